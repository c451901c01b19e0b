"""Scene to GLB: geometry, mean, weights, calibration, then the eigen textures by rank."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield import __version__
from eigenfield.errors import OutputError
from eigenfield.files import atomic_writer, refuse_existing
from eigenfield.format import limits, pictures, quantise, strict_json
from eigenfield.format.axes import capture_to_gltf, opening_view, quaternion
from eigenfield.format.container import BINARY_CHUNK, CHUNK, Glb, front, json_bytes
from eigenfield.format.document import FLOAT, UINT16, UINT32, Document
from eigenfield.format.findings import Findings
from eigenfield.format.layout import read_layout
from eigenfield.format.strict_json import printable
from eigenfield.parallel import parallel_stream
from eigenfield.progress import Progress, track
from eigenfield.scene import Basis, Plane, Scene

QUALITY = 70  # of the eigen textures, for avif
MEAN_SHARE = 0.3  # of the textures' distance to quality 100 is the mean's: there a byte gains as much (Tarot)
_VERTICES, _INDICES = 34962, 34963  # glTF's targets of a buffer view


@dataclass
class _Buffer:
    """The binary chunk while it grows, and the JSON entries that point into it."""

    parts: list[bytes] = field(default_factory=list)
    length: int = 0
    views: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)

    def view(self, data: bytes, target: int | None = None) -> int:
        """Append a buffer view at a multiple of 4; its index."""
        entry: dict[str, Any] = {"buffer": 0, "byteOffset": self.length, "byteLength": len(data)}
        if target is not None:
            entry["target"] = target
        self.views.append(entry)
        self.parts.append(data + bytes(-len(data) % 4))
        self.length += len(self.parts[-1])
        return len(self.views) - 1

    def accessor(self, array: NDArray[Any], component: int, kind: str, target: int | None = None, **more: Any) -> int:
        """Append an array as an accessor of its own buffer view; its index."""
        dtype = {FLOAT: "<f4", UINT32: "<u4", UINT16: "<u2"}[component]
        view = self.view(np.ascontiguousarray(array, dtype).tobytes(), target)
        self.accessors.append(
            {"bufferView": view, "componentType": component, "count": len(array), "type": kind, **more}
        )
        return len(self.accessors) - 1


def save(
    scene: Scene,
    path: str | os.PathLike[str],
    *,
    codec: str = "avif",
    quality: int | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write `scene` as a .glb, atomically.

    codec: "png", "webp" (both keep every code) or "avif" (lossy).
    quality: 0..100 for avif, QUALITY unless said; the mean is coded finer (MEAN_SHARE).
    Raises OutputError (`output-exists`, `disk-full`, `file-too-large`, `scene-limit`, ...) and OptionError (`codec`,
    `codec-missing`, `quality`), and FormatError for a scene that is inconsistent in itself, before anything is written.
    """
    path = Path(path)
    refuse_existing(path, overwrite)
    blocks = _blocks(scene, codec, quality, progress, path)
    with atomic_writer(path, overwrite=overwrite) as file:
        for block in blocks:
            file.write(block)


def encode_scene(
    scene: Scene, *, codec: str = "avif", quality: int | None = None, progress: Progress | None = None
) -> bytes:
    """The whole .glb in memory; options and errors as `save`. The same bytes at any number of threads."""
    return b"".join(_blocks(scene, codec, quality, progress, None))


def _blocks(scene: Scene, codec: str, quality: int | None, progress: Progress | None, path: Path | None) -> list[bytes]:
    pictures.check_codec(codec, quality)
    check_writable(scene, path)
    coded = _code_pictures(scene, codec, QUALITY if quality is None else quality, progress)
    buffer = _Buffer()
    gltf = _gltf(scene, buffer, coded, pictures.MIME_TYPES[codec])
    text = json_bytes(gltf)
    if len(text) > limits.MAX_JSON:
        raise OutputError(
            "scene-limit",
            f"{len(text)} bytes of JSON, {limits.MAX_JSON} are allowed",
            path=path,
            remedy="store less in it",
        )
    head = front(text, CHUNK.size + buffer.length, path)
    binary = b"".join(buffer.parts)
    check_readable(text, binary)
    return [head, CHUNK.pack(buffer.length, BINARY_CHUNK), binary]


