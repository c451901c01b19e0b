"""benchmarks/fit_studies.py: every lever does something, nothing stays changed, and the tables say what was found."""

from __future__ import annotations

import pytest

import fit_studies
import rate_tables
from eigenfield.encoding import options, plan
from eigenfield.encoding.fitted import fit, planes, rate
from evidence import prepared
from evidence.captures import Capture
from support.captures import write_capture


@pytest.fixture(scope="module")
def ready(tmp_path_factory):
    folder = write_capture(tmp_path_factory.mktemp("studies") / "nine")
    capture, work = Capture("nine", "Nine", folder, proxy=folder / "proxy.ply"), folder.parent / "work"
    prepared.estimate(capture, work)
    return prepared.prepare(capture, work)


def test_levers_are_put_back():
    before = (
        options.PRESETS.copy(),
        planes.PLANE_PRESETS.copy(),
        fit.find_regions,
        fit.fit_weights,
        (rate.LAGRANGE, rate.OTHER_STEPS),
        plan.slim_mesh,
        planes.mean_precision,
        fit.fill_unseen,
        plan.fit_surface,
    )
    for lever in fit_studies.LEVERS.values():
        with lever.change(), lever.coding():
            pass
    after = (
        options.PRESETS, planes.PLANE_PRESETS, fit.find_regions, fit.fit_weights, (rate.LAGRANGE, rate.OTHER_STEPS),
        plan.slim_mesh, planes.mean_precision, fit.fill_unseen, plan.fit_surface,
    )  # fmt: skip
    assert before == after


def test_each_lever_changes_the_files_or_the_pictures(ready, monkeypatch):
    monkeypatch.setattr(fit_studies, "QUALITIES", (70, 90))
    # four cameras have no region, one round of textures at most, and a square for a proxy
    chosen = ["all", "rounds", "loop", "planes", "dense", "coarse", "bilinear"]
    found = fit_studies.of_levers(ready, chosen)
    assert list(found) == chosen
    monkeypatch.setattr(fit_studies, "open_fitted", None)  # all of it is there now
    assert fit_studies.of_levers(ready, chosen) == found
    base = found["all"]
    assert base["rate"]["psnr"] == pytest.approx(0, abs=1e-9) and base["uncoded"]["luma"] > 35
    for name in chosen[1:]:
        pairs = zip(base["points"], found[name]["points"], strict=True)
        assert any(abs(a["psnr"] - b["psnr"]) > 0.02 or a["bytes"] != b["bytes"] for a, b in pairs), name
    assert found["rounds"]["uncoded"]["luma"] < base["uncoded"]["luma"]
    assert found["bilinear"]["points"][1]["psnr"] < base["points"][1]["psnr"]


def test_held_out_views_against_bytes(ready, monkeypatch, tmp_path):
    monkeypatch.setattr(fit_studies, "QUALITIES", (60, 90))
    found = fit_studies.held_out(ready)
    coarse, fine = found["points"]
    assert coarse["bytes"] < fine["bytes"] and coarse["encoded"]["psnr"] < fine["encoded"]["psnr"]
    assert found["rule"] == "odd" and fine["held_out"]["psnr"] > 25
    lever = {
        "words": "all on",
        "uncoded": {"luma": 40.0},
        "rate": dict.fromkeys(("psnr", "psnr_luma")),
        "gain": {"psnr_luma": None},
    }
    without = {**lever, "words": "no rounds", "rate": {"psnr": 12.3, "psnr_luma": 9.9}, "gain": {"psnr_luma": -0.5}}
    figures = {"nine": {"levers": {"all": lever, "rounds": without}, "held_out": found}}
    monkeypatch.setattr(rate_tables, "newest", lambda history: (figures, []))
    monkeypatch.setattr(rate_tables, "runs", lambda name: [])
    monkeypatch.setattr(rate_tables, "RESULTS", tmp_path)
    assert rate_tables._studies() == ""
    (tmp_path / "fit-studies.json").touch()
    text = rate_tables._studies()
    assert "no rounds | +12 % | +10 % | -0.50 | 40.00 |" in text and "| `nine`, odd |" in text
