"""`eigenfield inspect`: figures, problems, JSON, and the overlay that shows a flipped axis."""

from __future__ import annotations

import io
import json
import re
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest
from jsonschema import Draft202012Validator
from PIL import Image

from eigenfield.capture import open_capture
from eigenfield.capture.overlay import draw_overlay, proxy_lines
from eigenfield.capture.survey import corners_and_centre, find_focus, measure_array
from eigenfield.cli.inspect_lines import report_lines
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError, OptionError, OutputError
from eigenfield.core.mesh import Mesh
from eigenfield.proxy import write_ply
from support import inspected
from support.captures import write_capture
from support.named import picture, write_video
from support.scenes import bumpy_square, row_grid

DOCUMENT = Path(__file__).parents[2] / "docs" / "capture-formats.md"


@pytest.fixture(scope="module")
def capture(tmp_path_factory) -> Path:
    return write_capture(tmp_path_factory.mktemp("inspect") / "my capture")


@pytest.fixture
def inspect(run):
    """What the verb says, and with which exit code; EigenfieldErrors come through. JSON keeps to the schema."""

    def said(*words, code=0):
        found, out, err = run("inspect", *words, "--traceback")
        assert found == code, err
        if "--json" in words:
            report = json.loads(out)
            assert inspected.violation(report) is None
            assert (report["refused"] is None) == (code == 0)
            assert bool(report["next"]) == (code == 0)
        else:
            assert ("  encode     would run" in out) == (code == 0)
            assert ("  encode     is refused: " in out) == (code == 2)
        return out

    return said


def test_words(capture, inspect):
    text = inspect(capture)
    assert "9 views from transforms" in text and "64x56 (9)" in text and "PNG 8 bit (9)" in text
    assert "grid of 3 rows x 3 columns" in text and "problems   none" in text


def test_json(capture, inspect):
    report = json.loads(inspect(capture, "--json"))
    assert report["schema"] == "eigenfield.inspect/1" and report["refused"] is None
    assert report["views"] == 9 and report["proxy"] is None and report["damaged"] == []
    assert report["bytes"] == sum(p.stat().st_size for p in (capture / "images").iterdir())
    array = report["array"]
    assert array["grid"] == {"rows": 3, "columns": 3} and not array["line"]
    assert np.isclose([array["width"], array["height"], array["spacing"]], [1, 1, 0.5]).all()
    assert np.allclose(report["cameras"][4]["centre"], [0, 0, -3]) and report["cameras"][0]["name"] == "view_00.png"


def test_what_the_capture_is_good_for(tmp_path, inspect):
    folder = write_capture(tmp_path / "c", row_grid(9, 320, 280))
    blurred = folder / "images" / "view_04.png"
    pixels = np.asarray(Image.open(blurred))
    Image.fromarray(cv2.GaussianBlur(pixels, (0, 0), 3)).save(blurred)
    report = json.loads(inspect(folder, "--json"))
    found = report["neighbours"]
    assert report["blurred"] == ["view_04.png"] and found["pairs"] >= 4 and found["parallax"] > 0
    assert found["parallax_limit"] == pytest.approx(0.03 * 320)
    assert found["exposure"] < 0.1 and 0.5 < found["overlap"] <= 1
    text = inspect(folder)
    assert re.search(r"  parallax   neighbours are [0-9.]+ px apart \(median\), [0-9.]+% of the longer side", text)
    assert report["verdict"]["word"] in ("good", "fair", "poor") and f"  verdict    {report['verdict']['says']}" in text
    assert "  harmful    view_04.png is blurred: " in text and "--leave-out advised -o scene.glb" in text
    far = {"widest": {"photographs": ["a", "b"], "parallax": 41.2}, "overlap": 0.5, "exposure": 0.8}
    lines = "\n".join(report_lines(report | {"neighbours": found | far}))
    assert "widest: 41.2 px, between a and b" in lines
    assert "50% of the same: too little" in lines and "0.80 stops: fix the exposure" in lines


