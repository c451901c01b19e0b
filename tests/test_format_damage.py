"""Damaged, newer, hostile and foreign files: always a FormatError with the code that docs/format.md promises."""

from __future__ import annotations

import copy
import io
import json
import os
import re
import struct
import tracemalloc
import zlib
from pathlib import Path

import glb_surgery
import numpy as np
import pytest
import trimesh
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image
from scenes import tiny_scene

from eigenfield import format as scene_format
from eigenfield.cli.info import command as info
from eigenfield.cli.validate import command as validate
from eigenfield.errors import FormatError
from eigenfield.format import limits, pictures
from eigenfield.format.container import parse_glb

CODECS = ("png", "webp", "avif")
DOCUMENT = Path(__file__).parents[1] / "docs" / "format.md"


@pytest.fixture(scope="module")
def good() -> dict[str, bytes]:
    """A file of each codec, with everything in it."""
    scene = tiny_scene(3, 3, cameras=6, held_out=(1,))
    return {codec: scene_format.encode_scene(scene, codec=codec) for codec in CODECS}


def outcome(path: Path, data: bytes) -> str | None:
    """The code with which `load` refuses `data`, None if it takes it; `validate` must agree, no other error escape."""
    path.write_bytes(data)
    findings = scene_format.validate(path)
    errors = [finding for finding in findings if finding.severity == "error"]
    try:
        scene_format.load(path)
    except FormatError as error:
        assert error.path == str(path) and error.where and str(error).startswith(str(path))
        assert "\n" not in str(error)
        assert error.code in [finding.code for finding in errors]
        assert f"`{error.code}`" in DOCUMENT.read_text(encoding="utf-8"), error.code
        return error.code
    finally:
        path.unlink()
    others = ("/images", "/materials", "/meshes", "/textures", "/accessors")  # what only other viewers need
    assert all(finding.where.startswith(others) for finding in errors)
    return None


def test_good_files_are_good(tmp_path, good):
    for data in good.values():
        assert outcome(tmp_path / "a.glb", data) is None


def without(*keys):
    def change(gltf, extension, binary):
        place = gltf
        for key in keys[:-1]:
            place = place[key]
        del place[keys[-1]]

    return change


def setting(*keys, value):
    def change(gltf, extension, binary):
        place = gltf
        for key in keys[:-1]:
            place = place[key]
        place[keys[-1]] = value

    return change


def ours(*keys, value):
    return setting("extensions", limits.EXTENSION, *keys, value=value)


def not_ours(*keys):
    return without("extensions", limits.EXTENSION, *keys)


def numbers(where, dtype, index, value):
    """Overwrite one number of an accessor; `where(gltf, extension)` is its index."""

    def change(gltf, extension, binary):
        start, end = glb_surgery.view_of(gltf, where(gltf, extension))
        array = np.frombuffer(bytes(binary[start:end]), dtype).copy()
        array[index] = value
        binary[start:end] = array.tobytes()

    return change


def attribute(name):
    return lambda gltf, extension: gltf["meshes"][0]["primitives"][0]["attributes"][name]


def indices(gltf, extension):
    return gltf["meshes"][0]["primitives"][0]["indices"]


def weights(gltf, extension):
    return extension["planes"][0]["bases"][0]["weights"]


def camera(name):
    return lambda gltf, extension: extension["cameras"][name]


def hull(gltf, extension):
    return extension["viewPlane"]["triangles"]


def one_texture_of(channels_last_picture):
    def change(gltf, extension, binary):
        data = pictures.encode(channels_last_picture, "png", 0)
        gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data + bytes(-len(data) % 4)
        gltf["buffers"][0]["byteLength"] = len(binary)
        entry = extension["planes"][0]["bases"][0]["textures"][1]
        entry |= {"bufferView": len(gltf["bufferViews"]) - 1, "mimeType": "image/png"}

    return change


