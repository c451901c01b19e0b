"""The stages in order: a calibrated capture and a proxy in, an eigen-texture scene out."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield import __version__
from eigenfield.basis import (
    Mean,
    align_maps,
    component_count,
    eigen_textures,
    gram_matrix,
    mean_map,
    smallest_count,
    spectrum,
    warn_of_disagreement,
    weights_of,
)
from eigenfield.camera import Camera
from eigenfield.capture import LightField, PhotoSet
from eigenfield.errors import CaptureError, OptionError
from eigenfield.fitting import FIT_QUALITY, fit_planes, fitted_textures, open_shots
from eigenfield.format.geometry import code_cameras_of, code_mesh
from eigenfield.holdout import held_out_cameras
from eigenfield.mesh import Mesh
from eigenfield.progress import Progress
from eigenfield.proxy import prepare_proxy
from eigenfield.rendering import delaunay_triangles
from eigenfield.scene import Basis, Plane, Scene, check_scale
from eigenfield.texturing import (
    FILTERS,
    SIDE_LIMIT,
    Spreader,
    TextureMaps,
    atlas_side,
    check_density,
    check_model,
    harmonise_maps,
    make_atlas,
    make_spreader,
    texels_per_pixel,
    texture_maps,
    write_maps,
)
from eigenfield.viewplane import find_grid, fit_view_plane

log = logging.getLogger("eigenfield.encode")

DEFAULT_TEXTURES = 15
FITS = ("none", "photographs")
DEFAULT_DENSITY = 1.5
ROUNDING_LIMIT = 0.02  # pixels that float32 cameras may move the mesh before a warning


@dataclass(frozen=True)
class Options:
    """What `encode` was asked for; each is described there."""

    textures: int | None = None
    uv_ssim: float | None = None
    density: float = DEFAULT_DENSITY
    atlas: int | tuple[int, int] | None = None
    align: str | None = None
    reference: str | None = None
    hold_out: str | None = None
    resampling: str = "bicubic"
    harmonise: str | None = None
    metres_per_unit: float | None = None
    fit: str = "none"
    quality: int | None = None

    def __post_init__(self) -> None:
        self._check_fit()
        if self.textures is not None and self.textures < 0:
            raise OptionError("textures", f"{self.textures} eigen textures were asked for", remedy="ask for 0 or more")
        check_scale(self.metres_per_unit)
        if self.uv_ssim is not None and not 0 < self.uv_ssim <= 1:
            raise OptionError("uv-ssim", f"an SSIM of {self.uv_ssim:g} was asked for", remedy="ask for one in (0, 1]")
        if self.resampling not in FILTERS:
            raise OptionError(
                "resampling", f"no filter is called {self.resampling}", remedy=f"use one of {', '.join(FILTERS)}"
            )
        check_density(self.density)
        if self.harmonise is not None:
            check_model(self.harmonise)
        if self.atlas is not None:
            sides = (self.atlas,) if isinstance(self.atlas, int) else self.atlas
            if not all(1 <= side <= SIDE_LIMIT for side in sides):
                raise OptionError(
                    "atlas", f"an atlas of {self.atlas} was asked for", remedy=f"ask for sides from 1 to {SIDE_LIMIT}"
                )

    def _check_fit(self) -> None:
        if self.fit not in FITS:
            raise OptionError("fit", f"no fit is called {self.fit}", remedy=f"use one of {', '.join(FITS)}")
        if self.quality is not None and not 0 <= self.quality <= 100:
            raise OptionError("quality", f"a quality of {self.quality}", remedy="use 0 to 100")
        asked = {"align": self.align, "uv-ssim": self.uv_ssim, "harmonise": self.harmonise}
        maps = [name for name, value in asked.items() if value is not None]
        if self.fit != "none" and maps:
            raise OptionError(
                "fit", f"--{maps[0]} is about texture maps, and a fit makes none", remedy="leave it out, or --fit none"
            )


def check_options(capture: LightField | PhotoSet, options: Options) -> None:
    """Raise OptionError for what `encode` will refuse for this capture, before its cameras and proxy are estimated."""
    if isinstance(capture, LightField):
        places = fit_view_plane(capture.cameras).coordinates([camera.centre for camera in capture.cameras])
    elif capture.layout is not None:
        places = np.stack([capture.layout.columns, capture.layout.rows], axis=1).astype(np.float64)
    elif options.hold_out == "odd":
        return  # cameras will tell
    else:
        places = np.zeros((len(capture), 2))
    held = held_out_cameras(options.hold_out, capture.names, places)
    _reference(options.reference, capture.names, places, np.flatnonzero(~held))


def encode(
    capture: LightField,
    proxy: str | os.PathLike[str] | Mesh,
    *,
    textures: int | None = None,
    uv_ssim: float | None = None,
    density: float = DEFAULT_DENSITY,
    atlas: int | tuple[int, int] | None = None,
    triangles: int | None = None,
    align: str | None = None,
    reference: str | None = None,
    hold_out: str | None = None,
    resampling: str = "bicubic",
    harmonise: str | None = None,
    metres_per_unit: float | None = None,
    fit: str = "none",
    quality: int | None = None,
    keep_maps: str | os.PathLike[str] | None = None,
    work: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Scene:
    """Encode a light field on a proxy mesh (the paper's sections 3.2 and 3.3).

    textures: N, at most one less than there are encoded cameras; None: 15, of a fit by the number of cameras.
    uv_ssim: instead, the smallest N whose UV measure reaches this. density: atlas texels per photograph pixel along
    one axis, in the camera nearest the centre; the side is at most 4096, and the texels at most twice the
    photographs' pixels. atlas: its side, or (width, height), outright. triangles: simplify the proxy to this many;
    without it only a mesh that needs an atlas and has over 30,000. align: "dis" or "tvl1", optical-flow alignment to
    the reference camera. reference: its name; without it the camera nearest the centre of the array. hold_out: "odd",
    "every:K" or names separated by commas. resampling: "bicubic", "lanczos" or "bilinear". harmonise: "gain" or
    "affine", take the cameras' differences of exposure and white balance out of the maps (`texturing.harmonise`); the
    scene keeps them for drawing its captured cameras. metres_per_unit: metres in one unit of the cameras' world, by
    which a headset shows the scene in its real size; without it what the capture's format says, if it does. fit:
    "none" is the paper's way; "photographs" fits means, textures and weights, luma apart from chroma, until the drawn
    pictures match the photographs, to textures as they are coded at `quality` (0 to 100): `align`, `uv_ssim`,
    `harmonise`, `resampling` and `keep_maps` are about texture maps, which it does not make. keep_maps: folder for
    the filled maps and visibility as pictures. work: folder for the scratch file (4 bytes x channels x cameras x
    texels).

    Raises CaptureError, ProxyError, OptionError, OutputError, each naming the file and the remedy.
    """
    options = Options(
        textures, uv_ssim, density, atlas, align, reference, hold_out, resampling, harmonise, metres_per_unit, fit,
        quality,
    )  # fmt: skip
    if fit != "none" and keep_maps is not None:
        raise OptionError("fit", "a fit makes no texture maps to keep", remedy="leave --keep-maps out, or --fit none")
    names = [view.name for view in capture.views]
    cameras = [view.camera.rounded() for view in capture.views]
    plane = fit_view_plane(cameras)
    coordinates = plane.coordinates([camera.centre for camera in cameras])
    held = held_out_cameras(hold_out, names, coordinates)
    encoded = np.flatnonzero(~held)
    centre = _reference(options.reference, names, coordinates, encoded)

    mesh = prepare_proxy(proxy, cameras, triangles=triangles, progress=progress)
    _warn_of_rounding([view.camera for view in capture.views], cameras, mesh)
    streams: dict[str, bytes] = {}
    if options.fit != "none":
        streams["mesh"], mesh = code_mesh(mesh, cameras, centre)
        streams["cameras"], coded = code_cameras_of(cameras, mesh, _grid_of(coordinates, np.arange(len(cameras))))
        cameras = list(coded)
        plane = fit_view_plane(cameras)
        coordinates = plane.coordinates([camera.centre for camera in cameras])
    width, height = _atlas_size(options, mesh, cameras[centre], [cameras[i] for i in encoded])
    shown = capture.subset(encoded.tolist())

    def photograph(index: int) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
        picture = shown.photograph(index)
        return picture.pixels, picture.mask

    used = [cameras[i] for i in encoded]
    place = None if work is None else Path(work)
    fitted, to_rgb = None, None
    if options.fit != "none":
        grid = _grid_of(coordinates, encoded)
        planes, to_rgb, reached = _fit(used, photograph, mesh, (height, width), grid, options, place, progress)
        own: dict[str, Any] = {"fit": options.fit, "fitted": reached}
    else:
        layout = make_atlas(mesh, width, height)
        with texture_maps(layout, used, photograph, resampling=resampling, work=place, progress=progress) as maps:
            fitted = None if harmonise is None else harmonise_maps(maps, harmonise, progress)
            shown_names = [names[i] for i in encoded]
            scene_basis, mean, spreader = _decompose(
                maps, shown_names, options, int(np.searchsorted(encoded, centre)), place, progress
            )
            if keep_maps is not None:
                write_maps(maps, mean.values, spreader, shown_names, Path(keep_maps), progress=progress)
        planes = (Plane(spreader(mean.values), (scene_basis,)),)
        own = {"uvSsim": uv_ssim, "align": align, "resampling": resampling}
    settings = {
        "textures": max(sum(basis.count for basis in one.bases) for one in planes),
        "atlas": [width, height],
        "density": round(float(np.sqrt(width * height)) * texels_per_pixel(mesh, cameras[centre]), 4),
        "holdOut": hold_out,
        **own,
        **({} if harmonise is None else {"harmonise": harmonise}),
        **_scale(capture, metres_per_unit),
        **_lenses(capture),
        "photographs": {
            "count": len(encoded),
            "bytes": sum(capture.bytes(int(i)) for i in encoded),
            "pixels": sum(camera.width * camera.height for camera in used),
        },
    }
    return Scene(
        mesh=mesh,
        planes=planes,
        names=tuple(names),
        cameras=tuple(cameras),
        held_out=held,
        reference=centre,
        view_plane=plane,
        triangles=delaunay_triangles(coordinates[encoded]),
        settings=settings,
        generator=f"eigenfield {__version__}",
        colours=None if fitted is None else _colours(fitted, held),
        to_rgb=to_rgb,
        streams=streams,
    )


def _grid_of(coordinates: NDArray[np.float64], some: NDArray[np.int64]) -> NDArray[np.int64] | None:
    """(rows, columns) of the cameras `some`, counted among themselves, where they stand on a grid; else None."""
    grid = find_grid(coordinates[some])
    return None if grid is None else grid.index.astype(np.int64)


def _fit(
    cameras: Sequence[Camera],
    photograph: Callable[[int], tuple[NDArray[np.float32], NDArray[np.float32] | None]],
    mesh: Mesh,
    atlas: tuple[int, int],
    grid: NDArray[np.int64] | None,
    options: Options,
    work: Path | None,
    progress: Progress | None,
) -> tuple[tuple[Plane, ...], NDArray[np.float32], dict[str, Any]]:
    """Planes fitted to the photographs, the matrix that joins them, and what the settings say of the fit."""
    textures = fitted_textures(len(cameras)) if options.textures is None else options.textures
    quality = FIT_QUALITY if options.quality is None else options.quality
    with open_shots(cameras, photograph, mesh, atlas, work, progress) as shots:
        count = component_count(textures, len(cameras))
        planes, to_rgb, found = fit_planes(shots, count, quality, grid, work, progress)
    reached = {name: {"uncoded": round(one.uncoded, 3), "coded": round(one.coded, 3)} for name, one in found.items()}
    return planes, to_rgb, {"quality": quality, "psnr": reached}


def _decompose(
    maps: TextureMaps,
    names: Sequence[str],
    options: Options,
    reference: int,
    work: Path | None,
    progress: Progress | None,
) -> tuple[Basis, Mean, Spreader]:
    if options.align is not None:
        align_maps(maps, reference, options.align, progress)
    mean = mean_map(maps, progress)
    if not mean.seen.any():
        raise CaptureError(
            "nothing-seen",
            "no camera sees any texel of the proxy",
            remedy="bring mesh and cameras into one frame (eigenfield inspect --overlay shows both); look at the masks",
        )
    gram = gram_matrix(maps, mean, progress)
    warn_of_disagreement(maps, mean, gram, names, aligned=options.align is not None)
    decomposition = spectrum(gram)
    spreader = make_spreader(maps.atlas, mean.seen)
    if options.uv_ssim is None:
        asked = DEFAULT_TEXTURES if options.textures is None else options.textures
        count = component_count(asked, maps.cameras)
    else:
        average = spreader(mean.values)
        count = smallest_count(maps, mean, average, decomposition, options.uv_ssim, work=work, progress=progress)
    weights = weights_of(decomposition, count)
    compact = eigen_textures(maps, mean, weights, progress)
    pictures = np.zeros((count, maps.atlas.height, maps.atlas.width, maps.channels), np.float32)
    for index in range(count):
        pictures[index] = spreader(compact[index])
    ones, zeros = np.ones((count, maps.channels), np.float32), np.zeros((count, maps.channels), np.float32)
    return Basis(pictures, ones, zeros, weights), mean, spreader


def _colours(fitted: NDArray[np.float32], held: NDArray[np.bool_]) -> NDArray[np.float32]:
    """(Nc, 2, 3) for all cameras: a held-out one, of which nothing may be known, has gain 1 and offset 0."""
    colours = np.zeros((len(held), 2, 3), np.float32)
    colours[:, 0] = 1
    colours[~held] = fitted
    return colours


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
        side = atlas_side(mesh, camera, options.density, pixels)
        reached = side * texels_per_pixel(mesh, camera)
        if reached < 0.98 * options.density:
            log.warning("the atlas is capped at %d: density %.2f instead of %.2f", side, reached, options.density)
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
