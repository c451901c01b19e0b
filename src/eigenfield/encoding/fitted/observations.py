"""The photographs that a fit is held against: decoded once, beside the footprints of their cameras."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.observations import Observations, cameras_of
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.fitted.footprints import (
    Footprint,
    Footprints,
    offsets_of,
    open_footprints,
    sample_corner,
    subsampled_footprints,
)
from eigenfield.encoding.fitted.kernels import target
from eigenfield.imaging.metrics import to_codes
from eigenfield.rendering.software.drawing import make_surface, median_footprint
from eigenfield.runtime.files import scratch_array
from eigenfield.runtime.parallel import tracked_map

MAX_WEIGHT_RATIO = 4.0  # of one photograph's pixels to the median's


@dataclass(frozen=True, eq=False)
class DecodedObservations:
    """No photographs as 8-bit codes, which is what the measures compare with, and what their pixels count for.

    Attributes:
        cameras: (No,) the camera of each observation.
        shapes: (h, w) of each observation.
        codes: (pixels of all, 3) uint8, R, G, B, observation by observation.
        offsets: (No + 1,) where the pixels of each observation begin.
        masks: (pixels of all,) uint8, 0 where a pixel does not count, else what it counts for, 255 for whole; None:
            all count.
        robust: (pixels of all,) uint8, 255 times mask times robust (IRLS) weight, which `render_and_backproject`
            updates; None: the masks alone count.
        colours: (No, 2, 3) float32 gains and offsets of R, G, B, by which what is fitted to are the photographs in a
            common exposure; None: the photographs as they are.
    """

    cameras: NDArray[np.int64]
    shapes: tuple[tuple[int, int], ...]
    codes: NDArray[np.uint8]
    offsets: NDArray[np.int64]
    masks: NDArray[np.uint8] | None = None
    robust: NDArray[np.uint8] | None = None
    colours: NDArray[np.float32] | None = None

    def __len__(self) -> int:
        return len(self.shapes)

    def camera_of(self, index: int) -> int:
        return int(self.cameras[index])

    def codes_of(self, index: int) -> NDArray[np.uint8]:
        """(h, w, 3) of an observation."""
        return self._part(self.codes, index)

    def mask(self, index: int) -> NDArray[np.uint8]:
        """(h, w) `masks` of an observation, or (0, 0) where all count."""
        return np.zeros((0, 0), np.uint8) if self.masks is None else self._part(self.masks, index)[..., 0]

    def weights(self, index: int) -> NDArray[np.uint8]:
        """(h, w) what the pixels of an observation count for, 255 for whole, or (0, 0) where all do."""
        return self.mask(index) if self.robust is None else self._part(self.robust, index)[..., 0]

    def _part(self, of: NDArray[Any], index: int) -> NDArray[Any]:
        return np.asarray(of[self.offsets[index] : self.offsets[index + 1]]).reshape(*self.shapes[index], -1)


@dataclass(frozen=True, eq=False)
class FitData:
    """The data of a fit. Several observations of a camera, at different times, share its footprint."""

    observations: DecodedObservations
    footprints: Footprints

    def __len__(self) -> int:
        return len(self.observations)

    @property
    def size(self) -> tuple[int, int]:
        """(rows, columns) of the finest atlas, which texel coordinates count in."""
        return self.footprints.surface.size

    def footprint(self, index: int) -> Footprint:
        """(h, w) counts, (n, 2) texel coordinates and (n,) or (0,) shares of the camera of an observation."""
        return self.footprints.of(self.observations.camera_of(index))

    def white(self, matrix: NDArray[np.float32]) -> float:
        """What white of the darkest photograph is in the common exposure, in the channel of most of `matrix` (C, 3); 1
        without colours."""
        colours = self.observations.colours
        return 1.0 if colours is None else max(1.0, float((colours.sum(axis=1) @ matrix.T).max()))

    def blank(self, index: int, channels: int) -> NDArray[np.float32]:
        """(channels, h, w) zeros, as large as an observation."""
        return np.zeros((channels, *self.observations.shapes[index]), np.float32)

    def target(self, index: int, matrix: NDArray[np.float32]) -> NDArray[np.float32]:
        """(C, h, w): what is to be drawn of an observation, in the common exposure, by `matrix` (C, 3) from R, G, B."""
        image, colours = self.blank(index, len(matrix)), self.observations.colours
        gain, offset = (np.float32(1), np.zeros(3, np.float32)) if colours is None else colours[index]
        affine = np.concatenate([matrix * gain / np.float32(255), (matrix @ offset)[:, None]], axis=1)
        target(*self.footprint(index), self.observations.codes_of(index), affine.astype(np.float32), image)
        return image


@contextlib.contextmanager
def open_fit_data(
    cameras: Sequence[Camera],
    observations: Observations,
    proxy: Proxy,
    atlas: tuple[int, int],
    work: Path | None = None,
    progress: Progress | None = None,
    reference: int = 0,
    colours: NDArray[np.float32] | None = None,
) -> Iterator[FitData]:
    """Decode every photograph once, and rasterise the mesh in each camera, into scratch files of 4 bytes a pixel of the
    photographs and about 9 a pixel of the cameras: memory does not grow with their number.

    Args:
        cameras: Of the observations, which are as large as their cameras' pictures.
        observations: R, G, B.
        proxy: The surface at all their times.
        atlas: (rows, columns) of the finest texture.
        reference: Index of the scene's reference camera in `cameras`.
        colours: As of `DecodedObservations`; errors then count as in the photographs' own exposures.

    Raises:
        CaptureError: A photograph cannot be read.
        OutputError: `disk-full`.
    """
    with (
        open_camera_footprints(cameras, proxy, atlas, work, reference) as footprints,
        _open_observations(cameras, observations, colours, work, progress) as decoded,
    ):
        yield FitData(decoded, footprints)


@contextlib.contextmanager
def open_camera_footprints(
    cameras: Sequence[Camera], proxy: Proxy, atlas: tuple[int, int], work: Path | None = None, reference: int = 0
) -> Iterator[Footprints]:
    """The footprints of `open_fit_data`, which frames of a clip on one proxy share."""
    surface = make_surface(proxy.mesh, *atlas)
    detail = median_footprint(surface, cameras[reference])
    with open_footprints(surface, cameras, detail, proxy.sheets, work) as footprints:
        yield footprints


@contextlib.contextmanager
def _open_observations(
    cameras: Sequence[Camera],
    observations: Observations,
    colours: NDArray[np.float32] | None,
    work: Path | None,
    progress: Progress | None,
) -> Iterator[DecodedObservations]:
    pixels = sum(cameras[camera].height * cameras[camera].width for camera in cameras_of(observations))
    with scratch_array((pixels, 3), np.uint8, work) as codes, scratch_array((pixels,), np.uint8, work) as masks:
        yield decode_observations(cameras, observations, codes, masks, colours, progress)


def decode_observations(
    cameras: Sequence[Camera],
    observations: Observations,
    codes: NDArray[np.uint8],
    masks: NDArray[np.uint8],
    colours: NDArray[np.float32] | None = None,
    progress: Progress | None = None,
) -> DecodedObservations:
    """Decode every photograph into arrays.

    Args:
        codes: (pixels of all, 3), is filled.
        masks: (pixels of all,), is filled.
        colours: As of `DecodedObservations`.

    Raises:
        CaptureError: A photograph cannot be read.
    """
    by, total = cameras_of(observations), len(observations)
    shapes = tuple((cameras[camera].height, cameras[camera].width) for camera in by)
    offsets, whole = offsets_of([h * w for h, w in shapes]), _whole_weights(total, colours)

    def put(index: int) -> bool:
        photograph = observations.photograph(index)
        mask, part = photograph.mask, slice(offsets[index], offsets[index + 1])
        codes[part] = to_codes(photograph.pixels).reshape(-1, 3)
        masks[part] = whole[index] if mask is None else np.where(mask > 0.5, whole[index], 0).reshape(-1)
        return mask is not None

    masked = tracked_map(put, range(total), "photographs", progress)
    few = any(masked) or bool((whole < 255).any())
    return DecodedObservations(by, shapes, codes, offsets, masks if few else None, colours=colours)


def _whole_weights(count: int, colours: NDArray[np.float32] | None) -> NDArray[np.uint8]:
    """(No,) what a pixel of each observation counts for at most, 255 for whole: an error in the common exposure is
    1 / gain of it in the photograph's own. The brightest counts whole, or those MAX_WEIGHT_RATIO above the median."""
    if colours is None:
        return np.full(count, 255, np.uint8)
    squares = (1 / np.square(colours[:, 0].astype(np.float64))).mean(axis=1)
    most = min(squares.max(), MAX_WEIGHT_RATIO * float(np.median(squares)))
    return np.rint(255 * np.clip(squares / most, 1 / 255, 1)).astype(np.uint8)


