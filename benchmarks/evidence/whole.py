"""The whole way from photographs to figures, as the paper goes it: all cameras encoded, then some held out
(docs/measures.md)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import eigenfield as ef
import measure
from eigenfield.gltf import parts
from evidence.prepared import Prepared


def whole(prepared: Prepared) -> dict[str, Any]:
    """`eigenfield encode --fit none`, as a process of its own, and what it made; then the same with cameras
    held out. Cameras, mesh and its atlas are there before: what they took is in the step before this one."""
    scene, everything = encoded(prepared, "all.glb", [])
    held, some = encoded(prepared, "held.glb", ["--hold-out", prepared.hold_out])
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


def encoded(prepared: Prepared, name: str, options: list[str]) -> tuple[ef.Scene, dict[str, Any]]:
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
