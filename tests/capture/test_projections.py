"""3x4 projection matrices, taken apart."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.capture.readers.projections import decompose_projection, find_projections, read_projections
from support import calibrations as write
from support.calibrations import stations
from support.readers import check_cube, check_lens

# projection matrices


@pytest.mark.parametrize(("inner", "ending"), [("", ".P"), ("P", ".txt"), ("projections", "_P.txt"), ("txt", ".txt")])
def test_projections_under_their_names(tmp_path, inner, ending):
    path = write.projections(tmp_path / inner, stations(), ending)
    assert find_projections(tmp_path) == path
    check_cube(read_projections(path), stations())


def test_projections_of_pmvs_name_visualize(tmp_path):
    (tmp_path / "visualize").mkdir()
    path = write.projections(tmp_path / "txt", stations(), ".txt")
    assert read_projections(path).entries[0].file == "visualize/a0"


def test_projections_with_skew_are_straightened(tmp_path):
    skew = 2.0
    calibration = read_projections(write.projections(tmp_path, stations(), skew=skew))
    for entry, s in zip(calibration.entries, stations(), strict=True):

        def pixels(points, s=s):
            x, y, z = s.along(points).T
            return np.stack([(s.fx * x + skew * y) / z + s.cx, s.fy * y / z + s.cy], axis=1)

        check_lens(entry, pixels)
    calibration = read_projections(write.projections(tmp_path, stations(), skew=20.0))
    assert {error.code for error in calibration.errors} == {"camera-skew"}


def test_projections_singular(tmp_path):
    path = write.projections(tmp_path, stations())
    (path / "b1_P.txt").write_text("0 " * 12)
    (path / "c2_P.txt").write_text("1 0 0 0 0 1 0 0 0 0 0 1")  # an affine camera
    calibration = read_projections(path)
    assert len(calibration.entries) == 2
    assert [error.code for error in calibration.errors] == ["camera-singular"] * 2


@given(
    st.lists(st.floats(-3, 3), min_size=3, max_size=3),
    st.lists(st.floats(-50, 50), min_size=3, max_size=3),
    st.floats(10, 5000),
    st.floats(0.5, 2),
    st.sampled_from([1.0, -1.0, 1e-12, -1e9]),
)
@settings(max_examples=100)
def test_a_projection_comes_apart_as_it_was_made(turn, centre, focal, aspect, factor):
    R = cv2.Rodrigues(np.array(turn))[0]
    K = np.array([[focal, 0.3, 320.5], [0, focal * aspect, 200.25], [0, 0, 1]])
    P = factor * K @ R @ np.hstack([np.eye(3), -np.array(centre)[:, None]])
    K2, R2, centre2 = decompose_projection(P, "x", Path("x"))
    assert np.allclose(K2, K, rtol=1e-8, atol=1e-6 * focal)
    assert np.allclose(R2, R, atol=1e-9)
    assert np.allclose(centre2, centre, atol=1e-7)
