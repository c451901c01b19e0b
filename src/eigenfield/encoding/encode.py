"""The stages in order: a calibrated capture and a proxy in, an eigen-texture scene out."""

from __future__ import annotations

import contextlib
import logging
import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture import LightField
from eigenfield.core.errors import CaptureError
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
from eigenfield.core.scene import Basis, Plane, Scene
from eigenfield.encoding.fitted import (
    KINDS,
    Shots,
    Target,
    compared,
    fitted_textures,
    open_fits,
    open_shots,
    reach,
    to_rgb,
    warn_of_miss,
)
from eigenfield.encoding.plan import (
    DEFAULT_DENSITY,
    DEFAULT_RESAMPLING,
    DEFAULT_TEXTURES,
    Draft,
    Options,
    check_options,
    make_draft,
)
from eigenfield.encoding.projected import (
    Mean,
    Spreader,
    TextureMaps,
    align_maps,
    component_count,
    disagreement_of,
    eigen_textures,
    gram_matrix,
    harmonise_maps,
    make_atlas,
    make_spreader,
    mean_map,
    smallest_count,
    spectrum,
    texture_maps,
    warn_of_disagreement,
    weights_of,
    write_maps,
)

__all__ = ["DEFAULT_DENSITY", "Options", "Target", "check_options", "encode", "open_fitted"]

log = logging.getLogger("eigenfield.encode")

MESH_SHARE = 0.03  # of a file: what another mesh must save or cost for a second fit
NEAR = 3  # qualities beside the preset's that have as good as its mesh and atlas
DENSITY_SHARE = 0.1  # by which another atlas must be coarser or finer


