"""Clips with sheets: each frame has an opacity and vertices of its own, from any place on, and damage is refused."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

from eigenfield.coding import limits
from eigenfield.coding.mesh.coder import decode_placed
from eigenfield.gltf import encode_scene, load, load_clip, outline, parts, save, validate
from eigenfield.gltf.group import group_bytes
from eigenfield.rendering import ViewWeights, renderer_of
from support import glb_surgery
from support.clips import (
    BITS,
    OPACITY,
    groups_of,
    moving_clip,
    numbered_clip,
    read_all,
    shown_number,
    shown_opacity,
    two_sheets,
    with_groups,
)
from support.glb_surgery import changed, not_ours, ours, outcome
from support.viewer_clips import front_steps

LENGTHS = 3, 4
FACES = 50, 18
SHOWN = "sheets", "opacity"
AT = (*SHOWN, "at")
TWICE = {"size": [64, 64], "film": 2, "at": [[0, 0], [64, 0]]}
PICTURE = {"bufferView": 0, "mimeType": "image/png", "size": [8, 8]}


@pytest.fixture(scope="module")
def still():
    return numbered_clip(LENGTHS, sheets=True)


@pytest.fixture(scope="module")
def path(still, tmp_path_factory):
    path = tmp_path_factory.mktemp("sheets") / "clip.glb"
    save(moving_clip(still, front_steps), path)
    return path


def number_of(scene):
    number = shown_opacity(scene.proxy.sheets.opacity)
    assert shown_number(scene.appearance.planes[0].mean[..., 0]) == number
    return number


def test_each_frame_has_its_own_opacity_and_vertices_in_any_order(path, still):
    (stream,) = next(found for (kind, _), found in still.groups.payloads.items() if kind == "mesh")
    placed, clip = decode_placed(stream.data), load_clip(path)
    for number in (5, 0, 6, 2, 3, 3, 1, 4):
        scene = clip.scene(clip.timeline.times[number])
        assert number_of(scene) == number
        sheets = scene.proxy.sheets
        assert sheets.faces == FACES and sheets.opacity.shape == OPACITY and sheets.opacity.dtype == np.float32
        assert sheets.opacity.max() == 1 and sheets.opacity.min() >= 0
        places = front_steps(number, placed.places)
        assert (places != placed.places).any()
        np.testing.assert_array_equal(scene.proxy.mesh.vertices, placed.lattice.points(places).astype(np.float32))
    group = pickle.loads(pickle.dumps(clip)).groups.group(1)
    assert shown_opacity(group.proxy.sheets.opacity) == 3 and shown_opacity(group.frames[2].opacity) == 5


def test_what_stands_still_is_as_opaque_in_every_frame(path):
    """All of the first sheet; what is coded beside it changes."""
    clip = load_clip(path)
    first = [clip.scene(time).proxy.sheets.opacity[: round(0.8 * OPACITY[0])] for time in clip.timeline.times]
    assert min(one.min() for one in first) > 0.995


def test_the_file_names_its_sheets_and_other_clips_do_not(path, tmp_path):
    assert validate(path) == []
    extension = glb_surgery.split(path.read_bytes())[0]["extensions"][glb_surgery.EXTENSION]
    assert "sheets" in extension["needs"] and extension["version"] == "1.11"
    assert extension["sheets"] == {"faces": list(FACES), "opacity": {"size": [128, 64], "film": 2, "at": [[0, 0]]}}
    assert extension["timeline"]["films"][2]["size"] == [128, 64]
    other = glb_surgery.split(encode_scene(numbered_clip((1,))))[0]["extensions"][glb_surgery.EXTENSION]
    assert "sheets" not in other and "sheets" not in other["needs"] and len(other["timeline"]["films"]) == 2


def test_a_copy_keeps_its_groups_byte_for_byte(path, tmp_path):
    copy = tmp_path / "copy.glb"
    save(load_clip(path), copy)
    assert copy.read_bytes() == path.read_bytes()


@pytest.mark.parametrize("number", [2, 5])
def test_a_frame_is_drawn_sheet_over_sheet(path, number):
    """White where the second sheet is, the black rim of the first where it is not."""
    scene = load_clip(path).scene(number / 10)
    camera = scene.rig.cameras[-1].resize(480, 400)
    picture = renderer_of(scene).draw(camera, ViewWeights.one(3), samples=1).image[..., 1]
    strip = scene.proxy.mesh.vertices[-16:].astype(np.float64)
    low, high = strip.min(axis=0), strip.max(axis=0)
    points = np.tile((low + high) / 2, (BITS, 1))
    points[:, 0] = low[0] + (np.arange(BITS) + 0.5) / BITS * (high[0] - low[0])
    columns, rows = camera.project(points)[0].astype(int).T
    shown = picture[rows, columns]
    assert sum(int(value > 0.5) << bit for bit, value in enumerate(shown)) == number
    assert (np.abs(shown - 0.5) > 0.3).all()


def test_a_frame_is_a_scene_of_its_own(path, tmp_path):
    scene = load(path, 0.5)
    save(scene, tmp_path / "frame.glb", codec="png")
    again = load(tmp_path / "frame.glb")
    assert again.proxy.sheets.faces == FACES and number_of(again) == 5 and validate(tmp_path / "frame.glb") == []
    np.testing.assert_allclose(again.proxy.sheets.opacity, scene.proxy.sheets.opacity, atol=0.51 / 255)


def test_other_viewers_see_the_first_frame(path):
    gltf = glb_surgery.split(path.read_bytes())[0]
    assert "alphaMode" not in gltf["materials"][0]  # a relief of the middle view, as of still sheets that are coded
    scene, _ = outline(path)
    assert scene.proxy.sheets is None and len(scene.proxy.mesh.faces) == sum(FACES)


def test_info_says_how_many_sheets_and_what_they_cost(path, run):
    sizes = parts(path)
    films = [load_clip(path).groups.coded(index).units for index in range(2)]
    assert sizes["opacity"] == sum(len(frame[2]) for units in films for frame in units) > 0
    assert sizes["total"] == sum(size for part, size in sizes.items() if part != "total")
    out = run("info", path).out
    assert f", opacity {sizes['opacity']:,} (" in out
    assert "sheets        2 of 18 to 50 triangles; opacity 128x64, video/AV1" in out
    facts = json.loads(run("info", "--json", path).out)
    assert facts["proxy"]["sheets"] == {"triangles": [50, 18], "opacity": {"size": [128, 64], "type": "video/AV1"}}
    assert facts["clip"]["films"][2]["bytes"] == sizes["opacity"]


WRONG = {
    "faces-missing": (not_ours("sheets", "faces"), "json-missing"),
    "opacity-missing": (not_ours(*SHOWN), "json-missing"),
    "sheets-no-object": (ours("sheets", value=[1]), "json-type"),
    "sheets-null": (ours("sheets", value=None), "json-type"),
    "no-sheet": (ours("sheets", "faces", value=[]), "json-value"),
    "too-many": (ours("sheets", "faces", value=[1] * (limits.MAX_SHEETS + 1)), "json-value"),
    "a-face-too-few": (ours("sheets", "faces", value=[50, 17]), "sheets-faces"),
    "shared-vertex": (ours("sheets", "faces", value=[49, 19]), "sheets-vertex"),
    "size-missing": (not_ours(*SHOWN, "size"), "json-missing"),
    "size-huge": (ours(*SHOWN, "size", value=[10**6, 1]), "json-value"),
    "size-beyond": (ours(*SHOWN, "size", value=[129, 64]), "film-place"),
    "film-missing": (not_ours(*SHOWN, "film"), "json-missing"),
    "film-beyond": (ours(*SHOWN, "film", value=3), "json-value"),
    "film-of-others": (ours(*SHOWN, "film", value=1), "film-place"),
    "place-missing": (not_ours(*AT), "json-missing"),
    "no-place": (ours(*AT, value=[]), "json-value"),
    "two-places": (ours(*SHOWN, value=TWICE), "film-place"),
    "odd-place": (ours(*AT, value=[[8, 0]]), "film-place"),
    "place-beyond": (ours(*AT, value=[[16, 0]]), "film-place"),
    "film-gone": (lambda gltf, extension, binary: extension["timeline"]["films"].pop(), "json-value"),
    "a-picture": (ours(*SHOWN, value=PICTURE), "json-missing"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_cannot_be_is_refused(tmp_path, path, case):
    change, code = WRONG[case]
    assert outcome(tmp_path / "a.glb", changed(path.read_bytes(), change), read_all) == code


def test_groups_whose_films_are_too_few_or_of_another_size_are_refused(tmp_path, path):
    data, coded = path.read_bytes(), load_clip(path).groups.coded(0)
    rest = groups_of(data)[1:]
    few = replace(coded, units=tuple(frame[:2] for frame in coded.units))
    assert outcome(tmp_path / "a.glb", with_groups(data, [group_bytes(few), *rest]), read_all) == "group-damaged"
    swapped = replace(coded, units=tuple((mean, opacity, own) for mean, own, opacity in coded.units))
    assert outcome(tmp_path / "a.glb", with_groups(data, [group_bytes(swapped), *rest]), read_all) == "film-size"
    noise = replace(coded, units=tuple((*frame[:2], frame[2][:20]) for frame in coded.units))
    code = outcome(tmp_path / "a.glb", with_groups(data, [group_bytes(noise), *rest]), read_all)
    assert code in ("film-damaged", "film-frames")


def test_the_sheets_of_tests_are_those_of_the_file(still):
    assert two_sheets().sheets.faces == still.groups.sheets == FACES
