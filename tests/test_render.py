"""Drawing: equation 8 and the filters against plain NumPy, coverage, samples, threads."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
import reference
from scenes import tiny_scene

import eigenfield as ef
from eigenfield.camera import Camera
from eigenfield.errors import OptionError
from eigenfield.mesh import Mesh
from eigenfield.parallel import set_threads
from eigenfield.rendering import Renderer, draw_texture, path_points, view_weights
from eigenfield.scene import Basis, Plane

SIZE = 32
SQUARE = Mesh(
    np.array([[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]], np.float32),
    np.array([[0, 2, 1], [0, 3, 2]], np.int32),
    np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32),
)


def facing(width=SIZE, height=SIZE, shift=(0.0, 0.0), zoom=1.0):
    """A camera that sees the square exactly fill its picture, moved by `shift` pixels."""
    K = np.array([[zoom * width, 0, width / 2 + shift[0]], [0, zoom * height, height / 2 + shift[1]], [0, 0, 1]])
    return Camera(K, np.eye(3), np.array([0, 0, 1.0]), width, height)


def catmull_rom(t):
    t = np.abs(t)
    return np.where(t < 1, (1.5 * t - 2.5) * t * t + 1, np.where(t < 2, ((-0.5 * t + 2.5) * t - 4) * t + 2, 0))


def sampled(texture, x, y, filter):
    """A texture (H, W, C) at texel positions, whole at texel centres, by the definition of the filters."""
    weight = catmull_rom if filter == "bicubic" else lambda t: np.maximum(0, 1 - np.abs(t))
    height, width = texture.shape[:2]
    total = np.zeros((*x.shape, texture.shape[2]))
    for dy in range(-1, 3):
        for dx in range(-1, 3):
            i, j = np.floor(y).astype(int) + dy, np.floor(x).astype(int) + dx
            w = weight(y - i) * weight(x - j)
            total += w[..., None] * texture[np.clip(i, 0, height - 1), np.clip(j, 0, width - 1)]
    return total


@pytest.mark.parametrize("filter", ["bilinear", "bicubic"])
def test_filters_are_what_they_are_called(filter):
    texture = np.random.default_rng(0).random((SIZE, SIZE, 3)).astype(np.float32)
    picture = draw_texture(SQUARE, texture, facing(shift=(0.3, -0.2)), filter=filter, samples=1)
    y, x = np.mgrid[:SIZE, :SIZE].astype(float)
    inner = (slice(3, -3), slice(3, -3))
    expected = sampled(texture, x - 0.3, y + 0.2, filter)
    np.testing.assert_allclose(picture.image[inner], expected[inner], atol=2e-4)


@pytest.mark.parametrize("filter", ["bilinear", "bicubic"])
def test_texel_for_pixel_the_texture_comes_back(filter):
    texture = np.random.default_rng(1).random((SIZE, SIZE, 3)).astype(np.float32)
    picture = draw_texture(SQUARE, texture, facing(), filter=filter, samples=1)
    assert (picture.coverage == 1).all()
    np.testing.assert_allclose(picture.image, texture, atol=1e-4)


@pytest.mark.parametrize("stored", ["float", "codes"])
@pytest.mark.parametrize("channels", [1, 3, 6])
def test_composition_is_equation_8(stored, channels):
    scene = tiny_scene(channels=channels, textures=7)
    basis = scene.planes[0].bases[0]
    if stored == "codes":
        codes = np.random.default_rng(2).integers(0, 256, basis.textures.shape, dtype=np.uint8)
        ones = np.ones_like(basis.scale)
        basis = Basis(codes, 0.002 * ones, 128 * ones, basis.weights)
        scene = replace(scene, planes=(Plane(scene.planes[0].mean, (basis,)),))
    weights = view_weights(scene, (0.2, -0.4))
    for count in (None, 0, 3):
        part = basis.truncated(basis.count if count is None else count)
        expected = reference.texture(scene.planes[0].mean.astype(float), part.values(), weights @ part.weights)
        made = Renderer(scene).texture(weights, count)
        assert np.abs(made - expected).max() <= 1e-4 * np.abs(expected).max()


def test_background_and_coverage():
    texture = np.full((SIZE, SIZE, 3), 0.25, np.float32)
    picture = draw_texture(SQUARE, texture, facing(zoom=0.5), background=(1, 0, 0.5), samples=1)
    inside = np.zeros((SIZE, SIZE), bool)
    inside[8:24, 8:24] = True
    np.testing.assert_array_equal(picture.coverage > 0, inside)
    np.testing.assert_allclose(picture.image[inside], 0.25, atol=1e-6)
    np.testing.assert_allclose(picture.image[~inside], np.broadcast_to([1, 0, 0.5], (SIZE * SIZE - 256, 3)))


def test_samples_average_within_a_pixel():
    texture = np.random.default_rng(3).random((SIZE, SIZE, 3)).astype(np.float32)
    fine = draw_texture(SQUARE, texture, facing(2 * SIZE, 2 * SIZE), samples=1).image
    coarse = draw_texture(SQUARE, texture, facing(), samples=2).image
    np.testing.assert_allclose(coarse, fine.reshape(SIZE, 2, SIZE, 2, 3).mean(axis=(1, 3)), atol=1e-5)


def test_eight_bit_pictures_are_the_rounded_ones():
    scene = tiny_scene()
    renderer, weights = Renderer(scene), view_weights(scene, (0.1, 0.2))
    picture = renderer.draw(scene.cameras[0], weights)
    direct = renderer.draw_uint8(scene.cameras[0], weights)
    assert np.abs(picture.to_uint8().astype(int) - direct).max() <= 1
    assert (picture.to_uint8() != direct).mean() < 0.01


def test_same_picture_at_any_number_of_threads_and_from_many_at_once():
    scene = tiny_scene(textures=5, size=64)
    single = []
    for count in (1, 3):
        set_threads(count)
        try:
            single.append(ef.render(scene, at=(0.3, 0.1), resolution=(300, 200)).image.tobytes())
        finally:
            set_threads(None)
    assert single[0] == single[1]
    places = [(x, y) for x in (-0.5, 0.1, 0.6) for y in (-0.6, 0.0, 0.4)] * 4
    alone = [ef.render(scene, at=at).image for at in places]
    with ThreadPoolExecutor(6) as pool:
        together = list(pool.map(lambda at: ef.render(scene, at=at).image, places))
    for one, other in zip(alone, together, strict=True):
        np.testing.assert_array_equal(one, other)


def test_resolution_crops_to_cover():
    scene = tiny_scene()
    wide = ef.render(scene, camera="view_00", resolution=(96, 40))
    assert wide.image.shape == (40, 96, 3)


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        ({"camera": "view_9"}, "nearest are view_0"),
        ({"at": (0, 0), "camera": "view_00"}, "one of them"),
        ({"filter": "best"}, "bicubic"),
        ({"resolution": (0, 5)}, "16384"),
        ({"samples": 99}, "1 to 16"),
        ({"textures": -1}, "0 or more"),
        ({"background": (1, 2)}, "3 finite"),
    ],
)
def test_impossible_requests_are_refused(request_, says):
    with pytest.raises(OptionError, match=says):
        ef.render(tiny_scene(), **request_)


@pytest.mark.parametrize("name", ["circle", "spiral", "grid"])
def test_paths_stay_inside_and_move_evenly(name):
    points = path_points(name, 200)
    assert points.shape == (200, 2) and np.abs(points).max() <= 1
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert np.percentile(steps, 95) < 2.5 * np.median(steps)
    with pytest.raises(OptionError):
        path_points("zigzag", 10)
    with pytest.raises(OptionError):
        path_points(name, 0)
