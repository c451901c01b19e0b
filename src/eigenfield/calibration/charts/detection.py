"""Detection of a board in all pictures of a rig: its printed variant, its corners, and hints if it is nowhere."""

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

from eigenfield.calibration.charts.board import Board
from eigenfield.calibration.charts.bundle import BoardObservation
from eigenfield.calibration.charts.corners import (
    BoardVariant,
    DetectedCorners,
    board_variants,
    detect_checkerboard_size,
    detect_dictionary,
    find_corners,
)
from eigenfield.calibration.charts.pictures import ChartCamera, ChartPictures, decode_frames, read_grey_picture
from eigenfield.core.errors import CaptureError
from eigenfield.core.progress import Progress, track
from eigenfield.runtime.parallel import parallel_map, parallel_stream

log = logging.getLogger("eigenfield.calibration")

DETECTION_SAMPLE_PICTURES = 8  # of a camera, from which the printed variant is determined
DETECTION_HINT_PICTURES = 12  # in which a board of another size is searched
DETECTION_MARKER_HINT_PICTURES = 4  # in which other markers are searched
DETECTION_SURE_FRACTION = 0.7  # if so many of a few pictures show one other board, the described board is wrong
DETECTION_MIN_HINTS = 2  # pictures that must show the same other board
DETECTION_COUNTING_RULES = {
    "checkerboard": "inner corners are counted, where four squares meet, not squares",
    "charuco": "squares are counted, columns first",
}


@dataclass(frozen=True, eq=False)
class BoardDetections:
    """All detections of a board in a rig's pictures.

    Attributes:
        observations: By camera, then moment.
        variants: How each camera saw the board; None where it did not.
    """

    observations: tuple[BoardObservation, ...]
    variants: tuple[BoardVariant | None, ...]
    problems: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Picture:
    """One picture: already decoded (a video's frame), or on disk.

    Attributes:
        source: The (H, W) grey picture, or its path.
    """

    camera: int
    moment: int
    source: Path | NDArray[np.uint8]

    def grey(self) -> NDArray[np.uint8]:
        return read_grey_picture(self.source) if isinstance(self.source, Path) else self.source


def detect_boards(charts: ChartPictures, board: Board, progress: Progress | None = None) -> BoardDetections:
    """The board's corners in every picture of every camera.

    Pictures that cannot be decoded are listed in `problems` and left out.

    Raises:
        CaptureError: `board-unseen`: no picture shows the board. `board-size`: the pictures show a larger one. The
            remedy names the board that they show, if any.
    """
    open_variants = _sample_variants(charts, board, progress)
    problems: list[str] = []
    total = sum(len(camera.moments) for camera in charts.cameras)

    def detect_in(picture: _Picture) -> tuple[_Picture, dict[BoardVariant, DetectedCorners], str | None]:
        try:
            grey = picture.grey()
        except CaptureError as error:
            return picture, {}, f"{error} (left out)"
        patient = isinstance(picture.source, Path)
        found = {
            variant: find_corners(grey, board, variant, patient=patient) for variant in open_variants[picture.camera]
        }
        slim = replace(picture, source=Path()) if not patient else picture
        return slim, {variant: corners for variant, corners in found.items() if corners is not None}, None

    seen: list[dict[BoardVariant, dict[int, DetectedCorners]]] = [{} for _ in charts.cameras]
    pictures = parallel_stream(detect_in, _pictures(charts.cameras, problems))
    for picture, found, problem in track(pictures, "looking for the board", total, progress):
        if problem is not None:
            problems.append(problem)
        for variant, corners in found.items():
            seen[picture.camera].setdefault(variant, {})[picture.moment] = corners
    chosen = [max(by_look, key=lambda variant: _count_corners(by_look[variant]), default=None) for by_look in seen]
    observations = tuple(
        BoardObservation(c, moment, corners)
        for c, variant in enumerate(chosen)
        if variant is not None
        for moment, corners in sorted(seen[c][variant].items())
    )
    if not observations:
        raise _unseen_error(charts, board)
    if board.kind == "checkerboard":
        _refuse_part_of_larger(charts, board, observations)
    return BoardDetections(observations, tuple(chosen), tuple(problems))


def _count_corners(found: dict[int, DetectedCorners]) -> int:
    return sum(len(corners.ids) for corners in found.values())


def _pictures(cameras: Sequence[ChartCamera], problems: list[str]) -> Iterator[_Picture]:
    """All pictures, camera by camera; a video that breaks off ends there, with a line in `problems`."""
    for c, camera in enumerate(cameras):
        if not camera.is_video:
            yield from (_Picture(c, m, path) for m, path in zip(camera.moments, camera.paths, strict=True))
            continue
        try:
            for moment, grey in decode_frames(camera):
                yield _Picture(c, moment, grey)
        except CaptureError as error:
            problems.append(f"{error} (frames up to there were used)")


