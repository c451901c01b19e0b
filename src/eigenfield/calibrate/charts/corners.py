"""The corners of a board in one grey picture.

Checkerboards: OpenCV's quadrangle detector, its sector-based one where that fails, then `cornerSubPix` with a window
of a third of the smallest spacing. On thirteen stereo pairs that left 0.18 px rms against 0.25 px of the sector-based
detector alone and 0.4 px of the customary window of 11, which reaches the next corners of small squares.
ChArUco: `cv2.aruco.CharucoDetector`, then `cornerSubPix` with a window that ends where the markers begin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate.charts.board import Board, dictionaries

LONGEST = 1600  # side in pixels on which a checkerboard is looked for; its corners are refined on the whole picture
SMALLEST = 48  # side in pixels; OpenCV's detectors stop with an assertion on less
FEWEST = 6  # corners that make a sighting
MARKERS = 4  # of one dictionary in a picture that are no chance
BENT = 0.25  # of the spacing: how far a corner may lie from the plane's image; lenses bend less than that
WINDOW = 0.3  # of the smallest spacing: half the side of the window of `cornerSubPix`
SMALLEST_WINDOW, LARGEST_WINDOW = 2, 15  # pixels


@dataclass(frozen=True)
class Look:
    """How a board is looked for: as printed, or with black and white exchanged; ChArUco's pattern old or new."""

    inverted: bool
    legacy: bool = False


@dataclass(frozen=True, eq=False)
class Corners:
    """The corners that one picture shows.

    ids: (k,) int64, rows of `Board.points`. pixels: (k, 2) float64, pixel centres at +0.5.
    mirrored: the board was seen from behind (boards on glass are read from both sides).
    """

    ids: NDArray[np.int64]
    pixels: NDArray[np.float64]
    mirrored: bool = False


def looks(board: Board) -> list[Look]:
    """The ways to look for a board, those that its description leaves open."""
    inverted = (False, True) if board.inverted is None else (board.inverted,)
    legacy = (False, True) if board.legacy is None and board.kind == "charuco" else (bool(board.legacy),)
    return [Look(i, old) for old in legacy for i in inverted]


def find_corners(grey: NDArray[np.uint8], board: Board, look: Look, *, patient: bool = True) -> Corners | None:
    """The board's corners in a picture (H, W); None where fewer than FEWEST are seen.

    patient: try the slow detector of checkerboards too, where the quick one finds nothing.
    """
    if min(grey.shape) < SMALLEST:
        return None
    picture = 255 - grey if look.inverted else grey
    if board.kind == "checkerboard":
        return _checkerboard(np.ascontiguousarray(picture), grey, board, patient)
    found = _charuco(picture, board, look.legacy)
    if found is None:
        behind = _charuco(np.ascontiguousarray(picture[:, ::-1]), board, look.legacy)
        if behind is not None:
            pixels = np.stack([grey.shape[1] - behind.pixels[:, 0], behind.pixels[:, 1]], axis=1)
            found = Corners(behind.ids, pixels, True)
    return found


def _checkerboard(picture: NDArray[np.uint8], grey: NDArray[np.uint8], board: Board, patient: bool) -> Corners | None:
    size = board.corners
    scale = min(1.0, LONGEST / max(picture.shape))
    small = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA) if scale < 1 else picture
    flags = cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE
    found, corners = cv2.findChessboardCorners(small, size, flags=flags | (0 if patient else cv2.CALIB_CB_FAST_CHECK))
    if not found and patient:
        found, corners = cv2.findChessboardCornersSB(
            small, size, flags=cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_ACCURACY
        )
    if not found:
        return None
    # pixel edges, not centres, keep their places when a picture is scaled
    coarse = (corners.reshape(-1, 2).astype(np.float64) + 0.5) / scale
    pixels = _sharpened(picture, coarse, WINDOW * _spacing(coarse, size))
    pixels = np.where(np.isnan(pixels), coarse, pixels)
    pixels = pixels[_orientation(pixels, grey, board)]
    ids = np.arange(len(pixels))
    return Corners(ids, pixels) if _is_flat(pixels, ids, board) else None


def _spacing(pixels: NDArray[np.float64], size: tuple[int, int]) -> float:
    """The smallest distance between neighbouring corners of a full grid."""
    grid = pixels.reshape(size[1], size[0], 2)
    along = np.linalg.norm(np.diff(grid, axis=1), axis=2)
    down = np.linalg.norm(np.diff(grid, axis=0), axis=2)
    return float(min(along.min(), down.min()))


def _sharpened(picture: NDArray[np.uint8], coarse: NDArray[np.float64], reach: float) -> NDArray[np.float64]:
    """Corners by `cornerSubPix` with a half window of `reach` pixels; NaN where one left its window, along an edge."""
    half = int(np.clip(round(reach), SMALLEST_WINDOW, LARGEST_WINDOW))
    corners = np.ascontiguousarray(coarse - 0.5, np.float32).reshape(-1, 1, 2)
    cv2.cornerSubPix(picture, corners, (half, half), (-1, -1), (3, 50, 1e-3))
    fine = corners[:, 0].astype(np.float64) + 0.5
    fine[np.linalg.norm(fine - coarse, axis=1) > half] = np.nan
    return fine


def _orientation(pixels: NDArray[np.float64], grey: NDArray[np.uint8], board: Board) -> NDArray[np.int64]:
    """The order of the corners in which columns turn clockwise into rows, as seen, and the first inner square is dark.

    Detectors leave both to chance. Where black and white cannot be exchanged by turning the board, the colour is that
    of the print and says nothing.
    """
    columns, rows = board.corners
    order = np.arange(columns * rows).reshape(rows, columns)
    along, down = pixels[columns - 1] - pixels[0], pixels[-columns] - pixels[0]
    if along[0] * down[1] - along[1] * down[0] < 0:
        order = order[:, ::-1]
    flat = order.ravel()
    turn = board.recolouring()
    if turn is not None and _first_is_light(pixels[flat].reshape(rows, columns, 2), grey):
        flat = flat[turn]
    return flat


