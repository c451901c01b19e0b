"""The HCI benchmark: names, parameters.cfg, and what remains without it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.capture import LightField, PhotoSet, open_any, open_capture, open_photographs
from eigenfield.capture.readers.hci import read_parameters
from eigenfield.core.errors import CaptureError
from support.named import CFG, CUBE, hci, nodes, places, refused

# HCI


def test_hci_cameras_see_a_cube_where_the_benchmark_says(tmp_path):
    """Right by a column, down by a row; disparity b f (1/Z - 1/F) pixels a step, zero in the plane of focus."""
    light_field = open_any(hci(tmp_path))
    assert isinstance(light_field, LightField) and light_field.format == "hci" and len(light_field) == 9
    f, b, focus = 100 / 35 * 24, 0.006, 1.25
    middle, depth = light_field.cameras[4].project(CUBE)
    assert np.allclose(middle, f * CUBE[:, :2] / CUBE[:, 2:] + [12, 8]) and np.allclose(depth, CUBE[:, 2])
    disparity = b * f * (1 / CUBE[:, 2] - 1 / focus)
    for index, camera in enumerate(light_field.cameras):
        row, column = divmod(index, 3)
        expected = middle - disparity[:, None] * [column - 1, row - 1]
        assert np.allclose(camera.project(CUBE)[0], expected)
        assert np.allclose(camera.project([[0, 0, focus]])[0], [12, 8])
    layout = light_field.layout
    assert layout.exact and layout.signs and layout.rectified and layout.measured and np.isclose(layout.focal, f)
    assert np.allclose(layout.positions, [[c.centre[0] + b, -c.centre[1] - b] for c in light_field.cameras])
    near, far = light_field.views[0].bounds
    assert np.isclose(b * f * (1 / near - 1 / focus), 0.2) and np.isclose(b * f * (1 / far - 1 / focus), -0.3)
    assert light_field.subset([8, 0]).layout.rows.tolist() == [2, 0]


def test_hci_at_half_size_has_cameras_for_it(tmp_path):
    light_field = open_capture(hci(tmp_path, width=12, height=8))
    assert np.isclose(light_field.cameras[0].K[0, 0], 100 / 35 * 12) and np.isclose(light_field.layout.focal, 1200 / 35)


def test_hci_photographs_alone(tmp_path):
    """`open_photographs` leaves the cfg's cameras aside, and keeps what it says of the array."""
    photo_set = open_photographs(hci(tmp_path, width=12, height=8))
    assert isinstance(photo_set, PhotoSet) and photo_set.layout.exact
    assert photo_set.layout.focal == pytest.approx(1200 / 35) and photo_set.shots[3].focal == pytest.approx(1200 / 35)


def test_hci_without_a_cfg_is_a_grid(tmp_path):
    photo_set = open_any(hci(tmp_path, None))
    assert isinstance(photo_set, PhotoSet) and photo_set.layout.shape == (3, 3)
    assert photo_set.layout.exact and photo_set.layout.signs and photo_set.layout.focal is None
    assert nodes(photo_set)["input_Cam005.png"] == (1, 2) and places(photo_set)["input_Cam005.png"] == (2, -1)
    assert "parameters.cfg" in photo_set.problems[0]
    assert "eigenfield calibrate" in str(refused("calibration-missing", tmp_path, open_capture))


def test_hci_grids_that_are_not_square(tmp_path):
    folder = hci(tmp_path, None, 8)
    assert "grid=(ROWS, COLUMNS)" in refused("grid-size", folder).remedy
    assert open_any(folder, grid=(2, 4)).layout.shape == (2, 4)
    assert nodes(open_any(folder, grid=(4, 2)))["input_Cam005.png"] == (2, 1)
    refused("grid-size", folder, grid=(2, 3))
    assert open_any(folder, grid=(3, 3)).problems[-1].endswith("row 2 column 2")


DAMAGED = [
    b"", b"\xff\xfe", b"[intrinsics]", b"focal_length_mm = 1", CFG.replace("= 6.0", "= six").encode(),
    CFG.replace("= 6.0", "= nan").encode(), CFG.replace("= 6.0", "= -6").encode(), CFG.replace("= 6.0", "= 0").encode(),
    CFG.replace("num_cams_x = 3", "num_cams_x = 2.5").encode(), CFG.replace("focal_length_mm = 100.0", "").encode(),
    CFG.replace("sensor_size_mm = 35.0", "sensor_size_mm = 1e-320").encode(), CFG.encode()[:100], b"\0" * 1000,
    CFG.replace("num_cams_y = 3", "num_cams_y = 2").encode(), CFG.replace("focus_distance_m = 1.25", "").encode(),
]  # fmt: skip


@pytest.mark.parametrize("cfg", DAMAGED)
def test_a_damaged_cfg_leaves_the_grid(tmp_path, cfg):
    photo_set = open_any(hci(tmp_path, cfg))
    assert isinstance(photo_set, PhotoSet) and photo_set.layout.shape == (3, 3) and photo_set.layout.focal is None
    assert "parameters.cfg cannot be used" in photo_set.problems[0] and "\n" not in photo_set.problems[0]
    assert "cannot be used" in str(refused("calibration-missing", tmp_path, open_capture))


def test_a_cfg_without_disparities_is_whole(tmp_path):
    light_field = open_capture(hci(tmp_path, CFG.replace("disp_min = -0.3", "")))
    assert len(light_field) == 9 and light_field.views[0].bounds is None


@settings(max_examples=200)
@given(st.integers(0, len(CFG) - 1), st.binary(max_size=6), st.integers(0, 12))
def test_any_cfg_is_read_or_refused(tmp_path_factory, at, change, cut):
    path = tmp_path_factory.getbasetemp() / "any.cfg"
    data = CFG.encode()
    path.write_bytes(data[:at] + change + data[at + cut :])
    try:
        found = read_parameters(path)
    except CaptureError as error:
        assert "\n" not in str(error)
    else:
        values = np.array([found.focal, found.baseline, found.focus])
        assert np.isfinite(values).all() and (values > 0).all() and found.depth(0) > 0
