"""Calibration of a rig from charts: the rig, and folders and videos as people have them."""

from __future__ import annotations

import csv
import json
import tomllib
from dataclasses import replace
from pathlib import Path

import click
import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from eigenfield.calibration.charts import board as boards
from eigenfield.calibration.charts import corners
from eigenfield.calibration.charts.bundle import RigEstimate, adjust_bundle
from eigenfield.calibration.charts.calibrate import calibrate_charts
from eigenfield.calibration.charts.description import ChartOptions, board_of
from eigenfield.calibration.charts.lens_models import LENS_MODEL_LADDER
from eigenfield.calibration.charts.pictures import find_charts, split_name
from eigenfield.calibration.charts.rig import solve_rig
from eigenfield.capture import open_capture
from eigenfield.cli.calibrate_chart import chart_options, table
from eigenfield.core.errors import CaptureError, EigenfieldError, OutputError
from eigenfield.runtime.parallel import set_threads
from support import charts
from support.charts import CHARUCO, CHECKER, TOML

# --- the rig


def solved(board, cameras, seen, moments=12, basis=LENS_MODEL_LADDER[2].basis):
    count = len(cameras)
    start = np.repeat(charts.INTRINSICS[None], count, axis=0)
    return solve_rig(
        board.points, board.symmetries(), seen, start, [basis] * count, [charts.SIZE] * count, moments
    )  # fmt: skip


def assert_poses(rig, cameras, joined, degrees=0.1, away=1.0):
    base_R, base_t = cameras[joined[0]]
    for c in joined:
        R, t = cameras[c][0] @ base_R.T, cameras[c][1] - cameras[c][0] @ base_R.T @ base_t
        angle = np.degrees(np.arccos(np.clip((np.trace(rig.R[c] @ R.T) - 1) / 2, -1, 1)))
        assert angle < degrees
        assert np.linalg.norm(rig.R[c].T @ rig.t[c] - R.T @ t) < away


@pytest.mark.parametrize("size", [(9, 6), (7, 5), (6, 6), (5, 5)])
def test_a_rig_is_recovered_even_when_boards_look_the_same_turned(size):
    board = boards.checkerboard(*size, 25.0)
    cameras = charts.rig(3)
    seen = charts.observations(board, cameras, charts.board_poses(board, 9))
    symmetries = board.symmetries()
    random = np.random.default_rng(3)
    seen = [
        replace(s, corners=replace(s.corners, ids=symmetries[random.integers(len(symmetries))][s.corners.ids]))
        for s in seen
    ]
    solution = solved(board, cameras, seen, basis=LENS_MODEL_LADDER[0].basis)
    assert solution.joined == (0, 1, 2) and not solution.outliers
    assert_poses(solution.rig, cameras, (0, 1, 2), degrees=1, away=15)
    errors = np.concatenate([solution.rig.residuals(board.points, s).ravel() for s in solution.inliers])
    assert errors.std() == pytest.approx(0.2, rel=0.1)
    assert np.all(solution.focal_deviations < 5)


def test_moments_in_which_the_board_moved_are_dropped():
    cameras = charts.rig(3)
    poses = charts.board_poses(CHECKER, 12)
    seen = charts.observations(CHECKER, cameras, poses)
    moved = [(R, t + np.array([30.0, 0, 0])) for R, t in poses]
    late = {(s.camera, s.moment): s for s in charts.observations(CHECKER, cameras, moved)}
    seen = [late[1, s.moment] if s.camera == 1 and s.moment in (2, 5, 7) else s for s in seen]
    solution = solved(CHECKER, cameras, seen)
    assert {(s.camera, s.moment) for s in solution.outliers} >= {(1, 2), (1, 5), (1, 7)}
    assert len(solution.outliers) <= 6
    assert_poses(solution.rig, cameras, (0, 1, 2), degrees=0.3, away=4)


