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

from eigenfield.capture import LightField
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Coded, Payloads, mesh_key, size_of
from eigenfield.core.progress import Progress
from eigenfield.core.scene import EncodedScene, Plane
from eigenfield.core.version import __version__
from eigenfield.encoding.fitted import byte_price, fit_surface
from eigenfield.encoding.geometry import slim_mesh, triangles_worth
from eigenfield.encoding.geometry.coded import DEPTH_ERROR, coded_cameras, coded_mesh
from eigenfield.encoding.options import EncodeOptions, known
from eigenfield.encoding.projected import atlas_side, texels_per_pixel
from eigenfield.encoding.views import CaptureViews, grid_of, select_views
from eigenfield.proxy import prepare_proxy
from eigenfield.proxy.relief.find_lattice import relief_lattice
from eigenfield.rendering import delaunay_triangles

log = logging.getLogger("eigenfield.encode")

ROUNDING_LIMIT = 0.02  # pixels that float32 cameras may move the mesh before a warning
CAPPED = 0.98  # of the density asked for: what a capped atlas may have before a warning


@dataclass(frozen=True, eq=False)
class PreparedProxy:
    """A proxy with an atlas, before it is made ready for a quality.

    Attributes:
        given: The file or mesh that it was made from.
        mesh: With UVs; for a fit its vertices are where the photographs agree on the surface.
        views: The cameras that it was prepared for.
        by_quality: Whether another quality needs it prepared anew, with other triangles and charts.
    """

    given: str | os.PathLike[str] | Mesh
    mesh: Mesh
    views: CaptureViews
    by_quality: bool


@dataclass(frozen=True, eq=False)
class EncodePlan:
    """Everything that is decided before textures are made.

    Attributes:
        asked: The options as they were given.
        options: What they mean (`EncodeOptions.resolved`), for one quality: a target is left out.
        proxy: The proxy from which the same plan at another quality is made.
        views: The cameras as the file keeps them, and which of them are encoded.
        mesh: The proxy as the file keeps it.
        payloads: What mesh and cameras were coded to; without a fit they are not.
        atlas: Width and height of its atlas.
    """

    asked: EncodeOptions
    options: EncodeOptions
    proxy: PreparedProxy
    views: CaptureViews
    mesh: Mesh
    payloads: Payloads
    atlas: tuple[int, int]

    @property
    def mesh_bytes(self) -> int:
        """Of the coded mesh in the file; 0 where it is not coded."""
        return size_of(self.payloads.get(mesh_key(self.mesh), ()))

    @cached_property
    def density(self) -> float:
        """The atlas's texels per pixel of the reference photograph, along one axis."""
        camera = self.views.cameras[self.views.reference]
        return float(np.sqrt(np.prod(self.atlas))) * texels_per_pixel(self.mesh, camera)

    def at_quality(self, quality: int, work: Path | None = None, progress: Progress | None = None) -> EncodePlan:
        """The same plan with the mesh and the atlas that it has at another quality of the fit, 0 to 100."""
        asked = replace(self.asked, quality=quality, target=None)
        if self.proxy.by_quality:
            return plan_encoding(self.views.capture, self.proxy.given, asked, work, progress)
        return _at_its_quality(self.proxy, asked)

    def scene(
        self,
        planes: tuple[Plane, ...],
        own: Mapping[str, Any],
        *,
        payloads: Payloads | None = None,
        colours: NDArray[np.float32] | None = None,
        to_rgb: NDArray[np.float32] | None = None,
    ) -> EncodedScene:
        """The scene with these planes.

        Args:
            planes: As in `Scene`, with a row of weights for each encoded camera.
            own: What its settings say of how the planes were made.
            payloads: What the planes were coded to.
            colours: As in `Scene`.
            to_rgb: As in `Scene`.
        """
        views = self.views
        settings = {
            "textures": max(sum(basis.count for basis in one.bases) for one in planes),
            "atlas": list(self.atlas),
            "density": round(self.density, 4),
            "holdOut": self.options.hold_out,
            **own,
            **_scale(views.capture, self.options.metres_per_unit),
            **_lenses(views.capture),
            "photographs": {
                "count": len(views.encoded),
                "bytes": sum(views.capture.bytes(int(index)) for index in views.encoded),
                "pixels": sum(camera.width * camera.height for camera in views.encoded_cameras),
            },
        }
        return EncodedScene(
            mesh=self.mesh,
            planes=planes,
            names=tuple(views.capture.names),
            cameras=views.cameras,
            held_out=views.held_out,
            reference=views.reference,
            view_plane=views.view_plane,
            triangles=delaunay_triangles(views.coordinates[views.encoded]),
            settings=settings,
            generator=f"eigenfield {__version__}",
            colours=colours,
            to_rgb=to_rgb,
            payloads=self.payloads | (payloads or {}),
        )


def plan_encoding(
    capture: LightField,
    proxy: str | os.PathLike[str] | Mesh,
    asked: EncodeOptions,
    work: Path | None = None,
    progress: Progress | None = None,
) -> EncodePlan:
    """Cameras and proxy as a file keeps them: for a fit, the surface fitted to the photographs, and both as coded.

    Args:
        capture: Photographs and cameras.
        proxy: A mesh, or its file.
        asked: The options; a target is planned for at its preset's quality.
        work: Folder for scratch files.
        progress: Reports each stage.

    Raises:
        CaptureError, ProxyError, OptionError, OutputError: As `encode`.
    """
    views, options = select_views(capture, asked), _for_one_quality(asked)
    return _at_its_quality(_prepare(proxy, views, options, work, progress), asked)


