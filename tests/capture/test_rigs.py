"""Rigs of videos and RealityCapture: DeepView's models.json, LLFF beside videos, heading, pitch and roll."""

from __future__ import annotations

import json

import numpy as np
import pytest

from eigenfield.capture import open_any, open_capture
from eigenfield.capture.photographs.lens import Lens, source_positions
from eigenfield.capture.readers.deepview import read_deepview
from eigenfield.capture.readers.realitycapture import read_realitycapture
from eigenfield.core.errors import CaptureError, OptionError
from support import calibrations as write
from support.calibrations import HEIGHT, NAMES, WIDTH, stations
from support.named import write_video
from support.readers import check_cube, check_lens, stem

# the camera and the point of the data set's own description, and the pixel that it states for them
PUBLISHED = {
    "name": "camera_0001", "position": [0.003311238794086777, 0.000126384684934784, 0.42421246053630285],
    "orientation": [-0.03295944563072383, 0.02964606619481096, -0.03337751007195316],
    "focal_length": 1111.3638715594666, "pixel_aspect_ratio": 1.0,
    "principal_point": [1284.7296468363463, 925.4651609728676], "height": 1920.0, "width": 2560.0,
    "radial_distortion": [0.0970525284520715, -0.01708587111009977, 0.0], "projection_type": "fisheye",
}  # fmt: skip


def test_deepview_s_published_example(tmp_path):
    (tmp_path / "models.json").write_text(json.dumps([PUBLISHED]))
    (entry,) = read_deepview(tmp_path / "models.json").entries
    camera = entry.camera(2560, 1920, tmp_path)
    (pinhole,), _ = camera.project(np.array([[0.5, 0.5, 10.0]]))
    x, y, _ = source_positions(camera.K, entry.lens, 2560, 1920)  # of pixels whose centres are whole numbers
    at = np.floor(pinhole - 0.5).astype(int)
    weight = pinhole - 0.5 - at
    shown = []
    for picture in (x, y):
        corners = picture[at[1] : at[1] + 2, at[0] : at[0] + 2].astype(float)
        shown.append(np.array([1 - weight[1], weight[1]]) @ corners @ np.array([1 - weight[0], weight[0]]) + 0.5)
    assert np.allclose(shown, [1377.85525, 1017.61440], atol=2e-3)


def fisheye_pixels(s, radial, points):
    x, y, z = s.along(points).T
    theta = np.arctan2(np.hypot(x, y), z)
    r = theta * sum((1.0, *radial)[i] * theta ** (2 * i) for i in range(1 + len(radial))) / np.hypot(x, y)
    return np.stack([s.fx * x * r + s.cx, s.fy * y * r + s.cy], axis=1)


@pytest.mark.parametrize("radial", [(0.1, -0.02, 0.0), (0.05, 0.01), (), (0.02, 0.01, 0.004, 0.002)])
def test_deepview_lenses(tmp_path, radial):
    calibration = read_deepview(write.deepview(tmp_path, stations(), "fisheye", radial))
    for entry, s in zip(calibration.entries, stations(), strict=True):
        check_lens(entry, lambda points, s=s: fisheye_pixels(s, radial, points))
    if len(radial) < 4:
        flat = read_deepview(write.deepview(tmp_path, stations(), "perspective", radial))
        k1, k2, k3 = (*radial, 0.0, 0.0, 0.0)[:3]
        assert {entry.lens for entry in flat.entries} == {Lens("brown", (k1, k2, 0.0, 0.0, k3)) if radial else None}


@pytest.mark.parametrize(("change", "code"), [
    ({"projection_type": "equirectangular"}, "camera-model"),
    ({"projection_type": "perspective", "radial_distortion": [0.1, 0.1, 0.1, 0.1]}, "camera-model"),
    ({"orientation": [1, 2]}, "calibration-damaged"),
    ({"position": None}, "calibration-damaged"),
    ({"focal_length": True}, "calibration-damaged"),
    ({"name": 3}, "calibration-damaged"),
    ({"width": 0.5}, "camera-size"),
    ({"position": [1e999, 0, 0]}, "camera-not-finite"),
    ({"radial_distortion": [1e9]}, "lens"),
])  # fmt: skip
def test_a_camera_of_deepview_that_cannot_be_is_an_error_of_its_own(tmp_path, change, code):
    path = write.deepview(tmp_path, stations())
    cameras = json.loads(path.read_text())
    path.write_text(json.dumps([*cameras, PUBLISHED | change]))
    calibration = read_deepview(path)
    assert len(calibration.entries) == 4 and [error.code for error in calibration.errors] == [code]


def videos(folder, names):
    return [write_video(folder / f"{name}.mp4", 4, camera=i) for i, name in enumerate(names)]


def test_deepview_s_cameras_are_of_videos(tmp_path):
    """As it is published: a video more than there are cameras."""
    truth = videos(tmp_path, [name.removesuffix(".png") for name in NAMES] + ["e4"])
    path = write.deepview(tmp_path, stations())
    cameras = json.loads(path.read_text())
    for camera in cameras:  # of videos of 64 x 48
        camera |= {"width": 128.0, "height": 96.0}
    path.write_text(json.dumps(cameras))
    light_field = open_any(tmp_path, frame=2, work=tmp_path / "work")
    assert light_field.format == "deepview" and light_field.names == NAMES
    assert light_field.sizes == [(64, 48)] * 4
    assert "1 photograph has no calibration entry: e4.png" in light_field.problems
    for index in range(4):
        assert np.abs(light_field.photograph(index).pixels * 255 - truth[index][2]).mean() < 2
        K, s = light_field.cameras[index].K, stations()[index]
        assert np.allclose([K[0, 0], K[1, 1], K[0, 2], K[1, 2]], np.array([s.fx, s.fy, s.cx, s.cy]) / 2)
    assert len(open_capture(tmp_path / "models.json")) == 4
    assert "frame 0" in " ".join(open_capture(tmp_path, calibration=path).problems)


