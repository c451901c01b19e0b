"""The steps of one capture's evaluation, in order."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import eigenfield as ef
from evidence import pictures
from evidence.between import between, start
from evidence.captures import Capture
from evidence.losses import losses
from evidence.paper import paper
from evidence.peers import peers
from evidence.prepared import Prepared
from evidence.studies import studies
from evidence.truth import true_geometry
from evidence.whole import whole

SAMPLE = 25  # held-out cameras that are drawn in every way

Step = Callable[[Prepared, Path], dict[str, Any]]  # of a capture and the report's folder


def _losses(prepared: Prepared, folder: Path) -> dict[str, Any]:
    figures = losses(prepared.work / "all.glb", prepared.light_field, alone=prepared.capture.studied)
    if prepared.capture.name == "demo" and not prepared.quick:
        figures["truth"] = true_geometry(prepared.capture.folder, work=prepared.work / "truth")
    return figures


def _between(prepared: Prepared, folder: Path) -> dict[str, Any]:
    file = prepared.work / "held.glb"
    stage, others = start(ef.load(file), prepared.light_field)
    return {
        **between(stage, others, SAMPLE, file=file, circles=prepared.circles()),
        "rule": prepared.hold_out,
        "pictures": pictures.between_cameras(stage, others, prepared, folder),
    }


STEPS: dict[str, Step] = {
    "scene": lambda prepared, folder: whole(prepared),
    "paper": paper,
    "losses": _losses,
    "rates": peers,
    "between": _between,
    "studies": lambda prepared, folder: studies(prepared),
}


def wanted(capture: Capture, quick: bool) -> list[str]:
    """The steps of one capture, in order."""
    left_out = {"studies"} if quick or not capture.studied else set()
    left_out |= set() if capture.compression else {"rates"}
    return [name for name in STEPS if name not in left_out]
