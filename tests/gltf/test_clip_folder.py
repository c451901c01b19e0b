"""A clip as a folder of files: it reads as the same clip in one file, one form becomes the other byte for byte, and a
file that is missing or another one is named.
"""

from __future__ import annotations

import time
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from eigenfield.coding import limits
from eigenfield.core.clip import Audio
from eigenfield.core.errors import EigenfieldError, FormatError, OptionError, OutputError
from eigenfield.gltf import (
    encode_scene,
    has_group_files,
    load,
    load_clip,
    one_file,
    outline,
    parts,
    save,
    store_scores,
    validate,
)
from eigenfield.gltf.clip_forms import files_beside
from eigenfield.gltf.container import parse_glb
from eigenfield.viewer.exports import export, write_clip_folder
from support import glb_surgery
from support.clips import groups_of, moving_clip, numbered_clip, repeated_clip, shown_number
from support.schema import extension_of, violation
from support.sounds import opus
from support.viewer_clips import front_steps

SOUND = opus(0.5)
FILES = ["eigenfield.json", "groups/00000.eftg", "groups/00001.eftg", "scene.glb", "sound.opus"]


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("one") / "clip.glb"
    save(replace(numbered_clip((2, 3)), audio=Audio(SOUND, 0.25)), path)
    return path


@pytest.fixture
def folder(path, tmp_path):
    write_clip_folder(path, tmp_path / "clip")
    return tmp_path / "clip"


def files_of(folder):
    return sorted(one.relative_to(folder).as_posix() for one in folder.rglob("*") if one.is_file())


def numbers_of(clip):
    return [shown_number(clip.scene(float(time)).appearance.planes[0].mean[..., 0]) for time in clip.timeline.times]


def test_a_folder_has_the_bytes_of_each_group_and_of_the_sound(path, folder):
    assert files_of(folder) == FILES
    for name, data in zip(FILES[1:3], groups_of(path.read_bytes()), strict=True):
        assert (folder / name).read_bytes() == data
    assert (folder / "sound.opus").read_bytes() == SOUND
    scene = (folder / "scene.glb").read_bytes()
    assert b"EFTL" not in scene
    extension = extension_of(scene)
    assert violation(extension) is None and "groupFiles" in extension["needs"] and extension["timeline"]["groupFiles"]
    assert not any("offset" in one for one in (*extension["timeline"]["groups"], extension["timeline"]["audio"]))


def clips():
    yield "silent", numbered_clip((1, 2))
    yield "moving sheets", moving_clip(numbered_clip((2, 1), sheets=True), front_steps)
    yield "heard", replace(numbered_clip((2,), first=-1.5, rate=Fraction(30000, 1001)), audio=Audio(SOUND, 0.25))


@pytest.mark.parametrize("clip", [pytest.param(clip, id=name) for name, clip in clips()])
def test_one_form_becomes_the_other_byte_for_byte(clip, tmp_path):
    save(clip, tmp_path / "clip.glb")
    export(tmp_path / "clip.glb", tmp_path / "clip", "folder")
    made, what = export(tmp_path / "clip", tmp_path / "again.glb")
    assert made == tmp_path / "again.glb" and "the clip as one file" in what
    assert made.read_bytes() == (tmp_path / "clip.glb").read_bytes() == one_file(tmp_path / "clip")
    export(clip, tmp_path / "of a value", "folder")
    assert files_of(tmp_path / "of a value") == files_of(tmp_path / "clip")
    export(tmp_path / "clip" / "scene.glb", tmp_path / "copy", "folder")
    for name in files_of(tmp_path / "clip"):
        data = (tmp_path / "clip" / name).read_bytes()
        assert (tmp_path / "of a value" / name).read_bytes() == data == (tmp_path / "copy" / name).read_bytes()
    save(load_clip(tmp_path / "clip"), tmp_path / "saved.glb")
    assert (tmp_path / "saved.glb").read_bytes() == (tmp_path / "clip.glb").read_bytes()


def test_a_plain_file_becomes_a_folder_and_back(path, tmp_path):
    plain = glb_surgery.changed(path.read_bytes(), lambda gltf, extension, binary: None)
    assert "packed" not in parse_glb(plain).json["extensions"][glb_surgery.EXTENSION]
    (tmp_path / "plain.glb").write_bytes(plain)
    write_clip_folder(tmp_path / "plain.glb", tmp_path / "clip")
    again = one_file(tmp_path / "clip")
    assert glb_surgery.split(again) == glb_surgery.split(plain) and groups_of(again) == groups_of(plain)


