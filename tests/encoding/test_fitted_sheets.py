"""The fit of sheets with an opacity: it draws what renderers draw, and codes what its files give back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.core.errors import OptionError
from eigenfield.core.lattice import camera_lattice
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.fitted.colour import LUMA, split_matrix
from eigenfield.encoding.fitted.coverage import mean_precision
from eigenfield.encoding.fitted.footprints import open_footprints
from eigenfield.encoding.fitted.kernels import SHARE_ONE, forward, target
from eigenfield.encoding.fitted.model import PlaneModel
from eigenfield.encoding.fitted.observations import open_fit_data, open_subsampled
from eigenfield.encoding.fitted.solve import measure_scales
from eigenfield.encoding.geometry.distortion import depth_distortion
from eigenfield.encoding.geometry.simplify_relief import simplify_relief_rd
from eigenfield.gltf import encode_scene, read_scene
from eigenfield.imaging.metrics import psnr
from eigenfield.rendering import Renderer, ViewWeights, camera_weights
from eigenfield.rendering.software.drawing import make_surface
from support.observations import CalibratedInMemory, InMemory
from support.soft_scenes import soft_scene

SIDE = 96
DROPPED = 0.002  # of 0..1: by which small shares that the fit leaves out change a pixel


@pytest.fixture(scope="module")
def scene():
    return soft_scene()


@pytest.fixture(scope="module")
def capture(scene):
    """Photographs as the scene draws them, whose borders show nothing but the sheets."""
    pictures = []
    for index, camera in enumerate(scene.rig.cameras):
        drawn = Renderer(scene).draw(camera, camera_weights(scene, index))
        pictures.append((drawn.image / np.maximum(drawn.coverage, 0.25)[..., None]).clip(0, 1).astype(np.float32))
    return CalibratedInMemory(InMemory(pictures), scene.rig.cameras)


def plain_model(side: int = SIDE) -> PlaneModel:
    return PlaneModel(split_matrix()[0], np.zeros((1, side, side), np.float32), (48, 48), [])


def test_the_fit_draws_what_the_renderer_draws(scene):
    renderer = Renderer(scene)
    texture = np.ascontiguousarray(renderer.texture(ViewWeights()).transpose(2, 0, 1))
    cameras, surface = scene.rig.cameras, make_surface(scene.proxy.mesh, SIDE, SIDE)
    with open_footprints(surface, cameras, 1.0, scene.proxy.sheets) as footprints:
        assert 1.2 < len(footprints.shares) / np.count_nonzero(footprints.counts) < 3
        for index, camera in enumerate(cameras):
            expected = renderer.draw(camera, ViewWeights(), samples=1)
            drawn = np.zeros((3, camera.height, camera.width), np.float32)
            forward(*footprints.of(index), surface.size, texture, np.float32(1), drawn)
            np.testing.assert_allclose(drawn.transpose(1, 2, 0), expected.image, atol=DROPPED)
            whole = np.zeros_like(drawn)
            white = np.full((camera.height, camera.width, 3), 255, np.uint8)
            target(*footprints.of(index), white, np.eye(3, 4, dtype=np.float32) / 255, whole)
            part = np.where(expected.coverage > 0.95, 1, expected.coverage)
            near = np.abs(expected.coverage - 0.95) < DROPPED
            np.testing.assert_allclose(whole[0][~near], part[~near], atol=DROPPED)


def test_points_come_front_to_back_and_fewer_pixels_keep_theirs(scene, capture):
    with open_fit_data(scene.rig.cameras, capture.observations, scene.proxy, (SIDE, SIDE)) as data:
        counts, points, shares = data.footprint(4)
        starts = np.cumsum(counts.reshape(-1)) - counts.reshape(-1)
        several = np.flatnonzero(counts.reshape(-1) > 1)
        first, second = (points[starts[several] + k, 0] // (SIDE / 3) for k in (0, 1))  # the strip is the sheet
        assert len(several) > 100 and (first > second).all()
        assert np.bincount(np.repeat(np.arange(counts.size), counts.reshape(-1)), shares).max() <= SHARE_ONE + 3
        with open_subsampled(data, 2) as some:
            fewer, left, weights = some.footprint(4)
            assert len(left) == len(weights) == int(fewer.sum()) < len(points) / 3


def test_a_texel_behind_others_makes_less_noise(scene, capture):
    with open_fit_data(scene.rig.cameras, capture.observations, scene.proxy, (SIDE, SIDE)) as data:
        soft = measure_scales(data, plain_model())
        assert soft.mean_noise.max() <= soft.mean.max() * 1.01
        assert soft.mean_noise.sum() < 0.98 * soft.mean.sum()
        precision = mean_precision(soft)
        assert precision is not None and precision.min() < 0.8 * precision.max() <= 1
    with open_fit_data(scene.rig.cameras, capture.observations, Proxy(scene.proxy.mesh), (SIDE, SIDE)) as data:
        hard = measure_scales(data, plain_model())
        assert hard.mean_noise is hard.mean and hard.coarse_noise is hard.coarse
        assert hard.usual == np.median(hard.mean[hard.mean > 0])


def test_sheets_from_photographs_to_a_file_and_back(scene, capture):
    made = ef.encode(capture, scene.proxy, textures=3, atlas=SIDE, quality=90, hold_out="camera 4")
    data = encode_scene(made)
    read = read_scene(data)
    assert read.proxy.sheets.faces == scene.proxy.sheets.faces
    assert np.abs(read.proxy.sheets.opacity - scene.proxy.sheets.opacity).mean() < 0.05
    assert encode_scene(read) == data
    for index, least in ((0, 32), (4, 22)):  # the second is held out, and weights are random
        drawn = Renderer(read).draw(read.rig.cameras[index], camera_weights(read, index))
        grey, true = drawn.image @ LUMA, capture.photograph(index).pixels @ LUMA  # chroma is as fine, its atlas is not
        assert psnr(grey[..., None], true[..., None], drawn.coverage > 0.98) > least


def lattice_of(scene):
    camera = scene.rig.cameras[4]
    return camera_lattice(camera.matrix, 0.25, 2e-4)


def test_sheets_keep_the_triangles_that_are_worth_their_bytes(scene, capture):
    cameras, observations, proxy = scene.rig.cameras, capture.observations, scene.proxy
    sizes = []
    for lambda_ in (1e-7, 1e-3):
        found = simplify_relief_rd(proxy, lattice_of(scene), cameras, observations, lambda_, 1.0)
        assert sum(found.sheets) == len(found.mesh.faces) and len(found.sheets) == 3
        strips = np.floor(3 * found.mesh.uv[found.mesh.faces].mean(axis=1)[:, 0])
        assert np.array_equal(strips, np.repeat([0, 1, 2], found.sheets))
        sizes.append(len(found.stream))
    assert sizes[1] < 0.6 * sizes[0]


def test_a_sheet_that_shows_nothing_vanishes(scene, capture):
    opacity = scene.proxy.sheets.opacity.copy()
    opacity[:, opacity.shape[1] // 3 : 2 * opacity.shape[1] // 3] = 0
    clear = replace(scene.proxy, sheets=replace(scene.proxy.sheets, opacity=opacity))
    found = simplify_relief_rd(clear, lattice_of(scene), scene.rig.cameras, capture.observations, 1e-6, 1.0)
    assert len(found.sheets) == 2 and not (np.floor(3 * found.mesh.uv[:, 0]) == 1).any()


def test_what_is_seen_through_other_sheets_costs_as_much_less(scene, capture):
    cameras, proxy = scene.rig.cameras, scene.proxy
    shown = depth_distortion(proxy.mesh, lattice_of(scene), cameras, capture.observations, proxy.sheets)
    alone = replace(proxy.sheets, opacity=(np.arange(128) < 42).astype(np.float32) * np.ones((96, 1), np.float32))
    bare = depth_distortion(proxy.mesh, lattice_of(scene), cameras, capture.observations, alone)
    column = np.broadcast_to(np.arange(shown.cost_map.most.shape[1]), shown.cost_map.most.shape)
    wall = (shown.cost_map.given > 0) & (column < shown.cost_map.most.shape[1] / 3 - 2)
    assert (shown.cost_map.most[wall] <= bare.cost_map.most[wall] * 1.001 + 1e-9).all()
    assert shown.cost_map.most[wall].sum() < 0.9 * bare.cost_map.most[wall].sum()
    others = (bare.cost_map.given > 0) & (column > shown.cost_map.most.shape[1] / 3 + 4)
    assert bare.cost_map.most[others].max() < 1e-6 < shown.cost_map.most[others].max()


def test_opacity_has_the_even_sides_that_its_encoder_takes(scene, capture):
    odd = replace(scene.proxy.sheets, opacity=np.ascontiguousarray(scene.proxy.sheets.opacity[:61, :97]))
    made = ef.encode(capture, replace(scene.proxy, sheets=odd), textures=1, atlas=SIDE, preset="small")
    assert made.proxy.sheets.opacity.shape == (64, 98)


def test_a_proxy_without_sheets_is_its_mesh(scene, capture):
    few = {"textures": 2, "atlas": SIDE, "preset": "small"}
    by_mesh, by_proxy = (ef.encode(capture, given, **few) for given in (scene.proxy.mesh, Proxy(scene.proxy.mesh)))
    assert encode_scene(by_mesh) == encode_scene(by_proxy)


def test_texture_maps_know_one_surface(scene, capture):
    with pytest.raises(OptionError, match="texture maps of several sheets") as found:
        ef.encode(capture, scene.proxy, fit="none")
    assert found.value.code == "sheets"
