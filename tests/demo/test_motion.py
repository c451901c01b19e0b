"""The clip's motions against the laws that they follow."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from eigenfield.core.mesh import vertex_normals
from eigenfield.demo.cameras import array_cameras
from eigenfield.demo.geometry import (
    ALL_PARTS,
    CHROME_SPHERE,
    GLASS_SPHERE,
    MARBLE_SPHERE,
    ORANGE_SPHERE,
    SURFACE_PARTS,
    WALL_Z_UNITS,
)
from eigenfield.demo.lettering import POSTER
from eigenfield.demo.light import SHADOW_SPHERES, SOFT_BOXES, Shadows, irradiance
from eigenfield.demo.motion import (
    BOUNCE_HEIGHT_UNITS,
    LAMP,
    MOTIONS,
    ROLL_HALF_WAY_UNITS,
    SHEET_GAP_UNITS,
    SHEET_PLANE_Z_UNITS,
    lights_at,
    moved,
    moved_normals,
    shadows_at,
)
from eigenfield.demo.moving import at_time, moving_scene, moving_surroundings
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import atlas_fault, atlas_statistics

TIMES = np.arange(30) / 30
SPHERES = {"orange": ORANGE_SPHERE, "marble": MARBLE_SPHERE, "glass": GLASS_SPHERE, "chrome": CHROME_SPHERE}


@pytest.fixture(scope="module")
def scene():
    return moving_scene()


def part_vertices(scene, name):
    return np.unique(scene.mesh.faces[scene.part == ALL_PARTS.index(name)])


@pytest.mark.parametrize("name", MOTIONS)
def test_a_motion_ends_where_it_began_and_goes_on_as_it_went(scene, name):
    rest = scene.mesh.vertices[part_vertices(scene, name)].astype(np.float64)
    np.testing.assert_allclose(moved(name, rest, 1.0), moved(name, rest, 0.0), atol=1e-12)
    places = [moved(name, rest, time) for time in [*TIMES.tolist(), 1.0]]
    steps = np.array([np.linalg.norm(b - a, axis=1).max() for a, b in pairwise(places)])
    assert steps[-1] <= steps[:-1].max() * (1 + 1e-9)
    assert 0.005 < steps.max() < 0.1


@pytest.mark.parametrize("name", [*MOTIONS, "block"])
def test_normals_turn_with_the_surface(scene, name):
    own = part_vertices(scene, name)
    for time in (0.0, 0.13, 0.4):
        now = at_time(scene, time)
        expected = vertex_normals(now.mesh.vertices.astype(np.float64), now.mesh.faces)
        inner = (now.normals[own] * expected[own]).sum(axis=1)
        at_rest = (scene.normals[own] * vertex_normals(scene.mesh.vertices.astype(float), scene.mesh.faces)[own]).sum(1)
        assert (inner > at_rest - 0.005).all()
        np.testing.assert_allclose(np.linalg.norm(now.normals[own], axis=1), 1)


def test_the_orange_rolls_without_slipping():
    """The point that touches the floor stands still for that moment."""
    centre, radius = ORANGE_SPHERE
    way = 0.0
    for time in (0.0, 0.1, 0.35, 0.8):
        middle = moved("orange", centre[None], time)[0]
        touching = np.array([[middle[0], 0.0, middle[2]]])
        jacobian = np.column_stack(
            [moved("orange", centre + axis[None], time)[0] - middle for axis in np.eye(3)]
        )  # a rotation
        np.testing.assert_allclose(jacobian @ jacobian.T, np.eye(3), atol=1e-12)
        rest = centre + (touching[0] - middle) @ jacobian
        np.testing.assert_allclose(moved("orange", rest[None], time), touching, atol=1e-12)
        speed = (moved("orange", rest[None], time + 1e-5) - moved("orange", rest[None], time - 1e-5)) / 2e-5
        assert np.abs(speed).max() < 1e-6
        way = max(way, float(np.linalg.norm(middle - centre)))
        assert middle[1] == pytest.approx(radius)
    assert 0.9 * ROLL_HALF_WAY_UNITS < way <= ROLL_HALF_WAY_UNITS


def test_the_marble_bounces_off_the_floor_under_constant_weight(scene):
    centre, radius = MARBLE_SPHERE
    heights = np.array([moved("marble", centre[None], time)[0, 1] for time in TIMES]) - radius
    assert heights[0] == heights[15] == 0 and heights.min() == 0
    assert heights.max() == pytest.approx(BOUNCE_HEIGHT_UNITS, rel=0.01)
    bends = np.diff(heights, 2)
    falling = np.delete(bends, 14)  # the bounce
    np.testing.assert_allclose(falling, falling[0], rtol=1e-9)
    assert falling[0] < 0 < bends[14]


def test_the_sheet_hangs_from_its_upper_edge_keeps_its_length_and_does_not_reach_the_wall(scene):
    depth = np.linspace(0, POSTER.height, 200)
    for x in (POSTER.left, POSTER.left + POSTER.width):
        rest = np.column_stack([np.full(200, x), POSTER.top - depth, np.full(200, SHEET_PLANE_Z_UNITS)])
        swing = []
        for time in TIMES.tolist():
            line = moved("sheet", rest, time)
            np.testing.assert_allclose(line[0], rest[0], atol=1e-12)
            assert np.linalg.norm(np.diff(line, axis=0), axis=1).sum() == pytest.approx(POSTER.height, rel=2e-3)
            assert (line[:, 2] >= WALL_Z_UNITS + SHEET_GAP_UNITS - 1e-12).all()
            swing.append(line[-1, 2])
        assert np.ptp(swing) > 0.1


def test_nothing_meets_another_thing_or_the_floor(scene):
    for time in np.linspace(0, 1, 61).tolist():
        assert at_time(scene, time).mesh.vertices[:, 1].min() > -1e-6
        balls = [(moved(name, centre[None], time)[0], radius) for name, (centre, radius) in SPHERES.items()]
        for k, (centre, radius) in enumerate(balls):
            others = [
                *balls[k + 1 :],
                *((np.array(c), r) for part in ("body", "block") for c, r in SHADOW_SPHERES[part]),
            ]
            for other, size in others:
                assert np.linalg.norm(other - centre) > radius + size


def test_what_has_no_motion_stays_where_it_is(scene):
    still = np.concatenate([part_vertices(scene, name) for name in ALL_PARTS if name not in MOTIONS])
    moving = np.concatenate([part_vertices(scene, name) for name in MOTIONS])
    assert len(still) > 8000
    first, later = at_time(scene, 0.0), at_time(scene, 0.37)
    for now in (first, later):
        np.testing.assert_array_equal(now.mesh.vertices[still], scene.mesh.vertices[still])
        assert now.mesh.faces is scene.mesh.faces and now.mesh.uv is scene.mesh.uv
    assert (np.linalg.norm(later.mesh.vertices - first.mesh.vertices, axis=1)[moving] > 1e-4).mean() > 0.9


def test_the_mesh_has_an_atlas_of_its_own_and_every_part(scene):
    assert atlas_fault(scene.mesh) is None
    statistics = atlas_statistics(scene.mesh)
    assert statistics.overlap == 0 and statistics.fill > 0.55
    assert len(scene.mesh.faces) < 36_000
    assert set(scene.part) == set(range(len(ALL_PARTS)))
    assert set(moving_surroundings().part) == {ALL_PARTS.index(p) for p in ALL_PARTS if p not in ("chrome", "glass")}
    assert ALL_PARTS[: len(SURFACE_PARTS)] == SURFACE_PARTS


def test_every_pixel_of_every_view_is_covered_at_all_times(scene):
    for time in (0.0, 0.2, 0.45, 0.7):
        mesh = at_time(scene, time).mesh
        for camera in array_cameras(3, 3, 96):
            assert (rasterise_view(mesh, camera).face >= 0).all()


def test_no_camera_sees_a_face_that_was_left_out(scene):
    """Whole balls in place of those that were culled: the same depth in all pixels of the corners of the array."""
    for name in ("orange", "marble", "glass"):
        centre, radius = SPHERES[name]
        for time in TIMES[::5].tolist():
            mesh, middle = at_time(scene, time).mesh, moved(name, centre[None], time)[0]
            part = scene.part == ALL_PARTS.index(name)
            only = type(mesh)(mesh.vertices, mesh.faces[part], mesh.uv)
            for camera in (array_cameras(3, 3, 128)[k] for k in (0, 2, 6, 8)):
                covered = rasterise_view(only, camera).face >= 0
                rows, columns = np.nonzero(np.ones_like(covered))
                rays = np.column_stack([columns + 0.5, rows + 0.5, np.ones(len(rows))])
                rays = rays @ np.linalg.inv(camera.K).T @ camera.R
                rays /= np.linalg.norm(rays, axis=1, keepdims=True)
                off = np.linalg.norm(np.cross(rays, middle - camera.centre), axis=1).reshape(covered.shape)
                assert covered[off < 0.97 * radius].all() and not covered[off > radius].any()


def test_the_lamp_goes_round_and_the_other_lights_stay():
    places = [lights_at(time)[LAMP].direction for time in TIMES.tolist()]
    np.testing.assert_allclose(lights_at(1.0)[LAMP].direction, places[0], atol=1e-12)
    assert np.ptp([x for x, _, _ in places]) > 0.5
    for time in (0.1, 0.6):
        assert [light for k, light in enumerate(lights_at(time)) if k != LAMP] == [
            light for k, light in enumerate(SOFT_BOXES) if k != LAMP
        ]
    assert sum(SOFT_BOXES[LAMP].irradiance) == 0


def test_shadows_go_with_what_casts_them():
    up, key = np.array([[0.0, 1.0, 0.0]]), np.array(SOFT_BOXES[0].direction)
    for time in (0.25, 0.5):  # the marble is up, and on the floor
        for name in ("marble", "orange"):
            middle = moved(name, SPHERES[name][0][None], time)
            shade = middle - key * (middle[0, 1] / key[1])
            alone = Shadows({name: shadows_at(time).spheres[name]})
            assert (
                irradiance(shade, up, "floor", alone)[0][0, 0]
                < 0.6 * irradiance(shade, up, "floor", Shadows({}))[0][0, 0]
            )


def test_the_wall_is_dark_behind_the_sheet_and_below_its_edge_where_the_light_is_above():
    shadows, out, right = shadows_at(0.2), np.array([[0.0, 0.0, 1.0]]), POSTER.left + POSTER.width
    middle = np.array([[POSTER.left + POSTER.width / 2, POSTER.top - POSTER.height / 2, WALL_Z_UNITS]])
    below = np.array([[middle[0, 0], POSTER.top - POSTER.height - 0.02, WALL_Z_UNITS]])
    far = np.array([[right + 1.0, POSTER.top, WALL_Z_UNITS]])
    light = {at: irradiance(point, out, "wall", shadows) for at, point in (("m", middle), ("b", below), ("f", far))}
    bare = {at: irradiance(point, out, "wall", shadows._replace(before_wall=None)) for at, point in
            (("m", middle), ("b", below), ("f", far))}  # fmt: skip
    assert light["m"][0].max() < 0.6 * bare["m"][0].max()
    assert light["b"][0].max() < 0.9 * bare["b"][0].max()
    np.testing.assert_array_equal(light["f"][0], bare["f"][0])
    assert moved_normals("sheet", middle + SHEET_GAP_UNITS * out, out, 0.2)[0, 2] > 0.8
