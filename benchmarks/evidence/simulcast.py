"""Peers of a clip: its cameras' videos as AV1, measured as the clip is, and views between them as a lumigraph.

Each camera has a stream of its own, with a key picture where the clip's groups begin (`keys`) or with one in all
(`one-key`); or one stream goes through all cameras and frames (`joint`).
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture import match_photographs, with_scene_cameras
from eigenfield.coding.video.av1 import decode_video, encode_video
from eigenfield.core.clip import Clip, Timeline
from eigenfield.core.proxy import opaque_mesh
from eigenfield.core.scene import Scene
from eigenfield.evaluation.clip import Instants, Row, figures_of
from eigenfield.evaluation.flicker import Flicker, StillPixels
from eigenfield.evaluation.image import measure_picture
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.raster import rasterise_view
from eigenfield.runtime.parallel import parallel_map
from evidence.codecs import order
from evidence.colour import Picture, even, pad, to_planes, to_rgb
from evidence.lumigraph import draw_lumigraph, make_lumigraph

WAYS = ("keys", "one-key", "joint")
CRFS = (24, 32, 40, 48, 56, 63)

Coded = tuple[str, int, list[Picture]]  # camera, bytes, what is decoded


@dataclass(frozen=True, eq=False)
class Taken:
    """The photographs of a clip, decoded.

    Attributes:
        clip: For cameras and proxy.
        starts: The first frame of each group.
        pictures: By camera, those of each frame.
        covered: By camera, (H, W) what the first frame's proxy covers and no frame's mask hides.
    """

    clip: Clip
    starts: Sequence[int]
    pictures: Mapping[str, list[Picture]]
    covered: Mapping[str, NDArray[np.bool_]]

    @property
    def timeline(self) -> Timeline:
        return self.clip.timeline

    @property
    def held_out(self) -> list[str]:
        return [name for name, held in zip(self.clip.rig.names, self.clip.rig.held_out, strict=True) if held]

    @property
    def encoded(self) -> list[str]:
        return [name for name, held in zip(self.clip.rig.names, self.clip.rig.held_out, strict=True) if not held]

    def scene(self, frame: int) -> Scene:
        return self.clip.scene(float(self.timeline.times[frame]))

    @cached_property
    def still(self) -> dict[str, NDArray[np.bool_]]:
        """By camera, what stands still in its photographs."""

        def of_camera(name: str) -> NDArray[np.bool_]:
            found = StillPixels()
            for picture in self.pictures[name]:
                found.add(picture)
            return found.still

        return dict(zip(self.pictures, parallel_map(of_camera, list(self.pictures)), strict=True))


def take(footage: Instants, clip: Clip) -> Taken:
    """Decode all photographs of a clip's frames.

    Args:
        footage: What the clip was made of.
        clip: Whose groups say where streams have keys.
    """
    scene, timeline = clip.scene(float(clip.timeline.times[0])), clip.timeline
    names = scene.rig.names
    covered = {name: rasterise_view(opaque_mesh(scene.proxy), camera).face >= 0
               for name, camera in zip(names, scene.rig.cameras, strict=True)}  # fmt: skip
    pictures: dict[str, list[Picture]] = {name: [] for name in names}
    for moment in timeline.times:
        capture = with_scene_cameras(scene, footage.instant(footage.timeline.frame_at(float(moment))))
        views = match_photographs(scene, capture)
        photographs = parallel_map(capture.photograph, list(views.values()))
        for index, photograph in zip(views, photographs, strict=True):
            pictures[names[index]].append(to_codes(photograph.pixels))
            if photograph.mask is not None:
                covered[names[index]] &= photograph.mask > 0.5
    return Taken(clip, [0, *accumulate(clip.groups.lengths)][:-1], pictures, covered)


def code(frames: Sequence[Picture], crf: int, preset: int) -> tuple[int, list[Picture]]:
    """Bytes of a stream of pictures of one size, with one key picture, and what is decoded."""
    height, width = frames[0].shape[:2]
    size = even(height, width)
    data = encode_video((to_planes(pad(frame, *size)) for frame in frames), size, crf, preset)
    decoded = decode_video(data, size, len(frames), "a peer's stream", "video")
    return len(data), [to_rgb(planes, height, width) for planes in decoded]


def streams(taken: Taken, way: str, crf: int, preset: int) -> Iterator[Coded]:
    """The encoded cameras' frames, coded in one of WAYS. The bytes of `joint` are all at its first camera."""
    if way == "joint":
        yield from _joint(taken, crf, preset)
        return
    frames = taken.timeline.frames
    starts = [*taken.starts, frames] if way == "keys" else [0, frames]
    for name in taken.encoded:
        parts = [code(taken.pictures[name][start:stop], crf, preset) for start, stop in pairwise(starts)]
        yield name, sum(size for size, _ in parts), [picture for _, some in parts for picture in some]


