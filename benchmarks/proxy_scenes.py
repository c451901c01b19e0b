"""Whole captures: one `eigenfield encode --fit none` from a folder of photographs to a scene, and what it is worth."""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import measure


@dataclass(frozen=True)
class Case:
    """One capture. options: of `encode`; circles: file for `evaluate --exclude-circles`; uncoded: measure the lossless
    file too, which says what the geometry allows."""

    folder: str
    options: tuple[str, ...]
    circles: str | None = None
    uncoded: bool = False


WAY = ("--fit", "none")  # what a mesh is worth: pictures are drawn through it as they were projected onto it
CASES = {
    "tarot": Case("tarot_17x17_512", ("--hold-out", "odd", "--density", "1"), "ball.json", uncoded=True),
    "tarot-blind": Case("tarot_17x17_512", ("--hold-out", "odd", "--density", "1", "--blind"), "ball.json"),
    "tarot-all": Case("tarot_17x17_512", (), "ball.json"),
    "tarot-5x4": Case("tarot_5x4_1024", ("--hold-out", "every:5", "--textures", "7")),
    "amethyst": Case("amethyst_17x17_512", ("--hold-out", "odd")),
    "jellybeans": Case("jellybeans_17x17_768x384", ("--hold-out", "odd")),
    "shop": Case("shop_9x9", ("--hold-out", "odd")),
    "boxes": Case("hci_boxes_9x9", ("--hold-out", "odd")),
    "antinous": Case("hci_antinous_9x9", ("--hold-out", "odd")),
    "fern": Case("llff_fern", ("--hold-out", "every:5", "--textures", "7")),
    "cube": Case("cube_colmap_mesh", ("--hold-out", "every:4", "--textures", "5")),
    "fountain": Case("fountain_P11_half", ("--hold-out", "every:4", "--textures", "5")),
    "fox": Case("fox_transforms_half", ("--hold-out", "every:8")),
    "temple": Case("temple_ring16", ("--hold-out", "every:5", "--textures", "7")),
}


def scene(data: Path, case: Case) -> dict[str, Any]:
    """`eigenfield encode FOLDER --fit none` and `eigenfield evaluate`: seconds, memory, coverage, quality."""
    folder = data / case.folder
    with tempfile.TemporaryDirectory() as place:
        output = Path(place) / "scene.glb"
        encode = ["-m", "eigenfield", "encode", str(folder), "-o", str(output), *WAY, *case.options]
        made = measure.run(encode)
        figures = {
            "capture": case.folder,
            "encode": f"eigenfield encode {' '.join((case.folder, *WAY, *case.options))}",
            "seconds": made["seconds"],
            "peak_anonymous_mb": made["peak_anonymous_mb"],
            "bytes": output.stat().st_size,
            "summary": made["output"].strip().replace(str(output), "scene.glb"),
            **_measured(output, folder, case.circles),
        }
        if case.uncoded:
            measure.run([*encode, "--codec", "png", "--overwrite"])
            figures["uncoded"] = _measured(output, folder, case.circles)
    return figures


def _measured(output: Path, folder: Path, circles: str | None) -> dict[str, Any]:
    """The means over encoded and over held-out cameras."""
    evaluate = ["-m", "eigenfield", "evaluate", str(output), str(folder), "--json"]
    if circles is not None:
        evaluate += ["--exclude-circles", str(folder / circles)]
    image = json.loads(measure.run(evaluate)["output"])["image"]
    result: dict[str, Any] = {}
    for part in ("encoded", "held_out"):
        values = image[part]
        if values is None:
            continue
        result[part] = {key: values[key] for key in ("cameras", "psnr", "ssim", "psnr_full", "coverage")}
        if "outside" in values:
            result[part]["psnr_outside"] = values["outside"]["psnr"]
    return result
