"""The scores as plots, drawn on matplotlib's Agg canvas without pyplot, so that no global state is touched."""

from __future__ import annotations

import io
import os
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from eigenfield.capture import LightField
from eigenfield.core.errors import OutputError
from eigenfield.core.scene import Scene
from eigenfield.evaluation.session import Session, start_session
from eigenfield.imaging.metrics import PictureArray, to_codes
from eigenfield.runtime.files import make_folder, write_bytes
from eigenfield.runtime.objects import refuse_objects

ContactSheetRow = tuple[str, PictureArray, PictureArray, PictureArray]  # title, photograph, drawn, error

PLOT_CURVE_FILE, PLOT_BYTES_FILE, PLOT_CAMERAS_FILE, PLOT_CONTACT_SHEET_FILE = PLOT_FILES = (
    "uv-curve.png", "bytes.png", "cameras.png", "contact-sheet.png",
)  # fmt: skip
PLOT_DPI = 150
PLOT_BLUE, PLOT_ORANGE, PLOT_GREY = "#2f6db3", "#d9822b", "#5f6670"
PLOT_PARTS = (  # of a file: key, label, colour
    ("textures", "eigen textures", "#2f6db3"),
    ("mean", "mean texture", "#5fa8a0"),
    ("mesh", "mesh", "#d9822b"),
    ("weights", "weights", "#b5485d"),
    ("other", "other", "#9aa1a9"),
)
PLOT_MAX_NAME_CHARACTERS = 32  # longer names lose their beginning
PLOT_ERROR_GAIN = 5  # of the errors in the contact sheet


def refuse_existing_plots(folder: Path, overwrite: bool) -> None:
    """Check before any work that no plot would be replaced. OutputError as `refuse_existing_pictures`."""
    refuse_existing_pictures(folder, PLOT_FILES, overwrite)


def refuse_existing_pictures(folder: Path, names: Sequence[str], overwrite: bool) -> None:
    """OutputError `output-exists`, `not-a-folder` or `output-address` where pictures cannot go into a folder."""
    refuse_objects(folder)
    if folder.exists() and not folder.is_dir():
        raise OutputError("not-a-folder", "is a file", path=folder, remedy="name a folder for --plots")
    for name in names:
        if (folder / name).exists() and not overwrite:
            raise OutputError(
                "output-exists", "exists already", path=folder / name, remedy="use --overwrite or another folder"
            )


def write_plots(
    scores: Mapping[str, Any],
    scene: Scene,
    capture: LightField,
    folder: str | os.PathLike[str],
    *,
    overwrite: bool = False,
) -> list[Path]:
    """Write the plots of `evaluate`'s scores into a folder, which is created if need be; their paths. OutputError
    `output-exists`, or the folder cannot be written."""
    folder = Path(folder)
    session = start_session(
        scene, capture, textures=scores["textures"], filter=scores["filter"], weights=scores["weights"]
    )
    refuse_existing_plots(folder, overwrite)
    make_folder(folder)
    figures = {}
    if scores.get("curve") and scores["uv"] is not None:
        figures[PLOT_CURVE_FILE] = curve_figure(scores)
    if scores.get("bytes") is not None:
        figures[PLOT_BYTES_FILE] = bytes_figure(scores["bytes"], scores.get("ratio"))
    figures[PLOT_CAMERAS_FILE] = cameras_figure(scores["cameras"], _coordinates(scores["cameras"], session))
    figures[PLOT_CONTACT_SHEET_FILE] = contact_sheet_figure(_contact_sheet_rows(scores["cameras"], session))
    for name, figure in figures.items():
        write_bytes(folder / name, png_bytes(figure), overwrite=overwrite)
    return [folder / name for name in figures]


def curve_figure(scores: Mapping[str, Any]) -> Figure:
    """SSIM and PSNR in UV space against the number of eigen textures (figure 5 of the paper)."""
    points = scores["curve"]
    count = [point["textures"] for point in points]
    figure = new_figure(9, 4.2)
    for at, (key, label, colour) in enumerate(
        (("uv_ssim", "SSIM {:.4f}", PLOT_BLUE), ("uv_psnr", "PSNR {:.2f} dB", PLOT_ORANGE)), 1
    ):
        axes = figure.add_subplot(1, 2, at)
        values = [point[key] for point in points]
        axes.plot(count, values, color=colour, marker="o" if len(count) <= 40 else None, markersize=4, linewidth=1.8)
        axes.set_xlabel("eigen textures")
        axes.set_title(f"{label.format(values[-1])} with all {count[-1]}", fontsize=11, loc="left")
        axes.set_ylabel(f"{label.split()[0]} of the texture maps, mean over {points[-1]['cameras']} cameras")
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        style_axes(axes)
    return figure


