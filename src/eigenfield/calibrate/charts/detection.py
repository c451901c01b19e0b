"""A board in all pictures of a rig: which way it was printed, where its corners are, and what to say if nowhere."""

from __future__ import annotations

import functools
import logging
import operator
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate.charts.board import Board
from eigenfield.calibrate.charts.bundle import Sighting
from eigenfield.calibrate.charts.corners import Corners, Look, find_corners, looks, seen_dictionary, seen_size
from eigenfield.calibrate.charts.pictures import ChartCamera, Charts, frames, grey_picture
from eigenfield.core.errors import CaptureError
from eigenfield.core.progress import Progress, track
from eigenfield.runtime.parallel import parallel_map, parallel_stream

log = logging.getLogger("eigenfield.calibrate")

SAMPLE = 8  # pictures of a camera that tell how the board was printed
HINTS = 12  # pictures in which a board of another size is looked for
MARKER_HINTS = 4  # pictures in which other markers are looked for
SURE = 0.7  # of a few pictures: where so many show one other board, it is the board
FEWEST_HINTS = 2  # pictures that must show the same other board


@dataclass(frozen=True, eq=False)
class Detection:
    """What was seen.

    sightings: by camera, then moment. looks: how each camera saw the board, None where it did not.
    problems: one line each, for people.
    """

    sightings: tuple[Sighting, ...]
    looks: tuple[Look | None, ...]
    problems: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Picture:
    """One picture to look at: decoded already (a video's frame), or on disk."""

    camera: int
    moment: int
    source: Path | NDArray[np.uint8]

    def grey(self) -> NDArray[np.uint8]:
        return grey_picture(self.source) if isinstance(self.source, Path) else self.source


def detect(charts: Charts, board: Board, progress: Progress | None = None) -> Detection:
    """The board's corners in every picture of every camera.

    Pictures that cannot be decoded are named in `problems` and left out. Raises CaptureError `board-unseen` where no
    picture shows the board, `board-size` where the pictures show a larger one; the remedy says which, if any is seen.
    """
    open_looks = _sampled_looks(charts, board, progress)
    problems: list[str] = []
    total = sum(len(camera.moments) for camera in charts.cameras)

    def look_at(picture: _Picture) -> tuple[_Picture, dict[Look, Corners], str | None]:
        try:
            grey = picture.grey()
        except CaptureError as error:
            return picture, {}, f"{error} (left out)"
        patient = isinstance(picture.source, Path)
        found = {look: find_corners(grey, board, look, patient=patient) for look in open_looks[picture.camera]}
        slim = replace(picture, source=Path()) if not patient else picture
        return slim, {look: corners for look, corners in found.items() if corners is not None}, None

    seen: list[dict[Look, dict[int, Corners]]] = [{} for _ in charts.cameras]
    pictures = parallel_stream(look_at, _pictures(charts.cameras, problems))
    for picture, found, problem in track(pictures, "looking for the board", total, progress):
        if problem is not None:
            problems.append(problem)
        for look, corners in found.items():
            seen[picture.camera].setdefault(look, {})[picture.moment] = corners
    chosen = [max(by_look, key=lambda look: _count(by_look[look]), default=None) for by_look in seen]
    sightings = tuple(
        Sighting(c, moment, corners)
        for c, look in enumerate(chosen)
        if look is not None
        for moment, corners in sorted(seen[c][look].items())
    )
    if not sightings:
        raise _unseen(charts, board)
    if board.kind == "checkerboard":
        _refuse_part_of_larger(charts, board, sightings)
    return Detection(sightings, tuple(chosen), tuple(problems))


def _count(found: dict[int, Corners]) -> int:
    return sum(len(corners.ids) for corners in found.values())


def _pictures(cameras: Sequence[ChartCamera], problems: list[str]) -> Iterator[_Picture]:
    """All pictures, cameras in order; a video that breaks off ends there, with a line in `problems`."""
    for c, camera in enumerate(cameras):
        if not camera.is_video:
            yield from (_Picture(c, m, path) for m, path in zip(camera.moments, camera.paths, strict=True))
            continue
        try:
            for moment, grey in frames(camera):
                yield _Picture(c, moment, grey)
        except CaptureError as error:
            problems.append(f"{error} (frames up to there were used)")


