"""What a scene is before it has textures: options, cameras, mesh, the atlas's size, which photographs are encoded."""

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

from eigenfield.capture import Capture, LightField
from eigenfield.capture.holdout import held_out_cameras
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import Observations, of_cameras
from eigenfield.core.payloads import stream_of
from eigenfield.core.progress import Progress
from eigenfield.core.scene import Plane, Scene, check_scale
from eigenfield.core.version import __version__
from eigenfield.core.viewplane import ViewPlane, find_grid, fit_view_plane
from eigenfield.encoding.fitted import KINDS, PRESETS, Preset, Target, byte_price, density_of, fit_surface
from eigenfield.encoding.geometry import slim_mesh, triangles_worth
from eigenfield.encoding.geometry.coded import DEPTH_ERROR, coded_cameras, coded_mesh
from eigenfield.encoding.projected import (
    FILTERS,
    SIDE_LIMIT,
    atlas_side,
    check_density,
    check_model,
    texels_per_pixel,
)
from eigenfield.proxy import prepare_proxy
from eigenfield.proxy.relief.find_lattice import relief_lattice
from eigenfield.rendering import delaunay_triangles

log = logging.getLogger("eigenfield.encode")

DEFAULT_TEXTURES = 15
DEFAULT_PRESET = "balanced"
DEFAULT_PLANES = "luma-chroma"
DEFAULT_RESAMPLING = "bicubic"
FITS = ("none", "photographs")
DEFAULT_DENSITY = 1.5
ABOUT_MAPS = ("align", "uv_ssim", "harmonise", "resampling", "keep_maps", "codec")  # options that a fit has no use for
ABOUT_FITS = ("target", "preset", "planes")  # options that nothing else has
ROUNDING_LIMIT = 0.02  # pixels that float32 cameras may move the mesh before a warning


@dataclass(frozen=True)
class Options:
    """What `encode` was asked for; each is described there.

    fit: where it was not said, which of the two it is: `photographs`, unless something about texture maps was asked
    for. codec: of the pictures in the file, for those who save with one.
    """

    textures: int | None = None
    uv_ssim: float | None = None
    density: float | None = None
    atlas: int | tuple[int, int] | None = None
    align: str | None = None
    reference: str | None = None
    hold_out: str | None = None
    resampling: str | None = None
    harmonise: str | None = None
    metres_per_unit: float | None = None
    fit: str | None = None
    preset: str | None = None
    quality: int | None = None
    target: Target | None = None
    keep_maps: str | os.PathLike[str] | None = None
    codec: str | None = None
    planes: str | None = None

    def __post_init__(self) -> None:
        self._choose_fit()
        if self.textures is not None and self.textures < 0:
            raise OptionError("textures", f"{self.textures} eigen textures were asked for", remedy="ask for 0 or more")
        check_scale(self.metres_per_unit)
        if self.uv_ssim is not None and not 0 < self.uv_ssim <= 1:
            raise OptionError("uv-ssim", f"an SSIM of {self.uv_ssim:g} was asked for", remedy="ask for one in (0, 1]")
        if self.resampling is not None and self.resampling not in FILTERS:
            raise OptionError(
                "resampling", f"no filter is called {self.resampling}", remedy=f"use one of {', '.join(FILTERS)}"
            )
        check_density(self.atlas_density)
        if self.harmonise is not None:
            check_model(self.harmonise)
        if self.atlas is not None:
            sides = (self.atlas,) if isinstance(self.atlas, int) else self.atlas
            if not all(1 <= side <= SIDE_LIMIT for side in sides):
                raise OptionError(
                    "atlas", f"an atlas of {self.atlas} was asked for", remedy=f"ask for sides from 1 to {SIDE_LIMIT}"
                )

    @property
    def fit_preset(self) -> Preset:
        """What a fit aims at."""
        return PRESETS[DEFAULT_PRESET if self.preset is None else self.preset]

    @property
    def fit_planes(self) -> str:
        """Which planes a fit has."""
        return DEFAULT_PLANES if self.planes is None else self.planes

    @property
    def fit_quality(self) -> int:
        """At which quality a fit is coded, unless a target says otherwise."""
        return self.fit_preset.quality if self.quality is None else self.quality

    @property
    def atlas_density(self) -> float:
        """Texels per photograph pixel, unless the atlas's size is given: of a fit what its quality pays for."""
        if self.density is not None:
            return self.density
        return DEFAULT_DENSITY if self.fit == "none" else density_of(self.fit_quality)

    def _choose_fit(self) -> None:
        """Decide what `fit` is where it was not said, and raise OptionError for options that do not go with it."""
        if self.fit is not None and self.fit not in FITS:
            raise OptionError("fit", f"no fit is called {self.fit}", remedy=f"use one of {', '.join(FITS)}")
        if self.preset is not None and self.preset not in PRESETS:
            raise OptionError("preset", f"no preset is called {self.preset}", remedy=f"use one of {', '.join(PRESETS)}")
        if self.planes is not None and self.planes not in KINDS:
            raise OptionError("planes", f"no planes are called {self.planes}", remedy=f"use one of {', '.join(KINDS)}")
        if self.quality is not None and not 0 <= self.quality <= 100:
            raise OptionError("quality", f"a quality of {self.quality}", remedy="use 0 to 100")
        if self.target is not None:
            self.target.check()
            if self.quality is not None:
                raise OptionError("target", "a target is reached by the quality", remedy="leave one of them out")
        maps = [f"--{name.replace('_', '-')}" for name in ABOUT_MAPS if getattr(self, name) is not None]
        fits = [name for name in ABOUT_FITS if getattr(self, name) is not None]
        if self.fit is None:
            chosen = "none" if maps and not fits else "photographs"
            object.__setattr__(self, "fit", chosen)
            if chosen == "none":
                log.warning(
                    "%s is about texture maps, which a fit does not make: encoding the paper's way (--fit none)",
                    maps[0],
                )
        if self.fit == "none" and fits:
            raise OptionError(fits[0], f"--fit none has no {fits[0]}", remedy="leave one of them out")
        if self.fit != "none" and maps:
            other = f"leave it or the {fits[0]} out" if fits else "leave it out, or --fit none"
            raise OptionError("fit", f"{maps[0]} is about texture maps, and a fit makes none", remedy=other)


