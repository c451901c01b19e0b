"""The demo's exact geometry: a lidded jar, two balls and a letter block on a floor before a wall, with an atlas.

World axes: x right, y up, z towards the cameras; one unit is about 210 pixels. Surfaces that face away from all
cameras are left out, as a scan would leave them. Charts are laid out at about one density as the middle camera sees
them: floor and wall by its own projection, the round ones by maps that keep areas.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from eigenfield.core.mesh import Mesh
from eigenfield.demo.cameras import FOCAL, HALF_ARRAY, array_camera, array_centre

Array = NDArray[np.float64]

WALL_Z = -1.15
MARGIN = 46  # pixels of floor and wall around the middle camera's frame
FRAME = 512  # side of the frame in which charts are measured
GAP = 10  # of those pixels between charts
TURNED_AWAY = -0.22  # cosine to the nearest corner of the array below which a surface is never seen
UV_STEP = 2.0**-16  # UVs are multiples of it: they pass through files to the bit

BODY = np.array([(0.300, 0.0), (0.335, 0.035), (0.350, 0.075), (0.400, 0.23), (0.495, 0.44), (0.540, 0.62),
                 (0.520, 0.79), (0.430, 0.93), (0.310, 1.01), (0.275, 1.05), (0.272, 1.085)])  # fmt: skip
LID = np.array([(0.346, 1.084), (0.354, 1.092), (0.358, 1.110), (0.345, 1.140), (0.255, 1.205), (0.130, 1.250),
                (0.062, 1.268), (0.055, 1.295), (0.088, 1.335), (0.080, 1.385), (0.001, 1.420)])  # fmt: skip
ORANGE = (np.array([-0.735, 0.205, 0.42]), 0.205)
MARBLE = (np.array([0.36, 0.125, 0.80]), 0.125)
BLOCK_CENTRE, BLOCK_SIDE, BLOCK_TURN = np.array([0.80, 0.18, 0.28]), 0.36, np.radians(34)

PARTS = ("floor", "wall", "body", "lid", "orange", "marble", "block")


@dataclass(frozen=True, eq=False)
class Part:
    """One surface, float64: vertices (n, 3), faces (m, 3), smooth normals (n, 3), chart coordinates (n, 2) in pixels
    of the middle camera, and outward (n, 3), the normals without the relief."""

    name: str
    vertices: Array
    faces: NDArray[np.int64]
    normals: Array
    chart: Array
    outward: Array


@dataclass(frozen=True, eq=False)
class Geometry:
    """The mesh, with what only the drawing needs: normals (n, 3) a vertex, and which of PARTS each face belongs to."""

    mesh: Mesh
    normals: Array
    part: NDArray[np.int64]


def demo_scene_geometry() -> Mesh:
    """The exact proxy of the demo's capture, with a valid atlas of its own; float32 numbers that a PLY keeps."""
    return geometry().mesh


@cache
def geometry() -> Geometry:
    """All parts in one mesh, charts packed into the unit square."""
    parts = [*_background(), _turned("body", BODY, 66, 128), _turned("lid", LID, 34, 96)]
    parts += [_ball("orange", *ORANGE, 22, 48), _ball("marble", *MARBLE, 18, 40), *_block()]
    parts = [part for part in map(_facing, parts) if len(part.faces)]
    background, others = parts[:2], parts[2:]
    blocks = [np.concatenate([part.chart for part in background]), *(part.chart for part in others)]
    lows = [chart.min(axis=0) for chart in blocks]
    corners, side = _packed([chart.max(axis=0) - low for chart, low in zip(blocks, lows, strict=True)])
    shifts = [corner - low for corner, low in zip(corners, lows, strict=True)]
    charts = [part.chart + shift for part, shift in zip(parts, [shifts[0], *shifts], strict=True)]
    uv = np.round(np.concatenate(charts) / side / UV_STEP) * UV_STEP
    offsets = np.cumsum([0] + [len(part.vertices) for part in parts])
    mesh = Mesh(
        np.concatenate([part.vertices for part in parts]).astype(np.float32),
        np.concatenate([part.faces + offset for part, offset in zip(parts, offsets, strict=False)]).astype(np.int32),
        uv.astype(np.float32),
    )
    label = np.concatenate([np.full(len(part.faces), PARTS.index(part.name)) for part in parts])
    return Geometry(mesh, np.concatenate([part.normals for part in parts]), label)


