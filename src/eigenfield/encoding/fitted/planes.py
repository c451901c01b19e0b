"""Which planes a scene is fitted as, how dense and how finely coded each is."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.aom import aom_program, encode_aom
from eigenfield.coding.pictures.pictures_10bit import SMALLEST, SVT, encoder_step
from eigenfield.core.payloads import Coded
from eigenfield.core.progress import Progress
from eigenfield.core.scene import Plane
from eigenfield.encoding.fitted.colour import split_matrix
from eigenfield.encoding.fitted.coverage import mean_precision
from eigenfield.encoding.fitted.fit import OpenFit, Pixels, PlaneSettings, code_plane, coded_psnr, fit_plane
from eigenfield.encoding.fitted.observations import FitData, subsampled, with_robust_weights
from eigenfield.encoding.fitted.rate import Rate, price_of
from eigenfield.encoding.options import DENSEST, Preset

log = logging.getLogger("eigenfield.fit")

TEXTURE_SHARE = 0.55  # density of luma's components, of the atlas's along an axis; chosen on Tarot
SIDE_STEP = 16  # atlas sides are multiples of this


@dataclass(frozen=True, eq=False)
class PlanePreset:
    """How a plane is fitted and coded beside the others; chosen on Tarot.

    Attributes:
        name: of the plane.
        matrix: (C, 3) its channels from R, G, B.
        mean_share, texture_share: densities, of the atlas's along an axis.
        textures: of the number asked for.
        mean_step, texture_step: of the quantiser, beside `step_of`, at the atlas's density: a texel answers for as many
            pixels as its plane is less dense, so that equal steps in the pictures are steps in proportion to density.
        subsampled: fitted to fewer pixels where there are many observations.
        ahead: densities are as if the atlas had so many texels a pixel more, up to DENSEST.
        searched: see `Rate`; not chroma, whose mean says nothing of what luma's bytes are worth.
    """

    name: str
    matrix: NDArray[np.float32]
    mean_share: float
    texture_share: float
    textures: float
    mean_step: float
    texture_step: float
    subsampled: bool
    ahead: float
    searched: bool

    def settings(self, size: tuple[int, int], density: float, textures: int) -> PlaneSettings:
        """Of a fit. size: (rows, columns) of the atlas; density: its texels per photograph pixel along one axis.
        textures: luma's number, also of each region's own."""
        count = round(self.textures * textures)
        wanted = max(min(density + self.ahead, DENSEST), density)
        finer = min(wanted / density, 1 / self.mean_share)
        mean, grid = scaled(size, finer * self.mean_share), scaled(size, finer * self.texture_share)
        return PlaneSettings(self.matrix, mean, grid, count, count)

    def rate(self, step: float, patient: bool = False, few: bool = False) -> Rate:
        """How finely the plane is coded.

        Args:
            step: see `step_of`.
            patient: coded by libaom, which the machine must have.
            few: observations, whose textures are about as many and draw each photograph on its own; 5x4 views lose
                0.14 dB by a search at high rates.
        """
        mean_step, texture_step = self.mean_step * self.mean_share * step, self.texture_step * self.texture_share * step
        coder, trial = (encode_aom, SVT) if patient else (SVT, None)
        return Rate(mean_step, texture_step, coder, trial, search=self.searched and not few)


_LUMA, _CHROMA = split_matrix()
PLANE_PRESETS = {
    "luma-chroma": (
        PlanePreset("luma", _LUMA, 1.0, TEXTURE_SHARE, 1.0, 0.85, 0.7, False, 0.0, True),
        PlanePreset("chroma", _CHROMA, 0.5, 0.3, 0.25, 2.0, 0.95, True, 0.2, False),
    ),
    "rgb": (PlanePreset("rgb", np.eye(3, dtype=np.float32), 1.0, TEXTURE_SHARE, 1.0, 0.85, 0.7, False, 0.0, True),),
}
HALF_LEVEL = 0.002  # grey level, in the photographs' range
TEXTURES_SHARE = 1 / 2  # of the observations, see `fitted_textures`
TEXTURES_LEAST, TEXTURES_MOST = 20, 96
UNMEASURED = 99.999  # dB
SUBSAMPLED_FROM = 50  # observations, from which every second pixel each way is enough for weights, and for chroma
FEW_ROUNDS = 4  # at most, or the preset's, for fewer: they take longer to settle, and what is far off does not even out


def fitted_textures(observations: int) -> int:
    """Luma's number of eigen textures unless it is asked for, before coding keeps those that are worth their bytes."""
    return min(max(round(TEXTURES_SHARE * observations), min(TEXTURES_LEAST, observations - 1)), TEXTURES_MOST)


