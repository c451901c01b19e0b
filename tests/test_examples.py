"""The examples run, one after the other in one folder, and leave what they say."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[1] / "examples"
MADE = {
    "01_encode_folder": ["scene.glb"],
    "02_render_views": ["camera.png", "between.png", "flight.mp4"],
    "03_the_paper": ["maps/mean.png", "texture.png"],
    "04_embed_in_page": ["scene.html", "index.html"],
    "05_batch": ["scenes/index.html"],
    "06_workers": ["shared/index.html"],
}


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    return tmp_path_factory.mktemp("examples")


@pytest.mark.slow
@pytest.mark.parametrize("name", MADE)
def test_an_example_runs(name, place):
    done = subprocess.run([sys.executable, EXAMPLES / f"{name}.py", place], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout and all((place / path).stat().st_size for path in MADE[name])


def test_each_example_says_what_it_shows():
    files = sorted(EXAMPLES.glob("0*.py"))
    assert [path.stem for path in files] == list(MADE)
    for path in files:
        text = path.read_text("utf-8")
        assert f"python examples/{path.name} [FOLDER]" in text.split('"""')[1], path
        assert len(text.splitlines()) < 70, path
