"""docs/frames.png, made from benchmarks/results: frames per second against the number of eigen textures.

python benchmarks/plots.py
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from measure import latest

PICTURE = Path(__file__).parents[1] / "docs" / "frames.png"
PAPER = (1, 40, 60)  # "over 60 fps up to 40" on a GTX 1080


def series(counts: dict[str, Any], fps: Any) -> tuple[list[int], list[float]]:
    """Numbers of textures and frames per second where they were measured."""
    found = [(int(count), fps(row)) for count, row in counts.items()]
    known = [(count, value) for count, value in found if value is not None and count > 0]
    return [count for count, _ in known], [value for _, value in known]


def frames(row: dict[str, Any]) -> float | None:
    """Of the browser's figures, which has not measured all numbers of textures."""
    return 1e3 / row["eye_bicubic"]["milliseconds"] if "eye_bicubic" in row else None


def main() -> None:
    software, opengl, browser = latest("render"), latest("render-opengl"), latest("render-browser")
    lines = [
        ("software renderer, bicubic, 1024x768", "#1f6f8b", "o",
         series(software["relief"], lambda row: row["bicubic"]["fps"])),
        ("OpenGL on Mesa's llvmpipe, bicubic, 1920x1080", "#c8553d", "s",
         series(opengl["counts"], lambda row: row.get("mono_bicubic", {}).get("fps"))),
        ("Chromium on SwiftShader, bicubic, 1024x768", "#7a5195", "^",
         series(browser["counts"], frames)),
    ]  # fmt: skip
    figure = Figure(figsize=(7.6, 3.8), dpi=120, layout="constrained")
    axes = figure.add_subplot()
    for label, colour, marker, (counts, values) in lines:
        axes.plot(counts, values, color=colour, marker=marker, markersize=5, linewidth=1.8, label=label)
    first, last, rate = PAPER
    axes.plot([first, last], [rate, rate], color="#666666", linestyle="--", linewidth=1.2)
    axes.annotate("the paper, GTX 1080: above this", (first, rate), xytext=(0, 5), textcoords="offset points",
                  fontsize=8, color="#444444")  # fmt: skip
    axes.set(yscale="log", ylim=(0.5, 150))
    axes.set_xlabel("eigen textures")
    axes.set_ylabel("frames per second")
    axes.set_title("Two cores, no GPU", fontsize=10, loc="left")
    axes.grid(True, which="both", alpha=0.25)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.legend(fontsize=8, frameon=False)
    figure.savefig(PICTURE)


if __name__ == "__main__":
    main()
