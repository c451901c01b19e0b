"""Clips: groups of frames that share their weights, coded as films, decode to what the photographs show."""

from __future__ import annotations

import json
import os
import signal
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from PIL import Image

import eigenfield as ef
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.encoding import EncodeOptions, encode_footage
from eigenfield.encoding.atlas import make_atlas
from eigenfield.encoding.clip.digest import footage_digest
from eigenfield.encoding.clip.encode import encode_clip, group_length
from eigenfield.encoding.clip.plan import KeptPhotographs
from eigenfield.encoding.projected.mean import mean_map
from eigenfield.encoding.projected.project import texture_maps
from eigenfield.encoding.target import Target
from eigenfield.gltf import load_clip, save, validate
from eigenfield.imaging.metrics import psnr, to_codes
from eigenfield.rendering import Renderer, camera_weights, draw_texture
from eigenfield.runtime.executor import open_executor
from eigenfield.runtime.files import scratch_arrays
from eigenfield.viewer.exports import write_clip_folder
from support.captures import backdrop, shaded_texture
from support.filmed import CALIBRATION_FILE, HEIGHT, WIDTH, opened, picture, timed
from support.glb_surgery import split
from support.moving_clips import FootageInMemory
from support.observations import CalibratedInMemory, InMemory
from support.scenes import row_grid
from support.sounds import opus

CAMERAS, MESH = row_grid(9, 64, 56), backdrop()


def photographs(level: float) -> CalibratedInMemory:
    """What nine cameras see under a light of so much strength."""
    drawn = [draw_texture(MESH, shaded_texture(i, 9), camera, samples=2).image for i, camera in enumerate(CAMERAS)]
    return CalibratedInMemory(InMemory([np.clip(one * level, 0, 1).astype(np.float32) for one in drawn]), CAMERAS)


def footage(*levels: float) -> FootageInMemory:
    made = {level: photographs(level) for level in set(levels)}
    return FootageInMemory([made[level] for level in levels], [])


def measured(scene, instant) -> float:
    """dB, the mean over cameras."""
    found = []
    for index in range(len(instant)):
        drawn = Renderer(scene).draw(scene.rig.cameras[index], camera_weights(scene, index))
        found.append(psnr(drawn.image, to_codes(instant.photograph(index).pixels), drawn.covered))
    return float(np.mean(found))


def test_a_sound_is_kept_and_another_kind_of_file_is_refused_before_any_work(tmp_path):
    sound, other = tmp_path / "sound.opus", tmp_path / "sound.mp3"
    sound.write_bytes(opus(0.2))
    other.write_bytes(b"ID3 nonsense")
    two = footage(1.0, 0.9)
    clip = encode_footage(two, MESH, OPTIONS, audio=sound)
    assert clip.audio.data == sound.read_bytes() and clip.audio.first == 0.0
    for path, code in ((other, "audio-unknown"), (tmp_path / "none.opus", "audio-unreadable")):
        two.asked.clear()
        with pytest.raises(CaptureError) as caught:
            encode_footage(two, MESH, OPTIONS, audio=path)
        assert caught.value.code == code and path.name in str(caught.value) and not two.asked


LEVELS = 1.0, 0.9


@pytest.fixture(scope="module")
def two():
    return replace(footage(*LEVELS), rate=Fraction(10))


@pytest.fixture(scope="module")
def fine(two, tmp_path_factory):
    """The bytes of a clip of two frames in groups of their own, at a quality near the preset's."""
    path = tmp_path_factory.mktemp("fine") / "clip.glb"
    save(encode_footage(two, MESH, EncodeOptions(quality=88), group="1"), path)
    return path.stat().st_size


