"""The tables of docs/benchmarks.md and the README, made from benchmarks/results; `--check` fails where they differ.

python benchmarks/tables.py [--check]
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import plots
from evidence import rates
from evidence.between import TITLES
from measure import RESULTS, latest, runs

Captures = dict[str, dict[str, Any]]

README = Path(__file__).parents[1] / "README.md"
BENCHMARKS = README.parent / "docs" / "benchmarks.md"
BEGIN, END = "<!-- figures -->\n", "<!-- end of figures -->\n"
NONE = "–"
ORDER = (  # of captures in tables
    "tarot", "antinous", "boxes", "shop", "tarot-5x4", "cube", "cube_colmap_mesh", "fern", "fox", "fountain", "temple",
    "jellybeans", "amethyst", "demo",
)  # fmt: skip

# Fitted files
ANCHOR, FASTER = "SVT-AV1 preset 2, 4:2:0", "SVT-AV1 preset 6, 4:2:0"
BALANCED = 88  # the quality measured that is nearest the default's
SHOWN = (70, 84, 94, 97)  # qualities of the table of all; rate.json has more
KEYS = ("psnr", "psnr_luma")
FIVE = {  # of the README: far ahead of the codec, about level, far behind
    "tarot": "289 views of a gantry, a glass ball",
    "shop": "9 x 9 cameras, rendered, much detail",
    "boxes": "9 x 9 cameras, rendered, sharp edges",
    "cube": "13 hand-held phone pictures all round",
    "fern": "20 hand-held pictures of thin leaves",
}

# The paper's way
ANCHORS = (ANCHOR, FASTER, "libaom cpu 6, 4:4:4", "AVIF a view, 4:4:4")
WAYS = {
    "nearest": "nearest photograph",
    "blend": "blended photographs",
    "lumigraph": "lumigraph",
    "delaunay": "eigenfield",
}
RUNGS = ("codec", "quantisation", "truncation", "resampling")
CAPTURES = ("tarot", "tarot-5x4", "cube", "demo")
SCENES = (
    "tarot-all", "tarot", "tarot-blind", "tarot-5x4", "amethyst", "jellybeans", "shop", "boxes", "antinous", "fern",
    "cube", "fountain", "fox", "temple",
)  # fmt: skip
DRAWN = {"bilinear": "bilinear", "bicubic": "bicubic", "bicubic_one_sample": "bicubic, one sample"}  # in render.json


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def decimals(value: Any, places: int = 2, unit: str = "") -> str:
    """A figure in words; a dash where there is none."""
    return NONE if value is None else f"{value:.{places}f}{unit}"


def percent(value: float | None) -> str:
    return NONE if value is None else f"{value:+.0f} %"


def both(scores: Mapping[str, Any]) -> str:
    return f"{decimals(scores.get('psnr'))} / {decimals(scores.get('psnr_luma'))}"


def newest(name: str) -> tuple[Captures, str]:
    """Each capture of results/NAME.json as its newest run measured it, and where these runs come from."""
    history = runs(name)
    last = {capture: number for number, run in enumerate(history) for capture in run["captures"]}
    known = sorted(last, key=lambda capture: ORDER.index(capture) if capture in ORDER else len(ORDER))
    captures = {capture: history[last[capture]]["captures"][capture] for capture in known}
    return captures, origin(name, [history[number] for number in sorted(set(last.values()))])


def origin(name: str, shown: Sequence[Mapping[str, Any]]) -> str:
    """The command, commits, machines and dates of runs of results/NAME.json, each named once."""

    def once(words: Sequence[str]) -> str:
        return ", ".join(dict.fromkeys(words))

    commands = [str(run["command"]) for run in shown]
    command = commands[0] if len(set(commands)) == 1 else " ".join(commands[0].split()[:2])
    commits = once([commit for run in shown for commit in run.get("commits") or [run["commit"]]])
    machines = once([f"{run['machine']['processor']} with {run['machine']['cores']} cores" for run in shown])
    dates = once([run["date"][:10] for run in (shown[0], shown[-1])]).replace(", ", " to ")
    return f"[`{command}`](../benchmarks/results/{name}.json), commit {commits}, {machines}, {dates}.\n"


# -- fitted files ---------------------------------------------------------------------------------------------------


def fitted() -> str:
    """Fitted files beside codecs (benchmarks/rate.py)."""
    captures, source = newest("rate")
    return (
        "## Fitted files (the default of `encode`) beside AV1\n\nEvery byte of the `.glb` counts, mesh and cameras"
        " included. The codec stores the captured views as one video with one key frame, in the best of three orders;"
        " it has no view between its frames. Percentages compare bytes at equal quality: with a minus our file is"
        " smaller; – means that the codec was not measured at that quality.\n\n"
        f"### Quality {BALANCED} (the default is 89)\n\n{_overview(captures)}\n"
        f"### Other qualities, beside {ANCHOR}\n\n{_points(captures)}\n"
        "### Bjøntegaard rates, and the fit before coding\n\nBytes that our file takes more (+) or less (-) at equal"
        f" RGB / luma PSNR / SSIM, over the qualities that both curves share.\n\n{_deltas(captures)}\n{source}\n"
    )


def five() -> str:
    """The README's table; hand-held captures are of bare photographs (benchmarks/photographs.py --hand-held)."""
    captures, _ = newest("rate")
    bare, _ = newest("hand-held")
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
            both(point), f"{point['ssim']:.3f}", *against,
        ])  # fmt: skip
    return table(["capture", "views", "kB", "RGB / luma dB", "SSIM", f"bytes: {ANCHOR}", FASTER], rows)


