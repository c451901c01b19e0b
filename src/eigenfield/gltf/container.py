"""The GLB container: a 12-byte header, a JSON chunk, a binary chunk (glTF 2.0, section 4)."""

from __future__ import annotations

import json
import os
import stat
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError, OutputError
from eigenfield.core.recognise import HEAD_BYTES, recognise, refuse_address
from eigenfield.gltf import strict_json
from eigenfield.runtime.objects import find_objects

MAGIC = b"glTF"
JSON_CHUNK = b"JSON"
BINARY_CHUNK = b"BIN\0"
HEADER = struct.Struct("<4sII")  # magic, version, length of the file
CHUNK = struct.Struct("<I4s")  # length of the data, type
MAX_EXACT_INTEGER = 2.0**53  # below which a float is a whole number exactly


@dataclass(frozen=True, eq=False)
class Glb:
    """A container with checked chunks.

    Attributes:
        json: The parsed JSON chunk.
        binary: The first buffer's bytes, empty if there is no binary chunk.
        size: Bytes of the file.
        rest: Offset of the first byte behind the JSON chunk.
        missing: Bytes of the binary chunk that lie behind the end of the file.
    """

    json: Any
    binary: memoryview
    size: int
    rest: int
    missing: int = 0

    def cut_off(self) -> FormatError:
        """The error to raise where the missing bytes are needed."""
        return _truncation_error(self.size, self.size + self.missing)


def read_file(path: Path) -> bytes:
    """The whole file.

    Raises:
        FormatError: `file-missing`, `file-unreadable`, `not-a-file`, `file-size`.
        OptionError: `web-address`; `object-missing`, `store`: an object store has no such file.
    """
    objects = find_objects(path)
    if objects is not None:
        return objects.read()
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):  # a pipe would wait, a device may never end
            raise FormatError("not-a-file", "is no regular file", remedy="name a .glb")
        if status.st_size > limits.MAX_FILE:
            raise FormatError("file-size", f"{status.st_size} bytes, {limits.MAX_FILE} are allowed")
        return path.read_bytes()
    except FileNotFoundError as error:
        refuse_address(path)
        raise FormatError("file-missing", "does not exist", remedy="check the name") from error
    except (OSError, ValueError) as error:  # ValueError: a name with a null byte
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise FormatError("file-unreadable", f"cannot be read: {reason}") from error


def parse_glb(data: bytes) -> Glb:
    """Parse a container. One that ends within its binary chunk is not refused here: see `Glb.missing`.

    Raises:
        FormatError: `not-glb`, `truncated`, `glb-version`, `glb-length`, `glb-chunk`, `json-*`.
    """
    if data[:4] != MAGIC:
        what = recognise(data[:HEAD_BYTES])
        message = "does not begin with 'glTF'" if what is None else f"is {what}, and no .glb"
        raise FormatError("not-glb", message, remedy="name a .glb")
    if len(data) < HEADER.size:
        raise FormatError("truncated", f"ends after {len(data)} bytes, within the header", where=f"byte {len(data)}")
    _, version, length = HEADER.unpack_from(data)
    if version != 2:
        raise FormatError("glb-version", f"glTF {version}, not 2", where="byte 4")
    if length > len(data):
        return _parse_truncated(data, length)
    if length < len(data):
        raise FormatError("glb-length", f"{len(data) - length} bytes follow the end", where="byte 8")
    chunks = _chunks(data)
    start, end = chunks[JSON_CHUNK]
    first, last = chunks.get(BINARY_CHUNK, (end, end))
    value = strict_json.parse(data[start:end], f"byte {start}")
    return Glb(value, memoryview(data)[first:last], len(data), end)


def _parse_truncated(data: bytes, length: int) -> Glb:
    """A container of `length` bytes that ends within its binary chunk; FormatError `truncated` where it ends before."""
    start = HEADER.size + CHUNK.size
    if len(data) >= start:
        size, kind = CHUNK.unpack_from(data, HEADER.size)
        end, first = start + size, start + size + CHUNK.size
        if kind == JSON_CHUNK and first <= len(data):
            extent, kind = CHUNK.unpack_from(data, end)
            if kind == BINARY_CHUNK and len(data) < first + extent <= length:
                value = strict_json.parse(data[start:end], f"byte {start}")
                return Glb(value, memoryview(data)[first:], len(data), end, first + extent - len(data))
    raise _truncation_error(len(data), length)


def _truncation_error(size: int, length: int) -> FormatError:
    message, remedy = f"ends after {size} of {length} bytes", "copy or download it again"
    return FormatError("truncated", message, where=f"byte {size}", remedy=remedy)


def _chunks(data: bytes) -> dict[bytes, tuple[int, int]]:
    """Where each chunk's data lie, by type; unknown types are skipped, as glTF asks."""
    found: dict[bytes, tuple[int, int]] = {}
    offset, count = HEADER.size, 0
    while offset < len(data):
        where = f"byte {offset}"
        if offset + CHUNK.size > len(data):
            raise FormatError("glb-chunk", "a chunk's header is cut off by the end", where=where)
        length, kind = CHUNK.unpack_from(data, offset)
        start = offset + CHUNK.size
        if length % 4:
            raise FormatError("glb-chunk", f"a chunk of {length} bytes, not a multiple of 4", where=where)
        if start + length > len(data):
            raise FormatError("glb-chunk", f"a chunk of {length} bytes reaches past the end", where=where)
        if (count == 0) != (kind == JSON_CHUNK):
            raise FormatError("glb-chunk", "the first chunk must be JSON, and no other", where=where)
        if kind == BINARY_CHUNK and count != 1:
            raise FormatError("glb-chunk", "a binary chunk that is not the second", where=where)
        found[kind] = (start, start + length)
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


def file_head(text: bytes, rest: int, path: str | os.PathLike[str] | None) -> bytes:
    """Header and JSON chunk of a file in which `rest` bytes follow.

    Raises:
        OutputError: `file-too-large`, over 4 GiB.
    """
    size = HEADER.size + CHUNK.size + len(text) + rest
    if size > limits.MAX_FILE:
        message = f"would be {size} bytes, a .glb holds at most {limits.MAX_FILE}"
        remedy = "use fewer textures, a smaller atlas, or --codec avif"
        raise OutputError("file-too-large", message, path=path, remedy=remedy)
    return HEADER.pack(MAGIC, 2, size) + CHUNK.pack(len(text), JSON_CHUNK) + text
