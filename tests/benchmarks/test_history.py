"""Results that are appended, and the picture of their history."""

from __future__ import annotations

import json
from datetime import UTC, datetime, timedelta
from pathlib import Path

import cv2
import pytest

import history
import measure


@pytest.fixture
def results(tmp_path, monkeypatch):
    monkeypatch.setattr(measure, "RESULTS", tmp_path / "results")
    return tmp_path / "results"


def test_runs_are_appended_newest_last(results):
    path = measure.store("speed", {"fps": 10})
    assert path == results / "speed.json"
    measure.store("speed", {"fps": 20})
    measure.store("other", {"fps": 1})
    assert [run["fps"] for run in measure.runs("speed")] == [10, 20]
    assert measure.latest("speed")["fps"] == 20
    assert list(json.loads(path.read_text())) == ["runs"]
    assert sorted(p.name for p in results.iterdir()) == ["other.json", "speed.json"]


def test_a_run_says_where_it_comes_from(results):
    measure.store("speed", {"fps": 10})
    run = measure.latest("speed")
    assert list(run) == ["date", "commit", "machine", "command", "fps"]
    date = datetime.fromisoformat(run["date"])
    assert date.utcoffset() == timedelta(0) and abs(datetime.now(UTC) - date) < timedelta(minutes=1)
    assert run["machine"]["cores"] >= 1 and run["command"].startswith("python ")


def test_only_so_many_runs_are_kept(results):
    run = {"date": "2026-01-01T00:00:00+00:00", "commit": "a", "machine": {}, "command": "x"}
    results.mkdir()
    old = [run | {"fps": number} for number in range(measure.KEPT + 3)]
    (results / "speed.json").write_text(json.dumps({"runs": old}))
    measure.store("speed", {"fps": -1})
    kept = [run["fps"] for run in measure.runs("speed")]
    assert len(kept) == measure.KEPT
    assert kept[-1] == -1 and kept[:-1] == list(range(4, measure.KEPT + 3))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{"runs": [', "cannot be read"),
        ("", "cannot be read"),
        ('{"fps": 10, "commit": "a"}', 'has no "runs"'),
        ("[]", 'has no "runs"'),
        ('{"runs": []}', 'has no "runs"'),
        ('{"runs": [{"fps": 10, "machine": {}, "command": "x"}]}', "run 0 does not say its date, commit"),
        ('{"runs": [7]}', "run 0 does not say its date"),
    ],
)
def test_a_damaged_or_old_file_is_named_and_kept_and_so_is_the_run(results, text, words):
    results.mkdir()
    (results / "speed.json").write_text(text)
    for attempt in (lambda: measure.latest("speed"), lambda: measure.store("speed", {"fps": 30})):
        with pytest.raises(SystemExit) as caught:
            attempt()
        assert words in str(caught.value) and str(results / "speed.json") in str(caught.value)
    assert (results / "speed.json").read_text() == text
    assert "speed.json.new" in str(caught.value)
    assert json.loads((results / "speed.json.new").read_text())["runs"][0]["fps"] == 30


def test_a_result_that_is_not_there(results):
    with pytest.raises(SystemExit, match=r"speed\.json cannot be read"):
        measure.latest("speed")


def test_every_figure_that_the_picture_shows_is_in_the_newest_run():
    shown = [series for panel in history.PANELS.values() for series in panel]
    assert {label: history.value(measure.latest(name), path) is not None for label, name, path in shown} == {
        label: True for label, _, _ in shown
    }


def test_values_are_in_the_unit_that_is_shown():
    run = {"bytes": 2_500_000, "a": {"milliseconds": 20, "psnr": 30.5}, "none": None}
    assert history.value(run, "bytes") == 2.5
    assert history.value(run, "a/milliseconds") == 50
    assert history.value(run, "a/psnr") == 30.5
    assert history.value(run, "none") is history.value(run, "a/b") is history.value(run, "a/psnr/c") is None


def run_of(day, commit, fps):
    """A run of `render`, as it is stored."""
    origin = {"date": f"2026-01-{day:02}T00:00:00+00:00", "commit": commit, "machine": {"cores": 2}, "command": "x"}
    return origin | {"relief": {"40": {"bicubic": {"fps": fps}}}}


def test_commits_stand_in_the_order_of_their_first_run():
    results = {"a": [run_of(1, "x", 1), run_of(9, "z", 1)], "b": [run_of(3, "y", 1), run_of(12, "x", 1)]}
    assert history.commits(results) == ["x", "y", "z"]


def test_lines_go_through_the_runs_of_a_figure():
    runs = [run_of(1, "x", 10.0), run_of(2, "y", 12.0), run_of(3, "y+", 15.0)]
    title = "Drawing 40 eigen textures"
    axes = next(a for a in history.figure({"render": runs}).axes if a.get_title(loc="left") == title)
    (line,) = axes.get_lines()
    assert line.get_xydata().tolist() == [[0, 10], [1, 12], [2, 15]]
    assert line.get_label() == "software, bicubic: 15"


@pytest.mark.parametrize("runs", [1, 60])
def test_the_picture_is_written(results, monkeypatch, capsys, runs):
    results.mkdir()
    stored = [run_of(1 + number // 3, f"c{number}", 10.0 + number) for number in range(runs)]
    (results / "render.json").write_text(json.dumps({"runs": stored}))
    monkeypatch.setattr("sys.argv", ["history.py"])
    history.main()
    assert cv2.imread(str(results / "history.png")).std() > 5
    monkeypatch.setattr("sys.argv", ["history.py", str(results / "mine.png")])
    history.main()
    assert Path(capsys.readouterr().out.split()[-1]) == results / "mine.png"
    assert (results / "mine.png").read_bytes()[:4] == b"\x89PNG"


def test_nothing_to_show_is_said(results, monkeypatch):
    monkeypatch.setattr("sys.argv", ["history.py"])
    with pytest.raises(SystemExit, match="run a benchmark first"):
        history.main()
