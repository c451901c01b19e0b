"""Fitted files beside codecs, for docs/benchmarks.md and the README, made from benchmarks/results/rate.json
(benchmarks/rate.py)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from evaluation_tables import NONE, newest, origin, percent, table
from evidence import rates
from measure import RESULTS, runs

ANCHOR, FASTER = "SVT-AV1 preset 2, 4:2:0", "SVT-AV1 preset 6, 4:2:0"

DEFAULT = 89  # the default's quality
BALANCED = 88  # the quality measured that is nearest the default's
KEYS = ("psnr", "psnr_luma")
FIVE = {  # of the README: far ahead of the codec, about level, far behind
    "tarot": "289 views of a gantry, a glass ball",
    "shop": "9 x 9 cameras, rendered, much detail",
    "boxes": "9 x 9 cameras, rendered, sharp edges",
    "cube": "13 hand-held phone pictures all round",
    "fern": "20 hand-held pictures of thin leaves",
}


def section() -> str:
    """The section; nothing before anything was measured."""
    if not (RESULTS / "rate.json").exists():
        return ""
    captures, shown = newest(runs("rate"))
    source = origin(shown, "../benchmarks/results/rate.json")
    return (
        "## Fitted files (the default of `encode`) beside AV1\n\nEvery byte of the `.glb` counts, mesh and cameras"
        " included. The codec stores the captured views as one video with one key frame, in the best of three orders;"
        " it has no view between its frames. Percentages compare bytes at equal quality: with a minus our file is"
        " smaller; – means that the codec was not measured at that quality.\n\n"
        f"### Quality {BALANCED} (the default is 89)\n\n{_overview(captures)}\n"
        f"### All qualities, beside {ANCHOR}\n\n{_points(captures)}\n"
        f"### Bjøntegaard rates, and the fit before coding\n\n{_deltas(captures)}\n{source}\n{_studies()}"
    )


def five() -> str:
    """The README's table; hand-held captures are of bare photographs (benchmarks/photographs.py --hand-held)."""
    captures, _ = newest(runs("rate"))
    bare, _ = newest(runs("hand-held"))
    rows = []
    for name, what in FIVE.items():
        point, peers = _default(captures[name])
        point = bare.get(name, point)
        rows.append([
            f"`{name}`: {what}", f"{point['bytes'] / 1e3:.0f} kB", f"{point['psnr_luma']:.1f} dB",
            f"{point['ssim']:.3f}", _saved(point, _curve(peers, ANCHOR), "psnr_luma"),
        ])  # fmt: skip
    return table(["capture", "file", "luma PSNR", "SSIM", "bytes relative to AV1"], rows) + "\n"


def _overview(captures: Mapping[str, Any]) -> str:
    """What `encode` makes by default beside the codec, every capture in a row."""
    rows = []
    for name, one in captures.items():
        point, peers = _default(one)
        against = [" / ".join(_saved(point, _curve(peers, label), key) for key in KEYS) for label in (ANCHOR, FASTER)]
        rows.append([
            f"`{name}`", str(one["views"]), f"{point['bytes'] / 1e3:.0f}",
            f"{point['psnr']:.2f} / {point['psnr_luma']:.2f}", f"{point['ssim']:.3f}", *against,
        ])  # fmt: skip
    return table(["capture", "views", "kB", "RGB / luma dB", "SSIM", f"bytes: {ANCHOR}", FASTER], rows)


def _default(one: Mapping[str, Any]) -> tuple[Mapping[str, Any], Sequence[Mapping[str, Any]]]:
    """Our point nearest the default's quality, and the peers' curves."""
    mine, *peers = one["curves"]
    return min(mine["points"], key=lambda point: abs(point["parameter"] - BALANCED)), peers


def _studies() -> str:
    """What each part of the fit contributes, and held-out views against bytes (benchmarks/fit_studies.py)."""
    if not (RESULTS / "fit-studies.json").exists():
        return ""
    source = "../benchmarks/results/fit-studies.json"
    parts, shown = newest(_runs_with("parts"))
    text = ""
    if parts:
        text += (
            "### What each part of the fit contributes\n\nEach cell is the fit without a part: by how much the file is"
            " larger at equal RGB PSNR, and the pictures are better at equal bytes. With a minus they are smaller, or"
            " worse. Dense arrays have every second row and column. Photographs of more than half a megapixel have half"
            " their size.\n\n"
            f"{_parts(parts)}\n{origin(shown, source)}\n\n"
        )
    held, shown = newest(_runs_with("held_out"))
    rows = [
        [f"`{name}`, {found['held_out']['rule']}", *_held(point)]
        for name, found in held.items()
        for point in found["held_out"]["points"]
    ]
    if rows:
        head = ["held out", "kB", "N", "captured views, RGB / luma", "held-out views", "outside circles"]
        text += f"### Views that were held out\n\n{table(head, rows)}\n{origin(shown, source)}\n"
    return text