def test_all_damaged_files_are_listed_together(tmp_path, inspect):
    folder = write_capture(tmp_path / "c")
    images = folder / "images"
    whole = (images / "view_03.png").read_bytes()
    (images / "view_03.png").write_bytes(whole[: len(whole) // 2])  # a header, half the pixels
    (images / "view_05.png").write_bytes(b"no picture")
    (images / "view_07.png").unlink()
    Image.new("RGB", (64, 41)).save(images / "view_08.png")
    Image.new("RGB", (64, 56)).save(images / "stranger.jpg")
    report = json.loads(inspect(folder, "--json", "--proxy", folder / "proxy.ply", code=2))
    problems = "\n".join(report["problems"])
    assert report["views"] == 6
    expected = (
        "view_03.png: is cut short", "view_05.png: is no PNG", "1 calibration entry has no photograph", "view_07",
        "view_08.png: is 64x41", "1 photograph has no calibration entry: stranger.jpg",
    )  # fmt: skip
    for words in expected:
        assert words in problems, words
    assert report["damaged"] == [
        {"file": str(images / "view_03.png"), "code": "image-truncated", "message": "is cut short"}
    ]
    with pytest.raises(CaptureError) as caught:
        open_capture(folder)
    assert report["refused"] == {
        "file": caught.value.path, "code": caught.value.code, "message": caught.value.message,
        "remedy": caught.value.remedy,
    }  # fmt: skip


def test_too_few_views_are_a_problem_here_and_not_an_error(tmp_path, inspect):
    folder = write_capture(tmp_path / "c", row_grid(2))
    text = inspect(folder, code=2)
    assert "2 photographs with a camera are too few" in text and "array" not in text
    assert json.loads(inspect(folder, "--json", code=2))["refused"]["code"] == "too-few"


def test_the_schema_is_one_and_the_document_names_its_keys():
    Draft202012Validator.check_schema(inspected.SCHEMA)
    text = DOCUMENT.read_text(encoding="utf-8")
    section = text[text.index("## `inspect --json`") :]
    assert inspected.PATH.name in section
    assert [key for key in inspected.keys() if f"`{key}`" not in section] == []  # noqa: SIM118


@pytest.mark.parametrize(
    ("key", "value"), [("views", -1), ("views", "9"), ("array", 3), ("refused", {"code": "a"}), ("more", 1)]
)
def test_a_report_that_breaks_the_schema_is_found(capture, inspect, key, value):
    report = json.loads(inspect(capture, "--json"))
    assert inspected.violation(report | {key: value}) is not None
    del report["views"]
    assert "views" in inspected.violation(report)


def test_what_cannot_be_decoded_is_refused_though_it_opens(tmp_path, run, inspect):
    folder = write_capture(tmp_path / "c")
    victim = folder / "images" / "view_03.png"
    victim.write_bytes(victim.read_bytes()[:-600])
    open_capture(folder)
    refused = json.loads(inspect(folder, "--json", code=2))["refused"]
    assert refused["code"] == "image-truncated" and refused["file"] == str(victim)
    code, _, err = run("encode", folder, "--proxy", folder / "proxy.ply", "-o", tmp_path / "a.glb", "--atlas", 64)
    assert code == 2 and f"{victim}: {refused['message']}" in err


def test_cameras_in_one_place_are_refused_where_no_mesh_is_given(tmp_path, run, inspect):
    """Before, `encode` ended with a traceback."""
    camera = row_grid(9)[4]
    turn = np.array([[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]])
    turned = Camera(camera.K, turn @ camera.R, -turn @ camera.R @ camera.centre, camera.width, camera.height)
    folder = write_capture(tmp_path / "c", [camera, turned, camera])
    assert json.loads(inspect(folder, "--json", code=2))["refused"]["code"] == "one-place"
    code, _, err = run("encode", folder, "-o", tmp_path / "a.glb")
    assert code == 2 and "in one place" in err.splitlines()[-1]
    inspect(folder, "--proxy", folder / "proxy.ply")


@pytest.mark.parametrize("name", ["a_{:02d}_{:02d}.png", "b{}{}.png", "IMG_{:02d}{:02d}.jpg"])
def test_photographs_without_cameras(tmp_path, inspect, name):
    for row in range(3):
        for column in range(3):
            noise = np.random.default_rng(3 * row + column).integers(0, 255, (20, 30, 3), np.uint8)
            Image.fromarray(noise).save(tmp_path / name.format(row, column))
    report = json.loads(inspect(tmp_path, "--json"))
    assert report["views"] == 0 and len(report["photographs"]) == 9
    assert (report["layout"] is not None) == (name == "a_{:02d}_{:02d}.png")
    (tmp_path / "odd.png").write_bytes(b"no picture")
    inspect(tmp_path, "--json", code=0 if report["layout"] else 2)


def test_masks_lenses_and_far_worlds_keep_to_the_schema(tmp_path, inspect):
    folder = write_capture(tmp_path / "c")
    document = json.loads((folder / "transforms.json").read_text())
    document |= {"k1": 0.1, "p1": 0.01}
    for frame in document["frames"]:
        frame["transform_matrix"][0][3] += 4e6
    (folder / "transforms.json").write_text(json.dumps(document))
    (folder / "masks").mkdir()
    for path in (folder / "images").iterdir():
        with Image.open(path) as picture:
            Image.new("L", picture.size, 255).save(folder / "masks" / path.name)
    report = json.loads(inspect(folder, "--json", "--masks", folder / "masks"))
    assert report["distorted"] == report["masks"] == 9 and report["origin"][0] > 3e6
    assert report["cameras"][0]["lens"]["model"] and report["cameras"][0]["mask"]


def test_overlay(capture, tmp_path, inspect):
    target, proxy = tmp_path / "over lay.png", tmp_path / "small.ply"
    mesh = bumpy_square()
    write_ply(Mesh(mesh.vertices * np.float32(0.5), mesh.faces, mesh.uv), proxy)  # inside every picture
    result = inspect(capture, "--proxy", proxy, "--overlay", target)
    assert f"next       eigenfield encode '{capture}' --proxy {proxy} -o scene.glb" in result
    assert "triangles, with UVs" in result and "view_04.png" in result
    with Image.open(target) as sheet:
        pixels = np.asarray(sheet).astype(int)
    magenta = (pixels == [255, 0, 191]).all(axis=-1)
    assert 500 < magenta.sum() < 0.1 * magenta.size
    with pytest.raises(OutputError) as caught:
        inspect(capture, "--proxy", proxy, "--overlay", target)
    assert caught.value.code == "output-exists"
    inspect(capture, "--proxy", proxy, "--overlay", target, "--overwrite")


def test_overlay_without_a_proxy_says_so(capture, tmp_path, inspect):
    with pytest.raises(OptionError, match="--proxy"):
        inspect(capture, "--overlay", tmp_path / "o.png")
    assert not (tmp_path / "o.png").exists()


def test_exit_code_and_one_line(tmp_path, run):
    code, out, err = run("inspect", tmp_path / "no where")
    assert code == 2 and out == ""
    assert err.count("\n") == 1 and "no where: does not exist" in err


def test_the_outline_is_where_the_mesh_ends():
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    mesh = Mesh(square, np.array([[0, 1, 2], [0, 2, 3]], np.int32))
    camera = Camera(np.array([[20.0, 0, 30], [0, 20, 25], [0, 0, 1]]), np.eye(3), np.array([0, 0, 2.0]), 60, 50)
    lines = proxy_lines(mesh, camera)
    rows, columns = np.nonzero(lines.outline)
    assert {rows.min(), rows.max(), columns.min(), columns.max()} == {14, 34, 19, 39}  # 10 pixels around (30, 25)
    assert not lines.outline[17:33, 22:38].any() and not lines.crease.any()
    assert lines.covered.sum() == 400


def test_creases_and_depth_edges_are_told_apart():
    camera = Camera(np.array([[160.0, 0, 128], [0, 160, 128], [0, 0, 1]]), np.eye(3), np.array([0, 0, 3.0]), 256, 256)
    roof = np.array([[-1, -1, 1], [0, -1, 0], [1, -1, 1], [-1, 1, 1], [0, 1, 0], [1, 1, 1]], np.float32)
    lines = proxy_lines(Mesh(roof, np.array([[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4]], np.int32)), camera)
    assert set(np.nonzero(lines.crease[128])[0]) == {127}  # the ridge, x = 128
    assert not lines.outline[128, 100:156].any()
    plane = bumpy_square(2).vertices * np.array([1, 1, 0], np.float32)
    faces = bumpy_square(2).faces
    card = plane * np.float32(0.4) - np.array(
        [0, 0, 1], np.float32
    )  # before the plane: 160 * 0.4 / 2 = 32 pixels about 128
    edges = proxy_lines(Mesh(np.concatenate([plane, card]), np.concatenate([faces, faces + 4])), camera)
    inner = edges.outline[90:166, 90:166]
    assert edges.covered[90:166, 90:166].all() and not edges.crease.any()
    rows, columns = np.nonzero(inner)
    assert {rows.min() + 90, columns.min() + 90} == {95} and {rows.max() + 90, columns.max() + 90} == {160}
    assert not edges.outline[98:158, 98:158].any()


def test_a_flipped_proxy_covers_another_part(capture):
    light_field = open_capture(capture)
    mesh = bumpy_square(12)
    _, straight = draw_overlay(light_field, mesh, [4])
    moved = Mesh(mesh.vertices * np.array([1, 1, -1], np.float32) - np.array([0, 0, 6], np.float32), mesh.faces)
    data, behind = draw_overlay(light_field, moved, [4])
    assert straight[0] > 0.3 and behind[0] == 0
    Image.open(io.BytesIO(data)).load()


def test_focus_and_corners():
    cameras = []
    target = np.array([1.0, -2.0, 7.0])
    for x, y in ((-1, -1), (1, -1), (0, 0), (-1, 1), (1, 1)):
        centre = np.array([x, y, 0.0])
        forward = (target - centre) / np.linalg.norm(target - centre)
        right = np.cross([0, 1.0, 0], forward)
        right /= np.linalg.norm(right)
        R = np.stack([right, np.cross(forward, right), forward])
        cameras.append(Camera(np.array([[50.0, 0, 16], [0, 50, 12], [0, 0, 1]]), R, -R @ centre, 32, 24))
    assert np.allclose(find_focus(cameras), target)
    array = measure_array(cameras)
    assert array.grid is None and array.cone is not None
    widest = max(
        np.degrees(np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b)))
        for a in (c.centre - target for c in cameras)
        for b in (c.centre - target for c in cameras)
    )
    assert np.isclose(array.cone, widest)
    parallel = row_grid(9)
    assert find_focus(parallel) is None and measure_array(parallel).cone is None
    assert corners_and_centre(parallel) == [0, 2, 4, 6, 8]  # y down: the first row is the top one


