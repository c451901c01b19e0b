"""A still capture as a clip in which nothing moves: its photographs again and again, each time with fresh noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eigenfield.capture import LightField
from eigenfield.demo.clip import is_drawn, write_timed
from eigenfield.imaging.png import png_bytes
from eigenfield.runtime.files import write_bytes
from eigenfield.runtime.parallel import parallel_map

SIGMA_LEVELS = 2.0  # grey levels of the noise
SEED = 20190916


def repeat(capture: LightField, folder: Path, frames: int = 60) -> Path:
    """The clip's folder, made where it is not there yet: `CAMERA/NNNNNN.png` and transforms.json with times.

    Args:
        capture: Photographs with cameras; lenses are removed.
        folder: For the clip.
        frames: How often.
    """
    if is_drawn(folder):
        return folder
    names = [Path(name).stem for name in capture.names]

    def write(index: int) -> None:
        place = folder / names[index]
        place.mkdir(parents=True, exist_ok=True)
        levels = capture.photograph(index).pixels * np.float32(255)
        random = np.random.default_rng([SEED, index])
        for frame in range(frames):
            noisy = levels + random.normal(0, SIGMA_LEVELS, levels.shape).astype(np.float32)
            data = png_bytes(np.clip(np.rint(noisy), 0, 255).astype(np.uint8))
            write_bytes(place / f"{frame:06d}.png", data, overwrite=True)

    parallel_map(write, range(len(capture)))
    write_timed(folder, names, capture.cameras, frames)
    return folder
