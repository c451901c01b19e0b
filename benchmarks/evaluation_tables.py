"""The tables of docs/benchmarks.md about the paper's way, made from benchmarks/results/report.json."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from measure import runs

Captures = dict[str, dict[str, Any]]

ANCHORS = ("SVT-AV1 preset 2, 4:2:0", "SVT-AV1 preset 6, 4:2:0", "libaom cpu 6, 4:4:4", "AVIF a view, 4:4:4")
WAYS = {
    "nearest": "nearest photograph",
    "blend": "blended photographs",
    "lumigraph": "lumigraph",
    "delaunay": "eigenfield",
}
RUNGS = ("codec", "quantisation", "truncation", "resampling")
NONE = "–"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def decimals(value: Any, places: int = 2, unit: str = "") -> str:
    """A figure in words; a dash where there is none."""
    return NONE if value is None else f"{value:.{places}f}{unit}"


def summary(captures: Captures) -> str:
    """What every capture's file weighs and shows."""
    rows = []
    for name, one in captures.items():
        if "encoded" not in one:
            continue
        encoded, held = one["encoded"], one["held_out"] or {}
        rows.append([
            f"`{name}`", str(one["views"]), str(one["textures"]), decimals(one["bytes"]["total"] / 1e6),
            f"{decimals(encoded['psnr'])} / {decimals(encoded['psnr_luma'])}", decimals(encoded["ssim"], 3),
            decimals(encoded.get("flip"), 3), f"{decimals(held.get('psnr'))} / {decimals(held.get('psnr_luma'))}",
            decimals(held.get("ssim"), 3), decimals(100 * encoded["coverage"], 1, unit=" %"),
        ])  # fmt: skip
    head = ["capture", "views", "N", "MB", "encoded dB, RGB / luma", "SSIM", "FLIP", "held out dB, RGB / luma", "SSIM",
            "coverage"]  # fmt: skip
    return table(head, rows)


def rates(captures: Captures) -> str:
    """Bytes of ours relative to each anchor, at equal RGB and luma PSNR; where no quality is shared, a dash."""
    rows = []
    for name, one in captures.items():
        if "bd" not in one:
            continue
        cells = [one["bd"].get(anchor, {}) for anchor in ANCHORS]
        rows.append([f"`{name}`", *(f"{percent(c.get('psnr'))} / {percent(c.get('psnr_luma'))}" for c in cells)])
    return table(["capture", *ANCHORS], rows)


def percent(value: float | None) -> str:
    return NONE if value is None else f"{value:+.0f} %"


def losses(captures: Captures) -> str:
    """The ladder: what each loss costs in dB when those before it are switched off already."""
    rows = []
    for name, one in captures.items():
        if "losses" not in one:
            continue
        rungs = {row["key"]: row for row in one["losses"]}
        gains = [
            f"{decimals(rungs[k]['gain'])} ({100 * rungs[k]['share']:.0f} %)" if k in rungs else NONE for k in RUNGS
        ]
        rows.append([f"`{name}`", decimals(rungs["file"]["psnr"]), *gains, f"{100 * rungs['left']['share']:.0f} %"])
    head = ["capture", "file dB", "codec", "8-bit codes", "truncation to N", "resampling", "what stays"]
    return table(head, rows)


def between(captures: Captures) -> str:
    """Held-out views drawn in each way, dB over the pixels that the proxy covers."""
    rows = [
        [f"`{name}`", str(one["hold_out"]), *(decimals(one["between"].get(way, {}).get("psnr")) for way in WAYS)]
        for name, one in captures.items()
        if "between" in one
    ]
    return table(["capture", "held out", *WAYS.values()], rows)


