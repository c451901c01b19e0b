"""Inner loops of the demo: noise, and the shading of one view."""

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


@kernel()
def shade_view(
    face: NDArray[np.int32],
    maps: NDArray[np.float64],
    rays: NDArray[np.float64],
    surface: NDArray[np.float32],
    environment: NDArray[np.float32],
    samples: int,
    picture: NDArray[np.float32],
) -> None:
    """Shade one view in linear light, averaged over samples x samples points a pixel.

    Reflection: r = d - 2 (d.n) n; Schlick's F = F0 + (F90 - F0)(1 - cos)^5 with F90 = min(1, 12 F0), so that a
    reflectance of 0 gives none.

    Args:
        face: (s H, s W) from the rasteriser at s times the size.
        maps: (m, 3, 3) from its pixels (x, y, 1) to homogeneous texels, one for each triangle.
        rays: (3, 3) world direction of (x, y, 1), by columns.
        surface: (h, w, 8) diffuse radiance (3), world normal (3), reflectance at normal incidence, roughness 0..1.
        environment: (2, e, e, 3) radiance over the octahedron, smooth and rough.
        samples: s.
        picture: (H, W, 3), written.
    """
    height, width = surface.shape[0], surface.shape[1]
    side = environment.shape[1]
    share = np.float32(1.0 / (samples * samples))
    one = np.float32(1)
    value, total = np.empty(8, np.float32), np.empty(3, np.float32)
    for row in range(picture.shape[0]):
        for column in range(picture.shape[1]):
            total[:] = 0
            for sample in range(samples * samples):
                i = row * samples + sample // samples
                j = column * samples + sample % samples
                f = face[i, j]
                if f < 0:
                    continue
                x, y = j + 0.5, i + 0.5
                m = maps[f]
                q = 1.0 / (m[2, 0] * x + m[2, 1] * y + m[2, 2])
                s = (m[0, 0] * x + m[0, 1] * y + m[0, 2]) * q - 0.5
                t = (m[1, 0] * x + m[1, 1] * y + m[1, 2]) * q - 0.5
                s = min(max(s, 0.0), width - 1.001)
                t = min(max(t, 0.0), height - 1.001)
                u, v = int(s), int(t)
                fs, ft = np.float32(s - u), np.float32(t - v)
                w00, w01 = (one - fs) * (one - ft), fs * (one - ft)
                w10, w11 = (one - fs) * ft, fs * ft
                upper, lower = surface[v], surface[v + 1]
                for c in range(8):
                    value[c] = w00 * upper[u, c] + w01 * upper[u + 1, c] + w10 * lower[u, c] + w11 * lower[u + 1, c]
                dx = np.float32(rays[0, 0] * x + rays[0, 1] * y + rays[0, 2])
                dy = np.float32(rays[1, 0] * x + rays[1, 1] * y + rays[1, 2])
                dz = np.float32(rays[2, 0] * x + rays[2, 1] * y + rays[2, 2])
                nx, ny, nz = value[3], value[4], value[5]
                scale = one / np.sqrt((nx * nx + ny * ny + nz * nz) * (dx * dx + dy * dy + dz * dz))
                cosine = -(dx * nx + dy * ny + dz * nz)
                twice = np.float32(2) * cosine / (nx * nx + ny * ny + nz * nz)
                rx, ry, rz = dx + twice * nx, dy + twice * ny, dz + twice * nz
                graze = one - min(max(cosine * scale, np.float32(0)), one)
                square = graze * graze
                fresnel = value[6] + (min(one, np.float32(12) * value[6]) - value[6]) * square * square * graze
                # octahedral map: the sphere onto |x| + |y| + |z| = 1, the lower half folded outwards
                shrink = one / (abs(rx) + abs(ry) + abs(rz))
                ox, oz = rx * shrink, rz * shrink
                if ry < 0:
                    fold = (one - abs(oz)) if ox >= 0 else abs(oz) - one
                    oz = (one - abs(ox)) if oz >= 0 else abs(ox) - one
                    ox = fold
                s = (ox * np.float32(0.5) + np.float32(0.5)) * (side - 1)
                t = (oz * np.float32(0.5) + np.float32(0.5)) * (side - 1)
                u, v = min(int(s), side - 2), min(int(t), side - 2)
                fs, ft = np.float32(s - u), np.float32(t - v)
                w00, w01 = (one - fs) * (one - ft), fs * (one - ft)
                w10, w11 = (one - fs) * ft, fs * ft
                for layer in range(2):
                    weight = fresnel * (value[7] if layer == 1 else one - value[7])
                    if weight > np.float32(1e-4):
                        e = environment[layer]
                        upper, lower = e[v], e[v + 1]
                        for c in range(3):
                            total[c] += weight * (
                                w00 * upper[u, c] + w01 * upper[u + 1, c] + w10 * lower[u, c] + w11 * lower[u + 1, c]
                            )
                for c in range(3):
                    total[c] += value[c]
            for c in range(3):
                picture[row, column, c] = total[c] * share
