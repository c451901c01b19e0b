"""A word for what a scene or a capture is worth, and the remedy."""

from __future__ import annotations

import pytest

from eigenfield.encoding.verdict import score_words, verdict_beforehand, verdict_of_scores

CAPTURED = {"encoded": {"cameras": 9, "psnr": 35.14}}


@pytest.mark.parametrize(
    ("between", "word"), [(30.0, "good"), (29.99, "fair"), (25.0, "fair"), (24.99, "poor"), (10.2, "poor")]
)
def test_each_way_to_measure_gives_the_same_word(between: float, word: str) -> None:
    for scores in (
        {"image": {**CAPTURED, "held_out": {"psnr": between}}},
        {"image": CAPTURED, "between": {"psnr_luma_at_least": between, "widest": ["a", "b"]}},
        {"image": CAPTURED, "between": {"cameras": 12, "psnr": between}},
    ):
        found = verdict_of_scores(scores)
        assert found is not None and found.word == word and str(found).startswith(f"{word}: ")
        assert bool(found.remedy) == (word != "good")


def test_the_remedy_names_the_widest_gap() -> None:
    found = verdict_of_scores({"between": {"psnr_luma_at_least": 22.5, "widest": ["a.jpg", "b.jpg"]}})
    assert found is not None and "take more photographs between a.jpg and b.jpg, nearer" in str(found)


def test_without_scores_there_is_no_word() -> None:
    assert verdict_of_scores({}) is None and verdict_of_scores({"image": CAPTURED}) is None


@pytest.mark.parametrize(
    ("parallax", "overlap", "word"),
    [(0.015, 0.9, "good"), (0.016, 0.9, "fair"), (0.073, 0.6, "fair"), (0.074, 0.9, "poor"), (0.01, 0.59, "poor")],
)
def test_photographs_promise_by_parallax_and_overlap(parallax: float, overlap: float, word: str) -> None:
    found = verdict_beforehand(parallax, overlap, "go nearer")
    assert found.word == word and found.remedy == ("" if word == "good" else "go nearer")


def test_words() -> None:
    low = {"image": CAPTURED, "between": {"psnr_luma_at_least": 25.96, "widest": ["a", "b"]}}
    assert score_words(low) == ["35.1 dB in captured views", "at least about 26 dB of luma between them"]
    held = {"image": {**CAPTURED, "held_out": {"psnr": 27.38}}}
    assert score_words(held) == ["35.1 dB in captured views", "27.4 dB between them (held out)"]
    dense = {"image": CAPTURED, "between": {"cameras": 12, "psnr": 34.2}}
    assert score_words(dense) == ["35.1 dB in captured views", "about 34 dB between them"]
    assert score_words({}) == []


def test_photographs_that_show_nothing_are_passed_over() -> None:
    unseen = {"cameras": 0, "psnr": None}
    scores = {"image": {"encoded": unseen, "held_out": unseen}}
    assert score_words(scores) == [] and verdict_of_scores(scores) is None
    scores["between"] = {"psnr_luma_at_least": 26.2}
    assert score_words(scores) == ["at least about 26 dB of luma between them"]
    found = verdict_of_scores(scores)
    assert found is not None and found.word == "fair"
