"""The evaluation's runner: steps are kept, measured again when they must be, and an error costs one step only."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import report
from eigenfield.core.errors import CaptureError
from evidence import captures, page, runner
from evidence.runner import Run, fingerprint
from evidence.steps import wanted
from measure import meaning
from support.captures import write_capture

ROOT = Path(__file__).parents[2]


@pytest.fixture
def capture(tmp_path):
    write_capture(tmp_path / "own")
    return captures.of_folder(tmp_path / "own")


def step(tmp_path, capture, work, run=None, said=None):
    run = run or Run(tmp_path / "report")
    return runner._step("paper", tmp_path / "steps", run, capture, work, (said if said is not None else []).append)


@pytest.mark.slow
def test_a_step_is_done_once(tmp_path, capture):
    done = []
    first = step(tmp_path, capture, lambda: done.append(1) or {"value": 1.23456789})
    again = step(tmp_path, capture, lambda: done.append(1) or {"value": 2.0})
    assert len(done) == 1 and again == first
    assert first["figures"] == {"value": 1.234568}
    assert {"commit", "machine", "command", "date", "seconds"} <= set(first)


@pytest.mark.slow
def test_a_quick_figure_does_not_stand_for_a_full_one(tmp_path, capture):
    step(tmp_path, capture, lambda: {"value": 1}, Run(tmp_path, quick=True))
    assert step(tmp_path, capture, lambda: {"value": 2}, Run(tmp_path))["figures"] == {"value": 2}


@pytest.mark.parametrize("damage", ["", "{", "[]", '{"figures": {}}'])
def test_a_damaged_record_is_measured_again(tmp_path, capture, damage):
    step(tmp_path, capture, lambda: {"value": 1})
    (tmp_path / "steps" / "paper.json").write_text(damage)
    assert step(tmp_path, capture, lambda: {"value": 2})["figures"] == {"value": 2}


def test_figures_of_other_code_stand_only_if_asked_for(tmp_path, capture):
    step(tmp_path, capture, lambda: {"value": 1})
    path = tmp_path / "steps" / "paper.json"
    record = json.loads(path.read_text())
    path.write_text(json.dumps({**record, "code": "another"}))
    kept = step(tmp_path, capture, lambda: {"value": 2}, Run(tmp_path, keep=True))
    assert kept["figures"] == {"value": 1} and kept["code"] == "another"
    assert step(tmp_path, capture, lambda: {"value": 2})["figures"] == {"value": 2}


def test_a_step_whose_files_are_gone_is_done_again(tmp_path, capture):
    made = tmp_path / "all.glb"

    def step_of(value):
        def work():
            made.touch()
            return {"value": value}

        return runner._step("scene", tmp_path / "steps", Run(tmp_path), capture, work, print, [made])["figures"]

    assert step_of(1) == step_of(2) == {"value": 1}
    made.unlink()
    assert step_of(3) == {"value": 3}


def test_an_error_is_told_and_not_kept(tmp_path, capture, capsys):
    def mendable():
        raise CaptureError("some-code", "it is broken", remedy="mend it")

    said = []
    record = step(tmp_path, capture, mendable, said=said)
    assert "it is broken" in record["error"] and "it is broken" in said[0]
    assert "ZeroDivisionError" in step(tmp_path, capture, lambda: {"value": 1 // 0})["error"]
    assert "ZeroDivisionError" in capsys.readouterr().err
    assert step(tmp_path, capture, lambda: {"value": 3})["figures"] == {"value": 3}


def test_steps_that_mean_nothing_are_left_out(capture):
    assert "rates" in wanted(capture)
    assert "rates" not in wanted(captures.Capture("video", "", capture.folder, compression=False))


def test_names_folders_and_what_is_left_out(tmp_path, monkeypatch, capture):
    monkeypatch.delenv("EIGENFIELD_DATA", raising=False)
    some, left_out = report.chosen([], tmp_path, quick=False)
    assert [one.name for one in some] == ["demo"] and "EIGENFIELD_DATA" in left_out[0]
    assert report.chosen([str(capture.folder)], tmp_path, quick=False)[0][0].folder == capture.folder
    with pytest.raises(SystemExit, match="neither a folder nor one of demo"):
        report.chosen(["nothing"], tmp_path, quick=False)
    (tmp_path / "fox_transforms_half").mkdir()
    monkeypatch.setenv("EIGENFIELD_DATA", str(tmp_path))
    assert [one.name for one in report.chosen([], tmp_path, quick=False)[0]] == ["demo", "fox"]
    some, left_out = report.chosen([], tmp_path, quick=True)
    assert [one.name for one in some] == ["demo"] and "captures: fox" in left_out


def test_the_fingerprint_is_that_of_the_code():
    assert fingerprint() == fingerprint() and len(fingerprint()) == 16


def test_comments_and_layout_mean_nothing(tmp_path):
    texts = ("x = f(1,2)", "# why\nx = f(\n    1, 2\n)  # so\n", "x = f(1, 3)")
    meanings = []
    for number, text in enumerate(texts):
        (tmp_path / f"{number}.py").write_text(text)
        meanings.append(meaning(tmp_path / f"{number}.py"))
    assert meanings[0] == meanings[1] != meanings[2]


@pytest.mark.slow
def test_the_report_of_a_folder_of_photographs(tmp_path):
    """The command as a user gives it, then again: nothing is measured twice, and a page is there both times."""
    write_capture(tmp_path / "own")
    command = [sys.executable, str(ROOT / "benchmarks" / "report.py"), str(tmp_path / "own"), "--quick"]
    environment = {key: value for key, value in os.environ.items() if key != "EIGENFIELD_DATA"}
    for _ in range(2):
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, env=environment)
        assert done.returncode == 0, done.stdout + done.stderr
    assert "  s  " not in done.stdout
    results = json.loads((tmp_path / "report" / "results.json").read_text())
    steps = results["captures"]["own"]["steps"]
    assert set(steps) == {"scene", "paper", "losses", "rates", "between"}
    assert steps["scene"]["figures"]["encoded"]["psnr"] > 25
    text = (tmp_path / "report" / "report.md").read_text()
    shown = re.findall(r"!\[[^]]*\]\(([^)]+)\)", text)
    assert len(shown) > 10 and all((tmp_path / "report" / path).stat().st_size for path in shown)
    assert "### Where the decibels go" in text and "### Between the cameras" in text
    assert {curve["kind"] for curve in steps["rates"]["figures"]["curves"]} == {"ours", "paper", "video"}


def test_the_page_says_which_step_failed(tmp_path, capture):
    curve = [{"textures": count, "plain": {"uv_ssim": 0.9 + count / 100}} for count in (0, 5)]
    record = {
        "title": "Own", "note": "", "licence": "", "views": 9, "hold_out": "every:2", "geometry": {"figures": {}},
        "steps": {"paper": {"figures": {"curve": curve, "figure6": []}}, "rates": {"error": "no codec"}},
    }  # fmt: skip
    results = {
        "machine": {"processor": "P", "cores": 2}, "paper": {"note": "Quoted."}, "left_out": ["VVenC"], "quick": True,
        "command": "c", "commit": "a", "started": "2026", "captures": {"own": record},
    }  # fmt: skip
    text = page.write(results, {}, tmp_path).read_text("utf-8")
    assert "The step `rates` ended with an error: no codec" in text and "- Left out: VVenC" in text
    assert (tmp_path / "pictures" / "own-uv.png").read_bytes()[:4] == b"\x89PNG" and "(pictures/own-uv.png)" in text
