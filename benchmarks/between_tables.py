"""Views between the cameras, for docs/benchmarks.md, made from benchmarks/results/between.json
(benchmarks/between.py)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from evaluation_tables import NONE, newest, origin, table
from evidence.between import TITLES
from measure import RESULTS, runs


def section() -> str:
    """The section; nothing before anything was measured."""
    if not (RESULTS / "between.json").exists():
        return ""
    captures, shown = newest(runs("between"))
    parts = _parts()
    head = ["capture", "what is drawn", "kB", "RGB / luma dB", "worst view", "SSIM", "FLIP", "error near depth edges"]
    rows = [_row(name, number, row) for name, one in captures.items() for number, row in enumerate(one["methods"])]
    return (
        "## Views between the cameras, at equal bytes\n\nHeld-out views, measured over the pixels that our mesh covers."
        " The codec's film holds the encoded views; it is decoded and blended as a lumigraph on our mesh, and its bytes"
        " include the mesh. Where our file has soft sheets, this mesh is the opaque surface of the same capture"
        " (`--layers 1`), also for coverage and depth edges. The last three ways of a capture need all photographs. The"
        " worst view is the lowest of each figure. The last column is the share of luma's squared error within two"
        " pixels of depth edges.\n\n"
        f"{_captures(captures)}\n{table(head, rows)}\n{origin(shown, '../benchmarks/results/between.json')}\n{parts}"
    )


def _parts() -> str:
    """What each part of soft sheets is worth (benchmarks/layers.py)."""
    if not (RESULTS / "layers.json").exists():
        return ""
    captures, shown = newest(runs("layers"))
    words = {key: part["words"] for one in captures.values() for key, part in one["parts"].items()}
    rows = [
        [words[key], *(f"{one['parts'][key]['held_out']:.2f} / {one['parts'][key]['captured']:.2f}"
                       for one in captures.values())]
        for key in words
    ]  # fmt: skip
    head = ["sheets", *(f"`{name}`, {one['views']} views" for name, one in captures.items())]
    return (
        "\n### What each part of soft sheets is worth\n\nPSNR in RGB of every fourth view, which took no part, and"
        " of the others. Photographs are halved to at most 300 pixels. Nothing is coded, and nothing depends on the"
        " view.\n\n"
        f"{table(head, rows)}\n{origin(shown, '../benchmarks/results/layers.json')}\n"
    )


def _captures(captures: Mapping[str, Any]) -> str:
    rows = [
        [f"`{name}`", f"`{one['rule']}`", str(one["cameras"]), str(one["encoded"]), str(one.get("sheets", 0) or NONE),
         f"{one['mesh'] / 1e3:.1f}",
         f"{100 * one['methods'][0]['coverage']:.1f} %", f"{100 * one['methods'][0]['edge_pixels']:.0f} %"]
        for name, one in captures.items()
    ]  # fmt: skip
    head = [
        "capture", "held out", "held-out views", "encoded views", "our soft sheets", "mesh kB", "coverage",
        "pixels near depth edges",
    ]  # fmt: skip
    return table(head, rows)


def _row(name: str, number: int, row: Mapping[str, Any]) -> list[str]:
    size = f"{row['bytes'] / 1e3:.1f}" if "bytes" in row else NONE
    return [
        "" if number else f"`{name}`", TITLES[row["key"]], size, _both(row), _both(row["worst"]), f"{row['ssim']:.4f}",
        f"{row['flip']:.4f}", f"{100 * row['edge_share']:.0f} %",
    ]  # fmt: skip


def _both(scores: Mapping[str, Any]) -> str:
    return f"{scores['psnr']:.2f} / {scores['psnr_luma']:.2f}"
