"""GLB to clip: the head of the file is read and checked, groups when they are asked for."""

from __future__ import annotations

import logging
import os
from dataclasses import dataclass
from pathlib import Path

from eigenfield.coding import limits
from eigenfield.coding.opus import is_opus
from eigenfield.core.arguments import checked
from eigenfield.core.clip import Audio, Clip, Timeline
from eigenfield.core.errors import FormatError
from eigenfield.core.films import FilmLayout
from eigenfield.gltf.clips import CodedGroups, StoredGroup, group_place
from eigenfield.gltf.container import GROUPS_CHUNK
from eigenfield.gltf.document import Document
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.group import GroupHead, read_head
from eigenfield.gltf.layout import (
    TIMELINE,
    Surroundings,
    check_container,
    find_extension,
    is_clip,
    open_document,
    read_surroundings,
)
from eigenfield.gltf.layout_geometry import read_cameras
from eigenfield.gltf.layout_sheets import check_sheets, read_faces
from eigenfield.gltf.layout_timeline import (
    SOUND_FILE,
    AudioEntry,
    GroupEntry,
    group_file,
    in_files,
    read_audio,
    read_films,
    read_groups,
    read_timeline,
)
from eigenfield.gltf.source import (
    ByteRange,
    ByteSource,
    FileBeside,
    StoredBytes,
    name_file_in_errors,
    open_source,
    scene_file,
)
from eigenfield.gltf.strict_json import Value
from eigenfield.runtime.objects import find_objects

log = logging.getLogger("eigenfield.format")


@dataclass(frozen=True, eq=False)
class ClipLayout(Surroundings):
    """The file of a clip without its groups; a part that could not be read is None (only while validating).

    Attributes:
        sheets: Faces of each, back to front; None: one opaque surface.
        first: The first byte of the chunk of groups in the file; None: they are files of their own.
    """

    sheets: tuple[int, ...] | None
    timeline: Timeline | None
    films: FilmLayout | None
    groups: tuple[GroupEntry, ...] | None
    first: int | None
    audio: AudioEntry | None = None


def read_clip_layout(document: Document, findings: Findings) -> ClipLayout | None:
    """Check all but the groups' contents; None if the file is no clip at all (only while validating)."""

    def root_extension() -> Value:
        found, glb = find_extension(document), document.glb
        if not is_clip(found):
            found.fail("no-clip", "is a scene of one instant, and a clip is expected", "open it by `load`")
        if glb.missing:
            raise glb.cut_off()
        if GROUPS_CHUNK not in glb.chunks and not in_files(found[TIMELINE]):
            raise FormatError("group-missing", "the file has no chunk of groups")
        return found

    attempt = findings.attempt
    extension = attempt(root_extension)
    if extension is None:
        return None
    check_container(document, extension, findings)
    cameras = attempt(lambda: read_cameras(document, extension["cameras"]))
    films = attempt(lambda: read_films(extension))
    channels = None if films is None else [plane.channels for plane in films.planes]
    around = read_surroundings(document, extension, cameras, channels, findings)
    sheets = attempt(lambda: read_faces(extension["sheets"])) if extension.has("sheets") else None
    if sheets is not None:
        attempt(lambda: check_sheets(extension["sheets"], sheets, around.mesh))
    if cameras is not None and cameras.colours is not None:
        attempt(lambda: extension["cameras"].fail("camera-colour", "cameras of a clip have no colours of their own"))
    entry = extension[TIMELINE]
    chunk = None if in_files(entry) else document.glb.chunks[GROUPS_CHUNK]
    available = None if chunk is None else chunk.size + document.glb.missing_groups
    timeline = attempt(lambda: read_timeline(entry))
    groups = None
    if timeline is not None:
        groups = attempt(lambda: read_groups(entry, timeline.frames, available))
    audio = groups and attempt(lambda: read_audio(entry, groups, available))
    attempt(document.check_addresses)
    return ClipLayout(
        **vars(around),
        sheets=sheets,
        timeline=timeline,
        films=films,
        groups=groups,
        first=None if chunk is None else chunk.first,
        audio=audio or None,
    )


def check_clip(document: Document, findings: Findings, path: Path) -> bool:
    """Check a clip as a whole, and decode it frame by frame; whether the file at `path` holds one."""
    layout = read_clip_layout(document, findings)
    if layout is None:
        return False
    rig = layout.cameras, layout.view_plane, layout.triangles, layout.reference
    if any(part is None for part in (*rig, layout.mesh, layout.films, layout.groups)):
        return True
    place = _place(layout, document.glb.source, path)
    groups = _groups_of(layout, place)
    for index in range(len(groups.stored)):
        with findings.part():
            for _ in groups.group(index).frames:
                pass
        if any(finding.code == "truncated" for finding in findings.found):
            return True  # nor are those behind it there
    with findings.part():
        _audio_of(layout, place)
    return True


