"""Views between the encoded cameras: ours beside its peers at equal bytes, in photographs that were held out.

    EIGENFIELD_DATA=captures python benchmarks/between.py [CAPTURE...] [--hold-out RULE] [--kilobytes N]
        [--peers svt-av1-2,svt-av1-6] [--before TREE_OR_GLB] [--out out/between] [--store]

CAPTURE: names as benchmarks/report.py knows them, or a folder of photographs of your own; without any, those of CASES,
which says what each holds out and how large its file may be. Ours is the file of `eigenfield encode`, all defaults but
these two, and `--blind` where a surface is estimated: held-out photographs take no part in it. Dense arrays, whose rule
is odd, are encoded without. Beside it are drawn:

- the encoded views as one film, decoded and blended on our own mesh (a lumigraph), for each codec of --peers. Its rate
  is searched so that film and mesh have the bytes of our file, at most 2 % more; the order of views is the best. Where
  our file has soft sheets, which no lumigraph can be drawn on, the mesh is that of a second file with one opaque
  surface (`encode --layers 1`);
- the same lumigraph of the uncoded photographs;
- the photograph of the nearest camera, and the neighbours' photographs blended;
- the version before, with --before: another source tree, which encodes to the bytes of our file, or a .glb of the same
  capture and hold-out rule. A tree that refuses `--blind` for cameras all around encodes without it, in its favour.

All are measured over the pixels that this mesh covers, and depth edges are this mesh's. Crops of ours, the peers and
the photograph go to OUT/NAME/crops-PEER.png, for each peer of our bytes: where ours is worse than that peer by most,
and where it is better by most. What is done stays in OUT, and a run that was stopped goes on while the code is the
same.
"""

from __future__ import annotations

import argparse
import hashlib
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import cv2
import numpy as np

import eigenfield as ef
import measure
from eigenfield.capture import open_any, with_scene_cameras
from eigenfield.gltf import parts
from eigenfield.imaging.metrics import to_codes
from eigenfield.rendering import Renderer
from evidence import captures, codecs, equal_bytes, pictures, prepared
from evidence.between import (
    Peers,
    Stage,
    Way,
    covered_by_proxy,
    held_out,
    measure_ways,
    start,
    ways_of,
)
from evidence.captures import Capture
from evidence.codecs import VideoCodec
from evidence.runner import kept

PEERS = ("svt-av1-2", "svt-av1-6")
PHOTOGRAPHS = ("lumigraph", "blend", "nearest")  # ways that need all photographs
ROWS = 2  # of crops on each side
SCORES = ("psnr", "psnr_luma", "ssim", "flip")


@dataclass(frozen=True)
class Case:
    """What is asked of a capture.

    Attributes:
        hold_out: Rule of `encode --hold-out`.
        kilobytes: Of the file at most; None: the default's quality.
    """

    hold_out: str
    kilobytes: float | None = None


