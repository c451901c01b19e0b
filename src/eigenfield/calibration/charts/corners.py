"""Detection of a board's corners in one grey picture.

Checkerboards: OpenCV's quadrangle detector, then its sector-based one if that fails, then `cornerSubPix` with a window
of a third of the smallest spacing. On thirteen stereo pairs this left 0.18 px rms, against 0.25 px of the sector-based
detector alone. The customary window of 11 left 0.4 px, because it reaches the next corners of small squares. ChArUco:
`cv2.aruco.CharucoDetector`, then `cornerSubPix` with a window that ends where the markers begin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.charts.board import Board, dictionaries

CORNERS_MAX_SEARCH_PIXELS = 1600  # longer side for the detection; corners are refined at full resolution
CORNERS_MIN_PICTURE_PIXELS = 48  # shorter side; OpenCV's detectors fail an assertion on less
CORNERS_MIN_COUNT = 6  # corners of a detection
CORNERS_MIN_MARKERS = 4  # of one dictionary in a picture: fewer are chance
CORNERS_MAX_BEND_SPACINGS = 0.25  # distance of a corner from the plane's homography; distortion is smaller
CORNERS_WINDOW_SPACINGS = 0.3  # half the side of the window of `cornerSubPix`, in smallest spacings
CORNERS_MIN_WINDOW_PIXELS, CORNERS_MAX_WINDOW_PIXELS = 2, 15


@dataclass(frozen=True)
class BoardVariant:
    """One way in which a board may have been printed.

    Attributes:
        inverted: Black and white are swapped.
        legacy: ChArUco's pattern from before OpenCV 4.6.
    """

    inverted: bool
    legacy: bool = False


@dataclass(frozen=True, eq=False)
class DetectedCorners:
    """The corners of a board that one picture shows.

    Attributes:
        ids: (k,) int64 rows of `Board.points`.
        pixels: (k, 2) float64, pixel centres at +0.5.
        mirrored: The board was seen from behind (boards on glass can be read from both sides).
    """

    ids: NDArray[np.int64]
    pixels: NDArray[np.float64]
    mirrored: bool = False


def board_variants(board: Board) -> list[BoardVariant]:
    """The variants of a board that its description leaves open."""
    inverted = (False, True) if board.inverted is None else (board.inverted,)
    legacy = (False, True) if board.legacy is None and board.kind == "charuco" else (bool(board.legacy),)
    return [BoardVariant(i, old) for old in legacy for i in inverted]


def find_corners(
    grey: NDArray[np.uint8], board: Board, variant: BoardVariant, *, patient: bool = True
) -> DetectedCorners | None:
    """The board's corners in a picture; None if fewer than CORNERS_MIN_COUNT are visible.

    Args:
        grey: (H, W) picture.
        patient: Try the slow detector of checkerboards too, if the quick one finds nothing.
    """
    if min(grey.shape) < CORNERS_MIN_PICTURE_PIXELS:
        return None
    picture = 255 - grey if variant.inverted else grey
    if board.kind == "checkerboard":
        return _find_checkerboard(np.ascontiguousarray(picture), grey, board, patient)
    found = _find_charuco(picture, board, variant.legacy)
    if found is None:
        behind = _find_charuco(np.ascontiguousarray(picture[:, ::-1]), board, variant.legacy)
        if behind is not None:
            pixels = np.stack([grey.shape[1] - behind.pixels[:, 0], behind.pixels[:, 1]], axis=1)
            found = DetectedCorners(behind.ids, pixels, True)
    return found


def _find_checkerboard(
    picture: NDArray[np.uint8], grey: NDArray[np.uint8], board: Board, patient: bool
) -> DetectedCorners | None:
    size = board.corners
    small, scale = _reduce(picture)
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
    pixels = _refine_corners(picture, coarse, CORNERS_WINDOW_SPACINGS * _spacing(coarse, size))
    pixels = np.where(np.isnan(pixels), coarse, pixels)
    pixels = pixels[_oriented_order(pixels, grey, board)]
    ids = np.arange(len(pixels))
    return DetectedCorners(ids, pixels) if _is_flat(pixels, ids, board) else None


def _reduce(picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], float]:
    """The picture at the resolution of the detection, and its scale."""
    scale = min(1.0, CORNERS_MAX_SEARCH_PIXELS / max(picture.shape))
    if scale == 1:
        return picture, scale
    return np.asarray(cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.uint8), scale


def _spacing(pixels: NDArray[np.float64], size: tuple[int, int]) -> float:
    """The smallest distance between neighbouring corners of a full grid."""
    grid = pixels.reshape(size[1], size[0], 2)
    along = np.linalg.norm(np.diff(grid, axis=1), axis=2)
    down = np.linalg.norm(np.diff(grid, axis=0), axis=2)
    return float(min(along.min(), down.min()))


def _refine_corners(picture: NDArray[np.uint8], coarse: NDArray[np.float64], half_window: float) -> NDArray[np.float64]:
    """Corners by `cornerSubPix` with a window of 2 half_window; NaN where a corner left it, along an edge."""
    half = int(np.clip(round(half_window), CORNERS_MIN_WINDOW_PIXELS, CORNERS_MAX_WINDOW_PIXELS))
    corners = np.ascontiguousarray(coarse - 0.5, np.float32).reshape(-1, 1, 2)
    cv2.cornerSubPix(picture, corners, (half, half), (-1, -1), (3, 50, 1e-3))
    fine = corners[:, 0].astype(np.float64) + 0.5
    fine[np.linalg.norm(fine - coarse, axis=1) > half] = np.nan
    return fine


def _oriented_order(pixels: NDArray[np.float64], grey: NDArray[np.uint8], board: Board) -> NDArray[np.int64]:
    """The order in which columns turn clockwise into rows, as seen, and the first inner square is dark.

    Detectors leave both to chance. The colour is only tested where a rotation of the board swaps black and white.
    Elsewhere it is a property of the print.
    """
    columns, rows = board.corners
    order = np.arange(columns * rows).reshape(rows, columns)
    along, down = pixels[columns - 1] - pixels[0], pixels[-columns] - pixels[0]
    if along[0] * down[1] - along[1] * down[0] < 0:
        order = order[:, ::-1]
    flat = order.ravel()
    rotation = board.colour_swapping_rotation()
    if rotation is not None and _first_is_light(pixels[flat].reshape(rows, columns, 2), grey):
        flat = flat[rotation]
    return flat


def _first_is_light(grid: NDArray[np.float64], grey: NDArray[np.uint8]) -> bool:
    """Whether squares of the first inner square's colour are the lighter ones; grid: (rows, columns, 2)."""
    middles = (grid[:-1, :-1] + grid[1:, :-1] + grid[:-1, 1:] + grid[1:, 1:]) / 4
    x, y = np.floor(middles).astype(int).reshape(-1, 2).T
    values = grey[np.clip(y, 0, grey.shape[0] - 1), np.clip(x, 0, grey.shape[1] - 1)].astype(float)
    parity = np.add.outer(np.arange(middles.shape[0]), np.arange(middles.shape[1])).ravel() % 2
    return bool(values[parity == 0].mean() > values[parity == 1].mean())


