"""Bytes against quality: our fitted files beside video codecs on the same photographs, in one run, every byte counted.

    EIGENFIELD_DATA=captures python benchmarks/rate.py [CAPTURE...] [--out rate] [--peers svt-av1-2,...] [--best]
        [--store]

CAPTURE: names as benchmarks/report.py knows them, or a folder of photographs of your own; without any, the dense arrays
and the sparse Tarot. Ours: a fit for
each preset, coded at qualities near its own, each point a real .glb that is read and drawn again; --best adds a curve
of that preset alone, which takes its time. SVT-AV1 walks the views row by row, to and fro or in a spiral, whichever is
best at its middle rate; VVenC, which takes minutes, goes to and fro. Crops at about equal bytes go to
OUT/NAME/crops.png; what is done stays there too, and a run that was stopped goes on while the code is the same. The
loss without a codec stands beside: of ours before coding, of the peers' colours in 4:2:0.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import eigenfield as ef
import measure
from eigenfield.encoding import EncodeOptions
from eigenfield.rendering import Renderer
from eigenfield.runtime.parallel import parallel_map
from evidence import captures, codecs, ours, pictures, prepared, rates
from evidence.codecs import VideoCodec
from evidence.peers import ceiling
from evidence.prepared import Prepared
from evidence.runner import kept

CAPTURES = ("tarot", "shop", "boxes", "antinous", "tarot-5x4")
PEERS = ("svt-av1-2", "svt-av1-6", "libaom-444", "vvenc")
# a fit for each preset, and one with the mesh that the lowest quality has; the finest mesh says what is covered
FITS: tuple[ours.Fit, ...] = (
    (EncodeOptions(preset="best"), (94, 97)),
    (EncodeOptions(), (84, 88, 91, 92)),
    (EncodeOptions(preset="small"), (70, 78)),
    (EncodeOptions(preset="small", quality=60), (60,)),
)
BEST: tuple[ours.Fit, ...] = ((EncodeOptions(preset="best", quality=88), (78, 84, 88, 91)),)
CRF = (32, 40, 48, 56, 63)
QP = (20, 25, 30, 35, 40)  # of VVC: about the bytes of CRF
KEYS = ("psnr", "psnr_luma", "ssim")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("captures", nargs="*", metavar="CAPTURE")
    parser.add_argument("--out", type=Path, default=Path("rate"))
    parser.add_argument("--peers", default=",".join(PEERS), help="names of codecs, commas between; none: ours alone")
    parser.add_argument("--best", action="store_true", help="also a curve of the preset best")
    parser.add_argument("--store", action="store_true", help="append to benchmarks/results/rate.json")
    options = parser.parse_args()
    out = options.out.resolve()
    names = options.captures or [name for name in CAPTURES if name in captures.known(out)]
    if not names:
        raise SystemExit("name a capture, demo or a folder: EIGENFIELD_DATA names no folder that holds the shared ones")
    some = [captures.named(name, out) for name in names]
    chosen = codecs.asked_for(options.peers)
    figures = {}
    for capture in some:
        name, work = capture.name, out / capture.name
        make = partial(of_capture, capture, work, chosen, options.best)
        asked = f"{options.peers}{' best' * options.best}"
        figures[name] = kept(work / "figures.json", Path(__file__), make, asked)
        print(f"\n{name}\n{table(figures[name])}", flush=True)
    if options.store:
        print(measure.store("rate", {"captures": {name: worth_keeping(one) for name, one in figures.items()}}))


def worth_keeping(figures: dict[str, Any]) -> Any:
    """What the tables show, small enough for a history: not which camera is worst, nor where pictures lie."""

    def short(curve: dict[str, Any]) -> dict[str, Any]:
        left_out = {"worst", "file", "shown"}
        points = [{key: point[key] for key in point if key not in left_out} for point in curve["points"]]
        return {**curve, "points": points}

    best = figures["best"]
    return prepared.as_json({**figures, "curves": list(map(short, figures["curves"])), "best": best and short(best)})


def of_capture(
    capture: captures.Capture, work: Path, chosen: Sequence[VideoCodec], best: bool = False
) -> dict[str, Any]:
    """All curves of one capture, and Bjøntegaard's rates of ours against each peer."""
    prepared.estimate(capture, work)
    ready = prepared.prepare(capture, work)
    views = range(len(ready.light_field))
    photographs = parallel_map(lambda index: prepared.codes(ready.light_field, index), views)
    proxy = prepared.own_proxy(capture, work)
    mine, covered = ours.fitted(ready, ready.light_field, views, photographs, asked=FITS, proxy=proxy)
    patient = None
    if best:
        patient, _ = ours.fitted(ready, ready.light_field, views, photographs, covered, BEST, "best", proxy)
    for one in [*mine["points"], *(patient["points"] if patient else [])]:
        print(f"{capture.name}: {one['preset']}, quality {one['parameter']}: {line(one)}", flush=True)
    others = [peer_curve(codec, ready, photographs, covered) for codec in chosen if codecs.missing(codec) is None]
    if others:
        contact_sheet(ready, mine["points"], others[0], photographs, covered)
    return {
        "views": len(views),
        "ceiling_420": ceiling(photographs, ready.light_field.names, covered),
        "curves": [mine, *others],
        "best": patient,
        "bd": {one["name"]: {key: rates.bd_rate(one["points"], mine["points"], key) for key in KEYS} for one in others},
        "left_out": [f"{codec.label}: {codecs.missing(codec)}" for codec in chosen if codecs.missing(codec)],
    }


