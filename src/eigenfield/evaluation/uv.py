"""The paper's scores: each camera's texture map against its reconstruction from the eigen textures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Plane
from eigenfield.encoding.atlas import Atlas
from eigenfield.encoding.projected.uv_measure import measure_map as measure_pictures
from eigenfield.runtime.jit import kernel

UV_STRIDE_TEXELS = 512  # that the kernel sums at a time


@dataclass(frozen=True)
class MapScores:
    """The scores of one camera's texture map.

    Attributes:
        ssim: For each number of textures; None if the camera sees no texel.
        psnr: dB, likewise.
        png: Bytes of the filled map as PNG; None if it was not packed.
    """

    ssim: tuple[float | None, ...]
    psnr: tuple[float | None, ...]
    png: int | None


def reconstruct_maps(plane: Plane, row: int, counts: Sequence[int]) -> Iterator[NDArray[np.float32]]:
    """Equation 8 with the weights of one encoded camera, cut to each number of textures.

    Each picture is the one before with more textures added, in the same memory.

    Args:
        counts: Numbers of textures, increasing.

    Returns:
        (H, W, C) pictures, one a count.
    """
    total = np.array(plane.mean, np.float32)
    done = 0
    for count in counts:
        first = 0
        for basis in plane.bases:
            begin, end = max(done - first, 0), min(count - first, basis.count)
            if begin < end:
                factor = basis.weights[row, begin:end, None] * basis.scale[begin:end]
                offset = (factor * basis.zero[begin:end]).sum(axis=0)
                _add_textures(
                    total.reshape(-1),
                    basis.textures[begin:end].reshape(end - begin, -1),
                    np.tile(factor, UV_STRIDE_TEXELS),
                    np.tile(offset, UV_STRIDE_TEXELS),
                )
            first += basis.count
        done = count
        yield total


def measure_map(
    plane: Plane,
    row: int,
    atlas: Atlas,
    values: NDArray[np.float32],
    seen: NDArray[np.uint8],
    counts: Sequence[int],
    png: bool = False,
) -> MapScores:
    """SSIM and PSNR of one encoded camera over the texels that it sees, on the atlas's grid.

    Texels that it does not see come from the file's mean (equation 2), in both pictures.

    Args:
        values: (n, C) the camera's texture map at the chart texels.
        seen: (n,) its visibility.
        counts: Numbers of textures, increasing.
    """
    filled, scores = measure_pictures(reconstruct_maps(plane, row, counts), plane.mean, atlas, values, seen)
    structure, error = zip(*scores, strict=True)
    return MapScores(structure, error, png_size(atlas, filled) if png else None)


def png_size(atlas: Atlas, filled: NDArray[np.uint8]) -> int:
    """Bytes of a filled map (H, W, C) as PNG.

    It uses libpng's default compression (6, filtered), and black outside the charts, which PNG packs best. Channels
    beyond three are counted as separate pictures."""
    charts = np.zeros_like(filled)
    flat, source = charts.reshape(-1, filled.shape[2]), filled.reshape(-1, filled.shape[2])
    flat[atlas.texel] = source[atlas.texel]
    how = [cv2.IMWRITE_PNG_COMPRESSION, 6, cv2.IMWRITE_PNG_STRATEGY, cv2.IMWRITE_PNG_STRATEGY_FILTERED]
    pictures = [charts[..., ::-1]] if charts.shape[2] == 3 else [charts[..., c] for c in range(charts.shape[2])]
    return sum(len(cv2.imencode(".png", picture, how)[1]) for picture in pictures)


@kernel()
def _add_textures(total, stored, factor, offset):  # type: ignore[no-untyped-def]
    """total[i] += Σ_j factor[j, k] stored[j, i] - offset[k] with k = i modulo the period, for flat pictures.

    The period is a multiple of the channels: a long one lets the inner loop run over many texels at once.

    Args:
        total: (n,) float32, added to.
        stored: (m, n) of any type.
        factor: (m, period) float32.
        offset: (period,) float32.
    """
    size, period = total.shape[0], offset.shape[0]
    for start in range(0, size, period):
        length = min(period, size - start)
        part = total[start : start + length]
        for k in range(length):
            part[k] -= offset[k]
        for j in range(stored.shape[0]):
            texture = stored[j, start : start + length]
            scale = factor[j]
            for k in range(length):
                part[k] += scale[k] * texture[k]
