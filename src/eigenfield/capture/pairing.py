"""Entries of a calibration with their photographs: each is found, and its size compared with its camera's."""

from __future__ import annotations

import logging
import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from eigenfield.capture.calibration import Calibration, Entry, escape_name, or_error
from eigenfield.capture.duplicates import describe_duplicates, find_duplicates
from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.locate import PhotographFinder, photographs_in, with_masks
from eigenfield.capture.messages import describe, natural_key
from eigenfield.capture.photographs.read import read_header
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger(__name__)

LIGHT_FIELD_MIN_VIEWS = 3  # photographs that make a light field


def pair_photographs(read: Calibration, root: Path, *, apart: bool, masks: Path | None, strict: bool) -> LightField:
    """The light field of a calibration with the photographs below `root`.

    Args:
        read: The calibration.
        root: Folder of the photographs.
        apart: The calibration was named apart from the photographs (`PhotographFinder`).
        masks: A folder of masks; None for none.
        strict: As for `open_capture`.

    Raises:
        CaptureError: As `open_capture` does.
    """
    base = read.path if read.path.is_dir() else read.path.parent
    finder = PhotographFinder(root, base, apart)
    log.info("%s: %d calibration entries", read.path, len(read.entries))
    errors = list(read.errors)
    pairs, lost, twice = _match_entries(read, finder)
    errors += twice
    views, bad, problems = _make_views(pairs, finder, read.path)
    errors += bad
    views, missing = with_masks(views, masks, root, strict)
    if strict and errors:
        raise errors[0]
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
    if strict and len(views) < LIGHT_FIELD_MIN_VIEWS:
        raise CaptureError(
            "too-few",
            f"{len(views)} photographs with a camera, of {len(read.entries)} calibration entries; "
            f"{LIGHT_FIELD_MIN_VIEWS} are needed",
            path=root,
            remedy="check that the photographs lie where the calibration says, or name it with --calibration",
        )
    return LightField(root, _with_unique_names(views), tuple(problems), read.format)


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
    def make(pair: tuple[Entry, Path]) -> tuple[View, bool]:
        return _make_view(*pair, finder, calibration)

    outcomes = parallel_map(or_error(make), pairs)
    errors = [outcome for outcome in outcomes if isinstance(outcome, CaptureError)]
    made = [outcome for outcome in outcomes if not isinstance(outcome, CaptureError)]
    views, rescaled = [view for view, _ in made], [view for view, scaled in made if scaled]
    if not rescaled:
        return views, errors, []
    camera, name = rescaled[0].camera, escape_name(rescaled[0].path.name)
    return views, errors, [
        f"{len(rescaled)} cameras are for another size of the same picture and were scaled to the photographs "
        f"(to {camera.width}x{camera.height} for {name})"
    ]  # fmt: skip


def _make_view(entry: Entry, path: Path, finder: PhotographFinder, calibration: Path) -> tuple[View, bool]:
    """The view, and whether its camera was scaled to the photograph's size."""
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
    camera = entry.camera(claimed[0] or width, claimed[1] or height, calibration)
    if scaled:
        camera = scale_camera(camera, width, height)
    mask = _find_own_mask(entry, finder, calibration)
    return View(path.name, path, camera, entry.lens, mask, upright, entry.bounds), scaled


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


def _find_own_mask(entry: Entry, finder: PhotographFinder, calibration: Path) -> Path | None:
    """The mask that the calibration names."""
    if entry.mask is None:
        return None
    mask = finder.find_exactly(entry.mask)
    if mask is None:
        raise CaptureError(
            "mask-missing",
            f"{entry.label}: its mask {escape_name(entry.mask)} does not exist",
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
    times = Counter(view.path.name for view in views)
    shared = [view.path for view in views if times[view.path.name] > 1]
    common = Path(os.path.commonpath([path.parent for path in shared])) if shared else Path()

    def unique_name(path: Path) -> str:
        return escape_name(path.name if times[path.name] == 1 else path.relative_to(common).as_posix())

    named = [replace(view, name=unique_name(view.path)) for view in views]
    return tuple(sorted(named, key=lambda view: natural_key(view.name)))
