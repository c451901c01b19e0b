"""An arrangement with its photographs looked into: sizes, focal lengths, copies, and what cannot be read."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from eigenfield.capture.arrangement import Arrangement
from eigenfield.capture.calibration import or_error
from eigenfield.capture.duplicates import describe_duplicates, find_duplicates, refuse_duplicates
from eigenfield.capture.locate import with_masks
from eigenfield.capture.messages import count_phrase, describe, natural_key, unique_names
from eigenfield.capture.photographs.exif import read_focal_length
from eigenfield.capture.photographs.panorama import refuse_panorama
from eigenfield.capture.photographs.read import read_header
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.capture.unread import describe_unread
from eigenfield.core.errors import CaptureError
from eigenfield.runtime.parallel import parallel_map

PHOTO_SET_MIN_PHOTOGRAPHS = 3  # photographs that a scene can be made from
FOCAL_MAX_SPREAD_RATIO = 0.01  # of focal lengths to their median, up to which they count as the same

log = logging.getLogger(__name__)


def make_photo_set(arrangement: Arrangement, root: Path, *, masks: Path | None, strict: bool) -> PhotoSet:
    """The set of photographs of an arrangement; headers are read, nothing is decoded.

    Args:
        masks: A folder of masks; None for none.

    Raises:
        CaptureError: As `open_photographs` does.
    """
    files = arrangement.files
    names = unique_names(files)

    def make(index: int) -> Shot:
        return _make_shot(files[index], names[index], free=arrangement.layout is None)

    order = sorted(range(len(files)), key=lambda i: natural_key(names[i]))
    outcomes = parallel_map(or_error(make), order)
    found = [(i, outcome) for i, outcome in zip(order, outcomes, strict=True) if isinstance(outcome, Shot)]
    errors = [outcome for outcome in outcomes if isinstance(outcome, CaptureError)]
    if arrangement.layout is not None:
        found, odd = _split_by_size(found)
        errors += odd
    if strict and errors:
        raise errors[0]
    shots = _with_focal_lengths([shot for _, shot in found], arrangement)
    copies = find_duplicates([shot.path for shot in shots])
    if strict:
        refuse_duplicates(copies, len(shots), PHOTO_SET_MIN_PHOTOGRAPHS, root)
    others = [path.name for path in arrangement.others]
    problems = [
        *describe(others, "photograph is", "photographs are", "not named like the rest and left out"),
        *arrangement.problems,
        *describe_duplicates(copies),
        *map(str, errors),
    ]
    shots, missing = with_masks(shots, masks, root, strict)
    problems += missing
    if strict and len(shots) < PHOTO_SET_MIN_PHOTOGRAPHS:
        unread = describe_unread((root, *(file.parent for file in files)))
        raise CaptureError(
            "too-few",
            f"holds {count_phrase(shots, 'photograph', 'photographs')}; {PHOTO_SET_MIN_PHOTOGRAPHS} are needed",
            path=root,
            remedy="; ".join(unread)
            or "add photographs of the scene from other places, or name the folder that holds them all",
        )
    for problem in problems:
        log.info("%s", problem)
    layout = None
    if arrangement.layout is not None:
        layout = arrangement.layout.subset([i for i, _ in found])
        layout = replace(layout, focal=common_focal_length([shot.focal for shot in shots]))
    return PhotoSet(root, tuple(shots), layout, tuple(problems), arrangement.format)


def _make_shot(path: Path, name: str, *, free: bool) -> Shot:
    header = read_header(path)
    focal = read_focal_length(path, header)
    refuse_panorama(path, header, focal, by_shape=free)
    return Shot(name, path, *header.upright_size, focal)


def _split_by_size(found: Sequence[tuple[int, Shot]]) -> tuple[list[tuple[int, Shot]], list[CaptureError]]:
    """The photographs of a grid that have the most frequent size, and an error for each of the others."""
    sizes = Counter((shot.width, shot.height) for _, shot in found)
    if len(sizes) < 2:
        return list(found), []
    (width, height), _ = sizes.most_common(1)[0]
    errors = [
        CaptureError(
            "image-size",
            f"is {shot.width}x{shot.height}, but the rest of the grid is {width}x{height}",
            path=shot.path,
            remedy="bring all photographs of a grid to one size, or say --format folder",
        )
        for _, shot in found
        if (shot.width, shot.height) != (width, height)
    ]
    return [(i, shot) for i, shot in found if (shot.width, shot.height) == (width, height)], errors


def _with_focal_lengths(shots: Sequence[Shot], arrangement: Arrangement) -> list[Shot]:
    """Shots with the focal lengths that the names state, if they do: those have precedence over EXIF's."""
    if arrangement.calibration is None:
        return list(shots)
    entries = {entry.file: entry for entry in arrangement.calibration.entries}
    result = []
    for shot in shots:
        intrinsics = entries[shot.path.name].intrinsics
        assert intrinsics.focal is not None and intrinsics.width is not None
        result.append(replace(shot, focal=intrinsics.focal[0] * shot.width / intrinsics.width))
    return result


def common_focal_length(focals: Sequence[float | None]) -> float | None:
    """The focal length of all shots, where all have one and it is the same."""
    known = [focal for focal in focals if focal is not None]
    if not known or len(known) < len(focals):
        return None
    middle = float(np.median(known))
    return middle if max(known) - min(known) <= FOCAL_MAX_SPREAD_RATIO * middle else None
