"""A moving sheet from photographs alone: planes of known depth before nine cameras."""

from __future__ import annotations

import logging
from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np
import pytest

from eigenfield.capture import open_footage
from eigenfield.core.mesh import Mesh
from eigenfield.encoding.clip.moving import moving_proxy
from eigenfield.encoding.clip.still import still_capture
from eigenfield.imaging.raster import rasterise_view
from eigenfield.reconstruction.whole import reconstruct
from eigenfield.runtime.stages import Stages
from support.passing import (
    FRAMES,
    HALF_HEIGHT,
    HALF_WIDTH,
    SIDE,
    SQUARE,
    WALL,
    column,
    square,
    wall,
    write_passing,
    write_planes,
)

pytestmark = pytest.mark.slow

MIDDLE = 4  # of the nine cameras


def made(folder, work):
    """Footage, and what `reconstruct` makes of what stands still."""
    footage = open_footage(folder)
    return footage, reconstruct(still_capture(footage, Stages(work)), layers=1, work=work, progress=None)


def sheet_of(folder, work):
    return moving_proxy(*made(folder, work), Stages(work))


def seen(moving, number, camera):
    """(h, w) opacity and depth of the moving sheet before a camera."""
    mesh, first = moving.proxy.mesh, moving.proxy.sheets.faces[0]
    raster = rasterise_view(Mesh(moving.positions[number], mesh.faces[first:], mesh.uv), camera)
    row, across = np.nonzero(raster.face >= 0)
    uv = np.einsum(
        "nk,nkx->nx", raster.corner_shares(row, across), mesh.uv[mesh.faces[first:][raster.face[row, across]]]
    )
    atlas = np.array(moving.opacity[number])
    at = (uv * atlas.shape[::-1] - 0.5).astype(np.float32)
    opacity, depth = np.zeros((SIDE, SIDE)), np.full((SIDE, SIDE), np.inf)
    opacity[row, across] = cv2.remap(atlas, at[:, :1], at[:, 1:], cv2.INTER_LINEAR)[:, 0]
    depth[row, across] = 1 / raster.inverse_depth[row, across]
    return opacity, depth


def square_mask(middle):
    rows, columns = np.mgrid[:SIDE, :SIDE]
    return (abs(columns - middle) < HALF_WIDTH) & (abs(rows - SIDE / 2) < HALF_HEIGHT)


def agreement(opacity, mask):
    """Intersection over union."""
    return np.minimum(opacity, mask).sum() / np.maximum(opacity, mask).sum()


@pytest.fixture(scope="module")
def passing(tmp_path_factory):
    folder = tmp_path_factory.mktemp("passing")
    return folder / "work", write_passing(folder / "footage")


@pytest.fixture(scope="module")
def moving(passing):
    work, folder = passing
    return sheet_of(folder, work)


def test_a_square_passes_on_a_sheet_of_its_own(passing, moving):
    camera = open_footage(passing[1]).cameras[MIDDLE]
    assert moving.opacity.shape[0] == len(moving.positions) == FRAMES
    for number in range(1, FRAMES - 1):
        opacity, depth = seen(moving, number, camera)
        mask = square_mask(column(number))
        assert agreement(opacity, mask) > 0.9, number
        inner = cv2.erode(mask.astype(np.uint8), np.ones((5, 5), np.uint8)) > 0
        np.testing.assert_allclose(depth[inner], SQUARE, rtol=0.08)


