"""Names of cameras by what they have in common: exactly the same names again, or none."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from eigenfield.core.errors import FormatError
from eigenfield.gltf.name_pattern import name_pattern, read_pattern
from eigenfield.gltf.strict_json import Value

ARRAY = [f"out_{row:02d}_{column:02d}.jpg" for row in range(17) for column in range(17)]
STEPS = [f"view {4 * row + 2} {column:03d}" for row in range(7) for column in range(9)]
FILM = [f"frame{number}.png" for number in range(97, 131)]
PLACES = [
    f"{3 * row + 1:02d}_{3 * column + 1:02d}_{369.23 - 92.3 * row:.6f}_{-369.23 + 92.3 * column:.6f}_30.jpg"
    for row in range(9)
    for column in range(9)
]


@pytest.mark.parametrize("names", [ARRAY, STEPS, FILM, PLACES], ids=["array", "steps", "film", "places"])
def test_names_come_back(names):
    pattern = name_pattern(names)
    assert pattern is not None and read_pattern(Value(pattern)) == names
    assert len(str(pattern)) < len(str(names)) / 2


def test_an_array_is_counted_by_rows_and_columns():
    number = {"first": 0, "step": 1, "digits": 2}
    assert name_pattern(ARRAY) == {
        "counts": [17, 17], "parts": ["out_", {"axis": 0, **number}, "_", {"axis": 1, **number}, ".jpg"],
    }  # fmt: skip


@pytest.mark.parametrize("names", [["a", "b"], ["one.png"], [*ARRAY[1:], "x"], ["17", "4", "23", "9", "11"]])
def test_other_names_have_none(names):
    assert name_pattern(names) is None


@given(st.lists(st.text("a0197._-", max_size=6), min_size=1, max_size=24))
def test_any_pattern_gives_exactly_the_names(names):
    pattern = name_pattern(names)
    assert pattern is None or read_pattern(Value(pattern)) == names


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"counts": [17]}, "json-value"),
        ({"counts": [100_000, 2]}, "json-value"),
        ({"counts": [0, 2]}, "json-value"),
        ({"parts": []}, "json-value"),
        ({"parts": [7]}, "json-type"),
        ({"parts": [{"axis": 2, "first": 0, "step": 1, "digits": 2}]}, "json-value"),
        ({"parts": [{"axis": 0, "first": 0, "step": 1, "digits": 40}]}, "json-value"),
        ({"parts": [{"axis": 0, "texts": ["a"]}]}, "json-value"),
        ({"parts": [{"axis": 0, "first": 0, "step": 1}]}, "json-missing"),
        ({"parts": ["x" * 1000, {"axis": 0, "first": 0, "step": 1, "digits": 2}, "y" * 1000]}, "json-value"),
    ],
)
def test_patterns_that_cannot_be_are_refused(change, code):
    with pytest.raises(FormatError) as caught:
        read_pattern(Value({**(name_pattern(ARRAY) or {}), **change}))
    assert caught.value.code == code
