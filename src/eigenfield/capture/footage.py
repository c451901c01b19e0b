"""Footage: what the cameras of an array film. At each instant it is a light field, or a set of photographs."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.identity import content_digest
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photoset import Capture, PhotoSet, Shot
from eigenfield.capture.tracks import Track, VideoTrack
from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera
from eigenfield.core.clip import Timeline
from eigenfield.runtime.parallel import parallel_map


@dataclass(frozen=True, eq=False)
class Footage:
    """Frames of several cameras on one clock; each decodes when it is asked for, and none becomes a file.

    Attributes:
        root: The folder in which it was found.
        timeline: Of its instants.
        still: Cameras, lenses and masks, without pixels of any instant.
        tracks: Of each camera.
        frames: (cameras, instants) the frame of each track at each instant.
        held: (cameras, instants) True where a camera has no frame then, so that the frame before stands in for it and
            is masked out.
        problems: Lines for people.
    """

    root: Path
    timeline: Timeline
    still: Capture
    tracks: tuple[Track, ...]
    frames: NDArray[np.int64]
    held: NDArray[np.bool_]
    problems: tuple[str, ...] = ()

    __repr__ = brief_repr

    def __len__(self) -> int:
        return self.timeline.frames

    @property
    def names(self) -> tuple[str, ...]:
        """Of the cameras."""
        return tuple(track.name for track in self.tracks)

    @property
    def cameras(self) -> tuple[Camera, ...] | None:
        """None where they are not known."""
        return None if self.still.light_field is None else self.still.light_field.cameras

    @property
    def sizes(self) -> list[tuple[int, int]]:
        """(width, height) of each camera's frames."""
        return self.still.sizes

    @property
    def lenses(self) -> tuple[tuple[str, tuple[float, ...]] | None, ...] | None:
        """As of `LightField`; None where cameras are not known."""
        return None if self.still.light_field is None else self.still.light_field.lenses

    @property
    def as_stored(self) -> tuple[int, ...]:
        return () if self.still.light_field is None else self.still.light_field.as_stored

    @property
    def exposure(self) -> float | None:
        return self.still.exposure

    @property
    def metres_per_unit(self) -> float | None:
        return None if self.still.light_field is None else self.still.light_field.metres_per_unit

    @property
    def origin(self) -> NDArray[np.float64]:
        return np.zeros(3) if self.still.light_field is None else self.still.light_field.origin

    @property
    def bytes(self) -> int:
        """Of all its files."""
        return sum(track.bytes for track in self.tracks)

    def identity(self) -> str:
        """A digest of the frames of all cameras at all instants, and of the bytes of their files and masks.

        As for photographs it is their bytes that count, since a copy of an object has another time. Reading them
        costs little beside decoding, and whoever opens a video has read all of it for the times of its frames.

        Raises:
            CaptureError: `image-missing`, a file no longer exists.
        """

        def contents(camera: int) -> list[str | None]:
            mask = self.still.sources[camera].mask
            own = self.tracks[camera].contents(np.unique(self.frames[camera]).tolist())
            return [None if mask is None else content_digest(mask), *own]

        found = json.dumps(parallel_map(contents, range(len(self.tracks))))
        return hashlib.sha256(found.encode() + self.frames.tobytes() + self.held.tobytes()).hexdigest()

    def instant(self, number: int) -> Capture:
        """All cameras at an instant, counted from 0. Photographs decode when they are asked for, from any thread; that
        of a camera without a frame then is masked out as a whole.

        Raises:
            IndexError: There is no such instant.
        """
        if not 0 <= number < len(self):
            raise IndexError(f"instant {number} of {len(self)}")
        return at_frames(self.still, self.tracks, self.frames[:, number], self.held[:, number])

    def photographs(self, number: int) -> PhotoSet:
        """All cameras at an instant, without what is known of them."""
        instant = self.instant(number)
        if instant.light_field is None:
            return instant
        shots = tuple(map(Shot.of, instant.views))
        return PhotoSet(self.root, shots, instant.layout, self.problems, instant.format)

    def instants(self, first: int = 0, last: int | None = None) -> Iterator[Capture]:
        """The instants from `first` up to, and without, `last`, in order: the way in which videos decode fastest."""
        for number in range(first, len(self) if last is None else last):
            yield self.instant(number)

    def part(self, first: int, last: int) -> Footage:
        """The instants from `first` up to, and without, `last`."""
        start = float(self.timeline.times[first])
        timeline = Timeline(self.timeline.rate, last - first, start)
        return replace(self, timeline=timeline, frames=self.frames[:, first:last], held=self.held[:, first:last])

    def subset(self, indices: Iterable[int]) -> Footage:
        """Some of the cameras, in the order given."""
        chosen = list(indices)
        tracks = tuple(self.tracks[index] for index in chosen)
        still, frames, held = self.still.subset(chosen), self.frames[chosen], self.held[chosen]
        return replace(self, still=still, tracks=tracks, frames=frames, held=held)

    def reduced(self, factor: int) -> Footage:
        """The same with smaller pictures: a pixel is the mean of `factor` by `factor` pixels."""
        return replace(self, still=self.still.reduced(factor))

    def with_cameras(self, cameras: Sequence[Camera], lenses: Sequence[Lens | None] | None = None) -> Footage:
        """The same with other cameras, or with cameras where none were known.

        Args:
            cameras: In order.
            lenses: Distortion to remove; None: what is removed now.
        """
        return replace(self, still=self.still.with_cameras(cameras, lenses))

    def close(self) -> None:
        """Let go of decoders and what they keep; what is asked for next opens them again."""
        for track in self.tracks:
            if isinstance(track, VideoTrack):
                track.film.close()


def at_frames(still: Capture, tracks: Sequence[Track], frames: NDArray[np.int64], held: NDArray[np.bool_]) -> Capture:
    """The cameras of `still` with the pixels of a frame of each track.

    Args:
        frames: (cameras,) their numbers.
        held: (cameras,) whether each stands in for one that is missing.
    """
    chosen = list(zip(tracks, frames.tolist(), held.tolist(), strict=True))
    if still.light_field is None:
        shots = zip(still.shots, chosen, strict=True)
        return replace(still, shots=tuple(track.at(shot, *rest) for shot, (track, *rest) in shots))
    views = zip(still.views, chosen, strict=True)
    return replace(still, views=tuple(track.at(view, *rest) for view, (track, *rest) in views))