def test_cameras_far_apart_are_joined_through_those_between():
    cameras = charts.rig(4)
    seen = charts.observations(CHECKER, cameras, charts.board_poses(CHECKER, 12))
    common = {0: range(0, 5), 1: range(0, 9), 2: range(5, 12), 3: range(9, 12)}
    seen = [s for s in seen if s.moment in common[s.camera]]
    solution = solved(CHECKER, cameras, seen)
    assert solution.joined == (0, 1, 2, 3)
    assert_poses(solution.rig, cameras, (0, 1, 2, 3), degrees=0.5, away=10)


def test_bundle_adjustment_ends_where_it_began_without_noise():
    cameras = charts.rig(2)
    poses = charts.board_poses(CHECKER, 4)
    seen = charts.observations(CHECKER, cameras, poses, noise=0)
    rig = RigEstimate(
        np.repeat(charts.INTRINSICS[None], 2, axis=0), *(np.array(x) for x in zip(*cameras, strict=True)),
        *(np.array(x) for x in zip(*poses, strict=True)),
    )  # fmt: skip
    after, _ = adjust_bundle(CHECKER.points, seen, rig, [LENS_MODEL_LADDER[-1].basis] * 2, 0)
    assert np.allclose(after.t, rig.t, atol=1e-6) and np.allclose(after.intrinsics, rig.intrinsics, atol=1e-5)
    shaken = replace(rig, t=rig.t + np.array([[0, 0, 0], [3, -2, 4.0]]), board_shift=rig.board_shift + 2)
    after, _ = adjust_bundle(CHECKER.points, seen, shaken, [LENS_MODEL_LADDER[1].basis] * 2, 0)
    assert np.allclose(after.t, rig.t, atol=1e-3) and np.allclose(after.R, rig.R, atol=1e-5)


# --- folders as people have them


@given(st.text("abcXYZ_-", max_size=8), st.integers(0, 99999), st.integers(0, 3))
def test_the_last_number_of_a_name_is_the_moment(name, number, zeros):
    camera, moment = split_name(f"{name}{'0' * zeros}{number}")
    assert moment == str(number) and camera == name.rstrip("_-")


def test_names_with_more_numbers():
    assert split_name("cam_0_001") == ("cam_0", "1")
    assert split_name("left 12") == ("left", "12")
    assert split_name("07_left") == ("left", "7")
    assert split_name("left") == ("left", "") and split_name("12") == ("", "12")


def picture(path, size=(32, 24)):
    path.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(path), np.full((size[1], size[0]), 99, np.uint8))


@pytest.mark.parametrize(
    "names",
    [
        ["left01.png", "left02.png", "right1.png", "right02.png"],
        ["left/a_01.png", "left/a_02.png", "right/b_1.png", "right/b_2.png"],
        ["left/01.png", "left/02.png", "right/01.png", "right/02.png"],
        ["images/left01.png", "images/left02.png", "images/right01.png", "images/right02.png"],
    ],
)
def test_cameras_and_moments_are_told_from_names(tmp_path, names):
    for name in names:
        picture(tmp_path / name)
    found = find_charts(tmp_path)
    assert [camera.name for camera in found.cameras] == ["left", "right"]
    assert [camera.moments for camera in found.cameras] == [(0, 1), (0, 1)] and found.moments == ("1", "2")
    assert found.cameras[0].size == (32, 24) and not found.problems


def test_what_cannot_be_used_is_named(tmp_path):
    for name in ("left1.png", "left2.png", "left3.png", "right1.png", "right2.png", "left01.png"):
        picture(tmp_path / name)
    picture(tmp_path / "left4.png", (24, 32))
    (tmp_path / "right3.png").write_bytes(b"\x89PNG\r\n\x1a\n broken")
    (tmp_path / "notes.txt").write_text("no picture")
    found = find_charts(tmp_path)
    assert [len(camera.paths) for camera in found.cameras] == [3, 2]
    said = "\n".join(found.problems)
    assert "right3.png" in said and "left4.png" in said and "same moment" in said and len(found.problems) == 3


