"""The appearance in a scene file: planes, their means and bases, and the matrix from their channels to R, G, B."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits, stacking
from eigenfield.coding.codecs import CODECS
from eigenfield.coding.stacking import PICTURES, codec_of
from eigenfield.core.errors import FormatError
from eigenfield.core.payloads import Affine, Payload, PicturePayload
from eigenfield.gltf.accessors import FLOAT
from eigenfield.gltf.document import Document, all_finite
from eigenfield.gltf.findings import Findings
from eigenfield.gltf.layout_geometry import CameraList
from eigenfield.gltf.streams import codec_named, read_stream
from eigenfield.gltf.strict_json import Value, quote

PICTURE_MAX_BITS = max(codec.bits for codec in PICTURES.values())


@dataclass(frozen=True, eq=False)
class PictureLayout:
    """A picture in the file.

    Attributes:
        affine: From codes to numbers, per channel (of every texture in it); None: the largest code is 1.
        count: Textures in it, one below the other.
        precision: Of a mean, the picture of its precision place by place; None: all alike.
    """

    data: memoryview
    codec: str
    width: int
    height: int
    channels: int
    affine: Affine | None
    where: str
    count: int = 1
    precision: PictureLayout | None = None

    @property
    def mime(self) -> str:
        return PICTURES[self.codec].mime

    @property
    def bits(self) -> int:
        """Of a code."""
        return PICTURES[self.codec].bits

    @property
    def payload(self) -> PicturePayload:
        """The payload of a scene."""
        precision = None
        if self.precision is not None:
            precision = Payload(self.precision.codec, bytes(self.precision.data))
        return PicturePayload(self.codec, bytes(self.data), self.count, self.affine, precision)

    def decode(self) -> NDArray[Any]:
        """(count, height, width, channels) uint8, of 10 bits uint16. FormatError: see `stacking.decode`."""
        size = (self.width, self.height, self.channels)
        return stacking.decode(self.data, self.codec, *size, self.where, self.count)


@dataclass(frozen=True, eq=False)
class BasisLayout:
    """A basis in the file.

    Attributes:
        size: (width, height) of the textures.
        textures: By rank.
        weights: (Ne, N) float32.
        grid: (rows, columns) of which they are a part, which begins at `corner`, a row and a column; None: all of it.
        lost: Textures behind the end of a file that is cut off.
    """

    size: tuple[int, int]
    textures: tuple[PictureLayout, ...]
    weights: NDArray[np.float32]
    grid: tuple[int, int] | None = None
    corner: tuple[int, int] = (0, 0)
    payload: Payload | None = None
    lost: int = 0

    @property
    def count(self) -> int:
        return sum(picture.count for picture in self.textures)


@dataclass(frozen=True, eq=False)
class PlaneLayout:
    """A plane in the file.

    Attributes:
        bases: Those of which something is left.
        lost: Textures of all bases behind the end of the file.
    """

    mean: PictureLayout
    bases: tuple[BasisLayout, ...]
    lost: int = 0


def read_planes(
    document: Document, entry: Value, cameras: CameraList | None, findings: Findings
) -> tuple[PlaneLayout, ...]:
    """All planes.

    Args:
        cameras: None only while validating a file whose cameras are damaged.

    Raises:
        FormatError: `plane-*`, `decoded-size`, `weights-*`, `picture-*`, `codec-unknown`, `view-*`.
    """
    rows = 0 if cameras is None else cameras.encoded
    entries = enumerate(entry.items(limits.MAX_PLANES, 1))
    planes = tuple(_read_plane(document, plane, index, rows, findings) for index, plane in entries)
    count = sum(basis.count for plane in planes for basis in plane.bases)
    if count > limits.MAX_COMPONENTS:
        entry.fail("plane-components", f"{count} eigen textures, {limits.MAX_COMPONENTS} are allowed")
    total = sum(
        4 * plane.mean.width * plane.mean.height * plane.mean.channels
        + sum(
            basis.size[0] * basis.size[1] * plane.mean.channels * picture.count * (1 if picture.bits == 8 else 2)
            for basis in plane.bases
            for picture in basis.textures
        )
        for plane in planes
    )
    if total > limits.MAX_DECODED:
        entry.fail("decoded-size", f"would decode to {total} bytes, {limits.MAX_DECODED} are allowed")
    return planes


def _read_plane(document: Document, entry: Value, index: int, rows: int, findings: Findings) -> PlaneLayout:
    channels = entry["channels"].integer(1, limits.MAX_CHANNELS)
    if entry.has("mean"):
        size = read_size(entry["mean"]["size"], channels)
        mean = read_picture(document, entry["mean"], "mean", size, channels, 1)
        if entry["mean"].has("precision"):
            mean = replace(mean, precision=_precision(document, entry["mean"]["precision"], mean))
    elif index == 0 and channels in (1, 3):
        mean = read_image(document, channels)
    else:
        raise FormatError("plane-mean", "the plane has no mean", where=f"{entry.where}/mean")
    bases = [_read_basis(document, basis, channels, rows, findings) for basis in entry["bases"].items(limits.MAX_BASES)]
    kept = tuple(basis for basis in bases if basis.count or not basis.lost)
    return PlaneLayout(mean, kept, sum(basis.lost for basis in bases))


def read_image(document: Document, channels: int) -> PictureLayout:
    """`images[0]` as a picture of `channels`, of the size in its header."""
    image = document.root["images"].at(0)
    if not image.has("bufferView"):
        image.fail("plane-mean", "the picture lies in another file")
    data, codec = document.data(image["bufferView"]), _codec_of(image, 8)
    width, height = stacking.dimensions(data, codec, image.where)
    return PictureLayout(data, codec, width, height, channels, None, image.where)


def _read_basis(document: Document, entry: Value, channels: int, rows: int, findings: Findings) -> BasisLayout:
    size = read_size(entry["size"], channels)
    textures: list[PictureLayout] = []
    total, lost = 0, 0
    common = entry["picture"].mapping() if entry.has("picture") else {}
    for entry_of_texture in entry["textures"].items(limits.MAX_COMPONENTS):
        with findings.part():
            texture = Value(dict(common) | entry_of_texture.mapping(), entry_of_texture.where)
            count = texture["count"].integer(1, limits.MAX_COMPONENTS) if texture.has("count") else 1
            total += count  # also of a picture that is damaged: its weights are there
            if lost or document.cut_off(texture["bufferView"]):
                lost += count
                continue
            textures.append(read_picture(document, texture, "textures", size, channels, count))
    weights = np.zeros((rows, 0), np.float32)
    stream: Payload | None = None
    if total:
        with findings.part():
            if entry.has("codedWeights"):
                stream = read_stream(document, entry["codedWeights"], "weights")
                weights = _decode_weights(stream, entry["codedWeights"], rows, total)
            else:
                weights = _read_weights(document, entry["weights"], rows, total)
    if lost:
        weights, stream = np.ascontiguousarray(weights[:, : total - lost]), None
    return BasisLayout(size, tuple(textures), weights, *_region(entry, size), stream, lost)


def _region(entry: Value, size: tuple[int, int]) -> tuple[tuple[int, int] | None, tuple[int, int]]:
    """Grid (rows, columns) and corner (row, column) of a basis that is only a part. FormatError: `basis-region`."""
    if not entry.has("grid"):
        return None, (0, 0)
    columns, rows = (item.integer(1, limits.MAX_SIDE) for item in entry["grid"].items(2, 2))
    column, row = 0, 0
    if entry.has("corner"):
        column, row = (item.integer(0, limits.MAX_SIDE) for item in entry["corner"].items(2, 2))
    if column + size[0] > columns or row + size[1] > rows:
        entry["grid"].fail("basis-region", f"{size[0]}x{size[1]} at {column}, {row} leaves a grid of {columns}x{rows}")
    return (rows, columns), (row, column)


def _decode_weights(stream: Payload, entry: Value, rows: int, count: int) -> NDArray[np.float32]:
    weights: NDArray[np.float32] = CODECS[stream.codec].decode(stream.data, entry.where)
    if rows == 0:  # only while validating a file whose cameras are damaged
        return np.zeros((0, count), np.float32)
    if weights.shape != (rows, count) or not all_finite(weights):
        found = "x".join(map(str, weights.shape))
        entry.fail("weights-count", f"{found} weights, {rows} observations x {count} textures expected")
    return weights


def _read_weights(document: Document, reference: Value, rows: int, count: int) -> NDArray[np.float32]:
    flat = document.array(reference, "SCALAR", (FLOAT,), limits.MAX_WEIGHTS)
    if not all_finite(flat):
        reference.fail("weights-not-finite", "a weight is NaN, infinite or beyond 1e30")
    if rows == 0:  # only while validating a file whose cameras are damaged
        return np.zeros((0, count), np.float32)
    if len(flat) != rows * count:
        reference.fail("weights-count", f"{len(flat)} weights, {rows} observations x {count} textures expected")
    return flat.reshape(rows, count)


def read_size(entry: Value, channels: int) -> tuple[int, int]:
    """Width and height of a picture of so many channels. FormatError: `picture-limit`, `json-*`."""
    width, height = (item.integer(1, limits.MAX_SIDE) for item in entry.items(2, 2))
    w, h = stacking.picture_size(width, height, channels)
    if h > limits.MAX_STACKED or w * h > limits.MAX_TEXELS:
        entry.fail("picture-limit", f"a picture of {w}x{h}, {limits.MAX_TEXELS} texels are allowed")
    return width, height


def read_picture(
    document: Document, entry: Value, place: str, size: tuple[int, int], channels: int, count: int
) -> PictureLayout:
    """A picture that stands at a place of `streams.PLACES`.

    Args:
        place: Of an opacity there is no `scale` and `zero`.
        size: Width and height as announced, as are channels and the count of textures in it.

    Raises:
        FormatError: `picture-*`, `codec-unknown`, `view-*`, `json-*`.
    """
    data = document.data(entry["bufferView"])
    bits = entry["bits"].integer(8, PICTURE_MAX_BITS) if entry.has("bits") else 8
    usual = _codec_of(entry, bits)
    codec = codec_named(entry, place) or usual
    if (PICTURES[codec].mime, PICTURES[codec].bits) != (PICTURES[usual].mime, bits):
        mime = entry["mimeType"].value
        entry["codec"].fail("picture-type", f"{codec} is no codec of {bits} bits in a picture of type {mime}")
    affine = None
    plain = place == "mean" and PICTURES[codec].bits == 8 and not (entry.has("scale") or entry.has("zero"))
    if not plain and place != "opacity":
        affine = Affine(*(read_affine(entry[key], channels, count) for key in ("scale", "zero")))
    stacking.check_picture(data, codec, *size, channels, entry.where, count)
    return PictureLayout(data, codec, *size, channels, affine, entry.where, count)


def _codec_of(entry: Value, bits: int) -> str:
    """The usual codec of pictures of an entry's type. FormatError `picture-type`."""
    mime = entry["mimeType"].text()
    found = codec_of(mime, bits)
    if found is None and bits != 8:
        entry["bits"].fail("picture-type", f"{bits} bits in a picture of type {mime}")
    if found is None:
        entry.fail("picture-type", f"pictures of type {mime!r} are not read")
    return found


