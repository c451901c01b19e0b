"""Cameras and proxy of a capture made ready for their textures, as a file of a quality keeps them."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import CalibratedObservations
from eigenfield.core.payloads import Coded, Payloads
from eigenfield.core.progress import Progress, begin_step
from eigenfield.core.proxy import Proxy
from eigenfield.core.rig import Rig
from eigenfield.encoding.atlas import atlas_side, texels_per_pixel
from eigenfield.encoding.fitted.opacity import fit_opacity
from eigenfield.encoding.fitted.planes import byte_lambda, coded_opacity
from eigenfield.encoding.fitted.surface import fit_surface
from eigenfield.encoding.geometry.coded import DEPTH_ERROR_PX, coded_cameras, coded_mesh
from eigenfield.encoding.geometry.simplify_relief import simplify_proxy_rd
from eigenfield.encoding.geometry.simplify_surface import simplify_surface_rd
from eigenfield.encoding.options import EncodeOptions, resolved_value
from eigenfield.encoding.plan import EncodePlan, PreparedProxy
from eigenfield.encoding.views import CaptureViews, grid_of, select_views, usual_reference
from eigenfield.proxy import prepare_proxy
from eigenfield.proxy.placement import describe_placement
from eigenfield.proxy.relief.find_lattice import relief_lattice, relief_proxy

log = logging.getLogger("eigenfield.encode")

CAMERA_ROUNDING_LIMIT_PX = 0.02  # by which float32 cameras may move the mesh without a warning
# Of the usual density, for a surface that is no relief before cameras in no array: fewer of them see a texel, and they
# agree less well. Chosen on Cube, Temple and Fountain
SCATTERED_DENSITY_RATIO = 0.7
CAPPED_DENSITY_RATIO = 0.98  # of the density asked for that a capped atlas may have without a warning


def plan_encoding(
    capture: CalibratedObservations,
    proxy: str | os.PathLike[str] | Mesh | Proxy,
    asked: EncodeOptions,
    work: Path | None = None,
    progress: Progress | None = None,
    warn: bool = True,
    exact: bool = False,
) -> EncodePlan:
    """Cameras and proxy as a file keeps them: for a fit, the surface fitted to the photographs, and both as coded.

    Of sheets the opacity is fitted too.

    Args:
        proxy: A mesh, its file, or a proxy with sheets.
        asked: The options; a target is planned for at its preset's quality.
        warn: Whether a mesh that does not lie where the photographs say is named in a warning.
        exact: Whether vertices stay where they are given, as those of a mesh that moves do, and an opacity as it is.

    Raises:
        CaptureError, ProxyError, OptionError, OutputError: As `encode`.
    """
    begin_step(progress, "mesh")
    prepared = _prepare(proxy, select_views(capture, asked), asked, work, progress, warn, exact)
    return _at_its_quality(prepared, asked)


def plan_at_quality(
    plan: EncodePlan, quality: int, work: Path | None = None, progress: Progress | None = None
) -> EncodePlan:
    """The same plan with the mesh and the atlas that it has at another quality of the fit, 0 to 100."""
    asked = replace(plan.asked, quality=quality, target=None)
    if plan.prepared.by_quality:
        return plan_encoding(plan.views.capture, plan.prepared.given, asked, work, progress, warn=False)
    return _at_its_quality(plan.prepared, asked)


def _for_one_quality(asked: EncodeOptions) -> EncodeOptions:
    """The resolved options; with a target for the preset's quality, from which the search may lead elsewhere."""
    return replace(asked, target=None).resolved()


def _for_surface(asked: EncodeOptions, views: CaptureViews) -> EncodeOptions:
    """As `_for_one_quality`, with the density of a surface that is no relief."""
    options = _for_one_quality(asked)
    if options.fit == "none" or asked.density is not None or not views.scattered:
        return options
    return replace(options, density=SCATTERED_DENSITY_RATIO * resolved_value(options.density))


def _simplifies(options: EncodeOptions) -> bool:
    """Whether the encoder decides on the number of triangles."""
    return options.fit != "none" and options.triangles is None


