"""The footage that the demo draws: pictures, meshes and times agree, and the bytes are the same every time."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest

from eigenfield.capture import open_footage
from eigenfield.core.errors import OptionError, OutputError
from eigenfield.demo import draw_demo_clip
from eigenfield.demo.cameras import array_cameras
from eigenfield.demo.clip import CLIP_MESHES, CLIP_RATE, is_drawn
from eigenfield.demo.geometry import ALL_PARTS, GLASS_SPHERE, MARBLE_SPHERE, ORANGE_SPHERE
from eigenfield.demo.motion import moved
from eigenfield.demo.moving import moving_scene
from eigenfield.demo.rays import build_tree, nearest_triangle
from eigenfield.evaluation.flicker import StillPixels
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import read_mesh
from eigenfield.runtime.parallel import set_threads
from support.folders import folder_digest

pytestmark = pytest.mark.slow

SIZE, FRAMES, COLUMNS = 128, 4, 3


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    folder, calls = tmp_path_factory.mktemp("demo clip") / "some footage", []
    draw_demo_clip(folder, rows=1, columns=COLUMNS, size=SIZE, frames=FRAMES, progress=lambda *call: calls.append(call))
    return folder, calls


@pytest.fixture(scope="module")
def meshes(drawn):
    return [read_mesh(drawn[0] / (CLIP_MESHES % frame)) for frame in range(FRAMES)]


def pictures(folder, frame):
    return [cv2.imread(str(folder / f"cam_0_{column}" / f"{frame:06d}.png")) for column in range(COLUMNS)]


def test_the_folder_is_complete_and_progress_ends(drawn):
    folder, calls = drawn
    assert is_drawn(folder) and not is_drawn(folder.parent)
    assert len(list(folder.glob("cam_0_*/*.png"))) == COLUMNS * FRAMES
    assert calls[0] == ("draw", 0, FRAMES) and calls[-1] == ("draw", FRAMES, FRAMES)
    assert {path.name for path in folder.iterdir()} == {
        "transforms.json", *(f"cam_0_{column}" for column in range(COLUMNS)),
        *(CLIP_MESHES % frame for frame in range(FRAMES)),
    }  # fmt: skip


def test_it_is_footage_of_the_cameras_that_drew_it(drawn):
    footage = open_footage(drawn[0])
    assert len(footage) == FRAMES and float(footage.timeline.rate) == CLIP_RATE and not footage.problems
    assert footage.names == tuple(f"cam_0_{column}" for column in range(COLUMNS))
    for camera, expected in zip(footage.cameras, array_cameras(1, COLUMNS, SIZE), strict=True):
        np.testing.assert_allclose(camera.matrix, expected.matrix, atol=1e-9)
    for frame in (0, 3):
        for index, picture in enumerate(pictures(drawn[0], frame)):
            pixels = footage.instant(frame).photograph(index).pixels
            np.testing.assert_array_equal(np.rint(pixels * 255), picture[..., ::-1])


def test_meshes_have_the_same_faces_and_texture_coordinates_and_other_places(meshes):
    scene = moving_scene()
    own = np.isin(scene.part, [ALL_PARTS.index(name) for name in ("orange", "marble", "glass", "sheet")])
    moving = np.isin(np.arange(len(scene.mesh.vertices)), scene.mesh.faces[own])
    for mesh in meshes[1:]:
        np.testing.assert_array_equal(mesh.faces, meshes[0].faces)
        np.testing.assert_array_equal(mesh.uv, meshes[0].uv)
        change = np.linalg.norm(mesh.vertices - meshes[0].vertices, axis=1)
        assert (change[~moving] == 0).all()
        assert (change[moving] > 0.01).mean() > 0.6


@pytest.mark.parametrize(("name", "sphere"), [("orange", ORANGE_SPHERE), ("marble", MARBLE_SPHERE),
                                              ("glass", GLASS_SPHERE)])  # fmt: skip
def test_rays_meet_each_ball_of_a_frame_s_mesh_where_it_is_then(meshes, name, sphere):
    eye, radius = array_cameras(1, COLUMNS, SIZE)[1].centre, sphere[1]
    for frame, mesh in enumerate(meshes):
        middle = moved(name, sphere[0][None], frame / FRAMES)[0]
        far = float(np.linalg.norm(middle - eye))
        ray = (middle - eye) / far
        found = nearest_triangle(*build_tree(mesh), eye, ray, np.inf, np.empty(64, np.int64), np.empty(2))
        assert found <= far - radius + 0.004  # another ball may be before it
        assert name == "orange" or found == pytest.approx(far - radius, abs=0.004)


def test_photographs_agree_on_the_mesh_of_their_own_frame_alone(drawn, meshes):
    """Points that both outer cameras see have the same colour in both; on another frame's mesh, what moved has not."""
    cameras = array_cameras(1, COLUMNS, SIZE)

    def disagreement(mesh, moving, frame):
        seen, colours = np.ones(len(mesh.vertices), bool), []
        for camera, picture in zip(cameras, pictures(drawn[0], frame), strict=True):
            place, depth = camera.project(mesh.vertices)
            raster = rasterise_view(mesh, camera)
            column, row = np.clip(place.astype(int), 0, SIZE - 1).T
            nearest = mesh.vertices[mesh.faces[raster.face[row, column]]].mean(axis=1)
            seen &= np.abs((nearest - camera.centre) @ camera.R[2] - depth) < 0.03
            colours.append(cv2.remap(picture, *(place[None, :, k].astype(np.float32) - 0.5 for k in (0, 1)), 1)[0])
        difference = np.abs(colours[0].astype(float) - colours[-1]).mean(axis=1)
        assert (seen & moving).sum() > 300
        return np.median(difference[seen & moving])

    moving = np.linalg.norm(np.ptp([mesh.vertices for mesh in meshes], axis=0), axis=1) > 0.05
    for frame in range(FRAMES):
        right = disagreement(meshes[frame], moving, frame)
        wrong = disagreement(meshes[(frame + 1) % FRAMES], moving, frame)
        assert right < 16 and wrong > 1.4 * right, (frame, right, wrong)


