"""One texture map for each observation (the paper's section 3.2)."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.observations import Observations
from eigenfield.core.progress import Progress
from eigenfield.encoding.atlas import Atlas
from eigenfield.encoding.options import DEFAULT_MAX_ANGLE
from eigenfield.encoding.projected import kernels
from eigenfield.imaging.raster import rasterise_view
from eigenfield.runtime.files import scratch_array
from eigenfield.runtime.parallel import tracked_map

RESAMPLING = "bicubic"  # from photograph to atlas, as the settings of a scene name it (Catmull-Rom)
DEPTH_BIAS_RATIO = 2e-3  # of a view's range of inverse depths


@dataclass(frozen=True, eq=False)
class TextureMaps:
    """What every observation shows of the atlas's chart texels, before filling. The paper has one for each camera c.

    Attributes:
        atlas: The atlas of n chart texels.
        values: (No, n, C) float32, T(c); zero where not seen.
        seen: (No, n) uint8, v(c): 1 where the texel is seen.
    """

    atlas: Atlas
    values: NDArray[np.float32]
    seen: NDArray[np.uint8]

    @property
    def count(self) -> int:
        """No, the number of maps, one for each observation."""
        return int(self.values.shape[0])

    @property
    def channels(self) -> int:
        """C, of each map."""
        return int(self.values.shape[2])


def texture_map(
    atlas: Atlas,
    camera: Camera,
    pixels: NDArray[np.float32],
    mask: NDArray[np.float32] | None = None,
    max_angle: int = DEFAULT_MAX_ANGLE,
) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    """Project one photograph into the atlas, by a bicubic filter that is stretched where the photograph is denser.

    Args:
        pixels: (H, W, C) float32.
        mask: (H, W) 0..1; what it hides is not seen.

    Returns:
        (n, C) float32 values, which may overshoot the photograph's range, and (n,) uint8
        visibility.
    """
    depth = rasterise_view(atlas.mesh, camera).inverse_depth
    covered = depth[depth > 0]
    bias = DEPTH_BIAS_RATIO * float(np.ptp(covered)) + 1e-6 * float(covered.max()) if len(covered) else 0.0
    grazing = round(math.cos(math.radians(max_angle)), 4)
    values = np.empty((atlas.count, pixels.shape[2]), np.float32)
    seen = np.empty(atlas.count, np.uint8)
    kernels.project_texels(
        atlas.position, atlas.face, atlas.normal, atlas.along, atlas.down, camera.matrix, camera.centre,
        np.ascontiguousarray(pixels), np.zeros((0, 0), np.float32) if mask is None else np.ascontiguousarray(mask),
        depth, bias, grazing, values, seen,
    )  # fmt: skip
    return values, seen


@contextlib.contextmanager
def texture_maps(
    atlas: Atlas,
    cameras: Sequence[Camera],
    observations: Observations,
    channels: int = 3,
    *,
    max_angle: int = DEFAULT_MAX_ANGLE,
    maps: Iterable[tuple[NDArray[np.float32], NDArray[np.uint8]]] | None = None,
    work: Path | None = None,
    progress: Progress | None = None,
) -> Iterator[TextureMaps]:
    """The texture maps of all observations, in a memory-mapped scratch file that lives as long as the block.

    Memory does not grow with their number: as many photographs and maps as there are threads are held.

    Args:
        atlas: Of the mesh that is seen at all times.
        observations: Each is decoded once, from several threads.
        maps: The maps in order, where something else makes them (`maps_on_workers`).
    """
    total = len(observations)
    with (
        scratch_array((total, atlas.count, channels), np.float32, work) as values,
        scratch_array((total, atlas.count), np.uint8, work) as seen,
    ):

        def project(index: int) -> None:
            photograph, camera = observations.photograph(index), cameras[observations.camera_of(index)]
            values[index], seen[index] = texture_map(atlas, camera, photograph.pixels, photograph.mask, max_angle)

        if maps is None:
            tracked_map(project, range(total), "texture maps", progress)
        else:
            for index, (row, shown) in enumerate(maps):
                values[index], seen[index] = row, shown
        yield TextureMaps(atlas, values, seen)
