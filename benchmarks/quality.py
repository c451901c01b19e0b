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

import numpy as np

import eigenfield as ef
import measure
from eigenfield.capture import open_capture
from eigenfield.demo import draw_demo_capture
from eigenfield.encoding.atlas import make_atlas
from eigenfield.encoding.projected.project import texture_map
from eigenfield.evaluation import read_circles
from eigenfield.imaging.metrics import ssim, to_codes
from evidence import captures, prepared
from evidence.captures import Capture
from evidence.stills import STILLS, decode, encode

SAMPLE = 12  # texture maps that are coded as AVIF, evenly spread; their bytes are scaled up
AVIF = STILLS[0]


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


def maps_at_equal_ssim(scene_path: Path, capture: ef.LightField, target: float) -> dict[str, Any]:
    """The lowest AVIF quality at which the filled maps reach `target`, and all maps' bytes against the file's."""
    scene = ef.load(scene_path)
    mean = to_codes(scene.appearance.planes[0].mean)
    atlas = make_atlas(scene.proxy.mesh, mean.shape[1], mean.shape[0])
    names = [view.name for view in capture.views]
    maps = []
    for row in np.linspace(0, len(scene.rig.encoded) - 1, SAMPLE).round().astype(int):
        index = scene.rig.encoded[row]
        photograph = capture.photograph(names.index(scene.rig.names[index]))
        values, seen = texture_map(atlas, scene.rig.cameras[index], photograph.pixels, photograph.mask)
        filled, visible = mean.copy(), np.zeros(mean.shape[:2], bool)
        filled.reshape(-1, 3)[atlas.texel[seen > 0]] = to_codes(values[seen > 0])
        visible.reshape(-1)[atlas.texel[seen > 0]] = True
        maps.append((filled, visible))

    def at(quality: int) -> tuple[float, float]:
        files = [encode(filled, AVIF, quality) for filled, _ in maps]
        scores = [ssim(decode(data, AVIF), *one) or 0.0 for data, one in zip(files, maps, strict=True)]
        return float(np.mean(scores)), float(np.mean([len(data) for data in files]))

    low, high = 0, 100
    while low < high:
        middle = (low + high) // 2
        if at(middle)[0] >= target:
            high = middle
        else:
            low = middle + 1
    reached, size = at(high)
    total, own = size * len(scene.rig.encoded), scene_path.stat().st_size
    return {
        "quality": high, "ssim": round(reached, 4), "maps_bytes_estimated": round(total), "sample": SAMPLE,
        "file_bytes": own, "saving": round(1 - own / total, 4),
    }  # fmt: skip


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
        draw_demo_capture(demo / "capture", rows=17, columns=17)
    cases = {label: coded(name, demo, options) for label, options in CASES[name]}
    if name == "tarot":
        cases["all encoded"]["uncoded"] = uncoded(named(name, demo))
        cases["odd held out"]["uncoded"] = uncoded(named(name, demo), hold_out="odd")
    if name == "demo":
        cases["all encoded"]["exact geometry, all textures of 25 views, density 2, uncoded"] = exact(demo)
    return {"capture": name, "cases": cases}


def exact(demo: Path) -> dict[str, Any]:
    """What resampling alone costs: every fourth row and column of the demo's capture, with all their textures."""
    capture = open_capture(demo / "capture")
    some = prepared.every(capture, 4)
    scene = ef.encode(some, demo / "capture" / "proxy.ply", textures=len(some.views) - 1, density=2.0, fit="none")
    return ef.evaluate(scene, some, png_maps="none")["image"]


if __name__ == "__main__":
    main()
