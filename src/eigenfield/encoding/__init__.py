"""Photographs in, an eigen-texture scene out."""

from __future__ import annotations

import logging
import os
from collections.abc import Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eigenfield.core.arguments import checked
from eigenfield.core.fields import refuse_unknown, takes_options
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.progress import Progress
from eigenfield.encoding.options import EncodeOptions
from eigenfield.encoding.target import Target
from eigenfield.reconstruction import SurfaceOptions
from eigenfield.runtime.objects import find_objects, refuse_objects

if TYPE_CHECKING:
    from eigenfield.capture import Capture
    from eigenfield.capture.footage import Footage
    from eigenfield.core.clip import Clip
    from eigenfield.core.mesh import Mesh
    from eigenfield.core.observations import CalibratedObservations
    from eigenfield.core.proxy import MovingProxy, Proxy
    from eigenfield.core.scene import Scene
    from eigenfield.runtime.tasks import Workers

__all__ = ["EncodeOptions", "SurfaceOptions", "Target", "encode", "encode_footage"]

log = logging.getLogger("eigenfield.encode")

OPTION_NAMES = tuple(one.name for one in fields(EncodeOptions))
SURFACE_OF_SCENE = ("triangles", "blind", "hold_out")  # fields of `SurfaceOptions` that follow from those of the scene
SURFACE_NAMES = tuple(one.name for one in fields(SurfaceOptions) if one.name not in SURFACE_OF_SCENE)


@checked
@takes_options(SurfaceOptions, without=SURFACE_OF_SCENE, others=True)
def encode(
    capture: str | os.PathLike[str] | Capture | CalibratedObservations,
    proxy: str | os.PathLike[str] | Mesh | Proxy | None = None,
    options: EncodeOptions | None = None,
    *,
    surface_options: SurfaceOptions | None = None,
    blind: bool = False,
    work: str | os.PathLike[str] | None = None,
    workers: Workers | None = None,
    progress: Progress | None = notebook_progress,
    **changes: Any,
) -> Scene:
    """Encode photographs on a proxy mesh, as `eigenfield encode` does: fitted to them, or projected as in the paper.

    Options about texture maps choose the paper's way, with a warning, where neither was asked for.

    Args:
        capture: A folder or a file, as `open_any` takes it, or what that returns.
        proxy: A triangle mesh or a proxy with sheets in the world of `capture.cameras`, or a mesh file in the world of
            the calibration's files, which is the same unless `capture.origin` says another. None: it is made from the
            photographs, and so are cameras where there are none (see `reconstruct`).
        options: What is asked for; None for the defaults.
        surface_options: How the proxy is made; None for the defaults. Its `triangles` are taken where `options` has
            none, and the other arguments stand for its `blind` and `hold_out`.
        blind: Estimate proxy and cameras without the held-out photographs too: each only registers its own camera.
        work: Folder that keeps finished stages of the reconstruction, and scratch files: up to 17 bytes a pixel, and
            10 for each sheet that it shows; or 4 bytes x channels x cameras x texels. None: a temporary one.
        workers: Of `open_executor`: they make the depth maps of cameras all around (see `reconstruct`) and texture
            maps. A fit has none, and takes no workers where the proxy is given.
        progress: Reports each stage; by default bars in a notebook. None: nothing is reported.
        changes: Fields of `EncodeOptions` by name, in place of those of `options`. The six above are those of
            `surface_options`, without a proxy alone.

    Returns:
        The scene, with what its parts were coded to. A fit has coded all of it, and a scene with a residual is what its
        file gives back. Otherwise the paper's way makes numbers, which `save` codes when it is given
        `options.for_save`.

    Raises:
        CaptureError, ProxyError, OptionError, OutputError: Each names the file and the remedy.
    """
    # what the stages need takes a second to load, and the command line's help needs none of it
    from eigenfield.encoding.between import measure_scene
    from eigenfield.encoding.estimated import calibrated, estimate, surface_to_make
    from eigenfield.encoding.prepare import plan_encoding
    from eigenfield.encoding.projected.encode import encode_projected
    from eigenfield.encoding.reach_target import encode_fitted
    from eigenfield.encoding.residual.make import check_residual, with_residual
    from eigenfield.gltf import encode_scene, read_scene
    from eigenfield.runtime.files import make_folder

    refuse_unknown(changes, (*OPTION_NAMES, *SURFACE_NAMES), "encode")
    of_surface = {name: changes.pop(name) for name in SURFACE_NAMES if name in changes}
    options = replace(options or EncodeOptions(), **changes)
    options.refuse_clip_options()
    if options.keep_maps is not None:
        refuse_objects(options.keep_maps)
    surface = surface_to_make(
        options,
        replace(surface_options or SurfaceOptions(), **of_surface),
        blind,
        has_proxy=proxy is not None,
        others={"workers": workers},
    )
    if surface is not None:
        reconstruction = estimate(capture, options, surface, work, workers, progress)
        capture, proxy = reconstruction.light_field, reconstruction.proxy
        # the mesh has no more triangles than were asked for
        options = replace(options, triangles=None, hold_out=reconstruction.hold_out)
    else:
        assert proxy is not None
        capture = calibrated(capture, proxy)
    resolved = options.resolved()
    projected = resolved.fit == "none"
    if projected and options.fit is None:
        words = "%s is about texture maps, which a fit does not make: encoding the paper's way (--fit none)"
        log.warning(words, options.map_options[0])
    if resolved.residual is not None:
        check_residual(capture.cameras, resolved.residual)

    folder = None if work is None or find_objects(work) else Path(work)  # scratch files stay on this machine
    if folder is not None:
        make_folder(folder)
    plan = plan_encoding(capture, proxy, options, folder, progress)
    scene = encode_projected(plan, folder, progress, workers) if projected else encode_fitted(plan, folder, progress)
    scene = replace(scene, scores=measure_scene(scene, plan, folder, progress))

    if resolved.residual is None:
        return scene
    # the residual is of what a file holds, and so is its picture for other viewers
    stored = read_scene(encode_scene(scene, **resolved.coding, progress=progress))
    stored = replace(stored, payloads=stored.payloads.without("preview"))
    return with_residual(stored, capture, resolved.residual, progress)


