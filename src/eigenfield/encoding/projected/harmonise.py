"""Colour harmonisation: what exposure and white balance did to each photograph is taken out of its texture map.

The model, for each channel on its own: observation c, of the camera c where there is one time, shows the point x of the
surface as

    T(c, x) = (M(x) - o(c)) / g(c) + noise,    hence    g(c) T(c, x) + o(c) = M(x) up to noise,

with one mean map M for all observations, as in the compensation of exposures for panoramas (Brown and Lowe, IJCV 2007).
The noise stands on the photograph's side: fitted the other way round, noise in T would pull every gain towards 0.

An exposure changes the whole picture alike; a gloss that comes and goes with the viewpoint does not, and taking the
average of it for an exposure would only spoil the maps. So the fit also measures how far the blocks of the surface
depart from it, each on its own, and colours are shrunk unless they explain more than that (`_shrinkage`).

A resampling filter sums to 1, so gain and offset pass through it: a harmonised map is the map of the harmonised
photograph, and no photograph is decoded twice.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from eigenfield.core.appearance import COLOUR_STEP
from eigenfield.core.progress import Progress
from eigenfield.encoding.projected.project import TextureMaps
from eigenfield.runtime.parallel import parallel_map, tracked_map

log = logging.getLogger("eigenfield.texturing")

Numbers = NDArray[np.float64]

HARMONISE_DARK = 16 / 255  # up to here stray light, clipping and noise are as large as what a gain would change
HARMONISE_BRIGHT = 253 / 255  # from here on a photograph is saturated
HARMONISE_MAX_CELLS = 4096  # of the atlas in the fit
HARMONISE_MAX_NUMBERS = 4_000_000  # observations x cells
HARMONISE_MIN_CELL_FRACTION = 0.9  # of a cell's texels that a camera must see
HARMONISE_MAX_ROUNDS = 30  # of reweighted least squares
HARMONISE_MIN_GAIN_CHANGE = 1e-4  # a round that moves no gain further is the last
HARMONISE_HALF_WEIGHT_DEVIATIONS = 2.385  # residuals of so many standard deviations count half (Cauchy)
HARMONISE_MIN_NOISE = 1 / 255  # that of rounding
HARMONISE_GAIN_PRIOR = 0.1  # standard deviation of gains round 1
HARMONISE_OFFSET_PRIOR = 0.03  # standard deviation of offsets round 0
HARMONISE_PRIOR_CELLS = 25  # residuals of average size that the prior weighs as much as
HARMONISE_MAX_GAIN = 4.0  # its inverse is the smallest
HARMONISE_BLOCKS_PER_AXIS = 4  # of the surface along each of its two longest axes
HARMONISE_INDEPENDENT_BLOCKS = 4  # of all blocks, that a gloss changes independently of each other
HARMONISE_MIN_SHARED_CELLS = 8  # of a camera with others


@dataclass(frozen=True, eq=False)
class Cells:
    """What observations show of the same parts of the surface.

    Attributes:
        values: (No, m, C) averages over square cells of the atlas.
        weights: (No, m, C) how much each counts: the part of the cell that charts cover where the camera sees the cell
            and no texel of it is at an end of the range, else 0.
        blocks: (m,) the block of the surface in which each cell lies.
    """

    values: Numbers
    weights: Numbers
    blocks: NDArray[np.int64]

    def fit(self, model: str) -> NDArray[np.float32]:
        """(No, 2, C) gains and offsets of `fit_colours`, channel by channel, as a file keeps them."""
        channels = range(self.values.shape[2])
        with threadpool_limits(1, "blas"):
            fits = parallel_map(
                lambda c: fit_colours(self.values[..., c], self.weights[..., c], self.blocks, model), channels
            )
        return (np.rint(np.stack(fits, axis=2) / COLOUR_STEP) * COLOUR_STEP).astype(np.float32)

    @property
    def sharing(self) -> list[NDArray[np.bool_]]:
        """(No,) for each channel: which observations have enough in common with others."""
        return [_sharing(self.weights[..., c]) for c in range(self.values.shape[2])]


def harmonise_maps(maps: TextureMaps, model: str = "gain", progress: Progress | None = None) -> NDArray[np.float32]:
    """Fit the cameras' colours to their common mean and change all maps in place; the values are not cut to 0..1.

    Texels at either end of the range do not count.

    Args:
        maps: Of No observations; they become gain * T + offset.
        model: "gain", or "affine" for gain and offset.

    Returns:
        (No, 2, C) float32, gains then offsets. In each channel the gains have the geometric mean 1 and the offsets the
        mean 0 over the cameras that have something in common with others; the rest keep (1, 0), with a warning.
    """
    cells = average_cells(maps, progress)
    colours = cells.fit(model)
    left = maps.count - int(np.any(cells.sharing, axis=0).sum())
    if left:
        log.warning("%d of %d cameras share too little with others: their colours stay", left, maps.count)
    gains = colours[:, 0]
    log.info("harmonised: gains %.3f to %.3f", gains.min(), gains.max())

    def change(index: int) -> None:
        maps.values[index] = harmonised_map(maps.values[index], maps.seen[index], colours[index])

    tracked_map(change, range(maps.count), "harmonise", progress)
    return colours


def harmonised_map(
    values: NDArray[np.float32], seen: NDArray[np.uint8], colour: NDArray[np.float32]
) -> NDArray[np.float32]:
    """One camera's (n, C) map with its gain and offset, (2, C), applied where it sees; zero elsewhere."""
    return np.where(seen[:, None] > 0, values * colour[0] + colour[1], np.float32(0))


