"""Frames per second of the software renderer against the number of eigen textures (the paper's section 4.3).

    [EIGENFIELD_DATA=captures] python benchmarks/render.py

A frame is everything from a viewpoint to an 8-bit RGB picture in memory: the novel camera and its view weights,
equation 8 for the tiles in view, rasterising and shading. The viewpoint moves every frame and nothing composed is kept.
The scene is a bumpy relief of 29,282 triangles that fills the view with almost all of its atlas, 1024² and random 8-bit
textures; with EIGENFIELD_DATA also Tarot's own proxy (66,208 triangles). The relief is also drawn with a default file's
appearance: luma apart from chroma, eigen textures of 16 bits at half the density of the mean. It is drawn so as one
opaque surface, and as eight sheets that reach under each other. Beside it, in the same run: one sample a pixel at edges
too, summing the textures by NumPy's matrix product, and the memory bandwidth that reading reaches. Processor time is
that of all threads.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import measure
from eigenfield.core.appearance import Appearance, Basis, Plane
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.core.rig import Rig
from eigenfield.core.scene import Scene
from eigenfield.core.viewplane import fit_view_plane
from eigenfield.rendering import Renderer, delaunay_triangles, novel_camera, view_weights
from eigenfield.rendering.software.kernels import TILE_AREA, TILE_TEXELS
from eigenfield.rendering.software.tiles import compose, empty_layers, tile
from eigenfield.runtime.jit import kernel
from eigenfield.runtime.parallel import parallel_map, pieces, threads

SIDE, WIDTH, HEIGHT = 1024, 1024, 768
COUNTS = (1, 7, 15, 40, 100)
FRAMES, WARM_UP = 120, 10
WAYS: dict[str, tuple[str, int | None]] = {  # filter and samples a pixel
    "bilinear": ("bilinear", None), "bicubic": ("bicubic", None), "bicubic_one_sample": ("bicubic", 1),
}  # fmt: skip


def relief(nodes: int = 122) -> Mesh:
    """A bumpy rectangle at z = 0 that fills every view and uses the whole atlas."""
    steps = np.linspace(0, 1, nodes)
    v, u = np.meshgrid(steps, steps, indexing="ij")
    x, y = 2.16 * (u - 0.5), 1.62 * (v - 0.5)  # 5 % more than a view shows at the distance of 2
    corner = (np.arange(nodes - 1)[:, None] * nodes + np.arange(nodes - 1)).ravel()
    upper = np.stack([corner, corner + 1, corner + nodes], axis=1)
    lower = np.stack([corner + 1, corner + nodes + 1, corner + nodes], axis=1)
    vertices = np.stack([x, y, 0.08 * np.sin(9 * x) * np.cos(8 * y)], axis=-1).reshape(-1, 3)
    uv = np.stack([u, v], axis=-1).reshape(-1, 2)
    return Mesh(vertices.astype(np.float32), np.concatenate([upper, lower]).astype(np.int32), uv.astype(np.float32))


def array() -> list[Camera]:
    """17 x 17 rectified cameras: the relief stays where it is in their pictures, but for its bumps."""
    cameras = []
    for index in range(289):
        x, y = 0.05 * (index % 17 - 8), 0.05 * (index // 17 - 8)
        K = np.array([[1000.0, 0, WIDTH / 2 + 500 * x], [0, 1000, HEIGHT / 2 + 500 * y], [0, 0, 1]])
        cameras.append(Camera(K, np.eye(3), -np.array([x, y, -2.0]), WIDTH, HEIGHT))
    return cameras


def scene_of(mesh: Mesh, cameras: list[Camera], count: int) -> Scene:
    random = np.random.default_rng(0)
    textures = random.integers(0, 256, (count, SIDE, SIDE, 3), dtype=np.uint8)
    scale, zero = np.full((count, 3), 0.001, np.float32), np.full((count, 3), 128, np.float32)
    weights = random.normal(size=(len(cameras), count)).astype(np.float32)
    plane = fit_view_plane(cameras)
    places = plane.coordinates([camera.centre for camera in cameras])
    return Scene(
        proxy=Proxy(mesh=mesh),
        rig=Rig(
            names=tuple(str(index) for index in range(len(cameras))),
            cameras=tuple(cameras),
            held_out=np.zeros(len(cameras), bool),
            reference=len(cameras) // 2,
            view_plane=plane,
            triangles=delaunay_triangles(places),
        ),
        appearance=Appearance(
            planes=(Plane(random.random((SIDE, SIDE, 3)).astype(np.float32), (Basis(textures, scale, zero, weights),)),)
        ),
    )


def as_in_a_file(scene: Scene) -> Scene:
    """The scene with appearance as a default file of 40 eigen textures has it: that of Tarot, 5 x 4 cameras."""
    random, rows = np.random.default_rng(0), scene.observations

    def basis(count: int, side: int, channels: int) -> Basis:
        codes = random.integers(0, 1024, (count, side, side, channels), dtype=np.uint16)
        scale, zero = np.full((count, channels), 0.0003, np.float32), np.full((count, channels), 512, np.float32)
        return Basis(codes, scale, zero, random.normal(size=(rows, count)).astype(np.float32))

    luma = Plane(random.random((1280, 1280, 1)).astype(np.float32), (basis(40, 704, 1),))
    chroma = Plane(0.1 * random.random((656, 656, 2)).astype(np.float32), (basis(10, 384, 2),))
    to_rgb = np.array([[1, 0, 1.4], [1, -0.34, -0.71], [1, 1.77, 0]], np.float32)
    return replace(scene, appearance=Appearance(planes=(luma, chroma), to_rgb=to_rgb))


def in_sheets(scene: Scene, count: int = 8) -> Scene:
    """The scene's surface as sheets, strips from left to right, each of which reaches under the next."""
    mesh = scene.proxy.mesh
    assert mesh.uv is not None
    across = mesh.uv[mesh.faces, 0].mean(axis=1) * count
    parts, faces, before = [], [], 0
    for i in range(count):
        used, corners = np.unique(mesh.faces[(across >= i) & (across < i + 1.25)], return_inverse=True)
        parts.append(used)
        faces.append(corners.reshape(-1, 3) + before)
        before += len(used)
    kept, together = np.concatenate(parts), np.concatenate(faces).astype(np.int32)
    whole = Mesh(mesh.vertices[kept], together, mesh.uv[kept])
    opacity = np.ones(scene.appearance.atlas, np.float32)
    return replace(scene, proxy=Proxy(whole, None, Sheets(tuple(len(part) for part in faces), opacity)))