def _precision(document: Document, entry: Value, mean: PictureLayout) -> PictureLayout:
    if mean.bits == 8:
        entry.fail("picture-type", "only pictures of 10 bits have a precision")
    width, height = (item.integer(1, limits.MAX_PRECISION_SIDE) for item in entry["size"].items(2, 2))
    data, codec = document.data(entry["bufferView"]), "png"
    if codec_named(entry, "precision") != codec:
        entry["codec"].fail("codec-unknown", f"a precision is a {codec}, not {quote(entry['codec'].value)}")
    stacking.check_picture(data, codec, width, height, 1, entry.where)
    return PictureLayout(data, codec, width, height, 1, None, entry.where)


def read_affine(entry: Value, channels: int, count: int) -> NDArray[np.float64]:
    """(channels * count,), of a `scale` or a `zero`: C numbers for each texture, or C that stand for all."""
    given = [item.number(limits.MAX_NUMBER) for item in entry.items(channels * count, channels)]
    if len(given) not in (channels, channels * count):
        entry.fail("json-value", f"{len(given)} numbers, {channels} or {channels * count} expected")
    return np.tile(np.array(given), 1 if len(given) == channels * count else count)


def read_matrix(entry: Value, channels: int | None) -> NDArray[np.float32] | None:
    """(3, K) float32: R, G, B from the channels of all planes; None where there is none, or where these are not known
    (only while validating). FormatError `plane-matrix`."""
    if not entry.has("toRGB"):
        return None
    most = limits.MAX_PLANES * limits.MAX_CHANNELS
    numbers = [item.number(limits.MAX_GAIN) for item in entry["toRGB"].items(3 * most, 3)]
    if channels is not None and len(numbers) != 3 * channels:
        entry["toRGB"].fail("plane-matrix", f"{len(numbers)} numbers, 3 for each of {channels} channels expected")
    return None if channels is None else np.array(numbers, np.float32).reshape(3, channels)


def check_colours(
    entry: Value, cameras: CameraList | None, planes: Sequence[int] | None, to_rgb: NDArray[np.float32] | None
) -> None:
    """Check that colours of cameras are those of R, G and B; planes: channels of each. FormatError `camera-colour`."""
    if cameras is None or cameras.colours is None or not planes or to_rgb is not None:
        return
    if planes[0] != 3:
        entry["colour"].fail("camera-colour", "colours of cameras, but the first plane has not three channels")
