"""A ball before a wall, cameras that look at them, and photographs drawn of them."""

from __future__ import annotations

import numpy as np
import trimesh

from eigenfield.capture.lightfield import LightField, View
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import Photograph
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.background import join_meshes
from eigenfield.proxy.surface.fusion import DepthView


def looking(centre, at, focal=140.0, width=160, height=120):
    """A camera at `centre` that looks at `at`, y down."""
    z = np.array(at, float) - centre
    z /= np.linalg.norm(z)
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    R = np.stack([x, np.cross(z, x), z])
    return Camera(np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1.0]]), R, -R @ centre, width, height)


def square(half, z, nodes=30):
    """A square across the z axis that faces -z."""
    steps = np.linspace(-half, half, nodes)
    x, y = np.meshgrid(steps, steps)
    first = (np.arange(nodes - 1)[:, None] * nodes + np.arange(nodes - 1)).ravel()
    faces = np.concatenate(
        [
            np.stack([first, first + nodes, first + 1], axis=1),
            np.stack([first + 1, first + nodes, first + nodes + 1], axis=1),
        ]
    )
    return Mesh(np.stack([x, y, np.full_like(x, z)], axis=-1).reshape(-1, 3).astype(np.float32), faces.astype(np.int32))


def ball(centre=(0, 0, 0), radius=1.0, level=4):
    shape = trimesh.creation.icosphere(level, radius=radius)
    return Mesh((shape.vertices + np.array(centre)).astype(np.float32), shape.faces.astype(np.int32))


def ball_before_wall():
    """A unit ball at the origin before a wall at z = 1.2."""
    return join_meshes(ball(level=5), square(4, 1.2))


def nine_cameras():
    return [looking(np.array([x, y, -5.0]), (0, 0, 0.5)) for y in (-1.5, 0, 1.5) for x in (-2, 0, 2.0)]


def depth_views(mesh, cameras, **more):
    return [DepthView(camera, rasterise_view(mesh, camera).inverse_depth, **more) for camera in cameras]


def truth(positions):
    """Distance from the scene's true surfaces."""
    return np.minimum(np.abs(np.linalg.norm(positions, axis=1) - 1), np.abs(positions[:, 2] - 1.2))


class Drawn(LightField):
    """A light field whose photographs are computed: a texture fixed to the surface."""

    def __init__(self, mesh, cameras, mask=None):
        views = tuple(View(f"{i}.png", None, camera) for i, camera in enumerate(cameras))
        super().__init__(None, views, (), "drawn")
        object.__setattr__(self, "_drawn", (mesh, mask))

    def photograph(self, index):
        mesh, mask = self._drawn
        camera = self.views[index].camera
        raster = rasterise_view(mesh, camera)
        x, y = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
        rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(camera.K).T
        depth = 1 / np.maximum(raster.inverse_depth, 1e-9)
        world = (rays * depth[..., None] - camera.t) @ camera.R
        waves = np.random.default_rng(1).normal(size=(24, 3)) * np.geomspace(2, 22, 24)[:, None]
        phase = np.random.default_rng(2).uniform(0, 6, (24, 3))
        value = np.sin(np.einsum("hwk,nk->hwn", world, waves)[..., None] + phase).mean(axis=2)
        pixels = np.clip(0.5 + 1.2 * value, 0, 1).astype(np.float32)
        pixels[raster.face < 0] = 0
        return Photograph(pixels, None if mask is None else mask[index].astype(np.float32))


def relief(camera: Camera, phase: float, virtual: bool, step: int = 1) -> Mesh:
    """Every `step`-th pixel of a camera pushed into depth, in a mesh whose texture coordinates they are."""
    y, x = np.mgrid[0:40:step, 0:48:step].astype(np.float64) + phase
    rows, columns = x.shape
    depth = 3 + 0.5 * np.sin(x / 7) * np.cos(y / 5)
    rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(camera.K).T
    points = (rays * depth[..., None]).reshape(-1, 3) @ camera.R + camera.centre
    if not virtual:  # some vertices between pixels, as contours have them
        y.ravel()[::5] += 0.25
        points = ((np.stack([x, y, np.ones_like(x)], -1) @ np.linalg.inv(camera.K).T) * depth[..., None]).reshape(-1, 3)
        points = points @ camera.R + camera.centre
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    upper = np.stack([corner, corner + 1, corner + columns], axis=1)
    faces = np.concatenate([upper, np.stack([corner + 1, corner + columns + 1, corner + columns], axis=1)])
    uv = np.stack([x.ravel() + 5, y.ravel() + 9], axis=1) / 64
    return Mesh(points.astype(np.float32), faces.astype(np.int32), uv.astype(np.float32))
