"""Scene to GLB: geometry, mean, weights, calibration, then the eigen textures by rank."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.coding.arrays.names import code_names
from eigenfield.coding.pictures import pictures_8bit as pictures
from eigenfield.core.errors import OutputError
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import PictureFile, cameras_stream, stream_of
from eigenfield.core.progress import Progress
from eigenfield.core.scene import Plane, Residual, Scene
from eigenfield.core.version import __version__
from eigenfield.gltf import strict_json
from eigenfield.gltf.axes import capture_to_gltf, opening_view, quaternion
from eigenfield.gltf.buffer import Buffer
from eigenfield.gltf.coarse import shown_mesh
from eigenfield.gltf.coded_pictures import Coded, CodedPlane, code_pictures, shortest
from eigenfield.gltf.container import BINARY_CHUNK, CHUNK, Glb, front, json_bytes
from eigenfield.gltf.document import FLOAT, UINT8, UINT16, UINT32, Document
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.layout import read_layout
from eigenfield.gltf.name_pattern import name_pattern
from eigenfield.gltf.writable import check_writable
from eigenfield.runtime.files import atomic_writer, refuse_existing

QUALITY = 70  # of the eigen textures, for avif
_VERTICES, _INDICES = 34962, 34963  # glTF's targets of a buffer view
CODED_NAMES = 256  # bytes that coded names must save, and their two entries in the JSON


def save(
    scene: Scene,
    path: str | os.PathLike[str],
    *,
    codec: str | None = None,
    quality: int | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write `scene` as a .glb, atomically.

    codec: "png", "webp" (both keep every code of 8 bits) or "avif" (lossy). Without codec and quality what is coded
    already (by a fit, or read from a file) is kept as it is, and the rest becomes AVIF.
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
    scene: Scene, *, codec: str | None = None, quality: int | None = None, progress: Progress | None = None
) -> bytes:
    """The whole .glb in memory; options and errors as `save`. The same bytes at any number of threads."""
    return b"".join(_blocks(scene, codec, quality, progress, None))


def _blocks(
    scene: Scene, codec: str | None, quality: int | None, progress: Progress | None, path: Path | None
) -> list[bytes]:
    if codec is None and quality is not None:
        codec = pictures.DEFAULT_CODEC
    pictures.check_codec(codec or pictures.DEFAULT_CODEC, quality)
    check_writable(scene, path)
    coded = code_pictures(scene, codec, QUALITY if quality is None else quality, progress)
    buffer = Buffer()
    gltf = _gltf(scene, buffer, coded)
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


def _gltf(scene: Scene, buffer: Buffer, coded: Coded) -> dict[str, Any]:
    """The JSON, while `buffer` fills: mesh, mean, weights, calibration, textures."""
    mesh, poses = stream_of(scene.mesh), cameras_stream(scene.cameras)
    shown = scene.mesh if mesh is None else shown_mesh(scene.mesh, coded.bytes + len(mesh))
    primitive = _primitive(shown, buffer, mesh is not None)
    proxy = {} if mesh is None else {"mesh": {"bufferView": buffer.view(mesh)}}
    first = coded.planes[0].mean.data if coded.preview is None else coded.preview
    image = {"bufferView": buffer.view(first), "mimeType": "image/png" if coded.preview is None else "image/jpeg"}
    planes = [
        _plane(plane, made, buffer, inline=index > 0 or coded.preview is not None)
        for index, (plane, made) in enumerate(zip(scene.planes, coded.planes, strict=True))
    ]
    cameras, view_plane = _cameras(scene, buffer, poses), _view_plane(scene, buffer, poses is not None)
    used = {
        "codedNames": "codedNames" in cameras,
        "namePattern": "pattern" in cameras,
        "codedTriangles": "codedTriangles" in view_plane,
        "sharedPicture": any("picture" in basis for plane in planes for basis in plane["bases"]),
    }
    needs = _needs(scene, coded, mesh is not None, poses is not None, used)
    extension: dict[str, Any] = {
        "version": _version(scene, coded, needs),
        "needs": needs,
        **proxy,
        "planes": planes,
        **({} if scene.to_rgb is None else {"toRGB": shortest(scene.to_rgb.ravel())}),
        "cameras": cameras,
        "viewPlane": view_plane,
        "reference": int(scene.reference),
        "settings": dict(scene.settings),
        "scores": dict(scene.scores),
        "generator": scene.generator or f"eigenfield {__version__}",
    }
    for entry, file in _by_worth(scene, coded, planes):  # last: a file that is still arriving can be drawn
        entry["bufferView"] = buffer.view(file.data)
    if scene.residual is not None:  # behind all that any view is drawn of: a file that is cut off there loses it alone
        extension["residual"] = _residual(scene.residual, buffer)
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


def _by_worth(scene: Scene, coded: Coded, planes: list[dict[str, Any]]) -> list[tuple[dict[str, Any], PictureFile]]:
    """The entries of all pictures of eigen textures and their files, so that what takes most squared error off R, G and
    B for its bytes comes first; those of one basis in their order."""
    queues = []
    first = 0
    for plane, made, shown in zip(scene.planes, coded.planes, planes, strict=True):
        depth = plane.mean.shape[2]
        matrix = np.eye(depth) if scene.to_rgb is None else scene.to_rgb[:, first : first + depth]
        first += depth
        share = np.square(matrix, dtype=np.float64).sum(axis=0)
        for basis, files, entry in zip(plane.bases, made.bases, shown["bases"], strict=True):
            energy = np.square(basis.weights, dtype=np.float64).mean(axis=0) / float(np.prod(basis.size))
            worth, at = [], 0
            for file in files:
                part = basis.values(at, at + file.count)
                each = np.einsum("nhwc,nhwc,c->n", part, part, share.astype(np.float32))
                worth.append(float(each @ energy[at : at + file.count]) / len(file.data))
                at += file.count
            queues.append(list(zip(worth, entry["textures"], files, strict=True)))
    found = []
    while any(queues):
        _, entry, file = max((queue for queue in queues if queue), key=lambda queue: queue[0][0]).pop(0)
        found.append((entry, file))
    return found


def _version(scene: Scene, coded: Coded, needs: Sequence[str]) -> str:
    """The first version that has all that the file uses."""
    if "codedNames" in needs:
        return limits.VERSION
    if scene.residual is not None and scene.residual.smooth:
        return limits.SIXTH
    if any(plane.mean.precision is not None for plane in coded.planes):
        return limits.FIFTH
    if scene.residual is not None:
        return limits.FOURTH
    return limits.THIRD if needs else limits.FIRST if scene.colours is None else limits.SECOND


def _primitive(mesh: Mesh, buffer: Buffer, small: bool) -> dict[str, Any]:
    """small: whether indices may have 8 bits, which other viewers read but need not be quick at."""
    assert mesh.uv is not None
    # the largest index of a type restarts a primitive and may not be used
    index = UINT8 if small and len(mesh.vertices) < 256 else UINT16 if len(mesh.vertices) < 65_536 else UINT32
    bounds = {"min": shortest(mesh.vertices.min(axis=0)), "max": shortest(mesh.vertices.max(axis=0))}
    return {
        "attributes": {
            "POSITION": buffer.accessor(mesh.vertices, FLOAT, "VEC3", _VERTICES, **bounds),
            "TEXCOORD_0": buffer.accessor(mesh.uv, FLOAT, "VEC2", _VERTICES),
        },
        "indices": buffer.accessor(mesh.faces.ravel(), index, "SCALAR", _INDICES),
        "material": 0,
    }


def _plane(plane: Plane, coded: CodedPlane, buffer: Buffer, *, inline: bool) -> dict[str, Any]:
    """A plane's entry without the textures' buffer views; inline: the mean is its own picture, not images[0]."""
    height, width, channels = plane.mean.shape
    made: dict[str, Any] = {"channels": channels}
    if inline:
        mean: dict[str, Any] = {"bufferView": buffer.view(coded.mean.data), "size": [width, height]}
        made["mean"] = mean | _picture(coded.mean)
        if coded.mean.precision is not None:
            made["mean"]["precision"] = _precision(coded.mean.precision, buffer)
    made["bases"] = []
    for basis, files in zip(plane.bases, coded.bases, strict=True):
        entry: dict[str, Any] = {"size": [basis.textures.shape[2], basis.textures.shape[1]]}
        if basis.grid is not None:
            entry |= {"grid": [basis.grid[1], basis.grid[0]], "corner": [basis.corner[1], basis.corner[0]]}
        stream = stream_of(basis)
        if stream is not None:
            entry["codedWeights"] = buffer.view(stream)
        elif basis.count:
            entry["weights"] = buffer.accessor(basis.weights.ravel(), FLOAT, "SCALAR")
        entry |= _textures([_picture(file) for file in files])
        made["bases"].append(entry)
    return made


def _precision(data: bytes, buffer: Buffer) -> dict[str, Any]:
    size = pictures.dimensions(memoryview(data), pictures.MIME_TYPES["png"], "precision")
    return {"bufferView": buffer.shared(data), "size": list(size)}


def _textures(entries: list[dict[str, Any]]) -> dict[str, Any]:
    """Entries of pictures of more than one texture, what most of them say said once; the buffer views come later."""
    common: dict[str, Any] = {}
    if len(entries) > 1 and any("count" in entry for entry in entries):
        common = {"count": 1} | entries[0]
        entries = [{"count": 1} | entry for entry in entries]
        common = {key: value for key, value in common.items() if all(key in entry for entry in entries)}
        entries = [{key: value for key, value in one.items() if common.get(key) != value} for one in entries]
    shared = {"picture": common} if common else {}
    return shared | {"textures": [{"bufferView": -1, **entry} for entry in entries]}


def _picture(file: PictureFile) -> dict[str, Any]:
    """What a picture's entry says beside where it lies."""
    made: dict[str, Any] = {"mimeType": file.mime}
    if file.bits != 8:
        made["bits"] = file.bits
    if file.count != 1:
        made["count"] = file.count
    if file.affine is not None:
        made |= {"scale": _repeated(file.affine.scale, file.count), "zero": _repeated(file.affine.zero, file.count)}
    return made


