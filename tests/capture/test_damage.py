"""Damaged calibrations raise nothing but errors that people can mend."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.capture.photographs.lens import source_positions
from eigenfield.capture.readers.filestorage import load_storage
from eigenfield.capture.readers.opencv import find_opencv, read_opencv
from eigenfield.core.errors import CaptureError
from support.calibrations import HEIGHT, WIDTH
from support.readers import FINDERS, FORMATS, WRITERS

# damage


def survives(find, read, folder: Path, path: Path) -> None:
    """Finding never raises; reading, and what is done with the entries, raises nothing but CaptureError."""
    find(folder)
    try:
        calibration = read(path)
    except CaptureError as error:
        assert error.remedy
        assert "\n" not in str(error)
        return
    for error in calibration.errors:
        assert isinstance(error, CaptureError)
        assert "\n" not in str(error)
    for entry in calibration.entries:
        assert isinstance(entry.file, str)
        try:
            width, height = entry.intrinsics.width or WIDTH, entry.intrinsics.height or HEIGHT
            camera = entry.camera(width, height, path)
            if entry.lens is not None:
                source_positions(camera.K, entry.lens, 7, 5)
        except CaptureError:
            pass


VALUES = [
    b"nan",
    b"inf",
    b"-inf",
    b"1e308",
    b"-1e308",
    b"1e-320",
    b"0",
    b"-1",
    b"9" * 30,
    b"",
    b"x",
    b"\xff",
    b"\0",
    b"1_0",
]
EDITS = st.one_of(
    st.tuples(st.just("number"), st.integers(0, 10**6), st.sampled_from(VALUES)),
    st.tuples(st.just("bytes"), st.integers(0, 10**6), st.binary(min_size=1, max_size=6)),
    st.tuples(st.just("cut"), st.integers(0, 10**6), st.just(b"")),
    st.tuples(st.just("drop"), st.integers(0, 10**6), st.just(b"")),
    st.tuples(st.just("repeat"), st.integers(0, 10**6), st.just(b"")),
)
NUMBER = re.compile(rb"-?\d[\d.e+-]*")


def edited(data: bytes, edits) -> bytes:
    for kind, at, new in edits:
        if kind == "number":
            found = list(NUMBER.finditer(data))
            if found:
                match = found[at % len(found)]
                data = data[: match.start()] + new + data[match.end() :]
        elif data:
            at %= len(data)
            if kind == "bytes":
                data = data[:at] + new + data[at + len(new) :]
            elif kind == "cut":
                data = data[:at]
            elif kind == "drop":
                data = data[:at] + data[at + 5 :]
            else:
                data = data[:at] + data[at : at + 40] + data[at:]
    return data


@pytest.fixture(scope="module", params=list(WRITERS))
def written(request):
    """A folder of each format, its calibration, and the file that is damaged with its bytes."""
    writer, read = WRITERS[request.param]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = writer(folder)
        target = path if path.is_file() else sorted(p for p in path.iterdir() if p.is_file())[1]
        yield FINDERS[FORMATS.get(request.param, request.param)], read, folder, path, target, target.read_bytes()


@given(edits=st.lists(EDITS, min_size=1, max_size=4))
@settings(max_examples=120)
def test_damage_raises_nothing_but_capture_errors(written, edits):
    find, read, folder, path, target, data = written
    target.write_bytes(edited(data, edits))
    survives(find, read, folder, path)


@given(data=st.binary(max_size=300))
@settings(max_examples=40)
def test_garbage_raises_nothing_but_capture_errors(written, data):
    find, read, folder, path, target, _ = written
    target.write_bytes(data)
    survives(find, read, folder, path)


@given(text=st.text(alphabet="ab:[]{},-'\"#! \n\t1.%_", max_size=80))
@settings(max_examples=300)
def test_any_text_is_a_storage_or_an_error(text):
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "a.yml"
        path.write_text("%YAML:1.0\n---\n" + text)
        try:
            assert isinstance(load_storage(path), dict)
        except CaptureError as error:
            assert "\n" not in str(error)
        survives(find_opencv, read_opencv, Path(name), path)
