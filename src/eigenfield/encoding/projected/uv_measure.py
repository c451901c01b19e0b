"""The paper's measure: an observation's texture map against the one put together again, in UV space."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.progress import Progress
from eigenfield.core.spread import spread_indices
from eigenfield.encoding.atlas import Atlas
from eigenfield.encoding.projected.eigen import eigen_textures, weights_of
from eigenfield.encoding.projected.mean import Mean
from eigenfield.encoding.projected.project import TextureMaps
from eigenfield.imaging.metrics import psnr, ssim, to_codes
from eigenfield.runtime.files import scratch_array
from eigenfield.runtime.parallel import tracked_map

log = logging.getLogger("eigenfield.basis")

UV_SAMPLE_OBSERVATIONS = 24  # observations that narrow the number down before all of them decide


def measure_map(
    pictures: Iterable[NDArray[np.float32]],
    mean: NDArray[np.float32],
    atlas: Atlas,
    values: NDArray[np.float32],
    seen: NDArray[np.uint8],
) -> tuple[NDArray[np.uint8], list[tuple[float | None, float | None]]]:
    """SSIM and PSNR (dB) of each of `pictures` against a map, over the texels that are seen in it.

    Args:
        pictures: (H, W, C), put together with more and more textures.
        mean: (H, W, C), which fills what is not seen (equation 2), in both pictures.
        values: (n, C) of the map.
        seen: (n,) where the map has values.

    Returns:
        The filled map, (H, W, C) uint8, and a pair for each picture, of None where no texel is seen.
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
    vectors: NDArray[np.float64],
    target: float,
    *,
    work: Path | None = None,
    progress: Progress | None = None,
) -> int:
    """The smallest number of eigen textures whose mean UV SSIM over the observations reaches a target; all of them,
    with a warning, if none does. The textures are those before coding. A sample of the observations finds about where,
    all decide.

    Args:
        maps: Of No observations.
        average: (H, W, C), the mean without holes, as the file will keep it.
        vectors: (No, No - 1) of `eigenvectors`.
    """
    most, everyone = maps.count - 1, list(range(maps.count))
    sample = spread_indices(maps.count, UV_SAMPLE_OBSERVATIONS)
    limit = min(8, most)
    while True:
        weights = weights_of(vectors, limit)
        with scratch_array((limit, maps.atlas.count, maps.channels), np.float32, work) as textures:
            textures[:] = eigen_textures(maps, mean, weights, progress)
            curve = partial(_curve, maps, mean, average, textures, weights, progress)
            near = _first(curve(sample, range(limit + 1)), target)
            if near is not None or limit == most:
                count = _decide(partial(curve, everyone), limit if near is None else near, limit, target)
                if count is not None:
                    return count
                if limit == most:
                    log.warning("a UV SSIM of %g is not reached: all %d eigen textures are kept", target, most)
                    return most
        limit = min(2 * limit, most)


def _decide(curve: Callable[[range], list[float]], guess: int, limit: int, target: float) -> int | None:
    """From a guess outwards, a few counts at a time, until all observations say which count, up to a limit, is the
    first to reach the target."""
    low, high = max(guess - 1, 0), min(guess + 1, limit)
    while True:
        first = _first(curve(range(low, high + 1)), target)
        if first is None:
            if high == limit:
                return None
            low, high = high + 1, min(high + 3, limit)
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
    progress: Progress | None,
    chosen: Sequence[int],
    counts: range,
) -> list[float]:
    """Mean SSIM over the chosen observations for each number of textures in `counts`."""

    def pictures(row: int) -> Iterator[NDArray[np.float32]]:
        total, done = mean.values.copy(), 0
        for count in counts:
            for index in range(done, count):
                total += weights[row, index] * textures[index]
            done = count
            yield maps.atlas.image(total)

    def score(row: int) -> list[float | None]:
        values, seen = np.array(maps.values[row]), np.array(maps.seen[row])
        return [pair[0] for pair in measure_map(pictures(row), average, maps.atlas, values, seen)[1]]

    rows = tracked_map(score, chosen, "UV measure", progress)
    seen = np.array([row for row in rows if None not in row], float)
    return [0.0] * len(counts) if len(seen) == 0 else seen.mean(axis=0).tolist()
