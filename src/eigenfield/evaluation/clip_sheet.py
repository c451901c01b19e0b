"""Pictures of a clip beside its photographs: frames downwards, viewpoints across."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from eigenfield.core.clip import Clip
from eigenfield.core.rig import Rig
from eigenfield.core.spread import spread_indices
from eigenfield.evaluation.clip import Instants, open_clip_session
from eigenfield.evaluation.plots import new_figure, png_bytes
from eigenfield.evaluation.strip import CLIP_SHEET_FILE
from eigenfield.imaging.metrics import PictureArray, to_codes
from eigenfield.runtime.files import make_folder, write_bytes

CLIP_SHEET_FRAMES, CLIP_SHEET_VIEWS = 6, 3  # at most
CLIP_SHEET_INCHES = 2.2  # width of a picture

SheetRow = tuple[str, list[tuple[str, PictureArray]]]  # words on a frame, and pictures with titles


def write_clip_sheet(clip: Clip, footage: Instants, folder: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
    """Write the contact sheet of a clip into a folder, which is created if need be; its path. OutputError
    `output-exists`, or the folder cannot be written; errors of `evaluate_clip`."""
    folder = Path(folder)
    make_folder(folder)
    write_bytes(folder / CLIP_SHEET_FILE, png_bytes(_figure(sheet_rows(clip, footage))), overwrite=overwrite)
    return folder / CLIP_SHEET_FILE


def sheet_views(rig: Rig, known: list[int]) -> list[int]:
    """Indices of some cameras of those that are known, evenly spread, a held-out one among them if there is one."""
    some = [known[index] for index in spread_indices(len(known), CLIP_SHEET_VIEWS)]
    held_out = [index for index in known if rig.held_out[index]]
    if held_out and not any(rig.held_out[index] for index in some):
        some[len(some) // 2] = held_out[len(held_out) // 2]
    return some


def sheet_rows(clip: Clip, footage: Instants) -> list[SheetRow]:
    """Each n-th frame from the first on, with the photograph and the drawn picture of some cameras."""
    session = open_clip_session(clip, footage)
    rig, rows = session.first.rig, []
    views = sheet_views(rig, sorted(session.views))
    frames = clip.timeline.frames
    for frame in range(0, frames, -(-frames // CLIP_SHEET_FRAMES)):
        here = session.at(frame)
        pictures: list[tuple[str, PictureArray]] = []
        for index in views:
            name = rig.names[index] + (", held out" if rig.held_out[index] else "")
            pictures += [(f"{name}\nphotograph", here.photograph(index).pixels), ("\ndrawn", here.picture(index).image)]
        rows.append((f"frame {frame}, {float(clip.timeline.times[frame]):.2f} s", pictures))
    return rows


def _figure(rows: list[SheetRow]) -> Figure:
    height, width = rows[0][1][0][1].shape[:2]
    columns = len(rows[0][1])
    tall = CLIP_SHEET_INCHES * height / width + 0.1
    figure = new_figure(columns * CLIP_SHEET_INCHES + 0.4, len(rows) * tall + 0.6)
    grid = figure.subplots(len(rows), columns, squeeze=False)
    for number, (words, pictures) in enumerate(rows):
        line = grid[number]
        for axes, (title, picture) in zip(line, pictures, strict=True):
            axes.imshow(to_codes(np.asarray(picture)), interpolation="antialiased")
            axes.set(xticks=[], yticks=[])
            axes.spines[:].set_visible(False)
            if number == 0:
                axes.set_title(title, fontsize=9, loc="left", parse_math=False)
        line[0].set_ylabel(words, fontsize=9)
    return figure