def _runs_with(study: str) -> list[dict[str, Any]]:
    """The runs of benchmarks/fit_studies.py that hold one of its two studies."""
    return [run for run in runs("fit-studies") if any(study in one for one in run["captures"].values())]


def _parts(captures: Mapping[str, Any]) -> str:
    """A part in each row, a capture in each column; a part that is not about a capture has none there."""
    found = {name: one["parts"] for name, one in captures.items()}
    words = {key: part["words"] for parts in found.values() for key, part in parts.items() if key != "whole"}
    rows = [[words[key], *(_lost(parts.get(key)) for parts in found.values())] for key in words]
    sizes = ["the whole fit", *(f"{_at_default(one['whole'])['bytes'] / 1e3:.1f} kB" for one in found.values())]
    return table(["without", *(f"`{name}`" for name in found)], [sizes, *rows])


def _at_default(whole: Mapping[str, Any]) -> Mapping[str, Any]:
    return next(point for point in whole["points"] if point["parameter"] == DEFAULT)


def _lost(part: Mapping[str, Any] | None) -> str:
    return NONE if part is None else f"{part['rate']['psnr']:+.1f} %, {part['gain']['psnr']:+.2f} dB"


def _held(point: Mapping[str, Any]) -> list[str]:
    return [
        f"{point['bytes'] / 1e3:.1f}", str(point["textures"]), _both(point["encoded"]), _both(point["held_out"]),
        _outside(point["held_out"]),
    ]  # fmt: skip


def _both(figures: Mapping[str, Any]) -> str:
    return f"{figures['psnr']:.2f} / {figures['psnr_luma']:.2f}"


def _outside(figures: Mapping[str, Any]) -> str:
    """The same without what the capture's circles leave out, where there are some."""
    found = figures.get("outside")
    return NONE if not found else _both(found)


def _curve(peers: Sequence[Mapping[str, Any]], name: str) -> Mapping[str, Any] | None:
    """A peer's curve, None where it was not measured."""
    return next((one for one in peers if one["name"] == name), None)


def _points(captures: Mapping[str, Any]) -> str:
    """Each of our points, and what the anchor needs for the same figure."""
    rows = []
    for name, one in captures.items():
        mine, *others = one["curves"]
        anchor = _curve(others, ANCHOR)
        rows += [_row(f"`{name}`", point, anchor) for point in mine["points"]]
        patient = one.get("best") or {"points": []}
        rows += [_row(f"`{name}`, `best`", point, anchor) for point in patient["points"]]
    head = ["capture", "quality", "N", "kB", "RGB / luma dB", "SSIM", "at equal RGB / luma / SSIM"]
    return table(head, rows)


def _row(name: str, point: Mapping[str, Any], anchor: Mapping[str, Any] | None) -> list[str]:
    return [
        name, str(point["parameter"]), str(point["textures"]), f"{point['bytes'] / 1e3:.1f}",
        f"{point['psnr']:.2f} / {point['psnr_luma']:.2f}", f"{point['ssim']:.4f}",
        " / ".join(_saved(point, anchor, key) for key in ("psnr", "psnr_luma", "ssim")),
    ]  # fmt: skip


def _saved(point: Mapping[str, Any], anchor: Mapping[str, Any] | None, key: str) -> str:
    theirs = None if anchor is None else rates.bytes_at(anchor["points"], point[key], key)
    return NONE if theirs is None else f"{100 * (point['bytes'] / theirs - 1):+.0f} %"


def _deltas(captures: Mapping[str, Any]) -> str:
    """Bjøntegaard's rates against all peers, and what no coding costs."""
    rows = []
    for name, one in captures.items():
        mine = one["curves"][0]
        fit = mine["fits"]["balanced"]
        open_loop = " / ".join(f"{fit['uncoded'][plane]:.2f}" for plane in ("luma", "chroma"))
        for other in one["curves"][1:]:
            of = one["bd"][other["name"]]
            rows.append([
                f"`{name}`", f"{other['name']}, {other['order']}", percent(of["psnr"]), percent(of["psnr_luma"]),
                percent(of["ssim"]), open_loop, f"{fit['seconds']:.0f}",
            ])  # fmt: skip
    head = ["capture", "against", "BD-rate RGB", "luma", "SSIM", "ours uncoded (balanced), luma / chroma dB", "fit s"]
    return table(head, rows)
