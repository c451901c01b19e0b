"""Pictures of a .glb with `KHR_gaussian_splatting`, drawn as the extension's text says, in plain NumPy."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.rig import Rig
from eigenfield.gltf.axes import capture_to_gltf

NAME = "KHR_gaussian_splatting"
KINDS = {5126: "<f4", 5121: "u1"}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


def read_splats(path: Path) -> tuple[dict, dict[str, NDArray[np.float64]]]:
    """The JSON, and each attribute of the primitive by its name without the extension's."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document, start = json.loads(data[20 : 20 + length]), 28 + length
    (mesh,) = document["meshes"]
    (primitive,) = mesh["primitives"]
    found = {}
    for name, index in primitive["attributes"].items():
        entry = document["accessors"][index]
        view = document["bufferViews"][entry["bufferView"]]
        values = np.frombuffer(data, KINDS[entry["componentType"]], view["byteLength"] // np.dtype(
            KINDS[entry["componentType"]]).itemsize, start + view["byteOffset"])  # fmt: skip
        values = values.reshape(entry["count"], WIDTHS[entry["type"]]).astype(np.float64)
        found[name.removeprefix(f"{NAME}:")] = values / 255 if entry.get("normalized") else values
    return document, found


def read_spz(path: Path) -> dict[str, NDArray[np.float64]]:
    """The attributes of an .spz of version 4, as of `read_splats`, but for rotations."""
    import zstandard

    data = path.read_bytes()
    magic, version, count, degree, bits, _, streams, table = struct.unpack_from("<4sIIBBBBI", data)
    assert (magic, version, degree) == (b"NGSP", 4, 2)
    at, parts = table + 16 * streams, []
    for number in range(streams):
        packed, size = struct.unpack_from("<QQ", data, table + 16 * number)
        part = zstandard.ZstdDecompressor().decompress(data[at : at + packed], size)
        parts.append(np.frombuffer(part, np.uint8).astype(np.int64).reshape(count, -1))
        at += packed
    positions, opacity, colours, scales, _, harmonics = parts
    low, middle, high = np.moveaxis(positions.reshape(count, 3, 3), 2, 0)
    whole = low + (middle << 8) + (high << 16)
    found = {
        "POSITION": np.where(whole >= 1 << 23, whole - (1 << 24), whole) / (1 << bits),
        "OPACITY": opacity / 255,
        "SH_DEGREE_0_COEF_0": (colours / 255 - 0.5) / 0.15,
        "SCALE": np.exp(scales / 16 - 10),
    }
    for index in range(8):
        rank = int(np.sqrt(index + 1))
        name = f"SH_DEGREE_{rank}_COEF_{index + 1 - rank**2}"
        found[name] = (harmonics[:, 3 * index : 3 * index + 3] - 128) / 128
    return found


def camera_of(camera: Camera, rig: Rig, scale: float = 1.0) -> Camera:
    """A camera of a capture in the axes and units of the file."""
    turn = capture_to_gltf(rig)
    return Camera(camera.K, camera.R @ turn.T, scale * camera.t, camera.width, camera.height)


def draw_splats(splats: dict[str, NDArray[np.float64]], camera: Camera) -> NDArray[np.float64]:
    """(H, W, 3) sRGB-coded values on black.

    Sorted by the distance to the eye, each Gaussian ends at three sigmas; nothing is added to its covariance.
    """
    places, quaternions = splats["POSITION"], splats["ROTATION"]
    x, y, z, w = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    rotation = np.moveaxis(np.array(rows), 2, 0)
    local = places @ camera.R.T + camera.t
    depth = local[:, 2]
    jacobian = np.zeros((len(places), 2, 3))
    jacobian[:, 0, 0] = jacobian[:, 1, 1] = 1 / depth
    jacobian[:, :, 2] = -local[:, :2] / depth[:, None] ** 2
    jacobian = camera.K[:2, :2] @ jacobian
    spread = jacobian @ camera.R @ (rotation * splats["SCALE"][:, None, :])
    covariance = spread @ np.moveaxis(spread, 1, 2) + 1e-3 * np.eye(2)
    inverse = np.linalg.inv(covariance)
    pixels = (local[:, :2] / depth[:, None]) @ camera.K[:2, :2].T + camera.K[:2, 2]
    reach = 3 * np.sqrt(np.stack([covariance[:, 0, 0], covariance[:, 1, 1]], axis=1))
    size = np.array([camera.width, camera.height])
    first = np.floor(np.clip(pixels - reach, 0, size)).astype(int)
    last = np.ceil(np.clip(pixels + reach, 0, size)).astype(int)
    colours = seen_colours(splats, places - camera_centre(camera))
    image, rest = np.zeros((camera.height, camera.width, 3)), np.ones((camera.height, camera.width))
    for i in np.argsort(np.linalg.norm(local, axis=1), kind="stable"):
        if depth[i] <= 0 or (first[i] >= last[i]).any():
            continue
        part = slice(first[i, 1], last[i, 1]), slice(first[i, 0], last[i, 0])
        across = np.arange(first[i, 0], last[i, 0]) + 0.5 - pixels[i, 0]
        down = (np.arange(first[i, 1], last[i, 1]) + 0.5 - pixels[i, 1])[:, None]
        (xx, xy), (_, yy) = inverse[i]
        distance = xx * across**2 + 2 * xy * across * down + yy * down**2
        alpha = np.where(distance <= 9, splats["OPACITY"][i, 0] * np.exp(-distance / 2), 0)
        weight = alpha * rest[part]
        image[part] += weight[..., None] * colours[i]
        rest[part] -= weight
    return image


def camera_centre(camera: Camera) -> NDArray[np.float64]:
    return -camera.R.T @ camera.t


def seen_colours(splats: dict[str, NDArray[np.float64]], directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N, 3) colours 0..1 of Gaussians that are seen in directions (N, 3) from the eye."""
    x, y, z = (directions / np.linalg.norm(directions, axis=1, keepdims=True)).T[..., None]
    factors = {
        "SH_DEGREE_0_COEF_0": 0.2820947917738781,
        "SH_DEGREE_1_COEF_0": -0.4886025119029199 * y,
        "SH_DEGREE_1_COEF_1": 0.4886025119029199 * z,
        "SH_DEGREE_1_COEF_2": -0.4886025119029199 * x,
        "SH_DEGREE_2_COEF_0": 1.092548430592079 * x * y,
        "SH_DEGREE_2_COEF_1": -1.092548430592079 * y * z,
        "SH_DEGREE_2_COEF_2": 0.31539156525252 * (2 * z * z - x * x - y * y),
        "SH_DEGREE_2_COEF_3": -1.092548430592079 * x * z,
        "SH_DEGREE_2_COEF_4": 0.5462742152960395 * (x * x - y * y),
    }
    total = sum(factor * splats[name] for name, factor in factors.items() if name in splats)
    return np.clip(total + 0.5, 0, 1)
