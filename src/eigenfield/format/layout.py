"""What a scene file says, every number checked, its pictures not yet decoded.

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

from eigenfield.camera import Camera
from eigenfield.errors import FormatError
from eigenfield.format import deep, limits, pictures
from eigenfield.format.document import FLOAT, UINT8, UINT16, UINT32, Document
from eigenfield.format.findings import Findings
from eigenfield.format.quantise import Affine
from eigenfield.format.strict_json import Value, printable, quoted
from eigenfield.mesh import Mesh
from eigenfield.viewplane import ViewPlane

_LARGEST = 1e30  # of scales, zeros and lengths: squares and products stay finite
_KEYS = {
    "version", "needs", "mesh", "planes", "toRGB", "cameras", "viewPlane", "reference", "settings", "scores",
    "generator",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Picture:
    """Codes in the file.

    width, height, channels: of the array that it decodes to.
    affine: the way back to numbers, per channel (of every texture in it); None: code / 255.
    bits: of the codes, 8 or 10. count: textures in it, one below the other.
    """

    data: memoryview
    mime: str
    width: int
    height: int
    channels: int
    affine: Affine | None
    where: str
    bits: int = 8
    count: int = 1

    def decode(self) -> NDArray[Any]:
        """(count, height, width, channels) uint8, of 10 bits uint16. FormatError: see `pictures.decode`."""
        size = (self.width, self.height, self.channels)
        if self.count == 1 and self.bits == 8:
            return pictures.decode(self.data, self.mime, *size, self.where)[None]
        return pictures.decode_stack(self.data, self.mime, *size, self.count, self.bits, self.where)


@dataclass(frozen=True, eq=False)
class BasisLayout:
    """size: (width, height) of the textures. weights: (Ne, N) float32. grid: (rows, columns) of which they are a
    part, None: all of it. corner: row and column in it. stream: the weights' coded form, None where they are plain."""

    size: tuple[int, int]
    textures: tuple[Picture, ...]
    weights: NDArray[np.float32]
    grid: tuple[int, int] | None = None
    corner: tuple[int, int] = (0, 0)
    stream: bytes | None = None

    @property
    def count(self) -> int:
        return sum(picture.count for picture in self.textures)


@dataclass(frozen=True, eq=False)
class PlaneLayout:
    mean: Picture
    bases: tuple[BasisLayout, ...]


@dataclass(frozen=True, eq=False)
class CameraList:
    """colours: (Nc, 2, 3) float32 gains and offsets, None where the file has none."""

    names: tuple[str, ...]
    cameras: tuple[Camera, ...]
    held_out: NDArray[np.bool_]
    colours: NDArray[np.float32] | None

    @property
    def encoded(self) -> int:
        return int((~self.held_out).sum())


@dataclass(frozen=True, eq=False)
class Layout:
    """A whole file; a part that could not be read is None (only while validating)."""

    version: str
    mesh: Mesh | None
    planes: tuple[PlaneLayout, ...] | None
    cameras: CameraList | None
    view_plane: ViewPlane | None
    triangles: NDArray[np.int32] | None
    reference: int | None
    to_rgb: NDArray[np.float32] | None
    settings: Mapping[str, Any]
    scores: Mapping[str, Any]
    generator: str
    streams: Mapping[str, bytes]


