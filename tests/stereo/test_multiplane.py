"""Multiplane images: kernels against definitions, transposes and differences; a known scene found again."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from eigenfield.core.camera import Camera
from eigenfield.runtime.parallel import set_threads
from eigenfield.stereo import ReferenceView, view_matrices
from eigenfield.stereo.multiplane import (
    MULTIPLANE_TUNING,
    MultiplaneImage,
    MultiplaneTuning,
    SheetTuning,
    SoftSheets,
    fit_multiplane,
    fit_sheets,
)
from eigenfield.stereo.multiplane.drawing import backpropagate, draw_layers, view_rays
from eigenfield.stereo.multiplane.fit import plane_homographies
from eigenfield.stereo.multiplane.kernels import (
    add_label_gradient,
    add_layer_gradient,
    add_priors,
    draw_layer,
    pixel_rays,
    plane_places,
    prolong,
    restrict,
)
from eigenfield.stereo.multiplane.pyramid import Pyramid, interpolation
from eigenfield.stereo.multiplane.sheets import sheets_of

SHAPE = (20, 26)  # of a photograph
FRAME = (28, 34)  # of the reference view, with a margin of 4
LABELS = np.array([0.5, 1.0, 2.0])
QUICK = MultiplaneTuning(steps=200, levels=4, opacity_price=0.0006)  # few planes: what is hidden costs more


def cameras(count=9, pitch=0.12, seed=0):
    """Cameras on a plane, each turned a little its own way."""
    random, K = np.random.default_rng(seed), np.array([[24.0, 0, 13.2], [0, 24.5, 9.7], [0, 0, 1]])
    made = []
    for index in range(count):
        centre = pitch * np.array([index % 3 - 1, index // 3 - 1, 0.0])
        angle = 0.01 * random.standard_normal(3)
        turn = np.eye(3) + np.array([[0, -angle[2], angle[1]], [angle[2], 0, -angle[0]], [-angle[1], angle[0], 0]])
        R = np.linalg.qr(turn)[0]
        R *= np.sign(np.diag(R))  # nearly the identity
        made.append(Camera(K, R, -R @ centre, SHAPE[1], SHAPE[0]))
    return made


def reference():
    camera = Camera(cameras()[4].K, np.eye(3), np.zeros(3), SHAPE[1], SHAPE[0])
    return ReferenceView.with_margin(camera, 4, 0.0, 1.0)


def matrices():
    return view_matrices(reference(), cameras())


def random_layers(seed=0):
    return np.random.default_rng(seed).random((len(LABELS), *FRAME, 4), np.float32)


def test_a_homography_takes_a_view_to_the_plane_that_it_sees():
    view = reference()
    for camera, matrix in zip(cameras(), matrices(), strict=True):
        for label, homography in zip(LABELS, plane_homographies(matrix, LABELS), strict=True):
            points = view.points(np.array([3.0, 20.0]), np.array([5.0, 11.0]), np.full(2, label))
            seen, _ = camera.project(points)
            there = np.column_stack([seen - 0.5, np.ones(2)]) @ homography.T
            assert_allclose(there[:, :2] / there[:, 2:], [[3, 5], [20, 11]], atol=1e-6)


def places_by(base):
    """Where a photograph's pixels read a plane, by an affine map of their coordinates."""
    places = np.empty((*SHAPE, 2), np.float32)
    rays = np.empty((*places.shape[:2], 4), np.float32)
    pixel_rays(base, np.zeros((2, 3)), rays)
    plane_places(*FRAME, rays, np.float32(0), places)
    return places


def drawn_layers(labels, layers, matrix):
    places, drawn = np.empty((len(layers), *SHAPE, 2), np.float32), np.empty((len(layers), *SHAPE, 4), np.float32)
    draw_layers(labels, layers, view_rays(matrix, places.shape[1:3]), places, drawn)
    return places, drawn


def test_a_layer_is_read_bilinearly_and_is_nothing_beyond_its_border():
    layer, drawn = random_layers()[0], np.empty((*SHAPE, 4), np.float32)
    draw_layer(layer, places_by(np.array([[1.0, 0, 2.25], [0, 1, 3.5], [0, 0, 1]])), drawn)
    block = 0.75 * layer[:, :-1] + 0.25 * layer[:, 1:]
    block = 0.5 * (block[:-1] + block[1:])
    assert_allclose(drawn, block[3 : 3 + SHAPE[0], 2 : 2 + SHAPE[1]], rtol=1e-5, atol=1e-6)
    draw_layer(layer, places_by(np.array([[1.0, 0, -5], [0, 1, 0], [0, 0, 1]])), drawn)
    assert not drawn[:, :5].any() and drawn[:, 5:].any()
    draw_layer(layer, places_by(-np.eye(3)), drawn)  # the plane is behind the camera
    assert not drawn.any()


