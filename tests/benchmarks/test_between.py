"""benchmarks/between.py: peers at the bytes of our file, errors near depth edges, one small capture to the end."""

from __future__ import annotations

import dataclasses
import sys

import cv2
import numpy as np
import pytest

import between
import eigenfield as ef
import measure
import tables
from benchmarks.test_evidence_between import joined, square
from benchmarks.test_evidence_codecs import numbered
from eigenfield.capture import open_capture
from eigenfield.core.camera import Camera
from eigenfield.gltf import parts
from eigenfield.imaging.metrics import psnr
from evidence import captures, codecs, equal_bytes, pictures
from evidence.between import between as evidence_between
from evidence.between import near_depth_edges, share_near, squared_luma_errors, start
from evidence.captures import Capture
from evidence.lumigraph import make_lumigraph
from support.captures import write_capture
from support.scenes import row_grid
from support.sheets import stacked

FAST = dataclasses.replace(
    codecs.VIDEO[1], options=tuple((k, "10" if k == "preset" else v) for k, v in codecs.VIDEO[1].options)
)


def test_the_largest_size_that_fits_is_found_in_few_trials():
    tried = []

    def size_of(step):
        tried.append(step)
        return 1000 - 4 * step

    assert equal_bytes.largest_within(size_of, 200, 700) == 75
    assert len(tried) == len(set(tried)) <= 10
    assert equal_bytes.largest_within(size_of, 200, 702) == 75  # 699 and 703 lie round it
    assert equal_bytes.largest_within(size_of, 200, 5000) == 0
    with pytest.raises(ValueError, match=r"smallest has 0\.2 kB, more than 0\.1 kB"):
        equal_bytes.largest_within(size_of, 200, 100)


def test_sizes_that_fall_unevenly_are_looked_at_before_the_one_found():
    sizes = [900, 800, 700, 695, 705, 600, 500, 400]
    assert equal_bytes.largest_within(lambda step: sizes[step], len(sizes), 699) == 3


def test_a_film_has_the_bytes_that_are_left_and_the_views_in_their_order(tmp_path):
    cameras = row_grid(9, 96, 64)
    views = [numbered(k, 64, 96) for k in range(9)]
    whole = equal_bytes.film_within(FAST, cameras, views, 1e6, tmp_path)
    assert whole.rate == equal_bytes.FINEST and whole.bytes < 1e6
    most = whole.bytes / 3
    film = equal_bytes.film_within(FAST, cameras, views, most, tmp_path)
    assert 0.8 * most < film.bytes <= most and film.rate > whole.rate
    assert film.order in codecs.orders(cameras)
    for place, picture in enumerate(film.pictures):
        errors = [np.abs(picture.astype(float) - view).mean() for view in views]
        assert int(np.argmin(errors)) == place
    assert psnr(film.pictures[4], views[4]) < psnr(whole.pictures[4], views[4])


def test_quarters_of_a_rate_are_other_films(tmp_path):
    views = [numbered(k, 64, 96) for k in range(9)]
    sizes = set()
    for rate in (20, 20.25, 20.5, 20.75):
        codecs.encode(views, FAST, rate, tmp_path / "film.obu")
        sizes.add((tmp_path / "film.obu").read_bytes())
    assert len(sizes) > 1


def test_a_patient_codec_walks_one_way():
    cameras = row_grid(9, 32, 24)
    assert set(codecs.orders_of(FAST, cameras)) == {"rows", "serpentine", "spiral"}
    assert set(codecs.orders_of(dataclasses.replace(FAST, patient=True), cameras)) == {"serpentine"}
    assert codecs.best_order(
        {"small": {"bytes": 100, "psnr_luma": 30.0}, "large": {"bytes": 200, "psnr_luma": 31.9}}
    ) == "small"  # fmt: skip


def test_pixels_near_the_outline_of_a_square_before_a_wall():
    """A square of 20 x 20 pixels: its edge lies between two pixels, and two more on each side are near."""
    K = np.array([[100.0, 0, 40], [0, 100, 32], [0, 0, 1]])
    camera = Camera(K, np.eye(3), np.zeros(3), 80, 64)
    near = near_depth_edges(joined(square(4.0, 9.0), square(2.0, 0.2)), camera)
    band = np.zeros((64, 80), bool)
    band[22 - 3 : 42 + 3, 30 - 3 : 50 + 3] = True
    band[22 + 3 : 42 - 3, 30 + 3 : 50 - 3] = False
    corners = np.zeros_like(band)  # no pixel of a corner's outer diagonal lies beside the square in a row or a column
    corners[np.ix_([19, 44], [27, 52])] = True
    assert (near == band)[~corners].all()
    assert not near_depth_edges(square(4.0, 9.0), camera).any()
    slanted = square(4.0, 9.0)
    slanted.vertices[:, 2] += 0.2 * slanted.vertices[:, 0]
    assert not near_depth_edges(slanted, camera).any()