def read_layout(document: Document, findings: Findings) -> Layout | None:
    """Check everything but the pictures' contents; None if the file is no scene at all (only while validating)."""
    extension = None
    with findings.part():
        extension = find_extension(document)
    if extension is None:
        return None
    version = extension["version"].text()
    if version not in (limits.FIRST, limits.SECOND, limits.VERSION):
        findings.note(
            "information", "newer-version", f"{extension.where}/version", f"version {version}: what it adds is ignored"
        )
    for key in sorted(extension.mapping().keys() - _KEYS):
        findings.note("information", "unknown-key", extension.where, f"{quoted(key)} is ignored")
    if limits.EXTENSION not in _names(document, "extensionsUsed"):
        findings.note("warning", "extension-not-used", "/extensionsUsed", f"does not name {limits.EXTENSION}")
    if limits.EXTENSION in _names(document, "extensionsRequired"):
        findings.note(
            "warning", "extension-required", "/extensionsRequired", "keeps other viewers from showing the mean"
        )
    mesh = cameras = planes = view_plane = triangles = reference = to_rgb = None
    settings: Mapping[str, Any] = {}
    scores: Mapping[str, Any] = {}
    generator = ""
    with findings.part():
        document.check_buffer()
    with findings.part():
        document.check_overlap()
    streams: dict[str, bytes] = {}
    with findings.part():
        mesh = read_mesh(document)
        if extension.has("mesh"):
            streams["mesh"], mesh = read_coded_mesh(document, extension["mesh"])
    with findings.part():
        cameras = read_cameras(document, extension["cameras"])
        if extension["cameras"].has("coded"):
            streams["cameras"] = bytes(document.picture(extension["cameras"]["coded"]))
    with findings.part():
        planes = read_planes(document, extension["planes"], cameras, findings)
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
        settings = extension["settings"].mapping() if extension.has("settings") else {}
    with findings.part():
        scores = extension["scores"].mapping() if extension.has("scores") else {}
    with findings.part():
        generator = extension["generator"].text() if extension.has("generator") else ""
    return Layout(
        version, mesh, planes, cameras, view_plane, triangles, reference, to_rgb, settings, scores, generator, streams
    )


def find_extension(document: Document) -> Value:
    """Our root extension, of a version and with needs that this reader knows.

    FormatError: `gltf-version`, `not-a-scene`, `version`, `needs`.
    """
    root = document.root
    asset = root["asset"]["version"]
    if not re.fullmatch(r"2\.\d+", asset.text()):
        asset.fail("gltf-version", f"glTF {quoted(asset.value)}, 2.x expected")
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
            f"version {quoted(version.value)} of {limits.EXTENSION}, 1.x is read here",
            where=version.where,
            remedy="use a later eigenfield",
        )
    if extension.has("needs"):
        for need in extension["needs"].items(limits.MAX_VIEWS):
            if need.text() not in limits.FEATURES:
                raise FormatError(
                    "needs",
                    f"needs the unknown feature {quoted(need.value)}",
                    where=need.where,
                    remedy="use a later eigenfield",
                )
    return extension


def _names(document: Document, key: str) -> list[Any]:
    found = document.root.mapping().get(key, [])
    return found if isinstance(found, list) else []


def read_mesh(document: Document) -> Mesh:
    """The proxy: meshes[0].primitives[0]. FormatError: `mesh-*`, `accessor-*`."""
    primitive = document.root["meshes"].at(0)["primitives"].at(0)
    if primitive.has("mode") and primitive["mode"].integer(0, 6) != 4:
        primitive.fail("mesh-mode", "the primitive does not consist of triangles")
    attributes = primitive["attributes"]
    vertices = document.array(attributes["POSITION"], "VEC3", (FLOAT,), limits.MAX_VERTICES)
    uv = document.array(attributes["TEXCOORD_0"], "VEC2", (FLOAT,), limits.MAX_VERTICES)
    indices = document.array(primitive["indices"], "SCALAR", (UINT8, UINT16, UINT32), 3 * limits.MAX_TRIANGLES)
    if len(uv) != len(vertices):
        attributes["TEXCOORD_0"].fail("mesh-uv", f"{len(uv)} texture coordinates for {len(vertices)} vertices")
    if not _all_finite(vertices, _LARGEST):
        attributes["POSITION"].fail("mesh-not-finite", "a vertex is NaN, infinite or beyond 1e30")
    if not _all_finite(uv, _LARGEST):
        attributes["TEXCOORD_0"].fail("mesh-uv", "a texture coordinate is NaN, infinite or beyond 1e30")
    if len(indices) % 3:
        primitive["indices"].fail("mesh-index", f"{len(indices)} indices are no whole number of triangles")
    if indices.max() >= len(vertices):
        primitive["indices"].fail("mesh-index", f"index {indices.max()} with {len(vertices)} vertices")
    return Mesh(vertices, indices.astype(np.int32).reshape(-1, 3), uv)


