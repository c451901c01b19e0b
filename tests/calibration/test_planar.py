"""Planar arrays: spacing, direction, disparities and jitter found again in drawn photographs."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from eigenfield.calibration import refine_planar, register_views, start_given, start_planar
from eigenfield.calibration.planar.array import ARRAY_PARAMETERS, ArrayModel
from eigenfield.calibration.planar.joint import _JointRefinement
from eigenfield.calibration.planar.kernels import normal_equations
from eigenfield.calibration.planar.start import nominal_positions, resized_start
from eigenfield.capture import GridLayout
from eigenfield.core.errors import CaptureError
from eigenfield.stereo.views import pack_pictures
from support.planes import everywhere, paint, photograph

SIDE = 144
SIZE = 4
CENTRE = SIZE // 2 * (SIZE + 1)


def inner(x, y):
    return (abs(x - SIDE / 2 - 14) < 34) & (abs(y - SIDE / 2 + 8) < 26)


LAYERS = [(2.6, 0.004, 0.0, paint(2, detail=2.0), inner), (-1.4, 0.0, 0.006, paint(3, detail=2.0), everywhere)]


def layout(**more):
    row, column = (index.ravel() for index in np.mgrid[:SIZE, :SIZE])
    return GridLayout(row, column, np.stack([column, row], axis=1).astype(float), **more)


def array(right=1.0, down=0.85, jitter=0.0, seed=0):
    """Photographs of two slanted planes, and the true positions in steps (x right, y down)."""
    row, column = (index.ravel() - SIZE // 2 for index in np.mgrid[:SIZE, :SIZE])
    rng = np.random.default_rng(seed)
    places = np.stack([right * column, down * row], axis=1) + jitter * rng.standard_normal((SIZE**2, 2))
    places -= places[CENTRE]
    matrices = np.zeros((SIZE**2, 3, 4))
    matrices[:, 0, 0] = matrices[:, 1, 1] = matrices[:, 2, 3] = 1
    matrices[:, :2, 2] = -places
    return photograph(LAYERS, matrices, SIDE), places


@pytest.fixture(scope="module")
def names():
    return [f"{i:02d}.png" for i in range(SIZE**2)]


@pytest.fixture(scope="module")
def even():
    """Photographs from an even grid, and where they were taken."""
    return array()


@pytest.fixture(scope="module")
def jittering(names):
    pictures, places = array(jitter=0.08)
    return pictures, places, refine_planar(pictures, start_planar(pictures, layout(), names))


def same_array(found, true):
    """Root mean square distance from the camera at the origin of `found`, after the scale that is free (disparities
    take it up)."""
    true = true - true[np.argmin(np.linalg.norm(found, axis=1))]
    scale = (found * true).sum() / (found * found).sum()
    return np.sqrt(((scale * found - true) ** 2).sum(axis=1).mean()), scale


def test_spacing_and_range_are_estimated(even, names):
    pictures, _ = even
    start = start_planar(pictures, layout(signs=False), names)
    step = start.parameters[SIZE + 1, :2] - start.parameters[0, :2]
    assert abs(step[1] / step[0]) == pytest.approx(0.85, rel=0.03)
    assert start.low < -1.0
    assert start.high > 2.6


def assert_near_before_far(planar, scale):
    margin = planar.reference.margin
    d = planar.d[margin:-margin, margin:-margin] / scale
    assert np.median(d[SIDE // 2 - 20 : SIDE // 2, SIDE // 2 : SIDE // 2 + 30]) == pytest.approx(2.93, abs=0.15)
    assert np.median(d[-30:-5, 5:30]) == pytest.approx(-0.65, abs=0.15)


@pytest.mark.parametrize(("right", "down"), [(-1.0, -0.9), pytest.param(-1.0, 1.1, marks=pytest.mark.slow)])
def test_near_and_far_are_told_by_occlusion(right, down, names):
    pictures, places = array(right, down)
    planar = refine_planar(pictures, start_planar(pictures, layout(), names))
    found = planar.parameters[:, :2]
    distance, scale = same_array(found, places)
    assert scale > 0
    assert distance < 0.03
    assert_near_before_far(planar, scale)


@pytest.mark.slow
def test_jitter_is_found(jittering):
    _, places, planar = jittering
    assert planar.refined
    distance, scale = same_array(planar.parameters[:, :2], places)
    assert scale > 0
    assert distance < 0.05  # of 0.11 that the cameras are off the grid
    assert_near_before_far(planar, scale)


def test_a_regular_grid_is_left_as_it_is(names):
    pictures, _ = array(down=1.0)
    planar = refine_planar(pictures, start_planar(pictures, layout(signs=False, exact=True), names), exact=True)
    assert not planar.refined
    moved = planar.parameters[:, 2:]
    assert np.abs(moved).max() == 0


@pytest.mark.slow
def test_a_view_that_took_no_part_is_registered(jittering, names):
    pictures, places, _ = jittering
    new = np.array([2, 7, 13])
    known = np.setdiff1d(np.arange(SIZE**2), new)
    part = layout().subset(known)
    planar = refine_planar(pictures[known], start_planar(pictures[known], part, [names[i] for i in known]))
    whole = register_views(planar, known, pictures[new], new, layout().positions)
    assert np.array_equal(whole.parameters[known], planar.parameters)
    truth = places - places[known[np.argmin(np.linalg.norm(planar.parameters[:, :2], axis=1))]]
    _, scale = same_array(whole.parameters[known, :2], truth[known])
    assert np.linalg.norm(scale * whole.parameters[new, :2] - truth[new], axis=1).max() < 0.06


def test_labels_of_a_sweep_are_limited(even, names, monkeypatch, caplog):
    pictures, _ = even
    joint = _JointRefinement(pack_pictures(pictures), start_planar(pictures, layout(), names))
    monkeypatch.setattr("eigenfield.calibration.planar.joint.PLANAR_SWEEP_MAX_LABELS", 33)
    with caplog.at_level("INFO", "eigenfield.calibration"):
        joint.sweep_depth(np.arange(SIZE**2))
    assert "16 views, 33 labels" in caplog.text


def test_given_cameras_start_where_they_are(jittering):
    _, _, planar = jittering
    views = np.arange(SIZE**2)
    cameras = planar.model.cameras(views, planar.parameters)
    start = start_given(cameras, 0.5, 1.5)
    again = start.model.cameras(views, start.parameters)
    assert len(again) == SIZE**2
    for before, after in zip(cameras, again, strict=True):
        np.testing.assert_allclose(after.matrix, before.matrix, atol=1e-9)


def test_an_array_is_the_same_for_photographs_at_another_size(even, names):
    start = start_planar(even[0], layout(), names)
    small = resized_start(start, (SIDE // 2, SIDE // 4))
    x, y, d = np.array([10.0, 70, 140]), np.array([20.0, 70, 130]), np.linspace(start.low, start.high, 3)
    points = start.model.reference_view(0).points(x, y, d)
    assert (small.low, small.high) == pytest.approx((start.low / 8**0.5, start.high / 8**0.5))
    again = small.model.reference_view(0).points((x + 0.5) / 2 - 0.5, (y + 0.5) / 4 - 0.5, d / 8**0.5)
    assert_allclose(again, points, rtol=1e-9)
    whole, reduced = (one.model.cameras(np.arange(3), one.parameters[:3]) for one in (start, small))
    for camera, other in zip(whole, reduced, strict=True):
        assert (other.width, other.height) == (SIDE // 2, SIDE // 4)
        assert_allclose(other.project(points)[0], camera.project(points)[0] / [2, 4], rtol=1e-9)


def test_derivatives_are_those_of_the_projection():
    model = ArrayModel.planar(1, 200, 100, 180.0, 1.0, 0.1)
    reference = model.reference_view(8)
    rng = np.random.default_rng(1)
    parameters = rng.uniform(-1, 1, (1, ARRAY_PARAMETERS)) * [2, 2, 3, 3, 0.01, 0.01, 0.01, 0.01, 0.02, 0.01]
    derivatives = model.derivatives(reference, np.array([0]), parameters, ARRAY_PARAMETERS)[0]
    for index in range(ARRAY_PARAMETERS):
        moved = parameters.copy()
        moved[0, index] += 1e-6
        change = model.matrices(reference, np.array([0]), moved) - model.matrices(reference, np.array([0]), parameters)
        np.testing.assert_allclose(change[0] / 1e-6, derivatives[index], rtol=1e-3, atol=1e-3)


def test_the_anchor_moves_with_the_shift_alone():
    model = ArrayModel.planar(1, 200, 100, 180.0, 1.0, 0.1)
    parameters = np.array([1.5, -2, 3, -4, 0.02, 0.01, 0.01, -0.02, 0.1, 0.01])
    pixel, _ = model.camera(0, parameters).project(model.anchor[None])
    np.testing.assert_allclose(pixel[0], [100 + 3, 50 - 4], atol=1e-9)


def test_measured_positions_keep_their_jitter():
    measured = GridLayout(
        np.array([0, 0, 1, 1]), np.array([0, 1, 0, 1]),
        np.array([[0, 0], [10.0, 0.5], [0.2, 8.0], [10.1, 8.2]]), measured=True,
    )  # fmt: skip
    places = nominal_positions(measured)
    assert places[1, 0] - places[0, 0] == pytest.approx(10.0 / 9.95, rel=0.01)
    assert places[2, 1] < 0  # up in the layout, down here


def test_bare_photographs_are_refused(names):
    grey = np.full((SIZE**2, SIDE, SIDE, 3), 128, np.uint8)
    with pytest.raises(CaptureError, match="points of") as error:
        start_planar(grey, layout(), names)
    assert error.value.code == "grid-texture"


def test_photographs_of_other_things_are_refused(names):
    pictures = np.stack([paint(seed)[:SIDE, :SIDE].astype(np.uint8) for seed in range(SIZE**2)])
    with pytest.raises(CaptureError) as error:
        start_planar(pictures, layout(), names)
    assert error.value.code in ("grid-texture", "grid-motion")


def test_exchanged_rows_and_columns_are_noticed(even, names, caplog):
    pictures, places = even
    start = start_planar(pictures, layout().transpose(), names)
    assert start.exchanged and "column first" in caplog.text
    found = start.parameters[:, :2]
    assert min(same_array(found, places)[0], same_array(-found, places)[0]) < 0.02
    with pytest.raises(CaptureError) as error:  # measured positions are not reinterpreted
        start_planar(pictures, layout(measured=True).transpose(), names)
    assert error.value.code in ("grid-swapped", "grid-motion")


def test_a_shuffled_order_does_not_move_as_a_grid(even, names):
    pictures, _ = even
    order = np.random.default_rng(4).permutation(SIZE**2)
    with pytest.raises(CaptureError) as error:
        start_planar(pictures[order], layout(), names)
    assert error.value.code == "grid-motion"


def test_the_sums_of_a_camera_are_those_of_its_derivatives():
    random = np.random.default_rng(1)
    y, x = np.mgrid[:40, :50]
    waves = [np.sin(0.3 * x + c) + np.cos(0.2 * y - c) for c in range(4)]
    picture = np.clip(128 + 40 * np.stack(waves, axis=-1), 0, 255).astype(np.uint8)
    picture[..., 3] = 0
    points = random.uniform((5, 5, -1), (40, 30, 1), (200, 3)).astype(np.float32)
    colours = random.uniform(60, 200, (200, 3)).astype(np.float32)
    matrix = np.array([[1, 0.02, 1.5, 1], [0.01, 1, -1, 2], [1e-4, 1e-4, 1e-2, 1]])
    derivatives = random.normal(size=(5, 3, 4))
    left, right = np.zeros((3, 3, 16)), np.zeros((3, 4))
    total, seen = normal_equations(
        picture, points, colours, matrix, np.full((40, 50), -9, np.float32), 0.5, 15.0, left, right
    )

    def sample(at):
        column, row = at.astype(int).T
        fx, fy = (at - at.astype(int)).T[:, :, None]
        corner = [[picture[row + i, column + j, :3] for j in (0, 1)] for i in (0, 1)]
        return (1 - fy) * ((1 - fx) * corner[0][0] + fx * corner[0][1]) + fy * (
            (1 - fx) * corner[1][0] + fx * corner[1][1]
        )

    homogeneous = np.c_[points, np.ones(200)].astype(np.float64)
    p = homogeneous @ matrix.T
    moved = np.einsum("kij,nj->nki", derivatives, homogeneous)
    at = p[:, :2] / p[:, 2:]
    slopes = (moved[..., :2] - at[:, None] * moved[..., 2:]) / p[:, None, 2:]
    gradient = [sample(at + step) - sample(at - step) for step in (np.array([0.5, 0]), np.array([0, 0.5]))]
    rows = np.einsum("anc,nka->nck", np.array(gradient), slopes)
    error = colours - sample(at)
    weights = 1 / (1 + (error / 15) ** 2)
    assert seen == 200
    assert total == pytest.approx((error**2).sum(), rel=1e-4)
    hessian = np.einsum("pik,ijkl,qjl->pq", derivatives, left.reshape(3, 3, 4, 4), derivatives)
    assert_allclose(hessian, np.einsum("nc,nck,ncl->kl", weights, rows, rows), rtol=1e-3)
    assert_allclose(
        np.einsum("pik,ik->p", derivatives, right), np.einsum("nc,nc,nck->k", weights, error, rows), rtol=1e-3
    )

    picture[:, :12, 3] = picture[:, 42:, 3] = picture[:9, :, 3] = picture[33:, :, 3] = (
        255  # outside a smaller photograph
    )
    _, seen = normal_equations(
        picture, points, colours, matrix, np.full((40, 50), -9, np.float32), 0.5, 15.0, left, right
    )
    assert 0 < seen == ((at >= (14, 11)) & (at < (39, 30))).all(axis=1).sum() < 200
