"""A clip as one file, or as a folder of files: one becomes the other by copying bytes, without decoding a group."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eigenfield.coding import limits
from eigenfield.core.clip import Audio, Clip
from eigenfield.core.errors import OutputError
from eigenfield.gltf.clips import CodedGroups
from eigenfield.gltf.container import glb_blocks, json_bytes, parse_glb
from eigenfield.gltf.layout import TIMELINE, find_extension, is_clip, open_document, unpacked_document
from eigenfield.gltf.layout_timeline import GROUP_FILES, SOUND_FILE, in_files
from eigenfield.gltf.packed import is_packed, repack
from eigenfield.gltf.read_clip import load_clip
from eigenfield.gltf.source import (
    ByteSource,
    FileBeside,
    HeldBytes,
    name_file_in_errors,
    open_source,
    read_file,
    scene_file,
)
from eigenfield.gltf.write_clip import GroupsChunk, clip_blocks, coded_groups, place_groups

Blocks = Iterable[bytes | memoryview]


@dataclass(frozen=True, eq=False)
class ClipFiles:
    """A clip whose groups are files.

    Attributes:
        scene: The blocks of `SCENE_FILE`.
        groups: Whose bytes are the other files, with the sound (`group_files`).
    """

    scene: Blocks
    groups: CodedGroups
    audio: Audio | None


def has_group_files(path: str | os.PathLike[str]) -> bool:
    """Whether a file is a clip whose groups are files beside it. FormatError, it is neither a clip nor a scene."""
    with name_file_in_errors(path), open_source(Path(path)) as source:
        extension = find_extension(open_document(source))
        return is_clip(extension) and in_files(extension[TIMELINE])


def files_beside(clip: Clip) -> dict[str, ByteSource]:
    """The files that a clip was read from beside `SCENE_FILE`, by name; none where it is one file. OptionError
    `clip-groups`."""
    found = [one.data for one in coded_groups(clip, None).stored]
    made: dict[str, ByteSource] = {one.name: one for one in found if isinstance(one, FileBeside)}
    return made if clip.audio is None or not made else {**made, SOUND_FILE: HeldBytes(clip.audio.data)}


def clip_in_files(clip: Clip | str | os.PathLike[str]) -> ClipFiles:
    """A clip, or the one in a file of either form, as files. OptionError `clip-groups`; FormatError as `load_clip`."""
    if isinstance(clip, Clip):
        return ClipFiles(clip_blocks(clip, None, files=True), coded_groups(clip, None), clip.audio)
    loaded = load_clip(clip)
    return ClipFiles(_with_groups(clip, None), coded_groups(loaded, Path(clip)), loaded.audio)


def clip_in_one_file(path: str | os.PathLike[str]) -> Blocks:
    """The blocks of the .glb of a clip in a file of either form.

    Raises:
        OutputError: `file-too-large`, over 4 GiB.
        FormatError: As `load_clip`; while the blocks are taken, a group cannot be read.
    """
    clip = load_clip(path)
    return _with_groups(path, GroupsChunk(coded_groups(clip, Path(path)), clip.audio))


def one_file(path: str | os.PathLike[str]) -> bytes:
    """The bytes of a file as they are; of a clip whose groups are files, those of its .glb."""
    with name_file_in_errors(path):
        data = read_file(Path(path))
    return b"".join(clip_in_one_file(path)) if has_group_files(path) else data


def _with_groups(path: str | os.PathLike[str], chunk: GroupsChunk | None) -> Blocks:
    """The blocks of a clip's file with its groups in a chunk; None: they are files."""
    with name_file_in_errors(path), open_source(Path(path)) as source:
        glb = parse_glb(source)
        found = find_extension(unpacked_document(glb)).mapping()
        timeline = place_groups(found[TIMELINE], chunk)
        needs: set[str] = {*found.get("needs", ())} - {GROUP_FILES} | ({GROUP_FILES} if chunk is None else set())
        extension: dict[str, Any] = {**found, "needs": sorted(needs), TIMELINE: timeline}
        try:
            if is_packed(glb):
                return repack(glb, extension, chunk)
            glb.json["extensions"][limits.EXTENSION] = extension
            return glb_blocks(json_bytes(glb.json), bytes(glb.binary.data), behind=chunk)
        except OutputError as error:
            error.path = os.fspath(scene_file(path))
            raise
