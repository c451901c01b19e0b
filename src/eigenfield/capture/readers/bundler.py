"""Bundler's `bundle.out` (https://www.cs.cornell.edu/~snavely/bundler/bundler-v0.4-manual.html) with its list of files.

A comment line, the counts of cameras and points, then five lines a camera: f k1 k2, three rows of R, t. World-to-
camera, but with axes x right, y up, z backwards: p = -P / P.z, then p' = f (1 + k1 |p|^2 + k2 |p|^4) p, measured from
the middle of the photograph, y up. Turning both axes over gives OpenCV's and leaves k1, k2 as they are. A camera with
f = 0 was not registered. Points are passed over. The list has one photograph a line, its name first.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, printable
from eigenfield.capture.messages import count, some
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photographs.read import EXTENSIONS
from eigenfield.capture.readers.text import check_finite, check_lens, damaged, numbers, shown, text, unreadable
from eigenfield.core.errors import CaptureError

FOLDERS = ("", "bundle", "bundler")
FLIP = np.diag([1.0, -1.0, -1.0])
LINE_LIMIT = 4096  # characters; lines of points are passed over and not read
COUNT_LIMIT = 10_000_000


def find_bundler(folder: Path) -> Path | None:
    """A Bundler file with its list: `bundle.out` in the folder or `bundle/`, else any `*.out` that begins as one."""
    for inner in FOLDERS:
        named = folder / inner / "bundle.out"
        others = sorted((folder / inner).glob("*.out")) if (folder / inner).is_dir() else []
        for path in (named, *others):
            if path.is_file() and _begins_as_bundle(path) and _list_of(path) is not None:
                return path
    return None


def _begins_as_bundle(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            return file.read(64).removeprefix(b"\xef\xbb\xbf").lstrip().lower().startswith(b"# bundle file")
    except OSError:
        return False


def _list_of(path: Path) -> Path | None:
    """The list of photographs: beside the file, or in the folder above."""
    stems = list(dict.fromkeys([path.stem, path.stem.removesuffix(".bundle")]))
    names = [f"{stem}{end}" for stem in stems for end in (".list.txt", "_list.txt", "-list.txt", ".lst")]
    names += ["list.txt", "list_imgs.txt", "list.orig.txt", "imagelist.txt", "list.lst"]
    for folder in (path.parent, path.parent.parent):
        for name in names:
            if (folder / name).is_file():
                return folder / name
    return None


def read_bundler(path: Path) -> Calibration:
    """Every registered camera as an entry; those that Bundler did not register are named in `problems`.

    Raises CaptureError (`calibration-missing`, `calibration-damaged`, `calibration-count`, `calibration-empty`,
    `bundler-list` (no list of photographs)) where the file as a whole cannot be used.
    """
    listed = _list_of(path)
    if listed is None:
        raise CaptureError(
            "bundler-list",
            "has no list of its photographs beside it",
            path=path,
            remedy="put its list.txt into the same folder",
        )
    names = [_name(line.strip()) for line in text(listed).split("\n") if line.strip()]
    lines = _lines(path)
    first = next(lines, (1, ""))
    counts = next(lines, (2, "")) if first[1].startswith("#") else first
    words = counts[1].split()
    if len(words) != 2 or not all(w.isascii() and w.isdigit() and len(w) < 12 for w in words):
        raise damaged(path, f"line {counts[0]} is not the counts of cameras and points", "name a bundle.out")
    cameras = int(words[0])
    if not 0 < cameras <= COUNT_LIMIT:
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
            raise damaged(path, f"ends before camera {printable(name)}")
        try:
            entry = _entry(block, name, path)
        except CaptureError as error:
            errors.append(error)
            continue
        if entry is None:
            lost.append(name)
        else:
            entries.append(entry)
    problems = [f"{count(lost, 'camera was', 'cameras were')} not registered by Bundler: {some(lost)}"] if lost else []
    return Calibration(path, "bundler", tuple(entries), tuple(errors), tuple(problems))


def _name(line: str) -> str:
    """The name of a line `name [0 focal]`: names may hold spaces, and end in an extension."""
    words = line.split()
    for end in range(len(words), 0, -1):
        if words[end - 1].lower().endswith(EXTENSIONS):
            return " ".join(words[:end]).replace("\\", "/").removeprefix("./")
    return words[0].replace("\\", "/").removeprefix("./")


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    """Lines that are not empty, none longer than LINE_LIMIT."""
    try:
        with path.open(encoding="utf-8-sig", errors="surrogateescape") as file:
            number = 0
            while line := file.readline(LINE_LIMIT):
                number += 1
                if len(line) >= LINE_LIMIT:
                    raise damaged(path, f"line {number} has {LINE_LIMIT} characters or more", "name a bundle.out")
                if stripped := line.strip():
                    yield number, stripped
    except OSError as error:
        raise unreadable(path, error) from error


def _entry(lines: list[tuple[int, str]], name: str, path: Path) -> Entry | None:
    """The camera of five lines; None where it was not registered."""
    label = f"camera {printable(name)}"
    rows = [numbers(line.split(), 3, f"line {number} of {label} ({shown(line)})", path) for number, line in lines]
    (focal, k1, k2), R, t = rows[0], np.stack(rows[1:4]), rows[4]
    if focal == 0:
        return None
    check_finite([focal, R, t], label, path)
    check_lens([k1, k2], label, path)
    lens = Lens("brown", (float(k1), float(k2), 0.0, 0.0, 0.0))
    intrinsics = Intrinsics(None, None, (float(focal), float(focal)), None, (None, None))
    with np.errstate(over="ignore", invalid="ignore"):
        centre = -R.T @ t
    check_finite([centre], label, path)
    return Entry(name, label, intrinsics, FLIP @ R, centre, None if lens.does_nothing else lens)
