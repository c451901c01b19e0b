"""The paper's equations 1 to 8 in plain NumPy: slow, obvious, float64. Everything fast is held against this.

T: (Nc, n, C) texture maps, zero where not seen. v: (Nc, n) visibility, 0 or 1.
"""

from __future__ import annotations

import numpy as np


def mean_texture(T, v):
    """Equation 1: the mean over the cameras that see a texel; 0 where none does."""
    total = (T * v[..., None]).sum(axis=0)
    count = v.sum(axis=0)[:, None]
    return np.divide(total, count, out=np.zeros_like(total), where=count > 0)


def filled_maps(T, v):
    """Equation 2: what a camera does not see comes from the mean."""
    return np.where(v[..., None] > 0, T, mean_texture(T, v))


def decomposition(T, v, N):
    """Equations 3 to 6: subtract the mean, singular value decomposition, keep N.

    Returns the mean (n, C), eigen textures (N, n, C) and weights (Nc, N), the weights with unit mean square and their
    entry of largest magnitude positive.
    """
    mean = mean_texture(T, v)
    D = (filled_maps(T, v) - mean).reshape(len(T), -1)
    U, S, Vt = np.linalg.svd(D, full_matrices=False)
    U, S, Vt = U[:, :N], S[:N], Vt[:N]
    sign = np.where(U[np.abs(U).argmax(axis=0), np.arange(N)] < 0, -1.0, 1.0)
    scale = np.sqrt(len(T))
    return mean, (Vt * (S * sign)[:, None] / scale).reshape(N, *mean.shape), U * sign * scale


def barycentric(point, triangle):
    """The three weights of equation 7: coordinates of a viewpoint in a triangle of camera positions."""
    a, b, c = np.asarray(triangle, float)
    matrix = np.array([[a[0], b[0], c[0]], [a[1], b[1], c[1]], [1, 1, 1]])
    return np.linalg.solve(matrix, [point[0], point[1], 1])


def nearest3_weights(point, positions, rows):
    """Equation 7: the texture weights at a viewpoint from the three nearest cameras."""
    nearest = np.argsort(np.linalg.norm(np.asarray(positions) - point, axis=1), kind="stable")[:3]
    return barycentric(point, np.asarray(positions)[nearest]) @ np.asarray(rows)[nearest]


def texture(mean, eigen, row):
    """Equation 8: mean plus weighted sum of eigen textures."""
    return mean + np.tensordot(row, eigen, axes=1)
