"""What `eigenfield evaluate` does with a clip: its figures, printed and drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.common import echo_json, first_names, note, note_all
from eigenfield.cli.progress import progress_bars
from eigenfield.core.errors import OptionError
from eigenfield.core.open_options import OpenOptions

if TYPE_CHECKING:
    from eigenfield.core.clip import Clip

KINDS = (("encoded", "encoded"), ("held_out", "held out"))
COLUMNS = (("psnr", "PSNR", "{:.2f}"), ("psnr_luma", "PSNR luma", "{:.2f}"), ("ssim", "SSIM", "{:.4f}"))


def refuse_for_clips(given: Mapping[str, Any]) -> None:
    """Raise OptionError `clip-option` for an option that is for scenes of one instant."""
    for name, value in given.items():
        if value:
            raise OptionError("clip-option", f"--{name} is for scenes of one instant", remedy="leave it out")


def evaluate_clip_file(
    clip: Clip,
    path: Path,
    capture: Path,
    place: OpenOptions,
    plots: Path | None,
    overwrite: bool,
    as_json: bool,
    quiet: bool,
    every: int,
    settings: Mapping[str, Any],
) -> None:
    """Measure a clip that was read from `path`, and say what was found."""
    from eigenfield.capture import open_footage
    from eigenfield.evaluation import evaluate_clip

    if plots is not None:
        from eigenfield.evaluation.clip_sheet import write_clip_sheet
        from eigenfield.evaluation.strip import refuse_existing_clip_plots, write_strip

        refuse_existing_clip_plots(plots, overwrite)
    footage = open_footage(capture, options=replace(place, clip=place.clip or ":"))
    note_all(footage.problems, quiet)
    with progress_bars(quiet) as progress:
        figures = evaluate_clip(clip, footage, path=path, every=every, progress=progress, **settings)
    if plots is not None:
        note(f"wrote {write_strip(figures, plots, overwrite=overwrite)}", quiet)
        note(f"wrote {write_clip_sheet(clip, footage, plots, overwrite=overwrite)}", quiet)
    if as_json:
        echo_json(figures)
    else:
        click.echo("\n".join(clip_table(path.name, figures)))


def clip_table(name: str, figures: Mapping[str, Any]) -> list[str]:
    """The figures as lines for a person."""
    measured = f"{figures['measured']} of {figures['frames']} frames"
    lines = [f"{name}: {measured}, drawn {figures['filter']}, {figures['seconds']:.0f} s", ""]
    lines.append(" " * 22 + "".join(f"{heading:>11}" for _, heading, _ in COLUMNS))
    for kind, label in KINDS:
        part = figures["image"][kind]
        if part is None:
            lines.append(f"{label:22}none")
            continue
        named = part["worst"]["psnr"]
        worst = {key: None if value is None else value["value"] for key, value in part["worst"].items()}
        where = "" if named is None else f"   {named['camera']}, frame {named['frame']}"
        whole = f"{label} ({part['cameras']})"
        lines += [
            f"{whole:22}{_cells(part)}",
            f"{'  fifth percentile':22}{_cells(part['fifth'])}",
            f"{'  worst':22}{_cells(worst)}{where}".rstrip(),
        ]
    lines += ["", *_flicker_lines(figures)]
    if missing := figures["missing"]:
        lines += ["", f"{len(missing)} cameras have no photograph here: {first_names(missing, 5)}"]
    if sizes := figures["bytes"]:
        rates = f"{sizes['kilobytes_a_frame']:.1f} kB a frame, {sizes['megabits_a_second']:.2f} Mbit/s"
        lines += ["", f"{sizes['total']:,} bytes: {rates}"]
    return lines


def _cells(values: Mapping[str, Any]) -> str:
    return "".join(f"{'' if values[key] is None else form.format(values[key]):>11}" for key, _, form in COLUMNS)


def _flicker_lines(figures: Mapping[str, Any]) -> list[str]:
    lines = []
    for kind, label in KINDS:
        part, border = figures["flicker"][kind] or {}, figures["border"][kind]
        if part.get("still") is not None:
            share = f"{part['still_share']:.0%} of the pixels stand still"
            lines.append(f"{label}: {share}, and flicker by {part['still']:.2f} grey levels")
        if part.get("moving_ssim") is not None:
            lines.append(f"{label}: changes of the others have an SSIM of {part['moving_ssim']:.4f}")
        if border is not None:
            step = f"{border['step']:.2f} dB, at frame {border['frame']}"
            lines.append(f"{label}: the largest step of PSNR between groups is {step}")
    return lines
