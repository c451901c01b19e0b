"""Drawing: equation 8 and the filters against plain NumPy, coverage, samples, threads."""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import eigenfield as ef
import reference
from eigenfield.core.appearance import Basis, Plane
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.raster import rasterise_view
from eigenfield.rendering import Renderer, ViewWeights, draw_texture, path_points, view_weights
from eigenfield.rendering.software.drawing import (
    MULTISAMPLE_OFFSETS_PX,
    Framebuffer,
    choose_sampling,
    make_surface,
    median_footprint,
    rasterise_surface,
    smooth_edges,
)
from eigenfield.runtime.parallel import set_threads
from support.scenes import tiny_scene

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
    basis = scene.appearance.planes[0].bases[0]
    if stored == "codes":
        codes = np.random.default_rng(2).integers(0, 256, basis.textures.shape, dtype=np.uint8)
        ones = np.ones_like(basis.scale)
        basis = Basis(codes, 0.002 * ones, 128 * ones, basis.weights)
        scene = replace(
            scene, appearance=replace(scene.appearance, planes=(Plane(scene.appearance.planes[0].mean, (basis,)),))
        )
    weights = view_weights(scene, (0.2, -0.4))
    for count in (None, 0, 3):
        part = basis.truncate(basis.count if count is None else count)
        expected = reference.texture(
            scene.appearance.planes[0].mean.astype(float), part.values(), weights.blend(part.weights)
        )
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
        ({"samples": 2.0}, "give a whole number"),
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


@pytest.mark.parametrize("filter", ["bilinear", "bicubic"])
@pytest.mark.parametrize(("height", "width"), [(20, 37), (1, 50), (16, 1), (33, 16)])
def test_atlases_of_any_size_are_sampled_right(filter, height, width):
    """Sizes that are no multiple of a tile, and single rows and columns: clamped at the border, as in NumPy."""
    texture = np.random.default_rng(4).random((height, width, 3)).astype(np.float32)
    picture = draw_texture(SQUARE, texture, facing(64, 48), filter=filter, samples=1)
    y, x = np.mgrid[:48, :64]
    row = np.clip((y + 0.5) / 48 * height - 0.5, 0, height - 1)
    column = np.clip((x + 0.5) / 64 * width - 0.5, 0, width - 1)
    np.testing.assert_allclose(picture.image, sampled(texture, column, row, filter), atol=2e-4)


def test_bases_of_a_plane_are_summed_and_planes_are_joined():
    scene = tiny_scene(textures=6)
    (plane,) = scene.appearance.planes
    (basis,) = plane.bases
    whole = Renderer(scene).draw(scene.rig.cameras[1], ViewWeights.one(1)).image
    rest = Basis(basis.textures[2:], basis.scale[2:], basis.zero[2:], basis.weights[:, 2:])
    halves = replace(
        scene, appearance=replace(scene.appearance, planes=(Plane(plane.mean, (basis.truncate(2), rest)),))
    )
    np.testing.assert_allclose(Renderer(halves).draw(scene.rig.cameras[1], ViewWeights.one(1)).image, whole, atol=1e-6)

    def channels(part):
        textures = np.ascontiguousarray(basis.textures[..., part])
        return Plane(
            plane.mean[..., part], (Basis(textures, basis.scale[:, part], basis.zero[:, part], basis.weights),)
        )

    apart = replace(scene, appearance=replace(scene.appearance, planes=(channels(slice(0, 1)), channels(slice(1, 3)))))
    drawn = Renderer(apart).draw(scene.rig.cameras[1], ViewWeights.one(1), background=(0.1, 0.2, 0.3))
    expected = Renderer(scene).draw(scene.rig.cameras[1], ViewWeights.one(1), background=(0.1, 0.2, 0.3))
    np.testing.assert_allclose(drawn.image, expected.image, atol=1e-6)


