"""The file: a glTF 2.0 binary with `EIGENFIELD_eigen_textures`, as docs/format.md specifies it."""

from __future__ import annotations

from eigenfield.gltf.clip_forms import clip_in_files, clip_in_one_file, has_group_files, one_file
from eigenfield.gltf.clips import coded_clip
from eigenfield.gltf.contents import describe, describe_clip, parts, store_scores, without_residual
from eigenfield.gltf.findings import Finding
from eigenfield.gltf.read import as_scene, load, load_any, outline, read_scene, validate
from eigenfield.gltf.read_clip import load_clip, stores_clip
from eigenfield.gltf.write import encode_scene, refuse_output, save

__all__ = [
    "Finding", "as_scene", "clip_in_files", "clip_in_one_file", "coded_clip", "describe", "describe_clip",
    "encode_scene", "has_group_files", "load", "load_any", "load_clip", "one_file", "outline", "parts", "read_scene",
    "refuse_output", "save", "store_scores", "stores_clip", "validate", "without_residual",
]  # fmt: skip
