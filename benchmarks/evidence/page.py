"""The report as Markdown: the tables of docs/benchmarks.md, then each capture with its charts and pictures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from evidence.paper import TARGET
from tables import Captures, decimals, evaluation, table

Figures = Mapping[str, Any]
Line = tuple[str, Sequence[Figures], str]  # label, points, key of what is drawn upwards

PAIRED = {"psnr": "RGB PSNR, dB", "psnr_luma": "luma PSNR, dB", "ssim": "SSIM"}
FIGURE_6 = {
    "photograph": "photograph", "proxy": "proxy", "own_map": "its own texture map", "eigen": "eigen textures",
    "error": "error × 5",
}  # fmt: skip


def write(results: Figures, kept: Captures, folder: Path) -> Path:
    """FOLDER/report.md, and its charts in FOLDER/pictures.

    Args:
        results: What results.json holds.
        kept: Its main figures, as `tables.evaluation` takes them.
        folder: Where the paths of pictures begin.
    """
    (folder / "pictures").mkdir(parents=True, exist_ok=True)
    captures: dict[str, Figures] = results["captures"]
    parts = [_head(results), evaluation(kept), *(_capture(name, one, folder) for name, one in captures.items())]
    path = folder / "report.md"
    path.write_text("\n".join(parts), encoding="utf-8")
    return path


def _head(results: Figures) -> str:
    machine, quoted = results["machine"], results["paper"]
    left_out = "".join(f"- Left out: {words}\n" for words in results["left_out"])
    return (
        f"# The evaluation{' (a quick run)' * results['quick']}\n\n`{results['command']}`, commit {results['commit']},"
        f" {machine['processor']} with {machine['cores']} cores, {results['started']},"
        f" {results.get('seconds', 0):.0f} s. All figures are in `results.json`; `docs/measures.md` defines them.\n\n"
        f"{left_out}\n{quoted['note']}\n"
    )


def _capture(name: str, record: Figures, folder: Path) -> str:
    """What was measured on one capture, and which step failed."""
    steps = {"geometry": record["geometry"], **record["steps"]}
    errors = {key: one["error"] for key, one in steps.items() if "error" in one}
    figures = {key: one["figures"] for key, one in steps.items() if "figures" in one}
    licence = record["licence"] or "your own"
    parts = [f"## {record['title']}\n\n{record['note']}\n\nLicence and source: {licence}.\n"]
    parts += [f"- The step `{key}` ended with an error: {words}\n" for key, words in errors.items()]
    for key, draw in (("paper", _paper), ("rates", _rates), ("between", _between)):
        if key in figures:
            parts += draw(name, figures[key], folder)
    return "\n".join(parts)


def _paper(name: str, figures: Figures, folder: Path) -> Iterator[str]:
    """Figures 5 and 6 of the paper."""
    ways = [way for way in ("plain", "aligned") if way in figures["curve"][0]]
    lines = [(way, [{"textures": one["textures"], **one[way]} for one in figures["curve"]], "uv_ssim") for way in ways]
    yield "### The paper's curves and pictures\n"
    yield _chart(f"{name}-uv", lines, ("textures", "eigen textures"), "SSIM of texture maps", folder, level=TARGET)
    for row in figures["figure6"]:
        shown = [(row[key], words) for key, words in FIGURE_6.items()]
        yield f"Camera `{row['camera']}`; with eigen textures {decimals(row['psnr_eigen'])} dB.\n\n{_pictures(shown)}"


def _rates(name: str, figures: Figures, folder: Path) -> Iterator[str]:
    """The capture's photographs in other codecs."""
    yield "### Bytes against quality\n"
    for key, words in PAIRED.items():
        lines = [(curve["name"], curve["points"], key) for curve in figures["curves"]]
        yield _chart(f"{name}-{key}", lines, ("bytes", "bytes of all views"), words, folder, log=True)
    head = ["", "setting", "bytes", *PAIRED.values(), "encode s"]
    yield table(head, [_point(curve, point) for curve in figures["curves"] for point in curve["points"]])
    yield _pictures([(crop["picture"], crop["label"]) for crop in figures["crops"]])
    yield "".join(f"- {words}\n" for words in figures["left_out"])


def _point(curve: Figures, point: Figures) -> list[str]:
    return [
        curve["name"], str(point.get("parameter", "")), str(point["bytes"]), decimals(point["psnr"]),
        decimals(point["psnr_luma"]), decimals(point["ssim"], 4), decimals(point.get("encode_seconds"), 1),
    ]  # fmt: skip


def _between(name: str, figures: Figures, folder: Path) -> Iterator[str]:
    """Held-out views drawn in several ways."""
    yield f"### Between the cameras: {figures['cameras']} held-out views, `{figures['rule']}`\n\n{figures['words']}\n"
    head = ["what is drawn", *PAIRED.values(), "FLIP", "worst view, dB", "s a picture"]
    rows = [
        [
            one["title"], decimals(one["psnr"]), decimals(one["psnr_luma"]), decimals(one["ssim"], 4),
            decimals(one["flip"], 4), decimals(one["worst"]["psnr"]["value"]), decimals(one["seconds"], 3),
        ]
        for one in figures["methods"]
    ]  # fmt: skip
    yield table(head, rows)
    yield _pictures([(one["picture"], one["label"]) for one in figures["pictures"]])


def _pictures(shown: Sequence[tuple[str, str]]) -> str:
    """Pictures beside each other, their words above them."""
    return table([words for _, words in shown], [[f"![{words}]({path})" for path, words in shown]]) if shown else ""


def _chart(
    name: str,
    lines: Sequence[Line],
    across: tuple[str, str],
    upwards: str,
    folder: Path,
    log: bool = False,
    level: float | None = None,
) -> str:
    """A chart as a PNG, and the Markdown that shows it. Points without a figure are left out.

    Args:
        name: Of the file.
        lines: What is drawn.
        across: The key of what is drawn to the right, and what it is called.
        upwards: What the other axis is called.
        folder: Of the report.
        log: Whether bytes are on a logarithmic axis.
        level: A horizontal line to compare with.
    """
    figure = Figure(figsize=(6.4, 3.6), dpi=120, layout="constrained")
    axes = figure.add_subplot()
    for label, points, key in lines:
        known = sorted((one[across[0]], one[key]) for one in points if one.get(key) is not None)
        axes.plot([x for x, _ in known], [y for _, y in known], "o-", markersize=4, label=label)
    if level is not None:
        axes.axhline(level, color="#666666", linestyle="--", linewidth=1)
    axes.set(xlabel=across[1], ylabel=upwards, xscale="log" if log else "linear")
    axes.grid(True, alpha=0.25)
    axes.legend(fontsize=7, frameon=False)
    path = folder / "pictures" / f"{name}.png"
    figure.savefig(path)
    return f"![{upwards}](pictures/{path.name})\n"
