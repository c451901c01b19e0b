"""A relief in as few bytes as its pictures are worth.

Vertices are taken away while that costs the pictures less than their bytes cost elsewhere; depths are fitted to those
of the given surface; then steps of depth and of contours are tried, from those of the lattice to coarser ones, and the
form is kept whose bytes and errors together are least. Where a camera sees through it, the vertices that it saw before
are kept.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import itertools
import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import cg

from eigenfield.coding.codecs import encoder
from eigenfield.core.camera import Camera
from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import Observations
from eigenfield.encoding.geometry.coded import MESH_CODEC, UV_BITS
from eigenfield.encoding.geometry.collapse_kernels import BORDER, INSIDE, KEPT, Sheet, collapse, fallen
from eigenfield.encoding.geometry.distortion import Effect, depth_effect, opened, texel_weights
from eigenfield.encoding.geometry.raster_kernels import draw_owners, sheet_cost

log = logging.getLogger("eigenfield.encode")

LEFT = 0.4  # of a loss, once means and eigen textures have made the best of it: found on Tarot
VERTEX_BYTES = 1.6  # what one more takes: measured on Tarot, 2,000 to 4,500 vertices
MENDINGS = 3  # times that the vertices around holes are kept, before all are
CLOSED = 0.1  # of what the mesh's bytes are worth: holes that cost less stay
HOLES = 4.0  # of their squared error that they count: single black pixels disturb more than blur does
DEPTH_STEPS = (1.0, 1.5, 2.0, 3.0, 4.0)  # times that of the lattice
STIFF = 1e-3  # of what a depth usually weighs, for those that nothing tells


@dataclass(frozen=True, eq=False)
class Form:
    """A coded mesh. loss: squared error, of all pictures together, that the given surface would not have."""

    stream: bytes
    mesh: Mesh
    loss: float

    def cost(self, price: float) -> float:
        """Of both together: a byte is worth `price`."""
        return self.loss + price * len(self.stream)


def slim_relief(
    mesh: Mesh,
    lattice: Lattice,
    fine: int,
    cameras: Sequence[Camera],
    observations: Observations,
    price: float,
    texels: float,
) -> Form:
    """The relief whose bytes and errors together are least. Raises ValueError where no form can be coded.

    Args:
        mesh: the relief, with UVs.
        lattice, fine: of `relief_lattice`.
        cameras: of the observations.
        observations: some of them are decoded, see `depth_effect`.
        price: squared error that a byte takes off the pictures elsewhere, for each pixel that a texel is seen in.
        texels: for a pixel.
    """
    assert mesh.uv is not None
    exact = lattice.coordinates(mesh.vertices)
    effect = depth_effect(mesh, lattice, 2.0**fine, cameras, observations)
    price *= effect.seen / texels / LEFT
    found: list[tuple[float, Form]] = []
    whole = _form(mesh, lattice, fine, effect, 0, 1.0)  # all of a grid is cheap
    limit, kept, start = price * VERTEX_BYTES, np.zeros(0, np.int64), (0, 0)
    for mending in range(MENDINGS + 2):
        sheet = _sheet(effect.places(mesh.uv), exact, mesh.faces)
        sheet.where[kept] = KEPT
        sheet_cost(effect.ground, sheet.places, sheet.depth, sheet.faces)
        falls, _ = collapse(effect.ground, sheet, limit)
        slim = _fallen(mesh, lattice, effect, exact, falls, kept)
        best, start = _cheapest(slim, lattice, fine, effect, price, start)
        last = limit == 0
        if whole is not None and (best is None or whole.cost(price) < best.cost(price)):
            best, _ = _cheapest(mesh, lattice, fine, effect, price, (0, 0))
            last = True  # no vertex falls
        more = kept
        if best is not None:
            holes, seen = opened(mesh, best.mesh, cameras, observations)
            found.append((best.cost(price) + HOLES * holes, best))
            log.info(
                "relief: %d of %d triangles in %d bytes, %d vertices went, squared error of holes %.4g",
                len(best.mesh.faces), len(mesh.faces), len(best.stream), len(falls), holes,
            )  # fmt: skip
            last |= HOLES * holes < CLOSED * price * len(best.stream)
            more = np.union1d(kept, seen)
        if last:
            break
        if mending == MENDINGS or len(more) == len(kept):  # the holes that are left lie between vertices that stay
            limit = 0.0
        kept = more
    if not found:
        raise ValueError("the relief cannot be coded on its lattice")
    return min(found, key=lambda one: one[0])[1]


def _fallen(
    mesh: Mesh,
    lattice: Lattice,
    effect: Effect,
    exact: NDArray[np.float64],
    falls: NDArray[np.int32],
    kept: NDArray[np.int64],
) -> Mesh:
    """The mesh without the vertices that fell, depths fitted but for those of `kept` vertices. exact: (n, 3) the
    vertices' lattice coordinates."""
    assert mesh.uv is not None
    faces = fallen(mesh.faces, falls)
    faces = np.ascontiguousarray(faces[faces[:, 0] >= 0])
    depth = _fitted(effect, effect.places(mesh.uv), exact[:, 2], faces, kept)
    used, faces = np.unique(faces, return_inverse=True)
    vertices = lattice.points(np.column_stack([exact[used, :2], depth[used]])).astype(np.float32)
    return Mesh(vertices, faces.reshape(-1, 3).astype(np.int32), mesh.uv[used])


