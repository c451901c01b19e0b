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
from eigenfield.core.errors import OptionError


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
  eigenfield encode photos/ --proxy mesh.obj --fit none --uv-ssim 0.98 -o scene.glb
  eigenfield encode photos/ --proxy mesh.glb --fit none --codec png -o scene.glb
  eigenfield encode photos/ --proxy mesh.glb --preset small -o small.glb
  eigenfield encode photos/ --proxy mesh.glb --target-size 300kB -o small.glb
  eigenfield encode photos/ --proxy mesh.glb --residual 70 -o archive.glb"""
)
@click.argument("capture", type=click.Path(path_type=Path))
@click.option(
    "--proxy",
    type=click.Path(path_type=Path),
    metavar="MESH",
    help="Triangle mesh in the cameras' world: .ply, .obj, .glb, .gltf, .stl or .off.  "
    "[default: made from the photographs]",
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
    help="Eigen textures, at most one less than there are cameras. A fit keeps those that are worth their bytes, and "
    "regions of much error may get as many again.  [default: half as many as cameras, 20 to 96; unfitted 15]",
)
@click.option(
    "--uv-ssim",
    type=float,
    metavar="S",
    help="As few eigen textures as reach this SSIM in UV space, for example 0.98; without a fit.",
)
@click.option(
    "--density",
    type=float,
    metavar="D",
    help="Atlas texels per photograph pixel along one axis, in the central camera (side at most 4096, texels at "
    "most twice the photographs' pixels).  [default: 1.5; of a fit 0.9 to 1.5, what its quality pays for]",
)
@click.option("--atlas", callback=_atlas, metavar="N", help="Side of the atlas outright, or WIDTHxHEIGHT.")
@click.option(
    "--triangles",
    type=int,
    metavar="N",
    help="Triangles of the proxy, at most.  [default: a fit keeps what the pictures are worth; with --fit none 30000, "
    "a mesh that has an atlas as it is]",
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
    help="Cameras to leave out and measure later: odd (those in odd rows or odd columns of a grid, counted from 0: "
    "three quarters), every:K (every K-th), or names with commas between.",
)
@click.option(
    "--resampling",
    type=click.Choice(["bicubic", "lanczos", "bilinear"]),
    help="Filter from photograph to atlas.  [default: bicubic]",
)
@click.option(
    "--codec",
    type=click.Choice(["avif", "webp", "png"]),
    help="Pictures of a file that is not fitted: avif is lossy, webp and png keep 8 bits exactly.  [default: avif]",
)
@click.option(
    "--quality",
    type=click.IntRange(0, 100),
    metavar="Q",
    help="Quality of the pictures, 0 to 100.  [default: the preset's; 70 without a fit]",
)
@click.option(
    "--fit",
    type=click.Choice(["none", "photographs"]),
    help="photographs: fit the textures until the drawn pictures match the photographs. none: project the photographs "
    "into the textures, as the paper does; faster, larger, less sharp. --align, --uv-ssim, --harmonise, --resampling, "
    "--codec and --keep-maps are about texture maps, which a fit does not make.  [default: photographs, unless one of "
    "these is given]",
)
@click.option(
    "--preset",
    type=click.Choice(["small", "balanced", "best"]),
    help="Of a fit: how finely it is coded (quality 79, 89, 95) and how long it may take; --quality or a target "
    "instead of the first. best codes with libaom, in about 10 % fewer bytes and far more time, where there is an "
    "ffmpeg program that has it.  "
    "[default: balanced]",
)
@click.option(
    "--planes",
    type=click.Choice(["luma-chroma", "rgb"]),
    help="Of a fit: luma and chroma apart, each with its own mean, textures and densities, or R, G and B together.  "
    "[default: luma-chroma]",
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
    "--residual",
    is_flag=False,
    flag_value="40",
    type=click.IntRange(0, 100),
    metavar="[Q]",
    help="For archives: also keep what captured views lack, as a film of quality Q, 0 (coarse) to 100 (near-lossless); "
    "40 unless said. Other views gain nothing by it. With few bytes a small base is best: --fit photographs "
    "--textures 24 --quality 86, and as many bytes for the film as are left.",
)
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
    "[default: OUTPUT with the ending .work; with --proxy its folder, for scratch files]",
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
    density: float | None,
    atlas: int | tuple[int, int] | None,
    triangles: int | None,
    align: str | None,
    harmonise: str | None,
    metres_per_unit: float | None,
    reference: str | None,
    hold_out: str | None,
    resampling: str | None,
    codec: str | None,
    fit: str | None,
    preset: str | None,
    planes: str | None,
    quality: int | None,
    target_size: int | None,
    target_psnr: float | None,
    target_ssim: float | None,
    residual: int | None,
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
    from eigenfield.coding.pictures.pictures_8bit import DEFAULT_CODEC, check_codec
    from eigenfield.core.mesh import Mesh
    from eigenfield.encoding.encode import Options, Target, check_options, encode
    from eigenfield.encoding.residual import check_residual, with_residual
    from eigenfield.gltf import encode_scene, parts, read_scene, save
    from eigenfield.runtime.files import mended, refuse_existing

    started = time.monotonic()
    refuse_existing(output, overwrite)
    check_codec(codec or DEFAULT_CODEC, quality)
    target = None
    if any(value is not None for value in (target_size, target_psnr, target_ssim)):
        target = Target(target_size, target_psnr, target_ssim)
    if residual is not None and target is not None:
        raise OptionError(
            "residual",
            "a target is about the textures, and a residual comes on top of them",
            remedy="say --quality and --residual Q instead",
        )
    if blind and hold_out is None:
        raise OptionError("blind", "--blind is about held-out photographs", remedy="say which with --hold-out")
    options = Options(
        textures, uv_ssim, density, atlas, align, reference, hold_out, resampling, harmonise, metres_per_unit, fit,
        preset, quality, target, keep_maps, codec, planes,
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
        if residual is not None:
            check_residual(light_field.cameras, residual)
        scene = encode(
            light_field, mesh, textures=textures, uv_ssim=uv_ssim, density=density, atlas=atlas, triangles=triangles,
            align=align, harmonise=harmonise, reference=reference, hold_out=hold_out, resampling=resampling,
            metres_per_unit=metres_per_unit, fit=options.fit, preset=preset, planes=planes, quality=quality,
            target=target, keep_maps=keep_maps, work=scratch, progress=progress,
        )  # fmt: skip
        kept = options.fit != "none"  # coded already
        if residual is not None:
            read = read_scene(encode_scene(scene, codec=codec, quality=None if kept else quality, progress=progress))
            scene, kept = with_residual(read, light_field, residual, progress), True
        coded: dict[str, Any] = {} if kept else {"codec": codec, "quality": quality}
        save(scene, output, **coded, overwrite=overwrite, progress=progress)
    sizes = parts(output)
    width, height = scene.settings["atlas"]
    photographs = scene.settings["photographs"]
    click.echo(
        f"{output}: {sizes['total'] / 1e6:.2f} MB, {scene.textures} eigen textures, atlas {width}x{height}, for "
        f"{photographs['count']} photographs ({photographs['bytes'] / 1e6:.1f} MB), "
        f"{len(scene.mesh.faces)} triangles, {time.monotonic() - started:.0f} s"
    )
