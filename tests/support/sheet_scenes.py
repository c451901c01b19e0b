"""Scenes with sheets, and reference pictures of them, for the tests of the web viewer."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np

from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.core.scene import Scene
from eigenfield.gltf import save
from support.coded_scenes import GRID, coded
from support.scenes import bumpy_square
from support.viewer_scenes import references, scene

STRIPS = 3  # of the atlas, one for each sheet
OPACITY = (80, 96)  # rows and columns: coarser than the atlas


def sheet_scene(folded: bool = False) -> Scene:
    """Three sheets: an opaque one, one that leans through it, and a small one in front.

    Opacity is 0 at the rims of the last two. `folded`: the second lies twofold over half of its width.
    """
    square = bumpy_square(24)
    back = _strip(0, replace(square, vertices=square.vertices * np.float32([1.25, 1.25, 1])))
    middle = _strip(1, _leaning(folded))
    front = _strip(2, replace(square, vertices=square.vertices * np.float32(0.7) - np.float32([0.2, 0, 0.6])))
    rows, columns = np.indices(OPACITY)
    u, v = (columns + 0.5) / OPACITY[1], (STRIPS * (rows + 0.5) / OPACITY[0])
    within = np.minimum(1, 6 * np.minimum(_rim(u), _rim(v % 1)))  # 0 at the rim of each strip
    waves = 0.5 + 0.5 * np.sin(14 * u + 2 * v) * np.cos(9 * (v % 1))
    opacity = np.where(v < 1, 1, np.clip(1.6 * within * (waves + 0.2 * (v > 2)), 0, 1)).astype(np.float32)
    parts = (back, middle, front)
    first = np.cumsum([0] + [len(part.vertices) for part in parts])
    whole = Mesh(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + start for part, start in zip(parts, first, strict=False)]).astype(np.int32),
        np.concatenate([part.uv for part in parts]),
    )
    return replace(scene(), proxy=Proxy(whole, None, Sheets(tuple(len(part.faces) for part in parts), opacity)))


def _rim(along: np.ndarray) -> np.ndarray:
    """Distance from the rim of a strip, 0..1 along it, less what the mesh leaves free."""
    return np.maximum(0, np.minimum(along, 1 - along) - 0.14)


def _strip(number: int, mesh: Mesh) -> Mesh:
    """The mesh with its UVs in a strip of the atlas, some texels from its rim."""
    uv = (0.08 + 0.84 * mesh.uv + (0, number)) / (1, STRIPS)
    return Mesh(mesh.vertices.astype(np.float32), mesh.faces, uv.astype(np.float32))


def _leaning(folded: bool) -> Mesh:
    """A square that leans through the opaque one, nearer at its left; or is bent to and fro like an S."""
    mesh = bumpy_square(24)
    along, y, _ = mesh.vertices.T.astype(np.float64)
    x, z = along, 0.4 * along
    if folded:
        x, z = along + 0.9 * np.sin(np.pi * along), 0.35 * np.sin(np.pi * along / 2)
    return replace(mesh, vertices=np.stack([0.9 * x, 0.9 * y, z], axis=1).astype(np.float32))


def write(folder: Path) -> None:
    """Write sheets.glb, folded.glb and sheets-coded.glb, and add their pictures to references.json, which is there."""
    save(sheet_scene(), folder / "sheets.glb", codec="png", overwrite=True)
    save(sheet_scene(folded=True), folder / "folded.glb", codec="png", overwrite=True)
    save(coded(sheet_scene(), GRID), folder / "sheets-coded.glb", overwrite=True)
    listing = folder / "references.json"
    pictures = json.loads(listing.read_text(encoding="utf-8"))
    for name in ("sheets.glb", "folded.glb", "sheets-coded.glb"):
        pictures += references(folder, name)
    listing.write_text(json.dumps(pictures, indent=1), encoding="utf-8")
