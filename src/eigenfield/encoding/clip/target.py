"""The quality at which a clip reaches a target, found by coding a few of its groups several times."""

from __future__ import annotations

import contextlib
import logging
from dataclasses import dataclass, replace

import numpy as np

from eigenfield.core.clip import Clip, Timeline
from eigenfield.core.progress import Progress
from eigenfield.core.spread import spread_indices
from eigenfield.encoding.clip.closed_loop import code_group, texture_counts
from eigenfield.encoding.clip.films import CodedFilm
from eigenfield.encoding.clip.frames import GroupFrames
from eigenfield.encoding.clip.groups import Groups, open_fitted
from eigenfield.encoding.clip.open_loop import OpenGroup
from eigenfield.encoding.fitted.colour import to_rgb
from eigenfield.encoding.target import Attempt, Target, search_quality
from eigenfield.gltf import coded_clip
from eigenfield.gltf.fallback import with_fallback
from eigenfield.gltf.group import group_bytes
from eigenfield.gltf.write_clip import clip_blocks
from eigenfield.imaging.metrics import psnr, ssim, to_codes
from eigenfield.rendering import Renderer, camera_weights
from eigenfield.runtime.parallel import parallel_stream
from eigenfield.runtime.stages import SCENE_ROOMS, Stages, stage_key

log = logging.getLogger("eigenfield.encode")

SAMPLE_GROUPS = 3  # that are coded at each quality
HEAD_BYTES = 3000  # of a file, beside its groups, its mesh and its cameras; a small fallback is in it
SPARE_RATIO = 0.97  # of a size that is aimed at where not all groups were coded
MEASURED_FRAMES, MEASURED_CAMERAS = 3, 16  # of a group, in which a PSNR or SSIM is measured


@dataclass(frozen=True, eq=False)
class _Sample:
    """A group that was fitted, and waits to be coded."""

    frames: GroupFrames
    opened: OpenGroup
    opacity: CodedFilm | None


def reach_quality(groups: Groups, target: Target, stages: Stages, first: int, progress: Progress | None) -> int:
    """The quality at which the clip has at most a size, or reaches a PSNR or SSIM; where there is none the nearest.

    Groups are fitted once, on the mesh and the atlas of the groups' plan.

    Args:
        target: Without a bitrate.
        first: The quality that is tried first.
    """
    numbers = spread_indices(len(groups.spans), SAMPLE_GROUPS)
    if target.size is not None and len(numbers) < len(groups.spans):
        target = replace(target, size=round(SPARE_RATIO * target.size))
    with contextlib.ExitStack() as kept:
        samples = []
        for number in numbers:
            clip = kept.enter_context(groups.open_run(groups.run_of(number)))
            title = f"trial of group {number + 1} of {len(groups.spans)}"
            key, span = stage_key(["trial", groups.key(number, None)], SCENE_ROOMS), range(*groups.spans[number])
            frames = GroupFrames(clip, groups.footage.instant, span, stages, key, title, progress)
            samples.append(_Sample(*kept.enter_context(open_fitted(frames))))
        found = search_quality(target, lambda quality: _attempt(groups, samples, target, quality), first)
        for sample in samples:
            sample.frames.clear()
    log.info("clip: quality %d, about %d bytes", found.quality, found.size)
    return found.quality


def _attempt(groups: Groups, samples: list[_Sample], target: Target, quality: int) -> Attempt[None]:
    """What the whole clip takes at a quality, by its samples."""
    counts: tuple[int, ...] | None = None
    taken, frames, measured, beside = 0, 0, [], HEAD_BYTES
    for sample in samples:
        clip = sample.frames.clip.at_quality(quality)
        group = replace(sample.frames, clip=clip, identity=stage_key([sample.frames.identity, quality], SCENE_ROOMS))
        counts = texture_counts(clip, sample.opened) if counts is None else counts
        layout = clip.layout(counts)
        coded, _ = code_group(group, sample.opened, layout, sample.opacity)
        data = group_bytes(coded)
        taken, frames = taken + len(data), frames + len(group)
        plan, rate = clip.plan, groups.footage.timeline.rate
        alone = coded_clip(
            plan.views.rig, plan.mesh, Timeline(rate, len(group)), layout, [data], [len(group)],
            to_rgb=to_rgb(), settings={}, scores={}, generator="", payloads=plan.payloads,
            sheets=None if plan.proxy.sheets is None else plan.proxy.sheets.faces,
        )  # fmt: skip
        if target.size is None:
            measured += [_measured(target, alone, group, number)
                         for number in spread_indices(len(group), MEASURED_FRAMES)]  # fmt: skip
        elif sample is samples[0] and plan.asked.fallback == "good":
            beside += _fallback_bytes(alone)
    first, *later = groups.runs
    meshes = sum(len(run.spans) * run.plan.mesh_bytes for run in later)  # each of their groups has its own
    total = taken / frames * len(groups.footage) + beside + first.plan.payloads.bytes + meshes
    return Attempt(quality, round(total), float(np.mean(measured)) if measured else 0.0, None)


def _fallback_bytes(clip: Clip) -> int:
    """What `--fallback good` takes, which is of the first frame."""
    good, none = (sum(map(len, clip_blocks(with_fallback(clip, one), None))) for one in ("good", "none"))
    return good - none


def _measured(target: Target, clip: Clip, group: GroupFrames, number: int) -> float:
    """The mean PSNR or SSIM over covered pixels of some cameras in a frame of a group."""
    scene = clip.scene(float(clip.timeline.times[number]))
    renderer, photographs = Renderer(scene), group.clip.observations(group.instant(group.numbers[number]))

    def of_camera(place: int) -> float | None:
        camera, photograph = int(scene.rig.encoded[place]), photographs.photograph(place)
        drawn = renderer.draw(scene.rig.cameras[camera], camera_weights(scene, camera))
        seen = drawn.covered if photograph.mask is None else drawn.covered & (photograph.mask > 0)
        return (psnr if target.ssim is None else ssim)(drawn.image, to_codes(photograph.pixels), seen)

    some = spread_indices(len(scene.rig.encoded), MEASURED_CAMERAS)
    return float(np.mean([value for value in parallel_stream(of_camera, some) if value is not None]))
