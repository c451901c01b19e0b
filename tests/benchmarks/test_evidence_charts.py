"""The report's charts: their coordinates against the data; and figures as words."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from evidence.charts import DASHES, Level, Series, line_chart, log_ticks, ticks
from evidence.markup import Html, dig, duration, element, escape, loose, megabytes, number, percent, table

SVG = "{http://www.w3.org/2000/svg}"


def drawing(figure):
    return ET.fromstring(re.search(r"<svg[^>]*viewBox=\"0 0 380 .*?</svg>", figure, re.S).group())


def test_ticks_are_round_and_within():
    assert ticks(0, 10) == [0, 2, 4, 6, 8, 10]
    assert ticks(0.91, 1.0, 6) == pytest.approx([0.92, 0.94, 0.96, 0.98, 1.0])
    assert ticks(5, 5) == [5]
    for low, high in ((-3.3, 17), (1e-7, 2e-7), (28.1, 28.3), (0, 1e9)):
        found = ticks(low, high)
        assert 2 <= len(found) <= 6 and low <= found[0] and found[-1] <= high
        mantissa = (found[1] - found[0]) / 10 ** math.floor(math.log10(found[1] - found[0]) + 1e-9)
        assert round(mantissa, 6) in (1, 2, 5)


def test_log_ticks():
    assert log_ticks(1, 1000, 6) == pytest.approx([1, 10, 100, 1000]) or log_ticks(1, 1000, 6) == pytest.approx(
        [1, 3, 10, 30, 100, 300, 1000]
    )
    assert log_ticks(0.9e5, 2.1e6) == pytest.approx([1e5, 2e5, 5e5, 1e6, 2e6])
    assert log_ticks(3e5, 7.5e5) == pytest.approx([3e5, 4e5, 5e5, 6e5, 7e5])
    assert log_ticks(1, 1e12) == pytest.approx([1e0, 1e3, 1e6, 1e9, 1e12])
    assert all(51 <= v <= 58 for v in log_ticks(51, 58)) and len(log_ticks(51, 58)) >= 2


@pytest.mark.parametrize("log", [False, True])
def test_every_point_is_drawn_where_it_belongs(log):
    points = [(3e4 * 2.2**i, 27 + 1.5 * i) for i in range(6)]
    figure = line_chart([Series("a", points[::-1]), Series("b", [(1e5, 30.0)])], "bytes", "dB", x_log=log)
    svg = drawing(figure)
    title, *_ = (e.text for e in svg if e.tag == f"{SVG}title")
    assert title == "dB against bytes"
    line = next(
        p.get("d") for g in svg.iter(f"{SVG}g") for p in g.iter(f"{SVG}path") if "stroke-linejoin" in p.get("style")
    )
    drawn = np.array([pair.split() for pair in line[1:].split("L")], float)
    x = np.array([p[0] for p in points])
    u = (np.log(x) if log else x, np.array([p[1] for p in points]))
    for axis, falling in ((0, False), (1, True)):
        a, b = u[axis], drawn[:, axis]
        slope, offset = np.polyfit(a, b, 1)
        assert np.abs(slope * a + offset - b).max() < 0.06  # coordinates have one decimal
        assert (slope < 0) == falling
    assert drawn[:, 0].min() > 20 and drawn[:, 0].max() <= 366 and drawn[:, 1].min() >= 24 and drawn[:, 1].max() <= 230
    marks = [e.text for e in svg.iter(f"{SVG}title")][1:]
    assert len(marks) == 7 and "b: 100,000 | 30" in " ".join(marks).replace("1e+05", "100,000")


def test_tick_labels_stand_at_their_values_and_inside():
    figure = line_chart(
        [Series("a", [(1e5, 0.91), (9e6, 0.99)])], "bytes", "SSIM", x_log=True, x_words=lambda v: f"{v / 1e3:g} kB"
    )
    labels = {
        e.text: (float(e.get("x")), float(e.get("y")), e.get("text-anchor")) for e in drawing(figure).iter(f"{SVG}text")
    }
    assert {"100 kB", "1000 kB", "0.92", "0.98"} <= set(labels)
    decades = labels["1000 kB"][0] - labels["100 kB"][0]
    assert labels["300 kB"][0] - labels["100 kB"][0] == pytest.approx(decades * math.log10(3), abs=0.3)
    for words, (x, y, side) in labels.items():
        left = x - {"start": 0, "middle": 3.3, "end": 6.6}[side] * len(words)
        assert left > -12 and left + 6.6 * len(words) < 381 and 10 < y < 270


def test_levels_notes_legend_and_what_cannot_be_drawn():
    series = [
        Series("ours <&>", [(1, 2.0), (2, None), (math.nan, 3), (3, 4.0), (0, 1.0), ("x", 1)], slot=0),
        Series("none", [(None, None)]),
    ]
    figure = line_chart(
        series,
        "n",
        "y",
        x_log=True,
        levels=[Level(3.0, "the paper"), Level(math.nan, "no")],
        notes=["a & b"],
        title="T",
    )
    svg = drawing(figure)
    words = [e.text for e in svg.iter(f"{SVG}text")]
    assert "the paper" in words and "no" not in words
    assert "a &amp; b" in figure and "ours &lt;&amp;&gt;" in figure and ">none<" not in figure
    assert len(list(svg.iter(f"{SVG}title"))) == 1 + 2
    ET.fromstring(figure)  # the whole figure is well formed
    assert "Nothing to draw" in line_chart([Series("a", [(None, 1)])], "x", "y")
    assert "Nothing to draw" in line_chart([], "x", "y")


@pytest.mark.parametrize(
    "points",
    [[(5, 5)], [(0, 0)], [(1, 7), (2, 7)], [(7, 1), (7, 2)], [(-3, -1e-9), (4, 1e9)], [(1, 100.0), (2, 100.0)]],
)
def test_flat_and_single_points_have_an_axis(points):
    text = line_chart([Series("a", points)], "x", "y")
    assert "nan" not in text.lower() and "inf" not in text.lower()
    labels = [e.text for e in drawing(text).iter(f"{SVG}text")]
    assert len(labels) >= 4  # ticks on both axes, and both names


def test_series_differ_by_more_than_colour():
    figure = line_chart([Series(str(i), [(0, i), (1, i)]) for i in range(9)], "x", "y")
    lines = [p for p in drawing(figure).iter(f"{SVG}path") if "stroke-linejoin" in p.get("style")]
    looks = {(re.search("series-[0-9]", p.get("style")).group(), p.get("stroke-dasharray")) for p in lines}
    assert len(lines) == len(looks) == 9
    assert len({dash for _, dash in looks}) == len(DASHES)


# -- figures as words -------------------------------------------------------------------------------------------------


def test_numbers():
    assert number(-1.005, 1) == "−1.0" and number(12345.6, 0) == "12\u202f346" and number(1024, 0) == "1024"
    assert number(None) == number(math.nan) == "–" and number(-math.inf) == "−∞" and number(True) == "yes"
    assert number(-0.001) == "0.00" and number(0.3, 1, sign=True) == "+0.3"
    assert percent(-35.4, 0, sign=True) == "−35\u202f%" and percent(None) == "–"
    assert megabytes(980_000) == "0.98" and megabytes(64_321) == "0.064"
    assert [duration(s) for s in (0.0123, 3.42, 61, 605, 9000)] == [
        "12 ms",
        "3.4 s",
        "61 s",
        "10 min 5 s",
        "2 h 30 min",
    ]
    assert (
        loose(28.113) == "28.11" and loose(0.000123) == "0.000123" and loose(12) == "12" and loose([1, 2.5]) == "1, 2.5"
    )
    assert number("<i>") == "&lt;i&gt;"


def test_tables_leave_out_empty_columns_and_count_their_groups():
    text = table(
        ["a", "b", "c", "d"],
        [["1", number(None), "3", "4"], ["5", None, "", "8"]],
        groups=[("", 1), ("bc", 2), ("d", 1)],
    )
    tree = ET.fromstring(text)
    heads = ["".join(e.itertext()) for e in tree.iter("th") if e.get("scope") == "col"]
    assert heads == ["a", "c", "d"]
    assert [e.get("colspan") for e in tree.iter("th") if e.get("scope") == "colgroup"] == ["1", "1", "1"]
    assert table(["a"], []) == ""


def test_markup_escapes_once():
    assert element("p", "<", Html("<b></b>"), title='"') == '<p title="&quot;">&lt;<b></b></p>'
    assert escape(escape("&")) == "&amp;"
    assert dig({"a": [{"b": 1}]}, "a", 0, "b") == 1 and dig({"a": 1}, "a", "b") is None
