"""Small charts join their neighbours: what is sewn, what stays apart."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.core.mesh import Mesh
from eigenfield.imaging.graph import edge_components
from eigenfield.proxy import atlas_statistics, unwrap_mesh
from eigenfield.proxy.atlas import lscm_charts
from eigenfield.proxy.atlas.chart_merging import Chart, merge_charts, shared_edges
from support.surfaces import ball, square

SIDE = 20
FLAT = square(1.0, 0.0, SIDE + 1)


def cut(mesh: Mesh, label: np.ndarray) -> tuple[Mesh, list[Chart]]:
    """The mesh with its vertices doubled where triangles of different label meet, and the charts."""
    ends = np.stack([mesh.faces.reshape(-1), np.repeat(label, 3)], axis=1)
    kept, index = np.unique(ends, axis=0, return_inverse=True)
    apart = Mesh(mesh.vertices[kept[:, 0]], index.reshape(-1, 3).astype(np.int32))
    charts = []
    for one in np.unique(label):
        faces = np.flatnonzero(label == one)
        used, corners = np.unique(apart.faces[faces], return_inverse=True)
        corners = corners.reshape(-1, 3).astype(np.int32)
        flat = apart.vertices[used, :2].astype(np.float64)
        charts.append(Chart(faces, used, corners, flat - flat.min(axis=0), False))
    return apart, charts


def plan(points, corners):
    """Seen from above: for what is flat, nothing overlaps."""
    return points[:, :2].copy()


def check(mesh: Mesh, charts: list[Chart]) -> None:
    """Every triangle is in one chart, its corners where they were, its layout what `plan` says."""
    np.testing.assert_array_equal(np.sort(np.concatenate([c.faces for c in charts])), np.arange(len(mesh.faces)))
    for chart in charts:
        places = mesh.vertices[chart.vertices]
        np.testing.assert_array_equal(places[chart.corners], mesh.vertices[mesh.faces[chart.faces]])
        np.testing.assert_allclose(chart.uv, places[:, :2] - places[:, :2].min(axis=0), atol=1e-6)
        assert len(np.unique(edge_components(chart.corners))) == 1


def test_single_triangles_join_the_chart_around_them_and_are_sewn_all_round():
    label = np.zeros(len(FLAT.faces), np.int64)
    label[[100, 301, 302, 555]] = 1, 2, 3, 4
    mesh, charts = cut(FLAT, label)
    (whole,) = merge_charts(mesh, charts, plan)
    check(mesh, [whole])
    assert len(whole.vertices) == len(FLAT.vertices)  # nothing is doubled any more


def test_small_ones_that_only_touch_each_other_arrive_in_rounds():
    label = np.arange(len(FLAT.faces))  # every triangle by itself but for one half
    label[: len(label) // 2] = 0
    mesh, charts = cut(FLAT, label)
    merged = merge_charts(mesh, charts, plan)
    check(mesh, merged)
    assert len(merged) < len(charts) / 20
    assert max(len(chart.faces) for chart in merged) > len(label) / 2


def test_large_charts_stay_apart_and_the_order_of_charts_is_kept():
    column = FLAT.vertices[FLAT.faces].mean(axis=1)[:, 0]
    label = np.digitize(column, [-0.5, 0, 0.5])
    mesh, charts = cut(FLAT, label)
    merged = merge_charts(mesh, charts, plan)
    assert [len(chart.faces) for chart in merged] == [len(chart.faces) for chart in charts]
    for one, other in zip(merged, charts, strict=True):
        assert one is other


def test_what_cannot_be_laid_out_with_it_stays_and_the_others_still_join():
    label = np.zeros(len(FLAT.faces), np.int64)
    label[[100, 301, 555, 700]] = 1, 2, 3, 4
    mesh, charts = cut(FLAT, label)
    bad = FLAT.vertices[FLAT.faces[301]].astype(np.float64)

    def layout(points, corners):
        has = (np.abs(points[corners] - bad).max(axis=(1, 2)) == 0).any()
        return None if has else plan(points, corners)

    merged = merge_charts(mesh, charts, layout)
    check(mesh, merged)
    assert sorted(len(chart.faces) for chart in merged) == [1, len(FLAT.faces) - 1]


def test_seams_within_a_chart_stay_cut():
    """A chart may go round and meet itself: its own seam is no place to sew, or it could not be laid out flat."""
    label = np.zeros(len(FLAT.faces), np.int64)
    label[777] = 1
    mesh, charts = cut(FLAT, label)
    seam = int(np.flatnonzero((mesh.vertices == mesh.vertices[charts[0].vertices[210]]).all(axis=1))[0])
    doubled = Mesh(np.concatenate([mesh.vertices, mesh.vertices[seam : seam + 1]]), mesh.faces.copy())
    at = np.argwhere(doubled.faces == seam)[0]
    doubled.faces[tuple(at)] = len(mesh.vertices)
    label = np.where(np.arange(len(label)) == 777, 1, 0)
    charts = []
    for one in (0, 1):
        faces = np.flatnonzero(label == one)
        used, corners = np.unique(doubled.faces[faces], return_inverse=True)
        charts.append(Chart(faces, used, corners.reshape(-1, 3).astype(np.int32), doubled.vertices[used, :2], False))
    (whole,) = merge_charts(doubled, charts, plan)
    assert len(whole.vertices) == len(FLAT.vertices) + 1


def test_shared_edges_run_opposite_ways_once_each():
    borders = shared_edges(FLAT.vertices, FLAT.faces)
    assert len(borders.length) == 3 * SIDE * SIDE - 2 * SIDE  # all edges but the rim's
    corner = np.take_along_axis(FLAT.faces[borders.face], borders.corner[..., None], axis=2)[..., 0]
    behind = np.take_along_axis(FLAT.faces[borders.face], (borders.corner[..., None] + 1) % 3, axis=2)[..., 0]
    np.testing.assert_array_equal(corner[:, 0], behind[:, 1])
    np.testing.assert_array_equal(corner[:, 1], behind[:, 0])
    ends = FLAT.vertices[np.stack([corner[:, 0], behind[:, 0]], axis=1)].astype(np.float64)
    np.testing.assert_allclose(borders.length, np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1))
    three = np.concatenate([FLAT.faces[:1], FLAT.faces[:1], FLAT.faces[:1]])
    assert len(shared_edges(FLAT.vertices, three).length) == 0  # an edge of three triangles is nobody's


@pytest.mark.slow
def test_a_noisy_ball_has_fewer_charts_than_xatlas_cuts(monkeypatch):
    smooth = ball(level=4)
    noise = np.random.default_rng(0).normal(size=(len(smooth.vertices), 1))
    rough = Mesh((smooth.vertices * (1 + 0.05 * noise)).astype(np.float32), smooth.faces)
    merged = unwrap_mesh(rough)
    monkeypatch.setattr(lscm_charts, "merge_charts", lambda mesh, charts, layout: charts)
    as_cut = unwrap_mesh(rough)
    ours, theirs = atlas_statistics(merged), atlas_statistics(as_cut)
    assert ours.charts < 0.6 * theirs.charts
    assert len(merged.vertices) < 0.95 * len(as_cut.vertices)
    assert ours.stretch < theirs.stretch + 0.02 and ours.overlap < 1e-4
