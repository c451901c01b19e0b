"""The closed loop of a group: what is coded later makes up for what was lost before.

The film of eigen textures is coded first. Each camera's weights are fitted to the decoded textures of all frames, and
coded. Each frame's mean is fitted to both, and the film of means is coded last.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.codecs import encoder
from eigenfield.coding.video.film_layout import MEANS, TEXTURES
from eigenfield.core.films import CodedGroup, FilmLayout
from eigenfield.core.payloads import Payload
from eigenfield.encoding.clip.films import (
    MEAN_STEP_RATIOS,
    TEXTURE_STEP_RATIO,
    CodedFilm,
    code_film,
    film_scale,
    film_step,
    range_of,
)
from eigenfield.encoding.clip.frames import Arrays, FramePass, GroupFrames
from eigenfield.encoding.clip.hidden import hidden_held
from eigenfield.encoding.clip.open_loop import OpenGroup, equation_arrays, summed_equations
from eigenfield.encoding.clip.plan import ClipPlan, FramePixels
from eigenfield.encoding.fitted.fit import (
    FIT_CLOSING_ITERATIONS,
    MEAN_WANTED,
    WEIGHTS_CODEC,
    texture_squares,
    weight_steps,
)
from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.passes import psnr_of
from eigenfield.encoding.fitted.rate import effects_on_trial, plane_lambda
from eigenfield.encoding.fitted.solve import fit_textures, residual
from eigenfield.encoding.fitted.tied_weights import weight_equations

TRIAL_EVERY = 5  # frames, to one whose textures are coded on trial
FILM_BYTES_RATIO = 0.25  # of a texture in a film to one that is a picture by itself

Pictures = list[NDArray[np.float32]]  # of each plane (n, rows, columns)


def texture_counts(clip: ClipPlan, opened: OpenGroup) -> tuple[int, ...]:
    """How many textures of each plane take off more squared error than lambda x their bytes, at least one; by what
    those of some frames take as pictures."""
    totals = [np.zeros(plane.settings.textures) for plane in clip.planes]
    for arrays in islice(opened.frames, 0, None, TRIAL_EVERY):
        for number, plane in enumerate(clip.planes):
            block = Block(plane.rectangle, arrays[f"textures{number}"], opened.weights[number].weights)
            errors, sizes = effects_on_trial(block, plane.settings.grid, plane.scales, plane.rate)
            totals[number] += errors + plane_lambda(plane.scales, plane.rate) * FILM_BYTES_RATIO * sizes
    return tuple(max(1, int(np.argmin(np.cumsum([0.0, *total])))) for total in totals)


def code_group(
    group: GroupFrames, opened: OpenGroup, layout: FilmLayout, opacity: CodedFilm | None, closed: bool = True
) -> tuple[CodedGroup, list[float]]:
    """A fitted group coded, and the PSNR in dB of each frame's luma before its mean is coded.

    Args:
        layout: Says how many textures are kept of each plane: the first ones.
        opacity: The film of what sheets let through, which the group was fitted to; None: there are none.
        closed: Whether weights and means make up for what was lost before them; else they are coded as they are, and
            no PSNR is known.
    """
    kept, parts = _kept_textures(opened, layout), layout.planes
    textures = _code_textures(group, opened, kept, layout)
    weights = _code_weights(group, opened, kept, textures) if closed else _weights_as_they_are(group, opened, kept)
    final = _close(group, opened, weights, textures) if closed else opened.frames
    means = _code_means(group, opened, final, layout)
    films = [means, textures] if opacity is None else [means, textures, opacity]
    coded = CodedGroup(
        weights=tuple((one.payload,) for one in weights),
        means=tuple(means.scale.affine(number, plane.channels) for number, plane in enumerate(parts)),
        bases=tuple((textures.scale.affine(number, len(plane.bases[0].at)),) for number, plane in enumerate(parts)),
        units=tuple(zip(*(film.units for film in films), strict=True)),
        motion=None if group.clip.moving is None else group.clip.moving.payload(group.numbers),
    )
    return coded, [float(one) for one in final.each("psnr0")] if closed else []


@dataclass(frozen=True, eq=False)
class _Kept:
    """The textures that are kept of a plane.

    Attributes:
        signs: (n,) by which textures and weights are multiplied, so that the largest number is positive.
        weights: (Nc, n) of the open loop.
        range: The least and the greatest number of all frames.
    """

    signs: NDArray[np.float32]
    weights: NDArray[np.float32]
    range: tuple[float, float]


def _kept_textures(opened: OpenGroup, layout: FilmLayout) -> list[_Kept]:
    """Of each plane."""
    kept = []
    for number, (plane, shared) in enumerate(zip(layout.planes, opened.weights, strict=True)):
        count = len(plane.bases[0].at) // plane.channels
        frames = [(one[:count].min(axis=(1, 2, 3)), one[:count].max(axis=(1, 2, 3)))
                  for one in opened.frames.each(f"textures{number}")]  # fmt: skip
        low, high = np.min([one for one, _ in frames], axis=0), np.max([one for _, one in frames], axis=0)
        signs = np.where(-low > high, -1.0, 1.0).astype(np.float32)
        least = np.where(signs > 0, low, -high)
        limits = float(least.min()), float(np.maximum(-low, high).max())
        kept.append(_Kept(signs, np.ascontiguousarray(shared.weights[:, :count] * signs), limits))
    return kept


def _code_textures(group: GroupFrames, opened: OpenGroup, kept: Sequence[_Kept], layout: FilmLayout) -> CodedFilm:
    """The film of eigen textures."""
    planes = group.clip.planes
    steps = [film_step(one.rate.texture_step, TEXTURE_STEP_RATIO, len(group)) for one in planes]
    scale = film_scale(steps, [one.range for one in kept], [True] * len(kept))

    def pictures() -> Iterator[Pictures]:
        for found in hidden_held(group.clip, opened.frames, opened.frames, "textures"):
            each = [textures[: len(one.signs)] * one.signs[:, None, None, None]
                    for textures, one in zip(found, kept, strict=True)]  # fmt: skip
            yield [one.reshape(-1, *one.shape[2:]) for one in each]

    return code_film(layout, TEXTURES, scale, pictures(), group.keeper("film-of-textures", opened.frames))


@dataclass(frozen=True, eq=False)
class _CodedWeights:
    """A plane's weights (Nc, n) as a file gives them back."""

    weights: NDArray[np.float32]
    payload: Payload


