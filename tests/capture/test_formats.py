"""The table of formats: one claim wins, look-alikes are a question, and what is wrong with photographs is said."""

from __future__ import annotations

import json
import math
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

import eigenfield
from eigenfield.capture import (
    FORMATS,
    Lens,
    LightField,
    PhotoSet,
    open_any,
    open_capture,
    open_photographs,
    read_header,
)
from eigenfield.capture.photographs.exif import read_focal_length
from eigenfield.capture.photographs.kinds import VIDEO_EXTENSIONS
from eigenfield.capture.readers import colmap, transforms
from eigenfield.capture.readers.bundler import BUNDLER_LISTS
from eigenfield.capture.readers.grid_names import GRID_MAX_NODE_NUMBER, GRID_WORDS
from eigenfield.capture.readers.metashape import METASHAPE_LENS_MODELS, METASHAPE_PARAMETERS
from eigenfield.capture.readers.walk import WALK_MAX_FRAMES
from eigenfield.core.errors import CaptureError, EigenfieldError
from eigenfield.core.observations import select_cameras
from support import inspected
from support.captures import frame_of
from support.named import CFG, hci, refused, write, write_video
from support.scenes import row_grid

BULLETS = ["Written by", "Cameras", "Read", "Refused or left out, by name", "Traps"]
READ_IN_FULL = {  # what readers know by name, all of which docs/capture-formats.md lists
    "transforms": (
        *transforms.TRANSFORMS_PERSPECTIVE_MODELS, *transforms.TRANSFORMS_FISHEYE_MODELS,
        *transforms.TRANSFORMS_LENS_KEYS,
    ),
    "colmap": (*colmap.COLMAP_MODELS, *colmap.COLMAP_UNREAD_MODELS),
    "bundler": BUNDLER_LISTS,
    "metashape": (*METASHAPE_LENS_MODELS, *METASHAPE_PARAMETERS),
    "grid": (GRID_MAX_NODE_NUMBER, *(f"`{row}` `{column}`" for row, column in GRID_WORDS)),
    "video": VIDEO_EXTENSIONS,
    "walk": (WALK_MAX_FRAMES,),
}  # fmt: skip
GRID = [f"v_{r}_{c}.png" for r in range(3) for c in range(3)]


@pytest.fixture
def inspect(run):
    """What the verb finds, which keeps to the schema; EigenfieldErrors come through."""

    def found(*words):
        code, out, err = run("inspect", *words, "--json", "--traceback")
        report = json.loads(out)
        assert inspected.violation(report) is None
        assert code == (0 if report["refused"] is None else 2), err
        return report

    return found


# one claim


def test_every_row_is_documented_and_offered(run):
    assert len({row.name for row in FORMATS}) == len(FORMATS)
    page = Path(eigenfield.__file__).parents[2] / "docs" / "capture-formats.md"
    if page.exists():  # not in an installed package
        table, *sections = page.read_text("utf-8").split("\n## Formats\n\n")[1].split("\n\n## ")[0].split("\n### ")
        names = [row.name for row in FORMATS]
        assert re.findall(r"^\| \[`(\w+)`\]\(#\1\) \| .", table, re.MULTILINE) == names
        assert [section.split("\n")[0] for section in sections] == names
        for name, section in zip(names, sections, strict=True):
            assert re.findall(r"^- \*\*(.*?):\*\* .", section, re.MULTILINE) == BULLETS, name
            row = next(line for line in table.split("\n") if line.startswith(f"| [`{name}`]"))
            assert [word for word in READ_IN_FULL.get(name, ()) if str(word) not in section + row] == [], name
    words = " ".join(run("inspect", "--help").out.split())
    names = [row.name for row in FORMATS]
    assert f": {', '.join(names[:-1])} or {names[-1]}." in words
    assert all((row.read_cameras is None) != (row.read_names is None) for row in FORMATS)


