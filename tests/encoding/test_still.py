"""A clip without a mesh: the surface is that of photographs averaged over time, and what passes leaves none."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.capture import open_footage
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.proxy import opaque_mesh
from eigenfield.encoding import encode_footage
from eigenfield.encoding.clip.still import MAX_FRAMES, frames_of_still, still_capture, still_photograph
from eigenfield.gltf import load_clip
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import read_mesh
from eigenfield.reconstruction.whole import reconstruct
from eigenfield.runtime.stages import Stages
from support.changing import PICTURE, changed_frames
from support.moving_clips import FootageInMemory
from support.passing import FRAMES, SIDE, SQUARE, WALL, write_passing

COUNT = 11


def filmed(change, noise=0.0):
    """Codes of COUNT frames, after `change(number, pixels)`."""
    return np.stack([to_codes(pixels) for pixels in changed_frames(change, COUNT, noise)])


def off(pixels):
    """Grey levels between pixels and the picture without what moves."""
    return np.abs(pixels - PICTURE).max(axis=2) * 255


def test_what_passes_goes_and_noise_falls():
    def passing(number, pixels):
        pixels[20:40, 7 * number : 7 * number + 12] = 0.95

    codes = filmed(passing, noise=2.0)
    found = still_photograph(codes, [None] * COUNT, 5)
    assert off(codes[5] / 255)[22:38, 37:45].min() > 10 and found.mask is None
    assert np.std(found.pixels - PICTURE) * 255 < 1.3 * np.hypot(2 / np.sqrt(COUNT - 3), 0.29)


@pytest.mark.parametrize(("frames", "goes"), [(range(4, 8), True), (range(3, 9), False)])
def test_most_frames_say_what_stands_still(frames, goes):
    def parked(number, pixels):
        if number in frames:
            pixels[20:40, 30:50] = 0.95

    found = still_photograph(filmed(parked), [None] * COUNT, 5)
    apart = off(found.pixels)[25:35, 35:45]
    assert apart.max() < 1 if goes else np.ptp(found.pixels[25:35, 35:45]) < 1 / 255


def test_what_never_stands_still_is_as_in_the_middle_frame():
    def waving(number, pixels):
        pixels[20:40, 30:50] = 0.1 + 0.08 * number

    codes = filmed(waving)
    found = still_photograph(codes, [None] * COUNT, 4)
    np.testing.assert_allclose(found.pixels[18:42, 28:52], codes[4, 18:42, 28:52] / 255, atol=0.6 / 255)


def test_a_camera_without_a_middle_frame_has_what_stands_still_in_others():
    def passing(number, pixels):
        pixels[20:40, 7 * number : 7 * number + 12] = 0.95

    hidden, always = np.zeros((60, 80), np.float32), np.ones((60, 80), np.float32)
    always[:, :10] = 0
    codes = filmed(passing)
    found = still_photograph(codes, [hidden if number == 5 else always for number in range(COUNT)], 5)
    assert not found.mask[:, :10].any() and found.mask[:, 16:].min() == 1
    assert off(found.pixels)[:, 16:].max() < 1


@pytest.mark.parametrize("count", [1, 3, 14, 15, 16, 300])
def test_frames_are_spread_and_have_the_middle_one_among_them(count):
    frames = frames_of_still(FootageInMemory([None] * count, []))
    assert frames[0] == 0 and frames[-1] == count - 1 and count // 2 in frames
    assert len(frames) in (min(count, MAX_FRAMES), min(count, MAX_FRAMES + 1))


@pytest.fixture(scope="module")
def passing(tmp_path_factory):
    return write_passing(tmp_path_factory.mktemp("passing") / "footage")


def depths(mesh, camera):
    """Of a mesh in the middle of a camera's picture, where the square is in the middle frame."""
    inverse = rasterise_view(mesh, camera).inverse_depth
    return 1 / inverse[SIDE // 2 - 12 : SIDE // 2 + 12, SIDE // 2 - 8 : SIDE // 2 + 8]


def test_the_surface_is_the_wall_where_a_square_passes(passing, tmp_path):
    footage = open_footage(passing)
    camera = footage.cameras[4]
    middle = reconstruct(footage.instant(FRAMES // 2), layers=1, progress=None)
    assert np.median(depths(middle.proxy.mesh, camera)) == pytest.approx(SQUARE, rel=0.1)
    still = still_capture(footage, Stages(tmp_path))
    assert still.names == footage.names and still.sizes == footage.sizes
    made = reconstruct(still, layers=1, progress=None)
    np.testing.assert_allclose(depths(made.proxy.mesh, camera), WALL, rtol=0.05)


@pytest.mark.parametrize("known", [True, False])
def test_a_middle_frame_that_is_missing_and_cameras_that_are_not_known(passing, tmp_path, known):
    folder = tmp_path / "footage"
    shutil.copytree(passing, folder)
    (folder / "cam_1_1" / f"{FRAMES // 2:06d}.png").unlink()
    if not known:
        (folder / "transforms.json").unlink()
    footage, whole = open_footage(folder), open_footage(passing)
    assert footage.held[4, FRAMES // 2] and not footage.instant(FRAMES // 2).photograph(4).mask.any()
    still, better = (still_capture(one, Stages(tmp_path)) for one in (footage, whole))
    assert (still.light_field is not None) == known and still.names == whole.names
    seen = still.photograph(4)
    counts = np.ones((SIDE, SIDE), bool) if seen.mask is None else seen.mask > 0.5
    assert counts.mean() > 0.95
    assert np.abs(seen.pixels - better.photograph(4).pixels)[counts].mean() < 1 / 255


@pytest.mark.slow
def test_a_clip_without_a_mesh_goes_on_where_it_was_stopped(passing, tmp_path):
    class StoppedError(Exception):
        pass

    said = []

    def stop(stage, done, total):
        said.append(stage)
        if stage.startswith("group 1"):
            raise StoppedError

    footage, options = open_footage(passing), ef.EncodeOptions(preset="small", group="2")
    few = footage.part(2, 6)
    with pytest.raises(StoppedError):
        encode_footage(few, options=options, work=tmp_path, progress=stop)
    assert "averaging over time" in said
    assert {"still", "array", "relief"} <= {path.name.split("-")[0] for path in tmp_path.iterdir()}
    said.clear()
    clip = encode_footage(few, options=options, work=tmp_path, progress=lambda stage, done, total: said.append(stage))
    assert "averaging over time" not in said and not any("depth" in stage for stage in said)
    assert clip.timeline.frames == 4 and list(clip.groups.lengths) == [2, 2]


@pytest.mark.slow
def test_one_command_makes_a_clip_and_proxy_makes_the_same_surface(passing, tmp_path, run):
    small = tmp_path / "footage"
    shutil.copytree(passing, small)
    words = (small, "--clip", "0:7:1")
    result = run("encode", *words, "--preset", "small", "--group", "7", "-o", tmp_path / "clip.glb")
    assert result.code == 0 and "7 frames" in result.out, result
    clip = load_clip(tmp_path / "clip.glb")
    mesh = opaque_mesh(clip.scene(0.0).proxy)
    np.testing.assert_allclose(depths(mesh, clip.scene(0.0).rig.cameras[4]), WALL, rtol=0.05)
    result = run("proxy", *words, "-o", tmp_path / "mesh.ply")
    assert result.code == 0, result
    np.testing.assert_allclose(
        depths(read_mesh(tmp_path / "mesh.ply"), open_footage(small).cameras[4]), WALL, rtol=0.05
    )


@pytest.mark.parametrize("words", [("--surface", "layers"), ("--layers", "4")])
def test_sheets_are_not_for_clips(passing, tmp_path, run, words):
    code, _, err = run("encode", passing, "--clip", *words, "-o", tmp_path / "clip.glb", "-v")
    assert code == 2 and "a clip is encoded on one opaque surface, not on sheets; leave out the layers" in err
    with pytest.raises(OptionError) as error:
        encode_footage(open_footage(passing), surface_options=ef.SurfaceOptions(layers=2))
    assert error.value.code == "clip-proxy"


def test_two_cameras_make_no_surface(tmp_path):
    footage = open_footage(write_passing(tmp_path / "footage", cameras=2))
    with pytest.raises(CaptureError):
        encode_footage(footage, progress=None)


def test_cameras_that_are_not_known(passing, tmp_path):
    bare = tmp_path / "bare"
    shutil.copytree(passing, bare)
    (bare / "transforms.json").unlink()
    with pytest.raises(OptionError) as error:
        encode_footage(open_footage(bare), progress=None)
    assert error.value.code == "clip-cameras"
