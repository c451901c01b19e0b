"""Coded names of cameras: the same names again, few bytes, damaged ones refused."""

from __future__ import annotations

import json
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from eigenfield.coding import limits
from eigenfield.coding.arrays.names import code_names, decode_names
from eigenfield.core.errors import FormatError
from eigenfield.gltf.name_pattern import name_pattern

MEASURED = [
    f"jpg_out_{row:02d}_{column:02d}_{x:.6f}_{y:.6f}.jpg"
    for row in range(17)
    for column in range(17)
    for x, y in [np.random.default_rng([row, column]).normal([-700 - 9 * row, 460 + 9 * column], 0.5)]
]


def test_measured_positions_take_few_bytes():
    stream = code_names(MEASURED)
    assert stream is not None and decode_names(stream, len(MEASURED)) == MEASURED
    assert len(stream) < len(json.dumps(name_pattern(MEASURED) or MEASURED)) / 5
    assert len(stream) < 0.7 * len(zlib.compress("\n".join(MEASURED).encode(), 9))


@given(st.lists(st.text(st.characters(exclude_categories=["Cs"]), max_size=9), min_size=1, max_size=20))
def test_any_names_come_back(names):
    stream = code_names(names)
    if stream is None:
        assert not any(names) or any("\0" in name for name in names)
    else:
        assert decode_names(stream, len(names)) == names


def test_names_without_utf8_are_not_coded():
    assert code_names(["a", "\udcff"]) is None


@pytest.mark.parametrize(
    ("stream", "count", "code"),
    [
        (b"no zlib", 3, "coded-damaged"),
        (code_names(MEASURED)[:-5], 289, "coded-truncated"),
        (b"", 289, "coded-truncated"),
        (code_names(MEASURED) + b"more", 289, "coded-damaged"),
        (code_names(MEASURED), 288, "coded-damaged"),
        (zlib.compress(b""), 1, "coded-damaged"),
        (zlib.compress(b"\xff\xfe"), 1, "coded-damaged"),
        (zlib.compress(bytes(limits.MAX_NAMES + 1)), limits.MAX_CAMERAS, "coded-size"),
        (zlib.compress(bytes(limits.MAX_NAMES)), 2, "coded-size"),
    ],
)
def test_damaged_names_are_refused(stream, count, code):
    with pytest.raises(FormatError) as raised:
        decode_names(stream, count)
    assert raised.value.code == code


@given(st.binary(max_size=300), st.integers(1, 400))
def test_any_bytes_are_names_or_a_format_error(data, count):
    for stream in (data, zlib.compress(data)):
        try:
            names = decode_names(stream, count)
        except FormatError:
            continue
        assert len(names) == count
