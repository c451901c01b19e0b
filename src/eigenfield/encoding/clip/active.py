"""What frames after the first of a group are fitted to: the pixels that see a texel which any moving pixel sees.

Where all photographs of a group stand still they are the same in all frames (`rest`), and so is the solution. Texels
that still pixels alone see keep that of the first frame, and passes leave out the pixels that see no others.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.fitted.fit import PlaneSettings
from eigenfield.encoding.fitted.footprints import Footprints, masked_footprints
from eigenfield.encoding.fitted.kernels import adjoint, forward
from eigenfield.encoding.fitted.model import PlaneModel
from eigenfield.encoding.fitted.observations import FitData
from eigenfield.encoding.fitted.passes import PLUS
from eigenfield.encoding.fitted.solve import Scales
from eigenfield.runtime.parallel import parallel_map

MIN_SHARE = 1e-4  # of a pixel in a texel that it sees: the filter's weights come near to zero at whole texels
ALL_COUNT = np.zeros((0, 0), np.uint8)


@dataclass(frozen=True, eq=False)
class ActivePlane:
    """The part of a plane that changes within a group.

    Attributes:
        footprints: Without the pixels that see no texel that changes.
        mean: (rows, columns) bool, the texels of the mean that change.
        coarse: (h, w) bool, likewise of the components.
    """

    footprints: Footprints
    mean: NDArray[np.bool_]
    coarse: NDArray[np.bool_]

    @property
    def nbytes(self) -> int:
        """Of its scratch files."""
        return self.footprints.nbytes

    def data(self, whole: FitData) -> FitData:
        """The same photographs without the pixels that are left out."""
        return replace(whole, footprints=self.footprints)

    def scales(self, whole: Scales) -> Scales:
        """The same for texels that change. Others answer for so much that no step of a fit changes them."""
        mean, coarse = np.where(self.mean, whole.mean, np.inf), np.where(self.coarse, whole.coarse, np.inf)
        return replace(whole, mean=mean.astype(np.float32), coarse=coarse.astype(np.float32))

    def put_rest(self, model: PlaneModel, mean: NDArray[np.float32], textures: NDArray[np.float32] | None) -> None:
        """Put a solution into the texels of a model that do not change."""
        model.mean = np.where(self.mean, model.mean, mean)
        for block in model.blocks:
            assert textures is not None
            block.textures = np.where(self.coarse, block.textures, textures)


Moves = Callable[[int], NDArray[np.bool_]]  # from the number of a camera to (h, w), which of its pixels move
Texels = tuple[NDArray[np.bool_], NDArray[np.bool_]]  # of the mean, and of the components, as of `ActivePlane`


def active_texels(footprints: Footprints, settings: PlaneSettings, moves: Moves) -> Texels:
    """The texels of a plane that any moving pixel sees.

    Args:
        footprints: Of all pixels that the plane is fitted to.
    """
    cameras, size = range(len(footprints)), footprints.surface.size

    def seen(grid: tuple[int, int]) -> NDArray[np.bool_]:
        texels = np.zeros((1, *grid), np.float32)
        for camera in cameras:
            adjoint(*footprints.of(camera), size, moves(camera)[None].astype(np.float32), ALL_COUNT, texels)
        return np.asarray(np.abs(texels[0]) > MIN_SHARE)

    mean, coarse = parallel_map(seen, (settings.mean, settings.grid))
    return mean, coarse


@contextlib.contextmanager
def open_active_plane(
    footprints: Footprints, changing: Texels, moves: Moves, work: Path | None
) -> Iterator[ActivePlane]:
    """The part of a plane that changes.

    Args:
        footprints: Of all pixels that the plane is fitted to, in the frames that are fitted.
        changing: `active_texels`, in any frame.
        work: Folder for scratch files.
    """
    (mean, coarse), size = changing, footprints.surface.size

    def see(camera: int) -> NDArray[np.bool_]:
        found = moves(camera)
        for texels in (mean, coarse):
            image = np.zeros((1, *found.shape), np.float32)
            forward(*footprints.of(camera), size, texels[None].astype(np.float32), PLUS, image)
            found = found | (np.abs(image[0]) > 0)
        return found

    with masked_footprints(footprints, see, work) as kept:
        yield ActivePlane(kept, mean, coarse)
