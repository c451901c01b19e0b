"""Which planes a scene is fitted as, how dense and how finely coded each is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.fitting.colour import split_matrix, to_rgb
from eigenfield.fitting.fit import Fitted, PlaneSettings, fit_plane
from eigenfield.fitting.shots import Shots
from eigenfield.format.deep import encoder_step
from eigenfield.format.deep_code import STEP
from eigenfield.progress import Progress
from eigenfield.scene import Plane

# Texels a photograph's pixel along an axis, of the atlas's density; found on Tarot, see docs/evaluation.md
TEXTURE_SHARE = 0.55  # of the components of luma
CHROMA_MEAN_SHARE = 0.5
CHROMA_SHARE = 0.3
CHROMA_TEXTURES = 0.25  # of luma's number
SIDE_STEP = 16  # atlas sides are multiples of this
SMALLEST = 64
# Quantiser steps beside that of luma's components. A texel answers for as many pixels as its plane is less dense, so
# that equal steps in the pictures are steps in proportion to density.
MEAN_STEP = 0.7
CHROMA_MEAN_STEP = 2.0
CHROMA_STEP = 1.1
PRESET = 2  # SVT-AV1's
FIT_QUALITY = 70
TEXTURES_SHARE = 1 / 3  # of the cameras, see `fitted_textures`
TEXTURES_MOST = 96


def fitted_textures(cameras: int) -> int:
    """Luma's number of eigen textures unless it is asked for: what pays for its bytes grows with the cameras."""
    return min(round(TEXTURES_SHARE * cameras), TEXTURES_MOST)


def fit_planes(
    shots: Shots,
    textures: int,
    quality: int,
    grid: NDArray[np.int64] | None = None,
    work: Path | None = None,
    progress: Progress | None = None,
) -> tuple[tuple[Plane, ...], NDArray[np.float32], dict[str, Fitted]]:
    """Luma and chroma planes for `shots`, the matrix that joins them, what each reached. textures: luma's number.
    grid: as `fit_plane`."""
    luma_matrix, chroma_matrix = split_matrix()
    size = shots.surface.size
    step = step_of(quality)
    luma = PlaneSettings(
        luma_matrix, size, scaled(size, TEXTURE_SHARE), textures, 1, MEAN_STEP * step, TEXTURE_SHARE * step, PRESET
    )
    chroma = PlaneSettings(
        chroma_matrix, scaled(size, CHROMA_MEAN_SHARE), scaled(size, CHROMA_SHARE), round(CHROMA_TEXTURES * textures),
        2, CHROMA_MEAN_STEP * CHROMA_MEAN_SHARE * step, CHROMA_STEP * CHROMA_SHARE * step, PRESET,
    )  # fmt: skip
    found = {
        "luma": fit_plane(shots, luma, "luma", grid=grid, work=work, progress=progress),
        "chroma": fit_plane(shots, chroma, "chroma", grid=grid, work=work, progress=progress),
    }
    return tuple(one.plane for one in found.values()), to_rgb(), found


def step_of(quality: int) -> float:
    """Quantiser step of luma's components, were they as dense as the atlas, in the photographs' range: quality 0 to 100
    is SVT-AV1's crf 63 to 0 at half a grey level a code."""
    return encoder_step(0.63 * (100 - quality)) * STEP / TEXTURE_SHARE


def scaled(size: tuple[int, int], share: float) -> tuple[int, int]:
    """An atlas's size at another density, as the encoder takes it."""
    rows, columns = (max(SMALLEST, SIDE_STEP * round(share * side / SIDE_STEP)) for side in size)
    return rows, columns
