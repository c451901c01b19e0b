"""The web viewer in browsers: each file of web/tests by Node's test runner, which drives Chromium and two others."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from support import coded_scenes, composed, patched, pinholes, sheet_scenes, splat_scenes, viewer_clips, viewer_scenes
from support.browsers import CHROMIUM, OTHERS, lacks

WEB = Path(__file__).parents[2] / "web"
FILES = sorted((WEB / "tests").glob("*.test.mjs"))
# what needs no browser, and what of web/node_modules it needs
PLAIN = {"structure": None, "languages": None, "clip": "vite", "coding": "vite", "field": "vite"}


def missing(path: Path) -> str | None:
    """What a file of tests lacks here, with the remedy."""
    name = path.name.removesuffix(".test.mjs")
    package = PLAIN.get(name, "playwright-core")
    if shutil.which("node") is None:
        return "needs Node.js"
    if name not in PLAIN and CHROMIUM is None:
        return "needs Chromium: apt-get install chromium, or name one in EIGENFIELD_CHROMIUM"
    if name in OTHERS and (remedy := lacks(name)):
        return remedy
    if package is not None and not (WEB / "node_modules" / package).is_dir():
        return f"needs {package}: npm ci in web/"
    return None


def cases(plain: bool):
    """The files that need no browser, or those that do; each is skipped where it lacks something."""
    found = []
    for path in FILES:
        name, reason = path.name.removesuffix(".test.mjs"), missing(path)
        if (name in PLAIN) == plain:
            found.append(pytest.param(path, id=name, marks=pytest.mark.skipif(reason is not None, reason=str(reason))))
    return found


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("viewer")
    viewer_scenes.write(made)
    viewer_clips.write(made)
    composed.write(made)
    coded_scenes.write(made)
    sheet_scenes.write(made)
    splat_scenes.write(made)
    pinholes.write(made)
    patched.write(made)
    return made


def run_node(path: Path, **surroundings: str) -> None:
    done = subprocess.run(
        ["node", "--test", "--test-force-exit", "--test-reporter=spec", str(path)],
        cwd=WEB, env=os.environ | {"EIGENFIELD_PYTHON": sys.executable} | surroundings,
        capture_output=True, text=True, timeout=600,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-8000:] + done.stderr[-2000:]


def test_there_are_browser_tests():
    assert len(FILES) >= 22


@pytest.mark.parametrize("path", cases(plain=True))
def test_in_node(path):
    run_node(path)


@pytest.mark.parametrize("path", cases(plain=False))
@pytest.mark.slow
def test_in_browser(path, folder):
    run_node(path, EIGENFIELD_SCENES=str(folder), EIGENFIELD_CHROMIUM=str(CHROMIUM))
