"""The demo's surfaces: pigments, relief too fine for the mesh, gloss, and the light on them.

Everything is computed once, at the texels of a fine atlas. A view only looks it up and adds the reflections.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from eigenfield.demo.geometry import (
    ALL_PARTS,
    BLOCK_ANGLE_RADIANS,
    BLOCK_CENTRE,
    BLOCK_SIDE_UNITS,
    MARBLE_SPHERE,
    ORANGE_SPHERE,
    Array,
    DemoGeometry,
)
from eigenfield.demo.lettering import BLOCK_LETTERS, POSTER, letter_mask, poster_mask
from eigenfield.demo.light import STILL_SHADOWS, Shadows, dot_rows, irradiance
from eigenfield.demo.noise import fractal_noise
from eigenfield.imaging.colour import linear_of_srgb
from eigenfield.imaging.raster import rasterise_atlas
from eigenfield.runtime.parallel import parallel_map, pieces

DEMO_TEXELS_PER_TASK = 1 << 15  # texels a task
BUMP_STEP_UNITS = 0.003  # of the differences that give a bump's slope


class Finish(NamedTuple):
    """The material of points.

    Attributes:
        pigment: (n, 3) linear RGB.
        reflectance: (n,) or a number, at normal incidence.
        roughness: (n,) or a number.
    """

    pigment: Array
    reflectance: Array | float
    roughness: Array | float


FinishOf = Callable[[Array, Array], Finish]  # of points and normals, (n, 3) each


class ChartTexels(NamedTuple):
    """Some texels of one part.

    Attributes:
        name: Of the part.
        texel: (n,) places in the flattened atlas.
        face: (n,) of the mesh.
    """

    name: str
    texel: NDArray[np.int64]
    face: NDArray[np.int32]


class Material(NamedTuple):
    """What texels of one part are before any light falls on them.

    Attributes:
        name: Of the part.
        texel: (n,) places in the flattened atlas.
        point: (n, 3) in the world.
        normal: (n, 3) with the relief that is too fine for the mesh.
        finish: Of each texel.
    """

    name: str
    texel: NDArray[np.int64]
    point: Array
    normal: Array
    finish: Finish


class Charts:
    """The atlas of a scene: pieces of a bounded size, and how charts are extended into the gutters."""

    def __init__(self, scene: DemoGeometry, side: int, finishes: Mapping[str, FinishOf] | None = None) -> None:
        """Rasterise the atlas.

        Args:
            scene: With an atlas.
            side: Texels.
            finishes: Of all parts; None: those of the still scene.
        """
        self.side = side
        self._finishes = SURFACE_FINISHES if finishes is None else finishes
        raster = rasterise_atlas(scene.mesh, side, side)
        texel = np.flatnonzero(raster.face >= 0)
        face = raster.face.reshape(-1)[texel]
        order = np.argsort(scene.part[face], kind="stable")
        texel, face = texel[order], face[order]
        bounds = np.searchsorted(scene.part[face], np.arange(len(ALL_PARTS) + 1))
        self.pieces = [
            ChartTexels(name, texel[bounds[k] + start : bounds[k] + stop], face[bounds[k] + start : bounds[k] + stop])
            for k, name in enumerate(ALL_PARTS)
            if name in self._finishes
            for start, stop in pieces(int(bounds[k + 1] - bounds[k]), DEMO_TEXELS_PER_TASK)
        ]
        self._edges = raster.edges
        self._corners = scene.mesh.vertices.astype(np.float64)[scene.mesh.faces]
        self._normals = scene.normals[scene.mesh.faces]
        self._nearest = distance_transform_edt(raster.face < 0, return_distances=False, return_indices=True)

    def material(self, piece: ChartTexels) -> Material:
        """What a piece's texels are made of."""
        row, column = np.divmod(piece.texel, self.side)
        f = piece.face
        position = np.stack([column + 0.5, row + 0.5, np.ones(len(f))], axis=1)
        weight = np.einsum("nke,ne->nk", self._edges[f], position)
        point = np.einsum("nk,nkx->nx", weight, self._corners[f])
        normal = np.einsum("nk,nkx->nx", weight, self._normals[f])
        normal /= np.sqrt(dot_rows(normal, normal))[:, None]
        finish = self._finishes[piece.name](point, normal)
        return Material(piece.name, piece.texel, point, _bumped(piece.name, point, normal), finish)

    def extended(self, surface: NDArray[np.float32]) -> NDArray[np.float32]:
        """Texels (side * side, c) as a picture (side, side, c): gutters take the nearest texel inside a chart."""
        return np.ascontiguousarray(surface.reshape(self.side, self.side, -1)[tuple(self._nearest)])


