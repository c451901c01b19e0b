"""The residual layer: exact captured views, in the file and out of it, and nothing of it anywhere else."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

import eigenfield as ef
from eigenfield import gltf as scene_format
from eigenfield.capture import open_capture
from eigenfield.coding import limits
from eigenfield.core.errors import FormatError, OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.encoding.residual.make import check_residual, crf_of, video_order, with_residual
from eigenfield.encoding.residual.views import (
    captured_pixels,
    captured_samples,
    corrected_picture,
    difference_of,
    differences,
)
from eigenfield.evaluation import evaluate
from eigenfield.gltf import encode_scene, parts, read_scene, validate, without_residual
from eigenfield.imaging.metrics import psnr, to_codes
from eigenfield.rendering import RenderJob, camera_colour, camera_weights
from support import glb_surgery
from support.captures import write_capture
from support.glb_surgery import ours, outcome, without
from support.scenes import row_grid

FINE = 100
WHERE = f"/extensions/{limits.EXTENSION}/residual"


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    return open_capture(write_capture(tmp_path_factory.mktemp("capture") / "nine"))


@pytest.fixture(scope="module")
def base(capture):
    """A coarse scene of eight of nine cameras, as its file gives it back."""
    scene = ef.encode(capture, capture.root / "proxy.ply", textures=2, atlas=64, hold_out="view_04.png")
    return read_scene(encode_scene(scene, quality=40))


@pytest.fixture(scope="module")
def exact(base, capture):
    return with_residual(base, capture, FINE)


@pytest.fixture(scope="module")
def data(exact):
    return encode_scene(exact)


def stored(data, tmp_path, name="scene.glb"):
    (tmp_path / name).write_bytes(data)
    return tmp_path / name


def count_textures(scene):
    """Eigen textures of all planes and bases."""
    return sum(basis.count for plane in scene.appearance.planes for basis in plane.bases)


def test_qualities_and_crf():
    assert [crf_of(quality) for quality in (0, 50, 100)] == [63, 32, 1]
    with pytest.raises(OptionError, match="0 to 100"):
        check_residual(row_grid(9, 64, 56), 101)


def test_a_grid_is_walked_to_and_fro():
    cameras = row_grid(9, 64, 56)
    order = video_order(cameras)
    assert sorted(order.tolist()) == list(range(9))
    centres = np.array([camera.centre for camera in cameras])
    steps = np.linalg.norm(np.diff(centres[order], axis=0), axis=1)
    assert steps.max() < 1.5 * steps.min()
    some = video_order([cameras[index] for index in (0, 1, 3, 8)])
    assert sorted(some.tolist()) == list(range(4))
    assert video_order(cameras[:1]).tolist() == [0]


def test_captured_views_are_exact_and_others_as_before(base, exact, capture):
    for index, difference in differences(exact):
        camera, photograph = exact.rig.cameras[index], to_codes(capture.photograph(index).pixels)
        drawn = ef.render(base, camera=base.rig.names[index])
        made = corrected_picture(drawn, difference)
        covered = drawn.coverage > 0.999
        assert made.image.shape == (camera.height, camera.width, 3)
        assert psnr(made.image, photograph, covered) >= 50 > 40 > psnr(drawn.image, photograph, covered)
    for where in ({"at": (0.3, -0.4)}, {"camera": "view_04.png"}, {"camera": "view_00.png"}):
        np.testing.assert_array_equal(ef.render(exact, **where).image, ef.render(base, **where).image)


def test_captured_views_of_sheets_are_exact_as_far_as_the_sheets_cover_them(base, capture):
    mesh = base.proxy.mesh
    opacity = np.full(base.appearance.atlas, 0.75, np.float32)
    thrice = Mesh(
        np.concatenate([mesh.vertices] * 3),
        np.concatenate([mesh.faces + sheet * len(mesh.vertices) for sheet in range(3)]).astype(np.int32),
        np.concatenate([mesh.uv] * 3),
    )
    sheets = replace(base, proxy=Proxy(thrice, None, Sheets((len(mesh.faces),) * 3, opacity)))
    for index, difference in differences(with_residual(sheets, capture, FINE)):
        drawn = ef.render(sheets, camera=base.rig.names[index])
        made, photograph = corrected_picture(drawn, difference), to_codes(capture.photograph(index).pixels)
        covered = drawn.coverage > 0.1
        np.testing.assert_allclose(drawn.coverage[covered], 1 - 0.25**3, atol=1e-5)
        expected = photograph / 255 * drawn.coverage[..., None]
        assert covered.mean() > 0.3 and psnr(made.image, to_codes(expected), covered) >= 50


def test_coarser_videos_are_smaller_and_worse(base, capture):
    figures = []
    for quality in (20, 60, 90):
        scene = with_residual(base, capture, quality)
        figures.append(
            (len(scene.residual.video), evaluate(scene, capture, png_maps="none")["image"]["residual"]["psnr"])
        )
    assert figures == sorted(figures) and figures[0][1] < figures[2][1] - 3


def test_photographs_too_large_for_the_encoder(base):
    tall = [replace(camera, height=3000) for camera in base.rig.cameras]
    assert check_residual(tall, 89) == (3000, 64)
    with pytest.raises(OptionError, match=r"64x9000.*less than 90"):
        check_residual(tall, FINE)
    with pytest.raises(OptionError, match="scale the photographs down"):
        check_residual([replace(camera, height=8705) for camera in base.rig.cameras], 0)


def test_one_camera_is_any_of_them(exact):
    for index, difference in differences(exact):
        if index in (0, 5, 8):
            np.testing.assert_array_equal(difference_of(exact, index), difference)
    with pytest.raises(OptionError, match="held out"):
        difference_of(exact, 4)
    with pytest.raises(OptionError, match="no residual"):
        difference_of(replace(exact, residual=None), 0)


def test_a_background_shines_through_as_before(base, exact):
    """Where the proxy covers a part of a pixel, the residual is the surface's alone; where none, there is none."""
    square = ef.Mesh(base.proxy.mesh.vertices * np.float32(0.3), base.proxy.mesh.faces, base.proxy.mesh.uv)
    small = replace(base, proxy=Proxy(square))
    index = 0
    ones = np.full((exact.rig.cameras[0].height, exact.rig.cameras[0].width, 3), 0.25, np.float32)
    pictures = {}
    for background in ((0.0, 0.0, 0.0), (1.0, 0.5, 0.0)):
        drawn = ef.render(small, camera=small.rig.names[index], background=background, samples=3)
        made = corrected_picture(drawn, ones, background)
        none = drawn.coverage == 0
        assert none.any() and (drawn.coverage > 0).any()
        np.testing.assert_allclose(made.image[none], np.broadcast_to(background, (none.sum(), 3)))
        pictures[background] = made.image - (1 - drawn.coverage[..., None]) * np.float32(background)
    first, second = pictures.values()
    np.testing.assert_allclose(first, second, atol=1e-5)


