"""Clips beside AV1 streams of their cameras and beside our own stills, in one run, every byte counted.

    EIGENFIELD_DATA=captures python benchmarks/video.py [CLIP...] [--out out/video] [--size N] [--grid N] [--frames N]
        [--group 1s] [--qualities 60,75,88,94] [--peers keys-6,one-key-6,keys-2,joint-6] [--stills N] [--store]

CLIP: `light`, the demo's scene with still geometry and moving light, and `demo`, in motion, both drawn on the first run
and kept; `demo-bare`, the same without its meshes; `cloth` and `panoptic`, of EIGENFIELD_DATA; `tarot`, 20 of its
photographs at half size again and again with fresh noise. --size and --grid are of those that are drawn, --frames of
these and `tarot`. Every fifth camera is held out, and takes no part in surfaces, clips, streams and stills; of
`panoptic`, which is no array, none is.

Ours is one file a quality: encoded, saved, read and drawn again. A peer is a way of `evidence.simulcast` with a preset
of SVT-AV1 behind it: one stream a camera with a key picture where our groups begin (`keys`), one stream a camera with
one key (`one-key`), and one stream through all cameras and frames (`joint`). Their held-out views are drawn from the
decoded streams as a lumigraph on our mesh. `--stills N` encodes N of the frames by themselves at the same qualities.
What is done stays in OUT, and a run that was stopped goes on while the code is the same.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import eigenfield as ef
import measure
from eigenfield.capture import Footage, open_capture, open_footage
from eigenfield.capture.holdout import held_out_cameras
from eigenfield.core.clip import Clip
from eigenfield.core.proxy import MovingProxy, Proxy
from eigenfield.core.spread import spread_indices
from eigenfield.demo import CLIP_MESHES, draw_demo_clip
from eigenfield.encoding import EncodeOptions, encode_footage
from eigenfield.encoding.clip.still import estimate_still_surface
from eigenfield.evaluation.clip import evaluate_clip
from eigenfield.evaluation.strip import write_strip
from eigenfield.gltf import load_clip, parts
from eigenfield.proxy.meshes.sequence import is_sequence, mesh_files
from eigenfield.reconstruction import SurfaceOptions
from evidence import captures, moving_light, rates, simulcast
from evidence.repeated import repeat
from evidence.runner import kept
from evidence.simulcast import Taken

QUALITIES = "60,75,88,94"
PEERS = "keys-6,one-key-6,keys-2,joint-6"
BETWEEN = 4  # frames at which held-out cameras are drawn of peers
KEYS = ("psnr_luma", "psnr", "ssim")


@dataclass(frozen=True)
class Source:
    """Where a clip comes from.

    Attributes:
        proxy: A mesh file, or the pattern of one for each frame; None: it is made from the photographs of the encoded
            cameras, of what stands still and, where cameras look one way, of what moves.
        hold_out: Rule of `encode --hold-out`; None: all cameras are encoded.
    """

    name: str
    folder: Path
    proxy: Path | None = None
    hold_out: str | None = "every:5"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clips", nargs="*", metavar="CLIP")
    parser.add_argument("--out", type=Path, default=Path("out") / "video")
    parser.add_argument("--size", type=int, default=320)
    parser.add_argument("--grid", type=int, default=5)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--group", default="1s", help="as of encode")
    parser.add_argument("--qualities", default=QUALITIES)
    parser.add_argument("--peers", default=PEERS)
    parser.add_argument("--stills", type=int, default=3)
    parser.add_argument("--store", action="store_true", help="append to benchmarks/results/video.json")
    options = parser.parse_args()
    out = options.out.resolve()
    figures = {}
    for name in options.clips or ["light"]:
        source = source_of(name, out, options.size, options.grid, options.frames)
        qualities = [int(quality) for quality in options.qualities.split(",")]
        peers = [peer for peer in options.peers.split(",") if peer]
        work = out / source.name
        figures[source.name] = of_clip(source, work, options.group, qualities, peers, options.stills)
        print(f"\n{source.name}\n{table(figures[source.name])}", flush=True)
    if options.store:
        print(measure.store("video", {"captures": figures}))


def source_of(name: str, out: Path, size: int, grid: int, frames: int) -> Source:
    """A clip by its name; `light` and `demo` are drawn where they are not there. SystemExit: there is none of that
    name."""
    if name == "light":
        whole = f"light-{grid}x{grid}-{size}-{frames}"
        folder = moving_light.draw_clip(out / "clips" / whole, grid, grid, size, frames)
        return Source(whole, folder, folder / moving_light.PROXY)
    if name in ("demo", "demo-bare"):
        whole = f"{grid}x{grid}-{size}-{frames}"
        folder = out / "clips" / f"demo-{whole}"
        draw_demo_clip(folder, rows=grid, columns=grid, size=size, frames=frames)
        return Source(f"{name}-{whole}", folder, folder / CLIP_MESHES if name == "demo" else None)
    if name in ("cloth", "panoptic"):
        folder = measure.data() / {"cloth": "clip_cloth_5x4", "panoptic": "panoptic_arc_10"}[name]
        return Source(name, folder, hold_out=None if name == "panoptic" else "every:5")
    if name == "tarot":
        known = captures.named("tarot-5x4", out)
        whole = f"tarot-{frames}"
        capture = open_capture(known.folder, calibration=known.calibration).reduced(2)
        return Source(whole, repeat(capture, out / "clips" / whole, frames), known.proxy)
    raise SystemExit(f"no clip is called {name}: name light, demo, demo-bare, tarot, cloth or panoptic")


def of_clip(
    source: Source, work: Path, group: str, qualities: Sequence[int], peers: Sequence[str], stills: int
) -> dict[str, Any]:
    """All curves of one clip, each part kept when it is done."""
    work.mkdir(parents=True, exist_ok=True)
    footage = open_footage(source.folder)
    proxy = source.proxy or proxy_of(source, footage, work)

    def part(name: str, make: Callable[[], dict[str, Any]], more: str = "") -> dict[str, Any]:
        return kept(work / "parts" / f"{name}.json", Path(__file__), make, f"{group} {more}")

    points = [part(f"clip-{quality}", partial(our_point, source, footage, proxy, work, group, quality))
              for quality in qualities]  # fmt: skip
    clip = load_clip(work / f"clip-{qualities[-1]}.glb")
    taken = simulcast.take(footage, clip)
    curves = {peer: part(peer, partial(peer_curve, taken, peer))["points"] for peer in peers}
    frames = [int(frame) for frame in spread_indices(clip.timeline.frames, stills)] if stills else []
    singles = [part(f"stills-{quality}", partial(our_stills, source, footage, proxy, work, clip, quality, frames),
                    str(frames)) for quality in qualities if frames]  # fmt: skip
    return {
        "cameras": len(taken.encoded), "held_out": len(taken.held_out), "frames": clip.timeline.frames,
        "rate": float(clip.timeline.rate), "groups": list(clip.groups.lengths),
        "size": list(next(iter(taken.pictures.values()))[0].shape[:2]),
        "ours": points, "peers": curves, "stills": singles,
        "bd": {peer: {key: rates.bd_rate(curve, points, key) for key in KEYS} for peer, curve in curves.items()},
    }  # fmt: skip


def proxy_of(source: Source, footage: Footage, work: Path) -> Proxy | MovingProxy:
    """The surface that the encoded cameras show; its stages are kept."""
    held = held_out_cameras(source.hold_out, footage.names, np.zeros((len(footage.names), 2)))
    encoded = footage.subset(np.flatnonzero(~held).tolist())
    _, proxy, _ = estimate_still_surface(encoded, EncodeOptions(), SurfaceOptions(layers=1), work / "surface", None)
    return proxy


def our_point(
    source: Source, footage: Footage, proxy: Path | Proxy | MovingProxy, work: Path, group: str, quality: int
) -> dict[str, Any]:
    """A file of a quality, read and measured again."""
    path = work / f"clip-{quality}.glb"
    began = time.perf_counter()
    options = EncodeOptions(quality=quality, hold_out=source.hold_out, group=group)
    clip = encode_footage(footage, proxy, options, work=work / f"stages-{quality}", progress=None)
    ef.save(clip, path, overwrite=True)
    seconds = time.perf_counter() - began
    figures = evaluate_clip(path, footage, progress=None)
    write_strip(figures, work / f"plots-{quality}", overwrite=True)
    point = {
        "parameter": quality, "bytes": path.stat().st_size, "encode_seconds": round(seconds, 1),
        "parts": dict(parts(path)), **simulcast.short(figures),
    }  # fmt: skip
    print(f"{source.name}: quality {quality}: {line(point)}", flush=True)
    return point


def proxy_at(proxy: Path | Proxy | MovingProxy, frame: int) -> Path | Proxy:
    """The surface of a frame: of a sequence or of sheets its own, or the one that stands still."""
    if isinstance(proxy, MovingProxy):
        mesh = replace(proxy.proxy.mesh, vertices=proxy.positions[frame])
        sheets = proxy.proxy.sheets
        if sheets is not None and proxy.opacity is not None:
            sheets = replace(sheets, opacity=np.array(proxy.opacity[frame]))
        return replace(proxy.proxy, mesh=mesh, sheets=sheets)
    return mesh_files(proxy)[frame] if isinstance(proxy, Path) and is_sequence(proxy) else proxy


def our_stills(
    source: Source,
    footage: Footage,
    proxy: Path | Proxy | MovingProxy,
    work: Path,
    clip: Clip,
    quality: int,
    frames: Sequence[int],
) -> dict[str, Any]:
    """Some frames encoded by themselves; bytes are scaled up to all frames."""
    sizes, figures, seconds = [], [], 0.0
    for frame in frames:
        path = work / f"still-{quality}-{frame}.glb"
        capture = footage.instant(footage.timeline.frame_at(float(clip.timeline.times[frame])))
        began = time.perf_counter()
        surface = proxy_at(proxy, frame)
        ef.encode(capture, surface, quality=quality, hold_out=source.hold_out, progress=None).save(path, overwrite=True)
        seconds += time.perf_counter() - began
        sizes.append(path.stat().st_size)
        figures.append(ef.evaluate(path, capture, png_maps="none", progress=None)["image"]["encoded"])
    point = {
        "parameter": quality, "bytes": round(sum(sizes) / len(frames) * clip.timeline.frames), "frames": list(frames),
        "encode_seconds": round(seconds / len(frames), 1),
        **{key: sum(one[key] for one in figures) / len(frames) for key in KEYS},
    }  # fmt: skip
    print(f"{source.name}: stills of quality {quality}: {line(point)}", flush=True)
    return point


def peer_curve(taken: Taken, peer: str) -> dict[str, Any]:
    """A way of `simulcast` and a preset, joined by a hyphen, at all rates."""
    way, _, preset = peer.rpartition("-")
    between = [int(frame) for frame in spread_indices(taken.timeline.frames, BETWEEN)]
    points = []
    for crf in simulcast.CRFS:
        coded = simulcast.streams(taken, way, crf, int(preset))
        points.append({"parameter": crf, **simulcast.point(taken, coded, between)})
        print(f"{peer}, crf {crf}: {line(points[-1])}", flush=True)
    return {"points": points}


def line(point: dict[str, Any]) -> str:
    """A point in words."""
    words = [f"{point['bytes'] / 1000:.1f} kB, {point['psnr_luma']:.2f} dB luma, {point['psnr']:.2f} RGB"]
    if (between := rates.held_out_luma(point)) is not None:
        words.append(f"held out {between:.2f}")
    if (levels := rates.flicker(point)) is not None:
        words.append(f"flicker {levels:.2f} levels")
        if (changes := point["flicker"]["moving_ssim"]) is not None:  # something moves
            words.append(f"SSIM of changes {changes:.3f}")
    if point.get("border"):
        words.append(f"step {point['border']['step']:.2f} dB")
    return ", ".join(words)


def table(found: dict[str, Any]) -> str:
    """Our bytes over the peers' at equal luma, and what is drawn between cameras and flickers at equal bytes."""
    lines = []
    for name, curve in (*found["peers"].items(), ("stills", found["stills"])):
        if not curve:
            continue
        for point in found["ours"]:
            theirs = rates.bytes_at(curve, point["psnr_luma"], "psnr_luma")
            ratio = "not reached" if theirs is None else f"{point['bytes'] / theirs:.3f} of {theirs / 1000:.1f} kB"
            words = [f"{name}, quality {point['parameter']}, {point['psnr_luma']:.2f} dB: {ratio}"]
            for what, of in (("held out", rates.held_out_luma), ("flicker", rates.flicker)):
                value = rates.value_at(curve, point["bytes"], of)
                words += [] if value is None else [f"{what} at equal bytes {value:.3f}"]
            lines.append("; ".join(words))
    return "\n".join(lines)


if __name__ == "__main__":
    main()
