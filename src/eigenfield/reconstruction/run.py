"""The settings of a reconstruction, and how its stages run."""

from __future__ import annotations

import logging
import shutil
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eigenfield.coding.limits import MAX_SHEETS
from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress, begin_step
from eigenfield.proxy import PROXY_DEFAULT_TRIANGLES, parse_primitive, parse_region
from eigenfield.proxy.atlas.unwrap import UNWRAP_MIN_TRIANGLES
from eigenfield.runtime.executor import refuse_unshared
from eigenfield.runtime.files import output_errors
from eigenfield.runtime.parts import Parts
from eigenfield.runtime.stages import Stages, stage_key
from eigenfield.runtime.tasks import Workers

log = logging.getLogger("eigenfield.reconstruction")


SURFACE_KINDS = ("auto", "relief", "layers", "poisson")


@dataclass(frozen=True)
class ReconstructionSettings:
    """How photographs become a proxy. `reconstruct` describes the values.

    Attributes:
        surface: Kind of surface, one of SURFACE_KINDS.
        layers: Number of soft sheets; 1: none; None: as many as usual.
        refine: Whether the cameras of an array are corrected.
        triangles: Most triangles of the proxy.
        background: Whether the frustum is closed behind the surface.
        primitives: Texts of primitives.
        fit_spheres: Texts of spheres to fit.
        blind: Rule of the views that take no part.
        hold_out: Rule of the views that sheets are not made from; None: those of `blind`.

    Raises:
        OptionError: `surface`, `layers`, `triangles`, `primitive` or `fit-sphere`.
    """

    surface: str = "auto"
    layers: int | None = None
    refine: bool | None = None
    triangles: int = PROXY_DEFAULT_TRIANGLES
    background: bool | None = None
    primitives: tuple[str, ...] = ()
    fit_spheres: tuple[str, ...] = ()
    blind: str | None = None
    hold_out: str | None = None

    def __post_init__(self) -> None:
        if self.surface not in SURFACE_KINDS:
            raise OptionError(
                "surface", f"no surface is called {self.surface}", remedy=f"use {', '.join(SURFACE_KINDS)}"
            )
        self._check_layers()
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

    @staticmethod
    def of_arguments(arguments: Mapping[str, Any]) -> ReconstructionSettings:
        """Those of the arguments of `reconstruct`. Raises OptionError."""
        texts = {name: tuple(arguments[name] or ()) for name in ("primitives", "fit_spheres")}
        return ReconstructionSettings(**{**arguments, **texts})

    @property
    def by_hand(self) -> str | None:
        """The option by which the surface is made by hand, which soft sheets do not allow; None: there is none."""
        if self.background is not None:
            return "fill-background" if self.background else "no-fill-background"
        return "primitive" if self.primitives else "fit-sphere" if self.fit_spheres else None

    def _check_layers(self) -> None:
        if self.layers is not None and not 1 <= self.layers <= MAX_SHEETS:
            raise OptionError(
                "layers", f"{self.layers} layers were asked for", remedy=f"ask for 2 to {MAX_SHEETS}, or 1 for none"
            )
        if self.layers is not None and self.layers > 1 and self.surface not in ("auto", "layers"):
            raise OptionError(
                "layers", f"a {self.surface} surface has no {self.layers} layers", remedy="use --surface layers"
            )
        if self.surface == "layers" and self.layers == 1:
            raise OptionError("layers", "one layer is an opaque surface", remedy="leave out --surface layers")
        if self.surface == "layers" and self.by_hand is not None:
            raise OptionError(
                "surface", f"layers do not go together with --{self.by_hand}", remedy="leave out one of the two"
            )


@dataclass(frozen=True)
class StageRunner:
    """Runs the stages of one reconstruction.

    Attributes:
        stages: Finished stages.
        settings: Of the reconstruction.
        identity: What every stage depends on.
        progress: Called within stages.
        seconds: Time that each stage took.
        workers: That make parts of stages; None: there are none.
    """

    stages: Stages
    settings: ReconstructionSettings
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
            name: Of the stage.
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
