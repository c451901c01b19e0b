"""Pictures of 10 bits: coded, stacked, kept, refused when damaged."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import eigenfield as ef
from eigenfield.coding import stacking
from eigenfield.coding.pictures.pictures_10bit import (
    CODER,
    MAX_CODE,
    MIDDLE_CODE,
    PATIENT_CODER,
    TRIAL_CODER,
    crf_of,
    decode_10bit,
    encode_10bit,
    encoder_step,
    svt_coder,
)
from eigenfield.core.errors import FormatError
from eigenfield.core.payloads import Payload, Payloads, weights_key
from eigenfield.encoding.fitted.code_planes import code_basis, code_mean, coded_plane, with_weights
from eigenfield.gltf import save, validate
from support.composed import encoded
from support.scenes import float_basis, smooth_pictures, tiny_scene


@pytest.fixture(scope="module")
def picture():
    y, x = np.mgrid[0:96, 0:128]
    values = MIDDLE_CODE + 300 * np.sin(x / 9) * np.cos(y / 13)
    return np.rint(values).astype(np.uint16)


@pytest.fixture(scope="module")
def data(picture):
    return encode_10bit(picture, 4, 8)


def test_codes_of_ten_bits_come_back(picture, data):
    back = decode_10bit(data, False, "here")
    assert back.dtype == np.uint16 and back.shape == picture.shape and back.max() <= MAX_CODE
    assert np.abs(back.astype(int) - picture).mean() < 3
    assert (back % 4 != 0).any()  # more than 8 bits
    assert encode_10bit(picture, 4, 8) == data


def test_a_coarser_quantiser_takes_fewer_bytes_and_errs_more(picture):
    sizes, errors = [], []
    for crf in (4, 20, 40):
        coded = encode_10bit(picture, crf, 8)
        sizes.append(len(coded))
        errors.append(np.square(decode_10bit(coded, False, "here").astype(float) - picture).mean())
    assert sizes[0] > sizes[1] > sizes[2] and errors[0] < errors[1] < errors[2]


@pytest.mark.parametrize("coder, at_most", [(CODER, 0.98), (PATIENT_CODER, 0.95)])
def test_slower_presets_take_fewer_bytes_at_the_same_error(coder, at_most):
    rng = np.random.default_rng(3)
    y, x = np.mgrid[:256, :320]
    discs = 0.3 + x / 1000
    for _ in range(60):
        away = np.hypot(y - rng.uniform(0, 256), x - rng.uniform(0, 320)) / rng.uniform(4, 40)
        discs = np.where(away < 1, 0.5 + 0.4 * np.sin(away * rng.uniform(0, 20) + rng.uniform(0, 6)), discs)
    codes = np.rint((discs + rng.normal(0, 0.01, discs.shape)) * MAX_CODE).clip(0, MAX_CODE).astype(np.uint16)

    def error(data: bytes) -> float:
        return float(np.square(decode_10bit(data, False, "discs").astype(float) - codes).mean())

    made = [TRIAL_CODER(codes, crf) for crf in (24, 32, 40)]
    data = coder(codes, 32)
    same = np.exp(np.interp(error(data), [error(one) for one in made], [np.log(len(one)) for one in made]))
    assert len(data) < at_most * same


@pytest.mark.parametrize("preset", [8, 2])
@pytest.mark.parametrize("crf", [1, 8, 20, 32])
def test_the_error_is_that_of_the_quantiser_asked_for(crf, preset):
    noise = np.random.default_rng(1).integers(0, MAX_CODE, (64, 64)).astype(np.uint16)
    off = decode_10bit(encode_10bit(noise, crf, preset), False, "here").astype(float) - noise
    uniform = encoder_step(crf) / 12**0.5  # its root mean square, of values that are rounded to the step
    assert uniform < np.square(off).mean() ** 0.5 < 1.8 * uniform


@given(st.integers(1, 63))
def test_steps_and_qualities_of_the_encoder(crf):
    assert crf_of(encoder_step(crf)) == crf


def test_a_damaged_picture_is_refused(data):
    @settings(max_examples=60)
    @given(st.integers(0, len(data) - 1), st.integers(0, 255), st.booleans())
    def damage(place, value, cut):
        broken = data[:place] if cut else data[:place] + bytes([value]) + data[place + 1 :]
        try:
            decode_10bit(broken, False, "here")
        except FormatError as error:
            assert error.code in ("picture-damaged", "picture-channels") and error.where == "here"

    damage()
    with pytest.raises(FormatError):
        decode_10bit(data[: len(data) // 2], False, "here")


def test_textures_are_stacked_and_share_one_step():
    basis = float_basis(5, 7, 64, 80, 2)
    coded = code_basis(basis, 1e-3, svt_coder(8))
    made = coded.basis
    assert sum(picture.count for picture in coded.pictures) == 7 and {p.codec for p in coded.pictures} == {
        "av1-10bit-2"
    }
    assert made.textures.dtype == np.uint16 and len(np.unique(made.scale)) == 1
    assert np.abs(made.values() - basis.values()).mean() < 2e-3
    other = with_weights(coded, made.weights * 2, Payload("weights-1", b"coded"))
    assert other.pictures == coded.pictures and other.weights is not None and other.weights.data == b"coded"
    assert other.payloads.keys() - coded.payloads.keys() == {weights_key(made.weights * 2)}


def test_weak_textures_have_finer_codes_so_that_eight_bits_are_enough(monkeypatch):
    monkeypatch.setattr("eigenfield.encoding.fitted.code_planes.PICTURE_MAX_ROWS", 128)  # two textures a file
    basis = float_basis(5, 4, 64, 80, 1)
    strength = np.array([1, 1, 0.5, 0.5], np.float32)[:, None, None, None]
    basis = replace(basis, textures=basis.textures * strength)
    coded = code_basis(basis, 1e-3, svt_coder(8)).basis
    scale = coded.scale[:, 0]
    assert scale[0] == scale[1] > 3 * scale[2] and scale[2] == scale[3]
    eight = np.rint(np.rint(coded.textures * (255 / 1023)) * (1023 / 255))
    lost = np.abs((eight - coded.textures) * scale[:, None, None, None]).max(axis=(1, 2, 3))
    for files in (slice(0, 2), slice(2, 4)):
        assert lost[files].max() < np.abs(coded.values()[files]).max() / 150


@pytest.mark.parametrize("channels", [1, 2])
def test_means_of_any_range(channels):
    mean = smooth_pictures(1, 64, 64, channels)[0] * (3 if channels == 2 else 0.5) + (0 if channels == 2 else 0.5)
    back, picture = code_mean(mean, 1e-3, svt_coder(8))
    assert picture.codec == "av1-10bit-2" and np.abs(back - mean).mean() < 0.01


def scene_of_planes():
    scene = tiny_scene(3, 0)
    bases = (code_basis(float_basis(5, 3, 64, 64, 1), 1e-3, svt_coder(8)),)
    luma = coded_plane(0.5 + 0.3 * smooth_pictures(1, 96, 64, 1)[0], bases, 1e-3, svt_coder(8))
    local = code_basis(replace(float_basis(5, 2, 64, 64, 2), grid=(80, 96), corner=(16, 8)), 1e-3, svt_coder(8))
    chroma = coded_plane(0.1 * smooth_pictures(1, 64, 64, 2)[0], (local,), 1e-3, svt_coder(8))
    matrix = np.array([[1, 0.5, 0.25], [1, -0.5, 0.5], [1, 0.125, -1]], np.float32)
    return encoded(
        replace(scene, appearance=replace(scene.appearance, planes=(luma.value, chroma.value), to_rgb=matrix)),
        luma.payloads | chroma.payloads,
    )


def test_a_file_of_planes_regions_and_stacks(tmp_path):
    scene, path = scene_of_planes(), tmp_path / "planes.glb"
    save(scene, path)
    assert validate(path) == []
    back = ef.load(path)
    np.testing.assert_array_equal(back.appearance.to_rgb, scene.appearance.to_rgb)
    for one, two in zip(scene.appearance.planes, back.appearance.planes, strict=True):
        np.testing.assert_allclose(one.mean, two.mean, atol=1e-6)
        for a, b in zip(one.bases, two.bases, strict=True):
            assert (a.grid, a.corner) == (b.grid, b.corner)
            np.testing.assert_array_equal(a.textures, b.textures)
            np.testing.assert_allclose(a.values(), b.values(), atol=1e-7)
    from eigenfield.gltf.container import parse_glb
    from eigenfield.gltf.source import read_file

    extension = parse_glb(read_file(path)).json["extensions"]["EIGENFIELD_eigen_textures"]
    assert extension["version"] == "1.8" and extension["needs"] == ["av1-10bit-2", "regions", "stacks", "toRGB"]


def test_stacks_of_eight_bits_are_read():
    random = np.random.default_rng(0)
    for channels in (1, 2, 3):
        codes = random.integers(0, 256, (3, 16, 24, channels)).astype(np.uint8)
        stack = np.concatenate([stacking.stacked_picture(one) for one in codes])
        data = stacking.encode(stack if channels == 3 else stack[..., None], "png", 0)
        back = stacking.decode(memoryview(data), "png", 24, 16, channels, "here", 3)
        np.testing.assert_array_equal(back, codes)


def changed(path, change):
    from eigenfield.gltf.container import parse_glb
    from eigenfield.gltf.source import read_file

    glb = parse_glb(read_file(path))
    change(glb.json["extensions"]["EIGENFIELD_eigen_textures"])
    return glb


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda e: e.update(toRGB=[1.0] * 6), "plane-matrix"),
        (lambda e: e["planes"][1]["bases"][0].update(grid=[60, 60]), "basis-region"),
        (lambda e: e["planes"][0]["mean"].update(bits=9), "picture-type"),
        (lambda e: e["planes"][0]["bases"][0]["textures"][0].update(count=2), "picture-size"),
        (lambda e: e["planes"][0]["bases"][0]["textures"][0].update(count=0), "json-value"),
        (lambda e: e["planes"][0]["bases"][0]["textures"][0].update(scale=[1.0, 2.0]), "json-value"),
        (lambda e: e.update(needs=["magic"]), "needs"),
    ],
)
def test_what_is_not_as_specified_is_refused(tmp_path, change, code):
    from eigenfield.gltf.document import Document
    from eigenfield.gltf.findings import Findings
    from eigenfield.gltf.layout import read_layout

    path = tmp_path / "planes.glb"
    save(scene_of_planes(), path)
    glb = changed(path, change)
    with pytest.raises(FormatError) as caught:
        read_layout(Document(glb), Findings(strict=True))
    assert caught.value.code == code


def test_a_plane_without_payloads_is_coded_when_it_is_saved(tmp_path):
    scene = scene_of_planes()
    save(replace(scene, payloads=Payloads()), tmp_path / "a.glb")
    back = ef.load(tmp_path / "a.glb")
    assert np.abs(back.appearance.planes[0].mean - scene.appearance.planes[0].mean).mean() < 0.01
