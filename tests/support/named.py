"""Captures whose photographs' names say where they stand, and what is read of them."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

from eigenfield.capture import PhotoSet, open_any
from eigenfield.core.errors import EigenfieldError, OptionError

WIDTH, HEIGHT = 24, 16
CUBE = np.array([[x, y, z] for x in (-0.2, 0.3) for y in (-0.1, 0.2) for z in (2.0, 2.6)])


def picture(seed: int, width: int = WIDTH, height: int = HEIGHT) -> Image.Image:
    return Image.fromarray(np.random.default_rng(seed).integers(0, 256, (height, width, 3), np.uint8))


def write(folder: Path, names: list[str], **size: int) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for seed, name in enumerate(names):
        picture(seed, **size).save(folder / name)
    return folder


def nodes(photo_set: PhotoSet) -> dict[str, tuple[int, int]]:
    layout = photo_set.layout
    assert layout is not None
    return {s.name: (int(r), int(c)) for s, r, c in zip(photo_set.shots, layout.rows, layout.columns, strict=True)}


def places(photo_set: PhotoSet) -> dict[str, tuple[float, float]]:
    assert photo_set.layout is not None
    return {s.name: tuple(p) for s, p in zip(photo_set.shots, photo_set.layout.positions.tolist(), strict=True)}


def refused(code: str, path: Path, call=open_any, **options) -> EigenfieldError:
    with pytest.raises(EigenfieldError) as caught:
        call(path, **options)
    error = caught.value
    assert error.code == code and error.remedy and "\n" not in str(error), str(error)
    assert isinstance(error, OptionError) or error.path
    return error


CFG = """[intrinsics]
focal_length_mm = 100.0
image_resolution_x_px = 24
image_resolution_y_px = 16
sensor_size_mm = 35.0
fstop = 100.0
[extrinsics]
num_cams_x = 3
num_cams_y = 3
baseline_mm = 6.0
focus_distance_m = 1.25
center_cam_x_m = -1.0
[meta]
scene = cube
disp_min = -0.3
disp_max = 0.2
[unheard of]
key
"""


def hci(folder: Path, cfg: str | bytes | None = CFG, count: int = 9, **size: int) -> Path:
    write(folder, [f"input_Cam{i:03d}.png" for i in range(count)], **size)
    if cfg is not None:
        (folder / "parameters.cfg").write_bytes(cfg if isinstance(cfg, bytes) else cfg.encode())
    return folder


def write_video(path: Path, frames: int, rate: int = 10, camera: int = 0, codec: str = "libx264") -> list[np.ndarray]:
    """A gradient that grows brighter and changes its colour with every frame."""
    path.parent.mkdir(parents=True, exist_ok=True)
    width, height = 64, 48
    x = np.linspace(0, 1 - 0.1 * camera, width)[None, :, None] * np.ones((height, 1, 1))
    pictures = []
    with av.open(str(path), "w") as container:
        stream = container.add_stream(codec, rate=Fraction(rate), options={"crf": "4", "g": "5", "bf": "2"})
        stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
        for number in range(frames):
            colour = np.array([0.2 + 0.02 * number, 0.5 - 0.01 * number, 0.4])
            pictures.append(np.rint(255 * (0.2 + 0.8 * x) * colour).astype(np.uint8))
            for packet in stream.encode(av.VideoFrame.from_ndarray(pictures[-1], format="rgb24")):
                container.mux(packet)
        container.mux(stream.encode(None))
    return pictures
