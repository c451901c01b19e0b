"""A clip whose groups are coded: each is decoded when it is asked for, and a frame when it is taken."""

from __future__ import annotations

import contextlib
import hashlib
import threading
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.coding.codecs import CODECS
from eigenfield.coding.pictures.quantise import mean_values, opacity_values
from eigenfield.coding.video.film import decode_film
from eigenfield.coding.video.film_layout import pictures_of
from eigenfield.core.appearance import Appearance, Basis, Plane
from eigenfield.core.clip import Clip, Frame, Group, Timeline
from eigenfield.core.errors import FormatError
from eigenfield.core.films import CodedGroup, FilmLayout, FilmPart
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payload, Payloads, mesh_key, weights_key
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.core.rig import Rig
from eigenfield.gltf.group import read_group, read_head
from eigenfield.gltf.source import ByteSource, FileBeside, HeldBytes, StoredBytes, name_file_in_errors

if TYPE_CHECKING:
    from eigenfield.coding.mesh.coder import PlacedMesh

_AGAIN = "copy or download the file again"


@dataclass(frozen=True, eq=False)
class StoredGroup:
    """A group as it lies in a file.

    Attributes:
        digest: SHA-256 of its bytes, hexadecimal; None: not known, and not checked.
    """

    data: ByteSource
    frames: int
    digest: str | None = None

    def name_in_errors(self) -> contextlib.AbstractContextManager[None]:
        """Put the name of its file into every FormatError."""
        if isinstance(self.data, StoredBytes | FileBeside):
            return name_file_in_errors(self.data.path)
        return contextlib.nullcontext()


def coded_clip(
    rig: Rig,
    mesh: Mesh,
    timeline: Timeline,
    layout: FilmLayout,
    groups: Sequence[ByteSource | bytes],
    lengths: Sequence[int],
    *,
    to_rgb: NDArray[np.float32] | None,
    settings: Mapping[str, Any],
    scores: Mapping[str, Any],
    generator: str,
    payloads: Payloads,
    sheets: tuple[int, ...] | None = None,
) -> Clip:
    """A clip of coded groups.

    Args:
        mesh: As its stream decodes.
        groups: Bytes of each (`group.group_bytes`).
        lengths: Frames of each.
        payloads: What the mesh, and maybe the rig's cameras, were coded to.
        sheets: Faces of each, back to front, where the layout has an opacity; else None.
    """
    sources = [HeldBytes(one) if isinstance(one, bytes) else one for one in groups]
    stored = [StoredGroup(source, frames) for source, frames in zip(sources, lengths, strict=True)]
    made = CodedGroups(layout, stored, rig, mesh, to_rgb, payloads, sheets)
    return Clip(rig, timeline, made, settings, scores, generator)


