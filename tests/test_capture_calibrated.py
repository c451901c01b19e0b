"""Readers of calibrated captures: a cube projects where it must, damage is named, photographs agree with cameras."""

from __future__ import annotations

import contextlib
import itertools
import json
import re
import tempfile
from dataclasses import replace
from pathlib import Path

import calibrations as write
import cv2
import numpy as np
import pytest
from calibrations import CUBE, HEIGHT, NAMES, WIDTH, stations
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.capture import open_capture
from eigenfield.capture.bundler import find_bundler, read_bundler
from eigenfield.capture.filestorage import load_storage
from eigenfield.capture.lens import Lens, source_positions
from eigenfield.capture.llff import find_llff, read_llff
from eigenfield.capture.metashape import find_metashape, read_metashape
from eigenfield.capture.middlebury import find_middlebury, read_middlebury
from eigenfield.capture.opencv import find_opencv, read_opencv, read_opencv_intrinsics
from eigenfield.capture.projections import decompose, find_projections, read_projections
from eigenfield.capture.strecha import find_strecha, read_strecha
from eigenfield.errors import CaptureError

FINDERS = {
    "llff": find_llff,
    "middlebury": find_middlebury,
    "strecha": find_strecha,
    "bundler": find_bundler,
    "metashape": find_metashape,
    "opencv": find_opencv,
    "projections": find_projections,
}


def write_llff(folder):
    write.photographs(folder / "images")
    return write.llff(folder, stations(square=True, centred=True))


WRITERS = {
    "llff": (write_llff, read_llff),
    "middlebury": (lambda folder: write.middlebury(folder, stations()), read_middlebury),
    "strecha": (lambda folder: write.strecha(folder / "gt_dense_cameras", stations()), read_strecha),
    "bundler": (lambda folder: write.bundler(folder, stations(True, True)), read_bundler),
    "metashape": (lambda folder: write.metashape(folder, stations()), read_metashape),
    "opencv": (lambda folder: write.opencv_files(folder / "calib", stations()), read_opencv),
    "opencv-xml": (lambda folder: write.opencv_files(folder / "calib", stations(), kind="xml"), read_opencv),
    "easymocap": (lambda folder: write.easymocap(folder, stations()), read_opencv),
    "projections": (lambda folder: write.projections(folder, stations()), read_projections),
}
FORMATS = {"opencv-xml": "opencv", "easymocap": "opencv"}


def stem(entry) -> str:
    return Path(entry.file).name.removesuffix(".png")


def check_cube(calibration, truth, tolerance=1e-6):
    """Every entry sees the cube where the station of its name does, at the photographs' size."""
    assert calibration.errors == ()
    by_name = {s.name.removesuffix(".png"): s for s in truth}
    assert sorted(map(stem, calibration.entries)) == sorted(by_name)
    for entry in calibration.entries:
        width, height = entry.intrinsics.width or WIDTH, entry.intrinsics.height or HEIGHT
        camera = entry.camera(width, height, calibration.path)
        pixels, depth = camera.project(CUBE)
        assert (depth > 0).all()
        scale = WIDTH / width
        assert np.abs(pixels * scale - by_name[stem(entry)].pixels(CUBE)).max() < tolerance
        assert np.abs(camera.centre - by_name[stem(entry)].eye).max() < tolerance
        assert camera.K[0, 1] == 0