TEXTURE = ("planes", 0, "bases", 0, "textures", 0)
CASES = {
    "asset-version": (setting("asset", "version", value="1.0"), "gltf-version"),
    "no-extension": (without("extensions", limits.EXTENSION), "not-a-scene"),
    "no-extensions": (without("extensions"), "not-a-scene"),
    "next-major": (ours("version", value="2.0"), "version"),
    "version-nonsense": (ours("version", value="1.x"), "version"),
    "version-number": (ours("version", value=1.0), "json-type"),
    "needs-unknown": (ours("needs", value=["charts"]), "needs"),
    "needs-no-list": (ours("needs", value="charts"), "json-type"),
    "extension-no-object": (setting("extensions", limits.EXTENSION, value=[1]), "json-type"),
    "planes-empty": (ours("planes", value=[]), "json-value"),
    "planes-missing": (not_ours("planes"), "json-missing"),
    "channels-none": (ours("planes", 0, "channels", value=0), "json-value"),
    "channels-many": (ours("planes", 0, "channels", value=10**9), "json-value"),
    "channels-real": (ours("planes", 0, "channels", value=3.0), "json-type"),
    "channels-true": (ours("planes", 0, "channels", value=True), "json-type"),
    "channels-other": (ours("planes", 0, "channels", value=2), ("picture-size", "json-value")),
    "size-huge": (ours("planes", 0, "bases", 0, "size", value=[10**6, 10**6]), "json-value"),
    "size-large": (ours("planes", 0, "bases", 0, "size", value=[16384, 16384]), "picture-limit"),
    "size-other": (ours("planes", 0, "bases", 0, "size", value=[32, 31]), "picture-size"),
    "size-negative": (ours("planes", 0, "bases", 0, "size", value=[-32, -32]), "json-value"),
    "size-short": (ours("planes", 0, "bases", 0, "size", value=[32]), "json-value"),
    "mime-unknown": (ours(*TEXTURE, "mimeType", value="image/x-tga"), "picture-type"),
    "mime-other": (ours(*TEXTURE, "mimeType", value="image/jpeg"), "picture-damaged"),
    "scale-missing": (not_ours(*TEXTURE, "scale"), "json-missing"),
    "scale-short": (ours(*TEXTURE, "scale", value=[1.0]), "json-value"),
    "scale-text": (ours(*TEXTURE, "scale", value=[1, 2, "3"]), "json-type"),
    "scale-huge": (ours(*TEXTURE, "scale", value=[1, 2, 1e300]), "json-value"),
    "zero-null": (ours(*TEXTURE, "zero", value=None), "json-type"),
    "texture-elsewhere": (ours(*TEXTURE, "bufferView", value=9999), "view-missing"),
    "texture-negative": (ours(*TEXTURE, "bufferView", value=-1), "json-value"),
    "grey-texture": (one_texture_of(np.zeros((32, 32, 1), np.uint8)), "picture-channels"),
    "small-texture": (one_texture_of(np.zeros((32, 30, 3), np.uint8)), "picture-size"),
    "weights-elsewhere": (ours("planes", 0, "bases", 0, "weights", value=77), "accessor-missing"),
    "weights-nan": (numbers(weights, "<f4", 3, np.nan), "weights-not-finite"),
    "weights-infinite": (numbers(weights, "<f4", 0, -np.inf), "weights-not-finite"),
    "weights-other": (ours("planes", 0, "bases", 0, "weights", value=0), "accessor-type"),
    "fewer-textures": (not_ours("planes", 0, "bases", 0, "textures", 2), "weights-count"),
    "cameras-missing": (not_ours("cameras"), "json-missing"),
    "names-doubled": (ours("cameras", "names", 1, value="view_00"), "camera-name"),
    "names-control": (ours("cameras", "names", 1, value="a\x1b[2J"), "camera-name"),
    "names-number": (ours("cameras", "names", 1, value=7), "json-type"),
    "names-long": (ours("cameras", "names", 1, value="x" * 2000), "json-value"),
    "names-fewer": (not_ours("cameras", "names", 5), "camera-count"),
    "held-out-range": (ours("cameras", "heldOut", value=[6]), "json-value"),
    "held-out-twice": (ours("cameras", "heldOut", value=[1, 1]), "camera-held-out"),
    "held-out-all": (ours("cameras", "heldOut", value=[0, 1, 2, 3, 4, 5]), "camera-held-out"),
    "held-out-other": (ours("cameras", "heldOut", value=[]), "weights-count"),
    "focal-zero": (numbers(camera("intrinsics"), "<f4", 5, 0), "camera-intrinsics"),
    "focal-nan": (numbers(camera("intrinsics"), "<f4", 0, np.nan), "camera-intrinsics"),
    "centre-infinite": (numbers(camera("intrinsics"), "<f4", 3, np.inf), "camera-intrinsics"),
    "rotation-nan": (numbers(camera("poses"), "<f4", 0, np.nan), "camera-poses"),
    "rotation-scaled": (numbers(camera("poses"), "<f4", 5, 1.01), "camera-poses"),
    "rotation-huge": (numbers(camera("poses"), "<f4", 5, 1e29), "camera-poses"),
    "rotation-mirrored": (numbers(camera("poses"), "<f4", 5, -1), "camera-poses"),
    "size-none": (numbers(camera("sizes"), "<u4", 0, 0), "camera-sizes"),
    "camera-huge": (numbers(camera("sizes"), "<u4", 0, 2**32 - 1), "camera-sizes"),
    "camera-large": (numbers(camera("sizes"), "<u4", slice(0, 2), 60000), "camera-sizes"),
    "reference-range": (ours("reference", value=6), "json-value"),
    "reference-missing": (not_ours("reference"), "json-missing"),
    "view-plane-skew": (ours("viewPlane", "right", value=[0.9, 0.1, 0]), "view-plane"),
    "view-plane-parallel": (ours("viewPlane", "up", value=[1, 0, 0]), "view-plane"),
    "view-plane-short": (ours("viewPlane", "origin", value=[0, 0]), "json-value"),
    "view-plane-huge": (ours("viewPlane", "right", value=[1e200, 0, 0]), "json-value"),
    "extent-negative": (ours("viewPlane", "extent", value=[-1, 1]), "view-plane"),
    "triangles-range": (numbers(hull, "<u4", 0, 5), "view-plane-triangles"),
    "triangles-far": (numbers(hull, "<u4", 0, 2**32 - 1), "view-plane-triangles"),
    "settings-list": (ours("settings", value=[]), "json-type"),
    "scores-number": (ours("scores", value=3), "json-type"),
    "vertex-nan": (numbers(attribute("POSITION"), "<f4", 4, np.nan), "mesh-not-finite"),
    "vertex-infinite": (numbers(attribute("POSITION"), "<f4", 4, np.inf), "mesh-not-finite"),
    "uv-nan": (numbers(attribute("TEXCOORD_0"), "<f4", 4, np.nan), "mesh-uv"),
    "index-range": (numbers(indices, "<u2", 7, 36), "mesh-index"),
    "no-mesh": (without("meshes"), "json-missing"),
    "mesh-empty": (setting("meshes", value=[]), "json-missing"),
    "mesh-lines": (setting("meshes", 0, "primitives", 0, "mode", value=1), "mesh-mode"),
    "no-uv": (without("meshes", 0, "primitives", 0, "attributes", "TEXCOORD_0"), "json-missing"),
    "accessor-huge": (setting("accessors", 0, "count", value=2**26), "accessor-range"),
    "accessor-beyond": (setting("accessors", 0, "count", value=2**40), "json-value"),
    "accessor-empty": (setting("accessors", 0, "count", value=0), "json-value"),
    "accessor-double": (setting("accessors", 0, "componentType", value=5130), "accessor-type"),
    "accessor-sparse": (setting("accessors", 0, "sparse", value={}), "accessor-type"),
    "accessor-normalised": (setting("accessors", 0, "normalized", value=True), "accessor-type"),
    "accessor-odd": (setting("accessors", 0, "byteOffset", value=2), "accessor-alignment"),
    "accessor-outside": (setting("accessors", 0, "byteOffset", value=4), "accessor-range"),
    "fewer-uv": (setting("accessors", 1, "count", value=35), "mesh-uv"),
    "indices-torn": (setting("accessors", 2, "count", value=149), "mesh-index"),
    "view-outside": (setting("bufferViews", 0, "byteLength", value=2**31), "view-range"),
    "view-offset": (setting("bufferViews", 0, "byteOffset", value=2**31), "view-range"),
    "view-elsewhere": (setting("bufferViews", 0, "buffer", value=1), "view-range"),
    "view-stride": (setting("bufferViews", 0, "byteStride", value=8), "accessor-range"),
    "view-shared": (setting("bufferViews", 1, "byteOffset", value=0), "view-overlap"),
    "views-missing": (without("bufferViews"), "json-missing"),
    "buffer-other": (setting("buffers", 0, "byteLength", value=100), "buffer"),
    "buffer-file": (setting("buffers", 0, "uri", value="a.bin"), "buffer"),
    "buffer-two": (setting("buffers", value=[{"byteLength": 4}] * 2), "json-value"),
    "nested": (ours("settings", value=json.loads("[" * 70 + "]" * 70)), "json-depth"),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_each_damage_has_its_code(tmp_path, good, name):
    change, code = CASES[name]
    found = outcome(tmp_path / "a.glb", glb_surgery.changed(good["webp"], change))
    assert found in (code if isinstance(code, tuple) else (code,))


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack("<I4s", len(data), kind) + data


def glb(*chunks: bytes, version: int = 2) -> bytes:
    body = b"".join(chunks)
    return struct.pack("<4sII", b"glTF", version, 12 + len(body)) + body


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"", "not-glb"),
        (b"glT", "not-glb"),
        (b"glTF\2\0", "truncated"),
        (b"PK\3\4" + bytes(100), "not-glb"),
        (b'{"asset": {}}', "not-glb"),
        (glb(), "glb-chunk"),
        (glb(chunk(b"JSON", b"{}  "), version=1), "glb-version"),
        (glb(chunk(b"JSON", b"{}  ")), "json-missing"),
        (glb(chunk(b"JSON", b"{}  ")) + b"x", "glb-length"),
        (glb(chunk(b"JSON", b"{} ")), "glb-chunk"),
        (glb(chunk(b"BIN\0", b"    ")), "glb-chunk"),
        (glb(chunk(b"JSON", b"{}  "), chunk(b"JSON", b"{}  ")), "glb-chunk"),
        (glb(chunk(b"JSON", b"{}  "), chunk(b"BIN\0", b""), chunk(b"BIN\0", b"")), "glb-chunk"),
        (glb(chunk(b"JSON", b"{}  "), chunk(b"ODD\0", b""), chunk(b"BIN\0", b"")), "glb-chunk"),
        (glb(chunk(b"JSON", b"{}  "), *[chunk(b"ODD\0", b"")] * 100), "glb-chunk"),
        (glb(chunk(b"JSON", b"{}  "), b"\4\0\0\0"), "glb-chunk"),
        (glb(struct.pack("<I4s", 2**32 - 4, b"JSON") + b"{}  "), "glb-chunk"),
        (glb(chunk(b"JSON", b"")), "json-invalid"),
        (glb(chunk(b"JSON", b"\xff\xfe{}")), "json-invalid"),
        (glb(chunk(b"JSON", b"NaN ")), "json-invalid"),
        (glb(chunk(b"JSON", b'{"a":1e999 }')), "json-invalid"),
        (glb(chunk(b"JSON", b'{"a":-Infinity  }   ')), "json-invalid"),
        (glb(chunk(b"JSON", b'{"a":1,"a":2}   ')), "json-invalid"),
        (glb(chunk(b"JSON", b'{"a":"\\udc80"}  ')), "json-invalid"),
        (glb(chunk(b"JSON", b"1" * 5000)), "json-invalid"),
        (glb(chunk(b"JSON", b"[" * 100_000)), ("json-depth", "json-invalid")),
        (glb(chunk(b"JSON", b'{"a":' * 20_000)), ("json-depth", "json-invalid")),
        (glb(chunk(b"JSON", b"[]  ")), "json-type"),
        (glb(chunk(b"JSON", b"null")), "json-type"),
    ],
)
def test_containers_that_are_none(tmp_path, data, code):
    assert outcome(tmp_path / "a.glb", data) in (code if isinstance(code, tuple) else (code,))


