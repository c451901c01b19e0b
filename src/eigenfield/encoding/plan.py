"""What a scene is before it has textures: its options, cameras and mesh, and the size of its atlas."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Appearance, Plane
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import CalibratedObservations, cameras_of
from eigenfield.core.payloads import Coded, Payloads, mesh_key, size_of
from eigenfield.core.progress import Progress, begin_step
from eigenfield.core.proxy import Proxy
from eigenfield.core.rig import Rig
from eigenfield.core.scene import Scene
from eigenfield.core.version import __version__
from eigenfield.encoding.fitted.opacity import fit_opacity
from eigenfield.encoding.fitted.planes import byte_lambda, coded_opacity
from eigenfield.encoding.fitted.surface import fit_surface
from eigenfield.encoding.geometry.coded import DEPTH_ERROR_PX, coded_cameras, coded_mesh
from eigenfield.encoding.geometry.simplify_relief import simplify_proxy_rd
from eigenfield.encoding.geometry.simplify_surface import simplify_surface_rd
from eigenfield.encoding.options import EncodeOptions, resolved_value
from eigenfield.encoding.projected.atlas import atlas_side, texels_per_pixel
from eigenfield.encoding.views import CaptureViews, grid_of, select_views, usual_reference
from eigenfield.gltf.fallback import with_fallback
from eigenfield.proxy import prepare_proxy
from eigenfield.proxy.placement import describe_placement
from eigenfield.proxy.relief.find_lattice import relief_lattice, relief_proxy

log = logging.getLogger("eigenfield.encode")

CAMERA_ROUNDING_LIMIT_PX = 0.02  # by which float32 cameras may move the mesh without a warning
# Of the usual density, for a surface that is no relief before cameras in no array: fewer of them see a texel, and they
# agree less well. Chosen on Cube, Temple and Fountain
SCATTERED_DENSITY_RATIO = 0.7
CAPPED_DENSITY_RATIO = 0.98  # of the density asked for that a capped atlas may have without a warning


@dataclass(frozen=True, eq=False)
class PreparedProxy:
    """A proxy with an atlas, before it is made ready for a quality.

    Attributes:
        given: The file, the mesh or the proxy as it came.
        proxy: With UVs and, if it is a relief, its lattice; for a fit its vertices are where the photographs agree.
        views: The cameras that it was prepared for.
        by_quality: Whether another quality needs it prepared anew, with other triangles and charts.
    """

    given: str | os.PathLike[str] | Mesh | Proxy
    proxy: Proxy
    views: CaptureViews
    by_quality: bool


@dataclass(frozen=True, eq=False)
class EncodePlan:
    """Everything that is decided before textures are made.

    Attributes:
        asked: The options as they were given.
        options: The resolved options for one quality, without a target.
        prepared: The proxy that the same plan at another quality starts from.
        views: The cameras as the file keeps them, and which of them are encoded.
        proxy: The proxy as the file keeps it.
        payloads: The coded mesh, opacity and cameras; empty without a fit.
        atlas: Width and height of its atlas.
    """

    asked: EncodeOptions
    options: EncodeOptions
    prepared: PreparedProxy
    views: CaptureViews
    proxy: Proxy
    payloads: Payloads
    atlas: tuple[int, int]

    @property
    def mesh(self) -> Mesh:
        """The proxy's mesh."""
        return self.proxy.mesh

    @property
    def mesh_bytes(self) -> int:
        """Of the coded mesh in the file; 0 where it is not coded."""
        return size_of(self.payloads.get(mesh_key(self.mesh), ()))

    @cached_property
    def density(self) -> float:
        """The atlas's texels per pixel of the reference photograph, along one axis."""
        camera = self.views.rig.cameras[self.views.rig.reference]
        return float(np.sqrt(np.prod(self.atlas))) * texels_per_pixel(self.mesh, camera)

    def at_quality(self, quality: int, work: Path | None = None, progress: Progress | None = None) -> EncodePlan:
        """The same plan with the mesh and the atlas that it has at another quality of the fit, 0 to 100."""
        asked = replace(self.asked, quality=quality, target=None)
        if self.prepared.by_quality:
            return plan_encoding(self.views.capture, self.prepared.given, asked, work, progress, warn=False)
        return _at_its_quality(self.prepared, asked)

    def scene(
        self,
        planes: tuple[Plane, ...],
        own: Mapping[str, Any],
        *,
        payloads: Payloads | None = None,
        colours: NDArray[np.float32] | None = None,
        to_rgb: NDArray[np.float32] | None = None,
    ) -> Scene:
        """The scene with these planes.

        Args:
            planes: As in `Scene`, with a row of weights for each encoded camera.
            own: Settings that record how the planes were made.
            payloads: The coded planes.
            colours: As in `Scene`.
            to_rgb: As in `Scene`.
        """
        views, rig = self.views, self.views.rig
        sizes = [rig.cameras[index].width * rig.cameras[index].height for index in views.taken_by]
        used = np.flatnonzero(np.isin(cameras_of(views.capture), rig.encoded)).tolist()
        settings = {
            "textures": max(sum(basis.count for basis in one.bases) for one in planes),
            "atlas": list(self.atlas),
            "density": round(self.density, 4),
            "holdOut": self.options.hold_out,
            **own,
            **_scale(views.capture, self.options.metres_per_unit),
            **_origin(views.capture),
            **_lenses(views.capture),
            **_as_stored(views.capture),
            **_tone(views.capture),
            "photographs": {
                "count": len(views.observations),
                "bytes": sum(views.capture.bytes(index) for index in used),
                "pixels": sum(sizes),
            },
        }
        made = Scene(
            proxy=replace(self.proxy, lattice=None),
            rig=rig,
            appearance=Appearance(planes=planes, colours=colours, to_rgb=to_rgb),
            settings=settings,
            generator=f"eigenfield {__version__}",
            payloads=self.payloads | (payloads or {}),
        )
        return made if self.options.fallback is None else with_fallback(made, self.options.fallback)


