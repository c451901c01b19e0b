"""A made-up scene of three sheets: a wall, a soft disc before it, soft bars before that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.core.scene import Scene
from support.coded_scenes import coded
from support.scenes import bumpy_square, tiny_scene

DEPTHS, SIZES = (1.0, 0.1, -0.4), (1.6, 1.0, 0.8)  # of the sheets, back to front
OPACITY = 96, 128  # rows, columns


def soft_scene(channels: int = 3) -> Scene:
    """Sheets of 242, 128 and 98 triangles in strips of a 96 x 96 atlas, nine cameras."""
    scene = tiny_scene(channels, 4, 9, 96)
    return replace(scene, proxy=Proxy(*_mesh()))


def coded_soft_scene() -> Scene:
    """The same with everything coded that can be."""
    return coded(soft_scene(), np.arange(9).reshape(3, 3))


def _mesh() -> tuple[Mesh, None, Sheets]:
    vertices, faces, uv = [], [], []
    for k, (depth, size, nodes) in enumerate(zip(DEPTHS, SIZES, (12, 9, 8), strict=True)):
        one = bumpy_square(nodes)
        assert one.uv is not None
        faces.append(one.faces + sum(map(len, vertices)))
        vertices.append(one.vertices * (size, size, 1) + (0, 0, depth))
        uv.append((one.uv * 0.92 + (k + 0.04, 0.04)) / (3, 1))
    mesh = Mesh(
        np.concatenate(vertices).astype(np.float32), np.concatenate(faces).astype(np.int32),
        np.concatenate(uv).astype(np.float32),
    )  # fmt: skip
    return mesh, None, Sheets(tuple(map(len, faces)), _opacity())


def _opacity() -> NDArray[np.float32]:
    """The wall is opaque; the disc and the bars end within a tenth of their sheet."""
    rows, columns = OPACITY
    v, u = (np.mgrid[:rows, :columns] + 0.5) / np.array(OPACITY)[:, None, None]
    x, y = 6 * u % 2 - 1, 2 * v - 1
    disc, bars = 8 * (0.7 - np.hypot(x, y)), 4 * np.cos(9 * x) + 1
    made = np.select([u < 1 / 3, u < 2 / 3], [np.ones_like(u), disc], bars)
    return made.clip(0, 1).astype(np.float32)
