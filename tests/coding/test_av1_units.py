"""Bare AV1 pictures: their units and the size in the sequence header, and what is none refused."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.coding.pictures.av1_units import frame_size, picture_units, units
from eigenfield.coding.pictures.pictures_10bit import decode_10bit, encode_10bit
from eigenfield.core.errors import FormatError

SVT_128X96 = bytes.fromhex("0a0a0000000337fbe157ca42")  # what SVT-AV1 writes
REDUCED_64X64 = bytes([0x0A, 0x04, 0b00011000, 0b00010101, 0b01111111, 0b11111100])  # 6 bits a side, of level 0


def test_the_size_is_that_of_the_sequence_header():
    assert frame_size(memoryview(SVT_128X96), "here") == (128, 96)
    assert frame_size(memoryview(REDUCED_64X64), "here") == (64, 64)


@pytest.mark.parametrize(("height", "width"), [(64, 64), (66, 130), (96, 2048)])
def test_a_picture_is_a_sequence_header_and_a_frame(height, width):
    data = encode_10bit(np.full((height, width), 300, np.uint16), 30, 8)
    assert [kind for kind, *_ in units(data)] == [1, 6]
    assert frame_size(memoryview(data), "here") == (width, height)
    assert decode_10bit(data, False, "here").shape == (height, width)
    assert picture_units(b"\x12\x00" + data) == data  # without the temporal delimiter


@pytest.mark.parametrize(
    "data",
    [b"", b"\x0a", SVT_128X96[:6], b"\x12\x00", b"\x32" + SVT_128X96[1:], b"\x0a\x0a\x04" + SVT_128X96[3:], bytes(40)],
    ids=["nothing", "no length", "cut off", "a delimiter", "a frame", "timing", "zeros"],
)
def test_what_is_no_sequence_header_is_refused(data):
    with pytest.raises(FormatError) as caught:
        frame_size(memoryview(data), "here")
    assert caught.value.code == "picture-damaged" and caught.value.where == "here"


@given(st.binary(max_size=80))
@settings(max_examples=300)
def test_any_bytes_are_read_or_refused(data):
    pieces = [data[start:end] for _, start, _, end in units(data)]
    assert data.startswith(b"".join(pieces)) and len(picture_units(data)) <= len(data)
    try:
        width, height = frame_size(memoryview(data), "here")
    except FormatError as error:
        assert error.code == "picture-damaged"
    else:
        assert 1 <= width <= 2**16 and 1 <= height <= 2**16


def test_more_frames_than_one_are_not_decoded():
    data = encode_10bit(np.full((64, 64), 300, np.uint16), 30, 8)
    assert np.array_equal(decode_10bit(data * 1000, False, "here"), decode_10bit(data, False, "here"))
