"""Soft sheets: known pictures, the plain definition, and the OpenGL renderer beside the software renderer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eigenfield.core.appearance import Plane
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.core.scene import Scene
from eigenfield.rendering import OpenGLRenderer, Renderer, ViewWeights, view_weights, viewpoint
from eigenfield.runtime.parallel import set_threads
from support.composed import layered_scene
from support.scenes import bumpy_square, tiny_scene
from support.sheets import composited, stacked
from support.viewer_scenes import scene as viewer_scene

SIZE, MEAN_ONLY = 32, ViewWeights()
RED, BLUE, GREY = np.array([0.75, 0.25, 0.0]), np.array([0.0, 0.5, 1.0]), np.array([0.25, 0.25, 0.25])
ROUNDING = 1e-6
HIDDEN = 4e-4  # where less of what is behind shows through, the renderer draws nothing behind


def square(z: float, left: float, right: float) -> Mesh:
    """A square before `facing`, `left` to `right` of its picture's width; z < 0 is nearer, and as large in the picture.
    UVs are the picture's."""
    x = np.array([left, right, right, left])
    y = np.array([0.0, 0, 1, 1])
    vertices = np.stack([(x - 0.5) * (1 + z), (y - 0.5) * (1 + z), np.full(4, z)], axis=1)
    uv = np.stack([x, y], axis=1)
    return Mesh(vertices.astype(np.float32), np.array([[0, 2, 1], [0, 3, 2]], np.int32), uv.astype(np.float32))


def facing() -> Camera:
    """A camera that sees the unit square at z = 0 fill its picture."""
    K = np.array([[SIZE, 0, SIZE / 2], [0, SIZE, SIZE / 2], [0, 0, 1.0]])
    return Camera(K, np.eye(3), np.array([0, 0, 1.0]), SIZE, SIZE)


def painted(sheets: list[list[tuple[Mesh, np.ndarray, float]]]) -> Scene:
    """A scene of sheets, back to front, of squares of one colour and opacity; each square has a strip of the atlas."""
    flat = [part for sheet in sheets for part in sheet]
    mean = np.repeat([colour for _, colour, _ in flat], SIZE, axis=0)[:, None].repeat(SIZE, axis=1)
    opacity = np.repeat([part for *_, part in flat], SIZE)[:, None].repeat(SIZE, axis=1)
    vertices = np.concatenate([mesh.vertices for mesh, *_ in flat])
    faces = np.concatenate([mesh.faces + 4 * i for i, (mesh, *_) in enumerate(flat)]).astype(np.int32)
    # a strip's edges are left out: filters would mix it with its neighbour
    uv = np.concatenate([(0.1 + 0.8 * mesh.uv + (0, i)) / (1, len(flat)) for i, (mesh, *_) in enumerate(flat)])
    mesh = Mesh(vertices, faces, uv.astype(np.float32))
    counts = tuple(2 * len(sheet) for sheet in sheets)
    proxy = Proxy(mesh, None, Sheets(counts, opacity.astype(np.float32)))
    tiny = tiny_scene(textures=0)
    appearance = replace(tiny.appearance, planes=(Plane(mean.astype(np.float32), ()),))
    return replace(tiny, proxy=proxy, appearance=appearance)


def drawn(scene: Scene, **options):
    return Renderer(scene).draw(facing(), MEAN_ONLY, **options)