def _default(one: Mapping[str, Any]) -> tuple[Mapping[str, Any], Sequence[Mapping[str, Any]]]:
    """Our point nearest the default's quality, and the peers' curves."""
    mine, *peers = one["curves"]
    return min(mine["points"], key=lambda point: abs(point["parameter"] - BALANCED)), peers


def _curve(peers: Sequence[Mapping[str, Any]], name: str) -> Mapping[str, Any] | None:
    """A peer's curve, None where it was not measured."""
    return next((one for one in peers if one["name"] == name), None)


def _points(captures: Mapping[str, Any]) -> str:
    """Each of our points, and what the anchor needs for the same figure."""
    rows = []
    for name, one in captures.items():
        mine, *others = one["curves"]
        anchor = _curve(others, ANCHOR)
        rows += [_row(f"`{name}`", point, anchor) for point in mine["points"] if point["parameter"] in SHOWN]
        patient = one.get("best") or {"points": []}
        rows += [_row(f"`{name}`, `best`", point, anchor) for point in patient["points"]]
    head = ["capture", "quality", "N", "kB", "RGB / luma dB", "SSIM", "at equal RGB / luma / SSIM"]
    return table(head, rows)


def _row(name: str, point: Mapping[str, Any], anchor: Mapping[str, Any] | None) -> list[str]:
    return [
        name, str(point["parameter"]), str(point["textures"]), f"{point['bytes'] / 1e3:.1f}",
        both(point), f"{point['ssim']:.4f}",
        " / ".join(_saved(point, anchor, key) for key in ("psnr", "psnr_luma", "ssim")),
    ]  # fmt: skip


def _saved(point: Mapping[str, Any], anchor: Mapping[str, Any] | None, key: str) -> str:
    theirs = None if anchor is None else rates.bytes_at(anchor["points"], point[key], key)
    return NONE if theirs is None else f"{100 * (point['bytes'] / theirs - 1):+.0f} %"


def _deltas(captures: Mapping[str, Any]) -> str:
    """Bjøntegaard's rates against both presets, and what no coding costs."""
    rows = []
    for name, one in captures.items():
        fit = one["curves"][0]["fits"]["balanced"]
        against = [one["bd"].get(label, {}) for label in (ANCHOR, FASTER)]
        rows.append([
            f"`{name}`", *(" / ".join(percent(of.get(key)) for key in (*KEYS, "ssim")) for of in against),
            " / ".join(f"{fit['uncoded'][plane]:.2f}" for plane in ("luma", "chroma")), f"{fit['seconds']:.0f}",
        ])  # fmt: skip
    head = ["capture", ANCHOR, FASTER, "ours uncoded (balanced), luma / chroma dB", "fit s"]
    return table(head, rows)


# -- views between the cameras ---------------------------------------------------------------------------------------


def between_cameras() -> str:
    """Held-out views beside a codec's film of equal bytes (benchmarks/between.py)."""
    captures, source = newest("between")
    head = ["capture", "what is drawn", "kB", "RGB / luma dB", "worst view", "SSIM", "FLIP", "error near depth edges"]
    rows = [_way(name, number, row) for name, one in captures.items() for number, row in enumerate(one["methods"])]
    return (
        "## Views between the cameras, at equal bytes\n\nHeld-out views, measured over the pixels that our mesh covers."
        " The codec's film holds the encoded views; it is decoded and blended as a lumigraph on our mesh, and its bytes"
        " include the mesh. Where our file has soft sheets, this mesh is the opaque surface of the same capture"
        " (`--layers 1`), also for coverage and depth edges. The last three ways of a capture need all photographs. The"
        " worst view is the lowest of each figure. The last column is the share of luma's squared error within two"
        " pixels of depth edges.\n\n"
        f"{_held_out(captures)}\n{table(head, rows)}\n{source}\n"
    )


