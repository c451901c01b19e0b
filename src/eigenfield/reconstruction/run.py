"""How the stages of a reconstruction run."""

from __future__ import annotations

import logging
import shutil
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eigenfield.core.progress import Progress, begin_step
from eigenfield.reconstruction.options import SurfaceOptions
from eigenfield.runtime.executor import refuse_unshared
from eigenfield.runtime.files import output_errors
from eigenfield.runtime.parts import Parts
from eigenfield.runtime.stages import Stages, stage_key
from eigenfield.runtime.tasks import Workers

log = logging.getLogger("eigenfield.reconstruction")


@dataclass(frozen=True)
class StageRunner:
    """Runs the stages of one reconstruction.

    Attributes:
        identity: What every stage depends on.
        seconds: Time that each stage took.
        workers: That make parts of stages; None: there are none.
    """

    stages: Stages
    settings: SurfaceOptions
    identity: Sequence[Any]
    progress: Progress | None
    seconds: dict[str, float]
    workers: Workers | None = None

    @contextmanager
    def parts(self) -> Iterator[Parts | None]:
        """Where a stage has its independent parts made; they go when the block succeeds. None: in this process."""
        if self.workers is None:
            yield None
            return
        folder = self.stages.folder / "parts"
        with output_errors(folder):
            folder.mkdir(exist_ok=True)
        refuse_unshared(self.workers, folder)
        yield Parts(self.workers, folder, stage_key([self.identity, repr(self.settings)]))
        shutil.rmtree(folder, ignore_errors=True)

    def stage(self, name: str, inputs: Sequence[Any], build: Callable[[Path], None]) -> Path:
        """The folder of a stage, built if it is not finished.

        Args:
            inputs: What else its result depends on.
            build: Writes its files into a folder.
        """
        started = time.monotonic()
        key = stage_key([name, self.identity, *inputs])
        ready = self.stages.find(name, key) is not None
        if not ready:
            begin_step(self.progress, name)
        folder = self.stages.run(name, key, build)
        self.seconds[name] = 0.0 if ready else time.monotonic() - started
        log.info("%s: %s", name, "taken up" if ready else f"{self.seconds[name]:.1f} s")
        return folder