def _sampled_looks(charts: Charts, board: Board, progress: Progress | None) -> list[list[Look]]:
    """The looks worth trying on all pictures of each camera: the one under which most corners are in a few of them.

    The pattern, old or new, is the board's and the same for all cameras; black and white may be exchanged by camera.
    Raises CaptureError `board-size` where a board of another size is in them instead.
    """
    every = looks(board)
    samples = [camera.sample(SAMPLE) for camera in charts.cameras]
    counts: list[Counter[Look]] = [Counter() for _ in samples]

    def look_at(picture: _Picture) -> tuple[int, Counter[Look]]:
        count: Counter[Look] = Counter()
        try:
            grey = picture.grey()
        except CaptureError:
            return picture.camera, count
        for look in every:
            corners = find_corners(grey, board, look, patient=False)
            if corners is not None:
                count[look] = len(corners.ids)
                if board.kind == "checkerboard":  # all of it or nothing: no other look could find more
                    break
        return picture.camera, count

    total = sum(len(sample.moments) for sample in samples)
    results = parallel_stream(look_at, _pictures(samples, []))
    for camera, count in track(results, "black on white or white on black", total, progress):
        counts[camera] += count
    if not any(counts):
        _refuse_another(charts, board)
    old = Counter[bool]()
    for count in counts:
        for look, corners in count.items():
            old[look.legacy] += corners
    legacy = old[True] > old[False]
    fitting = [look for look in every if look.legacy == legacy] if old.total() else every
    return [
        [max(fitting, key=lambda look: count[look])] if any(count[look] for look in fitting) else fitting
        for count in counts
    ]


