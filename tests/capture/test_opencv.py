"""OpenCV storages: YAML, XML and JSON, lenses, stereo pairs, views of a chart."""

from __future__ import annotations

import contextlib
import json

import cv2
import numpy as np
import pytest

from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.filestorage import load_storage
from eigenfield.capture.readers.opencv import find_opencv, read_opencv, read_opencv_intrinsics
from eigenfield.core.errors import CaptureError
from support import calibrations as write
from support.calibrations import CUBE, HEIGHT, NAMES, WIDTH, stations
from support.readers import check_cube, check_lens

# OpenCV


@pytest.mark.parametrize("count", list(write.OPENCV_LENSES))
@pytest.mark.parametrize("kind", ["yml", "xml"])
def test_opencv_lens(tmp_path, count, kind):
    """Against cv2.projectPoints, whose pixel centres are whole numbers."""
    lens = write.OPENCV_LENSES[count]
    calibration = read_opencv(write.opencv_files(tmp_path, stations(), lens, kind))
    for entry, station in zip(calibration.entries, stations(), strict=True):
        K, _, R, t = write.opencv_numbers(station, lens)

        def pixels(points, K=K, R=R, t=t):
            return (
                cv2.projectPoints(points, cv2.Rodrigues(np.array(R))[0], t, np.array(K), np.array(lens))[0][:, 0] + 0.5
            )

        check_lens(entry, pixels)


def test_opencv_half_a_pixel(tmp_path):
    path = write.opencv_files(tmp_path, stations()) / "a0.yml"
    ((name, (intrinsics, lens)),) = read_opencv_intrinsics(path).items()
    station = stations()[0]
    assert (name, lens) == ("", None)
    assert intrinsics.principal == (station.cx, station.cy)
    assert (intrinsics.width, intrinsics.height) == (WIDTH, HEIGHT)


def test_ros_camera_info(tmp_path):
    """YAML without OpenCV's head and tags."""
    path = tmp_path / "camera.yaml"
    path.write_text(
        "image_width: 640\nimage_height: 480\ncamera_name: narrow_stereo\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
        "  data: [500, 0, 319.5, 0, 501, 239.5, 0, 0, 1]\ndistortion_model: plumb_bob\ndistortion_coefficients:\n"
        "  rows: 1\n  cols: 5\n  data: [-0.1, 0.01, 0.001, 0, 0]\nrectification_matrix:\n  rows: 3\n  cols: 3\n"
        "  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
    )
    ((intrinsics, lens),) = read_opencv_intrinsics(path).values()
    assert (intrinsics.width, intrinsics.focal, intrinsics.principal) == (640, (500, 501), (320, 240))
    assert lens == Lens("brown", (-0.1, 0.01, 0.001, 0, 0))


def test_opencv_fisheye_by_its_flag(tmp_path):
    path = write.opencv_files(tmp_path, stations(), write.OPENCV_LENSES[4]) / "a0.yml"
    path.write_text(path.read_text() + "fisheye_model: 1\n")
    assert read_opencv_intrinsics(path)[""][1] == Lens("fisheye", write.OPENCV_LENSES[4])
    path.write_text(path.read_text().replace("fisheye_model: 1", "distortion_model: kaleidoscope"))
    with pytest.raises(CaptureError) as error:
        read_opencv_intrinsics(path)
    assert error.value.code == "camera-model"


def test_opencv_cameras_as_mappings(tmp_path):
    """A mapping a camera, by name, as list items, and as flow lists."""
    one, two, three, four = stations()
    body = "%YAML:1.0\n---\n"
    for s in (one, two):
        K, D, R, T = write.opencv_numbers(s, (0.0,) * 5)
        parts = [("camera_matrix", K), ("distortion_coefficients", D), ("R", R), ("T", T)]
        body += f"{s.name[:-4]}:\n" + "".join(write.yaml_matrix(key, value, "   ") for key, value in parts)
    body += "cameras:\n"
    for s in (three, four):
        K, _, R, T = write.opencv_numbers(s, (0.0,) * 5)
        body += f'   -\n      name: "{s.name}"\n      K: {np.array(K).tolist()}\n'
        body += f"      rvec: {write.axis_angle(R).ravel().tolist()}\n      tvec: {T.ravel().tolist()}\n"
    path = tmp_path / "rig.yml"
    path.write_text(body)
    assert find_opencv(tmp_path) == path
    check_cube(read_opencv(path), stations())