def test_the_file_brings_it_back(exact, data, tmp_path):
    path = stored(data, tmp_path)
    assert validate(path) == []
    found = ef.load(path)
    assert found.residual.video == exact.residual.video and found.residual.scale == exact.residual.scale
    assert found.residual.size == (56, 64) or found.residual.size == (64, 64)
    assert found.residual.order.tolist() == exact.residual.order.tolist()
    assert encode_scene(found) == data
    sizes = parts(path)
    assert sizes["residual"] == len(exact.residual.video)
    assert sizes["total"] == sum(count for name, count in sizes.items() if name != "total")
    gltf, _ = glb_surgery.split(data)
    extension = gltf["extensions"][limits.EXTENSION]
    assert (
        extension["version"] >= "1.5"
        and extension["residual"]["smooth"] is True
        and "residual" not in extension["needs"]
    )
    assert gltf["bufferViews"][-1]["byteLength"] == len(exact.residual.video)  # the last thing in the file


def test_who_does_not_know_it_loses_nothing_else(base, data, tmp_path):
    """A reader of 1.2 ignores the key."""
    unknown = glb_surgery.changed(data, lambda gltf, ours, binary: ours.update(later=ours.pop("residual")))
    plain = ef.load(stored(unknown, tmp_path))
    assert plain.residual is None
    np.testing.assert_array_equal(
        ef.render(plain, camera="view_00.png").image, ef.render(base, camera="view_00.png").image
    )


def test_viewers_are_handed_the_file_without_it(base, data, tmp_path):
    bare = without_residual(data)
    assert len(bare) < len(data) - parts(stored(data, tmp_path))["residual"]
    path = stored(bare, tmp_path)
    assert validate(path) == [] and ef.load(path).residual is None
    assert parts(path)["textures"] == parts(stored(data, tmp_path, "with.glb"))["textures"]
    assert without_residual(bare) == bare
    moved = glb_surgery.changed(data, lambda gltf, ours, binary: gltf["bufferViews"].append(
        {"buffer": 0, "byteOffset": 0, "byteLength": 1}))  # fmt: skip
    assert without_residual(moved) == moved  # not the last one: left as it is


