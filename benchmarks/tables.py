"""The tables of docs/benchmarks.md and the README, made from benchmarks/results; `--check` fails where they differ.

python benchmarks/tables.py [--check]
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import between_tables
import evaluation_tables
import plots
import rate_tables
from evaluation_tables import table
from measure import latest, runs

README = Path(__file__).parents[1] / "README.md"
BENCHMARKS = README.parent / "docs" / "benchmarks.md"
CAPTURES = ("tarot", "tarot-5x4", "cube", "demo")
SCENES = (
    "tarot-all", "tarot", "tarot-blind", "tarot-5x4", "amethyst", "jellybeans", "shop", "boxes", "antinous", "fern",
    "cube", "fountain", "fox", "temple",
)  # fmt: skip
DRAWN = {"bilinear": "bilinear", "bicubic": "bicubic", "bicubic_one_sample": "bicubic, one sample"}  # in render.json
BEGIN, END = "<!-- figures -->\n", "<!-- end of figures -->\n"


def origin(figures: dict[str, Any], name: str) -> str:
    machine = figures["machine"]
    return (
        f"[`{figures['command']}`](../benchmarks/results/{name}.json), commit {figures['commit']}, "
        f"{machine['processor']}, {machine['cores']} cores.  \n"
    )


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
        + "".join(origin(figures, f"quality-{name}") for name, figures in results.items())
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
        + origin(scenes["tarot"], "proxy-scene-tarot")
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
        " them.\n\n" + origin(figures, "encode") + "\n"
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
        " product on float32 textures.\n\n" + shaded() + origin(figures, "render") + "\n"
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
        + origin(opengl, "render-opengl")
        + origin(browser, "render-browser")
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
        " names.\n\n" + table(head, rows) + "\n" + origin(figures, "photographs") + "\n"
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
        + "\n" + origin(figures, "batch") + "\n"
    )  # fmt: skip


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
    made = {
        README: rate_tables.five(),
        BENCHMARKS: rate_tables.section()
        + between_tables.section()
        + "## The paper's way (`--fit none`)\n\n"
        + quality()
        + reconstruction()
        + evaluation_tables.page()
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
