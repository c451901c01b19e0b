"""What a scene was coded to travels in it: what was not edited keeps its bytes, what was is coded anew and said."""

from __future__ import annotations

import copy
import logging
import multiprocessing
import pickle
from dataclasses import replace

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.core.payloads import Payloads, cameras_key, mean_key, mesh_key, size_of, textures_key, weights_key
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene
from eigenfield.gltf import encode_scene, read_scene, save, store_scores
from eigenfield.gltf.cached import cached_payloads
from eigenfield.rendering import renderer_of, view_weights
from support.coded_scenes import coded, precise_scene
from support.scenes import bumpy_square, tiny_scene


@pytest.fixture(scope="module")
def data():
    """A file of which everything is coded: mesh, cameras, mean, eigen textures and weights."""
    return encode_scene(
        coded(replace(tiny_scene(3, 4, 9, 64), proxy=Proxy(bumpy_square(40))), np.arange(9).reshape(3, 3))
    )


@pytest.fixture
def scene(data):
    return read_scene(data)


def of_the_same_arrays(scene):
    """Every object of it is another, and every array is a copy."""
    planes = []
    for plane in scene.appearance.planes:
        bases = tuple(
            replace(basis, textures=basis.textures.copy(), weights=basis.weights.copy()) for basis in plane.bases
        )
        planes.append(replace(plane, mean=plane.mean.copy(), bases=bases))
    cameras = tuple(replace(camera, K=camera.K.copy()) for camera in scene.rig.cameras)
    return replace(
        scene,
        proxy=Proxy(replace(scene.proxy.mesh, uv=scene.proxy.mesh.uv.copy())),
        rig=replace(scene.rig, cameras=cameras),
        appearance=replace(scene.appearance, planes=tuple(planes)),
    )


@pytest.mark.parametrize(
    "way",
    [
        lambda scene: scene,
        copy.copy,
        copy.deepcopy,
        lambda scene: pickle.loads(pickle.dumps(scene)),
        lambda scene: replace(scene, scores=dict(scene.scores)),
        lambda scene: replace(scene, proxy=Proxy(replace(scene.proxy.mesh))),
        of_the_same_arrays,
    ],
    ids=["itself", "copy", "deepcopy", "pickle", "replace", "replace-mesh", "same-arrays"],
)
def test_what_is_not_edited_keeps_its_bytes(scene, data, way, tmp_path, caplog):
    path = tmp_path / "scene.glb"
    made = way(scene)
    assert isinstance(made, Scene)
    with caplog.at_level(logging.INFO, "eigenfield.format"):
        save(made, path)
    assert path.read_bytes() == data
    assert "coded anew" not in caplog.text


def test_another_process_keeps_the_bytes(scene, data):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(encode_scene, [scene]) == data


def keys(scene):
    """The keys of the parts of a scene of one plane and basis, by their names."""
    (plane,) = scene.appearance.planes
    (basis,) = plane.bases
    return {
        "mesh": mesh_key(scene.proxy.mesh),
        "cameras": cameras_key(scene.rig.cameras),
        "planes[0].mean": mean_key(plane.mean),
        "planes[0].bases[0].textures": textures_key(basis),
        "planes[0].bases[0].weights": weights_key(basis.weights),
    }


def basis_of(scene):
    return scene.appearance.planes[0].bases[0]


def edit_mesh(scene):
    scene.proxy.mesh.vertices[0, 0] += 0.25


def edit_cameras(scene):
    scene.rig.cameras[2].t[1] += 0.25


def edit_mean(scene):
    scene.appearance.planes[0].mean[3, 4] += 0.25


def edit_textures(scene):
    basis_of(scene).textures[1, 5, 6] += 1


def edit_weights(scene):
    basis_of(scene).weights[2, 1] += 0.25


@pytest.mark.parametrize(
    ("part", "edit", "plain"),
    [
        ("mesh", edit_mesh, lambda scene: 4 * 5 * len(scene.proxy.mesh.vertices) + 2 * 3 * len(scene.proxy.mesh.faces)),
        ("cameras", edit_cameras, lambda scene: 4 * 17 * 9),
        ("planes[0].mean", edit_mean, None),
        ("planes[0].bases[0].textures", edit_textures, None),
        ("planes[0].bases[0].weights", edit_weights, lambda scene: 4 * 9 * 4),
    ],
)
def test_what_is_edited_in_place_alone_is_coded_anew(scene, part, edit, plain, tmp_path, caplog):
    before = {name: scene.payloads[key] for name, key in keys(scene).items()}
    assert all(before.values())
    edit(scene)
    with caplog.at_level(logging.INFO, "eigenfield.format"):
        save(scene, tmp_path / "scene.glb")
    back = ef.load(tmp_path / "scene.glb")
    after = {name: back.payloads.get(key, ()) for name, key in keys(back).items()}
    for name in before.keys() - {part}:
        assert [one.data for one in after[name]] == [one.data for one in before[name]], name
    if plain is None:  # pictures of 8 bits
        assert after[part] and {one.codec for one in after[part]} == {"avif"}
        now = size_of(after[part])
    else:  # plain numbers
        assert after[part] == ()
        now = plain(scene)
    had = size_of(before[part])
    (record,) = caplog.records
    assert record.getMessage() == f"{tmp_path / 'scene.glb'}: coded anew: {part} ({now:,} bytes, it had {had:,})"
    assert record.levelno == (logging.WARNING if now > had else logging.INFO)