def test_opencv_json(tmp_path):
    cameras = {}
    for s in stations():
        K, _, R, T = write.opencv_numbers(s, (0.0,) * 5)
        matrix = {"type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d", "data": list(np.ravel(K))}
        extrinsic = np.hstack([np.array(R), T]).tolist()
        cameras[s.name[:-4]] = {"camera_matrix": matrix, "extrinsic_matrix": extrinsic}
    path = tmp_path / "rig.json"
    path.write_text(json.dumps(cameras))
    check_cube(read_opencv(path), stations())


def test_opencv_stereo_pair(tmp_path):
    """intrinsics.yml and extrinsics.yml of OpenCV's sample: R, T lead from the first camera to the second."""
    one, two = stations()[:2]
    (K1, D, R1, T1), (K2, _, R2, T2) = (write.opencv_numbers(s, (0.0,) * 5) for s in (one, two))
    R = np.array(R2) @ np.array(R1).T
    T = T2 - R @ T1
    parts = [("M1", K1), ("D1", D), ("M2", K2), ("D2", D)]
    (tmp_path / "intrinsics.yml").write_text("%YAML:1.0\n" + "".join(write.yaml_matrix(*part) for part in parts))
    parts = [("R", R), ("T", T), ("R1", np.eye(3)), ("R2", np.eye(3)), ("P1", np.eye(3, 4)), ("Q", np.eye(4))]
    (tmp_path / "extrinsics.yml").write_text("%YAML:1.0\n---\n" + "".join(write.yaml_matrix(*part) for part in parts))
    write.photographs(tmp_path, NAMES[:2])
    assert find_opencv(tmp_path) is None  # two cameras are no light field
    for name in ("intrinsics.yml", "extrinsics.yml"):
        first, second = read_opencv(tmp_path / name).entries
        assert (first.file, second.file) == NAMES[:2]
        cameras = [entry.camera(WIDTH, HEIGHT, tmp_path) for entry in (first, second)]
        points = one.along(CUBE)  # the first camera's frame is the world
        assert np.abs(cameras[0].project(points)[0] - one.pixels(CUBE)).max() < 1e-6
        assert np.abs(cameras[1].project(points)[0] - two.pixels(CUBE)).max() < 1e-6
    assert set(read_opencv_intrinsics(tmp_path / "intrinsics.yml")) == {"1", "2"}


def test_opencv_views_of_a_chart(tmp_path):
    K, D, _, _ = write.opencv_numbers(stations()[0], (0.0,) * 5)
    rows = []
    for s in stations():
        _, _, R, T = write.opencv_numbers(s, ())
        rows.append([*write.axis_angle(R).ravel(), *T.ravel()])
    parts = [("camera_matrix", K), ("distortion_coefficients", D), ("extrinsic_parameters", rows)]
    path = tmp_path / "left.yml"
    path.write_text("%YAML:1.0\n---\n" + "".join(write.yaml_matrix(*part) for part in parts))
    write.photographs(tmp_path)
    assert find_opencv(tmp_path) is None
    calibration = read_opencv(path)
    assert [entry.file for entry in calibration.entries] == list(NAMES)
    for entry, s in zip(calibration.entries, stations(), strict=True):
        assert np.abs(entry.centre - s.eye).max() < 1e-9


def test_opencv_intrinsics_only_is_no_calibration(tmp_path):
    path = tmp_path / "left.yml"
    path.write_text("%YAML:1.0\n" + write.yaml_matrix("camera_matrix", np.diag([90.0, 90, 1])))
    assert find_opencv(tmp_path) is None
    with pytest.raises(CaptureError, match="--intrinsics") as error:
        read_opencv(path)
    assert error.value.code == "opencv-poses"
    path.write_text("%YAML:1.0\na: 1\n")
    with pytest.raises(CaptureError) as error:
        read_opencv_intrinsics(path)
    assert error.value.code == "calibration-empty"


