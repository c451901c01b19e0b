"""Entries of a calibration with their photographs: each found, and its size held against its camera's."""

from __future__ import annotations

import logging
import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from eigenfield.capture.calibration import Calibration, Entry, printable
from eigenfield.capture.duplicates import same_files, told_copies
from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.locate import PhotographFinder, photographs_in, refuse_black, with_masks
from eigenfield.capture.messages import count, natural, some
from eigenfield.capture.photographs.read import Header, read_header
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger(__name__)

FEWEST = 3  # photographs that make a light field


def pair(read: Calibration, root: Path, *, apart: bool, masks: Path | None, strict: bool) -> LightField:
    """The light field of a calibration with the photographs below `root`.

    apart: the calibration was named apart from the photographs (`PhotographFinder`). masks, strict: as `open_capture`.
    Raises CaptureError as `open_capture` says.
    """
    base = read.path if read.path.is_dir() else read.path.parent
    finder = PhotographFinder(root, base, apart)
    log.info("%s: %d calibration entries", read.path, len(read.entries))
    errors = list(read.errors)
    pairs, lost, twice = _pair(read, finder)
    errors += twice
    views, bad, problems = _views(pairs, finder, read.path)
    errors += bad
    if masks is not None:
        views, missing = with_masks(views, masks, root)
        if strict:
            refuse_black([view.mask for view in views], masks)
        problems += missing
    if strict and errors:
        raise errors[0]
    copies = same_files([view.path for view in views])
    problems = [
        *read.problems, *_lost(lost, read.path), *_unused(pairs, views), *told_copies(copies), *problems,
        *map(str, errors),
    ]  # fmt: skip
    if strict and len(views) < FEWEST:
        raise CaptureError(
            "too-few",
            f"{len(views)} photographs with a camera, of {len(read.entries)} calibration entries; {FEWEST} are needed",
            path=root,
            remedy="check that the photographs lie where the calibration says, or name it with --calibration",
        )
    return LightField(root, _named(views), tuple(problems), read.format)


def _pair(
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


def _header_or_error(path: Path) -> Header | CaptureError:
    try:
        return read_header(path)
    except CaptureError as error:
        return error


def _views(
    pairs: Sequence[tuple[Entry, Path]], finder: PhotographFinder, calibration: Path
) -> tuple[list[View], list[CaptureError], list[str]]:
    headers = parallel_map(_header_or_error, [path for _, path in pairs])
    views, errors, rescaled = [], [], []
    for (entry, path), header in zip(pairs, headers, strict=True):
        if isinstance(header, CaptureError):
            errors.append(header)
            continue
        try:
            view, scaled = _view(entry, path, header, finder, calibration)
        except CaptureError as error:
            errors.append(error)
            continue
        views.append(view)
        if scaled:
            rescaled.append(path.name)
    problems = []
    if rescaled:
        camera = views[[view.path.name for view in views].index(rescaled[0])].camera
        problems.append(
            f"{len(rescaled)} cameras are for another size of the same picture and were scaled to the photographs "
            f"(to {camera.width}x{camera.height} for {printable(rescaled[0])})"
        )
    return views, errors, problems


def _view(entry: Entry, path: Path, header: Header, finder: PhotographFinder, calibration: Path) -> tuple[View, bool]:
    """The view, and whether its camera was scaled to the photograph's size."""
    claimed = entry.intrinsics.width, entry.intrinsics.height
    fitting = [
        (upright, size)
        for upright, size in ((True, header.upright), (False, header.stored))
        if all(c is None or c == s for c, s in zip(claimed, size, strict=True))
    ]
    scaled = not fitting
    if scaled and None not in claimed:
        fitting = [
            (upright, size)
            for upright, size in ((True, header.upright), (False, header.stored))
            if is_same_picture(claimed[0] or 0, claimed[1] or 0, *size)
        ]
    if not fitting:
        raise CaptureError(
            "image-size",
            f"is {_size(header.upright)}, but its camera is for {_size(claimed)}: "
            "not the same picture at another scale",
            path=path,
            remedy=f"use the photographs that {calibration.name} was made from, undistorted and cropped alike",
        )
    upright, (width, height) = fitting[0]
    camera = entry.camera(claimed[0] or width, claimed[1] or height, calibration)
    if scaled:
        camera = scaled_camera(camera, width, height)
    mask = _own_mask(entry, finder, calibration)
    return View(path.name, path, camera, entry.lens, mask, upright, entry.bounds), scaled


def _size(size: tuple[int | None, int | None]) -> str:
    return "x".join("?" if side is None else str(side) for side in size)


def is_same_picture(width: int, height: int, other_width: int, other_height: int) -> bool:
    """Whether one size is the other scaled evenly and brought to whole pixels, by whatever rounding."""
    low = max((other_width - 1) / width, (other_height - 1) / height)
    high = min((other_width + 1) / width, (other_height + 1) / height)
    return low < high


def scaled_camera(camera: Camera, width: int, height: int) -> Camera:
    """The camera of the same picture at another size: pixel edges map to pixel edges."""
    scale = np.diag([width / camera.width, height / camera.height, 1.0])
    return replace(camera, K=scale @ camera.K, width=width, height=height)


def _own_mask(entry: Entry, finder: PhotographFinder, calibration: Path) -> Path | None:
    """The mask that the calibration names."""
    if entry.mask is None:
        return None
    mask = finder.find_exactly(entry.mask)
    if mask is None:
        raise CaptureError(
            "mask-missing",
            f"{entry.label}: its mask {printable(entry.mask)} does not exist",
            path=calibration,
            remedy="put it there, or remove its mask_path",
        )
    return mask


def _lost(lost: Sequence[str], calibration: Path) -> list[str]:
    if not lost:
        return []
    number = count(lost, "calibration entry has", "calibration entries have")
    return [f"{number} no photograph ({calibration.name}): {some(lost)}"]


def _unused(pairs: Sequence[tuple[Entry, Path]], views: Sequence[View]) -> list[str]:
    """Photographs that lie beside those in use, but that no entry names."""
    used = {path for _, path in pairs} | {view.mask for view in views}
    folders = sorted({path.parent for _, path in pairs})
    unused = [path.name for folder in folders for path in photographs_in(folder) if path not in used]
    if not unused:
        return []
    return [f"{count(unused, 'photograph has', 'photographs have')} no calibration entry: {some(unused)}"]


def _named(views: Sequence[View]) -> tuple[View, ...]:
    """Views with unique names, in natural order: view_2 before view_10."""
    times = Counter(view.path.name for view in views)
    shared = [view.path for view in views if times[view.path.name] > 1]
    common = Path(os.path.commonpath([path.parent for path in shared])) if shared else Path()
    named = [
        replace(
            view,
            name=printable(view.path.name if times[view.path.name] == 1 else view.path.relative_to(common).as_posix()),
        )
        for view in views
    ]
    return tuple(sorted(named, key=lambda view: (natural(view.name), view.name)))
