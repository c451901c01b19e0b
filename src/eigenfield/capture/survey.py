"""A capture in figures: sizes, files, the array, the cone of its viewing directions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.lightfield import LightField
from eigenfield.capture.photographs.kinds import VIDEO_EXTENSIONS
from eigenfield.capture.photographs.read import read_header
from eigenfield.capture.photoset import Capture
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError
from eigenfield.core.observations import Photograph
from eigenfield.core.progress import Progress, track
from eigenfield.core.viewplane import Grid, ViewPlane, find_grid, fit_view_plane
from eigenfield.runtime.parallel import parallel_stream

T = TypeVar("T")
ONE_PLACE_ROUNDING = 1e-9  # of the cameras' distance from the origin
FOCUS_MIN_EIGENVALUE = 1e-7  # rays whose normal matrix has a smaller eigenvalue than this meet nowhere


@dataclass(frozen=True, eq=False)
class CameraArray:
    """The geometry of the cameras' array.

    Attributes:
        plane: The view plane; width and height of the array are twice its extent, in world units.
        thickness: Greatest distance of a camera from the plane, world units.
        spacing: Median distance from a camera to its nearest neighbour, world units.
        grid: The regular grid, if there is one.
        focus: (3,) the point nearest to all rays through the pictures' middles, or None where they are parallel.
        distance: Mean distance of the cameras from the focus, world units.
        cone: Greatest angle between two cameras seen from the focus, degrees.
    """

    plane: ViewPlane
    thickness: float
    spacing: float
    grid: Grid | None
    focus: NDArray[np.float64] | None
    distance: float | None
    cone: float | None


def in_one_place(light_field: LightField) -> bool:
    """Whether all cameras stand in one place, up to rounding: they show no depth."""
    centres = np.array([camera.centre for camera in light_field.cameras])
    away = max(np.abs(centres).max(), np.abs(light_field.origin).max())
    return bool(np.ptp(centres, axis=0).max() <= ONE_PLACE_ROUNDING * away)


def refuse_one_place(capture: Capture) -> None:
    """Raise CaptureError `one-place` where known cameras stand in one place: no surface can be estimated from there."""
    if capture.light_field is not None and in_one_place(capture.light_field):
        raise CaptureError(
            "one-place",
            "all cameras stand in one place, and photographs from there show no depth",
            path=capture.root,
            remedy="take photographs from several places, or give a mesh with --proxy",
        )


def measure_array(cameras: Sequence[Camera]) -> CameraArray:
    """The arrangement of at least two cameras."""
    from scipy.spatial import KDTree

    centres = np.array([camera.centre for camera in cameras])
    plane = fit_view_plane(cameras)
    normal = np.cross(plane.right, plane.up)
    nearest = np.asarray(KDTree(centres).query(centres, k=2)[0])[:, 1]
    coordinates = plane.coordinates(centres)
    grid = find_grid(coordinates) if plane.extent[0] > 0 else None
    focus = find_focus(cameras)
    distance = cone = None
    if focus is not None:
        rays = centres - focus
        lengths = np.linalg.norm(rays, axis=1)
        distance = float(lengths.mean())
        unit = rays / np.maximum(lengths, 1e-300)[:, None]
        cone = float(np.degrees(np.arccos(np.clip(min((unit @ u).min() for u in unit), -1, 1))))
    thickness = float(np.abs((centres - plane.origin) @ normal).max())
    return CameraArray(plane, thickness, float(np.median(nearest)), grid, focus, distance, cone)


def find_focus(cameras: Sequence[Camera]) -> NDArray[np.float64] | None:
    """The point p with the least sum of squared distances to the rays through the pictures' middles:
    sum (I - d d^T) p = sum (I - d d^T) c. None where the rays are parallel, or meet behind the cameras."""
    normal, right = np.zeros((3, 3)), np.zeros(3)
    directions = []
    for camera in cameras:
        ray = camera.R.T @ np.linalg.solve(camera.K, [camera.width / 2, camera.height / 2, 1.0])
        ray = ray / np.linalg.norm(ray)
        across = np.eye(3) - np.outer(ray, ray)
        normal += across
        right += across @ camera.centre
        directions.append(ray)
    if np.linalg.eigvalsh(normal)[0] < FOCUS_MIN_EIGENVALUE * len(cameras):
        return None
    focus = np.asarray(np.linalg.solve(normal, right), dtype=np.float64)
    ahead = [(focus - camera.centre) @ ray for camera, ray in zip(cameras, directions, strict=True)]
    return focus if np.median(ahead) > 0 else None


def file_kinds(capture: Capture) -> list[tuple[str, int, bool, int]]:
    """(format, bits a channel, alpha, number of photographs), the most frequent first; without those whose header is
    damaged."""
    kinds: Counter[tuple[str, int, bool]] = Counter()
    for source in capture.sources:
        if source.path.name.lower().endswith(VIDEO_EXTENSIONS):
            kinds["video", 8, False] += 1  # as they are decoded
            continue
        with suppress(CaptureError):
            header = read_header(source.path)
            kinds[header.format, header.depth, header.alpha] += 1
    return [(*kind, count) for kind, count in sorted(kinds.items(), key=lambda item: (-item[1], item[0]))]


def decode_all(
    capture: Capture, look: Callable[[Photograph], T], progress: Progress | None = None
) -> tuple[list[CaptureError], dict[int, T]]:
    """Decode every photograph and mask once.

    Returns:
        What cannot be decoded or is hidden altogether, in the capture's order; what is kept of the others, by index.
    """

    def attempt(index: int) -> CaptureError | T:
        try:
            photograph = capture.photograph(index)
        except CaptureError as error:
            return error
        if photograph.mask is None or photograph.mask.any():
            return look(photograph)
        source = capture.sources[index]
        return CaptureError(
            "mask-black",
            "the mask hides the whole photograph",
            path=source.mask or source.path,
            remedy="white counts, black is left out: invert it, or take the photograph out",
        )

    total = len(capture)
    outcomes = list(track(parallel_stream(attempt, range(total)), "decoding photographs", total, progress))
    damaged = [outcome for outcome in outcomes if isinstance(outcome, CaptureError)]
    return damaged, {index: kept for index, kept in enumerate(outcomes) if not isinstance(kept, CaptureError)}


def corners_and_centre(cameras: Sequence[Camera]) -> list[int]:
    """The cameras nearest the array's top left, top right, centre, bottom left and bottom right; each once."""
    plane = fit_view_plane(cameras)
    places = plane.coordinates([camera.centre for camera in cameras])
    wanted = [(-1, 1), (1, 1), (0, 0), (-1, -1), (1, -1)]
    return list(dict.fromkeys(int(((places - place) ** 2).sum(axis=1).argmin()) for place in wanted))
