"""Planes of several densities, regions and a matrix become one texture: the renderer against the plain reference."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.core.appearance import Basis, Plane
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene
from eigenfield.rendering import Renderer, ViewWeights, draw_texture
from eigenfield.rendering.software.resample import make_taps, tiles_read
from eigenfield.rendering.software.tiles import tile_shape
from reference import composite, finer
from support.scenes import bumpy_square, float_basis, smooth_pictures, tiny_scene

TO_RGB = np.array([[1, 0.9, 0.1], [1, -0.4, 0.5], [1, -0.5, -0.9]], np.float32)


def coded(basis: Basis, zero: float = 128.0) -> Basis:
    """The basis as a file keeps it, with a zero that need not be a code."""
    scale = np.abs(basis.textures).max() / 120
    codes = np.clip(np.rint(basis.textures / scale + zero), 0, 255).astype(np.uint8)
    return replace(basis, textures=codes, scale=np.full_like(basis.scale, scale), zero=np.full_like(basis.zero, zero))


def split_scene(matrix: bool = True) -> Scene:
    """Luma with a dense mean, a coarse basis and a region of its own density; chroma of two channels, coarser."""
    rows = 5
    scene = tiny_scene()
    local = replace(coded(float_basis(rows, 3, 21, 18, 1, seed=3), 127.3), grid=(40, 44), corner=(7, 19))
    luma = Plane(0.5 + 0.2 * smooth_pictures(1, 90, 70, 1)[0], (coded(float_basis(rows, 6, 33, 35, 1, seed=1)), local))
    chroma = Plane(0.1 * smooth_pictures(1, 20, 26, 2, seed=5)[0], (float_basis(rows, 2, 17, 17, 2, seed=2),))
    return replace(
        scene, appearance=replace(scene.appearance, planes=(luma, chroma), to_rgb=TO_RGB if matrix else None)
    )


@pytest.mark.parametrize("matrix", [True, False])
def test_planes_of_several_densities_are_composed_as_the_reference_does(matrix):
    scene = split_scene(matrix)
    assert scene.appearance.atlas == (90, 70) and scene.appearance.channels == 3
    renderer = Renderer(scene)
    for row in range(3):
        mix = np.eye(5)[row] * 0.7 + 0.06
        np.testing.assert_allclose(renderer.texture(ViewWeights(np.arange(5), mix)), composite(scene, mix), atol=2e-5)


def test_a_drawn_view_is_the_composed_texture_on_the_mesh():
    scene = split_scene()
    mix = np.full(5, 0.2)
    camera = scene.rig.cameras[0]
    drawn = Renderer(scene).draw(camera, ViewWeights(np.arange(5), mix), samples=1)
    expected = draw_texture(scene.proxy.mesh, composite(scene, mix).astype(np.float32), camera, samples=1)
    np.testing.assert_allclose(drawn.image, expected.image, atol=2e-5)
    np.testing.assert_array_equal(drawn.coverage, expected.coverage)


def test_buffers_used_again_hold_nothing_of_the_last_picture():
    scene = split_scene()
    renderer = Renderer(scene)
    first = renderer.draw(scene.rig.cameras[0], ViewWeights.one(0)).image
    renderer.draw(scene.rig.cameras[4], ViewWeights.one(4))
    np.testing.assert_array_equal(renderer.draw(scene.rig.cameras[0], ViewWeights.one(0)).image, first)


def test_a_count_limits_every_basis():
    scene = split_scene()
    cut = tuple(replace(p, bases=tuple(basis.truncate(1) for basis in p.bases)) for p in scene.appearance.planes)
    weights = ViewWeights.one(2)
    np.testing.assert_allclose(
        Renderer(scene).texture(weights, 1),
        composite(replace(scene, appearance=replace(scene.appearance, planes=cut)), weights.dense(5)),
        atol=2e-5,
    )
    none = replace(
        scene, appearance=replace(scene.appearance, planes=tuple(replace(p, bases=()) for p in scene.appearance.planes))
    )
    np.testing.assert_allclose(Renderer(scene).texture(weights, 0), Renderer(none).texture(weights), atol=1e-6)


def test_a_coarse_mean_alone_is_drawn_as_it_is():
    mean = smooth_pictures(1, 24, 30, 3)[0]
    scene = replace(tiny_scene(3, 0), appearance=replace(tiny_scene(3, 0).appearance, planes=(Plane(mean, ()),)))
    np.testing.assert_allclose(Renderer(scene).texture(ViewWeights()), mean, atol=1e-6)


def test_an_attribute_of_other_channels_needs_no_matrix():
    planes = (Plane(smooth_pictures(1, 32, 32, 4)[0], ()), Plane(smooth_pictures(1, 16, 20, 1)[0], ()))
    scene = replace(tiny_scene(3, 0), appearance=replace(tiny_scene(3, 0).appearance, planes=planes))
    assert scene.appearance.channels == 5
    np.testing.assert_allclose(Renderer(scene).texture(ViewWeights()), composite(scene, np.zeros(5)), atol=1e-5)


@given(st.integers(1, 90), st.integers(1, 90))
def test_taps_make_a_constant_the_same_constant_and_a_line_the_same_line(fine, coarse):
    taps = make_taps(fine, coarse)
    np.testing.assert_allclose(taps.weight.sum(axis=1), 1, atol=1e-6)
    assert taps.at.min() >= 0 and taps.at.max() < coarse
    line = (taps.weight * taps.at).sum(axis=1)
    x = (np.arange(fine) + 0.5) / fine * coarse - 0.5
    inner = (x >= 1) & (x <= coarse - 3)
    np.testing.assert_allclose(line[inner], x[inner], atol=1e-4)
    expected = finer(np.random.default_rng(0).normal(size=(coarse, 1, 1)), (fine, 1))[:, 0, 0]
    found = (taps.weight * np.random.default_rng(0).normal(size=coarse)[taps.at]).sum(axis=1)
    np.testing.assert_allclose(found, expected, atol=1e-5)


@settings(max_examples=50)
@given(st.integers(1, 150), st.integers(1, 150), st.integers(1, 90), st.integers(1, 90), st.integers(0, 2**31))
def test_every_coarse_texel_that_a_needed_tile_reads_is_in_a_tile_that_is_summed(height, width, h, w, seed):
    needed = np.random.default_rng(seed).random(tile_shape((height, width))) < 0.2
    rows, columns = make_taps(height, h), make_taps(width, w)
    found = tiles_read(needed, rows, columns, tile_shape((h, w)))
    read = np.zeros_like(found)
    for row, column in np.argwhere(needed):
        ys = rows.at[row * 16 : row * 16 + 16].ravel() // 16
        xs = columns.at[column * 16 : column * 16 + 16].ravel() // 16
        read[np.ix_(np.unique(ys), np.unique(xs))] = True
    assert (found >= read).all()


def test_bases_of_sixteen_bits():
    scene = tiny_scene()
    (plane,) = scene.appearance.planes
    basis = plane.bases[0]
    values = basis.values()
    scale = np.float32(np.abs(values).max() / 30000)
    codes = (np.rint(values / scale) + 32768).astype(np.uint16)
    fine = Basis(codes, np.full_like(basis.scale, scale), np.full_like(basis.zero, 32768), basis.weights)
    weights = ViewWeights.one(1)
    expected = composite(
        replace(scene, appearance=replace(scene.appearance, planes=(Plane(plane.mean, (fine,)),))), weights.dense(5)
    )
    np.testing.assert_allclose(
        Renderer(replace(scene, appearance=replace(scene.appearance, planes=(Plane(plane.mean, (fine,)),)))).texture(
            weights
        ),
        expected,
        atol=1e-4,
    )


def test_texels_that_the_mesh_does_not_use_are_left_out():
    mesh = bumpy_square()
    assert mesh.uv is not None
    mesh = replace(mesh, uv=(mesh.uv * np.float32(0.3)))
    scene = replace(split_scene(), proxy=Proxy(mesh))
    mix = np.full(5, 0.2)
    found, expected = Renderer(scene).texture(ViewWeights(np.arange(5), mix)), composite(scene, mix)
    used = found.any(axis=2)
    assert 0.05 < used.mean() < 0.8
    np.testing.assert_allclose(found[used], expected[used], atol=2e-5)
