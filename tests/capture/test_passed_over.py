"""Calibrations beside photographs: used, or named in a line."""

from __future__ import annotations

import json
import unicodedata

import numpy as np
import pytest

from eigenfield.capture import LightField, PhotoSet, open_any, open_capture
from eigenfield.capture.readers.nvm import read_nvm
from support import calibrations as write
from support.calibrations import stations
from support.named import write_video
from support.readers import check_lens
from support.transforms_files import camera, document, picture, pose, refused

OPENCV = {s.name[:-4]: write.opencv_mapping(s) for s in stations()}
ROWS = "\n".join(" ".join(f"{v:.6e}" for v in row) for row in np.eye(4))
FOREIGN = {
    "sfm_data.json": '{"sfm_data_version": "0.3", "views": []}',
    "reconstruction.json": '[{"cameras": {}, "shots": {"a.png": {"rotation": [0, 0, 0]}}}]',
    "cameras.json": '[{"id": 0, "img_name": "a0", "position": [0, 0, 1], "rotation": [[1, 0, 0]], "fx": 90}]',
    "meta_data.json": '{"camera_model": "OPENCV", "frames": [{"camtoworld": [[1]], "intrinsics": [[1]]}]}',
    "camchain.yaml": "cam0:\n  intrinsics: [90, 90, 48, 32]\ncam1:\n  T_cn_cnm1:\n  - [1, 0, 0, 0]\n",
    "cams/00000000_cam.txt": f"extrinsic\n{ROWS}\n\nintrinsic\n90 0 48\n0 90 32\n0 0 1\n\n425.0 2.5\n",
    "trajectory.log": f"0 0 1\n{ROWS}\n1 1 2\n{ROWS}\n",
    "poses.txt": "# timestamp tx ty tz qx qy qz qw\n" + "1.5 0 0 1e-3 0 0 0 1\n" * 3,
    "pose/frame-000.pose.txt": ROWS,
    "rig.json": json.dumps(OPENCV),
    "all.json": json.dumps(document()),
    "intrinsics.yaml": "camera_matrix: [[90, 0, 48], [0, 90, 32], [0, 0, 1]]\n",
    "rig.toml": 'f_px = 90\n[cameras.a]\nquaternion = [1, 0, 0, 0]\nfocal = 90\n',
    "rig.yml": "- &a {focal_mm: 35, pose: !!python/tuple [1, 2]}\n- *a\n",
    "calib.txt": "cam0=[3997.684 0 1176.728; 0 3997.684 1011.728; 0 0 1]\n",
}  # fmt: skip


@pytest.mark.parametrize("name", list(FOREIGN))
def test_what_is_not_read_is_named(tmp_path, name):
    write.photographs(tmp_path / "images")
    assert not open_any(tmp_path).problems
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text(FOREIGN[name])
    opened = open_any(tmp_path)
    (line,) = opened.problems
    assert isinstance(opened, PhotoSet) and line.startswith(f"{name} looks like a calibration and is not read (")
    assert not open_any(tmp_path, format="folder").problems
    assert line.split(": ")[1] in refused("calibration-missing", tmp_path).remedy


@pytest.mark.parametrize(("name", "text"), [
    ("notes.txt", "1 2 3\n"), ("config.yml", "fps: 30\nposition: 3\n"), ("batch.toml", '[captures]\na = "b"\n'),
    ("IMG_1.jpg.json", '{"title": "a", "geoData": {"latitude": 1.0}}'), ("long.log", "1 2 3\n" + "\n" * 60_000 + "x"),
    ("digits.txt", "1" * 60_000), ("values.txt", "1 2 3 4 5 6 7 8\n1 2 3\n"), ("report.json", '{"frames": [], "K": 1}'),
])  # fmt: skip
def test_other_texts_are_not(tmp_path, name, text):
    write.photographs(tmp_path)
    (tmp_path / name).write_text(text)
    assert not open_any(tmp_path).problems


def test_the_remedy_of_a_line_reads_the_cameras(tmp_path):
    write.photographs(tmp_path / "images")
    (tmp_path / "rig.json").write_text(FOREIGN["rig.json"])
    assert open_any(tmp_path).problems[0].endswith("(in OpenCV's terms): name it with --calibration")
    opened = open_any(tmp_path, calibration=tmp_path / "rig.json")
    assert opened.format == "opencv" and len(opened) == 4 and not opened.problems
    for name in ("cameras.json", "camchain.yaml", "meta_data.json", "trajectory.log"):
        (tmp_path / name).write_text(FOREIGN[name])
        refused("calibration-foreign", tmp_path, calibration=tmp_path / name)
    (tmp_path / "rig.json").write_text('{"a": [1, 2]}')
    refused("calibration-json", tmp_path, calibration=tmp_path / "rig.json")


# what is read


@pytest.mark.parametrize(("writer", "format"), [
    (write.plain_yaml, "opencv"), (write.toml, "opencv"), (write.nvm, "nvm")])  # fmt: skip
def test_what_is_read_is_used(tmp_path, writer, format):
    write.photographs(tmp_path / "images")
    writer(tmp_path, stations(True, True))
    opened = open_any(tmp_path)
    assert isinstance(opened, LightField) and opened.format == format and not opened.problems and len(opened) == 4
    for one, station in zip(opened.cameras, stations(True, True), strict=True):
        assert np.abs(one.project(write.CUBE)[0] - station.pixels(write.CUBE)).max() < 1e-6


