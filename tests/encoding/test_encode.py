"""The whole way: capture and proxy in, scene out, drawn again."""

from __future__ import annotations

import logging
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import eigenfield as ef
import reference
from eigenfield.capture import open_capture
from eigenfield.core.appearance import Appearance, Basis, Plane
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.proxy import Proxy
from eigenfield.core.rig import Rig
from eigenfield.core.viewplane import fit_view_plane
from eigenfield.encoding.atlas import make_atlas
from eigenfield.encoding.projected.eigen import eigen_textures, eigenvectors, gram_matrix, weights_of
from eigenfield.encoding.projected.mean import filled_map, mean_map
from eigenfield.encoding.projected.project import texture_map, texture_maps
from eigenfield.encoding.spread import make_spreader
from eigenfield.gltf import save
from eigenfield.rendering import camera_weights, delaunay_triangles, renderer_of
from eigenfield.runtime.parallel import set_threads
from support.captures import write_capture
from support.observations import InMemory
from support.scenes import row_grid


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return write_capture(tmp_path_factory.mktemp("capture with space") / "nine")


@pytest.fixture(scope="module")
def capture(folder):
    return open_capture(folder)


@pytest.fixture(scope="module")
def scene(folder, capture):
    return ef.encode(capture, proxy=folder / "proxy.ply", textures=8, density=2.0, fit="none")


def psnr(a, b, covered):
    return -10 * np.log10(np.mean(np.square(a - b)[covered]))


def test_all_textures_redraw_the_photographs(capture, scene):
    """What is left is resampling."""
    assert len(capture.views) == 9
    for index, view in enumerate(capture.views):
        photograph = capture.photograph(index).pixels
        picture = ef.render(scene, camera=view.name)
        assert psnr(picture.image, photograph, picture.coverage > 0.5) > 38


def test_a_dense_atlas_does_not_blur_what_is_drawn(folder, capture):
    """However many texels a pixel covers, a captured view at its own size needs one sample, away from edges; half the
    size four."""
    dense = ef.encode(capture, proxy=folder / "proxy.ply", textures=8, density=3.0, fit="none")
    name = capture.views[4].name
    smooth, one, four = (ef.render(dense, camera=name, samples=samples) for samples in (None, 1, 2))
    inside = smooth.coverage == 1
    assert inside.mean() > 0.5
    np.testing.assert_allclose(smooth.image[inside], one.image[inside], atol=1e-3)
    assert np.abs(four.image[inside] - one.image[inside]).max() > 0.01
    half = {"camera": name, "resolution": (32, 28)}
    np.testing.assert_array_equal(ef.render(dense, **half).image, ef.render(dense, **half, samples=2).image)


def test_fewer_textures_are_worse_and_the_mean_is_worst(capture, scene):
    errors = []
    for count in (0, 1, 3, 8):
        drawn = [ef.render(scene, camera=view.name, textures=count) for view in capture.views]
        errors.append(
            np.mean([psnr(d.image, capture.photograph(i).pixels, d.coverage > 0.5) for i, d in enumerate(drawn)])
        )
    assert errors == sorted(errors) and errors[-1] > errors[0] + 6


def test_scene_is_what_the_reference_makes_of_the_maps(folder, capture, scene):
    """Equations 1 to 6 on the very maps: mean, textures and weights at the chart texels."""
    height, width = scene.appearance.planes[0].mean.shape[:2]
    atlas = make_atlas(scene.proxy.mesh, width, height)
    maps = [texture_map(atlas, c, capture.photograph(i).pixels) for i, c in enumerate(scene.rig.cameras)]
    T, v = np.stack([m[0] for m in maps]).astype(float), np.stack([m[1] for m in maps])
    mean, textures, weights = reference.decomposition(T, v, 8)
    seen = v.any(axis=0)
    flat = scene.appearance.planes[0].mean.reshape(-1, 3)[atlas.texel]
    np.testing.assert_allclose(flat[seen], mean[seen], atol=1e-5)
    basis = scene.appearance.planes[0].bases[0]
    for index in range(4):  # later ones are nearly equal in size, their order is noise
        made = basis.textures[index].reshape(-1, 3)[atlas.texel]
        assert np.abs(made - textures[index])[seen].max() < 1e-4 * np.abs(textures[index]).max() + 1e-6
        np.testing.assert_allclose(basis.weights[:, index], weights[:, index], atol=1e-3)
    filled = reference.filled_maps(T, v)
    whole = mean + np.einsum("cj,jnk->cnk", weights, textures)
    assert np.abs(whole - filled).max() * 255 < 1e-3