def bake_surface(scene: DemoGeometry, side: int) -> NDArray[np.float32]:
    """(side, side, 8) float32: see `shade_view`; charts are extended into the gutters. Mirrors and glass are zero.

    Args:
        scene: With an atlas.
        side: Texels.
    """
    charts = Charts(scene, side)
    surface = np.zeros((side * side, 8), np.float32)

    def work(piece: ChartTexels) -> None:
        surface[piece.texel] = light_material(charts.material(piece), STILL_SHADOWS)

    parallel_map(work, charts.pieces)
    return charts.extended(surface)


def light_material(material: Material, shadows: Shadows) -> NDArray[np.float32]:
    """(n, 8) float32 of a material's texels: see `shade_view`.

    Args:
        material: Where it is now.
        shadows: That fall on it.
    """
    finish = material.finish
    light, ambient = irradiance(material.point, material.normal, material.name, shadows)
    roughness = np.broadcast_to(finish.roughness, len(material.point))
    columns = [finish.pigment * light, material.normal, finish.reflectance * ambient**1.5, roughness]
    return np.column_stack(columns).astype(np.float32)


def _bumped(name: str, point: Array, normal: Array) -> Array:
    if name not in BUMP_HEIGHTS:
        return normal
    height = BUMP_HEIGHTS[name]
    here = height(point)
    slope = np.stack([(height(point + BUMP_STEP_UNITS * axis) - here) / BUMP_STEP_UNITS for axis in np.eye(3)], axis=1)
    bumped = normal - slope + dot_rows(slope, normal)[:, None] * normal
    bumped /= np.sqrt(dot_rows(bumped, bumped))[:, None]
    return bumped


def noise(points: Array, frequency: float, octaves: int, seed: int, gain: float = 0.5) -> Array:
    """(n,) fractal value noise in -1..1.

    Args:
        points: (n, 3).
        frequency: Of the first octave.
        octaves: How many.
        seed: Of the first octave.
        gain: Amplitude of each octave relative to the one before.
    """
    out = np.empty(len(points))
    fractal_noise(np.ascontiguousarray(points), frequency, octaves, gain, seed, out)
    return out


def edge(distance: Array, width: float) -> Array:
    """1 where distance is negative, 0 where it is positive, with a smooth step.

    Args:
        distance: Signed.
        width: Of the step.
    """
    t = np.clip(0.5 - distance / width, 0, 1)
    return np.asarray(t * t * (3 - 2 * t))


def linear_colour(code: str) -> Array:
    """(3,) linear RGB of a hexadecimal sRGB colour.

    Args:
        code: Six digits.
    """
    value = np.array([int(code[k : k + 2], 16) for k in (0, 2, 4)]) / 255
    return linear_of_srgb(value)


def mix(a: Array, b: Array, share: Array) -> Array:
    """(n, 3) linear interpolation.

    Args:
        a: Where `share` is 0.
        b: Where `share` is 1.
        share: (n,).
    """
    return np.asarray(a + (b - a) * share[:, None])


FLOOR_TILE_UNITS = 0.37
PIN_UNITS = 0.035  # from the sheet's edges; it is so wide
PAINT_EDGE_UNITS = 0.006  # width of a paint edge, a little over a pixel


