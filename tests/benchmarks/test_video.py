"""benchmarks/video.py: what is said of curves."""

from __future__ import annotations

import pytest

import tables
import video
from evidence import rates


def points(scale, held_out=25.0, flicker=1.0):
    return [
        {
            "parameter": at, "bytes": scale * 100_000 * 2**at, "psnr": 30.0 + 2 * at, "psnr_luma": 31.0 + 2 * at,
            "ssim": 0.9 + 0.02 * at, "held_out": {"psnr_luma": held_out + at},
            "flicker": {"still": flicker / (at + 1), "still_share": 0.4, "moving_ssim": 0.8}, "border": None,
        }
        for at in range(4)
    ]  # fmt: skip


def test_a_point_in_words_also_where_nothing_moves():
    point = points(1)[0]
    said = "100.0 kB, 31.00 dB luma, 30.00 RGB, held out 25.00, flicker 1.00 levels"
    assert video.line(point) == said + ", SSIM of changes 0.800"
    point["flicker"]["moving_ssim"] = None
    assert video.line(point) == said


def test_bytes_are_compared_at_equal_luma_and_views_between_at_equal_bytes():
    found = {"ours": points(1)[1:3], "peers": {"keys-6": points(2)}, "stills": []}
    lines = video.table(found).splitlines()
    assert lines[0].startswith("keys-6, quality 1, 33.00 dB: 0.500 of 400.0 kB")
    assert "held out at equal bytes 25.000" in lines[0]
    assert "flicker at equal bytes 1.000" in lines[0]
    assert len(lines) == 2


def test_beyond_a_curve_nothing_is_said():
    for size in (50_000, 900_000):
        assert rates.value_at(points(1), size, rates.held_out_luma) is None
    assert rates.value_at(points(1), 100_000 * 2**0.5, rates.held_out_luma) == pytest.approx(25.5)
    assert rates.value_at(points(1), 100_000 * 2**0.5, rates.flicker) == pytest.approx(0.75)
    bare = [{"bytes": point["bytes"]} for point in points(1)]
    assert rates.value_at(bare, 200_000, rates.held_out_luma) is rates.value_at(bare, 200_000, rates.flicker) is None
    assert video.table({"ours": points(1), "peers": {"far": points(100)}, "stills": []}).count("not reached") == 0
    far = [dict(point, psnr_luma=point["psnr_luma"] + 50) for point in points(1)]
    assert video.table({"ours": points(1), "peers": {"far": far}, "stills": []}).count("not reached") == 4


def test_a_clip_of_another_name_is_refused(tmp_path):
    with pytest.raises(SystemExit, match="no clip is called"):
        video.source_of("elephant", tmp_path, 32, 3, 4)


def test_the_demo_in_motion_is_drawn_once_and_comes_with_a_mesh_a_frame(tmp_path):
    source = video.source_of("demo", tmp_path, 16, 2, 2)
    assert source.name == "demo-2x2-16-2" and source.hold_out == "every:5"
    assert len(list(source.folder.glob("cam_*/*.png"))) == 8
    before = {path: path.stat().st_mtime_ns for path in source.folder.rglob("*")}
    assert {video.proxy_at(source.proxy, frame) for frame in range(2)} <= set(before)
    assert video.source_of("demo", tmp_path, 16, 2, 2) == source
    assert {path: path.stat().st_mtime_ns for path in source.folder.rglob("*")} == before


def test_the_table_has_a_row_a_quality_and_a_column_a_peer(monkeypatch, tmp_path):
    monkeypatch.setattr(tables, "RESULTS", tmp_path)
    assert tables.clips() == ""  # nothing is measured yet
    (tmp_path / "video.json").write_text("{}")
    clip = {
        "cameras": 20, "held_out": 5, "frames": 50, "rate": 30.0, "groups": [30, 30], "size": [320, 480],
        "ours": points(1)[1:3], "peers": {"keys-6": points(2), "one-key-6": points(100)}, "stills": points(20),
    }  # fmt: skip
    monkeypatch.setattr(tables, "newest", lambda name: ({"light": clip}, "where from\n"))
    text = tables.clips()
    assert "`light`, pictures of 480x320. 20 cameras are encoded, and 5 held out." in text
    assert "The 50 frames lie in groups of 30." in text
    rows = [line for line in text.splitlines() if line.startswith("| 1 ")]
    assert [cell.strip() for cell in rows[0].strip("|").split("|")] == [
        "1", "4.00", "32.00 / 33.00", "26.00 (25.00)", "0.50 (1.00)", "–", "-50 %", "-99 %", "-95 %",
    ]  # fmt: skip
    assert "keys, preset 6 | one key, preset 6 | stills" in text
