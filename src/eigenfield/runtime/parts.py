"""Parts of one stage that do not need each other, made by workers as finished stages of their own."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eigenfield.runtime.executor import spread
from eigenfield.runtime.stages import Stages, stage_key
from eigenfield.runtime.tasks import Task, Workers


@dataclass(frozen=True)
class Parts:
    """Where the parts of stages are made.

    Attributes:
        folder: That all of them share; it keeps parts that are finished.
        identity: What every part depends on, besides its own arguments.
    """

    workers: Workers
    folder: Path
    identity: str

    def make(
        self, name: str, build: Callable[..., None], calls: Sequence[tuple[Any, ...]], memory: float
    ) -> Iterator[Path]:
        """The folders of all parts, in order. Those that an earlier run has finished are not made again.

        Args:
            build: Importable by name; writes the files of a part into the folder that is its first argument.
            calls: Its other arguments for each part: paths and small numbers. A part is known by its place among them,
                so they must follow from `identity`.
            memory: Bytes that a part takes at most: it meets no worker that has less.
        """
        keys = [stage_key([self.identity, name, number, len(calls)]) for number in range(len(calls))]
        task = Task(make_part, memory)
        each = ((task, self.folder, name, key, build, call) for key, call in zip(keys, calls, strict=True))
        return spread(self.workers, each)


def make_part(folder: Path, name: str, key: str, build: Callable[..., None], args: tuple[Any, ...]) -> Path:
    """The folder of a part, made if it is not finished; runs on a worker."""

    def write(place: Path) -> None:
        build(place, *args)

    return Stages(folder).run(name, key, write)
