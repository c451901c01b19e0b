"""Entries of a calibration with their photographs: each is found, and its size compared with its camera's."""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from eigenfield.capture.calibration import Calibration, Entry, or_error, split_scale
from eigenfield.capture.duplicates import describe_duplicates, find_duplicates
from eigenfield.capture.far import move_to_origin
from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.locate import PhotographFinder, photographs_in, with_masks
from eigenfield.capture.messages import describe, natural_key, unique_names
from eigenfield.capture.photographs.read import read_header
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError, one_line
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger(__name__)

LIGHT_FIELD_MIN_VIEWS = 3  # photographs that make a light field
# by which the principal point of a photograph may be next to its corner: (0, 0), and fractions of one photograph
CORNER_MAX_PIXELS, CORNER_MAX_FRACTION = 1.5, 0.02
PINHOLE_MAX_ANGLE_DEGREES = 170.0  # of view, without a fisheye lens


def pair_photographs(
    read: Calibration,
    root: Path,
    *,
    apart: bool,
    masks: Path | None,
    strict: bool,
    fewest: int = LIGHT_FIELD_MIN_VIEWS,
) -> LightField:
    """The light field of a calibration with the photographs below `root`.

    Args:
        apart: The calibration was named apart from the photographs (`PhotographFinder`).
        masks: A folder of masks; None for none.
        fewest: Photographs that are needed.

    Raises:
        CaptureError: As `open_capture` does.
    """
    read, origin = move_to_origin(read)
    base = read.path if read.path.is_dir() else read.path.parent
    finder = PhotographFinder(root, base, apart)
    log.info("%s: %d calibration entries", read.path, len(read.entries))
    errors = list(read.errors)
    pairs, lost, twice = _match_entries(read, finder)
    errors += twice
    views, bad, problems = _make_views(pairs, finder, read.path)
    errors += bad
    views, missing = with_masks(views, masks, root, strict)
    # a camera of a model that is not read costs its own views alone, as long as others make a light field
    grave = [error for error in errors if error.code != "camera-model" or len(views) < fewest]
    if strict and grave:
        raise grave[0]
    copies = find_duplicates([view.path for view in views])
    problems = [
        *read.problems,
        *describe(lost, "calibration entry has", "calibration entries have", f"no photograph ({read.path.name})"),
        *describe(_unused(pairs, views), "photograph has", "photographs have", "no calibration entry"),
        *describe_duplicates(copies),
        *problems,
        *missing,
        *map(str, errors),
    ]
    if strict and len(views) < fewest:
        raise CaptureError(
            "too-few",
            f"{len(views)} photographs with a camera, of {len(read.entries)} calibration entries; {fewest} are needed",
            path=root,
            remedy="check that the photographs lie where the calibration says, or name it with --calibration",
        )
    return LightField(root, _with_unique_names(views), tuple(problems), read.format, origin=origin)


def _match_entries(
    read: Calibration, finder: PhotographFinder
) -> tuple[list[tuple[Entry, Path]], list[str], list[CaptureError]]:
    """Entries with their photographs, names of those without, and errors for those that share one."""
    pairs: list[tuple[Entry, Path]] = []
    lost: list[str] = []
    errors: list[CaptureError] = []
    owner: dict[Path, Entry] = {}
    for entry in read.entries:
        path = finder.find(entry.file)
        if path is None:
            lost.append(entry.file)
        elif path in owner:
            errors.append(
                CaptureError(
                    "frame-twice",
                    f"{entry.label} and {owner[path].label} are the same photograph ({path.name})",
                    path=read.path,
                    remedy="remove one of them",
                )
            )
        else:
            owner[path] = entry
            pairs.append((entry, path))
    return pairs, lost, errors


