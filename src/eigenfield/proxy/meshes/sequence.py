"""A mesh for each frame of a clip: the same triangles for some frames in a row, each with its own positions."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.proxy.meshes.formats import RawMesh
from eigenfield.proxy.meshes.read import check_mesh, raw_of, read_raw

NUMBER = re.compile(r"%0?\d*d")  # where the number stands in the name of a sequence
SEQUENCE_REMEDY = "give one mesh for each frame of the clip"


@dataclass(frozen=True, eq=False)
class MeshSequence:
    """A mesh over frames in a row whose meshes have the same triangles.

    Attributes:
        first: The first of these frames, counted in the clip.
        mesh: Its mesh, without what cannot be used of it; with its own texture coordinates or none.
        faces: (m, 3) of all that were given.
        positions: (T, v, 3) float32 of all that were given.
    """

    first: int
    mesh: Mesh
    faces: NDArray[np.int64]
    positions: NDArray[np.float32]

    def vertices_of(self, mesh: Mesh) -> NDArray[np.int64]:
        """(n,) which vertex of those given each vertex is of a mesh that has exactly their places in the first frame.

        Vertices at one place are told apart by the triangles that they belong to.
        """
        given = self.positions[0]
        _, place = np.unique(np.concatenate([given, mesh.vertices]), axis=0, return_inverse=True)
        place = place.reshape(-1)
        ours, theirs = place[: len(given)][self.faces], place[len(given) :][mesh.faces]
        order, sought = np.argsort(ours, axis=1), np.argsort(theirs, axis=1)
        rows = np.concatenate([np.take_along_axis(ours, order, 1), np.take_along_axis(theirs, sought, 1)])
        _, first, same = np.unique(rows, axis=0, return_index=True, return_inverse=True)
        match = first[same.reshape(-1)[len(ours) :]]
        found = np.zeros(len(mesh.vertices), np.int64)
        corners = np.take_along_axis(self.faces[match], order[match], 1)
        found[np.take_along_axis(mesh.faces, sought, 1)] = corners
        return found


def mesh_files(pattern: str | os.PathLike[str]) -> list[Path]:
    """The files of a numbered sequence, in order: one number after the other from the lowest that there is.

    Args:
        pattern: A path whose name holds %d or %04d where the number stands.

    Raises:
        ProxyError: `proxy-missing`, there is none; `proxy-gap`, a number is left out.
    """
    path = Path(pattern)
    head, tail = NUMBER.split(path.name, maxsplit=1)
    name = re.compile(f"{re.escape(head)}([0-9]+){re.escape(tail)}")
    there = sorted(path.parent.iterdir()) if path.parent.is_dir() else []
    found = {int(match[1]): one for one in there if (match := name.fullmatch(one.name)) is not None}
    if not found:
        raise ProxyError("proxy-missing", "no mesh has such a name", path=path, remedy=SEQUENCE_REMEDY)
    numbers = range(min(found), max(found) + 1)
    for number in numbers:
        if number not in found:
            message = f"mesh {number} of those from {numbers[0]} to {numbers[-1]} is not there"
            raise ProxyError("proxy-gap", message, path=path, remedy=SEQUENCE_REMEDY)
    return [found[number] for number in numbers]


def is_sequence(proxy: object) -> bool:
    """Whether a proxy is a mesh for each frame: several meshes, or a path in whose name a number is left open."""
    if isinstance(proxy, str | os.PathLike):
        return NUMBER.search(Path(proxy).name) is not None and not Path(proxy).exists()
    return isinstance(proxy, Sequence)


def read_sequences(
    given: str | os.PathLike[str] | Sequence[str | os.PathLike[str] | Mesh],
    frames: int,
    origin: NDArray[np.float64] | None = None,
) -> list[MeshSequence]:
    """Read a mesh for each of so many frames. Where a mesh has other triangles than the one before, another sequence
    begins.

    Args:
        given: Meshes, their files, or the pattern of `mesh_files`.
        origin: As of `read_mesh`, of files alone.

    Raises:
        ProxyError: As `mesh_files` and `read_mesh`; `proxy-count`, not as many meshes as frames; `proxy-not-finite`.
    """
    path = Path(given) if isinstance(given, str | os.PathLike) else None
    meshes = mesh_files(path) if path is not None else cast("Sequence[Path | Mesh]", given)
    if len(meshes) != frames:
        message = f"{len(meshes)} meshes, the clip has {frames} frames"
        raise ProxyError("proxy-count", message, path=path, remedy=SEQUENCE_REMEDY)
    found: list[tuple[int, Mesh, RawMesh, list[NDArray[np.float32]]]] = []
    for number, one in enumerate(meshes):
        raw, name = _raw(one, origin), None if isinstance(one, Mesh) else Path(one)
        if not found or not _same_faces(raw, found[-1][2]):
            found.append((number, check_mesh(raw, name), raw, []))
        with np.errstate(over="ignore"):
            positions = raw.vertices.astype(np.float32)
        if found[-1][3] and not np.isfinite(positions[np.unique(raw.faces)]).all():
            message = f"frame {number}: vertices have NaN or infinite positions"
            raise ProxyError("proxy-not-finite", message, path=name, remedy="export it again")
        found[-1][3].append(positions)
    return [MeshSequence(first, mesh, raw.faces.astype(np.int64), np.stack(positions))
            for first, mesh, raw, positions in found]  # fmt: skip


def _same_faces(one: RawMesh, other: RawMesh) -> bool:
    return one.vertices.shape == other.vertices.shape and np.array_equal(one.faces, other.faces)


def _raw(one: str | os.PathLike[str] | Mesh, origin: NDArray[np.float64] | None) -> RawMesh:
    return raw_of(one) if isinstance(one, Mesh) else read_raw(one, origin)
