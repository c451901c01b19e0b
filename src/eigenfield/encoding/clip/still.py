"""Photographs of footage averaged over time, and the surface that they show.

A frame alone shows what passes through, and noise. Where a camera sees the same in most of the frames, the average of
these frames stands for it. What never stands still is as in the middle frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import OptionError
from eigenfield.core.observations import Photograph
from eigenfield.core.progress import Progress, begin_step
from eigenfield.core.proxy import MovingProxy, Proxy
from eigenfield.encoding.clip.digest import footage_digest
from eigenfield.encoding.clip.moving import moving_proxy
from eigenfield.encoding.clip.rest import (
    MARGIN_PIXELS,
    MIN_FRAMES,
    NOISE_MAX,
    RANGE_SIGMAS,
    WINDOW_PIXELS,
    camera_at_rest,
)
from eigenfield.encoding.estimated import estimate, surface_to_make
from eigenfield.encoding.options import EncodeOptions
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.png import png_bytes
from eigenfield.reconstruction import SurfaceOptions
from eigenfield.runtime.parallel import tracked_map
from eigenfield.runtime.stages import SCENE_ROOMS, Stages, stage_key

if TYPE_CHECKING:
    from eigenfield.capture import Capture
    from eigenfield.capture.footage import Footage

MAX_FRAMES = 15  # that are looked at: noise falls to a quarter, and a camera's frames lie in memory at once
AWAY_CODES = round(255 * RANGE_SIGMAS * NOISE_MAX / 2)  # of a window from its usual value, which is something else
PICTURE_FILE = "{:04d}.png"


def surface_of_clip(asked: EncodeOptions, given: SurfaceOptions, has_proxy: bool) -> SurfaceOptions | None:
    """The options of `reconstruct` for a clip: an opaque surface; None where the proxy is given.

    Raises:
        OptionError: `clip-proxy`, sheets are asked for; and those of `surface_to_make`.
    """
    surface = surface_to_make(asked, given, blind=False, has_proxy=has_proxy)
    if surface is None:
        return None
    if surface.surface == "layers" or (surface.layers or 1) > 1:
        refuse_sheets()
    return replace(surface, layers=1)


def refuse_sheets() -> NoReturn:
    """Raise OptionError `clip-proxy`."""
    remedy = "leave out the layers, or give a mesh"
    raise OptionError("clip-proxy", "a clip is encoded on one opaque surface, not on sheets", remedy=remedy)


def estimate_still_surface(
    footage: Footage, asked: EncodeOptions, surface: SurfaceOptions, work: Path | None, progress: Progress | None
) -> tuple[Footage, Proxy | MovingProxy, EncodeOptions]:
    """The surface of footage whose cameras are known, as finished stages, with a sheet for what moves where that pays.

    Args:
        surface: Of `surface_of_clip`.

    Returns:
        The footage with the cameras for which the surface was made, the surface, and the options of what follows.

    Raises:
        CaptureError, ProxyError, OptionError, OutputError: As `reconstruct`.
    """
    with Stages(work) as stages:
        still = still_capture(footage, stages, progress)
        made = estimate(still, asked, surface, work or stages.folder, None, progress)
        views = made.light_field.views
        shown = footage.subset(footage.names.index(view.name) for view in views)
        shown = shown.with_cameras(made.light_field.cameras, [view.lens for view in views])
        texture_maps = asked.resolved().fit == "none"  # they know one opaque surface
        moving = None if texture_maps else moving_proxy(shown, made, stages, progress)
        if moving is not None and work is None:  # the folder goes, and the file in it
            moving = replace(moving, opacity=np.array(moving.opacity))
    return shown, moving or made.proxy, replace(asked, triangles=None, hold_out=made.hold_out)


def frames_of_still(footage: Footage) -> list[int]:
    """The frames that are looked at, spread over the footage, the middle one among them."""
    spread = np.linspace(0, len(footage) - 1, min(len(footage), MAX_FRAMES)).round().astype(int).tolist()
    return sorted({*spread, len(footage) // 2})


def still_capture(footage: Footage, stages: Stages, progress: Progress | None = None) -> Capture:
    """What all cameras see of what stands still, elsewhere the middle frame.

    Args:
        stages: Where the pictures lie, as a finished stage.

    Raises:
        CaptureError: A frame cannot be read.
        OutputError: The folder cannot be written.
    """
    chosen, middle = frames_of_still(footage), len(footage) // 2
    instant = footage.instant(middle)
    if len(chosen) < MIN_FRAMES:
        return instant
    key = stage_key([footage_digest(footage), chosen], SCENE_ROOMS)
    cameras = range(len(instant))

    def build(folder: Path) -> None:
        begin_step(progress, "still photographs")
        frames = [footage.photographs(number) for number in chosen]

        def write(camera: int) -> None:
            codes, masks = [], []
            for one in frames:
                photograph = one.photograph(camera)
                codes.append(to_codes(photograph.pixels))
                masks.append(photograph.mask)
            made = still_photograph(np.stack(codes), masks, chosen.index(middle))
            pixels = made.pixels if made.mask is None else np.dstack([made.pixels, made.mask])
            (folder / PICTURE_FILE.format(camera)).write_bytes(png_bytes(pixels))

        tracked_map(write, cameras, "averaging over time", progress)

    folder = stages.run("still", key, build)

    def shown(source: Any, camera: int) -> Any:
        own = {"mask": None, "picture": None, "upright": True, "exposure": None, "reduction": 1}
        return replace(source, path=folder / PICTURE_FILE.format(camera), **own)

    if instant.light_field is None:
        return replace(instant, shots=tuple(map(shown, instant.shots, cameras)))
    return replace(instant, views=tuple(map(shown, instant.views, cameras)))


def still_photograph(codes: NDArray[np.uint8], masks: Sequence[NDArray[np.float32] | None], middle: int) -> Photograph:
    """Frames of a camera averaged where most of them show the same; elsewhere one of them.

    Args:
        codes: (T, h, w, 3) of the frames, in the order of time.
        masks: (h, w) of each, 0..1; None: all of it counts.
        middle: The frame that stands for what never stands still.
    """
    smooth = np.stack([cv2.blur(one, (WINDOW_PIXELS, WINDOW_PIXELS)) for one in codes])
    usual = np.partition(smooth, len(codes) // 2, axis=0)[len(codes) // 2]
    around = np.ones((MARGIN_PIXELS, MARGIN_PIXELS), np.uint8)

    def same(number: int) -> NDArray[np.bool_]:
        away = cv2.absdiff(smooth[number], usual).max(axis=2) > AWAY_CODES
        return cv2.dilate(away.astype(np.uint8), around) == 0

    seen = np.stack([np.ones(codes.shape[1:3], np.bool_) if mask is None else mask > 0.5 for mask in masks])
    alike = seen & np.stack([same(number) for number in range(len(codes))])
    alike &= 2 * alike.sum(axis=0) > seen.sum(axis=0)
    scale = np.float32(255)
    frames = (Photograph(one / scale, counts.astype(np.float32)) for one, counts in zip(codes, alike, strict=True))
    rest = camera_at_rest(frames, len(codes))
    pixels = rest.shown(Photograph(codes[middle] / scale, None)).pixels
    mask = masks[middle]
    return Photograph.of(pixels, None if mask is None else np.maximum(mask, rest.share / scale))
