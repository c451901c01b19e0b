"""What `info`, `validate`, `render --time` and `export --time` say and draw of clips; and the same from Python."""

from __future__ import annotations

import json
from dataclasses import replace

import av
import numpy as np
import pytest
from PIL import Image

import eigenfield as ef
from eigenfield.core.clip import Audio
from eigenfield.core.errors import FormatError, OptionError
from eigenfield.gltf import store_scores
from eigenfield.gltf.container import parse_glb
from support.clips import moving_clip, numbered_clip, shown_number, shown_opacity
from support.sounds import opus
from support.viewer_clips import front_steps


@pytest.fixture(scope="module")
def clip(tmp_path_factory):
    path = tmp_path_factory.mktemp("clip") / "clip.glb"
    ef.save(numbered_clip((5, 7)), path)
    return path


@pytest.fixture(scope="module")
def sheets(tmp_path_factory):
    path = tmp_path_factory.mktemp("sheets") / "clip.glb"
    ef.save(moving_clip(numbered_clip((5, 7), sheets=True), front_steps), path)
    return path


def drawn_number(picture):
    """The number that the front view of a numbered clip shows."""
    height = len(picture)
    inside = picture[: height // 2, :, 0].max(axis=0) > 0
    columns = np.flatnonzero(inside)
    return shown_number(picture[: height // 2, columns[0] : columns[-1] + 1, 0].astype(np.float32) / 255)


def test_info_says_where_bytes_are_over_time(clip, run):
    text = run("info", clip).out
    assert "12 frames, 10 a second, from 0 to 1.1 s; groups: 1 of 5, 1 of 7 frames" in text
    assert "Mbit/s" in text and "eigen textures: 4 of 128x128; video/AV1" in text and "36 vertices" in text
    assert len(text.splitlines()) <= 20
    facts = json.loads(run("info", "--json", clip).out)
    films = facts["clip"]["films"]
    assert [film["size"] for film in films] == [[192, 128], [512, 128]]
    assert all(0 < film["key_bytes"] < film["bytes"] for film in films) and facts["clip"]["groups"] == [5, 7]
    assert sum(facts["bytes"].values()) == 2 * facts["bytes"]["total"] == 2 * clip.stat().st_size
    assert facts["bytes"]["textures"] == films[1]["bytes"] and facts["textures"] == 4


def test_info_of_a_clip_that_is_cut_off(clip, run, tmp_path):
    short = tmp_path / "short.glb"
    short.write_bytes(clip.read_bytes()[:-100])
    assert "the file ends behind 5 frames" in run("info", short).out
    code, out, _ = run("validate", short)
    assert code == 2 and out.count("error truncated") == 1
    short.write_bytes(clip.read_bytes()[: parse_glb(clip.read_bytes()).chunks[b"EFTL"].first + 300])
    with pytest.raises(FormatError) as caught:
        run("info", short, "--traceback")
    assert caught.value.code == "group-missing"


def test_validate_finds_nothing_in_a_good_clip_and_the_group_in_a_bad_one(clip, run, tmp_path):
    assert run("validate", clip) == (0, f"{clip}: no findings\n", "")
    bad, data = tmp_path / "bad.glb", bytearray(clip.read_bytes())
    data[-200] ^= 8
    bad.write_bytes(data)
    code, out, _ = run("validate", bad)
    assert code == 2 and out.count("\n") == 1 and "group-damaged" in out and "timeline/groups/1" in out


@pytest.mark.parametrize(("time", "number"), [("0", 0), ("11", 11), ("0.62s", 6), (".3s", 3)])
def test_render_draws_the_frame_of_a_time(clip, run, tmp_path, time, number):
    code, _, _ = run("render", clip, "--time", time, "--at", "0,0", "--resolution", "480x400", "-o", tmp_path / "a.png")
    assert code == 0
    assert drawn_number(np.atleast_3d(np.asarray(Image.open(tmp_path / "a.png")))) == number


@pytest.mark.parametrize(
    ("words", "line"),
    [
        ([], "is a clip, and a scene of one instant is expected"),
        (["--time", "12"], "the clip has no frame 12; name one from 0 to 11"),
        (["--time", "-3s"], "the clip has no frame at -3 s; give 0 to 1.1 seconds"),
    ],
)
def test_a_time_outside_the_clip_and_no_time(clip, run, tmp_path, words, line):
    code, _, err = run("render", clip, *words, "-o", tmp_path / "a.png")
    assert code == 2 and line in err and str(clip) in err and not (tmp_path / "a.png").exists()


@pytest.mark.parametrize(
    ("time", "numbers"), [("3:6", [3, 4, 5]), ("0.2s:0.5s", [2, 3, 4]), ("9:", [9, 10, 11]), (":.15s", [0, 1])]
)
def test_a_range_of_times_is_a_film(clip, run, tmp_path, time, numbers):
    words = ["--time", time, "--at", "0,0", "--resolution", "480x400"]
    assert run("render", clip, *words, "-o", tmp_path / "%02d.png").code == 0
    drawn = [np.atleast_3d(np.asarray(Image.open(path))) for path in sorted(tmp_path.glob("*.png"))]
    assert [drawn_number(picture) for picture in drawn] == numbers


def test_a_film_has_the_rate_of_the_clip_and_follows_a_path(clip, run, tmp_path):
    output = tmp_path / "a.mp4"
    assert run("render", clip, "--time", ":", "--path", "circle", "--resolution", "120x100", "-o", output).code == 0
    with av.open(output) as film:
        stream = film.streams.video[0]
        assert (stream.frames, stream.average_rate) == (12, 10)


@pytest.mark.parametrize(("fps", "seconds"), [([], 0.5), (["--fps", "5"], None)])
def test_a_film_that_plays_as_the_clip_does_has_its_sound(clip, run, tmp_path, fps, seconds):
    heard, output = tmp_path / "heard.glb", tmp_path / "a.mp4"
    ef.save(replace(numbered_clip((5, 7)), audio=Audio(opus(3), 0.0)), heard)
    words = ["--time", "4:9", "--at", "0,0", "--resolution", "96x80", *fps]
    assert run("render", heard, *words, "-o", output).code == 0
    with av.open(output) as film:
        if seconds is None:
            assert not film.streams.audio
            return
        samples = np.concatenate([one.to_ndarray()[0] for one in film.decode(audio=0)])
        rate = film.streams.audio[0].rate
    assert abs(len(samples) / rate - seconds) < 0.05
    steps = np.flatnonzero(np.diff(np.sign(samples[rate // 20 : rate // 2])))
    assert abs(len(steps) / 2 / 0.45 - 200) < 10  # of the first second; the film begins at 0.4 s of it


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["--time", "5:5", "-o", "a.mp4"], "leaves nothing"),
        (["--time", "5:99", "-o", "a.mp4"], "name frames between 0 and 12"),
        (["--time", "5:8", "-o", "a.png"], "a path, or a range of times, makes many pictures"),
        (["--time", "5:8", "--path", "grid", "--frames", "9", "-o", "a.mp4"], "a range of --time says how many"),
        (["--time", "3:x", "-o", "a.mp4"], "a range: 0s:2s"),
        (["--time", "3", "-o", "a.mp4"], "one picture makes no film"),
    ],
)
def test_ranges_that_are_none(clip, run, words, line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, err = run("render", clip, *words)
    assert code == 2 and line in err and not list(tmp_path.iterdir())


def test_a_scene_has_no_other_time(run, tmp_path, good):
    (tmp_path / "a.glb").write_bytes(good["webp"])
    code, _, err = run("render", tmp_path / "a.glb", "--time", "1s", "-o", tmp_path / "a.png")
    assert code == 2 and "leave --time out" in err


def test_export_writes_one_frame(clip, run, tmp_path):
    assert run("export", clip, "--time", "9", "-o", tmp_path / "maps", "--as", "maps").code == 0
    names = sorted(path.name for path in (tmp_path / "maps").iterdir() if path.suffix == ".png")
    first = np.atleast_3d(np.asarray(Image.open(tmp_path / "maps" / names[0])))
    assert len(names) == 4 and shown_number(first[..., 0].astype(np.float32) / 255) == 9
    made, what = ef.export([clip], tmp_path / "app", "app")
    assert made.is_dir() and "with clip to choose from" in what
    with pytest.raises(OptionError, match="time is not for app"):
        ef.export([clip], tmp_path / "app", "app", time=0.5)


def test_every_verb_takes_a_folder(clip, run, tmp_path):
    folder = tmp_path / "clip"
    code, _, err = run("export", clip, "-o", folder, "--as", "folder")
    assert code == 0 and "a file for each of 2 groups" in err
    for place in (folder, folder / "scene.glb"):
        facts, whole = (json.loads(run("info", "--json", one).out) for one in (place, clip))
        assert facts["clip"] == whole["clip"] and facts["bytes"]["textures"] == whole["bytes"]["textures"]
        assert run("validate", place).out == f"{place}: no findings\n"
        for time, number in (("9", 9), ("0.3s", 3)):
            picture = tmp_path / "a.png"
            words = ("--time", time, "--at", "0,0", "--resolution", "480x400", "-o", picture, "--overwrite")
            assert run("render", place, *words).code == 0
            assert drawn_number(np.asarray(Image.open(picture))) == number
    assert run("export", folder, "-o", tmp_path / "again.glb").code == 0
    assert (tmp_path / "again.glb").read_bytes() == clip.read_bytes()
    (folder / "groups" / "00001.eftg").unlink()
    for words in (("info", folder), ("render", folder, "--time", "9", "-o", tmp_path / "b.png")):
        code, _, err = run(*words)
        assert code == 2 and err.count("\n") == 1 and "groups/00001.eftg" in err and "copy or download" in err
    assert "group-missing" in run("validate", folder).out


EXPORTS = {
    "page.html": [], "flight.mp4": ["--frames", 2], "f%02d.png": ["--frames", 2], "plain.glb": [], "mesh.obj": [],
    "maps": ["--as", "maps"], "q.png": ["--as", "quilt", "--quilt", "2x2"], "capture": ["--as", "colmap"],
}  # fmt: skip


@pytest.mark.parametrize("output", EXPORTS)
def test_a_frame_with_sheets_is_exported_as_still_sheets_are(sheets, run, tmp_path, output):
    code, _, err = run("export", sheets, "--time", "9", "-o", tmp_path / output, *EXPORTS[output])
    assert code == 0, err
    if output == "plain.glb":
        primitives = parse_glb((tmp_path / output).read_bytes()).json["meshes"][0]["primitives"]
        assert len(primitives) == 2
    elif output == "maps":
        picture = np.asarray(Image.open(next((tmp_path / output).glob("*.png"))))
        assert shown_opacity(picture[..., 3].astype(np.float32) / 255) == 9
    elif output == "capture":
        assert (tmp_path / output / "sparse" / "0" / "points3D.bin").is_file()


def test_a_clip_in_python(clip, tmp_path):
    opened = ef.load_clip(clip)
    assert isinstance(opened, ef.Clip) and len(opened.times) == 12 and repr(opened).startswith("Clip(")
    numbers = [shown_number(scene.mean[..., 0]) for scene in opened.scenes(0.3, 0.7)]
    assert numbers == [3, 4, 5, 6, 7] and len(list(opened.scenes())) == 12
    scene = ef.load(clip, time=0.4)
    assert isinstance(scene, ef.Scene) and isinstance(opened.scene(0.4), ef.Scene)
    picture = opened.render(at=(0, 0), time=0.4, resolution=(480, 400))
    assert np.array_equal(picture.image, scene.render(at=(0, 0), resolution=(480, 400)).image)
    assert drawn_number(picture.to_uint8()) == 4
    with pytest.raises(OptionError, match="a clip is drawn at a time"):
        opened.render()
    opened.save(tmp_path / "copy.glb")
    assert (tmp_path / "copy.glb").read_bytes() == clip.read_bytes()


def test_scores_are_stored_and_groups_stay(clip, tmp_path):
    path = tmp_path / "clip.glb"
    path.write_bytes(clip.read_bytes())
    store_scores(path, {"image": {"psnr": 31.5}})
    opened = ef.load_clip(path)
    assert opened.scores == {"image": {"psnr": 31.5}}
    before, after = (parse_glb(file.read_bytes()).chunks[b"EFTL"].data for file in (clip, path))
    assert bytes(before) == bytes(after)


def test_a_clip_in_the_viewer_has_the_first_frame_s_surroundings(clip):
    with ef.view(clip, browser=False) as server:
        assert server.address