# real captures


def looked_over(inspect, folder, target, *words):
    """The report of a real capture, whose overlay is drawn."""
    report = json.loads(inspect(folder, *words, "--json", "--overlay", target, "--quiet"))
    assert report["damaged"] == [] and target.stat().st_size > 100_000
    return report


@pytest.mark.slow
def test_every_fourth_row_and_column_of_tarot(data, tmp_path, inspect):
    """They end where all of its 17x17 cameras do."""
    tarot, some = data / "tarot_17x17_512", tmp_path / "tarot"
    calibration = tarot / "calibration" / "refined.json"
    grid = measure_array(open_capture(tarot, calibration=calibration).cameras).grid
    assert grid is not None and (grid.rows, grid.columns) == (17, 17)
    (some / "images").mkdir(parents=True)
    document = json.loads(calibration.read_text())
    places = [f"out_{row:02}_{column:02}" for row in range(0, 17, 4) for column in range(0, 17, 4)]
    document["frames"] = [entry for entry in document["frames"] if Path(entry["file_path"]).stem in places]
    for entry in document["frames"]:
        shutil.copy(calibration.parent / entry["file_path"], some / "images")
        entry["file_path"] = f"images/{Path(entry['file_path']).name}"
    (some / "transforms.json").write_text(json.dumps(document))
    report = looked_over(inspect, some, tmp_path / "o.png", "--proxy", tarot / "calibration" / "proxy.ply")
    assert report["array"]["grid"] == {"rows": 5, "columns": 5} and report["views"] == 25
    assert min(report["proxy"]["coverage"].values()) > 0.999
    assert np.allclose(report["array"]["focus"], [0, 0, -1], atol=1e-3) and 26 < report["array"]["cone"] < 27


