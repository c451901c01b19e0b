"""Lenses and focal lengths of transforms.json: in every form that nerfstudio and instant-ngp write, or refused."""

from __future__ import annotations

import math

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.capture import Lens, open_capture
from eigenfield.capture.readers.transforms import read_transforms
from support.transforms_files import HEIGHT, WIDTH, document, picture, refused, write

NAMES = ("k1", "k2", "k3", "k4", "p1", "p2")  # nerfstudio's order of distortion_params
VALUES = (0.12, 0.03, -0.01, 0.0, 0.004, -0.003)
BROWN = Lens("brown", (0.12, 0.03, 0.004, -0.003, -0.01))
NAMED = dict(zip(NAMES, VALUES, strict=True))


def lens_of(folder, top: dict, frame: dict) -> Lens | None:
    whole = document() | top
    for one in whole["frames"]:
        one |= frame
    (entries,) = {entry.lens for entry in read_transforms(write(folder, whole) / "transforms.json").entries}
    return entries


@pytest.mark.parametrize(("top", "frame", "lens"), [
    ({"camera_model": "OPENCV"} | NAMED, {}, BROWN),
    ({"camera_model": "OPENCV"}, NAMED, BROWN),
    ({"camera_model": "OPENCV"}, {"distortion_params": VALUES}, BROWN),
    ({"camera_model": "OPENCV", "distortion_params": VALUES}, {}, BROWN),
    ({"distortion_params": [0.5] * 6}, {"distortion_params": VALUES}, BROWN),  # a frame's own goes first
    ({"k1": 0.5}, {"distortion_params": VALUES}, BROWN),
    ({"distortion_params": [0.5] * 6}, NAMED, BROWN),
    ({"distortion_params": VALUES} | NAMED, {}, BROWN),  # both, and the same
    ({"distortion_params": VALUES} | dict.fromkeys(NAMES, 0), {}, BROWN),  # zeros beside it say nothing
    ({"distortion_params": [0] * 6}, {}, None),
    ({"distortion_params": None}, {}, None),
    ({"camera_model": "OPENCV_FISHEYE", "distortion_params": [1, 2, 3, 4, 0, 0]}, {}, Lens("fisheye", (1, 2, 3, 4))),
    ({"camera_model": "OPENCV_FISHEYE"}, {"k1": 1, "k4": 4}, Lens("fisheye", (1, 0, 0, 4))),
    ({"camera_model": "SIMPLE_RADIAL_FISHEYE", "k1": 1}, {}, Lens("fisheye", (1, 0, 0, 0))),
    ({"camera_model": "RADIAL_FISHEYE", "k1": 1, "k2": 2}, {}, Lens("fisheye", (1, 2, 0, 0))),
    ({"is_fisheye": True, "k3": 3, "p1": 0.0}, {}, Lens("fisheye", (0, 0, 3, 0))),
    ({"camera_model": "FULL_OPENCV", "k5": 5, "k6": 6, "k4": 4} | NAMED | {"k4": 4}, {},
     Lens("rational", (0.12, 0.03, 0.004, -0.003, -0.01, 4, 5, 6))),
    ({"camera_model": "FULL_OPENCV"} | NAMED, {}, BROWN),
    ({"camera_model": "OPENCV", "k5": 0.0, "k6": 6}, {"distortion_params": [1, 2, 3, 4, 5, 6]},
     Lens("rational", (1, 2, 5, 6, 3, 4, 0, 6))),
])  # fmt: skip
def test_every_form_of_a_lens(tmp_path, top, frame, lens):
    assert lens_of(tmp_path, top, frame) == lens


@pytest.mark.parametrize(("extra", "code", "words"), [
    ({"distortion_params": VALUES, "k1": 0.1}, "lens", "contradicts"),
    ({"distortion_params": [0.1] * 4}, "lens", "six numbers"),
    ({"distortion_params": [0.1] * 12}, "lens", "six numbers"),
    ({"distortion_params": "0.1"}, "lens", "six numbers"),
    ({"distortion_params": [0.1] * 5 + ["x"]}, "lens", "six numbers"),
    ({"distortion_params": [float("nan")] * 6}, "lens", "not finite"),
    ({"k5": float("inf")}, "lens", "not finite"),
    ({"k5": "x"}, "frame-number", "k5"),
    ({"k4": 0.1}, "camera-model", "k4"),
    ({"distortion_params": [0, 0, 0, 0.1, 0, 0]}, "camera-model", "k4"),
    ({"camera_model": "OPENCV_FISHEYE", "k5": 0.1}, "camera-model", "k5"),
    ({"camera_model": "OPENCV_FISHEYE", "p1": 0.1}, "camera-model", "p1"),
    ({"camera_model": "FISHEYE624"}, "camera-model", "FISHEYE624"),
    ({"s1": 0.1}, "camera-model", "s1"),
    ({"sx1": 0.1, "is_fisheye": True}, "camera-model", "sx1"),
    ({"ftheta_p1": 0.1}, "camera-model", "ftheta_p1"),
    ({"equirectangular": True}, "camera-model", "equirectangular"),
    ({"orthographic": True}, "camera-model", "orthographic"),
    ({"omega": 0.5}, "camera-model", "omega"),
])  # fmt: skip
def test_what_is_not_read_is_refused_by_name(tmp_path, extra, code, words):
    assert words in str(refused(code, write(tmp_path, document() | extra)))