def _joint(taken: Taken, crf: int, preset: int) -> Iterator[Coded]:
    """One stream: at each time all cameras, to and fro, and back at the next."""
    names = taken.encoded
    way = [names[index] for index in order(taken.clip.rig.encoded_cameras)]
    path = [(name, frame) for frame in range(taken.timeline.frames) for name in (way if frame % 2 == 0 else way[::-1])]
    size, decoded = code([taken.pictures[name][frame] for name, frame in path], crf, preset)
    found = dict(zip(path, decoded, strict=True))
    for number, name in enumerate(way):
        yield name, 0 if number else size, [found[name, frame] for frame in range(taken.timeline.frames)]


def point(taken: Taken, coded: Iterable[Coded], between: Sequence[int]) -> dict[str, Any]:
    """Bytes and figures of one way at one rate, short enough for a history.

    Args:
        taken: The photographs.
        coded: Of `streams`.
        between: Frames at which held-out cameras are drawn from the decoded streams.
    """
    began = time.perf_counter()
    size, flickers, rows = 0, {}, []
    shown: dict[int, dict[str, Picture]] = {frame: {} for frame in between}
    for name, some, pictures in coded:
        size += some
        flickers[name] = Flicker(taken.still[name])
        rows += _measure(taken, name, pictures, flickers[name])
        for frame in between:
            shown[frame][name] = pictures[frame]
    held = [row for frame in between for row in _between(taken, frame, shown[frame])]
    figures = figures_of([*rows, *held], flickers, taken.held_out, taken.timeline, taken.starts)
    return {"bytes": size, "seconds": round(time.perf_counter() - began, 1), **short(figures)}


def short(figures: Mapping[str, Any]) -> dict[str, Any]:
    """What tables show of the figures of `figures_of`."""
    encoded, held_out = figures["image"]["encoded"], figures["image"]["held_out"]
    keys = ("psnr", "psnr_luma", "ssim")
    return {
        **{key: encoded[key] for key in keys},
        "fifth": encoded["fifth"]["psnr_luma"],
        "worst": encoded["worst"]["psnr_luma"]["value"],
        "held_out": None if held_out is None else {key: held_out[key] for key in keys},
        "flicker": figures["flicker"]["encoded"],
        "border": figures["border"]["encoded"],
    }


def _measure(taken: Taken, name: str, pictures: Sequence[Picture], flicker: Flicker) -> list[Row]:
    covered, photographs = taken.covered[name], taken.pictures[name]
    scores = parallel_map(lambda frame: measure_picture(pictures[frame], covered, photographs[frame]),
                          list(range(len(pictures))))  # fmt: skip
    for picture, photograph in zip(pictures, photographs, strict=True):
        flicker.add(picture, photograph, covered)
    return [(frame, name, one) for frame, one in enumerate(scores)]


def _between(taken: Taken, frame: int, shown: Mapping[str, Picture]) -> list[Row]:
    """Held-out cameras at a frame, drawn from what was decoded of the others."""
    rig = taken.clip.rig
    if not taken.held_out:
        return []
    names = [name for name in rig.names if name in shown]
    cameras = dict(zip(rig.names, rig.cameras, strict=True))
    lumigraph = make_lumigraph(
        opaque_mesh(taken.scene(frame).proxy),
        [cameras[name] for name in names],
        lambda index: (shown[names[index]].astype(np.float32) / np.float32(255), None),
    )
    rows = []
    for name in taken.held_out:
        drawn = to_codes(draw_lumigraph(lumigraph, cameras[name])[0])
        rows.append((frame, name, measure_picture(drawn, taken.covered[name], taken.pictures[name][frame])))
    return rows
