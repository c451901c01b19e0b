"""A video as frames by number, decoded one after the other by a decoder that stays open between them."""

from __future__ import annotations

import logging
import threading
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import av.error
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.readers.video import Shown, decode_video, find_film, to_rgb, video_errors
from eigenfield.core.errors import CaptureError

RATE_DEFAULT = Fraction(30)  # of what does not state one
RATE_USUAL = *map(Fraction, (24, 25, 30, 48, 50, 60, 120)), *(Fraction(n * 1000, 1001) for n in (24, 30, 60, 120))
RATE_TOLERANCE = 0.003  # by which rates may differ that are the same
RATE_END = 0.4  # frames by which the last one may be off
RATE_ROUNDING = 0.02  # likewise, where times are rounded to milliseconds
RATE_MAX_DENOMINATOR = 1001
RATE_EXTREME = 1e9  # beyond this, and below its reciprocal, no rate is told from another: a clip has none of them
FILM_MAX_SKIP = 16  # frames that are decoded and thrown away before a decoder is opened anew at a key frame

log = logging.getLogger(__name__)


@dataclass(eq=False)
class Film:
    """A video whose frames are read by number, from any thread; cheapest one after the other.

    Attributes:
        stamps: Of its frames, ascending, in units of the time base; the first frame of the stream is at 0.
        keys: Numbers of the frames at which decoding can begin.
        base: Seconds in a unit.
        rate: Frames a second.
    """

    path: Path
    stamps: tuple[int, ...]
    keys: tuple[int, ...]
    base: Fraction
    rate: Fraction
    _shown: Shown | None = field(default=None, init=False)
    _frames: Iterator[Shown] | None = field(default=None, init=False)
    _kept: tuple[int, NDArray[np.uint8], bool] | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._gate = threading.Lock()

    def __reduce__(self) -> tuple[Any, ...]:
        return Film, (self.path, self.stamps, self.keys, self.base, self.rate)  # another process opens its own decoder

    @property
    def seconds(self) -> NDArray[np.float64]:
        """(n,) when each frame is shown."""
        return np.array(self.stamps, np.float64) * float(self.base)

    def read(self, index: int) -> tuple[NDArray[np.uint8], bool]:
        """A frame as (H, W, 3) uint8 sRGB-coded values, upright, and whether it is damaged.

        Raises CaptureError: `video-unreadable`, `video-short`, `video-colours`, `video-large`.
        """
        with self._gate:
            if self._kept is None or self._kept[0] != index:
                shown, damaged = self._decode(index)
                if damaged:
                    log.warning("%s: frame %d is damaged, and masked out", self.path, index)
                self._kept = index, to_rgb(shown), damaged
            return self._kept[1], self._kept[2]

    def read_small(self, index: int, side: int) -> NDArray[np.float32] | None:
        """A frame in grey, of 0..1, its longer side not above `side`, not turned; None where it is damaged."""
        with self._gate:
            (frame, *_), damaged = self._decode(index)
            scale = min(1.0, side / max(frame.width, frame.height))
            width, height = (max(1, round(length * scale)) for length in (frame.width, frame.height))
            grey = frame.reformat(width, height, format="gray", interpolation="AREA").to_ndarray()
            return None if damaged else grey.astype(np.float32) / np.float32(255)

    def close(self) -> None:
        """Let go of the decoder; the next `read` opens another."""
        with self._gate:
            self._frames = self._shown = self._kept = None

    def _decode(self, index: int) -> tuple[Shown, bool]:
        """The frame of a number, or the next one that can be decoded, and whether it is damaged."""
        try:
            self._go_to(index)
        except CaptureError as error:
            self._shown = None
            later = next((key for key in self.keys if key > index), None)
            if error.code != "video-unreadable" or later is None:
                raise
            self._open(self._moment(later))
        if self._shown is None:
            raise CaptureError(
                "video-short",
                f"its frames from number {index} on cannot be decoded",
                path=self.path,
                remedy="copy it again, or end the --clip before",
            )
        return self._shown, self._shown.damaged or _stamp(self._shown) != self.stamps[index]

    def _go_to(self, index: int) -> None:
        place = bisect_right(self.keys, index) - 1
        here = None if self._shown is None else bisect_left(self.stamps, _stamp(self._shown))
        starts: list[float | int | None] = [None]  # on from here
        if here is None or here > index or here + FILM_MAX_SKIP < self.keys[place]:
            # In MPEG streams seeking may end behind the frame, or lack what it is built on: then a key frame sooner
            starts = [self._moment(index), self._moment(self.keys[max(place - 1, 0)]), 0]
        for start in starts:
            if start is not None:
                self._open(start)
            assert self._frames is not None
            while self._shown is not None and _stamp(self._shown) < self.stamps[index]:
                self._shown = next(self._frames, None)
            if self._shown is not None and _stamp(self._shown) == self.stamps[index] and not self._shown.damaged:
                return

    def _moment(self, index: int) -> float:
        """Seconds at which a frame is shown for certain."""
        return float((self.stamps[index] + Fraction(1, 2)) * self.base)

    def _open(self, time: int | float) -> None:
        self._frames = decode_video(self.path, time)
        self._shown = next(self._frames, None)


