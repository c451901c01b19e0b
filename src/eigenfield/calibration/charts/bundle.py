"""Bundle adjustment of a rig and its boards: cameras, intrinsics and the board's pose at every moment together.

A corner X of the board at moment m is seen by camera c at

    u = project(R_c (R_m X + t_m) + t_c, intrinsics_c).

The sum of rho(|u - measured|^2), rho(s) = f^2 log(1 + s / f^2) (Cauchy), is minimised by Levenberg-Marquardt on
reweighted normal equations. They are sparse, since an observation couples one camera to one board. SuperLU solves them
serially, so that the result does not depend on the number of threads. Rotations are updated from the left, R <- exp(w)
R.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array, diags_array
from scipy.sparse.linalg import splu
from scipy.spatial.transform import Rotation

from eigenfield.calibration.charts.corners import DetectedCorners
from eigenfield.calibration.charts.lens_models import project_points, project_points_with_derivatives

log = logging.getLogger("eigenfield.calibration")

F64 = NDArray[np.float64]

BUNDLE_MAX_STEPS = 60
BUNDLE_SCALE_ROUNDS = 3  # how often the loss scale is set from the residuals
BUNDLE_LOSS_MEDIANS = 2.5  # loss scale, in median residuals
BUNDLE_MIN_LOSS_PIXELS = 0.1
BUNDLE_COST_TOLERANCE = 1e-7  # relative decrease of the cost that ends a round
BUNDLE_FIRST_DAMPING, BUNDLE_MAX_DAMPING = 1e-4, 1e12


@dataclass(frozen=True, eq=False)
class BoardObservation:
    """The corners that one camera saw at one moment."""

    camera: int
    moment: int
    corners: DetectedCorners


@dataclass(frozen=True, eq=False)
class RigEstimate:
    """Cameras and boards in one world.

    Attributes:
        intrinsics: (C, 9), see `lens_models`.
        R: (C, 3, 3) world to camera.
        t: (C, 3) world to camera.
        board_rotation: (M, 3, 3) board to world; NaN at moments without a board.
        board_shift: (M, 3) board to world; NaN at moments without a board.
    """

    intrinsics: F64
    R: F64
    t: F64
    board_rotation: F64
    board_shift: F64

    def in_camera(self, points: F64, observation: BoardObservation) -> F64:
        """(k, 3) the observed corners in the axes of the observation's camera.

        Args:
            points: (n, 3) corners on the board.
        """
        m, c = observation.moment, observation.camera
        world = points[observation.corners.ids] @ self.board_rotation[m].T + self.board_shift[m]
        return world @ self.R[c].T + self.t[c]

    def residuals(self, points: F64, observation: BoardObservation) -> F64:
        """(k, 2) pixels, projected minus measured.

        Args:
            points: (n, 3) corners on the board.
        """
        inside = self.in_camera(points, observation)
        return project_points(inside, self.intrinsics[observation.camera]) - observation.corners.pixels


@dataclass(frozen=True, eq=False)
class _Problem:
    """Measurements as flat arrays, and where each camera's and board's unknowns begin."""

    points: F64  # (n, 3) on the board
    pixels: F64  # (n, 2)
    camera: NDArray[np.int64]
    moment: NDArray[np.int64]
    bases: tuple[F64, ...]  # (9, m) of each camera
    camera_at: NDArray[np.int64]  # first unknown of each camera: intrinsics, then the pose
    pose_is_free: NDArray[np.bool_]  # whether each camera's pose is free
    board_at: NDArray[np.int64]  # first unknown of each moment's board, -1 where there is none
    unknowns: int


def adjust_bundle(
    points: F64, observations: Sequence[BoardObservation], rig: RigEstimate, bases: Sequence[F64], fixed: int
) -> tuple[RigEstimate, F64]:
    """The rig that fits the observations best.

    Args:
        points: (n, 3) corners on the board.
        bases: (9, m) directions in which each camera's intrinsics may move; m = 0 holds them.
        fixed: The camera whose pose stays.

    Returns:
        The rig, and (C,) standard deviation of each camera's fx in pixels, NaN if its intrinsics are held.
    """
    problem = _make_problem(points, observations, rig, bases, fixed)
    for _ in range(BUNDLE_SCALE_ROUNDS):
        usual = float(np.median(_reprojection_distances(problem, rig)))
        scale = max(BUNDLE_LOSS_MEDIANS * usual, BUNDLE_MIN_LOSS_PIXELS)
        rig = _minimise(problem, rig, scale)
    return rig, _focal_deviations(problem, rig, scale)


def _make_problem(
    points: F64, observations: Sequence[BoardObservation], rig: RigEstimate, bases: Sequence[F64], fixed: int
) -> _Problem:
    counts = [len(s.corners.ids) for s in observations]
    pose_is_free = np.arange(len(bases)) != fixed
    seen = {s.camera for s in observations}
    bases = [basis if c in seen else basis[:, :0] for c, basis in enumerate(bases)]
    pose_is_free &= np.isin(np.arange(len(bases)), sorted(seen))
    sizes = np.array([basis.shape[1] for basis in bases]) + 6 * pose_is_free
    camera_at = np.concatenate([[0], np.cumsum(sizes)])
    board_at = np.full(len(rig.board_shift), -1)
    moments = np.unique([s.moment for s in observations])
    board_at[moments] = camera_at[-1] + 6 * np.arange(len(moments))
    return _Problem(
        np.concatenate([points[s.corners.ids] for s in observations]),
        np.concatenate([s.corners.pixels for s in observations]),
        np.repeat([s.camera for s in observations], counts),
        np.repeat([s.moment for s in observations], counts),
        tuple(bases), camera_at[:-1], pose_is_free, board_at, int(camera_at[-1] + 6 * len(moments)),
    )  # fmt: skip


def _in_world(problem: _Problem, rig: RigEstimate) -> F64:
    turned = np.einsum("nij,nj->ni", rig.board_rotation[problem.moment], problem.points)
    return turned + rig.board_shift[problem.moment]


def _in_camera(problem: _Problem, rig: RigEstimate) -> F64:
    return np.einsum("nij,nj->ni", rig.R[problem.camera], _in_world(problem, rig)) + rig.t[problem.camera]


def _reprojection_distances(problem: _Problem, rig: RigEstimate) -> F64:
    """(n,) pixels from each corner to its projection; infinite behind the camera."""
    inside = _in_camera(problem, rig)
    ahead = inside[:, 2] > 0
    away = np.full(len(inside), np.inf)
    at = project_points(inside[ahead], rig.intrinsics[problem.camera[ahead]])
    away[ahead] = np.linalg.norm(at - problem.pixels[ahead], axis=1)
    return away


def _cost(problem: _Problem, rig: RigEstimate, scale: float) -> float:
    return float(scale**2 * np.sum(np.log1p((_reprojection_distances(problem, rig) / scale) ** 2)))


def _minimise(problem: _Problem, rig: RigEstimate, scale: float) -> RigEstimate:
    cost, damping = _cost(problem, rig, scale), BUNDLE_FIRST_DAMPING
    for _ in range(BUNDLE_MAX_STEPS):
        H, g = _normal_equations(problem, rig, scale)
        diagonal = np.maximum(H.diagonal(), 1e-12)
        improved = False
        while damping < BUNDLE_MAX_DAMPING and not improved:
            step = splu(csc_array(H + diags_array(damping * diagonal))).solve(-g)
            moved = _apply_step(problem, rig, step)
            after = _cost(problem, moved, scale)
            improved = after < cost
            damping = damping / 10 if improved else damping * 10
        if not improved:
            return rig
        done = cost - after <= BUNDLE_COST_TOLERANCE * cost
        rig, cost = moved, after
        if done:
            return rig
    log.info("bundle adjustment: %d steps were not enough", BUNDLE_MAX_STEPS)
    return rig


def _normal_equations(problem: _Problem, rig: RigEstimate, scale: float) -> tuple[csc_array[np.float64], F64]:
    """Reweighted normal equations: J^T W J and J^T W r, W = 1 / (1 + |r|^2 / f^2)."""
    world = _in_world(problem, rig)
    R = rig.R[problem.camera]
    seen = np.einsum("nij,nj->ni", R, world)
    at, by_point, by_intrinsics = project_points_with_derivatives(
        seen + rig.t[problem.camera], rig.intrinsics[problem.camera]
    )
    residual = at - problem.pixels
    weight = 1 / (1 + np.sum(residual**2, axis=1) / scale**2)
    by_world = by_point @ R
    by_camera = np.concatenate([-by_point @ _cross(seen), by_point], axis=2)
    by_board = np.concatenate([-by_world @ _cross(world - rig.board_shift[problem.moment]), by_world], axis=2)
    root = np.sqrt(weight)[:, None]
    J = _jacobian(problem, by_intrinsics * root[..., None], by_camera * root[..., None], by_board * root[..., None])
    return csc_array(J.T @ J), J.T @ (residual * root).ravel()


def _cross(v: F64) -> F64:
    """(n, 3, 3) matrices of the cross product v x."""
    out = np.zeros((len(v), 3, 3))
    out[:, 0, 1], out[:, 0, 2], out[:, 1, 2] = -v[:, 2], v[:, 1], -v[:, 0]
    out[:, 1, 0], out[:, 2, 0], out[:, 2, 1] = v[:, 2], -v[:, 1], v[:, 0]
    return out


def _jacobian(problem: _Problem, by_intrinsics: F64, by_camera: F64, by_board: F64) -> csc_array[np.float64]:
    blocks: list[tuple[NDArray[np.int64], NDArray[np.int64], F64]] = []  # corners, columns, values
    everything = np.arange(len(problem.pixels))
    blocks.append((everything, problem.board_at[problem.moment], by_board))
    for c, basis in enumerate(problem.bases):
        mine = everything[problem.camera == c]
        start = np.full(len(mine), problem.camera_at[c])
        if len(mine) and basis.shape[1]:
            blocks.append((mine, start, by_intrinsics[mine] @ basis))
        if len(mine) and problem.pose_is_free[c]:
            blocks.append((mine, start + basis.shape[1], by_camera[mine]))
    rows = [np.broadcast_to((2 * i)[:, None, None] + [[0], [1]], v.shape).ravel() for i, _, v in blocks]
    columns = [np.broadcast_to(s[:, None, None] + np.arange(v.shape[2]), v.shape).ravel() for _, s, v in blocks]
    values = np.concatenate([v.ravel() for _, _, v in blocks])
    shape = (2 * len(problem.pixels), problem.unknowns)
    return csc_array(coo_array((values, (np.concatenate(rows), np.concatenate(columns))), shape=shape))


def _apply_step(problem: _Problem, rig: RigEstimate, step: F64) -> RigEstimate:
    intrinsics, R, t = rig.intrinsics.copy(), rig.R.copy(), rig.t.copy()
    board_rotation, board_shift = rig.board_rotation.copy(), rig.board_shift.copy()
    for c, basis in enumerate(problem.bases):
        start = problem.camera_at[c]
        intrinsics[c] += basis @ step[start : start + basis.shape[1]]
        if problem.pose_is_free[c]:
            pose = step[start + basis.shape[1] :][:6]
            R[c] = Rotation.from_rotvec(pose[:3]).as_matrix() @ R[c]
            t[c] += pose[3:]
    here = np.flatnonzero(problem.board_at >= 0)
    poses = step[problem.board_at[here][:, None] + np.arange(6)]
    board_rotation[here] = Rotation.from_rotvec(poses[:, :3]).as_matrix() @ board_rotation[here]
    board_shift[here] += poses[:, 3:]
    return replace(rig, intrinsics=intrinsics, R=R, t=t, board_rotation=board_rotation, board_shift=board_shift)


def _focal_deviations(problem: _Problem, rig: RigEstimate, scale: float) -> F64:
    """From the inverse of the normal equations, times the residual variance estimated from its median."""
    out = np.full(len(problem.bases), np.nan)
    free = [c for c, basis in enumerate(problem.bases) if basis.shape[1]]
    if not free:
        return out
    H, _ = _normal_equations(problem, rig, scale)
    solver = splu(csc_array(H + diags_array(1e-12 * np.maximum(H.diagonal(), 1e-12))))
    # the median of a Rayleigh distribution is 1.1774 of its scale
    variance = (float(np.median(_reprojection_distances(problem, rig))) / 1.1774) ** 2
    for c in free:
        basis = problem.bases[c]
        direction = np.zeros(problem.unknowns)
        direction[problem.camera_at[c] : problem.camera_at[c] + basis.shape[1]] = basis[0]
        out[c] = np.sqrt(max(variance * float(direction @ solver.solve(direction)), 0.0))
    return out