def check_lens(entry, pixels_of, tolerance=2e-4):
    """Rays through the centres of pinhole pixels, projected in the format's own words, land where the map says."""
    camera = entry.camera(WIDTH, HEIGHT, Path("x"))
    assert entry.lens is not None
    x, y, inside = source_positions(camera.K, entry.lens, WIDTH, HEIGHT)
    rows, columns = np.mgrid[2:HEIGHT:9, 1:WIDTH:11]
    rays = np.linalg.solve(camera.K, np.stack([columns + 0.5, rows + 0.5, np.ones_like(rows)]).reshape(3, -1))
    points = camera.centre + (7.0 * rays).T @ camera.R
    expected = pixels_of(points) - 0.5
    found = np.stack([x[rows, columns], y[rows, columns]], axis=-1).reshape(-1, 2)
    assert np.abs(found - expected).max() < tolerance
    assert inside[HEIGHT // 2, WIDTH // 2]


@pytest.mark.parametrize("name", list(WRITERS))
def test_a_cube_projects_where_it_must(tmp_path, name):
    writer, read = WRITERS[name]
    path = writer(tmp_path)
    assert FINDERS[FORMATS.get(name, name)](tmp_path) == path
    calibration = read(path)
    assert calibration.format == FORMATS.get(name, name)
    check_cube(calibration, stations(name in ("llff", "bundler"), name in ("llff", "bundler")))


@pytest.mark.parametrize("name", list(WRITERS))
def test_no_other_reader_claims_the_folder(tmp_path, name):
    WRITERS[name][0](tmp_path)
    claims = [key for key, find in FINDERS.items() if find(tmp_path) is not None]
    assert claims == [FORMATS.get(name, name)]


@pytest.mark.parametrize("find", FINDERS.values(), ids=FINDERS)
def test_nothing_is_found_where_nothing_is(tmp_path, find):
    assert find(tmp_path) is None
    assert find(tmp_path / "absent") is None
    (tmp_path / "notes.txt").write_text("1 2 3\n")
    (tmp_path / "log.out").write_text("hello\n")
    (tmp_path / "config.yml").write_text("a: 1\n")
    (tmp_path / "other.xml").write_text("<a/>\n")
    (tmp_path / "room_par.txt").write_text("carpet\n")
    (tmp_path / "readme_P.txt").write_text("see below\n")
    (tmp_path / "txt").mkdir()
    (tmp_path / "txt" / "a.txt").write_text("some words\n")
    assert find(tmp_path) is None


@pytest.mark.parametrize("name", list(WRITERS))
def test_a_missing_file_is_named(tmp_path, name):
    _, read = WRITERS[name]
    with pytest.raises(CaptureError) as error:
        read(tmp_path / "absent.yml")
    assert str(tmp_path) in str(error.value)
    assert error.value.remedy


@pytest.mark.parametrize("name", list(WRITERS))
@pytest.mark.parametrize("apart", [False, True])
def test_open_capture_pairs_it_with_photographs(tmp_path, name, apart):
    """As people call it: on the folder, or with --calibration and the photographs elsewhere."""
    square = name in ("llff", "bundler")
    path = WRITERS[name][0](tmp_path / "capture" if apart else tmp_path)
    write.photographs(tmp_path / "images")
    capture = open_capture(tmp_path, calibration=path) if apart else open_capture(tmp_path)
    assert capture.names == NAMES
    for view, s in zip(capture.views, stations(square, square), strict=True):
        assert (view.camera.width, view.camera.height) == (WIDTH, HEIGHT)
        assert np.abs(view.camera.project(CUBE)[0] - s.pixels(CUBE)).max() < 1e-6
        assert view.lens is None


# LLFF


def test_llff_keeps_bounds_and_full_size(tmp_path):
    calibration = read_llff(write_llff(tmp_path))
    assert [entry.file for entry in calibration.entries] == [f"images/{name}" for name in NAMES]
    assert calibration.entries[0].bounds == (2.0, 20.0)
    assert calibration.entries[0].intrinsics.width == 8 * WIDTH


@pytest.mark.parametrize(("dtype", "fortran"), [("<f4", False), (">f8", False), ("<f8", True)])
def test_llff_in_other_layouts(tmp_path, dtype, fortran):
    write.photographs(tmp_path / "images")
    path = write.llff(tmp_path, stations(True, True), dtype=dtype, fortran=fortran)
    check_cube(read_llff(path), stations(True, True), 1e-3 if dtype == "<f4" else 1e-6)


def test_llff_takes_the_folder_whose_count_fits(tmp_path):
    path = write.llff(tmp_path, stations(True, True))
    write.photographs(tmp_path / "images", (*NAMES, "e4.png"))
    with pytest.raises(CaptureError, match="5 in images") as error:
        read_llff(path)
    assert error.value.code == "calibration-count"
    write.photographs(tmp_path / "images_8")
    write.photographs(tmp_path / "images_16")
    assert read_llff(path).entries[1].file == "images_8/b1.png"
    write.photographs(tmp_path / "elsewhere")
    assert read_llff(path, tmp_path / "elsewhere").entries[1].file == "b1.png"


def test_llff_nan_pose_is_an_error_of_its_own(tmp_path):
    path = write_llff(tmp_path)
    data = bytearray(path.read_bytes())
    data[-17 * 8 : -16 * 8] = np.float64(np.nan).tobytes()
    path.write_bytes(data)
    calibration = read_llff(path)
    assert len(calibration.entries) == 3
    assert [error.code for error in calibration.errors] == ["camera-not-finite"]
    assert "row 3 (images/d3.png)" in str(calibration.errors[0])


def test_llff_refuses_pickles_and_claims_of_size(tmp_path):
    write.photographs(tmp_path / "images")
    path = tmp_path / "poses_bounds.npy"
    np.save(path, np.array([{"a": 1}], dtype=object), allow_pickle=True)
    with pytest.raises(CaptureError, match="floating-point"):
        read_llff(path)
    data = write_llff(tmp_path).read_bytes()
    path.write_bytes(data.replace(b"(4, 17)", b"(4000000000, 17)"))
    with pytest.raises(CaptureError) as error:
        read_llff(path)
    assert error.value.code == "calibration-damaged"


# Middlebury, Strecha, Bundler


def test_middlebury_count_must_agree(tmp_path):
    path = write.middlebury(tmp_path, stations())
    path.write_text(path.read_text().replace("4\n", "99999\n", 1))
    with pytest.raises(CaptureError, match="says 99999 cameras and lists 4"):
        read_middlebury(path)


def test_middlebury_bad_line_leaves_the_others(tmp_path):
    path = write.middlebury(tmp_path, stations())
    lines = path.read_text().split("\n")
    lines[2] = re.sub(r" \S+$", " nan", lines[2])
    lines[3] = " ".join(lines[3].split()[:-1])
    path.write_text("\n".join(lines))
    calibration = read_middlebury(path)
    assert [stem(entry) for entry in calibration.entries] == ["a0", "d3"]
    assert [error.code for error in calibration.errors] == ["camera-not-finite", "calibration-damaged"]


def test_text_in_utf16_and_with_old_line_ends(tmp_path):
    path = write.middlebury(tmp_path, stations())
    text = path.read_text()
    for data in (text.encode("utf-16"), text.encode("utf-8-sig"), text.replace("\n", "\r").encode()):
        path.write_bytes(data)
        check_cube(read_middlebury(path), stations())


def test_strecha_size_is_that_of_k(tmp_path):
    write.strecha(tmp_path / "full", stations(), scale=2)
    calibration = read_strecha(tmp_path / "full" / "a0.png.camera")
    assert calibration.entries[0].intrinsics.width == 2 * WIDTH
    check_cube(calibration, stations())


def test_strecha_usual_folder_goes_first(tmp_path):
    write.strecha(tmp_path / "a_full", stations(), scale=2)
    assert find_strecha(tmp_path) == tmp_path / "a_full"
    write.strecha(tmp_path / "gt_dense_cameras", stations())
    assert find_strecha(tmp_path) == tmp_path / "gt_dense_cameras"


def test_strecha_distortion_is_refused(tmp_path):
    path = write.strecha(tmp_path, stations()) / "b1.png.camera"
    path.write_text(path.read_text().replace("\n0 0 0 ", "\n0.1 0 0 ", 1))
    calibration = read_strecha(tmp_path)
    assert len(calibration.entries) == 3
    assert calibration.errors[0].code == "camera-model"
    assert str(path) in str(calibration.errors[0])


def test_bundler_lens(tmp_path):
    lens = write.BUNDLER_LENS
    calibration = read_bundler(write.bundler(tmp_path, stations(True, True), lens))
    for entry, station in zip(calibration.entries, stations(True, True), strict=True):
        assert entry.file == f"images/{station.name}"
        check_lens(entry, lambda points, s=station: write.bundler_pixels(s, lens, points))


def test_bundler_unregistered_cameras_are_named(tmp_path):
    calibration = read_bundler(write.bundler(tmp_path, stations(True, True), unregistered=(1,)))
    assert len(calibration.entries) == 3
    assert calibration.errors == ()
    assert calibration.problems == ("1 camera was not registered by Bundler: images/b1.png",)


def test_bundler_list_must_agree(tmp_path):
    path = write.bundler(tmp_path, stations(True, True))
    (tmp_path / "list.txt").write_text("a0.png\n")
    with pytest.raises(CaptureError) as error:
        read_bundler(path)
    assert error.value.code == "calibration-count"
    (tmp_path / "list.txt").unlink()
    assert find_bundler(tmp_path) is None
    with pytest.raises(CaptureError) as error:
        read_bundler(path)
    assert error.value.code == "bundler-list"


def test_bundler_as_colmap_exports_it(tmp_path):
    (tmp_path / "bundle").mkdir()
    path = write.bundler(tmp_path / "bundle", stations(True, True), list_name="my photos.list.txt")
    path = path.rename(path.with_name("my photos.bundle.out"))
    assert find_bundler(tmp_path) == path
    check_cube(read_bundler(path), stations(True, True))


def test_bundler_huge_count_costs_nothing(tmp_path):
    path = write.bundler(tmp_path, stations(True, True))
    path.write_text(path.read_text().replace("\n4 2\n", "\n90000000000 2\n"))
    with pytest.raises(CaptureError):
        read_bundler(path)
    path.write_text("# Bundle file v0.3\n4 2\n" + "7" * 100_000)
    with pytest.raises(CaptureError, match="characters"):
        read_bundler(path)


# Metashape


@pytest.mark.parametrize("kind", ["frame", "fisheye", "equidistant_fisheye", "equisolid_fisheye"])
@pytest.mark.parametrize("keys", [("k1", "k2", "k3", "p1", "p2", "b1"), tuple(write.METASHAPE_LENS), ("b1", "b2")])
def test_metashape_lens(tmp_path, kind, keys):
    lens = {key: write.METASHAPE_LENS[key] for key in keys}
    calibration = read_metashape(write.metashape(tmp_path, stations(), lens, kind))
    assert calibration.errors == ()
    for entry, station in zip(calibration.entries, stations(), strict=True):
        check_lens(entry, lambda points, s=station: write.metashape_pixels(s, lens, kind, points))


def test_metashape_lens_is_opencvs_where_it_can_be(tmp_path):
    lens = {key: write.METASHAPE_LENS[key] for key in ("k1", "k2", "k3", "p1", "p2")}
    entry = read_metashape(write.metashape(tmp_path, stations(), lens)).entries[0]
    assert entry.lens == Lens("brown", (-0.05, 0.03, -0.003, 0.002, -0.01))
    assert read_metashape(write.metashape(tmp_path, stations(), {"k1": 0.1}, "fisheye")).entries[0].lens == Lens(
        "fisheye", (0.1, 0.0, 0.0, 0.0)
    )


def test_metashape_transform_of_the_chunk_and_groups(tmp_path):
    check_cube(read_metashape(write.metashape(tmp_path, stations(), place="chunk")), stations())


def test_metashape_names_what_it_leaves_out(tmp_path):
    other = '<camera id="9" sensor_id="0" label="off" enabled="false"><transform>1</transform></camera>'
    calibration = read_metashape(write.metashape(tmp_path, stations(), extra=other))
    assert len(calibration.entries) == 4
    assert calibration.problems == ("1 camera is disabled: off", "1 camera is not aligned: lost")


def camera_xml(inside: str, **attributes) -> str:
    attributes = {"sensor_id": 0, "component_id": 0, "label": "z", **attributes}
    words = " ".join(f'{key}="{value}"' for key, value in attributes.items() if value is not None)
    return f'<camera id="9" {words}>{inside}</camera>'


@pytest.mark.parametrize(
    ("extra", "code"),
    [
        (camera_xml("<transform>1 2</transform>"), "calibration-damaged"),
        (camera_xml("<transform>1 2</transform>", label=None), "calibration-damaged"),
        (camera_xml("<transform>1 2</transform>", sensor_id=44), "calibration-damaged"),
        (camera_xml(f"<transform>{'nan ' * 16}</transform>"), "camera-not-finite"),
        (camera_xml("", master_id=0), "metashape-rig"),
    ],
)
def test_metashape_bad_camera_is_an_error_of_its_own(tmp_path, extra, code):
    calibration = read_metashape(write.metashape(tmp_path, stations(), extra=extra))
    assert len(calibration.entries) == 4
    assert [error.code for error in calibration.errors] == [code]


def test_metashape_component_without_a_frame_is_left_out(tmp_path):
    pose = " ".join(map(str, np.eye(4).ravel()))
    extra = f'<camera id="9" sensor_id="0" component_id="5" label="apart"><transform>{pose}</transform></camera>'
    calibration = read_metashape(write.metashape(tmp_path, stations(), extra=extra))
    check_cube(calibration, stations())
    assert any("another component" in line and "apart" in line for line in calibration.problems)


def test_metashape_georeferenced_cameras_come_to_the_origin(tmp_path):
    far = np.array([4_000_000.0, 500_000.0, 4_900_000.0])
    near = read_metashape(write.metashape(tmp_path, stations()))
    calibration = read_metashape(write.metashape(tmp_path, stations(), shift=write.SHIFT + far))
    offset = calibration.entries[0].centre - near.entries[0].centre
    assert np.abs(calibration.entries[0].centre).max() < 20
    for one, other in zip(calibration.entries, near.entries, strict=True):
        assert np.abs(one.centre - other.centre - offset).max() < 1e-6
    assert "georeferenced" in calibration.problems[-1]
    moved = [int(v) for v in re.search(r"\((-\d+), (-\d+), (-\d+)\)", calibration.problems[-1]).groups()]
    assert np.abs(far + moved - offset).max() < 1e-6


def test_photoscan_before_1_2(tmp_path):
    """Both focal lengths, the centre from the corner, p1 and p2 as OpenCV's."""
    path = write.metashape(tmp_path, stations())
    old = (
        "<fx>91</fx><fy>90</fy><cx>50</cx><cy>31</cy><skew>0</skew><k1>-0.05</k1><k2>0.02</k2><k3>0</k3>"
        "<p1>0.003</p1><p2>-0.002</p2>"
    )
    path.write_text(re.sub(r"<f>9\S*?</b1>", old, path.read_text()))
    calibration = read_metashape(path)
    assert calibration.entries[0].intrinsics.focal == (91, 90)
    assert calibration.entries[0].intrinsics.principal == (50, 31)
    assert calibration.entries[0].lens == Lens("brown", (-0.05, 0.02, 0.003, -0.002, 0.0))


LAUGHS = '<!DOCTYPE a [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;"><!ENTITY c "&b;&b;&b;&b;">]>'
FETCH = '<!DOCTYPE a SYSTEM "file:///etc/passwd">'


@pytest.mark.parametrize("doctype", [LAUGHS, FETCH, "<!DOCTYPE a>"])
def test_xml_with_a_document_type_is_refused(tmp_path, doctype):
    path = write.metashape(tmp_path, stations())
    path.write_text(path.read_text().replace("<document", f"{doctype}<document", 1).replace("lost", "&c;"))
    with pytest.raises(CaptureError) as error:
        read_metashape(path)
    assert error.value.code == "xml-doctype"
    storage = write.opencv_files(tmp_path / "calib", stations(), kind="xml") / "a0.xml"
    storage.write_text(storage.read_text().replace("<opencv", f"{doctype}<opencv", 1))
    with pytest.raises(CaptureError) as error:
        load_storage(storage)
    assert error.value.code == "xml-doctype"


def test_xml_nested_without_end_is_refused(tmp_path):
    path = tmp_path / "cameras.xml"
    path.write_text("<document><chunk>" + "<a>" * 100_000)
    with pytest.raises(CaptureError) as error:
        read_metashape(path)
    assert error.value.code == "calibration-damaged"


def test_files_that_are_too_large_are_not_read(tmp_path):
    for name, read in (("cameras.xml", read_metashape), ("a.yml", load_storage), ("poses_bounds.npy", read_llff)):
        with (tmp_path / name).open("wb") as file:
            file.truncate(2**40)  # sparse
        with pytest.raises(CaptureError) as error:
            read(tmp_path / name)
        assert error.value.code == "calibration-too-large"


# OpenCV


@pytest.mark.parametrize("count", list(write.OPENCV_LENSES))
@pytest.mark.parametrize("kind", ["yml", "xml"])
def test_opencv_lens(tmp_path, count, kind):
    """Against cv2.projectPoints, whose pixel centres are whole numbers."""
    lens = write.OPENCV_LENSES[count]
    calibration = read_opencv(write.opencv_files(tmp_path, stations(), lens, kind))
    for entry, station in zip(calibration.entries, stations(), strict=True):
        K, _, R, t = write.opencv_numbers(station, lens)

        def pixels(points, K=K, R=R, t=t):
            return (
                cv2.projectPoints(points, cv2.Rodrigues(np.array(R))[0], t, np.array(K), np.array(lens))[0][:, 0] + 0.5
            )

        check_lens(entry, pixels)


def test_opencv_half_a_pixel(tmp_path):
    path = write.opencv_files(tmp_path, stations()) / "a0.yml"
    ((name, (intrinsics, lens)),) = read_opencv_intrinsics(path).items()
    station = stations()[0]
    assert (name, lens) == ("", None)
    assert intrinsics.principal == (station.cx, station.cy)
    assert (intrinsics.width, intrinsics.height) == (WIDTH, HEIGHT)


def test_ros_camera_info(tmp_path):
    """YAML without OpenCV's head and tags."""
    path = tmp_path / "camera.yaml"
    path.write_text(
        "image_width: 640\nimage_height: 480\ncamera_name: narrow_stereo\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
        "  data: [500, 0, 319.5, 0, 501, 239.5, 0, 0, 1]\ndistortion_model: plumb_bob\ndistortion_coefficients:\n"
        "  rows: 1\n  cols: 5\n  data: [-0.1, 0.01, 0.001, 0, 0]\nrectification_matrix:\n  rows: 3\n  cols: 3\n"
        "  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
    )
    ((intrinsics, lens),) = read_opencv_intrinsics(path).values()
    assert (intrinsics.width, intrinsics.focal, intrinsics.principal) == (640, (500, 501), (320, 240))
    assert lens == Lens("brown", (-0.1, 0.01, 0.001, 0, 0))


def test_opencv_fisheye_by_its_flag(tmp_path):
    path = write.opencv_files(tmp_path, stations(), write.OPENCV_LENSES[4]) / "a0.yml"
    path.write_text(path.read_text() + "fisheye_model: 1\n")
    assert read_opencv_intrinsics(path)[""][1] == Lens("fisheye", write.OPENCV_LENSES[4])
    path.write_text(path.read_text().replace("fisheye_model: 1", "distortion_model: kaleidoscope"))
    with pytest.raises(CaptureError) as error:
        read_opencv_intrinsics(path)
    assert error.value.code == "camera-model"


def test_opencv_cameras_as_mappings(tmp_path):
    """A mapping a camera, by name, as list items, and as flow lists."""
    one, two, three, four = stations()
    body = "%YAML:1.0\n---\n"
    for s in (one, two):
        K, D, R, T = write.opencv_numbers(s, (0.0,) * 5)
        parts = [("camera_matrix", K), ("distortion_coefficients", D), ("R", R), ("T", T)]
        body += f"{s.name[:-4]}:\n" + "".join(write.yaml_matrix(key, value, "   ") for key, value in parts)
    body += "cameras:\n"
    for s in (three, four):
        K, _, R, T = write.opencv_numbers(s, (0.0,) * 5)
        body += f'   -\n      name: "{s.name}"\n      K: {np.array(K).tolist()}\n'
        body += f"      rvec: {write.axis_angle(R).ravel().tolist()}\n      tvec: {T.ravel().tolist()}\n"
    path = tmp_path / "rig.yml"
    path.write_text(body)
    assert find_opencv(tmp_path) == path
    check_cube(read_opencv(path), stations())


def test_opencv_json(tmp_path):
    cameras = {}
    for s in stations():
        K, _, R, T = write.opencv_numbers(s, (0.0,) * 5)
        matrix = {"type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d", "data": list(np.ravel(K))}
        extrinsic = np.hstack([np.array(R), T]).tolist()
        cameras[s.name[:-4]] = {"camera_matrix": matrix, "extrinsic_matrix": extrinsic}
    path = tmp_path / "rig.json"
    path.write_text(json.dumps(cameras))
    check_cube(read_opencv(path), stations())


def test_opencv_stereo_pair(tmp_path):
    """intrinsics.yml and extrinsics.yml of OpenCV's sample: R, T lead from the first camera to the second."""
    one, two = stations()[:2]
    (K1, D, R1, T1), (K2, _, R2, T2) = (write.opencv_numbers(s, (0.0,) * 5) for s in (one, two))
    R = np.array(R2) @ np.array(R1).T
    T = T2 - R @ T1
    parts = [("M1", K1), ("D1", D), ("M2", K2), ("D2", D)]
    (tmp_path / "intrinsics.yml").write_text("%YAML:1.0\n" + "".join(write.yaml_matrix(*part) for part in parts))
    parts = [("R", R), ("T", T), ("R1", np.eye(3)), ("R2", np.eye(3)), ("P1", np.eye(3, 4)), ("Q", np.eye(4))]
    (tmp_path / "extrinsics.yml").write_text("%YAML:1.0\n---\n" + "".join(write.yaml_matrix(*part) for part in parts))
    write.photographs(tmp_path, NAMES[:2])
    assert find_opencv(tmp_path) is None  # two cameras are no light field
    for name in ("intrinsics.yml", "extrinsics.yml"):
        first, second = read_opencv(tmp_path / name).entries
        assert (first.file, second.file) == NAMES[:2]
        cameras = [entry.camera(WIDTH, HEIGHT, tmp_path) for entry in (first, second)]
        points = one.along(CUBE)  # the first camera's frame is the world
        assert np.abs(cameras[0].project(points)[0] - one.pixels(CUBE)).max() < 1e-6
        assert np.abs(cameras[1].project(points)[0] - two.pixels(CUBE)).max() < 1e-6
    assert set(read_opencv_intrinsics(tmp_path / "intrinsics.yml")) == {"1", "2"}


def test_opencv_views_of_a_chart(tmp_path):
    K, D, _, _ = write.opencv_numbers(stations()[0], (0.0,) * 5)
    rows = []
    for s in stations():
        _, _, R, T = write.opencv_numbers(s, ())
        rows.append([*write.axis_angle(R).ravel(), *T.ravel()])
    parts = [("camera_matrix", K), ("distortion_coefficients", D), ("extrinsic_parameters", rows)]
    path = tmp_path / "left.yml"
    path.write_text("%YAML:1.0\n---\n" + "".join(write.yaml_matrix(*part) for part in parts))
    write.photographs(tmp_path)
    assert find_opencv(tmp_path) is None
    calibration = read_opencv(path)
    assert [entry.file for entry in calibration.entries] == list(NAMES)
    for entry, s in zip(calibration.entries, stations(), strict=True):
        assert np.abs(entry.centre - s.eye).max() < 1e-9


def test_opencv_intrinsics_only_is_no_calibration(tmp_path):
    path = tmp_path / "left.yml"
    path.write_text("%YAML:1.0\n" + write.yaml_matrix("camera_matrix", np.diag([90.0, 90, 1])))
    assert find_opencv(tmp_path) is None
    with pytest.raises(CaptureError, match="--intrinsics") as error:
        read_opencv(path)
    assert error.value.code == "opencv-poses"
    path.write_text("%YAML:1.0\na: 1\n")
    with pytest.raises(CaptureError) as error:
        read_opencv_intrinsics(path)
    assert error.value.code == "calibration-empty"


@pytest.mark.parametrize(
    "body",
    [
        "camera_matrix: !!opencv-matrix\n  rows: 1000000\n  cols: 1000000\n  dt: d\n  data: [ 1. ]\n",
        "camera_matrix: !!opencv-matrix\n  rows: -3\n  cols: 3\n  dt: d\n  data: [ 1. ]\n",
        "camera_matrix: !!opencv-matrix\n  rows: .Nan\n  cols: 3\n  dt: d\n  data: [ 1. ]\n",
        "camera_matrix: [ 1, 2",
        "a: ]",
        "a: 1\n   b: 2\n c: 3\n",
        "- 1\n- 2\n",
        "a: " + "[" * 1000 + "]" * 1000,
        "\n".join(" " * i + "a:" for i in range(1000)),
        'a: "no end\n',
        "",
        "\0\0\0",
    ],
)
def test_opencv_damaged_storage_is_named(tmp_path, body):
    path = tmp_path / "a.yml"
    path.write_text("%YAML:1.0\n" + body)
    with pytest.raises(CaptureError) as error:
        load_storage(path)
    assert error.value.code == "calibration-damaged"
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "line",
    ["a: " + " " * 2_000_000 + "x", '"' * 1_000_000, 'a: "' + '\\"' * 1_000_000, "a: [" + "[1]," * 200_000 + "]"],
)
def test_long_lines_take_no_more_than_their_length(tmp_path, line):
    path = tmp_path / "a.yml"
    path.write_text("%YAML:1.0\n" + line + "\n")
    with contextlib.suppress(CaptureError):
        load_storage(path)


