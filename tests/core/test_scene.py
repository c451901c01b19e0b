"""Where a scene's observations lie, and what is derived from it."""

from __future__ import annotations

import copy
from dataclasses import replace

import numpy as np
import pytest

from eigenfield.core.appearance import Appearance, Basis, Plane
from eigenfield.core.lattice import camera_lattice
from eigenfield.core.progress import track
from support.scenes import tiny_scene


def test_rows_are_in_the_order_of_encoded_cameras():
    scene = tiny_scene(cameras=5, held_out=(1,))
    assert scene.rows().tolist() == [0, 1, 2, 3] and scene.rows([[4, 1], [0, 2]]).tolist() == [[3, -1], [0, 1]]
    assert scene.rows(3).shape == () and scene.observations == 4


@pytest.mark.parametrize(
    ("stored", "place"),
    [([1, -2.5, 3e6], [1, -2.5, 3e6]), ([1, 2], None), ([1, 2, True], None), ([0, 1, 1e999], None), ("abc", None)],
)
def test_the_origin_is_three_finite_numbers_or_zero(stored, place):
    assert replace(tiny_scene(), settings={"origin": stored}).origin.tolist() == (place or [0, 0, 0])


def test_what_is_derived_is_made_once_for_each_scene():
    scene, made = tiny_scene(), []
    for _ in range(2):
        assert scene.derive("x", lambda: made.append(1) or len(made)) == 1
    for other in (replace(scene), copy.copy(scene)):
        assert other.derive("x", lambda: "another") == "another"


def test_textures_are_codes_less_their_zero_times_their_scale():
    codes = np.array([[[[3, 10]]], [[[5, 0]]]], np.uint8)  # two textures of one pixel and two channels
    scale, zero = np.array([[2, 0.5], [1, 4]], np.float32), np.array([[1, 8], [5, 2]], np.float32)
    basis = Basis(codes, scale, zero, np.array([[1, 2]], np.float32), (4, 6), (2, 3))
    assert basis.values().reshape(2, 2).tolist() == [[4, 1], [0, -8]]
    assert basis.values(1).tolist() == basis.values(1, 2).tolist() == [[[[0, -8]]]]
    first = basis.truncate(1)
    assert (first.count, first.size, first.corner, first.weights.tolist()) == (1, (4, 6), (2, 3), [[1]])
    planes = (Plane(np.zeros((3, 9, 1), np.float32), (basis,)), Plane(np.zeros((2, 5, 2), np.float32), ()))
    appearance = Appearance(planes)
    assert planes[0].sizes == [(3, 9), (4, 6)] and appearance.atlas == (4, 9)
    assert (appearance.channels, appearance.textures) == (3, 2)
    assert appearance.channel_slices == [slice(0, 1), slice(1, 3)]
    assert Appearance(planes[1:]).textures == 0


def test_a_lattice_of_a_camera_is_its_pixels_and_inverse_depth():
    """k is the number of the middle of an interval of 1 / Z."""
    matrix = np.array([[100, 0, 50, 7], [0, 80, 40, -3], [0, 0, 1, 2.0]])
    steps = np.array([[0, 0, 0], [10, -4, 3]])
    lattice = camera_lattice(matrix, 0.25, 0.1)
    assert lattice.flat
    points = lattice.points(steps)
    u, v, depth = (np.c_[points, np.ones(2)] @ matrix.T).T
    np.testing.assert_allclose(np.c_[u / depth, v / depth, 1 / depth], [[0.5, 0.5, 0.05], [3, -0.5, 0.35]])
    np.testing.assert_allclose(lattice.coordinates(points), steps, atol=1e-9)


def test_work_is_reported_when_its_consumer_is_done_with_it():
    said = []
    said.extend(track("ab", "work", 2, lambda *words: said.append(words)))
    assert said == [("work", 0, 2), "a", ("work", 1, 2), "b", ("work", 2, 2)]
    assert list(track("ab", "work", 2, None)) == ["a", "b"]
