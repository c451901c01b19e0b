"""How near a finished scene comes to photographs: to those it was made from, and between them.

Photographs that were held out are drawn and compared. Where none were, what the scene draws there is estimated:

- Of few cameras, or of cameras far apart, mean and eigen textures are made again in a short way, on the finished
  geometry and without some photographs, and drawn at their cameras. That is a lower estimate.
- Of many cameras near each other, the finished scene draws some with the weights of those around them.

docs/measures.md compares both with held-out views.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from eigenfield.core.observations import select_cameras
from eigenfield.core.progress import Progress
from eigenfield.core.scene import Scene
from eigenfield.core.spread import spread_indices
from eigenfield.encoding.fitted.colour import split_matrix
from eigenfield.encoding.fitted.fit import NOTHING_WANTED
from eigenfield.encoding.fitted.model import PlaneModel
from eigenfield.encoding.fitted.observations import FitData, open_fit_data, open_subsampled
from eigenfield.encoding.fitted.passes import psnr_of
from eigenfield.encoding.fitted.planes import plane_size
from eigenfield.encoding.fitted.solve import fit_textures, measure_scales, residual
from eigenfield.encoding.fitted.start import principal_block
from eigenfield.encoding.left_out import (
    farthest_neighbour,
    has_scores,
    interpolation,
    is_sparse,
    others_around,
    places_of,
    spread_inside,
)
from eigenfield.encoding.plan import EncodePlan
from eigenfield.imaging.metrics import psnr
from eigenfield.rendering import Renderer, ViewWeights, camera_weights
from eigenfield.runtime.parallel import parallel_map

BETWEEN_PIXEL_STEP = 2  # each way
BETWEEN_DENSITIES = (0.07, 0.14, 0.28, 0.55)  # of the atlas's, one after the other: coarse ones fill what few see
BETWEEN_TEXTURE_DENSITY = 0.28  # likewise
BETWEEN_ITERATIONS = 4  # of conjugate gradients at each
BETWEEN_SMOOTHNESS = 8.0  # of the fit's
MEASURED_MAX_CAMERAS = 16  # of the captured ones, evenly spread


def measure_scene(
    scene: Scene, plan: EncodePlan, work: Path | None = None, progress: Progress | None = None
) -> dict[str, Any]:
    """The scores of a scene for its file (docs/measures.md); empty where `has_scores` says no.

    Args:
        scene: Made of the plan's photographs.
        work: Folder for scratch files of 4 bytes a pixel of the cameras that take part, and about 9 more.

    Raises:
        CaptureError: A photograph cannot be read.
        OutputError: `disk-full`.
    """
    rig, encoded = plan.views.rig, plan.views.rig.encoded
    if not has_scores(plan):
        return {}
    some = spread_indices(len(encoded), MEASURED_MAX_CAMERAS)
    image = {"encoded": _drawn(scene, plan, encoded[some].tolist())}
    held_out = np.flatnonzero(rig.held_out).tolist()
    if held_out:
        image["held_out"] = _drawn(scene, plan, held_out)
        if image["held_out"]["cameras"]:
            return {"image": image}
    left_out = spread_inside(rig)
    if not is_sparse(plan):
        drawn = _drawn(scene, plan, encoded[left_out].tolist(), partial(_weights_of_others, scene))
        return {"image": image, "between": drawn}
    values = _drawn_by_others(plan, left_out, work, progress)
    if not values:
        return {"image": image}
    worst = min(values, key=values.__getitem__)
    widest = [rig.names[encoded[worst]], rig.names[encoded[farthest_neighbour(rig, worst)]]]
    at_least = round(float(np.mean(list(values.values()))), 2)
    return {"image": image, "between": {"cameras": len(values), "psnr_luma_at_least": at_least, "widest": widest}}


def _drawn(
    scene: Scene, plan: EncodePlan, cameras: Sequence[int], weights: Callable[[int], ViewWeights] | None = None
) -> dict[str, Any]:
    """Mean PSNR of photographs, drawn as `evaluate` does, or with other weights of their cameras."""
    renderer, capture = Renderer(scene), plan.views.capture
    weights = partial(camera_weights, scene) if weights is None else weights
    of_camera = {capture.camera_of(index): index for index in range(len(capture))}

    def measure(camera: int) -> float | None:
        drawn = renderer.draw(scene.rig.cameras[camera], weights(camera))
        photograph = capture.photograph(of_camera[camera])
        covered = drawn.covered if photograph.mask is None else drawn.covered & (photograph.mask > 0.5)
        return psnr(drawn.image, photograph.pixels, covered)

    values = [value for value in parallel_map(measure, cameras) if value is not None]
    return {"cameras": len(values), "psnr": round(float(np.mean(values)), 2) if values else None}


def _weights_of_others(scene: Scene, camera: int) -> ViewWeights:
    """What an encoded camera's place takes of those of others."""
    rig = scene.rig
    place, index = places_of(rig), int(np.searchsorted(rig.encoded, camera))
    others = np.flatnonzero(place != place[index])
    row = interpolation(rig, others.tolist(), [index])[0]
    return ViewWeights(scene.rows(rig.encoded[others[row != 0]]), row[row != 0])


def _drawn_by_others(
    plan: EncodePlan, left_out: Sequence[int], work: Path | None, progress: Progress | None
) -> dict[int, float]:
    """dB of luma for each camera left out, drawn from the others: of many cameras from those around it. Cameras that
    show nothing of the scene have none."""
    rig, size = plan.views.rig, (plan.atlas[1], plan.atlas[0])
    others = sorted(others_around(rig, left_out))
    order = [*others, *left_out]
    cameras, observations = [rig.encoded_cameras[i] for i in order], select_cameras(plan.views.observations, order)
    reference = order.index(rig.encoded_reference)
    with (
        open_fit_data(cameras, observations, plan.proxy, size, work, progress, reference) as whole,
        open_subsampled(whole, BETWEEN_PIXEL_STEP, work) as data,
    ):
        known = _first(data, len(others))
        grid = plane_size(size, BETWEEN_TEXTURE_DENSITY)
        model = PlaneModel(split_matrix()[0], np.full((1, 1, 1), 0.5, np.float32), grid, [])
        for density in BETWEEN_DENSITIES:
            rows, columns = plane_size(size, density)
            finer = cv2.resize(model.mean[0], (columns, rows), interpolation=cv2.INTER_CUBIC)
            model = replace(model, mean=np.ascontiguousarray(finer, np.float32).reshape(1, rows, columns))
            scales = measure_scales(known, model)
            scales = replace(scales, smooth=(BETWEEN_SMOOTHNESS * scales.smooth[0], scales.smooth[1]))
            fit_textures(known, model, scales, BETWEEN_ITERATIONS, mean_only=True)
        block = principal_block(
            known, model, scales, len(others) - 1, (0, grid[0], 0, grid[1]), scattered=False, work=work
        )
        weights = np.concatenate([block.weights, interpolation(rig, others, left_out) @ block.weights])
        model = replace(model, blocks=[replace(block, weights=weights.astype(np.float32))])
        equations = residual(data, model, NOTHING_WANTED)
    squares, pixels = equations.squares, equations.pixels
    seen = [(camera, slice(i, i + 1)) for i, camera in enumerate(left_out, len(others)) if pixels[i]]
    return {camera: psnr_of(squares[one], pixels[one]) for camera, one in seen}


def _first(data: FitData, count: int) -> FitData:
    """The first so many observations."""
    given = data.observations
    part = replace(
        given, cameras=given.cameras[:count], shapes=given.shapes[:count], offsets=given.offsets[: count + 1]
    )
    return replace(data, observations=part)
