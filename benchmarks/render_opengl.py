"""Frames per second of the OpenGL renderer against the number of eigen textures (the paper's section 4.3).

    python benchmarks/render_opengl.py

The scene is that of render.py: a relief of 29,282 triangles that fills the view, atlas 1024², random 8-bit textures. A
frame is a novel camera, its weights, and all that the GPU does until it has finished; pictures stay there. At 1920x1080
the viewpoint moves on the view plane, with one set of weights a frame; in stereo two eyes of 1832x1920 move in front of
and behind it, and each texel looks its own weights up. Beside each, in the same run, the same mesh with one plain
texture (N = 0). Which driver draws is in the results: Mesa's llvmpipe is the processor, no GPU.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

import measure
from eigenfield.core.camera import Camera
from eigenfield.core.scene import Scene
from eigenfield.rendering import OpenGLRenderer, novel_camera, view_weights
from eigenfield.rendering.opengl.renderer import make_context
from eigenfield.rendering.options import TEXTURE_FILTERS
from render import COUNTS, SIDE, array, relief, scene_of

MONO, EYE = (1920, 1080), (1832, 1920)
SECONDS, FEWEST, MOST = 2.0, 3, 240  # measured of each, and frames
PATIENCE = 3.0  # seconds a frame; of what takes longer, more textures are not tried
HALF_BASELINE = 0.02  # of the view plane's unit: the array is 0.8 wide


def mono(scene: Scene, renderer: OpenGLRenderer, turn: float) -> None:
    at = (0.7 * np.cos(turn), 0.7 * np.sin(turn))
    renderer.paint(novel_camera(scene, at).resize(*MONO), view_weights(scene, at))


def stereo(scene: Scene, renderer: OpenGLRenderer, turn: float) -> None:
    camera = novel_camera(scene, (0.5 * np.cos(turn), 0.5 * np.sin(turn))).resize(*EYE)
    for side in (-HALF_BASELINE, HALF_BASELINE):
        eye = camera.centre + np.array([side, 0.0, 0.1 * np.sin(3 * turn)])
        renderer.paint(Camera(camera.K, camera.R, -camera.R @ eye, *EYE))


def milliseconds(
    scene: Scene, renderer: OpenGLRenderer, frame: Callable[[Scene, OpenGLRenderer, float], None]
) -> float:
    """The median frame."""
    taken: list[float] = []
    frame(scene, renderer, 0.0)
    renderer.context.finish()
    while len(taken) < FEWEST or (sum(taken) < SECONDS and len(taken) < MOST):
        started = time.perf_counter()
        frame(scene, renderer, 2 * np.pi * len(taken) / 60)
        renderer.context.finish()
        taken.append(time.perf_counter() - started)
    return 1e3 * float(np.median(taken))


def main() -> None:
    context = make_context()
    figures: dict[str, Any] = {"driver": str(context.info["GL_RENDERER"]), "atlas": SIDE, "mono": MONO, "eye": EYE}
    print(figures["driver"])
    figures["counts"] = {}
    mesh, cameras = relief(), array()
    plain: dict[str, float] = {}
    last: dict[str, float] = {}
    for count in (0, *COUNTS):
        scene = scene_of(mesh, cameras, count)
        row: dict[str, Any] = {}
        for filter in TEXTURE_FILTERS:
            with OpenGLRenderer(scene, filter=filter, context=context) as renderer:
                for name, frame in (("mono", mono), ("stereo", stereo)):
                    key = f"{name}_{filter}"
                    if last.get(key, 0.0) > 1e3 * PATIENCE:
                        continue
                    took = last[key] = milliseconds(scene, renderer, frame)
                    plain.setdefault(name, took)  # N = 0, bilinear: the first of all
                    row[key] = {"fps": round(1e3 / took, 2), "times_plain": round(took / plain[name], 2)}
        figures["counts"][str(count)] = row
        print(count, row, flush=True)
    print(f"stored as {measure.store('render-opengl', figures)}")


if __name__ == "__main__":
    main()