def read_heads(layout: ClipLayout, source: ByteSource, path: Path) -> list[GroupHead]:
    """The heads of the groups that are whole in the file at `path`. FormatError `group-damaged`; `group-missing`: none
    is whole, or a file of one is not there."""
    assert layout.films is not None and layout.groups is not None
    heads, place = [], _place(layout, source, path)
    for index, entry in enumerate(layout.groups):
        group = _stored(layout, place, entry, group_file(index), group_place(index))
        if isinstance(group, ByteRange) and group.last > source.size:
            break
        heads.append(read_head(group, layout.films, group_place(index)))
    if not heads:
        remedy = "copy or download it again"
        raise FormatError("group-missing", "the file ends within its first group", where=group_place(0), remedy=remedy)
    return heads


def clip_layout_of(data: ByteSource) -> tuple[Document, ClipLayout]:
    """Container and checked layout of a clip's file. FormatError."""
    document = open_document(data)
    layout = read_clip_layout(document, Findings(strict=True))
    assert layout is not None
    return document, layout


@checked
def load_clip(path: str | os.PathLike[str]) -> Clip:
    """Read a clip, of which a group is read and decoded when one of its frames is asked for.

    A file that ends within its groups has those before; asking for a later one is the error.

    Raises:
        FormatError: As `load`.
    """
    with name_file_in_errors(path), open_source(Path(path)) as source:
        document, layout = clip_layout_of(source)
        if document.glb.missing_groups:
            log.warning("the file ends within its groups: later frames are missing (copy or download it again)")
        # read later from the file, or from a copy in memory of what an object store has
        return _clip_of(layout, _place(layout, source, path) if find_objects(path) is not None else scene_file(path))


def holds_clip(data: ByteSource) -> bool:
    """Whether a file of these bytes is a clip. FormatError, it is neither a clip nor a scene."""
    return is_clip(find_extension(open_document(data)))


def stores_clip(path: str | os.PathLike[str]) -> bool:
    """As `holds_clip`, of a file."""
    with name_file_in_errors(path), open_source(Path(path)) as source:
        return holds_clip(source)


def read_clip(data: ByteSource, path: str | os.PathLike[str] | None = None) -> Clip:
    """The clip in a file of these bytes, which are read as long as it is used.

    Args:
        path: Of that file, where it has one: groups may be files beside it.
    """
    layout = clip_layout_of(data)[1]
    return _clip_of(layout, data if path is None else _place(layout, data, path))


def _place(layout: ClipLayout, source: ByteSource, path: str | os.PathLike[str]) -> ByteSource | Path:
    """Where the groups are found: in the file itself, else beside it."""
    return source if layout.first is not None else scene_file(path)


def _clip_of(layout: ClipLayout, place: ByteSource | Path) -> Clip:
    assert layout.timeline is not None
    groups, audio = _groups_of(layout, place), None
    try:
        audio = _audio_of(layout, place)
    except FormatError as error:
        if error.code == "truncated":
            log.warning("the file ends within its sound: the clip is silent (copy or download it again)")
        elif layout.first is None and error.code in ("group-missing", "group-damaged"):
            log.warning("%s: the clip is silent (%s)", error.message, error.remedy)
        else:
            raise
    return Clip(
        layout.rig, layout.timeline, groups, layout.settings, layout.scores, layout.generator, audio, layout.rights
    )


def _stored(
    layout: ClipLayout, place: ByteSource | Path, entry: GroupEntry | AudioEntry, name: str, where: str
) -> ByteSource:
    """The bytes of an entry of the chunk of groups, or of the file of this name. FormatError `group-missing`: of bytes
    in memory, which have no files beside them."""
    if layout.first is None or entry.offset is None:
        if not isinstance(place, Path):
            remedy = "open the file where it lies, or make one file of it (export --as glb)"
            raise FormatError("group-missing", "its groups are files beside it", where=where, remedy=remedy)
        return FileBeside(place, name, entry.length, where)
    first = layout.first + entry.offset
    last = first + entry.length
    return StoredBytes(place, first, last) if isinstance(place, Path) else ByteRange(place, first, last)


def _audio_of(layout: ClipLayout, place: ByteSource | Path) -> Audio | None:
    """The sound; None: there is none. FormatError `audio-unknown`, `truncated`."""
    if layout.audio is None:
        return None
    where, remedy = f"/extensions/{limits.EXTENSION}/timeline/audio", "copy or download it again"
    data = bytes(_stored(layout, place, layout.audio, SOUND_FILE, where).read(0, layout.audio.length))
    if len(data) < layout.audio.length:
        message = f"the file ends after {len(data)} of the sound's {layout.audio.length} bytes"
        raise FormatError("truncated", message, where=where, remedy=remedy)
    if not is_opus(data):
        raise FormatError("audio-unknown", "the sound is no Ogg file of Opus", where=where, remedy=remedy)
    return Audio(data, layout.audio.first)


def _groups_of(layout: ClipLayout, place: ByteSource | Path) -> CodedGroups:
    """The groups, none of which is read. place: the file, or its path where it is opened for each read."""
    assert layout.films is not None and layout.mesh is not None
    stored = [
        StoredGroup(_stored(layout, place, one, group_file(index), group_place(index)), one.frames, one.digest)
        for index, one in enumerate(layout.groups or ())
    ]
    return CodedGroups(layout.films, stored, layout.rig, layout.mesh, layout.to_rgb, layout.payloads, layout.sheets)
