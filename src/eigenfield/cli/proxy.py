"""`eigenfield proxy`."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import click

from eigenfield.cli.common import (
    capture_options,
    common_options,
    note,
    note_all,
    progress_bars,
    reconstruction_options,
    timings,
)


@click.command(
    epilog="""\b
Examples:
  eigenfield proxy photos/ -o mesh.glb
  eigenfield proxy photos/ --grid 5x4 -o mesh.ply
  eigenfield proxy photos/ --surface poisson --triangles 60000 -o mesh.glb
  eigenfield proxy photos/ --fit-sphere out_08_08.jpg:150,180,200,210 -o mesh.glb
  eigenfield encode photos/ --calibration mesh.cameras/transforms.json --proxy mesh.glb -o scene.glb"""
)
@click.argument("capture", type=click.Path(path_type=Path))
@click.option(
    "--output", "-o", required=True, type=click.Path(path_type=Path), metavar="FILE", help="The .glb or .ply to write."
)
@capture_options
@reconstruction_options
@click.option(
    "--triangles", type=int, default=30_000, show_default=True, metavar="N", help="Triangles of the mesh, at most."
)
@click.option(
    "--work",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder that keeps finished stages; the same command goes on from there.  [default: OUTPUT.work]",
)
@click.option("--overwrite", is_flag=True, help="Replace the output if it exists.")
@common_options
def command(
    capture: Path,
    output: Path,
    calibration: Path | None,
    masks: Path | None,
    format: str | None,
    grid: tuple[int, int] | None,
    frame: str | None,
    work: Path | None,
    overwrite: bool,
    quiet: bool,
    **settings: Any,
) -> None:
    """Make a proxy mesh from the photographs in CAPTURE, and their cameras where these are not known.

    The mesh is in the world of the cameras, which are written beside it (OUTPUT.cameras) where they were estimated.
    """  # fmt: skip
    from eigenfield.capture import open_any
    from eigenfield.capture.writers.save import save_calibration
    from eigenfield.proxy import check_mesh_name, write_mesh
    from eigenfield.reconstruction import reconstruct
    from eigenfield.runtime.files import refuse_existing

    started = time.monotonic()
    check_mesh_name(output)
    refuse_existing(output, overwrite)
    work = work if work is not None else output.with_suffix(".work")
    opened = open_any(
        capture, calibration=calibration, masks=masks, format=format, grid=grid, frame=frame, work=work / "frames"
    )
    note_all(opened.problems, quiet)
    with progress_bars(quiet) as progress:
        made = reconstruct(opened, work=work, progress=progress, **settings)
    note_all(made.light_field.problems[len(opened.problems) :], quiet)
    if made.calibration is not None:
        place = output.with_suffix(".cameras")
        save_calibration(made.light_field, place, overwrite=True)
        note(f"cameras: {place}", quiet)
    write_mesh(made.mesh, output, overwrite=overwrite)
    note_all([*timings(made.seconds), *made.report.lines(made.light_field.names)], quiet)
    click.echo(
        f"{output}: {len(made.mesh.vertices)} vertices, {len(made.mesh.faces)} triangles for {len(made.light_field)} "
        f"photographs, {time.monotonic() - started:.0f} s"
    )
