"""What a person sees of long work: bars on a terminal, lines elsewhere; and what another program reads of it."""

from __future__ import annotations

import json
import math
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import Any

import click

from eigenfield.cli.common import note
from eigenfield.cli.time_left import RANGE_HIGH_RATIO, RANGE_LOW_RATIO, TimeLeft
from eigenfield.core.progress import Progress, begin_step

LINE_SECONDS = 15.0  # between two lines about a stage, where there is no terminal
JSON_SECONDS = 0.2  # likewise, for another program
COMPILING_WORDS = "compiling for this processor, once"
UNITS = {1: "s", 60: "min", 3600: "h"}  # of times, by their seconds
COMPILING_SECONDS = 3.0  # after which it is said where there is no terminal


@contextmanager
def progress_bars(quiet: bool) -> Iterator[Progress | None]:
    """A Progress that says on standard error how far the work is, with `--progress json` for another program; None if
    `quiet`."""
    if quiet:
        yield None
        return
    from eigenfield.runtime.jit import watch_compilation

    context = click.get_current_context(silent=True)
    as_json = context is not None and context.meta.get("progress") == "json"
    with ExitStack() as stack:
        shown = _JsonLines() if as_json else _Bars(stack) if sys.stderr.isatty() else _Lines()
        stack.enter_context(watch_compilation(shown.compiling))
        yield shown


@contextmanager
def planned_steps(
    quiet: bool, seconds: Mapping[str, float], words: Mapping[str, str]
) -> Iterator[tuple[Callable[[str], None], Progress]]:
    """Steps that are known from the start: a function that begins one, and a Progress for the work in it, whose own
    steps are passed over.

    Args:
        seconds: Expected of each step on two cores, by its name, in order.
        words: What each step says.
    """
    note(f"this takes about {sum(seconds.values()) / 60:.0f} minutes on two cores, in {len(seconds)} steps", quiet)
    with progress_bars(quiet) as shown:

        def progress(stage: str, done: int, total: int) -> None:
            if shown is not None:
                shown(stage, done, total)

        if isinstance(shown, StepProgress):
            shown.plan(seconds, words)
        yield partial(begin_step, shown), progress


class StepProgress:
    """Counts steps and what they take. A run that has none is one step without a name."""

    def __init__(self) -> None:
        self._words: dict[str, str] = {}
        self._step: str | None = None
        self._rest: TimeLeft | None = None
        self._compiling_since: float | None = None
        self._compiled = 0.0  # seconds, which tell nothing about what is to come
        self._told: tuple[float, float] | None = None  # seconds that are left, and when that was said
        self._began = time.monotonic()

    def plan(
        self,
        seconds: Mapping[str, float],
        words: Mapping[str, str],
        layered: Mapping[str, float] | None = None,
        stages: Mapping[str, Mapping[str, float]] | None = None,
    ) -> None:
        """Say what is to come.

        Args:
            seconds: Expected of each step, by its name, in order.
            layered: Of those that take others once the step "layers" begins.
        """
        self._words, self._rest = dict(words), TimeLeft(seconds, layered or {}, stages or {})

    def begin(self, step: str) -> None:
        """A step begins, and the one before has ended."""
        if step == self._step:
            return
        self._step = step
        if self._rest is not None:
            self._rest.begin(step, self._worked())
        self.show_step(self.heading())

    def __call__(self, stage: str, done: int, total: int) -> None:
        """As `Progress`."""
        if self._rest is not None:
            self._rest.advance(stage, done, total, self._worked())

    def remaining(self, seconds: float) -> None:
        """About how long the rest will take, from whoever knows it better."""
        self._told = seconds, time.monotonic()

    @property
    def knows_rest(self) -> bool:
        """Whether `left` says something."""
        return self._rest is not None or self._told is not None

    def heading(self) -> str:
        """The step's number and name, and about how long the rest will take."""
        assert self._step is not None
        words = self._words.get(self._step, self._step)
        if self._rest is None or self._step not in self._rest.seconds:
            return words
        number, count = self._rest.number
        return f"step {number} of {count}: {words}, {self.left()}"

    def left(self) -> str:
        """About how long the rest will take; empty if nothing is known."""
        if self._told is not None:
            seconds, since = self._told
            return duration(max(seconds - (time.monotonic() - since), 0)) + " left"
        rest = self.seconds_left()
        if self._rest is None or rest is None:
            return ""
        return (duration_range(rest) if self._rest.is_vague else duration(rest)) + " left"

    def seconds_left(self) -> float | None:
        """About how long the rest will take; None if nothing is known."""
        if self._rest is None or self._step not in self._rest.seconds:
            return None
        return self._rest.left(self._worked())

    def part(self) -> float | None:
        """How much of a planned run is done, 0 to 1, by time; None where nothing is planned."""
        if self._rest is None or self._step not in self._rest.seconds:
            return None
        worked = self._worked() - self._began
        return worked / max(worked + self._rest.left(self._worked()), 1e-9)

    def _worked(self) -> float:
        """Seconds without compilation."""
        now = time.monotonic()
        compiling = 0.0 if self._compiling_since is None else now - self._compiling_since
        return now - self._compiled - compiling

    def show_step(self, heading: str) -> None:
        """A step has begun."""
        raise NotImplementedError

    def compiling(self, now: bool) -> None:
        """Kernels begin to be compiled, or none is any longer."""
        if self._compiling_since is not None:
            self._compiled += time.monotonic() - self._compiling_since
        self._compiling_since = time.monotonic() if now else None