def _floor(point: Array, normal: Array) -> Finish:
    """Cement tiles: a quatrefoil and a star in turn, ruled with fine lines, in a pale joint."""
    x, z = (point[:, 0] + 0.11) / FLOOR_TILE_UNITS, (point[:, 2] - 0.05) / FLOOR_TILE_UNITS
    i, j = np.floor(x), np.floor(z)
    a, b = x - i - 0.5, z - j - 0.5
    even = (i + j) % 2 == 0
    fold = np.minimum(np.abs(a), np.abs(b)), np.maximum(np.abs(a), np.abs(b))
    petals = np.hypot(fold[1] - 0.23, fold[0]) - 0.175
    star = fold[1] + 0.62 * fold[0] - 0.40
    shape = np.where(even, petals, star)
    ring = np.abs(np.hypot(a, b) - 0.085) - 0.022
    corner = np.hypot(0.5 - np.abs(a), 0.5 - np.abs(b))
    width = PAINT_EDGE_UNITS / FLOOR_TILE_UNITS
    ground = np.where(even[:, None], linear_colour("E5D9C0"), linear_colour("8FA3A0"))
    figure = np.where(even[:, None], linear_colour("9E3F2B"), linear_colour("EBE2CE"))
    pigment = mix(ground, figure, edge(shape, width))
    pigment = mix(pigment, linear_colour("2E3E4E"), edge(np.abs(shape + 0.035) - 0.009, width))
    pigment = mix(pigment, linear_colour("D9A441"), edge(ring, width))
    pigment = mix(
        pigment, linear_colour("2E3E4E"), edge(np.abs(corner - 0.17) - 0.012, width) + edge(corner - 0.10, width)
    )
    pigment = mix(pigment, linear_colour("C9B48A"), edge(np.abs(corner - 0.055) - 0.012, width))
    grain = noise(point, 55.0, 3, 11, 0.7)
    cloud = noise(point, 5.0, 4, 12)
    pigment = pigment * (1 + 0.13 * grain + 0.14 * cloud)[:, None]
    joint = 0.5 - np.maximum(np.abs(a), np.abs(b)) - 0.012
    chip = joint - 0.010 * np.maximum(noise(point, 30.0, 2, 13), 0)
    inside = edge(chip, width)
    pigment = mix(pigment, linear_colour("6E675C") * (1 + 0.3 * grain)[:, None], inside)
    rough = np.clip(0.72 + 0.2 * cloud + 0.3 * inside, 0, 1)
    return Finish(pigment, 0.045 * (1 - 0.8 * inside), rough)


def _wall(point: Array, normal: Array) -> Finish:
    """The bare wall, and a printed sheet on it."""
    x, y = point[:, 0], point[:, 1]
    pigment = _bare_wall(point, normal).pigment
    off = np.maximum(
        np.abs((x - POSTER.left) / POSTER.width - 0.5) - 0.5,
        (np.abs((POSTER.top - y) / POSTER.height - 0.5) - 0.5) * POSTER.height / POSTER.width,
    )
    sheet = edge(off * POSTER.width, PAINT_EDGE_UNITS)
    shadow = 1 - 0.45 * np.exp(-np.maximum(_outside(x - 0.012, y + 0.016), 0) / 0.016)
    return Finish(mix(pigment * shadow[:, None], _print(point), sheet), 0.025, 1.0)


def _bare_wall(point: Array, normal: Array) -> Finish:
    """Lime plaster in two tones over a skirting of boards."""
    x, y = point[:, 0], point[:, 1]
    cloud = _wall_cloud(point)
    grain = noise(point * (1, 1, 0), 60.0, 3, 22, 0.8)
    trowel = noise(point * (1.0, 3.2, 0), 11.0, 4, 23, 0.6)
    pigment = mix(linear_colour("3E6B66"), linear_colour("6F9A8C"), np.clip(0.5 + 0.75 * cloud + 0.22 * trowel, 0, 1))
    pigment = pigment * (1 + 0.16 * grain)[:, None]
    board = np.floor(x / 0.16)
    groove = np.abs(x / 0.16 - board - 0.5) - 0.5
    fibre = noise(np.stack([x * 26 + 7 * board, y * 2.2, board], axis=1), 1.0, 4, 24, 0.65)
    figure = np.sin(
        26 * (x * 2.2 + 0.35 * noise(np.stack([x * 3, y * 0.9, board * 5.3], axis=1), 1.0, 2, 25)) + 9 * board
    )
    wood = mix(linear_colour("7A4A26"), linear_colour("B98147"), np.clip(0.5 + 0.4 * fibre + 0.28 * figure, 0, 1))
    wood = mix(wood, linear_colour("2A1A10"), edge(np.abs(groove) - 0.03, 0.05))
    below = edge(y - 0.20, PAINT_EDGE_UNITS)
    rail = edge(np.abs(y - 0.213) - 0.017, PAINT_EDGE_UNITS)
    pigment = mix(mix(pigment, wood, below), linear_colour("D8C9A8") * (1 + 0.1 * grain)[:, None], rail)
    return Finish(pigment, 0.025, 1.0)


def _wall_cloud(point: Array) -> Array:
    return noise(point, 2.2, 5, 21, 0.6)


def _print(point: Array) -> Array:
    """Paper with black and red ink."""
    u, v = (point[:, 0] - POSTER.left) / POSTER.width, (POSTER.top - point[:, 1]) / POSTER.height
    ink, red = poster_mask(u, v)
    fibres = noise(point, 120.0, 2, 26)
    shade = (1 + 0.035 * fibres + 0.05 * _wall_cloud(point))[:, None]
    return mix(mix(linear_colour("F0E6D0") * shade, linear_colour("1B1B20"), ink), linear_colour("B5301F"), red)


