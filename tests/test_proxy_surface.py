"""From depth maps of known scenes to a mesh: fusion, Poisson, trimming, holes, background, neighbours, the whole."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield import parallel
from eigenfield.camera import Camera
from eigenfield.capture.lens import Lens, source_positions
from eigenfield.capture.lightfield import LightField, Photograph, View
from eigenfield.errors import ProxyError
from eigenfield.mesh import Mesh
from eigenfield.proxy import multiview
from eigenfield.proxy.background import coverage, fill_background, joined
from eigenfield.proxy.fusion import DepthView, Points, fuse, thinned
from eigenfield.proxy.multiview import surface_from_views
from eigenfield.proxy.neighbours import choose_neighbours, frustum_points, spread_views
from eigenfield.proxy.poisson import poisson_surface
from eigenfield.proxy.topology import areas, boundary_loops, compact, edge_faces, filled, manifold, without_islands
from eigenfield.proxy.topology_kernels import least_area
from eigenfield.proxy.trim import (
    distances,
    simplified_with_error,
    surface_error,
    surface_samples,
    trimmed,
    within_masks,
)
from eigenfield.raster import rasterise_view

trimesh = pytest.importorskip("trimesh")


def looking(centre, at, focal=140.0, width=160, height=120):
    """A camera at `centre` that looks at `at`, y down."""
    z = np.array(at, float) - centre
    z /= np.linalg.norm(z)
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    R = np.stack([x, np.cross(z, x), z])
    return Camera(np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1.0]]), R, -R @ centre, width, height)


def square(half, z, nodes=30):
    """A square across the z axis that faces -z."""
    steps = np.linspace(-half, half, nodes)
    x, y = np.meshgrid(steps, steps)
    first = (np.arange(nodes - 1)[:, None] * nodes + np.arange(nodes - 1)).ravel()
    faces = np.concatenate(
        [
            np.stack([first, first + nodes, first + 1], axis=1),
            np.stack([first + 1, first + nodes, first + nodes + 1], axis=1),
        ]
    )
    return Mesh(np.stack([x, y, np.full_like(x, z)], axis=-1).reshape(-1, 3).astype(np.float32), faces.astype(np.int32))


def ball(centre=(0, 0, 0), radius=1.0, level=4):
    shape = trimesh.creation.icosphere(level, radius=radius)
    return Mesh((shape.vertices + np.array(centre)).astype(np.float32), shape.faces.astype(np.int32))


@pytest.fixture(scope="module")
def scene():
    """A unit ball at the origin before a wall at z = 1.2."""
    return joined(ball(level=5), square(4, 1.2))


@pytest.fixture(scope="module")
def cameras():
    return [looking(np.array([x, y, -5.0]), (0, 0, 0.5)) for y in (-1.5, 0, 1.5) for x in (-2, 0, 2.0)]


def depth_views(mesh, cameras, **more):
    return [DepthView(camera, rasterise_view(mesh, camera).inverse_depth, **more) for camera in cameras]


@pytest.fixture(scope="module")
def points(scene, cameras):
    return fuse(depth_views(scene, cameras))


@pytest.fixture(scope="module")
def whole(points):
    return poisson_surface(points)


def truth(positions):
    """Distance from the scene's true surfaces."""
    return np.minimum(np.abs(np.linalg.norm(positions, axis=1) - 1), np.abs(positions[:, 2] - 1.2))


# ---------------------------------------------------------------- fusion


def test_fused_points_lie_on_the_surfaces_and_face_outwards(points):
    off = truth(points.positions)
    assert np.median(off) < 1e-4 and np.percentile(off, 99) < 0.01
    on_wall = np.abs(points.positions[:, 2] - 1.2) < 0.01
    assert 0.5 < on_wall.mean() < 0.95
    assert (points.normals[on_wall] @ [0, 0, -1] > 0.999).mean() > 0.98  # the rest lies at the ball's rim
    on_ball = np.abs(np.linalg.norm(points.positions, axis=1) - 1) < 0.01
    assert ((points.normals * points.positions)[on_ball].sum(axis=1) > 0.97).mean() > 0.98


