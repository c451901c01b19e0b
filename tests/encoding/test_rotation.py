"""Rotated components draw the same pictures, and are what few bits say."""

import numpy as np
import pytest

from eigenfield.encoding.fitted.model import Block
from eigenfield.encoding.fitted.rotation import rotate_components


def mixed_block(count, seed=0):
    """Textures that hold something in a place of their own each, mixed by a random rotation; weights of variance 1."""
    random = np.random.default_rng(seed)
    textures = np.zeros((count, 1, 32, 32 * count), np.float32)
    for index in range(count):
        textures[index, :, :, 32 * index : 32 * index + 32] = random.normal(0, 0.1 * (index + 1), (1, 32, 32))
    turn = np.linalg.qr(random.normal(size=(count, count)))[0].astype(np.float32)
    weights = np.sqrt(12, dtype=np.float32) * np.linalg.qr(random.normal(size=(12, count)))[0].astype(np.float32)
    mixed = np.ascontiguousarray(np.einsum("ij,jchw->ichw", turn, textures))
    return textures, Block((0, 32, 0, 32 * count), mixed, weights @ turn.T)


@pytest.mark.parametrize("count", [2, 5, 6])
def test_components_that_are_apart_are_found(count):
    textures, block = mixed_block(count)
    found = rotate_components(block, 0.01)
    for one, true in zip(found.textures, textures[::-1], strict=True):  # the strongest first
        assert abs(np.vdot(one, true)) > 0.99 * np.linalg.norm(one) * np.linalg.norm(true)
        assert -one.min() <= one.max()


def test_pictures_and_the_variance_of_weights_stay():
    _, block = mixed_block(5)
    found = rotate_components(block, 0.01)
    before = np.einsum("on,nchw->ochw", block.weights, block.textures)
    np.testing.assert_allclose(np.einsum("on,nchw->ochw", found.weights, found.textures), before, atol=1e-4)
    np.testing.assert_allclose(found.weights.T @ found.weights / 12, np.eye(5), atol=1e-4)


def test_one_component_stays():
    _, block = mixed_block(2)
    one = Block(block.rectangle, block.textures[:1], block.weights[:, :1])
    assert rotate_components(one, 0.01) is one


def test_small_textures_are_rotated_or_left():
    block = Block((0, 4, 0, 4), np.ones((3, 1, 4, 4), np.float32), np.eye(3, dtype=np.float32))
    found = rotate_components(block, 0.01)  # smaller than a block: nothing is known of their bits
    np.testing.assert_allclose(found.weights @ found.textures.reshape(3, -1), block.textures.reshape(3, -1), atol=1e-6)
