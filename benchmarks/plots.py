"""docs/frames.png, made from benchmarks/results: frames per second against the number of eigen textures.

python benchmarks/plots.py
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from measure import latest, runs

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


def newest(name: str, gpu: bool) -> dict[str, Any]:
    """The newest run of results/NAME.json that a GPU drew, or the processor."""
    return next(run for run in reversed(runs(name)) if gpu != bool(re.search("llvmpipe|SwiftShader", run["driver"])))


def main() -> None:
    lines = [
        ("software renderer on two cores, bicubic, 1024x768", "#1f6f8b", "o-",
         series(latest("render")["relief"], lambda row: row["bicubic"]["fps"])),
    ]  # fmt: skip
    for gpu, opengl, chromium in ((True, "NVIDIA H100", "NVIDIA H100"), (False, "Mesa's llvmpipe", "SwiftShader")):
        line = "-" if gpu else ":"
        lines += [
            (f"OpenGL on {opengl}, bicubic, 1920x1080", "#c8553d", f"s{line}",
             series(newest("render-opengl", gpu)["counts"], lambda row: row.get("mono_bicubic", {}).get("fps"))),
            (f"Chromium on {chromium}, bicubic, 1024x768", "#7a5195", f"^{line}",
             series(newest("render-browser", gpu)["counts"], frames)),
        ]  # fmt: skip
    figure = Figure(figsize=(7.6, 3.8), dpi=120, layout="constrained")
    axes = figure.add_subplot()
    for label, colour, style, (counts, values) in lines:
        axes.plot(counts, values, style, color=colour, markersize=5, linewidth=1.8, label=label)
    first, last, rate = PAPER
    axes.plot([first, last], [rate, rate], color="#666666", linestyle="--", linewidth=1.2)
    axes.annotate("the paper, GTX 1080: above this", (first, rate), xytext=(0, -11), textcoords="offset points",
                  fontsize=8, color="#444444")  # fmt: skip
    axes.set(yscale="log", ylim=(0.5, 500))
    axes.set_xlabel("eigen textures")
    axes.set_ylabel("frames per second")
    axes.set_title("A GPU, and two cores without one", fontsize=10, loc="left")
    axes.grid(True, which="both", alpha=0.25)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.legend(fontsize=8, frameon=False)
    figure.savefig(PICTURE)


if __name__ == "__main__":
    main()
