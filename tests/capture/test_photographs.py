"""Photographs from files: every format at its full depth, turned upright, in sRGB; damage named."""

from __future__ import annotations

import io
import itertools
import struct
import zlib
from pathlib import Path

import cv2
import numpy as np
import pytest
import tifffile
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image, ImageCms

from eigenfield.capture.photographs import header as photographs
from eigenfield.capture.photographs.colour import COLOUR_SRGB_TO_XYZ, encode_srgb
from eigenfield.capture.photographs.icc import BrokenProfileError, read_profile
from eigenfield.capture.photographs.read import decode, decode_mask, read_header
from eigenfield.core.errors import CaptureError

RANDOM = np.random.default_rng(0)
EIGHT = RANDOM.integers(0, 256, (9, 13, 3), dtype=np.uint8)
SIXTEEN = RANDOM.integers(0, 65536, (9, 13, 3), dtype=np.uint16)


def smooth(height: int = 48, width: int = 64) -> np.ndarray:
    y, x = np.mgrid[0:height, 0:width]
    return np.stack([x * 255 / width, y * 255 / height, 128 + 0 * x], axis=-1).astype(np.uint8)


def oriented(picture: np.ndarray, orientation: int) -> np.ndarray:
    """EXIF's own words: where row 0 and column 0 of the stored picture are."""
    ways = {
        1: lambda a: a, 2: lambda a: a[:, ::-1], 3: lambda a: a[::-1, ::-1], 4: lambda a: a[::-1],
        5: lambda a: a.swapaxes(0, 1), 6: lambda a: np.rot90(a, -1), 7: lambda a: a[::-1, ::-1].swapaxes(0, 1),
        8: lambda a: np.rot90(a, 1),
    }  # fmt: skip
    return ways[orientation](picture)


def png16(picture: np.ndarray, orientation: int = 1, profile: bytes | None = None) -> bytes:
    """A 16-bit PNG with EXIF and ICC chunks, which no library at hand writes together."""
    order = [2, 1, 0, 3][: picture.shape[2]] if picture.ndim == 3 else slice(None)
    data = bytes(cv2.imencode(".png", picture[..., order] if picture.ndim == 3 else picture)[1])
    exif = Image.Exif()
    exif[0x0112] = orientation
    chunks = [(b"eXIf", exif.tobytes()[6:])]
    if profile is not None:
        chunks.append((b"iCCP", b"p\0\0" + zlib.compress(profile)))
    extra = b"".join(
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)) for kind, body in chunks
    )
    return data[:33] + extra + data[33:]


def tiff(picture: np.ndarray, **options) -> bytes:
    file = io.BytesIO()
    tifffile.imwrite(file, picture, **options)
    return file.getvalue()


def save(path: Path, image: Image.Image | bytes, *args, **options) -> Path:
    if isinstance(image, bytes):
        path.write_bytes(image)
    else:
        image.save(path, *args, **options)
    return path


@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.webp", "a b ü.png"])
def test_lossless_8_bit_formats_keep_every_value(tmp_path, name):
    path = save(tmp_path / name, Image.fromarray(EIGHT), **({"lossless": True} if name.endswith("webp") else {}))
    pixels, alpha = decode(path)
    assert pixels.dtype == np.float32 and alpha is None
    assert np.array_equal(pixels, EIGHT.astype(np.float32) / np.float32(255))


@pytest.mark.parametrize("name", ["a.jpg", "a.avif", "a.webp"])
def test_lossy_formats_are_near(tmp_path, name):
    picture = smooth()
    pixels, _ = decode(save(tmp_path / name, Image.fromarray(picture), quality=95))
    assert np.abs(pixels * 255 - picture).mean() < 2


def test_format_is_told_by_content_not_by_name(tmp_path):
    path = save(tmp_path / "photo.jpg", Image.fromarray(EIGHT), "PNG")
    assert read_header(path).format == "PNG"
    assert np.array_equal(decode(path)[0] * 255, EIGHT)


