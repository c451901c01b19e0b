"""Passes over the frames of a group. What a pass makes of a frame is a finished stage: a run that is stopped loses one
frame of one pass at most, and memory has one frame at a time."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.observations import Observations
from eigenfield.core.progress import Progress, track
from eigenfield.encoding.clip.plan import ClipPlan, KeptPhotographs, OpenActive
from eigenfield.encoding.clip.rest import MIN_FRAMES, AtRest, camera_at_rest
from eigenfield.encoding.fitted.observations import DecodedObservations
from eigenfield.runtime.files import read_arrays
from eigenfield.runtime.parallel import tracked_map
from eigenfield.runtime.stages import SCENE_ROOMS, Stages, stage_key

ARRAYS_FILE = "frame.npz"

Arrays = Mapping[str, NDArray[Any]]


@dataclass(frozen=True, eq=False)
class FramePass:
    """What a pass has made of each frame of a group.

    Attributes:
        key: Digest of all that it depends on.
        folders: Of the frames, in order.
    """

    key: str
    folders: tuple[Path, ...]

    def __iter__(self) -> Iterator[Arrays]:
        """The arrays of each frame, one frame in memory at a time."""
        for folder in self.folders:
            yield load_arrays(folder)

    def each(self, name: str) -> Iterator[NDArray[Any]]:
        """One array of each frame; no other is read."""
        for folder in self.folders:
            with np.load(folder / ARRAYS_FILE) as found:
                yield found[name]

    def total(self, name: str) -> NDArray[Any]:
        """The sum of an array over all frames."""
        return np.asarray(sum(self.each(name)))


@dataclass(frozen=True, eq=False)
class GroupFrames:
    """The frames of a group, and where their stages are kept.

    Attributes:
        instant: The photographs of all cameras at a frame of the clip.
        numbers: Of the frames, in the clip.
        identity: What all passes depend on.
        title: Of the group, for reports of progress.
        rest: The stage of what stands still; None: nothing is averaged.
        active: From a frame's footprints to the part of each plane that changes, which is what frames after the first
            are fitted to; None: all is.
        kept: Their photographs, which are decoded once for all passes; None: not `opened`.
        made: Folders of passes, which `clear` removes.
    """

    clip: ClipPlan
    instant: Callable[[int], Any]
    numbers: range
    stages: Stages
    identity: str
    title: str
    progress: Progress | None = None
    rest: Path | None = None
    active: OpenActive | None = None
    kept: KeptPhotographs | None = None
    made: list[Path] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.numbers)

    @contextlib.contextmanager
    def opened(self) -> Iterator[GroupFrames]:
        """The same with room for its photographs, in which what stands still is averaged over the group."""
        with self.clip.open_photographs(len(self)) as kept:
            if len(self) < MIN_FRAMES:
                yield replace(self, kept=kept)
                return

            def build(folder: Path) -> None:
                def find(camera: int) -> None:
                    each = (self.observations(number).photograph(camera) for number in self.numbers)
                    moving = self.clip.moving
                    moves = None if moving is None else moving.moving_pixels(self.clip.cameras[camera], self.numbers)
                    camera_at_rest(each, len(self), moves).save(folder, camera)

                tracked_map(find, range(len(self.clip.cameras)), f"{self.title}: what stands still", self.progress)

            key = stage_key([self.identity, "rest"], SCENE_ROOMS)
            folder = self.stages.run(f"rest-{self.numbers.start:05d}", key, build)
            self.made.append(folder)
            yield replace(self, rest=folder, kept=kept)

    @contextlib.contextmanager
    def changing(self) -> Iterator[GroupFrames]:
        """The same with what changes, which is what frames after the first are fitted to, and with room for what passes
        need again of frames."""
        with self.clip.caching() as clip:
            if self.rest is None:
                yield replace(self, clip=clip)
                return
            with clip.open_active(self.rest, self.numbers) as active:
                yield replace(self, clip=clip, active=active)

    def photographs(self, number: int) -> DecodedObservations:
        """Those of a frame, decoded; of an `opened` group."""
        assert self.kept is not None
        return self.kept.frame(number - self.numbers.start, lambda: self.observations(number))

    def observations(self, number: int) -> Observations:
        """The photographs of a frame, as they are or with what stands still averaged."""
        own = self.clip.observations(self.instant(number))
        return own if self.rest is None else AtRest(own, self.rest)

    def run(
        self,
        name: str,
        make: Callable[..., Arrays],
        given: Iterable[Any] | None = None,
        after: FramePass | None = None,
        *,
        with_first: bool = False,
    ) -> FramePass:
        """A pass over all frames.

        Args:
            name: Of the pass, each once in a group.
            make: From a frame's pixels, and what is given for it, to the arrays that are kept.
            given: Something for each frame; None: nothing.
            after: The pass before it.
            with_first: Whether `make` also gets, last, what it made of the first frame; None for that frame itself.
        """

        def of_frame(number: int, first: Path | None, *one: Any) -> Arrays:
            more = (None if first is None else load_arrays(first),) if with_first else ()
            active = None if first is None else self.active
            with self.clip.open_frame(number, self.photographs(number), active) as pixels:
                return make(pixels, *one, *more)

        return self.run_frames(name, of_frame, given, after)

    def run_frames(
        self,
        name: str,
        make: Callable[..., Arrays],
        given: Iterable[Any] | None = None,
        after: FramePass | None = None,
    ) -> FramePass:
        """A pass over all frames that opens their photographs by itself.

        Args:
            make: From a frame's number, the stage of the first frame (None: it is this one), and what is given for it.
        """
        key = stage_key([self.identity, name, None if after is None else after.key], SCENE_ROOMS)
        inputs = ((one,) for one in given) if given is not None else (() for _ in self.numbers)
        folders: list[Path] = []
        steps = zip(self.numbers, inputs, strict=True)
        for number, one in track(steps, f"{self.title}: {name}", len(self), self.progress):

            def build(folder: Path, number: int = number, one: tuple[Any, ...] = one) -> None:
                save_arrays(folder, make(number, folders[0] if folders else None, *one))

            folders.append(self.stages.run(f"{name}-{number:05d}", key, build))
        self.made.extend(folders)
        return FramePass(key, tuple(folders))

    def keeper(self, name: str, after: FramePass) -> Callable[[Callable[[Path], None]], Path]:
        """A function that makes a finished stage of the whole group by one that writes its files, or finds it."""

        def keep(write: Callable[[Path], None]) -> Path:
            key = stage_key([self.identity, after.key, name], SCENE_ROOMS)
            folder = self.stages.run(f"{name}-{self.numbers.start:05d}", key, write)
            self.made.append(folder)
            return folder

        return keep

    def clear(self) -> None:
        """Remove what the passes kept, once the group is whole."""
        for folder in self.made:
            self.stages.remove(folder)
        self.made.clear()


def save_arrays(folder: Path, arrays: Arrays) -> None:
    """Arrays as a file of a stage."""
    named: dict[str, Any] = dict(arrays)
    np.savez(folder / ARRAYS_FILE, **named)


def load_arrays(folder: Path) -> Arrays:
    """The arrays of a finished stage."""
    return read_arrays(folder / ARRAYS_FILE)
