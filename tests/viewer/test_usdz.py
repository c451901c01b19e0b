"""A scene for Quick Look: what USD's own readers and validators find in the package."""

from __future__ import annotations

import io
import zipfile

import numpy as np
import pytest
from PIL import Image

from eigenfield.gltf.axes import capture_to_gltf
from eigenfield.imaging.metrics import to_codes
from eigenfield.rendering import mean_texture
from eigenfield.viewer.exports import write_usdz
from support.scenes import tiny_scene
from support.soft_scenes import soft_scene

pytest.importorskip("pxr", reason="needs usd-core: pip install 'eigenfield[usd]'")


def opened(path):
    from pxr import Usd

    return Usd.Stage.Open(str(path))


@pytest.mark.parametrize("make", [tiny_scene, soft_scene, lambda: tiny_scene(channels=1)])
def test_the_validators_of_usd_find_nothing(make, tmp_path):
    from pxr import UsdValidation

    write_usdz(make(), tmp_path / "a.usdz")
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 10
    found = UsdValidation.ValidationContext(validators).Validate(opened(tmp_path / "a.usdz"))
    assert [error.GetErrorAsString() for error in found] == []


def test_mesh_and_mean_are_the_scene_s_upright_and_in_metres(tmp_path):
    from pxr import UsdGeom

    scene = tiny_scene()
    write_usdz(scene, tmp_path / "a.usdz", metres_per_unit=0.25)
    stage = opened(tmp_path / "a.usdz")
    assert UsdGeom.GetStageUpAxis(stage) == "Y" and UsdGeom.GetStageMetersPerUnit(stage) == 0.25
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/scene/proxy_0"))
    turn = capture_to_gltf(scene.rig)
    np.testing.assert_allclose(np.array(mesh.GetPointsAttr().Get()), scene.mesh.vertices @ turn.T, atol=1e-6)
    assert np.array_equal(np.array(mesh.GetFaceVertexIndicesAttr().Get()), scene.mesh.faces.ravel())
    places = np.array(UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st").Get())
    np.testing.assert_allclose(places * [1, -1] + [0, 1], scene.mesh.uv, atol=1e-6)
    with zipfile.ZipFile(tmp_path / "a.usdz") as package:
        assert package.namelist() == ["scene.usdc", "mean.png"]
        assert {entry.compress_type for entry in package.infolist()} == {zipfile.ZIP_STORED}
        picture = np.asarray(Image.open(io.BytesIO(package.read("mean.png"))))
    assert np.array_equal(picture, to_codes(mean_texture(scene)))


def test_sheets_are_meshes_with_an_opacity(tmp_path):
    from pxr import UsdShade

    scene = soft_scene()
    write_usdz(scene, tmp_path / "a.usdz")
    stage = opened(tmp_path / "a.usdz")
    assert [stage.GetPrimAtPath(f"/scene/proxy_{number}").IsValid() for number in range(4)] == [True] * 3 + [False]
    surface = UsdShade.Shader(stage.GetPrimAtPath("/scene/texture/surface"))
    assert surface.GetInput("opacity").HasConnectedSource()


def test_the_same_scene_makes_the_same_bytes(tmp_path):
    for name in ("a.usdz", "b.usdz"):
        write_usdz(tiny_scene(), tmp_path / name)
    assert (tmp_path / "a.usdz").read_bytes() == (tmp_path / "b.usdz").read_bytes()
