"""Colour harmonisation: what exposure and white balance did to each photograph is taken out of its texture map.

The model, for each channel on its own: observation c, of the camera c where there is one time, shows the point x of the
surface as

    T(c, x) = (M(x) - o(c)) / g(c) + noise,    hence    g(c) T(c, x) + o(c) = M(x) up to noise,

with one mean map M for all observations, as in the compensation of exposures for panoramas (Brown and Lowe, IJCV 2007).
The noise stands on the photograph's side: fitted the other way round, noise in T would pull every gain towards 0.

An exposure changes the whole picture alike; a gloss that comes and goes with the viewpoint does not, and taking the
average of it for an exposure would only spoil the maps. So the fit also looks at how far the blocks of the surface
depart from it, each on its own, and colours are believed only as far as they explain more than that (`_belief`).

A resampling filter sums to 1, so gain and offset pass through it: a harmonised map is the map of the harmonised
photograph, and no photograph is decoded twice.
"""

from __future__ import annotations

import logging

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from eigenfield.core.progress import Progress, track
from eigenfield.encoding.projected.project import TextureMaps
from eigenfield.runtime.parallel import parallel_map, parallel_stream

log = logging.getLogger("eigenfield.texturing")

DARK = 16 / 255  # up to here stray light, clipping and noise are as large as what a gain would change
BRIGHT = 253 / 255  # from here on a photograph says no more than "bright"
CELLS = 4096  # of the atlas, at most, that the fit looks at
NUMBERS = 4_000_000  # camera x cell, at most
WHOLE = 0.9  # of a cell's texels that a camera must see
ROUNDS = 30
CLOSE = 1e-4  # a round that moves no gain further is the last
CAUCHY = 2.385  # residuals of this many standard deviations count half
LEAST_NOISE = 1 / 255
PRIOR_GAIN, PRIOR_OFFSET = 0.1, 0.03  # standard deviations round (1, 0), and
PRIOR_CELLS = 25  # how many residuals of average size the prior weighs as much as
LARGEST_GAIN = 4.0
BLOCKS = 4  # of the surface along each of its two longest axes, and
ALONE = 4  # how many of all of them a gloss changes independently of each other
FEWEST = 8  # cells that a camera must share with others


def harmonise_maps(maps: TextureMaps, model: str = "gain", progress: Progress | None = None) -> NDArray[np.float32]:
    """Fit the cameras' colours to their common mean and change all maps in place; the values are not cut to 0..1.

    model: "gain", or "affine" for gain and offset. Returns (No, 2, C) float32, gains then offsets: the maps become
    gain * T + offset. In each channel the gains have the geometric mean 1 and the offsets the mean 0 over the cameras
    that have something in common with others; the rest keep (1, 0), with a warning. Texels at either end of the range
    do not count.
    """
    values, weights, blocks = _cells(maps, progress)
    channels = range(maps.channels)
    with threadpool_limits(1, "blas"):
        fits = parallel_map(lambda c: fit_colours(values[..., c], weights[..., c], blocks, model), channels)
    colours = np.stack(fits, axis=2).astype(np.float32)
    left = maps.count - int(np.any([_sharing(weights[..., c]) for c in channels], axis=0).sum())
    if left:
        log.warning("%d of %d cameras share too little with others: their colours stay", left, maps.count)
    gains = colours[:, 0]
    log.info("harmonised: gains %.3f to %.3f", gains.min(), gains.max())

    def change(index: int) -> None:
        maps.values[index] = harmonised(maps.values[index], maps.seen[index], colours[index])

    for _ in track(parallel_stream(change, range(maps.count)), "harmonise", maps.count, progress):
        pass
    return colours


def harmonised(
    values: NDArray[np.float32], seen: NDArray[np.uint8], colour: NDArray[np.float32]
) -> NDArray[np.float32]:
    """One camera's (n, C) map with its gain and offset, (2, C), applied where it sees; zero elsewhere."""
    result: NDArray[np.float32] = np.where(seen[:, None] > 0, values * colour[0] + colour[1], np.float32(0))
    return result


