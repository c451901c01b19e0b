"""Films of a residual: coded and decoded, refused when they are not what was said; differences as their planes."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.coding.pictures.av1_units import SEQUENCE_HEADER, units
from eigenfield.coding.video.av1 import decode_video, encode_video
from eigenfield.core.errors import FormatError
from eigenfield.encoding.residual.colour import double_size, to_difference, to_planes

SCALE = 1 / 510, 1 / 816
SMALL = 64, 72


def flat(count, value=512, size=SMALL):
    for _ in range(count):
        half = np.full((size[0] // 2, size[1] // 2), value, np.uint16)
        yield np.full(size, value, np.uint16), half, half


def test_a_video_of_no_difference_is_none_and_costs_nothing():
    video = encode_video(flat(12), SMALL, 40, 2)
    assert len(video) < 500
    frames = list(decode_video(video, SMALL, 12, "here", "residual"))
    assert len(frames) == 12
    assert all((plane == 512).all() for planes in frames for plane in planes)


def test_a_video_has_the_same_bytes_each_time():
    random = np.random.default_rng(1)
    noise = [tuple(random.integers(300, 700, plane.shape).astype(np.uint16) for plane in f) for f in flat(5)]
    assert encode_video(noise, SMALL, 30, 2) == encode_video(noise, SMALL, 30, 2)


@pytest.mark.parametrize(
    ("size", "count", "cut"),
    [((64, 74), 6, None), ((62, 72), 6, None), (SMALL, 7, None), (SMALL, 6, 60), (SMALL, 6, 0)],
    ids=["wider", "lower", "more", "cut", "nothing"],
)
def test_videos_that_are_not_what_was_said(size, count, cut):
    video = encode_video(flat(6, 700), SMALL, 40, 2)
    with pytest.raises(FormatError) as caught:
        list(decode_video(video if cut is None else video[:cut], size, count, "here", "residual"))
    assert caught.value.code == "residual-damaged" and caught.value.where == "here"


def test_an_error_names_what_the_video_is_of():
    video = encode_video(flat(2), SMALL, 40, 8)
    with pytest.raises(FormatError, match="the film cannot be decoded: ends after 2 of 3") as caught:
        list(decode_video(video, SMALL, 3, "here", "film"))
    assert caught.value.code == "film-damaged"


@pytest.mark.parametrize(("interval", "keys"), [(None, 1), (4, 3), (12, 1)])
def test_key_frames_come_at_their_interval(interval, keys):
    """Each begins with a sequence header, from which a decoder can begin."""
    video = encode_video(flat(12), SMALL, 40, 8, interval)
    headers = [start for kind, start, _, _ in units(video) if kind == SEQUENCE_HEADER]
    assert len(headers) == keys
    rest = list(decode_video(video[headers[-1] :], SMALL, 12 if keys == 1 else 4, "here", "residual"))
    assert all((plane == 512).all() for planes in rest for plane in planes)


def test_no_more_frames_are_decoded_than_were_said():
    assert len(list(decode_video(encode_video(flat(6), SMALL, 40, 2), SMALL, 2, "here", "residual"))) == 2


def test_planes_and_back():
    """Half a code a sample of luma; chroma that varies as a straight line survives being halved and doubled."""
    y, x = np.mgrid[0:30, 0:40].astype(np.float32)
    difference = np.stack([0.004 * x - 0.1, 0.003 * y - 0.002 * x, 0.002 * y], axis=-1)
    planes = to_planes(difference, (32, 40), SCALE)
    assert [plane.shape for plane in planes] == [(32, 40), (16, 20), (16, 20)]
    assert all((plane[-1] == 512).all() for plane in planes)  # below the photograph: no difference
    back = to_difference(planes, 30, 40, SCALE)
    np.testing.assert_allclose(back[4:-6, 4:-4], difference[4:-6, 4:-4], atol=1.8 / 510)
    noise = np.random.default_rng(2).normal(0, 0.1, (30, 40, 3)).astype(np.float32)
    planes = to_planes(noise, (32, 40), SCALE, full_chroma=True)
    assert [plane.shape for plane in planes] == [(96, 40), (48, 20), (48, 20)]
    np.testing.assert_allclose(to_difference(planes, 30, 40, SCALE, full_chroma=True), noise, atol=1.8 / 510)


def test_what_a_code_stands_for():
    """docs/format.md in numbers: BT.709, luma (code - 512) * scale[0], blue 1.8556 and red 1.5748 of chroma."""
    half = np.full((8, 8), 512, np.uint16)
    luma = np.full((16, 16), 512 + 51, np.uint16)
    np.testing.assert_allclose(to_difference((luma, half, half), 16, 16, SCALE), 0.1, atol=1e-6)
    grey = np.full((16, 16), 512, np.uint16)
    blue = to_difference((grey, half + np.uint16(51), half), 16, 16, SCALE)[8, 8]
    np.testing.assert_allclose(blue, 51 / 816 * np.array([0, -0.187324, 1.8556]), atol=1e-5)
    red = to_difference((grey, half, half + np.uint16(51)), 16, 16, SCALE)[8, 8]
    np.testing.assert_allclose(red, 51 / 816 * np.array([1.5748, -0.468124, 0]), atol=1e-5)


def test_doubling_is_catmull_and_roms():
    line = np.zeros((1, 9), np.float32)
    line[0, 4] = 128
    assert double_size(line)[0].tolist() == [0, 0, 0, 0, 0, -3, -9, 29, 111, 111, 29, -9, -3, 0, 0, 0, 0, 0]