def test_a_file_cut_in_its_residual_loses_that_alone(base, data, tmp_path, caplog):
    length = parts(stored(data, tmp_path))["residual"]
    gltf, binary = glb_surgery.split(data)
    ends = [view.get("byteOffset", 0) + view["byteLength"] for view in gltf["bufferViews"]]
    start = len(data) - len(binary) + sorted(ends)[-2]  # after it the video
    for keep in (start, start + 4, start + 1, len(data) - length // 2, len(data) - 5):
        path = stored(data[:keep], tmp_path)
        found = ef.load(path)
        assert found.residual is None
        np.testing.assert_array_equal(
            ef.render(found, camera="view_00.png").image, ef.render(base, camera="view_00.png").image
        )
        assert [(one.severity, one.code, one.where) for one in validate(path)] == [("warning", "residual-cut", WHERE)]
        assert "ends within its residual" in caplog.text
        assert parts(path)["residual"] == 0 and parts(path)["total"] == keep
        assert validate(stored(without_residual(data[:keep]), tmp_path, "mended.glb")) == []
        with pytest.raises(FormatError, match="copy or download"):
            scene_format.store_scores(path, {})
    for keep in (*range(0, start, 211), start - 1, start - 4):
        found = outcome(tmp_path / "a.glb", data[:keep])
        if found is None:  # within the eigen textures: the others are drawn
            left = read_scene(data[:keep])
            assert left.residual is None and count_textures(left) < count_textures(base)
        else:
            assert found in ("not-glb", "truncated")


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (ours("residual", value=[]), "json-type"),
        (without("extensions", limits.EXTENSION, "residual", "size"), "json-missing"),
        (without("extensions", limits.EXTENSION, "residual", "bufferView"), "json-missing"),
        (ours("residual", "bufferView", value=999), "view-missing"),
        (ours("residual", "size", value=[63, 64]), "json-value"),
        (ours("residual", "size", value=[65, 64]), "residual-size"),
        (ours("residual", "size", value=[64, 10**6]), "json-value"),
        (ours("residual", "size", value=[65534, 65534]), "residual-size"),
        (ours("residual", "scale", value=[0.002]), "json-value"),
        (ours("residual", "scale", value=[0.002, 0]), "residual-scale"),
        (ours("residual", "scale", value=[-0.002, 0.1]), "residual-scale"),
        (ours("residual", "scale", value=[0.002, "x"]), "json-type"),
        (ours("residual", "full", value=1), "json-type"),
        (ours("residual", "order", value=0), "accessor-type"),
        (ours("residual", "order", value=77), "accessor-missing"),
    ],
)
def test_entries_that_cannot_be(data, tmp_path, change, code):
    assert outcome(tmp_path / "a.glb", glb_surgery.changed(data, change)) == code


def test_an_order_is_one_of_all_encoded_cameras(data, tmp_path):
    def twice(gltf, extension, binary):
        start, _ = glb_surgery.view_of(gltf, extension["residual"]["order"])
        binary[start : start + 2] = binary[start + 2 : start + 4]

    assert outcome(tmp_path / "a.glb", glb_surgery.changed(data, twice)) == "residual-order"
    plain = ef.load(stored(glb_surgery.changed(data, without("extensions", limits.EXTENSION, "residual", "order")),
                           tmp_path))  # fmt: skip
    assert plain.residual.order.tolist() == list(range(8))


def test_limits_hold(data, tmp_path, monkeypatch):
    monkeypatch.setattr(limits, "MAX_VIDEO", 64 * 64 * 3 * 7)
    assert outcome(tmp_path / "a.glb", data) == "residual-size"


def test_a_damaged_video_harms_captured_views_alone(base, data, tmp_path):
    length = parts(stored(data, tmp_path))["residual"]
    random = np.random.default_rng(3)
    codes = set()
    for _ in range(25):
        broken = bytearray(data)
        place = len(data) - int(random.integers(8, length))
        broken[place : place + 6] = random.bytes(6)
        path = stored(bytes(broken), tmp_path)
        codes |= {(one.severity, one.code, one.where) for one in validate(path)}
        found = ef.load(path)
        np.testing.assert_array_equal(found.appearance.planes[0].mean, base.appearance.planes[0].mean)
        try:
            assert len(list(differences(found))) == 8
        except FormatError as error:
            assert error.code == "residual-damaged" and error.where == WHERE
    assert codes == {("error", "residual-damaged", WHERE)}


