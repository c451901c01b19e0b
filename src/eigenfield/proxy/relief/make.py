"""A layered relief: depth maps of one camera as a mesh, each layer laid out in the atlas as that camera sees it.

The first layer is one chart. The second lies behind it and exists only near its cuts. It is divided into pieces that
fill their boxes, and packed around and into the first. One pixel of the reference view gets the same number of texels
everywhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
from eigenfield.proxy.relief.backdrop import make_backdrop
from eigenfield.proxy.relief.height_field import (
    extract_faces,
    height_field_to_world,
    join_height_fields,
    triangulate_height_field,
)
from eigenfield.proxy.relief.packing import pack_layers
from eigenfield.proxy.simplify import PROXY_DEFAULT_TRIANGLES
from eigenfield.stereo import ReferenceView

RELIEF_SECOND_LAYER_FRACTION = 0.3  # of the triangles, for the second layer at most
RELIEF_BACKDROP_FRACTION = 0.05  # of the triangles, for the backdrop
RELIEF_BACKDROP_GAP_CUTS = 0.25  # distance of the backdrop behind the layers
RELIEF_SECOND_TOLERANCE_RATIO = 2.5  # to that of the first layer: few views see the second


def relief_mesh(
    reference: ReferenceView,
    d: NDArray[np.float32],
    valid: NDArray[np.bool_],
    second: tuple[NDArray[np.float32], NDArray[np.bool_]] | None = None,
    *,
    cut: float,
    tolerance: float,
    triangles: int | None = None,
    cameras: Sequence[Camera] = (),
    progress: Progress | None = None,
) -> Mesh:
    """The mesh of a depth map, and of a second one behind it, with an atlas.

    Faces are counter-clockwise seen from the reference camera.

    Args:
        second: The same for the layer behind, which has no cuts.
        cut: The surface is cut where neighbouring pixels of the first layer differ by more than this.
        tolerance: Largest difference of the mesh from the depth map in labels, except within a pixel of a cut. The
            second layer is allowed RELIEF_SECOND_TOLERANCE_RATIO times as much.
        triangles: Most triangles, at the cost of the tolerance. Default: PROXY_DEFAULT_TRIANGLES.
        cameras: What they see past both layers is closed by a backdrop (`make_backdrop`).

    Raises:
        ProxyError: `relief-empty`: the depth map has no surface.
    """
    limit = PROXY_DEFAULT_TRIANGLES if triangles is None else triangles
    spare = int(RELIEF_BACKDROP_FRACTION * limit) if cameras else 0
    limit -= spare
    others = []
    if second is not None and second[1].any():
        loose, most = RELIEF_SECOND_TOLERANCE_RATIO * tolerance, int(RELIEF_SECOND_LAYER_FRACTION * limit)
        behind = triangulate_height_field(*second, cut=float("inf"), tolerance=loose, limit=most)
        limit -= len(behind.faces)
        others = [behind] if len(behind.faces) else []
    front = triangulate_height_field(d, valid, cut=cut, tolerance=tolerance, limit=limit)
    if len(front.faces) == 0:
        raise ProxyError(
            "relief-empty", "the depth map has no surface", remedy="widen the depth range, or look at the masks"
        )
    if cameras:
        gap = RELIEF_BACKDROP_GAP_CUTS * cut
        far = make_backdrop(reference, [front, *others], cameras, gap=gap, limit=spare, progress=progress)
        others += [] if far is None else [far]
    parts, places, side = pack_layers(extract_faces(front), others)
    uv = np.concatenate([(np.stack([p.x, p.y], axis=1) + place) / side for p, place in zip(parts, places, strict=True)])
    mesh = height_field_to_world(reference, join_height_fields(parts))
    return replace(mesh, uv=np.clip(uv, 0, 1).astype(np.float32))
