"""Rays in the demo's scene: the tree against all triangles, mirrors and lenses against their laws."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.demo.geometry import GLASS_SPHERE, build_surroundings
from eigenfield.demo.light import irradiance
from eigenfield.demo.rays import (
    GLASS_INDEX,
    build_tree,
    glass_reflectance,
    mirror_ray,
    nearest_triangle,
    refract_ray,
    sphere_distance,
)

BALL = np.array([0.3, -0.2, 1.0, 0.5])


def random_rays(count, seed=3):
    random = np.random.default_rng(seed)
    origins = random.uniform((-1, 0.1, -0.8), (1, 1.2, 1.2), (count, 3))
    rays = random.normal(size=(count, 3))
    return origins, rays / np.linalg.norm(rays, axis=1, keepdims=True)


def test_the_tree_finds_the_nearest_of_all_triangles():
    mesh = build_surroundings().mesh
    tree = build_tree(mesh)
    p = mesh.vertices[mesh.faces].astype(np.float64)
    found, place = [], np.empty(2)
    for origin, ray in zip(*random_rays(60), strict=True):
        one, two = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
        across = np.cross(ray, two)
        with np.errstate(divide="ignore", invalid="ignore"):
            volume = (one * across).sum(axis=1)
            u = ((origin - p[:, 0]) * across).sum(axis=1) / volume
            other = np.cross(origin - p[:, 0], one)
            v, distance = other @ ray / volume, (other * two).sum(axis=1) / volume
            hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (distance > 1e-5)
        expected = distance[hit].min() if hit.any() else np.inf
        got = nearest_triangle(*tree, origin, ray, np.inf, np.empty(64, np.int64), place)
        assert got == pytest.approx(expected, rel=1e-9)
        if np.isfinite(got):
            f = np.flatnonzero(hit)[distance[hit].argmin()]
            corner = mesh.uv[mesh.faces[f]].astype(np.float64)
            chart = corner[0] + u[f] * (corner[1] - corner[0]) + v[f] * (corner[2] - corner[0])
            np.testing.assert_allclose(place, chart, atol=1e-6)
            assert nearest_triangle(*tree, origin, ray, 0.999 * got, np.empty(64, np.int64), place) == np.inf
        found.append(np.isfinite(got))
    assert 10 < sum(found) < 60


def rays_that_meet_the_ball():
    origins, rays = random_rays(200)
    met = [(o, r, d) for o, r in zip(origins, rays, strict=True) if (d := sphere_distance(o, r, BALL)) < np.inf]
    assert len(met) > 10
    return met


def test_a_mirror_sends_a_ray_back_at_the_angle_at_which_it_came():
    for origin, ray, distance in rays_that_meet_the_ball():
        o, r = origin.copy(), ray.copy()
        cosine = mirror_ray(o, r, BALL, distance)
        normal = (o - BALL[:3]) / BALL[3]
        assert np.linalg.norm(normal) == pytest.approx(1) and np.linalg.norm(r) == pytest.approx(1)
        assert -ray @ normal == pytest.approx(cosine) and r @ normal == pytest.approx(cosine)
        np.testing.assert_allclose(np.cross(r, normal), np.cross(ray, normal), atol=1e-12)
        assert sphere_distance(o, r, BALL) == np.inf  # it does not meet the ball again


def test_glass_obeys_snell_on_the_way_in_and_on_the_way_out():
    for origin, ray, distance in rays_that_meet_the_ball():
        o, r = origin.copy(), ray.copy()
        chord = refract_ray(o, r, BALL, distance)
        enters = origin + distance * ray
        within = (o - enters) / chord
        normals = (enters - BALL[:3]) / BALL[3], (o - BALL[:3]) / BALL[3]
        assert np.linalg.norm(normals[1]) == pytest.approx(1) and np.linalg.norm(r) == pytest.approx(1)
        np.testing.assert_allclose(np.cross(ray, normals[0]), GLASS_INDEX * np.cross(within, normals[0]), atol=1e-12)
        np.testing.assert_allclose(np.cross(r, normals[1]), GLASS_INDEX * np.cross(within, normals[1]), atol=1e-12)
        assert r @ normals[1] > 0


def test_glass_reflects_four_per_cent_head_on_and_all_at_grazing_angles():
    assert glass_reflectance(1.0) == pytest.approx(0.04)
    assert glass_reflectance(1e-9) == pytest.approx(1.0)
    assert np.all(np.diff([glass_reflectance(c) for c in np.linspace(0.01, 1, 50)]) < 0)


def test_the_glass_ball_focuses_light_within_its_shadow():
    centre, radius = GLASS_SPHERE
    to_light = np.array([-0.62, 0.62, 0.52]) / np.linalg.norm([-0.62, 0.62, 0.52])
    focus = centre - to_light * centre[1] / to_light[1]  # on the floor, along the key light
    aside = np.cross(to_light, (0.0, 1.0, 0.0))
    points = focus + np.linspace(0, 3 * radius, 40)[:, None] * aside / np.linalg.norm(aside)
    up = np.tile((0.0, 1.0, 0.0), (len(points), 1))
    light = irradiance(points, up, "floor")[0].sum(axis=1)
    clear = irradiance(points, up, "glass")[0].sum(axis=1)  # a surface of the ball itself: it casts no shadow on that
    share = light / clear
    assert share[0] > 1.5 and share.min() < 0.75 and share[-1] > 0.95
