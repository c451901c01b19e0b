"""Footage: its forms, its clock, and what is wrong with some."""

from __future__ import annotations

import json
import os
import pickle
import shutil
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from eigenfield.capture import open_any, open_path
from eigenfield.capture.film import open_film
from eigenfield.capture.lightfield import LightField
from eigenfield.capture.photoset import PhotoSet
from eigenfield.capture.readers.video import decode_video, to_rgb
from eigenfield.core.errors import CaptureError, EigenfieldError, OptionError
from eigenfield.imaging.png import png_bytes
from support.filmed import (
    CALIBRATION_FILE,
    HEIGHT,
    WIDTH,
    calibration,
    folder_a_camera,
    folder_an_instant,
    opened,
    picture,
    pose,
    seen,
    timed,
    video,
)
from support.named import refused, write_video


def all_seen(footage):
    return [seen(footage, number) for number in range(len(footage))]


def whole(cameras, frames):
    return [[(camera, frame, True) for camera in range(cameras)] for frame in frames]


def footage_refused(code, path, **options):
    return refused(code, path, call=lambda *given, **more: open_path(*given, **{"clip": ":", **more}), **options)


# forms


@pytest.mark.parametrize("write", [folder_a_camera, folder_an_instant])
def test_folders_of_pictures_without_cameras(tmp_path, write):
    footage = opened(write(tmp_path), rate=25)
    assert footage.names == ("cam_0", "cam_1", "cam_2") and footage.cameras is None
    assert footage.timeline.rate == 25 and len(footage) == 5 and not footage.held.any() and not footage.problems
    assert isinstance(footage.instant(0), PhotoSet) and all_seen(footage) == whole(3, range(5))
    assert "--rate" in opened(tmp_path).problems[0]


def test_entries_with_a_time_are_frames_of_cameras(tmp_path):
    footage = opened(timed(tmp_path))
    assert footage.names == ("cam_0", "cam_1", "cam_2") and footage.timeline.rate == 25 and not footage.problems
    assert isinstance(footage.instant(0), LightField) and all_seen(footage) == whole(3, range(5))
    assert [camera.centre[0] for camera in footage.cameras] == [pytest.approx(0.1 * c) for c in range(3)]
    assert np.array_equal(footage.instant(3).cameras[2].K, footage.cameras[2].K)
    assert opened(timed(tmp_path, fps=50.0)).timeline.rate == 50  # a frame is there at every other instant


def test_folders_with_a_calibration_beside_them_or_elsewhere(tmp_path):
    folder_a_camera(tmp_path / "take", first=4711)
    files = {c: [(f"cam_{c}/000000.png", None)] for c in range(3)}
    elsewhere = calibration(tmp_path / "rig.json", files)
    footage = opened(tmp_path / "take", calibration=elsewhere)
    assert [camera.centre[0] for camera in footage.cameras] == [pytest.approx(0.1 * c) for c in range(3)]
    assert all_seen(footage) == whole(3, range(5))
    shutil.copy(elsewhere, tmp_path / "take" / "transforms.json")
    assert all_seen(opened(tmp_path / "take")) == whole(3, range(5))
    footage = opened(tmp_path / "take", calibration=timed(tmp_path / "other") / "transforms.json")
    assert footage.cameras is not None and all_seen(footage) == whole(3, range(5))


def test_masks(tmp_path):
    timed(tmp_path)
    document = json.loads((tmp_path / "transforms.json").read_text("utf-8"))
    for frame in document["frames"]:
        if frame["file_path"] == "cam_1/000002.png":
            frame["mask_path"] = "masks/second.png"
    picture(tmp_path / "masks" / "second.png", 0, 0).write_bytes(black_half())
    (tmp_path / "transforms.json").write_text(json.dumps(document), encoding="utf-8")
    footage = opened(tmp_path)
    counts = [[footage.instant(n).photograph(c).mask for c in range(3)] for n in (1, 2)]
    assert [[mask is None for mask in row] for row in counts] == [[True] * 3, [True, False, True]]
    assert counts[1][1].mean() == 0.5
    picture(tmp_path / "static" / "cam_2.png", 0, 0).write_bytes(black_half())
    footage = opened(tmp_path, masks=tmp_path / "static")
    assert [footage.instant(4).photograph(c).mask is None for c in range(3)] == [True, True, False]


