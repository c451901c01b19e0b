"""Results: one run a line, the newest of each capture or driver, and damaged files."""

from __future__ import annotations

import json
from datetime import UTC, datetime, timedelta

import pytest

import measure


@pytest.fixture
def results(tmp_path, monkeypatch):
    monkeypatch.setattr(measure, "RESULTS", tmp_path / "results")
    return tmp_path / "results"


def test_a_run_is_a_line_and_goes_when_all_of_it_is_measured_again(results):
    path = measure.store("speed", {"fps": 10, "driver": "a"})
    assert path == results / "speed.json"
    measure.store("speed", {"fps": 20, "driver": "b"})
    measure.store("speed", {"fps": 30, "driver": "a"})
    measure.store("other", {"captures": {"one": 1, "two": 2}})
    measure.store("other", {"captures": {"two": 3}})
    measure.store("other", {"captures": {"two": 4}})
    assert [run["fps"] for run in measure.runs("speed")] == [20, 30]
    assert measure.latest("speed")["fps"] == 30
    assert [run["captures"] for run in measure.runs("other")] == [{"one": 1, "two": 2}, {"two": 4}]
    lines = path.read_text().splitlines()
    assert len(lines) == 4 and [json.loads(line.rstrip(","))["fps"] for line in lines[1:3]] == [20, 30]
    assert sorted(p.name for p in results.iterdir()) == ["other.json", "speed.json"]


def test_a_run_says_where_it_comes_from(results):
    measure.store("speed", {"fps": 10})
    run = measure.latest("speed")
    assert list(run) == ["date", "commit", "machine", "command", "fps"]
    date = datetime.fromisoformat(run["date"])
    assert date.utcoffset() == timedelta(0) and abs(datetime.now(UTC) - date) < timedelta(minutes=1)
    assert run["machine"]["cores"] >= 1 and run["command"].startswith("python ")


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