def test_it_reads_as_the_clip_in_one_file(path, folder):
    assert has_group_files(folder) and not has_group_files(path)
    one = load_clip(path)
    for place in (folder, folder / "scene.glb", str(folder)):
        clip = load_clip(place)
        assert numbers_of(clip) == [0, 1, 2, 3, 4] and clip.timeline == one.timeline
        assert clip.audio.data == SOUND and clip.audio.first == 0.25
        assert validate(place) == []
        scene, other = load(place, time=0.3), load(path, time=0.3)
        assert np.array_equal(scene.appearance.planes[0].mean, other.appearance.planes[0].mean)
        sizes, whole = parts(place), parts(path)
        assert {**sizes, "total": 0, "other": 0} == {**whole, "total": 0, "other": 0}
        files = [(folder / name).stat().st_size for name in FILES[1:]]
        assert sizes["total"] == sum(files)
    assert list(files_beside(load_clip(folder))) == FILES[1:3] + FILES[4:] and files_beside(one) == {}


def test_scores_are_stored_in_its_scene(folder):
    groups = [(folder / name).read_bytes() for name in FILES[1:3]]
    store_scores(folder, {"psnr": 30})
    assert load_clip(folder).scores == {"psnr": 30} and validate(folder) == []
    assert [(folder / name).read_bytes() for name in FILES[1:3]] == groups


