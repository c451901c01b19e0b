"""Files cut, flipped and rewritten at random: refused with a code, never a surprise."""

from __future__ import annotations

import io
import struct
import tracemalloc
import zlib
from copy import deepcopy

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from eigenfield import gltf as scene_format
from eigenfield.coding import limits
from eigenfield.coding import stacking as pictures
from eigenfield.core.errors import FormatError
from support import glb_surgery
from support.glb_surgery import CODECS, outcome


@pytest.mark.parametrize("codec", CODECS)
@pytest.mark.slow
def test_every_length_is_refused_or_drawn_of_the_textures_that_are_there(tmp_path, good, codec):
    data, path = good[codec], tmp_path / "a.glb"
    gltf, binary = glb_surgery.split(data)
    (basis,) = gltf["extensions"][limits.EXTENSION]["planes"][0]["bases"]
    ends = [glb_surgery.view_end(gltf, texture["bufferView"]) for texture in basis["textures"]]
    assert ends == sorted(ends) and ends[-1] > len(binary) - 4  # the last things in the file, the strongest first
    first = min(gltf["bufferViews"][texture["bufferView"]]["byteOffset"] for texture in basis["textures"])
    for length in sorted({*range(64), *range(64, len(data), 37), len(data) - 1}):
        found, kept = outcome(path, data[:length]), length - (len(data) - len(binary))
        if kept < first - 3 or kept >= ends[-1]:
            assert found in ("not-glb", "truncated")
        elif kept >= first:
            assert found is None
            path.write_bytes(data[:length])
            assert scene_format.load(path).appearance.textures == sum(end <= kept for end in ends)
            assert [finding.code for finding in scene_format.validate(path)] == ["truncated"]


@pytest.mark.parametrize("codec", CODECS)
def test_a_truncation_that_mends_its_header_is_refused(tmp_path, good, codec):
    gltf, binary = glb_surgery.split(good[codec])
    assert len(binary) > 97
    for keep in range(0, len(binary), 97):
        assert outcome(tmp_path / "a.glb", glb_surgery.join(gltf, binary[:keep])) is not None


@given(st.sampled_from(CODECS), st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), min_size=1, max_size=6))
@settings(max_examples=150)
def test_flipped_bytes_never_surprise(tmp_path_factory, good, codec, flips):
    data = bytearray(good[codec])
    for place, value in flips:
        data[min(int(place * len(data)), len(data) - 1)] = value
    outcome(tmp_path_factory.getbasetemp() / "flipped.glb", bytes(data))


@given(st.sampled_from(CODECS), st.integers(0, 4), st.binary(min_size=1, max_size=40), st.floats(0, 1))
@settings(max_examples=100)
def test_damaged_pictures_never_surprise(tmp_path_factory, good, codec, which, noise, place):
    gltf, binary = glb_surgery.split(good[codec])
    extension = gltf["extensions"][limits.EXTENSION]
    entries = [gltf["images"][0], *extension["planes"][0]["bases"][0]["textures"]]
    if "mean" in extension["planes"][0]:
        entries.append(extension["planes"][0]["mean"])
    view = gltf["bufferViews"][entries[which % len(entries)]["bufferView"]]
    start = view["byteOffset"] + int(place * max(0, view["byteLength"] - len(noise)))
    body = bytearray(binary)
    body[start : start + len(noise)] = noise
    outcome(tmp_path_factory.getbasetemp() / "noise.glb", glb_surgery.join(gltf, bytes(body)))


def pointers(value, path=()):
    """Every place in a JSON value."""
    yield path
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, child in children:
        yield from pointers(child, (*path, key))


ODD = st.one_of(
    st.none(), st.booleans(), st.integers(-(2**70), 2**70), st.integers(-2, 40), st.floats(allow_nan=True),
    st.text(max_size=5), st.just([]), st.just({}), st.just([[]]), st.lists(st.integers(-1, 9), max_size=4),
)  # fmt: skip


@given(st.data())
@settings(max_examples=300)
def test_changed_json_never_surprises(tmp_path_factory, good, data):
    gltf, binary = glb_surgery.split(good[data.draw(st.sampled_from(CODECS))])
    for _ in range(data.draw(st.integers(1, 3))):
        places = [path for path in pointers(gltf) if path]
        if not places:
            break
        *way, last = data.draw(st.sampled_from(places))
        place = gltf
        for key in way:
            place = place[key]
        if data.draw(st.booleans()) and isinstance(place, dict):
            del place[last]
        else:
            place[last] = deepcopy(data.draw(ODD))  # a list may be changed in the next round
    outcome(tmp_path_factory.getbasetemp() / "json.glb", glb_surgery.join(gltf, binary))


def test_announced_sizes_take_no_memory(tmp_path, good):
    """Whatever the JSON announces: nothing is allocated before the picture's own header agrees."""

    def huge(gltf, extension, binary):
        basis = extension["planes"][0]["bases"][0]
        basis["size"] = [8192, 16384]

    path = tmp_path / "a.glb"
    path.write_bytes(glb_surgery.changed(good["webp"], huge))
    tracemalloc.start()
    with pytest.raises(FormatError) as caught:
        scene_format.load(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert caught.value.code == "picture-size"
    assert peak < 10 * 2**20


def header_of(mime: str, width: int, height: int) -> bytes:
    """The start of a picture that claims a size."""
    if mime == "image/png":
        size = struct.pack(">4sIIBBBBB", b"IHDR", width, height, 8, 2, 0, 0, 0)
        rest = struct.pack(">II4s40x", zlib.crc32(size), 40, b"IDAT")
        return b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + size + rest
    sides = (width - 1).to_bytes(3, "little") + (height - 1).to_bytes(3, "little")
    body = struct.pack("<4sII", b"VP8X", 10, 0) + sides
    return b"RIFF" + struct.pack("<I", len(body) + 4) + b"WEBP" + body + bytes(40)


@pytest.mark.parametrize("mime", ["image/png", "image/webp"])
def test_a_picture_that_claims_a_huge_size_is_not_opened(mime):
    data = memoryview(header_of(mime, 2**16, 2**16))
    tracemalloc.start()
    with pytest.raises(FormatError) as caught:
        pictures.decode(data, mime.removeprefix("image/"), 2**14, 2**13, 3, "/")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert caught.value.code == "picture-limit" and peak < 10 * 2**20


@pytest.mark.parametrize("codec", CODECS)
@pytest.mark.parametrize("shape", [(5, 9, 3), (7, 4, 1), (6, 5, 4)])
def test_header_sizes_are_those_of_the_picture(codec, shape):
    data = memoryview(pictures.encode(np.zeros(shape, np.uint8), codec, 60))
    height, width, channels = shape
    assert pictures.dimensions(data, codec, "/") == pictures.picture_size(width, height, channels)
    assert pictures.decode(data, codec, width, height, channels, "/").shape == (1, *shape)


def test_lossy_webp_headers_are_read_too():
    for mode in ("RGB", "RGBA"):  # VP8 and VP8X
        buffer = io.BytesIO()
        Image.new(mode, (33, 21)).save(buffer, "WEBP", lossless=False)
        assert pictures.dimensions(memoryview(buffer.getvalue()), "webp", "/") == (33, 21)
