"""The JSON Schema of the extension: files of every kind keep to it, wrong values do not, and documents and code agree.

`tests/conftest.py` holds every file that any test writes to it."""

from __future__ import annotations

import copy
import re
from dataclasses import replace

import numpy as np
import pytest
from jsonschema import Draft202012Validator

from eigenfield.coding import limits
from eigenfield.coding.codecs import CODECS
from eigenfield.core.scene import Residual
from eigenfield.gltf import clip_in_files, encode_scene, layout, load
from eigenfield.gltf.fallback import with_fallback
from eigenfield.gltf.streams import FEATURES, OTHER_FEATURES
from support import schema
from support.clips import moving_clip, numbered_clip, read_all
from support.coded_scenes import coded_scene, precise_scene
from support.glb_surgery import DOCUMENT, changed, ours, outcome
from support.scenes import tiny_scene
from support.schema import SCHEMA, extension_of, violation
from support.soft_scenes import soft_scene

DEFINITIONS = SCHEMA["$defs"]
BASIS = ("planes", 0, "bases", 0)
TEXTURE = (*BASIS, "textures", 0)
MISSING = object()


@pytest.fixture(scope="module")
def files(good):
    """A file of each kind: plain ones of each codec, coded, with regions and a precision, with a residual."""
    made = dict(good)
    coded = coded_scene()
    video = Residual(
        b"video", (240, 320), np.arange(25)[::-1].copy(), (0.01, 0.02), full_chroma=True, smooth_edges=True
    )
    made["coded"] = encode_scene(coded)
    made["bare"] = encode_scene(with_fallback(coded, "none"))
    made["sheets"] = encode_scene(soft_scene(), codec="webp")
    made |= {name: encode_scene(coded_scene(name)) for name, codec in CODECS.items() if codec.kind == "weights"}
    made["precise"] = encode_scene(precise_scene())
    made["residual"] = encode_scene(replace(coded, residual=video))
    for kind, sheets in (("clip", False), ("sheets-clip", True)):
        made[kind] = encode_scene(moving_clip(numbered_clip(sheets=sheets), lambda number, places: places + number))
    made["files-clip"] = b"".join(clip_in_files(numbered_clip()).scene)
    return made


