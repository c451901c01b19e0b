"""The paper's measure: each camera's texture map against the one put together from the eigen textures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Plane
from eigenfield.encoding.projected import Atlas
from eigenfield.encoding.projected import measure_map as measure_pictures
from eigenfield.evaluation.kernels import add_textures

STRIDE = 512  # texels that the kernel sums at a time


@dataclass(frozen=True)
class MapFigures:
    """What one camera's texture map gave; an SSIM and a PSNR (dB) for each number of textures asked for, None where
    the camera sees no texel. png: bytes of the filled map, None when not asked for."""

    ssim: tuple[float | None, ...]
    psnr: tuple[float | None, ...]
    png: int | None


def reconstructions(plane: Plane, row: int, counts: Sequence[int]) -> Iterator[NDArray[np.float32]]:
    """Equation 8 with the weights of encoded camera `row`, cut to each of `counts` (rising): (H, W, C) pictures.

    Each picture is the one before it with more textures added, in the same memory.
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
                add_textures(
                    total.reshape(-1),
                    basis.textures[begin:end].reshape(end - begin, -1),
                    np.tile(factor, STRIDE),
                    np.tile(offset, STRIDE),
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
) -> MapFigures:
    """SSIM and PSNR of encoded camera `row` over the texels that it sees, on the atlas' grid.

    values (n, C), seen (n,): the camera's texture map at the chart texels. Texels that it does not see come from the
    file's mean (equation 2), in both pictures.
    """
    filled, scores = measure_pictures(reconstructions(plane, row, counts), plane.mean, atlas, values, seen)
    structure, error = zip(*scores, strict=True)
    return MapFigures(structure, error, png_size(atlas, filled) if png else None)


def png_size(atlas: Atlas, filled: NDArray[np.uint8]) -> int:
    """Bytes of a filled (H, W, C) map as PNG: libpng's default compression (6, filtered), black outside the charts,
    which is what PNG packs best. Channels beyond three are counted as pictures of their own."""
    charts = np.zeros_like(filled)
    flat, source = charts.reshape(-1, filled.shape[2]), filled.reshape(-1, filled.shape[2])
    flat[atlas.texel] = source[atlas.texel]
    how = [cv2.IMWRITE_PNG_COMPRESSION, 6, cv2.IMWRITE_PNG_STRATEGY, cv2.IMWRITE_PNG_STRATEGY_FILTERED]
    pictures = [charts[..., ::-1]] if charts.shape[2] == 3 else [charts[..., c] for c in range(charts.shape[2])]
    return sum(len(cv2.imencode(".png", picture, how)[1]) for picture in pictures)
