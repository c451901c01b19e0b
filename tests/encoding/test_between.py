"""What `encode` says of views between the photographs: true figures of held-out ones, else a lower estimate."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.encoding import left_out as left_out_module
from eigenfield.encoding.left_out import (
    farthest_neighbour,
    interpolation,
    neighbour_parallax,
    others_around,
    spread_inside,
)
from eigenfield.encoding.verdict import score_words
from eigenfield.encoding.views import make_rig
from eigenfield.gltf import load, save
from eigenfield.imaging.metrics import psnr
from eigenfield.rendering import Renderer, ViewWeights, draw_texture
from support.captures import backdrop, shaded_texture, write_capture
from support.observations import CalibratedInMemory, InMemory
from support.program import call
from support.scenes import row_grid


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return write_capture(tmp_path_factory.mktemp("between") / "nine", row_grid(9, 192, 168))


def encoded(folder, **options):
    return ef.encode(open_capture(folder), proxy=folder / "proxy.ply", textures=6, **options)


@pytest.mark.slow
@pytest.mark.parametrize("fit", ["photographs", "none"])
def test_the_estimate_is_below_the_true_figure_and_near_it(fit, folder):
    """The middle photograph is the one that is left out; the truth is a scene that is made without it."""
    scores = encoded(folder, fit=fit).scores
    held = encoded(folder, fit=fit, hold_out="view_04.png")
    truth = ef.evaluate(held, open_capture(folder), progress=None)["image"]["held_out"]
    assert held.scores["image"]["held_out"] == {"cameras": 1, "psnr": pytest.approx(truth["psnr"], abs=0.01)}
    between = scores["between"]
    assert between["cameras"] == 1 and between["widest"][0] == "view_04.png"
    assert 0.7 * truth["psnr_luma"] < between["psnr_luma_at_least"] < truth["psnr_luma"] + 0.3
    assert scores["image"]["encoded"]["psnr"] > between["psnr_luma_at_least"] + 3


def grid_rig(centres):
    K = np.array([[60.0, 0, 32], [0, 60, 28], [0, 0, 1]])
    cameras = [Camera(K, np.eye(3), -np.array([x, y, -3.0]), 64, 56) for x, y in centres]
    return make_rig([str(i) for i in range(len(cameras))], cameras, np.zeros(len(cameras), bool), 0)


def test_the_captured_figure_is_that_of_evaluate(folder):
    scene = encoded(folder)
    truth = ef.evaluate(scene, open_capture(folder), progress=None)["image"]["encoded"]
    assert scene.scores["image"]["encoded"] == {"cameras": 9, "psnr": pytest.approx(truth["psnr"], abs=0.01)}


def test_it_is_in_the_file_and_stays_there(folder, tmp_path, run):
    file = tmp_path / "scene.glb"
    assert call("encode", folder, "--proxy", folder / "proxy.ply", "-n", "4", "-q", "-o", file) == 0
    between = load(file).scores["between"]
    assert run("evaluate", file, folder, "--store", "-q")[0] == 0
    stored = load(file).scores
    assert stored["between"] == between and "ssim" in stored["image"]["encoded"]
    assert json.loads(run("info", file, "--json")[1])["scores"]["between"] == between
    assert "psnr_luma_at_least" in run("info", file)[1]


def test_many_cameras_near_each_other_are_drawn_by_the_finished_scene(tmp_path, monkeypatch):
    moved = np.random.default_rng(1).uniform(-0.1, 0.1, (9, 3)) * (1, 1, 0)  # so that one triangle is the best
    cameras = [replace(camera, t=camera.t + by) for camera, by in zip(row_grid(9, 192, 168), moved, strict=True)]
    folder = write_capture(tmp_path / "moved", tuple(cameras))
    whole = encoded(folder, fit="none").scores["between"]
    monkeypatch.setattr(left_out_module, "BETWEEN_FEW_CAMERAS", 8)
    scene = encoded(folder, fit="none")
    drawn = scene.scores["between"]
    (left_out,) = spread_inside(scene.rig)
    others = np.delete(np.arange(9), left_out)
    mixed = interpolation(scene.rig, others.tolist(), [left_out])[0]
    picture = Renderer(scene).draw(scene.rig.cameras[left_out], ViewWeights(others, mixed))
    truth = psnr(picture.image, open_capture(folder).photograph(left_out).pixels, picture.covered)
    assert drawn == {"cameras": 1, "psnr": pytest.approx(truth, abs=0.01)}
    assert drawn["psnr"] < scene.scores["image"]["encoded"]["psnr"]
    monkeypatch.setattr(left_out_module, "NEIGHBOUR_MAX_PARALLAX_RATIO", 0.001)
    some = encoded(folder, fit="none").scores["between"]
    assert some["cameras"] == 1 and some["psnr_luma_at_least"] == pytest.approx(whole["psnr_luma_at_least"], abs=1)


def test_cameras_left_out_that_show_nothing_are_passed_over(tmp_path):
    """Two of nine cameras on a line are left out, of which first one, then both are hidden."""
    mesh, first = backdrop(), row_grid(1, 136, 128)[0]
    cameras = [replace(first, t=np.array([0.6 - 0.1 * index - 0.006 * index**2, 0, 3.0])) for index in range(9)]
    pictures = [draw_texture(mesh, shaded_texture(i, 9), camera).image for i, camera in enumerate(cameras)]
    one, other = spread_inside(make_rig([str(i) for i in range(9)], cameras, np.zeros(9, bool), 4))

    def scores(*hidden):
        masks = [np.zeros((128, 136), np.float32) if index in hidden else None for index in range(9)]
        scene = ef.encode(CalibratedInMemory(InMemory(pictures, masks), cameras), mesh, textures=2, fit="none")
        save(scene, tmp_path / "scene.glb", overwrite=True)
        return load(tmp_path / "scene.glb").scores

    between = scores(one)["between"]
    assert between["cameras"] == 1 and between["widest"][0] == f"camera {other}" and between["psnr_luma_at_least"] > 20
    unknown = scores(one, other)
    assert "between" not in unknown and unknown["image"]["encoded"]["cameras"] == 7
    assert score_words(unknown) == [f"{unknown['image']['encoded']['psnr']:.1f} dB in captured views"]


def test_held_out_photographs_that_show_nothing_leave_the_estimate(tmp_path):
    folder = write_capture(tmp_path / "hidden", row_grid(6, 136, 128))
    path = folder / "images" / "view_05.png"
    with Image.open(path) as picture:
        picture.putalpha(0)
        picture.save(path)
    scores = encoded(folder, fit="none", hold_out="view_05.png").scores
    assert scores["image"]["held_out"] == {"cameras": 0, "psnr": None}
    assert scores["between"]["psnr_luma_at_least"] > 10


def test_of_many_cameras_those_around_each_are_taken():
    rig = grid_rig([(x, y) for y in range(9) for x in range(9)])
    left_out = spread_inside(rig)
    taken = others_around(rig, left_out)
    beside = {i + d for i in left_out for d in (-9, -1, 1, 9)}
    assert (
        len(left_out) == 12 and beside <= taken and not taken & set(left_out) and rig.reference in taken | {*left_out}
    )


def test_parallax_is_what_near_and_far_parts_of_the_surface_differ_by():
    """A chequered pattern of squares at depths 2 and 4, seen by cameras 0.1 apart."""
    x, y = (index.reshape(-1, 1) for index in np.mgrid[-4:4, -4:4])
    depth = np.broadcast_to(2.0 + 2 * ((x + y) % 2), (64, 4))
    x, y = x + np.array([0, 1, 1, 0]), y + np.array([0, 0, 1, 1])
    faces = 4 * np.arange(64)[:, None, None] + [[0, 1, 2], [0, 2, 3]]
    mesh = Mesh(
        np.stack([0.4 * depth * x, 0.4 * depth * y, depth], -1).reshape(-1, 3).astype(np.float32),
        faces.reshape(-1, 3).astype(np.int32),
    )
    K = np.array([[100.0, 0, 100], [0, 100, 90], [0, 0, 1]])
    cameras = [Camera(K, np.eye(3), -np.array([0.1 * i, 0, 0]), 200, 180) for i in range(3)]
    assert 200 * neighbour_parallax(cameras, Proxy(mesh)) == pytest.approx(100 * 0.1 * (1 / 2 - 1 / 4), rel=0.02)


def test_scenes_of_few_cameras_and_small_ones_have_no_scores(tmp_path):
    few = write_capture(tmp_path / "four", row_grid(4, 64, 56))
    scene = encoded(few)
    save(scene, tmp_path / "four.glb")
    assert scene.scores == {} and load(tmp_path / "four.glb").scores == {}


def test_cameras_left_out_are_inside_and_no_neighbours():
    def chosen(centres):
        return spread_inside(grid_rig(centres))

    assert chosen([(x, y) for y in range(3) for x in range(3)]) == [4]
    assert chosen([*((x, y) for y in range(3) for x in range(3)), (1, 1)]) == [4, 9]  # two in one place
    inner = chosen([(x, y) for y in range(5) for x in range(5)])
    assert 2 <= len(inner) <= 6 and all(i % 5 not in (0, 4) and i // 5 not in (0, 4) for i in inner)
    assert chosen([(x, 0) for x in (0, 1, 2, 4, 7)]) == [3]


def test_shots_from_one_place_are_left_out_together(monkeypatch):
    """A grid of places with three shots from each, 0.01 apart."""
    rig = grid_rig([(x + 0.01 * shot, y) for y in range(3) for x in range(3) for shot in range(3)])
    left_out = spread_inside(rig)
    assert left_out == [12, 13, 14] and farthest_neighbour(rig, 13) not in (12, 13, 14)
    monkeypatch.setattr(left_out_module, "BETWEEN_FEW_CAMERAS", 8)
    assert {9, 10, 11, 3, 4, 5} <= others_around(rig, left_out) <= {*range(27)} - {*left_out}
    line = grid_rig([(x + 0.01 * shot, 0) for x in (0, 1, 2, 4, 7) for shot in range(2)])
    assert spread_inside(line) == [6, 7]
