"""Scenes of planes of several densities and regions, the definition of their texture, slow and plain, and their files
with reference pictures for the tests of the web viewer."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from eigenfield.coding.pictures.quantise import mean_codes, mean_values
from eigenfield.coding.stacking import encode, stacked_picture
from eigenfield.core.appearance import Basis, Plane
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Affine, Payloads, PicturePayload, mean_key, textures_key
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene
from eigenfield.gltf import save
from eigenfield.rendering import ViewWeights, draw_texture, view_weights, viewpoint
from support.scenes import smooth_pictures
from support.viewer_scenes import FREE, PLACES, SIDE, free_camera, scene

TO_RGB = np.array([[1.0, 0.1, 1.4], [1.0, -0.34, -0.71], [1.0, 1.77, -0.1]], np.float32)


def layered_scene() -> Scene:
    """Luma of the whole 128 x 128 atlas with textures of a region of it and of half its density, two channels of
    chroma at odd sizes; textures are codes. Geometry and weights as `viewer_scenes.scene`."""
    plain = scene()
    weights = plain.appearance.planes[0].bases[0].weights
    luma, chroma = plain.appearance.planes[0].mean[..., :1], 0.1 * smooth_pictures(1, 40, 48, 2, seed=4)[0]
    luma, chroma = (mean_values(*mean_codes(mean)) for mean in (luma, chroma))  # as a file keeps them
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
    return replace(plain, appearance=replace(plain.appearance, planes=planes, to_rgb=TO_RGB))


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


def composed(
    scene: Scene, weights: ViewWeights | dict[tuple[int, int], np.ndarray], count: int | None = None
) -> np.ndarray:
    """(H, W, 3): the texture that is drawn. weights: of the view, or (h, w, No) for each size."""
    channels = []
    for plane in scene.appearance.planes:
        total = np.zeros((*scene.appearance.atlas, plane.mean.shape[2]))
        for size in set(plane.sizes):
            part = np.zeros((*size, plane.mean.shape[2]))
            if plane.mean.shape[:2] == size:
                part += plane.mean
            for basis in plane.bases:
                if basis.size == size:
                    whole = isinstance(weights, ViewWeights)
                    omega = weights.blend(basis.weights) if whole else weights[size] @ basis.weights
                    (top, left), (rows, columns) = basis.corner, basis.textures.shape[1:3]
                    for j, texture in enumerate(basis.values()[:count]):
                        own = np.broadcast_to(omega[..., j, None], (*size, 1))
                        place = slice(top, top + rows), slice(left, left + columns)
                        part[place] += own[place] * texture
            total += part if size == scene.appearance.atlas else finer(part, *scene.appearance.atlas)
        channels.append(total)
    together = np.concatenate(channels, axis=2)
    return np.broadcast_to(
        together if scene.appearance.to_rgb is None else together @ scene.appearance.to_rgb.T,
        (*scene.appearance.atlas, 3),
    )


def finer(grid: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """(rows, columns, C): Catmull-Rom of a grid, taps clamped to the border."""
    return np.einsum("rh,cw,hwk->rck", taps(rows, grid.shape[0]), taps(columns, grid.shape[1]), grid, optimize=True)


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
    return replace(made, proxy=Proxy(Mesh(corners, np.array([[0, 1, 2], [1, 3, 2]], np.int32), uv.astype(np.float32))))


def ray_weights(made: Scene, eye: np.ndarray, size: tuple[int, int], low: float, high: float) -> np.ndarray:
    """(h, w, No): the definition for each texel of a flat scene, continued beyond the square."""
    plane = made.rig.view_plane
    normal = np.cross(plane.right, plane.up)
    row, column = np.indices(size)
    u, v = (column + 0.5) / size[1], (row + 0.5) / size[0]
    points = (np.stack([u - low, v - low, 0.0 * u], axis=-1) / (high - low) * 2 - [1, 1, 0]).reshape(-1, 3)
    along = ((plane.origin - points) @ normal) / ((eye - points) @ normal)
    places = plane.coordinates(points + along[:, None] * (eye - points))
    return np.array([view_weights(made, tuple(place)).dense(made.observations) for place in places]).reshape(*size, -1)


def write(folder: Path) -> None:
    """Write layered.glb and flat.glb, and add their pictures to references.json, which is there."""
    listing = folder / "references.json"
    pictures = json.loads(listing.read_text(encoding="utf-8"))

    def keep(name: str, made: Scene, texture: np.ndarray, camera: Camera, filter: str, **what: object) -> None:
        texels = np.ascontiguousarray(texture, dtype=np.float32)
        picture = draw_texture(made.proxy.mesh, texels, camera, filter=filter, samples=1).to_uint8()
        file = f"{name}-{len(pictures)}.png"
        Image.fromarray(picture).save(folder / file)
        size = {"width": camera.width, "height": camera.height}
        missing = dict.fromkeys(("at", "camera", "free", "count"))
        pictures.append({"scene": f"{name}.glb", "file": file, "filter": filter, **missing, **what, **size})

    layered = kept_as_png(layered_scene())
    level = flat(layered, 0.0, 1.0)
    for name, made in (("layered", layered), ("flat", level)):
        save(made, folder / f"{name}.glb", overwrite=True)
    for filter in ("bilinear", "bicubic"):
        for count, at in ((None, PLACES[1]), (None, PLACES[2]), (0, PLACES[1]), (2, PLACES[1]), (4, PLACES[1])):
            camera, weights = viewpoint(layered, at=at)
            keep("layered", layered, composed(layered, weights, count), camera, filter, at=at, count=count)
    sizes = {size for plane in level.appearance.planes for size in plane.sizes}
    for eye in FREE:
        view = free_camera(np.array(eye))
        weights = {size: ray_weights(level, np.array(eye), size, 0.0, 1.0) for size in sizes}
        free = {"K": view.K.tolist(), "R": view.R.tolist(), "t": view.t.tolist()}
        keep("flat", level, composed(level, weights), view, "bilinear", free=free)
    listing.write_text(json.dumps(pictures, indent=1), encoding="utf-8")


def kept_as_png(made: Scene) -> Scene:
    """The scene of 8-bit codes with PNG pictures: of each basis the first texture alone, the rest in one picture."""
    payloads = Payloads()
    for plane in made.appearance.planes:
        codes, affine = mean_codes(plane.mean)
        payloads |= {mean_key(plane.mean): [PicturePayload("png", encode(codes, "png", 0), 1, affine)]}
        for basis in plane.bases:
            pictures = [png_picture(basis, part) for part in (slice(0, 1), slice(1, None))]
            payloads |= {textures_key(basis): pictures}
    return encoded(made, payloads)


def encoded(made: Scene, payloads: Payloads) -> Scene:
    """The scene with what parts of it were coded to."""
    return replace(made, payloads=made.payloads | payloads)


def png_picture(basis: Basis, part: slice) -> PicturePayload:
    codes = np.concatenate([stacked_picture(texture) for texture in basis.textures[part]])
    affine = Affine(*(numbers[part].ravel().astype(np.float64) for numbers in (basis.scale, basis.zero)))
    data = encode(codes if codes.ndim == 3 else codes[..., None], "png", 0)
    return PicturePayload("png", data, len(basis.textures[part]), affine)
