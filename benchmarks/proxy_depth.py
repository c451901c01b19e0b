"""Depth maps beside true ones."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.read import decode
from eigenfield.stereo import depth_range, estimate_depth

BORDER = 15  # pixels that the HCI benchmark leaves out on every side
WIDE = (-12.0, 12.0)  # labels of the coarse sweep: pixels a step of the array


def hci_antinous(data: Path) -> dict[str, Any]:
    """Disparity of the centre view against the truth: BadPix in per cent, MSE times 100, as the benchmark counts."""
    folder = data / "hci_antinous_9x9"
    truth = _read_pfm(folder / "gt_disp_lowres.pfm")
    pictures, matrices = _hci_views(folder)
    started, work = time.perf_counter(), time.process_time()
    span = depth_range(pictures, matrices, truth.shape, WIDE)
    if span is None:
        raise SystemExit("no depth range was found")
    depth = estimate_depth(pictures, matrices, truth.shape, span)
    error = np.abs(depth - truth)[BORDER:-BORDER, BORDER:-BORDER]
    return {
        "range": [round(value, 2) for value in span],
        "bad_pixels_0.07": round(100 * float((error > 0.07).mean()), 2),
        "bad_pixels_0.1": round(100 * float((error > 0.1).mean()), 2),
        "bad_pixels_0.03": round(100 * float((error > 0.03).mean()), 2),
        "mse_x100": round(100 * float((error.astype(np.float64) ** 2).mean()), 2),
        "median_error": round(float(np.median(error)), 4),
        "seconds": round(time.perf_counter() - started, 1),
        "cpu_seconds": round(time.process_time() - work, 1),
    }


def _read_pfm(path: Path) -> NDArray[np.float32]:
    """A single-channel PFM picture, top row first."""
    with path.open("rb") as file:
        if file.readline().strip() != b"Pf":
            raise SystemExit(f"{path} is no single-channel PFM file")
        width, height = (int(word) for word in file.readline().split())
        order = "<f4" if float(file.readline()) < 0 else ">f4"
        values = np.frombuffer(file.read(4 * width * height), order).reshape(height, width)
    return values[::-1].astype(np.float32)


def _hci_views(folder: Path, side: int = 9) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """Photographs and matrices of an HCI array: a step to the right or down moves a point by -d pixels."""
    paths = [next(folder.glob(f"input_Cam{index:03d}.*")) for index in range(side * side)]
    pictures = np.stack([np.rint(decode(path)[0] * 255).astype(np.uint8) for path in paths])
    rows, columns = np.divmod(np.arange(side * side), side)
    matrices = np.zeros((side * side, 3, 4))
    matrices[:, 0, 0] = matrices[:, 1, 1] = matrices[:, 2, 3] = 1
    matrices[:, 0, 2], matrices[:, 1, 2] = side // 2 - columns, side // 2 - rows
    return pictures, matrices