def test_storage_reads_what_opencv_writes(tmp_path):
    matrix = np.arange(12.0).reshape(3, 4) / 7
    for suffix in ("yml", "xml", "json"):
        path = tmp_path / f"a.{suffix}"
        storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
        storage.write("matrix", matrix)
        storage.write("points", np.arange(8, dtype=np.float32).reshape(2, 2, 2))
        storage.write("count", 3)
        storage.write("name", "a # b: c, [d]")
        storage.startWriteStruct("list", cv2.FileNode_SEQ)
        storage.write("", 1.5)
        storage.write("", np.eye(2))
        storage.endWriteStruct()
        storage.startWriteStruct("map", cv2.FileNode_MAP)
        storage.write("inner", matrix)
        storage.endWriteStruct()
        storage.release()
        tree = load_storage(path)
        assert np.array_equal(tree["matrix"], matrix)
        assert tree["points"].shape == (2, 2, 2)
        assert (tree["count"], tree["name"]) == (3.0, "a # b: c, [d]")
        assert tree["list"][0] == 1.5
        assert np.array_equal(tree["list"][1], np.eye(2))
        assert np.array_equal(tree["map"]["inner"], matrix)


# projection matrices


@pytest.mark.parametrize(("inner", "ending"), [("", ".P"), ("P", ".txt"), ("projections", "_P.txt"), ("txt", ".txt")])
def test_projections_under_their_names(tmp_path, inner, ending):
    path = write.projections(tmp_path / inner, stations(), ending)
    assert find_projections(tmp_path) == path
    check_cube(read_projections(path), stations())