def _background() -> list[Part]:
    """Floor and wall as a grid in the middle camera's frame; the crease between them is a line of it."""
    camera = array_camera(0.0, 0.0, FRAME)
    crease = camera.project([(0.0, 0.0, WALL_Z)])[0][0, 1]
    columns = np.linspace(-MARGIN, FRAME + MARGIN, 40)
    rows = {"wall": np.linspace(-MARGIN, crease, 20), "floor": np.linspace(crease, FRAME + MARGIN, 30)}
    back = camera.R.T @ np.linalg.inv(camera.K)
    parts = []
    for name, lines in rows.items():
        pixels = np.stack(np.meshgrid(columns, lines), axis=-1).reshape(-1, 2)
        ray = np.column_stack([pixels, np.ones(len(pixels))]) @ back.T
        axis, level = (2, WALL_Z) if name == "wall" else (1, 0.0)
        points = camera.centre + ray * ((level - camera.centre[axis]) / ray[:, axis])[:, None]
        points[:, axis] = level
        normal = np.zeros(3)
        normal[axis] = 1.0
        faces = _grid(len(lines), len(columns))
        normals = np.tile(normal, (len(points), 1))
        parts.append(Part(name, points, faces, normals, pixels, normals))
    return parts[::-1]


def _turned(name: str, profile: Array, rows: int, columns: int) -> Part:
    """A profile (k, 2) of radius and height turned about the y axis, embossed; laid out by the sinusoidal map
    (angle x radius, arc length), which keeps areas."""
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(profile, axis=0), axis=1))])
    curve = PchipInterpolator(length, profile)
    s = np.linspace(0, length[-1], rows + 1)
    radius, height = curve(s).T
    angle = np.linspace(-np.pi, np.pi, columns + 1)
    turn, arc = np.meshgrid(angle, s)
    across, up = np.broadcast_to(radius[:, None], turn.shape), np.broadcast_to(height[:, None], turn.shape)
    points = np.stack([across * np.sin(turn), up, across * np.cos(turn)], axis=-1)
    slope = curve.derivative()(s)
    flat = np.stack([slope[:, 1], -slope[:, 0]], axis=1)
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    outward = np.stack(
        [flat[:, :1] * np.sin(turn), np.broadcast_to(flat[:, 1:], turn.shape), flat[:, :1] * np.cos(turn)], axis=-1
    )
    points = points + emboss(name, turn, arc / length[-1])[..., None] * outward
    faces = _grid(rows + 1, columns + 1)[:, ::-1]
    vertices = points.reshape(-1, 3)
    normals = _smooth(vertices, faces).reshape(points.shape)
    normals[:, 0] = normals[:, -1] = (normals[:, 0] + normals[:, -1]) / 2  # the seam at the back
    depth = np.linalg.norm(array_centre() - vertices.mean(axis=0))
    chart = np.stack([turn * across, -arc], axis=-1).reshape(-1, 2) * FOCAL * FRAME / depth
    return Part(name, vertices, faces, normals.reshape(-1, 3), chart, outward.reshape(-1, 3))


def emboss(name: str, angle: Array, along: Array) -> Array:
    """Height of the jar's relief over its profile: flutes low on the body, lobes on its belly, petals on the lid."""
    if name == "lid":
        return np.asarray(0.007 * np.cos(12 * angle) * np.exp(-(((along - 0.38) / 0.13) ** 2)))
    flutes = 0.010 * np.cos(24 * angle) * np.exp(-(((along - 0.17) / 0.075) ** 4))
    lobes = np.cos(8 * angle) * np.cos(2 * np.pi * (along - 0.55) / 0.22)
    belly = 0.016 * np.maximum(lobes, 0) ** 2 * np.exp(-(((along - 0.55) / 0.19) ** 4))
    rings = 0.006 * np.exp(-(((along - 0.285) / 0.012) ** 2)) + 0.006 * np.exp(-(((along - 0.80) / 0.012) ** 2))
    return np.asarray(flutes + belly + rings)


def _ball(name: str, centre: Array, radius: float, rings: int, sectors: int) -> Part:
    """A sphere about the axis to the middle camera, in Lambert's azimuthal map (radius 2 sin(angle / 2)), which keeps
    areas; the far side is left out."""
    axis = array_centre() - centre
    depth = float(np.linalg.norm(axis))
    axis /= depth
    right = np.array([axis[2], 0.0, -axis[0]]) / np.hypot(axis[0], axis[2])
    up = np.cross(axis, right)
    polar, turn = np.meshgrid(
        np.linspace(0, np.radians(104), rings + 1), np.linspace(0, 2 * np.pi, sectors + 1), indexing="ij"
    )
    turn[:, -1] = 0.0
    normals = (
        np.cos(polar)[..., None] * axis
        + (np.sin(polar) * np.cos(turn))[..., None] * right
        + (np.sin(polar) * np.sin(turn))[..., None] * up
    ).reshape(-1, 3)
    reach = 2 * np.sin(polar / 2) * radius * FOCAL * FRAME / depth
    chart = np.stack([reach * np.cos(turn), -reach * np.sin(turn)], axis=-1).reshape(-1, 2)
    faces = _grid(rings + 1, sectors + 1)
    joined = np.arange(len(normals)).reshape(rings + 1, sectors + 1)
    joined[:, -1] = joined[:, 0]
    joined[0] = joined[0, 0]
    faces = joined.reshape(-1)[faces]
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return Part(name, centre + radius * normals, faces[whole], normals, chart, normals)


