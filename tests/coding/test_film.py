"""Films: a temporal unit shows its frame and no other, what stands still is nearly free, and damage is refused."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.coding.pictures.av1_units import SEQUENCE_HEADER, TEMPORAL_DELIMITER, units
from eigenfield.coding.video.film import decode_film, encode_film
from eigenfield.core.errors import FormatError

SIZE = 64, 128


def numbered(count, size=SIZE):
    """Frames whose blocks are their numbers in binary, so that each is known from all others."""
    for number in range(count):
        frame = np.full(size, 300, np.uint16)
        for bit in range(6):
            frame[16:48, 16 * bit + 16 : 16 * bit + 32] = 900 if number >> bit & 1 else 100
        yield frame


def read(frame):
    return sum(1 << bit for bit in range(6) if frame[24:40, 16 * bit + 20 : 16 * bit + 28].mean() > 500)


def textured():
    rng = np.random.default_rng(1)
    return np.clip(500 + np.cumsum(rng.normal(0, 12, SIZE), 1), 0, 1023).astype(np.uint16)


@pytest.mark.parametrize("count", [1, 2, 37])
def test_a_unit_shows_its_own_frame_as_soon_as_it_is_there(count):
    made = encode_film(numbered(count), SIZE, 20, 8)
    taken = []

    def arriving():
        for number, unit in enumerate(made):
            taken.append(number)
            yield unit

    shown = [(read(frame), len(taken)) for frame in decode_film(arriving(), SIZE, "here")]
    assert shown == [(number, number + 1) for number in range(count)]


def test_the_first_unit_alone_has_a_sequence_header_and_none_has_a_delimiter():
    kinds = [[kind for kind, *_ in units(unit)] for unit in encode_film(numbered(20), SIZE, 20, 8)]
    assert [SEQUENCE_HEADER in some for some in kinds] == [True] + [False] * 19
    assert not any(TEMPORAL_DELIMITER in some for some in kinds)


def test_a_frame_that_is_repeated_costs_about_twenty_bytes():
    made = encode_film([textured()] * 60, SIZE, 30, 6)
    assert len(made) == 60 and sum(map(len, made[1:])) / 59 < 25
    frames = list(decode_film(made, SIZE, "here"))
    assert all(np.array_equal(frame, frames[0]) for frame in frames)
    assert np.abs(frames[0].astype(int) - textured()).mean() < 8


def test_the_last_frame_is_as_good_as_the_others():
    """Of a film of an even number of frames too, where what predicts it is no frame of its own."""
    rng = np.random.default_rng(2)
    moving = [np.clip(np.roll(textured(), 3 * number, 1) + rng.normal(0, 9, SIZE), 0, 1023) for number in range(12)]
    frames = [frame.astype(np.uint16) for frame in moving]
    shown = decode_film(encode_film(frames, SIZE, 40, 6), SIZE, "here")
    errors = [np.square(a.astype(float) - b).mean() for a, b in zip(frames, shown, strict=True)]
    assert errors[-1] < 1.1 * np.mean(errors[1:])


def test_a_film_has_the_same_bytes_each_time():
    assert encode_film(numbered(9), SIZE, 30, 8) == encode_film(numbered(9), SIZE, 30, 8)


def refused(made, size=SIZE):
    with pytest.raises(FormatError) as caught:
        list(decode_film(made, size, "here"))
    assert caught.value.where == "here"
    return caught.value.code


def test_films_that_are_not_what_was_said():
    made = encode_film(numbered(8), SIZE, 40, 8)
    assert refused(made, (64, 64)) == "film-size"
    assert refused(made, (128, 128)) == "film-size"
    assert refused(made[1:]) == "film-frames"  # begins without a key picture
    assert refused([made[0], made[0]]) == "film-frames"  # begins anew
    assert refused([made[0] + made[1], made[2]]) == "film-frames"  # two frames in a unit
    assert refused([made[0], b"", made[1]]) == "film-frames"  # none
    assert refused([made[0][:40]]) in ("film-damaged", "film-frames")
    assert refused([b""]) == "film-frames"


def test_a_unit_of_many_frames_is_refused_at_the_second():
    made = encode_film(numbered(4), SIZE, 40, 8)
    again = next(unit for unit in made if [kind for kind, *_ in units(unit)] == [3])  # shows a hidden frame
    assert refused([made[0], made[1] + again * 100_000]) == "film-frames"


def test_any_damage_is_refused_or_decodes():
    made = encode_film(numbered(6), SIZE, 40, 8)
    rng = np.random.default_rng(3)
    for _ in range(60):
        unit = int(rng.integers(6))
        data = bytearray(made[unit])
        for at in rng.integers(0, len(data), 2):
            data[at] ^= 1 << int(rng.integers(8))
        try:
            for frame in decode_film([*made[:unit], bytes(data), *made[unit + 1 :]], SIZE, "here"):
                assert frame.shape == SIZE and frame.max() < 1024
        except FormatError as error:
            assert error.code in ("film-damaged", "film-frames", "film-size")
