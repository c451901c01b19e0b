"""GLB to scene: `load` refuses a file at its first error, `validate` lists them all; both run the same checks."""

from __future__ import annotations

import contextlib
import logging
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from eigenfield.coding import limits
from eigenfield.coding.pictures.pictures_8bit import check_preview
from eigenfield.coding.pictures.quantise import mean_values, spread_precision
from eigenfield.core.appearance import Appearance, Basis, Plane
from eigenfield.core.arguments import checked
from eigenfield.core.errors import FormatError
from eigenfield.core.payloads import (
    Coded,
    Payload,
    Payloads,
    cameras_key,
    mean_key,
    mesh_key,
    opacity_key,
    payloads_of,
    preview_key,
)
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.core.rig import Rig
from eigenfield.core.scene import Scene
from eigenfield.gltf.document import Document
from eigenfield.gltf.findings import Finding, Findings
from eigenfield.gltf.layout import FileLayout, open_document, read_layout
from eigenfield.gltf.layout_geometry import read_mesh
from eigenfield.gltf.layout_planes import BasisLayout, PlaneLayout, read_image
from eigenfield.gltf.layout_residual import residual_frames
from eigenfield.gltf.source import ByteSource, open_source, read_file
from eigenfield.gltf.streams import streams
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.format")


@contextlib.contextmanager
def name_file_in_errors(path: str | os.PathLike[str]) -> Iterator[None]:
    """Put the file's name into every FormatError, and turn a lack of memory into one."""
    try:
        yield
    except FormatError as error:
        error.path = os.fspath(path)
        raise
    except MemoryError as error:
        message, remedy = "does not fit into memory", "open it on a larger machine"
        raise FormatError("memory", message, path=path, remedy=remedy) from error


def layout_of(data: bytes | ByteSource) -> tuple[Document, FileLayout]:
    """Container and checked layout of a file of these bytes, pictures not decoded."""
    document = open_document(data)
    layout = read_layout(document, Findings(strict=True))
    assert layout is not None
    return document, layout


@checked
def load(path: str | os.PathLike[str]) -> Scene:
    """Read a scene: float32 means, uint8 or uint16 textures with their scale and zero, and their payloads.

    Limits are checked before memory is taken.

    Raises:
        FormatError: With a stable `code`, and `where`, for anything that is not as docs/format.md specifies; the
            content of a file never raises another exception.
    """
    with name_file_in_errors(path), open_source(Path(path)) as source:
        return read_scene(source)


def as_scene(scene: Scene | str | os.PathLike[str]) -> Scene:
    """The scene itself, or what `load` reads from its file, with its errors."""
    return scene if isinstance(scene, Scene) else load(scene)


def read_scene(data: bytes | ByteSource) -> Scene:
    """The scene in a file of these bytes, with the errors of `load`."""
    return _scene_of(data, pictures=True)


def outline(path: str | os.PathLike[str]) -> tuple[Scene, bytes]:
    """A scene without its planes and sheets, and the bytes of its file: checked as `load` does, but no picture is
    decoded."""
    with name_file_in_errors(path):
        data = read_file(Path(path))
        return _scene_of(data, pictures=False), data


def _scene_of(data: bytes | ByteSource, pictures: bool) -> Scene:
    document, layout = layout_of(data)
    bases = [basis for plane in layout.planes or () for basis in plane.bases]
    if layout.lost:
        found = sum(basis.count for basis in bases)
        words = "the file ends within its eigen textures: views are drawn of %d of %d (copy or download it again)"
        log.warning(words, found, found + layout.lost)
    elif document.glb.missing:
        log.warning("the file ends within its residual: captured views go without (copy or download it again)")
    planes = [_decode_plane(plane) for plane in layout.planes or ()] if pictures else []
    sheets = _decode_sheets(layout) if pictures else None
    return _scene(layout, planes, sheets, _preview(document, layout))


