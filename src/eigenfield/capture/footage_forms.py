"""The forms of footage: a video a camera, a folder a camera with a picture an instant, a folder an instant with a
picture a camera, and entries of a calibration that state a time."""

from __future__ import annotations

import math
import os
import re
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path, PurePosixPath

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import Calibration, Entry
from eigenfield.capture.film import RATE_DEFAULT, RATE_TOLERANCE, as_rate, open_film
from eigenfield.capture.locate import IMAGES_FOLDER, PhotographFinder, photographs_in
from eigenfield.capture.messages import Note, count_phrase, list_names, natural_key
from eigenfield.capture.pairing import find_own_mask
from eigenfield.capture.readers.video import videos_of
from eigenfield.capture.tracks import PictureTrack, Track, VideoTrack
from eigenfield.core.errors import CaptureError, OptionError, one_line
from eigenfield.core.open_options import RATE_MAX
from eigenfield.runtime.parallel import parallel_map

FORM_MIN_CAMERAS = 2
POSE_ROUNDING = 1e-6  # of the cameras' extent, and of entries of a rotation: poses that are nearer are one
CAMERA_WORDS = ("cam", "camera", "view", "cameras", "kamera", "c", "v")
INSTANT_WORDS = ("frame", "time", "instant", "frames", "t", "f")
OTHER_FOLDERS = re.compile(r"images(_\d+)?|(masks?|depths?|sparse|labels?|normals?)(_.*)?", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class Found:
    """The cameras of footage, before a calibration is looked for.

    Attributes:
        rate: Frames a second of the clock that the tracks' times count.
        calibration: Of footage whose frames are entries: an entry for each camera, with its name as the file.
        instants: The folders of instants, where they are such.
    """

    tracks: tuple[Track, ...]
    rate: Fraction
    problems: tuple[str, ...] = ()
    calibration: Calibration | None = None
    instants: tuple[Path, ...] = ()


def find_footage(root: Path, rate: float | None) -> Found | None:
    """The footage of a folder of videos, or of folders with pictures; None where it is neither.

    Args:
        rate: Frames a second of pictures; None for the default, and for what videos state.

    Raises OptionError `rate-unknown`: no video has so many frames.
    """
    videos = videos_of(root)
    if len(videos) >= FORM_MIN_CAMERAS:
        return _of_videos(videos, rate)
    inner = _picture_folders(root)
    return _of_folders(inner, rate) if len(inner) >= FORM_MIN_CAMERAS else None


# videos


def _of_videos(videos: Sequence[Path], rate: float | None) -> Found:
    films = parallel_map(open_film, videos)
    times = Counter(path.stem for path in videos)
    names = [one_line(path.stem if times[path.stem] == 1 else path.name) for path in videos]
    rates = [film.rate for film in films]
    if rate is not None and rate / max(rates) - 1 > RATE_TOLERANCE:
        raise OptionError(
            "rate-unknown",
            f"--rate {rate:g} is more than the {float(max(rates)):.4g} frames a second of the fastest video",
            remedy="leave it out, or say no more than that",
        )
    slowest = [one for one in rates if one / min(rates) - 1 <= RATE_TOLERANCE]
    clock = Counter(slowest).most_common(1)[0][0] if rate is None else as_rate(rate)
    problems = []
    other = [name for name, one in zip(names, rates, strict=True) if abs(one / clock - 1) > RATE_TOLERANCE]
    if other and rate is None:
        problems.append(
            f"videos differ in rate: the slowest, {float(clock):.4g} frames a second, is the clip's, and the nearest "
            f"frames are taken of {list_names(other)}"
        )
    tracks = [VideoTrack(*known, known[1].seconds * float(clock)) for known in zip(names, films, strict=True)]
    return Found(tuple(tracks), clock, tuple(problems))


# folders of pictures


def _picture_folders(root: Path) -> list[Path]:
    """The folders directly in one, or in its `images/`, that hold pictures."""
    for place in (root, root / IMAGES_FOLDER):
        if not place.is_dir():
            continue
        with os.scandir(place) as entries:
            inner = [Path(e.path) for e in entries if e.is_dir() and not _is_other(e.name)]
        found = [one for one in sorted(inner, key=lambda path: natural_key(path.name)) if _pictures_of(one)]
        if len(found) >= FORM_MIN_CAMERAS:
            return found
    return []


def _pictures_of(folder: Path) -> list[Path]:
    return photographs_in(folder) or photographs_in(folder / IMAGES_FOLDER)


def _is_other(name: str) -> bool:
    return name.startswith((".", "@", "__MACOSX")) or OTHER_FOLDERS.fullmatch(name) is not None


def _of_folders(folders: Sequence[Path], rate: float | None) -> Found | None:
    pictures = {folder: _pictures_of(folder) for folder in folders}
    by_folder, lines = _folders_are_cameras(pictures)
    frames: dict[str, dict[int, Path]] = defaultdict(dict)
    for folder, files in pictures.items():
        for file in files:
            camera, instant = (folder.name, file.stem) if by_folder else (file.stem, folder.name)
            name, number = one_line(camera), _number(instant)
            if number is None:
                lines.append(f"{file} has no number, and is left out")
            elif (other := frames[name].setdefault(number, file)) != file:
                raise CaptureError(
                    "frame-twice",
                    f"{other.name} and {file.name} are both frame {number} of {name}",
                    path=folder,
                    remedy="take one of them out",
                )
    frames = {name: found for name, found in frames.items() if found}
    if len(frames) < FORM_MIN_CAMERAS:
        return None
    found = _of_numbers(frames, rate, lines)
    return found if by_folder else replace(found, instants=tuple(folders))


def _of_numbers(frames: dict[str, dict[int, Path]], rate: float | None, lines: list[str]) -> Found:
    numbers = sorted({number for found in frames.values() for number in found})
    step = math.gcd(*(number - numbers[0] for number in numbers)) or 1
    if step > 1:
        lines.append(Note(f"pictures are numbered by {step}: each is a frame"))
    if rate is None:
        lines.append(Note(f"pictures state no rate: {RATE_DEFAULT} frames a second are taken, --rate says another"))
    tracks = []
    for name in sorted(frames, key=natural_key):
        order = sorted(frames[name])
        times = np.array([(number - numbers[0]) // step for number in order], np.float64)
        tracks.append(PictureTrack(name, tuple(frames[name][number] for number in order), times))
    return Found(tuple(tracks), RATE_DEFAULT if rate is None else as_rate(rate), tuple(lines))


def _number(name: str) -> int | None:
    """The last number in a name."""
    found = re.findall(r"\d+", name)
    return int(found[-1]) if found else None


def _folders_are_cameras(pictures: dict[Path, list[Path]]) -> tuple[bool, list[str]]:
    """Whether folders are cameras and their pictures instants, or the other way round; and lines about that.

    Names say so: those without a number and those of `CAMERA_WORDS` are cameras, those of `INSTANT_WORDS` are instants.
    """
    outer = [folder.name for folder in pictures]
    inner = [file.stem for files in pictures.values() for file in files]
    folders, names = _is_camera(outer), _is_camera(inner)
    for_folders, for_pictures = (folders is True) + (names is False), (folders is False) + (names is True)
    if for_folders != for_pictures:
        return for_folders > for_pictures, []
    line = "names do not say what is a camera: folders are taken as cameras, and their pictures as instants"
    return True, [Note(line)]


def _is_camera(names: Sequence[str]) -> bool | None:
    """Whether names are of cameras (True) or of instants (False); None where they do not say so."""
    words = {re.sub(r"[^a-z]*\d.*$", "", name.casefold()).rsplit("_", 1)[-1] for name in names}
    if any(_number(name) is None for name in names) or words <= set(CAMERA_WORDS):
        return True
    return False if words <= set(INSTANT_WORDS) else None


# entries of a calibration


def is_timed(read: Calibration) -> bool:
    """Whether a calibration states several times, so that its entries are frames of footage."""
    return len({entry.time for entry in read.entries if entry.time is not None}) > 1


def one_camera_each(read: Calibration) -> tuple[Calibration, list[list[Entry]]]:
    """A calibration in which entries of one pose and lens are one camera, whose file is the camera's name; and the
    entries of each. Poses that differ by rounding alone are one."""
    groups: dict[tuple[object, ...], list[Entry]] = defaultdict(list)
    centres = np.array([entry.centre for entry in read.entries])
    extent = float(np.ptp(centres, axis=0).max()) or 1.0
    poses = np.hstack([np.array([entry.R.ravel() for entry in read.entries]), centres / extent])
    for entry, pose in zip(read.entries, np.apply_along_axis(_levels, 0, poses), strict=True):
        groups[pose.tobytes(), entry.intrinsics, str(entry.lens)].append(entry)
    known = list(groups.values())
    names = _names_of_groups(known)
    entries = [replace(group[0], file=name, label=name, mask=None) for group, name in zip(known, names, strict=True)]
    return replace(read, entries=tuple(entries)), known


def _levels(values: NDArray[np.float64]) -> NDArray[np.int64]:
    """(n,) the same number for values that lie near each other: no limit as of rounding runs between them."""
    order = np.argsort(values)
    levels = np.zeros(len(values), np.int64)
    levels[order[1:]] = np.cumsum(np.diff(values[order]) > POSE_ROUNDING)
    return levels


def _names_of_groups(groups: Sequence[Sequence[Entry]]) -> list[str]:
    """The folder of a camera's files, or else their stem, or what stands before their number: what is one for each
    camera and differs between them."""
    paths = [[PurePosixPath(entry.file) for entry in group] for group in groups]
    for part in (
        lambda path: path.parent.name,
        lambda path: path.stem,
        lambda path: re.sub(r"[^a-zA-Z0-9]*\d+$", "", path.stem),
    ):
        names = [{part(path) for path in own} for own in paths]
        if all(len(own) == 1 for own in names) and len(set.union(*names)) == len(names) and "" not in set.union(*names):
            return [one_line(own.pop()) for own in names]
    width = len(str(len(groups) - 1))
    return [f"camera_{number:0{width}d}" for number in range(len(groups))]


def of_entries(read: Calibration, root: Path, *, apart: bool, rate: float | None) -> Found:
    """The footage of a calibration that states a time for each of its entries.

    Args:
        apart: As of `pair_photographs`.
    """
    single, groups = one_camera_each(read)
    times = [sorted({entry.time for entry in group if entry.time is not None}) for group in groups]
    steps = np.concatenate([np.diff(own) for own in times])  # cameras may be a little apart
    if not len(steps):
        raise CaptureError(
            "footage-moving",
            "states a time for each photograph, but no camera stands still: each has a pose of its own",
            path=read.path,
            remedy="leave out --clip, or give the poses of cameras that stand still",
        )
    stated = rate if rate is not None else read.rate
    first = min(min(own) for own in times if own)
    clock = as_rate(1 / float(np.median(steps)) if stated is None or not 0 < stated <= RATE_MAX else stated)
    finder = PhotographFinder(root, read.path if read.path.is_dir() else read.path.parent, apart)
    tracks, lost = [], []
    for entry, group in zip(single.entries, groups, strict=True):
        placed = [(one, finder.find(one.file)) for one in sorted(group, key=lambda one: one.time or 0.0)]
        lost += [one.file for one, path in placed if path is None]
        found = [(one, path) for one, path in placed if path is not None]
        if found:
            at = np.round((np.array([one.time or 0.0 for one, _ in found]) - first) * float(clock), 3)
            masks = tuple(find_own_mask(one, finder, read.path) for one, _ in found)
            files = tuple(path for _, path in found)
            tracks.append(PictureTrack(entry.file, files, at, masks if any(masks) else ()))
    problems = [f"{count_phrase(lost, 'entry has', 'entries have')} no picture: {list_names(lost)}"] if lost else []
    return Found(tuple(tracks), clock, tuple(problems), single)
