"""The JSON around the extension, and what scenes and clips say alike in it, while a buffer fills."""

from __future__ import annotations

from functools import partial
from typing import Any

from eigenfield.coding import limits
from eigenfield.coding.stacking import PICTURES
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payload
from eigenfield.core.scene import Scene
from eigenfield.core.version import __version__
from eigenfield.gltf import packed
from eigenfield.gltf.buffer import Buffer
from eigenfield.gltf.coded_pictures import shortest_decimals
from eigenfield.gltf.rights import with_rights
from eigenfield.gltf.write_geometry import NODE_DIGITS, PACKED_NODE_DIGITS, write_nodes, write_primitive


def write_drawn(scene: Scene, mesh: Mesh, picture: Payload, buffer: Buffer, coded: bool) -> dict[str, Any]:
    """What other viewers show: a mesh with a picture; coded: whether the scene's own mesh is a stream."""
    primitive = write_primitive(mesh, buffer, coded)
    image = {"bufferView": buffer.view(picture.data), "mimeType": PICTURES[picture.codec].mime}
    plain, holes = buffer.packed is None, scene.proxy.sheets is not None and not coded
    material = {
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.0},
        "extensions": {"KHR_materials_unlit": {}},
        **({"alphaMode": "MASK"} if holes else {}),  # below glTF's default of 0.5
        "doubleSided": True,
    }
    return {
        "meshes": [_named(plain, "proxy", {"primitives": [primitive]})],
        "materials": [_named(plain, "mean", material)],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{**({"magFilter": 9729, "minFilter": 9987} if plain else {}), "wrapS": 33071, "wrapT": 33071}],
        "images": [image],
    }


def _named(plain: bool, name: str, entry: dict[str, Any]) -> dict[str, Any]:
    """The entry with its name, which a packed file leaves out."""
    return {"name": name} | entry if plain else entry


def write_rest(scene: Scene, cameras: dict[str, Any], view_plane: dict[str, Any]) -> dict[str, Any]:
    """Members of the extension behind `planes`."""
    return {
        **({} if scene.appearance.to_rgb is None else {"toRGB": shortest_decimals(scene.appearance.to_rgb.ravel())}),
        "cameras": cameras,
        "viewPlane": view_plane,
        "reference": int(scene.rig.reference),
        **({"settings": dict(scene.settings)} if scene.settings else {}),
        **({"scores": dict(scene.scores)} if scene.scores else {}),
        "generator": scene.generator or f"eigenfield {__version__}",
    }


def write_root(
    scene: Scene, version: str, extension: dict[str, Any], drawn: dict[str, Any], buffer: Buffer
) -> dict[str, Any]:
    """The whole JSON. A buffer that packs is done with it.

    Args:
        extension: Without its version.
        drawn: What other viewers show (`write_drawn`); empty: nothing.
    """
    plain = buffer.packed is None
    if plain:
        extension = {"version": version} | extension
    else:
        extension = {"version": version, "needs": [packed.FEATURE], packed.FEATURE: packed.write(extension, buffer)}
    perspective, nodes = write_nodes(scene, NODE_DIGITS if plain else PACKED_NODE_DIGITS)
    if not drawn:
        del nodes[0]["mesh"]
    named = partial(_named, plain)
    made = {
        "asset": {"version": "2.0", **({"generator": f"eigenfield {__version__}"} if plain else {})},
        "extensionsUsed": [*(["KHR_materials_unlit"] if drawn else []), limits.EXTENSION],
        "extensions": {limits.EXTENSION: extension},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [named("proxy", nodes[0]), named("reference camera", nodes[1])],
        "cameras": [{"type": "perspective", "perspective": perspective}],
        **drawn,
        **({"accessors": buffer.accessors} if buffer.accessors else {}),
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": buffer.length}],
    }
    return with_rights(made, scene.rights)
