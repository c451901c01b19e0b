"""The cameras of footage: each has a track of frames in the order of time, which are decoded when they are asked for.

No frame becomes a file: a video is read by a decoder that stays open between frames.
"""

from __future__ import annotations

import logging
import threading
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Protocol, TypeVar

import av
import av.error
import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.lightfield import View
from eigenfield.capture.photographs.decoded import size_on_disk
from eigenfield.capture.photographs.read import decode
from eigenfield.capture.photoset import Shot
from eigenfield.capture.readers.video import Shown, decode_video, find_film, to_rgb
from eigenfield.core.errors import CaptureError

S = TypeVar("S", View, Shot)
FILM_MAX_SKIP = 16  # frames that are decoded and thrown away before a decoder is opened anew at a key frame

log = logging.getLogger(__name__)


class Track(Protocol):
    """The frames of one camera.

    Attributes:
        name: Of the camera.
        path: Of the video, or of the first picture.
        times: (n,) of its frames, ascending, in frames of the footage's clock; the offset is not in them.
    """

    @property
    def name(self) -> str: ...
    @property
    def path(self) -> Path: ...
    @property
    def times(self) -> NDArray[np.float64]: ...
    @property
    def bytes(self) -> int:
        """Of all its files."""

    def at(self, source: S, index: int, held: bool) -> S:
        """A view or shot with the pixels of a frame.

        Args:
            held: The frame stands in for one that is missing, so that it is masked out.
        """

    def small(self, index: int, side: int) -> NDArray[np.float32] | None:
        """(h, w) a frame in grey, of 0..1, its longer side not above `side`; None where it is damaged."""


@dataclass(frozen=True, eq=False)
class PictureTrack:
    """A camera whose frames are pictures in files."""

    name: str
    files: tuple[Path, ...]
    times: NDArray[np.float64]

    @property
    def path(self) -> Path:
        return self.files[0]

    @property
    def bytes(self) -> int:
        return sum(map(size_on_disk, self.files))

    def at(self, source: S, index: int, held: bool) -> S:
        file = self.files[index]
        picture = _Held(file, source.upright, source.exposure) if held else None
        return replace(source, name=self.name, path=file, picture=picture)

    def small(self, index: int, side: int) -> NDArray[np.float32]:
        pixels, _ = decode(self.files[index])
        scale = min(1.0, side / max(pixels.shape[:2]))
        width, height = (max(1, round(length * scale)) for length in pixels.shape[1::-1])
        return np.asarray(cv2.resize(pixels, (width, height), interpolation=cv2.INTER_AREA).mean(axis=-1), np.float32)


@dataclass(frozen=True)
class _Held:
    """A picture that stands in for a missing one."""

    path: Path
    upright: bool
    exposure: float | None

    def decode(self) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
        pixels, _ = decode(self.path, self.upright, self.exposure)
        return pixels, _hidden(pixels)


def _hidden(pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """A mask that hides a picture."""
    return np.zeros(pixels.shape[:2], np.float32)


@dataclass(frozen=True, eq=False)
class VideoTrack:
    """A camera whose frames are those of a video."""

    name: str
    film: Film
    times: NDArray[np.float64]

    @property
    def path(self) -> Path:
        return self.film.path

    @property
    def bytes(self) -> int:
        return size_on_disk(self.film.path)

    def at(self, source: S, index: int, held: bool) -> S:
        return replace(source, name=self.name, path=self.film.path, picture=_FilmFrame(self.film, index, held))

    def small(self, index: int, side: int) -> NDArray[np.float32] | None:
        return self.film.read_small(index, side)


@dataclass(frozen=True)
class _FilmFrame:
    film: Film
    index: int
    held: bool

    def decode(self) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
        rgb, damaged = self.film.read(self.index)
        pixels = rgb.astype(np.float32) / np.float32(255)
        return pixels, _hidden(pixels) if self.held or damaged else None


@dataclass(eq=False)
class Film:
    """A video whose frames are read by number, from any thread; cheapest one after the other.

    Attributes:
        stamps: Of its frames, ascending, in units of the time base; the first frame of the stream is at 0.
        keys: Numbers of the frames at which decoding can begin.
        base: Seconds in a unit.
        rate: Frames a second as the file states them; None where it does not.
    """

    path: Path
    stamps: tuple[int, ...]
    keys: tuple[int, ...]
    base: Fraction
    rate: Fraction | None
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
        """The frame of a number, or the next one that there is, and whether it is damaged."""
        key = self.keys[bisect_right(self.keys, index) - 1]
        here = None if self._shown is None else bisect_left(self.stamps, _stamp(self._shown))
        if here is None or here > index or here + FILM_MAX_SKIP < key:
            self._open(float((self.stamps[index] + Fraction(1, 2)) * self.base))
            if self._shown is not None and _stamp(self._shown) > self.stamps[index]:  # sought too far
                self._open(0)
        assert self._frames is not None
        while self._shown is not None and _stamp(self._shown) < self.stamps[index]:
            self._shown = next(self._frames, None)
        if self._shown is None:
            raise CaptureError(
                "video-short",
                f"its frames from number {index} on cannot be decoded",
                path=self.path,
                remedy="copy it again, or end the --clip before",
            )
        return self._shown, self._shown.damaged or _stamp(self._shown) != self.stamps[index]

    def _open(self, time: int | float) -> None:
        self._frames = decode_video(self.path, time)
        self._shown = next(self._frames, None)


def _stamp(shown: Shown) -> int:
    return 0 if shown.frame.pts is None else shown.frame.pts


def open_film(path: Path) -> Film:
    """A video with the times of its frames, of which none is decoded.

    Raises CaptureError: `video-unreadable`.
    """
    try:
        with av.open(str(path)) as container:
            stream = find_film(container)
            found = [] if stream is None else _stamps(container, stream)
            if stream is not None and found and stream.time_base is not None:
                start = stream.start_time or 0
                order = sorted({(stamp - start, key) for stamp, key in found})
                keys = {0, *(number for number, (_, key) in enumerate(order) if key)}
                stamps = tuple(stamp for stamp, _ in order)
                return Film(path, stamps, tuple(sorted(keys)), stream.time_base, stream.average_rate)
    except (av.error.FFmpegError, OSError) as error:
        raise CaptureError(
            "video-unreadable",
            f"is damaged or no video ({str(error).splitlines()[0][:120]})",
            path=path,
            remedy="copy it again, or take it out of the folder",
        ) from error
    raise CaptureError(
        "video-unreadable", "holds no frame whose time is stated", path=path, remedy="take it out of the folder"
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
