"""`eigenfield encode`."""

from __future__ import annotations

import logging
import re
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from eigenfield.cli.capture_options import (
    BY_HAND,
    capture_argument,
    capture_options,
    open_for_work,
    reconstruct_capture,
    surface_options,
)
from eigenfield.cli.clip import encode_clip, refuse_clip_output, refuse_for_clips
from eigenfield.cli.common import PATH, chosen_workers, common_options, note, note_all, worker_options
from eigenfield.cli.draft import Window, draft_lines, draft_of
from eigenfield.cli.field_options import field_options, from_fields
from eigenfield.cli.leave_out import leave_out, leave_out_option
from eigenfield.cli.progress import StepProgress, duration_range, progress_bars
from eigenfield.core.errors import OptionError
from eigenfield.core.open_options import OpenOptions
from eigenfield.core.shell import shell_word
from eigenfield.encoding import EncodeOptions
from eigenfield.encoding.target import parse_bitrate, parse_size
from eigenfield.reconstruction import SurfaceOptions

if TYPE_CHECKING:
    from eigenfield.capture import Capture, LightField
    from eigenfield.core.progress import Progress
    from eigenfield.core.scene import Scene

log = logging.getLogger("eigenfield.encode")


def parse_atlas(context: click.Context, parameter: click.Parameter, value: str | None) -> int | tuple[int, int] | None:
    if value is None:
        return None
    found = re.fullmatch(r"(-?\d+)(?:x(-?\d+))?", value.lower())
    if found is None:
        raise click.BadParameter("a side (1024) or WIDTHxHEIGHT (2048x1024)")
    return int(found[1]) if found[2] is None else (int(found[1]), int(found[2]))


def parse_target_bitrate(context: click.Context, parameter: click.Parameter, value: str | None) -> int | None:
    return None if value is None else parse_bitrate(value)


def parse_target_size(context: click.Context, parameter: click.Parameter, value: str | None) -> int | None:
    return None if value is None else parse_size(value)


GROUPS = {  # of options in the help, those of every day first; the empty one has what no other names
    "Common options": ("output", "draft", "look", "preset", "target_size", "proxy", "calibration", "grid", "without",
                       "overwrite"),
    "What the capture is": (
        "format", "quilt", "pattern", "frame", "walk_frames", "masks", "reference", "metres_per_unit",
    ),
    "Clips": ("clip", "offset", "rate", "group", "audio", "target_bitrate"),
    "Quality and size": (
        "quality", "target_psnr", "target_ssim", "hold_out", "blind", "density", "atlas", "harmonise", "residual",
        "fallback",
    ),
    "Estimated cameras and mesh": (
        "surface", "layers", "refine", "background", "primitives", "fit_spheres", "triangles",
    ),
    "Rights": ("rights_title", "rights_author", "rights_licence", "rights_source"),
    "How it runs": ("work", "threads", "workers", "cluster", "quiet", "progress"),
    "Other options": (),
    "The paper's way: texture maps instead of a fit": (
        "fit", "textures", "uv_ssim", "align", "max_angle", "codec", "keep_maps",
    ),
}  # fmt: skip


