"""What a person sees of long work: bars on a terminal, lines elsewhere."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from typing import Any

import click

from eigenfield.core.progress import Progress

LINE_SECONDS = 15.0  # between two lines about a stage, where there is no terminal
COMPILING_WORDS = "compiling for this processor, once"
COMPILING_SECONDS = 3.0  # after which it is said where there is no terminal


@contextmanager
def progress_bars(quiet: bool) -> Iterator[Progress | None]:
    """A Progress that says on standard error how far the work is; None if `quiet`."""
    if quiet:
        yield None
        return
    from eigenfield.runtime.jit import watch_compilation

    with ExitStack() as stack:
        shown = _Bars(stack) if sys.stderr.isatty() else _Lines()
        stack.enter_context(watch_compilation(shown.compiling))
        yield shown


class StepProgress:
    """Counts steps and what they take. A run that has none is one step without a name.

    Attributes:
        planned: Expected seconds of each step, by its name, in order; empty if nothing is known.
    """

    def __init__(self) -> None:
        self.planned: dict[str, float] = {}
        self._layered: dict[str, float] = {}
        self._words: dict[str, str] = {}
        self._step: str | None = None
        self._step_started = time.monotonic()
        self._spent, self._expected = 0.0, 0.0  # seconds of finished steps, and what they were expected to take
        self._compiling_since: float | None = None
        self._compiled = 0.0  # seconds of this step, which tell nothing about the next
        self._told: tuple[float, float] | None = None  # seconds that are left, and when that was said

    def plan(
        self, seconds: Mapping[str, float], words: Mapping[str, str], layered: Mapping[str, float] | None = None
    ) -> None:
        """Say what is to come.

        Args:
            seconds: Expected of each step, by its name, in order.
            words: What the steps are called.
            layered: Of those that take others once the step "layers" begins.
        """
        self.planned, self._words, self._layered = dict(seconds), dict(words), dict(layered or {})

    def begin(self, step: str) -> None:
        """A step begins, and the one before has ended. Steps between them were not needed and count no longer. One that
        was not foreseen takes the place of the next: cameras all around give a surface, where depth from one side was
        foreseen."""
        if step == self._step:
            return
        names = list(self.planned)
        if self._step in names[:-1] and step not in names:
            names[names.index(self._step) + 1] = step
            self.planned = dict(zip(names, self.planned.values(), strict=True))
        if self._step in names and step in self.planned:
            for needless in list(self.planned)[names.index(self._step) + 1 : list(self.planned).index(step)]:
                del self.planned[needless]
        now = time.monotonic()
        if self._step in self.planned:
            self._spent += now - self._step_started - self._compiled
            self._expected += self.planned[self._step]
        if step == "layers":
            self.planned |= self._layered
        self._step, self._step_started, self._compiled = step, now, 0.0
        self.show_step(self.heading())

    def remaining(self, seconds: float) -> None:
        """About how long the rest will take, from whoever knows it better."""
        self._told = seconds, time.monotonic()

    @property
    def knows_rest(self) -> bool:
        """Whether `left` says something."""
        return bool(self.planned) or self._told is not None

    def heading(self) -> str:
        """The step's number and name, and about how long the rest will take."""
        assert self._step is not None
        words = self._words.get(self._step, self._step)
        if self._step not in self.planned:
            return words
        names = list(self.planned)
        return f"step {names.index(self._step) + 1} of {len(names)}: {words}, {self.left()}"

    def left(self) -> str:
        """About how long the rest will take; empty if nothing is known."""
        if self._told is not None:
            seconds, since = self._told
            return duration(max(seconds - (time.monotonic() - since), 0)) + " left"
        if self._step not in self.planned:
            return ""
        rest = list(self.planned.values())[list(self.planned).index(self._step) :]
        spent = time.monotonic() - self._step_started - self._compiled
        return duration(self._pace() * sum(rest[1:]) + max(self._pace() * rest[0] - spent, 0)) + " left"

    def _pace(self) -> float:
        """Of this machine: how much longer finished steps took than was expected, more trusted the more is known."""
        total = sum(self.planned.values())
        return (self._spent + 0.2 * total) / (self._expected + 0.2 * total)

    def show_step(self, heading: str) -> None:
        """A step has begun."""
        raise NotImplementedError

    def compiling(self, now: bool) -> None:
        """Kernels begin to be compiled, or none is any longer."""
        if self._compiling_since is not None:
            self._compiled += time.monotonic() - max(self._compiling_since, self._step_started)
        self._compiling_since = time.monotonic() if now else None


def duration(seconds: float) -> str:
    """A time as a person says it: about 40 s, about 3 min."""
    if seconds < 90:
        return f"about {max(round(seconds, -1), 10):.0f} s"
    return f"about {seconds / 60:.0f} min" if seconds < 5400 else f"about {seconds / 3600:.1f} h"


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
        now = time.monotonic()
        if stage != self._stage:
            self._stage, self._said = stage, now
        elif now - self._said >= LINE_SECONDS and done < total:
            self._said = now
            rest = f", {self.left()}" if self._told is not None else ""
            click.echo(f"  {stage}: {done} of {total}{rest}", err=True)

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