@dataclass(frozen=True, eq=False)
class Fits:
    """Planes fitted, not coded yet. patient: see `PlanePreset.rate`."""

    planes: tuple[tuple[PlanePreset, OpenFit], ...]
    patient: bool

    def coded(
        self, quality: int, grid: NDArray[np.int64] | None = None, progress: Progress | None = None
    ) -> dict[str, Coded[Plane]]:
        """All as they are coded at a quality, in the order of `to_rgb`'s columns. grid: as `code_plane`."""
        step = step_of(quality)
        precision = mean_precision(self.planes[0][1].scales)
        few = len(self.planes[0][1].pixels.every) < SUBSAMPLED_FROM
        return {
            plane.name: code_plane(fit, plane.rate(step, self.patient, few), grid, precision, progress)
            for plane, fit in self.planes
        }

    def reached(self, planes: Sequence[Plane] | None = None) -> dict[str, dict[str, float]]:
        """dB of each plane's channels before and after coding to `planes`, for a scene's settings. None: not measured
        yet, a number that takes no fewer letters."""
        fits = [fit for _, fit in self.planes]
        coded = [UNMEASURED] * len(fits) if planes is None else map(coded_psnr, fits, planes)
        return {
            fit.name: {"uncoded": round(fit.uncoded, 3), "coded": round(value, 3)}
            for fit, value in zip(fits, coded, strict=True)
        }


@contextlib.contextmanager
def open_fits(
    data: FitData,
    density: float,
    textures: int,
    preset: Preset,
    planes: Sequence[PlanePreset] = PLANE_PRESETS["luma-chroma"],
    work: Path | None = None,
    progress: Progress | None = None,
) -> Iterator[Fits]:
    """Planes fitted.

    Args:
        data: what they are fitted to, which stays open.
        density: texels of its atlas for a pixel, along an axis.
        textures: luma's number.
        preset: what the fit aims at.
        planes: which, and how each is fitted and coded.
        work: folder for scratch files.
        progress: reports the steps.
    """
    few = len(data) < SUBSAMPLED_FROM
    rounds = max(preset.rounds, FEW_ROUNDS) if few else preset.rounds
    with contextlib.ExitStack() as kept:
        some = kept.enter_context(subsampled(data, 1 if few else 2, work))

        def fit(plane: PlanePreset) -> OpenFit:
            if few:
                robust = kept.enter_context(with_robust_weights(data, work))
                pixels = Pixels(data, robust, robust)
            else:
                pixels = Pixels(data, some if plane.subsampled else data, some)
            return fit_plane(pixels, plane.settings(data.size, density, textures), plane.name, rounds, work, progress)

        patient = preset.patient and aom_program() is not None
        if preset.patient:
            log.info("coded by %s", "libaom" if patient else "SVT-AV1: an ffmpeg program with libaom saves 8 to 10 %")
        yield Fits(tuple((plane, fit(plane)) for plane in planes), patient)


def step_of(quality: int) -> float:
    """Quantiser step by which those of all planes are counted, in the photographs' range: quality 0 to 100 is SVT-AV1's
    crf 63 to 0 at half a grey level a code and TEXTURE_SHARE of the atlas's density."""
    return encoder_step(0.63 * (100 - quality)) * HALF_LEVEL / TEXTURE_SHARE


def byte_price(quality: int) -> float:
    """Squared error of luma that a byte takes off the pictures at a quality, for each pixel that a texel of the mean is
    seen in."""
    return price_of(PLANE_PRESETS["luma-chroma"][0].mean_step * step_of(quality))


def scaled(size: tuple[int, int], share: float) -> tuple[int, int]:
    """An atlas's size at another density, as the encoder takes it; at its own as it is."""
    if share == 1:
        return size
    rows, columns = (max(SMALLEST, SIDE_STEP * round(share * side / SIDE_STEP)) for side in size)
    return rows, columns
