"""Weights that all frames of a group share: each camera's least squares over all of them.

For fixed mean and textures a frame adds a matrix and a vector to the normal equations of each camera, kilobytes in all.
Equations of frames are added in any process, and each camera is solved once:

    (sum_t A_ct^T rho A_ct + ridge) (w_c - w'_c) = sum_t A_ct^T rho (I_ct - G_c M_t - A_ct w'_c),

where A_ct = G_c [E_1t ... E_Nt] draws the textures of frame t in camera c, and w' are the weights before.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.fitted.model import PlaneModel
from eigenfield.encoding.fitted.normal_kernels import multiply
from eigenfield.encoding.fitted.observations import FitData
from eigenfield.encoding.fitted.products import one_blas_thread
from eigenfield.encoding.fitted.solve import WEIGHT_RIDGE_RATIO, residual
from eigenfield.runtime.parallel import parallel_map


@dataclass(frozen=True, eq=False)
class WeightEquations:
    """Normal equations of the weights of one frame, or of several.

    Attributes:
        matrix: (No, n, n) float64.
        right: (No, n) float64, of what the weights before leave.
        squares: Squared error that they leave.
        pixels: That it is over.
    """

    matrix: NDArray[np.float64]
    right: NDArray[np.float64]
    squares: float
    pixels: float

    def __add__(self, other: WeightEquations) -> WeightEquations:
        return WeightEquations(
            self.matrix + other.matrix,
            self.right + other.right,
            self.squares + other.squares,
            self.pixels + other.pixels,
        )

    @one_blas_thread
    def solve(self, weights: NDArray[np.float32]) -> NDArray[np.float32]:
        """(No, n) the weights that leave least, from those before."""
        count = self.matrix.shape[1]
        energy = float(np.trace(self.matrix, axis1=1, axis2=2).mean()) / max(count, 1)
        ridge = WEIGHT_RIDGE_RATIO * max(energy, 1e-12) * np.eye(count)
        change = np.linalg.solve(self.matrix + ridge, self.right[..., None])[..., 0]
        return (weights + change).astype(np.float32)


@one_blas_thread
def weight_equations(data: FitData, model: PlaneModel, variance: float | None = None) -> WeightEquations:
    """The equations of one frame.

    Args:
        data: An observation for each camera.
        model: With one block, of the whole grid.
        variance: As in `render_and_backproject`.
    """
    (block,) = model.blocks
    found = residual(data, model, (False, False, True), variance=variance)
    flat = block.textures.reshape(block.count, -1)
    layers = block.textures.reshape(-1, *model.grid)

    def matrix_of(index: int) -> NDArray[np.float64]:
        back = np.zeros_like(layers)
        multiply(*data.footprint(index), data.size, data.observations.weights(index), layers, back)
        return np.asarray(flat @ back.reshape(block.count, -1).T, np.float64)

    matrix = np.array(parallel_map(matrix_of, range(len(data))))
    right = found.weights[0].astype(np.float64)
    return WeightEquations(matrix, right, float(found.squares.sum()), float(found.pixels.sum()))