def peer_curve(
    codec: VideoCodec, ready: Prepared, photographs: list[NDArray[np.uint8]], covered: list[NDArray[np.bool_]]
) -> dict[str, Any]:
    """A peer's curve in the order of views that suits it best."""
    field, steps = ready.light_field, QP if codec.parameter == "qp" else CRF
    middle = steps[len(steps) // 2]
    with tempfile.TemporaryDirectory() as folder:
        orders = codecs.orders_of(codec, field.cameras)

        def point(step: int, name: str) -> dict[str, Any]:
            order, place = orders[name], Path(folder) / name  # a film of one order is not written over by another's
            place.mkdir(exist_ok=True)
            film, counted = [photographs[index] for index in order], [covered[index] for index in order]
            return codecs.measure_video(codec, step, film, [field.names[index] for index in order], counted, place)

        tried = {name: point(middle, name) for name in orders}
        best = codecs.best_order(tried)
        points = [tried[best] if step == middle else point(step, best) for step in steps]
        for one in points:
            film = Path(folder) / best / f"{codec.name}-{one['parameter']}.{codec.container}"
            at = orders[best].index(shown_view(ready))
            picture = codecs.access(film, codec, at, photographs[shown_view(ready)].shape[:2])[1]
            one["shown"] = pictures.write_exact(picture, ready.work / f"{codec.name}-{one['parameter']}.webp").name
    for one in points:
        print(f"{ready.capture.name}: {codec.label}, {codec.parameter} {one['parameter']}: {line(one)}", flush=True)
    return {
        "name": codec.label, "key": codec.name, "order": best,
        "orders": {name: [one[key] for key in ("bytes", "psnr", "psnr_luma")] for name, one in tried.items()},
        "points": points,
    }  # fmt: skip


def shown_view(ready: Prepared) -> int:
    """The view on the contact sheet: half way between the middle and a corner of a dense array."""
    return len(ready.light_field) // 4


def contact_sheet(
    ready: Prepared,
    mine: list[dict[str, Any]],
    film: dict[str, Any],
    photographs: list[NDArray[np.uint8]],
    covered: list[NDArray[np.bool_]],
) -> Path:
    """WORK/crops.png: where a view is hardest, the photograph, ours and the film nearest to ours in bytes."""
    index = shown_view(ready)
    pairs = [(abs(np.log(own["bytes"] / other["bytes"])), own, other) for own in mine for other in film["points"]]
    _, own, other = min(pairs, key=lambda pair: pair[0])
    scene = ef.load(ready.work / own["file"])
    shown = [
        photographs[index],
        prepared.drawn(Renderer(scene), scene, index)[0],
        pictures.read(ready.work / other["shown"]),
    ]
    words = [f"photograph {scene.rig.names[index]}"] + [
        f"{name}: {one['bytes'] / 1000:.1f} kB, {one['psnr']:.2f} / {one['psnr_luma']:.2f} dB"
        for name, one in (("eigenfield", own), (film["name"], other))
    ]
    corners = pictures.busiest([shown[0]] * 2, shown[1:], 3, covered[index])
    rows = [("", [pictures.crop(picture, corner) for picture in shown]) for corner in corners]
    place = pictures.write_sheet(words, rows, ready.work / "crops.png")
    print(f"{ready.capture.name}: {place}", flush=True)
    return place


def line(point: dict[str, Any]) -> str:
    """A point in words."""
    return (
        f"{point['bytes'] / 1000:.1f} kB, {point['psnr']:.2f} dB RGB, {point['psnr_luma']:.2f} luma, "
        f"SSIM {point['ssim']:.4f}, {point['encode_seconds']:.0f} s"
    )


def table(found: dict[str, Any]) -> str:
    """What each peer needs beside ours at equal quality."""
    mine, *others = found["curves"]
    lines = []
    for key, step in (("psnr", 0.5), ("psnr_luma", 0.5), ("ssim", 0.01)):
        values = [point[key] for point in mine["points"]]
        for quality in np.arange(np.ceil(min(values) / step) * step, max(values), step):
            at = rates.bytes_at(mine["points"], float(quality), key)
            if at is None:
                continue
            words = [f"{key} {quality:.2f}: {at / 1000:7.1f} kB"]
            for one in others:
                theirs = rates.bytes_at(one["points"], float(quality), key)
                if theirs is not None:
                    words.append(f"{one['name']} {theirs / 1000:.1f} kB ({100 * (at / theirs - 1):+.0f} %)")
            if len(words) > 1:
                lines.append(", ".join(words))
    for name, of in found["bd"].items():
        said = ", ".join(f"{key} {value:+.1f} %" for key, value in of.items() if value is not None)
        lines.append(f"BD-rate against {name}: {said}")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
