"""Which planes a scene is fitted as, how dense and how finely coded each is."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.fitting.colour import split_matrix
from eigenfield.fitting.fit import Coded, OpenFit, Pixels, PlaneSettings, Rate, code_plane, fit_plane, price_of
from eigenfield.fitting.shots import Shots, thinned
from eigenfield.format.deep import SMALLEST, encoder_step
from eigenfield.format.deep_code import STEP
from eigenfield.progress import Progress

# Densities, of the atlas's along an axis; chosen on Tarot
TEXTURE_SHARE = 0.55  # of the components of luma
CHROMA_MEAN_SHARE = 0.5
CHROMA_SHARE = 0.3
CHROMA_TEXTURES = 0.25  # of luma's number
SIDE_STEP = 16  # atlas sides are multiples of this
# Quantiser steps beside that of luma's components. A texel answers for as many pixels as its plane is less dense, so
# that equal steps in the pictures are steps in proportion to density.
MEAN_STEP = 0.7
CHROMA_MEAN_STEP = 2.0
CHROMA_STEP = 1.1
TEXTURES_SHARE = 1 / 2  # of the cameras, see `fitted_textures`
TEXTURES_LEAST, TEXTURES_MOST = 20, 96
THINNED_FROM = 50  # cameras, from which every second pixel each way is enough for weights, and for chroma


@dataclass(frozen=True)
class Preset:
    """What a fit aims at. quality: 0 to 100. rounds: at most. encoder: SVT-AV1's preset, the slower the lower."""

    quality: int
    rounds: int
    encoder: int


PRESETS = {"small": Preset(78, 2, 2), "balanced": Preset(88, 2, 2), "best": Preset(95, 4, 1)}


def fitted_textures(cameras: int) -> int:
    """Luma's number of eigen textures unless it is asked for, before coding keeps those that are worth their bytes."""
    return min(max(round(TEXTURES_SHARE * cameras), min(TEXTURES_LEAST, cameras - 1)), TEXTURES_MOST)


@dataclass(frozen=True, eq=False)
class Fits:
    """Luma and chroma fitted, not coded yet."""

    luma: OpenFit
    chroma: OpenFit
    preset: Preset

    def coded(
        self, quality: int, grid: NDArray[np.int64] | None = None, progress: Progress | None = None
    ) -> dict[str, Coded]:
        """Both as they are coded at a quality, in the order of `to_rgb`'s columns. grid: as `code_plane`."""
        step = step_of(quality)
        luma = Rate(MEAN_STEP * step, TEXTURE_SHARE * step, self.preset.encoder)
        chroma = Rate(
            CHROMA_MEAN_STEP * CHROMA_MEAN_SHARE * step, CHROMA_STEP * CHROMA_SHARE * step, self.preset.encoder
        )
        return {
            "luma": code_plane(self.luma, luma, grid, progress),
            "chroma": code_plane(self.chroma, chroma, grid, progress),
        }


@contextlib.contextmanager
def open_fits(
    shots: Shots, textures: int, preset: Preset, work: Path | None = None, progress: Progress | None = None
) -> Iterator[Fits]:
    """Luma and chroma planes fitted to `shots`, which stay open. textures: luma's number."""
    luma_matrix, chroma_matrix = split_matrix()
    size = shots.surface.size
    luma = PlaneSettings(luma_matrix, size, scaled(size, TEXTURE_SHARE), textures)
    chroma = PlaneSettings(
        chroma_matrix, scaled(size, CHROMA_MEAN_SHARE), scaled(size, CHROMA_SHARE), round(CHROMA_TEXTURES * textures)
    )
    with thinned(shots, 2 if len(shots) >= THINNED_FROM else 1, work) as some:
        yield Fits(
            fit_plane(Pixels(shots, shots, some), luma, "luma", preset.rounds, work, progress),
            fit_plane(Pixels(shots, some, some), chroma, "chroma", preset.rounds, work, progress),
            preset,
        )


def step_of(quality: int) -> float:
    """Quantiser step of luma's components, were they as dense as the atlas, in the photographs' range: quality 0 to 100
    is SVT-AV1's crf 63 to 0 at half a grey level a code."""
    return encoder_step(0.63 * (100 - quality)) * STEP / TEXTURE_SHARE


def byte_price(quality: int) -> float:
    """Squared error of luma that a byte takes off the pictures at a quality, for each pixel that a texel of the mean is
    seen in."""
    return price_of(MEAN_STEP * step_of(quality))


def scaled(size: tuple[int, int], share: float) -> tuple[int, int]:
    """An atlas's size at another density, as the encoder takes it."""
    rows, columns = (max(SMALLEST, SIDE_STEP * round(share * side / SIDE_STEP)) for side in size)
    return rows, columns
