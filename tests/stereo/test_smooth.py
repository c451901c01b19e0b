"""The plane fits that smooth depth, held against the sums as they are written down."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from eigenfield.runtime import parallel
from eigenfield.runtime.jit import kernel
from eigenfield.stereo.smooth import smooth_depth
from eigenfield.stereo.smooth_kernels import exponential, fit_planes
from eigenfield.stereo.sweep_kernels import _half_planes


@kernel()
def exponentials(x, out):
    for i in range(x.size):
        out[i] = exponential(x[i])


def test_the_exponential_is_one():
    x = -np.concatenate([[0.0], np.geomspace(1e-6, 80, 5000)]).astype(np.float32)
    out = np.empty_like(x)
    exponentials(x, out)
    assert (np.abs(out / np.exp(x.astype(np.float64)) - 1) < 2e-7 * (1 - x)).all() and out[0] == 1
    low = np.full(3, -1e6, np.float32)
    exponentials(low, low)
    assert (low < 1e-34).all()


def fitted(d, q, guide, y, x, radius, spacing, colour, depth, loose_colour, loose_depth):
    """The plane's height at one point, in float64."""
    relax = (1 - q[y, x]) ** 2
    c, s = colour + relax * loose_colour, depth + relax * loose_depth
    plane = np.zeros(3)
    for _ in range(2):
        rows, values, weights = [], [], []
        for v in range(-radius, radius + 1):
            for u in range(-radius, radius + 1):
                j, i = y + v * spacing, x + u * spacing
                if 0 <= j < d.shape[0] and 0 <= i < d.shape[1]:
                    e = float(d[j, i]) - float(d[y, x])
                    off = (e - plane @ [1, u, v]) / s
                    away = np.abs(guide[j, i] - guide[y, x]).sum() / c + (u * u + v * v) / radius**2
                    rows.append([1, u, v])
                    values.append(e)
                    weights.append(q[j, i] * np.exp(-away) / (1 + off**2) ** 2)
        A, e, w = np.array(rows, float), np.array(values), np.array(weights)
        mean = (w[:, None] * A).sum(axis=0) / w.sum()
        centred, level = A[:, 1:] - mean[1:], (w * e).sum() / w.sum()
        normal = (w[:, None] * centred).T @ centred
        normal += np.eye(2) * (1e-3 * (w[:, None] * A[:, 1:] ** 2).sum() + 1e-9)
        slope = np.linalg.solve(normal, (w[:, None] * centred).T @ (e - level))
        plane = np.array([level - slope @ mean[1:], *slope])
    return d[y, x] + plane[0] * ((1 - q[y, x]) if spacing > 2 else 1)


@pytest.fixture(scope="module")
def noisy():
    """d, q and guide, wider than one run of points."""
    random = np.random.default_rng(0)
    d = cv2.GaussianBlur(random.normal(0, 4, (40, 150)).astype(np.float32), (0, 0), 3)
    guide = cv2.GaussianBlur(random.uniform(0, 255, (40, 150, 3)).astype(np.float32), (0, 0), 2)
    return d, random.uniform(0.01, 1, d.shape).astype(np.float32), guide


@pytest.mark.parametrize("spacing", [1, 4])
def test_planes_are_least_squares(noisy, spacing):
    d, q, guide = noisy
    scales = (60.0, 0.12, 60.0, 0.5)
    out = np.empty_like(d)
    planes = np.ascontiguousarray(np.moveaxis(guide, 2, 0))
    fit_planes(0, 40, d, q, planes, 3, spacing, *(np.float32(scale) for scale in scales), out)
    for y, x in [(0, 0), (5, 127), (20, 128), (39, 149), (17, 60), (2, 140)]:  # borders, and the seam of two runs
        assert np.isclose(out[y, x], fitted(d, q, guide, y, x, 3, spacing, *scales), atol=2e-5)


def test_a_plane_stays_and_threads_do_not_matter(noisy):
    _, q, guide = noisy
    y, x = np.mgrid[:40, :150].astype(np.float32)
    plane = 0.05 * x - 0.03 * y + 2
    assert np.abs(smooth_depth(plane, 300 * q, np.full_like(guide, 90)) - plane).max() < 0.01
    try:
        parallel.set_threads(1)
        one = smooth_depth(noisy[0], 300 * q, guide)
        parallel.set_threads(3)
        assert np.array_equal(smooth_depth(noisy[0], 300 * q, guide), one)
    finally:
        parallel.set_threads(None)


def test_half_planes_that_hold_the_same_views_are_looked_at_once():
    best = np.float32(0.4)
    assert _half_planes(np.array([2, 2, 2]), 8, best).tolist() == [[0, 4]]  # all views on one side
    both = _half_planes(np.array([0, 4]), 8, best)
    assert len(both) == 2 and (both[:, 1] == 4).all()
    assert len(_half_planes(np.arange(8), 8, best)) == 8
    assert len(_half_planes(np.array([-1, -1]), 8, best)) == 0
    assert _half_planes(np.arange(8), 8, np.float32(1)).tolist() == [[0, 8]]