def check_readable(text: bytes, binary: bytes) -> None:
    """Never write what `load` would refuse: raises its FormatError (a scene put together by hand may be anything)."""
    written = Glb(strict_json.parse(text, "byte 20"), memoryview(binary), len(text) + len(binary), len(text))
    read_layout(Document(written), Findings(strict=True))


@dataclass(frozen=True, eq=False)
class _CodedBasis:
    textures: list[bytes]
    scale: NDArray[np.float32]
    zero: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class _CodedPlane:
    mean: bytes
    affine: quantise.Affine | None
    bases: list[_CodedBasis]


@dataclass(frozen=True, eq=False)
class _Coded:
    """preview: JPEG for `images[0]`, or None where the first plane's mean itself serves."""

    preview: bytes | None
    planes: list[_CodedPlane]


def _code_pictures(scene: Scene, codec: str, quality: int, progress: Progress | None) -> _Coded:
    """Every picture of the scene, coded, the pictures shared among the threads."""
    fine = round(100 - MEAN_SHARE * (100 - quality))
    jobs: list[Callable[[], bytes]] = []
    means = [quantise.mean_codes(plane.mean, _harmonised(scene, plane)) for plane in scene.planes]
    jobs.extend(partial(pictures.encode, codes, codec, fine) for codes, _ in means)
    steps = [
        [quantise.basis_scale(basis, photographic) for basis in plane.bases]
        for plane in scene.planes
        for photographic in [_harmonised(scene, plane) or quantise.photographic(plane.mean)]
    ]
    for plane, scales in zip(scene.planes, steps, strict=True):
        for basis, (scale, zero) in zip(plane.bases, scales, strict=True):
            jobs.extend(partial(_code_texture, basis, k, scale, zero, codec, quality) for k in range(basis.count))
    done = track(parallel_stream(lambda job: job(), jobs), "code textures", len(jobs), progress)
    files = iter(list(done))
    coded_means = [next(files) for _ in means]
    planes = [
        _CodedPlane(
            coded_means[i],
            means[i][1],
            [
                _CodedBasis([next(files) for _ in range(basis.count)], scale, zero)
                for basis, (scale, zero) in zip(plane.bases, steps[i], strict=True)
            ],
        )
        for i, plane in enumerate(scene.planes)
    ]
    first = scene.planes[0].mean
    if codec == "png" and first.shape[2] in (1, 3) and means[0][1] is None:
        return _Coded(None, planes)  # the mean itself serves
    return _Coded(_preview(first.clip(0, 1) if scene.colours is not None else first), planes)


def _harmonised(scene: Scene, plane: Plane) -> bool:
    """Whether a plane holds colours brought together by gains, which may lie beyond 0..1 and yet are photographs'."""
    return scene.colours is not None and plane is scene.planes[0]


def _code_texture(
    basis: Basis, index: int, scale: NDArray[np.float32], zero: NDArray[np.float32], codec: str, quality: int
) -> bytes:
    return pictures.encode(quantise.texture_codes(basis, index, scale, zero), codec, quality)


def _preview(mean: NDArray[np.float32]) -> bytes:
    """Something to see for every glTF viewer: R, G, B as they are; else the first one or three channels, stretched."""
    shown = mean if mean.shape[2] in (1, 3) else mean[..., : 3 if mean.shape[2] > 3 else 1]
    if not quantise.photographic(mean) and not quantise.unit_range(shown):
        low, high = shown.min(axis=(0, 1)), shown.max(axis=(0, 1))
        shown = (shown - low) / np.where(high > low, high - low, 1)
    return pictures.encode_preview(np.rint(shown * 255).clip(0, 255).astype(np.uint8))


