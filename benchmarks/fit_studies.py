"""What each part of the fit is worth: it is taken away, and the file that is left is compared with the whole fit's.

    EIGENFIELD_DATA=captures python benchmarks/fit_studies.py [CAPTURE ...] [--parts regions,...] [--store]
    EIGENFIELD_DATA=captures python benchmarks/fit_studies.py CAPTURE --held-out [--store]

Five captures unless some are named: every second row and column of dense arrays, all views of sparse ones. Photographs
of more than MAX_PIXELS are halved: large ones would take most of the time. The whole fit is coded at three qualities,
which make a curve; without a part it is coded once, at the default's quality, and both differences are read off that
curve: bytes at equal quality, and quality at equal bytes. Parts that only code share one fit, and parts that only fit
share one mesh, so that all of it takes less than an hour on two cores.

`--held-out`: the capture's hold-out rule, one fit, quality against bytes in captured views and in those left out.

What is done stays in OUT, and a run that was stopped goes on there while the code is the same.
"""

from __future__ import annotations

import argparse
import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, nullcontext
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from numpy.typing import NDArray

import eigenfield as ef
import measure
from eigenfield import LightField
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene
from eigenfield.encoding import EncodeOptions, prepare
from eigenfield.encoding import options as encode_options
from eigenfield.encoding.fitted import encoder, fit, planes, rate
from eigenfield.encoding.fitted.encoder import FittedEncoder, open_encoder
from eigenfield.encoding.fitted.observations import FitData, open_fit_data
from eigenfield.encoding.plan import EncodePlan
from eigenfield.encoding.reach_target import open_fitted
from eigenfield.gltf import save
from eigenfield.rendering.software import drawing
from eigenfield.runtime.parallel import parallel_map
from evidence import captures, ours, prepared
from evidence.prepared import Prepared
from evidence.runner import kept

CAPTURES = ("tarot", "boxes", "shop", "cube", "tarot-5x4")
QUALITY = encode_options.PRESETS["balanced"].quality
QUALITIES = (80, QUALITY, 94)
KEYS = ("psnr", "psnr_luma", "ssim")
MAX_PIXELS = 1 << 19  # of a photograph
Change = Callable[[], AbstractContextManager[Any]]


@dataclass(frozen=True)
class Part:
    """A part of the fit that is taken away.

    Attributes:
        words: What the fit is without it.
        change: Takes it away.
        few: Whether it is about captures of few cameras alone.
    """

    words: str
    change: Change
    few: bool = False


def _replaced(module: Any, name: str, value: Any) -> Change:
    return lambda: patch.object(module, name, value)


def _plane_presets(change: Callable[[planes.PlanePreset], planes.PlanePreset]) -> Change:
    return lambda: patch.object(planes, "PLANE_PRESETS", tuple(map(change, planes.PLANE_PRESETS)))


@contextlib.contextmanager
def _all(*changes: Change) -> Iterator[None]:
    with ExitStack() as stack:
        for change in changes:
            stack.enter_context(change())
        yield


def _no_rounds() -> AbstractContextManager[Any]:
    presets = {name: replace(one, rounds=0) for name, one in encode_options.PRESETS.items()}
    few = _replaced(planes, "FEW_OBSERVATIONS_ROUNDS", ())
    return _all(lambda: patch.dict(encode_options.PRESETS, presets), few)


def _equal_steps(block: Any, scales: Any) -> NDArray[np.float32]:
    return np.full(block.count, np.median(_weight_steps(block, scales)), np.float32)


_weight_steps = fit._weight_steps
_code_plane = fit.code_plane
_one_sample = _replaced(drawing, "MULTISAMPLE_OFFSETS_PX", drawing.CENTRE_OFFSETS_PX)

