"""Atlases: which are kept, what is made where there is none, and what is refused on the way."""

from __future__ import annotations

import logging
import os
import sys
import time

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError, ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.proxy import (
    PROXY_DEFAULT_TRIANGLES,
    atlas_fault,
    atlas_statistics,
    child,
    prepare_proxy,
    read_mesh,
    simplify_mesh,
    unwrap_mesh,
    write_ply,
)
from eigenfield.proxy.prepare import without_far_vertices


def grid(n, uv=True, height=0.0):
    """(n + 1)^2 vertices over the unit square, z up to `height`; UVs are x and y, shrunk by a margin."""
    y, x = np.mgrid[0 : n + 1, 0 : n + 1] / n
    z = height * np.sin(7 * x) * np.cos(5 * y)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1)
    faces = np.concatenate(
        [np.stack([corner, corner + 1, corner + n + 2], 1), np.stack([corner, corner + n + 2, corner + n + 1], 1)]
    )
    flat = np.stack([x, y], axis=-1).reshape(-1, 2)
    vertices = np.column_stack([flat, z.reshape(-1)]).astype(np.float32)
    return Mesh(vertices, faces.astype(np.int32), (0.1 + 0.8 * flat).astype(np.float32) if uv else None)


def with_uv(mesh, uv):
    return Mesh(mesh.vertices, mesh.faces, np.asarray(uv, np.float32))


def ball(detail=3):
    shape = trimesh.creation.icosphere(detail)
    return Mesh(shape.vertices.astype(np.float32), shape.faces.astype(np.int32))


def test_statistics_of_a_square_scaled_to_half():
    statistics = atlas_statistics(with_uv(grid(8), 0.25 + 0.5 * grid(8).vertices[:, :2]))
    assert statistics.charts == 1
    assert statistics.fill == pytest.approx(0.25, abs=1e-6)
    assert statistics.overlap == statistics.flat == 0
    assert statistics.stretch == pytest.approx(1, abs=1e-5)
    assert statistics.anisotropy == pytest.approx(1, abs=1e-5)


def test_statistics_of_a_map_that_is_squeezed_to_a_quarter():
    """Singular values 1 and 4 everywhere: sqrt((1 + 16) / 2) times sqrt(1 / 4), by Sander's formula."""
    statistics = atlas_statistics(with_uv(grid(8), grid(8).vertices[:, :2] * (1, 0.25)))
    assert statistics.anisotropy == pytest.approx(4, rel=1e-4)
    assert statistics.stretch == pytest.approx(np.sqrt(17 / 2) / 2, rel=1e-4)


def test_statistics_count_what_is_covered_twice():
    one = grid(6)
    uv = np.concatenate([one.uv * 0.5, one.uv * 0.5 + (0.2, 0.0)])
    faces = np.concatenate([one.faces, one.faces + len(one.vertices)]).astype(np.int32)
    statistics = atlas_statistics(Mesh(np.concatenate([one.vertices, one.vertices + 3]), faces, uv.astype(np.float32)))
    assert statistics.charts == 2
    assert statistics.overlap == pytest.approx(0.2 / 0.6, abs=0.02)  # 0.4 wide, shifted by 0.2
    assert statistics.fill == pytest.approx(0.6 * 0.4, abs=0.01)


@settings(max_examples=25)
@given(angle=st.floats(0, 6.3), size=st.floats(0.1, 0.6), flip=st.booleans())
def test_statistics_do_not_depend_on_turning_scaling_and_mirroring(angle, size, flip):
    mesh = grid(5, height=0.2)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) * (1, -1 if flip else 1)
    moved = atlas_statistics(with_uv(mesh, 0.5 + size * (mesh.uv - 0.5) @ turn.T))
    plain = atlas_statistics(mesh)
    assert moved.overlap == 0
    assert moved.stretch == pytest.approx(plain.stretch, rel=1e-3)
    assert moved.anisotropy == pytest.approx(plain.anisotropy, rel=1e-3)
    assert moved.fill == pytest.approx(plain.fill * size**2, rel=0.02)


def test_a_valid_atlas_is_kept_to_the_bit(caplog):
    mesh = grid(20)
    with caplog.at_level(logging.INFO, "eigenfield.proxy"):
        kept = unwrap_mesh(mesh)
    np.testing.assert_array_equal(kept.vertices, mesh.vertices)
    np.testing.assert_array_equal(kept.faces, mesh.faces)
    np.testing.assert_array_equal(kept.uv, mesh.uv)
    assert caplog.text == ""
    assert unwrap_mesh(mesh, triangles=800).uv is not None  # 800 triangles it has


