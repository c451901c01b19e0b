"""Formats that are told by names: where each photograph stands, and the cameras where names tell them."""

from __future__ import annotations

import shutil

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.capture import LightField, PhotoSet, open_any, open_photographs
from eigenfield.capture.readers.grid_names import find_grid_names, read_grid_names
from eigenfield.core.errors import OptionError
from eigenfield.core.open_options import OpenOptions
from support.named import CUBE, nodes, places, refused, write

# Stanford


@pytest.mark.parametrize("prefix", ["out", "jpg_out"])
@pytest.mark.parametrize("up", [True, False])
@pytest.mark.parametrize("left", [True, False])
def test_stanford_positions_are_right_and_up_whichever_way_the_grid_runs(tmp_path, prefix, up, left):
    """The names are made from camera centres, x right and y down: U is x, V is y."""
    truth = {}
    for row in range(3):
        for column in range(4):
            x, y = 500 + 9.3 * (-column if left else column) + 0.1 * row, -700 + 9.1 * (-row if up else row)
            truth[f"{prefix}_{row:02d}_{column:02d}_{y:.6f}_{x:.6f}.png"] = (round(x, 6), -round(y, 6), row, column)
    photo_set = open_any(write(tmp_path, list(truth)))
    assert isinstance(photo_set, PhotoSet) and photo_set.format == "stanford" and len(photo_set) == 12
    layout = photo_set.layout
    assert layout.measured and layout.signs and layout.rectified and not layout.exact and layout.focal is None
    assert places(photo_set) == {name: pytest.approx(value[:2]) for name, value in truth.items()}
    assert nodes(photo_set) == {name: value[2:] for name, value in truth.items()}


def test_stanford_without_positions_and_with_gaps_in_the_numbers(tmp_path):
    names = [f"out_{r:02d}_{c:02d}.jpg" for r in (2, 6, 10) for c in (0, 4, 8, 12) if (r, c) != (6, 8)]
    photo_set = open_any(write(tmp_path / "images", names).parent)
    layout = photo_set.layout
    assert layout.shape == (3, 4) and layout.missing_nodes == [(6, 8)] and not layout.measured and not layout.signs
    assert photo_set.problems == ("1 node of the grid has no photograph: row 6 column 8",)
    assert places(photo_set)["out_10_04.jpg"] == (4, -10)
    assert layout.subset([0]).shape == (1, 1)


def test_one_row_and_one_column(tmp_path):
    row = open_any(write(tmp_path / "row", [f"out_00_{c:02d}.png" for c in range(5)]))
    column = open_any(write(tmp_path / "column", [f"out_{r:02d}_03_{-2.5 * r:.3f}_7.000.png" for r in range(5)]))
    assert row.layout.shape == (1, 5) and column.layout.shape == (5, 1) and column.layout.measured


def test_positions_that_do_not_follow_the_grid_are_refused(tmp_path):
    names = [f"out_{r:02d}_{c:02d}_{9.0 * c:.2f}_{8.0 * r:.2f}.png" for r in range(3) for c in range(3)]
    folder = write(tmp_path, names)
    assert "V" in str(refused("grid-positions", folder))
    names = [f"out_{r:02d}_{c:02d}_{9.0 * r:.2f}_{8.0 * r:.2f}.png" for r in range(3) for c in range(3)]
    refused("grid-positions", write(tmp_path / "other", names))


def test_some_names_without_positions_are_said(tmp_path):
    names = [f"out_{r:02d}_{c:02d}_{9.0 * r:.2f}_{8.0 * c:.2f}.png" for r in range(2) for c in range(3)]
    names[4] = "out_01_01.png"
    photo_set = open_any(write(tmp_path, names))
    assert not photo_set.layout.measured and "1 of 6 names hold no position" in photo_set.problems[0]


def test_two_photographs_on_one_node(tmp_path):
    names = [f"out_{r:02d}_{c:02d}.png" for r in range(2) for c in range(3)]
    error = refused("node-twice", write(tmp_path, [*names, "out_1_1.jpg"]))
    assert "out_1_1.jpg" in str(error) and "out_01_01.png" in str(error)


