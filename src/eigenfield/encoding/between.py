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
from numpy.typing import NDArray

from eigenfield.calibration.neighbours import (
    NEIGHBOUR_MAX_PARALLAX_RATIO,
    fit_similarity,
    nearest_pairs,
    parallax_beside,
    spread_pairs,
)
from eigenfield.core.camera import Camera
from eigenfield.core.observations import select_cameras
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy, opaque_mesh
from eigenfield.core.rig import Rig
from eigenfield.core.scene import Scene
from eigenfield.encoding.fitted.colour import split_matrix
from eigenfield.encoding.fitted.fit import MEAN_WANTED, NOTHING_WANTED
from eigenfield.encoding.fitted.model import PlaneModel
from eigenfield.encoding.fitted.observations import FitData, open_fit_data, open_subsampled
from eigenfield.encoding.fitted.passes import psnr_of
from eigenfield.encoding.fitted.planes import plane_size
from eigenfield.encoding.fitted.solve import fit_textures, measure_scales, residual
from eigenfield.encoding.fitted.start import principal_block
from eigenfield.encoding.plan import EncodePlan
from eigenfield.imaging.metrics import psnr
from eigenfield.imaging.raster import rasterise_view, unproject
from eigenfield.rendering import Renderer, ViewWeights, camera_weights, delaunay_triangles
from eigenfield.rendering.weights import delaunay_weights, hull
from eigenfield.runtime.parallel import parallel_map

BETWEEN_MIN_CAMERAS = 5  # encoded ones, of which some can be left out
BETWEEN_FEW_CAMERAS = 49  # of more the finished scene tells enough, unless they are far apart
BETWEEN_PARALLAX_SIDE_PIXELS = 64  # longer side of the view in which points are taken to see how far that is
BETWEEN_MIN_SIDE_PIXELS = 128  # of smaller photographs the short way says far too little
BETWEEN_LEFT_OUT_RATIO, BETWEEN_MAX_LEFT_OUT = 1 / 4, 12  # of the cameras, at most
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
        plan: Its plan.
        work: Folder for scratch files of 4 bytes a pixel of the cameras that take part, and about 9 more.
        progress: Reports the photographs.

    Raises:
        CaptureError: A photograph cannot be read.
        OutputError: `disk-full`.
    """
    rig, encoded = plan.views.rig, plan.views.rig.encoded
    if not has_scores(plan):
        return {}
    some = np.unique(np.linspace(0, len(encoded) - 1, min(len(encoded), MEASURED_MAX_CAMERAS)).round().astype(int))
    image = {"encoded": _drawn(scene, plan, encoded[some].tolist())}
    held_out = np.flatnonzero(rig.held_out).tolist()
    if held_out:
        return {"image": {**image, "held_out": _drawn(scene, plan, held_out)}}
    left_out = spread_inside(rig)
    if not is_sparse(plan):
        drawn = _drawn(scene, plan, encoded[left_out].tolist(), partial(_weights_of_others, scene))
        return {"image": image, "between": drawn}
    values = _drawn_by_others(plan, left_out, work, progress)
    worst = left_out[int(np.argmin(values))]
    widest = [rig.names[encoded[worst]], rig.names[encoded[_farthest_neighbour(rig, worst)]]]
    at_least = round(float(np.mean(values)), 2)
    return {"image": image, "between": {"cameras": len(left_out), "psnr_luma_at_least": at_least, "widest": widest}}


def has_scores(plan: EncodePlan) -> bool:
    """Whether a scene of a plan gets scores: one of five cameras or more, whose pictures are not tiny."""
    cameras = plan.views.rig.encoded_cameras
    large = min(min(camera.width, camera.height) for camera in cameras) >= BETWEEN_MIN_SIDE_PIXELS
    return large and len(cameras) >= BETWEEN_MIN_CAMERAS


def is_sparse(plan: EncodePlan) -> bool:
    """Whether a scene with scores has few cameras, or cameras that are far apart."""
    cameras = plan.views.rig.encoded_cameras
    if not has_scores(plan):
        return False
    return len(cameras) <= BETWEEN_FEW_CAMERAS or neighbour_parallax(cameras, plan.proxy) > NEIGHBOUR_MAX_PARALLAX_RATIO


def neighbour_parallax(cameras: Sequence[Camera], proxy: Proxy) -> float:
    """What `inspect` says of neighbouring photographs, by the surface: the median parallax, over the longer side.

    Args:
        cameras: Two or more.
        proxy: That they see.
    """
    mesh = opaque_mesh(proxy)

    def measure(pair: tuple[int, int]) -> float:
        one, other = cameras[pair[0]], cameras[pair[1]]
        scale = BETWEEN_PARALLAX_SIDE_PIXELS / max(one.width, one.height)
        small = one.resize(max(1, round(scale * one.width)), max(1, round(scale * one.height)))
        inverse_depth = rasterise_view(mesh, small).inverse_depth
        row, column = np.nonzero(inverse_depth > 0)
        points = unproject(small, row, column, inverse_depth[row, column])
        source, (target, depth) = one.project(points)[0], other.project(points)
        shared = (depth > 0) & (target > 0).all(axis=1) & (target < (other.width, other.height)).all(axis=1)
        similarity = fit_similarity(source[shared], target[shared]) if shared.sum() > 2 else None
        if similarity is None:
            return np.inf
        return parallax_beside(similarity, source[shared], target[shared]) / max(one.width, one.height)

    pairs = spread_pairs(nearest_pairs(np.array([camera.centre for camera in cameras])))
    return float(np.median(parallel_map(measure, pairs)))


def spread_inside(rig: Rig) -> list[int]:
    """Cameras to leave out, counted among the encoded ones: inside their hull if any are, and no two are neighbours.

    Args:
        rig: With at least `BETWEEN_MIN_CAMERAS` encoded cameras.
    """
    near = _neighbours(rig)
    rim = set(hull(rig.triangles).ravel().tolist()) or {index for index, ones in enumerate(near) if len(ones) < 2}
    joined = [index for index, ones in enumerate(near) if ones]  # another camera may stand in the same place
    inner = [index for index in joined if index not in rim] or joined
    gaps = _gaps(rig)
    most = min(max(1, int(len(near) * BETWEEN_LEFT_OUT_RATIO)), BETWEEN_MAX_LEFT_OUT)
    chosen: list[int] = []
    for index in sorted(inner, key=lambda i: -max(gaps[i, j] for j in near[i])):
        if not near[index] & set(chosen) and len(chosen) < most:
            chosen.append(index)
    return sorted(chosen)


def _gaps(rig: Rig) -> NDArray[np.float64]:
    """(Ne, Ne) distances between encoded cameras, in world units."""
    centres = np.array([camera.centre for camera in rig.encoded_cameras])
    return np.asarray(np.linalg.norm(centres[:, None] - centres, axis=2))


def _neighbours(rig: Rig) -> list[set[int]]:
    """Of each encoded camera, those with which it has an edge; on a line the nearest along it."""
    near: list[set[int]] = [set() for _ in rig.encoded]
    pairs = rig.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    if not len(pairs):
        places = rig.view_plane.coordinates([camera.centre for camera in rig.encoded_cameras])
        order = np.lexsort((places[:, 1], places[:, 0]))
        pairs = np.stack([order[:-1], order[1:]], axis=1)
    for a, b in pairs.tolist():
        near[a].add(b)
        near[b].add(a)
    return near


def _farthest_neighbour(rig: Rig, index: int) -> int:
    return max(sorted(_neighbours(rig)[index]), key=lambda other: float(_gaps(rig)[index, other]))


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
    """What an encoded camera's place takes of the others."""
    rig = scene.rig
    others = np.flatnonzero(rig.encoded != camera)
    row = interpolation(rig, others.tolist(), [int(np.searchsorted(rig.encoded, camera))])[0]
    return ViewWeights(scene.rows(rig.encoded[others[row != 0]]), row[row != 0])


