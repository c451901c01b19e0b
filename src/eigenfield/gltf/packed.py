"""The root extension in few bytes: its JSON deflated with a preset dictionary, and its streams one behind the other.

Of a file of 12 kB the plain JSON takes 3 kB. Unpacked it reads as the JSON of a plain file: the buffer view that holds
all of it gives way to those of the streams.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError, OutputError
from eigenfield.gltf import strict_json
from eigenfield.gltf.buffer import Buffer
from eigenfield.gltf.container import Glb, Pieces, glb_blocks, json_bytes
from eigenfield.gltf.deflate import deflate, inflate
from eigenfield.gltf.document import BufferView, Document
from eigenfield.gltf.strict_json import Value

FEATURE = "packed"  # in `needs`
HEAD = struct.Struct("<I")  # bytes of the deflated JSON, which follows
# What the JSON of a fitted file says: it costs next to nothing there. Part of the format, docs/format.md prints it
DICTIONARY = (
    b'"names":["texts":["heldOut":[1,2,"lenses":[null,"harmonise":"gain","affine",'
    b'"align":true,"residual":{"quality":40},"metresPerUnit":0.'
    b'"sharedPicture","times","codec":"codedNames":{"bufferView":10,"count":20},"sizes":3,"colour":4,"times":[0,'
    b'"residual":{"size":[512,512],"scale":[0.00,0.00],"full":true,"smooth":true,"order":3,"holdOut":"odd","every:'
    b'"scores":{"psnr":{"mean":"ssim":{"mean":"captured":"heldOut":'
    b'{"needs":["av1-10bit-2","cameras-2","codedNames","codedTriangles","codedWeights","mesh-2","namePattern",'
    b'"precision","regions","stacks","toRGB"],"mesh":{"bufferView":5,"codec":"mesh-2"},'
    b'"planes":[{"channels":1,"mean":{"bufferView":6,"size":[1024,768],"mimeType":"video/AV1","bits":10,'
    b'"scale":[0.0009775171065493646],"zero":[0],"precision":{"bufferView":7,"size":[13,12]}},'
    b'"bases":[{"size":[480,480],"codedWeights":8,"textures":[{"bufferView":11,"mimeType":"video/AV1","bits":10,"count":2,'
    b'"scale":[0.0001],"zero":[341]}]},{"size":[64,464],"grid":[464,464],"corner":[0,0],"codedWeights":9,'
    b'"picture":{"mimeType":"video/AV1","bits":10,"count":8,"scale":[0.0002],"zero":[341]},'
    b'"textures":[{"bufferView":12},{"bufferView":13}]}]},'
    b'{"channels":2,"mean":{"bufferView":9,"size":[512,384],"mimeType":"video/AV1","bits":10,'
    b'"scale":[0.0004,0.0004],"zero":[341,341],"precision":{"bufferView":7,"size":[13,12]}},"bases":[]}],'
    b'"toRGB":[1,-0.027444022,-0.9585462,1,-0.092323445,0.284937,1,0.9953508,0],'
    b'"cameras":{"pattern":{"counts":[81,1],"parts":["image_",{"axis":0,"first":0,"step":1,"digits":3},'
    b'".png",".jpg",".webp"]},"size":[640,480],"coded":{"bufferView":4,"codec":"cameras-2"}},'
    b'"viewPlane":{"origin":[0,0,0],"right":[1,0,0],"up":[0,-1,0],"extent":[0.5,0.5],"codedTriangles":10},"reference":40,'
    b'"settings":{"textures":2,"atlas":[1024,768],"density":1.3,"fit":"photographs",'
    b'"fitted":{"quality":78,"psnr":{"luma":{"uncoded":50.0,"coded":40.0},"chroma":{"uncoded":50.0,"coded":40.0}}},'
    b'"photographs":{"count":81,"bytes":10000000,"pixels":10000000}},"generator":"eigenfield 0.1.0","lengths":['
)


def pack(extension: Mapping[str, Any], streams: Sequence[bytes]) -> bytes:
    """The bytes of the buffer view that `packed` names: this part of the root extension, and its streams. OutputError
    `scene-limit`, more JSON than is read."""
    text = json_bytes({**extension, "lengths": list(map(len, streams))}).rstrip(b" ")
    if len(text) > limits.MAX_JSON:
        message = f"{len(text)} bytes of JSON, {limits.MAX_JSON} are allowed"
        raise OutputError("scene-limit", message, remedy="store less in it")
    head = deflate(text, DICTIONARY)
    return b"".join([HEAD.pack(len(head)), head, *streams])


def write(extension: Mapping[str, Any], buffer: Buffer) -> int:
    """Append the packed extension with the streams of the buffer; the index of its buffer view."""
    assert buffer.packed is not None
    data = pack(extension, buffer.packed)
    buffer.packed = []
    return buffer.view(data)


def unpack(glb: Glb) -> Glb:
    """The container with the JSON that a plain file would have, over the same binary chunk; itself if it is plain.
    FormatError `json-*`, `view-*`, `truncated`, `coded-size`, `coded-damaged`."""
    if not is_packed(glb):
        return glb
    index = _index(glb)
    extension, streams = _read(glb, index)
    views = [*glb.json["bufferViews"][:-1]]
    views += [{"buffer": 0, "byteOffset": one.offset, "byteLength": one.length} for one in streams]
    kept = {key: value for key, value in glb.json["extensions"][limits.EXTENSION].items() if key != FEATURE}
    if len(views) > limits.MAX_VIEWS:
        raise FormatError("json-value", f"{len(views)} buffer views, {limits.MAX_VIEWS} are allowed", where=_WHERE)
    extensions = {**glb.json["extensions"], limits.EXTENSION: kept | extension}
    return replace(glb, json={**glb.json, "bufferViews": views, "extensions": extensions})


def repack(
    glb: Glb, extension: Mapping[str, Any], behind: Pieces | None, *, residual: bool = True
) -> Iterator[bytes | memoryview]:
    """The blocks of a packed container's file with another extension.

    Args:
        extension: That of the unpacked container, changed.
        behind: Whole chunks that follow the binary one; None: nothing does.
        residual: Whether the last stream stays.
    """
    index = _index(glb)
    streams = _read(glb, index)[1]
    plain = glb.json["extensions"][limits.EXTENSION]
    inner = {key: value for key, value in extension.items() if key != "version"}
    kept = [bytes(glb.binary.data[one.offset : one.end]) for one in (streams if residual else streams[:-1])]
    start, data = Document(glb).view_at(index).offset, pack(inner, kept)
    views = [*glb.json["bufferViews"][:-1], {**glb.json["bufferViews"][-1], "byteLength": len(data)}]
    data += bytes(-(start + len(data)) % 4)  # as `Buffer` ends
    made = {**glb.json, "bufferViews": views, "buffers": [{"byteLength": start + len(data)}]}
    made["extensions"] = {**made["extensions"], limits.EXTENSION: plain}
    return glb_blocks(json_bytes(made), bytes(glb.binary.data[:start]) + data, behind=behind)


_WHERE = f"/extensions/{limits.EXTENSION}/{FEATURE}"


def is_packed(glb: Glb) -> bool:
    """Whether a container has a packed extension."""
    extensions = glb.json.get("extensions") if isinstance(glb.json, dict) else None
    extension = extensions.get(limits.EXTENSION) if isinstance(extensions, dict) else None
    return isinstance(extension, dict) and FEATURE in extension


def _index(glb: Glb) -> int:
    """The buffer view that `packed` names: the last."""
    document = Document(glb)
    document.check_buffer()
    last = len(list(document.root["bufferViews"].items(limits.MAX_VIEWS, 1))) - 1
    return document.root["extensions"][limits.EXTENSION][FEATURE].integer(last, last)


def _read(glb: Glb, index: int) -> tuple[dict[str, Any], list[BufferView]]:
    """The packed part of the extension, and where its streams lie."""
    view, available = Document(glb).view_at(index), glb.binary.size
    start = view.offset + HEAD.size
    if start > view.end:
        raise FormatError("coded-size", f"{view.length} bytes have no length", where=_WHERE)
    if start > available:
        raise glb.cut_off()
    end = start + HEAD.unpack(glb.binary.data[view.offset : start])[0]
    if end > view.end:
        raise FormatError("coded-size", f"the JSON ends at byte {end} of {view.end}", where=_WHERE)
    if end > available:
        raise glb.cut_off()
    text = inflate(glb.binary.data[start:end], limits.MAX_JSON, _WHERE, DICTIONARY)
    inner = Value(strict_json.parse(text, _WHERE), _WHERE)
    streams: list[BufferView] = []
    at = end
    for item in inner["lengths"].items(limits.MAX_VIEWS):
        length = item.integer(1, limits.MAX_FILE)
        streams.append(BufferView(index + len(streams), at, length, 0))
        at += length
    if at != view.end:
        raise FormatError("coded-size", f"the streams end at byte {at}, not at {view.end}", where=_WHERE)
    return {key: value for key, value in inner.mapping().items() if key != "lengths"}, streams
