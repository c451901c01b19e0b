"""The tables of docs/benchmarks.md say what the results say: on two made-up captures, one of them with gaps."""

from __future__ import annotations

import pytest

import tables

IMAGE = {"psnr": 31.234, "ssim": 0.91234, "flip": 0.0812, "psnr_luma": 32.5, "psnr_full": 30.0, "coverage": 0.9951}


def rung(key, gain, share):
    return {"key": key, "gain": gain, "share": share, "psnr": 30.0}


@pytest.fixture
def captures():
    whole = {
        "title": "One", "views": 81, "hold_out": "odd", "textures": 15, "bytes": {"total": 1_500_000},
        "encoded": IMAGE, "held_out": {**IMAGE, "psnr": 29.0}, "encoded_beside_held_out": IMAGE,
        "losses": [
            {"key": "file", "psnr": 31.0}, rung("codec", 2.5, 0.4), rung("quantisation", 0.1, 0.02),
            rung("truncation", 1.5, 0.3), rung("resampling", -0.5, -0.05), {"key": "left", "share": 0.33, "psnr": 40.0},
        ],
        "bd": {
            tables.ANCHORS[0]: {"psnr": 120.4, "psnr_luma": None},
            tables.ANCHORS[1]: {"psnr": -12.0, "psnr_luma": 3},
        },
        "between": {"nearest": {"psnr": 12.0}, "blend": {"psnr": 13.0}, "lumigraph": {"psnr": 29.5},
                    "delaunay": {"psnr": 29.04}},
        "uv_curve": {"plain": {"0": 0.8, "7": 0.9, "15": 0.95}, "aligned": {"15": 0.96}},
        "table": {"rows": [
            {"label": "SSIM 0.98", "aligned": False, "not_reached": True, "most": 40},
            {"label": "SSIM 0.98", "aligned": True, "textures": 30},
            {"label": "N = 15", "aligned": False, "bytes": 10_000_000, "saving": 0.9, "file_bytes": 1_500_000,
             "file_saving": 0.985},
        ]},
    }  # fmt: skip
    return {"one": whole, "two": {"title": "Two", "views": None, "hold_out": "every:2"}}


def run_of(commit, **captures):
    machine = {"processor": "P", "cores": 2}
    return {"command": "c", "commits": [commit], "machine": machine, "date": "2026-11-01T00", "captures": captures}


def test_a_capture_is_shown_as_its_newest_run_measured_it(monkeypatch):
    history = [run_of("aaa", one=1, two=2), run_of("bbb", gone=0), run_of("ccc", two=3, gone=4)]
    monkeypatch.setattr(tables, "runs", lambda name: history)
    captures, source = tables.newest("there")
    assert captures == {"one": 1, "two": 3, "gone": 4}
    assert source == "[`c`](../benchmarks/results/there.json), commit aaa, ccc, P with 2 cores, 2026-11-01.\n"


def cells(text, row):
    return [cell.strip() for cell in text.splitlines()[2 + row].strip("|").split("|")]


def test_the_summary_rounds_and_keeps_gaps_out(captures):
    text = tables.summary(captures)
    assert cells(text, 0) == [
        "`one`", "81", "15", "1.50", "31.23 / 32.50", "0.912", "0.081", "29.00 / 32.50", "0.912", "99.5 %"
    ]  # fmt: skip
    assert len(text.splitlines()) == 3


def test_rates_have_signs_and_dashes(captures):
    assert cells(tables.beside_codecs(captures), 0) == ["`one`", "+120 % / –", "-12 % / +3 %", "– / –", "– / –"]


def test_the_ladder_has_gains_and_shares(captures):
    assert cells(tables.losses(captures), 0) == [
        "`one`", "31.00", "2.50 (40 %)", "0.10 (2 %)", "1.50 (30 %)", "-0.50 (-5 %)", "33 %"
    ]  # fmt: skip


def test_the_largest_losses_come_first(captures):
    lines = tables.largest(captures).splitlines()
    assert [line.split("**")[1].split(" (")[0] for line in lines] == [
        "the codec of the textures", "from encoded to held-out cameras", "truncation to N textures",
        "resampling into the atlas and out of it",
    ]  # fmt: skip
    assert lines[0].startswith("1. ") and "2.5 dB" in lines[0] and "2.2 dB" in lines[1]


def test_the_papers_table_says_what_was_not_reached(captures):
    assert cells(tables.paper(captures), 1) == [
        "`one`", "15", "0.950 / 0.960", "> 40", "30", "10.0 MB, 90.0 %", "1.50 MB, 98.5 %"
    ]  # fmt: skip


def test_held_out_ways_stand_beside_each_other(captures):
    assert cells(tables.between(captures), 0) == ["`one`", "odd", "12.00", "13.00", "29.50", "29.04"]


def test_the_cost_of_estimated_geometry_is_shown_where_the_truth_is_known(captures):
    assert tables.truth(captures) == ""
    captures["demo"] = {"truth": {"encoded": {"cost": 1.537}, "held_out": {"cost": 1.574}}}
    assert "encoded views lose 1.54 dB and held-out views 1.57 dB" in tables.truth(captures)