def test_too_much_json(tmp_path, good, monkeypatch):
    monkeypatch.setattr(limits, "MAX_JSON", 1000)
    assert outcome(tmp_path / "a.glb", good["png"]) == "json-size"


def test_too_large_a_file(tmp_path, good, monkeypatch):
    monkeypatch.setattr(limits, "MAX_FILE", 1000)
    assert outcome(tmp_path / "a.glb", good["png"]) == "file-size"


@pytest.mark.parametrize(
    ("limit", "value", "code"),
    [
        ("MAX_DECODED", 20_000, "decoded-size"),
        ("MAX_COMPONENTS", 2, "json-value"),
        ("MAX_TEXELS", 1000, "picture-limit"),
        ("MAX_VIEWS", 3, "json-value"),
        ("MAX_WEIGHTS", 5, "json-value"),
        ("MAX_CAMERA_SIDE", 40, "camera-sizes"),
    ],
)
def test_limits_hold(tmp_path, good, monkeypatch, limit, value, code):
    monkeypatch.setattr(limits, limit, value)
    assert outcome(tmp_path / "a.glb", good["webp"]) == code


def test_components_are_counted_over_all_bases(tmp_path, good, monkeypatch):
    def twice(gltf, extension, binary):
        extension["planes"].append(copy.deepcopy(extension["planes"][0]))

    monkeypatch.setattr(limits, "MAX_COMPONENTS", 5)
    assert outcome(tmp_path / "a.glb", glb_surgery.changed(good["webp"], twice)) == "plane-components"


