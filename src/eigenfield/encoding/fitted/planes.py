"""Which planes a scene is fitted as, how dense and how finely coded each is."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_10bit import CODER, MIN_SIDE_TEXELS, PATIENT_CODER, TRIAL_CODER, encoder_step
from eigenfield.core.appearance import Plane
from eigenfield.core.payloads import Coded
from eigenfield.core.progress import Progress
from eigenfield.encoding.fitted.code_planes import code_opacity
from eigenfield.encoding.fitted.colour import split_matrix
from eigenfield.encoding.fitted.coverage import mean_precision
from eigenfield.encoding.fitted.fit import OpenFit, Pixels, PlaneSettings, Turns, code_plane, coded_psnr, fit_plane
from eigenfield.encoding.fitted.observations import FitData, open_subsampled, with_robust_weights
from eigenfield.encoding.fitted.rate import Rate, lambda_of_step
from eigenfield.encoding.options import FIT_MAX_DENSITY, SUBSAMPLE_MIN_OBSERVATIONS, Preset

log = logging.getLogger("eigenfield.fit")

TEXTURE_DENSITY_RATIO = 0.55  # of luma's components to the atlas's, along an axis; chosen on Tarot
PLANE_SIDE_STEP_TEXELS = 16  # sides are multiples of this


@dataclass(frozen=True, eq=False)
class PlanePreset:
    """How a plane is fitted and coded beside the others; chosen on Tarot.

    Attributes:
        matrix: (C, 3) its channels from R, G, B.
        mean_share: Density of the mean, of the atlas's along an axis.
        texture_share: Density of the components, likewise.
        textures: Their number, of the number asked for.
        mean_step: Quantiser step of the mean, of `step_of`, at the atlas's density. A texel answers for as many pixels
            as its plane is less dense, so that equal steps in the pictures are steps in proportion to density.
        texture_step: Quantiser step of the components, likewise.
        subsampled: Whether fewer pixels are fitted where there are many observations.
        ahead: Densities are as if the atlas had so many texels a pixel more, up to FIT_MAX_DENSITY.
        sheet_steps: Factors of the steps of mean and components on sheets, which share a pixel; chosen on Boxes, and
            tried on Fern.
        scattered_step: Factor of the components' step before cameras in no array; chosen on Temple and Cube.
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
    sheet_steps: tuple[float, float]
    scattered_step: float

    def settings(self, size: tuple[int, int], density: float, textures: int, scattered: bool) -> PlaneSettings:
        """What the plane of a fit is to be.

        Args:
            size: (rows, columns) of the atlas.
            density: Its texels per photograph pixel along one axis.
            textures: Luma's number, also of each region's own.
        """
        count = round(self.textures * textures)
        wanted = max(min(density + self.ahead, FIT_MAX_DENSITY), density)
        finer = min(wanted / density, 1 / self.mean_share)
        mean, grid = plane_size(size, finer * self.mean_share), plane_size(size, finer * self.texture_share)
        return PlaneSettings(self.matrix, mean, grid, count, count, scattered)

    def rate(self, step: float, soft: bool = False, patient: bool = False, scattered: bool = False) -> Rate:
        """How finely the plane is coded.

        Args:
            soft: Whether it is on sheets.
            scattered: As in `PlaneSettings`.
            patient: Whether it is coded for as few bytes as time buys.
        """
        mean, texture = self.sheet_steps if soft else (1.0, self.scattered_step if scattered else 1.0)
        mean_step = mean * self.mean_step * self.mean_share * step
        texture_step = texture * self.texture_step * self.texture_share * step
        return Rate(mean_step, texture_step, PATIENT_CODER if patient else CODER, TRIAL_CODER)


_LUMA, _CHROMA = split_matrix()
PLANE_PRESETS = (
    PlanePreset("luma", _LUMA, 1.0, TEXTURE_DENSITY_RATIO, 1.0, 0.85, 0.7, False, 0.0, (0.7, 1.0), 1.0),
    PlanePreset("chroma", _CHROMA, 0.5, 0.3, 0.25, 2.0, 0.95, True, 0.2, (0.8, 8.0), 1.5),
)
OPACITY_STEP = 2.0  # quantiser step of the opacity, of `step_of`; chosen on Fern
HALF_GREY_LEVEL = 0.002  # in the photographs' range
TEXTURES_PER_OBSERVATION = 1 / 2
TEXTURES_MIN_COUNT, TEXTURES_MAX_COUNT = 20, 96
UNMEASURED_PSNR_DB = 99.999
# Rounds of so many observations at most, or the preset's if more: few converge slowly and average outliers less
FEW_OBSERVATIONS_ROUNDS = ((15, 4), (SUBSAMPLE_MIN_OBSERVATIONS - 1, 3))
MANY_TEXTURE_ITERATIONS = 4
FEW_TEXTURE_ITERATIONS = 5  # with 4, nine small views had texels that stood out


def fitted_textures(observations: int) -> int:
    """Luma's number of eigen textures unless it is asked for; of these `code_block_rd` codes as many as pay."""
    fewest = min(TEXTURES_MIN_COUNT, observations - 1)
    return min(max(round(TEXTURES_PER_OBSERVATION * observations), fewest), TEXTURES_MAX_COUNT)