def _held_out(captures: Mapping[str, Any]) -> str:
    rows = [
        [f"`{name}`", f"`{one['rule']}`", str(one["cameras"]), str(one["encoded"]), str(one.get("sheets", 0) or NONE),
         f"{one['mesh'] / 1e3:.1f}",
         f"{100 * one['methods'][0]['coverage']:.1f} %", f"{100 * one['methods'][0]['edge_pixels']:.0f} %"]
        for name, one in captures.items()
    ]  # fmt: skip
    head = [
        "capture", "held out", "held-out views", "encoded views", "our soft sheets", "mesh kB", "coverage",
        "pixels near depth edges",
    ]  # fmt: skip
    return table(head, rows)


def _way(name: str, number: int, row: Mapping[str, Any]) -> list[str]:
    size = f"{row['bytes'] / 1e3:.1f}" if "bytes" in row else NONE
    return [
        "" if number else f"`{name}`", TITLES[row["key"]], size, both(row), both(row["worst"]), f"{row['ssim']:.4f}",
        f"{row['flip']:.4f}", f"{100 * row['edge_share']:.0f} %",
    ]  # fmt: skip


# -- the whole evaluation (benchmarks/report.py) ---------------------------------------------------------------------


def summary(captures: Captures) -> str:
    """What every capture's file weighs and shows."""
    rows = []
    for name, one in captures.items():
        if "encoded" not in one:
            continue
        encoded, held = one["encoded"], one["held_out"] or {}
        rows.append([
            f"`{name}`", str(one["views"]), str(one["textures"]), decimals(one["bytes"]["total"] / 1e6),
            both(encoded), decimals(encoded["ssim"], 3),
            decimals(encoded.get("flip"), 3), both(held),
            decimals(held.get("ssim"), 3), decimals(100 * encoded["coverage"], 1, unit=" %"),
        ])  # fmt: skip
    head = ["capture", "views", "N", "MB", "encoded dB, RGB / luma", "SSIM", "FLIP", "held out dB, RGB / luma", "SSIM",
            "coverage"]  # fmt: skip
    return table(head, rows)


def beside_codecs(captures: Captures) -> str:
    """Bytes of ours relative to each anchor, at equal RGB and luma PSNR; where no quality is shared, a dash."""
    rows = []
    for name, one in captures.items():
        if "bd" not in one:
            continue
        cells = [one["bd"].get(anchor, {}) for anchor in ANCHORS]
        rows.append([f"`{name}`", *(f"{percent(c.get('psnr'))} / {percent(c.get('psnr_luma'))}" for c in cells)])
    return table(["capture", *ANCHORS], rows)


def losses(captures: Captures) -> str:
    """The ladder: what each loss costs in dB when those before it are switched off already."""
    rows = []
    for name, one in captures.items():
        if "losses" not in one:
            continue
        rungs = {row["key"]: row for row in one["losses"]}
        gains = [
            f"{decimals(rungs[k]['gain'])} ({100 * rungs[k]['share']:.0f} %)" if k in rungs else NONE for k in RUNGS
        ]
        rows.append([f"`{name}`", decimals(rungs["file"]["psnr"]), *gains, f"{100 * rungs['left']['share']:.0f} %"])
    head = ["capture", "file dB", "codec", "8-bit codes", "truncation to N", "resampling", "what stays"]
    return table(head, rows)


def between(captures: Captures) -> str:
    """Held-out views drawn in each way, dB over the pixels that the proxy covers."""
    rows = [
        [f"`{name}`", str(one["hold_out"]), *(decimals(one["between"].get(way, {}).get("psnr")) for way in WAYS)]
        for name, one in captures.items()
        if "between" in one
    ]
    return table(["capture", "held out", *WAYS.values()], rows)