def test_the_gradient_of_a_layer_is_the_transpose_of_drawing_it():
    layers, picture = random_layers(1), np.random.default_rng(2).random((*SHAPE, 4), np.float32)
    places, drawn = drawn_layers(LABELS, layers, matrices()[2])
    back = np.zeros_like(layers[1])
    add_layer_gradient(picture, places[1], back)
    assert_allclose(np.vdot(drawn[1].astype(float), picture), np.vdot(layers[1].astype(float), back), rtol=1e-5)


def test_layers_are_composited_back_to_front():
    image = MultiplaneImage(LABELS, random_layers(3))
    matrix = matrices()[6]
    expected = np.zeros((*SHAPE, 3))
    for layer in drawn_layers(LABELS, image.layers, matrix)[1].astype(float):
        expected = layer[..., 3:] * layer[..., :3] + (1 - layer[..., 3:]) * expected
    assert_allclose(image.draw(matrix, SHAPE), expected, atol=1e-6)


def test_the_gradient_of_the_error_agrees_with_differences():
    layers, matrix = random_layers(4), matrices()[1]
    codes = np.random.default_rng(5).integers(0, 256, (*SHAPE, 3), np.uint8)

    def error(changed):
        picture = MultiplaneImage(LABELS, changed).draw(matrix, SHAPE).astype(float)
        return np.square(picture - codes / 255).sum()

    places, drawn = drawn_layers(LABELS, layers, matrix)
    gradient = np.zeros_like(layers)
    assert backpropagate(codes, places, drawn, list(gradient)) == pytest.approx(error(layers), rel=1e-5)
    for direction in np.random.default_rng(6).standard_normal((3, *layers.shape)).astype(np.float32):
        step = np.float32(1e-3) * direction
        difference = (error(layers + step) - error(layers - step)) / 2e-3
        assert difference == pytest.approx(float(np.vdot(gradient.astype(float), direction)), rel=2e-3, abs=1e-2)


def test_priors_are_the_gradient_of_variation_and_prices():
    layer, width = random_layers(7)[0].reshape(FRAME[0], -1), 0.05
    variation = np.tile(np.array([0.3, 0.3, 0.3, 0.7], np.float32), FRAME[1])
    price = np.tile(np.array([0, 0, 0, 0.2], np.float32), FRAME[1])
    doubt = np.tile(np.array([0, 0, 0, 0.4], np.float32), FRAME[1])

    def cost(x):
        total = float((price * x + doubt * x * (1 - x)).sum())
        for a, b, weight in ((x[1:], x[:-1], variation), (x[:, 4:], x[:, :-4], variation[4:])):
            d = np.abs(a - b)
            total += float((weight * np.where(d < width, d * d / (2 * width), d - width / 2)).sum())
        return total

    given = np.random.default_rng(8).random(layer.shape).astype(np.float32)
    gradient = given.copy()
    add_priors(layer, 4, np.float32(0.5), variation, price, doubt, np.float32(1 / width), gradient)
    direction = np.random.default_rng(9).standard_normal(layer.shape)
    exact = layer.astype(float)
    difference = (cost(exact + 1e-5 * direction) - cost(exact - 1e-5 * direction)) / 2e-5
    assert float(((gradient - 0.5 * given) * direction).sum()) == pytest.approx(difference, rel=1e-3)


