"""`eigenfield export` as a person meets it: what is made, what is refused, and what stays when things go wrong."""

from __future__ import annotations

import base64
import errno
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path, PurePosixPath
from urllib.parse import unquote

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from PIL import Image

from eigenfield.capture import open_capture
from eigenfield.core.errors import OutputError
from eigenfield.gltf import save, without_residual
from eigenfield.rendering import RenderJob
from eigenfield.runtime.files import atomic_files
from eigenfield.viewer import exports
from eigenfield.viewer.exports import OPTIONS
from eigenfield.viewer.exports.export import ENDINGS, FILE_ENDINGS
from support.clips import numbered_clip
from support.scenes import tiny_scene

KINDS = {  # output, options, and a file that must be there
    "html": ("page.html", [], "page.jpg"),
    "html laboratory": ("page.html", ["--laboratory"], "page.html"),
    "mp4": ("flight.mp4", ["--frames", 4], "flight.mp4"),
    "png": ("f%02d.png", ["--frames", 3], "f02.png"),
    "glb": ("plain.glb", [], "plain.glb"),
    "obj": ("mesh.obj", [], "mesh.png"),
    "obj folder": ("mesh", ["--as", "obj"], "mesh/eigen_02.png"),
    "maps": ("maps", ["--as", "maps"], "maps/view_03.png"),
    "quilt": ("q.png", ["--as", "quilt", "--quilt", "3x2"], "q_qs3x2a1.2.png"),
    "views": ("grid", ["--as", "views", "--grid", "1x3"], "grid/input_Cam002.png"),
    "colmap": ("capture", ["--as", "colmap"], "capture/sparse/0/points3D.bin"),
    "splats": ("splats.glb", ["--as", "splats", "--splats", 300], "splats.glb"),
    "usdz": ("scene.usdz", [], "scene.usdz"),
    "folder": ("clip", ["--as", "folder"], "clip/groups/00001.eftg"),
    "app": ("open", ["--as", "app"], "open/samples/scene.glb"),
}


@pytest.fixture(scope="module")
def scene_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("a scene") / "scene.glb"
    save(tiny_scene(held_out=(1,)), path, codec="png")
    return path


@pytest.fixture(scope="module")
def clip_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("a clip") / "clip.glb"
    save(numbered_clip((2, 1)), path)
    return path


@pytest.fixture
def export(run, scene_file, clip_file, tmp_path):
    """`eigenfield export` of a scene (of a clip as a folder) into a folder of its own; returns exit code and standard
    error."""
    place = tmp_path / "out"
    place.mkdir()

    def call(output, *arguments):
        source = clip_file if "folder" in arguments else scene_file
        code, _, err = run("export", source, "-o", place / output, *arguments)
        return code, err

    call.place = place
    return call


def contents(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_every_kind_is_documented_and_tried(run):
    page = Path(__file__).parents[2] / "docs" / "exports.md"
    listed = re.findall(r"^\| `(\w+)` \|", page.read_text(encoding="utf-8"), re.MULTILINE)
    assert list(dict.fromkeys(listed)) == list(OPTIONS) == list(dict.fromkeys(kind.split()[0] for kind in KINDS))
    words = run("export", "--help").out
    assert f"--as {'|'.join(OPTIONS)}" in words
    assert [kind for kind in OPTIONS if f'"{kind}"' not in exports.export.__doc__] == []
    assert {ending for endings in ENDINGS.values() for ending in endings} <= set(FILE_ENDINGS)
    assert [kind for kind in OPTIONS if not re.search(rf"^ +{kind} {{2,}}\w", words, re.MULTILINE)] == []


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_made_once_and_again_with_overwrite(export, kind):
    output, options, there = KINDS[kind]
    code, err = export(output, *options)
    assert code == 0 and err.startswith("wrote "), err
    first = contents(export.place)
    assert there in first and not [name for name in first if ".part" in name]
    code, err = export(output, *options)
    assert code == 2 and "--overwrite" in err and err.count("\n") == 1
    assert contents(export.place) == first
    code, err = export(output, *options, "--overwrite", "-q")
    assert code == 0 and err == ""
    assert contents(export.place) == first  # the same bytes, and nothing more


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "quilt"])  # its name needs the scene
def test_an_existing_output_is_kept_before_any_work(export, kind, monkeypatch):
    output, options, there = KINDS[kind]
    (export.place / there).parent.mkdir(parents=True, exist_ok=True)
    (export.place / there).write_bytes(b"precious")

    def load(path):
        raise AssertionError("the scene was read")

    monkeypatch.setattr("eigenfield.gltf.load", load)
    code, err = export(output, *options)
    assert code == 2 and "--overwrite" in err and contents(export.place) == {there: b"precious"}


