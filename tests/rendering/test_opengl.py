"""The OpenGL renderer beside the software renderer and, off the view plane, beside the plain definition."""

from __future__ import annotations

import sys
from dataclasses import replace

import cv2
import numpy as np
import pytest

import eigenfield as ef
import reference
from eigenfield.core.appearance import Basis, Plane
from eigenfield.core.errors import EigenfieldError, FormatError, OptionError
from eigenfield.core.proxy import Proxy
from eigenfield.gltf import encode_scene, save
from eigenfield.rendering import OpenGLRenderer, camera_colour, view_weights, viewpoint, weight_map
from support.scenes import tiny_scene
from support.viewer_scenes import FREE, free_camera, scene

LARGEST, MEAN = 2, 0.5  # grey levels by which renderers may differ away from edges


@pytest.fixture(scope="module")
def loaded(tmp_path_factory):
    path = tmp_path_factory.mktemp("opengl") / "scene.glb"
    save(scene(), path, codec="png")
    return ef.load(path)


def levels(picture):
    return picture.to_uint8().astype(int)


def agree(one, other):
    """Both cover the same pixels but for an edge, and differ by a rounding within."""
    covered = (one.coverage == 1) & (other.coverage == 1)
    assert covered.sum() > 0.2 * covered.size
    assert ((one.coverage > 0) != (other.coverage > 0)).mean() < 1e-3
    away = np.abs(levels(one) - levels(other))[covered]
    assert away.max() <= LARGEST and away.mean() <= MEAN, (away.max(), away.mean())


@pytest.mark.parametrize("filter", ["bilinear", "bicubic"])
@pytest.mark.parametrize(
    "where", [{"at": (0.0, 0.0)}, {"at": (0.37, -0.21)}, {"at": (-0.93, 0.71)}, {"camera": "view_0_0"}]
)
def test_it_agrees_with_the_software_renderer(context, loaded, filter, where):
    camera, weights = viewpoint(loaded, **where)
    drawn = OpenGLRenderer(loaded, filter=filter, context=context).draw(camera, weights)
    agree(drawn, ef.render(loaded, **where, filter=filter, samples=1))


@pytest.mark.parametrize("rays", [False, True])
@pytest.mark.parametrize("count", [0, 1, 3, 4, 5, None])
def test_any_number_of_the_textures_is_summed(context, loaded, count, rays):
    """Four share a texel; those of a group that are not wanted add nothing."""
    camera, weights = viewpoint(loaded, at=(0.4, 0.3))
    drawn = OpenGLRenderer(loaded, context=context).draw(camera, None if rays else weights, textures=count)
    agree(drawn, ef.render(loaded, at=(0.4, 0.3), textures=count, samples=1))


@pytest.mark.parametrize("textures", [1, 2, 4, 5])
def test_scenes_of_any_number_of_textures(context, textures, tmp_path):
    """Codes of several bases, the last texels not full."""
    save(scene(textures=textures), tmp_path / "scene.glb", codec="png")
    coded = ef.load(tmp_path / "scene.glb")
    plane = coded.appearance.planes[0]
    (basis,) = plane.bases
    cut = textures // 2
    rest = Basis(basis.textures[cut:], basis.scale[cut:], basis.zero[cut:], basis.weights[:, cut:])
    split = replace(
        coded, appearance=replace(coded.appearance, planes=(Plane(plane.mean, (basis.truncate(cut), rest)),))
    )
    expected = ef.render(coded, at=(0.4, 0.3), samples=1)
    camera, weights = viewpoint(coded, at=(0.4, 0.3))
    for drawn in (coded, split):
        agree(OpenGLRenderer(drawn, context=context).draw(camera, weights), expected)


def test_each_texture_has_its_own_weight(context, loaded):
    """Of each component of a texel and of each group: one texture alone is what the software renderer draws of it."""
    camera, weights = viewpoint(loaded, at=(0.4, 0.3))
    plane = loaded.appearance.planes[0]
    (basis,) = plane.bases
    for j in range(basis.count):
        alone = np.zeros_like(basis.weights)
        alone[:, j] = basis.weights[:, j]
        one = replace(
            loaded, appearance=replace(loaded.appearance, planes=(Plane(plane.mean, (replace(basis, weights=alone),)),))
        )
        drawn = OpenGLRenderer(one, context=context).draw(camera, weights)
        agree(drawn, ef.render(one, at=(0.4, 0.3), samples=1))


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("textures", [0, 3, 5])
def test_fresh_scenes_of_one_and_three_channels(context, channels, textures):
    fresh = tiny_scene(channels=channels, textures=textures, cameras=9)
    camera, weights = viewpoint(fresh, at=(0.2, -0.6))
    camera = camera.resize(192, 160)
    drawn = OpenGLRenderer(fresh, context=context).draw(camera, weights)
    expected = ef.render(fresh, at=(0.2, -0.6), resolution=(192, 160), samples=1)
    same = replace(expected, image=np.broadcast_to(expected.image, (160, 192, 3)))
    agree(drawn, same)


