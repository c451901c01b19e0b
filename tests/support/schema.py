"""The JSON Schema of the extension, and whether a file keeps to it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match

from eigenfield.coding import limits
from support import glb_surgery

PATH = Path(__file__).parents[2] / "docs" / "schema" / f"{limits.EXTENSION}.schema.json"
SCHEMA: dict[str, Any] = json.loads(PATH.read_text(encoding="utf-8"))
VALIDATOR = Draft202012Validator(SCHEMA)


def violation(extension: Any) -> str | None:
    """Where and how the root extension breaks the schema, None where it keeps to it."""
    error = best_match(VALIDATOR.iter_errors(extension))
    return None if error is None else f"{error.json_path}: {error.message[:300]}"


def check_json(text: bytes) -> None:
    """AssertionError where the JSON chunk `text` holds an extension that breaks the schema."""
    found = violation(json.loads(text)["extensions"][limits.EXTENSION])
    assert found is None, f"{PATH.name}: {found}"


def extension_of(data: bytes) -> dict[str, Any]:
    """The root extension of a .glb."""
    return glb_surgery.split(data)[0]["extensions"][limits.EXTENSION]
