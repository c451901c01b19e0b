"""Layered reliefs: depth maps whose mesh is known, and what must hold for all of them."""

from __future__ import annotations

import logging
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.ndimage import distance_transform_edt, gaussian_filter

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.imaging.raster import rasterise_atlas, rasterise_view
from eigenfield.proxy import atlas_fault, atlas_statistics, chart_labels, estimate_second_layer, relief_mesh
from eigenfield.proxy.relief import height_field
from eigenfield.proxy.relief.contours import find_cut_edges, straighten_chain, trace_contours
from eigenfield.proxy.relief.height_field import triangulate_height_field
from eigenfield.proxy.relief.kernels import label_pixels
from eigenfield.proxy.relief.triangulation import DELAUNAY_STEPS_PER_PIXEL
from eigenfield.proxy.topology import face_components
from eigenfield.stereo import ReferenceView, view_matrices

OFFSET, SCALE = 0.25, 0.01  # 1/Z = OFFSET + SCALE d


def camera(width=60, height=40, at=(0.0, 0.0, 0.0), focal=80.0):
    K = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1.0]])
    return Camera(K, np.eye(3), -np.asarray(at, np.float64), width, height)


def reference_view(height=40, width=60, margin=0):
    return ReferenceView.with_margin(camera(width - 2 * margin, height - 2 * margin), margin, OFFSET, SCALE)


def depth_of(mesh, frame):
    """The labels that a mesh shows in the reference view, and where it does."""
    drawn = rasterise_view(mesh, frame.camera)
    return (drawn.inverse_depth - frame.offset) / frame.scale, drawn.face >= 0


def ramp(height=40, width=60):
    y, x = np.mgrid[:height, :width]
    return (0.03 * x - 0.05 * y + 1).astype(np.float32)


def covers(field, valid):
    """Does a triangle lie over the centre of every valid pixel? In whole numbers, so exactly."""
    owner = np.empty(valid.shape, np.int32)
    points = np.rint(np.stack([field.x, field.y], axis=1) * DELAUNAY_STEPS_PER_PIXEL).astype(np.int64)
    label_pixels(points, field.faces.astype(np.int64), len(field.faces), owner)
    return bool((owner[valid] >= 0).all())


def everywhere(d):
    return np.ones(d.shape, np.bool_)


def test_a_plane_is_two_triangles_and_exact():
    d = ramp()
    mesh = relief_mesh(reference_view(), d, everywhere(d), cut=1.0, tolerance=0.01)
    assert len(mesh.faces) <= 4
    shown, covered = depth_of(mesh, reference_view())
    assert covered.all()
    np.testing.assert_allclose(shown, d, atol=2e-3)
    centre = mesh.vertices.mean(axis=0)
    assert (mesh.face_normals() @ centre < 0).all()  # counter-clockwise as the camera at the origin sees them
    assert atlas_fault(mesh) is None


def test_a_step_is_cut_and_its_two_sides_are_exact():
    d = ramp()
    d[:, 30:] += 3
    field = triangulate_height_field(d, everywhere(d), cut=1.0, tolerance=0.01)
    on = np.abs(field.x - 29.5) < 1e-6
    top = np.sort(field.d[on & (field.y < 1)])
    np.testing.assert_allclose(np.diff(top), [3], atol=0.02)  # two vertices at one place, 3 apart
    assert len(field.faces) <= 12
    mesh = relief_mesh(reference_view(), d, everywhere(d), cut=1.0, tolerance=0.01)
    shown, covered = depth_of(mesh, reference_view())
    assert covered.all()
    np.testing.assert_allclose(shown, d, atol=0.02)


def test_without_a_cut_the_step_is_one_surface():
    d = ramp()
    d[:, 30:] += 3
    whole = triangulate_height_field(d, everywhere(d), cut=10.0, tolerance=0.01)
    places = np.stack([whole.x, whole.y], axis=1)
    assert len(np.unique(places.round(6), axis=0)) == len(places)


