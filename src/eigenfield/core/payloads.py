"""Coded forms that hold exactly what a scene's parts are: saved as they are, nothing is coded twice.

They are kept beside the objects, not in them: whoever makes a changed copy has an object without files.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.scene import Basis, Plane


@dataclass(frozen=True, eq=False)
class Affine:
    """value = (code - zero) * scale per channel, both (C,) float64: an offset may be large beside the range."""

    scale: NDArray[np.float64]
    zero: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PictureFile:
    """data, mime: the file. bits: of its codes, 8 or 10. count: eigen textures in it, one below the other. affine: the
    way back to numbers, for each channel of each texture; None: code / 255. precision: of a mean, the picture of how
    finely each place of it is coded (see `precision`); None: all of it alike."""

    data: bytes
    mime: str
    bits: int
    count: int
    affine: Affine | None
    precision: bytes | None = None


_files: weakref.WeakKeyDictionary[Basis | Plane, tuple[PictureFile, ...]] = weakref.WeakKeyDictionary()


_streams: weakref.WeakKeyDictionary[Basis | Mesh, bytes] = weakref.WeakKeyDictionary()
_cameras: weakref.WeakKeyDictionary[Camera, tuple[bytes, int, int]] = weakref.WeakKeyDictionary()


def keep_stream(owner: Basis | Mesh, stream: bytes) -> None:
    """The coded form of a basis's weights, or of a mesh (docs/coding.md)."""
    _streams[owner] = stream


def stream_of(owner: Basis | Mesh) -> bytes | None:
    """What `keep_stream` was told; None where the owner has not been coded."""
    return _streams.get(owner)


def keep_cameras(cameras: Sequence[Camera], stream: bytes) -> None:
    """The coded form of these cameras together."""
    for index, camera in enumerate(cameras):
        _cameras[camera] = (stream, index, len(cameras))


def cameras_stream(cameras: Sequence[Camera]) -> bytes | None:
    """The stream that holds exactly these cameras in this order; None where there is none."""
    first = _cameras.get(cameras[0])
    if first is None:
        return None
    expected = [(first[0], index, len(cameras)) for index in range(len(cameras))]
    return first[0] if [_cameras.get(camera) for camera in cameras] == expected else None


def keep_files(owner: Basis | Plane, files: Sequence[PictureFile]) -> None:
    """The files of a basis's textures, by rank, or the one of a plane's mean."""
    _files[owner] = tuple(files)


def files_of(owner: Basis | Plane) -> tuple[PictureFile, ...] | None:
    """What `keep_files` was told; None where the owner has not been coded."""
    return _files.get(owner)
