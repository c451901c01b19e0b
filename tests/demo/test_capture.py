"""The capture that the demo draws: exact geometry, pictures that agree with it, the same bytes every time."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest

from eigenfield.capture import open_capture
from eigenfield.core.errors import OptionError, OutputError
from eigenfield.core.viewplane import find_grid, fit_view_plane
from eigenfield.demo import draw_demo_capture
from eigenfield.demo.cameras import DEMO_HALF_ARRAY_UNITS, array_camera, array_cameras
from eigenfield.demo.capture import bake_look, draw_view
from eigenfield.demo.geometry import SURFACE_PARTS, build_geometry
from eigenfield.demo.light import radiance
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import atlas_fault, atlas_statistics, read_mesh
from eigenfield.runtime.parallel import set_threads
from support.folders import folder_digest

SIZE = 64


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo capture") / "a capture"
    calls = []
    draw_demo_capture(folder, rows=3, columns=4, size=SIZE, progress=lambda *call: calls.append(call))
    return folder, calls


def test_the_folder_is_complete_and_progress_ends(capture):
    folder, calls = capture
    assert len(list((folder / "images").glob("*.png"))) == 12
    assert calls[0] == ("draw", 0, 12) and calls[-1] == ("draw", 12, 12)
    assert [path.name for path in folder.parent.iterdir()] == ["a capture"]


def test_the_mesh_that_is_written_is_the_one_that_was_drawn(capture):
    mesh, read = build_geometry().mesh, read_mesh(capture[0] / "proxy.ply")
    np.testing.assert_array_equal(read.vertices, mesh.vertices)
    np.testing.assert_array_equal(read.faces, mesh.faces)
    np.testing.assert_array_equal(read.uv, mesh.uv)


def test_the_mesh_has_an_atlas_of_its_own():
    mesh = build_geometry().mesh
    assert atlas_fault(mesh) is None
    statistics = atlas_statistics(mesh)
    assert 20_000 < len(mesh.faces) < 30_000
    assert statistics.overlap == 0
    assert statistics.fill > 0.55


def test_charts_are_evenly_dense_in_the_middle_camera():
    mesh, camera = build_geometry().mesh, array_camera(0.0, 0.0, 512)
    seen = np.unique(rasterise_view(mesh, camera).face)
    pixels = camera.project(mesh.vertices)[0][mesh.faces[seen]]
    texels = mesh.uv[mesh.faces[seen]].astype(np.float64) * 800

    def area(corners):
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2

    ratio = np.sqrt(area(texels) / np.maximum(area(pixels), 1e-9))
    order = np.argsort(ratio)
    mass = np.cumsum(area(pixels)[order])
    low, middle, high = (ratio[order][np.searchsorted(mass, part * mass[-1])] for part in (0.02, 0.5, 0.9))
    assert low > 0.85 * middle
    assert high < 1.6 * middle


def test_every_pixel_of_every_view_is_covered():
    mesh = build_geometry().mesh
    for camera in array_cameras(3, 3, 128):
        assert (rasterise_view(mesh, camera).face >= 0).all()
    for x in (-1.1, 1.1):
        for y in (-1.1, 1.1):
            assert (
                rasterise_view(mesh, array_camera(x * DEMO_HALF_ARRAY_UNITS, y * DEMO_HALF_ARRAY_UNITS, 128)).face >= 0
            ).all()


def test_the_reader_finds_the_cameras_that_drew_it(capture):
    light_field = open_capture(capture[0])
    cameras = array_cameras(3, 4, SIZE)
    assert len(light_field.views) == 12
    by_name = {view.name: view.camera for view in light_field.views}
    for index, expected in enumerate(cameras):
        name = next(n for n in by_name if n.endswith(f"{index // 4:02d}_{index % 4:02d}.png"))
        np.testing.assert_allclose(by_name[name].matrix, expected.matrix, atol=1e-9)


def test_cameras_are_an_uneven_grid_in_a_plane_with_the_parallax_of_a_gantry():
    cameras = array_cameras(17, 17, 512)
    plane = fit_view_plane(cameras)
    grid = find_grid(plane.coordinates([camera.centre for camera in cameras]))
    assert grid is not None and (grid.rows, grid.columns) == (17, 17)
    offsets = np.array([camera.centre for camera in cameras]) - plane.origin
    assert np.abs(offsets @ np.cross(plane.right, plane.up)).max() < 1e-9
    steps = np.diff(plane.coordinates([camera.centre for camera in cameras[:17]])[:, 0])
    assert 0.02 < steps.std() / steps.mean() < 0.25
    mesh = build_geometry().mesh
    left, right = (array_camera(x * DEMO_HALF_ARRAY_UNITS, 0.0, 512).project(mesh.vertices)[0][:, 0] for x in (-1, 1))
    shift = (right - left)[np.unique(mesh.faces[rasterise_view(mesh, array_camera(0.0, 0.0, 512)).face])]
    assert 25 < shift.max() < 70 and 25 < -shift.min() < 70


def test_two_drawings_have_the_same_bytes_at_one_and_two_threads(tmp_path):
    digests = []
    for threads in (1, 2):
        set_threads(threads)
        try:
            draw_demo_capture(tmp_path / str(threads), rows=1, columns=3, size=32)
        finally:
            set_threads(None)
        digests.append(folder_digest(tmp_path / str(threads)))
    assert digests[0] == digests[1]


@pytest.fixture(scope="module")
def look():
    return bake_look(512)


def test_a_view_is_the_surface_where_the_mesh_says_it_is(look):
    """A surface that glows with its own world position, without reflections, is seen where it projects to."""
    mesh, camera = build_geometry().mesh, array_camera(0.2, -0.3, 96)
    from eigenfield.encoding.atlas import make_atlas

    atlas = make_atlas(mesh, 512, 512)
    glow = np.zeros((512 * 512, 8), np.float32)
    glow[:, 4] = 1
    glow[atlas.texel, :3] = (atlas.position + 2) / 8
    picture = draw_view(camera, look._replace(surface=glow.reshape(512, 512, 8)))
    raster = rasterise_view(mesh, camera)
    row, column = 78, 20  # on the floor, away from edges
    b = raster.edges[raster.face[row, column]] @ (column + 0.5, row + 0.5, 1.0)
    point = (b / b.sum()) @ mesh.vertices[mesh.faces[raster.face[row, column]]]
    linear = 1.05 * (point + 2) / 8
    coded = 255 * (1.055 * linear ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(picture[row, column], coded, atol=3)


def test_highlights_move_with_the_camera_and_paint_does_not(look):
    """The same points of the jar, seen from both ends of the array: reflections change what paint alone would not."""
    mesh = build_geometry().mesh
    dull = look.surface.copy()
    dull[..., 6] = 0
    x, y, z = mesh.vertices.T
    points = mesh.vertices[(np.hypot(x, z) < 0.58) & (np.abs(x) < 0.3) & (z > 0.35) & (y > 0.6) & (y < 0.9)]
    assert len(points) > 300
    change = []
    for surface in (look.surface, dull):
        values = []
        for x in (-DEMO_HALF_ARRAY_UNITS, DEMO_HALF_ARRAY_UNITS):
            camera = array_camera(x, 0.0, 256)
            picture = draw_view(camera, look._replace(surface=surface)).astype(np.float32)
            place = camera.project(points)[0]
            values.append(cv2.remap(picture, *(place[None, :, k].astype(np.float32) - 0.5 for k in (0, 1)), 1))
        change.append(np.quantile(np.abs(values[0] - values[1]), 0.97))
    assert change[0] > 25
    assert change[0] > 2 * change[1]


def test_chrome_and_glass_show_the_scene_and_nothing_else_does(look):
    """With all other things' surfaces black and without reflections, only the two balls change."""
    scene, camera = build_geometry(), array_camera(0.0, 0.0, 128)
    around = np.zeros_like(look.around)
    around[..., 4] = 1  # a normal
    dark = draw_view(camera, look._replace(around=around))
    changed = (dark != draw_view(camera, look)).any(axis=2)
    face = rasterise_view(scene.mesh, camera).face
    for name in SURFACE_PARTS:
        inner = cv2.erode((scene.part[face] == SURFACE_PARTS.index(name)).astype(np.uint8), np.ones((3, 3))) > 0
        assert inner.sum() > 30
        assert changed[inner].mean() > 0.3 if name in ("chrome", "glass") else not changed[inner].any()


