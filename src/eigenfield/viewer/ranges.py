"""Byte ranges and validators of a request (RFC 9110, sections 13 and 14)."""

from __future__ import annotations

import re
from collections.abc import Mapping

RANGE_HEADER = re.compile(r"bytes=\s*([0-9]{0,100})-([0-9]{0,100})\s*", re.IGNORECASE)


class RangeError(Exception):
    """A range without a byte of the content in it: status 416."""


def wanted_range(headers: Mapping[str, str], size: int, tag: str) -> tuple[int, int] | None:
    """First byte and the one behind the last that a GET asks for; None: all of it.

    None also for several ranges and for a Range that cannot be read, which a server may ignore, and where If-Range
    names another content.

    Args:
        headers: Of the request, by names in lower case.
        size: Of the content, in bytes.
        tag: Strong ETag of the content, quotes included.

    Raises:
        RangeError: No byte of the content is in the range.
    """
    match = RANGE_HEADER.fullmatch(headers.get("range", ""))
    if match is None or headers.get("if-range", tag) != tag:
        return None
    first, last = match[1], match[2]
    if not first:
        if not last:
            return None
        if int(last) == 0 or size == 0:
            raise RangeError
        return max(0, size - int(last)), size
    if last and int(last) < int(first):
        return None
    if int(first) >= size:
        raise RangeError
    return int(first), min(size, int(last) + 1) if last else size


def is_known(headers: Mapping[str, str], tag: str) -> bool:
    """Whether If-None-Match says that the client has this content already: status 304.

    Args:
        headers: Of the request, by names in lower case.
        tag: Strong ETag of the content, quotes included.
    """
    tags = [entry.strip().removeprefix("W/") for entry in headers.get("if-none-match", "").split(",")]
    return tag in tags or tags == ["*"]