def test_some_of_it_moves_and_some_stands_still(drawn):
    found = StillPixels()
    for frame in range(FRAMES):
        found.add(pictures(drawn[0], frame)[1])
    assert 0.1 < found.still.mean() < 0.9


def test_two_drawings_have_the_same_bytes_at_one_and_two_threads_and_after_a_stop(tmp_path):
    def draw(name, progress=None):
        draw_demo_clip(tmp_path / name, rows=1, columns=3, size=32, frames=2, progress=progress)

    def interrupt(stage, done, total):
        if done == 1:
            raise KeyboardInterrupt

    try:
        set_threads(1)
        draw("one")
        set_threads(2)
        with pytest.raises(KeyboardInterrupt):
            draw("two", interrupt)
        assert not is_drawn(tmp_path / "two")
        kept = tmp_path / "two" / "cam_0_0" / "000000.png"
        before = kept.stat().st_mtime_ns
        draw("two")
    finally:
        set_threads(None)
    assert kept.stat().st_mtime_ns == before
    assert folder_digest(tmp_path / "one") == folder_digest(tmp_path / "two")


def test_what_is_there_is_kept(drawn):
    before = folder_digest(drawn[0])
    (drawn[0] / "cam_0_1" / "000001.png").rename(drawn[0] / "moved.png")
    try:
        draw_demo_clip(drawn[0], rows=1, columns=COLUMNS, size=SIZE, frames=FRAMES)
        assert not (drawn[0] / "cam_0_1" / "000001.png").exists()
    finally:
        (drawn[0] / "moved.png").rename(drawn[0] / "cam_0_1" / "000001.png")
    assert folder_digest(drawn[0]) == before


def test_times_are_those_of_the_frames(drawn):
    document = json.loads((drawn[0] / "transforms.json").read_text())
    assert document["fps"] == CLIP_RATE
    for entry in document["frames"]:
        assert int(entry["file_path"][-10:-4]) == round(entry["time"] * CLIP_RATE)


@pytest.mark.parametrize("asked", [{"rows": 0}, {"rows": 1, "columns": 2}, {"size": 8}, {"frames": 0}])
def test_sizes_that_cannot_be_are_refused(tmp_path, asked):
    with pytest.raises(OptionError) as caught:
        draw_demo_clip(tmp_path / "x", **asked)
    assert caught.value.code == "demo-size"
    assert not (tmp_path / "x").exists()


def test_a_file_in_its_place_is_said(tmp_path):
    (tmp_path / "x").write_text("")
    with pytest.raises(OutputError, match="is a file"):
        draw_demo_clip(tmp_path / "x", rows=1, columns=3, size=16, frames=1)
