"""The demo's light: a room with two windows and lamps, for the highlights and for the diffuse part, with soft shadows.

Radiance on a direction d is a sum of soft boxes round their axes over a dim room. A gloss reflects it as an octahedral
picture that is smooth on the scale of the lobe.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

OCTAHEDRON = 256  # side of the pictures of the environment


class Light(NamedTuple):
    """A soft box: direction, half-widths in degrees (to the side, upwards), radiance, and the irradiance that a
    surface facing it gets (both RGB)."""

    direction: tuple[float, float, float]
    half: tuple[float, float]
    radiance: tuple[float, float, float]
    irradiance: tuple[float, float, float]


LIGHTS = (
    Light((-0.62, 0.62, 0.52), (5.0, 8.0), (38.0, 35.0, 31.0), (1.02, 0.92, 0.76)),  # the key: a window on the left
    Light((-0.38, 0.70, 0.62), (5.0, 8.0), (30.0, 28.0, 25.0), (0.42, 0.38, 0.32)),  # its other half
    Light((0.86, 0.34, 0.38), (4.0, 13.0), (9.0, 11.0, 14.0), (0.15, 0.20, 0.28)),  # a door on the right
    Light((0.30, 0.45, 0.84), (3.5, 3.5), (20.0, 14.5, 9.0), (0.0, 0.0, 0.0)),  # a lamp behind the cameras
    Light((0.10, 0.20, -0.97), (16.0, 6.0), (1.2, 1.15, 1.1), (0.0, 0.0, 0.0)),  # the wall's sheen at grazing angles
)
KEYS = 2  # the first lights are seen through a window frame, whose shadow lies over the scene
FRAME_CENTRE, FRAME_HALF, FRAME_BLUR = (0.42, 0.62), (1.15, 1.02), 0.13
FRAME_BARS, BAR_HALF = (-0.74, 0.58), 0.035
FRAME_SHADE = 0.25  # of the key is left outside the frame
SHADOW_SOFTNESS = 0.16  # tangent of the key's half width
OCCLUDERS = (  # spheres (centre, radius) in place of the objects
    ((0.0, 0.16, 0.0), 0.34), ((0.0, 0.45, 0.0), 0.47), ((0.0, 0.68, 0.0), 0.51), ((0.0, 0.95, 0.0), 0.36),
    ((0.0, 1.12, 0.0), 0.31), ((0.0, 1.35, 0.0), 0.085), ((-0.735, 0.205, 0.42), 0.205), ((0.36, 0.125, 0.80), 0.125),
    ((0.80, 0.14, 0.28), 0.19), ((0.80, 0.26, 0.28), 0.18), ((0.88, 0.13, 0.17), 0.14), ((0.72, 0.13, 0.39), 0.14),
)  # fmt: skip
OWNERS = ("body", "body", "body", "body", "lid", "lid", "orange", "marble", "block", "block", "block", "block")


def radiance(directions: Array, softness: float) -> Array:
    """(n, 3) unit directions to (n, 3) RGB: edges of lights and of the room blurred by `softness` degrees."""
    _, y, z = directions.T
    level = 1 / (1 + np.exp(-y / np.sin(np.radians(softness + 6))))
    floor, room = np.array([0.10, 0.075, 0.055]), np.array([0.30, 0.29, 0.28])
    total = floor + (room * (0.55 + 0.45 * y[:, None]) - floor) * level[:, None]
    total += 0.10 * np.maximum(z, 0)[:, None] * (1.0, 0.96, 0.9)
    for light in LIGHTS:
        axis = _unit(np.array(light.direction))
        side = _unit(np.cross((0.0, 1.0, 0.0), axis))
        up = np.cross(axis, side)
        ahead = directions @ axis
        across = np.degrees(np.arctan2(directions @ side, np.maximum(ahead, 1e-6)))
        above = np.degrees(np.arctan2(directions @ up, np.maximum(ahead, 1e-6)))
        area = light.half[0] * light.half[1]
        wide = [half + softness / 2 for half in light.half]
        inside = _box(across, wide[0], softness / 2) * _box(above, wide[1], softness / 2) * (ahead > 0)
        total += inside[:, None] * np.array(light.radiance) * area / (wide[0] * wide[1])
    return np.asarray(total)


def _box(angle: Array, half: float, softness: float) -> Array:
    """1 within `half` of 0, falling to 0 over about `softness` on each side."""
    return np.asarray(1 / (1 + np.exp(np.clip((np.abs(angle) - half) / (softness / 2), -50, 50))))


def environment() -> NDArray[np.float32]:
    """(2, e, e, 3): the room over the octahedron, through a gloss of about 4 degrees and one of about 22."""
    t = np.linspace(-1, 1, OCTAHEDRON)
    z, x = np.meshgrid(t, t, indexing="ij")
    y = 1 - np.abs(x) - np.abs(z)
    folded_x = np.where(y < 0, (1 - np.abs(z)) * np.where(x >= 0, 1, -1), x)
    folded_z = np.where(y < 0, (1 - np.abs(x)) * np.where(z >= 0, 1, -1), z)
    directions = np.stack([folded_x, y, folded_z], axis=-1).reshape(-1, 3)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    layers = [radiance(directions, softness).reshape(OCTAHEDRON, OCTAHEDRON, 3) for softness in (4.0, 22.0)]
    return np.stack(layers).astype(np.float32)


def irradiance(points: Array, normals: Array, owner: str) -> tuple[Array, Array]:
    """(n, 3) RGB that falls on a surface of part `owner`, and (n,) how open it is to the room, 0..1."""
    opened = np.ones(len(points))
    lit = [np.ones(len(points)) for _ in LIGHTS]
    for (centre, radius), name in zip(OCCLUDERS, OWNERS, strict=True):
        if name == owner or (name, owner) == ("body", "lid"):
            continue
        offset = np.array(centre) - points
        square = dot(offset, offset)
        toward = dot(offset, normals) / np.sqrt(square)
        opened *= 1 - 0.62 * np.clip(toward * 0.8 + 0.2, 0, 1) * np.minimum(radius**2 / square, 1)
        for light, share in zip(LIGHTS, lit, strict=True):
            if sum(light.irradiance) > 0:
                share *= _shade(offset, square, _unit(np.array(light.direction)), radius)
    total = np.array([0.235, 0.245, 0.27]) * (0.72 + 0.28 * normals[:, 1:2]) * opened[:, None]
    total = total + np.array([0.08, 0.06, 0.045]) * (0.5 - 0.5 * normals[:, 1:2]) * opened[:, None]
    for k, (light, share) in enumerate(zip(LIGHTS, lit, strict=True)):
        if sum(light.irradiance) == 0:
            continue
        if k < KEYS:
            share *= _window(points)
        facing = np.maximum(normals @ _unit(np.array(light.direction)), 0)
        total = total + (facing * share)[:, None] * np.array(light.irradiance)
    return total, opened


def _window(points: Array) -> Array:
    """What the frame of the window leaves of the key: two panes with blurred edges, seen along the key's direction."""
    key = _unit(np.array(LIGHTS[0].direction))
    side = _unit(np.cross((0.0, 1.0, 0.0), key))
    a, b = points @ side - FRAME_CENTRE[0], points @ np.cross(key, side) - FRAME_CENTRE[1]
    panes = _step(FRAME_HALF[0] - np.abs(a)) * _step(FRAME_HALF[1] - np.abs(b))
    for bar in FRAME_BARS:
        panes *= 1 - _step(BAR_HALF - np.abs(a - bar))
    return np.asarray(FRAME_SHADE + (1 - FRAME_SHADE) * panes)


def _step(distance: Array) -> Array:
    t = np.clip(0.5 + distance / FRAME_BLUR, 0, 1)
    return np.asarray(t * t * (3 - 2 * t))


def _shade(offset: Array, square: Array, direction: Array, radius: float) -> Array:
    """What a sphere at `offset` leaves of a light of some width: smooth in the clearance over the distance."""
    along = offset @ direction
    miss = np.sqrt(np.maximum(square - along**2, 0))
    clearance = (miss - radius) / np.maximum(along, 1e-3)
    share = np.clip(0.5 + clearance / (2 * SHADOW_SOFTNESS), 0, 1)
    return np.where(along > 0, share * share * (3 - 2 * share), 1.0)


def dot(a: Array, b: Array) -> Array:
    """(n,) of two (n, 3): by columns, several times as fast as a sum over an axis of three."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2])


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))
