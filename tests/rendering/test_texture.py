"""Equation 8 over the whole atlas: textures of cameras and viewpoints, the mean, and many views at once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eigenfield.core.errors import OptionError
from eigenfield.gltf import save
from eigenfield.rendering import mean_texture, render, render_many, texture, view_weights
from reference import composite
from support.composed import layered_scene
from support.scenes import tiny_scene


def test_a_camera_s_texture_is_the_mean_plus_the_weighted_eigen_textures():
    scene = tiny_scene(held_out=(1,), cameras=6)
    (plane,) = scene.appearance.planes
    (basis,) = plane.bases
    for row, name in enumerate(name for name in scene.names if name != "view_01"):
        expected = plane.mean + np.einsum("n,nhwc->hwc", basis.weights[row], basis.textures)
        np.testing.assert_allclose(texture(scene, name), expected, atol=1e-6)
        two = plane.mean + np.einsum("n,nhwc->hwc", basis.weights[row, :2], basis.textures[:2])
        np.testing.assert_allclose(texture(scene, name, textures=2), two, atol=1e-6)
    np.testing.assert_array_equal(texture(scene), texture(scene, scene.names[scene.rig.reference]))


def test_between_cameras_and_at_those_held_out_textures_are_mixed_by_the_view_weights():
    scene = tiny_scene(held_out=(1,), cameras=6)
    encoded = [texture(scene, name) for name in scene.names if name != "view_01"]
    x, y = scene.rig.view_plane.coordinates(scene.cameras[1].centre)[0]
    for at, found in (((0.3, -0.2), texture(scene, at=(0.3, -0.2))), ((x, y), texture(scene, "view_01"))):
        mix = view_weights(scene, at).dense(5)
        np.testing.assert_allclose(found, np.einsum("n,nhwc->hwc", mix, np.stack(encoded)), atol=1e-6)


def test_planes_of_other_densities_are_composed_over_the_whole_atlas():
    scene = layered_scene()
    for row, index in enumerate(scene.rig.encoded[:2]):
        expected = composite(scene, np.eye(scene.observations)[row])
        np.testing.assert_allclose(texture(scene, scene.names[index]), expected, atol=2e-5)
    mean = mean_texture(scene)
    assert mean.shape == (*scene.appearance.atlas, 3) and mean is mean_texture(scene)
    np.testing.assert_allclose(mean, composite(scene, np.zeros(scene.observations)), atol=2e-5)
    with pytest.raises(ValueError, match="read-only"):
        mean[0] = 0


def test_textures_have_as_many_channels_as_the_scene():
    assert texture(tiny_scene(channels=5)).shape == (32, 32, 5) == mean_texture(tiny_scene(channels=5)).shape


def test_many_views_are_those_that_are_drawn_one_by_one(tmp_path):
    scene = tiny_scene(held_out=(1,), cameras=6)
    mixed = replace(scene, appearance=replace(scene.appearance, colours=np.full((6, 2, 3), 0.9, np.float32)))
    save(scene, tmp_path / "scene.glb")
    points, how = np.array([[0, 0], [0.3, -0.2], [-1, 1], [0.5, 0.5], [0.1, 0.9]]), {"resolution": (20, 16)}
    for given in (scene, mixed, tmp_path / "scene.glb"):
        drawn = list(render_many(given, at=points, **how))
        for at, picture in zip(points.tolist(), drawn, strict=True):
            np.testing.assert_array_equal(picture.image, render(given, at=tuple(at), **how).image)
    for names in (None, ["view_03", "view_01"]):
        drawn = list(render_many(mixed, cameras=names))
        for name, picture in zip(names or scene.names, drawn, strict=True):
            np.testing.assert_array_equal(picture.image, render(mixed, camera=name).image)
    calls = []
    assert len(list(render_many(scene, at=points, progress=lambda *call: calls.append(call)))) == 5
    assert calls[0] == ("drawing", 0, 5) and calls[-1] == ("drawing", 5, 5)
    assert list(render_many(scene, at=[])) == list(render_many(scene, cameras=())) == []


@pytest.mark.parametrize(
    ("named", "says"),
    [
        ({"at": (0.3, 0.1)}, "give a sequence, each (a number, a number)"),
        ({"at": np.zeros((4, 3))}, "give a sequence, each (a number, a number)"),
        ({"at": [(0, 0), (0, 3)]}, "lies outside the array"),
        ({"cameras": "view_00"}, "give a sequence, each a text"),
        ({"cameras": ["view_00", "view_77"]}, "no camera is called view_77"),
        ({"at": [(0, 0)], "cameras": ["view_00"]}, "give one of them"),
        ({"filter": "blurry"}, "no filter is called 'blurry'"),
        ({"background": (1, 2)}, "the background has 2 values"),
        ({"resolution": (0, 5)}, "a picture of 0x5"),
        ({"textures": -1}, "-1 eigen textures"),
        ({"weights": "no"}, "no view weights are called 'no'"),
    ],
)
def test_what_is_wrong_with_many_views_is_said_by_the_call(named, says):
    with pytest.raises(OptionError) as caught:
        render_many(tiny_scene(), **named)
    assert says in str(caught.value)
