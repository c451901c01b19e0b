"""Texels that a frame does not show: films are to code no change of them.

Such a texel is as in the group's first frame. On the backmost of several sheets it is as in the first frame that shows
it, also before that one: then what a thing uncovers as it moves is in the key picture. Before that sheet a texel is a
place that things pass, and has nothing of its own to wait for.
"""

from __future__ import annotations

from collections.abc import Iterator

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.clip.frames import FramePass
from eigenfield.encoding.clip.plan import ClipPlan
from eigenfield.imaging.raster import rasterise_atlas

SHOWN_MIN_SHARE_RATIO = 0.6  # of the median: at an outline a texel is what is left of a pixel
BESIDE_TEXELS = 2  # of a chart, that belong to it


def hidden_held(clip: ClipPlan, frames: FramePass, shares: FramePass, name: str) -> Iterator[list[NDArray[np.float32]]]:
    """Mean or textures of each plane, frame after frame, with those of hidden texels held.

    Args:
        frames: That have them.
        shares: That say how much of its pictures each texel of a frame answers for, where the mesh moves.
        name: mean or textures.
    """
    names = [f"{name}{number}" for number in range(len(clip.planes))]
    if clip.moving is None:
        yield from ([arrays[one] for one in names] for arrays in frames)
        return
    held = [_held(clip, frames.each(one), shares.each(f"{one}-share")) for one in names]
    for arrays, of in zip(frames, shares, strict=True):
        yield [np.where(of[f"{one}-share"] > 0, arrays[one], own) for one, own in zip(names, held, strict=True)]


def _held(
    clip: ClipPlan, frames: Iterator[NDArray[np.float32]], shares: Iterator[NDArray[np.float32]]
) -> NDArray[np.float32]:
    """What hidden texels are, by the frames' values and shares."""
    held = next(frames)
    share = next(shares)
    known = _is_shown(share) | _stays_as_first(clip, share.shape)
    for values, share in zip(frames, shares, strict=True):
        new = _is_shown(share) & ~known
        held, known = np.where(new, values, held), known | new
    return held


def _is_shown(share: NDArray[np.float32]) -> NDArray[np.bool_]:
    """(rows, columns) which texels enough cameras see for them to be what they are."""
    seen = share[share > 0]
    return np.asarray(share > SHOWN_MIN_SHARE_RATIO * (float(np.median(seen)) if len(seen) else 1.0))


def _stays_as_first(clip: ClipPlan, size: tuple[int, ...]) -> NDArray[np.bool_]:
    """(rows, columns) which texels belong to another sheet than the backmost of several."""
    assert clip.moving is not None
    if not clip.moving.sheets:
        return np.ones(size, np.bool_)
    mesh, behind = clip.plan.mesh, clip.moving.sheets[0]
    inside = rasterise_atlas(mesh, size[1], size[0]).face >= behind
    around = np.ones((2 * BESIDE_TEXELS + 1,) * 2, np.uint8)
    return np.asarray(cv2.dilate(inside.astype(np.uint8), around) > 0)