def _some_pictures(charts: Charts, among: set[tuple[int, int]] | None = None) -> list[NDArray[np.uint8]]:
    """A few decoded pictures of all cameras, evenly spread; `among`: of these (camera, moment) only."""
    each = max(1, HINTS // len(charts.cameras))
    found = []
    for picture in _pictures([camera.sample(4 * each if among else each) for camera in charts.cameras], []):
        if among is None or (picture.camera, picture.moment) in among:
            try:
                found.append(picture.grey())
            except CaptureError:
                continue
        if len(found) >= HINTS:
            break
    return found


def _usual_size(pictures: Sequence[NDArray[np.uint8]]) -> tuple[tuple[int, int], int] | None:
    """The size of checkerboard that most pictures show, and how many do."""
    votes: Counter[tuple[int, int]] = Counter()
    for inverted in (False, True):
        sizes = parallel_map(functools.partial(seen_size, inverted=inverted), pictures)
        votes.update(size for size in sizes if size is not None)
        if votes:
            break
    if not votes:
        return None
    size = max(votes, key=lambda s: (votes[s], s))
    return size, votes[size]


def _refuse_part_of_larger(charts: Charts, board: Board, sightings: Sequence[Sighting]) -> None:
    """A checkerboard that is larger than was said is found in part, each time another part: a wrong rig, silently."""
    total = sum(len(camera.moments) for camera in charts.cameras)
    usually_found = 2 * len(sightings) > total
    pictures = _some_pictures(charts, {(s.camera, s.moment) for s in sightings} if usually_found else None)
    usual = _usual_size(pictures)
    if usual is None or usual[1] < FEWEST_HINTS or 2 * usual[1] <= len(pictures):
        return
    if usual[0] != _longer_first(board) and all(map(operator.ge, usual[0], _longer_first(board))):
        raise _another_size(charts, board, *usual, len(pictures))


def _refuse_another(charts: Charts, board: Board) -> None:
    """Where a few pictures show nothing of the board: do they show one of another size, or printed otherwise?

    Said before every picture is searched in vain, which takes seconds each. In doubt the search goes on.
    """
    pictures = _some_pictures(charts)
    if board.kind == "checkerboard":
        usual = _usual_size(pictures)
        if usual is None or usual[1] < max(FEWEST_HINTS, SURE * len(pictures)) or usual[0] == _longer_first(board):
            return
        if seen_dictionary(_few(pictures)[:2]) is None:  # the checkerboard of a ChArUco board is no other size
            raise _another_size(charts, board, *usual, len(pictures))
        return
    pictures = _few(pictures)
    markers = seen_dictionary(pictures, [board.dictionary])
    if markers is None:
        return
    if board.inverted is not None and board.inverted != markers[2]:
        raise CaptureError(
            "board-unseen",
            f"the markers of the {board} are {'inverted' if markers[2] else 'not inverted'} in the pictures",
            path=charts.root,
            remedy=f"say {'--inverted' if markers[2] else '--not-inverted'}",
        )
    fitting = _fitting_size(pictures, board, markers[2])
    if fitting is not None and fitting[1] >= FEWEST_HINTS:
        raise _another_size(charts, board, *fitting, len(pictures))


def _longer_first(board: Board) -> tuple[int, int]:
    return max(board.corners), min(board.corners)


def _another_size(charts: Charts, board: Board, size: tuple[int, int], count: int, total: int) -> CaptureError:
    rule = "inner corners are counted, where four squares meet, not squares"
    if board.kind == "charuco":
        rule = "squares are counted, columns first"
    return CaptureError(
        "board-size",
        f"a {board} was named, but {count} of {total} pictures looked at show one of {size[0]}x{size[1]}",
        path=charts.root,
        remedy=f"say --board {size[0]}x{size[1]} ({rule})",
    )


def _unseen(charts: Charts, board: Board) -> CaptureError:
    """Nothing was found: what would have been found instead?"""
    total = sum(len(camera.moments) for camera in charts.cameras)
    pictures = _some_pictures(charts)
    hint = _checkerboard_hint(pictures) if board.kind == "checkerboard" else _charuco_hint(pictures, board)
    return CaptureError("board-unseen", f"no {board} in any of {total} pictures", path=charts.root, remedy=hint)


def _checkerboard_hint(pictures: Sequence[NDArray[np.uint8]]) -> str:
    markers = seen_dictionary(_few(pictures))
    if markers is not None:
        return f"there are markers of {markers[0]} in them: say --chart charuco, with --marker and --dictionary"
    usual = _usual_size(pictures)
    if usual is not None:
        (columns, rows), count = usual
        return (
            f"{count} of {len(pictures)} pictures looked at show a checkerboard of {columns}x{rows}: say --board "
            f"{columns}x{rows} (inner corners are counted, where four squares meet, not squares)"
        )
    return (
        "count inner corners, where four squares meet, not squares; show the whole board, sharp, with a margin around "
        "it in the board's own background colour"
    )


def _charuco_hint(pictures: Sequence[NDArray[np.uint8]], board: Board) -> str:
    pictures = _few(pictures)
    markers = seen_dictionary(pictures, [board.dictionary]) or seen_dictionary(pictures)
    if markers is None:
        if _usual_size(pictures) is not None:
            return "there is a checkerboard without markers in them: say --chart checkerboard"
        return "no markers of any dictionary were found: check that the board is sharp and large enough in the pictures"
    name, highest, inverted = markers
    if _family(name) != _family(board.dictionary):
        return f"there are markers of {name} in them, up to number {highest}: say --dictionary {name}"
    fitting = _fitting_size(pictures, board, inverted)
    if fitting is not None:
        (columns, rows), count = fitting
        return (
            f"{count} of {len(pictures)} pictures looked at fit {columns}x{rows} squares: say --board {columns}x{rows} "
            "(squares are counted, columns first)"
        )
    kind = ", inverted," if inverted else ""
    return (
        f"there are markers of {name}{kind} in them, up to number {highest}, but not where such a board has them: "
        "check --board (squares, columns first), --dictionary and --inverted"
    )


def _family(dictionary: str) -> str:
    """DICT_4X4_50 and DICT_4X4_1000 begin with the same markers."""
    name, _, count = dictionary.rpartition("_")
    return name if count.isdecimal() else dictionary


def _few(pictures: Sequence[NDArray[np.uint8]]) -> list[NDArray[np.uint8]]:
    """Evenly spread, so that they are of different cameras."""
    return list(pictures[:: -(-len(pictures) // MARKER_HINTS)]) if pictures else []


def _fitting_size(
    pictures: Sequence[NDArray[np.uint8]], board: Board, inverted: bool
) -> tuple[tuple[int, int], int] | None:
    """The size like that of a ChArUco board under which most corners are in the pictures, and how many have any."""
    best: tuple[int, tuple[int, int], int] | None = None
    for columns, rows in _neighbours(board):
        legacy = None if rows % 2 == 0 else False
        other = replace(board, columns=columns, rows=rows, inverted=inverted, legacy=legacy)
        counts = parallel_map(functools.partial(_corners_of, board=other), pictures)
        if any(counts) and (best is None or sum(counts) > best[0]):
            best = sum(counts), (columns, rows), sum(map(bool, counts))
    return None if best is None else best[1:]


def _neighbours(board: Board) -> list[tuple[int, int]]:
    """Sizes that people mistake a ChArUco board's for: columns and rows exchanged, inner corners, one too many."""
    columns, rows = board.columns, board.rows
    sizes = [(rows, columns)] + [(columns + i, rows + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    sizes += [(r, c) for c, r in sizes]
    return [size for size in dict.fromkeys(sizes) if min(size) >= 3 and size != (columns, rows)]


def _corners_of(grey: NDArray[np.uint8], board: Board) -> int:
    found = (find_corners(grey, board, look, patient=False) for look in looks(board))
    return max(0 if corners is None else len(corners.ids) for corners in found)
