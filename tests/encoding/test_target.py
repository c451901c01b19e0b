"""Searching for the quality at which a file reaches a target."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from eigenfield.core.errors import OptionError
from eigenfield.encoding.target import (
    TARGET_MAX_ATTEMPTS,
    TARGET_MAX_QUALITY,
    TARGET_MIN_QUALITY,
    Attempt,
    Target,
    search_quality,
)


def curve(bend: float):
    """A rate-distortion curve: bytes and dB at a quality, and the qualities that were coded."""
    coded = []

    def code(quality: int) -> Attempt[int]:
        coded.append(quality)
        size = int(20_000 * math.exp(quality / 20 + bend * (quality / 50) ** 2))
        return Attempt(quality, size, 10 + 0.25 * quality - bend * (quality / 50) ** 2, quality)

    return code, coded


@given(st.floats(0, 0.8), st.integers(TARGET_MIN_QUALITY + 1, TARGET_MAX_QUALITY - 1))
def test_the_largest_file_within_a_size_and_the_smallest_that_reaches_a_psnr(bend, at):
    code, coded = curve(bend)
    there = code(at)
    for target in (Target(size=there.size), Target(psnr=there.measured)):
        coded.clear()
        found = search_quality(target, code)
        assert target.is_met(found) and len(coded) <= TARGET_MAX_ATTEMPTS
        assert found.size >= 0.9 * there.size if target.size else found.quality <= at + 1


@pytest.mark.parametrize(
    ("target", "quality"), [(Target(size=1001), TARGET_MIN_QUALITY), (Target(psnr=90), TARGET_MAX_QUALITY)]
)
def test_what_cannot_be_reached_gives_the_nearest(target, quality):
    code, coded = curve(0.3)
    found = search_quality(target, code)
    assert not target.is_met(found) and found.quality == quality and len(coded) <= TARGET_MAX_ATTEMPTS


@pytest.mark.parametrize(
    "target", [Target(), Target(size=5, psnr=3), Target(size=10), Target(ssim=1.5), Target(psnr=-1), Target(bitrate=5)]
)
def test_targets_that_cannot_be(target):
    with pytest.raises(OptionError) as caught:
        target.check()
    assert caught.value.code == "target"


@pytest.mark.parametrize(
    ("target", "worst_first"),
    [
        (Target(size=1000), [(1300, 39.0), (1200, 30.0), (900, 31.0), (1000, 32.0)]),
        (Target(psnr=30), [(700, 28.0), (900, 29.5), (1400, 31.0), (1300, 30.0)]),
        (Target(ssim=0.9), [(700, 0.7), (900, 0.89), (1400, 0.91), (1300, 0.9)]),
    ],
)
def test_the_merit_of_a_file(target, worst_first):
    tried = [Attempt(50, size, measured, None) for size, measured in worst_first]
    merits = [target.merit(one) for one in tried]
    assert merits == sorted(merits) and len(set(merits)) == len(merits)