def test_the_schema_is_one():
    Draft202012Validator.check_schema(SCHEMA)
    assert SCHEMA["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert schema.PATH.name in DOCUMENT.read_text(encoding="utf-8")


def test_files_of_every_kind_keep_to_it(files):
    needed = {need for data in files.values() for need in extension_of(data)["needs"]}
    before = {"bits", "codedCameras", "codedMesh"}  # 1.8
    assert needed >= FEATURES.keys() - before - {"codedNames", "packed"}
    for kind, data in files.items():
        assert violation(extension_of(data)) is None, kind


def test_what_a_test_writes_is_held_to_it(monkeypatch):
    monkeypatch.setattr(schema, "VALIDATOR", Draft202012Validator({"required": ["nothing has this"]}))
    with pytest.raises(AssertionError, match="nothing has this"):
        encode_scene(tiny_scene())


def test_unknown_keys_are_allowed_everywhere(files):
    def grown(value):
        if isinstance(value, dict):
            return {key: grown(entry) for key, entry in value.items()} | {"later": [1]}
        return [grown(entry) for entry in value] if isinstance(value, list) else value

    assert "coded" in files
    for kind, data in files.items():
        assert violation(grown(extension_of(data))) is None, kind


def test_a_stream_may_name_its_codec(files):
    extension = extension_of(files["residual"])
    plane, cameras, view = extension["planes"][0], extension["cameras"], extension["viewPlane"]
    extension["residual"]["codec"] = "video-1"
    assert extension["mesh"]["codec"] == "mesh-2"
    assert cameras["coded"]["codec"] == "cameras-2"
    view["codedTriangles"] = {"bufferView": view["codedTriangles"], "codec": "triangles-1"}
    (basis,) = plane["bases"]
    basis["codedWeights"] = {"bufferView": basis["codedWeights"]}
    plane["mean"]["codec"] = basis["textures"][0]["codec"] = "av1-10bit-2"
    assert violation(extension) is None
    basis["codedWeights"]["codec"] = "mesh-1"
    assert "weights-1" in violation(extension)


# kind of file, where in the extension, what stands there instead; each is refused by the reader too
WRONG = [
    ("png", (), []),
    ("png", ("version",), MISSING),
    ("png", ("version",), "2.0"),
    ("png", ("version",), 1.0),
    ("png", ("needs",), ["charts"]),
    ("png", ("needs",), "toRGB"),
    ("png", ("planes",), []),
    ("png", ("planes",), MISSING),
    ("png", ("planes", 0, "channels"), 0),
    ("png", ("planes", 0, "channels"), 65),
    ("png", ("planes", 0, "channels"), 2),  # without a mean of its own
    ("webp", ("planes", 0, "mean", "size"), MISSING),
    ("webp", ("planes", 0, "mean", "size"), [32]),
    ("webp", ("planes", 0, "mean", "scale"), [1, 1, 1]),  # without zero
    ("webp", ("planes", 0, "mean", "bits"), 10),
    ("webp", ("planes", 0, "mean", "precision"), {"bufferView": 0, "size": [1, 1]}),
    ("precise", ("planes", 1, "mean"), MISSING),
    ("precise", ("planes", 0, "mean", "mimeType"), "image/webp"),
    ("precise", ("planes", 0, "mean", "zero"), MISSING),
    ("precise", ("planes", 0, "mean", "precision", "size"), [1025, 3]),
    ("precise", ("planes", 0, "mean", "precision", "bufferView"), MISSING),
    ("precise", ("toRGB",), [1, 0]),
    ("precise", ("toRGB", 0), 1e4),
    ("precise", ("planes", 0, "bases", 0, "corner"), [-1, 0]),
    ("precise", ("planes", 0, "bases", 0, "grid"), [0, 128]),
    ("sheets", ("sheets",), []),
    ("sheets", ("sheets", "faces"), MISSING),
    ("sheets", ("sheets", "faces"), []),
    ("sheets", ("sheets", "faces"), [1] * 33),
    ("sheets", ("sheets", "faces", 1), 0),
    ("sheets", ("sheets", "opacity"), MISSING),
    ("sheets", ("sheets", "opacity", "bufferView"), MISSING),
    ("sheets", ("sheets", "opacity", "size"), MISSING),
    ("sheets", ("sheets", "opacity", "mimeType"), MISSING),
    ("sheets", ("sheets", "opacity", "bits"), 10),
    ("png", ("planes", 0, "bases"), MISSING),
    ("png", (*BASIS, "size"), [0, 32]),
    ("png", (*BASIS, "size"), [32, 32, 3]),
    ("png", (*BASIS, "textures"), MISSING),
    ("png", (*BASIS, "weights"), MISSING),
    ("png", (*BASIS, "weights"), "5"),
    ("png", (*BASIS, "picture"), 3),
    ("png", TEXTURE, "picture"),
    ("png", (*TEXTURE, "bufferView"), -1),
    ("png", (*TEXTURE, "bufferView"), MISSING),
    ("png", (*TEXTURE, "mimeType"), MISSING),
    ("png", (*TEXTURE, "mimeType"), "image/tiff"),
    ("png", (*TEXTURE, "bits"), 9),
    ("png", (*TEXTURE, "bits"), 10),
    ("png", (*TEXTURE, "count"), 0),
    ("png", (*TEXTURE, "scale"), MISSING),
    ("png", (*TEXTURE, "scale"), []),
    ("png", (*TEXTURE, "scale"), [1, 1, 1e31]),
    ("png", (*TEXTURE, "zero"), [1, 1, "1"]),
    ("coded", ("mesh",), 3),
    ("coded", ("mesh", "bufferView"), MISSING),
    ("coded", (*BASIS, "codedWeights"), [3]),
    ("coded", (*BASIS, "codedWeights"), 1.5),
    ("coded", ("cameras", "coded"), "cameras"),
    ("coded", ("cameras", "size"), [0, 240]),
    ("coded", ("cameras", "size"), [65536, 240]),
    ("coded", ("cameras", "size"), MISSING),
    ("coded", ("cameras", "pattern", "counts"), [5]),
    ("coded", ("cameras", "pattern", "parts"), []),
    ("coded", ("cameras", "pattern", "parts", 0), 5),
    ("coded", ("cameras", "pattern", "parts", 1, "axis"), 2),
    ("coded", ("cameras", "pattern", "parts", 1, "digits"), 10),
    ("coded", ("cameras", "pattern", "parts", 1, "step"), MISSING),
    ("coded", ("cameras", "codedNames"), {"bufferView": 0}),
    ("coded", ("viewPlane", "codedTriangles"), None),
    ("png", ("cameras",), MISSING),
    ("png", ("cameras", "names"), []),
    ("png", ("cameras", "names"), MISSING),
    ("png", ("cameras", "names", 1), "view_00"),
    ("png", ("cameras", "names", 1), "x" * 1025),
    ("png", ("cameras", "heldOut"), [1, 1]),
    ("png", ("cameras", "heldOut"), [-1]),
    ("png", ("cameras", "poses"), MISSING),
    ("png", ("cameras", "sizes"), MISSING),
    ("png", ("cameras", "colour"), "grey"),
    ("png", ("viewPlane",), MISSING),
    ("png", ("viewPlane", "origin"), [0, 0]),
    ("png", ("viewPlane", "right"), MISSING),
    ("png", ("viewPlane", "up"), [1e31, 0, 0]),
    ("png", ("viewPlane", "extent"), [-1, 1]),
    ("png", ("viewPlane", "triangles"), {}),
    ("png", ("reference",), MISSING),
    ("png", ("reference",), -1),
    ("png", ("reference",), 0.5),
    ("png", ("settings",), []),
    ("png", ("scores",), 3),
    ("png", ("generator",), 7),
    ("residual", ("residual",), "video"),
    ("residual", ("residual", "bufferView"), MISSING),
    ("residual", ("residual", "size"), [321, 240]),
    ("residual", ("residual", "size"), [62, 62]),
    ("residual", ("residual", "scale"), [0, 0.1]),
    ("residual", ("residual", "scale"), [0.1, 2]),
    ("residual", ("residual", "scale"), [0.1]),
    ("residual", ("residual", "full"), 1),
    ("residual", ("residual", "smooth"), "yes"),
    ("residual", ("residual", "order"), [0, 1]),
    ("clip", ("timeline",), []),
    ("clip", ("timeline", "rate"), [30]),
    ("clip", ("timeline", "rate"), [0, 1]),
    ("clip", ("timeline", "rate"), [2**31, 1]),
    ("clip", ("timeline", "first"), 1e10),
    ("clip", ("timeline", "frames"), 0),
    ("clip", ("timeline", "frames"), 2**20 + 1),
    ("clip", ("timeline", "films"), []),
    ("clip", ("timeline", "films", 0, "codec"), MISSING),
    ("clip", ("timeline", "films", 0, "codec"), "video-1"),
    ("clip", ("timeline", "films", 0, "size"), [192, 100]),
    ("clip", ("timeline", "films", 1, "size"), [8256, 64]),
    ("clip", ("timeline", "groups"), []),
    ("clip", ("timeline", "groups", 0, "frames"), 1025),
    ("clip", ("timeline", "groups", 0, "offset"), 2),
    ("clip", ("timeline", "groups", 0, "offset"), MISSING),
    ("clip", ("timeline", "groupFiles"), False),
    ("clip", ("timeline", "groups", 1, "length"), 0),
    ("clip", ("timeline", "groups", 1, "sha256"), "00"),
    ("clip", ("timeline", "groups", 1, "sha256"), MISSING),
    ("clip", ("planes", 0, "mean"), MISSING),
    ("clip", ("planes", 0, "mean", "film"), MISSING),
    ("clip", ("planes", 0, "mean", "film"), 4),
    ("clip", ("planes", 0, "mean", "at"), []),
    ("clip", ("planes", 0, "mean", "at"), [[8, 0]]),
    ("clip", (*BASIS, "at"), MISSING),
    ("clip", (*BASIS, "size"), MISSING),
    ("sheets-clip", ("sheets", "faces"), MISSING),
    ("sheets-clip", ("sheets", "opacity", "film"), MISSING),
    ("sheets-clip", ("sheets", "opacity", "film"), 4),
    ("sheets-clip", ("sheets", "opacity", "at"), MISSING),
    ("sheets-clip", ("sheets", "opacity", "at"), []),
    ("sheets-clip", ("sheets", "opacity", "at"), [[0, 0], [0, 0]]),
    ("sheets-clip", ("sheets", "opacity", "at"), [[0, 8]]),
    ("sheets-clip", ("sheets", "opacity", "size"), MISSING),
]
READ = {"clip": read_all, "sheets-clip": read_all}  # of the others it is `load`


@pytest.mark.parametrize(("kind", "keys", "value"), WRONG)
def test_wrong_values_are_refused(tmp_path, files, kind, keys, value):
    def change(gltf, extension, binary):
        if value is not MISSING:
            return ours(*keys, value=value)(gltf, extension, binary)
        for key in keys[:-1]:
            extension = extension[key]
        del extension[keys[-1]]

    data = changed(files[kind], change)
    assert violation(extension_of(data)) is not None
    assert outcome(tmp_path / "a.glb", data, READ.get(kind, load)) is not None


def test_what_excludes_each_other_is_refused(files):
    """The reader takes one of the two; nothing writes both."""
    both = {
        ("cameras", "names"): ["a", "b"],
        ("cameras", "sizes"): 0,
        ("cameras", "poses"): 0,
        ("viewPlane", "triangles"): 0,
        (*BASIS, "weights"): 0,
    }
    for keys, value in both.items():
        extension = copy.deepcopy(extension_of(files["coded"]))
        place = extension
        for key in keys[:-1]:
            place = place[key]
        place[keys[-1]] = value
        if keys[-1] == "poses":
            place["intrinsics"] = 0
        assert violation(extension) is not None, keys


def test_limits_are_those_of_the_code():
    properties = SCHEMA["properties"]
    plane, basis, cameras = (DEFINITIONS[name]["properties"] for name in ("plane", "basis", "cameras"))
    channels = limits.MAX_PLANES * limits.MAX_CHANNELS
    found = {
        "MAX_VIEWS": properties["needs"]["maxItems"],
        "MAX_SHEETS": DEFINITIONS["sheets"]["properties"]["faces"]["maxItems"],
        "MAX_TRIANGLES": DEFINITIONS["sheets"]["properties"]["faces"]["items"]["maximum"],
        "MAX_PLANES": properties["planes"]["maxItems"],
        "MAX_CHANNELS": plane["channels"]["maximum"],
        "MAX_BASES": plane["bases"]["maxItems"],
        "MAX_COMPONENTS": basis["textures"]["maxItems"],
        "MAX_SIDE": DEFINITIONS["size"]["items"]["maximum"],
        "MAX_PRECISION_SIDE": DEFINITIONS["precision"]["properties"]["size"]["items"]["maximum"],
        "MAX_CAMERAS": cameras["names"]["maxItems"],
        "MAX_CAMERA_SIDE": cameras["size"]["items"]["maximum"],
        "MAX_NAME": DEFINITIONS["text"]["maxLength"],
        "MAX_GAIN": properties["toRGB"]["items"]["maximum"],
        "MAX_NUMBER": DEFINITIONS["number"]["maximum"],
        "MAX_GROUPS": DEFINITIONS["timeline"]["properties"]["groups"]["maxItems"],
        "MAX_FRAMES": DEFINITIONS["timeline"]["properties"]["frames"]["maximum"],
        "MAX_FILMS": DEFINITIONS["timeline"]["properties"]["films"]["maxItems"],
        "MAX_RATE_TERM": DEFINITIONS["timeline"]["properties"]["rate"]["items"]["maximum"],
        "MAX_TIME": DEFINITIONS["timeline"]["properties"]["first"]["maximum"],
        "MAX_GROUP_FRAMES": DEFINITIONS["group"]["properties"]["frames"]["maximum"],
        "MAX_FILE": DEFINITIONS["group"]["properties"]["offset"]["maximum"],
        "MAX_GROUP": DEFINITIONS["group"]["properties"]["length"]["maximum"],
        "MAX_FILM_SIDE": DEFINITIONS["film"]["properties"]["size"]["items"]["maximum"],
    }
    assert found == {name: getattr(limits, name) for name in found}
    assert DEFINITIONS["bufferView"]["maximum"] == DEFINITIONS["accessor"]["maximum"] == limits.MAX_VIEWS - 1
    assert properties["reference"]["maximum"] == cameras["heldOut"]["maxItems"] == limits.MAX_CAMERAS - 1
    assert properties["toRGB"]["maxItems"] == 3 * channels
    assert DEFINITIONS["numbers"]["maxItems"] == limits.MAX_CHANNELS * limits.MAX_COMPONENTS


def test_features_and_keys_are_those_of_the_code():
    assert set(DEFINITIONS["feature"]["enum"]) == FEATURES.keys()
    assert set(SCHEMA["properties"]) == layout._KEYS


def tables(what: str) -> dict[str, set[str]]:
    """What the tables of docs/format.md that list each `what` name, by their heading."""
    found: dict[str, set[str]] = {}
    heading = ""
    listed = False
    for line in DOCUMENT.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            heading = line.lstrip("# ")
        if not line.startswith("|"):
            listed = False
        elif line.startswith(f"| {what} |"):
            listed = True
        elif listed and not line.startswith("|---"):
            found.setdefault(heading, set()).update(re.findall(r"`([\w-]+)`", line.split("|")[1]))
    return found


def keys_of(name: str) -> set[str]:
    return set(DEFINITIONS[name]["properties"])


def test_the_document_names_the_same_keys():
    stream, in_film = {"codec"}, {"film", "at"}  # said once, of all streams; of all textures of a clip
    assert tables("key") == {
        "The root extension": set(SCHEMA["properties"]),
        "packed": {"packed"},
        "stream": keys_of("codedMesh"),
        "sheets": keys_of("sheets"),
        "plane": keys_of("plane"),
        "basis": keys_of("basis") - in_film,
        "picture": (keys_of("mean") | keys_of("texture")) - stream - in_film,
        "cameras": keys_of("cameras"),
        "pattern": keys_of("pattern"),
        "view plane": keys_of("viewPlane"),
        "residual": keys_of("residual") - stream,
        "timeline": keys_of("timeline"),
        "film": keys_of("film"),
        "textures in films": in_film,
        "audio": keys_of("audio"),
        "group": keys_of("group"),
    }
    assert tables("field") == {"the bytes of a group": keys_of("groupHead")}
    text = DOCUMENT.read_text(encoding="utf-8")
    inner = [keys_of(name) for name in ("precision", "opacity", "patternPart", "codedNames", "affine")]
    assert {key for keys in inner for key in keys if f"`{key}`" not in text and f'"{key}"' not in text} == set()


def test_the_document_names_the_same_features():
    """Beside those of codecs, which docs/coding.md lists: see tests/coding/test_codecs.py."""
    assert tables("feature") == {"The root extension": set(OTHER_FEATURES)}
    assert set(DEFINITIONS["feature"]["enum"]) - set(OTHER_FEATURES) == {codec.needs for codec in CODECS.values()} - {
        None
    }