def _sample_variants(charts: ChartPictures, board: Board, progress: Progress | None) -> list[list[BoardVariant]]:
    """The variants to try on all pictures of each camera: the one with most corners in a few of them.

    The pattern, old or new, is the same for all cameras. Black and white may be swapped by camera.
    Raises CaptureError `board-size` if these pictures show a board of another size.
    """
    variants = board_variants(board)
    samples = [camera.sample(DETECTION_SAMPLE_PICTURES) for camera in charts.cameras]
    counts: list[Counter[BoardVariant]] = [Counter() for _ in samples]

    def detect_in(picture: _Picture) -> tuple[int, Counter[BoardVariant]]:
        count: Counter[BoardVariant] = Counter()
        try:
            grey = picture.grey()
        except CaptureError:
            return picture.camera, count
        for variant in variants:
            corners = find_corners(grey, board, variant, patient=False)
            if corners is not None:
                count[variant] = len(corners.ids)
                if board.kind == "checkerboard":  # found completely or not at all: no other variant finds more
                    break
        return picture.camera, count

    total = sum(len(sample.moments) for sample in samples)
    results = parallel_stream(detect_in, _pictures(samples, []))
    for camera, count in track(results, "black on white or white on black", total, progress):
        counts[camera] += count
    if not any(counts):
        _refuse_other_board(charts, board)
    seen = sum(counts, Counter[BoardVariant]())
    legacy = sum(corners if variant.legacy else -corners for variant, corners in seen.items()) > 0
    fitting = [variant for variant in variants if variant.legacy == legacy] if seen else variants
    return [
        [max(fitting, key=lambda variant: count[variant])] if any(count[variant] for variant in fitting) else fitting
        for count in counts
    ]


