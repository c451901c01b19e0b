"""The open loop of a group: weights that its frames share, and mean and textures of each frame for these.

The Gram matrices of what the means leave are summed over the frames (equation 6), which gives the weights that are best
in the least squares sense for all frames together. For them each frame's mean and textures are fitted by itself. Then
each camera's weights are fitted to all frames at once (`tied_weights`), and the frames to these again.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.clip.frames import Arrays, FramePass, GroupFrames
from eigenfield.encoding.clip.plan import ClipPlan, ClipPlane, FramePixels
from eigenfield.encoding.fitted.coverage import fill_unseen
from eigenfield.encoding.fitted.fit import FIT_MEAN_ITERATIONS, FIT_SIGMA_RATIO
from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.observations import FitData
from eigenfield.encoding.fitted.planes import FEW_TEXTURE_ITERATIONS, MANY_TEXTURE_ITERATIONS
from eigenfield.encoding.fitted.products import combine
from eigenfield.encoding.fitted.solve import Scales, fit_textures, residual, texture_gram, whitening
from eigenfield.encoding.fitted.start import open_residual_maps, principal_weights
from eigenfield.encoding.fitted.tied_weights import WeightEquations, weight_equations

# From farther off, frames that are fitted to what changes alone would each fill it otherwise, and films code that
CLIP_OUTLINE_TEXELS = 1.0
FIRST_ROUNDS = 2  # at least


@dataclass(frozen=True, eq=False)
class SharedWeights:
    """The weights of a plane at a step of the fit.

    Attributes:
        weights: (Nc, n) float32.
        rotation: (n, n) float32 by which the textures of each frame are multiplied to go with them.
        variance: Of what the model leaves of a pixel, times the square of FIT_SIGMA_RATIO; None: not known yet.
    """

    weights: NDArray[np.float32]
    rotation: NDArray[np.float32]
    variance: float | None = None


@dataclass(frozen=True, eq=False)
class OpenGroup:
    """A group fitted, not coded.

    Attributes:
        frames: `mean` and `textures` of each plane, by its number.
        weights: Of each plane, by which the frames are drawn.
    """

    frames: FramePass
    weights: tuple[SharedWeights, ...]


def fit_group(group: GroupFrames, rounds: int) -> OpenGroup:
    """Mean and textures of each frame, for weights that all share.

    Args:
        rounds: Of fitting frames and weights in turns.
    """
    clip = group.clip
    done = group.run("mean", lambda pixels, first: _fit_means(clip, pixels, first), with_first=True)
    weights = tuple(_principal(done, plane, number) for number, plane in enumerate(clip.planes))
    for turn in range(max(rounds, FIRST_ROUNDS)):
        now, last = weights, turn == max(rounds, FIRST_ROUNDS) - 1

        def make(
            pixels: FramePixels,
            before: Arrays,
            first: Arrays | None,
            now: tuple[SharedWeights, ...] = now,
            last: bool = last,
        ) -> Arrays:
            return _fit_textures(clip, pixels, before, first, now, last)

        done = group.run(f"textures-{turn}", make, done, done, with_first=True)
        if not last:
            weights = tuple(_solved(done, number, one) for number, one in enumerate(now))
    return OpenGroup(done, weights)


def _fit_means(clip: ClipPlan, pixels: FramePixels, first: Arrays | None) -> Arrays:
    """The mean alone of each plane, and the Gram matrix of what it leaves.

    Args:
        first: What was found of the group's first frame; None: this is it.
    """
    found: dict[str, NDArray[np.float32] | NDArray[np.float64]] = {}
    for number, plane in enumerate(clip.planes):
        data, model = pixels.fitted(plane), plane.settings.grey_model()
        scales = pixels.scales(plane)
        _fit(pixels, data, model, scales, FIT_MEAN_ITERATIONS, number, first)
        found[f"mean{number}"] = model.mean
        with open_residual_maps(data, model, scales, plane.rectangle, plane.settings.scattered, clip.work) as maps:
            found[f"gram{number}"] = maps.gram()
    return found


def _principal(done: FramePass, plane: ClipPlane, number: int) -> SharedWeights:
    """The weights of a plane by the sum of all frames' Gram matrices."""
    count = plane.settings.textures
    weights = principal_weights(done.total(f"gram{number}"), count).astype(np.float32)
    return SharedWeights(np.ascontiguousarray(weights), np.eye(count, dtype=np.float32))


