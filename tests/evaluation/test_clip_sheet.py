"""The contact sheet of a clip: which frames and cameras it shows, and their pictures beside each other."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from eigenfield.core.errors import OutputError
from eigenfield.evaluation.clip_sheet import sheet_rows, sheet_views, write_clip_sheet
from eigenfield.evaluation.strip import CLIP_SHEET_FILE
from eigenfield.imaging.metrics import to_codes
from support.moving_clips import tiny_clip, write_footage


@pytest.fixture
def clip():
    return tiny_clip((5, 4), lambda frame, mean: mean + 0.01 * frame, cameras=9, size=32, held_out=(3,))


def test_some_cameras_are_shown_with_a_held_out_one_in_their_middle(clip):
    assert sheet_views(clip.rig, list(range(9))) == [0, 3, 8]
    assert sheet_views(clip.rig, [0, 1, 2, 4]) == [0, 2, 4]  # rounds half to even
    assert sheet_views(clip.rig, [3, 5]) == [3, 5] and sheet_views(clip.rig, [7]) == [7]
    none = replace(clip.rig, held_out=(False,) * 9)
    assert sheet_views(none, list(range(9))) == [0, 4, 8]


def test_each_row_is_a_frame_and_has_each_photograph_beside_what_is_drawn(clip, tmp_path):
    rows = sheet_rows(clip, write_footage(clip, tmp_path / "f"))
    assert [words for words, _ in rows] == [f"frame {n}, {n / 30:.2f} s" for n in (0, 2, 4, 6, 8)]
    means = []
    for _, pictures in rows:
        assert len(pictures) == 6
        assert [title.split("\n")[1] for title, _ in pictures] == ["photograph", "drawn"] * 3
        assert [", held out" in title for title, _ in pictures] == [False, False, True, False, False, False]
        for (_, photograph), (_, drawn) in zip(pictures[::2], pictures[1::2], strict=True):
            np.testing.assert_array_equal(to_codes(photograph), to_codes(drawn))
        means.append(pictures[0][1].mean())
    assert np.all(np.diff(means) > 0.005)


@pytest.mark.slow
def test_the_sheet_is_a_picture_and_replaces_none_unasked(clip, tmp_path):
    footage = write_footage(clip, tmp_path / "f")
    path = write_clip_sheet(clip, footage, tmp_path / "plots")
    assert path == tmp_path / "plots" / CLIP_SHEET_FILE
    picture = cv2.imread(str(path))
    assert picture.shape[1] > 1500 and np.ptp(picture) > 200
    with pytest.raises(OutputError) as caught:
        write_clip_sheet(clip, footage, tmp_path / "plots")
    assert caught.value.code == "output-exists"
    write_clip_sheet(clip, footage, tmp_path / "plots", overwrite=True)
