"""All views in one file: quilts, lenslet pictures, arrays of MATLAB and HDF5."""

from __future__ import annotations

import json
import shutil

import h5py
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image
from scipy.io import savemat

from eigenfield.capture import open_any, open_capture, open_photographs
from eigenfield.capture.readers import array5d
from eigenfield.core.errors import CaptureError
from support.light_fields import (
    HEIGHT,
    WIDTH,
    light_field,
    shaded,
    write_eslf,
    write_matlab_73,
    write_old_hci,
    write_quilt,
    write_toolbox,
)
from support.named import nodes, picture, refused, write


def codes(opened, index: int) -> np.ndarray:
    return np.rint(opened.photograph(index).pixels * 255).astype(np.uint8)


def grid_of(opened, rows: int, columns: int) -> np.ndarray:
    return np.stack([codes(opened, i) for i in range(len(opened))]).reshape(rows, columns, *opened.sizes[0][::-1], 3)


# quilts


@pytest.mark.parametrize("name", ["q_qs4x3a1.3333.png", "q_QS4x3.png", "film 2_qs4x3a1.33.webp"])
def test_a_quilt_is_a_row_of_views_from_the_bottom_left(tmp_path, name):
    views = light_field(1, 12)[0]
    path = tmp_path / name
    write_quilt(tmp_path / "q.png", views, 4)
    with Image.open(tmp_path / "q.png") as whole:
        whole.save(path, lossless=True)
    opened = open_any(path)
    assert opened.format == "quilt" and opened.root == path and opened.problems == ()
    assert nodes(opened) == {f"view_{number:04d}.png": (0, number) for number in range(12)}
    assert opened.layout.shape == (1, 12) and opened.layout.rectified and not opened.layout.signs
    np.testing.assert_array_equal(grid_of(opened, 1, 12)[0], views)


def test_a_quilt_in_a_folder_or_a_zip_and_with_other_names(tmp_path):
    views = light_field(1, 6)[0]
    (tmp_path / "in").mkdir()
    write_quilt(tmp_path / "in/q_qs3x2.png", views, 3)
    shutil.make_archive(str(tmp_path / "packed"), "zip", tmp_path / "in")
    for path in (tmp_path / "in", tmp_path / "packed.zip"):
        opened = open_any(path)
        assert opened.format == "quilt" and len(opened) == 6
        np.testing.assert_array_equal(grid_of(opened, 1, 6)[0], views)
    other = shutil.copy(tmp_path / "in/q_qs3x2.png", tmp_path / "holiday.png")
    np.testing.assert_array_equal(grid_of(open_any(other, quilt=(3, 2)), 1, 6)[0], views)
    assert len(open_any(tmp_path / "in/q_qs3x2.png", quilt=(1, 6))) == 6  # what is asked for goes before the name
    assert "quilt=(COLUMNS, ROWS)" in str(refused("calibration-unknown", other))
    assert "quilt=(COLUMNS, ROWS)" in str(refused("quilt-missing", other, format="quilt"))
    refused("quilt-unused", write(tmp_path / "p", ["a_0_0.png", "a_0_1.png", "a_1_0.png", "a_1_1.png"]), quilt=(3, 2))
    refused("calibration-missing", tmp_path / "in", open_capture)


def test_tiles_are_stretched_to_what_is_shown(tmp_path):
    """Of 32x24 pixels: the shorter side becomes longer, none is shortened; a pixel more or less is rounding."""
    views = light_field(1, 6)[0]
    for aspect, size in (("2", (48, 24)), ("0.5", (32, 64)), ("1.37", (32, 24))):
        path = write_quilt(tmp_path / f"q_qs3x2a{aspect}.png", views, 3)
        opened = open_any(path)
        assert set(opened.sizes) == {size}
        shrunk = np.asarray(Image.fromarray(codes(opened, 4)).resize((32, 24), Image.Resampling.BOX), float)
        assert np.abs(shrunk - views[4]).mean() < 4


def test_what_is_left_over_in_a_texture_is_no_part_of_a_view(tmp_path):
    """64x128 pixels as 3x5 tiles of 21x25: one column at the right and three rows at the top are left over."""
    views = light_field(1, 15, 25, 21)[0]
    tiles = np.asarray(Image.open(write_quilt(tmp_path / "inner.png", views, 3)))
    whole = np.full((128, 64, 3), 255, np.uint8)
    whole[3:, :63] = tiles
    Image.fromarray(whole).save(tmp_path / "q_qs3x5.png")
    np.testing.assert_array_equal(grid_of(open_any(tmp_path / "q_qs3x5.png"), 1, 15)[0], views)


