"""Frames of several cameras on one clock of constant rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import CaptureError

CLOCK_NEAREST = 0.75  # of a frame: a camera without a frame nearer than this has a hole there
CLOCK_FARTHEST = 2.0**62  # frames: what lies farther away is no clip, and could not be counted
CLOCK_MAX_HOLE = 3  # frames that are missing one after the other, over which the frame before is held


@dataclass(frozen=True, eq=False)
class Extent:
    """From when to when a camera has frames, in frames of the clock.

    Attributes:
        last: The one after the last.
    """

    name: str
    first: int
    last: int

    def __str__(self) -> str:
        return f"{self.name} {self.first} to {self.last - 1}"


def extent_of(name: str, times: NDArray[np.float64], offset: int) -> Extent:
    """From the clock's frame nearest to a camera's first frame to the one nearest to its last.

    Args:
        times: (n,) of its frames, ascending, in frames of the clock.
        offset: Frames of the camera that come before the clock's beginning.
    """
    first, last = np.rint(times[[0, -1]].clip(-CLOCK_FARTHEST, CLOCK_FARTHEST)).astype(np.int64) - offset
    return Extent(name, int(first), int(last) + 1)


def place_on_clock(
    times: NDArray[np.float64], offset: int, wanted: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """The nearest frame of a camera for each wanted frame of the clock, and whether it only stands in.

    Args:
        times: (n,) of its frames, ascending, in frames of the clock.
        offset: Frames of the camera that come before the clock's beginning.
        wanted: (T,) ascending.

    Returns:
        (T,) numbers of its frames; in a hole, and behind the last one, the frame before. (T,) True in those places, and
        before its first frame.
    """
    at = wanted + float(offset)
    after = np.searchsorted(times, at).clip(0, len(times) - 1)
    before = np.maximum(after - 1, 0)
    nearest = np.where(np.abs(times[before] - at) <= np.abs(times[after] - at), before, after)
    held = np.abs(times[nearest] - at) > CLOCK_NEAREST
    behind = np.maximum(np.searchsorted(times, at, side="right") - 1, 0)
    return np.where(held, behind, nearest), held


def refuse_long_holes(extent: Extent, wanted: NDArray[np.int64], held: NDArray[np.bool_], path: object) -> int:
    """Raise CaptureError `footage-hole` where more than `CLOCK_MAX_HOLE` frames in a row are missing between others.

    Returns:
        How many frames are held there.
    """
    inside = held & (wanted >= extent.first) & (wanted < extent.last)
    run = 0
    for number, missing in zip(wanted.tolist(), inside.tolist(), strict=True):
        run = run + 1 if missing else 0
        if run > CLOCK_MAX_HOLE:
            raise CaptureError(
                "footage-hole",
                f"{extent.name} lacks more than {CLOCK_MAX_HOLE} frames one after the other, about frame {number}",
                path=str(path),
                remedy="put them back, or name a --clip without them",
            )
    return int(inside.sum())


def common_range(extents: Sequence[Extent], path: object) -> tuple[int, int]:
    """The frames that all cameras have; CaptureError `footage-range` where there are none."""
    first, last = max(one.first for one in extents), min(one.last for one in extents)
    if first >= last:
        early, late = min(extents, key=lambda one: one.last), max(extents, key=lambda one: one.first)
        raise CaptureError(
            "footage-range",
            f"its cameras have no frame in common: {early}, and {late}",
            path=str(path),
            remedy="say --offset NAME=FRAMES: how many frames of that camera come before the others begin",
        )
    return first, last
