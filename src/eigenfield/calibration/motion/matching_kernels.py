"""Inner loops of descriptor matching."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.jit import kernel

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
I64 = NDArray[np.int64]


@kernel()
def find_best_two(similarity: F32, first: int, row: I64, top: F32, second: F32, column: I64, column_top: F32) -> None:
    """The two largest entries of every row, and the running largest of every column; ties go to the lower index.

    Args:
        similarity: (b, m) block of the similarity matrix S = A B^T.
        first: Row of S at which the block begins.
        row: (n,) column of the largest entry of each row, written.
        top: (n,) its value, written.
        second: (n,) the second-largest value, written.
        column: (m,) row of the largest entry of each column, updated.
        column_top: (m,) its value, updated.
    """
    for i in range(similarity.shape[0]):
        best, runner, at = np.float32(-1), np.float32(-1), -1
        for j in range(similarity.shape[1]):
            s = similarity[i, j]
            if s > runner:
                if s > best:
                    runner, best, at = best, s, j
                else:
                    runner = s
            if s > column_top[j]:
                column_top[j] = s
                column[j] = first + i
        row[first + i], top[first + i], second[first + i] = at, best, runner


@kernel()
def mask_off_lines(similarity: F32, first: int, points1: F64, points2: F64, F: F64, tolerance: float) -> None:
    """Set to -1 the entries whose points do not lie near each other's epipolar lines, so that they never match.

    With l' = F x and l = F^T x' (x, x' homogeneous), an entry stays if |x'^T F x| <= tolerance min(|F x|_2D, |F^T
    x'|_2D).

    Args:
        similarity: (b, m) block of the similarity matrix, changed in place.
        first: Row of the matrix at which the block begins.
        points1: (n, 2) pixels of the rows' features.
        points2: (m, 2) pixels of the columns' features.
        F: (3, 3) fundamental matrix.
        tolerance: Pixels.
    """
    count = similarity.shape[1]
    back = np.empty(count)
    for j in range(count):
        x, y = points2[j, 0], points2[j, 1]
        back[j] = np.hypot(F[0, 0] * x + F[1, 0] * y + F[2, 0], F[0, 1] * x + F[1, 1] * y + F[2, 1])
    for i in range(similarity.shape[0]):
        x, y = points1[first + i, 0], points1[first + i, 1]
        a = F[0, 0] * x + F[0, 1] * y + F[0, 2]
        b = F[1, 0] * x + F[1, 1] * y + F[1, 2]
        c = F[2, 0] * x + F[2, 1] * y + F[2, 2]
        length = np.hypot(a, b)
        for j in range(count):
            residual = abs(a * points2[j, 0] + b * points2[j, 1] + c)
            if residual > tolerance * length or residual > tolerance * back[j]:
                similarity[i, j] = -1
