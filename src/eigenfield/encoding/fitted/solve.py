"""Least squares over the photographs: conjugate gradients for mean and textures together, and for the weights.

Minimised is the sum over observations i of |photograph_i - G M - G sum_j w_ij E_j|^2, where G, of the camera that took
i, draws a texture of any size as the renderer does (see `passes`), plus small Laplacians of mean and textures, which
determine what no photograph sees. Only pixels that a camera covers count, each against what is drawn there: nothing is
filled in first, so that this is principal component analysis with missing data, in the pictures instead of the texture
maps.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.fitted.footprints import Footprint
from eigenfield.encoding.fitted.kernels import SHARE_ONE, add_laplacian, adjoint, next_direction, take_step
from eigenfield.encoding.fitted.model import MEAN_ALONE_GRID, AtlasComposer, Block, PlaneModel
from eigenfield.encoding.fitted.observations import FitData
from eigenfield.encoding.fitted.passes import PASS_TASKS, NormalEquations, Textures, render_and_backproject
from eigenfield.encoding.fitted.products import combine, one_blas_thread, weighted_gram
from eigenfield.runtime.parallel import even_pieces, parallel_map

MEAN_SMOOTHNESS_RATIO = 0.004  # of the median diagonal entry of a seen texel
SHEET_SMOOTHNESS_RATIO = 0.02  # likewise, of the mean of sheets: 0.1 dB held out (Fern)
TEXTURE_SMOOTHNESS_RATIO = 0.0025  # likewise
# The least strengths where cameras stand in no array, in pixels that a texel answers for: a texel that few photographs
# see is no surer for that. Chosen on Cube, Temple and Fountain
MEAN_MIN_SMOOTHNESS = 0.1
TEXTURE_MIN_SMOOTHNESS = 0.2
WEIGHT_RIDGE_RATIO = 1e-5  # of the mean diagonal entry


@dataclass(frozen=True, eq=False)
class Scales:
    """How much of the pictures a texel answers for, summed over the observations.

    Attributes:
        mean: (rows, columns) float32 of the mean.
        coarse: (h, w) float32 of a component whose weights have mean square 1.
        smooth: strength of the Laplacians of mean and components.
        mean_noise: (rows, columns) float32: the squared error that an error of 1 in a texel of the mean alone makes. On
            an opaque surface it is `mean`, and where several sheets share a pixel it is less.
        coarse_noise: (h, w) float32, likewise of a component.
        usual: `mean` of a texel that all observations see, and nothing else in its pixels.
    """

    mean: NDArray[np.float32]
    coarse: NDArray[np.float32]
    smooth: tuple[float, float]
    mean_noise: NDArray[np.float32]
    coarse_noise: NDArray[np.float32]
    usual: float

    @property
    def nbytes(self) -> int:
        """Of its arrays."""
        own = self.mean.nbytes + self.coarse.nbytes
        return 2 * own if self.soft else own

    @property
    def soft(self) -> bool:
        """Whether they are of sheets with an opacity."""
        return self.mean_noise is not self.mean

    def for_scattered_cameras(self) -> Scales:
        """The same, at least as smooth as cameras in no array need it."""
        mean, components = self.smooth
        return replace(self, smooth=(max(mean, MEAN_MIN_SMOOTHNESS), max(components, TEXTURE_MIN_SMOOTHNESS)))

    @classmethod
    def opaque(cls, mean: NDArray[np.float32], coarse: NDArray[np.float32], smooth: tuple[float, float]) -> Scales:
        """Of a surface of which a pixel shows nothing but one texel and its neighbours."""
        return cls(mean, coarse, smooth, mean, coarse, _median(mean))


def measure_scales(data: FitData, model: PlaneModel) -> Scales:
    """Row sums of the normal matrix, G^T G 1 = G^T 1: what Catmull-Rom's negative taps leave of its diagonal plus all
    around it, on either grid.

    Args:
        model: A model of the same grids; of a mean alone, nothing is measured for components and their rate.
    """
    fine, coarse = _texel_sums(data, model, squared=False)
    soft = len(data.footprints.shares) > 0
    ratio = SHEET_SMOOTHNESS_RATIO if soft else MEAN_SMOOTHNESS_RATIO
    smooth = ratio * _median(fine), TEXTURE_SMOOTHNESS_RATIO * _median(coarse)
    if not soft or model.grid == MEAN_ALONE_GRID:
        return Scales.opaque(fine, coarse, smooth)
    density = data.footprints.detail * np.sqrt(fine.size / np.prod(data.size))
    return Scales(fine, coarse, smooth, *_texel_sums(data, model, squared=True), len(data) / float(density) ** 2)


def _texel_sums(data: FitData, model: PlaneModel, squared: bool) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """G^T 1 on the grids of mean and components, G with its shares or with their squares."""
    fine, coarse = np.zeros((1, *model.mean.shape[1:]), np.float32), np.zeros((1, *model.grid), np.float32)

    def piece(part: tuple[int, int]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        mean, grid = np.zeros_like(fine), np.zeros_like(coarse)
        for index in range(*part):
            footprint = data.footprint(index)
            if squared:
                footprint = squared_shares(footprint)
            weight, ones = data.observations.weights(index), np.ones((1, *footprint[0].shape), np.float32)
            adjoint(*footprint, data.size, ones, weight, mean)
            if model.grid != MEAN_ALONE_GRID:
                adjoint(*footprint, data.size, ones, weight, grid)
        return mean, grid

    for mean, grid in parallel_map(piece, even_pieces(len(data), PASS_TASKS)):
        fine += mean
        coarse += grid
    np.maximum(fine, 0, out=fine)
    np.maximum(coarse, 0, out=coarse)
    return fine[0], coarse[0]


def squared_shares(footprint: Footprint) -> Footprint:
    """The footprint with the squares of its shares; that of an opaque surface has none."""
    counts, points, shares = footprint
    return counts, points, (np.square(shares, dtype=np.float32) / SHARE_ONE).astype(np.uint16)


def _median(values: NDArray[np.float32]) -> float:
    seen = values[values > 0]
    return float(np.median(seen)) if len(seen) else 1.0


def residual(
    data: FitData,
    model: PlaneModel,
    wanted: tuple[bool, bool, bool] = (True, True, False),
    composer: AtlasComposer | None = None,
    variance: float | None = None,
) -> NormalEquations:
    """The model's residual in the photographs, brought back to mean and textures unless something else is wanted."""
    return render_and_backproject(
        data, model, mean=model.mean, textures=[block.textures for block in model.blocks],
        weights=[block.weights for block in model.blocks], photographs=True, wanted=wanted, composer=composer,
        variance=variance,
    )  # fmt: skip