def test_saved_and_loaded_it_draws_the_same(scene, tmp_path):
    save(scene, tmp_path / "scene.glb", codec="png")
    again = ef.load(tmp_path / "scene.glb")
    assert again.rig.names == scene.rig.names and again.settings["atlas"] == scene.settings["atlas"]
    for at in ((0, 0), (0.4, -0.7)):
        difference = np.abs(ef.render(again, at=at).image - ef.render(scene, at=at).image)
        assert difference.max() * 255 < 6 and difference.mean() * 255 < 1


def test_same_bytes_at_any_number_of_threads(folder, capture, tmp_path):
    files = []
    for count in (1, 2):
        set_threads(count)
        try:
            made = ef.encode(capture, proxy=folder / "proxy.ply", textures=5, atlas=64, align=True, fit="none")
            save(made, tmp_path / f"{count}.glb")
        finally:
            set_threads(None)
        files.append((tmp_path / f"{count}.glb").read_bytes())
    assert files[0] == files[1]


@pytest.mark.parametrize("channels", [1, 6])
def test_other_attributes_than_colour(folder, capture, tmp_path, channels):
    """Maps of any number of channels, encoded, saved, loaded, put together again (the paper's "other attributes")."""
    mesh, cameras = read(folder), [view.camera for view in capture.views]
    atlas = make_atlas(mesh, 64, 64)

    photographs = [capture.photograph(index).pixels for index in range(len(capture))]
    pictures = [np.concatenate([pixels, 2 * pixels - 5], axis=2)[..., :channels].copy() for pixels in photographs]
    with texture_maps(atlas, cameras, InMemory(pictures), channels) as maps:
        mean = mean_map(maps)
        weights = weights_of(eigenvectors(gram_matrix(maps, mean)), 8)
        textures = eigen_textures(maps, mean, weights)
        spread = make_spreader(atlas, mean.seen)
        expected = np.stack([filled_map(maps.values[c], maps.seen[c], mean.values) for c in range(9)])[:, mean.seen]
    ones = np.ones((8, channels), np.float32)
    basis = Basis(np.stack([spread(texture) for texture in textures]), ones, 0 * ones, weights)
    plane = fit_view_plane(cameras)
    triangles = delaunay_triangles(plane.coordinates([camera.centre for camera in cameras]))
    made = ef.Scene(
        proxy=Proxy(mesh=mesh),
        rig=Rig(
            names=tuple(capture.names),
            cameras=tuple(cameras),
            held_out=np.zeros(9, bool),
            reference=4,
            view_plane=plane,
            triangles=triangles,
        ),
        appearance=Appearance(planes=(Plane(spread(mean.values), (basis,)),)),
    )
    save(made, tmp_path / "attributes.glb", codec="png")
    again = ef.load(tmp_path / "attributes.glb").appearance.planes[0]
    assert again.mean.shape == (64, 64, channels)
    for camera in range(9):
        whole = reference.texture(again.mean, again.bases[0].values(), again.bases[0].weights[camera])
        error = whole.reshape(-1, channels)[atlas.texel][mean.seen] - expected[camera]
        assert np.sqrt(np.square(error).mean()) < 0.01 * np.ptp(expected)


def test_held_out_cameras_take_no_part(folder, capture, tmp_path):
    """The file is the same whatever the held-out photographs show."""
    kept = ef.encode(capture, proxy=folder / "proxy.ply", textures=2, atlas=64, hold_out="odd", fit="none")
    assert kept.rig.held_out.sum() == 5 and kept.appearance.planes[0].bases[0].weights.shape == (4, 2)
    assert not kept.rig.held_out[kept.rig.reference]
    alone = ef.encode(
        capture.subset(np.flatnonzero(~kept.rig.held_out).tolist()), proxy=folder / "proxy.ply", textures=2, atlas=64,
        fit="none",
    )  # fmt: skip
    np.testing.assert_array_equal(alone.appearance.planes[0].mean, kept.appearance.planes[0].mean)
    np.testing.assert_array_equal(
        alone.appearance.planes[0].bases[0].textures, kept.appearance.planes[0].bases[0].textures
    )
    held = int(np.flatnonzero(kept.rig.held_out)[0])
    weights = camera_weights(kept, held)
    assert weights.rows.max() < 4 and weights.values.sum() == pytest.approx(1)
    picture = renderer_of(kept).draw(kept.rig.cameras[held], weights)
    photograph = capture.photograph(held).pixels
    assert psnr(picture.image, photograph, picture.coverage > 0.5) > 20


def test_cameras_on_a_line_are_no_error(tmp_path):
    K = np.array([[50.0, 0, 32], [0, 50, 28], [0, 0, 1]])
    line = tuple(Camera(K, np.eye(3), -np.array([0.3 * i - 0.6, 0, -3.0]), 64, 56) for i in range(5))
    folder = write_capture(tmp_path / "line", line)
    made = ef.encode(open_capture(folder), proxy=folder / "proxy.ply", textures=4, atlas=64)
    assert made.rig.view_plane.is_line and len(made.rig.triangles) == 0
    save(made, tmp_path / "line.glb")
    left, middle = ef.render(ef.load(tmp_path / "line.glb"), at=(-0.9, 0)), ef.render(made, at=(-0.9, 0.8))
    assert np.abs(left.image - middle.image).mean() * 255 < 3


