"""Metashape XML: lenses, transforms, groups, and documents that are refused."""

from __future__ import annotations

import re

import numpy as np
import pytest

from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.filestorage import load_storage
from eigenfield.capture.readers.llff import read_llff
from eigenfield.capture.readers.metashape import read_metashape
from eigenfield.core.errors import CaptureError
from support import calibrations as write
from support.calibrations import stations
from support.readers import check_cube, check_lens

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


@pytest.mark.parametrize("master", [0, 2])
@pytest.mark.parametrize("place", ["component", "chunk"])
def test_metashape_multi_camera_systems(tmp_path, master, place):
    """Every camera but one has its place relative to that one, in its sensor."""
    path = write.metashape(tmp_path, stations(), place=place)
    text, all_stations = path.read_text(), stations()
    chief = all_stations[master]
    for number, s in enumerate(all_stations):
        if number == master:
            continue
        axes = np.stack([s.right, s.down, s.forward])
        rotation = axes @ np.stack([chief.right, chief.down, chief.forward], axis=1)  # dot products of the directions
        shift = axes @ (chief.eye - s.eye) / write.SCALE  # where the camera sees the master, in units of the chunk
        sensor = f"<rotation>{write.words(rotation)}</rotation><translation>{write.words(shift)}</translation></sensor>"
        head, tail = text.split(f'<sensor id="{number}"', 1)
        text = f'{head}<sensor id="{number}" master_id="{master}"{tail.replace("</sensor>", sensor, 1)}'
        camera = rf'(<camera id="{number}" sensor_id="{number}").*?<transform>.*?</transform>'
        label = rf'\1 master_id="{master}" label="{s.name.removesuffix(".png")}">'
        text = re.sub(camera, label, text)
    path.write_text(text)
    calibration = read_metashape(path)
    check_cube(calibration, all_stations)
    assert calibration.problems == ("1 camera is not aligned: lost",) and not calibration.errors
    path.write_text(re.sub(rf'(<camera id="{master}".*?)<transform>.*?</transform>', r"\1", text))
    assert calibration.problems[0] != read_metashape(path).problems[0]  # nor is any of a system without its master


@pytest.mark.parametrize(("offset", "code"), [
    ("<translation>1 2 3</translation>", "metashape-rig"),
    ("<rotation>1 0 0 0 1 0 0 0 2</rotation>", "calibration-damaged"),
    ("<rotation>1 0 0</rotation>", "calibration-damaged"),
    ("<rotation>1 0 0 0 1 0 0 0 nan</rotation>", "camera-not-finite"),
])  # fmt: skip
def test_metashape_offsets_that_are_none(tmp_path, offset, code):
    path = write.metashape(tmp_path, stations(), extra=camera_xml("", master_id=0, sensor_id=5))
    sensor = write.metashape_sensor(stations()[0], 5, {}, "frame").replace("</sensor>", f"{offset}</sensor>")
    path.write_text(path.read_text().replace("<sensors>", f"<sensors>{sensor}"))
    calibration = read_metashape(path)
    assert [error.code for error in calibration.errors] == [code] and len(calibration.entries) == 4


def test_metashape_component_without_a_frame_is_left_out(tmp_path):
    pose = " ".join(map(str, np.eye(4).ravel()))
    extra = f'<camera id="9" sensor_id="0" component_id="5" label="apart"><transform>{pose}</transform></camera>'
    calibration = read_metashape(write.metashape(tmp_path, stations(), extra=extra))
    check_cube(calibration, stations())
    assert any("another component" in line and "apart" in line for line in calibration.problems)


def test_metashape_georeferenced_cameras_keep_their_digits(tmp_path):
    far = np.array([4_000_000.0, 500_000.0, 4_900_000.0])
    near = read_metashape(write.metashape(tmp_path, stations()))
    calibration = read_metashape(write.metashape(tmp_path, stations(), shift=write.SHIFT + far))
    for one, other in zip(calibration.entries, near.entries, strict=True):
        assert np.abs(one.centre - other.centre - far).max() < 1e-6


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
    path.write_text(path.read_text().replace("<fy>90</fy><cx>50</cx><cy>31</cy>", ""))
    simple = read_metashape(path).entries[0].intrinsics
    assert simple.focal == (91, 91) and simple.principal == (simple.width / 2, simple.height / 2)


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
