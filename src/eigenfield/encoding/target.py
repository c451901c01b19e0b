"""Targets of size and quality, and the search for the quality that reaches one by coding a few times."""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
from typing import Generic, TypeVar

from eigenfield.core.errors import OptionError
from eigenfield.core.fields import Options, document_options, option

T = TypeVar("T")

log = logging.getLogger("eigenfield.fit")

TARGET_MAX_ATTEMPTS = 7
TARGET_MIN_QUALITY, TARGET_MAX_QUALITY = 20, 99  # below, pictures are not recognisable
TARGET_FIRST_QUALITY = 80
TARGET_RANGES = {  # both excluded
    "size": (1000, math.inf, " bytes"),
    "psnr": (1, 99, " dB"),
    "ssim": (0, 1, ""),
    "bitrate": (1000, math.inf, " bit/s"),
}
TARGET_NEAR_SIZE_RATIO = 0.985  # of a target size: such files are near enough


def parse_bitrate(text: str) -> int:
    """Bits a second from a text: "4Mbps", "800kbps" or "4000000". Raises OptionError `target`."""
    found = re.fullmatch(r"(\d{1,18}(?:\.\d+)?) *(k|m|)(?:bps|bit/s)?", text.strip().lower())
    if found is None:
        raise OptionError("target", f"{text!r} is no bitrate", remedy="say Mbps, kbps or bits a second: 4Mbps, 800kbps")
    return round(float(found[1]) * {"": 1, "k": 1e3, "m": 1e6}[found[2]])


def parse_size(text: str) -> int:
    """Bytes from a text: "300kB", "1.5MB" or "300000". Raises OptionError `target`."""
    found = re.fullmatch(r"(\d{1,18}(?:\.\d+)?) *(k|m|g|)b?", text.strip().lower())
    if found is None:
        raise OptionError("target", f"{text!r} is no size", remedy="say bytes, kB or MB: 500kB, 1.5MB, 300000")
    return round(float(found[1]) * {"": 1, "k": 1e3, "m": 1e6, "g": 1e9}[found[2]])


@document_options
@dataclass(frozen=True)
class Target(Options):
    """The target of a file: one of a size, a PSNR, an SSIM, and of a clip a bitrate.

    PSNR (dB, RGB) and SSIM are means over captured cameras (docs/measures.md).
    """

    size: int | None = option("The best file of at most this size: 500kB, 1.5MB, 300000.", metavar="SIZE")
    psnr: float | None = option("The smallest file whose captured views reach this PSNR, RGB.", metavar="DB")
    ssim: float | None = option("The smallest file whose captured views reach this SSIM.", metavar="S")
    bitrate: int | None = option("The best clip of at most so many bits a second: 4Mbps, 800kbps.", metavar="RATE")

    def check(self) -> None:
        """Raise OptionError `target` for none, several, or one out of range."""
        given = [(name, value) for name, value in vars(self).items() if value is not None]
        if len(given) != 1:
            names = ", ".join(f"--target-{name}" for name, _ in given) or "no target"
            raise OptionError("target", f"{names} at a time", remedy="say one: size, psnr, ssim or bitrate")
        name, value = given[0]
        low, high, unit = TARGET_RANGES[name]
        if isinstance(value, bool) or not isinstance(value, Real) or not low < float(value) < high:
            between = f"between {low:g} and {high:g}" if high < math.inf else f"above {low:g}"
            shown = f"{value:g}{unit}" if isinstance(value, Real) else value
            message = f"a target {name} of {shown} is out of range"
            raise OptionError("target", message, remedy=f"say one {between}{unit}")

    def is_met(self, tried: Attempt[T]) -> bool:
        """Whether a file reaches it."""
        if self.size is not None:
            return tried.size <= self.size
        return tried.measured >= self.goal

    def merit(self, tried: Attempt[T]) -> tuple[bool, float]:
        """A key by which files of different fits are compared: the greater is the better.

        A file that meets the target comes before one that does not. Of those that meet it, the better picture counts
        for a size and the fewer bytes for a PSNR or SSIM; of those that do not, the nearer.
        """
        met = self.is_met(tried)
        return met, tried.measured if met == (self.size is not None) else -float(tried.size)

    @property
    def goal(self) -> float:
        """The PSNR or SSIM asked for."""
        return float(self.ssim if self.psnr is None else self.psnr)  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False)
class Attempt(Generic[T]):
    """A file at a quality.

    Attributes:
        quality: 0 to 100.
        size: In bytes.
        measured: Its PSNR or SSIM; with a size as the target 0, or the PSNR where it was measured too.
        result: The coded scene.
    """

    quality: int
    size: int
    measured: float
    result: T


def search_quality(target: Target, code: Callable[[int], Attempt[T]], first: int = TARGET_FIRST_QUALITY) -> Attempt[T]:
    """The largest file within a size, or the smallest that reaches a PSNR or SSIM; where there is none the nearest.

    There are at most TARGET_MAX_ATTEMPTS codings. Size and measures are assumed to rise with the quality.
    """
    tried: dict[int, Attempt[T]] = {}
    # The answer lies between, both excluded: low is too little or unknown
    low, high = TARGET_MIN_QUALITY - 1, TARGET_MAX_QUALITY + 1
    quality = first
    while len(tried) < TARGET_MAX_ATTEMPTS and low + 1 < high:
        one = tried[quality] = code(quality)
        log.info("quality %d: %d bytes, %.4f", quality, one.size, one.measured)
        met = target.is_met(one)
        if target.size is not None and met and one.size >= TARGET_NEAR_SIZE_RATIO * target.size:
            break
        if met == (target.size is not None):
            low = quality
        else:
            high = quality
        quality = _next(target, list(tried.values()), low, high)
    good = [one for one in tried.values() if target.is_met(one)]
    if good:
        return (max if target.size is not None else min)(good, key=lambda one: one.size)
    return (min if target.size is not None else max)(tried.values(), key=lambda one: one.quality)


def _next(target: Target, tried: list[Attempt[T]], low: int, high: int) -> int:
    """Where a line through the two tries nearest the target meets it, within low..high; the middle with one try."""
    goal = math.log(target.size) if target.size is not None else target.goal

    def value(one: Attempt[T]) -> float:
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