def _sheet(point: Array, normal: Array) -> Finish:
    """The same print as a sheet of its own, held by two brass pins at the top."""
    inward = 0.5 * POSTER.width - np.abs(point[:, 0] - POSTER.left - 0.5 * POSTER.width)
    pin = edge(np.hypot(inward - PIN_UNITS, POSTER.top - point[:, 1] - PIN_UNITS) - 0.5 * PIN_UNITS, PAINT_EDGE_UNITS)
    return Finish(mix(_print(point), linear_colour("A8741F"), pin), 0.025 + 0.3 * pin, 1.0 - 0.8 * pin)


def _outside(x: Array, y: Array) -> Array:
    """Distance from the printed sheet."""
    dx = np.maximum(POSTER.left - x, x - POSTER.left - POSTER.width)
    dy = np.maximum(POSTER.top - POSTER.height - y, y - POSTER.top)
    return np.hypot(np.maximum(dx, 0), np.maximum(dy, 0))


def _body(point: Array, normal: Array) -> Finish:
    """Porcelain painted in cobalt: waves on the shoulder, rosettes on the belly's lobes, leaves and bands."""
    angle, y = np.arctan2(point[:, 0], point[:, 2]), point[:, 1]
    around = angle / (2 * np.pi)
    cobalt = np.zeros(len(point))
    for level, half in ((0.272, 0.006), (0.300, 0.003), (0.855, 0.006), (0.880, 0.003), (0.985, 0.004), (0.06, 0.006)):
        cobalt = np.maximum(cobalt, edge(np.abs(y - level) - half, PAINT_EDGE_UNITS))
    waves = _waves(around * 40, (y - 0.79) / 0.036)
    cobalt = np.maximum(cobalt, waves * ((y > 0.885) & (y < 0.98)) * 0.95)
    key = np.abs(((around * 48) % 1) - 0.5) - 0.27 + 0.18 * np.sign(np.sin(np.pi * (y - 1.0) / 0.018))
    cobalt = np.maximum(cobalt, edge(key, 0.1) * ((y > 1.0) & (y < 1.045)))
    cobalt = np.maximum(cobalt, _rosettes(around, y))
    flute = np.cos(24 * angle)
    leaf = edge(np.abs(y - 0.165) - 0.075 * np.sqrt(np.maximum(flute, 0)), PAINT_EDGE_UNITS)
    vein = edge(np.abs(((around * 24 + 0.5) % 1) - 0.5) - 0.03, 0.03) + edge(
        np.abs(np.sin(y * 260 + 3 * flute)) - 0.25, 0.3
    )
    cobalt = np.maximum(cobalt, leaf * (0.9 - 0.55 * np.clip(vein, 0, 1)))
    brush = noise(point, 26.0, 4, 31, 0.7)
    flow = noise(point, 4.0, 3, 32)
    wash = np.clip(cobalt * (0.84 + 0.28 * brush + 0.14 * flow), 0, 1)
    glaze = linear_colour("D3D3CF") * (1 + 0.04 * flow + 0.03 * brush)[:, None]
    ink = mix(linear_colour("3F66B4"), linear_colour("10246B"), np.clip(wash * 1.1 - 0.2 + 0.2 * flow, 0, 1))
    pigment = mix(glaze, ink, np.clip(wash * 1.25, 0, 1))
    return Finish(pigment, 0.07, np.clip(0.04 + 0.10 * cobalt, 0, 1))


def _waves(u: Array, v: Array) -> Array:
    """Overlapping fans of concentric arcs (seigaiha)."""
    out = np.zeros_like(u)
    for row in range(-1, 3):
        level = np.floor(v) - row
        a = (u + 0.5 * (level % 2)) % 1 - 0.5
        r = np.hypot(a, (v - level) * 0.5 + 0.0)
        inside = (r < 0.5) & (v >= level)
        arcs = np.maximum(edge(np.abs(r - 0.45) - 0.035, 0.05), edge(np.abs(r - 0.30) - 0.03, 0.05))
        arcs = np.maximum(arcs, edge(r - 0.14, 0.05))
        out = np.where(inside, arcs, out)
    return out