def _fit_textures(
    clip: ClipPlan,
    pixels: FramePixels,
    before: Arrays,
    first: Arrays | None,
    weights: tuple[SharedWeights, ...],
    last: bool,
) -> Arrays:
    """Mean and textures of each plane of a frame for given weights, and the frame's part in the next weights.

    Args:
        first: What this function made of the group's first frame; None: this is it.
        last: Whether there are no next weights.
    """
    iterations = FEW_TEXTURE_ITERATIONS if clip.few else MANY_TEXTURE_ITERATIONS
    found: dict[str, NDArray[np.float32] | NDArray[np.float64]] = {}
    for number, (plane, shared) in enumerate(zip(clip.planes, weights, strict=True)):
        model, fitted = plane.settings.grey_model(), pixels.fitted(plane)
        model.mean, scales = before[f"mean{number}"], pixels.scales(plane)
        with pixels.weighed(fitted, shared.variance) as data:
            textures = before.get(f"textures{number}")
            if textures is None:
                seen = data if first is None or pixels.active is None else pixels.active[number].data(data)
                textures = _projection(clip, plane, seen, scales, model, shared.weights)
            model.blocks = [Block(plane.rectangle, _rotated(textures, shared.rotation), shared.weights)]
            _fit(pixels, data, model, scales, iterations, number, first, shared.variance)
        if not last:
            with pixels.weighed(pixels.thinned, shared.variance) as some:
                found |= equation_arrays(weight_equations(some, model, shared.variance), number)
            found[f"energy{number}"] = texture_gram(model.blocks[0], scales)
        fill_unseen(model, scales, clip.footprints.surface, CLIP_OUTLINE_TEXELS)
        if last and clip.moving is not None:
            found[f"mean{number}-share"], found[f"textures{number}-share"] = scales.mean, scales.coarse
        found[f"mean{number}"], found[f"textures{number}"] = model.mean, model.blocks[0].textures
    return found


def _fit(
    pixels: FramePixels,
    data: FitData,
    model: PlaneModel,
    scales: Scales,
    iterations: int,
    number: int,
    first: Arrays | None,
    variance: float | None = None,
) -> None:
    """Fit mean and textures of a plane of a frame, or the mean alone where the model has no textures.

    Args:
        data: Of the plane, all pixels; those that see nothing that changes are left out here.
        number: Of the plane.
        first: What the same fit has found of the group's first frame; None: this is it, and all of it is fitted.
    """
    if first is not None and pixels.active is not None:
        active = pixels.active[number]
        data, scales = active.data(data), active.scales(scales)
        active.put_rest(model, first[f"mean{number}"], first.get(f"textures{number}"))
    equations = residual(data, model, (True, bool(model.blocks), False), variance=variance)
    fit_textures(data, model, scales, iterations, mean_only=not model.blocks, equations=equations)


def _projection(
    clip: ClipPlan, plane: ClipPlane, data: FitData, scales: Scales, model: PlaneModel, weights: NDArray[np.float32]
) -> NDArray[np.float32]:
    """(n, C, h, w): what the mean leaves, projected on the weights.

    Args:
        data: All pixels that see the texels for which it is asked.
        scales: Of all pixels.
    """
    with open_residual_maps(data, model, scales, plane.rectangle, plane.settings.scattered, clip.work) as maps:
        return maps.textures(weights.astype(np.float64))


def _rotated(textures: NDArray[np.float32], rotation: NDArray[np.float32]) -> NDArray[np.float32]:
    rotated = np.empty_like(textures)
    combine(rotation, textures.reshape(len(textures), -1), rotated.reshape(len(textures), -1))
    return rotated


def _solved(done: FramePass, number: int, shared: SharedWeights) -> SharedWeights:
    """The weights of a plane fitted to all frames, uncorrelated and of mean square 1 again."""
    equations = summed_equations(done, number)
    weights = equations.solve(shared.weights)
    rotation, whitened = whitening(weights, done.total(f"energy{number}"))
    variance = FIT_SIGMA_RATIO**2 * equations.squares / max(equations.pixels, 1.0)
    return SharedWeights(
        np.ascontiguousarray(whitened.astype(np.float32)), np.ascontiguousarray(rotation.astype(np.float32)), variance
    )


def equation_arrays(equations: WeightEquations, number: int) -> dict[str, NDArray[np.float64]]:
    """The equations of a frame's plane, as they are kept."""
    error = np.array([equations.squares, equations.pixels])
    return {f"matrix{number}": equations.matrix, f"right{number}": equations.right, f"error{number}": error}


def summed_equations(done: FramePass, number: int) -> WeightEquations:
    """The equations of a plane, of all frames."""
    squares, pixels = done.total(f"error{number}")
    return WeightEquations(done.total(f"matrix{number}"), done.total(f"right{number}"), float(squares), float(pixels))
