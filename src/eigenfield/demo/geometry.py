"""The demo's exact geometry: a lidded jar, four balls and a letter block on a floor before a wall, with an atlas.

World axes: x right, y up, z towards the cameras; one unit is about 210 pixels. Surfaces that face away from all cameras
are left out, as in a scan. Charts are laid out at about one density as the middle camera sees them: floor and wall by
its own projection, the round surfaces by equal-area maps. `build_surroundings` has what the chrome and the glass ball
show instead: all sides, and a floor and a wall that go on outside the picture.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from eigenfield.core.mesh import Mesh, area_normals, vertex_normals
from eigenfield.demo.cameras import DEMO_FOCAL_WIDTHS, DEMO_HALF_ARRAY_UNITS, array_camera, array_centre

Array = NDArray[np.float64]

WALL_Z_UNITS = -1.15
CHART_MARGIN_PIXELS = 46  # of floor and wall around the middle camera's frame
CHART_FRAME_PIXELS = 512  # side of the frame in which charts are measured
CHART_GAP_PIXELS = 10  # between charts
CULL_MIN_COSINE = -0.22  # to the nearest corner of the array: surfaces below are never seen
DEMO_UV_STEP = 2.0**-16  # UVs are multiples of it, which files restore exactly

BODY_PROFILE = np.array([(0.300, 0.0), (0.335, 0.035), (0.350, 0.075), (0.400, 0.23), (0.495, 0.44), (0.540, 0.62),
                 (0.520, 0.79), (0.430, 0.93), (0.310, 1.01), (0.275, 1.05), (0.272, 1.085)])  # fmt: skip
LID_PROFILE = np.array([(0.346, 1.084), (0.354, 1.092), (0.358, 1.110), (0.345, 1.140), (0.255, 1.205), (0.130, 1.250),
                (0.062, 1.268), (0.055, 1.295), (0.088, 1.335), (0.080, 1.385), (0.001, 1.420)])  # fmt: skip
ORANGE_SPHERE = (np.array([-0.735, 0.205, 0.42]), 0.205)
MARBLE_SPHERE = (np.array([0.36, 0.125, 0.80]), 0.125)
CHROME_SPHERE = (np.array([0.86, 0.33, -0.60]), 0.33)
GLASS_SPHERE = (np.array([-0.27, 0.22, 0.93]), 0.22)
BLOCK_CENTRE, BLOCK_SIDE_UNITS, BLOCK_ANGLE_RADIANS = np.array([0.80, 0.18, 0.28]), 0.36, np.radians(34)
VISIBLE_BLOCK_SIDES = ((2, 1), (0, -1), (0, 1), (1, 1))  # axis and sign of those seen from above and in front
BLOCK_SIDES = (*VISIBLE_BLOCK_SIDES, (2, -1))  # it stands on the sixth
FRONT_POLAR_RADIANS = np.radians(104)  # of a ball, from the middle camera: all that a camera can see

SURFACE_PARTS = ("floor", "wall", "body", "lid", "orange", "marble", "block", "chrome", "glass")
ALL_PARTS = (*SURFACE_PARTS, "sheet")  # the clip's too: in it the print on the wall is a sheet that hangs before it
SURROUNDINGS_HALF_WIDTH_UNITS, SURROUNDINGS_HEIGHT_UNITS, SURROUNDINGS_FRONT_UNITS = 3.0, 2.4, 3.8
SURROUNDINGS_PIXELS_PER_UNIT = 200.0  # of the chart of this floor and wall
SURROUNDINGS_CELL_UNITS = 0.5  # triangles of floor and wall: small ones make a good tree


@dataclass(frozen=True, eq=False)
class SurfacePart:
    """One surface of the scene.

    Attributes:
        name: One of ALL_PARTS.
        vertices: (n, 3) float64.
        faces: (m, 3).
        normals: (n, 3) smooth normals.
        chart: (n, 2) chart coordinates in pixels of the middle camera.
        outward: (n, 3) normals without the embossed relief.
    """

    name: str
    vertices: Array
    faces: NDArray[np.int64]
    normals: Array
    chart: Array
    outward: Array


@dataclass(frozen=True, eq=False)
class DemoGeometry:
    """The mesh, and what only the drawing needs.

    Attributes:
        mesh: With an atlas.
        normals: (n, 3) smooth normals.
        part: (m,) index into ALL_PARTS of each face.
    """

    mesh: Mesh
    normals: Array
    part: NDArray[np.int64]


@cache
def build_geometry() -> DemoGeometry:
    """All parts in one mesh, with charts packed into the unit square. A PLY restores its float32 numbers exactly."""
    balls = [
        ball_part("chrome", CHROME_SPHERE, 26, 64, FRONT_POLAR_RADIANS),
        ball_part("glass", GLASS_SPHERE, 22, 56, FRONT_POLAR_RADIANS),
    ]
    parts = [*background_parts(), *_things(FRONT_POLAR_RADIANS), *block_parts(VISIBLE_BLOCK_SIDES), *balls]
    return join_parts([part for part in map(cull_back_faces, parts) if len(part.faces)])


@cache
def build_surroundings() -> DemoGeometry:
    """What rays from the chrome and the glass ball meet, these two left out."""
    return join_parts(surroundings_parts())


def surroundings_parts() -> list[SurfacePart]:
    """The parts of `build_surroundings`."""
    left, right = -SURROUNDINGS_HALF_WIDTH_UNITS, SURROUNDINGS_HALF_WIDTH_UNITS
    floor = _rectangle("floor", (left, right), (WALL_Z_UNITS, SURROUNDINGS_FRONT_UNITS), 1)
    wall = _rectangle("wall", (left, right), (0.0, SURROUNDINGS_HEIGHT_UNITS), 2)
    return [floor, wall, *_things(np.pi), *block_parts(BLOCK_SIDES)]


def _things(polar: float) -> list[SurfacePart]:
    """The jar, and balls up to an angle from the middle camera."""
    return [
        *jar_parts(),
        ball_part("orange", ORANGE_SPHERE, 22, 48, polar),
        ball_part("marble", MARBLE_SPHERE, 18, 40, polar),
    ]


def jar_parts() -> list[SurfacePart]:
    """Body and lid."""
    return [_surface_of_revolution("body", BODY_PROFILE, 66, 128), _surface_of_revolution("lid", LID_PROFILE, 34, 96)]


def join_parts(parts: list[SurfacePart]) -> DemoGeometry:
    """The parts as one mesh, with charts packed into the unit square.

    Args:
        parts: The first two share a chart.
    """
    background, others = parts[:2], parts[2:]
    blocks = [np.concatenate([part.chart for part in background]), *(part.chart for part in others)]
    lows = [chart.min(axis=0) for chart in blocks]
    corners, side = _pack_rectangles([chart.max(axis=0) - low for chart, low in zip(blocks, lows, strict=True)])
    shifts = [corner - low for corner, low in zip(corners, lows, strict=True)]
    charts = [part.chart + shift for part, shift in zip(parts, [shifts[0], *shifts], strict=True)]
    uv = np.round(np.concatenate(charts) / side / DEMO_UV_STEP) * DEMO_UV_STEP
    offsets = np.cumsum([0] + [len(part.vertices) for part in parts])
    mesh = Mesh(
        np.concatenate([part.vertices for part in parts]).astype(np.float32),
        np.concatenate([part.faces + offset for part, offset in zip(parts, offsets, strict=False)]).astype(np.int32),
        uv.astype(np.float32),
    )
    label = np.concatenate([np.full(len(part.faces), ALL_PARTS.index(part.name)) for part in parts])
    return DemoGeometry(mesh, np.concatenate([part.normals for part in parts]), label)


def background_parts() -> list[SurfacePart]:
    """Floor and wall as a grid in the middle camera's frame; the crease between them is a line of it."""
    camera = array_camera(0.0, 0.0, CHART_FRAME_PIXELS)
    crease = camera.project([(0.0, 0.0, WALL_Z_UNITS)])[0][0, 1]
    columns = np.linspace(-CHART_MARGIN_PIXELS, CHART_FRAME_PIXELS + CHART_MARGIN_PIXELS, 40)
    rows = {
        "wall": np.linspace(-CHART_MARGIN_PIXELS, crease, 20),
        "floor": np.linspace(crease, CHART_FRAME_PIXELS + CHART_MARGIN_PIXELS, 30),
    }
    back = camera.R.T @ np.linalg.inv(camera.K)
    parts = []
    for name, lines in rows.items():
        pixels = np.stack(np.meshgrid(columns, lines), axis=-1).reshape(-1, 2)
        ray = np.column_stack([pixels, np.ones(len(pixels))]) @ back.T
        axis, level = (2, WALL_Z_UNITS) if name == "wall" else (1, 0.0)
        points = camera.centre + ray * ((level - camera.centre[axis]) / ray[:, axis])[:, None]
        points[:, axis] = level
        normal = np.zeros(3)
        normal[axis] = 1.0
        faces = grid_faces(len(lines), len(columns))
        normals = np.tile(normal, (len(points), 1))
        parts.append(SurfacePart(name, points, faces, normals, pixels, normals))
    return parts[::-1]


