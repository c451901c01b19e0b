"""Two eyes: where their pictures agree, by how much they differ, what half a sphere shows, what players are told."""

from __future__ import annotations

import struct
from dataclasses import replace
from fractions import Fraction

import av
import numpy as np
import pytest
from PIL import Image

from eigenfield.core.appearance import Appearance, Plane
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.gltf import save
from eigenfield.rendering import RenderJob, write_video
from eigenfield.rendering.spherical import vr_boxes
from eigenfield.rendering.stereo import Baseline, Eyes, half_sphere_side, write_stereo
from support import viewer_scenes
from support.clips import numbered_clip
from support.sounds import opus

DISTANCE = 3.0  # from the cameras' plane
NONE = {"textures": 0}


def wall(scene, distance=DISTANCE, half=4.0):
    """The scene as a flat, finely painted square before its cameras, which look along +z from z = -3."""
    corners = np.array([[-half, -half], [half, -half], [-half, half], [half, half]])
    vertices = np.column_stack([corners, np.full(4, distance - 3)]).astype(np.float32)
    mesh = Mesh(
        vertices, np.array([[0, 1, 2], [2, 1, 3]], np.int32), ((corners + half) / (2 * half)).astype(np.float32)
    )
    rows, columns = np.mgrid[:512, :512]
    mean = np.stack([np.sin(columns / 5) / 4, np.sin(rows / 7) / 4, np.sin((rows + columns) / 9) / 4], axis=2) + 0.5
    (basis,) = scene.appearance.planes[0].bases
    return replace(scene, proxy=Proxy(mesh), appearance=Appearance((Plane(mean.astype(np.float32), (basis,)),)))


@pytest.fixture(scope="module")
def scene():
    return wall(viewer_scenes.scene())


def eyes_of(scene, layout="side-by-side", part=0.25):
    return Eyes.of(scene, layout, Baseline(part))


def test_a_wall_at_the_depth_of_no_parallax_looks_the_same_to_both(scene):
    eyes = eyes_of(scene)
    assert eyes.depth == pytest.approx(DISTANCE, rel=1e-6)
    for at in ((0, 0), (0.6, -0.4), (1, 1)):
        both = eyes.pixels(RenderJob(scene, **NONE), at)
        assert both.shape == (240, 640, 3) and both.std() > 20
        assert np.abs(both[:, :320].astype(int) - both[:, 320:]).mean() < 0.5


@pytest.mark.parametrize("nearer", [0.5, -0.5])
def test_what_is_nearer_is_shifted_by_focal_length_times_baseline_times_disparity(scene, nearer):
    """f B (1 / z - 1 / Z) pixels between the eyes for a wall at z, where Z has no parallax."""
    focal, width = scene.rig.cameras[0].K[0, 0], 2 * float(scene.rig.view_plane.extent[0])
    wanted = 12  # pixels
    other = 1 / (1 / DISTANCE - np.sign(nearer) * 1 / (2 * DISTANCE))
    part = wanted / (focal * width * abs(1 / DISTANCE - 1 / other))
    eyes = replace(eyes_of(scene, part=part), depth=other)
    both = eyes.pixels(RenderJob(scene, **NONE), (0, 0)).astype(int)
    left, right = both[:, :320], both[:, 320:]
    shift = wanted if nearer > 0 else -wanted  # what is nearer lies further right for the left eye
    moved = np.roll(left, -shift, axis=1)
    assert np.abs(moved - right)[:, 20:-20].mean() < 1 < 5 < np.abs(left - right)[:, 20:-20].mean()


def test_the_left_eye_is_left_or_above(scene):
    job = RenderJob(scene, **NONE, resolution=(64, 48))
    beside = replace(eyes_of(scene), depth=30.0).pixels(job, (0, 0))
    above = replace(eyes_of(scene, "top-bottom"), depth=30.0).pixels(job, (0, 0))
    assert beside.shape == (48, 128, 3) and above.shape == (96, 64, 3)
    np.testing.assert_array_equal(beside[:, :64], above[:48])
    np.testing.assert_array_equal(beside[:, 64:], above[48:])


def test_both_eyes_stay_within_the_array(scene):
    eyes = eyes_of(scene, part=0.5)
    job = RenderJob(scene, **NONE)
    np.testing.assert_array_equal(eyes.pixels(job, (1, 0)), eyes.pixels(job, (0.5, 0)))
    np.testing.assert_array_equal(eyes.pixels(job, (-0.7, 0)), eyes.pixels(job, (-0.5, 0)))


def test_the_reach_is_the_angle_of_the_array(scene):
    width, height, apart = eyes_of(scene).reach(scene)
    assert width == height == pytest.approx(2 * np.degrees(np.arctan(0.8 / 3)))  # five cameras 0.4 apart
    assert apart == pytest.approx(2 * np.degrees(np.arctan(0.25 * 0.8 / 3)))