def test_the_share_of_squared_errors_near_edges():
    near = np.zeros((10, 20), bool)
    near[:, 4:8] = True
    photograph = np.full((10, 20, 3), 100, np.uint8)
    drawn = photograph.copy()
    drawn[:, 6] += 30
    drawn[:, 12] += 10
    errors = squared_luma_errors(drawn, photograph)
    assert errors[0, 6] == pytest.approx(900) and errors[0, 12] == pytest.approx(100) and errors[0, 0] == 0
    assert share_near([errors], [near]) == pytest.approx(0.9)
    assert share_near([errors, errors], [near, ~near]) == pytest.approx(0.5)  # of all views together
    assert share_near([np.zeros(4)], [np.ones(4, bool)]) == 0
    green = photograph.copy()
    green[0, 0, 1] += 10
    assert squared_luma_errors(green, photograph)[0, 0] == pytest.approx(7.152**2, rel=1e-5)


def test_other_pictures_in_the_place_of_photographs():
    cameras = row_grid(4, 48, 40)
    lumigraph = make_lumigraph(square(0.5, 9.0), cameras, lambda i: (np.full((40, 48, 3), 0.2, np.float32), None))
    other = [np.full((40, 48, 3), 50 * i, np.uint8) for i in range(4)]
    for place, picture in enumerate(other):
        assert (lumigraph.of(other).photograph(place) == picture).all()
    assert lumigraph.photograph(2)[0, 0, 0] == 51


def test_the_square_with_the_largest_values():
    values = np.zeros((200, 300), np.float32)
    values[90:150, 120:180] = 2
    values[0, 0] = 1000
    mean, (row, column) = pictures.largest_square(values)
    assert mean == pytest.approx(2 * 60 * 60 / pictures.CROP**2, rel=1e-4)
    assert 150 - pictures.CROP <= row <= 90 and 180 - pictures.CROP <= column <= 120


@pytest.fixture(scope="module")
def nine(tmp_path_factory):
    folder = write_capture(tmp_path_factory.mktemp("between") / "nine")
    return Capture("nine", "Nine", folder, proxy=folder / "proxy.ply", hold_out="odd")


@pytest.mark.slow
def test_a_small_capture_from_end_to_end(nine, tmp_path, monkeypatch):
    asked = between.Case("odd", 12)
    found = between.of_capture(nine, asked, tmp_path, [FAST])
    rows = {row["key"]: row for row in found["methods"]}
    assert list(rows) == ["ours", FAST.name, "lumigraph", "blend", "nearest"]
    file = tmp_path / "ours.glb"
    size = file.stat().st_size
    assert rows["ours"]["bytes"] == size <= 12_000
    assert found["mesh"] < rows[FAST.name]["bytes"] <= equal_bytes.OVER * size
    assert rows["lumigraph"]["psnr"] > rows[FAST.name]["psnr"] and rows["lumigraph"]["psnr"] > rows["nearest"]["psnr"]
    assert found["cameras"] == 5 and found["encoded"] == 4
    for row in rows.values():
        assert 0 <= row["edge_share"] <= 1 and row["edge_pixels"] == rows["ours"]["edge_pixels"]
    theirs = ef.evaluate(ef.load(file), open_capture(nine.folder), png_maps="none")["image"]["held_out"]
    for key in ("psnr", "psnr_luma", "psnr_full", "ssim"):
        assert rows["ours"][key] == pytest.approx(theirs[key], abs=1e-6)
    side = 56 * pictures.ENLARGED * 2
    assert found["crops"] == [f"crops-{FAST.name}.png"]
    sheet = cv2.imread(str(tmp_path / found["crops"][0]))
    assert sheet.shape == (20 + 4 * (20 + side), 6 * side, 3)

    again = between.of_capture(nine, asked, tmp_path / "again", [], file)  # the file itself as the version before
    before = next(row for row in again["methods"] if row["key"] == "before")
    ours = again["methods"][0]
    for key in between.SCORES:
        assert before[key] == ours[key] == rows["ours"][key]
    assert again["crops"] == ["crops-before.png"]
    told = between.table(again)
    assert f"{size / 1000:.1f} kB" in told and "near depth edges lie" in told

    run = {
        "captures": {"nine": between.worth_keeping(found)}, "commit": "c", "command": "python", "date": "2026-01-01T0",
        "machine": {"processor": "p", "cores": 2},
    }  # fmt: skip
    monkeypatch.setattr(tables, "runs", lambda name: [run])
    text = tables.between_cameras()
    assert "`nine`" in text and f"{size / 1000:.1f}" in text and "python" in text