def _preview(document: Document, layout: FileLayout) -> Payload | None:
    """The picture for other viewers; None where it is a mean itself, or is none that they show."""
    with contextlib.suppress(FormatError):
        image = read_image(document, 3)
        if image.codec in ("png", "jpeg") and image.where not in [plane.mean.where for plane in layout.planes or ()]:
            return Payload(image.codec, bytes(image.data))
    return None


def _scene(
    layout: FileLayout, planes: Sequence[Coded[Plane]], sheets: Coded[Sheets] | None, preview: Payload | None
) -> Scene:
    mesh, given, view_plane = layout.mesh, layout.cameras, layout.view_plane
    assert mesh is not None and given is not None and view_plane is not None
    assert layout.triangles is not None and layout.reference is not None
    payloads = Payloads.merge(plane.payloads for plane in planes)
    if layout.mesh_payload is not None:
        payloads |= {mesh_key(mesh): [layout.mesh_payload]}
    if sheets is not None:
        payloads |= sheets.payloads
    if given.payload is not None:
        payloads |= {cameras_key(given.cameras): [given.payload]}
    if planes and preview is not None and layout.mesh_payload is None:
        sources = [next(key for key in plane.payloads if key[0] == "mean") for plane in planes]
        sources += [] if sheets is None else [*sheets.payloads]
        payloads |= {preview_key(sources, layout.to_rgb, given.colours is not None): [preview]}
    return Scene(
        proxy=Proxy(mesh, sheets=None if sheets is None else sheets.value),
        rig=Rig(given.names, given.cameras, given.held_out, layout.reference, view_plane, layout.triangles),
        appearance=Appearance(
            tuple(plane.value for plane in planes), layout.to_rgb, given.colours, given.mixed_colours
        ),
        settings=layout.settings,
        scores=layout.scores,
        generator=layout.generator,
        residual=layout.residual,
        payloads=payloads,
    )


def _decode_sheets(layout: FileLayout) -> Coded[Sheets] | None:
    if layout.sheets is None:
        return None
    opacity = layout.sheets.decode()
    return Coded(
        Sheets(layout.sheets.faces, opacity), Payloads({opacity_key(opacity): [layout.sheets.opacity.payload]})
    )


def _decode_plane(plane: PlaneLayout) -> Coded[Plane]:
    mean = mean_values(plane.mean.decode()[0], plane.mean.affine)
    if plane.mean.precision is not None:
        mean /= spread_precision(plane.mean.precision.decode()[0, ..., 0], *mean.shape[:2])
    bases = [_decode_basis(basis, plane.mean.channels) for basis in plane.bases]
    payloads = Payloads.merge(basis.payloads for basis in bases) | {mean_key(mean): [plane.mean.payload]}
    return Coded(Plane(mean, tuple(basis.value for basis in bases)), payloads)


def _decode_basis(basis: BasisLayout, channels: int) -> Coded[Basis]:
    width, height = basis.size
    deep = any(picture.bits > 8 for picture in basis.textures)
    starts = np.cumsum([0, *(picture.count for picture in basis.textures)])
    count = int(starts[-1])
    textures = np.zeros((count, height, width, channels), np.uint16 if deep else np.uint8)
    scale, zero = np.ones((count, channels), np.float32), np.zeros((count, channels), np.float32)

    def decode(index: int) -> None:
        picture, part = basis.textures[index], slice(starts[index], starts[index + 1])
        textures[part] = picture.decode()
        if picture.affine is not None:
            scale[part] = picture.affine.scale.reshape(-1, channels)
            zero[part] = picture.affine.zero.reshape(-1, channels)

    parallel_map(decode, range(len(basis.textures)))
    decoded = Basis(textures, scale, zero, basis.weights, basis.grid, basis.corner)
    return Coded(decoded, payloads_of(decoded, [picture.payload for picture in basis.textures], basis.payload))


