"""The layout of a scene file, every number checked, its pictures not yet decoded.

Each check raises FormatError. `load` stops at the first; `validate` notes it and goes on with the next part: the same
code, through `Findings.part`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payload
from eigenfield.core.scene import Residual
from eigenfield.core.viewplane import ViewPlane
from eigenfield.gltf import layout_geometry as geometry
from eigenfield.gltf import packed
from eigenfield.gltf.container import Glb, parse_glb
from eigenfield.gltf.document import Document
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.layout_planes import PlaneLayout, check_colours, read_matrix, read_planes
from eigenfield.gltf.layout_residual import read_residual
from eigenfield.gltf.layout_sheets import SheetsLayout, check_sheets, read_sheets
from eigenfield.gltf.source import ByteSource
from eigenfield.gltf.streams import FEATURES, LATEST, minor
from eigenfield.gltf.strict_json import Value, quote

_KEYS = {
    "version", "needs", "mesh", "sheets", "planes", "toRGB", "cameras", "viewPlane", "reference",
    "residual", "settings", "scores", "generator",
}  # fmt: skip
_SEVERAL_INSTANTS = {  # keys and features of files that are no scene of one instant: what they are, and the remedy
    "timeline": ("is a clip (`timeline`), and a scene is of one instant", "use a later eigenfield"),
    "times": ("has weights for several instants (`times`), which no version reads", "encode each instant on its own"),
}


@dataclass(frozen=True, eq=False)
class FileLayout:
    """A whole file; a part that could not be read is None (only while validating).

    Attributes:
        mesh_payload: Its stream; None where it is plain.
        sheets: Of the proxy; None: it is one opaque surface.
        triangles: (T, 3) of encoded cameras.
        to_rgb: (3, K) from the channels of all planes; None: they are R, G, B.
    """

    version: str
    mesh: Mesh | None
    mesh_payload: Payload | None
    sheets: SheetsLayout | None
    planes: tuple[PlaneLayout, ...] | None
    cameras: geometry.CameraList | None
    view_plane: ViewPlane | None
    triangles: NDArray[np.int32] | None
    reference: int | None
    to_rgb: NDArray[np.float32] | None
    residual: Residual | None
    settings: Mapping[str, Any]
    scores: Mapping[str, Any]
    generator: str

    @property
    def lost(self) -> int:
        """Eigen textures behind the end of a file that is cut off."""
        return sum(plane.lost for plane in self.planes or ())


def open_document(data: bytes | ByteSource) -> Document:
    """The container and the unpacked JSON of a file of these bytes."""
    return unpacked_document(parse_glb(data))


def unpacked_document(glb: Glb) -> Document:
    """As `open_document`, of a container."""
    if packed.is_packed(glb):
        find_extension(Document(glb))  # whose needs may be unknown
    return Document(packed.unpack(glb))


def read_layout(document: Document, findings: Findings) -> FileLayout | None:
    """Check everything but the pictures' contents; None if the file is no scene at all (only while validating)."""

    def root_extension() -> Value:
        found = find_extension(document)
        document.check_end(found)
        return found

    attempt, note = findings.attempt, findings.note
    extension = attempt(root_extension)
    if extension is None:
        return None
    version = extension["version"].text()
    if minor(version) > LATEST:
        text = f"version {version}: what it adds is ignored"
        note("information", "newer-version", f"{extension.where}/version", text)
    for key in sorted(extension.mapping().keys() - _KEYS):
        note("information", "unknown-key", extension.where, f"{quote(key)} is ignored")
    if limits.EXTENSION not in _names(document, "extensionsUsed"):
        note("warning", "extension-not-used", "/extensionsUsed", f"does not name {limits.EXTENSION}")
    if limits.EXTENSION in _names(document, "extensionsRequired"):
        note("warning", "extension-required", "/extensionsRequired", "keeps other viewers from showing the mean")
    attempt(document.check_buffer)
    attempt(document.check_overlap)
    sheets = attempt(lambda: read_sheets(document, extension["sheets"]) if extension.has("sheets") else None)
    mesh = mesh_payload = None
    with findings.part():
        if document.root.has("meshes") or not extension.has("mesh"):
            mesh = geometry.read_mesh(document)  # of a coded one the coarse one, which is checked too
        if extension.has("mesh"):
            mesh, mesh_payload = geometry.read_coded_mesh(document, extension["mesh"])
    attempt(lambda: check_sheets(extension["sheets"], sheets, mesh) if extension.has("sheets") else None)
    cameras = attempt(lambda: geometry.read_cameras(document, extension["cameras"]))
    planes = attempt(lambda: read_planes(document, extension["planes"], cameras, findings))
    to_rgb = attempt(lambda: read_matrix(extension, planes))
    attempt(lambda: check_colours(extension["cameras"], cameras, planes, to_rgb))
    view_plane = attempt(lambda: geometry.read_view_plane(extension["viewPlane"]))
    triangles = attempt(lambda: geometry.read_triangles(document, extension["viewPlane"], cameras))
    count = limits.MAX_CAMERAS if cameras is None else len(cameras.names)
    reference = attempt(lambda: extension["reference"].integer(0, count - 1))
    with findings.part():
        if not findings.strict and any(plane.lost for plane in planes or ()):
            raise document.glb.cut_off()  # a fault, though what is left can be drawn
    residual = attempt(lambda: read_residual(document, extension, cameras, findings))
    settings = attempt(lambda: extension["settings"].mapping() if extension.has("settings") else {}) or {}
    scores = attempt(lambda: extension["scores"].mapping() if extension.has("scores") else {}) or {}
    generator = attempt(lambda: extension["generator"].text() if extension.has("generator") else "") or ""
    attempt(document.check_addresses)
    return FileLayout(
        version, mesh, mesh_payload, sheets, planes, cameras, view_plane, triangles, reference, to_rgb, residual,
        settings, scores, generator,
    )  # fmt: skip


def find_extension(document: Document) -> Value:
    """Our root extension, of a version and with needs that this reader knows. FormatError `gltf-version`,
    `not-a-scene`, `version`, `needs`, `timeline`, `times`."""
    root = document.root
    asset = root["asset"]["version"]
    if not re.fullmatch(r"2\.\d+", asset.text()):
        asset.fail("gltf-version", f"glTF {quote(asset.value)}, 2.x expected")
    if not root.has("extensions") or not root["extensions"].has(limits.EXTENSION):
        message = f"a glTF file without {limits.EXTENSION}: no eigen-texture scene"
        remedy = "name a file that `eigenfield encode CAPTURE -o scene.glb` wrote"
        raise FormatError("not-a-scene", message, where="/extensions", remedy=remedy)
    extension = root["extensions"][limits.EXTENSION]
    version = extension["version"]
    if not re.fullmatch(r"1\.\d{1,9}", version.text()):
        message = f"version {quote(version.value)} of {limits.EXTENSION}, 1.x is read here"
        version.fail("version", message, "use a later eigenfield")
    needs = list(extension["needs"].items(limits.MAX_VIEWS)) if extension.has("needs") else []
    for name, (message, remedy) in _SEVERAL_INSTANTS.items():
        if extension.has(name) or name in [need.value for need in needs]:
            extension.fail(name, message, remedy)
    for need in needs:
        if need.text() not in FEATURES:
            need.fail("needs", f"needs the unknown feature {quote(need.value)}", "use a later eigenfield")
    return extension


def _names(document: Document, key: str) -> list[Any]:
    found = document.root.mapping().get(key, [])
    return found if isinstance(found, list) else []
