"""The geometry of a scene file: proxy, cameras, view plane."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.coding.codecs import CODECS
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payload
from eigenfield.core.viewplane import ViewPlane
from eigenfield.gltf.accessors import FLOAT, UINT8, UINT16, UINT32
from eigenfield.gltf.document import Document, all_finite
from eigenfield.gltf.name_pattern import read_pattern
from eigenfield.gltf.streams import read_stream
from eigenfield.gltf.strict_json import Value, is_printable, quote


@dataclass(frozen=True, eq=False)
class CameraList:
    """Every camera of a file.

    Attributes:
        held_out: (Nc,) bool.
        colours: (Nc, 2, 3) float32 gains and offsets; None where the file has none.
        payload: The stream of intrinsics and poses; None where they are plain.
    """

    names: tuple[str, ...]
    cameras: tuple[Camera, ...]
    held_out: NDArray[np.bool_]
    colours: NDArray[np.float32] | None
    mixed_colours: bool
    payload: Payload | None

    @property
    def encoded(self) -> int:
        return int((~self.held_out).sum())


def read_mesh(document: Document) -> Mesh:
    """The proxy: meshes[0].primitives[0]. FormatError `mesh-*`, `accessor-*`."""
    primitive = document.root["meshes"].at(0)["primitives"].at(0)
    if primitive.has("mode") and primitive["mode"].integer(0, 6) != 4:
        primitive.fail("mesh-mode", "the primitive does not consist of triangles")
    attributes = primitive["attributes"]
    vertices = document.array(attributes["POSITION"], "VEC3", (FLOAT,), limits.MAX_VERTICES)
    uv = document.array(attributes["TEXCOORD_0"], "VEC2", (FLOAT,), limits.MAX_VERTICES)
    indices = document.array(primitive["indices"], "SCALAR", (UINT8, UINT16, UINT32), 3 * limits.MAX_TRIANGLES)
    if len(uv) != len(vertices):
        attributes["TEXCOORD_0"].fail("mesh-uv", f"{len(uv)} texture coordinates for {len(vertices)} vertices")
    if not all_finite(vertices):
        attributes["POSITION"].fail("mesh-not-finite", "a vertex is NaN, infinite or beyond 1e30")
    if not all_finite(uv):
        attributes["TEXCOORD_0"].fail("mesh-uv", "a texture coordinate is NaN, infinite or beyond 1e30")
    if len(indices) % 3:
        primitive["indices"].fail("mesh-index", f"{len(indices)} indices are no whole number of triangles")
    if indices.max() >= len(vertices):
        primitive["indices"].fail("mesh-index", f"index {indices.max()} with {len(vertices)} vertices")
    return Mesh(vertices, indices.astype(np.int32).reshape(-1, 3), uv)


def read_coded_mesh(document: Document, entry: Value) -> tuple[Mesh, Payload]:
    """The proxy itself, where meshes[0] is a coarse one for other viewers, and its stream. FormatError `coded-*`,
    `codec-unknown`, `view-*`."""
    stream = read_stream(document, entry, "mesh")
    mesh: Mesh = CODECS[stream.codec].decode(stream.data, entry.where)
    if not len(mesh.faces):
        entry.fail("coded-damaged", "a mesh without faces")
    return mesh, stream


def read_cameras(document: Document, entry: Value) -> CameraList:
    """All cameras. FormatError `camera-*`, `accessor-*`, `coded-*`, `codec-unknown`."""
    names = _read_names(document, entry)
    count = len(names)
    held_out = np.zeros(count, bool)
    if entry.has("heldOut"):
        for index in entry["heldOut"].items(count):
            held_out[index.integer(0, count - 1)] = True
        if held_out.sum() < len(entry["heldOut"].value):
            entry["heldOut"].fail("camera-held-out", "a camera is named twice")
    if held_out.all():
        entry["heldOut"].fail("camera-held-out", "every camera is held out")
    stream = read_stream(document, entry["coded"], "cameras") if entry.has("coded") else None
    if stream is not None:
        intrinsics, matrices = CODECS[stream.codec].decode(stream.data, entry["coded"].where)
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
    poses, refuse = poses.reshape(count, 3, 4), partial(_refuse, entry, names)
    _check_calibration(refuse, intrinsics, poses, sizes)
    cameras = cameras_of(intrinsics, poses, sizes)
    colours, key = None, "codedColour" if entry.has("codedColour") else "colour"
    if key == "codedColour":
        colours = _decode_colours(document, entry["codedColour"], held_out)
    elif entry.has("colour"):
        colours = _table(document, entry["colour"], FLOAT, count, 6).reshape(count, 2, 3)
    if colours is not None:
        gain, offset = colours[:, 0], colours[:, 1]
        good = (gain >= 1 / limits.MAX_GAIN) & (gain <= limits.MAX_GAIN) & (np.abs(offset) <= limits.MAX_OFFSET)
        bad = np.flatnonzero(~good.all(axis=1))
        if len(bad):
            what = f"camera {quote(names[bad[0]])} has a gain or an offset outside their range"
            entry[key].fail("camera-colour", what)
    return CameraList(tuple(names), cameras, held_out, colours, not entry.has("colour"), stream)


def _decode_colours(document: Document, entry: Value, held_out: NDArray[np.bool_]) -> NDArray[np.float32]:
    """(Nc, 2, 3) from the stream of the encoded cameras' gains and offsets; 1 and 0 of the others."""
    stream = read_stream(document, entry, "colours")
    own = CODECS[stream.codec].decode(stream.data, entry.where)
    if own.shape != (int((~held_out).sum()), 6):
        entry.fail("camera-count", f"a stream of {own.shape} numbers, 6 for each encoded camera expected")
    colours = np.zeros((len(held_out), 2, 3), np.float32)
    colours[:, 0] = 1
    colours[~held_out] = own.reshape(-1, 2, 3)
    return colours


