"""Real captures, from the folder that EIGENFIELD_DATA names: the whole path, and the figures it must reach."""

from __future__ import annotations

import json

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.evaluation import read_circles
from eigenfield.gltf import parts

pytestmark = pytest.mark.slow


def tarot(data):
    folder = data / "tarot_17x17_512"
    return folder, open_capture(folder, calibration=folder / "calibration" / "refined.json")


def test_tarot_before_coding(data):
    """Atlas 1024, 15 textures, bicubic both ways: what a prototype reached at density 1, or more."""
    folder, capture = tarot(data)
    scene = ef.encode(capture, folder / "calibration" / "proxy.ply", atlas=1024, hold_out="odd", fit="none")
    assert len(scene.proxy.mesh.faces) == 66_208  # its own atlas is valid: kept as it is
    circles = read_circles(folder / "ball.json", scene.rig.names)
    image = ef.evaluate(scene, capture, png_maps="none", circles=circles)["image"]
    for part, whole, outside in (("encoded", 29.5, 32.5), ("held_out", 28.7, 32.3)):
        assert image[part]["coverage"] > 0.999
        assert image[part]["psnr"] >= whole and image[part]["outside"]["psnr"] >= outside


@pytest.fixture
def call(run):
    """What the program says to standard output."""

    def said(*words):
        code, out, err = run(*words)
        assert code == 0, err
        return out

    return said


def test_the_command_line_on_a_capture(data, tmp_path, call):
    """Phone pictures with COLMAP's cameras, on a mesh with holes."""
    folder, scene = data / "cube_colmap_mesh", tmp_path / "scene.glb"
    proxy = folder / "proxy.obj"
    call("inspect", folder, "--proxy", proxy, "--overlay", tmp_path / "overlay.png")
    call("encode", folder, "--proxy", proxy, "-o", scene, "-n", "7", "--fit", "none", "--triangles", "5000")
    assert "no findings" in call("validate", scene)
    figures = json.loads(call("evaluate", scene, folder, "--json", "--png-maps", "sample"))
    assert figures["image"]["encoded"]["psnr"] > 34 and figures["image"]["encoded"]["coverage"] > 0.9
    assert figures["bytes"]["total"] == scene.stat().st_size
    call("render", scene, "--at", "0.2,0.1", "-o", tmp_path / "view.png")


def test_photographs_in_one_small_file_out(data, tmp_path, call):
    """Nothing but photographs and their own parameters: the proxy is estimated, found to be a relief, simplified; the
    textures are fitted to it."""
    folder, scene = data / "hci_antinous_9x9", tmp_path / "scene.glb"
    call("encode", folder, "-o", scene, "--preset", "small", "-q")
    assert "no findings" in call("validate", scene)
    assert scene.stat().st_size < 18_000 and dict(parts(scene))["mesh"] < 6_500
    figures = json.loads(call("evaluate", scene, folder, "--json"))["image"]["encoded"]
    assert figures["psnr"] > 37.5 and figures["psnr_luma"] > 38.5 and figures["coverage"] > 0.999


def test_a_sparse_array_tells_near_from_far(data, tmp_path, call):
    """Occlusion hardly tells them apart in the sparse Tarot; with the wrong order, its camera goes right with the
    column."""
    folder = data / "tarot_5x4_1024"
    call("proxy", folder, "-o", tmp_path / "proxy.ply", "--surface", "relief", "-q")
    for calibration in (folder / "calibration" / "refined.json", tmp_path / "proxy.cameras" / "transforms.json"):
        capture = open_capture(folder, calibration=calibration)
        cameras = dict(zip(capture.names, (view.camera for view in capture.views), strict=True))
        step = cameras["out_06_12.jpg"].centre - cameras["out_06_04.jpg"].centre
        right, down, _ = cameras["out_06_08.jpg"].R @ step
        assert right < 0 and abs(down) < -0.1 * right


def test_lenses_are_removed(data):
    """The fox: every view is there, straightened to its own size."""
    capture = open_capture(data / "fox_transforms_half")
    assert len(capture.views) == 50
    photograph = capture.photograph(0)
    assert photograph.pixels.shape == (960, 540, 3) and np.isfinite(photograph.pixels).all()
