"""The clip's motions as functions of time: 0 is the first frame, and at 1 everything is as it was at 0.

An orange rolls to and fro, a marble bounces and spins, a glass ball slides, a printed sheet waves in a draught, and a
lamp goes round, which moves the highlights of all that is glossy.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from eigenfield.demo.geometry import MARBLE_SPHERE, ORANGE_SPHERE, WALL_Z_UNITS, Array
from eigenfield.demo.lettering import POSTER
from eigenfield.demo.light import SHADOW_SPHERES, SOFT_BOXES, Shadows, SoftBox

Motion = Callable[[Array, float], Array]  # of points (n, 3) at rest, and the time

ROLL_DIRECTION, ROLL_HALF_WAY_UNITS = np.array([0.8, 0.0, 0.6]), 0.17
BOUNCES, BOUNCE_HEIGHT_UNITS = 2, 0.30
GLASS_HALF_WAY_UNITS, GLASS_PHASE = 0.08, 0.3
SHEET_GAP_UNITS = 0.012  # at rest, before the wall
SHEET_BEND_RADIANS = 0.45  # at the lower edge, on average
SHEET_WAVES, SHEET_PHASE_PER_UNIT = 0.8, 1.3  # along the sheet, downwards; sideways
SHEET_NODES = 5  # of Gauss and Legendre's rule along the sheet
SHEET_SHADOW_SOFTNESS_UNITS, SHEET_SHADOW_WIDENING = 0.02, 0.35  # of its edges, and with the distance from the wall
SHEET_SHADOW_REACH_UNITS = 0.8  # on the wall, beyond the sheet
MOTION_STEP_UNITS = 1e-4  # of the differences that turn normals
LAMP = 3  # of SOFT_BOXES: it lights nothing that is baked, so that only its reflections move
LAMP_SWING = 0.45  # sideways and upwards


def moved(name: str, points: Array, time: float) -> Array:
    """(n, 3) where points of a part are at a time.

    Args:
        name: Of the part.
        points: (n, 3) at rest.
        time: From 0 to 1, which is the whole turn.
    """
    return MOTIONS[name](points, time) if name in MOTIONS else points


def moved_normals(name: str, points: Array, normals: Array, time: float) -> Array:
    """(n, 3) unit normals of a part at a time: the cofactors of the motion's derivative, times those at rest.

    Args:
        name: Of the part.
        points: (n, 3) at rest.
        normals: (n, 3) at rest.
        time: From 0 to 1.
    """
    if name not in MOTIONS:
        return normals
    step = MOTION_STEP_UNITS
    x, y, z = (
        (moved(name, points + step * axis, time) - moved(name, points - step * axis, time)) / (2 * step)
        for axis in np.eye(3)
    )
    turned = normals[:, :1] * np.cross(y, z) + normals[:, 1:2] * np.cross(z, x) + normals[:, 2:] * np.cross(x, y)
    return np.asarray(turned / np.linalg.norm(turned, axis=1, keepdims=True))


def shadows_at(time: float) -> Shadows:
    """What casts shadows at a time."""
    spheres = {}
    for name, some in SHADOW_SPHERES.items():
        centres = moved(name, np.array([centre for centre, _ in some]), time).tolist()
        spheres[name] = tuple(((x, y, z), radius) for (x, y, z), (_, radius) in zip(centres, some, strict=True))
    return Shadows(spheres, lambda points, direction: _past_the_sheet(points, direction, time))


def lights_at(time: float) -> list[SoftBox]:
    """The room's lights at a time, for `environment_map`."""
    angle = 2 * np.pi * time
    lights = list(SOFT_BOXES)
    x, y, z = lights[LAMP].direction
    lights[LAMP] = lights[LAMP]._replace(
        direction=(x + LAMP_SWING * np.sin(angle) - 0.3, y + LAMP_SWING * np.cos(angle) - 0.2, z)
    )
    return lights


