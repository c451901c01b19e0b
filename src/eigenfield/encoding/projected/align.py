"""Optical-flow alignment of the texture maps to a reference (the paper's section 3.3: the reference camera's map).

Geometry and calibration are never exact, so one point of the surface lands on slightly different texels from map to
map. Each map is warped so that it matches the reference.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.progress import Progress
from eigenfield.encoding.atlas import Atlas
from eigenfield.encoding.projected.project import TextureMaps
from eigenfield.runtime.parallel import tracked_map


def _flow(reference: NDArray[np.uint8], moving: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Dense inverse search (Kroeger et al., ECCV 2016)."""
    cv2.setNumThreads(0)  # serial: its stripes, and so its result, follow the number of threads
    method = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    flow = np.zeros((*reference.shape, 2), np.float32)
    return np.asarray(method.calc(reference, moving, flow), np.float32)


def align_map(
    atlas: Atlas,
    values: NDArray[np.float32],
    seen: NDArray[np.uint8],
    reference: NDArray[np.float32],
    reference_seen: NDArray[np.uint8],
) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    """Warp one map onto the reference.

    Where only one of the two shows a texel it lends the other its value for finding the flow, so the flow is 0 there. A
    warped texel counts as seen if all texels it is interpolated from are.

    Args:
        values: (n, C) of the map.
        seen: (n,) where the map has values.
        reference: (n, C) of the reference.
        reference_seen: (n,) where the reference has values.

    Returns:
        Values and visibility, warped.
    """
    flow = _flow(
        _grey(atlas, np.where(reference_seen[:, None] > 0, reference, values), seen | reference_seen),
        _grey(atlas, np.where(seen[:, None] > 0, values, reference), seen | reference_seen),
    )
    row, column = np.divmod(atlas.texel, atlas.width)
    moved = flow.reshape(-1, 2)[atlas.texel]
    x, y = (column + moved[:, 0]).astype(np.float32), (row + moved[:, 1]).astype(np.float32)
    visible = atlas.image(seen[:, None].astype(np.float32))
    sharp = atlas.image(values)
    whole = _remap(visible, x, y, cv2.INTER_LINEAR)[:, 0] > 0.999
    warped = _remap(sharp, x, y, cv2.INTER_CUBIC)
    plain = _remap(sharp, x, y, cv2.INTER_LINEAR)
    eroded = np.asarray(cv2.erode(visible, np.ones((3, 3), np.uint8)), np.float32)[..., None]
    inner = _remap(eroded, x, y, cv2.INTER_LINEAR)[:, 0] > 0.999
    result = np.where(inner[:, None], warped, plain) * whole[:, None]  # cubic taps must not reach unseen texels
    return result.astype(np.float32), whole.astype(np.uint8)


def align_maps(maps: TextureMaps, reference: int, progress: Progress | None = None) -> None:
    """Align all maps in place to one of them.

    The mean must be taken again afterwards (equation 1): it changes the fill of every map (equation 2).

    Args:
        reference: Index of the map that stays.
    """
    fixed, fixed_seen = np.array(maps.values[reference]), np.array(maps.seen[reference])

    def align(index: int) -> None:
        if index != reference:
            maps.values[index], maps.seen[index] = align_map(
                maps.atlas, maps.values[index], maps.seen[index], fixed, fixed_seen
            )

    tracked_map(align, range(maps.count), "alignment", progress)


def _grey(atlas: Atlas, values: NDArray[np.float32], known: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The channels' mean as 8 bits, mid-grey where nothing is known."""
    level = np.where(known > 0, values.mean(axis=1) * 255, 128)
    return atlas.image(np.clip(np.rint(level), 0, 255).astype(np.float32)[:, None], 128)[..., 0].astype(np.uint8)


def _remap(
    picture: NDArray[np.float32], x: NDArray[np.float32], y: NDArray[np.float32], how: int
) -> NDArray[np.float32]:
    """(n, C) samples of an (H, W, C) picture at n positions; OpenCV takes them as a picture of short rows."""
    width = 1024
    short = -len(x) % width
    grid_x, grid_y = (np.pad(a, (0, short)).reshape(-1, width) for a in (x, y))
    channels = [cv2.remap(picture[..., c], grid_x, grid_y, how).reshape(-1)[: len(x)] for c in range(picture.shape[2])]
    return np.stack(channels, axis=1)