def test_calibrations_go_before_names(tmp_path):
    """Names say a grid; a transforms.json says cameras."""
    folder = write(tmp_path / "images", GRID, width=48, height=40).parent
    frames = [frame_of(camera, f"images/{name}") for camera, name in zip(row_grid(9), GRID, strict=True)]
    (folder / "transforms.json").write_text(json.dumps({"frames": frames}))
    opened = open_any(folder)
    assert isinstance(opened, LightField) and opened.format == "transforms" and opened.layout is None
    assert open_any(folder, format="grid").format == "grid"
    photo_set = open_photographs(folder)
    assert isinstance(photo_set, PhotoSet) and photo_set.layout.shape == (3, 3)
    refused("grid-unused", folder, grid=(3, 3))
    refused("frame-unused", folder, frame=3)
    refused("format-cameras", folder, open_photographs, format="transforms")
    refused("format-cameras", folder, format="stanford", calibration=folder / "transforms.json")


def test_a_second_calibration_is_said_and_can_be_asked_for(tmp_path):
    names = [f"view_{i}.png" for i in range(9)]
    folder = write(tmp_path / "images", names, width=64, height=56).parent
    frames = [frame_of(camera, name) for camera, name in zip(row_grid(9, 64, 56), names, strict=True)]
    (folder / "transforms.json").write_text(json.dumps({"frames": frames}))
    lines = [f"{name} 50 0 32 0 50 28 0 0 1 1 0 0 0 1 0 0 0 1 {-0.5 * i} 0 3" for i, name in enumerate(names)]
    (folder / "toy_par.txt").write_text("\n".join([str(len(names)), *lines]))
    first = open_capture(folder)
    assert first.format == "transforms"
    assert first.problems == ("toy_par.txt is there too, not read; --format middlebury reads it",)
    second = open_capture(folder, format="middlebury")
    assert second.format == "middlebury" and np.allclose(second.cameras[2].centre, [1, 0, -3])
    by_file = open_capture(folder, calibration=folder / "toy_par.txt")
    assert by_file.format == "middlebury" and len(by_file) == 9
    (folder / "transforms.json").unlink()
    for name in names:
        (folder / f"{Path(name).stem}_P.txt").write_text("50 0 32 96\n0 50 28 84\n0 0 1 3\n")
    error = refused("format-ambiguous", folder)
    assert 'format="middlebury" or format="projections"' in error.remedy
    assert open_any(folder, format="projections").format == "projections"


@pytest.mark.parametrize("names", [
    [f"out_{r:02d}_{c:02d}.png" for r in range(2) for c in range(3)] + [f"input_Cam{i:03d}.png" for i in range(6)],
    [f"input_Cam{i:03d}.png" for i in range(4)] + [f"v_{r}_{c}.png" for r in range(2) for c in range(2)],
])  # fmt: skip
def test_two_kinds_of_names_in_one_folder_are_a_question(tmp_path, names):
    error = refused("format-ambiguous", write(tmp_path, names))
    assert 'format="hci"' in error.remedy and error.remedy.count("format=") == 2
    assert "row-major" in str(error) and "row, column" in str(error)
    assert open_any(tmp_path, format="hci", grid=(2, 3)).format == "hci"


def test_one_row_of_grid_names_is_a_question(tmp_path):
    folder = write(tmp_path, [f"cam_0_{i}.png" for i in range(5)])
    assert 'format="grid"' in refused("format-ambiguous", folder).remedy
    assert open_any(folder, format="grid").layout.shape == (1, 5)
    assert open_any(folder, format="folder").layout is None


def test_strangers_are_named_and_left_out(tmp_path):
    photo_set = open_any(write(tmp_path, [*GRID, "thumbnail.png"]))
    assert len(photo_set) == 9 and photo_set.format == "grid"
    assert photo_set.problems == ("1 photograph is not named like the rest and left out: thumbnail.png",)
    assert open_any(hci(tmp_path / "h") if write(tmp_path / "h", ["x.png"]) else tmp_path).problems == (
        "1 photograph has no calibration entry: x.png",
    )


def test_photographs_and_videos_in_one_folder(tmp_path):
    for name in ("a.mp4", "b.mp4", "c.mp4"):
        write_video(tmp_path / name, 2, camera=ord(name[0]) - 97)
    write(tmp_path, ["poster.png"])
    assert open_any(tmp_path).format == "video"
    write(tmp_path, ["poster.png", "p1x.png", "p2y.png"])
    assert 'format="video"' in refused("format-ambiguous", tmp_path).remedy
    assert open_any(tmp_path, format="folder").format == "folder"


