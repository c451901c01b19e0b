"""The README's figures, made from benchmarks/results; `--check` fails where the README says otherwise.

python benchmarks/tables.py [--check]
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

README = Path(__file__).parents[1] / "README.md"
RESULTS = Path(__file__).parent / "results"
CAPTURES = ("tarot", "tarot-5x4", "cube", "demo")
BEGIN, END = "<!-- figures -->\n", "<!-- end of figures -->\n"


def result(name: str) -> dict[str, Any]:
    return json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))


def table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def origin(figures: dict[str, Any], name: str) -> str:
    machine = figures["machine"]
    return (
        f"[`{figures['command']}`](benchmarks/results/{name}.json), commit {figures['commit']}, "
        f"{machine['processor']}, {machine['cores']} cores.  \n"
    )


def quality() -> str:
    results = {name: result(f"quality-{name}") for name in CAPTURES}
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
        "### Quality\n\nPSNR of re-drawn photographs over covered pixels, 8-bit RGB, drawn bicubic from the file as it is"
        " decoded; in brackets outside the glass ball. `tarot` is Stanford's, 289 views of 512², atlas 1024; `tarot-5x4`"
        " 20 of them at 1024²; `cube` 13 pictures of a phone on a mesh with holes; `demo` what `make demo` draws.\n\n"
        + table(head, rows)
        + f"\nBefore coding, Tarot's encoded views have {decibels(before)} dB, held out `odd` {decibels(held)}. With exact"
        " geometry (25 views of the demo), all textures and density 2, what is left is resampling:"
        f" {decibels(exact)} dB. Held against the texture maps as AVIF at the same UV SSIM, the file saves"
        f" {100 * avif['tarot']:.1f} % (tarot) and {100 * avif['demo']:.1f} % (demo).\n\n"
        + "".join(origin(figures, f"quality-{name}") for name, figures in results.items())
        + "\n"
    )


def decibels(figures: dict[str, Any] | None) -> str:
    if figures is None:
        return ""
    outside = f" ({figures['outside']['psnr']:.2f})" if "outside" in figures else ""
    return f"{figures['psnr']:.2f}{outside}"


def encoding() -> str:
    figures = result("encode")
    whole, half = figures["encode"], figures["encode_every_second_row"]
    pca, av1 = figures["scikit_learn_pca"], figures["svt_av1_preset_6"]
    rows = [
        ["`eigenfield encode`, 289 views, all of it", f"{whole['seconds']:.1f}", str(whole["peak_anonymous_mb"]),
         f"{whole['bytes'] / 1e6:.2f}"],
        ["the same, every second row", f"{half['seconds']:.1f}", str(half["peak_anonymous_mb"]), ""],
        ["scikit-learn PCA (randomised), its fit", f"{pca['fit_seconds']:.1f}", str(pca["peak_anonymous_mb"]), ""],
        ["SVT-AV1 preset 6, crf 40, the encoder alone", f"{av1['encode_seconds']:.1f}", str(av1["peak_anonymous_mb"]),
         f"{av1['bytes'] / 1e6:.2f}"],
    ]  # fmt: skip
    return (
        "### Encoding\n\nTarot, atlas 1024, 15 textures, warm kernels; memory is the peak of anonymous pages.\n\n"
        + table(["", "seconds", "peak MB", "MB written"], rows)
        + f"\nAll cameras need {figures['ratio']['memory_all_to_every_second_row']:.2f} times the memory of half of"
        " them.\n\n" + origin(figures, "encode") + "\n"
    )


def drawing() -> str:
    figures = result("render")
    rows = [
        [count, *(f"{row[filter]['fps']:.0f} ({row[filter]['fps_best']:.0f})" for filter in ("bilinear", "bicubic")),
         f"{100 * row['share_of_bandwidth']:.0f} %"]
        for count, row in figures["relief"].items()
    ]  # fmt: skip
    if "tarot_proxy_40" in figures:
        own = figures["tarot_proxy_40"]
        rows.append(["40, Tarot's proxy", *(f"{own[f]['fps']:.0f} ({own[f]['fps_best']:.0f})" for f in own), ""])
    width, height = figures["view"]
    return (
        f"### Drawing\n\nFrames per second of the software renderer (best frame in brackets) at {width}x{height}, atlas"
        f" {figures['atlas']}², {figures['threads']} threads, the viewpoint moving every frame; the paper reports over 60"
        " up to 40 textures on a GTX 1080. The last column is what share of the memory bandwidth"
        f" ({figures['read_gb_per_second']:.0f} GB/s read, same run) all textures read once a frame make up.\n\n"
        + table(["N", "bilinear", "bicubic", "of the bandwidth"], rows)
        + f"\nSumming 40 textures takes {figures['composition_40']['ratio_to_numpy']:.2f} of the time of NumPy's matrix"
        " product on float32 textures.\n\n" + origin(figures, "render") + "\n"
    )


def section() -> str:
    return f"{BEGIN}\n## Figures\n\n{quality()}{encoding()}{drawing()}{END}"


def main() -> None:
    text = README.read_text(encoding="utf-8")
    start = text.index(BEGIN)
    stop = text.index(END) + len(END) if END in text else start + len(BEGIN)
    made = text[:start] + section() + text[stop:]
    if "--check" in sys.argv:
        if made != text:
            raise SystemExit("README.md and benchmarks/results differ: run python benchmarks/tables.py")
        return
    README.write_text(made, encoding="utf-8")


if __name__ == "__main__":
    main()
