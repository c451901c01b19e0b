"""Scenes against photographs that were drawn from them, so that every figure has a known answer."""

from __future__ import annotations

import dataclasses
import json
import re
from pathlib import Path

import cv2
import numpy as np
import pytest

from eigenfield.capture import match_photographs
from eigenfield.cli.evaluate import COLUMNS
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError, OptionError, OutputError
from eigenfield.encoding.atlas import make_atlas
from eigenfield.encoding.projected.project import texture_map
from eigenfield.evaluation import ExcludedCircle, evaluate, reconstruct_maps, stored_scores
from eigenfield.evaluation.uv import measure_map
from eigenfield.gltf import load, save
from eigenfield.imaging.flip import flip
from eigenfield.imaging.metrics import PSNR_MAX_DECIBELS
from eigenfield.rendering import Renderer, camera_weights
from eigenfield.runtime.parallel import set_threads
from support.redrawn import HELD, drawn, lighter, write_capture
from support.scenes import tiny_scene


@pytest.fixture
def scene():
    return tiny_scene(textures=3, cameras=9, size=48, held_out=HELD)


def named_as_files(scene):
    """The scene with its cameras named as the photographs that `write_capture` writes."""
    names = tuple(f"{name}.png" for name in scene.rig.names)
    return dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, names=names))


def test_a_scene_against_its_own_pictures_is_perfect(scene, tmp_path):
    figures = evaluate(scene, write_capture(scene, tmp_path / "c"))
    for kind, count in (("encoded", 8), ("held_out", 1)):
        part = figures["image"][kind]
        assert part["cameras"] == count
        assert part["psnr"] == part["psnr_full"] == part["psnr_luma"] == PSNR_MAX_DECIBELS
        assert part["ssim"] == part["ssim_full"] == 1
        assert 0.3 < part["coverage"] < 1
    assert figures["bytes"] is figures["ratio"] is None
    assert figures["missing"] == []
    assert "curve" not in figures and "flip" not in figures["image"]["encoded"]
    json.dumps(figures, allow_nan=False)


def test_the_documentation_defines_every_figure_of_a_picture(scene, tmp_path):
    text = (Path(__file__).parents[2] / "docs" / "measures.md").read_text(encoding="utf-8")
    table = text.split("\n## Figures of a picture\n\n")[1].split("\n\n")[0]
    defined = re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)
    figures = evaluate(scene, write_capture(scene, tmp_path / "c"), flip=True)
    for part in ("encoded", "held_out"):
        assert set(figures["image"][part]) == {*defined, "cameras", "worst"}
        assert set(figures["image"][part]["worst"]) == set(defined)
    assert {key for key, _, _ in COLUMNS} <= set(defined)


def test_drawing_and_projecting_back_each_resample_once(scene, tmp_path):
    """Pictures without smooth edges, whose pixels hold some of the background."""
    renderer = Renderer(scene)

    def plain(index, picture):
        camera, row = scene.rig.cameras[index], camera_weights(scene, index)
        return renderer.draw(camera, row, samples=1).to_uint8()

    assert evaluate(scene, write_capture(scene, tmp_path / "c", plain))["uv"]["ssim"] > 0.9


@pytest.mark.parametrize(("at", "kind"), [(2, "encoded"), (HELD[0], "held_out")])
def test_an_offset_of_ten_levels_is_found_where_it_is(scene, tmp_path, at, kind):
    figures = evaluate(scene, write_capture(scene, tmp_path / "c", lighter(at)))
    known = 20 * np.log10(25.5)
    part = figures["image"][kind]
    assert part["worst"]["psnr"] == {"value": pytest.approx(known, abs=1e-5), "camera": scene.rig.names[at]}
    assert part["worst"]["psnr_full"]["value"] == pytest.approx(known, abs=1e-5)
    assert part["psnr"] == pytest.approx(
        (PSNR_MAX_DECIBELS * (part["cameras"] - 1) + known) / part["cameras"], abs=1e-5
    )
    other = {"encoded": "held_out", "held_out": "encoded"}[kind]
    assert figures["image"][other]["psnr"] == PSNR_MAX_DECIBELS
    one = next(camera for camera in figures["cameras"] if camera["name"] == scene.rig.names[at])
    assert one["psnr"] == pytest.approx(known, abs=1e-5)
    assert one["held_out"] == (kind == "held_out")


