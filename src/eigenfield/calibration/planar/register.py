"""Further views of a refined planar array, each found by its own photograph."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.planar.array import ARRAY_PARAMETERS, ARRAY_POSITION
from eigenfield.calibration.planar.fit import PhotometricTarget, gauss_newton_step, select_textured_points
from eigenfield.calibration.planar.joint import PLANAR_TAU_LEVELS, PLANAR_VISIBILITY_BIAS_PIXELS, PlanarArray, blurred
from eigenfield.core.camera import Camera
from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.views import Pictures, pack_pictures
from eigenfield.stereo.visibility import depth_buffers


def register_views(
    planar: PlanarArray,
    known: NDArray[np.int64],
    photographs: Pictures,
    new: NDArray[np.int64],
    positions: NDArray[np.float64],
    bases: Sequence[Camera] | None = None,
    exact: bool = False,
) -> PlanarArray:
    """The array with further views, each fitted to the array's texture and depth by its own photograph alone.

    Args:
        known: Indices of its views among all n.
        photographs: (v, H, W, 3) uint8 of the new views, or packed.
        new: (v,) their indices among all n.
        positions: (n, 2) of all views in any unit: new cameras start on the affine grid of the known ones.
        bases: Of all n, if cameras were given.
        exact: Cameras stay where they start; only the photographs' errors are measured.
    """
    before, after = (np.hstack([positions[i], np.ones((len(i), 1))]) for i in (known, new))
    parameters = np.zeros((len(positions), ARRAY_PARAMETERS))
    parameters[known] = planar.parameters
    parameters[new, :4] = after @ np.linalg.lstsq(before, planar.parameters[:, :4], rcond=None)[0]
    model = replace(planar.model, bases=tuple(bases or planar.model.bases[:1] * len(positions)))
    error = np.full(len(positions), np.nan)
    error[known] = planar.error
    sharp = pack_pictures(photographs)
    soft = np.stack(parallel_map(blurred, sharp))
    extent = max(1.0, float(np.linalg.norm(planar.parameters[:, ARRAY_POSITION], axis=1).max()))
    bias = PLANAR_VISIBILITY_BIAS_PIXELS / extent
    points = select_textured_points(planar.d, planar.texture, planar.count, len(known), ARRAY_PARAMETERS)
    for pictures, count, tau, rounds in (
        (soft, 4, 2 * PLANAR_TAU_LEVELS, 3),
        (sharp, 4, PLANAR_TAU_LEVELS, 2),
        (sharp, ARRAY_PARAMETERS, PLANAR_TAU_LEVELS, 3),
    ):
        for _ in range(rounds):
            matrices = model.matrices(planar.reference, new, parameters[new])
            buffers = depth_buffers(matrices, planar.d, pictures.shape[1:3])
            target = PhotometricTarget(planar.reference, pictures, buffers, *points, bias)
            moved, error[new] = gauss_newton_step(model, new, parameters[new], target, count, tau)
            parameters[new] = parameters[new] if exact else moved
    return replace(planar, model=model, parameters=parameters, error=error)