@dataclass(frozen=True, eq=False)
class Fits:
    """Planes fitted, not coded yet."""

    planes: tuple[tuple[PlanePreset, OpenFit], ...]
    patient: bool

    def code_planes(
        self, quality: int, grid: NDArray[np.int64] | None = None, progress: Progress | None = None
    ) -> dict[str, Coded[Plane]]:
        """All planes coded at a quality of 0 to 100, by name, in the order of `to_rgb`'s columns."""
        step = step_of(quality)
        precision = mean_precision(self.planes[0][1].scales)
        rates = [plane.rate(step, fit.scales.soft, self.patient, fit.scattered) for plane, fit in self.planes]
        return {
            plane.name: code_plane(fit, rate, grid, precision, progress)
            for (plane, fit), rate in zip(self.planes, rates, strict=True)
        }

    def psnr_figures(self, planes: Sequence[Plane] | None = None) -> dict[str, dict[str, float]]:
        """dB of each plane's channels before and after coding to `planes`, for a scene's settings.

        None stands for planes that are not measured yet: UNMEASURED_PSNR_DB.
        """
        fits = [fit for _, fit in self.planes]
        coded = [UNMEASURED_PSNR_DB] * len(fits) if planes is None else map(coded_psnr, fits, planes)
        return {
            fit.name: {"uncoded": round(fit.uncoded, 3), "coded": round(value, 3)}
            for fit, value in zip(fits, coded, strict=True)
        }


@contextlib.contextmanager
def open_fits(
    data: FitData,
    density: float,
    textures: int,
    scattered: bool,
    preset: Preset,
    work: Path | None = None,
    progress: Progress | None = None,
) -> Iterator[Fits]:
    """Planes fitted.

    Args:
        data: What they are fitted to, which stays open.
        density: Texels of its atlas for a pixel, along an axis.
        textures: Luma's number.
    """
    few = len(data) < SUBSAMPLE_MIN_OBSERVATIONS
    least = next((rounds for most, rounds in FEW_OBSERVATIONS_ROUNDS if len(data) <= most), 0)
    turns = Turns(max(preset.rounds, least), FEW_TEXTURE_ITERATIONS if few else MANY_TEXTURE_ITERATIONS)
    with contextlib.ExitStack() as kept:
        some = kept.enter_context(open_subsampled(data, 1 if few else 2, work))

        def fit(plane: PlanePreset) -> OpenFit:
            if few:
                robust = kept.enter_context(with_robust_weights(data, work))
                pixels = Pixels(data, robust, robust)
            else:
                pixels = Pixels(data, some if plane.subsampled else data, some)
            return fit_plane(
                pixels, plane.settings(data.size, density, textures, scattered), plane.name, turns, work, progress
            )

        yield Fits(tuple((plane, fit(plane)) for plane in PLANE_PRESETS), preset.patient)


def step_of(quality: int) -> float:
    """The unit of all planes' quantiser steps, in the photographs' range.

    Quality 0 to 100 is SVT-AV1's crf 63 to 0 at half a grey level a code and TEXTURE_DENSITY_RATIO of the atlas's
    density.
    """
    return encoder_step(0.63 * (100 - quality)) * HALF_GREY_LEVEL / TEXTURE_DENSITY_RATIO


def byte_lambda(quality: int) -> float:
    """Lagrange multiplier at a quality: squared error of luma for a byte, for each pixel that sees a texel."""
    return lambda_of_step(PLANE_PRESETS[0].mean_step * step_of(quality))


def coded_opacity(opacity: NDArray[np.float32], quality: int) -> Coded[NDArray[np.float32]]:
    """The opacity of sheets as a file of a quality has it, with the even sides that the encoder takes.

    Args:
        opacity: (H, W) in 0..1, about a texel for a photograph's pixel.
        quality: 0 to 100.
    """
    return code_opacity(even_opacity(opacity), OPACITY_STEP * step_of(quality), CODER)


def opacity_size(shape: Sequence[int]) -> tuple[int, int]:
    """(rows, columns) that the encoder takes for an opacity of such a shape."""
    rows, columns = (max(MIN_SIDE_TEXELS, side + side % 2) for side in shape)
    return rows, columns


def even_opacity(opacity: NDArray[np.float32]) -> NDArray[np.float32]:
    """The opacity (H, W) with the sides of `opacity_size`."""
    rows, columns = opacity_size(opacity.shape)
    return opacity if opacity.shape == (rows, columns) else np.asarray(cv2.resize(opacity, (columns, rows)), np.float32)


def plane_size(size: tuple[int, int], share: float) -> tuple[int, int]:
    """(rows, columns) of an atlas at `share` of its density, as the encoder takes them; at its own as they are."""
    if share == 1:
        return size
    rows, columns = (
        max(MIN_SIDE_TEXELS, PLANE_SIDE_STEP_TEXELS * round(share * side / PLANE_SIDE_STEP_TEXELS)) for side in size
    )
    return rows, columns