def _cheapest(
    mesh: Mesh, lattice: Lattice, fine: int, effect: Effect, price: float, start: tuple[int, int]
) -> tuple[Form | None, tuple[int, int]]:
    """The form with depths and contours as coarse as pays best, from which no single step either way is better, and how
    coarse: digits less, and the index in DEPTH_STEPS. start: where to look first. Where nothing there can be coded, all
    are tried."""
    tried: dict[tuple[int, int], Form | None] = {}

    def cost(at: tuple[int, int]) -> float:
        digits, step = at
        if not (0 <= digits <= fine and 0 <= step < len(DEPTH_STEPS)):
            return np.inf
        if at not in tried:
            tried[at] = _form(mesh, lattice, fine, effect, digits, DEPTH_STEPS[step])
        form = tried[at]
        return np.inf if form is None else form.cost(price)

    best = start
    if cost(best) == np.inf:
        best = min(itertools.product(range(fine + 1), range(len(DEPTH_STEPS))), key=cost)
    while True:
        digits, step = best
        near = (best, (digits, step + 1), (digits, step - 1), (digits + 1, step), (digits - 1, step))
        following = min(near, key=cost)
        if following == best:
            return tried[best], best
        best = following


def _form(mesh: Mesh, lattice: Lattice, fine: int, effect: Effect, digits: int, step: float) -> Form | None:
    """The mesh coded with so many of the contours' fine digits less, and depths in steps so many times the lattice's;
    None where it cannot be."""
    coarse = Lattice(lattice.matrix @ np.diag([2.0**digits, 2.0**digits, step, 1.0]), True)
    try:
        stream, found = encoder(MESH_CODEC)(mesh, coarse, uv_bits=UV_BITS, fine=fine - digits)
    except ValueError:
        return None
    if not len(found.faces):
        return None
    assert found.uv is not None
    depth = lattice.coordinates(found.vertices)[:, 2]
    return Form(stream, found, float(sheet_cost(effect.ground, effect.places(found.uv), depth, found.faces)))


def _sheet(places: NDArray[np.int64], exact: NDArray[np.float64], faces: NDArray[np.int32]) -> Sheet:
    """What may fall: not where borders meet, nor where two charts do, which would come apart."""
    n, corners = len(places), faces.reshape(-1)
    order = np.argsort(corners, kind="stable").astype(np.int32)
    last = np.flatnonzero(np.diff(corners[order])) if len(order) else np.zeros(0, np.int64)
    head, after = np.full(n, -1, np.int32), np.full(len(corners), -1, np.int32)
    head[corners[order[np.r_[0, last + 1]]]] = order[np.r_[0, last + 1]]
    along = np.setdiff1d(np.arange(len(order) - 1), last)
    after[order[along]] = order[along + 1]
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    ends, count = np.unique(edges, axis=0, return_counts=True)
    borders = np.bincount(ends[count == 1].reshape(-1), minlength=n)
    where = np.where(borders == 0, INSIDE, np.where(borders == 2, BORDER, KEPT)).astype(np.uint8)
    where[ends[count > 2].reshape(-1)] = KEPT
    _, same, many = np.unique(np.rint(exact), axis=0, return_inverse=True, return_counts=True)
    where[many[same.reshape(-1)] > 1] = KEPT
    return Sheet(places, exact[:, 2].copy(), faces.copy(), head, after, where)


def _fitted(
    effect: Effect,
    places: NDArray[np.int64],
    depth: NDArray[np.float64],
    faces: NDArray[np.int32],
    kept: NDArray[np.int64],
) -> NDArray[np.float64]:
    """(n,) depths of the vertices by which the pictures lose least: least squares, texels that lose much count
    less. Those of `kept` are what they were: by a moved rim a camera sees past it."""
    ground = effect.ground
    owners = np.zeros(ground.depth.shape, np.int32)
    draw_owners(places, faces, owners)
    owners[ground.given == 0] = -1
    corners, weights = texel_weights(places, faces, owners)
    there = owners >= 0
    off = ground.depth[there] - np.einsum("tk,tk->t", weights, depth[corners])
    curve, most = ground.curve[there].astype(np.float64), np.maximum(ground.most[there], 1e-12).astype(np.float64)
    counts = curve * np.square(most / (most + curve * np.square(off)))
    free = np.setdiff1d(np.arange(len(depth)), kept)
    rows = np.repeat(np.arange(len(off)), 3)
    A = coo_array((weights.reshape(-1), (rows, corners.reshape(-1))), shape=(len(off), len(depth))).tocsc()[:, free]
    normal = A.T @ diags_array(counts) @ A
    diagonal = normal.diagonal()
    ridge = STIFF * float(np.median(diagonal[diagonal > 0])) if (diagonal > 0).any() else 1.0
    normal = normal + ridge * diags_array(np.ones(len(free)))
    change, _ = cg(normal, A.T @ (counts * off), rtol=1e-4, maxiter=200, M=diags_array(1 / normal.diagonal()))
    found = depth.copy()
    found[free] += change
    return found
