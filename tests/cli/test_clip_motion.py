"""`encode --clip` on a numbered sequence of meshes, and what the other commands make of the file."""

from __future__ import annotations

import json

import numpy as np
import pytest
from PIL import Image

from eigenfield.core.errors import OptionError, ProxyError
from eigenfield.imaging.png import png_bytes
from eigenfield.proxy import read_mesh, write_ply
from eigenfield.runtime.files import write_bytes
from support.captures import frame_of
from support.moving_plate import CAMERAS, seen, staged
from support.program import call

FRAMES = 3


@pytest.fixture(scope="module")
def filmed(tmp_path_factory):
    """FOOTAGE/0000/images/view_00.png and so on, with a calibration, beside MESHES/mesh_0000.ply."""
    folder = tmp_path_factory.mktemp("filmed")
    (folder / "meshes").mkdir()
    for number in range(FRAMES):
        instant, mesh, frames = folder / "footage" / f"{number:04d}", staged(2 * number), []
        (instant / "images").mkdir(parents=True)
        capture = seen(mesh)
        for index, camera in enumerate(CAMERAS):
            name = f"images/view_{index:02d}.png"
            write_bytes(instant / name, png_bytes(capture.photograph(index).pixels))
            frames.append(frame_of(camera, name))
        text = json.dumps({"camera_model": "PINHOLE", "frames": frames})
        (instant / "transforms.json").write_text(text, encoding="utf-8")
        write_ply(mesh, folder / "meshes" / f"mesh_{number:04d}.ply")
    return folder


@pytest.fixture(scope="module")
def clip(filmed):
    pattern = filmed / "meshes" / "mesh_%04d.ply"
    assert call("encode", filmed / "footage", "--clip", "--proxy", pattern, "-o", filmed / "clip.glb") == 0
    return filmed / "clip.glb"


@pytest.mark.slow
def test_a_sequence_of_meshes_becomes_a_clip_that_moves(clip, filmed, run, tmp_path):
    assert run("validate", clip).code == 0
    facts = json.loads(run("info", clip, "--json").out)
    assert facts["clip"]["motion_bytes"] > 0 and "the mesh moves" in run("info", clip).out
    pictures, photographs = [], []
    for number in range(FRAMES):
        run("render", clip, "--time", number, "--camera", "view_04", "-o", tmp_path / f"{number}.png")
        files = tmp_path / f"{number}.png", filmed / "footage" / f"{number:04d}" / "images" / "view_04.png"
        for file, found in zip(files, (pictures, photographs), strict=True):
            found.append(np.asarray(Image.open(file))[..., :3].astype(float))
    off = np.array([[np.abs(one - other).mean() for other in photographs] for one in pictures])
    assert off.diagonal().max() < 4 and (off + 99 * np.eye(FRAMES)).min() > 2 * off.diagonal().max()
    exported = []
    for number in (0, 2):
        assert run("export", clip, "--as", "obj", "--time", number, "-o", tmp_path / f"mesh{number}.obj").code == 0
        exported.append(read_mesh(tmp_path / f"mesh{number}.obj").vertices)
    moved = np.linalg.norm(exported[1] - exported[0], axis=1) > 0.1
    assert moved.sum() == 64  # of the plate, and none of the backdrop


def test_it_is_encoded_as_a_folder_too(clip, filmed, run, tmp_path):
    pattern, folder = filmed / "meshes" / "mesh_%04d.ply", filmed / "clip"
    words = "encode", filmed / "footage", "--clip", "--proxy", pattern, "-o", folder
    result = run(*words)  # goes on from what is finished
    assert result.code == 0 and f"{folder}: " in result.out and (folder / "groups" / "00000.eftg").is_file()
    assert run("export", folder, "--as", "glb", "-o", tmp_path / "again.glb").code == 0
    assert (tmp_path / "again.glb").read_bytes() == clip.read_bytes()
    again = run(*words)
    assert again.code == 2 and "--overwrite" in again.err
    still = run("encode", filmed / "footage" / "0000", "-o", tmp_path / "still")
    assert still.code == 2 and "a scene is a .glb file" in still.err


def test_it_is_measured_against_its_footage(clip, filmed, run):
    scores = json.loads(run("evaluate", clip, filmed / "footage", "--json").out)
    assert scores["image"]["encoded"]["psnr"] > 30
    assert min(one["encoded"]["psnr"] for one in scores["over_time"]) > 29


def test_texture_maps_of_a_clip_are_written(filmed, run, tmp_path):
    mesh, output = filmed / "meshes" / "mesh_0000.ply", tmp_path / "maps.glb"
    words = "--clip", "0:1", "--proxy", mesh, "--fit", "none", "--textures", 2, "--atlas", 64
    result = run("encode", filmed / "footage", *words, "-o", output)
    assert result.code == 0 and f"{output}: " in result.out, result.err
    assert run("validate", output).code == 0 and json.loads(run("info", output, "--json").out)["clip"]["groups"] == [1]


def test_sequences_that_cannot_be_used_are_refused_before_any_work(filmed, run, tmp_path):
    pattern, output = filmed / "meshes" / "mesh_%04d.ply", tmp_path / "a.glb"
    with pytest.raises(OptionError) as caught:
        run("encode", filmed / "footage" / "0000", "--proxy", pattern, "-o", output, "--traceback")
    assert caught.value.code == "sequence-unused" and "--clip" in str(caught.value)
    with pytest.raises(ProxyError) as missing:
        run("encode", filmed / "footage", "--clip", "--proxy", filmed / "mesh_%d.obj", "-o", output, "--traceback")
    assert missing.value.code == "proxy-missing"
    code, _, err = run("encode", filmed / "footage", "--clip", "0:2", "--proxy", pattern, "-o", output)
    assert code == 2 and "3 meshes, the clip has 2 frames" in err and len(err.strip().splitlines()) <= 4