# where photographs lie


def test_folders_with_nothing_or_too_much(tmp_path):
    assert "name a folder" in refused("photographs-missing", tmp_path).remedy
    write(tmp_path / "left", GRID)
    assert "left" in refused("photographs-missing", tmp_path).remedy
    write(tmp_path / "images", GRID)
    write(tmp_path, ["a.png", "b.png"])  # two pictures of the set-up
    assert len(open_any(tmp_path)) == 9
    write(tmp_path, ["c.png"])
    assert str(tmp_path / "images") in refused("photographs-twice", tmp_path).remedy
    refused("capture-missing", tmp_path / "nowhere")
    refused("calibration-unknown", tmp_path / "a.png")
    refused("names-unknown", tmp_path / "images", format="hci")
    refused("format-unknown", tmp_path, format="lytro")
    refused("too-few", write(tmp_path / "two", ["a.png", "b.png"]))


def test_no_cameras_names_what_to_run(tmp_path):
    folder = write(tmp_path, GRID)
    error = refused("calibration-missing", folder, open_capture)
    assert f"eigenfield calibrate {folder}" in error.remedy and f"eigenfield encode {folder}" in error.remedy


# what is wrong with photographs


def test_damaged_photographs_are_errors_or_named(tmp_path):
    folder = write(tmp_path, GRID)
    (folder / "v_1_1.png").write_bytes(b"no picture")
    (folder / "v_2_0.png").write_bytes(b"")
    error = refused("image-kind", folder)
    assert "v_1_1.png" in str(error)
    photo_set = open_any(folder, strict=False)
    assert len(photo_set) == 7 and photo_set.layout.missing_nodes == [(1, 1), (2, 0)]
    assert ["v_1_1.png" in p for p in photo_set.problems].count(True) == 1
    assert photo_set.layout.rows.tolist() == [int(name[2]) for name in photo_set.names]


def test_another_size_is_allowed_in_a_folder_and_refused_in_a_grid(tmp_path):
    folder = write(tmp_path, GRID)
    write(folder, ["v_0_2.png"], width=30, height=20)
    assert "v_0_2.png: is 30x20, but the rest of the grid is 24x16" in str(refused("image-size", folder))
    lenient = open_any(folder, strict=False)
    assert len(lenient) == 8 and "v_0_2.png" in "".join(lenient.problems)
    plain = open_any(folder, format="folder")
    assert [(s.width, s.height) for s in plain.shots].count((30, 20)) == 1 and len(plain) == 9


def test_copies_are_named(tmp_path):
    folder = write(tmp_path, GRID)
    for name in ("v_0_1.png", "v_2_2.png"):
        shutil.copy(folder / "v_0_0.png", folder / name)
    photo_set = open_any(folder)
    assert photo_set.problems == (
        "3 photographs are the same file, byte for byte: v_0_0.png, v_0_1.png, v_2_2.png",
    )  # fmt: skip


def test_masks_and_alpha(tmp_path):
    folder = write(tmp_path / "photographs", GRID)
    square = np.zeros((16, 24), np.uint8)
    square[4:12, 6:18] = 255
    (tmp_path / "masks").mkdir()
    for name in GRID[:-1]:
        Image.fromarray(square).save(tmp_path / "masks" / name)
    pixels = np.full((16, 24, 4), 200, np.uint8)
    pixels[..., 3] = 255 * (np.arange(24) < 12)
    Image.fromarray(pixels).save(folder / GRID[0])
    photo_set = open_any(folder, masks=tmp_path / "masks")
    assert photo_set.shots[1].mask == tmp_path / "masks" / GRID[1] and photo_set.shots[-1].mask is None
    assert photo_set.problems == (f"1 photograph has no mask in {tmp_path / 'masks'}: v_2_2.png",)
    assert np.array_equal(photo_set.photograph(1).mask, square / 255)
    assert np.array_equal(photo_set.photograph(0).mask, (square / 255) * (np.arange(24) < 12))
    assert photo_set.photograph(8).mask is None
    with Image.open(folder / GRID[1]) as image:
        assert np.array_equal(photo_set.photograph(1).pixels, np.asarray(image, np.float32) / 255)
    assert photo_set.subset([8, 1]).layout.rows.tolist() == [2, 0]
    assert photo_set.bytes(3) == (folder / GRID[3]).stat().st_size
    (tmp_path / "empty").mkdir()
    refused("masks-missing", folder, masks=tmp_path / "empty")
    Image.fromarray(square[:8]).save(tmp_path / "masks" / GRID[1])
    with pytest.raises(CaptureError, match="24x8"):
        photo_set.photograph(1)