def duration(seconds: float) -> str:
    """A time as a person says it: about 40 s, about 3 min."""
    unit = _unit_of(seconds)
    return f"about {_number(seconds, unit, round)} {UNITS[unit]}"


def duration_range(seconds: float) -> str:
    """Between which times one lies: about 3 to 6 min."""
    low, high = RANGE_LOW_RATIO * seconds, RANGE_HIGH_RATIO * seconds
    unit = _unit_of(high)
    few, many = _number(low, unit, math.floor), _number(high, unit, math.ceil)
    return f"about {many if few == many else f'{few} to {many}'} {UNITS[unit]}"


def _unit_of(seconds: float) -> int:
    return 1 if seconds < 90 else 60 if seconds < 5400 else 3600


def _number(seconds: float, unit: int, rounded: Callable[[float], float]) -> str:
    if unit == 1:
        return f"{max(10 * rounded(seconds / 10), 10):.0f}"
    return f"{max(rounded(seconds / 60), 1):.0f}" if unit == 60 else f"{rounded(seconds / 360) / 10:.1f}"


class _Bars(StepProgress):
    """A line for each step, and below them the bar of the present stage."""

    def __init__(self, stack: ExitStack) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Task, TextColumn, TimeElapsedColumn
        from rich.progress import Progress as Bars
        from rich.progress import TimeRemainingColumn as OfStage
        from rich.text import Text

        steps = self

        class Left(OfStage):
            """The rest of all steps, where that is known, else of the stage."""

            def render(self, task: Task) -> Text:
                return Text(steps.left()) if steps.knows_rest else super().render(task)

        super().__init__()
        columns = (
            TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), Left(),
            TextColumn("{task.fields[note]}"),
        )  # fmt: skip
        self._bars = stack.enter_context(Bars(*columns, console=Console(stderr=True)))
        self._stage: tuple[str, Any] | None = None
        self._note = ""

    def __call__(self, stage: str, done: int, total: int) -> None:
        super().__call__(stage, done, total)
        self._bars.update(self._task(stage), completed=done, total=total)

    def show_step(self, heading: str) -> None:
        self._bars.console.print(heading, highlight=False)

    def compiling(self, now: bool) -> None:
        super().compiling(now)
        self._note = COMPILING_WORDS if now else ""
        self._bars.update(self._task(self._stage[0] if self._stage else ""), note=self._note)

    def _task(self, stage: str) -> Any:
        """The bar of a stage, which takes the place of the one before."""
        if self._stage is None or self._stage[0] != stage:
            if self._stage is not None:
                self._bars.remove_task(self._stage[1])
            self._stage = stage, self._bars.add_task(stage, total=None, note=self._note)
        return self._stage[1]


class _Lines(StepProgress):
    """A line for each step, and for a stage that takes long one now and then."""

    def __init__(self) -> None:
        super().__init__()
        self._stage, self._said = "", time.monotonic()
        self._timer: threading.Timer | None = None
        self._said_compiling = False

    def __call__(self, stage: str, done: int, total: int) -> None:
        super().__call__(stage, done, total)
        now = time.monotonic()
        if stage != self._stage:
            self._stage, self._said = stage, now
        elif now - self._said >= LINE_SECONDS and done < total:
            self._said = now
            left = self.left()
            click.echo(f"  {stage}: {done} of {total}" + (f", {left}" if left else ""), err=True)

    def show_step(self, heading: str) -> None:
        click.echo(heading, err=True)

    def compiling(self, now: bool) -> None:
        super().compiling(now)
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        if now and self._step is not None and not self._said_compiling:  # of short work nothing is said
            self._timer = threading.Timer(COMPILING_SECONDS, self._say_compiling)
            self._timer.daemon = True
            self._timer.start()

    def _say_compiling(self) -> None:
        self._said_compiling = True
        click.echo(f"  {COMPILING_WORDS}: about a minute", err=True)


class _JsonLines(_Lines):
    """A line of JSON for each step, and a few a second for the stages within it (docs/usage.md)."""

    def __init__(self) -> None:
        super().__init__()
        self._count = 0, 0

    def __call__(self, stage: str, done: int, total: int) -> None:
        StepProgress.__call__(self, stage, done, total)
        new = stage != self._stage
        self._stage, self._count = stage, (done, total)
        if new or done == total or time.monotonic() - self._said >= JSON_SECONDS:
            self._say()

    def show_step(self, heading: str) -> None:
        self._stage, self._count = "", (0, 0)
        self._say()

    def _say_compiling(self) -> None:
        self._said_compiling = True
        self._say(COMPILING_WORDS)

    def _say(self, note: str = "") -> None:
        self._said = time.monotonic()
        step = "" if self._step is None else self._words.get(self._step, self._step)
        part, (done, total) = self.part(), self._count
        line = {"step": step, "stage": self._stage, "done": done, "total": total}
        line |= {"part": None if part is None else round(part, 4), "left": self.left(), "note": note}
        click.echo(json.dumps(line), err=True)
