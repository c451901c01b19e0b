"""The proxy as Wavefront OBJ with the mean as its texture, and the eigen textures beside it for other programs.

Axes are the .glb's: x right, y up, the array looking along -z. OBJ counts v upwards, the scene downwards.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.quantise import MAX_OFFSET_CODES, ZERO_CODE, basis_scale, texture_codes
from eigenfield.core.appearance import Basis
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.core.version import __version__
from eigenfield.gltf.axes import capture_to_gltf
from eigenfield.gltf.write_geometry import NODE_DIGITS, write_nodes
from eigenfield.imaging.png import png_bytes
from eigenfield.rendering import mean_texture
from eigenfield.rendering.options import check_textures
from eigenfield.rendering.weights import encoded_places
from eigenfield.runtime.files import atomic_files
from eigenfield.runtime.parallel import parallel_stream
from eigenfield.viewer.exports.folder import atomic_folder, write_listing
from eigenfield.viewer.exports.maps import alpha_added, eigen_maps
from eigenfield.viewer.exports.names import file_name

CodedPicture = tuple[bytes, NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]
OBJ_SUM_NOTE = "texture = mean / 255 + sum over j of weight[camera][j] * (code[j] - zero[j]) * scale[j]"


def write_obj(scene: Scene, output: Path, *, overwrite: bool = False) -> None:
    """Write NAME.obj with NAME.mtl and NAME.png, the mean clipped to 0..1, beside it; all three or none. The picture of
    sheets has their opacity as alpha.

    Raises:
        OptionError: `not-a-picture`.
        OutputError: A file cannot be written.
    """
    mean = png_bytes(alpha_added(scene)(mean_texture(scene)))
    targets = obj_files(output)
    with atomic_files(targets, overwrite=overwrite) as (picture, material, mesh):
        picture.write_bytes(mean)
        material.write_bytes(_material(scene, picture.name))
        mesh.write_bytes(_mesh(scene, material.name))


def obj_files(output: Path) -> list[Path]:
    """Picture, material and mesh of an OBJ. The names of the first two have no spaces, where readers split names."""
    stem = "".join(c if c.isalnum() or c in "._" else "_" for c in file_name(output.stem, "mesh"))
    return [output.with_name(f"{stem}.png"), output.with_name(f"{stem}.mtl"), output]


def write_obj_folder(
    scene: Scene,
    folder: Path,
    *,
    textures: int | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write mesh.obj, mesh.mtl, mean.png and eigen_00.png, eigen_01.png, ...

    `eigenfield.json` has the scale and zero that make values of their codes, the weights of every encoded camera, and
    where on the view plane these stand, with the triangles between them.
    Where planes have sizes and channels of their own, each eigen texture is what it adds to R, G and B at the atlas's
    size.

    Args:
        textures: Number of eigen textures of each basis. Default: all.

    Raises:
        OptionError: `not-a-picture`, `textures`.
        OutputError: The folder cannot be written.
    """
    check_textures(textures)
    mean = png_bytes(alpha_added(scene)(mean_texture(scene)))
    count = scene.appearance.textures if textures is None else textures
    total = sum(min(count, basis.count) for plane in scene.appearance.planes for basis in plane.bases)
    digits = max(2, len(str(total - 1)))
    with atomic_folder(folder, overwrite) as part:
        (part / "mean.png").write_bytes(mean)
        (part / "mesh.mtl").write_bytes(_material(scene, "mean.png"))
        (part / "mesh.obj").write_bytes(_mesh(scene, "mesh.mtl"))
        entries: list[dict[str, Any]] = []
        weights: list[NDArray[np.float32]] = []
        for picture, scale, zero, row in track(_pictures(scene, count), "eigen textures", total, progress):
            name = f"eigen_{len(entries):0{digits}d}.png"
            (part / name).write_bytes(picture)
            entries.append({"file": name, "scale": _numbers(scale), "zero": _numbers(zero)})
            weights.append(row)
        write_listing(
            part,
            "obj",
            {
                "axes": "x right, y up, the cameras look along -z; v upwards",
                "toCapture": capture_to_gltf(scene.rig).T.tolist(),
                "sum": OBJ_SUM_NOTE,
                "mean": "mean.png",
                "textures": entries,
                "weights": {
                    scene.rig.names[camera]: _numbers(np.array([of[row] for of in weights]))
                    for row, camera in zip(scene.rows().tolist(), scene.rig.encoded, strict=True)
                },
                **_places(scene),
            },
            scene.rights,
        )