def test_projections_of_pmvs_name_visualize(tmp_path):
    (tmp_path / "visualize").mkdir()
    path = write.projections(tmp_path / "txt", stations(), ".txt")
    assert read_projections(path).entries[0].file == "visualize/a0"


def test_projections_with_skew_are_straightened(tmp_path):
    skew = 2.0
    calibration = read_projections(write.projections(tmp_path, stations(), skew=skew))
    for entry, s in zip(calibration.entries, stations(), strict=True):

        def pixels(points, s=s):
            x, y, z = s.along(points).T
            return np.stack([(s.fx * x + skew * y) / z + s.cx, s.fy * y / z + s.cy], axis=1)

        check_lens(entry, pixels)
    calibration = read_projections(write.projections(tmp_path, stations(), skew=20.0))
    assert {error.code for error in calibration.errors} == {"camera-skew"}


def test_projections_singular(tmp_path):
    path = write.projections(tmp_path, stations())
    (path / "b1_P.txt").write_text("0 " * 12)
    (path / "c2_P.txt").write_text("1 0 0 0 0 1 0 0 0 0 0 1")  # an affine camera
    calibration = read_projections(path)
    assert len(calibration.entries) == 2
    assert [error.code for error in calibration.errors] == ["camera-singular"] * 2


@given(
    st.lists(st.floats(-3, 3), min_size=3, max_size=3),
    st.lists(st.floats(-50, 50), min_size=3, max_size=3),
    st.floats(10, 5000),
    st.floats(0.5, 2),
    st.sampled_from([1.0, -1.0, 1e-12, -1e9]),
)
@settings(max_examples=100, deadline=None)
def test_a_projection_comes_apart_as_it_was_made(turn, centre, focal, aspect, factor):
    R = cv2.Rodrigues(np.array(turn))[0]
    K = np.array([[focal, 0.3, 320.5], [0, focal * aspect, 200.25], [0, 0, 1]])
    P = factor * K @ R @ np.hstack([np.eye(3), -np.array(centre)[:, None]])
    K2, R2, centre2 = decompose(P, "x", Path("x"))
    assert np.allclose(K2, K, rtol=1e-8, atol=1e-6 * focal)
    assert np.allclose(R2, R, atol=1e-9)
    assert np.allclose(centre2, centre, atol=1e-7)


