"""The table of a batch, as Markdown, CSV and JSON."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from eigenfield.core.errors import one_line

Records = Sequence[Mapping[str, Any]]

SCHEMA = "eigenfield.batch/1"
FORMULA = re.compile(r"(^|;)(?=[\s\"]*[=+\-@＝＋－＠])")  # in some countries a semicolon begins a cell
COLUMNS = (  # of a record: key, heading, form
    ("name", "capture", "{}"),
    ("bytes", "bytes", "{:,}"),
    ("photographs", "photographs", "{}"),
    ("psnr", "PSNR", "{:.2f}"),
    ("ssim", "SSIM", "{:.4f}"),
    ("held_out_psnr", "held out", "{:.2f}"),
    ("between_psnr_luma", "between (luma, at least)", "{:.2f}"),
    ("between_psnr", "between (about)", "{:.2f}"),
    ("seconds", "seconds", "{:.0f}"),
    ("error", "error", "{}"),
)


def cells(record: Mapping[str, Any]) -> list[str]:
    """A record's values in the order of `COLUMNS`, for people; empty where there is none."""
    return ["" if record.get(key) is None else form.format(record[key]) for key, _, form in COLUMNS]


def as_markdown(records: Records) -> str:
    """A table in Markdown, whose cells are text: no code, HTML, links or pictures."""
    rows = [[heading for _, heading, _ in COLUMNS], ["---"] * len(COLUMNS), *map(cells, records)]
    return "".join(f"| {' | '.join(map(_markdown_text, row))} |\n" for row in rows)


def _markdown_text(cell: str) -> str:
    return re.sub(r"([\\`|\[\]])", r"\\\1", one_line(cell)).replace("<", "&lt;")


def as_csv(records: Records) -> str:
    """A line of headings, and one for each capture; numbers without commas."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([key for key, _, _ in COLUMNS])
    writer.writerows([_csv_value(record.get(key)) for key, _, _ in COLUMNS] for record in records)
    return text.getvalue()


def _csv_value(value: Any) -> Any:
    """A number as it is, and a text with an apostrophe where a spreadsheet would begin a formula."""
    return FORMULA.sub(r"\1'", one_line(value)) if isinstance(value, str) else value


def as_json(records: Records) -> str:
    """All that is known of each capture."""
    return json.dumps({"schema": SCHEMA, "captures": list(records)}, indent=1, allow_nan=False) + "\n"


TABLE_WRITERS: dict[str, Callable[[Records], str]] = {
    "table.md": as_markdown,
    "table.csv": as_csv,
    "table.json": as_json,
}
