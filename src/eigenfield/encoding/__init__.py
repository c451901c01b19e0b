"""Photographs in, an eigen-texture scene out."""

from __future__ import annotations

import logging
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eigenfield.core.arguments import checked
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.progress import Progress
from eigenfield.encoding.options import EncodeOptions
from eigenfield.encoding.target import Target
from eigenfield.runtime.objects import find_objects, refuse_objects

if TYPE_CHECKING:
    from eigenfield.capture import Capture
    from eigenfield.core.mesh import Mesh
    from eigenfield.core.observations import CalibratedObservations
    from eigenfield.core.proxy import Proxy
    from eigenfield.core.scene import Scene
    from eigenfield.runtime.tasks import Workers

__all__ = ["EncodeOptions", "Target", "encode"]

log = logging.getLogger("eigenfield.encode")


@checked
def encode(
    capture: str | os.PathLike[str] | Capture | CalibratedObservations,
    proxy: str | os.PathLike[str] | Mesh | Proxy | None = None,
    options: EncodeOptions | None = None,
    *,
    surface: str = "auto",
    layers: int | None = None,
    refine: bool | None = None,
    background: bool | None = None,
    primitives: Sequence[str] = (),
    fit_spheres: Sequence[str] = (),
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
        surface: As of `reconstruct`, and so are the next five; without a proxy alone.
        layers: Number of soft sheets.
        refine: Whether the cameras of an array are corrected.
        background: Whether the frustum is closed behind the surface.
        primitives: Texts of primitives.
        fit_spheres: Texts of spheres to fit.
        blind: Estimate proxy and cameras without the held-out photographs too: each only registers its own camera.
        work: Folder that keeps finished stages of the reconstruction, and scratch files: up to 17 bytes a pixel, and
            10 for each sheet that it shows; or 4 bytes x channels x cameras x texels. None: a temporary one.
        workers: Of `open_executor`: they make the depth maps of cameras all around (see `reconstruct`) and texture
            maps. A fit has none, and takes no workers where the proxy is given.
        progress: Reports each stage; by default bars in a notebook. None: nothing is reported.
        changes: Fields of `EncodeOptions` by name, in place of those of `options`.

    Returns:
        The scene, with what its parts were coded to. A fit has coded all of it, and a scene with a residual is what its
        file gives back. Otherwise the paper's way makes numbers, which `save` codes when it is given
        `options.for_save`.

    Raises:
        CaptureError, ProxyError, OptionError, OutputError: Each names the file and the remedy.
    """
    # what the stages need takes a second to load, and the command line's help needs none of it
    from eigenfield.encoding.between import measure_scene
    from eigenfield.encoding.estimated import calibrated, estimate, reconstruction_settings, refuse_unused
    from eigenfield.encoding.prepare import plan_encoding
    from eigenfield.encoding.projected.encode import encode_projected
    from eigenfield.encoding.reach_target import encode_fitted
    from eigenfield.encoding.residual.make import check_residual, with_residual
    from eigenfield.gltf import encode_scene, read_scene

    asked = replace(EncodeOptions() if options is None else options, **changes)
    if asked.keep_maps is not None:
        refuse_objects(asked.keep_maps)
    own: dict[str, Any] = {
        "surface": surface, "layers": layers, "refine": refine, "background": background,
        "primitives": primitives or (), "fit_spheres": fit_spheres or (),
    }  # fmt: skip
    if proxy is None:
        made = estimate(capture, asked, reconstruction_settings(asked, own, blind), work, workers, progress)
        capture, proxy = made.light_field, made.proxy
        # the mesh has no more triangles than were asked for
        asked = replace(asked, triangles=None, hold_out=made.hold_out)
    else:
        unused = {} if asked.resolved().fit == "none" else {"workers": workers}
        refuse_unused({**own, **unused}, blind)
        capture = calibrated(capture, proxy)
    meant = asked.resolved()
    projected = meant.fit == "none"
    if projected and asked.fit is None:
        words = "%s is about texture maps, which a fit does not make: encoding the paper's way (--fit none)"
        log.warning(words, asked.map_options[0])
    if meant.residual is not None:
        check_residual(capture.cameras, meant.residual)

    folder = None if work is None or find_objects(work) else Path(work)  # scratch files stay on this machine
    plan = plan_encoding(capture, proxy, asked, folder, progress)
    scene = encode_projected(plan, folder, progress, workers) if projected else encode_fitted(plan, folder, progress)
    scene = replace(scene, scores=measure_scene(scene, plan, folder, progress))

    if meant.residual is None:
        return scene
    # the residual is of what a file holds, and so is its picture for other viewers
    stored = read_scene(encode_scene(scene, **meant.coding, progress=progress))
    stored = replace(stored, payloads=stored.payloads.without("preview"))
    return with_residual(stored, capture, meant.residual, progress)
