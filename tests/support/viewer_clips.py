"""A numbered clip for the tests of the web viewer.

    PYTHONPATH=tests python -m support.viewer_clips FOLDER

writes into FOLDER

    clip.glb     frames that show their numbers (`support.clips`), in groups of 5, 7, 1 and 12
    far.glb      the same, 2 MB from group to group
    heard.glb    the same with a sound of three seconds, which begins half a second late
    folder/      heard.glb, whose groups and sound are files
    short.glb, long.glb, short/, long/  frames 0 to 59, and these fifty times, in groups of 30: as files and as folders
    moving.glb   the same on a mesh that moves, but for the third group, in which it is where the file's mesh is; the
                 second group has a mesh of its own
    moving.json  for each frame the positions of all vertices, three numbers each
    clip-sheets.glb  the same with a second sheet, which moves and shows the number by its opacity
    clip-sheets-N.png  what its last camera sees in frame N
    clip.json    {"groups": frames of each, "strengths" of each, "places": first byte of each and that behind it,
                 "held": in far.glb the byte behind the first,
                 "rate", "bits" of a number, "textures", "codes": for each frame the SHA-256 of the codes of each film,
                 two bytes a code, the lower first, "sheetCodes": those of clip-sheets.glb, "front": the row of the
                 atlas at which its second sheet is read, "drawn": frames of which there is a picture, "size" of these}
"""

from __future__ import annotations

import hashlib
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from eigenfield.coding.video.film import decode_film
from eigenfield.core.clip import Audio, Clip
from eigenfield.gltf import save
from eigenfield.gltf.clips import CodedGroups
from eigenfield.rendering import ViewWeights, renderer_of
from eigenfield.viewer.exports import write_clip_folder
from support.clips import (
    BITS,
    FRONT_MIDDLE,
    STRENGTHS,
    TEXTURES_COUNT,
    finer_mesh,
    groups_of,
    moving_clip,
    numbered_clip,
    repeated_clip,
    with_groups,
)
from support.sounds import opus

GROUPS = (5, 7, 1, 12)
DRAWN, SHOWN = (0, 7, 22), (288, 240)


def write(folder: Path) -> None:
    """Write both files into a folder that is there."""
    clip = numbered_clip(GROUPS)
    rate = clip.timeline.rate
    save(clip, folder / "clip.glb", overwrite=True)
    sheets = moving_clip(numbered_clip(GROUPS, sheets=True), front_steps)
    save(sheets, folder / "clip-sheets.glb", overwrite=True)
    data = (folder / "clip.glb").read_bytes()
    places = [(data.index(group), data.index(group) + len(group)) for group in groups_of(data)]
    for number in DRAWN:
        last = sheets.scene(float(sheets.timeline.times[number]))
        picture = renderer_of(last).draw(last.rig.cameras[-1].resize(*SHOWN), ViewWeights.one(3), samples=1)
        Image.fromarray(picture.to_uint8()).save(folder / f"clip-sheets-{number}.png")
    facts = {
        "groups": list(GROUPS), "strengths": STRENGTHS[: len(GROUPS)], "places": places,
        "rate": [rate.numerator, rate.denominator], "bits": BITS, "textures": TEXTURES_COUNT, "codes": digests(clip),
        "front": FRONT_MIDDLE, "sheetCodes": digests(sheets), "drawn": DRAWN, "size": SHOWN,
    }  # fmt: skip
    save(replace(clip, audio=Audio(opus(3), 0.5)), folder / "heard.glb", overwrite=True)
    write_clip_folder(folder / "heard.glb", folder / "folder", overwrite=True)
    short = numbered_clip((30, 30), rate)
    for name, made in (("short", short), ("long", repeated_clip(short, 50))):
        save(made, folder / f"{name}.glb", overwrite=True)
        write_clip_folder(folder / f"{name}.glb", folder / name, overwrite=True)
    far = with_groups(data, groups_of(data), gap=2**21)
    (folder / "far.glb").write_bytes(far)
    facts["held"] = far.index(groups_of(data)[0]) + len(groups_of(data)[0])
    (folder / "clip.json").write_text(json.dumps(facts), encoding="utf-8")
    moving = moving_clip(clip, steps, {1: finer_mesh(clip)})
    save(moving, folder / "moving.glb", overwrite=True)
    found = [moving.scene(float(time)).proxy.mesh.vertices.reshape(-1).tolist() for time in moving.timeline.times]
    (folder / "moving.json").write_text(json.dumps(found), encoding="utf-8")


def steps(number: int, places: NDArray[np.int64]) -> NDArray[np.int64]:
    """Lattice coordinates of a frame: to and fro by pixels, and every third vertex nearer."""
    if number in range(sum(GROUPS[:2]), sum(GROUPS[:3])):
        return places
    moved = places + np.array([6 * (number % 8) - 24, number % 3, 0])
    moved[::3, 2] += number
    return moved


def front_steps(number: int, places: NDArray[np.int64]) -> NDArray[np.int64]:
    """Lattice coordinates of a frame in which the second sheet, which is nearest, goes to and fro and comes nearer."""
    front = places[:, 2] > 0.97 * places[:, 2].max()
    moved = places.copy()
    moved[front] += np.array([2 * (number % 4) - 3, 0, number % 5])
    return moved


def digests(clip: Clip) -> list[list[str]]:
    """For each frame one of each film."""
    groups = clip.groups
    assert isinstance(groups, CodedGroups)
    listed: list[list[str]] = []
    for index in range(len(groups.lengths)):
        units = zip(*groups.coded(index).units, strict=True)
        films = [decode_film(own, size, "the film") for own, size in zip(units, groups.layout.sizes, strict=True)]
        listed += [[_digest(codes) for codes in frame] for frame in zip(*films, strict=True)]
    return listed


def _digest(codes: NDArray[np.uint16]) -> str:
    return hashlib.sha256(codes.astype("<u2").tobytes()).hexdigest()


if __name__ == "__main__":
    write(Path(sys.argv[1]))
