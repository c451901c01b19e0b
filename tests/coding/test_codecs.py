"""The table of codecs: what it names exists, and is in the documentation."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from eigenfield.coding import limits
from eigenfield.coding.arrays import cameras, triangles, weights
from eigenfield.coding.codecs import CODECS, PictureCodec
from eigenfield.coding.mesh import coder
from eigenfield.coding.stacking import PICTURES, SAVE_CODECS, codec_of
from eigenfield.core.errors import FormatError
from eigenfield.gltf.streams import FEATURES, LATEST, PLACES, minor
from support.coded_meshes import ball
from support.scenes import row_grid
from support.schema import SCHEMA

DOCUMENTS = Path(__file__).parents[2] / "docs"
VERSIONED = [  # codec, what is coded, the first byte
    ("mesh-2", ball(6, 4), coder.VERSION),
    ("cameras-1", (row_grid(4),), cameras.VERSION),
    ("cameras-2", (row_grid(4),), cameras.DEFLATED_VERSION),
    ("triangles-1", (np.array([[2, 0, 1]], np.int32),), triangles.VERSION),
    ("weights-1", (np.ones((4, 2), np.float32), 0.1), weights.VERSION),
]


def test_the_documentation_lists_what_the_table_says():
    text = (DOCUMENTS / "coding.md").read_text("utf-8")
    rows = re.findall(r"^\| `([a-z0-9-]+)` \| (\w+) \| (.*?) ?\| (1\.\d+) \| [^|]* \|$", text, re.M)
    most = {
        kind: tuple(re.findall(r"`(\w+)`", cell)) for kind, cell in re.findall(r"^\| (\w+) \| (`MAX.*) \|$", text, re.M)
    }
    listed = {name: (kind, needs.strip("` ") or None, since, most.get(kind)) for name, kind, needs, since in rows}
    assert listed == {name: (codec.kind, codec.needs, codec.since, codec.limits) for name, codec in CODECS.items()}
    assert all(isinstance(getattr(limits, name), int) for codec in CODECS.values() for name in codec.limits)
    assert max(map(minor, FEATURES.values())) <= LATEST
    format_page = (DOCUMENTS / "format.md").read_text("utf-8")
    assert f"` 1.{LATEST}\n" in format_page and f"\n- **1.{LATEST}**: " in format_page


def test_the_schema_lists_the_codecs_of_each_kind():
    listed = {}
    for name, definition in SCHEMA["$defs"].items():
        if name.endswith("Codec"):
            listed |= dict.fromkeys(definition["enum"], name.removesuffix("Codec"))
    assert listed == {name: codec.kind for name, codec in CODECS.items()}


def test_every_place_has_a_codec_of_its_kind():
    for place in PLACES.values():
        assert place.codec is None or CODECS[place.codec].kind == place.kind
        assert place.kind in {codec.kind for codec in CODECS.values()}
    for name, codec in PICTURES.items():  # a picture's type and depth say which it is
        assert isinstance(codec, PictureCodec) and codec_of(codec.mime, codec.bits) == name
    assert SAVE_CODECS == ("png", "webp", "avif") and codec_of("image/gif") is None


def test_every_versioned_codec_is_tried():
    kinds = {"mesh", "cameras", "triangles", "weights"}
    written = [name for name, codec in CODECS.items() if codec.kind in kinds and codec.encode is not None]
    assert [name for name, _, _ in VERSIONED] == written


@pytest.mark.parametrize(("codec", "given", "version"), VERSIONED)
def test_a_stream_begins_with_the_version_of_its_codec(codec, given, version):
    steps = {"intrinsic_step": 0.1, "rotation_step": 1e-3, "centre_step": 1e-3} if codec.startswith("cameras") else {}
    made = CODECS[codec].encode(*given, **steps)
    data = made if isinstance(made, bytes) else made[0]
    assert codec.endswith(f"-{version}") and data[0] == version
    assert CODECS[codec].decode(data, "here") is not None
    with pytest.raises(FormatError) as caught:
        CODECS[codec].decode(bytes([version + 1]) + data[1:], "here")
    assert caught.value.code == "coded-version" and caught.value.where == "here"
