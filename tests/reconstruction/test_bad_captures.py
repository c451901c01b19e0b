"""What people do wrong with a capture: each ends in one line with the remedy, or goes on without and says so."""

from __future__ import annotations

import json
import logging
import os
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from PIL import Image, ImageFilter

import eigenfield as ef
from eigenfield.calibration.motion import sfm
from eigenfield.calibration.motion.result import ViewReport
from eigenfield.capture import PhotoSet, Shot, open_any, open_capture
from eigenfield.core.errors import CaptureError, EigenfieldError
from eigenfield.reconstruction.whole import reconstruct
from support.captures import write_array, write_capture


@pytest.fixture(scope="module")
def array(tmp_path_factory):
    """Bare photographs of a grid."""
    folder = tmp_path_factory.mktemp("array") / "photos"
    write_array(folder, side=3, pixels=64)
    return folder


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory):
    """Nine photographs with cameras and a proxy."""
    return write_capture(tmp_path_factory.mktemp("calibrated") / "nine")


def copied(folder, tmp_path):
    return shutil.copytree(folder, tmp_path / "copy")


def refused(call) -> EigenfieldError:
    with pytest.raises(EigenfieldError) as caught:
        call()
    error = caught.value
    assert error.remedy and error.path and "\n" not in str(error), str(error)
    return error


def changed(folder, change):
    for path in sorted(folder.glob("*.png")):
        with Image.open(path) as picture:
            result = change(picture.convert("RGB"))
        result.save(path)


# photographs of a grid in which nothing can be followed


def noisy(picture, random):
    return Image.fromarray(random.integers(126, 130, (picture.height, picture.width, 3), np.uint8))


@pytest.mark.parametrize("kind", ["blurred", "bare", "still", "centre"])
def test_grids_without_a_scene(array, tmp_path, kind):
    folder, random = copied(array, tmp_path), np.random.default_rng(0)
    if kind == "blurred":
        changed(folder, lambda picture: picture.filter(ImageFilter.GaussianBlur(12)))
    elif kind == "bare":
        changed(folder, lambda picture: noisy(picture, random))
    elif kind == "still":
        with Image.open(folder / "view_01_01.png") as picture:
            same = np.asarray(picture).copy()
        for number, path in enumerate(sorted(folder.iterdir())):
            same[0, 0] = number  # copies, but not byte for byte
            Image.fromarray(same).save(path)
    else:
        blocks = random.integers(0, 255, (16, 16, 3), np.uint8)
        Image.fromarray(blocks).resize((64, 64), Image.Resampling.BICUBIC).save(folder / "view_01_01.png")
    error = refused(lambda: reconstruct(open_any(folder)))
    codes = {"blurred": ("grid-texture",), "bare": ("grid-texture",), "still": ("grid-still",)}
    assert error.code in codes.get(kind, ("grid-texture", "grid-motion"))
    assert error.path == str(folder)
    assert "view_01_01.png" in str(error)


# copies


def test_copies_of_one_photograph_are_no_capture(array, tmp_path):
    folder = copied(array, tmp_path)
    for path in folder.iterdir():
        if path.name != "view_00_00.png":
            shutil.copy(array / "view_02_02.png", path)
    error = refused(lambda: open_any(folder))
    assert error.code == "photographs-same"
    assert "8 of 9" in str(error)
    assert any("byte for byte" in problem for problem in open_any(folder, strict=False).problems)


def test_a_file_under_two_cameras_is_said(calibrated, tmp_path):
    folder = copied(calibrated, tmp_path)
    shutil.copy(folder / "images" / "view_01.png", folder / "images" / "view_07.png")
    capture = open_capture(folder)
    assert capture.problems == ("2 photographs are the same file, byte for byte: view_01.png, view_07.png",)


# a photograph, a camera or a mesh that does not belong


def warnings_of(folder, caplog, **options):
    with caplog.at_level(logging.WARNING):
        ef.encode(open_capture(folder), proxy=folder / "proxy.ply", atlas=64, textures=2, **options)
    return [record.getMessage() for record in caplog.records]


BOTH = pytest.mark.parametrize("fit", ["none", "photographs"])


@BOTH
def test_a_good_capture_is_not_warned_of(calibrated, caplog, fit):
    assert warnings_of(calibrated, caplog, fit=fit) == []


