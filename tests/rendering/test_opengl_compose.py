"""What OpenGL composes before it draws: planes of several sizes and regions, texel by texel beside the definition."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.core.appearance import Plane
from eigenfield.core.errors import FormatError
from eigenfield.core.scene import Scene
from eigenfield.rendering import OpenGLRenderer, draw_texture, view_weights, viewpoint
from eigenfield.rendering.opengl.composer import Composer
from support.composed import coded, composed, flat, layered_scene, ray_weights
from support.viewer_scenes import scene

CLOSE = 1.5 / 255  # of values up to 2; half-floats there are 1 / 1024 apart, and each part that is added rounds once


def texture_of(context, made: Scene, count: int, weights=None, eye=(0.0, 0.0, 0.0)) -> np.ndarray:
    """(H, W, 3): what the GPU composes."""
    composer = Composer(context, made, "delaunay")
    try:
        composer.compose(count, weights, np.array(eye))
        return (
            np.frombuffer(composer.texture.read(), np.float16).reshape(*made.appearance.atlas, 4)[..., :3].astype(float)
        )
    finally:
        composer.release()


@pytest.mark.parametrize("count", [0, 1, 2, 4, 6])
def test_planes_of_several_sizes_and_regions(context, count):
    made = layered_scene()
    weights = view_weights(made, (0.4, -0.3))
    expected = composed(made, weights, count)
    assert np.abs(texture_of(context, made, count, weights) - expected).max() < CLOSE
    assert count == 0 or np.abs(expected - composed(made, weights, 0)).max() > 20 * CLOSE  # there is much to be seen


@settings(max_examples=15, derandomize=True)
@given(data=st.data())
def test_any_sizes_channels_and_regions(context, data):
    """Also textures of more channels than share a texel, and an atlas that no mean and no basis has."""
    side, plain = st.integers(1, 40), scene(3, 3)
    weights = plain.appearance.planes[0].bases[0].weights
    planes = []
    for _ in range(data.draw(st.integers(1, 3))):
        channels = data.draw(st.integers(1, 5))
        mean = np.random.default_rng(len(planes)).uniform(0, 0.5, (data.draw(side), data.draw(side), channels))
        bases = []
        for _ in range(data.draw(st.integers(0, 2))):
            size = data.draw(side), data.draw(side)
            beyond = [data.draw(st.integers(0, 5)) for _ in range(4)]
            grid = size[0] + beyond[0] + beyond[1], size[1] + beyond[2] + beyond[3]
            bases.append(coded(weights, data.draw(st.integers(0, 6)), size, channels, grid, (beyond[0], beyond[2])))
        planes.append(Plane(mean.astype(np.float32), tuple(bases)))
    total = sum(plane.mean.shape[2] for plane in planes)
    matrix = np.random.default_rng(total).uniform(-0.5, 0.5, (3, total)).astype(np.float32)
    made = replace(plain, appearance=replace(plain.appearance, planes=tuple(planes), to_rgb=matrix))
    mix = view_weights(made, (0.2, 0.6))
    assert np.abs(texture_of(context, made, 5, mix) - composed(made, mix, 5)).max() < 2 * CLOSE


def test_more_textures_than_one_draw_sums(context):
    plain = scene(3, 3)
    weights = np.random.default_rng(3).normal(size=(9, 203)).astype(np.float32)
    basis = coded(weights, 203, (9, 12), 3)
    basis = replace(basis, scale=np.full_like(basis.scale, 0.02 / 127))
    made = replace(
        plain, appearance=replace(plain.appearance, planes=(Plane(np.full((9, 12, 3), 0.5, np.float32), (basis,)),))
    )
    mix = view_weights(made, (0.2, 0.6))
    for count in (84, 85, 203):
        assert np.abs(texture_of(context, made, count, mix) - composed(made, mix, count)).max() < CLOSE


@pytest.mark.parametrize(
    "eye",
    [(0.35, -0.2, -1.9), *(pytest.param(eye, marks=pytest.mark.slow) for eye in [(-0.6, 0.3, -4.5), (0.1, 0.1, -3.0)])],
)
@pytest.mark.slow
def test_each_texel_of_each_size_has_its_own_weights(context, eye):
    made = flat(layered_scene(), 0.0, 1.0)
    sizes = {size for plane in made.appearance.planes for size in plane.sizes}
    weights = {size: ray_weights(made, np.array(eye), size, 0.0, 1.0) for size in sizes}
    drawn = texture_of(context, made, 6, eye=eye)
    away = np.abs(drawn - composed(made, weights))
    assert away.max() < 2 * CLOSE and away.mean() < CLOSE / 3
    if eye[2] != -3.0:
        own = view_weights(made, tuple(made.rig.view_plane.coordinates(np.array(eye))[0]))
        assert np.abs(drawn - composed(made, own)).mean() > 2 * CLOSE


@pytest.mark.slow
def test_texels_beside_a_chart_have_its_weights_and_others_the_eyes(context):
    """A filter within the chart reads two texels beyond it."""
    eye, low, high = np.array([0.35, -0.2, -1.9]), 0.25, 0.75
    made = flat(scene(), low, high)
    size = made.appearance.atlas
    near = composed(made, {size: ray_weights(made, eye, size, low, high)})
    far = composed(made, view_weights(made, tuple(made.rig.view_plane.coordinates(eye)[0])))
    drawn = texture_of(context, made, 6, eye=tuple(eye))
    first, last = int(low * size[0]), int(high * size[0])
    chart, beside = np.zeros((2, *size), bool)
    chart[first:last, first:last] = True
    beside[first - 2 : last + 2, first - 2 : last + 2] = True
    beside &= ~chart
    assert np.abs(drawn - near)[chart].max() < CLOSE
    assert np.abs(drawn - far)[~chart & ~beside].max() < CLOSE
    assert np.abs(drawn - near)[beside].mean() < 0.25 * np.abs(drawn - far)[beside].mean()


def test_a_view_is_composed_once(context, monkeypatch):
    made = layered_scene()
    with OpenGLRenderer(made, context=context) as renderer:
        counted = []
        whole = Composer._add
        monkeypatch.setattr(Composer, "_add", lambda *given: counted.append(given) or whole(*given))
        camera, weights = viewpoint(made, at=(0.1, 0.2))
        moved, others = viewpoint(made, at=(0.4, 0.2))
        seen = []
        for view, mix, textures in (
            (camera, weights, None), (moved.resize(50, 40), weights, None), (camera, weights, 2), (camera, None, 2),
            (camera, None, 2), (moved, None, 2), (moved, others, 2),
        ):  # fmt: skip
            before = len(counted)
            renderer.draw(view, mix, textures=textures)
            seen.append(len(counted) > before)
    assert seen == [True, False, True, True, False, True, True]


@pytest.mark.parametrize("filter", ["bilinear", "bicubic"])
def test_what_is_composed_is_drawn(context, filter):
    made = layered_scene()
    camera, weights = viewpoint(made, at=(0.37, -0.21))
    texture = np.ascontiguousarray(composed(made, weights), dtype=np.float32)
    expected = draw_texture(made.proxy.mesh, texture, camera, filter=filter, samples=1)
    drawn = OpenGLRenderer(made, filter=filter, context=context).draw(camera, weights)
    inside = (drawn.coverage == 1) & (expected.coverage == 1)
    away = np.abs(drawn.to_uint8().astype(int) - expected.to_uint8())[inside]
    assert inside.sum() > 0.2 * inside.size and away.max() <= 2 and away.mean() <= 0.5


def test_scenes_that_are_no_pictures_are_refused(context):
    made = layered_scene()
    for refused in (
        replace(made, appearance=replace(made.appearance, to_rgb=None)),
        replace(made, appearance=replace(made.appearance, to_rgb=None, planes=made.appearance.planes[1:])),
    ):
        with pytest.raises(FormatError, match="one plane") as caught:
            OpenGLRenderer(refused, context=context)
        assert caught.value.code == "unsupported-layout"
    OpenGLRenderer(
        replace(made, appearance=replace(made.appearance, to_rgb=None, planes=made.appearance.planes[:1])),
        context=context,
    ).close()