def _prepare(
    proxy: str | os.PathLike[str] | Mesh | Proxy,
    views: CaptureViews,
    asked: EncodeOptions,
    work: Path | None,
    progress: Progress | None,
    warn: bool,
    exact: bool,
) -> PreparedProxy:
    """The proxy with an atlas and as many triangles as asked for; for a fit, moved to where the photographs agree."""
    cameras, given, options = views.rig.cameras, proxy, _for_one_quality(asked)
    if isinstance(proxy, Proxy):
        if proxy.sheets is not None:
            return _prepare_sheets(proxy, views, options, work, progress, exact)
        proxy = proxy.mesh
    simplified = None
    if _simplifies(options):
        simplified = _simplified_by_pictures(views, _for_surface(asked, views), is_estimated=isinstance(given, Proxy))
    mesh = prepare_proxy(
        proxy,
        cameras,
        origin=views.capture.origin,
        triangles=options.triangles,
        simplified=simplified,
        progress=progress,
    )
    _warn_of_rounding(views.capture.cameras, cameras, mesh)
    if warn and not isinstance(given, Proxy):
        path = None if isinstance(given, Mesh) else Path(given)
        encoded = views.rig.encoded_cameras, views.observations
        for line in describe_placement(mesh, *encoded, views.capture.origin, path):
            log.warning("%s", line)
    views = _at_usual_reference(views, options, mesh)
    if options.fit == "none":
        return PreparedProxy(given, Proxy(mesh), views, by_quality=False)
    lattice, side = relief_lattice(mesh, cameras, DEPTH_ERROR_PX), atlas_side(mesh, cameras[views.rig.reference], 1.0)
    if not exact:
        surface = Proxy(mesh, lattice)
        mesh = fit_surface(surface, views.rig.encoded_cameras, views.observations, side, work, progress).mesh
    measured = views.rig.encoded_cameras if _simplifies(options) else cameras
    fitted = relief_proxy(mesh, measured, DEPTH_ERROR_PX)
    by_quality = _simplifies(options) and lattice is None  # a relief keeps its atlas
    return PreparedProxy(given, fitted, views, by_quality)


def _prepare_sheets(
    proxy: Proxy, views: CaptureViews, options: EncodeOptions, work: Path | None, progress: Progress | None, exact: bool
) -> PreparedProxy:
    """Sheets with opacity and surfaces fitted, unless they are `exact`.

    Raises:
        OptionError: `sheets`: texture maps were asked for, which know one surface.
    """
    if options.fit == "none":
        message = "texture maps of several sheets, which only a fit can make"
        raise OptionError("sheets", message, remedy="leave out --fit none, or use another --surface")
    _warn_of_rounding(views.capture.cameras, views.rig.cameras, proxy.mesh)
    views = _at_usual_reference(views, options, proxy.mesh)
    given, cameras, observations = proxy, views.rig.encoded_cameras, views.observations
    if exact:
        return PreparedProxy(given, proxy, views, by_quality=False, exact=True)
    side = 0 if proxy.sheets is None else max(proxy.sheets.opacity.shape)
    proxy = fit_opacity(proxy, cameras, observations, work, progress)
    proxy = fit_surface(proxy, cameras, observations, side, work, progress)
    proxy = fit_opacity(proxy, cameras, observations, work, progress)
    return PreparedProxy(given, proxy, views, by_quality=False)


def _at_usual_reference(views: CaptureViews, options: EncodeOptions, mesh: Mesh) -> CaptureViews:
    """The views with the reference camera that was asked for, or that of `usual_reference`."""
    return views if options.reference else views.with_reference(usual_reference(views, mesh))


def _simplified_by_pictures(
    views: CaptureViews, options: EncodeOptions, *, is_estimated: bool
) -> Callable[[Mesh], Mesh | None]:
    """A function from a mesh as it was read to the mesh simplified by rate and distortion at the options' quality.

    It returns None for a relief, which is simplified when it is coded.
    """

    def simplified(mesh: Mesh) -> Mesh | None:
        if mesh.uv is not None and relief_lattice(mesh, views.rig.cameras, DEPTH_ERROR_PX) is not None:
            return None
        lambda_ = byte_lambda(resolved_value(options.quality)) / resolved_value(options.density) ** 2
        return simplify_surface_rd(
            mesh, views.rig.encoded_cameras, views.observations, lambda_, silhouettes=not is_estimated
        )

    return simplified


