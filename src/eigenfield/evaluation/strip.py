"""PSNR of a clip over time as a picture."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from eigenfield.evaluation.plots import (
    PLOT_BLUE,
    PLOT_GREY,
    PLOT_ORANGE,
    new_figure,
    png_bytes,
    refuse_existing_pictures,
    style_axes,
)
from eigenfield.runtime.files import make_folder, write_bytes

STRIP_FILE, CLIP_SHEET_FILE = CLIP_PLOT_FILES = "over-time.png", "contact-sheet.png"
STRIP_KINDS = (("encoded", "encoded", PLOT_BLUE), ("held_out", "held out", PLOT_ORANGE))


def refuse_existing_clip_plots(folder: Path, overwrite: bool) -> None:
    """Check before any work that no plot of a clip would be replaced. OutputError `output-exists`, `not-a-folder` or
    `output-address`."""
    refuse_existing_pictures(folder, CLIP_PLOT_FILES, overwrite)


def write_strip(scores: Mapping[str, Any], folder: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
    """Write the strip chart of `evaluate_clip`'s scores into a folder, which is created if need be; its path.
    OutputError `output-exists`, or the folder cannot be written."""
    folder = Path(folder)
    make_folder(folder)
    write_bytes(folder / STRIP_FILE, png_bytes(strip_figure(scores)), overwrite=overwrite)
    return folder / STRIP_FILE


def strip_figure(scores: Mapping[str, Any]) -> Figure:
    """PSNR over time: the mean over cameras as a line, between the worst and the best camera a band, and a line up
    where a group begins."""
    figure = new_figure(11, 3.6)
    axes = figure.add_subplot()
    for kind, label, colour in STRIP_KINDS:
        frames = [frame for frame in scores["over_time"] if frame[kind] is not None and frame[kind]["psnr"] is not None]
        if not frames:
            continue
        times = [frame["time"] for frame in frames]
        low, mean, high = ([frame[kind][key] for frame in frames] for key in ("psnr_worst", "psnr", "psnr_best"))
        axes.fill_between(times, low, high, color=colour, alpha=0.18, linewidth=0)
        marker = "o" if len(times) <= 40 else None
        average = f"{label}, mean {sum(mean) / len(mean):.2f} dB"
        axes.plot(times, mean, color=colour, marker=marker, markersize=3.5, linewidth=1.6, label=average)
    for time in scores["group_times"][1:]:
        axes.axvline(time, color=PLOT_GREY, linewidth=0.8, linestyle=(0, (4, 3)), zorder=0)
    axes.set_xlabel("seconds; dashed: a group begins" if len(scores["group_times"]) > 1 else "seconds")
    axes.set_ylabel("PSNR in dB, covered pixels")
    axes.set_title("lines are means over cameras, bands reach from the worst to the best", fontsize=10.5, loc="left")
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False)
    style_axes(axes)
    return figure
