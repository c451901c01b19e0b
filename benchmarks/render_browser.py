"""What a frame costs in a browser against the number of eigen textures, and what the first picture needs.

    python benchmarks/render_browser.py [demo/scene.glb]

Headless Chromium draws the scene of render.py at 1024x768 through the three.js plug-in (web/benchmarks), the viewpoint
moving every frame; a frame lasts until a pixel of it can be read. Beside it, in the same page, the same mesh with one
plain texture. Two more scenes have four sheets, of which three are discs before the first: with opacity, and the same
mesh as one opaque surface. Without a GPU WebGL is SwiftShader, on the processor: the ratios are what counts. Needs
Node.js, Chromium and `npm ci` in web/.

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
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.gltf import parts, save
from render import SIDE, array, relief, scene_of

ROOT = Path(__file__).parents[1]
COUNTS = (1, 7, 15, 40, 100)
SHEETS, SHEETS_COUNT = 4, 15  # sheets, and textures of the scenes that have them
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
        if count == SHEETS_COUNT:
            soft = replace(small, proxy=sheets())
            for name, made in (("sheets", soft), ("opaque", replace(small, proxy=Proxy(soft.proxy.mesh)))):
                names.append(f"{name}.glb")
                save(made, folder / names[-1], codec="png", overwrite=True)
    mean = np.rint(255 * np.clip(plane.mean, 0, 1)).astype(np.uint8)
    Image.fromarray(mean).save(folder / "mean.png")
    return names


def sheets() -> Proxy:
    """The relief, and before it three discs with soft rims; each has a strip of the atlas."""
    whole = relief()
    assert whole.uv is not None
    radius = np.hypot(*(2 * whole.uv - 1).T)
    parts, used = [], 0
    for sheet in range(SHEETS):
        faces = whole.faces if sheet == 0 else whole.faces[(radius[whole.faces] < 0.8).any(axis=1)]
        kept, faces = np.unique(faces, return_inverse=True)
        nearer = np.array([0, 0, 0.15 * sheet], np.float32)
        vertices = whole.vertices[kept] * np.float32(1 if sheet == 0 else 0.7) - nearer
        uv = (0.98 * whole.uv[kept] + (0.01, 0.01 + sheet)) / (1, SHEETS)
        parts.append((vertices, faces.reshape(-1, 3) + used, uv))
        used += len(kept)
    vertices, faces, uv = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    mesh = Mesh(vertices.astype(np.float32), faces.astype(np.int32), uv.astype(np.float32))
    v, u = (np.mgrid[:SIDE, :SIDE] + 0.5) / SIDE
    rims = np.clip(12 * (0.75 - np.hypot(2 * u - 1, 2 * (SHEETS * v % 1) - 1)), 0, 1)
    opacity = np.where(v < 1 / SHEETS, 1, rims).astype(np.float32)
    return Proxy(mesh, None, Sheets(tuple(len(part[1]) for part in parts), opacity))


def bundle() -> dict[str, int]:
    """Bytes of what the viewer consists of."""
    static = ROOT / "src" / "eigenfield" / "viewer" / "static"
    return {path.name: path.stat().st_size for path in sorted(static.iterdir())}


def main() -> None:
    figures: dict[str, Any] = {"atlas": SIDE, "view": [WIDTH, HEIGHT], "counts": {}, "sheets": {}, "bundle": bundle()}
    with tempfile.TemporaryDirectory() as place:
        names = write_scenes(Path(place))
        script = ROOT / "web" / "benchmarks" / "frames.mjs"
        size = [str(WIDTH), str(HEIGHT), str(SECONDS)]
        done = subprocess.run(["node", str(script), place, *size, *names], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    drawn = json.loads(done.stdout)
    figures["browser"] = f"Chromium {drawn['browser']}"
    for name in names:
        row, count = drawn[name], name.removesuffix(".glb")
        figures["driver"] = row["renderer"]
        found = {"plain": {"milliseconds": round(row["plain"], 1)}}
        for mode in ("eye", "ray"):
            for filter, took in row[mode].items():
                found[f"{mode}_{filter}"] = {
                    "milliseconds": round(took, 1), "times_plain": round(took / row["plain"], 2),
                }  # fmt: skip
        figures["counts" if count.isdigit() else "sheets"][count] = found
        print(count, found)
    if len(sys.argv) > 1:
        sizes = parts(sys.argv[1])
        figures["demo_bytes"] = sizes
        figures["first_picture_bytes"] = sizes["total"] - sizes["textures"]
        print(f"first picture after at most {figures['first_picture_bytes']:,} of {sizes['total']:,} bytes")
    print(f"stored as {measure.store('render-browser', figures)}")


if __name__ == "__main__":
    main()