def test_plain_numbers_are_those_that_were_edited(scene, tmp_path):
    edit_mesh(scene)
    edit_weights(scene)
    save(scene, tmp_path / "scene.glb")
    back = ef.load(tmp_path / "scene.glb")
    np.testing.assert_array_equal(back.proxy.mesh.vertices, scene.proxy.mesh.vertices)
    np.testing.assert_array_equal(basis_of(back).weights, basis_of(scene).weights)


def test_an_edit_that_is_undone_costs_nothing(scene, data):
    whole = scene.proxy.mesh.vertices.copy()
    edit_mesh(scene)
    assert encode_scene(scene) != data
    scene.proxy.mesh.vertices[:] = whole
    assert encode_scene(scene) == data


def test_one_plane_of_two_is_replaced(tmp_path, caplog):
    scene = read_scene(encode_scene(precise_scene()))
    first, second = scene.appearance.planes
    changed = replace(
        scene, appearance=replace(scene.appearance, planes=(first, replace(second, mean=second.mean * np.float32(0.5))))
    )
    with caplog.at_level(logging.INFO, "eigenfield.format"):
        save(changed, tmp_path / "scene.glb")
    assert caplog.text.count("planes[") == 1 and "coded anew: planes[1].mean (" in caplog.text
    kept = cached_payloads(changed)
    assert kept.lost == {"planes[1].mean": size_of(scene.payloads[mean_key(second.mean)])}
    assert kept.one("planes[0].mean") is scene.payloads[mean_key(first.mean)][0]
    assert len(kept.pictures("planes[1].bases[0].textures")) == 2
    other = replace(
        scene, appearance=replace(scene.appearance, planes=(second, first))
    )  # in another order all are found
    assert not cached_payloads(other).lost


def test_fewer_textures_are_coded_anew_and_the_rest_is_kept(scene):
    (plane,) = scene.appearance.planes
    fewer = replace(
        scene, appearance=replace(scene.appearance, planes=(replace(plane, bases=(basis_of(scene).truncate(2),)),))
    )
    kept = cached_payloads(fewer)
    assert kept.lost.keys() == {"planes[0].bases[0].textures", "planes[0].bases[0].weights"}
    assert kept.payloads.keys() == {"mesh", "cameras", "planes[0].mean"}
    assert read_scene(encode_scene(fewer)).appearance.textures == 2


def test_a_codec_that_is_asked_for_is_no_edit(scene, tmp_path, caplog):
    with caplog.at_level(logging.INFO, "eigenfield.format"):
        save(scene, tmp_path / "scene.glb", codec="png")
    assert "coded anew" not in caplog.text
    back = ef.load(tmp_path / "scene.glb")
    assert (
        mesh_key(back.proxy.mesh) in scene.payloads
        and back.payloads[mean_key(back.appearance.planes[0].mean)][0].codec == "png"
    )


def test_a_scene_that_was_never_coded_says_nothing(tmp_path, caplog):
    scene = tiny_scene()
    assert type(scene) is Scene
    with caplog.at_level(logging.INFO, "eigenfield.format"):
        save(scene, tmp_path / "scene.glb")
        save(replace(ef.load(tmp_path / "scene.glb"), proxy=Proxy(bumpy_square(5))), tmp_path / "other.glb")
    assert "coded anew" not in caplog.text  # the file held the mesh as plain numbers


def test_scores_that_are_stored_change_no_payload(data, tmp_path):
    path = tmp_path / "scene.glb"
    path.write_bytes(data)
    before = ef.load(path).scores
    store_scores(path, {"psnr": 40})
    back = ef.load(path)
    assert back.scores == {"psnr": 40} and encode_scene(replace(back, scores=before)) == data


def test_payloads_cannot_be_changed(scene):
    assert isinstance(scene.payloads, Payloads) and not hasattr(scene.payloads, "__setitem__")
    more = scene.payloads | {("mean", b"other"): []}
    assert len(more) == len(scene.payloads) + 1
    assert len({mean_key(np.zeros((4, 4, 1), dtype)) for dtype in (np.float32, np.float64)}) == 2
    assert len({mean_key(np.zeros(shape, np.float32)) for shape in ((4, 4, 1), (2, 8, 1), (0, 8, 1))}) == 3


def test_what_is_derived_is_kept_as_long_as_the_object(scene):
    renderer = renderer_of(scene)
    view_weights(scene, (0.2, 0.1))
    assert renderer_of(scene) is renderer
    for other in (copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene)), replace(scene)):
        assert renderer_of(other) is not renderer
        np.testing.assert_array_equal(view_weights(other, (0.2, 0.1)).values, view_weights(scene, (0.2, 0.1)).values)
