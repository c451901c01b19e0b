"""`eigenfield proxy`."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.capture_options import (
    BY_HAND,
    capture_argument,
    capture_options,
    open_for_work,
    reconstruct_capture,
    surface_options,
)
from eigenfield.cli.common import PATH, common_options, note, note_all
from eigenfield.cli.field_options import from_fields
from eigenfield.cli.leave_out import leave_out, leave_out_cameras, leave_out_option
from eigenfield.cli.progress import progress_bars
from eigenfield.core.open_options import OpenOptions
from eigenfield.reconstruction import SurfaceOptions
from eigenfield.reconstruction.options import MESH_KINDS

if TYPE_CHECKING:
    from eigenfield.capture import Capture
    from eigenfield.core.progress import Progress


@click.command(
    epilog="""\b
Examples:
  eigenfield proxy photos/ -o mesh.glb
  eigenfield proxy photos/ --grid 5x4 -o mesh.ply
  eigenfield proxy videos/ --clip 0:2s -o mesh.glb
  eigenfield proxy photos/ --surface poisson --triangles 60000 -o mesh.glb
  eigenfield proxy photos/ --fit-sphere out_08_08.jpg:150,180,200,210 -o mesh.glb
  eigenfield encode photos/ --calibration mesh.cameras/transforms.json --proxy mesh.glb -o scene.glb"""
)
@capture_argument()
@click.option("--output", "-o", required=True, type=PATH, metavar="FILE", help="The .glb or .ply to write.")
@capture_options
@leave_out_option
@click.option("--surface", type=click.Choice(["auto", "relief", "poisson"]), default="auto", show_default=True,
              help=f"{MESH_KINDS}.")  # fmt: skip
@surface_options(*BY_HAND, "triangles")
@click.option(
    "--work",
    type=PATH,
    metavar="DIR",
    help="Folder that keeps finished stages; the same command goes on from there.  [default: OUTPUT.work]",
)
@click.option("--overwrite", is_flag=True, help="Replace the output if it exists.")
@common_options
def command(
    capture: Path,
    output: Path,
    place: OpenOptions,
    without: str | None,
    work: Path | None,
    overwrite: bool,
    quiet: bool,
    **settings: Any,
) -> None:
    """Make a proxy mesh from the photographs in CAPTURE, and their cameras where these are not known.

    The mesh is in the world of the capture's calibration. Cameras that were estimated are written beside it
    (OUTPUT.cameras), and it is in their world. Of footage (--clip) it is made of what stands still, averaged
    over time; what never does is as in the middle frame.
    """  # fmt: skip
    from eigenfield.capture.writers.save import save_calibration
    from eigenfield.proxy import check_mesh_name, write_mesh
    from eigenfield.runtime.files import refuse_existing

    started = time.monotonic()
    check_mesh_name(output)
    refuse_existing(output, overwrite)
    work = work if work is not None else output.with_suffix(".work")
    with progress_bars(quiet) as progress:
        opened = _open(capture, place, without, work, progress, quiet)
        surface = replace(from_fields(SurfaceOptions, settings), layers=1)  # a file holds no layers
        result = reconstruct_capture(opened, surface, work, progress, quiet)
    note_all(result.report.lines(result.light_field.names), quiet)
    if result.calibration is not None:
        cameras = output.with_suffix(".cameras")
        save_calibration(result.light_field, cameras, overwrite=True)
        note(f"cameras: {cameras}", quiet)
    mesh = result.proxy.mesh
    write_mesh(mesh, output, origin=result.light_field.origin, overwrite=overwrite)
    click.echo(
        f"{output}: {len(mesh.vertices)} vertices, {len(mesh.faces)} triangles for {len(result.light_field)} "
        f"photographs, {time.monotonic() - started:.0f} s"
    )


def _open(
    capture: Path, place: OpenOptions, without: str | None, work: Path, progress: Progress | None, quiet: bool
) -> Capture:
    """The photographs that the mesh is made of."""
    if place.clip is None:
        return leave_out(open_for_work(capture, place, work, quiet), without, quiet)
    from eigenfield.capture import open_footage
    from eigenfield.encoding.clip.still import still_capture
    from eigenfield.runtime.stages import Stages

    footage = open_footage(capture, options=replace(place, work=work / "frames"))
    note_all(footage.problems, quiet)
    return still_capture(leave_out_cameras(footage, without, quiet), Stages(work), progress)
