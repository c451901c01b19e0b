"""A scene's pictures to files: those that are coded already as they are, the others as 8-bit codes; and the preview."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures import pictures_8bit as pictures
from eigenfield.coding.pictures import quantise
from eigenfield.core.payloads import Affine, PictureFile, files_of
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Basis, Plane, Scene
from eigenfield.gltf.coarse import affordable
from eigenfield.runtime.parallel import parallel_stream

SMALL_PREVIEWS = (128, 50), (96, 40), (64, 30)  # texels and quality beside a fit's pictures, the first that is in SHARE
MEAN_SHARE = 0.3  # of the textures' distance to quality 100 is the mean's: there a byte gains as much (Tarot)


@dataclass(frozen=True, eq=False)
class CodedPlane:
    """The files of a plane's mean and of each basis's textures, by rank."""

    mean: PictureFile
    bases: Sequence[Sequence[PictureFile]]


@dataclass(frozen=True, eq=False)
class Coded:
    """preview: JPEG for `images[0]`, or None where the first plane's mean itself serves."""

    preview: bytes | None
    planes: list[CodedPlane]

    @property
    def bytes(self) -> int:
        """Of all planes."""
        return sum(len(file.data) for plane in self.planes for files in ([plane.mean], *plane.bases) for file in files)


def code_pictures(scene: Scene, codec: str | None, quality: int, progress: Progress | None) -> Coded:
    """Every picture of the scene, coded, the pictures shared among the threads."""
    fine = round(100 - MEAN_SHARE * (100 - quality))
    planned = []
    for plane in scene.planes:
        one_unit = _harmonised(scene, plane) or quantise.photographic(plane.mean) or scene.to_rgb is not None
        bases = [_textures(basis, codec, quality, one_unit) for basis in plane.bases]
        planned.append([_mean(scene, plane, codec, fine), *bases])
    jobs = [job for plan in planned for some in plan for job in some]
    done = iter(list(track(parallel_stream(lambda job: job(), jobs), "code textures", len(jobs), progress)))
    planes = []
    for plan in planned:
        files = [[next(done) for _ in some] for some in plan]
        planes.append(CodedPlane(files[0][0], files[1:]))
    first, coded = planes[0].mean, Coded(None, planes)
    plain = scene.to_rgb is None and scene.planes[0].mean.shape[2] in (1, 3)
    if plain and first.mime == "image/png" and first.affine is None:
        return coded  # the mean itself serves
    return replace(coded, preview=_preview(scene, coded.bytes))


def _mean(scene: Scene, plane: Plane, codec: str | None, quality: int) -> list[Callable[[], PictureFile]]:
    kept = _kept(plane, codec)
    if kept:
        return kept
    codes, affine = quantise.mean_codes(plane.mean, _harmonised(scene, plane))
    return [partial(_code, codes, codec or pictures.DEFAULT_CODEC, quality, affine)]


def _textures(basis: Basis, codec: str | None, quality: int, one_unit: bool) -> list[Callable[[], PictureFile]]:
    kept = _kept(basis, codec)
    if kept:
        return kept
    scale, zero = quantise.basis_scale(basis, one_unit)
    name = codec or pictures.DEFAULT_CODEC
    return [partial(_code_texture, basis, k, scale, zero, name, quality) for k in range(basis.count)]


def _kept(owner: Basis | Plane, codec: str | None) -> list[Callable[[], PictureFile]]:
    """The files that there are already, unless a codec was asked for."""
    return [partial(_itself, file) for file in (files_of(owner) or ()) if codec is None]


def _itself(file: PictureFile) -> PictureFile:
    return file


def _harmonised(scene: Scene, plane: Plane) -> bool:
    """Whether a plane holds colours brought together by gains, which may lie beyond 0..1 and yet are photographs'."""
    return scene.colours is not None and plane is scene.planes[0]


def _code(codes: NDArray[np.uint8], codec: str, quality: int, affine: Affine | None) -> PictureFile:
    return PictureFile(pictures.encode(codes, codec, quality), pictures.MIME_TYPES[codec], 8, 1, affine)


def _code_texture(
    basis: Basis, index: int, scale: NDArray[np.float32], zero: NDArray[np.float32], codec: str, quality: int
) -> PictureFile:
    affine = Affine(np.array(shortest(scale[index])), np.array(shortest(zero[index])))
    return _code(quantise.texture_codes(basis, index, scale, zero), codec, quality, affine)


def _preview(scene: Scene, coded: int) -> bytes:
    """Something to see for every glTF viewer: R, G, B as they are; else the first one or three channels, stretched.
    coded: bytes of the planes."""
    mean = scene.planes[0].mean if scene.to_rgb is None else _joined(scene, scene.to_rgb)
    if scene.colours is not None:
        mean = mean.clip(0, 1)
    shown = mean if mean.shape[2] in (1, 3) else mean[..., : 3 if mean.shape[2] > 3 else 1]
    if not quantise.photographic(mean) and not quantise.unit_range(shown):
        low, high = shown.min(axis=(0, 1)), shown.max(axis=(0, 1))
        shown = (shown - low) / np.where(high > low, high - low, 1)
    codes = np.rint(shown * 255).clip(0, 255).astype(np.uint8)
    if scene.to_rgb is None:
        return pictures.encode_preview(codes)
    return affordable((pictures.encode_preview(codes, *small) for small in SMALL_PREVIEWS), len, coded)


def _joined(scene: Scene, to_rgb: NDArray[np.float32]) -> NDArray[np.float32]:
    """(H, W, 3): the means of all planes as R, G, B, at the size of the first; near enough for a preview."""
    import cv2

    height, width = scene.planes[0].mean.shape[:2]
    resized = [cv2.resize(plane.mean, (width, height), interpolation=cv2.INTER_LINEAR) for plane in scene.planes]
    stacked = np.concatenate([np.atleast_3d(np.asarray(one)) for one in resized], axis=2)
    return np.asarray(stacked @ to_rgb.T, np.float32).clip(0, 1)


def shortest(numbers: NDArray[Any]) -> list[float]:
    """The shortest decimals that give the same numbers."""
    return [float(str(number)) for number in numbers.ravel()]
