"""Section 1: all captures in one table, what was encoded, and between them the verdicts in words."""

from __future__ import annotations

from typing import Any

from evidence.markup import (
    Html,
    between,
    change,
    data_size,
    dig,
    duration,
    element,
    finite,
    fraction,
    join,
    megabytes,
    number,
    paragraph,
    percent,
    table,
)
from evidence.page.source import GEOMETRY, Source, Tree, capture_link, headline_rate, held_out, scene_bytes, shaded
from evidence.page.verdicts import verdicts


def summary(source: Source) -> Html:
    return join([_headline(source), verdicts(source), _files(source)])


def _headline(source: Source) -> Html:
    columns = [
        "capture", "views", "pixels", "MB", "photographs", "texture maps", "PSNR dB", "SSIM", "FLIP",
        "PSNR dB", "coverage", "RGB", "luma",
    ]  # fmt: skip
    groups = [
        ("", 4),
        ("MB against", 2),
        ("encoded cameras", 3),
        ("held out", 1),
        ("", 1),
        ("BD-rate, SVT-AV1 preset 2", 2),
    ]
    rows = []
    for name, capture in source.captures.items():
        scene, sizes = source.figures(name, "scene"), dig(source.figures(name, "paper"), "table")
        total, encoded = scene_bytes(source, name), dig(scene, "encoded")
        failed = [step for step in source.steps(name) if source.problem(name, step) is not None]
        rows.append(
            [
                join([capture_link(source, "image", "scene", name), _failed(failed)]),
                number(capture.get("views"), 0),
                between_pixels(capture.get("size")),
                megabytes(total),
                *_against(capture, scene, sizes),
                number(dig(encoded, "psnr")),
                number(dig(encoded, "ssim"), 3),
                number(dig(encoded, "flip"), 3),
                number(dig(held_out(scene), "psnr")),
                fraction(dig(encoded, "coverage")),
                shaded(headline_rate(source, name, "psnr")),
                shaded(headline_rate(source, name, "psnr_luma")),
            ]
        )
    if not rows:
        return paragraph("No capture was measured.", kind="missing")
    note = (
        "MB is the scene file, its codec's loss in all figures. MB against: by how much it is smaller (−) or larger "
        "(+) than the photographs' files as they lie on the disk, and than all texture maps as PNG (the paper's "
        "comparison). PSNR, SSIM and FLIP are means over cameras, on covered pixels; coverage is how much of the frame "
        "that is. Held out: from a scene made without those photographs. BD-rate: by how much more (+) or fewer (−) "
        "bytes the scene needs at equal quality over the cameras it was made from; shaded: the peer needs fewer."
    )
    return table(columns, rows, groups=groups, caption="All captures", note=note)


def _failed(steps: list[str]) -> Html:
    return element("div", "failed: " + ", ".join(steps), class_="sub") if steps else Html("")


def _against(capture: Tree, scene: Tree | None, sizes: Any) -> list[Html]:
    """The file against photographs and texture maps; nothing of captures on which compression means nothing."""
    if capture.get("compression") is False:
        return [percent(None), percent(None)]
    total, found = dig(scene, "bytes", "total"), []
    for ratio, size in (("photographs", "photographs_bytes"), ("texture_maps_png", "maps_png_bytes")):
        times = finite(dig(scene, "ratio", ratio))
        found.append(percent(100 / times - 100 if times else change(total, dig(sizes, size)), sign=True))
    return found


def between_pixels(size: Any) -> Html:
    """[512, 512] as 512 × 512."""
    return join((number(v, 0) for v in size), " × ") if isinstance(size, list | tuple) and size else number(size, 0)


def _files(source: Source) -> Html:
    """What was encoded, and where its bytes and seconds went."""
    columns = ["capture", "textures", "density", "atlas", "MB", "mean", "textures", "weights", "mesh", "other"]
    columns += ["encode", "peak MB", "estimated in", "peak MB"]
    rows = []
    for name in source.captures:
        scene = source.figures(name, "scene")
        if scene is None:
            continue
        total = finite(scene_bytes(source, name))
        shares = [
            _of_total(dig(scene, "bytes", part), total) for part in ("mean", "textures", "weights", "mesh", "other")
        ]
        made = source.figures(name, GEOMETRY) or {}
        given = made.get("reconstructed") is False
        rows.append(
            [
                capture_link(source, "image", "scene", name),
                number(scene.get("textures"), 0),
                number(scene.get("density"), 2),
                between_pixels(scene.get("atlas")),
                megabytes(total),
                *shares,
                duration(dig(scene, "encode", "seconds")),
                number(dig(scene, "encode", "peak_mb"), 0),
                "with the capture" if given else duration(dig(made, "seconds")),
                number(dig(made, "peak_mb"), 0),
            ]
        )
    groups = [("", 4), ("the file: MB and shares", 6), ("making the file", 2), ("cameras and proxy", 2)]
    return table(columns, rows, groups=groups, caption="What was encoded") if rows else Html("")


def _of_total(part: Any, total: float | None) -> Html:
    known = finite(part)
    return percent(100 * known / total) if known is not None and total else data_size(part)


def paper_sentence(paper: Any) -> Html:
    """The paper's own headline, for comparison."""
    textures, views, rate, most = (
        number(dig(paper, k), 0) for k in ("ssim_098_textures", "views", "fps", "fps_textures")
    )
    size, saving = between(dig(paper, "megabytes"), 1, " MB"), between(dig(paper, "saving_percent"), 0, "\u202f%")
    abstract = percent(dig(paper, "abstract_saving"), 0)
    return paragraph(
        f"The paper: SSIM 0.98 with {textures} textures from {views} views, {size}, {saving} smaller than the texture "
        f"maps (its abstract: {abstract}), over {rate} frames per second with up to {most} textures on a ",
        dig(paper, "gpu"), ". ", dig(paper, "note") or "",
    )  # fmt: skip