@pytest.mark.parametrize("data", [png16(SIXTEEN), tiff(SIXTEEN, photometric="rgb"),
                                  tiff(SIXTEEN, photometric="rgb", byteorder=">"),
                                  tiff(SIXTEEN, photometric="rgb", compression="zlib", predictor=True)])  # fmt: skip
def test_16_bit_is_not_cut_to_8(tmp_path, data):
    path = save(tmp_path / "deep", data)
    assert read_header(path).depth == 16
    pixels, alpha = decode(path)
    assert alpha is None
    assert np.array_equal(np.rint(pixels * 65535), SIXTEEN)


def test_16_bit_grey_alpha_and_white_is_zero(tmp_path):
    grey = SIXTEEN[..., 0]
    pixels, _ = decode(save(tmp_path / "grey.png", png16(grey)))
    assert np.array_equal(np.rint(pixels * 65535), np.repeat(grey[..., None], 3, axis=2))
    pixels, _ = decode(save(tmp_path / "white.tif", tiff(grey, photometric="miniswhite")))
    assert np.array_equal(np.rint(pixels[..., 1] * 65535), 65535 - grey)
    rgba = RANDOM.integers(1, 65536, (5, 6, 4), dtype=np.uint16)
    pixels, alpha = decode(save(tmp_path / "rgba.png", png16(rgba)))
    assert np.array_equal(np.rint(pixels * 65535), rgba[..., :3])
    assert alpha is not None and np.array_equal(np.rint(alpha * 65535), rgba[..., 3])


def test_premultiplied_16_bit_tiff_gives_its_colours_back(tmp_path):
    colour = np.array([40000, 20000, 10000])
    alpha = np.linspace(8000, 65535, 12).astype(np.uint16).reshape(3, 4)
    stored = np.concatenate([np.rint(colour * (alpha[..., None] / 65535)), alpha[..., None]], axis=2).astype(np.uint16)
    path = save(tmp_path / "a.tif", tiff(stored, photometric="rgb", extrasamples=["assocalpha"]))
    assert np.abs(decode(path)[0] * 65535 - colour).max() < 6


def test_10_bit_avif_keeps_more_than_8(tmp_path):
    ramp = np.zeros((16, 300, 3), np.uint16)
    ramp[...] = (300 + np.arange(300))[None, :, None]
    ok, data = cv2.imencode(".avif", ramp, [cv2.IMWRITE_AVIF_DEPTH, 10, cv2.IMWRITE_AVIF_QUALITY, 100])
    assert ok
    path = save(tmp_path / "a.avif", bytes(data))
    assert read_header(path).depth == 10
    assert np.abs(decode(path)[0] * 1023 - ramp).max() < 1.01  # 8 bit would be off by up to 2


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("kind", ["png8", "jpeg", "tiff8", "png16", "tiff16"])
def test_orientation_is_applied_or_left(tmp_path, kind, orientation):
    exif = Image.Exif()
    exif[0x0112] = orientation
    path, stored, scale, slack = tmp_path / "a", EIGHT, 255, 0.0
    if kind == "png8":
        save(path, Image.fromarray(EIGHT), "PNG", exif=exif)
    elif kind == "jpeg":
        stored, slack = smooth(), 6.0
        save(path, Image.fromarray(stored), "JPEG", exif=exif, quality=98, subsampling=0)
    elif kind == "tiff8":
        save(path, tiff(EIGHT, photometric="rgb", extratags=[(274, "H", 1, orientation, True)]))
    elif kind == "png16":
        stored, scale = SIXTEEN, 65535
        save(path, png16(SIXTEEN, orientation))
    else:
        stored, scale = SIXTEEN, 65535
        save(path, tiff(SIXTEEN, photometric="rgb", extratags=[(274, "H", 1, orientation, True)]))
    header = read_header(path)
    assert header.stored_size == (stored.shape[1], stored.shape[0]) and header.orientation == orientation
    upright, _ = decode(path)
    assert header.upright_size == (upright.shape[1], upright.shape[0])
    assert np.abs(np.rint(upright * scale) - oriented(stored, orientation)).max() <= slack
    left, _ = decode(path, upright=False)
    assert np.abs(np.rint(left * scale) - stored).max() <= slack


