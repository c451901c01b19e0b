"""Keys of a camera that look like a lens: read, or an error that names the key; in every reader of text."""

from __future__ import annotations

import json

import numpy as np
import pytest
import yaml

from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.colmap import read_colmap
from eigenfield.capture.readers.deepview import read_deepview
from eigenfield.capture.readers.lens_keys import is_lens
from eigenfield.capture.readers.metashape import read_metashape
from eigenfield.capture.readers.opencv import read_opencv, read_opencv_intrinsics
from eigenfield.capture.readers.realitycapture import read_realitycapture
from eigenfield.capture.readers.transforms import read_transforms
from support import calibrations as write
from support.calibrations import NAMES, stations, yaml_matrix
from support.readers import check_cube
from support.transforms_files import document

FIVE = [0.3, 0.05, 0.01, -0.02, 0.03]
BROWN = Lens("brown", tuple(FIVE))


def mapping(station, keys) -> dict:
    """A camera in OpenCV's terms without a lens, and further keys; None takes one away."""
    K, _, R, T = write.opencv_numbers(station, ())
    values = {"K": K, "R": R, "T": T.ravel().tolist()} | keys
    return {key: value for key, value in values.items() if value is not None}


def read(folder, keys, ending="json"):
    cameras = {s.name[:-4]: mapping(s, keys) for s in stations()}
    path = folder / f"rig.{ending}"
    path.write_text(json.dumps(cameras) if ending == "json" else yaml.safe_dump(json.loads(json.dumps(cameras))))
    return read_opencv(path)


@pytest.mark.parametrize("ending", ["json", "yaml"])
@pytest.mark.parametrize(("keys", "lens"), [
    *(({key: FIVE}, BROWN) for key in (
        "dist", "D", "distCoef", "dist_coef", "distCoeffs", "dist-coeffs", "distortion", "Distortions",
        "distortion_coefficient", "DistortionCoefficients", "distortion_params", "distortion_parameters",
        "lens_distortion")),
    ({"dist": [FIVE]}, BROWN),
    ({"dist": [[v] for v in FIVE]}, BROWN),
    ({"dist": [0.3]}, Lens("brown", (0.3, 0, 0, 0, 0))),
    ({"distortion": 0.3}, Lens("brown", (0.3, 0, 0, 0, 0))),
    ({"dist": [0.3, 0.05]}, Lens("brown", (0.3, 0.05, 0, 0, 0))),
    ({"dist": [0.3, 0.05, 0]}, Lens("brown", (0.3, 0.05, 0, 0, 0))),
    ({"dist": [0] * 7}, None),
    ({"radial_distortion": [0.3, 0.05, 0.03], "tangential_distortion": [0.01, -0.02]}, BROWN),
    ({"k1": 0.3, "k2": 0.05, "p1": 0.01, "p2": -0.02, "k3": 0.03}, BROWN),
    ({"distortion": {"K1": 0.3, "k_2": 0.05, "p1": 0.01, "p2": -0.02, "k3": 0.03, "model": "radtan"}}, BROWN),
    ({"distortion": {"coeffs": FIVE, "type": "brown"}}, BROWN),
    ({"lens": {"params": [0.3, 0.05], "model": "fisheye"}}, Lens("fisheye", (0.3, 0.05, 0, 0))),
    ({"dist": FIVE, "distortion_model": "PlumbBob"}, BROWN),
    ({"dist": [0.3, 0.05], "camera_model": "KannalaBrandt4"}, Lens("fisheye", (0.3, 0.05, 0, 0))),
    ({"k1": 0.3, "k4": 0.05, "k6": 0.1}, Lens("rational", (0.3, 0, 0, 0, 0, 0.05, 0, 0.1))),
    ({"lens_offset": [0, 0.0], "K1": 0, "distance": 3.5, "lens": "EF 24mm", "distortion_model": None}, None),
])  # fmt: skip
def test_a_lens_is_read_under_many_keys(tmp_path, ending, keys, lens):
    calibration = read(tmp_path, keys, ending)
    assert calibration.errors == () and {entry.lens for entry in calibration.entries} == {lens}