def test_one_point_stands_for_a_surface_element(points):
    from scipy.spatial import KDTree

    nearest = KDTree(points.positions).query(points.positions, k=2)[0][:, 1]
    ratio = nearest / points.spacing
    assert 0.6 < np.median(ratio) < 1.2  # nine views see most of it: their own points would be a third as far apart
    assert np.percentile(ratio, 1) > 0.4


def test_fusion_does_not_depend_on_threads(scene, cameras, points):
    try:
        parallel.set_threads(1)
        one = fuse(depth_views(scene, cameras))
        parallel.set_threads(3)
        three = fuse(depth_views(scene, cameras))
    finally:
        parallel.set_threads(None)
    for name in ("positions", "normals", "colours", "spacing"):
        assert np.array_equal(getattr(one, name), getattr(three, name))
        assert np.array_equal(getattr(one, name), getattr(points, name))


def test_wrong_depths_in_one_view_leave_no_trace(scene, cameras):
    views = depth_views(scene, cameras)
    wrong = views[4].inverse_depth.copy()
    wrong[30:60, 40:80] *= 1.5  # a piece that floats before everything
    wrong[0, :5] = [np.nan, np.inf, -1, 0, 1e30]
    views[4] = DepthView(views[4].camera, wrong)
    fused = fuse(views)
    assert np.percentile(truth(fused.positions), 99.5) < 0.02


def test_colours_come_from_the_photographs(scene, cameras):
    views = []
    for camera in cameras:
        raster = rasterise_view(scene, camera)
        on_ball = (raster.face >= 0) & (raster.face < 20480)
        colour = np.where(on_ball[..., None], np.float32([1, 0, 0]), np.float32([0, 0.5, 1])).astype(np.float32)
        views.append(DepthView(camera, raster.inverse_depth, colour))
    fused = fuse(views)
    on_ball = np.abs(np.linalg.norm(fused.positions, axis=1) - 1) < 0.005
    assert (fused.colours[on_ball] == [255, 0, 0]).all(axis=1).mean() > 0.99
    assert (fused.colours[~on_ball] == [0, 128, 255]).all(axis=1).mean() > 0.98


def test_masks_keep_the_foreground_only(scene, cameras):
    masks = [rasterise_view(ball(), camera).face >= 0 for camera in cameras]
    views = [
        DepthView(c, rasterise_view(scene, c).inverse_depth, mask=mask) for c, mask in zip(cameras, masks, strict=True)
    ]
    fused = fuse(views)
    assert np.abs(np.linalg.norm(fused.positions, axis=1) - 1).max() < 0.05


def test_one_mask_that_was_not_drawn_does_not_bring_the_background_back(scene, cameras):
    masks = [rasterise_view(ball(), camera).face >= 0 for camera in cameras]
    masks[3] = np.ones_like(masks[3])
    views = [
        DepthView(c, rasterise_view(scene, c).inverse_depth, mask=mask) for c, mask in zip(cameras, masks, strict=True)
    ]
    assert np.abs(np.linalg.norm(fuse(views).positions, axis=1) - 1).max() < 0.05


def test_masks_that_hide_everything(scene, cameras):
    nothing = np.zeros((120, 160), np.bool_)
    with pytest.raises(ProxyError, match="masks hide") as caught:
        fuse(depth_views(scene, cameras, mask=nothing))
    assert caught.value.code == "surface-masked" and caught.value.remedy


def test_no_agreement_is_said(cameras):
    random = np.random.default_rng(0)
    views = [DepthView(c, random.uniform(0.1, 1, (120, 160)).astype(np.float32)) for c in cameras]
    with pytest.raises(ProxyError) as caught:
        fuse(views)
    assert caught.value.code == "surface-no-points" and "9 views" in str(caught.value)
    with pytest.raises(ProxyError) as caught:
        fuse([])
    assert caught.value.code == "surface-no-points"
    with pytest.raises(ProxyError):
        fuse([DepthView(c, np.zeros((120, 160), np.float32)) for c in cameras])