def paper(captures: Captures) -> str:
    """The paper's measure and its way to count bytes."""
    rows = [["the paper, 289 views", "", "0.98 (aligned)", "", "15", "9.5-14.8 MB, 96-97 %", ""]]
    for name, one in captures.items():
        if "table" not in one:
            continue
        stored = {(row["label"], row["aligned"]): row for row in one["table"]["rows"]}
        curve = one["uv_curve"]
        most = max(map(int, curve["plain"]))
        at = "15" if "15" in curve["plain"] else str(most)
        needed = [_needed(stored.get(("SSIM 0.98", aligned))) for aligned in (False, True)]
        counted = stored.get(("N = 15", False)) or stored.get(("N = 7", False)) or {}
        rows.append([
            f"`{name}`", at, f"{decimals(curve['plain'].get(at), 3)} / {decimals(curve['aligned'].get(at), 3)}",
            *needed, f"{counted['bytes'] / 1e6:.1f} MB, {100 * counted['saving']:.1f} %" if counted else NONE,
            f"{counted['file_bytes'] / 1e6:.2f} MB, {100 * counted['file_saving']:.1f} %" if counted else NONE,
        ])  # fmt: skip
    head = [
        "capture",
        "N",
        "UV SSIM plain / aligned",
        "N for 0.98, plain",
        "aligned",
        "as the paper counts",
        "our file",
    ]
    return table(head, rows)


def _needed(row: dict[str, Any] | None) -> str:
    if row is None:
        return NONE
    return f"> {row['most']}" if row.get("not_reached") else str(row["textures"])


def largest(captures: Captures) -> str:
    """The losses by their median over captures, the three largest first, in words."""
    gap = [
        one["encoded_beside_held_out"]["psnr"] - one["held_out"]["psnr"]
        for one in captures.values()
        if one.get("held_out") and one.get("encoded_beside_held_out")
    ]
    found = {"from encoded to held-out cameras": gap}
    titles = {
        "codec": "the codec of the textures",
        "truncation": "truncation to N textures (it includes what wrong geometry and gloss add to the maps)",
        "resampling": "resampling into the atlas and out of it",
    }
    for key, title in titles.items():
        rows = [row for one in captures.values() for row in one.get("losses", ()) if row["key"] == key]
        found[title] = [row["gain"] for row in rows]
    known = {title: values for title, values in found.items() if values}
    order = sorted(known, key=lambda title: -float(np.median(known[title])))
    lines = [
        f"{number}. **{title}**: {np.median(known[title]):.1f} dB in the median of {len(known[title])} captures"
        f" ({min(known[title]):.1f} to {max(known[title]):.1f})"
        for number, title in enumerate(order, 1)
    ]
    return "\n".join(lines) + "\n"


def truth(captures: Captures) -> str:
    found = captures.get("demo", {}).get("truth")
    if not found:
        return ""
    cost = {kind: found[kind]["cost"] for kind in ("encoded", "held_out")}
    return (
        "\nThe demo's true geometry is known. With cameras and mesh estimated from its photographs (every second row"
        f" and column), encoded views lose {_cost(cost['encoded'])} dB and held-out views {_cost(cost['held_out'])} dB"
        " against the true ones.\n"
    )


def _cost(value: Any) -> str:
    return decimals(value["psnr"] if isinstance(value, dict) else value)


SECTIONS: tuple[tuple[str, Callable[[Captures], str]], ...] = (
    ("Every capture (15 textures, density 1.5)", summary),
    ("The paper's measure and its way to count bytes", paper),
    ("Where the decibels go", losses),
    ("Bytes relative to codecs at equal PSNR, RGB / luma (+: our file is larger)", beside_codecs),
    ("Views that were held out, dB", between),
)


def evaluation(captures: Captures) -> str:
    """The tables of the whole evaluation."""
    parts = [f"### {title}\n\n{of(captures)}\n" for title, of in SECTIONS]
    parts.insert(3, f"The losses, the largest first:\n\n{largest(captures)}{truth(captures)}\n")
    return "".join(parts)


# -- given cameras and mesh, bare photographs, time --------------------------------------------------------------------