def test_a_page_for_guests_names_its_poster_to_crawlers_and_shows_how_to_embed_it(export):
    code, err = export("my page.html", "--title", "<&>", "--url", "https://example.org/a b/page.html")
    assert code == 0
    snippet = err.splitlines()[1]
    assert snippet.startswith(
        '<iframe src="https://example.org/a b/page.html" title="&lt;&amp;&gt;" width="640" height="'
    )
    page = (export.place / "my page.html").read_text(encoding="utf-8")
    tags = dict(re.findall(r'<meta property="([\w:]+)" content="([^"]*)">', page))
    assert tags["og:image"] == "https://example.org/a b/my%20page.jpg" and tags["og:title"] == "&lt;&amp;&gt;"
    with Image.open(export.place / "my page.jpg") as poster:
        assert [str(side) for side in poster.size] == [tags["og:image:width"], tags["og:image:height"]]
        assert poster.format == "JPEG" and np.asarray(poster).std() > 5
    assert '"url":"https://example.org/a b/page.html"' in page and '"ui":"plain"' in page
    assert page.index('class="poster"') < page.index("eigenfield-config") < page.index('type="module"')
    code, err = export("other.html", "--at", "0.5,0")
    page = (export.place / "other.html").read_text(encoding="utf-8")
    assert code == 0 and '<iframe src="other.html"' in err and "og:url" not in page
    assert '"url"' not in page and '"start":[0.5,0.0]' in page and 'og:image" content="other.jpg"' in page
    assert (export.place / "other.jpg").read_bytes() != (export.place / "my page.jpg").read_bytes()


def test_a_page_that_opens_files_offers_the_scenes_that_are_named(run, export, scene_file, tmp_path):
    other = tmp_path / "50 % & b.glb"
    shutil.copy(scene_file, other)
    place = export.place / "open"
    code, out, err = run("export", scene_file, other, scene_file, "-o", place, "--as", "app", "--title", "</title>")
    assert (code, out) == (0, ""), err
    page = (place / "index.html").read_text(encoding="utf-8")
    config = json.loads(re.search(r'id="eigenfield-config">(.*?)</script>', page)[1])
    assert config["title"] == "</title>" and "<title>&lt;/title&gt;</title>" in page
    alike = f"{scene_file.parent.name}/scene"
    assert [sample["name"] for sample in config["samples"]] == [alike, "50 % & b", alike]
    for sample in config["samples"]:
        with Image.open(place / unquote(sample["picture"])) as picture:
            assert picture.format == "JPEG" and np.asarray(picture).std() > 5
        data = (place / unquote(sample["url"])).read_bytes()
        assert len(data) == sample["bytes"] and data == without_residual(scene_file.read_bytes())
    manifest = json.loads((place / "manifest.webmanifest").read_text(encoding="utf-8"))
    assert manifest["name"] == "</title>" and all((place / icon["src"]).is_file() for icon in manifest["icons"])


def test_a_page_that_opens_files_needs_no_scene_and_other_exports_need_one(run, tmp_path):
    code, _, err = run("export", "-o", tmp_path / "open", "--as", "app")
    assert code == 0 and "a page that opens files; put it on a web server" in err
    assert not (tmp_path / "open" / "samples").exists()
    for arguments, says in (
        (["-o", tmp_path / "a.html"], "0 scenes for html; name one"),
        (["a.glb", "b.glb", "-o", tmp_path / "a.mp4"], "2 scenes for mp4; name one"),
        (["a.glb", "b.glb", "c.glb", "-o", tmp_path / "a.html"], "3 scenes for html; name one"),
        ([tmp_path / "missing.glb", "-o", tmp_path / "b", "--as", "app"], "does not exist"),
        (["-o", tmp_path / "b", "--as", "app", "--laboratory"], "--laboratory is not for app"),
    ):
        code, _, err = run("export", *arguments)
        assert code == 2 and says in err and err.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["open"]


