"""`eigenfield export`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from eigenfield.cli.common import PATH, common_options, note, pair_of_numbers, progress_bars
from eigenfield.cli.drawing import DEFAULT_FRAMES, flight_options, picture_options, residual_option
from eigenfield.core.errors import OptionError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from eigenfield.core.progress import Progress
    from eigenfield.rendering import RenderJob

PICTURE_OPTIONS = {"resolution", "background", "weights", "filter", "textures", "samples", "renderer"}
OPTIONS = {  # of each kind, beside the options of all
    "html": {"title", "metres_per_unit"},
    "mp4": PICTURE_OPTIONS | {"path", "frames", "fps"},
    "png": PICTURE_OPTIONS | {"path", "frames"},
    "obj": {"textures"},
    "maps": {"textures"},
    "quilt": PICTURE_OPTIONS | {"quilt", "spread"},
    "colmap": PICTURE_OPTIONS | {"path", "frames", "residual"},
}
ENDINGS = {"html": (".html", ".htm"), "mp4": (".mp4",), "png": (".png",), "quilt": (".png",)}
FILE_ENDINGS = (".html", ".htm", ".mp4", ".png", ".jpg", ".jpeg", ".glb", ".gltf", ".ply", ".zip")
QUILT_NAME = re.compile(r"_qs\d+x\d+a[\d.]+$")
DEFAULT_PATH = "circle"  # where none is asked for


@click.command(
    epilog="""\b
Examples:
  eigenfield export scene.glb -o scene.html
  eigenfield export scene.glb -o flight.mp4 --path spiral --frames 240
  eigenfield export scene.glb -o 'frames/%04d.png' --background transparent
  eigenfield export scene.glb -o mesh.obj
  eigenfield export scene.glb -o textures --as obj
  eigenfield export scene.glb -o maps --as maps
  eigenfield export scene.glb -o quilt.png --as quilt --resolution 420x560
  eigenfield export scene.glb -o capture --as colmap"""
)
@click.argument("scene", type=PATH)
@click.option(
    "--output",
    "-o",
    required=True,
    type=PATH,
    metavar="PATH",
    help="A file or a folder; a file's ending says what is made, if --as does not.",
)
@click.option("--as", "kind", type=click.Choice(list(OPTIONS)), help="What is made.")
@click.option("--title", metavar="TEXT", help="Of the page (html).  [default: the output's name]")
@click.option(
    "--metres-per-unit", type=float, metavar="M", help="Metres in one unit of the capture, for headsets (html)."
)
@click.option(
    "--quilt",
    callback=pair_of_numbers("COLUMNSxROWS: 8x6"),
    metavar="CxR",
    help="Columns and rows of views (quilt).  [default: 8x6]",
)
@click.option(
    "--spread",
    type=float,
    default=1.0,
    show_default=True,
    metavar="0..1",
    help="Part of the array's width that the views span (quilt).",
)
@flight_options
@picture_options
@residual_option
@click.option("--overwrite", is_flag=True, help="Replace existing files, and folders that an export wrote.")
@common_options
def command(scene: Path, output: Path, kind: str | None, overwrite: bool, quiet: bool, **options: Any) -> None:
    """Write SCENE for other programs.

    \b
    html    one page with viewer and scene, which opens by double click
    mp4     a fly-through (--path, else a circle)
    png     its single pictures, where the output's name has %04d
    obj     NAME.obj with the mean as its texture; into a folder: with the eigen textures
    maps    a texture map for each encoded camera, in a folder
    quilt   the views side by side for a Looking Glass display, a .png
    colmap  re-drawn photographs with a COLMAP model, in a folder
    """
    from eigenfield.runtime.files import is_numbered

    chosen = _chosen_kind(output, kind, is_numbered(output))
    source = click.get_current_context().get_parameter_source
    given = {name for name in options if source(name) is ParameterSource.COMMANDLINE}
    _check(chosen, output, given, options)
    from eigenfield.gltf import load
    from eigenfield.rendering import RenderJob, path_points

    points = None
    if chosen in ("mp4", "png") or "path" in given:
        frames = DEFAULT_FRAMES if options["frames"] is None else options["frames"]
        points = path_points(options["path"] or DEFAULT_PATH, frames)
    _refuse(chosen, output, points, overwrite)
    job = RenderJob(load(scene), **{name: options[name] for name in PICTURE_OPTIONS})
    with progress_bars(quiet) as progress:
        made = _write(chosen, job, points, output, options, overwrite, progress)
    note(f"wrote {made}", quiet)


def _refuse(kind: str, output: Path, points: NDArray[np.float64] | None, overwrite: bool) -> None:
    """Refuse existing outputs, before any work; a quilt's name is known only with its scene."""
    from eigenfield.rendering.render_jobs import refuse_flight
    from eigenfield.runtime.files import refuse_existing
    from eigenfield.viewer import exports

    if _is_obj(output):
        exports.refuse_obj(output, overwrite)
    elif kind not in ENDINGS:
        exports.refuse_folder(output, overwrite)
    elif points is not None:
        refuse_flight(output, len(points), overwrite)
    elif kind != "quilt":
        refuse_existing(output, overwrite)


