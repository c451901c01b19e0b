"""Neighbouring photographs: parallax, overlap and exposure of pictures made with known ones."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from eigenfield.calibration import measure_neighbours
from eigenfield.calibration.neighbours import epipolar_matches, nearest_pairs, neighbours_of
from eigenfield.capture import open_any
from eigenfield.imaging.png import png_bytes
from support.captures import write_capture

NEAR, FAR, SIZE = 13, 3, (240, 320)  # pixels by which bands of a picture move to the next, and (H, W)
STOPS = 0.4


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Four photographs of bands that are near and far in turn; the last is brighter."""
    folder = tmp_path_factory.mktemp("bands")
    noise = np.random.default_rng(4).uniform(0.1, 0.6, (SIZE[0], 400, 3)).astype(np.float32)
    wall = cv2.GaussianBlur(noise, (0, 0), 1.5)
    wall = (wall - wall.min()) / np.ptp(wall) * np.float32(0.7)
    near = np.arange(SIZE[0]) // 40 % 2 == 0
    for number in range(4):
        picture = np.where(near[:, None, None], *(wall[:, d * number :][:, : SIZE[1]] for d in (NEAR, FAR)))
        if number == 3:
            picture = picture * 2 ** (STOPS / 2.2)
        (folder / f"photo_{number}.png").write_bytes(png_bytes(picture.astype(np.float32)))
    return folder


def test_parallax_overlap_and_exposure_are_those_that_were_made(folder):
    pairs = measure_neighbours(open_any(folder, strict=False), range(4))
    assert [(pair.first, pair.second) for pair in pairs] == [(0, 1), (1, 2), (2, 3)]
    for pair in pairs:
        assert pair.parallax == pytest.approx(NEAR - FAR, abs=0.3)
        assert 1 - NEAR / SIZE[1] - 0.05 <= pair.overlap <= 1 - FAR / SIZE[1] + 0.05
    assert [pair.stops for pair in pairs] == pytest.approx([0, 0, STOPS], abs=0.03)


def test_photographs_left_out_have_no_pair(folder):
    capture = open_any(folder, strict=False)
    assert neighbours_of(capture, [0, 2, 3]) == [(0, 2), (2, 3)] and neighbours_of(capture, [1]) == []
    (wide,) = measure_neighbours(capture, [0, 2])
    assert wide.parallax == pytest.approx(2 * (NEAR - FAR), abs=0.5)


def test_neighbours_are_the_nearest_cameras(tmp_path):
    capture = open_any(write_capture(tmp_path / "c"))
    pairs = neighbours_of(capture, range(9))
    assert all(abs(a - b) in (1, 3) for a, b in pairs) and {i for pair in pairs for i in pair} == set(range(9))


def test_shots_from_one_place_are_no_neighbours():
    line = np.stack([np.linspace(-1.2, 1.2, 9), np.zeros(9)], axis=1)
    shots = np.repeat(line, 3, axis=0) + 0.002 * (np.arange(27) % 3)[:, None]
    assert {(j - i, i % 3) for i, j in nearest_pairs(shots)} == {(3, 0)}
    dense = np.stack([np.linspace(0, 1, 300), np.zeros(300)], axis=1)  # steps of 0.3 % of its length
    assert {j - i for i, j in nearest_pairs(dense)} == {1}
    assert nearest_pairs(np.zeros((3, 3)))  # all in one place are still looked at


def test_what_shows_nothing_in_common_is_no_pair(tmp_path):
    for number in range(3):
        (tmp_path / f"{number}.png").write_bytes(png_bytes(np.full((64, 64, 3), 0.2 + 0.1 * number, np.float32)))
    assert measure_neighbours(open_any(tmp_path, strict=False), range(3)) == []


def test_points_on_which_opencv_fails_are_matched_all_the_same():
    matches = np.loadtxt(Path(__file__).parents[1] / "data/matches.csv", delimiter=",")
    assert epipolar_matches(matches[:, :2], matches[:, 2:], 2.0).sum() > 0.9 * len(matches)
