"""The paper's measure: a camera's texture map against the one put together again, in UV space."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.progress import Progress, track
from eigenfield.encoding.projected.atlas import Atlas
from eigenfield.encoding.projected.eigen import Spectrum, eigen_textures, weights_of
from eigenfield.encoding.projected.mean import Mean
from eigenfield.encoding.projected.project import TextureMaps
from eigenfield.imaging.metrics import psnr, ssim, to_codes
from eigenfield.runtime.files import scratch_array
from eigenfield.runtime.parallel import parallel_stream

log = logging.getLogger("eigenfield.basis")

SAMPLE = 24  # cameras that narrow the number down before all of them decide


def measure_map(
    pictures: Iterable[NDArray[np.float32]],
    mean: NDArray[np.float32],
    atlas: Atlas,
    values: NDArray[np.float32],
    seen: NDArray[np.uint8],
) -> tuple[NDArray[np.uint8], list[tuple[float | None, float | None]]]:
    """SSIM and PSNR (dB) of each of `pictures` against a camera's map, over the texels that the camera sees.

    pictures: (H, W, C), put together with more and more textures. mean: (H, W, C), which fills what the camera does not
    see (equation 2), in both pictures. values (n, C), seen (n,): the map at the chart texels. Returns the filled map,
    (H, W, C) uint8, and a pair for each picture; None where the camera sees no texel.
    """
    filled = np.array(to_codes(mean))
    visible = np.zeros(filled.shape[:2], bool)
    texel = atlas.texel[seen > 0]
    filled.reshape(-1, filled.shape[2])[texel] = to_codes(values[seen > 0])
    visible.reshape(-1)[texel] = True
    scores = []
    for picture in pictures:
        codes = to_codes(picture)
        scores.append((ssim(codes, filled, visible), psnr(codes, filled, visible)))
    return filled, scores


def smallest_count(
    maps: TextureMaps,
    mean: Mean,
    average: NDArray[np.float32],
    decomposition: Spectrum,
    target: float,
    *,
    work: Path | None = None,
    progress: Progress | None = None,
) -> int:
    """The smallest number of eigen textures whose mean UV SSIM over the cameras reaches `target`; all of them, with a
    warning, if none does. The textures are those before coding. A sample of cameras finds about where, all decide.

    average: (H, W, C), the mean without holes, as the file will keep it. work: folder for a scratch file.
    """
    most = maps.cameras - 1
    sample = np.unique(np.linspace(0, maps.cameras - 1, min(SAMPLE, maps.cameras)).round().astype(int)).tolist()
    everyone = list(range(maps.cameras))
    limit = min(8, most)
    while True:
        weights = weights_of(decomposition, limit)
        with scratch_array((limit, maps.atlas.count, maps.channels), np.float32, work) as textures:
            textures[:] = eigen_textures(maps, mean, weights, progress)
            near = _first(_curve(maps, mean, average, textures, weights, sample, range(limit + 1), progress), target)
            if near is not None or limit == most:
                guess = limit if near is None else near
                count = _decide(maps, mean, average, textures, weights, everyone, guess, target, progress)
                if count is not None:
                    return count
                if limit == most:
                    log.warning("a UV SSIM of %g is not reached: all %d eigen textures are kept", target, most)
                    return most
        limit = min(2 * limit, most)


def _decide(
    maps: TextureMaps,
    mean: Mean,
    average: NDArray[np.float32],
    textures: NDArray[np.float32],
    weights: NDArray[np.float32],
    cameras: Sequence[int],
    guess: int,
    target: float,
    progress: Progress | None,
) -> int | None:
    """From a guess outwards, a few counts at a time, until all cameras say which count is the first to reach it."""
    low, high = max(guess - 1, 0), min(guess + 1, len(textures))
    while True:
        first = _first(_curve(maps, mean, average, textures, weights, cameras, range(low, high + 1), progress), target)
        if first is None:
            if high == len(textures):
                return None
            low, high = high + 1, min(high + 3, len(textures))
        elif first > 0 or low == 0:
            return low + first
        else:
            low, high = max(low - 3, 0), low


def _first(curve: Sequence[float], target: float) -> int | None:
    return next((index for index, value in enumerate(curve) if value >= target), None)


def _curve(
    maps: TextureMaps,
    mean: Mean,
    average: NDArray[np.float32],
    textures: NDArray[np.float32],
    weights: NDArray[np.float32],
    cameras: Sequence[int],
    counts: range,
    progress: Progress | None,
) -> list[float]:
    """Mean SSIM over `cameras` for each number of textures in `counts`."""

    def pictures(camera: int) -> Iterator[NDArray[np.float32]]:
        total, done = mean.values.copy(), 0
        for count in counts:
            for index in range(done, count):
                total += weights[camera, index] * textures[index]
            done = count
            yield maps.atlas.image(total)

    def score(camera: int) -> list[float | None]:
        values, seen = np.array(maps.values[camera]), np.array(maps.seen[camera])
        return [pair[0] for pair in measure_map(pictures(camera), average, maps.atlas, values, seen)[1]]

    rows = list(track(parallel_stream(score, cameras), "UV measure", len(cameras), progress))
    seen = np.array([row for row in rows if None not in row], float)
    return [0.0] * len(counts) if len(seen) == 0 else seen.mean(axis=0).tolist()
