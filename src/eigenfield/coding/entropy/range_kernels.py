"""Adaptive binary arithmetic coding, and integers on top of it; one body codes and decodes.

Carry-less coder (as in Mahoney's lpaq, 2007): an interval [low, high] of 32-bit numbers is divided at every bit in
proportion to the probability of a one, and bytes on which both ends agree are shifted out. Behind the end of the bytes
a decoder reads zeros.

The probability of a one is a mixture of three predictions, each from a slot of its own that the caller's contexts
choose: with s = ln(p / (1 - p)),

    P = 1 / (1 + exp(-sum_i w_i s_i)),    w_i += RATE s_i (bit - P)    (logistic mixing)

and each slot moves towards the bit by 1 / (n + 1.5) of the way, n the number of bits it has seen, at most LIMIT. All of
it is in whole numbers: probabilities in 1/65536, s in 1/256, weights in 1/65536.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.jit import kernel

LOW, HIGH, CODE, AT = range(4)  # of Coder.state
INPUTS = 3  # predictions that are mixed
ONE = 65536
LIMIT = 126
NODES = 64  # slots of an integer in one context
ZERO, SIGN, LENGTH, UPPER, LOWER = 0, 1, 2, 24, 44  # first slots within them
LONGEST = 21  # binary digits of an integer's magnitude - 1, at most: |value| <= 2^21
START = 26214  # weight of a prediction at first: 0.4
SHIFT = 14  # of the mixer's rate

SQUASH = np.rint(ONE / (1 + np.exp(-np.arange(-2047, 2048) / 256))).astype(np.int32)
STRETCH = np.rint(
    256 * np.log((np.arange(4096) + 0.5) / (4095.5 - np.arange(4096)))  # of the middle of 16 steps of 1/65536
).astype(np.int16)
RATES = np.rint(ONE / (np.arange(LIMIT + 1) + 1.5)).astype(np.int32)


class Coder(NamedTuple):
    """State of a coder; arrays, because kernels change them.

    Attributes:
        data: (size,) uint8: what is read, or room for what is written; beyond it bytes are counted, not stored.
        state: (4,) int64: low, high, code (of a decoder) and the next byte.
        writing: (1,) bool.
        probability: (slots,) int64, of ones in 1/65536.
        seen: (slots,) int64, number of bits.
        weights: (mixtures, INPUTS) int64.
    """

    data: NDArray[np.uint8]
    state: NDArray[np.int64]
    writing: NDArray[np.bool_]
    probability: NDArray[np.int64]
    seen: NDArray[np.int64]
    weights: NDArray[np.int64]


def new_coder(data: NDArray[np.uint8], writing: bool, contexts: int, mixtures: int) -> Any:
    """A coder for integers in `contexts` contexts and `mixtures` mixtures of them, at the first byte of `data`."""
    coder = Coder(
        data,
        np.array([0, 2**32 - 1, 0, 0], np.int64),
        np.array([writing]),
        np.full(contexts * NODES, ONE // 2, np.int64),
        np.zeros(contexts * NODES, np.int64),
        np.full((mixtures * NODES, INPUTS), START, np.int64),
    )
    if not writing:
        begin(coder)
    return coder


@kernel()
def _next_byte(coder):
    at = coder.state[AT]
    coder.state[AT] = at + 1
    return np.int64(coder.data[at]) if at < coder.data.shape[0] else np.int64(0)


@kernel()
def _put_byte(coder, value):
    at = coder.state[AT]
    coder.state[AT] = at + 1
    if at < coder.data.shape[0]:
        coder.data[at] = value


@kernel()
def begin(coder):
    """Read the first four bytes."""
    for _ in range(4):
        coder.state[CODE] = coder.state[CODE] * 256 + _next_byte(coder)


@kernel()
def finish(coder):
    """Write as few bytes as identify the interval, zeros being read behind them."""
    low, high = coder.state[LOW], coder.state[HIGH]
    for count in range(5):
        unit = np.int64(1) << (32 - 8 * count)
        value = (low + unit - 1) // unit * unit
        if value <= high:
            for place in range(count):
                _put_byte(coder, (value >> (24 - 8 * place)) & 255)
            return


@kernel()
def code_split(coder, bit, one):
    """A bit whose probability of being 1 is one / 65536, 0 < one < 65536."""
    state = coder.state
    low, high = state[LOW], state[HIGH]
    middle = low + ((high - low) * one >> 16)
    if not coder.writing[0]:
        bit = np.int64(1) if state[CODE] <= middle else np.int64(0)
    if bit:
        high = middle
    else:
        low = middle + 1
    while (low ^ high) < (1 << 24):
        if coder.writing[0]:
            _put_byte(coder, high >> 24)
        else:
            state[CODE] = (state[CODE] & 0xFFFFFF) << 8 | _next_byte(coder)
        low = (low & 0xFFFFFF) << 8
        high = (high & 0xFFFFFF) << 8 | 255
    state[LOW], state[HIGH] = low, high
    return bit


@kernel()
def code_bit(coder, bit, a, b, c, mixture):
    """A bit predicted by slots a, b and c, mixed by row `mixture` of the weights."""
    p, n, w = coder.probability, coder.seen, coder.weights
    s0, s1, s2 = STRETCH[p[a] >> 4], STRETCH[p[b] >> 4], STRETCH[p[c] >> 4]
    s = (w[mixture, 0] * s0 + w[mixture, 1] * s1 + w[mixture, 2] * s2) >> 16
    one = np.int64(SQUASH[min(max(s, -2047), 2047) + 2047])
    bit = code_split(coder, bit, one)
    error = (ONE - one) if bit else -one
    w[mixture, 0] += (s0 * error) >> SHIFT
    w[mixture, 1] += (s1 * error) >> SHIFT
    w[mixture, 2] += (s2 * error) >> SHIFT
    target = (ONE - 1) if bit else 0
    for slot in (a, b, c):
        p[slot] += ((target - p[slot]) * RATES[n[slot]]) >> 16
        n[slot] = min(n[slot] + 1, LIMIT)
    return bit


@kernel()
def binary_digits(value):
    """How many binary digits a whole number has; none for 0."""
    count = 0
    while value > 0:
        value >>= 1
        count += 1
    return count


@kernel()
def code_raw(coder, value, digits):
    """A whole number of `digits` binary digits, each as likely 0 as 1; the highest first."""
    result = np.int64(0)
    for place in range(digits - 1, -1, -1):
        result = result * 2 + code_split(coder, (value >> place) & 1, ONE // 2)
    return result


@kernel()
def code_flag(coder, bit, a, b, c, mixture):
    """A bit in contexts a, b and c and mixture `mixture`."""
    return code_bit(coder, bit, a * NODES, b * NODES, c * NODES, mixture * NODES)


@kernel()
def _code_node(coder, bit, a, b, c, mixture, node):
    return code_bit(coder, bit, a * NODES + node, b * NODES + node, c * NODES + node, mixture * NODES + node)


@kernel()
def code_magnitude(coder, value, a, b, c, mixture):
    """A whole number from 0 to 2^LONGEST in contexts a, b and c: whether it is 0; how many binary digits value - 1 has,
    one after the other; these digits below the first, the upper two in slots of their own."""
    if not _code_node(coder, np.int64(value != 0), a, b, c, mixture, ZERO):
        return np.int64(0)
    rest = value - 1
    length = np.int64(0)
    while length < LONGEST and _code_node(coder, np.int64((rest >> length) != 0), a, b, c, mixture, LENGTH + length):
        length += 1
    if length < 2:
        return length + 1
    result = np.int64(1)
    for place in range(length - 2, -1, -1):
        bit = (rest >> place) & 1
        if place == length - 2:
            bit = _code_node(coder, bit, a, b, c, mixture, UPPER + length)
        elif place == length - 3:
            bit = _code_node(coder, bit, a, b, c, mixture, LOWER + 2 * min(length, np.int64(9)) + (result & 1))
        else:
            bit = code_split(coder, bit, ONE // 2)
        result = result * 2 + bit
    return result + 1


@kernel()
def code_integer(coder, value, a, b, c, mixture):
    """A whole number within ±2^LONGEST in contexts a, b and c: its magnitude, then its sign."""
    size = code_magnitude(coder, abs(value), a, b, c, mixture)
    if size == 0:
        return np.int64(0)
    negative = _code_node(coder, np.int64(value < 0), a, b, c, mixture, SIGN)
    return -size if negative else size
