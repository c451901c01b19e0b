"""GLB to clip: the head of the file is read and checked, groups when they are asked for."""

from __future__ import annotations

import logging
import os
from dataclasses import dataclass
from pathlib import Path

from eigenfield.core.arguments import checked
from eigenfield.core.clip import Clip, Timeline
from eigenfield.core.errors import FormatError
from eigenfield.core.films import FilmLayout
from eigenfield.gltf.clips import CodedGroups, StoredGroup, group_place
from eigenfield.gltf.container import GROUPS_CHUNK
from eigenfield.gltf.document import Document
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.group import GroupHead, read_head
from eigenfield.gltf.layout import (
    Surroundings,
    check_container,
    find_extension,
    is_clip,
    open_document,
    read_surroundings,
)
from eigenfield.gltf.layout_geometry import read_cameras
from eigenfield.gltf.layout_sheets import check_sheets, read_faces
from eigenfield.gltf.layout_timeline import GroupEntry, read_films, read_groups, read_timeline
from eigenfield.gltf.source import ByteRange, ByteSource, StoredBytes, name_file_in_errors, open_source
from eigenfield.gltf.strict_json import Value
from eigenfield.runtime.objects import find_objects

log = logging.getLogger("eigenfield.format")


@dataclass(frozen=True, eq=False)
class ClipLayout(Surroundings):
    """The file of a clip without its groups; a part that could not be read is None (only while validating).

    Attributes:
        sheets: Faces of each, back to front; None: one opaque surface.
        first: The first byte of the chunk of groups in the file.
    """

    sheets: tuple[int, ...] | None
    timeline: Timeline | None
    films: FilmLayout | None
    groups: tuple[GroupEntry, ...] | None
    first: int


def read_clip_layout(document: Document, findings: Findings) -> ClipLayout | None:
    """Check all but the groups' contents; None if the file is no clip at all (only while validating)."""

    def root_extension() -> Value:
        found, glb = find_extension(document), document.glb
        if not is_clip(found):
            found.fail("no-clip", "is a scene of one instant, and a clip is expected", "open it by `load`")
        if glb.missing or (not glb.missing_groups and GROUPS_CHUNK not in glb.chunks):
            raise glb.cut_off() if glb.missing else FormatError("group-missing", "the file has no chunk of groups")
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
    entry, chunk = extension["timeline"], document.glb.chunks[GROUPS_CHUNK]
    timeline = attempt(lambda: read_timeline(entry))
    groups = None
    if timeline is not None:
        groups = attempt(lambda: read_groups(entry, timeline.frames, chunk.size + document.glb.missing_groups))
    attempt(document.check_addresses)
    return ClipLayout(**vars(around), sheets=sheets, timeline=timeline, films=films, groups=groups, first=chunk.first)


def check_clip(document: Document, findings: Findings) -> bool:
    """Check a clip as a whole, and decode it frame by frame; whether the file holds one."""
    layout = read_clip_layout(document, findings)
    if layout is None:
        return False
    rig = layout.cameras, layout.view_plane, layout.triangles, layout.reference
    if any(part is None for part in (*rig, layout.mesh, layout.films, layout.groups)):
        return True
    groups = _groups_of(layout, document.glb.source)
    for index in range(len(groups.stored)):
        with findings.part():
            for _ in groups.group(index).frames:
                pass
        if any(finding.code == "truncated" for finding in findings.found):
            break  # nor are those behind it there
    return True


def read_heads(layout: ClipLayout, source: ByteSource) -> list[GroupHead]:
    """The heads of the groups that are whole in a file. FormatError `group-damaged`; `group-missing`: none is whole."""
    assert layout.films is not None and layout.groups is not None
    heads = []
    for index, entry in enumerate(layout.groups):
        first = layout.first + entry.offset
        group = ByteRange(source, first, first + entry.length)
        if group.last > source.size:
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
        return _clip_of(layout, source if find_objects(path) is not None else Path(path))


def holds_clip(data: ByteSource) -> bool:
    """Whether a file of these bytes is a clip. FormatError, it is neither a clip nor a scene."""
    return is_clip(find_extension(open_document(data)))


def stores_clip(path: str | os.PathLike[str]) -> bool:
    """As `holds_clip`, of a file."""
    with name_file_in_errors(path), open_source(Path(path)) as source:
        return holds_clip(source)


def read_clip(data: ByteSource) -> Clip:
    """The clip in a file of these bytes, which are read as long as it is used."""
    return _clip_of(clip_layout_of(data)[1], data)


def _clip_of(layout: ClipLayout, place: ByteSource | Path) -> Clip:
    assert layout.timeline is not None
    groups = _groups_of(layout, place)
    return Clip(layout.rig, layout.timeline, groups, layout.settings, layout.scores, layout.generator)


def _groups_of(layout: ClipLayout, place: ByteSource | Path) -> CodedGroups:
    """The groups, none of which is read. place: the file, or its path where it is opened for each read."""
    assert layout.films is not None and layout.mesh is not None
    stored = []
    for entry in layout.groups or ():
        first = layout.first + entry.offset
        last = first + entry.length
        data = StoredBytes(place, first, last) if isinstance(place, Path) else ByteRange(place, first, last)
        stored.append(StoredGroup(data, entry.frames, entry.digest))
    return CodedGroups(layout.films, stored, layout.rig, layout.mesh, layout.to_rgb, layout.payloads, layout.sheets)
