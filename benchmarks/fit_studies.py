"""What each part of a fit is worth, and what its bytes buy between the cameras.

    EIGENFIELD_DATA=captures python benchmarks/fit_studies.py [CAPTURE] [--levers planes,...] [--out studies] [--store]

Levers: every second row and column of a dense capture, fitted and coded with one lever off at a time, everything else
as it is; bytes at equal quality against all levers on (Bjøntegaard), and what is reached without coding. Held out: the
capture's hold-out rule, one fit, quality against bytes in captured views and in those left out. What is done stays in
OUT, and a run that was stopped goes on there while the code is the same.
"""

from __future__ import annotations

import argparse
import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from numpy.typing import NDArray

import eigenfield as ef
import measure
from eigenfield import LightField
from eigenfield.encoding import EncodeOptions, plan
from eigenfield.encoding import options as encode_options
from eigenfield.encoding.fitted import fit, planes, rate
from eigenfield.encoding.fitted.encoder import open_fitted
from eigenfield.encoding.geometry.coded import coded_mesh
from eigenfield.gltf import save
from eigenfield.imaging.metrics import to_codes
from eigenfield.rendering import Renderer, camera_weights
from eigenfield.rendering.software import drawing
from eigenfield.runtime.parallel import parallel_map
from evidence import captures, ours, prepared, rates
from evidence.prepared import Prepared
from evidence.runner import kept

QUALITIES = (80, 88, 94)
NO_OPTIONS = EncodeOptions()
KEYS = ("psnr", "psnr_luma", "ssim")


@dataclass(frozen=True)
class Lever:
    """A part of the fit that is taken away. change: what makes the fit without it; coding: what codes without it."""

    words: str
    change: Callable[[], contextlib.AbstractContextManager[Any]] = contextlib.nullcontext
    coding: Callable[[], contextlib.AbstractContextManager[Any]] = contextlib.nullcontext
    options: EncodeOptions = NO_OPTIONS
    filter: str = "bicubic"


def _plane_presets(
    change: Callable[[planes.PlanePreset], planes.PlanePreset],
) -> contextlib.AbstractContextManager[Any]:
    return patch.dict(planes.PLANE_PRESETS, {"luma-chroma": tuple(map(change, planes.PLANE_PRESETS["luma-chroma"]))})


def _open_loop() -> contextlib.AbstractContextManager[Any]:
    """Weights and mean as they were before the textures were coded."""
    stack = contextlib.ExitStack()
    stack.enter_context(patch.object(fit, "fit_weights", lambda *_: None))
    stack.enter_context(patch.object(fit, "CLOSING_STEPS", 0))
    return stack


def _whole(mesh: Any, cameras: Any, reference: int, *_: Any) -> Any:
    return coded_mesh(mesh, cameras, reference)


def _no_rounds() -> contextlib.AbstractContextManager[Any]:
    none = {name: replace(one, rounds=0) for name, one in encode_options.PRESETS.items()}
    stack = contextlib.ExitStack()
    stack.enter_context(patch.dict(encode_options.PRESETS, none))
    stack.enter_context(patch.object(planes, "FEW_ROUNDS", 0))
    return stack


def _all_kept() -> contextlib.AbstractContextManager[Any]:
    stack = contextlib.ExitStack()
    stack.enter_context(patch.object(rate, "LAGRANGE", 0.0))
    stack.enter_context(patch.object(rate, "OTHER_STEPS", ()))  # without a price the finest would always be best
    return stack


