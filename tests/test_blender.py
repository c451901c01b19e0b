"""The Blender add-on: its zip, and with bpy the whole way: pictures of an array, encoded, drawn again in Blender."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import eigenfield as ef
from eigenfield.capture import open_any
from eigenfield.proxy import read_mesh
from eigenfield.rendering import texture
from support.clips import moving_clip, numbered_clip

ROOT = Path(__file__).parents[1]
BPY = Path(os.environ.get("EIGENFIELD_BPY") or ROOT / "build/bpy/bin/python")


def pack(path: Path, *version: str) -> Path:
    subprocess.run([sys.executable, ROOT / "packaging/addon.py", path, *version], check=True)
    return path


def test_the_zip_has_equal_bytes_and_the_version_of_a_release(tmp_path):
    first = pack(tmp_path / "a.zip")
    assert first.read_bytes() == pack(tmp_path / "b.zip").read_bytes()
    files = "__init__ array clip encode field imported panel parallax preferences program sight steps"
    names = {"LICENSE", "blender_manifest.toml", *(f"{name}.py" for name in files.split())}
    with zipfile.ZipFile(pack(tmp_path / "c.zip", "1.2.3")) as archive:
        assert set(archive.namelist()) == names
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
    assert (manifest["id"], manifest["version"], manifest["license"]) == ("eigenfield", "1.2.3", ["SPDX:MIT"])


def blender(script: str, folder: Path, *more: object) -> None:
    """Run a script in Blender's Python, with the zip and settings of its own."""
    addon = pack(folder / "addon.zip")
    command = [BPY, ROOT / "tests/support" / script, addon, folder, *more]
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(folder / "user")}
    done = subprocess.run(
        [str(part) for part in command], env=environment, capture_output=True, text=True, cwd=folder, timeout=300
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture(scope="module")
def bpy() -> None:
    if not any(BPY.parents[1].glob("lib/python*/site-packages/bpy")):
        pytest.skip("no bpy: `make bpy` installs it in build/bpy, or EIGENFIELD_BPY names a Python that has it")


@pytest.fixture(scope="module")
def folder(tmp_path_factory, bpy) -> Path:
    folder = tmp_path_factory.mktemp("blender")
    blender("blender_render.py", folder)
    return folder


@pytest.mark.slow
def test_blender_itself_finds_the_manifest_valid(tmp_path, folder):
    (checker,) = BPY.parents[1].glob("lib/python*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py")
    subprocess.run([BPY, checker, "validate", pack(tmp_path / "a.zip")], check=True)


@pytest.mark.slow
def test_cameras_and_mesh_are_those_of_the_pictures(folder):
    capture = open_any(folder)
    field = capture.light_field
    assert [Path(name).stem for name in field.names] == [
        f"view_{row:02}_{column:02}" for row in (0, 1) for column in range(3)
    ]
    centres = np.array([camera.centre for camera in field.cameras])
    steps = np.diff(centres.reshape(2, 3, 3), axis=1)
    np.testing.assert_allclose(np.linalg.norm(steps, axis=2), 0.3, rtol=1e-5)
    assert centres[0, 2] > centres[3, 2]  # the first row is the upper one
    middle = np.array((0.2, -6, 1.4)) + 6 * np.mean([camera.R[2] for camera in field.cameras], axis=0)
    for camera in field.cameras:  # the zero plane stays in the middle of all pictures, which are 72 x 96
        assert (camera.width, camera.height) == (72, 96)
        x, y, z = camera.K @ (camera.R @ (middle - camera.centre))
        np.testing.assert_allclose((x / z, y / z), (36, 48), atol=0.01)
    mesh = read_mesh(folder / "proxy.obj")
    assert len(mesh.faces) == 320 * 3 * 2 + 12 + 2  # the ball as finely as in a render, and nothing that is hidden
    assert "is no perspective camera" in (folder / "refused.txt").read_text()


@pytest.mark.slow
def test_each_frame_of_an_animation_is_a_capture(folder):
    frames = [folder / "film" / f"frame_{number:04}" for number in (3, 4)]
    assert [len(ef.open(frame)) for frame in frames] == [3, 3]
    first, second = (read_mesh(frame / "proxy.obj").vertices for frame in frames)
    moved = np.ptp(np.concatenate([first - second]), axis=0)
    np.testing.assert_allclose(moved, (1, 0, 0), atol=1e-5)


@pytest.fixture(scope="module")
def program(tmp_path_factory, bpy) -> Path:
    path = tmp_path_factory.mktemp("program") / "eigenfield"
    path.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m eigenfield "$@"\n')
    path.chmod(0o755)
    return path


@pytest.fixture(scope="module")
def said(folder, program) -> dict[str, Any]:
    """What the panel showed, in all states."""
    blender("blender_encode.py", folder, program)
    return json.loads((folder / "said.json").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_the_panel_says_what_a_spacing_promises(said):
    """A cube from 8 to 10 units away, pictures of 800 x 600 with 800 pixels of focal length."""
    near, wide = said["promises"]
    assert (near["near"], near["far"]) == pytest.approx((8, 10))
    assert (near["pixels"], wide["pixels"]) == pytest.approx((2, 20))
    assert (near["word"], wide["word"]) == ("good", "fair") and near["good"] == pytest.approx(0.6)
    assert said["kept"], "boxes were looked at anew while the spacing was changed"
    assert (said["moved"]["near"], said["moved"]["far"]) == pytest.approx((9, 11))
    assert said["empty"] is None and said["array"][0] == "[Show the cameras]"
    shown = " ".join(said["array with a cube"])
    assert shown.startswith("Parallax 8.08 px, 1.0% of the longer side 9 m to 11 m away good: views between")


@pytest.mark.slow
def test_the_panel_encodes_what_was_rendered(folder, said):
    assert " ".join(said["not rendered"]).endswith("has no transforms.json: render the array first")
    assert said["idle"] == said["stopped"] == ["[eigenfield.encode]"]
    assert "no program does not run" in said["no program"]
    assert said["running"][1:] == ["[Cancel]"] and "%, " in said["running"][0]
    assert said["output"] == f"{folder}.glb" and ef.load(folder.with_suffix(".glb")).appearance.textures
    shown = " ".join(said["done"])
    assert f" {folder.name}.glb: " in shown and "smaller than the photographs" in shown
    assert said["done"][-2:] == ["[eigenfield.open]", "[Import]"]
    assert "proxy.obj: has no vertices" in said["error"]
    assert " ".join(said["failed"][1:]).endswith("proxy.obj: has no vertices; export it again")
    assert said["after load"] == said["after disabling"] == [True, False, None]


@pytest.mark.slow
def test_long_work_says_how_far_it_is_and_escape_stops_it(said):
    lines = [f"Import: {part}, picture {number}. Esc stops it" for number, part in enumerate(("0%", "50%"))]
    running = "RUNNING_MODAL"
    assert said["to the end"] == [[*lines, None], ["no more"], True, [running, running, running, running, "CANCELLED"]]
    assert said["escaped"] == [[lines[0], None], [], True, [running, running, "CANCELLED"]]


@pytest.mark.slow
def test_what_is_encoded_is_drawn_in_blender_as_it_was_rendered(folder, program):
    scene = ef.encode(folder, proxy=folder / "proxy.obj", textures=2)
    ef.save(scene, folder / "scene.glb")
    (folder / "broken.glb").write_bytes(b"glTF")
    blender("blender_import.py", folder, program)
    scene = ef.load(folder / "scene.glb")
    listing = json.loads((folder / "scene.textures/eigenfield.json").read_text())
    for name, eye in (("texture", (0.1, 0.05)), ("corner", (0.3, -0.15)), ("reopened", (0.3, -0.15))):
        at = np.array(eye) / listing["viewPlane"]["extent"]
        wanted = texture(scene, at=(float(at[0]), float(at[1]))).clip(0, 1)
        off = np.abs(np.load(folder / f"{name}.npy") - wanted)
        assert np.quantile(off, 0.999) < 4 / 255  # means and textures of 8 bits; a mean beyond 1 is cut
    assert np.abs(np.load(folder / "texture.npy") - np.load(folder / "corner.npy")).max() > 12 / 255
    reference = scene.rig.cameras[scene.rig.reference]
    matrix = np.load(folder / "camera.npy")
    np.testing.assert_allclose(matrix[:3, 3], reference.centre, atol=1e-4)
    rendered, drawn = (
        np.asarray(Image.open(folder / name).convert("RGB"), float) / 255 for name in ("between.png", "drawn.png")
    )
    assert -10 * np.log10(np.square(rendered - drawn).mean()) > 30
    assert "broken.glb" in (folder / "refused.txt").read_text()
    assert "names '../drawn.png', which is not in its folder" in (folder / "outside.txt").read_text()


@pytest.mark.slow
def test_a_clip_shows_the_frame_of_a_time(tmp_path, program):
    """At 10 frames a second; the mesh moves by its number."""
    clip = moving_clip(numbered_clip((3, 2), first=5.0), lambda number, places: places + np.array([6 * number, 0, 0]))
    ef.save(clip, tmp_path / "clip.glb")
    blender("blender_clip.py", tmp_path, program)
    listing = json.loads((tmp_path / "clip.frame_0002.textures/eigenfield.json").read_text())
    plane, eye = listing["viewPlane"], np.array(listing["camera"]["translation"])
    at = (eye - plane["origin"])[:2] / plane["extent"]
    for name, frame in (("second", 2), ("fourth", 4), ("opened", 4), ("kept", 4), ("first", 0)):
        scene, seen = clip.scene(float(clip.timeline.times[frame])), np.load(tmp_path / f"{name}.npz")
        wanted = texture(scene, at=(float(at[0]), float(at[1]))).clip(0, 1)
        assert np.quantile(np.abs(seen["texture"] - wanted), 0.999) < 4 / 255
    between = (np.load(tmp_path / f"{name}.npz")["vertices"] for name in ("second", "fourth"))
    moved, (a, b) = np.subtract(*between), (clip.scene(5 + frame / 10).proxy.mesh.vertices for frame in (2, 4))
    np.testing.assert_allclose(np.abs(moved).max(axis=0), np.abs(a - b).max(axis=0), atol=1e-5)
    said = json.loads((tmp_path / "said.json").read_text())
    assert said["times"] == pytest.approx([0.2, 0.43, 0.43, 0.4, 0])
    frames = 2, 4, 4, 4, 0
    assert said["folders"] == [f"clip.frame_{frame:04}.textures" for frame in frames]
    assert not said["before"] and said["panel"] == [f"Frame {frame} of 5, counted from 0" for frame in frames]