def test_folders_without_charts(tmp_path):
    with pytest.raises(CaptureError, match="no pictures and no videos"):
        find_charts(tmp_path)
    with pytest.raises(CaptureError, match="no folder"):
        find_charts(tmp_path / "absent")
    (tmp_path / "left1.png").write_bytes(b"")
    with pytest.raises(CaptureError, match="none of its pictures"):
        find_charts(tmp_path)
    (tmp_path / "left.mp4").write_bytes(b"no video")
    with pytest.raises(CaptureError, match=r"left\.mp4"):
        find_charts(tmp_path)


# --- all together

CAMERAS = charts.rig(2, spacing=150, distance=500)
POSES = charts.board_poses(CHECKER, 8, seed=2, spread=50)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Eight moments of a 9x6 checkerboard before two cameras, 25 mm; the twelfth picture is cut short."""
    place = tmp_path_factory.mktemp("charts")
    charts.write_charts(place, CHECKER, CAMERAS, POSES, names=("left", "right"))
    whole = (place / "right04.png").read_bytes()
    (place / "right04.png").write_bytes(whole[: len(whole) // 2])
    return place


@pytest.fixture(scope="module")
def result(folder):
    return calibrate_charts(folder, CHECKER)


@pytest.fixture
def few(folder, tmp_path):
    """The first three moments alone."""
    for number in (1, 2, 3):
        for path in folder.glob(f"*{number:02d}.png"):
            (tmp_path / path.name).write_bytes(path.read_bytes())
    return tmp_path


def test_a_folder_of_pictures_becomes_a_rig(folder, result):
    left, right = (report.camera for report in result.reports)
    assert result.rms < 0.15 and result.unit == "mm"
    assert np.array_equal(left.R, np.eye(3)) and np.array_equal(left.t, np.zeros(3))
    true_R = CAMERAS[1][0] @ CAMERAS[0][0].T
    true_t = CAMERAS[1][1] - true_R @ CAMERAS[0][1]
    assert np.linalg.norm(right.centre + true_R.T @ true_t) < 1.0  # of 157 mm
    assert np.degrees(np.arccos((np.trace(right.R @ true_R.T) - 1) / 2)) < 0.2
    assert left.K[0, 0] == pytest.approx(600, rel=0.01) and abs(left.K[0, 2] - 320) < 4
    assert any("right04.png" in problem for problem in result.problems)
    assert [(r.boards, r.used, r.shared) for r in result.reports] == [(8, 8, 7), (7, 7, 7)]
    field = result.light_field(folder)
    assert field.names == ("left", "right") and field.format == "charts"
    assert [c["used"] for c in json.loads(json.dumps(result.describe(), allow_nan=False))["cameras"]] == [8, 7]
    assert len(table(result)) == 3 and "mm" in table(result)[2]


def test_threads_change_nothing(folder, result):
    def cameras(result):
        return [(r.camera.K.tobytes(), r.camera.R.tobytes(), r.camera.t.tobytes()) for r in result.reports]

    set_threads(1)
    try:
        assert cameras(calibrate_charts(folder, CHECKER)) == cameras(result)
    finally:
        set_threads(None)


@pytest.mark.parametrize("given_size", [(10, 7), (8, 5), (7, 6)])
@pytest.mark.slow
def test_a_board_of_the_wrong_size_is_refused_with_the_right_one(few, given_size, monkeypatch):
    # markers of two families are looked for in vain instead of those of nine, which takes seconds
    monkeypatch.setattr(corners, "_largest_dictionaries", lambda: ["DICT_4X4_1000", "DICT_6X6_1000"])
    with pytest.raises(CaptureError) as caught:
        calibrate_charts(few, boards.checkerboard(*given_size, 25.0))
    assert caught.value.code == "board-size" and "--board 9x6" in caught.value.remedy


def test_one_camera_only(folder, tmp_path):
    for path in folder.glob("left*"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    with pytest.raises(CaptureError) as caught:
        calibrate_charts(tmp_path, CHECKER)
    assert caught.value.code == "charts-one-camera" and "left01" in caught.value.remedy


def test_no_common_moment(few):
    for path in sorted(few.glob("right*")):
        path.rename(path.with_name(path.name.replace("right", "right9")))
    with pytest.raises(CaptureError) as caught:
        calibrate_charts(few, CHECKER)
    assert caught.value.code == "rig-apart" and "left: 3 boards" in str(caught.value)


def test_a_third_camera_that_sees_nothing_is_named(few):
    for number in (1, 2):
        picture(few / f"blind{number}.png", charts.SIZE)
    result = calibrate_charts(few, CHECKER)
    assert "camera blind is left out: it sees no board in its 2 pictures" in result.problems
    assert result.light_field(few).names == ("left", "right")
    assert result.describe()["cameras"][0]["rms"] is None
    assert "sees no board" in table(result)[1]


def test_videos_of_an_inverted_charuco_board(tmp_path):
    poses = charts.board_poses(CHARUCO, 6, seed=4, spread=30)
    charts.write_videos(tmp_path, CHARUCO, CAMERAS, poses, inverted=True)
    result = calibrate_charts(tmp_path, CHARUCO)
    assert [(r.name, r.inverted, r.boards) for r in result.reports] == [("cam_0", True, 5), ("cam_1", True, 5)]
    true = np.linalg.norm(CAMERAS[1][0].T @ CAMERAS[1][1] - CAMERAS[0][0].T @ CAMERAS[0][1])
    assert np.linalg.norm(result.reports[1].camera.centre) == pytest.approx(true, rel=0.02)
    assert any("differ in length" in problem for problem in result.problems)


@pytest.fixture(scope="module")
def charuco_folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("charuco")
    charts.write_charts(place, CHARUCO, CAMERAS, POSES[:1], names=("left", "right"))
    return place


@pytest.mark.parametrize(
    ("wrong", "code", "remedy"),
    [
        (replace(CHARUCO, columns=6, rows=5), "board-size", "--board 5x6"),
        (replace(CHARUCO, columns=6, rows=6), "board-size", "--board 5x6"),
        (replace(CHARUCO, dictionary="DICT_6X6_50"), "board-unseen", "--dictionary DICT_4X4"),
        (replace(CHARUCO, inverted=True), "board-unseen", "--not-inverted"),
        (CHECKER, "board-unseen", "--chart charuco"),
    ],
)
def test_another_charuco_board_is_refused_with_the_right_one(charuco_folder, wrong, code, remedy):
    with pytest.raises(CaptureError) as caught:
        calibrate_charts(charuco_folder, wrong)
    assert caught.value.code == code and remedy in caught.value.remedy


# --- the command line


@click.command()
@chart_options
def verb(**options):
    chart = ChartOptions(**options)
    return board_of(chart, Path()) if chart.chart else None


def described(*words):
    return verb.main(words, standalone_mode=False)


def test_options_describe_the_board(tmp_path):
    assert described() is None
    assert described("--chart", "checkerboard", "--board", "9x6", "--square", "25mm") == CHECKER
    made = boards.charuco(4, 5, 5.4, 4.05, "DICT_4X4_1000", "cm", inverted=True)
    assert replace(made, marker=40.5 * 1e-3 / 1e-2) == described(
        "--chart", "charuco", "--board", "4x5", "--square", "5.4cm", "--marker", "40.5mm", "--inverted"
    )
    (tmp_path / "charuco.toml").write_text(TOML)
    assert described("--chart", "charuco", "--board", str(tmp_path / "charuco.toml")).columns == 4


@pytest.mark.parametrize(
    "words",
    [
        ["--board", "9x6"],
        ["--chart", "checkerboard", "--board", "9x6"],
        ["--chart", "checkerboard", "--square", "25mm"],
        ["--chart", "checkerboard", "--board", "9x6", "--square", "25mm", "--marker", "3"],
        ["--chart", "charuco", "--board", "4x5", "--square", "54"],
        ["--chart", "charuco", "--board", "absent.toml"],
    ],
)
def test_options_that_do_not_go_together(words):
    with pytest.raises(EigenfieldError) as caught:
        described(*words)
    assert caught.value.remedy


def test_the_rig_is_used_with_photographs_named_after_its_cameras(tmp_path, run):
    """From chart pictures in a folder a camera to a light field of a scene, through both files that are written."""
    cameras = charts.rig(3, spacing=100, distance=500)
    how = {"name": "{camera}/shot-{number}.png", "names": ("cam_0", "cam_1", "cam_10")}
    charts.write_charts(tmp_path / "charts", CHECKER, cameras, POSES[:5], **how)
    out, photos = tmp_path / "rig", tmp_path / "photos"
    words = ["calibrate", tmp_path / "charts", "--chart", "checkerboard", "--board", "9x6", "--square", "25mm"]
    code, said, err = run(*words, "-o", out, "--quiet")
    assert code == 0, err
    assert "3 of 3 cameras in mm" in said and "cam_10" in said
    report = json.loads((out / "report.json").read_text())
    assert report["unit"] == "mm" and [c["name"] for c in report["cameras"]] == ["cam_0", "cam_1", "cam_10"]
    for name, extension in (("cam_0", "png"), ("cam_1", "JPG"), ("cam_10", "png")):
        picture(photos / f"{name}.{extension}", charts.SIZE)
    base_R, base_t = cameras[0]
    for written in (out, out / "sparse" / "0"):
        field = open_capture(photos, calibration=written)
        assert [view.path.stem for view in field.views] == ["cam_0", "cam_1", "cam_10"]
        for camera, (R, t) in zip(field.cameras, cameras, strict=True):
            true = base_R @ (-R.T @ t) + base_t
            assert np.linalg.norm(camera.centre - true) < 2
            assert camera.K[0, 2] == pytest.approx(320, abs=6)
    with pytest.raises(OutputError) as caught:
        run(*words, "-o", out, "--quiet", "--traceback")
    assert caught.value.code == "output-exists"


# --- real rigs


@pytest.mark.slow
def test_opencvs_stereo_pairs(data):
    result = calibrate_charts(data / "opencv_stereo_chart", CHECKER)
    left, right = (report.camera for report in result.reports)
    assert result.rms <= 0.3 and all(report.used == 13 for report in result.reports)
    assert np.linalg.norm(right.centre) == pytest.approx(83.6, rel=0.01)
    assert left.K[0, 0] == pytest.approx(535.9, rel=0.01)


@pytest.mark.slow
def test_caliscopes_four_cameras(data):
    folder = data / "caliscope_charuco_rig4"
    board = boards.read_board(folder / "charuco.toml")
    result = calibrate_charts(folder, replace(board, inverted=None))  # which is seen by itself
    assert board.inverted and all(report.inverted for report in result.reports)
    assert result.median <= 0.35 and result.rms <= 0.6
    assert [report.mirrored > 0 for report in result.reports] == [False, True, False, False]
    true = tomllib.loads((folder / "camera_array.toml").read_text())["cameras"]
    theirs = np.array([-np.array(c["rotation"]).T @ c["translation"] for c in true.values()])
    ours = np.array([report.camera.centre for report in result.reports])
    a, b = theirs - theirs.mean(axis=0), ours - ours.mean(axis=0)
    u, s, vt = np.linalg.svd(a.T @ b)
    sign = np.diag([1, 1, np.linalg.det(u @ vt)])
    away = np.linalg.norm(np.trace(np.diag(s) @ sign) / (b**2).sum() * b @ (u @ sign @ vt).T - a, axis=1)
    extent = np.linalg.norm(theirs[:, None] - theirs[None], axis=2).max()
    assert away.max() < 0.01 * extent
    with (folder / "xy.csv").open() as file:  # the corners that the rig's makers found
        assert sum(report.corners for report in result.reports) > 0.95 * sum(1 for _ in csv.reader(file)) - 1
