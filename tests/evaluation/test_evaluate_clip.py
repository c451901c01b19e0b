"""Clips against footage that was drawn from them, so that every figure has a known answer."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from eigenfield.core.clip import Timeline
from eigenfield.core.errors import CaptureError, OptionError, OutputError
from eigenfield.evaluation.clip import evaluate_clip
from eigenfield.evaluation.strip import STRIP_FILE, write_strip
from eigenfield.imaging.metrics import PSNR_MAX_DECIBELS
from support.clips import moving_clip, numbered_clip
from support.moving_clips import Instants, tiny_clip, write_footage
from support.viewer_clips import front_steps

HELD = (4,)
TEN_LEVELS = 20 * np.log10(25.5)  # dB


def brighter(frame, mean):
    """The left third of the atlas turns brighter from frame to frame."""
    changed = mean.copy()
    changed[:, : mean.shape[1] // 3] += 0.05 * frame
    return changed


@pytest.fixture
def clip():
    return tiny_clip((3, 2), brighter, cameras=9, size=48, held_out=HELD)


def ten_levels(picture):
    return np.where(picture < 128, picture + 10, picture - 10).astype(np.uint8)


def test_a_clip_against_its_own_pictures_is_perfect(clip, tmp_path):
    figures = evaluate_clip(clip, write_footage(clip, tmp_path / "f"))
    for kind, cameras in (("encoded", 8), ("held_out", 1)):
        part = figures["image"][kind]
        assert (part["cameras"], part["pictures"]) == (cameras, 5 * cameras)
        assert part["psnr"] == part["psnr_luma"] == part["fifth"]["psnr"] == PSNR_MAX_DECIBELS
        assert part["ssim"] == part["worst"]["ssim"]["value"] == 1
        assert figures["flicker"][kind]["still"] == 0
        assert figures["flicker"][kind]["moving_ssim"] == 1
        assert 0 < figures["flicker"][kind]["still_share"] < 1
        assert figures["border"][kind] == {"step": 0, "frame": 3}
    assert figures["measured"] == figures["frames"] == 5
    assert figures["bytes"] is None and figures["missing"] == []
    assert [frame["time"] for frame in figures["over_time"]] == pytest.approx([n / 30 for n in range(5)], abs=1e-6)
    assert figures["group_times"] == pytest.approx([0, 0.1])
    json.dumps(figures, allow_nan=False)


def test_a_clip_whose_sheets_move_against_its_own_pictures_is_perfect(tmp_path):
    clip = moving_clip(numbered_clip((2, 2), sheets=True), front_steps)
    figures = evaluate_clip(clip, write_footage(clip, tmp_path / "f"))
    assert figures["image"]["encoded"]["psnr"] == PSNR_MAX_DECIBELS and figures["measured"] == 4
    assert figures["flicker"]["encoded"]["still"] < 0.1  # of a level: photographs are rounded
    assert figures["flicker"]["encoded"]["moving_ssim"] > 0.999


@pytest.mark.parametrize(("at", "kind"), [(2, "encoded"), (HELD[0], "held_out")])
def test_an_offset_of_ten_levels_is_found_in_its_frame_and_camera(clip, tmp_path, at, kind):
    def change(frame, camera, picture):
        return ten_levels(picture) if (frame, camera) == (3, at) else picture

    figures = evaluate_clip(clip, write_footage(clip, tmp_path / "f", change))
    part = figures["image"][kind]
    name = clip.rig.names[at]
    assert part["worst"]["psnr"] == {"value": pytest.approx(TEN_LEVELS, abs=1e-5), "camera": name, "frame": 3}
    lost = (PSNR_MAX_DECIBELS - TEN_LEVELS) / part["cameras"]
    assert part["psnr"] == pytest.approx(PSNR_MAX_DECIBELS - lost / 5, abs=1e-5)
    assert figures["over_time"][3][kind]["psnr"] == pytest.approx(PSNR_MAX_DECIBELS - lost, abs=1e-5)
    assert figures["over_time"][3][kind]["psnr_worst"] == pytest.approx(TEN_LEVELS, abs=1e-5)
    assert figures["border"][kind] == {"step": pytest.approx(lost, abs=1e-5), "frame": 3}
    other = {"encoded": "held_out", "held_out": "encoded"}[kind]
    assert figures["image"][other]["psnr"] == PSNR_MAX_DECIBELS
    one = next(camera for camera in figures["cameras"] if camera["name"] == name)
    assert one["psnr"] == pytest.approx(PSNR_MAX_DECIBELS - (PSNR_MAX_DECIBELS - TEN_LEVELS) / 5, abs=1e-5)


def test_the_fifth_percentile_is_of_pictures(clip, tmp_path):
    """Three of 40 pictures are worse, and the fifth percentile lies between the second and the third of all."""

    def change(frame, camera, picture):
        return ten_levels(picture) if (frame, camera) in {(0, 0), (1, 1), (2, 2)} else picture

    part = evaluate_clip(clip, write_footage(clip, tmp_path / "f", change))["image"]["encoded"]
    expected = np.percentile([TEN_LEVELS] * 3 + [PSNR_MAX_DECIBELS] * 37, 5)
    assert part["fifth"]["psnr"] == pytest.approx(expected, abs=1e-5)


def test_a_clip_that_flickers_is_caught_where_the_photographs_stand_still(tmp_path):
    still = tiny_clip((4,), cameras=4, size=48)
    footage = write_footage(still, tmp_path / "f")
    flickers = tiny_clip((4,), lambda frame, mean: mean + (0.02 if frame % 2 else -0.02), cameras=4, size=48)
    figures = evaluate_clip(flickers, footage)
    assert figures["flicker"]["encoded"]["still"] == pytest.approx(0.02 * 255, rel=0.03)
    assert figures["flicker"]["encoded"]["still_share"] == 1
    assert figures["flicker"]["held_out"] is None
    assert evaluate_clip(still, footage)["flicker"]["encoded"]["still"] == 0


def test_a_photograph_without_a_valid_pixel_does_not_count(clip, tmp_path):
    """A camera that has stopped repeats its last frame under a mask of zeros."""

    def masks(frame, camera):
        return np.full((40, 48), 0 if (frame, camera) == (2, 1) else 255, np.uint8)

    def change(frame, camera, picture):
        return np.zeros_like(picture) if (frame, camera) == (2, 1) else picture

    figures = evaluate_clip(clip, write_footage(clip, tmp_path / "f", change, masks))
    assert figures["image"]["encoded"]["psnr"] == PSNR_MAX_DECIBELS
    assert figures["flicker"]["encoded"]["still"] == 0


def test_each_second_frame_and_both_sides_of_a_border_are_measured(tmp_path):
    clip = tiny_clip((4, 5), cameras=3, size=32)
    figures = evaluate_clip(clip, write_footage(clip, tmp_path / "f"), every=5)
    assert [frame["frame"] for frame in figures["over_time"]] == [0, 3, 4, 5]
    assert figures["measured"] == 4


def test_frames_are_found_by_their_time(clip, tmp_path):
    """Footage of the double rate that begins earlier."""
    own = write_footage(clip, tmp_path / "f", lambda frame, camera, picture: picture)
    wrong = write_footage(tiny_clip((5,), lambda frame, mean: 1 - mean, cameras=9, size=48), tmp_path / "g")
    captures = [wrong.captures[0]] * 12
    captures[2::2] = own.captures
    footage = Instants(Timeline(60 * clip.timeline.rate / 30, 12, -1 / 30), tuple(captures))
    assert evaluate_clip(clip, footage)["image"]["encoded"]["psnr"] == PSNR_MAX_DECIBELS


def test_what_does_not_fit_is_refused(clip, tmp_path):
    footage = write_footage(clip, tmp_path / "f")
    with pytest.raises(OptionError) as error:
        evaluate_clip(clip, footage, every=0)
    assert error.value.code == "every"
    with pytest.raises(OptionError) as error:
        evaluate_clip(clip, footage, textures=4)
    assert error.value.code == "textures"
    with pytest.raises(OptionError) as error:
        evaluate_clip(clip, Instants(Timeline(clip.timeline.rate, 3), footage.captures[:3]))
    assert error.value.code == "time"
    with pytest.raises(OptionError, match="--rate") as error:
        evaluate_clip(clip, Instants(Timeline(clip.timeline.rate * 5 / 4, 7), footage.captures + footage.captures[:2]))
    assert error.value.code == "time"
    other = tiny_clip((5,), cameras=9, size=48)
    names = tuple(f"other_{name}" for name in other.rig.names)
    with pytest.raises(CaptureError) as error:
        evaluate_clip(replace(other, rig=replace(other.rig, names=names)), footage)
    assert error.value.code == "no-photographs"


def test_the_documentation_defines_every_figure_of_a_clip(clip, tmp_path):
    text = (Path(__file__).parents[2] / "docs" / "measures.md").read_text(encoding="utf-8")
    table = text.split("\n## Clips\n")[1].split("\n## ")[0]
    defined = set(re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE))
    figures = evaluate_clip(clip, write_footage(clip, tmp_path / "f"))
    elsewhere = {"schema", "textures", "filter", "weights", "missing", "seconds"}
    assert defined == (set(figures) - elsewhere) | set(figures["flicker"]["encoded"])


def test_the_strip_chart_is_a_picture_that_is_not_replaced_unasked(clip, tmp_path):
    figures = evaluate_clip(clip, write_footage(clip, tmp_path / "f"))
    path = write_strip(figures, tmp_path / "plots")
    assert path == tmp_path / "plots" / STRIP_FILE
    assert path.read_bytes().startswith(b"\x89PNG")
    with pytest.raises(OutputError) as error:
        write_strip(figures, tmp_path / "plots")
    assert error.value.code == "output-exists"
    write_strip(figures, tmp_path / "plots", overwrite=True)