def quality() -> str:
    results = {name: latest(f"quality-{name}") for name in CAPTURES}
    rows = []
    for name, figures in results.items():
        for label, case in figures["cases"].items():
            encoded, held = case["image"]["encoded"], case["image"]["held_out"]
            smaller = [case["ratio"][key] for key in ("photographs", "texture_maps_png")]
            rows.append([
                f"{name}, {label}", str(case["textures"]), f"{case['bytes']['total'] / 1e6:.2f}",
                f"{case['uv']['ssim']:.3f}", decibels(encoded), f"{encoded['ssim']:.3f}", decibels(held),
                "" if held is None else f"{held['ssim']:.3f}", f"{100 * encoded['coverage']:.0f} %",
                " / ".join(f"{times:.0f}" for times in smaller), f"{case['encode']['seconds']:.0f}",
                str(case["encode"]["peak_anonymous_mb"]),
            ])  # fmt: skip
    head = ["capture", "N", "MB", "UV SSIM", "encoded dB", "SSIM", "held out dB", "SSIM", "coverage",
            "smaller than photographs / maps as PNG", "encode s", "peak MB"]  # fmt: skip
    tarot, demo = results["tarot"]["cases"], results["demo"]["cases"]["all encoded"]
    before = tarot["all encoded"]["uncoded"]["image"]["encoded"]
    held = tarot["odd held out"]["uncoded"]["image"]["held_out"]
    exact = demo["exact geometry, all textures of 25 views, density 2, uncoded"]["encoded"]
    avif = {name: results[name]["cases"]["all encoded"]["maps_as_avif"]["saving"] for name in ("tarot", "demo")}
    return (
        "### Given cameras and mesh\n\nPSNR of re-drawn photographs over covered pixels, 8-bit RGB. Pictures are drawn with"
        " the bicubic filter from the decoded file. Figures in brackets leave out the glass ball. `tarot` is Stanford's"
        " capture of 289 views at 512² with an atlas of 1024²; `tarot-5x4` has 20 of these views at 1024²; `cube` is 13"
        " phone pictures on a mesh with holes; `demo` is the capture that `make demo` draws.\n\n"
        + table(head, rows)
        + f"\nBefore coding, Tarot's encoded views have {decibels(before)} dB and its held-out views (`odd`)"
        f" {decibels(held)} dB. With exact geometry (25 views of the demo), all textures and density 2, only resampling"
        f" loses anything: {decibels(exact)} dB remain. Compared with the texture maps coded as AVIF at the same UV SSIM,"
        f" the file is {100 * avif['tarot']:.1f} % smaller on Tarot and {100 * avif['demo']:.1f} % smaller on the demo.\n\n"
        + "\n".join(origin(f"quality-{name}", [figures]) for name, figures in results.items())
        + "\n"
    )


def reconstruction() -> str:
    depth, fountain, temple, stereo, rig = (
        latest(f"proxy-{name}")
        for name in ("hci-antinous", "cameras-fountain", "cameras-temple", "cameras-stereo-chart", "cameras-caliscope")
    )
    truth = [
        ["depth of `hci_antinous` (centre view, without a border of 15 pixels)",
         f"BadPix(0.07) {depth['bad_pixels_0.07']:.2f} %, BadPix(0.1) {depth['bad_pixels_0.1']:.2f} %,"
         f" MSE x 100 {depth['mse_x100']:.2f}", f"{depth['seconds']:.0f}"],
        *([f"cameras of `{name}` by structure from motion, lenses known",
           f"{figures['registered']} of {figures['photographs']} registered, at worst"
           f" {figures['rotation_degrees_worst']:.2f}° and {figures['position_percent_worst']:.2f} % of the extent",
           f"{figures['seconds']:.0f}"]
          for name, figures in (("fountain_P11_half", fountain), ("temple_ring16", temple))),
        ["stereo pair from a checkerboard (`opencv_stereo_chart`, true baseline 83.6 mm)",
         f"rms {stereo['reprojection_rms']:.2f} px, {stereo['baseline_mm']:.1f} mm", f"{stereo['seconds']:.0f}"],
        ["four cameras from videos of a ChArUco board (`caliscope_charuco_rig4`)",
         f"median {rig['reprojection_median']:.2f} px, centres within {rig['position_percent_worst']:.2f} % of the"
         " extent", f"{rig['seconds']:.0f}"],
    ]  # fmt: skip
    scenes = {name: latest(f"proxy-scene-{name}") for name in SCENES}
    rows = []
    for figures in scenes.values():
        encoded, held = figures["encoded"], figures.get("held_out")
        rows.append([
            f"`{figures['encode'].removeprefix('eigenfield encode ').replace(' --fit none', '')}`", f"{figures['bytes'] / 1e6:.2f}",
            f"{100 * (held or encoded)['coverage']:.1f} %", decibels(encoded), f"{encoded['ssim']:.3f}", decibels(held),
            "" if held is None else f"{held['ssim']:.3f}", f"{figures['seconds']:.0f}",
            str(figures["peak_anonymous_mb"]),
        ])  # fmt: skip
    head = [
        "`eigenfield encode --fit none`",
        "MB",
        "coverage",
        "encoded dB",
        "SSIM",
        "held out dB",
        "SSIM",
        "seconds",
        "peak MB",
    ]
    uncoded = scenes["tarot"]["uncoded"]["held_out"]
    return (
        "### From bare photographs\n\nCameras and geometry estimated from photographs alone, compared with the truth:\n\n"
        + table(["what is estimated", "error", "seconds"], truth)
        + "\nWhole captures, one command each. Seconds and memory include the estimation of cameras and mesh; no mesh is"
        " given. `fern`, `cube`, `fountain`, `fox` and `temple` come with a calibration. The parameter file of `boxes` and"
        " the file names of `shop` give the cameras. The other captures have file names at most.\n\n"
        + table(head, rows)
        + f"\nWith `--blind`, held-out photographs take no part in the estimation; each only registers its own camera."
        f" Before coding, Tarot's held-out views have {decibels(uncoded)} dB.\n\n"
        + origin("proxy-scene-tarot", [scenes["tarot"]])
        + "\n"
    )


