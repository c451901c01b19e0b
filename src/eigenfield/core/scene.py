"""An eigen-texture scene in memory: `encode` makes it, a file stores it, `render` draws it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.core.appearance import Appearance
from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.forks import renew_in_child
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payloads
from eigenfield.core.provenance import Provenance
from eigenfield.core.proxy import Proxy
from eigenfield.core.rig import Rig
from eigenfield.core.rights import Rights

SCALE_MOST = 1e9  # metres in a unit, and units in a metre: readers of glTF have 32 bits
T = TypeVar("T")

_lock = threading.RLock()  # of what is derived from any scene


@renew_in_child
def _renew_lock() -> None:
    global _lock
    _lock = threading.RLock()


@dataclass(frozen=True, eq=False)
class Residual:
    """Photographs of the encoded cameras minus the scene's renderings of them, coded: for captured views alone.

    Attributes:
        video: The coded video, a frame for each encoded camera.
        size: (rows, columns) of the pictures in it, whose top left part is a photograph's.
        order: (Ne,) the camera of each frame, counted among the encoded ones.
        scale: Value of one code of luma, and of chroma.
        full_chroma: Chroma has the resolution of luma and stands below it in the frames; otherwise it has half of it.
        smooth_edges: The renderings have smooth edges, not one sample a pixel, or k x k (files before 1.5).
        codec: Of the video, a name in `coding.codecs.CODECS`.
    """

    video: bytes
    size: tuple[int, int]
    order: NDArray[np.int64]
    scale: tuple[float, float]
    full_chroma: bool = False
    smooth_edges: bool = False
    codec: str = "video-1"

    __repr__ = brief_repr

    @property
    def frame(self) -> tuple[int, int]:
        """(rows, columns) of the video's frames."""
        rows, columns = self.size
        return (3 * rows if self.full_chroma else rows), columns


@dataclass(frozen=True, eq=False)
class Scene:
    """Everything needed to draw any viewpoint on the view plane at one instant.

    Weights have a row for each encoded camera, whose photograph is an observation.

    Attributes:
        proxy: The surface.
        rig: The cameras.
        appearance: Textures and weights drawn on the surface.
        settings: JSON object: the options with which it was made.
        scores: JSON object: measures by `encode` or `evaluate --store`.
        generator: Name and version of the program that made it.
        residual: Difference of captured views to their renderings, or None. It improves no other view.
        payloads: What mesh, opacity, cameras, means, eigen textures, weights and the picture for other viewers were
            coded to, each under the key of its content. `save` writes them byte for byte for parts that are unchanged,
            and codes the others. Parts that are not coded, or that a file holds as plain numbers, have none.
        rights: Title, author, licence and source, as far as somebody said them.
        cut_off: Whether the file that it was read from ended too early, so that something of it is missing.
    """

    proxy: Proxy
    rig: Rig
    appearance: Appearance
    settings: Mapping[str, Any] = field(default_factory=dict)
    scores: Mapping[str, Any] = field(default_factory=dict)
    generator: str = ""
    residual: Residual | None = None
    payloads: Payloads = field(default_factory=Payloads)
    rights: Rights = field(default_factory=Rights)
    cut_off: bool = False
    _derived: dict[str, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def mesh(self) -> Mesh:
        """The mesh of the proxy, with UVs."""
        return self.proxy.mesh

    @property
    def cameras(self) -> tuple[Camera, ...]:
        """(Nc,) the cameras of the rig, encoded or held out."""
        return self.rig.cameras

    @property
    def names(self) -> tuple[str, ...]:
        """(Nc,) the names of the cameras: those of their photographs."""
        return self.rig.names

    def rows(self, cameras: ArrayLike | None = None) -> NDArray[np.int64]:
        """The rows of the weights for the observations of some cameras.

        Rows are in the order of the encoded cameras. Only this function relies on it.

        Args:
            cameras: (n,) or () indices into `rig.cameras`; None: all encoded ones.

        Returns:
            The rows, in the shape of `cameras`; -1 for held-out cameras, which have none.
        """
        encoded = ~self.rig.held_out
        among = np.where(encoded, np.cumsum(encoded) - 1, -1)
        return among[self.rig.encoded if cameras is None else np.asarray(cameras, np.int64)]

    @property
    def provenance(self) -> Provenance:
        """What the settings say of how the scene was made."""
        return self.derive("provenance", lambda: Provenance.of(self.settings))

    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) the origin of the scene's world in that of the capture's files; zero unless that is far from its own."""
        return self.provenance.origin

    @property
    def observations(self) -> int:
        """Number of rows of the weights."""
        return int((~self.rig.held_out).sum())

    def derive(self, name: str, make: Callable[[], T]) -> T:
        """The result of `make`, cached under a name as long as this object exists.

        Copies, pickles and `replace` start without it; edits in place do not change it.
        """
        if name not in self._derived:
            with _lock:
                if name not in self._derived:
                    self._derived[name] = make()
        return self._derived[name]

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_derived": {}}

    def __repr__(self) -> str:
        held, mesh, sheets = int(self.rig.held_out.sum()), self.proxy.mesh, self.proxy.sheets
        rows, columns = self.appearance.atlas if self.appearance.planes else (0, 0)
        layers = "" if sheets is None else f" in {len(sheets.faces)} sheets"
        more = "" if self.residual is None else f", a residual of {len(self.residual.video):,} bytes"
        return (
            f"{type(self).__name__} of {len(self.rig.cameras)} cameras, {held} of them held out\n"
            f"proxy: {len(mesh.vertices):,} vertices, {len(mesh.faces):,} triangles{layers}\n"
            f"appearance: {self.appearance.textures} eigen textures, atlas {columns}x{rows}{more}"
        )


def scale_of(scene: Scene, metres_per_unit: float | None) -> float:
    """Metres in one unit of the world: as is said, else as the scene knows, else one."""
    return (scene.provenance.metres_per_unit or 1.0) if metres_per_unit is None else float(metres_per_unit)


def check_scale(metres_per_unit: float | None) -> None:
    """Raise OptionError `metres` unless the metres in one unit of the world are None or a length for files."""
    if metres_per_unit is not None and not 1 / SCALE_MOST <= metres_per_unit <= SCALE_MOST:
        remedy = f"say a number above 0, from {1 / SCALE_MOST:g} to {SCALE_MOST:g}"
        raise OptionError("metres", f"{metres_per_unit:g} metres in a unit is no length", remedy=remedy)