def _rectangle(name: str, across: tuple[float, float], along: tuple[float, float], axis: int) -> SurfacePart:
    """A part of the floor (axis 1) or of the wall (axis 2), with a chart in which they join at the crease."""
    steps = [round((high - low) / SURROUNDINGS_CELL_UNITS) + 1 for low, high in (across, along)]
    u, v = np.meshgrid(np.linspace(*across, steps[0]), np.linspace(*along, steps[1]))
    points = np.zeros((u.size, 3))
    points[:, 0], points[:, 3 - axis] = u.reshape(-1), v.reshape(-1)
    points[:, axis] = 0.0 if axis == 1 else WALL_Z_UNITS
    down = points[:, 2] - WALL_Z_UNITS - points[:, 1]
    normals = np.tile(np.eye(3)[axis], (len(points), 1))
    chart = np.column_stack([points[:, 0], down]) * SURROUNDINGS_PIXELS_PER_UNIT
    return SurfacePart(name, points, grid_faces(steps[1], steps[0]), normals, chart, normals)


def _surface_of_revolution(name: str, profile: Array, rows: int, columns: int) -> SurfacePart:
    """A profile (k, 2) of radius and height rotated about the y axis, embossed.

    The chart is the sinusoidal map (angle x radius, arc length), which preserves areas.
    """
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(profile, axis=0), axis=1))])
    curve = PchipInterpolator(length, profile)
    s = np.linspace(0, length[-1], rows + 1)
    radius, height = curve(s).T
    angle = np.linspace(-np.pi, np.pi, columns + 1)
    angles, arc = np.meshgrid(angle, s)
    across, up = np.broadcast_to(radius[:, None], angles.shape), np.broadcast_to(height[:, None], angles.shape)
    points = np.stack([across * np.sin(angles), up, across * np.cos(angles)], axis=-1)
    slope = curve.derivative()(s)
    slope_normal = np.stack([slope[:, 1], -slope[:, 0]], axis=1)
    slope_normal /= np.linalg.norm(slope_normal, axis=1, keepdims=True)
    outward = np.stack(
        [
            slope_normal[:, :1] * np.sin(angles),
            np.broadcast_to(slope_normal[:, 1:], angles.shape),
            slope_normal[:, :1] * np.cos(angles),
        ],
        axis=-1,
    )
    points = points + emboss_height(name, angles, arc / length[-1])[..., None] * outward
    faces = grid_faces(rows + 1, columns + 1)[:, ::-1]
    vertices = points.reshape(-1, 3)
    normals = vertex_normals(vertices, faces).reshape(points.shape)
    normals[:, 0] = normals[:, -1] = (normals[:, 0] + normals[:, -1]) / 2  # the seam at the back
    depth = np.linalg.norm(array_centre() - vertices.mean(axis=0))
    chart = np.stack([angles * across, -arc], axis=-1).reshape(-1, 2) * DEMO_FOCAL_WIDTHS * CHART_FRAME_PIXELS / depth
    return SurfacePart(name, vertices, faces, normals.reshape(-1, 3), chart, outward.reshape(-1, 3))


