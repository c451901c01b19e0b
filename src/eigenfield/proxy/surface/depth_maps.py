"""A depth map for each photograph: a first one by itself, then one that must agree with the first of its neighbours."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.progress import Progress, track
from eigenfield.proxy.surface.fusion import DepthView
from eigenfield.proxy.surface.neighbours import project_inside
from eigenfield.runtime.files import read_arrays
from eigenfield.runtime.parts import Parts
from eigenfield.runtime.shared import Shared, share
from eigenfield.stereo import ReferenceView, view_matrices
from eigenfield.stereo.patches import OtherMaps, match_patches, upsample_planes
from eigenfield.stereo.smooth import smooth_depth
from eigenfield.stereo.views import Pictures, halve_pictures, mark_outside, unpack_pictures

DEPTH_RANGE_END_LABELS = 0.25  # depths this near the ends of the range are invalid
DEPTH_AGREEMENT_PIXELS = 1.0  # of parallax, up to which two maps agree; at twice as much they differ altogether
DEPTH_MAX_PROJECTED_COST = 0.5  # a point of a neighbour's map with more is not tried
DEPTH_QUANTILES = (0.15, 0.5, 0.85)  # of the labels that the neighbours' maps put on a pixel: these are tried
DEPTH_SMOOTHING_SCALE_LABELS = 0.3  # off a plane, at which the weight of a point falls to a quarter
DEPTH_MAP_FILE = "depth.npz"
# Measured: 1.5 GB for nine views of 600,000 pixels with 16 threads, 1.0 with two; and 3 MB for each picture kept
DEPTH_MAP_MEMORY_BYTES = 1.7e9


@dataclass(frozen=True, eq=False)
class WorkingPicture:
    """A photograph at the working resolution.

    Attributes:
        camera: Of that resolution.
        pixels: (H, W, 3) uint8.
        mask: (H, W) bool, the foreground, or None.
        known: (H, W) bool, where the removal of the lens leaves a picture, or None.
    """

    camera: Camera
    pixels: NDArray[np.uint8]
    mask: NDArray[np.bool_] | None
    known: NDArray[np.bool_] | None


@dataclass(frozen=True)
class DepthJob:
    """A depth map that is to be made.

    Attributes:
        index: Of the view.
        others: Indices of those that it is compared with.
        span: Its range of inverse depths.
    """

    index: int
    others: tuple[int, ...]
    span: tuple[float, float]


@dataclass(frozen=True, eq=False)
class _FirstMap:
    """The first map of a view, at half resolution.

    Attributes:
        planes: (h, w, 3) of `match_patches`.
        cost: (h, w).
        inverse_depth: (h, w); 0 where there is none.
        tolerance: Relative depth of a pixel of parallax.
    """

    planes: NDArray[np.float32]
    cost: NDArray[np.float32]
    inverse_depth: NDArray[np.float32]
    tolerance: float


@dataclass(frozen=True, eq=False)
class _Stack:
    """The photographs of a job as `match_patches` takes them.

    Attributes:
        reference: The view.
        high: The highest label.
        pictures: (V, H, W, 3) or packed, its own first.
        matrices: (V, 3, 4).
    """

    reference: ReferenceView
    high: float
    pictures: Pictures
    matrices: NDArray[np.float64]


def make_depth_maps(
    jobs: Sequence[DepthJob],
    pictures: Sequence[WorkingPicture],
    parts: Parts | None,
    stage: str,
    progress: Progress | None,
) -> tuple[list[DepthView], list[float]]:
    """The depth map of each job, and the relative depth of a pixel of parallax in each.

    Args:
        jobs: At most one a view.
        parts: Workers that make the maps; None: this process does.
    """
    numbers = {job.index: number for number, job in enumerate(jobs)}
    if parts is None:
        first_maps = (_first_map(job, pictures) for job in jobs)
        first = dict(zip(numbers, track(first_maps, f"first {stage}", len(jobs), progress), strict=True))
        finished = track((_second_map(job, pictures, first) for job in jobs), stage, len(jobs), progress)
        return _views(jobs, pictures, finished), [first[job.index].tolerance for job in jobs]
    with share(pictures, parts.folder) as shared:
        calls = [(job, shared) for job in jobs]
        parted = parts.make("first-depth", build_first_map, calls, DEPTH_MAP_MEMORY_BYTES)
        folders = list(track(parted, f"first {stage}", len(jobs), progress))
        places = {index: folders[number] / DEPTH_MAP_FILE for index, number in numbers.items()}
        again = [(job, shared, places) for job in jobs]
        parted = parts.make("depth", build_depth_map, again, DEPTH_MAP_MEMORY_BYTES)
        made = track(parted, stage, len(jobs), progress)
        maps = (read_arrays(folder / DEPTH_MAP_FILE)["inverse_depth"] for folder in made)
        return _views(jobs, pictures, maps), [_load_first(places[job.index]).tolerance for job in jobs]


def _views(
    jobs: Sequence[DepthJob], pictures: Sequence[WorkingPicture], maps: Iterable[NDArray[np.float32]]
) -> list[DepthView]:
    used = (pictures[job.index] for job in jobs)
    return [DepthView(own.camera, w, own.mask) for own, w in zip(used, maps, strict=True)]


def build_first_map(folder: Path, job: DepthJob, pictures: Sequence[Shared[WorkingPicture]]) -> None:
    """Write one first map into a folder, on a worker. The pictures are those of all views."""
    made = _first_map(job, _load_pictures(job, pictures))
    np.savez(folder / DEPTH_MAP_FILE, **vars(made))


def build_depth_map(
    folder: Path, job: DepthJob, pictures: Sequence[Shared[WorkingPicture]], places: Mapping[int, Path]
) -> None:
    """Write one depth map into a folder, on a worker; the first maps lie at `places`, by the index of the view."""
    first = {index: _load_first(places[index]) for index in (job.index, *job.others) if index in places}
    np.savez(folder / DEPTH_MAP_FILE, inverse_depth=_second_map(job, _load_pictures(job, pictures), first))


def _load_pictures(job: DepthJob, pictures: Sequence[Shared[WorkingPicture]]) -> dict[int, WorkingPicture]:
    return {index: pictures[index].value() for index in (job.index, *job.others)}


def _load_first(place: Path) -> _FirstMap:
    data = read_arrays(place)
    return _FirstMap(data["planes"], data["cost"], data["inverse_depth"], float(data["tolerance"]))


def _stack_pictures(job: DepthJob, pictures: Mapping[int, WorkingPicture] | Sequence[WorkingPicture]) -> _Stack:
    reference_picture = pictures[job.index]
    used = [reference_picture, *(pictures[i] for i in job.others)]
    axis = reference_picture.camera.R[2]
    apart = [picture.camera.centre - reference_picture.camera.centre for picture in used[1:]]
    across = [np.linalg.norm(step - (step @ axis) * axis) for step in apart]
    unit = 1 / (reference_picture.camera.K[0, 0] * max(float(np.median(across)), 1e-12))
    reference = ReferenceView.with_margin(reference_picture.camera, 0, job.span[0], unit)
    height, width = max(p.pixels.shape[0] for p in used), max(p.pixels.shape[1] for p in used)
    stack = np.zeros((len(used), height, width, 3), np.uint8)
    places = [(slice(picture.pixels.shape[0]), slice(picture.pixels.shape[1])) for picture in used]
    for slot, place, picture in zip(stack, places, used, strict=True):
        slot[place] = picture.pixels
    matrices = view_matrices(reference, [picture.camera for picture in used])
    return _Stack(reference, (job.span[1] - job.span[0]) / unit, mark_outside(stack, places), matrices)


def _first_map(job: DepthJob, pictures: Mapping[int, WorkingPicture] | Sequence[WorkingPicture]) -> _FirstMap:
    stack = _stack_pictures(job, pictures)
    planes, cost = match_patches(stack.pictures, stack.matrices, stack.reference.shape, stack.high)
    w = _inverse_depth(planes[..., 0], stack, pictures[job.index], 2)
    tolerance = stack.reference.scale / float(np.median(w[w > 0])) if (w > 0).any() else 0.0
    return _FirstMap(planes, cost, w, tolerance)


def _inverse_depth(d: NDArray[np.float32], stack: _Stack, own: WorkingPicture, step: int) -> NDArray[np.float32]:
    """Inverse depth of labels on every `step`th pixel; 0 at the ends of the range and outside masks."""
    w = stack.reference.offset + stack.reference.scale * d
    w[(d <= DEPTH_RANGE_END_LABELS) | (d >= stack.high - DEPTH_RANGE_END_LABELS)] = 0
    for kept in (own.mask, own.known):
        if kept is not None:
            w[~kept[::step, ::step]] = 0
    return w.astype(np.float32)


def _second_map(
    job: DepthJob, pictures: Mapping[int, WorkingPicture] | Sequence[WorkingPicture], first: Mapping[int, _FirstMap]
) -> NDArray[np.float32]:
    """(H, W) inverse depths of the second map of a view, which begins with the first; 0 where there is none."""
    stack, picture, mine = _stack_pictures(job, pictures), pictures[job.index], first[job.index]
    reference = stack.reference.at_half_resolution()
    size = [(edge + 1) // 2 for edge in stack.pictures.shape[1:3]]
    depths = np.zeros((len(job.others), *size), np.float32)
    labels = np.full((len(job.others), *reference.shape), np.nan, np.float32)
    for number, index in enumerate(job.others):
        if index in first:
            other = first[index]
            height, width = other.inverse_depth.shape
            depths[number, :height, :width] = other.inverse_depth
            labels[number] = _projected_labels(reference, pictures[index].camera, other)
    tolerance = max(DEPTH_AGREEMENT_PIXELS * mine.tolerance, 1e-9)  # 0 where a mask hides all
    offset, scale = reference.offset, reference.scale
    others = OtherMaps(depths, offset, scale, 2 * tolerance, _quantiles(labels))
    planes, _ = match_patches(
        stack.pictures, stack.matrices, stack.reference.shape, stack.high, planes=mine.planes, others=others
    )
    cameras = [pictures[index].camera for index in job.others]
    agreeing = _count_agreeing(reference, planes[..., 0], cameras, depths, tolerance)
    share = agreeing / len(cameras)
    weight = (16.0 ** np.maximum(4 * share - 1, 0) - 1).astype(np.float32)  # half where half of the maps agree
    guide = unpack_pictures(halve_pictures(picture.pixels[None]))[0].astype(np.float32)
    planes[..., 0] = smooth_depth(
        planes[..., 0], weight, guide, half_confidence=15.0, depth_scale=DEPTH_SMOOTHING_SCALE_LABELS
    )
    return _inverse_depth(upsample_planes(planes, stack.reference.shape), stack, picture, 1)


def _projected_labels(reference: ReferenceView, camera: Camera, other: _FirstMap) -> NDArray[np.float32]:
    """(h, w) largest label of the points of another map on each pixel at half resolution; NaN where there is none."""
    row, column = np.nonzero((other.inverse_depth > 0) & (other.cost < DEPTH_MAX_PROJECTED_COST))
    view = ReferenceView(camera, 0, 0.0, 1.0).at_half_resolution()
    points = view.points(column.astype(float), row.astype(float), other.inverse_depth[row, column].astype(float))
    pixels, depth, inside = project_inside(reference.camera, points)
    column, row = pixels[inside].astype(np.int64).T
    d = (1 / depth[inside] - reference.offset) / reference.scale
    result = np.full(reference.shape, -np.inf, np.float32)
    np.maximum.at(result, (row, column), d.astype(np.float32))
    result[np.isneginf(result)] = np.nan
    return result


def _quantiles(labels: NDArray[np.float32]) -> NDArray[np.float32]:
    """(N, h, w) of DEPTH_QUANTILES along the first axis, without NaNs; NaN where there is nothing else."""
    ordered = np.sort(labels, axis=0)
    count = np.isfinite(labels).sum(axis=0)
    picks = [np.minimum((count * part).astype(np.int64), len(labels) - 1)[None] for part in DEPTH_QUANTILES]
    return np.concatenate([np.take_along_axis(ordered, pick, axis=0) for pick in picks])


def _count_agreeing(
    reference: ReferenceView,
    d: NDArray[np.float32],
    cameras: Sequence[Camera],
    depths: NDArray[np.float32],
    tolerance: float,
) -> NDArray[np.int64]:
    """(h, w) how many of the other maps show a point at its depth."""
    row, column = np.mgrid[: d.shape[0], : d.shape[1]].astype(float)
    points = reference.points(column, row, d.astype(float)).reshape(-1, 3)
    result = np.zeros(len(points), np.int64)
    for camera, depth in zip(cameras, depths, strict=True):
        small = ReferenceView(camera, 0, 0.0, 1.0).at_half_resolution().camera
        pixels, z, inside = project_inside(small, points)
        i, j = pixels[inside].astype(np.int64).T
        result[inside] += np.abs(depth[j, i] * z[inside] - 1) < tolerance
    return result.reshape(d.shape)
