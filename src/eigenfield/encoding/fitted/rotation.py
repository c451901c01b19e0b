"""Components rotated so that their textures take few bytes, where a texel is seen by few of the photographs.

Principal components of cameras all around mix what far cameras see: a texel that k of N photographs determine has k
degrees of freedom, and N components to spread them over. A rotation of the components draws the same pictures, keeps
weights of variance 1 and textures that one quantiser step serves, and can bring a texel's energy into few of them.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dctn

from eigenfield.encoding.fitted.model import Block
from eigenfield.encoding.fitted.products import combine, one_blas_thread
from eigenfield.encoding.fitted.rotation_kernels import rotated_cost
from eigenfield.runtime.parallel import parallel_map

ROTATION_BLOCK_TEXELS = 8  # side of the blocks whose cosine transform stands for what is coded
ROTATION_MAX_BLOCKS = 2000  # evenly spread over those that hold anything
ROTATION_SWEEPS = 3  # over all pairs of components
ROTATION_ANGLES = np.pi / 8 * np.arange(-1, 3)  # all that a pair may turn, up to order and sign
ROTATION_HALVINGS = 3  # of the angles' distance, around the best


@one_blas_thread
def rotate_components(block: Block, step: float) -> Block:
    """The block with components rotated for the fewest bits, the strongest first.

    The bits of a coefficient x are about log2(1 + (x / step)^2) / 2. Pairs of components are turned one after the
    other (Jacobi), pairs without a common component side by side.

    Args:
        block: Its weights have variance 1.
        step: Of the quantiser of its textures.
    """
    if block.count < 2:
        return block
    values = _coefficients(block.textures) / np.float32(step)
    rotation = np.eye(block.count, dtype=np.float32)

    def turn(pair: tuple[int, int]) -> None:
        rows = list(pair)
        angle = _best_angle(*values[rows])
        turned = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]], np.float32)
        values[rows], rotation[rows] = turned @ values[rows], turned @ rotation[rows]

    for _ in range(ROTATION_SWEEPS):
        for pairs in _disjoint_pairs(block.count):
            parallel_map(turn, pairs)
    flat = block.textures.reshape(block.count, -1)
    textures = np.empty_like(flat)
    combine(rotation, flat, textures)
    order = np.argsort(-np.einsum("nt,nt->n", textures, textures, dtype=np.float64), kind="stable")
    signs = np.where(-textures.min(axis=1) > textures.max(axis=1), -1, 1).astype(np.float32)[order]
    textures = textures[order] * signs[:, None]
    weights = np.ascontiguousarray((block.weights @ rotation.T)[:, order] * signs)
    return replace(block, textures=textures.reshape(block.textures.shape), weights=weights)


def _coefficients(textures: NDArray[np.float32]) -> NDArray[np.float32]:
    """(n, m) of the cosine transforms of some blocks of textures (n, C, h, w)."""
    (count, channels), side = textures.shape[:2], ROTATION_BLOCK_TEXELS
    rows, columns = (length // side for length in textures.shape[2:])
    whole = textures[:, :, : rows * side, : columns * side].reshape(count, channels, rows, side, columns, side)
    held = np.argwhere(whole.any(axis=(0, 3, 5)))
    channel, row, column = held[:: max(1, -(-len(held) // ROTATION_MAX_BLOCKS))].T
    found = dctn(whole.transpose(0, 1, 2, 4, 3, 5)[:, channel, row, column], axes=(2, 3), norm="ortho")
    return np.ascontiguousarray(found.reshape(count, len(row) * side * side), np.float32)


def _best_angle(first: NDArray[np.float32], second: NDArray[np.float32]) -> float:
    """By which two components are turned, in -pi / 8 to pi / 4 and a little beyond."""
    costs = {float(angle): rotated_cost(first, second, np.cos(angle), np.sin(angle)) for angle in ROTATION_ANGLES}
    apart = float(ROTATION_ANGLES[1] - ROTATION_ANGLES[0])
    for _ in range(ROTATION_HALVINGS):
        best, apart = min(costs, key=costs.__getitem__), apart / 2
        for angle in (best - apart, best + apart):
            costs[angle] = rotated_cost(first, second, np.cos(angle), np.sin(angle))
    return min(costs, key=costs.__getitem__)


def _disjoint_pairs(count: int) -> list[list[tuple[int, int]]]:
    """All pairs of `count` numbers, in rounds in which each number comes at most once (a round-robin tournament)."""
    players = [*range(count), *([-1] * (count % 2))]
    rounds = []
    for _ in range(len(players) - 1):
        half = len(players) // 2
        met = zip(players[:half], reversed(players[half:]), strict=True)
        rounds.append([(min(pair), max(pair)) for pair in met if -1 not in pair])
        players = [players[0], players[-1], *players[1:-1]]
    return rounds
