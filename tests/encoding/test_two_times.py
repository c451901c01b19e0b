"""Three cameras at two times: time is data, and what is seen twice alike is encoded as what is seen once."""

from __future__ import annotations

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.core.errors import FormatError, OptionError
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.atlas import make_atlas
from eigenfield.encoding.fitted.fit import Pixels, PlaneSettings, Turns, fit_plane
from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.observations import FitData, open_fit_data, open_subsampled, with_robust_weights
from eigenfield.encoding.fitted.solve import fit_textures, fit_weights, measure_scales, residual
from eigenfield.encoding.projected.eigen import eigen_textures, eigenvectors, gram_matrix, weights_of
from eigenfield.encoding.projected.mean import mean_map
from eigenfield.encoding.projected.project import texture_map, texture_maps
from eigenfield.gltf import validate
from eigenfield.imaging.metrics import psnr, to_codes
from support.glb_surgery import changed, ours
from support.observations import CalibratedInMemory, InMemory, repeated
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


def test_mean_textures_and_weights_fitted_to_the_same_photographs_twice_are_those_of_one_time():
    found = []
    for times in (1, 2):
        with opened(repeated(PHOTOGRAPHS[:3], times)) as data:
            model = model_of(3 * times)
            fit_textures(data, model, measure_scales(data, model), 5)
            fit_weights(data, model, 4)
            found.append(model)
    one, two = found
    np.testing.assert_allclose(two.mean, one.mean, atol=1e-3)
    np.testing.assert_allclose(two.blocks[0].textures, one.blocks[0].textures, atol=1e-3)
    np.testing.assert_array_equal(two.blocks[0].weights[:3], two.blocks[0].weights[3:])
    np.testing.assert_allclose(two.blocks[0].weights[:3], one.blocks[0].weights, atol=2e-3)


def whole_fit(data: FitData):
    settings = PlaneSettings(RGB, (SIDE, SIDE), (64, 64), 2)
    with with_robust_weights(data) as robust:
        return fit_plane(Pixels(data, robust, robust), settings, "test", Turns(3))


def test_a_whole_fit_of_the_same_photographs_twice_is_that_of_one_time():
    fits = []
    for times in (1, 2):
        with opened(repeated(PHOTOGRAPHS[:3], times)) as data:
            fits.append(whole_fit(data))
    one, two = fits
    assert two.uncoded == pytest.approx(one.uncoded, abs=0.05)
    np.testing.assert_allclose(two.mean_alone.squares, np.tile(one.mean_alone.squares, 2), rtol=1e-3)
    drawn = [np.einsum("ij,jchw->ichw", fit.model.blocks[0].weights, fit.model.blocks[0].textures) for fit in fits]
    np.testing.assert_allclose(drawn[1], np.tile(drawn[0], (2, 1, 1, 1)), atol=5e-3)


def test_different_photographs_at_two_times_are_told_apart_by_their_weights():
    with opened(MIXED) as data:
        settings = PlaneSettings(RGB, (SIDE, SIDE), (64, 64), 5)
        fit = fit_plane(Pixels(data, data, data), settings, "test", Turns(2))
    weights = fit.model.blocks[0].weights
    assert weights.shape == (6, 5)
    apart = np.linalg.norm(weights[:, None] - weights[None], axis=2) + 9 * np.eye(6)
    assert apart.min() > 1  # of unit variance
    assert fit.uncoded > 30


@pytest.fixture(scope="module")
def moving():
    """Three cameras at two instants, at the second of which all of the picture is darker."""
    capture = CalibratedInMemory(repeated(PHOTOGRAPHS[:3], 2), CAMERAS, (0.0, 0.5))
    capture.observations.pixels[3:] = [0.7 * one for one in PHOTOGRAPHS[:3]]
    return capture


@pytest.mark.parametrize("options", [{"fit": "none", "textures": 4, "atlas": 64}, {"textures": 4, "quality": 95}])
def test_two_times_are_encoded_saved_and_drawn(moving, options, tmp_path):
    scene = ef.encode(moving, MESH, **options)
    assert scene.times == (0.0, 0.5) and scene.observations == 6
    assert all(basis.weights.shape[0] == 6 for plane in scene.appearance.planes for basis in plane.bases)
    assert scene.rows(time=1).tolist() == [3, 4, 5] and int(scene.rows(1, 1)) == 4
    path = tmp_path / "two.glb"
    ef.save(scene, path)
    back = ef.load(path)
    assert back.times == scene.times and not [one for one in validate(path) if one.severity == "error"]
    found = []
    for time in range(2):
        for index in range(3):
            drawn = ef.render(back, camera=moving.names[index], time=time)
            shown = moving.photograph(3 * time + index).pixels
            found.append(psnr(to_codes(drawn.image), to_codes(shown), drawn.covered))
        between = ef.render(back, at=(0.5, 0.0), time=time)
        assert np.isfinite(between.image).all()
        found.append(between.image[between.covered].mean())
    assert min(found[:3] + found[4:7]) > 24
    assert found[7] == pytest.approx(0.7 * found[3], rel=0.05)
    with pytest.raises(OptionError, match="no instant 2"):
        ef.render(back, time=2)


def test_times_that_do_not_follow_one_another_are_refused(moving, tmp_path):
    path = tmp_path / "two.glb"
    ef.save(ef.encode(moving, MESH, fit="none", textures=1, atlas=64), path)
    path.write_bytes(changed(path.read_bytes(), ours("times", value=[0.5, 0.5])))
    with pytest.raises(FormatError) as caught:
        ef.load(path)
    assert caught.value.code == "times"
