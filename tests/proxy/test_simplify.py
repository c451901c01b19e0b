"""A mesh without cracks has none with fewer triangles either."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import KDTree

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import simplify, simplify_mesh, weld_vertices
from eigenfield.proxy.background import join_meshes
from support.surfaces import looking, square

FRONT = looking(np.array([0.3, -0.8, -4.0]), (0.0, 0.0, 0.0), focal=230)
AXES = ((0, 1, 2), (2, 1, 0), (0, 2, 1))


def moved(mesh: Mesh, to: tuple[float, float, float], axes: tuple[int, int, int] = AXES[0]) -> Mesh:
    return replace(mesh, vertices=(mesh.vertices[:, axes] + np.float32(to)).astype(np.float32))


def cube_in_a_room() -> Mesh:
    """A floor and a wall that meet at an edge, but at no vertex of it, and a cube on the floor, of five squares."""
    floor, wall = moved(square(3.0, 0.0, 44), (0, 1, -1), AXES[2]), moved(square(3.0, 0.0, 37), (0, -2, 2))
    side = square(0.5, 0.0, 11)
    sides = [moved(side, to) for to in ((0, 0.5, -0.5), (0, 0.5, 0.5))]
    sides += [moved(side, to, AXES[1]) for to in ((-0.5, 0.5, 0), (0.5, 0.5, 0))]
    mesh = floor
    for part in (wall, *sides, moved(side, (0, 0, 0), AXES[2])):
        mesh = join_meshes(mesh, part)
    return mesh


def along_a_curve(nodes: int = 41) -> Mesh:
    """Two sheets folded along a curve of common vertices, those of one a unit in the last place off."""
    parts = []
    for turn in (1.0, -1.0):
        part = square(2.0, 0.0, nodes)
        x, y = part.vertices[:, 0], part.vertices[:, 1] + 2
        points = np.stack(
            [x, 0.2 * np.sin(2 * x) + turn * y, 0.3 * y - 0.5 + 0.1 * y * np.cos((2.5 + turn) * x)], axis=1
        ).astype(np.float32)
        part = Mesh(points, part.faces) if turn > 0 else Mesh(np.nextafter(points, np.float32(9)), part.faces[:, ::-1])
        parts.append(part)
    return join_meshes(*parts)


def covered(mesh: Mesh, camera: Camera) -> np.ndarray:
    return rasterise_view(mesh, camera).inverse_depth > 0


@pytest.mark.parametrize("make", [cube_in_a_room, along_a_curve])
def test_no_crack_opens_where_parts_meet_however_few_triangles_are_left(make):
    whole = weld_vertices(make())
    fine = FRONT.resize(960, 720)
    assert covered(whole, fine).all()
    for count in (3000, 1500, 700, 300, 150):
        fewer = simplify_mesh(whole, count)
        assert len(fewer.faces) <= count
        assert covered(fewer, fine).all(), count


def test_the_border_of_a_plane_keeps_its_place():
    plane = square(1.0, 0.0, 30)
    corners = plane.vertices[[0, 29, -30, -1]]
    for count in (800, 100, 8):
        fewer = simplify_mesh(plane, count)
        assert fewer.face_areas().sum() == pytest.approx(4.0, rel=1e-4)
        assert np.abs(fewer.vertices[:, None] - corners).max(axis=2).min(axis=0).max() < 1e-4


def test_vertices_are_welded_that_rounding_parts_and_no_others():
    mesh = along_a_curve()
    apart = np.flatnonzero(np.abs(mesh.vertices[:, 2] + 0.5) < 1e-5)  # of both sheets
    assert len(apart) == 82
    assert len(weld_vertices(mesh).vertices) == len(mesh.vertices) - 41
    fine = square(1e-5, 1.0, 11)  # a step of 2e-6, at 1: 17 units in the last place
    assert len(weld_vertices(fine).vertices) == 121


def test_what_reaches_far_joins_no_more_of_what_is_near(monkeypatch):
    fine, far = square(1.0, 0.0, 40), square(1e6, 5.0, 3)
    pairs = []

    class Counted(KDTree):
        def query_pairs(self, *args, **options):
            found = super().query_pairs(*args, **options)
            pairs.append(len(found))
            return found

    monkeypatch.setattr(simplify, "KDTree", Counted)
    assert len(weld_vertices(join_meshes(fine, far)).vertices) == 1600 + 9
    assert sum(pairs) == 0  # with the reach of the far ones, 0.25, all within it would be pairs


def test_vertices_either_side_of_a_power_of_two_are_welded():
    """Of two squares that meet in a plane where float32's steps double, one is 3 of the larger steps off."""
    near, far = square(1.0, 2.0, 5), square(1.0, 2.0, 5)
    near.vertices[:, 2] -= np.float32(2.0**-22)
    far.vertices[:, 2] += np.float32(2 * 2.0**-22)
    assert len(weld_vertices(join_meshes(near, far)).vertices) == 25