def test_tiles_out_of_sight_are_not_needed():
    """A close-up composes only what it shows, and shows what the whole picture shows there."""
    scene = tiny_scene(textures=4, size=128)
    renderer, weights = Renderer(scene), ViewWeights.one(2)
    camera = scene.rig.cameras[2]
    near = replace(
        camera, K=np.diag([6.0, 6, 1]) @ camera.K - np.array([[0, 0, 5.0 * 24], [0, 0, 5.0 * 20], [0, 0, 0]])
    )
    sampling = choose_sampling(renderer._surface, near)
    frame = Framebuffer(renderer._surface, near.height, near.width, sampling)
    rasterise_surface(renderer._surface, near, sampling, frame)
    assert 0 < frame.needed.sum() < 0.4 * frame.needed.size
    whole = draw_texture(scene.proxy.mesh, renderer.texture(weights), near, samples=1)
    np.testing.assert_allclose(renderer.draw(near, weights, samples=1).image, whole.image, atol=1e-6)


def hidden_triangles(count=60):
    """Triangles that hide each other, and a camera in front of them."""
    random = np.random.default_rng(5)
    middle = random.uniform([-0.5, -0.4, 2], [0.5, 0.4, 5], (count, 1, 3))
    corners = (middle + random.uniform(-0.5, 0.5, (count, 3, 3))).reshape(-1, 3).astype(np.float32)
    uv = random.uniform(0.05, 0.95, (3 * count, 2)).astype(np.float32)
    mesh = Mesh(corners, np.arange(3 * count, dtype=np.int32).reshape(-1, 3), uv)
    return mesh, Camera(np.array([[150.0, 0, 60], [0, 150, 45], [0, 0, 1]]), np.eye(3), np.zeros(3), 120, 90)


@pytest.mark.parametrize("filter", ["bilinear", "bicubic"])
def test_edges_are_the_mean_of_four_samples_and_the_rest_is_drawn_once(filter):
    mesh, camera = hidden_triangles()
    texture = np.random.default_rng(3).uniform(0.2, 0.8, (32, 32, 3)).astype(np.float32)
    behind = (0.1, 0.9, 0.4)
    smooth = draw_texture(mesh, texture, camera, filter=filter, background=behind)
    middle = draw_texture(mesh, texture, camera, filter=filter, background=behind, samples=1)
    four = []
    for right, down in MULTISAMPLE_OFFSETS_PX:
        shifted = replace(camera, K=camera.K - np.array([[0, 0, right], [0, 0, down], [0, 0, 0]]))
        four.append(draw_texture(mesh, texture, shifted, filter=filter, background=behind, samples=1))
    np.testing.assert_array_equal(smooth.coverage, np.mean([picture.coverage for picture in four], axis=0))
    mean = np.mean([picture.image for picture in four], axis=0)
    edge = (smooth.coverage > 0) & (smooth.coverage < 1)
    assert edge.mean() > 0.03
    np.testing.assert_allclose(smooth.image[edge], mean[edge], atol=2e-5)
    # elsewhere either; what lies apart in the atlas and what does not is told by more than rounding
    off = np.minimum(np.abs(smooth.image - mean).max(axis=2), np.abs(smooth.image - middle.image).max(axis=2))
    assert (off[~edge] > 1e-3).mean() < 5e-3
    inside = smooth.image[smooth.coverage == 1]
    assert (np.abs(inside - middle.image[smooth.coverage == 1]).max(axis=1) < 1e-4).mean() > 0.3


def test_a_picture_without_edges_is_drawn_once():
    texture = np.random.default_rng(0).uniform(0, 1, (SIZE, SIZE, 3)).astype(np.float32)
    smooth, middle = (draw_texture(SQUARE, texture, facing(), samples=samples) for samples in (None, 1))
    np.testing.assert_allclose(smooth.image, middle.image, atol=1e-6)
    assert (smooth.coverage == 1).all()


def flat(rows, columns, low, high):
    """A grid of triangles between two corners, (x, y, z), z running with y; its UVs are its rows and columns."""
    v, u = (part.reshape(-1) for part in np.mgrid[0 : 1 : (rows + 1) * 1j, 0 : 1 : (columns + 1) * 1j])
    shares = np.stack([u, v, v], axis=1)
    vertices = (np.array(low) + shares * (np.array(high) - low)).astype(np.float32)
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).reshape(-1)
    right, below = corner + 1, corner + columns + 1
    faces = np.stack([corner, below, right, right, below, below + 1], axis=1).reshape(-1, 3)
    return Mesh(vertices, faces.astype(np.int32), np.stack([u, v], axis=1).astype(np.float32))