def test_the_background_counts_in_the_full_figures_only(scene, tmp_path):
    def framed(index, picture):
        coverage = Renderer(scene).draw(scene.rig.cameras[index], camera_weights(scene, index)).coverage
        return np.where(coverage[..., None] > 0, picture, 200).astype(np.uint8)

    part = evaluate(scene, write_capture(scene, tmp_path / "c", framed))["image"]["encoded"]
    assert part["psnr"] == PSNR_MAX_DECIBELS
    assert part["ssim"] == 1
    assert part["psnr_full"] < 20
    assert part["ssim_full"] < 0.95


def test_masks_bound_the_covered_pixels_and_the_coverage(scene, tmp_path):
    height, width = scene.rig.cameras[0].height, scene.rig.cameras[0].width
    mask = np.zeros((height, width), np.uint8)
    mask[13:26, 19:32] = 255  # the surface covers all of it

    def spoilt(index, picture):
        return np.where(mask[..., None] > 0, picture, 255 - picture).astype(np.uint8)

    part = evaluate(scene, write_capture(scene, tmp_path / "c", spoilt, lambda index: mask))["image"]["encoded"]
    assert part["coverage"] == 1
    assert part["psnr"] == PSNR_MAX_DECIBELS
    assert part["ssim"] == 1
    assert part["psnr_full"] < 30


def test_circles_are_left_out_of_the_outside_figures(scene, tmp_path):
    circle = ExcludedCircle(20, 20, 8)

    def spot(index, picture):
        return np.where(circle.outside(*picture.shape[1::-1])[..., None], picture, 255 - picture).astype(np.uint8)

    capture = write_capture(scene, tmp_path / "c", spot)
    figures = evaluate(scene, capture, circles=dict.fromkeys(scene.rig.names, circle))
    for kind in ("encoded", "held_out"):
        assert figures["image"][kind]["psnr"] < 40
        outside = figures["image"][kind]["outside"]
        assert outside["psnr"] == outside["psnr_luma"] == PSNR_MAX_DECIBELS
        assert outside["ssim"] == 1
        assert set(outside["worst"]) == {"psnr", "ssim", "psnr_luma"}
    some = evaluate(scene, capture, circles={scene.rig.names[0]: circle})["image"]["encoded"]["outside"]
    assert some["worst"]["psnr"]["camera"] != scene.rig.names[0]
    assert some["worst"]["psnr"]["value"] < 40


def test_flip_is_measured_when_asked_for(scene, tmp_path):
    capture = write_capture(scene, tmp_path / "c", lighter(2))
    figures = evaluate(scene, capture, flip=True, circles={scene.rig.names[2]: ExcludedCircle(24, 20, 9)})
    encoded, held = figures["image"]["encoded"], figures["image"]["held_out"]
    assert held["flip"] == held["worst"]["flip"]["value"] == 0
    worst = encoded["worst"]["flip"]  # the highest: lower is better
    assert worst["camera"] == scene.rig.names[2] and 0.01 < worst["value"] < 0.3
    assert encoded["flip"] == pytest.approx(worst["value"] / 8, abs=1e-6)
    assert encoded["outside"]["flip"] != encoded["flip"]
    assert encoded["outside"]["worst"]["flip"]["camera"] == scene.rig.names[2]
    alone = {camera["name"]: camera["flip"] for camera in figures["cameras"]}
    assert alone[scene.rig.names[2]] == worst["value"] and sum(value > 0 for value in alone.values()) == 1
    assert stored_scores(figures)["image"]["encoded"]["flip"] == encoded["flip"]
    picture = drawn(scene, 2)
    surface = Renderer(scene).draw(scene.rig.cameras[2], camera_weights(scene, 2)).coverage > 0.999
    assert worst["value"] == pytest.approx(flip(picture, lighter(2)(2, picture), surface), abs=1e-6)
    plain = evaluate(scene, capture)
    assert "flip" not in plain["image"]["encoded"] and "flip" not in plain["cameras"][0]
    assert plain["image"]["encoded"] == {
        key: value if key != "worst" else {name: at for name, at in value.items() if name != "flip"}
        for key, value in encoded.items()
        if key not in ("flip", "outside")
    }