def _sample_pictures(charts: ChartPictures, among: set[tuple[int, int]] | None = None) -> list[NDArray[np.uint8]]:
    """A few decoded pictures of all cameras, evenly spread; `among`: only these (camera, moment)."""
    each = max(1, DETECTION_HINT_PICTURES // len(charts.cameras))
    found = []
    for picture in _pictures([camera.sample(4 * each if among else each) for camera in charts.cameras], []):
        if among is None or (picture.camera, picture.moment) in among:
            try:
                found.append(picture.grey())
            except CaptureError:
                continue
        if len(found) >= DETECTION_HINT_PICTURES:
            break
    return found


def _most_common_size(pictures: Sequence[NDArray[np.uint8]]) -> tuple[tuple[int, int], int] | None:
    """The size of checkerboard that most pictures show, and how many do."""
    for inverted in (False, True):
        sizes = parallel_map(functools.partial(detect_checkerboard_size, inverted=inverted), pictures)
        votes = Counter(size for size in sizes if size is not None)
        if votes:
            return max(votes.items(), key=lambda vote: (vote[1], vote[0]))
    return None


def _refuse_part_of_larger(charts: ChartPictures, board: Board, observations: Sequence[BoardObservation]) -> None:
    """Refuse a checkerboard that is part of a larger one: each detection would be another part of it."""
    total = sum(len(camera.moments) for camera in charts.cameras)
    usually_found = 2 * len(observations) > total
    pictures = _sample_pictures(charts, {(s.camera, s.moment) for s in observations} if usually_found else None)
    usual = _most_common_size(pictures)
    if usual is None or usual[1] < DETECTION_MIN_HINTS or 2 * usual[1] <= len(pictures):
        return
    if usual[0] != _longer_first(board) and all(map(operator.ge, usual[0], _longer_first(board))):
        raise _wrong_size_error(charts, board, *usual, len(pictures))


def _refuse_other_board(charts: ChartPictures, board: Board) -> None:
    """If a few pictures show nothing of the board, refuse when they show one of another size or print.

    This is checked before every picture is searched in vain, which takes seconds each. In doubt the search goes on.
    """
    pictures = _sample_pictures(charts)
    if board.kind == "checkerboard":
        usual = _most_common_size(pictures)
        enough = max(DETECTION_MIN_HINTS, DETECTION_SURE_FRACTION * len(pictures))
        if usual is None or usual[1] < enough or usual[0] == _longer_first(board):
            return
        if detect_dictionary(_subsample(pictures)[:2]) is None:  # a ChArUco board contains a checkerboard
            raise _wrong_size_error(charts, board, *usual, len(pictures))
        return
    pictures = _subsample(pictures)
    markers = detect_dictionary(pictures, [board.dictionary])
    if markers is None:
        return
    if board.inverted is not None and board.inverted != markers[2]:
        raise CaptureError(
            "board-unseen",
            f"the markers of the {board} are {'inverted' if markers[2] else 'not inverted'} in the pictures",
            path=charts.root,
            remedy=f"say {'--inverted' if markers[2] else '--not-inverted'}",
        )
    fitting = _find_fitting_size(pictures, board, markers[2])
    if fitting is not None and fitting[1] >= DETECTION_MIN_HINTS:
        raise _wrong_size_error(charts, board, *fitting, len(pictures))


def _longer_first(board: Board) -> tuple[int, int]:
    return max(board.corners), min(board.corners)


def _wrong_size_error(
    charts: ChartPictures, board: Board, size: tuple[int, int], count: int, total: int
) -> CaptureError:
    return CaptureError(
        "board-size",
        f"a {board} was named, but {count} of {total} pictures looked at show one of {size[0]}x{size[1]}",
        path=charts.root,
        remedy=f"say --board {size[0]}x{size[1]} ({DETECTION_COUNTING_RULES[board.kind]})",
    )


def _unseen_error(charts: ChartPictures, board: Board) -> CaptureError:
    """The error for no detection at all, with a hint of what the pictures show instead."""
    total = sum(len(camera.moments) for camera in charts.cameras)
    pictures = _sample_pictures(charts)
    hint = _checkerboard_hint(pictures) if board.kind == "checkerboard" else _charuco_hint(pictures, board)
    return CaptureError("board-unseen", f"no {board} in any of {total} pictures", path=charts.root, remedy=hint)


def _checkerboard_hint(pictures: Sequence[NDArray[np.uint8]]) -> str:
    markers = detect_dictionary(_subsample(pictures))
    if markers is not None:
        return f"there are markers of {markers[0]} in them: say --chart charuco, with --marker and --dictionary"
    usual = _most_common_size(pictures)
    if usual is not None:
        (columns, rows), count = usual
        return (
            f"{count} of {len(pictures)} pictures looked at show a checkerboard of {columns}x{rows}: say --board "
            f"{columns}x{rows} ({DETECTION_COUNTING_RULES['checkerboard']})"
        )
    return (
        "count inner corners, where four squares meet, not squares; show the whole board, sharp, with a margin around "
        "it in the board's own background colour"
    )


def _charuco_hint(pictures: Sequence[NDArray[np.uint8]], board: Board) -> str:
    pictures = _subsample(pictures)
    markers = detect_dictionary(pictures, [board.dictionary]) or detect_dictionary(pictures)
    if markers is None:
        if _most_common_size(pictures) is not None:
            return "there is a checkerboard without markers in them: say --chart checkerboard"
        return "no markers of any dictionary were found: check that the board is sharp and large enough in the pictures"
    name, highest, inverted = markers
    if _family(name) != _family(board.dictionary):
        return f"there are markers of {name} in them, up to number {highest}: say --dictionary {name}"
    fitting = _find_fitting_size(pictures, board, inverted)
    if fitting is not None:
        (columns, rows), count = fitting
        return (
            f"{count} of {len(pictures)} pictures looked at fit {columns}x{rows} squares: say --board {columns}x{rows} "
            f"({DETECTION_COUNTING_RULES['charuco']})"
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


def _subsample(pictures: Sequence[NDArray[np.uint8]]) -> list[NDArray[np.uint8]]:
    """A few, evenly spread, so that they come from different cameras."""
    return list(pictures[:: -(-len(pictures) // DETECTION_MARKER_HINT_PICTURES)]) if pictures else []


def _find_fitting_size(
    pictures: Sequence[NDArray[np.uint8]], board: Board, inverted: bool
) -> tuple[tuple[int, int], int] | None:
    """The similar size of ChArUco board with most corners in the pictures, and how many pictures have any."""
    best: tuple[int, tuple[int, int], int] | None = None
    for columns, rows in _neighbours(board):
        legacy = None if rows % 2 == 0 else False
        other = replace(board, columns=columns, rows=rows, inverted=inverted, legacy=legacy)
        counts = parallel_map(functools.partial(_max_corners, board=other), pictures)
        if any(counts) and (best is None or sum(counts) > best[0]):
            best = sum(counts), (columns, rows), sum(map(bool, counts))
    return None if best is None else best[1:]


def _neighbours(board: Board) -> list[tuple[int, int]]:
    """Sizes that people confuse with a ChArUco board's: columns and rows swapped, inner corners, off by one."""
    columns, rows = board.columns, board.rows
    sizes = [(rows, columns)] + [(columns + i, rows + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    sizes += [(r, c) for c, r in sizes]
    return [size for size in dict.fromkeys(sizes) if min(size) >= 3 and size != (columns, rows)]


def _max_corners(grey: NDArray[np.uint8], board: Board) -> int:
    found = (find_corners(grey, board, variant, patient=False) for variant in board_variants(board))
    return max(0 if corners is None else len(corners.ids) for corners in found)