# parallel cameras in names


@pytest.mark.parametrize(("width", "height"), [(48, 32), (32, 48)])
def test_parallel_cameras_in_names_see_a_cube(tmp_path, width, height):
    truth = {}
    for row in (1, 4, 7):
        for column in (2, 5):
            x, y = 90.0 - 30 * column, 50.0 - 20 * row  # millimetres, right and down: columns run left, rows up
            truth[f"Original Camera_{row:02d}_{column:02d}_{y:.6f}_{x:.6f}_30_36.jpg"] = (x / 1000, y / 1000)
    light_field = open_any(write(tmp_path, list(truth), width=width, height=height))
    assert isinstance(light_field, LightField) and light_field.format == "positions"
    f = 30 / 36 * 48  # on the longer side
    for view, row in zip(light_field.views, light_field.layout.rows, strict=True):
        x, y = truth[view.name]
        expected = f * (CUBE[:, :2] - [x, y]) / CUBE[:, 2:] + [width / 2, height / 2]
        assert np.allclose(view.camera.project(CUBE)[0], expected) and f"_{row:02d}_" in view.name
    layout = light_field.layout
    assert layout.exact and layout.signs and layout.measured and layout.rectified is False and layout.shape == (3, 2)
    assert np.allclose(layout.positions, [(truth[n][0], -truth[n][1]) for n in light_field.names])
    assert np.isclose(layout.focal, f)
    assert open_photographs(tmp_path).layout.focal == pytest.approx(f)


def test_a_lens_that_cannot_be(tmp_path):
    names = [f"c_00_{c:02d}_0.0_{c:.1f}_{0 if c == 1 else 30}_36.png" for c in range(3)]
    assert "c_00_01" in str(refused("names-lens", write(tmp_path, names)))


# grid names, numbered frames


@pytest.mark.parametrize("form", ["{r:02d}_{c:02d}.png", "scene 2_{r}_{c}.png", "my_view-3_{r:03d}_{c:03d}_rgb.png"])
def test_grid_names(tmp_path, form):
    names = {form.format(r=r, c=c): (r, c) for r in range(1, 4) for c in range(4)}
    photo_set = open_any(write(tmp_path, list(names)))
    assert photo_set.format == "grid" and nodes(photo_set) == names
    layout = photo_set.layout
    assert (layout.measured, layout.signs, layout.rectified, layout.exact) == (False, False, None, False)


GRID_FORMS = [
    "x{c}_y{r}", "row{r}_col{c}", "r{r:02d}c{c:02d}", "{r}-{c}", "{r} {c}", "{r} - {c}", "{r}, {c}", "{r}x{c}",
    "Row {r} Column {c}", "scene (x={c}, y={r})", "scene 7 u{c} v{r} final", "col_{c:03d}-row_{r:03d}",
    "IMG-Y{r}-X{c}_1", "s{c}t{r}", "view_y-{r}_x-{c}", "max {r} {c}", "take2_x{c}y{r}", "C{c:02d}R{r:02d}",
]  # fmt: skip


@pytest.mark.parametrize("form", GRID_FORMS)
def test_grid_names_as_people_write_them(tmp_path, form):
    names = {form.format(r=r, c=c) + ".png": (r, c) for r in range(1, 4) for c in range(4)}
    photo_set = open_any(write(tmp_path, list(names)))
    assert photo_set.format == "grid" and nodes(photo_set) == names and photo_set.layout.shape == (3, 4)
    assert not photo_set.problems
    assert open_any(tmp_path, grid=(3, 4), format="grid").layout.shape == (3, 4)
    refused("grid-size", tmp_path, grid=(4, 3))


