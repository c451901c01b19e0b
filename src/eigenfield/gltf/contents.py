"""What a file consists of, and its scores: read and rewritten without touching a picture."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import Any

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError
from eigenfield.gltf.container import BINARY_CHUNK, JSON_CHUNK, Glb, file_head, glb_blocks, json_bytes, parse_glb
from eigenfield.gltf.document import Document
from eigenfield.gltf.group import GroupHead
from eigenfield.gltf.layout import FileLayout, find_extension, unpacked_document
from eigenfield.gltf.packed import is_packed, repack
from eigenfield.gltf.read import layout_of, read_scene
from eigenfield.gltf.read_clip import ClipLayout, clip_layout_of, read_heads, stores_clip
from eigenfield.gltf.source import name_file_in_errors, open_source, scene_file
from eigenfield.gltf.streams import streams
from eigenfield.gltf.strict_json import Value
from eigenfield.gltf.write import encode_scene
from eigenfield.runtime.files import atomic_writer
from eigenfield.runtime.objects import find_objects

PARTS = ("mean", "textures", "weights", "mesh", "opacity", "residual")  # that `parts` lists, beside `total` and `other`


def describe(path: str | os.PathLike[str]) -> tuple[FileLayout, dict[str, int]]:
    """The checked layout of a file and its bytes by part (see `parts`). FormatError as `load`."""
    with name_file_in_errors(path), open_source(Path(path)) as source:
        document, layout = layout_of(source)
        return layout, _parts(document)


def parts(path: str | os.PathLike[str]) -> dict[str, int]:
    """Bytes by part: total, mean, textures, weights, mesh, opacity, residual, other; the last seven sum to the first.

    Of a clip they are those of all groups that are whole.

    mean: the means, and the picture for other viewers (`images[0]`).
    mesh: positions, texture coordinates, indices; a coded one, its motion, and the coarse one for other viewers.
    opacity: of sheets; 0 where there is none.
    residual: of captured views; 0 where there is none.
    other: JSON, calibration, triangles, headers and padding."""
    return describe_clip(path)[2] if stores_clip(path) else describe(path)[1]


def describe_clip(path: str | os.PathLike[str]) -> tuple[ClipLayout, list[GroupHead], dict[str, int]]:
    """The checked layout of a clip's file, the heads of its groups that are whole, and its bytes by part (see `parts`).
    FormatError as `load_clip`."""
    with name_file_in_errors(path), open_source(Path(path)) as source:
        document, layout = clip_layout_of(source)
        heads = read_heads(layout, source, Path(path))
        made = _parts(document)
        assert layout.films is not None and layout.groups is not None
        if layout.first is None:
            made["total"] += sum(one.length for one in (*layout.groups, layout.audio) if one is not None)
        names = dict.fromkeys(range(len(layout.films.sizes)), "textures")
        names |= {} if layout.films.opacity is None else {layout.films.opacity.film: "opacity"}
        names |= {plane.mean.film: "mean" for plane in layout.films.planes}
        for head in heads:
            made["weights"] += sum(map(sum, head.weights))
            made["mesh"] += head.mesh + head.motion
            for units in head.frames:
                for film, length in enumerate(units):
                    made[names[film]] += length
        made["other"] = made["total"] - sum(made[name] for name in PARTS)
        return layout, heads, made


def _parts(document: Document) -> dict[str, int]:
    root = document.root
    extension = root["extensions"][limits.EXTENSION]
    found: dict[str, list[Value]] = {name: [] for name in PARTS}
    found["mean"] += [root["images"].at(0)["bufferView"]] if root.has("images") else []
    if root.has("meshes"):
        primitive = root["meshes"].at(0)["primitives"].at(0)
        attributes = [*(primitive["attributes"][key] for key in ("POSITION", "TEXCOORD_0")), primitive["indices"]]
        found["mesh"] += [_view_of(document, reference) for reference in attributes]
    for plane in extension["planes"].items(limits.MAX_PLANES):
        for basis in plane["bases"].items(limits.MAX_BASES):
            found["weights"] += [_view_of(document, basis["weights"])] if basis.has("weights") else []
    for place, reference in streams(extension):
        if place.part in found and not document.cut_off(reference):
            found[place.part].append(reference)
    counted: set[int] = set()
    sizes = {"total": document.glb.source.size}
    for name, references in found.items():
        views = {view.index: view.length for view in map(document.view, references) if view.index not in counted}
        counted |= views.keys()
        sizes[name] = sum(views.values())
    sizes["other"] = sizes["total"] - sum(sizes[name] for name in found)
    return sizes


def _view_of(document: Document, accessor: Value) -> Value:
    return document.root["accessors"].at(accessor.integer(0, 2**31))["bufferView"]


def without_residual(data: bytes) -> bytes:
    """A file for viewers, without its residual, of which they show nothing.

    The bytes are the same where it has none, or where it is not the last thing in the binary chunk. A file that is cut
    off becomes a whole one of what is left.
    """
    glb = parse_glb(data)
    if glb.missing:
        return encode_scene(replace(read_scene(data), residual=None))
    document = unpacked_document(glb)
    if is_packed(glb):
        kept = dict(document.glb.json["extensions"][limits.EXTENSION])
        last = {"bufferView": len(document.glb.json["bufferViews"]) - 1}
        is_last = last.items() <= kept.pop("residual", {}).items()
        return b"".join(repack(glb, kept, glb.behind(BINARY_CHUNK), residual=False)) if is_last else data
    views, accessors = list(glb.json["bufferViews"]), list(glb.json.get("accessors", []))
    extension = dict(glb.json["extensions"][limits.EXTENSION])
    residual = extension.pop("residual", None)
    if residual is None:
        return data
    end = document.view_at(len(views) - 1).offset
    if residual["bufferView"] != len(views) - 1 or any(document.view_at(i).end > end for i in range(len(views) - 1)):
        return data
    del views[-1]
    if residual.get("order") == len(accessors) - 1 and accessors[-1]["bufferView"] == len(views) - 1:
        end = document.view_at(len(views) - 1).offset
        del views[-1], accessors[-1]
    gltf = {**glb.json, "bufferViews": views, "accessors": accessors, "buffers": [{"byteLength": end}]}
    gltf["extensions"] = {**gltf["extensions"], limits.EXTENSION: extension}
    return b"".join(glb_blocks(json_bytes(gltf), bytes(glb.binary.data[:end]), behind=glb.behind(BINARY_CHUNK)))


def store_scores(path: str | os.PathLike[str], scores: Mapping[str, Any]) -> None:
    """Replace a file's `scores` by a JSON object; everything else, unknown keys too, stays as it is.

    Only the JSON chunk is written anew: textures keep their bytes, and so do chunks behind the binary one. Atomic.

    Raises:
        OutputError: The file cannot be written.
    """
    target = Path(scene_file(path))
    target = target if find_objects(target) else Path(os.path.realpath(target))  # a link stays a link
    with name_file_in_errors(path), contextlib.ExitStack() as opened:
        source = opened.enter_context(open_source(target))
        glb = parse_glb(source)
        if glb.missing:
            raise glb.cut_off()
        extension = find_extension(unpacked_document(glb)).mapping()
        blocks = _with_scores(glb, {**extension, "scores": dict(scores)}, path)
        with atomic_writer(target, overwrite=True) as file:
            for block in blocks:
                file.write(block)
            opened.close()  # Windows replaces no file that is open


def _with_scores(glb: Glb, extension: Mapping[str, Any], path: str | os.PathLike[str]) -> Iterable[bytes | memoryview]:
    """The blocks of the file with another extension, which is that of the unpacked container."""
    if is_packed(glb):
        return repack(glb, extension, glb.behind(BINARY_CHUNK))
    glb.json["extensions"][limits.EXTENSION]["scores"] = extension["scores"]
    text, rest = json_bytes(glb.json), glb.behind(JSON_CHUNK)
    if len(text) > limits.MAX_JSON:
        raise FormatError("json-size", f"the scores make {len(text)} bytes of JSON", where="/extensions", path=path)
    return chain([file_head(text, rest.size, path)], rest.pieces())
