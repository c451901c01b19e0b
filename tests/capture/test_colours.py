"""Colour spaces that photographs state without an ICC profile, and HDR: one picture, coded in many ways, comes back."""

from __future__ import annotations

import io
import struct
import zlib

import cv2
import numpy as np
import pillow_heif
import pytest
import tifffile
from PIL import Image, ImageCms

from eigenfield.capture.photographs.colour import COLOUR_PRIMARIES, make_profile, read_code_points, srgb_curve
from eigenfield.capture.photographs.read import decode
from eigenfield.imaging.colour import linear_of_srgb

Y, X = np.mgrid[:64, :96]
PICTURE = np.stack([X / 96 * 0.8 + 0.1, Y / 64 * 0.8 + 0.1, 0.5 + 0.3 * np.sin(X / 9)], axis=-1)  # sRGB
LINEAR = linear_of_srgb(PICTURE)
SRGB, P3, BT2020 = COLOUR_PRIMARIES[1], COLOUR_PRIMARIES[12], COLOUR_PRIMARIES[9]
ADOBE = (0.64, 0.33), (0.21, 0.71), (0.15, 0.06), (0.3127, 0.329)


def linear_in(primaries) -> np.ndarray:
    """The picture's linear light by other primaries of the same white."""

    def to_xyz(corners):
        columns = np.array([[x / y, 1, (1 - x - y) / y] for x, y in corners]).T
        return columns[:, :3] @ np.diag(np.linalg.solve(columns[:, :3], columns[:, 3]))

    return np.maximum(LINEAR @ (np.linalg.inv(to_xyz(primaries)) @ to_xyz(SRGB)).T, 0)


def srgb_coded(light: np.ndarray) -> np.ndarray:
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def pq_coded(light: np.ndarray) -> np.ndarray:
    """BT.2100's inverse EOTF of light whose white is 203 cd/m2."""
    power = (light * 203 / 10000) ** (2610 / 16384)
    return ((3424 / 4096 + 2413 / 128 * power) / (1 + 2392 / 128 * power)) ** (2523 / 32)


def hlg_coded(light: np.ndarray) -> np.ndarray:
    """BT.2100's OETF of light whose white lies at 75 %."""
    scene = light * (np.exp((0.75 - 0.55991073) / 0.17883277) + 0.28466892) / 12
    bright = 0.17883277 * np.log(np.maximum(12 * scene - 0.28466892, 1e-9)) + 0.55991073
    return np.where(scene <= 1 / 12, np.sqrt(3 * scene), bright)


# coded values, colour primaries and transfer characteristics
CODED = {
    "sRGB": (PICTURE, 1, 13),
    "BT.709's camera curve": (PICTURE, 1, 1),
    "not stated": (PICTURE, 2, 2),
    "P3": (srgb_coded(linear_in(P3)), 12, 13),
    "BT.2020": (srgb_coded(linear_in(BT2020)), 9, 14),
    "linear": (LINEAR, 1, 8),
    "PQ": (pq_coded(linear_in(BT2020)), 9, 16),
    "HLG": (hlg_coded(linear_in(BT2020)), 9, 18),
}


LOSSY = {"PQ": 4.0, "HLG": 2.0}  # grey levels, that a lossy code of 8 bit adds: a step of an HDR curve is more of SDR


def whole_numbers(values: np.ndarray, bits: int) -> np.ndarray:
    return np.rint(np.clip(values, 0, 1) * ((1 << bits) - 1)).astype(np.uint8 if bits == 8 else np.uint16)


def png(values: np.ndarray, *chunks: tuple[bytes, bytes], bits: int = 16) -> bytes:
    data = bytes(cv2.imencode(".png", whole_numbers(values, bits)[..., ::-1])[1])
    extra = b"".join(
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)) for kind, body in chunks
    )
    return data[:33] + extra + data[33:]


