"""All scores of a clip against its footage: one frame after the other, all cameras of a frame at once."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from eigenfield.capture import Capture, LightField, match_photographs, open_footage, with_scene_cameras
from eigenfield.core.arguments import checked
from eigenfield.core.clip import Clip, Timeline
from eigenfield.core.errors import OptionError
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.evaluation.flicker import Flicker, StillPixels, border_step, pool_flicker
from eigenfield.evaluation.image import HIGHER_IS_WORSE, ImageScores, covered_pixels, measure_picture
from eigenfield.evaluation.session import Session
from eigenfield.gltf import load_clip, parts
from eigenfield.imaging.metrics import to_codes
from eigenfield.rendering import Renderer
from eigenfield.runtime.parallel import parallel_map

CLIP_EVALUATION_SCHEMA = "eigenfield.evaluate-clip/1"
CLOCK_TOLERANCE = 0.1  # frames by which times of clip and footage may differ, by rounding
FIFTH_PERCENT = 5  # of pictures that are worse than `fifth`

Row = tuple[int, str, ImageScores]  # frame, name of the camera, its scores


class Instants(Protocol):
    """Footage as the measures see it."""

    @property
    def timeline(self) -> Timeline:
        """Its own, on the clip's clock."""

    def instant(self, number: int) -> Capture:
        """The photographs of all cameras at a frame."""


@dataclass(frozen=True, eq=False)
class ClipSession:
    """A clip beside its footage.

    Attributes:
        first: The clip's first scene, whose cameras all have.
        views: From the index of a camera to that of its photograph at any time.
        textures: The first so many are drawn.
    """

    clip: Clip
    footage: Instants
    first: Scene
    views: Mapping[int, int]
    textures: int
    filter: str
    weights: str
    flip: bool

    def photographs(self, frame: int) -> LightField:
        """Of all cameras at a frame of the clip."""
        moment = float(self.clip.timeline.times[frame])
        return with_scene_cameras(self.first, self.footage.instant(self.footage.timeline.frame_at(moment)))

    def at(self, frame: int) -> Session:
        """A frame's scene beside its photographs."""
        scene = self.clip.scene(float(self.clip.timeline.times[frame]))
        return Session(
            scene, self.photographs(frame), self.views, Renderer(scene), (self.textures,), frozenset(), self.filter,
            self.weights, atlas=None, max_angle=0, reference=None, circles=None, packed=frozenset(), flip=self.flip,
        )  # fmt: skip

    def look(self, frame: int, cameras: Mapping[int, StillPixels]) -> None:
        """Show the photographs of a frame to those that look for what does not change."""
        capture = self.photographs(frame)

        def camera(index: int) -> None:
            photograph = capture.photograph(self.views[index])
            cameras[index].add(to_codes(photograph.pixels), photograph.mask)

        parallel_map(camera, list(cameras))

    def measure(self, frame: int, flickers: Mapping[int, Flicker]) -> list[Row]:
        """The scores of a frame's pictures, which are also compared with those of the frame before."""
        session = self.at(frame)

        def camera(index: int) -> Row:
            photograph, drawn = session.photograph(index), session.picture(index)
            codes, pixels = to_codes(drawn.image), to_codes(photograph.pixels)
            flickers[index].add(codes, pixels, covered_pixels(drawn.covered, photograph.mask))
            scores = measure_picture(codes, drawn.covered, pixels, photograph.mask, self.flip)
            return frame, self.first.rig.names[index], scores

        return parallel_map(camera, list(flickers))


