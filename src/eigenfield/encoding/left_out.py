"""Which cameras are left out to see what a scene draws between cameras, and what these take of the others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.neighbours import (
    NEIGHBOUR_MAX_PARALLAX_RATIO,
    first_of_place,
    fit_similarity,
    nearest_pairs,
    parallax_beside,
    spread_pairs,
)
from eigenfield.core.camera import Camera
from eigenfield.core.proxy import Proxy, opaque_mesh
from eigenfield.core.rig import Rig
from eigenfield.encoding.plan import EncodePlan
from eigenfield.imaging.raster import rasterise_view, unproject
from eigenfield.rendering import delaunay_triangles
from eigenfield.rendering.weights import delaunay_weights, hull
from eigenfield.runtime.parallel import parallel_map

BETWEEN_MIN_PLACES = 5  # of encoded cameras, of which some can be left out
BETWEEN_FEW_CAMERAS = 49  # of more the finished scene tells enough, unless they are far apart
BETWEEN_PARALLAX_SIDE_PIXELS = 64  # longer side of the view in which points are taken to see how far that is
BETWEEN_MIN_SIDE_PIXELS = 128  # of smaller photographs the short way says far too little
BETWEEN_LEFT_OUT_RATIO, BETWEEN_MAX_LEFT_OUT = 1 / 4, 12  # of the cameras, at most


def has_scores(plan: EncodePlan) -> bool:
    """Whether a scene of a plan gets scores: one from five places or more, whose pictures are not tiny."""
    cameras = plan.views.rig.encoded_cameras
    large = min(min(camera.width, camera.height) for camera in cameras) >= BETWEEN_MIN_SIDE_PIXELS
    return large and len(np.unique(places_of(plan.views.rig))) >= BETWEEN_MIN_PLACES


def is_sparse(plan: EncodePlan) -> bool:
    """Whether a scene with scores has few cameras, or cameras that are far apart."""
    cameras = plan.views.rig.encoded_cameras
    if not has_scores(plan):
        return False
    return len(cameras) <= BETWEEN_FEW_CAMERAS or neighbour_parallax(cameras, plan.proxy) > NEIGHBOUR_MAX_PARALLAX_RATIO


def neighbour_parallax(cameras: Sequence[Camera], proxy: Proxy) -> float:
    """What `inspect` says of neighbouring photographs, by the surface: the median parallax, over the longer side."""
    mesh = opaque_mesh(proxy)

    def measure(pair: tuple[int, int]) -> float:
        one, other = cameras[pair[0]], cameras[pair[1]]
        scale = BETWEEN_PARALLAX_SIDE_PIXELS / max(one.width, one.height)
        small = one.resize(max(1, round(scale * one.width)), max(1, round(scale * one.height)))
        inverse_depth = rasterise_view(mesh, small).inverse_depth
        row, column = np.nonzero(inverse_depth > 0)
        points = unproject(small, row, column, inverse_depth[row, column])
        source, (target, depth) = one.project(points)[0], other.project(points)
        shared = (depth > 0) & (target > 0).all(axis=1) & (target < (other.width, other.height)).all(axis=1)
        similarity = fit_similarity(source[shared], target[shared]) if shared.sum() > 2 else None
        if similarity is None:
            return np.inf
        return parallax_beside(similarity, source[shared], target[shared]) / max(one.width, one.height)

    pairs = spread_pairs(nearest_pairs(np.array([camera.centre for camera in cameras])))
    return float(np.median(parallel_map(measure, pairs)))


def spread_inside(rig: Rig) -> list[int]:
    """Cameras to leave out, counted among the encoded ones: inside their hull if any are, and no two are neighbours.

    With a camera goes each other of its place: a twin would draw what it shows.

    The rig has cameras at BETWEEN_MIN_PLACES at least.
    """
    place = places_of(rig)
    near = _neighbours(rig, place)
    rim = set(place[hull(rig.triangles)].ravel().tolist()) or {index for index, ones in near.items() if len(ones) < 2}
    joined = [index for index, ones in near.items() if ones]
    inner = [index for index in joined if index not in rim] or joined
    gaps = _gaps(rig)
    most = min(max(1, int(len(near) * BETWEEN_LEFT_OUT_RATIO)), BETWEEN_MAX_LEFT_OUT)
    chosen: list[int] = []
    for index in sorted(inner, key=lambda i: -max(gaps[i, j] for j in near[i])):
        if not near[index] & set(chosen) and len(chosen) < most:
            chosen.append(index)
    return np.flatnonzero(np.isin(place, chosen)).tolist()


def places_of(rig: Rig) -> NDArray[np.int64]:
    """(Ne,) of each encoded camera the first of its place (`first_of_place`)."""
    return first_of_place(np.array([camera.centre for camera in rig.encoded_cameras]))


def _gaps(rig: Rig) -> NDArray[np.float64]:
    """(Ne, Ne) distances between encoded cameras, in world units."""
    centres = np.array([camera.centre for camera in rig.encoded_cameras])
    return np.asarray(np.linalg.norm(centres[:, None] - centres, axis=2))


def _neighbours(rig: Rig, place: NDArray[np.int64]) -> dict[int, set[int]]:
    """Of each place, in order, those with which it has an edge; on a line the nearest along it.

    Args:
        place: Of `places_of`.
    """
    near: dict[int, set[int]] = {index: set() for index in np.unique(place).tolist()}
    pairs = rig.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    if not len(pairs):
        places = rig.view_plane.coordinates([camera.centre for camera in rig.encoded_cameras])
        order = np.lexsort((places[:, 1], places[:, 0]))
        pairs = np.stack([order[:-1], order[1:]], axis=1)
    for a, b in place[pairs].tolist():
        if a != b:
            near[a].add(b)
            near[b].add(a)
    return near


def farthest_neighbour(rig: Rig, index: int) -> int:
    """The encoded camera, of those at the places beside, that is farthest from one."""
    place, gaps = places_of(rig), _gaps(rig)
    return max(sorted(_neighbours(rig, place)[int(place[index])]), key=lambda other: float(gaps[index, other]))


def others_around(rig: Rig, left_out: Sequence[int]) -> set[int]:
    """The encoded cameras that take part beside those left out: of few all, of many those around each.

    With all around it, a camera left out lies in the same triangle of others as with the whole array.

    Args:
        left_out: Of `spread_inside`.
    """
    if len(rig.encoded) <= BETWEEN_FEW_CAMERAS:
        taken = set(range(len(rig.encoded)))
    else:
        place = places_of(rig)
        near = _neighbours(rig, place)
        around = set().union(*(near[index] for index in set(place[list(left_out)].tolist())))
        taken = set(np.flatnonzero(np.isin(place, list(around))).tolist()) | {rig.encoded_reference}
    return taken - set(left_out)


def interpolation(rig: Rig, others: Sequence[int], left_out: Sequence[int]) -> NDArray[np.float64]:
    """(left out, others): what each camera left out takes of the others, all counted among the encoded ones."""
    places = rig.view_plane.coordinates([camera.centre for camera in rig.encoded_cameras])
    known, matrix = places[list(others)], np.zeros((len(left_out), len(others)))
    triangles = delaunay_triangles(known)
    for row, index in zip(matrix, left_out, strict=True):
        among, weights = delaunay_weights(np.clip(places[index], -1, 1), known, triangles)
        row[among] = weights
    return matrix