def test_shots_that_are_drawn_otherwise_have_none(exact):
    index, difference = 0, difference_of(exact, 0)
    expected = to_codes(corrected_picture(ef.render(exact, camera="view_00.png"), difference).image)
    np.testing.assert_array_equal(captured_pixels(RenderJob(exact), index, difference), expected)
    assert captured_pixels(RenderJob(exact, background=None), index, difference).shape[2] == 4
    for other in ({"resolution": (32, 32)}, {"filter": "bilinear"}, {"textures": 1}, {"samples": 2}):
        with pytest.raises(OptionError, match="other pictures"):
            captured_pixels(RenderJob(exact, **other), index, difference)


def test_what_was_taken_from_one_sample_a_pixel_is_put_on_that(exact, tmp_path):
    """Residuals of files before 1.5; of cameras half as fine as the reference, from 2 x 2."""
    smaller = replace(exact.proxy.mesh, vertices=exact.proxy.mesh.vertices * np.array([0.7, 0.7, 1], np.float32))
    cameras = tuple(one.resize(32, 28) if index == 3 else one for index, one in enumerate(exact.rig.cameras))
    older = replace(
        exact,
        proxy=Proxy(smaller),
        rig=replace(exact.rig, cameras=cameras),
        residual=replace(exact.residual, smooth_edges=False),
    )
    path = stored(encode_scene(older), tmp_path)
    assert [one for one in validate(path) if one.severity != "information"] == []
    found, difference = ef.load(path), difference_of(exact, 0)
    plain, smooth = (ef.render(found, camera="view_00.png", samples=samples) for samples in (1, None))
    assert (plain.image != smooth.image).any()
    expected = to_codes(corrected_picture(plain, difference).image)
    np.testing.assert_array_equal(captured_pixels(RenderJob(found), 0, difference), expected)
    assert [captured_samples(found, index) for index in (0, 3)] == [1, 2]
    assert captured_samples(exact, 3) is None


def test_harmonised_scenes_have_their_own_exposure(capture):
    scene = ef.encode(capture, capture.root / "proxy.ply", textures=2, atlas=64, fit="none", harmonise="gain")
    exact = with_residual(read_scene(encode_scene(scene, quality=40)), capture, FINE)
    job = RenderJob(exact)
    drawn = job.picture(exact.rig.cameras[2], camera_weights(exact, 2), camera_colour(exact, 2))
    made = captured_pixels(job, 2, difference_of(exact, 2))
    assert psnr(made, to_codes(capture.photograph(2).pixels), drawn.coverage > 0.999) >= 50


def test_masked_pixels_have_no_difference(base, capture, tmp_path):
    folder = tmp_path / "masks"
    folder.mkdir()
    for view in capture.views:
        mask = np.zeros((view.camera.height, view.camera.width), np.uint8)
        mask[:, 32:] = 255
        Image.fromarray(mask).save(folder / f"{view.name}.png")
    masked = open_capture(capture.root, masks=folder)
    difference = difference_of(with_residual(base, masked, FINE), 0)
    assert np.abs(difference[:, :28]).max() < 4 / 255 < np.abs(difference[:, 36:]).max()


def test_evaluate_says_both_and_mixes_nothing(base, exact, capture, tmp_path):
    path = stored(encode_scene(exact), tmp_path)
    plain, both = (evaluate(scene, capture, png_maps="none") for scene in (base, ef.load(path)))
    assert plain["image"]["residual"] is None
    for part in ("encoded", "held_out"):
        assert both["image"][part] == plain["image"][part]
    assert both["image"]["residual"]["cameras"] == 8
    assert both["image"]["residual"]["psnr"] >= 50 > both["image"]["encoded"]["psnr"]
    assert [camera["name"] for camera in both["cameras"]] == list(exact.rig.names)
    assert [name for camera in both["cameras"] for name in camera if name == "residual"] == ["residual"] * 8
    for other in ({"textures": 1}, {"filter": "bilinear"}):
        assert evaluate(exact, capture, png_maps="none", **other)["image"]["residual"] is None


