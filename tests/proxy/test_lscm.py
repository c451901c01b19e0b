"""Least-squares conformal charts: shapes whose maps are known, and what a bad chart is turned into."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh, triangle_areas
from eigenfield.imaging.graph import edge_components
from eigenfield.proxy import atlas_fault, atlas_statistics, chart_labels, prepare_proxy, unwrap_mesh
from eigenfield.proxy.atlas.lscm import boundary_vertices, conformal_energy, conformal_map
from eigenfield.proxy.atlas.lscm_charts import chart_scales, conformal_charts


def patch(rows, columns, place):
    """A (rows + 1) x (columns + 1) grid of vertices at place(u, v), u and v in 0..1."""
    v, u = (a.reshape(-1) for a in np.mgrid[0 : rows + 1, 0 : columns + 1] / np.array([rows, columns])[:, None, None])
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).reshape(-1)
    below = corner + columns + 1
    faces = np.concatenate([np.stack([corner, corner + 1, below + 1], 1), np.stack([corner, below + 1, below], 1)])
    return np.stack(place(u, v), axis=1).astype(np.float64), faces.astype(np.int32)


def cylinder(u, v):
    return np.cos(2 * u), np.sin(2 * u), 1.5 * v


def cone(u, v):
    r = 0.3 + v
    return r * np.cos(3 * u), r * np.sin(3 * u), -1.4 * r


def dome(u, v):
    return np.sin(1.2 * (u - 0.5)), np.sin(1.2 * (v - 0.5)), np.cos(1.2 * (u - 0.5)) * np.cos(1.2 * (v - 0.5))


def singular_ratio(vertices, uv, faces):
    """(m,) large over small singular value of the 2 x 2 matrix between each triangle's frames."""
    p, q = vertices[faces], uv[faces]
    one, two = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    x = one / np.linalg.norm(one, axis=1, keepdims=True)
    n = np.cross(one, two)
    y = np.cross(n / np.linalg.norm(n, axis=1, keepdims=True), x)
    local = np.stack([np.stack([(a * x).sum(1), (a * y).sum(1)], 1) for a in (one, two)], axis=2)
    flat = np.stack([q[:, 1] - q[:, 0], q[:, 2] - q[:, 0]], axis=2)
    values = np.linalg.svd(flat @ np.linalg.inv(local), compute_uv=False)
    return values[:, 0] / values[:, 1]


@pytest.mark.parametrize("shape", [cylinder, cone])
def test_developable_surfaces_are_unrolled(shape):
    """Their triangulations can be unrolled exactly only in strips; what is left is tiny."""
    vertices, faces = patch(40, 60, shape)
    uv = conformal_map(vertices, faces)
    assert singular_ratio(vertices, uv, faces).max() < 1.003
    a = (uv[faces[:, 1]] - uv[faces[:, 0]]).T
    b = (uv[faces[:, 2]] - uv[faces[:, 0]]).T
    area = (a[0] * b[1] - a[1] * b[0]) / 2
    assert area.min() > 0
    assert area.sum() == pytest.approx(triangle_areas(vertices[faces]).sum(), rel=1e-9)
    np.testing.assert_allclose(area, triangle_areas(vertices[faces]), rtol=0.02)


@settings(max_examples=20)
@given(seed=st.integers(0, 1000), scale=st.floats(1e-3, 1e4))
def test_a_plane_keeps_its_shape_wherever_it_lies(seed, scale):
    random = np.random.default_rng(seed)
    flat, faces = patch(4, 6, lambda u, v: (2 * u + 0.1 * np.sin(5 * v), v, 0 * u))
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    vertices = scale * (flat @ turn.T + random.normal(size=3))
    uv = conformal_map(vertices, faces)
    pairs = random.integers(0, len(flat), (40, 2))
    there = np.linalg.norm(vertices[pairs[:, 0]] - vertices[pairs[:, 1]], axis=1)
    here = np.linalg.norm(uv[pairs[:, 0]] - uv[pairs[:, 1]], axis=1)
    np.testing.assert_allclose(here, there, atol=1e-5 * scale)