def test_a_cut_that_ends_inside_leaves_one_surface():
    """A gap that closes: both sides of the cut have their own vertices, its end has one."""
    y, x = np.mgrid[:60, :80]
    d = np.where(x < 40, 0.0, np.maximum(0, 3 - 0.1 * y)).astype(np.float32)
    field = triangulate_height_field(d, everywhere(d), cut=0.5, tolerance=0.05)
    assert face_components(field.faces, len(field.x)).max() == 0
    on = np.abs(field.x - 39.5) < 0.6
    places, count = np.unique(np.stack([field.x[on], field.y[on]], 1).round(4), axis=0, return_counts=True)
    assert (count == 2).sum() >= 1 and places[count == 2, 1].max() < 27


def test_a_leaning_edge_is_straight_and_not_a_staircase():
    y, x = np.mgrid[:80, :100]
    inside = x * np.cos(0.3) + y * np.sin(0.3) < 60.3
    chains = trace_contours(
        *find_cut_edges(np.where(inside, 2, 0).astype(np.float32), np.ones((80, 100), np.bool_), 1.0)
    )
    assert len(chains) == 1
    line = straighten_chain(chains[0], 0.5)
    assert len(line) <= 5
    off = line[1:-1] @ (np.cos(0.3), np.sin(0.3)) - 60.3
    assert np.abs(off).max(initial=0) < 0.3
    middle = (line[1:] + line[:-1]) / 2
    assert np.abs(middle @ (np.cos(0.3), np.sin(0.3)) - 60.3).max() < 0.3


def test_contours_of_a_square_and_of_a_junction():
    label = np.zeros((12, 12), np.float32)
    label[3:9, 3:9] = 5
    chains = trace_contours(*find_cut_edges(label, np.ones((12, 12), np.bool_), 1.0))
    assert len(chains) == 1 and (chains[0][0] == chains[0][-1]).all() and len(chains[0]) == 25
    label[6:, :] += 20
    chains = trace_contours(*find_cut_edges(label, np.ones((12, 12), np.bool_), 1.0))
    ends = np.array([chain[[0, -1]] for chain in chains])
    assert len(chains) == 5  # two arcs, one line through, cut into three at the junctions
    assert {(2.5, 5.5), (8.5, 5.5)} <= {tuple(p) for p in ends.reshape(-1, 2)}


def bumpy(seed, height=48, width=64):
    """A smooth depth map with islands in front, and some pixels invalid."""
    random = np.random.default_rng(seed)
    d = gaussian_filter(random.normal(size=(height, width)), 8) * 20
    for _ in range(random.integers(0, 6)):
        near = gaussian_filter(random.normal(size=(height, width)), random.uniform(1.5, 6))
        d = np.where(near > np.quantile(near, random.uniform(0.7, 0.97)), d + random.uniform(1, 4), d)
    gone = gaussian_filter(random.normal(size=(height, width)), 3)
    return d.astype(np.float32), gone <= np.quantile(gone, random.uniform(0.8, 1))


@settings(max_examples=40)
@given(seed=st.integers(0, 10_000), tolerance=st.floats(0.02, 0.5))
@pytest.mark.slow
def test_every_relief_covers_its_pixels_within_the_tolerance(seed, tolerance):
    d, valid = bumpy(seed)
    if not valid.any():
        return
    frame = reference_view(*d.shape)
    mesh = relief_mesh(frame, d, valid, cut=0.6, tolerance=tolerance)
    shown, covered = depth_of(mesh, frame)
    assert covered[valid].mean() > 0.99  # float32 vertices leave hairlines at cuts
    assert covers(triangulate_height_field(d, valid, cut=0.6, tolerance=tolerance), valid)
    beside, below = find_cut_edges(d, valid, 0.6)
    mixed = np.zeros(d.shape, np.bool_)
    mixed[:, 1:] |= beside
    mixed[:, :-1] |= beside
    mixed[1:] |= below
    mixed[:-1] |= below
    clear = valid & covered & ~mixed
    error = np.abs(shown - d)[clear]
    assert np.quantile(error, 0.99, method="lower") <= 1.2 * tolerance if clear.any() else True
    assert mesh.uv.min() >= 0 and mesh.uv.max() <= 1
    assert atlas_statistics(mesh).overlap == 0
    again = relief_mesh(frame, d, valid, cut=0.6, tolerance=tolerance)
    np.testing.assert_array_equal(again.vertices, mesh.vertices)
    np.testing.assert_array_equal(again.faces, mesh.faces)


