"""An eigen-texture scene in memory: what `encode` makes, a file keeps and `render` draws."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from eigenfield.core import notebook
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payloads
from eigenfield.core.viewplane import ViewPlane

T = TypeVar("T")

_lock = threading.RLock()  # of what is derived from any scene


@dataclass(frozen=True, eq=False)
class Basis:
    """N eigen textures and what each encoded camera takes of them.

    Attributes:
        textures: (N, H, W, C), float32 values as `encode` makes them, or uint8 or uint16 codes as a file keeps them.
        scale, zero: (N, C) float32: value = (stored - zero) * scale; ones and zeros for float textures.
        weights: (Ne, N) float32, the paper's ω(c, j), a row for each encoded camera in the order of `Scene.names`.
        grid: (rows, columns) of the whole atlas at this basis's density; None: the textures are all of it.
        corner: Row and column of the grid at which the textures begin; they are zero elsewhere.
    """

    textures: NDArray[Any]
    scale: NDArray[np.float32]
    zero: NDArray[np.float32]
    weights: NDArray[np.float32]
    grid: tuple[int, int] | None = None
    corner: tuple[int, int] = (0, 0)

    @property
    def count(self) -> int:
        return int(self.textures.shape[0])

    @property
    def size(self) -> tuple[int, int]:
        """(rows, columns) of the whole atlas at this basis's density."""
        rows, columns = self.textures.shape[1:3]
        return self.grid or (int(rows), int(columns))

    def values(self, first: int = 0, last: int | None = None) -> NDArray[np.float32]:
        """(n, H, W, C) float32: the textures [first, last) as numbers."""
        part = slice(first, last)
        stored = self.textures[part].astype(np.float32)
        return (stored - self.zero[part, None, None]) * self.scale[part, None, None]

    def truncated(self, count: int) -> Basis:
        """The first `count` components."""
        parts = (self.textures[:count], self.scale[:count], self.zero[:count], self.weights[:, :count])
        return Basis(*parts, self.grid, self.corner)


@dataclass(frozen=True, eq=False)
class Plane:
    """Channels that share a mean and bases, which may have densities of their own.

    Attributes:
        mean: (H, W, C) float32 in 0..1 (of other attributes than colours: any range).
        bases: Summed onto the mean one after the other.
    """

    mean: NDArray[np.float32]
    bases: tuple[Basis, ...]

    @property
    def sizes(self) -> list[tuple[int, int]]:
        """(rows, columns) of the mean's atlas, then of each basis's."""
        return [(int(self.mean.shape[0]), int(self.mean.shape[1])), *(basis.size for basis in self.bases)]


@dataclass(frozen=True, eq=False)
class Residual:
    """Photographs of the encoded cameras minus what the scene draws of them, coded: for captured views alone.

    Attributes:
        film: The coded film, a frame for each encoded camera.
        size: (rows, columns) of the pictures in it, whose top left part a photograph is.
        order: (Ne,) the cameras of the frames, counted among the encoded ones.
        scale: What a code of luma, and of chroma, stands for.
        full: Chroma is as fine as luma, below it in the frames, not half as fine.
        smooth: What the scene draws has smooth edges, not one sample a pixel, or k x k (files before 1.5).
        codec: Of the film, a name in `coding.codecs.CODECS`.
    """

    film: bytes
    size: tuple[int, int]
    order: NDArray[np.int64]
    scale: tuple[float, float]
    full: bool = False
    smooth: bool = False
    codec: str = "video-1"

    @property
    def frame(self) -> tuple[int, int]:
        """(rows, columns) of the film's frames."""
        rows, columns = self.size
        return (3 * rows if self.full else rows), columns


@dataclass(frozen=True, eq=False)
class Scene:
    """Everything needed to draw any viewpoint on the view plane.

    Attributes:
        mesh: The proxy, with UVs.
        planes: One plane of three channels (R, G, B), or planes that `to_rgb` joins; any channels of other attributes.
        names, cameras: Every capture camera, encoded or held out.
        held_out: (Nc,) bool; held-out photographs took no part in textures, mean and weights.
        reference: Index into `cameras` of the one nearest the centre, or the one asked for.
        view_plane: The plane through the cameras.
        triangles: (T, 3) int32 Delaunay triangles on it over the *encoded* cameras.
        settings, scores: JSON objects: how it was made, and what `evaluate --store` measured.
        generator: Name and version of the program that made it.
        colours: (Nc, 2, 3) float32 gains and offsets of R, G, B, or None: each camera's map became gain * map + offset,
            so its own view is (drawn - offset) / gain. Gain 1 and offset 0 for held-out cameras.
        to_rgb: (3, K) float32, R, G and B from the K channels of all planes one after the other; None: they are what
            is drawn.
        residual: What is missing from captured views, or None. No other view has anything of it.
    """

    mesh: Mesh
    planes: tuple[Plane, ...]
    names: tuple[str, ...]
    cameras: tuple[Camera, ...]
    held_out: NDArray[np.bool_]
    reference: int
    view_plane: ViewPlane
    triangles: NDArray[np.int32]
    settings: Mapping[str, Any] = field(default_factory=dict)
    scores: Mapping[str, Any] = field(default_factory=dict)
    generator: str = ""
    colours: NDArray[np.float32] | None = None
    to_rgb: NDArray[np.float32] | None = None
    residual: Residual | None = None
    _derived: dict[str, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def atlas(self) -> tuple[int, int]:
        """(rows, columns) of the texture that is composed and drawn: the most that any mean or basis has."""
        sizes = [size for plane in self.planes for size in plane.sizes]
        return max(rows for rows, _ in sizes), max(columns for _, columns in sizes)

    @property
    def channels(self) -> int:
        """Channels of a drawn picture."""
        return 3 if self.to_rgb is not None else sum(int(plane.mean.shape[2]) for plane in self.planes)

    @property
    def encoded(self) -> NDArray[np.int64]:
        """(Ne,) indices into `cameras` of the encoded ones: the rows of the weights."""
        return np.flatnonzero(~self.held_out)

    @property
    def textures(self) -> int:
        """Number of eigen textures of the largest plane."""
        return max((sum(basis.count for basis in plane.bases) for plane in self.planes), default=0)

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