def _find_charuco(picture: NDArray[np.uint8], board: Board, legacy: bool) -> DetectedCorners | None:
    found, names, _, _ = _detector(board, legacy).detectBoard(picture)
    if names is None or len(names) < CORNERS_MIN_COUNT:
        return None
    ids = np.asarray(names, np.int64).ravel()
    coarse = found.reshape(-1, 2).astype(np.float64) + 0.5
    spacing = _neighbour_distances(coarse, ids, board)
    if not len(spacing):
        return None
    # refined: before OpenCV 5 the corners are half a pixel off. The window must not reach the markers.
    margin = (board.square - board.marker) / (2 * board.square)
    pixels = _refine_corners(picture, coarse, margin * float(spacing.min()))
    good = np.isfinite(pixels).all(axis=1)
    return DetectedCorners(ids[good], pixels[good]) if _is_flat(pixels[good], ids[good], board) else None


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
    """Whether the corners fit a plane's homography, up to lens distortion.

    A board of another size or squares of something else do not. Corners on one line are no detection.
    """
    plane = board.points[ids, :2]
    spread = np.linalg.svd(plane - plane.mean(axis=0), compute_uv=False)
    if len(plane) < CORNERS_MIN_COUNT or spread[1] < 0.5 * board.square:
        return False
    H, _ = cv2.findHomography(plane, pixels)
    if H is None:
        return False
    away = np.linalg.norm(cv2.perspectiveTransform(plane[:, None], H)[:, 0] - pixels, axis=1)
    spacing = _neighbour_distances(pixels, ids, board)
    return len(spacing) > 0 and bool(away.max() < CORNERS_MAX_BEND_SPACINGS * np.median(spacing))


def detect_checkerboard_size(grey: NDArray[np.uint8], inverted: bool) -> tuple[int, int] | None:
    """Inner corners (the longer side first) of the largest checkerboard of any size; None if there is none.

    Args:
        grey: (H, W) picture.
        inverted: Look for black and white swapped.
    """
    if min(grey.shape) < CORNERS_MIN_PICTURE_PIXELS:
        return None
    picture = 255 - grey if inverted else grey
    small, _ = _reduce(picture)
    flags = cv2.CALIB_CB_LARGER | cv2.CALIB_CB_NORMALIZE_IMAGE
    found, _, meta = cv2.findChessboardCornersSBWithMeta(np.ascontiguousarray(small), (3, 3), flags=flags)
    if not found or meta is None:
        return None
    rows, columns = meta.shape[:2]
    return max(rows, columns), min(rows, columns)


def detect_dictionary(
    pictures: Sequence[NDArray[np.uint8]], names: Sequence[str] | None = None
) -> tuple[str, int, bool] | None:
    """The marker dictionary that the pictures show: at least four markers in one, and more than of any other.

    Args:
        pictures: (H, W) grey pictures.
        names: Dictionaries to try; the first that half the pictures show is taken. Default: one of each family.

    Returns:
        Its name, the highest marker number, and whether the markers are inverted; None if there are no markers.
    """
    best: tuple[int, tuple[str, int, bool]] | None = None
    large = [picture for picture in pictures if min(picture.shape) >= CORNERS_MIN_PICTURE_PIXELS]
    for name in _largest_dictionaries() if names is None else names:
        detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, name)))
        for inverted in (False, True):
            seen = [detector.detectMarkers(255 - picture if inverted else picture)[1] for picture in large]
            many = [ids for ids in seen if ids is not None and len(ids) >= CORNERS_MIN_MARKERS]
            count = sum(len(ids) for ids in many)
            if many and (best is None or count > best[0]):
                best = count, (name, max(int(ids.max()) for ids in many), inverted)
            if 2 * len(many) > len(large):
                return best[1] if best else None
    return best[1] if best else None


def _largest_dictionaries() -> list[str]:
    """One of each family: DICT_4X4_50 is the beginning of DICT_4X4_1000."""
    return [n for n in dictionaries() if n.endswith("_1000") or not n.rsplit("_", 1)[-1].isdecimal()]
