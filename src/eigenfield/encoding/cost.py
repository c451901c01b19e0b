"""What an encode is expected to take, before it begins: steps, time, memory and scratch files.

The costs were measured on the shared captures (docs/usage.md); they are to be right within a factor of two.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from eigenfield.capture import Capture
from eigenfield.encoding.options import EncodeOptions
from eigenfield.reconstruction.array import looks_one_way
from eigenfield.reconstruction.layered import capture_fault
from eigenfield.reconstruction.layers import LAYERS_TUNING


class StepCost(NamedTuple):
    """A step's words, and the seconds that one thread needs for it: some, and some for each megapixel."""

    words: str
    fixed: float
    a_megapixel: float


STEPS = {  # by the name with which a step begins
    "motion": StepCost("cameras", 5.0, 1.5),
    "array": StepCost("depth", 10.0, 2.0),
    "relief": StepCost("surface", 2.0, 0.2),
    "surface": StepCost("surface", 30.0, 8.0),
    "proxy": StepCost("atlas", 5.0, 0.0),
    "trial": StepCost("trial of layers", 60.0, 2.0),
    "layers": StepCost("layers", 120.0, 10.0),
    "mesh": StepCost("mesh", 5.0, 0.8),
    "maps": StepCost("texture maps", 5.0, 1.0),
    "fit": StepCost("fit", 10.0, 2.5),
    "code": StepCost("coding", 5.0, 0.3),
}
THREADS_POWER = 0.8  # of the number of threads, by which time falls
MEMORY_FIXED_BYTES, MEMORY_BYTES_A_PIXEL = 6e8, 16.0
SCRATCH_BYTES_A_PIXEL = 17.0


@dataclass(frozen=True)
class Cost:
    """What a run is expected to take.

    Attributes:
        steps: Seconds of each step, by its name, in order. Some may turn out to be needless.
        memory: Bytes.
        scratch: Bytes of files that are removed again.
    """

    steps: dict[str, float]
    memory: float
    scratch: float

    @property
    def seconds(self) -> float:
        """Of all steps."""
        return sum(self.steps.values())


def expected_cost(capture: Capture, options: EncodeOptions, settings: Mapping[str, Any] | None, threads: int) -> Cost:
    """The cost of a scene.

    Args:
        capture: Photographs, with or without cameras.
        options: Of the scene.
        settings: The arguments of `reconstruct`; None: the proxy is given.
        threads: Number of threads.
    """
    pixels = float(sum(width * height for width, height in capture.sizes))
    names = [*([] if settings is None else _estimation(capture, settings)), *_textures(options)]
    share = threads**-THREADS_POWER
    steps = {name: share * (STEPS[name].fixed + STEPS[name].a_megapixel * pixels / 1e6) for name in names}
    return Cost(steps, MEMORY_FIXED_BYTES + MEMORY_BYTES_A_PIXEL * pixels, SCRATCH_BYTES_A_PIXEL * pixels)


def _estimation(capture: Any, settings: Mapping[str, Any]) -> list[str]:
    """The names of the steps that make cameras and proxy."""
    light_field = capture.light_field
    unknown = light_field is None
    found = ["motion"] if unknown and capture.layout is None else []
    one_way = unknown or looks_one_way(light_field.cameras)
    if settings["surface"] != "layers":
        found += ["array", "relief"] if one_way and settings["surface"] != "poisson" else ["surface", "proxy"]
    elif one_way:
        found += ["array"]
    may_have_layers = settings["layers"] != 1 and capture_fault(capture) is None
    if settings["surface"] in ("auto", "layers") and may_have_layers:
        found += ["trial"] if settings["layers"] is None else []
        few = len(capture.sizes) < LAYERS_TUNING.dense_views
        found += ["layers"] if few or settings["surface"] == "layers" else []
    return found


def _textures(options: EncodeOptions) -> list[str]:
    """The names of the steps from a proxy to a scene."""
    return ["mesh", "maps" if options.resolved().fit == "none" else "fit", "code"]