def _block() -> list[Part]:
    """The six sides of the letter block, a chart each."""
    c, s = np.cos(BLOCK_TURN), np.sin(BLOCK_TURN)
    frame = np.array([(c, 0, -s), (0, 1, 0), (s, 0, c)])  # rows: the block's axes in the world
    scale = BLOCK_SIDE * FOCAL * FRAME / np.linalg.norm(array_centre() - BLOCK_CENTRE)
    grid = np.stack(np.meshgrid(np.linspace(-0.5, 0.5, 9), np.linspace(-0.5, 0.5, 9)), axis=-1).reshape(-1, 2)
    parts = []
    for axis, sign in ((2, 1), (0, -1), (0, 1), (1, 1)):  # those that can be seen from above and before
        out = sign * frame[axis]
        up = frame[1] if axis != 1 else -frame[2]
        right = np.cross(up, out)
        points = BLOCK_CENTRE + BLOCK_SIDE * (out / 2 + grid[:, :1] * right + grid[:, 1:] * up)
        normals = np.tile(out, (len(points), 1))
        parts.append(Part("block", points, _grid(9, 9), normals, grid * (scale, -scale), normals))
    return parts


def _grid(rows: int, columns: int) -> NDArray[np.int64]:
    """Two triangles for each cell of a grid of vertices in row-major order."""
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1)
    lower = np.stack([corner, corner + columns, corner + columns + 1], axis=1)
    upper = np.stack([corner, corner + columns + 1, corner + 1], axis=1)
    return np.stack([lower, upper], axis=1).reshape(-1, 3)


def _smooth(vertices: Array, faces: NDArray[np.int64]) -> Array:
    p = vertices[faces]
    flat = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    normals = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, faces[:, k], flat)
    return np.asarray(normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300))


def _facing(part: Part) -> Part:
    """Without the triangles that turn their back on all four corners of the array, and their vertices. Judged without
    the relief, so that charts are not frayed; the rest wound counter-clockwise as seen from outside."""
    p, normals = part.vertices[part.faces], part.normals[part.faces].sum(axis=1)
    inward = (np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]) * normals).sum(axis=1) < 0
    faces = np.where(inward[:, None], part.faces[:, ::-1], part.faces)
    middle, outward = p.mean(axis=1), part.outward[part.faces].mean(axis=1)
    seen = np.zeros(len(faces), bool)
    for x in (-1, 1):
        for y in (-1, 1):
            ray = array_camera(x * HALF_ARRAY, y * HALF_ARRAY, FRAME).centre - middle
            ray /= np.linalg.norm(ray, axis=1, keepdims=True)
            seen |= (ray * outward).sum(axis=1) > TURNED_AWAY
    used, index = np.unique(faces[seen], return_inverse=True)
    return Part(
        part.name, part.vertices[used], index.reshape(-1, 3), part.normals[used], part.chart[used], part.outward[used]
    )


def _packed(sizes: list[Array]) -> tuple[list[Array], float]:
    """Corners of rectangles in the smallest square (in steps of 4) into which first fit, largest first, brings them."""
    order = sorted(range(len(sizes)), key=lambda i: -float(sizes[i].prod()))
    side = 4 * np.ceil(max(size.max() for size in sizes) / 4) + GAP
    while True:
        corners = _fitted([sizes[i] + GAP for i in order], side)
        if corners is not None:
            placed = dict(zip(order, corners, strict=True))
            return [placed[i] + GAP / 2 for i in range(len(sizes))], float(side)
        side += 4


def _fitted(sizes: list[Array], side: float) -> list[Array] | None:
    placed: list[tuple[Array, Array]] = []
    for size in sizes:
        xs = sorted({0.0, *(low[0] + s[0] for low, s in placed)})
        ys = sorted({0.0, *(low[1] + s[1] for low, s in placed)})
        spot = next((np.array([x, y]) for y in ys for x in xs if _free(np.array([x, y]), size, placed, side)), None)
        if spot is None:
            return None
        placed.append((spot, size))
    return [low for low, _ in placed]


def _free(low: Array, size: Array, placed: list[tuple[Array, Array]], side: float) -> bool:
    inside = bool((low + size <= side).all())
    return inside and not any(((low < other + s) & (other < low + size)).all() for other, s in placed)