def fit_colours(
    values: NDArray[np.float64], weights: NDArray[np.float64], blocks: NDArray[np.int64], model: str = "gain"
) -> NDArray[np.float64]:
    """(No, 2) gains and offsets of one channel.

    values: (No, m), what each camera shows of m places. weights: (No, m), 0 where that does not count.
    blocks: (m,) in which part of the surface each place lies.

    Iteratively reweighted least squares (Cauchy's weights) of T - a M - b with a = 1 / g, b = -o / g. Each round is a
    Gauss-Newton step in all a and b at once, the map M eliminated by its Schur complement: alternating between map and
    cameras needs very many rounds where each camera overlaps only its neighbours. A weak prior holds what the maps do
    not say at a = 1, b = 0.
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
    for count in range(ROUNDS):
        residual = T - a[:, None] * M - b[:, None]
        noise = max(1.4826 * float(np.median(np.abs(residual[base > 0]))), LEAST_NOISE)
        w = base / (1 + (residual / (CAUCHY * noise)) ** 2) if count else base
        M = _map(T, w, a, b)
        step_a, step_b = _step(T - a[:, None] * M - b[:, None], w, a, b, M, PRIOR_CELLS * noise**2, model == "affine")
        before = 1 / a
        a = np.clip(a + step_a, 1 / LARGEST_GAIN, LARGEST_GAIN)
        b = b + step_b
        a = a / np.exp(np.log(a).mean())
        b = b - a * (b / a).mean()
        M = _map(T, w, a, b)
        if count and np.abs(1 / a - before).max() < CLOSE:
            break
    belief = _belief(T, w, a, b, M, blocks)
    result[active] = np.stack([a**-belief, -belief * b / a], axis=1)
    return result


def _belief(
    T: NDArray[np.float64],
    w: NDArray[np.float64],
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    M: NDArray[np.float64],
    blocks: NDArray[np.int64],
) -> float:
    """From 0 to 1, max(0, 1 - V / (ALONE E)): the positive part of James and Stein's factor.

    E: squares of what the colours change, Σ w (a M + b - M)². V: what gains of each block's own would change on top of
    that, Σ over cameras and blocks of (Σ w r M)² / Σ w M², with the residuals r. Were V all there is, the average
    over blocks would make E = V / ALONE of it.
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
    return max(0.0, 1 - apart / (ALONE * explained)) if explained > 0 else 0.0


def _sharing(weights: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(No,) cameras with enough places that some other such camera shows too."""
    active = np.ones(len(weights), bool)
    while True:
        counts = weights > 0
        common = counts[active].sum(axis=0) >= 2
        kept = active & ((counts & common).sum(axis=1) >= FEWEST)
        if (kept == active).all():
            return active
        active = kept


def _map(
    T: NDArray[np.float64], w: NDArray[np.float64], a: NDArray[np.float64], b: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(m,) the best M for given a and b."""
    above = (w * a[:, None] * (T - b[:, None])).sum(axis=0)
    below = (w * a[:, None] ** 2).sum(axis=0)
    return np.divide(above, below, out=np.zeros_like(above), where=below > 0)


def _step(
    residual: NDArray[np.float64],
    w: NDArray[np.float64],
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    M: NDArray[np.float64],
    prior: float,
    affine: bool,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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
    strength = [prior / PRIOR_GAIN**2, prior / PRIOR_OFFSET**2]
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


def _blocks(positions: NDArray[np.float64]) -> NDArray[np.int64]:
    """(m,) the block of each of (m, 3) positions: as many in each quarter along the longest axis, and across it."""
    centred = positions - positions.mean(axis=0)
    axes = np.linalg.eigh(centred.T @ centred)[1][:, :0:-1]
    rank = np.argsort(np.argsort(centred @ axes, axis=0, kind="stable"), axis=0, kind="stable")
    quarter = rank * BLOCKS // len(positions)
    return np.asarray(quarter[:, 0] * BLOCKS + quarter[:, 1], np.int64)


def _cells(
    maps: TextureMaps, progress: Progress | None
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """(No, m, C) averages over square cells of the atlas and (No, m, C) how much each counts: the part of the cell that
    charts cover where the camera sees the cell and no texel of it is at an end of the range, else 0. (m,) the block of
    the surface in which the cell lies.

    Averages, since single texels differ from camera to camera by what calibration and proxy are off.
    """
    atlas = maps.atlas
    most = min(CELLS, max(NUMBERS // maps.count, 64))
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
        enough = number >= WHOLE * texels
        for channel in range(maps.channels):
            shown = maps.values[index, :, channel][seen]
            ends = np.bincount(part, (shown <= DARK) | (shown >= BRIGHT), len(texels))
            usable = enough & (ends == 0)
            values[index, :, channel] = np.bincount(part, shown, len(texels)) / np.maximum(number, 1)
            weights[index, :, channel] = np.where(usable, texels / side**2, 0)

    for _ in track(parallel_stream(average, range(maps.count)), "colours", maps.count, progress):
        pass
    place = np.stack([np.bincount(cell, atlas.position[:, axis], len(texels)) for axis in range(3)], axis=1)
    return values, weights, _blocks(place / texels[:, None])
