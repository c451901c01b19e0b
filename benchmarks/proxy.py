"""How good the geometry is that photographs alone give.

    EIGENFIELD_DATA=captures python benchmarks/proxy.py [CASE ...]

Results go to benchmarks/results/proxy-NAME.json.
"""

from __future__ import annotations

import argparse
import functools
import json
import os
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import measure
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs import decode
from eigenfield.stereo import depth_range, estimate_depth

BORDER = 15  # pixels that the HCI benchmark leaves out on every side
WIDE = (-12.0, 12.0)  # labels of the coarse sweep: pixels a step of the array


def data() -> Path:
    folder = os.environ.get("EIGENFIELD_DATA")
    if not folder:
        raise SystemExit("EIGENFIELD_DATA must name the folder of captures")
    return Path(folder)


def read_pfm(path: Path) -> NDArray[np.float32]:
    """A single-channel PFM picture, top row first."""
    with path.open("rb") as file:
        if file.readline().strip() != b"Pf":
            raise SystemExit(f"{path} is no single-channel PFM file")
        width, height = (int(word) for word in file.readline().split())
        order = "<f4" if float(file.readline()) < 0 else ">f4"
        values = np.frombuffer(file.read(4 * width * height), order).reshape(height, width)
    return values[::-1].astype(np.float32)


def hci_views(folder: Path, side: int = 9) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """Photographs and matrices of an HCI array: a step to the right or down moves a point by -d pixels."""
    paths = [next(folder.glob(f"input_Cam{index:03d}.*")) for index in range(side * side)]
    pictures = np.stack([np.rint(decode(path)[0] * 255).astype(np.uint8) for path in paths])
    rows, columns = np.divmod(np.arange(side * side), side)
    matrices = np.zeros((side * side, 3, 4))
    matrices[:, 0, 0] = matrices[:, 1, 1] = matrices[:, 2, 3] = 1
    matrices[:, 0, 2], matrices[:, 1, 2] = side // 2 - columns, side // 2 - rows
    return pictures, matrices


def hci_antinous() -> dict[str, Any]:
    """Disparity of the centre view against the truth: BadPix in per cent, MSE times 100, as the benchmark counts."""
    folder = data() / "hci_antinous_9x9"
    truth = read_pfm(folder / "gt_disp_lowres.pfm")
    pictures, matrices = hci_views(folder)
    started, work = time.perf_counter(), time.process_time()
    span = depth_range(pictures, matrices, truth.shape, WIDE)
    if span is None:
        raise SystemExit("no depth range was found")
    depth = estimate_depth(pictures, matrices, truth.shape, span)
    error = np.abs(depth.d - truth)[BORDER:-BORDER, BORDER:-BORDER]
    return {
        "range": [round(value, 2) for value in span],
        "bad_pixels_0.07": round(100 * float((error > 0.07).mean()), 2),
        "bad_pixels_0.1": round(100 * float((error > 0.1).mean()), 2),
        "bad_pixels_0.03": round(100 * float((error > 0.03).mean()), 2),
        "mse_x100": round(100 * float((error.astype(np.float64) ** 2).mean()), 2),
        "median_error": round(float(np.median(error)), 4),
        "seconds": round(time.perf_counter() - started, 1),
        "cpu_seconds": round(time.process_time() - work, 1),
    }


@dataclass(frozen=True)
class SceneCase:
    """One command from a capture to a scene, measured. options: of `encode`; circles: `evaluate --exclude-circles`."""

    folder: str
    options: tuple[str, ...]
    circles: str | None = None


SCENES = {
    "tarot": SceneCase("tarot_17x17_512", ("--hold-out", "odd", "--density", "1"), "ball.json"),
    "tarot-blind": SceneCase("tarot_17x17_512", ("--hold-out", "odd", "--density", "1", "--blind"), "ball.json"),
    "tarot-5x4": SceneCase("tarot_5x4_1024", ("--hold-out", "every:5", "--textures", "7")),
    "amethyst": SceneCase("amethyst_17x17_512", ("--hold-out", "odd")),
    "jellybeans": SceneCase("jellybeans_17x17_768x384", ("--hold-out", "odd")),
    "shop": SceneCase("shop_9x9", ("--hold-out", "odd")),
    "boxes": SceneCase("hci_boxes_9x9", ("--hold-out", "odd")),
    "antinous": SceneCase("hci_antinous_9x9", ("--hold-out", "odd")),
    "fern": SceneCase("llff_fern", ("--hold-out", "every:5", "--textures", "7")),
    "cube": SceneCase("cube_colmap_mesh", ("--hold-out", "every:4", "--textures", "5")),
    "fountain": SceneCase("fountain_P11_half", ("--hold-out", "every:4", "--textures", "5")),
    "fox": SceneCase(
        "fox_transforms_half",
        (
            "--hold-out",
            "every:8",
        ),
    ),
    "temple": SceneCase("temple_ring16", ("--hold-out", "every:5", "--textures", "7")),
}


def scene(case: SceneCase) -> dict[str, Any]:
    """`eigenfield encode FOLDER` and `eigenfield evaluate`: seconds, memory, coverage, quality."""
    folder = data() / case.folder
    with tempfile.TemporaryDirectory() as place:
        output = Path(place) / "scene.glb"
        encode = ["-m", "eigenfield", "encode", str(folder), "-o", str(output), *case.options]
        made = measure.run(encode)
        evaluate = ["-m", "eigenfield", "evaluate", str(output), str(folder), "--json"]
        if case.circles is not None:
            evaluate += ["--exclude-circles", str(folder / case.circles)]
        figures = json.loads(measure.run(evaluate)["output"])
        size = output.stat().st_size
        uncoded = None
        if case.circles is not None:  # what the geometry allows, before coding
            png = [*encode, "--codec", "png", "--overwrite"]
            measure.run(png)
            uncoded = _shortened(json.loads(measure.run(evaluate)["output"]))
    return {
        "command": f"eigenfield encode {case.folder} {' '.join(case.options)}",
        "seconds": made["seconds"],
        "peak_anonymous_mb": made["peak_anonymous_mb"],
        "bytes": size,
        "summary": made["output"].strip().replace(str(output), "scene.glb"),
        **_shortened(figures),
        **({} if uncoded is None else {"png": uncoded}),
    }


def _shortened(figures: dict[str, Any]) -> dict[str, Any]:
    """The means over encoded and over held-out cameras."""
    keys = ("cameras", "psnr", "ssim", "psnr_full", "coverage")
    result: dict[str, Any] = {}
    for part in ("encoded", "held_out"):
        values = figures["image"][part]
        if values is None:
            continue
        result[part] = {key: values[key] for key in keys}
        if "outside" in values:
            result[part]["psnr_outside"] = values["outside"]["psnr"]
    return result


CASES: dict[str, Callable[[], dict[str, Any]]] = {
    "hci-antinous": hci_antinous,
    **{f"scene-{name}": functools.partial(scene, case) for name, case in SCENES.items()},
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", help=f"of {', '.join(CASES)}; default: all")
    cases = parser.parse_args().cases or list(CASES)
    if unknown := set(cases) - set(CASES):
        parser.error(f"no such case: {', '.join(sorted(unknown))}")
    for name in cases:
        figures = {"case": name, **CASES[name]()}
        print(json.dumps(figures, indent=1))
        measure.store(f"proxy-{name}", figures)


if __name__ == "__main__":
    main()