@pytest.mark.parametrize("kind", ["size", "psnr", "too little"])
@pytest.mark.slow
def test_a_target_is_reached_by_the_quality_or_the_nearest_is_taken(two, fine, kind, tmp_path):
    target = {"size": Target(size=fine), "psnr": Target(psnr=32.0), "too little": Target(size=1200)}[kind]
    clip = encode_footage(two, MESH, EncodeOptions(target=target), group="1", work=tmp_path / "work")
    save(clip, tmp_path / "clip.glb")
    size, quality = (tmp_path / "clip.glb").stat().st_size, clip.settings["clip"]["quality"]
    if kind == "psnr":
        found = np.mean([measured(clip.scene(number / 10), two.frames[number]) for number in range(2)])
        assert abs(found - 32) < 1.0
        again = encode_footage(two, MESH, EncodeOptions(quality=quality), group="1")
        assert list(map(stored_bytes, again.groups.stored)) == list(map(stored_bytes, clip.groups.stored))
    elif kind == "too little":
        assert quality == 20 and size > 1200
    else:
        assert 0.8 * fine < size <= 1.03 * fine


def test_a_bitrate_is_the_size_of_so_many_seconds_beside_their_sound(two, monkeypatch, tmp_path):
    class ReachedError(Exception):
        pass

    def reached(groups, target, stages, first, progress):
        raise ReachedError(target)

    monkeypatch.setattr("eigenfield.encoding.clip.encode.reach_quality", reached)
    sound = tmp_path / "sound.opus"
    sound.write_bytes(opus(0.1))
    for audio, taken in ((None, 0), (sound, sound.stat().st_size)):
        with pytest.raises(ReachedError) as caught:
            encode_footage(two, MESH, EncodeOptions(target=Target(bitrate=200_000)), group="1", audio=audio)
        assert caught.value.args == (Target(size=5_000 - taken),)  # of 0.2 s


def test_a_sound_that_leaves_nothing_of_a_target_is_refused_before_any_work(two, tmp_path):
    sound = tmp_path / "sound.opus"
    sound.write_bytes(opus(1))
    two.asked.clear()
    for asked in (Target(size=sound.stat().st_size), Target(bitrate=sound.stat().st_size)):
        with pytest.raises(OptionError) as caught:
            encode_footage(two, MESH, EncodeOptions(target=asked), audio=sound)
        assert caught.value.code == "target" and str(sound.stat().st_size) in str(caught.value) and not two.asked


def stored_bytes(group) -> bytes:
    return bytes(group.data.read(0, group.data.size))


OPTIONS = EncodeOptions(quality=90)


@pytest.fixture(scope="module")
def lit(tmp_path_factory):
    """Six frames in groups of three, the light changes within the first group; and the folder of finished stages."""
    seen, work = footage(1.0, 1.0, 0.7, 0.7, 0.7, 0.7), tmp_path_factory.mktemp("work")
    return seen, encode_footage(seen, MESH, OPTIONS, group="3", work=work), work


def test_each_frame_shows_its_own_photographs(lit):
    seen, clip, _ = lit
    assert list(clip.groups.lengths) == [3, 3] and clip.timeline == seen.timeline
    still = ef.encode(seen.frames[0], MESH, OPTIONS)
    good = measured(still, seen.frames[0])
    for number, instant in enumerate(seen.frames):
        scene = clip.scene(float(clip.timeline.times[number]))
        assert measured(scene, instant) > good - 3  # films of three frames are coded more coarsely than pictures
    wrong = measured(clip.scene(0.0), seen.frames[-1])
    assert wrong < good - 5


def test_a_clip_of_one_frame_is_as_good_as_a_still():
    seen = footage(1.0)
    clip, still = encode_footage(seen, MESH, OPTIONS), ef.encode(seen.frames[0], MESH, OPTIONS)
    assert measured(clip.scene(0.0), seen.frames[0]) > measured(still, seen.frames[0]) - 1


def test_a_frame_that_is_repeated_takes_next_to_nothing(lit):
    _, clip, _ = lit
    sizes = [[sum(map(len, frame)) for frame in clip.groups.coded(index).units] for index in range(2)]
    assert sum(sizes[1][1:]) < sizes[1][0] / 20
    assert sum(sizes[0][1:]) > 3 * sum(sizes[1][1:])


def test_a_clip_is_saved_and_loaded(lit, tmp_path):
    _, clip, _ = lit
    save(clip, tmp_path / "clip.glb")
    assert validate(tmp_path / "clip.glb") == []
    loaded = load_clip(tmp_path / "clip.glb")
    assert loaded.timeline == clip.timeline and loaded.settings["clip"]["group"] == "3"
    for number in (0, 5):
        time = float(clip.timeline.times[number])
        drawn = [
            Renderer(one.scene(time)).draw(CAMERAS[4], camera_weights(one.scene(time), 4)) for one in (clip, loaded)
        ]
        np.testing.assert_array_equal(drawn[0].image, drawn[1].image)


