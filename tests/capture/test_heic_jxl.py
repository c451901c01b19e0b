"""HEIC and JPEG XL: sizes, depths, orientation and metadata; damage and bombs."""

from __future__ import annotations

import io
import struct

import numpy as np
import pillow_heif
import pillow_jxl  # noqa: F401  (Pillow writes JPEG XL with it)
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from eigenfield.capture.photographs.exif import read_focal_length
from eigenfield.capture.photographs.read import decode, read_header
from eigenfield.core.errors import CaptureError

STORED = np.zeros((48, 64, 3), np.uint8)
STORED[:12], STORED[:, :20, 1], STORED[30:, 40:, 2] = (250, 40, 40), 160, 220
RANDOM = np.random.default_rng(5)


def exif(orientation: int = 1) -> Image.Exif:
    found = Image.Exif()
    found[0x0112] = orientation
    found.get_ifd(0x8769)[0xA405] = 26
    return found


def heic(pixels: np.ndarray = STORED, **options) -> bytes:
    file = io.BytesIO()
    pillow_heif.from_pillow(Image.fromarray(pixels)).save(file, quality=95, chroma=444, **options)
    return file.getvalue()


def jxl(pixels: np.ndarray = STORED, orientation: int = 1) -> bytes:
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "JXL", lossless=True, exif=exif(orientation).tobytes())
    return file.getvalue()


def refused(path) -> CaptureError:
    with pytest.raises(CaptureError) as caught:
        decode(path)
    assert "\n" not in str(caught.value) and caught.value.remedy
    return caught.value


def test_heic(tmp_path):
    path = tmp_path / "IMG_1.HEIC"
    path.write_bytes(heic(exif=exif().tobytes()))
    header = read_header(path)
    assert (header.format, header.upright_size, header.depth, header.orientation) == ("HEIC", (64, 48), 8, 1)
    assert np.abs(decode(path)[0] * 255 - STORED).mean() < 3
    assert np.isclose(read_focal_length(path, header), 26 / np.hypot(36, 24) * 80, rtol=1e-3)


def test_heic_is_turned_by_its_own_properties(tmp_path):
    path = tmp_path / "a.heic"
    path.write_bytes(heic(exif=exif(6).tobytes()))
    header = read_header(path)
    upright, _ = decode(path)
    assert header.upright_size == (48, 64) and upright.shape == (64, 48, 3)
    assert np.abs(upright * 255 - np.rot90(STORED, -1)).mean() < 3
    assert np.array_equal(decode(path, upright=False)[0], upright)


def test_10_bit_heic_keeps_more_than_8(tmp_path):
    ramp = np.zeros((64, 320, 3), np.uint16)
    ramp[...] = (300 + np.arange(320))[None, :, None]
    path = tmp_path / "a.heic"
    pillow_heif.from_bytes("RGB;16", (320, 64), (ramp << 6).tobytes()).save(path, quality=-1, bit_depth=10)
    assert read_header(path).depth == 10
    assert np.abs(decode(path)[0] * 1023 - ramp).mean() < 1.0  # 8 bit would be off by 1.5


@pytest.mark.parametrize("orientation", [1, 6])
def test_jxl(tmp_path, orientation):
    path = tmp_path / "a.jxl"
    path.write_bytes(jxl(orientation=orientation))  # EXIF's orientation does not count
    header = read_header(path)
    assert (header.format, header.upright_size, header.orientation) == ("JPEG XL", (64, 48), 1)
    assert np.array_equal(np.rint(decode(path)[0] * 255), STORED)
    assert np.isclose(read_focal_length(path, header), 26 / np.hypot(36, 24) * 80, rtol=1e-3)


@pytest.mark.filterwarnings("ignore:Using JPEG reconstruction")
def test_a_jpeg_within_jxl_is_turned(tmp_path):
    Image.fromarray(STORED).save(tmp_path / "a.jpg", quality=95, exif=exif(6))
    with Image.open(tmp_path / "a.jpg") as image:
        image.save(tmp_path / "a.jxl")
    header = read_header(tmp_path / "a.jxl")
    assert header.stored_size == (64, 48) and header.orientation == 6
    assert np.abs(decode(tmp_path / "a.jxl")[0] - decode(tmp_path / "a.jpg")[0]).mean() < 0.01
    assert decode(tmp_path / "a.jxl", upright=False)[0].shape == (48, 64, 3)


@pytest.mark.parametrize("size", [(1, 1), (8, 8), (320, 240), (300, 200), (1000, 17), (9000, 3)])
def test_sizes_of_jxl(tmp_path, size):
    path = tmp_path / "a.jxl"
    path.write_bytes(jxl(np.zeros((size[1], size[0], 3), np.uint8)))
    assert read_header(path).stored_size == size


def test_bombs_are_refused_by_their_headers(tmp_path):
    data = bytearray(heic())
    at = data.index(b"ispe")
    data[at + 8 : at + 16] = struct.pack(">II", 60000, 60000)
    path = tmp_path / "a.heic"
    path.write_bytes(data)
    assert refused(path).code == "image-too-large"
    bits = 0 | (3 << 1) | (99999 << 3) | (0 << 33) | (3 << 36) | (99999 << 38)  # two sides of 30 bits
    path.write_bytes(b"\xff\x0a" + bits.to_bytes(40, "little"))
    assert refused(path).code == "image-too-large"


@pytest.mark.parametrize("make", [heic, jxl])
def test_truncated_files_are_refused(tmp_path, make):
    data = make(RANDOM.integers(0, 256, (48, 64, 3), np.uint8))
    for part in (0.02, 0.3, 0.6, 0.95):
        (tmp_path / "a").write_bytes(data[: int(part * len(data))])
        assert refused(tmp_path / "a").code in ("image-truncated", "image-unreadable")


@settings(max_examples=100)
@given(kind=st.sampled_from([heic, jxl]), data=st.data())
@pytest.mark.filterwarnings("ignore")
def test_changed_bytes_give_a_picture_or_a_capture_error(tmp_path_factory, kind, data):
    broken = bytearray(kind())
    for _ in range(data.draw(st.integers(1, 5))):
        broken[data.draw(st.integers(0, len(broken) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path_factory.getbasetemp() / "fuzzed"
    path.write_bytes(bytes(broken))
    try:
        size = read_header(path).upright_size
        pixels, _ = decode(path)
    except CaptureError as error:
        assert "\n" not in str(error)
    else:
        assert pixels.shape == (size[1], size[0], 3) and np.isfinite(pixels).all()
