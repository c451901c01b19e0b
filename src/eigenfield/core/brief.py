"""Values that hold arrays in one line: their fields by name, arrays by type and shape."""

from __future__ import annotations

import reprlib
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

BRIEF_NUMBERS = 4  # up to so many of an array or a sequence are shown
BRIEF_TEXT = 60  # letters of a text, or of another value
BRIEF_DIGITS = 4


class _Brief(reprlib.Repr):
    """`reprlib` calls `repr_TYPE`; a value inside another one is shown by its type, or by how many there are."""

    def __init__(self) -> None:
        super().__init__()
        self.maxstring = self.maxother = BRIEF_TEXT
        self.maxdict = 2

    def repr_ndarray(self, array: NDArray[Any], level: int) -> str:
        if array.size > BRIEF_NUMBERS or array.dtype.kind not in "biuf":
            return f"{array.dtype} {array.shape}"
        short = [float(f"{number:.{BRIEF_DIGITS}g}") for number in array.ravel()] if array.dtype.kind == "f" else array
        return str(np.reshape(short, array.shape).tolist())

    def repr_tuple(self, values: tuple[Any, ...], level: int) -> str:
        if len(values) <= BRIEF_NUMBERS and not any(map(is_dataclass, values)):
            return super().repr_tuple(values, level)
        kinds = dict.fromkeys(type(value).__name__ for value in values)
        return f"{len(values):,} {' or '.join(kinds)}"

    def repr_bytes(self, data: bytes, level: int) -> str:
        return f"{len(data):,} bytes"

    def repr_instance(self, value: Any, level: int) -> str:
        return f"{type(value).__name__}(...)" if is_dataclass(value) else super().repr_instance(value, level)


_brief = _Brief()


def brief_repr(value: Any) -> str:
    """A dataclass in one line, as its `__repr__`."""
    shown = [f"{one.name}={_brief.repr(getattr(value, one.name))}" for one in fields(value) if one.repr]
    return f"{type(value).__name__}({', '.join(shown)})"