# damage


def survives(find, read, folder: Path, path: Path) -> None:
    """Finding never raises; reading, and what is done with the entries, raises nothing but CaptureError."""
    find(folder)
    try:
        calibration = read(path)
    except CaptureError as error:
        assert error.remedy
        assert "\n" not in str(error)
        return
    for error in calibration.errors:
        assert isinstance(error, CaptureError)
        assert "\n" not in str(error)
    for entry in calibration.entries:
        assert isinstance(entry.file, str)
        try:
            width, height = entry.intrinsics.width or WIDTH, entry.intrinsics.height or HEIGHT
            camera = entry.camera(width, height, path)
            if entry.lens is not None:
                source_positions(camera.K, entry.lens, 7, 5)
        except CaptureError:
            pass


VALUES = [
    b"nan",
    b"inf",
    b"-inf",
    b"1e308",
    b"-1e308",
    b"1e-320",
    b"0",
    b"-1",
    b"9" * 30,
    b"",
    b"x",
    b"\xff",
    b"\0",
    b"1_0",
]
EDITS = st.one_of(
    st.tuples(st.just("number"), st.integers(0, 10**6), st.sampled_from(VALUES)),
    st.tuples(st.just("bytes"), st.integers(0, 10**6), st.binary(min_size=1, max_size=6)),
    st.tuples(st.just("cut"), st.integers(0, 10**6), st.just(b"")),
    st.tuples(st.just("drop"), st.integers(0, 10**6), st.just(b"")),
    st.tuples(st.just("repeat"), st.integers(0, 10**6), st.just(b"")),
)
NUMBER = re.compile(rb"-?\d[\d.e+-]*")


