"""The backmost of the sheets of a clip, which stands still and is opaque: it is made as for a clip on it alone."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import CalibratedObservations, Photograph
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import MovingProxy, Proxy, Sheets
from eigenfield.encoding.clip.motion import SHOWN_MIN_OPACITY, shown_faces
from eigenfield.encoding.geometry.coded import DEPTH_ERROR_PX
from eigenfield.encoding.options import EncodeOptions
from eigenfield.encoding.prepare import plan_encoding
from eigenfield.proxy.relief.find_lattice import relief_lattice

HIDDEN_MARGIN_PIXELS = 7  # around what hides the backmost sheet, which does not count


def settle_backmost(
    instant: CalibratedObservations,
    number: int,
    moving: MovingProxy,
    asked: EncodeOptions,
    work: Path | None,
    progress: Progress | None,
) -> MovingProxy:
    """The same with the backmost sheet moved to where photographs agree, and simplified by rate and distortion.

    A relief keeps its texture coordinates; what is none, or moves, stays as it is.

    Args:
        instant: Photographs of a frame, whose number this is. What other sheets show in them does not count.
    """
    proxy, sheets = moving.proxy, moving.proxy.sheets
    assert sheets is not None and moving.opacity is not None and proxy.mesh.uv is not None
    count = sheets.faces[0]
    behind = proxy.mesh.part(slice(count))
    of_behind = moving.positions[:, np.unique(proxy.mesh.faces[:count])]
    if (of_behind != of_behind[0]).any() or relief_lattice(behind, instant.cameras, DEPTH_ERROR_PX) is None:
        return moving
    before = Mesh(moving.positions[number], proxy.mesh.faces[count:], proxy.mesh.uv)
    seen = cast("CalibratedObservations", _WithoutSheets(instant, before, moving.opacity[number]))
    behind = plan_encoding(seen, Proxy(behind), asked, work, progress).mesh
    kept = np.unique(proxy.mesh.faces[count:])
    before = proxy.mesh.part(slice(count, None))
    assert behind.uv is not None and before.uv is not None
    mesh = Mesh(
        np.concatenate([behind.vertices, before.vertices]),
        np.concatenate([behind.faces, before.faces + np.int32(len(behind.vertices))]),
        np.concatenate([behind.uv, before.uv]),
    )
    still = np.broadcast_to(behind.vertices, (len(moving.positions), *behind.vertices.shape))
    positions = np.concatenate([still, moving.positions[:, kept]], axis=1)
    divided = Sheets((len(behind.faces), *sheets.faces[1:]), sheets.opacity)
    return replace(moving, proxy=replace(proxy, mesh=mesh, sheets=divided), positions=positions)


@dataclass(frozen=True, eq=False)
class _WithoutSheets:
    """Calibrated observations in which pixels that show some sheets do not count. All else is as in the `whole`."""

    whole: CalibratedObservations
    mesh: Mesh
    opacity: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.whole)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.whole, name)

    def photograph(self, index: int) -> Photograph:
        """With a mask."""
        photograph = self.whole.photograph(index)
        _, shown = shown_faces(self.mesh, self.opacity, self.whole.cameras[self.whole.camera_of(index)])
        around = np.ones((HIDDEN_MARGIN_PIXELS, HIDDEN_MARGIN_PIXELS), np.uint8)
        counts = 1 - cv2.dilate((shown > SHOWN_MIN_OPACITY).astype(np.uint8), around).astype(np.float32)
        return replace(photograph, mask=counts if photograph.mask is None else photograph.mask * counts)
