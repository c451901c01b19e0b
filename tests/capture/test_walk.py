"""One video of a walk: sharp frames, evenly spread by how far the picture moves."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
import pytest

from eigenfield.capture import open_any, open_photographs
from eigenfield.capture.readers import video, walk
from support.named import refused, write

WIDTH, HEIGHT = 320, 240
SPEEDS = [2] * 30 + [0] * 30 + [8] * 15  # pixels a frame: 60 slowly, a stop, 120 fast
SHARP = 3  # every third frame is


def write_walk(path: Path, speeds: list[int] = SPEEDS, blurred: bool = True) -> np.ndarray:
    """A camera that passes a wall of noise; the place of each frame."""
    path.parent.mkdir(parents=True, exist_ok=True)
    wall = np.random.default_rng(1).uniform(0, 255, (HEIGHT // 4, 200, 3)).astype(np.float32)
    wall = np.clip(cv2.resize(wall, (800, HEIGHT), interpolation=cv2.INTER_CUBIC), 0, 255).astype(np.uint8)
    places = np.cumsum(speeds)
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=Fraction(25), options={"crf": "16"})
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
        for number, place in enumerate(places):
            shown = np.ascontiguousarray(wall[:, place : place + WIDTH])
            if blurred and number % SHARP:
                shown = cv2.blur(shown, (9, 1))
            container.mux(stream.encode(av.VideoFrame.from_ndarray(shown, format="rgb24")))
        container.mux(stream.encode(None))
    return places


def numbers(opened) -> list[int]:
    return [int(name.removeprefix("frame_").removesuffix(".png")) for name in opened.names]


def test_sharp_frames_evenly_spread(tmp_path):
    path = tmp_path / "walk.mp4"
    places = write_walk(path)
    opened = open_any(path, walk_frames=6, work=tmp_path / "work")
    assert opened.format == "walk" and opened.layout is None and opened.root == path
    assert opened.problems == ("6 frames of the video are used",)
    chosen = numbers(opened)
    assert all(number % SHARP == 0 for number in chosen), chosen
    steps = np.diff(places[chosen])
    assert steps.min() >= 12 and steps.max() <= 48, steps  # 180 pixels in 6 steps
    before = opened.shots[0].path.stat().st_mtime_ns
    again = open_photographs(path, walk_frames=6, work=tmp_path / "work")
    assert again.shots[0].path == opened.shots[0].path and again.shots[0].path.stat().st_mtime_ns == before
    frame = video.read_frame(path, chosen[4])
    assert np.array_equal(np.rint(opened.photograph(4).pixels * 255), frame)


def test_a_folder_of_one_video_and_the_default_number(tmp_path):
    write_walk(tmp_path / "IMG_0001.MOV")
    opened = open_any(tmp_path)
    low, high = walk.WALK_DEFAULT_RANGE
    assert opened.format == "walk" and 20 <= len(opened) <= low < high and "--walk-frames" in opened.problems[0]
    write(tmp_path, ["a.png", "b.png", "c.png"])
    opened = open_any(tmp_path)
    assert opened.format == "folder" and ".mov (a video: name it alone" in opened.problems[0]
    write_walk(tmp_path / "z.mp4")
    refused("format-ambiguous", tmp_path)


def test_what_is_no_walk(tmp_path, monkeypatch):
    path = tmp_path / "a.mp4"
    write_walk(path, [0] * 12, blurred=False)
    assert "walk around" in refused("video-still", path).remedy
    write_walk(path, [8, 8])
    refused("video-short", path)
    write_walk(path, [8] * 20)
    monkeypatch.setattr(walk, "WALK_MAX_FRAMES", 19)
    refused("video-long", path)
    monkeypatch.setattr(video, "VIDEO_MAX_PIXELS", 1000)
    refused("video-large", path)
    monkeypatch.undo()
    data = path.read_bytes()
    for part in (0, 100, len(data) // 2):
        path.write_bytes(data[:part])
        refused("video-unreadable", path)
    for count in (2, 1001, -5):
        refused("walk-frames-unknown", path, walk_frames=count)
    refused("walk-frames-unused", write(tmp_path / "p", ["a.png", "b.png", "c.png"]), walk_frames=12)
    refused("names-unknown", tmp_path / "p", format="walk")


@pytest.mark.slow
def test_inspect_and_calibrate(tmp_path, run):
    write_walk(tmp_path / "a.mp4")
    code, out, _ = run("inspect", tmp_path / "a.mp4", "--walk-frames", "12")
    assert code == 0 and "12 photographs without cameras from walk" in out and "--walk-frames 12" in out
    for verb in (["inspect"], ["encode"], ["calibrate"], ["view", "scene.glb"]):
        code, _, err = run(*verb, tmp_path / "a.mp4", "--frames", "12")
        assert code == 2 and err.endswith("--frames is now called --walk-frames; say --walk-frames 12\n")
    refused("option-renamed", tmp_path / "a.mp4", frames=12)
    code, _, err = run("calibrate", tmp_path / "a.mp4", "-o", tmp_path / "cal")
    assert code == 2 and "--work" in err and err.count("\n") == 1
