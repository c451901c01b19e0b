"""The sheets of a scene file: how the faces of the mesh are divided, and the picture of their opacity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.coding.pictures.quantise import opacity_values
from eigenfield.core.mesh import Mesh
from eigenfield.gltf.document import Document
from eigenfield.gltf.layout_planes import PictureLayout, read_picture, read_size
from eigenfield.gltf.strict_json import Value


@dataclass(frozen=True, eq=False)
class SheetsLayout:
    """The sheets in the file.

    Attributes:
        faces: Number of faces of each, back to front.
    """

    faces: tuple[int, ...]
    opacity: PictureLayout

    def decode(self) -> NDArray[np.float32]:
        """(H, W) opacity in 0..1. FormatError: see `stacking.decode`."""
        return opacity_values(self.opacity.decode()[0, ..., 0])


def read_sheets(document: Document, entry: Value) -> SheetsLayout:
    """The sheets, not compared with the mesh yet. FormatError `picture-*`, `codec-unknown`, `view-*`, `json-*`."""
    faces, opacity = read_faces(entry), entry["opacity"]
    return SheetsLayout(faces, read_picture(document, opacity, "opacity", read_size(opacity["size"], 1), 1, 1))


def read_faces(entry: Value) -> tuple[int, ...]:
    """Number of faces of each sheet. FormatError `json-*`."""
    return tuple(item.integer(1, limits.MAX_TRIANGLES) for item in entry["faces"].items(limits.MAX_SHEETS, 1))


def check_sheets(entry: Value, faces: tuple[int, ...], mesh: Mesh | None) -> None:
    """Check that sheets of so many faces divide the mesh. None: only while validating a damaged file. FormatError
    `sheets-faces`, `sheets-vertex`."""
    if mesh is None:
        return
    if sum(faces) != len(mesh.faces):
        entry["faces"].fail("sheets-faces", f"the sheets have {sum(faces)} faces, the mesh has {len(mesh.faces)}")
    sheet = np.repeat(np.arange(len(faces)), faces)[:, None]
    owner = np.zeros(len(mesh.vertices), np.int64)
    owner[mesh.faces] = sheet
    shared = owner[mesh.faces] != sheet
    if shared.any():
        face, corner = np.argwhere(shared)[0]
        one, other = sheet[face, 0], owner[mesh.faces[face, corner]]
        entry["faces"].fail("sheets-vertex", f"sheets {one} and {other} share vertex {mesh.faces[face, corner]}")
