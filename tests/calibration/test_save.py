"""Calibrations as other tools read them: written whole, read back to the same cameras."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pycolmap
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from eigenfield.capture import Lens, LightField, View, open_capture
from eigenfield.capture.points import SparsePoints
from eigenfield.capture.writers.colmap import quaternion
from eigenfield.capture.writers.save import save_calibration
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OutputError
from eigenfield.imaging.png import png_bytes
from eigenfield.runtime.files import write_bytes
from support.scenes import row_grid

LENSES = {
    "none": None,
    "radial": Lens("brown", (-0.1, 0.0, 0.0, 0.0, 0.0)),
    "brown": Lens("brown", (-0.1, 0.02, 0.001, -0.002, 0.0)),
    "brown k3": Lens("brown", (-0.1, 0.02, 0.001, -0.002, 0.003)),
    "fisheye": Lens("fisheye", (-0.01, 0.002, 0.0, 0.0)),
    "rational": Lens("rational", (-0.1, 0.02, 0.001, -0.002, 0.003, 0.01, 0.02, 0.003)),
    "metashape": Lens("metashape", (-0.1, 0.02, 0.0, 0.0, 0.001, 0.002, 0.0, 0.0, 0.004)),
}


def turned(camera: Camera, seed: int) -> Camera:
    """The camera at an odd angle, so that nothing in its pose is round."""
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    R = q * np.sign(np.linalg.det(q))
    return Camera(camera.K, R, R @ np.array([0.1 * seed, 0.3, -1 / 3]), camera.width, camera.height)


def light_field(folder: Path, lenses: list[Lens | None], mask: bool = False) -> LightField:
    """Real files with odd names below folder/images, a camera each; square pixels for a radial lens alone."""
    (folder / "images" / "a b").mkdir(parents=True)
    views = []
    for index, (camera, lens) in enumerate(zip(row_grid(len(lenses), 24, 20), lenses, strict=True)):
        path = folder / "images" / ("a b" if index % 2 else "") / f"view_{index}.png"
        write_bytes(path, png_bytes(np.full((20, 24, 3), 0.5, np.float32)))
        hidden = None
        if mask:
            hidden = folder / f"mask_{index}.png"
            write_bytes(hidden, png_bytes(np.ones((20, 24, 3), np.float32)))
        if lens == LENSES["radial"]:
            camera = replace(camera, K=np.array([[50.0, 0, 13.5], [0, 50, 9.5], [0, 0, 1]]))
        views.append(View(path.name, path, turned(camera, index), lens, hidden))
    return LightField(folder, tuple(views), (), "test")


def some_points(views: int, count: int = 7) -> SparsePoints:
    random = np.random.default_rng(3)
    point = np.repeat(np.arange(count), 2)
    view = np.concatenate([np.sort(random.choice(views, 2, replace=False)) for _ in range(count)])
    return SparsePoints(
        random.normal(size=(count, 3)),
        random.integers(0, 256, (count, 3)).astype(np.uint8),
        random.uniform(0, 1, count),
        point,
        view,
        random.uniform(0, 20, (2 * count, 2)),
    )


def same(read: LightField, written: LightField) -> None:
    assert read.names == written.names
    for a, b in zip(read.views, written.views, strict=True):
        assert a.path.resolve() == b.path.resolve()
        assert (a.camera.width, a.camera.height) == (b.camera.width, b.camera.height)
        for x, y in ((a.camera.K, b.camera.K), (a.camera.R, b.camera.R), (a.camera.t, b.camera.t)):
            np.testing.assert_allclose(x, y, rtol=0, atol=1e-9)
        assert (a.lens is None) == (b.lens is None)
        if a.lens is not None and b.lens is not None:
            assert a.lens.model == b.lens.model
            np.testing.assert_allclose(a.lens.coefficients, b.lens.coefficients, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", [name for name in LENSES if name != "metashape"])
def test_both_forms_are_read_back_to_the_same_cameras(name, tmp_path):
    field = light_field(tmp_path / "photos", [LENSES[name]] * 4)
    save_calibration(field, tmp_path / "out", some_points(4))
    same(open_capture(tmp_path / "photos", calibration=tmp_path / "out" / "transforms.json"), field)
    same(open_capture(tmp_path / "photos", calibration=tmp_path / "out" / "sparse" / "0"), field)


@pytest.mark.parametrize("orientation", [1, 3, 6, 8])
@pytest.mark.parametrize("name", ["none", "brown k3", "rational", "fisheye"])
def test_photographs_that_exif_turns_stand_in_each_form_as_its_readers_take_them(orientation, name, tmp_path):
    lens = LENSES[name]
    if lens is not None and name != "fisheye":
        lens = Lens(lens.model, tuple(c * (4 if 1 < i < 4 else 1) for i, c in enumerate(lens.coefficients)))
    views = []
    (tmp_path / "photos").mkdir()
    exif = Image.Exif()
    exif[0x0112] = orientation
    pixels = np.random.default_rng(orientation).uniform(60, 200, (4, 5, 3)).astype(np.uint8)
    for index in range(3):
        stored = Image.fromarray(pixels).resize((48, 40), Image.Resampling.BICUBIC)
        width, height = (40, 48) if orientation > 4 else (48, 40)
        stored.save(tmp_path / "photos" / f"v{index}.png", exif=exif)
        camera = turned(Camera(np.array([[50, 0, 21], [0, 47, 23], [0, 0, 1.0]]), np.eye(3), np.zeros(3), 1, 1), index)
        camera = replace(camera, width=width, height=height)
        views.append(View(f"v{index}.png", tmp_path / "photos" / f"v{index}.png", camera, lens))
    field = LightField(tmp_path / "photos", tuple(views), (), "test")
    points = replace(some_points(3), pixels=np.tile([11.0, 5.0], (14, 1)))
    save_calibration(field, tmp_path / "out", points)
    same(open_capture(tmp_path / "photos", calibration=tmp_path / "out" / "transforms.json"), field)

    back = {1: 0, 3: 2, 6: 1, 8: -1}[orientation]  # quarter turns from the upright picture to the stored one
    of_colmap = open_capture(tmp_path / "photos", calibration=tmp_path / "out" / "sparse" / "0")
    for index, view in enumerate(of_colmap.views):
        upright, stored = field.photograph(index), of_colmap.photograph(index)
        np.testing.assert_allclose(np.rot90(upright.pixels, back), stored.pixels, atol=2e-5)
        if upright.mask is not None and stored.mask is not None:
            assert np.mean(np.rot90(upright.mask, back) != stored.mask) < 0.01  # pixels on the rim fall either way
        points_seen = view.camera.R.T @ np.array([[0.1, -0.2, 3.0], [0.3, 0.2, 2.0]]).T + view.camera.centre[:, None]
        (x, y), (u, v) = field.views[index].camera.project(points_seen.T)[0].T, view.camera.project(points_seen.T)[0].T
        width, height = field.sizes[index]
        at = {1: (x, y), 3: (width - x, height - y), 6: (y, width - x), 8: (height - y, x)}[orientation]
        np.testing.assert_allclose((u, v), at, atol=1e-9)
    seen = pycolmap.Reconstruction(str(tmp_path / "out" / "sparse" / "0")).images[1].points2D[0].xy
    width, height = field.sizes[0]
    at = {1: (11, 5), 3: (width - 11, height - 5), 6: (5, width - 11), 8: (height - 5, 11)}[orientation]
    np.testing.assert_allclose(seen, at, atol=1e-9)


def test_mirrored_photographs_have_no_camera_in_colmap(tmp_path, caplog):
    field = light_field(tmp_path / "photos", [None] * 3)
    exif = Image.Exif()
    exif[0x0112] = 2
    Image.open(field.views[1].path).save(field.views[1].path, exif=exif)
    save_calibration(field, tmp_path / "out")
    assert not (tmp_path / "out" / "sparse").exists() and "COLMAP" in caplog.text
    same(open_capture(tmp_path / "photos", calibration=tmp_path / "out" / "transforms.json"), field)


def test_lenses_that_differ_stand_in_each_frame(tmp_path):
    field = light_field(tmp_path / "photos", list(LENSES.values()))
    save_calibration(field, tmp_path / "out")
    same(open_capture(tmp_path / "photos", calibration=tmp_path / "out" / "transforms.json"), field)


def test_a_lens_unknown_to_colmap_leaves_its_model_out(tmp_path, caplog):
    field = light_field(tmp_path / "photos", [LENSES["metashape"]] * 3)
    save_calibration(field, tmp_path / "out", some_points(3))
    assert not (tmp_path / "out" / "sparse").exists()
    assert "no model for the lens" in caplog.text
    same(open_capture(tmp_path / "photos", calibration=tmp_path / "out" / "transforms.json"), field)
    # other readers of the format must refuse it rather than take the photographs for undistorted
    assert json.loads((tmp_path / "out" / "transforms.json").read_text())["camera_model"] == "EIGENFIELD"


def test_the_folder_alone_finds_its_photographs_and_masks(tmp_path):
    field = light_field(tmp_path / "photos", [None] * 3, mask=True)
    save_calibration(field, tmp_path / "out")
    read = open_capture(tmp_path / "out")
    same(read, field)
    assert [view.mask and view.mask.resolve() for view in read.views] == [
        view.mask and view.mask.resolve() for view in field.views
    ]


def test_colmap_reads_the_model_with_its_points(tmp_path):
    field, points = light_field(tmp_path / "photos", [LENSES["brown"]] * 4), some_points(4)
    save_calibration(field, tmp_path / "out", points)
    model = pycolmap.Reconstruction(tmp_path / "out" / "sparse" / "0")
    assert model.num_reg_images() == 4 and model.num_cameras() == 1 and model.num_points3D() == len(points)
    for index, view in enumerate(field.views):
        image = model.image(index + 1)
        assert (tmp_path / "photos" / image.name).resolve() == view.path.resolve()
        np.testing.assert_allclose(image.cam_from_world().matrix()[:, :3], view.camera.R, atol=1e-12)
        np.testing.assert_allclose(image.cam_from_world().matrix()[:, 3], view.camera.t, atol=1e-12)
    for row in range(len(points)):
        point = model.point3D(row + 1)
        np.testing.assert_allclose(point.xyz, points.positions[row])
        assert point.color.tolist() == points.colours[row].tolist()
        seen = {(e.image_id - 1, *model.image(e.image_id).point2D(e.point2D_idx).xy) for e in point.track.elements}
        here = points.point == row
        assert seen == {(v, *xy) for v, xy in zip(points.view[here].tolist(), points.pixels[here], strict=True)}


def test_the_ply_holds_the_points(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    points = some_points(3)
    save_calibration(light_field(tmp_path / "photos", [None] * 3), tmp_path / "out", points)
    cloud = trimesh.load(tmp_path / "out" / "points.ply")
    np.testing.assert_allclose(cloud.vertices, points.positions, atol=1e-6)
    assert np.asarray(cloud.visual.vertex_colors)[:, :3].tolist() == points.colours.tolist()


def test_the_same_calibration_gives_the_same_bytes(tmp_path):
    field = light_field(tmp_path / "photos", [LENSES["brown"]] * 3)
    for name in ("one", "two"):
        save_calibration(field, tmp_path / name, some_points(3))
    files = sorted(p.relative_to(tmp_path / "one") for p in (tmp_path / "one").rglob("*") if p.is_file())
    assert len(files) == 5
    for file in files:
        assert (tmp_path / "one" / file).read_bytes() == (tmp_path / "two" / file).read_bytes()


def test_nothing_is_written_where_something_is(tmp_path):
    field = light_field(tmp_path / "photos", [None] * 3)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "notes.txt").write_text("mine")
    with pytest.raises(OutputError) as error:
        save_calibration(field, tmp_path / "out")
    assert error.value.code == "output-exists"
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["notes.txt"]


def test_overwrite_replaces_its_own_and_leaves_the_rest(tmp_path):
    field = light_field(tmp_path / "photos", [None] * 4)
    save_calibration(field, tmp_path / "out", some_points(4))
    (tmp_path / "out" / "notes.txt").write_text("mine")
    fewer = field.subset([0, 1, 2])
    save_calibration(fewer, tmp_path / "out", some_points(3), overwrite=True, more={"report.json": b"{}"})
    names = sorted(p.name for p in (tmp_path / "out").iterdir())
    assert names == ["notes.txt", "points.ply", "report.json", "sparse", "transforms.json"]
    assert pycolmap.Reconstruction(tmp_path / "out" / "sparse" / "0").num_images() == 3
    assert len(json.loads((tmp_path / "out" / "transforms.json").read_text())["frames"]) == 3
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out", "photos"]


def test_what_fails_leaves_nothing(tmp_path, monkeypatch):
    field = light_field(tmp_path / "photos", [None] * 3)

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OutputError) as error:
        save_calibration(field, tmp_path / "out")
    assert error.value.code == "disk-full"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["photos"]


def test_a_file_in_the_way_and_a_skew_are_refused(tmp_path):
    field = light_field(tmp_path / "photos", [None] * 3)
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError) as error:
        save_calibration(field, tmp_path / "file", overwrite=True)
    assert error.value.code == "output-is-file"
    view = field.views[1]
    K = view.camera.K + np.array([[0, 0.5, 0], [0, 0, 0], [0, 0, 0]])
    skewed = replace(field, views=(view, replace(view, camera=replace(view.camera, K=K))))
    with pytest.raises(OutputError) as error:
        save_calibration(skewed, tmp_path / "out")
    assert error.value.code == "camera-skew" and not (tmp_path / "out").exists()


@settings(max_examples=200)
@given(st.lists(st.floats(-1, 1), min_size=4, max_size=4))
def test_quaternions_turn_as_their_matrices(q):
    w, x, y, z = q
    length = np.linalg.norm(q)
    if length < 1e-3:
        return
    w, x, y, z = np.array(q) / length
    R = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
    found = np.array(quaternion(R))
    assert abs(abs(found @ [w, x, y, z]) - 1) < 1e-12 and found[0] >= 0
