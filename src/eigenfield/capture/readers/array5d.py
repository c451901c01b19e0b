"""A light field as one array of row, column, y, x and channel, in MATLAB's .mat or in HDF5.

The Light Field Toolbox for MATLAB (Dansereau) keeps `LF` so, with the weight of a pixel as a fourth channel, which is
left out; data sets for learning and the old HCI benchmark (Wanner et al. 2013: `lf.h5`, `LF`) do likewise. MATLAB 7.3
writes HDF5 with the axes in reverse.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from eigenfield.capture.arrangement import Arrangement
from eigenfield.capture.photographs.kinds import is_installed
from eigenfield.capture.readers.packed import Views, only_file, packed_file, unpack_views
from eigenfield.core.errors import CaptureError, one_line
from eigenfield.core.open_options import OpenOptions

ARRAY_ENDINGS = (".mat", ".h5", ".hdf5")
ARRAY_NAME = "lf"  # of the one that is meant where there are several, small or capital
ARRAY_AXES = 5
ARRAY_MAX_VIEWS, ARRAY_MIN_PIXELS = 64, 16  # along an axis
ARRAY_MAX_OVERSHOOT = 0.5  # of floats beyond 0 and 1, which filters leave; 0..255 is no such thing
ARRAY_MAX_BYTES = 8 * 2**30
HDF5_HEADS = b"\x89HDF\r\n\x1a\n", b"MATLAB 7.3"
MATLAB_CLASS = "MATLAB_class"  # an attribute of what MATLAB wrote
ARRAY_ERRORS = (
    ArithmeticError, AttributeError, EOFError, LookupError, NotImplementedError, OSError, RuntimeError, TypeError,
    ValueError, struct.error, zlib.error,
)  # fmt: skip


def find_array(folder: Path) -> Path | None:
    """The array of a folder that holds no photographs."""
    return only_file(folder, ARRAY_ENDINGS)


def read_array(found: Path, options: OpenOptions) -> Arrangement:
    """The middle views of an array.

    Raises CaptureError: `names-unknown`, `views-missing`, `views-unreadable`, `views-large`, `extra-missing`,
    `grid-size`.
    """
    path = packed_file(found, find_array, "an array of views")
    return unpack_views("array", path, options, lambda: _read_views(path))


def _read_views(path: Path) -> Views:
    with path.open("rb") as file:
        is_hdf5 = file.read(16).startswith(HDF5_HEADS)
    if is_hdf5 and not is_installed("h5py"):
        raise CaptureError(
            "extra-missing", "is HDF5, which needs h5py", path=path, remedy="pip install 'eigenfield[arrays]'"
        )
    try:
        views = _read_hdf5(path) if is_hdf5 else _read_matlab(path)
    except CaptureError:
        raise
    except ARRAY_ERRORS as error:
        why = one_line((str(error) or type(error).__name__)[:120])
        raise CaptureError("views-unreadable", f"is damaged ({why})", path=path, remedy="copy it again") from error
    rows, columns, height, width, channels = views.shape
    fits = rows <= ARRAY_MAX_VIEWS and columns <= ARRAY_MAX_VIEWS and channels in (1, 3, 4)
    fits &= views.dtype.kind == "f" or views.dtype in (np.uint8, np.uint16)
    if not fits or min(height, width) < ARRAY_MIN_PIXELS:
        shape = "x".join(map(str, views.shape))
        raise _missing(path, f"its array of {shape} {views.dtype.name} is none of row, column, y, x and channel")
    views = views[..., :3]
    if views.dtype.kind != "f":
        return views
    least, most = float(views.min()), float(views.max())
    if not (least >= -ARRAY_MAX_OVERSHOOT and most <= 1 + ARRAY_MAX_OVERSHOOT):  # nor where one is no number
        raise _missing(path, f"its values go from {least:g} to {most:g}, and not from 0 to 1")
    return views.astype(np.float32, copy=False)


def _missing(path: Path, message: str) -> CaptureError:
    remedy = "save LF(row, column, y, x, channel) of uint8, uint16 or 0..1, as the Light Field Toolbox does"
    return CaptureError("views-missing", message, path=path, remedy=remedy)


def _choose(shapes: Mapping[str, tuple[int, ...]], path: Path) -> str:
    """The name of the array that is meant."""
    fitting = [name for name, shape in shapes.items() if len(shape) == ARRAY_AXES]
    named = [name for name in fitting if name.lower() == ARRAY_NAME] or fitting
    if len(named) != 1:
        count = f"{len(named)} arrays" if named else "no array"
        raise _missing(path, f"holds {count} of {ARRAY_AXES} axes")
    return named[0]


def _refuse_large(path: Path, values: int, item_bytes: int) -> None:
    if values * item_bytes > ARRAY_MAX_BYTES:
        size = values * item_bytes / 1e9
        raise CaptureError("views-large", f"holds {size:.3g} GB of views", path=path, remedy="save fewer or smaller")


def _read_matlab(path: Path) -> Views:
    from scipy.io import loadmat, whosmat
    from scipy.io.matlab import MatReadError

    try:
        shapes = {name: tuple(shape) for name, shape, _ in whosmat(str(path))}
    except MatReadError as error:
        raise ValueError(str(error)) from error
    name = _choose(shapes, path)
    _refuse_large(path, int(np.prod([int(side) for side in shapes[name]], dtype=object)), 2)
    found: Any = loadmat(str(path), variable_names=[name])[name]
    return np.asarray(found)


def _read_hdf5(path: Path) -> Views:
    import h5py

    with h5py.File(path, "r") as file:
        sets = {name: item for name, item in file.items() if isinstance(item, h5py.Dataset)}
        data = sets[_choose({name: item.shape or () for name, item in sets.items()}, path)]
        _refuse_large(path, data.size, data.dtype.itemsize)
        views = np.asarray(data[()])
        return views.transpose() if MATLAB_CLASS in data.attrs else views
