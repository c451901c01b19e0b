"""Observations: photographs, each taken by one camera at one instant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera


@dataclass(frozen=True, eq=False)
class Photograph:
    """One decoded photograph, without lens distortion.

    Attributes:
        pixels: (H, W, 3) float32, 0..1, sRGB-coded; other attributes than colour have their own channels and range.
        mask: (H, W) float32, 0..1, 1 where the photograph counts; None where all of it does.
    """

    pixels: NDArray[np.float32]
    mask: NDArray[np.float32] | None

    __repr__ = brief_repr

    @staticmethod
    def of(pixels: NDArray[np.float32], mask: NDArray[np.float32] | None) -> Photograph:
        """The photograph; a mask that is 1 everywhere becomes None."""
        return Photograph(pixels, None if mask is not None and mask.min() >= 1 else mask)


class Observations(Protocol):
    """Photographs of one scene, each by a camera at an instant: `LightField`, `PhotoSet`, parts of them, or arrays.

    Cameras and instants are counted from 0. Functions that need the cameras themselves are handed them beside the
    observations, in that order. Rows of weights, texture maps and errors are observations, in their order here.
    """

    def __len__(self) -> int:
        """How many observations there are."""

    def camera_of(self, index: int) -> int:
        """The camera that took an observation."""

    def time_of(self, index: int) -> int:
        """The instant at which an observation was taken."""

    def photograph(self, index: int) -> Photograph:
        """Decode one observation now, pixels and mask at once. May be called from any thread."""


class CalibratedObservations(Observations, Protocol):
    """Observations whose cameras are known: a `LightField`, or photographs of a rig at one instant."""

    @property
    def names(self) -> Sequence[str]:
        """(Nc,) of the cameras."""

    @property
    def cameras(self) -> Sequence[Camera]:
        """(Nc,) the pinhole cameras of the photographs as they are decoded."""

    @property
    def lenses(self) -> Sequence[tuple[str, Sequence[float]] | None]:
        """(Nc,) model and coefficients of the lens that was removed; None where there was none."""

    @property
    def as_stored(self) -> Sequence[int]:
        """Cameras whose photograph's EXIF orientation is not applied, although its size would be the same."""

    @property
    def exposure(self) -> float | None:
        """Factor of the photographs' linear values before the sRGB curve; None where they were coded already."""

    @property
    def metres_per_unit(self) -> float | None:
        """Metres in one unit of the cameras' world; None if unknown."""

    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) the origin of the cameras' world in that of the files of calibration and mesh; zero but for worlds that
        are far from their origin."""

    def bytes(self, index: int) -> int:
        """The size of an observation's file."""


@dataclass(frozen=True, eq=False)
class _Selection:
    """Some of the observations of `whole`, whose cameras are renumbered.

    Attributes:
        camera: From camera numbers of `whole` to those here.
    """

    whole: Observations
    indices: tuple[int, ...]
    camera: Mapping[int, int]

    def __len__(self) -> int:
        return len(self.indices)

    def camera_of(self, index: int) -> int:
        return self.camera[self.whole.camera_of(self.indices[index])]

    def time_of(self, index: int) -> int:
        return self.whole.time_of(self.indices[index])

    def photograph(self, index: int) -> Photograph:
        return self.whole.photograph(self.indices[index])


def select_cameras(observations: Observations, cameras: Sequence[int]) -> Observations:
    """The observations of some cameras, which are counted in the order given.

    Args:
        cameras: Numbers of cameras, each once.

    Returns:
        The observations of these cameras at all instants: one instant after the other, at each in the cameras' order.
    """
    place = {camera: number for number, camera in enumerate(cameras)}
    chosen = [index for index in range(len(observations)) if observations.camera_of(index) in place]
    chosen.sort(key=lambda index: (observations.time_of(index), place[observations.camera_of(index)]))
    return _Selection(observations, tuple(chosen), place)


def cameras_of(observations: Observations) -> NDArray[np.int64]:
    """(No,) the camera of each observation."""
    return np.array([observations.camera_of(index) for index in range(len(observations))], np.int64)
