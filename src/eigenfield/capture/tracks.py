"""The cameras of footage: each has a track of frames in the order of time, which are decoded when they are asked for.

No frame becomes a file: a video is read by a decoder that stays open between frames.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Protocol, TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.film import Film
from eigenfield.capture.identity import content_digest
from eigenfield.capture.lightfield import View
from eigenfield.capture.photographs.decoded import size_on_disk
from eigenfield.capture.photographs.read import decode
from eigenfield.capture.photoset import Shot
from eigenfield.core.errors import CaptureError

PICTURE_DAMAGE = "image-unreadable", "image-truncated", "image-kind"  # codes of errors that cost one frame

log = logging.getLogger(__name__)

S = TypeVar("S", View, Shot)


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

    def contents(self, indices: Iterable[int]) -> list[str | None]:
        """Digests of the files that some frames are read from, in order, and of their masks. CaptureError
        `image-missing`."""

    def at(self, source: S, index: int, held: bool) -> S:
        """A view or shot with the pixels of a frame.

        Args:
            held: The frame stands in for one that is missing, so that it is masked out.
        """

    def small(self, index: int, side: int) -> NDArray[np.float32] | None:
        """(h, w) a frame in grey, of 0..1, its longer side not above `side`; None where it is damaged."""


@dataclass(frozen=True, eq=False)
class PictureTrack:
    """A camera whose frames are pictures in files.

    Attributes:
        masks: Of each, where a calibration names masks of frames; empty otherwise.
    """

    name: str
    files: tuple[Path, ...]
    times: NDArray[np.float64]
    masks: tuple[Path | None, ...] = ()

    @property
    def path(self) -> Path:
        return self.files[0]

    @property
    def bytes(self) -> int:
        return sum(map(size_on_disk, self.files))

    def contents(self, indices: Iterable[int]) -> list[str | None]:
        found = [(self.files[index], self.masks[index] if self.masks else None) for index in indices]
        return [None if path is None else content_digest(path) for pair in found for path in pair]

    def at(self, source: S, index: int, held: bool) -> S:
        mask = self.masks[index] if self.masks and not held else source.mask
        picture = _PictureFrame(self, index, held, source.upright, source.exposure)
        return replace(source, name=self.name, path=self.files[index], mask=mask, picture=picture)

    def small(self, index: int, side: int) -> NDArray[np.float32] | None:
        found = self.decode(index)
        if found is None:
            return None
        pixels, _ = found
        scale = min(1.0, side / max(pixels.shape[:2]))
        width, height = (max(1, round(length * scale)) for length in pixels.shape[1::-1])
        return np.asarray(cv2.resize(pixels, (width, height), interpolation=cv2.INTER_AREA).mean(axis=-1), np.float32)

    def decode(
        self, index: int, upright: bool = True, exposure: float | None = None
    ) -> tuple[NDArray[np.float32], NDArray[np.float32] | None] | None:
        """(H, W, 3) pixels and (H, W) alpha of a frame; None where it is damaged, which is told once."""
        try:
            return decode(self.files[index], upright, exposure)
        except CaptureError as error:
            if error.code not in PICTURE_DAMAGE:
                raise
            _tell_damage(str(error))
            return None


@cache
def _tell_damage(text: str) -> None:
    """Once, though each pass over the frames finds it."""
    log.warning("%s; until then it is masked out", text)


@dataclass(frozen=True)
class _PictureFrame:
    """A picture; where it is damaged, masked out, the nearest sound one before it, or else after it.

    Attributes:
        held: It stands in for a missing one.
    """

    track: PictureTrack
    index: int
    held: bool
    upright: bool
    exposure: float | None

    def decode(self) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
        for number in (*range(self.index, -1, -1), *range(self.index + 1, len(self.track.files))):
            found = self.track.decode(number, self.upright, self.exposure)
            if found is not None:
                pixels, alpha = found
                return pixels, alpha if number == self.index and not self.held else _hidden(pixels)
        return decode(self.track.files[self.index], self.upright, self.exposure)  # all are damaged: raises why

    def identity(self) -> list[int]:
        return [-1] if self.held else []


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

    def contents(self, indices: Iterable[int]) -> list[str | None]:
        return [content_digest(self.film.path)]

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

    def identity(self) -> list[int]:
        return [-1 if self.held else self.index]
