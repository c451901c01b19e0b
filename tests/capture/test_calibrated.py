"""Readers of calibrated captures: a cube projects where it must, damage is named, photographs agree with cameras."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from eigenfield.capture import open_any, open_capture
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.llff import find_llff, read_llff
from eigenfield.capture.readers.middlebury import find_middlebury, read_middlebury
from eigenfield.capture.readers.opencv import read_opencv, read_opencv_intrinsics
from eigenfield.capture.readers.strecha import find_strecha, read_strecha
from eigenfield.core.errors import CaptureError
from support import calibrations as write
from support.calibrations import CUBE, HEIGHT, NAMES, WIDTH, stations
from support.readers import CENTRED, FINDERS, FORMATS, WRITERS, check_cube


def test_every_format_of_calibrations_has_a_writer():
    """transforms.json and COLMAP models have test modules of their own."""
    assert {FORMATS.get(name, name) for name in WRITERS} == FINDERS.keys()


@pytest.mark.parametrize("name", list(WRITERS))
def test_a_cube_projects_where_it_must(tmp_path, name):
    writer, read = WRITERS[name]
    path = writer(tmp_path)
    assert FINDERS[FORMATS.get(name, name)](tmp_path) == path
    calibration = read(path)
    assert calibration.format == FORMATS.get(name, name)
    check_cube(calibration, stations(name in CENTRED, name in CENTRED))


@pytest.mark.parametrize("name", list(WRITERS))
def test_no_other_reader_claims_the_folder(tmp_path, name):
    WRITERS[name][0](tmp_path)
    claims = [key for key, find in FINDERS.items() if find(tmp_path) is not None]
    assert claims == [FORMATS.get(name, name)]


@pytest.mark.parametrize("find", FINDERS.values(), ids=FINDERS)
def test_nothing_is_found_where_nothing_is(tmp_path, find):
    assert find(tmp_path) is None
    assert find(tmp_path / "absent") is None
    (tmp_path / "notes.txt").write_text("1 2 3\n")
    (tmp_path / "log.out").write_text("hello\n")
    (tmp_path / "config.yml").write_text("a: 1\n")
    (tmp_path / "other.xml").write_text("<a/>\n")
    (tmp_path / "room_par.txt").write_text("carpet\n")
    (tmp_path / "readme_P.txt").write_text("see below\n")
    (tmp_path / "txt").mkdir()
    (tmp_path / "txt" / "a.txt").write_text("some words\n")
    assert find(tmp_path) is None


@pytest.mark.parametrize("name", list(WRITERS))
def test_a_missing_file_is_named(tmp_path, name):
    _, read = WRITERS[name]
    with pytest.raises(CaptureError) as error:
        read(tmp_path / "absent.yml")
    assert str(tmp_path) in str(error.value)
    assert error.value.remedy


@pytest.mark.parametrize("name", list(WRITERS))
@pytest.mark.parametrize("apart", [False, True])
def test_open_capture_pairs_it_with_photographs(tmp_path, name, apart):
    """As people call it: on the folder, or with --calibration and the photographs elsewhere."""
    square = name in CENTRED
    path = WRITERS[name][0](tmp_path / "capture" if apart else tmp_path)
    write.photographs(tmp_path / "images")
    capture = open_capture(tmp_path, calibration=path) if apart else open_capture(tmp_path)
    assert capture.names == NAMES
    for view, s in zip(capture.views, stations(square, square), strict=True):
        assert (view.camera.width, view.camera.height) == (WIDTH, HEIGHT)
        assert np.abs(view.camera.project(CUBE)[0] - s.pixels(CUBE)).max() < 1e-6
        assert view.lens is None


SHARED_NAMES = {"deepview", "opencv", "opencv-xml", "easymocap", "toml", "realitycapture"}  # other files have them too


@pytest.mark.parametrize("name", [name for name in WRITERS if name not in SHARED_NAMES])
def test_a_damaged_calibration_of_a_name_of_its_own_is_said(tmp_path, name):
    """`CALIBRATION_PATTERNS` of `capture.formats` has the name; else the photographs are taken without a word."""
    path = WRITERS[name][0](tmp_path)
    files = [path] if path.is_file() else sorted(path.iterdir())
    for file in files:
        file.write_bytes(b"")
    write.photographs(tmp_path / "images")
    try:
        lines = open_any(tmp_path).problems
    except CaptureError as error:  # the name alone is a claim
        lines = (str(error),)
    assert any(files[0].name in line for line in lines), lines


# real captures

REAL = {
    "llff_fern": (find_llff, read_llff, 20),
    "temple_ring16": (find_middlebury, read_middlebury, 16),
    "fountain_P11_half": (find_strecha, read_strecha, 11),
}
# neighbours on the array, and the median distance (pixels) from the epipolar line that their matches may have
NEIGHBOURS = {"llff_fern": (0, 5, 0.4), "temple_ring16": (5, 10, 0.3), "fountain_P11_half": (1, 5, 0.15)}


@pytest.mark.parametrize("name", list(REAL))
def test_real_captures_are_found_and_told_apart(data, name):
    find, read, count = REAL[name]
    path = find(data / name)
    assert path is not None
    calibration = read(path)
    assert (len(calibration.entries), calibration.errors, calibration.problems) == (count, (), ())
    assert [key for key, other in FINDERS.items() if other(data / name) is not None] == [calibration.format]


OTHERS = (
    "tarot_17x17_512", "hci_boxes_9x9", "shop_9x9", "cube_colmap_mesh", "fox_transforms_half", "opencv_stereo_chart",
    "jellybeans_17x17_768x384",
)  # fmt: skip


@pytest.mark.parametrize("name", OTHERS)
def test_other_real_captures_are_not_claimed(data, name):
    assert [key for key, find in FINDERS.items() if find(data / name) is not None] == []


def photograph_of(folder: Path, file: str) -> Path:
    return next(path for path in (folder / file, folder / "images" / file) if path.is_file())


def epipolar_distances(one, two, first, second):
    """Distances (pixels) of SIFT matches of two photographs from the epipolar lines of two cameras."""
    sift, matcher = cv2.SIFT_create(2000), cv2.BFMatcher()
    (points1, features1), (points2, features2) = (sift.detectAndCompute(p, None) for p in (first, second))
    pairs = [a for a, b in matcher.knnMatch(features1, features2, k=2) if a.distance < 0.7 * b.distance]
    half = np.array([0.5, 0.5, 0])
    x1 = np.array([(*points1[m.queryIdx].pt, 1) for m in pairs]) + half
    x2 = np.array([(*points2[m.trainIdx].pt, 1) for m in pairs]) + half
    R = two.R @ one.R.T
    a, b, c = two.t - R @ one.t
    F = np.linalg.inv(two.K).T @ np.array([[0, -c, b], [c, 0, -a], [-b, a, 0]]) @ R @ np.linalg.inv(one.K)
    lines = x1 @ F.T
    return np.abs((lines * x2).sum(axis=1)) / np.hypot(lines[:, 0], lines[:, 1])


@pytest.mark.slow
@pytest.mark.parametrize("name", list(REAL))
def test_real_photographs_agree_with_their_cameras(data, name):
    find, read, _ = REAL[name]
    first, last, limit = NEIGHBOURS[name]
    calibration = read(find(data / name))
    views = []
    for entry in calibration.entries[first : last + 1]:
        picture = cv2.imread(str(photograph_of(data / name, entry.file)), cv2.IMREAD_GRAYSCALE)
        height, width = picture.shape
        claimed = entry.intrinsics.width or width, entry.intrinsics.height or height
        camera = entry.camera(*claimed, calibration.path)
        K = np.diag([width / claimed[0], height / claimed[1], 1]) @ camera.K
        views.append((replace(camera, K=K, width=width, height=height), picture))
    distances = np.concatenate([epipolar_distances(one, two, a, b) for (one, a), (two, b) in itertools.pairwise(views)])
    assert len(distances) > 200
    assert np.median(distances) < limit
    assert (distances < 3).mean() > 0.85
    swapped = np.concatenate([epipolar_distances(two, one, a, b) for (one, a), (two, b) in itertools.pairwise(views)])
    assert np.median(swapped) > 5 * np.median(distances)  # the measure can tell a wrong camera


def test_fountain_keeps_the_scale_of_its_file(data):
    centres = np.array([entry.centre for entry in read_strecha(find_strecha(data / "fountain_P11_half")).entries])
    assert 10 < np.ptp(centres, axis=0).max() < 20


def test_caliscopes_toml_is_that_of_its_videos(data):
    rig = open_capture(data / "caliscope_charuco_rig4")
    assert rig.format == "opencv" and rig.names == ("cam_0.png", "cam_1.png", "cam_2.png", "cam_3.png")
    assert rig.views[0].lens == Lens("brown", (-0.3383569013465177, 0.09672714756989992, -0.0013512226751077358,
                                               0.003155760325647937, -0.0037489346582201062))  # fmt: skip
    assert np.allclose(rig.cameras[0].t, [-0.6425176710599999, 0.2628680995431283, 1.4515383168392715], atol=1e-9)
    assert rig.cameras[0].K[0, 2] == pytest.approx(624.011791468827 + 0.5)


def test_the_stereo_chart_gives_intrinsics(data):
    folder = data / "opencv_stereo_chart"
    both = read_opencv_intrinsics(folder / "intrinsics.yml")
    assert both["1"][0].focal == pytest.approx((534.803, 534.803), abs=1e-3)
    assert both["2"][0].principal == pytest.approx((334.557 + 0.5, 242.053 + 0.5), abs=1e-3)
    ((intrinsics, lens),) = read_opencv_intrinsics(folder / "left_intrinsics.yml").values()
    assert (intrinsics.width, intrinsics.height) == (640, 480)
    assert lens is not None
    assert lens.coefficients[0] == pytest.approx(-0.26637, abs=1e-5)
    with pytest.raises(CaptureError) as error:  # 13 views of the left camera, but 26 photographs
        read_opencv(folder / "left_intrinsics.yml")
    assert error.value.code == "calibration-count"
