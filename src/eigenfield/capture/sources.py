"""What is read of a capture: its format found, then its photographs with their cameras or their names."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from eigenfield.capture.archive import is_zip, unpack
from eigenfield.capture.arrangement import Arrangement
from eigenfield.capture.calibration import Calibration, Entry
from eigenfield.capture.footage_forms import is_timed
from eigenfield.capture.formats import FORMATS, Claim, Format, claim_of_file, detect_format, format_by_name
from eigenfield.capture.inspect_photographs import common_focal_length, make_photo_set
from eigenfield.capture.lightfield import LightField
from eigenfield.capture.locate import IMAGES_FOLDER, photograph_root, photographs_in
from eigenfield.capture.messages import Note, count_phrase, list_names
from eigenfield.capture.pairing import pair_photographs
from eigenfield.capture.passed_over import describe_passed_over
from eigenfield.capture.photographs.exr import choose_exposure
from eigenfield.capture.photographs.kinds import VIDEO_EXTENSIONS, is_linear
from eigenfield.capture.photoset import UNPACKED_FORMATS, Capture, PhotoSet
from eigenfield.capture.readers.grid_names import compile_pattern
from eigenfield.capture.readers.video import is_video_rig, read_videos
from eigenfield.capture.unread import describe_unread
from eigenfield.core.camera_names import name_key
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.open_options import OpenOptions
from eigenfield.core.recognise import refuse_address
from eigenfield.core.shell import shell_word
from eigenfield.runtime.objects import local_copy

StrPath = str | os.PathLike[str]
C = TypeVar("C", LightField, PhotoSet, Capture)
PATTERN_FORMAT = "grid"  # which --pattern means
NAME_FORMATS = tuple(row for row in FORMATS if row.read_names is not None)


@dataclass(frozen=True)
class CaptureSource:
    """What is to be read.

    Attributes:
        videos: The cameras are of videos, one a camera.
    """

    claim: Claim
    root: Path
    options: OpenOptions
    videos: bool


def find_source(path: StrPath, options: OpenOptions, formats: tuple[Format, ...]) -> CaptureSource | None:
    """What is to be read of a path, by the formats that are meant; None where none of them fits."""
    if options.clip is not None or options.offset or options.rate is not None:
        given = "--clip" if options.clip is not None else "--offset" if options.offset else "--rate"
        remedy = "leave it out" if options.clip is not None else "say --clip too, or leave it out"
        raise OptionError(
            "clip-unused", f"{given} is of footage, and photographs of one instant are read", remedy=remedy
        )
    name, calibration = options.format, options.calibration
    root = local_copy(path)
    root = unpack(root, options.work) if is_zip(root) else root
    if options.pattern is not None:
        compile_pattern(options.pattern)
        name = PATTERN_FORMAT if name is None else name
    if name is not None:
        formats = _restrict_formats(format_by_name(name), formats)
    if calibration is not None:
        if not root.is_dir():
            raise CaptureError("capture-missing", "is no folder of photographs", path=root, remedy="check the path")
        formats = tuple(row for row in formats if row.read_cameras is not None)
        if not formats:
            raise OptionError(
                "format-cameras", f"--format {name} reads no calibration", remedy="leave out one of the two options"
            )
        claim = find_claim(local_copy(calibration), formats, options)
        if claim is None:
            raise no_cameras(Path(calibration))
    else:
        claim = find_claim(root, formats, options)
        if claim is None and name is not None:
            raise CaptureError(
                "format-missing",
                f"holds nothing of the format {name} ({formats[0].title})",
                path=root,
                remedy="leave out --format, or name the folder or file that holds it",
            )
        if claim is None:
            return None
        if claim.format.read_cameras is not None:
            root = photograph_root(root, claim.found)
    videos = claim.format.read_cameras is not None and is_video_rig(root)
    _refuse_unused(claim, replace(options, frame=None) if videos else options)
    return CaptureSource(claim, root, options, videos)


def _restrict_formats(row: Format, formats: tuple[Format, ...]) -> tuple[Format, ...]:
    if row not in formats:
        raise OptionError(
            "format-cameras",
            f"--format {row.name} reads cameras, and photographs without them are wanted here",
            remedy=f"say one of {', '.join(other.name for other in formats)}",
        )
    return (row,)


def find_claim(path: Path, formats: tuple[Format, ...], options: OpenOptions) -> Claim | None:
    """The format of a folder or a file; CaptureError `capture-missing` where there is none."""
    if not path.exists():
        refuse_address(path)
        raise CaptureError("capture-missing", "does not exist", path=path, remedy="check the path")
    if path.is_file():
        return claim_of_file(path, formats, options)
    if len(formats) == 1 and formats[0].read_names is not None:  # asked for: taken at the word
        return Claim(formats[0], path)
    return detect_format(path, formats, options)


def _refuse_unused(claim: Claim, options: OpenOptions) -> None:
    """Options that would change nothing are an error: who gives one expects something of it."""
    for name in ("grid", "quilt", "frame", "walk_frames", "pattern"):
        if getattr(options, name) is not None and name not in claim.format.uses:
            option = name.replace("_", "-")
            raise OptionError(
                f"{option}-unused",
                f"--{option} means nothing to a capture of the format {claim.format.name} ({claim.format.title})",
                remedy="leave it out, or name another --format",
            )


def read_arrangement(source: CaptureSource) -> Arrangement:
    """What the names of a source's photographs say."""
    assert source.claim.format.read_names is not None
    arrangement = source.claim.format.read_names(source.claim.found, source.options)
    return replace(arrangement, problems=(*source.claim.problems, *arrangement.problems))


