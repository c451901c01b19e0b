"""Streams that name their codec: read as those that do not, refused where it is unknown; and a codec that is new."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from jsonschema import Draft202012Validator

from eigenfield.coding.codecs import CODECS, Codec
from eigenfield.core.errors import FormatError
from eigenfield.core.payloads import Payload, weights_key
from eigenfield.gltf import encode_scene, parts, read_scene, streams, validate
from eigenfield.gltf.streams import PLACES
from eigenfield.gltf.strict_json import Value
from support import glb_surgery, schema
from support.coded_scenes import coded, precise_scene
from support.glb_surgery import EXTENSION
from support.soft_scenes import soft_scene


@pytest.fixture(scope="module")
def data():
    """A file with a stream at every place but the residual's, names with measured positions among them."""
    plain = soft_scene()
    places = np.random.default_rng(4).normal(size=(9, 2, 24)).round(6)
    names = tuple("_".join(f"{x:.6f}" for x in place.ravel()) for place in places)
    colours = np.tile(np.float32([[1.25], [0.125]]), (9, 1, 3))
    appearance = replace(plain.appearance, colours=colours)
    full = replace(plain, rig=replace(plain.rig, names=names), appearance=appearance)
    return encode_scene(coded(full, np.arange(9).reshape(3, 3)))


def entries(extension, path):
    """Every stream at a path, with what holds it and its key."""
    *above, last = path.split("/")
    holders = [extension]
    for key in above:
        holders = [
            one for holder in holders for one in (holder if key == "*" else [holder[key]] if key in holder else [])
        ]
    return [
        (holder, key)
        for holder in holders
        for key in (range(len(holder)) if last == "*" else [last])
        if last == "*" or last in holder
    ]


def naming(place, codec=None):
    """Name a codec, that which it has if None, in every stream of a place."""

    def change(gltf, extension, binary):
        found = entries(extension, PLACES[place].path)
        assert found
        for holder, key in found:
            entry = holder[key]
            entry = {"bufferView": entry} if isinstance(entry, int) else entry
            usual = PLACES[place].codec or {8: entry.get("mimeType", "image/png").removeprefix("image/")}.get(
                entry.get("bits", 8), "av1-10bit-2"
            )
            holder[key] = {**entry, "codec": entry.get("codec", usual) if codec is None else codec}

    return change


CODED = sorted(PLACES.keys() - {"precision", "residual"})


@pytest.mark.parametrize("place", CODED)
def test_a_stream_may_name_the_codec_that_it_has(data, place, tmp_path):
    path = tmp_path / "scene.glb"
    path.write_bytes(glb_surgery.changed(data, naming(place)))
    assert [found for found in validate(path) if found.code != "view-unused"] == []
    assert encode_scene(read_scene(path.read_bytes())) == data  # which says what is needed and no more


@pytest.mark.parametrize("place", CODED)
@pytest.mark.parametrize("codec", ["brotli-9", "of another kind"])
def test_an_unknown_codec_is_refused_by_name(data, place, codec, tmp_path):
    name = codec if codec == "brotli-9" else "png" if PLACES[place].kind != "picture" else "weights-1"
    path = tmp_path / "scene.glb"
    assert glb_surgery.outcome(path, glb_surgery.changed(data, naming(place, name))) == "codec-unknown"
    with pytest.raises(FormatError, match=f'"{name}"') as caught:
        read_scene(glb_surgery.changed(data, naming(place, name)))
    assert caught.value.where.endswith("/codec") and caught.value.remedy


def test_the_codec_of_a_picture_is_one_of_its_type(data, tmp_path):
    precise = encode_scene(precise_scene())
    assert encode_scene(read_scene(glb_surgery.changed(precise, naming("precision")))) == precise
    for given, place, codec, code in (
        (precise, "precision", "webp", "codec-unknown"),
        (data, "mean", "avif", "picture-type"),
        (data, "textures", "png", "picture-type"),
    ):
        assert glb_surgery.outcome(tmp_path / "a.glb", glb_surgery.changed(given, naming(place, codec))) == code


def raw_weights(data, where):
    """Ne, N, and the numbers as they are."""
    count = int.from_bytes(data[:4], "little")
    return np.frombuffer(data, "<f4", offset=4).reshape(-1, count)


def test_a_new_codec_is_an_entry_in_the_table(data, tmp_path, monkeypatch):
    """It is named in the file, with a need of its own, counted, read and written again; readers before refuse it."""
    scene, path = read_scene(data), tmp_path / "scene.glb"
    scene = replace(scene, appearance=replace(scene.appearance, colours=None))  # which are coded as weights are
    weights = scene.appearance.planes[0].bases[0].weights
    stream = weights.shape[1].to_bytes(4, "little") + weights.astype("<f4").tobytes()
    changed = replace(scene, payloads=scene.payloads | {weights_key(weights): [Payload("weights-raw", stream)]})
    with monkeypatch.context() as patch:
        raw = Codec("weights", None, raw_weights, "weights-raw", "1.9", ("MAX_WEIGHTS",))
        patch.setitem(CODECS, "weights-raw", raw)
        patch.setitem(streams.FEATURES, "weights-raw", "1.9")
        patch.setattr(schema, "VALIDATOR", Draft202012Validator({}))  # which does not know it
        path.write_bytes(encode_scene(changed))
        extension = glb_surgery.split(path.read_bytes())[0]["extensions"][EXTENSION]
        assert extension["planes"][0]["bases"][0]["codedWeights"]["codec"] == "weights-raw"
        assert extension["version"] == "1.9" and "codedWeights" not in extension["needs"]
        assert "weights-raw" in extension["needs"]
        assert validate(path) == [] and parts(path)["weights"] == len(stream)
        back = read_scene(path.read_bytes())
        np.testing.assert_array_equal(back.appearance.planes[0].bases[0].weights, weights)
        assert encode_scene(back) == path.read_bytes()
    with pytest.raises(FormatError, match="weights-raw") as caught:
        read_scene(path.read_bytes())
    assert caught.value.code == "needs"


def test_keys_of_unknown_or_damaged_parts_are_no_streams():
    extension = {
        "mesh": {"bufferView": 7}, "planes": "none", "cameras": {"coded": 3}, "viewPlane": {"codedTriangles": {"a": 2}},
        "residual": {"size": [1, 2]}, "later": {"coded": 5},
    }  # fmt: skip
    found = [(place.kind, reference.value) for place, reference in streams.streams(Value(extension, ""))]
    assert found == [("mesh", 7), ("cameras", 3)]
