"""Sections 3 and 4: how near the drawn pictures come to the photographs, and where the rest of the decibels goes."""

from __future__ import annotations

from typing import Any

from evidence.markup import (
    Html,
    anchor,
    details,
    dig,
    element,
    finite,
    fraction,
    join,
    listing,
    megabytes,
    number,
    paragraph,
    table,
)
from evidence.page.source import GEOMETRY, Source, Tree, by_capture, capture_link, failure, origin, worst

# key, title, decimals
FIGURES = (
    ("psnr", "PSNR", 2), ("psnr_luma", "luma PSNR", 2), ("ssim", "SSIM", 4), ("flip", "FLIP", 4),
    ("psnr_full", "PSNR", 2), ("psnr_luma_full", "luma PSNR", 2), ("ssim_full", "SSIM", 4),
)  # fmt: skip
PARTS: dict[str, tuple[str, ...]] = {  # figures of a scene: label, and where they lie
    "all encoded": ("encoded",),
    "encoded, some held out": ("held_scene", "encoded"),
    "held out": ("held_scene", "held_out"),
}
LOSSES = {
    "codec": "codec", "quantisation": "quantisation", "truncation": "PCA", "resampling": "resampling",
    "left": "what stays",
}  # fmt: skip


def image_space(source: Source) -> Html:
    """Tables over all captures; then what failed, and how each was made."""
    shown, without, places = [], [], []
    for name in source.captures:
        scene = source.figures(name, "scene")
        problem = source.problem(name, GEOMETRY) or source.problem(name, "scene")
        if scene is None and problem is None:
            without.append(name)
            continue
        places.append(element("span", "", id=anchor("image", name)))
        if scene is None:
            shown.append(failure(f"{name}: this step ended with an error: {problem}"))
        else:
            shown.append(_foot(source, name, scene))
    missing = paragraph(f"Not measured in this run: {', '.join(without)}.", kind="missing") if without else ""
    return join([*places, _tables(source), missing, *shown])


def _tables(source: Source) -> Html:
    """Means, worst cameras, and what is outside the circles to leave out."""
    means, lowest, outside = [], [], []
    for name in source.captures:
        scene = source.figures(name, "scene") or {}
        for label, path in PARTS.items():
            image = dig(scene, *path)
            if not isinstance(image, dict):
                continue
            views, size = number(image.get("cameras"), 0), megabytes(_bytes_of(scene, path))
            means.append([name, label, views, size, *_figures(image)])
            lowest.append([name, label, *(worst(image, key, digits) for key, _, digits in FIGURES[:5])])
            beyond = image.get("outside")
            if isinstance(beyond, dict):
                outside.append([name, label, *(number(beyond.get(key), digits) for key, _, digits in FIGURES[:3])])
    heads, titles = ["capture", "cameras"], [title for _, title, _ in FIGURES]
    columns = [*heads, "views", "MB", *titles, "coverage"]
    groups = [("", 4), ("covered pixels", 4), ("whole frame", 3), ("", 1)]
    note = (
        "PSNR in dB, over RGB unless luma is said; FLIP: lower is better. Whole frame counts black where the proxy "
        "covers nothing. All encoded: nothing was held out."
    )
    extremes = [*heads, *(f"worst {title}" for title in titles[:4]), "worst PSNR, whole frame"]
    return join(
        [
            table(columns, means, groups=groups, left={1}, caption="Means over cameras", note=note),
            table(extremes, lowest, left={1}, caption="The worst camera of each, with its name"),
            table([*heads, *titles[:3]], outside, left={1}, caption="Outside the circles that a capture leaves out"),
        ]
    )


def _bytes_of(scene: Tree, path: tuple[str, ...]) -> Any:
    if path[0] == "held_scene":
        return dig(scene, "held_scene", "bytes")
    return dig(scene, "bytes", "total")


def _figures(image: Tree) -> list[Html]:
    return [*(number(image.get(key), digits) for key, _, digits in FIGURES), fraction(image.get("coverage"))]


def _foot(source: Source, name: str, scene: Tree) -> Html:
    """The rule by which views were held out, the command, and where the figures are from."""
    rule, command, uv = scene.get("hold_out_rule"), dig(scene, "encode", "command"), scene.get("uv")
    inner = [
        paragraph(dig(source.captures.get(name), "note")) if dig(source.captures.get(name), "note") else "",
        paragraph("Held out: ", rule) if rule else "",
        paragraph("Made with ", element("code", command)) if command else "",
        paragraph(f"In UV: SSIM {number(dig(uv, 'ssim'), 4)}, PSNR {number(dig(uv, 'psnr'), 2)} dB.") if uv else "",
        origin(source, name, "scene"),
    ]  # fmt: skip
    return details(f"{source.title(name)}: how these figures were made", *inner)


# -- losses -----------------------------------------------------------------------------------------------------------


def losses(source: Source) -> Html:
    return join([_ladders(source), by_capture(source, "losses", "losses", _capture)])


def _displacement(figures: Tree) -> Tree | None:
    """Figures of pictures moved towards their photographs."""
    found = figures.get("displacement")
    return found if isinstance(found, dict) else None


