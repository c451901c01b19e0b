"""HTML out of plain figures: every string is escaped unless it is `Html`, and what is not known is a dash.

Figures come from a JSON file that may be of an older run, cut short, or hold null: nothing here raises on such values.
"""

from __future__ import annotations

import html
import math
import re
from collections.abc import Collection, Iterable, Sequence
from typing import Any

NONE = "–"
FORBIDDEN = re.compile("[\x00-\x08\x0b-\x1f\ud800-\udfff\ufffe\uffff]")  # in XML
LONG = 28  # letters of a cell from which it wraps


class Html(str):
    """Text that is markup already."""

    __slots__ = ()


def escape(value: Any) -> Html:
    """Any value as it may stand in an element or an attribute. Control characters, which XML forbids, become U+FFFD."""
    if isinstance(value, Html):
        return value
    if value is None:
        return Html(NONE)
    return Html(html.escape(FORBIDDEN.sub("\ufffd", str(value)), quote=True))


def join(parts: Iterable[Any], between: str = "") -> Html:
    """Parts, escaped where they are no markup, put together."""
    return Html(escape(between).join(escape(part) for part in parts if part is not None and part != ""))


def element(name: str, *content: Any, **attributes: Any) -> Html:
    """<name attribute="...">content</name>; `class_` is class, `_` is `-`, an attribute that is None is left out."""
    words = [f' {key.rstrip("_").replace("_", "-")}="{escape(value)}"' for key, value in attributes.items()
             if value is not None]  # fmt: skip
    return Html(f"<{name}{''.join(words)}>{join(content)}</{name}>")


def anchor(*words: Any) -> str:
    """A name for a link, of letters, digits, dashes and underlines; no two lists of words have the same."""
    kept = ("".join(c if c.isascii() and c.isalnum() else f"_{ord(c):x}_" for c in str(word)) for word in words)
    return "-".join(kept)


# -- getting at figures -----------------------------------------------------------------------------------------------


def dig(tree: Any, *path: str | int) -> Any:
    """tree[path[0]][path[1]]..., None where something on the way is missing."""
    for key in path:
        if isinstance(tree, dict):
            tree = tree.get(key)
        elif isinstance(tree, list | tuple) and isinstance(key, int) and -len(tree) <= key < len(tree):
            tree = tree[key]
        else:
            return None
    return tree


def listing(tree: Any, *path: str | int) -> list[dict[str, Any]]:
    """The dictionaries of the list there; none if there is no list."""
    found = dig(tree, *path)
    return [item for item in found if isinstance(item, dict)] if isinstance(found, list | tuple) else []


