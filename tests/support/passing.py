"""Footage of a wall before which a square passes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from eigenfield.core.camera import Camera
from eigenfield.imaging.png import png_bytes
from support.captures import frame_of
from support.planes import everywhere, paint, photograph

SIDE, GRID, FRAMES = 96, 3, 7
BASELINE = 0.1  # between neighbours; a depth of BASELINE * SIDE is seen with a disparity of one pixel
WALL, SQUARE = BASELINE * SIDE / 1.0, BASELINE * SIDE / 3.5  # depths


def write_passing(folder: Path, cameras: int = GRID**2, noise: float = 1.0) -> Path:
    """FOLDER/cam_R_C/NNNNNN.png and transforms.json. No pixel sees the square, or what is beside it, in more than 2
    of 7 frames."""
    random = np.random.default_rng(3)
    rows, columns = (index.ravel() - GRID // 2 for index in np.mgrid[:GRID, :GRID])
    matrices = np.zeros((GRID**2, 3, 4))
    matrices[:, 0, 0] = matrices[:, 1, 1] = matrices[:, 2, 3] = 1
    matrices[:, 0, 2], matrices[:, 1, 2] = -columns, -rows
    wall = 1.0, 0.0, 0.0, paint(6, detail=2.0), everywhere
    entries = []
    for frame in range(FRAMES):
        middle = SIDE / 2 + 16 * (frame - FRAMES // 2)
        square = lambda x, y, middle=middle: (abs(x - middle) < 11) & (abs(y - SIDE / 2) < 18)  # noqa: E731
        drawn = photograph([(3.5, 0.0, 0.0, paint(5, detail=2.0), square), wall], matrices, SIDE)
        for row, column, picture in zip(rows[:cameras], columns[:cameras], drawn, strict=False):
            K = np.array([[SIDE, 0, SIDE / 2], [0, SIDE, SIDE / 2], [0, 0, 1.0]])
            camera = Camera(K, np.eye(3), -BASELINE * np.array([column, row, 0.0]), SIDE, SIDE)
            path = folder / f"cam_{row + 1}_{column + 1}" / f"{frame:06d}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            noisy = picture + random.normal(0, noise, picture.shape)
            path.write_bytes(png_bytes(np.clip(np.rint(noisy), 0, 255).astype(np.uint8)))
            entries.append(frame_of(camera, path.relative_to(folder).as_posix()) | {"time": frame / 10})
    (folder / "transforms.json").write_text(json.dumps({"frames": entries}), encoding="utf-8")
    return folder
