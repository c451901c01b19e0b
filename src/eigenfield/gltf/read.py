"""GLB to scene: `load` refuses a file at its first error, `validate` lists them all; both run the same checks."""

from __future__ import annotations

import contextlib
import logging
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from eigenfield.coding.pictures.quantise import mean_values, spread_precision
from eigenfield.core.appearance import Appearance, Basis, Plane
from eigenfield.core.arguments import checked
from eigenfield.core.clip import Clip
from eigenfield.core.errors import FormatError, OptionError
from eigenfield.core.payloads import (
    Coded,
    Payload,
    Payloads,
    mean_key,
    opacity_key,
    payloads_of,
    preview_key,
)
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.core.scene import Scene
from eigenfield.gltf.check_root import check_other_viewers
from eigenfield.gltf.document import Document
from eigenfield.gltf.findings import Finding, Findings
from eigenfield.gltf.layout import FileLayout, find_extension, is_clip, open_document, read_layout
from eigenfield.gltf.layout_planes import BasisLayout, PlaneLayout, read_image
from eigenfield.gltf.layout_residual import residual_frames
from eigenfield.gltf.read_clip import check_clip, holds_clip, load_clip, read_clip, stores_clip
from eigenfield.gltf.source import ByteSource, HeldBytes, name_file_in_errors, open_source, read_file
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.format")


def layout_of(data: bytes | ByteSource) -> tuple[Document, FileLayout]:
    """Container and checked layout of a file of these bytes, pictures not decoded."""
    document = open_document(data)
    layout = read_layout(document, Findings(strict=True))
    assert layout is not None
    return document, layout


@checked
def load(path: str | os.PathLike[str], time: float | None = None) -> Scene:
    """Read a scene: float32 means, uint8 or uint16 textures with their scale and zero, and their payloads.

    Limits are checked before memory is taken.

    Args:
        path: Of a .glb, or of a folder with `scene.glb`.
        time: Seconds, of a clip, of which the nearest frame is read. A file of one instant needs none.

    Raises:
        OptionError: `time`, outside the clip.
        FormatError: With a stable `code`, and `where`, for anything that is not as docs/format.md specifies; the
            content of a file never raises another exception.
    """
    with name_file_in_errors(path), open_source(Path(path)) as source:
        if time is None or not holds_clip(source):
            return read_scene(source)
        try:
            return read_clip(source, path).scene(time)
        except OptionError as error:
            error.path = os.fspath(path)
            raise


def load_any(path: str | os.PathLike[str]) -> Scene | Clip:
    """What a file holds, as `load` or `load_clip` read it."""
    return load_clip(path) if stores_clip(path) else load(path)


def as_scene(scene: Scene | Clip | str | os.PathLike[str], time: float | None = None) -> Scene:
    """The scene itself, the frame of a clip at a time in seconds, or what `load` reads from a file, with its errors.
    OptionError `time`: a clip without a time."""
    if isinstance(scene, Clip):
        if time is None:
            times = scene.timeline.times
            remedy = f"give {times[0]:g} to {times[-1]:g} seconds"
            raise OptionError("time", "a clip is drawn at a time, and none is given", remedy=remedy)
        return scene.scene(time)
    return scene if isinstance(scene, Scene) else load(scene, time)


def read_scene(data: bytes | ByteSource) -> Scene:
    """The scene in a file of these bytes, with the errors of `load`."""
    return _scene_of(data, pictures=True)


def outline(path: str | os.PathLike[str]) -> tuple[Scene, bytes]:
    """A scene without its planes and sheets, and the bytes of its file: checked as `load` does, but no picture is
    decoded. Of a clip it is the first frame."""
    with name_file_in_errors(path):
        data = read_file(Path(path))
        if holds_clip(HeldBytes(data)):
            clip = read_clip(HeldBytes(data))
            scene = clip.scene(clip.timeline.first)
            bare = Appearance((), scene.appearance.to_rgb)
            return replace(scene, proxy=Proxy(scene.proxy.mesh), appearance=bare, scores=clip.scores), data
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
    scene = _scene(layout, planes, sheets, _preview(document, layout))
    return replace(scene, cut_off=True) if layout.lost or document.glb.missing else scene


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
    mesh, given = layout.mesh, layout.cameras
    assert mesh is not None and given is not None
    payloads = Payloads.merge(plane.payloads for plane in planes) | layout.payloads
    if sheets is not None:
        payloads |= sheets.payloads
    if planes and preview is not None and layout.mesh_payload is None:
        sources = [next(key for key in plane.payloads if key[0] == "mean") for plane in planes]
        sources += [] if sheets is None else [*sheets.payloads]
        payloads |= {preview_key(sources, layout.to_rgb, given.colours is not None): [preview]}
    return Scene(
        proxy=Proxy(mesh, sheets=None if sheets is None else sheets.value),
        rig=layout.rig,
        appearance=Appearance(
            tuple(plane.value for plane in planes), layout.to_rgb, given.colours, given.mixed_colours
        ),
        settings=layout.settings,
        scores=layout.scores,
        generator=layout.generator,
        residual=layout.residual,
        payloads=payloads,
        rights=layout.rights,
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

    It reads and decodes everything that `load` would, one picture at a time, of a clip each frame of each group. It
    checks what `load` does not need, too: the picture and the nodes for other viewers, buffer views without use. The
    content of a file never raises.
    """
    findings = Findings(strict=False)
    with findings.part(), name_file_in_errors(path), open_source(Path(path)) as source:
        document = open_document(source)
        if is_clip(find_extension(document)):
            found = check_clip(document, findings, Path(path))
        else:
            found = _check_scene(document, findings)
        if found:
            check_other_viewers(document, findings)
    return findings.found


def _check_scene(document: Document, findings: Findings) -> bool:
    """Check a scene as a whole; whether the file holds one."""
    layout = read_layout(document, findings)
    if layout is not None:
        _check_pictures(layout, findings)
        _check_residual(layout, findings)
    return layout is not None


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
