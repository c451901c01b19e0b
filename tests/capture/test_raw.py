"""RAW: a DNG written by hand is developed to the colours that it was made from, turned, and refused where damaged."""

from __future__ import annotations

import numpy as np
import pytest
import tifffile
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.capture import open_any
from eigenfield.capture.photographs import header as headers
from eigenfield.capture.photographs.colour import encode_srgb
from eigenfield.capture.photographs.exif import read_focal_length
from eigenfield.capture.photographs.read import decode, read_header
from eigenfield.core.errors import CaptureError
from support.named import picture

SRGB_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
NEUTRAL = np.array([0.5, 1.0, 0.7])  # what the sensor shows of white
BLACK, WHITE = 512, 60512


def ramp(height: int = 96, width: int = 128, brightness: float = 1.0) -> np.ndarray:
    """(H, W, 3) linear sRGB."""
    y, x = np.mgrid[:height, :width]
    return brightness * np.stack([x / width, y / height, 0.4 + 0 * x], axis=-1)


def write_dng(path, linear: np.ndarray, orientation: int = 1) -> None:
    """A Bayer mosaic RGGB (DNG 1.4: TIFF with photometric 32803), black and white levels, colour matrix and neutral."""
    values = np.rint(linear * NEUTRAL * (WHITE - BLACK) + BLACK).astype(np.uint16)
    mosaic = values[..., 1].copy()
    mosaic[0::2, 0::2], mosaic[1::2, 1::2] = values[0::2, 0::2, 0], values[1::2, 1::2, 2]

    def ratios(numbers: np.ndarray) -> list[int]:
        return [part for number in numbers.ravel() for part in (round(number * 10000), 10000)]

    tags = [
        (274, "H", 1, orientation, True), (33421, "H", 2, (2, 2), True), (33422, "B", 4, bytes([0, 1, 1, 2]), True),
        (50706, "B", 4, bytes([1, 4, 0, 0]), True), (50708, "s", 0, "Test Camera", True), (50714, "H", 1, BLACK, True),
        (50717, "H", 1, WHITE, True), (50721, "2i", 9, ratios(np.linalg.inv(SRGB_TO_XYZ)), True),
        (50728, "2I", 3, ratios(NEUTRAL), True), (50778, "H", 1, 21, True),
    ]  # fmt: skip
    tifffile.imwrite(path, mosaic, photometric=32803, extratags=tags, metadata=None)


@pytest.mark.parametrize(("orientation", "turn"), [(1, 0), (6, -1), (3, 2), (8, 1)])
def test_raw_is_developed_to_srgb(tmp_path, orientation, turn):
    path = tmp_path / "DSC_1.DNG"
    write_dng(path, ramp(), orientation)
    header = read_header(path)
    assert (header.format, header.stored_size, header.depth, header.orientation) == ("RAW", (128, 96), 16, orientation)
    expected = encode_srgb(ramp().astype(np.float32))
    upright, _ = decode(path)
    assert header.upright_size == (upright.shape[1], upright.shape[0])
    inner = slice(4, -4)
    assert np.abs(upright - np.rot90(expected, turn))[inner, inner].mean() < 1e-3
    assert np.abs(decode(path, upright=False)[0] - expected)[inner, inner].mean() < 1e-3


def test_no_photograph_is_brightened_for_itself(tmp_path):
    write_dng(tmp_path / "a.dng", ramp())
    write_dng(tmp_path / "b.dng", ramp(brightness=0.4))
    expected = encode_srgb(ramp(brightness=0.4).astype(np.float32))
    assert np.abs(decode(tmp_path / "b.dng")[0] - expected)[4:-4, 4:-4].mean() < 1e-3


def test_a_folder_of_raw_is_a_capture(tmp_path):
    for i in range(4):
        write_dng(tmp_path / f"DSC_{i}.dng", ramp(brightness=1 - 0.1 * i))
    opened = open_any(tmp_path)
    assert len(opened) == 4 and not opened.problems
    assert read_focal_length(opened.shots[0].path, read_header(opened.shots[0].path)) is None
    picture(0).save(tmp_path / "DSC_3.jpg")
    opened = open_any(tmp_path)
    assert opened.names[-1] == "DSC_3.jpg" and opened.problems[-1].startswith("1 file was not read: .dng")


def test_damage_and_size(tmp_path, monkeypatch):
    path = tmp_path / "a.dng"
    write_dng(path, ramp())
    data = path.read_bytes()
    for part in (0, 40, 2000, len(data) // 2):
        path.write_bytes(data[:part])
        with pytest.raises(CaptureError) as caught:
            decode(path)
        assert caught.value.code == "image-unreadable" and "\n" not in str(caught.value)
    path.write_bytes(data)
    monkeypatch.setattr(headers, "PHOTOGRAPH_MAX_PIXELS", 1000)
    with pytest.raises(CaptureError, match="million pixels"):
        read_header(path)


@settings(max_examples=40)
@given(data=st.data())
@pytest.mark.filterwarnings("ignore")
def test_changed_bytes_give_a_picture_or_a_capture_error(tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "fuzzed.dng"
    write_dng(path, ramp(16, 24))
    broken = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 5))):
        broken[data.draw(st.integers(0, len(broken) - 1))] = data.draw(st.integers(0, 255))
    path.write_bytes(bytes(broken))
    try:
        pixels, _ = decode(path)
    except CaptureError as error:
        assert "\n" not in str(error)
    else:
        assert pixels.ndim == 3 and np.isfinite(pixels).all()
