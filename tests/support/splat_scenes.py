"""A scene as Gaussians for the tests in browsers.

`write` puts into a folder that has `viewer_scenes.write`'s scene.glb

    splats.glb   scene.glb as Gaussians
    splats.json  {"K", "R", "t", "width", "height"}: a camera of the array in the axes of splats.glb
    splats.png   what the reference draws of splats.glb there
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

import eigenfield as ef
from eigenfield.imaging.png import png_bytes
from eigenfield.viewer.exports import write_splats
from support.splatted import camera_of, draw_splats, read_splats

COUNT = 8000


def write(folder: Path) -> None:
    """Write the three files."""
    scene = ef.load(folder / "scene.glb")
    write_splats(scene, folder / "splats.glb", splats=COUNT, metres_per_unit=1.0, overwrite=True)
    index = int(scene.rig.encoded[1])
    camera = camera_of(scene.rig.cameras[index], scene.rig)
    found = {"K": camera.K.tolist(), "R": camera.R.tolist(), "t": camera.t.tolist()}
    sizes = {"width": camera.width, "height": camera.height}
    (folder / "splats.json").write_text(json.dumps(found | sizes))
    drawn = draw_splats(read_splats(folder / "splats.glb")[1], camera)
    (folder / "splats.png").write_bytes(png_bytes(drawn.astype(np.float32)))