def decibels(figures: dict[str, Any] | None) -> str:
    if figures is None:
        return ""
    beyond = figures["outside"]["psnr"] if "outside" in figures else figures.get("psnr_outside")
    outside = "" if beyond is None else f" ({beyond:.2f})"
    return f"{figures['psnr']:.2f}{outside}"


def encoding() -> str:
    figures = latest("encode")
    whole, half = figures["encode"], figures["encode_every_second_row"]
    pca, av1 = figures["scikit_learn_pca"], figures["svt_av1_preset_6"]
    rows = [
        ["`eigenfield encode --fit none`, 289 views, all of it", f"{whole['seconds']:.1f}", str(whole["peak_anonymous_mb"]),
         f"{whole['bytes'] / 1e6:.2f}"],
        ["the same, every second row", f"{half['seconds']:.1f}", str(half["peak_anonymous_mb"]), ""],
        ["scikit-learn PCA (randomised), its fit", f"{pca['fit_seconds']:.1f}", str(pca["peak_anonymous_mb"]), ""],
        ["SVT-AV1 preset 6, crf 40, the encoder alone", f"{av1['encode_seconds']:.1f}", str(av1["peak_anonymous_mb"]),
         f"{av1['bytes'] / 1e6:.2f}"],
    ]  # fmt: skip
    return (
        "### Encoding the paper's way\n\nTarot, atlas of 1024², 15 textures, kernels compiled before. Memory is the peak of"
        " anonymous pages.\n\n"
        + table(["what runs", "seconds", "peak MB", "MB written"], rows)
        + f"\nAll cameras need {figures['ratio']['memory_all_to_every_second_row']:.2f} times the memory of half of"
        " them.\n\n" + origin("encode", [figures]) + "\n"
    )


def drawing() -> str:
    figures = latest("render")
    rows = [
        [count, *(f"{row[way]['fps']:.0f} ({row[way]['fps_best']:.0f})" for way in DRAWN),
         f"{100 * row['share_of_bandwidth']:.0f} %"]
        for count, row in figures["relief"].items()
    ]  # fmt: skip
    if "tarot_proxy_40" in figures:
        own = figures["tarot_proxy_40"]
        rows.append(
            ["40, Tarot's proxy", *(f"{own[way]['fps']:.0f} ({own[way]['fps_best']:.0f})" for way in DRAWN), ""]
        )
    width, height = figures["view"]
    return (
        f"### Drawing\n\nFrames per second of the software renderer at {width}x{height} with an atlas of"
        f" {figures['atlas']}² on {figures['threads']} threads; the best frame is in brackets. The viewpoint moves in every"
        " frame. The paper reports over 60 frames per second up to 40 textures on a GTX 1080. Pixels at edges are the mean"
        " of four samples, except in the column of one sample. The last column relates the bytes of all textures, read"
        f" once a frame, to the memory bandwidth ({figures['read_gb_per_second']:.0f} GB/s, measured in the same run).\n\n"
        + table(["N", *DRAWN.values(), "of the bandwidth"], rows)
        + f"\nSumming 40 textures takes {figures['composition_40']['ratio_to_numpy']:.2f} of the time of NumPy's matrix"
        " product on float32 textures.\n\n" + shaded() + origin("render", [figures]) + "\n"
    )


