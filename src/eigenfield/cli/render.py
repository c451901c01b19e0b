"""`eigenfield render`."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from eigenfield.cli.common import PATH, common_options, note
from eigenfield.cli.drawing import (
    DEFAULT_FPS,
    ClipTime,
    flight_options,
    parse_place,
    picture_options,
    residual_option,
    stereo_options,
    time_option,
)
from eigenfield.cli.progress import progress_bars
from eigenfield.core.errors import OptionError
from eigenfield.runtime.objects import address_of


@click.command(
    epilog="""\b
Examples:
  eigenfield render scene.glb -o view.png
  eigenfield render scene.glb --at 0.3,-0.2 --resolution 1024x768 -o view.png
  eigenfield render scene.glb --camera out_08_08.jpg --background transparent -o view.png
  eigenfield render archive.glb --camera out_08_08.jpg --residual -o view.png
  eigenfield render clip.glb --time 1.25s --at 0.3,-0.2 -o view.png
  eigenfield render clip.glb --time 0s:2s --path circle -o clip.mp4
  eigenfield render scene.glb --path circle --frames 240 -o around.mp4
  eigenfield render scene.glb --path grid --frames 25 -o 'frames/%04d.png'
  eigenfield render scene.glb --stereo side-by-side --baseline 63mm -o eyes.png
  eigenfield render clip.glb --time 0s:2s --stereo vr180 -o clip.mp4"""
)
@click.argument("scene", type=PATH)
@click.option(
    "--output",
    "-o",
    required=True,
    type=PATH,
    metavar="FILE",
    help="A .png; for a path or a range of times an .mp4, or a .png with %04d in its name for single pictures.",
)
@click.option("--at", callback=parse_place, metavar="X,Y", help="Viewpoint in the array: 0,0 its middle, ±1 its edges.")
@click.option("--camera", metavar="NAME", help="A captured camera.  [default: the reference camera]")
@time_option
@flight_options
@stereo_options
@picture_options
@residual_option
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
@common_options
def command(
    scene: Path, output: Path, at: tuple[float, float] | None, camera: str | None, time: ClipTime | None,
    path: str | None, frames: int | None, fps: Fraction, stereo: str | None, baseline: tuple[float, bool] | None,
    residual: bool, overwrite: bool, quiet: bool, **picture: Any,
) -> None:  # fmt: skip
    """Draw SCENE: one picture, or a fly-through.

    The picture is that of a viewpoint in the array (--at), of a captured camera (--camera), or a path's. Of a clip
    --time names the frame, or a range of frames: they become a film, along the path if one is given.
    """
    from eigenfield.runtime.files import is_numbered, refuse_existing, write_bytes

    given = [name for name, value in (("--at", at), ("--camera", camera), ("--path", path)) if value is not None]
    if len(given) > 1:
        raise OptionError("viewpoint", f"{' and '.join(given)} exclude each other", remedy="give one of them")
    flight = path is not None or (time is not None and time.several)
    _check_output(output, flight, is_numbered(output))
    if path is None and frames is not None:
        raise OptionError("frames", "--frames needs --path", remedy="give a path, or leave it out")
    if frames is not None and time is not None and time.several:
        raise OptionError("frames", "a range of --time says how many pictures there are", remedy="leave --frames out")
    if flight and not is_numbered(output) and picture["background"] is None:
        raise OptionError("background", "a film cannot be transparent", remedy="name a colour, or write .png pictures")
    if baseline is not None and stereo is None:
        raise OptionError("baseline", "--baseline needs --stereo", remedy="say --stereo side-by-side, or leave it out")
    if residual and (at is not None or flight or stereo is not None):
        raise OptionError("residual", "only captured views have a residual", remedy="name a --camera, or leave it out")
    from eigenfield.encoding.residual.views import captured_pixels, difference_of
    from eigenfield.gltf import load
    from eigenfield.rendering import FLIGHT_FRAMES, RenderJob, camera_index, path_points, viewpoint, viewpoint_colour
    from eigenfield.rendering.render_jobs import png, refuse_flight, write_flight

    if stereo is not None:
        given_rate = click.get_current_context().get_parameter_source("fps") is ParameterSource.COMMANDLINE
        what = _render_stereo(
            scene, time, {"at": at, "camera": camera}, path, frames, output, fps if given_rate else None,
            (stereo, baseline), overwrite, quiet, picture,
        )  # fmt: skip
        note(f"wrote {address_of(output)}: {what}", quiet)
        return
    if time is not None and time.several:
        _render_over_time(scene, time, {"at": at, "camera": camera}, path, output, fps, overwrite, quiet, picture)
        return
    seconds = None if time is None else time.in_clip(scene)
    if path is not None:
        points = path_points(path, FLIGHT_FRAMES if frames is None else frames)
        refuse_flight(output, len(points), overwrite)
        job = RenderJob(load(scene, seconds), **picture)
        with progress_bars(quiet) as progress:
            write_flight(job, points, output, fps, overwrite=overwrite, progress=progress)
        note(f"wrote {address_of(output)}: {len(points)} pictures", quiet)
        return
    refuse_existing(output, overwrite)
    job = RenderJob(load(scene, seconds), **picture)
    if residual:
        index = job.scene.rig.reference if camera is None else camera_index(job.scene, camera)
        data = png(captured_pixels(job, index, difference_of(job.scene, index)))
    else:
        chosen = viewpoint(job.scene, at=at, camera=camera, weights=job.weights)
        data = job.png(*chosen, viewpoint_colour(job.scene, at=at, camera=camera))
    write_bytes(output, data, overwrite=overwrite)
    note(f"wrote {address_of(output)}", quiet)


def _render_over_time(
    scene: Path, time: ClipTime, place: dict[str, Any], path: str | None, output: Path, fps: Fraction, overwrite: bool,
    quiet: bool, picture: dict[str, Any],
) -> None:  # fmt: skip
    """Draw frames of a clip, from one place or along a path; at the clip's own rate unless --fps says another."""
    from eigenfield.gltf import load_clip
    from eigenfield.rendering import path_points
    from eigenfield.rendering.render_jobs import refuse_flight, write_clip_flight

    frames = time.frames(scene)
    refuse_flight(output, len(frames), overwrite)
    clip = load_clip(scene)
    places = [place] * len(frames) if path is None else [{"at": tuple(at)} for at in path_points(path, len(frames))]
    given = click.get_current_context().get_parameter_source("fps") is ParameterSource.COMMANDLINE
    rate = fps if given else clip.timeline.rate
    with progress_bars(quiet) as progress:
        write_clip_flight(clip, frames, places, output, rate, overwrite=overwrite, progress=progress, **picture)
    note(f"wrote {address_of(output)}: {len(frames)} pictures", quiet)


