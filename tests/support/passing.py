"""Footage of a wall before which a square passes, and of other planes that move."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.imaging.png import png_bytes
from support.captures import frame_of
from support.planes import everywhere, paint, photograph

SIDE, GRID, FRAMES = 96, 3, 7
BASELINE = 0.1  # between neighbours; a depth of BASELINE * SIDE is seen with a disparity of one pixel
WALL_LABEL, SQUARE_LABEL = 1.0, 3.5  # disparities
WALL, SQUARE = BASELINE * SIDE / WALL_LABEL, BASELINE * SIDE / SQUARE_LABEL  # depths
HALF_WIDTH, HALF_HEIGHT = 11, 18  # of the square


def matrices_of(grid: int = GRID) -> NDArray[np.float64]:
    """(V, 3, 4) from (x, y, disparity, 1) to the pixels of each camera."""
    rows, columns = (index.ravel() - grid // 2 for index in np.mgrid[:grid, :grid])
    matrices = np.zeros((grid**2, 3, 4))
    matrices[:, 0, 0] = matrices[:, 1, 1] = matrices[:, 2, 3] = 1
    matrices[:, 0, 2], matrices[:, 1, 2] = -columns, -rows
    return matrices


def wall(seed: int = 6):
    """A layer of `photograph` behind all others."""
    return WALL_LABEL, 0.0, 0.0, paint(seed, detail=2.0), everywhere


def square(middle: float, seed: int = 5):
    """A layer of `photograph`: a square whose middle is in that column of the middle camera's picture."""
    inside = lambda x, y: (abs(x - middle) < HALF_WIDTH) & (abs(y - SIDE / 2) < HALF_HEIGHT)  # noqa: E731
    return SQUARE_LABEL, 0.0, 0.0, paint(seed, detail=2.0), inside


def column(frame: int) -> float:
    """Of the middle of the square that passes."""
    return SIDE / 2 + 16 * (frame - FRAMES // 2)


def write_passing(folder: Path, cameras: int = GRID**2, noise: float = 1.0) -> Path:
    """FOLDER/cam_R_C/NNNNNN.png and transforms.json. No pixel sees the square, or what is beside it, in more than 2
    of 7 frames."""
    return write_planes(folder, FRAMES, lambda frame: [square(column(frame)), wall()], cameras, noise)


def write_planes(
    folder: Path,
    frames: int,
    layers: Callable[[int], list],
    cameras: int = GRID**2,
    noise: float = 1.0,
    light: Callable[[int], float] = lambda frame: 1.0,
) -> Path:
    """FOLDER/cam_R_C/NNNNNN.png and transforms.json.

    Args:
        layers: Of `photograph`, in each frame.
        light: Factor of all colours in each frame.
    """
    random = np.random.default_rng(3)
    rows, columns = (index.ravel() - GRID // 2 for index in np.mgrid[:GRID, :GRID])
    entries = []
    for frame in range(frames):
        drawn = photograph(layers(frame), matrices_of(), SIDE)
        for row, place, picture in zip(rows[:cameras], columns[:cameras], drawn, strict=False):
            K = np.array([[SIDE, 0, SIDE / 2], [0, SIDE, SIDE / 2], [0, 0, 1.0]])
            camera = Camera(K, np.eye(3), -BASELINE * np.array([place, row, 0.0]), SIDE, SIDE)
            path = folder / f"cam_{row + 1}_{place + 1}" / f"{frame:06d}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            noisy = light(frame) * picture + random.normal(0, noise, picture.shape)
            path.write_bytes(png_bytes(np.clip(np.rint(noisy), 0, 255).astype(np.uint8)))
            entries.append(frame_of(camera, path.relative_to(folder).as_posix()) | {"time": frame / 10})
    (folder / "transforms.json").write_text(json.dumps({"frames": entries}), encoding="utf-8")
    return folder