def test_a_second_plane_needs_its_own_mean(tmp_path, good):
    def meanless(gltf, extension, binary):
        extension["planes"].append({"channels": 3, "bases": []})

    assert outcome(tmp_path / "a.glb", glb_surgery.changed(good["png"], meanless)) == "plane-mean"
    away = setting("images", 0, value={"uri": "mean.png"})
    assert outcome(tmp_path / "a.glb", glb_surgery.changed(good["png"], away)) == "plane-mean"


def test_what_is_no_file_at_all(tmp_path):
    for path, code in ((tmp_path / "none.glb", "file-missing"), (tmp_path, "not-a-file"), ("a\0b", "file-unreadable")):
        with pytest.raises(FormatError) as caught:
            scene_format.load(path)
        assert caught.value.code == code
        assert [finding.code for finding in scene_format.validate(path)] == [code]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_does_not_hang(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(FormatError) as caught:
        scene_format.load(tmp_path / "pipe")
    assert caught.value.code == "not-a-file"


def test_a_plain_glb_is_named_as_such(tmp_path):
    trimesh.creation.box().export(tmp_path / "box.glb")
    with pytest.raises(FormatError) as caught:
        scene_format.load(tmp_path / "box.glb")
    assert caught.value.code == "not-a-scene"
    assert re.search(r"box\.glb: .*EIGENFIELD_eigen_textures.*no eigen-texture scene.*encode", str(caught.value))


@pytest.mark.parametrize("codec", CODECS)
def test_every_length_is_refused(tmp_path, good, codec):
    data = good[codec]
    lengths = {*range(64), *range(64, len(data), 37), len(data) - 1}
    assert all(outcome(tmp_path / "a.glb", data[:length]) in ("not-glb", "truncated") for length in lengths)


@pytest.mark.parametrize("codec", CODECS)
def test_a_truncation_that_mends_its_header_is_refused(tmp_path, good, codec):
    gltf, binary = glb_surgery.split(good[codec])
    for keep in range(0, len(binary), 97):
        assert outcome(tmp_path / "a.glb", glb_surgery.join(gltf, binary[:keep])) is not None


@given(st.sampled_from(CODECS), st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), min_size=1, max_size=6))
@settings(max_examples=150, deadline=None)
def test_flipped_bytes_never_surprise(tmp_path_factory, good, codec, flips):
    data = bytearray(good[codec])
    for place, value in flips:
        data[min(int(place * len(data)), len(data) - 1)] = value
    outcome(tmp_path_factory.getbasetemp() / "flipped.glb", bytes(data))