@settings(max_examples=200)
@given(st.data())
def test_any_words_and_separators_give_the_same_grid(tmp_path_factory, data):
    """Names made of a head, two words or none, separators, numbers with or without leading zeros, and a tail."""
    pick = lambda *values: data.draw(st.sampled_from(values))  # noqa: E731
    row_word, column_word = pick(("row", "col"), ("r", "c"), ("y", "x"), ("v", "u"), ("Row", "Column"), ("", ""))
    after, between = pick("", "_", " ") if row_word else "", pick("_", "-", " ", ", ", " - ")
    head, tail, digits = pick("", "scan 12_", "Photo-"), pick("", "_rgb", " (copy)"), pick(1, 2, 3)
    column_first = bool(row_word) and data.draw(st.booleans())
    rows = data.draw(st.lists(st.integers(0, 30), min_size=2, max_size=4, unique=True))
    columns = data.draw(st.lists(st.integers(0, 30), min_size=2, max_size=4, unique=True))
    names = {}
    for r in rows:
        for c in columns:
            parts = [f"{row_word}{after}{r:0{digits}d}", f"{column_word}{after}{c:0{digits}d}"]
            names[f"{head}{between.join(parts[::-1] if column_first else parts)}{tail}.png"] = (r, c)
    folder = tmp_path_factory.mktemp("names")
    for name in names:
        (folder / name).touch()
    assert find_grid_names(folder) == folder
    read = read_grid_names(folder, OpenOptions())
    found = zip(read.layout.rows.tolist(), read.layout.columns.tolist(), strict=True)
    assert dict(zip([path.name for path in read.files], found, strict=True)) == names


@pytest.mark.parametrize(("pattern", "form"), [
    ("view_{row}_{col}.png", "view_{r}_{c}"),
    ("view_{row}_{col}", "view_{r}_{c}"),
    ("{col}of{row}*.png", "{c}of{r} take {c}"),
    ("*[{row}]({col}).PNG", "a.b[{r}]({c})"),
    ("cam{col}-{row}", "cam{c}-{r}"),
])  # fmt: skip
def test_a_pattern_says_row_and_column(tmp_path, pattern, form):
    names = {form.format(r=r, c=c) + ".png": (r, c) for r in (-1, 0, 1) for c in range(4)}
    write(tmp_path, [*names, "poster.png"])
    photo_set = open_any(tmp_path, format="grid", pattern=pattern)
    assert nodes(photo_set) == names
    assert photo_set.problems == ("1 photograph is not named like the rest and left out: poster.png",)
    assert nodes(open_photographs(tmp_path, pattern=pattern)) == names  # a pattern means a grid
    with pytest.raises(OptionError, match=r"^pattern means nothing"):
        open_any(tmp_path, format="folder", pattern=pattern)


@pytest.mark.parametrize("pattern", ["", "view.png", "{row}_{row}", "{row}", "{row}_{col}_{col}", "{ROW}_{COL}"])
def test_patterns_that_are_none(tmp_path, pattern):
    with pytest.raises(OptionError) as caught:
        open_any(write(tmp_path, ["0_0.png"]), pattern=pattern)
    assert caught.value.code == "pattern-unknown"


def test_a_pattern_that_no_name_fits(tmp_path):
    folder = write(tmp_path, [f"a{i}_{j}.png" for i in range(3) for j in range(3)])
    assert "b{row}_{col}" in str(refused("names-unknown", folder, pattern="b{row}_{col}"))


@pytest.mark.parametrize("names", [
    [f"x{i}.png" for i in range(6)],
    [f"s1e{i:02d}.png" for i in range(6)],
    [f"r{i}_x{i}.png" for i in range(6)],  # words of two kinds
    [f"2021-04-{i:02d} 08.png" for i in range(6)],
    [f"x{1920 + i}_y{1080 + j}.png" for i in range(3) for j in range(3)],  # pixels, not nodes
])  # fmt: skip
def test_words_and_separators_that_are_no_grid(tmp_path, names):
    assert open_any(write(tmp_path, names)).layout is None


