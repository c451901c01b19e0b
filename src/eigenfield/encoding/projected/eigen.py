"""Eigen textures by the Gram matrix of the texture maps (the paper's equations 3 to 6), streamed over texels.

The paper writes the deviations of Nc filled maps from their mean as the rows of a matrix X: equation 3 is a pixel of a
row, 4 is a row, 5 the matrix. Equation 6 decomposes X^T X, which has a row for each texel and channel. Here the rows
are No observations. With far fewer of them than texels the same vectors come from X X^T, their No x No inner products
(Sirovich's method of snapshots, 1987), which needs two passes over the maps and memory for one tile of them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import helmert
from threadpoolctl import threadpool_limits

from eigenfield.core.progress import Progress, track
from eigenfield.encoding.projected.mean import MAP_TILE_TEXELS, Mean
from eigenfield.encoding.projected.project import TextureMaps
from eigenfield.runtime.parallel import parallel_stream, pieces, tracked_map


def _deviations(maps: TextureMaps, mean: Mean, first: int, last: int) -> NDArray[np.float32]:
    """(No, (last - first) C): the columns of X (equations 3 to 5) of a tile; zero where the fill is the mean itself."""
    tile = maps.values[:, first:last] - mean.values[first:last]
    tile *= maps.seen[:, first:last, None]
    return tile.reshape(maps.count, -1)


def gram_matrix(maps: TextureMaps, mean: Mean, progress: Progress | None = None) -> NDArray[np.float64]:
    """(No, No) float64: X X^T, inner products of the maps' deviations from the mean.

    Tiles are summed in float64 and in a fixed order: float32 sums lose the small eigenvalues, free order changes the
    last bits with the number of threads.
    Matrices of frames that share their weights are added.
    """

    def product(part: tuple[int, int]) -> NDArray[np.float64]:
        tile = _deviations(maps, mean, *part).astype(np.float64)
        return tile @ tile.T

    total = np.zeros((maps.count, maps.count))
    parts = pieces(maps.atlas.count, MAP_TILE_TEXELS)
    with threadpool_limits(1, "blas"):
        for gram in track(parallel_stream(product, parts), "inner products", len(parts), progress):
            total += gram
    return total


def eigenvectors(gram: NDArray[np.float64]) -> NDArray[np.float64]:
    """(No, No - 1) float64, equation 6: eigenvectors of a Gram matrix within the complement of (1, ..., 1), on which
    deviations from a mean live: orthonormal columns by falling eigenvalue, each with its largest entry positive.

    Working there leaves exactly No - 1 components, which span every set of maps even where eigenvalues vanish.
    """
    complement = np.ascontiguousarray(helmert(len(gram)).T)
    with threadpool_limits(1, "blas"):
        _, inner = np.linalg.eigh(complement.T @ gram @ complement)
        vectors = complement @ inner[:, ::-1]
    largest = np.abs(vectors).argmax(axis=0)
    return vectors * np.where(vectors[largest, np.arange(len(gram) - 1)] < 0, -1.0, 1.0)


def weights_of(vectors: NDArray[np.float64], count: int) -> NDArray[np.float32]:
    """(No, N) float32 ω(c, j), scaled to unit mean square over the observations: the textures carry the amplitudes."""
    return (vectors[:, :count] * np.sqrt(len(vectors))).astype(np.float32)


def eigen_textures(
    maps: TextureMaps, mean: Mean, weights: NDArray[np.float32], progress: Progress | None = None
) -> NDArray[np.float32]:
    """(N, n, C) float32 T_E(j) at the chart texels: the deviations projected on the weights, Σ_c ω(c, j) D(c) / No."""
    count = weights.shape[1]
    textures = np.zeros((count, maps.atlas.count, maps.channels), np.float32)
    projection = np.ascontiguousarray(weights.T.astype(np.float64) / maps.count)

    def piece(part: tuple[int, int]) -> None:
        first, last = part
        tile = projection @ _deviations(maps, mean, first, last)
        textures[:, first:last] = tile.reshape(count, last - first, maps.channels)

    with threadpool_limits(1, "blas"):
        tracked_map(piece, pieces(maps.atlas.count, MAP_TILE_TEXELS), "eigen textures", progress)
    return textures