@pytest.mark.parametrize(("keys", "named"), [
    *(({key: FIVE}, key) for key in ("coeffs", "kc", "k", "lens", "LensParams", "dist_foo", "opencv_distortion")),
    ({"dist": FIVE, "distortion": [0.2, 0, 0, 0]}, "distortion"),
    ({"distortion": {"k1": 0.3, "k7": 0.1}}, "distortion"),
    ({"distortion": "0.3 0.05 0 0"}, "distortion"),
    ({"dist": ["0.3", "0.05", "0", "0"]}, "dist"),
    ({"dist": FIVE, "camera_type": "fisheye"}, "camera_type"),
    ({"dist": [0.3, 0.05, 0.1]}, "3 distortion coefficients"),
    ({"dist": [0.1] * 6}, "6 distortion coefficients"),
    ({"k1": 0.3, "k4": 0.1}, "k4"),
    ({"dist": FIVE, "k1": 0.3}, "k1"),
])  # fmt: skip
def test_a_lens_that_is_not_read_is_named(tmp_path, keys, named):
    calibration = read(tmp_path, keys)
    assert not calibration.entries and len(calibration.errors) == 4
    assert {error.code for error in calibration.errors} <= {"camera-model", "lens"}
    assert all(named in error.message and NAMES[i][:-4] in error.message for i, error in enumerate(calibration.errors))


def test_a_lens_beside_all_cameras_is_that_of_all(tmp_path):
    K = mapping(stations()[0], {})["K"]
    cameras = {s.name[:-4]: mapping(s, {"K": None}) for s in stations()}
    path = tmp_path / "rig.json"
    path.write_text(json.dumps({"K": K, "dist": FIVE, "cameras": cameras}))
    assert {entry.lens for entry in read_opencv(path).entries} == {BROWN}
    flat = {f"{key}_{name}": value for name, camera in cameras.items() for key, value in camera.items()}
    for name in cameras:
        flat |= {f"K_{name}": K, f"lensFoo_{name}": FIVE}
    path.write_text(json.dumps(flat))
    assert {error.code for error in read_opencv(path).errors} == {"camera-model"}


def test_intrinsics_alone_are_held_to_the_same(tmp_path):
    path = tmp_path / "left.yml"
    path.write_text("%YAML:1.0\n" + yaml_matrix("camera_matrix", np.diag([90.0, 90, 1])) + "lens: [0.1, 0.2]\n")
    with pytest.raises(Exception, match="'lens', which looks like a lens"):
        read_opencv_intrinsics(path)


@pytest.mark.parametrize("keys", [
    lambda s: {"fx": s.fx, "fy": s.fy, "cx": s.cx - 0.5, "cy": s.cy - 0.5},
    lambda s: {"focal_length": [s.fx, s.fy], "principal_point": [s.cx - 0.5, s.cy - 0.5]},
    lambda s: {"intrinsics": [s.fx, s.fy, s.cx - 0.5, s.cy - 0.5]},
    lambda s: {"intrinsics": {"fx": s.fx, "fy": s.fy, "ppx": s.cx - 0.5, "ppy": s.cy - 0.5}},
])  # fmt: skip
def test_focal_lengths_in_place_of_a_matrix(tmp_path, keys):
    cameras = {s.name[:-4]: mapping(s, {"K": None} | keys(s)) for s in stations()}
    path = tmp_path / "rig.json"
    path.write_text(json.dumps(cameras))
    check_cube(read_opencv(path), stations())


def test_poses_without_any_intrinsics_say_so(tmp_path):
    with pytest.raises(Exception, match="no camera has a camera matrix") as error:
        read(tmp_path, {"K": None})
    assert error.value.code == "opencv-matrix"


# other formats


