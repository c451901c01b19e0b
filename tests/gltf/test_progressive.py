"""A fitted file that is still arriving: what is there is drawn, and better with every picture that comes."""

from __future__ import annotations

import logging

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.core.errors import FormatError
from eigenfield.gltf import encode_scene, parts, read_scene, store_scores, validate, without_residual
from eigenfield.imaging.metrics import psnr, to_codes
from eigenfield.rendering import Renderer, ViewWeights, camera_weights
from support import glb_surgery
from support.captures import write_capture


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    return open_capture(write_capture(tmp_path_factory.mktemp("capture") / "nine"))


@pytest.fixture(scope="module")
def data(capture):
    return encode_scene(ef.encode(capture, capture.root / "proxy.ply", textures=8, quality=97))


def quality(scene, capture):
    """dB over covered pixels, the mean of all cameras."""
    values = []
    for index in range(len(capture)):
        drawn = Renderer(scene).draw(scene.rig.cameras[index], camera_weights(scene, index))
        values.append(psnr(to_codes(drawn.image), to_codes(capture.photograph(index).pixels), drawn.covered))
    return float(np.mean(values))


def cuts(data):
    """Lengths behind the means, and behind each picture of eigen textures in the order of the file."""
    gltf, binary = glb_surgery.split(data)
    planes = gltf["extensions"]["EIGENFIELD_eigen_textures"]["planes"]
    views = sorted(t["bufferView"] for plane in planes for basis in plane["bases"] for t in basis["textures"])
    head = len(data) - len(binary)
    return [head + gltf["bufferViews"][views[0]]["byteOffset"], *(head + glb_surgery.view_end(gltf, v) for v in views)]


def test_every_picture_that_arrives_makes_it_better(data, capture, tmp_path, caplog):
    path, reached = tmp_path / "part.glb", []
    for length in cuts(data)[:-1]:
        path.write_bytes(data[:length])
        with caplog.at_level(logging.WARNING):
            scene = ef.load(path)
        assert f"views are drawn of {sum(b.count for p in scene.appearance.planes for b in p.bases)} of" in caplog.text
        reached.append(quality(scene, capture))
        caplog.clear()
    reached.append(quality(read_scene(data), capture))
    assert (np.diff(reached) > 0).all() and reached[-1] > reached[0] + 3, reached
    early = np.diff(reached)
    assert early[0] == early.max()  # the most valuable first


def test_what_is_left_is_closed_for_viewers(data, tmp_path):
    lengths = cuts(data)
    left = without_residual(data[: lengths[1] + 1])
    path = tmp_path / "mended.glb"
    path.write_bytes(left)
    assert validate(path) == [] and len(left) < len(data)
    cut = read_scene(data[: lengths[1] + 1])
    weights = ViewWeights.one(4)
    np.testing.assert_allclose(Renderer(cut).texture(weights), Renderer(ef.load(path)).texture(weights), atol=1e-6)


def test_a_file_cut_short_is_no_good_file(data, tmp_path):
    path = tmp_path / "part.glb"
    path.write_bytes(data[: cuts(data)[1] + 5])
    assert [(one.severity, one.code) for one in validate(path)] == [("error", "truncated")]
    sizes = parts(path)
    assert sizes["total"] == path.stat().st_size and 0 < sizes["textures"] < parts_of(data, tmp_path)["textures"]
    for write in (lambda: store_scores(path, {}), lambda: ef.save(ef.load(path), tmp_path / "other.glb")):
        with pytest.raises(FormatError, match="copy or download"):
            write()
    assert list(tmp_path.glob("other*")) == []


def parts_of(data, folder):
    (folder / "whole.glb").write_bytes(data)
    return parts(folder / "whole.glb")


def test_what_comes_before_the_textures_is_needed(data, tmp_path):
    path = tmp_path / "part.glb"
    for length in (cuts(data)[0] - 8, cuts(data)[0] // 2, 25):
        path.write_bytes(data[:length])
        with pytest.raises(FormatError) as caught:
            ef.load(path)
        assert caught.value.code == "truncated"
