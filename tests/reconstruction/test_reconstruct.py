"""From bare photographs to a scene: the whole way, taken up again, and what bad input gets."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from PIL import Image

from eigenfield.capture import open_any, open_capture
from eigenfield.core.errors import CaptureError, OptionError, ProxyError
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import atlas_fault, read_mesh
from eigenfield.reconstruction import whole
from eigenfield.reconstruction.array import looks_one_way
from eigenfield.reconstruction.stage_files import read_planar
from eigenfield.reconstruction.whole import reconstruct
from support.captures import write_array
from support.motion import photographed
from support.planes import everywhere, lying_and_upright, paint, photograph


@pytest.fixture(scope="module")
def photos(tmp_path_factory):
    folder = tmp_path_factory.mktemp("array") / "photos"
    write_array(folder)
    return folder


@pytest.fixture(scope="module")
def made(photos, tmp_path_factory):
    work = tmp_path_factory.mktemp("work")
    return work, reconstruct(open_any(photos), layers=1, work=work)


def test_cameras_and_mesh_of_bare_photographs(made):
    _, result = made
    assert len(result.light_field) == 16
    assert atlas_fault(result.proxy.mesh) is None
    for camera in result.light_field.cameras:
        assert (rasterise_view(result.proxy.mesh, camera).face >= 0).all()
    assert list(result.seconds) == ["array", "relief"]
    assert looks_one_way(result.light_field.cameras)


def test_finished_stages_are_taken_up(photos, made):
    work, first = made
    again = reconstruct(open_any(photos), layers=1, work=work)
    assert set(again.seconds.values()) == {0.0}
    assert np.array_equal(again.proxy.mesh.vertices, first.proxy.mesh.vertices)
    for before, after in zip(first.light_field.cameras, again.light_field.cameras, strict=True):
        assert np.array_equal(before.matrix, after.matrix)


def test_refined_cameras_are_kept_for_other_tools(photos, made):
    _, result = made
    assert len(result.light_field.cameras) >= 3
    for name in ("transforms.json", "sparse/0"):
        read = open_capture(photos, calibration=result.calibration / name)
        for before, after in zip(result.light_field.cameras, read.cameras, strict=True):
            np.testing.assert_allclose(after.matrix, before.matrix, atol=1e-6)


@pytest.mark.slow
def test_a_surface_from_all_sides_gets_an_atlas_unless_it_is_left_to_who_simplifies_it(tmp_path):
    _, capture = photographed(tmp_path / "photos")
    bare, whole = (
        reconstruct(capture, surface="poisson", triangles=500, atlas=atlas, work=tmp_path / "work")
        for atlas in (False, True)
    )
    assert bare.proxy.mesh.uv is None and bare.report.atlas is None and list(bare.seconds) == ["surface"]
    assert atlas_fault(whole.proxy.mesh) is None and whole.seconds["surface"] == 0 < whole.seconds["proxy"]
    assert len(whole.proxy.mesh.faces) == len(bare.proxy.mesh.faces)


@pytest.mark.slow
def test_blind_views_only_register_their_own_camera(photos, made, tmp_path):
    _, seeing = made
    blind = reconstruct(open_any(photos), work=tmp_path, blind="every:5")
    assert blind.light_field.names == seeing.light_field.names
    changed = tmp_path / "changed"
    shutil.copytree(photos, changed)
    held = blind.light_field.names[2]
    with Image.open(changed / held) as picture:
        other = picture.transpose(Image.Transpose.FLIP_TOP_BOTTOM)
    other.save(changed / held)
    without = reconstruct(open_any(changed), blind="every:5")
    assert np.array_equal(without.proxy.mesh.vertices, blind.proxy.mesh.vertices)


@pytest.mark.slow
def test_a_photograph_of_another_scene_is_named_and_left_out(photos, tmp_path):
    mixed = tmp_path / "mixed"
    shutil.copytree(photos, mixed)
    foreign = mixed / "view_03_00.png"
    noise = np.random.default_rng(0).integers(0, 255, (12, 12, 3), np.uint8)
    Image.fromarray(noise).resize((96, 96), Image.Resampling.BICUBIC).save(foreign)
    result = reconstruct(open_any(mixed))
    assert foreign.name not in result.light_field.names
    assert len(result.light_field) == 15
    assert any(foreign.name in problem for problem in result.light_field.problems)


SIDE = 128


def near(x, y):
    return (abs(x - 60) < 22) & (abs(y - 64) < 26)


def write_square_before_a_wall(folder, steps, places):
    """A square of depth 2 before a wall of depth 3.2, by cameras 0.1 a step apart that show some rows and columns."""
    folder.mkdir(exist_ok=True)
    matrices = np.array([[[1, 0, -x, 0], [0, 1, -y, 0], [0, 0, 0, 1]] for x, y in steps], float)
    pictures = photograph([(6.4, 0, 0, paint(1), near), (4.0, 0, 0, paint(2), everywhere)], matrices, SIDE)
    frames = []
    for index, ((x, y), picture, place) in enumerate(zip(steps, pictures, places, strict=True)):
        Image.fromarray(picture[place]).save(folder / f"{index:02}.png")
        camera = {"fl_x": 128, "fl_y": 128, "cx": 64 - place[1].start, "cy": 64 - place[0].start}
        world = [[1, 0, 0, 0.1 * x], [0, 1, 0, -0.1 * y], [0, 0, 1, 0], [0, 0, 0, 1]]
        frames.append({"file_path": f"{index:02}.png", "transform_matrix": world, **camera})
    (folder / "transforms.json").write_text(json.dumps({"frames": frames}))


def wrong_depths(result):
    """Part of the first photograph's pixels whose depth is over 5 % off."""
    camera = result.light_field.cameras[0]
    inverse = rasterise_view(result.proxy.mesh, camera).inverse_depth
    row, column = np.indices(inverse.shape)
    x, y = column + 64 - camera.K[0, 2], row + 64 - camera.K[1, 2]
    across, down = 64 * (camera.R @ camera.centre)[:2]
    true = np.where(near(x + across, y + down), 1 / 2.0, 1 / 3.2)
    return (np.abs(inverse / true - 1) > 0.05).mean()


