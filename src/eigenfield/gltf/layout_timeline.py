"""A clip's films, its timeline and its groups in the JSON of a file."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.coding.codecs import CODECS
from eigenfield.coding.opus import OPUS_TYPE
from eigenfield.coding.video.film_layout import PLACE_STEP, SIDE_STEP
from eigenfield.core.clip import Timeline
from eigenfield.core.films import FilmLayout, FilmPart, FilmPlane, Size
from eigenfield.gltf.layout_planes import read_size
from eigenfield.gltf.strict_json import Value, quote

GROUP_ALIGNMENT = 4  # of a group's first byte
GROUP_FILES = "groupFiles"  # the key, and the feature, of a clip whose groups are files
SOUND_FILE = "sound.opus"  # beside such a clip
_DIGEST = re.compile("[0-9a-f]{64}")  # SHA-256


@dataclass(frozen=True)
class GroupEntry:
    """A group in the chunk of groups, or in a file.

    Attributes:
        offset: Of its first byte; None: it is a file (`group_file`).
        digest: SHA-256 of its bytes, hexadecimal.
    """

    frames: int
    offset: int | None
    length: int
    digest: str


@dataclass(frozen=True)
class AudioEntry:
    """The sound of a clip in the chunk of groups, or in a file.

    Attributes:
        offset: Of its first byte; None: it is `SOUND_FILE`.
        first: Seconds, of its beginning.
    """

    offset: int | None
    length: int
    first: float


def read_films(extension: Value) -> FilmLayout:
    """Films, and the places of all textures and of the opacity in them. FormatError `film-size`, `film-place`,
    `codec-unknown`, `plane-*`, `picture-limit`."""
    sizes = [_read_film(film) for film in extension["timeline"]["films"].items(limits.MAX_FILMS, 1)]
    taken = [np.zeros((rows // PLACE_STEP, columns // PLACE_STEP), bool) for rows, columns in sizes]
    planes = tuple(_read_plane(plane, sizes, taken) for plane in extension["planes"].items(limits.MAX_PLANES, 1))
    count = sum(len(part.at) // plane.channels for plane in planes for part in plane.bases)
    if count > limits.MAX_COMPONENTS:
        extension["planes"].fail("plane-components", f"{count} eigen textures, {limits.MAX_COMPONENTS} are allowed")
    opacity = None
    if extension.has("sheets"):
        entry = extension["sheets"]["opacity"]
        opacity = _read_part(entry, 1, sizes, taken)
        if len(opacity.at) != 1:
            entry["at"].fail("film-place", f"{len(opacity.at)} places, one expected")
    return FilmLayout(tuple(sizes), planes, opacity)


def _read_film(entry: Value) -> Size:
    codec = entry["codec"].text()
    if codec not in CODECS or CODECS[codec].kind != "film":
        message = f"no codec of a film is called {quote(codec)} here"
        entry["codec"].fail("codec-unknown", message, "use a later eigenfield")
    columns, rows = (item.integer(SIDE_STEP, limits.MAX_FILM_SIDE) for item in entry["size"].items(2, 2))
    if rows % SIDE_STEP or columns % SIDE_STEP or rows * columns > limits.MAX_FILM_PIXELS:
        message = f"a film of {columns}x{rows}; sides are multiples of {SIDE_STEP}, {limits.MAX_FILM_PIXELS} pixels"
        entry["size"].fail("film-size", f"{message} are allowed")
    return rows, columns


def _read_plane(entry: Value, sizes: list[Size], taken: list[NDArray[np.bool_]]) -> FilmPlane:
    channels = entry["channels"].integer(1, limits.MAX_CHANNELS)
    mean = _read_part(entry["mean"], channels, sizes, taken)
    if len(mean.at) != channels:
        entry["mean"]["at"].fail("film-place", f"{len(mean.at)} places, one for each of {channels} channels expected")
    bases = entry["bases"].items(limits.MAX_BASES)
    return FilmPlane(mean, tuple(_read_part(basis, channels, sizes, taken) for basis in bases))


def _read_part(entry: Value, channels: int, sizes: list[Size], taken: list[NDArray[np.bool_]]) -> FilmPart:
    columns, rows = read_size(entry["size"], 1)
    film = entry["film"].integer(0, len(sizes) - 1)
    places = []
    for place in entry["at"].items(limits.MAX_COMPONENTS * channels, channels):
        column, row = (item.integer(0, limits.MAX_FILM_SIDE) for item in place.items(2, 2))
        if row % PLACE_STEP or column % PLACE_STEP:
            place.fail("film-place", f"a place at {column}, {row}, not at multiples of {PLACE_STEP}")
        if row + rows > sizes[film][0] or column + columns > sizes[film][1]:
            shown = "x".join(map(str, reversed(sizes[film])))
            place.fail("film-place", f"{columns}x{rows} at {column}, {row} leaves a film of {shown}")
        below, behind = (-(-end // PLACE_STEP) for end in (row + rows, column + columns))
        cells = taken[film][row // PLACE_STEP : below, column // PLACE_STEP : behind]
        if cells.any():  # places begin cells, so that two which share one share texels
            place.fail("film-place", f"{columns}x{rows} at {column}, {row} covers another texture")
        cells[:] = True
        places.append((row, column))
    if len(places) % channels:
        entry["at"].fail("film-place", f"{len(places)} places are no multiple of {channels} channels")
    return FilmPart((rows, columns), film, tuple(places))


def read_timeline(entry: Value) -> Timeline:
    """When frames are shown. FormatError `timeline-rate`, `json-*`."""
    numerator, denominator = (item.integer(1, limits.MAX_RATE_TERM) for item in entry["rate"].items(2, 2))
    rate = Fraction(numerator, denominator)
    if not 1 / limits.MAX_RATE <= rate <= limits.MAX_RATE:
        entry["rate"].fail(
            "timeline-rate", f"{float(rate):g} frames a second, 1/{limits.MAX_RATE} to {limits.MAX_RATE} are allowed"
        )
    first = entry["first"].number(limits.MAX_TIME) if entry.has("first") else 0.0
    return Timeline(rate, entry["frames"].integer(1, limits.MAX_FRAMES), first)


def in_files(entry: Value) -> bool:
    """Whether groups and sound are files; entry: the timeline. FormatError `json-value`, `json-type`."""
    if entry.has(GROUP_FILES) and entry[GROUP_FILES].value is not True:
        entry[GROUP_FILES].fail("json-value", "true is expected, or nothing")
    return entry.has(GROUP_FILES)


def group_file(index: int) -> str:
    """The file of a group, from the folder of the clip's."""
    return f"groups/{index:05}.eftg"


