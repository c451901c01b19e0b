"""Observations in memory: any photographs by any cameras at any times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from eigenfield.core.camera import Camera
from eigenfield.core.observations import Photograph


@dataclass(frozen=True, eq=False)
class InMemory:
    """Arrays as observations.

    Attributes:
        pixels: (H, W, C) of each observation.
        masks: (H, W) or None of each; () for none at all.
        cameras, times: of each; () for a camera each, at one time.
        decoded: which observations were asked for, in order.
    """

    pixels: Sequence[np.ndarray]
    masks: Sequence[np.ndarray | None] = ()
    cameras: Sequence[int] = ()
    times: Sequence[int] = ()
    decoded: list[int] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.pixels)

    def camera_of(self, index: int) -> int:
        return self.cameras[index] if self.cameras else index

    def time_of(self, index: int) -> int:
        return self.times[index] if self.times else 0

    def photograph(self, index: int) -> Photograph:
        self.decoded.append(index)
        return Photograph.of(self.pixels[index], self.masks[index] if self.masks else None)


@dataclass(frozen=True, eq=False)
class CalibratedInMemory:
    """Observations in memory whose cameras are known: what `encode` takes in place of a light field.

    Attributes:
        observations: the photographs.
        cameras: of the rig.
    """

    observations: InMemory
    cameras: Sequence[Camera]

    def __len__(self) -> int:
        return len(self.observations)

    @property
    def names(self) -> list[str]:
        return [f"camera {index}" for index in range(len(self.cameras))]

    @property
    def lenses(self) -> list[None]:
        return [None] * len(self.cameras)

    @property
    def as_stored(self) -> tuple[()]:
        return ()

    @property
    def exposure(self) -> None:
        return None

    @property
    def metres_per_unit(self) -> None:
        return None

    @property
    def origin(self) -> np.ndarray:
        return np.zeros(3)

    def bytes(self, index: int) -> int:
        return self.observations.pixels[index].size

    def camera_of(self, index: int) -> int:
        return self.observations.camera_of(index)

    def time_of(self, index: int) -> int:
        return self.observations.time_of(index)

    def photograph(self, index: int) -> Photograph:
        return self.observations.photograph(index)


def repeated(pixels: Sequence[np.ndarray], times: int, masks: Sequence[np.ndarray | None] = ()) -> InMemory:
    """The same photographs at each of so many times, one time after the other."""
    cameras = list(range(len(pixels))) * times
    instants = [time for time in range(times) for _ in pixels]
    return InMemory(list(pixels) * times, list(masks) * times, cameras, instants)


def greys(levels: Sequence[np.ndarray]) -> InMemory:
    """Photographs without colour, of (H, W) luma."""
    return InMemory([np.repeat(level[..., None], 3, axis=2).astype(np.float32) for level in levels])