@dataclass(frozen=True, eq=False)
class CodedGroups:
    """The groups of a clip as they are coded. The one that was decoded last is kept.

    Attributes:
        mesh: Of the groups that have none of their own.
        payloads: Of this mesh, and maybe the cameras.
        sheets: Faces of each, back to front; None: one opaque surface.
    """

    layout: FilmLayout
    stored: Sequence[StoredGroup]
    rig: Rig
    mesh: Mesh
    to_rgb: NDArray[np.float32] | None
    payloads: Payloads
    sheets: tuple[int, ...] | None = None
    _kept: dict[int, Group] = field(default_factory=dict, init=False, repr=False)
    _placed: dict[bytes, PlacedMesh] = field(default_factory=dict, init=False, repr=False)

    @property
    def lengths(self) -> Sequence[int]:
        """Frames of each group."""
        return [one.frames for one in self.stored]

    def group(self, index: int) -> Group:
        """A group, of which the first frame is decoded. FormatError: see `coded`; `film-*`, `coded-*`, `weights-*`."""
        kept = self._kept.get(index)
        if kept is None:
            with self.stored[index].name_in_errors():
                kept = self._decode(index)
            self._kept.clear()
            self._kept[index] = kept
        return kept

    def moves(self, index: int) -> bool:
        """Whether the mesh moves in a group; its head alone is read. FormatError `group-damaged`."""
        return read_head(self.stored[index].data, self.layout, group_place(index)).motion > 0

    def read(self, index: int) -> bytes:
        """The bytes of a group, which are those that its digest says. FormatError `truncated`, `group-damaged`,
        `group-missing`."""
        one, where = self.stored[index], group_place(index)
        data = bytes(one.data.read(0, one.data.size))
        if len(data) < one.data.size:
            message, remedy = f"the file ends after {len(data)} of the group's {one.data.size} bytes", _AGAIN
            raise FormatError("truncated", message, where=where, remedy=remedy)
        if one.digest is not None and hashlib.sha256(data).hexdigest() != one.digest:
            file = f" in {one.data.name}" if isinstance(one.data, FileBeside) else ""
            message = f"the group's bytes{file} are not those that were written"
            raise FormatError("group-damaged", message, where=where, remedy=_AGAIN)
        return data

    def coded(self, index: int) -> CodedGroup:
        """A group as it is coded, its streams not decoded. FormatError as `read`."""
        one, where = self.stored[index], group_place(index)
        coded = read_group(self.read(index), self.layout, where)
        if len(coded.units) != one.frames:
            message = f"a group of {len(coded.units)} frames, {one.frames} are announced"
            raise FormatError("group-damaged", message, where=where)
        return coded

    def _decode(self, index: int) -> Group:
        coded, where = self.coded(index), group_place(index)
        mesh, payloads = self.mesh, self.payloads
        if coded.mesh is not None:
            if self.sheets is not None:
                raise FormatError("group-damaged", "a mesh of its own, in a clip with sheets", where=where)
            mesh = self._placed_mesh(coded.mesh, where).mesh
            payloads = payloads.without("mesh") | {mesh_key(mesh): [coded.mesh]}
        motion = None if coded.motion is None else self._motion(coded, where)
        frames = CodedFrames(coded, self.layout, where, self.stored[index], motion)
        first, planes = frames[0], []
        parts = zip(first.means, first.textures, coded.bases, coded.weights, strict=True)
        for mean, own, affines, streams in parts:
            bases = []
            for textures, affine, stream in zip(own, affines, streams, strict=True):
                count, _, _, channels = textures.shape
                weights = self._weights(stream, count, where)
                scale, zero = (one.reshape(count, channels).astype(np.float32) for one in (affine.scale, affine.zero))
                bases.append(Basis(textures, scale, zero, weights))
                payloads |= {weights_key(weights): [stream]}
            planes.append(Plane(mean, tuple(bases)))
        mesh = mesh if first.vertices is None else replace(mesh, vertices=first.vertices)
        sheets = None if self.sheets is None or first.opacity is None else Sheets(self.sheets, first.opacity)
        return Group(Proxy(mesh, sheets=sheets), Appearance(tuple(planes), self.to_rgb), frames, payloads)

    def _placed_mesh(self, stream: Payload, where: str) -> PlacedMesh:
        """A mesh on its lattice; the last one is kept. FormatError `coded-*`."""
        if stream.data not in self._placed:
            from eigenfield.coding.mesh.coder import decode_placed  # loads numba, which files without it do not want

            placed = decode_placed(stream.data, where, stream.data[0])
            if not len(placed.mesh.faces):
                raise FormatError("coded-damaged", "a mesh without faces", where=where)
            self._placed.clear()
            self._placed[stream.data] = placed
        return self._placed[stream.data]

    def _motion(self, coded: CodedGroup, where: str) -> Motion:
        stream, frames = coded.motion, len(coded.units)
        assert stream is not None
        placed = self._placed_mesh(coded.mesh or self.payloads.only("mesh"), where)
        moving, steps = CODECS[stream.codec].decode(stream.data, placed.places, placed.mesh.faces, where)
        if len(steps) != frames:
            message = f"vertices move in {len(steps)} frames, the group has {frames}"
            raise FormatError("group-damaged", message, where=where)
        return Motion(placed, moving, steps, where)

    def _weights(self, stream: Payload, count: int, where: str) -> NDArray[np.float32]:
        weights: NDArray[np.float32] = CODECS[stream.codec].decode(stream.data, where)
        rows = len(self.rig.encoded)
        if weights.shape != (rows, count):
            found = "x".join(map(str, weights.shape))
            message = f"{found} weights, {rows} observations x {count} textures expected"
            raise FormatError("weights-count", message, where=where)
        return weights

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_kept": {}, "_placed": {}}


