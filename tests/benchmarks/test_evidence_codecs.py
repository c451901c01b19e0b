"""The peers' codecs: the right picture at the right place, whatever order it was coded in; sizes; the way round."""

from __future__ import annotations

import dataclasses
from itertools import pairwise

import av
import numpy as np
import pytest

from eigenfield.core.camera import Camera
from eigenfield.imaging.metrics import psnr
from evidence import codecs, stills
from evidence.codecs import VIDEO, VideoCodec, order, orders, serpentine, spiral
from evidence.stills import STILLS
from support.scenes import row_grid

HEIGHT, WIDTH, COUNT = 66, 98, 13


def quick(codec: VideoCodec) -> VideoCodec:
    """The same codec in a hurry."""
    faster = {"libsvtav1": ("preset", "10"), "libx265": ("preset", "veryfast"), "libaom-av1": ("cpu-used", "8"),
              "libvvenc": ("preset", "faster")}  # fmt: skip
    name, value = faster[codec.encoder]
    return dataclasses.replace(codec, options=tuple((k, value if k == name else v) for k, v in codec.options))


def numbered(position, height=HEIGHT, width=WIDTH):
    """A picture that says its number: bright bars are its bits, on a ground that drifts."""
    y, x = np.mgrid[0:height, 0:width]
    picture = np.stack([90 + x / 2, 60 + y, 150 - x / 3 + position], axis=-1)
    for bit in range(4):
        if position >> bit & 1:
            picture[12 + 12 * bit : 20 + 12 * bit, 10:80] += 60  # grey steps: 4:2:0 by itself loses little of them
    return np.clip(picture, 0, 255).astype(np.uint8)


def usable(codec):
    module = codecs if isinstance(codec, VideoCodec) else stills
    reason = module.missing(codec)
    if reason is not None:
        pytest.skip(reason)