@checked
def validate(path: str | os.PathLike[str]) -> list[Finding]:
    """Every finding in a file, in the order of the file's parts; an empty list for a file as specified.

    It reads and decodes everything that `load` would, one picture at a time, and checks what `load` does not need: the
    picture and the nodes for other viewers, buffer views without use. The content of a file never raises.
    """
    findings = Findings(strict=False)
    with findings.part(), name_file_in_errors(path), open_source(Path(path)) as source:
        document = open_document(source)
        layout = read_layout(document, findings)
        if layout is not None:
            _check_pictures(layout, findings)
            _check_residual(layout, findings)
            if document.root.has("meshes"):
                _check_preview(document, findings)
                _check_bounds(document, layout, findings)
            _check_use(document, findings)
    return findings.found


def _check_pictures(layout: FileLayout, findings: Findings) -> None:
    for plane in layout.planes or ():
        for picture in [plane.mean, *(texture for basis in plane.bases for texture in basis.textures)]:
            with findings.part():
                picture.decode()
                if picture.precision is not None:
                    picture.precision.decode()
    with findings.part():
        if layout.sheets is not None:
            layout.sheets.decode()


def _check_residual(layout: FileLayout, findings: Findings) -> None:
    if layout.residual is not None:
        with findings.part():
            for _ in residual_frames(layout.residual):
                pass


def _check_preview(document: Document, findings: Findings) -> None:
    """Check the preview, which viewers without our extension show: images[0] in the proxy's unlit material."""
    with findings.part():
        image = read_image(document, 3)
        if image.mime not in ("image/png", "image/jpeg"):
            findings.note("warning", "preview-type", image.where, f"{image.mime} is not glTF's PNG or JPEG")
        elif image.width * image.height * 3 <= limits.MAX_DECODED:
            check_preview(image.data, image.mime, image.where)
    with findings.part():
        primitive = document.root["meshes"].at(0)["primitives"].at(0)
        material = document.root["materials"].at(primitive["material"].integer(0, 2**31))
        texture = material["pbrMetallicRoughness"]["baseColorTexture"]["index"].integer(0, 2**31)
        source = document.root["textures"].at(texture)["source"]
        if source.integer(0, 2**31) != 0:
            findings.note("warning", "preview-material", source.where, "the proxy's material does not show images[0]")


def _check_bounds(document: Document, layout: FileLayout, findings: Findings) -> None:
    """glTF wants the bounds of POSITION to be exact: viewers place their camera by them."""
    if layout.mesh is None:
        return
    with findings.part():
        position = document.root["meshes"].at(0)["primitives"].at(0)["attributes"]["POSITION"]
        accessor = document.root["accessors"].at(position.integer(0, 2**31))
        shown = read_mesh(document).vertices  # of a coded mesh the coarse one
        for key, found in (("min", shown.min(axis=0)), ("max", shown.max(axis=0))):
            stated = np.array([item.number() for item in accessor[key].items(3, 3)], np.float32)
            if not np.array_equal(stated, found):
                findings.note("warning", "mesh-bounds", f"{accessor.where}/{key}", "is not the bound of the vertices")


def _check_use(document: Document, findings: Findings) -> None:
    """Buffer views that nothing names: bytes without use."""
    extension = document.root["extensions"][limits.EXTENSION]
    used = {reference.value for _, reference in streams(extension) if isinstance(reference.value, int)}
    todo = [document.glb.json]
    while todo:
        item = todo.pop()
        if isinstance(item, dict):
            if isinstance(item.get("bufferView"), int):
                used.add(item["bufferView"])
            todo.extend(item.values())
        elif isinstance(item, list):
            todo.extend(item)
    with findings.part():
        for view in document.root["bufferViews"].items(limits.MAX_VIEWS):
            if int(view.where.rpartition("/")[2]) not in used:
                findings.note("information", "view-unused", view.where, "no one names these bytes")
