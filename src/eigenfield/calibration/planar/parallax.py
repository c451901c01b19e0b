"""The positions of a planar array's cameras, from how points move between its photographs.

A planar array with one viewing direction moves a point of the central photograph by

    u_v = s_v - d p_v,

with p_v the camera's position in the array's plane in steps (x right, y down), d the point's disparity for one step,
and s_v a shift of the whole picture (principal point, small rotation). Over many points and views that is a matrix of
rank one plus a constant. Positions, shifts and disparities are determined together, up to the sign of (p, d), which
only occlusion reveals, and to an offset of d, which moves s by a multiple of p.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.planar.tracks import Tracks

F64 = NDArray[np.float64]

log = logging.getLogger("eigenfield.calibration")

PARALLAX_MIN_POINTS = 20
PARALLAX_MIN_VIEWS = 2  # in which a point must be found, besides the central one
PARALLAX_ROUNDS = 60
PARALLAX_NOISE_PIXELS = 1.0  # scale of the Cauchy loss
PARALLAX_OUTLIER_PIXELS = 3.0
PARALLAX_MAX_UNEXPLAINED_FRACTION = 0.25  # of the larger motions: otherwise the names of the views give wrong positions


@dataclass(frozen=True, eq=False)
class Parallax:
    """The rank-one model of the tracks.

    Attributes:
        steps: (2, 2) maps nominal positions (relative to the central camera) to positions p in steps, x right, y down.
        disparity: (k,) of the points; NaN where unreliable.
        residual: Median distance of the tracks from the model with regular positions, pixels.
        support: Number of reliable points.
    """

    steps: F64
    disparity: F64
    residual: float
    support: int


def measure_parallax(tracks: Tracks, nominal: F64) -> Parallax | None:
    """Fit the model to tracks; None if the tracks are too few or do not move.

    A line of cameras is allowed.

    Args:
        tracks: Of the central photograph.
        nominal: (v, 2) positions relative to the central camera, in nominal steps.
    """
    moved = tracks.found - tracks.points
    seen = np.isfinite(moved[..., 0])
    enough = seen.sum(axis=0) > PARALLAX_MIN_VIEWS
    moved, seen = moved[:, enough], seen[:, enough]
    if enough.sum() < PARALLAX_MIN_POINTS:
        return None
    weights = seen.astype(np.float64)
    moved = np.where(seen[..., None], moved, 0.0)
    steps = np.eye(2)
    shifts = np.zeros((2, 2))
    used = np.abs(nominal).max(axis=0) > 0  # a line of cameras does not constrain the other direction
    d = _initial_disparity(moved, weights, nominal)
    for _ in range(PARALLAX_ROUNDS):
        steps, shifts = _fit_positions(moved, weights, nominal, d, used)
        d = _fit_disparity(moved, weights, nominal, steps, shifts)
        residual = _model_residual(moved, nominal, steps, shifts, d)
        weights = np.where(seen, 1 / (1 + (residual / PARALLAX_NOISE_PIXELS) ** 2), 0.0)
    residual = np.where(seen, residual, np.nan)
    good = np.nanmedian(residual, axis=0) < PARALLAX_OUTLIER_PIXELS
    good &= (residual < PARALLAX_OUTLIER_PIXELS).sum(axis=0) > PARALLAX_MIN_VIEWS
    if good.sum() < PARALLAX_MIN_POINTS or not np.isfinite(steps).all() or np.abs(np.diag(steps)[used]).min() < 1e-3:
        return None
    moves = np.where(seen, np.linalg.norm(moved, axis=-1), np.nan)[:, good]
    unexplained = PARALLAX_MAX_UNEXPLAINED_FRACTION * np.nanpercentile(moves, 75)
    if np.nanmedian(residual[:, good]) > unexplained:
        return None
    # gauge: the mean length of a step is one, the first axis keeps its sign
    first = 0 if used[0] else 1
    scale = steps[first, first]
    disparity = np.full(len(enough), np.nan)
    disparity[np.flatnonzero(enough)[good]] = d[good] * scale
    return Parallax(steps / scale, disparity, float(np.nanmedian(residual[:, good])), int(good.sum()))


def _initial_disparity(moved: F64, weights: F64, nominal: F64) -> F64:
    """Least squares over the axis with more motion; the shift of each view is its median motion."""
    axis = 0 if np.abs(nominal[:, 0]).sum() >= np.abs(nominal[:, 1]).sum() else 1
    result = np.zeros(moved.shape[1])
    total = np.full(moved.shape[1], 1e-9)
    for motion, weight, place in zip(moved[..., axis], weights, nominal[:, axis], strict=True):
        inside = weight > 0
        if abs(place) < 0.5 or inside.sum() < PARALLAX_MIN_POINTS:
            continue
        result -= weight * place * (motion - np.median(motion[inside]))
        total += weight * place * place
    return result / total


def _fit_positions(moved: F64, weights: F64, nominal: F64, d: F64, used: NDArray[np.bool_]) -> tuple[F64, F64]:
    """Weighted least squares for `steps` and `shifts`, given the disparities."""
    n = nominal[:, used]
    a = n.shape[1]
    # unknowns of one image axis: steps (a), shifts (a); u = n . shifts - d n . steps
    left = np.zeros((2 * a, 2 * a))
    right = np.zeros((2 * a, 2))
    w0, w1, w2 = weights.sum(1), weights @ d, weights @ (d * d)
    m0 = np.einsum("vk,vkc->vc", weights, moved)
    m1 = np.einsum("vk,vkc->vc", weights * d, moved)
    left[:a, :a] = np.einsum("v,vi,vj->ij", w2, n, n)
    left[:a, a:] = -np.einsum("v,vi,vj->ij", w1, n, n)
    left[a:, :a] = left[:a, a:].T
    left[a:, a:] = np.einsum("v,vi,vj->ij", w0, n, n)
    right[:a] = -np.einsum("vi,vc->ic", n, m1)
    right[a:] = np.einsum("vi,vc->ic", n, m0)
    solved = np.linalg.lstsq(left, right, rcond=1e-12)[0].T  # (image axis, unknowns)
    steps, shifts = np.zeros((2, 2)), np.zeros((2, 2))
    steps[:, used], shifts[:, used] = solved[:, :a], solved[:, a:]
    # an offset of d is a multiple of `steps` in `shifts`: remove it, the disparities follow in the next fit
    offset = (steps * shifts).sum() / max((steps * steps).sum(), 1e-12)
    return steps, shifts - offset * steps


def _fit_disparity(moved: F64, weights: F64, nominal: F64, steps: F64, shifts: F64) -> F64:
    p, s = nominal @ steps.T, nominal @ shifts.T
    over = -np.einsum("vk,vkc,vc->k", weights, moved - s[:, None], p)
    return over / np.maximum(weights.T @ (p * p).sum(axis=1), 1e-9)


def _model_residual(moved: F64, nominal: F64, steps: F64, shifts: F64, d: F64) -> F64:
    p, s = nominal @ steps.T, nominal @ shifts.T
    return np.linalg.norm(moved - s[:, None] + d[None, :, None] * p[:, None], axis=-1)
