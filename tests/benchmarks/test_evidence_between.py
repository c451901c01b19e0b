"""Ways to draw held-out views, on scenes whose pictures are known: a textured sheet, a square before a wall."""

from __future__ import annotations

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.gltf import save
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.raster import rasterise_view
from evidence.between import between, start, ways_of
from evidence.lumigraph import draw_lumigraph, make_lumigraph
from evidence.prepared import spread_over_array
from support import captures
from support.captures import shaded_texture, write_capture
from support.scenes import row_grid, tiny_scene

RED, BLUE = np.array([0.9, 0.1, 0.1], np.float32), np.array([0.1, 0.2, 0.9], np.float32)


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    """A bumpy, matt backdrop seen by 5 x 5 cameras, encoded without the odd rows and columns."""
    folder = tmp_path_factory.mktemp("between") / "capture"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(captures, "shaded_texture", lambda index, total: shaded_texture(0, total))
        write_capture(folder, cameras=row_grid(25, 64, 56))
    light_field = open_capture(folder)
    scene = ef.encode(light_field, folder / "proxy.ply", textures=4, hold_out="odd", density=1.5, fit="none")
    file = folder / "scene.glb"
    save(scene, file)
    return folder, light_field, ef.load(file), file


def square(z: float, half: float) -> Mesh:
    corners = [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]]
    return Mesh(np.array(corners, np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.int32))


def joined(first: Mesh, second: Mesh) -> Mesh:
    faces = np.concatenate([first.faces, second.faces + len(first.vertices)])
    return Mesh(np.concatenate([first.vertices, second.vertices]), faces.astype(np.int32))


@pytest.mark.slow
def test_with_exact_geometry_both_ways_on_the_proxy_beat_those_without_it(capture):
    _, light_field, scene, file = capture
    result = between(*start(scene, light_field), file=file)
    rows = {row["key"]: row for row in result["methods"]}
    assert list(rows) == ["nearest", "blend", "lumigraph", "delaunay", "nearest3", "bilinear"]
    assert result["cameras"] == result["held_out"] == 16 and result["encoded"] == 9
    assert rows["lumigraph"]["psnr"] > 34 and rows["bilinear"]["psnr"] > 33
    assert rows["nearest"]["psnr"] < rows["lumigraph"]["psnr"] - 10
    assert rows["blend"]["psnr"] < rows["bilinear"]["psnr"] - 8
    for row in rows.values():
        assert row["worst"]["psnr"]["value"] <= row["psnr"] and row["worst"]["flip"]["value"] >= row["flip"]
    assert result["bytes"]["scene"] == file.stat().st_size
    encoded = [light_field.bytes(i) for i in range(25) if not scene.rig.held_out[i]]
    assert result["bytes"]["photographs"] == sum(encoded)


def test_all_ways_are_measured_over_the_same_pixels(capture):
    _, light_field, scene, _ = capture
    rows = between(*start(scene, light_field), 2)["methods"]
    assert len({row["coverage"] for row in rows}) == 1 and 0.9 < rows[0]["coverage"] <= 1


def test_pixels_outside_circles_are_counted_apart(capture):
    from eigenfield.evaluation import ExcludedCircle

    _, light_field, scene, _ = capture
    none = {name: ExcludedCircle(0, 0, 0) for name in scene.rig.names}
    row = between(*start(scene, light_field), 2, circles=none)["methods"][0]
    assert row["psnr_outside"] == row["psnr"]
    left = {name: ExcludedCircle(0, 28, 32) for name in scene.rig.names}
    row = between(*start(scene, light_field), 2, circles=left)["methods"][0]
    assert row["psnr_outside"] != row["psnr"]


def test_off_a_grid_bilinear_weights_are_left_out_with_a_word(capture):
    folder, light_field, _, _ = capture
    scene = ef.encode(light_field, folder / "proxy.ply", textures=2, hold_out="every:4", density=0.8, fit="none")
    result = between(*start(scene, light_field), 2)
    assert "bilinear" not in [row["key"] for row in result["methods"]]
    assert "No bilinear view weights" in result["words"] and "Delaunay" in result["words"]


def test_the_blend_without_geometry_is_the_mean_of_the_neighbours_in_the_middle_of_a_cell(capture):
    _, light_field, scene, _ = capture
    stage, peers = start(scene, light_field)
    middle = 6  # row 1, column 1: between the cameras 0, 2, 10 and 12
    mean = np.mean([light_field.photograph(i).pixels for i in (0, 2, 10, 12)], axis=0)
    assert np.abs(ways_of(stage, peers)["blend"](middle) - mean).max() < 0.51 / 255


def test_a_camera_that_coincides_with_an_encoded_one_takes_its_photograph():
    camera, other = row_grid(2)
    random = np.random.default_rng(0)
    pictures = random.integers(0, 256, (2, camera.height, camera.width, 3)).astype(np.float32) / 255
    lumigraph = make_lumigraph(square(0.5, 9.0), [camera, other], lambda i: (pictures[i], None))
    image, surface, holes = draw_lumigraph(lumigraph, camera)
    assert surface.all() and not holes.any()
    assert (to_codes(image) == to_codes(pictures[0])).all()