def test_topology_and_pixels_stay_and_the_still_relief_is_opaque(passing, moving):
    mesh, sheets = moving.proxy.mesh, moving.proxy.sheets
    camera = open_footage(passing[1]).cameras[MIDDLE]
    first, own = sheets.faces[0], np.unique(mesh.faces[sheets.faces[0] :])
    assert sum(sheets.faces) == len(mesh.faces) and 100 < sheets.faces[1] < 6000
    np.testing.assert_array_equal(sheets.opacity, moving.opacity[0])
    assert not np.intersect1d(own, np.unique(mesh.faces[:first])).size
    behind = np.setdiff1d(np.arange(len(mesh.vertices)), own)
    np.testing.assert_array_equal(
        moving.positions[:, behind], np.broadcast_to(mesh.vertices[behind], (FRAMES, len(behind), 3))
    )
    pixels = [camera.project(places[own])[0] for places in moving.positions]
    np.testing.assert_allclose(pixels, np.broadcast_to(pixels[0], np.shape(pixels)), atol=0.02)
    depth = rasterise_view(Mesh(mesh.vertices, mesh.faces[:first]), camera).inverse_depth
    np.testing.assert_allclose(1 / depth[10:-10, 10:-10], WALL, rtol=0.05)
    at = (mesh.uv[mesh.faces[:first]].mean(axis=1) * sheets.opacity.shape[::-1]).astype(int)
    assert (moving.opacity[:, at[:, 1], at[:, 0]] == 1).all()
    assert moving.proxy.lattice is not None and moving.proxy.lattice.flat


def test_vertices_stay_where_nothing_is_seen_near_them(moving):
    changes = [np.abs(after - before).max(axis=1) > 0 for before, after in pairwise(moving.positions)]
    assert np.mean(changes) < 0.3


def test_finished_frames_are_taken_up(passing, moving):
    work, folder = passing
    said = []
    again = moving_proxy(*made(folder, work), Stages(work), lambda stage, done, total: said.append((stage, done)))
    np.testing.assert_array_equal(again.positions, moving.positions)
    np.testing.assert_array_equal(again.opacity, moving.opacity)
    assert {stage for stage, _ in said} <= {"moving sheet", "step"}
    assert len([path for path in work.iterdir() if path.name.startswith("moving-")]) == FRAMES


@pytest.mark.parametrize("kind", ["still", "light"])
def test_where_nothing_moves_there_is_no_sheet(tmp_path, caplog, kind):
    light = (lambda frame: 1.0) if kind == "still" else (lambda frame: 0.7 + 0.06 * frame)
    folder = write_planes(tmp_path / "footage", FRAMES, lambda frame: [square(48), wall()], light=light)
    with caplog.at_level(logging.INFO, "eigenfield"):
        assert sheet_of(folder, tmp_path / "work") is None
    assert any("moving sheet: none" in line and "opaque" in line for line in caplog.messages)


def test_a_surface_that_is_no_relief_has_none(passing, caplog):
    work, folder = passing
    footage, found = made(folder, work)
    with caplog.at_level(logging.INFO, "eigenfield"):
        assert moving_proxy(footage, replace(found, reference=None), Stages(work)) is None
    assert any("look one way" in line for line in caplog.messages)


def test_what_enters_and_leaves(tmp_path):
    frames = [None, None, 36.0, 48.0, 60.0, None, None]
    layers = lambda frame: [wall()] if frames[frame] is None else [square(frames[frame]), wall()]  # noqa: E731
    folder = write_planes(tmp_path / "footage", len(frames), layers)
    found, camera = sheet_of(folder, tmp_path / "work"), open_footage(folder).cameras[MIDDLE]
    for number, middle in enumerate(frames):
        opacity, _ = seen(found, number, camera)
        if middle is None:
            assert opacity.max() < 0.05, number
        else:
            assert agreement(opacity, square_mask(middle)) > 0.88, number


def test_a_cut_in_the_middle_of_a_clip_gives_something_sound(tmp_path):
    layers = lambda frame: [square(30), wall()] if frame < 3 else [square(64, seed=8), wall(seed=9)]  # noqa: E731
    folder = write_planes(tmp_path / "footage", FRAMES, layers)
    found = sheet_of(folder, tmp_path / "work")
    if found is not None:
        assert np.isfinite(found.positions).all()
        assert found.opacity.min() >= 0 and found.opacity.max() <= 1


def test_a_camera_without_a_frame_takes_no_part_in_it(tmp_path):
    folder = write_passing(tmp_path / "footage")
    (folder / "cam_1_1" / "000003.png").unlink()
    found, camera = sheet_of(folder, tmp_path / "work"), open_footage(folder).cameras[MIDDLE]
    opacity, depth = seen(found, 3, camera)
    assert agreement(opacity, square_mask(column(3))) > 0.7
    assert np.median(depth[square_mask(column(3))]) == pytest.approx(SQUARE, rel=0.08)