def test_what_is_no_quilt(tmp_path):
    def named(name, width, height):
        picture(1, width, height).save(tmp_path / name)
        return tmp_path / name

    assert "100x96" in str(refused("quilt-size", named("a_qs8x6a1.png", 100, 96)))
    for name in ("one_qs1x1a1.png", "two_qs2x1a1.png"):
        assert "too few" in str(refused("quilt-size", named(name, 96, 96)))
    refused("quilt-size", named("thin_qs8x6a9.png", 96, 96))
    refused("quilt-size", named("flat_qs3x2a0.01.png", 96, 96))
    refused("quilt-size", named("few_qs99x99.png", 64, 64))  # less than a pixel for each
    refused("quilt", tmp_path / "a_qs8x6a1.png", quilt=(0, 6))
    refused("calibration-unknown", named("a_qs0x6a1.png", 96, 96))
    refused("calibration-unknown", named("a_qs8x6a1_copy.png", 96, 96))
    same = Image.new("RGB", (96, 96), "grey")
    same.save(tmp_path / "same_qs4x4a1.png")
    refused("photographs-same", tmp_path / "same_qs4x4a1.png")
    whole = (tmp_path / "thin_qs8x6a9.png").read_bytes()
    (tmp_path / "cut_qs8x6a1.png").write_bytes(whole[: len(whole) // 2])
    refused("image-truncated", tmp_path / "cut_qs8x6a1.png")


def test_alpha_of_a_quilt_is_a_mask_and_16_bit_stay(tmp_path):
    import cv2

    views = light_field(1, 6)[0]
    alpha = np.full((*views.shape[:3], 1), 255, np.uint8)
    alpha[:, :, :5] = 0
    path = write_quilt(tmp_path / "a_qs3x2.png", np.concatenate([views, alpha], axis=3), 3)
    mask = open_any(path).photograph(2).mask
    assert not mask[:, :5].any() and mask[:, 5:].all()
    deep = (np.arange(40 * 60).reshape(40, 60, 1) * 27 + [0, 1, 2]).astype(np.uint16)
    cv2.imwrite(str(tmp_path / "d_qs3x2.png"), deep[..., ::-1])
    pixels = open_any(tmp_path / "d_qs3x2.png").photograph(1).pixels
    np.testing.assert_array_equal(np.rint(pixels * 65535), deep[20:, 20:40])


def test_views_are_unpacked_once_into_the_work_folder(tmp_path):
    path = write_quilt(tmp_path / "q_qs3x2.png", light_field(1, 6)[0], 3)
    first = open_photographs(path, work=tmp_path / "work")
    before = first.shots[0].path.stat().st_mtime_ns
    again = open_photographs(path, work=tmp_path / "work")
    assert again.shots[0].path == first.shots[0].path and again.shots[0].path.stat().st_mtime_ns == before
    other = open_photographs(path, work=tmp_path / "work", quilt=(6, 1))
    assert other.shots[0].path != first.shots[0].path and other.sizes[0] == (WIDTH // 2, 2 * HEIGHT)


def test_inspect_names_a_quilt_and_hands_its_shape_on(tmp_path, run):
    path = write_quilt(tmp_path / "photo.png", light_field(1, 6, 96, 128, 3)[0], 3)
    code, out, err = run("inspect", path, "--quilt", "3x2")
    assert code == 0 and "6 photographs without cameras from quilt" in out, err
    assert "grid of 1 row x 6 columns" in out or "1 rows x 6 columns" in out
    report = json.loads(run("inspect", path, "--quilt", "3x2", "--json").out)
    assert report["next"][0] == f"eigenfield encode {path} --quilt 3x2 -o scene.glb"
    assert report["root"] == str(path) and report["refused"] is None
    code, _, err = run("inspect", path, "--quilt", "3")
    assert code == 2 and "COLUMNSxROWS" in err and err.count("\n") == 1


# lenslet pictures


@pytest.mark.parametrize(("block", "kept"), [(14, 8), (15, 9)])
def test_the_middle_views_of_a_lenslet_picture_are_taken(tmp_path, block, kept):
    views = light_field(block, block)
    path = write_eslf(tmp_path / "flowers_plants_1_eslf.png", shaded(views, kept))
    opened = open_any(path)
    assert opened.format == "eslf" and opened.layout.rectified and opened.layout.shape == (kept, kept)
    assert f"of {block}x{block} views the middle {kept}x{kept} are used" in opened.problems[0]
    first = (block - kept) // 2
    np.testing.assert_array_equal(grid_of(opened, kept, kept), views[first : first + kept, first : first + kept])
    assert open_any(path, grid=(5, 7)).layout.shape == (5, 7)
    refused("grid-size", path, grid=(block + 1, 3))


def test_lenslet_pictures_of_even_light_are_taken_whole_and_others_refused(tmp_path):
    path = write_eslf(tmp_path / "even_eslf.png", light_field(14, 14))
    opened = open_any(path)
    assert opened.layout.shape == (14, 14) and opened.problems == ()
    picture(1, 101, 99).save(tmp_path / "cut_eslf.png")
    refused("eslf-size", tmp_path / "cut_eslf.png")
    shutil.copy(path, tmp_path / "other.png")
    assert open_any(tmp_path / "other.png", format="eslf").layout.shape == (14, 14)
    refused("names-unknown", write(tmp_path / "several", ["a.png", "b.png"]), format="eslf")


# arrays


@pytest.mark.parametrize(
    ("name", "make"),
    [
        ("a__Decoded.mat", write_toolbox),
        ("b.mat", write_matlab_73),
        ("lf.h5", write_old_hci),
        ("c.HDF5", write_old_hci),
    ],
)
def test_arrays_of_row_column_y_x_and_channel(tmp_path, name, make):
    views = light_field(5, 7)
    path = make(tmp_path / name, views)
    for one in (path, tmp_path):
        opened = open_any(one)
        assert opened.format == "array" and opened.layout.shape == (5, 7) and opened.layout.rectified
        assert nodes(opened)["view_02_06.png"] == (2, 6)
        np.testing.assert_array_equal(grid_of(opened, 5, 7), views)
    np.testing.assert_array_equal(grid_of(open_any(path, grid=(3, 3)), 3, 3), views[1:4, 2:5])


def test_values_of_arrays(tmp_path):
    views = light_field(3, 3)
    fine = np.linspace(0, 1, views.size).reshape(views.shape)
    savemat(tmp_path / "float.mat", {"lightfield": fine, "disparity": np.ones((3, 3))})
    opened = open_any(tmp_path / "float.mat")
    np.testing.assert_allclose(opened.photograph(4).pixels, fine[1, 1], atol=0.51 / 65535)
    with h5py.File(tmp_path / "half.h5", "w") as file:
        file["LF"] = fine.astype(np.float16)
    np.testing.assert_allclose(open_any(tmp_path / "half.h5").photograph(4).pixels, fine[1, 1], atol=1e-3)
    savemat(tmp_path / "grey.mat", {"LF": views[..., :1]})
    np.testing.assert_array_equal(codes(open_any(tmp_path / "grey.mat"), 8)[..., 2], views[2, 2, ..., 0])
    savemat(tmp_path / "both.mat", {"LF": views, "LF_small": views[:, :, ::2, ::2]})
    assert set(open_any(tmp_path / "both.mat").sizes) == {(WIDTH, HEIGHT)}


def test_what_is_no_array_of_views(tmp_path, monkeypatch):
    views = light_field(3, 3)

    def saved(name, **arrays):
        savemat(tmp_path / name, arrays)
        return tmp_path / name

    assert "no array" in str(refused("views-missing", saved("flat.mat", depth=np.ones((9, 9)))))
    assert "2 arrays" in str(refused("views-missing", saved("two.mat", a=views, b=views)))
    assert "24x32x3x3x3" in str(refused("views-missing", saved("turned.mat", LF=views.transpose(2, 3, 4, 0, 1))))
    refused("views-missing", saved("signed.mat", LF=views.astype(np.int32)))
    refused("views-missing", saved("wide.mat", LF=views.astype(np.uint64)))
    refused("views-missing", saved("text.mat", LF="views"))
    assert "not from 0 to 1" in str(refused("views-missing", saved("codes.mat", LF=views.astype(float))))
    holes = views / 255
    holes[1, 1, 2, 3] = np.nan
    assert "nan" in str(refused("views-missing", saved("holes.mat", LF=holes)))
    path = saved("large.mat", LF=views)
    monkeypatch.setattr(array5d, "ARRAY_MAX_BYTES", views.size - 1)
    refused("views-large", path)
    refused("views-large", write_old_hci(tmp_path / "large.h5", views))
    (tmp_path / "text.h5").write_text("no HDF5")
    refused("views-unreadable", tmp_path / "text.h5")


def test_a_file_that_claims_to_be_huge_is_refused_unread(tmp_path):
    with h5py.File(tmp_path / "lf.h5", "w") as file:
        file.create_dataset("LF", (60, 60, 9000, 9000, 3), np.uint8, chunks=(1, 1, 100, 100, 3))  # holds nothing
    refused("views-large", tmp_path / "lf.h5")


def test_without_h5py_a_line_says_what_to_install(tmp_path, monkeypatch):
    path = write_old_hci(tmp_path / "lf.h5", light_field(3, 3))
    monkeypatch.setattr(array5d, "is_installed", lambda module: False)
    assert "pip install 'eigenfield[arrays]'" in str(refused("extra-missing", path))
    assert open_any(write_toolbox(tmp_path / "a.mat", light_field(3, 3))).layout.shape == (3, 3)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("make", [write_toolbox, write_matlab_73, write_old_hci])
def test_damaged_arrays_are_read_or_refused(tmp_path_factory, make):
    folder = tmp_path_factory.mktemp("damaged")
    good = make(folder / ("a.h5" if make is write_old_hci else "a.mat"), light_field(3, 3, 16, 16))
    whole = good.read_bytes()

    @settings(max_examples=60, deadline=None, derandomize=True)
    @given(st.integers(0, len(whole) - 1), st.binary(min_size=1, max_size=4), st.booleans())
    def damage(at, new, cut):
        bad = folder / f"bad{good.suffix}"
        bad.write_bytes(whole[:at] if cut else whole[:at] + new + whole[at + len(new) :])
        try:
            open_any(bad)
        except CaptureError as error:
            assert "\n" not in str(error)

    damage()
