"""Coded streams that travel with a scene, each found by the content that it decodes to.

A payload is cached under a key: the kind of the content and a SHA-256 digest of its arrays. `save` computes the keys of
a scene's parts and writes the payloads under them. A part that was edited, even in place, has another key and is
encoded again. All others keep their bytes through copies, pickles, `dataclasses.replace` and other processes.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Basis
from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh

T = TypeVar("T")
Key = tuple[str, bytes]  # kind, digest


@dataclass(frozen=True, eq=False)
class Affine:
    """value = (code - zero) * scale per channel, in float64: an offset may be large beside the range.

    Attributes:
        scale: (C,) float64.
        zero: (C,) float64.
    """

    scale: NDArray[np.float64]
    zero: NDArray[np.float64]

    __repr__ = brief_repr


@dataclass(frozen=True, eq=False)
class Payload:
    """A coded stream.

    Attributes:
        codec: Name in `coding.codecs.CODECS`.
        data: The bytes, as a file holds them.
    """

    codec: str
    data: bytes

    __repr__ = brief_repr


@dataclass(frozen=True, eq=False)
class PicturePayload(Payload):
    """A coded picture, of a mean, of eigen textures or of an opacity.

    Attributes:
        count: Eigen textures in it, one below the other.
        affine: From codes to numbers, for each channel of each texture; None: the largest code is 1.
        precision: Of a mean, a picture of the precision with which each place is coded; None: uniform.
    """

    count: int = 1
    affine: Affine | None = None
    precision: Payload | None = None

    __repr__ = brief_repr


class Payloads(Mapping[Key, tuple[Payload, ...]]):
    """Payloads of the parts of a scene by key; immutable. The pictures of a basis come by rank."""

    def __init__(self, found: Mapping[Key, Sequence[Payload]] | None = None) -> None:
        self._found = {key: tuple(payloads) for key, payloads in (found or {}).items()}

    def __getitem__(self, key: Key) -> tuple[Payload, ...]:
        return self._found[key]

    def __iter__(self) -> Iterator[Key]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def __or__(self, other: Mapping[Key, Sequence[Payload]]) -> Payloads:
        return Payloads({**self._found, **other})

    def without(self, kind: str) -> Payloads:
        """All payloads but those of one kind of content."""
        return Payloads({key: payloads for key, payloads in self._found.items() if key[0] != kind})

    def only(self, kind: str) -> Payload:
        """The one payload of a kind of content of which there is no other.

        Raises:
            ValueError: There is none, or there are several.
        """
        (stream,) = (payload for key, payloads in self._found.items() if key[0] == kind for payload in payloads)
        return stream

    @staticmethod
    def merge(several: Iterable[Payloads]) -> Payloads:
        """The payloads of several."""
        return Payloads({key: payloads for one in several for key, payloads in one.items()})

    @property
    def bytes(self) -> int:
        """Bytes of all payloads together."""
        return sum(map(size_of, self._found.values()))

    def __repr__(self) -> str:
        return f"Payloads of {len(self)} parts, {self.bytes:,} bytes"


@dataclass(frozen=True, eq=False)
class Coded(Generic[T]):
    """A decoded value with its payloads, under the keys of its parts."""

    value: T
    payloads: Payloads


def size_of(payloads: Iterable[Payload]) -> int:
    """Bytes of some payloads together."""
    return sum(len(payload.data) for payload in payloads)


def mesh_key(mesh: Mesh) -> Key:
    """The key of vertices, faces and texture coordinates."""
    return _key("mesh", mesh.vertices, mesh.faces, *(() if mesh.uv is None else (mesh.uv,)))


def cameras_key(cameras: Sequence[Camera]) -> Key:
    """The key of the intrinsics and poses of these cameras in this order; files hold the photographs' sizes apart."""
    return _key("cameras", *(np.array([getattr(camera, name) for camera in cameras]) for name in ("K", "R", "t")))


def mean_key(mean: NDArray[np.float32]) -> Key:
    """The key of a plane's mean (H, W, C)."""
    return _key("mean", mean)


def opacity_key(opacity: NDArray[np.float32]) -> Key:
    """The key of the opacity (H, W) of sheets."""
    return _key("opacity", opacity)


def textures_key(basis: Basis) -> Key:
    """The key of a basis's eigen textures, and of scale and zero of their codes."""
    return _key("textures", basis.textures, basis.scale, basis.zero)


def weights_key(weights: NDArray[np.float32]) -> Key:
    """The key of a basis's weights (Ne, N)."""
    return _key("weights", weights)


def preview_key(sources: Sequence[Key], to_rgb: NDArray[np.float32] | None, harmonised: bool) -> Key:
    """The key of the picture for other viewers: from those of the means and the opacity of sheets, the scene's
    `to_rgb`, and whether it has `colours`."""
    digests = np.frombuffer(b"".join(digest for _, digest in sources), np.uint8)
    return _key("preview", digests, np.array([harmonised]), *(() if to_rgb is None else (to_rgb,)))


def payloads_of(basis: Basis, pictures: Sequence[PicturePayload], weights: Payload | None) -> Payloads:
    """The payloads of a basis.

    Args:
        pictures: Of its textures, by rank; none where it has no textures.
        weights: Its coded weights; None where they are not coded.
    """
    found = Payloads({textures_key(basis): pictures} if pictures else {})
    return found if weights is None else found | {weights_key(basis.weights): [weights]}


def _key(kind: str, *arrays: NDArray[Any]) -> Key:
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(f"{array.dtype.str}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data)
    return kind, digest.digest()
