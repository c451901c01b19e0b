"""The options of a reconstruction, and the running of its stages."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress
from eigenfield.proxy import (
    parse_primitive,
    parse_region,
)
from eigenfield.proxy.atlas.unwrap import UNWRAP_MIN_TRIANGLES
from eigenfield.runtime.stages import Stages, stage_key

log = logging.getLogger("eigenfield.reconstruction")

SURFACES = ("auto", "relief", "poisson")
DEFAULT_TRIANGLES = 30_000


@dataclass(frozen=True)
class Settings:
    """How photographs become a proxy; `reconstruct` describes each."""

    surface: str = "auto"
    refine: bool | None = None
    triangles: int = DEFAULT_TRIANGLES
    background: bool | None = None
    primitives: tuple[str, ...] = ()
    fit_spheres: tuple[str, ...] = ()
    blind: str | None = None

    def __post_init__(self) -> None:
        if self.surface not in SURFACES:
            raise OptionError("surface", f"no surface is called {self.surface}", remedy=f"use {', '.join(SURFACES)}")
        if self.triangles < UNWRAP_MIN_TRIANGLES:
            raise OptionError(
                "triangles",
                f"{self.triangles} triangles were asked for",
                remedy=f"ask for {UNWRAP_MIN_TRIANGLES} or more",
            )
        for text in self.primitives:
            parse_primitive(text)
        for text in self.fit_spheres:
            parse_region(text)


@dataclass(frozen=True)
class Run:
    stages: Stages
    settings: Settings
    progress: Progress | None
    seconds: dict[str, float]

    def stage(self, name: str, inputs: Sequence[Any], build: Callable[[Path], None]) -> Path:
        """The folder of a finished stage, and how long it took."""
        started = time.monotonic()
        key = stage_key([name, *inputs])
        ready = self.stages.path(name, key).is_dir()
        folder = self.stages.run(name, key, build)
        self.seconds[name] = 0.0 if ready else time.monotonic() - started
        log.info("%s: %s", name, "taken up" if ready else f"{self.seconds[name]:.1f} s")
        return folder
