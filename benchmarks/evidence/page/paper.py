"""Section 2: the paper's figures 5 and 6, its table 1 and its frame rates, with its own numbers beside ours."""

from __future__ import annotations

from typing import Any

from evidence.charts import Level, Series, line_chart
from evidence.markup import (
    Html,
    between,
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
    percent,
    table,
)
from evidence.page.source import Source, Tree, by_capture, capture_link, gallery, picture
from evidence.page.summary import between_pixels, paper_sentence

ENOUGH = 0.98  # the SSIM at which the paper says how many textures it needs
WAYS = {"plain": "without alignment", "aligned": "with alignment"}


def paper(source: Source) -> Html:
    said = dig(source.results, "paper")
    return join(
        [paper_sentence(said) if said else "", _overview(source), by_capture(source, "paper", "paper", _capture)]
    )


def _overview(source: Source) -> Html:
    """Every capture beside the paper: textures for SSIM 0.98, and what they cost."""
    said = dig(source.results, "paper")
    rows: list[list[Any]] = []
    if said:
        rows.append(
            [
                element("span", "the paper, Tarot", class_="paper"), number(dig(said, "views"), 0), "",
                number(dig(said, "ssim_098_textures"), 0), between(dig(said, "megabytes"), 1),
                between(dig(said, "saving_percent"), 0, "\u202f%"), join(["> ", number(dig(said, "fps"), 0)]), "",
            ]
        )  # fmt: skip
    for name, capture in source.captures.items():
        figures = source.figures(name, "paper")
        if figures is None:
            continue
        curve = listing(figures, "curve")
        reached = {way: _reached(curve, way) for way in WAYS}
        cheapest = min((r for r in reached.values() if r), key=lambda r: r["textures"], default=None)
        most = dig(said, "fps_textures")
        rate = next((one for one in listing(figures, "fps") if one.get("textures") == most), None)
        cells: list[Any] = [
            capture_link(source, "paper", "paper", name),
            number(capture.get("views"), 0),
            *(_textures(reached[way], curve, way) for way in WAYS),
            megabytes(dig(cheapest, "bytes")),
            fraction(dig(cheapest, "saving")),
            number(dig(rate, "bilinear"), 0),
            number(dig(rate, "bicubic"), 0),
        ]
        rows.append(cells)
    columns = ["capture", "views", *WAYS.values(), "MB there", "saving there", "bilinear", "bicubic"]
    rated = number(dig(said, "fps_textures"), 0) if dig(said, "fps_textures") else "most"
    groups = [("", 2), ("textures for SSIM 0.98", 2), ("", 2), (join(["frames per second, ", rated, " textures"]), 2)]
    note = (
        "Textures for SSIM 0.98: the fewest measured whose mean SSIM in UV is 0.98 or more; > n: not with the n "
        "that were measured. MB and saving as the paper counts, at the fewer of the two. The paper's frame rate is its "
        "graphics card's, and a lower bound; ours is the software renderer's on the machine of this run, without a GPU."
    )
    return table(columns, rows, groups=groups, caption="Beside the paper", note=note) if rows else Html("")


def _reached(curve: list[Tree], way: str) -> Tree | None:
    """The first point of the curve with SSIM 0.98."""
    points = [{**dig(p, way), "textures": count} for p in curve
              if (count := finite(p.get("textures"))) is not None and isinstance(dig(p, way), dict)]  # fmt: skip
    points.sort(key=lambda p: p["textures"])
    return next((p for p in points if (finite(p.get("uv_ssim")) or 0) >= ENOUGH), None)


def _textures(reached: Tree | None, curve: list[Tree], way: str) -> Html | None:
    if reached:
        return number(reached["textures"], 0)
    counts = [finite(p.get("textures")) for p in curve if dig(p, way, "uv_ssim") is not None]
    most = max((c for c in counts if c is not None), default=None)
    return None if most is None else join(["> ", number(most, 0)])


def _capture(source: Source, name: str, figures: Tree) -> Html:
    said = dig(source.results, "paper")
    curve = listing(figures, "curve")
    charts = []
    if curve:
        level = [Level(ENOUGH, "0.98")]
        charts = [
            _curve(curve, "uv_ssim", "SSIM in UV", "Figures 5a, 5b: SSIM against textures", level, ()),
            _curve(curve, "saving", "saving, %", "Figure 5c: storage saving", *_paper_savings(said)),
        ]
    charts.append(_frames(figures, said))
    more = _curve(curve, "uv_psnr", "PSNR in UV, dB", "PSNR against textures", [], ()) if curve else ""
    return join(
        [
            element("div", *charts, class_="charts"),
            _table_1(figures, said),
            *(_pictures_6(source, row) for row in listing(figures, "figure6")),
            details("PSNR in UV, and every point of the curves", more, _points(curve)),
        ]
    )


def _points(curve: list[Tree]) -> Html:
    keys = ("uv_ssim", "uv_psnr", "bytes", "saving")
    rows = []
    for point in curve:
        cells: list[Any] = [number(point.get("textures"), 0)]
        for way in WAYS:
            ssim, psnr, size, saving = (dig(point, way, key) for key in keys)
            cells += [number(ssim, 4), number(psnr, 2), megabytes(size), fraction(saving)]
        rows.append(cells)
    columns = ["textures", *(2 * ["SSIM", "PSNR dB", "MB", "saving"])]
    return table(columns, rows, groups=[("", 1), *((words, 4) for words in WAYS.values())])


