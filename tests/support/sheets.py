"""Scenes of soft sheets, and the plain definition of their pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.core.scene import Scene
from eigenfield.rendering import Renderer, ViewWeights, draw_texture
from support.composed import finer
from support.scenes import smooth_pictures


def stacked(scene: Scene, mesh: Mesh, count: int = 3, size: tuple[int, int] | None = None, step: float = 0.3) -> Scene:
    """The scene with `count` copies of a mesh one behind the other, each in a strip of the atlas of its own.

    A sheet is moved towards -z, to the cameras, by `step`. Opacity is smooth, 0 in places and 1 in others.

    Args:
        scene: Its appearance and cameras stay.
        mesh: Whose UVs cover the atlas.
        count: Of the sheets.
        size: Of the opacity. Default: as the atlas.
        step: Between sheets.
    """
    vertices, faces, uv = [], [], []
    for sheet in range(count):
        faces.append(mesh.faces + sheet * len(mesh.vertices))
        vertices.append(mesh.vertices - np.array([0, 0, sheet * step], np.float32))
        uv.append((mesh.uv * (1, 0.96) + (0, sheet + 0.02)) / (1, count))
    whole = Mesh(np.concatenate(vertices), np.concatenate(faces), np.concatenate(uv).astype(np.float32))
    waves = smooth_pictures(1, *(size or scene.appearance.atlas), 1, seed=7)[0, ..., 0]
    opacity = np.clip(0.5 + 1.5 * waves, 0, 1)
    return replace(scene, proxy=Proxy(whole, None, Sheets((len(mesh.faces),) * count, opacity)))


def sheet_pictures(
    scene: Scene, texture: np.ndarray, camera: Camera, filter: str, samples: int
) -> tuple[np.ndarray, np.ndarray]:
    """Picture and opacity of each sheet alone, back to front, by drawing it as an opaque surface."""
    sheets, mesh = scene.proxy.sheets, scene.proxy.mesh
    assert sheets is not None
    starts = np.concatenate([[0], np.cumsum(sheets.faces)])
    drawn = []
    opacity = finer(sheets.opacity[..., None], *scene.appearance.atlas)
    both = np.concatenate([texture, opacity], axis=2, dtype=np.float32)
    big = camera.resize(camera.width * samples, camera.height * samples)
    for first, last in pairwise(starts):
        alone = replace(mesh, faces=mesh.faces[first:last])
        drawn.append(draw_texture(alone, both, big, filter=filter, samples=1).image)
    return np.stack(drawn)[..., :-1], np.clip(np.stack(drawn)[..., -1], 0, 1)


def composited(
    scene: Scene,
    weights: ViewWeights,
    camera: Camera,
    *,
    filter: str = "bicubic",
    samples: int = 1,
    background: Sequence[float] = (0.0,),
) -> tuple[np.ndarray, np.ndarray]:
    """Picture (H, W, C) and coverage (H, W) by the definition: sheet over sheet, back to front.

    Args:
        scene: With sheets.
        weights: What is blended.
        camera: The camera.
        filter: As of `Renderer.draw`.
        samples: k.
        background: As of `Renderer.draw`.
    """
    own = replace(scene, proxy=replace(scene.proxy, sheets=None))
    colours, opacities = sheet_pictures(scene, Renderer(own).texture(weights), camera, filter, samples)
    picture = np.broadcast_to(np.float32(background), colours[0].shape).astype(np.float64)
    open_ = np.ones(picture.shape[:2])
    for colour, part in zip(colours, opacities, strict=True):
        picture = (1 - part[..., None]) * picture + part[..., None] * colour
        open_ = open_ * (1 - part)
    height, width = camera.height, camera.width
    mean = picture.reshape(height, samples, width, samples, -1).mean(axis=(1, 3))
    return mean, 1 - open_.reshape(height, samples, width, samples).mean(axis=(1, 3))
