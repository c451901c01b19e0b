"""What `encode` needs of a capture and was not given: cameras and proxy."""

from __future__ import annotations

import logging
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

from eigenfield.capture import Capture, LightField, PhotoSet, open_any, open_capture
from eigenfield.core.arguments import kind_in_words
from eigenfield.core.errors import OptionError
from eigenfield.core.fields import options_of
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import CalibratedObservations
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.options import EncodeOptions
from eigenfield.encoding.views import check_selection
from eigenfield.proxy import refuse_no_mesh
from eigenfield.reconstruction import SurfaceOptions
from eigenfield.reconstruction.whole import Reconstruction, reconstruct
from eigenfield.runtime.tasks import Workers

log = logging.getLogger("eigenfield.encode")

Given = str | os.PathLike[str] | Capture | CalibratedObservations


def surface_to_make(
    options: EncodeOptions,
    given: SurfaceOptions,
    blind: bool,
    has_proxy: bool,
    others: Mapping[str, Any] = MappingProxyType({}),
) -> SurfaceOptions | None:
    """The options of `reconstruct` for a scene with these options; None where the proxy is given.

    Args:
        options: Of the scene.
        given: What is asked for of the surface; `triangles`, `blind` and `hold_out` come from the other arguments.
        blind: Whether held-out photographs take no part in cameras and proxy.
        has_proxy: Whether the proxy is given, for which nothing may be asked of a surface.
        others: Arguments by name that a fit on a given proxy has no use for, either.

    Raises:
        OptionError: `proxy-given`, `blind`, `sheets`, and those of `SurfaceOptions`.
    """
    projected = options.resolved().fit == "none"
    if has_proxy:
        unused = [] if projected else [name for name, value in others.items() if value is not None]
        _refuse_with_proxy([*given.changed(), *unused, *(["blind"] if blind else [])])
        return None
    if blind and options.hold_out is None:
        raise OptionError("blind", "--blind is about held-out photographs", remedy="say which with --hold-out")
    surface = replace(
        given,
        triangles=given.triangles if options.triangles is None else options.triangles,
        blind=options.hold_out if blind else None,
        hold_out=options.hold_out,
    )
    if not projected:
        return surface
    if surface.surface == "layers" or (surface.layers or 1) > 1:  # texture maps know one opaque surface
        message = "texture maps of several layers, which only a fit can make"
        raise OptionError("sheets", message, remedy="leave out --fit none, or the layers")
    return replace(surface, layers=1)


def _refuse_with_proxy(names: Sequence[str]) -> None:
    if names:
        option = dict(options_of(SurfaceOptions)).get(names[0])
        name = names[0] if option is None or option.name is None else option.name
        raise OptionError(
            "proxy-given",
            f"--{name} is for making a proxy, but --proxy gives one",
            remedy="leave out one of the two",
        )


def estimate(
    given: Given, options: EncodeOptions, surface: SurfaceOptions, work: str | os.PathLike[str] | None,
    workers: Workers | None, progress: Progress | None,
) -> Reconstruction:  # fmt: skip
    """Cameras and proxy of a capture.

    Args:
        given: The capture, or its path.
        options: Of the scene.
        surface: Of `surface_to_make`.
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
    atlas = options.resolved().fit == "none"  # a fit simplifies the surface first
    reconstruction = reconstruct(opened, surface, atlas=atlas, work=folder, workers=workers, progress=progress)
    _warn(reconstruction.light_field.problems[len(opened.problems) :])
    return reconstruction


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
