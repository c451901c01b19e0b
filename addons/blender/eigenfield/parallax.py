"""How far things shift between two neighbouring cameras, and what that promises. Nothing here needs Blender."""

import numpy as np

# As `eigenfield inspect` has them (eigenfield.encoding.verdict); a test holds both against each other
GOOD_MAX_PARALLAX_RATIO, FAIR_MAX_PARALLAX_RATIO = 0.015, 0.073  # of the longer side of a picture
MIN_OVERLAP = 0.6  # of a picture that its neighbour shows, too
MEANINGS = {
    "good": "views between the photographs come near to photographs",
    "fair": "views between the photographs are softer, and edges of near things may be wrong",
    "poor": "views between the photographs show errors",
}
FACES = (0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (3, 2, 6, 7), (0, 3, 7, 4), (1, 2, 6, 5)  # of Blender's boxes


def depth_range(boxes, frame, start):
    """(near, far): between which depths a camera sees surfaces of boxes; None where it sees none.

    Args:
        boxes: (n, 8, 3) corners in the camera's space, which looks along -z, in the order of Blender's `bound_box`.
        frame: (left, right, bottom, top) of the picture at depth 1.
        start: Depth from which the camera sees.
    """
    left, right, bottom, top = frame
    normals = np.array([(1, 0, left), (-1, 0, -right), (0, 1, bottom), (0, -1, -top), (0, 0, -1)], float)
    offsets = np.array([0, 0, 0, 0, -start], float)
    sides = boxes @ normals.T + offsets  # of each corner, 0 and more within a side of what is seen
    depths = -boxes[:, :, 2]
    whole = (sides >= 0).all(axis=(1, 2))
    near, far = depths[whole].min(initial=np.inf), depths[whole].max(initial=-np.inf)
    for index in np.flatnonzero(~whole & ~(sides < 0).all(axis=1).any(axis=1)):  # seen in part
        if near <= max(depths[index].min(), start) and depths[index].max() <= far:
            continue
        for face in FACES:
            seen = [-point[2] for point in _clipped(boxes[index][list(face)], normals, offsets)]
            near, far = min([near, *seen]), max([far, *seen])
    return (float(near), float(far)) if near <= far else None


def _clipped(polygon, normals, offsets):
    """The corners of what is left of a polygon within planes (Sutherland and Hodgman 1974)."""
    points = list(polygon)
    for normal, offset in zip(normals, offsets, strict=True):
        kept = []
        for this, other in zip(points, points[1:] + points[:1], strict=True):
            here, there = normal @ this + offset, normal @ other + offset
            if here >= 0:
                kept.append(this)
            if (here >= 0) != (there >= 0):
                kept.append(this + (other - this) * (here / (here - there)))
        points = kept
    return points


def parallax_pixels(spacing, focal, near, far):
    """By which a thing at depth `near` shifts against one at depth `far` from a camera to the next.

    Args:
        spacing: Of the cameras, in the unit of the depths.
        focal: In pixels.
        near: Depth.
        far: Depth.
    """
    return spacing * focal * (1 / near - 1 / far)


def overlap_part(spacing, focal, near, far, sides, plane=None):
    """Part of a picture that its neighbours show too, at the depth between near and far; below 0 it is a gap.

    Args:
        spacing: As of `parallax_pixels`.
        focal: Likewise.
        near: Likewise.
        far: Likewise.
        sides: Of the picture in pixels, along which there are neighbours.
        plane: Depth of what stays in place; None: the cameras are parallel.
    """
    shift = spacing * focal * abs((1 / near + 1 / far) / 2 - (0 if plane is None else 1 / plane))
    return 1 - shift / min(sides)


def word_of(ratio, overlap):
    """One of `MEANINGS`.

    Args:
        ratio: Of the parallax to the longer side of a picture.
        overlap: Of `overlap_part`.
    """
    if overlap < MIN_OVERLAP or ratio > FAIR_MAX_PARALLAX_RATIO:
        return "poor"
    return "good" if ratio <= GOOD_MAX_PARALLAX_RATIO else "fair"


def good_factor(ratio, overlap):
    """By which a spacing may be longer, so that its word is good still; infinite where nothing shifts.

    Args:
        ratio: As of `word_of`.
        overlap: Likewise.
    """
    limits = (GOOD_MAX_PARALLAX_RATIO, ratio), (1 - MIN_OVERLAP, 1 - overlap)
    return min(most / shown if shown > 0 else np.inf for most, shown in limits)