def fit_textures(
    data: FitData,
    model: PlaneModel,
    scales: Scales,
    iterations: int,
    *,
    mean_only: bool = False,
    equations: NormalEquations | None = None,
) -> None:
    """Fit mean and textures to the photographs for the weights that the model has, by conjugate gradients.

    For fixed weights this is one linear least squares problem, and observations of other frames take no part in it:
    frames of a clip that share their weights are fitted each by itself.

    Args:
        model: Where the solution begins, and where it is put.
        scales: Of these data.
        mean_only: Whether the textures stay as they are.
        equations: `residual` of the model as it is, where it is known; its sums are used up.
    """
    if equations is None:
        equations = residual(data, model, (True, not mean_only, False))
    blocks = [] if mean_only else model.blocks
    weights = [block.weights for block in model.blocks]
    scales_of_parts = [_PartScales(scales.mean, scales.smooth[0], 1.0)]
    for block in blocks:
        share, energy = np.ascontiguousarray(scales.coarse[block.window]), np.square(block.weights, dtype=np.float64)
        scales_of_parts += [_PartScales(share, scales.smooth[1], max(float(e), 1e-6)) for e in energy.mean(axis=0)]
    mean, textures = np.zeros_like(model.mean), [np.zeros_like(block.textures) for block in blocks]
    gradients = _ConjugateGradients(
        scales_of_parts, _parts(model.mean, [block.textures for block in blocks]),
        _parts(equations.mean, equations.textures), _parts(mean, textures),
    )  # fmt: skip
    product = gradients.begin()
    for _ in range(iterations):
        if product <= 0:
            break
        back = render_and_backproject(
            data, model, mean=mean, textures=None if mean_only else textures, weights=weights, photographs=False,
            wanted=(True, not mean_only, False),
        )  # fmt: skip
        image = _parts(back.mean, back.textures)
        length = product / gradients.curvature(image)
        product, before = gradients.take_step(image, length), product
        gradients.next_direction(product / before)


def _parts(mean: NDArray[np.float32], textures: Textures) -> Textures:
    """The mean and each component, (C, rows, columns)."""
    return [mean, *(texture for found in textures for texture in found)]


@dataclass(frozen=True, eq=False)
class _ConjugateGradients:
    """The vectors of preconditioned conjugate gradients, in parts: the mean, and each component.

    Attributes:
        scales_of_parts: The diagonal of the normal matrix.
        state: The solution so far.
        rest: The residual of the normal equations.
        direction: The search direction.
    """

    scales_of_parts: list[_PartScales]
    state: Textures
    rest: Textures
    direction: Textures

    def begin(self) -> float:
        """The first direction, of what is left without the Laplacian; how much is left, by the preconditioner."""
        self._sum(lambda i: add_laplacian(self.state[i], -self.scales_of_parts[i].strength, self.rest[i]))
        return self.next_direction(0.0)

    def curvature(self, image: Textures) -> float:
        """direction . A direction; image: A direction, but for the Laplacian, which is added."""
        return self._sum(lambda i: add_laplacian(self.direction[i], self.scales_of_parts[i].strength, image[i]))

    def take_step(self, image: Textures, length: float) -> float:
        """A step along the direction; how much is left, by the preconditioner."""
        step, state, rest, along = np.float32(length), self.state, self.rest, self.direction
        return self._sum(
            lambda i: take_step(state[i], rest[i], along[i], image[i], step, *self.scales_of_parts[i].diagonal)
        )

    def next_direction(self, ratio: float) -> float:
        """The next direction, with `ratio` of the present one."""
        part = np.float32(ratio)
        return self._sum(
            lambda i: next_direction(self.direction[i], self.rest[i], part, *self.scales_of_parts[i].diagonal)
        )

    def _sum(self, function: Callable[[int], float]) -> float:
        return float(np.sum(parallel_map(function, range(len(self.scales_of_parts)))))


