"""Exposure and white balance: fitted, taken out of the maps, kept in the file and given back."""

from __future__ import annotations

import dataclasses
import json

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.core.appearance import COLOUR_STEP
from eigenfield.core.errors import FormatError, OptionError
from eigenfield.encoding.atlas import make_atlas
from eigenfield.encoding.projected.harmonise import fit_colours, harmonised_map
from eigenfield.encoding.projected.project import texture_map
from eigenfield.evaluation import evaluate
from eigenfield.gltf import encode_scene, read_scene, save, validate
from eigenfield.imaging.png import png_bytes
from eigenfield.rendering import Renderer, ViewWeights, camera_colour, camera_weights, draw_texture
from support import glb_surgery
from support.captures import backdrop, shaded_texture, write_capture
from support.scenes import row_grid, tiny_scene

GAINS = np.array([0.8, 0.95, 1.1, 1.05, 0.9, 1.2, 1.0, 0.85, 1.15])
AS_THEY_ARE = np.tile(np.array([[1.0], [0.0]], np.float32), (9, 1, 3))  # gains and offsets
OFFSETS = np.array([0.02, -0.01, 0.0, 0.03, -0.03, 0.01, -0.02, 0.015, -0.015])


def exposed(folder, source, gains, offsets):
    """The capture in `source` as other exposures would show it: photograph (x - offset) / gain, 16 bits."""
    write_capture(folder)
    for index, path in enumerate(sorted((folder / "images").glob("*.png"))):
        picture = cv2.imread(str(source / "images" / path.name), cv2.IMREAD_UNCHANGED).astype(float) / 255
        own = (0.1 + 0.6 * picture - offsets[index]) / gains[index]
        assert own.min() > 0.01 and own.max() < 0.99
        cv2.imwrite(str(path), np.rint(own * 65535).astype(np.uint16))
    return folder


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return write_capture(tmp_path_factory.mktemp("plain") / "c")


@pytest.fixture(scope="module")
def still(tmp_path_factory):
    """A surface that looks the same from everywhere."""
    root = tmp_path_factory.mktemp("still")
    write_capture(root / "c")
    for index, camera in enumerate(row_grid(9, 64, 56)):
        picture = draw_texture(backdrop(), shaded_texture(0, 9), camera, samples=2)
        (root / "c" / "images" / f"view_{index:02d}.png").write_bytes(png_bytes(picture.image))
    offsets = {"gain": 0 * OFFSETS, "affine": OFFSETS}
    return {model: exposed(root / model, root / "c", GAINS, offset) for model, offset in offsets.items()}


@pytest.fixture(scope="module")
def folders(tmp_path_factory, plain):
    root = tmp_path_factory.mktemp("exposed")
    offsets = {"gain": 0 * OFFSETS, "affine": OFFSETS}
    return {
        "equal": exposed(root / "equal", plain, np.ones(9), np.zeros(9)),
        **{model: exposed(root / model, plain, GAINS, offset) for model, offset in offsets.items()},
    }


def encoded(folder, **options):
    return ef.encode(open_capture(folder), folder / "proxy.ply", textures=8, atlas=128, fit="none", **options)


@pytest.mark.parametrize("model", ["gain", "affine"])
def test_known_colours_are_found(still, model):
    scene = encoded(still[model], harmonise=model)
    gains, offsets = scene.appearance.colours[:, 0], scene.appearance.colours[:, 1]
    known = GAINS / np.exp(np.log(GAINS).mean())
    np.testing.assert_allclose(gains, np.repeat(known[:, None], 3, axis=1), rtol=0.01)
    np.testing.assert_allclose(np.exp(np.log(gains.astype(float)).mean(axis=0)), 1, atol=1e-3)
    if model == "affine":
        wanted = OFFSETS / np.exp(np.log(GAINS).mean())
        np.testing.assert_allclose(offsets, np.repeat((wanted - wanted.mean())[:, None], 3, axis=1), atol=0.004)
        np.testing.assert_allclose(offsets.mean(axis=0), 0, atol=1e-3)
    else:
        assert not offsets.any()


def test_gains_are_found_beneath_a_highlight_that_wanders(folders):
    scene = encoded(folders["gain"], harmonise="gain")
    known = GAINS / np.exp(np.log(GAINS).mean())
    np.testing.assert_allclose(scene.appearance.colours[:, 0], np.repeat(known[:, None], 3, axis=1), rtol=0.02)


def test_equal_exposures_stay_as_they_are(folders):
    """A highlight that wanders is no exposure."""
    without, scene = encoded(folders["equal"]), encoded(folders["equal"], harmonise="gain")
    np.testing.assert_allclose(scene.appearance.colours[:, 0], 1, atol=0.003)
    np.testing.assert_allclose(scene.appearance.planes[0].mean, without.appearance.planes[0].mean, atol=0.5 / 255)


