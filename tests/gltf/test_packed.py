"""A packed extension: the same scene in fewer bytes; what is damaged in it is refused."""

from __future__ import annotations

import re
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.coding import limits
from eigenfield.core.errors import OutputError
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Residual
from eigenfield.gltf import encode_scene, read_scene, store_scores, validate, without_residual
from eigenfield.gltf.packed import DICTIONARY, HEAD, pack
from support.coded_scenes import coded
from support.glb_surgery import DOCUMENT, EXTENSION, join, outcome, split, split_packed
from support.scenes import bumpy_square, tiny_scene

SCRIPT = Path(__file__).parents[2] / "web" / "eigenfield-three" / "src" / "packed.ts"


@pytest.fixture(scope="module")
def data():
    scene = replace(tiny_scene(3, 4, 9, 64), proxy=Proxy(bumpy_square(40)))
    return encode_scene(coded(scene, np.arange(9).reshape(3, 3)))


def inner(data):
    """The packed JSON as text, and the bytes of the streams."""
    gltf, binary = split_packed(data)
    start = gltf["bufferViews"][-1]["byteOffset"]
    (size,) = HEAD.unpack_from(binary, start)
    text = zlib.decompressobj(-15, zdict=DICTIONARY).decompress(binary[start + 4 : start + 4 + size])
    return text, binary[start + 4 + size : start + gltf["bufferViews"][-1]["byteLength"]]


def with_packed(data, packed):
    """The file with other bytes in the packed buffer view."""
    gltf, binary = split_packed(data)
    start = gltf["bufferViews"][-1]["byteOffset"]
    gltf["bufferViews"][-1]["byteLength"] = len(packed)
    body = binary[:start] + packed
    gltf["buffers"] = [{"byteLength": len(body)}]
    return join(gltf, body)


def deflated(text):
    coder = zlib.compressobj(9, zlib.DEFLATED, -15, zdict=DICTIONARY)
    return coder.compress(text) + coder.flush()


def test_a_packed_file_is_the_plain_one_in_fewer_bytes(data, tmp_path):
    plain = join(*split(data))
    assert "packed" not in split_packed(plain)[0]["extensions"][EXTENSION]
    assert len(data) < len(plain) - 1000
    assert encode_scene(read_scene(plain)) == encode_scene(read_scene(data)) == data
    for kind, file in (("plain", plain), ("packed", data)):
        (tmp_path / kind).write_bytes(file)
        assert validate(tmp_path / kind) == []
    outer = split_packed(data)[0]["extensions"][EXTENSION]
    assert outer == {"version": "1.8", "needs": ["packed"], "packed": 4}


def test_a_scene_that_is_not_coded_is_plain():
    assert "planes" in split_packed(encode_scene(tiny_scene()))[0]["extensions"][EXTENSION]


def test_packed_bytes_are_known():
    text = b'{"reference":40,"lengths":[2,3]}'
    made = pack({"reference": 40}, [b"ab", b"cde"])
    assert made == HEAD.pack(len(made) - 9) + made[4:-5] + b"abcde"
    assert zlib.decompressobj(-15, zdict=DICTIONARY).decompress(made[4:-5]) == text
    assert len(made) < 4 + 20 + 5


def test_the_dictionary_is_the_same_everywhere():
    """In the document, in Python and in the browser."""
    block = re.search(r"### packed\n.*?```text\n(.*?)```", DOCUMENT.read_text("utf-8"), re.S)
    assert block and block[1].replace("\n", "").encode() == DICTIONARY
    assert "".join(re.findall(r"^  '(.*)',$", SCRIPT.read_text("utf-8"), re.M)).encode() == DICTIONARY
    assert len(DICTIONARY) < 2**15  # what deflate reaches back


def test_scores_are_stored_in_it(data, tmp_path):
    path = tmp_path / "scene.glb"
    path.write_bytes(data)
    store_scores(path, {"psnr": 30.5})
    back = read_scene(path.read_bytes())
    assert back.scores == {"psnr": 30.5} and validate(path) == []
    assert inner(path.read_bytes())[1] == inner(data)[1]
    store_scores(path, {})
    assert read_scene(path.read_bytes()).scores == {}


def test_a_residual_is_taken_off(data, tmp_path):
    order = np.arange(9)[::-1].copy()
    residual = Residual(b"no video", (64, 64), order, (0.01, 0.02))
    made = encode_scene(replace(read_scene(data), residual=residual))
    assert read_scene(made).residual.order.tolist() == order.tolist()
    assert inner(made)[1] == inner(data)[1] + b"no video"
    bare = without_residual(made)
    (tmp_path / "bare.glb").write_bytes(bare)
    assert validate(tmp_path / "bare.glb") == [] and encode_scene(read_scene(bare)) == data
    assert without_residual(bare) == bare and without_residual(data) == data


def test_more_json_than_is_read_is_not_written(data, tmp_path, monkeypatch):
    path = tmp_path / "scene.glb"
    path.write_bytes(data)
    monkeypatch.setattr(limits, "MAX_JSON", 2000)
    for write in (
        lambda: store_scores(path, {"much": "x" * 2000}),
        lambda: encode_scene(replace(read_scene(data), settings={"much": "x" * 2000})),
    ):
        with pytest.raises(OutputError) as caught:
            write()
        assert caught.value.code == "scene-limit" and caught.value.remedy
    assert path.read_bytes() == data


