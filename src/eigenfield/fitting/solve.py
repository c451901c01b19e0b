"""Least squares over the photographs: conjugate gradients for mean and textures together, and for the weights.

Minimised is the sum over cameras c of |photograph - G_c (M + U sum_j w_cj E_j)|^2, where G_c draws a texture as the
renderer does and U makes the coarse sum as fine as the mean, plus small Laplacians of mean and textures, which settle
what no photograph sees. Only pixels that a camera covers count, each against what is drawn there: nothing is filled in
first, so that this is principal component analysis with missing data, in the pictures instead of the texture maps.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from eigenfield.fitting.kernels import add_laplacian
from eigenfield.fitting.model import Finers, Model
from eigenfield.fitting.passes import Look, Textures, look
from eigenfield.fitting.shots import Shots

MEAN_SMOOTHNESS = 0.004  # of a seen texel's own part in the pictures, the median
TEXTURE_SMOOTHNESS = 0.0025
RIDGE = 1e-5  # of the mean diagonal, for weights


@dataclass(frozen=True, eq=False)
class Scales:
    """How much of the pictures a texel answers for, summed over the cameras.

    mean: (rows, columns) float32 of the mean. coarse: (h, w) float32 of a component whose weights have mean square 1.
    smooth: strength of the Laplacians of mean and components.
    """

    mean: NDArray[np.float32]
    coarse: NDArray[np.float32]
    smooth: tuple[float, float]


def measure_scales(shots: Shots, model: Model, finers: Finers) -> Scales:
    """Row sums of the normal matrix: G^T G of ones, which Catmull-Rom's negative taps leave a little below its diagonal
    plus all around it, and the same on the coarse grid."""
    ones = np.ones((1, *finers.fine), np.float32)
    direct = Finers(None, finers.grid)
    ones = np.ones((1, *finers.fine), np.float32)
    direct = Finers(None, finers.grid)
    bare = Model(np.full((1, 3), 1 / 3, np.float32), ones, model.grid, [])
    found = look(
        shots, bare, direct, mean=ones, textures=None, weights=[], photographs=False, wanted=(True, False, False)
    )
    fine = np.maximum(found.mean, 0)
    coarse = np.zeros((1, *model.grid), np.float32)
    finers.grid.down(fine, coarse)
    np.maximum(coarse, 0, out=coarse)
    mean = np.maximum(finers.coarse_mean(fine)[0], 0)
    return Scales(mean, coarse[0], (MEAN_SMOOTHNESS * _median(mean), TEXTURE_SMOOTHNESS * _median(coarse)))


def _median(values: NDArray[np.float32]) -> float:
    seen = values[values > 0]
    return float(np.median(seen)) if len(seen) else 1.0


def fit_textures(
    shots: Shots, model: Model, finers: Finers, scales: Scales, iterations: int, step: int = 1, mean_only: bool = False
) -> float:
    """Mean and textures of the model for its weights, or the mean alone for its textures as well; returns the sum of
    squares before."""
    blocks = [] if mean_only else model.blocks
    energy = [np.square(block.weights, dtype=np.float64).mean(axis=0).astype(np.float32) for block in blocks]
    inverse = [1 / (scales.mean + np.float32(4 * scales.smooth[0] + 1e-6))[None]]
    for block, squares in zip(blocks, energy, strict=True):
        share = (scales.coarse[block.window] + np.float32(4 * scales.smooth[1]))[None, None]
        inverse.append(1 / (np.maximum(squares, 1e-6)[:, None, None, None] * share + np.float32(1e-6)))

    def smooth(found: list[NDArray[np.float32]], of: list[NDArray[np.float32]], sign: float) -> None:
        add_laplacian(of[0], np.float32(sign * scales.smooth[0]), found[0])
        for part, texture, squares in zip(found[1:], of[1:], energy, strict=True):
            for j in range(len(texture)):
                add_laplacian(texture[j], np.float32(sign * scales.smooth[1] * squares[j]), part[j])

    weights = [block.weights for block in model.blocks]

    def apply(mean: NDArray[np.float32], textures: Textures | None, photographs: bool) -> Look:
        return look(
            shots, model, finers, mean=mean, textures=textures, weights=weights, photographs=photographs,
            wanted=(True, not mean_only, False), step=step,
        )  # fmt: skip

    state = [model.mean, *(block.textures for block in blocks)]
    first = apply(model.mean, [block.textures for block in model.blocks], True)
    residual = [first.mean, *first.textures]
    smooth(residual, state, -1)
    direction = [m * r for m, r in zip(inverse, residual, strict=True)]
    product = _dot(residual, direction)
    for _ in range(iterations):
        if product <= 0:
            break
        back = apply(direction[0], None if mean_only else direction[1:], False)
        image = [back.mean, *back.textures]
        smooth(image, direction, 1)
        length = np.float32(product / _dot(direction, image))
        for x, r, d, q in zip(state, residual, direction, image, strict=True):
            x += length * d
            r -= length * q
        ready = [m * r for m, r in zip(inverse, residual, strict=True)]
        product, before = _dot(residual, ready), product
        turn = np.float32(product / before)
        direction = [z + turn * d for z, d in zip(ready, direction, strict=True)]
    return float(first.squares.sum())


def fit_weights(shots: Shots, model: Model, finers: Finers, iterations: int, step: int = 1) -> float:
    """The weights of all cameras for the model's mean and textures, each camera its own least squares, solved side by
    side; returns the sum of squares before."""
    blocks = model.blocks
    textures = [block.textures for block in blocks]
    sizes = [block.count for block in blocks]
    cuts = np.cumsum([0, *sizes])

    def split(rows: NDArray[np.float32]) -> Textures:
        return [np.ascontiguousarray(rows[:, a:b]) for a, b in pairwise(cuts)]

    def apply(rows: NDArray[np.float32], photographs: bool) -> Look:
        return look(
            shots, model, finers, mean=model.mean if photographs else None, textures=textures, weights=split(rows),
            photographs=photographs, wanted=(False, False, True), step=step,
        )  # fmt: skip

    state = np.concatenate([block.weights for block in blocks], axis=1)
    first = apply(state, True)
    residual = np.concatenate(first.weights, axis=1)
    # Whitened components draw pictures of about one size, so that the diagonal is about one number a camera
    energy = np.concatenate([np.square(texture).sum(axis=(1, 2, 3)) for texture in textures])
    scale = np.float32(max(float(energy.mean()), 1e-12))
    direction = residual.copy()
    product = np.square(residual, dtype=np.float64).sum(axis=1)
    for _ in range(iterations):
        image = np.concatenate(apply(direction, False).weights, axis=1) + np.float32(RIDGE) * scale * direction
        bent = (direction.astype(np.float64) * image).sum(axis=1)
        length = np.divide(product, bent, out=np.zeros_like(product), where=bent > 0).astype(np.float32)[:, None]
        state += length * direction
        residual -= length * image
        before, product = product, np.square(residual, dtype=np.float64).sum(axis=1)
        turn = np.divide(product, before, out=np.zeros_like(product), where=before > 0).astype(np.float32)[:, None]
        direction = residual + turn * direction
    for block, rows in zip(blocks, split(state), strict=True):
        block.weights = rows
    return float(first.squares.sum())


def whiten(model: Model, scales: Scales) -> None:
    """Turn each block's components so that their weights are uncorrelated, of mean square 1, and the textures
    orthogonal in the pictures (texels counted by what they answer for), the strongest first; signs as eigen textures
    have them. What is drawn stays the same."""
    for block in model.blocks:
        if not block.count:
            continue
        weights = block.weights.astype(np.float64)
        rows = len(weights)
        q, r = np.linalg.qr(weights)
        flat = block.textures.reshape(block.count, -1)
        mixed = r.astype(np.float32) @ flat
        share = np.sqrt(scales.coarse[block.window]).reshape(-1)
        counted = mixed.reshape(len(mixed), model.channels, -1) * share
        counted = counted.reshape(len(mixed), -1)
        gram = (counted @ counted.T).astype(np.float64)
        _, turn = np.linalg.eigh(gram)
        turn = turn[:, ::-1]
        textures = (turn.T.astype(np.float32) @ mixed) / np.float32(np.sqrt(rows))
        largest = np.abs(textures).argmax(axis=1)
        signs = np.where(textures[np.arange(len(textures)), largest] < 0, -1.0, 1.0)
        block.textures = np.ascontiguousarray(
            (textures * signs[:, None].astype(np.float32)).reshape(-1, *block.textures.shape[1:])
        )
        block.weights = np.ascontiguousarray((q @ turn * signs * np.sqrt(rows)).astype(np.float32))


def _dot(a: list[NDArray[np.float32]], b: list[NDArray[np.float32]]) -> float:
    return float(
        sum(np.einsum("i,i->", x.reshape(-1), y.reshape(-1), dtype=np.float64) for x, y in zip(a, b, strict=True))
    )