def _stamp(shown: Shown) -> int:
    return 0 if shown.frame.pts is None else shown.frame.pts


def open_film(path: Path) -> Film:
    """A video with the times of its frames, of which none is decoded.

    Raises CaptureError: `video-unreadable`.
    """
    with video_errors(path), av.open(str(path), metadata_errors="replace") as container:
        stream = find_film(container)
        found = [] if stream is None else _stamps(container, stream)
        if stream is not None and container.format.name == "avi":
            _refuse_guessed_times(stream, path)
        if stream is not None and found and stream.time_base is not None:
            start = stream.start_time or 0
            order = sorted({(stamp - start, key) for stamp, key in found})
            keys = {0, *(number for number, (_, key) in enumerate(order) if key)}
            stamps = tuple(stamp for stamp, _ in order)
            rate = _rate_of(stream, np.diff(np.array(stamps, np.float64)) * float(stream.time_base))
            return Film(path, stamps, tuple(sorted(keys)), stream.time_base, rate)
    raise CaptureError(
        "video-unreadable", "holds no frame whose time is stated", path=path, remedy="take it out of the folder"
    )


def as_rate(rate: float, tolerance: float = RATE_TOLERANCE) -> Fraction:
    """Frames a second as a fraction: one that cameras have, where it differs by no more than a tolerance."""
    rate = min(max(rate, 1 / RATE_EXTREME), RATE_EXTREME)
    usual = min(RATE_USUAL, key=lambda one: abs(one / rate - 1))
    fraction = usual if abs(usual / rate - 1) <= tolerance else Fraction(rate)
    if fraction < 1:  # of a time lapse the seconds between frames are a short number
        return 1 / (1 / fraction).limit_denominator(RATE_MAX_DENOMINATOR)
    return fraction.limit_denominator(RATE_MAX_DENOMINATOR)


def _rate_of(stream: av.VideoStream, steps: NDArray[np.float64]) -> Fraction:
    """As the file states it, if most of its frames come so; else as they come, holes apart.

    Args:
        steps: Seconds from each frame to the next.
    """
    if not len(steps):
        return stream.average_rate or RATE_DEFAULT
    middle = 1 / float(np.median(steps))
    if stream.guessed_rate and abs(stream.guessed_rate / middle - 1) <= RATE_ROUNDING:
        return stream.guessed_rate
    frames = float(np.maximum(np.rint(steps * middle), 1).sum())
    return as_rate(frames / float(steps.sum()), max(RATE_TOLERANCE, RATE_END / frames))


def _refuse_guessed_times(stream: av.VideoStream, path: Path) -> None:
    """Raise CaptureError `video-unreadable` where an AVI, which states no times, has frames in another order than they
    are shown. Of MPEG-4 FFmpeg knows it from the pictures; of these codecs it takes the order of the file."""
    if stream.codec_context.name in ("h264", "hevc") and stream.codec_context.has_b_frames:
        raise CaptureError(
            "video-unreadable",
            "is an AVI that does not state in which order its frames are shown",
            path=path,
            remedy="encode it anew as MP4 (a copy of its stream would not do)",
        )


def _stamps(container: av.container.InputContainer, stream: av.VideoStream) -> list[tuple[int, bool]]:
    """Time stamp of each frame that is shown, and whether decoding can begin there. Of a video that is cut short, those
    that are there."""
    found: list[tuple[int, bool]] = []
    try:
        for packet in container.demux(stream):
            if packet.pts is not None and packet.size and not packet.is_discard:
                found += [(packet.pts, bool(packet.is_keyframe))]
    except av.error.FFmpegError:
        if not found:
            raise
    return found
