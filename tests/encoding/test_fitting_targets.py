"""Fits that are to reach a size or a quality, and what a quality decides: mesh, atlas and densities."""

from __future__ import annotations

import pytest

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.core.payloads import mesh_key, size_of
from eigenfield.encoding import EncodeOptions, Target
from eigenfield.encoding.fitted.fit import coded_psnr
from eigenfield.encoding.fitted.planes import PLANE_PRESETS, plane_size
from eigenfield.encoding.options import density_for_quality
from eigenfield.encoding.reach_target import FIGURES_MAX_BYTES
from eigenfield.evaluation import evaluate
from eigenfield.gltf import encode_scene, validate
from eigenfield.gltf.container import parse_glb
from support.captures import write_capture
from support.scenes import row_grid
from support.surfaces import relief


@pytest.mark.slow
def test_figures_are_measured_of_the_file_that_is_kept(fitted, monkeypatch):
    """They are measured once, and take no more bytes than the search leaves for them."""
    folder, output = fitted
    files, drawn = [], []
    monkeypatch.setattr(
        "eigenfield.encoding.reach_target.encode_scene", lambda scene: files.append(encode_scene(scene)) or files[-1]
    )
    monkeypatch.setattr(
        "eigenfield.encoding.fitted.planes.coded_psnr", lambda *given: drawn.append(coded_psnr(*given)) or drawn[-1]
    )
    options = {"proxy": folder / "proxy.ply", "textures": 4, "fit": "photographs"}
    made = ef.encode(open_capture(folder), **options, target=Target(size=output.stat().st_size))
    assert len(files) > 1 and len(drawn) == 2
    assert [one["coded"] for one in made.settings["fitted"]["psnr"].values()] == [round(one, 3) for one in drawn]
    assert any(abs(len(tried) - len(encode_scene(made))) <= FIGURES_MAX_BYTES for tried in files)
    assert len(encode_scene(made)) <= output.stat().st_size


@pytest.mark.slow
def test_a_size_is_kept_to(fitted, tmp_path, run):
    """Without anything for other viewers, whose bytes go to the pictures."""
    folder, output = fitted
    limit = output.stat().st_size * 9 // 10
    words = ["--proxy", folder / "proxy.ply", "-n", "4", "-q", "--target-size", limit, "--fallback", "none"]
    code, _, err = run("encode", folder, *words, "-o", tmp_path / "small.glb")
    assert code == 0, err
    assert "meshes" not in parse_glb((tmp_path / "small.glb").read_bytes()).json
    size = (tmp_path / "small.glb").stat().st_size
    assert 0.85 * limit < size <= limit
    assert validate(tmp_path / "small.glb") == []


@pytest.mark.slow
def test_a_psnr_is_reached_and_one_that_cannot_be_is_said_to_be_out_of_reach(fitted, caplog):
    folder, _ = fitted
    capture = open_capture(folder)
    options = {"proxy": folder / "proxy.ply", "textures": 4, "fit": "photographs"}
    scene = ef.encode(capture, **options, target=Target(psnr=36))
    figures = evaluate(scene, capture)["image"]["encoded"]
    assert 36 <= figures["psnr"] < 38
    assert not caplog.records
    best = ef.encode(capture, **options, target=Target(psnr=80))
    assert best.settings["fitted"]["quality"] == 99
    assert caplog.text.count("80 cannot be reached") == 1


