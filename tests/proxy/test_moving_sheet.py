"""The grid of a moving sheet: what it covers, and the labels that its vertices get."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.core.mesh import signed_areas
from eigenfield.proxy.relief.moving_sheet import sheet_grid

SHAPE = 61, 90
ROWS, COLUMNS = np.indices(SHAPE)
PLANE = (0.03 * COLUMNS - 0.02 * ROWS + 2).astype(np.float32)


def region(top, bottom, left, right):
    found = np.zeros(SHAPE, bool)
    found[top:bottom, left:right] = True
    return found


WITHIN = region(20, 45, 30, 60)


def at_vertices(grid):
    return 0.03 * grid.mesh.x - 0.02 * grid.mesh.y + 2


@pytest.mark.parametrize("where", [WITHIN, region(0, 61, 0, 90), region(57, 61, 84, 90)])
def test_a_grid_covers_the_region_and_its_shares_are_barycentric(where):
    grid = sheet_grid(where)
    assert where.ravel()[grid.pixels].sum() == where.sum()
    np.testing.assert_allclose(grid.shares.sum(axis=1), 1)
    assert grid.shares.min() >= 0
    x, y = (grid.shares @ own for own in (grid.mesh.x, grid.mesh.y))
    np.testing.assert_allclose(x, grid.pixels % SHAPE[1], atol=1e-9)
    np.testing.assert_allclose(y, grid.pixels // SHAPE[1], atol=1e-9)
    areas = signed_areas(np.stack([grid.mesh.x, grid.mesh.y], axis=1)[grid.mesh.faces])
    np.testing.assert_allclose(areas, areas[0])
    assert areas[0] > 0


def test_few_triangles_make_a_coarse_grid():
    assert len(sheet_grid(WITHIN, 60).mesh.faces) < 90 < len(sheet_grid(WITHIN).mesh.faces)


def test_a_plane_is_met_exactly_and_continued_beside_what_is_seen():
    grid, seen = sheet_grid(WITHIN), WITHIN.astype(np.float32)
    labels = grid.fit(PLANE, seen, at_vertices(grid))
    np.testing.assert_allclose(labels, at_vertices(grid), atol=0.1)
    assert np.abs(labels - at_vertices(grid)).mean() < 0.02
    found = grid.shares @ grid.fit(PLANE, seen, None)
    inside = WITHIN.ravel()[grid.pixels]
    assert np.abs(found - PLANE.ravel()[grid.pixels])[inside].mean() < 0.02


def test_vertices_far_from_what_is_seen_stay():
    grid = sheet_grid(region(10, 50, 5, 85))
    before = np.full(len(grid.mesh.x), 3.0)
    half = region(10, 50, 5, 30).astype(np.float32)
    labels = grid.fit(np.full(SHAPE, 1.0, np.float32), half, before)
    assert np.abs(labels - 3)[grid.mesh.x > 70].max() < 0.2
    seen = (grid.mesh.x > 4) & (grid.mesh.x < 28) & (grid.mesh.y > 8) & (grid.mesh.y < 50)
    assert np.abs(labels - 1)[seen].max() < 0.05
    nothing = grid.fit(np.full(SHAPE, 1.0, np.float32), np.zeros(SHAPE, np.float32), before)
    np.testing.assert_allclose(nothing, 3)
