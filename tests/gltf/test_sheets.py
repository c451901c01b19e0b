"""Scenes of sheets with an opacity: written, read, refused where they cannot be, and shown by other viewers."""

from __future__ import annotations

import copy
import io
import json
import logging
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from eigenfield.coding import limits
from eigenfield.coding.pictures.pictures_8bit import PREVIEW_MAX_SIDE_TEXELS
from eigenfield.coding.stacking import encode
from eigenfield.core.errors import FormatError, OutputError
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Sheets
from eigenfield.gltf import encode_scene, outline, parts, read_scene, save, store_scores, validate
from support import glb_surgery
from support.glb_surgery import CODECS, EXTENSION, changed, not_ours, ours, outcome
from support.soft_scenes import coded_soft_scene, soft_scene


@pytest.fixture(scope="module")
def plain():
    return encode_scene(soft_scene(), codec="png")


@pytest.fixture(scope="module")
def data():
    """Of which everything is coded."""
    return encode_scene(coded_soft_scene())


def sheet_of(scene):
    """The sheet of each face."""
    return np.repeat(np.arange(len(scene.proxy.sheets.faces)), scene.proxy.sheets.faces)


@pytest.mark.parametrize("codec", CODECS)
def test_sheets_come_back(codec):
    scene = soft_scene()
    written = encode_scene(scene, codec=codec)
    back = read_scene(written)
    assert back.proxy.sheets.faces == scene.proxy.sheets.faces == (242, 128, 98)
    assert back.proxy.sheets.opacity.dtype == np.float32
    np.testing.assert_array_equal(back.proxy.mesh.faces, scene.proxy.mesh.faces)
    off = np.abs(back.proxy.sheets.opacity - scene.proxy.sheets.opacity)
    assert off.max() <= (0.1 if codec == "avif" else 0.5001 / 255) and off.mean() < 0.01
    assert encode_scene(back) == written
    extension = glb_surgery.split(written)[0]["extensions"][EXTENSION]
    assert extension["version"] == "1.9" and extension["needs"] == ["sheets"]
    assert extension["sheets"]["opacity"].keys() == {"bufferView", "size", "mimeType"}


def test_coded_sheets_come_back_each_with_its_faces(data, tmp_path):
    """Places are on a lattice of quarter pixels; a sheet's vertices lie near those that it had."""
    scene, back = soft_scene(), read_scene(data)
    assert back.proxy.sheets.faces == (242, 128, 98)
    before, after = scene.proxy.mesh, back.proxy.mesh
    for sheet in range(3):
        own, found = before.faces[sheet_of(scene) == sheet], after.faces[sheet_of(back) == sheet]
        one, other = np.sort(before.uv[own].mean(axis=1), axis=0), np.sort(after.uv[found].mean(axis=1), axis=0)
        np.testing.assert_allclose(one, other, atol=2e-3)
        depths = before.vertices[own].mean(axis=(0, 1))[2], after.vertices[found].mean(axis=(0, 1))[2]
        assert depths[0] == pytest.approx(depths[1], abs=0.01)
    np.testing.assert_allclose(back.proxy.sheets.opacity, scene.proxy.sheets.opacity, atol=0.05)
    path = tmp_path / "scene.glb"
    path.write_bytes(data)
    assert validate(path) == [] and encode_scene(back) == data
    picture = glb_surgery.split(data)[0]["extensions"][EXTENSION]["sheets"]["opacity"]
    assert picture["mimeType"] == "video/AV1" and picture["bits"] == 10 and "scale" not in picture


@pytest.mark.parametrize("way", [copy.copy, copy.deepcopy, lambda scene: pickle.loads(pickle.dumps(scene))])
def test_copies_keep_their_bytes(data, way):
    assert encode_scene(way(read_scene(data))) == data


def test_an_opacity_that_was_edited_is_coded_anew_and_nothing_else(data, tmp_path, caplog):
    scene, path = read_scene(data), tmp_path / "scene.glb"
    sheets = scene.proxy.sheets
    edited = replace(sheets, opacity=sheets.opacity * np.float32(0.5))
    with caplog.at_level(logging.INFO, "eigenfield.format"):
        save(replace(scene, proxy=replace(scene.proxy, sheets=edited)), path)
    assert "coded anew: opacity (" in caplog.text and "mean" not in caplog.text and "mesh" not in caplog.text
    back = read_scene(path.read_bytes())
    np.testing.assert_allclose(back.proxy.sheets.opacity, edited.opacity, atol=0.1)
    old, new = (glb_surgery.split(one)[0] for one in (data, path.read_bytes()))
    assert old["extensions"][EXTENSION]["planes"][0].keys() == new["extensions"][EXTENSION]["planes"][0].keys()


