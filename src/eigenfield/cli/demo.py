"""`eigenfield demo`."""

from __future__ import annotations

import json
import time
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.common import PATH, common_options, note
from eigenfield.cli.progress import progress_bars

if TYPE_CHECKING:
    from eigenfield.core.scene import Scene

DEMO_HOLD_OUT = "every:10"  # enough to say how good the views between the cameras are
DEMO_FRAMES = 96


@click.command(
    epilog="""\b
Examples:
  eigenfield demo
  eigenfield demo --output /tmp/demo --threads 2"""
)
@click.option(
    "--output",
    "-o",
    type=PATH,
    default=Path("demo"),
    show_default=True,
    metavar="DIR",
    help="Folder for all of it; a capture that is there already is used again, the rest is made anew.",
)
@common_options
def command(output: Path, quiet: bool) -> None:
    """Make a capture, encode it, draw and measure it: the whole way in one command.

    DIR then holds capture/ (289 photographs of a scene that exists only here, transforms.json, the exact proxy.ply),
    scene.glb, flight.mp4, evaluation.json and plots/, of which contact-sheet.png shows photograph, drawing and error.
    """  # fmt: skip
    from eigenfield.capture import open_capture
    from eigenfield.encoding import encode
    from eigenfield.evaluation import evaluate, stored_scores
    from eigenfield.evaluation.plots import write_plots
    from eigenfield.gltf import load, save, store_scores
    from eigenfield.rendering import RenderJob, path_points
    from eigenfield.rendering.render_jobs import write_flight
    from eigenfield.runtime.files import output_errors, write_bytes

    started = time.monotonic()
    with output_errors(output):
        output.mkdir(parents=True, exist_ok=True)
    folder, path = output / "capture", output / "scene.glb"
    with progress_bars(quiet) as progress:
        if not folder.exists():
            from eigenfield.demo import draw_demo_capture

            note(f"drawing 289 photographs into {folder}", quiet)
            draw_demo_capture(folder, progress=progress)
        capture = open_capture(folder)
        note(f"encoding them into {path}", quiet)
        scene = encode(capture, folder / "proxy.ply", hold_out=DEMO_HOLD_OUT, work=output, progress=progress)
        save(scene, path, overwrite=True, progress=progress)
        scene = load(path)
        note(f"flying through it in {output / 'flight.mp4'}", quiet)
        points = path_points("circle", DEMO_FRAMES)
        write_flight(RenderJob(scene), points, output / "flight.mp4", Fraction(30), overwrite=True, progress=progress)
        note(f"measuring it: {output / 'evaluation.json'}, {output / 'plots'}", quiet)
        figures = evaluate(scene, capture, path=path, progress=progress)
        write_bytes(output / "evaluation.json", json.dumps(figures, indent=1).encode(), overwrite=True)
        write_plots(figures, scene, capture, output / "plots", overwrite=True)
        store_scores(path, stored_scores(figures))
    click.echo(_summary(path, scene, figures, time.monotonic() - started))


def _summary(path: Path, scene: Scene, figures: dict[str, Any], seconds: float) -> str:
    encoded, held_out = figures["image"]["encoded"], figures["image"]["held_out"]
    return (
        f"{path}: {path.stat().st_size / 1e6:.2f} MB, {scene.appearance.textures} eigen textures, "
        f"{figures['ratio']['photographs']:.0f} times smaller than the photographs\n"
        f"re-drawn photographs {encoded['psnr']:.1f} dB, SSIM {encoded['ssim']:.3f}; "
        f"held out, between the cameras {held_out['psnr']:.1f} dB, SSIM {held_out['ssim']:.3f}\n"
        f"look at {path.parent / 'plots' / 'contact-sheet.png'} and {path.parent / 'flight.mp4'}; {seconds:.0f} s\n"
        f"look around in it: eigenfield view {path} {path.parent / 'capture'}"
    )
