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
PACKED = Draft202012Validator({"$ref": "#/$defs/packed", "$defs": SCHEMA["$defs"]})


def violation(extension: Any) -> str | None:
    """Where and how the root extension breaks the schema, None where it keeps to it."""
    error = best_match(VALIDATOR.iter_errors(extension))
    return None if error is None else f"{error.json_path}: {error.message[:300]}"


def check_file(text: bytes, binary: bytes) -> None:
    """AssertionError where a file of this JSON and binary chunk holds an extension that breaks the schema."""
    data = glb_surgery.join_text(text, binary)
    outer = glb_surgery.split_packed(data)[0]["extensions"][limits.EXTENSION]
    wrong = best_match(PACKED.iter_errors(outer)) if "packed" in outer else None
    found = violation(extension_of(data)) if wrong is None else wrong.message
    assert found is None, f"{PATH.name}: {found}"


def extension_of(data: bytes) -> dict[str, Any]:
    """The root extension of a .glb."""
    return glb_surgery.split(data)[0]["extensions"][limits.EXTENSION]
