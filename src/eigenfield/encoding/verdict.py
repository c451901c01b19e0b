"""What the scores of a scene mean, in a word, and what photographs promise beforehand (docs/measures.md)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

GOOD_MIN_DB, FAIR_MIN_DB = 30.0, 25.0  # between the photographs, chosen on the captures of docs/measures.md
GOOD_MAX_PARALLAX_RATIO, FAIR_MAX_PARALLAX_RATIO = 0.015, 0.073  # of the longer side, between neighbours; likewise
MIN_OVERLAP = 0.6  # of a photograph that its neighbour shows, too
MEANINGS = {
    "good": "views between the photographs come near to photographs",
    "fair": "views between the photographs are softer, and edges of near things may be wrong",
    "poor": "views between the photographs show errors",
}


@dataclass(frozen=True)
class Verdict:
    """A word, and what follows from it.

    Attributes:
        word: One of `MEANINGS`.
        remedy: What to do; empty where the word is good.
    """

    word: str
    remedy: str = ""

    def __str__(self) -> str:
        return f"{self.word}: {MEANINGS[self.word]}" + (f"; {self.remedy}" if self.remedy else "")


def verdict_of_scores(scores: Mapping[str, Any]) -> Verdict | None:
    """By the PSNR of held-out views, else by what was estimated between the photographs; None if neither is known."""
    found = _between(scores)
    if found is None:
        return None
    word = "good" if found >= GOOD_MIN_DB else "fair" if found >= FAIR_MIN_DB else "poor"
    widest = scores.get("between", {}).get("widest")
    where = f"between {' and '.join(widest)}, nearer to each other where thin parts are" if widest else "between these"
    return Verdict(word, "" if word == "good" else f"take more photographs {where}")


def verdict_beforehand(parallax_ratio: float, overlap: float, remedy: str) -> Verdict:
    """What photographs promise.

    Args:
        parallax_ratio: Median over pairs of neighbours, of the longer side.
        overlap: The least of a pair, 0 to 1.
        remedy: For photographs that are too far apart.
    """
    if parallax_ratio <= GOOD_MAX_PARALLAX_RATIO and overlap >= MIN_OVERLAP:
        return Verdict("good")
    fair = parallax_ratio <= FAIR_MAX_PARALLAX_RATIO and overlap >= MIN_OVERLAP
    return Verdict("fair" if fair else "poor", remedy)


def score_words(scores: Mapping[str, Any]) -> list[str]:
    """The scores of `measure_scene` as parts of a line for people."""
    encoded, held_out, between = _psnr(scores, "encoded"), _psnr(scores, "held_out"), scores.get("between", {})
    words = [] if encoded is None else [f"{encoded:.1f} dB in captured views"]
    if held_out is not None:
        words.append(f"{held_out:.1f} dB between them (held out)")
    elif "psnr_luma_at_least" in between:
        words.append(f"at least about {between['psnr_luma_at_least']:.0f} dB of luma between them")
    elif between.get("psnr") is not None:
        words.append(f"about {between['psnr']:.0f} dB between them")
    return words


def _between(scores: Mapping[str, Any]) -> float | None:
    held_out, between = _psnr(scores, "held_out"), scores.get("between", {})
    figure = between.get("psnr_luma_at_least", between.get("psnr")) if held_out is None else held_out
    return None if figure is None else float(figure)


def _psnr(scores: Mapping[str, Any], kind: str) -> float | None:
    """Of the pictures of a kind; None where there are none, or none of them shows any of the scene."""
    found: float | None = (scores.get("image", {}).get(kind) or {}).get("psnr")
    return found