@pytest.mark.parametrize("codec", VIDEO[1:], ids=lambda codec: codec.name)
def test_each_frame_is_the_picture_of_its_place(codec, tmp_path):
    """Encoders put frames into another order; each decoded one must be nearest to its own picture, sizes and all."""
    usable(codec)
    codec = quick(codec)
    pictures = [numbered(k, HEIGHT - k % 3, WIDTH - k % 2) for k in range(COUNT)]
    sizes = [picture.shape[:2] for picture in pictures]
    path = tmp_path / "film"
    assert codecs.encode(pictures, codec, 20, path) > 0
    with av.open(str(path), format=codec.container) as container:
        assert sum(packet.is_keyframe for packet in container.demux() if packet.size) == 1
    decoded = list(codecs.decode(path, codec, sizes))
    assert [picture.shape for picture in decoded] == [picture.shape for picture in pictures]
    common = [picture[: HEIGHT - 2, : WIDTH - 1].astype(float) for picture in pictures]
    for place, picture in enumerate(decoded):
        errors = [np.abs(picture[: HEIGHT - 2, : WIDTH - 1] - other).mean() for other in common]
        assert int(np.argmin(errors)) == place
        assert psnr(picture, pictures[place]) > 35  # the colours' range and matrix are those they were coded with
    for place in (0, COUNT // 2, COUNT - 1):
        seconds, picture = codecs.access(path, codec, place, sizes[place])
        assert seconds > 0 and np.array_equal(picture, decoded[place])


def test_a_point_of_a_video_has_its_bytes_seconds_and_figures(tmp_path):
    codec = next(c for c in VIDEO if c.name == "x265-420")
    usable(codec)
    pictures = [numbered(k) for k in range(5)]
    names, covered = [str(k) for k in range(5)], [np.ones((HEIGHT, WIDTH), bool)] * 5
    fine, coarse = (codecs.measure_video(quick(codec), crf, pictures, names, covered, tmp_path) for crf in (16, 36))
    assert fine["parameter"] == 16 and set(fine["access_seconds"]) == {"middle", "last"}
    assert fine["bytes"] == (tmp_path / "x265-420-16.hevc").stat().st_size
    assert fine["bytes"] > coarse["bytes"] and fine["psnr"] > coarse["psnr"] + 3


def test_a_film_with_other_frames_than_expected_is_an_error(tmp_path):
    codec = next(c for c in VIDEO if c.name == "x265-444")
    usable(codec)
    path = tmp_path / "film.hevc"
    codecs.encode([numbered(k) for k in range(3)], quick(codec), 30, path)
    for count in (2, 4):
        with pytest.raises(ValueError, match=r"more than 2 frames|has 3 frames"):
            list(codecs.decode(path, codec, [(HEIGHT, WIDTH)] * count))
    with pytest.raises(ValueError, match="no frame 3"):
        codecs.access(path, codec, 3, (HEIGHT, WIDTH))


def test_a_codec_that_is_not_there_is_missing_with_a_word(monkeypatch):
    unknown = dataclasses.replace(VIDEO[0], encoder="libnothing")
    assert codecs.missing(unknown) == "PyAV was built without libnothing"
    monkeypatch.setenv("PATH", "")
    program = dataclasses.replace(VIDEO[-1], name="without a program")
    assert codecs.missing(program) == "the ffmpeg program is not installed"


def test_what_the_program_says_is_in_the_error(tmp_path):
    codec = VIDEO[-1]
    usable(codec)
    wrong = dataclasses.replace(codec, options=(("cpu-used", "many"),))
    with pytest.raises(RuntimeError, match=r"cpu-used|many"):
        codecs.encode([numbered(0)], wrong, 30, tmp_path / "film.obu")


@pytest.mark.parametrize("codec", STILLS, ids=lambda codec: codec.name)
def test_single_pictures_come_back_each_with_its_own_bytes(codec, tmp_path):
    usable(codec)
    pictures = [numbered(k, HEIGHT - k % 3, WIDTH - k % 2) for k in range(4)]
    names, covered = list("abcd"), [np.ones(p.shape[:2], bool) for p in pictures]
    figures = [stills.measure_stills(codec, rate, pictures, names, covered, tmp_path) for rate in codec.rates]
    sizes = [point["bytes"] for point in figures]
    assert sizes == sorted(sizes, reverse=True) and len(set(sizes)) == 4
    assert figures[0]["psnr"] > 30 and figures[0]["psnr"] > figures[-1]["psnr"]
    alone = [len(stills.encode(picture, codec, codec.rates[1])) for picture in pictures]
    assert figures[1]["bytes"] == sum(alone)
    path = tmp_path / "one"
    path.write_bytes(stills.encode(pictures[1], codec, codec.rates[1]))
    seconds, picture = stills.access(path, codec)
    assert seconds > 0 and picture.shape == pictures[1].shape and picture.dtype == np.uint8


def test_serpentine_goes_to_and_fro():
    assert serpentine(3, 3) == [0, 1, 2, 5, 4, 3, 6, 7, 8]
    assert serpentine(1, 4) == [0, 1, 2, 3]
    assert serpentine(4, 1) == [0, 1, 2, 3]


def cameras_at(points):
    K = np.array([[100.0, 0, 32], [0, 100, 24], [0, 0, 1]])
    return [Camera(K, np.eye(3), -np.array([x, y, 0.0]), 64, 48) for x, y in points]


def test_a_shuffled_grid_is_walked_between_neighbours():
    nodes = np.array([(column, row) for row in range(3) for column in range(4)], float)
    nodes = nodes[np.random.default_rng(1).permutation(12)]
    way = order(cameras_at(nodes))
    assert sorted(way) == list(range(12))
    steps = np.abs(np.diff(nodes[way], axis=0))
    assert (steps.sum(axis=1) == 1).all() and (steps[:, 1] == 1).sum() == 2  # twice from row to row


def test_cameras_without_a_grid_are_walked_from_one_to_the_nearest():
    arc = np.array([(np.cos(t) * 5, np.sin(t) * 5) for t in (0, 0.3, 0.55, 0.9, 1.4, 1.7)])
    shuffled = np.random.default_rng(2).permutation(6)
    way = [int(shuffled[place]) for place in order(cameras_at(arc[shuffled]))]
    assert way in (list(range(6)), list(range(6))[::-1])
    assert order(cameras_at([(0, 0)])) == [0]


def test_a_spiral_goes_outwards_from_neighbour_to_neighbour():
    assert sorted(spiral(5, 7)) == list(range(35))
    places = [divmod(place, 5) for place in spiral(5, 5)]
    assert places[0] == (2, 2)
    rings = [max(abs(row - 2), abs(column - 2)) for row, column in places]
    assert rings == sorted(rings)
    steps = [max(abs(a - c), abs(b - d)) for (a, b), (c, d) in pairwise(places)]
    assert max(steps) == 1


def test_orders_of_a_grid_and_of_cameras_anywhere():
    cameras = row_grid(9, 32, 24)
    assert set(orders(cameras)) == {"rows", "serpentine", "spiral"}
    for way in orders(cameras).values():
        assert sorted(way) == list(range(9))
