"""JSON from strangers: UTF-8, no NaN, no doubled keys, bounded depth and numbers; and a cursor that checks types."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NoReturn

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError

_QUOTE_MAX_CHARACTERS = 60  # of a value in a message
_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]")


def parse(data: bytes, where: str | None = None, *, finite: bool = True) -> Any:
    """The JSON value in `data`.

    Args:
        data: UTF-8.
        where: In which part of a file it is; None: it is a whole file.
        finite: Whether NaN and infinite numbers are refused.

    Raises:
        FormatError: `json-size`, `json-invalid`, `json-depth`.
    """
    check_size(len(data), where)

    def refuse(text: str) -> NoReturn:
        raise FormatError("json-invalid", f"{text} is not JSON", where=where)

    def real(text: str) -> float:
        value = float(text)
        return value if math.isfinite(value) or not finite else refuse(text[:_QUOTE_MAX_CHARACTERS])

    def whole(text: str) -> int:
        return int(text) if len(text) <= 20 else refuse(f"a whole number of {len(text)} digits")

    def single(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        mapping = dict(pairs)
        if len(mapping) < len(pairs):
            keys = [key for key, _ in pairs]
            doubled = next(key for i, key in enumerate(keys) if key in keys[:i]) if len(keys) < 1000 else "a key"
            raise FormatError("json-invalid", f"{quote(doubled)} occurs twice in one object", where=where)
        return mapping

    constant = refuse if finite else float
    try:
        text = data.decode("utf-8")
        value = json.loads(text, parse_constant=constant, parse_float=real, parse_int=whole, object_pairs_hook=single)
    except UnicodeDecodeError as error:
        raise FormatError("json-invalid", f"not UTF-8 ({error.reason})", where=where) from error
    except json.JSONDecodeError as error:
        raise FormatError("json-invalid", f"{error.msg}, character {error.pos}", where=where) from error
    except RecursionError as error:
        raise FormatError("json-depth", f"nested more than {limits.MAX_DEPTH} deep", where=where) from error
    _check_depth_and_text(value, where)
    return value


def check_size(size: int, where: str | None) -> None:
    """Refuse more bytes of JSON than are read: `json-size`."""
    if size > limits.MAX_JSON:
        raise FormatError("json-size", f"{size} bytes of JSON, {limits.MAX_JSON} are allowed", where=where)


def _check_depth_and_text(value: Any, where: str | None) -> None:
    level, depth = [value], 0
    while level:
        if depth > limits.MAX_DEPTH:
            raise FormatError("json-depth", f"nested more than {limits.MAX_DEPTH} deep", where=where)
        below: list[Any] = []
        for item in level:
            if isinstance(item, dict):
                below.extend(item.keys())
                below.extend(item.values())
            elif isinstance(item, list):
                below.extend(item)
            elif isinstance(item, str) and not item.isascii() and any("\ud800" <= c <= "\udfff" for c in item):
                raise FormatError("json-invalid", "half of a surrogate pair in a string", where=where)
        level, depth = below, depth + 1


def quote(value: object) -> str:
    """A value of the file as it may appear in a message: short, on one line."""
    text = json.dumps(value) if isinstance(value, (str, int, float, bool, type(None))) else type(value).__name__
    return text if len(text) <= _QUOTE_MAX_CHARACTERS else text[:_QUOTE_MAX_CHARACTERS] + "…"


def is_printable(text: str) -> bool:
    """Whether a name can be shown on one line of a terminal without effects."""
    return _CONTROL.search(text) is None


@dataclass(frozen=True)
class Value:
    """A value of the JSON. Every getter raises FormatError `json-type` or `json-value`.

    Attributes:
        where: Its JSON pointer.
    """

    value: Any
    where: str = ""

    def fail(self, code: str, message: str, remedy: str | None = None) -> NoReturn:
        raise FormatError(code, message, where=self.where or "/", remedy=remedy)

    def _expect(self, kind: type | tuple[type, ...], words: str) -> Any:
        if not isinstance(self.value, kind) or (isinstance(self.value, bool) and kind is not bool):
            self.fail("json-type", f"{words} expected, {quote(self.value)} found")
        return self.value

    def mapping(self) -> dict[str, Any]:
        return self._expect(dict, "an object")

    def has(self, key: str) -> bool:
        return key in self.mapping()

    def __getitem__(self, key: str) -> Value:
        """The member `key`; `json-missing` if there is none."""
        found = self.mapping()
        pointer = f"{self.where}/{key.replace('~', '~0').replace('/', '~1')}"
        if key not in found:
            raise FormatError("json-missing", f"{quote(key)} is missing", where=pointer)
        return Value(found[key], pointer)

    def items(self, most: int, least: int = 0) -> Iterator[Value]:
        """The entries of an array of `least` to `most`."""
        found = self._expect(list, "an array")
        if not least <= len(found) <= most:
            self.fail("json-value", f"{len(found)} entries, {least} to {most} are allowed")
        return (Value(item, f"{self.where}/{index}") for index, item in enumerate(found))

    def size(self) -> int:
        """Entries of an array."""
        return len(self._expect(list, "an array"))

    def at(self, index: int) -> Value:
        """One entry of an array."""
        found = self._expect(list, "an array")
        if index >= len(found):
            raise FormatError("json-missing", f"there are {len(found)} entries", where=f"{self.where}/{index}")
        return Value(found[index], f"{self.where}/{index}")

    def integer(self, least: int, most: int) -> int:
        found: int = self._expect(int, "a whole number")
        if not least <= found <= most:
            self.fail("json-value", f"{found} is not within {least} to {most}")
        return found

    def boolean(self) -> bool:
        return self._expect(bool, "true or false")

    def number(self, largest: float = 3.4e38) -> float:
        """A number of magnitude up to `largest`, by default float32's range."""
        found = float(self._expect((int, float), "a number"))
        if not abs(found) <= largest:
            self.fail("json-value", f"{found} is larger than {largest:g}")
        return found

    def text(self, most: int = limits.MAX_NAME) -> str:
        found: str = self._expect(str, "a string")
        if len(found) > most:
            self.fail("json-value", f"{len(found)} characters, {most} are allowed")
        return found