def test_highlights_are_about_ten_degrees_wide():
    """Across the key light, radiance in the smooth gloss falls to half within 4 to 8 degrees on each side."""
    axis = np.array([-0.62, 0.62, 0.52]) / np.linalg.norm([-0.62, 0.62, 0.52])
    up = np.cross(axis, np.cross((0.0, 1.0, 0.0), axis))
    up /= np.linalg.norm(up)
    angle = np.radians(np.arange(0, 25, 0.25))
    along = radiance(np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * up, 4.0)[:, 0]
    assert 4 < np.degrees(angle[np.argmax(along < along[0] / 2)]) < 12


def test_no_pixel_is_blank_and_fine_detail_is_there(look):
    picture = draw_view(array_camera(0.0, 0.0, 128), look).astype(np.float32)
    assert picture.mean() > 60 and 100 * (picture > 250).mean() < 3
    assert np.abs(np.diff(picture, axis=1)).mean() > 8


@pytest.mark.parametrize(("rows", "columns", "size"), [(0, 5, 64), (1, 2, 64), (3, 3, 8)])
def test_sizes_that_cannot_be_are_refused(tmp_path, rows, columns, size):
    with pytest.raises(OptionError) as caught:
        draw_demo_capture(tmp_path / "x", rows=rows, columns=columns, size=size)
    assert caught.value.code == "demo-size"
    assert not (tmp_path / "x").exists()


def test_an_existing_folder_is_left_alone(tmp_path):
    (tmp_path / "x").mkdir()
    with pytest.raises(OutputError) as caught:
        draw_demo_capture(tmp_path / "x")
    assert caught.value.code == "output-exists"
    with pytest.raises(OutputError) as caught:
        draw_demo_capture(tmp_path / "not there" / "x")
    assert caught.value.code == "no-folder"


def test_an_interrupted_drawing_leaves_nothing(tmp_path):
    def interrupt(stage, done, total):
        if done == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        draw_demo_capture(tmp_path / "x", rows=1, columns=3, size=32, progress=interrupt)
    assert list(tmp_path.iterdir()) == []


def test_transforms_are_nerfstudio_json(capture):
    tree = json.loads((capture[0] / "transforms.json").read_text())
    assert {(frame["w"], frame["h"]) for frame in tree["frames"]} == {(SIZE, SIZE)}
    pose = np.array(tree["frames"][0]["transform_matrix"])
    np.testing.assert_allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-12)
    assert np.linalg.det(pose[:3, :3]) > 0
    assert pose[1, 1] > 0.9  # up is up
    assert {round(frame["cx"], 6) for frame in tree["frames"]} != {SIZE / 2}
