"""`eigenfield demo --clip`."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.clip import clip_lines
from eigenfield.cli.progress import planned_steps
from eigenfield.core.shell import shell_word

if TYPE_CHECKING:
    from eigenfield.core.clip import Clip

CLIP_HOLD_OUT = "every:10"
CLIP_EVERY = 5  # frames of which one is measured
CLIP_STEP_SECONDS = {"draw": 115.0, "encode": 250.0, "fly": 8.0, "measure": 20.0, "page": 2.0}  # on two cores


def make_demo_clip(output: Path, quiet: bool) -> None:
    """Draw footage into a folder, encode it, draw and measure the clip."""
    from eigenfield.capture import open_footage
    from eigenfield.demo import clip as drawing
    from eigenfield.encoding import EncodeOptions, encode_footage
    from eigenfield.evaluation import evaluate_clip
    from eigenfield.evaluation.clip_sheet import write_clip_sheet
    from eigenfield.evaluation.strip import write_strip
    from eigenfield.gltf import load_clip, save
    from eigenfield.rendering import path_points
    from eigenfield.rendering.render_jobs import write_clip_flight
    from eigenfield.runtime.files import make_folder, write_bytes
    from eigenfield.viewer.exports import export

    started = time.monotonic()
    make_folder(output)
    folder, path, page, plots = (output / name for name in ("footage", "clip.glb", "clip.html", "plots"))
    work = path.with_suffix(".work")  # what is finished of the clip stays there, as of `encode --clip`
    there = drawing.is_drawn(folder)
    seconds = {**CLIP_STEP_SECONDS, **({"draw": 0.0} if there else {})}
    pictures = drawing.CLIP_ROWS * drawing.CLIP_COLUMNS
    words = {
        "draw": "footage that is there" if there else f"drawing {drawing.CLIP_FRAMES} frames of {pictures} cameras",
        "encode": f"encoding them into {path}",
        "fly": f"flying through it in {output / 'flight.mp4'}",
        "measure": f"measuring it: {output / 'evaluation.json'}, {plots}",
        "page": f"one page of it: {page}",
    }
    with planned_steps(quiet, seconds, words) as (begin, progress):
        begin("draw")
        drawing.draw_demo_clip(folder, progress=progress)
        footage = open_footage(folder)
        begin("encode")
        options = EncodeOptions(hold_out=CLIP_HOLD_OUT)
        clip = encode_footage(footage, folder / drawing.CLIP_MESHES, options, work=work, progress=progress)
        save(clip, path, overwrite=True, progress=progress)
        clip = load_clip(path)
        begin("fly")
        frames = range(clip.timeline.frames)
        places = [{"at": tuple(point)} for point in path_points("circle", len(frames)).tolist()]
        rate = clip.timeline.rate
        write_clip_flight(clip, frames, places, output / "flight.mp4", rate, overwrite=True, progress=progress)
        begin("measure")
        figures = evaluate_clip(clip, footage, path=path, every=CLIP_EVERY, progress=progress)
        write_bytes(output / "evaluation.json", json.dumps(figures, indent=1).encode(), overwrite=True)
        write_strip(figures, plots, overwrite=True)
        write_clip_sheet(clip, footage, plots, overwrite=True)
        begin("page")
        export(path, page, overwrite=True, progress=progress)
    click.echo(_summary(path, page, clip, figures, time.monotonic() - started))


def _summary(path: Path, page: Path, clip: Clip, figures: dict[str, Any], seconds: float) -> str:
    encoded, held_out = (figures["image"][kind] for kind in ("encoded", "held_out"))
    between = "" if held_out is None else f"; held out, between the cameras {held_out['psnr']:.1f} dB"
    size, *_ = clip_lines(path, clip)
    return (
        f"{size}\n"
        f"re-drawn photographs {encoded['psnr']:.1f} dB, SSIM {encoded['ssim']:.3f}{between}\n"
        f"look at {path.parent / 'plots' / 'contact-sheet.png'} and {path.parent / 'flight.mp4'}; {seconds:.0f} s\n"
        f"look around in it while it plays: eigenfield view {shell_word(path)}\n"
        f"or open this in a browser: {page}"
    )