@pytest.mark.parametrize("fallback", ["none", "good"])
def test_what_other_viewers_get_is_as_asked_and_makes_no_other_groups(lit, tmp_path, fallback):
    seen, clip, work = lit
    made = encode_footage(seen, MESH, replace(OPTIONS, fallback=fallback), group="3", work=work)
    assert list(map(stored_bytes, made.groups.stored)) == list(map(stored_bytes, clip.groups.stored))
    save(made, tmp_path / "clip.glb")
    assert load_clip(tmp_path / "clip.glb").settings["fallback"] == fallback
    assert ("meshes" in split((tmp_path / "clip.glb").read_bytes())[0]) == (fallback == "good")


@pytest.mark.slow
def test_a_target_counts_what_other_viewers_get(monkeypatch, tmp_path):
    tried = []
    monkeypatch.setattr(
        "eigenfield.encoding.clip.target.search_quality", lambda _, code, first: tried.append(code(97)) or tried[-1]
    )
    options = EncodeOptions(target=Target(size=14_000), fallback="good")
    save(encode_footage(footage(1.0), MESH, options), tmp_path / "clip.glb")
    assert 0 <= tried[-1].size - (tmp_path / "clip.glb").stat().st_size < 2600  # a small one is counted besides


def test_finished_groups_are_taken_up_and_nothing_else_is_kept(lit):
    seen, clip, work = lit
    assert sorted(one.name[:10] for one in (work / "clip").iterdir()) == ["group-0000", "group-0001"]
    again = replace(seen, asked=[])
    made = encode_footage(again, MESH, OPTIONS, group="3", work=work)
    assert list(map(stored_bytes, made.groups.stored)) == list(map(stored_bytes, clip.groups.stored))
    assert again.asked == [0, 3, 5, 3]  # what tells this footage from another, and the mesh by the middle one


def test_frames_with_other_masks_are_other_footage(lit):
    seen, _, _ = lit
    hidden = [np.zeros((56, 64), np.float32) for _ in CAMERAS]
    masked = [CalibratedInMemory(InMemory(one.observations.pixels, hidden), CAMERAS) for one in seen.frames]
    assert footage_digest(seen) == footage_digest(replace(seen))
    assert footage_digest(seen) != footage_digest(replace(seen, frames=masked))


@pytest.mark.parametrize("change", ["picture", "mask", "offset", "nothing"])
def test_footage_is_known_by_all_of_its_files_and_frames(tmp_path, change):
    """Not by those of the instants alone whose pixels are looked at: 2, 7 and 11."""
    timed(tmp_path, frames=14)
    document = json.loads((tmp_path / CALIBRATION_FILE).read_text("utf-8"))
    (tmp_path / "masks").mkdir()
    for frame in range(14):
        picture(tmp_path / "cam_1" / f"{frame:06d}.png", 1, 9 if frame == 4 else 8)
        mask_all(tmp_path / "masks" / f"{frame}.png", 255)
        document["frames"][14 + frame]["mask_path"] = f"masks/{frame}.png"
    (tmp_path / CALIBRATION_FILE).write_text(json.dumps(document), encoding="utf-8")
    before, offset = footage_digest(opened(tmp_path, "2:12")), {}
    if change == "picture":
        size = (tmp_path / "cam_1" / "000004.png").stat().st_size
        assert picture(tmp_path / "cam_1" / "000004.png", 1, 7).stat().st_size == size
    elif change == "mask":
        mask_all(tmp_path / "masks" / "4.png", 0)
    elif change == "offset":
        offset = {"offset": ["cam_1=1"]}
    assert (footage_digest(opened(tmp_path, "2:12", **offset)) == before) == (change == "nothing")


def mask_all(path, level):
    Image.new("L", (WIDTH, HEIGHT), level).save(path)


@pytest.fixture(scope="module")
def projected():
    """Two frames the paper's way."""
    seen = footage(1.0, 0.7)
    return seen, encode_footage(seen, MESH, EncodeOptions(fit="none", textures=3), group="2")


