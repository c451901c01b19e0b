"""glTF 2.0 and GLB: all triangles of a scene, with the transforms of its nodes applied.

Of materials only the transform of the texture coordinates is read. Morph targets have their default weights; bones and
animations are left out.
"""

from __future__ import annotations

import base64
import json
import logging
import re
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any
from urllib.parse import unquote, unquote_to_bytes

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.core.errors import ProxyError
from eigenfield.gltf.accessors import ViewBytes, find_accessor, read_accessor
from eigenfield.gltf.container import BINARY_CHUNK, CHUNK, HEADER, JSON_CHUNK, MAGIC
from eigenfield.gltf.strict_json import Value, quote
from eigenfield.proxy.meshes.formats import MeshFormat, RawMesh
from eigenfield.proxy.meshes.polygons import check_range, strip_triangles

log = logging.getLogger("eigenfield.proxy")

GLTF_MAX_VISITS = 2**20  # nodes of a scene, those with several parents counted as often as they are drawn
GLTF_MAX_INSTANCES = 2**22
DRACO, INSTANCING, TEXTURE_TRANSFORM = "KHR_draco_mesh_compression", "EXT_mesh_gpu_instancing", "KHR_texture_transform"
MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
GLTF_READ_EXTENSIONS = (DRACO, INSTANCING, TEXTURE_TRANSFORM, "KHR_mesh_quantization")
GLTF_HARMLESS_EXTENSIONS = (  # a name, or how it begins: they change no geometry
    "KHR_materials_", "KHR_lights_", "EXT_lights_", "KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif",
    "MSFT_texture_dds", "KHR_xmp", "KHR_xmp_json_ld", "EXT_mesh_features", "EXT_structural_metadata",
    "EXT_instance_features", "EIGENFIELD_eigen_textures",
)  # fmt: skip
_POINTS_AND_LINES, _TRIANGLES, _STRIP, _FAN = range(4), 4, 5, 6


def read_gltf(data: bytes, path: Path) -> RawMesh:
    """All triangles of a scene.

    Args:
        path: Of the file, for external buffers and messages.

    Raises:
        ProxyError: `proxy-extension`, `proxy-nodes`, `proxy-index-range`, `proxy-outside`, `proxy-unreadable`.
        FormatError: What is damaged, with its place.
        ValueError: Damaged data.
    """
    file = _GltfFile(*_split_glb(data), path)
    file.check_extensions()
    parts: dict[tuple[int, tuple[float, ...]], list[RawMesh]] = {}
    vertices, faces, uvs, without, start, total = [], [], [], 0, 0, 0
    for matrix, mesh, weights in file.places():
        if (mesh, weights) not in parts:
            parts[mesh, weights] = list(file.read_parts(mesh, weights))
        for part in parts[mesh, weights]:
            total += len(part.faces)
            if total > limits.MAX_TRIANGLES or start + len(part.vertices) > limits.MAX_VERTICES:
                raise ValueError(f"its instances have more than {limits.MAX_TRIANGLES} triangles or too many vertices")
            turned = np.linalg.det(matrix[:3, :3]) < 0
            vertices.append(part.vertices @ matrix[:3, :3].T + matrix[:3, 3])
            faces.append((part.faces[:, ::-1] if turned else part.faces) + start)
            uvs.append(np.zeros((len(part.vertices), 2)) if part.uv is None else part.uv)
            without += part.uv is None
            start += len(part.vertices)
    if file.without_surface:
        log.info("%s: %d primitives of points or lines are ignored", path, file.without_surface)
    if file.skinned:
        log.warning("%s: %d meshes with bones are read as they were modelled, in no pose", path, file.skinned)
    if not vertices:
        return RawMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64), None)
    if 0 < without < len(vertices):
        log.info(
            "%s: %d of %d parts have no texture coordinates: those of the others are ignored", path, without, len(uvs)
        )
    return RawMesh(np.concatenate(vertices), np.concatenate(faces), None if without else np.concatenate(uvs))