@pytest.mark.parametrize("fine", [(9, 14), (2, 5), (3, 2)])
def test_restriction_is_the_transpose_of_prolongation(fine):
    coarse = max(2, fine[0] // 2), max(2, fine[1] // 2)
    taps = (*interpolation(fine[0], coarse[0]), *interpolation(fine[1], coarse[1]))
    random = np.random.default_rng(10)
    x, y = random.random((*coarse, 4), np.float32), random.random((*fine, 4), np.float32)
    up, down = np.zeros_like(y), np.full_like(x, np.nan)
    prolong(x, *taps, up)
    restrict(y, *taps, down)
    assert_allclose(np.vdot(up.astype(float), y), np.vdot(x.astype(float), down), rtol=1e-6)
    assert_allclose(prolonged_ones(coarse, fine, taps), 1, rtol=1e-6)


def prolonged_ones(coarse, fine, taps):
    up = np.zeros((*fine, 4), np.float32)
    prolong(np.ones((*coarse, 4), np.float32), *taps, up)
    return up


def test_a_step_of_the_pyramid_moves_what_the_photographs_do_not_see():
    """One texel asks for more: all grids answer, the coarser the farther."""
    pyramid = Pyramid((32, 32), 4, 4)
    pyramid.gradient[16, 16] = -1
    pyramid.step(1)
    assert pyramid.gradient[16, 16, 0] == pytest.approx(4, rel=1e-3)  # each grid moves there by its rate of 1
    assert pyramid.gradient[16, 22, 0] > 0 and pyramid.gradient[0, 0, 0] == 0
    alone = Pyramid((32, 32), 4, 1)
    alone.gradient[16, 16] = -1
    alone.step(1)
    assert np.count_nonzero(alone.gradient[..., 0]) == 1


def scene():
    """A checked wall and, before it, an opaque square of another colour."""
    layers = np.zeros((3, *FRAME, 4), np.float32)
    rows, columns = np.indices(FRAME)
    layers[0, ..., :3] = np.where((rows // 3 + columns // 3) % 2, 0.8, 0.3)[..., None] * np.array([1, 0.8, 0.6])
    layers[0, ..., 3] = 1
    layers[2, 9:19, 12:22] = [0.1, 0.4, 0.9, 1]
    layers[2, 12:14, 14:18, :3] = 0.9
    return MultiplaneImage(LABELS, layers)


def photographs():
    pictures = [scene().draw(matrix, SHAPE) for matrix in matrices()]
    return np.round(np.clip(np.stack(pictures), 0, 1) * 255).astype(np.uint8)


def psnr(picture, codes):
    return -10 * np.log10(np.square(picture - codes / 255).mean())


def test_a_known_scene_is_found_again():
    """Held-out views are drawn well, the square is on its plane, and what nobody asks for is empty."""
    pictures, views = photographs(), matrices()
    shown, held = [0, 1, 2, 3, 5, 6, 8], [4, 7]
    found = fit_multiplane(pictures[shown], views[shown], FRAME, LABELS, tuning=QUICK)
    assert found.layers.shape == (3, *FRAME, 4) and (found.layers[0, ..., 3] == 1).all()
    assert found.layers[..., 3].min() >= 0 and found.layers[..., 3].max() <= 1
    assert min(psnr(found.draw(views[view], SHAPE), pictures[view]) for view in held) > 24
    assert found.layers[2, 10:18, 13:21, 3].mean() > 0.7
    assert found.layers[1:, :, :8, 3].mean() < 0.1


def test_threads_do_not_change_it():
    planes, tuning = MultiplaneTuning(steps=6, levels=3), SheetTuning(steps=4, levels=2)
    made = []
    try:
        for count in (1, 3):
            set_threads(count)
            (found,) = fit_sheets(photographs(), matrices(), FRAME, LABELS, [2], planes=planes, tuning=tuning)
            made.append(found.layers.tobytes() + found.labels.tobytes())
    finally:
        set_threads(None)
    assert made[0] == made[1]


def test_progress_goes_from_nothing_to_all():
    told, planes, tuning = [], MultiplaneTuning(steps=3, levels=2), SheetTuning(steps=2, levels=2)
    given = photographs(), matrices(), FRAME, LABELS, [2]
    fit_sheets(*given, planes=planes, tuning=tuning, progress=lambda *said: told.append(said))
    assert told == [("planes", 1, 3), ("planes", 2, 3), ("planes", 3, 3), ("sheets", 1, 2), ("sheets", 2, 2)]


@pytest.mark.parametrize("labels", [[1.0], [1.0, 1.0], [2.0, 1.0], [[1.0, 2.0]]])
def test_labels_ascend(labels):
    with pytest.raises(ValueError, match="labels must be at least two, ascending"):
        fit_multiplane(photographs(), matrices(), FRAME, np.array(labels), tuning=MULTIPLANE_TUNING)


@pytest.mark.parametrize("count", [0, 4])
def test_there_are_no_more_sheets_than_planes(count):
    with pytest.raises(ValueError, match="sheets of 3 planes"):
        fit_sheets(photographs(), matrices(), FRAME, LABELS, [count])


def wavy_labels(seed=0):
    """(2, h, w): a slanted sheet and a wavy one before it."""
    rows, columns = np.indices(FRAME)
    far = 0.5 + 0.012 * columns + 0.006 * rows
    return np.stack([far, 1.6 + 0.1 * np.sin(columns / 4 + seed)]).astype(np.float32)


def test_a_pixel_reads_a_sheet_where_its_ray_meets_it():
    labels, view = wavy_labels(), reference()
    for camera, matrix in zip(cameras(), matrices(), strict=True):
        places, _ = drawn_layers(labels, random_layers()[:2], matrix)
        for sheet, there in zip(labels, places, strict=True):
            row, column = 8, 12
            u, v = there[row, column].astype(float)
            left, top = int(u), int(v)
            f, g = u - left, v - top
            line = (1 - f) * sheet[top : top + 2, left] + f * sheet[top : top + 2, left + 1]
            point = view.points(np.array(u), np.array(v), np.array((1 - g) * line[0] + g * line[1]))
            assert_allclose(camera.project(point[None])[0][0] - 0.5, [column, row], atol=2e-3)


def test_a_level_sheet_is_a_plane():
    layers = random_layers(3)
    level = SoftSheets(np.broadcast_to(LABELS[:, None, None], (3, *FRAME)).astype(np.float32), layers)
    for matrix in matrices()[:3]:
        assert_allclose(level.draw(matrix, SHAPE), MultiplaneImage(LABELS, layers).draw(matrix, SHAPE), atol=2e-5)


def test_the_gradient_of_sheets_agrees_with_differences():
    """Labels move smoothly: the derivative is that of a fixed place's texels, which cross no texel's middle here."""
    rows, columns = np.indices(FRAME)
    smooth = np.sin(np.stack([rows / 5 + k + columns / 7 for k in range(8)], axis=-1)).reshape(*FRAME, 2, 4)
    layers = np.ascontiguousarray(0.5 + 0.3 * smooth.transpose(2, 0, 1, 3), np.float32)
    labels, matrix = wavy_labels(), matrices()[1]
    codes = np.random.default_rng(5).integers(100, 156, (*SHAPE, 3), np.uint8)

    def error(changed_labels, changed_layers):
        picture = SoftSheets(changed_labels, changed_layers).draw(matrix, SHAPE).astype(float)
        return np.square(picture - codes / 255).sum()

    places, drawn = drawn_layers(labels, layers, matrix)
    by_layer, by_label = np.zeros_like(layers), np.zeros_like(labels)
    total = backpropagate(codes, places, drawn, list(by_layer))
    for k in range(2):
        add_label_gradient(drawn[k], places[k], layers[k], view_rays(matrix, places.shape[1:3]), by_label[k])
    assert total == pytest.approx(error(labels, layers), rel=1e-5)
    step = np.float32(1e-3) * np.random.default_rng(6).standard_normal(layers.shape).astype(np.float32)
    change = error(labels, layers + step) - error(labels, layers - step)
    assert change == pytest.approx(2 * float(np.vdot(by_layer.astype(float), step)), rel=5e-3, abs=1e-5)
    for k in range(2):  # a whole sheet nearer: labels are level where the derivative is exact
        step = np.zeros_like(labels)
        step[k] = 2e-3
        change = error(labels + step, layers) - error(labels - step, layers)
        assert change == pytest.approx(2 * float(np.vdot(by_label.astype(float), step)), rel=0.1)


def test_planes_are_shared_out_among_sheets_by_what_they_hold():
    labels = np.array([0.0, 1.0, 2.0, 6.0, 7.0, 9.0])
    layers = np.full((6, 12, 16, 4), 0.5, np.float32)
    layers[..., 3] = 0
    layers[0, ..., 3] = 1
    layers[3, :, :8, 3], layers[4, :, 8:, 3] = 1, 1
    layers[3, :, :8, 0], layers[4, :, 8:, 0] = 0.2, 0.8
    found = sheets_of(MultiplaneImage(labels, layers), 2)
    assert_allclose(found.labels[0], 0, atol=1e-5)
    assert found.labels[1, :, 0].mean() == pytest.approx(6, abs=0.1)
    assert found.labels[1, :, 15].mean() == pytest.approx(7, abs=0.1)
    assert_allclose(found.layers[1, ..., 3], 1)
    assert_allclose(found.layers[1, :, 2, :3], np.broadcast_to([0.2, 0.5, 0.5], (12, 3)), atol=1e-6)


def test_sheets_find_a_slanted_wall_between_planes():
    """Two planes, and a wall that leans from one to the other: labels follow it, and held-out views are drawn well."""
    rows, columns = np.indices(FRAME)
    wall = np.zeros((1, *FRAME, 4), np.float32)
    pattern = 0.5 + 0.2 * np.sin(columns / 1.7) + 0.2 * np.sin(rows / 2.1 + columns / 5)
    wall[0] = np.stack([pattern, 0.9 * pattern, 0.7 * pattern, np.ones(FRAME)], axis=-1)
    leaning = (0.6 + 1.2 * columns / FRAME[1]).astype(np.float32)[None]
    views, shown = matrices(), [0, 1, 2, 3, 5, 6, 8]
    pictures = np.stack([SoftSheets(leaning, wall).draw(matrix, SHAPE) for matrix in views])
    codes = np.round(np.clip(pictures, 0, 1) * 255).astype(np.uint8)
    planes, tuning = MultiplaneTuning(steps=60, levels=4), SheetTuning(steps=200, levels=4)
    given = codes[shown], views[shown], FRAME, np.array([0.6, 1.2, 1.8]), [1]
    (found,) = fit_sheets(*given, planes=planes, tuning=tuning)
    inner = slice(6, -6), slice(8, -8)
    assert np.abs(found.labels[0] - leaning[0])[inner].mean() < 0.15
    assert psnr(found.draw(views[4], SHAPE), codes[4]) > 30
