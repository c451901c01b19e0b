"""The documents hold: blocks run or say why not, links lead somewhere, and lists are those of the program."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
import urllib.request
from collections.abc import Callable
from datetime import datetime
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

import click
import cv2
import pytest
import trimesh
from markdown_it import MarkdownIt

import eigenfield as ef
import measure
from eigenfield.calibration.charts.board import charuco
from eigenfield.capture.writers.save import save_calibration
from eigenfield.cli import VERBS, group
from eigenfield.cli.encode import command as encode_command
from support import charts, light_fields
from support.captures import write_array, write_capture
from support.motion import K, film, photographed

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), ROOT / "web/eigenfield-three/README.md"]
SHOWN = {"{toctree}", "{eval-rst}", "bibtex", "html", "text"}  # languages of blocks that nobody types in
NUMBER = re.compile(r"(?<![\w.])[-+−]?\d+(?:[.,]\d+)*")
OURS = re.compile(r"(?:(?:eigenfield [^>|\n]*)?\n?)*")  # commands of ours and nothing else of the shell's
MADE = {  # what is there when the commands of a page have run
    "README": {"scene.glb", "scene.html"},
    "usage": {
        "overlay.png", "scene.glb", "small.glb", "paper.glb", "view.png", "flight.mp4", "redrawn", "plots", "mesh.glb",
        "mesh.cameras", "draft.glb", "photos.glb",
    },
}  # fmt: skip


def page(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


# -- blocks -----------------------------------------------------------------------------------------------------------


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


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_every_block_is_run_or_says_why_not(path):
    text = path.read_text("utf-8")
    assert text.count("\n```") == 2 * len(blocks(path))  # none is written in another way
    assert not [token.content for token in MarkdownIt().parse(text) if token.type == "code_block"]  # by four spaces
    assert {block.language for block in run_of(path)} <= {"sh", "python", "json"}
    for block in run_of(path):
        if block.language == "json":
            json.loads(block.text)


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, id=path.stem, marks=[pytest.mark.slow] * (path.stem != "README"))
        for path in PAGES
        if run_of(path)
    ],
)
def test_the_blocks_run(path, tmp_path, run, monkeypatch):
    monkeypatch.chdir(tmp_path)
    prepare(path.stem, tmp_path)
    ran = 0
    for language, several in groupby(run_of(path), lambda block: block.language):
        text = "\n".join(block.text for block in several)  # what a block names, those below it use
        if language == "sh" and (path.stem in MADE or OURS.fullmatch(text)):
            ran += run_commands(text, tmp_path, run)
        elif language == "sh":
            ran += run_shell(text, tmp_path)
        elif path.stem == "README":
            (tmp_path / "scene.glb").unlink()  # of the commands above
            exec(text, {})
            ran += 1
        elif language == "python":
            done = subprocess.run([sys.executable, "-c", text], cwd=tmp_path, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            ran += 1
    assert ran or not any(block.language in ("sh", "python") for block in run_of(path))
    assert MADE.get(path.stem, set()) <= {path.name for path in tmp_path.iterdir()}
    assert not (tmp_path / "scenes/failed.txt").exists()


def run_commands(text: str, place: Path, run: Callable) -> int:
    """The lines that are commands of ours, in this process, which has its kernels; how many there are."""
    lines = [line for line in text.splitlines() if line.startswith("eigenfield ")]
    for line in lines:
        words = shlex.split(line, comments=True)
        if "--path" in words:
            words += ["--frames", "4"]
        if words[1] == "view":
            look(words, place)
            continue
        code, _, err = run(*words[1:])
        assert code == 0, f"{line}\n{err}"
    return len(lines)


def run_shell(text: str, place: Path) -> int:
    """A block of shell, with `eigenfield` as this interpreter's; what `view` shows is asked for once."""
    viewed = [line for line in text.splitlines() if line.startswith("eigenfield view")]
    rest = "\n".join(line for line in text.splitlines() if line not in viewed)
    program = f'eigenfield() {{ "{sys.executable}" -m eigenfield "$@"; }}\n'
    done = subprocess.run(["bash", "-euc", program + rest], cwd=place, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    for line in viewed:
        look(shlex.split(line, comments=True), place)
    return len(text.splitlines())


def look(words: list[str], place: Path) -> None:
    """`eigenfield view` serves until it is stopped."""
    command = [sys.executable, "-m", *words, "--no-browser"]
    process = subprocess.Popen(command, cwd=place, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        address = process.stdout.readline().strip()
        assert address, process.stderr.read()
        with urllib.request.urlopen(address + "scene.glb", timeout=20) as answer:
            assert answer.read(4) == b"glTF"
    finally:
        process.terminate()
        _, err = process.communicate(timeout=20)
    assert process.returncode == 0, err


def prepare(name: str, place: Path) -> None:
    """What the commands of a page find there."""
    if name == "calibration":
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
    if name == "captures":
        _, given = photographed(place / "photos")
        save_calibration(given, place / "model")
        (place / "model/sparse").rename(place / "sparse")
        write_array(place / "grid")
        film(place / "walk.mp4", 6)
        ef.export(ef.load(ROOT / "docs/scene.glb"), place / "quilt.png", kind="quilt", resolution=(64, 64))
        light_fields.write_eslf(place / "flowers_eslf.png", light_fields.light_field(14, 14))
        light_fields.write_toolbox(place / "Bikes__Decoded.mat", light_fields.light_field(7, 7))
        (place / "buddha").mkdir()
        light_fields.write_old_hci(place / "buddha/lf.h5", light_fields.light_field(3, 3))
    capture = write_capture(place / "capture")
    trimesh.load(capture / "proxy.ply", process=False).export(capture / "proxy.obj")
    if name != "captures":
        write_array(place / "photos")
    for one in ("one", "two"):
        write_capture(place / "captures" / one)
    if name == "viewer":
        shutil.copytree(capture, place / "photographs")
        ef.save(ef.encode(capture, proxy=capture / "proxy.ply", fit="none"), place / "scene.glb")
        shutil.copy(place / "scene.glb", place / "smaller.glb")
    elif name in ("exports", "publish", "measure-and-compare", "scene-as-numpy"):
        for one in ("tarot", "fern", *([] if name == "measure-and-compare" else ["scene"])):
            shutil.copy(ROOT / "docs/scene.glb", place / f"{one}.glb")


# -- lists ------------------------------------------------------------------------------------------------------------


def options_of_usage() -> set[str]:
    table = page("docs/usage.md").split("## Options of `encode`\n")[1].split("\n## ")[0]
    return set(re.findall(r"`[^`]*?(--[a-z-]+)", "\n".join(re.findall(r"^\| (.*?) \|", table, re.MULTILINE))))


def options_of_encode() -> set[str]:
    common = {"--help", "--output", "--overwrite", "--quiet", "--threads", "--traceback", "--verbose"}
    shown = [option for option in encode_command.params if not getattr(option, "hidden", False)]
    known = {word for option in shown for word in (*option.opts, *option.secondary_opts)}
    return {word for word in known if word.startswith("--")} - common


def commands_of_reference() -> set[tuple[str, str]]:
    """Of the page that docs/_ext/commands.py makes: command, option."""
    sys.path.insert(0, str(ROOT / "docs/_ext"))
    try:
        from commands import help_page
    finally:
        sys.path.pop(0)
    sections = re.split(r"^## (\w+)$", help_page(), flags=re.MULTILINE)[1:]
    texts = dict(zip(sections[::2], sections[1::2], strict=True))
    return {
        (name, word)
        for name, text in texts.items()
        for word in re.findall(r"-[\w-]+", "\n".join(re.findall(r"^`(-.*)`$", text, re.MULTILINE)))
    }


def options_of_commands() -> set[tuple[str, str]]:
    found = set()
    for name in VERBS:
        params = group.get_command(click.Context(group), name).params
        options = [param for param in params if isinstance(param, click.Option) and not param.hidden]
        found |= {(name, word) for option in options for word in option.opts}
    return found


def required() -> set[str]:
    """What pyproject.toml asks for; packaging/requirements-*.txt pin what linting and releasing need."""
    project = tomllib.loads(page("pyproject.toml"))["project"]
    extras = [needs for name, needs in project["optional-dependencies"].items() if name not in ("lint", "release")]
    wanted = [*project["dependencies"], *(need for needs in extras for need in needs)]
    return {re.split(r"[<>=\[]", requirement)[0].lower() for requirement in wanted}


def pinned() -> set[str]:
    return {line.split("==")[0].lower().replace("_", "-") for line in page("constraints.txt").split()}


def codes() -> set[str]:
    source = "\n".join(path.read_text("utf-8") for path in (ROOT / "src/eigenfield").rglob("*.py"))
    return set(re.findall(r'"([a-z]+(?:-[a-z]+)*)"', source))


# what a document names, what the program has, and whether the program may have more
LISTS: dict[str, tuple[Callable[[], set], Callable[[], set], bool]] = {
    "options of encode in docs/usage.md": (options_of_usage, options_of_encode, False),
    "options in the reference of commands": (options_of_commands, commands_of_reference, True),
    "names in docs/reference/python.md": (
        lambda: set(re.findall(r"^\.\. auto(?:function|class):: (\w+)$", page("docs/reference/python.md"), re.M)),
        lambda: set(ef.__all__) - {"__version__"},
        False,
    ),
    "targets of make in README.md": (
        lambda: set(re.findall(r"`make ([a-z]+)`", page("README.md"))),
        lambda: set(re.findall(r"^([a-z-]+):", page("Makefile"), re.MULTILINE)),
        True,
    ),
    "codes in docs/guide/troubleshooting.md": (
        lambda: set(re.findall(r"^\| [^|]+ \| `([a-z-]+)` \|", page("docs/guide/troubleshooting.md"), re.MULTILINE)),
        codes,
        True,
    ),
    "requirements in constraints.txt": (required, pinned, True),
    "versions of the hooks": (
        lambda: set(re.findall(r"\w+==[\d.]+", page(".pre-commit-config.yaml"))),
        lambda: set(page("constraints.txt").split()),
        True,
    ),
    "decisions in their index": (
        lambda: set(re.findall(r"\]\((\d+[\w-]*\.md)\)", page("docs/decisions/index.md"))),
        lambda: {path.name for path in (ROOT / "docs/decisions").glob("0*.md")},
        False,
    ),
    "examples in their page": (
        lambda: set(re.findall(r"examples/(\w+\.py)", page("docs/python.md"))),
        lambda: {path.name for path in (ROOT / "examples").glob("0*.py")},
        False,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", LISTS)
def test_a_list_is_the_programs(name):
    named, known, more = LISTS[name]
    assert named() and named() - known() == set()
    assert more or known() - named() == set()


def test_links_lead_somewhere():
    pages = [*PAGES, ROOT / "CHANGELOG.md"]
    links = [(path, to) for path in pages for to in re.findall(r"\]\(([^)#\s]+)", path.read_text("utf-8"))]
    assert len(links) > 300
    lost = [(path.name, to) for path, to in links if not to.startswith("http") and not (path.parent / to).exists()]
    assert lost == []


def test_the_lists_of_contributing_name_what_there_is():
    """Files, tests, and for a step of a source file the constants and private functions in it."""
    text = page("docs/contributing.md")
    paths = re.findall(r"`((?:src|tests|docs|web|benchmarks)/[\w/.-]+)`", text)
    assert [path for path in paths if "NEW" not in path and not (ROOT / path).exists()] == []
    tests = "".join(path.read_text("utf-8") for path in (ROOT / "tests").rglob("test_*.py"))
    assert [name for name in re.findall(r"`(test_\w+)`", text) if f"def {name}(" not in tests] == []
    steps = re.findall(r"^\d\. `([\w/.-]+\.(?:py|ts))`(.*?)(?=^\d\. |^#|\n\n)", text, re.MULTILINE | re.DOTALL)
    assert len(steps) > 15
    words = [(path, word) for path, step in steps for word in re.findall(r"`([A-Z][A-Z_]+|_\w+)`", step)]
    assert [word for word in words if "NEW" not in word[0] and word[1] not in page(word[0])] == []


def test_the_readme_and_the_evaluation_are_short():
    """A bullet of the evaluation has at most 40 words and three numbers; all else is a row of docs/benchmarks.md."""
    assert len(page("README.md").splitlines()) <= 120
    bullets = re.findall(r"^- (.*?)(?=\n- |\n\n|\Z)", page("docs/evaluation.md"), re.MULTILINE | re.DOTALL)
    assert len(bullets) > 20
    shown = [re.sub(r"\]\([^)]*\)|`[^`]*`|(?<=\[decision) \d+", "", bullet) for bullet in bullets]
    assert [bullet for bullet in shown if len(bullet.split()) > 40 or len(NUMBER.findall(bullet)) > 3] == []


@pytest.mark.parametrize("program", ["benchmarks/tables.py", "packaging/errors.py"])
def test_what_is_made_is_current(program):
    """Tables of README.md and docs/benchmarks.md; docs/errors.md."""
    done = subprocess.run([sys.executable, str(ROOT / program), "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_results_say_where_they_come_from():
    names = [path.stem for path in measure.RESULTS.glob("*.json")]
    assert "encode" in names
    for name in names:
        runs = measure.runs(name)  # each with date, commit, machine and command, or this says which has not
        dates = [datetime.fromisoformat(run["date"]) for run in runs]
        assert dates == sorted(dates), name
        assert len((measure.RESULTS / f"{name}.json").read_text("utf-8").splitlines()) == len(runs) + 2, name
