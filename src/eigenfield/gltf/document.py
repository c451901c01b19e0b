"""Buffer views and accessors of a GLB, each checked before a byte of it is touched."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError
from eigenfield.gltf.accessors import ViewBytes, find_accessor, read_accessor
from eigenfield.gltf.container import Glb
from eigenfield.gltf.strict_json import Value, quote


@dataclass(frozen=True, eq=False)
class BufferView:
    """A buffer view.

    Attributes:
        offset: Its first byte in the binary chunk.
        stride: In bytes; 0: packed.
    """

    index: int
    offset: int
    length: int
    stride: int

    @property
    def end(self) -> int:
        """The first byte behind it."""
        return self.offset + self.length


@dataclass(frozen=True, eq=False)
class Document:
    """A container and its JSON, to be read through checks only."""

    glb: Glb

    @property
    def root(self) -> Value:
        return Value(self.glb.json)

    def check_buffer(self) -> None:
        """The one buffer must be the binary chunk: `buffer`."""
        buffers = list(self.root["buffers"].items(1, 1))
        if buffers[0].has("uri"):
            buffers[0].fail("buffer", f"the buffer lies in another file, {quote(buffers[0]['uri'].value)}")
        length = buffers[0]["byteLength"].integer(1, limits.MAX_FILE)
        if not 0 <= self._length - length < 4:
            buffers[0].fail("buffer", f"{length} bytes, but the binary chunk has {self._length}")

    def check_addresses(self) -> None:
        """No part of the file lies in another one: every `uri` outside of `extras` is a data URI. `address`."""
        waiting: list[tuple[str, Any]] = [("", self.glb.json)]
        while waiting:
            where, value = waiting.pop()
            for key, item in value.items() if isinstance(value, dict) else enumerate(value):
                if key == "uri" and not (isinstance(item, str) and item[:5].lower() == "data:"):
                    message, remedy = f"the file names another one, {quote(item)}", "export all of it as one .glb"
                    raise FormatError("address", message, where=f"{where}/uri", remedy=remedy)
                if key != "extras" and isinstance(item, dict | list):
                    waiting.append((f"{where}/{key}", item))

    def check_end(self, extension: Value) -> None:
        """A file may end within its eigen textures or its residual, and nowhere else: `truncated`. (What lies behind
        the end otherwise is missed where it is read.)"""
        if not self.glb.missing:
            return
        last = [extension["residual"]["bufferView"]] if extension.has("residual") else []
        for plane in extension["planes"].items(limits.MAX_PLANES):
            for basis in plane["bases"].items(limits.MAX_BASES):
                last += [texture["bufferView"] for texture in basis["textures"].items(limits.MAX_COMPONENTS)]
        if not any(map(self.cut_off, last)):
            raise self.glb.cut_off()

    def cut_off(self, reference: Value) -> bool:
        """Whether the file ends before the buffer view whose index `reference` holds does. FormatError as `view`."""
        return self.view_at(self._index(reference)).end > self.glb.binary.size

    @property
    def _length(self) -> int:
        return self.glb.binary.size + self.glb.missing

    def check_overlap(self) -> None:
        """No byte belongs to two buffer views: `view-overlap`."""
        count = len(list(self.root["bufferViews"].items(limits.MAX_VIEWS)))
        views = sorted((self.view_at(index) for index in range(count)), key=lambda view: (view.offset, view.length))
        for before, after in pairwise(views):
            if after.offset < before.end:
                message, where = f"shares bytes with buffer view {before.index}", f"/bufferViews/{after.index}"
                raise FormatError("view-overlap", message, where=where)

    def view(self, reference: Value) -> BufferView:
        """The buffer view whose index `reference` holds. FormatError `view-range`, `view-missing`, `truncated`."""
        view = self.view_at(self._index(reference))
        if view.end > self.glb.binary.size:
            raise self.glb.cut_off()
        return view

    def _index(self, reference: Value) -> int:
        count = len(list(self.root["bufferViews"].items(limits.MAX_VIEWS)))
        index = reference.integer(0, 2**31)
        if index >= count:
            reference.fail("view-missing", f"there are {count} buffer views, {index} is none of them")
        return index

    def view_at(self, index: int) -> BufferView:
        """A buffer view by its index; of a file that is cut off it may lie behind the end. FormatError `view-range`."""
        entry = self.root["bufferViews"].at(index)
        if entry["buffer"].integer(0, 2**31) != 0:
            entry.fail("view-range", "lies in a buffer that does not exist")
        offset = entry["byteOffset"].integer(0, limits.MAX_FILE) if entry.has("byteOffset") else 0
        length = entry["byteLength"].integer(1, limits.MAX_FILE)
        stride = entry["byteStride"].integer(4, 252) if entry.has("byteStride") else 0
        if offset + length > self._length:
            entry.fail("view-range", f"ends at byte {offset + length} of {self._length}")
        return BufferView(index, offset, length, stride)

    def data(self, reference: Value) -> memoryview:
        """The bytes of the buffer view whose index `reference` holds. FormatError as `view`."""
        view = self.view(reference)
        return self.glb.binary.data[view.offset : view.end]

    def array(self, reference: Value, kind: str, components: tuple[int, ...], most: int) -> NDArray[Any]:
        """A copy of an accessor of this kind: (n,) for SCALAR, (n, 2) or (n, 3) for VEC2, VEC3. FormatError
        `accessor-missing`, `accessor-type`, `accessor-range`, `accessor-alignment`."""
        self.root["accessors"].items(limits.MAX_VIEWS)
        entry = find_accessor(self.root, reference)
        found = entry["type"].text()
        component = entry["componentType"].integer(0, 2**31)
        if found != kind or component not in components:
            entry.fail("accessor-type", f"{quote(found)} of {component}, {kind} of {components} expected")
        if entry.has("sparse") or (entry.has("normalized") and entry["normalized"].value is not False):
            entry.fail("accessor-type", "sparse and normalised accessors are not read here")
        entry["bufferView"]
        return read_accessor(entry, self._view_bytes, most, aligned=True)

    def _view_bytes(self, reference: Value) -> ViewBytes:
        view = self.view(reference)
        return ViewBytes(self.glb.binary.data[view.offset : view.end], view.stride, view.offset)


def all_finite(array: NDArray[Any]) -> bool:
    """Whether the magnitude of every number is at most `limits.MAX_NUMBER`."""
    return bool((np.abs(array) <= limits.MAX_NUMBER).all())  # False for NaN