def test_exif_after_the_pixels_of_a_png_is_found(tmp_path):
    data = png16(SIXTEEN, 6)
    size = struct.unpack(">I", data[33:37])[0]
    chunk, rest = data[33 : 45 + size], data[45 + size :]
    path = save(tmp_path / "late.png", data[:33] + rest[:-12] + chunk + rest[-12:])
    assert read_header(path).orientation == 6


def test_other_pixel_kinds_become_rgb(tmp_path):
    grey = Image.fromarray(EIGHT[..., 0])
    expected = np.repeat(EIGHT[..., :1], 3, axis=2)
    for name, image in {"l.png": grey, "la.png": Image.merge("LA", [grey, Image.new("L", grey.size, 200)])}.items():
        pixels, alpha = decode(save(tmp_path / name, image))
        assert np.array_equal(np.rint(pixels * 255), expected), name
        assert (alpha is None) == (name == "l.png")
    palette = Image.fromarray(EIGHT).quantize(16)
    assert np.array_equal(decode(save(tmp_path / "p.png", palette))[0] * 255, np.asarray(palette.convert("RGB")))
    bits = Image.fromarray(EIGHT[..., 0] > 127)
    assert set(np.unique(decode(save(tmp_path / "1.png", bits))[0])) == {0.0, 1.0}
    palette.info["transparency"] = 3
    _, alpha = decode(save(tmp_path / "pt.png", palette, transparency=3))
    assert alpha is not None and np.array_equal(alpha == 0, np.asarray(palette) == 3)


def test_cmyk_jpeg_is_near_its_rgb(tmp_path):
    image = Image.fromarray(smooth())
    pixels, _ = decode(save(tmp_path / "a.jpg", image.convert("CMYK"), quality=98))
    assert np.abs(pixels * 255 - np.asarray(image)).mean() < 3


# colour


def profile_bytes(columns: np.ndarray, curve: bytes, space: bytes = b"RGB ", tables: bool = False) -> bytes:
    """A small matrix profile: three colorants and one curve for all."""
    tags = {}
    if space == b"RGB ":
        for name, column in zip((b"rXYZ", b"gXYZ", b"bXYZ"), columns.T, strict=True):
            tags[name] = b"XYZ \0\0\0\0" + struct.pack(">3i", *(round(v * 65536) for v in column))
        tags |= dict.fromkeys((b"rTRC", b"gTRC", b"bTRC"), curve)
    else:
        tags[b"kTRC"] = curve
    if tables:
        tags[b"A2B0"] = b"mft2" + bytes(60)
    tags[b"wtpt"] = b"XYZ \0\0\0\0" + struct.pack(">3i", round(0.9642 * 65536), 65536, round(0.8249 * 65536))
    tags[b"desc"] = b"desc\0\0\0\0" + struct.pack(">I", 5) + b"test\0" + bytes(78)
    tags[b"cprt"] = b"text\0\0\0\0none\0"
    offset = 132 + 12 * len(tags)
    table, body = b"", b""
    for name, tag in tags.items():
        padded = tag + bytes(-len(tag) % 4)
        table += name + struct.pack(">II", offset + len(body), len(tag))
        body += padded
    size = offset + len(body)
    head = (
        struct.pack(">I4sI4s4s4s", size, b"test", 0x02400000, b"mntr", space, b"XYZ ") + bytes(12) + b"acsp" + bytes(28)
    )
    head += struct.pack(">3i", round(0.9642 * 65536), 65536, round(0.8249 * 65536)) + bytes(48)
    return head + struct.pack(">I", len(tags)) + table + body


