"""The residual of a scene: every encoded camera drawn, taken from its photograph, and coded as a video."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_10bit import MIN_SIDE_TEXELS
from eigenfield.coding.video.av1 import Planes, encode_video
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.observations import CalibratedObservations
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Residual, Scene
from eigenfield.core.viewplane import find_grid, fit_view_plane
from eigenfield.encoding.residual.colour import to_planes
from eigenfield.encoding.residual.views import surface_colours
from eigenfield.rendering import Renderer, camera_colour, camera_weights
from eigenfield.runtime.parallel import parallel_stream

RESIDUAL_DEFAULT_QUALITY = 40
RESIDUAL_CODE_UNIT = 1 / 510  # what a code of luma stands for: every difference of photographs has one
RESIDUAL_CHROMA_GAIN = 1.6  # codes of chroma are as much finer
RESIDUAL_FULL_CHROMA_QUALITY = 90  # from which chroma is as fine as luma: half as fine it limits Tarot to 43.5 dB
RESIDUAL_MAX_COLUMNS_PX, RESIDUAL_MAX_ROWS_PX = 16_384, 8_704  # that SVT-AV1 takes
RESIDUAL_SVT_PRESET = 2  # 4 loses 0.1 dB at equal bytes, 1 gains 0.04 (Tarot)


def with_residual(
    scene: Scene,
    capture: CalibratedObservations,
    quality: int = RESIDUAL_DEFAULT_QUALITY,
    progress: Progress | None = None,
) -> Scene:
    """The scene with a residual.

    Args:
        scene: As its file gives it back (`gltf.read_scene`), since the residual holds what coding has lost too.
        capture: What it was encoded from.
        quality: Of the video, 0 to 100 (`crf_of`).

    Raises:
        OptionError: `not-photographs` for a scene that is not R, G, B; as `check_residual`.
        CaptureError: A photograph cannot be read.
    """
    if scene.appearance.channels != 3:
        message = f"the scene has {scene.appearance.channels} channels, not R, G, B"
        raise OptionError("not-photographs", message, remedy="leave the residual out")
    encoded, cameras = scene.rig.encoded, scene.rig.encoded_cameras
    rows, columns = check_residual(cameras, quality)
    scale = RESIDUAL_CODE_UNIT, RESIDUAL_CODE_UNIT / RESIDUAL_CHROMA_GAIN
    renderer, full_chroma = Renderer(scene), quality >= RESIDUAL_FULL_CHROMA_QUALITY

    def planes(row: int) -> Planes:
        index = int(encoded[row])
        shown = capture.photograph(index)
        drawn = renderer.draw(
            scene.rig.cameras[index], camera_weights(scene, index), colour=camera_colour(scene, index)
        )
        counted = drawn.coverage > 0 if shown.mask is None else (drawn.coverage > 0) & (shown.mask > 0.5)
        return to_planes(
            (shown.pixels - surface_colours(drawn)) * counted[..., None], (rows, columns), scale, full_chroma
        )

    order = video_order(cameras)
    frames = track(parallel_stream(planes, order.tolist()), "residual", len(order), progress)
    residual = Residual(b"", (rows, columns), order, scale, full_chroma, smooth_edges=True)
    video = encode_video(frames, residual.frame, crf_of(quality), RESIDUAL_SVT_PRESET)
    settings = {**scene.settings, "residual": {"quality": quality}}
    return replace(scene, residual=replace(residual, video=video), settings=settings)


def check_residual(cameras: Sequence[Camera], quality: int) -> tuple[int, int]:
    """Rows and columns of the pictures in a video of these cameras.

    Raises:
        OptionError: `residual-quality` outside 0 to 100, `residual` where the encoder does not take frames so large.
    """
    if not 0 <= quality <= 100:
        raise OptionError("residual-quality", f"a residual of quality {quality}", remedy="use 0 to 100")
    rows, columns = (_even_side(max(sides)) for sides in ([c.height for c in cameras], [c.width for c in cameras]))
    high = 3 * rows if quality >= RESIDUAL_FULL_CHROMA_QUALITY else rows
    if columns > RESIDUAL_MAX_COLUMNS_PX or high > RESIDUAL_MAX_ROWS_PX:
        most, half_chroma_fits = f"{RESIDUAL_MAX_COLUMNS_PX}x{RESIDUAL_MAX_ROWS_PX}", rows <= RESIDUAL_MAX_ROWS_PX
        less = f"ask for less than {RESIDUAL_FULL_CHROMA_QUALITY}"
        remedy = less if half_chroma_fits else "scale the photographs down"
        raise OptionError("residual", f"frames of {columns}x{high}, the film's encoder takes {most}", remedy=remedy)
    return rows, columns


def crf_of(quality: int) -> int:
    """SVT-AV1's crf, 63 (coarse) at quality 0 to 1 at 100."""
    return round(63 - 0.62 * quality)


def _even_side(side: int) -> int:
    return max(MIN_SIDE_TEXELS, side + side % 2)


def video_order(cameras: Sequence[Camera]) -> NDArray[np.int64]:
    """The order of the cameras: a grid's row by row, to and fro; else from each to the nearest that is left.

    On Tarot the grid's rows all in one direction take 3 % more bytes at equal luma, from the middle outwards 9 %.
    """
    centres = np.array([camera.centre for camera in cameras])
    grid = find_grid(fit_view_plane(cameras).coordinates(centres))
    if grid is None:
        return _nearest(centres)
    order = grid.index.astype(np.int64)
    order[1::2] = order[1::2, ::-1].copy()
    return np.ascontiguousarray(order.ravel())


def _nearest(centres: NDArray[np.float64]) -> NDArray[np.int64]:
    """From the camera farthest from the middle, each time to the nearest one left."""
    left = np.ones(len(centres), bool)
    order = [int(np.argmax(np.linalg.norm(centres - centres.mean(axis=0), axis=1)))]
    left[order[0]] = False
    while left.any():
        distance = np.linalg.norm(centres - centres[order[-1]], axis=1)
        order.append(int(np.argmin(np.where(left, distance, np.inf))))
        left[order[-1]] = False
    return np.array(order, np.int64)