@pytest.mark.slow
def test_the_command_line(run, capture, tmp_path):
    folder, out = Path(capture.root), tmp_path / "archive.glb"
    how = ["--proxy", folder / "proxy.ply", "--fit", "photographs", "--preset", "small", "-n", "2"]
    said = run("encode", folder, *how, "--hold-out", "view_04.png", "--residual", "100", "-o", out, "-q")
    assert said[0] == 0, said
    facts = json.loads(run("info", "--json", out)[1])
    assert facts["bytes"]["residual"] > 0 and facts["settings"]["residual"] == {"quality": 100}
    assert run("validate", out)[0] == 0
    table = run("evaluate", out, folder, "-q")[1]
    assert "with residual (8)" in table and ", residual " in table
    picture = tmp_path / "view.png"
    assert run("render", out, "--camera", "view_00.png", "--residual", "-o", picture, "-q")[0] == 0
    shown = np.asarray(Image.open(picture))
    assert psnr(shown, to_codes(capture.photograph(0).pixels)) > 45
    assert run("export", out, "--as", "colmap", "--residual", "-o", tmp_path / "colmap", "-q")[0] == 0
    listing = json.loads(next((tmp_path / "colmap").glob("*.json")).read_text(encoding="utf-8"))
    assert len(listing["residual"]) == 8 and not set(listing["residual"]) & set(listing["heldOut"])
    np.testing.assert_array_equal(shown, np.asarray(Image.open(tmp_path / "colmap" / listing["images"]["view_00.png"])))


@pytest.mark.parametrize("codec", ["avif", "png"])
def test_a_residual_on_the_papers_way(run, capture, tmp_path, codec):
    folder, out = Path(capture.root), tmp_path / "archive.glb"
    how = ["--proxy", folder / "proxy.ply", "-n", "2", "--atlas", "64", "--codec", codec]
    assert run("encode", folder, *how, "-o", tmp_path / "plain.glb", "-q")[0] == 0
    assert run("encode", folder, *how, "--residual", "90", "-o", out, "-q")[0] == 0
    plain, made = ef.load(tmp_path / "plain.glb"), ef.load(out)
    for name in ("view_00.png", "view_07.png"):
        np.testing.assert_array_equal(ef.render(made, camera=name).image, ef.render(plain, camera=name).image)
    shown = captured_pixels(RenderJob(made), 7, difference_of(made, 7))
    assert psnr(shown, to_codes(capture.photograph(7).pixels)) > 45


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["render", "SCENE", "--residual", "--at", "0,0", "-o", "OUT.png"], "only captured views"),
        (["render", "SCENE", "--residual", "--path", "circle", "-o", "OUT.mp4"], "only captured views"),
        (["render", "SCENE", "--residual", "--camera", "view_04.png", "-o", "OUT.png"], "held out"),
        (["render", "SCENE", "--residual", "--resolution", "32x32", "-o", "OUT.png"], "other pictures"),
        (["export", "SCENE", "--residual", "--as", "maps", "-o", "OUT"], "--residual is not for maps"),
        (["export", "SCENE", "--residual", "--as", "colmap", "--path", "circle", "-o", "OUT"], "captured"),
        (["encode", "CAPTURE", "--residual", "40", "--target-size", "300kB", "-o", "OUT.glb"], "on top"),
    ],
)
def test_combinations_that_cannot_be(run, data, capture, tmp_path, words, said):
    path = stored(data, tmp_path)
    places = {"SCENE": str(path), "CAPTURE": str(capture.root)}
    command = [places.get(word, word).replace("OUT", str(tmp_path / "out")) for word in words]
    code, _, error = run(*command, "-q")
    assert code == 2 and said in error


PAIR = st.lists(st.floats(-2, 2) | st.integers(-1, 200), min_size=2, max_size=2)
ODD = st.one_of(
    st.none(), st.booleans(), st.integers(-(2**70), 2**70), st.integers(-2, 90), st.floats(allow_nan=True),
    st.text(max_size=5), st.just([]), st.just({}), st.lists(st.integers(-1, 90), max_size=3), PAIR,
)  # fmt: skip


@given(st.sampled_from(["bufferView", "size", "full", "order", "scale"]), ODD)
@settings(max_examples=100)
def test_odd_entries_never_surprise(tmp_path_factory, data, key, value):
    changed = glb_surgery.changed(data, ours("residual", key, value=value))
    outcome(tmp_path_factory.getbasetemp() / "odd.glb", changed)
