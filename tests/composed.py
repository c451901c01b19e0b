"""Scenes of planes of several densities and regions, the definition of their texture, slow and plain, and their files
with reference pictures for the tests of the web viewer."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from glb_surgery import EXTENSION, join, split
from PIL import Image
from scenes import smooth_pictures
from viewer_scenes import FREE, PLACES, SIDE, free_camera, scene

from eigenfield.camera import Camera
from eigenfield.format import save
from eigenfield.mesh import Mesh
from eigenfield.rendering import draw_texture, view_weights, viewpoint
from eigenfield.scene import Basis, Plane, Scene

TO_RGB = np.array([[1.0, 0.1, 1.4], [1.0, -0.34, -0.71], [1.0, 1.77, -0.1]], np.float32)


def layered_scene() -> Scene:
    """Luma of the whole 128 x 128 atlas with textures of a region of it and of half its density, two channels of
    chroma at odd sizes; textures are codes. Geometry and weights as `viewer_scenes.scene`."""
    plain = scene()
    weights = plain.planes[0].bases[0].weights
    luma = as_coded(plain.planes[0].mean[..., :1])
    chroma = as_coded(0.1 * smooth_pictures(1, 40, 48, 2, seed=4)[0])
    planes = (
        Plane(
            luma,
            (
                coded(weights, 6, (72, 96), 1, grid=(SIDE, SIDE), corner=(40, 8)),
                coded(weights[:, ::-1], 3, (64, 64), 1),
            ),
        ),
        Plane(
            chroma,
            (coded(weights, 5, (32, 64), 2), coded(weights, 2, (20, 11), 2, grid=(40, 48), corner=(20, 37))),
        ),
    )
    return replace(plain, planes=planes, to_rgb=TO_RGB)


def as_coded(mean: np.ndarray) -> np.ndarray:
    """A mean as 256 steps between its least and its largest value keep it."""
    low, high = mean.min(), mean.max()
    return (low + np.rint((mean - low) / (high - low) * 255) * (high - low) / 255).astype(np.float32)


def coded(
    weights: np.ndarray,
    count: int,
    size: tuple[int, int],
    channels: int,
    grid: tuple[int, int] | None = None,
    corner: tuple[int, int] = (0, 0),
) -> Basis:
    """A basis of 8-bit codes with scales and zeros that differ."""
    values = 127 * smooth_pictures(count, *size, channels, seed=sum(size) + channels)
    zero = (128 - np.arange(count * channels).reshape(count, channels) % 3).astype(np.float32)
    scale = (0.2 * 0.8 ** np.arange(count)[:, None] / 127 * np.linspace(1, 1.3, channels)).astype(np.float32)
    codes = np.clip(np.rint(values + zero[:, None, None]), 0, 255).astype(np.uint8)
    return Basis(codes, scale, zero, np.ascontiguousarray(weights[:, :count]), grid, corner)


def composed(scene: Scene, weights: np.ndarray, count: int | None = None) -> np.ndarray:
    """(H, W, 3): the texture that is drawn. weights: (Ne,), or (h, w, Ne) for each size in a dict."""
    channels = []
    for plane in scene.planes:
        total = np.zeros((*scene.atlas, plane.mean.shape[2]))
        for size in set(plane.sizes):
            part = np.zeros((*size, plane.mean.shape[2]))
            if plane.mean.shape[:2] == size:
                part += plane.mean
            for basis in plane.bases:
                if basis.size == size:
                    omega = (weights[size] if isinstance(weights, dict) else weights) @ basis.weights
                    (top, left), (rows, columns) = basis.corner, basis.textures.shape[1:3]
                    for j, texture in enumerate(basis.values()[:count]):
                        own = np.broadcast_to(omega[..., j, None], (*size, 1))
                        place = slice(top, top + rows), slice(left, left + columns)
                        part[place] += own[place] * texture
            total += part if size == scene.atlas else finer(part, *scene.atlas)
        channels.append(total)
    together = np.concatenate(channels, axis=2)
    return np.broadcast_to(together if scene.to_rgb is None else together @ scene.to_rgb.T, (*scene.atlas, 3))


def finer(grid: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """(rows, columns, C): Catmull-Rom of a grid, taps clamped to the border."""
    return np.einsum("rh,cw,hwk->rck", taps(rows, grid.shape[0]), taps(columns, grid.shape[1]), grid)


def taps(count: int, given: int) -> np.ndarray:
    """(count, given): what each of `count` texels takes of each of `given`."""
    matrix = np.zeros((count, given))
    for texel in range(count):
        x = (texel + 0.5) / count * given - 0.5
        for tap in range(int(np.floor(x)) - 1, int(np.floor(x)) + 3):
            t = abs(x - tap)
            near, far = 1.5 * t**3 - 2.5 * t**2 + 1, -0.5 * t**3 + 2.5 * t**2 - 4 * t + 2
            matrix[texel, min(max(tap, 0), given - 1)] += near if t <= 1 else far
    return matrix


def flat(made: Scene, low: float, high: float) -> Scene:
    """The scene with a level square for a mesh, laid out from `low` to `high` of the atlas along both axes."""
    corners = np.array([[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0]], np.float32)
    uv = low + (high - low) * (corners[:, :2] + 1) / 2
    return replace(made, mesh=Mesh(corners, np.array([[0, 1, 2], [1, 3, 2]], np.int32), uv.astype(np.float32)))


def ray_weights(made: Scene, eye: np.ndarray, size: tuple[int, int], low: float, high: float) -> np.ndarray:
    """(h, w, Ne): the definition for each texel of a flat scene, continued beyond the square."""
    plane, weights = made.view_plane, np.zeros((*size, len(made.encoded)))
    normal = np.cross(plane.right, plane.up)
    for row, column in np.ndindex(*size):
        u, v = (column + 0.5) / size[1], (row + 0.5) / size[0]
        point = np.array([(u - low) / (high - low) * 2 - 1, (v - low) / (high - low) * 2 - 1, 0.0])
        along = ((plane.origin - point) @ normal) / ((eye - point) @ normal)
        weights[row, column] = view_weights(made, tuple(plane.coordinates(point + along * (eye - point))[0]))
    return weights


def write(folder: Path) -> None:
    """Write layered.glb and flat.glb, and add their pictures to references.json, which is there."""
    listing = folder / "references.json"
    pictures = json.loads(listing.read_text(encoding="utf-8"))

    def keep(name: str, made: Scene, texture: np.ndarray, camera: Camera, filter: str, **what: object) -> None:
        texels = np.ascontiguousarray(texture, dtype=np.float32)
        picture = draw_texture(made.mesh, texels, camera, filter=filter, samples=1).to_uint8()
        file = f"{name}-{len(pictures)}.png"
        Image.fromarray(picture).save(folder / file)
        size = {"width": camera.width, "height": camera.height}
        missing = dict.fromkeys(("at", "camera", "free", "count"))
        pictures.append({"scene": f"{name}.glb", "file": file, "filter": filter, **missing, **what, **size})

    layered, level = layered_scene(), flat(layered_scene(), 0.0, 1.0)
    for name, made in (("layered", layered), ("flat", level)):
        save_layered(made, folder / f"{name}.glb")
    for filter in ("bilinear", "bicubic"):
        for count, at in ((None, PLACES[1]), (None, PLACES[2]), (0, PLACES[1]), (2, PLACES[1]), (4, PLACES[1])):
            camera, weights = viewpoint(layered, at=at)
            keep("layered", layered, composed(layered, weights, count), camera, filter, at=at, count=count)
    sizes = {size for plane in level.planes for size in plane.sizes}
    for eye in FREE:
        view = free_camera(np.array(eye))
        weights = {size: ray_weights(level, np.array(eye), size, 0.0, 1.0) for size in sizes}
        free = {"K": view.K.tolist(), "R": view.R.tolist(), "t": view.t.tolist()}
        keep("flat", level, composed(level, weights), view, "bilinear", free=free)
    listing.write_text(json.dumps(pictures, indent=1), encoding="utf-8")


def save_layered(made: Scene, path: Path) -> None:
    """Write a scene of 8-bit codes as format 1.2 has it, in PNG: the first texture of a basis alone, the rest in
    one picture."""
    plain = replace(made, planes=(Plane(np.zeros((SIDE, SIDE, 3), np.float32), ()),), to_rgb=None)
    save(plain, path, codec="png", overwrite=True)
    gltf, binary = split(path.read_bytes())
    data = bytearray(binary)

    def view(part: bytes) -> int:
        data.extend(bytes(-len(data) % 4))
        gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
        data.extend(part)
        gltf["buffers"][0]["byteLength"] = len(data)
        return len(gltf["bufferViews"]) - 1

    def picture(codes: np.ndarray) -> dict:
        """(k, h, w, C) codes, one below the other; channels too unless there are three."""
        k, h, w, channels = codes.shape
        stacked = codes.reshape(k * h, w, 3) if channels == 3 else codes.transpose(0, 3, 1, 2).reshape(-1, w)
        file = io.BytesIO()
        Image.fromarray(np.ascontiguousarray(stacked)).save(file, "PNG")
        return {"bufferView": view(file.getvalue()), "mimeType": "image/png"}

    def basis(own: Basis) -> dict:
        (rows, columns), (top, left) = own.size, own.corner
        h, w = own.textures.shape[1:3]
        weights = {"bufferView": view(own.weights.astype("<f4").tobytes()), "componentType": 5126, "type": "SCALAR"}
        gltf["accessors"].append({**weights, "count": own.weights.size})
        listed = []
        for part in (slice(0, 1), slice(1, None)):
            numbers = {"scale": own.scale[part].ravel().tolist(), "zero": own.zero[part].ravel().tolist()}
            count = len(own.textures[part])
            listed.append(picture(own.textures[part]) | numbers | ({"count": count} if count > 1 else {}))
        whole = {"grid": [columns, rows], "corner": [left, top]} if own.grid else {}
        return {"size": [w, h], **whole, "textures": listed, "weights": len(gltf["accessors"]) - 1}

    def mean(values: np.ndarray) -> dict:
        low, high = values.min(), values.max()
        codes = np.rint((values - low) / (high - low) * 255).astype(np.uint8)
        numbers = {"scale": [float(high - low) / 255] * values.shape[2], "zero": [float(-low / (high - low)) * 255]}
        numbers["zero"] *= values.shape[2]
        return picture(codes[None]) | numbers | {"size": [values.shape[1], values.shape[0]]}

    extension = gltf["extensions"][EXTENSION]
    extension["version"], extension["needs"] = "1.2", ["toRGB", "regions", "stacks"]
    extension["toRGB"] = made.to_rgb.ravel().tolist()
    extension["planes"] = [
        {"channels": plane.mean.shape[2], "mean": mean(plane.mean), "bases": [basis(own) for own in plane.bases]}
        for plane in made.planes
    ]
    path.write_bytes(join(gltf, bytes(data)))