def _repeated(numbers: NDArray[np.float64], count: int) -> list[float]:
    """The numbers of `count` textures; of one, where all have the same."""
    each = numbers.reshape(count, -1)
    return shortest(each[:1] if (each == each[0]).all() else each)


def _residual(residual: Residual, buffer: Buffer) -> dict[str, Any]:
    order, count = residual.order, len(residual.order)
    made: dict[str, Any] = {"size": [residual.size[1], residual.size[0]], "scale": list(residual.scale)}
    if residual.full:
        made["full"] = True
    if residual.smooth:
        made["smooth"] = True
    if (order != np.arange(count)).any():
        made["order"] = buffer.accessor(order, UINT16 if count < 65_536 else UINT32, "SCALAR")
    return made | {"bufferView": buffer.view(residual.film)}


def _needs(scene: Scene, coded: Coded, mesh: bool, cameras: bool, used: Mapping[str, bool]) -> list[str]:
    """The features that a reader must know to draw this scene rightly; used: some of them."""
    files = [file for plane in coded.planes for some in [[plane.mean], *plane.bases] for file in some]
    found = {
        "bits": any(file.bits != 8 for file in files),
        "codedCameras": cameras,
        "codedMesh": mesh,
        "codedWeights": any(stream_of(basis) is not None for plane in scene.planes for basis in plane.bases),
        "precision": any(plane.mean.precision is not None for plane in coded.planes),
        "regions": any(basis.grid is not None for plane in scene.planes for basis in plane.bases),
        "stacks": any(file.count != 1 for file in files),
        "toRGB": scene.to_rgb is not None,
        **used,
    }
    return sorted(name for name, needed in found.items() if needed)


