"""The report as one HTML file that needs nothing beside it: for phones, light and dark, paper, without a script.

`write(results, folder)` is what the runner calls. Every part of `results` may be missing or hold an error: the page
says so in its place.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from evidence.markup import Html, anchor, details, dig, duration, element, escape, join, link, number, paragraph, table
from evidence.page.paper import paper
from evidence.page.peers import between_cameras, peers
from evidence.page.quality import image_space, losses
from evidence.page.reading import left_out, reading, studies
from evidence.page.source import Source, failure, moment
from evidence.page.summary import summary

LARGE = 12e6  # bytes: a page of more is told of
SECTIONS: tuple[tuple[str, str, str, str | None, Callable[[Source], Html]], ...] = (
    # key, title, in the navigation, step, what draws it
    ("summary", "Summary", "Summary", None, summary),
    ("paper", "The paper's figures and table", "The paper", "paper", paper),
    ("image", "Image space: what the paper's measure hides", "Image space", "scene", image_space),
    ("losses", "Where the decibels go", "Losses", "losses", losses),
    ("peers", "Peers: the same photographs in other codecs", "Peers", "rates", peers),
    ("between", "Between the cameras", "Between cameras", "between", between_cameras),
    ("studies", "Parameter studies", "Studies", "studies", studies),
    ("reading", "How to read this report", "How to read it", None, reading),
)
# Chromium prints closed <details> by the style sheet; others need them opened.
SCRIPT = "addEventListener('beforeprint',()=>document.querySelectorAll('details').forEach(d=>{d.open=true}))"


def write(results: dict[str, Any], folder: Path) -> Path:
    """Write folder/index.html from what results.json holds; paths of pictures in it are relative to the folder.

    Warns where the page is larger than LARGE.
    """
    path = Path(folder) / "index.html"
    text = draw(Source(results, Path(folder)))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    size = path.stat().st_size
    if size > LARGE:
        warnings.warn(f"{path} has {size / 1e6:.1f} MB, most of it pictures", stacklevel=2)
    return path


def draw(source: Source) -> str:
    """The document."""
    quick = bool(dig(source.results, "quick"))
    title = "eigenfield: the evidence" + (" (quick run)" if quick else "")
    sections = [
        element("section", element("h2", f"{number_of}. {words}"), _drawn(section, source), id=key)
        for number_of, (key, words, _, _, section) in enumerate(SECTIONS, 1)
    ]
    style = Path(__file__).with_name("page.css").read_text(encoding="utf-8")
    head = (
        '<meta charset="utf-8">\n<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n<link rel="icon" href="data:,">\n'
        f"<title>{escape(title)}</title>\n<style>\n{style}</style>\n<script>{SCRIPT}</script>"
    )
    body = join(
        [_header(source, title, quick), _navigation(), element("main", _index(source), *sections), _footer()], "\n"
    )
    return f'<!DOCTYPE html>\n<html lang="en">\n<head>\n{head}\n</head>\n<body>\n{body}\n</body>\n</html>\n'


def _drawn(section: Callable[[Source], Html], source: Source) -> Html:
    try:
        return section(source) or paragraph("Nothing was measured for this section.", kind="missing")
    except Exception as error:  # one odd figure must not cost the page of a run of hours
        return failure(f"This section could not be shown ({type(error).__name__}: {error})")


def _header(source: Source, title: str, quick: bool) -> Html:
    results, count = source.results, len(source.captures)
    facts = [
        f"{count} capture{'s' * (count != 1)}",
        f"commit {results['commit']}" if results.get("commit") else "",
        moment(results["started"]) if results.get("started") else "",
        join(["took ", duration(results["seconds"])]) if results.get("seconds") is not None else "",
        join([dig(results, "machine", "processor"), ", ", number(dig(results, "machine", "cores"), 0), " cores"])
        if dig(results, "machine", "processor")
        else "",
    ]
    what = (
        "Photographs of camera arrays as eigen textures on a proxy: the evaluation of Volino, Mustafa, Guillemaut and "
        "Hilton (3DV 2019) done again, the same scenes in image space, and other codecs on the same photographs."
    )
    short = (
        paragraph(element("strong", "A quick run:"), " fewer captures, rates and studies than the full one.")
        if quick
        else ""
    )
    return element(
        "header",
        element("h1", title),
        paragraph(join([fact for fact in facts if fact], " · "), kind="note"),
        paragraph(what),
        short,
        left_out(source),
    )


def _navigation() -> Html:
    links = [element("li", link(key, short)) for key, _, short, *_ in SECTIONS]
    return element("nav", element("ul", *links), class_="top", aria_label="sections")


def _index(source: Source) -> Html:
    """Captures against sections, each cell a link to its part."""
    shown = [(key, short, step) for key, _, short, step, _ in SECTIONS if step is not None]
    rows = []
    for name in source.captures:
        cells = []
        for key, _, step in shown:
            failed, there = source.problem(name, step) is not None, source.figures(name, step) is not None
            target = key if failed and key == "image" else anchor(key, name)
            cells.append(link(target, "error" if failed else "see") if failed or there else None)
        rows.append([name, *cells])
    if not rows:
        return Html("")
    columns = ["capture", *(short for _, short, _ in shown)]
    return details("Contents by capture", table(columns, rows))


def _footer() -> Html:
    program, file = element("code", "benchmarks/report.py"), element("code", "results.json")
    return element("footer", paragraph("Written by ", program, "; figures are in ", file, "."))