def test_the_service_worker_keeps_every_file_of_the_page(run, tmp_path):
    run("export", "-o", tmp_path / "open", "--as", "app")
    worker = Path(__file__).parents[2] / "src/eigenfield/viewer/static/worker.js"
    kept = json.loads(re.search(r"PAGE = (\[.*?\]);", worker.read_text(encoding="utf-8"))[1])
    there = {path.name for path in (tmp_path / "open").iterdir()} - {"index.html", "worker.js", "eigenfield.json"}
    assert set(kept) == {"./"} | there


def test_a_folder_with_files_of_others_is_never_replaced(export):
    assert export("maps", "--as", "maps")[0] == 0
    (export.place / "maps" / "notes.txt").write_text("mine")
    before = contents(export.place)
    code, err = export("maps", "--as", "maps", "--overwrite")
    assert code == 2 and "notes.txt" in err and contents(export.place) == before
    (export.place / "home" / "sub").mkdir(parents=True)
    (export.place / "home" / "sub" / "letter").write_text("dear")
    for listing in (b"", b"[]", b"\xff", b'{"files": 3}', b'{"files": [{}]}', b"[" * 100_000):
        (export.place / "home" / "eigenfield.json").write_bytes(listing)
        code, err = export("home", "--as", "colmap", "--overwrite")
        assert code == 2 and "no export wrote" in err


def test_an_empty_folder_is_filled(export):
    (export.place / "maps").mkdir()
    assert export("maps", "--as", "maps")[0] == 0
    assert export("maps/.", "--as", "colmap", "--overwrite")[0] == 0
    assert {path.name for path in (export.place / "maps").iterdir()} == {"images", "sparse", "eigenfield.json"}


@pytest.mark.parametrize("kind", [*KINDS, "maps into an old one"])
def test_a_full_disk_is_one_line_and_leaves_what_was(export, kind, monkeypatch):
    output, options, _ = KINDS.get(kind, KINDS["maps"])
    if kind not in KINDS:
        assert export(output, *options)[0] == 0
        options = [*options, "--overwrite"]
    before = contents(export.place)

    def full(descriptor):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    code, err = export(output, *options)
    assert code == 2 and "no room" in err and err.count("\n") == 1
    assert contents(export.place) == before and not list(export.place.rglob("*.part"))


@pytest.mark.parametrize("at", [0, 1, 3])
def test_interrupted_work_leaves_nothing(tmp_path, at):
    job = RenderJob(tiny_scene(cameras=9))

    def stop(stage, done, total):
        if done == min(at, total):
            raise KeyboardInterrupt

    from fractions import Fraction

    from eigenfield.rendering.render_jobs import write_flight

    points = np.zeros((4, 2))
    work = [
        lambda: exports.write_maps(job.scene, tmp_path / "maps", progress=stop),
        lambda: exports.write_obj_folder(job.scene, tmp_path / "obj", progress=stop),
        lambda: exports.write_colmap(job, tmp_path / "colmap", progress=stop),
        lambda: exports.write_quilt(job, exports.quilt_of(job.scene), tmp_path / "q.png", progress=stop),
        lambda: write_flight(job, points, tmp_path / "a.mp4", Fraction(30), progress=stop),
        lambda: write_flight(job, points, tmp_path / "a%d.png", Fraction(30), progress=stop),
    ]
    for write in work:
        with pytest.raises(KeyboardInterrupt):
            write()
        assert list(tmp_path.iterdir()) == []


def test_pictures_that_cannot_all_be_placed_are_taken_back(tmp_path, monkeypatch):
    targets = [tmp_path / name for name in ("a", "b", "c")]
    targets[0].write_bytes(b"old")
    with pytest.raises(OutputError), atomic_files(targets, overwrite=True) as places:
        for place in places:
            place.write_bytes(b"new")
        targets[2].mkdir()  # what came meanwhile
    targets[2].rmdir()
    assert contents(tmp_path) == {"a": b"old"} and len(list(tmp_path.iterdir())) == 1