def _ladders(source: Source) -> Html:
    """Captures against losses: dB that come back when a loss is switched off, and its share of the squared error."""
    rows = []
    for name in source.captures:
        figures = source.figures(name, "losses")
        if figures is None:
            continue
        steps = {str(row.get("key")): row for row in listing(figures, "rows")}
        shares = {key: share for key in LOSSES if (share := finite(dig(steps.get(key), "share"))) is not None}
        most = max(shares, key=lambda key: shares[key], default=None)
        cells = [_loss(steps.get(key), key == most) for key in LOSSES]
        rows.append(
            [
                capture_link(source, "losses", "losses", name),
                number(dig(steps.get("file"), "psnr")),
                *cells,
                _moved(_displacement(figures)),
            ]
        )
    columns = ["capture", "PSNR of the file, dB", *LOSSES.values(), "shifts alone, overlapping the others"]
    note = (
        "Each loss is switched off when those to its left are gone already: the gain in dB, and the share of the "
        "file's squared error that goes with it; the largest share is shaded. What stays: the PSNR and share that are "
        "left. Shifts: the gain when each picture, before quantisation, is moved towards its photograph by optical "
        "flow, and the share of its own error; only what goes beyond the control below speaks of shifted surfaces."
    )
    return table(columns, rows, caption="All captures", note=note)


def _loss(row: Tree | None, largest: bool) -> Html | None:
    if row is None:
        return None
    left = row.get("key") == "left"
    decibels = number(
        row.get("psnr_of_mse", row.get("psnr")) if left else row.get("gain"), 2, sign=not left, unit=" dB"
    )
    words = element("span", fraction(row.get("share"), 0), class_="best in" if largest else "sub")
    return join([decibels, " ", words]) if row.get("gain") is not None or left else words


def _moved(found: Tree | None) -> Html | None:
    if found is None:
        return None
    share = found.get("share")
    words = element("span", fraction(share, 0), class_="sub") if finite(share) is not None else ""
    return join([number(found.get("gain"), 2, sign=True, unit=" dB"), " ", words])


def _capture(source: Source, name: str, figures: Tree) -> Html:
    cameras = figures.get("cameras")
    over = f", over {cameras} cameras" if cameras is not None else ""
    parts = [_ladder(listing(figures, "rows"), f"One loss after the other switched off{over}")]
    parts.append(_shift_table(_displacement(figures)))
    parts.append(_truth(figures.get("truth")))
    alone = _ladder(listing(figures, "alone"), "One loss switched off, all others on")
    words = figures.get("words")
    said = details("What these rows mean", paragraph(words, kind="note")) if words else ""
    return join([*parts, details("Each loss alone", alone), said])


def _ladder(rows: list[Tree], caption: str) -> Html:
    columns = ["", "PSNR dB", "luma PSNR dB", "mean squared error", "gain dB", "share of the error", "MB"]
    lines = []
    for row in rows:
        share = finite(row.get("share"))
        bar = (
            element("span", "", class_="bar", style=f"width:{max(0.0, min(share, 1.0)) * 6:.2f}em")
            if share is not None
            else ""
        )
        said = join([bar, fraction(share)]) if share is not None else row.get("left_out")
        lines.append(
            [
                row.get("title") or row.get("key"),
                number(row.get("psnr")),
                number(row.get("psnr_luma")),
                number(row.get("mse")),
                number(row.get("gain"), 2, sign=True),
                said,
                megabytes(row.get("bytes")),
            ]
        )
    return table(columns, lines, caption=caption, left={5})


def _shift_table(found: Tree | None) -> Html:
    if found is None:
        return Html("")
    rows = [
        [
            label,
            number(one.get("psnr")),
            number(one.get("gain"), 2, sign=True),
            fraction(one.get("share")),
            number(one.get("median_px")),
            number(one.get("p95_px")),
        ]
        for label, one in (
            ("drawn before quantisation", found),
            ("control: each camera's own map", found.get("control")),
        )
        if isinstance(one, dict)
    ]
    columns = ["pictures", "PSNR moved, dB", "gain dB", "share of the error", "median shift, px", "95 % below, px"]
    return table(columns, rows, caption="Geometry: moved towards the photographs by optical flow")


def _truth(truth: Any) -> Html:
    """What estimated geometry costs where the true one is known."""
    rows = []
    for part in ("encoded", "held_out"):
        for kind in ("true", "estimated"):
            one = dig(truth, part, kind)
            if isinstance(one, dict):
                moved = one.get("displacement")
                rows.append(
                    [
                        f"{part.replace('_', ' ')}, {kind} geometry",
                        number(one.get("psnr")),
                        number(one.get("psnr_luma")),
                        number(dig(truth, part, "cost")) if kind == "estimated" else "",
                        number(dig(moved, "gain"), 2, sign=True),
                        number(dig(moved, "median_px")),
                    ]
                )
    columns = ["", "PSNR dB", "luma PSNR dB", "cost of the estimate, dB", "gain by moving, dB", "median shift, px"]
    return table(columns, rows, caption="Where the true geometry is known", note=dig(truth, "words"))