class _Grouped(click.Command):
    """Shows its options by `GROUPS`."""

    def format_options(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        options = [option for option in self.get_params(context) if isinstance(option, click.Option)]
        lines = {option.name: option.get_help_record(context) for option in options}
        named = {name for names in GROUPS.values() for name in names}
        for title, names in GROUPS.items():
            shown = [lines[name] for name in names or (name for name in lines if name not in named)]
            with formatter.section(title):
                formatter.write_dl([line for line in shown if line is not None])


@click.command(
    cls=_Grouped,
    epilog="""\b
Examples:
  eigenfield encode photos/
  eigenfield encode photos/ -o scene.glb
  eigenfield encode photos/ --draft
  eigenfield encode photos/ --view
  eigenfield encode photos/ --grid 5x4 -o scene.glb
  eigenfield encode walk.mp4 --walk-frames 60 -o scene.glb
  eigenfield encode photos/ --calibration sparse/0 -o scene.glb
  eigenfield encode capture/ --proxy capture/proxy.ply -o scene.glb
  eigenfield encode photos/ --target-size 300kB -o small.glb
  eigenfield encode photos/ --hold-out every:5 -o scene.glb
  eigenfield encode photos/ --residual 70 -o archive.glb
  eigenfield encode footage/ --clip 0:2s -o clip.glb
  eigenfield encode footage/ --clip 0:2s --proxy 'mesh_%04d.ply' -o clip.glb
  eigenfield encode footage/ --clip --audio sound.opus -o clip.glb
  eigenfield encode photos/ --proxy mesh.obj --fit none --uv-ssim 0.98 -o paper.glb""",
)
@capture_argument()
@click.option(
    "--proxy",
    type=PATH,
    metavar="MESH",
    help="A .ply, .obj, .glb, .gltf, .stl or .off file in the cameras' world; of a clip m_%04d.ply.",
)
@click.option(
    "--output",
    "-o",
    type=PATH,
    metavar="FILE",
    help="The .glb to write.  [default: the capture's name and .glb, in the current folder]",
)
@capture_options
@leave_out_option
@field_options(EncodeOptions, atlas=parse_atlas, target_size=parse_target_size, target_bitrate=parse_target_bitrate)
@click.option(
    "--work",
    type=PATH,
    metavar="DIR",
    help="Folder, or s3://BUCKET/NAME, that keeps finished steps: the same command goes on from there.  "
    "[default: OUTPUT with the ending .work; with --proxy the folder of OUTPUT]",
)
@worker_options
@surface_options("surface", "layers", *BY_HAND)
@click.option(
    "--blind",
    is_flag=True,
    help="Keep held-out photographs out of cameras and mesh, too. Where cameras are estimated, each then finds its own "
    "in the finished scene, and is left out if it cannot.",
)
@click.option(
    "--audio",
    type=PATH,
    metavar="FILE",
    help="Sound of a clip: an Ogg file of Opus, kept as it is, which begins with the footage.",
)
@click.option(
    "--draft",
    is_flag=True,
    help="Only a first look, in about half a minute.",
)
@click.option(
    "--view",
    "look",
    is_flag=True,
    help="Look around in a draft meanwhile, in a browser.",
)
@click.option("--overwrite", is_flag=True, help="Replace the output if it exists.")
@common_options
def command(
    capture: Path,
    proxy: Path | None,
    output: Path | None,
    place: OpenOptions,
    without: str | None,
    work: Path | None,
    draft: bool,
    look: bool,
    overwrite: bool,
    quiet: bool,
    blind: bool,
    workers: int | None,
    cluster: str | None,
    audio: Path | None,
    **settings: Any,
) -> None:
    """Turn photographs into one .glb in which you can look around.

    CAPTURE is a folder of photographs, a zip of them, or a video of a walk. Cameras and mesh are estimated unless you
    give them. `eigenfield inspect CAPTURE` says what will be used.
    The last three lines say how small and how good the file is, and which command comes next; -v says more.
    """
    from eigenfield.encoding import encode
    from eigenfield.encoding.estimated import surface_to_make
    from eigenfield.encoding.views import check_selection
    from eigenfield.gltf import refuse_output, save
    from eigenfield.proxy import refuse_no_mesh
    from eigenfield.proxy.meshes.sequence import is_sequence, mesh_files
    from eigenfield.reconstruction.whole import check_settings
    from eigenfield.runtime.objects import find_objects

    started = time.monotonic()
    whole = default_output(capture) if output is None else output
    output = whole.with_suffix(".draft.glb") if draft and output is None else whole
    (refuse_output if place.clip is None else refuse_clip_output)(output, overwrite)
    if is_sequence(proxy):
        if place.clip is None:
            message, remedy = "--proxy names a mesh for each frame", "say --clip, or name one mesh"
            raise OptionError("sequence-unused", message, remedy=remedy)
        mesh_files(cast("Path", proxy))
    elif proxy is not None:
        refuse_no_mesh(proxy)
    options = from_fields(EncodeOptions, settings)
    if place.clip is None:
        options.refuse_clip_options()
        if audio is not None:
            raise OptionError("audio-unused", "--audio is about clips", remedy="say --clip, or leave it out")
    if place.clip is not None:
        refuse_for_clips({"draft": draft, "view": look, "blind": blind})
        given, stages = from_fields(SurfaceOptions, settings), work or whole.with_suffix(".work")
        encode_clip(
            capture, proxy, place, options, given, without, stages, output, overwrite, quiet, workers, cluster, audio
        )
        return
    projected = options.resolved().fit == "none"
    surface = surface_to_make(
        options,
        from_fields(SurfaceOptions, settings),
        blind,
        has_proxy=proxy is not None,
        others={"workers": workers, "cluster": cluster},
    )
    with Window(output.name, quiet) as window:
        with chosen_workers(workers, cluster) as reached, progress_bars(quiet) as progress:
            kept = work or (None if find_objects(output) else output.absolute().parent)
            scratch = work or whole.with_suffix(".work")
            if surface is None:
                opened: Capture = leave_out(_open_capture(capture, place, kept, quiet), without, quiet)
            else:
                opened = leave_out(open_for_work(capture, place, scratch, quiet), without, quiet)
                check_selection(opened, options)
                check_settings(opened, surface)
            first = draft_of(opened, proxy, options, surface, progress, quiet) if draft or look else None
            if first is not None and draft:
                scene, lines = first, draft_lines
            else:
                refuse_output(output := whole, overwrite)
                announce(opened, options, surface, progress)
                if first is not None:
                    window.show_draft(first, progress)
                for_maps = reached if projected else None
                if surface is None:
                    scene = encode(opened, proxy, options, work=kept, workers=for_maps, progress=progress)
                else:
                    result = reconstruct_capture(opened, surface, scratch, progress, quiet, reached, atlas=projected)
                    log.info("%s", "\n".join(result.report.lines(result.light_field.names)))
                    scene = encode(
                        result.light_field, result.proxy, options, triangles=None, hold_out=result.hold_out,
                        work=scratch, workers=for_maps, progress=progress,
                    )  # fmt: skip
                lines = last_lines
            save(scene, output, **options.for_save, overwrite=overwrite, progress=progress)
        log.info("%.0f s", time.monotonic() - started)
        click.echo("\n".join(lines(output, scene)))
        if look:
            window.show(output)
            window.wait()


def default_output(capture: Path) -> Path:
    """The file of a capture whose output is not named: in the current folder.

    Args:
        capture: A folder, a file, or an address.
    """
    named = capture if capture.name not in ("", "..") else capture.resolve()
    name = named.name if named.is_dir() else named.stem
    return Path(f"{name or 'scene'}.glb")


def last_lines(output: Path, scene: Scene) -> list[str]:
    """How small and how good a file is, and the command that comes next; statistics are logged."""
    from eigenfield.encoding.verdict import score_words, verdict_of_scores
    from eigenfield.gltf import parts
    from eigenfield.runtime.objects import address_of

    total, photographs = parts(output)["total"], scene.settings["photographs"]
    width, height = scene.settings["atlas"]
    log.info(
        "%d eigen textures, atlas %dx%d, %d triangles, for %d photographs (%.1f MB)", scene.appearance.textures,
        width, height, len(scene.proxy.mesh.faces), photographs["count"], photographs["bytes"] / 1e6,
    )  # fmt: skip
    ratio = photographs["bytes"] / total
    smaller = f"{ratio:.0f} times smaller than" if ratio >= 9.5 else f"{ratio:.1f} times smaller than"
    if ratio < 1:
        smaller = "larger than"
    figures = "".join(f", {words}" for words in score_words(scene.scores))
    word = verdict_of_scores(scene.scores) or "no verdict: `eigenfield evaluate SCENE CAPTURE` measures more"
    return [
        f"{address_of(output)}: {total / 1e3:,.0f} kB, {smaller} the photographs{figures}",
        str(word),
        f"look around in it: eigenfield view {shell_word(address_of(output))}",
    ]


def announce(
    capture: Capture, options: EncodeOptions, surface: SurfaceOptions | None, progress: Progress | None
) -> None:
    """Say what an encode is expected to take, and how it goes on if it is stopped; nothing without a progress.

    Args:
        surface: That is made; None: the proxy is given.
        progress: Of `progress_bars`, which then counts the steps.
    """
    from eigenfield.capture.messages import count_phrase
    from eigenfield.encoding.cost import STEPS, expected_cost
    from eigenfield.runtime.parallel import threads

    if not isinstance(progress, StepProgress):
        return
    count = threads()
    cost = expected_cost(capture, options, surface, count)
    pixels = sum(width * height for width, height in capture.sizes)
    layered = f", or {duration_range(cost.layered_seconds)} if layers turn out to be better" if cost.layered else ""
    note(
        f"{len(capture.sizes)} photographs, {pixels / 1e6:.1f} megapixels: {duration_range(cost.seconds)} "
        f"with {count_phrase(range(count), 'thread', 'threads')}{layered}; {cost.memory / 1e9:.1f} GB of memory, "
        f"{cost.scratch / 1e6:.0f} MB of scratch files"
    )
    if surface is not None:
        note("Ctrl-C stops it; the same command goes on after the last finished step")
    stages = {name: step.stages for name, step in STEPS.items()}
    progress.plan(cost.steps, {name: step.words for name, step in STEPS.items()}, cost.layered, stages)


def _open_capture(capture: Path, place: OpenOptions, scratch: Path | None, quiet: bool) -> LightField:
    """A calibrated capture, and a folder for scratch files."""
    from eigenfield.capture import open_capture
    from eigenfield.runtime.files import make_folder
    from eigenfield.runtime.objects import find_objects

    light_field = open_capture(capture, place)
    if scratch is not None and not find_objects(scratch):
        make_folder(scratch)
    note_all(light_field.problems, quiet)
    return light_field
