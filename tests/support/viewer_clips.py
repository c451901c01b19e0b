"""A numbered clip for the tests of the web viewer.

    PYTHONPATH=tests python -m support.viewer_clips FOLDER

writes into FOLDER

    clip.glb     frames that show their numbers (`support.clips`), in groups of 5, 7, 1 and 12
    moving.glb   the same on a mesh that moves, but for the third group, in which it is where the file's mesh is
    moving.json  for each frame the positions of all vertices, three numbers each
    clip-sheets.glb  the same with a second sheet, which moves and shows the number by its opacity
    clip.json    {"groups": frames of each, "strengths" of each, "places": first byte of each and that behind it,
                 "rate", "bits" of a number, "textures", "codes": for each frame the SHA-256 of the codes of each film,
                 two bytes a code, the lower first, "sheetCodes": those of clip-sheets.glb, "front": the row of the
                 atlas at which its second sheet is read}
"""

from __future__ import annotations

import hashlib
import json
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.video.film import decode_film
from eigenfield.core.clip import Clip
from eigenfield.gltf import save
from eigenfield.gltf.clips import CodedGroups
from support.clips import BITS, FRONT_MIDDLE, STRENGTHS, TEXTURES_COUNT, groups_of, moving_clip, numbered_clip

GROUPS = (5, 7, 1, 12)


def write(folder: Path) -> None:
    """Write both files into a folder that is there."""
    clip = numbered_clip(GROUPS)
    rate = clip.timeline.rate
    save(clip, folder / "clip.glb", overwrite=True)
    sheets = moving_clip(numbered_clip(GROUPS, sheets=True), front_steps)
    save(sheets, folder / "clip-sheets.glb", overwrite=True)
    data = (folder / "clip.glb").read_bytes()
    places = [(data.index(group), data.index(group) + len(group)) for group in groups_of(data)]
    facts = {
        "groups": list(GROUPS), "strengths": STRENGTHS[: len(GROUPS)], "places": places,
        "rate": [rate.numerator, rate.denominator], "bits": BITS, "textures": TEXTURES_COUNT, "codes": digests(clip),
        "front": FRONT_MIDDLE, "sheetCodes": digests(sheets),
    }  # fmt: skip
    (folder / "clip.json").write_text(json.dumps(facts), encoding="utf-8")
    moving = moving_clip(clip, steps)
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