def test_luma_of_the_whole_frame(scene, tmp_path):
    def green(index, picture):
        assert picture[..., 1].max() < 255
        return picture + np.uint8([0, 1, 0])

    part = evaluate(scene, write_capture(scene, tmp_path / "c", green))["image"]["held_out"]
    assert part["psnr_luma_full"] == pytest.approx(20 * np.log10(255 / 0.7152), abs=1e-4)
    assert part["psnr_full"] == pytest.approx(10 * np.log10(255**2 * 3), abs=1e-4)


def test_reconstruction_is_equation_8_at_every_count(scene):
    plane = scene.appearance.planes[0]
    basis = plane.bases[0]
    codes = np.random.default_rng(3).integers(0, 256, basis.textures.shape, dtype=np.uint8)
    scale = np.linspace(0.001, 0.002, basis.scale.size, dtype=np.float32).reshape(basis.scale.shape)
    coded = dataclasses.replace(basis, textures=codes, scale=scale, zero=np.full_like(scale, 127.5))
    for bases in ((basis,), (coded,), (basis, coded)):
        mixed = dataclasses.replace(plane, bases=bases)
        counts = range(sum(b.count for b in bases) + 1)
        made = [picture.copy() for picture in reconstruct_maps(mixed, 5, counts)]
        expected = [plane.mean.astype(np.float64)]
        for b in bases:
            expected += [
                row * picture for row, picture in zip(b.weights[5], b.values().astype(np.float64), strict=True)
            ]
        for count in counts:
            np.testing.assert_allclose(made[count], np.sum(expected[: count + 1], axis=0), atol=2e-6)
        (direct,) = reconstruct_maps(mixed, 5, [counts[-1]])
        np.testing.assert_allclose(direct, made[-1], atol=2e-6)


def test_a_map_that_is_the_reconstruction_is_perfect_and_one_in_the_wrong_place_is_not(scene):
    plane, height, width = scene.appearance.planes[0], 48, 48
    atlas = make_atlas(scene.proxy.mesh, width, height)
    (texture,) = reconstruct_maps(plane, 3, [3])
    values = texture.reshape(-1, 3)[atlas.texel]
    seen = np.ones(atlas.count, np.uint8)
    seen[::3] = 0
    perfect = measure_map(plane, 3, atlas, values, seen, [3])
    assert perfect.psnr == (PSNR_MAX_DECIBELS,)
    assert perfect.ssim[0] == pytest.approx(1, abs=1e-6)
    assert perfect.png is None
    values[~seen.astype(bool)] = 7  # what is not seen does not count
    assert measure_map(plane, 3, atlas, values, seen, [3]) == perfect
    assert measure_map(plane, 4, atlas, values, seen, [3]).psnr[0] < 40
    blind = measure_map(plane, 3, atlas, values, np.zeros(atlas.count, np.uint8), [0, 3])
    assert blind.psnr == blind.ssim == (None, None)


def test_uv_figures_are_those_of_the_maps(scene, tmp_path):
    capture = write_capture(scene, tmp_path / "c", lighter(1))
    figures = evaluate(scene, capture, curve="all")
    atlas = make_atlas(scene.proxy.mesh, 48, 48)
    found = []
    for row, index in enumerate(scene.rig.encoded):
        values, seen = texture_map(atlas, scene.rig.cameras[index], capture.photograph(int(index)).pixels)
        found.append(measure_map(scene.appearance.planes[0], row, atlas, values, seen, [3]))
    assert figures["uv"]["psnr"] == pytest.approx(np.mean([one.psnr[0] for one in found]), abs=1e-5)
    assert figures["uv"]["ssim"] == pytest.approx(np.mean([one.ssim[0] for one in found]), abs=1e-5)
    assert figures["uv"]["worst"]["psnr"]["camera"] == scene.rig.names[1]
    assert [point["textures"] for point in figures["curve"]] == [0, 1, 2, 3]
    last = figures["curve"][-1]
    assert (last["uv_ssim"], last["uv_psnr"]) == (figures["uv"]["ssim"], figures["uv"]["psnr"])
    for point in figures["curve"]:
        cut = evaluate(scene, capture, textures=point["textures"])
        assert cut["uv"]["psnr"] == pytest.approx(point["uv_psnr"], abs=1e-4)
        assert cut["textures"] == point["textures"]