@pytest.mark.slow
def test_a_target_far_from_the_preset_has_a_mesh_of_its_own(tmp_path, caplog, monkeypatch):
    cameras = row_grid(9, 64, 56)
    folder = write_capture(tmp_path / "relief", cameras, relief(cameras[4], 0.5, False))
    capture, options = open_capture(folder), {"proxy": folder / "proxy.ply", "textures": 2, "density": 1.5}
    asked = Target(psnr=25)
    with caplog.at_level("INFO", "eigenfield.encode"):
        monkeypatch.setattr("eigenfield.encoding.reach_target.REFIT_MIN_MESH_RATIO", 0.1)
        once = ef.encode(capture, **options, target=asked)
        assert "fitted again for quality" not in caplog.text  # the meshes differ by less
        monkeypatch.setattr("eigenfield.encoding.reach_target.REFIT_MIN_MESH_RATIO", 1e-3)
        found = ef.encode(capture, **options, target=asked)
    assert "fitted again for quality" in caplog.text and "not kept" not in caplog.text
    assert len(found.proxy.mesh.faces) < len(once.proxy.mesh.faces)
    meshes = [size_of(scene.payloads[mesh_key(scene.proxy.mesh)]) for scene in (found, once)]
    assert 0 < meshes[0] < meshes[1]
    sizes = [len(encode_scene(scene)) for scene in (found, once)]
    assert sizes[0] < sizes[1]
    assert evaluate(found, capture)["image"]["encoded"]["psnr"] >= 25
    caplog.clear()
    ef.encode(capture, **options, target=Target(size=1200))
    assert caplog.text.count("fitted again") <= caplog.text.count("1200 bytes cannot be reached") == 1


@pytest.mark.slow
@pytest.mark.parametrize("asked", [Target(psnr=24), Target(size=3500)])
def test_of_two_fits_the_better_is_kept(tmp_path, caplog, monkeypatch, asked):
    """The second may be worse: another mesh and atlas are a guess from the quality."""
    cameras = row_grid(9, 64, 56)
    folder = write_capture(tmp_path / "relief", cameras, relief(cameras[4], 0.5, False, step=2))
    capture, options = open_capture(folder), {"proxy": folder / "proxy.ply", "textures": 2, "density": 1.5}
    made = []
    for share in (1.0, 1e-3):
        monkeypatch.setattr("eigenfield.encoding.reach_target.REFIT_MIN_MESH_RATIO", share)
        with caplog.at_level("INFO", "eigenfield.encode"):
            made.append(ef.encode(capture, **options, target=asked))
        assert ("fitted again" in caplog.text) == (share < 1)
    once, found = (len(encode_scene(scene)) for scene in made)
    reached = [evaluate(scene, capture)["image"]["encoded"]["psnr"] for scene in made]
    if asked.size is None:
        assert found <= once and min(reached) >= 24
    else:
        assert found <= asked.size and reached[1] >= reached[0]


@pytest.mark.slow
def test_a_target_far_from_the_preset_has_an_atlas_of_its_own(tmp_path, caplog):
    folder = write_capture(tmp_path / "nine")
    capture, proxy = open_capture(folder), folder / "proxy.ply"
    with caplog.at_level("INFO", "eigenfield.encode"):
        near = ef.encode(capture, proxy, textures=2, target=Target(psnr=20))
    assert "fitted again for quality" in caplog.text
    default = ef.encode(capture, proxy, textures=2)
    assert near.settings["atlas"] < default.settings["atlas"]


def test_the_density_is_what_a_quality_pays_for():
    found = [density_for_quality(quality) for quality in (0, 60, 79, 89, 91, 100)]
    assert found == sorted(found) and found[:2] == [0.9, 0.9] and found[-2:] == [1.5, 1.5]
    assert EncodeOptions(preset="small").resolved().density == density_for_quality(79)
    assert EncodeOptions(quality=60).resolved().density == 0.9
    assert EncodeOptions(quality=60, density=1.2).resolved().density == 1.2
    assert EncodeOptions(fit="none").resolved().density == 1.5


def test_chroma_gets_less_dense_later_than_luma():
    luma, chroma = PLANE_PRESETS
    for density, share in ((0.9, 1.1 / 0.9), (1.2, 1.4 / 1.2), (1.4, 1.5 / 1.4), (1.5, 1.0), (2.0, 1.0), (0.01, 2.0)):
        assert luma.settings((800, 960), density, 20, scattered=False).mean == (800, 960)
        found = chroma.settings((800, 960), density, 20, scattered=False)
        assert found.mean == plane_size((800, 960), 0.5 * share) and found.grid == plane_size((800, 960), 0.3 * share)