CASES = {
    "antinous": Case("odd", 25.5),
    "boxes": Case("odd", 100),
    "shop": Case("odd"),
    "tarot-5x4": Case("out_06_04.jpg,out_06_12.jpg,out_10_12.jpg"),
    "fern": Case("image000.png,image008.png,image016.png"),
    "cube": Case("every:4"),
    "fountain": Case("every:4"),
    "fox": Case("every:8"),
    "temple": Case("every:5"),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("captures", nargs="*", metavar="CAPTURE")
    parser.add_argument("--hold-out", metavar="RULE", help="rule of encode --hold-out, in place of the capture's")
    parser.add_argument("--kilobytes", type=float, metavar="N", help="size of the file, in place of the capture's")
    parser.add_argument("--peers", default=",".join(PEERS), help="names of codecs, commas between; none: no codec")
    parser.add_argument("--before", type=Path, metavar="TREE_OR_GLB", help="the version before")
    parser.add_argument("--out", type=Path, default=Path("out") / "between")
    parser.add_argument("--store", action="store_true", help="append to benchmarks/results/between.json")
    options = parser.parse_args()
    out = options.out.resolve()
    names = options.captures or [name for name in CASES if name in captures.known(out)]
    if not names:
        raise SystemExit("name a capture, demo or a folder: EIGENFIELD_DATA names no folder that holds the shared ones")
    if options.before is not None and options.before.is_file() and len(names) > 1:
        raise SystemExit(f"{options.before} is the file of one capture: name that one alone")
    chosen = [codec for codec in codecs.asked_for(options.peers) if codecs.missing(codec) is None]
    for name in names:
        capture = captures.named(name, out)
        usual = CASES.get(name, Case(capture.hold_out or "odd"))
        case = Case(options.hold_out or usual.hold_out, options.kilobytes or usual.kilobytes)
        work = out / capture.name
        make = partial(of_capture, capture, case, work, chosen, options.before)
        asked = f"{case} {options.peers} {options.before and version(options.before)}"
        figures = kept(work / "figures.json", Path(__file__), make, asked)
        print(f"\n{capture.name}, {case.hold_out} held out\n{table(figures)}", flush=True)
        if options.store:
            print(measure.store("between", {"captures": {capture.name: worth_keeping(figures)}}))


def of_capture(
    capture: Capture, case: Case, work: Path, chosen: Sequence[VideoCodec], before: Path | None = None
) -> dict[str, Any]:
    """A row for each way, and crops beside each peer of our bytes."""
    work.mkdir(parents=True, exist_ok=True)
    most = None if case.kilobytes is None else round(1000 * case.kilobytes)
    file = encoded(capture, case.hold_out, most, work)
    size, sheets = file.stat().st_size, ef.load(file).proxy.sheets
    opaque = file if sheets is None else encoded(capture, case.hold_out, None, work, more=["--layers", "1"])
    stage, peers = opened(opaque, capture)
    index = held_out(stage)
    mesh = parts(opaque)["mesh"]
    ways: dict[str, Way] = {"ours": drawn_by(file, stage, index)}
    spent: dict[str, dict[str, Any]] = {"ours": {"bytes": size}}
    left_out = []
    for codec in chosen:
        try:
            ways[codec.name], spent[codec.name] = coded(codec, stage, peers, equal_bytes.OVER * size - mesh)
        except ValueError as error:
            left_out.append(f"{codec.label}: {error}")
            continue
        spent[codec.name]["bytes"] += mesh
    if before is not None:
        old = before if before.is_file() else encoded(capture, case.hold_out, size, work, before)
        ways["before"] = drawn_by(old, stage, index)
        spent["before"] = {"bytes": old.stat().st_size, "version": version(before)}
    against = list(ways)[1:]
    drawn = ways_of(stage, peers)
    ways |= {key: drawn[key] for key in PHOTOGRAPHS}
    rows, _ = measure_ways(stage, index, ways)
    methods = [{**row, **spent.get(row["key"], {})} for row in rows]
    heads = ["photograph", *map(caption, methods)]
    return {
        "rule": case.hold_out, "cameras": len(index), "encoded": len(peers.shown), "mesh": mesh,
        "sheets": 0 if sheets is None else len(sheets.faces),
        "methods": methods, "left_out": left_out,
        "crops": [crops(stage, index, ways, peer, heads, work).name for peer in against],
    }  # fmt: skip


def encoded(
    capture: Capture, hold_out: str, size: int | None, work: Path, tree: Path | None = None, more: Sequence[str] = ()
) -> Path:
    """The file that `eigenfield encode` makes, of this source tree or of another one: of at most `size` bytes.

    Args:
        capture: The capture.
        hold_out: Rule of `encode --hold-out`.
        size: Bytes at most; None: the default's quality.
        work: Folder of the file.
        tree: The other source tree.
        more: Options that make an opaque surface.
    """
    name = "before" if tree else "opaque" if more else "ours"
    words = ["encode", *prepared.words(capture), "--hold-out", hold_out, *more]
    blind = ["--blind"] if capture.proxy is None and hold_out != "odd" else []
    words += [] if capture.proxy is None else ["--proxy", str(capture.proxy)]
    words += [] if size is None else ["--target-size", str(size)]
    stages = "before.work" if tree else "ours.work"
    words += ["--work", str(work / stages), "-o", str(work / f"{name}.glb")]
    words = ["-m", "eigenfield", *words, "--overwrite", "--quiet"]
    try:
        made = measure.run([*words, *blind], tree)
    except SystemExit:
        if tree is None or not blind:
            raise
        print(f"{capture.name}, {name}: its surface sees held-out photographs", flush=True)
        made = measure.run(words, tree)
    print(f"{capture.name}, {name}: {made['output'].strip()}", flush=True)
    return work / f"{name}.glb"


def opened(file: Path, capture: Capture) -> tuple[Stage, Peers]:
    """A file beside the photographs of its capture."""
    folder, *calibration = prepared.words(capture)
    scene = ef.load(file)
    photographs = open_any(folder, calibration=calibration[1] if calibration else None)
    return start(scene, with_scene_cameras(scene, photographs))


def coded(codec: VideoCodec, stage: Stage, peers: Peers, most: float) -> tuple[Way, dict[str, Any]]:
    """A codec's way: its film of the encoded views, of at most `most` bytes, in place of the photographs."""
    views = [peers.lumigraph.photograph(place) for place in range(len(peers.shown))]
    cameras = [stage.scene.rig.cameras[index] for index in peers.shown]
    with tempfile.TemporaryDirectory() as folder:
        film = equal_bytes.film_within(codec, cameras, views, most, Path(folder))
    way = ways_of(stage, Peers(peers.shown, peers.lumigraph.of(film.pictures)))["lumigraph"]
    return way, {"bytes": film.bytes, "parameter": film.rate, "order": film.order}


def drawn_by(file: Path, stage: Stage, chosen: Sequence[int]) -> Way:
    """What another file of the capture draws of the cameras `chosen`. SystemExit where it did not hold them out."""
    scene = ef.load(file)
    renderer, names, held = Renderer(scene), stage.scene.rig.names, scene.rig.held_out
    place = {name: number for number, name in enumerate(scene.rig.names) if held[number]}
    seen = [names[index] for index in chosen if names[index] not in place]
    if seen:
        raise SystemExit(f"{file} does not hold out {seen[0]}: encode it with the same --hold-out")
    return lambda index: prepared.drawn(renderer, scene, place[names[index]])[0]


def version(before: Path) -> str:
    """A tree's commit, or a file's digest."""
    if before.is_file():
        return hashlib.sha256(before.read_bytes()).hexdigest()[:16]
    if not (before / "src" / "eigenfield").is_dir():
        raise SystemExit(f"{before} is neither a .glb nor a source tree of eigenfield")
    return measure.commit(before)


def crops(
    stage: Stage, chosen: Sequence[int], ways: Mapping[str, Way], peer: str, heads: Sequence[str], work: Path
) -> Path:
    """WORK/crops-PEER.png: the photograph and all ways, where ours is worse than the peer, and where it is better.

    Of each view the square counts in which the squared errors differ by most; the ROWS most different views are shown.
    """
    found: list[list[tuple[float, tuple[int, int], int]]] = [[], []]
    for index in chosen:
        photograph = stage.capture.photograph(stage.views[index])
        true, covered = to_codes(photograph.pixels), covered_by_proxy(stage, index, photograph.mask)
        mine, theirs = (
            np.square(np.asarray(cv2.subtract(to_codes(ways[key](index)), true, dtype=cv2.CV_32F))).sum(axis=2)
            for key in ("ours", peer)
        )
        for side, difference in zip(found, (mine - theirs, theirs - mine), strict=True):
            side.append((*pictures.largest_square(difference * covered), index))
    rows = []
    for words, side in zip(("worse", "better"), found, strict=True):
        for _, corner, index in sorted(side, key=lambda one: -one[0])[:ROWS]:
            true = to_codes(stage.capture.photograph(stage.views[index]).pixels)
            shown = [true, *(to_codes(draw(index)) for draw in ways.values())]
            label = f"{stage.scene.rig.names[index]}, row {corner[0]}, column {corner[1]}: ours {words}"
            rows.append((label, [pictures.crop(picture, corner) for picture in shown]))
    place = pictures.write_sheet(heads, rows, work / f"crops-{peer}.png")
    print(place, flush=True)
    return place


def caption(row: Mapping[str, Any]) -> str:
    """A way in words, for the head of its crops."""
    return f"{row['key']}: {_size(row)}, {row['psnr']:.2f} / {row['psnr_luma']:.2f} dB"


def _size(row: Mapping[str, Any]) -> str:
    return f"{row['bytes'] / 1000:.1f} kB" if "bytes" in row else "all photographs"


def table(figures: Mapping[str, Any]) -> str:
    """The rows as text."""
    lines = [
        f"{row['key']:>10}  {_size(row):>15}"
        f"  {row['psnr']:.2f} / {row['psnr_luma']:.2f} dB"
        f"  worst {row['worst']['psnr']['value']:.2f} / {row['worst']['psnr_luma']['value']:.2f}"
        f"  SSIM {row['ssim']:.4f}  FLIP {row['flip']:.4f}  near depth edges {100 * row['edge_share']:.0f} %"
        for row in figures["methods"]
    ]
    lines.append(f"near depth edges lie {100 * figures['methods'][0]['edge_pixels']:.0f} % of the pixels")
    return "\n".join([*lines, *(f"left out: {words}" for words in figures["left_out"])])


def worth_keeping(figures: Mapping[str, Any]) -> dict[str, Any]:
    """What the table of the docs shows, small enough for a history."""
    keys = (
        "key",
        *SCORES,
        "psnr_full",
        "coverage",
        "edge_share",
        "edge_pixels",
        "bytes",
        "parameter",
        "order",
        "version",
    )
    methods = [
        {key: row[key] for key in keys if key in row} | {"worst": {key: row["worst"][key]["value"] for key in SCORES}}
        for row in figures["methods"]
    ]
    return {**{key: value for key, value in figures.items() if key != "crops"}, "methods": methods}


if __name__ == "__main__":
    main()