DAMAGE = {
    "nothing": (lambda head, text, rest: b"", "json-value"),
    "no length": (lambda head, text, rest: b"abc", "coded-size"),
    "a length beyond the end": (lambda head, text, rest: HEAD.pack(2**31) + rest, "coded-size"),
    "no JSON": (lambda head, text, rest: HEAD.pack(0) + rest, "coded-damaged"),
    "noise": (lambda head, text, rest: HEAD.pack(4) + b"\xff\xff\xff\xff" + rest, "coded-damaged"),
    "cut off": (lambda head, text, rest: HEAD.pack(len(head) - 2) + head[:-2] + rest, "coded-damaged"),
    "more than its end": (lambda head, text, rest: HEAD.pack(len(head) + 1) + head + b"\0" + rest, "coded-damaged"),
    "text": (lambda head, text, rest: packed(b"some text", rest), "json-invalid"),
    "a list": (lambda head, text, rest: packed(b"[]", rest), "json-type"),
    "a doubled key": (lambda head, text, rest: packed(b'{"lengths":[1],"lengths":[1]}', rest), "json-invalid"),
    "no lengths": (lambda head, text, rest: packed(b"{}", rest), "json-missing"),
    "a stream of nothing": (lambda head, text, rest: packed(b'{"lengths":[0]}', b""), "json-value"),
    "streams that end early": (lambda head, text, rest: packed(text, rest + b"\0"), "coded-size"),
    "streams beyond the end": (lambda head, text, rest: packed(text, rest[:-1]), "coded-size"),
    "nothing of a scene": (lambda head, text, rest: packed(b'{"lengths":[]}', b""), "json-missing"),
    "an unknown need": (lambda head, text, rest: packed(text.replace(b'"stacks"', b'"towers"'), rest), "needs"),
    "too deep": (lambda head, text, rest: packed(b'{"a":' + b"[" * 99 + b"]" * 99 + b"}", rest), "json-depth"),
}


def packed(text, rest):
    head = deflated(text)
    return HEAD.pack(len(head)) + head + rest


@pytest.mark.parametrize("what", DAMAGE)
def test_what_is_damaged_is_refused(data, tmp_path, what):
    change, code = DAMAGE[what]
    text, rest = inner(data)
    assert outcome(tmp_path / "a.glb", with_packed(data, change(deflated(text), text, rest))) == code


@pytest.mark.parametrize(
    ("packed", "code"),
    [(3, "json-value"), (5, "json-value"), ("4", "json-type"), (None, "json-type"), (-1, "json-value")],
)
def test_it_names_the_last_buffer_view(data, tmp_path, packed, code):
    gltf, binary = split_packed(data)
    gltf["extensions"][EXTENSION]["packed"] = packed
    assert outcome(tmp_path / "a.glb", join(gltf, binary)) == code


def test_an_unknown_need_beside_it_is_refused_by_name(data, tmp_path):
    gltf, binary = split_packed(data)
    gltf["extensions"][EXTENSION]["needs"].append("repacked")
    assert outcome(tmp_path / "a.glb", join(gltf, binary[:40])) == "needs"


def test_a_json_that_inflates_to_gigabytes_takes_no_memory(data, tmp_path, monkeypatch):
    monkeypatch.setattr(limits, "MAX_JSON", 2**16)
    whole = with_packed(data, packed(b'{"a":"' + b" " * 2**20 + b'"}', b""))
    assert outcome(tmp_path / "a.glb", whole) == "json-size"


def test_every_length_is_refused_or_drawn_of_the_textures_that_are_there(data, tmp_path):
    gltf, binary = split(data)
    start = min(view["byteOffset"] for view in gltf["bufferViews"][-1:]) + len(data) - len(binary)
    for length in (*range(0, start, 53), start - 1):
        assert outcome(tmp_path / "a.glb", data[:length]) in ("not-glb", "truncated")
    assert read_scene(data[: start + 1]).appearance.textures < 4


@given(st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), min_size=1, max_size=6))
@settings(max_examples=200)
def test_flipped_bytes_never_surprise(tmp_path_factory, data, flips):
    """In the packed part: JSON and streams."""
    gltf, binary = split_packed(data)
    body, start = bytearray(binary), gltf["bufferViews"][-1]["byteOffset"]
    for place, value in flips:
        body[start + min(int(place**3 * (len(body) - start)), len(body) - start - 1)] = value
    outcome(tmp_path_factory.getbasetemp() / "flipped.glb", join(gltf, bytes(body)))


def test_what_lies_in_accessors_stays_there():
    """Photographs of two sizes, and exposures of their own."""
    plain = replace(tiny_scene(3, 4, 9, 64), proxy=Proxy(bumpy_square(40)))
    first, *others = plain.rig.cameras
    cameras = (replace(first, width=first.width - 2), *others)
    scene = coded(replace(plain, rig=replace(plain.rig, cameras=cameras)), np.arange(9).reshape(3, 3))
    colours = np.tile(np.array([[[1, 1, 1], [0, 0, 0.25]]], np.float32), (9, 1, 1))
    made = encode_scene(replace(scene, appearance=replace(scene.appearance, colours=colours)))
    assert "packed" in split_packed(made)[0]["extensions"][EXTENSION]
    back = read_scene(made)
    assert [camera.width for camera in back.rig.cameras] == [camera.width for camera in cameras]
    np.testing.assert_array_equal(back.appearance.colours, colours)