def _rosettes(around: Array, y: Array) -> Array:
    """Flowers on the lobes of the relief, with leaves and curls between them."""
    column, out = around * 8, np.zeros_like(y)
    for level, shift in ((0.515, 0.5), (0.635, 0.0), (0.755, 0.5), (0.395, 0.0)):
        a = ((column - shift + 0.5) % 1 - 0.5) * 0.42
        b = y - level
        r, t = np.hypot(a, b), np.arctan2(b, a)
        petals = r - 0.052 * (0.72 + 0.28 * np.abs(np.cos(4 * t)))
        veins = edge(np.abs(np.sin(16 * t)) - 0.30, 0.4) * (r > 0.022)
        flower = (
            edge(petals, PAINT_EDGE_UNITS) * (1 - 0.6 * veins) * (1 - edge(np.abs(r - 0.021) - 0.004, PAINT_EDGE_UNITS))
        )
        out = np.maximum(out, flower * (1 - edge(r - 0.007, PAINT_EDGE_UNITS)))
        out = np.maximum(out, 0.85 * edge(np.abs(r - 0.066) - 0.0022, 0.004))
        c = ((column - shift) % 1 - 0.5) * 0.42
        curl = np.abs(np.hypot(c, b) - 0.018 - 0.010 * (np.arctan2(b, c) / np.pi)) - 0.0035
        out = np.maximum(out, 0.9 * edge(curl, 0.005) * (np.hypot(c, b) < 0.034))
        leaf = np.hypot(np.abs(c) - 0.058, b * 2.6) - 0.024
        out = np.maximum(out, 0.75 * edge(leaf, PAINT_EDGE_UNITS) * (1 - 0.6 * edge(np.abs(b) - 0.002, 0.004)))
    return out


def _lid(point: Array, normal: Array) -> Finish:
    """The lid: twelve petals with veins, a gilt knob and rim."""
    angle, y = np.arctan2(point[:, 0], point[:, 2]), point[:, 1]
    r = np.hypot(point[:, 0], point[:, 2])
    petal = np.cos(12 * angle)
    body = edge(np.abs(r - 0.215) - 0.105 * np.sqrt(np.maximum(petal * 0.9 + 0.1, 0)), PAINT_EDGE_UNITS)
    veins = edge(np.abs(np.sin(r * 170 + 5 * petal)) - 0.28, 0.35)
    cobalt = np.maximum(body * (0.95 - 0.6 * veins), edge(np.abs(r - 0.332) - 0.004, PAINT_EDGE_UNITS))
    dots = np.hypot((((angle / (2 * np.pi)) * 48) % 1 - 0.5) * 0.042, y - 1.122) - 0.009
    cobalt = np.maximum(cobalt * (y > 1.135), edge(dots, PAINT_EDGE_UNITS))
    brush, flow = noise(point, 30.0, 4, 41, 0.7), noise(point, 5.0, 3, 42)
    wash = np.clip(cobalt * (0.85 + 0.3 * brush), 0, 1)
    ink = mix(linear_colour("3F66B4"), linear_colour("10246B"), np.clip(wash - 0.1 + 0.2 * flow, 0, 1))
    pigment = mix(linear_colour("D3D3CF") * (1 + 0.04 * flow + 0.03 * brush)[:, None], ink, np.clip(1.2 * wash, 0, 1))
    gilt = np.maximum(edge(1.256 - y, PAINT_EDGE_UNITS), edge(np.abs(y - 1.099) - 0.006, 0.004)) * np.clip(
        0.97 + 0.1 * brush, 0, 1
    )
    pigment = mix(pigment, linear_colour("A8741F"), gilt)
    return Finish(pigment, 0.07 + 0.25 * gilt, np.clip(0.04 + 0.15 * gilt, 0, 1))


def _orange(point: Array, normal: Array) -> Finish:
    """A waxed orange: pores, and a green blush where its stalk was."""
    local = (point - ORANGE_SPHERE[0]) / ORANGE_SPHERE[1]
    pits = edge(0.30 - noise(local, 19.0, 1, 51), 0.5)
    cloud = noise(local, 2.6, 4, 52)
    pigment = mix(linear_colour("D9680E"), linear_colour("F2A01E"), np.clip(0.5 + 0.7 * cloud, 0, 1))
    pigment = mix(pigment, linear_colour("B84E06"), 0.45 * pits)
    pole = np.linalg.norm(local - np.array([0.35, 0.80, 0.49]), axis=1)
    pigment = mix(pigment, linear_colour("7F8C2A"), 0.7 * edge(pole - 0.20 - 0.1 * cloud, 0.30))
    pigment = mix(
        pigment,
        linear_colour("3F4A1A"),
        edge(pole - 0.075 + 0.02 * np.cos(5 * np.arctan2(local[:, 0] - 0.35, local[:, 2] - 0.49)), 0.03),
    )
    return Finish(pigment, 0.045, 0.3)