def test_thinning_keeps_the_surface_and_the_limit(points):
    few = thinned(points, 2000)
    assert 800 < len(few) <= 2000
    assert np.median(truth(few.positions)) < 0.005
    assert np.median(few.spacing) > 2 * np.median(points.spacing)
    assert np.allclose(np.linalg.norm(few.normals, axis=1), 1, atol=1e-5)
    assert thinned(points, len(points)) is points


# ---------------------------------------------------------------- Poisson, trimming, simplification


def test_poisson_is_the_same_twice_and_true(whole, points):
    again = poisson_surface(points)
    assert np.array_equal(again.vertices, whole.vertices) and np.array_equal(again.faces, whole.faces)
    assert surface_error(whole, points.positions, looking(np.array([0, 0, -5.0]), (0, 0, 0))).rms < 0.01


def test_the_surface_is_true_covers_and_is_manifold(whole, points, scene, cameras):
    mesh = trimmed(whole, points)
    for camera in cameras:
        drawn, true = rasterise_view(mesh, camera).inverse_depth, rasterise_view(scene, camera).inverse_depth
        both = (drawn > 0) & (true > 0)
        off = np.abs(drawn[both] / true[both] - 1)
        assert np.median(off) < 1e-3 and (off < 0.01).mean() > 0.95 and both.mean() > 0.8
    assert coverage(mesh, cameras)[4] > 0.99
    _, number = edge_faces(mesh.faces)
    assert np.bincount(number).max() == 2
    assert np.abs(mesh.vertices).max() < 4.4  # Poisson's closed balloon is cut
    assert (mesh.face_normals()[areas(mesh) > 0] @ [0, 0, -1]).mean() > 0.5


def test_simplification_reports_its_error(points, cameras, whole):
    fine = trimmed(whole, points)
    mesh, error = simplified_with_error(fine, points, 2000, cameras[4])
    assert 1000 < len(mesh.faces) <= 2000
    assert error.rms < 0.02 and error.relative < 0.003 and error.pixels < 0.6
    _, coarse = simplified_with_error(fine, points, 150, cameras[4])
    assert coarse.rms > 2 * error.rms and coarse.pixels > 2 * error.pixels
    assert "%" in str(error) and "px" in str(error)


def test_masks_cut_the_surface(scene, cameras):
    masks = [rasterise_view(ball(), camera).face >= 0 for camera in cameras]
    mesh = within_masks(scene, cameras, masks)
    on_ball = np.abs(np.linalg.norm(mesh.vertices, axis=1) - 1) < 1e-4
    assert on_ball.sum() == 10242 and len(mesh.faces) < 20600  # all of the ball, of the wall only what it hides
    assert np.linalg.norm(mesh.vertices[~on_ball][:, :2], axis=1).max() < 0.9
    assert len(within_masks(ball(), cameras, [None] * 9).faces) == len(ball().faces)
    with pytest.raises(ProxyError) as caught:
        within_masks(scene, cameras, [np.zeros((120, 160), np.bool_)] * 9)
    assert caught.value.code == "surface-empty"


def test_too_few_points_are_no_surface():
    few = Points(np.zeros((3, 3)), np.zeros((3, 3), np.float32), np.zeros((3, 3), np.uint8), np.ones(3, np.float32))
    with pytest.raises(ProxyError, match="3 points") as caught:
        poisson_surface(few)
    assert caught.value.code == "surface-no-points"


def test_a_surface_far_from_all_points_comes_out_empty(points):
    with pytest.raises(ProxyError) as caught:
        trimmed(ball(centre=(50, 0, 0), level=5, radius=8), points)
    assert caught.value.code == "surface-empty"


def test_distances_of_known_points():
    mesh = square(1, 0.0, 5)
    away = np.array([[0.1, 0.2, 0.5], [0.3, -0.2, -2.0], [2.0, 0.0, 0.0], [2.0, 2.0, 1.0]])
    assert np.allclose(distances(mesh, away), [0.5, 2.0, 1.0, np.sqrt(3)], atol=1e-6)


def test_samples_are_spread_by_area():
    mesh = joined(square(1, 0.0, 5), square(2, 1.0, 5))
    samples, face = surface_samples(mesh, 10_000)
    assert np.isclose((samples[:, 2] == 1).mean(), 0.8, atol=0.01)
    assert np.abs(samples[samples[:, 2] == 1][:, :2].mean(axis=0)).max() < 0.03
    assert np.array_equal(np.unique(face), np.arange(len(mesh.faces)))