def test_llff_beside_videos(tmp_path):
    """Neural 3D Video: cam00.mp4 ... go with the rows in the order of their names."""
    names = ["cam00", "cam01", "cam02", "cam10"]
    truth = videos(tmp_path, names)
    write.llff(tmp_path, stations(True, True), full=4)
    path = tmp_path / "poses_bounds.npy"
    rows = np.load(path)
    rows[:, [4, 9]] = 4 * 48, 4 * 64  # height and width of the unreduced videos
    np.save(path, rows)
    light_field = open_any(tmp_path, frame="0.1s")
    assert light_field.format == "llff" and light_field.names == tuple(f"{name}.png" for name in names)
    for index, s in enumerate(stations(True, True)):
        assert np.abs(light_field.cameras[index].centre - s.eye).max() < 1e-9
        assert np.abs(light_field.photograph(index).pixels * 255 - truth[index][1]).mean() < 2
    (tmp_path / "images").mkdir()
    write.photographs(tmp_path / "images", size=(64, 48))
    with pytest.raises(OptionError, match=r"^frame means nothing"):  # there are photographs, which go first
        open_any(tmp_path, frame=1)
    assert open_any(tmp_path).names == NAMES


@pytest.mark.parametrize(
    "lens", [{"k1": -0.2, "k2": 0.05, "k3": -0.01}, {"k1": 0.1, "k4": 0.01, "t1": 0.01, "t2": -0.02}]
)
@pytest.mark.parametrize("separator", [",", ";"])
def test_realitycapture_lenses_and_principal_points(tmp_path, lens, separator):
    write.photographs(tmp_path / "images")
    all_stations = stations(square=True)
    calibration = read_realitycapture(write.realitycapture(tmp_path, all_stations, lens, "", separator))
    for entry, s in zip(calibration.entries, all_stations, strict=True):

        def pixels(points, s=s):
            x, y, z = s.along(points).T
            x, y = x / z, y / z
            q = x * x + y * y
            radial = 1 + sum(lens.get(f"k{i}", 0) * q**i for i in range(1, 5))
            t1, t2 = lens.get("t1", 0), lens.get("t2", 0)
            u = x * radial + t2 * (q + 2 * x * x) + 2 * t1 * x * y
            v = y * radial + t1 * (q + 2 * y * y) + 2 * t2 * x * y
            return np.stack([s.fx * u + s.cx, s.fx * v + s.cy], axis=1)

        check_lens(entry, pixels)


def test_realitycapture_at_no_rotation_looks_down_with_the_north_above(tmp_path):
    write.photographs(tmp_path / "images", size=(HEIGHT, WIDTH))
    (tmp_path / "a.csv").write_text("#name,x,y,alt,heading,pitch,roll,f,px,py\n" + "".join(
        f"{name},10,20,30,{turn},{pitch},0,36,0,0\n" for name, turn, pitch in zip(NAMES, (0, 90, 0, 90), (0, 0, 90, 90),
                                                                                strict=True)))  # fmt: skip
    calibration = read_realitycapture(tmp_path / "a.csv")
    down, heading_east, north, east = (entry.R for entry in calibration.entries)
    assert np.allclose(down, [[1, 0, 0], [0, -1, 0], [0, 0, -1]])  # right is east, down is south
    assert np.allclose(heading_east, [[0, -1, 0], [-1, 0, 0], [0, 0, -1]])  # right is south, down is west
    assert np.allclose(north[1:], [[0, 0, -1], [0, 1, 0]]) and np.allclose(east[1:], [[0, 0, -1], [1, 0, 0]])
    assert calibration.entries[0].intrinsics.focal == (WIDTH, WIDTH)  # the longer side, which is the height here
    assert np.allclose(calibration.entries[0].centre, (10, 20, 30))


@pytest.mark.parametrize(("text", "code"), [
    ("name,x\n", "calibration-damaged"),
    ("#name,longitude,latitude,alt,heading,pitch,roll,f\na,1,2,3,4,5,6,7\n", "calibration-damaged"),
    ("#name,x,y,alt,heading,pitch,roll,f\n", "calibration-empty"),
])  # fmt: skip
def test_realitycapture_files_that_are_none(tmp_path, text, code):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(CaptureError) as caught:
        read_realitycapture(tmp_path / "a.csv")
    assert caught.value.code == code


def test_realitycapture_names_photographs_that_are_missing(tmp_path):
    write.realitycapture(tmp_path, stations(True, True))
    write.photographs(tmp_path / "images", NAMES[:3])
    (line,) = open_capture(tmp_path).problems
    assert line.startswith("1 calibration entry has no photograph") and NAMES[3] in line
    assert stem(read_realitycapture(tmp_path / "alignment.csv").entries[0]) == "a0"
    check_cube(read_realitycapture(write.realitycapture(tmp_path, stations(True, True)[:3])), stations(True, True)[:3])