@settings(max_examples=15)
@given(seed=st.integers(0, 10_000))
@example(seed=7331)
def test_every_pixel_of_noise_is_cut_without_crossings(seed):
    """Independent pixels: contours everywhere, many junctions, lines that cross when straightened."""
    random = np.random.default_rng(seed)
    d = random.integers(0, 4, (24, 24)).astype(np.float32)
    field = triangulate_height_field(d, everywhere(d), cut=0.5, tolerance=0.1)
    p = np.stack([field.x, field.y], axis=1)[field.faces]
    a, b = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    area = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    assert (area > 0).all()
    assert area.sum() == pytest.approx(26 * 26, rel=0.03)  # a pixel more all round
    assert covers(field, everywhere(d))
    between = replace(field, x=4 * field.x + 0.3, y=4 * field.y + 0.3)  # no hole between pixels either
    assert covers(between, np.ones((93, 93), np.bool_))


def test_lines_that_cross_when_straightened_go_back_to_their_chains(monkeypatch):
    random = np.random.default_rng(9)
    hills = gaussian_filter(random.normal(size=(80, 80)), 2.2)
    d = np.digitize(hills, np.quantile(hills, [0.2, 0.4, 0.6, 0.8])).astype(np.float32)
    clashes = []
    real = height_field._constrained_delaunay

    def spy(*arguments):
        result = real(*arguments)
        clashes.append(int(result[1].sum()))
        return result

    monkeypatch.setattr(height_field, "_constrained_delaunay", spy)
    assert covers(triangulate_height_field(d, everywhere(d), cut=0.5, tolerance=0.1), everywhere(d))
    assert clashes[0] >= 1 and clashes[-1] == 0


def test_two_layers_share_the_atlas_without_overlap():
    y, x = np.mgrid[:120, :160]
    d = (0.02 * x + np.sin(y / 9)).astype(np.float32)
    near = gaussian_filter((np.random.default_rng(1).random(d.shape) > 0.995).astype(np.float64), 4) > 0.005
    frame = reference_view(*d.shape)
    mesh = relief_mesh(frame, d, everywhere(d), (d - 2, near), cut=0.6, tolerance=0.1)
    statistics = atlas_statistics(mesh)
    assert statistics.overlap == 0 and statistics.fill > 0.6
    assert atlas_fault(mesh) is None
    label = chart_labels(mesh)
    side = round(1 / np.median(texels(mesh, frame)))  # one texel a canvas pixel
    face = rasterise_atlas(mesh, side, side).face
    chart = np.where(face >= 0, label[face], -1)
    assert len(np.unique(chart)) > 3
    for one in range(label.max() + 1):
        others = (chart >= 0) & (chart != one)
        assert distance_transform_edt(chart != one)[others].min() >= 4


def texels(mesh, frame):
    """(m,) atlas units a canvas pixel, of each triangle."""
    flat, _ = frame.camera.project(mesh.vertices)
    p, q = flat[mesh.faces], mesh.uv[mesh.faces].astype(np.float64)

    def area(c):
        a, b = c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]
        return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2

    big = area(p) > 1
    return np.sqrt(area(q)[big] / area(p)[big])


def test_texels_are_even():
    d, valid = bumpy(3, 90, 120)
    even = texels(relief_mesh(reference_view(*d.shape), d, valid, cut=0.6, tolerance=0.05), reference_view(*d.shape))
    assert even.max() / even.min() < 1.001


def test_the_limit_of_triangles_holds(caplog):
    d, valid = bumpy(11, 120, 160)
    d += np.random.default_rng(0).normal(0, 0.2, d.shape).astype(np.float32)
    frame = reference_view(*d.shape)
    free = relief_mesh(frame, d, valid, cut=1.5, tolerance=0.05)
    with caplog.at_level(logging.INFO, "eigenfield.proxy"):
        few = relief_mesh(frame, d, valid, cut=1.5, tolerance=0.05, triangles=1500)
    assert len(few.faces) <= 1500 < len(free.faces)
    assert "leave an error" in caplog.text