ADOBE = np.array([[0.60974, 0.20528, 0.14919], [0.31111, 0.62567, 0.06322], [0.01947, 0.06087, 0.74457]])
GAMMA22 = b"curv\0\0\0\0" + struct.pack(">IH", 1, round(2.19921875 * 256))


def parametric(kind: int, *numbers: float) -> bytes:
    return b"para\0\0\0\0" + struct.pack(f">HH{len(numbers)}i", kind, 0, *(round(v * 65536) for v in numbers))


SRGB_PARA = parametric(3, 2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)
CURVES = [
    GAMMA22, SRGB_PARA, parametric(0, 1.8), parametric(1, 2.2, 1.25, -0.25), parametric(2, 1.5, 1.1, -0.3, 0.1),
    parametric(4, 2.0, 0.9, 0.05, 0.3, 0.2, 0.06, 0.02),
    b"curv\0\0\0\0" + struct.pack(">I4H", 4, 0, 9000, 20000, 65535),
]  # fmt: skip


@pytest.mark.parametrize("curve", CURVES)
def test_matrix_profile_agrees_with_littlecms(tmp_path, curve):
    profile = profile_bytes(ADOBE, curve)
    image = Image.fromarray(smooth())
    path = save(tmp_path / "a.png", image, icc_profile=profile)
    reference = ImageCms.profileToProfile(
        image, ImageCms.ImageCmsProfile(io.BytesIO(profile)), ImageCms.createProfile("sRGB"),
        renderingIntent=ImageCms.Intent.RELATIVE_COLORIMETRIC,
    )  # fmt: skip
    pixels, _ = decode(path)
    assert np.abs(pixels * 255 - np.asarray(reference)).max() < 1.6
    assert np.abs(pixels * 255 - np.asarray(image)).max() > 20  # it does something


def test_matrix_profile_at_16_bit_keeps_neighbouring_values_apart(tmp_path):
    ramp = np.repeat((30000 + 8 * np.arange(64, dtype=np.uint16))[None, :, None], 3, axis=2).repeat(2, axis=0)
    path = save(tmp_path / "a.png", png16(ramp, profile=profile_bytes(COLOUR_SRGB_TO_XYZ, GAMMA22)))
    pixels, _ = decode(path)
    assert len(np.unique(pixels[0, :, 0])) == 64
    linear = (ramp[0, :, 0] / 65535) ** 2.19921875
    expected = 1.055 * linear ** (1 / 2.4) - 0.055
    assert np.abs(pixels[0, :, 0] - expected).max() < 1e-4


def test_srgb_profiles_change_nothing(tmp_path):
    for number, profile in enumerate(
        (
            ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes(),
            profile_bytes(COLOUR_SRGB_TO_XYZ, SRGB_PARA),
        )
    ):
        assert read_profile(profile).kind == "none"
        path = save(tmp_path / f"{number}.png", Image.fromarray(EIGHT), icc_profile=profile)
        assert np.array_equal(decode(path)[0] * np.float32(255), EIGHT)


def test_grey_profile_is_a_curve(tmp_path):
    profile = profile_bytes(COLOUR_SRGB_TO_XYZ, b"curv\0\0\0\0" + struct.pack(">I", 0), b"GRAY")
    path = save(tmp_path / "a.png", Image.fromarray(EIGHT[..., 0]), icc_profile=profile)
    expected = encode_srgb(EIGHT[..., 0].astype(np.float32) / 255)
    assert np.allclose(decode(path)[0][..., 2], expected, atol=1e-6)


BROKEN = [
    b"rubbish",
    profile_bytes(ADOBE, GAMMA22)[:150],
    profile_bytes(ADOBE, b"curv\0\0\0\0\xff\xff\xff\xff"),
    profile_bytes(ADOBE, GAMMA22, tables=True),
]


@pytest.mark.parametrize("profile", BROKEN)
def test_broken_profiles_are_ignored_with_a_warning(tmp_path, caplog, profile):
    path = save(tmp_path / "a.png", Image.fromarray(EIGHT), icc_profile=profile)
    assert np.array_equal(decode(path)[0] * np.float32(255), EIGHT)
    assert "a.png" in caplog.text and "profile" in caplog.text


