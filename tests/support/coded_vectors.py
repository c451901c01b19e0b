"""Coded parts and what they decode to, for decoders in other languages.

`PYTHONPATH=tests python -m support.coded_vectors FOLDER` writes
NAME.bin and NAME.json, whose lists a decoder must find, or null where it must refuse."""

from __future__ import annotations

import base64
import json
import sys
import zlib
from pathlib import Path

import numpy as np

from eigenfield.coding.arrays.cameras import code_cameras, decode_cameras
from eigenfield.coding.arrays.names import code_names, decode_names
from eigenfield.coding.arrays.triangles import code_triangles, decode_triangles, sorted_triangles
from eigenfield.coding.arrays.weights import code_weights, decode_weights
from eigenfield.coding.mesh.coder import decode_mesh, decode_placed, encode_mesh
from eigenfield.coding.mesh.motion import decode_motion, encode_motion
from eigenfield.core.errors import FormatError
from eigenfield.core.payloads import mesh_key
from eigenfield.gltf import read_scene
from eigenfield.gltf.clips import Motion
from support import coded_meshes
from support.arrays import GRID, array_cameras, array_triangles, smooth_weights

DAMAGED = 25  # of each
BEFORE = Path(__file__).parents[1] / "data" / "coded-1.7.glb"  # whose mesh is of mesh-1


def streams():
    """Name and bytes of every undamaged vector."""
    yield "mesh-relief", encode_mesh(*coded_meshes.relief(charts=3))[0]
    yield "mesh-coarse", encode_mesh(*coded_meshes.relief(30, 31, step=2.5), uv_bits=6)[0]
    yield "mesh-fine", encode_mesh(*coded_meshes.relief(step=0.25, charts=2, astray=0.2), fine=2)[0]
    yield "mesh-ball", encode_mesh(*coded_meshes.ball())[0]
    yield "mesh-soup", encode_mesh(*coded_meshes.soup(7, 60, 150))[0]
    relief, lattice = coded_meshes.relief()
    twice, counts = coded_meshes.joined([relief, relief])
    yield "mesh-sheets", encode_mesh(twice, lattice, sheets=counts)[0]
    before = read_scene(BEFORE.read_bytes())
    yield "mesh-before", before.payloads[mesh_key(before.proxy.mesh)][0].data
    yield "weights-line", code_weights(smooth_weights(4, noise=0.3), 0.05)[0]
    yield "weights-grid", code_weights(smooth_weights(6, noise=0.02), [0.01, 0.02, 0.05, 0.1, 0.2, 0.3], GRID)[0]
    steps = {"intrinsic_step": 0.02, "rotation_step": 1e-4, "centre_step": 1e-3}
    yield "cameras-line", code_cameras(array_cameras(), **steps)[0]
    yield "cameras-grid", code_cameras(array_cameras(), **steps, grid=GRID)[0]
    yield "triangles-grid", code_triangles(sorted_triangles(array_triangles()))


def decoded(kind, stream):
    """Lists of numbers, or None where the bytes are refused."""
    try:
        if kind == "mesh":
            mesh = decode_mesh(stream, version=min(max(stream[0], 1), 2))
            parts = {"positions": mesh.vertices, "uv": mesh.uv, "indices": mesh.faces}
        elif kind == "weights":
            parts = {"values": decode_weights(stream)}
        elif kind == "triangles":
            parts = {"corners": decode_triangles(stream)}
        else:
            parts = dict(zip(("intrinsics", "poses"), decode_cameras(stream), strict=True))
    except FormatError:
        return None
    return {name: part.astype(np.float64).reshape(-1).tolist() for name, part in parts.items()}


def names_of(stream, count):
    """The names, or None where the bytes are refused."""
    try:
        return decode_names(stream, count)
    except FormatError:
        return None


def coded_names():
    """Base64, count and names of streams, whole and damaged."""
    random = np.random.default_rng(5)
    measured = [f"out_{k // 9:02d}_{k % 9:02d}_{random.normal():.6f}_{random.normal():.6f}.jpg" for k in range(81)]
    for names in (measured, ["ä", "猫.png", "c"], ["\ufeffone"]):
        stream, count = code_names(names), len(names)
        variants = [(stream, count), (stream, count + 1), (stream, 2 * count), (stream[:-3], count)]
        for _ in range(DAMAGED):
            damaged = bytearray(stream)
            damaged[random.integers(len(stream))] = random.integers(256)
            variants.append((bytes(damaged), count))
        variants += [
            (zlib.compress(bytes(range(128, 248))), 60),
            (zlib.compress(b""), 1),
            (zlib.compress(bytes(2**25 + 1)), 9000),
        ]
        for data, number in variants:
            yield base64.b64encode(data).decode(), number, names_of(data, number)


def coded_motion():
    """Base64 of a mesh and of its motion, whole and damaged; and the positions of all frames, or None."""
    random = np.random.default_rng(9)
    relief = coded_meshes.relief(charts=2)
    for mesh, lattice in (relief, coded_meshes.ball(), coded_meshes.soup(3, 40, 80)):
        stream = encode_mesh(mesh, lattice)[0]
        placed = decode_placed(stream)
        frames = np.tile(placed.places, (4, 1, 1))
        frames[1:] += np.arange(3)[:, None, None] * (placed.places[:, ::-1] % 7)
        frames[2:, : len(placed.places) // 2] += random.integers(-900, 900, (len(placed.places) // 2, 3))
        whole = encode_motion(placed.places, placed.mesh.faces, frames)
        still = encode_motion(placed.places, placed.mesh.faces, frames[:1])
        variants = [whole, still, whole[: len(whole) // 2], still[:3]]
        for _ in range(DAMAGED):
            damaged = bytearray(whole)
            damaged[random.integers(len(whole))] = random.integers(256)
            variants.append(bytes(damaged))
        for data in variants:
            yield *(base64.b64encode(one).decode() for one in (stream, data)), positions_of(placed, data)


def positions_of(placed, data):
    """Of all vertices in each frame, or None where the bytes are refused."""
    try:
        moving, steps = decode_motion(data, placed.places, placed.mesh.faces, "here")
        motion = Motion(placed, moving, steps, "here")
        return [motion.vertices(frame).astype(np.float64).reshape(-1).tolist() for frame in range(len(steps))]
    except FormatError:
        return None


def write(folder):
    (folder / "motion.json").write_text(json.dumps(list(coded_motion())), encoding="utf-8")
    (folder / "names.json").write_text(json.dumps(list(coded_names())), encoding="utf-8")
    random = np.random.default_rng(11)
    for name, stream in streams():
        variants = [(name, stream)]
        for k in range(DAMAGED):
            damaged = bytearray(stream)
            for _ in range(random.integers(1, 3)):
                damaged[random.integers(len(stream) // 2 if k % 2 else 0, len(stream))] = random.integers(256)
            variants.append((f"{name}-damaged-{k}", bytes(damaged[: len(stream) - (k % 5)])))
        for label, variant in variants:
            (folder / f"{label}.bin").write_bytes(variant)
            (folder / f"{label}.json").write_text(json.dumps(decoded(name.split("-")[0], variant)), encoding="utf-8")


if __name__ == "__main__":
    write(Path(sys.argv[1]))
