"""What is said of footage: offsets by motion, exposure, what stands still."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from eigenfield.capture.footage_survey import find_lags, watch
from support import inspected
from support.filmed import CALIBRATION_FILE, calibration, opened

FRAMES, SIDE = 48, 48


def film(root: Path, delays: list[int], *, move: bool = True, light: np.ndarray | None = None,
         frames: int = FRAMES) -> Path:  # fmt: skip
    """A square that jumps at random moments, seen by cameras that are late by some frames, with noise of 1 level."""
    random = np.random.default_rng(1)
    place = np.cumsum(random.integers(0, 6, frames + 20) * (random.random(frames + 20) < 0.5)) % (SIDE - 12)
    ground = random.integers(60, 180, (SIDE, SIDE, 3))
    for camera, delay in enumerate(delays):
        for frame in range(frames):
            pixels = np.roll(ground, 3 * camera, axis=1).astype(float)
            at = int(place[frame + 10 - delay]) if move else 5
            pixels[18 : 18 + 10, at : at + 12] = 240
            pixels *= 1.0 if light is None else light[frame]
            pixels += np.random.default_rng([camera, frame]).normal(0, 1, pixels.shape)
            file = root / f"cam_{camera}" / f"{frame:03d}.png"
            file.parent.mkdir(parents=True, exist_ok=True)
            Image.fromarray(np.clip(np.rint(pixels), 0, 255).astype(np.uint8)).save(file, compress_level=1)
    return root


@pytest.mark.parametrize("delays", [[0, 0, 0], [0, 3, 0, 0], [0, -5, 2, 0, 0]])
def test_cameras_that_are_late_are_found(tmp_path, delays):
    footage = opened(film(tmp_path, delays))
    watched = watch(footage)
    lags = find_lags([one.energy for one in watched])
    assert [lag.frames for lag in lags] == delays and all(lag.known for lag in lags)
    assert all(0.5 < one.still < 0.99 and one.stops < 0.1 and not one.damaged for one in watched)
    mended = opened(tmp_path, offset=[f"cam_{camera}={delay}" for camera, delay in enumerate(delays)])
    assert not any(lag.frames for lag in find_lags([one.energy for one in watch(mended)]))


def test_nothing_moves(tmp_path):
    watched = watch(opened(film(tmp_path, [0, 0, 0], move=False)))
    assert all(one.still > 0.99 for one in watched)
    assert not any(lag.known and lag.frames for lag in find_lags([one.energy for one in watched]))
    assert not any(lag.known for lag in find_lags([np.zeros(FRAMES)] * 3))


def test_two_cameras_and_one_frame(tmp_path, run):
    film(tmp_path, [0, 0])
    calibration(tmp_path / CALIBRATION_FILE, {c: [(f"cam_{c}.png", None)] for c in range(2)}, w=SIDE, h=SIDE)
    code, out, err = run("inspect", tmp_path, "--clip", "0:1")
    assert code == 0 and "one frame shows no motion" in out and "too few" not in out, out + err
    assert "would run, with a mesh" in out  # a surface wants three
    assert f"eigenfield encode {tmp_path} --clip 0:1 --proxy mesh.glb -o clip.glb" in out


def test_an_offset_that_gains_little_is_not_told():
    """One camera sees what moves a frame before the others do, as in perspective it may, and only a little better."""
    random = np.random.default_rng(5)
    shared = np.convolve(random.random(FRAMES + 8), np.hanning(9), "same")[4:-4]
    early = np.roll(shared, -1)
    mixed = [np.exp(3 * (0.3 * shared + 0.7 * early)), *(np.exp(3 * shared) for _ in range(4))]
    assert [lag.frames for lag in find_lags(mixed)] == [0] * 5


def test_light_that_drifts(tmp_path):
    watched = watch(opened(film(tmp_path, [0, 0, 0], light=np.linspace(1, 0.7, FRAMES))))
    assert all(one.stops == pytest.approx(2.2 * np.log2(1 / 0.7), abs=0.15) and one.still < 0.2 for one in watched)


@pytest.mark.parametrize("words", [("--clip",), ("--clip", "0:40", "--offset", "cam_1=1")])
def test_inspect(tmp_path, run, words):
    film(tmp_path, [0, 4, 0])
    files = {c: [(f"cam_{c}.png", None)] for c in range(3)}
    calibration(tmp_path / CALIBRATION_FILE, files, w=SIDE, h=SIDE)
    code, out, err = run("inspect", tmp_path, *words)
    assert code == 0 and "3 cameras" in out and "try --offset cam_1=4" in out and "30 a second" in out, out + err
    code, out, err = run("inspect", tmp_path, *words, "--json")
    report = json.loads(out)
    assert code == 0 and inspected.violation(report) is None, err
    late = [camera["offset"] for camera in report["footage"]["cameras"]]
    assert late == [0, 3 if "--offset" in words else 4, 0] and report["bytes"] > 0 and report["views"] == 3
    assert all(" --clip" in command for command in report["next"])
    said = "--clip 0:40 --offset cam_1=1" if "--offset" in words else "--clip :"
    assert report["next"] == [f"eigenfield encode {tmp_path} {said} -o clip.glb"]


def test_inspect_says_offsets_in_frames_of_the_clock_and_names_as_words(tmp_path, run):
    names = ("left cam", "b", "c")
    film(tmp_path, [4, 0, 0], frames=72)
    for camera, name in enumerate(names):
        (tmp_path / f"cam_{camera}").rename(tmp_path / name)
    calibration(tmp_path / CALIBRATION_FILE, {c: [(f"{n}.png", None)] for c, n in enumerate(names)}, w=SIDE, h=SIDE)
    for words in ((), ("--offset", "left cam.png=2")):
        code, out, err = run("inspect", tmp_path, "--clip", ":", *words)
        assert code == 0 and "try --offset 'left cam=4'\n" in out, out + err
    code, out, err = run("inspect", tmp_path, "--clip", "::2")
    assert code == 0 and "try --offset 'left cam=4'\n" in out, out + err
    code, out, err = run("inspect", tmp_path, "--clip", "::2", "--json")
    assert [camera["offset"] for camera in json.loads(out)["footage"]["cameras"]] == [0, 0, 4], err


def test_cameras_come_before_all_else(tmp_path, run):
    code, out, err = run("inspect", film(tmp_path, [0, 0, 0]), "--clip", "0:4")
    assert code == 0 and "would run, with cameras\n" in out, out + err
    assert f"next       eigenfield calibrate {tmp_path} --clip 0:4" in out and "encode /" not in out


def test_inspect_counts_damaged_pictures(tmp_path, run):
    film(tmp_path, [0, 0, 0])
    files = {c: [(f"cam_{c}.png", None)] for c in range(3)}
    calibration(tmp_path / CALIBRATION_FILE, files, w=SIDE, h=SIDE)
    for number, left in ((3, 0), (7, 60)):
        file = tmp_path / "cam_1" / f"{number:03d}.png"
        file.write_bytes(file.read_bytes()[:left])
    code, out, err = run("inspect", tmp_path, "--clip", "3:")  # the first frame is damaged, too
    assert code == 0 and "cam_1 (2)" in out and "problems   none" in out, out + err
