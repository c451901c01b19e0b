"""Components of small graphs and meshes whose pieces are known."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from eigenfield.imaging.graph import components, edge_components, edge_links, face_edges, vertex_components

# 0-1-2-3 is a square of two triangles; triangle 4-5-6 stands alone; 3-7-8 touches the square at a vertex
FACES = np.array([[0, 1, 2], [2, 1, 3], [4, 5, 6], [3, 7, 8]], np.int32)


def test_components_are_numbered_by_their_first_nodes():
    found = components(6, np.array([4, 5]), np.array([1, 4]))
    np.testing.assert_array_equal(found, [0, 1, 2, 3, 1, 1])
    assert found.dtype == np.int32
    np.testing.assert_array_equal(components(3, np.zeros(0, int), np.zeros(0, int)), [0, 1, 2])


@given(st.lists(st.tuples(st.integers(0, 19), st.integers(0, 19)), max_size=30))
def test_components_are_those_of_a_walk_along_the_links(links):
    label = list(range(20))
    for _ in range(20):
        for a, b in links:
            label[a] = label[b] = min(label[a], label[b])
    one, other = np.array(links, int).reshape(-1, 2).T
    np.testing.assert_array_equal(components(20, one, other), np.unique(label, return_inverse=True)[1])


def test_triangles_that_share_vertices_or_edges():
    np.testing.assert_array_equal(vertex_components(FACES, 10), [0, 0, 0, 0, 1, 1, 1, 0, 0, 2])
    np.testing.assert_array_equal(edge_components(FACES), [0, 0, 1, 2])
    np.testing.assert_array_equal(np.stack(edge_links(FACES)), [[1], [0]])
    assert len(edge_components(np.zeros((0, 3), np.int32))) == 0


def test_edges_are_numbered_whichever_way_they_run():
    ends, number = face_edges(FACES[:2])
    np.testing.assert_array_equal(ends, [[0, 1], [1, 2], [0, 2], [1, 2], [1, 3], [2, 3]])
    np.testing.assert_array_equal(number, [0, 2, 1, 2, 3, 4])


def test_an_edge_of_three_triangles_joins_them_all():
    fan = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]], np.int32)
    np.testing.assert_array_equal(edge_components(fan), [0, 0, 0])
    np.testing.assert_array_equal(np.stack(edge_links(fan)), [[1, 2], [0, 1]])
