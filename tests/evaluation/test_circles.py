"""Circles of pixels to leave out, and the files that say where they are."""

from __future__ import annotations

import json

import numpy as np
import pytest

from eigenfield.core.errors import OptionError
from eigenfield.evaluation import ExcludedCircle, read_circles


def test_a_circle_holds_the_pixels_whose_centre_it_holds():
    assert np.argwhere(~ExcludedCircle(2.5, 1.5, 1.0).outside(5, 4)).tolist() == [
        [0, 2],
        [1, 1],
        [1, 2],
        [1, 3],
        [2, 2],
    ]


def test_circles_are_matched_by_name_then_by_file(tmp_path):
    path = tmp_path / "ball.json"
    one = {"cx": 1, "cy": 2.5, "r": 3}
    path.write_text(json.dumps({"about": "", "circles": {"images/a.jpg": one, "x/b.jpg": one, "y/b.jpg": one}}))
    assert read_circles(path, ["a.jpg", "c.jpg"]) == {"a.jpg": ExcludedCircle(1, 2.5, 3)}
    assert read_circles(path, ["y/b.jpg", "z/a.jpg"]) == {
        "y/b.jpg": ExcludedCircle(1, 2.5, 3),
        "z/a.jpg": ExcludedCircle(1, 2.5, 3),
    }
    with pytest.raises(OptionError) as caught:  # two files of that name in the scene: which is meant?
        read_circles(path, ["p/a.jpg", "q/a.jpg", "c.jpg", "b.jpg"])
    assert caught.value.code == "circles-unmatched"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("{", "circles-unreadable"),
        ("[]", "circles-malformed"),
        ('{"circles": []}', "circles-malformed"),
        ('{"circles": {"a": {"cx": 1, "cy": 2}}}', "circles-malformed"),
        ('{"circles": {"a": {"cx": 1, "cy": NaN, "r": 1}}}', "circles-malformed"),
        ('{"circles": {"a": {"cx": 1, "cy": 2, "r": -1}}}', "circles-malformed"),
        ('{"circles": {"a": 7}}', "circles-malformed"),
        ('{"circles": {"b": {"cx": 1, "cy": 2, "r": 1}}}', "circles-unmatched"),
    ],
)
def test_circle_files_that_cannot_be_used(tmp_path, text, code):
    path = tmp_path / "ball.json"
    path.write_text(text)
    with pytest.raises(OptionError) as caught:
        read_circles(path, ["a"])
    assert caught.value.code == code
    assert str(path) in str(caught.value)


def test_a_circle_file_that_is_not_there(tmp_path):
    with pytest.raises(OptionError) as caught:
        read_circles(tmp_path / "none.json", ["a"])
    assert caught.value.code == "circles-unreadable"
