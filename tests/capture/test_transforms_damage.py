"""transforms.json: every way in which it can be wrong."""

from __future__ import annotations

import copy
import json

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from eigenfield.capture import open_capture
from eigenfield.capture.readers.transforms import read_transforms
from eigenfield.core.errors import CaptureError
from support.transforms_files import document, picture, refused, write

# damage


def changed(path: str, value) -> dict:
    top = document()
    *steps, last = path.split("/")
    at = top
    for step in steps:
        at = at[int(step) if step.isdigit() else step]
    at[int(last) if last.isdigit() else last] = value
    return top


@pytest.mark.parametrize(("path", "value", "code"), [
    ("frames", {}, "calibration-json"),
    ("frames", [], "calibration-empty"),
    ("frames/1", 3, "frame-not-object"),
    ("frames/1/file_path", 3, "frame-file"),
    ("frames/1/file_path", "a\0b", "frame-file"),
    ("frames/1/transform_matrix", None, "frame-pose"),
    ("frames/1/transform_matrix", [[1, 0], [0]], "frame-pose"),
    ("frames/1/transform_matrix/0/0", "1.0", "frame-pose"),
    ("frames/1/transform_matrix/0/0", True, "frame-pose"),
    ("frames/1/transform_matrix/3/0", 0.5, "frame-pose"),
    ("frames/1/transform_matrix/0/0", float("nan"), "camera-not-finite"),
    ("frames/1/transform_matrix/0/3", 10**400, "camera-not-finite"),
    ("frames/1/transform_matrix/0/0", 5.0, "camera-not-rotation"),
    ("frames/1/fl_x", 0, "camera-focal"),
    ("frames/1/fl_x", "550", "frame-number"),
    ("frames/1/cx", [1], "frame-number"),
    ("frames/1/w", -3, "frame-size"),
    ("frames/1/w", 1e12, "frame-size"),
    ("frames/1/w", float("nan"), "frame-size"),
    ("frames/1/mask_path", 7, "frame-mask"),
    ("frames/1/mask_path", "none.png", "mask-missing"),
    ("camera_model", "EQUIRECTANGULAR", "camera-model"),
    ("k4", 0.1, "camera-model"),
    ("k1", float("inf"), "lens"),
    ("applied_transform", "no", "frame-pose"),
    ("applied_scale", 0, "applied-transform"),
])  # fmt: skip
def test_wrong_values_are_refused(tmp_path, path, value, code):
    error = refused(code, write(tmp_path, changed(path, value)))
    assert error.path == str(tmp_path / "transforms.json")
    if path.startswith("frames/1"):
        assert "frame 1" in str(error)


def test_a_reflection_is_no_rotation(tmp_path):
    top = document()
    matrix = np.array(top["frames"][2]["transform_matrix"])
    matrix[:3, 0] *= -1
    top["frames"][2]["transform_matrix"] = matrix.tolist()
    assert "images/v2.png" in str(refused("camera-not-rotation", write(tmp_path, top)))


def test_frames_without_any_focal_length(tmp_path):
    top = document()
    del top["frames"][0]["fl_x"], top["frames"][0]["fl_y"]
    assert "fl_x" in str(refused("frame-focal", write(tmp_path, top)))


@pytest.mark.parametrize(
    "data", [b"", b"{", b"[]", b"3", b"\xff\xfe", b"[" * 100_000, b'{"frames": ' + b"9" * 5000 + b"}"]
)
def test_broken_json(tmp_path, data):
    write(tmp_path)
    (tmp_path / "transforms.json").write_bytes(data)
    refused("calibration-json", tmp_path)


def test_a_huge_json_is_not_read(tmp_path, monkeypatch):
    write(tmp_path)
    monkeypatch.setattr("eigenfield.capture.readers.transforms.TRANSFORMS_MAX_BYTES", 100)
    refused("calibration-too-large", tmp_path)


def test_what_is_no_capture(tmp_path):
    refused("capture-missing", tmp_path / "nowhere")
    refused("calibration-missing", tmp_path)
    picture().save(tmp_path / "a.png")
    refused("calibration-unknown", tmp_path / "a.png")
    refused("capture-missing", tmp_path / "nowhere", calibration=tmp_path)
    refused("capture-missing", write(tmp_path / "good"), calibration=tmp_path / "nowhere.json")
    (tmp_path / "transforms_train.json").write_text("{}")
    assert "transforms_train.json" in str(refused("calibration-missing", tmp_path))


def test_a_damaged_photograph_is_named_on_opening_or_left_out(tmp_path):
    write(tmp_path, document(5), 5)
    (tmp_path / "images" / "v1.png").write_bytes(b"no picture")
    assert "v1.png" in str(refused("image-kind", tmp_path))
    lenient = open_capture(tmp_path, strict=False)
    assert len(lenient) == 4 and any("v1.png" in problem for problem in lenient.problems)


def test_names_with_line_breaks_and_lone_surrogates_stay_on_one_line(tmp_path):
    top = document(5)
    top["frames"][4]["file_path"] = "images/a\nb\ud800.png"
    (problem,) = open_capture(write(tmp_path, top, 4)).problems
    assert "\n" not in problem and problem.encode()


JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-(10**30), 10**30) | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=8,
)


PLACES = [
    "frames", "camera_model", "applied_transform", "k1", "is_fisheye", "frames/0", "frames/0/file_path",
    "frames/0/transform_matrix", "frames/0/transform_matrix/1", "frames/0/transform_matrix/1/2", "frames/0/w",
    "frames/0/mask_path", "frames/0/cx", "frames/0/fl_y", "frames/0/camera_angle_x",
]  # fmt: skip


@settings(max_examples=300)
@given(st.sampled_from(PLACES), JSON)
@example("frames/0/transform_matrix/1/2", float("inf"))
def test_any_value_anywhere_is_read_or_refused(tmp_path_factory, path, value):
    folder = tmp_path_factory.getbasetemp() / "any"
    if not folder.exists():
        write(folder)
    (folder / "transforms.json").write_text(json.dumps(changed(path, value)))
    try:
        capture = open_capture(folder)
    except CaptureError as error:
        assert "\n" not in str(error)
    else:
        assert all(np.isfinite(view.camera.matrix).all() for view in capture.views)


def test_the_reader_leaves_its_input_alone(tmp_path):
    top = document()
    before = copy.deepcopy(top)
    write(tmp_path, top)
    assert len(read_transforms(tmp_path / "transforms.json").entries) == 4 and top == before
