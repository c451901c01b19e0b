"""A group of frames as bytes (`group-1`): a deflated JSON head, then its streams one behind the other.

First come the weights, then maybe a mesh of its own and the motion of the mesh, then frame by frame a unit of each
film. A group that is still arriving can be shown as far as it is there.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from itertools import accumulate, chain, pairwise
from typing import Any

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError
from eigenfield.core.films import CodedGroup, FilmLayout
from eigenfield.core.payloads import Affine, Payload
from eigenfield.gltf import strict_json
from eigenfield.gltf.coded_pictures import affine_numbers
from eigenfield.gltf.container import json_bytes
from eigenfield.gltf.deflate import deflate, inflate
from eigenfield.gltf.layout_planes import read_affine
from eigenfield.gltf.source import ByteSource, HeldBytes
from eigenfield.gltf.strict_json import Value

HEAD = struct.Struct("<I")  # bytes of the deflated JSON, which follows
WEIGHTS_CODEC = "weights-1"
MESH_CODEC = "mesh-2"
MOTION_CODEC = "motion-1"


@dataclass(frozen=True, eq=False)
class GroupHead:
    """What a group says of its streams.

    Attributes:
        first: The first byte of the streams.
        weights: Lengths, of each basis of each plane.
        frames: Lengths: for each frame the unit of each film.
        mesh: The length; 0: it has the mesh of the file.
        motion: The length; 0: the mesh stands still.
    """

    first: int
    weights: tuple[tuple[int, ...], ...]
    means: tuple[Affine, ...]
    bases: tuple[tuple[Affine, ...], ...]
    frames: tuple[tuple[int, ...], ...]
    mesh: int
    motion: int

    @property
    def lengths(self) -> list[int]:
        """Of all streams, in their order."""
        geometry = [length for length in (self.mesh, self.motion) if length]
        return [*chain.from_iterable(self.weights), *geometry, *chain.from_iterable(self.frames)]


def group_bytes(group: CodedGroup) -> bytes:
    """The bytes of a group, the same each time."""
    assert all(weights.codec == WEIGHTS_CODEC for plane in group.weights for weights in plane)
    assert group.mesh is None or group.mesh.codec == MESH_CODEC
    geometry = {"mesh": group.mesh, "motion": group.motion}
    head = {
        "weights": [[len(weights.data) for weights in plane] for plane in group.weights],
        "means": [_affine(mean, len(mean.scale)) for mean in group.means],
        "bases": [
            [_affine(basis, len(mean.scale)) for basis in plane]
            for mean, plane in zip(group.means, group.bases, strict=True)
        ],
        "frames": [list(map(len, units)) for units in group.units],
        **{name: len(one.data) for name, one in geometry.items() if one is not None},
    }
    text = deflate(json_bytes(head).rstrip(b" "))
    streams = [weights.data for plane in group.weights for weights in plane]
    streams += [one.data for one in geometry.values() if one is not None]
    return b"".join([HEAD.pack(len(text)), text, *streams, *chain.from_iterable(group.units)])


def _affine(affine: Affine, channels: int) -> dict[str, Any]:
    """The numbers of each channel of each texture; of one texture, where all have the same."""
    count = len(affine.scale) // channels
    return {"scale": affine_numbers(affine.scale, count), "zero": affine_numbers(affine.zero, count)}


def read_group(data: bytes, layout: FilmLayout, where: str) -> CodedGroup:
    """The group of these bytes, its streams not decoded. FormatError `group-damaged`."""
    head = read_head(HeldBytes(data), layout, where)
    ends = accumulate(head.lengths, initial=head.first)
    streams = (data[start:end] for start, end in pairwise(ends))
    return CodedGroup(
        weights=tuple(tuple(Payload(WEIGHTS_CODEC, next(streams)) for _ in plane) for plane in head.weights),
        mesh=Payload(MESH_CODEC, next(streams)) if head.mesh else None,
        motion=Payload(MOTION_CODEC, next(streams)) if head.motion else None,
        means=head.means,
        bases=head.bases,
        units=tuple(tuple(next(streams) for _ in units) for units in head.frames),
    )


def read_head(group: ByteSource, layout: FilmLayout, where: str) -> GroupHead:
    """The head of a group, of which nothing else is read. FormatError `group-damaged`: it is not as specified, or the
    streams do not end where the group does; `group-missing`, as of `FileBeside`."""
    try:
        if group.size < HEAD.size:
            raise FormatError("group-damaged", f"{group.size} bytes have no length")
        first = HEAD.size + HEAD.unpack(group.read(0, HEAD.size))[0]
        if first > group.size:
            raise FormatError("group-damaged", f"the head ends at byte {first} of {group.size}")
        text = inflate(group.read(HEAD.size, first), limits.MAX_GROUP_JSON, "the head")
        if len(text) > limits.MAX_GROUP_JSON:
            raise FormatError("group-damaged", f"a head of more than {limits.MAX_GROUP_JSON} bytes")
        head = _head_of(Value(strict_json.parse(text)), first, layout)
    except FormatError as error:
        if error.where == where:  # of the file that it is
            raise
        raise FormatError("group-damaged", f"the group cannot be read: {error.message}", where=where) from error
    end = head.first + sum(head.lengths)
    if end != group.size:
        message = f"the group's streams end at byte {end}, not at {group.size}"
        raise FormatError("group-damaged", message, where=where)
    return head


def _head_of(entry: Value, first: int, layout: FilmLayout) -> GroupHead:
    planes = len(layout.planes)
    weights, means, bases = (list(entry[key].items(planes, planes)) for key in ("weights", "means", "bases"))
    films, frames = len(layout.sizes), entry["frames"].items(limits.MAX_GROUP_FRAMES, 1)
    return GroupHead(
        first=first,
        weights=tuple(
            tuple(map(_length, own.items(len(plane.bases), len(plane.bases))))
            for own, plane in zip(weights, layout.planes, strict=True)
        ),
        means=tuple(_read_affine(own, plane.channels, 1) for own, plane in zip(means, layout.planes, strict=True)),
        bases=tuple(
            tuple(
                _read_affine(one, plane.channels, len(part.at) // plane.channels)
                for one, part in zip(own.items(len(plane.bases), len(plane.bases)), plane.bases, strict=True)
            )
            for own, plane in zip(bases, layout.planes, strict=True)
        ),
        frames=tuple(tuple(map(_length, units.items(films, films))) for units in frames),
        mesh=_length(entry["mesh"]) if entry.has("mesh") else 0,
        motion=_length(entry["motion"]) if entry.has("motion") else 0,
    )


def _length(entry: Value) -> int:
    return entry.integer(1, limits.MAX_GROUP)


def _read_affine(entry: Value, channels: int, count: int) -> Affine:
    return Affine(*(read_affine(entry[key], channels, count) for key in ("scale", "zero")))