def finite(value: Any) -> float | None:
    """The value as a float; None for what is no number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value) if math.isfinite(value) else None


def change(new: Any, old: Any) -> float | None:
    """new / old - 1 in percent."""
    a, b = finite(new), finite(old)
    return None if a is None or not b else 100 * (a / b - 1)


# -- figures as words -------------------------------------------------------------------------------------------------


def number(value: Any, digits: int = 2, *, sign: bool = False, unit: str = "") -> Html:
    """A number with that many decimals and a true minus; other values as they are, nothing as a dash."""
    if isinstance(value, bool):
        return Html("yes" if value else "no")
    if not isinstance(value, int | float):
        return escape(value)
    if math.isnan(value):
        return Html(NONE)
    words = ("∞" if value > 0 else "-∞") if math.isinf(value) else f"{value:{'+' if sign else ''},.{digits}f}"
    if not any(c in "123456789∞" for c in words):  # -0.00
        words = words.lstrip("+-")
    space = "\u202f" if abs(value) >= 10_000 else ""  # 1024 stands closed up
    return Html(words.replace("-", "−").replace(",", space) + escape(unit))


def percent(value: Any, digits: int = 1, *, sign: bool = False) -> Html:
    return number(value, digits, sign=sign, unit="\u202f%" if finite(value) is not None else "")


def fraction(value: Any, digits: int = 1) -> Html:
    """A part of 1, in percent."""
    known = finite(value)
    return percent(None if known is None else 100 * known, digits)


def megabytes(value: Any) -> Html:
    """Bytes in units of 10^6; three decimals where two would leave one figure."""
    known = finite(value)
    if known is None:
        return escape(value)
    return number(known / 1e6, 2 if known >= 1e5 or known == 0 else 3)


def data_size(value: Any) -> Html:
    """Bytes with their unit: 0.94 MB, 38.1 kB, 512 bytes."""
    known = finite(value)
    if known is None:
        return escape(value)
    for unit, scale, digits in (("GB", 1e9, 2), ("MB", 1e6, 2), ("kB", 1e3, 1)):
        if known >= scale:
            return number(known / scale, digits, unit=f" {unit}")
    return number(known, 0, unit=" bytes")


def duration(value: Any) -> Html:
    """Seconds as a person says them: 12 ms, 3.4 s, 12 min 5 s, 2 h 7 min."""
    known = finite(value)
    if known is None:
        return escape(value)
    if known < 0.9995:
        return number(known * 1e3, 0 if known >= 0.01 else 1, unit=" ms")
    if known < 119.5:
        return number(known, 1 if known < 20 else 0, unit=" s")
    whole = round(known)
    if whole < 7200:
        return Html(f"{whole // 60} min {whole % 60} s")
    return Html(f"{whole // 3600} h {whole % 3600 // 60} min")


def loose(value: Any) -> Html:
    """A cell of a table that brings its own columns: four significant figures, lists with commas."""
    if isinstance(value, float) and math.isfinite(value) and value:
        digits = 0 if abs(value) >= 1000 else max(0, 3 - math.floor(math.log10(abs(value))))
        words = number(value, min(digits, 6))
        return Html(words.rstrip("0").rstrip(".")) if "." in words else words
    if isinstance(value, int | float):
        return number(value, 0)
    if isinstance(value, list | tuple):
        return join((loose(item) for item in value), ", ")
    return escape(value)


def between(values: Any, digits: int = 0, unit: str = "") -> Html:
    """[9.5, 14.8] as 9.5–14.8."""
    if isinstance(values, list | tuple) and values:
        words = [number(v, digits) for v in values]
        return Html("–".join(dict.fromkeys(words)) + escape(unit))
    return number(values, digits, unit=unit if values is not None else "")


# -- blocks -----------------------------------------------------------------------------------------------------------


def paragraph(*words: Any, kind: str | None = None) -> Html:
    return element("p", *words, class_=kind)


def items(lines: Iterable[Any]) -> Html:
    """A list with points; nothing for no lines."""
    inner = [element("li", line) for line in lines]
    return element("ul", *inner) if inner else Html("")


def details(summary: Any, *body: Any) -> Html:
    """A part that is folded until it is asked for; nothing where there is nothing in it."""
    inner = join(body)
    return element("details", element("summary", summary), inner) if inner else Html("")


def link(address: str, *words: Any) -> Html:
    return element("a", *words, href=f"#{address}")


def table(
    columns: Sequence[Any],
    rows: Iterable[Sequence[Any]],
    *,
    caption: Any = None,
    groups: Sequence[tuple[Any, int]] = (),
    left: Collection[int] = (),
    note: Any = None,
) -> Html:
    """A table in a box of its own, which scrolls sideways while the first column stays.

    Cells are right-aligned but for the first column and those in `left`. groups: (label, columns it spans) of a row
    above the columns. A column in which no row has a figure is left out, as is a table without rows.
    """
    lines = [[escape(cell) for cell in row] for row in rows]
    if not lines:
        return Html("")
    kept = [
        i for i in range(len(columns)) if i == 0 or any(i < len(line) and line[i] not in (NONE, "") for line in lines)
    ]
    sides = {i: "l" if i == 0 or i in left else None for i in kept}
    head = element("tr", *(element("th", columns[i], scope="col", class_=sides[i]) for i in kept))
    if groups:
        spans, first = [], 0
        for label, width in groups:
            span = sum(first <= i < first + width for i in kept)
            first += width
            if span:
                spans.append(element("th", label, scope="colgroup", colspan=span))
        head = Html(element("tr", *spans, class_="groups") + head)
    body = []
    for line in lines:
        cells = [line[i] if i < len(line) else Html(NONE) for i in kept]
        body.append(
            element(
                "tr",
                element("th", cells[0], scope="row", class_="l"),
                *(
                    element("td", cell, class_=_side(sides[i], cell))
                    for i, cell in zip(kept[1:], cells[1:], strict=True)
                ),
            )
        )
    inner = element("table", element("thead", head), element("tbody", *body))
    box = element("div", inner, class_="box", tabindex="0", role="region", aria_label=_plain(caption) or "table")
    title = element("figcaption", caption) if caption else ""
    return element("figure", title, box, paragraph(note, kind="note") if note else "", class_="table")


def _side(side: str | None, cell: Html) -> str | None:
    """The class of a cell: words of more than a few wrap."""
    return "l long" if side and len(_plain(cell) or "") > LONG else side


def _plain(words: Any) -> str | None:
    """Words without their markup, for an attribute."""
    if words is None or not isinstance(words, Html):
        return None if words is None else str(words)
    return html.unescape(re.sub(r"<[^>]*>", "", words))