@pytest.mark.parametrize("at", [(0.0, 0.0), (-0.7, 0.45)])
def test_on_the_plane_rays_meet_it_at_the_eye(context, loaded, at):
    camera, weights = viewpoint(loaded, at=at)
    renderer = OpenGLRenderer(loaded, context=context)
    agree(renderer.draw(camera), renderer.draw(camera, weights))


@pytest.mark.parametrize("eye", [FREE[0], *(pytest.param(eye, marks=pytest.mark.slow) for eye in FREE[1:])])
@pytest.mark.slow
def test_off_the_plane_every_point_has_its_own_weights(context, loaded, eye):
    camera = free_camera(np.array(eye))
    drawn = OpenGLRenderer(loaded, filter="bilinear", context=context).draw(camera)
    expected = np.rint(255 * reference.free_view(loaded, camera)).astype(int)
    inner = drawn.coverage == 1
    inner[1:-1, 1:-1] &= inner[:-2, 1:-1] & inner[2:, 1:-1] & inner[1:-1, :-2] & inner[1:-1, 2:]
    away = np.abs(levels(drawn) - expected)[inner]
    assert inner.sum() > 10_000 and away.max() <= LARGEST and away.mean() <= MEAN
    flat = OpenGLRenderer(loaded, filter="bilinear", context=context).draw(
        camera, view_weights(loaded, tuple(loaded.rig.view_plane.coordinates([camera.centre])[0]))
    )
    assert np.abs(levels(flat) - expected)[inner].mean() > 5 * MEAN  # one set of weights for all is not the same


def test_far_from_the_worlds_origin(context, loaded):
    """Float32 keeps a third of a unit at 3e6: what is drawn must not depend on where the origin lies."""
    move = np.array([40_000.0, -25_000.0, 8_000.0])
    vertices = (loaded.proxy.mesh.vertices + move).astype(np.float32)
    cameras = tuple(replace(camera, t=camera.t - camera.R @ move) for camera in loaded.rig.cameras)
    plane = replace(loaded.rig.view_plane, origin=loaded.rig.view_plane.origin + move)
    moved = replace(
        loaded,
        proxy=Proxy(replace(loaded.proxy.mesh, vertices=vertices)),
        rig=replace(loaded.rig, cameras=cameras, view_plane=plane),
    )
    camera, weights = viewpoint(moved, at=(0.3, 0.1))
    agree(OpenGLRenderer(moved, context=context).draw(camera, weights), ef.render(moved, at=(0.3, 0.1), samples=1))


def test_background_edges_and_exposure(context, loaded):
    camera, weights = viewpoint(loaded, at=(0.1, 0.1))
    drawn = OpenGLRenderer(loaded, multisample=4, context=context).draw(camera, weights, background=(0.2, 0.4, 0.6))
    assert np.allclose(drawn.image[0, 0], (0.2, 0.4, 0.6), atol=1e-3) and drawn.coverage[0, 0] == 0
    partly = (drawn.coverage > 0) & (drawn.coverage < 1)
    assert 50 < partly.sum() < 5000
    colours = np.tile(np.array([[[1.1, 0.9, 1.2], [0.02, -0.03, 0.05]]], np.float32), (25, 1, 1))
    appearance = replace(loaded.appearance, colours=colours, mixed_colours=False)
    harmonised = replace(loaded, appearance=appearance)
    camera, weights = viewpoint(harmonised, camera="view_1_1")
    drawn = OpenGLRenderer(harmonised, context=context).draw(camera, weights, colour=camera_colour(harmonised, 6))
    expected = ef.render(harmonised, camera="view_1_1", samples=1)
    agree(drawn, replace(expected, image=np.clip(expected.image, 0, 1)))


@pytest.mark.parametrize("where", [{"at": (0.37, -0.21)}, {"camera": "view_0_0"}])
def test_exposures_are_mixed_as_the_software_renderer_does(context, loaded, where):
    factors = np.linspace(0.8, 1.2, 75).reshape(25, 1, 3)
    colours = np.concatenate([factors, (1 - factors) / 4], axis=1).astype(np.float32)
    mixed = replace(loaded, appearance=replace(loaded.appearance, colours=colours))
    camera, weights = viewpoint(mixed, **where)
    expected = ef.render(mixed, **where, samples=1)
    expected = replace(expected, image=np.clip(expected.image, 0, 1))
    renderer = OpenGLRenderer(mixed, context=context)
    agree(renderer.draw(camera, weights), expected)
    if "at" in where:  # on the view plane all rays have the same weights
        agree(renderer.draw(camera), expected)


