"""Gaussians of a scene: how they are drawn, where they lie, and what a reader of the extension finds in the file."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.gltf import save
from eigenfield.gltf.axes import capture_to_gltf
from eigenfield.rendering import camera_weights, renderer_of
from eigenfield.viewer.exports import write_splats
from eigenfield.viewer.exports.splats.fit import fit_gaussians
from eigenfield.viewer.exports.splats.gaussians import SH_ZERO, Gaussians, footprint_of, harmonics_of
from eigenfield.viewer.exports.splats.place import SPLATS_MOST
from support.clips import numbered_clip
from support.scenes import tiny_scene
from support.soft_scenes import soft_scene
from support.splatted import camera_of, draw_splats, read_splats, read_spz, seen_colours

CAMERA = Camera(np.array([[40.0, 0, 16.5], [0, 40.0, 12.5], [0, 0, 1]]), np.eye(3), np.zeros(3), 33, 25)


def gaussians(positions, scales, opacity, colours):
    """Round ones of given colours."""
    count = len(positions)
    harmonics = ((np.asarray(colours, np.float32) - 0.5) / SH_ZERO)[:, None]
    scales = np.repeat(np.asarray(scales, float)[:, None], 3, axis=1)
    turns = np.tile(np.eye(3), (count, 1, 1))
    places, opaque = np.asarray(positions, float), np.asarray(opacity, np.float32)
    return Gaussians(places, turns, scales, opaque, harmonics.astype(np.float32))


def draw(made, camera=CAMERA):
    return footprint_of(made, camera).draw(made.colours(np.full((len(made), 1), SH_ZERO, np.float32)))


def test_a_gaussian_is_drawn_as_its_formula_says():
    """In the middle of the picture, 2 away: 0.1 is 2 pixels."""
    picture = draw(gaussians([[0, 0, 2.0]], [0.1], [0.8], [[1, 0.5, 0.25]]))
    column, row = np.meshgrid(np.arange(33) - 16, np.arange(25) - 12)
    distance = (column**2 + row**2) / 4
    expected = np.where(distance <= 9, 0.8 * np.exp(-distance / 2), 0)
    np.testing.assert_allclose(picture, expected[..., None] * [1, 0.5, 0.25], atol=1 / 255)


def test_the_nearer_covers_the_other_and_what_is_behind_the_eye_is_not_drawn():
    places = [[0, 0, 3.0], [0, 0, 2.0], [0, 0, -1.0]]
    picture = draw(gaussians(places, [9, 9, 9], [1, 0.75, 1], [[0, 1, 0], [1, 0, 0], [0, 0, 1]]))
    np.testing.assert_allclose(picture[12, 16], [0.75, 0.25, 0], atol=1e-3)


def test_gathering_is_the_transpose_of_drawing():
    random = np.random.default_rng(1)
    places = np.column_stack([random.uniform(-0.8, 0.8, (30, 2)), random.uniform(1.5, 3, 30)])
    made = gaussians(places, random.uniform(0.05, 0.3, 30), random.uniform(0.2, 1, 30), random.uniform(0, 1, (30, 3)))
    footprint, image = footprint_of(made, CAMERA), random.normal(size=(25, 33, 3)).astype(np.float32)
    colours = random.normal(size=(30, 3)).astype(np.float32)
    sums = footprint.gather(image)
    assert (footprint.draw(colours) * image).sum() == pytest.approx((sums[:, :3] * colours).sum(), rel=1e-3)
    white = footprint.draw(np.ones((30, 3), np.float32))
    assert sums[:, 3].sum() == pytest.approx(white[..., 0].sum(), rel=1e-4)


def test_harmonics_are_orthonormal_and_have_the_extension_s_signs():
    number = np.arange(20_000) + 0.5
    polar, around = np.arccos(1 - 2 * number / 20_000), np.pi * (1 + 5**0.5) * number
    sphere = np.stack([np.cos(around) * np.sin(polar), np.sin(around) * np.sin(polar), np.cos(polar)], axis=1)
    found = harmonics_of(sphere, 2).astype(float)
    np.testing.assert_allclose(4 * np.pi * found.T @ found / len(sphere), np.eye(9), atol=2e-3)
    for index in range(9):
        degree = int(np.sqrt(index))
        one = {f"SH_DEGREE_{degree}_COEF_{index - degree**2}": np.full((len(sphere), 3), 0.1)}
        np.testing.assert_allclose(seen_colours(one, sphere)[:, 0], 0.5 + 0.1 * found[:, index], atol=1e-6)


@pytest.fixture(scope="module", params=["opaque", "sheets", "grey"])
def scene(request):
    made = {"opaque": lambda: tiny_scene(size=96, cameras=9), "sheets": soft_scene,
            "grey": lambda: tiny_scene(channels=1, size=64)}  # fmt: skip
    return made[request.param]()


@pytest.mark.slow
def test_a_reader_of_the_extension_draws_what_the_scene_draws(scene, tmp_path):
    count, decibels = write_splats(scene, tmp_path / "a.glb", splats=3000, metres_per_unit=2.0)
    document, splats = read_splats(tmp_path / "a.glb")
    assert document["extensionsUsed"] == ["KHR_gaussian_splatting"] and "extensionsRequired" not in document
    assert len(splats["POSITION"]) == count <= 3000
    np.testing.assert_allclose(np.linalg.norm(splats["ROTATION"], axis=1), 1, atol=1e-6)
    assert ((splats["OPACITY"] > 0) & (splats["OPACITY"] <= 1)).all() and (splats["SCALE"] > 0).all()
    assert (splats["SCALE"][:, 2] < 0.1 * splats["SCALE"][:, 0]).all()  # flat
    errors = []
    for index in scene.rig.encoded:
        camera = scene.rig.cameras[index]
        expected = renderer_of(scene).draw(camera, camera_weights(scene, int(index))).image.clip(0, 1)
        drawn = draw_splats(splats, camera_of(camera, scene.rig, 2.0)).astype(np.float32)
        errors.append(np.square(drawn - expected).mean())
    assert -10 * np.log10(np.mean(errors)) == pytest.approx(decibels, abs=0.1) and decibels > 22


def test_gaussians_lie_on_the_mesh_with_its_normal():
    scene = tiny_scene(size=64)
    made, _ = fit_gaussians(scene, 500)
    x, y, z = made.positions.T
    off, on = z - 0.1 * np.sin(3 * x) * np.cos(2 * y), 440  # of 500; the others are behind the surface
    np.testing.assert_allclose(off[:on], 0, atol=0.03)  # six nodes a side
    assert len(made) > 490 and (off[on:] > 0.05).all()  # cameras look along z
    assert (np.abs(made.rotations[:, 2, 2]) > 0.9).all()
    np.testing.assert_allclose(np.linalg.det(made.rotations), 1, atol=1e-9)


def painted(colour):
    """A scene without eigen textures whose mean is `colour`, which may be one or a picture."""
    scene = tiny_scene(size=64, textures=0)
    (plane,) = scene.appearance.planes
    mean = np.broadcast_to(colour, plane.mean.shape).astype(np.float32)
    return replace(scene, appearance=replace(scene.appearance, planes=(replace(plane, mean=mean),)))


def test_more_gaussians_lie_where_there_is_more_to_see():
    scene = painted(0.5 + 0.4 * (np.indices((64, 64)).sum(axis=0) // 3 % 2 * (np.arange(64) < 32))[..., None])
    made, _ = fit_gaussians(scene, 600)
    left = (made.positions[:, 0] < 0).mean()
    assert left > 0.7


def test_a_scene_of_one_colour_keeps_it_and_has_no_holes(tmp_path):
    scene = painted([0.8, 0.4, 0.2])
    write_splats(scene, tmp_path / "a.glb", splats=400)
    drawn = draw_splats(read_splats(tmp_path / "a.glb")[1], camera_of(scene.rig.cameras[2], scene.rig))
    inside = drawn[12:-12, 16:-16].reshape(-1, 3)
    np.testing.assert_allclose(inside.mean(axis=0), [0.8, 0.4, 0.2], atol=0.02)
    assert np.abs(inside - inside.mean(axis=0)).max() < 0.12


def test_axes_are_those_of_the_scene_s_file(tmp_path):
    scene = tiny_scene(size=32)
    write_splats(scene, tmp_path / "a.glb", splats=200)
    splats = read_splats(tmp_path / "a.glb")[1]
    made, _ = fit_gaussians(scene, 200)
    turn = capture_to_gltf(scene.rig)
    np.testing.assert_allclose(splats["POSITION"], made.positions @ turn.T, atol=1e-6)
    np.testing.assert_array_equal(splats["COLOR_0"][:, 3], np.rint(255 * splats["OPACITY"][:, 0]) / 255)


def test_an_spz_has_the_same_gaussians(tmp_path):
    pytest.importorskip("gsply")
    scene = tiny_scene(size=64)
    for name in ("a.glb", "a.spz", "b.spz"):
        write_splats(scene, tmp_path / name, splats=500)
    splats, packed = read_splats(tmp_path / "a.glb")[1], read_spz(tmp_path / "a.spz")
    np.testing.assert_allclose(packed["POSITION"], splats["POSITION"], atol=1e-5)
    np.testing.assert_allclose(packed["SCALE"], splats["SCALE"], rtol=0.04)
    np.testing.assert_allclose(packed["OPACITY"], splats["OPACITY"], atol=0.003)
    np.testing.assert_allclose(packed["SH_DEGREE_0_COEF_0"], splats["SH_DEGREE_0_COEF_0"], atol=0.02)
    for index in range(5):
        name = f"SH_DEGREE_2_COEF_{index}"
        np.testing.assert_allclose(packed[name], splats[name], atol=0.005)
    assert (tmp_path / "a.spz").read_bytes() == (tmp_path / "b.spz").read_bytes()


def test_what_cannot_be_is_one_line(run, tmp_path, monkeypatch):
    save(tiny_scene(), tmp_path / "scene.glb", codec="png")
    save(numbered_clip((2, 1)), tmp_path / "clip.glb")

    def export(source, output, *options):
        code, _, err = run("export", tmp_path / source, "-o", tmp_path / output, *options)
        assert code == 2 and err.count("\n") == 1 and not (tmp_path / output).exists()
        return err

    assert "ask for 1 to 1000000" in export("scene.glb", "a.glb", "--as", "splats", "--splats", 0)
    assert "ask for 1 to" in export("scene.glb", "a.glb", "--as", "splats", "--splats", SPLATS_MOST + 1)
    assert "name it .glb" in export("scene.glb", "a.ply", "--as", "splats")
    assert "a clip is drawn at a time" in export("clip.glb", "a.glb", "--as", "splats")
    assert "is not for usdz" in export("scene.glb", "a.usdz", "--splats", 3)
    monkeypatch.setitem(sys.modules, "gsply", None)
    assert "pip install 'eigenfield[splats]'" in export("scene.glb", "a.spz")
    monkeypatch.setitem(sys.modules, "pxr", None)
    assert "pip install 'eigenfield[usd]'" in export("scene.glb", "a.usdz")
    assert run("export", tmp_path / "clip.glb", "-o", tmp_path / "a.glb", "--as", "splats", "--time", 1).code == 0
    with pytest.raises(OptionError, match="channels"):
        write_splats(tiny_scene(channels=6), tmp_path / "b.glb")


@pytest.mark.slow
def test_the_demo_as_100_000_gaussians(tmp_path):
    """Its glass ball, which they cannot show, is most of what lacks."""
    scene = ef.load(Path(__file__).parents[2] / "docs" / "scene.glb")
    count, decibels = write_splats(scene, tmp_path / "a.glb", splats=100_000)
    assert 99_000 < count <= 100_000 and decibels > 29.5
