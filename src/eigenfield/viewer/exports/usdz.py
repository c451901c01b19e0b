"""The proxy with its mean as a .usdz, for Quick Look and programs that read USD."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import numpy as np

from eigenfield.core.arguments import checked
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.scene import Scene, scale_of
from eigenfield.core.version import __version__
from eigenfield.gltf.axes import capture_to_gltf
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.png import png_bytes
from eigenfield.rendering import mean_texture
from eigenfield.runtime.files import atomic_files
from eigenfield.runtime.temporary import temporary_folder
from eigenfield.viewer.exports.glb import mesh_parts
from eigenfield.viewer.exports.maps import alpha_added

USDZ_TIME_SECONDS = 631_152_000  # of the files in the package, 1990: the same scene makes the same bytes
PICTURE_FILE, LAYER_FILE = "mean.png", "scene.usdc"


@checked
def write_usdz(scene: Scene, output: Path, *, metres_per_unit: float | None = None, overwrite: bool = False) -> None:
    """Write the proxy with its mean, which shines by itself, Y up. Sheets are meshes, back to front, with an opacity.

    Args:
        metres_per_unit: Metres in one unit of the capture; None: as the scene says, or else one.

    Raises:
        OptionError: `usd-missing`, `not-a-picture`.
        OutputError: The file cannot be written.
    """
    check_usd()
    codes = to_codes(alpha_added(scene)(mean_texture(scene)))
    scale = scale_of(scene, metres_per_unit)
    with temporary_folder() as folder, atomic_files([output], overwrite=overwrite) as (place,):
        (folder / PICTURE_FILE).write_bytes(png_bytes(codes))
        _write_layer(scene, folder / LAYER_FILE, scale, codes.shape[2] == 4)
        _pack(folder, place)


def check_usd() -> None:
    """Before any work: check that USD can be written. OptionError `usd-missing`."""
    try:
        import pxr  # noqa: F401
    except ImportError:
        remedy = "pip install 'eigenfield[usd]'"
        raise OptionError("usd-missing", "usd-core is not installed", remedy=remedy) from None


def _write_layer(scene: Scene, path: Path, scale: float, alpha: bool) -> None:
    """The file of a stage with the meshes; scale: metres in a unit; alpha: whether the picture has opacity."""
    from pxr import Sdf, Usd, UsdGeom, UsdShade

    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, scale)
    stage.SetMetadata("comment", f"eigenfield {__version__}")
    stage.GetRootLayer().customLayerData = scene.rights.said
    root = UsdGeom.Xform.Define(stage, "/scene")
    stage.SetDefaultPrim(root.GetPrim())
    material = UsdShade.Material.Define(stage, "/scene/texture")
    places = UsdShade.Shader.Define(stage, "/scene/texture/places")
    places.CreateIdAttr("UsdPrimvarReader_float2")
    places.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
    picture = UsdShade.Shader.Define(stage, "/scene/texture/mean")
    picture.CreateIdAttr("UsdUVTexture")
    picture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(PICTURE_FILE)
    picture.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("sRGB")
    for side in ("wrapS", "wrapT"):
        picture.CreateInput(side, Sdf.ValueTypeNames.Token).Set("clamp")
    found = places.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    picture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(found)
    surface = UsdShade.Shader.Define(stage, "/scene/texture/surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    surface.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set((0.0, 0.0, 0.0))
    surface.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(1.0)
    colour = picture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)
    surface.CreateInput("emissiveColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(colour)
    if alpha:
        opacity = picture.CreateOutput("a", Sdf.ValueTypeNames.Float)
        surface.CreateInput("opacity", Sdf.ValueTypeNames.Float).ConnectToSource(opacity)
    shaded = surface.CreateOutput("surface", Sdf.ValueTypeNames.Token)
    material.CreateSurfaceOutput().ConnectToSource(shaded)
    turn = capture_to_gltf(scene.rig)
    for number, part in enumerate(mesh_parts(scene.proxy)):
        turned = Mesh((part.vertices.astype(np.float64) @ turn.T).astype(np.float32), part.faces, part.uv)
        made = UsdGeom.Mesh.Define(stage, f"/scene/proxy_{number}")
        _fill(made, turned)
        UsdShade.MaterialBindingAPI.Apply(made.GetPrim()).Bind(material)
    stage.GetRootLayer().Save()


def _fill(made: object, mesh: Mesh) -> None:
    """A mesh of USD; v is upwards there."""
    from pxr import Sdf, UsdGeom, Vt

    assert mesh.uv is not None and isinstance(made, UsdGeom.Mesh)
    made.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(mesh.vertices))
    made.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(mesh.faces), 3, np.int32)))
    made.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(mesh.faces.astype(np.int32).ravel()))
    made.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(np.stack([mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)])))
    made.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    made.CreateDoubleSidedAttr(True)
    up = np.column_stack([mesh.uv[:, 0], 1 - mesh.uv[:, 1]]).astype(np.float32)
    places = UsdGeom.PrimvarsAPI(made).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex)
    places.Set(Vt.Vec2fArray.FromNumpy(up))


def _pack(folder: Path, place: Path) -> None:
    """A package of the layer and its picture, which is made where names are UTF-8, as USD wants them."""
    from pxr import Sdf

    made = folder / "scene.usdz"
    for name in (LAYER_FILE, PICTURE_FILE):
        os.utime(folder / name, (USDZ_TIME_SECONDS, USDZ_TIME_SECONDS))
    with Sdf.ZipFileWriter.CreateNew(str(made)) as writer:
        for name in (LAYER_FILE, PICTURE_FILE):
            writer.AddFile(str(folder / name), name)
    shutil.copyfile(made, place)
