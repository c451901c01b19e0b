"""Commands and Python of the pages run as they stand, links lead somewhere, tables are those of the results."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
import tomllib
import urllib.request
from datetime import datetime
from pathlib import Path

import pytest

import measure
from eigenfield.cli.encode import command as encode_command
from support.captures import write_array, write_capture

ROOT = Path(__file__).parents[1]
COMMANDS = {
    "README.md": ["inspect", "encode", "view", "export", "evaluate"],
    "docs/usage.md": [
        "inspect", "encode", "encode", "proxy", "inspect", "encode", "encode", "encode", "render", "render", "export",
        "evaluate", "info", "validate",
    ],
}  # fmt: skip
PAGES = ["README.md", pytest.param("docs/usage.md", marks=pytest.mark.slow)]
MADE = {
    "README.md": {"scene.glb", "scene.html"},
    "docs/usage.md": {
        "overlay.png", "scene.glb", "small.glb", "paper.glb", "view.png", "flight.mp4", "redrawn", "plots", "mesh.glb",
        "mesh.cameras", "draft.glb", "photos.glb",
    },
}  # fmt: skip
NUMBER = re.compile(r"(?<![\w.])[-+−]?\d+(?:[.,]\d+)*")


def page(name):
    return (ROOT / name).read_text(encoding="utf-8")


def blocks(name, language):
    return re.findall(rf"(?<!-->\n)```{language}\n(.*?)```", page(name), re.DOTALL)  # none that says why it is not run


@pytest.mark.parametrize("name", PAGES)
def test_the_commands_run_in_order(name, tmp_path, run, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_capture(tmp_path / "capture")
    write_array(tmp_path / "photos")
    lines = [line for block in blocks(name, "sh") for line in block.splitlines() if line.startswith("eigenfield ")]
    assert [shlex.split(line)[1] for line in lines] == COMMANDS[name]
    for line in lines:
        words = shlex.split(line, comments=True)
        if "--path" in words:
            words += ["--frames", "4"]
        if words[1] == "view":
            look(words, tmp_path)
            continue
        code, _, err = run(*words[1:])
        assert code == 0, f"{line}\n{err}"
    assert MADE[name] <= {path.name for path in tmp_path.iterdir()}


def look(words, place):
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


def test_the_python_runs(tmp_path, monkeypatch):
    write_capture(tmp_path / "capture")
    write_array(tmp_path / "photos")
    code = "\n".join(blocks("README.md", "python"))
    assert code
    monkeypatch.chdir(tmp_path)
    exec(code, {})


def test_the_readme_is_short():
    assert len(page("README.md").splitlines()) <= 120


def test_the_make_targets_exist():
    targets = re.findall(r"^([a-z-]+):", page("Makefile"), re.MULTILINE)
    named = set(re.findall(r"`make ([a-z]+)`", page("README.md")))
    assert named and named <= set(targets)


def test_links_lead_somewhere():
    pages = [ROOT / "README.md", ROOT / "CHANGELOG.md", *(ROOT / "docs").rglob("*.md")]
    links = [(path, target) for path in pages for target in re.findall(r"\]\(([^)#\s]+)", path.read_text("utf-8"))]
    assert links
    lost = [(path.name, to) for path, to in links if not to.startswith("http") and not (path.parent / to).exists()]
    assert lost == []


def test_every_option_of_encode_has_its_use():
    """docs/usage.md says what each option is good for, and names none that is gone."""
    table = page("docs/usage.md").split("## Options of `encode`\n")[1].split("\n## ")[0]
    named = set(re.findall(r"`[^`]*?(--[a-z-]+)", "\n".join(re.findall(r"^\| (.*?) \|", table, re.MULTILINE))))
    common = {"--help", "--output", "--overwrite", "--quiet", "--threads", "--traceback", "--verbose"}
    shown = [option for option in encode_command.params if not getattr(option, "hidden", False)]
    known = {word for option in shown for word in (*option.opts, *option.secondary_opts)}
    assert named == {word for word in known if word.startswith("--")} - common


def test_a_bullet_of_the_evaluation_is_one_claim():
    """At most 40 words and three numbers a bullet; everything else is a row of docs/benchmarks.md."""
    bullets = re.findall(r"^- (.*?)(?=\n- |\n\n|\Z)", page("docs/evaluation.md"), re.MULTILINE | re.DOTALL)
    assert len(bullets) > 20
    shown = [re.sub(r"\]\([^)]*\)|`[^`]*`|(?<=\[decision) \d+", "", bullet) for bullet in bullets]
    assert [bullet for bullet in shown if len(bullet.split()) > 40 or len(NUMBER.findall(bullet)) > 3] == []


def test_constraints_pin_what_is_required():
    pinned = {line.split("==")[0].lower().replace("_", "-") for line in page("constraints.txt").split()}
    project = tomllib.loads(page("pyproject.toml"))["project"]
    apart = {"lint", "release"}  # packaging/requirements-*.txt pin what these need
    extras = [needs for name, needs in project["optional-dependencies"].items() if name not in apart]
    wanted = [*project["dependencies"], *(need for needs in extras for need in needs)]
    assert {re.split(r"[<>=\[]", requirement)[0].lower() for requirement in wanted} <= pinned


def test_the_tables_are_those_of_the_results():
    """What is between the marks of README.md and docs/benchmarks.md is what benchmarks/tables.py makes."""
    done = subprocess.run(
        [sys.executable, str(ROOT / "benchmarks" / "tables.py"), "--check"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    names = [path.stem for path in measure.RESULTS.glob("*.json")]
    assert "encode" in names
    for name in names:
        runs = measure.runs(name)  # each with date, commit, machine and command, or this says which has not
        dates = [datetime.fromisoformat(run["date"]) for run in runs]
        assert dates == sorted(dates) and len(runs) <= measure.KEPT, name
