"""What `eigenfield info` says of a clip: its timeline, and where its bytes are over time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from eigenfield.core.films import FilmPart, FilmPlane
    from eigenfield.gltf.group import GroupHead
    from eigenfield.gltf.read_clip import ClipLayout

BITS = 8  # of a byte
FILM_TYPE = "video/AV1"


def clip_facts(layout: ClipLayout, heads: Sequence[GroupHead]) -> dict[str, Any]:
    """The timeline; and of the groups that are whole the bytes of each film, of frames and a second.

    Args:
        heads: Of these groups.
    """
    timeline, films, groups = layout.timeline, layout.films, layout.groups
    assert timeline is not None and films is not None and groups is not None
    seconds = sum(len(head.frames) for head in heads) / float(timeline.rate)
    found = [
        {
            "size": [columns, rows],
            "bytes": sum(units[film] for head in heads for units in head.frames),
            "key_bytes": sum(head.frames[0][film] for head in heads),
        }
        for film, (rows, columns) in enumerate(films.sizes)
    ]
    return {
        "frames": timeline.frames,
        "rate": [timeline.rate.numerator, timeline.rate.denominator],
        "first": timeline.first,
        "last": float(timeline.times[-1]),
        "groups": [group.frames for group in groups],
        "whole_groups": len(heads),
        "films": found,
        "motion_bytes": sum(head.motion for head in heads),
        "bits_per_second": BITS * sum(group.length for group in groups[: len(heads)]) / seconds,
    }


def film_plane_facts(plane: FilmPlane) -> dict[str, Any]:
    """As of a plane of pictures."""
    return {
        "channels": plane.channels,
        "mean": {"size": _size(plane.mean), "type": FILM_TYPE},
        "bases": [
            {"textures": len(basis.at) // plane.channels, "size": _size(basis), "types": [FILM_TYPE]}
            for basis in plane.bases
        ],
    }


def film_sheet_facts(layout: ClipLayout) -> dict[str, Any] | None:
    """As of sheets whose opacity is a picture; None: one opaque surface."""
    if layout.sheets is None or layout.films is None or layout.films.opacity is None:
        return None
    opacity = {"size": _size(layout.films.opacity), "type": FILM_TYPE}
    return {"triangles": list(layout.sheets), "opacity": opacity}


def _size(part: FilmPart) -> list[int]:
    return [part.size[1], part.size[0]]


def clip_lines(clip: dict[str, Any]) -> list[str]:
    """Five lines at most."""
    rate = clip["rate"][0] / clip["rate"][1]
    groups = ", ".join(f"{count} of {frames}" for frames, count in Counter(clip["groups"]).most_common(3))
    whole = sum(clip["groups"][: clip["whole_groups"]])
    lines = [
        f"clip          {clip['frames']} frames, {rate:g} a second, from {clip['first']:g} to {clip['last']:g} s; "
        f"groups: {groups} frames"
    ]
    if whole < clip["frames"]:
        lines.append(f"cut off       the file ends behind {whole} frames")
    films = [
        f"{film['size'][0]}x{film['size'][1]}, {film['bytes']:,} bytes ({film['key_bytes']:,} in groups' first frames)"
        for film in clip["films"][:3]
    ]
    lines.append(f"films         {'; '.join(films)}")
    if clip["motion_bytes"]:
        lines.append(f"motion        {clip['motion_bytes']:,} bytes: the mesh moves")
    per_frame = clip["bits_per_second"] / BITS / rate / 1000
    lines.append(f"rate          {clip['bits_per_second'] / 1e6:.3g} Mbit/s, {per_frame:.3g} kB a frame")
    return lines
