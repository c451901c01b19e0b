"""The fit: its operators are the renderer's and their transposes, and it finds what is there to be found."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.coding.pictures.pictures_10bit import svt_coder
from eigenfield.core.appearance import Plane
from eigenfield.core.errors import OptionError
from eigenfield.core.proxy import Proxy
from eigenfield.encoding import Target
from eigenfield.encoding.fitted.colour import LUMA, split_matrix, to_rgb
from eigenfield.encoding.fitted.fit import Pixels, PlaneSettings, Turns, code_plane, coded_psnr, fit_plane
from eigenfield.encoding.fitted.kernels import (
    SHARE_ONE,
    add_laplacian,
    adjoint,
    forward,
    robust_weights,
    squares_of,
    target,
)
from eigenfield.encoding.fitted.model import Block, PlaneModel, make_composer
from eigenfield.encoding.fitted.normal_kernels import multiply, multiply_both
from eigenfield.encoding.fitted.observations import FitData, open_fit_data, open_subsampled, with_robust_weights
from eigenfield.encoding.fitted.passes import psnr_of, render_and_backproject
from eigenfield.encoding.fitted.planes import fitted_textures
from eigenfield.encoding.fitted.rate import Rate
from eigenfield.encoding.fitted.solve import fit_textures, fit_weights, measure_scales, residual, whiten
from eigenfield.encoding.fitted.start import _residual_map, open_residual_maps, principal_weights
from eigenfield.encoding.options import PRESETS
from eigenfield.evaluation import evaluate
from eigenfield.gltf import encode_scene, parts, save, validate
from eigenfield.imaging.metrics import psnr, to_codes
from eigenfield.rendering import Renderer, ViewWeights, camera_weights
from eigenfield.rendering.software.drawing import make_surface
from eigenfield.runtime.parallel import set_threads
from support.observations import InMemory
from support.scenes import bumpy_square, row_grid, smooth_pictures, tiny_scene, unit_weights

SIDE, GRID = 64, (40, 36)
RGB = np.eye(3, dtype=np.float32)
CAMERAS = row_grid(9, 72, 60)


def true_model(cameras: int, seed: int = 0) -> PlaneModel:
    """A mean and three components of luma and the rest, far from the borders of 0..1."""
    mean = 0.5 + 0.2 * smooth_pictures(1, SIDE, SIDE, 3, seed)[0].transpose(2, 0, 1)
    textures = 0.06 * smooth_pictures(3, *GRID, 3, seed + 1).transpose(0, 3, 1, 2)
    block = Block((0, GRID[0], 0, GRID[1]), np.ascontiguousarray(textures), unit_weights(cameras, 3, seed + 2))
    return PlaneModel(RGB, np.ascontiguousarray(mean.astype(np.float32)), GRID, [block])


def whole(drawn):
    """A picture whose pixels at the border show nothing but the surface, as a photograph's."""
    return drawn.image / np.maximum(drawn.coverage, 0.25)[..., None]


def middles(data, index):
    """(h, w, 2) of a footprint: of each pixel's points the middle, -1 where there is none."""
    counts, points, _ = data.footprint(index)
    pixels = np.repeat(np.arange(counts.size), counts.reshape(-1))
    sums = np.stack([np.bincount(pixels, points[:, k], counts.size) for k in range(2)], axis=1)
    found = np.where(counts.reshape(-1, 1) > 0, sums / np.maximum(counts.reshape(-1, 1), 1), -1)
    return found.reshape(*counts.shape, 2)


@pytest.fixture(scope="module")
def world():
    """Nine cameras that see what `true_model` draws, rounded to codes."""
    mesh = bumpy_square(12)
    model = true_model(9)
    surface = make_surface(mesh, SIDE, SIDE)
    composer = make_composer(surface, model)
    scene = replace(tiny_scene(cameras=9), proxy=Proxy(mesh), rig=replace(tiny_scene(cameras=9).rig, cameras=CAMERAS))
    pictures = []
    for index, camera in enumerate(CAMERAS):
        texture = np.zeros((3, SIDE, SIDE), np.float32)
        composer.grid.up(model.sums(slice(index, index + 1))[0], texture)
        texture += model.mean
        plain = replace(scene.appearance.planes[0], mean=np.ascontiguousarray(texture.transpose(1, 2, 0)), bases=())
        drawn = Renderer(replace(scene, appearance=replace(scene.appearance, planes=(plain,)))).draw(
            camera, ViewWeights()
        )
        pictures.append(to_codes(whole(drawn)).astype(np.float32) / 255)
    with open_fit_data(CAMERAS, InMemory(pictures), Proxy(mesh), (SIDE, SIDE)) as data:
        yield data, composer, model


