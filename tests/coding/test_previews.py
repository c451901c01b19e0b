"""The small JPEG for other viewers: every reader takes it, though it has no JFIF header and one table."""

from __future__ import annotations

import io

import cv2
import numpy as np
import pytest
from PIL import Image

from eigenfield.coding.pictures.pictures_8bit import encode_preview, encode_small_preview
from support.scenes import smooth_pictures


@pytest.fixture(scope="module")
def codes():
    return np.rint(255 * smooth_pictures(1, 120, 90, 3)[0].clip(0, 1)).astype(np.uint8)


def test_its_colours_are_those_of_the_picture(codes):
    data = encode_small_preview(codes, 64, 60)
    assert data[:4] == b"\xff\xd8\xff\xdb" and len(data) < len(encode_preview(codes))
    small = Image.fromarray(codes).resize((48, 64), Image.Resampling.LANCZOS)
    for decoded in (
        np.asarray(Image.open(io.BytesIO(data))),
        cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)[..., ::-1],
    ):
        assert decoded.shape == (64, 48, 3)
        assert np.abs(decoded.astype(int) - np.asarray(small)).mean() < 6


def test_a_grey_picture_stays_grey(codes):
    image = Image.open(io.BytesIO(encode_small_preview(codes[..., 0], 64, 60)))
    assert image.mode == "L" and image.size == (48, 64)
