"""How good scenes are, the paper's way: real captures and the demo, before and after coding, encoded and held out.

    EIGENFIELD_DATA=captures python benchmarks/quality.py [tarot] [tarot-5x4] [cube] [demo]

`coded` is what the file holds, through the command line (seconds and memory of `encode` are that process's);
`uncoded` is the scene in memory before any quantisation, drawn bicubic. The demo's capture is drawn if `--demo DIR`
(default: demo) does not hold it.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import eigenfield as ef
import measure
from avif_maps import maps_at_equal_ssim
from eigenfield.core.viewplane import find_grid, fit_view_plane
from eigenfield.demo import draw_demo_capture
from eigenfield.evaluation import read_circles


def data() -> Path:
    folder = os.environ.get("EIGENFIELD_DATA")
    if not folder:
        raise SystemExit("EIGENFIELD_DATA must name the folder of captures")
    return Path(folder)


def capture_arguments(name: str, demo: Path) -> tuple[list[str], list[str], Path | None]:
    """What `evaluate` needs, what `encode` needs more, and circles to leave out."""
    if name == "tarot":
        folder = data() / "tarot_17x17_512"
        proxy = str(folder / "calibration" / "proxy.ply")
        return [str(folder), "--calibration", str(folder / "calibration" / "refined.json")], [
            "--proxy", proxy, "--atlas", "1024",
        ], folder / "ball.json"  # fmt: skip
    if name == "tarot-5x4":
        folder = data() / "tarot_5x4_1024"
        proxy = str(data() / "tarot_17x17_512" / "calibration" / "proxy.ply")
        return [str(folder), "--calibration", str(folder / "calibration" / "refined.json")], ["--proxy", proxy], None
    if name == "cube":
        folder = data() / "cube_colmap_mesh"
        return [str(folder)], ["--proxy", str(folder / "proxy.obj")], None
    return [str(demo / "capture")], ["--proxy", str(demo / "capture" / "proxy.ply")], None


CASES: dict[str, Sequence[tuple[str, list[str]]]] = {
    "tarot": (("all encoded", []), ("odd held out", ["--hold-out", "odd"])),
    "tarot-5x4": (("all encoded", []), ("every:5 held out, 7 textures", ["--hold-out", "every:5", "-n", "7"])),
    "cube": (("all encoded", ["-n", "7"]), ("every:4 held out, 5 textures", ["--hold-out", "every:4", "-n", "5"])),
    "demo": (
        ("all encoded", []),
        ("all encoded, png", ["--codec", "png"]),
        ("odd held out", ["--hold-out", "odd"]),
    ),
}


def coded(name: str, demo: Path, options: list[str]) -> dict[str, Any]:
    where, how, circles = capture_arguments(name, demo)
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "scene.glb"
        words = [*where, *how, "--fit", "none", "-o", str(output), "--overwrite", "--quiet", *options]
        arguments = ["-m", "eigenfield", "encode", *words]
        encoded = measure.run(arguments)
        exclude = [] if circles is None else ["--exclude-circles", str(circles)]
        figures = json.loads(
            measure.run(["-m", "eigenfield", "evaluate", str(output), *where, "--json", "--quiet", *exclude])["output"]
        )
        if not options:
            capture = open_capture(where)
            figures["maps_as_avif"] = maps_at_equal_ssim(output, capture, figures["uv"]["ssim"])
    for key in ("cameras", "schema", "missing", "png_maps"):
        figures.pop(key, None)
    figures["encode"] = {key: encoded[key] for key in ("seconds", "peak_anonymous_mb")}
    return figures


def open_capture(where: Sequence[str]) -> ef.LightField:
    return ef.open_capture(where[0], calibration=where[2] if len(where) > 1 else None)


def uncoded(name: str, demo: Path, options: dict[str, Any]) -> dict[str, Any]:
    where, how, circles = capture_arguments(name, demo)
    capture = open_capture(where)
    atlas = int(how[3]) if "--atlas" in how else None
    scene = ef.encode(capture, how[1], **{"atlas": atlas, "fit": "none", **options})
    figures = ef.evaluate(
        scene, capture, png_maps="none", circles=None if circles is None else read_circles(circles, scene.rig.names)
    )
    return {"uv": figures["uv"], "image": figures["image"], "textures": figures["textures"]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("captures", nargs="*", metavar="CAPTURE", help=", ".join(CASES))
    parser.add_argument("--demo", type=Path, default=Path("demo"))
    arguments = parser.parse_args()
    for name in arguments.captures or list(CASES):
        if name not in CASES:
            parser.error(f"no capture is called {name}: {', '.join(CASES)}")
        print(f"stored as {measure.store(f'quality-{name}', measured(name, arguments.demo))}", flush=True)


def measured(name: str, demo: Path) -> dict[str, Any]:
    if name == "demo" and not (demo / "capture").exists():
        demo.mkdir(parents=True, exist_ok=True)
        draw_demo_capture(demo / "capture")
    cases = {label: coded(name, demo, options) for label, options in CASES[name]}
    if name == "tarot":
        cases["all encoded"]["uncoded"] = uncoded(name, demo, {})
        cases["odd held out"]["uncoded"] = uncoded(name, demo, {"hold_out": "odd"})
    if name == "demo":
        cases["all encoded"]["exact geometry, all textures of 25 views, density 2, uncoded"] = exact(demo)
    return {"capture": name, "cases": cases}


def exact(demo: Path) -> dict[str, Any]:
    """What resampling alone costs: every second row and column of the demo's capture, with all their textures."""
    capture = ef.open_capture(demo / "capture")
    cameras = [view.camera for view in capture.views]
    grid = find_grid(fit_view_plane(cameras).coordinates([camera.centre for camera in cameras]))
    assert grid is not None
    some = capture.subset(np.sort(grid.index[::4, ::4].reshape(-1)).tolist())
    scene = ef.encode(some, demo / "capture" / "proxy.ply", textures=len(some.views) - 1, density=2.0, fit="none")
    return ef.evaluate(scene, some, png_maps="none")["image"]


if __name__ == "__main__":
    main()
