"""`eigenfield demo` from nothing, as a new user runs it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.slow
def test_the_demo_leaves_what_it_promises(tmp_path):
    def demo():
        done = subprocess.run(
            [sys.executable, "-m", "eigenfield", "demo", "-o", "my demo"], cwd=tmp_path, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        return done

    first = demo()
    folder = tmp_path / "my demo"
    said = first.stderr.splitlines()
    assert said[0].startswith("this takes about") and "two cores" in said[0]
    assert [line.split(" of ")[0] for line in said if " of 5: " in line] == [f"step {k}" for k in range(1, 6)]
    assert "step 1 of 5: drawing 81 photographs" in first.stderr and "contact-sheet.png" in first.stdout
    assert first.stdout.splitlines()[-1].endswith(str(Path("my demo") / "scene.html"))
    assert len(list((folder / "capture" / "images").iterdir())) == 81
    assert {"capture", "scene.glb", "scene.html", "scene.jpg", "flight.mp4", "evaluation.json", "plots"} == {
        path.name for path in folder.iterdir()
    }
    figures = json.loads((folder / "evaluation.json").read_text())
    assert figures["image"]["encoded"]["psnr"] > 33 and figures["image"]["held_out"]["psnr"] > 31
    assert figures["image"]["encoded"]["coverage"] == 1.0
    before = (folder / "scene.glb").read_bytes()
    again = demo()
    assert "drawing" not in again.stderr  # the capture is used again
    assert (folder / "scene.glb").read_bytes() == before
