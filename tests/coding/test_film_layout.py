"""Places of textures in films: apart from each other, on their grid, in as small a film as a known best; and back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.coding.video.film_layout import (
    EMPTY_CODE,
    PlaneSizes,
    film_layout,
    film_parts,
    join_parts,
    pictures_of,
)
from eigenfield.core.errors import OptionError

SIDES = st.tuples(st.integers(1, 300), st.integers(1, 300))
PLANES = st.lists(
    st.builds(
        PlaneSizes, st.integers(1, 3), SIDES, st.lists(st.tuples(SIDES, st.integers(1, 5)), max_size=2).map(tuple)
    ),
    min_size=1,
    max_size=3,
)


@given(PLANES, st.none() | SIDES)
@settings(max_examples=60)
def test_what_goes_into_a_film_comes_out_of_it(planes, opacity):
    layout = film_layout(planes, opacity)
    assert [plane.channels for plane in layout.planes] == [plane.channels for plane in planes]
    rng = np.random.default_rng(1)
    for film, size in enumerate(layout.sizes):
        assert size[0] % 64 == size[1] % 64 == 0
        parts = film_parts(layout, film)
        assert all(row % 16 == column % 16 == 0 for part in parts for row, column in part.at)
        codes = [rng.integers(0, 1024, (len(part.at), *part.size)).astype(np.uint16) for part in parts]
        frame = join_parts(layout, film, codes)
        assert frame.shape == size
        for part, own in zip(parts, codes, strict=True):
            assert np.array_equal(pictures_of(part, frame), own)
    counts = [[len(part.at) for part in plane.bases] for plane in layout.planes]
    assert counts == [[plane.channels * count for _, count in plane.bases] for plane in planes]


@pytest.mark.parametrize("textures", [0, 3])
def test_an_opacity_has_the_last_film_to_itself(textures):
    bases = (((384, 384), textures),) if textures else ()
    layout = film_layout([PlaneSizes(1, (704, 704), bases)], (300, 700))
    last = len(layout.sizes) - 1
    assert layout.sizes[last] == (320, 704) and last == (2 if textures else 1)
    assert film_parts(layout, last) == [layout.opacity]
    assert layout.opacity.at == ((0, 0),) and layout.opacity.size == (300, 700) and layout.opacity.film == last
    assert film_layout([PlaneSizes(1, (704, 704), bases)]).opacity is None


def test_halves_stand_below_each_other():
    """Luma, and two planes of chroma of half its sides, need a half more columns and no more rows."""
    planes = [PlaneSizes(1, (704, 704), (((384, 384), 6),)), PlaneSizes(2, (352, 352), (((208, 208), 2),))]
    layout = film_layout(planes)
    assert layout.sizes[0] == (704, 1088) and layout.planes[1].mean.at == ((0, 704), (352, 704))
    assert layout.sizes[1][0] * layout.sizes[1][1] <= 1152 * 1024
    assert layout.planes[0].bases[0].film == 1


def test_a_film_is_rather_wide_than_high_and_of_a_size_that_hardware_decodes():
    rows, columns = film_layout([PlaneSizes(1, (512, 512), (((512, 512), 8),))]).sizes[1]
    assert (rows, columns) == (1024, 2048)


def test_padding_repeats_the_edge_and_the_rest_is_empty():
    layout = film_layout([PlaneSizes(1, (20, 100), ())])
    assert layout.sizes == ((64, 128),)
    frame = join_parts(layout, 0, [np.full((1, 20, 100), 77, np.uint16)])
    assert (frame[:32, :112] == 77).all() and (frame[32:] == EMPTY_CODE).all() and (frame[:, 112:] == EMPTY_CODE).all()


def test_a_film_that_no_reader_takes_is_refused():
    with pytest.raises(OptionError, match="larger than readers take") as caught:
        film_layout([PlaneSizes(1, (4000, 4000), (((4000, 4000), 2),))])
    assert caught.value.code == "film-size"
