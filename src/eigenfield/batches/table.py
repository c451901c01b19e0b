"""The table of a batch, as Markdown, CSV and JSON."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

Records = Sequence[Mapping[str, Any]]

SCHEMA = "eigenfield.batch/1"
COLUMNS = (  # of a record: key, heading, form
    ("name", "capture", "{}"),
    ("bytes", "bytes", "{:,}"),
    ("photographs", "photographs", "{}"),
    ("psnr", "PSNR", "{:.2f}"),
    ("ssim", "SSIM", "{:.4f}"),
    ("held_out_psnr", "held out", "{:.2f}"),
    ("between_psnr_luma", "between (luma, at least)", "{:.2f}"),
    ("seconds", "seconds", "{:.0f}"),
    ("error", "error", "{}"),
)


def cells(record: Mapping[str, Any]) -> list[str]:
    """A record's values in the order of `COLUMNS`, for people; empty where there is none."""
    return ["" if record.get(key) is None else form.format(record[key]) for key, _, form in COLUMNS]


def as_markdown(records: Records) -> str:
    """A table in Markdown."""
    rows = [[heading for _, heading, _ in COLUMNS], ["---"] * len(COLUMNS), *map(cells, records)]
    return "".join(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in row)} |\n" for row in rows)


def as_csv(records: Records) -> str:
    """A line of headings, and one for each capture; numbers without commas."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([key for key, _, _ in COLUMNS])
    writer.writerows([record.get(key) for key, _, _ in COLUMNS] for record in records)
    return text.getvalue()


def as_json(records: Records) -> str:
    """All that is known of each capture."""
    return json.dumps({"schema": SCHEMA, "captures": list(records)}, indent=1, allow_nan=False) + "\n"


TABLE_WRITERS: dict[str, Callable[[Records], str]] = {
    "table.md": as_markdown,
    "table.csv": as_csv,
    "table.json": as_json,
}