def test_masks_fit_frames_of_videos(tmp_path):
    for index in range(3):
        write_video(tmp_path / "rig" / f"cam{index}.mp4", 3, camera=index)
    (tmp_path / "masks").mkdir()
    for index in range(3):
        Image.new("L", (64, 48), 255 if index else 0).save(tmp_path / "masks" / f"cam{index}.png")
    photo_set = open_any(tmp_path / "rig", masks=tmp_path / "masks", frame=1)
    assert photo_set.photograph(0).mask.max() == 0 and photo_set.photograph(1).mask is None


def test_a_photograph_that_changed_since_is_said(tmp_path):
    photo_set = open_any(write(tmp_path, GRID))
    write(tmp_path, GRID[:1], width=8, height=8)
    with pytest.raises(CaptureError, match="was 24x16") as caught:
        photo_set.photograph(0)
    assert caught.value.code == "image-size"
    (tmp_path / GRID[1]).unlink()
    with pytest.raises(CaptureError):
        photo_set.bytes(1)


def test_cameras_join_photographs(tmp_path):
    photo_set = open_any(write(tmp_path, GRID, width=48, height=40))
    light_field = photo_set.with_cameras(row_grid(9), problems=["estimated"])
    assert isinstance(light_field, LightField) and light_field.layout is photo_set.layout
    assert light_field.names == photo_set.names and light_field.problems[-1] == "estimated"
    assert np.array_equal(light_field.photograph(4).pixels, photo_set.photograph(4).pixels)
    assert photo_set.light_field is None and light_field.light_field is light_field
    assert light_field.sizes == photo_set.sizes == [(48, 40)] * 9
    paths = [[(one.path, one.mask, one.upright, one.lens) for one in capture.sources] for capture in
             (light_field, photo_set)]  # fmt: skip
    assert paths[0] == paths[1]


def test_each_photograph_is_an_observation_at_one_time(tmp_path):
    photo_set = open_any(write(tmp_path, GRID, width=48, height=40))
    for capture in (photo_set, photo_set.with_cameras(row_grid(9))):
        assert [(capture.camera_of(i), capture.time_of(i)) for i in range(len(capture))] == [(i, 0) for i in range(9)]
        some, part = select_cameras(capture, [7, 2]), capture.subset([7, 2])
        assert len(some) == len(part) == 2
        for index in range(2):
            assert (some.camera_of(index), some.time_of(index)) == (index, 0)
            assert np.array_equal(some.photograph(index).pixels, part.photograph(index).pixels)


def test_other_cameras_for_a_light_field(tmp_path):
    cameras, lens = row_grid(9), Lens("brown", (0.1, 0.0, 0.0, 0.0, 0.0))
    photo_set = open_any(write(tmp_path, GRID, width=48, height=40))
    given = photo_set.with_cameras(cameras, [lens] * 9)
    turned = given.with_cameras(cameras[::-1], problems=["turned"])
    assert turned.cameras == cameras[::-1] and turned.problems[-1] == "turned"
    assert [view.lens for view in turned.views] == [lens] * 9 and turned.names == given.names
    assert [view.lens for view in given.with_cameras(cameras, [None] * 9).views] == [None] * 9


# EXIF


