"""The steps of one capture's evaluation, in order."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import eigenfield as ef
import measure
from eigenfield.gltf import parts
from evidence import pictures
from evidence.between import between, start
from evidence.captures import Capture
from evidence.losses import losses
from evidence.paper import paper
from evidence.peers import peers
from evidence.prepared import Prepared
from evidence.truth import true_geometry

SAMPLE = 25  # held-out cameras that are drawn in every way

Step = Callable[[Prepared, Path], dict[str, Any]]  # of a capture and the report's folder


def _losses(prepared: Prepared, folder: Path) -> dict[str, Any]:
    figures = losses(prepared.work / "all.glb", prepared.light_field, alone=prepared.capture.studied)
    if prepared.capture.name == "demo" and not prepared.quick:
        figures["truth"] = true_geometry(prepared.capture.folder, prepared.work / "truth")
    return figures


def _between(prepared: Prepared, folder: Path) -> dict[str, Any]:
    file = prepared.work / "held.glb"
    stage, others = start(ef.load(file), prepared.light_field)
    return {
        **between(stage, others, SAMPLE, file=file, circles=prepared.circles()),
        "rule": prepared.hold_out,
        "pictures": pictures.between_cameras(stage, others, prepared, folder),
    }


def _whole(prepared: Prepared) -> dict[str, Any]:
    """`eigenfield encode --fit none`, as a process of its own, and what it made; then the same with cameras
    held out. Cameras, mesh and its atlas are there before: what they took is in the step before this one."""
    scene, everything = _encoded(prepared, "all.glb", [])
    held, some = _encoded(prepared, "held.glb", ["--hold-out", prepared.hold_out])
    settings = scene.settings
    return {
        "encode": everything["encode"], "bytes": everything["bytes"], "ratio": everything["ratio"],
        "textures": scene.appearance.textures, "density": settings["density"], "atlas": settings["atlas"],
        "encoded": everything["image"]["encoded"], "uv": everything["uv"],
        "hold_out_rule": prepared.hold_out,
        "held_scene": {
            "bytes": some["bytes"]["total"], "textures": held.appearance.textures, "encode": some["encode"],
            "encoded": some["image"]["encoded"], "held_out": some["image"]["held_out"],
        },
    }  # fmt: skip


def _encoded(prepared: Prepared, name: str, options: list[str]) -> tuple[ef.Scene, dict[str, Any]]:
    """Encode into the work folder and evaluate; the figures, with seconds, memory and the command of `encode`."""
    output = prepared.work / name
    how = ["--proxy", str(prepared.mesh_file), "--fit", "none", *options]
    words = ["encode", *prepared.where, *how, "-o", str(output)]
    made = measure.run(["-m", "eigenfield", *words, "--overwrite", "--quiet"])
    scene = ef.load(output)
    figures = ef.evaluate(
        scene, prepared.light_field, path=output, circles=prepared.circles(), png_maps="sample", flip=True
    )
    figures["bytes"] = dict(parts(Path(output)))
    figures["encode"] = {
        "seconds": made["seconds"], "peak_mb": made["peak_anonymous_mb"], "command": f"eigenfield {' '.join(words)}",
    }  # fmt: skip
    return scene, figures


STEPS: dict[str, Step] = {
    "scene": lambda prepared, folder: _whole(prepared),
    "paper": paper,
    "losses": _losses,
    "rates": peers,
    "between": _between,
}


def wanted(capture: Capture) -> list[str]:
    """The steps of one capture, in order."""
    return [name for name in STEPS if name != "rates" or capture.compression]