def masks_folder(options: OpenOptions) -> Path | None:
    """The folder of masks that is named, on this machine."""
    return None if options.masks is None else local_copy(options.masks)


def open_source(source: CaptureSource) -> Capture:
    """The capture of a source: a light field where cameras are known."""
    row, options = source.claim.format, source.options
    if row.read_cameras is not None:
        root, lines = source.root, source.claim.problems
        if source.videos:
            frames = read_videos(root, options)
            root, lines = frames.files[0].parent, (*lines, *frames.problems)
        read = row.read_cameras(source.claim.found, root)
        if is_timed(read):
            lines = (*lines, "its entries are of several times, and each is taken for a camera; --clip reads footage")
        read = replace(read, problems=(*lines, *read.problems))
        if source.videos:
            read = _of_frames(read, {name_key(file.stem) for file in frames.files})
        apart = options.calibration is not None
        return pair_photographs(read, root, apart=apart, masks=masks_folder(options), strict=options.strict)
    arrangement = read_arrangement(source)
    if arrangement.calibration is None:
        return make_photo_set(arrangement, source.root, masks=masks_folder(options), strict=options.strict)
    read = replace(arrangement.calibration, problems=arrangement.problems)
    light_field = pair_photographs(read, source.root, apart=False, masks=masks_folder(options), strict=options.strict)
    assert arrangement.layout is not None
    index = {file.name: i for i, file in enumerate(arrangement.files)}
    layout = arrangement.layout.subset([index[view.path.name] for view in light_field.views])
    focal = common_focal_length([float(camera.K[0, 0]) for camera in light_field.cameras])
    return replace(light_field, layout=replace(layout, focal=focal))


def _of_frames(read: Calibration, stems: set[str]) -> Calibration:
    """A calibration whose entries name videos, as one of the frames that were taken out of them under their names.

    Args:
        stems: Of the frames' names, by `name_key`.
    """

    def rename(entry: Entry) -> Entry:
        if not entry.file.lower().endswith(VIDEO_EXTENSIONS):
            return entry
        whole = name_key(entry.file.rsplit("/", 1)[-1]) in stems  # of two videos that differ by their ending alone
        return replace(entry, file=f"{entry.file}.png" if whole else entry.file[: entry.file.rindex(".")])

    return replace(read, entries=tuple(map(rename, read.entries)))


def finish(opened: C) -> C:
    """The capture with one exposure for its linear values, and lines about that and about what lies beside it."""
    lines: list[str] = _unread_lines(opened)
    linear = [source.path for source in opened.sources if is_linear(source.path)]
    if linear:
        exposure = choose_exposure(linear)
        opened = opened.with_exposure(exposure)
        which = count_phrase(linear, "photograph has", "photographs have")
        lines.append(Note(f"{which} linear values (OpenEXR): taken times {exposure:.4g}, then by the sRGB curve"))
    return replace(opened, problems=(*opened.problems, *lines))


def _unread_lines(opened: Capture) -> list[str]:
    """Lines about files beside the photographs; beside a calibration, or videos, only other photographs are missed."""
    folders = {opened.root, opened.root / IMAGES_FOLDER, *(source.path.parent for source in opened.sources)}
    return describe_unread(
        folders, photographs_only=opened.light_field is not None or opened.format in UNPACKED_FORMATS
    )


def no_cameras(path: Path, problems: tuple[str, ...] = ()) -> CaptureError:
    """The error for a capture without a calibration, which says how it gets one."""
    why = next((problem for problem in problems if "cannot be used" in problem), None)
    message = "has no calibration (transforms.json, COLMAP model or another that `eigenfield help captures` lists)"
    others = sorted(p.name for p in path.glob("*.json"))
    if unread := describe_passed_over(path):
        remedy = "; ".join(unread)
    elif others:
        remedy = f"it holds {list_names(others)}: name one as the calibration"
    elif path.is_dir() and (photographs_in(path) or photographs_in(path / IMAGES_FOLDER)):
        words = shell_word(path)
        remedy = f"`eigenfield encode {words} -o scene.glb` estimates cameras and mesh, `eigenfield calibrate {words}` "
        remedy += "cameras alone; or name one with --calibration"
    else:
        remedy = "name one with --calibration"
    return CaptureError("calibration-missing", why or message, path=path, remedy=remedy)