def photograph(path: Path, tags: dict, orientation: int | None = None, size=(120, 80)) -> Path:
    exif = Image.Exif()
    exif.get_ifd(0x8769).update(tags)
    if orientation:
        exif[0x0112] = orientation
    Image.new("RGB", size, (int("".join(filter(str.isdigit, path.stem))) % 13 * 20, 60, 90)).save(path, exif=exif)
    return path


FOCAL, FOCAL_35MM, PLANE_X, PLANE_UNIT, PIXELS_X = 0x920A, 0xA405, 0xA20E, 0xA210, 0xA002


@pytest.mark.parametrize(("tags", "expected"), [
    ({FOCAL_35MM: 36}, 120.0),  # 36 mm wide: as long as wide
    ({FOCAL_35MM: 28, FOCAL: 4.0, PLANE_X: 9999.0}, 120 * 28 / 36),
    ({FOCAL: 10.0, PLANE_X: 254.0}, 100.0),  # inches, where nothing says
    ({FOCAL: 10.0, PLANE_X: 100.0, PLANE_UNIT: 3}, 100.0),
    ({FOCAL: 10.0, PLANE_X: 100.0, PLANE_UNIT: 3, PIXELS_X: 240}, 50.0),  # since made half as large
    ({FOCAL: 10.0}, None),
    ({}, None),
    ({FOCAL_35MM: 0}, None),
    ({FOCAL_35MM: 60000}, None),
    ({FOCAL: 10.0, PLANE_X: 0.0}, None),
])  # fmt: skip
def test_focal_lengths_from_exif(tmp_path, tags, expected):
    for suffix in (".jpg", ".webp"):
        path = photograph(tmp_path / f"a1{suffix}", tags)
        focal = read_focal_length(path, read_header(path))
        assert focal == (None if expected is None else pytest.approx(expected, rel=1e-4)), suffix


def test_orientation_turns_sizes_and_leaves_focal_lengths(tmp_path):
    for index in range(4):
        photograph(tmp_path / f"p{index}.jpg", {FOCAL_35MM: 36}, orientation=6)
    photo_set = open_any(tmp_path)
    shot = photo_set.shots[0]
    assert (shot.width, shot.height) == (80, 120) and math.isclose(shot.focal, 120)
    assert photo_set.photograph(0).pixels.shape == (120, 80, 3)


def test_the_focal_length_of_a_grid_is_one_or_none(tmp_path):
    for name in ("a_0_0", "a_0_1", "a_1_0", "a_1_1"):
        photograph(tmp_path / f"{name}.jpg", {FOCAL_35MM: 36}, size=(120, 80))
    assert math.isclose(open_any(tmp_path).layout.focal, 120)
    photograph(tmp_path / "a_1_1.jpg", {FOCAL_35MM: 50})
    assert open_any(tmp_path).layout.focal is None
    photograph(tmp_path / "a_1_1.jpg", {})
    assert open_any(tmp_path).layout.focal is None


@pytest.mark.filterwarnings("ignore::UserWarning")  # Pillow's, of EXIF that is cut short
@settings(max_examples=150)
@given(st.integers(0, 400), st.binary(min_size=1, max_size=8))
def test_damaged_exif_is_no_focal_length_or_one(tmp_path_factory, at, change):
    path = tmp_path_factory.getbasetemp() / "exif1.jpg"
    tags = {FOCAL: 10.0, PLANE_X: 100.0, PLANE_UNIT: 3, PIXELS_X: 240, FOCAL_35MM: 40}
    data = bytearray(photograph(path, tags).read_bytes())
    data[at : at + len(change)] = change
    path.write_bytes(data)
    try:
        header = read_header(path)
    except CaptureError:
        return
    focal = read_focal_length(path, header)
    assert focal is None or (math.isfinite(focal) and focal > 0)


# inspect


