"""Matches of descriptors, with and without epipolar lines."""

from __future__ import annotations

import numpy as np

from eigenfield.calibration.motion.matching import (
    MATCHING_GUIDED_LINE_PIXELS,
    MATCHING_GUIDED_MAX_ANGLE_RATIO,
    MATCHING_MAX_ANGLE_RADIANS,
    MATCHING_MAX_ANGLE_RATIO,
    mutual_matches,
)

F = np.array([[0.0, -1e-4, 0.02], [1e-4, 0.0, -0.05], [-0.02, 0.05, 0.3]])


def root_normalised(random, count):
    share = random.random((count, 128)) ** 4
    return np.rint(512 * np.sqrt(share / share.sum(axis=1, keepdims=True))).clip(0, 255).astype(np.uint8)


def brute_force(left, right, ratio, allowed):
    """As the docstring says, one feature at a time."""
    inner = np.where(allowed, left.astype(float) @ right.astype(float).T, -1)
    found = []
    for i, row in enumerate(inner):
        second, best = np.arccos(np.clip(np.sort(row)[-2:] / 512**2, 0, 1))
        j = int(row.argmax())
        if row[j] >= 0 and best <= min(MATCHING_MAX_ANGLE_RADIANS, ratio * second) and inner[:, j].argmax() == i:
            found.append((i, j))
    return found


def test_matches_are_those_of_all_comparisons_one_by_one():
    random = np.random.default_rng(0)
    right = root_normalised(random, 200)
    left = np.concatenate([right[:90], root_normalised(random, 70)])
    left[:, :20] //= 2
    points1, points2 = random.uniform(0, 300, (160, 2)), random.uniform(0, 300, (200, 2))
    everywhere = np.ones((160, 200), bool)
    found = mutual_matches(left, right)
    assert found.tolist() == [list(pair) for pair in brute_force(left, right, MATCHING_MAX_ANGLE_RATIO, everywhere)]
    assert len(found) > 50
    one, two = (np.column_stack([points, np.ones(len(points))]) for points in (points1, points2))
    lines, back = one @ F.T, two @ F
    away = np.abs(np.einsum("ik,jk->ij", lines, two))
    near = MATCHING_GUIDED_LINE_PIXELS * np.minimum(
        np.linalg.norm(lines[:, None, :2], axis=2), np.linalg.norm(back[None, :, :2], axis=2)
    )
    guided = mutual_matches(left, right, (points1, points2, F))
    expected = brute_force(left, right, MATCHING_GUIDED_MAX_ANGLE_RATIO, away <= near)
    assert guided.tolist() == [list(pair) for pair in expected]
    assert 0 < len(guided) < len(found)
