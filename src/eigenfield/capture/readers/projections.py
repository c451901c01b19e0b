"""3 x 4 projection matrices: one file a photograph with twelve numbers, world to pixels up to scale.

Files `NAME_P.txt` or `NAME.P` beside the photographs or in a folder, or `NAME.txt` in a folder named for it (PMVS's
`txt/`, with its first line CONTOUR and photographs in `visualize/`). P is taken apart by RQ decomposition with
positive focal lengths and a right-handed rotation, which makes it unique: of P and -P, the one whose left 3 x 3 has
a positive determinant. Remaining skew is removed as a lens. The format does not specify a pixel's centre: P is used
as it is. R. Hartley and A. Zisserman, "Multiple View Geometry", section 6.2.4.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, read_each
from eigenfield.capture.readers.skew import remove_skew
from eigenfield.capture.readers.text import check_finite, damaged_error, files_in, parse_numbers, read_text
from eigenfield.core.errors import CaptureError, one_line

PROJECTION_SUFFIXES = ("_P.txt", "_p.txt", ".P")
PROJECTION_FOLDERS = ("", "P", "projections", "projection", "calib", "calibration", "cameras", "txt", "images")
# folders where NAME.txt is a matrix too, if it looks like one
PROJECTION_PLAIN_FOLDERS = ("P", "projections", "projection", "txt")
PROJECTION_PMVS_HEAD = "CONTOUR"
PROJECTION_PMVS_FOLDER = "visualize"
PROJECTION_MAX_BYTES = 64 * 1024
PROJECTION_MIN_DETERMINANT = 1e-9


def find_projections(folder: Path) -> Path | None:
    """The folder itself or a usual one in it that holds projection matrices, at least the first of which is one."""
    for name in PROJECTION_FOLDERS:
        files = _matrix_files(folder / name, name in PROJECTION_PLAIN_FOLDERS)
        if files and _is_matrix(files[0]):
            return folder / name
    return None


def _matrix_files(folder: Path, plain: bool) -> list[Path]:
    """`NAME_P.txt` and the like, in name order; only where there is none and `plain`, `NAME.txt`."""
    paths = files_in(folder)
    named = [path for path in paths if path.name.endswith(PROJECTION_SUFFIXES) and _photograph_name(path)]
    return named or [path for path in paths if plain and path.suffix == ".txt"]


def _is_matrix(path: Path) -> bool:
    try:
        _read_matrix(path)
    except CaptureError:
        return False
    return True


def _photograph_name(path: Path) -> str:
    return next((path.name.removesuffix(end) for end in PROJECTION_SUFFIXES if path.name.endswith(end)), path.stem)


def read_projections(path: Path) -> Calibration:
    """Every matrix of a folder (or of the folder of the file that is named) as an entry, named as its file.

    Files that cannot be used become errors of their own; so do other `*.txt`, unless the matrices are named `_P.txt`.

    Raises:
        CaptureError: `calibration-empty` where there is no such file.
    """
    folder = path.parent if path.is_file() else path
    files = _matrix_files(folder, True)
    if not files:
        raise CaptureError(
            "calibration-empty", "holds no NAME_P.txt and no NAME.txt", path=folder, remedy="name another folder"
        )
    entries, errors = read_each(_read_entry, files)
    return Calibration(folder, "projections", entries, errors)


def _read_matrix(path: Path) -> NDArray[np.float64]:
    words = read_text(path, PROJECTION_MAX_BYTES).split()
    if words[:1] == [PROJECTION_PMVS_HEAD]:
        words = words[1:]
    return parse_numbers(words, 12, "the projection matrix", path).reshape(3, 4)


def _read_entry(path: Path) -> Entry:
    name = _photograph_name(path)
    label = one_line(name)
    P = _read_matrix(path)
    check_finite([P], label, path)
    K, R, centre = decompose_projection(P, label, path)
    check_finite([K, centre], label, path)
    K, lens = remove_skew(K, label, path)
    visualised = path.parent.name == "txt" and (path.parent.parent / PROJECTION_PMVS_FOLDER).is_dir()
    file = f"{PROJECTION_PMVS_FOLDER}/{name}" if visualised else name
    return Entry(file, label, Intrinsics.of_matrix(K), R, centre, lens)


def decompose_projection(
    P: NDArray[np.float64], label: str, path: Path
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """K (3, 3) upper triangular with a positive diagonal and last entry 1, R (3, 3) a rotation, and the centre (3,) of
    P (3, 4) ~ K R [I | -centre]. CaptureError `camera-singular` where the camera's centre is at infinity."""
    P = P / max(np.abs(P).max(), np.finfo(float).tiny)
    M = P[:, :3]
    scales = np.linalg.norm(M, axis=1)
    # rows of a projection differ by the focal length: whether it is singular depends on their directions alone
    if scales.min() == 0 or abs(np.linalg.det(M / scales[:, None])) < PROJECTION_MIN_DETERMINANT:
        raise CaptureError(
            "camera-singular",
            f"the projection matrix of {label} is singular: a camera at infinity, or none",
            path=path,
            remedy="mend or remove it",
        )
    if np.linalg.det(M / scales[:, None]) < 0:
        P, M = -P, -M
    # RQ by QR of the reversed transpose
    q, r = np.linalg.qr(M[::-1].T)
    K: NDArray[np.float64]
    R: NDArray[np.float64]
    K, R = r.T[::-1, ::-1], q.T[::-1]
    signs = np.sign(np.diag(K))
    K, R = K * signs, signs[:, None] * R
    if not K[2, 2] > 0:
        raise damaged_error(path, f"the projection matrix of {label} cannot be taken apart")
    return K / K[2, 2], R, np.asarray(-np.linalg.solve(M, P[:, 3]), np.float64)
