"""Rays in the demo's scene: triangles in a tree of boxes, mirrors and glass balls as exact spheres."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.runtime.jit import kernel

TREE_LEAF_TRIANGLES = 4  # at most
GLASS_INDEX = 1.5  # of refraction
RAY_START_UNITS = 1e-5  # what is nearer is the surface that a ray leaves


class Tree(NamedTuple):
    """A complete binary tree of boxes around triangles; the children of box k are 2 k + 1 and 2 k + 2.

    Attributes:
        boxes: (2 L - 1, 6) lowest and highest corner; the last L boxes hold triangles.
        triangles: (L, k, 3, 5) position and chart coordinates of the corners of each box's triangles.
    """

    boxes: NDArray[np.float64]
    triangles: NDArray[np.float64]


def build_tree(mesh: Mesh) -> Tree:
    """Triangles halved at the median of the longest side of their centres' box, level by level.

    Some triangles stand in two boxes where their number asks for it.

    Args:
        mesh: With an atlas.
    """
    assert mesh.uv is not None
    corners = np.concatenate([mesh.vertices, mesh.uv], axis=1).astype(np.float64)[mesh.faces]
    levels = int(np.ceil(np.log2(len(corners) / TREE_LEAF_TRIANGLES)))
    order = np.resize(np.arange(len(corners)), -(-len(corners) // 2**levels) * 2**levels)[None]
    middle = corners[..., :3].mean(axis=1)
    boxes = []
    for level in range(levels + 1):
        inside = corners[order][..., :3]
        boxes.append(np.concatenate([inside.min(axis=(1, 2)), inside.max(axis=(1, 2))], axis=1))
        if level < levels:
            points = middle[order]
            axis = (points.max(axis=1) - points.min(axis=1)).argmax(axis=1)
            along = np.take_along_axis(points, axis[:, None, None], axis=2)[..., 0]
            order = np.take_along_axis(order, along.argsort(axis=1, kind="stable"), axis=1)
            order = order.reshape(2 ** (level + 1), -1)
    return Tree(np.concatenate(boxes), corners[order])


@kernel(inline=True)
def _box_distance(box, origin, inverse, far):
    """Distance at which a ray enters a box; infinite where it misses it or enters beyond `far`."""
    near, away = 0.0, far
    for c in range(3):
        a, b = (box[c] - origin[c]) * inverse[c], (box[c + 3] - origin[c]) * inverse[c]
        near, away = max(near, min(a, b)), min(away, max(a, b))
    return near if near <= away else np.inf


@kernel()
def nearest_triangle(boxes, triangles, origin, ray, far, stack, place):
    """The nearest triangle that a ray meets.

    Args:
        boxes: Of a Tree.
        triangles: Of a Tree.
        origin: (3,).
        ray: (3,) of length 1.
        far: Only nearer triangles count.
        stack: (64,) int64, scratch.
        place: (2,) chart coordinates of the point, written.

    Returns:
        Its distance; infinite where there is none.
    """
    inverse = (1.0 / ray[0], 1.0 / ray[1], 1.0 / ray[2])
    first = triangles.shape[0] - 1
    best = np.inf
    waiting, stack[0] = 1, 0
    while waiting > 0:
        waiting -= 1
        node = stack[waiting]
        if _box_distance(boxes[node], origin, inverse, far) == np.inf:
            continue
        if node < first:
            left = 2 * node + 1
            a = _box_distance(boxes[left], origin, inverse, far)
            b = _box_distance(boxes[left + 1], origin, inverse, far)
            nearer = left if a <= b else left + 1
            if max(a, b) < np.inf:
                stack[waiting] = 2 * left + 1 - nearer
                waiting += 1
            if min(a, b) < np.inf:
                stack[waiting] = nearer
                waiting += 1
            continue
        for k in range(triangles.shape[1]):  # Moeller and Trumbore, 1997
            p = triangles[node - first, k]
            e0, e1, e2 = p[1, 0] - p[0, 0], p[1, 1] - p[0, 1], p[1, 2] - p[0, 2]
            f0, f1, f2 = p[2, 0] - p[0, 0], p[2, 1] - p[0, 1], p[2, 2] - p[0, 2]
            c0, c1, c2 = ray[1] * f2 - ray[2] * f1, ray[2] * f0 - ray[0] * f2, ray[0] * f1 - ray[1] * f0
            volume = e0 * c0 + e1 * c1 + e2 * c2
            if volume == 0.0:
                continue
            s0, s1, s2 = origin[0] - p[0, 0], origin[1] - p[0, 1], origin[2] - p[0, 2]
            u = (s0 * c0 + s1 * c1 + s2 * c2) / volume
            if u < 0.0 or u > 1.0:
                continue
            q0, q1, q2 = s1 * e2 - s2 * e1, s2 * e0 - s0 * e2, s0 * e1 - s1 * e0
            v = (ray[0] * q0 + ray[1] * q1 + ray[2] * q2) / volume
            distance = (f0 * q0 + f1 * q1 + f2 * q2) / volume
            if v >= 0.0 and u + v <= 1.0 and RAY_START_UNITS < distance < far:
                best = far = distance
                place[0] = p[0, 3] + u * (p[1, 3] - p[0, 3]) + v * (p[2, 3] - p[0, 3])
                place[1] = p[0, 4] + u * (p[1, 4] - p[0, 4]) + v * (p[2, 4] - p[0, 4])
    return best


@kernel()
def sphere_distance(origin, ray, sphere):
    """Distance of a ray to a sphere that it enters; infinite where there is none.

    Args:
        origin: (3,).
        ray: (3,) of length 1.
        sphere: (4,) centre and radius.
    """
    x, y, z = sphere[0] - origin[0], sphere[1] - origin[1], sphere[2] - origin[2]
    along = x * ray[0] + y * ray[1] + z * ray[2]
    rest = sphere[3] * sphere[3] - (x * x + y * y + z * z - along * along)
    if rest <= 0.0:
        return np.inf
    distance = along - np.sqrt(rest)
    return distance if distance > RAY_START_UNITS else np.inf


@kernel(inline=True)
def _meet_sphere(origin, ray, sphere, distance):
    """Move a ray to a sphere's surface, in place; the cosine of incidence."""
    cosine = 0.0
    for c in range(3):
        origin[c] += distance * ray[c]
        cosine -= ray[c] * (origin[c] - sphere[c]) / sphere[3]
    return cosine


