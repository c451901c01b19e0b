"""Cameras of photographs whose EXIF orientation was applied, as cameras of the pixels that their files store."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.lightfield import View
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photographs.read import read_header
from eigenfield.core.errors import CaptureError

# EXIF orientation: direction in the upright picture to the one in the stored picture, x right and y down
STORED_DIRECTIONS = {3: ((-1, 0), (0, -1)), 6: ((0, 1), (-1, 0)), 8: ((0, -1), (1, 0))}


def turned_orientation(view: View) -> int:
    """The EXIF orientation that is applied when the photograph is read; 1 where there is none, or no such file yet."""
    if not view.upright:
        return 1
    try:
        return read_header(view.path).orientation
    except CaptureError:
        return 1


def stored_pixels(view: View) -> NDArray[np.float64] | None:
    """(3, 3) upright pixels to those of the stored picture; None where that is mirrored, as no camera sees it."""
    orientation = turned_orientation(view)
    if orientation == 1:
        return np.eye(3)
    if orientation not in STORED_DIRECTIONS:
        return None
    turn = np.eye(3)
    turn[:2, :2] = STORED_DIRECTIONS[orientation]
    # the picture's corner stays one: what would become negative is counted from the other side
    turn[:2, 2] = np.where(
        turn[:2, :2].sum(axis=1) < 0, np.abs(turn[:2, :2]) @ (view.camera.width, view.camera.height), 0
    )
    return turn


def stored_view(view: View) -> View | None:
    """The view with the camera and the lens of the stored pixels, without skew; None as `stored_pixels`."""
    pixels = stored_pixels(view)
    if pixels is None or np.array_equal(pixels, np.eye(3)):
        return None if pixels is None else view
    turn = pixels.copy()
    turn[:2, 2] = 0
    camera = view.camera
    width, height = np.abs(turn[:2, :2]) @ (camera.width, camera.height)
    turned = replace(
        camera, K=pixels @ camera.K @ turn.T, R=turn @ camera.R, t=turn @ camera.t, width=int(width), height=int(height)
    )
    lens = view.lens
    if lens is not None and lens.model in ("brown", "rational"):  # p2 x + p1 y is a direction; the rest is round
        k1, k2, p1, p2, *more = lens.coefficients
        p2, p1 = (turn[:2, :2] @ (p2, p1)).tolist()
        lens = Lens(lens.model, (k1, k2, p1, p2, *more))
    return replace(view, camera=turned, lens=lens, upright=False)
