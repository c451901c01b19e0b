"""Footage of a rig in, a clip out: the whole way on one page."""

from __future__ import annotations

import hashlib
import logging
import math
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from eigenfield.capture.readers.audio import read_opus
from eigenfield.core.arguments import kind_in_words
from eigenfield.core.clip import Audio, Clip, Timeline
from eigenfield.core.errors import OptionError, ProxyError, one_line
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import CalibratedObservations
from eigenfield.core.progress import Progress, begin_step
from eigenfield.core.proxy import MovingProxy, Proxy
from eigenfield.core.rights import Rights
from eigenfield.core.version import __version__
from eigenfield.encoding.clip.backmost import settle_backmost
from eigenfield.encoding.clip.digest import footage_digest
from eigenfield.encoding.clip.groups import Groups, MadeGroup, Run
from eigenfield.encoding.clip.motion import moving_mesh
from eigenfield.encoding.clip.still import estimate_still_surface, refuse_sheets, surface_of_clip
from eigenfield.encoding.clip.target import reach_quality
from eigenfield.encoding.fitted.colour import to_rgb
from eigenfield.encoding.options import PRESETS, EncodeOptions, resolved_value
from eigenfield.encoding.plan import EncodePlan
from eigenfield.encoding.prepare import coded_plan, plan_encoding
from eigenfield.encoding.reach_target import REFIT_MAX_NEAR_QUALITIES
from eigenfield.encoding.target import Target
from eigenfield.gltf.clips import coded_clip
from eigenfield.gltf.fallback import with_fallback
from eigenfield.proxy import refuse_no_mesh
from eigenfield.proxy.atlas.unwrap import UNWRAP_MIN_TRIANGLES
from eigenfield.proxy.meshes.sequence import is_sequence, read_sequences
from eigenfield.reconstruction import SurfaceOptions
from eigenfield.runtime.files import make_folder
from eigenfield.runtime.objects import find_objects
from eigenfield.runtime.parallel import even_pieces
from eigenfield.runtime.stages import SCENE_ROOMS, Stages, stage_key
from eigenfield.runtime.tasks import Workers

if TYPE_CHECKING:
    from eigenfield.capture.footage import Footage

log = logging.getLogger("eigenfield.encode")

GivenProxy = str | os.PathLike[str] | Mesh | Proxy | MovingProxy | Sequence[str | os.PathLike[str] | Mesh]
DEFAULT_GROUP = "1s"
GROUP_PATTERN = re.compile(r"(\d{1,9})|(\d{1,9}(?:\.\d*)?|\.\d+)s")  # frames, or seconds
GROUP_LIMITS = 1, 1024  # frames
TARGET_ROUNDS = 2  # of searches, the second one on another mesh
SHOWN_NUMBERS = 8  # of frames in a message
STILL_OPTIONS = (  # that have no meaning for clips
    "uv_ssim", "align", "max_angle", "codec", "keep_maps", "residual", "harmonise",
)  # fmt: skip


def encode_clip(
    footage: Footage,
    proxy: GivenProxy | None,
    asked: EncodeOptions,
    work: Path | None = None,
    progress: Progress | None = None,
    workers: Workers | None = None,
    given: SurfaceOptions | None = None,
    sound: str | os.PathLike[str] | None = None,
) -> Clip:
    """A clip on a proxy that stands still, or on a mesh for each frame, or on sheets that change with time.

    Its frames share the weights of their group (equation 6, summed over its frames).

    Args:
        proxy: Opaque; or a mesh for each frame (`read_sequences`), or a `MovingProxy`, maybe of sheets, the backmost of
            which is opaque. None: the surface that `still_capture` shows.
        asked: Options; those that clips have no use for are refused.
        work: Folder that keeps finished stages, or an address of an object store; None: nothing is kept.
        workers: That make all groups but the first, which says how many textures there are; they see `work` and the
            footage. None: this process makes all.
        given: How a surface is made that is not given; None for the defaults.
        sound: An Ogg file of Opus, which begins at second 0 of the footage.

    Raises:
        OptionError: `clip-proxy`, `clip-cameras`, `clip-option`, `group-unknown`, `target`.
        CaptureError, ProxyError, OutputError: As `encode`.
    """
    refuse_still_options(asked)
    if isinstance(proxy, MovingProxy) and proxy.proxy.sheets is None:
        proxy = [replace(proxy.proxy.mesh, vertices=own) for own in proxy.positions]
    surface = surface_of_clip(asked, given or SurfaceOptions(), has_proxy=proxy is not None)
    _refuse_proxy(footage, proxy, asked)
    audio = None if sound is None else Audio(read_opus(sound))
    length = group_length(asked.group, footage.timeline.rate)
    target = _target_of_frames(asked.target, footage.timeline, audio)
    scratch = None if work is None or find_objects(work) else work  # such files stay on this machine
    if scratch is not None:
        make_folder(scratch)
    if surface is not None:
        footage, proxy, asked = estimate_still_surface(footage, asked, surface, work, progress)
    assert proxy is not None
    digest = footage_digest(footage)

    def groups_of(asked: EncodeOptions) -> Groups:
        runs = _runs(footage, proxy, asked, length, scratch, progress)
        meshes = [[_plan_digest(run.plan), None if run.moving is None else run.moving.digest] for run in runs]
        key = stage_key([digest, replace(asked, rights=None, fallback=None), meshes], SCENE_ROOMS)
        return Groups(footage, tuple(runs), key, scratch)

    with Stages(None if work is None else work / "clip") as stages:
        groups = groups_of(asked)
        if target is not None:
            asked = _reach_target(groups, groups_of, asked, target, stages, progress)
            groups = groups_of(asked)
        begin_step(progress, "fit")
        made, layout = groups.make_all(stages, workers, progress)
    plan = groups.runs[0].plan
    clip = coded_clip(
        plan.views.rig,
        plan.mesh,
        footage.timeline,
        layout,
        [one.data for one in made],
        [last - first for first, last in groups.spans],
        to_rgb=to_rgb(),
        settings=_settings(plan, made, asked),
        scores={},
        generator=f"eigenfield {__version__}",
        payloads=plan.payloads,
        sheets=None if plan.proxy.sheets is None else plan.proxy.sheets.faces,
    )
    clip = replace(clip, audio=audio, rights=asked.rights or Rights())
    return clip if asked.fallback is None else with_fallback(clip, asked.fallback)


