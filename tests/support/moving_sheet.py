"""A disc that flies before a wall, drawn by a ray-caster of its own; and the two sheets that show it exactly.

The wall is the static sheet. The disc is a height field over the middle camera's picture: its depth changes with time
and is the same all over, and where it is shows in the opacity alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import MovingProxy, Proxy, Sheets
from eigenfield.proxy.relief.find_lattice import lattice_of_camera
from support.coded_meshes import joined
from support.moving_clips import FootageInMemory
from support.observations import CalibratedInMemory, InMemory
from support.planes import look_up, paint

ROWS, COLUMNS, WIDTH, HEIGHT = 3, 5, 96, 72
FOCAL, SPACING = 110.0, 0.16
WALL_DEPTH, DISC_DEPTH, RADIUS = 4.0, 2.6, 0.34
MIDDLE = ROWS * COLUMNS // 2
ATLAS = 208  # texels a side, a texel for a pixel of the middle camera
WALL_PLACE, DISC_PLACE = (24, 28), (12, 126)  # column and row of the atlas at which the picture's (0, 0) lies
WALL_TEXTURE, DISC_TEXTURE = paint(11, detail=7.0) / 255, paint(4, detail=5.0) / 255
SAMPLES = 3  # a pixel, each way


def _cameras() -> tuple[Camera, ...]:
    K = np.array([[FOCAL, 0, WIDTH / 2], [0, FOCAL, HEIGHT / 2], [0, 0, 1.0]])
    made = []
    for index in range(ROWS * COLUMNS):
        row, column = divmod(index, COLUMNS)
        centre = np.array([SPACING * (column - COLUMNS // 2), SPACING * (row - ROWS // 2), 0.0])
        made.append(Camera(K, np.eye(3), -centre, WIDTH, HEIGHT))
    return tuple(made)


CAMERAS = _cameras()


def disc(frame: int) -> tuple[float, float, float]:
    """x, y and depth of the disc's middle."""
    return -0.62 + 0.14 * frame, 0.1 * np.sin(0.9 * frame), DISC_DEPTH - 0.06 * frame


def picture(camera: Camera, frame: int, moving: bool = True) -> NDArray[np.float32]:
    """(h, w, 3) what a camera sees; the wall is a little brighter from the right."""
    steps = (np.arange(SAMPLES) + 0.5) / SAMPLES
    v, u = np.meshgrid(
        (np.arange(HEIGHT)[:, None] + steps).ravel(), (np.arange(WIDTH)[:, None] + steps).ravel(), indexing="ij"
    )
    along = np.stack([(u - WIDTH / 2) / FOCAL, (v - HEIGHT / 2) / FOCAL])
    x, y = along * WALL_DEPTH + camera.centre[:2, None, None]
    shown = look_up(WALL_TEXTURE, x * 32, y * 32) * (0.95 + 0.1 * camera.centre[0] * np.sin(2 * x)[..., None])
    if moving:
        left, top, depth = disc(frame)
        x, y = along * depth + camera.centre[:2, None, None]
        x, y = x - left, y - top
        own = look_up(DISC_TEXTURE, x * 50 + 128, y * 50 + 128) * (1 + 0.2 * camera.centre[1])
        shown = np.where((x * x + y * y < RADIUS**2)[..., None], own, shown)
    mean = shown.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, 3).mean(axis=(1, 3))
    return mean.clip(0, 1).astype(np.float32)


def filmed(frames: int, noise: float = 0.0, frozen: int | None = None) -> FootageInMemory:
    """Footage of so many frames, with noise of so many grey levels; `frozen`: all of them are this one."""
    random, made = np.random.default_rng(5), []
    for frame in range(frames):
        seen = [picture(camera, frame if frozen is None else frozen) for camera in CAMERAS]
        noisy = [one + random.normal(0, noise / 255, one.shape) for one in seen] if noise else seen
        made.append(CalibratedInMemory(InMemory([one.clip(0, 1).astype(np.float32) for one in noisy]), CAMERAS))
    return FootageInMemory(made, [])


