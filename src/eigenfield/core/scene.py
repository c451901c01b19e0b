"""An eigen-texture scene in memory: what `encode` makes, a file keeps and `render` draws."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.core import notebook
from eigenfield.core.appearance import Appearance
from eigenfield.core.errors import OptionError
from eigenfield.core.payloads import Payloads
from eigenfield.core.proxy import Proxy
from eigenfield.core.rig import Rig

T = TypeVar("T")

_lock = threading.RLock()  # of what is derived from any scene


@dataclass(frozen=True, eq=False)
class Residual:
    """Photographs of the encoded cameras minus what the scene draws of them, coded: for captured views alone.

    Attributes:
        video: The coded video, a frame for each encoded camera.
        size: (rows, columns) of the pictures in it, whose top left part a photograph is.
        order: (Ne,) the cameras of the frames, counted among the encoded ones.
        scale: What a code of luma, and of chroma, stands for.
        full: Chroma is as fine as luma, below it in the frames, not half as fine.
        smooth: What the scene draws has smooth edges, not one sample a pixel, or k x k (files before 1.5).
        codec: Of the video, a name in `coding.codecs.CODECS`.
    """

    video: bytes
    size: tuple[int, int]
    order: NDArray[np.int64]
    scale: tuple[float, float]
    full: bool = False
    smooth: bool = False
    codec: str = "video-1"

    @property
    def frame(self) -> tuple[int, int]:
        """(rows, columns) of the video's frames."""
        rows, columns = self.size
        return (3 * rows if self.full else rows), columns


@dataclass(frozen=True, eq=False)
class Scene:
    """Everything needed to draw any viewpoint on the view plane.

    An observation is a photograph by an encoded camera at one instant. Weights have a row for each.

    Attributes:
        proxy: The surface.
        rig: The cameras.
        appearance: What is drawn on the surface.
        settings: JSON object: how it was made.
        scores: JSON object: what `evaluate --store` measured.
        generator: Name and version of the program that made it.
        residual: What is missing from captured views, or None. No other view has anything of it.
        times: The instants of its observations, in seconds; one for a still scene.
    """

    proxy: Proxy
    rig: Rig
    appearance: Appearance
    settings: Mapping[str, Any] = field(default_factory=dict)
    scores: Mapping[str, Any] = field(default_factory=dict)
    generator: str = ""
    residual: Residual | None = None
    times: tuple[float, ...] = (0.0,)
    _derived: dict[str, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    def rows(self, cameras: ArrayLike | None = None, time: int = 0) -> NDArray[np.int64]:
        """Which rows of the weights are the observations of some cameras at one instant.

        Rows are in the order of instants, and at each in that of the encoded cameras. This is the only place that
        knows.

        Args:
            cameras: (n,) or () indices into `rig.cameras`; None: all encoded ones.
            time: Index into `times`.

        Returns:
            The rows, in the shape of `cameras`; -1 for held-out cameras, which have none.
        """
        encoded = ~self.rig.held_out
        among = np.where(encoded, np.cumsum(encoded) - 1, -1)
        found = among[self.rig.encoded if cameras is None else np.asarray(cameras, np.int64)]
        return np.where(found < 0, -1, found + time * int(encoded.sum()))

    @property
    def observations(self) -> int:
        """How many rows the weights have."""
        return len(self.times) * int((~self.rig.held_out).sum())

    def derived(self, name: str, make: Callable[[], T]) -> T:
        """What `make` returns, called once and kept as long as this object. Copies, pickles and `replace` have none of
        it; edits in place do not change it."""
        if name not in self._derived:
            with _lock:
                if name not in self._derived:
                    self._derived[name] = make()
        found: T = self._derived[name]
        return found

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_derived": {}}

    def _repr_html_(self) -> str | None:
        """The viewer in a frame: how a notebook shows a scene."""
        return None if notebook.show is None else notebook.show(self)


@dataclass(frozen=True, eq=False)
class EncodedScene(Scene):
    """A scene with what its parts were coded to, as `encode` and `load` return it.

    `dataclasses.replace`, copies and pickles keep the payloads. `save` writes those whose content is still there, byte
    for byte, and codes anew what was edited.

    Attributes:
        payloads: Of mesh, cameras, means, eigen textures, weights and the picture for other viewers, each under the key
            of its content. Parts that have not been coded, or that a file holds as plain numbers, have none.
    """

    payloads: Payloads = field(default_factory=Payloads)


def check_scale(metres_per_unit: float | None) -> None:
    """Raise OptionError `metres` unless the metres in one unit of the world are None or a positive, finite number."""
    if metres_per_unit is not None and not 0 < metres_per_unit < math.inf:
        raise OptionError("metres", f"{metres_per_unit:g} metres in a unit is no length", remedy="say a number above 0")