def read_coded_mesh(document: Document, entry: Value) -> tuple[bytes, Mesh]:
    """The proxy itself, where meshes[0] is a coarse one for other viewers. FormatError: `coded-*`, `view-*`."""
    from eigenfield.format.mesh_coder import decode_mesh  # numba: most files need none

    data = bytes(document.picture(entry["bufferView"]))
    mesh = decode_mesh(data, entry.where)
    if not len(mesh.faces):
        entry.fail("coded-damaged", "a mesh without faces")
    return data, mesh


def _all_finite(array: NDArray[Any], largest: float) -> bool:
    return bool((np.abs(array) <= largest).all())  # False for NaN


def read_cameras(document: Document, entry: Value) -> CameraList:
    """FormatError: `camera-*`, `accessor-*`."""
    names: list[str] = []
    for name in entry["names"].items(limits.MAX_CAMERAS, 1):
        if not printable(name.text()):
            name.fail("camera-name", "a name with control characters")
        names.append(name.value)
    if len(set(names)) < len(names):
        entry["names"].fail("camera-name", "two cameras have one name")
    count = len(names)
    held_out = np.zeros(count, bool)
    if entry.has("heldOut"):
        for index in entry["heldOut"].items(count):
            held_out[index.integer(0, count - 1)] = True
        if held_out.sum() < len(entry["heldOut"].value):
            entry["heldOut"].fail("camera-held-out", "a camera is named twice")
    if held_out.all():
        entry["heldOut"].fail("camera-held-out", "every camera is held out")
    if entry.has("coded"):
        from eigenfield.format.camera_coder import decode_cameras  # as above

        intrinsics, matrices = decode_cameras(bytes(document.picture(entry["coded"])), entry["coded"].where)
        poses = matrices.reshape(len(matrices), 12)
        if len(poses) != count:
            entry["coded"].fail("camera-count", f"{len(poses)} cameras in the stream, {count} names")
    else:
        intrinsics = _table(document, entry["intrinsics"], FLOAT, count, 5)
        poses = _table(document, entry["poses"], FLOAT, count, 12)
    if entry.has("size"):
        one = [item.integer(1, limits.MAX_CAMERA_SIDE) for item in entry["size"].items(2, 2)]
        sizes = np.tile(np.array(one, np.int64), (count, 1))
    else:
        sizes = _table(document, entry["sizes"], UINT32, count, 2).astype(np.int64)
    _check_calibration(entry, names, intrinsics, poses.reshape(count, 3, 4), sizes)
    K = np.zeros((count, 3, 3))
    K[:, 0, 0], K[:, 1, 1], K[:, 0, 1], K[:, 0, 2], K[:, 1, 2] = intrinsics.T
    K[:, 2, 2] = 1
    placed = poses.reshape(count, 3, 4).astype(np.float64)
    cameras = tuple(
        Camera(k, np.ascontiguousarray(m[:, :3]), m[:, 3].copy(), int(w), int(h))
        for k, m, (w, h) in zip(K, placed, sizes, strict=True)
    )
    colours = None
    if entry.has("colour"):
        colours = _table(document, entry["colour"], FLOAT, count, 6).reshape(count, 2, 3)
        gain, offset = colours[:, 0], colours[:, 1]
        good = (gain >= 1 / limits.MAX_GAIN) & (gain <= limits.MAX_GAIN) & (np.abs(offset) <= limits.MAX_OFFSET)
        _refuse(entry, names, "colour", ~good.all(axis=1), "has a gain or an offset outside their range")
    return CameraList(tuple(names), cameras, held_out, colours)


