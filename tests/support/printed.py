"""What verbs print with --json keeps to the schemas in docs/schema/."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match

from support.program import Ran

FOLDER = Path(__file__).parents[2] / "docs" / "schema"
VERBS = "calibrate", "evaluate", "info", "inspect", "validate"


def _closed(schema: Any) -> Any:
    """The schema, which allows more keys, without that: what is printed must be in it."""
    if isinstance(schema, list):
        return [_closed(entry) for entry in schema]
    if not isinstance(schema, dict):
        return schema
    closed = {key: _closed(entry) for key, entry in schema.items()}
    return closed | {"additionalProperties": False} if "properties" in schema and "type" in schema else closed


@cache
def schema(verb: str) -> dict[str, Any]:
    """The schema of what a verb prints."""
    found: dict[str, Any] = json.loads((FOLDER / f"{verb}.schema.json").read_text(encoding="utf-8"))
    return found


@cache
def _validator(verb: str) -> Draft202012Validator:
    return Draft202012Validator(_closed(schema(verb)))


def violation(verb: str, report: Any) -> str | None:
    """Where and how a report breaks the schema or has keys that are not in it, None where it keeps to it."""
    error = best_match(_validator(verb).iter_errors(report))
    return None if error is None else f"{error.json_path}: {error.message[:300]}"


def check_printed(words: tuple[object, ...], ran: Ran) -> None:
    """Assert that what a call has printed keeps to the schema, where it was asked for JSON and did not refuse."""
    if "--json" in words and words[0] in VERBS and (ran.code == 0 or ran.out):
        report, verb = json.loads(ran.out), str(words[0])
        of_clip = isinstance(report, dict) and report.get("schema") == "eigenfield.evaluate-clip/1"
        assert violation("evaluate-clip" if of_clip else verb, report) is None
