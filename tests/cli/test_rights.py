"""Rights from photographs to pages: what is said at `encode` comes out everywhere, and nothing else of a photograph."""

from __future__ import annotations

import base64
import json
import re
from dataclasses import replace

import pytest
from PIL import Image

from eigenfield.core.rights import Rights
from eigenfield.gltf import load, save
from eigenfield.gltf.container import parse_glb
from support.captures import write_capture
from support.clips import numbered_clip
from support.scenes import tiny_scene

ARTIST, COPYRIGHT, MAKE, MODEL, GPS = 0x013B, 0x8298, 0x010F, 0x0110, 0x8825
SECRETS = "Secretmaker", "Secretmodel", "Secretplace"


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    """Photographs with an author, and a place that is nobody's business."""
    folder = write_capture(tmp_path_factory.mktemp("rights") / "capture")
    path = folder / "transforms.json"
    listed = json.loads(path.read_text(encoding="utf-8"))
    for frame in listed["frames"]:
        source = folder / frame["file_path"]
        exif = Image.Exif()
        exif[ARTIST], exif[COPYRIGHT] = "Ada O'Hara\0", "(c) Ada O'Hara"
        exif[MAKE], exif[MODEL] = SECRETS[:2]
        exif.get_ifd(GPS).update(
            {1: "N", 2: (47.0, 22.0, 11.0), 3: "E", 4: (8.0, 32.0, 9.0), 0x1B: SECRETS[2].encode()}
        )
        with Image.open(source) as picture:
            picture.convert("RGB").save(source.with_suffix(".jpg"), quality=95, exif=exif)
        source.unlink()
        frame["file_path"] = str(source.with_suffix(".jpg").relative_to(folder))
    path.write_text(json.dumps(listed), encoding="utf-8")
    return folder


def test_encode_keeps_what_is_said_and_nothing_else_of_the_photographs(run, capture, tmp_path):
    scene = tmp_path / "scene.glb"
    said = ["--title", "Two\u00a0stones", "--author", "Ada", "--licence", "CC0", "--source", "https://example.org"]
    fast = ["--proxy", capture / "proxy.ply", "--fit", "none", "-n", 2, "--atlas", 64]
    code, _, err = run("encode", capture, *fast, *said, "-o", scene)
    assert code == 0, err
    assert load(scene).rights == Rights(
        title="Two\u00a0stones", author="Ada", licence="CC0", source="https://example.org"
    )
    assert run("export", scene, "-o", tmp_path / "page.html").code == 0
    for file in tmp_path.iterdir():
        found = file.read_bytes() if file.is_file() else b""
        # what a page has as base64 is looked into, but for the viewer's script, which is packed and ours
        found = re.sub(rb'id="eigenfield-viewer">[^<]*', b"", found)
        found = re.sub(rb'(?<=id="eigenfield-scene">)[^<]*', lambda text: base64.b64decode(text[0]), found)
        assert (b"glTF" in found) == (file.suffix in (".glb", ".html")), file
        assert not [secret for secret in (*SECRETS, "Exif", "O'Hara", "GPS") if secret.encode() in found], file


def test_inspect_offers_what_the_photographs_say(run, capture):
    notes = [line for line in run("inspect", capture).out.splitlines() if "whose they are" in line]
    assert len(notes) == 1
    assert """encode --author 'Ada O'"'"'Hara' --licence '(c) Ada O'"'"'Hara'""" in notes[0]


def test_a_megabyte_of_licence_is_one_line(run, capture, tmp_path):
    code, _, err = run("encode", capture, "--licence", "x" * 100_000, "-o", tmp_path / "scene.glb")
    assert code == 2 and len(err.splitlines()) == 1 and len(err) < 200
    assert "the licence has 100,000 characters" in err and not list(tmp_path.iterdir())


def test_a_page_is_called_as_its_scene_and_offers_it(run, tmp_path):
    scene, page = tmp_path / "scene.glb", tmp_path / "page.html"
    save(replace(tiny_scene(), rights=Rights(title="</title><b>x</b>")), scene, codec="png")
    assert run("export", scene, "-o", page).code == 0
    text = page.read_text(encoding="utf-8")
    assert "<title>&lt;/title&gt;&lt;b&gt;x&lt;/b&gt;</title>" in text and '"download"' not in text
    assert run("export", scene, "-o", page, "--no-download", "--title", "Mine", "--overwrite").code == 0
    text = page.read_text(encoding="utf-8")
    assert "<title>Mine</title>" in text and '"download":false' in text
    assert run("export", scene, "-o", page, "--no-download", "--laboratory", "--overwrite").code == 0
    assert '"download":false' in page.read_text(encoding="utf-8")
    assert run("export", scene, "-o", tmp_path / "a.mp4", "--no-download").code == 2


def test_pages_hold_a_file_that_still_says_it(run, tmp_path):
    said = Rights(title="Stones", author="Ada", licence="CC0", source="https://example.org")
    scene, clip = tmp_path / "scene.glb", tmp_path / "clip.glb"
    save(replace(tiny_scene(), rights=said), scene, codec="png")
    save(replace(numbered_clip((2, 1)), rights=said), clip)
    assert run("export", scene, clip, "--as", "app", "-o", tmp_path / "open").code == 0
    assert load(tmp_path / "open/samples/scene.glb").rights == said
    assert load(tmp_path / "open/samples/clip.glb", 0.0).rights == said
    for file in (scene, clip):
        assert run("export", file, "-o", tmp_path / "page.html", "--overwrite").code == 0
        (held,) = re.findall('id="eigenfield-scene">([^<]*)<', (tmp_path / "page.html").read_text(encoding="utf-8"))
        (tmp_path / "held.glb").write_bytes(base64.b64decode(held))
        assert load(tmp_path / "held.glb", 0.0).rights == said
    assert run("export", clip, "--time", "0", "-o", tmp_path / "frame.glb").code == 0
    assert parse_glb((tmp_path / "frame.glb").read_bytes()).json["asset"]["copyright"] == "Ada, CC0"


def test_exports_for_other_programs_say_it_where_they_can(run, tmp_path):
    Usd = pytest.importorskip("pxr.Usd")
    scene = tmp_path / "scene.glb"
    save(replace(tiny_scene(size=32), rights=Rights(author="Ada", licence="CC0")), scene, codec="png")
    assert run("export", scene, "--as", "splats", "--splats", "50", "-o", tmp_path / "splats.glb").code == 0
    assert parse_glb((tmp_path / "splats.glb").read_bytes()).json["asset"]["copyright"] == "Ada, CC0"
    assert run("export", scene, "-o", tmp_path / "a.usdz").code == 0
    stage = Usd.Stage.Open(str(tmp_path / "a.usdz"))
    assert stage.GetRootLayer().customLayerData == {"author": "Ada", "licence": "CC0"}
    for kind in ("maps", "obj", "colmap"):
        assert run("export", scene, "--as", kind, "-o", tmp_path / kind).code == 0
        listing = json.loads((tmp_path / kind / "eigenfield.json").read_text(encoding="utf-8"))
        assert listing["rights"] == {"author": "Ada", "licence": "CC0"}
    assert b"# author: Ada\n" in (tmp_path / "obj/mesh.obj").read_bytes()
