"""LLFF, Middlebury, Strecha and Bundler: their layouts, lenses, and counts that do not agree."""

from __future__ import annotations

import re

import numpy as np
import pytest

from eigenfield.capture import open_any, open_capture
from eigenfield.capture.readers.bundler import find_bundler, read_bundler
from eigenfield.capture.readers.llff import read_llff
from eigenfield.capture.readers.middlebury import read_middlebury
from eigenfield.capture.readers.strecha import find_strecha, read_strecha
from eigenfield.core.errors import CaptureError
from support import calibrations as write
from support.calibrations import NAMES, WIDTH, stations
from support.readers import check_cube, check_lens, stem, write_llff

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


BUNDLER_PLACES = {  # the Bundler file and its list
    "Bundler's own": ("bundle/bundle.out", "prepare/list.txt"),
    "beside the photographs": ("bundle.out", "name_list.txt"),
    "of Metashape": ("model.out", "cameras of today.txt"),
    "above": ("bundler/scene.out", "photographs.txt"),
}


@pytest.mark.parametrize("name", BUNDLER_PLACES)
@pytest.mark.parametrize("form", ["./{}", "{} 0 90.0", "C:\\photos of today\\{}", '"D:/a b/{}"'])
def test_bundler_lists_under_other_names(tmp_path, name, form):
    path, place = (tmp_path / part for part in BUNDLER_PLACES[name])
    path.parent.mkdir(parents=True, exist_ok=True)
    place.parent.mkdir(parents=True, exist_ok=True)
    write.bundler(tmp_path / "made", stations(True, True)).rename(path)
    place.write_text("".join(form.format(s.name) + "\n" for s in stations()), encoding="utf-8")
    for other, text in (("notes.txt", "Four photographs, a0.png is the first.\n\n\n"), ("few.txt", "a0.png\n")):
        (place.parent / other).write_text(text)
    write.photographs(tmp_path / "images")
    light_field = open_capture(tmp_path)
    assert light_field.format == "bundler" and light_field.names == write.NAMES and not light_field.problems
    for view, station in zip(light_field.views, stations(True, True), strict=True):
        assert np.allclose(view.camera.project(write.CUBE)[0], station.pixels(write.CUBE))


@pytest.mark.parametrize("file", ["bundle.out", "bundle/bundle.out", "model.out"])
def test_a_bundler_file_without_its_list_is_named(tmp_path, file):
    (tmp_path / file).parent.mkdir(exist_ok=True)
    write.bundler(tmp_path / "made", stations(True, True)).rename(tmp_path / file)
    write.photographs(tmp_path / "images")
    (line,) = open_any(tmp_path).problems
    assert line.startswith(f"{file}: a Bundler file without the list of its photographs") and "list.txt" in line


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