def emboss_height(name: str, angle: Array, along: Array) -> Array:
    """Height of the jar's relief over its profile: flutes and lobes on the body, petals on the lid.

    Args:
        name: "body" or "lid".
        angle: About the axis, radians.
        along: Position along the profile, 0..1.
    """
    if name == "lid":
        return np.asarray(0.007 * np.cos(12 * angle) * np.exp(-(((along - 0.38) / 0.13) ** 2)))
    flutes = 0.010 * np.cos(24 * angle) * np.exp(-(((along - 0.17) / 0.075) ** 4))
    lobes = np.cos(8 * angle) * np.cos(2 * np.pi * (along - 0.55) / 0.22)
    belly = 0.016 * np.maximum(lobes, 0) ** 2 * np.exp(-(((along - 0.55) / 0.19) ** 4))
    rings = 0.006 * np.exp(-(((along - 0.285) / 0.012) ** 2)) + 0.006 * np.exp(-(((along - 0.80) / 0.012) ** 2))
    return np.asarray(flutes + belly + rings)


def ball_part(
    name: str, sphere: tuple[Array, float], rings: int, sectors: int, polar_end: float, *, behind: bool = False
) -> SurfacePart:
    """A sphere about the axis to the middle camera, as far as an angle from it.

    The chart is Lambert's azimuthal map (radius 2 sin(angle / 2)), which preserves areas.

    Args:
        name: One of ALL_PARTS.
        sphere: Centre and radius.
        rings: Of triangles.
        sectors: Of triangles.
        polar_end: Radians.
        behind: About the axis away from the middle camera.
    """
    centre, radius = sphere
    axis = array_centre() - centre
    depth = float(np.linalg.norm(axis))
    axis /= -depth if behind else depth
    right = np.array([axis[2], 0.0, -axis[0]]) / np.hypot(axis[0], axis[2])
    up = np.cross(axis, right)
    polar, angles = np.meshgrid(
        np.linspace(0, polar_end, rings + 1), np.linspace(0, 2 * np.pi, sectors + 1), indexing="ij"
    )
    angles[:, -1] = 0.0
    normals = (
        np.cos(polar)[..., None] * axis
        + (np.sin(polar) * np.cos(angles))[..., None] * right
        + (np.sin(polar) * np.sin(angles))[..., None] * up
    ).reshape(-1, 3)
    chart_radius = 2 * np.sin(polar / 2) * radius * DEMO_FOCAL_WIDTHS * CHART_FRAME_PIXELS / depth
    chart = np.stack([chart_radius * np.cos(angles), -chart_radius * np.sin(angles)], axis=-1).reshape(-1, 2)
    faces = grid_faces(rings + 1, sectors + 1)
    merged = np.arange(len(normals)).reshape(rings + 1, sectors + 1)
    merged[:, -1] = merged[:, 0]
    merged[0] = merged[0, 0]
    faces = merged.reshape(-1)[faces]
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return SurfacePart(name, centre + radius * normals, faces[whole], normals, chart, normals)


