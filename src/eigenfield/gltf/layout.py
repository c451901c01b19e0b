"""The layout of a scene file, every number checked, its pictures not yet decoded.

Each check raises FormatError. `load` stops at the first; `validate` notes it and goes on with the next part: the same
code, through `Findings.part`.
"""

from __future__ import annotations

import itertools
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
from eigenfield.gltf.document import Document
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.layout_geometry import (
    CameraList,
    read_cameras,
    read_coded_mesh,
    read_mesh,
    read_triangles,
    read_view_plane,
)
from eigenfield.gltf.layout_planes import PlaneLayout, check_colours, read_matrix, read_planes
from eigenfield.gltf.layout_residual import read_residual
from eigenfield.gltf.streams import FEATURES, LATEST, minor
from eigenfield.gltf.strict_json import Value, quote

_KEYS = {
    "version", "needs", "mesh", "planes", "toRGB", "cameras", "viewPlane", "times", "reference", "residual",
    "settings", "scores", "generator",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class FileLayout:
    """A whole file; a part that could not be read is None (only while validating).

    Attributes:
        version: Of the format.
        mesh: The proxy.
        mesh_payload: Its stream; None where it is plain.
        planes: Means and bases.
        cameras: All of them.
        view_plane: Through the cameras.
        triangles: (T, 3) of encoded cameras on it.
        reference: Index of the reference camera.
        to_rgb: (3, K) from the channels of all planes; None: they are R, G, B.
        residual: Of captured views.
        settings: A JSON object.
        scores: A JSON object.
        generator: The program that wrote it.
        times: In seconds.
    """

    version: str
    mesh: Mesh | None
    mesh_payload: Payload | None
    planes: tuple[PlaneLayout, ...] | None
    cameras: CameraList | None
    view_plane: ViewPlane | None
    triangles: NDArray[np.int32] | None
    reference: int | None
    to_rgb: NDArray[np.float32] | None
    residual: Residual | None
    settings: Mapping[str, Any]
    scores: Mapping[str, Any]
    generator: str
    times: tuple[float, ...]

    @property
    def lost(self) -> int:
        """Eigen textures behind the end of a file that is cut off."""
        return sum(plane.lost for plane in self.planes or ())


def read_layout(document: Document, findings: Findings) -> FileLayout | None:
    """Check everything but the pictures' contents; None if the file is no scene at all (only while validating)."""
    extension = None
    with findings.part():
        found = find_extension(document)
        document.check_end(found)
        extension = found
    if extension is None:
        return None
    version = extension["version"].text()
    if minor(version) > LATEST:
        findings.note(
            "information", "newer-version", f"{extension.where}/version", f"version {version}: what it adds is ignored"
        )
    for key in sorted(extension.mapping().keys() - _KEYS):
        findings.note("information", "unknown-key", extension.where, f"{quote(key)} is ignored")
    if limits.EXTENSION not in _names(document, "extensionsUsed"):
        findings.note("warning", "extension-not-used", "/extensionsUsed", f"does not name {limits.EXTENSION}")
    if limits.EXTENSION in _names(document, "extensionsRequired"):
        findings.note(
            "warning", "extension-required", "/extensionsRequired", "keeps other viewers from showing the mean"
        )
    mesh = mesh_payload = cameras = planes = view_plane = triangles = reference = to_rgb = residual = None
    settings: Mapping[str, Any] = {}
    scores: Mapping[str, Any] = {}
    generator = ""
    times: tuple[float, ...] = (0.0,)
    with findings.part():
        document.check_buffer()
    with findings.part():
        document.check_overlap()
    with findings.part():
        mesh = read_mesh(document)  # of a coded one the coarse one, which is checked too
        if extension.has("mesh"):
            mesh, mesh_payload = read_coded_mesh(document, extension["mesh"])
    with findings.part():
        cameras = read_cameras(document, extension["cameras"])
    with findings.part():
        times = read_times(extension)
    with findings.part():
        planes = read_planes(document, extension["planes"], cameras, len(times), findings)
    with findings.part():
        to_rgb = read_matrix(extension, planes)
    with findings.part():
        check_colours(extension["cameras"], cameras, planes, to_rgb)
    with findings.part():
        view_plane = read_view_plane(extension["viewPlane"])
    with findings.part():
        triangles = read_triangles(document, extension["viewPlane"], cameras)
    with findings.part():
        count = limits.MAX_CAMERAS if cameras is None else len(cameras.names)
        reference = extension["reference"].integer(0, count - 1)
    with findings.part():
        if not findings.strict and any(plane.lost for plane in planes or ()):
            raise document.glb.cut_off()  # a fault, though what is left can be drawn
    with findings.part():
        residual = read_residual(document, extension, cameras, findings)
    with findings.part():
        settings = extension["settings"].mapping() if extension.has("settings") else {}
    with findings.part():
        scores = extension["scores"].mapping() if extension.has("scores") else {}
    with findings.part():
        generator = extension["generator"].text() if extension.has("generator") else ""
    return FileLayout(
        version, mesh, mesh_payload, planes, cameras, view_plane, triangles, reference, to_rgb, residual, settings,
        scores, generator, times,
    )  # fmt: skip


def read_times(extension: Value) -> tuple[float, ...]:
    """The instants of the observations, in seconds; by default one.

    Raises:
        FormatError: `times`, `json-*`.
    """
    if not extension.has("times"):
        return (0.0,)
    entry = extension["times"]
    times = tuple(item.number() for item in entry.items(limits.MAX_TIMES, 1))
    if any(after <= before for before, after in itertools.pairwise(times)):
        entry.fail("times", "instants do not follow one another")
    return times


def find_extension(document: Document) -> Value:
    """Our root extension, of a version and with needs that this reader knows.

    Raises:
        FormatError: `gltf-version`, `not-a-scene`, `version`, `needs`.
    """
    root = document.root
    asset = root["asset"]["version"]
    if not re.fullmatch(r"2\.\d+", asset.text()):
        asset.fail("gltf-version", f"glTF {quote(asset.value)}, 2.x expected")
    if not root.has("extensions") or not root["extensions"].has(limits.EXTENSION):
        raise FormatError(
            "not-a-scene",
            f"a glTF file without {limits.EXTENSION}: no eigen-texture scene",
            where="/extensions",
            remedy="name a file that `eigenfield encode` made",
        )
    extension = root["extensions"][limits.EXTENSION]
    version = extension["version"]
    if not re.fullmatch(r"1\.\d{1,9}", version.text()):
        raise FormatError(
            "version",
            f"version {quote(version.value)} of {limits.EXTENSION}, 1.x is read here",
            where=version.where,
            remedy="use a later eigenfield",
        )
    if extension.has("needs"):
        for need in extension["needs"].items(limits.MAX_VIEWS):
            if need.text() not in FEATURES:
                raise FormatError(
                    "needs",
                    f"needs the unknown feature {quote(need.value)}",
                    where=need.where,
                    remedy="use a later eigenfield",
                )
    return extension


def _names(document: Document, key: str) -> list[Any]:
    found = document.root.mapping().get(key, [])
    return found if isinstance(found, list) else []
