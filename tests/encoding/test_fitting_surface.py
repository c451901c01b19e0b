"""The surface moved to where the photographs agree on it: known depths found again, and what must stay as it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.core.camera import Camera
from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.encoding.fitted import surface
from eigenfield.encoding.fitted.surface import fit_surface
from eigenfield.encoding.fitted.surface_kernels import gather_steps
from eigenfield.encoding.geometry.coded import DEPTH_ERROR_PX
from eigenfield.gltf import encode_scene
from eigenfield.proxy.relief.find_lattice import relief_lattice
from eigenfield.rendering import draw_texture
from support.captures import write_capture
from support.observations import InMemory, repeated
from support.scenes import row_grid, smooth_pictures
from support.surfaces import relief

SIDE = 96


def sheet(depth: float, nodes: int = 9) -> Mesh:
    """A square at z = depth - 3 that fills every frame of `row_grid`, in front of its cameras."""
    steps = np.linspace(0, 1, nodes)
    v, u = np.meshgrid(steps, steps, indexing="ij")
    points = np.stack([6 * u - 3, 6 * v - 3, np.full_like(u, depth - 3)], axis=-1).reshape(-1, 3)
    corner = (np.arange(nodes - 1)[:, None] * nodes + np.arange(nodes - 1)).ravel()
    upper = np.stack([corner, corner + 1, corner + nodes], axis=1)
    faces = np.concatenate([upper, np.stack([corner + 1, corner + nodes + 1, corner + nodes], axis=1)])
    uv = np.stack([u, v], axis=-1).reshape(-1, 2)
    return Mesh(points.astype(np.float32), faces.astype(np.int32), uv.astype(np.float32))


def detailed(side: int = 256) -> np.ndarray:
    """(side, side, 3) with something to see everywhere."""
    y, x = np.mgrid[0:side, 0:side] / side
    waves = np.sin(2 * np.pi * 13 * x + 3 * y) * np.sin(2 * np.pi * 11 * y)
    return np.clip(0.5 + 0.2 * smooth_pictures(1, side, side, 3, seed=2)[0] + 0.2 * waves[..., None], 0, 1).astype(
        np.float32
    )


def photographs_of(mesh: Mesh, cameras: tuple[Camera, ...]):
    """The photographs of a mesh, without masks."""
    return InMemory([draw_texture(mesh, detailed(), camera, samples=2).image for camera in cameras])


def fitted(mesh: Mesh, lattice: Lattice | None, cameras: tuple[Camera, ...], observations: InMemory, side: int) -> Mesh:
    """The mesh of `fit_surface`."""
    return fit_surface(Proxy(mesh, lattice), cameras, observations, side).mesh


@pytest.mark.parametrize("off", [0.97, 1.04])
def test_a_plane_at_the_wrong_depth_is_brought_to_the_right_one(off):
    cameras = row_grid(9, 64, 56)
    observations = photographs_of(sheet(3.0), cameras)
    wrong = sheet(3.0 * off)
    found = fitted(wrong, None, cameras, observations, SIDE)
    inside = (np.abs(wrong.vertices[:, :2]) < 1.6).all(axis=1)  # what most cameras see
    before, after = (np.abs(mesh.vertices[inside, 2]) for mesh in (wrong, found))
    assert np.median(after) < 0.15 * np.median(before)
    np.testing.assert_allclose(found.vertices[:, :2], wrong.vertices[:, :2], atol=1e-4)  # along the normal alone
    assert found.uv is wrong.uv and found.faces is wrong.faces


def test_photographs_again_at_another_time_move_a_surface_alike():
    cameras, wrong = row_grid(9, 64, 56), sheet(3.1)
    once = photographs_of(sheet(3.0), cameras)
    found, again = (fitted(wrong, None, cameras, some, SIDE) for some in (once, repeated(once.pixels, 2)))
    assert np.abs(found.vertices - wrong.vertices).max() > 0.05
    np.testing.assert_allclose(again.vertices, found.vertices, atol=2e-3)


def test_a_relief_stays_on_the_rays_it_was_made_on():
    cameras = row_grid(9, 64, 56)
    true = relief(cameras[4], 0.5, False)
    observations = photographs_of(true, cameras)
    lattice = relief_lattice(true, cameras, DEPTH_ERROR_PX)
    assert lattice is not None
    exact = lattice.coordinates(true.vertices)
    exact[:, 2] *= 1.03
    wrong = replace(true, vertices=lattice.points(exact).astype(np.float32))
    found = fitted(wrong, lattice, cameras, observations, SIDE)
    now = lattice.coordinates(found.vertices)
    np.testing.assert_allclose(now[:, :2], exact[:, :2], atol=0.02)
    right = lattice.coordinates(true.vertices)[:, 2]
    assert np.median(np.abs(now[:, 2] - right)) < 0.3 * np.median(np.abs(exact[:, 2] - right))
    again = relief_lattice(found, cameras, DEPTH_ERROR_PX)
    assert again is not None and again.fine == lattice.fine


def test_a_sheet_is_brought_to_its_depth_behind_another():
    """A wall that is too far, seen through a sheet that is right and lets half of the light through."""
    cameras, glass = row_grid(9, 64, 56), sheet(2.4)
    behind, before = photographs_of(sheet(3.0), cameras).pixels, photographs_of(glass, cameras).pixels
    photographs = InMemory([0.5 * wall + 0.5 * pane for wall, pane in zip(behind, before, strict=True)])
    wrong = sheet(3.1)
    faces = len(wrong.faces)
    both = Mesh(
        np.concatenate([wrong.vertices, glass.vertices]),
        np.concatenate([wrong.faces, glass.faces + len(wrong.vertices)]),
        np.concatenate([wrong.uv * [0.5, 1], glass.uv * [0.5, 1] + [0.5, 0]]).astype(np.float32),
    )  # fmt: skip
    opacity = np.where(np.arange(2 * SIDE) < SIDE, 1, 0.5).astype(np.float32) * np.ones((SIDE, 1), np.float32)
    proxy = Proxy(both, None, Sheets((faces, faces), opacity))
    found = fit_surface(proxy, cameras, photographs, 2 * SIDE)
    assert found.sheets is proxy.sheets
    seen = (np.abs(wrong.vertices[:, :2]) < 1.6).all(axis=1)
    wall, pane = np.split(found.mesh.vertices[:, 2], 2)
    assert np.median(np.abs(wall[seen])) < 0.4 * 0.1
    assert np.median(np.abs(pane[seen] + 0.6)) < 0.03


def test_what_is_right_stays_and_what_nothing_tells_stays():
    cameras = row_grid(9, 64, 56)
    true = sheet(3.0)
    found = fitted(true, None, cameras, photographs_of(true, cameras), SIDE)
    assert np.abs(found.vertices - true.vertices).max() < 0.02
    noise = np.random.default_rng(3)
    for pictures in (np.full((9, 56, 64, 3), 0.5, np.float32), noise.random((9, 56, 64, 3), np.float32)):
        found = fitted(true, None, cameras, InMemory(list(pictures)), SIDE)
        assert np.abs(found.vertices - true.vertices).max() < 0.12  # half a pixel of parallax


def test_doubled_vertices_move_as_one():
    cameras = row_grid(9, 64, 56)
    whole = sheet(3.1)
    torn = Mesh(whole.vertices[whole.faces.ravel()], np.arange(whole.faces.size, dtype=np.int32).reshape(-1, 3),
                whole.uv[whole.faces.ravel()])  # fmt: skip
    observations = photographs_of(sheet(3.0), cameras)
    found, torn_found = (fitted(mesh, None, cameras, observations, SIDE) for mesh in (whole, torn))
    assert np.abs(found.vertices - whole.vertices).max() > 0.05
    first = np.unique(whole.faces, return_index=True)[1]
    np.testing.assert_array_equal(torn_found.vertices, torn_found.vertices[first][whole.faces.ravel()])
    assert np.median(np.abs(torn_found.vertices[first] - found.vertices)) < 1e-3


def test_surfaces_that_touch_without_common_vertices_stay_together():
    """A wall on a floor, divided otherwise: where only one of them moved, a camera would look through between."""
    cameras = row_grid(9, 64, 56)
    fine, coarse = sheet(3.1, 9), sheet(3.1, 6)
    halves = [
        replace(
            half, vertices=(half.vertices * [0.5, 1, 1] + [add, 0, 0]).astype(np.float32), uv=half.uv * [0.5, 1] + u
        )
        for half, add, u in ((fine, -1.5, 0), (coarse, 1.5, [0.5, 0]))
    ]
    wrong = Mesh(
        np.concatenate([half.vertices for half in halves]),
        np.concatenate([halves[0].faces, halves[1].faces + len(fine.vertices)]),
        np.concatenate([half.uv for half in halves]).astype(np.float32),
    )
    found = fitted(wrong, None, cameras, photographs_of(sheet(3.0), cameras), SIDE)
    moved = np.abs(found.vertices - wrong.vertices).max(axis=1) > 0
    touching = np.abs(wrong.vertices[:, 0]) < 1e-6
    assert moved.any() and touching.sum() == 9 + 6 and not moved[touching].any()
    for camera in cameras:
        assert draw_texture(found, detailed(), camera, samples=1).coverage.all()


def test_a_mesh_of_open_edges_alone_stays():
    cameras = row_grid(9, 64, 56)
    wrong = sheet(3.1, 2)
    found = fitted(wrong, None, cameras, photographs_of(sheet(3.0), cameras), SIDE)
    np.testing.assert_array_equal(found.vertices, wrong.vertices)


def test_masked_pixels_do_not_count():
    cameras = row_grid(9, 64, 56)
    pictures, spoiled = photographs_of(sheet(3.0), cameras).pixels, np.random.default_rng(1)
    mask = np.ones((56, 64), np.float32)
    mask[:, :20] = 0
    for picture in pictures:
        picture[:, :20] = spoiled.random((56, 20, 3))
    wrong = sheet(3.1)
    found = fitted(wrong, None, cameras, InMemory(pictures, [mask] * 9), SIDE)
    seen = (np.abs(wrong.vertices[:, :2]) < 0.8).all(axis=1)
    assert np.median(np.abs(found.vertices[seen, 2])) < 0.03


def test_a_mesh_that_no_camera_sees_is_left_alone():
    cameras = row_grid(4, 64, 56)
    behind = sheet(-3.0)
    assert fitted(behind, None, cameras, photographs_of(sheet(3.0), cameras), SIDE) is behind


def test_what_a_step_changes_is_what_a_camera_then_draws():
    """g of the kernel against the difference of two pictures, in a camera to the side."""
    cameras = row_grid(9, 64, 56)
    camera, t = cameras[0], np.array([[0.4, -0.3, 0.2], [-0.5, 0.6, -0.1]])
    slopes, step = np.array([[0.3, -0.2], [0.1, 0.4]]), np.tile([0.1, 0.05, 1.0], (2, 1))
    tangents = np.array([[[0.06, 0, 0.01], [0, 0.05, -0.02]]])
    out = np.zeros((2, 5))
    one = np.ones(2, np.float32)
    gather_steps(camera.matrix, tangents, t, step, np.zeros(2, np.int32), slopes, one, one, out)
    small = 1e-5
    for k in range(2):
        moved = camera.project(t[k : k + 1] + small * step[k])[0][0]
        at, right, down = (
            camera.project((t[k] + add)[None])[0][0] for add in (0, 1e-5 * tangents[0, 0], 1e-5 * tangents[0, 1])
        )
        across = np.stack([(right - at) / 1e-5, (down - at) / 1e-5], axis=1)
        texels = -np.linalg.solve(across, (moved - at) / small)  # of the texture under a pixel that stays
        np.testing.assert_allclose(out[k, 0], slopes[k] @ texels, rtol=1e-3)
    np.testing.assert_allclose(out[:, 1], np.square(out[:, 0]), rtol=1e-9)


@pytest.mark.slow
def test_a_mesh_that_is_off_costs_an_encode_little(tmp_path, monkeypatch):
    """The same photographs on the right depths and on wrong ones: what is fitted makes good what was wrong."""
    cameras = row_grid(9, 64, 56)
    true = relief(cameras[4], 0.5, False)
    folder = write_capture(tmp_path / "relief", cameras, true)
    lattice = relief_lattice(true, cameras, DEPTH_ERROR_PX)
    exact = lattice.coordinates(true.vertices)
    exact[:, 2] *= 1.03
    wrong = replace(true, vertices=lattice.points(exact).astype(np.float32))
    capture, made = open_capture(folder), {}
    for rounds in (4, 0):
        monkeypatch.setattr(surface, "SURFACE_ROUNDS", rounds)
        scene = ef.encode(capture, wrong, textures=2, fit="photographs")
        made[rounds] = len(encode_scene(scene)), scene.settings["fitted"]["psnr"]["luma"]["coded"]
    assert made[4][1] > made[0][1] + 0.3 and made[4][0] < 1.03 * made[0][0]
