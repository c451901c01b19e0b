"""Entries of the JSON for mesh, cameras, view plane and nodes, while a buffer fills."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.codecs import encoder
from eigenfield.core.appearance import COLOUR_STEP
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Payload
from eigenfield.core.scene import Scene
from eigenfield.gltf.accessors import FLOAT, UINT8, UINT16, UINT32
from eigenfield.gltf.axes import NEAR_PLANE_RATIO, capture_to_gltf, opening_view, quaternion
from eigenfield.gltf.buffer import Buffer
from eigenfield.gltf.coded_pictures import shortest_decimals
from eigenfield.gltf.container import json_bytes
from eigenfield.gltf.name_pattern import name_pattern
from eigenfield.gltf.streams import PLACES, codec_entry

_VERTICES, _INDICES = 34962, 34963  # glTF's targets of a buffer view
NODE_DIGITS = 9  # of numbers for other viewers and of the view plane: all that readers of 32 bits keep
PACKED_NODE_DIGITS = 6
CODED_NAMES_MIN_SAVING_BYTES = 256  # with their two entries in the JSON


def write_primitive(mesh: Mesh, buffer: Buffer, small: bool) -> dict[str, Any]:
    """A mesh with texture coordinates.

    Args:
        small: Whether indices may have 8 bits, which other viewers read but need not be quick at.
    """
    assert mesh.uv is not None
    return {
        "attributes": {
            "POSITION": buffer.accessor(mesh.vertices, FLOAT, "VEC3", _VERTICES, **bounds_of(mesh.vertices)),
            "TEXCOORD_0": buffer.accessor(mesh.uv, FLOAT, "VEC2", _VERTICES),
        },
        "indices": buffer.accessor(mesh.faces.ravel(), index_type(mesh, small), "SCALAR", _INDICES),
        "material": 0,
    }


def bounds_of(vertices: NDArray[np.float32]) -> dict[str, list[float]]:
    """`min` and `max` of an accessor of positions (n, 3)."""
    return {"min": shortest_decimals(vertices.min(axis=0)), "max": shortest_decimals(vertices.max(axis=0))}


def index_type(mesh: Mesh, small: bool) -> int:
    """The smallest type of indices, with `small` of 8 bits too. The largest index of a type restarts a primitive and
    may not be used."""
    return UINT8 if small and len(mesh.vertices) < 256 else UINT16 if len(mesh.vertices) < 65_536 else UINT32


def write_stream(payload: Payload, place: str, buffer: Buffer) -> Any:
    """The entry of a stream at a place of `PLACES`: its buffer view, and its codec unless it is the default."""
    index, named = buffer.stream(payload, place), codec_entry(payload.codec, place)
    return index if PLACES[place].bare and not named else {"bufferView": index, **named}


def write_cameras(scene: Scene, buffer: Buffer, stream: Payload | None) -> dict[str, Any]:
    """Names, sizes, matrices and colours of all cameras.

    Args:
        stream: The coded matrices; None: they are plain.
    """
    sizes = np.array([[c.width, c.height] for c in scene.rig.cameras])
    fields: dict[str, Any] = {}
    if stream is not None and (sizes == sizes[0]).all():
        fields["size"] = sizes[0].tolist()
    else:
        fields["sizes"] = buffer.accessor(sizes.ravel(), UINT32, "SCALAR")
    if scene.appearance.colours is not None:
        fields |= _colours(scene.appearance.colours, scene, buffer)
    if scene.rig.held_out.any():
        fields["heldOut"] = np.flatnonzero(scene.rig.held_out).tolist()
    if stream is not None:
        fields["coded"] = write_stream(stream, "cameras", buffer)
    else:
        cameras = scene.rig.cameras
        intrinsics = np.array([[c.K[0, 0], c.K[1, 1], c.K[0, 1], c.K[0, 2], c.K[1, 2]] for c in cameras])
        poses = np.array([np.hstack([c.R, c.t[:, None]]) for c in cameras])
        fields["intrinsics"] = buffer.accessor(intrinsics.ravel(), FLOAT, "SCALAR")
        fields["poses"] = buffer.accessor(poses.ravel(), FLOAT, "SCALAR")
    return _names(scene.rig.names, None if stream is None else buffer) | fields


def _colours(colours: NDArray[np.float32], scene: Scene, buffer: Buffer) -> dict[str, Any]:
    """Gains and offsets of all cameras, or coded those of the encoded ones where views mix them."""
    if not scene.appearance.mixed_colours:
        return {"colour": buffer.accessor(colours.ravel(), FLOAT, "SCALAR")}
    codec = PLACES["colours"].codec
    assert codec is not None
    stream, _ = encoder(codec)(colours[scene.rig.encoded].reshape(-1, 6), COLOUR_STEP)
    return {"codedColour": write_stream(Payload(codec, stream), "colours", buffer)}


def _names(names: Sequence[str], buffer: Buffer | None) -> dict[str, Any]:
    """One by one, by a pattern or coded, whichever is shortest; without a buffer as readers of 1.1 know them."""
    plain: dict[str, Any] = {"names": list(names)}
    if buffer is None:
        return plain
    pattern, stream = name_pattern(names), _encode_at("names", names)
    shorter = plain if pattern is None else {"pattern": pattern}
    if stream is None or len(stream.data) + CODED_NAMES_MIN_SAVING_BYTES >= len(json_bytes(shorter)):
        return shorter
    return {"codedNames": write_stream(stream, "names", buffer) | {"count": len(names)}}


def _encode_at(place: str, value: Any) -> Payload | None:
    """A value coded by the default codec of a place; None where it cannot code it."""
    codec = PLACES[place].codec
    assert codec is not None
    data: bytes | None = encoder(codec)(value)
    return None if data is None else Payload(codec, data)


def write_view_plane(scene: Scene, buffer: Buffer, short: bool) -> dict[str, Any]:
    """The view plane and the triangles of the encoded cameras on it.

    Args:
        short: Whether the triangles may be coded, which readers of 1.1 do not know.
    """
    plane = scene.rig.view_plane
    numbers = {"origin": plane.origin, "right": plane.right, "up": plane.up, "extent": plane.extent}
    fields: dict[str, Any] = {name: (value + 0.0).tolist() for name, value in numbers.items()}  # + 0.0: no minus zero
    if short:
        size = max(np.abs(plane.origin).max(), plane.extent.max())
        units = {"origin": size, "right": 1.0, "up": 1.0, "extent": size}
        fields = {name: _rounded(value, units[name]) for name, value in numbers.items()}
    if len(scene.rig.triangles):
        stream = _encode_at("triangles", scene.rig.triangles) if short else None
        if stream is not None:
            fields["codedTriangles"] = write_stream(stream, "triangles", buffer)
        else:
            fields["triangles"] = buffer.accessor(scene.rig.triangles.ravel(), UINT32, "SCALAR")
    return fields


def _decimals(numbers: Iterable[float], digits: int) -> list[float]:
    return [float(f"{number:.{digits}g}") + 0.0 for number in numbers]  # + 0.0: no minus zero in the file


def _rounded(numbers: NDArray[np.float64], unit: float, digits: int = NODE_DIGITS) -> list[float]:
    """To a place below the first digit of `unit`: what is nothing beside it becomes 0."""
    places = digits - 1 - int(np.floor(np.log10(unit))) if unit > 0 else digits
    return [round(float(number), places) + 0.0 for number in numbers]


def write_nodes(scene: Scene, digits: int) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """The perspective of the reference camera for other viewers; the nodes of the mesh and of that camera, in numbers
    of so many digits."""
    camera = scene.rig.cameras[scene.rig.reference]
    turn = capture_to_gltf(scene.rig)
    perspective, axes = opening_view(camera, scene.proxy.mesh)
    proxy = {"mesh": 0, **_node_rotation(turn, digits)}
    distance = perspective["znear"] / NEAR_PLANE_RATIO
    view = {"camera": 0, **_node_translation(turn @ camera.centre, distance, digits)}
    perspective = dict(zip(perspective, _decimals(perspective.values(), digits), strict=True))
    return perspective, [proxy, view | _node_rotation(turn @ axes, digits)]


def _node_translation(place: NDArray[np.float64], distance: float, digits: int) -> dict[str, list[float]]:
    """A node's translation, left out where it is none. distance: to the nearest vertex."""
    found = _rounded(place, max(float(np.abs(place).max()), distance), digits)
    return {"translation": found} if any(found) else {}


def _node_rotation(rotation: NDArray[np.float64], digits: int) -> dict[str, list[float]]:
    """A node's rotation, (3, 3); left out where it is none."""
    found = _rounded(np.array(quaternion(rotation)), 1.0, digits)
    return {} if found == [0, 0, 0, 1] else {"rotation": found}
