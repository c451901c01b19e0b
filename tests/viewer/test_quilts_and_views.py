"""Quilts for displays, films of quilts, and grids of views: cameras that look one way and share a plane."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
import pytest

import eigenfield as ef
from eigenfield.capture import open_any
from eigenfield.capture.readers.hci import read_parameters
from eigenfield.core.errors import OptionError, OutputError
from eigenfield.core.viewplane import fit_view_plane
from eigenfield.gltf import save
from eigenfield.imaging.metrics import psnr
from eigenfield.rendering import RenderJob, renderer_of, view_weights
from eigenfield.rendering.parallel_cameras import parallel_cameras
from eigenfield.viewer import exports
from eigenfield.viewer.exports.quilt import quilt_of, quilt_views
from support.clips import numbered_clip
from support.scenes import tiny_scene


@pytest.fixture(scope="module")
def scene():
    """A 4 x 4 array in place of a row: cameras that see the square from even steps, both ways."""
    row = tiny_scene(cameras=16)
    first = row.rig.cameras[0]
    places = [(0.1 * (i % 4 - 1.5), 0.1 * (i // 4 - 1.5)) for i in range(16)]
    middle = np.mean([camera.centre for camera in row.rig.cameras], axis=0)
    cameras = tuple(replace(first, R=np.eye(3), t=-(middle + np.array([x, y, 0.0]))) for x, y in places)
    return replace(row, rig=replace(row.rig, cameras=cameras, view_plane=fit_view_plane(cameras)))


def frames_of(path) -> list[np.ndarray]:
    with av.open(str(path)) as film:
        return [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]


@pytest.mark.parametrize("name", exports.QUILT_DEVICES)
def test_a_quilt_for_a_display_has_its_tiles_and_its_shape(scene, name):
    """The whole is what the maker's toolkit says, but for what is left over; views have the display's shape."""
    sizes = {"go": (4092, 4092), "portrait": (3360, 3360), "16": (5999, 5999), "16-portrait": (5995, 6000),
             "32": (8190, 8190), "32-portrait": (8184, 8184), "65": (8192, 8190)}  # fmt: skip
    quilt = exports.quilt_of(scene, name)
    assert (quilt.columns * quilt.width, quilt.rows * quilt.height) == sizes[name]
    camera, _ = quilt_views(RenderJob(scene), replace(quilt, columns=3, rows=1))[1]
    assert (camera.width, camera.height) == (quilt.width, quilt.height)
    angles = [side / focal for side, focal in zip((quilt.width, quilt.height), np.diag(camera.K), strict=False)]
    pixel = np.divide(*np.diag(scene.rig.cameras[0].K)[:2])  # its height by its width
    assert pixel * angles[0] / angles[1] == pytest.approx(quilt.aspect, rel=2e-3)
    small = exports.quilt_of(scene, name, (30, 20))
    assert small.width == 30 and small.suffix == quilt.suffix


def test_a_quilt_of_one_view_is_seen_from_the_middle(scene):
    job = RenderJob(scene)
    one = quilt_of(scene, (1, 1))
    ((middle, _),) = quilt_views(job, one)
    np.testing.assert_allclose(middle.centre, scene.rig.view_plane.point(0, 0), atol=1e-9)


def test_a_quilt_that_exists_is_refused_before_it_is_drawn(scene, tmp_path, monkeypatch):
    path, _ = exports.export(scene, tmp_path / "a.png", "quilt", quilt=(2, 1))
    monkeypatch.setattr(RenderJob, "pixels", lambda *_: pytest.fail("a view is drawn"))
    with pytest.raises(OutputError) as caught:
        exports.export(scene, tmp_path / "a.png", "quilt", quilt=(2, 1))
    assert caught.value.code == "output-exists" and caught.value.path == str(path)


def test_a_film_of_quilts_moves_its_views_along_a_path(scene, tmp_path):
    file = tmp_path / "scene.glb"
    save(scene, file, codec="png")
    path, what = ef.export(file, tmp_path / "film.mp4", "quilt", quilt=(3, 2), resolution=(33, 24), path="circle",
                           frames=4, fps=10)  # fmt: skip
    assert path.name == "film_qs3x2a1.375.mp4" and "4 quilts of 6 views" in what
    frames = frames_of(path)
    assert len(frames) == 4 and frames[0].shape == (48, 96, 3)  # 33 columns of a tile would be odd
    job = RenderJob(ef.load(file))
    quilt = replace(exports.quilt_of(job.scene, (3, 2), (32, 24)), display=33 / 24)
    for number, y in ((1, 0.9), (3, -0.9)):  # a circle of 0.9, of which the whole width leaves Y
        for view, (camera, weights) in enumerate(quilt_views(job, quilt, (0.0, y))):
            row, column = 1 - view // 3, view % 3
            tile = frames[number][24 * row : 24 * row + 24, 32 * column : 32 * column + 32] / 255
            drawn = renderer_of(job.scene).draw(camera, weights).image.clip(0, 1)
            assert np.abs(tile.mean(axis=2) - drawn.mean(axis=2)).mean() < 0.03
    assert np.abs(frames[1].astype(int) - frames[3]).mean() > 1
    again, _ = ef.export(file, tmp_path / "again_qs3x2a1.333.mp4", quilt=(3, 2), resolution=(32, 24), frames=2)
    assert len(frames_of(again)) == 2


def test_what_spread_leaves_of_the_array_is_where_a_film_moves(scene):
    quilt = exports.quilt_of(scene, (5, 1), (16, 12), 0.25)
    for x in (-1.0, 0.4):
        views = quilt_views(RenderJob(scene), quilt, (x, 0.5))
        places = scene.rig.view_plane.coordinates([camera.centre for camera, _ in views])
        np.testing.assert_allclose(places[:, 0], 0.75 * x + np.linspace(-0.25, 0.25, 5), atol=1e-9)
        np.testing.assert_allclose(places[:, 1], 0.5, atol=1e-9)


def test_a_clip_becomes_a_film_of_quilts(tmp_path):
    clip = numbered_clip((2, 1))
    path, what = ef.export(clip, tmp_path / "clip.mp4", "quilt", quilt=(2, 1), resolution=(32, 24))
    assert path.name == "clip_qs2x1a1.333.mp4" and "3 quilts of 2 views" in what
    with av.open(str(path)) as film:
        assert film.streams.video[0].average_rate == clip.timeline.rate
    assert len(frames_of(path)) == 3
    still, _ = ef.export(clip, tmp_path / "still.png", "quilt", quilt=(2, 1), resolution=(32, 24), time=0.0)
    first = cv2.imread(str(still))[..., ::-1].astype(int)
    assert np.abs(frames_of(path)[0] - first).mean() < 6
    slow, _ = ef.export(clip, tmp_path / "slow.mp4", "quilt", quilt=(2, 1), resolution=(32, 24), fps=Fraction(5))
    with av.open(str(slow)) as film:
        assert film.streams.video[0].average_rate == 5
    with pytest.raises(OptionError, match="how many pictures"):
        ef.export(clip, tmp_path / "long.mp4", "quilt", frames=9)


def test_a_grid_of_views_is_read_as_hci_s_and_moves_as_its_parameters_say(scene, tmp_path):
    """A step of the baseline b moves a point at depth Z by b f (1/Z - 1/F) pixels."""
    _, what = ef.export(scene, tmp_path / "views", "views", grid=(3, 5), resolution=(60, 40))
    assert "3x5 views" in what
    opened = open_any(tmp_path / "views")
    assert opened.format == "hci" and len(opened) == 15 and opened.layout.shape == (3, 5)
    found = read_parameters(tmp_path / "views/parameters.cfg")
    assert (found.width, found.height, found.columns, found.rows) == (60, 40, 5, 3)
    assert found.baseline == pytest.approx(0.3 / 4)  # as far apart as the five fit into the array
    rig = parallel_cameras(scene, (60, 40), square=True)
    assert found.focus == pytest.approx(rig.depth) and found.focal == pytest.approx(rig.base.K[0, 0])
    vertices = scene.proxy.mesh.vertices.astype(float)
    left, right, below = (
        rig.at(rig.base.centre + x * rig.R[0] - y * rig.R[1]).project(vertices)[0]
        for x, y in ((0.0, 0.0), (found.baseline, 0.0), (0.0, -found.baseline))
    )
    depth = (vertices - rig.base.centre) @ rig.R[2]
    disparity = found.baseline * found.focal * (1 / depth - 1 / found.focus)
    np.testing.assert_allclose(left[:, 0] - right[:, 0], disparity, atol=1e-6)
    np.testing.assert_allclose(left[:, 1] - below[:, 1], disparity, atol=1e-6)
    np.testing.assert_allclose(left[:, 1], right[:, 1], atol=1e-6)
    low, high = found.disparities
    assert low <= disparity.min() + 0.2 and high >= disparity.max() - 0.2
    job = RenderJob(scene)
    drawn = job.pixels(rig.at(rig.base.centre), view_weights(scene, (0.0, 0.0)))
    np.testing.assert_array_equal(np.rint(opened.photograph(7).pixels * 255).astype(np.uint8), drawn)
    steps = np.array([camera.centre for camera in opened.cameras]).reshape(3, 5, 3)
    np.testing.assert_allclose(np.diff(steps[..., 0], axis=1), found.baseline, rtol=1e-6)


def test_a_line_of_cameras_makes_a_line_of_views(tmp_path):
    scene = tiny_scene(cameras=2)
    with pytest.raises(OptionError, match="1x9"):
        ef.export(scene, tmp_path / "views", "views", grid=(3, 3))
    ef.export(scene, tmp_path / "views", "views")
    opened = open_any(tmp_path / "views")
    assert opened.layout.shape == (1, 9) and len(opened) == 9


@pytest.mark.slow
def test_a_scene_of_a_quilt_draws_what_the_quilt_shows(tmp_path):
    """A scene, its quilt, a scene of the quilt: cameras and mesh are estimated from twelve small views alone."""
    source = Path(__file__).parents[2] / "docs/scene.glb"
    path, _ = ef.export(source, tmp_path / "q.png", "quilt", quilt=(4, 3), resolution=(128, 96))
    scene = ef.encode(path)
    whole = cv2.imread(str(path))[..., ::-1].astype(np.float32) / 255
    for view in (0, 5, 11):
        row, column = 2 - view // 4, view % 4
        tile = whole[96 * row : 96 * row + 96, 128 * column : 128 * column + 128]
        drawn = ef.render(scene, camera=f"view_{view:04d}.png").image.clip(0, 1)
        assert psnr(drawn, tile) > 31