def check_options(capture: Capture, options: Options) -> None:
    """Raise OptionError for what `encode` will refuse for this capture, before its cameras and proxy are estimated."""
    if capture.light_field is not None:
        places = fit_view_plane(capture.cameras).coordinates([camera.centre for camera in capture.cameras])
    elif capture.layout is not None:
        places = np.stack([capture.layout.columns, capture.layout.rows], axis=1).astype(np.float64)
    elif options.hold_out == "odd":
        return  # cameras will tell
    else:
        places = np.zeros((len(capture), 2))
    held = held_out_cameras(options.hold_out, capture.names, places)
    _reference(options.reference, capture.names, places, np.flatnonzero(~held))


@dataclass(frozen=True, eq=False)
class Draft:
    """A scene without its textures.

    again: the same with other options. cameras: all, as the file keeps them. coordinates: (Nc, 2) on the view plane.
    held_out: (Nc,) bool. reference: index of the reference camera. atlas: width and height.
    """

    capture: LightField
    options: Options
    again: Callable[[Options], Draft]
    mesh: Mesh
    cameras: tuple[Camera, ...]
    view_plane: ViewPlane
    coordinates: NDArray[np.float64]
    held_out: NDArray[np.bool_]
    reference: int
    atlas: tuple[int, int]

    @cached_property
    def encoded(self) -> NDArray[np.int64]:
        """(Ne,) indices of the cameras whose photographs count."""
        return np.flatnonzero(~self.held_out)

    @property
    def encoded_cameras(self) -> list[Camera]:
        return [self.cameras[index] for index in self.encoded]

    @property
    def encoded_reference(self) -> int:
        """The reference camera, counted among the encoded ones."""
        return int(np.searchsorted(self.encoded, self.reference))

    @property
    def encoded_names(self) -> list[str]:
        return [self.capture.names[index] for index in self.encoded]

    @property
    def grid(self) -> NDArray[np.int64] | None:
        """(rows, columns) of the encoded cameras, counted among themselves, where they stand on a grid; else None."""
        return _grid_of(self.coordinates[self.encoded])

    @cached_property
    def observations(self) -> Observations:
        """Those of the encoded cameras, which are counted among themselves."""
        return of_cameras(self.capture, self.encoded.tolist())

    @property
    def mesh_bytes(self) -> int:
        """Of the coded mesh in the file; 0 where it is not coded."""
        return len(stream_of(self.mesh) or b"")

    def at_quality(self, quality: int) -> Draft:
        """The same with the mesh and the atlas that it has at another quality."""
        return self.again(replace(self.options, quality=quality, target=None))

    @cached_property
    def density(self) -> float:
        """The atlas's texels per pixel of the reference photograph, along one axis."""
        return float(np.sqrt(np.prod(self.atlas))) * texels_per_pixel(self.mesh, self.cameras[self.reference])

    def scene(
        self,
        planes: tuple[Plane, ...],
        own: Mapping[str, Any],
        *,
        colours: NDArray[np.float32] | None = None,
        to_rgb: NDArray[np.float32] | None = None,
    ) -> Scene:
        """The scene with these planes. own: what the settings say of how they were made."""
        settings = {
            "textures": max(sum(basis.count for basis in one.bases) for one in planes),
            "atlas": list(self.atlas),
            "density": round(self.density, 4),
            "holdOut": self.options.hold_out,
            **own,
            **_scale(self.capture, self.options.metres_per_unit),
            **_lenses(self.capture),
            "photographs": {
                "count": len(self.encoded),
                "bytes": sum(self.capture.bytes(int(i)) for i in self.encoded),
                "pixels": sum(camera.width * camera.height for camera in self.encoded_cameras),
            },
        }
        return Scene(
            mesh=self.mesh,
            planes=planes,
            names=tuple(self.capture.names),
            cameras=self.cameras,
            held_out=self.held_out,
            reference=self.reference,
            view_plane=self.view_plane,
            triangles=delaunay_triangles(self.coordinates[self.encoded]),
            settings=settings,
            generator=f"eigenfield {__version__}",
            colours=colours,
            to_rgb=to_rgb,
        )