def test_a_curve_of_some_cameras(scene, tmp_path, monkeypatch):
    monkeypatch.setattr("eigenfield.evaluation.session.EVALUATION_SAMPLE_CAMERAS", 2)
    capture = write_capture(scene, tmp_path / "c", lighter(1))
    whole, some = (evaluate(scene, capture, curve=which) for which in ("all", "sample"))
    assert some["uv"] == whole["uv"] and some["image"] == whole["image"]
    assert [point["cameras"] for point in some["curve"]] == [2] * 4
    assert whole["curve"][0]["cameras"] == len(scene.rig.encoded)
    ends = [scene.rig.names[scene.rig.encoded[0]], scene.rig.names[scene.rig.encoded[-1]]]
    alone = [camera["uv_psnr"] for camera in whole["cameras"] if camera["name"] in ends]
    assert some["curve"][-1]["uv_psnr"] == pytest.approx(np.mean(alone), abs=1e-4)
    with pytest.raises(OptionError, match="use all, sample, none"):
        evaluate(scene, capture, curve="few")


def test_maps_of_an_aligned_scene_are_aligned_too(scene, tmp_path):
    def shifted(index, picture):
        return np.roll(picture, 1, axis=1) if index == 1 else picture

    capture = write_capture(scene, tmp_path / "c", shifted)
    plain = evaluate(scene, capture)
    aligned = evaluate(dataclasses.replace(scene, settings={"align": "dis"}), capture)
    one, other = (next(c for c in f["cameras"] if c["name"] == scene.rig.names[1]) for f in (plain, aligned))
    assert one["uv_psnr"] != other["uv_psnr"]
    assert one["psnr"] == other["psnr"]
    reference = scene.rig.names[0 if scene.rig.reference in HELD else scene.rig.reference]
    assert plain["image"] == aligned["image"]
    assert reference in [camera["name"] for camera in aligned["cameras"]]


def test_the_number_of_threads_changes_nothing(scene, tmp_path):
    capture = write_capture(scene, tmp_path / "c", lighter(3))
    results = []
    try:
        for count in (1, 3):
            set_threads(count)
            figures = evaluate(scene, capture, curve="all")
            assert figures.pop("seconds") >= 0
            results.append(figures)
    finally:
        set_threads(None)
    assert results[0] == results[1]


def test_missing_photographs_are_named_and_left_out(scene, tmp_path):
    figures = evaluate(scene, write_capture(scene, tmp_path / "c", only=(0, 1, 2, 5)))
    assert figures["missing"] == [scene.rig.names[i] for i in (3, 4, 6, 7, 8)]
    assert figures["image"]["held_out"] is None
    assert figures["image"]["encoded"]["cameras"] == 4
    held_only = evaluate(scene, write_capture(scene, tmp_path / "d", only=HELD))
    assert held_only["image"]["encoded"] is held_only["uv"] is None
    assert held_only["image"]["held_out"]["psnr"] == PSNR_MAX_DECIBELS


def test_photographs_with_other_endings_are_matched_by_stem(scene, tmp_path):
    scene, capture = named_as_files(scene), write_capture(scene, tmp_path / "c")
    endings = [".JPG", ".heic", *[".png"] * 7]
    named = [Path(name).stem + ending for name, ending in zip(scene.rig.names, endings, strict=True)]
    views = [dataclasses.replace(view, name=name) for view, name in zip(capture.views, named, strict=True)]
    found = match_photographs(scene, dataclasses.replace(capture, views=tuple(views)))
    assert found == {index: index for index in range(9)}
    twins = [dataclasses.replace(views[0], name=f"{Path(named[0]).stem}.tif"), *views]  # neither is the one
    found = match_photographs(scene, dataclasses.replace(capture, views=tuple(twins)))
    assert found == {index: index + 1 for index in range(1, 9)}