@given(st.sampled_from(CODECS), st.integers(0, 4), st.binary(min_size=1, max_size=40), st.floats(0, 1))
@settings(max_examples=100, deadline=None)
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
@settings(max_examples=300, deadline=None)
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
            place[last] = data.draw(ODD)
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
        pictures.decode(data, mime, 2**14, 2**13, 3, "/")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert caught.value.code == "picture-limit" and peak < 10 * 2**20


@pytest.mark.parametrize("codec", CODECS)
@pytest.mark.parametrize("shape", [(5, 9, 3), (7, 4, 1), (6, 5, 4)])
def test_header_sizes_are_those_of_the_picture(codec, shape):
    data = memoryview(pictures.encode(np.zeros(shape, np.uint8), codec, 60))
    height, width, channels = shape
    assert pictures.dimensions(data, pictures.MIME_TYPES[codec], "/") == pictures.picture_size(width, height, channels)
    assert pictures.decode(data, pictures.MIME_TYPES[codec], width, height, channels, "/").shape == shape


def test_lossy_webp_headers_are_read_too():
    for mode in ("RGB", "RGBA"):  # VP8 and VP8X
        buffer = io.BytesIO()
        Image.new(mode, (33, 21)).save(buffer, "WEBP", lossless=False)
        assert pictures.dimensions(memoryview(buffer.getvalue()), "image/webp", "/") == (33, 21)


