"""Shapes put into the mesh by hand, where stereo must fail: glass and mirrors, balls and table tops.

    sphere:CX,CY,CZ,R                           centre and radius
    plane:PX,PY,PZ,NX,NY,NZ,EXTENT[,DEPTH]      middle, normal towards the cameras, half the side of a square, and up to
                                                what distance from it on both sides the old surface gives way

All in world units of the capture.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError, ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.proxy.background import joined, seen_faces, with_ring
from eigenfield.proxy.primitives.clip import clipped, split_long_edges
from eigenfield.proxy.topology import compact, patches

log = logging.getLogger("eigenfield.proxy")

SPHERE_LEVEL = 4  # subdivisions of an icosahedron: 5120 triangles, 0.06 % of the radius off the sphere
PLANE_CELLS = 16  # a side
SHELL = 0.08  # of the size: a loose piece that lies this near outside the primitive is the old surface's rest
PLANE_DEPTH = 0.1  # of the extent
FINE = 8  # parts of the size: the old mesh is at least so fine where it is cut


@dataclass(frozen=True)
class Sphere:
    """centre: x, y, z in the world. radius: world units."""

    centre: tuple[float, float, float]
    radius: float

    @property
    def size(self) -> float:
        return self.radius

    def distance(self, positions: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) signed distance of points (n, 3) from the sphere, negative inside."""
        return np.asarray(np.linalg.norm(positions - self.centre, axis=1) - self.radius)

    def mesh(self, cameras: Sequence[Camera]) -> Mesh:
        """The whole sphere."""
        import trimesh

        shape = trimesh.creation.icosphere(SPHERE_LEVEL)
        vertices = np.asarray(shape.vertices) * self.radius + self.centre
        return Mesh(vertices.astype(np.float32), np.asarray(shape.faces).astype(np.int32))

    def __str__(self) -> str:
        return "sphere:" + ",".join(f"{x:.9g}" for x in (*self.centre, self.radius))


@dataclass(frozen=True)
class Plane:
    """A square of a plane.

    middle, normal: in the world, the normal of unit length. extent: half its side. depth: the old surface gives way up
    to this distance from it, on both sides.
    """

    middle: tuple[float, float, float]
    normal: tuple[float, float, float]
    extent: float
    depth: float

    @property
    def size(self) -> float:
        return self.extent

    def axes(self) -> NDArray[np.float64]:
        """(3, 3): two directions along the sides and the normal. The first lies as level as it can (y is vertical)."""
        n = np.array(self.normal)
        level = np.cross([0.0, 1.0, 0.0], n)
        if np.linalg.norm(level) < 1e-3:
            level = np.array([1.0, 0, 0]) - n[0] * n
        u = level / np.linalg.norm(level)
        return np.stack([u, np.cross(n, u), n])

    def distance(self, positions: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) the largest of the distances from the slab's sides, negative inside."""
        local = np.abs((positions - self.middle) @ self.axes().T)
        return np.asarray((local - (self.extent, self.extent, self.depth)).max(axis=1))

    def mesh(self, cameras: Sequence[Camera]) -> Mesh:
        """The square, turned towards most of the cameras."""
        steps = np.linspace(-self.extent, self.extent, PLANE_CELLS + 1)
        a, b = (grid.ravel() for grid in np.meshgrid(steps, steps))
        vertices = np.stack([a, b, np.zeros_like(a)], axis=1) @ self.axes() + self.middle
        side = PLANE_CELLS + 1
        first = (np.arange(PLANE_CELLS)[:, None] * side + np.arange(PLANE_CELLS)).ravel()
        faces = np.concatenate(
            [
                np.stack([first, first + 1, first + side], axis=1),
                np.stack([first + 1, first + side + 1, first + side], axis=1),
            ]
        )
        towards = sum(np.sign((camera.centre - self.middle) @ self.normal) for camera in cameras)
        return Mesh(vertices.astype(np.float32), (faces if towards >= 0 else faces[:, ::-1]).astype(np.int32))

    def __str__(self) -> str:
        return "plane:" + ",".join(f"{x:.9g}" for x in (*self.middle, *self.normal, self.extent, self.depth))


Primitive = Sphere | Plane


