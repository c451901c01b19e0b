"""A layered relief: depth maps seen from one camera as a mesh, each layer laid out in the atlas as that camera sees it.

The first layer is one chart. The second, which lies behind it and exists only near its cuts, is divided into pieces
that fill their boxes, and packed round and into the first. One pixel of the canvas takes the same number of texels
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
from eigenfield.proxy.atlas.unwrap import DEFAULT_TRIANGLES
from eigenfield.proxy.relief.backdrop import backdrop
from eigenfield.proxy.relief.packing import packed_layers
from eigenfield.proxy.relief.sheet import joined, make_sheet, sheet_mesh, used_part
from eigenfield.stereo import ReferenceView

SECOND_SHARE = 0.3  # of the triangles that the second layer may take
BACKDROP_SHARE = 0.05  # likewise, the backdrop
GAP = 0.25  # of a cut: how far behind the layers it stays
SECOND_TOLERANCE = 2.5  # times coarser than the first: it is seen by few views
GUTTER = 4.0  # canvas pixels between charts: six texels at density 1.5


def relief_mesh(
    canvas: ReferenceView,
    d: NDArray[np.float32],
    valid: NDArray[np.bool_],
    second: tuple[NDArray[np.float32], NDArray[np.bool_]] | None = None,
    *,
    cut: float,
    tolerance: float,
    triangles: int | None = None,
    gutter: float = GUTTER,
    cameras: Sequence[Camera] = (),
    progress: Progress | None = None,
) -> Mesh:
    """The mesh of a depth map, and of a second one behind it, with an atlas.

    d, valid: (h, w) labels on the canvas (larger is nearer) and where there is surface. second: the same for the layer
    behind. cut: the surface is slit where neighbouring pixels of the first layer differ by more than this; the second
    has no cuts. tolerance: in d, how far the mesh may be from the depth map, except within a pixel of a cut; a second
    layer is allowed SECOND_TOLERANCE times as much. triangles: at most this many (None: DEFAULT_TRIANGLES), at the
    cost of the tolerance. gutter: free canvas pixels between charts. cameras: what they see past both layers is closed
    by a backdrop (`relief_backdrop`).

    Faces are counter-clockwise seen from the reference camera. Raises ProxyError `relief-empty`.
    """
    limit = DEFAULT_TRIANGLES if triangles is None else triangles
    spare = int(BACKDROP_SHARE * limit) if cameras else 0
    limit -= spare
    others = []
    if second is not None and second[1].any():
        behind = make_sheet(
            second[0],
            second[1],
            cut=float("inf"),
            tolerance=SECOND_TOLERANCE * tolerance,
            limit=int(SECOND_SHARE * limit),
        )
        others = [behind] if len(behind.faces) else []
    front = make_sheet(d, valid, cut=cut, tolerance=tolerance, limit=limit - sum(len(s.faces) for s in others))
    if len(front.faces) == 0:
        raise ProxyError(
            "relief-empty", "the depth map has no surface", remedy="widen the depth range, or look at the masks"
        )
    far = (
        backdrop(canvas, [front, *others], cameras, gap=GAP * cut, limit=spare, progress=progress) if cameras else None
    )
    if far is not None:
        others.append(far)
    parts, places, side = packed_layers(used_part(front), others, gutter)
    uv = np.concatenate([(np.stack([p.x, p.y], axis=1) + place) / side for p, place in zip(parts, places, strict=True)])
    mesh = sheet_mesh(canvas, joined(parts))
    return replace(mesh, uv=np.clip(uv, 0, 1).astype(np.float32))