def cameras_figure(cameras: Sequence[Mapping[str, Any]], coordinates: NDArray[np.float64]) -> Figure:
    """PSNR of each re-drawn photograph at its camera's position (n, 2) on the view plane."""
    measured = [camera for camera in cameras if camera["psnr"] is not None]
    places = coordinates[[camera["psnr"] is not None for camera in cameras]]
    values = np.array([camera["psnr"] for camera in measured])
    held_out = np.array([camera["held_out"] for camera in measured], bool)
    figure = new_figure(7.6, 6.4)
    axes = figure.add_subplot()
    size = float(np.clip(26000 / max(len(measured), 1), 14, 260))
    drawn = None
    for here, marker, edge, width, label in (
        (~held_out, "o", "none", 0.0, "encoded"),
        (held_out, "s", "#202428", 0.9, "held out"),
    ):
        if here.any():
            drawn = axes.scatter(
                places[here, 0],
                places[here, 1],
                c=values[here],
                s=size,
                marker=marker,
                cmap="viridis",
                vmin=values.min(),
                vmax=values.max(),
                edgecolors=edge,
                linewidths=width,
                label=f"{label}, mean {values[here].mean():.2f} dB",
            )
    if drawn is not None:
        figure.colorbar(drawn, ax=axes, label="PSNR in dB, covered pixels", shrink=0.85)
        worst = int(values.argmin())
        x, y = places[worst]
        axes.scatter(x, y, s=2.6 * size, marker="o", facecolors="none", edgecolors="#c2352b", linewidths=1.8)
        text = f"worst, ringed: {_shorten(measured[worst]['name'])}, {values[worst]:.2f} dB"
        axes.annotate(
            text, (1, -0.11), xycoords="axes fraction", ha="right", va="top", color="#c2352b", parse_math=False
        )
        legend = axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
        for handle in legend.legend_handles:
            if isinstance(handle, PathCollection):  # otherwise it has the colour of one camera
                handle.set_array(None)
                handle.set_facecolor("#9aa1a9")
    axes.set_xlabel("X on the view plane (right)")
    axes.set_ylabel("Y on the view plane (up)")
    axes.margins(0.08)
    axes.set_aspect("equal" if np.ptp(coordinates[:, 1]) > 0 else "auto")
    style_axes(axes)
    return figure


def bytes_figure(sizes: Mapping[str, int], ratio: Mapping[str, float | None] | None) -> Figure:
    """The file's bytes by part."""
    figure = new_figure(8.2, 3.6)
    axes = figure.add_subplot()
    keys, labels, colours = zip(*PLOT_PARTS, strict=True)
    kilobytes = np.array([sizes[key] for key in keys]) / 1e3
    shares = kilobytes / max(sizes["total"], 1) * 1e5
    bars = axes.barh(labels, kilobytes, color=colours)
    axes.invert_yaxis()
    texts = [f"{size:,.1f} kB, {share:.1f} %" for size, share in zip(kilobytes, shares, strict=True)]
    axes.bar_label(bars, texts, padding=5, color=PLOT_GREY)
    axes.set_xlim(0, 1.28 * kilobytes.max() or 1)
    axes.set_xlabel("kB (1000 bytes)")
    known = {"photographs": "photographs", "texture_maps_png": "texture maps as PNG", "raw": "raw pixels"}
    times = [(ratio[key], label) for key, label in known.items()] if ratio else []
    text = [f"{label} {value:.{1 if value < 20 else 0}f}" for value, label in times if value is not None]
    smaller = f"\ntimes smaller than: {', '.join(text)}" if text else ""
    axes.set_title(f"{sizes['total'] / 1e6:.2f} MB{smaller}", fontsize=10.5, loc="left")
    style_axes(axes)
    axes.grid(False, axis="y")
    return figure


def contact_sheet_figure(rows: Sequence[ContactSheetRow]) -> Figure:
    """Photograph, drawn picture and error side by side; a title for each row."""
    height, width = rows[0][1].shape[:2] if rows else (1, 1)
    inches = 3.6
    figure = new_figure(3 * inches + 0.3, len(rows) * (inches * height / width + 0.45) + 0.2)
    axes = figure.subplots(len(rows), 3, squeeze=False) if rows else np.empty((0, 3))
    for line, (title, *pictures) in zip(axes, rows, strict=True):
        for place, picture, label in zip(
            line, pictures, ("photograph", "drawn", f"error × {PLOT_ERROR_GAIN}"), strict=True
        ):
            place.imshow(to_codes(np.asarray(picture)), interpolation="antialiased")
            place.set_axis_off()
            place.set_title(
                f"{title}\n{label}" if place is line[0] else f"\n{label}", fontsize=10, loc="left", parse_math=False
            )
    return figure


def _contact_sheet_rows(cameras: Sequence[Mapping[str, Any]], session: Session) -> list[ContactSheetRow]:
    """The cameras with the highest, the median and the lowest PSNR, drawn again."""
    order = sorted((camera for camera in cameras if camera["psnr"] is not None), key=lambda camera: -camera["psnr"])
    chosen = {"best": 0, "median": len(order) // 2, "worst": len(order) - 1} if order else {}
    rows = []
    for kind, at in chosen.items():
        camera = order[at]
        index = session.scene.rig.names.index(camera["name"])
        photograph = session.photograph(index).pixels
        drawn = session.picture(index)
        error = np.abs(drawn.image - photograph) * PLOT_ERROR_GAIN * drawn.covered[..., None]
        held_out = ", held out" if camera["held_out"] else ""
        about = f"{kind}{held_out} {camera['psnr']:.2f} dB, {_shorten(camera['name'])}"
        rows.append((about, photograph, drawn.image, error.astype(np.float32)))
    return rows


def _coordinates(cameras: Sequence[Mapping[str, Any]], session: Session) -> NDArray[np.float64]:
    scene = session.scene
    centre = {name: camera.centre for name, camera in zip(scene.rig.names, scene.rig.cameras, strict=True)}
    return scene.rig.view_plane.coordinates([centre[camera["name"]] for camera in cameras])


def new_figure(width: float, height: float) -> Figure:
    figure = Figure(figsize=(width, height), dpi=PLOT_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def style_axes(axes: Axes) -> None:
    """No frame at the top and right, and a pale grid behind."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(True, color="#e4e7ea", linewidth=0.8)
    axes.set_axisbelow(True)


def _shorten(name: str) -> str:
    return name if len(name) <= PLOT_MAX_NAME_CHARACTERS else f"…{name[1 - PLOT_MAX_NAME_CHARACTERS :]}"


def png_bytes(figure: Figure) -> bytes:
    data = io.BytesIO()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing")  # names in scripts that the font lacks
        figure.savefig(data, format="png", metadata={"Software": None})
    return data.getvalue()