# ---------------------------------------------------------------- topology


def holed(mesh, which):
    return compact(Mesh(mesh.vertices, mesh.faces[~which]))


def test_small_holes_are_filled_large_ones_stay():
    mesh = square(2, 0.0, 41)
    middle = mesh.vertices[mesh.faces].mean(axis=1)[:, :2]
    small = np.linalg.norm(middle - [1, 1], axis=1) < 0.25
    large = np.linalg.norm(middle - [-0.5, -0.5], axis=1) < 0.9
    mesh = holed(mesh, small | large)
    assert len(boundary_loops(mesh)) == 3
    result = filled(mesh, 1.0)
    assert len(boundary_loops(result)) == 2
    missing = 16 - areas(result).sum()
    assert np.isclose(missing, areas(square(2, 0.0, 41))[large].sum(), rtol=1e-4)  # the small hole is closed exactly
    assert (result.face_normals()[areas(result) > 0] @ [0, 0, -1] > 0.99).all()  # and faces as the rest does


def test_an_outer_border_is_no_hole():
    mesh = square(0.1, 0.0, 6)
    assert np.array_equal(filled(mesh, 10.0).faces, mesh.faces)


@settings(max_examples=40, deadline=None)
@given(st.integers(3, 40), st.integers(0, 2**31))
def test_least_area_triangulates_any_loop(count, seed):
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0, 2 * np.pi, count))
    loop = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
    triangles = least_area(loop)
    assert triangles.shape == (count - 2, 3) and set(triangles.ravel()) == set(range(count))
    x, y = loop[:, 0], loop[:, 1]
    polygon = abs((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()) / 2
    flat = areas(Mesh(loop.astype(np.float32), triangles.astype(np.int32))).sum()
    assert np.isclose(flat, polygon, rtol=1e-4, atol=1e-6)


def test_least_area_spans_a_bent_loop_over_the_short_way():
    loop = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 1.0], [0, 1, 0]], float)
    area = areas(Mesh(loop.astype(np.float32), least_area(loop).astype(np.int32))).sum()
    other = areas(Mesh(loop.astype(np.float32), np.array([[1, 2, 3], [1, 3, 0]], np.int32))).sum()
    one = areas(Mesh(loop.astype(np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.int32))).sum()
    assert np.isclose(area, min(one, other))


def test_islands_go_by_their_share_of_the_area():
    mesh = joined(square(1, 0.0), square(0.05, 3.0), square(0.4, 5.0))
    assert set(np.unique(without_islands(mesh, 0.01).vertices[:, 2])) == {0.0, 5.0}
    assert set(np.unique(without_islands(mesh, 0.5).vertices[:, 2])) == {0.0}


def test_no_edge_keeps_three_faces_and_no_vertex_two_fans():
    vertices = np.array(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 0.1], [-1, -1, 0], [-1, 0, 1], [5, 5, 5]], np.float32
    )
    faces = np.array(
        [
            [0, 1, 2],
            [1, 0, 3],
            [0, 1, 4],  # a third face, and the smallest, at the edge 0 1
            [0, 5, 6],  # touches the rest in vertex 0 alone
            [0, 1, 2],  # twice
            [2, 2, 1],  # no triangle
        ],
        np.int32,
    )
    mesh = manifold(Mesh(vertices, faces))
    assert len(mesh.faces) == 3
    _, number = edge_faces(mesh.faces)
    assert np.bincount(number).max() == 2
    assert len(mesh.vertices) == 7  # vertex 0 is doubled; 4 and 7 are gone
    assert len(boundary_loops(mesh)) == 2


def test_a_clean_mesh_stays_as_it_is():
    mesh = ball()
    same = manifold(mesh)
    assert np.array_equal(same.faces, mesh.faces) and np.array_equal(same.vertices, mesh.vertices)
    assert boundary_loops(mesh) == []


# ---------------------------------------------------------------- background