def test_uvs_a_hair_outside_are_clipped():
    mesh = grid(4)
    kept = unwrap_mesh(with_uv(mesh, mesh.vertices[:, :2] * 1.0004 - 0.0002))
    assert len(kept.vertices) == len(mesh.vertices)
    assert kept.uv.min() == 0 and kept.uv.max() == 1


FAULTS = {
    "tile": lambda mesh: mesh.vertices[:, :2] * 3,
    "one point": lambda mesh: np.full((len(mesh.vertices), 2), 0.5),
    "line": lambda mesh: mesh.vertices[:, :2] * (1, 0),
    "NaN": lambda mesh: np.where(mesh.vertices[:, :2] > 0.9, np.nan, 0.5),
    "more than one triangle": lambda mesh: np.abs(mesh.vertices[:, :2] - 0.5),
    "no area": lambda mesh: np.maximum(mesh.vertices[:, :2], 0.5),
}


@pytest.mark.parametrize("word", FAULTS)
def test_texture_coordinates_that_are_no_atlas_say_why(word):
    mesh = grid(8)
    assert word in atlas_fault(with_uv(mesh, FAULTS[word](mesh)))


@pytest.fixture(scope="module")
def laid_out():
    """A ball, its atlas, and what the progress was told."""
    calls = []
    return ball(), unwrap_mesh(ball(), progress=lambda *call: calls.append(call)), calls


def test_a_mesh_without_uvs_gets_charts_that_hold(laid_out):
    mesh, result, calls = laid_out
    assert atlas_fault(result) is None
    statistics = atlas_statistics(result)
    assert statistics.overlap == 0 and statistics.fill > 0.4 and statistics.stretch < 1.2
    assert calls[0] == ("atlas", 0, 3) and calls[-1] == ("atlas", 3, 3)
    assert len(result.faces) == len(mesh.faces)
    theirs = np.sort(np.linalg.norm(mesh.vertices[mesh.faces].sum(axis=1), axis=1))
    ours = np.sort(np.linalg.norm(result.vertices[result.faces].sum(axis=1), axis=1))
    np.testing.assert_array_equal(ours, theirs)  # the same triangles, vertices doubled only
    again = unwrap_mesh(mesh)
    np.testing.assert_array_equal(again.uv, result.uv)
    np.testing.assert_array_equal(again.faces, result.faces)


def test_charts_keep_their_distance(laid_out):
    """No two charts within three texels at 1024: the gutters that bilinear sampling needs."""
    from scipy.ndimage import maximum_filter, minimum_filter

    from eigenfield.imaging.raster import rasterise_atlas
    from eigenfield.proxy import chart_labels

    _, mesh, _ = laid_out
    face = rasterise_atlas(mesh, 1024, 1024).face
    chart = np.where(face >= 0, chart_labels(mesh)[face], -1)
    highest = maximum_filter(chart, 7)
    lowest = minimum_filter(np.where(chart < 0, 1 << 20, chart), 7)
    assert chart.max() > 0
    assert not ((highest >= 0) & (lowest < highest)).any()


@pytest.mark.slow
def test_refused_uvs_are_welded_and_cut_anew(caplog):
    mesh = grid(10, height=0.1)
    soup = Mesh(
        mesh.vertices[mesh.faces].reshape(-1, 3),
        np.arange(3 * len(mesh.faces), dtype=np.int32).reshape(-1, 3),
        np.tile([(0, 0), (1, 0), (0, 1)], (len(mesh.faces), 1)).astype(np.float32),  # every triangle over the others
    )
    with caplog.at_level(logging.WARNING, "eigenfield.proxy"):
        result = unwrap_mesh(soup)
    assert "no atlas" in caplog.text and "more than one triangle" in caplog.text
    assert atlas_statistics(result).charts < 10
    assert len(result.vertices) < len(soup.vertices) / 2


def test_a_large_mesh_without_an_atlas_is_simplified_and_the_log_says_so(caplog):
    mesh = grid(130, uv=False, height=0.1)
    assert len(mesh.faces) > PROXY_DEFAULT_TRIANGLES
    with caplog.at_level(logging.INFO, "eigenfield.proxy"):
        result = unwrap_mesh(mesh, triangles=500)
    assert "simplified from 33800 to" in caplog.text
    assert 300 <= len(result.faces) <= 500
    assert atlas_fault(result) is None
    assert len(simplify_mesh(mesh, PROXY_DEFAULT_TRIANGLES).faces) <= PROXY_DEFAULT_TRIANGLES