def frames(scene: Scene, way: str, count: int = FRAMES) -> dict[str, Any]:
    """Milliseconds a frame along a circle of `count` frames through the array, at WIDTH x HEIGHT."""
    filter, samples = WAYS[way]
    renderer = Renderer(scene)
    taken, before = [], 0.0
    for number in range(-WARM_UP, count):
        if number == 0:
            before = time.process_time()
        angle = 2 * np.pi * number / count
        at = (0.7 * np.cos(angle), 0.7 * np.sin(angle))
        started = time.perf_counter()
        camera = novel_camera(scene, at).resize(WIDTH, HEIGHT)
        renderer.draw(camera, view_weights(scene, at), filter=filter, samples=samples).to_uint8()
        if number >= 0:
            taken.append(time.perf_counter() - started)
    worked = time.process_time() - before
    coverage = renderer.draw(camera, view_weights(scene, at), filter=filter, samples=samples).coverage.mean()
    return {
        "fps": round(1 / float(np.median(taken)), 1),
        "fps_best": round(1 / min(taken), 1),
        "fps_worst": round(1 / max(taken), 1),
        "milliseconds": round(1e3 * float(np.median(taken)), 2),
        "processor_milliseconds": round(1e3 * worked / count, 2),
        "coverage": round(float(coverage), 4),
    }


