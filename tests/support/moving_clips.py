"""Clips of tiny scenes in memory, and footage that a clip has drawn itself."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from eigenfield.core.clip import Clip, Frame, Group, Timeline
from support.observations import CalibratedInMemory
from support.redrawn import write_capture
from support.scenes import tiny_scene


@dataclass(frozen=True, eq=False)
class Groups:
    """The groups of a clip, all in memory."""

    made: tuple[Group, ...]

    @property
    def lengths(self):
        return [len(group.frames) for group in self.made]

    def group(self, index):
        return self.made[index]


@dataclass(frozen=True, eq=False)
class FootageInMemory:
    """Footage whose instants are in memory, in place of `capture.footage.Footage`.

    Attributes:
        asked: Numbers of the instants that were asked for, in order.
    """

    frames: list[CalibratedInMemory]
    asked: list[int]
    rate: Fraction = Fraction(4)

    def __len__(self):
        return len(self.frames)

    @property
    def timeline(self):
        return Timeline(self.rate, len(self.frames))

    @property
    def names(self):
        return self.frames[0].names

    @property
    def cameras(self):
        return self.frames[0].cameras

    def identity(self):
        return ""  # pixels that are looked at stand for it

    def instant(self, number):
        self.asked.append(number)
        return self.frames[number]


@dataclass(frozen=True, eq=False)
class Instants:
    """Photographs by frame, as footage has them."""

    timeline: Timeline
    captures: tuple

    def instant(self, number):
        return self.captures[number]


def tiny_clip(lengths=(3, 2), change=None, rate=30, **scene):
    """A clip of `tiny_scene`, whose mean at a frame is change(frame, mean); None: it stands still."""
    still = tiny_scene(**scene)
    plane, groups, start = still.appearance.planes[0], [], 0
    for length in lengths:
        means = [plane.mean if change is None else change(start + at, plane.mean) for at in range(length)]
        frames = [Frame((mean.astype(np.float32),), ((plane.bases[0].textures,),)) for mean in means]
        groups.append(Group(still.proxy, still.appearance, frames))
        start += length
    timeline = Timeline(Fraction(rate), sum(lengths))
    return Clip(still.rig, timeline, Groups(tuple(groups)), still.settings, generator=still.generator)


def write_footage(clip, folder, change=None, masks=None):
    """Photographs as the clip draws them at each frame, changed by change(frame, camera, picture); masks(frame,
    camera)."""
    folder.mkdir()
    captures = []
    for frame, time in enumerate(clip.timeline.times):
        own = None if change is None else lambda camera, picture, frame=frame: change(frame, camera, picture)
        mask = None if masks is None else lambda camera, frame=frame: masks(frame, camera)
        captures.append(write_capture(clip.scene(float(time)), folder / f"{frame:04d}", own, mask))
    return Instants(clip.timeline, tuple(captures))
