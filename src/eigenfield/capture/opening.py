"""Opening a capture: its format found, then the light field of its cameras, or the set of its photographs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

from eigenfield.capture.archive import is_zip, unpack
from eigenfield.capture.arrangement import Arrangement
from eigenfield.capture.calibration import Calibration, Entry
from eigenfield.capture.formats import FORMATS, Claim, Format, claim_of_file, detect_format, format_by_name
from eigenfield.capture.inspect_photographs import common_focal_length, make_photo_set
from eigenfield.capture.lightfield import LightField
from eigenfield.capture.locate import IMAGES_FOLDER, photograph_root, photographs_in
from eigenfield.capture.messages import Note, count_phrase, list_names
from eigenfield.capture.pairing import pair_photographs
from eigenfield.capture.passed_over import describe_passed_over
from eigenfield.capture.photographs.exr import choose_exposure
from eigenfield.capture.photographs.kinds import VIDEO_EXTENSIONS, is_linear
from eigenfield.capture.photoset import Capture, PhotoSet
from eigenfield.capture.readers.folder import read_folders, refuse_photograph_files
from eigenfield.capture.readers.grid_names import compile_pattern
from eigenfield.capture.readers.video import is_video_rig, read_videos
from eigenfield.capture.unread import describe_inner, describe_unread
from eigenfield.core.arguments import checked
from eigenfield.core.camera_names import name_key
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.fields import takes_options
from eigenfield.core.open_options import OpenOptions
from eigenfield.core.recognise import refuse_address
from eigenfield.core.shell import shell_word
from eigenfield.runtime.objects import local_copy

C = TypeVar("C", LightField, PhotoSet, Capture)
StrPath = str | os.PathLike[str]
PATTERN_FORMAT = "grid"  # which --pattern means
NAME_FORMATS = tuple(row for row in FORMATS if row.read_names is not None)


@checked
@takes_options(OpenOptions)
def open_any(path: StrPath, options: OpenOptions | None = None, **changes: Any) -> Capture:
    """Open a capture: a `LightField` where a calibration or the names state the cameras, otherwise a `PhotoSet`.

    Args:
        path: A folder of photographs (in itself or in its `images/`), or of one video a camera; one video of a walk; a
            zip of any of these; an address of an object store. A calibration beside the photographs is found.
        options: How it is opened; None for the defaults.
        changes: In place of those of `options`.

    Raises:
        CaptureError: There are no photographs (`photographs-missing`), or fewer than three (`too-few`); one is
            unreadable, or has another size than its camera or grid (`image-size`); a calibration is damaged; more than
            one format fits (`format-ambiguous`); and others of `open_capture` and `open_photographs`.
        OptionError: An option is impossible or would have no effect.
    """
    options = replace(options or OpenOptions(), **changes)
    if options.also:
        return _open_folders([path, *options.also], options)
    source = _find_source(path, options, FORMATS)
    if source is None:
        raise _no_photographs(Path(path))
    return _finish(_open_source(source))


@takes_options(OpenOptions)
def open_capture(path: StrPath, options: OpenOptions | None = None, **changes: Any) -> LightField:
    """Open a capture with cameras; photographs are decoded on demand, only their headers are read now.

    Calibration entries without a photograph, and the reverse, are no error: they are named in `problems`.

    Args:
        path: A folder with a calibration of any format of `formats.FORMATS`, a zip of one, or the calibration itself.
        options: How it is opened; None for the defaults.
        changes: In place of those of `options`.

    Raises:
        CaptureError: There is no calibration (`calibration-missing`), or it is damaged; a camera is impossible; a
            photograph is unreadable, or its size is not its camera's (`image-size`); two entries share a photograph
            (`frame-twice`); no mask fits; there are fewer than three photographs (`too-few`); more than one format
            fits (`format-ambiguous`).
        OptionError: An option is impossible or would have no effect.
    """
    options = replace(options or OpenOptions(), **changes)
    if options.also:
        refuse_photograph_files([Path(one) for one in (path, *options.also)])
        raise OptionError(
            "folders-cameras", "several folders have no calibration", remedy="name one folder that holds them all"
        )
    source = _find_source(path, options, FORMATS)
    if source is None or not source.claim.format.cameras:
        raise _no_cameras(Path(path))
    opened = _open_source(source)
    if opened.light_field is None:
        raise _no_cameras(Path(path), opened.problems)
    return _finish(opened.light_field)


@checked
@takes_options(OpenOptions, without=("calibration",))
def open_photographs(path: StrPath, options: OpenOptions | None = None, **changes: Any) -> PhotoSet:
    """Open photographs without cameras, with the grid that their names state; a calibration beside them is not read.

    Args:
        path: A folder of photographs (in itself or in its `images/`), or of one video a camera; one video of a walk; a
            zip of any of these.
        options: How they are opened; None for the defaults.
        changes: In place of those of `options`.

    Raises:
        CaptureError: `photographs-missing`, `photographs-twice`, `format-ambiguous`, `names-unknown`, `node-twice`,
            `grid-size`, `grid-positions`; a photograph is unreadable, or has another size than the rest of its grid
            (`image-size`); `video-unreadable`, `video-short`, `video-long`, `video-large`, `video-still`, `too-few`;
            those of `archive.unpack`.
        OptionError: An option is impossible or would have no effect.
    """
    options = replace(options or OpenOptions(), **changes)
    if options.calibration is not None:
        raise OptionError(
            "calibration-unused", "--calibration means nothing to photographs without cameras", remedy="leave it out"
        )
    if options.also:
        return _open_folders([path, *options.also], options)
    source = _find_source(path, options, NAME_FORMATS)
    if source is None:
        raise _no_photographs(Path(path))
    made = make_photo_set(_read_arrangement(source), source.root, masks=_masks(options), strict=options.strict)
    return _finish(made)


def _open_folders(paths: Sequence[StrPath], options: OpenOptions) -> PhotoSet:
    """The photographs of several folders, without any option that is for one."""
    refuse_photograph_files([Path(path) for path in paths])
    if replace(options, work=None, also=None, masks=None, strict=True) != OpenOptions():
        raise OptionError(
            "folders-options",
            "several folders are photographs alone: calibrations, formats and grids are of one",
            remedy="name one folder that holds them all, or leave out the other options",
        )
    folders = [local_copy(path) for path in paths]
    try:
        root = Path(os.path.commonpath([folder.absolute() for folder in folders]))
    except ValueError as error:
        raise OptionError(
            "folders-drives", "the folders are on several drives", remedy="copy them to one drive"
        ) from error
    arrangement = read_folders(folders)
    return _finish(make_photo_set(arrangement, root, masks=_masks(options), strict=options.strict))


def _finish(opened: C) -> C:
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
        folders, photographs_only=opened.light_field is not None or opened.format in ("video", "walk")
    )


@dataclass(frozen=True)
class _Source:
    """What is to be read.

    Attributes:
        videos: The cameras are of videos, one a camera.
    """

    claim: Claim
    root: Path
    options: OpenOptions
    videos: bool


def _find_source(path: StrPath, options: OpenOptions, formats: tuple[Format, ...]) -> _Source | None:
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
        claim = _find_claim(local_copy(calibration), formats, options)
        if claim is None:
            raise _no_cameras(Path(calibration))
    else:
        claim = _find_claim(root, formats, options)
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
    return _Source(claim, root, options, videos)


def _restrict_formats(row: Format, formats: tuple[Format, ...]) -> tuple[Format, ...]:
    if row not in formats:
        raise OptionError(
            "format-cameras",
            f"--format {row.name} reads cameras, and photographs without them are wanted here",
            remedy=f"say one of {', '.join(other.name for other in formats)}",
        )
    return (row,)


def _find_claim(path: Path, formats: tuple[Format, ...], options: OpenOptions) -> Claim | None:
    if not path.exists():
        refuse_address(path)
        raise CaptureError("capture-missing", "does not exist", path=path, remedy="check the path")
    if path.is_file():
        return claim_of_file(path, formats)
    if len(formats) == 1 and formats[0].read_names is not None:  # asked for: taken at the word
        return Claim(formats[0], path)
    return detect_format(path, formats, options)


def _refuse_unused(claim: Claim, options: OpenOptions) -> None:
    """Options that would change nothing are an error: who gives one expects something of it."""
    for name in ("grid", "frame", "walk_frames", "pattern"):
        if getattr(options, name) is not None and name not in claim.format.uses:
            option = name.replace("_", "-")
            raise OptionError(
                f"{option}-unused",
                f"--{option} means nothing to a capture of the format {claim.format.name} ({claim.format.title})",
                remedy="leave it out, or name another --format",
            )


def _read_arrangement(source: _Source) -> Arrangement:
    assert source.claim.format.read_names is not None
    arrangement = source.claim.format.read_names(source.claim.found, source.options)
    return replace(arrangement, problems=(*source.claim.problems, *arrangement.problems))


def _masks(options: OpenOptions) -> Path | None:
    return None if options.masks is None else local_copy(options.masks)


def _open_source(source: _Source) -> Capture:
    row, options = source.claim.format, source.options
    if row.read_cameras is not None:
        root, lines = source.root, source.claim.problems
        if source.videos:
            frames = read_videos(root, options)
            root, lines = frames.files[0].parent, (*lines, *frames.problems)
        read = row.read_cameras(source.claim.found, root)
        read = replace(read, problems=(*lines, *read.problems))
        if source.videos:
            read = _of_frames(read, {name_key(file.stem) for file in frames.files})
        apart = options.calibration is not None
        return pair_photographs(read, root, apart=apart, masks=_masks(options), strict=options.strict)
    arrangement = _read_arrangement(source)
    if arrangement.calibration is None:
        return make_photo_set(arrangement, source.root, masks=_masks(options), strict=options.strict)
    read = replace(arrangement.calibration, problems=arrangement.problems)
    light_field = pair_photographs(read, source.root, apart=False, masks=_masks(options), strict=options.strict)
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


def _no_cameras(path: Path, problems: tuple[str, ...] = ()) -> CaptureError:
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


def _no_photographs(path: Path) -> CaptureError:
    """The error for a folder in which nothing is found; it names what is there, and folders inside with photographs."""
    unread, inner = describe_unread((path, path / IMAGES_FOLDER)), describe_inner(path) if path.is_dir() else None
    message = "holds no photographs that are read" if unread else "holds no photographs"
    remedy = "; ".join([*unread, *([inner] if inner else [])]) or "name a folder of photographs"
    return CaptureError("photographs-missing", message, path=path, remedy=remedy)