def edited(data: bytes, edits) -> bytes:
    for kind, at, new in edits:
        if kind == "number":
            found = list(NUMBER.finditer(data))
            if found:
                match = found[at % len(found)]
                data = data[: match.start()] + new + data[match.end() :]
        elif data:
            at %= len(data)
            if kind == "bytes":
                data = data[:at] + new + data[at + len(new) :]
            elif kind == "cut":
                data = data[:at]
            elif kind == "drop":
                data = data[:at] + data[at + 5 :]
            else:
                data = data[:at] + data[at : at + 40] + data[at:]
    return data


@pytest.fixture(scope="module", params=list(WRITERS))
def written(request):
    """A folder of each format, its calibration, and the file that is damaged with its bytes."""
    writer, read = WRITERS[request.param]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = writer(folder)
        target = path if path.is_file() else sorted(p for p in path.iterdir() if p.is_file())[1]
        yield FINDERS[FORMATS.get(request.param, request.param)], read, folder, path, target, target.read_bytes()


@given(edits=st.lists(EDITS, min_size=1, max_size=4))
@settings(max_examples=120, deadline=None)
def test_damage_raises_nothing_but_capture_errors(written, edits):
    find, read, folder, path, target, data = written
    target.write_bytes(edited(data, edits))
    survives(find, read, folder, path)


