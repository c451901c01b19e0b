"""benchmarks/rate.py: our curve and a codec's on the same photographs, and what is said of them."""

from __future__ import annotations

import dataclasses

import cv2
import numpy as np
import pytest

import rate
import tables
from eigenfield.encoding import EncodeOptions
from evidence import codecs, pictures, prepared
from evidence.captures import Capture
from support.captures import write_capture


def test_what_a_peer_needs_at_equal_quality():
    def points(scale):
        return [
            {"psnr": 28.0 + i, "psnr_luma": 29.0 + i, "ssim": 0.9 + 0.01 * i, "bytes": scale * 100_000 * 2**i}
            for i in range(5)
        ]

    ours, theirs = {"name": "eigenfield", "points": points(1)}, {"name": "film", "points": points(2)}
    said = rate.table({"curves": [ours, theirs], "bd": {"film": {"psnr": -50.0, "psnr_luma": None}}}).splitlines()
    assert said[0] == "psnr 28.00:   100.0 kB, film 200.0 kB (-50 %)"
    assert said[-1] == "BD-rate against film: psnr -50.0 %"
    anchor = {"points": points(2)}
    assert tables._saved(ours["points"][2], anchor, "psnr") == "-50 %"
    assert tables._saved({"psnr": 20.0}, anchor, "psnr") == "–"
    assert tables._saved(ours["points"][2], None, "psnr") == "–"


@pytest.mark.slow
def test_a_small_capture_from_end_to_end(tmp_path, monkeypatch):
    folder = write_capture(tmp_path / "nine")
    fast = dataclasses.replace(
        codecs.VIDEO[0], options=tuple((k, "10" if k == "preset" else v) for k, v in codecs.VIDEO[0].options)
    )
    monkeypatch.setattr(rate, "FITS", ((EncodeOptions(), (90,)), (EncodeOptions(preset="small", quality=50), (50,))))
    monkeypatch.setattr(rate, "BEST", ((EncodeOptions(preset="best"), (70,)),))
    monkeypatch.setattr(rate, "CRF", (30, 50, 60))
    found = rate.of_capture(
        Capture("nine", "Nine", folder, proxy=folder / "proxy.ply"), tmp_path / "work", [fast], True
    )
    mine, film = found["curves"]
    assert [(point["parameter"], point["preset"]) for point in mine["points"]] == [(50, "small"), (90, "balanced")]
    assert mine["points"][0]["bytes"] < mine["points"][1]["bytes"]
    assert mine["points"][0]["psnr"] < mine["points"][1]["psnr"]
    assert mine["points"][1]["bytes"] == (tmp_path / "work" / "quality-90.glb").stat().st_size
    assert set(film["orders"]) == {"rows", "serpentine", "spiral"}
    chosen = film["orders"][film["order"]]
    for size, _, luma in film["orders"].values():  # none is better in both
        assert not (size < chosen[0] and luma > chosen[2])
    assert found["ceiling_420"]["psnr"] > 35 and found["views"] == 9
    sheet = cv2.imread(str(tmp_path / "work" / "crops.png"))
    side = min(96, 56) * 4  # of a crop, twice enlarged twice; three of them under a line of words, three columns
    assert sheet.shape[0] == 20 + 3 * side and sheet.std() > 10
    assert set(found["bd"][film["name"]]) == {"psnr", "psnr_luma", "ssim"}
    short = rate.worth_keeping(found)
    for long, kept in zip([*found["curves"], found["best"]], [*short["curves"], short["best"]], strict=True):
        assert "worst" in long["points"][0] and not {"worst", "file", "shown"} & set(kept["points"][0])
        assert [point["bytes"] for point in kept["points"]] == [point["bytes"] for point in long["points"]]
    monkeypatch.setattr(tables, "newest", lambda name: ({"nine": found}, ""))
    monkeypatch.setattr(tables, "SHOWN", (70, 90))
    text = tables.fitted()
    assert [point["preset"] for point in found["best"]["points"]] == ["best"]
    assert (tmp_path / "work" / "best-70.glb").exists() and "| `nine`, `best` | 70 |" in text
    assert "| `nine` | 90 |" in text


def test_the_view_that_is_shown_is_of_the_film_in_the_chosen_order(tmp_path, monkeypatch):
    folder = write_capture(tmp_path / "nine")
    capture, work = Capture("nine", "Nine", folder, proxy=folder / "proxy.ply"), tmp_path / "work"
    prepared.estimate(capture, work)
    ready = prepared.prepare(capture, work)
    views = range(len(ready.light_field))
    photographs = [prepared.codes(ready.light_field, index) for index in views]
    covered = [np.ones(one.shape[:2], np.bool_) for one in photographs]
    backwards = [*views][::-1]  # tried last
    monkeypatch.setattr(codecs, "orders", lambda _: {"given": [*views], "backwards": backwards})
    monkeypatch.setattr(codecs, "DOUBLING", 0.0)
    monkeypatch.setattr(rate, "CRF", (20, 30, 40))
    measured = codecs.measure_video

    def worse_backwards(codec, crf, film, names, counted, place):
        found = measured(codec, crf, film, names, counted, place)
        return {**found, "psnr_luma": found["psnr_luma"] - 50 * (names[0] != ready.light_field.names[0])}

    monkeypatch.setattr(codecs, "measure_video", worse_backwards)
    found = rate.peer_curve(codecs.VIDEO[1], ready, photographs, covered)
    assert found["order"] == "given" and len(found["points"]) == 3
    for point in found["points"]:
        shown = pictures.read(work / point["shown"])
        errors = [float(np.square(shown.astype(float) - one).mean()) for one in photographs]
        assert int(np.argmin(errors)) == rate.shown_view(ready)


def test_crops_are_taken_where_the_surface_covers():
    photograph = np.zeros((300, 300, 3), np.uint8)
    drawing = photograph.copy()
    drawing[:120, :120] = 255  # most of the error, but nothing is drawn there
    drawing[200:260, 200:260] = 90
    covered = np.ones((300, 300), np.bool_)
    covered[:120, :120] = False
    anywhere, there = (pictures.busiest([photograph], [drawing], 1, which)[0] for which in (None, covered))
    assert max(anywhere) < 120
    assert min(there) > 260 - pictures.CROP - 1