def _write(
    kind: str, job: RenderJob, points: NDArray[np.float64] | None, output: Path, options: dict[str, Any],
    overwrite: bool, progress: Progress | None,
) -> str:  # fmt: skip
    """Write the export; a line about what was written."""
    from eigenfield.rendering.render_jobs import write_flight
    from eigenfield.viewer import exports

    scene = job.scene
    how: dict[str, Any] = {"overwrite": overwrite, "progress": progress}
    if kind == "html":
        own = {name: options[name] for name in ("title", "metres_per_unit")}
        exports.write_page(scene, output, overwrite=overwrite, **own)
        return f"{output}: {output.stat().st_size / 1e6:.1f} MB"
    if _is_obj(output):
        exports.write_obj(scene, output, overwrite=overwrite)
        return f"{output}, its material and the mean; a folder with --as obj holds the eigen textures too"
    if kind == "obj":
        exports.write_obj_folder(scene, output, textures=job.textures, **how)
        return f"{output}: mesh, mean and eigen textures"
    if kind == "maps":
        exports.write_maps(scene, output, textures=job.textures, **how)
        return f"{output}: {len(scene.rig.encoded)} texture maps"
    if kind == "quilt":
        quilt = exports.quilt_of(scene, options["quilt"], options["resolution"], options["spread"])
        path = exports.write_quilt(job, quilt, output, **how)
        return f"{path}: {quilt.columns * quilt.rows} views of {quilt.width}x{quilt.height}"
    if kind == "colmap":
        exports.write_colmap(job, output, points=points, residual=options["residual"], **how)
        return f"{output}: {len(scene.rig.names) if points is None else len(points)} pictures and a COLMAP model"
    assert points is not None
    write_flight(job, points, output, options["fps"], **how)
    return f"{output}: {len(points)} pictures"


def _is_obj(output: Path) -> bool:
    return output.suffix.lower() == ".obj"


def _chosen_kind(output: Path, kind: str | None, numbered: bool) -> str:
    """The kind that is asked for, else that of the output's name."""
    ending = output.suffix.lower()
    if kind is None:
        if ending == ".png" and not numbered and not QUILT_NAME.search(output.stem):
            raise OptionError(
                "output-kind",
                f"{output}: one .png may be many things",
                remedy="put %04d into its name for the pictures of a path, or say --as quilt; "
                "`eigenfield render SCENE -o view.png` draws one view",
            )
        by_ending = {".html": "html", ".htm": "html", ".mp4": "mp4", ".obj": "obj",
                     ".png": "png" if numbered else "quilt"}  # fmt: skip
        if ending not in by_ending:
            raise OptionError(
                "output-kind",
                f"{output}: the name does not tell what to write",
                remedy=f"say --as {', '.join(list(OPTIONS)[:-1])} or {list(OPTIONS)[-1]}",
            )
        return by_ending[ending]
    if kind in ENDINGS and ending not in ENDINGS[kind]:
        raise OptionError("output-kind", f"{output}: {kind} is a file", remedy=f"name it {ENDINGS[kind][0]}")
    if kind == "png" and not numbered:
        raise OptionError("output-kind", f"{output}: a path makes many pictures", remedy="put %04d into its name")
    if kind == "quilt" and numbered:
        raise OptionError("output-kind", f"{output}: a quilt is one picture", remedy="leave the number out of its name")
    if kind not in ENDINGS and (ending in FILE_ENDINGS or (ending == ".obj" and kind != "obj")):
        raise OptionError("output-kind", f"{output}: {kind} is a folder", remedy="name one")
    return kind


def _check(kind: str, output: Path, given: set[str], options: dict[str, Any]) -> None:
    """Refuse options that the kind does not take, before anything is read."""
    for name in options:
        if name in given - OPTIONS[kind]:
            raise OptionError("unused-option", f"--{name.replace('_', '-')} is not for {kind}", remedy="leave it out")
    if _is_obj(output) and "textures" in given:
        raise OptionError(
            "unused-option", f"{output} has the mean alone", remedy="leave out --textures, or name a folder"
        )
    if kind == "colmap" and "frames" in given and "path" not in given:
        raise OptionError("frames", "--frames needs --path", remedy="give a path, or leave it out")
    if kind == "mp4" and options["background"] is None:
        raise OptionError("background", "a film cannot be transparent", remedy="name a colour, or write .png pictures")
    from eigenfield.core.scene import check_scale

    check_scale(options["metres_per_unit"])