@checked
def evaluate_clip(
    clip: Clip | str | os.PathLike[str],
    footage: Instants | str | os.PathLike[str],
    *,
    path: str | os.PathLike[str] | None = None,
    every: int = 1,
    textures: int | None = None,
    filter: str = "bicubic",
    weights: str = "delaunay",
    flip: bool = False,
    progress: Progress | None = notebook_progress,
) -> dict[str, Any]:
    """Measure a clip against its footage; docs/measures.md defines every score. The result is JSON-able.

    Args:
        clip: The clip, or its file.
        footage: What it was made of, or its folder; where it has no cameras, it takes the clip's by name.
        path: The clip's file, for `bytes`, which is None without it. Default: the file that `clip` is.
        every: Measure each so many frames, beginning with the first, and both frames at each border of groups.
        textures: Use only so many textures.
        filter: "bicubic" or "bilinear", for drawing.
        weights: View weights of held-out cameras: "delaunay", "nearest3" or "bilinear".
        flip: Measure FLIP too, which takes longer.
        progress: Called for each frame; by default a bar in a notebook.

    Raises:
        CaptureError: `no-photographs`: no photograph has the name of a camera. `photograph-size`. As for reading
            footage.
        OptionError: `every`, `textures` or `settings-unknown`; `time`, the footage ends before the clip, or has its
            frames at other times.
    """
    started = time.monotonic()
    if not isinstance(clip, Clip):
        path = clip if path is None else path
        clip = load_clip(clip)
    if isinstance(footage, str | os.PathLike):
        footage = open_footage(Path(footage))
    session = open_clip_session(clip, footage, textures, filter, weights, flip)
    frames, starts = measured_frames(clip, every)
    still = {index: StillPixels() for index in session.views}
    for frame in track(frames, "looking for what stands still", len(frames), progress):
        session.look(frame, still)
    flickers = {index: Flicker(one.still) for index, one in still.items()}
    rows: list[Row] = []
    for frame in track(frames, "measuring", len(frames), progress):
        rows += session.measure(frame, flickers)
    names = session.first.rig.names
    scores = {
        "schema": CLIP_EVALUATION_SCHEMA,
        "frames": clip.timeline.frames,
        "measured": len(frames),
        "textures": session.textures,
        "filter": filter,
        "weights": weights,
        **figures_of(
            rows,
            {names[index]: flicker for index, flicker in flickers.items()},
            [names[index] for index in session.views if session.first.rig.held_out[index]],
            clip.timeline,
            starts,
        ),
        "bytes": None if path is None else _bytes(clip, Path(path)),
        "missing": [name for index, name in enumerate(names) if index not in session.views],
        "seconds": time.monotonic() - started,
    }
    rounded: dict[str, Any] = json.loads(json.dumps(scores), parse_float=lambda text: round(float(text), 6))
    return rounded  # more decimals are noise


def measured_frames(clip: Clip, every: int) -> tuple[list[int], list[int]]:
    """The frames that are measured, increasing, and the first frame of each group. OptionError `every`."""
    if every < 1:
        raise OptionError("every", f"each {every} frames cannot be measured", remedy="give a whole number from 1 on")
    starts = [0, *accumulate(clip.groups.lengths)][:-1]
    borders = {frame for start in starts[1:] for frame in (start - 1, start)}
    return sorted({*range(0, clip.timeline.frames, every), *borders}), starts


def figures_of(
    rows: Sequence[Row],
    flickers: Mapping[str, Flicker],
    held_out: Sequence[str],
    timeline: Timeline,
    starts: Sequence[int],
) -> dict[str, Any]:
    """All figures of measured pictures, whoever made them: a clip or a codec.

    Args:
        rows: Of all pictures that were measured.
        flickers: By camera, shown the same pictures. A camera may have none.
        held_out: Names of cameras.
        timeline: Of the frames.
        starts: The first frame of each group.

    Returns:
        `image`, `flicker` and `border` for "encoded" and "held_out" cameras, `over_time`, `group_times` and `cameras`.
    """
    moving = {name: flicker.figures for name, flicker in flickers.items()}
    names = list(dict.fromkeys(name for _, name, _ in rows))
    kinds = {
        "encoded": [name for name in names if name not in held_out],
        "held_out": [name for name in names if name in held_out],
    }
    of_kind = {kind: [row for row in rows if row[1] in some] for kind, some in kinds.items()}
    over_time = {kind: _over_time(some) for kind, some in of_kind.items()}
    pooled = {kind: [moving[name] for name in some if name in moving] for kind, some in kinds.items()}
    frames = sorted({frame for frame, _, _ in rows})
    return {
        "image": {kind: _summary(some, len(kinds[kind])) for kind, some in of_kind.items()},
        "flicker": {kind: pool_flicker(some) if some else None for kind, some in pooled.items()},
        "border": {kind: border_step({frame: one["psnr"] for frame, one in some.items()}, starts)
                   for kind, some in over_time.items()},
        "over_time": [
            {"frame": frame, "time": float(timeline.times[frame])}
            | {kind: over_time[kind].get(frame) for kind in kinds} for frame in frames
        ],
        "group_times": [float(timeline.times[start]) for start in starts],
        "cameras": [
            {"name": name, "held_out": name in held_out, **moving.get(name, {})}
            | _means([scores for _, camera, scores in rows if camera == name], ("psnr", "psnr_luma", "ssim"))
            for name in names
        ],
    }  # fmt: skip