def _first_is_light(grid: NDArray[np.float64], grey: NDArray[np.uint8]) -> bool:
    """Whether the squares of the first inner square's colour are the lighter ones; grid: (rows, columns, 2)."""
    middles = (grid[:-1, :-1] + grid[1:, :-1] + grid[:-1, 1:] + grid[1:, 1:]) / 4
    x, y = np.floor(middles).astype(int).reshape(-1, 2).T
    values = grey[np.clip(y, 0, grey.shape[0] - 1), np.clip(x, 0, grey.shape[1] - 1)].astype(float)
    parity = np.add.outer(np.arange(middles.shape[0]), np.arange(middles.shape[1])).ravel() % 2
    return bool(values[parity == 0].mean() > values[parity == 1].mean())


def _charuco(picture: NDArray[np.uint8], board: Board, legacy: bool) -> Corners | None:
    found, names, _, _ = _detector(board, legacy).detectBoard(picture)
    if names is None or len(names) < FEWEST:
        return None
    ids = np.asarray(names, np.int64).ravel()
    coarse = found.reshape(-1, 2).astype(np.float64) + 0.5
    spacing = _neighbour_distances(coarse, ids, board)
    if not len(spacing):
        return None
    # found anew: before OpenCV 5 they came half a pixel off. The window must not reach the markers.
    margin = (board.square - board.marker) / (2 * board.square)
    pixels = _sharpened(picture, coarse, margin * float(spacing.min()))
    good = np.isfinite(pixels).all(axis=1)
    return Corners(ids[good], pixels[good]) if _is_flat(pixels[good], ids[good], board) else None


def _neighbour_distances(pixels: NDArray[np.float64], ids: NDArray[np.int64], board: Board) -> NDArray[np.float64]:
    """Distances in the picture between corners that are neighbours on the board."""
    plane = board.points[ids, :2]
    apart = np.linalg.norm(plane[:, None] - plane[None], axis=2)
    a, b = np.nonzero(np.abs(apart - board.square) < 1e-6 * board.square)
    return np.asarray(np.linalg.norm(pixels[a] - pixels[b], axis=1))


def _detector(board: Board, legacy: bool) -> cv2.aruco.CharucoDetector:
    dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, board.dictionary))
    drawn = cv2.aruco.CharucoBoard((board.columns, board.rows), board.square, board.marker, dictionary)
    drawn.setLegacyPattern(legacy)
    return cv2.aruco.CharucoDetector(drawn)


def _is_flat(pixels: NDArray[np.float64], ids: NDArray[np.int64], board: Board) -> bool:
    """Whether the corners lie as a plane's do, up to a lens: a board of another size, or squares of something else,
    do not. Corners on one line tell nothing and are no sighting."""
    plane = board.points[ids, :2]
    spread = np.linalg.svd(plane - plane.mean(axis=0), compute_uv=False)
    if len(plane) < FEWEST or spread[1] < 0.5 * board.square:
        return False
    H, _ = cv2.findHomography(plane, pixels)
    if H is None:
        return False
    away = np.linalg.norm(cv2.perspectiveTransform(plane[:, None], H)[:, 0] - pixels, axis=1)
    spacing = _neighbour_distances(pixels, ids, board)
    return len(spacing) > 0 and bool(away.max() < BENT * np.median(spacing))


def seen_size(grey: NDArray[np.uint8], inverted: bool) -> tuple[int, int] | None:
    """Inner corners (the longer side first) of the largest checkerboard in a picture, whatever its size."""
    if min(grey.shape) < SMALLEST:
        return None
    picture = 255 - grey if inverted else grey
    scale = min(1.0, LONGEST / max(picture.shape))
    small = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA) if scale < 1 else picture
    flags = cv2.CALIB_CB_LARGER | cv2.CALIB_CB_NORMALIZE_IMAGE
    found, _, meta = cv2.findChessboardCornersSBWithMeta(np.ascontiguousarray(small), (3, 3), flags=flags)
    if not found or meta is None:
        return None
    rows, columns = meta.shape[:2]
    return max(rows, columns), min(rows, columns)


def seen_dictionary(
    pictures: Sequence[NDArray[np.uint8]], names: Sequence[str] | None = None
) -> tuple[str, int, bool] | None:
    """The dictionary of markers that the pictures show: at least four in one, and more than of any other.

    names: those to look for, one of each family if None; the first that half the pictures show is taken.
    Returns its name, the highest number among the markers, and whether they are inverted.
    """
    best: tuple[int, tuple[str, int, bool]] | None = None
    large = [picture for picture in pictures if min(picture.shape) >= SMALLEST]
    for name in _largest_dictionaries() if names is None else names:
        detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, name)))
        for inverted in (False, True):
            seen = [detector.detectMarkers(255 - picture if inverted else picture)[1] for picture in large]
            many = [ids for ids in seen if ids is not None and len(ids) >= MARKERS]
            count = sum(len(ids) for ids in many)
            if many and (best is None or count > best[0]):
                best = count, (name, max(int(ids.max()) for ids in many), inverted)
            if 2 * len(many) > len(large):
                return best[1] if best else None
    return best[1] if best else None


def _largest_dictionaries() -> list[str]:
    """One of each family: DICT_4X4_50 is the beginning of DICT_4X4_1000."""
    return [n for n in dictionaries() if n.endswith("_1000") or not n.rsplit("_", 1)[-1].isdecimal()]
