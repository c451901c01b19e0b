"""Captures whose photographs a scene has drawn itself, changed where a test wants it."""

from __future__ import annotations

import json

import cv2
import numpy as np

from eigenfield.capture import LightField, View
from eigenfield.core.camera import Camera
from eigenfield.rendering import Renderer, camera_weights

HELD = (4,)


def drawn(scene, index):
    """What the scene shows of one of its cameras, with 8 bits."""
    return Renderer(scene).draw(scene.rig.cameras[index], camera_weights(scene, index)).to_uint8()


def write_capture(scene, folder, change=None, masks=None, only=None):
    """Photographs as the scene draws them, `change`d, with their transforms.json; a LightField of them."""
    folder.mkdir(exist_ok=True)
    views, frames = [], []
    for index, (name, camera) in enumerate(zip(scene.rig.names, scene.rig.cameras, strict=True)):
        if only is not None and index not in only:
            continue
        picture = drawn(scene, index)
        if change is not None:
            picture = change(index, picture)
        path = folder / f"{name}.png"
        cv2.imwrite(str(path), picture[..., ::-1])
        mask = None
        if masks is not None:
            mask = folder / f"{name}.mask.png"
            cv2.imwrite(str(mask), masks(index))
        views.append(View(name, path, camera, mask=mask))
        frames.append(frame(name, camera))
    (folder / "transforms.json").write_text(json.dumps({"frames": frames}))
    return LightField(folder, tuple(views), (), "transforms")


def frame(name, camera: Camera):
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = camera.R, camera.t
    world = np.linalg.inv(pose) @ np.diag([1.0, -1.0, -1.0, 1.0])
    K = camera.K
    return {
        "file_path": f"{name}.png", "fl_x": K[0, 0], "fl_y": K[1, 1], "cx": K[0, 2], "cy": K[1, 2],
        "w": camera.width, "h": camera.height, "transform_matrix": world.tolist(),
    }  # fmt: skip


def lighter(at):
    """Ten grey levels more (or less, where there is no room) on camera `at`'s photograph."""

    def change(index, picture):
        return np.where(picture < 128, picture + 10, picture - 10).astype(np.uint8) if index == at else picture

    return change
