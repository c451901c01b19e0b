"""The demo's light: a room with two windows and lamps, for the highlights and for soft diffuse shading.

The radiance in a direction is a sum of soft boxes over a dim room. A glossy surface reflects it as an octahedral
picture, blurred to the width of the reflection lobe.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RegularGridInterpolator

from eigenfield.demo.geometry import CHROME_SPHERE, GLASS_SPHERE, Array
from eigenfield.demo.rays import GLASS_INDEX

LIGHT_OCTAHEDRON_TEXELS = 256  # side of the environment's pictures


class SoftBox(NamedTuple):
    """A rectangular light with soft edges.

    Attributes:
        direction: From the scene.
        half: Half-widths in degrees, sideways and upwards.
        radiance: RGB.
        irradiance: RGB on a surface that faces it.
    """

    direction: tuple[float, float, float]
    half: tuple[float, float]
    radiance: tuple[float, float, float]
    irradiance: tuple[float, float, float]


SOFT_BOXES = (
    SoftBox((-0.62, 0.62, 0.52), (5.0, 8.0), (38.0, 35.0, 31.0), (1.02, 0.92, 0.76)),  # the key: a window on the left
    SoftBox((-0.38, 0.70, 0.62), (5.0, 8.0), (30.0, 28.0, 25.0), (0.42, 0.38, 0.32)),  # its other half
    SoftBox((0.86, 0.34, 0.38), (4.0, 13.0), (9.0, 11.0, 14.0), (0.15, 0.20, 0.28)),  # a door on the right
    SoftBox((0.30, 0.45, 0.84), (3.5, 3.5), (20.0, 14.5, 9.0), (0.0, 0.0, 0.0)),  # a lamp behind the cameras
    SoftBox((0.10, 0.20, -0.97), (16.0, 6.0), (1.2, 1.15, 1.1), (0.0, 0.0, 0.0)),  # the wall's sheen at grazing angles
    # dark posts and rails: the gantry that carries the cameras
    *(SoftBox((x, 0.29, 0.93), (0.9, 19.0), (-0.2, -0.2, -0.2), (0.0, 0.0, 0.0)) for x in (-0.30, 0.30)),
    *(SoftBox((0.0, y, 0.93), (17.5, 0.9), (-0.2, -0.2, -0.2), (0.0, 0.0, 0.0)) for y in (-0.03, 0.62)),
)
CEILING_TANGENT = 0.62  # the ceiling's edge above the horizon, seen square to a wall
LIGHT_KEY_COUNT = 2  # these first lights shine through a window frame, which casts a shadow on the scene
WINDOW_CENTRE_UNITS, WINDOW_HALF_SIZE_UNITS, WINDOW_BLUR_UNITS = (0.42, 0.62), (1.15, 1.02), 0.13
WINDOW_BAR_OFFSETS_UNITS, WINDOW_BAR_HALF_WIDTH_UNITS = (-0.74, 0.58), 0.035
WINDOW_SHADE_FRACTION = 0.25  # of the key light, outside the frame
SHADOW_SOFTNESS_TANGENT = 0.16  # of the key light's half-width
SHADOW_SPHERES = {  # spheres (centre, radius) that stand for the parts
    "body": (((0.0, 0.16, 0.0), 0.34), ((0.0, 0.45, 0.0), 0.47), ((0.0, 0.68, 0.0), 0.51), ((0.0, 0.95, 0.0), 0.36)),
    "lid": (((0.0, 1.12, 0.0), 0.31), ((0.0, 1.35, 0.0), 0.085)),
    "orange": (((-0.735, 0.205, 0.42), 0.205),),
    "marble": (((0.36, 0.125, 0.80), 0.125),),
    "block": (((0.80, 0.14, 0.28), 0.19), ((0.80, 0.26, 0.28), 0.18), ((0.88, 0.13, 0.17), 0.14),
              ((0.72, 0.13, 0.39), 0.14)),
    "chrome": ((tuple(CHROME_SPHERE[0]), CHROME_SPHERE[1]),), "glass": ((tuple(GLASS_SPHERE[0]), GLASS_SPHERE[1]),),
}  # fmt: skip
Spheres = tuple[tuple[tuple[float, float, float], float], ...]
GLASS_DARKNESS_FRACTION = 0.3  # of the ambient light that it keeps off, to that of a solid ball
CAUSTIC_RAYS = 60_000
SHEET_AMBIENT_FRACTION = 0.65  # that a sheet right before a wall keeps off it


class Shadows(NamedTuple):
    """What casts shadows.

    Attributes:
        spheres: That stand for each part.
        before_wall: The share of a light from a direction (3,) that comes to points (n, 3) of the wall past what hangs
            before it; None: nothing does.
    """

    spheres: Mapping[str, Spheres]
    before_wall: Callable[[Array, Array], Array] | None = None


STILL_SHADOWS = Shadows(SHADOW_SPHERES)


def radiance(directions: Array, softness: float, lights: Sequence[SoftBox] = SOFT_BOXES) -> Array:
    """(n, 3) RGB radiance, with the edges of lights and of the room blurred.

    Args:
        directions: (n, 3) unit vectors.
        softness: Degrees.
        lights: In the room.
    """
    x, y, z = directions.T
    blur = np.sin(np.radians(softness))
    level = 1 / (1 + np.exp(-y / np.sin(np.radians(softness + 6))))
    floor, room = np.array([0.10, 0.075, 0.055]), np.array([0.30, 0.29, 0.28])
    total = floor + (room * (0.55 + 0.45 * y[:, None]) - floor) * level[:, None]
    ceiling = _soft_step(y - CEILING_TANGENT * np.maximum(np.abs(x), z), blur)
    side = _soft_step(np.abs(x) - z, blur)
    total *= (1 + 0.9 * ceiling - 0.3 * side * (1 - ceiling))[:, None]
    total += 0.10 * np.maximum(z, 0)[:, None] * (1.0, 0.96, 0.9)
    for light in lights:
        axis = _unit(np.array(light.direction))
        side = _unit(np.cross((0.0, 1.0, 0.0), axis))
        up = np.cross(axis, side)
        ahead = directions @ axis
        across = np.degrees(np.arctan2(directions @ side, np.maximum(ahead, 1e-6)))
        above = np.degrees(np.arctan2(directions @ up, np.maximum(ahead, 1e-6)))
        area = light.half[0] * light.half[1]
        wide = [half + softness / 2 for half in light.half]
        inside = (
            _soft_interval(across, wide[0], softness / 2) * _soft_interval(above, wide[1], softness / 2) * (ahead > 0)
        )
        total += inside[:, None] * np.array(light.radiance) * area / (wide[0] * wide[1])
    return np.maximum(total, 0.02)


def _soft_step(value: Array, width: float) -> Array:
    return np.asarray(0.5 + 0.5 * np.tanh(value / width))


def _soft_interval(angle: Array, half: float, softness: float) -> Array:
    """1 within `half` of 0, falling to 0 over about `softness` on each side."""
    return np.asarray(1 / (1 + np.exp(np.clip((np.abs(angle) - half) / (softness / 2), -50, 50))))


def environment_map(lights: Sequence[SoftBox] = SOFT_BOXES) -> NDArray[np.float32]:
    """(3, e, e, 3): the room over the octahedron, sharp, and through lobes of about 4 and 22 degrees."""
    t = np.linspace(-1, 1, LIGHT_OCTAHEDRON_TEXELS)
    z, x = np.meshgrid(t, t, indexing="ij")
    y = 1 - np.abs(x) - np.abs(z)
    folded_x = np.where(y < 0, (1 - np.abs(z)) * np.where(x >= 0, 1, -1), x)
    folded_z = np.where(y < 0, (1 - np.abs(x)) * np.where(z >= 0, 1, -1), z)
    directions = np.stack([folded_x, y, folded_z], axis=-1).reshape(-1, 3)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    layers = [
        radiance(directions, softness, lights).reshape(LIGHT_OCTAHEDRON_TEXELS, LIGHT_OCTAHEDRON_TEXELS, 3)
        for softness in (0.8, 4.0, 22.0)
    ]
    return np.stack(layers).astype(np.float32)


def irradiance(points: Array, normals: Array, owner: str, shadows: Shadows = STILL_SHADOWS) -> tuple[Array, Array]:
    """Light on a surface.

    Args:
        points: (n, 3).
        normals: (n, 3).
        owner: The surface's part, which casts no shadow on itself.
        shadows: Of all parts.

    Returns:
        (n, 3) RGB irradiance, and (n,) ambient visibility, 0..1.
    """
    ambient = np.ones(len(points))
    visible = [np.ones(len(points)) for _ in SOFT_BOXES]
    others = [part for part in shadows.spheres if part != owner and (part, owner) != ("body", "lid")]
    for name, (centre, radius) in ((part, sphere) for part in others for sphere in shadows.spheres[part]):
        offset = np.array(centre) - points
        square = dot_rows(offset, offset)
        toward = dot_rows(offset, normals) / np.sqrt(square)
        dark = GLASS_DARKNESS_FRACTION if name == "glass" else 1.0
        ambient *= 1 - 0.62 * dark * np.clip(toward * 0.8 + 0.2, 0, 1) * np.minimum(radius**2 / square, 1)
        for light, fraction in zip(SOFT_BOXES, visible, strict=True):
            if sum(light.irradiance) > 0:
                along = offset @ _unit(np.array(light.direction))
                miss = np.sqrt(np.maximum(square - along**2, 0))
                through = _focused_light()(np.column_stack([along, miss]) / radius) if name == "glass" else 0.0
                fraction *= _sphere_shadow(along, miss, radius) + through
    before = shadows.before_wall if owner == "wall" else None
    if before is not None:
        ambient *= 1 - SHEET_AMBIENT_FRACTION * (1 - before(points, np.array([0.0, 0.0, 1.0])))
    total = np.array([0.235, 0.245, 0.27]) * (0.72 + 0.28 * normals[:, 1:2]) * ambient[:, None]
    total = total + np.array([0.08, 0.06, 0.045]) * (0.5 - 0.5 * normals[:, 1:2]) * ambient[:, None]
    for k, (light, fraction) in enumerate(zip(SOFT_BOXES, visible, strict=True)):
        if sum(light.irradiance) == 0:
            continue
        if k < LIGHT_KEY_COUNT:
            fraction *= _window_shadow(points)
        if before is not None:
            fraction *= before(points, _unit(np.array(light.direction)))
        facing = np.maximum(normals @ _unit(np.array(light.direction)), 0)
        total = total + (facing * fraction)[:, None] * np.array(light.irradiance)
    return total, ambient


def _window_shadow(points: Array) -> Array:
    """The fraction of the key light that the window frame lets through: two panes with blurred edges."""
    key = _unit(np.array(SOFT_BOXES[0].direction))
    side = _unit(np.cross((0.0, 1.0, 0.0), key))
    a, b = points @ side - WINDOW_CENTRE_UNITS[0], points @ np.cross(key, side) - WINDOW_CENTRE_UNITS[1]
    panes = _smooth_step(WINDOW_HALF_SIZE_UNITS[0] - np.abs(a)) * _smooth_step(WINDOW_HALF_SIZE_UNITS[1] - np.abs(b))
    for bar in WINDOW_BAR_OFFSETS_UNITS:
        panes *= 1 - _smooth_step(WINDOW_BAR_HALF_WIDTH_UNITS - np.abs(a - bar))
    return np.asarray(WINDOW_SHADE_FRACTION + (1 - WINDOW_SHADE_FRACTION) * panes)


def _smooth_step(distance: Array) -> Array:
    t = np.clip(0.5 + distance / WINDOW_BLUR_UNITS, 0, 1)
    return np.asarray(t * t * (3 - 2 * t))


def _sphere_shadow(along: Array, miss: Array, radius: float) -> Array:
    """The fraction of a soft light that passes a sphere: smooth in clearance over distance."""
    clearance = (miss - radius) / np.maximum(along, 1e-3)
    fraction = np.clip(0.5 + clearance / (2 * SHADOW_SOFTNESS_TANGENT), 0, 1)
    return np.where(along > 0, fraction * fraction * (3 - 2 * fraction), 1.0)


@cache
def _focused_light() -> RegularGridInterpolator:
    """Light that a glass sphere focuses, over that of the lamp: a function of how far a point is behind the sphere's
    centre and from its axis, in radii. Rays that fill the sphere evenly are counted in rings around the axis."""
    index = np.arange(CAUSTIC_RAYS)
    turn = 2 * np.pi * index * (np.sqrt(5) - 1) / 2  # the golden angle: a sunflower's seeds
    offset = np.sqrt((index + 0.5) / CAUSTIC_RAYS)
    incident = np.arcsin(offset)
    refracted = np.arcsin(offset / GLASS_INDEX)
    bend = incident - refracted  # at each surface
    leaves = 2 * np.cos(refracted) * np.cos(bend) - np.cos(incident), offset - 2 * np.cos(refracted) * np.sin(bend)
    passed = np.cos(incident) ** 0.2  # about what Fresnel's reflections at both surfaces leave
    lamp = np.sqrt(index * np.sqrt(2) % 1)[:, None] * _circle(2 * np.pi * (index * np.sqrt(3) % 1))
    behind, rings = np.linspace(0, 6, 40), np.linspace(0, 3, 61)
    table = np.empty((len(behind), len(rings) - 1))
    for row, depth in zip(table, behind, strict=True):
        height = leaves[1] - np.maximum(depth - leaves[0], 0) * np.tan(2 * bend)
        place = height[:, None] * _circle(turn) + depth * SHADOW_SOFTNESS_TANGENT * lamp
        row[:] = np.histogram(np.hypot(*place.T), rings, weights=passed)[0] / CAUSTIC_RAYS / np.diff(rings**2)
    return RegularGridInterpolator((behind, rings[:-1]), table, bounds_error=False, fill_value=0.0)


def _circle(angle: Array) -> Array:
    return np.column_stack([np.cos(angle), np.sin(angle)])


def dot_rows(a: Array, b: Array) -> Array:
    """(n,) inner products of rows; by columns, several times as fast as a sum over an axis of three.

    Args:
        a: (n, 3).
        b: (n, 3).
    """
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2])


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))