def encode(
    capture: LightField,
    proxy: str | os.PathLike[str] | Mesh,
    *,
    textures: int | None = None,
    uv_ssim: float | None = None,
    density: float | None = None,
    atlas: int | tuple[int, int] | None = None,
    triangles: int | None = None,
    align: str | None = None,
    reference: str | None = None,
    hold_out: str | None = None,
    resampling: str | None = None,
    harmonise: str | None = None,
    metres_per_unit: float | None = None,
    fit: str | None = None,
    preset: str | None = None,
    quality: int | None = None,
    target: Target | None = None,
    planes: str | None = None,
    keep_maps: str | os.PathLike[str] | None = None,
    work: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Scene:
    """Encode a light field on a proxy mesh, fitted to its photographs, or as the paper does (its sections 3.2 and 3.3).

    textures: N, at most one less than there are encoded cameras; None: by the number of cameras, without a fit 15.
    Of a fit a region with much of the error gets up to as many of its own.
    uv_ssim: instead, the smallest N whose UV measure reaches this. density: atlas texels per photograph pixel along
    one axis, in the camera nearest the centre, at most 4096 a side and twice the photographs' pixels; None: 1.5, of a
    fit what its quality pays for (`density_of`). atlas: its side, or (width, height), outright. triangles: simplify the
    proxy to this many; without it only a mesh that needs an atlas and has over 30,000, and for a
    fit any mesh, by what its pictures lose (`simplification`). align: "dis" or "tvl1", optical-flow alignment to
    the reference camera. reference: its name; without it the camera nearest the centre of the array. hold_out: "odd",
    "every:K" or names separated by commas. resampling: "bicubic" (None), "lanczos" or "bilinear". harmonise: "gain" or
    "affine", take the cameras' differences of exposure and white balance out of the maps (`texturing.harmonise`); the
    scene keeps them for drawing its captured cameras. metres_per_unit: metres in one unit of the cameras' world, by
    which a headset shows the scene in its real size; without it what the capture's format says, if it does. fit:
    "photographs" fits means, textures and weights, luma apart from chroma, until the drawn pictures match the
    photographs, to textures as they are coded, on a proxy whose vertices have moved to where they agree; "none" is the
    paper's way. `align`, `uv_ssim`, `harmonise`, `resampling` and `keep_maps` are about texture maps, which a fit does
    not make; None: "none" if one of them is asked for, with a warning, else "photographs". preset: "small", "balanced"
    (None) or "best", how finely and with how much patience a fit is made and coded. quality: of a fit, 0 to 100 instead
    of the preset's. target: the quality is searched for, until the file reaches it, with a second fit where another
    mesh belongs to it; where none does, the nearest, with a warning. planes: "luma-chroma" (None), or "rgb", one plane
    for all of a fit, as the paper has it. keep_maps: folder for the filled maps and visibility as pictures. work:
    folder for scratch files (up to 17 bytes a pixel; 4 bytes x channels x cameras x texels).

    Raises CaptureError, ProxyError, OptionError, OutputError, each naming the file and the remedy.
    """
    options = Options(
        textures, uv_ssim, density, atlas, align, reference, hold_out, resampling, harmonise, metres_per_unit, fit,
        preset, quality, target, keep_maps, planes=planes,
    )  # fmt: skip
    place = None if work is None else Path(work)
    draft = make_draft(capture, proxy, options, triangles, place, progress)
    if target is not None:
        return _reached(target, draft, place, progress)
    if options.fit != "none":
        with _fitted(draft, place, progress) as (coded, measured, _):
            return measured(coded(options.fit_quality))
    layout = make_atlas(draft.mesh, *draft.atlas)
    resampling = DEFAULT_RESAMPLING if resampling is None else resampling
    with texture_maps(
        layout, draft.encoded_cameras, draft.observations, resampling=resampling, work=place, progress=progress
    ) as maps:
        fitted = None if harmonise is None else harmonise_maps(maps, harmonise, progress)
        scene_basis, mean, spreader = _decompose(maps, draft, place, progress)
        if keep_maps is not None:
            write_maps(maps, mean.values, spreader, draft.encoded_names, Path(keep_maps), progress=progress)
    own = {"uvSsim": uv_ssim, "align": align, "resampling": resampling}
    if harmonise is not None:
        own["harmonise"] = harmonise
    return draft.scene(
        (Plane(spreader(mean.values), (scene_basis,)),), own,
        colours=None if fitted is None else _colours(fitted, draft.held_out),
    )  # fmt: skip


@contextlib.contextmanager
def open_fitted(
    capture: LightField,
    proxy: str | os.PathLike[str] | Mesh,
    options: Options,
    work: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Iterator[Callable[[int], Scene]]:
    """Fit once, code at many qualities (0 to 100): what `encode` with these options and `fit="photographs"` makes of
    each. Errors as there."""
    options = replace(options, fit="photographs")
    place = None if work is None else Path(work)
    draft = make_draft(capture, proxy, options, None, place, progress)
    with _fitted(draft, place, progress) as (coded, measured, _):
        yield lambda quality: measured(coded(quality))


@contextlib.contextmanager
def _fitted(
    draft: Draft, work: Path | None, progress: Progress | None, warn: bool = True
) -> Iterator[tuple[Callable[[int], Scene], Callable[[Scene], Scene], Shots]]:
    """Planes fitted to the draft's photographs, as scenes coded at a quality; such a scene with the figures that it has
    room for; and those photographs."""
    options, used = draft.options, draft.encoded_cameras
    asked = fitted_textures(len(used)) if options.textures is None else options.textures
    atlas = draft.atlas[1], draft.atlas[0]
    with (
        open_shots(used, draft.observations, draft.mesh, atlas, work, progress, draft.encoded_reference) as shots,
        open_fits(
            shots,
            draft.density,
            component_count(asked, len(used)),
            options.fit_preset,
            KINDS[options.fit_planes],
            work,
            progress,
        ) as fits,
    ):
        if warn:
            apart = fits.planes[0][1].mean_alone
            places = draft.coordinates[draft.encoded]
            warn_of_disagreement(apart.squares, apart.pixels, apart.channels, apart.total, draft.encoded_names, places)

        def coded(quality: int) -> Scene:
            coder = {"coder": "libaom"} if fits.patient else {}
            own = {"fit": options.fit, "fitted": {"quality": quality, **coder, "psnr": fits.reached()}}
            planes = fits.coded(quality, draft.grid, progress)
            matrix = None if options.fit_planes == "rgb" else to_rgb()
            return draft.scene(tuple(planes.values()), own, to_rgb=matrix)

        def measured(scene: Scene) -> Scene:
            fitted = {**scene.settings["fitted"], "psnr": fits.reached(scene.planes)}
            return replace(scene, settings={**scene.settings, "fitted": fitted})

        yield coded, measured, shots


def _reached(target: Target, draft: Draft, work: Path | None, progress: Progress | None) -> Scene:
    """The scene that reaches a target, or with a warning the nearest. A relief has the triangles that the preset's
    quality pays for, and the atlas its density; where the target is met at a quality that pays for others, there is a
    second fit, on those, and the better file of both is kept."""
    with _fitted(draft, work, progress) as (coded, measured, shots):
        found, met = reach(target, coded, shots)
        scene = measured(found.result)
        near = abs(found.quality - draft.options.fit_quality) <= NEAR
        other = draft if near else draft.at_quality(found.quality)
        again = (
            abs(other.mesh_bytes - draft.mesh_bytes) >= MESH_SHARE * found.size
            or abs(other.atlas[0] / draft.atlas[0] - 1) >= DENSITY_SHARE
        )
        if again:
            found = compared(target, found, shots)
    if again:
        words = "fitted again for quality %d: mesh %d bytes instead of %d, atlas %dx%d instead of %dx%d"
        log.info(words, found.quality, other.mesh_bytes, draft.mesh_bytes, *other.atlas, *draft.atlas)
        with _fitted(other, work, progress, warn=False) as (coded, measured, shots):
            second, met_again = reach(target, coded, shots, found.quality)
            second = compared(target, second, shots)
            sizes = second.size, second.measured, found.size, found.measured
            if target.worth(second) > target.worth(found):
                log.info("kept: %d bytes, %.4f instead of %d, %.4f", *sizes)
                found, met, scene = second, met_again, measured(second.result)
            else:
                log.info("not kept: %d bytes, %.4f, and the first has %d, %.4f", *sizes)
    if not met:
        warn_of_miss(target, found)
    return scene


def _decompose(
    maps: TextureMaps, draft: Draft, work: Path | None, progress: Progress | None
) -> tuple[Basis, Mean, Spreader]:
    options, names = draft.options, draft.encoded_names
    reference = draft.encoded_reference
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
    disagreement_of(maps, mean, gram, names, draft.coordinates[draft.encoded], aligned=options.align is not None)
    decomposition = spectrum(gram)
    spreader = make_spreader(maps.atlas, mean.seen)
    if options.uv_ssim is None:
        asked = DEFAULT_TEXTURES if options.textures is None else options.textures
        count = component_count(asked, maps.count)
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
