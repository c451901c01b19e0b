"""Primitives put in by hand, and the fit of a sphere to its outline."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.capture import open_capture
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError, ProxyError
from eigenfield.imaging.graph import face_edges
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.background import camera_coverage, join_meshes
from eigenfield.proxy.primitives.clip import clip_mesh, split_long_edges
from eigenfield.proxy.primitives.shapes import PlanePrimitive, SpherePrimitive, insert_primitive, parse_primitive
from eigenfield.proxy.primitives.sphere_fit import ViewRegion, find_view, fit_sphere, parse_region, sphere_outlines
from eigenfield.proxy.topology import boundary_loops
from support.observations import InMemory
from support.surfaces import ball, looking, square

# ---------------------------------------------------------------- words


def test_primitives_are_read():
    assert parse_primitive("sphere:1,-2,3.5,0.25") == SpherePrimitive((1, -2, 3.5), 0.25)
    assert parse_primitive(" Sphere:1, -2,3.5 ,2.5e-1") == SpherePrimitive((1, -2, 3.5), 0.25)
    assert parse_primitive("plane:0,0,1,0,0,-2,3") == PlanePrimitive((0, 0, 1), (0, 0, -1), 3, pytest.approx(0.3))
    assert parse_primitive("plane:0,0,1,0,0,-2,3,0.5") == PlanePrimitive((0, 0, 1), (0, 0, -1), 3, 0.5)


@given(st.tuples(*[st.floats(-1e3, 1e3)] * 3), st.floats(1e-3, 1e3))
def test_a_sphere_is_read_as_it_is_written(centre, radius):
    sphere = SpherePrimitive(centre, radius)
    again = parse_primitive(str(sphere))
    assert np.allclose(again.centre, centre, rtol=1e-7, atol=1e-9) and np.isclose(again.radius, radius)


@pytest.mark.parametrize(
    "text",
    ["", "sphere", "sphere:", "sphere:1,2,3", "sphere:1,2,3,4,5", "sphere:1,2,3,0", "sphere:1,2,3,-1", "sphere:a,b,c,d",
     "sphere:nan,0,0,1", "sphere:inf,0,0,1", "cone:1,2,3,4", "plane:0,0,0,0,0,0,1", "plane:0,0,0,0,0,1,0",
     "plane:0,0,0,0,0,1,1,-1", "plane:0,0,1,1", "1,2,3,4"],
)  # fmt: skip
def test_bad_primitives_are_refused_with_the_form(text):
    with pytest.raises(OptionError) as caught:
        parse_primitive(text)
    assert caught.value.code == "primitive" and caught.value.remedy


def test_regions_are_read():
    assert parse_region("out_08_08.jpg:10,20,30.5,40") == ViewRegion("out_08_08.jpg", 10, 20, 30.5, 40)
    assert parse_region("C:left.jpg:1,2,3,4").view == "C:left.jpg"


@pytest.mark.parametrize(
    "text", ["", "a.jpg", "a.jpg:1,2,3", ":1,2,3,4", "a:1,2,3,x", "a:1,2,0,4", "a:1,2,3,-4", "a:1,2,inf,4"]
)
def test_bad_regions_are_refused(text):
    with pytest.raises(OptionError) as caught:
        parse_region(text)
    assert caught.value.code == "fit-sphere" and caught.value.remedy


def test_views_are_found_by_what_people_type():
    names = ("left/0001.jpg", "right/0001.jpg", "right/0002.jpg")
    assert find_view(ViewRegion("right/0001.jpg", 0, 0, 1, 1), names) == 1
    assert find_view(ViewRegion("0002.jpg", 0, 0, 1, 1), names) == 2
    assert find_view(ViewRegion("0002", 0, 0, 1, 1), names) == 2
    for wrong in ("0001.jpg", "0003.jpg"):
        with pytest.raises(OptionError) as caught:
            find_view(ViewRegion(wrong, 0, 0, 1, 1), names)
        assert caught.value.code == "fit-sphere-view"


# ---------------------------------------------------------------- cutting


@settings(max_examples=25)
@given(st.floats(0.2, 0.9), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_a_disc_is_cut_out_of_a_square(radius, x, y):
    sphere = SpherePrimitive((x, y, 0.0), radius)
    mesh = split_long_edges(square(2, 0.0, 9), sphere.distance, radius / 8)
    assert np.isclose(mesh.face_areas().sum(), 16, rtol=1e-4)  # splitting moves nothing
    result = clip_mesh(mesh, sphere.distance)
    assert np.isclose(16 - result.face_areas().sum(), np.pi * radius**2, rtol=0.02)
    assert sphere.distance(result.vertices.astype(np.float64)).min() > -1e-5
    _, number = face_edges(result.faces)
    assert np.bincount(number).max() == 2
    loops = boundary_loops(result)
    assert len(loops) == 2  # no crack: the outer border and the hole's, which lies on the sphere
    on = [np.abs(sphere.distance(result.vertices[loop].astype(np.float64))).max() for loop in loops]
    assert min(on) < 1e-5


def test_a_small_sphere_inside_one_large_triangle_is_not_missed():
    sphere = SpherePrimitive((0.1, 0.05, 0.0), 0.05)
    result = clip_mesh(split_long_edges(square(2, 0.0, 2), sphere.distance, 0.01), sphere.distance)
    assert np.isclose(16 - result.face_areas().sum(), np.pi * 0.05**2, rtol=0.05)


def test_what_lies_apart_is_not_split():
    mesh = square(2, 0.0, 9)
    assert np.array_equal(split_long_edges(mesh, SpherePrimitive((0, 0, 50), 1).distance, 0.01).faces, mesh.faces)
    assert np.array_equal(clip_mesh(mesh, SpherePrimitive((0, 0, 50), 1).distance).faces, mesh.faces)
    assert len(clip_mesh(mesh, SpherePrimitive((0, 0, 0), 50).distance).faces) == 0


# ---------------------------------------------------------------- putting in


@pytest.fixture(scope="module")
def cameras():
    return [looking(np.array([x, y, -5.0]), (0, 0, 0.5)) for y in (-1.5, 0, 1.5) for x in (-2, 0, 2.0)]


def test_a_sphere_takes_the_place_of_the_noise_inside_it(cameras):
    random = np.random.default_rng(0)
    noise = ball(radius=0.9, level=3)
    rough = type(noise)(
        (noise.vertices * random.uniform(0.8, 1.08, (len(noise.vertices), 1))).astype(np.float32), noise.faces
    )
    sphere = SpherePrimitive((0.0, 0.0, 0.0), 1.0)
    result = insert_primitive(join_meshes(rough, square(4, 0.6, 60)), sphere, cameras)
    for camera in cameras:
        raster = rasterise_view(result, camera)
        true = rasterise_view(join_meshes(ball(level=4), square(4, 0.6, 60)), camera)
        assert (raster.face >= 0).mean() == (true.face >= 0).mean()
        assert np.percentile(np.abs(raster.inverse_depth - true.inverse_depth), 99.9) < 1e-3
    inside = sphere.distance(result.vertices.astype(np.float64)) < -1e-4
    assert not inside.any()
    hidden = ball(level=4).vertices[:, 2] > 0.8  # behind the wall: no camera sees it, so it is not put in
    assert result.vertices[np.abs(sphere.distance(result.vertices)) < 1e-4][:, 2].max() < 0.8 and hidden.any()


def test_a_plane_takes_the_place_of_bumps(cameras):
    wall = square(3, 1.0, 60)
    bumps = wall.vertices.copy()
    near = np.linalg.norm(bumps[:, :2], axis=1) < 0.8
    bumps[near, 2] += np.random.default_rng(0).uniform(-0.15, 0.15, int(near.sum())).astype(np.float32)
    result = insert_primitive(type(wall)(bumps, wall.faces), parse_primitive("plane:0,0,1,0,0,-1,1,0.3"), cameras)
    raster, true = rasterise_view(result, cameras[4]), rasterise_view(wall, cameras[4])
    assert np.abs(raster.inverse_depth - true.inverse_depth).max() < 2e-3
    middle = result.vertices[result.faces].mean(axis=1)
    inner = np.abs(middle[:, :2]).max(axis=1) < 0.9
    assert (result.face_normals()[inner] @ [0, 0, -1] > 0.999).all()
    assert (camera_coverage(result, cameras) == camera_coverage(wall, cameras)).all()


def test_primitives_that_cannot_be_seen_are_said(cameras):
    wall = square(4, 1.0)
    for text in ("sphere:0,0,50,1", "sphere:0,0,-50,1", "sphere:100,0,0,1", "plane:0,0,30,0,0,1,2"):
        with pytest.raises(ProxyError) as caught:
            insert_primitive(wall, parse_primitive(text), cameras)
        assert caught.value.code == "primitive-not-seen" and caught.value.remedy
    with pytest.raises(ProxyError) as caught:
        insert_primitive(wall, parse_primitive("sphere:0,0,-5,1"), cameras)
    assert caught.value.code == "primitive-camera-inside"


# ---------------------------------------------------------------- the fit


def sphere_outline(sphere, camera, grow=0.0):
    return sphere_outlines(sphere, camera.K[None], camera.R[None], camera.t[None], (grow,))[0, 0]


def test_the_outline_is_where_the_sphere_ends():
    sphere = SpherePrimitive((0.7, -0.4, 1.0), 0.8)
    camera = looking(np.array([-1.0, 0.5, -4.0]), (0, 0, 0), focal=400, width=500, height=400)
    mesh = ball(centre=sphere.centre, radius=sphere.radius, level=6)
    drawn = (rasterise_view(mesh, camera).face >= 0).astype(np.uint8)
    polygon = np.zeros_like(drawn)
    cv2.fillPoly(polygon, [np.round((sphere_outline(sphere, camera) - 0.5) * 16).astype(np.int32)], 1, shift=4)
    assert (drawn != polygon).sum() < 0.02 * drawn.sum()
    grown = sphere_outline(sphere, camera, 5.0) - sphere_outline(sphere, camera)
    assert np.allclose(np.linalg.norm(grown, axis=1), 5, rtol=0.15)
    assert np.isnan(sphere_outline(SpherePrimitive((-1.0, 0.5, -4.0), 1.0), camera)).all()


def photograph_of(mesh, first_ball_face, camera, seed=3):
    """A ball with its own paint before a wall with paint; smooth within, a step at the outline."""
    raster = rasterise_view(mesh, camera)
    x, y = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(camera.K).T
    world = (rays / np.maximum(raster.inverse_depth, 1e-9)[..., None] - camera.t) @ camera.R
    waves = np.random.default_rng(seed).normal(size=(12, 3)) * 4
    value = np.sin(np.einsum("hwk,nk->hwn", world, waves)).mean(axis=-1)
    paint = np.stack([0.4 + value, 0.5 - 0.5 * value, 0.5 + 0.6 * value], axis=-1)
    paint[raster.face >= first_ball_face] = paint[raster.face >= first_ball_face] * 0.5 + 0.45
    paint += np.random.default_rng(seed + 1).normal(size=paint.shape) * 0.01
    return np.clip(paint, 0, 1).astype(np.float32)


@pytest.fixture(scope="module")
def before_a_wall():
    """A sphere, and cameras with their photographs of it."""
    sphere = SpherePrimitive((0.3, 0.2, 0.0), 0.7)
    wall = square(6, 1.5, 30)
    mesh = join_meshes(wall, ball(centre=sphere.centre, radius=sphere.radius, level=5))
    cameras = [
        looking(np.array([x, y, -5.0]), (0, 0, 0.5), focal=260, width=240, height=200)
        for y in (-0.8, 0.8)
        for x in (-1.2, 0, 1.2)
    ]
    return sphere, cameras, [photograph_of(mesh, len(wall.faces), camera) for camera in cameras]


@pytest.mark.slow
def test_a_sphere_is_found_from_a_careless_box(before_a_wall):
    sphere, cameras, pictures = before_a_wall
    around = sphere_outline(sphere, cameras[1])
    low, high = around.min(axis=0), around.max(axis=0)
    box = ViewRegion("1", low[0] - 8, low[1] - 3, high[0] - low[0] + 6, high[1] - low[1] + 9)
    fit = fit_sphere(1, box, cameras, InMemory(pictures))
    assert np.linalg.norm(np.array(fit.sphere.centre) - sphere.centre) < 0.05
    assert abs(fit.sphere.radius - sphere.radius) < 0.02
    assert fit.residual < 1.0 and fit.views == 6 and fit.contrast > 0.1


@pytest.mark.slow
def test_fits_that_cannot_be_are_said():
    camera = looking(np.array([0, 0, -5.0]), (0, 0, 0))
    cameras = [camera, looking(np.array([0.5, 0, -5.0]), (0, 0, 0)), looking(np.array([-0.5, 0, -5.0]), (0, 0, 0))]
    grey = np.full((120, 160, 3), 0.5, np.float32)
    with pytest.raises(OptionError) as caught:
        fit_sphere(0, ViewRegion("0", 500, 10, 20, 20), cameras, InMemory([grey] * 3))
    assert caught.value.code == "fit-sphere-region"
    with pytest.raises(ProxyError) as caught:
        fit_sphere(0, ViewRegion("0", 50, 40, 30, 30), cameras, InMemory([grey] * 3))
    assert caught.value.code == "fit-sphere-outline" and caught.value.remedy
    back = Camera(camera.K, np.diag([-1.0, 1, -1]), np.array([0, 0, -5.0]), 160, 120)
    with pytest.raises(ProxyError) as caught:
        fit_sphere(0, ViewRegion("0", 50, 40, 30, 30), [camera, back], InMemory([grey] * 2))
    assert caught.value.code == "fit-sphere-outline"


@pytest.mark.slow
def test_the_ball_of_tarot(data):
    folder = data / "tarot_17x17_512"
    light_field = open_capture(folder, calibration=folder / "calibration" / "refined.json")
    circles = json.loads((folder / "ball.json").read_text(encoding="utf-8"))["circles"]
    view = find_view(ViewRegion("out_08_08.jpg", 0, 0, 1, 1), light_field.names)
    circle = circles["images/out_08_08.jpg"]
    r = circle["r"]
    box = ViewRegion("", circle["cx"] - r - 12, circle["cy"] - r + 8, 2 * r + 10, 2 * r + 16)
    fit = fit_sphere(view, box, light_field.cameras, light_field)
    off = []
    for name, camera in zip(light_field.names, light_field.cameras, strict=True):
        (cx, cy), radius = cv2.minEnclosingCircle(sphere_outline(fit.sphere, camera).astype(np.float32))
        true = circles["images/" + name.rpartition("/")[2]]
        off.append([cx - true["cx"], cy - true["cy"], radius - (true["r"] - 3)])  # the circles have 3 px to spare
    assert np.abs(off).mean() < 1.2 and np.abs(off).max() < 4