def paper(captures: Captures) -> str:
    """The paper's measure and its way to count bytes."""
    rows = [["the paper, 289 views", "", "0.98 (aligned)", "", "15", "9.5-14.8 MB, 96-97 %", ""]]
    for name, one in captures.items():
        if "table" not in one:
            continue
        stored = {(row["label"], row["aligned"]): row for row in one["table"]["rows"]}
        curve = one["uv_curve"]
        most = max(map(int, curve["plain"]))
        at = "15" if "15" in curve["plain"] else str(most)
        needed = [_needed(stored.get(("SSIM 0.98", aligned))) for aligned in (False, True)]
        counted = stored.get(("N = 15", False)) or stored.get(("N = 7", False)) or {}
        rows.append([
            f"`{name}`", at, f"{decimals(curve['plain'].get(at), 3)} / {decimals(curve['aligned'].get(at), 3)}",
            *needed, f"{counted['bytes'] / 1e6:.1f} MB, {100 * counted['saving']:.1f} %" if counted else NONE,
            f"{counted['file_bytes'] / 1e6:.2f} MB, {100 * counted['file_saving']:.1f} %" if counted else NONE,
        ])  # fmt: skip
    head = [
        "capture",
        "N",
        "UV SSIM plain / aligned",
        "N for 0.98, plain",
        "aligned",
        "as the paper counts",
        "our file",
    ]
    return table(head, rows)


def _needed(row: dict[str, Any] | None) -> str:
    if row is None:
        return NONE
    return f"> {row['most']}" if row.get("not_reached") else str(row["textures"])


def largest(captures: Captures) -> str:
    """The losses by their median over captures, the three largest first, in words."""
    gap = [
        one["encoded_beside_held_out"]["psnr"] - one["held_out"]["psnr"]
        for one in captures.values()
        if one.get("held_out") and one.get("encoded_beside_held_out")
    ]
    found = {"from encoded to held-out cameras": gap}
    titles = {
        "codec": "the codec of the textures",
        "truncation": "truncation to N textures (it includes what wrong geometry and gloss add to the maps)",
        "resampling": "resampling into the atlas and out of it",
    }
    for key, title in titles.items():
        rows = [row for one in captures.values() for row in one.get("losses", ()) if row["key"] == key]
        found[title] = [row["gain"] for row in rows]
    known = {title: values for title, values in found.items() if values}
    order = sorted(known, key=lambda title: -float(np.median(known[title])))
    lines = [
        f"{number}. **{title}**: {np.median(known[title]):.1f} dB in the median of {len(known[title])} captures"
        f" ({min(known[title]):.1f} to {max(known[title]):.1f})"
        for number, title in enumerate(order, 1)
    ]
    return "\n".join(lines) + "\n"


def truth(captures: Captures) -> str:
    found = captures.get("demo", {}).get("truth")
    if not found:
        return ""
    cost = {kind: found[kind]["cost"] for kind in ("encoded", "held_out")}
    return (
        "\nThe demo's true geometry is known. With cameras and mesh estimated from its photographs (every second row"
        f" and column), encoded views lose {_cost(cost['encoded'])} dB and held-out views {_cost(cost['held_out'])} dB"
        " against the true ones.\n"
    )


def _cost(value: Any) -> str:
    return decimals(value["psnr"] if isinstance(value, dict) else value)


def newest(history: Sequence[Mapping[str, Any]]) -> tuple[Captures, list[Mapping[str, Any]]]:
    """Each capture as the newest run that has it measured it, in the order in which they came first; and the runs that
    are shown so, the oldest first."""
    last = {name: number for number, run in enumerate(history) for name in run["captures"]}
    captures = {name: history[number]["captures"][name] for name, number in last.items()}
    return captures, [history[number] for number in sorted(set(last.values()))]


def origin(shown: Sequence[Mapping[str, Any]], link: str) -> str:
    lines = []
    for run in shown:
        machine, commits = run["machine"], run.get("commits") or [run["commit"]]
        lines.append(
            f"[`{run['command']}`]({link}), commit {', '.join(commits)}, {machine['processor']},"
            f" {machine['cores']} cores, {run['date'][:10]}"
        )
    return ";\n".join(lines) + ".\n"


SECTIONS: tuple[tuple[str, Callable[[Captures], str]], ...] = (
    ("Every capture (15 textures, density 1.5)", summary),
    ("The paper's measure and its way to count bytes", paper),
    ("Where the decibels go", losses),
    ("Bytes relative to codecs at equal PSNR, RGB / luma (+: our file is larger)", rates),
    ("Views that were held out, dB", between),
)


def page() -> str:
    """The tables of the whole evaluation (benchmarks/report.py)."""
    captures, shown = newest(runs("report"))
    parts = [f"### {title}\n\n{of(captures)}\n" for title, of in SECTIONS]
    parts.insert(3, f"The losses, the largest first:\n\n{largest(captures)}{truth(captures)}\n")
    return "".join(parts) + origin(shown, "../benchmarks/results/report.json")