@pytest.mark.parametrize("names", [
    [f"IMG_20210430_0{i}0617.png" for i in range(6)],
    [f"2021-04-30_08.06.{i}7.png" for i in range(6)],
    [f"walk_{i}_{i * i}.png" for i in range(1, 7)],  # a diagonal: far from filled
    [f"DSC_{i:04d}.png" for i in range(6)],
    ["a.png", "b.png", "c.png"],
])  # fmt: skip
def test_names_that_are_no_grid(tmp_path, names):
    photo_set = open_any(write(tmp_path, names))
    assert photo_set.format == "folder" and photo_set.layout is None


def test_numbered_frames(tmp_path):
    folder = write(tmp_path, [f"f{i}.png" for i in range(8, 20)])
    photo_set = open_any(folder, grid=(3, 4))
    assert photo_set.format == "numbered" and photo_set.names[:3] == ("f8.png", "f9.png", "f10.png")
    assert nodes(photo_set)["f8.png"] == (0, 0) and nodes(photo_set)["f13.png"] == (1, 1)
    error = refused("grid-size", folder, grid=(3, 5))
    assert "12 photographs" in str(error) and all(size in error.remedy for size in ("1x12", "2x6", "3x4", "4x3"))
    (folder / "f12.png").unlink()
    photo_set = open_any(folder, grid=(3, 4))
    assert photo_set.problems == ("1 node of the grid has no photograph: row 1 column 0",) and len(photo_set) == 11
    (folder / "f8.png").unlink()  # now nothing says where the grid begins
    refused("grid-size", folder, grid=(3, 4))
    refused("grid-missing", folder, format="numbered")
    shutil.copy(folder / "f9.png", folder / "f09.png")
    refused("node-twice", folder, grid=(3, 4))


def test_numbers_that_fill_a_square_are_a_hint_only(tmp_path):
    photo_set = open_any(write(tmp_path, [f"{i}.png" for i in range(25)]))
    assert photo_set.layout is None and photo_set.problems == (
        "numbered from 0 to 24: if they are a grid, say --grid 5x5",
    )


# real captures


def tracks(light_field: LightField | PhotoSet, first: int, second: int) -> np.ndarray:
    """(n, 2) motion in pixels of points found in both directions."""
    a, b = (np.rint(light_field.photograph(i).pixels * 255).astype(np.uint8) for i in (first, second))
    a, b = (cv2.cvtColor(p, cv2.COLOR_RGB2GRAY) for p in (a, b))
    points = cv2.goodFeaturesToTrack(a, 1500, 0.01, 5)
    found, _, _ = cv2.calcOpticalFlowPyrLK(a, b, points, None)
    back, _, _ = cv2.calcOpticalFlowPyrLK(b, a, found, None)
    good = np.linalg.norm(back - points, axis=-1)[:, 0] < 0.1
    return (found - points)[good, 0]


def test_the_disparities_of_hci_boxes_are_those_of_its_cfg(data):
    light_field = open_any(data / "hci_boxes_9x9")
    assert isinstance(light_field, LightField) and len(light_field) == 81
    near, far = light_field.views[0].bounds
    centre, right, below = (light_field.cameras[i] for i in (40, 41, 49))
    for depth, disparity in ((near, 1.4), (far, -2.2)):
        point = [[0.01, -0.02, depth]]
        assert np.allclose(right.project(point)[0] - centre.project(point)[0], [[-disparity, 0]])
        assert np.allclose(below.project(point)[0] - centre.project(point)[0], [[0, -disparity]])
    for other, axis in ((41, 0), (49, 1)):
        moved = tracks(light_field, 40, other)
        assert len(moved) > 300 and np.median(np.abs(moved[:, 1 - axis])) < 0.05
        low, high = np.percentile(-moved[:, axis], [2, 98])
        assert -2.4 < low < -1.2 and 0.8 < high < 1.6


