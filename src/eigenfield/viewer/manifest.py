"""What the viewer's server answers: a fixed table of paths. No path is ever joined to a folder."""

from __future__ import annotations

import gzip
import hashlib
import json
import secrets
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from eigenfield.core.version import __version__
from eigenfield.gltf.source import ByteSource, HeldBytes
from eigenfield.viewer.page import Beside, page_html, static_file
from eigenfield.viewer.photographs import Photographs

SECOND_FILE = "second.glb"
SCENE_TYPE = "model/gltf-binary"
BYTES_TYPE = "application/octet-stream"
JAVASCRIPT_TYPE = "text/javascript; charset=utf-8"
STATIC_TYPES = {
    "viewer.js": JAVASCRIPT_TYPE,
    "eigenfield-three.js": JAVASCRIPT_TYPE,
    "viewer.css": "text/css; charset=utf-8",
}


@dataclass(frozen=True, eq=False)
class Content:
    """What a path is answered with.

    Attributes:
        data: In memory, or in a file that is read for each answer.
        tag: The strong ETag, quotes included.
        gzip: The same for clients that unpack gzip, with an ETag of its own; None: as it is for all.
    """

    type: str
    data: ByteSource
    tag: str
    gzip: Content | None = None

    @staticmethod
    def of(type: str, data: bytes) -> Content:
        """Bytes with their ETag."""
        return Content(type, HeldBytes(data), f'"{hashlib.sha256(data).hexdigest()[:32]}"')

    @staticmethod
    def of_text(type: str, data: bytes) -> Content:
        """Bytes that become much less when they are packed."""
        return replace(Content.of(type, data), gzip=Content.of(type, gzip.compress(data, mtime=0)))


Manifest = Mapping[str, Callable[[], Content]]


def make_manifest(
    glb: bytes | ByteSource,
    title: str,
    photographs: Photographs | None = None,
    metres_per_unit: float | None = None,
    seconds_left: Callable[[], float | None] | None = None,
    beside: Mapping[str, ByteSource] | None = None,
    second: Beside | None = None,
) -> Manifest:
    """The page, its files, the scene, and a picture for each photograph: path to what makes the content.

    All but photographs and clips is held in memory, so that files replaced on disk never mix with those that were
    checked. Of a clip, whose groups have digests, the page finds that out by itself.

    Args:
        glb: The scene's file: its bytes, or where they are.
        metres_per_unit: Metres in one unit of the capture, for headsets.
        seconds_left: The scene is a draft: about when the whole scene takes its place, None where that is not known.
            The page asks for it, and opens anew where there is no such answer any longer.
        beside: Files of a clip beside its own, by name.
        second: A scene to compare with.

    Raises:
        OutputError: `viewer-build`: the page was not built.
    """
    scene = Content.of(SCENE_TYPE, glb) if isinstance(glb, bytes) else Content(SCENE_TYPE, glb, _own_tag())
    config: dict[str, object] = {"title": title, "scene": "scene.glb", "bytes": scene.data.size, "version": __version__}
    if metres_per_unit is not None:
        config["metresPerUnit"] = metres_per_unit
    if photographs is not None:
        config["photographs"] = {name: f"photographs/{index}" for index, name in photographs.names.items()}
    if seconds_left is not None:
        config["draft"] = "draft"
    if second is not None:
        config["beside"] = {"names": second.names, "scene": SECOND_FILE, "bytes": len(second.glb)}
    fixed = {f"/{name}": Content.of_text(type, static_file(name)) for name, type in STATIC_TYPES.items()}
    fixed["/"] = Content.of_text("text/html; charset=utf-8", page_html(config))
    fixed["/scene.glb"] = scene
    if second is not None:
        fixed[f"/{SECOND_FILE}"] = Content.of(SCENE_TYPE, second.glb)
    fixed |= {f"/{name}": Content(BYTES_TYPE, data, _own_tag()) for name, data in (beside or {}).items()}
    manifest: dict[str, Callable[[], Content]] = {path: _answer_fixed(content) for path, content in fixed.items()}
    if seconds_left is not None:
        manifest["/draft"] = _answer_seconds(seconds_left)
    if photographs is not None:
        for index in photographs.names:
            manifest[f"/photographs/{index}"] = _answer_photograph(photographs, index)
    return manifest


def _own_tag() -> str:
    """An ETag of this server alone."""
    return f'"{secrets.token_hex(16)}"'


def _answer_fixed(content: Content) -> Callable[[], Content]:
    return lambda: content


def _answer_photograph(photographs: Photographs, index: int) -> Callable[[], Content]:
    return lambda: Content.of("image/png", photographs.png(index))


def _answer_seconds(seconds_left: Callable[[], float | None]) -> Callable[[], Content]:
    return lambda: Content.of("application/json", json.dumps({"seconds": seconds_left()}).encode())