def test_without_a_fit_all_frames_of_a_group_share_the_decomposition_of_their_texture_maps(projected):
    """The weights are the left singular vectors of all frames' maps beside each other, each less its frame's mean."""
    seen, clip = projected
    assert clip.settings["fit"] == "none"
    scenes = [clip.scene(float(time)) for time in clip.timeline.times]
    atlas = make_atlas(scenes[0].proxy.mesh, *clip.settings["atlas"])
    beside = []
    for instant in seen.frames:
        with texture_maps(atlas, clip.rig.cameras, instant) as maps:
            mean = mean_map(maps)
            beside.append(((maps.values - mean.values) * maps.seen[..., None]).reshape(9, -1).astype(np.float64))
    vectors = np.linalg.svd(np.concatenate(beside, axis=1), full_matrices=False)[0][:, :3]
    weights = scenes[0].appearance.planes[0].bases[0].weights / 3  # of unit mean square over nine cameras
    np.testing.assert_allclose(np.abs((vectors * weights).sum(axis=0)), 1, atol=0.01)
    for scene, instant in zip(scenes, seen.frames, strict=True):
        assert measured(scene, instant) > 36
    assert measured(scenes[0], seen.frames[1]) < 20


def test_a_clip_without_a_fit_is_saved_on_the_mesh_and_the_cameras_of_its_maps(projected, tmp_path):
    _, clip = projected
    save(clip, tmp_path / "clip.glb")
    assert validate(tmp_path / "clip.glb") == []
    write_clip_folder(clip, tmp_path / "clip")
    for loaded in map(load_clip, (tmp_path / "clip.glb", tmp_path / "clip")):
        one, other = (found.scene(float(clip.timeline.times[1])) for found in (clip, loaded))
        np.testing.assert_array_equal(one.proxy.mesh.vertices, other.proxy.mesh.vertices)
        drawn = [Renderer(scene).draw(scene.rig.cameras[4], camera_weights(scene, 4)).image for scene in (one, other)]
        np.testing.assert_array_equal(*drawn)


def test_without_a_fit_groups_of_another_mesh_or_other_cameras_are_not_taken_up(tmp_path):
    seen, options = footage(1.0), EncodeOptions(fit="none", textures=2, atlas=64)
    near = replace(MESH, vertices=MESH.vertices + np.float32([0, 0, -0.3]))
    aside = [replace(camera, t=camera.t + np.array([0.05, 0, 0])) for camera in CAMERAS]
    moved = replace(seen, frames=[CalibratedInMemory(seen.frames[0].observations, aside)])
    for film, mesh in ((seen, MESH), (seen, near), (moved, MESH), (seen, MESH)):
        encode_footage(film, mesh, options, work=tmp_path)
    assert len(list((tmp_path / "clip").iterdir())) == 3


@pytest.mark.parametrize("count", [None, pytest.param(2, marks=pytest.mark.slow)])
@pytest.mark.slow
def test_workers_make_the_same_groups(tmp_path, count):
    seen = footage(1.0, 0.8, 0.7, 0.7)
    alone = encode_footage(seen, MESH, OPTIONS, group="2")
    with open_executor(count) as workers:
        seen.asked.clear()
        spread = encode_footage(seen, MESH, OPTIONS, group="2", work=tmp_path, workers=workers)
    assert set(seen.asked[4:]) == {0, 1}  # this process has made the first group alone
    assert list(map(stored_bytes, spread.groups.stored)) == list(map(stored_bytes, alone.groups.stored))


@pytest.mark.slow
def test_a_cluster_makes_the_same_groups_though_one_of_its_workers_is_killed(tmp_path):
    from distributed import Client, LocalCluster

    seen = footage(1.0, 0.8, 0.7, 0.9)
    alone = encode_footage(seen, MESH, OPTIONS, group="1")
    killed = []

    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50) as small,
        Client(small.scheduler_address, set_as_default=False) as client,
        open_executor(cluster=small.scheduler_address) as workers,
    ):
        started = [*client.run(os.getpid).values()]

        def disturb(stage: str, done: int, total: int) -> None:
            if stage == "groups on workers" and done == 1 and not killed:
                os.kill(started[0], signal.SIGKILL)
                killed.append(started[0])

        spread = encode_footage(seen, MESH, OPTIONS, group="1", work=tmp_path, workers=workers, progress=disturb)
        client.wait_for_workers(2, timeout=60)
        assert killed and killed[0] not in client.run(os.getpid).values()
    assert list(map(stored_bytes, spread.groups.stored)) == list(map(stored_bytes, alone.groups.stored))