def _split_glb(data: bytes) -> tuple[Value, memoryview | None]:
    """The JSON, and the binary chunk if there is one. Other chunks, and what follows the end, are ignored."""
    if not data.startswith(MAGIC):
        return Value(json.loads(data.decode("utf-8-sig"))), None
    _, version, length = HEADER.unpack_from(data)
    if version != 2:
        raise ValueError(f"glTF {version}, not 2")
    if length > len(data):
        raise ValueError(f"{length} bytes announced, {len(data)} found")
    chunks: dict[bytes, memoryview] = {}
    at = HEADER.size
    while at + CHUNK.size <= length:
        size, kind = CHUNK.unpack_from(data, at)
        at += CHUNK.size
        if at + size > length:
            raise ValueError(f"a chunk of {size} bytes reaches past the end")
        chunks.setdefault(kind, memoryview(data)[at : at + size])
        at += size
    return Value(json.loads(bytes(chunks[JSON_CHUNK]).decode("utf-8-sig"))), chunks.get(BINARY_CHUNK)


class _GltfFile:
    """A glTF file, whose parts are read when they are asked for.

    Attributes:
        without_surface: Primitives of points or lines that were met.
        skinned: Nodes with a skin that were met.
    """

    def __init__(self, root: Value, binary: memoryview | None, path: Path) -> None:
        self.root = root
        self._binary = binary
        self._path = path
        self._buffers: dict[int, memoryview] = {}
        self.without_surface = 0
        self.skinned = 0

    def check_extensions(self) -> None:
        """Refuse a file that cannot be read without an extension that is not known: `proxy-extension`."""
        if not self.root.has("extensionsRequired"):
            return
        names = [item.text() for item in self.root["extensionsRequired"].items(2**16)]
        unknown = [n for n in names if n not in GLTF_READ_EXTENSIONS and not n.startswith(GLTF_HARMLESS_EXTENSIONS)]
        packed = [name for name in unknown if name in MESHOPT]
        if packed:
            _refuse_extension(f"its geometry is compressed ({', '.join(packed)}), which is not read", packed)
        if unknown:
            what = "the glTF extensions" if len(unknown) > 1 else "the glTF extension"
            names = [quote(name)[1:-1] for name in unknown]
            _refuse_extension(f"it needs {what} {', '.join(names)}, which is not read", names)

    def places(self) -> Iterator[tuple[NDArray[np.float64], int, tuple[float, ...]]]:
        """Every mesh of the scene: (4, 4) its transform, its index, and the weights of its morph targets."""
        meshes = self.root["meshes"].size() if self.root.has("meshes") else 0
        if not self._nodes:
            yield from ((np.eye(4), mesh, ()) for mesh in range(meshes))
            return
        roots = self._roots()
        self._check_graph(roots)
        waiting = [(index, np.eye(4)) for index in reversed(roots)]
        drawn = 0
        while waiting:
            index, parent = waiting.pop()
            node = self._nodes[index]
            matrix = parent @ _local_matrix(node)
            waiting += [(child, matrix) for child in reversed(self._children[index])]
            if not node.has("mesh"):
                continue
            self.skinned += node.has("skin")
            weights = _numbers(node, "weights") if node.has("weights") else ()
            for instance in self._instances(node):
                drawn += 1
                if drawn > GLTF_MAX_INSTANCES:
                    raise ValueError(f"more than {GLTF_MAX_INSTANCES} instances of meshes")
                yield matrix @ instance, node["mesh"].integer(0, max(meshes - 1, 0)), weights

    @cached_property
    def _nodes(self) -> list[Value]:
        return list(self.root["nodes"].items(2**24)) if self.root.has("nodes") else []

    @cached_property
    def _children(self) -> list[list[int]]:
        last = len(self._nodes) - 1
        return [
            [child.integer(0, last) for child in node["children"].items(2**24)] if node.has("children") else []
            for node in self._nodes
        ]

    def _roots(self) -> list[int]:
        """The nodes of the scene that a viewer shows; without one, all that are nobody's children."""
        if self.root.has("scenes") and self.root["scenes"].size():
            count = self.root["scenes"].size()
            index = self.root["scene"].integer(0, count - 1) if self.root.has("scene") else 0
            if count > 1:
                log.info("%s: of %d scenes the one that is shown is read, number %d", self._path, count, index)
            scene = self.root["scenes"].at(index)
            last = len(self._nodes) - 1
            return [node.integer(0, last) for node in scene["nodes"].items(2**24)] if scene.has("nodes") else []
        inner = {child for children in self._children for child in children}
        return [index for index in range(len(self._nodes)) if index not in inner] or [0]

    def _check_graph(self, roots: list[int]) -> None:
        """Nodes form no circle, and shared ones do not multiply without bounds: `proxy-nodes`."""
        remedy = "export it again as a tree of nodes"
        state: dict[int, bool] = {}  # False: entered, True: left
        order: list[int] = []
        for root in roots:
            waiting = [(root, False)]
            while waiting:
                index, leaving = waiting.pop()
                if leaving:
                    state[index] = True
                    order.append(index)
                elif index not in state:
                    state[index] = False
                    waiting.append((index, True))
                    for child in self._children[index]:
                        if state.get(child) is False:
                            message = f"its nodes form a circle: node {child} is among its own descendants"
                            raise ProxyError("proxy-nodes", message, remedy=remedy)
                        waiting.append((child, False))
        visits = dict.fromkeys(order, 0)
        for root in roots:
            visits[root] += 1
        for index in reversed(order):  # parents before their children
            for child in self._children[index]:
                visits[child] += visits[index]
        if sum(visits.values()) > GLTF_MAX_VISITS:
            message = f"its {len(order)} nodes share children so that they stand for more than {GLTF_MAX_VISITS} nodes"
            raise ProxyError("proxy-nodes", message, remedy=remedy)

    def _instances(self, node: Value) -> Iterator[NDArray[np.float64]]:
        """(4, 4) transforms of a node's mesh within it (EXT_mesh_gpu_instancing); otherwise the identity."""
        extension = _extension(node, INSTANCING)
        if extension is None:
            yield np.eye(4)
            return
        attributes = extension["attributes"]
        tables = {name: self._floats(attributes, name, width) for name, width in _TRANSFORM.items()}
        counts = {len(table) for table in tables.values() if table is not None}
        if len(counts) > 1:
            attributes.fail("accessor-range", f"instances have {min(counts)} and {max(counts)} transforms")
        for row in range(max(counts, default=0)):
            yield _matrix(**{name.lower(): None if t is None else t[row] for name, t in tables.items()})

    def read_parts(self, mesh: int, weights: tuple[float, ...]) -> Iterator[RawMesh]:
        """The primitives of a mesh that have triangles.

        Args:
            weights: Of its morph targets; without, the mesh's own.
        """
        entry = self.root["meshes"].at(mesh)
        if not weights and entry.has("weights"):
            weights = _numbers(entry, "weights")
        for primitive in entry["primitives"].items(2**24, 1):
            mode = primitive["mode"].integer(0, 6) if primitive.has("mode") else _TRIANGLES
            if mode in _POINTS_AND_LINES:
                self.without_surface += 1
                continue
            yield self._read_primitive(primitive, mode, weights)

    def _read_primitive(self, primitive: Value, mode: int, weights: tuple[float, ...]) -> RawMesh:
        attributes = primitive["attributes"]
        texels, uv_map = self._texture(primitive)
        packed = _extension(primitive, DRACO)
        if packed is not None and not find_accessor(self.root, attributes["POSITION"]).has("bufferView"):
            vertices, uv, indices = self._unpack_draco(packed, attributes, texels)
        else:
            vertices = self._vectors(attributes["POSITION"], 3)
            uv = self._floats(attributes, texels, 2)
            indices = None
            if primitive.has("indices"):
                entry = find_accessor(self.root, primitive["indices"])
                indices = read_accessor(entry, self._view, 3 * limits.MAX_TRIANGLES).astype(np.int64).reshape(-1)
        if indices is None:
            indices = np.arange(len(vertices))
        check_range(indices, len(vertices))
        if uv is not None and len(uv) != len(vertices):
            attributes.fail("mesh-uv", f"{len(uv)} texture coordinates for {len(vertices)} vertices")
        for target, weight in zip(primitive["targets"].items(2**16) if any(weights) else (), weights, strict=False):
            moved = self._floats(target, "POSITION", 3)
            if weight and moved is not None:
                vertices = vertices + weight * moved
        return RawMesh(
            vertices, _triangles(indices, mode), None if uv is None else uv @ uv_map[:2, :2].T + uv_map[:2, 2]
        )

    def _texture(self, primitive: Value) -> tuple[str, NDArray[np.float64]]:
        """The texture coordinates of the base colour, by their attribute, and their (3, 3) transform.

        KHR_texture_transform: uv' = T R S uv. R turns counter-clockwise as one sees it, with v down.
        """
        info = None
        if primitive.has("material") and self.root.has("materials"):
            material = self.root["materials"].at(primitive["material"].integer(0, 2**31))
            for place, key in (("pbrMetallicRoughness", "baseColorTexture"), (None, "emissiveTexture")):
                holder = material if place is None else material[place] if material.has(place) else None
                if info is None and holder is not None and holder.has(key):
                    info = holder[key]
        if info is None:
            return "TEXCOORD_0", np.eye(3)
        texels = info["texCoord"].integer(0, 2**16) if info.has("texCoord") else 0
        transform = _extension(info, TEXTURE_TRANSFORM)
        if transform is None:
            return f"TEXCOORD_{texels}", np.eye(3)
        if transform.has("texCoord"):
            texels = transform["texCoord"].integer(0, 2**16)
        angle = transform["rotation"].number() if transform.has("rotation") else 0.0
        (x, y), (sx, sy) = _numbers(transform, "offset", (0.0, 0.0)), _numbers(transform, "scale", (1.0, 1.0))
        c, s = np.cos(angle), np.sin(angle)
        return f"TEXCOORD_{texels}", np.array([[c * sx, s * sy, x], [-s * sx, c * sy, y], [0, 0, 1]])

    def _unpack_draco(
        self, packed: Value, attributes: Value, texels: str
    ) -> tuple[NDArray[np.float64], NDArray[np.float64] | None, NDArray[np.int64]]:
        """Positions, UVs and indices of a primitive that Draco compressed."""
        try:
            import DracoPy
        except ImportError:
            message = f"its geometry is compressed ({DRACO}), and DracoPy is not installed"
            remedy = "pip install 'eigenfield[meshes]', or export it without compression"
            raise ProxyError("proxy-extension", message, remedy=remedy) from None
        decoded = DracoPy.decode(bytes(self._view(packed["bufferView"]).data))
        numbers = packed["attributes"]

        def attribute(name: str) -> NDArray[np.float64] | None:
            if not numbers.has(name):
                return None
            array = np.asarray(decoded.get_attribute_by_unique_id(numbers[name].integer(0, 2**31))["data"])
            entry = find_accessor(self.root, attributes[name])
            if array.dtype.kind in "iu" and entry.has("normalized") and entry["normalized"].boolean():
                return np.maximum(array / np.iinfo(array.dtype).max, -1.0)
            return array.astype(np.float64)

        positions = attribute("POSITION")
        if positions is None:
            numbers.fail("accessor-missing", "it has no positions")
        return positions, attribute(texels), np.asarray(decoded.faces).astype(np.int64).reshape(-1)

    def _floats(self, holder: Value, key: str, width: int) -> NDArray[np.float64] | None:
        """(n, width) numbers of the accessor that a member names; None where there is none."""
        return self._vectors(holder[key], width) if holder.has(key) else None

    def _vectors(self, reference: Value, width: int) -> NDArray[np.float64]:
        found = read_accessor(find_accessor(self.root, reference), self._view, limits.MAX_VERTICES)
        if found.ndim != 2 or found.shape[1] != width:
            reference.fail("accessor-type", f"vectors of {width} numbers expected")
        return found.astype(np.float64)

    def _view(self, reference: Value) -> ViewBytes:
        """The bytes of the buffer view whose index `reference` holds."""
        entry = self.root["bufferViews"].at(reference.integer(0, 2**31))
        data = self._buffer(entry["buffer"])
        offset = entry["byteOffset"].integer(0, limits.MAX_FILE) if entry.has("byteOffset") else 0
        length = entry["byteLength"].integer(1, limits.MAX_FILE)
        stride = entry["byteStride"].integer(0, limits.MAX_FILE) if entry.has("byteStride") else 0
        if offset + length > len(data):
            entry.fail("view-range", f"ends at byte {offset + length} of {len(data)}")
        return ViewBytes(data[offset : offset + length], stride, offset)

    def _buffer(self, reference: Value) -> memoryview:
        index = reference.integer(0, 2**31)
        if index not in self._buffers:
            entry = self.root["buffers"].at(index)
            length = entry["byteLength"].integer(0, limits.MAX_FILE)
            if entry.has("uri"):
                data = self._fetch(entry["uri"].text(limits.MAX_FILE))
            elif index == 0 and self._binary is not None:
                data = self._binary
            else:
                entry.fail("buffer", f"buffer {index} has no data")
            if length > len(data):
                entry.fail("buffer", f"{length} bytes of buffer {index} announced, {len(data)} found")
            self._buffers[index] = data[:length]
        return self._buffers[index]

    def _fetch(self, uri: str) -> memoryview:
        """The bytes of a data URI, or of a file in this one's folder whose name is percent-encoded (RFC 3986)."""
        if uri[:5].lower() == "data:":
            head, _, body = uri[5:].partition(",")
            raw = unquote_to_bytes(body)
            return memoryview(base64.b64decode(raw) if head.lower().endswith(";base64") else raw)
        folder, plain = self._path.parent, unquote(uri).replace("\\", "/")
        outside = plain.startswith("/") or _DRIVE.match(plain) is not None or ".." in plain.split("/")
        for name in () if outside else (unquote(uri), uri, plain):
            try:
                file = folder / name
                if file.is_file():
                    if not file.resolve().is_relative_to(folder.resolve()):  # by a link
                        outside = True
                        break
                    return memoryview(file.read_bytes())
            except (OSError, ValueError):  # a name that no file can have
                continue
        if outside:
            message = f"its data {quote(unquote(uri))} lie outside of its folder, and are not read"
            raise ProxyError("proxy-outside", message, remedy="put that file beside it, or export one .glb")
        raise ProxyError(
            "proxy-unreadable",
            f"its data {quote(unquote(uri))} are not beside it",
            remedy="put that file where it belongs, or export one .glb",
        )


