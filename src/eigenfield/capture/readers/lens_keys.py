"""Keys of a camera that look like a lens: one that a reader does not use is an error that names it.

Left out without a word, its photographs would keep their distortion. No format fixes how such keys are spelled, so they
are told by their words, in any case. A key counts only where it holds a number that is not 0, or names a kind of lens.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from eigenfield.capture.readers.text import excerpt
from eigenfield.core.errors import CaptureError

# of keys in lower case, without what is no letter and no digit
LENS_KEY = re.compile(
    r"(cam|camera|opencv|image|img|intrinsics?)?dist(?!ance|ribut|rict|inct|to|from)|(?!.*undist).*distort"
    r"|.*(lens|radial|tangential|decenter|fisheye|ftheta|coef)|thinprism|latlong|equirect|orthographic"
)
LENS_COEFFICIENT_KEY = re.compile(r"(k|p|s|sx|sy|kappa)\d{1,2}|tau[xy]|omega|xi")  # of one number
LENS_LIST_KEY = re.compile(r"d|k|kc")  # of coefficients in a row
LENS_PROJECTION_KEY = re.compile(r".*(fisheye|latlong|equirect|orthographic)")  # of a flag
# what is written beside a lens, by how it ends
LENS_OTHER_KEY = re.compile(
    r".*(id|index|number|serial|mm|units?|focal|length|aperture|count|errors?|rms|std|thresh|cov\w*)"
)
LENS_MODEL_KEY = re.compile(r".*(model|type|projection|distortion|lens)")  # of a word that may name a lens
LENS_MODEL_WORD = re.compile(
    r"(opencv|simple|radial|thinprism)*"
    r"(fish|equidist|equisolid|kannala|omni|eucm|division|fov|stereog|equirect|panoram|spheric)"
)
LENS_COUNTS = range(1, 9)  # of coefficients that stand in a row; nine are a matrix
LENS_MAX_FIRST = 100  # of the first one: beyond, it is a focal length in pixels
LENS_MAX_KEY_CHARACTERS = 100  # of a key that are looked at
LENS_MAX_DEPTH = 8


def refuse_lens_keys(values: Mapping[str, Any], read: Container[str], label: str, path: Path) -> None:
    """CaptureError `camera-model` where a camera has a key that looks like a lens, holds something, and is not read.

    Args:
        values: Of the camera, as its file has them; mappings in it count as parts of the camera.
        read: Keys that the reader uses, as the file spells them.
    """
    for key in lens_keys(values, read):
        refuse_lens_key(key, label, path)


def refuse_lens_key(key: str, label: str, path: Path) -> NoReturn:
    """CaptureError `camera-model` for a key that looks like a lens and is not read."""
    raise CaptureError(
        "camera-model",
        f"{label} has {excerpt(key)!r}, which looks like a lens and is not read",
        path=path,
        remedy="name it as `eigenfield help captures` says of the format, undistort the photographs, or remove it if "
        "it means nothing",
    )


def lens_keys(values: Mapping[str, Any], read: Container[str] = (), depth: int = 0) -> Iterator[str]:
    """The keys of a mapping and of mappings in it that look like a lens and hold something, but for those in `read`."""
    for key, value in values.items():
        if not isinstance(key, str) or key in read:
            continue
        if is_lens(key, value):
            yield key
        elif isinstance(value, Mapping) and depth < LENS_MAX_DEPTH:
            yield from lens_keys(value, (), depth + 1)


def letters(word: str) -> str:
    """A word as names are compared that differ in case and separators alone: its letters and digits."""
    return re.sub(r"[\W_]+", "", word).lower()


def is_lens(key: str, value: Any) -> bool:
    """Whether a key looks like a lens, and its value says something of one."""
    key = letters(key[:LENS_MAX_KEY_CHARACTERS])
    if isinstance(value, str) and LENS_MODEL_WORD.match(letters(value)):
        return LENS_MODEL_KEY.fullmatch(key) is not None
    one, row, other = (pattern.fullmatch(key) for pattern in (LENS_COEFFICIENT_KEY, LENS_LIST_KEY, LENS_OTHER_KEY))
    if not (one or row or LENS_KEY.match(key)):
        return False
    if isinstance(value, bool):
        return value and LENS_PROJECTION_KEY.match(key) is not None
    numbers = np.array(list(_numbers(value)))
    if other or not has_numbers(value):
        return False
    if one:
        return len(numbers) == 1
    if row:
        flat = isinstance(value, list) and not any(isinstance(one, list) for one in value)
        return flat and len(numbers) in LENS_COUNTS and not abs(numbers[0]) > LENS_MAX_FIRST  # true for NaN
    return (
        key != "lens" or len(numbers) > 1 or bool(abs(numbers[0]) < 1)
    )  # beyond, Blender's focal length in millimetres


def has_numbers(value: Any) -> bool:
    """Whether a value holds a number that is not 0; NaN is one."""
    return any(number != 0 for number in _numbers(value))


def _numbers(value: Any, depth: int = 0) -> Iterator[float]:
    """The numbers in a value, as numbers or as words."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        yield float(value) if abs(value) < 1e300 else np.inf
    elif isinstance(value, str):
        for word in value.replace(",", " ").strip("[]() ").split():
            try:
                yield float(word)
            except ValueError:
                return
    elif isinstance(value, np.ndarray):
        yield from map(float, value.ravel())
    elif isinstance(value, (list, Mapping)) and depth < LENS_MAX_DEPTH:
        for inner in value.values() if isinstance(value, Mapping) else value:
            yield from _numbers(inner, depth + 1)
