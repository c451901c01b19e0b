"""Checks of what readers of ours do not need: the picture and the mesh for other viewers, bytes without use."""

from __future__ import annotations

import numpy as np

from eigenfield.coding import limits
from eigenfield.coding.pictures.pictures_8bit import check_preview
from eigenfield.gltf.document import Document
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.layout_geometry import read_mesh
from eigenfield.gltf.layout_planes import read_image
from eigenfield.gltf.streams import streams


def check_other_viewers(document: Document, findings: Findings) -> None:
    """Note what is wrong in the parts for other viewers, and which buffer views nothing names."""
    if document.root.has("meshes"):
        _check_preview(document, findings)
        _check_bounds(document, findings)
    _check_use(document, findings)


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


def _check_bounds(document: Document, findings: Findings) -> None:
    """glTF wants the bounds of POSITION to be exact: viewers place their camera by them."""
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