def block_parts(sides: tuple[tuple[int, int], ...]) -> list[SurfacePart]:
    """Sides of the letter block, one chart each.

    Args:
        sides: Axis and sign.
    """
    c, s = np.cos(BLOCK_ANGLE_RADIANS), np.sin(BLOCK_ANGLE_RADIANS)
    frame = np.array([(c, 0, -s), (0, 1, 0), (s, 0, c)])  # rows: the block's axes in the world
    scale = BLOCK_SIDE_UNITS * DEMO_FOCAL_WIDTHS * CHART_FRAME_PIXELS / np.linalg.norm(array_centre() - BLOCK_CENTRE)
    grid = np.stack(np.meshgrid(np.linspace(-0.5, 0.5, 9), np.linspace(-0.5, 0.5, 9)), axis=-1).reshape(-1, 2)
    parts = []
    for axis, sign in sides:
        out = sign * frame[axis]
        up = frame[1] if axis != 1 else -frame[2]
        right = np.cross(up, out)
        points = BLOCK_CENTRE + BLOCK_SIDE_UNITS * (out / 2 + grid[:, :1] * right + grid[:, 1:] * up)
        normals = np.tile(out, (len(points), 1))
        parts.append(SurfacePart("block", points, grid_faces(9, 9), normals, grid * (scale, -scale), normals))
    return parts


