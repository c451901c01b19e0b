"""A codec at the bytes of our file: the encoded views as a film that is no larger than what is left beside the mesh."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eigenfield.core.camera import Camera
from eigenfield.imaging.metrics import psnr_luma
from evidence import codecs
from evidence.codecs import VideoCodec
from evidence.colour import Picture

OVER = 1.02  # times our bytes: so much larger a peer may be, since its rate has steps
FINEST, COARSEST = 1, 63  # rate of the codecs
UNEVEN = 2  # steps beyond the one found that are tried too: an encoder's bytes do not fall with every one


@dataclass(frozen=True, eq=False)
class Film:
    """A film of some views.

    Attributes:
        rate: Of the codec.
        bytes: Of the film.
        order: Name of the order in which it holds the views.
        pictures: What is decoded, as the views were given.
    """

    rate: float
    bytes: int
    order: str
    pictures: Sequence[Picture]


def largest_within(size_of: Callable[[int], int], steps: int, most: float) -> int:
    """The step of 0 to steps - 1 with the largest size of at most `most`, where sizes fall with the steps.

    Args:
        size_of: The size at a step. It may fall unevenly: UNEVEN steps before the one that bisection finds count too.
        steps: Their number.
        most: The largest size that counts.

    Raises:
        ValueError: Even the last step is larger.
    """
    sizes: dict[int, int] = {}

    def fits(step: int) -> bool:
        sizes[step] = size_of(step)
        return sizes[step] <= most

    low, high = 0, steps - 1
    while low < high:
        middle = (low + high) // 2
        if fits(middle):
            high = middle
        else:
            low = middle + 1
    for step in range(max(low - UNEVEN, 0), low + 1):
        if step not in sizes:
            fits(step)
    within = [step for step, size in sizes.items() if size <= most]
    if not within:
        raise ValueError(f"the smallest has {sizes[low] / 1000:.1f} kB, more than {most / 1000:.1f} kB")
    return max(within, key=lambda step: sizes[step])


def film_within(
    codec: VideoCodec, cameras: Sequence[Camera], views: Sequence[Picture], most: float, folder: Path
) -> Film:
    """The largest film of at most `most` bytes, in the order of views that suits the codec at that rate.

    Args:
        codec: The codec.
        cameras: Of the views.
        views: (H, W, 3) uint8, one of each camera.
        most: Bytes.
        folder: For films, which are left there.

    Raises:
        ValueError: Even the smallest film is larger.
    """
    orders = codecs.orders_of(codec, cameras)
    sizes = [(view.shape[0], view.shape[1]) for view in views]

    def place(rate: float, name: str) -> Path:
        return folder / f"{codec.name}-{name}-{rate:g}.{codec.container}"

    def size_of(rate: float, name: str) -> int:
        film = place(rate, name)
        if not film.exists():
            codecs.encode([views[view] for view in orders[name]], codec, rate, film)
        return film.stat().st_size

    def found(name: str) -> float:
        count = (COARSEST - FINEST) * codec.steps + 1
        return FINEST + largest_within(lambda at: size_of(FINEST + at / codec.steps, name), count, most) / codec.steps

    def decoded(rate: float, name: str) -> list[Picture]:
        film = codecs.decode(place(rate, name), codec, [sizes[view] for view in orders[name]])
        return [picture for _, picture in sorted(zip(orders[name], film, strict=True), key=lambda pair: pair[0])]

    def point(rate: float, name: str) -> dict[str, float]:
        size = size_of(rate, name)
        luma = [psnr_luma(a, b) for a, b in zip(decoded(rate, name), views, strict=True)]
        return {"bytes": size, "psnr_luma": float(np.mean([value for value in luma if value is not None]))}

    usual = codecs.usual(orders)
    rate = found(usual)
    best = codecs.best_order({name: point(rate, name) for name in orders})
    rate = rate if best == usual else found(best)
    return Film(rate, size_of(rate, best), best, decoded(rate, best))