@pytest.mark.parametrize("samples", [None, 1, 3])
@pytest.mark.parametrize("filter", ["bilinear", "bicubic"])
def test_a_half_transparent_sheet_over_an_opaque_one(filter, samples):
    scene = painted([[(square(0, 0, 0.5), RED, 1.0)], [(square(-0.5, 0.25, 0.75), BLUE, 0.5)]])
    picture = drawn(scene, filter=filter, samples=samples, background=GREY)
    shown = [RED, 0.5 * RED + 0.5 * BLUE, 0.5 * BLUE + 0.5 * GREY, GREY]
    expected = np.repeat(shown, SIZE // 4, axis=0)[None].repeat(SIZE, axis=0)
    np.testing.assert_allclose(picture.image, expected, atol=ROUNDING)
    coverage = np.repeat([1, 1, 0.5, 0], SIZE // 4)[None].repeat(SIZE, axis=0)
    np.testing.assert_allclose(picture.coverage, coverage, atol=ROUNDING)
    assert (picture.covered == (coverage == 1)).all()


def test_the_order_of_sheets_counts_and_not_their_depth():
    near, far = (square(-0.5, 0, 1), RED, 0.25), (square(0, 0, 1), BLUE, 0.75)
    np.testing.assert_allclose(drawn(painted([[near], [far]])).image[0, 0], 0.25 * 0.25 * RED + 0.75 * BLUE, atol=1e-6)
    np.testing.assert_allclose(drawn(painted([[far], [near]])).image[0, 0], 0.25 * RED + 0.75**2 * BLUE, atol=1e-6)


@pytest.mark.parametrize("first", [0, 1])
def test_within_a_sheet_the_nearest_point_alone_is_shown(first):
    both = [(square(-0.5, 0, 0.5), RED, 0.25), (square(0, 0, 1), BLUE, 0.75)]
    picture = drawn(painted([[both[first], both[1 - first]]]), background=GREY)
    np.testing.assert_allclose(picture.image[3, 3], 0.25 * RED + 0.75 * GREY, atol=ROUNDING)
    np.testing.assert_allclose(picture.image[3, -3], 0.75 * BLUE + 0.25 * GREY, atol=ROUNDING)


def test_opacity_is_cut_off_after_filtering():
    scene = painted([[(square(0, 0, 1), RED, 1.0)], [(square(-0.2, 0, 1), BLUE, 0.5)]])
    sheets = scene.proxy.sheets
    beyond = replace(scene, proxy=replace(scene.proxy, sheets=replace(sheets, opacity=3 * sheets.opacity - 1)))
    np.testing.assert_allclose(drawn(beyond).image[4, 4], 0.5 * RED + 0.5 * BLUE, atol=ROUNDING)
    # half of twice the opacity and half of none are all of it, not half of it
    steps = np.tile(np.float32([2.0, 0.0]), (2 * SIZE, SIZE // 2))
    mixed = replace(scene, proxy=replace(scene.proxy, sheets=replace(sheets, opacity=steps)))
    at_middles = replace(mixed, proxy=replace(mixed.proxy, mesh=replace(mixed.proxy.mesh, uv=np.tile(
        np.float32([[0.5, 0.3]]), (len(mixed.proxy.mesh.uv), 1)
    ))))  # fmt: skip
    np.testing.assert_allclose(drawn(at_middles, filter="bilinear").coverage, 1, atol=ROUNDING)


@pytest.mark.parametrize("filter", ["bilinear", "bicubic"])
@pytest.mark.parametrize("samples", [1, 2, 3])
@pytest.mark.parametrize("channels, size", [(3, None), (3, (20, 90)), (1, None), (5, None)])
def test_pictures_are_the_definition(filter, samples, channels, size):
    scene = stacked(tiny_scene(channels=channels, textures=3, size=64), bumpy_square(12), size=size)
    camera, weights = viewpoint(scene, at=(0.3, 0.1))
    camera, options = camera.resize(130, 97), {"filter": filter, "samples": samples, "background": (0.2,)}
    picture = Renderer(scene).draw(camera, weights, **options)
    expected, coverage = composited(scene, weights, camera, **options)
    assert 0.02 < (coverage > 0.999).mean() < (coverage > 0.001).mean() < 0.95
    np.testing.assert_allclose(picture.image, expected, atol=HIDDEN)
    np.testing.assert_allclose(picture.coverage, coverage, atol=HIDDEN)


def test_planes_of_several_densities_and_many_sheets():
    scene = stacked(layered_scene(), bumpy_square(8), count=7, size=(50, 70), step=0.1)
    camera, weights = viewpoint(scene, at=(-0.4, 0.6))
    picture = Renderer(scene).draw(camera, weights, samples=1)
    expected, coverage = composited(scene, weights, camera)
    np.testing.assert_allclose(picture.image, expected, atol=HIDDEN)
    np.testing.assert_allclose(picture.coverage, coverage, atol=HIDDEN)


def test_smaller_pictures_take_more_samples_and_larger_ones_one():
    scene = stacked(tiny_scene(textures=2, size=128), bumpy_square(12))
    renderer, weights = Renderer(scene), view_weights(scene, (0.1, 0.2))
    for size in ((24, 20), (96, 80)):
        camera = scene.rig.cameras[2].resize(*size)
        side = renderer.grid_side(camera)
        assert side == (1 if size[0] > 48 else 2)
        asked = renderer.draw(camera, weights, samples=side)
        np.testing.assert_array_equal(renderer.draw(camera, weights).image, asked.image)


def test_tiles_where_nothing_is_opaque_are_not_composed():
    scene = stacked(tiny_scene(textures=2, size=128), bumpy_square(12), count=2)
    sheets = scene.proxy.sheets
    half = np.where(np.arange(128)[:, None] < 64, sheets.opacity, 0).astype(np.float32)
    cleared = replace(scene, proxy=replace(scene.proxy, sheets=replace(sheets, opacity=half)))
    camera, weights = viewpoint(cleared, at=(0.0, 0.0))
    renderer = Renderer(cleared)
    assert not renderer.texture(weights)[80:].any() and renderer.texture(weights)[:64].any()
    expected, coverage = composited(cleared, weights, camera)
    picture = renderer.draw(camera, weights, samples=1)
    np.testing.assert_allclose(picture.image, expected, atol=HIDDEN)
    np.testing.assert_allclose(picture.coverage, coverage, atol=HIDDEN)


def test_sheets_that_are_nowhere_opaque_show_the_background():
    scene = painted([[(square(0, 0, 1), RED, 0.0)], [(square(-0.5, 0, 1), BLUE, 0.0)]])
    picture = drawn(scene, background=GREY)
    assert not picture.coverage.any() and (picture.image == GREY.astype(np.float32)).all()


def test_a_harmonised_cameras_own_colours():
    scene = stacked(tiny_scene(textures=3, size=64), bumpy_square(12))
    colours = np.tile(np.array([[[1.1, 0.9, 1.2], [0.02, -0.03, 0.05]]], np.float32), (5, 1, 1))
    scene = replace(scene, appearance=replace(scene.appearance, colours=colours))
    camera, weights = viewpoint(scene, camera="view_01")
    picture = Renderer(scene).draw(camera, weights, samples=1, background=GREY)
    texture_scene = replace(scene, appearance=replace(scene.appearance, colours=None))
    plain, coverage = composited(texture_scene, weights, camera)
    surface = (plain - coverage[..., None] * colours[0, 1]) / colours[0, 0]
    np.testing.assert_allclose(picture.image, surface + (1 - coverage[..., None]) * GREY, atol=2 * HIDDEN)


def test_any_number_of_threads_and_used_buffers_make_the_same_picture():
    scene = stacked(tiny_scene(textures=5, size=64), bumpy_square(12))
    renderer, found = Renderer(scene), set()
    camera, weights = viewpoint(scene, at=(0.3, 0.1))
    for count in (1, 3, 2):
        set_threads(count)
        try:
            renderer.draw(scene.rig.cameras[0].resize(300, 200), weights)
            found.add(renderer.draw(camera.resize(300, 200), weights).image.tobytes())
        finally:
            set_threads(None)
    assert len(found) == 1


def levels_apart(one, other):
    return np.abs(one.to_uint8().astype(int) - other.to_uint8())


@pytest.mark.parametrize("filter", ["bilinear", "bicubic"])
@pytest.mark.parametrize("base, size", [(viewer_scene, None), (layered_scene, (50, 70))])
@pytest.mark.parametrize("count", [1, 3, 8])
def test_opengl_agrees_with_the_software_renderer(context, filter, base, size, count):
    scene = stacked(base(), bumpy_square(24), count, size, step=0.1)
    camera, weights = viewpoint(scene, at=(0.37, -0.21))
    renderer = OpenGLRenderer(scene, filter=filter, context=context)
    software = Renderer(scene).draw(camera, weights, filter=filter, samples=1, background=GREY)
    for given in (weights, None):
        picture = renderer.draw(camera, given, background=GREY)
        away = levels_apart(picture, software)
        assert (away > 2).mean() < 1e-3 and away.mean() < 0.6, ((away > 2).mean(), away.mean())
        assert (np.abs(picture.coverage - software.coverage) > 0.01).mean() < 1e-3


@pytest.mark.parametrize("first", [0, 1])
def test_opengl_shows_of_a_sheet_what_is_nearest(context, first):
    both = [(square(-0.5, 0, 0.5), RED, 0.25), (square(0, 0, 1), BLUE, 0.75)]
    scene = painted([[(square(-0.7, 0, 1), GREY, 0.5)], [both[first], both[1 - first]]])
    camera = facing()
    picture = OpenGLRenderer(scene, multisample=4, context=context).draw(camera, MEAN_ONLY)
    np.testing.assert_allclose(picture.image[3, 3], 0.25 * RED + 0.75 * 0.5 * GREY, atol=1 / 255)
    np.testing.assert_allclose(picture.image[3, -3], 0.75 * BLUE + 0.25 * 0.5 * GREY, atol=1 / 255)
    np.testing.assert_allclose(picture.coverage[3, [3, -3]], (1 - 0.75 * 0.5, 1 - 0.25 * 0.5), atol=1 / 255)


def test_opengl_reads_opacity_from_mip_maps_too(context):
    scene = stacked(viewer_scene(), bumpy_square(24), 2)
    camera, weights = viewpoint(scene, at=(0.0, 0.0))
    renderer = OpenGLRenderer(scene, context=context)
    large, small = renderer.draw(camera, weights), renderer.draw(camera.resize(80, 60), weights)
    average = large.coverage.reshape(60, 4, 80, 4).mean(axis=(1, 3))
    assert np.abs(small.coverage - average).mean() < 0.02