def _target_of_frames(asked: Target | None, timeline: Timeline, sound: Audio | None) -> Target | None:
    """The target for all but the sound, without a bitrate. OptionError `target`: nothing is left."""
    if asked is None or (asked.size is None and asked.bitrate is None):
        return asked
    size = asked.size or math.floor((asked.bitrate or 0) / 8 * timeline.frames / timeline.rate)
    taken = len(b"" if sound is None else sound.data)
    if size <= taken:
        message = f"a target of {size} bytes leaves nothing beside {taken} bytes of sound"
        raise OptionError("target", message, remedy="ask for more, or give a sound of a lower bitrate")
    return Target(size=size - taken)


def _reach_target(
    groups: Groups,
    groups_of: Callable[[EncodeOptions], Groups],
    asked: EncodeOptions,
    target: Target,
    stages: Stages,
    progress: Progress | None,
) -> EncodeOptions:
    """The options with the quality that reaches the target. Where that is far from the preset's, it is searched again
    on the mesh and the atlas that belong to it.

    Args:
        target: Of `_target_of_frames`.
    """
    begin_step(progress, "trial")
    usual = PRESETS[resolved_value(groups.runs[0].plan.options.preset)].quality
    found = usual
    for _ in range(TARGET_ROUNDS):
        before = found
        found = reach_quality(groups, target, stages, before, progress)
        asked = replace(asked, target=None, quality=found)
        if abs(found - before) <= REFIT_MAX_NEAR_QUALITIES:
            break
        groups = groups_of(asked)
    return asked


