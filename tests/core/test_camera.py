"""A camera and the rasters that it is drawn on."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.core.camera import Camera
from eigenfield.core.camera_names import named_camera, named_cameras
from eigenfield.core.errors import OptionError

K = np.array([[90.0, 1, 52], [0, 100, 38], [0, 0, 1]])
CAMERA = Camera(K, np.eye(3), np.zeros(3), 100, 80)


@pytest.mark.parametrize(("width", "height", "scale"), [(200, 160, 2), (50, 20, 0.5), (30, 80, 1), (400, 80, 4)])
def test_a_resized_view_covers_its_raster_just_so(width, height, scale):
    """The smallest even scale at which the picture reaches all edges; what it has too much is cut on both sides."""
    ray = np.linalg.inv(K) @ np.array([[0, 0, 1], [100, 80, 1], [50, 40, 1], [25, 60, 1]]).T
    (left, top), (right, bottom), middle, point = CAMERA.resize(width, height).project(3 * ray.T)[0]
    assert middle == pytest.approx([width / 2, height / 2])
    assert right - left == pytest.approx(100 * scale) and bottom - top == pytest.approx(80 * scale)
    assert point - middle == pytest.approx([-25 * scale, 20 * scale])
    assert max(left, top) == pytest.approx(0, abs=1e-9) and min(right - width, bottom - height) == pytest.approx(0)


def test_a_camera_is_called_as_its_photograph():
    names = ("a.png", "A.jpg", "b.png", "c.png", "a.tif")
    assert [named_camera(name, names, "view") for name in ("A.jpg", "a.png", "B", "c.JPG")] == [1, 0, 2, 3]
    with pytest.raises(OptionError) as caught:
        named_camera("a", names, "view")
    assert caught.value.code == "view" and caught.value.remedy == "nearest are a.png, A.jpg, a.tif"


def test_cameras_are_named_with_commas_which_names_may_hold_too():
    names = ("a.png", "b.png", "12.03, 14.05.jpg", "12.03, 14.06.jpg", "a, b,c.png")
    found = {text: named_cameras(text, names, "view") for text in (
        "", " , ", "b.png,a.png", "a, B.jpg,", ",".join(names), "12.03, 14.06, a,12.03, 14.05.JPG", "a, b", "a, b,c,b",
    )}  # fmt: skip
    assert list(found.values()) == [[], [], [1, 0], [0, 1], [0, 1, 2, 3, 4], [3, 0, 2], [0, 1], [4, 1]]
    with pytest.raises(OptionError, match=r"called 12\.03; nearest") as caught:
        named_cameras("a,12.03, 14.07", names, "view")
    assert caught.value.code == "view"
