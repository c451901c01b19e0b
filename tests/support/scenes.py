"""Small synthetic scenes: a bumpy square before a few cameras, with smooth textures of falling amplitude."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay, QhullError

from eigenfield.core.appearance import Appearance, Basis, Plane
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.core.rig import Rig
from eigenfield.core.scene import Scene
from eigenfield.core.viewplane import fit_view_plane


def bumpy_square(nodes: int = 6) -> Mesh:
    """A square of `nodes` x `nodes` vertices, x and y in -1..1 (y down), z around 0, facing -z; UV covers the atlas."""
    steps = np.linspace(0, 1, nodes)
    v, u = np.meshgrid(steps, steps, indexing="ij")
    x, y = 2 * u - 1, 2 * v - 1
    z = 0.1 * np.sin(3 * x) * np.cos(2 * y)
    corner = (np.arange(nodes - 1)[:, None] * nodes + np.arange(nodes - 1)).ravel()
    upper = np.stack([corner, corner + 1, corner + nodes], axis=1)
    lower = np.stack([corner + 1, corner + nodes + 1, corner + nodes], axis=1)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3).astype(np.float32)
    uv = np.stack([u, v], axis=-1).reshape(-1, 2).astype(np.float32)
    return Mesh(vertices, np.concatenate([upper, lower]).astype(np.int32), uv)


def row_grid(cameras: int, width: int = 48, height: int = 40) -> tuple[Camera, ...]:
    """Cameras that look along +z from z = -3, row by row on a grid as square as `cameras` allows, 0.5 apart."""
    columns = int(np.ceil(np.sqrt(cameras)))
    rows = -(-cameras // columns)
    K = np.array([[50.0, 0, width / 2 + 1.5], [0, 52.0, height / 2 - 0.5], [0, 0, 1]])
    made = []
    for index in range(cameras):
        row, column = divmod(index, columns)
        centre = np.array([0.5 * (column - (columns - 1) / 2), 0.5 * (row - (rows - 1) / 2), -3.0])
        made.append(Camera(K, np.eye(3), -centre, width, height))
    return tuple(made)


def smooth_pictures(count: int, height: int, width: int, channels: int, seed: int = 0) -> NDArray[np.float32]:
    """(count, height, width, channels) float32 sums of a few waves, every channel within -1..1."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:height, 0:width] / max(height, width)
    waves = random.uniform(-8, 8, (count, channels, 4, 3))
    angle = waves[..., 0, None, None] * x + waves[..., 1, None, None] * y + waves[..., 2, None, None]
    return np.ascontiguousarray(np.cos(angle).mean(axis=2).transpose(0, 2, 3, 1), dtype=np.float32)


def unit_weights(rows: int, count: int, seed: int = 0) -> NDArray[np.float32]:
    """(rows, count) float32, each column of zero mean and unit variance (one row: zeros)."""
    weights = np.random.default_rng(seed).normal(size=(rows, count))
    weights -= weights.mean(axis=0)
    spread = weights.std(axis=0)
    return np.divide(weights, spread, out=np.zeros_like(weights), where=spread > 0).astype(np.float32)


def float_basis(rows: int, count: int, height: int, width: int, channels: int, seed: int = 0) -> Basis:
    """A basis as the encoder makes it: float textures of falling amplitude, scale 1, zero 0."""
    amplitude = 0.2 * 0.7 ** np.arange(count, dtype=np.float32)
    textures = smooth_pictures(count, height, width, channels, seed + 1) * amplitude[:, None, None, None]
    ones = np.ones((count, channels), np.float32)
    return Basis(textures, ones, np.zeros_like(ones), unit_weights(rows, count, seed + 2))


def encoded_triangles(coordinates: NDArray[np.float64]) -> NDArray[np.int32]:
    """(T, 3) int32 Delaunay triangles over (n, 2) view-plane coordinates, none where they lie on a line."""
    try:
        return Delaunay(coordinates).simplices.astype(np.int32)
    except (QhullError, ValueError):
        return np.zeros((0, 3), np.int32)


def tiny_scene(
    channels: int = 3, textures: int = 3, cameras: int = 5, size: int = 32, held_out: tuple[int, ...] = ()
) -> Scene:
    """A whole scene: `size` x `size` atlas, `cameras` cameras named view_00.., of which `held_out` are held out."""
    views = row_grid(cameras)
    held = np.zeros(cameras, bool)
    held[list(held_out)] = True
    plane = fit_view_plane(views)
    coordinates = plane.coordinates([view.centre for view in views])
    mean = (0.5 + 0.45 * smooth_pictures(1, size, size, channels)[0]).astype(np.float32)
    basis = float_basis(int((~held).sum()), textures, size, size, channels)
    return Scene(
        proxy=Proxy(mesh=bumpy_square()),
        rig=Rig(
            names=tuple(f"view_{index:02d}" for index in range(cameras)),
            cameras=views,
            held_out=held,
            reference=int(np.argmin(np.square(coordinates).sum(axis=1))),
            view_plane=plane,
            triangles=encoded_triangles(coordinates[~held]),
        ),
        appearance=Appearance(planes=(Plane(mean, (basis,)),)),
        settings={"textures": textures, "density": 1.5},
        scores={"uv": {"psnr": 30.5}},
        generator="eigenfield test",
    )
