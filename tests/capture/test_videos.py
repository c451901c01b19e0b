"""One video a camera: frames by index and time, and videos that cannot be read."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

from eigenfield.capture import open_any, open_photographs
from eigenfield.capture.readers.video import parse_frame, read_frame
from eigenfield.core.errors import OptionError
from support.named import refused, write_video

# videos


def test_one_frame_of_each_video(tmp_path):
    truth = [write_video(tmp_path / "rig" / "videos" / f"cam_{i}.mp4", 12, camera=i) for i in range(3)]
    photo_set = open_any(tmp_path / "rig", frame=7, work=tmp_path / "work")
    assert photo_set.format == "video" and photo_set.names == ("cam_0.png", "cam_1.png", "cam_2.png")
    assert photo_set.layout is None and not photo_set.problems
    for index in range(3):
        pixels = photo_set.photograph(index).pixels * 255
        distance = [np.abs(pixels - t).mean() for t in truth[index]]
        assert np.argmin(distance) == 7 and distance[7] < 1.5
    before = photo_set.shots[0].path.stat().st_mtime_ns
    again = open_photographs(tmp_path / "rig", frame="7", work=tmp_path / "work")
    assert again.shots[0].path == photo_set.shots[0].path and again.shots[0].path.stat().st_mtime_ns == before
    by_time = open_any(tmp_path / "rig", frame="0.75s")  # shown from 0.7 s to 0.8 s
    assert np.array_equal(by_time.photograph(0).pixels, photo_set.photograph(0).pixels)
    assert "frame 0" in open_any(tmp_path / "rig").problems[0]


@pytest.mark.parametrize("frame", [0, 4, 11, 0.0, 0.349, 1.19])
def test_frames_by_index_and_time(tmp_path, frame):
    truth = write_video(tmp_path / "a.mp4", 12)
    found = read_frame(tmp_path / "a.mp4", frame).astype(float)
    wanted = frame if isinstance(frame, int) else int(frame * 10)
    assert np.argmin([np.abs(found - t).mean() for t in truth]) == wanted


def test_videos_that_are_too_short_or_none(tmp_path):
    write_video(tmp_path / "a.mp4", 12)
    write_video(tmp_path / "b.mp4", 5)
    error = refused("video-short", tmp_path, frame=8)
    assert "b.mp4" in str(error) and "5 frames" in str(error)
    assert "0.5 s" in str(refused("video-short", tmp_path, frame="0.9s"))
    (tmp_path / "b.mp4").write_bytes((tmp_path / "a.mp4").read_bytes()[:300])
    assert "b.mp4" in str(refused("video-unreadable", tmp_path))
    (tmp_path / "b.mp4").write_bytes(b"")
    refused("video-unreadable", tmp_path)


@pytest.mark.parametrize("word", ["-1", "2.5", "s", "1e3s", "x", "", "1:20"])
def test_frames_that_are_none(word):
    with pytest.raises(OptionError, match="--frame"):
        parse_frame(word)


# how a stored point (x, y) is shown: a, b, c, d of (a x + c y, b x + d y), and the same of an array
DISPLAYS = {
    "as stored": ((1, 0, 0, 1), lambda p: p),
    "left and right exchanged": ((-1, 0, 0, 1), lambda p: p[:, ::-1]),
    "upside down and mirrored": ((1, 0, 0, -1), lambda p: p[::-1]),
    "half a turn": ((-1, 0, 0, -1), lambda p: p[::-1, ::-1]),
    "a quarter turn clockwise": ((0, 1, -1, 0), lambda p: np.rot90(p, -1)),
    "a quarter turn back": ((0, -1, 1, 0), lambda p: np.rot90(p, 1)),
    "rows for columns": ((0, 1, 1, 0), lambda p: p.swapaxes(0, 1)),
    "rows for columns, both reversed": ((0, -1, -1, 0), lambda p: np.rot90(p, 2).swapaxes(0, 1)),
}


@pytest.mark.parametrize("name", DISPLAYS)
def test_a_video_is_shown_as_its_display_matrix_says(tmp_path, name):
    write_video(tmp_path / "a.mp4", 3)
    flat = read_frame(tmp_path / "a.mp4", 1)
    data = bytearray((tmp_path / "a.mp4").read_bytes())
    at = data.index(b"tkhd") + 4 + 40  # the matrix of the track header, version 0
    (a, b, c, d), shown = DISPLAYS[name]
    matrix = [a << 16, b << 16, 0, c << 16, d << 16, 0, 0, 0, 1 << 30]
    data[at : at + 36] = b"".join(v.to_bytes(4, "big", signed=True) for v in matrix)
    (tmp_path / "a.mp4").write_bytes(data)
    assert np.array_equal(read_frame(tmp_path / "a.mp4", 1), shown(flat))


def test_frames_without_a_work_folder_are_taken_out_once_a_process(tmp_path):
    for i in range(3):
        write_video(tmp_path / f"cam_{i}.mp4", 3, camera=i)
    first, again = open_any(tmp_path), open_any(tmp_path, strict=False)
    assert first.shots == again.shots
    other = open_any(tmp_path, frame=2)
    assert other.shots[0].path != first.shots[0].path and first.shots[0].path.exists()
    shutil.rmtree(first.shots[0].path.parents[1])  # by what clears the system's temporary folder
    assert open_any(tmp_path).shots[0].path.exists()