def grid_faces(rows: int, columns: int) -> NDArray[np.int64]:
    """Two triangles for each cell of a grid of vertices in row-major order.

    Args:
        rows: Of vertices.
        columns: Of vertices.
    """
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1)
    lower = np.stack([corner, corner + columns, corner + columns + 1], axis=1)
    upper = np.stack([corner, corner + columns + 1, corner + 1], axis=1)
    return np.stack([lower, upper], axis=1).reshape(-1, 3)


def cull_back_faces(part: SurfacePart, moments: Sequence[tuple[Array, Array]] | None = None) -> SurfacePart:
    """The part without triangles that face away from all four corners of the array, and without their vertices.

    The relief is ignored, so that charts have smooth borders. The rest is wound counter-clockwise as seen from outside.

    Args:
        part: To be culled.
        moments: Vertices (n, 3) and normals without relief (n, 3) at each time at which it is seen; None: as it is.
    """
    p, normals = part.vertices[part.faces], part.normals[part.faces].sum(axis=1)
    inward = (area_normals(p) * normals).sum(axis=1) < 0
    faces = np.where(inward[:, None], part.faces[:, ::-1], part.faces)
    seen = np.zeros(len(faces), bool)
    for vertices, outwards in moments or [(part.vertices, part.outward)]:
        middle, outward = vertices[part.faces].mean(axis=1), outwards[part.faces].mean(axis=1)
        for x in (-1, 1):
            for y in (-1, 1):
                corner = array_camera(x * DEMO_HALF_ARRAY_UNITS, y * DEMO_HALF_ARRAY_UNITS, CHART_FRAME_PIXELS)
                ray = corner.centre - middle
                ray /= np.linalg.norm(ray, axis=1, keepdims=True)
                seen |= (ray * outward).sum(axis=1) > CULL_MIN_COSINE
    used, index = np.unique(faces[seen], return_inverse=True)
    return SurfacePart(
        part.name, part.vertices[used], index.reshape(-1, 3), part.normals[used], part.chart[used], part.outward[used]
    )


def _pack_rectangles(sizes: list[Array]) -> tuple[list[Array], float]:
    """Corners of rectangles in the smallest square (in steps of 4) that holds them by first fit, largest first."""
    order = sorted(range(len(sizes)), key=lambda i: -float(sizes[i].prod()))
    side = 4 * np.ceil(max(size.max() for size in sizes) / 4) + CHART_GAP_PIXELS
    while True:
        corners = _first_fit([sizes[i] + CHART_GAP_PIXELS for i in order], side)
        if corners is not None:
            placed = dict(zip(order, corners, strict=True))
            return [placed[i] + CHART_GAP_PIXELS / 2 for i in range(len(sizes))], float(side)
        side += 4


def _first_fit(sizes: list[Array], side: float) -> list[Array] | None:
    placed: list[tuple[Array, Array]] = []
    for size in sizes:
        xs = sorted({0.0, *(low[0] + s[0] for low, s in placed)})
        ys = sorted({0.0, *(low[1] + s[1] for low, s in placed)})
        spot = next((np.array([x, y]) for y in ys for x in xs if _is_free(np.array([x, y]), size, placed, side)), None)
        if spot is None:
            return None
        placed.append((spot, size))
    return [low for low, _ in placed]


def _is_free(low: Array, size: Array, placed: list[tuple[Array, Array]], side: float) -> bool:
    inside = bool((low + size <= side).all())
    return inside and not any(((low < other + s) & (other < low + size)).all() for other, s in placed)
