"""What a file is to reach, and the search for the quality at which it does, by coding it a few times."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from eigenfield.core.errors import OptionError
from eigenfield.encoding.fields import documented, option

T = TypeVar("T")

log = logging.getLogger("eigenfield.fit")

TRIES = 7  # codings at most
LOWEST, HIGHEST = 20, 99  # qualities that are tried: below the first one the pictures are no pictures
FIRST = 80
NEAR = 0.985  # of a size that is asked for: near enough


@documented
@dataclass(frozen=True)
class Target:
    """What a file is to reach: one of a size, a PSNR and an SSIM.

    PSNR (dB, RGB) and SSIM are means over captured cameras (docs/measures.md).
    """

    size: int | None = option(
        "The best file of at most this size (500kB, 1.5MB, 300000), by the fit's quality.", metavar="SIZE"
    )
    psnr: float | None = option("The smallest file with this PSNR, RGB, of captured views.", metavar="DB")
    ssim: float | None = option("The smallest file with this SSIM of captured views.", metavar="S")

    def check(self) -> None:
        """Raise OptionError `target` for none, several, or one that cannot be."""
        given = [(name, value) for name, value in vars(self).items() if value is not None]
        if len(given) != 1:
            names = ", ".join(f"--target-{name}" for name, _ in given) or "no target"
            raise OptionError("target", f"{names} at a time", remedy="say one: size, psnr or ssim")
        name, value = given[0]
        low, high = {"size": (1000, math.inf), "psnr": (1, 99), "ssim": (0, 1)}[name]
        if not low < value < high:
            raise OptionError("target", f"{name} of {value:g}", remedy=f"say one between {low:g} and {high:g}")

    def met(self, tried: Tried[T]) -> bool:
        """Whether a file reaches it."""
        if self.size is not None:
            return tried.size <= self.size
        return tried.measured >= self.wanted

    def merit(self, tried: Tried[T]) -> tuple[bool, float]:
        """What files of different fits are compared by: the greater is the better.

        A file that meets the target comes before one that does not. Of those that meet it, the better picture counts
        for a size and the fewer bytes for a PSNR or SSIM; of those that do not, the nearer.
        """
        met = self.met(tried)
        return met, tried.measured if met == (self.size is not None) else -float(tried.size)

    @property
    def wanted(self) -> float:
        """The PSNR or SSIM asked for."""
        return float(self.ssim if self.psnr is None else self.psnr)  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False)
class Tried(Generic[T]):
    """A file at a quality.

    Attributes:
        quality: 0 to 100.
        size: Its bytes.
        measured: The PSNR or SSIM that it reaches; with a size as the target 0, or the PSNR where it was measured too.
        result: What was coded.
    """

    quality: int
    size: int
    measured: float
    result: T


def search(target: Target, code: Callable[[int], Tried[T]], first: int = FIRST) -> Tried[T]:
    """The largest file within a size, or the smallest that reaches a PSNR or SSIM; where there is none the nearest.

    Takes at most TRIES codings. Size and measures are taken to rise with the quality.

    Args:
        target: What is to be reached.
        code: Codes at a quality.
        first: The quality that is tried first.
    """
    tried: dict[int, Tried[T]] = {}
    low, high = LOWEST - 1, HIGHEST + 1  # the answer lies between, both excluded: low is too little or unknown
    quality = first
    while len(tried) < TRIES and low + 1 < high:
        one = tried[quality] = code(quality)
        log.info("quality %d: %d bytes, %.4f", quality, one.size, one.measured)
        met = target.met(one)
        if target.size is not None and met and one.size >= NEAR * target.size:
            break
        if met == (target.size is not None):
            low = quality
        else:
            high = quality
        quality = _next(target, list(tried.values()), low, high)
    good = [one for one in tried.values() if target.met(one)]
    if good:
        return (max if target.size is not None else min)(good, key=lambda one: one.size)
    return (min if target.size is not None else max)(tried.values(), key=lambda one: one.quality)


def _next(target: Target, tried: list[Tried[T]], low: int, high: int) -> int:
    """Where a line through the two tries nearest the target meets it, within low..high; the middle with one try."""
    goal = math.log(target.size) if target.size is not None else target.wanted

    def value(one: Tried[T]) -> float:
        return math.log(one.size) if target.size is not None else one.measured

    inside = sorted(tried, key=lambda one: abs(value(one) - goal))[:2]
    if len(inside) == 2 and inside[0].quality != inside[1].quality and value(inside[0]) != value(inside[1]):
        a, b = inside
        slope = (value(b) - value(a)) / (b.quality - a.quality)
        guess = a.quality + (goal - value(a)) / slope if slope > 0 else (low + high) / 2
    else:
        guess = (low + high) / 2
    rounded = math.floor(guess) if target.size is not None else math.ceil(guess)
    return min(max(rounded, low + 1), high - 1)
