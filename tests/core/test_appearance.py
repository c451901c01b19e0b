"""The number of eigen textures: one definition for the library, the commands and the viewer."""

from __future__ import annotations

import json
from dataclasses import replace

from eigenfield.core.appearance import Appearance
from eigenfield.gltf import save
from eigenfield.rendering import RenderJob, viewpoint
from support.scenes import tiny_scene


def test_the_number_of_eigen_textures_is_that_of_the_largest_basis(run, tmp_path):
    scene = tiny_scene()
    (plane,) = scene.appearance.planes
    (basis,) = plane.bases
    two = replace(plane, bases=(basis, basis.truncate(basis.count - 1)))
    scene = replace(scene, appearance=Appearance((two,)))
    assert scene.appearance.textures == basis.count
    camera, weights = viewpoint(scene, at=(0.2, 0.1))
    whole = RenderJob(scene).rgb(camera, weights)
    assert (RenderJob(scene, textures=basis.count).rgb(camera, weights) == whole).all()
    assert (RenderJob(scene, textures=basis.count - 1).rgb(camera, weights) != whole).any()
    path = tmp_path / "scene.glb"
    save(scene, path)
    assert json.loads(run("info", path, "--json").out)["textures"] == basis.count
    assert f"eigen textures: {basis.count} of " in run("info", path).out
