"""Drawing of the demo's capture: noise-free photographs of a gantry camera, with exactly known geometry."""

from __future__ import annotations

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.writers.transforms import transforms_document
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError, OutputError
from eigenfield.core.progress import Progress, track
from eigenfield.demo.cameras import array_cameras
from eigenfield.demo.geometry import (
    ALL_PARTS,
    CHROME_SPHERE,
    GLASS_SPHERE,
    DemoGeometry,
    build_geometry,
    build_surroundings,
)
from eigenfield.demo.light import environment_map
from eigenfield.demo.rays import Tree, build_tree
from eigenfield.demo.shading import shade_view
from eigenfield.demo.surface import bake_surface
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import write_ply
from eigenfield.runtime.files import output_errors, rename
from eigenfield.runtime.parallel import parallel_stream
from eigenfield.runtime.temporary import temporary_folder

DEMO_ROWS, DEMO_COLUMNS = 9, 9  # of the array
DEMO_SAMPLES_PER_SIDE = 3  # of a pixel
DEMO_EXPOSURE = 1.05
DEMO_TEXELS_PER_PIXEL = 4  # side of the atlas over side of the picture
DEMO_MAX_ATLAS_TEXELS = 4096
BALLS = {"chrome": CHROME_SPHERE, "glass": GLASS_SPHERE}  # that show what is around them


class Look(NamedTuple):
    """What a view is shaded with, beside the geometry; see `shade_view`.

    Attributes:
        surface: (h, w, 8) of `build_geometry`.
        around: (h, w, 8) of `build_surroundings`.
        tree: Of `build_surroundings`.
        room: (3, e, e, 3).
        scene: Whose mesh and atlas they see.
        spheres: (2, 4) centre and radius of the chrome and the glass ball.
    """

    surface: NDArray[np.float32]
    around: NDArray[np.float32]
    tree: Tree
    room: NDArray[np.float32]
    scene: DemoGeometry
    spheres: NDArray[np.float64]


def bake_look(side: int) -> Look:
    """All that the views share.

    Args:
        side: Of the surface's atlas, in texels.
    """
    scene, around = build_geometry(), build_surroundings()
    return Look(
        bake_surface(scene, side),
        bake_surface(around, max(3 * side // 4, 64)),
        build_tree(around.mesh),
        environment_map(),
        scene,
        np.array([(*middle, radius) for middle, radius in BALLS.values()]),
    )


def draw_demo_capture(
    folder: Path,
    *,
    rows: int = DEMO_ROWS,
    columns: int = DEMO_COLUMNS,
    size: int = 512,
    progress: Progress | None = None,
) -> None:
    """Draw the array's views into a folder: images/*.png, transforms.json (nerfstudio's form) and proxy.ply.

    The folder appears by rename when it is complete. The same arguments give the same bytes, at any number of threads.

    Args:
        size: Side of the pictures in pixels.

    Raises:
        OutputError: `output-exists`, `no-folder`, `disk-full` or `not-writable`.
        OptionError: `demo-size`.
    """
    if rows < 1 or columns < 1 or rows * columns < 3 or size < 16:
        raise OptionError(
            "demo-size",
            f"{rows}x{columns} views of {size} pixels were asked for",
            remedy="ask for 3 views or more, of 16",
        )
    folder = Path(folder)
    if folder.exists():
        raise OutputError("output-exists", "exists already", path=folder, remedy="remove it or name another folder")
    parent = folder.absolute().parent
    if not parent.is_dir():
        raise OutputError("no-folder", "its folder does not exist", path=folder, remedy=f"create {parent}")
    with output_errors(folder), temporary_folder(folder.name, parent) as work:
        _draw_into(work, rows, columns, size, progress)
        work.chmod(0o755)  # it was its maker's alone
        rename(work, folder)


def _draw_into(folder: Path, rows: int, columns: int, size: int, progress: Progress | None) -> None:
    mesh = build_geometry().mesh
    write_ply(mesh, folder / "proxy.ply")
    cameras = array_cameras(rows, columns, size)
    names = [f"images/{index // columns:02d}_{index % columns:02d}.png" for index in range(len(cameras))]
    views = tuple(View(name, folder / name, camera) for name, camera in zip(names, cameras, strict=True))
    document = transforms_document(LightField(folder, views, (), "transforms"), folder, None)
    (folder / "images").mkdir()
    (folder / "transforms.json").write_text(json.dumps(document, indent=1), encoding="utf-8", newline="\n")
    look = bake_look(min(DEMO_TEXELS_PER_PIXEL * size, DEMO_MAX_ATLAS_TEXELS))

    stream = track(parallel_stream(lambda camera: draw_png(camera, look), cameras), "draw", len(cameras), progress)
    for name, data in zip(names, stream, strict=True):
        (folder / name).write_bytes(data)


def draw_png(camera: Camera, look: Look, samples: int = DEMO_SAMPLES_PER_SIDE) -> bytes:
    """The file of `draw_view`."""
    import cv2

    picture = draw_view(camera, look, samples)
    done, data = cv2.imencode(".png", picture[..., ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 2])
    assert done
    return data.tobytes()


def draw_view(camera: Camera, look: Look, samples: int = DEMO_SAMPLES_PER_SIDE) -> NDArray[np.uint8]:
    """(H, W, 3) uint8 sRGB: the scene as a camera sees it, averaged over several points a pixel in linear light.

    Args:
        camera: Of the view.
        look: Of its time.
        samples: Points on each side of a pixel.
    """
    scene, mesh = look.scene, look.scene.mesh
    assert mesh.uv is not None
    fine = camera.resize(samples * camera.width, samples * camera.height)
    raster = rasterise_view(mesh, fine)
    rays = np.ascontiguousarray(fine.R.T @ np.linalg.inv(fine.K))
    picture = np.empty((camera.height, camera.width, 3), np.float32)
    texels = np.concatenate([mesh.uv * float(look.surface.shape[0]), np.ones((len(mesh.uv), 1))], axis=1)[mesh.faces]
    maps = np.einsum("fkt,fke->fte", texels, raster.edges)
    balls = np.full(len(ALL_PARTS), -1)
    balls[[ALL_PARTS.index(name) for name in BALLS]] = range(len(BALLS))
    shade_view(
        raster.face, maps, balls[scene.part], rays, camera.centre, look.surface, look.around, *look.tree,
        look.spheres, look.room, samples, picture,
    )  # fmt: skip
    return _tone_map(picture)


def _tone_map(linear: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Linear light as 8-bit sRGB, with an exponential shoulder for the highlights."""
    x = DEMO_EXPOSURE * linear
    high = np.maximum(x - 0.6, 0)
    x = np.minimum(x, np.float32(0.6)) + np.float32(0.4) * (1 - np.exp(-high / np.float32(0.4)))
    coded = np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.power(np.maximum(x, 1e-8), 1 / 2.4) - 0.055)
    return np.clip(np.round(coded * 255), 0, 255).astype(np.uint8)
