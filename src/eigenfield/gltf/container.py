"""The GLB container: a 12-byte header, a JSON chunk, a binary chunk (glTF 2.0, section 4)."""

from __future__ import annotations

import json
import os
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Any, Protocol

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError, OutputError
from eigenfield.core.recognise import HEAD_BYTES, recognise
from eigenfield.gltf import strict_json
from eigenfield.gltf.source import ByteRange, ByteSource, HeldBytes, truncation_error

MAGIC = b"glTF"
JSON_CHUNK = b"JSON"
BINARY_CHUNK = b"BIN\0"
GROUPS_CHUNK = b"EFTL"  # of a clip, behind the binary chunk
HEADER = struct.Struct("<4sII")  # magic, version, length of the file
CHUNK = struct.Struct("<I4s")  # length of the data, type
MAX_EXACT_INTEGER = 2.0**53  # below which a float is a whole number exactly


@dataclass(frozen=True, eq=False)
class Glb:
    """A container with checked chunks.

    Attributes:
        chunks: Where the data of each chunk lie, by its type; of several of one type the last.
        missing: Bytes of the binary chunk that lie behind the end of the file.
        missing_groups: Likewise of the chunk of groups.
    """

    json: Any
    source: ByteSource
    chunks: Mapping[bytes, ByteRange]
    missing: int = 0
    missing_groups: int = 0

    @property
    def binary(self) -> ByteRange:
        """The first buffer's bytes; none if there is no binary chunk."""
        return self.chunks.get(BINARY_CHUNK, ByteRange(self.source, self.source.size, self.source.size))

    def behind(self, kind: bytes) -> ByteRange:
        """All that follows the data of a chunk: whole chunks with their heads."""
        return ByteRange(self.source, self.chunks[kind].last, self.source.size)

    def cut_off(self) -> FormatError:
        """The error to raise where the missing bytes are needed."""
        return truncation_error(self.source.size, self.source.size + self.missing + self.missing_groups)


def parse_glb(data: bytes | ByteSource) -> Glb:
    """Parse a container, of which only the JSON and the heads of chunks are read.

    One that ends within its binary chunk or its groups is not refused here: see `Glb.missing`.

    Raises:
        FormatError: `not-glb`, `truncated`, `glb-version`, `glb-length`, `glb-chunk`, `json-*`.
    """
    source = HeldBytes(data) if isinstance(data, bytes) else data
    head, size = bytes(source.read(0, max(HEAD_BYTES, HEADER.size))), source.size
    if head[:4] != MAGIC:
        what = recognise(head[:HEAD_BYTES])
        message = "does not begin with 'glTF'" if what is None else f"is {what}, and no .glb"
        raise FormatError("not-glb", message, remedy="name a .glb")
    if size < HEADER.size:
        raise FormatError("truncated", f"ends after {size} bytes, within the header", where=f"byte {size}")
    _, version, length = HEADER.unpack_from(head)
    if version != 2:
        raise FormatError("glb-version", f"glTF {version}, not 2", where="byte 4")
    if length > size:
        return _parse_truncated(source, length)
    if length < size:
        raise FormatError("glb-length", f"{size - length} bytes follow the end", where="byte 8")
    chunks = _chunks(source)
    return Glb(_parse_json(chunks[JSON_CHUNK]), source, chunks)


def _parse_json(chunk: ByteRange) -> Any:
    where = f"byte {chunk.first}"
    strict_json.check_size(chunk.size, where)
    return strict_json.parse(bytes(chunk.read(0, chunk.size)), where)


def _parse_truncated(source: ByteSource, length: int) -> Glb:
    """A container of `length` bytes that ends within its second or third chunk, of its binary bytes or of its groups.
    FormatError `truncated` where it ends elsewhere."""
    chunks: dict[bytes, ByteRange] = {}
    offset, end, expected = HEADER.size, source.size, (JSON_CHUNK, BINARY_CHUNK, GROUPS_CHUNK)
    for wanted in expected:
        start = offset + CHUNK.size
        if start > end:
            break
        size, kind = CHUNK.unpack(source.read(offset, start))
        offset = start + size
        if kind != wanted or offset > length:
            break
        chunks[kind] = ByteRange(source, start, min(offset, end))
        if offset > end and kind != JSON_CHUNK:
            missing = (offset - end, 0) if kind == BINARY_CHUNK else (0, offset - end)
            return Glb(_parse_json(chunks[JSON_CHUNK]), source, chunks, *missing)
    raise truncation_error(end, length)


