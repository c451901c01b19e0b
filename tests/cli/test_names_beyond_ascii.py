"""Names and paths beyond ASCII in every verb, on consoles that have them and on those that do not."""

from __future__ import annotations

import io
import json
import os
import sys
from pathlib import Path
from unittest import mock

import pytest

from eigenfield.proxy import read_mesh
from support.captures import write_capture
from support.program import call

FOLDER, PHOTOGRAPH = "写真 é", "ünïcode \N{CAMERA}.png"


def said(encoding: str, *words: object) -> tuple[int, str]:
    """Exit code and what the program wrote to both streams of that encoding."""
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding=encoding) for _ in range(2))
    with mock.patch.object(sys, "stdout", out), mock.patch.object(sys, "stderr", err):
        code = call(*words)
        out.flush(), err.flush()
    return code, (out.buffer.getvalue() + err.buffer.getvalue()).decode(encoding)


@pytest.fixture(scope="module")
def capture(tmp_path_factory) -> Path:
    """A capture whose folder, photograph, mesh and scene have such names."""
    folder = write_capture(tmp_path_factory.mktemp("names") / FOLDER)
    (folder / "images" / "view_00.png").rename(folder / "images" / PHOTOGRAPH)
    document = (folder / "transforms.json").read_text().replace("view_00.png", json.dumps(PHOTOGRAPH)[1:-1])
    (folder / "transforms.json").write_text(document)
    (folder / "proxy.ply").rename(folder / "Oberfläche.ply")
    words = ["--fit", "none", "--textures", 1, "--atlas", 64, "--codec", "png"]
    mesh, scene = folder / "Oberfläche.ply", folder.parent / "szene ß.glb"
    assert said("cp1252", "encode", folder, "--proxy", mesh, "-o", scene, *words)[0] == 0
    return folder


@pytest.mark.parametrize("encoding", ["cp1252", "iso8859-2", "utf-8"])
@pytest.mark.slow
def test_verbs_that_print_names(capture, encoding):
    shown = "写真" if encoding == "utf-8" else r"\u5199\u771f"
    scene = capture.parent / "szene ß.glb"
    for words in (["inspect", capture], ["validate", scene], ["info", scene], ["evaluate", scene, capture]):
        code, text = said(
            encoding, *words, *(["--png-maps", "none", "--curve", "none"] if words[0] == "evaluate" else [])
        )
        assert code == 0 and "Traceback" not in text, words
        if words[0] == "inspect":
            assert shown in text
    code, text = said(encoding, "inspect", capture, "--json")
    assert code == 0 and json.loads(text)["cameras"][-1]["name"] == PHOTOGRAPH
    code, text = said(encoding, "encode", capture / "nichts 写", "-o", capture.parent / "x.glb")
    assert code == 2 and "does not exist" in text


def test_verbs_that_write_files(capture, tmp_path):
    scene = capture.parent / "szene ß.glb"
    for name in ("mesh é.obj", "写真.obj", "mesh 写真"):
        more = [] if name.endswith(".obj") else ["--as", "obj"]
        assert said("cp1252", "export", scene, "-o", tmp_path / name, *more)[0] == 0, name
    text = (tmp_path / "mesh é.obj").read_text(encoding="utf-8")
    (library,) = [line.split(maxsplit=1)[1] for line in text.splitlines() if line.startswith("mtllib")]
    assert (tmp_path / library).is_file()
    (picture,) = [
        line.split(maxsplit=1)[1] for line in (tmp_path / library).read_text(encoding="utf-8").splitlines()
        if line.startswith("map_Kd")
    ]  # fmt: skip
    assert (tmp_path / picture).is_file() and len(read_mesh(tmp_path / "写真.obj").faces)
    assert said("cp1252", "render", scene, "--camera", PHOTOGRAPH, "-o", tmp_path / "bild ö.png")[0] == 0
    assert said("cp1252", "export", scene, "-o", tmp_path / "シーン.html")[0] == 0


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no such names")
def test_a_name_that_is_no_text_at_all(tmp_path):
    folder = write_capture(tmp_path / os.fsdecode(b"a\xff b"))
    assert said("utf-8", "inspect", folder)[0] == 0