def fit_colours(values: Numbers, weights: Numbers, blocks: NDArray[np.int64], model: str = "gain") -> Numbers:
    """(No, 2) gains and offsets of one channel.

    Iteratively reweighted least squares (Cauchy's weights) of T - a M - b with a = 1 / g, b = -o / g. Each round is a
    Gauss-Newton step in all a and b at once, the map M eliminated by its Schur complement: alternating between map and
    cameras needs very many rounds where each camera overlaps only its neighbours. A weak prior keeps what the maps do
    not determine at a = 1, b = 0.

    Args:
        values: (No, m), what each camera shows of m places.
        weights: (No, m), 0 where that does not count.
        blocks: (m,) the part of the surface in which each place lies.
        model: "gain" or "affine".
    """
    active = _sharing(weights)
    result = np.zeros((len(values), 2))
    result[:, 0] = 1
    if active.sum() < 2:
        return result
    T, w = values[active], weights[active]
    shared = (w > 0).sum(axis=0) >= 2
    T, base, blocks = np.ascontiguousarray(T[:, shared]), np.ascontiguousarray(w[:, shared]), blocks[shared]
    a, b = np.ones(len(T)), np.zeros(len(T))
    M = _map(T, base, a, b)
    for count in range(HARMONISE_MAX_ROUNDS):
        residual = T - a[:, None] * M - b[:, None]
        noise = max(1.4826 * float(np.median(np.abs(residual[base > 0]))), HARMONISE_MIN_NOISE)
        w = base / (1 + (residual / (HARMONISE_HALF_WEIGHT_DEVIATIONS * noise)) ** 2) if count else base
        M = _map(T, w, a, b)
        prior = HARMONISE_PRIOR_CELLS * noise**2
        step_a, step_b = _step(T - a[:, None] * M - b[:, None], w, a, b, M, prior, model == "affine")
        before = 1 / a
        a = np.clip(a + step_a, 1 / HARMONISE_MAX_GAIN, HARMONISE_MAX_GAIN)
        b = b + step_b
        a = a / np.exp(np.log(a).mean())
        b = b - a * (b / a).mean()
        M = _map(T, w, a, b)
        if count and np.abs(1 / a - before).max() < HARMONISE_MIN_GAIN_CHANGE:
            break
    kept = _shrinkage(T, w, a, b, M, blocks)
    result[active] = np.stack([a**-kept, -kept * b / a], axis=1)
    return result


def _shrinkage(T: Numbers, w: Numbers, a: Numbers, b: Numbers, M: Numbers, blocks: NDArray[np.int64]) -> float:
    """From 0 to 1, max(0, 1 - V / (n E)): the positive part of James and Stein's factor, n = `independent_blocks`.

    E: squares of what the colours change, Σ w (a M + b - M)². V: what gains of each block's own would change on top of
    that, Σ over cameras and blocks of (Σ w r M)² / Σ w M², with the residuals r. Were V all there is, the average
    over blocks would make E = V / n of it.
    """
    change = (a[:, None] - 1) * M + b[:, None]
    explained = float((w * change**2).sum())
    residual = T - a[:, None] * M - b[:, None]
    apart = 0.0
    for block in np.unique(blocks):
        here = blocks == block
        above = (w[:, here] * residual[:, here] * M[here]).sum(axis=1)
        below = (w[:, here] * M[here] ** 2).sum(axis=1)
        apart += float(np.divide(above**2, below, out=np.zeros_like(above), where=below > 0).sum())
    return max(0.0, 1 - apart / (HARMONISE_INDEPENDENT_BLOCKS * explained)) if explained > 0 else 0.0


