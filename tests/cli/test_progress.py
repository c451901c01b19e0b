"""What long work says: its cost before, its steps while it runs, on a terminal and elsewhere."""

from __future__ import annotations

import json
import os
import pty
import re
import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path

import click
import pytest

from eigenfield.batches.run import _Bar
from eigenfield.capture import open_any
from eigenfield.cli import progress as progress_module
from eigenfield.cli.progress import StepProgress, duration, duration_range, progress_bars
from eigenfield.cli.time_left import TimeLeft
from eigenfield.core.progress import tell_remaining
from eigenfield.encoding import EncodeOptions
from eigenfield.encoding.cost import STEPS, expected_cost
from eigenfield.encoding.estimated import surface_to_make
from eigenfield.reconstruction import SurfaceOptions


class Clock:
    """A clock that a test sets."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 0.0
        monkeypatch.setattr(progress_module.time, "monotonic", lambda: self.now)


class Told(StepProgress):
    """Keeps the headings."""

    def __init__(self) -> None:
        super().__init__()
        self.headings: list[str] = []

    def show_step(self, heading: str) -> None:
        self.headings.append(heading)


def test_steps_are_numbered_and_the_rest_follows_this_machines_pace(monkeypatch: pytest.MonkeyPatch) -> None:
    clock, told = Clock(monkeypatch), Told()
    told.plan({"array": 300, "trial": 100, "mesh": 200, "fit": 500}, {"array": "depth"})
    told.begin("array")
    clock.now = 600  # twice as long as was expected
    told.begin("mesh")  # no trial was needed
    assert told.headings == ["step 1 of 4: depth, about 11 to 33 min left", "step 2 of 3: mesh, about 14 min left"]
    clock.now = 660
    assert told.left() == "about 13 min left"
    told.begin("mesh")  # the same once more is no new step
    assert len(told.headings) == 2


def test_layers_change_what_is_to_come(monkeypatch: pytest.MonkeyPatch) -> None:
    clock, told = Clock(monkeypatch), Told()
    told.plan({"trial": 100, "layers": 0, "fit": 100}, {}, {"layers": 300, "fit": 240})
    told.begin("trial")
    clock.now = 100
    told.begin("layers")
    assert told.headings == ["step 1 of 2: trial, about 2 to 6 min left", "step 2 of 3: layers, about 5 to 17 min left"]


def test_steps_that_were_not_foreseen_take_the_places_of_those_that_were(monkeypatch: pytest.MonkeyPatch) -> None:
    Clock(monkeypatch)
    told = Told()
    planned = "motion", "array", "relief", "trial", "layers", "mesh"
    told.plan(dict.fromkeys(planned, 100), {"proxy": "atlas"})
    for step in ("motion", "surface", "proxy", "mesh"):
        told.begin(step)
    steps = [heading.partition(",")[0] for heading in told.headings]
    assert steps == ["step 1 of 6: motion", "step 2 of 6: surface", "step 3 of 6: atlas", "step 4 of 4: mesh"]


def test_steps_that_were_taken_up_do_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    Clock(monkeypatch)
    told = Told()
    told.plan({"surface": 500, "proxy": 20, "mesh": 30, "fit": 70}, {})
    told.begin("mesh")
    assert told.headings == ["step 1 of 2: mesh, about 1 to 3 min left"]


def test_time_of_compilation_says_nothing_about_the_pace(monkeypatch: pytest.MonkeyPatch) -> None:
    clock, told = Clock(monkeypatch), Told()
    told.plan({"array": 100, "fit": 100}, {})
    told.begin("array")
    told.compiling(True)
    clock.now = 400
    told.compiling(False)
    clock.now = 500
    told.begin("fit")
    assert told.headings[-1] == "step 2 of 2: fit, about 2 min left"


def test_the_rest_is_corrected_within_a_step_by_the_part_that_is_done() -> None:
    """Its stages take a quarter and three quarters of it, and this machine twice as long as was expected."""
    rest = TimeLeft({"surface": 100, "fit": 100}, {}, {"surface": {"first depth": 25, "depth": 75}})
    rest.begin("surface", 0)
    assert rest.left(0) == 200 and rest.is_vague
    rest.advance("first depth", 10, 10, 50)
    pace, own = (50 + 200) / (25 + 200), (50 + 30 * 10 / 9) / (25 + 30)  # of the fit, and of the surface: trusted more
    assert rest.left(50) == pytest.approx(100 * pace + 75 * own)
    rest.advance("depth", 5, 10, 125)
    assert not rest.is_vague and rest.left(125) == pytest.approx(189.5, abs=0.1)
    assert rest.left(135) == pytest.approx(rest.left(125) - 10)
    rest.advance("first depth", 10, 10, 130)  # of a second round: nothing goes back
    rest.advance("other", 1, 2, 130)
    assert rest.left(135) == pytest.approx(rest.left(125) - 10)
    rest.advance("depth", 10, 10, 200)
    rest.begin("fit", 200)
    assert rest.left(200) == pytest.approx(100 * (200 + 200) / (100 + 200))


def test_work_without_a_plan_has_steps_without_numbers() -> None:
    told = Told()
    told.begin("draw")
    assert told.headings == ["draw"]
    assert told.left() == ""


@pytest.mark.parametrize(
    ("seconds", "words"), [(1, "10 s"), (20, "10 to 40 s"), (200, "2 to 6 min"), (4000, "0.7 to 2.0 h")]
)
def test_a_range_is_said_as_people_say_it(seconds: float, words: str) -> None:
    assert duration_range(seconds) == f"about {words}"


@pytest.mark.parametrize(("seconds", "words"), [(1, "10 s"), (44, "40 s"), (100, "2 min"), (7200, "2.0 h")])
def test_durations_are_said_as_people_say_them(seconds: float, words: str) -> None:
    assert duration(seconds) == f"about {words}"


def test_whoever_knows_the_rest_says_it(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    clock, lines = Clock(monkeypatch), progress_module._Lines()
    assert not lines.knows_rest and lines.left() == ""
    lines("captures", 0, 40)
    tell_remaining(lines, 600)
    clock.now = 120
    lines("captures", 8, 40)
    assert lines.knows_rest and capsys.readouterr().err == "  captures: 8 of 40, about 8 min left\n"
    tell_remaining(None, 600)


def test_a_batch_counts_what_is_left_by_what_finished_captures_took() -> None:
    told: list[float] = []

    class Rest(StepProgress):
        def __call__(self, stage: str, done: int, total: int) -> None:
            shown.append((stage, done, total))

        def remaining(self, seconds: float) -> None:
            told.append(round(seconds, 3))

    shown: list[tuple[str, int, int]] = []
    bar = _Bar(10, Rest())  # of ten captures six are finished before
    bar.begin(dict.fromkeys(range(6, 10), 100.0), 2)
    bar.finished(6, 50.0, 2)
    bar.finished(8, None, 2)  # it has failed
    bar.finished(7, 50.0, 2)
    bar.finished(9, 50.0, 2)
    assert told == [200, 75, 50, 50, 0]
    assert shown == [("captures", done, 10) for done in range(6, 11)]


def test_lines_come_now_and_then_where_there_is_no_terminal(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    clock = Clock(monkeypatch)
    with progress_bars(quiet=False) as shown:
        assert shown is not None
        for done in range(11):
            shown("depth", done, 10)
            clock.now += 5
    assert capsys.readouterr().err.splitlines() == [f"  depth: {done} of 10" for done in (3, 6, 9)]


def test_compilation_is_said_once_if_it_takes_long(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    said = threading.Event()
    monkeypatch.setattr(progress_module, "COMPILING_SECONDS", 0.01)
    monkeypatch.setattr(progress_module.click, "echo", lambda text, err: (print(text), said.set()))
    with progress_bars(quiet=False) as shown:
        assert isinstance(shown, StepProgress)
        shown.compiling(True)  # before any step
        shown.compiling(False)
        shown._step = "fit"
        for _ in range(2):
            shown.compiling(True)
            assert said.wait(10)
            shown.compiling(False)
    assert capsys.readouterr().out.splitlines() == ["  compiling for this processor, once: about a minute"]


def test_another_program_reads_lines_of_json(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    clock = Clock(monkeypatch)
    command = click.Command("it")
    with click.Context(command) as context:
        context.meta["progress"] = "json"
        with progress_bars(quiet=False) as shown:
            assert isinstance(shown, StepProgress)
            for done in range(11):
                shown("pictures", done, 10)
                clock.now += 0.125
            shown.plan({"array": 9, "fit": 30}, {"array": "depth"})
            shown.begin("array")
            clock.now += 9  # as was expected
            shown.begin("fit")
            shown._say_compiling()
    lines = [json.loads(line) for line in capsys.readouterr().err.splitlines()]
    assert [line["done"] for line in lines[:6]] == [0, 2, 4, 6, 8, 10]
    assert {(line["step"], line["stage"], line["total"], line["part"]) for line in lines[:6]} == {
        ("", "pictures", 10, None)
    }
    assert [(line["step"], line["stage"], line["note"] != "") for line in lines[6:]] == [
        ("depth", "", False),
        ("fit", "", False),
        ("fit", "", True),
    ]
    assert lines[6]["part"] == pytest.approx(1.375 / (1.375 + 39), abs=0.001)
    assert lines[7]["part"] == pytest.approx(10.375 / (10.375 + 30), abs=0.001)
    assert lines[7]["left"] == "about 10 to 60 s left"


def test_nothing_is_shown_if_quiet() -> None:
    with progress_bars(quiet=True) as shown:
        assert shown is None


def test_a_capture_with_cameras_has_the_steps_that_its_encode_takes(fitted: tuple[Path, Path]) -> None:
    opened, options = open_any(fitted[0]), EncodeOptions()
    surface = surface_to_make(options, SurfaceOptions(), blind=False, has_proxy=False)
    cost = expected_cost(opened, options, surface, threads=1)
    assert list(cost.steps) == ["array", "relief", "trial", "layers", "mesh", "fit", "code"]
    assert cost.seconds == pytest.approx(sum(cost.steps.values()))
    assert cost.seconds < cost.layered_seconds
    assert expected_cost(opened, options, surface, threads=4).seconds < cost.seconds / 2
    assert list(expected_cost(opened, options, None, 1).steps) == ["mesh", "fit", "code"]
    held = expected_cost(opened, EncodeOptions(hold_out="odd"), surface, threads=1)
    assert held.steps["fit"] < cost.steps["fit"] and held.steps["array"] == cost.steps["array"]
    forced = expected_cost(opened, options, replace(surface, surface="layers", layers=4), threads=1)
    assert list(forced.steps) == ["array", "layers", "mesh", "fit", "code"]
    assert forced.steps["layers"] > 0 and not forced.layered
    paper = EncodeOptions(fit="none")
    surface = surface_to_make(paper, SurfaceOptions(), blind=False, has_proxy=False)
    assert list(expected_cost(opened, paper, surface, 1).steps) == ["array", "relief", "mesh", "maps", "code"]
    assert set(cost.steps) <= set(STEPS)


def test_a_few_large_photographs_take_the_memory_of_a_sweep(fitted: tuple[Path, Path]) -> None:
    opened, options = open_any(fitted[0]), EncodeOptions()
    surface = surface_to_make(options, SurfaceOptions(), blind=False, has_proxy=False)
    views = [replace(view, camera=replace(view.camera, width=6000, height=4000)) for view in opened.views[:2]]
    large = replace(opened, views=tuple(views))
    given = expected_cost(large, options, None, 1).memory
    assert given == pytest.approx(0.9e9 + 50 * 48e6)
    assert given + 1e9 < expected_cost(large, options, surface, 1).memory < 6e9


def run_on_a_terminal(words: list[str]) -> str:
    """What a command shows on a terminal."""
    own, theirs = pty.openpty()
    with subprocess.Popen(
        [sys.executable, "-m", "eigenfield", *words], stderr=theirs, stdout=subprocess.DEVNULL
    ) as run:
        os.close(theirs)
        shown = b""
        while True:
            try:
                shown += os.read(own, 4096)
            except OSError:  # Linux says so when the other end is closed
                break
        assert run.wait() == 0
    os.close(own)
    return re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", shown.decode())


@pytest.mark.slow
def test_an_encode_says_its_cost_and_its_steps(fitted: tuple[Path, Path], tmp_path: Path) -> None:
    words = ["encode", str(fitted[0]), "--proxy", str(fitted[0] / "proxy.ply"), "-o", str(tmp_path / "out.glb")]
    shown = run_on_a_terminal([*words, "--preset", "small"])
    assert re.search(r"9 photographs, 0.0 megapixels: about (\d+ to )?\d+ s with \d+ threads?; ", shown)
    for line in ("step 1 of 3: mesh, about", "step 2 of 3: fit, about", "step 3 of 3: coding, about"):
        assert line in shown
    words[-1] = str(tmp_path / "lines.glb")
    run = subprocess.run(
        [sys.executable, "-m", "eigenfield", *words, "--preset", "small"], capture_output=True, text=True, check=True
    )
    assert [line[:11] for line in run.stderr.splitlines() if line.startswith("step")] == [
        "step 1 of 3", "step 2 of 3", "step 3 of 3"
    ]  # fmt: skip
