"""Opening footage: its form, its calibration, and its frames on one clock.

Readers of calibrations, names and masks know photographs. While footage is opened, each camera therefore has a stand-in
under its name in a temporary folder: a link to its first picture, or of a video a blank picture of its size.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from pathlib import Path, PurePosixPath

import numpy as np
from PIL import Image, PngImagePlugin

from eigenfield.capture.archive import is_zip, unpack
from eigenfield.capture.calibration import Calibration, Entry
from eigenfield.capture.clip_range import ClipRange, offsets_by_camera, parse_clip, parse_offsets
from eigenfield.capture.clock import Extent, common_range, extent_of, place_on_clock, refuse_long_holes
from eigenfield.capture.footage import Footage, at_frames
from eigenfield.capture.footage_forms import Found, find_footage, is_timed, of_entries, one_camera_each
from eigenfield.capture.formats import FORMATS, Claim, format_by_name
from eigenfield.capture.locate import IMAGES_FOLDER
from eigenfield.capture.messages import describe, list_names
from eigenfield.capture.pairing import pair_photographs
from eigenfield.capture.photographs.kinds import VIDEO_EXTENSIONS
from eigenfield.capture.photoset import Capture
from eigenfield.capture.sources import (
    NAME_FORMATS,
    StrPath,
    find_claim,
    find_source,
    finish,
    masks_folder,
    no_cameras,
    open_source,
)
from eigenfield.capture.tracks import PictureTrack, Track, VideoTrack
from eigenfield.coding.limits import MAX_FRAMES, MAX_RATE
from eigenfield.core.camera_names import name_key
from eigenfield.core.clip import Timeline
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.open_options import OpenOptions
from eigenfield.runtime.objects import local_copy
from eigenfield.runtime.parallel import parallel_map
from eigenfield.runtime.temporary import temporary_folder

FOOTAGE_MIN_CAMERAS = 2  # whose calibration is known
FOOTAGE_MIN_BARE_CAMERAS = 3  # whose calibration is to be estimated
CAMERA_FORMATS = tuple(row for row in FORMATS if row.read_cameras is not None)

NUMBER_AT_END = re.compile(r"[^a-zA-Z0-9]*\d+$")


def open_footage(
    path: StrPath,
    *,
    clip: str | None = None,
    offsets: Mapping[str, int] | None = None,
    options: OpenOptions | None = None,
) -> Footage:
    """Open what several cameras film: with their cameras where a calibration or names state them.

    Args:
        path: A folder of one video a camera; of a folder a camera with numbered pictures; of a folder an instant with a
            picture a camera; a transforms.json whose frames state a time, or the folder of one; a zip of any of these.
        clip: FIRST:END[:STEP] in frames or seconds; None: that of `options`, or all frames that the cameras share.
        offsets: By camera, how many of its frames come before the others begin; None: those of `options`.
        options: As of `open_any`.

    Raises:
        CaptureError: There is no footage (`footage-missing`), its cameras move (`footage-moving`) or have no frame in
            common (`footage-range`), one lacks frames in the middle (`footage-hole`); too few cameras (`too-few`); and
            those of `open_any`.
        OptionError: `clip-unknown`, `clip-range`, `offset-unknown`, `rate-unknown`; an option is impossible or would
            have no effect.
    """
    options = options or OpenOptions()
    asked = parse_clip(clip if clip is not None else options.clip or ":")
    offsets = parse_offsets(options.offset) if offsets is None else offsets
    if options.frame is not None or options.walk_frames is not None or options.also:
        remedy = "name the frames with --clip"
        raise OptionError("clip-options", "--frame, --walk-frames and several folders are of stills", remedy=remedy)
    root = local_copy(path)
    root = unpack(root, options.work) if is_zip(root) else root
    claim = _find_calibration(root, options)
    root = root.parent if root.is_file() else root
    found, read = _find_tracks(root, claim, options)
    if claim is None and found.instants:
        claim, read = _calibration_of_instants(found.instants, options)
    still, tracks = _open_cameras(found, claim, read, root, options)
    return _on_clock(root, found, still, tracks, asked, offsets)


# what is there


def _find_calibration(root: Path, options: OpenOptions) -> Claim | None:
    """The calibration that is named, or else lies there."""
    formats = CAMERA_FORMATS
    if options.format is not None:
        row = format_by_name(options.format)
        formats = (row,) if row.read_cameras is not None else ()
    if options.calibration is not None:
        claim = find_claim(local_copy(options.calibration), formats or CAMERA_FORMATS, options)
        if claim is None:
            raise no_cameras(Path(options.calibration))
        return claim
    if root.is_file() and root.name.lower().endswith(VIDEO_EXTENSIONS):
        raise _too_few(root, "is the video of one camera", FOOTAGE_MIN_CAMERAS)
    return find_claim(root, formats, options) if formats else None


def _find_tracks(root: Path, claim: Claim | None, options: OpenOptions) -> tuple[Found, Calibration | None]:
    """The cameras, and the calibration if it has been read."""
    read = None
    if claim is not None and claim.format.name == "transforms":
        assert claim.format.read_cameras is not None
        read = claim.format.read_cameras(claim.found, root)
    timed = read is not None and is_timed(read)
    apart = options.calibration is not None
    if timed and not apart and read is not None:
        return of_entries(read, root, apart=False, rate=options.rate), None
    found = find_footage(root, options.rate)
    if found is None and timed and read is not None:
        return of_entries(read, root, apart=True, rate=options.rate), None
    if found is None:
        raise CaptureError(
            "footage-missing",
            "holds no footage: neither a video a camera, nor a folder of numbered pictures a camera or an instant",
            path=root,
            remedy="put the videos of all cameras into one folder, or leave out --clip",
        )
    return found, one_camera_each(read)[0] if timed and read is not None else read


def _calibration_of_instants(
    folders: Sequence[Path], options: OpenOptions
) -> tuple[Claim, Calibration] | tuple[None, None]:
    """The calibration in the first instant's folder, as programs write it that render each frame as a capture.

    Raises CaptureError `footage-moving` where that of the last instant has other poses.
    """
    first, last = (_read_beside(folder, options) for folder in (folders[0], folders[-1]))
    if first is None:
        return None, None
    if last is not None:
        poses = {PurePosixPath(entry.file).name: (entry.R, entry.centre) for entry in first[1].entries}
        for entry in last[1].entries:
            R, centre = poses.get(PurePosixPath(entry.file).name, (entry.R, entry.centre))
            if not (np.allclose(entry.R, R, atol=1e-5) and np.allclose(entry.centre, centre, rtol=1e-4, atol=1e-6)):
                message = f"{entry.label} has another pose here than in {folders[0].name}: the cameras move"
                remedy = "film with cameras that stand still; of one that moves with all others, encode each instant"
                raise CaptureError("footage-moving", message, path=last[1].path, remedy=remedy)
    return first


def _read_beside(folder: Path, options: OpenOptions) -> tuple[Claim, Calibration] | None:
    claim = _find_calibration(folder, options)
    if claim is None:
        return None
    assert claim.format.read_cameras is not None
    return claim, claim.format.read_cameras(claim.found, folder)


# cameras


def _open_cameras(
    found: Found, claim: Claim | None, read: Calibration | None, root: Path, options: OpenOptions
) -> tuple[Capture, tuple[Track, ...]]:
    """The cameras at their first frames, and their tracks in the same order."""
    with _stand_ins(found.tracks, root) as (folder, by_file):
        if claim is None:
            opened = _by_names(folder, len(by_file), root, options)
        else:
            assert claim.format.read_cameras is not None
            read = found.calibration or read or claim.format.read_cameras(claim.found, folder)
            read = replace(read, problems=(*claim.problems, *read.problems))
            opened = _by_calibration(read, folder, by_file, bool(found.instants), root, options)
        opened = finish(opened)
        tracks = tuple(by_file[source.path.name] for source in opened.sources)
    first = np.zeros(len(tracks), np.int64)
    still = at_frames(opened, tracks, first, first > 0)
    return replace(still, root=root, problems=(*found.problems, *still.problems)), tracks


def _by_names(folder: Path, cameras: int, root: Path, options: OpenOptions) -> Capture:
    if cameras < FOOTAGE_MIN_BARE_CAMERAS:
        what = "holds footage of two cameras without a calibration"
        raise _too_few(root, what, FOOTAGE_MIN_BARE_CAMERAS, "name one with --calibration, or add cameras")
    source = find_source(folder, replace(options, clip=None, offset=(), rate=None), NAME_FORMATS)
    assert source is not None
    return open_source(source)


def _by_calibration(
    read: Calibration, folder: Path, by_file: Mapping[str, Track], instants: bool, root: Path, options: OpenOptions
) -> Capture:
    named = _by_stand_in(read, by_file, instants)
    if len(named.entries) < FOOTAGE_MIN_CAMERAS and not read.errors:
        here = list_names([track.name for track in by_file.values()])
        there = list_names([entry.file for entry in read.entries])
        what = f"{len(named.entries)} cameras of the footage ({here}) are among those of {read.path.name} ({there})"
        raise _too_few(root, what, FOOTAGE_MIN_CAMERAS, "name videos or folders as the calibration does")
    masks, strict = masks_folder(options), options.strict
    return pair_photographs(named, folder, apart=False, masks=masks, strict=strict, fewest=FOOTAGE_MIN_CAMERAS)


@contextmanager
def _stand_ins(tracks: Sequence[Track], root: Path) -> Iterator[tuple[Path, dict[str, Track]]]:
    """A folder of stand-ins, and the tracks by the names of these. Errors that name one name the camera's file."""
    with temporary_folder("eigenfield-footage") as folder:
        files = parallel_map(lambda track: _stand_in(track, folder), tracks)
        by_file = {file.name: track for file, track in zip(files, tracks, strict=True)}
        try:
            yield folder, by_file
        except CaptureError as error:
            if error.path is not None and Path(error.path).is_relative_to(folder):
                track = by_file.get(Path(error.path).name)
                error.path = str(root if track is None else track.path)
            raise