@dataclass(frozen=True, eq=False)
class _PartScales:
    """The diagonal of the normal matrix for the mean, or for one component.

    Attributes:
        share: (h, w) what its texels answer for.
        smooth: Its Laplacian's strength at weights of mean square 1.
        energy: The mean square of its weights.
    """

    share: NDArray[np.float32]
    smooth: float
    energy: float

    @property
    def strength(self) -> np.float32:
        return np.float32(self.smooth * self.energy)

    @property
    def diagonal(self) -> tuple[NDArray[np.float32], np.float32, np.float32]:
        return self.share, np.float32(4 * self.smooth), np.float32(self.energy)


def fit_weights(data: FitData, model: PlaneModel, iterations: int) -> None:
    """The weights of all observations for the model's mean and textures, each row its own least squares, solved side
    by side.

    Args:
        model: is changed in place.
    """
    blocks = model.blocks
    textures = [block.textures for block in blocks]
    sizes = [block.count for block in blocks]
    cuts = np.cumsum([0, *sizes])

    def split(rows: NDArray[np.float32]) -> Textures:
        return [np.ascontiguousarray(rows[:, a:b]) for a, b in pairwise(cuts)]

    def backproject(rows: NDArray[np.float32], photographs: bool) -> NDArray[np.float32]:
        found = render_and_backproject(
            data, model, mean=model.mean if photographs else None, textures=textures, weights=split(rows),
            photographs=photographs, wanted=(False, False, True),
        )  # fmt: skip
        return np.concatenate(found.weights, axis=1)

    state = np.concatenate([block.weights for block in blocks], axis=1)
    rest = backproject(state, True)
    # Whitened components draw pictures of about one size, so that the diagonal is about one number a row
    energy = np.concatenate([np.einsum("nchw,nchw->n", texture, texture) for texture in textures])
    ridge = np.float32(WEIGHT_RIDGE_RATIO * max(float(energy.mean()), 1e-12))
    direction = rest.copy()
    product = np.square(rest, dtype=np.float64).sum(axis=1)
    for _ in range(iterations):
        image = backproject(direction, False) + ridge * direction
        curvature = (direction.astype(np.float64) * image).sum(axis=1)
        length = np.divide(product, curvature, out=np.zeros_like(product), where=curvature > 0)
        length = length.astype(np.float32)[:, None]
        state += length * direction
        rest -= length * image
        before, product = product, np.square(rest, dtype=np.float64).sum(axis=1)
        ratio = np.divide(product, before, out=np.zeros_like(product), where=before > 0).astype(np.float32)[:, None]
        direction = rest + ratio * direction
    for block, rows in zip(blocks, split(state), strict=True):
        block.weights = rows


@one_blas_thread
def whiten(model: PlaneModel, scales: Scales) -> None:
    """Rotate each block's components so that their weights are uncorrelated, of mean square 1, and the textures
    orthogonal in the pictures, the strongest first; signs as eigen textures have them. What is drawn stays the same.

    Args:
        model: Is changed in place.
    """
    for block in model.blocks:
        if not block.count:
            continue
        flat = block.textures.reshape(block.count, -1)
        rotation, weights = whitening(block.weights, texture_gram(block, scales))
        textures = np.empty_like(flat)
        combine(rotation.astype(np.float32), flat, textures)
        low, high = textures.min(axis=1), textures.max(axis=1)
        signs = np.where(-low > high, -1.0, 1.0)  # of the largest
        textures *= signs[:, None].astype(np.float32)
        block.textures = textures.reshape(-1, *block.textures.shape[1:])
        block.weights = np.ascontiguousarray((weights * signs).astype(np.float32))


@one_blas_thread
def texture_gram(block: Block, scales: Scales) -> NDArray[np.float64]:
    """(n, n) scalar products of a block's textures in the pictures. Those of frames that share weights are added."""
    share = np.tile(np.sqrt(scales.coarse[block.window]).reshape(-1), block.textures.shape[1])
    return weighted_gram(block.textures.reshape(block.count, -1), share)


@one_blas_thread
def whitening(
    weights: NDArray[np.float32], gram: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A matrix (n, n) by which textures are multiplied, and the weights (No, n) that go with what becomes of them:
    uncorrelated and of mean square 1, with textures that are orthogonal, the strongest first.

    Args:
        weights: (No, n).
        gram: Of `texture_gram`, before.
    """
    q, r = np.linalg.qr(weights.astype(np.float64))
    _, rotation = np.linalg.eigh(r @ gram @ r.T)
    rotation = rotation[:, ::-1]
    return rotation.T @ r / np.sqrt(len(weights)), q @ rotation * np.sqrt(len(weights))
