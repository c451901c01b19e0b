"""Names of an array's cameras, or of a video's frames, that differ by numbers alone: stored as one pattern."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from typing import Any

from eigenfield.coding import limits
from eigenfield.gltf.strict_json import Value

PATTERN_MAX_PARTS = 64
PATTERN_MAX_DIGITS = 9
_NUMBERS = (re.compile(r"([0-9]+)"), re.compile(r"(-?[0-9]+(?:\.[0-9]+)?)"))


def name_pattern(names: Sequence[str]) -> dict[str, Any] | None:
    """The shortest `pattern` of cameras (docs/format.md) for these names; None where there is none, or it is no shorter
    than the names."""
    widths = [width for width in range(1, len(names) + 1) if len(names) % width == 0]
    found = [
        {"counts": [len(names) // width, width], "parts": parts}
        for columns in filter(None, (_columns(names, number) for number in _NUMBERS))
        for width in widths
        if (parts := _parts(columns, len(names) // width, width)) is not None and len(parts) <= PATTERN_MAX_PARTS
    ]
    shortest = min(found, key=_length, default=None)
    return shortest if shortest is not None and _length(shortest) < _length(names) else None


def _length(value: Any) -> int:
    return len(json.dumps(value, ensure_ascii=False, separators=(",", ":")))


def _columns(names: Sequence[str], number: re.Pattern[str]) -> list[list[str]] | None:
    """The names' pieces one below the other, numbers and the texts between them; None where these texts differ."""
    split = [number.split(name) for name in names]
    if any(some[0::2] != split[0][0::2] for some in split):
        return None
    return [[some[k] for some in split] for k in range(len(split[0]))]


def read_pattern(entry: Value) -> list[str]:
    """The names of a pattern. FormatError `json-*`."""
    rows, columns = (item.integer(1, limits.MAX_CAMERAS) for item in entry["counts"].items(2, 2))
    if rows * columns > limits.MAX_CAMERAS:
        entry["counts"].fail("json-value", f"{rows * columns} names, {limits.MAX_CAMERAS} are allowed")
    names = [""] * (rows * columns)
    for part in entry["parts"].items(PATTERN_MAX_PARTS, 1):
        plain = isinstance(part.value, str)
        axis = 0 if plain else part["axis"].integer(0, 1)
        texts = [part.text()] * rows if plain else _texts(part, columns if axis else rows)
        names = [name + texts[i % columns if axis else i // columns] for i, name in enumerate(names)]
        if max(map(len, names)) > limits.MAX_NAME:
            part.fail("json-value", f"names of more than {limits.MAX_NAME} characters")
    return names


def _texts(part: Value, count: int) -> list[str]:
    """The text of each place along an axis."""
    if part.has("texts"):
        return [item.text() for item in part["texts"].items(count, count)]
    first, step = (part[key].integer(0, 10**PATTERN_MAX_DIGITS) for key in ("first", "step"))
    return [f"{first + step * k:0{part['digits'].integer(1, PATTERN_MAX_DIGITS)}d}" for k in range(count)]


def _parts(columns: list[list[str]], rows: int, width: int) -> list[Any] | None:
    """Pieces of the names, each the same in all, along rows or along columns; None where one is not."""
    parts: list[Any] = []
    for pieces in columns:
        along = (pieces[::width], pieces[:width])
        axis = next((k for k in (0, 1) if _repeat_along(along[k], k, width, rows) == pieces), None)
        if axis is None:
            return None
        if len(set(pieces)) > 1:
            parts.append({"axis": axis} | _number_run(along[axis]))
        elif parts and isinstance(parts[-1], str):
            parts[-1] += pieces[0]
        elif pieces[0]:
            parts.append(pieces[0])
    return parts


def _repeat_along(along: list[str], axis: int, width: int, rows: int) -> list[str]:
    return along * rows if axis else [text for text in along for _ in range(width)]


def _number_run(texts: list[str]) -> dict[str, Any]:
    """A rising row of numbers by its first, or the texts themselves."""
    if all(text.isdigit() and len(text) <= PATTERN_MAX_DIGITS for text in texts):
        step, digits = int(texts[1]) - int(texts[0]), min(map(len, texts))
        if step > 0 and texts == [f"{int(texts[0]) + step * k:0{digits}d}" for k in range(len(texts))]:
            return {"first": int(texts[0]), "step": step, "digits": digits}
    return {"texts": texts}
