"""Title, author, licence and source: kept by every file that a scene or a clip becomes, and never markup or a flood."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

import eigenfield as ef
from eigenfield.coding import limits
from eigenfield.core.errors import OptionError
from eigenfield.core.rights import Rights
from eigenfield.gltf import load, load_any, load_clip, outline, save, store_scores, validate, without_residual
from eigenfield.gltf.container import parse_glb
from eigenfield.gltf.rights import XMP
from eigenfield.viewer.exports import export
from support import glb_surgery
from support.clips import numbered_clip
from support.coded_scenes import fitted_scene
from support.glb_surgery import setting, without
from support.scenes import tiny_scene

SAID = Rights(
    title="A <b>stone</b>", author="Ada & Söhne", licence="CC BY 4.0", source="https://example.org/stone?a=1&b=2"
)
PACKET = {
    "@context": {"dc": "http://purl.org/dc/elements/1.1/", "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#"},
    "dc:title": {"@type": "rdf:Alt", "rdf:_1": {"@language": "x-default", "@value": SAID.title}},
    "dc:creator": {"@list": [SAID.author]},
    "dc:rights": {"@type": "rdf:Alt", "rdf:_1": {"@language": "x-default", "@value": SAID.licence}},
    "dc:source": SAID.source,
}


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "scene.glb"
    save(replace(tiny_scene(), rights=SAID), path, codec="png")
    return path


def root_of(path):
    return parse_glb(path.read_bytes()).json


def test_the_file_says_it_where_other_programs_look(file):
    root = root_of(file)
    assert root["asset"]["copyright"] == "Ada & Söhne, CC BY 4.0"
    assert root["asset"]["extensions"] == {XMP: {"packet": 0}}
    assert root["extensions"][XMP] == {"packets": [PACKET]} and XMP in root["extensionsUsed"]
    assert load(file).rights == SAID and validate(file) == []


def test_a_scene_without_rights_is_written_as_before(tmp_path):
    save(tiny_scene(), tmp_path / "a.glb", codec="png")
    root = root_of(tmp_path / "a.glb")
    assert set(root["asset"]) == {"version", "generator"} and set(root["extensions"]) == {limits.EXTENSION}
    assert load(tmp_path / "a.glb").rights == Rights()


@pytest.mark.parametrize("name", ["title", "author", "licence", "source"])
def test_one_alone(tmp_path, name):
    said = Rights(**{name: "x"})
    save(replace(tiny_scene(), rights=said), tmp_path / "a.glb", codec="png")
    assert load(tmp_path / "a.glb").rights == said
    assert ("copyright" in root_of(tmp_path / "a.glb")["asset"]) == (name in ("author", "licence"))


def test_every_edit_keeps_it(file, tmp_path):
    scene = load(file)
    save(scene, tmp_path / "again.glb")
    assert load(tmp_path / "again.glb").rights == SAID
    ef.load(file).save(tmp_path / "method.glb")
    assert load(tmp_path / "method.glb").rights == SAID
    store_scores(file, {"psnr": 1})
    assert load(file).rights == SAID
    (tmp_path / "bare.glb").write_bytes(without_residual(file.read_bytes()))
    assert load(tmp_path / "bare.glb").rights == SAID
    assert outline(file)[0].rights == SAID


@pytest.mark.slow
def test_a_packed_file_keeps_it(tmp_path):
    save(replace(fitted_scene(), rights=SAID), tmp_path / "a.glb")
    assert "packed" in root_of(tmp_path / "a.glb")["extensions"][limits.EXTENSION]
    assert load(tmp_path / "a.glb").rights == SAID
    store_scores(tmp_path / "a.glb", {"psnr": 1})
    assert load(tmp_path / "a.glb").rights == SAID and validate(tmp_path / "a.glb") == []


def test_clips_keep_it_as_a_file_and_as_a_folder(tmp_path):
    save(replace(numbered_clip((2, 1)), rights=SAID), tmp_path / "clip.glb")
    assert load_clip(tmp_path / "clip.glb").rights == SAID == load(tmp_path / "clip.glb", 0.1).rights
    export(tmp_path / "clip.glb", tmp_path / "clip", "folder")
    assert load_any(tmp_path / "clip").rights == SAID
    export(tmp_path / "clip", tmp_path / "again.glb", "glb")
    assert (tmp_path / "again.glb").read_bytes() == (tmp_path / "clip.glb").read_bytes()
    save(load_clip(tmp_path / "clip"), tmp_path / "saved.glb")
    assert load_clip(tmp_path / "saved.glb").rights == SAID and validate(tmp_path / "saved.glb") == []


def test_the_plain_glb_keeps_it(file, tmp_path):
    export(file, tmp_path / "plain.glb", "glb")
    root = root_of(tmp_path / "plain.glb")
    assert root["asset"]["copyright"] == SAID.copyright and root["extensions"][XMP] == {"packets": [PACKET]}


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        ("x" * 1_000_000, "1,000,000 characters"), ("two\nlines", "U+000A"), ("\x1b[31mred", "U+001B"),
        ("\0", "U+0000"),
        ("\ud800", "U+D800"), ("\u202egnp", "U+202E"), ("\u2028", "U+2028"), ("\x85", "U+0085"),
    ],
)  # fmt: skip
def test_what_is_no_line_is_refused_in_one(bad, words):
    with pytest.raises(OptionError, match=words.replace("+", r"\+")) as caught:
        Rights(title=bad)
    assert caught.value.code == "rights" and "\n" not in str(caught.value) and len(str(caught.value)) < 200


def test_what_people_write_is_taken():
    for text in ("👩‍🔬 and 日本語", "می‌خواهم", "<script>alert(1)</script>", "x" * limits.MAX_RIGHTS, "a\u00a0b"):
        assert Rights(author=text).author == text


@pytest.mark.parametrize(
    "value",
    ["x" * (limits.MAX_RIGHTS + 1), "a\nb", 5, [], {}, {"@list": [1]}, {"rdf:_1": "x"}, {"rdf:_1": {"@value": 3}}, True,
     {"@set": ["a" * 600, "b" * 600]}],
)  # fmt: skip
def test_a_damaged_packet_leaves_the_scene_as_it_is(file, value):
    """A file of strangers: the text is left out, the others stay, and `validate` says so."""
    data = glb_surgery.changed(file.read_bytes(), setting("extensions", XMP, "packets", 0, "dc:creator", value=value))
    file.write_bytes(data)
    assert load(file).rights == replace(SAID, author="")
    assert [(one.severity, one.code) for one in validate(file)] == [("warning", "rights")]


@pytest.mark.parametrize(
    "change",
    [
        setting("asset", "extensions", value=3), setting("asset", "extensions", XMP, "packet", value=-1),
        setting("asset", "extensions", XMP, "packet", value=1),
        setting("asset", "extensions", XMP, "packet", value="0"),
        setting("extensions", XMP, value=[]), setting("extensions", XMP, "packets", value={}),
        setting("extensions", XMP, "packets", 0, value="x"), without("extensions", XMP),
    ],
)  # fmt: skip
def test_a_file_without_its_packet_says_nothing(file, change):
    file.write_bytes(glb_surgery.changed(file.read_bytes(), change))
    assert load(file).rights == Rights()


def test_other_programs_forms_are_read(file):
    packet = {
        "dc:title": "plain", "dc:creator": {"@set": ["A", "B"]}, "dc:source": {"@list": []},
        "dc:rights": {"@type": "rdf:Alt", "rdf:_1": {"@language": "en-us", "@value": "BSD"}, "rdf:_2": {"@value": "x"}},
    }  # fmt: skip
    change = setting("extensions", XMP, "packets", 0, value=packet)
    file.write_bytes(glb_surgery.changed(file.read_bytes(), change))
    assert load(file).rights == Rights(title="plain", author="A, B", licence="BSD")


def test_info_shows_it_in_a_line(run, file):
    facts = json.loads(run("info", file, "--json").out)
    assert facts["rights"] == {name: getattr(SAID, name) for name in ("title", "author", "licence", "source")}
    (line,) = [line for line in run("info", file).out.splitlines() if line.startswith("rights")]
    assert 'title "A <b>stone</b>"' in line and len(line) <= 120
