"""Line charts as SVG written by hand: small, sharp at any size, and in the colours of the page, light or dark.

A chart is a <figure>: title, drawing, legend that wraps, notes. It needs no script and no style sheet: colours are CSS
variables with the light theme's value behind them. Series differ by colour, dash and marker at once.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from evidence.markup import Html, element, finite, items, join, number, paragraph

WIDTH, HEIGHT = 380.0, 270.0  # user units: one CSS pixel where a phone gives the chart its whole width
TOP, BOTTOM, RIGHT = 24.0, 40.0, 14.0
LETTER = 6.7  # width of a digit of the labels, for the left margin
MARGIN = 0.05  # of the range, kept free above and below the points

# Okabe and Ito's palette, darkened where it would be pale on white; page.css has the dark theme's. 0 is ours.
COLOURS = ("#d1480b", "#0068a8", "#00805c", "#a8478c", "#5c5c5c", "#b07900", "#5b45b5", "#2f95c9", "#7a4b1e")
DASHES = ("", "7 3", "2 2.5", "9 3 2 3", "4 2.5")
MARKERS = ("circle", "square", "triangle", "diamond", "cross", "ring", "wedge")

Words = Callable[[float], str]


@dataclass(frozen=True)
class Series:
    """points: (x, y) in any order; those that cannot be drawn (no number; not above 0 on a log axis) are left out.
    slot: which colour, dash and marker, by position if None; 0 is drawn thick. joined: with a line between points."""

    label: str
    points: Sequence[tuple[Any, Any]]
    slot: int | None = None
    joined: bool = True


@dataclass(frozen=True)
class Level:
    """A horizontal line to compare with, with a word on it."""

    value: float
    label: str


@dataclass(frozen=True)
class Axis:
    """low..high of the data on start..end of the drawing."""

    low: float
    high: float
    start: float
    end: float
    log: bool

    def place(self, value: float) -> float:
        low, high, at = (math.log(v) if self.log else v for v in (self.low, self.high, value))
        return self.start + (self.end - self.start) * (at - low) / (high - low)


def ticks(low: float, high: float, count: int = 6) -> list[float]:
    """At most `count` multiples of 1, 2 or 5 times a power of ten within low..high."""
    span = high - low
    if not span > 0:
        return [low]
    power = 10.0 ** math.floor(math.log10(span / count))
    for factor in (1, 2, 5, 10, 20, 50):
        step = power * factor
        first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
        if last - first < count:
            return [round(i * step, 12) if step < 1 else i * step for i in range(first, last + 1)]
    raise AssertionError((low, high, count))


def log_ticks(low: float, high: float, count: int = 6) -> list[float]:
    """At most `count` round numbers within low..high, 0 < low: the densest of 1, 2, 3 ... 9, of 1, 2, 5, of 1, 3 and of
    1 times powers of ten that fits; every second power, and so on, over many; linear ones where the range has no two.
    """
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    for factors in (range(1, 10), (1, 2, 5), (1, 3), (1,)):
        found = [f * 10.0**p for p in range(first, last + 1) for f in factors if low <= f * 10.0**p * (1 + 1e-9)]
        found = [v for v in found if v <= high * (1 + 1e-9)]
        if 2 <= len(found) <= count:
            return found
    if len(found) > count:
        return found[:: math.ceil(len(found) / count)]
    return [v for v in ticks(low, high, count) if v > 0]


def line_chart(
    series: Sequence[Series],
    x_label: str,
    y_label: str,
    *,
    title: str = "",
    x_log: bool = False,
    y_log: bool = False,
    levels: Sequence[Level] = (),
    notes: Sequence[str] = (),
    x_words: Words | None = None,
) -> Html:
    """The chart as a <figure>. x_words: how a tick of the x axis is written, as a decimal number if None."""
    drawn = [(s, _drawable(s, x_log, y_log), i if s.slot is None else s.slot) for i, s in enumerate(series)]
    drawn = [(s, points, slot) for s, points, slot in drawn if points]
    heading = element("figcaption", title) if title else ""
    if not drawn:
        empty = paragraph("Nothing to draw: no point has both figures.", kind="missing")
        return element("figure", heading, empty, class_="chart")
    levels = [level for level in levels if finite(level.value) is not None and (not y_log or level.value > 0)]
    xs = [x for _, points, _ in drawn for x, _ in points]
    ys = [y for _, points, _ in drawn for _, y in points] + [level.value for level in levels]

    x_range, y_range = _widened(xs, x_log), _widened(ys, y_log)
    x_ticks, y_ticks = (log_ticks if log else ticks for log in (x_log, y_log))
    across, up = x_ticks(*x_range), y_ticks(*y_range)
    if all(x == int(x) for x in xs):  # a number of things has no halves
        across = [x for x in across if x == int(x)] or across
    x_names, y_names = _names(across, x_words), _names(up, None)
    left = 12 + LETTER * max(len(name) for name in y_names)
    x_axis = Axis(*x_range, left, WIDTH - RIGHT, x_log)
    y_axis = Axis(*y_range, HEIGHT - BOTTOM, TOP, y_log)

    parts = [_grid(x_axis, y_axis, across, up, x_names, y_names, x_label, y_label)]
    lines = [[(x_axis.place(x), y_axis.place(y)) for x, y in points] for _, points, _ in drawn]
    parts += [_level(level, x_axis, y_axis, lines) for level in levels]
    for at in sorted(range(len(drawn)), key=lambda i: drawn[i][2] == 0):  # ours on top
        (one, points, slot), places = drawn[at], lines[at]
        said = [f"{one.label}: {_said(x, x_words)} | {number_of_any_size(y)}" for x, y in points]
        parts.append(_line(places, said, slot, one.joined))
    labels = ", ".join(one.label for one, _, _ in drawn)
    words = f"{y_label} against {x_label}"
    drawing = element(
        "svg",
        element("title", title or words),
        element("desc", f"{words}, {len(drawn)} series: {labels}"),
        *parts,
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {WIDTH:g} {HEIGHT:g}",
        role="img",
        aria_label=f"{title or words}: {words} of {labels}",
        class_="plot",
    )
    legend = element("ul", *(element("li", _swatch(slot, s.joined), s.label) for s, _, slot in drawn), class_="legend")
    below = element("div", items(notes), class_="note") if notes else ""
    return element("figure", heading, drawing, legend, below, class_="chart")


def _drawable(one: Series, x_log: bool, y_log: bool) -> list[tuple[float, float]]:
    found = []
    for pair in one.points:
        x, y = finite(pair[0]), finite(pair[1])
        if x is not None and y is not None and (x > 0 or not x_log) and (y > 0 or not y_log):
            found.append((x, y))
    return sorted(found, key=lambda point: point[0])


def _widened(values: Sequence[float], log: bool) -> tuple[float, float]:
    """The range of the values with a margin; one value alone stands in the middle."""
    low, high = min(values), max(values)
    if log:
        factor = (high / low) ** MARGIN if high > low * (1 + 1e-9) else 1.5
        return low / factor, high * factor
    margin = (high - low) * MARGIN
    if not margin > 1e-9 * max(abs(low), abs(high)):
        margin = max(abs(high) * 0.1, 1e-6)
    if low >= 0 > low - margin:  # what cannot be negative gets no axis below 0
        return 0.0, high + margin
    return low - margin, high + margin


def _names(values: Sequence[float], words: Words | None) -> list[str]:
    """Labels of ticks, with as many decimals as tell them apart."""
    if words is not None:
        return [words(v) for v in values]
    steps = [b - a for a, b in itertools.pairwise(values)]
    even = len(steps) > 0 and max(steps) < 1.01 * min(steps)
    digits = max(0, -math.floor(math.log10(min(steps)) + 1e-9)) if even else None
    return [number(v, digits) if digits is not None else number_of_any_size(v) for v in values]


def number_of_any_size(value: float) -> str:
    """Four significant figures at most, without an exponent between 0.001 and 10^6."""
    return f"{value:.4g}".replace("-", "−") if 1e-3 <= abs(value) < 1e4 or value == 0 else f"{value:,.3g}"


def _said(value: float, words: Words | None) -> str:
    return words(value) if words is not None else number_of_any_size(value)


def _grid(
    x_axis: Axis,
    y_axis: Axis,
    across: Sequence[float],
    up: Sequence[float],
    x_names: Sequence[str],
    y_names: Sequence[str],
    x_label: str,
    y_label: str,
) -> Html:
    left, right, bottom, top = x_axis.start, x_axis.end, y_axis.start, y_axis.end
    lines = [f"M{_p(x_axis.place(x))} {_p(top)}V{_p(bottom)}" for x in across]
    lines += [f"M{_p(left)} {_p(y_axis.place(y))}H{_p(right)}" for y in up]
    frame = f"M{_p(left)} {_p(top)}V{_p(bottom)}H{_p(right)}"
    return join(
        [
            _path(" ".join(lines), "stroke:var(--grid,#e2e2de);fill:none"),
            _path(frame, "stroke:var(--muted,#5c5c5c);fill:none"),
            *(
                _text(n, _inside(x_axis.place(x), n), bottom + 15, "middle")
                for x, n in zip(across, x_names, strict=True)
            ),
            *(_text(n, left - 5, y_axis.place(y) + 4, "end") for y, n in zip(up, y_names, strict=True)),
            _text(x_label, (left + right) / 2, HEIGHT - 6, "middle"),
            _text(y_label, 4, 14, "start"),
        ]
    )


def _inside(x: float, words: str) -> float:
    """Where a middle-aligned label at x goes so that it ends within the drawing."""
    return min(x, WIDTH - 1 - LETTER * len(words) / 2)


def _level(level: Level, x_axis: Axis, y_axis: Axis, lines: Sequence[Sequence[tuple[float, float]]]) -> Html:
    """The line, and its word above or below it, left or right, where it hides least of the series."""
    y = y_axis.place(level.value)
    stroke = "stroke:var(--muted,#5c5c5c);stroke-width:1.2;fill:none"
    width = LETTER * len(level.label)
    left, right = x_axis.start + 5, x_axis.end - 3 - width
    places = [(x, at) for at in (y - 4, y + 13) for x in (right, left) if y_axis.end < at - 9 and at < y_axis.start]
    x, at = min(places or [(right, y - 4)], key=lambda place: _hidden(place[0], place[1], width, lines))
    return Html(
        _path(f"M{_p(x_axis.start)} {_p(y)}H{_p(x_axis.end)}", stroke, dasharray="1 3")
        + _text(level.label, x, at, "start", halo=True)
    )


def _hidden(x: float, y: float, width: float, lines: Sequence[Sequence[tuple[float, float]]]) -> int:
    """How much of the lines lies under words that begin at x and stand on y: of 20 places on each piece."""
    count = 0
    for line in lines:
        for (x0, y0), (x1, y1) in itertools.pairwise([*line[:1], *line]):
            for part in range(20):
                at = (x0 + (x1 - x0) * part / 19, y0 + (y1 - y0) * part / 19)
                count += x - 6 < at[0] < x + width + 6 and y - 15 < at[1] < y + 5
    return count


def _line(places: Sequence[tuple[float, float]], said: Sequence[str], slot: int, joined: bool) -> Html:
    colour, dash, marker = _look(slot)
    width = 2.6 if slot == 0 else 1.6
    parts = []
    if joined and len(places) > 1:
        way = "M" + "L".join(f"{_p(x)} {_p(y)}" for x, y in places)
        style = f"stroke:{colour};stroke-width:{width};fill:none;stroke-linejoin:round"
        parts.append(_path(way, style, dasharray=dash or None))
    parts += [_marker(marker, x, y, colour, words) for (x, y), words in zip(places, said, strict=True)]
    return element("g", *parts)


def _look(slot: int) -> tuple[str, str, str]:
    """Colour, dash and marker; no two slots below 315 share all three."""
    colour = slot % len(COLOURS)
    return f"var(--series-{colour},{COLOURS[colour]})", DASHES[slot % len(DASHES)], MARKERS[slot % len(MARKERS)]


def _marker(shape: str, x: float, y: float, colour: str, words: str | None = None) -> Html:
    full, hollow = f"fill:{colour}", f"fill:var(--card,#fff);stroke:{colour};stroke-width:1.6"
    way, style = {
        "circle": (_round(x, y, 3.8), full),
        "square": (f"M{_p(x - 3.3)} {_p(y - 3.3)}h6.6v6.6h-6.6z", full),
        "triangle": (f"M{_p(x)} {_p(y - 4.4)}l4.2 7.4h-8.4z", full),
        "diamond": (f"M{_p(x)} {_p(y - 4.6)}l4.6 4.6l-4.6 4.6l-4.6 -4.6z", full),
        "cross": (f"M{_p(x - 3.4)} {_p(y - 3.4)}l6.8 6.8m0 -6.8l-6.8 6.8", f"stroke:{colour};stroke-width:2;fill:none"),
        "ring": (_round(x, y, 3.4), hollow),
        "wedge": (f"M{_p(x)} {_p(y + 4.4)}l4.2 -7.4h-8.4z", full),
    }[shape]
    return element("path", element("title", words) if words else "", d=way, style=style)


def _round(x: float, y: float, r: float) -> str:
    return f"M{_p(x - r)} {_p(y)}a{r} {r} 0 1 0 {_p(2 * r)} 0a{r} {r} 0 1 0 {_p(-2 * r)} 0z"


def _swatch(slot: int, joined: bool) -> Html:
    """The line and marker of a series, for the legend."""
    colour, dash, marker = _look(slot)
    style = f"stroke:{colour};stroke-width:{2.6 if slot == 0 else 1.6};fill:none"
    line = _path("M1 7H31", style, dasharray=dash or None) if joined else ""
    return element("svg", line, _marker(marker, 16, 7, colour), viewBox="0 0 32 14", aria_hidden="true")


def _text(words: str, x: float, y: float, anchor: str, halo: bool = False) -> Html:
    style = "font:12px system-ui,sans-serif;fill:var(--ink-2,#444)"
    if halo:
        style += ";paint-order:stroke;stroke:var(--card,#fff);stroke-width:4;stroke-linejoin:round"
    return element("text", words, x=_p(x), y=_p(y), text_anchor=anchor, style=style)


def _path(way: str, style: str, dasharray: str | None = None) -> Html:
    return element("path", d=way, style=style, stroke_dasharray=dasharray)


def _p(value: float) -> str:
    """A coordinate with one decimal."""
    return f"{value:.1f}".removesuffix(".0")
