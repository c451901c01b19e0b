"""Photographs of textured planes, drawn by a ray-caster of their own."""

from __future__ import annotations

import numpy as np


def paint(seed: int, size: int = 256, detail: float = 3.0) -> np.ndarray:
    """(size, size, 3) smooth random colours that repeat at the edges."""
    rng = np.random.default_rng(seed)
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(size), np.fft.fftfreq(size)))
    noise = np.fft.fft2(rng.standard_normal((size, size, 3)), axes=(0, 1))
    noise *= np.exp(-((frequency * np.pi * detail) ** 2))[..., None]
    values = np.real(np.fft.ifft2(noise, axes=(0, 1)))
    return np.clip(128 + 45 * values / values.std(), 0, 255)


def look_up(texture: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Bilinear, repeating."""
    size = len(texture)
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = (x - i)[..., None], (y - j)[..., None]
    at = lambda a, b: texture[a % size, b % size]  # noqa: E731
    upper = (1 - fx) * at(j, i) + fx * at(j, i + 1)
    return (1 - fy) * upper + fy * ((1 - fx) * at(j + 1, i) + fx * at(j + 1, i + 1))


def photograph(layers: list, matrices: np.ndarray, side: int) -> np.ndarray:
    """(V, side, side, 3) uint8. layers, near to far: (a, b, c, texture, inside): the plane d = a + b x + c y of canvas
    coordinates, where inside(x, y) holds.

    A pixel's ray meets the plane where M (x, y, a + b x + c y, 1) is the pixel: a homography, inverted.
    """
    v, u = np.mgrid[0:side, 0:side].astype(float)
    result = np.zeros((len(matrices), side, side, 3), np.uint8)
    for picture, matrix in zip(result, matrices, strict=True):
        colour = np.full((side, side, 3), 0.0)
        empty = np.ones((side, side), bool)
        for a, b, c, texture, inside in layers:
            plane = np.array([[1, 0, 0], [0, 1, 0], [b, c, a], [0, 0, 1]])
            x, y, w = np.moveaxis(np.stack([u, v, np.ones_like(u)], -1) @ np.linalg.inv(matrix @ plane).T, -1, 0)
            x, y = x / w, y / w
            hit = empty & inside(x, y)
            colour[hit] = look_up(texture, x, y)[hit]
            empty &= ~hit
        picture[:] = np.rint(colour)
    return result


def cropped(pictures: np.ndarray, places: list[tuple[slice, slice]]) -> np.ndarray:
    """Photographs that show only these rows and columns: their edges go on beyond them."""
    parts = []
    for picture, (rows, columns) in zip(pictures, places, strict=True):
        around = [(part.start, side - part.stop) for part, side in zip((rows, columns), picture.shape, strict=False)]
        parts.append(np.pad(picture[rows, columns], (*around, (0, 0)), mode="edge"))
    return np.stack(parts)


def lying_and_upright(count: int, side: int, short: int) -> list[tuple[slice, slice]]:
    """Rows and columns of `count` photographs in the middle of a square: every second one is upright."""
    whole, part = slice(0, side), slice((side - short) // 2, (side + short) // 2)
    return [(whole, part) if index % 2 else (part, whole) for index in range(count)]


def everywhere(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.ones(x.shape, bool)
