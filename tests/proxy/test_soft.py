"""A relief of soft sheets: what it keeps, where its texels lie, and that it shows what the sheets show."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import atlas_fault, soft_relief
from eigenfield.stereo import ReferenceView, view_matrices
from eigenfield.stereo.multiplane import SoftSheets
from eigenfield.stereo.multiplane.visibility import sheet_visibility

SHAPE, MARGIN = (48, 64), 14
FRAME = (SHAPE[0] + 2 * MARGIN, SHAPE[1] + 2 * MARGIN)
K = np.array([[60.0, 0, 32], [0, 60, 24], [0, 0, 1]])


def cameras(pitch=0.25):
    centres = pitch * np.array([(x, y, 0.0) for y in (-1, 0, 1) for x in (-1, 0, 1)])
    return [Camera(K, np.eye(3), -centre, SHAPE[1], SHAPE[0]) for centre in centres]


def reference():
    return ReferenceView.with_margin(cameras()[4], MARGIN, 0.0, 1.0)


def disc(radius, row=FRAME[0] / 2, column=FRAME[1] / 2):
    rows, columns = np.indices(FRAME)
    return np.clip(radius - np.hypot(rows - row, columns - column), 0, 1).astype(np.float32)


def sheets(*opacities):
    """A slanted wall, and discs before it, each nearer than the last."""
    rows, columns = np.indices(FRAME)
    labels = [0.1 + 0.0004 * columns, *(0.25 + 0.1 * k + 0.0005 * rows for k in range(len(opacities)))]
    colour = 0.5 + 0.3 * np.sin(np.stack([columns / 5, rows / 4, (rows + columns) / 7], axis=-1))
    layers = np.zeros((len(labels), *FRAME, 4), np.float32)
    for k, opacity in enumerate((np.ones(FRAME), *opacities)):
        layers[k, ..., :3], layers[k, ..., 3] = np.roll(colour, 9 * k, axis=1), opacity
    return SoftSheets(np.array(labels, np.float32), layers)


def relief(given, **options):
    return soft_relief(reference(), given, cameras(), **{"tolerance": 0.002, "depth_error": 0.02, **options})


def drawn(made, camera):
    """A view of a soft relief, and its coverage, by definition."""
    mesh, side = made.proxy.mesh, len(made.colours)
    texels = np.concatenate([made.colours, made.proxy.sheets.opacity[..., None]], axis=2)
    picture, through = np.zeros((*SHAPE, 3)), np.ones(SHAPE)
    for first, count in zip(np.cumsum([0, *made.proxy.sheets.faces]), made.proxy.sheets.faces, strict=False):
        faces = mesh.faces[first : first + count]
        raster = rasterise_view(Mesh(mesh.vertices, faces, mesh.uv), camera)
        row, column = np.nonzero(raster.face >= 0)
        face = raster.face[row, column]
        weights = np.einsum("nij,nj->ni", raster.edges[face], np.stack([column + 0.5, row + 0.5, np.ones(len(row))], 1))
        place = np.einsum("ni,nik->nk", weights / weights.sum(axis=1, keepdims=True), mesh.uv[faces[face]]) * side - 0.5
        at = np.clip(place, 0, side - 1.001).astype(int)
        right, below = (np.clip(place, 0, side - 1) - at).T[..., None]
        x, y = at.T
        above = (1 - right) * texels[y, x] + right * texels[y, x + 1]
        under = (1 - right) * texels[y + 1, x] + right * texels[y + 1, x + 1]
        read = (1 - below) * above + below * under
        picture[row, column] += read[:, 3:] * (read[:, :3] - picture[row, column])
        through[row, column] *= 1 - read[:, 3]
    return picture, 1 - through


def test_a_relief_shows_what_its_sheets_show():
    given = sheets(disc(12, row=30), 0.6 * disc(9, column=60))
    made = relief(given)
    assert len(made.proxy.sheets.faces) == 3
    for camera, matrix in zip(cameras(), view_matrices(reference(), cameras()), strict=True):
        picture, coverage = drawn(made, camera)
        assert coverage.min() > 0.999
        assert np.abs(picture - given.draw(matrix, SHAPE)).mean() < 0.004


def test_faces_stand_sheet_by_sheet_and_share_nothing():
    made = relief(sheets(disc(12), disc(6))).proxy
    owner = np.repeat(np.arange(3), made.sheets.faces)
    used = [np.unique(made.mesh.faces[owner == k]) for k in range(3)]
    assert len(np.concatenate(used)) == len(made.mesh.vertices) == len(np.unique(np.concatenate(used)))
    nearest = [made.mesh.vertices[part, 2].min() for part in used]
    assert nearest[0] > nearest[1] > nearest[2]
    assert atlas_fault(made.mesh) is None
    corners = reference().camera.project(made.mesh.vertices)[0][made.mesh.faces]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    assert (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] < 0).all()  # y is down: counter-clockwise


def test_vertices_stand_on_the_lattice_of_the_reference_view():
    made = relief(sheets(disc(12))).proxy
    steps = made.lattice.coordinates(made.mesh.vertices)
    assert made.lattice.flat
    assert_allclose((steps[:, :2] / 4 + 0.5)[:50], reference().camera.project(made.mesh.vertices)[0][:50], atol=1e-3)
    moved = made.lattice.points(np.rint(steps))
    for camera in cameras():
        assert np.abs(camera.project(moved)[0] - camera.project(made.mesh.vertices)[0]).max() < 0.2


def test_what_no_view_sees_is_left_out():
    wall = relief(sheets()).proxy
    behind = relief(sheets(disc(30))).proxy
    assert rasterise_view(wall.mesh, cameras()[4]).face.min() >= 0
    first = behind.sheets.faces[0]
    back = Mesh(behind.mesh.vertices, behind.mesh.faces[:first], behind.mesh.uv)
    assert rasterise_view(back, cameras()[4]).face[SHAPE[0] // 2, SHAPE[1] // 2] < 0
    assert len(relief(sheets(0.03 * disc(30), disc(12), 0.1 * disc(1.5))).proxy.sheets.faces) == 2


def test_a_limit_of_triangles_is_kept():
    assert len(relief(sheets(disc(12)), tolerance=1e-5, triangles=300).proxy.mesh.faces) <= 330


def test_cameras_that_see_nothing_get_one_line():
    away = [Camera(K, np.diag([-1.0, 1, -1]), -camera.t, SHAPE[1], SHAPE[0]) for camera in cameras()]
    with pytest.raises(ProxyError, match="no sheet draws anything"):
        soft_relief(reference(), sheets(disc(12)), away, tolerance=0.01, depth_error=0.02)


def test_a_texel_is_as_visible_as_in_the_view_that_sees_it_best():
    seen = sheet_visibility(sheets(0.75 * disc(25)), reference(), cameras())
    assert_allclose(seen[1, MARGIN:-MARGIN, MARGIN:-MARGIN], 1)
    assert_allclose(seen[0, FRAME[0] // 2, FRAME[1] // 2], 0.25, atol=0.01)
    assert seen[0, FRAME[0] // 2, MARGIN] == pytest.approx(1)
