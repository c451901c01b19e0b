"""What an encode is expected to take, before it begins: steps, time, memory and scratch files.

The costs were measured on real captures (docs/time.md). What a machine takes corrects them (`cli.time_left`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, NamedTuple

from eigenfield.capture import Capture
from eigenfield.encoding.options import SUBSAMPLE_MIN_OBSERVATIONS, EncodeOptions
from eigenfield.encoding.views import encoded_ratio
from eigenfield.reconstruction import SurfaceOptions
from eigenfield.reconstruction.array import looks_one_way
from eigenfield.reconstruction.frame import common_frame
from eigenfield.reconstruction.layered import capture_fault
from eigenfield.reconstruction.layers import LAYERS_DENSE_VIEWS
from eigenfield.stereo.estimate import DEPTH_MAX_BYTES, DEPTH_SWEEP_BYTES, DEPTH_SWEEP_MAX_LABELS


class StepCost(NamedTuple):
    """A step's words, and the seconds that one thread needs for it: some, some for each megapixel of all photographs,
    some for each megapixel of one, and some for the square root of all megapixels. Then what part its stages take, in
    their order, in any unit."""

    words: str
    fixed: float
    of_all: float = 0.0
    of_one: float = 0.0
    of_root: float = 0.0
    stages: Mapping[str, float] = MappingProxyType({})


STEPS = {  # by the name with which a step begins
    "motion": StepCost("cameras", 8, 3.6, stages={"features": 35, "matches": 25, "cameras": 40}),
    "array": StepCost("depth", 15, 0.2, 60, stages={"cameras and depth": 1}),
    "relief": StepCost("surface", 8, of_one=10, stages={"second layer": 70, "what lies open": 30}),
    "surface": StepCost(
        "surface",
        40,
        5,
        stages={"features": 8, "first depth": 20, "depth": 25, "fusion": 6, "visibility": 26, "surface": 15},
    ),
    "proxy": StepCost("atlas", 12),
    "trial": StepCost("trial of layers", 35, stages={"planes": 25, "sheets": 75}),
    "layers": StepCost("layers", 10, 22, stages={"planes": 50, "sheets": 45, "what is seen": 5}),
    "mesh": StepCost("mesh", 5, 0.6),
    "maps": StepCost("texture maps", 5, 0.7, stages={"texture maps": 1}),
    "fit": StepCost("fit", 5, 1.5, stages={"fit luma": 1, "fit chroma": 1}),
    "code": StepCost(
        "coding", 6, 0.6, stages={"code luma": 60, "code chroma": 20, "photographs": 12, "code textures": 8}
    ),
}
FEW_VIEWS = {  # of below SUBSAMPLE_MIN_OBSERVATIONS: more rounds, and all pixels
    "mesh": StepCost("mesh", 10, of_root=6),
    "fit": StepCost("fit", 5, of_root=26),
    "code": StepCost("coding", 4, of_root=18),
}
AROUND = {"code": StepCost("coding", 6, 1.8)}  # of more views that look around: their textures are rotated
TEXTURE_MAPS = {"mesh": StepCost("mesh", 5)}  # without a fit: its surface and triangles stay as they are
DENSE_TRIAL = StepCost("trial of layers", 20)  # which ends with the fewest layers, as a rule
LAYERED = {"layers": STEPS["layers"], "mesh": StepCost("mesh", 10, 28), "fit": StepCost("fit", 5, 30)}
DENSE_LAYERS_RATIO = 1 / 3  # of the time of layers: dense arrays have fewer
THREADS_POWER = 0.8  # of the number of threads, by which time falls
MEMORY_FIXED_BYTES, MEMORY_BYTES_A_PIXEL = 9e8, 50.0
# While the depth of an array is estimated, beside the volume of a sweep, whose view has so many times the pixels of one
DEPTH_FIXED_BYTES, DEPTH_BYTES_A_PIXEL, DEPTH_VIEW_RATIO = 4e8, 30.0, 2.0
SCRATCH_BYTES_A_PIXEL = 17.0


@dataclass(frozen=True)
class Cost:
    """What a run is expected to take.

    Attributes:
        steps: Seconds of each step, by its name, in order. Some may turn out to be needless; those of layers are 0.
        layered: Seconds of the steps that take others if there are layers; empty where there can be none.
        memory: Bytes.
        scratch: Bytes of files that are removed again.
    """

    steps: dict[str, float]
    layered: dict[str, float]
    memory: float
    scratch: float

    @property
    def seconds(self) -> float:
        """Of all steps, without layers."""
        return sum(self.steps.values())

    @property
    def layered_seconds(self) -> float:
        """Of all steps, with layers."""
        return sum((self.steps | self.layered).values())


def expected_cost(capture: Capture, options: EncodeOptions, surface: SurfaceOptions | None, threads: int) -> Cost:
    """The cost of a scene.

    Args:
        capture: Photographs, with or without cameras.
        surface: That is made; None: the proxy is given.
    """
    sizes, share = capture.sizes, threads**-THREADS_POWER
    pixels = float(sum(width * height for width, height in sizes))

    textures = _textures(options)
    estimation = [] if surface is None else _estimation(capture, surface, atlas="maps" in textures)
    encoded = encoded_ratio(capture, options)
    few = encoded * len(sizes) < SUBSAMPLE_MIN_OBSERVATIONS
    around = AROUND if _looks_around(capture) else {}
    costs = STEPS | (TEXTURE_MAPS if "maps" in textures else FEW_VIEWS if few else around)

    def seconds(name: str, step: StepCost) -> float:
        seen = 1e-6 * pixels * (encoded if name in textures else 1)
        of_one = step.of_one * 1e-6 * pixels / len(sizes)
        return share * (step.fixed + step.of_all * seen + of_one + step.of_root * seen**0.5)

    steps = {name: seconds(name, costs[name]) for name in (*estimation, *textures)}
    layered = {name: seconds(name, step) for name, step in LAYERED.items()} if "layers" in steps else {}
    if surface is not None and surface.surface == "layers":
        steps, layered = steps | layered, {}
    elif layered:
        steps["layers"] = 0.0
        if len(sizes) >= LAYERS_DENSE_VIEWS:
            steps["trial"] = seconds("trial", DENSE_TRIAL)
            layered = {name: DENSE_LAYERS_RATIO * spent for name, spent in layered.items()}
    memory = MEMORY_FIXED_BYTES + MEMORY_BYTES_A_PIXEL * pixels
    if "array" in estimation:
        memory = max(memory, _depth_memory(capture))
    return Cost(steps, layered, memory, SCRATCH_BYTES_A_PIXEL * pixels)


def _depth_memory(capture: Capture) -> float:
    """Bytes that the depth of an array may take: labels may be as many as a sweep has at most."""
    width, height = common_frame(capture)[1]
    volume = DEPTH_SWEEP_BYTES * DEPTH_SWEEP_MAX_LABELS * DEPTH_VIEW_RATIO * width * height
    smaller = min(1.0, DEPTH_MAX_BYTES / volume)  # to which photographs are reduced
    beside = DEPTH_BYTES_A_PIXEL * len(capture.sizes) * width * height
    return DEPTH_FIXED_BYTES + smaller * (volume + beside)


def _looks_around(capture: Any) -> bool:
    """Whether cameras are known, and look to all sides."""
    light_field = capture.light_field
    return light_field is not None and not looks_one_way(light_field.cameras)


def _estimation(capture: Any, settings: SurfaceOptions, atlas: bool) -> list[str]:
    """The names of the steps that make cameras and proxy; `atlas`: as of `reconstruct`."""
    unknown = capture.light_field is None
    found = ["motion"] if unknown and capture.layout is None else []
    one_way = not _looks_around(capture)
    if settings.surface != "layers":
        all_around = ["surface", "proxy"] if atlas else ["surface"]
        found += ["array", "relief"] if one_way and settings.surface != "poisson" else all_around
    elif one_way:
        found += ["array"]
    may_have_layers = settings.layers != 1 and capture_fault(capture, most=1) is None  # cut-outs are alike
    if settings.surface in ("auto", "layers") and may_have_layers:
        found += ["trial"] if settings.layers is None else []
        found += ["layers"]
    return found


def _textures(options: EncodeOptions) -> list[str]:
    """The names of the steps from a proxy to a scene."""
    return ["mesh", "maps" if options.resolved().fit == "none" else "fit", "code"]