def _for_one_quality(asked: EncodeOptions) -> EncodeOptions:
    """What the options mean; with a target, for the preset's quality, from which the search may lead elsewhere."""
    return replace(asked, target=None).resolved()


def _simplifies(options: EncodeOptions) -> bool:
    """Whether the encoder decides on the number of triangles."""
    return options.fit != "none" and options.triangles is None


def _prepare(
    proxy: str | os.PathLike[str] | Mesh,
    views: CaptureViews,
    options: EncodeOptions,
    work: Path | None,
    progress: Progress | None,
) -> PreparedProxy:
    """The proxy with an atlas and as many triangles as asked for; for a fit, moved to where the photographs agree."""
    cameras = views.cameras
    triangles = _triangles_by_pictures(views, options) if _simplifies(options) else options.triangles
    mesh = prepare_proxy(proxy, cameras, triangles=triangles, progress=progress)
    _warn_of_rounding([view.camera for view in views.capture.views], cameras, mesh)
    if options.fit == "none":
        return PreparedProxy(proxy, mesh, views, by_quality=False)
    relief = relief_lattice(mesh, cameras, DEPTH_ERROR)
    lattice, side = relief and relief[0], atlas_side(mesh, cameras[views.reference], 1.0)
    mesh = fit_surface(mesh, lattice, views.encoded_cameras, views.observations, side, work, progress)
    return PreparedProxy(proxy, mesh, views, by_quality=_simplifies(options) and relief is None)  # it keeps its atlas


def _triangles_by_pictures(views: CaptureViews, options: EncodeOptions) -> Callable[[Mesh], int | None]:
    """A function of a mesh as it was read: how many triangles its pictures are worth at the options' quality.

    It returns None for a relief, which is simplified when it is coded.
    """

    def triangles(mesh: Mesh) -> int | None:
        if mesh.uv is not None and relief_lattice(mesh, views.cameras, DEPTH_ERROR) is not None:
            return None
        price = byte_price(known(options.quality)) / known(options.density) ** 2
        return triangles_worth(mesh, views.encoded_cameras, views.observations, price)

    return triangles


def _at_its_quality(proxy: PreparedProxy, asked: EncodeOptions) -> EncodePlan:
    """The plan with a prepared proxy: the atlas's size and, for a fit, mesh and cameras as they are coded."""
    options, views = _for_one_quality(asked), proxy.views
    atlas = _atlas_size(options, proxy.mesh, views)
    if options.fit == "none":
        return EncodePlan(asked, options, proxy, views, proxy.mesh, Payloads(), atlas)
    mesh = _coded_mesh(proxy.mesh, views, options, atlas)
    cameras = coded_cameras(views.cameras, mesh.value, grid_of(views.coordinates))
    views = replace(views, cameras=cameras.value)
    return EncodePlan(asked, options, proxy, views, mesh.value, mesh.payloads | cameras.payloads, atlas)


def _atlas_size(options: EncodeOptions, mesh: Mesh, views: CaptureViews) -> tuple[int, int]:
    """(width, height): as asked for, or a square of the options' density in the reference camera."""
    if options.atlas is not None:
        return (options.atlas, options.atlas) if isinstance(options.atlas, int) else options.atlas
    camera, density = views.cameras[views.reference], known(options.density)
    side = atlas_side(mesh, camera, density, sum(one.width * one.height for one in views.encoded_cameras))
    reached = side * texels_per_pixel(mesh, camera)
    if reached < CAPPED * density:
        log.warning("the atlas is capped at %d: density %.2f instead of %.2f", side, reached, density)
    return side, side


def _coded_mesh(mesh: Mesh, views: CaptureViews, options: EncodeOptions, atlas: tuple[int, int]) -> Coded[Mesh]:
    """The mesh as a fitted file keeps it.

    A relief is simplified to what its pictures are worth, unless a number of triangles was asked for.
    """
    if not _simplifies(options):
        return coded_mesh(mesh, views.cameras, views.reference)
    texels = float(np.prod(atlas)) * texels_per_pixel(mesh, views.cameras[views.reference]) ** 2
    price = byte_price(known(options.quality))
    return slim_mesh(mesh, views.encoded_cameras, views.encoded_reference, views.observations, price, texels)


def _scale(capture: LightField, asked: float | None) -> dict[str, float]:
    """What the settings say of the real size: as asked, or metres where the capture's parameters were in metres."""
    in_metres = capture.format == "hci" and capture.layout is not None and capture.layout.measured
    scale = 1.0 if asked is None and in_metres else asked
    return {} if scale is None else {"metresPerUnit": scale}


def _lenses(capture: LightField) -> dict[str, Any]:
    """The lenses that were removed, so that the photographs alone are enough to measure the scene by."""
    lenses = [None if v.lens is None else [v.lens.model, list(v.lens.coefficients)] for v in capture.views]
    return {"lenses": lenses} if any(lenses) else {}


def _warn_of_rounding(exact: Sequence[Camera], kept: Sequence[Camera], mesh: Mesh) -> None:
    """A world far from its origin loses pixels when its numbers become float32."""
    points = mesh.vertices[:: max(1, len(mesh.vertices) // 100)]
    worst = 0.0
    for before, after in zip(exact, kept, strict=True):
        (first, depth), (second, _) = before.project(points), after.project(points)
        seen = (depth > 0) & (first > 0).all(axis=1) & (first < (before.width, before.height)).all(axis=1)
        moved = np.abs(first - second)[seen]
        worst = max(worst, float(moved.max(initial=0.0)))
    if worst > ROUNDING_LIMIT:
        log.warning("float32 cameras move the mesh by %.2f px: shift the world's origin to the array", worst)
