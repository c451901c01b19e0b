"""Scene to GLB: geometry, mean, weights, calibration, then the eigen textures by rank."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from eigenfield.coding import limits
from eigenfield.coding.codecs import CODECS
from eigenfield.coding.stacking import DEFAULT_CODEC, PICTURES, check_codec, dimensions
from eigenfield.core.appearance import Plane
from eigenfield.core.arguments import checked
from eigenfield.core.clip import Clip
from eigenfield.core.errors import FormatError, OptionError, OutputError
from eigenfield.core.mesh import Mesh
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.payloads import Payload, PicturePayload
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Sheets
from eigenfield.core.scene import Residual, Scene
from eigenfield.gltf import strict_json
from eigenfield.gltf.accessors import FLOAT, UINT16, UINT32
from eigenfield.gltf.buffer import Buffer
from eigenfield.gltf.cached import CachedPayloads, cached_payloads
from eigenfield.gltf.coded_pictures import (
    PlanePictures,
    ScenePictures,
    affine_numbers,
    code_pictures,
    shown_mean,
)
from eigenfield.gltf.container import BINARY_CHUNK, Glb, glb_blocks, json_bytes
from eigenfield.gltf.fallback import make_fallback, with_fallback
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.layout import read_layout, unpacked_document
from eigenfield.gltf.read import load_any
from eigenfield.gltf.source import ByteRange, HeldBytes
from eigenfield.gltf.streams import FEATURES, codec_entry, minor
from eigenfield.gltf.writable import check_writable
from eigenfield.gltf.write_clip import clip_blocks
from eigenfield.gltf.write_geometry import (
    index_type,
    write_cameras,
    write_stream,
    write_view_plane,
)
from eigenfield.gltf.write_root import write_drawn, write_rest, write_root
from eigenfield.runtime.files import atomic_writer, refuse_existing

log = logging.getLogger("eigenfield.format")

DEFAULT_AVIF_QUALITY = 70  # of the eigen textures


@checked
def save(
    scene: Scene | Clip | str | os.PathLike[str],
    path: str | os.PathLike[str],
    *,
    codec: str | None = None,
    quality: int | None = None,
    fallback: str | None = None,
    overwrite: bool = False,
    progress: Progress | None = notebook_progress,
) -> None:
    """Write a scene or a clip as a .glb, atomically.

    The groups of a clip are copied, never coded again. Parts of a scene whose content has not changed since they were
    coded keep their bytes, too. One line of the log lists the parts that are coded anew, and the bytes that this costs;
    as a warning where the file grows by it.

    Args:
        scene: To be written, or a file.
        path: Of the .glb.
        codec: "png", "webp" (both keep every code of 8 bits) or "avif" (lossy), for all pictures. Without codec and
            quality, pictures that are coded already (by a fit, or read from a file) stay as they are, and the rest
            becomes AVIF.
        quality: 0..100 for avif, by default DEFAULT_AVIF_QUALITY; the mean is coded finer (MEAN_QUALITY_RATIO).
        fallback: What viewers without eigen textures show of a scene whose mesh is coded: "small", "good" or "none";
            None: as it was encoded.
        overwrite: Whether an existing file is replaced.
        progress: Reports each picture; by default a bar in a notebook.

    Raises:
        OutputError: `output-exists`, `disk-full`, `file-too-large`, `scene-limit`, ...
        OptionError: `codec`, `codec-missing`, `quality`, `fallback`; `clip-groups`: the clip is of no coded groups.
        FormatError: The scene is inconsistent in itself, or was read from a file that ends too early (`truncated`).
            Nothing is written.
    """
    path = Path(path)
    refuse_output(path, overwrite)
    made = scene if isinstance(scene, Scene | Clip) else load_any(scene)
    if isinstance(made, Scene) and made.cut_off:
        message, remedy = "the scene's file ended before all of it was there", "copy or download that file again"
        raise FormatError("truncated", message, path=path, remedy=remedy)
    if fallback is not None:
        made = with_fallback(made, fallback)
    if isinstance(made, Clip):
        _refuse_coding(codec, quality, path)
        blocks, anew = clip_blocks(made, path), dict[str, tuple[int, int]]()
    else:
        blocks, anew = _blocks(made, codec, quality, progress, path)
    with atomic_writer(path, overwrite=overwrite) as file:
        for block in blocks:
            file.write(block)
    if anew:
        grows = sum(now - before for now, before in anew.values()) > 0
        parts = ", ".join(f"{part} ({now:,} bytes, it had {before:,})" for part, (now, before) in anew.items())
        log.log(logging.WARNING if grows else logging.INFO, "%s: coded anew: %s", path, parts)


def _refuse_coding(codec: str | None, quality: int | None, path: Path) -> None:
    if codec is not None or quality is not None:
        option = "quality" if codec is None else "codec"
        message = f"a clip keeps the bytes of its groups, and takes no {option}"
        raise OptionError(option, message, path=path, remedy="leave it out")


def refuse_output(path: Path, overwrite: bool) -> None:
    """Before any work: check that a scene may be written.

    Raises:
        OptionError: `output-kind`: its name does not end in .glb.
        OutputError: It may not or cannot be written.
    """
    if path.suffix.lower() != ".glb":
        message = "a scene is a .glb file"
        raise OptionError("output-kind", message, path=path, remedy=f"name it {path.with_suffix('.glb').name}")
    refuse_existing(path, overwrite)


def encode_scene(
    scene: Scene | Clip, *, codec: str | None = None, quality: int | None = None, progress: Progress | None = None
) -> bytes:
    """The whole .glb in memory; options and errors as `save`. The same bytes at any number of threads."""
    if isinstance(scene, Clip):
        return b"".join(clip_blocks(scene, None))
    return b"".join(_blocks(scene, codec, quality, progress, None)[0])


def _blocks(
    scene: Scene, codec: str | None, quality: int | None, progress: Progress | None, path: Path | None
) -> tuple[Iterable[bytes | memoryview], dict[str, tuple[int, int]]]:
    """The pieces of the file; and of each part that was coded anew since it has changed, its bytes now and before."""
    if codec is None and quality is not None:
        codec = DEFAULT_CODEC
    check_codec(codec or DEFAULT_CODEC, quality)
    check_writable(scene, path)
    cached = cached_payloads(scene)
    coded = code_pictures(scene, cached, codec, DEFAULT_AVIF_QUALITY if quality is None else quality, progress)
    buffer = Buffer(packed=[] if _packs(scene, cached) else None)
    gltf = _gltf(scene, buffer, coded, cached)
    text = json_bytes(gltf)
    if len(text) > limits.MAX_JSON:
        message = f"{len(text)} bytes of JSON, {limits.MAX_JSON} are allowed"
        raise OutputError("scene-limit", message, path=path, remedy="store less in it")
    binary = b"".join(buffer.parts)
    blocks = glb_blocks(text, binary, path)
    check_readable(text, binary)
    sizes = _plain_sizes(scene) | (coded.sizes if codec is None else {})
    anew = {part: (sizes[part], before) for part, before in cached.lost.items() if part in sizes}
    return blocks, anew


def _packs(scene: Scene, cached: CachedPayloads) -> bool:
    """Whether the extension is packed: mesh, cameras and weights are coded, so that all else is in it, too."""
    bases = [(p, b) for p, plane in enumerate(scene.appearance.planes) for b in range(len(plane.bases))]
    coded = ["mesh", "cameras", *(f"planes[{p}].bases[{b}].weights" for p, b in bases)]
    return all(cached.one(part) is not None for part in coded)


def check_readable(text: bytes, binary: bytes) -> None:
    """Check that `load` takes what is written: a scene put together by hand may be anything.

    Raises:
        FormatError: That of `load`.
    """
    source = HeldBytes(binary)
    written = Glb(strict_json.parse(text, "byte 20"), source, {BINARY_CHUNK: ByteRange(source, 0, len(binary))})
    read_layout(unpacked_document(written), Findings(strict=True))


def _plain_sizes(scene: Scene) -> dict[str, int]:
    """Bytes of the parts that are not pictures, as plain numbers."""
    mesh = scene.proxy.mesh
    assert mesh.uv is not None
    corner = 2 if index_type(mesh, False) == UINT16 else 4
    return {
        "mesh": 4 * (mesh.vertices.size + mesh.uv.size) + corner * mesh.faces.size,
        "cameras": 4 * (5 + 12) * len(scene.rig.cameras),
        **{
            f"planes[{p}].bases[{b}].weights": 4 * basis.weights.size
            for p, plane in enumerate(scene.appearance.planes)
            for b, basis in enumerate(plane.bases)
        },
    }


def _gltf(scene: Scene, buffer: Buffer, coded: ScenePictures, cached: CachedPayloads) -> dict[str, Any]:
    """The JSON, while `buffer` fills: mesh, opacity, mean, weights, calibration, textures; if packed, all accessors
    first."""
    mesh, poses = cached.one("mesh"), cached.one("cameras")
    shown: tuple[Mesh, Payload] | None = (scene.proxy.mesh, coded.preview or coded.planes[0].mean)
    if mesh is not None:
        shown = make_fallback(scene, shown_mean(scene), coded.bytes + len(mesh.data))
    drawn = {} if shown is None else write_drawn(scene, *shown, buffer, mesh is not None)
    plain = buffer.packed is None
    order = {} if plain or scene.residual is None else _frame_order(scene.residual, buffer)
    cameras = {} if plain else write_cameras(scene, buffer, poses)
    proxy = {} if mesh is None else {"mesh": write_stream(mesh, "mesh", buffer)}
    if scene.proxy.sheets is not None and coded.opacity is not None:
        proxy["sheets"] = _sheets(scene.proxy.sheets, coded.opacity, buffer)
    planes = []
    for index, (plane, coding) in enumerate(zip(scene.appearance.planes, coded.planes, strict=True)):
        weights = [cached.one(f"planes[{index}].bases[{b}].weights") for b in range(len(plane.bases))]
        planes.append(
            _plane(plane, coding, weights, buffer, inline=index > 0 or mesh is not None or coded.preview is not None)
        )
    cameras = cameras or write_cameras(scene, buffer, poses)
    view_plane = write_view_plane(scene, buffer, poses is not None)
    entries = _by_gain_per_byte(scene, coded, planes)
    codecs = buffer.codecs | {("textures", picture.codec) for _, picture in entries}
    needs = _needs(scene, coded, {codec for _, codec in codecs}, cameras, planes, bool(drawn))
    version = _version(scene, needs, any(codec_entry(codec, place) for place, codec in codecs))
    extension: dict[str, Any] = {"needs": needs, **proxy, "planes": planes, **write_rest(scene, cameras, view_plane)}
    for entry, picture in entries:  # last: a file that is still arriving can be drawn
        entry["bufferView"] = buffer.stream(picture, "textures")
    if scene.residual is not None:  # behind all that any view is drawn of: a file that is cut off there loses it alone
        order = _frame_order(scene.residual, buffer) if plain else order
        extension["residual"] = _residual(scene.residual, buffer) | order
    return write_root(scene, version, extension, drawn, buffer)


def _by_gain_per_byte(
    scene: Scene, coded: ScenePictures, planes: list[dict[str, Any]]
) -> list[tuple[dict[str, Any], PicturePayload]]:
    """The entries of all pictures of eigen textures and their files, sorted by the squared error of R, G and B that
    they take off for a byte; those of one basis in their order."""
    queues, to_rgb = [], scene.appearance.to_rgb
    slices = scene.appearance.channel_slices
    for plane, channels, coding, shown in zip(scene.appearance.planes, slices, coded.planes, planes, strict=True):
        matrix = np.eye(plane.mean.shape[2]) if to_rgb is None else to_rgb[:, channels]
        share = np.square(matrix, dtype=np.float64).sum(axis=0)
        for basis, files, entry in zip(plane.bases, coding.bases, shown["bases"], strict=True):
            energy = np.square(basis.weights, dtype=np.float64).mean(axis=0) / float(np.prod(basis.size))
            gains, at = [], 0
            for file in files:
                part = basis.values(at, at + file.count)
                each = np.einsum("nhwc,nhwc,c->n", part, part, share.astype(np.float32))
                gains.append(float(each @ energy[at : at + file.count]) / len(file.data))
                at += file.count
            queues.append(list(zip(gains, entry["textures"], files, strict=True)))
    found = []
    while any(queues):
        _, entry, file = max((queue for queue in queues if queue), key=lambda queue: queue[0][0]).pop(0)
        found.append((entry, file))
    return found


def _version(scene: Scene, needs: Sequence[str], named: bool) -> str:
    """The first version of the format with all that the file uses. named: whether a stream names its codec."""
    found = {FEATURES[need] for need in needs} | {"1.7" if named else "1.0"}
    if scene.appearance.colours is not None:
        found.add("1.11" if scene.appearance.mixed_colours else "1.1")
    if scene.residual is not None:
        found |= {CODECS[scene.residual.codec].since, "1.5" if scene.residual.smooth_edges else "1.0"}
    return max(found, key=minor)


def _sheets(sheets: Sheets, opacity: PicturePayload, buffer: Buffer) -> dict[str, Any]:
    height, width = sheets.opacity.shape
    picture = {"bufferView": buffer.stream(opacity, "opacity"), "size": [width, height], **_picture(opacity, "opacity")}
    return {"faces": list(map(int, sheets.faces)), "opacity": picture}


def _plane(
    plane: Plane, coded: PlanePictures, weights: Sequence[Payload | None], buffer: Buffer, *, inline: bool
) -> dict[str, Any]:
    """A plane's entry without the textures' buffer views; weights: of each basis, coded; inline: the mean is its own
    picture, not images[0]."""
    height, width, channels = plane.mean.shape
    fields: dict[str, Any] = {"channels": channels}
    if inline:
        mean: dict[str, Any] = {"bufferView": buffer.stream(coded.mean, "mean"), "size": [width, height]}
        fields["mean"] = mean | _picture(coded.mean, "mean")
        if coded.mean.precision is not None:
            fields["mean"]["precision"] = _precision(coded.mean.precision, buffer)
    fields["bases"] = []
    for basis, files, stream in zip(plane.bases, coded.bases, weights, strict=True):
        entry: dict[str, Any] = {"size": [basis.textures.shape[2], basis.textures.shape[1]]}
        if basis.grid is not None:
            entry |= {"grid": [basis.grid[1], basis.grid[0]], "corner": [basis.corner[1], basis.corner[0]]}
        if stream is not None:
            entry["codedWeights"] = write_stream(stream, "weights", buffer)
        elif basis.count:
            entry["weights"] = buffer.accessor(basis.weights.ravel(), FLOAT, "SCALAR")
        entry |= _textures([_picture(file, "textures") for file in files])
        fields["bases"].append(entry)
    return fields


def _precision(picture: Payload, buffer: Buffer) -> dict[str, Any]:
    size = list(dimensions(memoryview(picture.data), picture.codec, "precision"))
    entry = {"bufferView": buffer.shared_stream(picture, "precision"), "size": size}
    return entry | codec_entry(picture.codec, "precision")


def _textures(entries: list[dict[str, Any]]) -> dict[str, Any]:
    """Entries of pictures, common members once if a picture has several textures; the buffer views come later."""
    common: dict[str, Any] = {}
    if len(entries) > 1 and any("count" in entry for entry in entries):
        common = {"count": 1} | entries[0]
        entries = [{"count": 1} | entry for entry in entries]
        common = {key: value for key, value in common.items() if all(key in entry for entry in entries)}
        entries = [{key: value for key, value in one.items() if common.get(key) != value} for one in entries]
    shared = {"picture": common} if common else {}
    return shared | {"textures": [{"bufferView": -1, **entry} for entry in entries]}


def _picture(picture: PicturePayload, place: str) -> dict[str, Any]:
    """A picture's entry without its buffer view."""
    codec = PICTURES[picture.codec]
    made: dict[str, Any] = {"mimeType": codec.mime}
    if codec.bits != 8:
        made["bits"] = codec.bits
    if picture.count != 1:
        made["count"] = picture.count
    if picture.affine is not None:
        scale, zero = picture.affine.scale, picture.affine.zero
        made |= {"scale": affine_numbers(scale, picture.count), "zero": affine_numbers(zero, picture.count)}
    return made | codec_entry(picture.codec, place)


