"""Whether a mesh lies where the photographs say: how well they agree on it, and on the same mesh placed otherwise.

Points of the surface are looked up in small copies of a few photographs that see them. What these differ by at a point,
over the contrast of all, is the part of the contrast that the mesh does not explain. Axes of another program, a factor
or a shift are found by trying them.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh, triangle_areas
from eigenfield.core.observations import Observations, cameras_of
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.surface.neighbours import spread_views
from eigenfield.runtime.parallel import parallel_map

PLACEMENT_VIEWS = 4  # spread over the array, and the nearest one of each
PLACEMENT_SIDE_PIXELS = 128  # longest side of the copies
PLACEMENT_POINTS = 3000, 24_000  # of the surface, for every placement and for the best ones
PLACEMENT_CELLS = 24, 48  # along the longest side of a picture, in which the nearest points hide others, likewise
PLACEMENT_DEPTH_TOLERANCE = 0.05  # of the nearest depth of a cell, up to which points of it are seen
PLACEMENT_MIN_SAMPLES = 200  # colours of points that two views see: with less nothing is known
PLACEMENT_SCALES = (*(1.1**power for power in (*range(-8, 0), *range(1, 9))), 1e-3, 0.01, 0.0254, 0.1, 0.3048,
                    1 / 0.3048, 10.0, 1 / 0.0254, 100.0, 1e3)  # fmt: skip
PLACEMENT_SHIFTS = 0.05, 0.1, 0.2  # of the usual distance of the cameras, along each axis
# Another placement is better if it leaves less unexplained, by both of these:
PLACEMENT_MAX_RATIO = {"axes": 0.8, "scale": 0.6, "shift": 0.6}  # real meshes placed rightly: all others 1.19 and more
PLACEMENT_MIN_DIFFERENCE = 0.02
PLACEMENT_MIN_UNEXPLAINED = 0.04  # by the mesh as it is, from which on others are tried
PLACEMENT_MAX_UNEXPLAINED = 0.5  # of a better one
PLACEMENT_MIN_SHARE = 0.5  # of the samples and of the covered pictures, beside the mesh as it is
PLACEMENT_MIN_COVERAGE = 0.25  # of the pictures without masks


class Placement(NamedTuple):
    """Points of a mesh file go from p to `matrix` p + `shift`.

    Attributes:
        kind: A key of PLACEMENT_MAX_RATIO; "" for the mesh as it is.
        words: The mesh is so, for people.
        matrix: (3, 3).
        shift: (3,).
    """

    kind: str
    words: str
    matrix: NDArray[np.float64]
    shift: NDArray[np.float64]


class Agreement(NamedTuple):
    """How photographs agree on a mesh.

    Attributes:
        unexplained: Part of their contrast by which they differ at points of the mesh, 0..1.
        samples: Number of colours that were compared.
        covered: Part of the pictures, 0..1.
    """

    unexplained: float
    samples: int
    covered: float


class _Copy(NamedTuple):
    """A small photograph: (h, w, 3) its pixels, (h, w) which of them count, (3, 4) from world to pixels."""

    pixels: NDArray[np.float32]
    counts: NDArray[np.bool_]
    matrix: NDArray[np.float64]


def describe_placement(
    mesh: Mesh,
    cameras: Sequence[Camera],
    observations: Observations,
    origin: NDArray[np.float64] | None = None,
    path: Path | None = None,
) -> list[str]:
    """A line if the photographs agree clearly better on the mesh in other axes, larger, smaller or moved, or if it
    covers little of them; none where it fits.

    Args:
        mesh: In the cameras' world.
        observations: The photographs, of which a few are decoded.
        origin: (3,) the origin of the cameras' world in that of the mesh's file. None: they are the same.
    """
    first = {camera: index for index, camera in reversed(list(enumerate(cameras_of(observations).tolist())))}
    views = [view for view in _chosen_views(cameras) if view in first]
    copies = parallel_map(lambda view: _shrink(observations, first[view], cameras[view]), views)
    found = _better_placement(mesh, cameras, copies, np.zeros(3) if origin is None else origin)
    look = "look at cameras and mesh (`eigenfield inspect CAPTURE --proxy MESH --overlay overlay.png`)"
    if found is not None:
        placement, then, now = found
        return [
            f"{path or 'mesh'}: the photographs agree better on this mesh {placement.words}: they would differ by "
            f"{100 * then.unexplained:.0f} % of their contrast, and not by {100 * now.unexplained:.0f} %; {look}"
        ]
    if not all(copy.counts.all() for copy in copies):
        return []
    covered = float(np.mean([(rasterise_view(mesh, _small(cameras[view])).face >= 0).mean() for view in views]))
    if covered >= PLACEMENT_MIN_COVERAGE:
        return []
    words = f"the mesh covers {100 * covered:.0f} % of the photographs, and nothing is drawn beside it"
    return [f"{path or 'mesh'}: {words}; if that is not meant, {look}"]


def _better_placement(
    mesh: Mesh, cameras: Sequence[Camera], copies: Sequence[_Copy], origin: NDArray[np.float64]
) -> tuple[Placement, Agreement, Agreement] | None:
    """The placement on which photographs agree clearly better, how they do, and how on the mesh as it is; or None."""

    def measure(level: int, chosen: Sequence[Placement]) -> list[Agreement]:
        points = _surface_points(mesh, PLACEMENT_POINTS[level]) + origin
        return parallel_map(
            lambda one: _agreement(points @ one.matrix.T + one.shift - origin, copies, PLACEMENT_CELLS[level]), chosen
        )

    placements = _placements(mesh, cameras)
    if measure(1, placements[:1])[0].unexplained <= PLACEMENT_MIN_UNEXPLAINED:
        return None
    coarse = measure(0, placements)
    best = [placements[0]]
    for kind in PLACEMENT_MAX_RATIO:
        ranked = sorted(
            (agreement.unexplained, number)
            for number, (one, agreement) in enumerate(zip(placements, coarse, strict=True))
            if one.kind == kind and _has_evidence(agreement, coarse[0])
        )
        best += [placements[number] for _, number in ranked[:2]]
    now, *then = measure(1, best)
    if now.samples < PLACEMENT_MIN_SAMPLES and now.covered > 1 / PLACEMENT_CELLS[1]:
        return None  # seen, but by one view at a time
    better = [
        (agreement.unexplained, number)
        for number, (one, agreement) in enumerate(zip(best[1:], then, strict=True))
        if agreement.unexplained
        <= min(PLACEMENT_MAX_RATIO[one.kind] * now.unexplained, now.unexplained - PLACEMENT_MIN_DIFFERENCE)
        and agreement.unexplained <= PLACEMENT_MAX_UNEXPLAINED
        and _has_evidence(agreement, now)
    ]
    if not better:
        return None
    number = min(better)[1]
    return best[1 + number], then[number], now


def _has_evidence(agreement: Agreement, now: Agreement) -> bool:
    least = max(PLACEMENT_MIN_SAMPLES, PLACEMENT_MIN_SHARE * now.samples)
    return agreement.samples >= least and agreement.covered >= PLACEMENT_MIN_SHARE * now.covered


def _chosen_views(cameras: Sequence[Camera]) -> list[int]:
    chosen = spread_views(cameras, PLACEMENT_VIEWS)
    centres = np.array([camera.centre for camera in cameras])
    for view in tuple(chosen):
        distance = np.linalg.norm(centres - centres[view], axis=1)
        distance[chosen] = np.inf
        if np.isfinite(distance).any():
            chosen.append(int(distance.argmin()))
    return sorted(chosen)


def _small(camera: Camera) -> Camera:
    scale = PLACEMENT_SIDE_PIXELS / max(camera.width, camera.height)
    return camera.resize(max(1, round(scale * camera.width)), max(1, round(scale * camera.height)))


def _shrink(observations: Observations, index: int, camera: Camera) -> _Copy:
    photograph = observations.photograph(index)
    height, width = photograph.pixels.shape[:2]
    scale = PLACEMENT_SIDE_PIXELS / max(width, height)
    size = max(1, round(scale * width)), max(1, round(scale * height))
    pixels = cv2.resize(photograph.pixels, size, interpolation=cv2.INTER_AREA).reshape(size[1], size[0], -1)
    counts = np.ones((size[1], size[0]), bool)
    if photograph.mask is not None:
        counts = cv2.resize(photograph.mask, size, interpolation=cv2.INTER_AREA) > 0.5
    return _Copy(
        np.asarray(pixels, np.float32), counts, np.diag([size[0] / width, size[1] / height, 1]) @ camera.matrix
    )


def _placements(mesh: Mesh, cameras: Sequence[Camera]) -> list[Placement]:
    same, still = np.eye(3), np.zeros(3)
    found = [Placement("", "", same, still)]
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            matrix = np.array(signs)[:, None] * same[list(order)]
            names = ", ".join(("" if sign > 0 else "-") + "xyz"[axis] for sign, axis in zip(signs, order, strict=True))
            if names != "x, y, z":
                found.append(Placement("axes", f"with its x, y, z taken as {names}", matrix, still))
    found += [Placement("scale", f"{scale:.3g} times as large", scale * same, still) for scale in PLACEMENT_SCALES]
    middle = np.median(mesh.vertices.astype(np.float64), axis=0)
    away = float(np.median([np.linalg.norm(camera.centre - middle) for camera in cameras]))
    for axis, share, sign in itertools.product(range(3), PLACEMENT_SHIFTS, (1, -1)):
        words = f"moved by {sign * share * away:.3g} along {'xyz'[axis]}"
        found.append(Placement("shift", words, same, sign * share * away * same[axis]))
    return found


def _surface_points(mesh: Mesh, count: int) -> NDArray[np.float64]:
    """At most `count` points of the surface: half of them evenly over its area, but fewer far outside, the rest at
    vertices, which are many where there is detail."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    away = mesh.vertices - np.median(mesh.vertices.astype(np.float64), axis=0)
    reach = (away**2).sum(axis=1)
    area = np.cumsum(triangle_areas(corners) / (reach[mesh.faces].min(axis=1) + np.median(reach)))
    number = np.arange(count // 2)
    face = np.searchsorted(area, (number + 0.5) / len(number) * area[-1])
    a, b = (number * step % 1 for step in (0.7548776662466927, 0.5698402909980532))  # Roberts's R2 sequence
    a, b = np.where(a + b > 1, 1 - a, a), np.where(a + b > 1, 1 - b, b)
    chosen = corners[np.minimum(face, len(corners) - 1)]
    inside = chosen[:, 0] + a[:, None] * (chosen[:, 1] - chosen[:, 0]) + b[:, None] * (chosen[:, 2] - chosen[:, 0])
    return np.concatenate([inside, mesh.vertices[:: -(-2 * len(mesh.vertices) // count)].astype(np.float64)])


def _agreement(points: NDArray[np.float64], copies: Sequence[_Copy], cells: int) -> Agreement:
    """How small photographs agree at points (n, 3) of the world."""
    times, total, squares = (
        np.zeros(len(points)),
        np.zeros((len(points), copies[0].pixels.shape[2])),
        np.zeros(len(points)),
    )
    covered = []
    for copy in copies:
        height, width = copy.counts.shape
        across, down, depth = (points @ copy.matrix[:, :3].T + copy.matrix[:, 3]).T
        with np.errstate(divide="ignore", invalid="ignore"):
            x, y = across / depth, down / depth
        seen = np.flatnonzero((depth > 0) & (x >= 0) & (x < width) & (y >= 0) & (y < height))
        x, y, depth = x[seen].astype(np.int64), y[seen].astype(np.int64), depth[seen]
        side = -(-max(width, height) // cells)
        columns, rows = -(-width // side), -(-height // side)
        cell = y // side * columns + x // side
        nearest = np.full(columns * rows, np.inf)
        np.minimum.at(nearest, cell, depth)
        covered.append(np.isfinite(nearest).mean())
        front = (depth <= (1 + PLACEMENT_DEPTH_TOLERANCE) * nearest[cell]) & copy.counts[y, x]
        colours = copy.pixels[y[front], x[front]].astype(np.float64)
        times[seen[front]] += 1
        total[seen[front]] += colours
        squares[seen[front]] += (colours**2).sum(axis=1)
    compared = times >= 2
    times, total, squares = times[compared], total[compared], squares[compared]
    count = int(times.sum())
    if count < PLACEMENT_MIN_SAMPLES:
        return Agreement(1.0, count, float(np.mean(covered)))
    within = float((squares - (total**2).sum(axis=1) / times).sum()) / (count - len(times))
    contrast = float(squares.sum() - (total.sum(axis=0) ** 2).sum() / count) / (count - 1)
    return Agreement(within / contrast if contrast > 0 else 1.0, count, float(np.mean(covered)))
