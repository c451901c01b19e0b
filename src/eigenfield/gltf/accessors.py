"""The one reader of glTF accessors, for our scenes and for meshes of other programs (glTF 2.0, section 3.6.2)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.gltf.strict_json import Value, quote

FLOAT, UINT32, UINT16, INT16, UINT8, INT8 = 5126, 5125, 5123, 5122, 5121, 5120
DTYPES = {
    kind: np.dtype(name)
    for kind, name in ((FLOAT, "<f4"), (UINT32, "<u4"), (UINT16, "<u2"), (INT16, "<i2"), (UINT8, "u1"), (INT8, "i1"))
}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}

ACCESSOR_MAX_ZEROS = 2**24  # elements of an accessor that no bytes stand behind


class ViewBytes(NamedTuple):
    """The bytes of a buffer view.

    Attributes:
        stride: In bytes; 0: packed.
        offset: Of the first byte in the buffer.
    """

    data: memoryview
    stride: int
    offset: int


ViewReader = Callable[[Value], ViewBytes]


def find_accessor(root: Value, reference: Value) -> Value:
    """The accessor whose index `reference` holds. FormatError `accessor-missing`."""
    accessors = root["accessors"]
    index, count = reference.integer(0, 2**31), accessors.size()
    if index >= count:
        reference.fail("accessor-missing", f"there are {count} accessors, {index} is none of them")
    return accessors.at(index)


def read_accessor(entry: Value, view: ViewReader, most: int, *, aligned: bool = False) -> NDArray[Any]:
    """A copy of an accessor's elements: (n,) for SCALAR, (n, k) for a vector or a matrix of k numbers.

    Normalised integers c of b bits become float64, c / (2^b - 1), or max(c / (2^(b - 1) - 1), -1) with a sign.

    Args:
        view: Gives the bytes of the buffer view whose index a value holds.
        aligned: Refuse numbers that lie at no multiple of their size.

    Raises:
        FormatError: `accessor-type`, `accessor-range`, `accessor-alignment`; `json-*`; what `view` raises.
    """
    kind, component = entry["type"].text(), entry["componentType"].integer(0, 2**31)
    if kind not in WIDTHS or component not in DTYPES:
        entry.fail("accessor-type", f"{quote(kind)} of component type {component} is not read")
    dtype, width, count = DTYPES[component], WIDTHS[kind], entry["count"].integer(1, most)
    if entry.has("bufferView"):
        found = _elements(entry, view, dtype, width, count, aligned)
    elif count > ACCESSOR_MAX_ZEROS:
        entry.fail("accessor-range", f"{count} elements without a buffer view, {ACCESSOR_MAX_ZEROS} are allowed")
    else:
        found = np.zeros((count, width), dtype)
    if entry.has("sparse"):
        _substitute(entry["sparse"], view, found)
    if entry.has("normalized") and entry["normalized"].boolean() and dtype.kind != "f":
        found = np.maximum(found / np.iinfo(dtype).max, -1.0)
    return found if width > 1 else found[:, 0]


def _elements(
    entry: Value, view: ViewReader, dtype: np.dtype[Any], width: int, count: int, aligned: bool = False
) -> NDArray[Any]:
    """(count, width) numbers where `bufferView` and `byteOffset` of an entry say."""
    data, stride, offset = view(entry["bufferView"])
    start = entry["byteOffset"].integer(0, limits.MAX_FILE) if entry.has("byteOffset") else 0
    element = dtype.itemsize * width
    stride = stride or element
    if aligned and ((offset + start) % dtype.itemsize or stride % dtype.itemsize):
        entry.fail("accessor-alignment", f"begins at byte {offset + start}")
    if stride < element or start + stride * (count - 1) + element > len(data):
        entry.fail("accessor-range", f"{count} entries do not fit into {len(data)} bytes from byte {start}")
    return np.ndarray((count, width), dtype, data, start, (stride, dtype.itemsize)).copy()


def _substitute(sparse: Value, view: ViewReader, found: NDArray[Any]) -> None:
    """Put the values of a sparse accessor into the elements (n, k) that they replace."""
    count = sparse["count"].integer(1, len(found))
    component = sparse["indices"]["componentType"].integer(0, 2**31)
    if component not in (UINT8, UINT16, UINT32):
        sparse["indices"].fail("accessor-type", f"indices of component type {component}")
    index = _elements(sparse["indices"], view, DTYPES[component], 1, count)[:, 0]
    if index.max() >= len(found):
        sparse["indices"].fail("accessor-range", f"element {index.max()} of {len(found)} is replaced")
    found[index] = _elements(sparse["values"], view, found.dtype, found.shape[1], count)