def plan_encoding(
    capture: CalibratedObservations,
    proxy: str | os.PathLike[str] | Mesh | Proxy,
    asked: EncodeOptions,
    work: Path | None = None,
    progress: Progress | None = None,
    warn: bool = True,
) -> EncodePlan:
    """Cameras and proxy as a file keeps them: for a fit, the surface fitted to the photographs, and both as coded.

    Of sheets the opacity is fitted too.

    Args:
        capture: Photographs and cameras.
        proxy: A mesh, its file, or a proxy with sheets.
        asked: The options; a target is planned for at its preset's quality.
        work: Folder for scratch files.
        progress: Reports each stage.
        warn: Whether a mesh that does not lie where the photographs say is named in a warning.

    Raises:
        CaptureError, ProxyError, OptionError, OutputError: As `encode`.
    """
    begin_step(progress, "mesh")
    return _at_its_quality(_prepare(proxy, select_views(capture, asked), asked, work, progress, warn), asked)


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
) -> PreparedProxy:
    """The proxy with an atlas and as many triangles as asked for; for a fit, moved to where the photographs agree."""
    cameras, given, options = views.rig.cameras, proxy, _for_one_quality(asked)
    if isinstance(proxy, Proxy):
        if proxy.sheets is not None:
            return _prepare_sheets(proxy, views, options, work, progress)
        proxy = proxy.mesh
    simplified = _simplified_by_pictures(views, _for_surface(asked, views)) if _simplifies(options) else None
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
    given_surface = Proxy(mesh, lattice)
    mesh = fit_surface(given_surface, views.rig.encoded_cameras, views.observations, side, work, progress).mesh
    measured = views.rig.encoded_cameras if _simplifies(options) else cameras
    fitted = relief_proxy(mesh, measured, DEPTH_ERROR_PX)
    by_quality = _simplifies(options) and lattice is None  # a relief keeps its atlas
    return PreparedProxy(given, fitted, views, by_quality)


def _prepare_sheets(
    proxy: Proxy, views: CaptureViews, options: EncodeOptions, work: Path | None, progress: Progress | None
) -> PreparedProxy:
    """Sheets with opacity and surfaces fitted.

    Raises:
        OptionError: `sheets`: texture maps were asked for, which know one surface.
    """
    if options.fit == "none":
        message = "texture maps of several sheets, which only a fit can make"
        raise OptionError("sheets", message, remedy="leave out --fit none, or use another --surface")
    _warn_of_rounding(views.capture.cameras, views.rig.cameras, proxy.mesh)
    views = _at_usual_reference(views, options, proxy.mesh)
    given, cameras, observations = proxy, views.rig.encoded_cameras, views.observations
    side = 0 if proxy.sheets is None else max(proxy.sheets.opacity.shape)
    proxy = fit_opacity(proxy, cameras, observations, work, progress)
    proxy = fit_surface(proxy, cameras, observations, side, work, progress)
    proxy = fit_opacity(proxy, cameras, observations, work, progress)
    return PreparedProxy(given, proxy, views, by_quality=False)


