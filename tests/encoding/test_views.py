"""Which camera the atlas is made for, where some see much less of the scene than others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import eigenfield as ef
from eigenfield.encoding.options import EncodeOptions
from eigenfield.encoding.views import select_views, usual_reference
from eigenfield.rendering import Renderer, ViewWeights, draw_texture
from support.observations import CalibratedInMemory, InMemory
from support.scenes import bumpy_square, row_grid, smooth_pictures
from support.soft_scenes import soft_scene

TELE = np.diag([3.0, 3.0, 1.0])
MIDDLE = 4  # of nine cameras


def photographed(cameras):
    texture = np.clip(0.5 + 0.4 * smooth_pictures(1, 96, 96, 3, seed=3)[0], 0, 1).astype(np.float32)
    pictures = [draw_texture(bumpy_square(12), texture, camera, samples=2).image for camera in cameras]
    return CalibratedInMemory(InMemory(pictures), cameras)


def chosen(cameras, mesh=None, **options):
    views = select_views(photographed(cameras), EncodeOptions(**options).resolved())
    return usual_reference(views, bumpy_square(12) if mesh is None else mesh)


def closer(camera, metres):
    return replace(camera, t=camera.t - np.array([0, 0, metres]))


def test_the_middle_one_of_cameras_that_see_alike():
    cameras = list(row_grid(9))
    assert chosen(cameras) == MIDDLE
    cameras[0] = closer(cameras[0], 0.8)  # a little closer
    assert chosen(cameras) == MIDDLE
    assert chosen(cameras, hold_out="camera 4") in (1, 3, 5, 7)


def test_one_that_sees_the_scene_much_larger_is_no_reference():
    cameras = list(row_grid(9))
    for tele in ([MIDDLE], [MIDDLE, 1, 5, 8]):
        some = [replace(camera, K=TELE @ camera.K) if index in tele else camera for index, camera in enumerate(cameras)]
        assert chosen(some) in {1, 3, 5, 7} - set(tele)
    assert (
        chosen([closer(camera, 1.9) if index == MIDDLE else camera for index, camera in enumerate(cameras)]) != MIDDLE
    )
    wide = [replace(camera, K=TELE @ camera.K) if index else camera for index, camera in enumerate(cameras)]
    assert chosen(wide) == MIDDLE  # one wide view is not what is usual


def test_a_scene_that_no_camera_sees_changes_nothing():
    mesh = bumpy_square(12)
    assert chosen(list(row_grid(9)), replace(mesh, vertices=mesh.vertices - np.float32([0, 0, 9]))) == MIDDLE


def test_a_camera_that_sees_nothing_is_no_reference():
    cameras = list(row_grid(9))
    back = np.diag([-1.0, 1.0, -1.0])
    cameras[MIDDLE] = replace(cameras[MIDDLE], R=back @ cameras[MIDDLE].R, t=back @ cameras[MIDDLE].t)
    assert chosen(cameras) in (1, 3, 5, 7)


def test_a_camera_sees_triangles_whose_corners_are_outside_its_frame():
    square, cameras = bumpy_square(2), list(row_grid(9))
    square = replace(square, vertices=square.vertices * np.float32(2.7))
    cameras[0] = closer(cameras[0], -9)  # the only one that sees the corners
    assert chosen(cameras, square) == MIDDLE


def test_wide_views_are_as_good_beside_tele_views():
    cameras = list(row_grid(9))
    cameras[MIDDLE] = replace(cameras[MIDDLE], K=TELE @ cameras[MIDDLE].K)
    capture = photographed(cameras)
    few = {"textures": 2, "preset": "small"}
    made, asked = (ef.encode(capture, bumpy_square(12), **few, **more) for more in ({}, {"reference": "camera 4"}))
    assert made.rig.reference != MIDDLE and asked.rig.reference == MIDDLE
    assert np.prod(made.appearance.atlas) < 0.5 * np.prod(asked.appearance.atlas)


def test_sheets_have_such_a_reference_too():
    scene = soft_scene()
    cameras = list(scene.rig.cameras)
    cameras[MIDDLE] = replace(cameras[MIDDLE], K=TELE @ cameras[MIDDLE].K)
    pictures = [Renderer(scene).draw(camera, ViewWeights()).image for camera in cameras]
    capture = CalibratedInMemory(InMemory(pictures), cameras)
    made = ef.encode(capture, scene.proxy, textures=1, preset="small")
    assert made.proxy.sheets is not None and made.rig.reference != MIDDLE