def _make_views(
    pairs: Sequence[tuple[Entry, Path]], finder: PhotographFinder, calibration: Path
) -> tuple[list[View], list[CaptureError], list[str]]:
    def make(pair: tuple[Entry, Path]) -> _Made:
        return _make_view(*pair, finder, calibration)

    outcomes = parallel_map(or_error(make), pairs)
    errors = [outcome for outcome in outcomes if isinstance(outcome, CaptureError)]
    made = [outcome for outcome in outcomes if not isinstance(outcome, CaptureError)]
    problems = []
    if rescaled := [one.view for one in made if one.scaled]:
        camera, name = rescaled[0].camera, one_line(rescaled[0].path.name)
        problems.append(
            f"{len(rescaled)} cameras are for another size of the same picture and were scaled to the photographs "
            f"(to {camera.width}x{camera.height} for {name})"
        )
    if disagreeing := [(one.view, *one.focals) for one in made if one.focals is not None]:
        view, stated, by_angle = disagreeing[0]
        problems.append(
            f"{len(disagreeing)} cameras have a focal length and an angle of view that contradict each other "
            f"({stated:.4g} and {by_angle:.4g} pixels for {one_line(view.path.name)}): the focal length is taken"
        )
    problems += _describe_rotations(made)
    if outside := [one for one in made if _is_outside(one.view.camera)]:
        camera, unsized = outside[0].view.camera, not outside[0].sized
        problems.append(
            f"{len(outside)} cameras have their principal point outside of the photograph or in its corner "
            f"(({camera.K[0, 2]:.4g}, {camera.K[1, 2]:.4g}) of {camera.width}x{camera.height} for "
            f"{one_line(outside[0].view.path.name)}): "
            + ("the calibration gives no width and height (w, h), so " if unsized else "")
            + "its numbers may be of a larger photograph, or fractions; right only for photographs that were cut out"
        )
    return [one.view for one in made], errors, problems


def _is_outside(camera: Camera) -> bool:
    sides = np.array([camera.width, camera.height])
    near = np.maximum(CORNER_MAX_FRACTION * sides, CORNER_MAX_PIXELS)
    inside = np.minimum(camera.K[:2, 2], sides - camera.K[:2, 2])  # from the nearest side
    return bool((inside < 0).any() or (inside <= near).all())


def _describe_rotations(made: Sequence[_Made]) -> list[str]:
    """Lines about rotations that `Entry.camera` corrected."""
    problems = []
    if scaled := [one for one in made if one.pose_scale != 1]:
        problems.append(
            f"{len(scaled)} cameras have a pose with a scale ({scaled[0].pose_scale:.4g} for "
            f"{one_line(scaled[0].view.path.name)}), which is divided out"
        )
    if rounded := [one.view for one in made if one.pose_rounded and one.pose_scale == 1]:
        problems.append(
            f"{len(rounded)} cameras have rotations of few digits (that of {one_line(rounded[0].path.name)} is not "
            "orthonormal): the nearest rotations are taken"
        )
    return problems


class _Made(NamedTuple):
    """A view, and what people may want to know of it.

    Attributes:
        scaled: Its camera was scaled to the photograph's size.
        focals: As `Intrinsics.contradiction`.
        sized: The calibration states the size of the photograph.
        pose_scale: Taken out of the pose, by `split_scale`.
        pose_rounded: The rotation is not the matrix of the calibration.
    """

    view: View
    scaled: bool
    focals: tuple[float, float] | None
    sized: bool
    pose_scale: float
    pose_rounded: bool


