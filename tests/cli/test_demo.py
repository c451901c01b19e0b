"""`eigenfield demo` from nothing, as a new user runs it."""

from __future__ import annotations

import json
import subprocess
import sys

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
    assert "drawing 289 photographs" in first.stderr and "contact-sheet.png" in first.stdout
    assert len(list((folder / "capture" / "images").iterdir())) == 289
    assert {"capture", "scene.glb", "flight.mp4", "evaluation.json", "plots"} == {
        path.name for path in folder.iterdir()
    }
    figures = json.loads((folder / "evaluation.json").read_text())
    assert figures["image"]["encoded"]["psnr"] > 35 and figures["image"]["held_out"]["psnr"] > 34
    assert figures["image"]["encoded"]["coverage"] == 1.0
    before = (folder / "scene.glb").read_bytes()
    again = demo()
    assert "drawing" not in again.stderr  # the capture is used again
    assert (folder / "scene.glb").read_bytes() == before