def _cameras(scene: Scene, buffer: Buffer, stream: bytes | None) -> dict[str, Any]:
    sizes = np.array([[c.width, c.height] for c in scene.cameras])
    made = _names(scene.names, None if stream is None else buffer)
    made["heldOut"] = np.flatnonzero(scene.held_out).tolist()
    if stream is not None:
        made["coded"] = buffer.view(stream)
    else:
        cameras = scene.cameras
        intrinsics = np.array([[c.K[0, 0], c.K[1, 1], c.K[0, 1], c.K[0, 2], c.K[1, 2]] for c in cameras])
        poses = np.array([np.hstack([c.R, c.t[:, None]]) for c in cameras])
        made["intrinsics"] = buffer.accessor(intrinsics.ravel(), FLOAT, "SCALAR")
        made["poses"] = buffer.accessor(poses.ravel(), FLOAT, "SCALAR")
    if stream is not None and (sizes == sizes[0]).all():
        made["size"] = sizes[0].tolist()
    else:
        made["sizes"] = buffer.accessor(sizes.ravel(), UINT32, "SCALAR")
    if scene.colours is not None:
        made["colour"] = buffer.accessor(scene.colours.ravel(), FLOAT, "SCALAR")
    return made


def _names(names: Sequence[str], buffer: Buffer | None) -> dict[str, Any]:
    """One by one, by a pattern or coded, whichever is shortest; without a buffer as readers of 1.1 know them."""
    plain: dict[str, Any] = {"names": list(names)}
    if buffer is None:
        return plain
    pattern, stream = name_pattern(names), code_names(names)
    told = plain if pattern is None else {"pattern": pattern}
    if stream is None or len(stream) + CODED_NAMES >= len(json_bytes(told)):
        return told
    return {"codedNames": {"bufferView": buffer.view(stream), "count": len(names)}}


def _view_plane(scene: Scene, buffer: Buffer, short: bool) -> dict[str, Any]:
    """short: whether the triangles may be coded, which readers of 1.1 do not know."""
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
        if short:
            from eigenfield.coding.arrays.triangles import (  # numba: most files need none
                code_triangles,
                sorted_triangles,
            )

            made["codedTriangles"] = buffer.view(code_triangles(sorted_triangles(scene.triangles)))
        else:
            made["triangles"] = buffer.accessor(scene.triangles.ravel(), UINT32, "SCALAR")
    return made


def _decimals(numbers: Iterable[float]) -> list[float]:
    """To nine digits, all that readers of 32 bits keep."""
    return [float(f"{number:.9g}") + 0.0 for number in numbers]  # + 0.0: no minus zero in the file


def _nodes(scene: Scene) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    camera = scene.cameras[scene.reference]
    turn = capture_to_gltf(scene.view_plane)
    perspective, axes = opening_view(camera, scene.mesh)
    proxy = {"name": "proxy", "mesh": 0, **_turned(turn)}
    place = _decimals(turn @ camera.centre)
    perspective = dict(zip(perspective, _decimals(perspective.values()), strict=True))
    return perspective, [proxy, {"name": "reference camera", "camera": 0, "translation": place, **_turned(turn @ axes)}]


def _turned(rotation: NDArray[np.float64]) -> dict[str, list[float]]:
    """A node's rotation, (3, 3); left out where it is none."""
    found = _decimals(quaternion(rotation))
    return {} if found == [0, 0, 0, 1] else {"rotation": found}