def _code_weights(
    group: GroupFrames, opened: OpenGroup, kept: Sequence[_Kept], textures: CodedFilm
) -> list[_CodedWeights]:
    """The weights of each plane, fitted to the decoded textures of all frames."""
    clip = group.clip

    def make(pixels: FramePixels, given: tuple[Arrays, Pictures]) -> Arrays:
        found: dict[str, NDArray[np.float64]] = {}
        for number, model in enumerate(_models(clip, *given, [one.weights for one in kept])):
            variance = opened.weights[number].variance
            with pixels.weighed(pixels.thinned, variance) as some:
                found |= equation_arrays(weight_equations(some, model, variance), number)
            found[f"squares{number}"] = texture_squares(model.blocks[0], clip.planes[number].scales)
        return found

    done = group.run("weights", make, zip(opened.frames, textures.decoded(), strict=True), opened.frames)
    return [
        _coded_weights(clip, number, summed_equations(done, number).solve(one.weights),
                       done.total(f"squares{number}") / len(group))
        for number, one in enumerate(kept)
    ]  # fmt: skip


def _weights_as_they_are(group: GroupFrames, opened: OpenGroup, kept: Sequence[_Kept]) -> list[_CodedWeights]:
    """The weights of the open loop."""
    coded = []
    for number, (plane, one) in enumerate(zip(group.clip.planes, kept, strict=True)):
        blocks = (Block(plane.rectangle, found[: len(one.signs)], one.weights)
                  for found in opened.frames.each(f"textures{number}"))  # fmt: skip
        squares = np.mean([texture_squares(block, plane.scales) for block in blocks], axis=0)
        coded.append(_coded_weights(group.clip, number, one.weights, squares))
    return coded


def _coded_weights(
    clip: ClipPlan, number: int, weights: NDArray[np.floating[Any]], squares: NDArray[np.float64]
) -> _CodedWeights:
    """The weights (Nc, n) of a plane; squares: (n,) of its textures, see `weight_steps`."""
    steps = weight_steps(squares, clip.planes[number].scales)
    stream, stored = encoder(WEIGHTS_CODEC)(weights, steps, clip.plan.views.grid)
    return _CodedWeights(stored, Payload(WEIGHTS_CODEC, stream))


def _close(group: GroupFrames, opened: OpenGroup, weights: Sequence[_CodedWeights], textures: CodedFilm) -> FramePass:
    """The mean of each frame, fitted to what its textures and weights became."""
    clip = group.clip

    def make(pixels: FramePixels, given: tuple[Arrays, Pictures]) -> Arrays:
        found: dict[str, NDArray[Any]] = {}
        for number, model in enumerate(_models(clip, *given, [one.weights for one in weights])):
            plane, variance = clip.planes[number], opened.weights[number].variance
            with pixels.weighed(pixels.fitted(plane), variance) as data:
                equations = residual(data, model, MEAN_WANTED, plane.composer, variance)
                scales = pixels.scales(plane)
                fit_textures(data, model, scales, FIT_CLOSING_ITERATIONS, mean_only=True, equations=equations)
            found[f"mean{number}"] = model.mean
            found[f"psnr{number}"] = np.array(psnr_of(equations.squares, equations.pixels, model.channels))
        return found

    return group.run("close", make, zip(opened.frames, textures.decoded(), strict=True), opened.frames)


def _models(
    clip: ClipPlan, arrays: Arrays, pictures: Pictures, weights: Sequence[NDArray[np.float32]]
) -> Iterator[PlaneModel]:
    """Each plane of a frame with its decoded textures."""
    for number, (plane, decoded, own) in enumerate(zip(clip.planes, pictures, weights, strict=True)):
        model = plane.settings.grey_model()
        model.mean = arrays[f"mean{number}"]
        textures = np.ascontiguousarray(decoded.reshape(-1, model.channels, *decoded.shape[1:]))
        model.blocks = [Block(plane.rectangle, textures, own)]
        yield model


def _code_means(group: GroupFrames, opened: OpenGroup, closed: FramePass, layout: FilmLayout) -> CodedFilm:
    """The film of means."""
    planes = group.clip.planes
    ranges = [range_of(closed.each(f"mean{number}")) for number in range(len(planes))]
    signed = [len(plane.settings.matrix) == 2 for plane in planes]  # differences of colours
    steps = [film_step(plane.rate.mean_step, ratio, len(group))
             for ratio, plane in zip(MEAN_STEP_RATIOS, planes, strict=True)]  # fmt: skip
    scale = film_scale(steps, ranges, signed)
    pictures = hidden_held(group.clip, closed, opened.frames, "mean")
    return code_film(layout, MEANS, scale, pictures, group.keeper("film-of-means", closed))
