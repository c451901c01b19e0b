"""Three cameras at two times: time is data, and what is seen twice alike is encoded as what is seen once."""

from __future__ import annotations

import numpy as np

from eigenfield.encoding.projected import (
    eigen_textures,
    gram_matrix,
    make_atlas,
    mean_map,
    spectrum,
    texture_map,
    texture_maps,
    weights_of,
)
from support.observations import InMemory, repeated
from support.scenes import bumpy_square, row_grid, smooth_pictures

CAMERAS = row_grid(9, 72, 60)[3:6]
MESH = bumpy_square(12)
SIDE = 64
PHOTOGRAPHS = [0.5 + 0.2 * one for one in smooth_pictures(6, 60, 72, 3, seed=3)]


def projected(observations):
    """Texture maps, their mean, two eigen textures and their weights."""
    with texture_maps(make_atlas(MESH, SIDE, SIDE), CAMERAS, observations) as maps:
        mean = mean_map(maps)
        weights = weights_of(spectrum(gram_matrix(maps, mean)), 2)
        return np.array(maps.values), mean, eigen_textures(maps, mean, weights), weights


def test_texture_maps_are_of_each_observation_through_its_own_camera():
    observations = InMemory(PHOTOGRAPHS, (), [2, 0, 1, 0, 2, 1], [0, 0, 0, 1, 1, 1])
    atlas = make_atlas(MESH, SIDE, SIDE)
    values, *_ = projected(observations)
    for index in range(6):
        expected, _ = texture_map(atlas, CAMERAS[observations.camera_of(index)], PHOTOGRAPHS[index])
        np.testing.assert_array_equal(values[index], expected)
    assert sorted(observations.decoded) == list(range(6))


def test_mean_and_eigen_textures_of_the_same_photographs_twice_are_those_of_one_time():
    _, mean, textures, weights = projected(InMemory(PHOTOGRAPHS[:3]))
    values, again, textures_again, weights_again = projected(repeated(PHOTOGRAPHS[:3], 2))
    assert len(values) == 6 and (again.count == 2 * mean.count).all()
    np.testing.assert_allclose(again.values, mean.values, atol=1e-6)
    np.testing.assert_allclose(textures_again, textures, atol=1e-5)
    np.testing.assert_allclose(weights_again, np.concatenate([weights, weights]), atol=1e-4)
