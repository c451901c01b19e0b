"""The proxy as Wavefront OBJ with the mean as its texture, and the eigen textures beside it for programs of one's own.

Axes are the .glb's: x right, y up, the array looking along -z. OBJ counts v upwards, the scene downwards.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield import __version__
from eigenfield.errors import FormatError, OptionError
from eigenfield.files import atomic_files, refuse_existing
from eigenfield.format.axes import capture_to_gltf
from eigenfield.format.quantise import basis_scale, texture_codes
from eigenfield.progress import Progress, track
from eigenfield.rendering.shots import refuse_attributes
from eigenfield.scene import Plane, Scene
from eigenfield.texturing import png_bytes
from eigenfield.viewer.exports.folder import atomic_folder, write_listing
from eigenfield.viewer.exports.names import file_name

SUM = "texture = mean / 255 + sum over j of weight[camera][j] * (code[j] - zero[j]) * scale[j]"


def write_obj(scene: Scene, output: Path, *, overwrite: bool = False) -> None:
    """Write NAME.obj with NAME.mtl and NAME.png, the mean cut to 0..1, beside it; all three or none.

    Raises OutputError, OptionError `not-a-picture`, FormatError `unsupported-layout`.
    """
    plane = only_plane(scene)
    targets = obj_files(output)
    with atomic_files(targets, overwrite=overwrite) as (picture, material, mesh):
        picture.write_bytes(png_bytes(plane.mean))
        material.write_bytes(_material(picture.name))
        mesh.write_bytes(_mesh(scene, material.name))


def refuse_obj(output: Path, overwrite: bool) -> None:
    """Before any work: raise OutputError where one of the three files may not or cannot be written."""
    for path in obj_files(output):
        refuse_existing(path, overwrite)


def obj_files(output: Path) -> list[Path]:
    """Picture, material and mesh of an OBJ; the first two in words that every reader of OBJ takes for one."""
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
    """Write mesh.obj, mesh.mtl, mean.png and eigen_00.png, eigen_01.png, ..., whose codes become numbers with the
    scale and zero in `eigenfield.json`; weights of every encoded camera are there too.

    textures: how many eigen textures. Raises OutputError, OptionError (`not-a-picture`, `textures`) and FormatError
    `unsupported-layout`.
    """
    if textures is not None and textures < 0:
        raise OptionError("textures", f"{textures} eigen textures were asked for", remedy="ask for 0 or more")
    plane = only_plane(scene)
    count = scene.textures if textures is None else min(textures, scene.textures)
    digits = max(2, len(str(count - 1)))
    with atomic_folder(folder, overwrite) as part:
        (part / "mean.png").write_bytes(png_bytes(plane.mean))
        (part / "mesh.mtl").write_bytes(_material("mean.png"))
        (part / "mesh.obj").write_bytes(_mesh(scene, "mesh.mtl"))
        entries = []
        codes = _codes(plane)
        for number, (picture, scale, zero) in zip(
            track(range(count), "eigen textures", count, progress), codes, strict=False
        ):
            name = f"eigen_{number:0{digits}d}.png"
            (part / name).write_bytes(png_bytes(picture))
            entries.append({"file": name, "scale": _numbers(scale), "zero": _numbers(zero)})
        weights = np.concatenate(
            [basis.weights for basis in plane.bases] or [np.zeros((len(scene.encoded), 0), np.float32)], axis=1
        )
        write_listing(
            part,
            "obj",
            {
                "axes": "x right, y up, the cameras look along -z; v upwards",
                "toCapture": capture_to_gltf(scene.view_plane).T.tolist(),
                "sum": SUM,
                "mean": "mean.png",
                "textures": entries,
                "weights": {
                    scene.names[index]: _numbers(row[:count]) for index, row in zip(scene.encoded, weights, strict=True)
                },
            },
        )


def only_plane(scene: Scene) -> Plane:
    """The plane of a scene whose mean is a picture. Raises OptionError `not-a-picture`, FormatError."""
    refuse_attributes(sum(plane.mean.shape[2] for plane in scene.planes))
    if len(scene.planes) != 1:
        raise FormatError(
            "unsupported-layout", "several planes make no one texture", where="planes", remedy="encode with one"
        )
    return scene.planes[0]


def _codes(plane: Plane) -> Iterator[tuple[NDArray[np.uint8], NDArray[np.float32], NDArray[np.float32]]]:
    """Codes (H, W, C), scale and zero (C,) of every eigen texture."""
    for basis in plane.bases:
        scale, zero = basis_scale(basis, one_unit=plane.mean.shape[2] == 3)
        for index in range(basis.count):
            yield texture_codes(basis, index, scale, zero), scale[index], zero[index]


def _mesh(scene: Scene, material: str) -> bytes:
    mesh = scene.mesh
    assert mesh.uv is not None
    turned = mesh.vertices.astype(np.float64) @ capture_to_gltf(scene.view_plane).T
    lines = [
        f"# eigenfield {__version__}",
        "# x right, y up, the cameras look along -z; lengths as in the capture",
        f"mtllib {material}",
        "o proxy",
    ]
    lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in turned.tolist()]
    lines += [f"vt {u!r} {1 - v!r}" for u, v in mesh.uv.astype(np.float64).tolist()]
    lines += ["usemtl mean", "s off"]
    lines += [f"f {a}/{a} {b}/{b} {c}/{c}" for a, b, c in (mesh.faces + 1).tolist()]
    return ("\n".join(lines) + "\n").encode("ascii")


def _material(picture: str) -> bytes:
    """The picture as diffuse colour, nothing shiny."""
    lines = ["newmtl mean", "Ka 0 0 0", "Kd 1 1 1", "Ks 0 0 0", "illum 1", f"map_Kd {picture}"]
    return ("\n".join(lines) + "\n").encode()


def _numbers(values: NDArray[np.floating]) -> list[float]:
    """The shortest decimals that give the same float32."""
    return [float(str(value)) for value in np.asarray(values, np.float32)]
