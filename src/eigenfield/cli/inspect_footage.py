"""What `eigenfield inspect --clip` says of footage, beside what it says of its first instant."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from eigenfield.capture import Footage
    from eigenfield.core.progress import Progress

DRIFT_MIN_STOPS = 0.3
SURFACE_MIN_CAMERAS = 3  # from which a surface is estimated
STILL_LEAST, STILL_MOST = 0.1, 0.995  # shares of pixels


def describe_footage(footage: Footage, step: int, progress: Progress | None) -> dict[str, Any]:
    """The key `footage` of the report; `docs/capture-formats.md` says what is in it.

    Args:
        step: Frames of its clock from each instant to the next.
    """
    from eigenfield.capture.footage_survey import find_lags, watch

    watched = watch(footage, progress)
    lags = find_lags([one.energy for one in watched])
    timeline = footage.timeline
    return {
        "frames": timeline.frames,
        "rate": [timeline.rate.numerator, timeline.rate.denominator],
        "first": timeline.first,
        "seconds": float(timeline.frames / timeline.rate),
        "looked_at": len(watched[0].energy) + 1,
        "still": sum(one.still for one in watched) / len(watched),
        "cameras": [
            {
                "name": track.name,
                "frames": len(track.times),
                "held": int(held.sum()),
                "damaged": one.damaged,
                "offset": lag.frames * step if lag.known else None,
                "correlation": lag.correlation,
                "stops": one.stops,
                "still": one.still,
            }
            for track, held, one, lag in zip(footage.tracks, footage.held, watched, lags, strict=True)
        ],
    }


def footage_lines(footage: dict[str, Any], offsets: Mapping[str, int]) -> list[str]:
    """Lines for people about the key `footage`.

    Args:
        offsets: That are taken already, by names that people give cameras.
    """
    cameras, rate = footage["cameras"], footage["rate"][0] / footage["rate"][1]
    lines = [
        f"  footage    {len(cameras)} cameras, {footage['frames']} frames at {rate:.4g} a second from "
        f"{footage['first']:.4g} s on: {footage['seconds']:.4g} s"
    ]
    if footage["looked_at"] < footage["frames"]:
        lines.append(f"             the first {footage['looked_at']} frames are looked at")
    if missing := _named(cameras, "held", "{}"):
        lines.append(f"  missing    frames, in whose place the one before is held and masked out: {missing}")
    if damaged := _named(cameras, "damaged", "{}"):
        lines.append(f"  damaged    frames, which are masked out: {damaged}")
    if footage["looked_at"] < 2:
        return [*lines, "  in step    not told: one frame shows no motion"]
    lines += _step_lines(cameras, offsets)
    drifting = [camera for camera in cameras if camera["stops"] > DRIFT_MIN_STOPS]
    most = max(camera["stops"] for camera in cameras)
    drift = f"changes by up to {most:.2f} stops over time"
    if drifting:
        named = _named(drifting, "stops", "{:.2f}")
        drift += f", in {named}: fix exposure and white balance, unless what moves fills the picture"
    return [*lines, f"  light      {drift}", f"  still      {_still_text(footage['still'])}"]


def _step_lines(cameras: list[dict[str, Any]], offsets: Mapping[str, int]) -> list[str]:
    from eigenfield.capture.clip_range import offsets_by_camera

    known = [camera for camera in cameras if camera["offset"] is not None]
    given = offsets_by_camera(offsets, [camera["name"] for camera in cameras])
    late = {
        camera["name"]: camera["offset"] + taken
        for camera, taken in zip(cameras, given, strict=True)
        if camera["offset"]
    }
    if not known:
        return ["  in step    not told: too little moves, or for too short a time"]
    if not late:
        return [f"  in step    {len(known)} of {len(cameras)} cameras, as far as the scene's motion tells"]
    words = " ".join(f"--offset {shlex.quote(f'{name}={frames}')}" for name, frames in late.items())
    return [f"  in step    {len(late)} of {len(cameras)} cameras seem not to be: try {words}"]


def _still_text(share: float) -> str:
    text = f"{share:.0%} of the pixels"
    if share < STILL_LEAST:
        return f"{text}: everything moves, or the light flickers; a clip takes far more bytes then"
    return f"{text}: nothing moves; a scene of one instant shows as much" if share > STILL_MOST else text


def _named(cameras: list[dict[str, Any]], key: str, form: str) -> str:
    from eigenfield.capture.messages import list_names

    return list_names([f"{camera['name']} ({form.format(camera[key])})" for camera in cameras if camera[key]])


def clip_needs(cameras: int, mesh: bool) -> str:
    """Whether `encode --clip` would run, and with what that is not here yet.

    Args:
        cameras: How many are known.
        mesh: Whether one is among the options.
    """
    if not cameras:
        return "would run, with cameras"
    return "would run" if mesh or cameras >= SURFACE_MIN_CAMERAS else "would run, with a mesh"


def clip_commands(chosen: str, words: str, cameras: int, mesh: bool) -> list[str]:
    """Commands that make sense now.

    Args:
        chosen: The capture and the options of this command, and which cameras are left out.
        words: The capture and these options.
        cameras: As of `clip_needs`.
        mesh: As of `clip_needs`.
    """
    if not cameras:
        return [f"eigenfield calibrate {words}"]
    given = "" if mesh or cameras >= SURFACE_MIN_CAMERAS else " --proxy mesh.glb"
    return [f"eigenfield encode {chosen}{given} -o clip.glb"]