@settings(max_examples=200)
@given(st.data())
def test_damaged_profiles_never_raise_anything_else(data):
    profile = bytearray(profile_bytes(ADOBE, SRGB_PARA))
    for _ in range(data.draw(st.integers(1, 4))):
        profile[data.draw(st.integers(0, len(profile) - 1))] = data.draw(st.integers(0, 255))
    try:
        read = read_profile(bytes(profile))
    except BrokenProfileError:
        return
    if read.kind == "tables":  # nothing to apply: littleCMS does these
        return
    values = read.apply(np.linspace(0, 1, 12, dtype=np.float32).reshape(2, 2, 3))
    assert np.isfinite(values).all() and values.min() >= 0 and values.max() <= 1


# kinds that are named, and what is low


@pytest.mark.parametrize(
    ("picture", "said"),
    [(EIGHT.astype(np.float32), "floating point"), (EIGHT.astype(np.float16), "floating point"),
     (EIGHT[..., 0].astype(np.float64), "floating point"), (EIGHT.astype(np.uint32), "32 bit"),
     (EIGHT.astype(np.int16), "signed"), (SIXTEEN >> 4, "12 bit")],
)  # fmt: skip
def test_numbers_that_are_not_read_are_named(tmp_path, picture, said):
    data = bytearray(tiff(picture, photometric="rgb" if picture.ndim == 3 else "minisblack"))
    if "12" in said:  # packed, as far as the tag goes: tifffile writes none
        at = data.index(struct.pack("<HHI", 258, 3, 3))
        (place,) = struct.unpack_from("<I", data, at + 8)
        data[place : place + 6] = struct.pack("<3H", 12, 12, 12)
    path = save(tmp_path / "a.tif", bytes(data))
    error = refused(path)
    assert error.code == "image-kind" and said in str(error) and "damaged" not in str(error)
    with pytest.raises(CaptureError, match=said):
        read_header(path)


@pytest.mark.parametrize(("bits", "times"), [(8, 256), (10, 64), (12, 16), (14, 4), (16, None)])
def test_values_of_fewer_bits_than_16_are_named(tmp_path, caplog, bits, times):
    picture = SIXTEEN >> (16 - bits)
    picture[0, 0] = (1 << bits) - 1
    for name, data in (("a.png", png16(picture)), ("a.tif", tiff(picture, photometric="rgb"))):
        caplog.clear()
        decode(save(tmp_path / name, data))
        assert (f"{name}: its greatest value" in caplog.text) == (times is not None)
        assert times is None or f"times {times} " in caplog.text


# damage


def chunk_at(data: bytes, kind: bytes) -> int:
    return data.index(kind) + 4


@pytest.mark.parametrize("late", [False, True])
@pytest.mark.parametrize("deep", [False, True])
def test_damage_of_a_png_counts_only_where_it_is_critical(tmp_path, deep, late):
    """A wrong sum of a text, of a gamma; a text that cannot be unpacked: the picture is whole."""
    data, whole = (png16(SIXTEEN), SIXTEEN / 65535) if deep else (png16(EIGHT), EIGHT / 255)
    end = chunk_at(data, b"IEND") - 8 if late else 33
    texts = [b"tEXt" + b"Comment\0hello", b"zTXt" + b"Comment\0\0rubbish", b"gAMA" + struct.pack(">I", 100000)]
    for number, body in enumerate(texts):
        sum_ = zlib.crc32(body) ^ (number != 1)
        chunk = struct.pack(">I", len(body) - 4) + body + struct.pack(">I", sum_)
        path = save(tmp_path / "a.png", data[:end] + chunk + data[end:])
        assert read_header(path).depth == (16 if deep else 8)
        assert np.allclose(decode(path)[0], whole, atol=1e-6)
    broken = bytearray(data)
    broken[chunk_at(data, b"IHDR") + 13] ^= 1
    assert refused(save(tmp_path / "a.png", bytes(broken))).code == "image-unreadable"