def _make_view(entry: Entry, path: Path, finder: PhotographFinder, calibration: Path) -> _Made:
    header = read_header(path)
    claimed = entry.intrinsics.width, entry.intrinsics.height
    ways = [(True, header.upright_size), (False, header.stored_size)]
    if entry.stored:
        ways.reverse()
    fitting = [way for way in ways if all(c is None or c == s for c, s in zip(claimed, way[1], strict=True))]
    scaled = not fitting
    if scaled and None not in claimed:
        fitting = [way for way in ways if is_same_picture(claimed[0] or 0, claimed[1] or 0, *way[1])]
    if not fitting:
        raise CaptureError(
            "image-size",
            f"is {_format_size(header.upright_size)}, but its camera is for {_format_size(claimed)}: "
            "not the same picture at another scale",
            path=path,
            remedy=f"use the photographs that {calibration.name} was made from, undistorted and cropped alike",
        )
    upright, (width, height) = fitting[0]
    size = claimed[0] or width, claimed[1] or height
    camera = entry.camera(*size, calibration)
    focals = None
    if entry.lens is None or not entry.lens.is_fisheye:  # whose angle is stated in several ways
        focals = entry.intrinsics.contradiction(*size)
        _refuse_too_wide(entry, camera, focals, calibration)
    if scaled:
        camera = scale_camera(camera, width, height)
    mask = find_own_mask(entry, finder, calibration)
    view = View(path.name, path, camera, entry.lens, mask, upright, entry.bounds)
    rotation, pose_scale = split_scale(entry.R)
    return _Made(view, scaled, focals, None not in claimed, pose_scale, rotation is not entry.R)


def _refuse_too_wide(entry: Entry, camera: Camera, focals: tuple[float, float] | None, calibration: Path) -> None:
    """Raise CaptureError `camera-focal` for a focal length that no photograph without a fisheye lens has."""
    focal = float(camera.K[0, 0])
    degrees = 2 * math.degrees(math.atan(camera.width / (2 * focal)))
    if degrees > PINHOLE_MAX_ANGLE_DEGREES:
        also = "" if focals is None else f", although the angle that it states means {focals[1]:.4g} pixels"
        raise CaptureError(
            "camera-focal",
            f"camera {entry.label} has a focal length of {focal:.4g} pixels for a width of {camera.width}, which is an "
            f"angle of view of {degrees:.1f} degrees{also}",
            path=calibration,
            remedy="give the focal length in pixels, not millimetres",
        )


def _format_size(size: tuple[int | None, int | None]) -> str:
    return "x".join("?" if side is None else str(side) for side in size)


def is_same_picture(width: int, height: int, other_width: int, other_height: int) -> bool:
    """Whether one size is the other scaled evenly and brought to whole pixels, by whatever rounding."""
    low = max((other_width - 1) / width, (other_height - 1) / height)
    high = min((other_width + 1) / width, (other_height + 1) / height)
    return low < high


def scale_camera(camera: Camera, width: int, height: int) -> Camera:
    """The camera of the same picture at another size: pixel edges map to pixel edges."""
    scale = np.diag([width / camera.width, height / camera.height, 1.0])
    return replace(camera, K=scale @ camera.K, width=width, height=height)


def find_own_mask(entry: Entry, finder: PhotographFinder, calibration: Path) -> Path | None:
    """The mask that the calibration names."""
    if entry.mask is None:
        return None
    mask = finder.find_exactly(entry.mask)
    if mask is None:
        raise CaptureError(
            "mask-missing",
            f"{entry.label}: its mask {one_line(entry.mask)} does not exist",
            path=calibration,
            remedy="put it there, or remove its mask_path",
        )
    return mask


def _unused(pairs: Sequence[tuple[Entry, Path]], views: Sequence[View]) -> list[str]:
    """Names of photographs that lie beside those in use, but that no entry names."""
    used = {path for _, path in pairs} | {view.mask for view in views}
    folders = sorted({path.parent for _, path in pairs})
    return [path.name for folder in folders for path in photographs_in(folder) if path not in used]


def _with_unique_names(views: Sequence[View]) -> tuple[View, ...]:
    """Views with unique names, in natural order: view_2 before view_10."""
    names = unique_names([view.path for view in views])
    named = [replace(view, name=name) for view, name in zip(views, names, strict=True)]
    return tuple(sorted(named, key=lambda view: natural_key(view.name)))
