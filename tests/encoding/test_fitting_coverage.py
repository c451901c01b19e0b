"""Texels that few cameras see, and those that none sees."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.core.mesh import Mesh
from eigenfield.encoding.fitted.coverage import PRECISION_CELL_TEXELS, PRECISION_MIN_FACTOR, fill_unseen, mean_precision
from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.solve import Scales
from eigenfield.rendering.software.drawing import make_surface


def scales(mean, coarse=None):
    return Scales.opaque(mean.astype(np.float32), (mean if coarse is None else coarse).astype(np.float32), (0.0, 0.0))


def chart(left, right):
    """A surface of 96 x 96 texels with one chart, between two shares of the atlas's width."""
    corners = np.array([[left, 0], [right, 0], [right, 1], [left, 1]], np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return make_surface(Mesh(np.zeros((4, 3), np.float32), faces, corners), 96, 96)


@pytest.mark.parametrize(("fewer", "expected"), [(4, 0.5), (2, 2**-0.5), (1000, PRECISION_MIN_FACTOR)])
def test_steps_grow_with_the_root_of_what_is_not_seen(fewer, expected):
    share = np.full((8 * PRECISION_CELL_TEXELS, 8 * PRECISION_CELL_TEXELS), 40.0)
    share[:, 6 * PRECISION_CELL_TEXELS :] /= fewer
    precision = mean_precision(scales(share))
    assert precision.shape == (8, 8)
    assert np.allclose(precision[:, :6], 1) and np.allclose(precision[:, 6:], expected, rtol=0.02)


def test_what_is_seen_alike_and_what_is_not_seen_at_all_need_no_precision():
    assert mean_precision(scales(np.full((200, 300), 7.0))) is None
    assert mean_precision(scales(np.zeros((200, 300)))) is None


def test_texels_that_are_seen_often_are_no_measure():
    """More than the median is as precise as the median."""
    share = np.full((6 * PRECISION_CELL_TEXELS, 6 * PRECISION_CELL_TEXELS), 10.0)
    share[: 2 * PRECISION_CELL_TEXELS] = 1000
    assert mean_precision(scales(share)) is None


def test_the_unseen_go_on_as_the_seen_do():
    y, x = np.mgrid[0:96, 0:96]
    ramp = (0.2 + 0.006 * x).astype(np.float32)
    seen = (x - 48) ** 2 + (y - 48) ** 2 < 30**2
    mean, texture = np.where(seen, ramp, 0.5)[None], np.where(seen, -ramp, 0)[None, None]
    local = np.ascontiguousarray(texture[..., 20:50, 10:60])
    blocks = [
        Block((0, 96, 0, 96), texture.astype(np.float32), np.ones((3, 1), np.float32)),
        Block((20, 50, 10, 60), local.astype(np.float32), np.ones((3, 1), np.float32)),
    ]
    model = PlaneModel(np.eye(1, 3, dtype=np.float32), mean.astype(np.float32), (96, 96), blocks)
    fill_unseen(model, scales(seen.astype(float)), chart(0, 1))
    for found, sign, part in ((model.mean[0], 1, np.s_[:, :]), (blocks[0].textures[0, 0], -1, np.s_[:, :]),
                              (blocks[1].textures[0, 0], -1, np.s_[20:50, 10:60])):  # fmt: skip
        inside, expected = seen[part], sign * ramp[part]
        assert np.array_equal(found[inside], expected[inside])
        steps = np.abs(np.diff(found, axis=1))
        assert steps.max() < 0.06  # 0.3 beside the chart before
        low, high = expected[inside].min(), expected[inside].max()
        assert found.min() >= low - 1e-5 and found.max() <= high + 1e-5


@pytest.mark.parametrize(("share", "kept"), [(0.1, False), (0.6, True)])
def test_beside_a_chart_what_counts_for_little_goes_on_as_the_chart_does(share, kept):
    """Half of the atlas is a chart; the column of texels beside it says something else, and in the chart a texel that
    few see says what it says."""
    mean = np.full((1, 96, 96), 0.4, np.float32)
    mean[0, :, 48] = 0.9
    mean[0, 10, 10] = 0.7
    seen = np.zeros((96, 96))
    seen[:, :48], seen[:, 48], seen[10, 10] = 8, 8 * share, 0.08
    texture = np.ascontiguousarray(mean[None, :, ::2, ::2])
    block = Block((0, 48, 0, 48), texture.copy(), np.ones((3, 1), np.float32))
    model = PlaneModel(np.eye(1, 3, dtype=np.float32), mean.copy(), (48, 48), [block])
    fill_unseen(model, scales(seen, seen[::2, ::2]), chart(0, 0.5))
    assert model.mean[0, 10, 10] == np.float32(0.7)
    assert np.allclose(model.mean[0, :, 48], 0.9 if kept else 0.4, atol=1e-3)
    assert np.allclose(block.textures[0, 0, :, 24], 0.9 if kept else 0.4, atol=1e-3)
    assert np.array_equal(np.delete(model.mean[0, :, :48], 10, axis=0), np.full((95, 48), np.float32(0.4)))


def test_a_chart_goes_on_by_itself_and_not_by_what_shows_along_an_outline():
    """The left chart is dark, its middle is not seen, and around that is the outline of a bright thing before it."""
    y, x = np.mgrid[0:96, 0:96]
    away = np.hypot(x - 20, y - 48)
    hidden, outline, right = away < 12, (away >= 12) & (away < 14), x >= 56
    value = np.where(right, 0.9, np.where(outline, 0.6, 0.1)).astype(np.float32)
    share = np.where(hidden, 0, np.where(outline, 0.4, 8.0)) * ((x < 40) | right)
    start = np.where(share > 0, value, 0.5).astype(np.float32)
    corners = np.array([[0, 0], [40, 0], [40, 96], [0, 96], [56, 0], [96, 0], [96, 96], [56, 96]], np.float32) / 96
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]], np.int32)
    surface = make_surface(Mesh(np.zeros((8, 3), np.float32), faces, corners), 96, 96)
    block = Block((0, 96, 0, 96), start[None, None].copy(), np.ones((3, 1), np.float32))
    model = PlaneModel(np.eye(1, 3, dtype=np.float32), start[None].copy(), (96, 96), [block])
    fill_unseen(model, scales(share), surface)
    for found in (model.mean[0], block.textures[0, 0]):
        assert found[hidden].min() > 0.1 and found[hidden].max() < 0.2  # 0.6 by the outline alone
        assert np.array_equal(found[share > 0], value[share > 0])
        between = found[:, 40:56]
        assert between.min() > 0.1 - 1e-5 and between.max() < 0.9 + 1e-5 and np.ptp(between[48]) > 0.3