def test_by_default_the_eyes_are_a_fifth_of_the_array_apart_and_at_most_three_degrees(scene):
    assert Eyes.of(scene, "side-by-side").reach(scene)[2] == pytest.approx(3)
    far = wall(scene, 30.0, 40.0)
    assert Eyes.of(far, "side-by-side").part == 0.2


def test_half_a_sphere_has_each_direction_where_it_lies(scene):
    """By longitude and latitude: the wall's paint, in the direction of the pixel."""
    side = 256
    eyes = eyes_of(scene, "vr180", 0.001)
    both = eyes.pixels(RenderJob(scene, **NONE, resolution=(side, side)), (0, 0))
    assert both.shape == (side, 2 * side, 3)
    mean = scene.appearance.planes[0].mean
    for longitude, latitude in ((0, 0), (10, 5), (-18, -8), (20, 12)):
        lon, lat = np.radians([longitude, latitude])
        ray = np.array([np.cos(lat) * np.sin(lon), -np.sin(lat), np.cos(lat) * np.cos(lon)])
        x, y = ray[:2] / ray[2] * DISTANCE
        texel = mean[int((y + 4) / 8 * 512), int((x + 4) / 8 * 512)]
        row, column = int((0.5 - latitude / 180) * side), int((longitude / 180 + 0.5) * side)
        np.testing.assert_allclose(both[row, column] / 255, texel, atol=0.12)
    seen = both[side // 2, :side].any(axis=1)
    reach = np.degrees(np.arctan(160 / 330))  # of a photograph, to either side
    assert seen.sum() == pytest.approx(2 * reach / 180 * side, abs=2) and seen[side // 2]


def test_the_middle_of_half_a_sphere_is_as_fine_as_the_photographs(scene):
    camera = scene.rig.cameras[0]
    assert half_sphere_side(camera) == 1040  # pi * 330 and up to a multiple of 16
    assert half_sphere_side(camera.resize(32000, 24000)) == 2880


@pytest.mark.parametrize(
    ("baseline", "words"),
    [
        (Baseline(0.0), "0 of the array's width apart"), (Baseline(1.5), "1.5 of the array's width apart"),
        (Baseline(0.9, True), "900 mm apart do not stand within the array, which is 800 mm wide"),
    ],
)  # fmt: skip
def test_eyes_wider_apart_than_the_array_are_refused(scene, baseline, words):
    with pytest.raises(OptionError, match=words) as caught:
        Eyes.of(scene, "side-by-side", baseline)
    assert caught.value.code == "baseline" and "\n" not in str(caught.value)


def test_a_baseline_in_metres_needs_a_scene_that_knows_them(scene):
    assert Baseline(0.2, True).part(scene) == pytest.approx(0.2 / 0.8)  # a unit of the scene is half a metre
    with pytest.raises(OptionError, match="does not know its metres") as caught:
        Baseline(0.2, True).part(replace(scene, settings={}))
    assert caught.value.code == "baseline"


def test_cameras_around_a_thing_and_unknown_layouts_are_refused(scene):
    for given, layout, code in ((viewer_scenes.around(), "vr180", "array-side"), (scene, "anaglyph", "stereo")):
        with pytest.raises(OptionError) as caught:
            Eyes.of(given, layout, Baseline(0.2))
        assert caught.value.code == code


# ---- what players are told


def boxes(data, start=0, end=None):
    """(name, content) of the boxes in a part of a file."""
    end = len(data) if end is None else end
    while start < end:
        size, name = struct.unpack_from(">I4s", data, start)
        assert 8 <= size <= end - start
        yield name, data[start + 8 : start + size]
        start += size


def inner(data, *names):
    for name in names:
        data = next(content for found, content in boxes(data) if found == name)
    return data


def entry_boxes(film):
    """The boxes at the end of the description of the pictures."""
    stsd = inner(film, b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stsd")
    ((name, entry),) = boxes(stsd[8:])
    assert name == b"avc1"
    return dict(boxes(entry[78:]))


@pytest.mark.parametrize(("layout", "mode"), [("side-by-side", 2), ("top-bottom", 1), ("vr180", 2)])
def test_a_film_says_that_it_is_stereo(scene, tmp_path, layout, mode):
    path = tmp_path / "film.mp4"
    job = RenderJob(scene, **NONE, resolution=(64, 64))
    write_stereo([(job, (0.0, 0.0)), (job, (0.3, 0.0))], 2, eyes_of(scene, layout), path, Fraction(10))
    found = entry_boxes(path.read_bytes())
    assert found[b"st3d"] == bytes(4) + bytes([mode])
    assert (b"sv3d" in found) == (layout == "vr180")
    with av.open(path) as film:
        frames = [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
    assert len(frames) == 2 and frames[0].shape == ((128, 64, 3) if layout == "top-bottom" else (64, 128, 3))


def test_half_a_sphere_says_which_half(scene, tmp_path):
    write_video(tmp_path / "a.mp4", [np.zeros((32, 64, 3), np.uint8)] * 3, Fraction(10), boxes=vr_boxes("vr180"))
    sphere = entry_boxes((tmp_path / "a.mp4").read_bytes())[b"sv3d"]
    assert inner(sphere, b"svhd") == bytes(4) + b"eigenfield\0"
    assert inner(sphere, b"proj", b"prhd") == bytes(16)
    assert struct.unpack(">IIIII", inner(sphere, b"proj", b"equi")) == (0, 0, 0, 1 << 30, 1 << 30)


def test_boxes_are_in_the_track_of_the_pictures_where_there_is_sound(tmp_path):
    pictures = [np.zeros((32, 64, 3), np.uint8)] * 8
    for sound in (None, (opus(1.0), 0.0)):
        write_video(tmp_path / "a.mp4", pictures, Fraction(10), sound=sound, boxes=vr_boxes("vr180"), overwrite=True)
        assert {b"st3d", b"sv3d"} <= set(entry_boxes((tmp_path / "a.mp4").read_bytes()))
    with av.open(str(tmp_path / "a.mp4")) as film:
        assert [stream.type for stream in film.streams] == ["video", "audio"]
        assert len(list(film.decode(video=0))) == 8


def test_the_same_film_with_and_without_boxes_has_the_same_pictures(tmp_path):
    pictures = [np.full((32, 64, 3), value, np.uint8) for value in (10, 120, 230)]
    write_video(tmp_path / "a.mp4", pictures, Fraction(10))
    write_video(tmp_path / "b.mp4", pictures, Fraction(10), boxes=vr_boxes("vr180"))
    found = []
    for name in "ab":
        with av.open(tmp_path / f"{name}.mp4") as film:
            found.append([frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)])
    np.testing.assert_array_equal(*found)


# ---- the command


@pytest.fixture(scope="module")
def file(scene, tmp_path_factory):
    path = tmp_path_factory.mktemp("stereo") / "scene.glb"
    save(scene, path, codec="png")
    return path


def test_a_picture_and_a_path_and_the_reach_in_degrees(run, file, tmp_path):
    code, _, err = run("render", file, "--stereo", "side-by-side", "--baseline", "63mm", "-o", tmp_path / "a.png")
    assert code == 0 and "the array reaches 29.9 x 29.9 degrees, the eyes are 2.4 apart" in err
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (640, 240)
    words = ["--path", "circle", "--frames", 2, "--resolution", "64x48", "--stereo", "top-bottom"]
    assert run("render", file, *words, "-o", tmp_path / "b%d.png").code == 0
    with Image.open(tmp_path / "b1.png") as picture:
        assert picture.size == (64, 96)
    code, _, err = run("render", file, *words[:-1], "vr180", "-o", tmp_path / "c.mp4")
    assert code == 0 and "photographs fill 52 x 40 of 180 degrees" in err
    assert b"sv3d" in (tmp_path / "c.mp4").read_bytes()
    assert run("render", file, "--camera", "view_0_0", "--stereo", "vr180", "--background", "transparent",
               "--resolution", "64x64", "-o", tmp_path / "d.png").code == 0  # fmt: skip


def test_a_clip_over_time(run, tmp_path):
    clip = numbered_clip((2, 1))
    save(clip, tmp_path / "clip.glb")
    words = ["--time", "0:2", "--stereo", "side-by-side", "--resolution", "48x40"]
    code, _, err = run("render", tmp_path / "clip.glb", *words, "-o", tmp_path / "a.mp4")
    assert code == 0 and "2 pictures" in err, err
    with av.open(tmp_path / "a.mp4") as film:
        assert film.streams.video[0].average_rate == clip.timeline.rate and len(list(film.decode(video=0))) == 2


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--stereo", "side-by-side", "--baseline", "2"], "eyes 2 of the array's width apart do not stand within"),
        (["--stereo", "side-by-side", "--baseline", "1m"], "eyes 1000 mm apart do not stand within the array"),
        (["--stereo", "anaglyph"], "no stereo is called anaglyph"),
        (["--baseline", "0.1"], "--baseline needs --stereo"),
        (["--stereo", "vr180", "--residual"], "only captured views have a residual"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line(run, file, tmp_path, words, said):
    code, _, err = run("render", file, *words, "-o", tmp_path / "a.png")
    assert code == 2 and said in err and len(err.strip().splitlines()) == 1 and not list(tmp_path.iterdir())


@pytest.mark.parametrize("baseline", ["wide", "", "-1", "1e9", "nan", "5 feet"])
def test_a_baseline_is_a_number_or_a_length(run, file, tmp_path, baseline):
    code, _, err = run("render", file, "--stereo", "vr180", "--baseline", baseline, "-o", tmp_path / "a.png")
    assert code == 2 and "a part of the array's width, as 0.2, or a length, as 63mm" in err
