"""Fly-throughs and the `render` verb: where paths go, what films hold, what stays on disk."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from PIL import Image

import eigenfield as ef
from eigenfield.core.errors import EigenfieldError
from eigenfield.gltf import save
from eigenfield.rendering import path_points, write_video
from eigenfield.rendering.video import yuv420
from support.scenes import tiny_scene


@pytest.fixture(scope="module")
def glb(tmp_path_factory):
    path = tmp_path_factory.mktemp("a scene") / "scène.glb"
    save(tiny_scene(cameras=9, held_out=(4,)), path, codec="png")
    return path


@pytest.fixture
def render(run):
    """The verb; EigenfieldErrors come through."""
    return lambda *words: run("render", *words, "--traceback")


def decoded(path):
    import av

    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        return stream, [frame.to_ndarray(format="yuv420p") for frame in container.decode(stream)]


def test_a_circle_is_closed_a_spiral_ends_at_its_rim_a_grid_goes_to_and_fro():
    circle = path_points("circle", 60)
    np.testing.assert_allclose(np.linalg.norm(circle, axis=1), 0.9)
    np.testing.assert_allclose(circle.mean(axis=0), 0, atol=1e-12)
    spiral = np.linalg.norm(path_points("spiral", 60), axis=1)
    assert spiral[0] == 0 and spiral[-1] == pytest.approx(0.9) and (np.diff(spiral) > 0).all()
    grid = path_points("grid", 61)
    np.testing.assert_allclose(grid[[0, -1]], [[-0.9, 0.9], [0.9, -0.9]])
    assert len(np.unique(np.sign(np.diff(grid[:, 0])))) == 3  # right, left, and straight down between rows


def test_one_frame_is_enough():
    for name in ("circle", "spiral", "grid"):
        assert path_points(name, 1).shape == (1, 2)


def test_colours_become_those_of_bt709():
    """White, black and the primaries, from the standard's own table (limited range)."""
    known = {
        (255, 255, 255): (235, 128, 128), (0, 0, 0): (16, 128, 128), (255, 0, 0): (63, 102, 240),
        (0, 255, 0): (173, 42, 26), (0, 0, 255): (32, 240, 118),
    }  # fmt: skip
    for colour, (y, cb, cr) in known.items():
        planes = yuv420(np.full((4, 6, 3), colour, np.uint8))
        for plane, value in zip(planes, (y, cb, cr), strict=True):
            assert (plane == value).all(), colour


def test_chroma_sits_on_the_left_of_two_columns():
    """A step in colour between columns 3 and 4 weighs a quarter on the chroma sample at column 4."""
    picture = np.zeros((2, 8, 3), np.uint8)
    picture[:, 4:, 2] = 255
    cb = yuv420(picture)[1][0].astype(float)
    np.testing.assert_array_equal(cb[[0, 1, 3]], [128, 128, 240])
    assert cb[2] == pytest.approx(128 + 0.75 * 112, abs=0.5)


def test_a_film_holds_its_pictures_and_is_the_same_every_time(tmp_path):
    y, x = np.mgrid[:33, :47]
    pictures = [np.stack([(3 * x + 9 * i) % 256, (5 * y) % 256, x + y], -1).astype(np.uint8) for i in range(12)]
    for name in ("a.mp4", "b.mp4"):
        write_video(tmp_path / name, iter(pictures), Fraction(24000, 1001))
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()
    stream, frames = decoded(tmp_path / "a.mp4")
    assert (stream.width, stream.height, len(frames)) == (48, 34, 12)  # odd sizes gain a row and a column
    assert stream.average_rate == Fraction(24000, 1001)
    context = stream.codec_context
    assert (context.colorspace, context.color_primaries, context.color_trc, context.color_range) == (1, 1, 1, 1)
    for frame, picture in zip(frames, pictures, strict=True):
        luma = yuv420(picture)[0].astype(float)
        assert np.abs(frame[:34].astype(float) - luma).mean() < 3


def test_an_interrupted_film_leaves_nothing(tmp_path):
    def interrupted():
        yield np.zeros((32, 32, 3), np.uint8)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_video(tmp_path / "film.mp4", interrupted(), Fraction(30))
    assert list(tmp_path.iterdir()) == []


def test_the_verb_draws_what_the_library_draws(glb, tmp_path, render):
    scene = ef.load(glb)
    render(glb, "-o", tmp_path / "a.png", "--at", "0.3,-0.2", "--resolution", "64x50", "-q")
    picture = np.asarray(Image.open(tmp_path / "a.png"))
    np.testing.assert_array_equal(picture, ef.render(scene, at=(0.3, -0.2), resolution=(64, 50)).to_uint8())
    render(glb, "-o", tmp_path / "b.png", "-q")
    reference = ef.render(scene, camera=scene.rig.names[scene.rig.reference])
    np.testing.assert_array_equal(np.asarray(Image.open(tmp_path / "b.png")), reference.to_uint8())