def _render_stereo(
    scene: Path, time: ClipTime | None, place: dict[str, Any], path: str | None, count: int | None, output: Path,
    fps: Fraction | None, stereo: tuple[str, tuple[float, bool] | None], overwrite: bool, quiet: bool,
    picture: dict[str, Any],
) -> str:  # fmt: skip
    """Draw what two eyes see, as a picture or as a film; what was made.

    Args:
        fps: None: the clip's own, or DEFAULT_FPS.
    """
    from eigenfield.gltf import load, load_clip
    from eigenfield.rendering import FLIGHT_FRAMES, RenderJob, path_points, viewpoint
    from eigenfield.rendering.render_jobs import png, refuse_flight
    from eigenfield.rendering.stereo import Baseline, Eyes, write_stereo
    from eigenfield.runtime.files import write_bytes

    layout, baseline = stereo
    numbers = time.frames(scene) if time is not None and time.several else None
    points = None
    if path is not None:
        count = FLIGHT_FRAMES if count is None else count
        points = [tuple(at) for at in path_points(path, count if numbers is None else len(numbers)).tolist()]
    refuse_flight(output, 1 if points is None and numbers is None else len(numbers or points or ()), overwrite)
    clip = None if numbers is None else load_clip(scene)
    seconds = None if time is None or clip is not None else time.in_clip(scene)
    if clip is None or numbers is None:
        first = load(scene, seconds)
    else:
        first = clip.scene(float(clip.timeline.times[numbers.start]))
    eyes = Eyes.of(first, layout, None if baseline is None else Baseline(*baseline))
    if points is None:
        centre = viewpoint(first, **place)[0].centre
        points = [place["at"] or tuple(first.rig.view_plane.coordinates([centre])[0].tolist())] * len(numbers or [0])
    said = eyes.said(first)
    if numbers is None and path is None:
        write_bytes(output, png(eyes.pixels(RenderJob(first, **picture), points[0])), overwrite=overwrite)
        return said
    sound = None
    if clip is None or numbers is None:
        job = RenderJob(first, **picture)
        views = ((job, at) for at in points)
    else:
        times = clip.timeline.times[numbers.start : numbers.stop]
        scenes = (clip.scene(float(time)) for time in times)
        views = ((RenderJob(one, **picture), at) for one, at in zip(scenes, points, strict=True))
        if clip.audio is not None and fps in (None, clip.timeline.rate):
            sound = clip.audio.data, float(times[0]) - clip.audio.first
    rate = fps or (Fraction(DEFAULT_FPS) if clip is None else clip.timeline.rate)
    with progress_bars(quiet) as progress:
        write_stereo(
            views, len(points), eyes, output, rate, one_thread=picture["renderer"] == "opengl", sound=sound,
            overwrite=overwrite, progress=progress,
        )  # fmt: skip
    return f"{len(points)} pictures; {said}"


def _check_output(output: Path, flight: bool, numbered: bool) -> None:
    kind = output.suffix.lower()
    if kind not in (".png", ".mp4"):
        raise OptionError("output-kind", f"{output}: the output is a .png or an .mp4", remedy="name it so")
    if not flight and (kind == ".mp4" or numbered):
        raise OptionError("output-kind", f"{output}: one picture makes no film", remedy="give --path, or name a .png")
    if flight and kind == ".png" and not numbered:
        raise OptionError(
            "output-kind",
            f"{output}: a path, or a range of times, makes many pictures",
            remedy="name an .mp4, or a .png with %04d in its name",
        )
