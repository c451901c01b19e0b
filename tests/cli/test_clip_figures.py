"""`eigenfield evaluate` of a clip: what it prints, and what it refuses."""

from __future__ import annotations

import json

import pytest

from eigenfield.cli.clip_figures import clip_table, refuse_for_clips
from eigenfield.core.errors import OptionError
from eigenfield.evaluation import evaluate_clip
from support.moving_clips import tiny_clip, write_footage


@pytest.fixture(scope="module")
def figures(tmp_path_factory):
    clip = tiny_clip((3, 2), lambda frame, mean: mean + 0.01 * frame, cameras=9, size=32, held_out=(4,))
    footage = write_footage(clip, tmp_path_factory.mktemp("f") / "f")
    return evaluate_clip(clip, footage, every=2)


def test_figures_are_printed_for_a_person(figures):
    sized = {**figures, "bytes": {"total": 12_345, "kilobytes_a_frame": 2.469, "megabits_a_second": 0.59}}
    lines = clip_table("clip.glb", sized)
    assert lines[0].startswith("clip.glb: 4 of 5 frames, drawn bicubic")  # 0, 2, 3 and 4
    assert lines[3].split() == ["encoded", "(8)", "100.00", "100.00", "1.0000"]
    assert "fifth percentile" in lines[4] and "frame 0" in lines[5]
    assert any(line.startswith("held out (1)") for line in lines)
    assert "encoded: the largest step of PSNR between groups is 0.00 dB, at frame 3" in lines
    assert lines[-1] == "12,345 bytes: 2.5 kB a frame, 0.59 Mbit/s"


def test_what_was_not_measured_is_left_out(figures):
    bare = json.loads(json.dumps(figures))
    bare["image"]["held_out"] = bare["flicker"]["held_out"] = bare["border"]["encoded"] = None
    bare["border"]["held_out"] = None
    lines = clip_table("clip.glb", {**bare, "missing": ["view_03"]})
    assert "held out              none" in lines
    assert not any("step" in line for line in lines)
    assert lines[-1] == "1 cameras have no photograph here: view_03"


def test_options_of_one_instant_are_refused_by_name():
    refuse_for_clips({"curve": False, "workers": None})
    with pytest.raises(OptionError) as error:
        refuse_for_clips({"curve": False, "store": True})
    assert error.value.code == "clip-option"
    assert "--store" in str(error.value)
