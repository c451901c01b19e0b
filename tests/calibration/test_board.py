"""Boards, the lens model, and corners found in pictures."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.calibration.charts import board as boards
from eigenfield.calibration.charts.corners import BoardVariant, board_variants, find_corners
from eigenfield.calibration.charts.intrinsics import estimate_intrinsics
from eigenfield.calibration.charts.lens_models import LENS_MODEL_LADDER, project_points, project_points_with_derivatives
from eigenfield.core.errors import CaptureError, OptionError
from support import charts
from support.charts import CHARUCO, CHECKER, TOML

# --- boards


@given(st.integers(3, 9), st.integers(3, 9))
def test_turns_of_a_checkerboard_are_rotations_and_colours_decide_between_them(columns, rows):
    board = boards.checkerboard(columns, rows, 1.0)
    points = board.points[:, :2]
    middle = points.mean(axis=0)

    def dark(where):  # colour of the square up and left of a corner
        return np.floor(where).astype(int).sum(axis=1) % 2

    def turned(turn):
        source, target = points - middle, points[turn] - middle
        R = np.linalg.lstsq(source, target, rcond=None)[0].T
        assert np.allclose(R @ R.T, np.eye(2)) and np.linalg.det(R) > 0
        assert np.allclose(source @ R.T, target)
        squares = np.array([[x + 0.5, y + 0.5] for x in range(columns - 1) for y in range(rows - 1)])
        return dark(squares), dark((squares - middle) @ R.T + middle)

    symmetries = board.symmetries()
    assert np.array_equal(symmetries[0], np.arange(columns * rows))
    for turn in symmetries:
        before, after = turned(turn)
        assert np.array_equal(before, after)
    expected = {True: 4 if columns % 2 == 0 else 2, False: 2 if (columns + rows) % 2 == 0 else 1}
    assert len(symmetries) == expected[columns == rows]
    if board.colour_swapping_rotation() is not None:
        before, after = turned(board.colour_swapping_rotation())
        assert np.array_equal(before, 1 - after)


def test_sizes_and_lengths_are_read_as_people_write_them():
    assert (
        boards.parse_board_size("9x6") == boards.parse_board_size(" 9 X 6") == boards.parse_board_size("9,6") == (9, 6)
    )
    assert boards.parse_length("25mm") == (25.0, "mm")
    assert boards.parse_length("2.5 cm") == (2.5, "cm") and boards.parse_length("1in") == (1.0, "in")
    assert boards.parse_length("54") == (54.0, "")
    assert boards.convert_length(2.5, "cm", "mm") == pytest.approx(25)
    assert boards.convert_length(2.5, "", "mm") == 2.5
    for text in ("9", "9x", "9x6x3", "-9x6"):
        with pytest.raises(OptionError, match="COLUMNSxROWS"):
            boards.parse_board_size(text)
    for text in ("", "mm", "25 furlongs", "-3", "nan"):
        with pytest.raises(OptionError, match="is no length"):
            boards.parse_length(text)


@pytest.mark.parametrize(
    ("make", "code"),
    [
        (lambda: boards.checkerboard(2, 6, 25), "board-size"),
        (lambda: boards.checkerboard(9, 600, 25), "board-size"),
        (lambda: boards.checkerboard(9, 6, 0), "square"),
        (lambda: boards.checkerboard(9, 6, float("nan")), "square"),
        (lambda: boards.charuco(4, 5, 54, 54), "marker"),
        (lambda: boards.charuco(4, 5, 54, 40, "DICT_9X9_7"), "dictionary"),
        (lambda: boards.charuco(12, 12, 54, 40, "DICT_4X4_50"), "dictionary"),
    ],
)
def test_boards_that_cannot_be(make, code):
    with pytest.raises(OptionError) as caught:
        make()
    assert caught.value.code == code and caught.value.remedy


def test_a_charuco_toml_describes_a_board(tmp_path):
    path = tmp_path / "charuco.toml"
    path.write_text(TOML)
    board = boards.read_board(path)
    assert (board.columns, board.rows, board.square, board.unit, board.inverted) == (4, 5, 5.4, "cm", True)
    assert board.marker == pytest.approx(4.05)
    path.write_text('columns = 4\nrows = 5\nboard_width = 8.0\nboard_height = 11\nunits = "inch"\n')
    board = boards.read_board(path)
    assert (board.square, board.unit, board.marker, board.inverted) == (2.0, "in", 1.5, None)


@pytest.mark.parametrize(
    "text",
    ["columns = ", "columns = 4", TOML.replace("rows = 5", 'rows = "5"'), TOML.replace("true", "1"), "\xff\xfe",
     TOML.replace("5.4", "nan"), TOML.replace('"DICT_4X4_1000"', "7")],
)  # fmt: skip
def test_a_damaged_charuco_toml(tmp_path, text):
    path = tmp_path / "charuco.toml"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(CaptureError) as caught:
        boards.read_board(path)
    assert caught.value.code == "board-file" and str(path) in str(caught.value)


# --- lenses


@given(st.integers(0, 2**31))
@settings(max_examples=20)
def test_projection_is_opencvs_and_its_derivatives_are_right(seed):
    random = np.random.default_rng(seed)
    points = random.uniform([-1, -1, 1.5], [1, 1, 3], (7, 3))
    row = np.array([500.0, 510, 320, 240, *random.uniform(-0.1, 0.1, 5)])
    K = np.array([[row[0], 0, row[2]], [0, row[1], row[3]], [0, 0, 1]])
    theirs = cv2.projectPoints(points, np.zeros(3), np.zeros(3), K, row[4:])[0][:, 0]
    at, by_point, by_intrinsics = project_points_with_derivatives(points, row)
    assert np.allclose(at, theirs, atol=1e-9) and np.allclose(project_points(points, row), at)
    for axis in range(3):
        step = np.eye(3)[axis] * 1e-6
        slope = (project_points(points + step, row) - project_points(points - step, row)) / 2e-6
        assert np.allclose(by_point[:, :, axis], slope, atol=1e-3)
    for k in range(9):
        step = np.eye(9)[k] * 1e-6
        slope = (project_points(points, row + step) - project_points(points, row - step)) / 2e-6
        assert np.allclose(by_intrinsics[:, :, k], slope, atol=1e-3)


def test_the_lens_model_is_as_loose_as_the_pictures_ask_for():
    true = charts.INTRINSICS.copy()
    true[:5] = 600, 600, 331, 228, -0.25
    true[5] = 0.08
    poses = charts.board_poses(CHECKER, 14, tilt=45, spread=150)
    plain = charts.observations(CHECKER, [charts.look_at([0, 0, -420.0])], poses, noise=0.1)
    bent = charts.observations(CHECKER, [charts.look_at([0, 0, -420.0])], poses, noise=0.1, intrinsics=true)
    start = estimate_intrinsics(CHECKER.points, [s.corners for s in plain], charts.SIZE)
    assert start.model in LENS_MODEL_LADDER[:3]
    assert np.allclose(start.intrinsics[:4], charts.INTRINSICS[:4], atol=3)
    start = estimate_intrinsics(CHECKER.points, [s.corners for s in bent], charts.SIZE)
    assert start.model.distortion >= 1 and start.model.centre
    assert np.allclose(start.intrinsics[:4], true[:4], atol=3)


def test_an_observation_that_does_not_fit_its_camera_is_left_out():
    seen = [s.corners for s in charts.observations(CHECKER, charts.rig(1), charts.board_poses(CHECKER, 10), noise=0.1)]
    seen[4] = replace(seen[4], pixels=seen[4].pixels + np.random.default_rng(1).normal(0, 4, seen[4].pixels.shape))
    start = estimate_intrinsics(CHECKER.points, seen, charts.SIZE)
    assert 4 not in start.inliers and len(start.inliers) == 9
    assert estimate_intrinsics(CHECKER.points, seen[:2], charts.SIZE) is None


# --- corners in pictures

POSE = charts.board_poses(CHECKER, 3, seed=5)[2]
NEAR = charts.look_at([40.0, -30, -500])


@pytest.mark.parametrize("inverted", [False, True])
@pytest.mark.parametrize("roll", [0, 95, 180])
def test_corners_of_a_checkerboard_keep_their_names_however_the_camera_is_held(inverted, roll):
    camera = charts.look_at([40.0, -30, -500], roll=roll)
    grey, true = charts.photograph(CHECKER, camera, POSE, inverted=inverted)
    first = find_corners(grey, CHECKER, BoardVariant(False))
    found = find_corners(grey, CHECKER, BoardVariant(inverted))
    assert np.abs(found.pixels - true[found.ids if not inverted else found.ids[::-1]]).max() < 0.15
    if first is not None:  # the sector-based detector finds both kinds
        assert np.abs(first.pixels - found.pixels).max() < 0.2


@pytest.mark.parametrize("how", [{}, {"inverted": True}, {"mirrored": True}, {"legacy": True}])
def test_corners_of_a_charuco_board(how):
    grey, true = charts.photograph(CHARUCO, NEAR, charts.board_poses(CHARUCO, 3, seed=5)[2], **how)
    found = {variant: find_corners(grey, CHARUCO, variant) for variant in board_variants(CHARUCO)}
    best = max(found, key=lambda look: 0 if found[look] is None else len(found[look].ids))
    assert best == BoardVariant(how.get("inverted", False), how.get("legacy", False))
    assert found[best].mirrored == how.get("mirrored", False)
    assert len(found[best].ids) == 20
    assert np.abs(found[best].pixels - true[found[best].ids]).max() < 0.3


def test_a_picture_without_a_board_has_no_corners():
    grey = np.random.default_rng(0).integers(0, 255, (240, 320), dtype=np.uint8)
    assert find_corners(grey, CHECKER, BoardVariant(False)) is None
    assert find_corners(grey, CHARUCO, BoardVariant(True)) is None
    assert find_corners(np.zeros((8, 8), np.uint8), CHECKER, BoardVariant(False)) is None
