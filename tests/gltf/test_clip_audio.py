"""Sound in the file of a clip: kept as it is, checked, and left out of a file that ends before it does."""

from __future__ import annotations

from dataclasses import replace

import pytest

from eigenfield.core.clip import Audio
from eigenfield.gltf import load_clip, parts, save, validate
from support import glb_surgery
from support.clips import groups_of, numbered_clip
from support.glb_surgery import outcome
from support.sounds import opus

SOUND = opus(0.5)


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("sound") / "clip.glb"
    save(replace(numbered_clip((2, 3)), audio=Audio(SOUND, 0.25)), path)
    return path


def changed(path, change):
    """The file with another timeline."""
    data = path.read_bytes()
    gltf, binary = glb_surgery.split(data)
    change(gltf["extensions"][glb_surgery.EXTENSION]["timeline"])
    return glb_surgery.join(gltf, binary, glb_surgery.behind(data))


def test_a_sound_is_kept_byte_for_byte(path, tmp_path):
    clip = load_clip(path)
    assert clip.audio.data == SOUND and clip.audio.first == 0.25
    assert validate(path) == []
    save(clip, tmp_path / "again.glb")
    assert (tmp_path / "again.glb").read_bytes() == path.read_bytes()
    silent = numbered_clip((2, 3))
    save(silent, tmp_path / "silent.glb")
    assert load_clip(tmp_path / "silent.glb").audio is None
    assert groups_of(path.read_bytes()) == groups_of((tmp_path / "silent.glb").read_bytes())
    more = parts(path)["other"] - parts(tmp_path / "silent.glb")["other"]
    assert len(SOUND) <= more < len(SOUND) + 200


def test_a_file_that_ends_within_its_sound_is_a_silent_clip(path, tmp_path, caplog):
    cut = tmp_path / "cut.glb"
    cut.write_bytes(path.read_bytes()[: -len(SOUND) // 2])
    clip = load_clip(cut)
    assert clip.audio is None and "the file ends within its sound" in caplog.text
    assert clip.scene(float(clip.timeline.times[-1])).proxy.mesh is not None


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda timeline: timeline["audio"].update(mimeType="audio/mpeg"), "audio-unknown"),
        (lambda timeline: timeline["audio"].update(offset=0), "group-range"),
        (lambda timeline: timeline["audio"].update(length=2**20), "group-range"),
        (lambda timeline: timeline["audio"].update(offset=timeline["audio"]["offset"] + 2), "group-range"),
        (lambda timeline: timeline["audio"].update(length=0), "json-value"),
        (lambda timeline: timeline["audio"].update(offset=timeline["audio"]["offset"] + 4, length=8), "audio-unknown"),
    ],
)
def test_a_sound_that_cannot_be_is_refused_by_its_code(path, tmp_path, change, code):
    assert outcome(tmp_path / "a.glb", changed(path, change), load_clip) == code