@kernel()
def mirror_ray(origin, ray, sphere, distance):
    """Move a ray to a sphere's surface and reflect it, in place.

    Args:
        origin: (3,).
        ray: (3,) of length 1.
        sphere: (4,) centre and radius.
        distance: To the surface.

    Returns:
        The cosine of incidence.
    """
    cosine = _meet_sphere(origin, ray, sphere, distance)
    for c in range(3):
        ray[c] += 2.0 * cosine * (origin[c] - sphere[c]) / sphere[3]
    return cosine


@kernel()
def refract_ray(origin, ray, sphere, distance):
    """Move a ray through a glass sphere, in place.

    Args:
        origin: (3,).
        ray: (3,) of length 1.
        sphere: (4,) centre and radius.
        distance: To the surface.

    Returns:
        The length of its way in the glass.
    """
    cosine = _meet_sphere(origin, ray, sphere, distance)
    within = np.sqrt(1.0 - (1.0 - cosine * cosine) / (GLASS_INDEX * GLASS_INDEX))
    chord = 2.0 * sphere[3] * within
    for c in range(3):
        ray[c] = ray[c] / GLASS_INDEX + (cosine / GLASS_INDEX - within) * (origin[c] - sphere[c]) / sphere[3]
    for c in range(3):  # it leaves at the angle at which it came
        origin[c] += chord * ray[c]
        ray[c] = GLASS_INDEX * ray[c] - (GLASS_INDEX * within - cosine) * (origin[c] - sphere[c]) / sphere[3]
    return chord


@kernel()
def glass_reflectance(cosine):
    """Fresnel's reflectance of glass for unpolarised light.

    Args:
        cosine: Of incidence.
    """
    within = np.sqrt(1.0 - (1.0 - cosine * cosine) / (GLASS_INDEX * GLASS_INDEX))
    across = (cosine - GLASS_INDEX * within) / (cosine + GLASS_INDEX * within)
    along = (GLASS_INDEX * cosine - within) / (GLASS_INDEX * cosine + within)
    return 0.5 * (across * across + along * along)
