"""The ladder of losses, on captures where each is known: exact geometry, all components, a shift put in by hand."""

from __future__ import annotations

import dataclasses

import cv2
import numpy as np
import pytest

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.core.camera import Camera
from eigenfield.gltf import save
from eigenfield.imaging.metrics import psnr
from eigenfield.proxy import read_mesh
from evidence.displacement import displacement, moved_back
from evidence.losses import as_encoded, encode_again, ladder, losses, rounded_to_codes
from evidence.prepared import every
from evidence.truth import compare
from support.captures import write_capture
from support.planes import paint
from support.scenes import row_grid

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def coded(tmp_path_factory):
    folder = write_capture(tmp_path_factory.mktemp("losses") / "capture", cameras=row_grid(9, 64, 56))
    light_field = open_capture(folder)
    file = folder / "scene.glb"
    save(ef.encode(light_field, folder / "proxy.ply", textures=3, density=1.0, fit="none"), file, quality=40)
    return folder, light_field, file


def test_shares_add_up_and_switching_losses_off_helps(coded):
    _, light_field, file = coded
    result = losses(file, light_field, quality=40)
    rows = {row["key"]: row for row in result["rows"]}
    assert list(rows) == ["file", "codec", "quantisation", "truncation", "resampling", "left"]
    assert sum(row.get("share", 0.0) for row in rows.values()) == pytest.approx(1)
    errors = [rows[key]["mse"] for key in ("file", "codec", "truncation", "resampling")]
    assert errors == sorted(errors, reverse=True) and errors[0] > 1.5 * errors[-1]
    for row in rows.values():
        assert row["psnr_of_mse"] == pytest.approx(10 * np.log10(255**2 / row["mse"]))
    gains = sum(row.get("gain", 0.0) for row in rows.values())
    assert gains == pytest.approx(rows["resampling"]["psnr_of_mse"] - rows["file"]["psnr_of_mse"])


def test_the_file_is_measured_as_evaluate_measures_it(coded):
    _, light_field, file = coded
    row = losses(file, light_field, alone=False)["rows"][0]
    theirs = ef.evaluate(ef.load(file), light_field, png_maps="none")["image"]["encoded"]
    assert row["psnr"] == pytest.approx(theirs["psnr"], abs=1e-6)
    assert row["psnr_luma"] == pytest.approx(theirs["psnr_luma"], abs=1e-6)


def test_with_all_components_truncation_loses_nothing(coded, tmp_path):
    folder, light_field, _ = coded
    file = tmp_path / "all.glb"
    save(ef.encode(light_field, folder / "proxy.ply", textures=8, density=1.0, fit="none"), file, codec="webp")
    rows = {row["key"]: row for row in losses(file, light_field, alone=False)["rows"]}
    assert rows["truncation"]["psnr_of_mse"] == pytest.approx(rows["quantisation"]["psnr_of_mse"], abs=0.1)
    assert rows["codec"]["mse"] == pytest.approx(rows["file"]["mse"], rel=1e-6)  # webp keeps every code


@pytest.mark.parametrize("options", [{"harmonise": "affine"}, {"align": True}])
def test_harmonised_and_aligned_scenes_are_encoded_and_drawn_again_as_they_were(coded, tmp_path, options):
    folder, light_field, _ = coded
    file = tmp_path / "scene.glb"
    scene = ef.encode(light_field, folder / "proxy.ply", textures=8, density=1.0, fit="none", **options)
    save(scene, file, codec="webp")
    rows = {row["key"]: row for row in losses(file, light_field, alone=False)["rows"]}
    assert rows["codec"]["mse"] == pytest.approx(rows["file"]["mse"], rel=1e-6)
    assert rows["truncation"]["psnr_of_mse"] == pytest.approx(rows["quantisation"]["psnr_of_mse"], abs=0.1)


def test_encoding_again_gives_the_same_bytes(coded):
    _, light_field, file = coded
    scene = ef.load(file)
    again = encode_again(scene, as_encoded(scene, light_field))
    first = ef.encode(light_field, file.parent / "proxy.ply", textures=3, density=1.0, fit="none")
    for a, b in zip(again.appearance.planes, first.appearance.planes, strict=True):
        assert (a.mean == b.mean).all() and (a.bases[0].textures == b.bases[0].textures).all()
    codes = rounded_to_codes(again).appearance.planes[0].bases[0].textures
    lossless = file.parent / "webp.glb"
    save(first, lossless, codec="webp")
    assert (codes == ef.load(lossless).appearance.planes[0].bases[0].textures).all()


