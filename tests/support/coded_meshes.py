"""Meshes to code: sheets, closed surfaces, and what no surface is."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import strategies as st

from eigenfield.core.lattice import camera_lattice, world_lattice
from eigenfield.core.mesh import Mesh

CAMERA = np.array([[100.0, 0, 50, 0], [0, 100, 40, 0], [0, 0, 1, 0]])


def relief(rows=20, columns=24, *, step=1.0, charts=1, astray=0.0):
    """A bumpy sheet on the pixels of CAMERA, its texture laid out as that camera sees it; and its lattice. charts: it
    is cut into so many strips, with gaps between them in the texture. astray: the share of
    vertices that are off the pixels."""
    y, x = np.mgrid[:rows, :columns].astype(np.float64)
    off = np.random.default_rng(2).uniform(-0.4, 0.4, (2, rows, columns))
    off *= np.random.default_rng(3).uniform(0, 1, (rows, columns)) < astray
    x, y = x + off[0], y + off[1]
    inverse = 0.5 + 0.05 * np.sin(x / 5) * np.cos(y / 4)
    vertices, uv, faces = [], [], []
    cuts = np.linspace(0, columns - 1, charts + 1).astype(int)
    for chart, (first, last) in enumerate(itertools.pairwise(cuts)):
        width = last - first + 1
        start = sum(len(each) for each in vertices)
        part = np.s_[:, first : last + 1]
        px, py, w = x[part].reshape(-1), y[part].reshape(-1), inverse[part].reshape(-1)
        vertices.append(np.stack([(px + 0.5 - 50) / 100 / w, (py + 0.5 - 40) / 100 / w, 1 / w], axis=1))
        uv.append(np.stack([(px + 4 * chart + 2) / 64, (py + 2) / 64], axis=1))
        corner = (np.arange(rows - 1)[:, None] * width + np.arange(width - 1)).reshape(-1) + start
        faces.append(np.stack([corner, corner + width, corner + 1], axis=1))
        faces.append(np.stack([corner + 1, corner + width, corner + width + 1], axis=1))
    mesh = Mesh(
        np.concatenate(vertices).astype(np.float32), np.concatenate(faces).astype(np.int32),
        np.concatenate(uv).astype(np.float32),
    )  # fmt: skip
    return mesh, camera_lattice(CAMERA, step, 1e-3)


def ball(around=16, up=9):
    """A sphere whose texture is cut along a meridian and apart at the poles; and a lattice in space."""
    t, s = np.mgrid[: up + 1, : around + 1].astype(np.float64)
    a, b = 2 * np.pi * s / around, np.pi * t / up
    vertices = np.stack([np.cos(a) * np.sin(b), np.sin(a) * np.sin(b), np.cos(b)], axis=-1).reshape(-1, 3)
    vertices[np.abs(vertices) < 1e-12] = 0
    vertices.reshape(up + 1, around + 1, 3)[:, -1] = vertices.reshape(up + 1, around + 1, 3)[:, 0]
    uv = np.stack([s / around, t / up], axis=-1).reshape(-1, 2)
    corner = (np.arange(up)[:, None] * (around + 1) + np.arange(around)).reshape(-1)
    low = corner + around + 1
    faces = np.concatenate([np.stack([corner, low, corner + 1], axis=1), np.stack([corner + 1, low, low + 1], axis=1)])
    return Mesh(vertices.astype(np.float32), faces.astype(np.int32), uv.astype(np.float32)), world_lattice(
        [-1, -1, -1], 2 / 1023
    )


def soup(seed=0, vertices=40, faces=90):
    """Triangles between random vertices, some twice, some turned over, some of two corners; and a lattice in space."""
    random = np.random.default_rng(seed)
    corners = random.integers(0, vertices, (faces, 3))
    corners[faces // 2 :][::3] = corners[: len(corners[faces // 2 :][::3])]
    corners[faces // 2 :][1::3] = corners[: len(corners[faces // 2 :][1::3]), ::-1]
    mesh = Mesh(
        random.integers(0, 12, (vertices, 3)).astype(np.float32), corners.astype(np.int32),
        random.uniform(0, 1, (vertices, 2)).astype(np.float32),
    )  # fmt: skip
    return mesh, world_lattice([0, 0, 0], 1.0)


def joined(meshes):
    """One mesh of several, which share no vertex; and the number of faces of each."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts[:-1], strict=True)]
    whole = Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces).astype(np.int32),
        np.concatenate([mesh.uv for mesh in meshes]),
    )  # fmt: skip
    return whole, tuple(len(mesh.faces) for mesh in meshes)


def face_set(mesh, lattice):
    """(m, 9) whole numbers: the lattice points of every face's corners, the least first, in order; without faces that
    have two corners at one point."""
    corner = np.rint(lattice.coordinates(mesh.vertices)).astype(np.int64)[mesh.faces]
    apart = (corner != np.roll(corner, 1, axis=1)).any(axis=2).all(axis=1)
    rows = [min(tuple(np.roll(face, -k, axis=0).reshape(-1)) for k in range(3)) for face in corner[apart]]
    return np.array(sorted(rows), np.int64).reshape(-1, 9)


def corner_set(mesh, lattice, bits):
    """As `face_set`, with the codes of texture coordinates of `bits` digits: (m, 15)."""
    place = np.rint(lattice.coordinates(mesh.vertices)).astype(np.int64)
    corner = np.concatenate([place, np.rint(mesh.uv.astype(np.float64) * 2.0**bits).astype(np.int64)], axis=1)[
        mesh.faces
    ]
    apart = (corner[..., :3] != np.roll(corner[..., :3], 1, axis=1)).any(axis=2).all(axis=1)
    rows = [min(tuple(np.roll(face, -k, axis=0).reshape(-1)) for k in range(3)) for face in corner[apart]]
    return np.array(sorted(rows), np.int64).reshape(-1, 15)


def damaged(data, stream: bytes) -> bytes:
    """`stream` with a few bytes changed, perhaps cut off; data: hypothesis's."""
    changed = bytearray(stream)
    for _ in range(data.draw(st.integers(1, 4))):
        changed[data.draw(st.integers(0, len(changed) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(0, len(changed)))
    return bytes(changed[:cut] if data.draw(st.booleans()) else changed)