_DRIVE = re.compile(r"[a-z]:/", re.IGNORECASE)  # of Windows
_TRANSFORM = {"TRANSLATION": 3, "ROTATION": 4, "SCALE": 3}


def _refuse_extension(message: str, names: list[str]) -> None:
    raise ProxyError("proxy-extension", message, remedy=f"export it without {' and '.join(names)}")


def _extension(holder: Value, name: str) -> Value | None:
    if not holder.has("extensions") or not holder["extensions"].has(name):
        return None
    return holder["extensions"][name]


def _numbers(holder: Value, key: str, default: tuple[float, ...] | None = None) -> tuple[float, ...]:
    """The numbers of a member; as many as the default has."""
    if default is not None and not holder.has(key):
        return default
    count = None if default is None else len(default)
    return tuple(item.number() for item in holder[key].items(count or 2**16, count or 0))


def _local_matrix(node: Value) -> NDArray[np.float64]:
    """(4, 4) transform of a node within its parent."""
    if node.has("matrix"):
        return np.array(_numbers(node, "matrix", (0.0,) * 16)).reshape(4, 4).T
    given: Mapping[str, Any] = {
        name.lower(): np.array(_numbers(node, name.lower(), (0.0,) * width)) if node.has(name.lower()) else None
        for name, width in _TRANSFORM.items()
    }
    return _matrix(**given)


