"""Held-out photographs that take no part in cameras and surface."""

from __future__ import annotations

import pytest

from eigenfield.capture import PhotoSet, Shot, open_capture
from eigenfield.core.errors import OptionError
from eigenfield.reconstruction import SurfaceOptions, whole
from eigenfield.reconstruction.unseen import held_out_names, rule_for, without
from eigenfield.reconstruction.whole import check_settings, reconstruct
from support.captures import write_capture
from support.scenes import row_grid


@pytest.fixture
def capture(tmp_path):
    return open_capture(write_capture(tmp_path / "c", cameras=row_grid(9, 64, 56)))


class StoppedError(Exception):
    pass


def test_neither_points_nor_surface_see_held_out_photographs(capture, monkeypatch):
    seen = []

    def points(light_field, **rest):
        seen.append(light_field.names)
        return []

    def surface(light_field, points, **rest):
        seen.append(light_field.names)
        raise StoppedError

    monkeypatch.setattr(whole, "triangulate_points", points)
    monkeypatch.setattr(whole, "surface_from_views", surface)
    with pytest.raises(StoppedError):
        reconstruct(capture, surface="poisson", blind="every:3", progress=None)
    assert seen == [tuple(name for index, name in enumerate(capture.names) if index % 3 != 1)] * 2


def test_names_follow_the_order_of_all_photographs(capture):
    held = held_out_names("every:4", capture)
    assert held == {capture.names[2], capture.names[6]}
    assert without(capture, held).names == tuple(name for name in capture.names if name not in held)
    assert rule_for(capture, "every:4", held) == "every:4"
    assert rule_for(without(capture, [capture.names[0]]), "every:4", held) == ",".join(sorted(held))
    assert rule_for(without(capture, [capture.names[2]]), "every:4", held) == capture.names[6]
    assert rule_for(without(capture, held), "every:4", held) is None
    assert rule_for(capture, None, frozenset()) is None


def test_names_of_held_out_photographs_may_hold_commas(tmp_path):
    names = tuple(f"Foto 12.03.21, 14 05 {k:02d}.jpg" for k in range(10))
    photos = PhotoSet(tmp_path, tuple(Shot(name, tmp_path / name, 64, 48) for name in names), None, (), "folder")
    held, left = held_out_names("every:5", photos), without(photos, names[:1])
    assert held_out_names(rule_for(left, "every:5", held), left) == held == {names[2], names[7]}


def test_rows_and_columns_are_not_known_of_bare_photographs(tmp_path):
    shots = tuple(Shot(f"{k}.png", tmp_path / f"{k}.png", 64, 48) for k in range(9))
    photos = PhotoSet(tmp_path, shots, None, (), "folder")
    with pytest.raises(OptionError) as caught:
        check_settings(photos, SurfaceOptions(blind="odd"))
    assert caught.value.code == "hold-out" and "--blind" in caught.value.remedy
    assert held_out_names("every:4", photos) == {"2.png", "6.png"}