def test_photographs_lying_and_upright_give_the_depth_that_is_there(tmp_path):
    cameras = [(0, 0), *((x, y) for y in (-1, 1) for x in (-1, 0, 1))]
    write_square_before_a_wall(tmp_path, cameras, lying_and_upright(len(cameras), SIDE, 96))
    result = reconstruct(open_any(tmp_path), layers=1)
    assert len(result.light_field) == len(cameras) and not result.light_field.problems
    assert wrong_depths(result) < 0.02


def test_depth_is_estimated_at_a_smaller_size_where_memory_ends(tmp_path, monkeypatch, caplog):
    cameras = [(x, y) for y in (-1, 0, 1) for x in (-1, 0, 1)]
    write_square_before_a_wall(tmp_path / "capture", cameras, [(slice(0, SIDE), slice(0, SIDE))] * len(cameras))
    monkeypatch.setattr("eigenfield.stereo.estimate.DEPTH_MAX_PIXELS", SIDE**2 / 2)
    with caplog.at_level("INFO", "eigenfield"):
        result = reconstruct(open_any(tmp_path / "capture"), layers=1, work=tmp_path / "work")
    size = int(re.search(r"depth: estimated at (\d+) x \1 pixels", caplog.text)[1])
    (depth,) = (tmp_path / "work").rglob("depth.npz")
    assert 64 < size < 90 and read_planar(depth).reference.photograph_size == (size, size)
    for camera in result.light_field.cameras:
        assert np.allclose(camera.K, [[128, 0, 64], [0, 128, 64], [0, 0, 1]])
    assert wrong_depths(result) < 0.06


def test_a_walk_past_near_things_is_no_relief(tmp_path, monkeypatch, caplog):
    """Things move by over twice a photograph's width from its middle to its end."""

    def all_around(run, shown, points):
        raise RuntimeError("from all sides")

    monkeypatch.setattr(whole, "_poisson", all_around)
    cameras = [(3 * x, x % 2) for x in range(-14, 15)]
    write_square_before_a_wall(tmp_path / "capture", cameras, [(slice(0, SIDE), slice(0, SIDE))] * len(cameras))
    capture = open_any(tmp_path / "capture")
    assert looks_one_way(capture.cameras)
    with pytest.raises(RuntimeError, match="from all sides"):
        reconstruct(capture, layers=1, refine=False, work=tmp_path / "work")
    monkeypatch.setattr("eigenfield.stereo.estimate.DEPTH_MAX_PIXELS", SIDE**2)
    with caplog.at_level("INFO", "eigenfield"):
        relief = reconstruct(capture, surface="relief", refine=False, work=tmp_path / "work")
    assert list(relief.seconds) == ["array", "relief"] and "depth: estimated at" in caplog.text
    with pytest.raises(RuntimeError, match="from all sides"):  # whatever is finished
        reconstruct(capture, layers=1, refine=False, work=tmp_path / "work")


def test_options_that_cannot_be(photos):
    with pytest.raises(OptionError, match="surface"):
        reconstruct(open_any(photos), surface="wavy")
    with pytest.raises(OptionError):
        reconstruct(open_any(photos), primitives=["cube:1,2,3"])
    with pytest.raises(OptionError):
        reconstruct(open_any(photos), fit_spheres=["view:1,2"])
    with pytest.raises(OptionError, match="metric"):
        reconstruct(open_any(photos), surface="poisson")


