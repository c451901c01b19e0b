"""Scenes to files and back."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield import gltf as scene_format
from eigenfield.coding import limits
from eigenfield.coding import stacking as pictures
from eigenfield.coding.pictures import quantise
from eigenfield.core.appearance import Basis, Plane
from eigenfield.core.errors import FormatError, OptionError, OutputError
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene
from eigenfield.gltf import save
from eigenfield.runtime import parallel
from support import glb_surgery
from support.scenes import bumpy_square, float_basis, smooth_pictures, tiny_scene

CODECS = ("png", "webp", "avif")


def reloaded(scene: Scene, tmp_path: Path, **options) -> Scene:
    path = tmp_path / "scene.glb"
    scene_format.save(scene, path, overwrite=True, **options)
    assert scene_format.validate(path) == []
    return scene_format.load(path)


def assert_same_but_pictures(a: Scene, b: Scene) -> None:
    np.testing.assert_array_equal(a.proxy.mesh.vertices, b.proxy.mesh.vertices)
    np.testing.assert_array_equal(a.proxy.mesh.faces, b.proxy.mesh.faces)
    np.testing.assert_array_equal(a.proxy.mesh.uv, b.proxy.mesh.uv)
    assert b.proxy.mesh.faces.dtype == np.int32
    assert a.rig.names == b.rig.names
    np.testing.assert_array_equal(a.rig.held_out, b.rig.held_out)
    assert a.rig.reference == b.rig.reference
    for x, y in zip(a.rig.cameras, b.rig.cameras, strict=True):
        x = x.to_float32()
        for name in ("K", "R", "t"):
            np.testing.assert_array_equal(getattr(x, name), getattr(y, name))
            assert getattr(y, name).dtype == np.float64
        assert (x.width, x.height) == (y.width, y.height)
    for name in ("origin", "right", "up", "extent"):
        np.testing.assert_array_equal(getattr(a.rig.view_plane, name), getattr(b.rig.view_plane, name))
    np.testing.assert_array_equal(a.rig.triangles, b.rig.triangles)
    assert b.rig.triangles.dtype == np.int32 and b.rig.triangles.shape[1] == 3
    assert (dict(a.settings), dict(a.scores), a.generator) == (dict(b.settings), dict(b.scores), b.generator)
    for one, two in zip(a.appearance.planes, b.appearance.planes, strict=True):
        assert one.mean.shape == two.mean.shape and two.mean.dtype == np.float32
        for before, after in zip(one.bases, two.bases, strict=True):
            np.testing.assert_array_equal(before.weights, after.weights)
            assert after.textures.dtype == np.uint8 and before.textures.shape == after.textures.shape


@pytest.mark.parametrize("codec", CODECS)
@pytest.mark.parametrize(("channels", "textures"), [(3, 3), (1, 2), (6, 2), (2, 1), (3, 0), (4, 0)])
def test_a_scene_comes_back_as_it_was(tmp_path, codec, channels, textures):
    scene = tiny_scene(channels, textures, cameras=6, held_out=(1, 4))
    back = reloaded(scene, tmp_path, codec=codec)
    assert_same_but_pictures(scene, back)
    lossless = codec != "avif"
    assert np.abs(back.appearance.planes[0].mean - scene.appearance.planes[0].mean).max() <= (
        0.5001 / 255 if lossless else 8 / 255
    )
    before, after = scene.appearance.planes[0].bases[0], back.appearance.planes[0].bases[0]
    if textures:
        error, step = np.abs(after.values() - before.values()), after.scale[:, None, None]
        if lossless:
            assert (error <= 0.501 * step).all()
        else:
            assert np.sqrt(np.square(error / step).mean()) < 3  # codes
        assert error.max() > 0  # codes are not the numbers themselves


@pytest.mark.parametrize("codec", CODECS)
def test_pictures_are_stored_upright_and_in_order(tmp_path, codec):
    scene = tiny_scene(6, 2, size=32)
    ramp = np.linspace(0, 1, 32, dtype=np.float32)
    mean = np.stack([np.tile(ramp * (c + 1) / 6, (24, 1)) for c in range(6)], axis=-1)  # wide, channels all unlike
    mean *= np.linspace(0.5, 1, 24, dtype=np.float32)[:, None, None]
    back = reloaded(
        replace(scene, appearance=replace(scene.appearance, planes=(Plane(mean, ()),))), tmp_path, codec=codec
    )
    assert back.appearance.planes[0].bases == ()
    np.testing.assert_allclose(back.appearance.planes[0].mean, mean, atol=6 / 255)


@pytest.mark.parametrize("codec", ["png", "webp"])
@pytest.mark.parametrize("channels", [1, 3, 5])
def test_saving_a_loaded_scene_again_changes_no_code(tmp_path, codec, channels):
    first = tmp_path / "first.glb"
    save(tiny_scene(channels, 3), first, codec=codec)
    scene = scene_format.load(first)
    again = reloaded(scene, tmp_path, codec=codec)
    for name in ("textures", "scale", "zero"):
        np.testing.assert_array_equal(
            getattr(scene.appearance.planes[0].bases[0], name), getattr(again.appearance.planes[0].bases[0], name)
        )
    np.testing.assert_array_equal(scene.appearance.planes[0].mean, again.appearance.planes[0].mean)
    assert (tmp_path / "scene.glb").read_bytes() == first.read_bytes()


def test_lossless_codecs_hold_the_same_codes(tmp_path):
    scene = tiny_scene(3, 3)
    png, webp = (reloaded(scene, tmp_path, codec=codec).appearance.planes[0] for codec in ("png", "webp"))
    np.testing.assert_array_equal(png.mean, webp.mean)
    np.testing.assert_array_equal(png.bases[0].textures, webp.bases[0].textures)


def test_several_planes_and_bases_of_their_own_sizes(tmp_path):
    scene = tiny_scene(3, 3)
    rows = len(scene.rig.encoded)
    planes = (
        Plane(
            scene.appearance.planes[0].mean, (float_basis(rows, 2, 16, 24, 3), float_basis(rows, 3, 8, 8, 3, seed=5))
        ),
        Plane(
            0.5 + 0.4 * smooth_pictures(1, 20, 12, 2)[0], (float_basis(rows, 0, 8, 8, 2), float_basis(rows, 1, 8, 8, 2))
        ),
    )
    scene = replace(scene, appearance=replace(scene.appearance, planes=planes))
    for codec in CODECS:
        back = reloaded(scene, tmp_path, codec=codec)
        assert_same_but_pictures(scene, back)
        assert back.appearance.textures == 3


def test_a_mean_of_any_range_keeps_it(tmp_path):
    scene = tiny_scene(3, 1)
    mean = np.stack(
        [smooth_pictures(1, 32, 32, 1)[0, ..., 0] * s + o for s, o in ((1, 1e6), (0, -3), (500, 0))], axis=-1
    )
    for codec in CODECS:
        back = reloaded(
            replace(
                scene, appearance=replace(scene.appearance, planes=(Plane(mean, scene.appearance.planes[0].bases),))
            ),
            tmp_path,
            codec=codec,
        )
        bound = np.ptp(mean, axis=(0, 1)) * (0.51 / 255 if codec != "avif" else 12 / 255)
        bound += 1e-5 * np.abs(mean).max(axis=(0, 1)) * (mean.max(axis=(0, 1)) == mean.min(axis=(0, 1)))
        bound[0] = max(bound[0], 0.0625)  # the spacing of float32 numbers at a million
        assert (np.abs(back.appearance.planes[0].mean - mean).max(axis=(0, 1)) <= bound).all()


@given(st.integers(1, 5), st.floats(1e-6, 1e4), st.integers(0, 2**32 - 1), st.booleans())
@settings(max_examples=40)
def test_quantising_textures_never_clips_and_errs_by_half_a_step(count, size, seed, photographic):
    textures = np.random.default_rng(seed).normal(size=(count, 6, 5, 3), scale=size).astype(np.float32)
    ones = np.ones((count, 3), np.float32)
    basis = Basis(textures, ones, 0 * ones, np.zeros((2, count), np.float32))
    scale, zero = quantise.basis_scale(basis, one_unit=photographic)
    assert scale.min(axis=0) == pytest.approx(scale.max(axis=0), rel=0.5001)  # steps within a factor of two
    assert (np.ptp(scale, axis=1).max() == 0) == photographic
    for k in range(count):
        back = (quantise.texture_codes(basis, k, scale, zero) - zero[k]) * scale[k]
        assert (np.abs(back - textures[k]).max(axis=(0, 1)) <= 0.5005 * scale[k]).all()
    nothing = quantise.texture_codes(replace(basis, textures=0 * textures), 0, scale, zero)
    assert (nothing == 128).all()  # zero is a code


def test_textures_with_a_scale_of_their_own_are_coded_by_value():
    stored = smooth_pictures(2, 8, 8, 3)
    scale, zero = np.full((2, 3), 0.5, np.float32), np.full((2, 3), 0.25, np.float32)
    basis = Basis(stored, scale, zero, np.zeros((3, 2), np.float32))
    step, middle = quantise.basis_scale(basis, one_unit=True)
    for k in range(2):
        back = (quantise.texture_codes(basis, k, step, middle) - middle[k]) * step[k]
        np.testing.assert_allclose(back, (stored[k] - 0.25) * 0.5, atol=0.501 * step.max())


@pytest.mark.parametrize("codec", CODECS)
def test_the_bytes_do_not_depend_on_threads(codec):
    scene = tiny_scene(3, 4)
    made = set()
    for count in (1, 2, 3):
        parallel.set_threads(count)
        made.add(scene_format.encode_scene(scene, codec=codec))
    parallel.set_threads(None)
    assert len(made) == 1


def test_quality_costs_bytes_and_gains_accuracy(tmp_path):
    scene = tiny_scene(3, 3, size=64)
    sizes, errors = [], []
    for quality in (20, 60, 95):
        back = reloaded(scene, tmp_path, quality=quality)
        sizes.append(scene_format.parts(tmp_path / "scene.glb")["textures"])
        errors.append(
            float(
                np.square(
                    back.appearance.planes[0].bases[0].values() - scene.appearance.planes[0].bases[0].values()
                ).mean()
            )
        )
    assert sizes == sorted(sizes) and len(set(sizes)) == 3
    assert errors == sorted(errors, reverse=True)


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ({"codec": "jpeg"}, "codec"),
        ({"codec": "png", "quality": 80}, "quality"),
        ({"quality": 101}, "quality"),
        ({"quality": -1}, "quality"),
    ],
)
def test_options_that_cannot_be(tmp_path, options, code):
    with pytest.raises(OptionError) as caught:
        save(tiny_scene(), tmp_path / "scene.glb", **options)
    assert caught.value.code == code and caught.value.remedy
    assert list(tmp_path.iterdir()) == []


def test_saving_is_whole_or_nothing(tmp_path, monkeypatch):
    path = tmp_path / "scene.glb"
    save(tiny_scene(textures=1), path)
    before = path.read_bytes()
    with pytest.raises(OutputError, match="exists already"):
        save(tiny_scene(textures=2), path)
    monkeypatch.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(OutputError) as caught:
        save(tiny_scene(textures=2), path, overwrite=True)
    assert caught.value.code == "disk-full"
    assert path.read_bytes() == before and list(tmp_path.iterdir()) == [path]


def test_over_four_gigabytes_is_refused_before_writing(tmp_path, monkeypatch):
    monkeypatch.setattr(limits, "MAX_FILE", 5000)
    with pytest.raises(OutputError) as caught:
        save(tiny_scene(), tmp_path / "scene.glb", codec="png")
    assert caught.value.code == "file-too-large" and "scene.glb" in str(caught.value)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("limit", "value"),
    [("MAX_CHANNELS", 2), ("MAX_SIDE", 31), ("MAX_TEXELS", 1000), ("MAX_COMPONENTS", 2), ("MAX_CAMERAS", 4),
     ("MAX_VERTICES", 35), ("MAX_TRIANGLES", 49), ("MAX_WEIGHTS", 14), ("MAX_PLANES", 0), ("MAX_JSON", 500),
     ("MAX_DECODED", 10_000)],
)  # fmt: skip
def test_what_no_reader_would_take_is_not_written(tmp_path, monkeypatch, limit, value):
    save(tiny_scene(), tmp_path / "good.glb")
    monkeypatch.setattr(limits, limit, value)
    with pytest.raises(OutputError) as caught:
        save(tiny_scene(), tmp_path / "scene.glb")
    assert caught.value.code == "scene-limit"
    with pytest.raises(FormatError):  # and indeed no reader does
        scene_format.load(tmp_path / "good.glb")


def test_names_that_would_break_a_line_are_refused(tmp_path):
    scene = tiny_scene(cameras=3)
    for name in ("a\nb", "a\x1b[2J", "a\udc80", "x" * 2000):
        with pytest.raises(OutputError, match="cannot be kept"):
            save(replace(scene, rig=replace(scene.rig, names=("one", name, "three"))), tmp_path / "scene.glb")
    good = replace(scene, rig=replace(scene.rig, names=("Bild 1 – ä.jpg", "写真", "a/b")))
    assert reloaded(good, tmp_path).rig.names == good.rig.names


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"rig": {"names": ("one",) * 5}}, "camera-name"),
        ({"rig": {"held_out": np.ones(5, bool)}}, "weights-count"),
        ({"rig": {"triangles": np.array([[0, 1, 5]], np.int32)}}, "view-plane-triangles"),
        ({"settings": {"deep": json.loads("[" * 70 + "]" * 70)}}, "json-depth"),
    ],
)
def test_an_inconsistent_scene_is_not_written(tmp_path, change, code):
    scene = tiny_scene()
    if "rig" in change:
        change = {"rig": replace(scene.rig, **change["rig"])}
    scene = replace(scene, **change)
    if code == "weights-count":
        scene = replace(scene, rig=replace(scene.rig, held_out=np.array([1, 0, 0, 0, 0], bool), reference=1))
    with pytest.raises(FormatError) as caught:
        save(scene, tmp_path / "scene.glb", codec="png")
    assert caught.value.code == code
    assert list(tmp_path.iterdir()) == []


def test_textures_that_are_not_finite_are_a_bug(tmp_path):
    scene = tiny_scene()
    plane = scene.appearance.planes[0]
    basis = replace(plane.bases[0], scale=plane.bases[0].scale * np.inf)
    for broken in (replace(plane, mean=plane.mean * np.nan), replace(plane, bases=(basis,))):
        with pytest.raises(ValueError, match="not finite"):
            save(replace(scene, appearance=replace(scene.appearance, planes=(broken,))), tmp_path / "scene.glb")
    assert list(tmp_path.iterdir()) == []


def test_cameras_on_a_line_have_no_triangles(tmp_path):
    assert reloaded(tiny_scene(cameras=2), tmp_path).rig.triangles.shape == (0, 3)


def test_large_meshes_get_long_indices(tmp_path):
    for nodes, component in ((255, 5123), (256, 5125)):  # 65025 and 65536 vertices
        mesh = bumpy_square(nodes)
        scene = replace(tiny_scene(textures=0), proxy=Proxy(mesh))
        back = reloaded(scene, tmp_path, codec="png")
        np.testing.assert_array_equal(back.proxy.mesh.faces, mesh.faces)
        gltf, _ = glb_surgery.split((tmp_path / "scene.glb").read_bytes())
        assert gltf["accessors"][gltf["meshes"][0]["primitives"][0]["indices"]]["componentType"] == component


@pytest.mark.parametrize("codec", CODECS)
def test_trimesh_shows_the_mean(tmp_path, codec):
    scene = tiny_scene(3, 2, size=48)
    save(scene, tmp_path / "scene.glb", codec=codec)
    loaded = trimesh.load(tmp_path / "scene.glb")
    (mesh,) = loaded.geometry.values()
    assert len(mesh.faces) == len(scene.proxy.mesh.faces)
    shown = np.asarray(mesh.visual.material.baseColorTexture.convert("RGB"), np.float32) / 255
    assert shown.shape == scene.appearance.planes[0].mean.shape
    assert np.abs(shown - scene.appearance.planes[0].mean).mean() < (0.3 if codec == "png" else 3) / 255
    np.testing.assert_allclose(mesh.visual.uv * (1, -1) + (0, 1), scene.proxy.mesh.uv, atol=1e-6)  # trimesh has v up


@pytest.mark.parametrize("channels", [1, 2, 6])
def test_other_attributes_show_something_too(tmp_path, channels):
    scene = tiny_scene(channels, 1)
    scene = replace(
        scene,
        appearance=replace(
            scene.appearance,
            planes=(Plane(scene.appearance.planes[0].mean * 40 - 7, scene.appearance.planes[0].bases),),
        ),
    )
    save(scene, tmp_path / "scene.glb", codec="png")
    (mesh,) = trimesh.load(tmp_path / "scene.glb").geometry.values()
    assert np.ptp(np.asarray(mesh.visual.material.baseColorTexture.convert("L"))) > 100


def test_a_photographs_mean_that_overshoots_is_cut_and_others_are_not(tmp_path):
    scene = tiny_scene(3, 1)
    mean = scene.appearance.planes[0].mean
    mean = (mean - mean.min()) / np.ptp(mean) * np.float32(1.1) - np.float32(0.05)
    assert quantise.is_photographic(mean)
    for codec in ("png", "webp"):
        back = reloaded(
            replace(
                scene, appearance=replace(scene.appearance, planes=(Plane(mean, scene.appearance.planes[0].bases),))
            ),
            tmp_path,
            codec=codec,
        )
        np.testing.assert_allclose(back.appearance.planes[0].mean, mean.clip(0, 1), atol=0.501 / 255)
    grey = mean[..., :1]
    back = reloaded(
        replace(
            tiny_scene(1, 1),
            appearance=replace(
                tiny_scene(1, 1).appearance, planes=(Plane(grey, tiny_scene(1, 1).appearance.planes[0].bases),)
            ),
        ),
        tmp_path,
        codec="png",
    )
    np.testing.assert_allclose(back.appearance.planes[0].mean, grey, atol=0.501 * np.ptp(grey) / 255)


def test_the_preview_is_small(tmp_path):
    scene = tiny_scene(3, 0)
    mean = np.tile(scene.appearance.planes[0].mean, (20, 32, 1))  # 640 high, 1024 wide
    path = tmp_path / "scene.glb"
    save(replace(scene, appearance=replace(scene.appearance, planes=(Plane(mean, ()),))), path, codec="webp")
    (mesh,) = trimesh.load(path).geometry.values()
    assert mesh.visual.material.baseColorTexture.size == (512, 320)
    assert scene_format.load(path).appearance.planes[0].mean.shape == mean.shape


def test_files_written_interleaved_by_other_tools_are_read(tmp_path):
    path = tmp_path / "scene.glb"
    scene = tiny_scene(3, 1)
    save(scene, path, codec="png")

    def interleave(gltf, extension, binary):
        both = np.hstack([scene.proxy.mesh.vertices, scene.proxy.mesh.uv]).astype("<f4").tobytes()
        gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(both), "byteStride": 20})
        binary += both
        gltf["buffers"][0]["byteLength"] = len(binary)
        attributes = gltf["meshes"][0]["primitives"][0]["attributes"]
        for name, offset in (("POSITION", 0), ("TEXCOORD_0", 12)):
            gltf["accessors"][attributes[name]] |= {"bufferView": len(gltf["bufferViews"]) - 1, "byteOffset": offset}

    path.write_bytes(glb_surgery.changed(path.read_bytes(), interleave))
    back = scene_format.load(path)
    np.testing.assert_array_equal(back.proxy.mesh.vertices, scene.proxy.mesh.vertices)
    np.testing.assert_array_equal(back.proxy.mesh.uv, scene.proxy.mesh.uv)
    assert {f.code for f in scene_format.validate(path)} == {"view-unused"}


def test_progress_counts_the_pictures():
    seen = []
    scene_format.encode_scene(tiny_scene(3, 3), progress=lambda *step: seen.append(step))
    assert seen == [("code textures", done, 4) for done in range(5)]


def test_a_newer_minor_version_is_read(tmp_path):
    path = tmp_path / "scene.glb"
    save(tiny_scene(), path)
    path.write_bytes(glb_surgery.changed(path.read_bytes(), lambda g, e, b: e.update(version="1.99")))
    assert scene_format.load(path).rig.names == tiny_scene().rig.names
    assert [(f.severity, f.code) for f in scene_format.validate(path)] == [("information", "newer-version")]


def test_pictures_carry_no_colour_profile(tmp_path):
    codes = np.zeros((4, 4, 3), np.uint8)
    for codec in CODECS:
        assert b"ICC" not in pictures.encode(codes, codec, 80).upper().replace(b"ICCP", b"ICC")


def test_importing_the_room_stays_light():
    heavy = "numba cv2 matplotlib av trimesh xatlas skimage rich"
    code = f"import sys, eigenfield.gltf; print([m for m in {heavy.split()!r} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_scene_whose_mesh_has_other_dtypes_is_written_as_float32(tmp_path):
    mesh = bumpy_square()
    wide = Mesh(mesh.vertices.astype(np.float64), mesh.faces.astype(np.int64), mesh.uv.astype(np.float64))
    back = reloaded(replace(tiny_scene(), proxy=Proxy(wide)), tmp_path)
    np.testing.assert_array_equal(back.proxy.mesh.vertices, mesh.vertices)