def test_inspect_of_photographs_without_cameras(tmp_path, inspect, run):
    names = [f"out_{r:02d}_{c:02d}_{-9.0 * r:.2f}_{8.0 * c:.2f}.png" for r in range(3) for c in range(4)][:-1]
    folder = write(tmp_path / "my photos", names)
    report = inspect(folder)
    assert report["schema"] == "eigenfield.inspect/1" and report["format"] == "stanford"
    assert report["views"] == 0 and report["cameras"] == [] and report["array"] is None and report["proxy"] is None
    assert report["layout"] == {"rows": 3, "columns": 4, "missing": [[2, 3]], "measured": True, "signs": True,
                                "rectified": True, "exact": False, "focal": None}  # fmt: skip
    assert report["sizes"] == [{"width": 24, "height": 16, "views": 11}] and report["damaged"] == []
    shot = report["photographs"][5]
    assert shot["name"] == names[5] and shot["node"] == [1, 1] and shot["position"] == [8, 9] and shot["focal"] is None
    assert report["next"] == [f"eigenfield encode '{folder}' -o scene.glb", f"eigenfield calibrate '{folder}'"]
    words = run("inspect", folder).out
    assert "11 photographs without cameras from stanford" in words and "3 rows x 4 columns" in words
    assert "measured" in words and "row 2 column 3" in words and "eigenfield calibrate" in words


def test_inspect_takes_the_options_and_hands_them_on(tmp_path, inspect):
    folder = write(tmp_path, [f"{i}.png" for i in range(12)])
    report = inspect(folder, "--grid", "3x4")
    assert report["format"] == "numbered" and report["layout"]["columns"] == 4
    assert report["next"][0].endswith(f"{folder} --grid 3x4 -o scene.glb")
    assert inspect(folder, "--format", "folder")["layout"] is None
    for words in (["--grid", "3"], ["--grid", "0x12"], ["--grid", "3x5"], ["--frame", "2"], ["--format", "x"]):
        with pytest.raises(EigenfieldError):
            inspect(folder, *words)


def test_inspect_decodes_photographs_without_cameras(tmp_path, inspect):
    folder = write(tmp_path, GRID)
    whole = (folder / GRID[4]).read_bytes()
    (folder / GRID[4]).write_bytes(whole[: len(whole) // 2])
    report = inspect(folder)
    assert [item["code"] for item in report["damaged"]] == [report["refused"]["code"]] == ["image-truncated"]
    assert any("v_1_1.png" in problem for problem in report["problems"])
    with pytest.raises(EigenfieldError, match="calibrate"):
        inspect(folder, "--proxy", "mesh.ply")


def test_inspect_of_cameras_from_names(tmp_path, inspect):
    report = inspect(hci(tmp_path, CFG))
    assert report["views"] == 9 and report["layout"]["exact"] and report["array"]["grid"] == {"rows": 3, "columns": 3}
    assert np.isclose(report["array"]["distance"], 1.25, rtol=1e-4) and report["photographs"] == []
    assert report["next"] == [f"eigenfield encode {tmp_path} -o scene.glb"]


NAMES = st.from_regex(r"[a-z]{0,3}[0-9]{0,3}[_.-]{0,2}[0-9]{0,4}(_-?[0-9]{1,3}\.[0-9])?", fullmatch=True).filter(
    lambda name: name and not name.startswith(".")
)


@settings(max_examples=150)
@given(
    st.lists(NAMES, min_size=1, max_size=9, unique=True),
    st.sampled_from([None, *[row.name for row in FORMATS]]),
    st.sampled_from([None, (1, 3), (2, 2), (3, 3)]),
)
def test_any_names_are_read_or_refused(tmp_path_factory, names, format, grid):
    """No names end in a traceback, and a layout always fits its photographs."""
    folder = tmp_path_factory.mktemp("any")
    for name in names:
        (folder / f"{name}.png").write_bytes(PNG)
    try:
        opened = open_any(folder, format=format, grid=grid)
    except EigenfieldError as error:
        assert "\n" not in str(error)
    else:
        assert len(opened) >= 3
        if opened.layout is not None:
            assert len(opened.layout.rows) == len(opened) == len(opened.layout.positions)
            assert np.isfinite(opened.layout.positions).all()
    finally:
        shutil.rmtree(folder)


def _png() -> bytes:
    import io

    buffer = io.BytesIO()
    Image.new("RGB", (2, 2)).save(buffer, "PNG")
    return buffer.getvalue()


PNG = _png()
