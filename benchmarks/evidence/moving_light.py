"""The demo's scene as a clip: geometry and cameras stand still, a lamp and a shadow move.

The lamp behind the cameras goes round, which moves highlights on whatever is glossy. A soft bar of shadow goes to and
fro across floor, wall and objects. What it has not reached stands still. The clip ends where it begins.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from eigenfield.core.mesh import Mesh
from eigenfield.demo.cameras import array_cameras
from eigenfield.demo.capture import DEMO_MAX_ATLAS_TEXELS, DEMO_TEXELS_PER_PIXEL, Look, bake_look
from eigenfield.demo.clip import draw_footage, is_drawn
from eigenfield.demo.geometry import build_geometry, build_surroundings
from eigenfield.demo.light import SOFT_BOXES, environment_map
from eigenfield.demo.motion import lights_at
from eigenfield.imaging.raster import rasterise_atlas
from eigenfield.proxy import write_ply
from eigenfield.runtime.files import make_folder

SHADOW_DEPTH = 0.45  # of the diffuse light
SHADOW_HALF_WIDTH, SHADOW_SWING = 0.45, 0.9  # in units of the scene
PROXY = "proxy.ply"


def draw_clip(folder: Path, rows: int = 5, columns: int = 5, size: int = 320, frames: int = 60) -> Path:
    """The clip's folder, drawn where it is not there yet: `draw_footage`, and proxy.ply, the exact surface. What a run
    that was stopped has drawn is kept.

    Args:
        folder: For the clip.
        rows: Of the array.
        columns: Of the array.
        size: Side of the pictures in pixels.
        frames: One turn of lamp and shadow.
    """
    if not is_drawn(folder):
        make_folder(folder)
        write_ply(build_geometry().mesh, folder / PROXY, overwrite=True)
        look_at = moving_look(min(DEMO_TEXELS_PER_PIXEL * size, DEMO_MAX_ATLAS_TEXELS))
        draw_footage(folder, array_cameras(rows, columns, size), columns, look_at, frames)
    return folder


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
            room=environment_map(lights_at(time)),
        )

    return at


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
