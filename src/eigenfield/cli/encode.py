"""`eigenfield encode`."""

from __future__ import annotations

import re
import time
from pathlib import Path
from typing import Any

import click

from eigenfield.cli.common import (
    capture_options,
    common_options,
    progress_bars,
    reconstruction_options,
    refuse_unused,
    tell,
    timings,
)
from eigenfield.errors import OptionError


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


def _size(context: click.Context, parameter: click.Parameter, value: str | None) -> int | None:
    if value is None:
        return None
    found = re.fullmatch(r"(\d+(?:\.\d+)?) *(k|m|g|)b?", value.strip().lower())
    if found is None:
        raise click.BadParameter("a size in bytes, kB or MB: 500kB, 1.5MB, 300000")
    return round(float(found[1]) * {"": 1, "k": 1e3, "m": 1e6, "g": 1e9}[found[2]])


@click.command(
    epilog="""\b
Examples:
  eigenfield encode photos/ -o scene.glb
  eigenfield encode photos/ --grid 5x4 --hold-out every:5 -o scene.glb
  eigenfield encode capture/ --proxy capture/proxy.ply -o scene.glb
  eigenfield encode photos/ --calibration refined.json --proxy proxy.ply --atlas 1024 -o scene.glb
  eigenfield encode photos/ --proxy mesh.obj --uv-ssim 0.98 --hold-out odd -o scene.glb
  eigenfield encode photos/ --proxy mesh.glb --codec png --align -o scene.glb
  eigenfield encode photos/ --proxy mesh.glb --fit photographs --quality 80 -o small.glb
  eigenfield encode photos/ --proxy mesh.glb --target-size 300kB -o small.glb"""
)
@click.argument("capture", type=click.Path(path_type=Path))
@click.option(
    "--proxy",
    type=click.Path(path_type=Path),
    metavar="MESH",
    help="Triangle mesh in the cameras' world: .ply, .obj or .glb.  [default: made from the photographs]",
)
@click.option(
    "--output", "-o", required=True, type=click.Path(path_type=Path), metavar="FILE", help="The .glb to write."
)
@capture_options
@click.option(
    "--textures",
    "-n",
    type=int,
    metavar="N",
    help="Eigen textures to keep; at most one less than there are cameras.  [default: 15; with --fit by the cameras]",
)
@click.option("--uv-ssim", type=float, metavar="S", help="Instead: as few as reach this SSIM in UV space (0.98, say).")
@click.option(
    "--density",
    type=float,
    default=1.5,
    show_default=True,
    metavar="D",
    help="Atlas texels per photograph pixel along one axis, in the central camera (side at most 4096, texels at "
    "most twice the photographs' pixels).",
)
@click.option("--atlas", callback=_atlas, metavar="N", help="Side of the atlas outright, or WIDTHxHEIGHT.")
@click.option(
    "--triangles",
    type=int,
    metavar="N",
    help="Triangles of the proxy, at most.  [default: 30000; a mesh that has an atlas is kept as it is, but that a fit "
    "simplifies a relief by what its pictures lose]",
)
@click.option(
    "--align",
    is_flag=False,
    flag_value="dis",
    type=click.Choice(["dis", "tvl1"]),
    metavar="[dis|tvl1]",
    help="Align the maps to the reference camera by optical flow; tvl1 is finer and much slower.",
)
@click.option(
    "--harmonise",
    is_flag=False,
    flag_value="gain",
    type=click.Choice(["gain", "affine"]),
    metavar="[gain|affine]",
    help="Take the cameras' differences of exposure and white balance out of the textures; affine fits offsets too. "
    "Captured views are drawn with their own exposure again.",
)
@click.option(
    "--metres-per-unit",
    type=float,
    metavar="F",
    help="Metres in one unit of the cameras' world: headsets then show the real size.  [default: as the capture says]",
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
    help="Pictures in the file: avif is lossy and small, webp and png keep 8 bits exactly.  [default: avif]",
)
@click.option(
    "--quality",
    type=click.IntRange(0, 100),
    metavar="Q",
    help="Quality of avif, 0 to 100.  [default: 70; of a fit the preset's]",
)
@click.option(
    "--fit",
    type=click.Choice(["none", "photographs"]),
    help="none: project the photographs into the textures, as the paper does. photographs: fit the textures until the "
    "drawn pictures match the photographs; smaller, better, takes minutes.  [default: none; photographs with a target]",
)
@click.option(
    "--preset",
    type=click.Choice(["small", "balanced", "best"]),
    default="balanced",
    show_default=True,
    help="Of a fit: how finely it is coded and how long it may take; --quality or a target instead of the first.",
)
@click.option(
    "--target-size",
    callback=_size,
    metavar="SIZE",
    help="The best file of at most this size (500kB, 1.5MB, 300000), by the quality of a fit.",
)
@click.option(
    "--target-psnr", type=float, metavar="DB", help="The smallest file with this PSNR, RGB, of captured views."
)
@click.option("--target-ssim", type=float, metavar="S", help="The smallest file with this SSIM of captured views.")
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
    help="Folder that keeps finished stages of the reconstruction; the same command goes on from there. "
    "[default: OUTPUT.work]",
)
@reconstruction_options
@click.option(
    "--blind",
    is_flag=True,
    help="Estimate proxy and cameras without the held-out photographs too: each only registers its own camera.",
)
@click.option("--overwrite", is_flag=True, help="Replace the output if it exists.")
@common_options
def command(
    capture: Path,
    proxy: Path | None,
    output: Path,
    calibration: Path | None,
    masks: Path | None,
    format: str | None,
    grid: tuple[int, int] | None,
    frame: str | None,
    textures: int | None,
    uv_ssim: float | None,
    density: float,
    atlas: int | tuple[int, int] | None,
    triangles: int | None,
    align: str | None,
    harmonise: str | None,
    metres_per_unit: float | None,
    reference: str | None,
    hold_out: str | None,
    resampling: str,
    codec: str | None,
    fit: str | None,
    preset: str,
    quality: int | None,
    target_size: int | None,
    target_psnr: float | None,
    target_ssim: float | None,
    keep_maps: Path | None,
    work: Path | None,
    overwrite: bool,
    quiet: bool,
    blind: bool,
    **settings: Any,
) -> None:
    """Turn the photographs in CAPTURE into one .glb.

    Cameras and proxy mesh are estimated where they are not given: CAPTURE is a folder of photographs, with or without a
    calibration (eigenfield inspect CAPTURE says what is found in it).
    """  # fmt: skip
    from eigenfield.capture import open_any, open_capture
    from eigenfield.files import mended, refuse_existing
    from eigenfield.format import parts, save
    from eigenfield.format.pictures import DEFAULT_CODEC, check_codec
    from eigenfield.mesh import Mesh
    from eigenfield.pipeline import Options, Target, check_options, encode

    started = time.monotonic()
    refuse_existing(output, overwrite)
    check_codec(codec or DEFAULT_CODEC, quality)
    target = None
    if any(value is not None for value in (target_size, target_psnr, target_ssim)):
        target = Target(target_size, target_psnr, target_ssim)
    fit = fit or ("none" if target is None else "photographs")
    if fit != "none" and codec is not None:
        raise OptionError("codec", "a fit codes its pictures itself (10-bit AVIF)", remedy="leave --codec out")
    if blind and hold_out is None:
        raise OptionError("blind", "--blind is about held-out photographs", remedy="say which with --hold-out")
    options = Options(
        textures, uv_ssim, density, atlas, align, reference, hold_out, resampling, harmonise, metres_per_unit, fit,
        preset, quality, target,
    )  # fmt: skip
    place: dict[str, Any] = {"calibration": calibration, "masks": masks, "format": format, "grid": grid, "frame": frame}
    with progress_bars(quiet) as progress:
        if proxy is not None:
            refuse_unused(settings, blind)
            light_field = open_capture(capture, **place)
            mesh: Path | Mesh = proxy
            scratch = work if work is not None else output.absolute().parent
            with mended(scratch):
                scratch.mkdir(parents=True, exist_ok=True)
            tell(light_field.problems, quiet)
        else:
            from eigenfield.reconstruction import DEFAULT_TRIANGLES, reconstruct

            scratch = work if work is not None else output.with_suffix(".work")
            opened = open_any(capture, work=scratch / "frames", **place)
            tell(opened.problems, quiet)
            check_options(opened, options)
            held = hold_out if blind else None
            made = reconstruct(
                opened,
                triangles=DEFAULT_TRIANGLES if triangles is None else triangles,
                work=scratch,
                blind=held,
                progress=progress,
                **settings,
            )
            light_field, mesh, triangles = made.light_field, made.mesh, None
            tell(light_field.problems[len(opened.problems) :], quiet)
            tell([*timings(made.seconds), *made.report.lines(made.light_field.names)], quiet)
        scene = encode(
            light_field, mesh, textures=textures, uv_ssim=uv_ssim, density=density, atlas=atlas, triangles=triangles,
            align=align, harmonise=harmonise, reference=reference, hold_out=hold_out, resampling=resampling,
            metres_per_unit=metres_per_unit, fit=fit, preset=preset, quality=quality, target=target,
            keep_maps=keep_maps, work=scratch, progress=progress,
        )  # fmt: skip
        kept = fit != "none"  # coded already
        save(scene, output, codec=codec, quality=None if kept else quality, overwrite=overwrite, progress=progress)
    sizes = parts(output)
    width, height = scene.settings["atlas"]
    photographs = scene.settings["photographs"]
    click.echo(
        f"{output}: {sizes['total'] / 1e6:.2f} MB, {scene.textures} eigen textures of {width}x{height} for "
        f"{photographs['count']} photographs ({photographs['bytes'] / 1e6:.1f} MB), "
        f"{len(scene.mesh.faces)} triangles, {time.monotonic() - started:.0f} s"
    )
