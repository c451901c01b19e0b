"""The surface by visibility: votes of lines of sight, the minimal cut, and what it closes and leaves open."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.sparse.csgraph import maximum_flow
from scipy.spatial import Delaunay

from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.background import camera_coverage
from eigenfield.proxy.surface import visibility
from eigenfield.proxy.surface.fusion import fuse_depth_maps
from eigenfield.proxy.surface.poisson import poisson_surface
from eigenfield.proxy.surface.trim import trim_surface
from eigenfield.proxy.surface.visibility import add_weak_points, visible_surface
from eigenfield.proxy.surface.visibility_kernels import (
    CAMERA_WEIGHT,
    SOURCE,
    SURE_NOISES,
    back_slots,
    cast_votes,
    cut,
)
from eigenfield.runtime import parallel
from support.surfaces import ball_before_wall, depth_views, looking, nine_cameras, square, truth


@pytest.fixture(scope="module")
def cameras():
    return nine_cameras()


@pytest.fixture(scope="module")
def views(cameras):
    """Depth maps with noise: points that lie exactly in a plane have no Delaunay triangulation of their own."""
    rng = np.random.default_rng(0)
    true = depth_views(ball_before_wall(), cameras)
    noise = [rng.normal(scale=0.001, size=view.inverse_depth.shape) for view in true]
    return [
        replace(view, inverse_depth=(view.inverse_depth * (1 + off)).astype(np.float32))
        for view, off in zip(true, noise, strict=True)
    ]


@pytest.fixture(autouse=True)
def few_vertices(monkeypatch):
    monkeypatch.setattr(visibility, "VISIBILITY_MAX_VERTICES", 8_000)


def with_patch(views, behind):
    """Depth maps with others, such as of what lies behind, in a square of 1.4 on the wall."""
    result = []
    for view, other in zip(views, behind, strict=True):
        x, y = np.meshgrid(np.arange(view.camera.width) + 0.5, np.arange(view.camera.height) + 0.5)
        rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(view.camera.K).T
        world = (rays / np.maximum(view.inverse_depth, 1e-9)[..., None] - view.camera.t) @ view.camera.R
        result.append(replace(view, inverse_depth=np.where(in_patch(world), other, view.inverse_depth)))
    return result


def in_patch(positions, half=0.7):
    return (np.abs(positions[..., :2] - [2.0, 0]) < half).all(axis=-1) & (positions[..., 2] > 1.1)


def random_graph(count, seed):
    points = np.random.default_rng(seed).normal(size=(count, 3))
    delaunay = Delaunay(points)
    neighbours = delaunay.neighbors.astype(np.int32)
    back = np.zeros(neighbours.shape, np.int8)
    back_slots(neighbours, back)
    return points, delaunay, neighbours, back


@pytest.mark.parametrize("seed", range(3))
def test_the_cut_is_minimal(seed):
    _, _, neighbours, back = random_graph(200, seed)
    rng = np.random.default_rng(seed)
    count, real = len(neighbours), neighbours >= 0
    capacity = np.where(real, rng.integers(0, 50, neighbours.shape), 0)
    excess = rng.integers(-300, 300, count) * (rng.random(count) < 0.3)
    t, k = np.nonzero(real)
    sources, sinks = np.flatnonzero(excess > 0), np.flatnonzero(excess < 0)
    rows = np.concatenate([t, np.full(len(sources), count), sinks])
    columns = np.concatenate([neighbours[t, k], sources, np.full(len(sinks), count + 1)])
    values = np.concatenate([capacity[t, k], excess[sources], -excess[sinks]]).astype(np.int32)
    true = maximum_flow(csr_array((values, (rows, columns)), shape=(count + 2,) * 2), count, count + 1).flow_value
    tree = np.zeros(count, np.int8)
    assert cut(neighbours, back, capacity.copy(), excess.copy(), tree) == true
    full = tree != SOURCE
    across = capacity[~full[:, None] & real & full[neighbours]].sum()
    assert across + excess[(excess > 0) & full].sum() - excess[(excess < 0) & ~full].sum() == true


def test_a_line_of_sight_votes_for_the_faces_that_it_crosses():
    points, delaunay, neighbours, back = random_graph(300, 0)
    tetrahedra = delaunay.simplices.astype(np.int32)
    order = np.argsort(tetrahedra, axis=None, kind="stable")
    first = np.append(0, np.cumsum(np.bincount(tetrahedra.reshape(-1), minlength=len(points))))
    v = int(np.linalg.norm(points, axis=1).argmin())
    centre, noise, behind = np.array([[1.1, 0.2, -0.3]]), 0.1, 4.0
    capacity, excess = np.zeros(neighbours.shape), np.zeros(len(neighbours))
    cast_votes(
        points, tetrahedra, neighbours, back, first, order // 4, centre, np.array([v]), np.array([0]), np.array([2.0]),
        np.full(len(points), noise), behind, capacity, excess,
    )  # fmt: skip
    towards = centre[0] - points[v]
    length = np.linalg.norm(towards)
    inner = np.linspace(1e-6, 1, 20_000)

    def crossed(end):
        """The tetrahedra along a line, and the distances at which it goes from one to the next."""
        along = inner * np.linalg.norm(end)
        t = delaunay.find_simplex(points[v] + inner[:, None] * end)
        change = np.flatnonzero(np.diff(t))
        return np.append(t[change], t[-1]), along[change]

    front, at = crossed(towards)
    rear, beyond = crossed(-towards / length * behind * noise)
    flow = 2 * (1 - np.exp(-0.5 * SURE_NOISES**2))  # from the camera as far as the line is sure
    sure = at >= SURE_NOISES * noise
    steps = [*zip(front[1:], front, at, flow * sure, strict=False)]
    steps += [*zip(rear, rear[1:], beyond, 0 * beyond, strict=False)]
    for t, u, distance, known in steps:
        slot = int(np.flatnonzero(neighbours[t] == u)[0])
        cost = 2 * (1 - np.exp(-0.5 * (distance / noise) ** 2))
        assert capacity[t, slot] == pytest.approx(cost - known, abs=2e-2)
        assert capacity[u, back[t, slot]] == known
    assert (capacity > 0).sum() == len(steps) + sure.sum()
    assert 0 < sure.sum() < len(at)
    true = {front[-1]: 2 * CAMERA_WEIGHT - flow, front[int(sure.argmax())]: flow, rear[-1]: -2}
    assert np.flatnonzero(excess).tolist() == sorted(true) and all(excess[t] == value for t, value in true.items())


def test_the_surface_is_where_the_views_see_it_and_faces_them(views, cameras):
    mesh = visible_surface(views, 0.005)
    for view in views[::4]:
        raster = rasterise_view(mesh, view.camera)
        both = (view.inverse_depth > 0) & (raster.face >= 0)
        assert both.sum() > 0.95 * (view.inverse_depth > 0).sum()
        assert np.median(np.abs(raster.inverse_depth[both] / view.inverse_depth[both] - 1)) < 0.01
        seen = np.unique(raster.face[both])
        middles = mesh.vertices[mesh.faces[seen]].mean(axis=1)
        assert (((view.camera.centre - middles) * mesh.face_normals()[seen]).sum(axis=1) > 0).mean() > 0.98


@pytest.mark.slow
def test_what_no_view_knows_is_closed_and_what_they_see_through_is_open(views):
    far = [rasterise_view(square(9, 3.0), view.camera).inverse_depth for view in views]
    hole, open_air = with_patch(views, [0] * len(views)), with_patch(views, far)
    bare = fuse_depth_maps(hole)
    assert not in_patch(bare.positions, 0.6).any()
    closed = add_weak_points(bare, hole, 0.005)
    added = closed.positions[len(bare) :]
    middle = looking(np.array([2.0, 0, -5.0]), (2, 0, 1.2), width=20, height=20)
    assert in_patch(added).sum() > 20 and np.abs(added[in_patch(added), 2] - 1.2).max() < 0.1
    assert camera_coverage(trim_surface(poisson_surface(closed), closed), [middle])[0] == 1
    seen_through = add_weak_points(bare, open_air, 0.005).positions
    assert not (in_patch(seen_through, 0.5) & (seen_through[:, 2] < 1.4)).any()


def test_near_and_far_stay_apart(views):
    fused = fuse_depth_maps(views)
    added = add_weak_points(fused, views, 0.005).positions[len(fused) :]
    assert (truth(added) < 0.1).all()  # between the ball's rim and the wall there is nothing


def test_the_surface_does_not_depend_on_threads(views):
    try:
        parallel.set_threads(1)
        one = visible_surface(views, 0.005)
        parallel.set_threads(3)
        three = visible_surface(views, 0.005)
    finally:
        parallel.set_threads(None)
    assert np.array_equal(one.vertices, three.vertices) and np.array_equal(one.faces, three.faces)
