"""Edges, islands, holes, and what no surface may have."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.core.mesh import Mesh
from eigenfield.imaging.graph import face_edges
from eigenfield.proxy.background import join_meshes
from eigenfield.proxy.topology import (
    boundary_loops,
    fill_holes,
    make_manifold,
    remove_islands,
    remove_unused_vertices,
)
from eigenfield.proxy.topology_kernels import triangulate_least_area
from support.surfaces import ball, square


def holed(mesh, which):
    return remove_unused_vertices(Mesh(mesh.vertices, mesh.faces[~which]))


def test_small_holes_are_filled_large_ones_stay():
    mesh = square(2, 0.0, 41)
    middle = mesh.vertices[mesh.faces].mean(axis=1)[:, :2]
    small = np.linalg.norm(middle - [1, 1], axis=1) < 0.25
    large = np.linalg.norm(middle - [-0.5, -0.5], axis=1) < 0.9
    mesh = holed(mesh, small | large)
    assert len(boundary_loops(mesh)) == 3
    result = fill_holes(mesh, 1.0)
    assert len(boundary_loops(result)) == 2
    missing = 16 - result.face_areas().sum()
    assert np.isclose(
        missing, square(2, 0.0, 41).face_areas()[large].sum(), rtol=1e-4
    )  # the small hole is closed exactly
    assert (result.face_normals()[result.face_areas() > 0] @ [0, 0, -1] > 0.99).all()  # and faces as the rest does


def test_an_outer_border_is_no_hole():
    mesh = square(0.1, 0.0, 6)
    assert np.array_equal(fill_holes(mesh, 10.0).faces, mesh.faces)


@settings(max_examples=40)
@given(st.integers(3, 40), st.integers(0, 2**31))
def test_least_area_triangulates_any_loop(count, seed):
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0, 2 * np.pi, count))
    loop = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
    triangles = triangulate_least_area(loop)
    assert triangles.shape == (count - 2, 3) and set(triangles.ravel()) == set(range(count))
    x, y = loop[:, 0], loop[:, 1]
    polygon = abs((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()) / 2
    flat = Mesh(loop.astype(np.float32), triangles.astype(np.int32)).face_areas().sum()
    assert np.isclose(flat, polygon, rtol=1e-4, atol=1e-6)


def test_least_area_spans_a_bent_loop_over_the_short_way():
    loop = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 1.0], [0, 1, 0]], float)
    area = Mesh(loop.astype(np.float32), triangulate_least_area(loop).astype(np.int32)).face_areas().sum()
    other = Mesh(loop.astype(np.float32), np.array([[1, 2, 3], [1, 3, 0]], np.int32)).face_areas().sum()
    one = Mesh(loop.astype(np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.int32)).face_areas().sum()
    assert np.isclose(area, min(one, other))


def test_islands_go_by_their_share_of_the_area():
    mesh = join_meshes(square(1, 0.0), square(0.05, 3.0), square(0.4, 5.0))
    assert set(np.unique(remove_islands(mesh, 0.01).vertices[:, 2])) == {0.0, 5.0}
    assert set(np.unique(remove_islands(mesh, 0.5).vertices[:, 2])) == {0.0}


def test_no_edge_keeps_three_faces_and_no_vertex_two_fans():
    vertices = np.array(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 0.1], [-1, -1, 0], [-1, 0, 1], [5, 5, 5]], np.float32
    )
    faces = np.array(
        [
            [0, 1, 2],
            [1, 0, 3],
            [0, 1, 4],  # a third face, and the smallest, at the edge 0 1
            [0, 5, 6],  # touches the rest in vertex 0 alone
            [0, 1, 2],  # twice
            [2, 2, 1],  # no triangle
        ],
        np.int32,
    )
    mesh = make_manifold(Mesh(vertices, faces))
    assert len(mesh.faces) == 3
    _, number = face_edges(mesh.faces)
    assert np.bincount(number).max() == 2
    assert len(mesh.vertices) == 7  # vertex 0 is doubled; 4 and 7 are gone
    assert len(boundary_loops(mesh)) == 2


def test_a_clean_mesh_stays_as_it_is():
    mesh = ball()
    same = make_manifold(mesh)
    assert np.array_equal(same.faces, mesh.faces) and np.array_equal(same.vertices, mesh.vertices)
    assert boundary_loops(mesh) == []
