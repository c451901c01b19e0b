"""A clip: a function from time to scenes of one instant.

A clip is cut into groups of frames, each of which is decoded by itself. Constant in a group are the weights of its
cameras, the scale of its codes, and the topology and texture coordinates of its proxy. Each frame has a mean, eigen
textures, an opacity and vertices of its own.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import accumulate
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Appearance
from eigenfield.core.brief import brief_repr
from eigenfield.core.errors import OptionError
from eigenfield.core.payloads import Payloads
from eigenfield.core.proxy import Proxy
from eigenfield.core.rig import Rig
from eigenfield.core.rights import Rights
from eigenfield.core.scene import Scene


@dataclass(frozen=True)
class Timeline:
    """When the frames of a clip are shown.

    Attributes:
        rate: Frames a second, above 0.
        frames: How many there are, at least 1.
        first: The time of the first one, in seconds.
    """

    rate: Fraction
    frames: int
    first: float = 0.0

    def __post_init__(self) -> None:
        if self.rate <= 0 or self.frames < 1 or not math.isfinite(self.first):
            raise ValueError(f"no timeline: {self.frames} frames at a rate of {self.rate}, from {self.first} s on")

    @property
    def times(self) -> NDArray[np.float64]:
        """(frames,) in seconds."""
        return self.first + np.arange(self.frames, dtype=np.float64) * (self.rate.denominator / self.rate.numerator)

    def frame_at(self, time: float) -> int:
        """The number of the frame that is nearest to a time in seconds. OptionError `time`, more than half a frame
        before the first or behind the last."""
        number = (time - self.first) * float(self.rate)
        if not -0.5 <= number <= self.frames - 0.5:  # False for NaN
            last = float(self.times[-1])
            remedy = f"give {self.first:g} to {last:g} seconds"
            raise OptionError("time", f"the clip has no frame at {time:g} s", remedy=remedy)
        return min(max(math.floor(number + 0.5), 0), self.frames - 1)


@dataclass(frozen=True, eq=False)
class Audio:
    """The sound of a clip.

    Attributes:
        data: An Ogg file of Opus.
        first: The time, in seconds of the clip, of its beginning.
    """

    data: bytes
    first: float = 0.0

    __repr__ = brief_repr


@dataclass(frozen=True, eq=False)
class Frame:
    """What one frame of a group has of its own.

    Attributes:
        means: (H, W, C) of each plane.
        textures: (N, H, W, C) of each basis of each plane, in the group's codes.
        opacity: (H, W) in 0..1 of sheets; None: that of the group's first frame.
        vertices: (V, 3); None: those of the group's first frame.
    """

    means: tuple[NDArray[np.float32], ...]
    textures: tuple[tuple[NDArray[Any], ...], ...]
    opacity: NDArray[np.float32] | None = None
    vertices: NDArray[np.float32] | None = None

    __repr__ = brief_repr


@dataclass(frozen=True, eq=False)
class Group:
    """Some frames of a clip that share weights, codes and topology.

    Attributes:
        proxy: Of the first frame.
        appearance: Of the first frame. All frames have its weights, scales, regions and colours.
        frames: All of them, the first too. A sequence may decode each when it is taken.
        payloads: What the parts that all frames share were coded to.
    """

    proxy: Proxy
    appearance: Appearance
    frames: Sequence[Frame]
    payloads: Payloads = field(default_factory=Payloads)

    __repr__ = brief_repr

    def of_frame(self, number: int) -> tuple[Proxy, Appearance]:
        """Proxy and appearance of a frame, counted in the group.

        Raises:
            ValueError: The frame's arrays have not the shapes of the first one's.
        """
        frame = self.frames[number]
        planes = []
        for plane, mean, textures in zip(self.appearance.planes, frame.means, frame.textures, strict=True):
            _check_shape("a mean", mean, plane.mean)
            bases = []
            for basis, own in zip(plane.bases, textures, strict=True):
                _check_shape("eigen textures", own, basis.textures)
                bases.append(replace(basis, textures=own))
            planes.append(replace(plane, mean=mean, bases=tuple(bases)))
        return self._proxy_of(frame), replace(self.appearance, planes=tuple(planes))

    def _proxy_of(self, frame: Frame) -> Proxy:
        proxy = self.proxy
        if frame.vertices is not None:
            _check_shape("vertices", frame.vertices, proxy.mesh.vertices)
            proxy = replace(proxy, mesh=replace(proxy.mesh, vertices=frame.vertices))
        if frame.opacity is not None:
            if proxy.sheets is None:
                raise ValueError("a frame has an opacity, and its group has no sheets")
            _check_shape("an opacity", frame.opacity, proxy.sheets.opacity)
            proxy = replace(proxy, sheets=replace(proxy.sheets, opacity=frame.opacity))
        return proxy


class GroupSource(Protocol):
    """The groups of a clip in the order of time, each decoded when it is asked for."""

    @property
    def lengths(self) -> Sequence[int]:
        """Frames of each group."""

    def group(self, index: int) -> Group:
        """A group by its number."""


@dataclass(frozen=True, eq=False)
class Clip:
    """A scene that changes with time, seen by cameras that stand still.

    Attributes:
        timeline: When frames are shown.
        groups: As many frames in all as the timeline has.
        audio: None: it is silent.
        rights: Title, author, licence and source, as far as somebody said them.
    """

    rig: Rig
    timeline: Timeline
    groups: GroupSource
    settings: Mapping[str, Any] = field(default_factory=dict)
    scores: Mapping[str, Any] = field(default_factory=dict)
    generator: str = ""
    audio: Audio | None = None
    rights: Rights = field(default_factory=Rights)

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        total = sum(self.groups.lengths)
        if total != self.timeline.frames or min(self.groups.lengths) < 1:
            raise ValueError(f"groups of {list(self.groups.lengths)} frames, {self.timeline.frames} in the timeline")

    def scene(self, time: float) -> Scene:
        """The scene of the frame nearest to a time in seconds. OptionError `time`, outside the clip."""
        number = self.timeline.frame_at(time)
        starts = [0, *accumulate(self.groups.lengths)]
        index = bisect_right(starts, number) - 1
        group = self.groups.group(index)
        proxy, appearance = group.of_frame(number - starts[index])
        payloads = group.payloads if proxy.mesh is group.proxy.mesh else group.payloads.without("mesh")
        return Scene(
            proxy,
            self.rig,
            appearance,
            self.settings,
            generator=self.generator,
            payloads=payloads,
            rights=self.rights,
        )


def _check_shape(what: str, found: NDArray[Any], first: NDArray[Any]) -> None:
    if found.shape != first.shape or found.dtype != first.dtype:
        raise ValueError(f"{what} of {found.dtype} {found.shape}, the group's are {first.dtype} {first.shape}")
