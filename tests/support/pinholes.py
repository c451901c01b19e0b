"""A crumpled square and a thousand eyes on it: neighbouring triangles cover every pixel between them exactly once."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from eigenfield.core.appearance import Plane
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.core.scene import Scene
from eigenfield.gltf import save
from support.scenes import tiny_scene

EYES, WIDTH, HEIGHT, NODES = 1000, 24, 18, 13
OPACITY = 0.5  # a pixel that is covered twice shows 0.75, a pinhole 0


def crumpled() -> Mesh:
    """A square of two charts that meet in doubled vertices, from -1 to 1, facing -z. Some of its triangles are slivers,
    its middle is a grid on whole pixels of `eyes`."""
    random = np.random.default_rng(3)
    y, x = np.mgrid[0:NODES, 0:NODES].astype(np.float64)
    off = random.choice([0.0, 0.3, 0.4999], (2, NODES, NODES)) * random.choice([-1, 1], (2, NODES, NODES))
    off[:, [0, -1]] = off[:, :, [0, -1]] = 0
    off[:, 4:9, 4:9] = 0
    z = np.where(off[0] == 0, 0, random.normal(0, 0.02, x.shape))
    step = 2 / (NODES - 1)
    vertices = np.stack([(x + off[0]) * step - 1, (y + off[1]) * step - 1, z], axis=-1).reshape(-1, 3)
    corner = (np.arange(NODES - 1)[:, None] * NODES + np.arange(NODES - 1)).ravel()
    a, b, c, d = corner, corner + 1, corner + NODES + 1, corner + NODES
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    right = faces.min(axis=1) % NODES >= NODES // 2
    faces[right] += NODES * NODES
    uv = np.concatenate([np.full((NODES * NODES, 2), at) for at in (0.25, 0.75)])
    return Mesh(np.tile(vertices, (2, 1)).astype(np.float32), faces.astype(np.int32), uv.astype(np.float32))


def eyes() -> Iterator[Camera]:
    """Cameras that the square fills. From every second one edges run through the middles of pixels."""
    random = np.random.default_rng(4)
    for index in range(EYES):
        if index % 2:
            turn, focal, centre = random.normal(0, 0.05, 3), 50.0, random.uniform(-0.2, 0.2, 2)
        else:
            turn, focal = np.array([0, 0, index // 2 % 8 * np.pi / 4]), 24.0 * (1 + index % 3)
            centre = random.integers(-8, 9, 2) / 48
        R = cv2.Rodrigues(turn)[0]
        K = np.array([[focal, 0, (WIDTH + index % 5) / 2], [0, focal, HEIGHT / 2], [0, 0, 1]])
        yield Camera(K, R, -R @ np.append(centre, -1), WIDTH, HEIGHT)


def painted(sheets: bool) -> Scene:
    """The square in one dark colour, half opaque or as an opaque surface."""
    mesh, tiny = crumpled(), tiny_scene(textures=0)
    opacity = np.full((32, 32), OPACITY, np.float32)
    mean = np.zeros((32, 32, 3), np.float32)
    proxy = Proxy(mesh, None, Sheets((len(mesh.faces),), opacity) if sheets else None)
    return replace(tiny, proxy=proxy, appearance=replace(tiny.appearance, planes=(Plane(mean, ()),)))


def write(folder: Path) -> None:
    """Write pinholes.glb and, as the web viewer has cameras, pinholes.json."""
    save(painted(sheets=True), folder / "pinholes.glb", codec="png", overwrite=True)
    views = [
        {"K": eye.K.tolist(), "R": eye.R.tolist(), "centre": eye.centre.tolist(), "width": WIDTH, "height": HEIGHT}
        for eye in eyes()
    ]
    (folder / "pinholes.json").write_text(json.dumps(views), encoding="utf-8")
