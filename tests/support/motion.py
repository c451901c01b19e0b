"""A drawn scene that structure from motion can be tried on: hills with spots, seen along an arc."""

from __future__ import annotations

from pathlib import Path

import av
import cv2
import numpy as np

from eigenfield.capture import LightField, PhotoSet, Shot
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.png import png_bytes
from eigenfield.rendering import draw_texture
from eigenfield.runtime.files import write_bytes

WIDTH, HEIGHT = 320, 240
K = np.array([[300.0, 0, 165], [0, 302, 118], [0, 0, 1]])


def spotted(seed: int, side: int = 768) -> np.ndarray:
    """(side, side, 3): discs of many sizes, which SIFT likes."""
    random = np.random.default_rng(seed)
    picture = np.full((side, side, 3), 128, np.uint8)
    for radius in (60, 30, 16, 9, 6):
        for _ in range(int(40000 / radius**1.6)):
            x, y = random.integers(0, side, 2)
            colour = tuple(int(c) for c in random.integers(0, 256, 3))
            cv2.circle(picture, (int(x), int(y)), int(random.integers(radius // 2, radius)), colour, -1, cv2.LINE_AA)
    return picture.astype(np.float32) / 255


def relief(nodes: int = 24) -> Mesh:
    """A square of side 4 with hills as high as a quarter of the cameras' distance."""
    steps = np.linspace(0, 1, nodes)
    v, u = np.meshgrid(steps, steps, indexing="ij")
    x, y = 4 * u - 2, 4 * v - 2
    z = 0.4 * np.sin(2.5 * x) * np.cos(2 * y) + 0.2 * np.sin(5 * y + x)
    corner = (np.arange(nodes - 1)[:, None] * nodes + np.arange(nodes - 1)).ravel()
    upper = np.stack([corner, corner + 1, corner + nodes], axis=1)
    lower = np.stack([corner + 1, corner + nodes + 1, corner + nodes], axis=1)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3).astype(np.float32)
    faces = np.concatenate([upper, lower]).astype(np.int32)
    return Mesh(vertices, faces, np.stack([u, v], axis=-1).reshape(-1, 2).astype(np.float32))


def looking(centre: np.ndarray, at: np.ndarray) -> Camera:
    z = (at - centre) / np.linalg.norm(at - centre)
    x = np.cross([0.0, 1, 0], z)
    x /= np.linalg.norm(x)
    R = np.stack([x, np.cross(z, x), z])
    return Camera(K, R, -R @ centre, WIDTH, HEIGHT)


def cameras(count: int) -> list[Camera]:
    """On a wavy arc before the relief, all looking at its middle."""
    angles = np.linspace(-0.45, 0.45, count)
    return [
        looking(np.array([3 * np.sin(a), 0.3 * np.cos(7 * a), -3 * np.cos(a)]), np.array([0.1 * a, 0, 0]))
        for a in angles
    ]


def photographed(folder: Path) -> tuple[PhotoSet, LightField]:
    """Five photographs in a new folder, and the truth."""
    folder.mkdir()
    mesh, texture = relief(), spotted(1)
    shots = []
    views = cameras(5)
    for index, camera in enumerate(views):
        path = folder / f"shot_{index}.png"
        write_bytes(path, png_bytes(draw_texture(mesh, texture, camera, samples=1).image))
        shots.append(Shot(path.name, path, WIDTH, HEIGHT))
    photos = PhotoSet(folder, tuple(shots), None, (), "folder")
    return photos, photos.with_cameras(views)


def film(path: Path, frames: int = 48) -> None:
    """A walk along the arc."""
    mesh, texture = relief(), spotted(1)
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=24, options={"crf": "12"})
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
        for camera in cameras(frames):
            shown = np.rint(255 * draw_texture(mesh, texture, camera, samples=1).image).astype(np.uint8)
            container.mux(stream.encode(av.VideoFrame.from_ndarray(shown, format="rgb24")))
        container.mux(stream.encode(None))


def picture(folder: Path, name: str, pixels: np.ndarray) -> Shot:
    write_bytes(folder / name, png_bytes(pixels.astype(np.float32)))
    return Shot(name, folder / name, pixels.shape[1], pixels.shape[0])
