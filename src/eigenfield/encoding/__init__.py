"""A calibrated capture and a proxy in, an eigen-texture scene out."""

from __future__ import annotations

import logging
import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eigenfield.encoding.options import EncodeOptions
from eigenfield.encoding.target import Target

if TYPE_CHECKING:
    from eigenfield.core.mesh import Mesh
    from eigenfield.core.observations import CalibratedObservations
    from eigenfield.core.progress import Progress
    from eigenfield.core.proxy import Proxy
    from eigenfield.core.scene import EncodedScene

__all__ = ["EncodeOptions", "Target", "encode"]

log = logging.getLogger("eigenfield.encode")


def encode(
    capture: CalibratedObservations,
    proxy: str | os.PathLike[str] | Mesh | Proxy,
    options: EncodeOptions | None = None,
    *,
    work: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    **changes: Any,
) -> EncodedScene:
    """Encode a light field on a proxy mesh: fitted to its photographs, or projected as the paper does.

    Options about texture maps choose the paper's way, with a warning, where neither was asked for.

    Args:
        capture: Photographs with their cameras.
        proxy: A triangle mesh or a proxy with sheets in the world of `capture.cameras`, or a mesh file in the world of
            the calibration's files, which is the same unless `capture.origin` says another.
        options: What is asked for; None for the defaults.
        work: Folder for scratch files, up to 17 bytes a pixel, and 10 for each sheet that it shows; or 4 bytes x
            channels x cameras x texels.
        progress: Reports each stage.
        changes: Fields of `EncodeOptions` by name, in place of those of `options`.

    Returns:
        The scene, with what its parts were coded to. A fit has coded all of it, and a scene with a residual is what its
        file gives back. Otherwise the paper's way makes numbers, which `save` codes when it is given
        `options.for_save`.

    Raises:
        CaptureError, ProxyError, OptionError, OutputError: Each names the file and the remedy.
    """
    # what the stages need takes a second to load, and the command line's help needs none of it
    from eigenfield.encoding.fitted.encode import encode_fitted
    from eigenfield.encoding.plan import plan_encoding
    from eigenfield.encoding.projected.encode import encode_projected
    from eigenfield.encoding.residual.make import check_residual, with_residual
    from eigenfield.gltf import encode_scene, read_scene

    asked = replace(EncodeOptions() if options is None else options, **changes)
    meant = asked.resolved()
    projected = meant.fit == "none"
    if projected and asked.fit is None:
        words = "%s is about texture maps, which a fit does not make: encoding the paper's way (--fit none)"
        log.warning(words, asked.map_options[0])
    if meant.residual is not None:
        check_residual(capture.cameras, meant.residual)

    folder = None if work is None else Path(work)
    plan = plan_encoding(capture, proxy, asked, folder, progress)
    scene = (encode_projected if projected else encode_fitted)(plan, folder, progress)

    if meant.residual is None:
        return scene
    # the residual is of what a file holds, and so is its picture for other viewers
    stored = read_scene(encode_scene(scene, **meant.coding, progress=progress))
    stored = replace(stored, payloads=stored.payloads.without("preview"))
    return with_residual(stored, capture, meant.residual, progress)