def test_a_depth_map_without_surface():
    d = ramp()
    with pytest.raises(ProxyError) as caught:
        relief_mesh(reference_view(), d, np.zeros(d.shape, np.bool_), cut=1, tolerance=0.1)
    assert caught.value.code == "relief-empty"


def test_labels_beyond_infinity_are_put_far_away():
    d = np.full((20, 30), -40, np.float32)  # 1/Z = -0.15
    d[:, 15:] = 0
    mesh = relief_mesh(reference_view(20, 30), d, everywhere(d), cut=5, tolerance=0.1)
    assert np.isfinite(mesh.vertices).all() and (mesh.vertices[:, 2] > 0).all()


def world(at, width=64, height=48):
    """A textured card in front of a textured wall as a camera at (x, y, 0) sees it: photograph and depth labels."""

    def pattern(x, y, phase):
        waves = (
            np.sin(3 * x + phase) + np.sin(5 * y + 2 * phase) + np.sin(7 * x - 4 * y) + np.cos(11 * x + 9 * y + phase)
        )
        return 127 + 30 * waves

    y, x = np.mgrid[:height, :width]
    focal, (wall, card) = 80.0, (4.0, 2.5)
    ray_x, ray_y = (x + 0.5 - width / 2) / focal, (y + 0.5 - height / 2) / focal
    card_x, card_y = at[0] + card * ray_x, at[1] + card * ray_y
    on = (np.abs(card_x) < 0.3) & (np.abs(card_y) < 0.25)
    wall_colour = pattern(4 * (at[0] + wall * ray_x), 4 * (at[1] + wall * ray_y), 0.0)
    grey = np.where(on, pattern(5 * card_x, 5 * card_y, 1.0), wall_colour)
    label = (np.where(on, 1 / card, 1 / wall) - OFFSET) / SCALE
    return np.repeat(np.rint(grey)[..., None], 3, 2).astype(np.uint8), label.astype(np.float32)


def test_the_second_layer_finds_the_wall_behind_the_card_and_covers_every_view():
    margin = 12
    spots = [(0.04 * i, 0.04 * j, 0.0) for j in range(-3, 4) for i in range(-3, 4)]
    cameras = [camera(64, 48, at) for at in spots]
    pictures = np.stack([world(at)[0] for at in spots])
    frame = ReferenceView.with_margin(camera(64, 48), margin, OFFSET, SCALE)
    d = world((0, 0), *reversed(frame.shape))[1]
    matrices = view_matrices(frame, cameras)
    wide, valid = estimate_second_layer(pictures, matrices, d, cut=3.0)
    assert valid.any() and (wide[valid] < d[valid]).all()
    card = d > 10
    hidden = valid & card
    assert 0.1 < hidden.sum() / card.sum() <= 1
    assert np.median(np.abs(wide[hidden])) < 1.0  # the wall is at label 0, the card at 15
    one = relief_mesh(frame, d, everywhere(d), cut=3.0, tolerance=0.1)
    two = relief_mesh(frame, d, everywhere(d), (wide, valid), cut=3.0, tolerance=0.1)
    corners = [cameras[i] for i in (0, 6, 42, 48)]
    holes = [(rasterise_view(one, c).face < 0).mean() for c in corners]
    left = [(rasterise_view(two, c).face < 0).mean() for c in corners]
    assert min(holes) > 0.01 > max(left)
    again = estimate_second_layer(pictures, matrices, d, cut=3.0)
    np.testing.assert_array_equal(again[0], wide)


def test_a_depth_map_without_cuts_needs_no_second_layer():
    pictures = np.zeros((2, 40, 60, 3), np.uint8)
    matrices = view_matrices(reference_view(), [camera(), camera(at=(0.1, 0, 0))])
    _, valid = estimate_second_layer(pictures, matrices, ramp(), cut=1.0)
    assert not valid.any()