@given(data=st.binary(max_size=300))
@settings(max_examples=40, deadline=None)
def test_garbage_raises_nothing_but_capture_errors(written, data):
    find, read, folder, path, target, _ = written
    target.write_bytes(data)
    survives(find, read, folder, path)


@given(text=st.text(alphabet="ab:[]{},-'\"#! \n\t1.%_", max_size=80))
@settings(max_examples=300, deadline=None)
def test_any_text_is_a_storage_or_an_error(text):
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "a.yml"
        path.write_text("%YAML:1.0\n---\n" + text)
        try:
            assert isinstance(load_storage(path), dict)
        except CaptureError as error:
            assert "\n" not in str(error)
        survives(find_opencv, read_opencv, Path(name), path)


# lenses


@pytest.mark.parametrize(
    ("lens", "expected"),
    [
        (Lens("brown", (-0.3, 0, 0, 0, 0)), np.sqrt(1 / 0.9)),
        (Lens("rational", (-0.3, 0, 0, 0, 0, 0, 0, 0)), np.sqrt(1 / 0.9)),
        (Lens("rational", (0, 0, 0, 0, 0, 1.0, 0, 0)), 1.0),  # s / (1 + s^2) grows up to 1
        (Lens("metashape", (-0.3, 0, 0, 0, 0, 0, 0, 0, 0)), np.sqrt(1 / 0.9)),
        (Lens("metashape", (0, 0, 0, -1 / 9, 0, 0, 0, 0, 0)), 1.0),
        (Lens("metashape-equidistant", (-0.3, 0, 0, 0, 0, 0, 0, 0, 0)), np.tan(np.sqrt(1 / 0.9))),
        (Lens("metashape-equisolid", (-0.5, 0, 0, 0, 0, 0, 0, 0, 0)), np.tan(2 * np.arcsin(np.sqrt(2 / 3) / 2))),
        (Lens("metashape", (0.1, 0, 0, 0, 0, 0, 0, 0, 0.01)), np.inf),
    ],
)  # fmt: skip
def test_where_a_lens_folds_back(lens, expected):
    assert lens.limit() == pytest.approx(expected)