@pytest.mark.parametrize("behind", [0.4, -0.5])
def test_a_slanted_floor_is_no_edge(behind):
    """Foreshortened, its pixels hold many times the texels of a usual one: still one place each. `behind`: where the
    floor ends, the second time behind the camera."""
    mesh = flat(40, 40, (-4, 0.5, behind), (4, 0.5, 12))
    camera = Camera(np.array([[100.0, 0, 64], [0, 100, 8], [0, 0, 1]]), np.eye(3), np.zeros(3), 128, 96)
    surface = make_surface(mesh, 512, 512)
    sampling = smooth_edges(2.0)
    frame = Framebuffer(surface, camera.height, camera.width, sampling)
    rasterise_surface(surface, camera, sampling, frame)
    shown = frame.inverse_depth[:, : camera.width] > 0
    parted = np.zeros_like(shown)
    for row, (first, last) in enumerate(frame.spans):
        parted[row, frame.multisampled[first:last]] = True
    assert shown.mean() > 0.5
    # below the far end's line, and inside the sides
    near = np.zeros_like(shown)
    near[24:-1, 40:88] = True
    assert shown[near].all() and not parted[near].any()
    assert parted.any()


def test_a_close_up_of_large_triangles_has_a_footprint():
    """No middle is in view, or none of those that are looked at first."""
    mesh = flat(1, 1, (-40, -40, 1), (40, 40, 1))
    fine = flat(300, 300, (-40, -40, 1), (40, 40, 1))
    camera = Camera(np.array([[300.0, 0, 64], [0, 300, 48], [0, 0, 1]]), np.eye(3), np.array([-0.6, 0.9, 0]), 128, 96)
    assert median_footprint(make_surface(fine, 512, 512), camera) == pytest.approx(512 / 80 / 300, rel=1e-3)
    for one in (mesh, fine):
        texture = np.random.default_rng(0).uniform(0, 1, (512, 512, 3)).astype(np.float32)
        smooth, middle = (draw_texture(one, texture, camera, samples=samples) for samples in (None, 1))
        np.testing.assert_allclose(smooth.image, middle.image, atol=1e-6)


@pytest.mark.skipif(sys.platform != "linux", reason="/proc")
def test_room_for_edges_takes_memory_only_where_they_are():
    surface = make_surface(SQUARE, SIZE, SIZE)
    before = resident()
    frame = Framebuffer(surface, 4096, 4096, smooth_edges(1.0))
    assert frame.subsamples.nbytes > 7e8 and frame.multisampled.nbytes > 6e7
    frame.subsamples[:, ::1000000] = 1
    assert resident() - before < 1e8


def resident():
    """Bytes of memory that this process holds."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


def test_what_is_drawn_is_what_the_rasteriser_finds():
    """On triangles that hide each other: the same coverage, and at each pixel the UV of the rasteriser's triangle."""
    mesh, camera = hidden_triangles()
    uv = mesh.uv
    raster = rasterise_view(mesh, camera)
    steps = (np.arange(256) + 0.5) / 256
    ramp = np.stack(np.broadcast_arrays(steps[None], steps[:, None], 0.5), axis=-1).astype(np.float32)
    picture = draw_texture(mesh, ramp, camera, filter="bilinear", samples=1)
    covered = raster.face >= 0
    np.testing.assert_array_equal(picture.coverage > 0, covered)
    row, column = np.nonzero(covered)
    face = raster.face[covered]
    places = np.stack([column + 0.5, row + 0.5, np.ones(len(row))], axis=-1)
    shares = np.einsum("nij,nj->ni", raster.edges[face], places)
    expected = np.einsum("ni,nik->nk", shares / shares.sum(axis=1, keepdims=True), uv[mesh.faces[face]])
    differs = np.abs(picture.image[covered][:, :2] - expected).max(axis=1) > 1e-3
    assert differs.mean() < 2e-3  # where two triangles cross, float32 may choose the other
