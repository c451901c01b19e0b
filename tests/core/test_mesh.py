"""Areas and normals of triangles that are known."""

from __future__ import annotations

import numpy as np

from eigenfield.core.mesh import Mesh, barycentric_coordinates, signed_areas, triangle_areas, vertex_normals

CORNERS = np.array(
    [[[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[1, 1, 1], [1, 1, 2], [1, 2, 2]], [[0, 0, 0], [1, 1, 1], [2, 2, 2]]]
)


def test_areas_in_space():
    np.testing.assert_allclose(triangle_areas(CORNERS.astype(float)), [6, 0.5, 0], atol=1e-15)
    mesh = Mesh(CORNERS.reshape(-1, 3).astype(np.float32), np.arange(9, dtype=np.int32).reshape(-1, 3))
    np.testing.assert_allclose(mesh.face_areas(), [6, 0.5, 0], atol=1e-15)
    np.testing.assert_allclose(mesh.face_normals(), [[0, 0, 1], [-1, 0, 0], [0, 0, 0]])
    assert len(Mesh(mesh.vertices, mesh.faces[:0]).face_areas()) == 0


def test_normals_of_vertices_are_means_by_area():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2], [5, 5, 5]])
    normals = vertex_normals(points, np.array([[0, 1, 2], [0, 2, 3]]))
    shared = np.array([2, 0, 1]) / np.sqrt(5)
    np.testing.assert_allclose(normals, [shared, [0, 0, 1], shared, [1, 0, 0], [0, 0, 0]], atol=1e-15)


def test_areas_in_the_plane_have_the_sign_of_their_turn():
    corners = CORNERS[:1, :, :2]
    np.testing.assert_array_equal(signed_areas(corners), [6])
    np.testing.assert_array_equal(signed_areas(corners[:, ::-1]), [-6])


def test_barycentric_coordinates_of_corners_sides_and_points_outside():
    corners = np.repeat(np.array([[[0, 0], [4, 0], [0, 4]]]), 4, axis=0)
    found = barycentric_coordinates(corners, np.array([[4, 0], [2, 2], [1, 1], [-4, 0]]))
    np.testing.assert_array_equal(found, [[0, 1, 0], [0, 0.5, 0.5], [0.5, 0.25, 0.25], [2, -1, 0]])