def cicp(primaries: int, transfer: int, full: int = 1) -> tuple[bytes, bytes]:
    return b"cICP", bytes([primaries, transfer, 0, full])


def gama(gamma: float) -> tuple[bytes, bytes]:
    return b"gAMA", struct.pack(">I", round(gamma * 100000))


def chrm(primaries) -> tuple[bytes, bytes]:
    red, green, blue, white = primaries
    return b"cHRM", struct.pack(">8I", *(round(v * 100000) for pair in (white, red, green, blue) for v in pair))


def error(tmp_path, data: bytes) -> float:
    """Mean error in grey levels."""
    (tmp_path / "a").write_bytes(data)
    return float(np.abs(decode(tmp_path / "a")[0] - PICTURE).mean() * 255)


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("name", CODED)
def test_png_by_code_points(tmp_path, name, bits):
    values, primaries, transfer = CODED[name]
    assert error(tmp_path, png(values, cicp(primaries, transfer), bits=bits)) < (1.5 if bits == 8 else 0.02)


PROFILE = b"iCCP", b"p\0\0" + zlib.compress(ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes())
PNG_CHUNKS = {
    "1/2.2 alone is the curve of sRGB": (PICTURE, [gama(0.45455)]),
    "with its primaries, too": (PICTURE, [gama(0.45455), chrm(SRGB)]),
    "linear": (LINEAR, [gama(1)]),
    "1/1.8": (LINEAR ** (1 / 1.8), [gama(1 / 1.8)]),
    "primaries and a power": (linear_in(P3) ** (1 / 2.2), [gama(1 / 2.2), chrm(P3)]),
    "primaries alone": (srgb_coded(linear_in(P3)), [chrm(P3)]),
    "sRGB goes before": (PICTURE, [(b"sRGB", b"\0"), gama(1), chrm(P3)]),
    "so does ICC": (PICTURE, [PROFILE, gama(1), chrm(P3)]),
    "code points go before ICC": (CODED["P3"][0], [cicp(12, 13), PROFILE]),
    "but not if they state nothing": (PICTURE, [cicp(2, 2), PROFILE, gama(1)]),
    "the narrow range": ((PICTURE * 219 + 16) / 255, [cicp(1, 13, 0)]),
    "no colours": (PICTURE, [chrm(((0.3, 0.3),) * 4)]),
}


@pytest.mark.parametrize("name", PNG_CHUNKS)
def test_png_by_chunks(tmp_path, name):
    values, chunks = PNG_CHUNKS[name]
    assert error(tmp_path, png(values, *chunks)) < 0.2


@pytest.mark.parametrize("bits", [8, 10])
@pytest.mark.parametrize("name", CODED)
def test_heic_by_nclx(tmp_path, name, bits):
    values, primaries, transfer = CODED[name]
    size, coded = (96, 64), whole_numbers(values, bits)
    image = (
        pillow_heif.from_pillow(Image.fromarray(coded))
        if bits == 8
        else pillow_heif.from_bytes("RGB;16", size, (coded << 6).tobytes())
    )
    file = io.BytesIO()
    points = {"color_primaries": primaries, "transfer_characteristics": transfer, "matrix_coefficients": 6}
    image.save(file, quality=95, chroma=444, save_nclx_profile=True, full_range_flag=bits == 8, **points)
    assert error(tmp_path, file.getvalue()) < LOSSY.get(name, 1.5)


@pytest.mark.parametrize("bits", [8, 10])
@pytest.mark.parametrize("name", CODED)
def test_avif_by_nclx(tmp_path, name, bits):
    values, primaries, transfer = CODED[name]
    if bits == 8:
        file = io.BytesIO()
        Image.fromarray(whole_numbers(values, 8)).save(file, "AVIF", quality=98, subsampling="4:4:4", speed=10)
        data = bytearray(file.getvalue())
    else:
        options = [cv2.IMWRITE_AVIF_DEPTH, bits, cv2.IMWRITE_AVIF_QUALITY, 98, cv2.IMWRITE_AVIF_SPEED, 10]
        data = bytearray(cv2.imencode(".avif", whole_numbers(values, bits)[..., ::-1], options)[1])
    at = data.index(b"colrnclx") + 8
    data[at : at + 4] = struct.pack(">HH", primaries, transfer)
    assert error(tmp_path, bytes(data)) < LOSSY.get(name, 1.5)