DAMAGES = {
    "missing": (lambda data: None, "group-missing", "groups/00001.eftg does not exist"),
    "shorter": (lambda data: data[:-9], "group-damaged", "groups/00001.eftg has"),
    "longer": (lambda data: data + b"more", "group-damaged", "groups/00001.eftg has"),
    "empty": (lambda data: b"", "group-damaged", "groups/00001.eftg has 0 bytes"),
    "wrong": (lambda data: data[:-1] + bytes([data[-1] ^ 1]), "group-damaged", "in groups/00001.eftg are not those"),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_file_that_is_another_is_named_and_costs_its_frames_alone(folder, tmp_path, damage):
    change, code, says = DAMAGES[damage]
    file = folder / "groups" / "00001.eftg"
    data = change(file.read_bytes())
    file.unlink()
    if data is not None:
        file.write_bytes(data)
    clip = load_clip(folder)
    assert shown_number(clip.scene(0.1).appearance.planes[0].mean[..., 0]) == 1
    for read in (lambda: clip.scene(0.3), lambda: load(folder, time=0.3)):
        with pytest.raises(FormatError) as error:
            read()
        assert error.value.code == code and says in str(error.value) and "copy or download" in error.value.remedy
        assert str(folder) in str(error.value) and "\n" not in str(error.value)
    (finding,) = validate(folder)
    assert finding.code == code and says in finding.message and finding.where.endswith("/timeline/groups/1")
    for output, kind in ((tmp_path / "again.glb", "glb"), (tmp_path / "other", "folder")):
        with pytest.raises(FormatError, match=r"groups/00001\.eftg"):
            export(folder, output, kind)
    assert sorted(one.name for one in tmp_path.iterdir()) == ["clip"]  # nothing half written


@pytest.mark.parametrize("change", [lambda file: file.unlink(), lambda file: file.write_bytes(SOUND[:-9])])
def test_a_clip_whose_sound_is_missing_or_cut_is_silent(folder, caplog, change):
    change(folder / "sound.opus")
    clip = load_clip(folder)
    assert clip.audio is None and "sound.opus" in caplog.text and "the clip is silent" in caplog.text
    (finding,) = validate(folder)
    assert finding.code in ("group-missing", "group-damaged") and "sound.opus" in finding.message


def test_a_sound_that_is_none_is_refused(folder):
    (folder / "sound.opus").write_bytes(bytes(len(SOUND)))
    with pytest.raises(FormatError) as error:
        load_clip(folder)
    assert error.value.code == "audio-unknown"


def test_its_scene_alone_in_memory_has_no_groups(folder):
    with pytest.raises(FormatError) as error:
        outline(folder)
    assert error.value.code == "group-missing" and "--as glb" in error.value.remedy


def test_a_flag_that_is_not_true_is_refused(path, tmp_path):
    def change(gltf, extension, binary):
        extension["timeline"]["groupFiles"] = 1

    data = glb_surgery.changed(path.read_bytes(), change)
    assert glb_surgery.outcome(tmp_path / "a.glb", data, load_clip) == "json-value"


def test_a_folder_without_a_scene_is_none(tmp_path):
    with pytest.raises(FormatError) as error:
        load_clip(tmp_path)
    assert error.value.code == "not-a-file"


def test_more_than_a_glb_holds_becomes_a_folder(path, folder, tmp_path, monkeypatch):
    clip, output = load_clip(folder), tmp_path / "long.glb"
    monkeypatch.setattr(limits, "MAX_FILE", path.stat().st_size - 1)
    for write in (lambda: save(clip, output), lambda: export(folder, output)):
        with pytest.raises(OutputError) as error:
            write()
        assert error.value.code == "file-too-large" and "make it a folder" in error.value.remedy
        assert "glb" in str(error.value.path) and not output.exists()
    export(clip, tmp_path / "long", "folder")
    assert numbers_of(load_clip(tmp_path / "long")) == [0, 1, 2, 3, 4]


def test_only_clips_of_coded_groups_become_folders(path, tmp_path):
    scene = load(path, time=0)
    with pytest.raises(OptionError, match="no groups for a folder"):
        export(scene, tmp_path / "a", "folder")
    (tmp_path / "scene.glb").write_bytes(encode_scene(scene))
    with pytest.raises(EigenfieldError, match="a clip is expected"):
        export(tmp_path / "scene.glb", tmp_path / "a", "folder")
    with pytest.raises(OptionError, match="time is not for folder"):
        export(path, tmp_path / "a", "folder", time=0.1)
    with pytest.raises(OptionError, match="a clip is drawn at a time"):
        export(path, tmp_path / "a.glb")
    assert not (tmp_path / "a").exists()


def test_one_frame_of_a_folder_is_exported_as_a_mesh(folder, tmp_path):
    made, what = export(folder, tmp_path / "a.glb", time=0.2)
    assert "for any viewer" in what and b"EIGENFIELD" not in made.read_bytes()


GROUP, LONG, SHORT = 30, 3000, 60


@pytest.fixture(scope="module")
def lengths(tmp_path_factory):
    """A clip of 3,000 frames and one of 60, each as a file and as a folder."""
    place = tmp_path_factory.mktemp("long")
    clip = numbered_clip((GROUP, GROUP), Fraction(30))
    for frames in (LONG, SHORT):
        save(repeated_clip(clip, frames // SHORT), place / f"{frames}.glb")
        write_clip_folder(place / f"{frames}.glb", place / str(frames))
    return place


@pytest.mark.parametrize("name", [f"{LONG}.glb", f"{LONG}/scene.glb"])
def test_the_json_of_3000_frames_is_small(lengths, name):
    data = (lengths / name).read_bytes()
    gltf, _ = glb_surgery.split(data)
    assert gltf["extensions"][glb_surgery.EXTENSION]["timeline"]["frames"] == LONG
    unpacked = len(glb_surgery.join(gltf, b"")) - 28
    assert unpacked < 40_000 and glb_surgery.binary_start(data) < 4_000


@pytest.mark.parametrize("form", [".glb", ""])
def test_3000_frames_are_opened_and_sought_as_60_are(lengths, form):
    def seconds(frames):
        """To open a clip, and to seek a frame in the last group and one in the first."""
        started = time.perf_counter()
        clip = load_clip(lengths / f"{frames}{form}")
        shown = [shown_number(clip.scene(at / 30).appearance.planes[0].mean[..., 0]) for at in (frames - 20, 7)]
        assert shown == [40, 7]
        return time.perf_counter() - started

    taken = {frames: [] for frames in (SHORT, LONG)}
    deadline = time.monotonic() + 60
    for _ in range(5):
        for frames, own in taken.items():
            own.append(seconds(frames))
    while min(taken[LONG]) > 1.5 * min(taken[SHORT]) and time.monotonic() < deadline:  # a busy machine
        for frames, own in taken.items():
            own.append(seconds(frames))
    assert min(taken[LONG]) <= 1.5 * min(taken[SHORT]), taken
