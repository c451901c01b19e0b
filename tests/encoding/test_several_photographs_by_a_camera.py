"""Several photographs by a camera share its footprint; the same one twice weighs as two in the sums of a fit."""

from __future__ import annotations

import numpy as np

from eigenfield.core.proxy import Proxy
from eigenfield.encoding.atlas import make_atlas
from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.observations import open_fit_data, open_subsampled
from eigenfield.encoding.fitted.solve import measure_scales, residual
from eigenfield.encoding.projected.eigen import eigen_textures, eigenvectors, gram_matrix, weights_of
from eigenfield.encoding.projected.mean import mean_map
from eigenfield.encoding.projected.project import texture_map, texture_maps
from eigenfield.imaging.metrics import to_codes
from support.observations import InMemory, repeated
from support.scenes import bumpy_square, row_grid, smooth_pictures

CAMERAS = row_grid(9, 72, 60)[3:6]
MESH = bumpy_square(12)
SIDE, GRID = 64, (40, 36)
RGB = np.eye(3, dtype=np.float32)
PHOTOGRAPHS = [0.5 + 0.2 * one for one in smooth_pictures(6, 60, 72, 3, seed=3)]
MASK = np.ones((60, 72), np.float32)
MASK[10:30, 20:50] = 0
MIXED = InMemory(
    PHOTOGRAPHS, [None, MASK, *[None] * 4], [2, 0, 1, 0, 2, 1], [0, 0, 0, 1, 1, 1]
)  # in no order of cameras


def projected(observations):
    """Texture maps, their mean, two eigen textures and their weights."""
    with texture_maps(make_atlas(MESH, SIDE, SIDE), CAMERAS, observations) as maps:
        mean = mean_map(maps)
        weights = weights_of(eigenvectors(gram_matrix(maps, mean)), 2)
        return np.array(maps.values), mean, eigen_textures(maps, mean, weights), weights


def test_texture_maps_are_of_each_observation_through_its_own_camera():
    values, *_ = projected(MIXED)
    for index in range(6):
        expected, _ = texture_map(
            make_atlas(MESH, SIDE, SIDE),
            CAMERAS[MIXED.camera_of(index)],
            PHOTOGRAPHS[index],
            MASK if index == 1 else None,
        )
        np.testing.assert_array_equal(values[index], expected)


def test_mean_and_eigen_textures_of_the_same_photographs_twice_are_those_of_one_time():
    _, mean, textures, weights = projected(InMemory(PHOTOGRAPHS[:3]))
    values, again, textures_again, weights_again = projected(repeated(PHOTOGRAPHS[:3], 2))
    assert len(values) == 6 and (again.count == 2 * mean.count).all()
    np.testing.assert_allclose(again.values, mean.values, atol=1e-6)
    np.testing.assert_allclose(textures_again, textures, atol=1e-5)
    np.testing.assert_allclose(weights_again, np.concatenate([weights, weights]), atol=1e-4)


def opened(observations):
    return open_fit_data(CAMERAS, observations, Proxy(MESH), (SIDE, SIDE))


def test_observations_of_a_camera_share_its_footprint():
    with opened(InMemory(PHOTOGRAPHS[:3])) as once, opened(MIXED) as data:
        assert len(data.footprints) == 3 and len(data) == 6
        assert data.footprints.counts.size == once.footprints.counts.size
        for index in range(6):
            camera = MIXED.camera_of(index)
            for found, expected in zip(data.footprint(index), once.footprints.of(camera), strict=True):
                np.testing.assert_array_equal(found, expected)
            assert data.observations.camera_of(index) == camera
            np.testing.assert_array_equal(data.observations.codes_of(index), to_codes(PHOTOGRAPHS[index]))
            mask = data.observations.mask(index)
            np.testing.assert_array_equal(mask, 255 * (MASK if index == 1 else np.ones_like(MASK)))
        with open_subsampled(data, 2) as some:
            assert len(some.footprints) == 3 and len(some) == 6
            for index in range(6):
                counts, _, _ = some.footprint(index)
                assert counts.shape == some.observations.codes_of(index).shape[:2]
                assert some.observations.mask(index).shape == counts.shape


def model_of(observations: int) -> PlaneModel:
    """A grey mean and two components, whose weights are the same at each time."""
    textures = 0.06 * smooth_pictures(2, *GRID, 3, 1).transpose(0, 3, 1, 2)
    weights = np.array([[1, 0.5], [-1, 0.3], [0.2, -1]], np.float32)
    block = Block((0, *GRID[:1], 0, GRID[1]), np.ascontiguousarray(textures), np.tile(weights, (observations // 3, 1)))
    return PlaneModel(RGB, np.full((3, SIDE, SIDE), 0.5, np.float32), GRID, [block])


def test_the_normal_equations_of_the_same_photographs_twice_are_twice_those_of_one_time():
    found = []
    for times in (1, 2):
        with opened(repeated(PHOTOGRAPHS[:3], times)) as data:
            model = model_of(3 * times)
            scales, left = measure_scales(data, model), residual(data, model)
            found.append((scales, left.mean.copy(), left.textures[0].copy(), left.squares, left.pixels))
    (one, mean, textures, squares, pixels), (two, mean_again, textures_again, squares_again, pixels_again) = found
    np.testing.assert_allclose(two.mean, 2 * one.mean, rtol=1e-4, atol=1e-4)
    np.testing.assert_allclose(two.coarse, 2 * one.coarse, rtol=1e-4, atol=1e-4)
    np.testing.assert_allclose(mean_again, 2 * mean, atol=1e-4)
    np.testing.assert_allclose(textures_again, 2 * textures, atol=1e-3)
    np.testing.assert_array_equal(squares_again, np.tile(squares, 2))
    np.testing.assert_array_equal(pixels_again, np.tile(pixels, 2))