CODING = {
    "loop": Part(
        "open loop: weights and mean not fitted to the coded textures",
        partial(_all, _replaced(fit, "fit_weights", lambda *_: None), _replaced(fit, "FIT_CLOSING_ITERATIONS", 0)),
    ),
    "closing": Part("the mean not fitted again to the coded textures", _replaced(fit, "FIT_CLOSING_ITERATIONS", 0)),
    "components": Part("all components kept, whatever they cost", _replaced(rate, "RATE_LAMBDA_PER_SQUARED_STEP", 0.0)),
    "precision": Part("the mean coded as finely everywhere", _replaced(planes, "mean_precision", lambda *_: None)),
    "weight-steps": Part("weights of all components quantised alike", _replaced(fit, "_weight_steps", _equal_steps)),
    "grid": Part(
        "weights not predicted across the camera grid",
        _replaced(planes, "code_plane", lambda made, rate, grid, *rest: _code_plane(made, rate, None, *rest)),
    ),
}
FITTING = {
    "rounds": Part("no fit in the pictures: the mean, then the decomposition of what it leaves", _no_rounds),
    "few-rounds": Part(
        "as many rounds as with many cameras", _replaced(planes, "FEW_OBSERVATIONS_ROUNDS", ()), few=True
    ),
    "robust": Part(
        "all pixels count alike", _replaced(planes, "with_robust_weights", lambda data, _: nullcontext(data)), few=True
    ),
    "coarse": Part(
        "textures as dense as the mean", _plane_presets(lambda one: replace(one, texture_share=one.mean_share))
    ),
    "ahead": Part("chroma no denser than the atlas asks", _plane_presets(lambda one: replace(one, ahead=0.0))),
    "regions": Part("no regions", _replaced(fit, "find_regions", lambda *_: [])),
    "unseen": Part("texels that no photograph sees left as they are", _replaced(fit, "fill_unseen", lambda *_: None)),
}
PLANNING = {
    "surface": Part("the proxy's surface as it was given", _replaced(prepare, "fit_surface", lambda mesh, *_: mesh)),
    "triangles": Part("triangles not chosen by what they cost", _replaced(prepare, "_simplifies", lambda _: False)),
    "edges": Part("one sample a pixel at edges too, in the fit and in drawing", _one_sample),
}
PARTS = CODING | FITTING | PLANNING


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("capture", nargs="*", default=CAPTURES, metavar="CAPTURE")
    parser.add_argument("--parts", default=",".join(PARTS), help="commas between")
    parser.add_argument("--held-out", action="store_true", help="held-out views against bytes instead")
    parser.add_argument("--out", type=Path, default=Path("studies"))
    parser.add_argument("--store", action="store_true", help="append to benchmarks/results/fit-studies.json")
    options = parser.parse_args()
    out, figures = options.out.resolve(), {}
    for name in options.capture:
        capture = captures.named(name, out)
        work = out / capture.name
        prepared.estimate(capture, work)
        ready = prepared.prepare(capture, work)
        if options.held_out:
            found = {"held_out": _kept(work / "held-out.json", partial(held_out, ready))}
        else:
            found = {"parts": of_parts(ready, options.parts.split(","))}
        figures[capture.name] = found
        if options.store:
            print(measure.store("fit-studies", {"captures": prepared.as_json({capture.name: found})}))


@dataclass(frozen=True, eq=False)
class Views:
    """The photographs that files are measured by, and which of their pixels count.

    Attributes:
        field: The capture.
        photographs: (H, W, 3) of each.
        covered: (H, W) of each, by the first file that is measured, so that the same pixels count for all.
    """

    field: LightField
    photographs: list[NDArray[np.uint8]]
    covered: list[NDArray[np.bool_]]

    def point(self, scene: Scene, path: Path) -> dict[str, Any]:
        """Bytes and textures of the scene's file, and the means of KEYS over its views."""
        save(scene, path, overwrite=True)
        of_views = range(len(self.photographs)), self.photographs, self.counted(path), self.field.names
        point = ours.figures(path, *of_views)
        figures = {key: point[key] for key in KEYS}
        return {"bytes": path.stat().st_size, "textures": scene.appearance.textures, **figures}

    def counted(self, path: Path) -> list[NDArray[np.bool_]]:
        if not self.covered:
            self.covered.extend(ours.covered_pixels(path, range(len(self.field)), self.field))
        return self.covered


class Fit:
    """A capture's fit: mesh, footprints and planes, each made when it is first needed."""

    def __init__(self, field: LightField, mesh: Any, work: Path, opened: ExitStack) -> None:
        self.field, self.mesh, self.work, self._opened = field, mesh, work, opened

    @cached_property
    def plan(self) -> EncodePlan:
        return prepare.plan_encoding(self.field, self.mesh, EncodeOptions(fit="photographs"), self.work)

    @cached_property
    def data(self) -> FitData:
        ready, views = self.plan, self.plan.views
        size = ready.atlas[1], ready.atlas[0]
        cameras, reference = views.rig.encoded_cameras, views.rig.encoded_reference
        return self._opened.enter_context(
            open_fit_data(cameras, views.observations, Proxy(ready.mesh), size, self.work, reference=reference)
        )

    @cached_property
    def whole(self) -> FittedEncoder:
        return self._opened.enter_context(_fitted(self.plan, self.data, self.work))

    def without(self, name: str) -> Scene:
        """The scene coded at the default's quality without a part."""
        part = PARTS[name]
        if name in CODING:
            whole = self.whole
            with part.change():
                return whole.encode(QUALITY)
        if name in FITTING:
            fitted = _fitted(self.plan, self.data, self.work)
        else:
            fitted = open_fitted(self.field, self.mesh, EncodeOptions(), self.work)
        with part.change(), fitted as made:
            return made.encode(QUALITY)


