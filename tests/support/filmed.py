"""Footage whose pictures say which camera and which frame they are."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from PIL import Image

from eigenfield.capture import Footage, open_path

WIDTH, HEIGHT = 16, 12
CALIBRATION_FILE = "transforms.json"


def colour(camera: int, frame: int) -> tuple[int, int, int]:
    """Of the picture that a camera takes at a frame."""
    return 20 * camera + 10, 3 * frame + 5, 77


def picture(path: Path, camera: int, frame: int, size: tuple[int, int] = (WIDTH, HEIGHT)) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.new("RGB", size, colour(camera, frame)).save(path)
    return path


def seen(footage: Footage, instant: int) -> list[tuple[int, int, bool]]:
    """Camera, frame and whether the picture counts, of all cameras at an instant."""
    capture, found = footage.instant(instant), []
    for index in range(len(footage.names)):
        photograph = capture.photograph(index)
        red, green, _ = photograph.pixels.reshape(-1, 3).mean(axis=0) * 255
        counts = photograph.mask is None or bool(photograph.mask.any())
        found.append((round((red - 10) / 20), round((green - 5) / 3), counts))
    return found


def folder_a_camera(root: Path, cameras: int = 3, frames: int = 5, first: int = 0) -> Path:
    for camera in range(cameras):
        for frame in range(frames):
            picture(root / f"cam_{camera}" / f"{first + frame:06d}.png", camera, frame)
    return root


def folder_an_instant(root: Path, cameras: int = 3, frames: int = 5) -> Path:
    for frame in range(frames):
        for camera in range(cameras):
            picture(root / f"{frame:04d}" / f"cam_{camera}.png", camera, frame)
    return root


def pose(camera: int) -> list[list[float]]:
    return [[1.0, 0, 0, 0.1 * camera], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def calibration(path: Path, files: dict[int, list[tuple[str, float | None]]], **top: float) -> Path:
    """A transforms.json: files and times by camera."""
    frames = [
        {"file_path": file, "transform_matrix": pose(camera)} | ({} if time is None else {"time": time})
        for camera, entries in files.items()
        for file, time in entries
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"fl_x": 20.0, "w": WIDTH, "h": HEIGHT, "frames": frames, **top}), encoding="utf-8")
    return path


def timed(root: Path, cameras: int = 3, frames: int = 5, rate: float = 25.0, **top: float) -> Path:
    """A folder a camera, with a transforms.json whose frames state a time."""
    folder_a_camera(root, cameras, frames)
    files = {c: [(f"cam_{c}/{f:06d}.png", f / rate) for f in range(frames)] for c in range(cameras)}
    calibration(root / CALIBRATION_FILE, files, **top)
    return root


def video(path: Path, camera: int, times: dict[int, int], size: tuple[int, int] = (WIDTH, HEIGHT)) -> Path:
    """A video without loss whose frames are shown at given milliseconds, by their numbers."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with av.open(str(path), "w") as container:
        stream = container.add_stream("ffv1", rate=1000, options={"g": "4"})
        (stream.width, stream.height), stream.pix_fmt, stream.time_base = size, "bgr0", Fraction(1, 1000)
        for number, time in times.items():
            pixels = np.full((size[1], size[0], 3), colour(camera, number), np.uint8)
            frame = av.VideoFrame.from_ndarray(pixels, format="rgb24")
            frame.pts, frame.time_base = time, Fraction(1, 1000)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path


def opened(path: Path, clip: str = ":", **options: object) -> Footage:
    footage = open_path(path, clip=clip, **options)
    assert isinstance(footage, Footage)
    return footage
