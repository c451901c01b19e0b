"""How good scenes are, the paper's way: real captures and the demo, before and after coding, encoded and held out.

    EIGENFIELD_DATA=captures python benchmarks/quality.py [tarot] [tarot-5x4] [cube] [demo]

`coded` is what the file holds, through the command line (seconds and memory of `encode` are that process's);
`uncoded` is the scene in memory before any quantisation, drawn bicubic. The demo's capture is drawn if `--demo DIR`
(default: demo) does not hold it.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import eigenfield as ef
import measure
from avif_maps import maps_at_equal_ssim
from eigenfield.demo import draw_demo_capture
from eigenfield.evaluation import read_circles
from evidence import captures, prepared
from evidence.captures import Capture


def named(name: str, demo: Path) -> Capture:
    if name != "demo":
        return captures.named(name, demo)
    folder = demo / "capture"
    return replace(captures.demo(demo), folder=folder, proxy=folder / "proxy.ply")


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
    capture = named(name, demo)
    where, atlas = prepared.words(capture), ["--atlas", "1024"] if name == "tarot" else []
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "scene.glb"
        how = ["--proxy", str(capture.proxy), *atlas, "--fit", "none"]
        words = [*where, *how, "-o", str(output), "--overwrite", "--quiet", *options]
        arguments = ["-m", "eigenfield", "encode", *words]
        encoded = measure.run(arguments)
        exclude = [] if capture.circles is None else ["--exclude-circles", str(capture.circles)]
        figures = json.loads(
            measure.run(["-m", "eigenfield", "evaluate", str(output), *where, "--json", "--quiet", *exclude])["output"]
        )
        if not options:
            figures["maps_as_avif"] = maps_at_equal_ssim(output, prepared.opened(where), figures["uv"]["ssim"])
    for key in ("cameras", "schema", "missing", "png_maps"):
        figures.pop(key, None)
    figures["encode"] = {key: encoded[key] for key in ("seconds", "peak_anonymous_mb")}
    return figures


def uncoded(capture: Capture, **options: Any) -> dict[str, Any]:
    """Of Tarot."""
    assert capture.proxy is not None and capture.circles is not None
    light_field = prepared.opened(prepared.words(capture))
    scene = ef.encode(light_field, capture.proxy, atlas=1024, fit="none", **options)
    circles = read_circles(capture.circles, scene.rig.names)
    figures = ef.evaluate(scene, light_field, png_maps="none", circles=circles)
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
        cases["all encoded"]["uncoded"] = uncoded(named(name, demo))
        cases["odd held out"]["uncoded"] = uncoded(named(name, demo), hold_out="odd")
    if name == "demo":
        cases["all encoded"]["exact geometry, all textures of 25 views, density 2, uncoded"] = exact(demo)
    return {"capture": name, "cases": cases}


def exact(demo: Path) -> dict[str, Any]:
    """What resampling alone costs: every fourth row and column of the demo's capture, with all their textures."""
    capture = ef.open_capture(demo / "capture")
    some = prepared.every(capture, 4)
    scene = ef.encode(some, demo / "capture" / "proxy.ply", textures=len(some.views) - 1, density=2.0, fit="none")
    return ef.evaluate(scene, some, png_maps="none")["image"]


if __name__ == "__main__":
    main()