@contextlib.contextmanager
def _fitted(ready: EncodePlan, data: FitData, work: Path) -> Iterator[FittedEncoder]:
    """A plan's fit on footprints that are there."""
    with ExitStack() as opened:
        with patch.object(encoder, "open_fit_data", lambda *_: nullcontext(data)):
            made = opened.enter_context(open_encoder(ready, work, warn=False))
        yield made


def of_parts(ready: Prepared, chosen: Sequence[str]) -> dict[str, Any]:
    """The whole fit's curve, and for each part what is lost without it (`beside`)."""
    field = ready.light_field
    if prepared.grid_of(field) is not None and len(field) >= encode_options.SUBSAMPLE_MIN_OBSERVATIONS:
        field = prepared.every(field, 2)
    if max(width * height for width, height in field.sizes) > MAX_PIXELS:
        field = prepared.halved(field, ready.work / "halved")
    few = len(field) < encode_options.SUBSAMPLE_MIN_OBSERVATIONS
    chosen = [name for name in PARTS if name in chosen and (few or not PARTS[name].few)]
    views = Views(field, parallel_map(lambda index: prepared.codes(field, index), range(len(field))), [])
    with ExitStack() as opened:
        made = Fit(field, ready.mesh, ready.work, opened)

        def curve() -> dict[str, Any]:
            points = [
                {"parameter": quality, **views.point(made.whole.encode(quality), ready.work / f"whole-{quality}.glb")}
                for quality in QUALITIES
            ]
            return {"points": points}

        whole = _kept(ready.work / "whole.json", curve)
        views.counted(ready.work / f"whole-{QUALITIES[0]}.glb")
        found: dict[str, Any] = {"whole": {"words": "the whole fit", **whole}}
        for name in chosen:

            def point(name: str = name) -> dict[str, Any]:
                return views.point(made.without(name), ready.work / f"{name}.glb")

            one = _kept(ready.work / f"{name}.json", point)
            found[name] = {"words": PARTS[name].words, **one, **beside(whole["points"], one)}
            rate, gain = found[name]["rate"], found[name]["gain"]
            print(
                f"{ready.capture.name}, {PARTS[name].words}: {one['bytes'] / 1e3:.1f} kB {one['psnr']:.2f} /"
                f" {one['psnr_luma']:.2f} dB; bytes {rate['psnr']:+.1f} / {rate['psnr_luma']:+.1f} %,"
                f" {gain['psnr']:+.2f} / {gain['psnr_luma']:+.2f} dB",
                flush=True,
            )
    return found


def beside(points: Sequence[Mapping[str, Any]], one: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """A file beside a curve of quality over log bytes, which is a line between its points and goes on beyond them.

    rate: by how many percent the file is larger than the curve's of equal quality. gain: by how much it is better than
    the curve's of equal bytes.
    """
    sizes = np.log([point["bytes"] for point in points])
    rate, gain = {}, {}
    for key in KEYS:
        values = np.array([point[key] for point in points])
        rate[key] = float(100 * np.expm1(np.log(one["bytes"]) - _line(values, sizes, one[key])))
        gain[key] = float(one[key] - _line(sizes, values, float(np.log(one["bytes"]))))
    return {"rate": rate, "gain": gain}


def _line(x: NDArray[np.float64], y: NDArray[np.float64], at: float) -> float:
    """Through the two points around `at`, or at the end nearest to it."""
    piece = min(max(int(np.searchsorted(x, at)) - 1, 0), len(x) - 2)
    slope = (y[piece + 1] - y[piece]) / (x[piece + 1] - x[piece])
    return float(y[piece] + slope * (at - x[piece]))


def _kept(place: Path, make: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    return kept(place, Path(__file__), make, str(QUALITIES))


def held_out(ready: Prepared) -> dict[str, Any]:
    """Quality of captured and of held-out views against bytes, all of a view and outside the capture's circles."""
    points = []
    with open_fitted(ready.light_field, ready.mesh, EncodeOptions(hold_out=ready.hold_out), work=ready.work) as made:
        for quality in QUALITIES:
            path = ready.work / f"held-{quality}.glb"
            save(made.encode(quality), path, overwrite=True)
            scene = ef.load(path)
            figures = ef.evaluate(scene, ready.light_field, path=path, circles=ready.circles(), png_maps="none")
            image = figures["image"]
            point: dict[str, Any] = {
                "parameter": quality, "bytes": path.stat().st_size, "textures": scene.appearance.textures,
            }  # fmt: skip
            for part in ("encoded", "held_out"):
                point[part] = {key: value for key, value in image[part].items() if not isinstance(value, (list, str))}
            points.append(point)
            print(f"{ready.hold_out}, {point['bytes'] / 1000:.1f} kB: {point}", flush=True)
    return {"rule": ready.hold_out, "points": points}


if __name__ == "__main__":
    main()