def test_the_background_closes_every_view_behind_everything(cameras):
    mesh = joined(ball(), square(1.5, 1.2))
    before = coverage(mesh, cameras)
    assert before.max() < 0.6
    closed = fill_background(mesh, cameras)
    assert (coverage(closed, cameras) == 1).all()
    for camera in cameras:  # nothing of the mesh is hidden by it, beyond a pixel's rounding
        own, both = rasterise_view(mesh, camera), rasterise_view(closed, camera)
        there = own.face >= 0
        assert (both.inverse_depth[there] > own.inverse_depth[there] * 1.001).mean() < 1e-3
    far = closed.vertices[len(mesh.vertices) :]
    assert 1.2 < np.median(far[:, 2]) < 2.5  # goes on where the wall ends, not at infinity


def test_the_background_goes_on_in_the_plane_of_a_slanted_wall(cameras):
    wall = square(2.5, 0.0, 40)
    tilt = wall.vertices.astype(np.float64) @ np.array([[1, 0, 0.3], [0, 1, 0], [0, 0, 1]])
    closed = fill_background(Mesh(tilt.astype(np.float32), wall.faces), cameras)
    assert (coverage(closed, cameras) == 1).all()
    far = closed.vertices[len(wall.vertices) :].astype(np.float64)
    inside = np.abs(far[:, :2]).max(axis=1) < 3.5
    assert inside.sum() > 20
    assert np.abs(far[inside, 2] - 0.3 * far[inside, 0]).max() < 0.6


def test_a_walk_around_gets_a_dome(cameras):
    around = [
        looking(np.array([5 * np.sin(a), -1.0, 5 * np.cos(a)]), (0, 0, 0)) for a in np.linspace(0, 2 * np.pi, 12)[:-1]
    ]
    closed = fill_background(ball(), around)
    assert (coverage(closed, around) == 1).all()
    assert np.linalg.norm(closed.vertices[2562:], axis=1).min() > 5.0  # beyond all cameras


def test_backgrounds_of_nothing_are_refused(cameras):
    with pytest.raises(ProxyError) as caught:
        fill_background(Mesh(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32)), cameras)
    assert caught.value.code == "surface-empty"


# ---------------------------------------------------------------- neighbours and the whole


def test_neighbours_stand_aside_but_not_too_far():
    arc = [looking(np.array([5 * np.sin(a), 0, -5 * np.cos(a)]), (0, 0, 0)) for a in np.radians(np.arange(0, 360, 5))]
    chosen = choose_neighbours(0, arc, frustum_points(arc[0], 1 / 5.5, 1 / 4.5), 4)
    steps = [i if i < 36 else i - len(arc) for i in chosen]
    assert (
        len(steps) == 4 and max(map(abs, steps)) <= 4 and min(steps) < 0 < max(steps)
    )  # at most 20 degrees, both sides


def test_a_view_from_the_same_place_is_no_neighbour(cameras):
    twice = [*cameras, cameras[4]]
    chosen = choose_neighbours(4, twice, frustum_points(cameras[4], 0.15, 0.25), 8)
    assert len(twice) - 1 not in chosen and len(chosen) >= 3


def test_spread_views_are_spread(cameras):
    assert spread_views(cameras, 20) == list(range(9))
    chosen = spread_views(cameras, 5)
    assert set(chosen) == {0, 2, 4, 6, 8}


class Drawn(LightField):
    """A light field whose photographs are computed: a texture fixed to the surface."""

    def __init__(self, mesh, cameras, mask=None):
        views = tuple(View(f"{i}.png", None, camera) for i, camera in enumerate(cameras))
        super().__init__(None, views, (), "drawn")
        object.__setattr__(self, "_drawn", (mesh, mask))

    def photograph(self, index):
        mesh, mask = self._drawn
        camera = self.views[index].camera
        raster = rasterise_view(mesh, camera)
        x, y = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
        rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(camera.K).T
        depth = 1 / np.maximum(raster.inverse_depth, 1e-9)
        world = (rays * depth[..., None] - camera.t) @ camera.R
        waves = np.random.default_rng(1).normal(size=(24, 3)) * np.geomspace(2, 22, 24)[:, None]
        phase = np.random.default_rng(2).uniform(0, 6, (24, 3))
        value = np.sin(np.einsum("hwk,nk->hwn", world, waves)[..., None] + phase).mean(axis=2)
        pixels = np.clip(0.5 + 1.2 * value, 0, 1).astype(np.float32)
        pixels[raster.face < 0] = 0
        return Photograph(pixels, None if mask is None else mask[index].astype(np.float32))


