"""Inner loops of descriptor matching."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.jit import kernel

F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
U8 = NDArray[np.uint8]


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
def find_best_two_on_lines(
    left: U8, right: U8, points1: F64, points2: F64, F: F64, tolerance: float, row: I64, top: F32, second: F32,
    column: I64, column_top: F32,
) -> None:  # fmt: skip
    """As `find_best_two` for all rows, among pairs whose points lie near each other's epipolar lines; others have -1.

    With l' = F x and l = F^T x' (x, x' homogeneous), a pair counts if |x'^T F x| <= tolerance min(|F x|_2D, |F^T
    x'|_2D). A hundredth of the pairs do, so that single inner products are faster than a product of matrices.

    Args:
        left: (n, 128) descriptors of the rows.
        right: (m, 128) descriptors of the columns.
        points1: (n, 2) pixels of the rows' features.
        points2: (m, 2) pixels of the columns' features.
        F: (3, 3) fundamental matrix.
        tolerance: Pixels.
        row, top, second, column, column_top: As of `find_best_two`, written.
    """
    count = len(points2)
    back = np.empty(count)
    for j in range(count):
        x, y = points2[j, 0], points2[j, 1]
        back[j] = np.hypot(F[0, 0] * x + F[1, 0] * y + F[2, 0], F[0, 1] * x + F[1, 1] * y + F[2, 1])
    for i in range(len(points1)):
        x, y = points1[i, 0], points1[i, 1]
        a = F[0, 0] * x + F[0, 1] * y + F[0, 2]
        b = F[1, 0] * x + F[1, 1] * y + F[1, 2]
        c = F[2, 0] * x + F[2, 1] * y + F[2, 2]
        limit = tolerance * np.hypot(a, b)
        best, runner, at = np.float32(-1), np.float32(-1), -1
        for j in range(count):
            residual = abs(a * points2[j, 0] + b * points2[j, 1] + c)
            if residual <= limit and residual <= tolerance * back[j]:
                inner = np.int32(0)
                for k in range(left.shape[1]):
                    inner += np.int32(left[i, k]) * np.int32(right[j, k])
                s = np.float32(inner)
                if s > runner:  # as in `find_best_two`, which takes twice as long with a function for both
                    if s > best:
                        runner, best, at = best, s, j
                    else:
                        runner = s
                if s > column_top[j]:
                    column_top[j] = s
                    column[j] = i
        row[i], top[i], second[i] = at, best, runner
