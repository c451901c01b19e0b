"""OpenEXR: linear values by one exposure for a whole capture, then the sRGB curve; layers, windows, alpha, damage."""

from __future__ import annotations

import json

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from eigenfield.capture import open_any, open_capture, with_scene_cameras
from eigenfield.capture.photographs import header as headers
from eigenfield.capture.photographs.colour import encode_srgb
from eigenfield.capture.photographs.read import decode, decode_mask, read_header
from eigenfield.core.errors import CaptureError
from eigenfield.gltf import load
from support.captures import write_capture

RANDOM = np.random.default_rng(2)
PICTURE = RANDOM.uniform(0, 0.9, (20, 30, 3)).astype(np.float32)


def write_exr(path, channels: dict[str, np.ndarray], **header) -> None:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **header}
    with OpenEXR.File(header, channels) as file:
        file.write(str(path))


def refused(call, path) -> CaptureError:
    with pytest.raises(CaptureError) as caught:
        call(path)
    assert "\n" not in str(caught.value) and caught.value.remedy
    return caught.value


@pytest.mark.parametrize("kind", [np.float32, np.float16])
def test_values_are_linear(tmp_path, kind):
    path = tmp_path / "a.exr"
    write_exr(path, {"RGB": PICTURE.astype(kind)})
    header = read_header(path)
    assert (header.format, header.stored_size, header.alpha) == ("EXR", (30, 20), False)
    stored = PICTURE.astype(kind).astype(np.float32)
    assert np.allclose(decode(path)[0], encode_srgb(stored), atol=1e-6)
    assert np.allclose(decode(path, exposure=0.5)[0], encode_srgb(stored * np.float32(0.5)), atol=1e-6)


def test_alpha_layers_and_windows(tmp_path):
    path = tmp_path / "a.exr"
    alpha = RANDOM.uniform(0.2, 1, (20, 30)).astype(np.float32)
    alpha[:4] = 0
    layer = {f"ViewLayer.Combined.{c}": PICTURE[..., i] * alpha for i, c in enumerate("RGB")}
    layer |= {"ViewLayer.Combined.A": alpha, "ViewLayer.Depth.Z": alpha, "Albedo.R": alpha, "Albedo.G": alpha}
    write_exr(path, layer, displayWindow=(np.array([-2, 0], np.int32), np.array([31, 24], np.int32)))
    pixels, found = decode(path)
    assert pixels.shape == (25, 34, 3) and read_header(path).stored_size == (34, 25)
    assert np.array_equal(found[:20, 2:32], alpha) and found.sum() == alpha.sum()
    assert np.allclose(pixels[4:20, 2:32], encode_srgb(PICTURE[4:]), atol=1e-4)


def test_grey_masks_and_numbers_that_are_none(tmp_path):
    grey = PICTURE[..., 0].copy()
    grey[0, :3] = np.nan, np.inf, -1
    write_exr(tmp_path / "a.exr", {"Y": grey})
    pixels, _ = decode(tmp_path / "a.exr")
    assert np.allclose(pixels[0, :3, 1], [0, 1, 0], atol=1e-6)
    write_exr(tmp_path / "m.exr", {"Y": (grey > 0.5).astype(np.float32)})
    assert set(np.unique(decode_mask(tmp_path / "m.exr"))) == {0.0, 1.0}


def as_exr(folder, factor: float):
    """A capture's photographs as OpenEXR, `factor` times as bright; the first one is a quarter of that."""
    for index, path in enumerate(sorted((folder / "images").iterdir())):
        with Image.open(path) as image:
            coded = np.asarray(image, np.float32) / 255
        linear = np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4).astype(np.float32)
        write_exr(path.with_suffix(".exr"), {"RGB": linear * np.float32(factor if index else factor / 4)})
        path.unlink()
    text = (folder / "transforms.json").read_text()
    (folder / "transforms.json").write_text(text.replace(".png", ".exr"))
    return folder


def test_one_exposure_for_a_whole_capture(tmp_path):
    plain = open_capture(write_capture(tmp_path / "plain"))
    same = open_capture(as_exr(write_capture(tmp_path / "same"), 1.0))
    assert same.exposure == 1.0 and "times 1, then" in same.problems[-1]
    assert np.abs(same.photograph(4).pixels - plain.photograph(4).pixels).max() < 1e-3
    bright = open_capture(as_exr(write_capture(tmp_path / "bright"), 40.0))
    assert 1 / 40 < bright.exposure < 1 / 20
    dark = open_any(tmp_path / "same" / "images")
    assert dark.exposure == 1.0 and dark.photograph(4).pixels.max() == same.photograph(4).pixels.max()
    ratio = bright.photograph(0).pixels.mean() / bright.photograph(4).pixels.mean()
    assert np.isclose(ratio, same.photograph(0).pixels.mean() / same.photograph(4).pixels.mean(), rtol=0.05)
    other = bright.with_exposure(0.01)
    assert other.exposure == 0.01 and other.photograph(4).pixels.mean() < bright.photograph(4).pixels.mean()


def test_the_scene_keeps_the_exposure(tmp_path, run):
    folder = as_exr(write_capture(tmp_path / "c"), 40.0)
    words = ("--proxy", folder / "proxy.ply", "--fit", "none", "--density", "0.5", "-o", tmp_path / "s.glb")
    code, _, err = run("encode", folder, *words)
    assert code == 0 and "sRGB curve" in err, err
    settings = json.loads(run("info", tmp_path / "s.glb", "--json").out)["settings"]
    assert settings["tone"] == {"curve": "sRGB", "exposure": open_capture(folder).exposure}
    changed = open_capture(folder).with_exposure(0.5)
    assert with_scene_cameras(load(tmp_path / "s.glb"), changed).exposure == open_capture(folder).exposure


def test_what_is_not_read(tmp_path, monkeypatch):
    path = tmp_path / "a.exr"
    write_exr(path, {"Z": PICTURE[..., 0]})
    assert "no channels R, G, B" in str(refused(decode, path))
    write_exr(path, {"RGB": PICTURE})
    data = path.read_bytes()
    for part in (4, 40, 200, len(data) - 300):
        path.write_bytes(data[:part])
        assert refused(decode, path).code in ("image-unreadable", "image-truncated")
    path.write_bytes(data)
    monkeypatch.setattr(headers, "PHOTOGRAPH_MAX_PIXELS", 599)
    assert refused(read_header, path).code == refused(decode, path).code == "image-too-large"