def _gltf(scene: Scene, buffer: _Buffer, coded: _Coded, mime: str) -> dict[str, Any]:
    """The JSON, while `buffer` fills: mesh, mean, weights, calibration, textures."""
    primitive = _primitive(scene, buffer)
    first = coded.planes[0].mean if coded.preview is None else coded.preview
    image = {"bufferView": buffer.view(first), "mimeType": "image/png" if coded.preview is None else "image/jpeg"}
    planes = [
        _plane(plane, made, buffer, mime, inline=index > 0 or coded.preview is not None)
        for index, (plane, made) in enumerate(zip(scene.planes, coded.planes, strict=True))
    ]
    extension: dict[str, Any] = {
        "version": limits.FIRST if scene.colours is None else limits.VERSION,
        "needs": [],
        "planes": planes,
        "cameras": _cameras(scene, buffer),
        "viewPlane": _view_plane(scene, buffer),
        "reference": int(scene.reference),
        "settings": dict(scene.settings),
        "scores": dict(scene.scores),
        "generator": scene.generator or f"eigenfield {__version__}",
    }
    for plane, made in zip(planes, coded.planes, strict=True):  # last: a file that is still arriving can be drawn
        for basis, made_basis in zip(plane["bases"], made.bases, strict=True):
            for entry, data in zip(basis["textures"], made_basis.textures, strict=True):
                entry["bufferView"] = buffer.view(data)
    perspective, nodes = _nodes(scene)
    return {
        "asset": {"version": "2.0", "generator": f"eigenfield {__version__}"},
        "extensionsUsed": ["KHR_materials_unlit", limits.EXTENSION],
        "extensions": {limits.EXTENSION: extension},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": nodes,
        "cameras": [{"type": "perspective", "perspective": perspective}],
        "meshes": [{"name": "proxy", "primitives": [primitive]}],
        "materials": [
            {
                "name": "mean",
                "pbrMetallicRoughness": {
                    "baseColorTexture": {"index": 0},
                    "metallicFactor": 0.0,
                    "roughnessFactor": 1.0,
                },
                "extensions": {"KHR_materials_unlit": {}},
                "doubleSided": True,
            }
        ],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}],
        "images": [image],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": buffer.length}],
    }


def _primitive(scene: Scene, buffer: _Buffer) -> dict[str, Any]:
    mesh = scene.mesh
    assert mesh.uv is not None
    short = len(mesh.vertices) < 65_536  # 65535 itself restarts a primitive and may not be an index
    bounds = {"min": mesh.vertices.min(axis=0).tolist(), "max": mesh.vertices.max(axis=0).tolist()}
    return {
        "attributes": {
            "POSITION": buffer.accessor(mesh.vertices, FLOAT, "VEC3", _VERTICES, **bounds),
            "TEXCOORD_0": buffer.accessor(mesh.uv, FLOAT, "VEC2", _VERTICES),
        },
        "indices": buffer.accessor(mesh.faces.ravel(), UINT16 if short else UINT32, "SCALAR", _INDICES),
        "material": 0,
    }


def _plane(plane: Plane, coded: _CodedPlane, buffer: _Buffer, mime: str, *, inline: bool) -> dict[str, Any]:
    """A plane's entry without the textures' buffer views; inline: the mean is its own picture, not images[0]."""
    height, width, channels = plane.mean.shape
    made: dict[str, Any] = {"channels": channels}
    if inline:
        mean: dict[str, Any] = {"bufferView": buffer.view(coded.mean), "mimeType": mime, "size": [width, height]}
        if coded.affine is not None:
            mean |= {"scale": coded.affine.scale.tolist(), "zero": coded.affine.zero.tolist()}
        made["mean"] = mean
    made["bases"] = []
    for basis, coded_basis in zip(plane.bases, coded.bases, strict=True):
        entry: dict[str, Any] = {"size": [basis.textures.shape[2], basis.textures.shape[1]], "textures": []}
        if basis.count:
            entry["weights"] = buffer.accessor(basis.weights.ravel(), FLOAT, "SCALAR")
        for scale, zero in zip(coded_basis.scale, coded_basis.zero, strict=True):
            entry["textures"].append(
                {"bufferView": -1, "mimeType": mime, "scale": _shortest(scale), "zero": _shortest(zero)}
            )
        made["bases"].append(entry)
    return made


