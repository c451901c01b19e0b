"""Damaged, newer, hostile and foreign files: always a FormatError with the code that docs/format.md promises."""

from __future__ import annotations

import copy
import json
import os
import re
import struct

import numpy as np
import pytest
import trimesh

from eigenfield import gltf as scene_format
from eigenfield.coding import limits
from eigenfield.core.errors import FormatError
from support import glb_surgery
from support.glb_surgery import (
    attribute,
    camera,
    chunk,
    glb,
    hull,
    indices,
    not_ours,
    numbers,
    one_texture_of,
    ours,
    outcome,
    setting,
    weights,
    without,
)


def test_good_files_are_good(tmp_path, good, caplog):
    assert good
    for data in good.values():
        assert outcome(tmp_path / "a.glb", data) is None
        assert not caplog.records
        assert not re.search(r"-0\.0\b", json.dumps(glb_surgery.split(data)[0]))


TEXTURE = ("planes", 0, "bases", 0, "textures", 0)
CASES = {
    "asset-version": (setting("asset", "version", value="1.0"), "gltf-version"),
    "no-extension": (without("extensions", limits.EXTENSION), "not-a-scene"),
    "no-extensions": (without("extensions"), "not-a-scene"),
    "next-major": (ours("version", value="2.0"), "version"),
    "version-nonsense": (ours("version", value="1.x"), "version"),
    "version-number": (ours("version", value=1.0), "json-type"),
    "needs-unknown": (ours("needs", value=["charts"]), "needs"),
    "times": (ours("times", value=[0, 0.5]), "times"),
    "needs-times": (ours("needs", value=["times"]), "times"),
    "needs-no-list": (ours("needs", value="charts"), "json-type"),
    "extension-no-object": (setting("extensions", limits.EXTENSION, value=[1]), "json-type"),
    "planes-empty": (ours("planes", value=[]), "json-value"),
    "planes-missing": (not_ours("planes"), "json-missing"),
    "channels-none": (ours("planes", 0, "channels", value=0), "json-value"),
    "channels-many": (ours("planes", 0, "channels", value=10**9), "json-value"),
    "channels-real": (ours("planes", 0, "channels", value=3.0), "json-type"),
    "channels-text": (ours("planes", 0, "channels", value="x" * 100), "json-type"),
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
    "extent-of-a-line": (ours("viewPlane", "extent", value=[1, 0]), None),
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


@pytest.mark.parametrize(
    "address", ["http://host/a.png", "//host/a", "file:///a", "blob:a", "../a", "a.png", "", 7, None]
)
@pytest.mark.parametrize("place", [("images", 0), ("buffers", 0), ("materials", 0, "extensions", "MAKER_holograms")])
def test_a_file_that_names_another_is_refused(tmp_path, good, place, address):
    def away(gltf, extension, binary):
        gltf["materials"][0].setdefault("extensions", {})["MAKER_holograms"] = {}
        setting(*place, "uri", value=address)(gltf, extension, binary)

    path = tmp_path / "a.glb"
    path.write_bytes(glb_surgery.changed(good["webp"], away))
    code = "buffer" if place == ("buffers", 0) else "address"
    for read in (scene_format.load, scene_format.outline, scene_format.describe):
        with pytest.raises(FormatError, match=re.escape(json.dumps(address))) as caught:
            read(path)
        assert (caught.value.code, caught.value.path) == (code, str(path))
    assert "address" in {finding.code for finding in scene_format.validate(path)}


def test_data_uris_and_what_is_in_extras_stay(tmp_path, good):
    def more(gltf, extension, binary):
        gltf["images"].append({"uri": "DATA:,", "extras": {"uri": "http://host/a"}})

    assert outcome(tmp_path / "a.glb", glb_surgery.changed(good["webp"], more)) is None


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
        (glb(chunk(b"JSON", b"{}  "), version=3), "glb-version"),
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


@pytest.mark.parametrize(("padding", "fits"), [(-1, False), (0, True), (3, True), (4, False)])
def test_a_binary_chunk_is_padded_by_up_to_three_bytes(tmp_path, good, padding, fits):
    _, binary = glb_surgery.split(good["webp"])
    change = setting("buffers", 0, "byteLength", value=len(binary) - padding)
    found = outcome(tmp_path / "a.glb", glb_surgery.changed(good["webp"], change))
    assert (found != "buffer") == fits


def test_too_much_json(tmp_path, good, monkeypatch):
    monkeypatch.setattr(limits, "MAX_JSON", 1000)
    assert outcome(tmp_path / "a.glb", good["png"]) == "json-size"


def test_too_large_a_file(tmp_path, good, monkeypatch):
    monkeypatch.setattr(limits, "MAX_FILE", 1000)
    assert outcome(tmp_path / "a.glb", good["png"]) == "file-size"


@pytest.mark.slow
def test_a_file_beyond_4_gib_is_refused_unread(tmp_path, good):
    path = tmp_path / "a.glb"
    path.write_bytes(good["png"])
    with path.open("r+b") as file:
        file.truncate((4 << 30) + 1)  # sparse
    with pytest.raises(FormatError) as caught:
        scene_format.load(path)
    assert caught.value.code == "file-size"


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


def test_weights_of_several_instants_are_refused_in_one_line(tmp_path, good):
    path = tmp_path / "a.glb"
    path.write_bytes(glb_surgery.changed(good["png"], ours("times", value=[0])))
    for read in (scene_format.load, lambda path: scene_format.store_scores(path, {})):
        with pytest.raises(FormatError, match=r"has weights for several instants \(`times`\)") as caught:
            read(path)
        assert caught.value.code == "times" and caught.value.remedy and "\n" not in str(caught.value)


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
