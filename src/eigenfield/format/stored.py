"""Files that hold exactly what a mean, textures or weights are: saved as they are, never coded twice.

They are kept beside the objects, not in them: whoever makes a changed copy has an object without files.
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from dataclasses import dataclass

from eigenfield.format.quantise import Affine
from eigenfield.scene import Basis, Plane


@dataclass(frozen=True, eq=False)
class PictureFile:
    """data, mime: the file. bits: of its codes, 8 or 10. count: eigen textures in it, one below the other. affine: the
    way back to numbers, for each channel of each texture; None: code / 255."""

    data: bytes
    mime: str
    bits: int
    count: int
    affine: Affine | None


_files: weakref.WeakKeyDictionary[Basis | Plane, tuple[PictureFile, ...]] = weakref.WeakKeyDictionary()


_weights: weakref.WeakKeyDictionary[Basis, bytes] = weakref.WeakKeyDictionary()


def keep_weights(basis: Basis, stream: bytes) -> None:
    """The coded form of a basis's weights."""
    _weights[basis] = stream


def weights_of(basis: Basis) -> bytes | None:
    """What `keep_weights` was told; None where the weights have not been coded."""
    return _weights.get(basis)


def keep_files(owner: Basis | Plane, files: Sequence[PictureFile]) -> None:
    """The files of a basis's textures, by rank, or the one of a plane's mean."""
    _files[owner] = tuple(files)


def files_of(owner: Basis | Plane) -> tuple[PictureFile, ...] | None:
    """What `keep_files` was told; None where the owner has not been coded."""
    return _files.get(owner)
