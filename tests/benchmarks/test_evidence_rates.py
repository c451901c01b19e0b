"""Bjøntegaard's deltas against answers that can be worked out by hand and against his own polynomials."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.imaging.metrics import PSNR_MAX_DECIBELS, psnr, psnr_luma, ssim
from evidence.rates import bd_quality, bd_rate, bytes_at, common_range, point

# kbit/s and dB of two coders, of the usual shape
ANCHOR = ((85.95, 31.42), (157.11, 34.24), (309.58, 37.18), (686.76, 40.28))
TEST = ((112.75, 31.24), (204.93, 34.17), (407.8, 37.21), (893.34, 40.39))


def curve(pairs, factor=1.0, shift=0.0, key="psnr"):
    return [{"bytes": size * factor, key: value + shift} for size, value in pairs]


def polynomial_rate(anchor, test):
    """VCEG-M33: a cubic through log rate against PSNR, integrated over the common range."""
    fits = [np.polyint(np.polyfit([q for _, q in c], [np.log(r) for r, _ in c], 3)) for c in (anchor, test)]
    low, high = max(c[0][1] for c in (anchor, test)), min(c[-1][1] for c in (anchor, test))
    one, other = (np.polyval(fit, high) - np.polyval(fit, low) for fit in fits)
    return 100 * (np.exp((other - one) / (high - low)) - 1)


def polynomial_quality(anchor, test):
    fits = [np.polyint(np.polyfit([np.log(r) for r, _ in c], [q for _, q in c], 3)) for c in (anchor, test)]
    low, high = (np.log(f(c[i][0] for c in (anchor, test))) for f, i in ((max, 0), (min, -1)))
    one, other = (np.polyval(fit, high) - np.polyval(fit, low) for fit in fits)
    return (other - one) / (high - low)


def test_a_curve_against_itself_is_nothing():
    assert bd_rate(curve(ANCHOR), curve(ANCHOR)) == pytest.approx(0, abs=1e-9)
    assert bd_quality(curve(ANCHOR), curve(ANCHOR)) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(("factor", "percent"), [(0.5, -50), (2, 100), (1.1, 10)])
def test_a_constant_factor_of_bytes_is_the_rate(factor, percent):
    assert bd_rate(curve(ANCHOR), curve(ANCHOR, factor)) == pytest.approx(percent)


def test_a_constant_gain_is_the_quality():
    assert bd_quality(curve(ANCHOR), curve(ANCHOR, shift=1.0)) == pytest.approx(1.0)
    assert bd_quality(curve(ANCHOR), curve(ANCHOR, shift=-0.25)) == pytest.approx(-0.25)


def test_a_pair_agrees_with_bjontegaard_s_polynomials():
    assert bd_rate(curve(ANCHOR), curve(TEST)) == pytest.approx(polynomial_rate(ANCHOR, TEST), abs=0.5)
    assert bd_quality(curve(ANCHOR), curve(TEST)) == pytest.approx(polynomial_quality(ANCHOR, TEST), abs=0.03)
    assert bd_rate(curve(ANCHOR), curve(TEST)) > 25  # the second is the worse one
    forth, back = bd_rate(curve(ANCHOR), curve(TEST)), bd_rate(curve(TEST), curve(ANCHOR))
    assert (1 + forth / 100) * (1 + back / 100) == pytest.approx(1)


def test_curves_that_hardly_meet_have_no_delta():
    assert bd_rate(curve(ANCHOR), curve(ANCHOR, shift=20)) is None
    assert bd_rate(curve(ANCHOR), curve(ANCHOR, shift=8.5)) is None  # 0.36 dB in common
    assert bd_rate(curve(ANCHOR), curve(ANCHOR, shift=8.2)) is not None  # 0.66 dB
    assert bd_quality(curve(ANCHOR), curve(ANCHOR, factor=7.5)) is None  # the bytes of a single point's width
    assert bd_quality(curve(ANCHOR), curve(ANCHOR, factor=6)) is not None
    assert bd_rate(curve(ANCHOR), curve(ANCHOR[:1])) is None
    assert common_range(curve(ANCHOR), curve(TEST)) == (31.42, 40.28)


def test_ssim_has_its_own_least_overlap():
    pairs = [(10, 0.90), (20, 0.93), (40, 0.95)]
    assert bd_rate(curve(pairs, key="ssim"), curve(pairs, 0.5, key="ssim"), "ssim") == pytest.approx(-50)
    assert bd_rate(curve(pairs, key="ssim"), curve(pairs, shift=0.047, key="ssim"), "ssim") is None


def test_neither_order_nor_a_point_that_is_beaten_changes_anything():
    expected = bd_rate(curve(ANCHOR), curve(TEST))
    beaten = [{"bytes": 700, "psnr": 36.0}, {"bytes": 900, "psnr": 40.39}, {"bytes": 500, "psnr": None}]
    assert bd_rate(curve(ANCHOR[::-1]), beaten + curve(TEST[::-1])) == pytest.approx(expected)


def test_bytes_between_points_run_in_their_logarithm():
    straight = curve([(100, 30.0), (200, 32.0), (400, 34.0)])
    assert bytes_at(straight, 32.0) == pytest.approx(200)
    assert bytes_at(straight, 31.0) == pytest.approx(100 * 2**0.5)
    assert bytes_at(straight, 34.0) == pytest.approx(400)
    assert bytes_at(straight, 29.99) is None and bytes_at(straight, 34.01) is None
    assert bytes_at([], 30) is None and bytes_at(straight[:1], 30.0) == pytest.approx(100)


def test_a_point_is_the_mean_over_views_with_the_worst_by_name():
    random = np.random.default_rng(0)
    photographs = [random.integers(40, 200, (height, 24, 3), dtype=np.uint8) for height in (20, 22, 20)]
    decoded = [p + np.uint8(offset) for p, offset in zip(photographs, (0, 10, 20), strict=True)]
    decoded[1][:11] = 0  # above the covered rows: the whole frame alone knows of it
    covered = [np.ones(p.shape[:2], bool) for p in photographs]
    covered[1][:11] = False
    figures = point(iter(decoded), photographs, covered, ["a", "b", "c"])
    at = [20 * np.log10(255 / offset) for offset in (10, 20)]
    assert figures["psnr"] == pytest.approx((PSNR_MAX_DECIBELS + sum(at)) / 3)
    assert figures["psnr_luma"] == pytest.approx((PSNR_MAX_DECIBELS + sum(at)) / 3, abs=1e-4)
    assert figures["worst"]["psnr"] == {"value": pytest.approx(at[1]), "camera": "c"}
    assert figures["worst"]["psnr_full"]["camera"] == "b"
    assert figures["coverage"] == pytest.approx((1 + 0.5 + 1) / 3)
    for key, measure in (("psnr_full", psnr), ("psnr_luma_full", psnr_luma), ("ssim_full", ssim)):
        pairs = zip(decoded, photographs, strict=True)
        assert figures[key] == pytest.approx(np.mean([measure(a, b) for a, b in pairs]))
    masked = zip(decoded, photographs, covered, strict=True)
    assert figures["ssim"] == pytest.approx(np.mean([ssim(*three) for three in masked]))


def test_views_that_do_not_pair_up_are_refused():
    picture = np.zeros((16, 16, 3), np.uint8)
    with pytest.raises(ValueError, match="zip"):
        point([picture], [picture, picture], [np.ones((16, 16), bool)] * 2, ["a", "b"])