def _at_its_quality(prepared: PreparedProxy, asked: EncodeOptions) -> EncodePlan:
    """The plan with a prepared proxy: the atlas's size and, for a fit, mesh and cameras as they are coded."""
    views, proxy = prepared.views, prepared.proxy
    relief = proxy.lattice is not None or proxy.sheets is not None
    options = _for_one_quality(asked) if relief else _for_surface(asked, views)
    atlas = _atlas_size(options, proxy.mesh, views.rig)
    plan = EncodePlan(asked, options, prepared, views, Proxy(proxy.mesh), Payloads(), atlas)
    return plan if options.fit == "none" else _with_coded(plan, _coded_proxy(prepared, views, options, atlas))


def coded_plan(plan: EncodePlan) -> EncodePlan:
    """The plan with mesh and cameras as they are coded. That of a fit has them so already."""
    if plan.payloads:
        return plan
    rig = plan.views.rig
    proxy = relief_proxy(plan.mesh, rig.cameras, DEPTH_ERROR_PX)
    return _with_coded(plan, coded_mesh(proxy, rig.cameras, rig.reference))


def _with_coded(plan: EncodePlan, made: Coded[Proxy]) -> EncodePlan:
    """The plan with a coded proxy, and with its cameras coded."""
    views = plan.views
    cameras = coded_cameras(views.rig.cameras, made.value.mesh, grid_of(views.coordinates))
    views, payloads = views.with_cameras(cameras.value), made.payloads | cameras.payloads
    return replace(plan, views=views, proxy=made.value, payloads=payloads)


def _atlas_size(options: EncodeOptions, mesh: Mesh, rig: Rig) -> tuple[int, int]:
    """(width, height): as asked for, or a square of the options' density in the reference camera."""
    if options.atlas is not None:
        return (options.atlas, options.atlas) if isinstance(options.atlas, int) else options.atlas
    camera, density = rig.cameras[rig.reference], resolved_value(options.density)
    side = atlas_side(mesh, camera, density, sum(one.width * one.height for one in rig.encoded_cameras))
    reached = side * texels_per_pixel(mesh, camera)
    if reached < CAPPED_DENSITY_RATIO * density:
        log.warning("the atlas is capped at %d: density %.2f instead of %.2f", side, reached, density)
    return side, side


def _coded_proxy(
    prepared: PreparedProxy, views: CaptureViews, options: EncodeOptions, atlas: tuple[int, int]
) -> Coded[Proxy]:
    """The proxy as a fitted file keeps it.

    A relief is simplified by rate and distortion, unless it is exact or a number of triangles was asked for.
    """
    proxy, rig, quality = prepared.proxy, views.rig, resolved_value(options.quality)
    if prepared.exact or not _simplifies(options):
        made = coded_mesh(proxy, rig.cameras, rig.reference)
    else:
        texels = float(np.prod(atlas)) * texels_per_pixel(proxy.mesh, rig.cameras[rig.reference]) ** 2
        encoded, reference, lambda_ = rig.encoded_cameras, rig.encoded_reference, byte_lambda(quality)
        made = simplify_proxy_rd(proxy, encoded, reference, views.observations, lambda_, texels)
    sheets = made.value.sheets
    if sheets is None or prepared.exact:
        return made
    opacity = coded_opacity(sheets.opacity, quality)
    coded = replace(made.value, sheets=replace(sheets, opacity=opacity.value))
    return Coded(coded, made.payloads | opacity.payloads)


def _warn_of_rounding(exact: Sequence[Camera], kept: Sequence[Camera], mesh: Mesh) -> None:
    """A world far from its origin loses pixels when its numbers become float32."""
    points = mesh.vertices[:: max(1, len(mesh.vertices) // 100)]
    worst = 0.0
    for before, after in zip(exact, kept, strict=True):
        (first, depth), (second, _) = before.project(points), after.project(points)
        seen = (depth > 0) & (first > 0).all(axis=1) & (first < (before.width, before.height)).all(axis=1)
        moved = np.abs(first - second)[seen]
        worst = max(worst, float(moved.max(initial=0.0)))
    if worst > CAMERA_ROUNDING_LIMIT_PX:
        log.warning("float32 cameras move the mesh by %.2f px: shift the world's origin to the array", worst)
