"""The peer that draws from photographs and a proxy: unstructured lumigraph rendering (Buehler et al., SIGGRAPH 2001).

The proxy is ours; blending weights are taken at every pixel, not at the vertices of a triangulation; what a photograph
does not see is told by depth maps. Without the penalty for differing resolution: an array's cameras stand abreast.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.encoding.projected.project import DEPTH_BIAS_RATIO
from eigenfield.encoding.spread import push_pull
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.raster import rasterise_view
from eigenfield.runtime.parallel import parallel_map, pieces
from evidence.lumigraph_kernels import blend_views

BLENDED = 4  # photographs a pixel
FEATHER = 1 / 32  # of the frame's shorter side: where a photograph fades towards its border
ROWS = 16  # a thread draws at a time


@dataclass(frozen=True, eq=False)
class Lumigraph:
    """Photographs, ready to be blended on a proxy.

    centres (n, 3), matrices (n, 3, 4), sizes (n, 2) int64 width and height, starts (n,) int64: first pixel of each.
    codes: (3 * all pixels,) uint8. depths: (all pixels,) float32, the proxy's inverse depth in each photograph,
        infinite where a mask hides it. biases: (n,) by which an inverse depth may be the smaller and still be seen.
    """

    mesh: Mesh
    centres: NDArray[np.float64]
    matrices: NDArray[np.float64]
    sizes: NDArray[np.int64]
    starts: NDArray[np.int64]
    codes: NDArray[np.uint8]
    depths: NDArray[np.float32]
    biases: NDArray[np.float64]

    def photograph(self, index: int) -> NDArray[np.uint8]:
        """(H, W, 3) the photograph at `index` as it is blended."""
        width, height = self.sizes[index]
        start = self.starts[index]
        return self.codes[3 * start : 3 * (start + width * height)].reshape(height, width, 3)

    def of(self, pictures: Sequence[NDArray[np.uint8]]) -> Lumigraph:
        """The same cameras with other pictures, of the same sizes, in place of the photographs."""
        assert [picture.shape[:2] for picture in pictures] == [(height, width) for width, height in self.sizes]
        return replace(self, codes=np.concatenate([picture.reshape(-1) for picture in pictures]))


def make_lumigraph(
    mesh: Mesh,
    cameras: Sequence[Camera],
    photograph: Callable[[int], tuple[NDArray[np.float32], NDArray[np.float32] | None]],
) -> Lumigraph:
    """Decode the photographs and draw the proxy's depth from each camera.

    photograph: index into `cameras` to pixels (H, W, 3), 0..1, and mask (H, W) or None.
    """
    sizes = np.array([(camera.width, camera.height) for camera in cameras], np.int64)
    ends = np.cumsum(sizes.prod(axis=1))
    starts = np.concatenate([[0], ends[:-1]]).astype(np.int64)
    codes, depths = np.empty(3 * ends[-1], np.uint8), np.empty(ends[-1], np.float32)
    biases = np.zeros(len(cameras))

    def prepare(index: int) -> None:
        pixels, mask = photograph(index)
        depth = rasterise_view(mesh, cameras[index]).inverse_depth
        seen = depth[depth > 0]
        if len(seen):
            biases[index] = DEPTH_BIAS_RATIO * float(np.ptp(seen)) + 1e-6 * float(seen.max())
        if mask is not None:
            depth = np.where(mask > 0.5, depth, np.float32(np.inf))
        codes[3 * starts[index] : 3 * ends[index]] = to_codes(pixels).reshape(-1)
        depths[starts[index] : ends[index]] = depth.reshape(-1)

    parallel_map(prepare, range(len(cameras)))
    return Lumigraph(
        mesh,
        np.array([camera.centre for camera in cameras]),
        np.array([camera.matrix for camera in cameras]),
        sizes,
        starts,
        codes,
        depths,
        biases,
    )


def draw_lumigraph(
    lumigraph: Lumigraph, camera: Camera
) -> tuple[NDArray[np.float32], NDArray[np.bool_], NDArray[np.bool_]]:
    """The view of `camera`: (H, W, 3) float32, 0..1, black off the proxy; (H, W) where the proxy puts surface; (H, W)
    where none of the photographs sees that surface: there the picture is filled smoothly from round about."""
    depth = rasterise_view(lumigraph.mesh, camera).inverse_depth
    rays = np.ascontiguousarray(camera.R.T @ np.linalg.inv(camera.K))
    image = np.empty((camera.height, camera.width, 3), np.float32)
    found = np.empty((camera.height, camera.width), np.uint8)
    parallel_map(
        lambda rows: blend_views(
            *rows, rays, camera.centre, depth, lumigraph.matrices, lumigraph.centres, lumigraph.sizes, lumigraph.starts,
            lumigraph.codes, lumigraph.depths, lumigraph.biases, BLENDED, FEATHER, image, found,
        ),
        pieces(camera.height, ROWS),
    )  # fmt: skip
    surface = depth > 0
    holes = surface & (found == 0)
    if holes.any() and found.any():
        filled = push_pull(image, (found > 0).astype(np.float32))
        image[holes] = filled[holes]
    return image, surface, holes
