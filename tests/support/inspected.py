"""The JSON Schema of `inspect --json`, and whether a report keeps to it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match

PATH = Path(__file__).parents[2] / "docs" / "schema" / "inspect.schema.json"
SCHEMA: dict[str, Any] = json.loads(PATH.read_text(encoding="utf-8"))


def _closed(schema: Any) -> Any:
    """The schema, which allows more keys, without that: what is printed must be in it."""
    if isinstance(schema, list):
        return [_closed(entry) for entry in schema]
    if not isinstance(schema, dict):
        return schema
    closed = {key: _closed(entry) for key, entry in schema.items()}
    return closed | {"additionalProperties": False} if "properties" in schema and "type" in schema else closed


VALIDATOR = Draft202012Validator(_closed(SCHEMA))


def violation(report: Any) -> str | None:
    """Where and how a report breaks the schema or has keys that are not in it, None where it keeps to it."""
    error = best_match(VALIDATOR.iter_errors(report))
    return None if error is None else f"{error.json_path}: {error.message[:300]}"


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