def read_matrix(entry: Value, planes: tuple[PlaneLayout, ...] | None) -> NDArray[np.float32] | None:
    """(3, K) float32: R, G, B from the channels of all planes. FormatError: `plane-matrix`."""
    if not entry.has("toRGB"):
        return None
    channels = 0 if planes is None else sum(plane.mean.channels for plane in planes)
    most = limits.MAX_PLANES * limits.MAX_CHANNELS
    numbers = [item.number(limits.MAX_GAIN) for item in entry["toRGB"].items(3 * most, 3)]
    if planes is not None and len(numbers) != 3 * channels:
        entry["toRGB"].fail("plane-matrix", f"{len(numbers)} numbers, 3 for each of {channels} channels expected")
    return None if planes is None else np.array(numbers, np.float32).reshape(3, channels)


def check_colours(
    entry: Value,
    cameras: CameraList | None,
    planes: tuple[PlaneLayout, ...] | None,
    to_rgb: NDArray[np.float32] | None,
) -> None:
    """Colours are those of R, G and B. FormatError: `camera-colour`."""
    if cameras is None or cameras.colours is None or not planes or to_rgb is not None:
        return
    if planes[0].mean.channels != 3:
        entry["colour"].fail("camera-colour", "colours of cameras, but the first plane has not three channels")


def _table(document: Document, reference: Value, component: int, rows: int, columns: int) -> NDArray[Any]:
    array = document.array(reference, "SCALAR", (component,), 12 * limits.MAX_CAMERAS)
    if len(array) != rows * columns:
        reference.fail("camera-count", f"{len(array)} numbers, {columns} for each of {rows} cameras expected")
    return array.reshape(rows, columns)


def _refuse(entry: Value, names: list[str], key: str, bad: NDArray[np.bool_], what: str) -> None:
    if bad.any():
        entry[key].fail(f"camera-{key}", f"camera {quoted(names[int(np.flatnonzero(bad)[0])])} {what}")