def _read_names(document: Document, entry: Value) -> list[str]:
    """Names one by one, by a pattern, or coded."""
    given = entry[next((key for key in ("codedNames", "pattern") if entry.has(key)), "names")]
    listed = isinstance(given.value, list)
    if entry.has("codedNames"):
        count = given["count"].integer(1, limits.MAX_CAMERAS)
        stream = read_stream(document, given, "names")
        names: list[str] = CODECS[stream.codec].decode(stream.data, count, given.where)
        if max(map(len, names)) > limits.MAX_NAME:
            given.fail("coded-damaged", f"names of more than {limits.MAX_NAME} characters")
    elif entry.has("pattern"):
        names = read_pattern(given)
    else:
        names = [name.text() for name in given.items(limits.MAX_CAMERAS, 1)]
    for index, name in enumerate(names):
        if not is_printable(name):
            (given.at(index) if listed else given).fail("camera-name", "a name with control characters")
    if len(set(names)) < len(names):
        given.fail("camera-name", "two cameras have one name")
    return names


def cameras_of(
    intrinsics: NDArray[np.float32], poses: NDArray[np.float32], sizes: NDArray[np.int64]
) -> tuple[Camera, ...]:
    """Cameras of intrinsics (Nc, 5): fx, fy, skew, cx, cy; poses (Nc, 3, 4): [R t]; sizes (Nc, 2): width, height."""
    made = []
    numbers = zip(intrinsics.astype(float), poses.astype(float), sizes, strict=True)
    for (fx, fy, skew, cx, cy), pose, (width, height) in numbers:
        K = np.array([[fx, skew, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
        made.append(Camera(K, np.ascontiguousarray(pose[:, :3]), pose[:, 3].copy(), int(width), int(height)))
    return tuple(made)


def _table(document: Document, reference: Value, component: int, rows: int, columns: int) -> NDArray[Any]:
    array = document.array(reference, "SCALAR", (component,), 12 * limits.MAX_CAMERAS)
    if len(array) != rows * columns:
        reference.fail("camera-count", f"{len(array)} numbers, {columns} for each of {rows} cameras expected")
    return array.reshape(rows, columns)


def _refuse(entry: Value, names: list[str], key: str, bad: NDArray[np.bool_], what: str) -> None:
    if bad.any():
        entry[key].fail(f"camera-{key}", f"camera {quote(names[int(np.flatnonzero(bad)[0])])} {what}")


def _check_calibration(
    refuse: Callable[[str, NDArray[np.bool_], str], None],
    intrinsics: NDArray[Any],
    poses: NDArray[Any],
    sizes: NDArray[np.int64],
) -> None:
    good = (np.abs(intrinsics) <= limits.MAX_NUMBER).all(axis=1) & (intrinsics[:, :2] > 1e-6).all(axis=1)
    refuse("intrinsics", ~good, "has no valid focal length or centre")
    refuse("poses", ~(np.abs(poses) <= limits.MAX_NUMBER).all(axis=(1, 2)), "has a pose that is not finite")
    rotations = poses[:, :, :3].astype(np.float64)
    refuse("poses", np.abs(rotations).max(axis=(1, 2)) > 2, "has a pose that is no rotation")
    off = np.abs(rotations @ rotations.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
    mirrored = np.linalg.det(rotations) < 0
    refuse("poses", (off > limits.ORTHONORMAL_TOLERANCE) | mirrored, "has a pose that is no rotation")
    area = sizes[:, 0] * sizes[:, 1]
    bad = (sizes < 1).any(axis=1) | (sizes > limits.MAX_CAMERA_SIDE).any(axis=1) | (area > limits.MAX_CAMERA_PIXELS)
    refuse("sizes", bad, "has an impossible size")


def read_view_plane(entry: Value) -> ViewPlane:
    """The plane through the cameras. FormatError `view-plane`."""
    origin, right, up = (
        np.array([n.number(limits.MAX_NUMBER) for n in entry[key].items(3, 3)]) for key in ("origin", "right", "up")
    )
    extent = np.array([n.number(limits.MAX_NUMBER) for n in entry["extent"].items(2, 2)])
    gram = np.array([right @ right, up @ up, right @ up])
    if not np.abs(gram - (1, 1, 0)).max() <= limits.ORTHONORMAL_TOLERANCE:
        entry.fail("view-plane", "right and up are not of length 1 and at right angles")
    if extent.min() < 0:
        entry["extent"].fail("view-plane", "a negative extent")
    return ViewPlane(origin, right, up, extent)


def read_triangles(document: Document, entry: Value, cameras: CameraList | None) -> NDArray[np.int32]:
    """(T, 3) indices of encoded cameras. FormatError `view-plane-triangles`, `accessor-*`."""
    most = limits.MAX_CAMERAS if cameras is None else cameras.encoded
    found: NDArray[Any]
    if entry.has("codedTriangles"):
        given = entry["codedTriangles"]
        stream = read_stream(document, given, "triangles")
        found = CODECS[stream.codec].decode(stream.data, given.where)
    elif entry.has("triangles"):
        given = entry["triangles"]
        flat = document.array(given, "SCALAR", (UINT16, UINT32), 6 * limits.MAX_CAMERAS)
        if len(flat) % 3:
            given.fail("view-plane-triangles", f"{len(flat)} indices are no whole number of triangles")
        found = flat.astype(np.int64).reshape(-1, 3)
    else:
        return np.zeros((0, 3), np.int32)
    if found.max(initial=0) >= most:
        given.fail("view-plane-triangles", f"index {found.max()} with {most} encoded cameras")
    return found.astype(np.int32)
