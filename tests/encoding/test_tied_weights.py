"""Weights that frames share are those of one dense least squares problem for each camera."""

from __future__ import annotations

from contextlib import ExitStack

import numpy as np
import pytest

from eigenfield.core.proxy import Proxy
from eigenfield.encoding.fitted.kernels import forward
from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.observations import (
    FitData,
    decode_observations,
    open_camera_footprints,
    open_subsampled,
)
from eigenfield.encoding.fitted.solve import measure_scales, texture_gram, whiten, whitening
from eigenfield.encoding.fitted.start import residual_image
from eigenfield.encoding.fitted.tied_weights import weight_equations
from support.observations import InMemory
from support.scenes import bumpy_square, row_grid, smooth_pictures, unit_weights

SIDE, GRID, COUNT, CAMERAS = 64, (40, 36), 3, row_grid(6, 72, 60)
RGB = np.eye(3, dtype=np.float32)
RECTANGLE = (0, GRID[0], 0, GRID[1])


def model_of(frame: int, weights: np.ndarray) -> PlaneModel:
    """Mean and textures of a frame."""
    mean = 0.5 + 0.2 * smooth_pictures(1, SIDE, SIDE, 3, 10 + frame)[0].transpose(2, 0, 1)
    textures = 0.1 * smooth_pictures(COUNT, *GRID, 3, 20 + frame).transpose(0, 3, 1, 2)
    block = Block(RECTANGLE, np.ascontiguousarray(textures), weights)
    return PlaneModel(RGB, np.ascontiguousarray(mean.astype(np.float32)), GRID, [block])


@pytest.fixture(scope="module")
def frames():
    """Three frames of six cameras, one with a mask; all pixels, and every second."""
    mask = np.ones((60, 72), np.float32)
    mask[10:30, 20:50] = 0
    with ExitStack() as kept:
        footprints = kept.enter_context(open_camera_footprints(CAMERAS, Proxy(bumpy_square(12)), (SIDE, SIDE)))
        opened = []
        for frame in range(3):
            pictures = list(0.5 + 0.3 * smooth_pictures(6, 60, 72, 3, frame))
            seen = InMemory(pictures, [mask if frame == 1 and index == 2 else None for index in range(6)])
            codes, masks = np.zeros((6 * 60 * 72, 3), np.uint8), np.zeros(6 * 60 * 72, np.uint8)
            opened.append(FitData(decode_observations(CAMERAS, seen, codes, masks), footprints))
        yield opened, [kept.enter_context(open_subsampled(one, 2)) for one in opened]


def dense_solution(frames, camera):
    """The weights of a camera by one matrix with a row for each pixel and channel of all frames."""
    rows, values = [], []
    for number, data in enumerate(frames):
        model = model_of(number, np.zeros((6, COUNT), np.float32))
        left = residual_image(data, model, camera)
        drawn = []
        for texture in model.blocks[0].textures:
            image = np.zeros_like(left)
            forward(*data.footprint(camera), data.size, texture, np.float32(1), image)
            drawn.append(image)
        weight = data.observations.weights(camera)
        root = np.sqrt(weight / 255.0) if weight.size else np.ones(left.shape[1:])
        rows.append((np.stack(drawn) * root).reshape(COUNT, -1).T)
        values.append((left * root * (data.footprint(camera)[0] > 0)).reshape(-1))
    return np.linalg.lstsq(np.concatenate(rows).astype(np.float64), np.concatenate(values), rcond=None)[0]


@pytest.mark.parametrize("which", [0, 1])
def test_weights_that_frames_share_are_those_of_a_dense_solution(frames, which):
    data, start = frames[which], unit_weights(6, COUNT, 5)
    equations = [weight_equations(one, model_of(number, start)) for number, one in enumerate(data)]
    found = sum(equations[1:], equations[0]).solve(start)
    expected = np.array([dense_solution(data, camera) for camera in range(6)])
    np.testing.assert_allclose(found, expected, atol=2e-3 * np.abs(expected).max())
    alone = equations[0].solve(start)
    assert np.abs(alone - expected).max() > 20 * np.abs(found - expected).max()


def test_solved_weights_leave_nothing_to_solve(frames):
    data, start = frames[0], unit_weights(6, COUNT, 5)
    weights = weight_equations(data[0], model_of(0, start)).solve(start)
    again = weight_equations(data[0], model_of(0, weights))
    np.testing.assert_allclose(again.solve(weights), weights, atol=1e-3 * np.abs(weights).max())
    assert again.squares < weight_equations(data[0], model_of(0, start)).squares


def test_frames_are_whitened_together(frames):
    weights = (unit_weights(6, COUNT, 5) @ np.array([[1, 0.5, 0], [0, 2, 0.3], [0.1, 0, 0.5]])).astype(np.float32)
    models = [model_of(number, weights) for number in range(3)]
    scales = measure_scales(frames[0][0], models[0])
    grams = [texture_gram(model.blocks[0], scales) for model in models]
    rotation, whitened = whitening(weights, sum(grams))
    np.testing.assert_allclose(whitened.T @ whitened / 6, np.eye(COUNT), atol=1e-6)
    together = rotation @ sum(grams) @ rotation.T
    np.testing.assert_allclose(together, np.diag(np.diag(together)), atol=1e-5 * together.max())
    assert (np.diff(np.diag(together)) < 0).all()
    for model in models:
        before = np.tensordot(weights, model.blocks[0].textures, 1)
        after = np.tensordot(whitened @ rotation, model.blocks[0].textures, 1)
        np.testing.assert_allclose(after, before, atol=1e-5)
    whiten(models[0], scales)
    alone, _ = whitening(weights, grams[0])
    shown = np.tensordot(alone, model_of(0, weights).blocks[0].textures, 1)
    np.testing.assert_allclose(np.abs(models[0].blocks[0].textures), np.abs(shown), atol=1e-4)
