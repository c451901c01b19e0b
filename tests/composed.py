"""Scenes of planes of several densities and regions, and the definition of their texture, slow and plain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scenes import smooth_pictures
from viewer_scenes import SIDE, scene

from eigenfield.scene import Basis, Plane, Scene

TO_RGB = np.array([[1.0, 0.1, 1.4], [1.0, -0.34, -0.71], [1.0, 1.77, -0.1]], np.float32)


def layered_scene() -> Scene:
    """Luma of the whole 128 x 128 atlas with textures of a region of it and of half its density, two channels of
    chroma at odd sizes; textures are codes. Geometry and weights as `viewer_scenes.scene`."""
    plain = scene()
    weights = plain.planes[0].bases[0].weights
    luma = np.ascontiguousarray(plain.planes[0].mean[..., :1])
    chroma = 0.1 * smooth_pictures(1, 40, 48, 2, seed=4)[0]
    planes = (
        Plane(
            luma,
            (
                coded(weights, 6, (72, 96), 1, grid=(SIDE, SIDE), corner=(40, 8)),
                coded(weights[:, ::-1], 3, (64, 64), 1),
            ),
        ),
        Plane(
            chroma,
            (coded(weights, 5, (32, 64), 2), coded(weights, 2, (20, 11), 2, grid=(40, 48), corner=(20, 37))),
        ),
    )
    return replace(plain, planes=planes, to_rgb=TO_RGB)


def coded(
    weights: np.ndarray,
    count: int,
    size: tuple[int, int],
    channels: int,
    grid: tuple[int, int] | None = None,
    corner: tuple[int, int] = (0, 0),
) -> Basis:
    """A basis of 8-bit codes with scales and zeros that differ."""
    values = 127 * smooth_pictures(count, *size, channels, seed=sum(size) + channels)
    zero = (128 - np.arange(count * channels).reshape(count, channels) % 3).astype(np.float32)
    scale = (0.2 * 0.8 ** np.arange(count)[:, None] / 127 * np.linspace(1, 1.3, channels)).astype(np.float32)
    codes = np.clip(np.rint(values + zero[:, None, None]), 0, 255).astype(np.uint8)
    return Basis(codes, scale, zero, np.ascontiguousarray(weights[:, :count]), grid, corner)


def composed(scene: Scene, weights: np.ndarray, count: int | None = None) -> np.ndarray:
    """(H, W, 3): the texture that is drawn. weights: (Ne,), or (h, w, Ne) for each size in a dict."""
    channels = []
    for plane in scene.planes:
        total = np.zeros((*scene.atlas, plane.mean.shape[2]))
        for size in set(plane.sizes):
            part = np.zeros((*size, plane.mean.shape[2]))
            if plane.mean.shape[:2] == size:
                part += plane.mean
            for basis in plane.bases:
                if basis.size == size:
                    omega = (weights[size] if isinstance(weights, dict) else weights) @ basis.weights
                    (top, left), (rows, columns) = basis.corner, basis.textures.shape[1:3]
                    for j, texture in enumerate(basis.values()[:count]):
                        own = np.broadcast_to(omega[..., j, None], (*size, 1))
                        place = slice(top, top + rows), slice(left, left + columns)
                        part[place] += own[place] * texture
            total += part if size == scene.atlas else finer(part, *scene.atlas)
        channels.append(total)
    together = np.concatenate(channels, axis=2)
    return np.broadcast_to(together if scene.to_rgb is None else together @ scene.to_rgb.T, (*scene.atlas, 3))


def finer(grid: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """(rows, columns, C): Catmull-Rom of a grid, taps clamped to the border."""
    return np.einsum("rh,cw,hwk->rck", taps(rows, grid.shape[0]), taps(columns, grid.shape[1]), grid)


def taps(count: int, given: int) -> np.ndarray:
    """(count, given): what each of `count` texels takes of each of `given`."""
    matrix = np.zeros((count, given))
    for texel in range(count):
        x = (texel + 0.5) / count * given - 0.5
        for tap in range(int(np.floor(x)) - 1, int(np.floor(x)) + 3):
            t = abs(x - tap)
            near, far = 1.5 * t**3 - 2.5 * t**2 + 1, -0.5 * t**3 + 2.5 * t**2 - 4 * t + 2
            matrix[texel, min(max(tap, 0), given - 1)] += near if t <= 1 else far
    return matrix
