"""The whole evaluation: every capture through every step, one page in Markdown, one file of figures.

    [EIGENFIELD_DATA=captures] python benchmarks/report.py [CAPTURE...] [--quick] [--out report]

CAPTURE: a name (demo, tarot, tarot-5x4, amethyst, ...; those of the shared captures that lie in EIGENFIELD_DATA) or a
folder of photographs of your own; without any, all shared captures and the demo. Writes OUT/report.md, with pictures
beside it, and OUT/results.json. What is finished is kept in OUT/steps: after Ctrl-C the same command goes on. A figure
is measured again when the code has changed, unless --keep. `--quick` takes two captures and fewer rates, within ten
minutes on two cores; everything takes up to three hours. `pip install 'eigenfield[report]'` first: what a peer lacks
here is left out, and the page says so.
"""

from __future__ import annotations

import argparse
import datetime
import os
import shlex
import sys
import time
from pathlib import Path
from typing import Any

import measure
from evidence import captures, page
from evidence.captures import Capture
from evidence.paper import QUOTED
from evidence.runner import Run, evaluate_capture


def chosen(names: list[str], out: Path, quick: bool) -> tuple[list[Capture], list[str]]:
    """The captures of a run, and in words what it leaves out."""
    if names:
        return [captures.named(name, out) for name in names], []
    known = captures.known(out)
    if not quick:
        there = os.environ.get("EIGENFIELD_DATA")
        words = [] if there else ["the shared captures: EIGENFIELD_DATA names no folder that holds them"]
        return list(known.values()), words
    some = [known[name] for name in captures.QUICK if name in known] or [known["demo"]]
    names_left = [name for name in known if name not in {one.name for one in some}]
    words = [
        "a quick run: two rates instead of four, four numbers of textures, no alignment, no x265, libaom, AVIF or JPEG"
        " XL"
    ]
    return some, words + ([f"captures: {', '.join(names_left)}"] if names_left else [])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("captures", nargs="*", metavar="CAPTURE")
    parser.add_argument("--quick", action="store_true", help="fewer captures and rates, within ten minutes")
    parser.add_argument("--out", type=Path, default=Path("report"), metavar="DIR")
    parser.add_argument("--keep", action="store_true", help="keep figures of another state of the code, marked as such")
    parser.add_argument(
        "--store", action="store_true", help="append the main figures to benchmarks/results/report.json"
    )
    arguments = parser.parse_args()
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    some, left_out = chosen(arguments.captures, out, arguments.quick)
    started, begun = time.perf_counter(), datetime.datetime.now(datetime.UTC)
    run = Run(out, arguments.quick, arguments.keep)
    results: dict[str, Any] = {
        "schema": "eigenfield.report/1", "command": shlex.join(["python", *sys.argv]), "quick": arguments.quick,
        "started": begun.isoformat(timespec="seconds"), "commit": measure.commit(), "machine": measure.machine(),
        "left_out": left_out, "paper": QUOTED, "captures": {},
    }  # fmt: skip
    for capture in some:
        results["captures"][capture.name] = evaluate_capture(capture, run, lambda line: print(line, flush=True))
        results["seconds"] = round(time.perf_counter() - started, 1)
        _write(out, results)  # a page after each capture: a long run can be read while it goes on
    if arguments.store:
        print(f"stored as {measure.store('report', summary(results))}")
    print(f"{out / 'report.md'}: {results['seconds']:.0f} s")
    failed = [name for name, record in results["captures"].items() for step in _records(record) if "error" in step]
    if failed:
        raise SystemExit(f"some steps failed: {', '.join(dict.fromkeys(failed))}; the page says which")


def _records(record: dict[str, Any]) -> list[dict[str, Any]]:
    return [record["geometry"], *record["steps"].values()]


def _write(out: Path, results: dict[str, Any]) -> None:
    measure.write_json(out / "results.json", results)
    page.write(results, summary(results)["captures"], out)


def summary(results: dict[str, Any]) -> dict[str, Any]:
    """The figures worth keeping from run to run: small enough for a history."""
    kept = {}
    for name, record in results["captures"].items():
        steps = {key: step["figures"] for key, step in record["steps"].items() if "figures" in step}
        kept[name] = {"title": record["title"], "views": record.get("views"), "hold_out": record.get("hold_out")}
        for key, of_step in KEPT.items():
            if key in steps:
                kept[name] |= of_step(steps[key])
    commits = sorted({step["commit"] for record in results["captures"].values() for step in _records(record)})
    return {"quick": results["quick"], "seconds": results["seconds"], "commits": commits, "captures": kept}


def _whole(figures: dict[str, Any]) -> dict[str, Any]:
    held = figures["held_scene"]
    return {
        "bytes": figures["bytes"], "encode_seconds": figures["encode"]["seconds"], "textures": figures["textures"],
        "encoded": _short(figures["encoded"]), "held_out": _short(held["held_out"]),
        "encoded_beside_held_out": _short(held["encoded"]),
    }  # fmt: skip


def _paper(figures: dict[str, Any]) -> dict[str, Any]:
    at: dict[str, dict[str, float]] = {}
    for way in ("plain", "aligned"):
        points = [point for point in figures["curve"] if way in point]
        at[way] = {str(point["textures"]): round(point[way]["uv_ssim"], 4) for point in points}
    return {"uv_curve": at, "table": {"rows": figures["table"]["rows"]}}


def _rates(figures: dict[str, Any]) -> dict[str, Any]:
    return {"bd": {peer: {key: rates[key] for key in ("psnr", "psnr_luma")} for peer, rates in figures["bd"].items()}}


def _losses(figures: dict[str, Any]) -> dict[str, Any]:
    rows = [{key: row[key] for key in ("key", "psnr", "gain", "share") if key in row} for row in figures["rows"]]
    truth = figures.get("truth")
    cost = None if truth is None else {part: {"cost": truth[part]["cost"]} for part in ("encoded", "held_out")}
    return {"losses": rows, "truth": cost}


def _between(figures: dict[str, Any]) -> dict[str, Any]:
    return {"between": {m["key"]: {key: m[key] for key in ("psnr", "psnr_luma", "ssim")} for m in figures["methods"]}}


def _short(image: dict[str, Any] | None) -> dict[str, Any] | None:
    keys = ("cameras", "psnr", "ssim", "flip", "psnr_luma", "psnr_full", "coverage")
    return None if image is None else {key: image[key] for key in keys if key in image}


KEPT = {"scene": _whole, "paper": _paper, "rates": _rates, "losses": _losses, "between": _between}


if __name__ == "__main__":
    main()
