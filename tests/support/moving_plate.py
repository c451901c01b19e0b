"""A plate that slides and turns before a backdrop, drawn exactly: the mesh of each frame, and what nine cameras see."""

from __future__ import annotations

import numpy as np

from eigenfield.core.mesh import Mesh
from eigenfield.rendering import draw_texture
from support.captures import backdrop, shaded_texture
from support.coded_meshes import joined
from support.moving_clips import FootageInMemory
from support.observations import CalibratedInMemory, InMemory
from support.scenes import bumpy_square, row_grid

CAMERAS = row_grid(9, 64, 56)


def staged(frame, speed=1.0):
    """The mesh of a frame: the backdrop in the left half of the atlas, the plate in the right half."""
    behind, plate = backdrop(), bumpy_square(8)
    turn = 0.06 * speed * frame
    c, s = np.cos(turn), np.sin(turn)
    place = plate.vertices * 0.55 @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]], np.float32).T
    place += np.array([-0.7 + 0.14 * speed * frame, 0.1, -0.9 - 0.03 * speed * frame], np.float32)
    half = np.array([0.46, 0.96], np.float32)
    mesh, _ = joined([
        Mesh(behind.vertices, behind.faces, behind.uv * half + np.float32(0.02)),
        Mesh(place.astype(np.float32), plate.faces, plate.uv * half + np.array([0.52, 0.02], np.float32)),
    ])  # fmt: skip
    return mesh


def seen(mesh):
    """What the nine cameras see of a mesh; a highlight wanders with the camera."""
    pictures = []
    for index, camera in enumerate(CAMERAS):
        pictures.append(draw_texture(mesh, shaded_texture(index, 9, 256), camera, samples=3).image)
    return CalibratedInMemory(InMemory([np.clip(one, 0, 1).astype(np.float32) for one in pictures]), CAMERAS)


def filmed(frames, speed=1.0):
    """The meshes of so many frames, and the footage."""
    meshes = [staged(frame, speed) for frame in range(frames)]
    return meshes, FootageInMemory([seen(mesh) for mesh in meshes], [])
