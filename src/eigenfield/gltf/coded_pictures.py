"""A scene's pictures to files: those that are coded already as they are, the others as 8-bit codes; and the preview."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures import quantise
from eigenfield.coding.pictures.pictures_8bit import (
    PREVIEW_MAX_SIDE_TEXELS,
    encode_masked_preview,
    encode_preview,
)
from eigenfield.coding.stacking import DEFAULT_CODEC, encode, stacked_picture
from eigenfield.core.appearance import Basis, Plane
from eigenfield.core.payloads import Affine, Payload, PicturePayload, size_of
from eigenfield.core.progress import Progress
from eigenfield.core.scene import Scene
from eigenfield.gltf.cached import CachedPayloads
from eigenfield.runtime.parallel import tracked_map

MASKED_PREVIEW_COLOURS = 256
MEAN_QUALITY_RATIO = 0.3  # of the mean's distance to quality 100 to the textures': there a byte gains as much (Tarot)


@dataclass(frozen=True, eq=False)
class PlanePictures:
    """The pictures of a plane: of its mean, and of each basis's textures by rank."""

    mean: PicturePayload
    bases: Sequence[Sequence[PicturePayload]]


@dataclass(frozen=True, eq=False)
class ScenePictures:
    """All pictures of a file.

    Attributes:
        preview: For `images[0]`, of a mesh that is not coded; None where the first plane's mean itself is shown.
    """

    preview: Payload | None
    planes: list[PlanePictures]
    opacity: PicturePayload | None

    @property
    def bytes(self) -> int:
        """Of all planes, and of the opacity."""
        return sum(self.sizes.values())

    @property
    def sizes(self) -> dict[str, int]:
        """Bytes by part, named as in `CachedPayloads`."""
        means = {f"planes[{p}].mean": len(plane.mean.data) for p, plane in enumerate(self.planes)}
        opacity = {} if self.opacity is None else {"opacity": len(self.opacity.data)}
        return (
            opacity
            | means
            | {
                f"planes[{p}].bases[{b}].textures": size_of(pictures)
                for p, plane in enumerate(self.planes)
                for b, pictures in enumerate(plane.bases)
            }
        )


def code_pictures(
    scene: Scene, cached: CachedPayloads, codec: str | None, quality: int, progress: Progress | None
) -> ScenePictures:
    """Every picture of the scene; coding is shared among the threads.

    Args:
        cached: Its payloads, which are taken unless a codec is asked for.
        codec: For all pictures; None: the default for those without a payload.
    """
    fine, to_rgb = round(100 - MEAN_QUALITY_RATIO * (100 - quality)), scene.appearance.to_rgb
    planned, sheets = [], scene.proxy.sheets
    for p, plane in enumerate(scene.appearance.planes):
        one_unit = to_rgb is not None or _is_harmonised(scene, plane) or quantise.is_photographic(plane.mean)
        parts = [f"planes[{p}].mean", *(f"planes[{p}].bases[{b}].textures" for b in range(len(plane.bases)))]
        ways = [partial(_mean, scene, plane, codec or DEFAULT_CODEC, fine)]
        ways += [partial(_textures, basis, codec or DEFAULT_CODEC, quality, one_unit) for basis in plane.bases]
        there = [cached.pictures(part) if codec is None else () for part in parts]
        planned.append(
            [[partial(_same_picture, one) for one in some] or way() for some, way in zip(there, ways, strict=True)]
        )
    if sheets is not None:
        kept = cached.pictures("opacity") if codec is None else ()
        way = partial(_opacity, sheets.opacity, codec or DEFAULT_CODEC, fine)
        planned.append([[partial(_same_picture, one) for one in kept] or [way]])
    jobs = [job for plan in planned for some in plan for job in some]
    done = iter(tracked_map(lambda job: job(), jobs, "code textures", progress))
    planes = []
    for plan in planned[: len(scene.appearance.planes)]:
        files = [[next(done) for _ in some] for some in plan]
        planes.append(PlanePictures(files[0][0], files[1:]))
    first, pictures = planes[0].mean, ScenePictures(None, planes, next(done, None))
    plain = sheets is None and to_rgb is None and scene.appearance.planes[0].mean.shape[2] in (1, 3)
    if cached.one("mesh") is not None or (plain and first.codec == "png" and first.affine is None):
        return pictures  # other viewers are shown another mesh, or the mean itself
    preview = cached.one("preview") if codec is None else None
    return replace(pictures, preview=preview or _preview(scene))


