"""Texels that a frame hides are held, so that films code no change of them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from eigenfield.core.mesh import Mesh
from eigenfield.encoding.clip.hidden import hidden_held

SHOWN, BESIDE, HIDDEN = 10.0, 0.5, 0.0


class Frames:
    """Arrays by name for each frame, as of a pass."""

    def __init__(self, arrays):
        self.arrays = arrays

    def __iter__(self):
        return iter(self.arrays)

    def each(self, name):
        return iter([one[name] for one in self.arrays])


def strip(first, last):
    """A rectangle of the atlas, from one column to another, of 16."""
    return np.array([(first, 0), (last, 0), (last, 16), (first, 16)], np.float32) / 16


def clip_of(sheets):
    """A still sheet in the left half of the atlas and a moving one at its right."""
    uv = np.concatenate([strip(0, 6), strip(10, 16)])
    faces = np.array([(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)], np.int32)
    mesh = Mesh(np.zeros((8, 3), np.float32), faces, uv)
    return SimpleNamespace(planes=[None], plan=SimpleNamespace(mesh=mesh), moving=SimpleNamespace(sheets=sheets))


def passed(share_of_column):
    """Three frames whose texels are 1, 2 and 3, and their shares by column."""
    frames = Frames([{"mean0": np.full((1, 16, 16), value, np.float32)} for value in (1, 2, 3)])
    shares = [np.full((16, 16), SHOWN, np.float32) for _ in range(3)]
    for frame, column, share in share_of_column:
        shares[frame][:, column] = share
    return frames, Frames([{"mean0-share": one} for one in shares])


HIDDEN_TEXELS = [
    (0, 2, HIDDEN), (1, 2, HIDDEN),  # uncovered in the last frame
    (0, 3, HIDDEN), (1, 3, BESIDE), (2, 3, SHOWN),  # at an outline in between
    (1, 4, HIDDEN),  # covered in between
    (0, 13, HIDDEN), (1, 14, HIDDEN),  # of the moving sheet
]  # fmt: skip


def test_what_is_uncovered_on_the_backmost_sheet_is_there_before():
    found = [one[0][0, 8] for one in hidden_held(clip_of((2, 2)), *passed(HIDDEN_TEXELS), "mean")]
    assert [row[2] for row in found] == [3, 3, 3]
    assert [row[3] for row in found] == [3, 2, 3]
    assert [row[4] for row in found] == [1, 1, 3]
    assert [row[5] for row in found] == [1, 2, 3]
    assert [row[13] for row in found] == [1, 2, 3] and [row[14] for row in found] == [1, 1, 3]


def test_a_single_surface_holds_the_first_frame():
    found = [one[0][0, 8] for one in hidden_held(clip_of(()), *passed(HIDDEN_TEXELS), "mean")]
    assert [row[2] for row in found] == [1, 1, 3] and [row[4] for row in found] == [1, 1, 3]


def test_what_stands_still_as_a_whole_is_as_it_is():
    frames, shares = passed(HIDDEN_TEXELS)
    clip = clip_of(())
    clip.moving = None
    assert [float(one[0].max()) for one in hidden_held(clip, frames, shares, "mean")] == [1, 2, 3]