def test_photographs_from_other_places_are_said(scene, tmp_path, caplog):
    """Another world and scale are no other places."""
    capture = write_capture(scene, tmp_path / "c")
    turn = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    for moved, said in ((lambda c: 7 * turn @ c + 3, False), (lambda c: c * [1, 3, 1], True)):
        views = [
            dataclasses.replace(view, camera=dataclasses.replace(cam := view.camera, t=-cam.R @ moved(cam.centre)))
            for view in capture.views
        ]
        caplog.clear()
        match_photographs(named_as_files(scene), dataclasses.replace(capture, views=tuple(views)))
        assert ("not the one that was encoded" in caplog.text) == said


def test_a_camera_that_sees_nothing_has_no_figures(scene, tmp_path):
    away = scene.rig.cameras[0]
    about = np.diag([-1.0, 1.0, -1.0])
    turned = Camera(away.K, about @ away.R, about @ away.t, away.width, away.height)
    blind = dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, cameras=(turned, *scene.rig.cameras[1:])))
    figures = evaluate(blind, write_capture(blind, tmp_path / "c"))
    assert figures["cameras"][0]["psnr"] is figures["cameras"][0]["uv_ssim"] is None
    assert figures["cameras"][0]["coverage"] == 0
    assert figures["image"]["encoded"]["psnr"] == PSNR_MAX_DECIBELS
    assert figures["image"]["encoded"]["worst"]["coverage"] == {"value": 0, "camera": scene.rig.names[0]}
    json.dumps(figures, allow_nan=False)


def test_a_capture_of_something_else(scene, tmp_path):
    capture = write_capture(scene, tmp_path / "c")
    other = dataclasses.replace(capture, views=tuple(dataclasses.replace(v, name=f"x{v.name}") for v in capture.views))
    with pytest.raises(CaptureError) as caught:
        evaluate(scene, other)
    assert caught.value.code == "no-photographs"
    assert str(tmp_path / "c") in str(caught.value)


def test_photographs_of_another_size(scene, tmp_path):
    small = dataclasses.replace(
        scene, rig=dataclasses.replace(scene.rig, cameras=tuple(camera.resize(24, 20) for camera in scene.rig.cameras))
    )
    with pytest.raises(CaptureError) as caught:
        evaluate(scene, write_capture(small, tmp_path / "c"))
    assert caught.value.code == "photograph-size"
    assert "24x20" in str(caught.value)
    assert str(tmp_path) in str(caught.value)


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ({"png_maps": "some"}, "png-maps"),
        ({"textures": 4}, "textures"),
        ({"textures": -1}, "textures"),
        ({"filter": "sinc"}, "filter"),
        ({"weights": "psychic"}, "weights-mode"),
    ],
)
def test_options_that_cannot_be(scene, tmp_path, options, code):
    with pytest.raises(OptionError) as caught:
        evaluate(scene, write_capture(scene, tmp_path / "c"), **options)
    assert caught.value.code == code


@pytest.mark.parametrize(
    "settings",
    [{"resampling": "magic"}, {"align": "crystals"}, {"resampling": []}, {"maxAngle": 0}, {"maxAngle": [85]}],
)
def test_settings_of_a_later_version(scene, tmp_path, settings):
    with pytest.raises(OptionError) as caught:
        evaluate(dataclasses.replace(scene, settings=settings), write_capture(scene, tmp_path / "c"))
    assert caught.value.code == "settings-unknown"


def test_scenes_of_other_attributes_are_refused(scene, tmp_path):
    capture = write_capture(scene, tmp_path / "c")
    with pytest.raises(OptionError) as caught:
        evaluate(tiny_scene(channels=6), capture)
    assert caught.value.code == "not-photographs"


