"""One video a camera: frames by index and time, and videos that cannot be read."""

from __future__ import annotations

import shutil
from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
import pytest

from eigenfield.capture import open_any, open_photographs
from eigenfield.capture.photographs.colour import read_code_points
from eigenfield.capture.readers.video import parse_frame, read_frame
from eigenfield.core.errors import CaptureError, OptionError
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


def test_notes_in_a_video_that_are_no_utf8_do_not_matter(tmp_path):
    truth = write_video(tmp_path / "a.mp4", 3)
    data = (tmp_path / "a.mp4").read_bytes()
    assert b"Lavf" in data
    (tmp_path / "a.mp4").write_bytes(data.replace(b"Lavf", b"L\xa2vf"))
    assert np.abs(read_frame(tmp_path / "a.mp4", 1).astype(float) - truth[1]).mean() < 1.5


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


# colours

PICTURE = cv2.resize(
    np.random.default_rng(0).integers(0, 256, (6, 8, 3), np.uint8), (96, 72), interpolation=cv2.INTER_CUBIC
)
BT709, BT601, BT2020 = 1, 5, 9  # AVColorSpace


def add_stream(container, codec: str, pixels: str, size: tuple[int, int], **tags):
    stream = container.add_stream(codec, rate=Fraction(10))
    (stream.width, stream.height), stream.pix_fmt = size, pixels
    for name, value in tags.items():
        setattr(stream.codec_context, name, value)
    return stream


def write_picture(path: Path, picture: np.ndarray, pixels: str, matrix: int, codec: str = "ffv1", **tags) -> None:
    """Three frames of one picture (uint8 or uint16), in a pixel format, by a matrix that `tags` may state."""
    depth = "rgb24" if picture.dtype == np.uint8 else "rgb48le"
    with av.open(str(path), "w") as container:
        stream = add_stream(container, codec, pixels, picture.shape[1::-1], **tags)
        for _ in range(3):
            frame = av.VideoFrame.from_ndarray(picture, format=depth)
            frame = frame.reformat(format=pixels, dst_colorspace=matrix)
            frame.pts = None
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))


@pytest.mark.parametrize("rows", [576, 720])
@pytest.mark.parametrize("pixels", ["yuv420p", "yuv420p10le", "yuv422p", "yuv422p10le", "yuv444p", "yuv444p10le"])
def test_unmarked_videos_have_the_matrix_of_their_size(tmp_path, pixels, rows):
    picture = cv2.resize(PICTURE, (96, rows), interpolation=cv2.INTER_CUBIC)
    write_picture(tmp_path / "a.mkv", picture, pixels, BT709 if rows > 576 else BT601)
    assert np.abs(read_frame(tmp_path / "a.mkv", 1).astype(float) - picture).mean() < 4  # 10 by the other one


@pytest.mark.parametrize("matrix", [BT709, BT601, BT2020])
def test_a_matrix_that_is_stated_counts(tmp_path, matrix):
    write_picture(tmp_path / "a.mkv", PICTURE, "yuv444p", matrix, colorspace=matrix)
    assert np.abs(read_frame(tmp_path / "a.mkv", 1).astype(float) - PICTURE).mean() < 1.5


@pytest.mark.parametrize(("primaries", "transfer"), [(9, 18), (9, 16), (12, 13), (9, 14), (12, 18)])
@pytest.mark.parametrize("pixels", ["yuv420p10le", "yuv444p10le", "yuv422p10le"])
def test_hdr_and_wide_colours_become_srgb_as_those_of_photographs(tmp_path, pixels, primaries, transfer):
    picture = (PICTURE.astype(np.uint16) + 64) * 150  # neither black nor full
    tags = {"colorspace": BT2020, "color_primaries": primaries, "color_trc": transfer, "color_range": 1}
    write_picture(tmp_path / "a.mkv", picture, pixels, BT2020, **tags)
    expected = read_code_points(primaries, transfer).apply(picture / np.float32(65535))
    assert np.abs(read_frame(tmp_path / "a.mkv", 1) - 255 * expected).mean() < 6
    assert np.abs(picture / 257 - 255 * expected).mean() > 6


def test_colours_that_are_not_converted_are_refused(tmp_path):
    matrix, dolby = tmp_path / "a.mkv", tmp_path / "b.mp4"
    write_picture(matrix, PICTURE, "yuv444p", BT2020, colorspace=14)  # ICtCp
    write_picture(dolby, PICTURE, "yuv420p", BT2020, "libx265", options={"x265-params": "log-level=none"})
    dolby.write_bytes(dolby.read_bytes().replace(b"hev1\0", b"dvhe\0"))
    for path, said in ((matrix, "number 14"), (dolby, "Dolby Vision")):
        with pytest.raises(CaptureError, match=said) as caught:
            read_frame(path, 0)
        assert caught.value.code == "video-colours" and caught.value.remedy


def test_the_film_is_read_and_not_its_preview(tmp_path):
    with av.open(str(tmp_path / "a.mkv"), "w") as container:
        small, large = np.zeros((24, 32, 3), np.uint8), PICTURE
        streams = [
            add_stream(container, "mjpeg", "yuvj420p", (32, 24)),
            add_stream(container, "ffv1", "yuv444p", (96, 72)),
        ]
        for stream, picture in zip(streams, (small, large), strict=True):
            for number in range(3):
                frame = av.VideoFrame.from_ndarray(picture, format="rgb24").reformat(format=stream.pix_fmt)
                frame.pts, frame.time_base = number, Fraction(1, 10)
                container.mux(stream.encode(frame))
            container.mux(stream.encode(None))
    assert np.abs(read_frame(tmp_path / "a.mkv", 0).astype(float) - PICTURE).mean() < 2


def test_frames_that_the_decoder_made_up_are_named(tmp_path):
    path = tmp_path / "a.mp4"
    wall = np.random.default_rng(1).integers(0, 256, (60, 110, 3), np.uint8).repeat(4, axis=0).repeat(4, axis=1)
    with av.open(str(path), "w") as container:
        stream = add_stream(container, "libx264", "yuv420p", (320, 240))
        stream.options = {"g": "5", "bf": "0"}
        for number in range(15):
            shown = np.ascontiguousarray(wall[:, 8 * number : 8 * number + 320])
            container.mux(stream.encode(av.VideoFrame.from_ndarray(shown, format="rgb24")))
        container.mux(stream.encode(None))
    sound = {number: read_frame(path, number) for number in (4, 10)}
    with av.open(str(path)) as container:
        packet = list(container.demux(video=0))[5]  # a key frame
        at = packet.pos + packet.size // 2
    data = bytearray(path.read_bytes())
    data[at : at + 20] = b"\xff" * 20
    path.write_bytes(data)
    for number in (4, 5, 9, 10):
        if 5 <= number < 10:
            with pytest.raises(CaptureError, match=f"frame {number} is damaged") as caught:
                read_frame(path, number)
            assert caught.value.code == "video-unreadable" and "--frame" in caught.value.remedy
        else:
            assert np.array_equal(read_frame(path, number), sound[number])
    opened = open_any(path, walk_frames=15)  # a walk does without them
    assert opened.problems[1] == "5 damaged frames of the video are left out"
    assert not {f"frame_{number:05d}.png" for number in range(5, 10)} & set(opened.names)