def _places(scene: Scene) -> dict[str, Any]:
    """What a program needs to draw between the cameras, in the axes of the OBJ: the view plane, where the encoded
    cameras stand on it, the triangles between them, the reference camera, and the triangles of each sheet."""
    plane, sheets = scene.rig.view_plane, scene.proxy.sheets
    perspective, (_, camera) = write_nodes(scene, NODE_DIGITS)
    turn = capture_to_gltf(scene.rig)
    return {
        "viewPlane": {
            "origin": (turn @ (plane.origin + scene.origin)).tolist(),
            "right": (turn @ plane.right).tolist(),
            "up": (turn @ plane.up).tolist(),
            "extent": plane.extent.tolist(),
        },
        "places": encoded_places(scene).tolist(),
        "triangles": scene.rig.triangles.tolist(),
        "camera": {
            **perspective,
            "translation": (turn @ (scene.rig.cameras[scene.rig.reference].centre + scene.origin)).tolist(),
            "rotation": camera.get("rotation", [0, 0, 0, 1]),
        },
        "sheets": [] if sheets is None else list(sheets.faces),
    }


def _pictures(scene: Scene, count: int) -> Iterator[CodedPicture]:
    """PNG, scale and zero (C,), and weights (No,) of the first `count` eigen textures of each basis, as pictures of the
    whole atlas: codes as the scene has them where these are such pictures."""
    if not _has_plain_atlas(scene):
        yield from parallel_stream(lambda item: _quantised(*item), eigen_maps(scene, count))
        return
    (plane,) = scene.appearance.planes
    for basis in plane.bases:
        yield from _codes_of(basis, plane.mean.shape[2], min(count, basis.count))


def _quantised(make: Callable[[], NDArray[np.float32]], weights: NDArray[np.float32]) -> CodedPicture:
    """An item of `eigen_maps` as a picture."""
    added = make()
    scale = np.full(len(added), max(-float(added.min()), float(added.max())) / MAX_OFFSET_CODES or 1, np.float32)
    added /= scale[0]
    added += ZERO_CODE
    codes = np.stack([np.rint(channel).astype(np.uint8) for channel in added], axis=2)
    return png_bytes(codes), scale, np.full_like(scale, ZERO_CODE), weights


def _codes_of(basis: Basis, channels: int, count: int) -> Iterator[CodedPicture]:
    scale, zero = basis_scale(basis, one_unit=channels == 3)
    for index in range(count):
        picture = png_bytes(texture_codes(basis, index, scale, zero))
        yield picture, scale[index], zero[index], basis.weights[:, index]


def _has_plain_atlas(scene: Scene) -> bool:
    """Whether the scene's eigen textures are pictures of the whole atlas."""
    sizes = {basis.textures.shape[1:3] for plane in scene.appearance.planes for basis in plane.bases}
    return scene.appearance.to_rgb is None and len(scene.appearance.planes) == 1 and sizes <= {scene.appearance.atlas}


def _mesh(scene: Scene, material: str) -> bytes:
    mesh = scene.proxy.mesh
    assert mesh.uv is not None
    places = mesh.vertices.astype(np.float64) + scene.origin
    turned = places @ capture_to_gltf(scene.rig).T
    digits = 15 if scene.origin.any() else 9
    lines = [
        f"# eigenfield {__version__}",
        *(f"# {name}: {text}" for name, text in scene.rights.said.items()),
        "# x right, y up, the cameras look along -z; lengths as in the capture",
        f"mtllib {material}",
        "o proxy",
    ]
    lines += [f"v {x:.{digits}g} {y:.{digits}g} {z:.{digits}g}" for x, y, z in turned.tolist()]
    lines += [f"vt {u!r} {1 - v!r}" for u, v in mesh.uv.astype(np.float64).tolist()]
    lines += ["usemtl mean", "s off"]
    lines += [f"f {a}/{a} {b}/{b} {c}/{c}" for a, b, c in (mesh.faces + 1).tolist()]
    return ("\n".join(lines) + "\n").encode()


def _material(scene: Scene, picture: str) -> bytes:
    """The picture as diffuse colour, nothing shiny, and of sheets its alpha as opacity."""
    lines = ["newmtl mean", "Ka 0 0 0", "Kd 1 1 1", "Ks 0 0 0", "illum 1", f"map_Kd {picture}"]
    lines += [] if scene.proxy.sheets is None else [f"map_d {picture}"]
    return ("\n".join(lines) + "\n").encode()


def _numbers(values: NDArray[np.floating]) -> list[float]:
    """The shortest decimals that give the same float32."""
    return [float(str(value)) for value in np.asarray(values, np.float32)]