@BOTH
@pytest.mark.parametrize("kind", ["foreign", "moved"])
def test_a_view_that_does_not_belong_is_named(calibrated, tmp_path, caplog, kind, fit):
    folder = copied(calibrated, tmp_path)
    if kind == "foreign":
        blocks = np.random.default_rng(1).integers(0, 255, (14, 16, 3), np.uint8)
        Image.fromarray(blocks).resize((64, 56), Image.Resampling.NEAREST).save(folder / "images" / "view_02.png")
    else:
        document = json.loads((folder / "transforms.json").read_text())
        document["frames"][2]["transform_matrix"][0][3] += 1.0
        (folder / "transforms.json").write_text(json.dumps(document))
    (message,) = warnings_of(folder, caplog, fit=fit)
    assert "view_02.png" in message and "--hold-out" in message
    caplog.clear()
    assert warnings_of(folder, caplog, hold_out="view_02.png", fit=fit) == []


def test_black_photographs_have_no_contrast_to_agree_on(calibrated, tmp_path, caplog):
    folder = copied(calibrated, tmp_path)
    for path in (folder / "images").iterdir():
        Image.fromarray(np.zeros((56, 64, 3), np.uint8)).save(path)
    assert warnings_of(folder, caplog) == []


@BOTH
def test_photographs_that_agree_nowhere_are_said(calibrated, tmp_path, caplog, fit):
    folder, random = copied(calibrated, tmp_path), np.random.default_rng(2)
    for path in (folder / "images").iterdir():
        Image.fromarray(random.integers(0, 255, (56, 64, 3), np.uint8)).save(path)
    assert any("hardly agree" in message for message in warnings_of(folder, caplog, fit=fit))


@BOTH
def test_a_camera_that_looks_away_is_said(calibrated, tmp_path, caplog, fit):
    folder = copied(calibrated, tmp_path)
    document = json.loads((folder / "transforms.json").read_text())
    pose = np.array(document["frames"][3]["transform_matrix"])
    pose[:3, :3] = pose[:3, :3] @ np.diag([-1, 1, -1])
    document["frames"][3]["transform_matrix"] = pose.tolist()
    (folder / "transforms.json").write_text(json.dumps(document))
    assert any("view_03.png sees next to nothing" in message for message in warnings_of(folder, caplog, fit=fit))


# files


DAMAGES = {
    "short": lambda path: path.write_bytes(path.read_bytes()[:200]),
    "empty": lambda path: path.write_bytes(b""),
    "text": lambda path: path.write_text("a photograph"),
    "size": lambda path: Image.new("RGB", (30, 20)).save(path),
}


@pytest.mark.parametrize("damage", list(DAMAGES))
def test_a_damaged_photograph_is_named_and_inspect_goes_on(array, tmp_path, run, damage):
    folder = copied(array, tmp_path)
    DAMAGES[damage](folder / "view_01_02.png")
    error = refused(lambda: reconstruct(open_any(folder)))
    assert error.path == str(folder / "view_01_02.png")
    code, out, _ = run("inspect", folder, "--json")
    assert code == 2 and json.loads(out)["refused"]["file"] == error.path
    assert any("view_01_02.png" in problem for problem in json.loads(out)["problems"])


@pytest.mark.parametrize(
    "name", ["poses_bounds.npy/", "transforms.json/", "set_par.txt", "bundle.out", "cameras.xml", "sparse/0/images.txt"]
)
def test_a_calibration_that_is_not_taken_up_is_said(array, tmp_path, name):
    folder = copied(array, tmp_path)
    place = folder / name
    place.parent.mkdir(parents=True, exist_ok=True)
    if name.endswith("/"):
        place.mkdir()
    else:
        place.write_bytes(b"\x93\x00damaged")
    opened = open_any(folder)
    assert isinstance(opened, PhotoSet)
    assert any(name.rstrip("/") in problem and "not read" in problem for problem in opened.problems)


