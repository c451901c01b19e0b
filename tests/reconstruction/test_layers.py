"""Soft sheets from photographs: what they show, when they are taken, and who gets none."""

from __future__ import annotations

import logging
import re

import numpy as np
import pytest
from PIL import Image

from eigenfield.capture import open_any
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.metrics import psnr
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import atlas_fault
from eigenfield.reconstruction.layers import compare_held_out, draw_means, fit_views, layers_fault
from eigenfield.reconstruction.whole import reconstruct
from eigenfield.stereo import view_matrices
from eigenfield.stereo.views import mark_outside
from support.captures import write_array
from support.planes import cropped

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def photos(tmp_path_factory):
    folder = tmp_path_factory.mktemp("array") / "photos"
    write_array(folder)
    return folder


@pytest.fixture(scope="module")
def made(photos, tmp_path_factory):
    work = tmp_path_factory.mktemp("work")
    return work, reconstruct(open_any(photos), surface="layers", layers=3, work=work)


def test_an_array_gets_sheets(made):
    _, result = made
    sheets = result.proxy.sheets
    assert list(result.seconds) == ["array", "layers"]
    assert 1 <= len(sheets.faces) <= 3
    assert sum(sheets.faces) == len(result.proxy.mesh.faces)
    assert sheets.opacity.min() >= 0
    assert sheets.opacity.max() <= 1
    assert result.proxy.lattice.flat
    assert atlas_fault(result.proxy.mesh) is None
    for camera in result.light_field.cameras:
        assert (rasterise_view(result.proxy.mesh, camera).face >= 0).mean() > 0.995


def test_finished_sheets_are_taken_up(photos, made):
    work, first = made
    again = reconstruct(open_any(photos), surface="layers", layers=3, work=work).proxy
    assert again.sheets.faces == first.proxy.sheets.faces
    for name in ("vertices", "faces", "uv"):
        assert np.array_equal(getattr(again.mesh, name), getattr(first.proxy.mesh, name))
    assert np.array_equal(again.sheets.opacity, first.proxy.sheets.opacity)
    assert np.array_equal(again.lattice.matrix, first.proxy.lattice.matrix)


@pytest.mark.slow
def test_auto_says_which_surface_draws_views_left_out_better(photos, made, caplog):
    work, _ = made
    with caplog.at_level(logging.INFO):
        result = reconstruct(open_any(photos), work=work)
    lines = [record.getMessage() for record in caplog.records if "views left out" in record.getMessage()]
    assert len(lines) == 1
    assert lines[0].endswith(" layers") == (result.proxy.sheets is not None)
    assert re.match(
        r"views left out: (relief|surface from all sides) \d+\.\d+ dB, 4 layers \d+\.\d+, 8 layers ", lines[0]
    )
    assert reconstruct(open_any(photos), layers=1, work=work).proxy.sheets is None


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"layers": 0}, "0 layers"),
        ({"layers": 33}, "33 layers"),
        ({"layers": 1, "surface": "layers"}, "one layer"),
        ({"layers": 4, "surface": "relief"}, "relief surface has no 4 layers"),
        ({"surface": "layers", "background": False}, "background=False"),
        ({"surface": "layers", "primitives": ["sphere:0,0,5,1"]}, "with primitives"),
    ],
)
def test_options_that_cannot_be(photos, options, words):
    with pytest.raises(OptionError, match=words):
        reconstruct(open_any(photos), **options)


@pytest.mark.parametrize(("given", "words"), [("0", "0 layers"), ("33", "33 layers"), ("many", "a number, or auto")])
def test_the_verb_refuses_numbers_of_layers_in_one_line(photos, tmp_path, run, given, words):
    code, _, err = run("encode", photos, "--layers", given, "-o", tmp_path / "scene.glb")
    assert code == 2
    assert words in err


def test_texture_maps_have_one_surface(photos, made, tmp_path, run):
    work, _ = made
    code, _, err = run("encode", photos, "--fit", "none", "--surface", "layers", "-o", tmp_path / "scene.glb")
    assert code == 2
    assert "--fit none" in err
    code, _, err = run("encode", photos, "--fit", "none", "-n", "3", "--work", work, "-o", tmp_path / "scene.glb")
    assert code == 0, err
    assert "trial" not in err


def test_photographs_with_masks_have_no_sheets(photos, tmp_path, made):
    masks = tmp_path / "masks"
    masks.mkdir()
    for path in photos.iterdir():
        Image.fromarray(np.pad(np.full((96, 90), 255, np.uint8), ((0, 0), (6, 0)))).save(masks / path.name)
    with pytest.raises(OptionError, match="masks"):
        reconstruct(open_any(photos, masks=masks), surface="layers")