def test_pictures_of_several_sizes_one_after_the_other(context, loaded):
    renderer = OpenGLRenderer(loaded, context=context)
    for size in ((64, 48), (320, 240), (33, 21), (320, 240)):
        camera, weights = viewpoint(loaded, at=(0, 0))
        drawn = renderer.draw(camera.resize(*size), weights)
        assert drawn.image.shape == (size[1], size[0], 3) and drawn.coverage.any()


def test_smaller_pictures_do_not_shimmer(context, loaded):
    """A picture of a quarter of the size is about the average of the large one's pixels."""
    camera, weights = viewpoint(loaded, at=(0, 0))
    renderer = OpenGLRenderer(loaded, context=context)
    large, small = renderer.draw(camera, weights), renderer.draw(camera.resize(80, 60), weights)
    average = large.image.reshape(60, 4, 80, 4, 3).mean(axis=(1, 3))
    whole = large.coverage.reshape(60, 4, 80, 4).min(axis=(1, 3)) == 1
    assert np.abs(small.image - average)[whole].mean() < 0.03
    sharp = np.abs(large.image[2::4, 2::4] - average)[whole].mean()
    assert np.abs(small.image - average)[whole].mean() < 0.7 * sharp


@pytest.mark.parametrize("columns, rows, held_out", [(5, 5, 0), (5, 1, 0), (5, 5, 3), (2, 2, 0)])
@pytest.mark.parametrize("mode", ["delaunay", "nearest3"])
def test_the_weight_map_holds_the_weights(columns, rows, held_out, mode):
    made = scene(columns, rows, held_out=held_out)
    nodes = 33
    found, steps = weight_map(made, mode, nodes), np.linspace(-1, 1, nodes)
    omega = made.appearance.planes[0].bases[0].weights.astype(float)
    expected = [[view_weights(made, (x, y), mode).blend(omega) for x in steps] for y in steps]
    assert found.shape == (nodes, nodes, 6)
    np.testing.assert_allclose(found, expected, atol=1e-5)


def test_scenes_that_it_cannot_draw_are_refused(context):
    two = tiny_scene()
    plane = two.appearance.planes[0]
    with pytest.raises(FormatError, match="one plane") as caught:
        OpenGLRenderer(replace(two, appearance=replace(two.appearance, planes=(plane, plane))), context=context)
    assert caught.value.code == "unsupported-layout"
    with pytest.raises(FormatError):
        OpenGLRenderer(
            replace(two, appearance=replace(two.appearance, planes=(Plane(plane.mean[..., :2], ()),))), context=context
        )


def test_unknown_filters_are_refused(context, loaded):
    with pytest.raises(OptionError, match="bilinear, bicubic"):
        OpenGLRenderer(loaded, filter="mixed", context=context)


def test_a_machine_without_driver_or_module_says_so(monkeypatch):
    monkeypatch.setitem(sys.modules, "moderngl", None)
    with pytest.raises(EigenfieldError, match="pip install") as caught:
        OpenGLRenderer(tiny_scene())
    assert caught.value.code == "opengl-missing"
    monkeypatch.undo()
    moderngl = pytest.importorskip("moderngl")

    def none(**options):
        raise RuntimeError("no display")

    monkeypatch.setattr(moderngl, "create_standalone_context", none)
    with pytest.raises(EigenfieldError, match="no display") as caught:
        OpenGLRenderer(tiny_scene())
    assert caught.value.code == "opengl-context"


def test_films_and_pictures_by_the_command_line(context, loaded, tmp_path, run):
    """`--renderer opengl` draws what the software renderer does, in `render` and in `export`."""
    path = tmp_path / "scene.glb"
    path.write_bytes(encode_scene(loaded))
    for name in ("software", "opengl"):
        for verb, output in (("render", "frame-%d.png"), ("export", "view_qs3x2a1.33.png")):
            more = ["--path", "circle", "--frames", "2"] if verb == "render" else ["--quilt", "3x2"]
            code, _, err = run(verb, path, "-o", tmp_path / f"{name}-{output}", "--renderer", name, *more)
            assert code == 0, err
    for output in ("frame-0.png", "frame-1.png"):
        one, other = (cv2.imread(tmp_path / f"{name}-{output}").astype(int) for name in ("software", "opengl"))
        assert np.abs(one - other).mean() < 0.6
    quilts = [cv2.imread(found) for found in sorted(tmp_path.glob("*_qs3x2*.png"))]
    assert len(quilts) == 2 and np.abs(quilts[0].astype(int) - quilts[1]).mean() < 0.6
    code, _, err = run("render", path, "-o", tmp_path / "x.png", "--renderer", "opengl", "--samples", "2")
    assert code == 2 and "leave them out" in err
