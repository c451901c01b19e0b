"""Primitives that a person inserts where stereo must fail: glass and mirrors, balls and table tops.

    sphere:CX,CY,CZ,R                           centre and radius
    plane:PX,PY,PZ,NX,NY,NZ,EXTENT[,DEPTH]      middle, normal towards the cameras, half the side of a square, and up to
                                                what distance on both sides the old surface is replaced

All in world units of the capture.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError, ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.proxy.background import add_seen_faces
from eigenfield.proxy.primitives.clip import clip_mesh, split_long_edges
from eigenfield.proxy.topology import face_patches, remove_unused_vertices

log = logging.getLogger("eigenfield.proxy")

SPHERE_SUBDIVISIONS = 4  # of an icosahedron: 5120 triangles, 0.06 % of the radius off the sphere
PLANE_SIDE_CELLS = 16
PRIMITIVE_SHELL_SIZES = 0.08  # a loose piece this near outside the primitive is a remnant of the old surface
PLANE_DEPTH_EXTENTS = 0.1
PRIMITIVE_EDGES_PER_SIZE = 8  # the old mesh is at least so fine where it is cut


@dataclass(frozen=True)
class SpherePrimitive:
    """A sphere.

    Attributes:
        centre: x, y, z in the world.
        radius: World units.
    """

    centre: tuple[float, float, float]
    radius: float

    @property
    def size(self) -> float:
        """The radius."""
        return self.radius

    def moved(self, shift: NDArray[np.float64]) -> SpherePrimitive:
        """The sphere elsewhere, by (3,)."""
        x, y, z = (np.array(self.centre) + shift).tolist()
        return replace(self, centre=(x, y, z))

    def distance(self, positions: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) signed distance from the sphere, negative inside."""
        return np.asarray(np.linalg.norm(positions - self.centre, axis=1) - self.radius)

    def mesh(self, cameras: Sequence[Camera]) -> Mesh:
        """The whole sphere.

        Args:
            cameras: Not used.
        """
        import trimesh

        shape = trimesh.creation.icosphere(SPHERE_SUBDIVISIONS)
        vertices = np.asarray(shape.vertices) * self.radius + self.centre
        return Mesh(vertices.astype(np.float32), np.asarray(shape.faces).astype(np.int32))

    def __str__(self) -> str:
        return "sphere:" + ",".join(f"{x:.9g}" for x in (*self.centre, self.radius))


@dataclass(frozen=True)
class PlanePrimitive:
    """A square of a plane.

    Attributes:
        middle: In the world.
        normal: Unit normal in the world.
        extent: Half the side.
        depth: The old surface is replaced up to this distance on both sides.
    """

    middle: tuple[float, float, float]
    normal: tuple[float, float, float]
    extent: float
    depth: float

    @property
    def size(self) -> float:
        """Half the side."""
        return self.extent

    def moved(self, shift: NDArray[np.float64]) -> PlanePrimitive:
        """The plane elsewhere, by (3,)."""
        x, y, z = (np.array(self.middle) + shift).tolist()
        return replace(self, middle=(x, y, z))

    def axes(self) -> NDArray[np.float64]:
        """(3, 3): two directions along the sides, the first as level as possible (y is vertical), and the normal."""
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
        """The square, facing most of the cameras."""
        steps = np.linspace(-self.extent, self.extent, PLANE_SIDE_CELLS + 1)
        a, b = (grid.ravel() for grid in np.meshgrid(steps, steps))
        vertices = np.stack([a, b, np.zeros_like(a)], axis=1) @ self.axes() + self.middle
        side = PLANE_SIDE_CELLS + 1
        first = (np.arange(PLANE_SIDE_CELLS)[:, None] * side + np.arange(PLANE_SIDE_CELLS)).ravel()
        halves = ((first, first + 1, first + side), (first + 1, first + side + 1, first + side))
        faces = np.concatenate([np.stack(half, axis=1) for half in halves])
        towards = sum(np.sign((camera.centre - self.middle) @ self.normal) for camera in cameras)
        return Mesh(vertices.astype(np.float32), (faces if towards >= 0 else faces[:, ::-1]).astype(np.int32))

    def __str__(self) -> str:
        return "plane:" + ",".join(f"{x:.9g}" for x in (*self.middle, *self.normal, self.extent, self.depth))


Primitive = SpherePrimitive | PlanePrimitive


def parse_primitive(text: str) -> Primitive:
    """A primitive from its text form; see the module.

    Args:
        text: `sphere:CX,CY,CZ,R` or `plane:PX,PY,PZ,NX,NY,NZ,EXTENT[,DEPTH]`.

    Raises:
        OptionError: `primitive`.
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
        return SpherePrimitive((numbers[0], numbers[1], numbers[2]), numbers[3])
    normal = np.array(numbers[3:6])
    length = float(np.linalg.norm(normal))
    depth = numbers[7] if len(numbers) == 8 else PLANE_DEPTH_EXTENTS * numbers[6]
    if length < 1e-12 or numbers[6] <= 0 or depth <= 0:
        raise OptionError(
            "primitive",
            f"{text!r}: the normal, the extent or the depth is zero or negative",
            remedy="give a normal with a length, and an extent and a depth above 0",
        )
    nx, ny, nz = (normal / length).tolist()
    return PlanePrimitive((numbers[0], numbers[1], numbers[2]), (nx, ny, nz), numbers[6], depth)


def insert_primitive(mesh: Mesh, primitive: Primitive, cameras: Sequence[Camera]) -> Mesh:
    """The mesh with the primitive in place of what lay inside it.

    Triangles are cut where they cross the primitive's surface, so that the border has no gap and no overlap. Loose
    remnants just outside it are removed too. Of the primitive, the faces that some camera sees are inserted, with those
    next to them. UVs are dropped.

    Raises:
        ProxyError: `primitive-not-seen`; `primitive-camera-inside`: a camera stands in it.
    """
    for number, camera in enumerate(cameras, 1):
        if primitive.distance(camera.centre[None])[0] <= 0:
            raise ProxyError(
                "primitive-camera-inside",
                f"camera {number} of {len(cameras)} stands inside {primitive}",
                remedy="the primitive is given in world units of the capture: check its centre and size",
            )
    fine = split_long_edges(mesh, primitive.distance, primitive.size / PRIMITIVE_EDGES_PER_SIZE)
    outside = _remove_remnants(clip_mesh(fine, primitive.distance), primitive)
    result, put_in = add_seen_faces(outside, primitive.mesh(cameras), cameras)
    if not put_in:
        raise ProxyError(
            "primitive-not-seen",
            f"{primitive} is seen by none of the {len(cameras)} cameras",
            remedy="it lies outside their frames, behind them, or behind the surface: check its place",
        )
    log.info("%s: %d triangles of the mesh gave way to %d", primitive, len(fine.faces) - len(outside.faces), put_in)
    return result


def _remove_remnants(mesh: Mesh, primitive: Primitive) -> Mesh:
    """Drop patches that lie wholly in a thin shell around the primitive: noise of the replaced surface."""
    if len(mesh.faces) == 0:
        return mesh
    label = face_patches(mesh.faces)
    farthest = primitive.distance(mesh.vertices.astype(np.float64))[mesh.faces].max(axis=1)
    reach = np.full(int(label.max()) + 1, -np.inf)
    np.maximum.at(reach, label, farthest)
    kept = reach[label] > PRIMITIVE_SHELL_SIZES * primitive.size
    return remove_unused_vertices(Mesh(mesh.vertices, mesh.faces[kept]))
