"""A layered relief: depth maps seen from one camera as a mesh, each layer laid out in the atlas as that camera sees it.

The first layer is one chart. The second, which lies behind it and exists only near its cuts, is divided into pieces
that fill their boxes, and packed round and into the first. One pixel of the canvas takes the same number of texels
everywhere.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.errors import ProxyError
from eigenfield.mesh import Mesh
from eigenfield.proxy.relief_packing import packed_layers
from eigenfield.proxy.relief_sheet import make_sheet, used_part
from eigenfield.proxy.unwrap import DEFAULT_TRIANGLES
from eigenfield.stereo import Canvas

SECOND_SHARE = 0.3  # of the triangles that the second layer may take
SECOND_TOLERANCE = 2.5  # times coarser than the first: it is seen by few views
GUTTER = 4.0  # canvas pixels between charts: six texels at density 1.5
FARTHEST = 1e-4  # of the nearest inverse depth: nothing is put farther away


def relief_mesh(
    canvas: Canvas,
    d: NDArray[np.float32],
    valid: NDArray[np.bool_],
    second: tuple[NDArray[np.float32], NDArray[np.bool_]] | None = None,
    *,
    cut: float,
    tolerance: float,
    triangles: int | None = None,
    gutter: float = GUTTER,
) -> Mesh:
    """The mesh of a depth map, and of a second one behind it, with an atlas.

    d, valid: (h, w) labels on the canvas (larger is nearer) and where there is surface. second: the same for the layer
    behind. cut: the surface is slit where neighbouring pixels of the first layer differ by more than this; the second
    has no cuts. tolerance: in d, how far the mesh may be from the depth map, except within a pixel of a cut; a second
    layer is allowed SECOND_TOLERANCE times as much. triangles: at most this many (None: DEFAULT_TRIANGLES), at the
    cost of the tolerance. gutter: free canvas pixels between charts.

    Faces are counter-clockwise seen from the reference camera. Raises ProxyError `relief-empty`.
    """
    limit = DEFAULT_TRIANGLES if triangles is None else triangles
    behind = None
    if second is not None and second[1].any():
        behind = make_sheet(
            second[0],
            second[1],
            cut=float("inf"),
            tolerance=SECOND_TOLERANCE * tolerance,
            limit=int(SECOND_SHARE * limit),
        )
        limit -= len(behind.faces)
    front = make_sheet(d, valid, cut=cut, tolerance=tolerance, limit=limit)
    if len(front.faces) == 0:
        raise ProxyError(
            "relief-empty", "the depth map has no surface", remedy="widen the depth range, or look at the masks"
        )
    parts, places, side = packed_layers(used_part(front), behind, gutter)
    uv = np.concatenate([(np.stack([p.x, p.y], axis=1) + place) / side for p, place in zip(parts, places, strict=True)])
    starts = np.cumsum([0, *(len(p.x) for p in parts[:-1])])
    faces = np.concatenate([p.faces + start for p, start in zip(parts, starts, strict=True)])
    x, y, z = (np.concatenate([getattr(p, name) for p in parts]) for name in "xyd")
    nearest = canvas.offset + canvas.scale * z.max()
    z = np.maximum(z, (FARTHEST * nearest - canvas.offset) / canvas.scale)
    return Mesh(
        canvas.points(x, y, z).astype(np.float32),
        np.ascontiguousarray(faces[:, ::-1]).astype(np.int32),  # y is down: positive area is clockwise to the camera
        np.clip(uv, 0, 1).astype(np.float32),
    )
