"""Sections 7 and 8: the studies of parameters, and what a reader needs to judge the figures."""

from __future__ import annotations

from typing import Any

from evidence.markup import (
    Html,
    dig,
    duration,
    element,
    escape,
    items,
    join,
    listing,
    loose,
    number,
    paragraph,
    table,
)
from evidence.page.source import Source, Tree, by_capture, moment
from evidence.page.summary import between_pixels

DEFINITIONS = {
    "covered pixel": "A pixel of a photograph on which the proxy, drawn from that camera, puts surface; with masks, "
    "also inside the mask. Coverage is their share.",
    "encoded, held out": "A held-out photograph took no part in textures, mean and weights. An encoded camera is drawn "
    "with its own weights, a held-out one with view weights at its place.",
    "PSNR": "In dB, of values rounded to 8 bits; the squared error pooled over a picture's pixels and three channels, "
    "at most 100; then the mean over cameras. Whole frame: black where nothing is drawn.",
    "luma PSNR": "The same of BT.709 luma. Video codecs in 4:2:0 halve the resolution of colour, which RGB counts and "
    "luma does not: so both stand here.",
    "SSIM": "Wang et al. 2004: Gaussian window of σ = 1.5, population covariance, mean of R, G and B; averaged over "
    "covered pixels.",
    "FLIP": "LDR-FLIP at 67 pixels per degree, the mean over covered pixels: 0 is no visible difference.",
    "in UV": "The paper's measure: a camera's texture map against its reconstruction, over the texels it sees. It "
    "knows of the decomposition and the codec, not of geometry.",
    "saving": "By how much smaller than all texture maps as PNG, the paper's comparison; the photographs' own files "
    "stand beside it.",
    "BD-rate": "Bjøntegaard's delta rate: the mean difference of log bytes over the quality that both curves reach. It "
    "holds for the presets that it names.",
    "one view from a cold file": "Seconds from a closed file, put out of the system's cache where that can be done, to "
    "one picture in memory.",
}


def studies(source: Source) -> Html:
    return by_capture(source, "studies", "studies", _study)


def _study(source: Source, name: str, figures: Tree) -> Html:
    parts: list[Any] = []
    if figures.get("title"):
        parts.append(paragraph(figures["title"]))
    for one in listing(figures, "tables"):
        columns = one.get("columns")
        found = one.get("rows")
        rows = [row for row in found if isinstance(row, list | tuple)] if isinstance(found, list | tuple) else []
        width = max([len(row) for row in rows] + [0])
        heads = list(columns) if isinstance(columns, list | tuple) else []
        heads += [""] * (width - len(heads))
        wordy = {i for i in range(1, len(heads)) if any(isinstance(row[i], str) for row in rows if i < len(row))}
        cells = [[loose(cell) for cell in row] for row in rows]
        parts.append(table(heads, cells, left=wordy, caption=one.get("title"), note=one.get("words")))
    return join(parts) or paragraph("No table.", kind="missing")


def reading(source: Source) -> Html:
    terms = [part for term, words in DEFINITIONS.items() for part in (element("dt", term), element("dd", words))]
    return join(
        [
            paragraph("Full definitions are in ", element("code", "docs/measures.md"), " of the project."),
            element("dl", *terms),
            element("h3", "Machine and run", id="run"),
            _run(source),
            element("h3", "Steps", id="steps"),
            _steps(source),
            element("h3", "Captures and their licences", id="licences"),
            _licences(source),
        ]
    )


def _run(source: Source) -> Html:
    results, machine = source.results, dig(source.results, "machine")
    lines = []
    if results.get("command"):
        lines.append(join(["Command: ", element("code", results["command"])]))
    if results.get("commit"):
        lines.append(join(["Commit ", results["commit"], " (a + says that the tree differed from it)"]))
    if results.get("started"):
        lines.append(join(["Started ", moment(results["started"]), ", took ", duration(results.get("seconds"))]))
    if machine:
        cores, memory = number(dig(machine, "cores"), 0), number(dig(machine, "memory_gb"), 0)
        hardware = [dig(machine, "processor"), f", {cores} cores, {memory} GB, Python ", dig(machine, "python")]
        lines.append(join([*hardware, ". Times are this machine's, and noisy."]))
    if results.get("schema"):
        schema, file = element("code", results["schema"]), element("code", "results.json")
        lines.append(join(["Schema ", schema, "; all figures, unrounded, are in ", file, " beside this page."]))
    return items(lines) or paragraph("Not recorded.", kind="missing")


def _steps(source: Source) -> Html:
    rows = []
    for name in source.captures:
        for step in source.steps(name):
            of, problem = source.record(name, step), source.problem(name, step)
            rows.append(
                [
                    name,
                    step,
                    dig(of, "commit"),
                    moment(dig(of, "date")) if dig(of, "date") else None,
                    duration(dig(of, "seconds")),
                    element("code", dig(of, "command")) if dig(of, "command") else None,
                    join(["error: ", problem]) if problem is not None else None,
                ]
            )
    shown = table(["capture", "step", "commit", "date", "took", "command", "result"], rows, left={1, 2, 3, 5, 6})
    return shown or paragraph("No step was run.", kind="missing")


def _licences(source: Source) -> Html:
    rows = [
        [
            element("span", name, title=source.title(name)),
            source.title(name),
            number(capture.get("views"), 0),
            between_pixels(capture.get("size")),
            capture.get("folder"),
            capture.get("licence"),
            capture.get("note"),
        ]
        for name, capture in source.captures.items()
    ]
    columns = ["capture", "title", "views", "pixels", "folder", "licence and source", "note"]
    return table(columns, rows, left={1, 4, 5, 6}) or paragraph("No captures.", kind="missing")


def left_out(source: Source) -> Html:
    """What this run did not measure, in its own words."""
    words = dig(source.results, "left_out")
    lines = [escape(w) for w in words if w] if isinstance(words, list | tuple) else []
    return join([paragraph("Left out of this run:"), items(lines)]) if lines else Html("")