@pytest.mark.parametrize(
    ("change", "says"),
    [({"textures": -1}, "0 or more"), ({"uv_ssim": 1.5}, "in \\(0, 1\\]"), ({"harmonise": "best"}, "gain"),
     ({"reference": "lost.png"}, "no camera is called lost"), ({"atlas": 0}, "from 1 to"),
     ({"density": 0.0, "atlas": None}, "ask for one between"), ({"hold_out": "every:0"}, "2 or more"),
     ({"hold_out": "odd", "reference": "view_01.png"}, "is held out")],
)  # fmt: skip
def test_impossible_options_are_refused(folder, capture, change, says):
    with pytest.raises(ef.OptionError, match=says):
        ef.encode(capture, proxy=folder / "proxy.ply", **{"atlas": 64, **change})


def test_a_proxy_in_another_frame_is_refused(folder, capture):
    mesh = ef.Mesh(*(lambda m: (m.vertices * [1, 1, -1] - [0, 0, 9], m.faces, m.uv))(read(folder)))
    with pytest.raises(ef.ProxyError) as caught:
        ef.encode(capture, proxy=ef.Mesh(mesh.vertices.astype(np.float32), mesh.faces, mesh.uv), atlas=64)
    assert caught.value.code == "proxy-not-seen"


def read(folder):
    from eigenfield.proxy import read_mesh

    return read_mesh(folder / "proxy.ply")


def test_a_world_far_from_its_origin_is_said(caplog):
    from eigenfield.encoding.prepare import _warn_of_rounding

    far = np.array([500_000.37, 4_000_000.61, 100.0])
    cameras = [Camera(c.K, c.R, c.t - c.R @ far, c.width, c.height) for c in row_grid(4)]
    mesh = ef.Mesh((np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]) + far).astype(np.float32), np.array([[0, 1, 2]]))
    with caplog.at_level(logging.WARNING):
        _warn_of_rounding(cameras, [camera.to_float32() for camera in cameras], mesh)
    assert "origin" in caplog.text


@pytest.mark.slow
def test_the_real_size_is_kept_where_it_is_known(capture, folder, tmp_path):
    proxy = folder / "proxy.ply"
    assert "metresPerUnit" not in ef.encode(capture, proxy=proxy, textures=0).settings
    save(ef.encode(capture, proxy=proxy, textures=0, metres_per_unit=0.01), tmp_path / "scene.glb")
    assert ef.load(tmp_path / "scene.glb").settings["metresPerUnit"] == 0.01
    in_metres = replace(capture, format="hci", layout=SimpleNamespace(measured=True, subset=lambda chosen: None))
    assert ef.encode(in_metres, proxy=proxy, textures=0).settings["metresPerUnit"] == 1.0
    assert ef.encode(in_metres, proxy=proxy, textures=0, metres_per_unit=2.0).settings["metresPerUnit"] == 2.0
    for wrong in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(OptionError, match="a number above 0"):
            ef.encode(capture, proxy=proxy, metres_per_unit=wrong)


def test_uv_ssim_takes_the_fewest_textures_that_reach_it(folder, capture):
    for target in (0.9, 0.97, 0.999):
        made = ef.encode(capture, proxy=folder / "proxy.ply", atlas=64, uv_ssim=target, fit="none")
        count = made.appearance.textures
        assert ef.evaluate(made, capture)["uv"]["ssim"] >= target or count == 8
        if count > 1:
            fewer = ef.encode(capture, proxy=folder / "proxy.ply", atlas=64, textures=count - 1, fit="none")
            assert ef.evaluate(fewer, capture)["uv"]["ssim"] < target


@pytest.mark.parametrize(
    ("fit", "stages"),
    [("none", {"texture maps", "mean", "inner products", "eigen textures"}),
     ("photographs", {"photographs", "fit luma", "fit chroma", "code luma", "code chroma"})],
)  # fmt: skip
def test_progress_is_told_from_start_to_end(folder, capture, fit, stages, tmp_path):
    """In a work folder that is not there yet, too."""
    reported = {}
    ef.encode(
        capture, proxy=folder / "proxy.ply", atlas=64, textures=2, fit=fit, work=tmp_path / "new" / "work",
        progress=lambda stage, done, total: reported.setdefault(stage, []).append((done, total)),
    )  # fmt: skip
    assert stages <= set(reported)
    for steps in reported.values():
        assert steps[0][0] == 0 and steps[-1][0] == steps[-1][1]