def _curve(curve: list[Tree], key: str, label: str, title: str, levels: list[Level], notes: tuple[str, ...]) -> Html:
    scale = 100 if key == "saving" else 1
    series = []
    for slot, (way, words) in enumerate(WAYS.items()):
        points = [(p.get("textures"), None if (v := finite(dig(p, way, key))) is None else scale * v) for p in curve]
        series.append(Series(words, points, slot=1 - slot))  # what the scene does by default is ours
    return line_chart(series, "eigen textures", label, title=title, levels=levels, notes=notes)


def _paper_savings(said: Any) -> tuple[list[Level], tuple[str, ...]]:
    values = dig(said, "saving_percent")
    if not isinstance(values, list | tuple) or not values:
        return [], ()
    least = min((v for v in map(finite, values) if v is not None), default=None)
    if least is None:
        return [], ()
    counts = number(dig(said, "ssim_098_textures"), 0)
    words = f"The line is the lower end of the paper's {between(values, 0)} % (at SSIM 0.98, {counts} textures)."
    return [Level(least, f"the paper: {least:g} %")], (words,)


def _frames(figures: Tree, said: Any) -> Html:
    rates = listing(figures, "fps")
    if not rates:
        return Html("")
    series = [
        Series(f"software renderer, {way}", [(r.get("textures"), r.get(way)) for r in rates], slot)
        for slot, way in ((1, "bilinear"), (0, "bicubic"))
    ]
    size = between_pixels(dig(figures, "view")) if dig(figures, "view") else None
    notes = [f"Pictures of {size} pixels, the viewpoint moving."] if size else []
    levels = []
    rate = finite(dig(said, "fps"))
    if rate is not None:
        levels = [Level(rate, f"the paper: over {rate:g}")]
        notes.append(
            f"The paper's line: up to {dig(said, 'fps_textures')} textures on a {dig(said, 'gpu')}; ours has no GPU."
        )
    return line_chart(
        series, "eigen textures", "frames per second", title="Frames per second", y_log=True, levels=levels, notes=notes
    )


def _table_1(figures: Tree, said: Any) -> Html:
    sizes = dig(figures, "table")
    if not isinstance(sizes, dict):
        return Html("")
    maps = finite(sizes.get("maps_png_bytes"))

    def share(value: Any) -> Html:
        known = finite(value)
        return percent(100 * known / maps) if known is not None and maps else percent(None)

    rows: list[list[Any]] = [
        [words, "", "", "", megabytes(sizes.get(key)), share(sizes.get(key)), "", "", ""]
        for words, key in (
            ("photographs, three bytes a pixel", "raw_bytes"),
            ("photographs, as they are", "photographs_bytes"),
            ("texture maps, PNG", "maps_png_bytes"),
        )
    ]
    for row in listing(sizes, "rows"):
        missed = row.get("not_reached")
        rows.append(
            [
                join([row.get("label"), ": not reached" if missed else ""]),
                join(["> ", number(row.get("most"), 0)]) if missed else number(row.get("textures"), 0),
                number(row.get("aligned")),
                number(row.get("uv_ssim"), 4),
                megabytes(row.get("bytes")),
                percent(row.get("percent_of_maps")),
                fraction(row.get("saving")),
                megabytes(row.get("file_bytes")),
                fraction(row.get("file_saving")),
            ]
        )
    if said:
        values = dig(said, "saving_percent")
        ends = [100 - v for v in map(finite, reversed(values)) if v is not None] if isinstance(values, list) else None
        rows.append(
            [
                element("span", f"the paper, Tarot, {number(dig(said, 'views'), 0)} views", class_="paper"),
                number(dig(said, "ssim_098_textures"), 0), "", number(ENOUGH, 2), between(dig(said, "megabytes"), 1),
                between(ends, 0, "\u202f%") if ends else None, between(values, 0, "\u202f%"), "", "",
            ]
        )  # fmt: skip
    columns = ["", "textures", "aligned", "SSIM in UV", "MB", "of texture maps", "saving", "MB", "saving"]
    groups = [("", 4), ("as the paper counts", 3), ("our whole file", 2)]
    note = (
        "As the paper counts: mean and textures as 8-bit PNG, weights as floats, no mesh. Our whole file: as "
        "eigenfield writes it, with the mesh. Saving: against the texture maps as PNG."
    )
    caption = "Table 1: what the photographs, their texture maps and the eigen textures weigh"
    return table(columns, rows, groups=groups, caption=caption, note=note)


def _pictures_6(source: Source, row: Tree) -> Html:
    camera = str(row.get("camera", "?"))
    columns = {
        "photograph": ("photograph", None), "proxy": ("proxy", None), "own_map": ("its own texture map", "psnr_own"),
        "eigen": ("eigen textures", "psnr_eigen"), "error": ("error × 5", None),
    }  # fmt: skip
    shown = []
    for key, (words, figure) in columns.items():
        decibels = number(row.get(figure), 2, unit=" dB") if figure and finite(row.get(figure)) is not None else ""
        shown.append(picture(source, row.get(key), join([words, decibels], " "), f"{words}, camera {camera}"))
    heading = paragraph("Figure 6, camera ", element("code", camera))
    return join([heading, gallery(*shown)]) if any(shown) else Html("")
