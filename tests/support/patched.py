"""A ball of many charts, with loud colours between them: whatever gets from there into a picture shows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene
from eigenfield.gltf import save
from support.coded_scenes import coded
from support.viewer_scenes import around

SIDE, ACROSS = 512, 10  # texels of the atlas, and charts beside each other in it
PATCHES = 4  # charts along a side of each face of a cube, which is blown up to the ball
CELL = SIDE // ACROSS  # texels of a chart with what is around it
GUTTER = 8  # of which beside the chart on each side: the least that xatlas leaves at this size
KNOWN = 3  # texels beside a chart that continue it
NODES = 4  # vertices along a side of a chart


def _corners() -> list[tuple[int, NDArray[np.float64]]]:
    """Face and lower corner in it of each chart, both from -1 to 1."""
    step = np.linspace(-1, 1, PATCHES + 1)[:-1]
    return [(face, np.array([x, y])) for face in range(6) for y in step for x in step]


def _on_ball(face: int, at: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 3) points of the ball over (..., 2) places of a face of the cube."""
    sign = 1.0 if face % 2 else -1.0
    cube = np.stack([np.full(at.shape[:-1], sign), at[..., 0] * sign, at[..., 1]], axis=-1)
    cube = np.roll(cube, face // 2, axis=-1)
    return np.asarray(1.2 * cube / np.linalg.norm(cube, axis=-1, keepdims=True))


def ball() -> Mesh:
    """The ball, facing outwards."""
    vertices, uv, faces = [], [], []
    along = np.linspace(0, 1, NODES)
    y, x = np.meshgrid(along, along, indexing="ij")
    corner = (np.arange(NODES - 1)[:, None] * NODES + np.arange(NODES - 1)).ravel()
    square = np.concatenate([np.stack([corner, corner + 1, corner + NODES], 1),
                             np.stack([corner + 1, corner + NODES + 1, corner + NODES], 1)])  # fmt: skip
    for index, (face, low) in enumerate(_corners()):
        place = np.stack([x, y], axis=-1)
        vertices.append(_on_ball(face, low + place * 2 / PATCHES).reshape(-1, 3))
        cell = np.array([index % ACROSS, index // ACROSS]) * CELL
        uv.append((cell + GUTTER + place * (CELL - 2 * GUTTER)).reshape(-1, 2) / SIDE)
        faces.append(square + index * NODES * NODES)
    return Mesh(np.concatenate(vertices).astype(np.float32), np.concatenate(faces).astype(np.int32),
                np.concatenate(uv).astype(np.float32))  # fmt: skip


def painted(
    colour: Callable[[NDArray[np.float64]], NDArray[np.float64]], outside: NDArray[np.float64]
) -> NDArray[np.float32]:
    """(SIDE, SIDE, 3): a function of points of the ball, and `outside` where no chart is near."""
    picture = np.tile(outside, (SIDE, SIDE, 1))
    texels = np.arange(-KNOWN, CELL - 2 * GUTTER + KNOWN)
    own = (texels + 0.5) / (CELL - 2 * GUTTER)
    y, x = np.meshgrid(own, own, indexing="ij")
    for index, (face, low) in enumerate(_corners()):
        row, column = (np.array([index // ACROSS, index % ACROSS]) * CELL + GUTTER)[:, None] + texels
        picture[np.ix_(row, column)] = colour(_on_ball(face, low + np.stack([x, y], axis=-1) * 2 / PATCHES))
    return picture.astype(np.float32)


def patched() -> Scene:
    """The ball before the cameras of `around`, with a smooth mean and four smooth textures."""
    made = around()
    (plane,) = made.appearance.planes
    (basis,) = plane.bases
    waves = np.random.default_rng(8).uniform(-2, 2, (5, 3, 3))
    smooth = [lambda p, w=w: np.cos(p @ w + 1) for w in waves]
    mean = painted(lambda p: 0.5 + 0.25 * smooth[0](p), np.array([1.0, 0.0, 1.0]))
    loud = np.array([1.0, -1.0, 1.0])
    textures = np.stack([painted(lambda p, f=f: 0.08 * f(p), loud) for f in smooth[1:]])
    own = replace(plane, mean=mean, bases=(replace(basis, textures=textures),))
    return replace(made, proxy=Proxy(ball()), appearance=replace(made.appearance, planes=(own,)))


def write(folder: Path) -> None:
    """Write patched.glb, codes of 8 bits, and patched-coded.glb, codes of 10."""
    made = patched()
    save(made, folder / "patched.glb", codec="png", overwrite=True)
    save(coded(made, None), folder / "patched-coded.glb", overwrite=True)