def _sharing(weights: Numbers) -> NDArray[np.bool_]:
    """(No,) cameras with enough places that some other such camera shows too."""
    active = np.ones(len(weights), bool)
    while True:
        counts = weights > 0
        common = counts[active].sum(axis=0) >= 2
        kept = active & ((counts & common).sum(axis=1) >= HARMONISE_MIN_SHARED_CELLS)
        if (kept == active).all():
            return active
        active = kept


def _map(T: Numbers, w: Numbers, a: Numbers, b: Numbers) -> Numbers:
    """(m,) the best M for given a and b."""
    above = (w * a[:, None] * (T - b[:, None])).sum(axis=0)
    below = (w * a[:, None] ** 2).sum(axis=0)
    return np.divide(above, below, out=np.zeros_like(above), where=below > 0)


def _step(
    residual: Numbers, w: Numbers, a: Numbers, b: Numbers, M: Numbers, prior: float, affine: bool
) -> tuple[Numbers, Numbers]:
    """The Gauss-Newton step of a and b, M following.

    M is the best one, so its own gradient is zero and the step solves (H - B Bᵀ) δ = gradient: H the cameras' own
    blocks, B their coupling with M over the root of M's diagonal.
    """
    n = len(a)
    below = (w * a[:, None] ** 2).sum(axis=0)
    root = np.divide(1, np.sqrt(below), out=np.zeros_like(below), where=below > 0)
    coupling = w * a[:, None] * root
    parts = [M, np.ones_like(M)] if affine else [M]
    start = [1 - a, -b]
    strength = [prior / HARMONISE_GAIN_PRIOR**2, prior / HARMONISE_OFFSET_PRIOR**2]
    B = np.concatenate([coupling * part for part in parts])
    H = -(B @ B.T)
    gradient = np.empty(len(B))
    here = np.arange(n)
    for i, part in enumerate(parts):
        gradient[i * n : (i + 1) * n] = (w * residual * part).sum(axis=1) + strength[i] * start[i]
        H[i * n + here, i * n + here] += strength[i]
        for j, other in enumerate(parts):
            H[i * n + here, j * n + here] += (w * (part * other)).sum(axis=1)
    step = np.linalg.solve(H, gradient)
    return step[:n], step[n:] if affine else np.zeros(n)


def _blocks(positions: Numbers) -> NDArray[np.int64]:
    """(m,) the block of each of (m, 3) positions: as many in each quarter along the longest axis, and across it."""
    centred = positions - positions.mean(axis=0)
    axes = np.linalg.eigh(centred.T @ centred)[1][:, :0:-1]
    rank = np.argsort(np.argsort(centred @ axes, axis=0, kind="stable"), axis=0, kind="stable")
    quarter = rank * HARMONISE_BLOCKS_PER_AXIS // len(positions)
    return np.asarray(quarter[:, 0] * HARMONISE_BLOCKS_PER_AXIS + quarter[:, 1], np.int64)


def average_cells(maps: TextureMaps, progress: Progress | None = None) -> Cells:
    """The cells of texture maps.

    Averages, since single texels differ from camera to camera by what calibration and proxy are off.
    """
    atlas = maps.atlas
    most = min(HARMONISE_MAX_CELLS, max(HARMONISE_MAX_NUMBERS // maps.count, 64))
    side = max(1, int(np.ceil(np.sqrt(atlas.width * atlas.height / most))))
    row, column = np.divmod(atlas.texel, atlas.width)
    _, cell = np.unique((row // side) * atlas.width + column // side, return_inverse=True)
    texels = np.bincount(cell)
    shape = (maps.count, len(texels), maps.channels)
    values, weights = np.zeros(shape), np.zeros(shape)

    def average(index: int) -> None:
        seen = maps.seen[index] > 0
        part = cell[seen]
        number = np.bincount(part, minlength=len(texels))
        enough = number >= HARMONISE_MIN_CELL_FRACTION * texels
        for channel in range(maps.channels):
            shown = maps.values[index, :, channel][seen]
            ends = np.bincount(part, (shown <= HARMONISE_DARK) | (shown >= HARMONISE_BRIGHT), len(texels))
            usable = enough & (ends == 0)
            values[index, :, channel] = np.bincount(part, shown, len(texels)) / np.maximum(number, 1)
            weights[index, :, channel] = np.where(usable, texels / side**2, 0)

    tracked_map(average, range(maps.count), "colours", progress)
    place = np.stack([np.bincount(cell, atlas.position[:, axis], len(texels)) for axis in range(3)], axis=1)
    return Cells(values, weights, _blocks(place / texels[:, None]))