def _check_calibration(
    entry: Value, names: list[str], intrinsics: NDArray[Any], poses: NDArray[Any], sizes: NDArray[np.int64]
) -> None:
    def refuse(key: str, bad: NDArray[np.bool_], what: str) -> None:
        _refuse(entry, names, key, bad, what)

    inside = np.abs(intrinsics) <= _LARGEST
    refuse(
        "intrinsics",
        ~inside.all(axis=1) | (intrinsics[:, :2] <= 1e-6).any(axis=1),
        "has no valid focal length or centre",
    )
    refuse("poses", ~(np.abs(poses) <= _LARGEST).all(axis=(1, 2)), "has a pose that is not finite")
    rotations = poses[:, :, :3].astype(np.float64)
    refuse("poses", np.abs(rotations).max(axis=(1, 2)) > 2, "has a pose that is no rotation")
    off = np.abs(rotations @ rotations.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
    refuse("poses", (off > limits.ORTHONORMAL) | (np.linalg.det(rotations) < 0), "has a pose that is no rotation")
    area = sizes[:, 0] * sizes[:, 1]
    bad = (sizes < 1).any(axis=1) | (sizes > limits.MAX_CAMERA_SIDE).any(axis=1) | (area > limits.MAX_CAMERA_PIXELS)
    refuse("sizes", bad, "has an impossible size")


def read_planes(
    document: Document, entry: Value, cameras: CameraList | None, findings: Findings
) -> tuple[PlaneLayout, ...]:
    """FormatError: `plane-*`, `decoded-size`, `weights-*`, `view-*`."""
    planes = tuple(
        _read_plane(document, plane, index, cameras, findings)
        for index, plane in enumerate(entry.items(limits.MAX_PLANES, 1))
    )
    count = sum(basis.count for plane in planes for basis in plane.bases)
    if count > limits.MAX_COMPONENTS:
        entry.fail("plane-components", f"{count} eigen textures, {limits.MAX_COMPONENTS} are allowed")
    total = sum(
        4 * plane.mean.width * plane.mean.height * plane.mean.channels
        + sum(
            basis.size[0] * basis.size[1] * plane.mean.channels * picture.count * (1 if picture.bits == 8 else 2)
            for basis in plane.bases
            for picture in basis.textures
        )
        for plane in planes
    )
    if total > limits.MAX_DECODED:
        entry.fail("decoded-size", f"would decode to {total} bytes, {limits.MAX_DECODED} are allowed")
    return planes


def _read_plane(
    document: Document, entry: Value, index: int, cameras: CameraList | None, findings: Findings
) -> PlaneLayout:
    channels = entry["channels"].integer(1, limits.MAX_CHANNELS)
    if entry.has("mean"):
        size = _size(entry["mean"]["size"], channels)
        mean = _picture(document, entry["mean"], size, channels, 1, bare=True)
    elif index == 0 and channels in (1, 3):
        mean = read_image(document, channels)
    else:
        raise FormatError("plane-mean", "the plane has no mean", where=f"{entry.where}/mean")
    bases = tuple(
        _read_basis(document, basis, channels, cameras, findings) for basis in entry["bases"].items(limits.MAX_BASES)
    )
    return PlaneLayout(mean, bases)


def read_image(document: Document, channels: int) -> Picture:
    """`images[0]` as a picture of `channels`; its size is what its header says."""
    image = document.root["images"].at(0)
    if not image.has("bufferView"):
        image.fail("plane-mean", "the picture lies in another file")
    data, mime = document.picture(image["bufferView"]), image["mimeType"].text()
    width, height = pictures.dimensions(data, mime, image.where)
    return Picture(data, mime, width, height, channels, None, image.where)


def _read_basis(
    document: Document, entry: Value, channels: int, cameras: CameraList | None, findings: Findings
) -> BasisLayout:
    size = _size(entry["size"], channels)
    textures: list[Picture] = []
    total = 0
    for texture in entry["textures"].items(limits.MAX_COMPONENTS):
        with findings.part():
            count = texture["count"].integer(1, limits.MAX_COMPONENTS) if texture.has("count") else 1
            total += count  # also of a picture that is damaged: its weights are there
            textures.append(_picture(document, texture, size, channels, count, bare=False))
    rows = 0 if cameras is None else cameras.encoded
    weights = np.zeros((rows, 0), np.float32)
    stream = None
    if total:
        with findings.part():
            if entry.has("codedWeights"):
                stream = bytes(document.picture(entry["codedWeights"]))
                weights = _decode_weights(stream, entry["codedWeights"], rows, total)
            else:
                weights = _read_weights(document, entry["weights"], rows, total)
    return BasisLayout(size, tuple(textures), weights, *_region(entry, size), stream)


def _region(entry: Value, size: tuple[int, int]) -> tuple[tuple[int, int] | None, tuple[int, int]]:
    """Grid (rows, columns) and corner (row, column) of a basis that is only a part. FormatError: `basis-region`."""
    if not entry.has("grid"):
        return None, (0, 0)
    columns, rows = (item.integer(1, limits.MAX_SIDE) for item in entry["grid"].items(2, 2))
    column, row = (
        (item.integer(0, limits.MAX_SIDE) for item in entry["corner"].items(2, 2)) if entry.has("corner") else (0, 0)
    )
    if column + size[0] > columns or row + size[1] > rows:
        entry["grid"].fail("basis-region", f"{size[0]}x{size[1]} at {column}, {row} leaves a grid of {columns}x{rows}")
    return (rows, columns), (row, column)


def _decode_weights(stream: bytes, entry: Value, rows: int, count: int) -> NDArray[np.float32]:
    from eigenfield.format.weight_coder import decode_weights  # as above

    weights = decode_weights(stream, entry.where)
    if rows == 0:  # only while validating a file whose cameras are damaged
        return np.zeros((0, count), np.float32)
    if weights.shape != (rows, count) or not _all_finite(weights, _LARGEST):
        found = "x".join(map(str, weights.shape))
        entry.fail("weights-count", f"{found} weights, {rows} encoded cameras x {count} textures expected")
    return weights


def _read_weights(document: Document, reference: Value, rows: int, count: int) -> NDArray[np.float32]:
    flat = document.array(reference, "SCALAR", (FLOAT,), limits.MAX_WEIGHTS)
    if not _all_finite(flat, _LARGEST):
        reference.fail("weights-not-finite", "a weight is NaN, infinite or beyond 1e30")
    if rows == 0:  # only while validating a file whose cameras are damaged
        return np.zeros((0, count), np.float32)
    if len(flat) != rows * count:
        reference.fail("weights-count", f"{len(flat)} weights, {rows} encoded cameras x {count} textures expected")
    return flat.reshape(rows, count)


def _size(entry: Value, channels: int) -> tuple[int, int]:
    width, height = (item.integer(1, limits.MAX_SIDE) for item in entry.items(2, 2))
    w, h = pictures.picture_size(width, height, channels)
    if h > limits.MAX_STACKED or w * h > limits.MAX_TEXELS:
        entry.fail("picture-limit", f"a picture of {w}x{h}, {limits.MAX_TEXELS} texels are allowed")
    return width, height


def _picture(
    document: Document, entry: Value, size: tuple[int, int], channels: int, count: int, *, bare: bool
) -> Picture:
    """bare: scale and zero may be absent."""
    data, mime = document.picture(entry["bufferView"]), entry["mimeType"].text()
    bits = entry["bits"].integer(8, deep.BITS) if entry.has("bits") else 8
    if bits not in (8, deep.BITS) or (bits != 8 and mime != deep.MIME):
        entry["bits"].fail("picture-type", f"{bits} bits in a picture of type {mime}")
    affine = None
    if not bare or bits != 8 or entry.has("scale") or entry.has("zero"):
        affine = Affine(*(_affine(entry[key], channels, count) for key in ("scale", "zero")))
    pictures.check_header(data, mime, *size, channels, entry.where, count, bits)
    return Picture(data, mime, *size, channels, affine, entry.where, bits, count)


def _affine(entry: Value, channels: int, count: int) -> NDArray[np.float64]:
    """(channels * count,): C numbers for each texture, or C that stand for all."""
    given = [item.number(_LARGEST) for item in entry.items(channels * count, channels)]
    if len(given) not in (channels, channels * count):
        entry.fail("json-value", f"{len(given)} numbers, {channels} or {channels * count} expected")
    return np.tile(np.array(given), 1 if len(given) == channels * count else count)


def read_view_plane(entry: Value) -> ViewPlane:
    """FormatError: `view-plane`."""
    origin, right, up = (
        np.array([n.number(_LARGEST) for n in entry[key].items(3, 3)]) for key in ("origin", "right", "up")
    )
    extent = np.array([n.number(_LARGEST) for n in entry["extent"].items(2, 2)])
    gram = np.array([right @ right, up @ up, right @ up])
    if not np.abs(gram - (1, 1, 0)).max() <= limits.ORTHONORMAL:
        entry.fail("view-plane", "right and up are not of length 1 and at right angles")
    if extent.min() < 0:
        entry["extent"].fail("view-plane", "a negative extent")
    return ViewPlane(origin, right, up, extent)


def read_triangles(document: Document, entry: Value, cameras: CameraList | None) -> NDArray[np.int32]:
    """(T, 3) indices of encoded cameras. FormatError: `view-plane-triangles`, `accessor-*`."""
    if not entry.has("triangles"):
        return np.zeros((0, 3), np.int32)
    flat = document.array(entry["triangles"], "SCALAR", (UINT16, UINT32), 6 * limits.MAX_CAMERAS)
    if len(flat) % 3:
        entry["triangles"].fail("view-plane-triangles", f"{len(flat)} indices are no whole number of triangles")
    most = limits.MAX_CAMERAS if cameras is None else cameras.encoded
    if flat.max() >= most:
        entry["triangles"].fail("view-plane-triangles", f"index {flat.max()} with {most} encoded cameras")
    return flat.astype(np.int32).reshape(-1, 3)
