"""How the main figures moved from run to run, as one picture: a point for every run in benchmarks/results.

python benchmarks/history.py [PNG]                (without it benchmarks/results/history.png)
Runs stand over the commit that they measured, commits in the order of their first run. A hollow point is of another
machine than the newest one: its seconds and frames are no comparison.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

import measure

Series = tuple[str, str, str]  # label, name of the result, path of the figure in a run
Run = dict[str, Any]

QUALITY = "cases/all encoded/image/encoded/psnr"
PANELS: dict[tuple[str, str], tuple[Series, ...]] = {
    ("Encoding Tarot, whole, against", "times as long"): (
        ("scikit-learn's PCA", "encode", "ratio/whole_encode_seconds_to_pca_fit"),
        ("SVT-AV1, preset 6", "encode", "ratio/whole_encode_seconds_to_svt_av1"),
    ),
    ("Peak of anonymous memory", "MB"): (
        ("encode, Tarot", "encode", "encode/peak_anonymous_mb"),
        ("encode, Tarot, every second row", "encode", "encode_every_second_row/peak_anonymous_mb"),
        ("Tarot from bare photographs", "proxy-scene-tarot", "peak_anonymous_mb"),
    ),
    ("Encoded photographs, drawn again", "PSNR in dB"): (
        ("tarot", "quality-tarot", QUALITY),
        ("tarot-5x4", "quality-tarot-5x4", QUALITY),
        ("cube", "quality-cube", QUALITY),
        ("demo", "quality-demo", QUALITY),
    ),
    ("Held-out photographs", "PSNR in dB"): (
        ("tarot, mesh given", "quality-tarot", "cases/odd held out/image/held_out/psnr"),
        ("tarot", "proxy-scene-tarot", "held_out/psnr"),
        ("amethyst", "proxy-scene-amethyst", "held_out/psnr"),
        ("boxes", "proxy-scene-boxes", "held_out/psnr"),
        ("fern", "proxy-scene-fern", "held_out/psnr"),
        ("fox", "proxy-scene-fox", "held_out/psnr"),
    ),
    ("Size of the file", "MB"): (
        ("tarot, mesh given", "quality-tarot", "cases/all encoded/bytes/total"),
        ("tarot-5x4, mesh given", "quality-tarot-5x4", "cases/all encoded/bytes/total"),
        ("tarot, bare photographs", "proxy-scene-tarot", "bytes"),
        ("demo", "quality-demo", "cases/all encoded/bytes/total"),
    ),
    ("Drawing 40 eigen textures", "frames per second"): (
        ("software, bicubic", "render", "relief/40/bicubic/fps"),
        ("OpenGL, bicubic", "render-opengl", "counts/40/mono_bicubic/fps"),
        ("browser, bicubic", "render-browser", "counts/40/eye_bicubic/milliseconds"),
    ),
}
SCALES = {"bytes": 1e-6, "total": 1e-6}  # by the last word of a path
COLOURS = ("#1f6f8b", "#c8553d", "#7a5195", "#3d8f5f", "#b38600", "#5b6770")


def value(run: Run, path: str) -> float | None:
    """The number at a path such as encode/seconds, in the unit that is shown; None where a run has none there."""
    found: Any = run
    *_, last = words = path.split("/")
    for word in words:
        found = found.get(word) if isinstance(found, dict) else None
    if not isinstance(found, int | float):
        return None
    return 1e3 / found if last == "milliseconds" else found * SCALES.get(last, 1.0)


def stored() -> dict[str, list[Run]]:
    """All runs by result, of those that PANELS shows and that are there. SystemExit names a damaged file."""
    names = {name for panel in PANELS.values() for _, name, _ in panel}
    return {name: measure.runs(name) for name in sorted(names) if (measure.RESULTS / f"{name}.json").exists()}


def commits(results: dict[str, list[Run]]) -> list[str]:
    """Every commit that was measured, in the order of its first run."""
    every = sorted((run for runs in results.values() for run in runs), key=lambda run: str(run["date"]))
    return list(dict.fromkeys(str(run["commit"]) for run in every))


def figure(results: dict[str, list[Run]]) -> Figure:
    """The panels of PANELS over the commits of these results."""
    order = commits(results)
    newest = max((runs[-1] for runs in results.values()), key=lambda run: str(run["date"]))
    drawn = Figure(figsize=(11, 3.1 * ((len(PANELS) + 1) // 2)), dpi=120, layout="constrained")
    panels = drawn.subplots((len(PANELS) + 1) // 2, 2, squeeze=False).ravel()
    for axes, ((title, unit), lines) in zip(panels, PANELS.items(), strict=False):
        for colour, (label, name, path) in zip(COLOURS, lines, strict=False):
            points = [(run, found) for run in results.get(name, []) if (found := value(run, path)) is not None]
            if points:
                line(axes, points, order, newest["machine"], f"{label}: {shown(points[-1][1])}", colour)
        axes.set_title(title, fontsize=10, loc="left")
        axes.set_ylabel(unit, fontsize=9)
        dress(axes, order)
    for axes in panels[len(PANELS) :]:
        axes.set_axis_off()
    return drawn


def shown(number: float) -> str:
    return f"{number:,.0f}" if number >= 100 else f"{number:.3g}"


def line(axes: Axes, points: list[tuple[Run, float]], order: list[str], machine: Any, label: str, colour: str) -> None:
    """One figure's runs, joined; hollow points where the machine was another."""
    places = [order.index(str(run["commit"])) for run, _ in points]
    values = [found for _, found in points]
    axes.plot(places, values, color=colour, linewidth=1.6, label=label)
    same = [run["machine"] == machine for run, _ in points]
    fills = [colour if one else "white" for one in same]
    axes.scatter(places, values, s=28, c=fills, edgecolors=colour, zorder=3)


def dress(axes: Axes, order: list[str]) -> None:
    """Axis, grid and legend of a panel; not every commit is named where there are many."""
    axes.set_xlim(-0.5, len(order) - 0.5)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=14, integer=True))
    axes.xaxis.set_major_formatter(lambda place, _: order[int(place)] if 0 <= place < len(order) else "")
    axes.tick_params("x", rotation=45, labelsize=7)
    axes.tick_params("y", labelsize=8)
    if axes.get_ylabel() == "frames per second":
        axes.set_yscale("log")
    elif axes.get_ylabel() != "PSNR in dB":
        axes.set_ylim(bottom=0)
    axes.grid(True, alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=7, frameon=False, loc="center left", bbox_to_anchor=(1, 0.5))


def main() -> None:
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else measure.RESULTS / "history.png"
    results = stored()
    if not results:
        raise SystemExit(f"no results in {measure.RESULTS}: run a benchmark first")
    figure(results).savefig(path, format="png")
    print(f"wrote {path}")


if __name__ == "__main__":
    main()
