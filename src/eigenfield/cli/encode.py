"""`eigenfield encode`."""

from __future__ import annotations

import time
from pathlib import Path

import click

from eigenfield.cli.common import capture_options, common_options, note, progress_bars


def _atlas(context: click.Context, parameter: click.Parameter, value: str | None) -> int | tuple[int, int] | None:
    if value is None:
        return None
    try:
        sides = [int(part) for part in value.lower().split("x")]
    except ValueError:
        sides = []
    if len(sides) == 1:
        return sides[0]
    if len(sides) == 2:
        return sides[0], sides[1]
    raise click.BadParameter("a side (1024) or WIDTHxHEIGHT (2048x1024)")


@click.command(
    epilog="""\b
Examples:
  eigenfield encode capture/ --proxy capture/proxy.ply -o scene.glb
  eigenfield encode photos/ --calibration refined.json --proxy proxy.ply --atlas 1024 -o scene.glb
  eigenfield encode photos/ --proxy mesh.obj --uv-ssim 0.98 --hold-out odd -o scene.glb
  eigenfield encode photos/ --proxy mesh.glb --codec png --align -o scene.glb"""
)
@click.argument("capture", type=click.Path(path_type=Path))
@click.option(
    "--proxy",
    required=True,
    type=click.Path(path_type=Path),
    metavar="MESH",
    help="Triangle mesh in the cameras' world: .ply, .obj or .glb.",
)
@click.option(
    "--output", "-o", required=True, type=click.Path(path_type=Path), metavar="FILE", help="The .glb to write."
)
@capture_options
@click.option(
    "--textures",
    "-n",
    type=int,
    default=15,
    show_default=True,
    metavar="N",
    help="Eigen textures to keep; at most one less than there are cameras.",
)
@click.option("--uv-ssim", type=float, metavar="S", help="Instead: as few as reach this SSIM in UV space (0.98, say).")
@click.option(
    "--density",
    type=float,
    default=1.5,
    show_default=True,
    metavar="D",
    help="Atlas texels per photograph pixel along one axis, in the central camera (side at most 4096).",
)
@click.option("--atlas", callback=_atlas, metavar="N", help="Side of the atlas outright, or WIDTHxHEIGHT.")
@click.option(
    "--triangles",
    type=int,
    metavar="N",
    help="Simplify the proxy to N triangles.  [default: 30000, only if it has more and no atlas of its own]",
)
@click.option(
    "--align",
    is_flag=False,
    flag_value="dis",
    type=click.Choice(["dis", "tvl1"]),
    metavar="[dis|tvl1]",
    help="Align the maps to the reference camera by optical flow; tvl1 is finer and much slower.",
)
@click.option("--reference", metavar="NAME", help="Reference camera.  [default: nearest the centre of the array]")
@click.option(
    "--hold-out",
    metavar="RULE",
    help="Cameras to leave out and measure later: odd, every:K, or names with commas between.",
)
@click.option(
    "--resampling",
    type=click.Choice(["bicubic", "lanczos", "bilinear"]),
    default="bicubic",
    show_default=True,
    help="Filter from photograph to atlas.",
)
@click.option(
    "--codec",
    type=click.Choice(["avif", "webp", "png"]),
    default="avif",
    show_default=True,
    help="Pictures in the file: avif is lossy and small, webp and png keep 8 bits exactly.",
)
@click.option("--quality", type=click.IntRange(0, 100), metavar="Q", help="Quality of avif, 0 to 100.")
@click.option(
    "--keep-maps",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Also write every filled texture map and its visibility as PNG.",
)
@click.option(
    "--work",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder for the scratch file of texture maps.  [default: the output's]",
)
@click.option("--overwrite", is_flag=True, help="Replace the output if it exists.")
@common_options
def command(
    capture: Path,
    proxy: Path,
    output: Path,
    calibration: Path | None,
    masks: Path | None,
    textures: int,
    uv_ssim: float | None,
    density: float,
    atlas: int | tuple[int, int] | None,
    triangles: int | None,
    align: str | None,
    reference: str | None,
    hold_out: str | None,
    resampling: str,
    codec: str,
    quality: int | None,
    keep_maps: Path | None,
    work: Path | None,
    overwrite: bool,
    quiet: bool,
) -> None:
    """Turn a calibrated CAPTURE and a proxy mesh into one .glb.

    CAPTURE is a folder with a transforms.json or a COLMAP model, or the photographs of a --calibration.
    """  # fmt: skip
    from eigenfield.capture import open_capture
    from eigenfield.files import refuse_existing
    from eigenfield.format import parts, save
    from eigenfield.pipeline import encode

    started = time.monotonic()
    refuse_existing(output, overwrite)
    light_field = open_capture(capture, calibration=calibration, masks=masks)
    for problem in light_field.problems:
        note(problem, quiet)
    with progress_bars(quiet) as progress:
        scene = encode(
            light_field, proxy, textures=textures, uv_ssim=uv_ssim, density=density, atlas=atlas, triangles=triangles,
            align=align, reference=reference, hold_out=hold_out, resampling=resampling, keep_maps=keep_maps,
            work=work if work is not None else output.absolute().parent, progress=progress,
        )  # fmt: skip
        save(scene, output, codec=codec, quality=quality, overwrite=overwrite, progress=progress)
    sizes = parts(output)
    width, height = scene.settings["atlas"]
    photographs = scene.settings["photographs"]
    click.echo(
        f"{output}: {sizes['total'] / 1e6:.2f} MB, {scene.textures} eigen textures of {width}x{height} for "
        f"{photographs['count']} photographs ({photographs['bytes'] / 1e6:.1f} MB), "
        f"{len(scene.mesh.faces)} triangles, {time.monotonic() - started:.0f} s"
    )