KILLED_EXPORTS = """
import os, sys
from pathlib import Path
from eigenfield.viewer.exports.folder import atomic_folder, write_listing

folder, replace = Path(sys.argv[1]), Path.replace

def export(names, killed_after=None):
    if os.fork() == 0:
        left = [killed_after]
        def counted(path, target):
            answer = replace(path, target)
            if left[0] is not None:
                left[0] -= 1
                if left[0] == 0:
                    os._exit(9)
            return answer
        Path.replace = counted
        with atomic_folder(folder, overwrite=True) as place:
            for name in names:
                (place / name).write_text(names)
            write_listing(place, "test", {})
        os._exit(0)
    return os.waitstatus_to_exitcode(os.wait()[1])

for moment in range(1, 100):
    assert export("abc") == 0
    code = export("bcd", moment)
    if code == 0:
        break
    assert code == 9 and export("cde") == 0, moment
    assert sorted(path.name for path in folder.iterdir()) == ["c", "d", "e", "eigenfield.json"], moment
    assert {(folder / name).read_text() for name in "cde"} == {"cde"}
print(moment)
"""


@pytest.mark.skipif(os.name != "posix", reason="fork")
def test_an_export_that_was_killed_while_it_replaced_another_is_replaced_by_the_next(tmp_path):
    command = [sys.executable, "-c", KILLED_EXPORTS, str(tmp_path / "export")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) == 3 + 3 + 2 + 1  # three files out, three in, two listings: then none is killed


