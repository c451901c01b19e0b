"""Captures with a transforms.json, written by hand."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from eigenfield.capture import open_capture
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError

WIDTH, HEIGHT = 40, 30


def rotation(x: float, y: float, z: float) -> np.ndarray:
    return cv2.Rodrigues(np.array([x, y, z]))[0]


def camera(index: int) -> Camera:
    R = rotation(0.05 * index, -0.1 * index, 0.02)
    K = np.array([[50.0 + index, 0, 5.5], [0, 48.0, 27.25], [0, 0, 1]])  # principal point far off the middle
    return Camera(K, R, -R @ np.array([0.5 * index, 0.1 * index**2, -3.0]), WIDTH, HEIGHT)


def pose(of: Camera) -> list[list[float]]:
    """Camera-to-world, OpenGL axes."""
    matrix = np.eye(4)
    matrix[:3, :3] = of.R.T * [1, -1, -1]
    matrix[:3, 3] = of.centre
    return matrix.tolist()


def document(count: int = 4, extension: str = ".png") -> dict:
    frames = []
    for i in range(count):
        K = camera(i).K
        frames.append({
            "file_path": f"images/v{i}{extension}", "fl_x": K[0, 0], "fl_y": K[1, 1], "cx": K[0, 2], "cy": K[1, 2],
            "w": float(WIDTH), "h": HEIGHT, "transform_matrix": pose(camera(i)), "sharpness": 3.0,
        })  # fmt: skip
    return {"camera_model": "PINHOLE", "frames": frames}


def picture(index: int = 0, width: int = WIDTH, height: int = HEIGHT) -> Image.Image:
    y, x = np.mgrid[0:height, 0:width]
    return Image.fromarray(
        np.stack([x * 255 // width, y * 255 // height, 0 * x + 20 * index], axis=-1).astype(np.uint8)
    )


def write(folder: Path, top: dict | None = None, count: int = 4, images: str = "images") -> Path:
    (folder / images).mkdir(parents=True, exist_ok=True)
    for i in range(count):
        picture(i).save(folder / images / f"v{i}.png")
    (folder / "transforms.json").write_text(json.dumps(document(count) if top is None else top), encoding="utf-8")
    return folder


def refused(code: str, *args, **options) -> CaptureError:
    with pytest.raises(CaptureError) as caught:
        open_capture(*args, **options)
    error = caught.value
    assert error.code == code and error.path and error.remedy and "\n" not in str(error), str(error)
    return error
