"""The page of a batch: a contact sheet of its scenes.

It needs no server and nothing else than what lies beside it: posters, and the pages of the scenes.
"""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

TEMPLATES = Path(__file__).parent / "templates"


def sheet_html(title: str, records: Sequence[Mapping[str, Any]], missing: int = 0) -> str:
    """The page.

    Args:
        missing: How many captures are neither finished nor have failed.
    """
    finished = [record for record in records if "error" not in record]
    cards = "".join(map(_card, finished))
    failed = [f"<li><b>{_text(one['name'])}</b> {_text(one['error'])}</li>" for one in records if "error" in one]
    failures = f'<h2>Failed</h2><ul class="failed">{"".join(failed)}</ul>' if failed else ""
    left = f" {_counted(missing, 'scene')} to come: the same command goes on." if missing else ""
    style = (TEMPLATES / "sheet.css").read_text(encoding="utf-8")
    size = sum(record["bytes"] for record in finished)
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{_text(title)}</title>
<link rel="icon" href="data:,">
<style>
{style}</style>
</head>
<body>
<header><h1>{_text(title)}</h1><p>{_counted(len(finished), "scene")}, {_size(size)}.{left}
All figures: <a href="table.csv">CSV</a>, <a href="table.json">JSON</a>, <a href="table.md">Markdown</a>.</p></header>
<main><ul class="sheet">{cards}</ul>{failures}</main>
</body>
</html>
"""


def _card(record: Mapping[str, Any]) -> str:
    figures = [_size(record["bytes"])]
    if record["psnr"] is not None:
        figures.append(f"{record['psnr']:.1f} dB")
    if record["held_out_psnr"] is not None:
        figures.append(f"held out {record['held_out_psnr']:.1f} dB")
    if record["between_psnr_luma"] is not None:
        figures.append(f"views between at least {record['between_psnr_luma']:.1f} dB of luma")
    elif record.get("between_psnr") is not None:  # a finished one of an earlier version has none
        figures.append(f"views between about {record['between_psnr']:.1f} dB")
    name = _text(record["name"])
    lines = "<br>".join(map(_text, record["warnings"]))
    warned = f"<details><summary>Warnings</summary>{lines}</details>" if lines else ""
    return (
        f'<li><a href="{_address(record, "page")}"><img loading="lazy" src="{_address(record, "poster")}" alt="">'
        f"<b>{name}</b></a><p>{', '.join(figures)}"
        f'<a href="{_address(record, "scene")}" download aria-label="{name}.glb">.glb</a></p>{warned}</li>'
    )


def _address(record: Mapping[str, Any], key: str) -> str:
    return quote(f"{record['folder']}/{record[key]}")


def _counted(count: int, word: str) -> str:
    return f"{count} {word}{'' if count == 1 else 's'}"


def _size(count: float) -> str:
    return f"{count / 1e6:.1f} MB" if count >= 1e6 else f"{count / 1e3:.0f} kB"


def _text(value: object) -> str:
    return html.escape(str(value))
