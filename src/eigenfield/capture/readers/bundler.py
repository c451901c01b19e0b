"""Bundler's `bundle.out` (https://www.cs.cornell.edu/~snavely/bundler/bundler-v0.4-manual.html) with its list of files.

A comment line, the counts of cameras and points, then five lines a camera: f k1 k2, three rows of R, t. World-to-
camera, but with axes x right, y up, z backwards: p = -P / P.z, then p' = f (1 + k1 |p|^2 + k2 |p|^4) p, measured from
the middle of the photograph, y up. Turning both axes over gives OpenCV's and leaves k1, k2 as they are. A camera with
f = 0 was not registered. Points are passed over. The list has one photograph a line, its name first; programs call it
by many names, and Metashape by any.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics
from eigenfield.capture.messages import describe
from eigenfield.capture.photographs.kinds import ALL_EXTENSIONS
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.text import (
    camera_centre,
    check_finite,
    check_lens,
    damaged_error,
    excerpt,
    parse_numbers,
    read_head,
    read_text,
    unreadable_error,
)
from eigenfield.core.errors import CaptureError, one_line

BUNDLER_FOLDERS = ("", "bundle", "bundler")
BUNDLER_LISTS = ("list.txt", "list_imgs.txt", "list.orig.txt", "imagelist.txt", "name_list.txt", "list.lst")
BUNDLER_MAX_LIST_BYTES = 16 * 2**20  # of a text that may be a list under another name
BUNDLER_TO_OPENCV_AXES = np.diag([1.0, -1.0, -1.0])
BUNDLER_MAX_LINE_CHARACTERS = 4096  # lines of points are skipped and not read
BUNDLER_MAX_CAMERAS = 10_000_000


def find_bundler(folder: Path) -> Path | None:
    """A Bundler file with its list: `bundle.out` in the folder or `bundle/`, else any `*.out` that begins as one."""
    return next((path for path in _bundler_files(folder) if _find_list(path) is not None), None)


def find_unlisted(folder: Path) -> Path | None:
    """A Bundler file in a folder whose list of photographs is not there."""
    return next((path for path in _bundler_files(folder) if _find_list(path) is None), None)


def _bundler_files(folder: Path) -> Iterator[Path]:
    for inner in BUNDLER_FOLDERS:
        named = folder / inner / "bundle.out"
        others = sorted((folder / inner).glob("*.out")) if (folder / inner).is_dir() else []
        for path in dict.fromkeys((named, *others)):
            if path.is_file() and read_head(path, 64).lstrip().lower().startswith(b"# bundle file"):
                yield path


def _find_list(path: Path) -> Path | None:
    """The list of photographs: beside the file, in the folder above or in its `prepare/`, under a usual name; else any
    text beside it that names as many photographs as there are cameras, and nothing else."""
    stems = list(dict.fromkeys([path.stem, path.stem.removesuffix(".bundle")]))
    names = [f"{stem}{end}" for stem in stems for end in (".list.txt", "_list.txt", "-list.txt", ".lst")]
    names += [*BUNDLER_LISTS]
    folders = [path.parent, path.parent.parent, path.parent / "prepare", path.parent.parent / "prepare"]
    places = (folder / name for folder in folders for name in names)
    found = next((place for place in places if place.is_file()), None)
    if found is not None:
        return found
    others = (place for folder in folders if folder.is_dir() for place in sorted(folder.glob("*.txt")))
    return next((place for place in others if place.is_file() and _is_list(place, path)), None)


def _is_list(place: Path, path: Path) -> bool:
    """Whether a text has a photograph's name on each line, and as many lines as a Bundler file has cameras."""
    try:
        lines = [line for line in read_text(place, BUNDLER_MAX_LIST_BYTES).split("\n") if line.strip()]
        named = all(any(word.strip('"').lower().endswith(ALL_EXTENSIONS) for word in line.split()) for line in lines)
        return named and len(lines) == _read_count(_read_lines(path), path)
    except CaptureError:
        return False


