"""What a frame costs in a browser against the number of eigen textures, and what the first picture needs.

    python benchmarks/render_browser.py [demo/scene.glb]

Headless Chromium draws the scene of render.py at 1024x768 through the three.js plug-in (web/benchmarks), the viewpoint
moving every frame; a frame lasts until a pixel of it can be read. Beside it, in the same page, the same mesh with one
plain texture. Without a GPU WebGL is SwiftShader, on the processor: the ratios are what counts. Needs Node.js,
Chromium and `npm ci` in web/.

DEMO.glb (the capture that `eigenfield demo` draws, encoded with `--fit none`) gives the bytes that must have come
before the first picture.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import measure
from eigenfield.core.appearance import Plane
from eigenfield.gltf import parts, save
from render import SIDE, array, relief, scene_of

ROOT = Path(__file__).parents[1]
COUNTS = (1, 7, 15, 40, 100)
WIDTH, HEIGHT, SECONDS = 1024, 768, 3.0


def write_scenes(folder: Path) -> list[str]:
    """Scenes of all counts; smooth textures, which are quick to code: what they hold costs a frame nothing."""
    mesh, cameras = relief(), array()
    names = []
    for count in COUNTS:
        scene = scene_of(mesh, cameras, count)
        plane = scene.appearance.planes[0]
        basis = plane.bases[0]
        smooth = np.repeat(np.repeat(basis.textures[:, ::64, ::64], 64, axis=1), 64, axis=2)
        small = replace(
            scene, appearance=replace(scene.appearance, planes=(Plane(plane.mean, (replace(basis, textures=smooth),)),))
        )
        names.append(f"{count}.glb")
        save(small, folder / names[-1], codec="png", overwrite=True)
    mean = np.rint(255 * np.clip(plane.mean, 0, 1)).astype(np.uint8)
    Image.fromarray(mean).save(folder / "mean.png")
    return names


def bundle() -> dict[str, int]:
    """Bytes of what the viewer consists of."""
    static = ROOT / "src" / "eigenfield" / "viewer" / "static"
    return {path.name: path.stat().st_size for path in sorted(static.iterdir())}


def main() -> None:
    figures: dict[str, Any] = {"atlas": SIDE, "view": [WIDTH, HEIGHT], "counts": {}, "bundle": bundle()}
    with tempfile.TemporaryDirectory() as place:
        names = write_scenes(Path(place))
        script = ROOT / "web" / "benchmarks" / "frames.mjs"
        size = [str(WIDTH), str(HEIGHT), str(SECONDS)]
        done = subprocess.run(["node", str(script), place, *size, *names], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    drawn = json.loads(done.stdout)
    figures["browser"] = f"Chromium {drawn['browser']}"
    for name, count in zip(names, COUNTS, strict=True):
        row = drawn[name]
        figures["driver"] = row["renderer"]
        found = {"plain": {"milliseconds": round(row["plain"], 1)}}
        for mode in ("eye", "ray"):
            for filter, took in row[mode].items():
                found[f"{mode}_{filter}"] = {
                    "milliseconds": round(took, 1), "times_plain": round(took / row["plain"], 2),
                }  # fmt: skip
        figures["counts"][str(count)] = found
        print(count, found)
    if len(sys.argv) > 1:
        sizes = parts(sys.argv[1])
        figures["demo_bytes"] = sizes
        figures["first_picture_bytes"] = sizes["total"] - sizes["textures"]
        print(f"first picture after at most {figures['first_picture_bytes']:,} of {sizes['total']:,} bytes")
    print(f"stored as {measure.store('render-browser', figures)}")


if __name__ == "__main__":
    main()
