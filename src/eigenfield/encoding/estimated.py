"""What `encode` needs of a capture and was not given: cameras and proxy."""

from __future__ import annotations

import logging
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from eigenfield.capture import Capture, LightField, PhotoSet, open_any, open_capture
from eigenfield.core.arguments import kind_in_words
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import CalibratedObservations
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.options import EncodeOptions
from eigenfield.encoding.views import check_selection
from eigenfield.proxy import PROXY_DEFAULT_TRIANGLES, refuse_no_mesh
from eigenfield.reconstruction import Reconstruction, ReconstructionSettings, reconstruct
from eigenfield.runtime.tasks import Workers

log = logging.getLogger("eigenfield.encode")

Given = str | os.PathLike[str] | Capture | CalibratedObservations


def reconstruction_settings(options: EncodeOptions, own: Mapping[str, Any], blind: bool) -> dict[str, Any]:
    """The arguments of `reconstruct` for a scene with these options.

    Args:
        options: Of the scene.
        own: Arguments of `reconstruct` that were given.
        blind: Whether held-out photographs take no part in cameras and proxy.

    Raises:
        OptionError: `blind`, `sheets`, and those of `ReconstructionSettings`.
    """
    if blind and options.hold_out is None:
        raise OptionError("blind", "--blind is about held-out photographs", remedy="say which with --hold-out")
    settings = {
        **own,
        "triangles": PROXY_DEFAULT_TRIANGLES if options.triangles is None else options.triangles,
        "blind": options.hold_out if blind else None,
        "hold_out": options.hold_out,
    }
    ReconstructionSettings.of_arguments(settings)
    if options.resolved().fit == "none":  # texture maps know one opaque surface
        if own["surface"] == "layers" or (own["layers"] or 1) > 1:
            message = "texture maps of several layers, which only a fit can make"
            raise OptionError("sheets", message, remedy="leave out --fit none, or the layers")
        settings["layers"] = 1
    return settings


def refuse_unused(own: Mapping[str, Any], blind: bool) -> None:
    """Refuse arguments of `reconstruct`, and `blind`, where the proxy is given.

    Args:
        own: Arguments of `reconstruct` that were given.
        blind: Whether held-out photographs were to take no part in cameras and proxy.

    Raises:
        OptionError: `proxy-given`.
    """
    asked = [name for name, value in own.items() if value not in (None, "auto", ())] + ["blind"] * blind
    if asked:
        option = {"primitives": "primitive", "fit_spheres": "fit-sphere"}.get(asked[0], asked[0])
        raise OptionError(
            "proxy-given",
            f"--{option} is for making a proxy, but --proxy gives one",
            remedy="leave out one of the two",
        )


def estimate(
    given: Given, options: EncodeOptions, settings: Mapping[str, Any], work: str | os.PathLike[str] | None,
    workers: Workers | None, progress: Progress | None,
) -> Reconstruction:  # fmt: skip
    """Cameras and proxy of a capture.

    Args:
        given: The capture, or its path.
        options: Of the scene.
        settings: Of `reconstruction_settings`.
        work: Folder that keeps finished stages; None: nothing is kept.
        workers: Of `reconstruct`.
        progress: Reports each stage.

    Raises:
        CaptureError, ProxyError, OptionError: As `open_any` and `reconstruct`.
    """
    folder = None if work is None else Path(work)
    if isinstance(given, LightField | PhotoSet):
        opened: Capture = given
    elif isinstance(given, str | os.PathLike):
        opened = open_any(given, work=None if folder is None else folder / "frames")
        _warn(opened.problems)
    else:
        raise OptionError("capture", f"{kind_in_words(given)} makes no proxy", remedy="give the proxy, or a folder")
    check_selection(opened, options)
    made = reconstruct(opened, work=folder, workers=workers, progress=progress, **settings)
    _warn(made.light_field.problems[len(opened.problems) :])
    return made


def calibrated(given: Given, proxy: str | os.PathLike[str] | Mesh | Proxy) -> CalibratedObservations:
    """A capture with cameras, as it is or opened.

    Args:
        given: The capture, or its path.
        proxy: Refused first if it is a path and no mesh.

    Raises:
        CaptureError, ProxyError: As `open_capture` and `refuse_no_mesh`.
        OptionError: `capture`, `proxy`: they are nothing that is encoded.
    """
    if isinstance(proxy, str | os.PathLike):
        refuse_no_mesh(Path(proxy))
    elif not isinstance(proxy, Mesh | Proxy):
        remedy = "give a mesh file, a Mesh or a Proxy, or leave it out"
        raise OptionError("proxy", f"{kind_in_words(proxy)} is no proxy", remedy=remedy)
    if isinstance(given, str | os.PathLike):
        opened = open_capture(given)
        _warn(opened.problems)
        return opened
    if isinstance(given, PhotoSet):
        raise OptionError("capture", "these photographs have no cameras", remedy="leave out the proxy, or calibrate")
    if not hasattr(given, "cameras"):
        raise OptionError("capture", f"{kind_in_words(given)} is no capture", remedy="give a folder, or `ef.open` it")
    return given


def _warn(problems: tuple[str, ...]) -> None:
    for problem in problems:
        log.warning("%s", problem)