def read_bundler(path: Path) -> Calibration:
    """Every registered camera as an entry; those that Bundler did not register are named in `problems`.

    Raises CaptureError (`calibration-missing`, `calibration-damaged`, `calibration-count`, `calibration-empty`,
    `bundler-list` (no list of photographs)) where the file as a whole cannot be used.
    """
    listed = _find_list(path)
    if listed is None:
        raise CaptureError(
            "bundler-list",
            "has no list of its photographs beside it",
            path=path,
            remedy="put its list.txt into the same folder",
        )
    names = [_parse_name(line.strip()) for line in read_text(listed).split("\n") if line.strip()]
    lines = _read_lines(path)
    cameras = _read_count(lines, path)
    if not 0 < cameras <= BUNDLER_MAX_CAMERAS:
        raise CaptureError(
            "calibration-empty", f"lists {cameras} cameras", path=path, remedy="name another calibration"
        )
    if cameras != len(names):
        raise CaptureError(
            "calibration-count",
            f"has {cameras} cameras, but {listed.name} has {len(names)} photographs",
            path=path,
            remedy="give it the list that it was made with",
        )
    entries, errors, lost = [], [], []
    for name in names:
        block = list(islice(lines, 5))
        if len(block) < 5:
            raise damaged_error(path, f"ends before camera {one_line(name)}")
        try:
            entry = _parse_entry(block, name, path)
        except CaptureError as error:
            errors.append(error)
            continue
        if entry is None:
            lost.append(name)
        else:
            entries.append(entry)
    problems = describe(lost, "camera was", "cameras were", "not registered by Bundler")
    return Calibration(path, "bundler", tuple(entries), tuple(errors), tuple(problems))


def _read_count(lines: Iterator[tuple[int, str]], path: Path) -> int:
    """The number of cameras, from the lines before the first of them."""
    first = next(lines, (1, ""))
    counts = next(lines, (2, "")) if first[1].startswith("#") else first
    words = counts[1].split()
    if len(words) != 2 or not all(w.isascii() and w.isdigit() and len(w) < 12 for w in words):
        raise damaged_error(path, f"line {counts[0]} is not the counts of cameras and points", "name a bundle.out")
    return int(words[0])


def _parse_name(line: str) -> str:
    """The name of a line `name [0 focal]`: names may hold spaces, and end in an extension."""
    words = line.replace('"', " ").split()  # some quote paths with spaces
    for end in range(len(words), 0, -1):
        if words[end - 1].lower().endswith(ALL_EXTENSIONS):
            return " ".join(words[:end]).replace("\\", "/").removeprefix("./")
    return words[0].replace("\\", "/").removeprefix("./")


def _read_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Lines that are not empty, none longer than LINE_LIMIT."""
    try:
        with path.open(encoding="utf-8-sig", errors="surrogateescape") as file:
            number = 0
            while line := file.readline(BUNDLER_MAX_LINE_CHARACTERS):
                number += 1
                if len(line) >= BUNDLER_MAX_LINE_CHARACTERS:
                    long = f"line {number} has {BUNDLER_MAX_LINE_CHARACTERS} characters or more"
                    raise damaged_error(path, long, "name a bundle.out")
                if stripped := line.strip():
                    yield number, stripped
    except OSError as error:
        raise unreadable_error(path, error) from error


def _parse_entry(lines: list[tuple[int, str]], name: str, path: Path) -> Entry | None:
    """The camera of five lines; None where it was not registered."""
    label = f"camera {one_line(name)}"
    rows = [parse_numbers(line.split(), 3, f"line {n} of {label} ({excerpt(line)})", path) for n, line in lines]
    (focal, k1, k2), R, t = rows[0], np.stack(rows[1:4]), rows[4]
    if focal == 0:
        return None
    check_finite([focal, R, t], label, path)
    check_lens([k1, k2], label, path)
    lens = Lens("brown", (float(k1), float(k2), 0.0, 0.0, 0.0))
    intrinsics = Intrinsics(None, None, (float(focal), float(focal)), None, (None, None))
    centre = camera_centre(R, t, label, path)
    axes, distortion = BUNDLER_TO_OPENCV_AXES @ R, None if lens.is_identity else lens
    return Entry(name, label, intrinsics, axes, centre, distortion, stored=True)