def _runs(
    footage: Footage,
    proxy: GivenProxy,
    asked: EncodeOptions,
    length: int,
    work: Path | None,
    progress: Progress | None,
) -> list[Run]:
    """All frames on a mesh that stands still or on sheets, which is planned by the middle instant. Or frames in a row
    whose meshes have the same triangles, each planned by its first instant on its own mesh as it is given.

    Args:
        length: Of a group, in frames, at most.
    """
    if not is_sequence(proxy):
        middle = cast("CalibratedObservations", footage.instant(len(footage) // 2))
        spans = _spans(0, len(footage), length)
        if not isinstance(proxy, MovingProxy):
            plan = plan_encoding(middle, cast("Mesh", proxy), asked, work, progress)
            return [Run(spans, coded_plan(plan))]  # texture maps, too, are made on what decoders find
        settled = settle_backmost(middle, len(footage) // 2, proxy, asked, work, progress)
        plan = plan_encoding(middle, settled.proxy, asked, work, progress, exact=True)
        moving = moving_mesh(plan, settled.positions, opacity=settled.opacity)
        moving.check_groups(spans)
        return [Run(spans, plan, moving)]
    origin = cast("CalibratedObservations", footage.instant(0)).origin
    sequences = read_sequences(cast("str", proxy), len(footage), origin)
    runs: list[Run] = []
    for sequence in sequences:
        whole = replace(asked, triangles=max(len(sequence.mesh.faces), UNWRAP_MIN_TRIANGLES))
        if runs:  # cameras and the size of films are those of the clip
            rig = runs[0].plan.views.rig
            whole = replace(whole, atlas=runs[0].plan.atlas, reference=rig.names[rig.reference])
        first = cast("CalibratedObservations", footage.instant(sequence.first))
        plan = plan_encoding(first, sequence.mesh, whole, work, progress, exact=True)
        if runs:
            plan = replace(plan, views=plan.views.with_cameras(rig.cameras))
        origins, end = sequence.vertices_of(plan.prepared.proxy.mesh), sequence.first + len(sequence.positions)
        moving = moving_mesh(plan, sequence.positions, origins, first=sequence.first)
        runs.append(Run(_spans(sequence.first, end, length), plan, moving))
        moving.check_groups(runs[-1].spans)
    if len(runs) > 1:
        numbers = ", ".join(str(sequence.first) for sequence in sequences[1:][:SHOWN_NUMBERS])
        more = "" if len(runs) <= SHOWN_NUMBERS + 1 else ", ..."
        log.info("meshes with other triangles begin at frames %s%s: a group begins there", numbers, more)
    return runs


def _spans(first: int, end: int, length: int) -> tuple[tuple[int, int], ...]:
    """Groups of about the same length from a frame up to, and without, another one."""
    count = end - first
    return tuple((first + start, first + stop) for start, stop in even_pieces(count, -(-count // length)))


def group_length(text: str | None, rate: Fraction) -> int:
    """Frames of a group, from seconds (1.5s) or frames (30); None: of a second, or of one frame where that is longer.
    OptionError `group-unknown`."""
    if text is None:
        return max(GROUP_LIMITS[0], min(round(rate), GROUP_LIMITS[1]))
    match = GROUP_PATTERN.fullmatch(text.strip())
    if match is not None:
        frames = int(match[1]) if match[1] else round(float(match[2]) * rate)
        if GROUP_LIMITS[0] <= frames <= GROUP_LIMITS[1]:
            return frames
    remedy = f"say seconds (1s) or frames (30), {GROUP_LIMITS[0]} to {GROUP_LIMITS[1]} frames"
    raise OptionError("group-unknown", f"--group {one_line(text[:40])} is no length of a group", remedy=remedy)


def refuse_still_options(asked: EncodeOptions) -> None:
    """Raise OptionError `clip-option` for what has no meaning for clips, or has none yet."""
    given = [name for name in STILL_OPTIONS if getattr(asked, name) not in (None, False, "none")]
    if given:
        name = f"--{given[0].replace('_', '-')}"
        remedy = "leave it out, or encode one instant without --clip"
        raise OptionError("clip-option", f"{name} is for scenes of one instant", remedy=remedy)


def _refuse_proxy(footage: Footage, proxy: GivenProxy | None, asked: EncodeOptions) -> None:
    """Raise an error where cameras are not known, or the proxy is none for clips."""
    if footage.cameras is None:
        remedy = "find them with calibrate --clip, and give the result as --calibration"
        raise OptionError("clip-cameras", "the cameras of this footage are not known", remedy=remedy)
    several: list[Any] = [] if isinstance(proxy, str) or not isinstance(proxy, Sequence) else list(proxy)
    for one in several or ([] if proxy is None else [proxy]):
        single = isinstance(one, Proxy | MovingProxy | Sequence) and not several
        if not isinstance(one, str | os.PathLike | Mesh) and not single:
            remedy = "give a mesh, its file, or one of them for each frame"
            raise OptionError("proxy", f"{kind_in_words(one)} is no proxy", remedy=remedy)
    if is_sequence(proxy) or isinstance(proxy, MovingProxy):
        given = [name for name, is_given in (("triangles", asked.triangles is not None), ("fit", asked.fit == "none"))
                 if is_given]  # fmt: skip
        if given:
            remedy = "leave it out, or give one mesh that stands still"
            raise OptionError("clip-option", f"--{given[0]} is for meshes that stand still", remedy=remedy)
    elif isinstance(proxy, str | os.PathLike):
        refuse_no_mesh(Path(proxy))
    elif isinstance(proxy, Proxy) and proxy.sheets is not None:
        refuse_sheets()
    if isinstance(proxy, MovingProxy) and len(proxy.positions) != len(footage):
        message = f"a surface in {len(proxy.positions)} frames, the clip has {len(footage)}"
        raise ProxyError("proxy-count", message, remedy="make it for this footage")


def _plan_digest(plan: EncodePlan) -> list[Any]:
    """What stands for mesh and cameras as they are coded, and the atlas."""
    streams = sorted(hashlib.sha256(one.data).hexdigest() for found in plan.payloads.values() for one in found)
    return [streams, plan.atlas]


def _settings(plan: EncodePlan, made: Sequence[MadeGroup], asked: EncodeOptions) -> dict[str, Any]:
    """What the file says about how it was made."""
    counts, options = made[0].counts, plan.options
    psnr = [round(value, 2) for one in made for value in one.psnr]
    own = {"fit": options.fit, "clip": {"group": asked.group or DEFAULT_GROUP, "quality": options.quality,
                                        "textures": list(counts), "psnr": psnr}}  # fmt: skip
    return plan.settings(max(counts), own)
