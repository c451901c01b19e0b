"""Value noise, compiled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.jit import kernel


@kernel(inline=True)
def _hash_noise(x: int, y: int, z: int, seed: int) -> float:
    """A number in [-1, 1) for an integer point: multiply-and-shift hashing on 32 bits."""
    h = (x * 374761393 + y * 668265263 + z * 1274126177 + seed * 974634777) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1103515245) & 0xFFFFFFFF
    h = ((h ^ (h >> 16)) * 747796405) & 0xFFFFFFFF
    return ((h ^ (h >> 15)) & 0xFFFFFF) / 8388608.0 - 1.0


@kernel()
def value_noise(x: float, y: float, z: float, seed: int) -> float:
    """Value noise in [-1, 1]: lattice values, blended by 6 t^5 - 15 t^4 + 10 t^3 (Perlin, 2002).

    Args:
        x, y, z: The point.
        seed: Of the lattice.
    """
    i, j, k = int(np.floor(x)), int(np.floor(y)), int(np.floor(z))
    a, b, c = x - i, y - j, z - k
    a = a * a * a * (a * (a * 6.0 - 15.0) + 10.0)
    b = b * b * b * (b * (b * 6.0 - 15.0) + 10.0)
    c = c * c * c * (c * (c * 6.0 - 15.0) + 10.0)
    total = 0.0
    for dk in range(2):
        wk = c if dk == 1 else 1.0 - c
        for dj in range(2):
            wj = b if dj == 1 else 1.0 - b
            low = _hash_noise(i, j + dj, k + dk, seed)
            high = _hash_noise(i + 1, j + dj, k + dk, seed)
            total += wk * wj * (low + a * (high - low))
    return total


@kernel()
def fractal_noise(
    points: NDArray[np.float64], frequency: float, octaves: int, gain: float, seed: int, out: NDArray[np.float64]
) -> None:
    """The sum over octaves o of gain^o noise(2^o frequency p), over the sum of gain^o.

    Args:
        points: (n, 3).
        frequency: Of the first octave.
        octaves: How many.
        gain: Amplitude of each octave relative to the one before.
        seed: Of the first octave.
        out: (n,), written.
    """
    for n in range(points.shape[0]):
        total, weight, scale, mass = 0.0, 1.0, frequency, 0.0
        for octave in range(octaves):
            total += weight * value_noise(
                points[n, 0] * scale, points[n, 1] * scale, points[n, 2] * scale, seed + octave
            )
            mass += weight
            weight *= gain
            scale *= 2.0
        out[n] = total / mass