def test_captured_cameras_get_their_own_exposure_back_and_viewpoints_a_mixture(folders):
    scene, capture = encoded(folders["gain"], harmonise="gain"), open_capture(folders["gain"])
    for index, name in enumerate(scene.rig.names):
        picture = ef.render(scene, camera=name)
        inside = picture.coverage > 0.999
        error = (picture.image - capture.photograph(index).pixels)[inside]
        assert np.sqrt(np.mean(error**2)) < 0.01
    common = dataclasses.replace(scene, appearance=dataclasses.replace(scene.appearance, mixed_colours=False))
    places = scene.rig.view_plane.coordinates([scene.rig.cameras[index].centre for index in (4, 5)])
    factors = 1 / scene.appearance.colours[4:6, 0]
    for part in (0, 0.3, 1):
        at = tuple((1 - part) * places[0] + part * places[1])
        seen, wanted = ef.render(scene, at=at).image, ef.render(common, at=at).image
        np.testing.assert_allclose(seen, wanted * ((1 - part) * factors[0] + part * factors[1]), atol=2e-5)


def test_fewer_textures_do_where_exposures_differ(folders):
    """One texture of eight is spared: what the exposures did is no longer in them."""

    def figures(**options):
        capture = open_capture(folders["gain"])
        scene = ef.encode(capture, folders["gain"] / "proxy.ply", textures=2, atlas=128, fit="none", **options)
        return evaluate(scene, capture)["image"]["encoded"]["psnr"]

    assert figures(harmonise="gain") > figures() + 1


def test_a_fit_to_one_exposure_takes_fewer_bytes(still):
    capture, made = open_capture(still["affine"]), {}
    for model in ("none", "affine"):
        scene = ef.encode(capture, still["affine"] / "proxy.ply", textures=3, atlas=64, quality=80, harmonise=model)
        assert scene.settings.get("harmonise", "none") == model
        data = encode_scene(scene)
        again = read_scene(data)
        made[model] = len(data), evaluate(again, capture)["image"]["encoded"]["psnr"]
        if model == "affine":
            assert (again.appearance.colours == scene.appearance.colours).all() and again.appearance.mixed_colours
    assert made["affine"][0] < made["none"][0] and made["affine"][1] > made["none"][1] - 0.1


def test_held_out_cameras_have_no_colours(folders):
    scene = encoded(folders["gain"], harmonise="gain", hold_out="every:4")
    held = scene.rig.held_out
    assert held.any() and (scene.appearance.colours[held, 0] == 1).all() and not scene.appearance.colours[held, 1].any()
    np.testing.assert_allclose(
        np.exp(np.log(scene.appearance.colours[~held, 0].astype(float)).mean(axis=0)), 1, atol=1e-3
    )


def test_the_uv_measure_compares_harmonised_maps(folders):
    capture = open_capture(folders["gain"])
    scene = encoded(folders["gain"], harmonise="gain")
    found = evaluate(scene, capture)
    assert found["uv"]["psnr"] > 40
    strange = dataclasses.replace(
        scene,
        appearance=dataclasses.replace(scene.appearance, colours=AS_THEY_ARE),
    )
    assert evaluate(strange, capture)["uv"]["psnr"] < found["uv"]["psnr"] - 10


def test_the_number_of_threads_changes_nothing(folders):
    made = []
    for count in (1, 2):
        ef.set_threads(count)
        try:
            made.append(encode_scene(encoded(folders["affine"], harmonise="affine"), codec="png"))
        finally:
            ef.set_threads(None)
    assert made[0] == made[1]


def test_an_unknown_model_is_refused(folders):
    with pytest.raises(OptionError, match="no harmonisation is called luma"):
        encoded(folders["gain"], harmonise="luma")


# the fit on its own


@settings(max_examples=25)
@given(st.integers(2, 12), st.sampled_from(["gain", "affine"]), st.integers(0, 2**32 - 1))
def test_the_fit_withstands_outliers_and_holes(cameras, model, seed):
    random = np.random.default_rng(seed)
    m = 600
    truth = random.uniform(0.1, 0.8, m)
    gain = np.exp(random.uniform(-0.3, 0.3, cameras))
    gain /= np.exp(np.log(gain).mean())
    offset = random.uniform(-0.04, 0.04, cameras) * (model == "affine")
    offset -= offset.mean()
    values = (truth - offset[:, None]) / gain[:, None] + random.normal(0, 0.003, (cameras, m))
    wild = random.random((cameras, m)) < 0.03
    values[wild] = random.random(wild.sum())
    weights = (random.random((cameras, m)) < 0.8).astype(float)
    found = fit_colours(values, weights, np.arange(m) % 16, model)
    np.testing.assert_allclose(found[:, 0], gain, rtol=0.02)
    np.testing.assert_allclose(found[:, 1], offset, atol=0.008)