def _matrix(
    translation: NDArray[np.float64] | None, rotation: NDArray[np.float64] | None, scale: NDArray[np.float64] | None
) -> NDArray[np.float64]:
    """(4, 4) T R S of a translation (3,), a quaternion x, y, z, w and scales (3,)."""
    matrix = np.eye(4)
    length = 0.0 if rotation is None else float(np.linalg.norm(rotation))
    if rotation is not None and length > 0:
        x, y, z, w = rotation / length
        matrix[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    if scale is not None:
        matrix[:3, :3] *= scale
    if translation is not None:
        matrix[:3, 3] = translation
    return matrix


def _triangles(indices: NDArray[np.int64], mode: int) -> NDArray[np.int64]:
    """(m, 3) faces of a list, a strip or a fan of triangles (glTF 2.0, section 3.7.2.1)."""
    if mode == _STRIP:
        return strip_triangles(indices)
    if mode == _FAN:
        return np.stack([np.full(max(len(indices) - 2, 0), indices[0]), indices[1:-1], indices[2:]], axis=1)
    if len(indices) % 3:
        raise ValueError(f"{len(indices)} indices are no whole number of triangles")
    return indices.reshape(-1, 3)


GLTF = MeshFormat(
    "glTF 2.0", (".glb", ".gltf"), read_gltf,
    "triangles, strips and fans of the scene that is shown; transforms of nodes; every type of accessor, sparse ones "
    "too; buffers in the file, beside it and in data URIs; weights of morph targets; "
    + ", ".join(f"`{name}`" for name in GLTF_READ_EXTENSIONS) + " (Draco with `pip install 'eigenfield[meshes]'`)",
    "every other entry of `extensionsRequired` that may change geometry, among them "
    + " and ".join(f"`{name}`" for name in MESHOPT) + "; nodes that form a circle or multiply",
    "points and lines, materials, bones, animations, other scenes",
    "trimesh 5.2, Blender 5.0 (bpy), glTF-Transform 4.5, gltfpack 1.3, DracoPy 2.2, eigenfield",
)  # fmt: skip
