"""The demo's scene as a clip: geometry and cameras stand still, a lamp and a shadow move.

The lamp behind the cameras goes round, which moves highlights on whatever is glossy. A soft bar of shadow goes to and
fro across floor, wall and objects. What it has not reached stands still. The clip ends where it begins.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.writers.transforms import transforms_document
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.demo.cameras import array_cameras
from eigenfield.demo.capture import DEMO_MAX_ATLAS_TEXELS, DEMO_TEXELS_PER_PIXEL, Look, bake_look, draw_view
from eigenfield.demo.geometry import build_geometry, build_surroundings
from eigenfield.demo.light import SOFT_BOXES, SoftBox, environment_map
from eigenfield.imaging.raster import rasterise_atlas
from eigenfield.proxy import write_ply
from eigenfield.runtime.parallel import parallel_map

LAMP = 3  # of SOFT_BOXES: it lights nothing that is baked, so that only its reflections move
LAMP_SWING = 0.45  # sideways and upwards
SHADOW_DEPTH = 0.45  # of the diffuse light
SHADOW_HALF_WIDTH, SHADOW_SWING = 0.45, 0.9  # in units of the scene
RATE = 30  # frames a second
TRANSFORMS, PROXY = "transforms.json", "proxy.ply"


def draw_clip(folder: Path, rows: int = 5, columns: int = 5, size: int = 320, frames: int = 60) -> Path:
    """The clip's folder, drawn where it is not there yet: `cam_R_C/NNNNNN.png`, transforms.json with a time for each
    frame, and proxy.ply, the exact surface. What a run that was stopped has drawn is kept.

    Args:
        folder: For the clip.
        rows: Of the array.
        columns: Of the array.
        size: Side of the pictures in pixels.
        frames: One turn of lamp and shadow.
    """
    if (folder / TRANSFORMS).exists():
        return folder
    cameras = array_cameras(rows, columns, size)
    names = [f"cam_{index // columns}_{index % columns}" for index in range(len(cameras))]
    for name in names:
        (folder / name).mkdir(parents=True, exist_ok=True)
    write_ply(build_geometry().mesh, folder / PROXY, overwrite=True)
    look_at = moving_look(min(DEMO_TEXELS_PER_PIXEL * size, DEMO_MAX_ATLAS_TEXELS))
    for frame in range(frames):
        wanted = [(folder / name / f"{frame:06d}.png", camera) for name, camera in zip(names, cameras, strict=True)]
        wanted = [(path, camera) for path, camera in wanted if not path.exists()]
        if wanted:
            look = look_at(frame / frames)
            parallel_map(partial(_draw, look), wanted)
    write_timed(folder, names, cameras, frames)
    return folder


def _draw(look: Look, one: tuple[Path, Camera]) -> None:
    write_picture(one[0], draw_view(one[1], look))


def write_timed(folder: Path, names: Sequence[str], cameras: Sequence[Camera], frames: int) -> None:
    """transforms.json of a clip whose frames lie in the cameras' folders as NNNNNN.png, each with its time."""
    views = tuple(View(name, folder / name / "000000.png", camera) for name, camera in zip(names, cameras, strict=True))
    document = transforms_document(LightField(folder, views, (), "transforms"), folder, None)
    document["fps"] = RATE
    document["frames"] = [
        {**entry, "file_path": entry["file_path"].replace("000000", f"{frame:06d}"), "time": frame / RATE}
        for entry in document["frames"]
        for frame in range(frames)
    ]
    (folder / TRANSFORMS).write_text(json.dumps(document), encoding="utf-8")


def moving_look(side: int) -> Callable[[float], Look]:
    """What the views of a time share, for times of 0 to 1, which is the whole turn.

    Args:
        side: Of the surface's atlas, in texels.
    """
    still = bake_look(side)
    places = _texel_places(build_geometry().mesh, side)
    around = _texel_places(build_surroundings().mesh, still.around.shape[0])

    def at(time: float) -> Look:
        return still._replace(
            surface=_in_shadow(still.surface, places, time),
            around=_in_shadow(still.around, around, time),
            room=environment_map(_lights(time)),
        )

    return at


def _lights(time: float) -> list[SoftBox]:
    angle = 2 * np.pi * time
    lights = list(SOFT_BOXES)
    x, y, z = lights[LAMP].direction
    lights[LAMP] = lights[LAMP]._replace(
        direction=(x + LAMP_SWING * np.sin(angle) - 0.3, y + LAMP_SWING * np.cos(angle) - 0.2, z)
    )
    return lights


def _in_shadow(surface: NDArray[np.float32], places: NDArray[np.float32], time: float) -> NDArray[np.float32]:
    """The baked surface with its diffuse light dimmed where the bar is."""
    middle = SHADOW_SWING * np.sin(2 * np.pi * time)
    off = np.minimum(np.abs(places - np.float32(middle)) / SHADOW_HALF_WIDTH, 1)
    dimmed = surface.copy()
    dimmed[..., :3] *= (1 - SHADOW_DEPTH * np.square(1 - np.square(off)))[..., None]
    return dimmed


def _texel_places(mesh: Mesh, side: int) -> NDArray[np.float32]:
    """(side, side) how far each texel is along the way of the shadow, square to the key light; charts are extended
    into the gutters, as those of the baked surface are."""
    across = np.cross((0.0, 1.0, 0.0), SOFT_BOXES[0].direction)
    across /= np.linalg.norm(across)
    raster = rasterise_atlas(mesh, side, side)
    row, column = np.nonzero(raster.face >= 0)
    face = raster.face[row, column]
    weights = np.einsum("nke,ne->nk", raster.edges[face], np.stack([column + 0.5, row + 0.5, np.ones(len(row))], 1))
    places = np.zeros((side, side), np.float32)
    places[row, column] = ((mesh.vertices.astype(np.float64) @ across)[mesh.faces[face]] * weights).sum(axis=1)
    nearest = distance_transform_edt(raster.face < 0, return_distances=False, return_indices=True)
    return np.ascontiguousarray(places[tuple(nearest)])


def write_picture(path: Path, picture: NDArray[np.uint8]) -> None:
    """A PNG of (H, W, 3) R, G, B, whole or not at all."""
    part = path.with_suffix(".part.png")
    if not cv2.imwrite(str(part), picture[..., ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 3]):
        raise OSError(f"{part} cannot be written")
    part.replace(path)
