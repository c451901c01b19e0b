"""Picture files that hold exactly what a plane's mean or a basis's textures are: saved as they are, never coded twice.

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


def keep_files(owner: Basis | Plane, files: Sequence[PictureFile]) -> None:
    """The files of a basis's textures, by rank, or the one of a plane's mean."""
    _files[owner] = tuple(files)


def files_of(owner: Basis | Plane) -> tuple[PictureFile, ...] | None:
    """What `keep_files` was told; None where the owner has not been coded."""
    return _files.get(owner)