def test_peers_of_soft_sheets_are_drawn_on_an_opaque_surface(nine, tmp_path, monkeypatch):
    field = open_capture(nine.folder)
    plain = ef.encode(field, nine.proxy, textures=2, hold_out="odd", density=0.8, fit="none")
    ef.save(stacked(plain, plain.proxy.mesh), tmp_path / "ours.glb", codec="png")
    ef.save(plain, tmp_path / "opaque.glb", codec="png")
    asked = []

    def encoded(capture, hold_out, size, work, tree=None, more=()):
        asked.append((size, more))
        return work / ("opaque.glb" if more else "ours.glb")

    monkeypatch.setattr(between, "encoded", encoded)
    found = between.of_capture(nine, between.Case("odd", 12), tmp_path, [FAST])
    rows = {row["key"]: row for row in found["methods"]}
    assert asked == [(12_000, ()), (None, ["--layers", "1"])]
    assert found["sheets"] == 3 and found["mesh"] == parts(tmp_path / "opaque.glb")["mesh"]
    size = (tmp_path / "ours.glb").stat().st_size
    assert rows["ours"]["bytes"] == size and rows[FAST.name]["bytes"] <= equal_bytes.OVER * size
    opaque, photographs = ef.load(tmp_path / "opaque.glb"), open_capture(nine.folder)
    truth = ef.evaluate(opaque, photographs, png_maps="none")["image"]["held_out"]
    assert [row["coverage"] for row in rows.values()] == pytest.approx([truth["coverage"]] * len(rows))
    theirs = ef.evaluate(ef.load(tmp_path / "ours.glb"), photographs, png_maps="none")["image"]["held_out"]
    assert rows["ours"]["psnr_full"] == pytest.approx(theirs["psnr_full"], abs=1e-6) != truth["psnr_full"]
    usual = evidence_between(*start(opaque, photographs))["methods"]
    for row in usual:
        if row["key"] in between.PHOTOGRAPHS:
            for key in ("psnr", "edge_share", "edge_pixels"):
                assert rows[row["key"]][key] == pytest.approx(row[key])


@pytest.mark.slow
def test_another_tree_encodes_to_our_bytes(nine, tmp_path):
    tree = between.Path(__file__).parents[2]
    found = between.of_capture(nine, between.Case("odd"), tmp_path, [], tree)
    ours, before = found["methods"][0], found["methods"][1]
    assert before["key"] == "before" and before["bytes"] <= ours["bytes"] and before["psnr"] > ours["psnr"] - 1
    assert before["version"].rstrip("+") == measure.commit().rstrip("+")


def test_a_version_before_that_saw_the_views_is_refused(nine, tmp_path):
    field = open_capture(nine.folder)
    held = ef.encode(field, nine.proxy, textures=2, hold_out="odd", density=0.8, fit="none")
    seen = ef.encode(field, nine.proxy, textures=2, density=0.8, fit="none")
    ef.save(held, tmp_path / "held.glb")
    ef.save(seen, tmp_path / "seen.glb")
    stage, _ = between.opened(tmp_path / "held.glb", nine)
    chosen = between.held_out(stage)
    with pytest.raises(SystemExit, match=r"seen\.glb does not hold out .*view_01"):
        between.drawn_by(tmp_path / "seen.glb", stage, chosen)
    picture = between.drawn_by(tmp_path / "held.glb", stage, chosen)(chosen[0])
    assert picture.shape == (56, 64, 3) and picture.dtype == np.uint8


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nowhere"], "neither a folder nor one of"),
        (["a", "b", "--before", "FILE"], "is the file of one capture"),
        (["a", "--before", "FOLDER"], "neither a .glb nor a source tree"),
        ([], "name a capture"),
    ],
)
def test_what_cannot_be_asked_for(tmp_path, monkeypatch, words, said):
    (tmp_path / "file.glb").touch()
    places = {"FILE": str(tmp_path / "file.glb"), "FOLDER": str(tmp_path)}
    monkeypatch.delenv("EIGENFIELD_DATA", raising=False)
    monkeypatch.setattr(
        sys, "argv", ["between.py", *(places.get(word, word) for word in words), "--out", str(tmp_path)]
    )
    if "a" in words:
        monkeypatch.setattr(captures, "named", lambda name, out: Capture(name, name, tmp_path))
    with pytest.raises(SystemExit, match=said):
        between.main()