def test_masks_that_hide_everything(array, calibrated, tmp_path, run):
    masks = tmp_path / "masks"
    masks.mkdir()
    for path in array.iterdir():
        Image.new("L", (64, 64)).save(masks / path.name)
    error = refused(lambda: open_any(array, masks=masks))
    assert error.code == "masks-black" and "invert" in error.remedy
    shown = json.loads(run("inspect", array, "--masks", masks, "--json").out)
    assert sum("hides the whole photograph" in problem for problem in shown["problems"]) == 9
    Image.new("L", (64, 64), 255).save(masks / "view_01_01.png")
    assert len(open_any(array, masks=masks)) == 9  # some is enough here
    for number in range(9):
        Image.new("L", (64, 56)).save(masks / f"view_{number:02d}.png")
    assert refused(lambda: open_capture(calibrated, masks=masks)).code == "masks-black"


def test_a_format_that_is_not_there_is_said(array):
    error = refused(lambda: open_any(array, format="colmap"))
    assert error.code == "format-missing"
    assert "COLMAP" in str(error)


@pytest.mark.parametrize("number", [0, 1, 2])
def test_too_few_photographs(array, tmp_path, number):
    folder = tmp_path / "few"
    folder.mkdir()
    for path in sorted(array.iterdir())[:number]:
        shutil.copy(path, folder)
    error = refused(lambda: reconstruct(open_any(folder)))
    assert error.code == ("too-few" if number else "photographs-missing")
    assert number != 1 or "1 photograph;" in str(error)


# options are judged before the long stages


@pytest.mark.parametrize(
    "words",
    [
        ["--density", "0"], ["--hold-out", "every:1"], ["--hold-out", "nobody.png"], ["--reference", "nobody.png"],
        ["--triangles", "0"], ["--atlas", "0"], ["--uv-ssim", "2"], ["-n", "-1"], ["--blind"],
        ["--layers", "0"], ["--layers", "0", "--fit", "none"], ["--blind", "--hold-out", "odd", "--surface", "poisson"],
        ["--fit-sphere", "nobody.png:1,2,3,4"], ["--primitive", "sphere:0,0,0,-1"],
        ["--codec", "webp", "--quality", "3"],
        ["--reference", "view_00_01.png", "--hold-out", "odd"],
    ],
    ids=lambda words: " ".join(words),
)  # fmt: skip
def test_options_are_judged_first(array, tmp_path, run, words):
    with pytest.raises(EigenfieldError) as caught:
        run("encode", array, "-o", tmp_path / "scene.glb", *words, "--traceback")
    assert caught.value.remedy
    assert not list(tmp_path.glob("**/array-*"))


# structure from motion


def report_of(photos, code):
    return [ViewReport(name, False, code, "", 500, 3, 0, None) for name in photos.names]


@pytest.mark.parametrize(
    ("number", "code", "hint"), [(12, "no-pose", True), (11, "no-pose", False), (12, "few-features", False)]
)
def test_photographs_that_may_be_a_grid_are_told_of_it(tmp_path, number, code, hint):
    shots = tuple(Shot(f"{k}.png", tmp_path / f"{k}.png", 64, 48) for k in range(number))
    photos = PhotoSet(tmp_path, shots, None, (), "folder")
    error = sfm._failure_error(photos, report_of(photos, code), [])
    assert isinstance(error, CaptureError)
    assert ("--grid RxC" in str(error)) == hint


def test_where_masks_leave_too_few_features_they_are_named(tmp_path):
    shots = tuple(Shot(f"{k}.png", tmp_path / f"{k}.png", 64, 48, mask=tmp_path / f"{k}_mask.png") for k in range(5))
    photos = PhotoSet(tmp_path, shots, None, (), "folder")
    assert "look at the masks" in str(sfm._failure_error(photos, report_of(photos, "few-features"), []))


# interrupted


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, getattr(signal, "SIGHUP", None)])
def test_an_interrupted_run_ends_soon_and_leaves_no_output(array, tmp_path, number):
    out = tmp_path / "scene.glb"
    process = subprocess.Popen(
        [sys.executable, "-m", "eigenfield", "encode", str(array), "-o", str(out)],
        stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )  # fmt: skip
    deadline = time.monotonic() + 120
    while not list((tmp_path / "scene.work").glob(".array-*")) and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(number)
    sent = time.monotonic()
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said.strip().splitlines()[-1] == "eigenfield: interrupted"
    assert time.monotonic() - sent < 20
    assert not out.exists()
    assert not list((tmp_path / "scene.work").glob(".array-*"))