def test_validate_goes_on_behind_an_error(tmp_path, good):
    def several(gltf, extension, binary):
        extension["cameras"]["names"][1] = extension["cameras"]["names"][0]
        extension["viewPlane"]["right"] = [0.5, 0, 0]
        extension["planes"][0]["bases"][0]["textures"][2]["mimeType"] = "image/x-tga"
        extension["scores"] = 5
        numbers(attribute("TEXCOORD_0"), "<f4", 0, np.nan)(gltf, extension, binary)
        numbers(weights, "<f4", 0, np.nan)(gltf, extension, binary)
        gltf["extensionsUsed"].remove(limits.EXTENSION)

    path = tmp_path / "a.glb"
    path.write_bytes(glb_surgery.changed(good["webp"], several))
    found = {(finding.severity, finding.code) for finding in scene_format.validate(path)}
    assert found == {
        ("error", "camera-name"), ("error", "view-plane"), ("error", "picture-type"), ("error", "json-type"),
        ("error", "mesh-uv"), ("error", "weights-not-finite"), ("warning", "extension-not-used"),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("change", "finding"),
    [
        (setting("extensionsRequired", value=[limits.EXTENSION]), ("warning", "extension-required")),
        (setting("accessors", 0, "min", value=[-9, -9, -9]), ("warning", "mesh-bounds")),
        (without("images"), ("error", "json-missing")),
        (setting("images", 0, "mimeType", value="image/png"), ("error", "picture-damaged")),
        (without("meshes", 0, "primitives", 0, "material"), ("error", "json-missing")),
        (ours("later", value=1), ("information", "unknown-key")),
    ],
)
def test_validate_sees_what_load_does_not_need(tmp_path, good, change, finding):
    path = tmp_path / "a.glb"
    path.write_bytes(glb_surgery.changed(good["webp"], change))
    scene_format.load(path)
    assert finding in {(found.severity, found.code) for found in scene_format.validate(path)}


