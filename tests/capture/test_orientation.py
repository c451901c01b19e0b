"""EXIF orientations whose size does not tell: applied or not, as the program does that wrote the calibration."""

from __future__ import annotations

import json

import numpy as np
import pytest
from PIL import Image

from eigenfield.capture import open_capture
from support import calibrations
from support.calibrations import HEIGHT, WIDTH, stations

STORED = ("colmap", "transforms", "llff", "bundler", "metashape")  # works on pixels as stored
TURNED = ("opencv", "strecha")


def write_colmap(folder, all_stations):
    from scipy.spatial.transform import Rotation

    images = []
    for i, s in enumerate(all_stations):
        rows, t = calibrations.world_to_camera(s)
        x, y, z, w = Rotation.from_matrix(rows).as_quat()
        images.append(f"{i + 1} {calibrations.words([w, x, y, z, *t])} 1 {s.name}\n\n")
    s = all_stations[0]
    (folder / "cameras.txt").write_text(f"1 PINHOLE {WIDTH} {HEIGHT} {s.fx} {s.fy} {s.cx} {s.cy}\n")
    (folder / "images.txt").write_text("".join(images))


def write_transforms(folder, all_stations):
    frames = []
    for s in all_stations:
        matrix = np.eye(4)
        matrix[:3, :3] = np.stack([s.right, -s.down, -s.forward], axis=1)
        matrix[:3, 3] = s.eye
        frames.append({"file_path": f"images/{s.name}", "transform_matrix": matrix.tolist()})
    (folder / "transforms.json").write_text(json.dumps({"fl_x": 90, "w": WIDTH, "h": HEIGHT, "frames": frames}))


WRITERS = {
    "colmap": write_colmap,
    "transforms": write_transforms,
    "llff": lambda folder, s: calibrations.llff(folder, s, full=1),
    "bundler": calibrations.bundler,
    "metashape": calibrations.metashape,
    "opencv": calibrations.opencv_files,
    "strecha": calibrations.strecha,
}


@pytest.mark.parametrize("orientation", [2, 3, 4])
@pytest.mark.parametrize("name", [*STORED, *TURNED])
def test_pixels_are_turned_where_the_calibrations_writer_turns_them(tmp_path, name, orientation):
    exif = Image.Exif()
    exif[0x0112] = orientation
    (tmp_path / "images").mkdir()
    pixels = np.random.default_rng(3).integers(0, 255, (HEIGHT, WIDTH, 3)).astype(np.uint8)
    for index, file in enumerate(calibrations.NAMES):
        given = {"exif": exif} if index != 1 else {}
        Image.fromarray(pixels).save(tmp_path / "images" / file, **given)
    WRITERS[name](tmp_path, stations(square=True, centred=True))
    light_field = open_capture(tmp_path)
    assert light_field.format == name
    flipped = {2: pixels[:, ::-1], 3: pixels[::-1, ::-1], 4: pixels[::-1]}[orientation]
    for index, shown in enumerate([flipped, pixels, flipped, flipped]):
        wanted = pixels if name in STORED else shown
        assert np.array_equal(np.rint(light_field.photograph(index).pixels * 255), wanted)