def _cameras(scene: Scene, buffer: _Buffer) -> dict[str, Any]:
    cameras = scene.cameras
    intrinsics = np.array([[c.K[0, 0], c.K[1, 1], c.K[0, 1], c.K[0, 2], c.K[1, 2]] for c in cameras])
    poses = np.array([np.hstack([c.R, c.t[:, None]]) for c in cameras])
    sizes = np.array([[c.width, c.height] for c in cameras])
    made = {
        "names": list(scene.names),
        "heldOut": np.flatnonzero(scene.held_out).tolist(),
        "intrinsics": buffer.accessor(intrinsics.ravel(), FLOAT, "SCALAR"),
        "poses": buffer.accessor(poses.ravel(), FLOAT, "SCALAR"),
        "sizes": buffer.accessor(sizes.ravel(), UINT32, "SCALAR"),
    }
    if scene.colours is not None:
        made["colour"] = buffer.accessor(scene.colours.ravel(), FLOAT, "SCALAR")
    return made


def _view_plane(scene: Scene, buffer: _Buffer) -> dict[str, Any]:
    plane = scene.view_plane
    made: dict[str, Any] = {
        name: (np.asarray(value, np.float64) + 0.0).tolist()  # + 0.0: no minus zero in the file
        for name, value in (
            ("origin", plane.origin),
            ("right", plane.right),
            ("up", plane.up),
            ("extent", plane.extent),
        )
    }
    if len(scene.triangles):
        made["triangles"] = buffer.accessor(scene.triangles.ravel(), UINT32, "SCALAR")
    return made


def _nodes(scene: Scene) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    camera = scene.cameras[scene.reference]
    turn = capture_to_gltf(scene.view_plane)
    perspective, axes = opening_view(camera, scene.mesh)
    place = (turn @ camera.centre + 0.0).tolist()
    return perspective, [
        {"name": "proxy", "mesh": 0, "rotation": quaternion(turn)},
        {"name": "reference camera", "camera": 0, "translation": place, "rotation": quaternion(turn @ axes)},
    ]


def _shortest(numbers: NDArray[np.float32]) -> list[float]:
    """The shortest decimals that give the same float32."""
    return [float(str(number)) for number in numbers]


def check_writable(scene: Scene, path: Path | None) -> None:
    """Raises OutputError `scene-limit` or `camera-name` for what no reader would take back."""

    def refuse(what: str) -> None:
        raise OutputError("scene-limit", f"a file cannot hold {what}", path=path, remedy="make the scene smaller")

    for plane in scene.planes:
        channels = plane.mean.shape[2]
        if channels > limits.MAX_CHANNELS:
            refuse(f"{channels} channels")
        for height, width in [plane.mean.shape[:2], *(basis.textures.shape[1:3] for basis in plane.bases)]:
            w, h = pictures.picture_size(width, height, channels)
            if max(width, height) > limits.MAX_SIDE or h > limits.MAX_STACKED or w * h > limits.MAX_TEXELS:
                refuse(f"a picture of {w}x{h}")
    bases = [basis for plane in scene.planes for basis in plane.bases]
    decoded = sum(
        4 * plane.mean.size + sum(math.prod(basis.textures.shape) for basis in plane.bases) for plane in scene.planes
    )
    counts: Iterable[tuple[int, int, str]] = [
        (len(scene.cameras), limits.MAX_CAMERAS, "cameras"),
        (sum(basis.count for basis in bases), limits.MAX_COMPONENTS, "eigen textures"),
        (len(scene.planes), limits.MAX_PLANES, "planes"),
        (max(len(plane.bases) for plane in scene.planes), limits.MAX_BASES, "bases"),
        (decoded, limits.MAX_DECODED, "decoded bytes"),
        (len(scene.mesh.vertices), limits.MAX_VERTICES, "vertices"),
        (len(scene.mesh.faces), limits.MAX_TRIANGLES, "triangles"),
        (max((basis.weights.size for basis in bases), default=0), limits.MAX_WEIGHTS, "weights"),
    ]
    for count, most, name in counts:
        if count > most:
            refuse(f"{count} {name}")
    for name in scene.names:
        if len(name) > limits.MAX_NAME or not printable(name):
            raise OutputError(
                "camera-name", f"the name {name!r} cannot be kept", path=path, remedy="rename the photograph"
            )
