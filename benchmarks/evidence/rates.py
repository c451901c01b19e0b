"""Points of a rate-distortion curve, and what lies between two curves: Bjøntegaard's deltas.

A point is a dict with "bytes" and the figures of `point`; a curve is a sequence of points in any order.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from eigenfield.evaluation.image import ImageScores, measure_picture, summarise_scores
from eigenfield.runtime.parallel import parallel_stream

Point = Mapping[str, Any]

OVERLAP = {"psnr": 0.5, "ssim": 0.005}  # quality that two curves must share, dB or SSIM: less says nothing
OVERLAP_BYTES = 1.2  # the same for bytes, as a ratio


def point(
    decoded: Iterable[NDArray[np.uint8]],
    photographs: Sequence[NDArray[np.uint8]],
    covered: Sequence[NDArray[np.bool_]],
    names: Sequence[str],
) -> dict[str, Any]:
    """Means over views of psnr, psnr_luma and ssim over covered pixels, of the same with "_full" over the whole frame,
    of coverage, and under "worst" each one's lowest value with the view's name (docs/measures.md defines them).

    decoded, photographs: (H, W, 3) uint8; covered: (H, W) bool. `decoded` may be a generator: at most a few of its
    pictures are held at a time.
    """

    def of_view(task: tuple[NDArray[np.uint8], NDArray[np.uint8], NDArray[np.bool_]]) -> ImageScores:
        picture, photograph, counted = task
        return measure_picture(picture, counted, photograph)

    views = list(parallel_stream(of_view, zip(decoded, photographs, covered, strict=True)))
    return dict(summarise_scores(views, names))


def bd_rate(anchor: Sequence[Point], test: Sequence[Point], key: str = "psnr") -> float | None:
    """Bjøntegaard's delta rate: by how many percent `test` needs more bytes than `anchor` at equal quality.

    The mean over the quality both reach of the difference in log bytes, each curve a monotone piecewise cubic through
    its points (ITU-T HSTP-VID-WPOM, 2020). None where they share less than OVERLAP, or a curve has a single point.
    """
    shared = common_range(anchor, test, key)
    if shared is None:
        return None
    difference = _mean(_by_quality(test, key), *shared) - _mean(_by_quality(anchor, key), *shared)
    return float(100 * np.expm1(difference))


def bd_quality(anchor: Sequence[Point], test: Sequence[Point], key: str = "psnr") -> float | None:
    """By how much `test` is better than `anchor` at equal bytes, in the unit of `key`, the mean over log bytes.

    None where the curves share less than a factor of OVERLAP_BYTES, or one has a single point.
    """
    curves = [_by_bytes(anchor, key), _by_bytes(test, key)]
    shared = _shared(curves, np.log(OVERLAP_BYTES))
    if shared is None:
        return None
    return _mean(curves[1], *shared) - _mean(curves[0], *shared)


def common_range(anchor: Sequence[Point], test: Sequence[Point], key: str = "psnr") -> tuple[float, float] | None:
    """The lowest and highest quality that both curves reach: what `bd_rate` speaks of. None where it is too narrow."""
    least = next(value for start, value in OVERLAP.items() if key.startswith(start))
    return _shared([_by_quality(anchor, key), _by_quality(test, key)], least)


def bytes_at(points: Sequence[Point], quality: float, key: str = "psnr") -> float | None:
    """The bytes at which a curve reaches a quality; None beyond its ends."""
    x, y = _by_quality(points, key)
    if len(x) == 0 or not x[0] <= quality <= x[-1]:
        return None
    return float(np.exp(y[0] if len(x) == 1 else PchipInterpolator(x, y)(quality)))


def value_at(points: Sequence[Point], size: float, value: Callable[[Point], float | None]) -> float | None:
    """A figure of a curve at some bytes, on the line over log bytes between its points; None beyond its ends.

    Args:
        points: In any order.
        size: Bytes.
        value: The figure of a point; one that has none is left out.
    """
    known = sorted((float(point["bytes"]), found) for point in points if (found := value(point)) is not None)
    if not known or not known[0][0] <= size <= known[-1][0]:
        return None
    sizes, values = zip(*known, strict=True)
    return float(np.interp(np.log(size), np.log(sizes), values))


def held_out_luma(point: Point) -> float | None:
    """dB of views between cameras; None where there are none."""
    held_out = point.get("held_out")
    return None if held_out is None else held_out["psnr_luma"]


def flicker(point: Point) -> float | None:
    """Grey levels in still pixels."""
    found = point.get("flicker")
    return None if found is None else found["still"]


Curve = tuple[NDArray[np.float64], NDArray[np.float64]]


def _by_quality(points: Sequence[Point], key: str) -> Curve:
    """Quality, rising, and log bytes; a point that costs more bytes than a better one is left out."""
    rising: list[tuple[float, float]] = []
    for value, size in sorted(_pairs(points, key)):
        if rising and rising[-1][0] == value:
            continue  # the cheaper of equals came first
        while rising and rising[-1][1] >= size:
            rising.pop()
        rising.append((value, size))
    return _curve(rising)


def _by_bytes(points: Sequence[Point], key: str) -> Curve:
    """Log bytes, rising, and quality, of the same points as `_by_quality`."""
    quality, size = _by_quality(points, key)
    return size, quality


def _pairs(points: Sequence[Point], key: str) -> list[tuple[float, float]]:
    return [(float(p[key]), float(np.log(p["bytes"]))) for p in points if p[key] is not None]


def _curve(pairs: Sequence[tuple[float, float]]) -> Curve:
    table = np.array(pairs, np.float64).reshape(-1, 2)
    return table[:, 0], table[:, 1]


def _shared(curves: Sequence[Curve], least: float) -> tuple[float, float] | None:
    if min(len(x) for x, _ in curves) < 2:
        return None
    low, high = max(float(x[0]) for x, _ in curves), min(float(x[-1]) for x, _ in curves)
    return (low, high) if high - low >= least else None


def _mean(curve: Curve, low: float, high: float) -> float:
    return float(PchipInterpolator(*curve).integrate(low, high)) / (high - low)
