"""The places of coded streams in the JSON, and the default codec of each."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from eigenfield.coding import limits
from eigenfield.coding.codecs import CODECS
from eigenfield.coding.stacking import PICTURES, codec_of
from eigenfield.core.errors import FormatError
from eigenfield.core.payloads import Payload
from eigenfield.gltf.document import Document
from eigenfield.gltf.strict_json import Value, quote


@dataclass(frozen=True)
class Place:
    """A place in the extension where a stream stands: an object with a `bufferView`.

    Attributes:
        path: From the extension, `*` for every entry of an array.
        codec: Unless the object has a `codec`; None: by the `mimeType` and the `bits` of a picture.
        part: The part of the file that its bytes count to (`contents.parts`).
        bare: Whether the index of the buffer view may stand there alone.
    """

    path: str
    kind: str
    codec: str | None
    part: str
    bare: bool = False


PLACES = {
    "mesh": Place("mesh", "mesh", "mesh-1", "mesh"),
    "cameras": Place("cameras/coded", "cameras", "cameras-1", "other", bare=True),
    "colours": Place("cameras/codedColour", "weights", "weights-1", "other", bare=True),
    "names": Place("cameras/codedNames", "names", "names-1", "other"),
    "triangles": Place("viewPlane/codedTriangles", "triangles", "triangles-1", "other", bare=True),
    "mean": Place("planes/*/mean", "picture", None, "mean"),
    "opacity": Place("sheets/opacity", "picture", None, "opacity"),
    "precision": Place("planes/*/mean/precision", "picture", "png", "mean"),
    "textures": Place("planes/*/bases/*/textures/*", "picture", None, "textures"),
    "weights": Place("planes/*/bases/*/codedWeights", "weights", "weights-1", "weights", bare=True),
    "residual": Place("residual", "video", "video-1", "residual"),
}
OTHER_FEATURES = {  # what `needs` may name beside the needs of codecs, and the version that brought it
    "groupFiles": "1.11", "namePattern": "1.2", "noFallback": "1.10", "packed": "1.8", "precision": "1.4",
    "regions": "1.2", "sharedPicture": "1.2", "sheets": "1.9", "stacks": "1.2", "timeline": "1.11", "toRGB": "1.2",
}  # fmt: skip
FEATURES = OTHER_FEATURES | {codec.needs: codec.since for codec in CODECS.values() if codec.needs is not None}


def minor(version: str) -> int:
    """x of version 1.x."""
    return int(version.removeprefix("1."))


LATEST = max(map(minor, [limits.VERSION, *(codec.since for codec in CODECS.values())]))  # that is known here


def codec_entry(codec: str, place: str) -> dict[str, str]:
    """The JSON's member for a codec; none for the default of its place."""
    picture = PICTURES.get(codec)
    usual = PLACES[place].codec or (picture and codec_of(picture.mime, picture.bits))
    return {} if codec == usual else {"codec": codec}


def _reference(entry: Value, place: Place) -> Value:
    """The index of a stream's buffer view."""
    return entry if place.bare and isinstance(entry.value, int) else entry["bufferView"]


def codec_named(entry: Value, place: str) -> str | None:
    """The codec that a stream names, else its place's. FormatError `codec-unknown`, it is not known, or not for such
    streams."""
    if not isinstance(entry.value, dict) or not entry.has("codec"):
        return PLACES[place].codec
    name, kind = entry["codec"].text(), PLACES[place].kind
    if name not in CODECS or CODECS[name].kind != kind:
        message = f"no codec of a {kind} stream is called {quote(name)} here"
        entry["codec"].fail("codec-unknown", message, "use a later eigenfield")
    return name


def read_stream(document: Document, entry: Value, place: str) -> Payload:
    """The stream of an entry, not decoded. FormatError `codec-unknown`, `view-*`, `truncated`."""
    codec = codec_named(entry, place)
    assert codec is not None
    return Payload(codec, bytes(document.data(_reference(entry, PLACES[place]))))


def streams(extension: Value) -> Iterator[tuple[Place, Value]]:
    """Every stream of a file: its place, and the index of its buffer view. Where the JSON is not as specified there is
    none."""
    for place in PLACES.values():
        with contextlib.suppress(FormatError):
            for entry in _at(extension, place.path.split("/")):
                yield place, _reference(entry, place)


def _at(value: Value, path: Sequence[str]) -> Iterator[Value]:
    if not path:
        yield value
    elif path[0] == "*":
        for item in value.items(limits.MAX_VIEWS):
            yield from _at(item, path[1:])
    elif value.has(path[0]):
        yield from _at(value[path[0]], path[1:])