def test_a_frame_is_decoded_once_and_keeps_its_mask():
    hidden = np.ones((56, 64), np.float32)
    hidden[:, :32] = 0
    pictures = [np.full((56, 64, 3), level / 255, np.float32) for level in range(40, 49)]
    seen = [InMemory(pictures), InMemory(pictures, [hidden if camera == 2 else None for camera in range(9)])]
    with (
        scratch_arrays(2, (9 * 56 * 64, 3), np.uint8) as codes,
        scratch_arrays(2, (9 * 56 * 64,), np.uint8) as masks,
    ):
        kept = KeptPhotographs(CAMERAS, codes, masks)
        first = [kept.frame(place, lambda place=place: seen[place]) for place in range(2)]
        again = [kept.frame(place, lambda place=place: seen[place]) for place in range(2)]
        assert [sorted(one.decoded) for one in seen] == [list(range(9))] * 2
        for before, after in zip(first, again, strict=True):
            np.testing.assert_array_equal(after.codes, before.codes)
            assert after.shapes == before.shapes and after.codes_of(3).min() == after.codes_of(3).max() == 43
        assert again[0].masks is None
        np.testing.assert_array_equal(again[1].mask(2) > 0, hidden > 0)
        assert again[1].mask(3).all()


@pytest.mark.slow
def test_a_run_that_was_stopped_goes_on_after_the_last_finished_frame(tmp_path):
    seen = footage(1.0, 0.7)
    whole = encode_footage(seen, MESH, OPTIONS)

    class StoppedError(Exception):
        pass

    def stop(stage, done, total):
        if stage.endswith("textures-0") and done == 1:
            raise StoppedError

    with pytest.raises(StoppedError):
        encode_footage(seen, MESH, OPTIONS, work=tmp_path, progress=stop)
    names = sorted(one.name[:16] for one in (tmp_path / "clip").iterdir())
    assert [name.rsplit("-", 1)[0] for name in names][:2] == ["mean-00000", "mean-00001"] and len(names) == 3
    seen.asked.clear()
    made = encode_footage(seen, MESH, OPTIONS, work=tmp_path)
    stages = seen.asked[4:]
    assert stages == [1, 0]  # of textures-0 the second alone; what is decoded stays for the passes that follow
    assert made.groups.coded(0).units == whole.groups.coded(0).units


@pytest.mark.parametrize(
    ("given", "code"),
    [
        ({"residual": 40}, "clip-option"),
        ({"harmonise": "gain"}, "clip-option"),
        ({"group": "a while"}, "group-unknown"),
        ({"group": "0"}, "group-unknown"),
        ({"group": "1000s"}, "group-unknown"),
    ],
)
def test_options_without_a_meaning_for_clips_are_refused_by_name(given, code):
    with pytest.raises(OptionError) as error:
        encode_footage(footage(1.0), MESH, **given)
    assert error.value.code == code and next(iter(given)).replace("_", "-") in str(error.value)


def test_sheets_are_refused():
    sheets = Proxy(MESH, sheets=Sheets((len(MESH.faces),), np.ones((8, 8), np.float32)))
    with pytest.raises(OptionError, match="not on sheets") as error:
        encode_clip(footage(1.0), sheets, OPTIONS)
    assert error.value.code == "clip-proxy"


@pytest.mark.parametrize(("text", "frames"), [("1s", 30), ("0.5s", 15), ("12", 12), (" 2s ", 60), ("0.04s", 1)])
def test_the_length_of_a_group(text, frames):
    assert group_length(text, Fraction(30)) == frames


def test_a_time_lapse_has_a_group_for_each_frame():
    assert [group_length(None, Fraction(rate)) for rate in ("1/600", "1/2", "24", "2000")] == [1, 1, 24, 1024]