@pytest.mark.parametrize("kind", ["JPEG", "WEBP", "TIFF"])
@pytest.mark.parametrize(("space", "index"), [(0xFFFF, "R03"), (2, None), (0xFFFF, None), (1, "R98")])
def test_adobe_rgb_by_exif(tmp_path, kind, space, index):
    exif = Image.Exif()
    exif.get_ifd(0x8769)[0xA001] = space
    if index is not None and kind != "TIFF":  # Pillow writes it to another place of a TIFF than it says
        exif.get_ifd(0x8769)[0xA005] = {1: index}
    is_adobe = space == 2 or (index == "R03" and kind != "TIFF")
    values = linear_in(ADOBE) ** (256 / 563) if is_adobe else PICTURE
    options = {"JPEG": {"quality": 97, "subsampling": 0}, "WEBP": {"lossless": True}, "TIFF": {}}[kind]
    given = Image.Exif()
    given.load(exif.tobytes())
    file = io.BytesIO()
    Image.fromarray(whole_numbers(values, 8)).save(file, kind, exif=given, **options)
    assert error(tmp_path, file.getvalue()) < 1


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("curve", [True, False])
def test_tiff_by_tags(tmp_path, bits, curve):
    corners = [part for x, y in (*P3[:3], P3[3]) for value in (x, y) for part in (round(value * 10000), 10000)]
    tags = [(319, "2I", 6, corners[:12], True), (318, "2I", 2, corners[12:], True)]
    if curve:
        table = np.rint(65535 * np.linspace(0, 1, 1 << bits) ** 2.2).astype(int).tolist()
        tags.append((301, "H", 3 * len(table), tuple(table * 3), True))
    values = linear_in(P3) ** (1 / 2.2) if curve else srgb_coded(linear_in(P3))
    file = io.BytesIO()
    tifffile.imwrite(file, whole_numbers(values, bits), photometric="rgb", extratags=sorted(tags))
    assert error(tmp_path, file.getvalue()) < 0.7


def test_code_points_inside_an_icc_profile(tmp_path):
    """An HDR profile has tables for other programs, and says in `cicp` what it is."""
    values, primaries, transfer = CODED["HLG"]
    body = b"cicp\0\0\0\0" + bytes([primaries, transfer, 0, 1])
    head = bytes(16) + b"RGB XYZ " + bytes(12) + b"acsp" + bytes(88)
    profile = head + struct.pack(">I4sII4sII", 2, b"cicp", 156, 12, b"A2B0", 156, 12) + body
    assert error(tmp_path, png(values, (b"iCCP", b"p\0\0" + zlib.compress(profile)))) < 0.02


def test_reference_white_is_white_and_brighter_is_clipped():
    levels = np.array([pq_coded(np.array(1.0)), 0.75, 0.9, 1.0], np.float32)
    grey = np.repeat(levels[:, None], 3, axis=1)
    assert read_code_points(9, 16).apply(grey[:1]) == pytest.approx(1, abs=1e-3)
    assert read_code_points(9, 18).apply(grey[1:]) == pytest.approx(1, abs=1e-3)
    assert read_code_points(9, 16).apply(grey[:1] * np.float32(0.9)).max() < 0.9


def test_matrices_are_those_of_the_standards():
    profile = make_profile(BT2020, srgb_curve())
    known = [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]]  # ITU-R BT.2087
    assert np.allclose(profile.matrix, known, atol=2e-3)
    assert np.allclose(profile.matrix.sum(axis=1), 1, atol=1e-6)