def test_the_cameras_of_shop_agree_with_its_photographs(data):
    """Points move right by a column and down by a row, all of them, and as far both ways."""
    light_field = open_any(data / "shop_9x9")
    assert isinstance(light_field, LightField) and light_field.layout.shape == (9, 9)
    index = {node: i for i, node in enumerate(
        zip(light_field.layout.rows.tolist(), light_field.layout.columns.tolist(), strict=True))}  # fmt: skip
    point = [[0.0, 0.0, 6.0]]
    start = light_field.cameras[index[13, 13]].project(point)[0]
    for node, axis in (((13, 16), 0), ((16, 13), 1)):
        expected = (light_field.cameras[index[node]].project(point)[0] - start)[0]
        moved = tracks(light_field, index[13, 13], index[node])
        assert expected[axis] > 1 and abs(expected[1 - axis]) < 1e-9
        assert np.percentile(moved[:, axis], 5) > 1 and np.median(np.abs(moved[:, 1 - axis])) < 0.1


def test_jelly_beans_positions_agree_with_the_photographs(data):
    """+U is right and +V down: all parallax has one sign, that of the names (the zero plane lies at the front)."""
    photo_set = open_any(data / "jellybeans_17x17_768x384")
    assert photo_set.layout.measured and photo_set.layout.signs
    index = {node: i for i, node in enumerate(
        zip(photo_set.layout.rows.tolist(), photo_set.layout.columns.tolist(), strict=True))}  # fmt: skip
    for node, axis in (((8, 10), 0), ((10, 8), 1)):
        step = photo_set.layout.positions[index[node]] - photo_set.layout.positions[index[8, 8]]
        far = np.percentile(tracks(photo_set, index[8, 8], index[node])[:, axis] * [1, -1][axis], [5, 95])
        assert abs(step[axis]) > 15 and abs(step[1 - axis]) < 3
        assert far[np.argmax(np.abs(far))] * step[axis] > 0  # far points move with the camera


REAL = {
    "amethyst_17x17_512": ("stanford", (17, 17), False, False),
    "jellybeans_17x17_768x384": ("stanford", (17, 17), True, True),
    "tarot_17x17_512": ("stanford", (17, 17), False, False),
    "tarot_5x4_1024": ("stanford", (4, 5), False, False),
    "hci_antinous_9x9": ("hci", (9, 9), False, True),
    "temple_ring16/images": ("folder", None, None, None),
}


@pytest.mark.parametrize("name", list(REAL))
def test_what_real_photographs_say_of_themselves(data, name):
    expected, shape, is_measured, signs = REAL[name]
    photo_set = open_any(data / name)
    assert isinstance(photo_set, PhotoSet) and photo_set.format == expected
    layout = photo_set.layout
    assert (layout is None) == (shape is None)
    if layout is not None:
        assert (layout.shape, layout.measured, layout.signs, layout.missing_nodes) == (shape, is_measured, signs, [])
        assert len(photo_set) == shape[0] * shape[1]
    if name == "tarot_5x4_1024":
        assert sorted(set(layout.rows)) == [2, 6, 10, 14] and sorted(set(layout.columns)) == [0, 4, 8, 12, 16]


def test_frames_of_the_rig(data):
    photo_set = open_any(data / "caliscope_charuco_rig4", format="video", frame="4s")
    assert isinstance(photo_set, PhotoSet) and photo_set.format == "video"
    assert photo_set.names == ("cam_0.png", "cam_1.png", "cam_2.png", "cam_3.png")
    by_index = open_any(data / "caliscope_charuco_rig4", format="video", frame=24)  # 6 frames a second
    for index in range(4):
        pixels = photo_set.photograph(index).pixels
        assert pixels.shape == (720, 1280, 3) and np.array_equal(pixels, by_index.photograph(index).pixels)
    assert "48 frames" in str(refused("video-short", data / "caliscope_charuco_rig4", frame=48))


def test_other_formats_of_real_captures(data):
    said = {name: open_any(data / name).format for name in
            ("cube_colmap_mesh", "fox_transforms_half", "fountain_P11_half", "temple_ring16", "llff_fern")}  # fmt: skip
    assert list(said.values()) == ["colmap", "transforms", "strecha", "middlebury", "llff"]
