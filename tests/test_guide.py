"""Every block of the documentation runs as it stands, page by page, or says why not; codes that it explains exist."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
import sys
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

import cv2
import pytest
import trimesh
from markdown_it import MarkdownIt

import eigenfield as ef
from eigenfield.calibration.charts.board import charuco
from eigenfield.capture.writers.save import save_calibration
from support import charts
from support.captures import write_array, write_capture
from support.motion import K, film, photographed
from test_readme import look

ROOT = Path(__file__).parents[1]
PAGES = [*sorted((ROOT / "docs").rglob("*.md")), ROOT / "web/eigenfield-three/README.md"]
SHOWN = {"{toctree}", "{eval-rst}", "html", "text"}  # languages of blocks that nobody types in
ELSEWHERE = {"usage"}  # run by test_readme.py


class Block(NamedTuple):
    language: str
    text: str
    reason: str  # why it does not run; empty where it does


def blocks(path: Path) -> list[Block]:
    found = re.findall(
        r"^(?:<!-- not run: (.+?) -->\n)?```(\S+)\n(.*?)^```$", path.read_text("utf-8"), re.MULTILINE | re.DOTALL
    )
    return [Block(language, text, reason) for reason, language, text in found]


def run_of(path: Path) -> list[Block]:
    return [block for block in blocks(path) if not block.reason and block.language not in SHOWN]


def run_shell(text: str, place: Path) -> None:
    """A block of shell, with `eigenfield` as this interpreter's; what `view` shows is asked for once."""
    viewed = [line for line in text.splitlines() if line.startswith("eigenfield view")]
    rest = "\n".join(line for line in text.splitlines() if line not in viewed)
    program = f'eigenfield() {{ "{sys.executable}" -m eigenfield "$@"; }}\n'
    done = subprocess.run(["bash", "-euc", program + rest], cwd=place, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    for line in viewed:
        look(shlex.split(line, comments=True), place)


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_every_block_is_run_or_says_why_not(path):
    text = path.read_text("utf-8")
    assert text.count("\n```") == 2 * len(blocks(path))  # none is written in another way
    assert not [token.content for token in MarkdownIt().parse(text) if token.type == "code_block"]  # by four spaces
    assert {block.language for block in run_of(path)} <= {"sh", "python", "json"}
    for block in run_of(path):
        if block.language == "json":
            json.loads(block.text)


def prepare(page: str, place: Path) -> None:
    """What the commands of a page find there."""
    if page == "calibration":
        photographed(place / "photos")
        cameras = charts.rig(2, spacing=150, distance=500)
        charts.write_charts(
            place / "charts", charts.CHECKER, cameras, charts.board_poses(charts.CHECKER, 8, seed=2, spread=50)
        )
        board = charuco(4, 5, 54, 40.5, "DICT_4X4_1000", "mm")
        charts.write_videos(
            place / "videos", board, cameras, charts.board_poses(board, 8, seed=4, spread=30), inverted=True
        )
        (place / "videos/charuco.toml").write_text(charts.TOML)
        lens = cv2.FileStorage(str(place / "lens.yml"), cv2.FILE_STORAGE_WRITE)
        lens.write("camera_matrix", K)
        lens.release()
        return
    if page == "captures":
        _, given = photographed(place / "photos")
        save_calibration(given, place / "model")
        (place / "model/sparse").rename(place / "sparse")
        write_array(place / "grid")
        film(place / "walk.mp4", 12)
        ef.export(ef.load(ROOT / "docs/scene.glb"), place / "quilt.png", kind="quilt", resolution=(96, 96))
    capture = write_capture(place / "capture")
    trimesh.load(capture / "proxy.ply", process=False).export(capture / "proxy.obj")
    if page != "captures":
        write_array(place / "photos")
    for name in ("one", "two"):
        write_capture(place / "captures" / name)
    if page == "viewer":
        shutil.copytree(capture, place / "photographs")
        ef.save(ef.encode(capture, proxy=capture / "proxy.ply", fit="none"), place / "scene.glb")
    elif page in ("exports", "publish", "measure-and-compare", "scene-as-numpy"):
        for name in ("tarot", "fern", *([] if page == "measure-and-compare" else ["scene"])):
            shutil.copy(ROOT / "docs/scene.glb", place / f"{name}.glb")


@pytest.mark.slow
@pytest.mark.parametrize(
    "path", [path for path in PAGES if run_of(path) and path.stem not in ELSEWHERE], ids=lambda path: path.stem
)
def test_the_blocks_run(path, tmp_path):
    prepare(path.stem, tmp_path)
    for language, several in groupby(run_of(path), lambda block: block.language):
        text = "\n".join(block.text for block in several)  # what a block names, those below it use
        if language == "sh":
            run_shell(text, tmp_path)
        elif language == "python":
            done = subprocess.run([sys.executable, "-c", text], cwd=tmp_path, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
    assert not (tmp_path / "scenes/failed.txt").exists()


def test_the_codes_that_are_explained_exist():
    page = (ROOT / "docs/guide/troubleshooting.md").read_text("utf-8")
    codes = set(re.findall(r"^\| [^|]+ \| `([a-z-]+)` \|", page, re.MULTILINE))
    source = "\n".join(path.read_text("utf-8") for path in (ROOT / "src/eigenfield").rglob("*.py"))
    assert len(codes) > 8
    assert {code for code in codes if f'"{code}"' not in source} == set()