@pytest.mark.slow
def test_photographs_to_a_surface(scene, cameras):
    light_field = Drawn(scene, cameras)
    stages = []
    surface = surface_from_views(light_field, triangles=4000, progress=lambda stage, done, total: stages.append(stage))
    assert (surface.coverage == 1).all()
    view = rasterise_view(surface.mesh, cameras[4])
    true = rasterise_view(scene, cameras[4]).inverse_depth
    off = np.abs(view.inverse_depth / true - 1)
    assert np.median(off) < 0.005 and (off < 0.02).mean() > 0.9
    assert {"photographs", "coarse depth", "depth", "fusion", "surface"} <= set(stages)


@pytest.mark.slow
def test_photographs_with_masks_give_the_foreground_without_a_background(scene, cameras):
    masks = [rasterise_view(ball(), camera).face >= 0 for camera in cameras]
    points = ball(level=3).vertices.astype(np.float64)
    surface = surface_from_views(Drawn(scene, cameras, masks), points, triangles=4000)
    near = surface.mesh.vertices[surface.mesh.vertices[:, 2] < 0.2]  # what is behind no camera sees
    off = np.abs(np.linalg.norm(near, axis=1) - 1)
    assert np.median(off) < 0.03 and np.percentile(off, 90) < 0.15
    seen = rasterise_view(surface.mesh, cameras[4]).face >= 0
    assert (seen & masks[4]).sum() > 0.85 * masks[4].sum() and (seen & ~masks[4]).sum() < 0.1 * masks[4].sum()


def test_photographs_that_are_all_masked(scene, cameras):
    masks = [np.zeros((120, 160), np.bool_)] * len(cameras)
    with pytest.raises(ProxyError) as caught:
        surface_from_views(Drawn(scene, cameras, masks))
    assert caught.value.code == "surface-masked"


def test_photographs_that_share_nothing(scene):
    apart = [looking(np.array([100.0 * i, 0, -5]), (100.0 * i + 500 * i, 0, 0)) for i in range(4)]
    points = np.random.default_rng(0).normal(size=(100, 3))
    with pytest.raises(ProxyError) as caught:
        surface_from_views(Drawn(scene, apart), points)
    assert caught.value.code == "surface-overlap" and "4 photographs" in str(caught.value)


def test_the_border_that_lens_removal_leaves_is_no_mask(scene, cameras):
    lens = Lens("brown", (0.3, 0.0, 0.0, 0.0, 0.0))
    K = cameras[0].K
    inside = source_positions(K, lens, 160, 120)[2]
    assert 0.5 < inside.mean() < 0.99
    drawn = rasterise_view(ball(), cameras[0]).face >= 0
    for mask, real in ((inside, False), (inside & drawn, True)):
        light_field = Drawn(scene, cameras, [mask] * 9)
        object.__setattr__(light_field, "views", tuple(replace(view, lens=lens) for view in light_field.views))
        picture = multiview._pictures(light_field, [0], 100_000, None)[0]
        assert (picture.mask is not None) == real
        assert picture.known is not None and np.array_equal(picture.known, inside)


def test_resizing_keeps_what_a_camera_sees():
    camera = looking(np.array([0, 0, -5.0]), (0, 0, 0), width=160, height=121)
    small = camera.resized(53, 40)
    x, y = np.meshgrid(np.arange(160) + 0.5, np.arange(121) + 0.5)
    picture = np.stack([x, y, np.zeros_like(x)], axis=-1).astype(np.float32)
    result = multiview._resampled(picture, camera, small)
    back = np.linalg.inv(small.K) @ np.array([20.5, 10.5, 1])  # the middle of pixel (10, 20)
    place = camera.K @ back
    assert np.allclose(result[10, 20, :2], place[:2] / place[2], atol=0.05)
