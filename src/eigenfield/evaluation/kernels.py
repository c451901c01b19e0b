"""The inner loop of equation 8 on a whole atlas."""

from __future__ import annotations

from eigenfield.runtime.jit import kernel


@kernel()
def add_textures(total, stored, factor, offset):  # type: ignore[no-untyped-def]
    """total[i] += Σ_j factor[j, k] stored[j, i] - offset[k] with k = i modulo the period, for flat pictures.

    The period is a multiple of the channels: a long one lets the inner loop run over many texels at once.

    Args:
        total: (n,) float32, added to.
        stored: (m, n) of any type.
        factor: (m, period) float32.
        offset: (period,) float32.
    """
    size, period = total.shape[0], offset.shape[0]
    for start in range(0, size, period):
        length = min(period, size - start)
        part = total[start : start + length]
        for k in range(length):
            part[k] -= offset[k]
        for j in range(stored.shape[0]):
            texture = stored[j, start : start + length]
            scale = factor[j]
            for k in range(length):
                part[k] += scale[k] * texture[k]
