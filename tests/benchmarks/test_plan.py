"""The plan for many instants, reckoned from the measured encodes by proportions; docs/cluster.md has its table."""

from __future__ import annotations

from pathlib import Path

import pytest

import plan

DOCS = Path(__file__).parents[2] / "docs"


def test_the_plan_follows_from_one_measured_encode():
    known = plan.Measured(pixels=1e7, photographs=2e6, scene=1e5, seconds=100, cores=2, memory=1.9e9)
    same = plan.plan(known, instants=1, pixels=1e7, machines=1, cores=2)
    assert same.task_seconds == 100 and same.memory == 1.9e9 and same.hours == pytest.approx(100 / 3600)
    many = plan.plan(known, instants=250, pixels=1e8, machines=100, cores=2)
    assert many.task_seconds == 1000 and many.memory == pytest.approx(10.9e9) and many.tasks == 250
    assert many.hours == pytest.approx(3 * 1000 / 3600)  # 250 tasks on 100 machines are three rounds
    assert many.read == 250 * 2e7 and many.written == 250 * 1e6
    faster = plan.plan(known, instants=250, pixels=1e8, machines=100, cores=16)
    assert many.task_seconds / 8 < faster.task_seconds < many.task_seconds / 4


def test_the_measured_encodes_are_read():
    for name in plan.PIXELS:
        known = plan.measured(name)
        assert known.seconds > 10 and known.scene < known.photographs and known.memory > 1e9


def test_the_page_has_the_table_that_the_script_prints():
    rows = plan.table(10_000, 100, 3840, 2160, 100, 16).splitlines()
    assert len(rows) == 12 and {row.count("|") for row in rows[2:]} == {2 + len(plan.PIXELS)}
    page = (DOCS / "cluster.md").read_text(encoding="utf-8")
    assert "\n".join(rows[2:]) in page
