"""A small light field in the layouts in which data sets have one: no data set is at hand, only what they describe."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.io import savemat

HEIGHT, WIDTH = 24, 32


def light_field(rows: int, columns: int, height: int = HEIGHT, width: int = WIDTH, step: int = 1) -> NDArray[np.uint8]:
    """(rows, columns, H, W, 3): a wall of smooth noise, of which each view sees a part `step` pixels further on, so
    that a point moves left and up as the camera moves right and down."""
    rng = np.random.default_rng(3)
    shape = height + step * (rows - 1) + 8, width + step * (columns - 1) + 8, 3
    wall = rng.uniform(0, 255, shape)
    for axis in (0, 1):
        wall = sum(np.roll(wall, shift, axis) for shift in range(-2, 3)) / 5
    wall = np.clip(128 + 2.5 * (wall - 128), 0, 255).astype(np.uint8)
    return np.stack(
        [
            np.stack([wall[step * r : step * r + height, step * c : step * c + width] for c in range(columns)])
            for r in range(rows)
        ]
    )


def shaded(views: NDArray[np.uint8], kept: int) -> NDArray[np.uint8]:
    """The same with dark views at the rim, as a lens makes them: all but the middle `kept` rows and columns."""
    rows, columns = views.shape[:2]
    top, left = (rows - kept) // 2, (columns - kept) // 2
    dark = (views // 4).astype(np.uint8)
    dark[top : top + kept, left : left + kept] = views[top : top + kept, left : left + kept]
    return dark


def write_quilt(path: Path, views: NDArray[np.uint8], columns: int) -> Path:
    """Views (N, H, W, C) as a quilt: the first at the bottom left, to the right, then up."""
    rows = len(views) // columns
    bands = [np.concatenate(list(views[row * columns : (row + 1) * columns]), axis=1) for row in range(rows)]
    Image.fromarray(np.concatenate(bands[::-1])).save(path)
    return path


def write_eslf(path: Path, views: NDArray[np.uint8]) -> Path:
    """Stanford's Lytro archives: below each lens a block of what each view sees there."""
    rows, columns, height, width = views.shape[:4]
    Image.fromarray(views.transpose(2, 0, 3, 1, 4).reshape(height * rows, width * columns, 3)).save(path)
    return path


def write_toolbox(path: Path, views: NDArray[np.uint8]) -> Path:
    """The Light Field Toolbox for MATLAB (EPFL, INRIA): `LF` of uint16 with weights as a fourth channel, and more."""
    weights = np.full((*views.shape[:4], 1), 65535, np.uint16)
    values = np.concatenate([views.astype(np.uint16) * 257, weights], axis=4)
    savemat(path, {"LF": values, "LensletGridModel": {"HSpacing": 14.3}, "WhiteImage": np.ones((5, 5))})
    return path


def write_matlab_73(path: Path, views: NDArray[np.uint8]) -> Path:
    """What MATLAB writes with -v7.3: HDF5 behind a head of 512 bytes, with the axes in reverse."""
    with h5py.File(path, "w", userblock_size=512) as file:
        data = file.create_dataset("LF", data=views.transpose(), compression="gzip")
        data.attrs["MATLAB_class"] = np.bytes_(b"uint8")
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")
    return path


def write_old_hci(path: Path, views: NDArray[np.uint8]) -> Path:
    """The HCI benchmark of 2013: `lf.h5`, with the ground truth beside the views."""
    with h5py.File(path, "w") as file:
        file["LF"] = views
        file["GT_DEPTH"] = np.ones(views.shape[:4], np.float32)
        file.attrs["dH"], file.attrs["focalLength"] = 0.1, 9.373
    return path
