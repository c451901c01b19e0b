"""Products of weights and textures, a chunk of texels at a time: the same numbers at any number of threads.

BLAS multiplies each chunk in one thread (`one_blas_thread`). Its own threads wait for each other by spinning, which
takes more time than such narrow products themselves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from eigenfield.runtime.parallel import parallel_map, pieces

CHUNK_TEXELS = 1 << 15

Floats = NDArray[np.float32]
Function = TypeVar("Function", bound=Callable[..., Any])


def one_blas_thread(function: Function) -> Function:
    """Decorator: BLAS has one thread while the function runs."""
    return threadpool_limits.wrap(limits=1, user_api="blas")(function)


def combine(weights: Floats, textures: Floats, into: Floats) -> None:
    """into (B, t) = weights (B, n) times textures (n, t)."""

    def multiply(part: tuple[int, int]) -> None:
        texels = slice(*part)
        into[:, texels] = weights @ textures[:, texels]

    parallel_map(multiply, pieces(textures.shape[1], CHUNK_TEXELS))


def add_shares(weights: Floats, maps: Floats, into: Floats) -> None:
    """into (n, t) += the transpose of weights (B, n), times maps (B, t)."""

    def multiply(part: tuple[int, int]) -> None:
        texels = slice(*part)
        into[:, texels] += weights.T @ maps[:, texels]

    parallel_map(multiply, pieces(maps.shape[1], CHUNK_TEXELS))


def scalar_products(maps: Floats, textures: Floats) -> NDArray[np.float64]:
    """(B, n): of each map (B, t) with each texture (n, t)."""

    def multiply(part: tuple[int, int]) -> NDArray[np.float64]:
        texels = slice(*part)
        return np.asarray(maps[:, texels] @ textures[:, texels].T, np.float64)

    return np.sum(parallel_map(multiply, pieces(maps.shape[1], CHUNK_TEXELS)), axis=0)


def weighted_gram(maps: Floats, weights: Floats) -> NDArray[np.float64]:
    """(B, B) scalar products of maps (B, t), each number times its weight (t,)."""

    def multiply(part: tuple[int, int]) -> NDArray[np.float64]:
        some = maps[:, slice(*part)] * weights[slice(*part)]
        return np.asarray(some @ some.T, np.float64)

    return np.sum(parallel_map(multiply, pieces(maps.shape[1], CHUNK_TEXELS)), axis=0)
