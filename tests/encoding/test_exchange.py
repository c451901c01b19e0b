"""Another mesh in a scene: textures stay, bytes stay few, and what cannot be is refused in one line."""

from __future__ import annotations

import logging
from dataclasses import replace

import numpy as np
import pytest

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import mesh_key, size_of
from eigenfield.encoding.geometry.exchange import with_mesh
from eigenfield.gltf import encode_scene, load, save
from eigenfield.rendering import render
from support.coded_scenes import coded_scene
from support.scenes import tiny_scene
from support.soft_scenes import coded_soft_scene


def mesh_bytes(scene):
    return size_of(scene.payloads[mesh_key(scene.mesh)])


@pytest.mark.parametrize("make", [coded_scene, coded_soft_scene])
def test_the_same_mesh_draws_the_same_pictures_in_as_many_bytes(make):
    scene = make()
    made = with_mesh(scene, scene.mesh)
    assert abs(mesh_bytes(made) - mesh_bytes(scene)) < 20 and len(encode_scene(made)) <= len(encode_scene(scene))
    assert made.scores == {} != scene.scores
    np.testing.assert_allclose(render(made).image, render(scene).image, atol=0.02)


def test_a_mesh_is_cut_and_coded(tmp_path, caplog):
    """The right half of the square goes: there the picture is the background, and the left is as it was."""
    scene = coded_scene()
    middle = scene.mesh.vertices[scene.mesh.faces].mean(axis=1)[:, 0]
    made = with_mesh(scene, scene.mesh.part(middle < 0))
    assert len(made.mesh.faces) == (middle < 0).sum()
    with caplog.at_level(logging.INFO, "eigenfield.format"):
        save(made, tmp_path / "half.glb")
    assert "coded anew" not in caplog.text and mesh_bytes(made) < 0.8 * mesh_bytes(scene)
    again = load(tmp_path / "half.glb")
    np.testing.assert_array_equal(again.mesh.vertices, made.mesh.vertices)
    whole, half = render(scene), render(again)
    camera, gone = scene.cameras[scene.rig.reference], scene.mesh.part(middle >= 0)
    end = int(camera.project(made.mesh.vertices)[0][:, 0].max()) + 2
    assert not half.coverage[:, end:].any() and whole.coverage[:, end:].any()
    begin = int(camera.project(gone.vertices)[0][:, 0].min()) - 2
    assert whole.covered[:, :begin].any()
    np.testing.assert_allclose(half.image[:, :begin], whole.image[:, :begin], atol=0.02)


def test_a_mesh_is_moved():
    """Lists and float64 stand for arrays; what is moved to the left is drawn there."""
    scene = tiny_scene()
    vertices = scene.mesh.vertices.astype(np.float64) - (5, 0, 0)
    made = with_mesh(scene, Mesh(vertices, scene.mesh.faces.tolist(), scene.mesh.uv.tolist()))
    np.testing.assert_allclose(made.mesh.vertices[:, 0].mean(), -5, atol=0.01)
    assert made.mesh.vertices.dtype == np.float32 and render(scene).coverage.any() and not render(made).coverage.any()


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda mesh: replace(mesh, uv=None), "proxy-no-uv"),
        (lambda mesh: replace(mesh, uv=mesh.uv[:-1]), "proxy-shape"),
        (lambda mesh: replace(mesh, vertices=mesh.vertices[:, :2]), "proxy-shape"),
        (lambda mesh: replace(mesh, faces=mesh.faces.astype(np.float32)), "proxy-shape"),
        (lambda mesh: replace(mesh, faces=mesh.faces[0]), "proxy-shape"),
        (lambda mesh: Mesh("abc", "d", "e"), "proxy-shape"),
        (lambda mesh: Mesh([[1, 2], [3]], mesh.faces, mesh.uv), "proxy-shape"),
        (lambda mesh: Mesh(1, 2, 3), "proxy-shape"),
        (lambda mesh: replace(mesh, uv=mesh.uv + 1), "proxy-uv"),
        (lambda mesh: replace(mesh, uv=mesh.uv * np.nan), "proxy-uv"),
        (lambda mesh: replace(mesh, faces=mesh.faces + 1), "proxy-index-range"),
        (lambda mesh: replace(mesh, faces=mesh.faces[:0]), "proxy-no-faces"),
        (lambda mesh: replace(mesh, vertices=mesh.vertices * np.inf), "proxy-not-finite"),
    ],
)
def test_what_is_no_mesh_for_the_scene_is_refused(change, code):
    scene = tiny_scene()
    with pytest.raises(ProxyError) as caught:
        with_mesh(scene, change(scene.mesh))
    assert caught.value.code == code and "\n" not in str(caught.value) and caught.value.remedy


def test_sheets_keep_their_triangles():
    scene = coded_soft_scene()
    with pytest.raises(ProxyError, match="keep all of them, in their order") as caught:
        with_mesh(scene, scene.mesh.part(slice(0, 100)))
    assert caught.value.code == "proxy-sheets"