def _stand_in(track: Track, folder: Path) -> Path:
    if isinstance(track, PictureTrack):
        file = folder / f"{track.name}{track.path.suffix}"
        try:
            file.symlink_to(track.path.absolute())
        except OSError:  # Windows, where links are a right of their own
            shutil.copyfile(track.path, file)
        return file
    assert isinstance(track, VideoTrack)
    pixels, _ = track.film.read(0)
    file = folder / f"{track.name}.png"
    note = PngImagePlugin.PngInfo()
    note.add_text("camera", track.name)  # no two are the same file
    Image.new("L", pixels.shape[1::-1]).save(file, pnginfo=note, compress_level=1)
    return file


def _by_stand_in(read: Calibration, by_file: Mapping[str, Track], instants: bool) -> Calibration:
    """The entries of a calibration that are of the footage's cameras, with the names of their stand-ins.

    They name a camera by their file or their folder, with or without the number of a frame. A frame may be called as
    another camera is: folders come first, but where they are instants.
    """
    keys = {name_key(track.name): file for file, track in by_file.items()}
    entries: list[Entry] = []
    taken: set[str] = set()
    twice: list[str] = []
    lost: list[str] = []
    for entry in read.entries:
        path = PurePosixPath(entry.file)
        folder = path.parent.parent.name if path.parent.name == IMAGES_FOLDER else path.parent.name
        either = (path.name, path.stem, folder) if instants else (folder, path.name, path.stem)
        words = (entry.file, *either, NUMBER_AT_END.sub("", path.stem))
        file = next((keys[key] for word in words if (key := name_key(word)) in keys), None)
        if file is None or file in taken:
            (lost if file is None else twice).append(entry.file)
            continue
        taken.add(file)
        entries.append(replace(entry, file=file))
    again = describe(twice, "calibration entry is", "calibration entries are", "of a camera that has one already")
    none = describe(lost, "calibration entry is", "calibration entries are", "of no camera of the footage")
    return replace(read, entries=tuple(entries), problems=(*read.problems, *again, *none))


