"""What a reader of meshes gives, and what `docs/meshes.md` says of its format."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class RawMesh(NamedTuple):
    """A mesh as a file stores it.

    Attributes:
        vertices: (n, 3) float64.
        faces: (m, 3) int64.
        uv: (n, 2) float64, v down, or None.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    uv: NDArray[np.float64] | None


def parse_numbers(text: bytes) -> NDArray[np.float64]:
    """(n,) all numbers of a text, with white space between them.

    Raises:
        ValueError: It holds something else.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # of NumPy before 2.4, which raises ValueError
        try:
            return np.fromstring(text.decode("latin-1"), np.float64, sep=" ")
        except DeprecationWarning as error:
            raise ValueError(str(error)) from None


@dataclass(frozen=True)
class MeshFormat:
    """A format of mesh files.

    Attributes:
        name: For people.
        suffixes: Of its files, in lower case.
        read: The mesh in the bytes of a file, whose path is for files beside it and for messages.
        reads: What is read of it.
        refuses: What is refused, with a message that names it.
        ignores: What is left out.
        tried: Programs whose files were tried, with versions.
    """

    name: str
    suffixes: tuple[str, ...]
    read: Callable[[bytes, Path], RawMesh]
    reads: str
    refuses: str
    ignores: str
    tried: str


def list_of_formats(formats: tuple[MeshFormat, ...]) -> str:
    """The list of `docs/meshes.md`, in Markdown."""
    parts = [
        f"### {each.name}: {', '.join(f'`{suffix}`' for suffix in each.suffixes)}\n\n"
        f"- **Read**: {each.reads}\n- **Refused, by name**: {each.refuses}\n- **Left out**: {each.ignores}\n"
        f"- **Tried with files of** {each.tried}\n"
        for each in formats
    ]
    return "\n".join(parts)