def test_a_gloss_on_a_part_of_the_surface_is_no_exposure():
    random = np.random.default_rng(1)
    truth = random.uniform(0.2, 0.6, 1600)
    blocks = np.arange(1600) // 100
    values = np.tile(truth, (6, 1))
    for camera in range(6):
        values[camera, blocks == 2 * camera] *= 1.5
        values[camera, blocks == 2 * camera + 1] *= 1.3
    found = fit_colours(values, np.ones_like(values), blocks)
    np.testing.assert_allclose(found[:, 0], 1, atol=0.003)


def test_cameras_that_share_nothing_stay():
    random = np.random.default_rng(2)
    truth = random.uniform(0.2, 0.6, 400)
    gain = np.array([0.8, 1.25, 1.6])
    weights = np.zeros((3, 400))
    weights[:2, :200], weights[2, 200:] = 1, 1
    found = fit_colours(truth / gain[:, None], weights, np.arange(400) % 16)
    np.testing.assert_allclose(found[:, 0], [0.8, 1.25, 1], rtol=1e-3)
    assert found[2].tolist() == [1, 0]


# the file


def coloured(channels=3, mixed=False):
    scene = tiny_scene(channels=channels, cameras=6, held_out=(4,))
    colours = np.zeros((6, 2, 3), np.float32)
    colours[:, 0] = np.linspace(0.7, 1.4, 18).reshape(6, 3)
    colours[:, 1] = np.linspace(-0.1, 0.1, 18).reshape(6, 3)
    colours[4] = [[1], [0]]
    if mixed:
        colours = np.rint(colours / np.float32(COLOUR_STEP)) * np.float32(COLOUR_STEP)
    return dataclasses.replace(
        scene, appearance=dataclasses.replace(scene.appearance, colours=colours, mixed_colours=mixed)
    )


@pytest.mark.parametrize(("codec", "mixed"), [("png", False), ("webp", True), ("avif", False)])
def test_colours_come_back_from_the_file(tmp_path, codec, mixed):
    scene = coloured(mixed=mixed)
    save(scene, tmp_path / "a.glb", codec=codec)
    again = ef.load(tmp_path / "a.glb")
    assert again.appearance.colours.dtype == np.float32 and (again.appearance.colours == scene.appearance.colours).all()
    assert again.appearance.mixed_colours == mixed
    assert validate(tmp_path / "a.glb") == []
    gltf, _ = glb_surgery.split((tmp_path / "a.glb").read_bytes())
    assert gltf["extensions"][glb_surgery.EXTENSION]["version"] == ("1.11" if mixed else "1.1")


def test_a_scene_without_colours_is_written_as_before(tmp_path):
    save(tiny_scene(), tmp_path / "a.glb")
    gltf, _ = glb_surgery.split((tmp_path / "a.glb").read_bytes())
    extension = gltf["extensions"][glb_surgery.EXTENSION]
    assert extension["version"] == "1.0" and "colour" not in extension["cameras"]
    assert ef.load(tmp_path / "a.glb").appearance.colours is None


def test_a_mean_beyond_white_keeps_its_colours(tmp_path):
    scene = coloured()
    bright = np.asarray(scene.appearance.planes[0].mean * np.float32(1.3) - np.float32(0.02), np.float32)
    scene = dataclasses.replace(
        scene,
        appearance=dataclasses.replace(
            scene.appearance, planes=(dataclasses.replace(scene.appearance.planes[0], mean=bright),)
        ),
    )
    save(scene, tmp_path / "a.glb", codec="png")
    again = ef.load(tmp_path / "a.glb")
    assert np.abs(again.appearance.planes[0].mean - bright).max() < 1.4 / 255 / 2 * 1.01
    save(again, tmp_path / "b.glb", codec="png")
    assert (ef.load(tmp_path / "b.glb").appearance.planes[0].mean == again.appearance.planes[0].mean).all()


@pytest.mark.parametrize(
    ("index", "value"), [(0, np.nan), (1, 0), (2, -1), (0, 2000), (3, np.inf), (4, 2000), (5, -2000)]
)
def test_damaged_colours_are_refused(tmp_path, index, value):
    def change(gltf, extension, binary):
        start, end = glb_surgery.view_of(gltf, extension["cameras"]["colour"])
        numbers = np.frombuffer(bytes(binary[start:end]), "<f4").copy()
        numbers[index] = value
        binary[start:end] = numbers.tobytes()

    refused(tmp_path, change, "camera-colour")