def test_a_large_mesh_with_an_atlas_is_kept_unless_triangles_are_named():
    mesh = grid(130)
    assert len(unwrap_mesh(mesh).faces) == len(mesh.faces)
    assert len(unwrap_mesh(mesh, triangles=400).faces) <= 400


def test_simplification_far_from_the_origin_keeps_the_shape():
    mesh = grid(40, uv=False, height=0.1)
    far = Mesh((mesh.vertices * 1000 + (1e5, -2e5, 3e4)).astype(np.float32), mesh.faces)
    less = simplify_mesh(far, 400)
    np.testing.assert_allclose(less.vertices.min(axis=0), far.vertices.min(axis=0), atol=10)
    np.testing.assert_allclose(less.vertices.max(axis=0), far.vertices.max(axis=0), atol=10)


def test_too_few_triangles_are_refused():
    with pytest.raises(OptionError) as caught:
        unwrap_mesh(grid(3), triangles=0)
    assert caught.value.code == "triangles"


@pytest.mark.skipif(os.name == "nt", reason="a shell script stands for the process")
@pytest.mark.slow
def test_a_mesh_larger_than_a_pipe_reaches_a_slow_xatlas(monkeypatch, tmp_path):
    """The process starts to read only after several ticks: none of the mesh may get lost on the way."""
    script = tmp_path / "python"
    script.write_text(f'#!/bin/sh\nsleep {5 * child.CHILD_POLL_SECONDS}\nexec "{sys.executable}" "$@"\n')
    script.chmod(0o755)
    monkeypatch.setattr(child.sys, "executable", str(script))
    mesh = grid(70, uv=False, height=0.05)
    assert mesh.vertices.nbytes + mesh.faces.nbytes > 65536
    assert len(unwrap_mesh(mesh).faces) == len(mesh.faces)


def test_ctrl_c_ends_xatlas_too(monkeypatch):
    children = []
    real = child.subprocess.Popen

    def spy(*arguments, **options):
        children.append(real(*arguments, **options))
        return children[-1]

    def interrupt(stage, done, total):
        if children:
            raise KeyboardInterrupt

    monkeypatch.setattr(child.subprocess, "Popen", spy)
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        unwrap_mesh(ball(5), progress=interrupt)
    assert time.monotonic() - start < 5
    assert children[0].poll() is not None


@pytest.mark.skipif(os.name == "nt", reason="a shell script stands for the process")
@pytest.mark.parametrize("last", ["kill -SEGV $$", "echo some trouble >&2; exit 3"])
def test_a_crash_of_xatlas_is_one_clear_line(monkeypatch, tmp_path, last):
    script = tmp_path / "python"
    script.write_text(f"#!/bin/sh\ncat > /dev/null\n{last}\n")
    script.chmod(0o755)
    monkeypatch.setattr(child.sys, "executable", str(script))
    write_ply(ball(1), tmp_path / "ball.ply")
    with pytest.raises(ProxyError, match="xatlas ended with") as caught:
        prepare_proxy(tmp_path / "ball.ply", [looking(-1)])
    assert caught.value.code == "proxy-unwrap"
    assert caught.value.path == str(tmp_path / "ball.ply")


def looking(side, distance=5.0):
    """A camera on the z axis at -`distance` (side -1: looks at the origin) or that turns its back on it (side 1)."""
    turn = np.diag([1.0, 1.0, 1.0]) if side < 0 else np.diag([-1.0, 1.0, -1.0])
    return Camera(np.array([[100, 0, 50], [0, 100, 50], [0, 0, 1.0]]), turn, turn @ (0, 0, distance), 100, 100)


def test_a_mesh_behind_all_cameras():
    with pytest.raises(ProxyError, match="behind all 2 cameras") as caught:
        prepare_proxy(grid(3), [looking(1), looking(1, 6.0)])
    assert caught.value.code == "proxy-not-seen"
    assert "axes" in caught.value.remedy


def test_a_mesh_beside_all_cameras():
    mesh = grid(3)
    with pytest.raises(ProxyError, match="outside the frame of all 1 cameras") as caught:
        prepare_proxy(Mesh(mesh.vertices + np.float32(50), mesh.faces, mesh.uv), [looking(-1)])
    assert caught.value.code == "proxy-not-seen"


def test_one_camera_that_sees_it_is_enough():
    assert prepare_proxy(grid(3), [looking(1), looking(-1)]).uv is not None


