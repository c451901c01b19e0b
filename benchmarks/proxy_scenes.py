"""Whole captures: one `eigenfield encode` from a folder of photographs to a scene, and what it is worth."""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import measure
import numpy as np

import eigenfield as ef
from eigenfield.capture import LightField, open_photographs
from eigenfield.evaluation import with_scene_cameras
from eigenfield.metrics import psnr, ssim, to_codes
from eigenfield.rendering import Renderer, camera_weights
from eigenfield.scene import Scene


@dataclass(frozen=True)
class Case:
    """One capture. options: of `encode`; circles: file for `evaluate --exclude-circles`; uncoded: measure the lossless
    file too, which says what the geometry allows; peers: put the held-out views beside simpler ways to draw them."""

    folder: str
    options: tuple[str, ...]
    circles: str | None = None
    uncoded: bool = False
    peers: bool = False


CASES = {
    "tarot": Case("tarot_17x17_512", ("--hold-out", "odd", "--density", "1"), "ball.json", uncoded=True),
    "tarot-blind": Case("tarot_17x17_512", ("--hold-out", "odd", "--density", "1", "--blind"), "ball.json"),
    "tarot-all": Case("tarot_17x17_512", (), "ball.json"),
    "tarot-5x4": Case("tarot_5x4_1024", ("--hold-out", "every:5", "--textures", "7"), peers=True),
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
    """`eigenfield encode FOLDER` and `eigenfield evaluate`: seconds, memory, coverage, quality."""
    folder = data / case.folder
    with tempfile.TemporaryDirectory() as place:
        output = Path(place) / "scene.glb"
        encode = ["-m", "eigenfield", "encode", str(folder), "-o", str(output), *case.options]
        made = measure.run(encode)
        figures = {
            "capture": case.folder,
            "encode": f"eigenfield encode {' '.join((case.folder, *case.options))}",
            "seconds": made["seconds"],
            "peak_anonymous_mb": made["peak_anonymous_mb"],
            "bytes": output.stat().st_size,
            "summary": made["output"].strip().replace(str(output), "scene.glb"),
            **_measured(output, folder, case.circles),
        }
        if case.peers:
            scene = ef.load(output)
            figures["peers"] = _peers(scene, with_scene_cameras(scene, open_photographs(folder)))
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


def _peers(scene: Scene, capture: LightField) -> dict[str, dict[str, float]]:
    """Held-out photographs beside what simpler ways draw in their place, over the whole frame: the photograph of the
    nearest encoded camera, the blend of the neighbours' photographs with the weights that the scene would use (in a
    grid without holes: bilinear), and the nearest camera's own weights on the mesh."""
    renderer, views = Renderer(scene), dict(zip(capture.names, range(len(capture)), strict=True))

    def photograph(index: int) -> np.ndarray:
        return capture.photograph(views[scene.names[index]]).pixels

    places = scene.view_plane.coordinates(np.array([camera.centre for camera in scene.cameras]))
    rows: dict[str, list[tuple[float | None, float | None]]] = {}
    for index in np.flatnonzero(scene.held_out):
        true = to_codes(photograph(int(index)))
        away = np.linalg.norm((places[scene.encoded] - places[index]) * scene.view_plane.extent, axis=1)
        nearest = int(np.argmin(away))
        weights = camera_weights(scene, int(index))
        alone = np.eye(len(scene.encoded))[nearest]
        drawn = {
            "nearest_photograph": photograph(int(scene.encoded[nearest])),
            "blended_photographs": sum(weights[k] * photograph(int(scene.encoded[k])) for k in np.flatnonzero(weights)),
            "nearest_weights_on_the_mesh": renderer.draw(scene.cameras[index], alone).image,
            "eigenfield": renderer.draw(scene.cameras[index], weights).image,
        }
        for name, picture in drawn.items():
            codes = to_codes(picture)
            rows.setdefault(name, []).append((psnr(codes, true), ssim(codes, true)))
    means = {name: np.array(values, np.float64).mean(axis=0) for name, values in rows.items()}
    return {name: {"psnr": round(float(mean[0]), 3), "ssim": round(float(mean[1]), 4)} for name, mean in means.items()}
