"""`validate` and `info` on files good and bad, and the codes that the documentation lists."""

from __future__ import annotations

import json
import re
import struct
from pathlib import Path

import numpy as np
import pytest

from eigenfield import gltf as scene_format
from eigenfield.coding import limits
from eigenfield.core.errors import FormatError
from eigenfield.gltf.container import parse_glb
from support import glb_surgery
from support.glb_surgery import DOCUMENT, attribute, chunk, numbers, ours, setting, weights, without


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
    rooms = Path(scene_format.__file__).parent, Path(limits.__file__).parent
    source = "\n".join(path.read_text(encoding="utf-8") for room in rooms for path in room.rglob("*.py"))
    codes = set(re.findall(r'(?:FormatError\(|\.fail\(|note\("\w+",)\s*"([a-z-]+)"', source))
    codes |= {"camera-intrinsics", "camera-poses", "camera-sizes"}
    assert len(codes) > 35
    assert {code for code in codes if f"`{code}`" not in text} == set()


def test_every_limit_is_in_the_documentation():
    text = DOCUMENT.read_text(encoding="utf-8")
    found = {name: value for name, value in vars(limits).items() if name.startswith("MAX_")}
    assert "MAX_CAMERA_SIDE" in found
    for name, value in found.items():
        assert f"`{name}` | {value} |" in text, name


def test_unknown_chunks_are_skipped(good):
    data = good["png"]
    longer = data[:8] + struct.pack("<I", len(data) + 12) + data[12:] + chunk(b"ODD\0", b"abcd")
    assert parse_glb(longer).binary.data == parse_glb(data).binary.data


def test_validate_on_the_command_line(tmp_path, good, run):
    fine, bad = tmp_path / "fine.glb", tmp_path / "with space.glb"
    fine.write_bytes(good["png"])
    bad.write_bytes(good["png"][:-5])
    assert run("validate", fine) == (0, f"{fine}: no findings\n", "")
    code, out, _ = run("validate", fine, bad, tmp_path / "none.glb")
    assert code == 2
    assert f"{bad}: error truncated at byte {len(good['png']) - 5}: ends after" in out
    assert "file-missing" in out
    code, out, _ = run("validate", "--json", fine, bad)
    assert code == 2
    first, second = json.loads(out)
    assert first == {"file": str(fine), "findings": []}
    assert [finding["code"] for finding in second["findings"]] == ["truncated"]
    assert run("validate", "--quiet", fine) == (0, "", "")


def test_info_on_the_command_line(tmp_path, good, run):
    path = tmp_path / "scene.glb"
    path.write_bytes(good["avif"])
    text = run("info", path).out
    for expected in ("eigen textures: 3 of 32x32; image/avif", "5 encoded, 1 held out", "view_01", "Y up",
                     "texture maps  psnr 30.5", "36 vertices, 50 triangles", "6 of 48x40", "bytes         mean ",
                     "eigenfield test", "density"):  # fmt: skip
        assert expected in text, expected
    facts = json.loads(run("info", "--json", path).out)
    assert facts["bytes"]["total"] == len(good["avif"])
    assert facts["cameras"]["held_out"] == ["view_01"]
    assert facts["planes"][0]["bases"][0]["textures"] == 3
    assert facts["view_plane"]["width"] == 1.0 and facts["view_plane"]["height"] == 0.5
    assert facts["scores"] == {"uv": {"psnr": 30.5}}


def test_info_refuses_what_load_refuses(tmp_path, good, run):
    path = tmp_path / "scene.glb"
    path.write_bytes(good["png"][:1000])
    with pytest.raises(FormatError) as caught:
        run("info", path, "--traceback")
    assert caught.value.code == "truncated"


def test_info_shows_nothing_raw_from_the_file(tmp_path, good, run):
    path = tmp_path / "scene.glb"
    evil = "\x1b[2J\n"
    path.write_bytes(glb_surgery.changed(good["png"], lambda g, e, b: e.update(
        generator=evil, settings={evil: evil}, scores={"a": {evil: [evil]}}, **{evil: 1})))  # fmt: skip
    for verb in ("info", "validate"):
        code, out, err = run(verb, path)
        assert code == 0 and out and "\x1b" not in out + err