def shaded() -> str:
    """The shader on OpenGL and in a browser: frames a second, and times the cost of a plain texture."""
    first = next(run for run in reversed(runs("render-browser")) if "first_picture_bytes" in run)  # asked for by a file
    return (
        "The browser and the OpenGL renderer share one shader. The tables give its frames per second; in brackets is the"
        " time of a frame relative to one plain texture on the same mesh (N = 0). OpenGL draws 1920x1080, and in stereo"
        " 2 x 1832x1920 with weights per texel. The browser draws 1024x768. The atlas has 1024² texels.\n\n"
        + shaded_by(gpu=True)
        + shaded_by(gpu=False)
        + "![Frames per second against the number of eigen textures](frames.png)\n\n"
        f"The viewer's script has {latest('render-browser')['bundle']['viewer.js'] / 1e3:.0f} kB, three.js included. The"
        f" first picture of the demo, encoded with `--fit none`, needs {first['first_picture_bytes'] / 1e3:.0f} of the"
        f" file's {first['demo_bytes']['total'] / 1e3:.0f} kB.\n\n"
    )


def shaded_by(gpu: bool) -> str:
    """The newest figures of the shader on a GPU, or on the processor."""
    opengl, browser = (plots.newest(name, gpu) for name in ("render-opengl", "render-browser"))

    def cell(entry: dict[str, Any] | None, fps: float | None) -> str:
        return "" if entry is None or fps is None else f"{number(fps)} ({entry['times_plain']:.1f})"

    rows = []
    for count in opengl["counts"]:
        mine, theirs = opengl["counts"][count], browser["counts"].get(count, {})
        cells = [cell(mine.get(key), mine.get(key, {}).get("fps")) for key in
                 ("mono_bilinear", "mono_bicubic", "stereo_bicubic")]  # fmt: skip
        for key in ("eye_bicubic", "ray_bicubic"):
            entry = theirs.get(key)
            cells.append(cell(entry, None if entry is None else 1e3 / entry["milliseconds"]))
        rows.append([count, *cells])
    place = "On a GPU" if gpu else "On the processor, without a GPU"
    return (
        f"{place}: {driver(opengl['driver'])}; {browser['browser']} on {driver(browser['driver'])}.\n\n"
        + table(["N", "OpenGL bilinear", "bicubic", "stereo", "browser", "by the ray"], rows)
        + "\n"
        + origin("render-opengl", [opengl])
        + "\n"
        + origin("render-browser", [browser])
        + "\n"
    )


def number(value: float) -> str:
    return f"{value:.0f}" if value >= 10 else f"{value:.1f}" if value >= 1 else f"{value:.2f}"


def driver(name: str) -> str:
    """What draws, out of ANGLE's long name for it."""
    found = re.search(r"SwiftShader|NVIDIA \w+(?= \w+ HBM)", name)
    return found[0] if found else name


def photographs() -> str:
    figures = latest("photographs")
    rows = []
    for name, case in figures["captures"].items():
        own, before, peer = case["encode"], case.get("before"), case["svt_av1_preset_6"]
        rows.append([
            f"`{name}`", *(_time_and_rate(one) for one in (own, before)), str(own["peak_mb"]),
            f"{peer['seconds']:.1f}", f"{case['ratio']['seconds_to_svt_av1']:.0f}",
        ])  # fmt: skip
    head = ["capture", "seconds, kB, dB", "before", "peak MB", "SVT-AV1, seconds", "ratio"]
    before = f" *Before* is commit {figures['before']}, in the same run." if "before" in figures else ""
    return (
        "### Encoding bare photographs\n\n`eigenfield encode` at `balanced`, cameras and surface estimated, kernels"
        f" compiled before.{before} PSNR is that of captured views, RGB. SVT-AV1 is preset 6 at crf {figures['crf']}, on the same views in the order of their"
        " names.\n\n" + table(head, rows) + "\n" + origin("photographs", [figures]) + "\n"
    )  # fmt: skip


def _time_and_rate(case: dict[str, Any] | None) -> str:
    return "" if case is None else f"{case['seconds']:.0f}, {case['bytes'] / 1e3:.0f}, {case['psnr']:.2f}"


def batches() -> str:
    figures = latest("batch")
    names = {"one_process": "one process", "processes": "a process a processor", "cluster": "a Dask cluster"}
    rows = [
        [words, f"{way['seconds']:.0f}", f"{way['ratio']:.2f}", f"{100 * way['overhead']:.1f} %"]
        for name, words in names.items()
        if (way := figures.get(name))
    ]
    return (
        f"### Many captures\n\n{figures['instants']} instants of the demo's array, 25 views of 256² each, by `eigenfield"
        f" batch --preset small` with the mesh given. {figures['workers']} workers of one thread stand against one"
        f" process of {figures['workers']} threads. The overhead is the time in which workers had no capture, as a share"
        " of that in which they had one. The scenes are equal to the byte.\n\n"
        + table(["where", "seconds", "of one process", "overhead"], rows)
        + "\n" + origin("batch", [figures]) + "\n"
    )  # fmt: skip


