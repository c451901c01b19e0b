"""A relief simplified by rate and distortion: squared error of the pictures + lambda x bytes is minimised.

Vertices collapse while one costs less squared error than its bytes times lambda; depths are fitted to those of the
given surface; then steps of depth and of contours are tried, from those of the lattice to coarser ones, and the coded
relief of least cost is taken. Where a camera sees through it, the vertices that it saw before stay. Parts of
sheets that are not worth their bytes vanish.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import contextlib
import itertools
import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import cg

from eigenfield.coding.codecs import encoder
from eigenfield.coding.mesh.coder import whole_faces
from eigenfield.core.camera import Camera
from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import Observations
from eigenfield.core.payloads import Coded
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.geometry.coded import MESH_CODEC, UV_BITS, coded_mesh, faces_left, proxy_of_stream
from eigenfield.encoding.geometry.collapse_kernels import FIXED, collapse, collapse_state, collapsed_faces
from eigenfield.encoding.geometry.distortion import DistortionMap, depth_distortion, hole_error, texel_weights
from eigenfield.encoding.geometry.raster_kernels import draw_owners, mesh_cost

log = logging.getLogger("eigenfield.encode")

REMAINING_LOSS_RATIO = 0.4  # of a loss, once means and eigen textures are fitted to it: found on Tarot
SHEETS_REMAINING_LOSS_RATIO = 1.0  # likewise, of sheets: found on Fern and Boxes
VERTEX_BYTES = 1.6  # measured on Tarot, 2,000 to 4,500 vertices
HOLE_ROUNDS = 3  # in which the vertices around holes are fixed, before all are
HOLE_MAX_COST_RATIO = 0.1  # of the cost of the mesh's bytes: holes that cost less stay
HOLE_ERROR_FACTOR = 4.0  # of their squared error: single black pixels disturb more than blur does
DEPTH_STEP_RATIOS = (1.0, 1.5, 2.0, 3.0, 4.0)  # times that of the lattice
DEPTH_RIDGE_RATIO = 1e-3  # of the median weight of a depth, for those that no texel determines


@dataclass(frozen=True, eq=False)
class CodedRelief:
    """A coded mesh.

    Attributes:
        stream: Of MESH_CODEC.
        mesh: That the stream decodes to.
        sheets: Number of faces of each sheet; () of an opaque mesh.
        loss: Squared error, of all pictures together, that the given surface would not have.
    """

    stream: bytes
    mesh: Mesh
    sheets: tuple[int, ...]
    loss: float

    def cost(self, lambda_: float) -> float:
        """The rate-distortion cost: loss + lambda x bytes."""
        return self.loss + lambda_ * len(self.stream)


def simplify_proxy_rd(
    proxy: Proxy, cameras: Sequence[Camera], reference: int, observations: Observations, lambda_: float, texels: float
) -> Coded[Proxy]:
    """The proxy as a file keeps it: a relief, also of sheets, simplified by rate and distortion, other meshes with all
    their triangles.

    Args:
        proxy: With its lattice, if it is a relief. The opacity of its sheets stays as it is, and is not coded.
        cameras: The encoded ones.
        reference: Index of the reference camera among them.
        observations: Theirs.
        lambda_: Rate-distortion weight: squared error for one byte, for each pixel that a texel is seen in.
        texels: Of the atlas, for one pixel of the reference camera.
    """
    if proxy.lattice is not None:
        with contextlib.suppress(ValueError):  # too far off the picture for the lattice
            made = simplify_relief_rd(proxy, proxy.lattice, cameras, observations, lambda_, texels)
            sheets = None if proxy.sheets is None else replace(proxy.sheets, faces=made.sheets)
            return proxy_of_stream(made.stream, made.mesh, sheets)
    return coded_mesh(proxy, cameras, reference)


def simplify_relief_rd(
    proxy: Proxy, lattice: Lattice, cameras: Sequence[Camera], observations: Observations, lambda_: float, texels: float
) -> CodedRelief:
    """The relief of least rate-distortion cost.

    Args:
        proxy: The relief, with UVs.
        lattice: Of `relief_lattice`.
        observations: Some of them are decoded, see `depth_distortion`.
        lambda_: Squared error for one byte, for each pixel that a texel is seen in.
        texels: Of the atlas, for one pixel.

    Raises:
        ValueError: The relief cannot be coded on its lattice.
    """
    mesh, sheets = proxy.mesh, proxy.sheets
    assert mesh.uv is not None
    whole_sheets = () if sheets is None else sheets.faces
    exact = lattice.coordinates(mesh.vertices)
    distortion = depth_distortion(mesh, lattice, cameras, observations, sheets)
    remaining = REMAINING_LOSS_RATIO if sheets is None else SHEETS_REMAINING_LOSS_RATIO
    lambda_ *= distortion.seen / texels / remaining
    found: list[tuple[float, CodedRelief]] = []
    whole = _coded_relief(mesh, whole_sheets, lattice, distortion, 0, 1.0)  # all of a grid is cheap
    limit, kept, start = lambda_ * VERTEX_BYTES, np.zeros(0, np.int64), (0, 0)
    for number in range(HOLE_ROUNDS + 2):
        state = collapse_state(distortion.places(mesh.uv), exact, mesh.faces)
        state.where[kept] = FIXED
        mesh_cost(distortion.cost_map, state.places, state.depth, state.faces)
        collapses, _ = collapse(distortion.cost_map, state, limit)
        simplified = _collapsed_mesh(mesh, whole_sheets, lattice, distortion, exact, collapses, kept)
        best, start = _best_steps(*simplified, lattice, distortion, lambda_, start)
        last = limit == 0
        if whole is not None and (best is None or whole.cost(lambda_) < best.cost(lambda_)):
            best, _ = _best_steps(mesh, whole_sheets, lattice, distortion, lambda_, (0, 0))
            last = True  # no vertex collapses
        more = kept
        if best is not None:
            holes, seen = hole_error(mesh, best.mesh, cameras, observations)
            found.append((best.cost(lambda_) + HOLE_ERROR_FACTOR * holes, best))
            words = "relief: %d of %d triangles in %d bytes, %d vertices collapsed, squared error of holes %.4g"
            log.info(words, len(best.mesh.faces), len(mesh.faces), len(best.stream), len(collapses), holes)
            last |= HOLE_ERROR_FACTOR * holes < HOLE_MAX_COST_RATIO * lambda_ * len(best.stream)
            more = np.union1d(kept, seen)
        if last:
            break
        if number == HOLE_ROUNDS or len(more) == len(kept):  # the holes that are left lie between vertices that stay
            limit = 0.0
        kept = more
    if not found:
        raise ValueError("the relief cannot be coded on its lattice")
    return min(found, key=lambda one: one[0])[1]


def _collapsed_mesh(
    mesh: Mesh,
    sheets: tuple[int, ...],
    lattice: Lattice,
    distortion: DistortionMap,
    exact: NDArray[np.float64],
    collapses: NDArray[np.int32],
    kept: NDArray[np.int64],
) -> tuple[Mesh, tuple[int, ...]]:
    """The mesh without the vertices that collapsed, depths fitted but for those of `kept` vertices, and the number of
    faces that its sheets have left. exact: (n, 3) the vertices' lattice coordinates."""
    assert mesh.uv is not None
    faces = collapsed_faces(mesh.faces, collapses)
    left = faces_left(sheets, faces[:, 0] >= 0)
    faces = np.ascontiguousarray(faces[faces[:, 0] >= 0])
    depth = _fitted_depths(distortion, distortion.places(mesh.uv), exact, faces, kept)
    used, faces = np.unique(faces, return_inverse=True)
    vertices = lattice.points(np.column_stack([exact[used, :2], depth[used]])).astype(np.float32)
    return Mesh(vertices, faces.reshape(-1, 3).astype(np.int32), mesh.uv[used]), left


