"""The web viewer in a real browser: each file of web/tests by Node's test runner, which drives Chromium."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from support import coded_scenes, composed, viewer_scenes

WEB = Path(__file__).parents[2] / "web"
CHROMIUM = os.environ.get("EIGENFIELD_CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
FILES = sorted((WEB / "tests").glob("*.test.mjs"))


def missing() -> str | None:
    """What these tests lack here, with the remedy."""
    if shutil.which("node") is None:
        return "needs Node.js"
    if CHROMIUM is None:
        return "needs Chromium: apt-get install chromium, or name one in EIGENFIELD_CHROMIUM"
    if not (WEB / "node_modules" / "playwright-core").is_dir():
        return "needs playwright-core: npm ci in web/"
    return None


pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("viewer")
    viewer_scenes.write(made)
    composed.write(made)
    coded_scenes.write(made)
    return made


def test_there_are_browser_tests():
    assert len(FILES) >= 5


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name.removesuffix(".test.mjs"))
def test_in_chromium(path, folder):
    surroundings = os.environ | {
        "EIGENFIELD_SCENES": str(folder), "EIGENFIELD_CHROMIUM": str(CHROMIUM), "EIGENFIELD_PYTHON": sys.executable,
    }  # fmt: skip
    done = subprocess.run(
        ["node", "--test", "--test-force-exit", "--test-reporter=spec", str(path)],
        cwd=WEB, env=surroundings, capture_output=True, text=True, timeout=600,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-8000:] + done.stderr[-2000:]
