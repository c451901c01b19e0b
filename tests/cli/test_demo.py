"""`eigenfield demo` from nothing, as a new user runs it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from eigenfield.demo import draw_demo_capture, draw_demo_clip
from eigenfield.gltf import load_clip

FILES = {"capture", "scene.glb", "scene.html", "scene.jpg", "flight.mp4", "evaluation.json", "plots"}


@pytest.mark.slow
def test_the_demo_leaves_what_it_promises(tmp_path):
    words = [sys.executable, "-m", "eigenfield", "demo", "-o", "my demo"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "my demo"
    said = done.stderr.splitlines()
    assert said[0].startswith("this takes about") and "two cores" in said[0]
    assert [line.split(" of ")[0] for line in said if " of 5: " in line] == [f"step {k}" for k in range(1, 6)]
    assert "step 1 of 5: drawing 81 photographs" in done.stderr and "contact-sheet.png" in done.stdout
    assert done.stdout.splitlines()[-1].endswith(str(Path("my demo") / "scene.html"))
    assert len(list((folder / "capture" / "images").iterdir())) == 81
    assert {path.name for path in folder.iterdir()} == FILES
    figures = json.loads((folder / "evaluation.json").read_text())
    assert figures["image"]["encoded"]["psnr"] > 33 and figures["image"]["held_out"]["psnr"] > 31
    assert figures["image"]["encoded"]["coverage"] == 1.0


@pytest.mark.slow
def test_a_capture_that_is_there_is_used_again(run, tmp_path):
    folder = tmp_path / "my demo"
    folder.mkdir()
    draw_demo_capture(folder / "capture", rows=3, columns=5, size=64)
    made = []
    for _ in range(2):
        done = run("demo", "-o", folder)
        assert done.code == 0, done.err
        assert "drawing" not in done.err and "step 1 of 5: photographs that are there" in done.err
        made.append((folder / "scene.glb").read_bytes())
    assert made[0] == made[1] and {path.name for path in folder.iterdir()} == FILES


CLIP_FILES = {"footage", "clip.glb", "clip.html", "clip.jpg", "clip.work", "flight.mp4", "evaluation.json", "plots"}


@pytest.mark.slow
def test_a_clip_of_footage_that_is_there(run, tmp_path):
    folder = tmp_path / "my clip"
    draw_demo_clip(folder / "footage", rows=2, columns=3, size=48, frames=3)
    done = run("demo", "--clip", "-o", folder)
    assert done.code == 0, done.err
    said = done.err.splitlines()
    assert said[0].startswith("this takes about") and "two cores" in said[0]
    assert [line.split(" of ")[0] for line in said if " of 5: " in line] == [f"step {k}" for k in range(1, 6)]
    assert "step 1 of 5: footage that is there" in done.err and "drawing 30 frames" not in done.err
    assert "contact-sheet.png" in done.out and done.out.splitlines()[-1].endswith(str(folder / "clip.html"))
    assert {path.name for path in folder.iterdir()} == CLIP_FILES
    assert {path.name for path in (folder / "plots").iterdir()} == {"over-time.png", "contact-sheet.png"}
    clip = load_clip(folder / "clip.glb")
    assert clip.timeline.frames == 3 and len(clip.rig.names) == 6
    figures = json.loads((folder / "evaluation.json").read_text())
    assert figures["image"]["encoded"]["psnr"] > 22 and figures["image"]["encoded"]["coverage"] == 1.0
    before = (folder / "clip.glb").read_bytes()
    assert run("demo", "--clip", "-o", folder, "-q").code == 0
    assert (folder / "clip.glb").read_bytes() == before


@pytest.mark.parametrize("kind", [(), ("--clip",)])
def test_a_file_in_place_of_the_folder_is_said(run, tmp_path, kind):
    (tmp_path / "x").write_text("")
    done = run("demo", *kind, "-o", tmp_path / "x")
    assert done.code == 2 and "is a file" in done.err


@pytest.mark.slow
def test_the_clip_is_good_at_its_own_size(run, tmp_path):
    """Three frames of the thirty, which turn as far: what moves is drawn where it is."""
    folder = tmp_path / "demo-clip"
    draw_demo_clip(folder / "footage", frames=3)
    assert len(list((folder / "footage").glob("mesh_*.ply"))) == 3
    assert len(list((folder / "footage").glob("cam_*/*.png"))) == 75
    done = run("demo", "--clip", "-o", folder)
    assert done.code == 0, done.err
    clip = load_clip(folder / "clip.glb")
    assert clip.timeline.frames == 3 and len(clip.rig.names) == 25
    figures = json.loads((folder / "evaluation.json").read_text())
    assert figures["image"]["encoded"]["psnr"] > 32 and figures["image"]["held_out"]["psnr"] > 29