def _at_usual_reference(views: CaptureViews, options: EncodeOptions, mesh: Mesh) -> CaptureViews:
    """The views with the reference camera that was asked for, or that of `usual_reference`."""
    return views if options.reference else views.with_reference(usual_reference(views, mesh.vertices))


def _simplified_by_pictures(views: CaptureViews, options: EncodeOptions) -> Callable[[Mesh], Mesh | None]:
    """A function from a mesh as it was read to the mesh simplified by rate and distortion at the options' quality.

    It returns None for a relief, which is simplified when it is coded.
    """

    def simplified(mesh: Mesh) -> Mesh | None:
        if mesh.uv is not None and relief_lattice(mesh, views.rig.cameras, DEPTH_ERROR_PX) is not None:
            return None
        lambda_ = byte_lambda(resolved_value(options.quality)) / resolved_value(options.density) ** 2
        return simplify_surface_rd(mesh, views.rig.encoded_cameras, views.observations, lambda_)

    return simplified


def _at_its_quality(prepared: PreparedProxy, asked: EncodeOptions) -> EncodePlan:
    """The plan with a prepared proxy: the atlas's size and, for a fit, mesh and cameras as they are coded."""
    views, proxy = prepared.views, prepared.proxy
    relief = proxy.lattice is not None or proxy.sheets is not None
    options = _for_one_quality(asked) if relief else _for_surface(asked, views)
    atlas = _atlas_size(options, proxy.mesh, views.rig)
    if options.fit == "none":
        return EncodePlan(asked, options, prepared, views, Proxy(proxy.mesh), Payloads(), atlas)
    made = _coded_proxy(proxy, views, options, atlas)
    cameras = coded_cameras(views.rig.cameras, made.value.mesh, grid_of(views.coordinates))
    views = views.with_cameras(cameras.value)
    return EncodePlan(asked, options, prepared, views, made.value, made.payloads | cameras.payloads, atlas)


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


def _coded_proxy(proxy: Proxy, views: CaptureViews, options: EncodeOptions, atlas: tuple[int, int]) -> Coded[Proxy]:
    """The proxy as a fitted file keeps it.

    A relief is simplified by rate and distortion, unless a number of triangles was asked for.
    """
    rig, quality = views.rig, resolved_value(options.quality)
    if not _simplifies(options):
        made = coded_mesh(proxy, rig.cameras, rig.reference)
    else:
        texels = float(np.prod(atlas)) * texels_per_pixel(proxy.mesh, rig.cameras[rig.reference]) ** 2
        encoded, reference, lambda_ = rig.encoded_cameras, rig.encoded_reference, byte_lambda(quality)
        made = simplify_proxy_rd(proxy, encoded, reference, views.observations, lambda_, texels)
    sheets = made.value.sheets
    if sheets is None:
        return made
    opacity = coded_opacity(sheets.opacity, quality)
    coded = replace(made.value, sheets=replace(sheets, opacity=opacity.value))
    return Coded(coded, made.payloads | opacity.payloads)


def _scale(capture: CalibratedObservations, asked: float | None) -> dict[str, float]:
    """The settings about the real size: as asked, or as in the capture."""
    scale = capture.metres_per_unit if asked is None else asked
    return {} if scale is None else {"metresPerUnit": scale}


def _origin(capture: CalibratedObservations) -> dict[str, list[float]]:
    """Where a capture that was far from its origin stood, so that what is exported stands there again."""
    return {"origin": capture.origin.tolist()} if capture.origin.any() else {}


def _lenses(capture: CalibratedObservations) -> dict[str, Any]:
    """The lenses that were removed, so that the photographs alone are enough to measure the scene by."""
    lenses = [None if lens is None else [lens[0], list(lens[1])] for lens in capture.lenses]
    return {"lenses": lenses} if any(lenses) else {}


def _as_stored(capture: CalibratedObservations) -> dict[str, list[int]]:
    """The photographs that are not turned by their EXIF orientation, where no size tells: for the same purpose."""
    indices = list(capture.as_stored)
    return {"asStored": indices} if indices else {}


def _tone(capture: CalibratedObservations) -> dict[str, Any]:
    """How linear values became the photographs' own numbers."""
    return {} if capture.exposure is None else {"tone": {"curve": "sRGB", "exposure": capture.exposure}}


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