def _height_field(
    columns: NDArray[np.float64], rows: NDArray[np.float64], depth: float, place: tuple[int, int]
) -> Mesh:
    """A mesh over pixels of the middle camera, all at one depth."""
    v, u = np.meshgrid(rows, columns, indexing="ij")
    vertices = _points(u.ravel(), v.ravel(), depth)
    across = len(columns)
    corner = (np.arange(len(rows) - 1)[:, None] * across + np.arange(across - 1)).ravel()
    upper = np.stack([corner, corner + 1, corner + across], axis=1)
    lower = np.stack([corner + 1, corner + across + 1, corner + across], axis=1)
    uv = (np.stack([u.ravel() + place[0], v.ravel() + place[1]], axis=1)) / ATLAS
    return Mesh(vertices, np.concatenate([upper, lower]).astype(np.int32), uv.astype(np.float32))


def _points(u: NDArray[np.float64], v: NDArray[np.float64], depth: float) -> NDArray[np.float32]:
    along = np.stack([(u - WIDTH / 2) / FOCAL, (v - HEIGHT / 2) / FOCAL, np.ones_like(u)], axis=1)
    return (along * depth + CAMERAS[MIDDLE].centre).astype(np.float32)


def wall(spacing: int = 12) -> Mesh:
    """The static sheet, as far as any camera sees it, with a vertex every so many pixels."""
    columns, rows = np.arange(-23.5, 121, spacing), np.arange(-15.5, 81, spacing)
    return _height_field(columns, rows, WALL_DEPTH, WALL_PLACE)


def true_opacity(frame: int) -> NDArray[np.float32]:
    """(h, w) how much of each pixel of the middle camera the disc covers."""
    left, top, depth = disc(frame)
    fine = 8
    steps = (np.arange(fine) + 0.5) / fine
    v, u = np.meshgrid(
        (np.arange(HEIGHT)[:, None] + steps).ravel(), (np.arange(WIDTH)[:, None] + steps).ravel(), indexing="ij"
    )
    x, y = (u - WIDTH / 2) / FOCAL * depth - left, (v - HEIGHT / 2) / FOCAL * depth - top
    inside = (x * x + y * y < RADIUS**2).astype(np.float32)
    return inside.reshape(HEIGHT, fine, WIDTH, fine).mean(axis=(1, 3))


def chart_of_disc(opacity: NDArray[np.float32]) -> NDArray[np.float32]:
    """The part of an opacity over the atlas that the middle camera's picture is."""
    left, top = DISC_PLACE
    return opacity[top : top + HEIGHT, left : left + WIDTH]


def sheets(frames: int, opacity=true_opacity, spacing: int = 12) -> MovingProxy:
    """The wall, with a vertex every so many pixels, and before it the disc's sheet, whose opacity is opacity(frame),
    (h, w) over the middle camera."""
    columns, rows = np.arange(0.5, WIDTH, 8), np.arange(0.5, HEIGHT, 8)
    behind, before = wall(spacing), _height_field(columns, rows, disc(0)[2], DISC_PLACE)
    mesh, _ = joined([behind, before])
    v, u = np.meshgrid(rows, columns, indexing="ij")
    positions = np.stack([
        np.concatenate([behind.vertices, _points(u.ravel(), v.ravel(), disc(frame)[2])]) for frame in range(frames)
    ])  # fmt: skip
    opacities = np.zeros((frames, ATLAS, ATLAS), np.float32)
    opacities[:, : DISC_PLACE[1] - 6] = 1
    for frame in range(frames):
        chart_of_disc(opacities[frame])[:] = opacity(frame)
    lattice = lattice_of_camera(CAMERAS[MIDDLE].matrix, mesh, CAMERAS, 0.04)
    proxy = Proxy(mesh, lattice, Sheets((len(behind.faces), len(before.faces)), opacities[0]))
    return MovingProxy(proxy, positions, opacities)
