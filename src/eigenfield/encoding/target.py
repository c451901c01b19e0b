"""The quality at which a file reaches what it is to reach, found by coding it a few times."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import numpy as np

from eigenfield.core.errors import OptionError
from eigenfield.core.scene import Scene
from eigenfield.encoding.fitted.observations import Shots
from eigenfield.gltf import encode_scene
from eigenfield.imaging.metrics import psnr, ssim, to_codes
from eigenfield.rendering import Renderer
from eigenfield.runtime.parallel import parallel_stream

T = TypeVar("T")

log = logging.getLogger("eigenfield.fit")

TRIES = 7  # codings at most
LOWEST, HIGHEST = 20, 99  # qualities that are tried: below the first one the pictures are no pictures
FIRST = 80
NEAR = 0.985  # of a size that is asked for: near enough
MEASURED = 48  # cameras, evenly spread, by which a PSNR or SSIM is judged


@dataclass(frozen=True)
class Target:
    """What a file is to reach: at most `size` bytes, or at least this PSNR (dB, RGB) or SSIM, the means over captured
    cameras (docs/measures.md); one of them."""

    size: int | None = None
    psnr: float | None = None
    ssim: float | None = None

    def check(self) -> None:
        """Raises OptionError `target` for none, several, or one that cannot be."""
        given = [(name, value) for name, value in vars(self).items() if value is not None]
        if len(given) != 1:
            names = ", ".join(f"--target-{name}" for name, _ in given) or "no target"
            raise OptionError("target", f"{names} at a time", remedy="say one: size, psnr or ssim")
        name, value = given[0]
        low, high = {"size": (1000, math.inf), "psnr": (1, 99), "ssim": (0, 1)}[name]
        if not low < value < high:
            raise OptionError("target", f"{name} of {value:g}", remedy=f"say one between {low:g} and {high:g}")

    def met(self, tried: Tried[T]) -> bool:
        """Whether a file is within it."""
        if self.size is not None:
            return tried.size <= self.size
        return tried.measured >= self.wanted

    def worth(self, tried: Tried[T]) -> tuple[bool, float]:
        """By which files of different fits compare, the greater the better: one that meets it before one that does
        not, then the better picture in as many bytes or the fewer bytes for as good a picture; of those that do not,
        the nearer."""
        met = self.met(tried)
        return met, tried.measured if met == (self.size is not None) else -float(tried.size)

    @property
    def wanted(self) -> float:
        """The PSNR or SSIM asked for."""
        return float(self.ssim if self.psnr is None else self.psnr)  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False)
class Tried(Generic[T]):
    """A file at a quality: its bytes, and what it reaches of what was asked for (of a size: 0, or the PSNR once
    `compared`)."""

    quality: int
    size: int
    measured: float
    result: T


def search(target: Target, code: Callable[[int], Tried[T]], first: int = FIRST) -> tuple[Tried[T], bool]:
    """The largest file within a size, or the smallest that reaches a PSNR or SSIM, and whether there is one; else the
    nearest to it. At most TRIES codings, from quality `first`; size and measures are taken to rise with quality."""
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
        return (max if target.size is not None else min)(good, key=lambda one: one.size), True
    return (min if target.size is not None else max)(tried.values(), key=lambda one: one.quality), False


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


def reach(target: Target, coded: Callable[[int], Scene], shots: Shots, first: int = FIRST) -> tuple[Tried[Scene], bool]:
    """As `search`: the scene whose file reaches the target, by `coded`, which makes one at a quality."""

    def code(quality: int) -> Tried[Scene]:
        scene = coded(quality)
        return Tried(quality, len(encode_scene(scene)), 0.0 if target.size else _measured(target, scene, shots), scene)

    return search(target, code, first)


def compared(target: Target, found: Tried[Scene], shots: Shots) -> Tried[Scene]:
    """What was found, measured too where the target is a size: for `Target.worth`."""
    return found if target.size is None else replace(found, measured=_measured(target, found.result, shots))


def warn_of_miss(target: Target, nearest: Tried[Scene]) -> None:
    """Say that no file reaches the target, and why."""
    if target.size is not None:
        log.warning(
            "%d bytes cannot be reached: the coarsest file has %d; take fewer textures, or a lower density",
            target.size, nearest.size,
        )  # fmt: skip
    else:
        log.warning(
            "%g cannot be reached: the finest file has %.4g; take more textures, or a higher density", target.wanted,
            nearest.measured,
        )  # fmt: skip


def _measured(target: Target, scene: Scene, shots: Shots) -> float:
    """The mean PSNR or SSIM over covered pixels of some captured cameras, drawn as they are."""
    renderer, count = Renderer(scene), len(shots)
    encoded = scene.encoded

    def of_camera(index: int) -> float | None:
        picture = renderer.draw(scene.cameras[encoded[index]], np.eye(count)[index])
        covered, weight = picture.covered, shots.weight(index)
        if weight.size:
            covered &= weight > 0
        measure = psnr if target.ssim is None else ssim
        return measure(to_codes(picture.image), shots.photograph(index), covered)

    some = np.unique(np.linspace(0, count - 1, min(count, MEASURED)).round().astype(int))
    values = [value for value in parallel_stream(of_camera, some.tolist()) if value is not None]
    return float(np.mean(values)) if values else 0.0