PHOTOGRAPH = cv2.resize(RANDOM.integers(0, 256, (14, 18, 3), np.uint8), (288, 216), interpolation=cv2.INTER_CUBIC)


def jpeg(mode: str = "RGB", kind: str = "JPEG", **options) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(PHOTOGRAPH).convert(mode).save(buffer, kind, quality=90, **options)
    return buffer.getvalue()


JPEGS = {
    "baseline": jpeg(), "progressive": jpeg(progressive=True), "4:4:4": jpeg(subsampling=0), "grey": jpeg("L"),
    "CMYK": jpeg("CMYK"), "restart markers": jpeg(restart_marker_rows=2), "TIFF": jpeg(kind="TIFF", compression="jpeg"),
}  # fmt: skip


@pytest.mark.parametrize("kind", JPEGS)
def test_damage_inside_a_jpeg_is_named(tmp_path, kind):
    """Blocks of zeros, as a bad card or a failed copy leaves them; libjpeg decodes something else then, to the end."""
    data = JPEGS[kind]
    decode(save(tmp_path / "a.jpg", data))
    for part, size in itertools.product((0.3, 0.5, 0.7), (512,) if kind == "progressive" else (48, 64, 200, 512)):
        at = int(part * len(data))
        damaged = data[:at] + bytes(size) + data[at + size :]
        assert refused(save(tmp_path / "a.jpg", damaged)).code == "image-unreadable", (part, size)


@pytest.mark.parametrize("kind", [kind for kind in JPEGS if kind != "TIFF"])
def test_what_is_no_damage_of_a_jpeg_changes_nothing(tmp_path, kind):
    data = JPEGS[kind]
    with Image.open(io.BytesIO(data)) as image:
        expected = np.asarray(image.convert("RGB")) / 255
    end, start = data.rindex(b"\xff\xd9"), data.index(b"\xff\xdb")
    sound = {
        "as it is": data,
        "padding before the end": data[:end] + bytes(7) + data[end:],
        "more padding before the end": data[:end] + bytes(40) + data[end:],
        "fill bytes": data[:end] + b"\xff" * 20 + data[end:],
        "another picture behind": data + jpeg(),
        "a film behind": data + b"\0\0\0\x18ftypmp42" + bytes(range(256)) * 9,
        "rubbish between segments": data[:start] + b"rubbish" + data[start:],
    }
    for name, changed in sound.items():
        assert np.abs(decode(save(tmp_path / "a.jpg", changed))[0] - expected).max() < 1e-6, name
    rubbish = bytes(range(1, 200))
    assert refused(save(tmp_path / "a.jpg", data[:end] + rubbish + data[end:])).code == "image-unreadable"


def refused(path: Path) -> CaptureError:
    with pytest.raises(CaptureError) as caught:
        decode(path)
    assert str(path) in str(caught.value) and "\n" not in str(caught.value) and caught.value.remedy
    return caught.value


@pytest.mark.parametrize("options", [("JPEG", {}), ("PNG", {}), ("WEBP", {}), ("AVIF", {}), ("TIFF", {})])
@pytest.mark.parametrize("part", [0.02, 0.3, 0.6, 0.95])
@pytest.mark.filterwarnings("ignore::UserWarning:PIL")
def test_truncated_files_are_refused(tmp_path, options, part):
    buffer = io.BytesIO()
    Image.fromarray(RANDOM.integers(0, 256, (40, 40, 3), dtype=np.uint8)).save(buffer, options[0], **options[1])
    path = save(tmp_path / "a", buffer.getvalue()[: int(part * len(buffer.getvalue()))])
    assert refused(path).code in ("image-truncated", "image-unreadable")


