"""The adaptive code: what goes in comes out, near its entropy, and no bytes harm the decoder."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.coding.entropy import range_coder
from eigenfield.coding.entropy.range_kernels import (
    LIMIT,
    LONGEST,
    ONE,
    RATES,
    SQUASH,
    STRETCH,
    code_flag,
    code_integer,
    code_raw,
)
from eigenfield.core.errors import FormatError

LARGEST = 2**LONGEST


def encoded(values, contexts=4, room=4096):
    def run(coder):
        for k, value in enumerate(values):
            code_integer(coder, np.int64(value), k % contexts, contexts, contexts + 1, 0)

    return range_coder.coded_bytes(run, contexts + 2, 1, room=room)


def decoded(data, count, contexts=4):
    coder = range_coder.decoder(data, contexts + 2, 1)
    values = [int(code_integer(coder, np.int64(0), k % contexts, contexts, contexts + 1, 0)) for k in range(count)]
    return values, coder


@settings(max_examples=60)
@given(st.lists(st.one_of(st.integers(-3, 3), st.integers(-LARGEST, LARGEST)), max_size=200))
def test_integers_come_back(values):
    data = encoded(values)
    back, coder = decoded(data, len(values))
    assert back == values
    range_coder.check_end(coder, "test")


def test_extremes_come_back():
    values = [0, 1, -1, 2, LARGEST, -LARGEST, LARGEST - 1, 4, -5, 1000, -(2**20)]
    assert decoded(encoded(values), len(values))[0] == values


def test_raw_numbers_and_flags_come_back():
    def run(coder):
        code_raw(coder, np.int64(0xDEADBEEF), 32)
        code_flag(coder, np.int64(1), 0, 1, 2, 0)
        code_raw(coder, np.int64(5), 3)

    coder = range_coder.decoder(range_coder.coded_bytes(run, 3, 1, room=64), 3, 1)
    assert code_raw(coder, np.int64(0), 32) == 0xDEADBEEF
    assert code_flag(coder, np.int64(0), 0, 1, 2, 0) == 1
    assert code_raw(coder, np.int64(0), 3) == 5


def test_the_room_is_only_a_guess():
    values = list(range(-300, 300))
    assert encoded(values, room=1) == encoded(values)


def test_bytes_are_near_the_entropy():
    random = np.random.default_rng(1)
    values = np.rint(random.laplace(0, 3, 20000)).astype(int)
    _, counts = np.unique(values, return_counts=True)
    share = counts / len(values)
    entropy = -(share * np.log2(share)).sum() * len(values) / 8
    assert len(encoded(values.tolist(), contexts=1)) < 1.03 * entropy


def test_sure_bits_cost_next_to_nothing():
    assert len(encoded([0] * 8000, contexts=1)) < 30


def test_decoding_reads_zeros_behind_the_end_and_says_so():
    data = encoded(list(range(-200, 200)))
    back, coder = decoded(data[:50], 400)
    assert all(abs(value) <= LARGEST for value in back)
    with pytest.raises(FormatError, match="cut off") as caught:
        range_coder.check_end(coder, "weights")
    assert caught.value.code == "coded-truncated" and caught.value.where == "weights"


def test_four_bytes_behind_the_end_may_be_read():
    """What is coded in no byte at all is whole; one byte more is cut off."""
    assert range_coder.coded_bytes(lambda coder: None, 1, 1, room=8) == b""
    coder = range_coder.decoder(b"", 1, 1)
    range_coder.check_end(coder, "here")
    code_raw(coder, np.int64(0), 8)
    with pytest.raises(FormatError, match="cut off"):
        range_coder.check_end(coder, "here")


@settings(max_examples=40)
@given(st.binary(max_size=300))
def test_any_bytes_decode_to_numbers_in_range(data):
    back, _ = decoded(data, 100)
    assert all(abs(value) <= LARGEST for value in back)


def test_tables_are_those_of_their_formulas_wherever_they_are_computed():
    """Rounding must not depend on the last digit of an exponential or a logarithm."""
    for exact, table in (
        (ONE / (1 + np.exp(-np.arange(-2047, 2048) / 256)), SQUASH),
        (256 * np.log((np.arange(4096) + 0.5) / (4095.5 - np.arange(4096))), STRETCH),
    ):
        assert np.array_equal(np.rint(exact), table)
        assert (np.abs(exact - np.floor(exact) - 0.5) > 1e-9).all()
    assert (SQUASH > 0).all() and (SQUASH < ONE).all() and len(RATES) == LIMIT + 1


def test_headers_are_checked():
    with pytest.raises(FormatError) as caught:
        range_coder.check_header(b"\x01", 8, 1, "mesh")
    assert caught.value.code == "coded-truncated"
    with pytest.raises(FormatError) as caught:
        range_coder.check_header(b"\x07" * 8, 8, 1, "mesh")
    assert caught.value.code == "coded-version"
    with pytest.raises(FormatError) as caught:
        range_coder.check_numbers(bytes(10), 10**6, 2**28, "mesh")
    assert caught.value.code == "coded-size"
    long_enough = range_coder.pad_bytes(bytes(10), 10**6)
    range_coder.check_numbers(long_enough, 10**6, 2**28, "mesh")
    assert len(long_enough) < 10**6 / 15