def make_draft(
    capture: LightField,
    proxy: str | os.PathLike[str] | Mesh,
    options: Options,
    triangles: int | None = None,
    work: Path | None = None,
    progress: Progress | None = None,
) -> Draft:
    """Cameras as a file keeps them, the proxy with an atlas; for a fit its surface fitted to the photographs, and both
    as they are coded. triangles, work, errors: as `encode`."""
    names = [view.name for view in capture.views]
    cameras = [view.camera.rounded() for view in capture.views]
    coordinates = fit_view_plane(cameras).coordinates([camera.centre for camera in cameras])
    held = held_out_cameras(options.hold_out, names, coordinates)
    encoded = np.flatnonzero(~held)
    centre = _reference(options.reference, names, coordinates, encoded)
    observations, used = of_cameras(capture, encoded.tolist()), [cameras[index] for index in encoded]
    simplify = options.fit != "none" and triangles is None

    def worth(mesh: Mesh) -> int | None:
        relief = mesh.uv is not None and relief_lattice(mesh, cameras, DEPTH_ERROR) is not None
        price = byte_price(options.fit_quality) / options.atlas_density**2
        return None if relief else triangles_worth(mesh, used, observations, price)

    mesh = prepare_proxy(proxy, cameras, triangles=worth if simplify else triangles, progress=progress)
    _warn_of_rounding([view.camera for view in capture.views], cameras, mesh)
    relief = None
    if options.fit != "none":
        relief, side = relief_lattice(mesh, cameras, DEPTH_ERROR), atlas_side(mesh, cameras[centre], 1.0)
        mesh = fit_surface(mesh, relief and relief[0], used, observations, side, work, progress)
    anew = simplify and relief is None  # a relief keeps its atlas

    def again(other: Options) -> Draft:
        if anew:
            return make_draft(capture, proxy, other, triangles, work, progress)
        return _draft(capture, mesh, other, held, centre, simplify, again)

    return _draft(capture, mesh, options, held, centre, simplify, again)


def _draft(
    capture: LightField,
    mesh: Mesh,
    options: Options,
    held: NDArray[np.bool_],
    centre: int,
    simplify: bool,
    again: Callable[[Options], Draft],
) -> Draft:
    """The draft with a proxy that is prepared. simplify: a fit's relief, for its quality."""
    cameras, encoded = [view.camera.rounded() for view in capture.views], np.flatnonzero(~held)
    size = _atlas_size(options, mesh, cameras[centre], [cameras[i] for i in encoded])
    if options.fit != "none":
        if simplify:
            texels = float(np.prod(size)) * texels_per_pixel(mesh, cameras[centre]) ** 2
            mesh = slim_mesh(
                mesh, [cameras[i] for i in encoded], int(np.searchsorted(encoded, centre)),
                of_cameras(capture, encoded.tolist()), byte_price(options.fit_quality), texels,
            )  # fmt: skip
        else:
            mesh = coded_mesh(mesh, cameras, centre)
        grid = _grid_of(fit_view_plane(cameras).coordinates([camera.centre for camera in cameras]))
        cameras = list(coded_cameras(cameras, mesh, grid))
    plane = fit_view_plane(cameras)
    coordinates = plane.coordinates([camera.centre for camera in cameras])
    return Draft(
        capture, options, again, mesh, tuple(cameras), plane, coordinates, held, centre, size
    )  # fmt: skip


def _grid_of(coordinates: NDArray[np.float64]) -> NDArray[np.int64] | None:
    grid = find_grid(coordinates)
    return None if grid is None else grid.index.astype(np.int64)


def _reference(
    name: str | None, names: Sequence[str], coordinates: NDArray[np.float64], encoded: NDArray[np.int64]
) -> int:
    if name is None:
        return int(encoded[np.argmin(np.linalg.norm(coordinates[encoded], axis=1))])
    if name not in names:
        raise OptionError("reference", f"no camera is called {name}", remedy="eigenfield inspect lists the names")
    index = names.index(name)
    if index not in encoded:
        raise OptionError("reference", f"{name} is held out", remedy="name an encoded camera as --reference")
    return index


def _atlas_size(options: Options, mesh: Mesh, camera: Camera, encoded: Sequence[Camera]) -> tuple[int, int]:
    if options.atlas is None:
        pixels = sum(one.width * one.height for one in encoded)
        density = options.atlas_density
        side = atlas_side(mesh, camera, density, pixels)
        reached = side * texels_per_pixel(mesh, camera)
        if reached < 0.98 * density:
            log.warning("the atlas is capped at %d: density %.2f instead of %.2f", side, reached, density)
        return side, side
    return (options.atlas, options.atlas) if isinstance(options.atlas, int) else options.atlas


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