def test_energy_is_zero_for_similarities_and_not_for_mirrored_ones():
    """Of a mirrored triangle W_1 u_1 + W_2 u_2 + W_3 u_3 is 4 i times its area: 16 A^2 / (2 A)."""
    flat, faces = patch(3, 5, lambda u, v: (u, v, 0 * u))
    energy = conformal_energy(flat, faces)
    turned = np.r_[2 * flat[:, 0] - flat[:, 1], flat[:, 0] + 2 * flat[:, 1]]
    mirrored = np.r_[-flat[:, 0], flat[:, 1]]
    assert turned @ energy @ turned == pytest.approx(0, abs=1e-12)
    assert mirrored @ energy @ mirrored == pytest.approx(8 * triangle_areas(flat[faces]).sum())


def test_the_map_has_less_energy_than_the_projection():
    vertices, faces = patch(12, 12, dome)
    energy = conformal_energy(vertices, faces)
    uv = conformal_map(vertices, faces)
    rim = boundary_vertices(faces, len(vertices))

    def quotient(layout):
        layout = layout - layout[rim].mean(axis=0)
        return (layout.T.reshape(-1) @ energy @ layout.T.reshape(-1)) / (layout[rim] ** 2).sum()

    assert quotient(uv) < 0.5 * quotient(vertices[:, :2])
    assert singular_ratio(vertices, uv, faces).max() < 1.1


def test_boundary_and_edge_components():
    vertices, faces = patch(3, 3, lambda u, v: (u, v, 0 * u))
    inside = (vertices[:, :2] > 0.1).all(axis=1) & (vertices[:, :2] < 0.9).all(axis=1)
    np.testing.assert_array_equal(boundary_vertices(faces, len(vertices)), ~inside)
    hinge = np.array([(0, 1, 2), (2, 3, 4), (3, 5, 4)], np.int32)  # the first hangs on at one vertex
    np.testing.assert_array_equal(edge_components(hinge), [0, 1, 1])


def as_mesh(vertices, faces, uv):
    low = uv.min(axis=0)
    return Mesh(vertices.astype(np.float32), faces, ((uv - low) / np.ptp(uv, axis=0).max()).astype(np.float32))


def test_a_spiral_ramp_that_lies_over_itself_is_cut_where_it_does():
    """A ramp of one and a half turns unrolls onto itself: some triangles must go into a chart of their own."""
    vertices, faces = patch(2, 60, lambda u, v: ((1 + v) * np.cos(9.4 * u), (1 + v) * np.sin(9.4 * u), 0.02 * u))
    laid = conformal_charts(as_mesh(vertices, faces, vertices[:, :2]))
    label = chart_labels(laid)
    assert 2 <= label.max() + 1 <= 4
    for chart in range(label.max() + 1):
        one = laid.faces[label == chart]
        used, index = np.unique(one, return_inverse=True)
        part = as_mesh(laid.vertices[used], index.reshape(-1, 3).astype(np.int32), laid.uv[used])
        assert atlas_statistics(part).overlap < 1e-4
    np.testing.assert_array_equal(laid.vertices[laid.faces], vertices.astype(np.float32)[faces])


def test_a_hinge_makes_two_charts():
    vertices = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 1, 1), (-1, 2, 0.5)], np.float64)
    faces = np.array([(0, 1, 2), (2, 4, 3)], np.int32)
    laid = conformal_charts(as_mesh(vertices, faces, vertices[:, :2]))
    assert chart_labels(laid).max() == 1


