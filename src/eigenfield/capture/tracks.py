"""The cameras of footage: each has a track of frames in the order of time, which are decoded when they are asked for.

No frame becomes a file: a video is read by a decoder that stays open between frames.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol, TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.film import Film
from eigenfield.capture.lightfield import View
from eigenfield.capture.photographs.decoded import size_on_disk
from eigenfield.capture.photographs.read import decode
from eigenfield.capture.photoset import Shot

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

    def at(self, source: S, index: int, held: bool) -> S:
        file = self.files[index]
        picture = _Held(file, source.upright, source.exposure) if held else None
        mask = self.masks[index] if self.masks and not held else source.mask
        return replace(source, name=self.name, path=file, mask=mask, picture=picture)

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

    def identity(self) -> list[int]:
        return [-1]


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

    def identity(self) -> list[int]:
        return [-1 if self.held else self.index]
