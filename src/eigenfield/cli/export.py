"""`eigenfield export`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from eigenfield.cli.common import PATH, common_options, note, pair_of_numbers
from eigenfield.cli.drawing import ClipTime, flight_options, parse_place, picture_options, residual_option, time_option
from eigenfield.cli.progress import progress_bars


def _parse_quilt(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[int, int] | str | None:
    if value is None or (re.fullmatch(r"[a-z0-9]+(-[a-z]+)?", value) and not re.search(r"\dx\d", value)):
        return value
    return pair_of_numbers("COLUMNSxROWS: 8x6, or the name of a display")(context, parameter, value)


@click.command(
    epilog="""\b
Examples:
  eigenfield export scene.glb -o scene.html
  eigenfield export scene.glb -o scene.html --title "My scene" --url https://example.org/scene.html
  eigenfield export scene.glb -o scene.html --laboratory
  eigenfield export large.glb small.glb -o compare.html
  eigenfield export scene.glb -o flight.mp4 --path spiral --frames 240
  eigenfield export scene.glb -o 'frames/%04d.png' --background transparent
  eigenfield export scene.glb -o plain.glb --as glb
  eigenfield export scene.glb -o plain.glb --at 0.5,0 --image webp --draco
  eigenfield export clip.glb -o still.html --time 1.25s
  eigenfield export scene.glb -o mesh.obj
  eigenfield export scene.glb -o textures --as obj
  eigenfield export scene.glb -o maps --as maps
  eigenfield export scene.glb -o quilt.png --as quilt --quilt go
  eigenfield export scene.glb -o quilt.mp4 --as quilt --quilt 8x6 --path circle
  eigenfield export scene.glb -o views --as views --grid 9x9
  eigenfield export scene.glb -o capture --as colmap
  eigenfield export scene.glb -o splats.glb --as splats --splats 50000
  eigenfield export scene.glb -o scene.usdz
  eigenfield export clip.glb -o clip --as folder
  eigenfield export clip -o clip.glb --as glb
  eigenfield export scene.glb other.glb -o open --as app"""
)
@click.argument("scenes", type=PATH, nargs=-1, metavar="SCENE...")
@click.option(
    "--output",
    "-o",
    required=True,
    type=PATH,
    metavar="PATH",
    help="A file or a folder; a file's ending says what is made, if --as does not.",
)
@click.option(
    "--as", "kind", metavar="html|mp4|png|glb|obj|maps|quilt|views|colmap|splats|usdz|folder|app", help="What is made."
)
@click.option(
    "--title",
    metavar="TEXT",
    help="Of the page (html, app).  [default: the scene's own, or the output's name; of an app eigenfield]",
)
@click.option(
    "--metres-per-unit", type=float, metavar="M", help="Metres in one unit of the capture (html, glb, splats, usdz)."
)
@click.option(
    "--at",
    callback=parse_place,
    metavar="X,Y",
    help="First view (html), or viewpoint of the texture (glb).  [default: the reference camera's; the mean]",
)
@click.option(
    "--image", default="png", show_default=True, metavar="png|jpeg|webp", help="How the texture is kept (glb)."
)
@click.option("--draco", is_flag=True, help="Compress the mesh (glb).")
@click.option("--laboratory", is_flag=True, help="A page for those who measure, with panel and tools (html).")
@click.option("--no-download", is_flag=True, help="Leave out the button that saves the scene as a file (html).")
@click.option("--url", metavar="URL", help="Where the page will be, for links to it (html).")
@click.option(
    "--quilt",
    callback=_parse_quilt,
    metavar="CxR|DISPLAY",
    help="Columns and rows of views, or go, portrait, 16, 16-portrait, 32, 32-portrait, 65 (quilt).  [default: 8x6]",
)
@click.option(
    "--grid",
    callback=pair_of_numbers("ROWSxCOLUMNS: 9x9"),
    metavar="RxC",
    help="Rows and columns of views (views).  [default: 9x9, or 9 in a line]",
)
@click.option(
    "--spread",
    type=float,
    default=1.0,
    show_default=True,
    metavar="0..1",
    help="Part of the array's width that the views span (quilt).",
)
@click.option("--splats", type=int, metavar="N", help="Gaussians, at most (splats).  [default: one for two pixels]")
@time_option
@flight_options
@picture_options
@residual_option
@click.option("--overwrite", is_flag=True, help="Replace existing files, and folders that an export wrote.")
@common_options
def command(
    scenes: tuple[Path, ...], output: Path, kind: str | None, time: ClipTime | None, overwrite: bool, quiet: bool,
    **options: Any,
) -> None:  # fmt: skip
    """Write SCENE, or the frame of a clip at --time, for other programs.

    \b
    html    one page with viewer and scene, which opens by double click, and its poster, a .jpg; of two SCENEs a page
            that compares them
    mp4     a fly-through (--path, else a circle)
    png     its single pictures, where the output's name has %04d
    glb     the mesh with its mean, or the texture of --at, for any glTF viewer
    obj     NAME.obj with the mean as its texture; into a folder: with the eigen textures
    maps    a texture map for each encoded camera, in a folder
    quilt   the views side by side for a Looking Glass display, a .png, or a film of them, an .mp4
    views   a grid of drawn views with the names of the HCI benchmark, in a folder
    colmap  re-drawn photographs with a COLMAP model, in a folder
    splats  Gaussians, a .glb with KHR_gaussian_splatting or an .spz
    usdz    the mesh with its mean, for Quick Look
    folder  a clip whose groups are files beside it; glb makes it one file again
    app     a folder for a web server: a page that opens files, with any number of SCENEs to choose from
    """
    from eigenfield.gltf import stores_clip
    from eigenfield.viewer.exports import export

    source = click.get_current_context().get_parameter_source
    given: dict[str, Any] = {
        name: value for name, value in options.items() if source(name) is ParameterSource.COMMANDLINE
    }
    if time is not None:  # a page may compare a clip's frame with a scene, in any order
        clips = [scene for scene in scenes if stores_clip(scene)] or scenes
        given["time"] = time.in_clip(clips[0]) if clips else 0.0
    with progress_bars(quiet) as progress:
        made, what = export(scenes, output, kind, overwrite=overwrite, progress=progress, **given)
    note(f"wrote {made}: {what}", quiet)
