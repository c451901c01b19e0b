"""The layout of a scene file, every number checked, its pictures not yet decoded.

Each check raises FormatError. `load` stops at the first; `validate` notes it and goes on with the next part: the same
code, through `Findings.part`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payload, Payloads, cameras_key, mesh_key
from eigenfield.core.rig import Rig
from eigenfield.core.rights import Rights
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
from eigenfield.gltf.rights import read_rights
from eigenfield.gltf.source import ByteSource
from eigenfield.gltf.streams import FEATURES, LATEST, minor
from eigenfield.gltf.strict_json import Value, quote

_KEYS = {
    "version", "needs", "mesh", "sheets", "planes", "toRGB", "cameras", "viewPlane", "reference",
    "residual", "timeline", "settings", "scores", "generator",
}  # fmt: skip
TIMELINE = "timeline"  # the key, and the feature, of a clip


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What files of scenes and of clips have in common; a part that could not be read is None (only while validating).

    Attributes:
        mesh_payload: Its stream; None where it is plain.
        triangles: (T, 3) of encoded cameras.
        to_rgb: (3, K) from the channels of all planes; None: they are R, G, B.
    """

    version: str
    mesh: Mesh | None
    mesh_payload: Payload | None
    cameras: geometry.CameraList | None
    view_plane: ViewPlane | None
    triangles: NDArray[np.int32] | None
    reference: int | None
    to_rgb: NDArray[np.float32] | None
    settings: Mapping[str, Any]
    scores: Mapping[str, Any]
    generator: str
    rights: Rights

    @property
    def rig(self) -> Rig:
        """The cameras of a file that was read strictly."""
        given, plane, triangles = self.cameras, self.view_plane, self.triangles
        assert given is not None and plane is not None and triangles is not None and self.reference is not None
        return Rig(given.names, given.cameras, given.held_out, self.reference, plane, triangles)

    @property
    def payloads(self) -> Payloads:
        """The streams of the mesh and the cameras of a file that was read strictly, where they are coded."""
        assert self.mesh is not None and self.cameras is not None
        cameras = self.cameras.payload
        mesh = {} if self.mesh_payload is None else {mesh_key(self.mesh): [self.mesh_payload]}
        return Payloads(mesh | ({} if cameras is None else {cameras_key(self.cameras.cameras): [cameras]}))


@dataclass(frozen=True, eq=False)
class FileLayout(Surroundings):
    """The whole file of a scene; a part that could not be read is None (only while validating).

    Attributes:
        sheets: Of the proxy; None: it is one opaque surface.
    """

    sheets: SheetsLayout | None
    planes: tuple[PlaneLayout, ...] | None
    residual: Residual | None

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
        if is_clip(found):
            remedy = "name the time of one of its frames (`--time 1.5s`, in Python `time=1.5`)"
            found.fail("timeline", "is a clip, and a scene of one instant is expected", remedy)
        document.check_end(found)
        return found

    attempt = findings.attempt
    extension = attempt(root_extension)
    if extension is None:
        return None
    check_container(document, extension, findings)
    sheets = attempt(lambda: read_sheets(document, extension["sheets"]) if extension.has("sheets") else None)
    cameras = attempt(lambda: geometry.read_cameras(document, extension["cameras"]))
    planes = attempt(lambda: read_planes(document, extension["planes"], cameras, findings))
    channels = None if planes is None else [plane.mean.channels for plane in planes]
    around = read_surroundings(document, extension, cameras, channels, findings)
    if sheets is not None:
        attempt(lambda: check_sheets(extension["sheets"], sheets.faces, around.mesh))
    with findings.part():
        if not findings.strict and any(plane.lost for plane in planes or ()):
            raise document.glb.cut_off()  # a fault, though what is left can be drawn
    residual = attempt(lambda: read_residual(document, extension, cameras, findings))
    attempt(document.check_addresses)
    return FileLayout(**vars(around), sheets=sheets, planes=planes, residual=residual)


def check_container(document: Document, extension: Value, findings: Findings) -> None:
    """Check what surrounds the extension, and note what is odd in it."""
    attempt, note = findings.attempt, findings.note
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


def read_surroundings(
    document: Document, extension: Value, cameras: geometry.CameraList | None, planes: Sequence[int] | None,
    findings: Findings,
) -> Surroundings:  # fmt: skip
    """What a scene and a clip have in common.

    Args:
        cameras: None where they could not be read (only while validating), as are `planes`.
        planes: Channels of each.
    """
    attempt = findings.attempt
    mesh, mesh_payload = attempt(lambda: _read_mesh(document, extension)) or (None, None)
    to_rgb = attempt(lambda: read_matrix(extension, None if planes is None else sum(planes)))
    attempt(lambda: check_colours(extension["cameras"], cameras, planes, to_rgb))
    view_plane = attempt(lambda: geometry.read_view_plane(extension["viewPlane"]))
    triangles = attempt(lambda: geometry.read_triangles(document, extension["viewPlane"], cameras))
    count = limits.MAX_CAMERAS if cameras is None else len(cameras.names)
    reference = attempt(lambda: extension["reference"].integer(0, count - 1))
    settings = attempt(lambda: extension["settings"].mapping() if extension.has("settings") else {}) or {}
    scores = attempt(lambda: extension["scores"].mapping() if extension.has("scores") else {}) or {}
    generator = attempt(lambda: extension["generator"].text() if extension.has("generator") else "") or ""
    version = extension["version"].text()
    return Surroundings(
        version, mesh, mesh_payload, cameras, view_plane, triangles, reference, to_rgb, settings, scores, generator,
        read_rights(document, findings),
    )  # fmt: skip


def _read_mesh(document: Document, extension: Value) -> tuple[Mesh, Payload | None]:
    """The proxy, and its stream where it is coded."""
    coded = extension.has("mesh") or is_clip(extension)
    if coded and not document.root.has("meshes"):
        return geometry.read_coded_mesh(document, extension["mesh"])
    shown = geometry.read_mesh(document)  # beside a coded one the coarse one, which is checked too
    return geometry.read_coded_mesh(document, extension["mesh"]) if coded else (shown, None)


def find_extension(document: Document) -> Value:
    """Our root extension, of a version and with needs that this reader knows. FormatError `gltf-version`,
    `not-a-scene`, `version`, `needs`, `times`."""
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
    if extension.has("times") or "times" in [need.value for need in needs]:
        message = "has weights for several instants (`times`), which no version reads"
        extension.fail("times", message, "encode each instant on its own")
    for need in needs:
        if need.text() not in FEATURES:
            need.fail("needs", f"needs the unknown feature {quote(need.value)}", "use a later eigenfield")
    return extension


def is_clip(extension: Value) -> bool:
    """Whether a file is a clip, of which a frame is a scene."""
    return extension.has(TIMELINE)


def _names(document: Document, key: str) -> list[Any]:
    found = document.root.mapping().get(key, [])
    return found if isinstance(found, list) else []