def _chunks(source: ByteSource) -> dict[bytes, ByteRange]:
    """Where each chunk's data lie, by type; unknown types are skipped, as glTF asks."""
    found: dict[bytes, ByteRange] = {}
    offset, count = HEADER.size, 0
    while offset < source.size:
        where = f"byte {offset}"
        if offset + CHUNK.size > source.size:
            raise FormatError("glb-chunk", "a chunk's header is cut off by the end", where=where)
        start = offset + CHUNK.size
        length, kind = CHUNK.unpack(source.read(offset, start))
        if length % 4:
            raise FormatError("glb-chunk", f"a chunk of {length} bytes, not a multiple of 4", where=where)
        if start + length > source.size:
            raise FormatError("glb-chunk", f"a chunk of {length} bytes reaches past the end", where=where)
        if (count == 0) != (kind == JSON_CHUNK):
            raise FormatError("glb-chunk", "the first chunk must be JSON, and no other", where=where)
        if kind == BINARY_CHUNK and count != 1:
            raise FormatError("glb-chunk", "a binary chunk that is not the second", where=where)
        found[kind] = ByteRange(source, start, start + length)
        offset, count = start + length, count + 1
        if count > limits.MAX_CHUNKS:
            raise FormatError("glb-chunk", f"more than {limits.MAX_CHUNKS} chunks", where=where)
    if JSON_CHUNK not in found:
        raise FormatError("glb-chunk", "there is no JSON chunk", where=f"byte {HEADER.size}")
    return found


def json_bytes(value: Any) -> bytes:
    """Compact JSON, whole numbers without a fraction, padded with spaces to a multiple of 4.

    Raises:
        ValueError: NaN, which is our own bug.
    """
    text = json.dumps(_without_fractions(value), separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    data = text.encode()
    return data + b" " * (-len(data) % 4)


def _without_fractions(value: Any) -> Any:
    """The same numbers in fewer characters: 1 for 1.0."""
    if isinstance(value, dict):
        return {key: _without_fractions(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_without_fractions(item) for item in value]
    return int(value) if isinstance(value, float) and value.is_integer() and abs(value) < MAX_EXACT_INTEGER else value


def file_head(text: bytes, rest: int, path: str | os.PathLike[str] | None, *, is_clip: bool = False) -> bytes:
    """Header and JSON chunk of a file in which `rest` bytes follow. OutputError `file-too-large`, over 4 GiB."""
    size = HEADER.size + CHUNK.size + len(text) + rest
    if size > limits.MAX_FILE:
        message = f"would be {size} bytes, a .glb holds at most {limits.MAX_FILE}"
        if is_clip:
            raise OutputError("file-too-large", message, path=path, remedy="make it a folder: -o clip, without .glb")
        remedy = "use fewer textures, a smaller atlas, or --codec avif"
        raise OutputError("file-too-large", message, path=path, remedy=remedy)
    return HEADER.pack(MAGIC, 2, size) + CHUNK.pack(len(text), JSON_CHUNK) + text


class Pieces(Protocol):
    """Bytes that are read a piece at a time."""

    @property
    def size(self) -> int:
        """How many there are."""

    def pieces(self) -> Iterator[memoryview]:
        """All of them."""


def glb_blocks(
    text: bytes, binary: bytes, path: str | os.PathLike[str] | None = None, behind: Pieces | None = None
) -> Iterator[bytes | memoryview]:
    """The bytes of a file, to be written one block after the other.

    Args:
        text: The JSON chunk (`json_bytes`).
        behind: Whole chunks that follow, read a piece at a time; None: nothing does.

    Raises:
        OutputError: `file-too-large`, over 4 GiB: before the first block.
    """
    padding = bytes(-len(binary) % 4)
    length = len(binary) + len(padding)
    rest = CHUNK.size + length + (0 if behind is None else behind.size)
    head = file_head(text, rest, path, is_clip=behind is not None)
    blocks = [head, CHUNK.pack(length, BINARY_CHUNK), binary, padding]
    return chain(blocks, () if behind is None else behind.pieces())