def _too_few(
    path: Path, what: str, fewest: int, remedy: str = "name the folder with the videos of all"
) -> CaptureError:
    return CaptureError("too-few", f"{what}; {fewest} are needed", path=path, remedy=remedy)


# the clock


def _on_clock(
    root: Path, found: Found, still: Capture, tracks: tuple[Track, ...], asked: ClipRange, offsets: Mapping[str, int]
) -> Footage:
    rate = found.rate / asked.step
    if not Fraction(1, MAX_RATE) <= rate <= MAX_RATE:
        raise OptionError(
            "rate-unknown",
            f"a clip has 1/{MAX_RATE} to {MAX_RATE} frames a second, and not {float(rate):.3g}",
            remedy="say another --rate or a smaller step in --clip; where a calibration states times, they are seconds",
        )
    shifts = offsets_by_camera(offsets, [track.name for track in tracks])
    extents = [extent_of(track.name, track.times, shift) for track, shift in zip(tracks, shifts, strict=True)]
    first, last = _range(asked, extents, found, root)
    if (last - first) // asked.step > MAX_FRAMES:
        raise OptionError(
            "clip-range",
            f"frames {first} to {last} are more than the {MAX_FRAMES} of a clip",
            remedy="number pictures 0, 1, 2 if their names are time stamps, or name fewer frames with --clip",
        )
    wanted = np.arange(first, last, asked.step)
    placed = [place_on_clock(track.times, shift, wanted) for track, shift in zip(tracks, shifts, strict=True)]
    missing = []
    for extent, track, (_, held) in zip(extents, tracks, placed, strict=True):
        if count := refuse_long_holes(extent, wanted, held, track.path):
            missing.append(f"{extent.name} ({count})")
    timeline = Timeline(rate, len(wanted), float(first / found.rate))
    problems = [*still.problems, *_describe_range(asked, extents, first, last)]
    if missing:
        problems.append(f"frames are missing in {list_names(missing)}: the frame before is held, and masked out")
    frames, held = (np.stack(part) for part in zip(*placed, strict=True))
    return Footage(root, timeline, still, tracks, frames, held, tuple(problems))