def test_a_loss_alone_comes_from_a_whole_file_of_its_own(coded):
    _, light_field, file = coded
    alone = {row["key"]: row for row in losses(file, light_field, quality=40)["alone"]}
    assert set(alone) == {"quantisation", "truncation", "resampling"}
    assert alone["truncation"]["bytes"] > file.stat().st_size
    assert alone["truncation"]["gain"] > 0


def test_a_missing_photograph_is_named(coded):
    _, light_field, file = coded
    with pytest.raises(ValueError, match="view_00"):
        losses(file, light_field.subset(range(1, 9)))


def test_the_ladder_of_known_errors():
    rungs = {
        key: {"mse": mse, "psnr_of_mse": 10 * np.log10(255**2 / mse), "psnr": 0.0, "psnr_luma": 0.0}
        for key, mse in {"file": 8.0, "quantisation": 6.0, "truncation": 2.0}.items()
    }
    rows = ladder(rungs)
    assert [row.get("share") for row in rows] == [None, 0.25, 0.5, 0.25]
    assert rows[2]["gain"] == pytest.approx(10 * np.log10(3))


def shifted(x: float, y: float) -> tuple[np.ndarray, np.ndarray]:
    """A picture, and the same moved by x to the right and y down, exactly (it repeats: Fourier)."""
    picture = paint(3, size=128, detail=2.0)
    fy, fx = np.meshgrid(np.fft.fftfreq(128), np.fft.fftfreq(128), indexing="ij")
    turn = np.exp(-2j * np.pi * (fx * x + fy * y))[..., None]
    moved = np.real(np.fft.ifft2(np.fft.fft2(picture, axes=(0, 1)) * turn, axes=(0, 1)))
    return tuple(np.clip(np.rint(p), 0, 255).astype(np.uint8) for p in (picture, moved))


def test_a_known_shift_is_found_and_undone():
    photograph, drawn = shifted(0.8, -0.5)
    covered = np.ones(photograph.shape[:2], bool)
    flow = displacement(drawn, photograph, covered)
    inner = (slice(16, -16), slice(16, -16))
    assert np.median(flow[inner], axis=(0, 1)) == pytest.approx([0.8, -0.5], abs=0.05)
    back = moved_back(drawn, flow, covered)
    assert psnr(back[inner], photograph[inner]) > psnr(drawn[inner], photograph[inner]) + 8


def test_a_shift_is_limited_and_none_is_found_where_there_is_none():
    photograph, drawn = shifted(3.0, 0.0)
    covered = np.ones(photograph.shape[:2], bool)
    assert np.linalg.norm(displacement(drawn, photograph, covered), axis=2).max() <= 2 + 1e-5
    still = displacement(photograph, photograph, covered)
    assert np.abs(still).max() < 0.01
    assert (moved_back(photograph, np.zeros_like(still), covered) == photograph).all()


def test_uncovered_pixels_neither_move_nor_are_sampled():
    photograph, drawn = shifted(1.0, 0.0)
    covered = np.zeros(photograph.shape[:2], bool)
    covered[:, 30:90] = True
    hidden = np.where(covered[..., None], drawn, np.uint8(0))
    flow = displacement(hidden, photograph, covered)
    assert (flow[~covered] == 0).all()
    back = moved_back(hidden, flow, covered)
    assert (back[~covered] == 0).all()
    assert psnr(back, photograph, covered) > psnr(hidden, photograph, covered) + 3


def test_wrong_cameras_cost_what_a_shift_brings_back(coded):
    """The same photographs on cameras turned a little, each its own way: true geometry draws better, the shift finds
    most of the difference, and where there is none it finds less."""
    folder, light_field, _ = coded
    random = np.random.default_rng(2)
    views = []
    for view in light_field.views:
        camera = view.camera
        turn = cv2.Rodrigues(random.normal(0, 0.012, 3))[0]
        views.append(dataclasses.replace(view, camera=Camera(camera.K, turn @ camera.R, turn @ camera.t, 64, 56)))
    wrong = dataclasses.replace(light_field, views=tuple(views))
    mesh = read_mesh(folder / "proxy.ply")
    scenes = {
        kind: (ef.encode(capture, mesh, textures=2, density=1.0, fit="none"), capture)
        for kind, capture in {"true": light_field, "estimated": wrong}.items()
    }
    result = compare(scenes, list(light_field.names))
    assert result["cost"] > 1
    assert result["estimated"]["displacement"]["gain"] > result["true"]["displacement"]["gain"] + 0.3
    assert result["estimated"]["displacement"]["median_px"] > result["true"]["displacement"]["median_px"]


def test_every_second_row_and_column_of_a_grid(coded):
    _, light_field, _ = coded
    assert every(light_field, 2).names == light_field.subset([0, 2, 6, 8]).names
