"""Clip to GLB: what viewers without a decoder of ours show, cameras and mesh, then the groups as they are."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import accumulate
from pathlib import Path
from typing import Any

from eigenfield.coding import limits
from eigenfield.coding.codecs import CODECS
from eigenfield.coding.opus import OPUS_TYPE
from eigenfield.core.clip import Audio, Clip
from eigenfield.core.errors import OptionError, OutputError
from eigenfield.core.films import FilmPart, FilmPlane
from eigenfield.core.scene import Scene
from eigenfield.gltf import strict_json
from eigenfield.gltf.buffer import Buffer
from eigenfield.gltf.cached import cached_payloads
from eigenfield.gltf.clips import CodedGroups, StoredGroup
from eigenfield.gltf.coded_pictures import shown_mean
from eigenfield.gltf.container import BINARY_CHUNK, CHUNK, GROUPS_CHUNK, Glb, glb_blocks, json_bytes
from eigenfield.gltf.fallback import make_fallback
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.group import MOTION_CODEC
from eigenfield.gltf.layout import TIMELINE, unpacked_document
from eigenfield.gltf.layout_timeline import GROUP_ALIGNMENT, GROUP_FILES, SOUND_FILE, group_file
from eigenfield.gltf.read_clip import read_clip_layout
from eigenfield.gltf.source import ByteRange, HeldBytes
from eigenfield.gltf.streams import FEATURES, minor
from eigenfield.gltf.writable import check_writable
from eigenfield.gltf.write_geometry import write_cameras, write_stream, write_view_plane
from eigenfield.gltf.write_root import write_drawn, write_rest, write_root

FILM_CODEC = "film-1"


@dataclass(frozen=True, eq=False)
class GroupsChunk:
    """The chunk of groups with its head: these, and the sound behind them, each at a multiple of GROUP_ALIGNMENT.

    Each group is compared with its digest while it is read.
    """

    groups: CodedGroups
    audio: Audio | None

    @property
    def offsets(self) -> list[int]:
        """Of each group, then of the sound if there is any, and last the length of all."""
        sizes = [one.data.size for one in self.groups.stored]
        sizes += [] if self.audio is None else [len(self.audio.data)]
        return list(accumulate(map(_aligned, sizes), initial=0))

    @property
    def size(self) -> int:
        return CHUNK.size + self.offsets[-1]

    def pieces(self) -> Iterator[memoryview]:
        yield memoryview(CHUNK.pack(self.size - CHUNK.size, GROUPS_CHUNK))
        for _, data in group_files(self.groups, self.audio):
            yield memoryview(data)
            yield memoryview(bytes(_aligned(len(data)) - len(data)))


def coded_groups(clip: Clip, path: Path | None) -> CodedGroups:
    """The groups of a clip that can be written. OptionError `clip-groups`: they are not coded."""
    if not isinstance(clip.groups, CodedGroups):
        message, remedy = "only a clip whose groups are coded can be written", "take it from `encode` or `load_clip`"
        raise OptionError("clip-groups", message, path=path, remedy=remedy)
    return clip.groups


def group_files(groups: CodedGroups, audio: Audio | None) -> Iterator[tuple[str, bytes]]:
    """The groups and the sound as files: their names and bytes. FormatError, a group cannot be read."""
    for index in range(len(groups.stored)):
        yield group_file(index), groups.read(index)
    if audio is not None:
        yield SOUND_FILE, audio.data


def clip_blocks(clip: Clip, path: Path | None, *, files: bool = False) -> Iterable[bytes | memoryview]:
    """The pieces of a clip's file; bytes of groups are copied.

    Args:
        files: Whether the groups become files (`group_files`), and are not in this one.

    Raises:
        OptionError: `clip-groups`: its groups are not coded.
        OutputError: `file-too-large`, `scene-limit`.
        FormatError: A group cannot be read, or the clip is inconsistent in itself.
    """
    groups = coded_groups(clip, path)
    scene = replace(clip.scene(clip.timeline.first), scores=clip.scores)
    check_writable(scene, path)
    chunk = None if files else GroupsChunk(groups, clip.audio)
    text, binary = _head(clip, groups, scene, chunk)
    if len(text) > limits.MAX_JSON:
        message = f"{len(text)} bytes of JSON, {limits.MAX_JSON} are allowed"
        raise OutputError("scene-limit", message, path=path, remedy="store less in it")
    blocks = glb_blocks(text, binary, path, chunk)
    check_readable(text, binary, chunk)
    return blocks


def _aligned(size: int) -> int:
    return -(-size // GROUP_ALIGNMENT) * GROUP_ALIGNMENT


def check_readable(text: bytes, binary: bytes, chunk: GroupsChunk | None) -> None:
    """Check that `load_clip` takes what is written. FormatError, that of `load_clip`."""
    source = HeldBytes(binary)
    chunks = {BINARY_CHUNK: ByteRange(source, 0, len(binary))}
    if chunk is not None:
        chunks[GROUPS_CHUNK] = ByteRange(source, 0, chunk.offsets[-1])
    written = Glb(strict_json.parse(text, "byte 20"), source, chunks)
    read_clip_layout(unpacked_document(written), Findings(strict=True))


def _head(clip: Clip, groups: CodedGroups, scene: Scene, chunk: GroupsChunk | None) -> tuple[bytes, bytes]:
    """The JSON and the binary chunk; scene: of the first frame, which other viewers are shown."""
    poses = cached_payloads(scene).one("cameras")
    mesh = groups.payloads.only("mesh")
    buffer = Buffer(packed=None if poses is None else [])
    shown = make_fallback(scene, shown_mean(scene), groups.stored[0].data.size + len(mesh.data))
    drawn = {} if shown is None else write_drawn(scene, *shown, buffer, True)
    cameras = write_cameras(scene, buffer, poses)
    proxy = write_stream(mesh, "mesh", buffer)
    view_plane = write_view_plane(scene, buffer, poses is not None)
    needs = _needs(groups, {codec for _, codec in buffer.codecs}, cameras, bool(drawn), chunk is None)
    extension = {
        "needs": needs,
        "mesh": proxy,
        **_sheets(groups),
        "planes": [_plane(plane) for plane in groups.layout.planes],
        **write_rest(scene, cameras, view_plane),
        TIMELINE: _timeline(clip, groups, chunk),
    }
    version = max((FEATURES[need] for need in needs), key=minor)
    return json_bytes(write_root(scene, version, extension, drawn, buffer)), b"".join(buffer.parts)


def _needs(
    groups: CodedGroups, codecs: Iterable[str], cameras: Mapping[str, Any], fallback: bool, files: bool
) -> list[str]:
    """The features that a reader must know to draw this clip; codecs: of streams beside those of groups."""
    coded = groups.coded(0)
    named = {FILM_CODEC, *(weights.codec for plane in coded.weights for weights in plane), *codecs}
    named |= {MOTION_CODEC} if any(map(groups.moves, range(len(groups.stored)))) else set()
    found = {
        TIMELINE: True,
        GROUP_FILES: files,
        "namePattern": "pattern" in cameras,
        "noFallback": not fallback,
        "sheets": groups.layout.opacity is not None,
        "toRGB": groups.to_rgb is not None,
    }
    own = {CODECS[codec].needs for codec in named}
    return sorted({name for name, needed in found.items() if needed} | {need for need in own if need is not None})


def _sheets(groups: CodedGroups) -> dict[str, Any]:
    opacity = groups.layout.opacity
    if opacity is None:
        return {}
    assert groups.sheets is not None
    return {"sheets": {"faces": list(map(int, groups.sheets)), "opacity": _part(opacity)}}


def _plane(plane: FilmPlane) -> dict[str, Any]:
    return {"channels": plane.channels, "mean": _part(plane.mean), "bases": [_part(basis) for basis in plane.bases]}


def _part(part: FilmPart) -> dict[str, Any]:
    size, places = [part.size[1], part.size[0]], [[column, row] for row, column in part.at]
    return {"size": size, "film": part.film, "at": places}


def _timeline(clip: Clip, groups: CodedGroups, chunk: GroupsChunk | None) -> dict[str, Any]:
    timeline, audio = clip.timeline, clip.audio
    made: dict[str, Any] = {
        "rate": [timeline.rate.numerator, timeline.rate.denominator],
        "first": timeline.first,
        "frames": timeline.frames,
        "films": [{"codec": FILM_CODEC, "size": [columns, rows]} for rows, columns in groups.layout.sizes],
        "groups": [
            {"frames": one.frames, "length": one.data.size, "sha256": one.digest or _digest(one)}
            for one in groups.stored
        ],
    }
    if audio is not None:
        made["audio"] = {"mimeType": OPUS_TYPE, "first": audio.first, "length": len(audio.data)}
    return place_groups(made, chunk)


def place_groups(timeline: Mapping[str, Any], chunk: GroupsChunk | None) -> dict[str, Any]:
    """The timeline of the same clip with the places of its groups and its sound in a chunk; None: they are files."""
    made = {key: value for key, value in timeline.items() if key != GROUP_FILES}
    offsets = [None] * (len(made["groups"]) + 1) if chunk is None else chunk.offsets
    made["groups"] = [_placed(one, offset) for one, offset in zip(made["groups"], offsets, strict=False)]
    if "audio" in made:
        made["audio"] = _placed(made["audio"], offsets[len(made["groups"])])
    return made if chunk is not None else {**made, GROUP_FILES: True}


def _placed(entry: Mapping[str, Any], offset: int | None) -> dict[str, Any]:
    """An entry with an offset before its length, or without one."""
    made: dict[str, Any] = {}
    for key, value in entry.items():
        if key == "length" and offset is not None:
            made["offset"] = offset
        if key != "offset":
            made[key] = value
    return made


def _digest(group: StoredGroup) -> str:
    digest = hashlib.sha256()
    for piece in ByteRange(group.data, 0, group.data.size).pieces():
        digest.update(piece)
    return digest.hexdigest()
