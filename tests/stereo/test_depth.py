"""Depth from photographs: known answers on scenes drawn by a ray-caster of their own."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.core.camera import Camera
from eigenfield.runtime.parallel import set_threads
from eigenfield.stereo import (
    ReferenceView,
    depth_buffers,
    depth_range,
    estimate_depth,
    mean_texture,
    view_matrices,
)
from eigenfield.stereo.detail import detail_pictures
from eigenfield.stereo.estimate import depth_scale
from eigenfield.stereo.refine import refine_depth
from eigenfield.stereo.semiglobal import semi_global_matching
from eigenfield.stereo.smooth import smooth_depth
from eigenfield.stereo.sweep import plane_sweep
from eigenfield.stereo.views import (
    halve_pictures,
    halved_matrices,
    inside_pictures,
    mark_outside,
    pack_pictures,
    unpack_pictures,
)
from support.planes import cropped, everywhere, lying_and_upright, paint, photograph

SIDE = 96
GRID = 5


def grid_matrices(side: int = GRID) -> np.ndarray:
    """Views of a rectified array: x_view = x - d column."""
    places = [(c - side // 2, r - side // 2) for r in range(side) for c in range(side)]
    matrices = np.zeros((side * side, 3, 4))
    matrices[:, 0, 0] = matrices[:, 1, 1] = matrices[:, 2, 3] = 1
    matrices[:, :2, 2] = -np.array(places)
    return matrices


def middle(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return (abs(x - SIDE / 2) < 20) & (abs(y - SIDE / 2) < 20)


@pytest.fixture(scope="module")
def slanted():
    layer = (0.3, 0.008, -0.006, paint(1), everywhere)
    y, x = np.mgrid[0:SIDE, 0:SIDE]
    return photograph([layer], grid_matrices(), SIDE), 0.3 + 0.008 * x - 0.006 * y


@pytest.fixture(scope="module")
def two_layers():
    layers = [(1.55, 0, 0, paint(2), middle), (-1.05, 0, 0, paint(3), everywhere)]
    y, x = np.mgrid[0:SIDE, 0:SIDE]
    return photograph(layers, grid_matrices(), SIDE), np.where(middle(x, y), 1.55, -1.05)


@given(st.floats(-1.5, 1.5))
@settings(max_examples=5)
def test_the_sweep_is_least_at_the_plane(label):
    matrices = grid_matrices(3)
    pictures = photograph([(label, 0, 0, paint(4), everywhere)], matrices, 48)
    labels = np.linspace(-2, 2, 41).astype(np.float32)
    cost = plane_sweep(pictures, matrices, (48, 48), labels, reference=pictures[4])
    found = labels[cost[4:-4, 4:-4].argmin(axis=-1)]
    assert abs(np.median(found) - label) < 0.13  # labels are 0.1 apart: half of it, and what interpolation moves it
    assert (abs(found - label) < 0.25).mean() > 0.9


def test_without_a_reference_the_views_own_centre_does(slanted):
    pictures, truth = slanted
    matrices = grid_matrices()
    others = np.arange(len(matrices)) != len(matrices) // 2
    labels = np.linspace(-1, 2, 31).astype(np.float32)
    cost = plane_sweep(pictures[others], matrices[others], (SIDE, SIDE), labels)
    found = labels[cost[8:-8, 8:-8].argmin(axis=-1)]
    assert (abs(found - truth[8:-8, 8:-8]) < 0.15).mean() > 0.8


def test_labels_outside_floor_and_ceiling_and_pixels_not_asked_for_are_never_taken(slanted):
    pictures, _ = slanted
    labels = np.linspace(-1, 2, 31).astype(np.float32)
    todo = np.zeros((SIDE, SIDE), bool)
    todo[10:20, 30:50] = True
    floor, ceiling = np.full((SIDE, SIDE), -0.5, np.float32), np.full((SIDE, SIDE), 0.5, np.float32)
    cost = plane_sweep(
        pictures, grid_matrices(), (SIDE, SIDE), labels, reference=pictures[12], mask=todo, floor=floor, ceiling=ceiling
    )
    assert (cost[~todo] == 255).all()
    allowed = (labels >= -0.5) & (labels <= 0.5)
    assert (cost[todo][:, ~allowed] == 255).all() and (cost[todo][:, allowed] < 255).all()
    d, confidence = semi_global_matching(cost, pictures[12].mean(axis=-1).astype(np.float32), labels)
    assert d[todo].min() > -0.55 and d[todo].max() < 0.55
    assert (confidence[~todo] == 0).all()


def test_the_best_half_of_the_views_decides_beside_an_occluder(two_layers):
    pictures, truth = two_layers
    labels = np.linspace(-2, 2.5, 46).astype(np.float32)
    far, ring = np.abs(labels + 1.05).argmin(), np.zeros((SIDE, SIDE), bool)
    ring[26:70, 26:70] = True
    ring &= truth < 0
    ring[:, :] &= np.roll(truth > 0, 2, 1) | np.roll(truth > 0, -2, 1)
    half = plane_sweep(pictures, grid_matrices(), (SIDE, SIDE), labels, reference=pictures[12], half_plane_fraction=0.4)
    whole = plane_sweep(
        pictures, grid_matrices(), (SIDE, SIDE), labels, reference=pictures[12], half_plane_fraction=1.0
    )
    assert half[ring][:, far].mean() < 0.5 * whole[ring][:, far].mean()


def test_semi_global_jumps_at_an_edge_of_the_guide_and_fills_what_says_nothing():
    labels = np.arange(10, dtype=np.float32)
    cost = np.full((20, 20, 10), 80, np.uint8)
    cost[:, :10, 2] = 0
    cost[:, 10:, 7] = 0
    cost[5:9, 3:7] = 40  # flat paint
    guide = np.zeros((20, 20), np.float32)
    guide[:, 10:] = 100
    d, confidence = semi_global_matching(cost, guide, labels)
    assert np.allclose(d[:, :10], 2, atol=0.3) and np.allclose(d[:, 10:], 7, atol=0.3)
    assert (confidence > 0).all()


def test_semi_global_is_the_same_when_memory_is_short(monkeypatch):
    cost = np.random.default_rng(0).integers(0, 255, (30, 40, 12), dtype=np.uint8)
    guide = np.random.default_rng(1).uniform(0, 255, (30, 40)).astype(np.float32)
    labels = np.arange(12, dtype=np.float32)
    apart = semi_global_matching(cost, guide, labels)
    monkeypatch.setattr("eigenfield.stereo.semiglobal.SGM_MAX_PARALLEL_BYTES", 0)
    together = semi_global_matching(cost, guide, labels)
    assert np.array_equal(apart[0], together[0]) and np.array_equal(apart[1], together[1])


def test_depth_buffers_keep_the_nearest():
    matrices = grid_matrices(3)
    d = np.zeros((32, 32), np.float32)
    d[10:20, 10:20] = 4
    buffers = depth_buffers(matrices, d, (32, 32))
    left = buffers[3]  # column -1: points move right by d
    assert (left[11:19, 15:23] == 4).all() and (left[:, 25:] == 0).all()
    assert (buffers[:, :9, :9].max(axis=(1, 2)) <= 4).all()
    hidden = depth_buffers(matrices, d, (32, 32), valid=np.zeros((32, 32), bool))
    assert (hidden < -1e8).all()
    with pytest.raises(ValueError, match="shape"):
        depth_buffers(matrices, d, (32, 32), out=np.zeros((9, 8, 8), np.float32))


def test_the_mean_texture_is_the_paint_where_it_is_seen(two_layers):
    pictures, truth = two_layers
    matrices = grid_matrices()
    d = truth.astype(np.float32)
    buffers = depth_buffers(matrices, d, (SIDE, SIDE))
    texture, count = mean_texture(pictures, matrices, d, buffers)
    inner = np.zeros((SIDE, SIDE), bool)
    inner[10:-10, 10:-10] = True
    error = np.abs(texture - pictures[12].astype(np.float32)).mean(axis=-1)
    assert np.median(error[inner]) < 4
    assert count[48, 48] == 25 and count[48, 27] < 25  # beside the occluder some views are blocked
    assert count.max() == 25
    beyond, nobody = mean_texture(pictures, matrices, np.full((SIDE, SIDE), 500, np.float32))
    assert nobody[0, 0] == 1 and nobody.sum() == SIDE * SIDE  # the centre view alone
    assert np.allclose(beyond, pictures[12], atol=0.6)


def test_refinement_finds_the_slanted_plane_and_is_sure_of_it(slanted):
    pictures, truth = slanted
    matrices = grid_matrices()
    rng = np.random.default_rng(0)
    d = (truth + rng.uniform(-0.12, 0.12, truth.shape)).astype(np.float32)
    for step in (0.08, 0.04):
        buffers = depth_buffers(matrices, d, (SIDE, SIDE))
        texture, _ = mean_texture(pictures, matrices, d, buffers, bias=0.3)
        d, confidence = refine_depth(pictures, matrices, d, step, buffers=buffers, texture=texture, bias=0.3)
        d = smooth_depth(d, confidence, texture)
    error = np.abs(d - truth)[8:-8, 8:-8]
    assert np.median(error) < 0.01 and np.percentile(error, 95) < 0.05
    assert np.median(confidence[8:-8, 8:-8]) > 300


def test_a_candidate_behind_its_own_surface_is_not_hidden_by_it(slanted):
    """All labels of a point are judged by the same views, though the depth buffer holds the point itself."""
    pictures, truth = slanted
    matrices = grid_matrices()
    d = (truth + 0.3).astype(np.float32)  # too near: the right label lies behind the present surface
    buffers = depth_buffers(matrices, d, (SIDE, SIDE))
    texture, _ = mean_texture(pictures, matrices, d, buffers)
    better, confidence = refine_depth(pictures, matrices, d, 0.15, buffers=buffers, texture=texture)
    inner = (slice(10, -10), slice(10, -10))
    assert (confidence[inner] > 0).mean() > 0.95
    assert np.median(np.abs(better - truth)[inner]) < 0.05


def test_flat_paint_has_no_confidence_even_with_blocks_fixed_to_the_raster():
    matrices = grid_matrices()
    flat = np.full((25, SIDE, SIDE, 3), 120, np.uint8)
    y, x = np.mgrid[0:SIDE, 0:SIDE]
    blocks = flat + (((x // 8 + y // 8) % 2) * 3).astype(np.uint8)[None, ..., None]
    blocks += np.random.default_rng(0).integers(0, 3, blocks.shape[:3], dtype=np.uint8)[..., None]
    d = np.full((SIDE, SIDE), 1.3, np.float32)
    for pictures in (flat, blocks):
        texture, _ = mean_texture(pictures, matrices, d)
        refined, confidence = refine_depth(pictures, matrices, d, 0.08, buffers=None, texture=texture)
        assert np.percentile(confidence, 99) < 20
        assert (refined == d).mean() > 0.98


def test_smoothing_keeps_a_plane_and_an_outline_and_mends_unsure_points():
    y, x = np.mgrid[0:64, 0:64].astype(np.float32)
    plane = 0.05 * x - 0.03 * y
    guide = np.zeros((64, 64, 3), np.float32)
    guide[:, 32:] = 200
    d = (plane + np.where(x >= 32, 3, 0)).astype(np.float32)
    confidence = np.full((64, 64), 1000, np.float32)
    kept = smooth_depth(d, confidence, guide)
    assert np.abs(kept - d).max() < 0.02
    broken, unsure = d.copy(), confidence.copy()
    broken[20:26, 12:18] += 0.3
    unsure[20:26, 12:18] = 0
    assert np.abs(smooth_depth(broken, unsure, guide) - d).max() < 0.08


def test_estimate_finds_two_layers_with_a_sharp_outline(two_layers):
    pictures, truth = two_layers
    depth = estimate_depth(pictures, grid_matrices(), (SIDE, SIDE), (-2.0, 2.5), rounds=2)
    error = np.abs(depth - truth)[6:-6, 6:-6]
    assert (error > 0.1).mean() < 0.03
    assert np.median(error) < 0.02
    assert (error > 1).mean() < 0.015  # the outline: 160 pixels long, under one pixel off


def test_estimate_with_turned_cameras_and_a_widened_reference_view():
    cameras = turned_cameras()
    reference = ReferenceView.with_margin(cameras[4], 8, offset=0.25, scale=0.02)
    matrices = view_matrices(reference, cameras)
    layer = (0.5, 0.006, 0.004, paint(5), everywhere)
    pictures = photograph([layer], matrices, 80)
    depth = estimate_depth(pictures, matrices, reference.shape, (-2.0, 3.0), rounds=2)
    y, x = np.mgrid[0:96, 0:96]
    truth = 0.5 + 0.006 * x + 0.004 * y
    error = np.abs(depth - truth)
    assert (error[8:-8, 8:-8] > 0.1).mean() < 0.03
    assert np.median(error) < 0.03 and np.isfinite(depth).all()


def test_what_photographs_do_not_reach_is_not_taken_for_seen(two_layers):
    pictures, truth = two_layers
    places = lying_and_upright(GRID**2, SIDE, 72)
    smeared = cropped(pictures, places)
    marked = mark_outside(smeared, places)
    for few in (0, 2):  # rows by which photographs of one camera may differ
        assert mark_outside(smeared, [(slice(few, SIDE), slice(0, SIDE - few))] * GRID**2) is smeared

    def wrong(given):
        depth = estimate_depth(given, grid_matrices(), (SIDE, SIDE), (-2.0, 2.5), rounds=2)
        seen = np.s_[14:-14, 6:-6]  # where the reference camera's own photograph is
        return (np.abs(depth - truth)[seen] > 0.1).mean()

    assert wrong(marked) < 0.03 < 0.1 < wrong(smeared)
    _, count = mean_texture(marked, grid_matrices(), np.zeros((SIDE, SIDE), np.float32))
    assert count[5, 5] == 0 and count[5, 48] == 12 and count[48, 5] == 13 and count[48, 48] == 25
    assert np.array_equal(inside_pictures(halve_pictures(marked)), inside_pictures(marked)[:, ::2, ::2])
    assert np.array_equal(inside_pictures(detail_pictures(marked)), inside_pictures(marked))


@pytest.mark.parametrize(
    ("high", "size", "scale"), [(9.0, 1 / 8, 1 / 2), (200.0, 1 / 4, 1 / 2), (9.0, 1.1, 1.0), (0.01, 1.1, 1 / 4)]
)
def test_a_sweep_stays_within_its_bytes(high, size, scale, monkeypatch):
    """Labels move by half a pixel in the fastest view, by sqrt(2) a label: below 256 they fall with the size, too."""
    labels = min(256, 2 * 2**0.5 * high)
    monkeypatch.setattr("eigenfield.stereo.estimate.DEPTH_MAX_BYTES", 3 * SIDE**2 * labels * size)
    monkeypatch.setattr("eigenfield.stereo.estimate.DEPTH_MAX_PIXELS", SIDE**2 if high > 1 else SIDE**2 / 16)
    assert depth_scale(grid_matrices(3), (SIDE, SIDE), 0.0, high) == pytest.approx(min(scale, 1.0), rel=1e-3)


def turned_cameras() -> list[Camera]:
    """Nine cameras of 80 x 80 that look at one point, from a bent row of places."""
    K = np.array([[90, 0, 40], [0, 90, 40], [0, 0, 1.0]])
    cameras = []
    for index in range(9):
        centre = np.array([(index % 3 - 1) * 0.5, (index // 3 - 1) * 0.5, 0.05 * index])
        forward = np.array([0, 0, 4.0]) - centre
        forward /= np.linalg.norm(forward)
        right = np.cross([0, 1.0, 0], forward)
        right /= np.linalg.norm(right)
        R = np.stack([right, np.cross(forward, right), forward])
        cameras.append(Camera(K, R, -R @ centre, 80, 80))
    return cameras


def test_the_range_is_found_and_its_absence_is_said(two_layers):
    matrices = grid_matrices()
    layers = [(1.5, 0, 0, paint(2, detail=6), middle), (-1.0, 0, 0, paint(3, detail=6), everywhere)]
    pictures = photograph(layers, matrices, SIDE)
    found = depth_range(pictures, matrices, (SIDE, SIDE), (-6, 6))
    assert found is not None
    assert -2.2 < found[0] < -0.95 and 1.4 < found[1] < 2.7
    flat = np.full_like(pictures, 90)
    assert depth_range(flat, matrices, (SIDE, SIDE), (-6, 6)) is None
    noise = np.random.default_rng(0).integers(0, 255, pictures.shape, dtype=np.uint8)
    assert depth_range(noise, matrices, (SIDE, SIDE), (-6, 6)) is None


def test_the_number_of_threads_changes_nothing(two_layers):
    pictures, _ = two_layers
    results = []
    for threads in (1, 2, 3):
        set_threads(threads)
        results.append(estimate_depth(pictures, grid_matrices(), (SIDE, SIDE), (-2.0, 2.5), rounds=1))
    set_threads(None)
    for other in results[1:]:
        assert np.array_equal(results[0], other)


def test_damaged_input_is_refused_and_points_behind_a_camera_are_not_seen(slanted):
    pictures, _ = slanted
    matrices = grid_matrices()
    broken = matrices.copy()
    broken[3, 0, 0] = np.nan
    with pytest.raises(ValueError, match="finite"):
        plane_sweep(pictures, broken, (SIDE, SIDE), np.array([0, 1, 2], np.float32))
    with pytest.raises(ValueError, match="uint8"):
        pack_pictures(pictures.astype(np.float32))
    with pytest.raises(ValueError, match="empty range"):
        estimate_depth(pictures, matrices, (SIDE, SIDE), (1.0, 1.0))
    with pytest.raises(ValueError, match="empty range"):
        estimate_depth(pictures, matrices, (SIDE, SIDE), (float("nan"), 1.0))
    behind = matrices.copy()
    behind[:, 2, 3] = -1
    _, count = mean_texture(pictures, behind, np.zeros((SIDE, SIDE), np.float32))
    assert (count == 0).all()
    _, count = mean_texture(pictures, matrices, np.full((SIDE, SIDE), np.nan, np.float32))
    assert (count == 0).all()


def test_halved_pictures_and_matrices_belong_together():
    matrices = grid_matrices(3)
    pictures = photograph([(1.0, 0, 0, paint(6, detail=6), everywhere)], matrices, 65)
    small = halve_pictures(pictures)
    assert small.shape == (9, 33, 33)
    texture, count = mean_texture(small, halved_matrices(matrices), np.ones((33, 33), np.float32))
    reference, _ = mean_texture(small[4:5], halved_matrices(matrices)[4:5], np.ones((33, 33), np.float32))
    inner = (slice(3, -3), slice(3, -3))
    assert (count[inner] == 9).all()
    assert np.abs(texture - reference)[inner].mean() < 1.5


def test_detail_is_blind_to_shading():
    texture = paint(7)[:SIDE, :SIDE]
    x = np.mgrid[0:SIDE, 0:SIDE][1]
    plain = np.clip(128 + 0.15 * (texture - 128), 0, 255)
    shaded = plain + (0.3 * x)[..., None]
    as_bytes = lambda values: np.rint(np.clip(values, 0, 255)).astype(np.uint8)[None]  # noqa: E731
    before = np.abs(shaded - plain).mean()
    first, second = (unpack_pictures(detail_pictures(as_bytes(p), base_gain=0))[0] for p in (plain, shaded))
    assert np.abs(first.astype(int) - second)[6:-6, 6:-6].mean() < 0.3 * before
    assert first.std() > 3
