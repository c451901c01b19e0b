"""What geometry costs where it is known: the demo's capture, with its own cameras and proxy and with estimated ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import eigenfield as ef
from eigenfield.capture import LightField, open_capture, open_photographs
from eigenfield.core.scene import Scene
from eigenfield.evaluation.session import Session, start_session
from eigenfield.imaging.metrics import to_codes
from evidence.losses import Pictures, Views, shifts
from evidence.prepared import every, spread_over_array

SAMPLE = 16  # cameras of each kind
TEXTURES, DENSITY = 15, 1.0
WORDS = (
    "The demo's capture, drawn from exact geometry: encoded with its true cameras and proxy, and with cameras and "
    "proxy estimated from the bare photographs; float textures, no coding; pixels that both cover. cost: what "
    "estimated geometry loses, in dB, the truth; displacement.gain: what moving each picture by at most 2 px brings "
    "back, the estimate that captures without a truth have to do with; with true geometry it says what the estimate "
    "finds where there is nothing to find."
)


def true_geometry(folder: Path, work: Path) -> dict[str, Any]:
    """Figures under "encoded" and "held_out" (odd rows and columns), each with "true" and "estimated" geometry.

    Every second row and column counts. folder: as `draw_demo_capture` writes it: images, transforms.json and proxy.ply.
    work: a folder that keeps the stages of the reconstruction.
    """
    exact = every(open_capture(folder), 2)
    bare = open_photographs(folder)
    bare = bare.subset([bare.names.index(name) for name in exact.names])
    made = ef.reconstruct(bare, work=work)
    options: dict[str, Any] = {"textures": TEXTURES, "density": DENSITY, "hold_out": "odd", "fit": "none"}
    scenes = {
        "true": (ef.encode(exact, folder / "proxy.ply", **options), exact),
        "estimated": (ef.encode(made.light_field, made.proxy, **options), made.light_field),
    }
    first = scenes["true"][0]
    parts = {"encoded": first.rig.encoded.tolist(), "held_out": np.flatnonzero(first.rig.held_out).tolist()}
    result: dict[str, Any] = {"views": len(exact), "textures": TEXTURES, "density": DENSITY, "words": WORDS}
    for part, indices in parts.items():
        result[part] = compare(scenes, [first.rig.names[i] for i in spread_over_array(first, indices, SAMPLE)])
    return result


def compare(scenes: Mapping[str, tuple[Scene, LightField]], names: Sequence[str]) -> dict[str, Any]:
    """The same cameras, by name, drawn from scenes of "true" and "estimated" geometry; see `true_geometry`."""
    drawn: dict[str, Pictures] = {}
    covered: dict[int, NDArray[np.bool_]] = {}
    photographs: Pictures = {}
    for kind, (scene, capture) in scenes.items():
        session = start_session(scene, capture)
        drawn[kind] = {}
        for place, name in enumerate(names):
            picture = session.picture(scene.rig.names.index(name))
            drawn[kind][place] = to_codes(picture.image)
            covered[place] = picture.covered & covered.get(place, picture.covered)
            photographs[place] = _photograph(session, name)
    views = Views(photographs, covered)
    result: dict[str, Any] = {"cameras": len(names)}
    for kind, pictures in drawn.items():
        result[kind] = {**views.measure(pictures), "displacement": shifts(views, pictures)}
    result["cost"] = result["true"]["psnr_of_mse"] - result["estimated"]["psnr_of_mse"]
    return result


def _photograph(session: Session, name: str) -> NDArray[np.uint8]:
    return to_codes(session.photograph(session.scene.rig.names.index(name)).pixels)
