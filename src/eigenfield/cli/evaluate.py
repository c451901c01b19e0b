"""`eigenfield evaluate`: a scene against its photographs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from eigenfield.cli.capture_options import capture_argument, capture_options
from eigenfield.cli.clip_figures import evaluate_clip_file, refuse_for_clips
from eigenfield.cli.common import (
    PATH,
    chosen_workers,
    common_options,
    echo_json,
    first_names,
    note,
    worker_options,
)
from eigenfield.cli.progress import progress_bars
from eigenfield.core.errors import OptionError
from eigenfield.core.open_options import OpenOptions

Column = tuple[str, str, str]  # key, heading, format

COLUMNS: tuple[Column, ...] = (
    ("psnr", "PSNR", "{:.2f}"),
    ("ssim", "SSIM", "{:.4f}"),
    ("psnr_luma", "PSNR luma", "{:.2f}"),
    ("psnr_full", "PSNR full", "{:.2f}"),
    ("ssim_full", "SSIM full", "{:.4f}"),
    ("coverage", "coverage", "{:.1%}"),
    ("flip", "FLIP", "{:.4f}"),
)
LABEL_WIDTH = 22


@click.command(
    epilog="""\b
Examples:
  eigenfield evaluate scene.glb capture/
  eigenfield evaluate scene.glb photos/ --calibration refined.json --curve --plots plots/
  eigenfield evaluate scene.glb capture/ --flip --json > figures.json
  eigenfield evaluate scene.glb capture/ --store --exclude-circles ball.json
  eigenfield evaluate clip.glb footage/ --every 5 --plots plots/"""
)
@click.argument("scene", type=PATH)
@capture_argument()
@capture_options
@click.option("--json", "as_json", is_flag=True, help="The figures as JSON on standard output, every camera's too.")
@click.option(
    "--curve",
    type=click.Choice(["all", "sample", "none"]),
    is_flag=False,
    flag_value="all",
    default="none",
    help="The UV measure for every number of eigen textures up to the file's: of all cameras, or of 16. A fitted file "
    "has no texture maps to measure.",
)
@click.option(
    "--plots",
    type=PATH,
    metavar="DIR",
    help="Write plots and a contact sheet as PNG into DIR, which is made if need be.",
)
@click.option("--overwrite", is_flag=True, help="Replace plots that exist.")
@click.option(
    "--store", is_flag=True, help="Write the figures into the scene file (`eigenfield info SCENE` shows them)."
)
@click.option(
    "--exclude-circles",
    type=PATH,
    metavar="FILE",
    help='Also measure outside the circles of a JSON file {"circles": {photograph: {"cx", "cy", "r"}}}, in pixels.',
)
@click.option(
    "--filter",
    type=click.Choice(["bicubic", "bilinear"]),
    default="bicubic",
    show_default=True,
    help="Texture filter of the drawn pictures.",
)
@click.option(
    "--weights",
    type=click.Choice(["delaunay", "nearest3", "bilinear"]),
    default="delaunay",
    show_default=True,
    help="View weights of held-out cameras.",
)
@click.option("--textures", "-n", type=int, metavar="N", help="Use the first N eigen textures only.")
@click.option(
    "--png-maps",
    type=click.Choice(["all", "sample", "none"]),
    default="all",
    show_default=True,
    help="Pack every texture map as PNG for the ratio to them, or 16 and scale up, or none.",
)
@click.option(
    "--every",
    type=int,
    metavar="N",
    help="Of a clip: measure each N-th frame, and those at the borders of groups.  [default: all frames]",
)
@click.option("--flip", is_flag=True, help="Measure FLIP too: what an eye sees of the difference (0 is best).")
@worker_options
@common_options
def command(
    scene: Path,
    capture: Path,
    place: OpenOptions,
    as_json: bool,
    plots: Path | None,
    overwrite: bool,
    store: bool,
    exclude_circles: Path | None,
    every: int | None,
    quiet: bool,
    workers: int | None,
    cluster: str | None,
    **settings: Any,
) -> None:
    """Measure the file SCENE against the photographs of CAPTURE, matched by name. A clip is measured frame by frame.

    `eigenfield help measures` defines every figure. Where the file has a residual, captured views are measured without
    it and with it; held-out ones have none. With --json all figures go to standard output, otherwise a table does.
    """  # fmt: skip
    from eigenfield.capture import open_any, with_scene_cameras
    from eigenfield.core.clip import Clip
    from eigenfield.evaluation import evaluate, read_circles, stored_scores
    from eigenfield.gltf import store_scores
    from eigenfield.gltf.read import load_any
    from eigenfield.runtime.files import refuse_existing

    loaded = load_any(scene)
    if isinstance(loaded, Clip):
        stills = {"curve": settings.pop("curve") != "none", "store": store, "exclude-circles": exclude_circles,
                  "workers": workers, "cluster": cluster, "png-maps": settings.pop("png_maps") != "all"}  # fmt: skip
        refuse_for_clips(stills)
        every = 1 if every is None else every
        evaluate_clip_file(loaded, scene, capture, place, plots, overwrite, as_json, quiet, every, settings)
        return
    if every is not None:
        raise OptionError("clip-option", "--every is for clips", remedy="leave it out")
    if plots is not None:
        from eigenfield.evaluation.plots import refuse_existing_plots

        refuse_existing_plots(plots, overwrite)
    if store:
        refuse_existing(scene, overwrite=True)  # fails now, not after the work, where the folder cannot be written to
    light_field = with_scene_cameras(loaded, open_any(capture, place))
    circles = None if exclude_circles is None else read_circles(exclude_circles, loaded.rig.names)
    with chosen_workers(workers, cluster) as reached, progress_bars(quiet) as progress:
        figures = evaluate(
            loaded, light_field, path=scene, circles=circles, workers=reached, progress=progress, **settings
        )
    if plots is not None:
        from eigenfield.evaluation.plots import write_plots

        for path in write_plots(figures, loaded, light_field, plots, overwrite=overwrite):
            note(f"wrote {path}", quiet)
    if as_json:
        echo_json(figures)
    else:
        click.echo("\n".join(table(scene.name, figures, fitted=loaded.appearance.to_rgb is not None)))
    if store:
        kept = {"between": loaded.scores["between"]} if "between" in loaded.scores else {}
        store_scores(scene, kept | stored_scores(figures))


def table(name: str, figures: Mapping[str, Any], fitted: bool = False) -> list[str]:
    """The figures as lines for a person.

    Args:
        fitted: Whether the scene was fitted, and so has no texture maps.
    """
    lines = [f"{name}: {figures['textures']} eigen textures, drawn {figures['filter']}, {figures['seconds']:.0f} s", ""]
    parts = [part for part in figures["image"].values() if part is not None]
    columns = [column for column in COLUMNS if any(column[0] in part for part in parts)]
    lines.append(" " * LABEL_WIDTH + "".join(f"{heading:>11}" for _, heading, _ in columns))
    uv = figures["uv"]
    why = "none: the scene was fitted to the photographs (encode --fit none makes them)" if fitted else "not measured"
    lines += _table_rows("texture maps (UV)", uv, columns) if uv else [f"{'texture maps (UV)':{LABEL_WIDTH}}{why}"]
    for key, label in (("encoded", "encoded"), ("residual", "with residual"), ("held_out", "held out")):
        part = figures["image"][key]
        if part is None and key == "residual":
            continue
        if part is None:
            lines.append(f"{label:{LABEL_WIDTH}}none")
            continue
        lines += _table_rows(f"{label} ({part['cameras']})", part, columns)
        if "outside" in part:
            lines += _table_rows("  outside circles", part["outside"], columns)
    if missing := figures["missing"]:
        lines += ["", f"{len(missing)} cameras have no photograph here: {first_names(missing, 5)}"]
    lines += _size_lines(figures)
    if figures.get("curve"):
        lines += ["", f"{'eigen textures':>14}{'UV SSIM':>11}{'UV PSNR':>11}"]
        for point in figures["curve"]:
            ssim, psnr = _cell(point["uv_ssim"], "{:.4f}"), _cell(point["uv_psnr"], "{:.2f}")
            lines.append(f"{point['textures']:14}{ssim:>11}{psnr:>11}")
    return lines


def _table_rows(label: str, part: Mapping[str, Any], columns: Sequence[Column]) -> list[str]:
    """A line of means and a line of the worst cameras' values, named by the worst PSNR."""
    lows = {key: None if worst is None else worst["value"] for key, worst in part["worst"].items()}
    named = part["worst"].get("psnr")
    mean = "".join(f"{_cell(part.get(key), form):>11}" for key, _, form in columns)
    low = "".join(f"{_cell(lows.get(key), form):>11}" for key, _, form in columns)
    return [
        f"{label:{LABEL_WIDTH}}{mean}",
        f"{'  worst':{LABEL_WIDTH}}{low}   {'' if named is None else named['camera']}".rstrip(),
    ]


def _cell(value: float | None, form: str) -> str:
    return "" if value is None else form.format(value)


def _size_lines(figures: Mapping[str, Any]) -> list[str]:
    sizes, ratio = figures["bytes"], figures["ratio"]
    if sizes is None or ratio is None:
        return []
    rest = ", ".join(f"{key} {sizes[key]:,}" for key in sizes if key != "total")
    lines = ["", f"{sizes['total']:,} bytes: {rest}"]
    maps = figures["png_maps"]
    estimate = maps is not None and maps["packed"] < maps["of"]
    about = f" (estimated from {maps['packed']} of {maps['of']} maps)" if estimate else ""
    known = {
        "photographs": "the photographs' files",
        "texture_maps_png": f"the texture maps as PNG{about}",
        "raw": "their raw pixels",
    }
    return lines + [f"{ratio[key]:10.1f} times smaller than {label}" for key, label in known.items() if ratio.get(key)]
