"""The proxy with one texture, the mean or that of a viewpoint, as a .glb that every glTF viewer shows in full.

Axes are those of a scene's own .glb, lengths are metres where the scene knows them. Sheets are primitives of their own,
back to front, that are blended.
"""

from __future__ import annotations

import io
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from eigenfield.core.arguments import checked
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene, scale_of
from eigenfield.core.version import __version__
from eigenfield.gltf.accessors import FLOAT
from eigenfield.gltf.buffer import Buffer
from eigenfield.gltf.container import glb_blocks, json_bytes
from eigenfield.gltf.rights import with_rights
from eigenfield.gltf.write_geometry import NODE_DIGITS, bounds_of, index_type, write_nodes, write_primitive
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.png import png_bytes
from eigenfield.rendering import mean_texture, texture
from eigenfield.runtime.files import write_bytes
from eigenfield.viewer.exports.maps import alpha_added

IMAGES = ("png", "jpeg", "webp")
JPEG_QUALITY, WEBP_QUALITY = 95, 90
WEBP_MAX_SIDE_TEXELS = 16_383
DRACO, DRACO_BITS, DRACO_LEVEL = "KHR_draco_mesh_compression", 16, 7
WEBP = "EXT_texture_webp"
DRACO_POSITION, DRACO_TEXELS = 0, 3  # Draco's types of attributes


@checked
def write_glb(
    scene: Scene,
    output: Path,
    *,
    at: tuple[float, float] | None = None,
    image: str = "png",
    draco: bool = False,
    metres_per_unit: float | None = None,
    overwrite: bool = False,
) -> None:
    """Write the proxy with its mean, or with the texture of a viewpoint.

    Args:
        at: View-plane coordinates of the viewpoint; None: the mean.
        image: How the texture is kept: "png", "jpeg", or "webp", which a viewer must know (EXT_texture_webp).
        draco: Whether the mesh is compressed, which a viewer must know (KHR_draco_mesh_compression).
        metres_per_unit: Metres in one unit of the capture; None: as the scene says, or else one.

    Raises:
        OptionError: `image`, `draco-missing`, `viewpoint`, `not-a-picture`.
        OutputError: The file cannot be written.
    """
    check_image(image, draco)
    finish = alpha_added(scene)
    drawn = mean_texture(scene) if at is None else texture(scene, at=at)
    picture = _picture(to_codes(finish(drawn)), image)
    buffer = Buffer()
    write = _write_draco if draco else _write_plain
    primitives = [write(part, buffer) for part in mesh_parts(scene.proxy)]
    view = buffer.view(picture)
    scale = scale_of(scene, metres_per_unit)
    gltf = _gltf(scene, scale, image, view) | {
        "meshes": [{"name": "proxy", "primitives": primitives}],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": buffer.length}],
    }
    required = ([DRACO] if draco else []) + ([WEBP] if image == "webp" else [])
    gltf["extensionsUsed"] = ["KHR_materials_unlit", *required]
    if required:
        gltf["extensionsRequired"] = required
    blocks = glb_blocks(json_bytes(with_rights(gltf, scene.rights)), b"".join(buffer.parts), output)
    write_bytes(output, b"".join(blocks), overwrite=overwrite)


def check_image(image: str, draco: bool) -> None:
    """Before any work: check that texture and mesh can be coded. OptionError `image`, `draco-missing`."""
    if image == "ktx2":
        remedy = "write png, and convert it by `gltf-transform uastc plain.glb small.glb`, which needs Khronos' ktx"
        raise OptionError("image", "eigenfield has no encoder of KTX2", remedy=remedy)
    if image not in IMAGES:
        raise OptionError("image", f"no picture is called {image}", remedy=f"use one of {', '.join(IMAGES)}")
    if draco:
        try:
            import DracoPy  # noqa: F401
        except ImportError:
            remedy = "pip install 'eigenfield[meshes]', or leave --draco out"
            raise OptionError("draco-missing", "DracoPy is not installed", remedy=remedy) from None


def mesh_parts(proxy: Proxy) -> list[Mesh]:
    """The mesh, or that of each sheet, back to front."""
    if proxy.sheets is None:
        return [proxy.mesh]
    ends = np.cumsum((0, *proxy.sheets.faces)).tolist()
    return [proxy.mesh.part(slice(first, last)) for first, last in pairwise(ends)]