@kernel(fastmath=True)
def read_all(values):  # type: ignore[no-untyped-def]
    """The sum of a flat array with nothing else to do: memory is all that it waits for."""
    result = np.float32(0)
    for index in range(values.size):
        result += values[index]
    return result


def bandwidth() -> float:
    """Gigabytes a second that all threads together read from an array far larger than the caches."""
    values: NDArray[np.float32] = np.ones(1 << 27, np.float32)
    parts = pieces(len(values), 1 << 22)
    return values.nbytes / 1e9 / best(lambda: parallel_map(lambda part: read_all(values[slice(*part)]), parts))


def best(work: Callable[[], object]) -> float:
    """Seconds of the quickest of 7 times."""
    taken = []
    for _ in range(7):
        started = time.perf_counter()
        work()
        taken.append(time.perf_counter() - started)
    return min(taken)


def composition(scene: Scene) -> dict[str, Any]:
    """Equation 8 alone, over the whole atlas, beside NumPy's matrix product of weights and float32 textures."""
    plane = scene.appearance.planes[0]
    basis = plane.bases[0]
    omega = view_weights(scene, (0.31, -0.17)).blend(basis.weights)
    tiled = tile(plane.mean, plane.bases, np.ones((SIDE // TILE_TEXELS, SIDE // TILE_TEXELS), bool), 3)
    layers, tiles = empty_layers(SIDE, SIDE, 3), np.arange(len(tiled.places))
    opacity = np.zeros((1, TILE_AREA), np.float32)
    ours = best(lambda: compose(tiled, omega, tiles, opacity, layers))
    values = basis.values().reshape(basis.count, -1)
    row = omega.astype(np.float32)
    numpy = best(lambda: plane.mean.reshape(-1) + row @ values)
    return {
        "milliseconds": round(1e3 * ours, 2),
        "gb_per_second": round(basis.textures.nbytes / ours / 1e9, 1),
        "numpy_milliseconds": round(1e3 * numpy, 2),
        "ratio_to_numpy": round(ours / numpy, 3),
    }


def tarot(count: int) -> Scene | None:
    folder = os.environ.get("EIGENFIELD_DATA")
    if not folder:
        return None
    from eigenfield.capture import open_capture
    from eigenfield.proxy import read_mesh

    capture = Path(folder) / "tarot_17x17_512"
    views = open_capture(capture, calibration=capture / "calibration" / "refined.json").views
    return scene_of(read_mesh(capture / "calibration" / "proxy.ply"), [view.camera for view in views], count)


def main() -> None:
    speed = bandwidth()
    figures: dict[str, Any] = {"atlas": SIDE, "view": [WIDTH, HEIGHT], "threads": threads()}
    figures |= {"read_gb_per_second": round(speed, 2), "relief": {}}
    mesh, cameras = relief(), array()
    for count in COUNTS:
        scene = scene_of(mesh, cameras, count)
        row: dict[str, Any] = {way: frames(scene, way) for way in WAYS}
        moved = count * SIDE * SIDE * 3 / 1e9
        row["share_of_bandwidth"] = round(moved / (row["bilinear"]["milliseconds"] / 1e3) / speed, 3)
        figures["relief"][str(count)] = row
        print(count, row, flush=True)
    as_filed = as_in_a_file(scene_of(mesh, cameras, 0))
    for name, scene in (("file_40", as_filed), ("file_40_sheets", in_sheets(as_filed))):
        figures[name] = {way: frames(scene, way) for way in WAYS}
        print(name, figures[name], flush=True)
    figures["composition_40"] = composition(scene_of(mesh, cameras, 40))
    print(figures["composition_40"])
    own = tarot(40)
    if own is not None:
        figures["tarot_proxy_40"] = {way: frames(own, way) for way in WAYS}
        print("Tarot's proxy", figures["tarot_proxy_40"])
    print(f"stored as {measure.store('render', figures)}")


if __name__ == "__main__":
    main()
