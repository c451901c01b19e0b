"""`eigenfield evaluate` of a clip: what it prints, and what it refuses."""

from __future__ import annotations

import json

import cv2
import pytest
from jsonschema import Draft202012Validator

from eigenfield.cli.clip_figures import clip_table, refuse_for_clips
from eigenfield.core.errors import OptionError
from eigenfield.evaluation import evaluate_clip
from eigenfield.gltf import load_clip, save
from eigenfield.imaging.metrics import PSNR_MAX_DECIBELS
from eigenfield.viewer.exports import write_clip_folder
from support import printed
from support.clips import numbered_clip
from support.moving_clips import tiny_clip, write_footage
from support.redrawn import drawn, frame


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


def test_the_json_keeps_to_its_schema(figures):
    Draft202012Validator.check_schema(printed.schema("evaluate-clip"))
    assert printed.violation("evaluate-clip", figures) is None
    assert "new" in str(printed.violation("evaluate-clip", figures | {"new": 1}))


def test_a_file_is_measured_against_a_folder(run, tmp_path):
    save(numbered_clip((2, 2)), tmp_path / "clip.glb")
    clip, entries = load_clip(tmp_path / "clip.glb"), []
    for number, time in enumerate(clip.timeline.times.tolist()):
        scene = clip.scene(time)
        for index, (name, camera) in enumerate(zip(scene.rig.names, scene.rig.cameras, strict=True)):
            path = tmp_path / "f" / name / f"{number:04d}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(path), drawn(scene, index)[..., ::-1])
            entries.append(frame(name, camera) | {"file_path": f"{name}/{number:04d}.png", "time": time})
    (tmp_path / "f" / "transforms.json").write_text(json.dumps({"fps": 10, "frames": entries}))
    given = "evaluate", tmp_path / "clip.glb", tmp_path / "f"
    figures = json.loads(run(*given, "--json", "--flip", "--plots", tmp_path / "plots", "-q").out)
    assert figures["image"]["encoded"]["psnr"] == PSNR_MAX_DECIBELS
    assert figures["image"]["encoded"]["flip"] == 0
    assert figures["bytes"]["total"] == (tmp_path / "clip.glb").stat().st_size
    assert (tmp_path / "plots" / "over-time.png").exists() and (tmp_path / "plots" / "contact-sheet.png").exists()
    write_clip_folder(tmp_path / "clip.glb", tmp_path / "clip")
    same = json.loads(run("evaluate", tmp_path / "clip", tmp_path / "f", "--json", "--flip", "-q").out)
    assert same["image"] == figures["image"] and same["bytes"]["mean"] == figures["bytes"]["mean"]
    again = run(*given, "--plots", tmp_path / "plots")
    assert again.code != 0 and "exists already" in again.err
    assert "--curve" in run(*given, "--curve").err
    few = run(*given, "--every", "3", "-q")
    none = run(*given, "--every", "0", "-q")
    assert none.code == 2 and "each 0 frames" in none.err
    assert "4 of 4 frames" in few.out  # 0 and 3, and both sides of the border