def ring(count, degrees):
    """Cameras side by side, whose axes are spread over an angle."""
    K = np.array([[80.0, 0, 32], [0, 80, 24], [0, 0, 1]])
    made = []
    for index, angle in enumerate(np.radians(np.linspace(-degrees / 2, degrees / 2, count))):
        turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
        made.append(Camera(K, turn, turn @ [-0.1 * index, 0, 0], 64, 48))
    return made


def test_who_can_have_sheets():
    assert layers_fault(ring(3, 20)) is None
    assert "too few" in layers_fault(ring(2, 20))
    assert "do not look one way" in layers_fault(ring(5, 90))
    assert "do not look one way" in layers_fault(ring(4, 340))


def wall(depth):
    corners = np.array([(x, y, depth) for y in (-9, 9) for x in (-9, 9)], np.float32)
    return Mesh(corners, np.array([[0, 1, 3], [0, 3, 2]], np.int32))


def wall_pictures(cameras, depth=4.0):
    """Photographs of a wall with a pattern."""
    found = []
    for camera in cameras:
        row, column = np.indices((camera.height, camera.width)) + 0.5
        rays = np.stack([column, row, np.ones_like(row)], axis=-1) @ np.linalg.inv(camera.K).T @ camera.R
        x, y = np.moveaxis(camera.centre[:2] + rays[..., :2] * depth / rays[..., 2:], -1, 0)
        waves = np.stack([np.sin(9 * x + 2 * y), np.cos(7 * y), np.sin(5 * (x - y))], axis=-1)
        found.append(np.rint(127.5 + 100 * waves).astype(np.uint8))
    return np.stack(found)


def test_a_view_is_drawn_with_the_mean_of_the_photographs_that_see_it():
    cameras = ring(5, 4)
    pictures = wall_pictures(cameras)
    ((drawn, covered),) = draw_means(wall(4.0), cameras[2:3], pictures[[0, 1, 3, 4]], [*cameras[:2], *cameras[3:]])
    assert covered.mean() > 0.95
    assert psnr(drawn, pictures[2], covered) > 34
    ((_, nothing),) = draw_means(wall(-4.0), cameras[2:3], pictures[:1], cameras[:1])
    assert not nothing.any()


def test_views_left_out_tell_a_right_surface_from_a_wrong_one():
    cameras = ring(6, 4)
    pictures = wall_pictures(cameras)
    (sheets,), right = compare_held_out(pictures, cameras, (0.2, 0.3), wall(4.0), counts=[2])
    assert min(sheets, right) > 34
    assert compare_held_out(pictures, cameras, (0.2, 0.3), wall(6.0), counts=[2])[1] < right - 6


def test_photographs_lying_and_upright_are_judged_by_what_they_show():
    cameras = ring(6, 4)
    places = [(slice(0, 48), slice(10, 54)) if index % 2 else (slice(4, 44), slice(0, 64)) for index in range(6)]
    smeared = cropped(wall_pictures(cameras), places)
    marked = mark_outside(smeared, places)
    (sheets,), right = compare_held_out(marked, cameras, (0.2, 0.3), wall(4.0), counts=[2])
    assert min(sheets, right) > 32
    (blurred,), wrong = compare_held_out(smeared, cameras, (0.2, 0.3), wall(4.0), counts=[2])
    assert max(blurred, wrong) < 26


def test_more_sheets_are_not_tried_where_the_fewest_are_far_from_enough():
    cameras, told = ring(6, 4), []
    pictures = wall_pictures(cameras)
    tried = {"counts": [2, 3], "progress": lambda *said: told.append(said)}
    scores, opaque = compare_held_out(pictures, cameras, (0.2, 0.3), wall(4.0), min_gain=30.0, **tried)
    assert scores[0] == scores[1] < opaque + 30
    steps = told[-1][2]
    assert told[-2:] == [("sheets", steps // 2, steps), ("sheets", steps, steps)]
    whole, same = compare_held_out(pictures, cameras, (0.2, 0.3), wall(4.0), min_gain=0.0, **tried)
    assert (whole[0], same) == (scores[0], opaque)
    assert told[-2:] == [("sheets", steps - 1, steps), ("sheets", steps, steps)]


def test_the_reference_view_holds_every_frame():
    cameras = ring(4, 6)
    reference, (sheets,) = fit_views(wall_pictures(cameras), cameras, (0.2, 0.3), [2])
    assert sheets.labels.shape == (2, *reference.shape)
    for matrix in view_matrices(reference, cameras):
        corners = np.array([(x, y, 1.0) for x in (0, 63) for y in (0, 47)])
        places = corners @ np.linalg.inv(matrix[:, [0, 1, 3]] + 0.21 * np.outer(matrix[:, 2], [0, 0, 1])).T
        places = places[:, :2] / places[:, 2:]
        assert (places >= -1).all()
        assert (places <= np.array(reference.shape[::-1])).all()