def _marble(point: Array, normal: Array) -> Finish:
    """A lacquered ball: bands of red and cream under a clear coat, with gold specks."""
    local = (point - MARBLE_SPHERE[0]) / MARBLE_SPHERE[1]
    tilted = local @ np.array([0.35, 0.85, -0.40])
    swirl = tilted * 5.5 + 0.9 * noise(local, 1.6, 3, 61)
    band = np.abs((swirl % 1) - 0.5) - 0.25
    pigment = mix(linear_colour("7E0F16"), linear_colour("F1DFBE"), edge(band, 0.05))
    pigment = mix(pigment, linear_colour("17181C"), edge(np.abs(band) - 0.035, 0.03))
    pigment = mix(pigment, linear_colour("C8921E"), edge(0.55 - noise(local, 9.0, 1, 62), 0.08))
    return Finish(pigment, 0.07, 0.0)


def _block(point: Array, normal: Array) -> Finish:
    """A wooden block: a letter in a frame on each side, and long grain."""
    c, s = np.cos(BLOCK_ANGLE_RADIANS), np.sin(BLOCK_ANGLE_RADIANS)
    frame = np.array([(c, 0, -s), (0, 1, 0), (s, 0, c)])
    local, facing = (point - BLOCK_CENTRE) @ frame.T / BLOCK_SIDE_UNITS, normal @ frame.T
    ring = np.sin(60 * np.hypot(local[:, 1] + 0.9, local[:, 2] - 1.3) + 4 * noise(local, 2.0, 3, 71))
    fibre = noise(local * (6, 60, 60), 1.0, 3, 72)
    pigment = mix(linear_colour("C08F55"), linear_colour("E6C48F"), np.clip(0.5 + 0.3 * ring + 0.3 * fibre, 0, 1))
    side = np.abs(facing).argmax(axis=1)
    a = np.where(side == 0, -np.sign(facing[:, 0]) * local[:, 2], local[:, 0])
    b = np.where(side == 1, -local[:, 2], local[:, 1])
    paint = np.array([linear_colour(code) for code in ("23508C", "2E6B3A", "A62B21")])[side]
    border = np.maximum(np.abs(a), np.abs(b))
    worn = np.clip(1.0 - 0.9 * np.maximum(noise(local, 12.0, 3, 73) - 0.18, 0), 0, 1)
    marks = edge(np.abs(border - 0.40) - 0.022, 0.02)
    for k, letter in enumerate(BLOCK_LETTERS):
        marks = np.maximum(marks, np.where(side == k, letter_mask(letter, a + 0.5, 0.5 - b), 0.0))
    pigment = mix(pigment, paint * (1 + 0.15 * fibre)[:, None], marks * worn)
    pigment = pigment * (1 - 0.35 * edge(0.485 - border, 0.02))[:, None]
    return Finish(pigment, 0.04, 0.8)


SURFACE_FINISHES: dict[str, FinishOf] = {
    "floor": _floor, "wall": _wall, "body": _body, "lid": _lid, "orange": _orange, "marble": _marble, "block": _block,
}  # fmt: skip
CLIP_FINISHES: dict[str, FinishOf] = {**SURFACE_FINISHES, "wall": _bare_wall, "sheet": _sheet}
BUMP_HEIGHTS: dict[str, Callable[[Array], Array]] = {  # heights, whose slope perturbs the normal
    "floor": lambda p: 0.0035 * noise(p, 9.0, 3, 14),
    "wall": lambda p: (
        0.005 * noise(p * (1.0, 3.2, 0), 11.0, 3, 23, 0.6) * (p[:, 1] > 0.23) * (_outside(p[:, 0], p[:, 1]) > 0)
    ),
    "body": lambda p: 0.0022 * noise(p, 7.0, 2, 35) + 0.0005 * noise(p, 42.0, 2, 36),
    "lid": lambda p: 0.0020 * noise(p, 8.0, 2, 43) + 0.0005 * noise(p, 46.0, 2, 44),
    "orange": lambda p: -0.005 * edge(0.30 - noise((p - ORANGE_SPHERE[0]) / ORANGE_SPHERE[1], 19.0, 1, 51), 0.6),
    "block": lambda p: 0.0015 * noise(p, 40.0, 2, 74),
}