def _mean(scene: Scene, plane: Plane, codec: str, quality: int) -> list[Callable[[], PicturePayload]]:
    codes, affine = quantise.mean_codes(plane.mean, _is_harmonised(scene, plane))
    return [partial(_code, codes, codec, quality, affine)]


def _opacity(opacity: NDArray[np.float32], codec: str, quality: int) -> PicturePayload:
    return _code(quantise.opacity_codes(opacity), codec, quality, None)


def _textures(basis: Basis, codec: str, quality: int, one_unit: bool) -> list[Callable[[], PicturePayload]]:
    scale, zero = quantise.basis_scale(basis, one_unit)
    return [partial(_code_texture, basis, k, scale, zero, codec, quality) for k in range(basis.count)]


def _same_picture(picture: PicturePayload) -> PicturePayload:
    return picture


def _is_harmonised(scene: Scene, plane: Plane) -> bool:
    """Whether a plane holds colours brought together by gains, which may lie beyond 0..1 and yet are photographs'."""
    return scene.appearance.colours is not None and plane is scene.appearance.planes[0]


def _code(codes: NDArray[np.uint8], codec: str, quality: int, affine: Affine | None) -> PicturePayload:
    return PicturePayload(codec, encode(codes, codec, quality), 1, affine)


def _code_texture(
    basis: Basis, index: int, scale: NDArray[np.float32], zero: NDArray[np.float32], codec: str, quality: int
) -> PicturePayload:
    affine = Affine(np.array(shortest_decimals(scale[index])), np.array(shortest_decimals(zero[index])))
    return _code(quantise.texture_codes(basis, index, scale, zero), codec, quality, affine)


def _preview(scene: Scene) -> Payload:
    """A picture for every glTF viewer. Of sheets it is a PNG with holes where they are less than half opaque."""
    picture, sheets = shown_mean(scene), scene.proxy.sheets
    if sheets is None:
        return Payload("jpeg", encode_preview(picture))
    opacity = quantise.opacity_codes(sheets.opacity)[..., 0]
    return Payload("png", encode_masked_preview(picture, opacity, PREVIEW_MAX_SIDE_TEXELS, MASKED_PREVIEW_COLOURS))


def shown_mean(scene: Scene) -> NDArray[np.uint8]:
    """(H, W) or (H, W, 3) codes: R, G, B of the mean as they are; else its first one or three channels, stretched."""
    to_rgb = scene.appearance.to_rgb
    mean = scene.appearance.planes[0].mean if to_rgb is None else _rgb_mean(scene, to_rgb)
    if scene.appearance.colours is not None:
        mean = mean.clip(0, 1)
    shown = mean if mean.shape[2] in (1, 3) else mean[..., : 3 if mean.shape[2] > 3 else 1]
    if not quantise.is_photographic(mean) and not quantise.is_unit_range(shown):
        low, high = shown.min(axis=(0, 1)), shown.max(axis=(0, 1))
        shown = (shown - low) / np.where(high > low, high - low, 1)
    return stacked_picture(np.rint(shown * 255).clip(0, 255).astype(np.uint8))


def _rgb_mean(scene: Scene, to_rgb: NDArray[np.float32]) -> NDArray[np.float32]:
    """(H, W, 3): the means of all planes as R, G, B, at the size of the first; near enough for a preview."""
    import cv2

    height, width = scene.appearance.planes[0].mean.shape[:2]
    means = [plane.mean for plane in scene.appearance.planes]
    resized = [cv2.resize(mean, (width, height), interpolation=cv2.INTER_LINEAR) for mean in means]
    stacked = np.concatenate([np.atleast_3d(np.asarray(one)) for one in resized], axis=2)
    return np.asarray(stacked @ to_rgb.T, np.float32).clip(0, 1)


def shortest_decimals(numbers: NDArray[Any]) -> list[float]:
    """The shortest decimals of the same numbers."""
    return [float(str(number)) for number in numbers.ravel()]


def affine_numbers(numbers: NDArray[np.float64], count: int) -> list[float]:
    """The numbers of `count` textures; of one, where all have the same."""
    each = numbers.reshape(count, -1)
    return shortest_decimals(each[:1] if (each == each[0]).all() else each)