def _best_steps(
    mesh: Mesh,
    sheets: tuple[int, ...],
    lattice: Lattice,
    distortion: DistortionMap,
    lambda_: float,
    start: tuple[int, int],
) -> tuple[CodedRelief | None, tuple[int, int]]:
    """The coded relief whose steps of depth and contours no single change makes cheaper, and these: the digits less,
    and the index in DEPTH_STEP_RATIOS.

    start: the steps that are tried first. Where the mesh cannot be coded with these, all are tried.
    """
    tried: dict[tuple[int, int], CodedRelief | None] = {}
    fine = lattice.fine

    def cost(at: tuple[int, int]) -> float:
        digits, step = at
        if not (0 <= digits <= fine and 0 <= step < len(DEPTH_STEP_RATIOS)):
            return np.inf
        if at not in tried:
            tried[at] = _coded_relief(mesh, sheets, lattice, distortion, digits, DEPTH_STEP_RATIOS[step])
        relief = tried[at]
        return np.inf if relief is None else relief.cost(lambda_)

    best = start
    if cost(best) == np.inf:
        best = min(itertools.product(range(fine + 1), range(len(DEPTH_STEP_RATIOS))), key=cost)
    while True:
        digits, step = best
        near = (best, (digits, step + 1), (digits, step - 1), (digits + 1, step), (digits - 1, step))
        following = min(near, key=cost)
        if following == best:
            return tried[best], best
        best = following


