"""The stages of soft sheets: a trial on views left out, and the sheets of all views."""

from __future__ import annotations

import json
import logging
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration import triangulate_points
from eigenfield.capture import Capture, LightField
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.reconstruction.array import AlignedArray, array_depths, inverse_depths
from eigenfield.reconstruction.frame import filled_pictures, has_masks, resized_cameras
from eigenfield.reconstruction.layers import (
    LAYERS_COUNTS,
    LAYERS_DENSE_MIN_GAIN_DB,
    LAYERS_DENSE_VIEWS,
    LAYERS_MIN_GAIN_DB,
    Range,
    best_count,
    compare_held_out,
    layers_fault,
    layers_proxy,
)
from eigenfield.reconstruction.run import StageRunner
from eigenfield.reconstruction.stage_files import STAGE_PROXY_FILE, STAGE_TRIAL_FILE, read_proxy, write_proxy
from eigenfield.reconstruction.unseen import without
from eigenfield.stereo.views import Pictures

log = logging.getLogger("eigenfield.reconstruction")


def capture_fault(capture: Capture, most: int | None = None) -> str | None:
    """Why photographs can have no sheets; None if they can, as far as their cameras are known.

    Args:
        most: As of `has_masks`.

    Raises:
        CaptureError: As `has_masks`.
    """
    fault = None if capture.light_field is None else layers_fault(capture.light_field.cameras)
    if fault is None and has_masks(capture, most):
        return "photographs with masks have no layers"
    return fault


def check_capture(capture: Capture, most: int | None = None) -> None:
    """Refuse photographs that can have no sheets, as far as their cameras are known.

    Args:
        most: As of `has_masks`.

    Raises:
        OptionError: `surface`.
        CaptureError: As `has_masks`.
    """
    fault = capture_fault(capture, most)
    if fault is not None:
        raise OptionError("surface", fault, remedy="leave out --surface layers")


@dataclass(frozen=True, eq=False)
class LayerSource:
    """What soft sheets are made from.

    Attributes:
        capture: All photographs.
        light_field: Those with a camera.
        array: Cameras and depth of an array; None for other captures.
        points: (n, 3) points of structure from motion, if any.
        unseen: Names of photographs that take no part in sheets.
    """

    capture: Capture
    light_field: LightField
    array: AlignedArray | None
    points: NDArray[np.float64] | None
    unseen: frozenset[str]

    @property
    def shown(self) -> LightField:
        """The photographs that take part."""
        return without(self.light_field, self.unseen)

    @property
    def inputs(self) -> list[Any]:
        """What stages depend on."""
        known = [None if self.points is None else len(self.points)] if self.array is None else self.array.inputs
        return [known, sorted(self.unseen)]

    def views(self, run: StageRunner) -> tuple[Pictures, list[Camera], Range]:
        """The photographs that take part, their cameras at the same size, and the range of inverse depths."""
        shown = self.shown
        pictures, cameras = filled_pictures(shown), resized_cameras(shown)
        if self.array is not None:
            return pictures, cameras, array_depths(self.array)
        points = self.points
        if points is None:
            points = triangulate_points(shown, progress=run.progress)
        return pictures, cameras, inverse_depths(shown, cameras, pictures, points)


def layers_of_capture(run: StageRunner, source: LayerSource, count: int) -> Proxy:
    """The proxy of soft sheets.

    Raises:
        OptionError: `surface`: the capture can have no sheets.
    """
    triangles = run.settings.triangles

    def build(folder: Path) -> None:
        made = layers_proxy(*source.views(run), count=count, triangles=triangles, progress=run.progress)
        write_proxy(folder / STAGE_PROXY_FILE, made)

    folder = run.stage("layers", [source.inputs, count, triangles], build)
    return read_proxy(folder / STAGE_PROXY_FILE)


def asked_count(run: StageRunner, source: LayerSource) -> int:
    """The number of sheets where they are asked for: that of the settings, or the least that draws views left out
    about as well as any.

    Raises:
        OptionError: `surface`: the capture can have no sheets.
    """
    check_capture(source.shown, most=0)  # `check_settings` has looked for masks
    if run.settings.layers is not None:
        return run.settings.layers
    counts, scores, _ = _trial(run, source, None, -np.inf)
    index = best_count(counts, scores)
    log.info("layers: %d, which draw views left out with %.2f dB", counts[index], scores[index])
    return counts[index]


def better_count(run: StageRunner, source: LayerSource, mesh: Mesh) -> int | None:
    """The number of soft sheets, if they draw photographs that are left out better than an opaque surface does."""
    settings = run.settings
    if settings.layers == 1 or settings.by_hand is not None:
        return None
    fault = capture_fault(source.shown)
    if fault is not None:
        log.info("surface: opaque, since %s", fault)
        return None
    dense = source.array is not None and len(source.array.shown) >= LAYERS_DENSE_VIEWS
    gain = LAYERS_DENSE_MIN_GAIN_DB if dense else LAYERS_MIN_GAIN_DB
    counts, scores, opaque = _trial(run, source, mesh, gain)
    index = best_count(counts, scores)
    better = scores[index] > opaque + gain
    kind = "surface from all sides" if source.array is None else "relief"
    tried = ", ".join(f"{count} layers {score:.2f}" for count, score in zip(counts, scores, strict=True))
    chosen = f"{counts[index]} layers" if better else kind
    log.info("views left out: %s %.2f dB, %s; layers must gain %.1f: %s", kind, opaque, tried, gain, chosen)
    return counts[index] if better else None


def _trial(
    run: StageRunner, source: LayerSource, mesh: Mesh | None, gain: float
) -> tuple[tuple[int, ...], list[float], float]:
    """Numbers of sheets, and as `compare_held_out`. Where no range of depths is found, the opaque surface wins, which
    needed none."""
    settings = run.settings
    counts = LAYERS_COUNTS if settings.layers is None else (settings.layers,)

    def build(folder: Path) -> None:
        try:
            given = source.views(run)
        except CaptureError:
            if mesh is None:
                raise
            scores, opaque = [-np.inf] * len(counts), np.inf
        else:
            scores, opaque = compare_held_out(*given, mesh, counts=counts, min_gain=gain, progress=run.progress)
        (folder / STAGE_TRIAL_FILE).write_text(
            json.dumps([str(score) for score in (*scores, opaque)]), encoding="utf-8"
        )

    folder = run.stage("trial", [source.inputs, counts, gain, settings.triangles, settings.surface], build)
    *scores, opaque = map(float, json.loads((folder / STAGE_TRIAL_FILE).read_text(encoding="utf-8")))
    return counts, scores, opaque