def box():
    """A cube's sides without shared vertices, outward faces."""
    sides, faces = [], []
    for axis in range(3):
        for sign in (-1, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            corner = np.zeros((4, 3))
            corner[:, axis] = sign
            corner[:, u] = (-1, 1, 1, -1)
            corner[:, v] = (-1, -1, 1, 1)
            order = np.array([(0, 1, 2), (0, 2, 3)])
            faces.append((order if sign > 0 else order[:, ::-1]) + 4 * len(sides))
            sides.append(corner)
    return np.concatenate(sides), np.concatenate(faces).astype(np.int32)


def looking_along(axis, sign, distance, focal=200.0):
    forward = np.zeros(3)
    forward[axis] = -sign
    right = np.zeros(3)
    right[(axis + 1) % 3] = 1
    R = np.stack([right, np.cross(forward, right), forward])
    return Camera(np.array([[focal, 0, 128], [0, focal, 128], [0, 0, 1.0]]), R, -R @ (-forward * distance), 256, 256)


def test_charts_of_a_cube_are_as_large_as_cameras_see_them():
    """Cameras in front of the six sides at different distances: pixels per area go with 1 / depth^2."""
    vertices, faces = box()
    depths = (2.0, 2.5, 3.0, 2.2, 2.0, 2.8)
    cameras = [looking_along(i // 2, (-1, 1)[i % 2], 1 + depth) for i, depth in enumerate(depths)]
    result = prepare_proxy(Mesh(vertices.astype(np.float32), faces), cameras)
    corners, texels = result.vertices[result.faces], result.uv[result.faces].astype(np.float64)
    a, b = texels[:, 1] - texels[:, 0], texels[:, 2] - texels[:, 0]
    area = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    axis = np.argmax(np.abs(normal), axis=1)
    side = 2 * axis + (corners.mean(axis=1)[np.arange(len(axis)), axis] > 0)
    got = np.array([area[side == i].sum() for i in range(6)])
    want = np.array(depths) ** -2.0
    np.testing.assert_allclose(got / got.sum(), want / want.sum(), rtol=0.02)
    assert atlas_fault(result) is None


def test_scales_are_bounded_and_unseen_charts_get_the_least():
    vertices, faces = box()
    mesh = Mesh(vertices.astype(np.float32), faces)
    scales = chart_scales(mesh, [looking_along(0, 1, 2.0), looking_along(1, 1, 40.0)])
    assert scales.max() <= 8 and scales.min() >= 1 / 8
    assert (scales == 1 / 8).sum() >= 4
    np.testing.assert_array_equal(chart_scales(mesh, [looking_along(0, 1, -30.0)]), np.ones(6))  # sees nothing


def test_a_wide_background_does_not_take_the_atlas():
    near, faces = patch(8, 8, lambda u, v: (u - 0.5, v - 0.5, np.full_like(u, 2.0)))
    far = patch(8, 8, lambda u, v: (30 * (u - 0.5), 30 * (v - 0.5), np.full_like(u, 12.0)))[0]
    mesh = Mesh(np.concatenate([near, far]).astype(np.float32), np.concatenate([faces, faces + len(near)]))
    K = np.array([[100.0, 0, 60], [0, 100, 60], [0, 0, 1]])
    scales = chart_scales(mesh, [Camera(K, np.eye(3), np.array([x, 0.0, 0.0]), 120, 120) for x in (-0.1, 0, 0.1)])
    assert np.isclose(scales[0] / scales[1], 6, rtol=0.02)  # as far behind: texels are spread as pixels are


@pytest.mark.slow
@settings(max_examples=2)
@given(seed=st.integers(0, 100))
def test_rough_surfaces_get_an_atlas_without_overlap(seed):
    random = np.random.default_rng(seed)
    bumps = random.normal(0, 1, (3, 3))

    def place(u, v):
        waves = sum(
            bumps[i, j] * np.sin((i + 1) * 3 * u + j) * np.cos((j + 1) * 3 * v + i) for i in range(3) for j in range(3)
        )
        return u, v, 0.1 * waves

    vertices, faces = patch(10, 10, place)
    mesh = Mesh(vertices.astype(np.float32), faces)
    result = unwrap_mesh(mesh, cameras=[looking_along(2, 1, 3.0)])
    statistics = atlas_statistics(result)
    assert statistics.overlap == 0 and statistics.flat == 0
    assert result.uv.min() >= 0 and result.uv.max() <= 1
    theirs = np.sort(np.linalg.norm(result.vertices[result.faces].sum(axis=1), axis=1))
    np.testing.assert_array_equal(theirs, np.sort(np.linalg.norm(mesh.vertices[mesh.faces].sum(axis=1), axis=1)))
    np.testing.assert_array_equal(unwrap_mesh(mesh, cameras=[looking_along(2, 1, 3.0)]).uv, result.uv)
