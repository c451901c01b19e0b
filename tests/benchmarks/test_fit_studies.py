"""benchmarks/fit_studies.py: every part is something, nothing stays changed, and the tables say what was found."""

from __future__ import annotations

import numpy as np
import pytest

import fit_studies
import rate_tables
from eigenfield.encoding import options, plan
from eigenfield.encoding.fitted import fit, planes, rate
from eigenfield.rendering.software import drawing
from evidence import prepared
from evidence.captures import Capture
from support.captures import write_capture


@pytest.fixture(scope="module")
def ready(tmp_path_factory):
    folder = write_capture(tmp_path_factory.mktemp("studies") / "nine")
    capture, work = Capture("nine", "Nine", folder, proxy=folder / "proxy.ply"), folder.parent / "work"
    prepared.estimate(capture, work)
    return prepared.prepare(capture, work)


def test_parts_are_put_back():
    modules = (options, plan, fit, planes, rate, drawing)

    def state():
        return [dict(vars(module)) | {"PRESETS": dict(options.PRESETS)}
                for module in modules]  # fmt: skip

    before = state()
    for name, part in fit_studies.PARTS.items():
        with part.change():
            assert any(a is not b for one, other in zip(state(), before, strict=True)
                       for a, b in zip(one.values(), other.values(), strict=True)), name  # fmt: skip
    after = state()
    assert all(a is b or a == b for one, other in zip(after, before, strict=True)
               for a, b in zip(one.values(), other.values(), strict=True))  # fmt: skip


@pytest.mark.slow
def test_a_part_that_is_taken_away_changes_the_file_or_the_pictures(ready, monkeypatch):
    monkeypatch.setattr(fit_studies, "QUALITIES", (70, fit_studies.QUALITY))
    # four cameras have no region, one round of textures at most, and a square for a proxy
    chosen = ["rounds", "loop", "coarse"]
    found = fit_studies.of_parts(ready, chosen)
    assert set(found) == {"whole", *chosen}
    monkeypatch.setattr(fit_studies, "Fit", None)  # all of it is there now
    whole = found["whole"]["points"][1]
    for name in chosen:
        assert found[name]["psnr"] != whole["psnr"] or found[name]["bytes"] != whole["bytes"], name
    assert found["rounds"]["gain"]["psnr"] < 0 < found["rounds"]["rate"]["psnr"]


def test_a_file_beside_a_curve():
    figures = [(100, 30.0, 1.0, 0.5), (200, 31.0, 2.0, 0.6), (400, 33.0, 3.0, 0.7)]
    points = [dict(zip(("bytes", *fit_studies.KEYS), figure, strict=True)) for figure in figures]
    same = fit_studies.beside(points, points[1])
    assert same["rate"] == pytest.approx(dict.fromkeys(fit_studies.KEYS, 0), abs=1e-9)
    assert same["gain"] == pytest.approx(dict.fromkeys(fit_studies.KEYS, 0), abs=1e-12)
    dearer = fit_studies.beside(points, {"bytes": 400, "psnr": 31.0, "psnr_luma": 2.0, "ssim": 0.6})
    assert dearer["rate"]["psnr"] == pytest.approx(100) and dearer["gain"]["psnr"] == pytest.approx(-2)
    beyond = fit_studies.beside(points, {"bytes": 800, "psnr": 35.0, "psnr_luma": 4.0, "ssim": 0.8})
    assert beyond["rate"]["psnr"] == pytest.approx(0) and np.isclose(beyond["gain"]["ssim"], 0)


def test_held_out_views_against_bytes(ready, monkeypatch, tmp_path):
    monkeypatch.setattr(fit_studies, "QUALITIES", (60, 90))
    found = fit_studies.held_out(ready)
    coarse, fine = found["points"]
    assert coarse["bytes"] < fine["bytes"] and coarse["encoded"]["psnr"] < fine["encoded"]["psnr"]
    assert found["rule"] == "odd" and fine["held_out"]["psnr"] > 25
    whole = {"words": "the whole fit", "points": [{"parameter": 89, "bytes": 12300}]}
    without = {"words": "no rounds", "rate": {"psnr": 12.3}, "gain": {"psnr": -0.5}}
    history = [
        {"captures": {"nine": {"parts": {"whole": whole, "rounds": without}}}},
        {"captures": {"nine": {"held_out": found}}},
    ]
    monkeypatch.setattr(rate_tables, "newest", lambda runs: (runs[-1]["captures"], []))
    monkeypatch.setattr(rate_tables, "origin", lambda *_: "")
    monkeypatch.setattr(rate_tables, "runs", lambda name: history)
    monkeypatch.setattr(rate_tables, "RESULTS", tmp_path)
    assert rate_tables._studies() == ""
    (tmp_path / "fit-studies.json").touch()
    text = rate_tables._studies()
    assert "no rounds | +12.3 %, -0.50 dB |" in text and "| `nine`, odd |" in text and "12.3 kB" in text


def test_halved_photographs_show_the_same(ready, tmp_path):
    """Each pixel is the mean of four, seen by a camera that projects to half the place."""
    half = prepared.halved(ready.light_field, tmp_path / "halved")
    assert half.names == ready.light_field.names
    for index, (camera, whole) in enumerate(zip(half.cameras, ready.light_field.cameras, strict=True)):
        assert (camera.width, camera.height) == (whole.width // 2, whole.height // 2)
        point = np.array([[0.1, -0.2, 0.0]])
        np.testing.assert_allclose(camera.project(point)[0], whole.project(point)[0] / 2, atol=1e-9)
        pixels = prepared.codes(ready.light_field, index).astype(float)
        means = pixels.reshape(camera.height, 2, camera.width, 2, 3).mean(axis=(1, 3))
        np.testing.assert_allclose(prepared.codes(half, index), means, atol=0.51)