@checked
@takes_options(EncodeOptions)
def encode_footage(
    footage: Footage,
    proxy: str | os.PathLike[str] | Mesh | Proxy | MovingProxy | Sequence[str | os.PathLike[str] | Mesh] | None = None,
    options: EncodeOptions | None = None,
    *,
    surface_options: SurfaceOptions | None = None,
    audio: str | os.PathLike[str] | None = None,
    work: str | os.PathLike[str] | None = None,
    workers: Workers | None = None,
    progress: Progress | None = notebook_progress,
    **changes: Any,
) -> Clip:
    """Encode footage on a proxy mesh that stands still, or on one for each frame, as `eigenfield encode --clip` does.

    Args:
        footage: Of cameras that are known.
        proxy: A triangle mesh in the world of the cameras, its file, or an opaque proxy. A list of meshes, one for each
            frame, or a path with %04d in place of their number: a mesh that moves, whose vertices stay where they are
            given. Those with the same triangles share the texture coordinates of the first of them; other triangles
            begin a group. A `core.proxy.MovingProxy`: sheets whose depth and opacity change, behind them an opaque one
            that stands still. None: the surface of what stands still, made from photographs that are averaged over
            time, and a sheet before it for what moves, where cameras look one way.
        options: What is asked for; None for the defaults. Those that are for one instant are refused.
        surface_options: How a surface is made that is not given; None for the defaults. It is opaque.
        audio: An Ogg file of Opus, kept as it is, which begins at second 0 of the footage.
        work: Folder that keeps finished stages, or an address of an object store, so that the same call goes on from
            there. None: a temporary folder.
        workers: Of `open_executor`: they make the groups after the first, with the same bytes. They see `work` and the
            footage.
        progress: Reports each pass by frames; by default bars in a notebook. None: nothing is reported.
        changes: Fields of `EncodeOptions` by name, in place of those of `options`.

    Raises:
        OptionError: `clip-proxy`, the surface would be of sheets; `clip-cameras`, the cameras are not known;
            `clip-option`, an option is for one instant; `group-unknown`; `target`, the sound leaves nothing of a size.
        CaptureError, ProxyError, OutputError: Each names the file and the remedy.
    """
    from eigenfield.encoding.clip.encode import encode_clip

    refuse_unknown(changes, OPTION_NAMES, "encode")
    options = replace(options or EncodeOptions(), **changes)
    folder = None if work is None else Path(work)
    return encode_clip(footage, proxy, options, folder, progress, workers, surface_options, audio)
