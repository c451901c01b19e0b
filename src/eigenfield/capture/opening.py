"""Opening a capture: its format found, then the light field of its cameras, or the set of its photographs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from eigenfield.capture.footage import Footage
from eigenfield.capture.formats import FORMATS
from eigenfield.capture.inspect_photographs import make_photo_set
from eigenfield.capture.lightfield import LightField
from eigenfield.capture.locate import IMAGES_FOLDER
from eigenfield.capture.opening_footage import open_footage
from eigenfield.capture.photoset import Capture, PhotoSet
from eigenfield.capture.readers.folder import read_folders, refuse_photograph_files
from eigenfield.capture.sources import (
    NAME_FORMATS,
    StrPath,
    find_source,
    finish,
    masks_folder,
    no_cameras,
    open_source,
    read_arrangement,
)
from eigenfield.capture.unread import describe_inner, describe_unread
from eigenfield.core.arguments import checked
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.fields import takes_options
from eigenfield.core.open_options import OpenOptions
from eigenfield.runtime.objects import local_copy


@checked
@takes_options(OpenOptions)
def open_path(path: StrPath, options: OpenOptions | None = None, **changes: Any) -> Capture | Footage:
    """Open a capture: a `LightField` where a calibration or the names state the cameras, otherwise a `PhotoSet`. With
    `clip`, open `Footage`, which is one of these at each of its instants.

    Args:
        path: A folder of photographs (in itself or in its `images/`), or of one video a camera; one video of a walk; a
            zip of any of these; an address of an object store. A calibration beside the photographs is found.
            For footage also a folder of folders: one a camera with numbered pictures, or one an instant.
        options: How it is opened; None for the defaults.
        changes: In place of those of `options`.

    Raises:
        CaptureError: There are no photographs (`photographs-missing`), or fewer than three (`too-few`); one is
            unreadable, or has another size than its camera or grid (`image-size`); a calibration is damaged; more than
            one format fits (`format-ambiguous`); and others of `open_capture`, `open_photographs` and `open_footage`.
        OptionError: An option is impossible or would have no effect.
    """
    options = replace(options or OpenOptions(), **changes)
    return open_any(path, options) if options.clip is None else open_footage(path, options=options)


@checked
@takes_options(OpenOptions)
def open_any(path: StrPath, options: OpenOptions | None = None, **changes: Any) -> Capture:
    """Open photographs of one instant, as `open_path` does.

    Args:
        path: As of `open_path`.
        options: How it is opened; None for the defaults.
        changes: In place of those of `options`.

    Raises:
        CaptureError: As of `open_path`.
        OptionError: An option is impossible or would have no effect.
    """
    options = replace(options or OpenOptions(), **changes)
    if options.also:
        return _open_folders([path, *options.also], options)
    source = find_source(path, options, FORMATS)
    if source is None:
        raise _no_photographs(Path(path))
    return finish(open_source(source))


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
    source = find_source(path, options, FORMATS)
    if source is None or not source.claim.format.cameras:
        raise no_cameras(Path(path))
    opened = open_source(source)
    if opened.light_field is None:
        raise no_cameras(Path(path), opened.problems)
    return finish(opened.light_field)


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
    source = find_source(path, options, NAME_FORMATS)
    if source is None:
        raise _no_photographs(Path(path))
    made = make_photo_set(read_arrangement(source), source.root, masks=masks_folder(options), strict=options.strict)
    return finish(made)


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
    return finish(make_photo_set(arrangement, root, masks=masks_folder(options), strict=options.strict))


def _no_photographs(path: Path) -> CaptureError:
    """The error for a folder in which nothing is found; it names what is there, and folders inside with photographs."""
    unread, inner = describe_unread((path, path / IMAGES_FOLDER)), describe_inner(path) if path.is_dir() else None
    message = "holds no photographs that are read" if unread else "holds no photographs"
    remedy = "; ".join([*unread, *([inner] if inner else [])]) or "name a folder of photographs"
    return CaptureError("photographs-missing", message, path=path, remedy=remedy)
