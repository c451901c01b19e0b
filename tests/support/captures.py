"""Small captures with exact geometry, drawn and written to disk: what a new user's folder looks like."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from PIL import Image

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.png import png_bytes
from eigenfield.proxy import write_ply
from eigenfield.rendering import draw_texture
from eigenfield.runtime.files import write_bytes
from support.planes import everywhere, paint, photograph
from support.scenes import bumpy_square, row_grid, smooth_pictures


def shaded_texture(index: int, total: int, side: int = 128) -> np.ndarray:
    """(side, side, 3): fixed detail, and a highlight that wanders with the camera."""
    fixed = 0.5 + 0.2 * smooth_pictures(1, side, side, 3, seed=5)[0]
    y, x = np.mgrid[0:side, 0:side] / side
    fixed += 0.15 * np.sin(2 * np.pi * 9 * x)[..., None] * np.sin(2 * np.pi * 7 * y)[..., None]
    place = index / max(total - 1, 1)
    glow = np.exp(-((x - 0.2 - 0.6 * place) ** 2 + (y - 0.5) ** 2) / 0.02)
    return np.clip(fixed + 0.25 * glow[..., None], 0, 1).astype(np.float32)


def frame_of(camera: Camera, file_path: str) -> dict:
    """A transforms.json frame: camera-to-world with OpenGL axes."""
    pose = np.eye(4)
    pose[:3, :3] = camera.R.T @ np.diag([1, -1, -1])
    pose[:3, 3] = camera.centre
    K = camera.K
    return {
        "file_path": file_path, "fl_x": K[0, 0], "fl_y": K[1, 1], "cx": K[0, 2], "cy": K[1, 2],
        "w": camera.width, "h": camera.height, "transform_matrix": pose.tolist(),
    }  # fmt: skip


def backdrop() -> Mesh:
    """The bumpy square, wide enough to fill every frame of `row_grid`."""
    mesh = bumpy_square(12)
    return Mesh(mesh.vertices * np.array([2.7, 2.7, 2.0], np.float32), mesh.faces, mesh.uv)


def write_capture(folder: Path, cameras: tuple[Camera, ...] | None = None, mesh: Mesh | None = None) -> Path:
    """FOLDER/images/view_NN.png, FOLDER/transforms.json and FOLDER/proxy.ply; nine cameras on a grid by default."""
    cameras = row_grid(9, 64, 56) if cameras is None else cameras
    mesh = backdrop() if mesh is None else mesh
    (folder / "images").mkdir(parents=True)
    frames = []
    for index, camera in enumerate(cameras):
        picture = draw_texture(mesh, shaded_texture(index, len(cameras)), camera, samples=2)
        write_bytes(folder / "images" / f"view_{index:02d}.png", png_bytes(picture.image))
        frames.append(frame_of(camera, f"images/view_{index:02d}.png"))
    (folder / "transforms.json").write_text(json.dumps({"camera_model": "PINHOLE", "frames": frames}), encoding="utf-8")
    write_ply(mesh, folder / "proxy.ply")
    return folder


def write_array(folder, side=4, pixels=96):
    """Bare photographs of an array, named by row and column: a slanted plane and a square before it."""
    folder.mkdir(parents=True)
    row, column = (index.ravel() for index in np.mgrid[:side, :side])
    matrices = np.zeros((side * side, 3, 4))
    matrices[:, 0, 0] = matrices[:, 1, 1] = matrices[:, 2, 3] = 1
    matrices[:, 0, 2], matrices[:, 1, 2] = side // 2 - column, 0.9 * (side // 2 - row)
    square = lambda x, y: (abs(x - pixels / 2) < 20) & (abs(y - pixels / 2 + 6) < 18)  # noqa: E731
    layers = [(2.5, 0.0, 0.0, paint(5, detail=2.0), square), (-1.2, 0.0, 0.006, paint(6, detail=2.0), everywhere)]
    for r, c, picture in zip(row, column, photograph(layers, matrices, pixels), strict=True):
        Image.fromarray(picture).save(folder / f"view_{r:02d}_{c:02d}.png")