def _means(scores: Sequence[ImageScores], keys: Sequence[str]) -> dict[str, float | None]:
    found = {key: [value for one in scores if (value := one[key]) is not None] for key in keys}
    return {key: float(np.mean(values)) if values else None for key, values in found.items()}


def _summary(rows: Sequence[Row], cameras: int) -> dict[str, Any] | None:
    """Mean, fifth percentile and worst of each key over all pictures."""
    if not rows:
        return None
    worst: dict[str, Any] = {}
    fifth: dict[str, float | None] = {}
    for key in rows[0][2]:
        found = [(value, name, frame) for frame, name, scores in rows if (value := scores[key]) is not None]
        high = key in HIGHER_IS_WORSE
        pick, percent = (max, 100 - FIFTH_PERCENT) if high else (min, FIFTH_PERCENT)
        value, name, frame = pick(found, key=lambda one: one[0], default=(None, None, None))
        worst[key] = None if value is None else {"value": value, "camera": name, "frame": frame}
        fifth[key] = float(np.percentile([one[0] for one in found], percent)) if found else None
    means = _means([scores for _, _, scores in rows], list(rows[0][2]))
    return {"cameras": cameras, "pictures": len(rows), **means, "fifth": fifth, "worst": worst}


def _over_time(rows: Sequence[Row]) -> dict[int, dict[str, Any]]:
    """Means over cameras of each frame in which some camera covers something, and its worst and best PSNR."""
    by_frame: dict[int, list[ImageScores]] = {}
    for frame, _, scores in rows:
        if scores["psnr"] is not None:
            by_frame.setdefault(frame, []).append(scores)
    return {
        frame: _means(some, ("psnr", "psnr_luma", "ssim"))
        | {f"psnr_{name}": pick(one["psnr"] or 0.0 for one in some) for name, pick in (("worst", min), ("best", max))}
        for frame, some in by_frame.items()
    }


def open_clip_session(
    clip: Clip,
    footage: Instants,
    textures: int | None = None,
    filter: str = "bicubic",
    weights: str = "delaunay",
    flip: bool = False,
) -> ClipSession:
    """Check that clip and footage belong together. Arguments and errors are those of `evaluate_clip`."""
    moment = float(clip.timeline.times[0])
    scene = clip.scene(moment)
    views = match_photographs(scene, with_scene_cameras(scene, footage.instant(footage.timeline.frame_at(moment))))
    footage.timeline.frame_at(float(clip.timeline.times[-1]))
    numbers = (clip.timeline.times - footage.timeline.first) * float(footage.timeline.rate)
    if np.abs(numbers - np.rint(numbers)).max() > CLOCK_TOLERANCE:
        raise OptionError(
            "time",
            f"frames of the clip, {float(clip.timeline.rate):.4g} a second, lie between those of the footage, "
            f"{float(footage.timeline.rate):.4g} a second",
            remedy="give the --rate and the --clip with which the clip was encoded",
        )
    most = scene.appearance.textures
    count = most if textures is None else textures
    if not 0 <= count <= most:
        raise OptionError(
            "textures", f"{count} textures were asked for, the clip has {most}", remedy=f"ask for 0 to {most}"
        )
    return ClipSession(clip, footage, scene, views, count, filter, weights, flip)


def _bytes(clip: Clip, path: Path) -> dict[str, Any]:
    """The file's bytes by part, and what a frame and a second take of them."""
    sizes = dict(parts(path))
    total, timeline = sizes["total"], clip.timeline
    return {
        **sizes,
        "kilobytes_a_frame": total / 1000 / timeline.frames,
        "megabits_a_second": 8e-6 * total * float(timeline.rate) / timeline.frames,
    }