@pytest.mark.parametrize("make", [png16, lambda a: tiff(a, photometric="rgb")])
@pytest.mark.filterwarnings("ignore::UserWarning:PIL")
def test_truncated_16_bit_files_are_refused(tmp_path, make):
    data = make(RANDOM.integers(0, 65536, (40, 40, 3), dtype=np.uint16))
    for part in (0.3, 0.7, 0.9):
        assert refused(save(tmp_path / "a", data[: int(part * len(data))])).code in (
            "image-truncated",
            "image-unreadable",
        )


def test_what_is_no_photograph_is_named(tmp_path):
    assert refused(save(tmp_path / "empty.png", b"")).code == "image-unreadable"
    assert refused(save(tmp_path / "text.png", b"hello, this is no picture at all, not at all")).code == "image-kind"
    assert refused(save(tmp_path / "a.gif", Image.fromarray(EIGHT), "GIF")).code == "image-kind"
    assert refused(tmp_path / "missing.png").code == "image-missing"
    floats = save(tmp_path / "f.tif", tiff(EIGHT[..., 0].astype(np.float32)))
    assert refused(floats).code == "image-kind"
    planes = save(
        tmp_path / "p.tif", tiff(np.moveaxis(SIXTEEN, 2, 0).copy(), photometric="rgb", planarconfig="separate")
    )
    assert refused(planes).code == "image-kind"


def test_a_bomb_is_refused_by_its_header(tmp_path, monkeypatch):
    data = bytearray(save(tmp_path / "a.png", Image.fromarray(EIGHT)).read_bytes())
    data[16:24] = struct.pack(">II", 30000, 30000)
    data[29:33] = struct.pack(">I", zlib.crc32(bytes(data[12:29])))
    assert refused(save(tmp_path / "bomb.png", bytes(data))).code == "image-too-large"
    monkeypatch.setattr(photographs, "PHOTOGRAPH_MAX_PIXELS", 9 * 13 - 1)
    assert refused(tmp_path / "a.png").code == "image-too-large"


@settings(max_examples=150)
@given(kind=st.sampled_from(["PNG", "JPEG", "WEBP", "TIFF", "AVIF", "PNG16", "TIFF16"]), data=st.data())
@pytest.mark.filterwarnings("ignore")
def test_changed_bytes_give_a_picture_or_a_capture_error(tmp_path_factory, kind, data):
    if kind == "PNG16":
        good = png16(SIXTEEN)
    elif kind == "TIFF16":
        good = tiff(SIXTEEN, photometric="rgb")
    else:
        buffer = io.BytesIO()
        Image.fromarray(EIGHT).save(buffer, kind)
        good = buffer.getvalue()
    broken = bytearray(good)
    for _ in range(data.draw(st.integers(1, 5))):
        broken[data.draw(st.integers(0, len(broken) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path_factory.getbasetemp() / "fuzzed"
    path.write_bytes(bytes(broken))
    try:
        pixels, _ = decode(path)
    except CaptureError as error:
        assert "\n" not in str(error)
    else:
        assert pixels.ndim == 3 and pixels.shape[2] == 3 and np.isfinite(pixels).all()


# masks


def test_masks_are_white_where_they_count(tmp_path):
    half = np.zeros((6, 8), np.uint8)
    half[:, 4:] = 255
    expected = half / 255
    grey = Image.fromarray(half)
    for name, image in {"l.png": grey, "rgb.png": grey.convert("RGB"), "1.png": Image.fromarray(half > 0)}.items():
        assert np.array_equal(decode_mask(save(tmp_path / name, image)), expected), name
    deep = save(tmp_path / "16.png", png16(half.astype(np.uint16) * 257))
    assert np.array_equal(decode_mask(deep), expected)
    with pytest.raises(CaptureError, match=r"dark\.png.*255") as caught:
        decode_mask(save(tmp_path / "dark.png", Image.fromarray((half > 0).astype(np.uint8))))
    assert caught.value.code == "mask-dark"
    assert decode_mask(save(tmp_path / "black.png", Image.new("L", (4, 4)))).max() == 0  # nothing counts: allowed