def _residual(residual: Residual, buffer: Buffer) -> dict[str, Any]:
    made: dict[str, Any] = {"size": [residual.size[1], residual.size[0]], "scale": list(residual.scale)}
    if residual.full_chroma:
        made["full"] = True
    if residual.smooth_edges:
        made["smooth"] = True
    return made | write_stream(Payload(residual.codec, residual.video), "residual", buffer)


def _frame_order(residual: Residual, buffer: Buffer) -> dict[str, int]:
    """The order of a residual's frames, left out where it is that of the encoded cameras."""
    order, count = residual.order, len(residual.order)
    if (order == np.arange(count)).all():
        return {}
    return {"order": buffer.accessor(order, UINT16 if count < 65_536 else UINT32, "SCALAR")}


def _needs(
    scene: Scene, coded: ScenePictures, codecs: Iterable[str], cameras: Mapping[str, Any], planes: list[dict[str, Any]],
    fallback: bool,
) -> list[str]:  # fmt: skip
    """The features that a reader must know to draw this scene."""
    pictures = [file for plane in coded.planes for some in plane.bases for file in some]
    found = {
        "namePattern": "pattern" in cameras,
        "noFallback": not fallback,
        "precision": any(plane.mean.precision is not None for plane in coded.planes),
        "regions": any(basis.grid is not None for plane in scene.appearance.planes for basis in plane.bases),
        "sharedPicture": any("picture" in basis for plane in planes for basis in plane["bases"]),
        "sheets": scene.proxy.sheets is not None,
        "stacks": any(picture.count != 1 for picture in pictures),
        "toRGB": scene.appearance.to_rgb is not None,
    }
    of_codecs = {CODECS[codec].needs for codec in codecs}
    return sorted({name for name, needed in found.items() if needed} | {need for need in of_codecs if need is not None})
