"""How finely each place of a mean is coded: known answers, what a file keeps of it, what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import eigenfield as ef
from eigenfield.coding.pictures.pictures_10bit import svt_coder
from eigenfield.coding.pictures.quantise import precision_codes, spread_precision
from eigenfield.core.errors import FormatError
from eigenfield.core.payloads import mean_key
from eigenfield.encoding.fitted.code_planes import code_mean
from eigenfield.gltf import parts, save, validate
from support.coded_scenes import precise_scene
from support.glb_surgery import join, split
from support.scenes import smooth_pictures


@given(arrays(np.float32, (3, 4), elements=st.floats(0, 1, width=32)))
def test_precisions_are_kept_to_half_a_code(precision):
    back = (precision_codes(precision).astype(float) + 1) / 256
    assert back.min() > 0
    assert np.abs(back - np.maximum(precision, 1 / 256)).max() <= 0.5 / 256 + 1e-6


def test_precision_is_linear_between_the_middles_of_its_numbers():
    spread = spread_precision(np.array([[255, 127]], np.uint8), 3, 8)
    expected = np.clip(1 - ((np.arange(8) + 0.5) / 4 - 0.5) / 2, 0.5, 1)
    assert spread.shape == (3, 8, 1)
    assert np.allclose(spread[..., 0], expected, atol=1e-6)


def test_what_is_less_precise_costs_fewer_bytes_and_is_farther_off():
    mean = 0.5 + 0.3 * smooth_pictures(1, 128, 128, 1)[0]
    mean += np.random.default_rng(0).normal(0, 0.02, mean.shape).astype(np.float32)
    precision = np.ones((4, 4), np.float32)
    precision[:, 2:] = 0.25
    whole, file = code_mean(mean, 4e-3, svt_coder(8))
    less, smaller = code_mean(mean, 4e-3, svt_coder(8), precision)
    assert len(smaller.data) + len(smaller.precision.data) < 0.9 * len(file.data)
    error = {name: np.abs(values - mean) for name, values in {"whole": whole, "less": less}.items()}
    assert error["less"][:, 96:].mean() > 1.5 * error["whole"][:, 96:].mean()
    assert error["less"][:, :32].mean() < 1.1 * error["whole"][:, :32].mean()
    assert less.dtype == np.float32


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    path = tmp_path_factory.mktemp("precise") / "scene.glb"
    scene = precise_scene()
    save(scene, path)
    return scene, path


def test_a_file_gives_the_means_back(saved, tmp_path):
    scene, path = saved
    back = ef.load(path)
    for plane, other in zip(scene.appearance.planes, back.appearance.planes, strict=True):
        assert np.array_equal(plane.mean, other.mean)
    save(back, tmp_path / "again.glb")
    assert (tmp_path / "again.glb").read_bytes() == path.read_bytes()
    assert validate(path) == []


def test_both_planes_name_the_same_bytes(saved):
    scene, path = saved
    gltf, _ = split(path.read_bytes())
    extension = gltf["extensions"]["EIGENFIELD_eigen_textures"]
    assert extension["version"] == "1.8" and "precision" in extension["needs"]
    entries = [plane["mean"]["precision"] for plane in extension["planes"]]
    assert len(entries) > 1 and all(entry == entries[0] for entry in entries)
    assert entries[0]["size"] == [5, 3]
    means = [scene.payloads[mean_key(plane.mean)][0] for plane in scene.appearance.planes]
    preview = gltf["bufferViews"][gltf["images"][0]["bufferView"]]["byteLength"]
    assert parts(path)["mean"] == preview + sum(len(mean.data) for mean in means) + len(means[0].precision.data)


def test_another_codec_has_no_precision(saved, tmp_path):
    scene, _ = saved
    save(scene, tmp_path / "plain.glb", codec="png")
    gltf, _ = split((tmp_path / "plain.glb").read_bytes())
    assert all(
        "precision" not in plane.get("mean", {}) for plane in gltf["extensions"]["EIGENFIELD_eigen_textures"]["planes"]
    )
    back = ef.load(tmp_path / "plain.glb")
    assert np.abs(back.appearance.planes[0].mean - scene.appearance.planes[0].mean).max() < 0.01


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda mean: mean["precision"].update(size=[5, 4]), "picture-size"),
        (lambda mean: mean["precision"].update(size=[5, 2000]), "json-value"),
        (lambda mean: mean["precision"].update(size=[0, 3]), "json-value"),
        (lambda mean: mean["precision"].pop("size"), "json-missing"),
        (lambda mean: mean["precision"].update(bufferView=mean["bufferView"]), "picture-damaged"),
        (lambda mean: mean["precision"].update(bufferView=999), "view-missing"),
    ],
)
def test_a_precision_that_cannot_be_is_refused(saved, tmp_path, change, code):
    gltf, binary = split(saved[1].read_bytes())
    change(gltf["extensions"]["EIGENFIELD_eigen_textures"]["planes"][0]["mean"])
    (tmp_path / "bad.glb").write_bytes(join(gltf, binary))
    with pytest.raises(FormatError) as caught:
        ef.load(tmp_path / "bad.glb")
    assert caught.value.code == code
    assert code in {finding.code for finding in validate(tmp_path / "bad.glb")}


def test_a_mean_of_eight_bits_has_none(saved, tmp_path):
    scene, path = saved
    entry = split(path.read_bytes())[0]["extensions"]["EIGENFIELD_eigen_textures"]["planes"][1]["mean"]["precision"]
    save(scene, tmp_path / "plain.glb", codec="png")
    gltf, binary = split((tmp_path / "plain.glb").read_bytes())
    gltf["extensions"]["EIGENFIELD_eigen_textures"]["planes"][1]["mean"]["precision"] = entry
    (tmp_path / "bad.glb").write_bytes(join(gltf, binary))
    with pytest.raises(FormatError) as caught:
        ef.load(tmp_path / "bad.glb")
    assert caught.value.code == "picture-type"


def test_a_damaged_picture_is_named(saved, tmp_path):
    data = bytearray(saved[1].read_bytes())
    at = data.index(
        b"IDAT", data.index(saved[0].payloads[mean_key(saved[0].appearance.planes[0].mean)][0].precision.data[:16])
    )
    data[at + 6] ^= 0xFF
    (tmp_path / "bad.glb").write_bytes(data)
    with pytest.raises(FormatError) as caught:
        ef.load(tmp_path / "bad.glb")
    assert caught.value.code == "picture-damaged"
    assert caught.value.where.endswith("/mean/precision")


def test_a_changed_mean_has_no_precision(saved, tmp_path):
    scene, _ = saved
    planes = tuple(replace(plane, mean=plane.mean + np.float32(1e-3)) for plane in scene.appearance.planes)
    save(replace(scene, appearance=replace(scene.appearance, planes=planes)), tmp_path / "changed.glb")
    gltf, _ = split((tmp_path / "changed.glb").read_bytes())
    assert "precision" not in gltf["extensions"]["EIGENFIELD_eigen_textures"]["needs"]