@settings(max_examples=200)
@given(st.data())
def test_a_list_is_the_same_as_names(tmp_path_factory, data):
    folder = tmp_path_factory.getbasetemp() / "lists"
    values = [data.draw(st.sampled_from([0, -0.1, 0.25, 1e-3])) for _ in NAMES]
    more = {key: data.draw(st.sampled_from([0, 0.1])) for key in ("k5", "k6") if data.draw(st.booleans())}
    top = {"camera_model": data.draw(st.sampled_from(["OPENCV", "FULL_OPENCV", "OPENCV_FISHEYE", "PINHOLE"]))} | more
    plain = top | dict(zip(NAMES, values, strict=True))
    listed, in_frame = top | {"distortion_params": values}, top
    read = []
    for whole, frame in ((plain, {}), (listed, {}), (in_frame, {"distortion_params": values})):
        if not folder.exists():
            write(folder)
        calibration = read_transforms(write_only(folder, whole, frame))
        read.append(([e.lens for e in calibration.entries], [(e.code, e.message) for e in calibration.errors]))
    assert read[0] == read[1] == read[2]


def write_only(folder, top: dict, frame: dict):
    import json

    whole = document() | top
    whole["frames"] = [one | frame for one in whole["frames"]]
    (folder / "transforms.json").write_text(json.dumps(whole))
    return folder / "transforms.json"


def test_a_lens_of_eight_coefficients_is_removed_as_opencv_does(tmp_path):
    coefficients = (0.2, -0.1, 0.01, -0.02, 0.05, 0.1, 0.05, -0.02)
    keys = dict(zip(("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"), coefficients, strict=True))
    photograph = open_capture(write(tmp_path, document() | keys)).photograph(0)
    K = np.array([[50, 0, 5], [0, 48, 26.75], [0, 0, 1]])  # OpenCV counts pixel centres from 0
    maps = cv2.initUndistortRectifyMap(K, np.array(coefficients), np.eye(3), K, (WIDTH, HEIGHT), cv2.CV_32FC1)
    wanted = (
        cv2.remap(np.asarray(picture(0)).astype(np.float32), *maps, cv2.INTER_LINEAR, None, cv2.BORDER_REPLICATE) / 255
    )
    inside = np.ones((HEIGHT, WIDTH), bool) if photograph.mask is None else photograph.mask > 0
    assert inside.mean() > 0.5 and np.abs(photograph.pixels - wanted)[inside].max() < 0.02  # bicubic against bilinear


# focal length and angle


def angled(**changes) -> dict:
    """Cameras whose focal length is 50 pixels by fl_x and by the angle, but for the changes."""
    top = document()
    for frame in top["frames"]:
        frame |= {"fl_x": 50.0, "camera_angle_x": 2 * math.atan(WIDTH / 100), "fl_y": 50.0} | changes
    return top


@pytest.mark.parametrize("changes", [{}, {"camera_angle_y": 2 * math.atan(HEIGHT / 100)}, {"camera_angle_x": 0}, {
    "camera_angle_x": 53.1}, {"x_fov": 43.6028}, {"fl_x": 50.9}])  # fmt: skip
def test_a_focal_length_and_an_angle_that_agree_or_say_nothing(tmp_path, changes):
    light_field = open_capture(write(tmp_path, angled(**changes)))
    assert not light_field.problems
    assert light_field.cameras[0].K[0, 0] == changes.get("fl_x", 50)


@pytest.mark.parametrize(("changes", "words"), [
    ({"fl_x": 35.0}, "(35 and 50 pixels for v0.png)"),
    ({"camera_angle_x": 0.5}, "(50 and 78.33 pixels for v0.png)"),
    ({"camera_angle_y": 0.5}, "(50 and 58.74 pixels for v0.png)"),
    ({"camera_angle_x": None, "x_fov": 30}, "(50 and 74.64 pixels for v0.png)"),
])  # fmt: skip
def test_a_focal_length_and_an_angle_that_contradict_each_other(tmp_path, changes, words):
    light_field = open_capture(write(tmp_path, angled(**changes)))
    (line,) = light_field.problems
    assert line.startswith("4 cameras have a focal length and an angle") and words in line
    assert light_field.cameras[0].K[0, 0] == changes.get("fl_x", 50)


def test_a_focal_length_in_millimetres_is_refused(tmp_path):
    error = refused("camera-focal", write(tmp_path, angled(fl_x=1.5)))
    assert "1.5 pixels" in str(error) and "means 50 pixels" in str(error) and "millimetres" in str(error)
    assert "angle of view" in str(refused("camera-focal", write(tmp_path, document() | {"frames": [
        frame | {"fl_x": 1.5} for frame in document()["frames"]]})))  # fmt: skip
    fisheye = angled(fl_x=1.5) | {"is_fisheye": True}
    assert not open_capture(write(tmp_path, fisheye)).problems


def test_instant_ngps_angles_in_degrees(tmp_path):
    top = document()
    for frame in top["frames"]:
        del frame["fl_x"], frame["fl_y"]
        frame |= {"x_fov": math.degrees(2 * math.atan(WIDTH / 100)), "y_fov": math.degrees(2 * math.atan(HEIGHT / 96))}
    K = open_capture(write(tmp_path, top)).cameras[0].K
    assert np.allclose((K[0, 0], K[1, 1]), (50, 48))
