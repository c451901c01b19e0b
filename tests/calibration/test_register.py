"""Cameras of photographs that take no part in structure from motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from eigenfield.calibration import KnownLens, SfmResult, align_similarity, structure_from_motion
from eigenfield.calibration.align import angle_between, transform_camera
from eigenfield.calibration.motion.colmap_core import pycolmap
from eigenfield.calibration.motion.register import find_pose
from eigenfield.capture import LightField, PhotoSet
from support.motion import HEIGHT, WIDTH, K, looking, photographed, picture, spotted

BLIND = (2, 5)  # a view of the scene, and another place


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> tuple[PhotoSet, LightField]:
    return photographed(tmp_path_factory.mktemp("scene") / "photos")


@pytest.fixture(scope="module")
def solved(scene: tuple[PhotoSet, LightField], tmp_path_factory: pytest.TempPathFactory) -> Iterator[SfmResult]:
    """Without two of six photographs."""
    photos, _ = scene
    foreign = picture(tmp_path_factory.mktemp("more"), "foreign.png", spotted(99)[:HEIGHT, :WIDTH])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("eigenfield.calibration.motion.features.FEATURE_MIN_MEDIAN_COUNT", 0)
        yield structure_from_motion(
            replace(photos, shots=(*photos.shots, foreign)), intrinsics=KnownLens(K), blind=BLIND
        )


@pytest.mark.slow
def test_cameras_and_points_are_those_of_the_other_photographs(scene, solved):
    photos, _ = scene
    own = [0, 1, 3, 4]
    without = structure_from_motion(photos.subset(own), intrinsics=KnownLens(K))
    for place, camera in zip(own, without.light_field.cameras, strict=True):
        assert camera.matrix.tobytes() == solved.light_field.cameras[place].matrix.tobytes()
    assert solved.points.positions.tobytes() == without.points.positions.tobytes()
    assert np.array_equal(solved.points.view, np.array(own)[without.points.view])


def test_a_held_out_photograph_registers_its_own_camera(scene, solved):
    _, truth = scene
    assert solved.light_field.names == truth.names
    own = [0, 1, 3, 4]
    found, true = (np.array([field.cameras[i].centre for i in own]) for field in (solved.light_field, truth))
    moved = transform_camera(solved.light_field.cameras[2], *align_similarity(found, true))
    assert np.linalg.norm(moved.centre - truth.cameras[2].centre) < 0.005 * 3  # of its distance from the scene
    assert angle_between(moved.R, truth.cameras[2].R) < 0.15
    entry = solved.report[2]
    assert entry.registered and entry.error < 0.7 and entry.observations > 30


def test_one_that_cannot_is_left_out_with_one_line(solved):
    (line,) = solved.light_field.problems
    assert line.startswith("foreign.png has no camera: held out, and ") and "\n" not in line
    assert [entry.registered for entry in solved.report] == [True] * 5 + [False]


def test_a_pose_is_found_among_wrong_matches():
    random = np.random.default_rng(3)
    points = random.uniform(-1, 1, (60, 3))
    true = looking(np.array([0.4, -0.2, -3.0]), np.zeros(3))
    pixels, _ = true.project(points)
    pixels[:20] = random.uniform(0, [WIDTH, HEIGHT], (20, 2))
    camera = pycolmap.Camera(model="PINHOLE", width=WIDTH, height=HEIGHT, params=K[[0, 1, 0, 1], [0, 1, 2, 2]])
    pose = find_pose(pixels, points, camera, False, 0)
    np.testing.assert_allclose(pose.cam_from_world.matrix(), np.column_stack([true.R, true.t]), atol=1e-5)
    assert pose.error < 1e-3 and pose.inliers[20:].all() and not pose.inliers[:20].any()


def test_too_few_points_give_no_pose():
    camera = pycolmap.Camera(model="PINHOLE", width=WIDTH, height=HEIGHT, params=K[[0, 1, 0, 1], [0, 1, 2, 2]])
    random = np.random.default_rng(4)
    assert find_pose(np.zeros((5, 2)), np.zeros((5, 3)), camera, False, 0) is None
    noise = random.uniform(0, [WIDTH, HEIGHT], (60, 2)), random.uniform(-1, 1, (60, 3))
    assert find_pose(*noise, camera, False, 0) is None
