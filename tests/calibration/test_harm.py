"""Photographs that harm: one of a series is changed in a known way, and only that one is named."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from eigenfield.calibration import harm
from eigenfield.calibration.harm import find_harmful, look_at
from eigenfield.capture import open_any
from eigenfield.cli.leave_out import leave_out
from eigenfield.core.errors import OptionError
from eigenfield.core.observations import Photograph
from eigenfield.imaging.png import png_bytes

NUMBER, CHANGED = 5, 3


def textured(seed: int) -> np.ndarray:
    """A wall of detail at all sizes, 0.1..0.7."""
    random = np.random.default_rng(seed)
    wall = sum(
        size * cv2.resize(random.normal(size=(260 // size, 440 // size, 3)), (440, 260), interpolation=cv2.INTER_CUBIC)
        for size in (2, 4, 8, 16)
    )
    return (0.4 + 0.3 * np.tanh(wall / wall.std())).astype(np.float32)


def finger(picture: np.ndarray) -> np.ndarray:
    """A soft dark disc over the top left corner."""
    row, column = np.mgrid[: picture.shape[0], : picture.shape[1]]
    hidden = 1 / (1 + np.exp((np.hypot(row, column) - 70) / 8))
    return picture * (1 - hidden[..., None]) + hidden[..., None] * (0.25, 0.1, 0.08)


def moved(picture: np.ndarray) -> np.ndarray:
    return cv2.filter2D(picture, -1, np.full((1, 9), 1 / 9, np.float32))


CHANGES = {
    "blurred": lambda picture: cv2.GaussianBlur(picture, (0, 0), 2),
    "blurred, altogether": lambda picture: cv2.GaussianBlur(picture, (0, 0), 30),
    "blurred, along its rows": moved,
    "exposure": lambda picture: picture * 2 ** (-2 / 2.2),
    "exposure, four stops": lambda picture: picture * 2 ** (-4 / 2.2),
    "covered": finger,
    "apart": lambda picture: textured(9)[:240, :320],
}


@pytest.fixture(scope="module")
def series(tmp_path_factory):
    """Photographs of a wall from the left to the right, as a capture, and their looks."""
    folder = tmp_path_factory.mktemp("series")
    wall = textured(1)
    pictures = [np.ascontiguousarray(wall[10:250, 12 * k : 12 * k + 320]) for k in range(NUMBER)]
    for number, picture in enumerate(pictures):
        (folder / f"IMG_{number}.png").write_bytes(png_bytes(picture))
    return open_any(folder), pictures, {k: look_at(Photograph.of(p, None)) for k, p in enumerate(pictures)}


def test_sound_photographs_are_not_named(series):
    capture, _, looks = series
    assert find_harmful(capture, looks) == []
    assert find_harmful(capture, {0: looks[0], 4: looks[4]}) == []  # too few to tell


@pytest.mark.parametrize(("kind", "place"), [*((kind, CHANGED) for kind in CHANGES), ("blurred", 0), ("exposure", 0)])
def test_a_changed_photograph_is_named_alone(series, kind, place):
    capture, pictures, looks = series
    changed = np.clip(CHANGES[kind](pictures[place]), 0, 1).astype(np.float32)
    (found,) = find_harmful(capture, {**looks, place: look_at(Photograph.of(changed, None))})
    assert (found.index, found.kind) == (place, kind.split(",")[0])
    words = {"exposure": "2.0 stops darker", "exposure, four stops": "4.0 stops darker", "covered": "at the top left"}
    assert words.get(kind, "") in found.reason


def test_where_many_are_exposed_otherwise_none_is_the_exception(series, caplog):
    capture, pictures, looks = series
    dark = {k: look_at(Photograph.of(CHANGES["exposure, four stops"](pictures[k]), None)) for k in (1, 3)}
    assert find_harmful(capture, {**looks, **dark}) == []
    (line,) = caplog.messages
    assert "5 photographs differ from their neighbours by more than 1.5 stops" in line and "--harmonise" in line


def test_what_a_mask_hides_does_not_count(series):
    capture, pictures, looks = series
    mask = np.zeros(pictures[0].shape[:2], np.float32)
    mask[:, 100:] = 1
    look = look_at(Photograph.of(pictures[2], mask))
    assert len(look.points) > 100 and look.points[:, 0].min() > 99
    assert find_harmful(capture, {**looks, 2: look}) == []


def test_photographs_are_left_out_as_advised_or_by_name(series, monkeypatch, capsys):
    capture, pictures, looks = series
    dark = look_at(Photograph.of(CHANGES["exposure"](pictures[CHANGED]), None))
    found = find_harmful(capture, {**looks, CHANGED: dark})
    monkeypatch.setattr(harm, "advise", lambda given: found if len(given) == NUMBER else [])
    assert leave_out(capture, None, False) is capture
    said = "IMG_3.png is 2.0 stops darker than its neighbours"
    asked = "--leave-out advised leaves out what `inspect` names"
    assert capsys.readouterr().err == f"a photograph may do harm: {said}; {asked}\n"
    kept = leave_out(capture, "advised", False)
    assert kept.names == tuple(name for name in capture.names if name != "IMG_3.png")
    assert capsys.readouterr().err == f"left out: {said}\n"
    assert leave_out(kept, "advised", False) is kept
    assert capsys.readouterr().err == "no photograph does harm: none is left out\n"
    assert len(leave_out(capture, "IMG_0, IMG_4.png", True)) == NUMBER - 2
    commas = replace(capture, shots=tuple(replace(shot, name=f"no, {shot.name}") for shot in capture.shots))
    assert leave_out(commas, "no, IMG_0, no, IMG_4.png", True).names == commas.names[1:4]
    for rule in ("IMG_9.png", "IMG_0,IMG_1,IMG_2"):
        with pytest.raises(OptionError) as caught:
            leave_out(capture, rule, True)
        assert caught.value.code == "leave-out" and caught.value.remedy


def test_advice_passes_over_what_cannot_be_decoded(series, tmp_path):
    for path in series[0].root.iterdir():
        whole = path.read_bytes()
        (tmp_path / path.name).write_bytes(whole[: len(whole) // 2] if path.stem == "IMG_1" else whole)
    assert harm.advise(open_any(tmp_path)) == []