def test_a_scene_may_lose_its_sheets(data, tmp_path):
    scene, path = read_scene(data), tmp_path / "scene.glb"
    save(replace(scene, proxy=replace(scene.proxy, sheets=None)), path)
    gltf = glb_surgery.split(path.read_bytes())[0]
    assert "sheets" not in gltf["extensions"][EXTENSION] and "alphaMode" not in gltf["materials"][0]
    assert "sheets" not in gltf["extensions"][EXTENSION]["needs"]
    assert parts(path)["opacity"] == 0 and validate(path) == []


def test_scores_and_outline_leave_them_alone(data, tmp_path):
    path = tmp_path / "scene.glb"
    path.write_bytes(data)
    store_scores(path, {"uv": {"psnr": 1.5}})
    np.testing.assert_array_equal(
        read_scene(path.read_bytes()).proxy.sheets.opacity, read_scene(data).proxy.sheets.opacity
    )
    scene, _ = outline(path)
    assert scene.proxy.sheets is None and len(scene.proxy.mesh.faces) == 468


WRONG = {
    "faces-missing": (not_ours("sheets", "faces"), "json-missing"),
    "opacity-missing": (not_ours("sheets", "opacity"), "json-missing"),
    "sheets-no-object": (ours("sheets", value=[1]), "json-type"),
    "no-sheet": (ours("sheets", "faces", value=[]), "json-value"),
    "too-many": (ours("sheets", "faces", value=[1] * (limits.MAX_SHEETS + 1)), "json-value"),
    "a-sheet-of-nothing": (ours("sheets", "faces", value=[242, 0, 226]), "json-value"),
    "negative": (ours("sheets", "faces", value=[500, -32]), "json-value"),
    "half-a-face": (ours("sheets", "faces", value=[242.5, 225.5]), "json-type"),
    "a-face-too-few": (ours("sheets", "faces", value=[242, 128, 97]), "sheets-faces"),
    "a-face-too-many": (ours("sheets", "faces", value=[242, 128, 99]), "sheets-faces"),
    "shared-vertex": (ours("sheets", "faces", value=[241, 129, 98]), "sheets-vertex"),
    "size-other": (ours("sheets", "opacity", "size", value=[128, 95]), "picture-size"),
    "size-huge": (ours("sheets", "opacity", "size", value=[10**6, 1]), "json-value"),
    "size-missing": (not_ours("sheets", "opacity", "size"), "json-missing"),
    "view-elsewhere": (ours("sheets", "opacity", "bufferView", value=999), "view-missing"),
    "type-unknown": (ours("sheets", "opacity", "mimeType", value="image/x-tga"), "picture-type"),
    "type-other": (ours("sheets", "opacity", "mimeType", value="image/jpeg"), "picture-damaged"),
    "codec-other": (ours("sheets", "opacity", "codec", value="mesh-2"), "codec-unknown"),
    "bits-other": (ours("sheets", "opacity", "bits", value=10), "picture-type"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_cannot_be_is_refused(tmp_path, plain, case):
    change, code = WRONG[case]
    assert outcome(tmp_path / "a.glb", changed(plain, change)) == code


def test_counts_are_held_to_the_coded_mesh_too(tmp_path, data):
    wrong = changed(data, ours("sheets", "faces", value=[242, 128, 97]))
    assert outcome(tmp_path / "a.glb", wrong) == "sheets-faces"
    with pytest.raises(FormatError, match=r"the sheets have 467 faces, the mesh has 468") as caught:
        read_scene(wrong)
    assert caught.value.where == f"/extensions/{EXTENSION}/sheets/faces"


def test_an_opacity_of_colours_is_refused(tmp_path, plain):
    def change(gltf, extension, binary):
        view = gltf["bufferViews"][extension["sheets"]["opacity"]["bufferView"]]
        picture = encode(np.zeros((*soft_scene().proxy.sheets.opacity.shape, 3), np.uint8), "png", 0)
        view["byteOffset"], view["byteLength"] = len(binary), len(picture)
        binary += picture + bytes(-len(picture) % 4)
        gltf["buffers"][0]["byteLength"] = len(binary)

    assert outcome(tmp_path / "a.glb", changed(plain, change)) == "picture-channels"


@given(st.lists(st.tuples(st.floats(0, 1), st.integers(0, 255)), min_size=1, max_size=6))
@settings(max_examples=60)
def test_flipped_bytes_never_surprise(tmp_path_factory, data, flips):
    changed = bytearray(data)
    for place, value in flips:
        changed[min(int(place * len(changed)), len(changed) - 1)] = value
    outcome(tmp_path_factory.getbasetemp() / "sheets.glb", bytes(changed))


def test_a_file_that_ends_before_its_textures_is_refused(tmp_path, plain):
    gltf, binary = glb_surgery.split(plain)
    end = glb_surgery.view_end(gltf, gltf["extensions"][EXTENSION]["sheets"]["opacity"]["bufferView"])
    assert outcome(tmp_path / "a.glb", plain[: len(plain) - len(binary) + end - 5]) == "truncated"


def with_sheets(**changes):
    scene = soft_scene()
    return replace(scene, proxy=replace(scene.proxy, sheets=replace(scene.proxy.sheets, **changes)))


@pytest.mark.parametrize("value", [-0.01, 1.01, np.nan, np.inf])
def test_an_opacity_outside_its_range_is_not_written(value, tmp_path):
    opacity = soft_scene().proxy.sheets.opacity.copy()
    opacity[3, 4] = value
    with pytest.raises(FormatError, match="in 0 to 1") as caught:
        save(with_sheets(opacity=opacity), tmp_path / "a.glb")
    assert caught.value.code == "sheets-opacity" and not (tmp_path / "a.glb").exists()


def test_an_opacity_of_three_channels_is_not_written():
    with pytest.raises(FormatError, match="one number") as caught:
        encode_scene(with_sheets(opacity=np.ones((64, 64, 3), np.float32)))
    assert caught.value.code == "sheets-opacity"


@pytest.mark.parametrize(
    ("faces", "code"), [((242, 128), "sheets-faces"), ((200, 170, 98), "sheets-vertex"), ((468, 0), "json-value")]
)
def test_sheets_that_do_not_divide_the_mesh_are_not_written(faces, code):
    with pytest.raises(FormatError) as caught:
        encode_scene(with_sheets(faces=faces))
    assert caught.value.code == code


def test_more_sheets_than_the_limit_are_not_written():
    count = limits.MAX_SHEETS + 1
    corners = np.arange(3 * count, dtype=np.int32).reshape(-1, 3)
    random = np.random.default_rng(1)
    mesh = Mesh(random.random((3 * count, 3), np.float32), corners, random.random((3 * count, 2), np.float32))
    scene = soft_scene()
    sheets = Sheets((1,) * count, scene.proxy.sheets.opacity)
    with pytest.raises(OutputError, match="33 sheets") as caught:
        encode_scene(replace(scene, proxy=replace(scene.proxy, mesh=mesh, sheets=sheets)))
    assert caught.value.code == "scene-limit"


def shown(data):
    """The picture for other viewers, and its bytes."""
    gltf, binary = glb_surgery.split(data)
    assert gltf["materials"][0]["alphaMode"] == "MASK" and "alphaCutoff" not in gltf["materials"][0]
    assert gltf["images"][0]["mimeType"] == "image/png"
    view = gltf["bufferViews"][gltf["images"][0]["bufferView"]]
    picture = binary[view["byteOffset"] :][: view["byteLength"]]
    return np.asarray(Image.open(io.BytesIO(picture)).convert("RGBA")), len(picture)


@pytest.mark.parametrize("channels", [1, 2, 3])
def test_other_viewers_get_a_mask(channels):
    """Holes where less than half is opaque; elsewhere the mean."""
    scene = soft_scene(channels)
    picture, _ = shown(encode_scene(scene, codec="png"))
    assert max(picture.shape) <= PREVIEW_MAX_SIDE_TEXELS and set(np.unique(picture[..., 3])) == {0, 255}
    opacity = np.asarray(
        Image.fromarray(scene.proxy.sheets.opacity).resize(picture.shape[1::-1], Image.Resampling.BILINEAR)
    )
    clear = np.abs(opacity - 0.5) > 0.1
    assert clear.mean() > 0.9 and ((picture[..., 3] > 0) == (opacity > 0.5))[clear].all()
    if channels == 3:
        opaque = picture[..., 3] > 0
        off = picture[opaque, :3] / 255 - scene.appearance.planes[0].mean.clip(0, 1)[opaque]
        assert np.abs(off).mean() < 0.03


def test_one_that_is_opaque_or_not_there_is_shown_too(tmp_path):
    for value in (0, 1):
        path = tmp_path / "scene.glb"
        save(with_sheets(opacity=np.full((64, 64), value, np.float32)), path, overwrite=True)
        assert validate(path) == [] and (shown(path.read_bytes())[0][..., 3] == 255 * value).all()


def test_info_says_how_many_sheets_and_what_they_cost(data, tmp_path, run):
    path = tmp_path / "scene.glb"
    path.write_bytes(data)
    sizes = parts(path)
    opacity = glb_surgery.split(data)[0]
    view = opacity["bufferViews"][opacity["extensions"][EXTENSION]["sheets"]["opacity"]["bufferView"]]
    assert sizes["opacity"] == view["byteLength"] > 0
    assert sizes["total"] == sum(size for part, size in sizes.items() if part != "total")
    code, out, _ = run("info", path)
    assert code == 0 and f", opacity {sizes['opacity']:,} (" in out
    assert "sheets        3 of 98 to 242 triangles; opacity 128x96, video/AV1" in out
    code, out, _ = run("info", "--json", path)
    facts = json.loads(out)["proxy"]
    assert facts["sheets"] == {"triangles": [242, 128, 98], "opacity": {"size": [128, 96], "type": "video/AV1"}}
    assert run("validate", path) == (0, f"{path}: no findings\n", "")