def test_the_fit_draws_what_the_renderer_draws(world):
    data, composer, model = world
    for how, most in ((composer, 0.5 / 255), (None, 0.8 / 255)):  # rounding to codes alone: a deviation of 0.29
        found = residual(data, model, composer=how)
        assert (np.sqrt(found.squares / found.pixels / 3) < most).all()
        assert (found.pixels > 1000).all()


def test_subsampled_pixels_are_some_of_all(world):
    data, _, _ = world
    with open_subsampled(data, 2) as some:
        assert len(some) == len(data)
        for index in range(len(data)):
            (counts, points, _), (fewer, left, _) = data.footprint(index), some.footprint(index)
            assert counts.sum() == len(points) and fewer.sum() == len(left)
            rows, columns = slice(7 * index // 2 % 2, None, 2), slice(index % 2, None, 2)
            codes = [one.observations.codes_of(index) for one in (some, data)]
            np.testing.assert_array_equal(codes[0], codes[1][rows, columns])
            np.testing.assert_array_equal(fewer, counts[rows, columns])
            np.testing.assert_array_equal(middles(some, index), middles(data, index)[rows, columns])
            assert 0.2 < codes[0].size / codes[1].size < 0.3
    with open_subsampled(data, 1) as same:
        assert same is data


@settings(max_examples=30)
@given(st.integers(2, 40), st.integers(2, 40), st.integers(1, 3), st.booleans(), st.integers(0, 2**31))
def test_drawing_and_its_transpose(height, width, channels, opaque, seed):
    random = np.random.default_rng(seed)
    size = (int(random.integers(2, 60)), int(random.integers(2, 60)))
    counts = random.choice(np.array([0, 1, 1, 2, 3, 4], np.uint8), (7, 9))
    points = random.uniform(0, 1, (int(counts.sum()), 2)).astype(np.float32) * np.float32([size[1] - 1, size[0] - 1])
    shares = random.integers(0, SHARE_ONE // 4, 0 if opaque else len(points)).astype(np.uint16)
    owners = np.repeat(np.arange(counts.size), counts.reshape(-1))
    parts = np.where(counts == 1, 4, counts) / 4
    if not opaque:
        parts = np.bincount(owners, shares / SHARE_ONE, counts.size).reshape(counts.shape)
    covered = counts > 0
    texture = random.normal(size=(channels, height, width)).astype(np.float32)
    image = random.normal(size=(channels, 7, 9)).astype(np.float32) * covered
    codes = random.integers(0, 256, (7, 9)).astype(np.uint8)
    weight = codes / np.float32(255)
    drawn, back = np.zeros_like(image), np.zeros_like(texture)
    forward(counts, points, shares, size, texture, np.float32(1), drawn)
    adjoint(counts, points, shares, size, image, codes, back)
    assert float((drawn * weight * image).sum()) == pytest.approx(float((texture * back).sum()), rel=1e-3, abs=1e-3)
    product, other = np.zeros_like(texture), random.normal(size=(channels, width, height)).astype(np.float32)
    other_product = np.zeros_like(other)
    back[:] = 0
    adjoint(counts, points, shares, size, drawn, codes, back)
    multiply(counts, points, shares, size, codes, texture, product)
    np.testing.assert_allclose(product, back, rtol=1e-4, atol=1e-5)
    both, back, other_back = np.zeros_like(texture), np.zeros_like(texture), np.zeros_like(other)
    expected = np.zeros_like(drawn)
    forward(counts, points, shares, size, texture, np.float32(1), expected)
    forward(counts, points, shares, size, other, np.float32(1), expected)
    adjoint(counts, points, shares, size, expected, codes, back)
    adjoint(counts, points, shares, size, expected, codes, other_back)
    multiply_both(counts, points, shares, size, codes, texture, other, both, other_product)
    np.testing.assert_allclose(both, back, rtol=1e-4, atol=1e-5)
    np.testing.assert_allclose(other_product, other_back, rtol=1e-4, atol=1e-5)
    squares, total = squares_of(counts, drawn, codes)
    assert squares == pytest.approx(float((weight * drawn * drawn).sum()), rel=1e-4)
    assert total == pytest.approx(weight[covered].sum(), rel=1e-5)
    ones = np.zeros_like(drawn)
    forward(counts, points, shares, size, np.ones_like(texture), np.float32(1), ones)
    np.testing.assert_allclose(ones, np.broadcast_to(parts, ones.shape), atol=1e-5)
    aimed = np.zeros((3, 7, 9), np.float32)
    target(counts, points, shares, np.full((7, 9, 3), 200, np.uint8), np.eye(3, 4, dtype=np.float32), aimed)
    np.testing.assert_allclose(aimed, 200 * ones[:1].repeat(3, axis=0), rtol=1e-4)


def test_the_laplacian_is_that_of_a_quadratic():
    y, x = np.mgrid[0:9, 0:9].astype(np.float32)
    quadratic, out = (x * x + 2 * y * y)[None], np.ones((1, 9, 9), np.float32)
    product = add_laplacian(quadratic, np.float32(0.5), out)
    np.testing.assert_allclose(out[0, 1:-1, 1:-1], 1 - 3)  # -(2 + 4) / 2
    assert out.sum() == pytest.approx(81, abs=1e-3)
    assert product == pytest.approx(float((quadratic * out).sum()), rel=1e-5)


def test_the_weights_of_known_textures_are_found(world):
    data, _, model = world
    true = model.blocks[0].weights
    guess = PlaneModel(RGB, model.mean, GRID, [Block(model.blocks[0].rectangle, model.blocks[0].textures, true * 0)])
    fit_weights(data, guess, 12)
    np.testing.assert_allclose(guess.blocks[0].weights, true, atol=0.05)


def test_mean_and_textures_of_known_weights_draw_the_photographs(world):
    data, _, model = world
    block = model.blocks[0]
    guess = PlaneModel(RGB, np.full_like(model.mean, 0.5), GRID, [replace_textures(block, block.textures * 0)])
    before = residual(data, guess).squares.sum()
    fit_textures(data, guess, measure_scales(data, guess), 25)
    assert residual(data, guess).squares.sum() < before / 1000


def test_frames_that_share_their_weights_are_decomposed_by_the_sum_of_their_gram_matrices(world):
    """As all their maps below each other are, by the singular value decomposition, of which nothing better exists."""
    data, _, model = world
    scales, rectangle = measure_scales(data, model), (0, GRID[0], 0, GRID[1])
    frames = [PlaneModel(RGB, np.full_like(model.mean, grey), GRID, []) for grey in (0.2, 0.7)]
    with ExitStack() as stack:
        opened = [stack.enter_context(open_residual_maps(data, one, scales, rectangle, False)) for one in frames]
        gram = np.sum([maps.gram() for maps in opened], axis=0)
        stacked = np.concatenate([maps.values * maps.share for maps in opened], axis=1).astype(np.float64)
        np.testing.assert_allclose(gram, stacked @ stacked.T, rtol=1e-4, atol=1e-4 * gram.max())
        values = np.linalg.svd(stacked, compute_uv=False)
        for count in (1, 4):
            weights = principal_weights(gram, count)
            np.testing.assert_allclose(weights.T @ weights / len(data), np.eye(count), atol=1e-6)
            shown = [np.tensordot(weights, maps.textures(weights), 1).reshape(len(data), -1) for maps in opened]
            left = sum(
                np.square((maps.values - one) * maps.share).sum() for maps, one in zip(opened, shown, strict=True)
            )
            assert left == pytest.approx(np.square(values[count:]).sum(), rel=1e-3)


def replace_textures(block: Block, textures: np.ndarray) -> Block:
    return Block(block.rectangle, textures, block.weights)


def test_whitening_changes_no_sum_and_orders_by_strength(world):
    data, _, model = world
    block = model.blocks[0]
    mixed = np.array([[1, 0.4, 0], [0.2, 2, 0.1], [0, 0.3, 0.7]], np.float32)
    textures = np.tensordot(np.linalg.inv(mixed), block.textures, 1).astype(np.float32)
    skewed = PlaneModel(RGB, model.mean, GRID, [Block(block.rectangle, textures, block.weights @ mixed)])
    before = skewed.sums(slice(0, 9))
    scales = measure_scales(data, skewed)
    whiten(skewed, scales)
    np.testing.assert_allclose(skewed.sums(slice(0, 9)), before, atol=1e-4)
    weights = skewed.blocks[0].weights
    np.testing.assert_allclose(weights.T @ weights / 9, np.eye(3), atol=1e-4)
    energy = (np.square(skewed.blocks[0].textures) * scales.coarse).sum(axis=(1, 2, 3))
    assert (np.diff(energy) < 0).all()


def settings_of(textures: int = 3) -> PlaneSettings:
    return PlaneSettings(RGB, (SIDE, SIDE), (64, 64), textures)


def fit_and_code(data: FitData, rounds: int) -> tuple[Plane, float, float]:
    """The coded plane, dB before coding and after."""
    fit = fit_plane(Pixels(data, data, data), settings_of(), "test", Turns(rounds))
    plane = code_plane(fit, Rate(1e-3, 1e-3, svt_coder(8), svt_coder(8))).value
    return plane, fit.uncoded, coded_psnr(fit, plane)


def test_what_few_cameras_in_no_array_see_is_smoother(world):
    data, _, _ = world
    fits = [
        fit_plane(Pixels(data, data, data), replace(settings_of(), scattered=on), "test", Turns(1)) for on in (0, 1)
    ]
    rough = [np.square(np.diff(fit.model.mean)).sum() for fit in fits]
    assert rough[1] < rough[0]
    mean, components = fits[1].scales.smooth
    assert mean > 2 * fits[0].scales.smooth[0] and components > 2 * fits[0].scales.smooth[1]
    assert fits[1].uncoded > fits[0].uncoded - 1


def test_what_a_camera_in_no_array_does_not_see_fades_to_the_mean(world):
    data, _, _ = world
    masks = np.full(len(data.observations.codes), 255, np.uint8)
    h, w = data.observations.shapes[0]
    masks[: h * w].reshape(h, w)[:, w // 2 :] = 0  # the first camera sees the left half
    half = replace(data, observations=replace(data.observations, masks=masks))
    model = PlaneModel(RGB, np.zeros((3, SIDE, SIDE), np.float32), (64, 64), [])
    cut, fading = (
        _residual_map(half, model, 0, np.float32(0.2), on)[:, 16:48].mean(axis=(0, 1)) for on in (False, True)
    )
    last = int(np.flatnonzero(np.abs(cut) > 1e-6).max())  # of the columns that its pixels reach
    beyond = fading[last + 1 : last + 12]
    assert (cut[last + 1 :] == 0).all() and beyond[0] > 0.6 * fading[last - 1]
    assert (np.diff(beyond) <= 0).all() and beyond[-1] < 0.05


def test_a_fit_beats_its_start_and_is_what_is_drawn(world):
    data, _, _ = world
    (_, start, _), (plane, uncoded, coded) = (fit_and_code(data, rounds) for rounds in (0, 3))
    assert uncoded > start + 1
    assert coded > 38
    scene = replace(
        tiny_scene(cameras=9),
        proxy=Proxy(bumpy_square(12)),
        rig=replace(tiny_scene(cameras=9).rig, cameras=CAMERAS),
        appearance=replace(tiny_scene(cameras=9).appearance, planes=(plane,)),
    )
    drawn = [Renderer(scene).draw(camera, ViewWeights.one(i)) for i, camera in enumerate(CAMERAS)]
    photographs = [data.observations.codes_of(i) / np.float32(255) for i in range(9)]
    errors = [
        (d.image - d.coverage[..., None] * photograph)[d.coverage > 0.25]
        for d, photograph in zip(drawn, photographs, strict=True)
    ]
    assert np.mean([-10 * np.log10(np.square(e).mean()) for e in errors]) == pytest.approx(coded, abs=0.02)


def test_a_place_that_looks_different_from_everywhere_gets_textures_of_its_own(world):
    data, _, _ = world
    pictures = [data.observations.codes_of(i).astype(np.float32) / 255 for i in range(len(data))]
    lit = np.random.default_rng(4).uniform(0, 1, (len(data), 2, 2, 3)).astype(np.float32)
    with open_fit_data(CAMERAS, InMemory(pictures), Proxy(bumpy_square(12)), (SIDE, SIDE)) as plain:
        for index, picture in enumerate(pictures):
            rows, columns = np.clip((middles(plain, index) // 8).astype(int) - 3, -1, 2).transpose(2, 0, 1)
            inside = (rows >= 0) & (rows < 2) & (columns >= 0) & (columns < 2)
            picture[inside] = lit[index][rows[inside], columns[inside]]
    with open_fit_data(CAMERAS, InMemory(pictures), Proxy(bumpy_square(12)), (SIDE, SIDE)) as glitter:
        pixels = Pixels(glitter, glitter, glitter)
        alone = fit_plane(pixels, settings_of(), "test", Turns(1))
        fit = fit_plane(pixels, replace(settings_of(), local=5), "test", Turns(1))
    assert len(alone.model.blocks) == 1
    _, region = fit.model.blocks
    top, bottom, left, right = region.rectangle
    assert top <= 24 and left <= 24 and bottom >= 40 and right >= 40, region.rectangle  # all of it, little else
    assert region.textures.shape == (5, 3, bottom - top, right - left) and (bottom - top) * (right - left) < 0.3 * 64**2
    assert fit.uncoded > alone.uncoded + 3


def test_pixels_far_off_count_for_less(world):
    data, _, _ = world
    random = np.random.default_rng(2)
    pictures = [data.observations.codes_of(i).astype(np.float32) / 255 for i in range(len(data))]
    spoiled = [random.random(picture.shape[:2]) < 0.002 for picture in pictures]
    for picture, glints in zip(pictures, spoiled, strict=True):
        picture[glints] = 1.0

    def reached(work: FitData) -> float:
        model = fit_plane(Pixels(glinting, work, work), settings_of(), "test", Turns(4)).model
        found = residual(data, model)
        return psnr_of(found.squares, found.pixels, 3)

    with open_fit_data(CAMERAS, InMemory(pictures), Proxy(bumpy_square(12)), (SIDE, SIDE)) as glinting:
        with with_robust_weights(glinting) as robust:
            found = reached(robust)
            weights = np.stack([robust.observations.weights(i) for i in range(9)])
            covered = np.stack([robust.footprint(i)[0] > 0 for i in range(9)])
        assert found > reached(glinting) + 0.7
    glints = np.stack(spoiled)
    assert np.median(weights[glints & covered]) < 128 and np.median(weights[~glints & covered]) > 240


def test_what_a_pixel_counts_for():
    image = np.array([[[0.0, 0.3, 0.1]], [[0.0, 0.4, 0.0]]], np.float32)
    out = np.zeros((1, 3), np.uint8)
    robust_weights(image, np.zeros((0, 0), np.uint8), np.float32(0.25), out)
    assert out.tolist() == [[255, 128, 245]]  # 1 / (1 + e^2 / 0.25)
    robust_weights(image, np.array([[0, 255, 100]], np.uint8), np.float32(0.25), out)
    assert out.tolist() == [[0, 128, 96]]


def test_components_that_are_not_worth_their_bytes_are_left_out(world):
    data, _, _ = world
    settings = replace(settings_of(), textures=8)  # of which the photographs have three
    fit = fit_plane(Pixels(data, data, data), settings, "test", Turns(1))
    counts, reached = [], []
    for step in (1e-3, 0.05, 1.0):
        plane = code_plane(fit, Rate(step, step, svt_coder(8), svt_coder(8))).value
        counts.append(sum(basis.count for basis in plane.bases))
        reached.append(coded_psnr(fit, plane))
    assert counts[0] >= 3 and counts[0] > counts[1] >= counts[2] == 0, counts
    assert reached[0] > reached[1] > reached[2]


def test_the_number_of_threads_changes_nothing(world):
    data, _, _ = world
    planes = []
    for threads in (1, 3):
        set_threads(threads)
        try:
            planes.append(fit_and_code(data, 1)[0])
        finally:
            set_threads(None)
    np.testing.assert_array_equal(planes[0].mean, planes[1].mean)
    np.testing.assert_array_equal(planes[0].bases[0].textures, planes[1].bases[0].textures)
    np.testing.assert_array_equal(planes[0].bases[0].weights, planes[1].bases[0].weights)


def test_what_a_mask_hides_does_not_count(world):
    data, composer, model = world
    pictures = [data.observations.codes_of(i).astype(np.float32) / 255 for i in range(len(data))]
    pictures[4][20:40, 20:50] = 1.0  # somebody walked by
    mask = np.ones(pictures[4].shape[:2], np.float32)
    mask[20:40, 20:50] = 0
    options = {
        "mean": model.mean, "textures": [model.blocks[0].textures], "weights": [model.blocks[0].weights],
        "photographs": True, "wanted": (False, False, False),
    }  # fmt: skip
    for hidden, good in ((None, False), (mask, True)):
        masked = InMemory(pictures, [hidden if index == 4 else None for index in range(9)])
        with open_fit_data(CAMERAS, masked, Proxy(bumpy_square(12)), (SIDE, SIDE)) as others:
            found = render_and_backproject(others, model, composer=composer, **options)
            assert (psnr_of(found.squares[4:5], found.pixels[4:5], 3) > 45) == good


def test_luma_and_chroma_make_the_colours_again():
    luma, chroma = split_matrix()
    random = np.random.default_rng(0).uniform(0, 1, (50, 3)).astype(np.float32)
    parts = random @ np.concatenate([luma, chroma]).T
    np.testing.assert_allclose(parts @ to_rgb().T, random, atol=1e-6)
    np.testing.assert_allclose(np.full(3, 0.3) @ chroma.T, 0, atol=1e-6)  # a grey has none
    np.testing.assert_allclose(parts[:, 0], random @ LUMA, atol=1e-6)


@pytest.mark.parametrize(("cameras", "expected"), [(2, 1), (20, 19), (81, 40), (1000, 96)])
def test_more_cameras_more_textures(cameras, expected):
    assert fitted_textures(cameras) == expected


def test_a_fitted_file_is_small_and_near_the_photographs(fitted):
    folder, output = fitted
    scene, capture = ef.load(output), open_capture(folder)
    assert validate(output) == []
    assert [plane.mean.shape[2] for plane in scene.appearance.planes] == [1, 2] and scene.appearance.to_rgb is not None
    assert scene.settings["fit"] == "photographs" and scene.settings["fitted"]["quality"] == 92
    paper = ef.encode(capture, proxy=folder / "proxy.ply", textures=4, fit="none")
    save(paper, output.parent / "plain.glb", quality=80)
    plain = ef.load(output.parent / "plain.glb")
    values = {"fit": [], "none": []}
    for index in range(len(capture)):
        for name, one in (("fit", scene), ("none", plain)):
            drawn = Renderer(one).draw(one.rig.cameras[index], camera_weights(one, index))
            values[name].append(
                psnr(to_codes(drawn.image), to_codes(capture.photograph(index).pixels), drawn.coverage > 0)
            )
    sizes = [parts(file) for file in (output, output.parent / "plain.glb")]
    pictures = [size["mean"] + size["textures"] for size in sizes]
    assert pictures[0] < pictures[1]
    assert np.mean(values["fit"]) > 41  # 43.5 the other way, with more bytes: so smooth a scene is easy for both


def test_saving_again_codes_nothing_twice(fitted, tmp_path):
    _, output = fitted
    save(ef.load(output), tmp_path / "again.glb")
    assert (tmp_path / "again.glb").read_bytes() == output.read_bytes()
    save(ef.load(output), tmp_path / "eight.glb", codec="png")
    first, again = ef.load(output), ef.load(tmp_path / "eight.glb")
    weights = ViewWeights.one(0)
    assert np.abs(Renderer(first).texture(weights) - Renderer(again).texture(weights)).mean() < 2 / 255


def test_a_fitted_scene_is_evaluated_without_texture_maps(fitted, run):
    folder, output = fitted
    figures = evaluate(ef.load(output), open_capture(folder))
    assert figures["image"]["encoded"]["psnr"] > 40
    assert figures["uv"] is None and figures["png_maps"] is None
    with pytest.raises(OptionError, match="no texture maps") as caught:
        evaluate(ef.load(output), open_capture(folder), curve="all")
    assert caught.value.code == "curve" and "--fit none" in caught.value.remedy
    code, said, _ = run("evaluate", output, folder)
    assert code == 0 and "none: the scene was fitted" in said


@pytest.mark.parametrize(
    ("options", "code"),
    [({"align": True}, "fit"), ({"uv_ssim": 0.9}, "fit"), ({"fit": "magic"}, "fit"),
     ({"quality": 101}, "quality"), ({"preset": "huge"}, "preset"), ({"keep_maps": "maps"}, "fit"),
     ({"target": Target(size=50_000), "fit": "none"}, "target"), ({"target": Target(psnr=30), "quality": 50}, "target"),
     ({"target": Target()}, "target"), ({"target": Target(ssim=0.9, psnr=30)}, "target")],
)  # fmt: skip
def test_options_that_do_not_go_with_a_fit(fitted, options, code):
    folder, _ = fitted
    with pytest.raises(OptionError) as caught:
        ef.encode(open_capture(folder), proxy=folder / "proxy.ply", **{"fit": "photographs", **options})
    assert caught.value.code == code


@pytest.mark.slow
def test_presets_differ_in_bytes(fitted):
    folder, _ = fitted
    options = {"proxy": folder / "proxy.ply", "textures": 4, "fit": "photographs"}
    sizes = [len(encode_scene(ef.encode(open_capture(folder), **options, preset=name))) for name in PRESETS]
    assert sizes == sorted(sizes) and sizes[0] < sizes[-1]