def test_a_file_that_numbers_its_cameras(tmp_path):
    """Caliscope's camera 0 is the photograph or the video cam_0, Anipose's A is camA."""
    for beginning in ("cam_", "port_", "cam"):
        folder = tmp_path / beginning
        write.photographs(folder, [f"{beginning}{i}.png" for i in range(4)])
        lines = []
        for i, s in enumerate(stations()):
            values = {"cam_id": i, "ignore": False, **write.opencv_mapping(s)}
            lines += [f"[cameras.{i}]", *(f"{key} = {json.dumps(value)}" for key, value in values.items())]
        (folder / "camera_array.toml").write_text("\n".join(lines))
        opened = open_any(folder)
        assert opened.names == tuple(f"{beginning}{i}.png" for i in range(4)) and not opened.problems
        assert np.abs(opened.cameras[2].centre - stations()[2].eye).max() < 1e-9


def splits(folder, **parts):
    """A capture as the original NeRF's: train/r_0.png, transforms_train.json, without endings and sizes."""
    for split, numbers in parts.items():
        (folder / split).mkdir(parents=True)
        frames = [{"file_path": f"./{split}/r_{i}", "transform_matrix": pose(camera(i))} for i in numbers]
        (folder / f"transforms_{split}.json").write_text(json.dumps({"camera_angle_x": 0.7, "frames": frames}))
        for i in numbers:
            picture(i).convert("RGBA").save(folder / split / f"r_{i}.png")
    return folder


def test_the_splits_of_nerfs_sets_are_one_capture(tmp_path):
    folder = splits(tmp_path / "lego", train=range(4), val=range(2), test=range(3))
    picture(9).save(tmp_path / "beside.png")  # above it, photographs of something else
    opened = open_any(folder)
    assert opened.root == folder and len(opened) == 9
    assert "transforms_train.json, transforms_val.json, transforms_test.json are read together" in opened.problems[0]
    for view in opened.views:
        assert np.allclose(view.camera.centre, camera(int(view.path.stem[-1])).centre)
    train = open_any(folder / "transforms_train.json")
    assert train.names == ("r_0.png", "r_1.png", "r_2.png", "r_3.png") and not train.problems
    assert not open_any(splits(tmp_path / "alone", train=range(4))).problems


@pytest.mark.parametrize("radial", [-0.12, 0.05])
def test_visualsfms_radial_distortion(tmp_path, radial):
    write.photographs(tmp_path / "images")
    calibration = read_nvm(write.nvm(tmp_path, stations(True, True), radial))
    for entry, station in zip(calibration.entries, stations(True, True), strict=True):
        check_lens(entry, lambda points, s=station: write.nvm_pixels(s, radial, points), tolerance=0.05)


def test_visualsfms_file_says_more_than_cameras(tmp_path):
    write.photographs(tmp_path / "images")
    truth = stations(True, True)
    path = write.nvm(tmp_path, truth, radial=-0.6)
    errors = read_nvm(path).errors
    assert len(errors) == 4 and {error.code for error in errors} == {"camera-model"} and "too strong" in str(errors[0])
    calibration = read_nvm(write.nvm(tmp_path, truth, more="7\n"))
    assert calibration.problems == ("model.nvm has another model, of 7 cameras, which is not read",)
    fixed = read_nvm(write.nvm(tmp_path, truth, fixed="FixedK 99 50 98 30 0")).entries[0].intrinsics
    assert (fixed.focal, fixed.principal) == ((99, 98), (50, 30))
    path.write_text(path.read_text().replace("NVM_V3", "NVM_V3_R9T"))
    refused("calibration-damaged", path)


# names


@pytest.mark.parametrize("form", ["NFC", "NFD"])
def test_folders_and_masks_in_the_other_form(tmp_path, form):
    """macOS writes accents apart, others in one; folders and masks may differ in case as well."""
    other = {"NFC": "NFD", "NFD": "NFC"}[form]
    top = document()
    (tmp_path / unicodedata.normalize(form, "Büro")).mkdir()
    (tmp_path / unicodedata.normalize(form, "Mä")).mkdir()
    (tmp_path / "images").mkdir()
    for i, frame in enumerate(top["frames"]):
        frame["file_path"] = unicodedata.normalize(other, f"büro/Vö{i}.png")
        frame["mask_path"] = unicodedata.normalize(other, f"mä/ü{i}.png")
        picture(i).save(tmp_path / unicodedata.normalize(form, f"Büro/vö{i}.png"))
        picture(9).save(tmp_path / f"images/{unicodedata.normalize(form, f'vö{i}.png')}")  # another of the same name
        picture(i).convert("L").point(lambda v: 255).save(tmp_path / unicodedata.normalize(form, f"Mä/ü{i}.png"))
    (tmp_path / "transforms.json").write_text(json.dumps(top))
    opened = open_capture(tmp_path)
    assert len(opened) == 4 and {unicodedata.normalize("NFC", view.path.parent.name) for view in opened.views} == {
        "Büro"
    }
    assert all(view.mask is not None for view in opened.views)


def test_entries_may_name_the_videos_themselves(tmp_path):
    top = document(3)
    for i, frame in enumerate(top["frames"]):
        frame["file_path"] = f"cam_{i}.mkv"
        write_video(tmp_path / f"cam_{i}.mkv", 2)
        for key in ("w", "h", "cx", "cy"):
            del frame[key]
    (tmp_path / "transforms.json").write_text(json.dumps(top))
    assert open_capture(tmp_path).names == ("cam_0.png", "cam_1.png", "cam_2.png")
    assert open_capture(tmp_path, calibration=tmp_path / "transforms.json").names[2] == "cam_2.png"