def clips() -> str:
    """Clips beside streams of their cameras (benchmarks/video.py); nothing before they are measured."""
    if not (RESULTS / "video.json").exists():
        return ""
    captures, source = newest("video")
    parts = [
        "## Clips beside AV1 streams of their cameras\n\nEvery byte of the `.glb` counts. Streams are SVT-AV1's, 10 bits,"
        " 4:2:0, of the encoded cameras: one a camera with a key picture where our groups begin (*keys*) or with one in"
        " all (*one key*), or one through all cameras and frames (*joint*), each with its preset. *Stills* are some of"
        " the frames encoded by themselves, their bytes scaled up to all. Percentages compare bytes at equal luma PSNR:"
        " with a minus our file is smaller; – means that the peer was not measured at that quality. In brackets stands"
        " what the streams with keys have at our bytes; their held-out views are a lumigraph on our mesh. *Flicker* is in"
        " pixels whose photographs stand still, in grey levels, and *step* the largest between groups.\n"
    ]
    for name, one in captures.items():
        height, width = one["size"]
        curves = {**one["peers"], "stills": one["stills"]}
        with_keys: list[Any] = [curve for peer, curve in one["peers"].items() if peer.startswith("keys")]
        anchor = with_keys[0] if with_keys else []
        rows = [_clip_row(point, one["frames"], curves, anchor) for point in one["ours"]]
        peers = [peer.replace("one-key", "one key").replace("-", ", preset ") for peer in curves]
        head = ["quality", "kB a frame", "RGB / luma dB", "held out, luma", "flicker", "step, dB", *peers]
        parts.append(
            f"`{name}`, pictures of {width}x{height}. {one['cameras']} cameras are encoded, and {one['held_out']} held out."
            f" The {one['frames']} frames lie in groups of {', '.join(map(str, dict.fromkeys(one['groups'])))}.\n\n"
            f"{table(head, rows)}"
        )
    return "\n".join([*parts, source]) + "\n"


def _clip_row(
    point: Mapping[str, Any], frames: int, curves: Mapping[str, Any], anchor: Sequence[Mapping[str, Any]]
) -> list[str]:
    def beside(of: Callable[[Mapping[str, Any]], float | None]) -> str:
        own, theirs = of(point), rates.value_at(anchor, point["bytes"], of)
        return decimals(own) + ("" if own is None or theirs is None else f" ({theirs:.2f})")

    border = point["border"] or {}
    return [
        str(point["parameter"]), f"{point['bytes'] / 1e3 / frames:.2f}", both(point),
        beside(rates.held_out_luma), beside(rates.flicker), decimals(border.get("step")),
        *(_saved(point, {"points": curve} if curve else None, "psnr_luma") for curve in curves.values()),
    ]  # fmt: skip


def single() -> str:
    """Tables of figures that were measured once, by hand: each run of single.json is one table."""
    parts = [
        "## Measured once\n\nThese figures were measured by hand and have no script that repeats them. Each table names"
        " the commit that recorded it.\n"
    ]
    for run in runs("single"):
        note = f"{run['note']}\n\n" if run["note"] else ""
        parts.append(
            f"### {run['title']}\n\n{note}{table(run['head'], run['rows'])}\n"
            f"`{run['command']}`, recorded in commit {run['commit']}, {run['date'][:10]}.\n"
        )
    return "\n".join(parts) + "\n"


def between_marks(text: str, made: str) -> str:
    """`text` with what is between the marks replaced."""
    start, stop = text.index(BEGIN), text.index(END)
    return f"{text[:start]}{BEGIN}\n{made}{text[stop:]}"


def main() -> None:
    whole, source = newest("report")
    made = {
        README: five(),
        BENCHMARKS: fitted()
        + between_cameras()
        + clips()
        + "## The paper's way (`--fit none`)\n\n"
        + quality()
        + reconstruction()
        + evaluation(whole)
        + source
        + "\n## Time\n\n"
        + encoding()
        + photographs()
        + drawing()
        + batches()
        + single(),
    }
    for path, figures in made.items():
        text = path.read_text(encoding="utf-8")
        new = between_marks(text, figures)
        if "--check" in sys.argv and new != text:
            raise SystemExit(f"{path.name} and benchmarks/results differ: run python benchmarks/tables.py")
        path.write_text(new, encoding="utf-8")


if __name__ == "__main__":
    main()
