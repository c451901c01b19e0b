"""The residual of a scene file: photographs of captured views minus what is drawn of them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from eigenfield.coding import limits
from eigenfield.coding.codecs import CODECS
from eigenfield.coding.pictures.pictures_10bit import MIN_SIDE_TEXELS
from eigenfield.coding.video.av1 import Planes
from eigenfield.core.scene import Residual
from eigenfield.gltf.accessors import UINT16, UINT32
from eigenfield.gltf.document import Document
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.layout_geometry import CameraList
from eigenfield.gltf.streams import read_stream
from eigenfield.gltf.strict_json import Value


def read_residual(
    document: Document, extension: Value, cameras: CameraList | None, findings: Findings
) -> Residual | None:
    """The residual, its video not decoded; None where there is none, or where the file is cut off in it. FormatError
    `residual-*`, `codec-unknown`, `view-*`, `accessor-*`, `json-*`."""
    if not extension.has("residual"):
        return None
    entry = extension["residual"]
    if document.cut_off(entry["bufferView"]):
        findings.note("warning", "residual-cut", entry.where, "the file ends within it: captured views go without")
        return None
    columns, rows = (item.integer(MIN_SIDE_TEXELS, limits.MAX_CAMERA_SIDE) for item in entry["size"].items(2, 2))
    luma, chroma = (item.number(1) for item in entry["scale"].items(2, 2))
    if min(luma, chroma) <= 0:
        entry["scale"].fail("residual-scale", "a scale is not positive")
    full, smooth = (entry.has(key) and entry[key].boolean() for key in ("full", "smooth"))
    video = read_stream(document, entry, "residual")
    if cameras is None:  # only while validating a file whose cameras are damaged
        return None
    sizes = [(one.height, one.width) for one, held in zip(cameras.cameras, cameras.held_out, strict=True) if not held]
    if columns % 2 or rows % 2 or any(height > rows or width > columns for height, width in sizes):
        entry["size"].fail("residual-size", f"frames of {columns}x{rows} are odd, or smaller than a photograph")
    pixels = columns * rows * (3 if full else 1)
    if pixels > limits.MAX_TEXELS or pixels * len(sizes) > limits.MAX_VIDEO:
        entry["size"].fail(
            "residual-size", f"{len(sizes)} frames of {columns}x{rows}, {limits.MAX_VIDEO} pixels allowed"
        )
    order = np.arange(len(sizes))
    if entry.has("order"):
        order = document.array(entry["order"], "SCALAR", (UINT16, UINT32), limits.MAX_CAMERAS).astype(np.int64)
        if not np.array_equal(np.sort(order), np.arange(len(sizes))):
            entry["order"].fail("residual-order", f"is no order of {len(sizes)} encoded cameras")
    return Residual(video.data, (rows, columns), order, (luma, chroma), full, smooth, video.codec)


def residual_frames(residual: Residual) -> Iterator[Planes]:
    """The frames of a residual, in its order. FormatError `residual-damaged`."""
    where = f"/extensions/{limits.EXTENSION}/residual"
    return CODECS[residual.codec].decode(residual.video, residual.frame, len(residual.order), where, "residual")