def _picture(codes: NDArray[np.uint8], image: str) -> bytes:
    """The file of (H, W, C) codes: grey, R, G, B or with alpha."""
    if image == "png":
        return png_bytes(codes)
    height, width, channels = codes.shape
    if image == "jpeg" and channels == 4:
        message = "the texture of soft sheets has alpha, and a JPEG has none"
        raise OptionError("image", message, remedy="use png or webp")
    if image == "webp" and max(width, height) > WEBP_MAX_SIDE_TEXELS:
        message = f"webp holds {WEBP_MAX_SIDE_TEXELS} texels a side, {max(width, height)} needed"
        raise OptionError("image", message, remedy="use png or jpeg")
    file, picture = io.BytesIO(), Image.fromarray(codes if channels > 1 else codes[..., 0])
    if image == "jpeg":
        picture.save(file, "JPEG", quality=JPEG_QUALITY, subsampling="4:4:4", optimize=True)
    else:
        picture.save(file, "WEBP", quality=WEBP_QUALITY, method=4, exact=True, use_sharp_yuv=True)
    return file.getvalue()


def _write_plain(mesh: Mesh, buffer: Buffer) -> dict[str, Any]:
    return write_primitive(mesh, buffer, small=False)


def _write_draco(mesh: Mesh, buffer: Buffer) -> dict[str, Any]:
    """A primitive whose accessors have no bytes of their own: a decoder fills them."""
    import DracoPy

    assert mesh.uv is not None
    data = DracoPy.encode(
        mesh.vertices, mesh.faces.astype(np.uint32), quantization_bits=DRACO_BITS, compression_level=DRACO_LEVEL,
        tex_coord=mesh.uv.astype(np.float64), tex_coord_quantization_bits=DRACO_BITS,
    )  # fmt: skip
    decoded = DracoPy.decode(data)
    of_type = {one["attribute_type"]: one["unique_id"] for one in decoded.attributes}
    vertices = np.asarray(decoded.points, np.float32)
    decoded_mesh = Mesh(vertices, np.asarray(decoded.faces, np.int32))
    vector = {"componentType": FLOAT, "count": len(vertices)}
    first = len(buffer.accessors)
    buffer.accessors += [
        {**vector, "type": "VEC3", **bounds_of(vertices)},
        {**vector, "type": "VEC2"},
        {"componentType": index_type(decoded_mesh, small=False), "count": decoded_mesh.faces.size, "type": "SCALAR"},
    ]
    ids = {"POSITION": of_type[DRACO_POSITION], "TEXCOORD_0": of_type[DRACO_TEXELS]}
    return {
        "attributes": {"POSITION": first, "TEXCOORD_0": first + 1},
        "indices": first + 2,
        "material": 0,
        "extensions": {DRACO: {"bufferView": buffer.view(data), "attributes": ids}},
    }


def _gltf(scene: Scene, scale: float, image: str, view: int) -> dict[str, Any]:
    """The JSON without meshes and bytes; scale: metres in a unit; view: buffer view of the texture."""
    perspective, (proxy, camera) = write_nodes(scene, NODE_DIGITS)
    if scale != 1:
        proxy["scale"] = [scale] * 3
        camera["translation"] = [scale * place for place in camera.get("translation", (0.0, 0.0, 0.0))]
        perspective["znear"] *= scale
    if scene.origin.any():
        proxy["extras"] = {"origin": scene.origin.tolist()}
    source: dict[str, Any] = {"extensions": {WEBP: {"source": 0}}} if image == "webp" else {"source": 0}
    return {
        "asset": {"version": "2.0", "generator": f"eigenfield {__version__}"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"name": "proxy"} | proxy, {"name": "reference camera"} | camera],
        "cameras": [{"type": "perspective", "perspective": perspective}],
        "materials": [
            {
                "name": "texture",
                "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.0},
                "extensions": {"KHR_materials_unlit": {}},
                **({} if scene.proxy.sheets is None else {"alphaMode": "BLEND"}),
                "doubleSided": True,
            }
        ],
        "textures": [{"sampler": 0, **source}],
        "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}],
        "images": [{"bufferView": view, "mimeType": f"image/{image}"}],
    }