@contextlib.contextmanager
def open_on_proxy(
    data: FitData, cameras: Sequence[Camera], proxy: Proxy, work: Path | None = None
) -> Iterator[FitData]:
    """The same observations on another proxy under as large an atlas."""
    surface = make_surface(proxy.mesh, *data.size)
    with open_footprints(surface, cameras, data.footprints.detail, proxy.sheets, work) as footprints:
        yield replace(data, footprints=footprints)


@contextlib.contextmanager
def open_subsampled(
    data: FitData, step: int, work: Path | None = None, made: Footprints | None = None
) -> Iterator[FitData]:
    """Every `step`-th pixel each way, from a corner that changes with the camera; step 1: the data themselves.

    Args:
        made: The footprints of these pixels, where they are there already.
    """
    if step == 1:
        yield data
        return
    given = data.observations
    thinned = subsampled_footprints(data.footprints, step, work) if made is None else contextlib.nullcontext(made)
    with thinned as footprints:
        shapes = tuple(footprints.shapes[given.camera_of(index)] for index in range(len(data)))
        offsets = offsets_of([h * w for h, w in shapes])
        with (
            scratch_array((int(offsets[-1]), 3), np.uint8, work) as codes,
            scratch_array((0 if given.masks is None else int(offsets[-1]),), np.uint8, work) as masks,
        ):
            for index in range(len(data)):
                part, corner = slice(offsets[index], offsets[index + 1]), sample_corner(given.camera_of(index), step)
                codes[part] = given.codes_of(index)[corner].reshape(-1, 3)
                if given.masks is not None:
                    masks[part] = given.mask(index)[corner].reshape(-1)
            few = None if given.masks is None else masks
            subsampled = replace(given, shapes=shapes, codes=codes, offsets=offsets, masks=few, robust=None)
            yield FitData(subsampled, footprints)


@contextlib.contextmanager
def with_robust_weights(data: FitData, work: Path | None = None) -> Iterator[FitData]:
    """The same data, whose pixels `render_and_backproject` may let count for less: a byte a pixel more on disk."""
    given = data.observations
    with scratch_array((int(given.offsets[-1]),), np.uint8, work) as robust:
        robust[:] = 255 if given.masks is None else given.masks
        yield replace(data, observations=replace(given, robust=robust))