def test_second_layer_reports_its_progress_from_the_first_step_to_the_last():
    spots = [(0.04 * i, 0.04 * j, 0.0) for j in (-1, 0, 1) for i in (-1, 0, 1)]
    frame = ReferenceView.with_margin(camera(64, 48), 12, OFFSET, SCALE)
    matrices = view_matrices(frame, [camera(64, 48, at) for at in spots])
    reports = []
    estimate_second_layer(
        np.stack([world(at)[0] for at in spots]), matrices, world((0, 0), *reversed(frame.shape))[1], cut=3.0,
        progress=lambda *each: reports.append(each),
    )  # fmt: skip
    assert {stage for stage, _, _ in reports} == {"second layer"}
    done = [step for _, step, _ in reports]
    assert done[0] == 0 and done == sorted(done) and done[-1] == reports[-1][2]


def leaves(frame):
    """A wall, a leaf before it, a smaller one before that."""
    d = np.zeros(frame.shape, np.float32)
    d[14:44, 20:60] = 8.0
    d[22:36, 30:48] = 18.0
    return d


def turned(camera, degrees):
    angle = np.radians(degrees)
    turn = np.array([[np.cos(angle), 0, -np.sin(angle)], [0, 1, 0], [np.sin(angle), 0, np.cos(angle)]])
    return Camera(camera.K, turn @ camera.R, turn @ camera.t, camera.width, camera.height)


def open_pixels(mesh, cameras):
    return sum(int((rasterise_view(mesh, each).face < 0).sum()) for each in cameras)


def test_the_backdrop_closes_every_view_and_stays_behind_the_layers():
    frame = ReferenceView.with_margin(camera(64, 48), 12, OFFSET, SCALE)
    d = leaves(frame)
    cameras = [camera(64, 48, (0.05 * i, 0.05 * j, 0)) for i in range(-2, 3) for j in range(-2, 3)]
    cameras += [turned(camera(64, 48, (0.1, 0, 0)), 8), turned(camera(64, 48, (-0.1, 0, 0)), -8)]
    torn = relief_mesh(frame, d, everywhere(d), cut=3.0, tolerance=0.1)
    closed = relief_mesh(frame, d, everywhere(d), cut=3.0, tolerance=0.1, cameras=cameras)
    assert open_pixels(torn, cameras) > 500 and open_pixels(closed, cameras) == 0
    between = [camera(64, 48, (0.05 * i + 0.025, 0.05 * j, 0)) for i in range(-2, 2) for j in range(-2, 3)]
    assert open_pixels(closed, between) == 0
    shown, there = depth_of(closed, frame)
    before, _ = depth_of(torn, frame)
    assert there.all()
    np.testing.assert_allclose(shown, before, atol=1e-3)
    assert atlas_fault(closed) is None
    assert atlas_statistics(closed).overlap == 0


def test_without_anything_open_there_is_no_backdrop():
    frame = ReferenceView.with_margin(camera(64, 48), 12, OFFSET, SCALE)
    d = ramp(*frame.shape)
    near = [camera(64, 48, (0.01 * i, 0, 0)) for i in (-1, 0, 1)]
    one = relief_mesh(frame, d, everywhere(d), cut=3.0, tolerance=0.1)
    same = relief_mesh(frame, d, everywhere(d), cut=3.0, tolerance=0.1, cameras=near)
    np.testing.assert_array_equal(one.faces, same.faces)
    np.testing.assert_array_equal(one.uv, same.uv)


def test_the_backdrop_keeps_to_its_share_of_the_triangles():
    frame = ReferenceView.with_margin(camera(64, 48), 12, OFFSET, SCALE)
    d = leaves(frame)
    cameras = [camera(64, 48, (0.05 * i, 0.05 * j, 0)) for i in range(-2, 3) for j in range(-2, 3)]
    for triangles in (400, 2000):
        mesh = relief_mesh(frame, d, everywhere(d), cut=3.0, tolerance=0.1, triangles=triangles, cameras=cameras)
        assert len(mesh.faces) <= triangles and open_pixels(mesh, cameras) == 0
