"""Opening a capture: its format found, then the light field of its cameras, or the set of its photographs."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path

from eigenfield.capture.arrangement import IMAGES, Arrangement, Wanted
from eigenfield.capture.formats import FORMATS, Claim, Format, claim_of_file, detect, named_format
from eigenfield.capture.inspect_photographs import common_focal, gather
from eigenfield.capture.lightfield import LightField
from eigenfield.capture.locate import photographs_in, root_of
from eigenfield.capture.messages import some
from eigenfield.capture.pairing import pair
from eigenfield.capture.photoset import Capture, PhotoSet
from eigenfield.core.errors import CaptureError, OptionError

StrPath = str | os.PathLike[str]
WITH_CAMERAS = tuple(row for row in FORMATS if row.read_cameras is not None)
WITH_NAMES = tuple(row for row in FORMATS if row.read_names is not None)


def open_capture(
    path: StrPath,
    *,
    calibration: StrPath | None = None,
    masks: StrPath | None = None,
    strict: bool = True,
    format: str | None = None,
    grid: tuple[int, int] | None = None,
    frame: int | str | None = None,
) -> LightField:
    """Open a capture with cameras; photographs are decoded when they are asked for, only their headers are read now.

    path: a folder with a calibration of any format of `formats.FORMATS`, or the calibration itself.
    calibration: a calibration that lies elsewhere than the photographs in `path`; its entries find them by relative
        path or by file name.
    masks: a folder of masks, named as the photographs, white where they count; goes before the calibration's own.
    strict: raise the first thing that is wrong; if False, leave it out and name it in `problems` (`inspect` does).
    format: the name of a format, where more than one would do. grid, frame: as `open_photographs`.

    Calibration entries without a photograph, and the reverse, are no error: they are named in `problems`. Raises
    CaptureError: no calibration (`calibration-missing`), one that is damaged, a camera that cannot be, a photograph
    that is unreadable or whose size is not its camera's (`image-size`), two entries for one photograph (`frame-twice`),
    a masks folder that fits nothing, fewer than three photographs (`too-few`), formats that look alike
    (`format-ambiguous`); OptionError for options that cannot be.
    """
    source = _source(path, calibration, format, Wanted(_checked(grid), frame), FORMATS)
    if source is None or not source.claim.format.cameras:
        raise _no_cameras(Path(path))
    opened = _open(source, masks, strict)
    if opened.light_field is None:
        raise _no_cameras(Path(path), opened.problems)
    return opened.light_field


def open_photographs(
    path: StrPath,
    *,
    masks: StrPath | None = None,
    strict: bool = True,
    format: str | None = None,
    grid: tuple[int, int] | None = None,
    frame: int | str | None = None,
    work: StrPath | None = None,
) -> PhotoSet:
    """Open photographs without cameras, with what their names say of the array; a calibration beside them is not read.

    path: a folder of photographs (in itself or in its `images/`), or of one video a camera.
    masks, strict: as `open_capture`.
    format: the name of a format that names tell. grid: (rows, columns) of numbered photographs, in row-major order.
    frame: which frame of each video, an index from 0 or seconds ("2.5s"); 0 by default.
    work: a folder that keeps the frames of videos as PNG, so that they are decoded once; by default they last as
        long as the process.

    Raises CaptureError: `photographs-missing`, `photographs-twice`, `format-ambiguous`, `names-unknown`, `node-twice`,
    `grid-size`, `grid-positions`, a photograph that is unreadable, one in a grid of another size than the rest
    (`image-size`), `video-unreadable`, `video-short`, `too-few`; OptionError for options that cannot be.
    """
    wanted = Wanted(_checked(grid), frame, None if work is None else Path(work))
    source = _source(path, None, format, wanted, WITH_NAMES)
    if source is None:
        raise _no_photographs(Path(path))
    arrangement = _arrangement(source)
    return gather(arrangement, source.root, masks=None if masks is None else Path(masks), strict=strict)


def open_any(
    path: StrPath,
    *,
    calibration: StrPath | None = None,
    masks: StrPath | None = None,
    strict: bool = True,
    format: str | None = None,
    grid: tuple[int, int] | None = None,
    frame: int | str | None = None,
    work: StrPath | None = None,
) -> Capture:
    """Open whatever is there: a light field where a calibration or the names tell the cameras, else photographs.

    Arguments and errors as `open_capture` and `open_photographs`.
    """
    wanted = Wanted(_checked(grid), frame, None if work is None else Path(work))
    source = _source(path, calibration, format, wanted, FORMATS)
    if source is None:
        raise _no_photographs(Path(path))
    return _open(source, masks, strict)


@dataclass(frozen=True)
class _Source:
    """What is to be read: the claim, the folder of the photographs, and whether the calibration lies apart from it."""

    claim: Claim
    root: Path
    apart: bool
    wanted: Wanted


def _source(
    path: StrPath, calibration: StrPath | None, name: str | None, wanted: Wanted, formats: tuple[Format, ...]
) -> _Source | None:
    root = Path(path)
    if name is not None:
        formats = _only(named_format(name), formats)
    if calibration is not None:
        if not root.is_dir():
            raise CaptureError("capture-missing", "is no folder of photographs", path=root, remedy="check the path")
        formats = tuple(row for row in formats if row.read_cameras is not None)
        if not formats:
            raise OptionError(
                "format-cameras", f"--format {name} reads no calibration", remedy="leave out one of the two options"
            )
        claim = _claim(Path(calibration), formats, wanted)
        if claim is None:
            raise _no_cameras(Path(calibration))
    else:
        claim = _claim(root, formats, wanted)
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
            root = root_of(root, claim.found)
    _refuse_unused(claim, wanted)
    return _Source(claim, root, calibration is not None, wanted)


def _only(row: Format, formats: tuple[Format, ...]) -> tuple[Format, ...]:
    if row not in formats:
        raise OptionError(
            "format-cameras",
            f"--format {row.name} reads cameras, and photographs without them are wanted here",
            remedy=f"say one of {', '.join(other.name for other in formats)}",
        )
    return (row,)


def _claim(path: Path, formats: tuple[Format, ...], wanted: Wanted) -> Claim | None:
    if not path.exists():
        raise CaptureError("capture-missing", "does not exist", path=path, remedy="check the path")
    if path.is_file():
        return claim_of_file(path, formats)
    if len(formats) == 1 and formats[0].read_names is not None:  # asked for: taken at the word
        return Claim(formats[0], path)
    return detect(path, formats, wanted)


def _refuse_unused(claim: Claim, wanted: Wanted) -> None:
    """Options that would change nothing are an error: who gives one expects something of it."""
    for option, value in (("grid", wanted.grid), ("frame", wanted.frame)):
        if value is not None and option not in claim.format.uses:
            raise OptionError(
                f"{option}-unused",
                f"--{option} means nothing to a capture of the format {claim.format.name} ({claim.format.title})",
                remedy="leave it out, or name another --format",
            )


def _checked(grid: tuple[int, int] | None) -> tuple[int, int] | None:
    if grid is not None and (len(grid) != 2 or min(grid) < 1):
        raise OptionError("grid-unknown", f"{grid} is no grid", remedy="say rows and columns, both at least 1")
    return None if grid is None else (int(grid[0]), int(grid[1]))


def _arrangement(source: _Source) -> Arrangement:
    assert source.claim.format.read_names is not None
    arrangement = source.claim.format.read_names(source.claim.found, source.wanted)
    return replace(arrangement, problems=(*source.claim.problems, *arrangement.problems))


def _open(source: _Source, masks: StrPath | None, strict: bool) -> Capture:
    folder = None if masks is None else Path(masks)
    row = source.claim.format
    if row.read_cameras is not None:
        read = row.read_cameras(source.claim.found, source.root)
        read = replace(read, problems=(*source.claim.problems, *read.problems))
        return pair(read, source.root, apart=source.apart, masks=folder, strict=strict)
    arrangement = _arrangement(source)
    if arrangement.calibration is None:
        return gather(arrangement, source.root, masks=folder, strict=strict)
    read = replace(arrangement.calibration, problems=arrangement.problems)
    light_field = pair(read, source.root, apart=False, masks=folder, strict=strict)
    assert arrangement.layout is not None
    index = {file.name: i for i, file in enumerate(arrangement.files)}
    layout = arrangement.layout.subset([index[view.path.name] for view in light_field.views])
    focal = common_focal([float(camera.K[0, 0]) for camera in light_field.cameras])
    return replace(light_field, layout=replace(layout, focal=focal))


def _no_cameras(path: Path, problems: tuple[str, ...] = ()) -> CaptureError:
    why = next((problem for problem in problems if "cannot be used" in problem), None)
    message = "has no calibration (transforms.json, COLMAP model or another that docs/captures.md lists)"
    others = sorted(p.name for p in path.glob("*.json"))
    if others:
        remedy = f"it holds {some(others)}: name one as the calibration"
    elif path.is_dir() and (photographs_in(path) or photographs_in(path / IMAGES)):
        remedy = f"run `eigenfield calibrate {path}` or `eigenfield encode {path}`, or name one with --calibration"
    else:
        remedy = "name one with --calibration"
    return CaptureError("calibration-missing", why or message, path=path, remedy=remedy)


def _no_photographs(path: Path) -> CaptureError:
    """The error for a folder in which nothing is found; it names folders inside that hold photographs."""
    inner = [p.name for p in sorted(path.iterdir()) if p.is_dir() and photographs_in(p)] if path.is_dir() else []
    remedy = f"name one of the folders inside: {some(inner)}" if inner else "name a folder of photographs"
    return CaptureError("photographs-missing", "holds no photographs", path=path, remedy=remedy)
