"""A moving sheet before a still relief: one mesh for all frames of a clip, with depth and opacity of each.

The sheet is a regular grid over the pixels of the reference view in which anything moves in any frame. Pixels and
texture coordinates of its vertices stay, and depth alone changes: outlines move in the opacity, so that the grid needs
no cuts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import spsolve

from eigenfield.core.camera import Camera
from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh
from eigenfield.proxy.relief.find_lattice import lattice_of_camera
from eigenfield.proxy.relief.height_field import HeightFieldMesh, height_field_to_world, join_height_fields
from eigenfield.proxy.relief.packing import pack_sheets
from eigenfield.proxy.relief.soft import draw_chart
from eigenfield.proxy.relief.triangulation import DELAUNAY_STEPS_PER_PIXEL
from eigenfield.stereo import ReferenceView

SHEET_TRIANGLES = 4000  # of the moving sheet, at most, about
SHEET_MIN_SPACING_PIXELS = 4  # of the grid
SHEET_REACH_PIXELS = 4  # by which it reaches beyond what moves
SHEET_SEEN_OPACITY = 0.05  # of a pixel that shows the sheet
SHEET_BESIDE_WEIGHT, SHEET_BESIDE_PIXELS = 0.1, 6.0  # of a pixel beside these, and the distance at which it falls by e
SHEET_SMOOTH_WEIGHT = 0.1  # of the difference of two neighbouring vertices, next to a pixel
SHEET_STEADY_WEIGHT = 0.05  # of a vertex's label in the frame before, next to a pixel
SHEET_DEPTH_ERROR_PIXELS = 0.04  # by which the lattice's depths move a point


@dataclass(frozen=True, eq=False)
class SheetGrid:
    """The grid of a moving sheet over the reference view.

    Attributes:
        mesh: Its vertices stand on whole pixels; labels are 0.
        pixels: (n,) indices of the pixels that it covers, in the flat picture.
        shares: (n, v) barycentric coordinates of these pixels.
        smooth: (v, v) the sum over neighbours of the squared difference of their labels, as a matrix.
    """

    mesh: HeightFieldMesh
    pixels: NDArray[np.int64]
    shares: csr_array
    smooth: csr_array

    def fit(
        self, d: NDArray[np.float32], opacity: NDArray[np.float32], before: NDArray[np.float64] | None
    ) -> NDArray[np.float64]:
        """(v,) labels of the vertices.

        With A the shares, W a weight for each pixel and L `smooth`, they are the z that minimise
        |W^(1/2) (A z - d)|^2 + smooth z^T L z + steady |z - before|^2. A pixel weighs what is seen of the sheet there,
        and less the farther from that: there a vertex stays as it was.

        Args:
            d: (h, w) labels of a frame.
            opacity: (h, w) how much is seen.
            before: (v,) the labels of the frame before.
        """
        beside = (
            distance_transform_edt(opacity < SHEET_SEEN_OPACITY) if (opacity >= SHEET_SEEN_OPACITY).any() else np.inf
        )
        near = SHEET_BESIDE_WEIGHT * np.exp(-beside / SHEET_BESIDE_PIXELS) * np.ones(opacity.shape)
        weighted = self.shares.T * np.maximum(opacity, near).ravel()[self.pixels]
        matrix, right = weighted @ self.shares + SHEET_SMOOTH_WEIGHT * self.smooth, weighted @ d.ravel()[self.pixels]
        steady = np.full(len(self.mesh.x), SHEET_STEADY_WEIGHT)
        start = (
            np.full(len(self.mesh.x), np.average(d, weights=np.maximum(opacity, 1e-6))) if before is None else before
        )
        return np.asarray(spsolve((matrix + diags_array(steady)).tocsc(), right + steady * start))


def sheet_grid(region: NDArray[np.bool_], triangles: int = SHEET_TRIANGLES) -> SheetGrid:
    """A regular grid over a region of the reference view, and a little beyond.

    Args:
        region: (h, w) where anything moves in any frame.
        triangles: About how many there may be.
    """
    height, width = region.shape
    around = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * SHEET_REACH_PIXELS + 1,) * 2)
    covered = cv2.dilate(region.astype(np.uint8), around)
    spacing = max(SHEET_MIN_SPACING_PIXELS, int(np.ceil(np.sqrt(2 * covered.sum() / triangles))))
    rows, columns = -(-height // spacing), -(-width // spacing)
    padded = np.zeros((rows * spacing, columns * spacing), np.uint8)
    padded[:height, :width] = covered
    cells = padded.reshape(rows, spacing, columns, spacing).max(axis=(1, 3)) > 0
    row, column = np.nonzero(cells)
    number = np.full((rows + 1, columns + 1), -1, np.int64)
    corners = (0, 0), (0, 1), (1, 0), (1, 1)
    for below, beside in corners:
        number[row + below, column + beside] = 0
    at = np.nonzero(number == 0)
    number[at] = np.arange(len(at[0]))
    of_cell = np.stack([number[row + below, column + beside] for below, beside in corners], axis=1)
    faces = np.concatenate([of_cell[:, [0, 1, 3]], of_cell[:, [0, 3, 2]]])
    across, down = (spacing * at[k].astype(np.float64) for k in (1, 0))
    mesh = HeightFieldMesh(across, down, np.zeros(len(across)), faces.astype(np.int32))
    y, x = np.nonzero(np.kron(cells, np.ones((spacing, spacing), np.bool_))[:height, :width])
    fx, fy = (x % spacing) / spacing, (y % spacing) / spacing
    four = [number[y // spacing + below, x // spacing + beside] for below, beside in corners]
    upper = fx >= fy  # the triangle of the first, second and last corner; else of the first, last and third
    shares = [1 - np.maximum(fx, fy), np.where(upper, fx - fy, 0), np.where(upper, 0, fy - fx), np.minimum(fx, fy)]
    index = np.arange(len(x))
    entries = np.concatenate(shares), (np.tile(index, 4), np.concatenate(four))
    A = coo_array(entries, shape=(len(x), len(mesh.x))).tocsr()
    sides = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
    pair = np.tile(np.arange(len(sides)), 2), sides.T.ravel()
    D = coo_array((np.repeat([1.0, -1.0], len(sides)), pair), shape=(len(sides), len(mesh.x))).tocsr()
    return SheetGrid(mesh, y * width + x, A, (D.T @ D).tocsr())


@dataclass(frozen=True, eq=False)
class _Chart:
    """A packed part; `index` are its vertices in the grid, None of the still relief."""

    part: HeightFieldMesh
    place: NDArray[np.float64]
    index: NDArray[np.int64] | None


@dataclass(frozen=True, eq=False)
class MovingSheet:
    """A still relief and a moving sheet before it, in one atlas.

    Attributes:
        faces: Number of faces of the relief and of the sheet.
        side: Of the atlas, in pixels of the reference view.
    """

    reference: ReferenceView
    charts: tuple[_Chart, ...]
    faces: tuple[int, int]
    side: int

    @staticmethod
    def over(reference: ReferenceView, still: Mesh, grid: SheetGrid) -> MovingSheet:
        """The sheet of a grid before a relief.

        Args:
            still: The relief, whose camera is that of the reference view.
        """
        parts, owners, places, side = pack_sheets([_height_field_of(reference, still), grid.mesh])
        numbers = {at: k for k, at in enumerate(zip(grid.mesh.x.tolist(), grid.mesh.y.tolist(), strict=True))}
        charts = []
        for part, owner, place in sorted(zip(parts, owners, places, strict=True), key=lambda one: one[1]):
            at = zip(part.x.tolist(), part.y.tolist(), strict=True)
            charts.append(_Chart(part, place, np.array([numbers[one] for one in at]) if owner else None))
        counts = [
            sum(len(chart.part.faces) for chart in charts if (chart.index is None) == back) for back in (True, False)
        ]
        return MovingSheet(reference, tuple(charts), (counts[0], counts[1]), round(side))

    def mesh(self, labels: NDArray[np.float64]) -> Mesh:
        """With texture coordinates, in a frame.

        Args:
            labels: (v,) of the grid's vertices.
        """
        placed = [
            chart.part if chart.index is None else replace(chart.part, d=labels[chart.index]) for chart in self.charts
        ]
        uv = np.concatenate([np.stack([one.part.x, one.part.y], axis=1) + one.place for one in self.charts]) / self.side
        mesh = height_field_to_world(self.reference, join_height_fields(placed))
        return replace(mesh, uv=np.clip(uv, 0, 1).astype(np.float32))

    def opacity(self, labels: NDArray[np.float64], seen: NDArray[np.float32]) -> NDArray[np.float32]:
        """(S, S) of the atlas in a frame; the still relief is opaque.

        Args:
            labels: (v,) of the grid's vertices.
            seen: (h, w) opacity of the moving sheet in the reference view.
        """
        atlas = np.ones((self.side, self.side), np.float32)
        for chart in self.charts:
            if chart.index is not None:
                depth = 1 / (self.reference.offset + self.reference.scale * labels[chart.index])
                draw_chart(seen, chart.part, depth, chart.place, atlas)
        return np.clip(atlas, 0, 1)

    def lattice(self, mesh: Mesh, cameras: Sequence[Camera]) -> Lattice | None:
        """Of `mesh` of some frame; None if rounding to it would move vertices.

        Args:
            cameras: That see it.
        """
        return lattice_of_camera(self.reference.camera.matrix, mesh, cameras, SHEET_DEPTH_ERROR_PIXELS)


def _height_field_of(reference: ReferenceView, relief: Mesh) -> HeightFieldMesh:
    """A relief over the pixels of its camera."""
    h = reference.camera.homogeneous(relief.vertices)
    x, y = (np.rint(DELAUNAY_STEPS_PER_PIXEL * (h[:, k] / h[:, 2] - 0.5)) / DELAUNAY_STEPS_PER_PIXEL for k in range(2))
    d = (1 / h[:, 2] - reference.offset) / reference.scale
    return HeightFieldMesh(x, y, d, np.ascontiguousarray(relief.faces[:, ::-1]))
