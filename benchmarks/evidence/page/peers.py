"""Sections 5 and 6: what other codecs need for the same photographs, and what simpler ways draw between the cameras."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from evidence.charts import Level, Series, line_chart
from evidence.markup import (
    Html,
    data_size,
    details,
    dig,
    duration,
    element,
    finite,
    fraction,
    items,
    join,
    listing,
    loose,
    megabytes,
    number,
    paragraph,
    table,
)
from evidence.page.source import (
    Source,
    Tree,
    by_capture,
    capture_link,
    gallery,
    label_of,
    peer_rates,
    picture,
    shaded,
    worst,
)
from evidence.page.verdicts import access, is_ours

ROOM = 0.3  # of the range of a chart, within which a level above it is drawn
CHARTS = (
    ("psnr", "PSNR, dB", "RGB PSNR"), ("psnr_luma", "luma PSNR, dB", "Luma PSNR"), ("ssim", "SSIM", "SSIM"),
)  # fmt: skip
BETWEEN = (
    ("psnr", "PSNR dB", 2, 1), ("psnr_luma", "luma PSNR dB", 2, 1), ("psnr_outside", "PSNR outside, dB", 2, 1),
    ("psnr_full", "PSNR whole frame, dB", 2, 1), ("ssim", "SSIM", 4, 1), ("flip", "FLIP", 4, -1),
)  # fmt: skip  # key, title, decimals, whether more (1) or less (-1) is better


def peers(source: Source) -> Html:
    slots = _slots(source)
    return join([_overview(source), by_capture(source, "peers", "rates", lambda s, n, f: _capture(s, n, f, slots))])


def _slots(source: Source) -> dict[str, int]:
    """A colour for each curve, the same in all charts; the first of ours has 0."""
    found: dict[str, int] = {}
    first = True
    for name in source.captures:
        for curve in listing(source.figures(name, "rates"), "curves"):
            label = label_of(curve)
            if label in found:
                continue
            found[label] = 0 if first and curve.get("kind") == "ours" else 1 + sum(slot > 0 for slot in found.values())
            first = first and found[label] != 0
    return found


def _overview(source: Source) -> Html:
    """BD-rates, captures against peers."""
    names = [n for n in source.captures if peer_rates(source, n)]
    columns = list(dict.fromkeys(peer for n in names for peer in peer_rates(source, n)))
    rows = []
    for name in names:
        rates = peer_rates(source, name)
        rows.append([capture_link(source, "peers", "rates", name), *(_pair(rates.get(peer)) for peer in columns)])
    note = (
        "Bytes that our scene needs relative to the peer at equal PSNR (Bjøntegaard's delta rate over covered pixels, "
        "encoded views): RGB / luma. −: ours is smaller; + (shaded): the peer is. A dash: the curves share too little "
        "quality to compare."
    )
    return table(["capture", *columns], rows, caption="BD-rate of ours against each peer", note=note)


def _pair(values: Tree | None) -> Html | None:
    if values is None or all(finite(values.get(k)) is None for k in ("psnr", "psnr_luma")):
        return None
    return join((shaded(values.get(k)) for k in ("psnr", "psnr_luma")), " / ")


def _capture(source: Source, name: str, figures: Tree, slots: dict[str, int]) -> Html:
    curves = listing(figures, "curves")
    if not curves:
        return paragraph("No curve was measured.", kind="missing")
    charts = element("div", *(_chart(figures, curves, slots, *chart) for chart in CHARTS), class_="charts")
    whole = element(
        "div",
        *(
            _chart(figures, curves, slots, f"{key}_full", label, f"{title}, whole frame")
            for key, label, title in CHARTS
        ),
        class_="charts",
    )
    pictures = gallery(
        *(
            picture(
                source,
                crop.get("picture"),
                join([element("strong", crop.get("label")), *_said(crop)]),
                f"detail, {crop.get('label')}",
            )
            for crop in listing(figures, "crops")
        )
    )
    left_out = figures.get("left_out")
    return join(
        [
            charts,
            _curves_table(figures, curves, peer_rates(source, name)),
            pictures,
            items(f"Left out: {words}" for words in left_out) if isinstance(left_out, list) else "",
            details("The same over the whole frame", whole),
            details("Every point of every curve", _points_table(curves)),
        ]
    )


def _said(crop: Tree) -> list[Html]:
    found = []
    if crop.get("bytes") is not None:
        found.append(join([" ", data_size(crop.get("bytes"))]))
    if crop.get("psnr") is not None:
        found.append(join([", ", number(crop.get("psnr"), 2, unit=" dB")]))
    return found


def _chart(figures: Tree, curves: Sequence[Tree], slots: dict[str, int], key: str, label: str, title: str) -> Html:
    series = [
        Series(label_of(c), [(p.get("bytes"), p.get(key)) for p in listing(c, "points")], slots.get(label_of(c)))
        for c in curves
    ]
    values = [v for one in series for _, y in one.points if (v := finite(y)) is not None]
    ceiling, levels, notes = finite(dig(figures, "ceiling", key)), [], []
    if ceiling is not None and values and min(values) < ceiling < max(values) + ROOM * (max(values) - min(values)):
        levels = [Level(ceiling, "4:2:0, no codec")]
    elif ceiling is not None:
        notes = [f"10 bit 4:2:0 without any codec: {number(ceiling, 4 if key.startswith('ssim') else 2)}"]
    return line_chart(
        series, "bytes for all views (log)", label, title=title, x_log=True, levels=levels, notes=notes, x_words=_bytes
    )


def _bytes(value: float) -> str:
    """3 MB, 30 kB: of a tick, which is round, or of a point."""
    unit, scale = ("MB", 1e6) if value >= 999_500 else ("kB", 1e3)
    return f"{value / scale:.3g} {unit}" if value < 999.5e6 else f"{value / 1e9:.3g} GB"


def _curves_table(figures: Tree, curves: Sequence[Tree], rates: dict[str, Tree]) -> Html:
    """One row a curve: BD-rates, and the time to encode and to reach one view."""
    rows = []
    for curve in curves:
        points, rate = listing(curve, "points"), rates.get(label_of(curve), {})
        ours = curve.get("kind") == "ours"
        rows.append(
            [
                element("strong", label_of(curve)) if ours else label_of(curve),
                _chroma(curve.get("chroma")),
                _span([p.get("bytes") for p in points], data_size),
                *(shaded(rate.get(key)) for key in ("psnr", "psnr_luma", "ssim")),
                *(number(rate.get(f"{key}_gain"), 2, sign=True) for key in ("psnr", "psnr_luma")),
                _span([p.get("encode_seconds") for p in points], duration),
                _span(access(curve), duration),
                _span(access(curve, ("last", "next")), duration) if _timed_twice(points) else None,
            ]
        )
    groups = [("", 3), ("bytes of ours against it", 3), ("dB of ours against it", 2), ("", 1), ("time to views", 2)]
    columns = ["", "chroma", "bytes", "RGB", "luma", "SSIM", "RGB", "luma", "encode", "first", "then"]
    note = join(
        [
            _extent(figures),
            "Bytes of ours: at equal quality; dB of ours: at equal bytes (Bjøntegaard). Times span the rates measured. "
            "First: a view in the middle of the array, from a cold file. Then: of video and single pictures the last "
            "view, from a cold file again; of ours one more view, the file being open.",
        ]
    )
    return table(columns, rows, groups=groups, left={1}, caption="Curves", note=note)


def _extent(figures: Tree) -> Html:
    """Which views were coded, in which order, and over which pixels they are measured."""
    views, total, coverage = figures.get("views"), figures.get("of"), figures.get("coverage")
    parts = []
    if views is not None:
        of_all = f" of {total} (every second row and column)" if total not in (None, views) else ""
        parts.append(f"{views} views{of_all}")
    if figures.get("order"):
        parts.append(f"video in {figures['order']} order")
    if finite(coverage) is not None:
        parts.append(join(["measured over covered pixels, ", fraction(coverage), " of the frame"]))
    return join([join(parts, ", "), ". "]) if parts else Html("")


def _timed_twice(points: Sequence[Tree]) -> bool:
    return any(isinstance(point.get("access_seconds"), dict) for point in points)


def _chroma(value: Any) -> Any:
    """420 as 4:2:0."""
    return ":".join(value) if isinstance(value, str) and len(value) == 3 and value.isdigit() else value


def _span(values: Sequence[Any], words: Any) -> Html | None:
    """The least and the largest."""
    known = [v for v in map(finite, values) if v is not None]
    if not known:
        return None
    low, high = words(min(known)), words(max(known))
    return low if low == high else join([low, " – ", high])


def _points_table(curves: Sequence[Tree]) -> Html:
    rows = [
        [
            label_of(curve),
            loose(point.get("parameter")),
            megabytes(point.get("bytes")),
            *(number(point.get(k), d) for k, d in (("psnr", 2), ("psnr_luma", 2), ("ssim", 4))),
            worst(point, "psnr", 2),
            *(number(point.get(k), d) for k, d in (("psnr_full", 2), ("psnr_luma_full", 2), ("ssim_full", 4))),
            duration(point.get("encode_seconds")),
            *_access(point),
        ]
        for curve in curves
        for point in sorted(listing(curve, "points"), key=lambda p: finite(p.get("bytes")) or 0)
    ]
    quality = ["PSNR", "luma", "SSIM"]
    columns = ["", "setting", "MB", *quality, "worst PSNR", *quality, "encode", "first", "then"]
    groups = [("", 3), ("covered pixels", 4), ("whole frame", 3), ("", 1), ("time to views", 2)]
    return table(columns, rows, groups=groups, left={1})


def _access(point: Tree) -> list[Html]:
    value = point.get("access_seconds")
    if isinstance(value, dict):
        return [duration(value.get("middle", value.get("first"))), duration(value.get("last", value.get("next")))]
    return [duration(value), duration(None)]


# -- between the cameras ----------------------------------------------------------------------------------------------


def between_cameras(source: Source) -> Html:
    return join([_between_overview(source), by_capture(source, "between", "between", _methods)])


def _between_overview(source: Source) -> Html:
    """PSNR, captures against ways to draw; the best of each capture is marked."""
    found: dict[str, dict[str, Any]] = {}
    for name in source.captures:
        for method in listing(source.figures(name, "between"), "methods"):
            found.setdefault(name, {})[label_of(method)] = method.get("psnr")
    columns = list(dict.fromkeys(label for methods in found.values() for label in methods))
    rows = []
    for name, methods in found.items():
        best = max((v for v in map(finite, methods.values()) if v is not None), default=None)
        rows.append(
            [capture_link(source, "between", "between", name), *(_marked(methods.get(c), 2, best) for c in columns)]
        )
    return table(
        ["capture", *columns],
        rows,
        caption="Held-out views: RGB PSNR over covered pixels, dB",
        note="The best of each row is shaded.",
    )


def _marked(value: Any, digits: int, best: float | None) -> Html:
    words = number(value, digits)
    return element("span", words, class_="best") if best is not None and finite(value) == best else words


def _methods(source: Source, name: str, figures: Tree) -> Html:
    methods = listing(figures, "methods")
    best: dict[str, float | None] = {}
    for key, _, _, sense in BETWEEN:
        known = [sense * v for m in methods if (v := finite(m.get(key))) is not None]
        best[key] = sense * max(known) if known else None
    rows = [
        [
            element("strong", label_of(method)) if is_ours(method) else label_of(method),
            *(_marked(method.get(key), digits, best[key]) for key, _, digits, _ in BETWEEN),
            worst(method, "psnr", 2),
            duration(method.get("seconds")),
        ]
        for method in methods
    ]
    columns = ["", *(title for _, title, _, _ in BETWEEN), "worst PSNR dB", "a picture"]
    cameras, rule = figures.get("cameras"), figures.get("rule")
    said = [f"{cameras} held-out views" if cameras is not None else "", str(rule) if rule else ""]
    caption = ", ".join(word for word in said if word) or "Held-out views"
    shown = (
        picture(source, p.get("picture"), p.get("label"), f"held-out view, {p.get('label')}")
        for p in listing(figures, "pictures")
    )
    words = figures.get("words")
    return join(
        [
            table(columns, rows, caption=caption),
            _kept(figures),
            gallery(*shown),
            details("What these rows mean", paragraph(words, kind="note")) if words else "",
        ]
    )


def _kept(figures: Tree) -> Html:
    """What each way has to keep."""
    sizes = figures.get("bytes")
    if not isinstance(sizes, dict):
        return Html("")
    names = {"photographs": "photographs as they lie", "avif_50": "photographs as AVIF of quality 50",
             "scene": "our scene", "mesh": "the proxy alone"}  # fmt: skip
    said = [
        join([names.get(k, str(k).replace("_", " ")), " ", data_size(v)])
        for k, v in sizes.items()
        if finite(v) is not None
    ]
    return paragraph("What has to be kept: ", join(said, ", "), ".") if said else Html("")