def test_too_few_colours_are_refused(tmp_path):
    def fewer(gltf, extension, binary):
        gltf["accessors"][extension["cameras"]["colour"]]["count"] -= 1

    refused(tmp_path, fewer, "camera-count")
    refused(tmp_path, lambda gltf, extension, binary: extension["cameras"].update(colour="red"), "json-type")


def test_damaged_coded_colours_are_refused(tmp_path):
    def shorter(gltf, extension, binary):
        gltf["bufferViews"][extension["cameras"]["codedColour"]]["byteLength"] = 8

    def others(gltf, extension, binary):
        extension["cameras"]["codedColour"] = []

    refused(tmp_path, shorter, "coded-truncated", mixed=True)
    refused(tmp_path, others, "json-type", mixed=True)

    def one_camera_less(gltf, extension, binary):
        extension["cameras"]["heldOut"] = [4, 5]

    refused(tmp_path, one_camera_less, "camera-count", mixed=True)


def refused(tmp_path, change, code, mixed=False):
    (tmp_path / "a.glb").write_bytes(glb_surgery.changed(encode_scene(coloured(mixed=mixed), codec="png"), change))
    with pytest.raises(FormatError) as caught:
        ef.load(tmp_path / "a.glb")
    assert caught.value.code == code
    assert [found.code for found in validate(tmp_path / "a.glb") if found.severity == "error"] == [code]


def test_colours_need_red_green_and_blue(tmp_path):
    with pytest.raises(FormatError) as caught:
        save(coloured(channels=1), tmp_path / "a.glb")
    assert caught.value.code == "camera-colour" and not (tmp_path / "a.glb").exists()


# drawing


def test_the_surface_alone_is_given_its_exposure_back():
    scene = coloured()
    renderer, row, colour = Renderer(scene), camera_weights(scene, 2), camera_colour(scene, 2)
    behind = (0.9, 0.1, 0.4)
    common = renderer.draw(scene.rig.cameras[2], row, background=behind, samples=2)
    own = renderer.draw(scene.rig.cameras[2], row, background=behind, samples=2, colour=colour)
    part = common.coverage[..., None]
    assert ((part > 0) & (part < 1)).any() and (part == 0).any()
    surface = np.divide(
        common.image - (1 - part) * np.float32(behind), part, where=part > 0, out=np.zeros_like(common.image)
    )
    wanted = part * (surface - colour[1]) / colour[0] + (1 - part) * np.float32(behind)
    np.testing.assert_allclose(own.image, wanted, atol=1e-5)
    assert camera_colour(tiny_scene(), 2) is None
    mixed = dataclasses.replace(scene, appearance=dataclasses.replace(scene.appearance, mixed_colours=True))
    np.testing.assert_allclose(
        Renderer(mixed).draw(scene.rig.cameras[2], row, background=behind, samples=2).image, own.image, atol=1e-6
    )
    mean, plain = (
        Renderer(one).draw(scene.rig.cameras[2], ViewWeights(), background=behind, samples=2) for one in (mixed, scene)
    )
    np.testing.assert_allclose(mean.image, plain.image, atol=1e-6)


def test_the_command_line(folders, tmp_path, run):
    folder, out = folders["gain"], tmp_path / "a.glb"
    words = ["encode", folder, "--proxy", folder / "proxy.ply", "-n", "3", "--atlas", "64", "--fit", "none", "-o", out]
    for extra in (["--harmonise"], ["--harmonise", "affine", "--overwrite"]):
        code, _, err = run(*words, "-q", *extra)
        assert code == 0, err
    assert "exposures     gains of " in run("info", out).out
    facts = json.loads(run("info", "--json", out).out)
    assert facts["settings"]["harmonise"] == "affine" and facts["cameras"]["harmonised"]["gain"]["G"][0] < 0.9
    scene = ef.load(out)
    for name in scene.rig.names[::4]:
        picture = tmp_path / name
        assert run("render", out, "--camera", name, "-o", picture).code == 0
        np.testing.assert_array_equal(cv2.imread(str(picture))[..., ::-1], ef.render(scene, camera=name).to_uint8())


def test_harmonised_maps_are_the_maps_of_harmonised_photographs(folders):
    scene, capture = encoded(folders["gain"]), open_capture(folders["gain"])
    atlas = make_atlas(scene.proxy.mesh, 128, 128)
    pixels = capture.photograph(3).pixels
    values, seen = texture_map(atlas, scene.rig.cameras[3], pixels)
    gain, offset = np.float32([1.2, 0.9, 1.1]), np.float32([0.01, -0.02, 0])
    first, _ = texture_map(atlas, scene.rig.cameras[3], pixels * gain + offset)
    np.testing.assert_allclose(harmonised_map(values, seen, np.stack([gain, offset])), first, atol=1e-5)