def _coded_relief(
    mesh: Mesh, sheets: tuple[int, ...], lattice: Lattice, distortion: DistortionMap, digits: int, step: float
) -> CodedRelief | None:
    """The mesh coded with so many of the contours' fine digits less, and depths in steps so many times the lattice's;
    None where it cannot be."""
    coarse = Lattice(lattice.matrix @ np.diag([2.0**digits, 2.0**digits, step, 1.0]), True)
    try:
        stream, found = encoder(MESH_CODEC)(
            mesh, coarse, uv_bits=UV_BITS, fine=lattice.fine - digits, sheets=sheets
        )  # fmt: skip
    except ValueError:
        return None
    if not len(found.faces):
        return None
    assert found.uv is not None
    depth = lattice.coordinates(found.vertices)[:, 2]
    loss = mesh_cost(distortion.cost_map, distortion.places(found.uv), depth, found.faces)
    return CodedRelief(stream, found, faces_left(sheets, whole_faces(mesh, coarse)), float(loss))


def _fitted_depths(
    distortion: DistortionMap,
    places: NDArray[np.int64],
    exact: NDArray[np.float64],
    faces: NDArray[np.int32],
    kept: NDArray[np.int64],
) -> NDArray[np.float64]:
    """(n,) depths of the vertices by robust least squares: the pictures then lose least. Those of `kept` are what they
    were: a camera sees past a rim that moves. Vertices at one point, where two charts meet, stay at one point: a camera
    would see between them. exact: (n, 3) lattice coordinates."""
    cost_map, depth = distortion.cost_map, exact[:, 2]
    _, first, same = np.unique(exact, axis=0, return_index=True, return_inverse=True)
    point = first[same.reshape(-1)]  # the first vertex there
    owners = np.zeros(cost_map.depth.shape, np.int32)
    draw_owners(places, faces, owners)
    owners[cost_map.given == 0] = -1
    corners, weights = texel_weights(places, faces, owners)
    there = owners >= 0
    off = cost_map.depth[there] - np.einsum("tk,tk->t", weights, depth[corners])
    curve, most = cost_map.curve[there].astype(np.float64), np.maximum(cost_map.most[there], 1e-12).astype(np.float64)
    counts = curve * np.square(most / (most + curve * np.square(off)))
    free = np.setdiff1d(point, point[kept])
    rows, columns = np.repeat(np.arange(len(off)), 3), point[corners.reshape(-1)]
    A = coo_array((weights.reshape(-1), (rows, columns)), shape=(len(off), len(depth))).tocsc()[:, free]
    normal = A.T @ diags_array(counts) @ A
    diagonal = normal.diagonal()
    ridge = DEPTH_RIDGE_RATIO * float(np.median(diagonal[diagonal > 0])) if (diagonal > 0).any() else 1.0
    normal = normal + ridge * diags_array(np.ones(len(free)))
    change, _ = cg(normal, A.T @ (counts * off), rtol=1e-4, maxiter=200, M=diags_array(1 / normal.diagonal()))
    moved = np.zeros(len(depth))
    moved[free] = change
    return depth + moved[point]
