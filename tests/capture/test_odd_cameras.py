"""Cameras that are not as they should be: poses with a scale or few digits, degrees, principal points outside."""

from __future__ import annotations

import json

import numpy as np
import pytest

from eigenfield.capture import open_capture
from eigenfield.capture.calibration import split_scale
from eigenfield.capture.readers.deepview import read_deepview
from eigenfield.capture.readers.opencv import read_opencv
from support import calibrations as write
from support.calibrations import CUBE, WIDTH, stations
from support.transforms_files import camera, document, pose, refused, rotation
from support.transforms_files import write as write_transforms


def transforms(change) -> dict:
    top = document()
    for i, frame in enumerate(top["frames"]):
        frame["transform_matrix"] = change(np.array(pose(camera(i)))).tolist()
    return top


def scaled(by):
    return lambda matrix: matrix @ np.diag([*np.broadcast_to(by, 3), 1])


@pytest.mark.parametrize(("change", "words"), [
    (scaled(2), "4 cameras have a pose with a scale (2 for v0.png), which is divided out"),
    (scaled(0.01), "4 cameras have a pose with a scale (0.01 for v0.png), which is divided out"),
    (lambda matrix: scaled(2)(matrix).round(3), "a scale (2 for v0.png)"),
    (lambda matrix: matrix.round(3), "cameras have rotations of few digits (that of v"),
    (lambda matrix: matrix.round(5), None),
])  # fmt: skip
def test_uniform_scale_and_three_decimals_are_taken_out(tmp_path, change, words):
    opened = open_capture(write_transforms(tmp_path, transforms(change)))
    assert [words in line for line in opened.problems] == ([True] if words else [])
    for i, view in enumerate(opened.views):
        assert (
            np.abs(view.camera.R - camera(i).R).max() < 1e-3
            and np.abs(view.camera.centre - camera(i).centre).max() < 1e-3
        )
        assert np.abs(view.camera.R @ view.camera.R.T - np.eye(3)).max() < 1e-12


@pytest.mark.parametrize("by", [(-1, 1, 1), (1, 1, 1.01), (1, 0, 1), (-2, -2, -2), 0])
def test_mirrored_and_sheared_poses_are_refused(tmp_path, by):
    refused("camera-not-rotation", write_transforms(tmp_path, transforms(scaled(by))))


def test_two_decimals_are_refused(tmp_path):
    refused("camera-not-rotation", write_transforms(tmp_path, transforms(lambda matrix: matrix.round(2))))


@pytest.mark.parametrize("name", ["opencv", "bundler", "middlebury", "strecha", "llff"])
def test_scaled_world_to_camera_matrices_keep_their_centres(tmp_path, name, monkeypatch):
    """P is up to scale: [2 R | 2 t] is the same camera, and [2 A | c] one of camera-to-world."""
    from support.readers import WRITERS

    twice = write.Station.__init__

    writer, reader = WRITERS[name]
    plain = {entry.file: entry for entry in reader(writer(tmp_path / "a")).entries}

    def double(self, name, eye, right, down, forward, *optics):
        twice(self, name, eye, 2 * right, 2 * down, 2 * forward, *optics)

    monkeypatch.setattr(write.Station, "__init__", double)
    for entry in reader(writer(tmp_path / "b")).entries:
        one, other = (e.camera(WIDTH, WIDTH, tmp_path) for e in (plain[entry.file], entry))
        assert split_scale(entry.R)[1] == pytest.approx(2)
        assert np.abs(one.project(CUBE)[0] - other.project(CUBE)[0]).max() < 1e-6


@pytest.mark.parametrize("factor", [1, 180 / np.pi])
def test_rotation_vectors_in_degrees_are_refused(tmp_path, factor):
    """One that is too long tells of the others of its file, which could be either."""
    cameras = {}
    for s in stations():
        K, _, R, T = write.opencv_numbers(s, ())
        cameras[s.name[:-4]] = {
            "K": K,
            "rvec": (factor * write.axis_angle(R)).ravel().tolist(),
            "tvec": T.ravel().tolist(),
        }
    path = tmp_path / "rig.json"
    path.write_text(json.dumps(cameras))
    models = write.deepview(tmp_path, stations())
    turned = [
        c | {"orientation": (factor * np.array(c["orientation"])).tolist()} for c in json.loads(models.read_text())
    ]
    models.write_text(json.dumps(turned))
    for read, file in ((read_opencv, path), (read_deepview, models)):
        calibration = read(file)
        assert {error.code for error in calibration.errors} == ({"camera-rotation-vector"} if factor != 1 else set())
        assert len(calibration.errors) == (4 if factor != 1 else 0)
        assert all("a0" in error.message and "degrees" in error.message for error in calibration.errors[:1])


@pytest.mark.parametrize("key", ["euler", "rotation_deg", "rpy", "euler_angles"])
def test_angles_are_refused_by_their_key(tmp_path, key):
    K, _, _, T = write.opencv_numbers(stations()[0], ())
    path = tmp_path / "rig.json"
    path.write_text(json.dumps({"a0": {"K": K, key: [1, 2, 3], "T": T.ravel().tolist()}}))
    (error,) = read_opencv(path).errors
    assert error.code == "camera-rotation-vector" and key in error.message


@pytest.mark.parametrize(("cx", "cy", "sized", "outside"), [
    (400, 300, False, True), (40, 30, False, True), (0.5, 0.5, True, True), (0, 0, True, True), (-3, 15, True, True),
    (20, 31, True, True), (0.5, 15, True, False), (5.5, 27, False, False), (39.5, 0.5, True, True),
])  # fmt: skip
def test_a_principal_point_outside_or_in_the_corner_is_said(tmp_path, cx, cy, sized, outside):
    top = document()
    for frame in top["frames"]:
        frame |= {"cx": cx, "cy": cy}
        if not sized:
            del frame["w"], frame["h"]
    problems = open_capture(write_transforms(tmp_path, top)).problems
    assert len(problems) == outside
    if outside:
        assert f"(({cx:.4g}, {cy:.4g}) of 40x30 for v0.png)" in problems[0]
        assert ("gives no width and height" in problems[0]) != sized


def test_small_turns_have_no_scale():
    """What was read before is read bit by bit as before."""
    R = rotation(0.1, 0.2, 0.3)
    for matrix in (R, R.round(6), R * (1 + 5e-5), np.full((3, 3), np.nan), np.zeros((3, 3)), R * 1e200):
        found, scale = split_scale(matrix)
        assert found is matrix and scale == 1
