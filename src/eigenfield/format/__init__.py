"""The file: a glTF 2.0 binary with `EIGENFIELD_eigen_textures`, as docs/format.md specifies it."""

from __future__ import annotations

from eigenfield.format.contents import describe, parts, store_scores
from eigenfield.format.findings import Finding
from eigenfield.format.read import file_bytes, load, outline, validate
from eigenfield.format.write import encode_scene, save

__all__ = [
    "Finding",
    "describe",
    "encode_scene",
    "file_bytes",
    "load",
    "outline",
    "parts",
    "save",
    "store_scores",
    "validate",
]