def read_groups(entry: Value, frames: int, available: int | None) -> tuple[GroupEntry, ...]:
    """Where the groups lie.

    Args:
        entry: The timeline.
        frames: Of the clip.
        available: Bytes of the chunk of groups, those behind the end of a file that is cut off counted; None: each
            group is a file.

    Raises:
        FormatError: `timeline-frames`, the groups have not so many frames; `group-range`, one does not lie within the
            chunk, behind the one before.
    """
    groups: list[GroupEntry] = []
    end = 0
    for item in entry["groups"].items(limits.MAX_GROUPS, 1):
        group = GroupEntry(
            item["frames"].integer(1, limits.MAX_GROUP_FRAMES),
            None if available is None else item["offset"].integer(0, limits.MAX_FILE),
            item["length"].integer(1, limits.MAX_GROUP),
            item["sha256"].text(),
        )
        if not _DIGEST.fullmatch(group.digest):
            item["sha256"].fail("json-value", "64 hexadecimal digits expected")
        if group.offset is not None and available is not None:
            if group.offset < end or group.offset % GROUP_ALIGNMENT:
                message = f"begins at byte {group.offset}; a multiple of {GROUP_ALIGNMENT} from {end} on is expected"
                item.fail("group-range", message)
            end = group.offset + group.length
            if end > available:
                item.fail("group-range", f"ends at byte {end} of {available} in the chunk of groups")
        groups.append(group)
    total = sum(group.frames for group in groups)
    if total != frames:
        entry["groups"].fail("timeline-frames", f"groups of {total} frames, the timeline has {frames}")
    return tuple(groups)


def read_audio(entry: Value, groups: tuple[GroupEntry, ...], available: int | None) -> AudioEntry | None:
    """Where the sound lies, behind the groups; None: there is none.

    Args:
        entry: The timeline.
        available: As of `read_groups`.

    Raises:
        FormatError: `audio-unknown`, of another kind than Opus in Ogg; `group-range`.
    """
    if not entry.has("audio"):
        return None
    item = entry["audio"]
    kind = item["mimeType"].text()
    if kind != OPUS_TYPE:
        item["mimeType"].fail("audio-unknown", f"sound of the kind {quote(kind)}, {OPUS_TYPE} expected")
    first = item["first"].number(limits.MAX_TIME) if item.has("first") else 0.0
    length = item["length"].integer(1, limits.MAX_AUDIO)
    last = groups[-1]
    if available is None or last.offset is None:
        return AudioEntry(None, length, first)
    offset, behind = item["offset"].integer(0, limits.MAX_FILE), last.offset + last.length
    if offset < behind or offset % GROUP_ALIGNMENT or offset + length > available:
        message = f"sound from byte {offset} to {offset + length}"
        item.fail("group-range", f"{message}; a multiple of {GROUP_ALIGNMENT} from {behind} to {available} is expected")
    return AudioEntry(offset, length, first)
