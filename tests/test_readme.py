"""Every command and every line of Python in the README runs as it stands there."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
import urllib.request
from datetime import datetime
from pathlib import Path

import pytest

import measure
from support.captures import write_array, write_capture

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    folder = tmp_path_factory.mktemp("readme")
    write_capture(folder / "capture")
    write_array(folder / "photos")
    return folder


def test_the_commands_run_in_order(place, run, monkeypatch):
    monkeypatch.chdir(place)
    lines = [line for block in blocks("sh") for line in block.splitlines() if line.startswith("eigenfield ")]
    assert [shlex.split(line)[1] for line in lines] == [
        "inspect", "encode", "proxy", "inspect", "encode", "encode", "encode", "view", "render", "render", "export",
        "export", "evaluate", "info", "validate",
    ]  # fmt: skip
    for line in lines:
        words = shlex.split(line, comments=True)
        if "--path" in words:
            words += ["--frames", "4"]
        if words[1] == "view":
            look(words, place)
            continue
        code, _, err = run(*words[1:])
        assert code == 0, f"{line}\n{err}"
    assert {
        "photos.glb",
        "mesh.glb",
        "mesh.cameras",
        "overlay.png",
        "scene.glb",
        "small.glb",
        "paper.glb",
        "view.png",
        "flight.mp4",
        "scene.html",
        "redrawn",
        "plots",
    } <= {path.name for path in place.iterdir()}


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
    monkeypatch.chdir(tmp_path)
    exec("\n".join(blocks("python")), {})


def test_the_make_targets_exist():
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    named = {word for block in blocks("sh") for word in re.findall(r"^make ([a-z]+)", block, re.MULTILINE)}
    assert named and named <= set(targets)


def test_links_lead_somewhere():
    for target in re.findall(r"\]\(([^)#]+)\)", README):
        assert target.startswith("http") or (ROOT / target).exists(), target


def test_constraints_pin_what_is_required():
    pinned = {line.split("==")[0].lower().replace("_", "-") for line in (ROOT / "constraints.txt").read_text().split()}
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    wanted = [*project["dependencies"], *(r for extra in project["optional-dependencies"].values() for r in extra)]
    assert {re.split(r"[<>=\[]", requirement)[0].lower() for requirement in wanted} <= pinned


def test_the_figures_are_those_of_the_results():
    """The tables between the marks are what benchmarks/tables.py makes of benchmarks/results."""
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