@dataclass(frozen=True, eq=False)
class Motion:
    """The vertices of a group's frames.

    Attributes:
        placed: The mesh of the file.
        moving: (n,) the vertices that move.
        steps: (T, n, 3) their lattice coordinates.
    """

    placed: PlacedMesh
    moving: NDArray[np.int64]
    steps: NDArray[np.int64]
    where: str

    def vertices(self, number: int) -> NDArray[np.float32]:
        """(V, 3) of a frame. FormatError `coded-damaged`, a lattice has no such point."""
        vertices = self.placed.mesh.vertices.copy()
        with np.errstate(over="ignore", invalid="ignore"):
            vertices[self.moving] = self.placed.lattice.points(self.steps[number])
        if not (np.abs(vertices) <= limits.MAX_NUMBER).all():
            raise FormatError("coded-damaged", "positions that are not finite", where=self.where)
        return vertices


def group_place(index: int) -> str:
    """The place of a group in the JSON, for errors."""
    return f"/extensions/{limits.EXTENSION}/timeline/groups/{index}"


class CodedFrames(Sequence[Frame]):
    """The frames of a group. One behind the last that was taken costs one picture of each film, one before it costs all
    from the first on.
    """

    def __init__(
        self, coded: CodedGroup, layout: FilmLayout, where: str, stored: StoredGroup, motion: Motion | None = None
    ) -> None:
        self._coded, self._layout, self._where, self._stored, self._motion = coded, layout, where, stored, motion
        self._lock = threading.Lock()
        self._films = self._pictures()
        self._next, self._last = 0, Frame((), ())

    def __len__(self) -> int:
        return len(self._coded.units)

    def __getitem__(self, number: int) -> Frame:  # type: ignore[override]  # there are no slices of it
        """FormatError `film-*`."""
        number = range(len(self))[number]
        with self._lock, self._stored.name_in_errors():
            if number == self._next - 1:
                return self._last
            if number < self._next:
                self._films, self._next = self._pictures(), 0
            try:
                pictures = self._skip(number - self._next)
            except BaseException:  # an iterator that has raised is at its end
                self._films, self._next = self._pictures(), 0
                raise
            self._next, self._last = number + 1, self._frame(number, pictures)
            return self._last

    def _skip(self, count: int) -> tuple[NDArray[np.uint16], ...]:
        """The pictures behind the next `count`."""
        for _ in range(count):
            next(self._films)
        return next(self._films)

    def _pictures(self) -> Iterator[tuple[NDArray[np.uint16], ...]]:
        """A picture of each film, frame after frame."""
        units = zip(*self._coded.units, strict=True)
        films = [
            decode_film(own, size, f"{self._where}, film {film}")
            for film, (own, size) in enumerate(zip(units, self._layout.sizes, strict=True))
        ]
        return zip(*films, strict=True)

    def _frame(self, number: int, pictures: Sequence[NDArray[np.uint16]]) -> Frame:
        means, textures = [], []
        for plane, affine in zip(self._layout.planes, self._coded.means, strict=True):
            mean = pictures_of(plane.mean, pictures[plane.mean.film])
            means.append(mean_values(np.moveaxis(mean, 0, -1), affine))
            textures.append(tuple(_texture_codes(part, pictures[part.film], plane.channels) for part in plane.bases))
        part = self._layout.opacity
        opacity = None if part is None else opacity_values(pictures_of(part, pictures[part.film])[0])
        vertices = None if self._motion is None else self._motion.vertices(number)
        return Frame(tuple(means), tuple(textures), opacity, vertices)


def _texture_codes(part: FilmPart, picture: NDArray[np.uint16], channels: int) -> NDArray[np.uint16]:
    """(N, H, W, C) of a basis."""
    codes = pictures_of(part, picture)
    return np.ascontiguousarray(codes.reshape(-1, channels, *part.size).transpose(0, 2, 3, 1))
