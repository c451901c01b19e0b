"""`eigenfield encode --clip`: footage in, a clip out."""

from __future__ import annotations

import logging
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.common import chosen_workers, note, note_all
from eigenfield.cli.leave_out import leave_out_cameras
from eigenfield.cli.progress import progress_bars
from eigenfield.core.errors import OptionError
from eigenfield.core.open_options import OpenOptions
from eigenfield.core.shell import shell_word
from eigenfield.encoding import EncodeOptions
from eigenfield.reconstruction import SurfaceOptions

if TYPE_CHECKING:
    from eigenfield.core.clip import Clip

log = logging.getLogger("eigenfield.encode")


def refuse_for_clips(given: dict[str, Any]) -> None:
    """Raise OptionError `clip-option` for an option that is for one instant."""
    for name, value in given.items():
        if value:
            remedy = "leave it out, or encode one instant without --clip"
            raise OptionError("clip-option", f"--{name} is for scenes of one instant", remedy=remedy)


def refuse_clip_output(output: Path, overwrite: bool) -> None:
    """Before any work: check that a clip may be written, as a .glb or, under a name without an ending, as a folder.
    OptionError, OutputError as `refuse_output`, `refuse_folder`."""
    from eigenfield.gltf import refuse_output
    from eigenfield.viewer.exports import refuse_folder

    (refuse_output if output.suffix else refuse_folder)(output, overwrite)


def encode_clip(
    capture: Path,
    proxy: Path | None,
    place: OpenOptions,
    options: EncodeOptions,
    surface: SurfaceOptions,
    without: str | None,
    work: Path,
    output: Path,
    overwrite: bool,
    quiet: bool,
    workers: int | None,
    cluster: str | None,
    audio: Path | None,
) -> None:
    """Footage in, a clip out: a .glb, or a folder where the output's name has no ending."""
    from eigenfield.capture import open_footage
    from eigenfield.capture.messages import count_phrase
    from eigenfield.encoding import encode_footage
    from eigenfield.encoding.clip.encode import refuse_still_options
    from eigenfield.encoding.clip.still import surface_of_clip
    from eigenfield.gltf import save
    from eigenfield.viewer.exports import write_clip_folder

    started = time.monotonic()
    refuse_still_options(options)
    surface_of_clip(options, surface, proxy is not None)  # raises
    with chosen_workers(workers, cluster) as reached, progress_bars(quiet) as progress:
        found = open_footage(capture, options=replace(place, work=work / "frames"))
        note_all(found.problems, quiet)
        footage = leave_out_cameras(found, without, quiet)
        frames = count_phrase(range(len(footage)), "frame", "frames")
        note(f"{len(footage.names)} cameras, {frames} at {float(footage.timeline.rate):g} a second", quiet)
        note("Ctrl-C stops it; the same command goes on after the last finished frame", quiet)
        clip = encode_footage(
            footage, proxy, options, surface_options=surface, audio=audio, work=work, workers=reached, progress=progress
        )
        if output.suffix:
            save(clip, output, overwrite=overwrite, progress=progress)
        else:
            write_clip_folder(clip, output, overwrite=overwrite)
    log.info("%.0f s", time.monotonic() - started)
    click.echo("\n".join(clip_lines(output, clip)))


def clip_lines(output: Path, clip: Clip) -> list[str]:
    """How small a clip is, and the command that comes next."""
    from eigenfield.gltf import parts
    from eigenfield.runtime.objects import address_of

    size, seconds = parts(output)["total"], clip.timeline.frames / float(clip.timeline.rate)
    frames = clip.timeline.frames
    return [
        f"{output}: {size / 1e3:,.0f} kB, {frames} frames of {size / frames / 1e3:.1f} kB, "
        f"{8 * size / seconds / 1e6:.2f} Mbit/s",
        f"look around in it: eigenfield view {shell_word(address_of(output))}",
    ]