def test_a_wrong_grid_ends_in_one_line(photos, tmp_path, run):
    numbered = tmp_path / "numbered"
    numbered.mkdir()
    for number, path in enumerate(sorted(photos.iterdir())):
        shutil.copy(path, numbered / f"{number:03d}.png")
    code, _, err = run("encode", numbered, "--grid", "2x8", "-o", tmp_path / "scene.glb")
    assert code == 2
    *steps, last = err.strip().splitlines()
    assert any(line.startswith("step 1 of") for line in steps) and "grid" in last
    assert not (tmp_path / "scene.glb").exists()


def test_grey_photographs_end_in_one_line(tmp_path):
    grey = tmp_path / "grey"
    grey.mkdir()
    for row in range(3):
        for column in range(3):
            Image.new("RGB", (64, 64), (90 + row, 90, 90 + column)).save(grey / f"view_{row:02d}_{column:02d}.png")
    with pytest.raises(CaptureError) as error:
        reconstruct(open_any(grey))
    assert error.value.code == "grid-texture"


def test_a_given_proxy_and_its_options_do_not_mix(photos, tmp_path, run):
    mesh = tmp_path / "mesh.ply"
    mesh.write_bytes(b"ply\n")
    code, _, err = run("encode", photos, "--proxy", mesh, "--no-refine", "-o", tmp_path / "scene.glb")
    assert code == 2
    assert "--proxy" in err


def test_the_proxy_verb_writes_mesh_and_cameras(photos, made, tmp_path, run):
    work, result = made
    code, _, err = run("proxy", photos, "-o", tmp_path / "mesh.glb", "--work", work)
    assert code == 0, err
    assert "taken up" in err
    mesh = read_mesh(tmp_path / "mesh.glb")
    assert np.array_equal(np.sort(mesh.vertices, axis=0), np.sort(result.proxy.mesh.vertices, axis=0))
    poses = json.loads((tmp_path / "mesh.cameras" / "transforms.json").read_text())["frames"]
    assert len(poses) == 16
    assert run("proxy", photos, "-o", tmp_path / "mesh.obj")[0] == 2


@pytest.mark.slow
def test_bare_photographs_are_measured_by_the_scenes_own_cameras(photos, made, tmp_path, run):
    work, _ = made
    scene = tmp_path / "scene.glb"
    code, _, err = run("encode", photos, "-o", scene, "--work", work, "-n", "5", "--hold-out", "every:4")
    assert code == 0, err
    _, measured, _ = run("evaluate", scene, photos, "--json")
    figures = json.loads(measured)["image"]
    assert figures["held_out"]["psnr"] > 27
    assert figures["encoded"]["psnr"] > 29


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.slow
def test_a_killed_run_goes_on(photos, tmp_path, run):
    command = [sys.executable, "-m", "eigenfield", "encode", str(photos), "-o", str(tmp_path / "scene.glb")]
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    work = tmp_path / "scene.work"
    deadline = time.monotonic() + 300
    while not list(work.glob("array-*")) and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert not (tmp_path / "scene.glb").exists()
    code, _, err = run("encode", photos, "-o", tmp_path / "scene.glb")
    assert code == 0, err
    assert "depth: taken up from an earlier run" in err
    assert not list(work.glob(".*.part"))


def test_masks_restrict_the_relief(photos, tmp_path):
    masks = tmp_path / "masks"
    masks.mkdir()
    for path in photos.iterdir():
        shown = np.zeros((96, 96), np.uint8)
        shown[:, :48] = 255
        Image.fromarray(shown).save(masks / path.name)
    work = tmp_path / "work"
    result = reconstruct(open_any(photos, masks=masks), work=work)
    covered = [(rasterise_view(result.proxy.mesh, camera).face >= 0) for camera in result.light_field.cameras]
    assert np.mean([part[:, :36].mean() for part in covered]) > 0.97
    assert np.mean([part[:, 66:].mean() for part in covered]) < 0.05
    closed = reconstruct(open_any(photos, masks=masks), background=True, work=work)
    assert closed.seconds["array"] == 0 < closed.seconds["relief"]
    for camera in closed.light_field.cameras:
        assert (rasterise_view(closed.proxy.mesh, camera).face >= 0).all()
    black = tmp_path / "black"
    black.mkdir()
    for path in photos.iterdir():
        Image.fromarray(np.pad(np.full((1, 1), 255, np.uint8), ((0, 95), (0, 95)))).save(black / path.name)
    with pytest.raises(ProxyError) as error:
        reconstruct(open_any(photos, masks=black))
    assert error.value.code in ("surface-masked", "relief-empty")