def black_half() -> bytes:
    mask = np.zeros((HEIGHT, WIDTH), np.uint8)
    mask[:, : WIDTH // 2] = 255
    return png_bytes(mask[..., None])


def test_a_calibration_of_other_cameras_is_named(tmp_path):
    folder_a_camera(tmp_path / "take")
    rig = calibration(tmp_path / "rig.json", {c: [(f"left_{c}.png", None)] for c in range(3)})
    error = footage_refused("too-few", tmp_path / "take", calibration=rig)
    assert "cam_0" in str(error) and "left_0.png" in str(error)
    rig = calibration(tmp_path / "rig.json", {c: [(f"cam_{c + 1}.png", None)] for c in range(3)})
    footage = opened(tmp_path / "take", calibration=rig)
    assert footage.names == ("cam_1", "cam_2") and any("cam_3.png" in line for line in footage.problems)


def test_instants_that_are_captures_with_a_calibration_each(tmp_path):
    for frame in range(4):
        folder = tmp_path / f"frame_{frame + 1:04d}"
        for camera in range(3):
            picture(folder / "images" / f"view_00_{camera:02d}.png", camera, frame)
        calibration(folder / "transforms.json", {c: [(f"images/view_00_{c:02d}.png", None)] for c in range(3)})
    footage = opened(tmp_path, rate=24)
    assert footage.names == ("view_00_00", "view_00_01", "view_00_02") and not footage.problems
    assert all_seen(footage) == whole(3, range(4)) and footage.cameras[1].centre[0] == pytest.approx(0.1)
    calibration(folder / "transforms.json", {c + 1: [(f"images/view_00_{c:02d}.png", None)] for c in range(3)})
    assert "frame_0001" in str(footage_refused("footage-moving", tmp_path))
    assert len(opened(tmp_path, calibration=tmp_path / "frame_0001")) == 4


def test_a_zip_of_footage(tmp_path):
    timed(tmp_path / "take")
    shutil.make_archive(str(tmp_path / "take"), "zip", tmp_path / "take")
    assert all_seen(opened(tmp_path / "take.zip")) == whole(3, range(5))


def test_names_that_do_not_say_what_is_a_camera_are_said_so(tmp_path):
    for folder in range(3):
        for number in range(4):
            picture(tmp_path / f"{folder}" / f"{number}.png", folder, number)
    footage = opened(tmp_path, rate=30)
    assert len(footage) == 4 and len(footage.names) == 3 and "do not say" in footage.problems[0]


def test_folders_beside_the_cameras_are_none(tmp_path):
    folder_a_camera(tmp_path)
    picture(tmp_path / "masks" / "cam_0.png", 0, 0)
    picture(tmp_path / "images_2" / "0.png", 0, 0)
    assert opened(tmp_path).names == ("cam_0", "cam_1", "cam_2")


def test_cameras_whose_clocks_are_a_little_apart(tmp_path):
    folder_a_camera(tmp_path, frames=12)
    files = {c: [(f"cam_{c}/{f:06d}.png", f / 25 + 0.002 * c) for f in range(12)] for c in range(3)}
    calibration(tmp_path / CALIBRATION_FILE, files)
    footage = opened(tmp_path)
    assert footage.timeline.rate == 25 and all_seen(footage) == whole(3, range(12))


@pytest.mark.parametrize("noise", [-1e-12, 1e-8])
def test_poses_that_differ_by_rounding_are_of_one_camera(tmp_path, noise):
    timed(tmp_path, frames=6)
    document = json.loads((tmp_path / CALIBRATION_FILE).read_text("utf-8"))
    for number, entry in enumerate(document["frames"]):
        for row in range(3):  # the middle camera's place is half of their extent
            entry["transform_matrix"][row][3] += noise * (number % 2)
    (tmp_path / CALIBRATION_FILE).write_text(json.dumps(document), encoding="utf-8")
    footage = opened(tmp_path)
    assert footage.names == ("cam_0", "cam_1", "cam_2") and all_seen(footage) == whole(3, range(6))


@pytest.mark.parametrize("inner", ["", "images/"])
def test_frames_that_are_called_as_other_cameras(tmp_path, inner):
    for camera in range(4):
        for frame in range(4):
            picture(tmp_path / f"{camera}" / f"{inner}{frame}.png", camera, frame)
    for frames in ((0, 0, 0, 0), (0, 2, 1, 3)):
        files = {camera: [(f"{camera}/{inner}{frame}.png", None)] for camera, frame in enumerate(frames)}
        calibration(tmp_path / CALIBRATION_FILE, files)
        footage = opened(tmp_path)
        assert footage.names == ("0", "1", "2", "3") and all_seen(footage) == whole(4, range(4))
        assert [camera.centre[0] for camera in footage.cameras] == [pytest.approx(0.1 * c) for c in range(4)]


def test_a_calibration_that_is_none(tmp_path):
    (tmp_path / "empty").mkdir()
    error = footage_refused("calibration-missing", folder_a_camera(tmp_path / "take"), calibration=tmp_path / "empty")
    assert "empty" in str(error)


# videos


def rig(folder: Path, frames=(12, 12, 12), rates=(10, 10, 10)):
    """Videos, a calibration, and the pictures in them."""
    truth = [
        write_video(folder / f"cam_{i}.mp4", *kind, camera=i) for i, kind in enumerate(zip(frames, rates, strict=True))
    ]
    entries = [{"file_path": f"cam_{i}.mp4", "transform_matrix": pose(i)} for i in range(len(frames))]
    document = {"fl_x": 60.0, "w": 64, "h": 48, "frames": entries}
    (folder / "transforms.json").write_text(json.dumps(document), encoding="utf-8")
    return truth


def frame_of(photograph, truth) -> int:
    distances = [np.abs(photograph.pixels * 255 - picture).mean() for picture in truth]
    assert min(distances) < 1.5
    return int(np.argmin(distances))


def test_videos_in_any_order_of_instants(tmp_path):
    truth = rig(tmp_path)
    footage = opened(tmp_path)
    assert footage.names == ("cam_0", "cam_1", "cam_2") and footage.timeline.rate == 10 and len(footage) == 12
    for number in (0, 1, 2, 11, 5, 6, 0, 7):
        instant = footage.instant(number)
        assert [frame_of(instant.photograph(c), truth[c]) for c in range(3)] == [number] * 3
    assert [frame_of(x.photograph(1), truth[1]) for x in footage.instants(3, 7)] == [3, 4, 5, 6]
    footage.close()
    again = pickle.loads(pickle.dumps(footage))
    assert frame_of(again.instant(9).photograph(0), truth[0]) == 9
    still = open_any(tmp_path, frame=4)
    assert np.array_equal(still.photograph(2).pixels, footage.instant(4).photograph(2).pixels)
    assert np.array_equal(still.cameras[2].t, footage.cameras[2].t)


def test_the_stored_direction_of_videos_is_not_looked_for(tmp_path):
    """Their calibration says nothing about turning, as of pictures that are kept as they are stored."""
    for camera in range(2):
        video(tmp_path / f"cam_{camera}.mkv", camera, {0: 0, 1: 40})
    calibration(tmp_path / CALIBRATION_FILE, {c: [(f"cam_{c}.mkv", None)] for c in range(2)})
    instant = opened(tmp_path).instant(1)
    assert not any(view.upright for view in instant.views) and instant.as_stored == ()


def test_no_frame_becomes_a_file(tmp_path):
    rig(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    footage = opened(tmp_path, work=tmp_path / "work")
    assert footage.instant(3).photograph(0).pixels.shape == (48, 64, 3)
    assert sorted(tmp_path.rglob("*")) == before
    assert footage.instant(3).views[0].path == tmp_path / "cam_0.mp4" and footage.bytes > 0


@pytest.mark.parametrize("write", [rig, timed])
def test_its_identity_is_what_its_files_hold_wherever_they_lie(tmp_path, write):
    write(tmp_path / "one")
    shutil.copytree(tmp_path / "one", tmp_path / "two")
    one, two = (opened(tmp_path / name) for name in ("one", "two"))
    assert one.identity() == two.identity() != one.part(1, 3).identity()
    file = one.tracks[1].path
    data, times = bytearray(file.read_bytes()), file.stat()
    data[len(data) // 2] ^= 1
    file.write_bytes(data)
    os.utime(file, ns=(times.st_atime_ns, times.st_mtime_ns + 1))
    assert one.identity() != two.identity()
    file.unlink()
    with pytest.raises(CaptureError) as caught:
        one.identity()
    assert caught.value.code == "image-missing" and str(file) in str(caught.value)


def test_videos_of_another_length_and_rate(tmp_path):
    truth = rig(tmp_path, (12, 24, 9), (10, 20, 10))
    footage = opened(tmp_path)
    assert len(footage) == 9 and footage.timeline.rate == 10
    assert any("rate" in line and "cam_1" in line for line in footage.problems)
    assert any("cam_2" in line and "0 to 8" in line for line in footage.problems)
    instant = footage.instant(4)
    assert [frame_of(instant.photograph(c), truth[c]) for c in range(3)] == [4, 8, 4]


def test_a_rate_that_no_video_has(tmp_path):
    rig(tmp_path, (12, 24, 12), (10, 20, 10))
    assert "20" in str(footage_refused("rate-unknown", tmp_path, rate=21.0))
    assert opened(tmp_path, rate=20).timeline.rate == 20
    assert opened(tmp_path, rate=5).timeline.rate == 5


def test_a_camera_that_stops_is_masked_out(tmp_path):
    truth = rig(tmp_path, (12, 12, 5))
    footage = opened(tmp_path, ":12")
    assert len(footage) == 12 and any("cam_2 0 to 4" in line for line in footage.problems)
    last = footage.instant(10).photograph(2)
    assert frame_of(last, truth[2]) == 4 and last.mask is not None and not last.mask.any()
    assert footage.instant(10).photograph(0).mask is None
    assert footage.held.sum() == 7


def test_uneven_times_and_holes_of_videos(tmp_path):
    random = np.random.default_rng(0)
    even = {number: round(number * 1000 / 30) for number in range(30)}
    video(tmp_path / "cam_0.mkv", 0, even)
    video(tmp_path / "cam_1.mkv", 1, {n: t + int(random.integers(-9, 10)) if n else t for n, t in even.items()})
    video(tmp_path / "cam_2.mkv", 2, {n: t for n, t in even.items() if n not in (7, 8, 20)})
    video(tmp_path / "cam_3.mkv", 3, {n: t + 500 for n, t in even.items()})  # does not begin at 0
    footage = opened(tmp_path)
    assert footage.timeline.rate == 30 and len(footage) == 30
    held = {7: 6, 8: 6, 20: 19}
    for number in range(30):
        counts = number not in held
        assert seen(footage, number) == [
            (0, number, True), (1, number, True), (2, held.get(number, number), counts), (3, number, True),
        ]  # fmt: skip
    assert any("cam_2 (3)" in line for line in footage.problems)
    video(tmp_path / "cam_2.mkv", 2, {n: t for n, t in even.items() if not 7 <= n <= 10})
    error = footage_refused("footage-hole", tmp_path)
    assert "cam_2" in str(error) and "frame 10" in str(error)


def test_videos_of_another_size_and_direction(tmp_path):
    rig(tmp_path)
    video(tmp_path / "cam_3.mkv", 3, {number: 100 * number for number in range(12)}, (32, 20))
    data = bytearray((tmp_path / "cam_1.mp4").read_bytes())
    at = data.index(b"tkhd") + 4 + 40  # the matrix of the track header
    turn = 0, 1 << 16, 0, -1 << 16, 0, 0, 0, 0, 1 << 30
    data[at : at + 36] = b"".join(value.to_bytes(4, "big", signed=True) for value in turn)
    (tmp_path / "cam_1.mp4").write_bytes(data)
    (tmp_path / "transforms.json").unlink()
    footage = opened(tmp_path)
    assert footage.sizes == [(64, 48), (48, 64), (64, 48), (32, 20)]
    assert [footage.instant(5).photograph(camera).pixels.shape[:2] for camera in range(4)] == [
        (48, 64), (64, 48), (48, 64), (20, 32),
    ]  # fmt: skip


def test_a_video_that_is_damaged_in_the_middle_is_masked_out_there(tmp_path):
    truth = [write_video(tmp_path / f"cam_{i}.mp4", 40, camera=i) for i in range(3)]
    data = bytearray((tmp_path / "cam_1.mp4").read_bytes())
    start = data.index(b"mdat") + 4
    middle = start + (len(data) - start) // 3
    data[middle : middle + 400] = bytes(400)
    (tmp_path / "cam_1.mp4").write_bytes(data)
    footage, masked = opened(tmp_path), 0
    for number in range(len(footage)):
        try:
            photograph = footage.instant(number).photograph(1)
        except CaptureError as error:
            assert "cam_1.mp4" in str(error)
            continue
        if photograph.mask is not None:
            masked += 1
            assert not photograph.mask.any()
        else:
            assert frame_of(photograph, truth[1]) == number
    assert masked


def test_any_folders_are_footage_or_refused(tmp_path):
    random = np.random.default_rng(3)
    words = ["cam", "frame", "", "0", "00", "view_", "images", "masks", "t", "é", "cam_1"]
    opened_at_all = 0
    for trial in range(60):
        root = tmp_path / str(trial)
        folder, name = random.choice(words, 2)
        for outer in range(4):
            for inner in range(4):
                if random.random() < 0.85:
                    stray = random.choice(words) if random.random() < 0.05 else name
                    picture(root / f"{folder}{outer}" / f"{stray}{inner}.png", inner, outer)
        try:
            footage = opened(root)
        except EigenfieldError as error:
            assert error.remedy and "\n" not in str(error)
        else:
            opened_at_all += 1
            assert footage.frames.shape == (len(footage.names), len(footage)) and seen(footage, len(footage) - 1)
    assert opened_at_all > 20


@pytest.mark.parametrize("seed", range(12))
def test_videos_changed_at_random_are_read_or_refused(tmp_path, seed):
    random = np.random.default_rng(seed)
    rig(tmp_path)
    data = bytearray((tmp_path / "cam_1.mp4").read_bytes())
    for place in random.integers(0, len(data), 1 + seed):
        data[place] = random.integers(0, 256)
    (tmp_path / "cam_1.mp4").write_bytes(data[: len(data) - int(random.integers(0, 3)) * 200])
    try:
        footage = opened(tmp_path)
        for instant in footage.instants():
            assert instant.photograph(1).pixels.shape == (48, 64, 3)
    except EigenfieldError as error:
        assert error.remedy and "cam_1" in str(error)


def test_stills_of_footage_are_said_so(tmp_path):
    assert any("--clip" in line for line in open_any(timed(tmp_path)).problems)


# ranges and offsets


@pytest.mark.parametrize(
    ("clip", "frames"),
    [("1:3", [1, 2]), ("2:", [2, 3, 4]), (":2", [0, 1]), ("::2", [0, 2, 4]), ("0.04s:0.12s", [1, 2]), ("", range(5))],
)
def test_a_range_of_frames(tmp_path, clip, frames):
    footage = opened(timed(tmp_path), clip)
    assert all_seen(footage) == whole(3, frames)
    assert footage.timeline.first == pytest.approx(frames[0] / 25)
    part = footage.part(1, 2)
    assert len(part) == 1 and seen(part, 0) == seen(footage, 1) and part.timeline.first == footage.timeline.times[1]


def test_a_step_makes_the_rate_lower(tmp_path):
    footage = opened(timed(tmp_path), "0:5:2")
    assert footage.timeline.rate == Fraction(25, 2) and list(footage.timeline.times) == pytest.approx([0, 0.08, 0.16])


def test_offsets(tmp_path):
    footage = opened(folder_a_camera(tmp_path), offset=["cam_1=2"])
    assert all_seen(footage) == [[(0, f, True), (1, f + 2, True), (2, f, True)] for f in range(3)]
    footage = opened(tmp_path, offset=["cam_1=-1"])
    assert all_seen(footage) == [[(0, f, True), (1, f - 1, True), (2, f, True)] for f in range(1, 5)]
    error = footage_refused("footage-range", tmp_path, offset=["cam_2=9"])
    assert "cam_2 -9 to -5" in str(error) and "offset" in str(error)


@pytest.mark.parametrize("clip", ["5", "a:b", "1s", "3:4:0", "-1:4", "1:2:3:4", "1e3s:"])
def test_ranges_that_are_none(tmp_path, clip):
    with pytest.raises(OptionError, match="is no range"):
        opened(folder_a_camera(tmp_path), clip)


@pytest.mark.parametrize("clip", ["9:", "3:3", "4:2", "0:6", "2s:3s"])
def test_ranges_that_leave_nothing(tmp_path, clip):
    assert footage_refused("clip-range", folder_a_camera(tmp_path), clip=clip).code == "clip-range"


@pytest.mark.parametrize("offset", [["cam_9=1"], ["cam_1"], ["cam_1=x"], ["cam_1=1", "cam_1=2"]])
def test_offsets_that_are_none(tmp_path, offset):
    footage_refused("offset-unknown", folder_a_camera(tmp_path), offset=offset)


def test_options_of_footage_alone(tmp_path):
    timed(tmp_path)
    refused("clip-unused", tmp_path, offset=["cam_1=1"])
    refused("clip-unused", tmp_path, rate=5.0)
    footage_refused("clip-options", tmp_path, frame=3)
    with pytest.raises(OptionError, match="rate"):
        opened(tmp_path, rate=0)


# clocks


@pytest.mark.parametrize("seconds", [15, 700.7])
def test_a_time_lapse(tmp_path, seconds):
    footage = opened(timed(tmp_path, rate=1 / seconds))
    assert 1 / footage.timeline.rate == Fraction(str(seconds)) and all_seen(footage) == whole(3, range(5))
    assert not footage.held.any()


def test_rates_that_no_clip_has(tmp_path):
    footage_refused("rate-unknown", folder_a_camera(tmp_path / "pictures"), rate=0.0004)
    footage_refused("rate-unknown", tmp_path / "pictures", clip="::99999999")
    for number, rate in enumerate((1 / 1800, 1e5, 1e308, 1e-307)):
        footage_refused("rate-unknown", timed(tmp_path / f"{number}", rate=rate))


@pytest.mark.parametrize("apart", [33333331, 10**40])
def test_names_that_are_time_stamps(tmp_path, apart):
    for camera in range(3):
        for frame in range(3):
            picture(tmp_path / f"cam_{camera}" / f"{1699999999123456789 + apart * frame + camera}.png", camera, frame)
    assert "number pictures" in str(footage_refused("clip-range", tmp_path))


# gaps


def test_a_hole_is_held_and_masked_out(tmp_path):
    folder_a_camera(tmp_path, frames=9)
    for number in (3, 4, 5):
        (tmp_path / "cam_1" / f"{number:06d}.png").unlink()
    footage = opened(tmp_path)
    assert [seen(footage, number)[1] for number in range(2, 7)] == [
        (1, 2, True), (1, 2, False), (1, 2, False), (1, 2, False), (1, 6, True),
    ]  # fmt: skip
    assert any("cam_1 (3)" in line for line in footage.problems)
    (tmp_path / "cam_1" / "000006.png").unlink()
    error = footage_refused("footage-hole", tmp_path)
    assert "cam_1" in str(error)
    assert len(opened(tmp_path, ":5")) == 5


def test_pictures_numbered_by_tens(tmp_path):
    for camera in range(3):
        for frame in range(4):
            picture(tmp_path / f"cam_{camera}" / f"f{100 + 10 * frame}.png", camera, frame)
    footage = opened(tmp_path)
    assert all_seen(footage) == whole(3, range(4)) and any("by 10" in line for line in footage.problems)


# what is wrong with some


def test_one_frame_and_one_camera(tmp_path):
    assert len(opened(timed(tmp_path / "short", frames=2), ":1")) == 1
    folder_a_camera(tmp_path / "two", cameras=2)
    assert "calibration" in str(footage_refused("too-few", tmp_path / "two"))
    files = {c: [(f"cam_{c}.png", None)] for c in range(2)}
    assert len(opened(tmp_path / "two", calibration=calibration(tmp_path / "rig.json", files)).names) == 2
    write_video(tmp_path / "one" / "a.mp4", 3)
    footage_refused("too-few", tmp_path / "one" / "a.mp4")
    footage_refused("footage-missing", tmp_path / "one")
    (tmp_path / "none").mkdir()
    footage_refused("footage-missing", tmp_path / "none")


def test_cameras_that_move_are_no_footage(tmp_path):
    files = {f: [(f"cam_0/{f:06d}.png", f / 10)] for f in range(5)}
    folder_a_camera(tmp_path, cameras=1)
    calibration(tmp_path / "transforms.json", files)
    footage_refused("footage-moving", tmp_path)


def test_a_picture_of_another_size_is_named(tmp_path):
    timed(tmp_path)
    picture(tmp_path / "cam_1" / "000003.png", 1, 3, (10, 10))
    with pytest.raises(Exception, match=r"000003\.png.*10x10"):
        opened(tmp_path).instant(3).photograph(1)
    picture(tmp_path / "cam_1" / "000000.png", 1, 3, (10, 10))
    error = footage_refused("image-size", tmp_path)
    assert "000000.png" in str(error)


@pytest.mark.parametrize("left", [0, 50])  # bytes: no header, or one without its picture
def test_a_damaged_picture_is_masked_out_and_the_one_before_stands_in(tmp_path, caplog, left):
    folder_a_camera(tmp_path, frames=6)
    calibration(tmp_path / CALIBRATION_FILE, {c: [(f"cam_{c}/000000.png", None)] for c in range(3)})
    for number in (2, 3):
        file = tmp_path / "cam_1" / f"{number:06d}.png"
        file.write_bytes(file.read_bytes()[:left])
    footage = opened(tmp_path)
    for _ in range(2):
        assert [seen(footage, number)[1] for number in range(1, 5)] == [
            (1, 1, True), (1, 1, False), (1, 1, False), (1, 4, True),
        ]  # fmt: skip
    assert [footage.tracks[1].small(number, 8) is None for number in range(1, 5)] == [False, True, True, False]
    assert footage.instant(2).as_stored == ()
    lines = [record.getMessage() for record in caplog.records if "masked out" in record.getMessage()]
    assert len(lines) == 2 and all(f"00000{n}.png" in line for n, line in zip((2, 3), lines, strict=True))
    first = opened(tmp_path, "2:")  # nothing else is known of an instant that begins with one
    assert seen(first, 0) == [(0, 2, True), (1, 1, False), (2, 2, True)]


def test_pictures_that_are_all_damaged_are_named(tmp_path):
    folder_a_camera(tmp_path, frames=2)
    for file in (tmp_path / "cam_1").iterdir():
        file.write_bytes(file.read_bytes()[:50])
    assert "000001.png" in str(refused("image-truncated", 1, call=opened(tmp_path).instant(1).photograph))


def test_videos_that_are_damaged(tmp_path):
    rig(tmp_path)
    whole_video = (tmp_path / "cam_1.mp4").read_bytes()
    (tmp_path / "cam_1.mp4").write_bytes(whole_video[:300])
    assert "cam_1.mp4" in str(footage_refused("video-unreadable", tmp_path))
    (tmp_path / "cam_1.mp4").write_bytes(b"")
    footage_refused("video-unreadable", tmp_path)


def test_a_video_that_is_cut_short_ends_sooner(tmp_path):
    truth = [write_video(tmp_path / f"cam_{i}.mkv", 12, camera=i) for i in range(3)]
    data = (tmp_path / "cam_1.mkv").read_bytes()
    (tmp_path / "cam_1.mkv").write_bytes(data[: len(data) * 8 // 10])
    footage = opened(tmp_path)
    assert 3 < len(footage) < 12 and any("cam_1" in line for line in footage.problems)
    for number in range(len(footage)):
        photograph = footage.instant(number).photograph(1)
        assert (photograph.mask is not None and not photograph.mask.any()) or frame_of(photograph, truth[1]) == number


def test_the_key_frames_of_a_video_are_known(tmp_path):
    write_video(tmp_path / "a.mp4", 23)
    film, shown = open_film(tmp_path / "a.mp4"), list(decode_video(tmp_path / "a.mp4"))
    assert film.keys == tuple(number for number, one in enumerate(shown) if one.frame.key_frame) and len(film.keys) > 2
    assert list(film.seconds) == [pytest.approx(one.frame.time) for one in shown]


@pytest.mark.parametrize(("name", "codec"), [("a.mts", "libx264"), ("a.mpg", "mpeg2video")])
def test_frames_of_a_stream_in_which_seeking_goes_too_far(tmp_path, name, codec):
    write_video(tmp_path / name, 40, 25, codec=codec)
    film, shown = open_film(tmp_path / name), [to_rgb(one) for one in decode_video(tmp_path / name)]
    assert len(film.stamps) == len(shown) == 40
    for number in (39, 38, 20, 3, 37):
        film.close()
        pixels, damaged = film.read(number)
        assert not damaged and np.array_equal(pixels, shown[number]), number


def test_an_avi_that_does_not_state_the_order_of_its_frames_is_refused(tmp_path):
    write_video(tmp_path / "a.avi", 12)
    assert "encode it anew" in str(refused("video-unreadable", tmp_path / "a.avi", call=open_film))
    write_video(tmp_path / "b.avi", 12, codec="mpeg4")
    film, shown = open_film(tmp_path / "b.avi"), [to_rgb(one) for one in decode_video(tmp_path / "b.avi")]
    assert all(np.array_equal(film.read(number)[0], shown[number]) for number in range(12))
