"""The cameras of a capture, which of them are encoded, and the plane that they stand on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera
from eigenfield.core.viewplane import ViewPlane


@dataclass(frozen=True, eq=False)
class Rig:
    """All Nc cameras of a capture, encoded or held out.

    Attributes:
        cameras: In the capture's order.
        held_out: (Nc,) bool; held-out photographs were not used for textures, mean and weights.
        reference: Index of the camera nearest the centre, or of the one chosen by the user; an encoded one.
        triangles: (T, 3) int32 Delaunay triangles of the view plane over the *encoded* cameras, by their order.
    """

    names: tuple[str, ...]
    cameras: tuple[Camera, ...]
    held_out: NDArray[np.bool_]
    reference: int
    view_plane: ViewPlane
    triangles: NDArray[np.int32]

    __repr__ = brief_repr

    @property
    def encoded(self) -> NDArray[np.int64]:
        """(Ne,) indices of the encoded cameras."""
        return np.flatnonzero(~self.held_out)

    @property
    def encoded_cameras(self) -> list[Camera]:
        return [self.cameras[index] for index in self.encoded]

    @property
    def encoded_reference(self) -> int:
        """The reference camera, counted among the encoded ones."""
        return int(np.searchsorted(self.encoded, self.reference))
