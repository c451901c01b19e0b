"""Mean, fill and eigen textures against the plain reference, at any tiling and number of threads."""

from __future__ import annotations

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import reference
from eigenfield.encoding.agreement import warn_of_disagreement
from eigenfield.encoding.plan import component_count
from eigenfield.encoding.projected import eigen, mean
from eigenfield.encoding.projected.align import align_maps
from eigenfield.encoding.projected.project import TextureMaps
from eigenfield.runtime.parallel import set_threads


def random_maps(cameras=7, texels=500, channels=3, seed=0, rank=None, unseen=0.3):
    generator = np.random.default_rng(seed)
    if rank is None:
        values = generator.random((cameras, texels, channels))
    else:
        values = 0.5 + generator.normal(size=(cameras, rank)) @ generator.normal(size=(rank, texels * channels)) / 10
        values = values.reshape(cameras, texels, channels)
    seen = (generator.random((cameras, texels)) >= unseen).astype(np.uint8)
    seen[:, : texels // 50] = 0  # texels that no camera sees
    values = (values * seen[..., None]).astype(np.float32)
    return TextureMaps(SimpleNamespace(count=texels), values, seen)


def decompose(maps, count):
    average = mean.mean_map(maps)
    weights = eigen.weights_of(eigen.eigenvectors(eigen.gram_matrix(maps, average)), count)
    return average, weights, eigen.eigen_textures(maps, average, weights)


def test_mean_and_fill_are_equations_1_and_2():
    maps = random_maps()
    average = mean.mean_map(maps)
    np.testing.assert_allclose(average.values, reference.mean_texture(maps.values, maps.seen), atol=1e-6)
    assert (average.count == maps.seen.sum(axis=0)).all()
    expected = reference.filled_maps(maps.values, maps.seen)
    for camera in range(maps.count):
        np.testing.assert_allclose(
            mean.filled_map(maps.values[camera], maps.seen[camera], average.values), expected[camera], atol=1e-6
        )


@pytest.mark.parametrize("channels", [1, 3, 6])
def test_textures_and_weights_are_equations_3_to_6(channels):
    maps = random_maps(channels=channels)
    average, weights, textures = decompose(maps, 4)
    mean_, eigen_, weights_ = reference.decomposition(maps.values.astype(float), maps.seen, 4)
    np.testing.assert_allclose(average.values, mean_, atol=1e-6)
    np.testing.assert_allclose(weights, weights_, rtol=1e-4, atol=1e-4)
    assert np.abs(textures - eigen_).max() < 1e-4 * np.abs(eigen_).max()


@pytest.mark.parametrize("rank", [None, 2])
def test_all_components_reproduce_the_filled_maps(rank):
    maps = random_maps(cameras=9, rank=rank)
    average, weights, textures = decompose(maps, 8)
    filled = reference.filled_maps(maps.values.astype(float), maps.seen)
    for camera in range(9):
        again = reference.texture(average.values, textures, weights[camera])
        assert np.abs(again - filled[camera]).max() * 255 < 1e-3


def test_reproduces_duplicated_cameras():
    """Two pairs of equal maps: eigenvalues vanish, the span must not."""
    maps = random_maps(cameras=6, unseen=0)
    maps.values[3], maps.values[5] = maps.values[2], maps.values[0]
    average, weights, textures = decompose(maps, 5)
    for camera in range(6):
        again = reference.texture(average.values, textures, weights[camera])
        assert np.abs(again - reference.filled_maps(maps.values, maps.seen)[camera]).max() * 255 < 1e-3


def test_analytic_decomposition():
    """Maps a(c) A + b(c) B with orthogonal A, B and zero-mean, orthogonal a, b decompose into just these."""
    texels = 64
    a, b = np.array([3.0, -3, 3, -3]), np.array([1.0, 1, -1, -1])
    A, B = np.zeros((texels, 1)), np.zeros((texels, 1))
    A[::2], B[1::2] = 0.1, 0.1
    values = 0.5 + a[:, None, None] * A + b[:, None, None] * B
    maps = TextureMaps(SimpleNamespace(count=texels), values.astype(np.float32), np.ones((4, texels), np.uint8))
    average, weights, textures = decompose(maps, 3)
    np.testing.assert_allclose(average.values, 0.5, atol=1e-6)
    np.testing.assert_allclose(weights[:, 0], a / 3, atol=1e-5)
    np.testing.assert_allclose(weights[:, 1], b, atol=1e-5)
    np.testing.assert_allclose(textures[0], 3 * A, atol=1e-6)
    np.testing.assert_allclose(textures[1], B, atol=1e-6)
    np.testing.assert_allclose(textures[2], 0, atol=1e-6)


def test_same_bytes_at_any_number_of_threads(monkeypatch):
    maps = random_maps(cameras=12, texels=3000)
    monkeypatch.setattr(eigen, "MAP_TILE_TEXELS", 256)
    monkeypatch.setattr(mean, "MAP_TILE_TEXELS", 256)
    results = []
    for count in (1, 2, 3):
        set_threads(count)
        try:
            average, weights, textures = decompose(maps, 11)
        finally:
            set_threads(None)
        results.append((average.values.tobytes(), weights.tobytes(), textures.tobytes()))
    assert results[0] == results[1] == results[2]


@settings(max_examples=20)
@given(cameras=st.integers(3, 12), texels=st.integers(1, 60), channels=st.integers(1, 6), seed=st.integers(0, 99))
def test_weights_are_white_and_errors_fall(cameras, texels, channels, seed):
    maps = random_maps(cameras, texels, channels, seed)
    average, weights, textures = decompose(maps, cameras - 1)
    np.testing.assert_allclose(weights.sum(axis=0), 0, atol=1e-4)
    np.testing.assert_allclose(weights.T @ weights / cameras, np.eye(cameras - 1), atol=1e-4)
    filled = reference.filled_maps(maps.values.astype(float), maps.seen)
    errors = [
        np.square(average.values + np.tensordot(weights[:, :n], textures[:n], 1) - filled).sum() for n in range(cameras)
    ]
    assert all(later <= earlier + 1e-6 for earlier, later in itertools.pairwise(errors))


def test_asking_for_too_many_components_is_said(caplog):
    assert component_count(40, 17) == 16
    assert "at most 16" in caplog.text
    assert component_count(3, 17) == 3


def warned_of(levels, caplog):
    """Cameras of a 9 x 9 array that are said to show something else, of so many grey levels off the mean texture."""
    y, x = np.divmod(np.arange(81), 9)
    names = [f"{row}-{column}" for row, column in zip(y, x, strict=True)]
    caplog.clear()
    squares = 1000 * 3 * (np.asarray(levels).reshape(-1) / 255) ** 2
    warn_of_disagreement(squares, np.full(81, 1000), 3, 1e9, names, np.stack([x, y], axis=1).astype(float))
    return [record.getMessage().split()[0] for record in caplog.records]


def test_only_what_its_neighbours_do_not_show_is_strange(caplog):
    """Light that falls off towards a corner is none; a photograph there is, and a row of photographs."""
    y, x = np.mgrid[0:9, 0:9]
    falling = 3 + 5 * np.exp(-np.hypot(8 - x, 8 - y) / 3)
    assert warned_of(falling, caplog) == []
    one, row = falling.copy(), falling.copy()
    one[8, 8], one[4, 4], row[8] = 20, falling[8, 8], 30
    assert warned_of(one, caplog) == ["4-4", "8-8"]
    assert warned_of(row, caplog) == [f"8-{column}" for column in range(9)]


def test_alignment_undoes_a_shift():
    """A map shifted by two texels comes back onto the reference; the mean is sharper after alignment."""
    height = width = 96
    generator = np.random.default_rng(3)
    import cv2

    picture = cv2.GaussianBlur(generator.random((height, width + 8, 3)).astype(np.float32), (0, 0), 2.0)
    picture = (picture - picture.min()) / np.ptp(picture)
    shifted = np.stack([picture[:, s : s + width] for s in (4, 6, 2)]).reshape(3, -1, 3)
    atlas = SimpleNamespace(count=height * width, texel=np.arange(height * width), width=width, height=height)
    atlas.image = lambda values, blank=0.0: values.reshape(height, width, -1).astype(np.float32)
    maps = TextureMaps(atlas, shifted.copy(), np.ones((3, height * width), np.uint8))
    align_maps(maps, 0)
    inner = np.zeros((height, width), bool)
    inner[10:-10, 10:-10] = True
    before = np.abs(shifted[1] - shifted[0])[inner.reshape(-1)].mean()
    after = np.abs(maps.values[1] - maps.values[0])[inner.reshape(-1)].mean()
    assert after < before / 8
    np.testing.assert_array_equal(maps.values[0], shifted[0])