@pytest.mark.parametrize("extra", [
    {"K1": 0.3}, {"distortion": {"k1": 0.3}}, {"radial_distortion": [0.3]}, {"dist": FIVE}, {"D": FIVE}, {"k7": 0.1},
    {"camera": {"k1": 0.3}}, {"lens": [0.3]}, {"camera_type": "fisheye"}, {"tangential": {"p1": 0.1}}, {"s3": 1e-3},
])  # fmt: skip
def test_transforms_names_what_it_does_not_read(tmp_path, extra):
    path = tmp_path / "transforms.json"
    for top in (document() | extra, document() | {"frames": [frame | extra for frame in document()["frames"]]}):
        path.write_text(json.dumps(top))
        errors = read_transforms(path).errors
        assert len(errors) == 4 and {error.code for error in errors} == {"camera-model"}
        assert any(key in str(errors[0]) for key in (*extra, "k1"))
    path.write_text(json.dumps(document() | {"K1": 0, "distortion": {"k1": 0.0}, "lens": 35, "distance": 2}))
    assert not read_transforms(path).errors


@pytest.mark.parametrize(("model", "code"), [
    ("pinhole", None), ("Simple Pinhole", None), ("opencv", None), (None, None), ("", None), ("opencv-fisheye", None),
    ("SimplePinhole", None),    ("fisheye624", "camera-model"), (3, "camera-model"),
])  # fmt: skip
def test_a_camera_model_in_any_case(tmp_path, model, code):
    path = tmp_path / "transforms.json"
    path.write_text(json.dumps(document() | {"camera_model": model}))
    read = read_transforms(path)
    assert [error.code for error in read.errors] == ([code] * 4 if code else [])
    assert all((entry.lens is not None) == (model == "opencv-fisheye") for entry in read.entries)


def test_deepview_metashape_and_realitycapture(tmp_path):
    path = write.deepview(tmp_path, stations())
    cameras = json.loads(path.read_text())
    for key, value in (("tangential_distortion", [0.1, 0]), ("projection_type", "Perspective"), ("k1", 0.2)):
        path.write_text(json.dumps([camera | {key: value} for camera in cameras]))
        errors = read_deepview(path).errors
        assert [error.code for error in errors] == ([] if key == "projection_type" else ["camera-model"] * 4)
    assert {e.code for e in read_metashape(write.metashape(tmp_path, stations(), {"k5": 0.1})).errors} == {
        "camera-model"
    }
    csv = write.realitycapture(tmp_path, stations(True, True))
    text = csv.read_text().replace("k4,t1", "k5,t1")
    assert not read_realitycapture(csv).errors
    csv.write_text(text.replace("0.0,0.0,0.0\n", "0.1,0.0,0.0\n"))
    assert {error.code for error in read_realitycapture(csv).errors} == {"camera-model"}


@pytest.mark.parametrize(("key", "value", "wanted"), [
    ("lens_id", 7, False), ("lens", 50.0, False), ("lens", 0.1, True), ("distributed", 3, False),
    ("K", [[1, 2]], False), ("k", [900, 900, 1, 1], False), ("undistorted", [1.0], False),
    ("is_distorted", True, False), ("P1", [1] * 12, False),
    ("latlong", True, True), ("thin_prism", [0.1], True), ("dist", float("nan"), True), ("d", 3.0, False),
])  # fmt: skip
def test_what_looks_like_a_lens(key, value, wanted):
    assert is_lens(key, value) is wanted


def test_colmaps_model_in_any_case(tmp_path):
    (tmp_path / "cameras.txt").write_text("1 simple_Radial 96 64 90 48 32 0.1\n2 fov 96 64 90 90 48 32 0.1\n")
    (tmp_path / "images.txt").write_text("1 1 0 0 0 0 0 0 1 a.png\n\n2 1 0 0 0 1 0 0 2 b.png\n\n")
    read = read_colmap(tmp_path)
    assert [entry.lens for entry in read.entries] == [Lens("brown", (0.1, 0, 0, 0, 0))]
    assert [error.code for error in read.errors] == ["camera-model"]
