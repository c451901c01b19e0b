"""Files are read by range: what follows the binary chunk is neither read nor lost."""

from __future__ import annotations

import struct
from dataclasses import replace

import numpy as np
import pytest

from eigenfield.core.errors import FormatError
from eigenfield.core.proxy import Proxy
from eigenfield.core.recognise import HEAD_BYTES
from eigenfield.core.scene import Residual
from eigenfield.gltf import encode_scene, load, read_scene, store_scores, validate, without_residual
from eigenfield.gltf.container import BINARY_CHUNK, JSON_CHUNK, parse_glb
from eigenfield.gltf.source import PIECE_BYTES, HeldBytes, OpenFile, open_source
from support.coded_scenes import coded
from support.scenes import bumpy_square, tiny_scene

GROUPS = bytes(range(256)) * 16
BEHIND = struct.pack("<I4s", len(GROUPS), b"EFTL") + GROUPS + struct.pack("<I4s", 4, b"ODD\0") + b"abcd"


@pytest.fixture(scope="module")
def files():
    packed = coded(replace(tiny_scene(3, 4, 9, 64), proxy=Proxy(bumpy_square(40))), np.arange(9).reshape(3, 3))
    return {"plain": encode_scene(tiny_scene()), "packed": encode_scene(packed)}


def longer(data: bytes, behind: bytes = BEHIND) -> bytes:
    """A file with more chunks behind its binary one."""
    return data[:8] + struct.pack("<I", len(data) + len(behind)) + data[12:] + behind


class Watched:
    """Bytes that remember which of them were read."""

    def __init__(self, data: bytes) -> None:
        self.held, self.size = HeldBytes(data), len(data)
        self.seen = np.zeros(len(data), bool)

    def read(self, first: int, last: int) -> memoryview:
        self.seen[first:last] = True
        return self.held.read(first, last)


@pytest.mark.parametrize("kind", ["plain", "packed"])
def test_no_more_is_read_than_is_wanted(files, kind):
    data = longer(files[kind])
    source = Watched(data)
    glb = parse_glb(source)
    assert not source.seen[max(glb.binary.first, HEAD_BYTES) : glb.binary.last].any()
    expected = read_scene(files[kind])
    found = read_scene(source)
    np.testing.assert_array_equal(found.appearance.planes[0].mean, expected.appearance.planes[0].mean)
    heads = [len(files[kind]) + place for place in (*range(8), *range(8 + len(GROUPS), 16 + len(GROUPS)))]
    assert np.flatnonzero(source.seen[len(files[kind]) :]).tolist() == [head - len(files[kind]) for head in heads]


def test_a_chunk_is_read_by_range(files, tmp_path):
    path = tmp_path / "a.glb"
    path.write_bytes(longer(files["plain"]))
    with open_source(path) as source:
        groups = parse_glb(source).chunks[b"EFTL"]
        assert groups.size == len(GROUPS) and bytes(groups.read(300, 310)) == GROUPS[300:310]
        assert bytes(groups.read(len(GROUPS) - 2, len(GROUPS) + 50)) == GROUPS[-2:]
        assert b"".join(groups.pieces()) == GROUPS


@pytest.mark.parametrize("kind", ["plain", "packed"])
def test_what_follows_the_binary_chunk_is_kept(files, kind, tmp_path):
    path = tmp_path / "a.glb"
    behind = BEHIND + struct.pack("<I4s", PIECE_BYTES + 8, b"LONG") + bytes(PIECE_BYTES + 8)
    path.write_bytes(longer(files[kind], behind))
    store_scores(path, {"psnr": 30.5})
    made = path.read_bytes()
    assert made.endswith(behind) and load(path).scores == {"psnr": 30.5} and validate(path) == []
    store_scores(path, read_scene(files[kind]).scores)
    assert path.read_bytes() == longer(files[kind], behind)


@pytest.mark.parametrize("kind", ["plain", "packed"])
def test_it_is_kept_without_a_residual(files, kind):
    scene = read_scene(files[kind])
    residual = Residual(b"no video", (64, 64), np.arange(len(scene.rig.encoded)), (0.01, 0.02))
    with_one = encode_scene(replace(scene, residual=residual))
    bare = without_residual(longer(with_one))
    assert bare == longer(without_residual(with_one)) and b"no video" not in bare


def test_a_file_without_a_binary_chunk_has_nothing_behind_its_json():
    text = b'{"a":1} '
    data = struct.pack("<4sII", b"glTF", 2, 20 + len(text)) + struct.pack("<I4s", len(text), b"JSON") + text
    glb = parse_glb(data)
    assert glb.json == {"a": 1} and glb.binary.size == glb.behind(JSON_CHUNK).size == 0
    assert BINARY_CHUNK not in glb.chunks


def test_a_file_that_becomes_shorter_is_refused(tmp_path):
    path = tmp_path / "a.bin"
    path.write_bytes(b"12345678")
    with open_source(path) as source:
        assert bytes(source.read(2, 5)) == b"345" and bytes(source.read(6, 20)) == b"78" and not source.read(9, 12)
    path.write_bytes(b"1234")
    with path.open("rb") as file, pytest.raises(FormatError, match="ends after 4 of 8 bytes") as caught:
        OpenFile(file, 8).read(2, 6)
    assert caught.value.code == "truncated"