@pytest.mark.slow
def test_a_real_capture(data, tmp_path, inspect):
    cube = data / "cube_colmap_mesh"
    report = looked_over(inspect, cube, tmp_path / "o.png", "--proxy", cube / "proxy.obj")
    assert report["array"]["grid"] is None and min(report["proxy"]["coverage"].values()) > 0.85


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["fountain_P11_half", "fox_transforms_half", "hci_boxes_9x9", "llff_fern", "temple_ring16"]
)
def test_reports_of_real_captures_keep_to_the_schema(data, name, inspect):
    report = json.loads(inspect(data / name, "--json", "--quiet"))
    assert report["views"] or report["photographs"]


def test_what_is_done_is_no_problem(tmp_path, inspect):
    """The frame of videos with cameras, and sizes that differ by a pixel; the page is headed by the folder."""
    for camera in range(3):
        write_video(tmp_path / "rig" / f"cam_{camera}.mp4", 2, camera=camera)
    frames = [
        {"file_path": f"cam_{i}", "transform_matrix": [[1, 0, 0, 0.1 * i], *np.eye(4)[1:].tolist()]} for i in range(3)
    ]
    (tmp_path / "rig" / "transforms.json").write_text(json.dumps({"fl_x": 64, "w": 64, "h": 48, "frames": frames}))
    report = json.loads(inspect(tmp_path / "rig", "--json"))
    assert report["root"] == str(tmp_path / "rig") and not report["problems"]
    assert report["notes"] == ["frame 0 of each video is used; --frame names another"]
    assert "  lenses     no distortion is stated" in inspect(tmp_path / "rig")
    (tmp_path / "odd").mkdir()
    for number, width in enumerate((200, 201, 200, 200)):
        picture(number, width, 150).save(tmp_path / "odd" / f"{number}.png")
    report = json.loads(inspect(tmp_path / "odd", "--json"))
    assert report["notes"] == ["the photographs have 2 different sizes"] and not report["problems"]