@pytest.mark.parametrize(
    ("output", "options", "says"),
    [
        ("a.png", [], "--as quilt"),
        ("a", [], "say --as"),
        ("a.gltf", [], "say --as"),
        ("a.obj", ["--as", "glb"], ".glb"),
        ("a.glb", ["--at", "0,2"], "lies outside the array"),
        ("a.glb", ["--image", "ktx2"], "gltf-transform uastc"),
        ("a.glb", ["--image", "gif"], "png, jpeg, webp"),
        ("a.glb", ["--metres-per-unit", "0"], "above 0"),
        ("a.glb", ["--textures", 2], "--textures is not for glb"),
        ("a.obj", ["--draco"], "--draco is not for obj"),
        ("a.png", ["--as", "maps"], "folder"),
        ("a.obj", ["--as", "colmap"], "folder"),
        ("a", ["--as", "html"], ".html"),
        ("a.png", ["--as", "mp4"], ".mp4"),
        ("a.png", ["--as", "png"], "%04d"),
        ("a%d.png", ["--as", "quilt"], "one picture"),
        ("a.html", ["--fps", 30], "--fps is not for html"),
        ("a", ["--as", "maps", "--background", "#ffffff"], "--background is not for maps"),
        ("a.mp4", ["--title", "x"], "--title is not for mp4"),
        ("a.mp4", ["--background", "transparent"], "transparent"),
        ("a.mp4", ["--path", "zigzag"], "circle, spiral, grid"),
        ("a.mp4", ["--frames", 0], "1 or more"),
        ("a.obj", ["--textures", 2], "mean alone"),
        ("a", ["--as", "obj", "--textures", -1], "0 or more"),
        ("a", ["--as", "maps", "--textures", -1], "0 or more"),
        ("a", ["--as", "colmap", "--frames", 3], "--path"),
        ("a.html", ["--at", "0,1.5"], "outside the array"),
        ("a.html", ["--laboratory", "--at", "0,1.5"], "outside the array"),
        ("a.html", ["--laboratory", "--url", "https://example.org/"], "--url is not for --laboratory"),
        ("a.html", ["--url", "example.org"], "https://"),
        ("a.mp4", ["--laboratory"], "--laboratory is not for mp4"),
        ("a.html", ["--metres-per-unit", "nan"], "above 0"),
        ("a.html", ["--metres-per-unit", "-1"], "above 0"),
        ("a.png", ["--as", "quilt", "--quilt", "0x3"], "1x1"),
        ("a.png", ["--as", "quilt", "--quilt", "27"], "go, portrait"),
        ("a.png", ["--as", "quilt", "--quilt", "x6"], "COLUMNSxROWS"),
        ("a.png", ["--as", "quilt", "--path", "circle"], "--path is not for one quilt"),
        ("a_qs2x2a1.mp4", ["--background", "transparent"], "transparent"),
        ("a_qs2x2a9.mp4", ["--quilt", "2x2", "--frames", 2], "suffix"),
        ("a.png", ["--as", "views"], "folder"),
        ("a", ["--as", "views", "--grid", "1x1"], "1x2 to 99x99"),
        ("a.png", ["--as", "quilt", "--spread", "1.5"], "0 (one place)"),
        ("a.png", ["--as", "quilt", "--spread", "nan"], "0 (one place)"),
        ("a.png", ["--as", "quilt", "--resolution", "9000x9000"], "16384"),
        ("a_qs4x4a1.png", [], "suffix"),
        ("no/a.obj", [], "create"),
        ("no/a", ["--as", "maps"], "create"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(export, output, options, says):
    code, err = export(output, *options)
    assert code == 2 and says in err and err.count("\n") == 1, err
    assert list(export.place.iterdir()) == []


def test_numbers_and_percent_signs_in_names(export):
    assert export("50%_%03d.png", "--frames", 2)[0] == 0
    assert {path.name for path in export.place.iterdir()} == {"50%_000.png", "50%_001.png"}


def test_transparent_pictures(export):
    assert export("f%d.png", "--frames", 1, "--background", "transparent")[0] == 0
    with Image.open(export.place / "f0.png") as picture:
        assert picture.mode == "RGBA"


# fmt: off
HOSTILE = ["../../x", "a/b", "a\\b", "/etc/passwd", "C:\\windows\\x", "CON", "con.png", "NUL.txt", "..", ".", "...",
           "x" * 1000, "é" * 300, "a.png", "A.PNG", "a.jpg", "a", "a.png/b", "a/B", " a ", "a.", "a?", "a*", "x/" * 400,
           "trailing ", "<script>", "naïve", "nai\u0308ve", "..\\..\\y", "a//b", "~", "-rf", "%s", "\u202egnp"]
# fmt: on


def check_names(names):
    files = exports.file_names(names)
    assert len(files) == len(names)
    keys = [name.casefold() for name in files]
    assert len(set(keys)) == len(keys)
    for name in files:
        path = PurePosixPath(name)
        assert not path.is_absolute() and str(path) == name and path.suffix == ".png" and len(name.encode()) < 1000
        for part in path.parts:
            assert part not in ("..", ".") and 0 < len(part.encode()) <= 160
            assert not set(part) & set('<>:"\\|?*') and part.isprintable()
            assert part == part.strip() and not part.endswith(".")
            assert part.split(".")[0].upper() not in ("CON", "NUL", "PRN", "AUX", "COM1", "LPT9")
        for parent in path.parents:
            assert str(parent).casefold() not in keys, "a file where a folder must be"
    return files


@given(
    st.lists(st.text(st.characters(codec="utf-8", exclude_categories=["Cc"]), max_size=30), max_size=12, unique=True)
)
@example(HOSTILE)
@example(["a/b", "a", "a.png/c", "a.png", "A/B.png"])
@example(["a.png/b", "a.png"])
@example(["a.png", "a.png/b", "a.png_b"])
def test_names_stay_in_the_folder_and_apart(names):
    check_names(names)


def test_harmless_names_stay_as_they_are():
    assert exports.file_names(["left/0001.jpg", "DSC 01.TIFF", "out_00_-3.5", "ü.png"]) == [
        "left/0001.png", "DSC 01.png", "out_00_-3.5.png", "ü.png",
    ]  # fmt: skip


def test_hostile_cameras_are_written_inside(tmp_path):
    names = tuple(HOSTILE[:25])
    scene = tiny_scene(cameras=25)
    scene = replace(scene, rig=replace(scene.rig, names=names))
    (tmp_path / "in").mkdir()
    exports.write_maps(scene, tmp_path / "in" / "maps")
    exports.write_colmap(RenderJob(scene), tmp_path / "in" / "colmap")
    assert {path.name for path in tmp_path.iterdir()} == {"in"}
    assert {path.name for path in (tmp_path / "in").iterdir()} == {"maps", "colmap"}
    listing = json.loads((tmp_path / "in" / "maps" / "eigenfield.json").read_text(encoding="utf-8"))
    assert list(listing["maps"]) == list(names)
    assert all((tmp_path / "in" / "maps" / file).is_file() for file in listing["maps"].values())
    assert len(open_capture(tmp_path / "in" / "colmap")) == 25


def test_a_glb_never_takes_the_place_of_its_scene(run, scene_file):
    before = scene_file.read_bytes()
    code, _, err = run("export", scene_file, "-o", scene_file, "--overwrite")
    assert code == 2 and "the scene itself" in err and err.count("\n") == 1
    assert scene_file.read_bytes() == before


def test_no_export_takes_the_place_of_a_clip_s_folder(run, clip_file, tmp_path):
    clip = tmp_path / "clip"
    assert run("export", clip_file, "--as", "folder", "-o", clip).code == 0
    before = contents(clip)
    for words in (["--as", "maps", "-o", clip], ["--as", "glb", "-o", clip / "scene.glb"]):
        code, _, err = run("export", clip, "--time", "0", "--overwrite", *words)
        assert code == 2 and "the scene itself" in err and err.count("\n") == 1
        assert contents(clip) == before
    assert run("export", clip, "--as", "folder", "-o", clip, "--overwrite").code == 0
    assert contents(clip) == before


def test_a_scene_that_is_missing_or_in_a_store_is_told_as_such(run, scene_file, tmp_path):
    fsspec = pytest.importorskip("fsspec")
    there = tmp_path / "a.glb"
    there.write_bytes(b"")
    code, _, err = run("export", tmp_path / "missing.glb", "-o", there, "--as", "glb", "--overwrite")
    assert code == 2 and "does not exist" in err and err.count("\n") == 1
    fsspec.filesystem("memory").pipe("/scenes/scene.glb", scene_file.read_bytes())
    for _ in range(2):
        exports.export("memory://scenes/scene.glb", there, "glb", overwrite=True)


def test_names_that_are_no_text(run, scene_file, tmp_path):
    for name in (b"caf\xe9.html", b"caf\xe9.usdz", b"caf\xe9.obj"):
        assert run("export", scene_file, "-o", tmp_path / os.fsdecode(name)).code == 0
    other = tmp_path / os.fsdecode(b"caf\xe9.glb")
    shutil.copy(scene_file, other)
    assert run("export", other, "-o", tmp_path / "open", "--as", "app").code == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["-o", "a.html", "--url", "https://[x"], "is no address"),
        (["-o", "a.html", "--url", "https://"], "is no address"),
        (["-o", "a.glb", "--as", "splats", "--metres-per-unit", "1e40"], "is no length"),
        (["-o", "a", "--as", "app", "--time", "0"], "instant"),
    ],
)
def test_impossible_values_are_refused_in_a_line(export, words, said):
    code, err = export(words[1], *words[2:])
    assert code == 2 and said in err and err.count("\n") == 1
    assert list(export.place.iterdir()) == []


