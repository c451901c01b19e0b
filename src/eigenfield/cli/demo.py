"""`eigenfield demo`."""

from __future__ import annotations

import json
import time
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.common import PATH, common_options
from eigenfield.cli.progress import planned_steps
from eigenfield.core.shell import shell_word

if TYPE_CHECKING:
    from eigenfield.core.scene import Scene

DEMO_HOLD_OUT = "every:10"  # enough to say how good the views between the cameras are
DEMO_TRIANGLES = 30_000  # all of the exact mesh: no facet is seen near by
DEMO_FRAMES = 96
DEMO_STEP_SECONDS = {"draw": 45.0, "encode": 90.0, "fly": 12.0, "measure": 10.0, "page": 1.0}  # on two cores


@click.command(
    epilog="""\b
Examples:
  eigenfield demo
  eigenfield demo --clip
  eigenfield demo --output /tmp/demo --threads 2"""
)
@click.option("--clip", is_flag=True, help="A light-field video: the same scene in motion.")
@click.option(
    "--output",
    "-o",
    type=PATH,
    metavar="DIR",
    help="Folder for all of it; photographs that are there already are used again, the rest is made anew.  "
    "[default: demo, or demo-clip]",
)
@common_options
def command(output: Path | None, clip: bool, quiet: bool) -> None:
    """Make a capture, encode it, draw and measure it: the whole way in one command.

    DIR then holds capture/ (81 photographs of a scene that exists only here, transforms.json, the exact proxy.ply),
    scene.glb, flight.mp4, evaluation.json, plots/, of which contact-sheet.png shows photograph, drawing and error, and
    scene.html with its poster scene.jpg, which opens in a browser. It takes about 3 minutes on two cores.

    With --clip DIR holds footage/ (30 frames of 25 cameras, and the exact mesh of each frame), clip.glb, clip.html,
    which plays, and flight.mp4, evaluation.json and plots/ of it. It takes about 7 minutes.
    """  # fmt: skip
    if clip:
        from eigenfield.cli.demo_clip import make_demo_clip

        make_demo_clip(output or Path("demo-clip"), quiet)
    else:
        make_demo(output or Path("demo"), quiet)


def make_demo(output: Path, quiet: bool) -> None:
    """Draw a capture into a folder, encode it, draw and measure the scene."""
    from eigenfield.capture import open_capture
    from eigenfield.demo import DEMO_COLUMNS, DEMO_ROWS, draw_demo_capture
    from eigenfield.encoding import encode
    from eigenfield.evaluation import evaluate, stored_scores
    from eigenfield.evaluation.plots import write_plots
    from eigenfield.gltf import load, save, store_scores
    from eigenfield.rendering import RenderJob, path_points
    from eigenfield.rendering.render_jobs import write_flight
    from eigenfield.runtime.files import make_folder, write_bytes
    from eigenfield.viewer.exports import export

    started = time.monotonic()
    there = (output / "capture").exists()
    seconds = {**DEMO_STEP_SECONDS, **({"draw": 0.0} if there else {})}
    make_folder(output)
    folder, path, page = output / "capture", output / "scene.glb", output / "scene.html"
    words = {
        "draw": "photographs that are there" if there else f"drawing {DEMO_ROWS * DEMO_COLUMNS} photographs",
        "encode": f"encoding them into {path}",
        "fly": f"flying through it in {output / 'flight.mp4'}",
        "measure": f"measuring it: {output / 'evaluation.json'}, {output / 'plots'}",
        "page": f"one page of it: {page}",
    }
    with planned_steps(quiet, seconds, words) as (begin, progress):
        begin("draw")
        if not there:
            draw_demo_capture(folder, progress=progress)
        capture = open_capture(folder)
        begin("encode")
        scene = encode(
            capture,
            folder / "proxy.ply",
            triangles=DEMO_TRIANGLES,
            hold_out=DEMO_HOLD_OUT,
            work=output,
            progress=progress,
        )
        save(scene, path, overwrite=True, progress=progress)
        scene = load(path)
        begin("fly")
        points = path_points("circle", DEMO_FRAMES)
        write_flight(RenderJob(scene), points, output / "flight.mp4", Fraction(30), overwrite=True, progress=progress)
        begin("measure")
        figures = evaluate(scene, capture, path=path, progress=progress)
        write_bytes(output / "evaluation.json", json.dumps(figures, indent=1).encode(), overwrite=True)
        write_plots(figures, scene, capture, output / "plots", overwrite=True)
        store_scores(path, stored_scores(figures))
        begin("page")
        export(path, page, overwrite=True, progress=progress)
    click.echo(_summary(path, page, scene, figures, time.monotonic() - started))


def _summary(path: Path, page: Path, scene: Scene, figures: dict[str, Any], seconds: float) -> str:
    words = f"{shell_word(path)} {shell_word(path.parent / 'capture')}"
    encoded, held_out = figures["image"]["encoded"], figures["image"]["held_out"]
    return (
        f"{path}: {path.stat().st_size / 1e6:.2f} MB, {scene.appearance.textures} eigen textures, "
        f"{figures['ratio']['photographs']:.0f} times smaller than the photographs\n"
        f"re-drawn photographs {encoded['psnr']:.1f} dB, SSIM {encoded['ssim']:.3f}; "
        f"held out, between the cameras {held_out['psnr']:.1f} dB, SSIM {held_out['ssim']:.3f}\n"
        f"look at {path.parent / 'plots' / 'contact-sheet.png'} and {path.parent / 'flight.mp4'}; {seconds:.0f} s\n"
        f"look around in it beside the photographs: eigenfield view {words}\n"
        f"or open this in a browser: {page}"
    )
