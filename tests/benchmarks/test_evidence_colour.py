"""The peers' colour conversion: BT.709's own numbers, greys, odd sizes, and what swscale does instead."""

from __future__ import annotations

import av
import cv2
import numpy as np
import pytest

from eigenfield.imaging.metrics import PSNR_MAX_DECIBELS, psnr
from evidence.colour import ceiling, even, pad, to_planes, to_rgb


def smooth(height, width):
    """A picture without edges, in all colours."""
    y, x = np.mgrid[0:height, 0:width]
    waves = [np.sin(x / 23 + k) * np.cos(y / 19 - k) for k in (0, 1, 2)]
    return np.rint(128 + 100 * np.stack(waves, axis=-1)).astype(np.uint8)


def saturated_edges(size=64):
    """Squares of red, green and blue, none of them along the pairs of pixels that 4:2:0 joins."""
    picture = np.zeros((size, size, 3), np.uint8)
    for number, (y, x) in enumerate(np.ndindex(7, 7)):
        picture[y * 9 + 1 : y * 9 + 10, x * 9 + 1 : x * 9 + 10, number % 3] = 220
    return picture


@pytest.mark.parametrize(
    ("colour", "codes"),
    [  # H.273 by hand: Y' = 1023 luma, Cb = 512 + 1023 (B - Y') / 1.8556, Cr = 512 + 1023 (R - Y') / 1.5748
        ((0, 0, 0), (0, 512, 512)),
        ((255, 255, 255), (1023, 512, 512)),
        ((255, 0, 0), (217, 395, 1023)),
        ((0, 255, 0), (732, 118, 47)),
        ((0, 0, 255), (74, 1023, 465)),
        ((51, 102, 204), (395, 740, 391)),
    ],
)
@pytest.mark.parametrize("chroma", ["420", "444"])
def test_flat_colours_have_the_codes_of_the_standard(colour, codes, chroma):
    picture = np.full((6, 8, 3), colour, np.uint8)
    planes = to_planes(picture, chroma)
    assert all((plane == code).all() for plane, code in zip(planes, codes, strict=True))
    assert [plane.shape for plane in planes] == [(6, 8), *[(3, 4) if chroma == "420" else (6, 8)] * 2]
    assert abs(to_rgb(planes, 6, 8).astype(int) - picture).max() <= 1


@pytest.mark.parametrize("chroma", ["420", "444"])
def test_greys_come_back_exactly(chroma):
    picture = np.repeat(np.arange(256, dtype=np.uint8).reshape(16, 16, 1), 3, axis=2)
    assert np.array_equal(ceiling(picture, chroma), picture)


def test_444_comes_back_within_one_level():
    picture = np.random.default_rng(0).integers(0, 256, (256, 256, 3), dtype=np.uint8)
    assert abs(ceiling(picture, "444").astype(int) - picture).max() <= 1


@pytest.mark.parametrize("chroma", ["420", "444"])
@pytest.mark.parametrize(("height", "width"), [(1, 1), (7, 10), (10, 7), (35, 33)])
def test_odd_sizes_are_padded_by_their_edge_and_cut_again(chroma, height, width):
    picture = smooth(height, width)
    back = ceiling(picture, chroma)
    assert back.shape == picture.shape and psnr(back, picture) > 40
    padded = pad(picture, *even(height, width))
    for own, whole in zip(to_planes(picture, "420"), to_planes(padded, "420"), strict=True):
        assert np.array_equal(own, whole)
    assert np.array_equal(padded[-1, :width], picture[-1]) and np.array_equal(padded[:height, -1], picture[:, -1])


def test_smooth_pictures_lose_next_to_nothing_in_420():
    picture = smooth(96, 120)
    assert 50 < psnr(ceiling(picture, "420"), picture) < PSNR_MAX_DECIBELS


def test_halving_and_doubling_do_not_shift_chroma():
    """A picture seen in a mirror gives the mirrored result, which a filter that is sited on one side does not."""
    picture = saturated_edges()
    straight = ceiling(picture, "420")
    for axis in (0, 1):
        assert abs(np.flip(ceiling(np.flip(picture, axis), "420"), axis).astype(int) - straight).max() <= 1


def test_chroma_of_a_ramp_lies_where_its_pixels_do():
    """Cr rises by 4 codes a pixel: a half sample is the mean of its two, and the way back puts it in their middle."""
    luma = np.full((4, 64), 512, np.uint16)
    ramp = (400 + 4 * np.arange(64)).astype(np.uint16)
    half = np.tile((ramp[0::2] + ramp[1::2]) // 2, (2, 1))
    grey = np.full((2, 32), 512, np.uint16)
    full = np.full((4, 64), 512, np.uint16)
    doubled = to_rgb((luma, grey, half), 4, 64)
    exact = to_rgb((luma, full, np.tile(ramp, (4, 1))), 4, 64)
    assert abs(doubled.astype(int) - exact)[:, 4:-4].max() <= 1


def test_swscale_loses_decibels_that_are_not_the_sampling_s():
    picture = cv2.GaussianBlur(saturated_edges(), (0, 0), 1.0)
    y, u, v = to_planes(picture, "420")
    frame = av.VideoFrame(64, 64, "yuv420p10le")
    for target, plane in zip(frame.planes, (y, u, v), strict=True):
        np.frombuffer(target, np.uint16).reshape(target.height, -1)[:, : target.width] = plane
    frame.color_range, frame.colorspace = 2, 1
    by_swscale = frame.reformat(format="rgb24", src_colorspace="ITU709", src_color_range="JPEG").to_ndarray()
    assert psnr(ceiling(picture, "420"), picture) > psnr(by_swscale, picture) + 1.0
