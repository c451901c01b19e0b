"""The rasteriser on planes and cubes whose depth and outline are known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.raster import rasterise, rasterise_atlas, rasterise_view
from eigenfield.runtime.parallel import set_threads

K = np.array([[40.0, 0, 32], [0, 40, 24], [0, 0, 1]])
EYE = Camera(K, np.eye(3), np.zeros(3), 64, 48)


def mesh_of(vertices, faces, uv=None):
    uv = None if uv is None else np.asarray(uv, np.float32)
    return Mesh(np.asarray(vertices, np.float32), np.asarray(faces, np.int32), uv)


def plane(z, half=5.0, slope=0.0):
    corners = [[x, y, z + slope * x] for x, y in ((-half, -half), (half, -half), (half, half), (-half, half))]
    return mesh_of(corners, [[0, 2, 1], [0, 3, 2]])


def cube(low, high):
    corners = [[(low, high)[i & 1], (low, high)[i >> 1 & 1], (low, high)[i >> 2] + 3] for i in range(8)]
    quads = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))
    return mesh_of(corners, [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))])


def test_depth_of_a_plane_is_exact():
    raster = rasterise_view(plane(2.0), EYE)
    assert (raster.face >= 0).all()
    np.testing.assert_allclose(raster.inverse_depth, 0.5, rtol=1e-6)


def test_depth_of_a_sloping_plane_is_that_of_the_ray():
    raster = rasterise_view(plane(4.0, half=7.0, slope=0.5), EYE)
    x = (np.arange(64) + 0.5 - 32) / 40  # the ray at depth z is at x z; z = 4 + x z / 2
    np.testing.assert_allclose(1 / raster.inverse_depth, np.broadcast_to(4 / (1 - x / 2), (48, 64)), rtol=1e-5)


def test_a_cube_covers_its_front_face_and_hides_its_back():
    """Seen straight on, the front face at z = 2 covers 40 / 2 * 2 = 40 pixels a side."""
    raster = rasterise_view(cube(-1.0, 1.0), EYE)
    covered = raster.face >= 0
    rows, columns = np.flatnonzero(covered.any(1)), np.flatnonzero(covered.any(0))
    assert (rows[0], rows[-1], columns[0], columns[-1]) == (4, 43, 12, 51) and covered.sum() == 1600
    assert set(np.unique(raster.face[covered])) <= {0, 1}
    np.testing.assert_allclose(raster.inverse_depth[covered], 0.5, rtol=1e-6)


def test_edge_functions_are_barycentric_coordinates_over_depth():
    mesh = mesh_of([[-1, -1, 2], [3, -1, 4], [-1, 2, 3]], [[0, 1, 2]])
    raster = rasterise_view(mesh, EYE)
    pixels, depth = EYE.project(mesh.vertices)
    at_corners = raster.edges[0] @ np.vstack([pixels.T, np.ones(3)])
    np.testing.assert_allclose(at_corners, np.diag(1 / depth), atol=1e-12)


def test_a_floor_that_reaches_behind_the_camera_is_drawn_to_the_horizon():
    floor = mesh_of([[-50, 1, -50], [50, 1, -50], [50, 1, 50], [-50, 1, 50]], [[0, 1, 2], [0, 2, 3]])
    raster = rasterise_view(floor, EYE)
    y = (np.arange(48) + 0.5 - 24) / 40
    below = y > 1 / 50 + 0.01
    np.testing.assert_allclose(
        raster.inverse_depth[below], np.broadcast_to(y[below, None], (below.sum(), 64)), rtol=1e-5
    )
    assert not (raster.face[y < 0] >= 0).any()


def test_what_lies_behind_the_camera_and_degenerate_triangles_draw_nothing():
    assert not (rasterise_view(plane(-2.0), EYE).face >= 0).any()
    line = mesh_of([[0, 0, 2], [1, 1, 2], [2, 2, 2]], [[0, 1, 2], [0, 0, 1]])
    assert not (rasterise_view(line, EYE).face >= 0).any()


@settings(max_examples=40)
@given(seed=st.integers(0, 10_000))
def test_no_cracks_between_triangles(seed):
    """A square cut into a random fan and grid covers every pixel inside it."""
    random = np.random.default_rng(seed)
    n = 6
    steps = np.linspace(0, 1, n)
    places = np.stack(np.meshgrid(steps, steps), axis=-1)
    places[1:-1, 1:-1] += random.uniform(-0.08, 0.08, (n - 2, n - 2, 2))
    depth = random.uniform(0.5, 2.0, (n, n, 1))
    corners = np.concatenate([(places * [50.3, 40.7] + [3.1, 2.2]) * depth, depth], axis=-1).reshape(-1, 3)
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = index[:-1, :-1].ravel(), index[:-1, 1:].ravel(), index[1:, 1:].ravel(), index[1:, :-1].ravel()
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)
    covered = rasterise(corners, faces, 60, 50).face >= 0
    y, x = np.mgrid[:50, :60] + 0.5
    inside = (x > 3.1) & (x < 53.4) & (y > 2.2) & (y < 42.9)
    np.testing.assert_array_equal(covered, inside)


def test_the_nearer_of_two_planes_wins_whatever_the_order():
    near, far = plane(2.0, half=0.5), plane(4.0)
    for first, second, expected in ((near, far, 0), (far, near, 1)):
        mesh = mesh_of(
            np.concatenate([first.vertices, second.vertices]), np.concatenate([first.faces, second.faces + 4])
        )
        middle = rasterise_view(mesh, EYE).face[24, 32]
        assert middle // 2 == expected


def test_atlas_texels_are_those_whose_centre_lies_in_a_chart():
    mesh = mesh_of([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]],
                   [[0.25, 0.5], [0.75, 0.5], [0.75, 1.0], [0.25, 1.0]])  # fmt: skip
    face = rasterise_atlas(mesh, 16, 8).face
    expected = np.zeros((8, 16), bool)
    expected[4:, 4:12] = True
    np.testing.assert_array_equal(face >= 0, expected)


@pytest.mark.parametrize("count", [2, 3])
def test_same_at_any_number_of_threads(count):
    results = []
    for threads in (1, count):
        set_threads(threads)
        try:
            raster = rasterise_view(cube(-1.3, 0.9), Camera(4 * K, np.eye(3), np.zeros(3), 256, 192))
        finally:
            set_threads(None)
        results.append(raster.face.tobytes() + raster.inverse_depth.tobytes())
    assert results[0] == results[1]