def test_a_triangle_that_fills_the_frame_is_seen_though_no_corner_is():
    corners = np.array([(-900, -900, 1), (900, -900, 1), (0, 1800, 1)], np.float32)
    mesh = Mesh(corners, np.array([(0, 1, 2)], np.int32), np.array([(0, 0), (1, 0), (0.5, 1)], np.float32))
    assert len(prepare_proxy(mesh, [looking(-1)]).faces) == 1


def test_a_mesh_from_memory_is_checked_too():
    mesh = grid(3)
    broken = Mesh(mesh.vertices, np.array([(0, 1, 99)], np.int32), mesh.uv)
    with pytest.raises(ProxyError) as caught:
        prepare_proxy(broken, [looking(-1)])
    assert caught.value.code == "proxy-index-range"


def test_tarot_is_kept_exactly(data):
    mesh = read_mesh(data / "tarot_17x17_512/calibration/proxy.ply")
    kept = unwrap_mesh(mesh)
    np.testing.assert_array_equal(kept.uv, mesh.uv)
    np.testing.assert_array_equal(kept.faces, mesh.faces)
    statistics = atlas_statistics(mesh)
    assert statistics.charts == 8 and statistics.overlap < 1e-4


@pytest.mark.slow
def test_the_cube_gets_an_atlas(data):
    mesh = read_mesh(data / "cube_colmap_mesh/proxy.obj")
    assert len(mesh.faces) == 25_798
    result = unwrap_mesh(mesh)
    statistics = atlas_statistics(result)
    assert atlas_fault(result) is None
    assert statistics.fill > 0.45 and statistics.stretch < 1.02 and statistics.overlap < 1e-4


def look_at(x, y, z):
    """A camera above the unit square that looks straight down."""
    return Camera(
        np.array([[80.0, 0, 32], [0, 80, 32], [0, 0, 1]]), np.diag([1.0, -1, -1]), np.array([-x, y, z]), 64, 64
    )


ABOVE = [look_at(0.5 + 0.2 * i, 0.5, 2.0) for i in (-1, 0, 1)]


@pytest.mark.parametrize(
    ("places", "left"), [([(9e5, 9e5, 9e5)], 1), ([(0, 1e4, 0), (1e5, 0, 3e4)], 3), ([(0, 0, 9)], 0)]
)
def test_triangles_of_vertices_far_outside_are_left_out(caplog, places, left):
    plain = grid(6, uv=False, height=0.1)
    vertices = plain.vertices.copy()
    vertices[[0, 6][: len(places)]] = places  # corners, of one and of two triangles
    with caplog.at_level(logging.WARNING):
        made = without_far_vertices(Mesh(vertices, plain.faces), ABOVE, None)
    lines = [record.getMessage() for record in caplog.records if "far outside" in record.getMessage()]
    dropped = len(plain.faces) - len(made.faces)
    assert (dropped, len(lines)) == ({0: 0, 1: 2, 3: 3}[left], int(left > 0))


def test_ground_that_reaches_far_stays():
    plain = grid(12, uv=False)
    flat = plain.vertices - np.float32(0.5)
    reach = (np.abs(flat).max(axis=1) * 2) ** 8 * 5000 + 1  # gradually, to 2500 times the scene
    mesh = Mesh((flat * reach[:, None] + 0.5).astype(np.float32), plain.faces)
    assert without_far_vertices(mesh, ABOVE, None) is mesh


@pytest.mark.parametrize("equal", [True, False])
def test_an_atlas_of_equal_triangles_is_kept_where_triangles_are_alike(caplog, equal):
    plain = grid(8, uv=False)
    if not equal:  # most of the square in two triangles
        x, y = plain.vertices[:, 0], plain.vertices[:, 1]
        plain.vertices[:, 0], plain.vertices[:, 1] = x**12, y**12
    count = len(plain.faces)
    side = int(np.ceil(np.sqrt(count)))
    at = np.stack(np.divmod(np.arange(count), side), axis=1)[:, None]
    uv = (at + np.array([[0.1, 0.1], [0.9, 0.1], [0.1, 0.9]])) / side
    own = Mesh(plain.vertices[plain.faces].reshape(-1, 3), np.arange(3 * count, dtype=np.int32).reshape(-1, 3),
               uv.reshape(-1, 2).astype(np.float32))  # fmt: skip
    with caplog.at_level(logging.WARNING):
        made = unwrap_mesh(own, cameras=ABOVE)
    assert (made.uv.tobytes() == own.uv.tobytes()) == equal
    assert any("hardly any texels" in record.getMessage() for record in caplog.records) != equal
    assert unwrap_mesh(own).uv.tobytes() == own.uv.tobytes()  # without cameras any share will do