def test_every_code_in_the_sources_is_in_the_documentation():
    text = DOCUMENT.read_text(encoding="utf-8")
    source = "\n".join(path.read_text(encoding="utf-8") for path in (Path(scene_format.__file__).parent).glob("*.py"))
    codes = set(re.findall(r'(?:FormatError\(|\.fail\(|note\("\w+",)\s*"([a-z-]+)"', source))
    codes |= {"camera-intrinsics", "camera-poses", "camera-sizes"}
    assert len(codes) > 35
    assert {code for code in codes if f"`{code}`" not in text} == set()


def test_every_limit_is_in_the_documentation():
    text = DOCUMENT.read_text(encoding="utf-8")
    for name, value in vars(limits).items():
        if name.startswith("MAX_"):
            assert f"`{name}` | {value} |" in text, name


def test_unknown_chunks_are_skipped(good):
    data = good["png"]
    longer = data[:8] + struct.pack("<I", len(data) + 12) + data[12:] + chunk(b"ODD\0", b"abcd")
    assert parse_glb(longer).binary == parse_glb(data).binary


def run(command, *arguments):
    return CliRunner().invoke(command, [str(argument) for argument in arguments])


def test_validate_on_the_command_line(tmp_path, good):
    fine, bad = tmp_path / "fine.glb", tmp_path / "with space.glb"
    fine.write_bytes(good["png"])
    bad.write_bytes(good["png"][:-5])
    done = run(validate, fine)
    assert (done.exit_code, done.output) == (0, f"{fine}: no findings\n")
    done = run(validate, fine, bad, tmp_path / "none.glb")
    assert done.exit_code == 2
    assert f"{bad}: error truncated at byte {len(good['png']) - 5}: ends after" in done.output
    assert "file-missing" in done.output
    done = run(validate, "--json", fine, bad)
    assert done.exit_code == 2
    first, second = json.loads(done.stdout)
    assert first == {"file": str(fine), "findings": []}
    assert [finding["code"] for finding in second["findings"]] == ["truncated"]
    assert run(validate, "--quiet", fine).output == ""


def test_info_on_the_command_line(tmp_path, good):
    path = tmp_path / "scene.glb"
    path.write_bytes(good["avif"])
    text = run(info, path).output
    for expected in ("3 of 32x32, 3 channels, image/avif", "5 encoded, 1 held out", "view_01", "Y up", "psnr", "30.5",
                     "36 vertices, 50 triangles", "6 of 48x40", "100.0 %", "eigenfield test", "density"):  # fmt: skip
        assert expected in text, expected
    facts = json.loads(run(info, "--json", path).stdout)
    assert facts["bytes"]["total"] == len(good["avif"])
    assert facts["cameras"]["held_out"] == ["view_01"]
    assert facts["planes"][0]["bases"][0]["textures"] == 3
    assert facts["view_plane"]["width"] == 1.0 and facts["view_plane"]["height"] == 0.5
    assert facts["scores"] == {"uv": {"psnr": 30.5}}


def test_info_refuses_what_load_refuses(tmp_path, good):
    path = tmp_path / "scene.glb"
    path.write_bytes(good["png"][:1000])
    done = run(info, path)
    assert isinstance(done.exception, FormatError) and done.exception.code == "truncated"


def test_info_shows_nothing_raw_from_the_file(tmp_path, good):
    path = tmp_path / "scene.glb"
    evil = "\x1b[2J\n"
    path.write_bytes(glb_surgery.changed(good["png"], lambda g, e, b: e.update(
        generator=evil, settings={evil: evil}, scores={"a": {evil: [evil]}}, **{evil: 1})))  # fmt: skip
    for command in (info, validate):
        assert "\x1b" not in run(command, path).output
