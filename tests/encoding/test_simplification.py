"""Reliefs in few bytes: what an error costs, which vertices go, what is left."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eigenfield.core.camera import Camera
from eigenfield.core.lattice import Lattice, camera_lattice
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.geometry.coded import DEPTH_ERROR_PX, coded_mesh
from eigenfield.encoding.geometry.collapse_kernels import collapse, collapse_state, collapsed_faces
from eigenfield.encoding.geometry.distortion import depth_distortion, hole_error
from eigenfield.encoding.geometry.raster_kernels import TEXEL_STEPS, CostMap, mesh_cost
from eigenfield.encoding.geometry.simplify_relief import _fitted_depths, simplify_proxy_rd, simplify_relief_rd
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.relief.find_lattice import relief_lattice, relief_proxy
from support.observations import greys, repeated
from support.scenes import bumpy_square, row_grid
from support.surfaces import relief

SIDE = 40
MOST = 5.0


def valley(x, y):
    return np.abs(x - y * 0.5 - 10)


def terrain():
    """places, depth and faces of a grid of vertices at the corners of texels; the diagonals run through the middles."""
    y, x = np.mgrid[0 : SIDE + 1, 0 : SIDE + 1]
    corner = np.arange(SIDE * (SIDE + 1)).reshape(SIDE, SIDE + 1)[:, :-1].ravel()
    upper = np.stack([corner, corner + 1, corner + SIDE + 1], axis=1)
    lower = np.stack([corner + 1, corner + SIDE + 2, corner + SIDE + 1], axis=1)
    places = np.stack([x.ravel(), y.ravel()], axis=1).astype(np.int64) * TEXEL_STEPS
    return places, valley(x, y).ravel().astype(np.float64), np.concatenate([upper, lower]).astype(np.int32)


def cost_map(curve=1.0):
    row, column = np.mgrid[0:SIDE, 0:SIDE] + 0.5
    one = np.ones((SIDE, SIDE), np.float32)
    return CostMap(
        valley(column, row).astype(np.float32), one.astype(np.uint8), np.float32(curve) * one, np.float32(MOST) * one,
        np.float32(MOST) * one, np.zeros((SIDE, SIDE), np.int16),
    )  # fmt: skip


def test_faces_share_the_texels_among_themselves():
    places, depth, faces = terrain()
    below = cost_map()
    for senses in (faces, np.ascontiguousarray(faces[:, ::-1])):
        mesh_cost(below, places, depth, senses)
        assert (below.cover == 1).all()  # also those whose middle is on an edge
    random = np.random.default_rng(2)
    inside = (places > 0).all(axis=1) & (places < SIDE * TEXEL_STEPS).all(axis=1)
    places[inside] += random.integers(-TEXEL_STEPS // 5, TEXEL_STEPS // 5, (inside.sum(), 2))
    mesh_cost(below, places, depth, faces)
    assert (below.cover == 1).all()


def test_a_texel_costs_its_squared_error_and_at_most_what_else_is_there():
    places, depth, faces = terrain()
    exact = mesh_cost(cost_map(), places, depth, faces)
    one = np.zeros_like(depth)
    one[20 * (SIDE + 1) + 5] = 0.2  # far from the valley: planes on either side
    off = mesh_cost(cost_map(), places, depth + one, faces) - exact
    at = [0.1] * 4 + [0.0] * 2  # middles of the diagonals that end there, and others
    assert off == pytest.approx(sum(e**2 * MOST / (e**2 + MOST) for e in at), abs=0.02)
    assert mesh_cost(cost_map(), places, depth + 1e4, faces) == pytest.approx(MOST * SIDE**2, rel=1e-3)
    faces[:, 0] = -1
    assert mesh_cost(cost_map(), places, depth, faces) == pytest.approx(MOST * SIDE**2)


@pytest.mark.parametrize("limit", [0.01, 1.0, 20.0])
def test_collapses_lose_less_than_they_save_and_leave_a_manifold(limit):
    places, depth, faces = terrain()
    exact = np.concatenate([places / TEXEL_STEPS, depth[:, None]], axis=1)
    state, below = collapse_state(places, exact, faces), cost_map()
    before = mesh_cost(below, state.places, state.depth, state.faces)
    collapses, costs = collapse(below, state, limit)
    gone = len(collapses)
    assert (costs < limit).all()
    again = collapsed_faces(faces, collapses)
    np.testing.assert_array_equal(again[again[:, 0] >= 0], state.faces[state.faces[:, 0] >= 0])
    covered = below.cover.copy()
    left = state.faces[state.faces[:, 0] >= 0]
    after = mesh_cost(below, state.places, state.depth, left)
    np.testing.assert_array_equal(below.cover, covered)  # kept up to date on the way
    assert len(np.unique(left)) == len(places) - gone
    assert after - before < gone * limit
    corner = places[left]
    one, other = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    assert (one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0] > 0).all()  # none turned over
    edges, count = np.unique(
        np.sort(np.stack([left, np.roll(left, -1, 1)], -1).reshape(-1, 2), 1), axis=0, return_counts=True
    )
    assert count.max() <= 2 and len(edges) - len(left) - len(np.unique(left)) == -1  # Euler: one disc
    assert gone > 0.9 * len(places)  # two planes and a crease


def test_high_costs_keep_more():
    places, _, faces = terrain()
    x, y = places.T / TEXEL_STEPS
    row, column = np.mgrid[0:SIDE, 0:SIDE] + 0.5
    counts = []
    for curve in (0.0, 0.01, 1.0):
        exact = np.stack([x, y, hills(x, y)], axis=1)
        below = cost_map(curve)._replace(depth=hills(column, row).astype(np.float32))
        state = collapse_state(places, exact, faces)
        mesh_cost(below, state.places, state.depth, state.faces)
        collapse(below, state, 0.05)
        counts.append(len(np.unique(state.faces[state.faces[:, 0] >= 0])))
    assert counts[0] < counts[1] < counts[2] / 2


def hills(x, y):
    return 3 * np.sin(x / 4) * np.cos(y / 5)


def test_a_lower_limit_is_the_same_up_to_what_costs_as_much():
    places, _, faces = terrain()
    x, y = places.T / TEXEL_STEPS
    row, column = np.mgrid[0:SIDE, 0:SIDE] + 0.5

    def taken(limit):
        state = collapse_state(places, np.stack([x, y, hills(x, y)], axis=1), faces)
        below = cost_map()._replace(depth=hills(column, row).astype(np.float32))
        mesh_cost(below, state.places, state.depth, state.faces)
        return collapse(below, state, limit)

    collapses, costs = taken(1.0)
    for limit in (0.3, 0.05, 0.01):
        beyond = costs >= limit
        assert 0 < beyond.sum() < len(costs)
        np.testing.assert_array_equal(taken(limit)[0], collapses[: beyond.argmax()])


def test_vertices_of_two_charts_stay():
    places, depth, faces = terrain()
    exact = np.concatenate([places / TEXEL_STEPS, depth[:, None]], axis=1)
    exact[100] = exact[300]  # at one point of the lattice
    where = collapse_state(places, exact, faces).where
    assert where[100] == where[300] == 2 and (where[[45, 500]] == 0).all()


def waves(points):
    return (0.5 + 0.2 * np.sin(16 * points[..., 0]) * np.cos(10 * points[..., 1])).astype(np.float32)


def photographed_plane(depth=2.0, spacing=0.05):
    """A plane with waves on it as a mesh of the middle camera's pixels, nine cameras, their photographs."""
    K = np.array([[80.0, 0, 32], [0, 80.0, 24], [0, 0, 1]])
    cameras = [
        Camera(K, np.eye(3), -np.array([spacing * (i % 3 - 1), spacing * (i // 3 - 1), 0.0]), 64, 48) for i in range(9)
    ]
    y, x = np.mgrid[0:49, 0:65].astype(np.float64)
    points = np.stack([(x - 32) / 80, (y - 24) / 80, np.ones_like(x)], axis=-1) * depth
    corner = np.arange(48 * 65).reshape(48, 65)[:, :-1].ravel()
    faces = np.concatenate([
        np.stack([corner, corner + 1, corner + 65], axis=1), np.stack([corner + 1, corner + 66, corner + 65], axis=1)
    ])  # fmt: skip
    uv = np.stack([x.ravel(), y.ravel()], axis=1) / 80
    mesh = Mesh(points.reshape(-1, 3).astype(np.float32), faces.astype(np.int32), uv.astype(np.float32))
    photographs = []
    for camera in cameras:
        row, column = np.mgrid[0:48, 0:64] + 0.5
        rays = np.stack([(column - 32) / 80, (row - 24) / 80], axis=-1) * depth
        photographs.append(waves(rays + camera.centre[:2]))
    return mesh, cameras, photographs


def plane_lattice(cameras, step=0.02) -> Lattice:
    camera = cameras[4]
    return camera_lattice(camera.K @ np.hstack([camera.R, camera.t[:, None]]), 1.0, step, (0.0, 0.0))


def test_the_distortion_is_what_the_photographs_lose():
    """Against the error itself: the photographs drawn from the middle one's texture on a plane that is a little off."""
    mesh, cameras, photographs = photographed_plane()
    lattice = plane_lattice(cameras)
    distortion = depth_distortion(mesh, lattice, cameras, greys(photographs))
    assert distortion.seen == pytest.approx(9, rel=0.1)
    off = 0.5  # of the lattice's steps
    depth = 1 / (1 / 2.0 + 0.02 * off)
    inner = (slice(12, 36), slice(12, 52))
    drawn = []
    for camera, photograph in zip(cameras, photographs, strict=True):  # where each sees what the texel stands for
        row, column = np.mgrid[0:48, 0:64] + 0.5
        moved = np.stack([column, row], axis=-1) - 80 * camera.centre[:2] * (1 / depth)
        rays = (moved - [32, 24]) / 80 * 2.0 + camera.centre[:2]
        assert photograph.shape == row.shape
        drawn.append(waves(rays)[inner])
    actual = (np.square(np.stack(drawn) - np.mean(drawn, axis=0)).sum(axis=0)).sum()
    expected = off**2 * distortion.cost_map.curve[12:36, 12:52].sum()
    assert expected == pytest.approx(actual, rel=0.25)


def test_photographs_again_at_another_time_lose_as_much_again():
    mesh, cameras, photographs = photographed_plane()
    lattice, once = plane_lattice(cameras), greys(photographs)
    twice = repeated(once.pixels, 2)
    distortion, both = (depth_distortion(mesh, lattice, cameras, some) for some in (once, twice))
    assert both.seen == pytest.approx(2 * distortion.seen)
    np.testing.assert_allclose(both.cost_map.curve, 2 * distortion.cost_map.curve, rtol=1e-4)
    part = replace(mesh, faces=mesh.faces[::2])
    (error, seen), (errors, again) = (hole_error(mesh, part, cameras, some) for some in (once, twice))
    assert errors == pytest.approx(2 * error) and error > 0
    np.testing.assert_array_equal(again, seen)


def test_depths_are_fitted_but_for_those_of_kept_vertices():
    mesh, cameras, photographs = photographed_plane()
    assert mesh.uv is not None
    lattice = plane_lattice(cameras)
    distortion = depth_distortion(mesh, lattice, cameras, greys(photographs))
    exact = lattice.coordinates(mesh.vertices)
    true = exact[:, 2].copy()
    exact[:, 2] += np.random.default_rng(2).normal(0, 1, len(true))
    rough, kept = exact[:, 2], np.arange(0, len(true), 40)
    found = _fitted_depths(distortion, distortion.places(mesh.uv), exact, mesh.faces, kept)
    np.testing.assert_array_equal(found[kept], rough[kept])
    free = np.setdiff1d(np.arange(len(true)), kept)
    assert np.sqrt(np.square(found - true)[free].mean()) < 0.8 * np.sqrt(np.square(rough - true)[free].mean())
    everything = np.arange(len(true))
    np.testing.assert_array_equal(
        _fitted_depths(distortion, distortion.places(mesh.uv), exact, mesh.faces, everything), rough
    )


@pytest.mark.parametrize("kept", [[], [20]], ids=["free", "kept on one side"])
def test_charts_that_meet_stay_together(kept):
    """A plane in two charts, the right half's texture elsewhere and flat: depths fitted to either alone differ."""
    mesh, cameras, photographs = photographed_plane()
    lattice, seam = plane_lattice(cameras), 32
    right = mesh.faces.min(axis=1) % 65 >= seam
    doubled = np.unique(mesh.faces[right])
    faces = mesh.faces.copy()
    faces[right] = len(mesh.vertices) + np.searchsorted(doubled, faces[right])
    exact = lattice.coordinates(mesh.vertices)
    exact[:, 2] += np.random.default_rng(2).normal(0, 1, len(exact))
    exact = np.concatenate([exact, exact[doubled]])
    uv = np.concatenate([mesh.uv, mesh.uv[doubled] + np.float32([0.1, 0])])
    cut = Mesh(lattice.points(exact).astype(np.float32), faces, uv)
    some = np.array([65 * row + seam for row in kept], np.int64)
    distortion = depth_distortion(cut, lattice, cameras, greys(photographs))
    found = _fitted_depths(distortion, distortion.places(uv), exact, faces, some)
    np.testing.assert_array_equal(found[doubled], found[len(mesh.vertices) :])
    assert (found != exact[:, 2])[np.unique(faces)].mean() > 0.5
    assert not kept or (found[some] == exact[some, 2]).all()


def test_flat_photographs_do_not_mind():
    mesh, cameras, photographs = photographed_plane()
    flat = np.full_like(photographs[0], 0.5)
    distortion = depth_distortion(mesh, plane_lattice(cameras), cameras, greys([flat] * 9))
    assert distortion.cost_map.curve.max() == 0 and distortion.cost_map.most.max() < 1e-6


def test_a_mesh_that_no_camera_sees_costs_nothing_but_is_whole():
    mesh, cameras, photographs = photographed_plane()
    away = [replace(camera, t=camera.t + np.array([50.0, 0, 0])) for camera in cameras]
    form = simplify_relief_rd(Proxy(mesh), plane_lattice(cameras), away, greys(photographs), 1e-3, 1.0)
    assert len(form.mesh.faces) > 0


@pytest.mark.parametrize("virtual", [False, True])
def test_a_relief_takes_fewer_bytes_the_dearer_they_are(virtual):
    cameras = row_grid(9)
    made_in = cameras[5] if not virtual else replace(cameras[4], t=cameras[4].t + np.array([0.07, -0.03, 0.01]))
    mesh = relief(made_in, 0.5, virtual)
    random = np.random.default_rng(1)
    photographs = [random.random((camera.height, camera.width)).astype(np.float32) for camera in cameras]
    plain = coded_mesh(relief_proxy(mesh, cameras, DEPTH_ERROR_PX), cameras, 4)
    sizes, holes = [], []
    for lambda_ in (1e-9, 0.05):
        slim = simplify_proxy_rd(
            relief_proxy(mesh, cameras, DEPTH_ERROR_PX), cameras, 4, greys(photographs), lambda_, 1.0
        )
        found = slim.value.mesh
        sizes.append(slim.payloads.bytes)
        holes.append(hole_error(mesh, found, cameras, greys(photographs))[0])
        for camera in cameras if lambda_ < 1e-6 else ():
            before, after = rasterise_view(mesh, camera), rasterise_view(found, camera)
            both = (before.face >= 0) & (after.face >= 0)
            assert both.sum() > 0.96 * (before.face >= 0).sum()
            off = 1 / before.inverse_depth[both] - 1 / after.inverse_depth[both]
            assert np.median(np.abs(off)) < 0.01
    assert sizes[1] < 0.6 * sizes[0]
    # more bytes than without any choice only for what they close
    closed = holes[0] < hole_error(mesh, plain.value.mesh, cameras, greys(photographs))[0]
    assert closed or sizes[0] <= 1.05 * plain.payloads.bytes


def test_other_meshes_keep_their_triangles():
    mesh, cameras = bumpy_square(20), row_grid(9)
    assert mesh.uv is not None
    bent = replace(mesh, uv=(mesh.uv**2).astype(np.float32))
    assert relief_lattice(bent, cameras, DEPTH_ERROR_PX) is None
    found = simplify_proxy_rd(
        relief_proxy(bent, cameras, DEPTH_ERROR_PX), cameras, 4, greys([np.zeros((48, 64))] * 9), 1.0, 1.0
    )
    assert len(found.value.mesh.faces) == len(bent.faces) and found.payloads.bytes > 0


def test_what_a_camera_sees_through_is_found():
    mesh = bumpy_square(12)
    cameras = row_grid(9, 72, 60)
    whole, part = mesh, replace(mesh, faces=mesh.faces[: len(mesh.faces) // 2])
    bright = np.full((cameras[0].height, cameras[0].width), 0.5, np.float32)
    for before, after in ((whole, whole), (part, whole)):  # more is no hole
        error, seen = hole_error(before, after, cameras, greys([bright] * 9))
        assert error == 0 and len(seen) == 0
    lost = [(rasterise_view(m, c).face >= 0).sum() for m in (whole, part) for c in cameras]
    error, seen = hole_error(whole, part, cameras, greys([bright] * 9))
    assert error == pytest.approx(0.25 * (sum(lost[:9]) - sum(lost[9:])))
    missing = mesh.faces[len(mesh.faces) // 2 :]
    assert set(seen) <= set(missing.reshape(-1)) and len(seen) > 0.8 * len(np.unique(missing))


def test_where_the_surface_is_gone_and_none_lies_behind_the_picture_is_black():
    """Two sheets over one another: of the near one alone the photographs' variance is lost."""
    cameras = row_grid(9, 64, 48)
    near = relief(cameras[4], 0.5, False)
    lattice = relief_lattice(near, cameras, DEPTH_ERROR_PX)
    assert lattice is not None
    exact = lattice.coordinates(near.vertices)
    exact[:, 2] = exact[:, 2].mean() + 0.02 * (exact[:, 2] - exact[:, 2].mean())  # inverse depth
    near = replace(near, vertices=lattice.points(exact).astype(np.float32))
    exact[:, 2] *= 0.8
    x = near.vertices[near.faces][..., 0].mean(axis=1)
    patch = near.faces[x > np.median(x)]  # the half of the picture that the near one covers
    vertices = np.concatenate([near.vertices, lattice.points(exact).astype(np.float32)])
    uv = np.concatenate([near.uv * [0.5, 1], near.uv * [0.5, 1] + [0.5, 0]]).astype(np.float32)
    both = Mesh(vertices, np.concatenate([patch, near.faces + len(near.vertices)]).astype(np.int32), uv)
    grey = np.tile(0.5 + 0.02 * np.sin(np.arange(64)), (48, 1)).astype(np.float32)
    distortion = depth_distortion(both, lattice, cameras, greys([grey] * 9))
    cost_map = distortion.cost_map
    given, middle = cost_map.given > 0, cost_map.given.shape[1] // 2
    front = given & (np.arange(given.shape[1]) < middle)
    alone = given & ~front & (cost_map.bare > 10 * cost_map.most)
    assert (cost_map.bare[front] == cost_map.most[front]).mean() > 0.9
    assert 0.3 < alone.sum() / (given & ~front).sum() <= 1.0
    assert np.median(cost_map.bare[alone]) > 50 * np.median(cost_map.most[front])
