"""The binary chunk of a .glb while it is written."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.payloads import Payload
from eigenfield.gltf.accessors import DTYPES


@dataclass
class Buffer:
    """The binary chunk while it grows, and the JSON entries that point into it.

    Attributes:
        once: Buffer views of bytes that `shared_stream` has written.
        codecs: Places (`streams.PLACES`) and codecs of its streams.
        packed: The streams of a packed extension, which lie behind all buffer views; None where it is plain.
    """

    parts: list[bytes] = field(default_factory=list)
    length: int = 0
    views: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)
    once: dict[bytes, int] = field(default_factory=dict)
    codecs: set[tuple[str, str]] = field(default_factory=set)
    packed: list[bytes] | None = None

    def view(self, data: bytes, target: int | None = None) -> int:
        """Append a buffer view at a multiple of 4; its index. Of a packed file no stream comes before."""
        assert not self.packed
        entry: dict[str, Any] = {"buffer": 0, "byteOffset": self.length, "byteLength": len(data)}
        if target is not None and self.packed is None:
            entry["target"] = target
        self.views.append(entry)
        self.parts.append(data + bytes(-len(data) % 4))
        self.length += len(self.parts[-1])
        return len(self.views) - 1

    def stream(self, payload: Payload, place: str) -> int:
        """As `view`, of a coded stream."""
        self.codecs.add((place, payload.codec))
        if self.packed is None:
            return self.view(payload.data)
        self.packed.append(payload.data)
        return len(self.views) + len(self.packed) - 1

    def shared_stream(self, payload: Payload, place: str) -> int:
        """As `stream`; the same buffer view for the same bytes."""
        if payload.data not in self.once:
            self.once[payload.data] = self.stream(payload, place)
        return self.once[payload.data]

    def accessor(self, array: NDArray[Any], component: int, kind: str, target: int | None = None, **more: Any) -> int:
        """Append an array (n,) or (n, k) as an accessor of its own buffer view; its index."""
        view = self.view(np.ascontiguousarray(array, DTYPES[component]).tobytes(), target)
        entry = {"bufferView": view, "componentType": component, "count": len(array), "type": kind}
        self.accessors.append(entry | more)
        return len(self.accessors) - 1