@pytest.mark.parametrize(
    "body",
    [
        "camera_matrix: !!opencv-matrix\n  rows: 1000000\n  cols: 1000000\n  dt: d\n  data: [ 1. ]\n",
        "camera_matrix: !!opencv-matrix\n  rows: -3\n  cols: 3\n  dt: d\n  data: [ 1. ]\n",
        "camera_matrix: !!opencv-matrix\n  rows: .Nan\n  cols: 3\n  dt: d\n  data: [ 1. ]\n",
        "camera_matrix: [ 1, 2",
        "a: ]",
        "a: 1\n   b: 2\n c: 3\n",
        "- 1\n- 2\n",
        "a: " + "[" * 1000 + "]" * 1000,
        "\n".join(" " * i + "a:" for i in range(1000)),
        'a: "no end\n',
        "b: *name\na: &name [ 1 ]\n",
        "a: &name [ *name ]\n",
        "a: &a [1, 1, 1, 1, 1, 1, 1, 1]\n"
        + "".join(f"{k}: &{k} [{', '.join([f'*{chr(ord(k) - 1)}'] * 8)}]\n" for k in "bcdefghijk"),
        "? [ 1 ]\n: 2\n",
        "",
        "\0\0\0",
    ],
)
def test_opencv_damaged_storage_is_named(tmp_path, body):
    path = tmp_path / "a.yml"
    path.write_text("%YAML:1.0\n" + body)
    with pytest.raises(CaptureError) as error:
        load_storage(path)
    assert error.value.code == "calibration-damaged"
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "line",
    ["a: " + " " * 2_000_000 + "x", '"' * 1_000_000, 'a: "' + '\\"' * 1_000_000, "a: [" + "[1]," * 200_000 + "]"],
)
def test_long_lines_take_no_more_than_their_length(tmp_path, line):
    path = tmp_path / "a.yml"
    path.write_text("%YAML:1.0\n" + line + "\n")
    with contextlib.suppress(CaptureError):
        load_storage(path)


@pytest.mark.parametrize("body", [
    "a = 9", "a = [" * 5000, "a." * 5000 + "a = 1", "1." * 5000 + "1 = 1", '","."' * 5000, "a = " + "9" * 5000,
])  # fmt: skip
def test_damaged_toml_is_named(tmp_path, body):
    path = tmp_path / "a.toml"
    path.write_text(body + "\n")
    with contextlib.suppress(CaptureError):
        assert list(load_storage(path)) == ["a"]


def test_storage_reads_what_opencv_writes(tmp_path):
    matrix = np.arange(12.0).reshape(3, 4) / 7
    for suffix in ("yml", "xml", "json"):
        path = tmp_path / f"a.{suffix}"
        storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
        storage.write("matrix", matrix)
        storage.write("points", np.arange(8, dtype=np.float32).reshape(2, 2, 2))
        storage.write("count", 3)
        storage.write("name", "a # b: c, [d]")
        storage.startWriteStruct("list", cv2.FileNode_SEQ)
        storage.write("", 1.5)
        storage.write("", np.eye(2))
        storage.endWriteStruct()
        storage.startWriteStruct("map", cv2.FileNode_MAP)
        storage.write("inner", matrix)
        storage.endWriteStruct()
        storage.release()
        tree = load_storage(path)
        assert np.array_equal(tree["matrix"], matrix)
        assert tree["points"].shape == (2, 2, 2)
        assert (tree["count"], tree["name"]) == (3.0, "a # b: c, [d]")
        assert tree["list"][0] == 1.5
        assert np.array_equal(tree["list"][1], np.eye(2))
        assert np.array_equal(tree["map"]["inner"], matrix)


def test_yaml_is_read_as_opencv_means_it(tmp_path):
    """Dates and `no` stay words, exponents need no point, maps in braces no blank; documents are joined."""
    path = tmp_path / "a.yml"
    path.write_text(
        "%YAML:1.0\n---\ny: no\ndate: 2024-11-21\nsmall: 1e-5\nwords: 'it''s'\n012: .Nan\n"
        "map: { x:167, y:-1.5, list:[ 1, 2 ], inner:{ z:3 } }\n...\n---\nmore:\t~\n"
    )
    tree = load_storage(path)
    assert np.isnan(tree.pop("012"))
    assert tree == {
        "y": "no", "date": "2024-11-21", "small": 1e-5, "words": "it's", "more": None,
        "map": {"x": 167.0, "y": -1.5, "list": [1.0, 2.0], "inner": {"z": 3.0}},
    }  # fmt: skip


def test_words_that_look_like_a_map_are_left_alone(tmp_path):
    path = tmp_path / "a.yml"
    path.write_text("%YAML:1.0\nwords: a, b:c\n")
    assert load_storage(path) == {"words": "a, b:c"}
