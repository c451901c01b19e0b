"""What moves before a surface that stands still: planes of known depth, and changes of light."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.stereo.change import changed_pixels, in_light_of
from eigenfield.stereo.moving import StillDepth, find_moving
from support.passing import HALF_HEIGHT, HALF_WIDTH, SIDE, SQUARE_LABEL, WALL_LABEL, matrices_of, square, wall
from support.planes import everywhere, paint, photograph

MATRICES = matrices_of(5)
MIDDLE = 12  # the camera whose picture is the reference view


def seen(*layers, noise=1.0, seed=1):
    drawn = photograph([*layers, wall()], MATRICES, SIDE)
    noisy = drawn + np.random.default_rng(seed).normal(0, noise, drawn.shape)
    return np.clip(np.rint(noisy), 0, 255).astype(np.uint8)


EMPTY = seen(seed=0)
WALL = StillDepth.of(MATRICES, np.full((SIDE, SIDE), WALL_LABEL, np.float32))


def moving(pictures, still=EMPTY, before=None, depth=WALL):
    changed = np.stack([changed_pixels(one, other) for one, other in zip(pictures, still, strict=True)])
    return find_moving(pictures, changed, depth, before)


def square_mask(middle):
    rows, columns = np.mgrid[:SIDE, :SIDE]
    return (abs(columns - middle) < HALF_WIDTH) & (abs(rows - SIDE / 2) < HALF_HEIGHT)


def agreement(opacity, mask):
    """Intersection over union."""
    return (np.minimum(opacity, mask).sum()) / np.maximum(opacity, mask).sum()


@pytest.mark.parametrize("middle", [SIDE / 2, 20, 77.5])
def test_a_square_before_a_wall(middle):
    found, mask = moving(seen(square(middle))), square_mask(middle)
    assert agreement(found.opacity, mask) > 0.9
    inner = mask & (found.opacity > 0.9)
    assert np.quantile(np.abs(found.d[inner] - SQUARE_LABEL), 0.99) < WALL.step
    assert np.abs(found.d[inner] - SQUARE_LABEL).mean() < 0.15


def test_a_square_without_texture_is_found_by_its_outline():
    plain = (*square(50)[:3], np.full((4, 4, 3), 230.0), square(50)[4])
    found = moving(seen(plain))
    assert agreement(found.opacity, square_mask(50)) > 0.9
    assert np.abs(found.d[square_mask(50)] - SQUARE_LABEL).mean() < WALL.step


def test_nothing_moves():
    assert not moving(seen(noise=2.0)).opacity.any()


@pytest.mark.parametrize("kind", ["brighter", "from one side", "shadow", "new paint"])
def test_a_change_of_light_or_of_colour_is_no_motion(kind):
    pictures = seen()
    if kind == "brighter":
        pictures = np.clip(1.3 * pictures, 0, 255)
    elif kind == "from one side":
        pictures = pictures * np.linspace(0.6, 1.2, SIDE)[:, None]
    elif kind == "shadow":
        shade = np.full((256, 256, 3), 255.0)
        shade[30:60, 30:60] = 150
        pictures = pictures * (photograph([(WALL_LABEL, 0, 0, shade, everywhere)], MATRICES, SIDE) / 255)
    else:
        painted = (WALL_LABEL, 0.0, 0.0, paint(9, detail=2.0), square(40)[4])
        pictures = seen(painted)
    assert not moving(np.rint(pictures).astype(np.uint8)).opacity.any()


def test_what_is_seen_behind_where_something_was_has_a_place():
    """The still surface has a square that has gone: what was behind it is farther."""
    d = np.where(square_mask(48), SQUARE_LABEL, WALL_LABEL).astype(np.float32)
    found = moving(EMPTY, seen(square(48)), depth=StillDepth.of(MATRICES, d))
    assert agreement(found.opacity, square_mask(48)) > 0.8
    inner = square_mask(48) & (found.opacity > 0.5)
    assert np.abs(found.d[inner] - WALL_LABEL).mean() < 0.3


def test_depth_stays_where_the_pictures_stay():
    first = moving(seen(square(40)))
    again = seen(square(40), seed=2)
    steady, alone = moving(again, before=first), moving(again)
    inner = square_mask(40)
    assert np.abs(steady.d - first.d)[inner].mean() < 0.5 * np.abs(alone.d - first.d)[inner].mean()
    moved = moving(seen(square(52), seed=2), before=first)
    assert agreement(moved.opacity, square_mask(52)) > 0.9


def test_a_camera_that_is_masked_out_does_not_count():
    pictures = seen(square(40))
    pictures[3] = 0
    shown = np.ones(pictures.shape[:3], bool)
    shown[3] = False
    changed = np.stack([changed_pixels(one, other) for one, other in zip(pictures, EMPTY, strict=True)])
    found = find_moving(pictures, changed, WALL, shown=shown)
    assert agreement(found.opacity, square_mask(40)) > 0.9


def test_light_is_found_where_a_third_of_the_picture_moves():
    still = np.clip(paint(3, SIDE), 20, 150).astype(np.uint8)
    across, down = np.meshgrid(np.linspace(-1, 1, SIDE), np.linspace(-1, 1, SIDE))
    factor = np.exp(0.2 + 0.1 * across - 0.15 * down)[..., None] * (1.0, 0.95, 1.05)
    lit = (still + 8.0) * factor - 8
    picture = np.clip(lit, 0, 255)
    picture[20:60, 30:70] = 90
    beside = np.ones((SIDE, SIDE), bool)
    beside[20:60, 30:70] = False
    found = in_light_of(np.rint(picture).astype(np.uint8), still)
    assert np.abs(found - lit)[beside].mean() < 1.5
    changed = changed_pixels(np.rint(picture).astype(np.uint8), still)
    assert changed[25:55, 35:65].mean() > 0.9 and changed[beside].mean() < 0.1