def test_a_skew_alone_is_a_lens():
    assert not Lens("metashape", (*(0.0,) * 8, 0.01)).does_nothing
    assert Lens("metashape", (0.0,) * 9).does_nothing
    assert not Lens("metashape-equisolid", (0.0,) * 9).does_nothing


# real captures

REAL = {
    "llff_fern": (find_llff, read_llff, 20),
    "temple_ring16": (find_middlebury, read_middlebury, 16),
    "fountain_P11_half": (find_strecha, read_strecha, 11),
}
# neighbours on the array, and the median distance (pixels) from the epipolar line that their matches may have
NEIGHBOURS = {"llff_fern": (0, 5, 0.4), "temple_ring16": (5, 10, 0.3), "fountain_P11_half": (1, 5, 0.15)}


@pytest.mark.parametrize("name", list(REAL))
def test_real_captures_are_found_and_told_apart(data, name):
    find, read, count = REAL[name]
    path = find(data / name)
    assert path is not None
    calibration = read(path)
    assert (len(calibration.entries), calibration.errors, calibration.problems) == (count, (), ())
    assert [key for key, other in FINDERS.items() if other(data / name) is not None] == [calibration.format]


OTHERS = (
    "tarot_17x17_512", "hci_boxes_9x9", "shop_9x9", "cube_colmap_mesh", "fox_transforms_half", "opencv_stereo_chart",
    "caliscope_charuco_rig4", "jellybeans_17x17_768x384",
)  # fmt: skip


@pytest.mark.parametrize("name", OTHERS)
def test_other_real_captures_are_not_claimed(data, name):
    assert [key for key, find in FINDERS.items() if find(data / name) is not None] == []


def photograph_of(folder: Path, file: str) -> Path:
    return next(path for path in (folder / file, folder / "images" / file) if path.is_file())


def epipolar_distances(one, two, first, second):
    """Distances (pixels) of SIFT matches of two photographs from the epipolar lines of two cameras."""
    sift, matcher = cv2.SIFT_create(2000), cv2.BFMatcher()
    (points1, features1), (points2, features2) = (sift.detectAndCompute(p, None) for p in (first, second))
    pairs = [a for a, b in matcher.knnMatch(features1, features2, k=2) if a.distance < 0.7 * b.distance]
    half = np.array([0.5, 0.5, 0])
    x1 = np.array([(*points1[m.queryIdx].pt, 1) for m in pairs]) + half
    x2 = np.array([(*points2[m.trainIdx].pt, 1) for m in pairs]) + half
    R = two.R @ one.R.T
    a, b, c = two.t - R @ one.t
    F = np.linalg.inv(two.K).T @ np.array([[0, -c, b], [c, 0, -a], [-b, a, 0]]) @ R @ np.linalg.inv(one.K)
    lines = x1 @ F.T
    return np.abs((lines * x2).sum(axis=1)) / np.hypot(lines[:, 0], lines[:, 1])


@pytest.mark.slow
@pytest.mark.parametrize("name", list(REAL))
def test_real_photographs_agree_with_their_cameras(data, name):
    find, read, _ = REAL[name]
    first, last, limit = NEIGHBOURS[name]
    calibration = read(find(data / name))
    views = []
    for entry in calibration.entries[first : last + 1]:
        picture = cv2.imread(str(photograph_of(data / name, entry.file)), cv2.IMREAD_GRAYSCALE)
        height, width = picture.shape
        claimed = entry.intrinsics.width or width, entry.intrinsics.height or height
        camera = entry.camera(*claimed, calibration.path)
        K = np.diag([width / claimed[0], height / claimed[1], 1]) @ camera.K
        views.append((replace(camera, K=K, width=width, height=height), picture))
    distances = np.concatenate([epipolar_distances(one, two, a, b) for (one, a), (two, b) in itertools.pairwise(views)])
    assert len(distances) > 200
    assert np.median(distances) < limit
    assert (distances < 3).mean() > 0.85
    swapped = np.concatenate([epipolar_distances(two, one, a, b) for (one, a), (two, b) in itertools.pairwise(views)])
    assert np.median(swapped) > 5 * np.median(distances)  # the measure can tell a wrong camera


def test_fountain_keeps_the_scale_of_its_file(data):
    centres = np.array([entry.centre for entry in read_strecha(find_strecha(data / "fountain_P11_half")).entries])
    assert 10 < np.ptp(centres, axis=0).max() < 20


def test_the_stereo_chart_gives_intrinsics(data):
    folder = data / "opencv_stereo_chart"
    both = read_opencv_intrinsics(folder / "intrinsics.yml")
    assert both["1"][0].focal == pytest.approx((534.803, 534.803), abs=1e-3)
    assert both["2"][0].principal == pytest.approx((334.557 + 0.5, 242.053 + 0.5), abs=1e-3)
    ((intrinsics, lens),) = read_opencv_intrinsics(folder / "left_intrinsics.yml").values()
    assert (intrinsics.width, intrinsics.height) == (640, 480)
    assert lens is not None
    assert lens.coefficients[0] == pytest.approx(-0.26637, abs=1e-5)
    with pytest.raises(CaptureError) as error:  # 13 views of the left camera, but 26 photographs
        read_opencv(folder / "left_intrinsics.yml")
    assert error.value.code == "calibration-count"
