"""What is told of a proxy."""

from __future__ import annotations

import numpy as np

from eigenfield.core.mesh import Mesh
from eigenfield.proxy.surface.trim import SurfaceError
from eigenfield.reconstruction.report import measure_proxy
from support.surfaces import looking, square


def with_uv(half, side):
    """A square at z = 0 that fills `side` of the atlas along both axes."""
    mesh = square(half, 0.0, 5)
    return Mesh(mesh.vertices, mesh.faces, (mesh.vertices[:, :2] / half * side / 2 + side / 2).astype(np.float32))


def test_a_report_tells_what_was_measured():
    ahead = looking(np.array([0, 0, -5.0]), (0, 0, 0), focal=120.0, width=120, height=120)  # sees 5 by 5
    aside = looking(np.array([1.25, 0, -5.0]), (1.25, 0, 0), focal=120.0, width=120, height=120)
    error = SurfaceError(0.01, 0.0005, 0.5, 1.25)
    report = measure_proxy(with_uv(2.5, 0.5), [ahead, aside], error)
    assert report.triangles == 32
    assert np.allclose(report.coverage, [1, 0.75], atol=0.01)
    assert np.isclose(report.atlas.fill, 0.25, atol=0.002) and report.atlas.overlap == 0
    assert np.isclose(report.atlas.stretch, 1, atol=1e-3) and np.isclose(report.atlas.anisotropy, 1, atol=1e-3)
    lines = report.lines(["ahead.png", "aside.png"])
    assert lines[0] == "  32 triangles, coverage 87.5%, least 75.0% in aside.png"
    assert "0.050 % of the scene, 0.50 px (95 % under 1.25 px)" in lines[1]
    assert "fill 25.0%" in lines[2] and "overlap 0.00%" in lines[2] and "stretch 1.000" in lines[2]


def test_full_coverage_and_no_simplification_are_told_shortly():
    camera = looking(np.array([0, 0, -5.0]), (0, 0, 0), width=40, height=40)
    lines = measure_proxy(with_uv(2.5, 1.0), [camera], None).lines(["one.png"])
    assert lines[0] == "  32 triangles, coverage 100.0%" and len(lines) == 2