def test_bytes_ratios_and_sampled_maps(tmp_path):
    scene = tiny_scene(textures=3, cameras=20, size=32)
    capture = write_capture(scene, tmp_path / "c")
    path = tmp_path / "scene.glb"
    save(scene, path, codec="png")
    whole, sample, none = (evaluate(load(path), capture, path=path, png_maps=how) for how in ("all", "sample", "none"))
    sizes = whole["bytes"]
    assert sizes["total"] == path.stat().st_size == sum(size for part, size in sizes.items() if part != "total")
    photographs = sum((tmp_path / "c" / f"{name}.png").stat().st_size for name in scene.rig.names)
    assert whole["ratio"]["photographs"] == pytest.approx(photographs / sizes["total"], abs=1e-6)
    assert whole["ratio"]["raw"] == pytest.approx(20 * 48 * 40 * 3 / sizes["total"], abs=1e-6)
    assert whole["ratio"]["texture_maps_png"] == pytest.approx(whole["png_maps"]["bytes"] / sizes["total"], abs=1e-6)
    assert (whole["png_maps"]["packed"], whole["png_maps"]["of"]) == (20, 20)
    assert (sample["png_maps"]["packed"], sample["png_maps"]["mode"]) == (16, "sample")
    assert sample["png_maps"]["bytes"] == pytest.approx(whole["png_maps"]["bytes"], rel=0.05)
    assert none["png_maps"] is none["ratio"]["texture_maps_png"] is None


def test_the_verb_from_end_to_end(scene, tmp_path, run):
    write_capture(scene, tmp_path / "a capture", lighter(2))
    path, plots = tmp_path / "scene.glb", tmp_path / "some" / "plots"
    named = dataclasses.replace(
        scene, rig=dataclasses.replace(scene.rig, names=tuple(f"{name}.png" for name in scene.rig.names))
    )
    save(named, path, codec="png")
    result = run("evaluate", path, tmp_path / "a capture", "--json", "--curve", "--plots", plots, "--store", "--quiet")
    assert result.code == 0, result.err
    figures = json.loads(result.out)
    assert {"schema", "uv", "image", "bytes", "ratio", "seconds", "curve"} <= set(figures)
    assert figures["image"]["encoded"]["worst"]["psnr"]["camera"] == "view_02.png"
    assert sorted(p.name for p in plots.iterdir()) == ["bytes.png", "cameras.png", "contact-sheet.png", "uv-curve.png"]
    assert all(cv2.imread(str(p)).std() > 10 for p in plots.iterdir())
    stored = load(path).scores
    assert stored == stored_scores(figures)
    assert {"seconds", "cameras", "bytes"}.isdisjoint(stored)

    with pytest.raises(OutputError) as refused:
        run("evaluate", path, tmp_path / "a capture", "--plots", plots, "--traceback")
    assert refused.value.code == "output-exists"
    table = run("evaluate", path, tmp_path / "a capture", "--plots", plots, "--overwrite", "--store")
    assert table.code == 0, table.err
    for words in ("texture maps (UV)", "encoded (8)", "held out (1)", "view_02.png", "times smaller than"):
        assert words in table.out
    assert "FLIP" not in table.out
    again = load(path).scores
    assert set(stored) - set(again) == {"curve"}
    assert all(again[key] == stored[key] for key in again if key != "ratio")  # the file has grown by its scores


def test_the_table_of_the_verb_shows_flip(scene, tmp_path, run):
    write_capture(scene, tmp_path / "c", lighter(2))
    save(
        dataclasses.replace(
            scene, rig=dataclasses.replace(scene.rig, names=tuple(f"{name}.png" for name in scene.rig.names))
        ),
        tmp_path / "s.glb",
        codec="png",
    )
    words = ["--flip", "--png-maps", "none", "--quiet"]
    shown = run("evaluate", tmp_path / "s.glb", tmp_path / "c", *words).out.splitlines()
    end = next(line for line in shown if "PSNR" in line).index("FLIP") + 4
    at = next(number for number, line in enumerate(shown) if line.startswith("encoded (8)"))
    mean, worst = (float(line[end - 6 : end]) for line in shown[at : at + 2])
    assert 0 < mean < worst < 0.3


def test_the_verb_leaves_nothing_when_it_cannot(scene, tmp_path, run):
    save(scene, tmp_path / "scene.glb", codec="png")
    before = (tmp_path / "scene.glb").read_bytes()
    others = tuple(f"other_{name}" for name in scene.rig.names)
    write_capture(dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, names=others)), tmp_path / "c")
    code, out, err = run("evaluate", tmp_path / "scene.glb", tmp_path / "c", "--plots", tmp_path / "plots", "--store")
    assert (code, out) == (2, "") and err.startswith("eigenfield: ")
    assert not (tmp_path / "plots").exists()
    assert (tmp_path / "scene.glb").read_bytes() == before