def _range(asked: ClipRange, extents: Sequence[Extent], found: Found, root: Path) -> tuple[int, int]:
    first, last = asked.frames(found.rate)
    if first is None or last is None:
        common = common_range(extents, root)
        first, last = common[0] if first is None else first, common[1] if last is None else last
    earliest, latest = min(one.first for one in extents), max(one.last for one in extents)
    if not earliest <= first < last <= latest:
        raise OptionError(
            "clip-range",
            f"--clip from frame {first} to {last} leaves nothing, or more than there is: the cameras have frames "
            f"{earliest} to {latest} at {float(found.rate):.4g} a second",
            remedy="name frames between these",
        )
    return first, last


def _describe_range(asked: ClipRange, extents: Sequence[Extent], first: int, last: int) -> list[str]:
    """Lines about cameras that begin late or stop early, and about those that have more."""
    short = [str(one) for one in extents if one.first > first or one.last < last]
    if short:
        names = list_names(short)
        return [f"not all cameras have frames {first} to {last - 1}, and are masked out elsewhere: {names}"]
    earliest, latest = min(one.first for one in extents), max(one.last for one in extents)
    limits = [str(one) for one in extents if earliest < one.first == first or latest > one.last == last]
    if limits and asked.first is None and asked.last is None:
        return [f"frames {first} to {last - 1} are those that all cameras have, limited by {list_names(limits)}"]
    return []
