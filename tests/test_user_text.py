"""Whatever a person's file or option says, it is read, or one of our errors: one fuzz test for each of these parsers.

Calibrations, batches, meshes, photographs and scenes have fuzz tests of their own (docs/contributing.md).
"""

from __future__ import annotations

import json

import click
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from eigenfield.calibration.charts.board import charuco, checkerboard, parse_board_size, parse_length, read_board
from eigenfield.capture.holdout import held_out_cameras
from eigenfield.capture.readers.grid_names import compile_pattern
from eigenfield.capture.readers.video import parse_frame
from eigenfield.capture.readers.xml_tree import load_xml
from eigenfield.cli import drawing
from eigenfield.cli.capture_options import _parse_grid, _parse_layers
from eigenfield.cli.common import pair_of_numbers
from eigenfield.cli.export import _parse_quilt
from eigenfield.core.camera_names import named_camera, named_cameras
from eigenfield.core.errors import EigenfieldError
from eigenfield.core.rights import Rights
from eigenfield.encoding.target import Target, parse_size
from eigenfield.evaluation import read_circles
from eigenfield.proxy.primitives.shapes import parse_primitive
from eigenfield.proxy.primitives.sphere_fit import parse_region
from support.fuzzed import QUIET

NAMES = "a.png", "b.png", "c.png", "d.png", "e.png"
COMMAS = "a,b.png", "c.png", "d,,e.png"
PLACES = np.array([[0.0, 0], [1, 0], [0, 1], [1, 1], [2, 2]])
DIGITS = "9" * 5000
BADLY = [
    "",
    "\0",
    "nan",
    "inf",
    "-1",
    "0",
    "1e400",
    DIGITS,
    "-" + DIGITS,
    "٣",
    "1_0",
    "\udcff",
    "a\nb",
    "(" * 200,
    "1e-999999999",
]
LEAVES = st.sampled_from([None, True, 0, -1, 1e308, 10**20, 10**4000, "", "cm", "\0", "\ud800", "DICT_4X4_50", [], {}])
VALUES = st.recursive(LEAVES | st.floats() | st.text("a\0é\n", max_size=4), lambda inner: st.lists(inner, max_size=3))


def check(parse, *given):
    """It returns, or raises an error of ours or of click, which is one line."""
    try:
        return parse(*given)
    except EigenfieldError as error:
        assert "\n" not in str(error) and error.code
    except click.BadParameter as error:
        assert "\n" not in error.message
    return None


def as_option(callback):
    return lambda text: callback(None, None, text)


OPTIONS = {
    "at": (as_option(drawing.parse_place), "0.3,-0.2"),
    "background": (as_option(drawing._parse_colour), "#ff8800"),
    "board": (lambda text: checkerboard(*parse_board_size(text), 25.0), "5x7"),
    "dictionary": (lambda text: charuco(5, 7, 2.0, 1.0, text), "DICT_4X4_50"),
    "fit-sphere": (parse_region, "a.png:1,2,3,4"),
    "fps": (as_option(drawing._parse_rate), "24000/1001"),
    "frame": (parse_frame, "2.5s"),
    "grid": (as_option(_parse_grid), "17x17"),
    "hold-out": (lambda text: held_out_cameras(text, NAMES, PLACES), "every:5"),
    "hold-out names": (lambda text: held_out_cameras(text, NAMES, PLACES), "a,b.png"),
    "leave-out": (lambda text: named_cameras(text, COMMAS, "leave-out"), "a,b.png,c"),
    "layers": (as_option(_parse_layers), "12"),
    "length": (lambda text: checkerboard(5, 7, *parse_length(text)), "40.5mm"),
    "pattern": (compile_pattern, "view_{row}_{col}*.png"),
    "primitive": (parse_primitive, "sphere:1,2,3,4"),
    "primitive plane": (parse_primitive, "plane:1,2,3,0,0,1,4"),
    "quilt": (as_option(_parse_quilt), "8x6"),
    "reference": (lambda text: named_camera(text, NAMES, "reference"), "a.png"),
    "rights": (lambda text: Rights(title=text), "My scene"),
    "resolution": (as_option(pair_of_numbers("WxH")), "640x480"),
    "target-size": (lambda text: Target(size=parse_size(text)).check(), "1.5MB"),
}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", OPTIONS)
def test_options(name):
    parse, good = OPTIONS[name]
    parse(good)
    for bad in BADLY:
        for text in (bad, *(good.replace(part, bad) for part in good if part.isalnum()), good + bad, bad + good):
            check(parse, text)

    @settings(max_examples=30, derandomize=True, **QUIET)
    @given(st.text(st.sampled_from(good + "0,:;-.xe*{}[]()s ßЖ\n\0"), max_size=12))
    def many(text):
        check(parse, text)

    many()


def circles(document: object) -> bytes:
    return json.dumps(document).encode()


HOSTILE = [
    b"", b"\xff\xfe", b"[" * 100_000, b'{"circles":' * 100_000, b"\0" * 20, b'{"circles": {"a.png": ' + b"[" * 5000,
    b'{"circles": {"a.png": {"cx": 1, "cy": 2, "r": ' + DIGITS.encode() + b"}}}", b"columns = " + DIGITS.encode(),
    b"columns = 4\nrows = 5\nx = " + b"[" * 5000, b"a." * 1000 + b"a = 1", b"columns = 4\ncolumns = 5",
    b'<?xml version="1.0"?><!DOCTYPE a [<!ENTITY b "bb"><!ENTITY c "&b;&b;">]><a>&c;</a>', b"<a>" * 100_000,
    b'<!DOCTYPE a SYSTEM "file:///etc/passwd"><a/>', b"<a " + b'b="' + b"x" * 1_000_000 + b'"/>', b"<a>&#0;</a>",
]  # fmt: skip
BOARD = b"columns = 4\nrows = 5\nboard_width = 8.5\nboard_height = 11\nunits = 'inch'\naruco_scale = 0.7"
FILES = {
    "circles": (lambda path: read_circles(path, NAMES), b'{"circles": {"a.png": {"cx": 1, "cy": 2.5, "r": 3}}}'),
    "board": (
        read_board,
        BOARD,
    ),
    "xml": (load_xml, b"<document><chunk label='a'><camera id='0'/></chunk></document>"),
}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", FILES)
def test_files(name, tmp_path):
    parse, good = FILES[name]
    path = tmp_path / "file"

    def read(data: bytes) -> None:
        path.write_bytes(data)
        check(parse, path)

    path.write_bytes(b"\xef\xbb\xbf" + good)
    assert parse(path) is not None
    for data in HOSTILE:
        read(data)

    @settings(max_examples=25, derandomize=True, **QUIET)
    @given(
        st.integers(0, len(good)),
        st.integers(0, 8),
        st.binary(max_size=6) | st.sampled_from([b"null", b"1e999", b"{}"]),
    )
    def edited(at, gone, more):
        read(good[:at] + more + good[at + gone :])

    edited()


@settings(max_examples=25, derandomize=True, **QUIET)
@given(st.sampled_from(["circles", "cx", "r", "entry", "key"]), VALUES)
@example("r", 1e308)
def test_values_of_circles(tmp_path_factory, place, value):
    circle = {"cx": 1, "cy": 2, "r": 3}
    entry = value if place == "entry" else {**circle, place: value}
    document = {"circles": value if place == "circles" else {str(value) if place == "key" else "a.png": entry}}
    path = tmp_path_factory.getbasetemp() / "circles.json"
    path.write_bytes(json.dumps(document, allow_nan=True).encode())
    found = check(read_circles, path, NAMES)
    for one in (found or {}).values():
        one.outside(4, 3)
