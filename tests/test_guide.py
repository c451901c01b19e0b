"""Every block of the guide runs as it stands, page by page, or says why not; codes that it explains exist."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from support.captures import write_array, write_capture
from test_readme import look

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "docs/index.md", *sorted((ROOT / "docs/guide").glob("*.md"))]
SHOWN = {"{toctree}"}  # languages of blocks that nobody types in


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
    assert path.read_text("utf-8").count("\n```") == 2 * len(blocks(path))  # none is written in another way
    assert {block.language for block in run_of(path)} <= {"sh", "python", "json"}
    for block in run_of(path):
        if block.language == "json":
            json.loads(block.text)


@pytest.mark.slow
@pytest.mark.parametrize("path", [path for path in PAGES if run_of(path)], ids=lambda path: path.stem)
def test_the_blocks_run(path, tmp_path):
    write_capture(tmp_path / "capture")
    write_array(tmp_path / "photos")
    for name in ("one", "two"):
        write_capture(tmp_path / "captures" / name)
    if "encode" not in path.read_text("utf-8"):  # a page about a scene that is there
        shutil.copy(ROOT / "docs/scene.glb", tmp_path)
    for block in run_of(path):
        if block.language == "sh":
            run_shell(block.text, tmp_path)
        elif block.language == "python":
            done = subprocess.run([sys.executable, "-c", block.text], cwd=tmp_path, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
    assert not (tmp_path / "scenes/failed.txt").exists()


def test_the_codes_that_are_explained_exist():
    page = (ROOT / "docs/guide/troubleshooting.md").read_text("utf-8")
    codes = set(re.findall(r"^\| [^|]+ \| `([a-z-]+)` \|", page, re.MULTILINE))
    source = "\n".join(path.read_text("utf-8") for path in (ROOT / "src/eigenfield").rglob("*.py"))
    assert len(codes) > 8
    assert {code for code in codes if f'"{code}"' not in source} == set()
