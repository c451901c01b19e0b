"""A draft: a scene to look around in within half a minute, from fewer and smaller photographs, without a fit.

Cameras and surface come from the same stages as those of the whole scene, and the textures are the paper's.
"""

from __future__ import annotations

import logging
import os
from dataclasses import replace

import numpy as np

from eigenfield.capture import Capture, LightField
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene
from eigenfield.core.spread import spread_indices
from eigenfield.encoding.options import EncodeOptions
from eigenfield.proxy.surface.neighbours import spread_views
from eigenfield.reconstruction import SurfaceOptions
from eigenfield.reconstruction.unseen import held_out_names, without
from eigenfield.reconstruction.whole import reconstruct

log = logging.getLogger("eigenfield.encode")

# Chosen on the cube, Antinous and Temple
DRAFT_MAX_VIEWS = 25
DRAFT_SURFACE_PIXELS = 800_000  # of all photographs together, from which cameras and surface are made
DRAFT_TEXTURE_PIXELS = 4_000_000  # of all photographs together, from which the textures are made
DRAFT_MIN_SIDE = 180  # pixels, below which photographs are not made smaller
DRAFT_TRIANGLES = 2500
DRAFT_TEXTURES = 8
DRAFT_ATLAS = 1024  # side of the atlas, at most, texels
DRAFT_WORTH_SECONDS = 40.0  # a scene that takes no longer is made at once
DRAFT_KEY = "draft"  # of a draft's settings: how many times smaller its photographs are, along one axis


def make_draft(
    capture: Capture,
    proxy: str | os.PathLike[str] | Mesh | Proxy | None,
    options: EncodeOptions,
    surface: SurfaceOptions | None,
    progress: Progress | None = None,
) -> Scene:
    """A scene without a fit from some of the photographs, made smaller, without scores.

    Its cameras have the photographs' own size.

    Args:
        capture: Photographs, with cameras if there is a proxy.
        proxy: None: it is made.
        options: Of the whole scene, of which the draft takes what is not about quality and size.
        surface: Of the whole scene; None where the proxy is given.

    Raises:
        CaptureError, ProxyError, OptionError: As `encode`, of which some may not apply to the whole scene.
    """
    from eigenfield.encoding import encode

    chosen = _some_views(capture, options)
    if proxy is None:
        factor = _factor(chosen, DRAFT_SURFACE_PIXELS)
        whole = surface or SurfaceOptions()
        opaque = replace(
            whole,
            surface="auto" if whole.surface == "layers" else whole.surface,
            layers=1,
            fit_spheres=(),  # whose regions are in pixels of the whole photographs
            triangles=min(DRAFT_TRIANGLES, whole.triangles),
            blind=None,  # who is held out takes no part at all
            hold_out=None,
        )
        reconstruction = reconstruct(chosen.reduced(factor), opaque, progress=_within(progress))
        proxy, chosen = reconstruction.proxy, _as_photographed(reconstruction.light_field, chosen, factor)
    assert isinstance(chosen, LightField)
    factor = _factor(chosen, DRAFT_TEXTURE_PIXELS)
    small = chosen.reduced(factor)
    reference = options.reference if options.reference in small.names else None
    pixels = max(camera.width * camera.height for camera in small.cameras)
    plain = EncodeOptions(
        fit="none",
        textures=min(DRAFT_TEXTURES, len(small) - 1),
        atlas=min(DRAFT_ATLAS, round(2 * np.sqrt(pixels))),
        metres_per_unit=options.metres_per_unit,
        reference=reference,
        rights=options.rights,
    )
    scene = encode(small, proxy, plain, progress=_within(progress))
    recorded = {**scene.settings["photographs"], "pixels": sum(width * height for width, height in chosen.sizes)}
    return replace(
        scene,
        rig=replace(scene.rig, cameras=tuple(camera.to_float32() for camera in chosen.cameras)),
        settings={**scene.settings, "photographs": recorded, DRAFT_KEY: factor},
        scores={},
    )


def _some_views(capture: Capture, options: EncodeOptions) -> Capture:
    """The photographs that are not held out, and of these as many as a draft takes: every so many rows and columns of a
    grid, or spread over the cameras, or over their order."""
    rule = options.hold_out
    known = capture.light_field is not None or capture.layout is not None
    shown = (
        capture if rule is None or (rule == "odd" and not known) else without(capture, held_out_names(rule, capture))
    )
    count, most = len(shown), DRAFT_MAX_VIEWS
    if count <= most:
        return shown
    if shown.layout is not None:
        step = int(np.ceil(np.sqrt(count / most)))
        rows, columns = (np.unique(nodes)[::step] for nodes in (shown.layout.rows, shown.layout.columns))
        on_both = np.isin(shown.layout.rows, rows) & np.isin(shown.layout.columns, columns)
        return shown.subset(np.flatnonzero(on_both).tolist())
    if shown.light_field is not None:
        return shown.subset(spread_views(shown.light_field.cameras, most))
    return shown.subset(spread_indices(count, most))


def _factor(capture: Capture, pixels: int) -> int:
    """By how much photographs are made smaller so that all together have about so many pixels."""
    sizes = np.array(capture.sizes)
    wanted = int(np.ceil(np.sqrt(sizes.prod(axis=1).sum() / pixels)))
    return max(1, min(wanted, int(sizes.min()) // DRAFT_MIN_SIDE))


def _as_photographed(made: LightField, capture: Capture, factor: int) -> LightField:
    """A light field of photographs that were made smaller, at their own sizes."""
    place = {name: index for index, name in enumerate(capture.names)}
    whole = capture.subset([place[name] for name in made.names])
    scale = np.diag([factor, factor, 1.0])
    cameras = [
        replace(view.camera, K=scale @ view.camera.K, width=width, height=height)
        for view, (width, height) in zip(made.views, whole.sizes, strict=True)
    ]
    again = whole.with_cameras(cameras, [view.lens for view in made.views])
    return replace(again, origin=made.origin, layout=whole.layout)


def _within(progress: Progress | None) -> Progress | None:
    """A progress that is not told of steps: a draft is one of them."""
    return None if progress is None else lambda stage, done, total: progress(stage, done, total)