def _drawn_by_others(
    plan: EncodePlan, left_out: Sequence[int], work: Path | None, progress: Progress | None
) -> list[float]:
    """dB of luma for each camera left out, drawn from the others: of many cameras from those around it."""
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
            left = residual(known, model, MEAN_WANTED)
            fit_textures(known, model, scales, left, BETWEEN_ITERATIONS, mean_only=True)
        block = principal_block(
            known, model, scales, len(others) - 1, (0, grid[0], 0, grid[1]), scattered=False, work=work
        )
        weights = np.concatenate([block.weights, interpolation(rig, others, left_out) @ block.weights])
        model = replace(model, blocks=[replace(block, weights=weights.astype(np.float32))])
        found = residual(data, model, NOTHING_WANTED)
    at = range(len(others), len(order))
    return [psnr_of(found.squares[i : i + 1], found.pixels[i : i + 1]) if found.pixels[i] else np.inf for i in at]


def others_around(rig: Rig, left_out: Sequence[int]) -> set[int]:
    """The encoded cameras that take part beside those left out: of few all, of many those around each.

    With all around it, a camera left out lies in the same triangle of others as with the whole array.

    Args:
        rig: The rig.
        left_out: Of `spread_inside`.
    """
    if len(rig.encoded) <= BETWEEN_FEW_CAMERAS:
        taken = set(range(len(rig.encoded)))
    else:
        near = _neighbours(rig)
        taken = set().union(*(near[index] for index in left_out)) | {rig.encoded_reference}
    return taken - set(left_out)


def interpolation(rig: Rig, others: Sequence[int], left_out: Sequence[int]) -> NDArray[np.float64]:
    """(left out, others): what each camera left out takes of the others, all counted among the encoded ones.

    Args:
        rig: The rig.
        others: Cameras.
        left_out: Other cameras.
    """
    places = rig.view_plane.coordinates([camera.centre for camera in rig.encoded_cameras])
    known, matrix = places[list(others)], np.zeros((len(left_out), len(others)))
    triangles = delaunay_triangles(known)
    for row, index in zip(matrix, left_out, strict=True):
        among, weights = delaunay_weights(np.clip(places[index], -1, 1), known, triangles)
        row[among] = weights
    return matrix


def _first(data: FitData, count: int) -> FitData:
    """The first so many observations."""
    given = data.observations
    part = replace(
        given, cameras=given.cameras[:count], shapes=given.shapes[:count], offsets=given.offsets[: count + 1]
    )
    return replace(data, observations=part)