def test_an_occluder_is_not_painted_on_the_plane_behind_it():
    """A blue square before a red wall, flat colours: each pixel has its own surface's colour, but where a photograph's
    taps reach over the square's outline."""
    mesh = joined(square(1.0, 9.0), square(-1.0, 0.3))
    cameras = row_grid(9, 96, 80)

    def is_square(camera: Camera) -> np.ndarray:
        return rasterise_view(mesh, camera).face >= 2

    def picture(camera: Camera) -> np.ndarray:
        return np.where(is_square(camera)[..., None], BLUE, RED)

    here, others = cameras[4], cameras[:4] + cameras[5:]
    clear = np.ones((80, 96), bool)
    for camera in others:
        clear &= ~near_outline(is_square(camera), surface_pixels(here, camera, is_square(here)))
    assert clear.sum() > 2000
    lumigraph = make_lumigraph(mesh, others, lambda i: (picture(others[i]), None))
    image, _, holes = draw_lumigraph(lumigraph, here)
    assert np.abs(image - picture(here))[clear].max() < 1 / 255 and not holes.any()
    lumigraph.depths[:] = 0  # without depth maps nothing is hidden: the square's ghosts stand on the wall
    ghosts = np.abs(draw_lumigraph(lumigraph, here)[0] - picture(here)).max(axis=2) > 0.1
    assert (ghosts & clear).sum() > 20


def surface_pixels(here: Camera, there: Camera, square: np.ndarray) -> np.ndarray:
    """(H, W, 2): where `there` has what each pixel of `here` shows, the square at z = -1 or the wall at z = 1."""
    y, x = np.indices(square.shape) + 0.5
    rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(here.K).T
    depth = np.where(square, -1.0, 1.0) - here.centre[2]
    return there.project((here.centre + rays * depth[..., None]).reshape(-1, 3))[0].reshape(*square.shape, 2)


def near_outline(square: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Whether the 5 x 5 pixels round positions (H, W, 2) are of both kinds."""
    window = np.lib.stride_tricks.sliding_window_view(np.pad(square, 2, mode="edge"), (5, 5))
    mixed = window.any(axis=(2, 3)) & ~window.all(axis=(2, 3))
    column, row = (np.clip(at[..., k].astype(int), 0, square.shape[1 - k] - 1) for k in range(2))
    return mixed[row, column]


def test_what_a_mask_hides_is_not_drawn():
    mesh = square(0.5, 9.0)
    cameras = row_grid(4)
    pictures = [np.full((40, 48, 3), 0.2 if i else 0.6, np.float32) for i in range(4)]
    masks = [np.zeros((40, 48), np.float32) if i else None for i in range(4)]
    lumigraph = make_lumigraph(mesh, cameras, lambda i: (pictures[i], masks[i]))
    image, _, holes = draw_lumigraph(lumigraph, cameras[3])
    assert np.abs(image - 0.6).max() < 1e-6 and holes.any() and not holes.all()


def test_weights_fall_to_nothing_where_the_next_photograph_takes_over():
    """Flat photographs of different grey: along a line of viewpoints the grey never jumps."""
    mesh = square(0.5, 9.0)
    cameras = row_grid(9)
    grey = np.random.default_rng(1).uniform(0, 1, 9).astype(np.float32)
    lumigraph = make_lumigraph(mesh, cameras, lambda i: (np.full((40, 48, 3), grey[i], np.float32), None))
    seen = []
    for x in np.linspace(-0.4, 0.4, 81):
        camera = Camera(cameras[0].K, np.eye(3), np.array([x, 0.13, 3.0]), 48, 40)
        seen.append(draw_lumigraph(lumigraph, camera)[0][20, 24, 0])
    steps = np.abs(np.diff(seen))
    assert np.ptp(seen) > 0.1 and steps.max() < 0.12 * np.ptp(seen)


def test_a_sample_is_spread_over_the_array():
    scene = tiny_scene(cameras=25)
    assert spread_over_array(scene, list(range(25)), 25) == list(range(25))
    nine = spread_over_array(scene, list(range(25)), 9)
    places = scene.rig.view_plane.coordinates([scene.rig.cameras[i].centre for i in nine])
    for sign in ((-1, -1), (1, -1), (-1, 1), (1, 1)):
        assert (places * sign > 0.1).all(axis=1).any()
    assert len(set(spread_over_array(scene, list(range(25)), 7))) == 7


def test_psnr_of_ours_agrees_with_evaluate(capture):
    """The project's own measure of held-out views, an independent route to the same figure."""
    _, light_field, scene, _ = capture
    ours = next(row for row in between(*start(scene, light_field))["methods"] if row["key"] == "delaunay")
    theirs = ef.evaluate(scene, light_field, png_maps="none")["image"]["held_out"]
    for key in ("psnr", "psnr_luma", "psnr_full", "ssim"):
        assert ours[key] == pytest.approx(theirs[key], abs=1e-6)


def test_without_held_out_photographs_there_is_nothing_to_measure(capture):
    _, light_field, scene, _ = capture
    kept = light_field.subset(np.flatnonzero(~scene.rig.held_out).tolist())
    with pytest.raises(ValueError, match="holds out no camera"):
        between(*start(scene, kept))