def parse_primitive(text: str) -> Primitive:
    """`sphere:CX,CY,CZ,R` or `plane:PX,PY,PZ,NX,NY,NZ,EXTENT[,DEPTH]`; see the module.

    Raises OptionError `primitive`.
    """
    kind, colon, rest = text.partition(":")
    kind = kind.strip().lower()
    forms = {"sphere": ("CX,CY,CZ,R", (4,)), "plane": ("PX,PY,PZ,NX,NY,NZ,EXTENT[,DEPTH]", (7, 8))}
    if not colon or kind not in forms:
        raise OptionError(
            "primitive",
            f"{text!r} is no primitive",
            remedy="write " + " or ".join(f"{name}:{form}" for name, (form, _) in forms.items()),
        )
    form, counts = forms[kind]
    try:
        numbers = [float(part) for part in rest.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in counts or not all(math.isfinite(x) for x in numbers):
        raise OptionError(
            "primitive", f"{text!r} does not have the right numbers", remedy=f"write {kind}:{form}, finite numbers"
        )
    if kind == "sphere":
        if numbers[3] <= 0:
            raise OptionError("primitive", f"{text!r}: the radius is not positive", remedy="give a radius above 0")
        return Sphere((numbers[0], numbers[1], numbers[2]), numbers[3])
    normal = np.array(numbers[3:6])
    length = float(np.linalg.norm(normal))
    depth = numbers[7] if len(numbers) == 8 else PLANE_DEPTH * numbers[6]
    if length < 1e-12 or numbers[6] <= 0 or depth <= 0:
        raise OptionError(
            "primitive",
            f"{text!r}: the normal, the extent or the depth is zero or negative",
            remedy="give a normal with a length, and an extent and a depth above 0",
        )
    nx, ny, nz = (normal / length).tolist()
    return Plane((numbers[0], numbers[1], numbers[2]), (nx, ny, nz), numbers[6], depth)


def insert_primitive(mesh: Mesh, primitive: Primitive, cameras: Sequence[Camera]) -> Mesh:
    """The mesh with the primitive in place of what lay inside it.

    Triangles are cut where they pass the primitive's surface, so no gap and no overlap is left at the border; loose
    rests just outside it go too. Of the primitive, what some camera sees is put in (and the triangles next to it). UVs
    are dropped. Raises ProxyError `primitive-not-seen`, and `primitive-camera-inside` where a camera stands in it.
    """
    for number, camera in enumerate(cameras, 1):
        if primitive.distance(camera.centre[None])[0] <= 0:
            raise ProxyError(
                "primitive-camera-inside",
                f"camera {number} of {len(cameras)} stands inside {primitive}",
                remedy="the primitive is given in world units of the capture: check its centre and size",
            )
    fine = split_long_edges(mesh, primitive.distance, primitive.size / FINE)
    outside = _without_rests(clipped(fine, primitive.distance), primitive)
    shape = primitive.mesh(cameras)
    both = joined(outside, shape)
    seen = seen_faces(both, cameras)[len(outside.faces) :]
    if not seen.any():
        raise ProxyError(
            "primitive-not-seen",
            f"{primitive} is seen by none of the {len(cameras)} cameras",
            remedy="it lies outside their frames, behind them, or behind the surface: check its place",
        )
    kept = np.append(np.ones(len(outside.faces), np.bool_), with_ring(shape.faces, seen))
    gone, put_in = len(fine.faces) - len(outside.faces), int(kept[len(outside.faces) :].sum())
    log.info("%s: %d triangles of the mesh gave way to %d", primitive, gone, put_in)
    return compact(Mesh(both.vertices, both.faces[kept]))


def _without_rests(mesh: Mesh, primitive: Primitive) -> Mesh:
    """Without patches that lie wholly in a thin shell around the primitive: noise of the surface that it replaces."""
    if len(mesh.faces) == 0:
        return mesh
    label = patches(mesh.faces)
    farthest = primitive.distance(mesh.vertices.astype(np.float64))[mesh.faces].max(axis=1)
    reach = np.full(int(label.max()) + 1, -np.inf)
    np.maximum.at(reach, label, farthest)
    return compact(Mesh(mesh.vertices, mesh.faces[reach[label] > SHELL * primitive.size]))