LEVERS = {
    "all": Lever("all on"),
    "rounds": Lever("no fit in the pictures: the mean, then the decomposition of what it leaves", _no_rounds),
    "loop": Lever("open loop: weights and mean not fitted to the coded textures", coding=_open_loop),
    "planes": Lever("R, G and B in one plane (`--planes rgb`)", options=EncodeOptions(planes="rgb")),
    "dense": Lever(
        "the mean as coarse as the textures",
        lambda: _plane_presets(lambda one: replace(one, mean_share=one.texture_share)),
    ),
    "coarse": Lever(
        "textures as dense as the mean",
        lambda: _plane_presets(lambda one: replace(one, texture_share=one.mean_share)),
    ),
    "rank": Lever("15 textures", options=EncodeOptions(textures=15)),
    "regions": Lever("no regions", lambda: patch.object(fit, "find_regions", lambda *_: [])),
    "worth": Lever("all components kept, worth their bytes or not", coding=_all_kept),
    "step": Lever("textures coded at their usual step", coding=lambda: patch.object(rate, "OTHER_STEPS", ())),
    "precision": Lever(
        "the mean coded as finely everywhere", coding=lambda: patch.object(planes, "mean_precision", lambda *_: None)
    ),
    "unseen": Lever("texels that no photograph sees left as they are", lambda: patch.object(fit, "fill_unseen")),
    "surface": Lever(
        "the proxy's surface as it was given", lambda: patch.object(plan, "fit_surface", lambda mesh, *_: mesh)
    ),
    "edges": Lever(
        "one sample a pixel at edges too, in the fit and in drawing",
        lambda: patch.object(drawing, "STANDARD", drawing.CENTRE),
    ),
    "relief": Lever("the relief not simplified", lambda: patch.object(plan, "slim_mesh", _whole)),
    "bilinear": Lever("fitted for bicubic drawing, drawn bilinearly", filter="bilinear"),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("capture", nargs="?", default="tarot", metavar="CAPTURE")
    parser.add_argument(
        "--levers", default=",".join(list(LEVERS)[1:]), help="commas between; none: held-out views alone"
    )
    parser.add_argument("--out", type=Path, default=Path("studies"))
    parser.add_argument("--store", action="store_true", help="append to benchmarks/results/fit-studies.json")
    options = parser.parse_args()
    out = options.out.resolve()
    capture = captures.named(options.capture, out)
    figures = of_capture(capture, out / capture.name, options.levers.split(","))
    if options.store:
        print(measure.store("fit-studies", {"captures": prepared.as_json({capture.name: figures})}))


def of_capture(capture: captures.Capture, work: Path, levers: list[str]) -> dict[str, Any]:
    """Both studies of one capture."""
    prepared.estimate(capture, work)
    ready = prepared.prepare(capture, work)
    chosen = (
        ["all", *(name for name in LEVERS if name in levers and name != "all")] if set(levers) & set(LEVERS) else []
    )
    return {
        "levers": of_levers(ready, chosen),
        "held_out": _kept(ready.work / "held-out.json", partial(held_out, ready)),
    }


def of_levers(ready: Prepared, chosen: list[str]) -> dict[str, Any]:
    """For each lever the curve without it, and Bjøntegaard's rates against all of them on."""
    field = prepared.every(ready.light_field, 2)
    photographs = parallel_map(lambda index: prepared.codes(field, index), range(len(field)))

    @cache
    def covered() -> list[NDArray[np.bool_]]:
        """By the files of all levers on, which come first: the same pixels count for all."""
        return ours.covered_pixels(ready.work / f"all-{QUALITIES[0]}.glb", range(len(field)), field)

    found: dict[str, Any] = {}
    for name in chosen:
        curve = _kept(ready.work / f"{name}.json", partial(of_lever, ready, name, field, photographs, covered))
        points = curve["points"]
        base = found["all"]["points"] if found else points
        dearer = {key: rates.bd_rate(base, points, key) for key in KEYS}
        gain = {key: rates.bd_quality(base, points, key) for key in KEYS}
        found[name] = {"words": LEVERS[name].words, **curve, "rate": dearer, "gain": gain}
        said = "; ".join(f"{p['bytes'] / 1000:.1f} kB {p['psnr']:.2f} / {p['psnr_luma']:.2f} dB" for p in points)
        print(f"{LEVERS[name].words}: {said}; rate {dearer}", flush=True)
    return found


def of_lever(
    ready: Prepared,
    name: str,
    field: LightField,
    photographs: list[NDArray[np.uint8]],
    covered: Callable[[], list[NDArray[np.bool_]]],
) -> dict[str, Any]:
    """The curve without a lever, and what is reached without coding. covered: asked for once there is a file."""
    lever, points = LEVERS[name], []
    with lever.change(), open_fitted(field, ready.mesh, lever.options, work=ready.work) as encoder:
        for quality in QUALITIES:
            with lever.coding():
                scene = encoder.coded(quality)
            path = ready.work / f"{name}-{quality}.glb"
            save(scene, path, overwrite=True)
            figures = drawn_figures(path, photographs, covered(), field.names, lever.filter)
            points.append({"parameter": quality, "bytes": path.stat().st_size, **figures})
    uncoded = {plane: one["uncoded"] for plane, one in scene.settings["fitted"]["psnr"].items()}
    return {"points": points, "uncoded": uncoded}


def _kept(place: Path, make: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    return kept(place, Path(__file__), make, str(QUALITIES))


def drawn_figures(
    path: Path,
    photographs: list[NDArray[np.uint8]],
    covered: list[NDArray[np.bool_]],
    names: Sequence[str],
    filter: str,
) -> dict[str, Any]:
    """`rates.point` of a file's captured views, drawn with a filter."""
    scene = ef.load(path)
    renderer = Renderer(scene)

    def pictures() -> Iterator[NDArray[np.uint8]]:
        for index in range(len(photographs)):
            picture = renderer.draw(scene.cameras[index], camera_weights(scene, index), filter=filter)
            yield to_codes(picture.image)

    return rates.point(pictures(), photographs, covered, names)


def held_out(ready: Prepared) -> dict[str, Any]:
    """Quality of captured and of held-out views against bytes, all of a view and outside the capture's circles."""
    points = []
    with open_fitted(ready.light_field, ready.mesh, EncodeOptions(hold_out=ready.hold_out), work=ready.work) as encoder:
        for quality in QUALITIES:
            path = ready.work / f"held-{quality}.glb"
            save(encoder.coded(quality), path, overwrite=True)
            scene = ef.load(path)
            figures = ef.evaluate(scene, ready.light_field, path=path, circles=ready.circles(), png_maps="none")
            image = figures["image"]
            point: dict[str, Any] = {
                "parameter": quality, "bytes": path.stat().st_size, "textures": scene.textures,
            }  # fmt: skip
            for part in ("encoded", "held_out"):
                point[part] = {key: value for key, value in image[part].items() if not isinstance(value, (list, str))}
            points.append(point)
            print(f"{ready.hold_out}, {point['bytes'] / 1000:.1f} kB: {point}", flush=True)
    return {"rule": ready.hold_out, "points": points}


if __name__ == "__main__":
    main()
