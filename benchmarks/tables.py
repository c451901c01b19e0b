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
        f"{machine['processor']}, {machine['cores']} cores.\n"
    )


def db(figures: dict[str, Any] | None, key: str = "psnr") -> str:
    return "" if figures is None else f"{figures[key]:.2f}"


def quality() -> str:
    figures = result("quality")
    rows = []
    for capture, cases in figures["captures"].items():
        for label, case in cases.items():
            if "bytes" not in case:
                continue
            encoded, held = case["image"]["encoded"], case["image"]["held_out"]
            outside = "" if "outside" not in encoded else f" ({encoded['outside']['psnr']:.2f})"
            held_outside = "" if held is None or "outside" not in held else f" ({held['outside']['psnr']:.2f})"
            rows.append([
                f"{capture}, {label}", str(case["textures"]), f"{case['bytes']['total'] / 1e6:.2f}",
                f"{case['uv']['ssim']:.3f}", f"{db(encoded)}{outside}", f"{encoded['ssim']:.3f}",
                f"{db(held)}{held_outside}", "" if held is None else f"{held['ssim']:.3f}",
                f"{100 * encoded['coverage']:.0f} %",
                f"{case['ratio']['photographs']:.0f} / {case['ratio']['texture_maps_png']:.0f}",
                f"{case['encode']['seconds']:.0f}", str(case["encode"]["peak_anonymous_mb"]),
            ])  # fmt: skip
    head = ["capture", "N", "MB", "UV SSIM", "encoded dB", "SSIM", "held out dB", "SSIM", "coverage",
            "smaller than photographs / maps as PNG", "encode s", "peak MB"]  # fmt: skip
    tarot = figures["captures"]["tarot"]
    before = tarot["all encoded"]["uncoded"]["image"]["encoded"]
    held = tarot["odd held out"]["uncoded"]["image"]["held_out"]
    exact = figures["captures"]["demo"]["exact geometry, all textures, density 2, uncoded"]["encoded"]
    return (
        "### Quality\n\nPSNR of re-drawn photographs over covered pixels, 8-bit RGB, drawn bicubic, as the file is"
        " decoded; in brackets outside the glass ball. `tarot` is Stanford's, 289 views of 512², atlas 1024.\n\n"
        + table(head, rows)
        + f"\nBefore coding, Tarot's encoded views have {db(before)} dB ({db(before['outside'])} outside the ball),"
        f" held out `odd` {db(held)} ({db(held['outside'])}). With exact geometry (the demo), all textures and"
        f" density 2, what is left is resampling: {db(exact)} dB.\n\n" + origin(figures, "quality") + "\n"
    )


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
    return ""


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