def test_backgrounds_are_a_colour_or_transparent(glb, tmp_path, render):
    small = ("--at", "0,0", "--resolution", "48x40", "-q")
    render(glb, "-o", tmp_path / "red.png", "--background", "#ff0080", *small)
    render(glb, "-o", tmp_path / "clear.png", "--background", "transparent", "--samples", 2, *small)
    red, clear = np.asarray(Image.open(tmp_path / "red.png")), np.asarray(Image.open(tmp_path / "clear.png"))
    assert tuple(red[0, 0]) == (255, 0, 128) and clear.shape == (40, 48, 4)
    alpha = clear[..., 3]
    assert alpha[0, 0] == 0 and alpha[20, 24] == 255 and ((alpha > 0) & (alpha < 255)).any()
    covered = (alpha == 255) & (red != [255, 0, 128]).any(axis=2)
    assert np.abs(clear[covered][:, :3].astype(int) - red[covered]).mean() < 4  # red for red, not blue for red


def test_one_channel_makes_grey_pictures(tmp_path, render):
    save(tiny_scene(channels=1), tmp_path / "grey.glb", codec="png")
    render(tmp_path / "grey.glb", "-o", tmp_path / "a.png", "-q", "--background", "transparent")
    render(tmp_path / "grey.glb", "-o", tmp_path / "b.png", "-q")
    for name, mode in (("a.png", "LA"), ("b.png", "L")):
        with Image.open(tmp_path / name) as picture:
            assert picture.mode == mode


def test_a_path_makes_a_film_or_numbered_pictures(glb, tmp_path, render):
    render(glb, "-o", tmp_path / "way.mp4", "--path", "spiral", "--frames", 5, "--fps", 12, "-q")
    stream, frames = decoded(tmp_path / "way.mp4")
    assert len(frames) == 5 and stream.average_rate == 12
    render(glb, "-o", tmp_path / "%03d.png", "--path", "grid", "--frames", 3, "-q")
    assert sorted(path.name for path in tmp_path.glob("*.png")) == ["000.png", "001.png", "002.png"]


MISTAKES = [
    (("-o", "a.jpg"), "name it so"),
    (("-o", "a.png", "--path", "circle"), "%04d"),
    (("-o", "a.mp4"), "--path"),
    (("-o", "%02d.png"), "--path"),
    (("-o", "a.png", "--at", "0,0", "--camera", "view_00"), "one of them"),
    (("-o", "a.png", "--frames", "3"), "path"),
    (("-o", "a.mp4", "--path", "circle", "--background", "transparent"), "colour"),
    (("-o", "a.mp4", "--path", "zigzag"), "circle"),
    (("-o", "a.mp4", "--path", "circle", "--frames", "0"), "1 or more"),
    (("-o", "a.png", "--camera", "view_99"), "view_0"),
    (("-o", "a.png", "--weights", "nearest"), "nearest3"),
    (("-o", "a.png", "--filter", "lanczos"), "bicubic"),
    (("-o", "nowhere/a.png"), "create"),
]


@pytest.mark.parametrize(("arguments", "remedy"), MISTAKES, ids=[" ".join(a) for a, _ in MISTAKES])
def test_mistakes_are_named_with_their_remedy_and_leave_nothing(glb, tmp_path, monkeypatch, arguments, remedy, render):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(EigenfieldError) as caught:
        render(glb, *arguments)
    assert remedy in caught.value.remedy and "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "arguments", [("--at", "1;2"), ("--resolution", "big"), ("--background", "red"), ("--fps", "0"), ("--fps", "x")]
)
def test_options_that_cannot_be_read_are_refused(glb, tmp_path, arguments, render):
    assert render(glb, "-o", tmp_path / "a.png", *arguments).code == 2
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_overwritten_unasked(glb, tmp_path, render):
    for name in ("a.png", "b.mp4", "001.png"):
        (tmp_path / name).write_bytes(b"precious")
        output = "%03d.png" if name == "001.png" else name
        path = () if name == "a.png" else ("--path", "circle", "--frames", 2)
        with pytest.raises(EigenfieldError, match="exists already"):
            render(glb, "-o", tmp_path / output, *path)
        assert (tmp_path / name).read_bytes() == b"precious"
        assert render(glb, "-o", tmp_path / output, *path, "--overwrite", "-q").code == 0
        assert (tmp_path / name).read_bytes() != b"precious"
