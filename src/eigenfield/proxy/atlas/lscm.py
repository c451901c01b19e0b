"""Least-squares conformal maps.

Lévy et al., "Least Squares Conformal Maps for Automatic Texture Atlas Generation", 2002. The paper fixes the scale and
rotation of the map by pinning two vertices, which distorts the map near them. Here the whole boundary fixes them:
Mullen et al., "Spectral Conformal Parameterization", 2008.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from eigenfield.core.mesh import signed_areas, triangle_areas
from eigenfield.imaging.graph import face_edges

LSCM_DIAGONAL_SHIFT = 1e-9  # relative to the mean diagonal: keeps the factorisation regular
LSCM_ITERATIONS = 12  # of inverse iteration; the desired pair of eigenvalues is far below the rest
LSCM_MIN_AREA_RATIO = 1e-12  # smaller triangles, relative to the mean, do not determine angles


def conformal_map(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """The conformal map of a chart to the plane.

    It has the least conformal energy sum |W_1 u_1 + W_2 u_2 + W_3 u_3|^2 / (2 area) over the triangles, u = x + i y,
    W_k the edge opposite corner k as a complex number in the triangle's own plane (equation 4 of Lévy et al.), among
    maps whose boundary has variance 1 about its mean. The total area is that of the surface.

    Args:
        vertices: (n, 3); each is in a face.
        faces: (m, 3), of positive total area.

    Returns:
        (n, 2) coordinates.
    """
    energy = conformal_energy(vertices, faces)
    n = len(vertices)
    boundary = boundary_vertices(faces, n)
    mass = np.tile(boundary, 2).astype(np.float64)
    size = float(energy.diagonal().mean()) or 1.0
    solve = splu((energy + LSCM_DIAGONAL_SHIFT * size * diags_array(np.ones(2 * n))).tocsc()).solve
    z = _initial_map(vertices, boundary)
    for _ in range(LSCM_ITERATIONS):
        z = solve(mass * z).reshape(2, n)
        z -= z[:, boundary].mean(axis=1, keepdims=True)
        z = (z / np.sqrt((z[:, boundary] ** 2).sum())).reshape(-1)
    uv = z.reshape(2, n).T
    area = signed_areas(uv[faces])
    if area.sum() < 0:  # a mirrored map has maximal energy; this is for maps that collapsed
        uv = uv * (1, -1)
    total = max(abs(float(area.sum())), 1e-300)
    return np.ascontiguousarray(uv * np.sqrt(float(triangle_areas(vertices[faces]).sum()) / total))


def conformal_energy(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> csr_array:
    """Matrix of the energy for (x_1 .. x_n, y_1 .. y_n): zero for similarities.

    Returns:
        (2 n, 2 n) symmetric.
    """
    p = vertices[faces]
    along, side = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    length = np.linalg.norm(along, axis=1)
    twice = 2 * triangle_areas(vertices[faces])
    good = twice > LSCM_MIN_AREA_RATIO * max(float(twice.mean()), 1e-300)
    length, along, side, twice, f = length[good], along[good], side[good], twice[good], faces[good].astype(np.int64)
    x2, y2 = (along * side).sum(axis=1) / length, twice / length
    corner = np.stack([np.zeros_like(x2), length + 0j, x2 + 1j * y2], axis=1)
    w = (np.roll(corner, -2, axis=1) - np.roll(corner, -1, axis=1)) / np.sqrt(twice)[:, None]
    n, m = len(vertices), len(f)
    row = np.repeat(np.arange(m), 3)
    column, real, imaginary = f.reshape(-1), w.real.reshape(-1), w.imag.reshape(-1)
    rows = np.r_[row, row, row + m, row + m]
    columns = np.r_[column, column + n, column, column + n]
    values = np.r_[real, -imaginary, imaginary, real]
    matrix = coo_array((values, (rows, columns)), shape=(2 * m, 2 * n)).tocsr()
    return (matrix.T @ matrix).tocsr()


def boundary_vertices(faces: NDArray[np.int32], n: int) -> NDArray[np.bool_]:
    """(n,) vertices on an edge of only one triangle; all vertices of a closed surface."""
    ends, edge = face_edges(faces)
    boundary = np.zeros(n, np.bool_)
    boundary[ends[np.bincount(edge)[edge] == 1]] = True
    return boundary if boundary.any() else np.ones(n, np.bool_)


def _initial_map(vertices: NDArray[np.float64], boundary: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Two principal directions of the boundary with fixed signs: not orthogonal to the solution, and deterministic."""
    centred = vertices - vertices[boundary].mean(axis=0)
    _, _, directions = np.linalg.svd(centred[boundary], full_matrices=False)
    directions = directions[:2]
    largest = np.argmax(np.abs(directions), axis=1)
    directions = directions * np.sign(directions[[0, 1], largest])[:, None]
    return np.asarray(
        np.concatenate([centred @ directions[0], centred @ directions[1] + 0.1 * centred @ directions[0]])
    )