def test_a_time_belongs_to_the_scenes_that_are_clips(run, scene_file, clip_file, tmp_path):
    for order in ([scene_file, clip_file], [clip_file, scene_file]):
        assert run("export", *order, "-o", tmp_path / "a.html", "--time", "0", "--overwrite").code == 0
    for scenes in ([], [clip_file] * 3):
        code, _, err = run("export", *scenes, "-o", tmp_path / "open", "--as", "app", "--time", "0")
        assert code == 2 and "--time is not for app" in err


def test_without_dracopy_a_line_says_what_to_install(export, monkeypatch):
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    code, err = export("a.glb", "--draco")
    assert code == 2 and "pip install 'eigenfield[meshes]'" in err and err.count("\n") == 1
    assert list(export.place.iterdir()) == []


def test_two_scenes_make_one_page_that_has_both(run, tmp_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        save(tiny_scene(textures=2 if folder == "a" else 1), tmp_path / folder / "scene.glb", codec="png")
    first, second, page = tmp_path / "a/scene.glb", tmp_path / "b/scene.glb", tmp_path / "page.html"
    for more in ([], ["--laboratory", "--overwrite"]):
        assert run("export", first, second, "-o", page, *more).code == 0
        text = page.read_text(encoding="utf-8")
        assert '"beside":{"names":["a/scene","b/scene"]' in text
        for name, file in (("scene", first), ("beside", second)):
            (held,) = re.findall(f'id="eigenfield-{name}">([^<]*)<', text)
            assert base64.b64decode(held) == file.read_bytes()
    code, _, err = run("export", first, tmp_path / "none.glb", "-o", page, "--overwrite")
    assert code == 2 and "none.glb: does not exist" in err and page.read_text(encoding="utf-8") == text