def _roll(points: Array, time: float) -> Array:
    """Without slipping, along a line: what turns by way over radius is as it was when it comes back."""
    centre, radius = ORANGE_SPHERE
    way = ROLL_HALF_WAY_UNITS * np.sin(2 * np.pi * time)
    axis = np.cross((0.0, 1.0, 0.0), ROLL_DIRECTION)
    return _turned(points - centre, axis, way / radius) + centre + way * ROLL_DIRECTION


def _bounce(points: Array, time: float) -> Array:
    """Parabolas, and one turn about the vertical."""
    centre, _ = MARBLE_SPHERE
    part = BOUNCES * time % 1
    height = 4 * BOUNCE_HEIGHT_UNITS * part * (1 - part)
    up = np.array([0.0, 1.0, 0.0])
    return _turned(points - centre, up, 2 * np.pi * time) + centre + height * up


def _slide(points: Array, time: float) -> Array:
    """A ball of glass that rolls, which nobody can tell from one that slides."""
    way = GLASS_HALF_WAY_UNITS * np.sin(2 * np.pi * (time + GLASS_PHASE))
    return points + np.array([way, 0.0, 0.0])


def _wave(points: Array, time: float) -> Array:
    """The sheet, held by its upper edge: a wave of its slope runs down and grows on the way; its length stays.

    Slope at the depth s from the upper edge: b s / h (1 + sin(2 pi (k s / h - t) + c x)), which is never negative, so
    that it does not reach the wall.
    """
    x, depth = points[:, 0], POSTER.top - points[:, 1]
    nodes, weights = np.polynomial.legendre.leggauss(SHEET_NODES)
    along = depth[:, None] * (nodes + 1) / 2
    share = along / POSTER.height
    phase = 2 * np.pi * (SHEET_WAVES * share - time) + SHEET_PHASE_PER_UNIT * x[:, None]
    slope = SHEET_BEND_RADIANS * share * (1 + np.sin(phase))
    out, down = depth * (np.sin(slope) @ weights) / 2, depth * (np.cos(slope) @ weights) / 2
    return np.column_stack([x, POSTER.top - down, points[:, 2] + out])


def _past_the_sheet(points: Array, direction: Array, time: float) -> Array:
    """(n,) the share of a light that comes to points of the wall past the sheet, with edges that its distance blurs."""
    share, reach = np.ones(len(points)), SHEET_SHADOW_REACH_UNITS
    off = points[:, :2] - (POSTER.left, POSTER.top - POSTER.height)
    near = ((off > -reach) & (off < (POSTER.width + reach, POSTER.height + reach))).all(axis=1)
    x, y = points[near, :2].T
    distance = np.zeros(len(x))
    for _ in range(3):  # where the ray to the light meets the sheet
        x, y = (points[near] + distance[:, None] * direction / direction[2])[:, :2].T
        depth = np.clip(POSTER.top - y, 0, POSTER.height)
        distance = _wave(np.column_stack([x, POSTER.top - depth, np.full(len(x), SHEET_GAP_UNITS)]), time)[:, 2]
    softness = SHEET_SHADOW_SOFTNESS_UNITS + SHEET_SHADOW_WIDENING * distance
    sides = np.minimum(x - POSTER.left, POSTER.left + POSTER.width - x)
    ends = np.minimum(POSTER.top - y, y - (POSTER.top - POSTER.height))
    across, along = (np.clip(0.5 + edge / softness, 0, 1) for edge in (sides, ends))
    share[near] = 1 - (across * across * (3 - 2 * across)) * (along * along * (3 - 2 * along))
    return share


def _turned(points: Array, axis: Array, angle: float) -> Array:
    """Points turned about a unit axis through the origin (Rodrigues)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.asarray(
        cosine * points + sine * np.cross(axis, points) + (1 - cosine) * (points @ axis)[:, None] * axis[None]
    )


SHEET_PLANE_Z_UNITS = WALL_Z_UNITS + SHEET_GAP_UNITS
MOTIONS: dict[str, Motion] = {"orange": _roll, "marble": _bounce, "glass": _slide, "sheet": _wave}
