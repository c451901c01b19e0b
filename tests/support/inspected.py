"""The JSON Schema of `inspect --json`, and whether a report keeps to it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from support import printed

PATH = printed.FOLDER / "inspect.schema.json"
SCHEMA = printed.schema("inspect")


def violation(report: Any) -> str | None:
    """As `printed.violation`."""
    return printed.violation("inspect", report)


def keys(schema: Any = SCHEMA) -> Iterator[str]:
    """The keys of all objects of the schema."""
    if isinstance(schema, dict):
        for key, entry in schema.items():
            if key == "properties":
                yield from entry
            yield from keys(entry)
    elif isinstance(schema, list):
        for entry in schema:
            yield from keys(entry)
