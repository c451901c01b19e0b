"""A capture made ready: its calibrated photographs, its proxy, the words that `eigenfield encode` needs for them."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

import measure
from eigenfield.capture import LightField, View, open_any, open_capture
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.core.scene import Scene
from eigenfield.core.viewplane import Grid, find_grid, fit_view_plane
from eigenfield.demo import draw_demo_capture
from eigenfield.evaluation import ExcludedCircle, read_circles
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.png import png_bytes
from eigenfield.proxy import prepare_proxy, read_mesh, write_mesh
from eigenfield.reconstruction.whole import reconstruct
from eigenfield.rendering import Renderer, camera_weights
from eigenfield.runtime.files import write_bytes
from eigenfield.runtime.parallel import parallel_map
from evidence.captures import Capture


@dataclass(frozen=True, eq=False)
class Prepared:
    """capture: what was asked for. work: folder of its scenes. where: words of `encode` and `evaluate` that name
    photographs and calibration. mesh_file: the proxy. hold_out: the rule. quick: fewer rates and counts."""

    capture: Capture
    work: Path
    where: tuple[str, ...]
    light_field: LightField
    mesh_file: Path
    hold_out: str
    quick: bool = False

    @property
    def mesh(self) -> Mesh:
        return read_mesh(self.mesh_file)

    def circles(self) -> Mapping[str, ExcludedCircle] | None:
        """Circles to leave out, by camera, where the capture has some."""
        file = self.capture.circles
        return None if file is None else read_circles(file, self.light_field.names)


def estimate(capture: Capture, work: Path) -> dict[str, Any]:
    """Make what is missing, once for all steps: the demo's capture, cameras, proxy, an atlas on a proxy that has none;
    says how, and what it took."""
    work.mkdir(parents=True, exist_ok=True)
    if capture.name == "demo" and not (capture.folder / "proxy.ply").exists():
        capture.folder.parent.mkdir(parents=True, exist_ok=True)
        draw_demo_capture(capture.folder, rows=17, columns=17)
    figures: dict[str, Any] = {"reconstructed": capture.proxy is None}
    if capture.proxy is not None:
        cameras = opened(words(capture)).cameras
        write_mesh(prepare_proxy(capture.proxy, cameras), work / "proxy.glb", overwrite=True)
    else:
        command = ["proxy", *words(capture), "-o", str(work / "proxy.glb"), "--work", str(work / "stages")]
        made = measure.run(["-m", "eigenfield", *command, "--overwrite", "--quiet"])
        figures |= {
            "seconds": made["seconds"], "peak_mb": made["peak_anonymous_mb"],
            "command": f"eigenfield {' '.join(command)}",
        }  # fmt: skip
    return figures


def own_proxy(capture: Capture, work: Path) -> Proxy | None:
    """What `encode` estimates, which may be soft sheets; None where the capture comes with a mesh.

    capture, work: as of `estimate`, whose stages are taken up.
    """
    if capture.proxy is not None:
        return None
    return reconstruct(open_any(capture.folder, calibration=capture.calibration), work=work / "stages").proxy


def prepare(capture: Capture, work: Path, quick: bool = False) -> Prepared:
    """What `estimate` left, opened."""
    where = words(capture)
    cameras = work / "proxy.cameras" / "transforms.json"
    if capture.calibration is None and cameras.exists():
        where = [str(capture.folder), "--calibration", str(cameras)]
    light_field = opened(where)
    rule = capture.hold_out
    if rule is None:
        grid = grid_of(light_field)
        rule = "odd" if grid is not None and min(grid.rows, grid.columns) > 2 else "every:2"
    return Prepared(capture, work, tuple(where), light_field, work / "proxy.glb", rule, quick)


def words(capture: Capture) -> list[str]:
    """Words of `encode` and `evaluate` that name the photographs, and the calibration that comes with them."""
    calibration = [] if capture.calibration is None else ["--calibration", str(capture.calibration)]
    return [str(capture.folder), *calibration]


def opened(where: Sequence[str]) -> LightField:
    """The capture that `words` names."""
    return open_capture(where[0], calibration=where[2] if len(where) > 1 else None)


def grid_of(light_field: LightField) -> Grid | None:
    """The grid on which the cameras stand, None where they stand on none."""
    cameras = light_field.cameras
    return find_grid(fit_view_plane(cameras).coordinates([camera.centre for camera in cameras]))


def every(light_field: LightField, step: int) -> LightField:
    """Every step-th row and column of a grid of cameras. Raises ValueError off a grid."""
    grid = grid_of(light_field)
    if grid is None:
        raise ValueError("the cameras are on no grid")
    return light_field.subset(sorted(grid.index[::step, ::step].reshape(-1).tolist()))


def halved(light_field: LightField, folder: Path) -> LightField:
    """The capture with photographs of half the size, written to `folder`, without lenses; masks are left out."""
    folder.mkdir(parents=True, exist_ok=True)

    def half(index: int) -> View:
        view, path = light_field.views[index], folder / f"{index:03d}.png"
        camera = view.camera.resize(view.camera.width // 2, view.camera.height // 2)
        pixels = cv2.resize(codes(light_field, index), (camera.width, camera.height), interpolation=cv2.INTER_AREA)
        write_bytes(path, png_bytes(np.asarray(pixels, np.uint8)), overwrite=True)
        return View(view.name, path, camera)

    return replace(light_field, views=tuple(parallel_map(half, range(len(light_field)))))


def spread_over_array(scene: Scene, indices: Sequence[int], count: int) -> list[int]:
    """`count` of the cameras `indices`, in rising order: those nearest the middles of as many even cells of the view
    plane, each taken once; all of them where there are no more."""
    if len(indices) <= count:
        return sorted(int(index) for index in indices)
    places = scene.rig.view_plane.coordinates(np.array([scene.rig.cameras[index].centre for index in indices]))
    rows = 1 if scene.rig.view_plane.is_line else max(1, round(math.sqrt(count)))
    shares = np.diff(np.rint(np.linspace(0, count, rows + 1)).astype(int))  # nodes in each row of cells
    free = np.ones(len(indices), bool)
    chosen = []
    for row, share in enumerate(shares):
        for column in range(share):
            node = ((2 * column + 1) / share - 1, (2 * row + 1) / rows - 1)
            away = np.where(free, ((places - node) ** 2).sum(axis=1), np.inf)
            nearest = int(np.argmin(away))
            free[nearest] = False
            chosen.append(int(indices[nearest]))
    return sorted(chosen)


def codes(light_field: LightField, index: int) -> NDArray[np.uint8]:
    """(H, W, 3) uint8: a photograph as the measures and the peers see it, undistorted where it has a lens."""
    return to_codes(light_field.photograph(index).pixels)


def drawn(renderer: Renderer, scene: Scene, index: int) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """What the scene draws from its camera `index`, 8-bit, and the covered pixels."""
    picture = renderer.draw(scene.rig.cameras[index], camera_weights(scene, index), filter="bicubic")
    return to_codes(picture.image), picture.covered


def first_textures(scene: Scene, count: int) -> Scene:
    """The scene with its first `count` eigen textures alone, as if it had been encoded so."""
    planes = tuple(
        replace(plane, bases=tuple(basis.truncate(count) for basis in plane.bases)) for plane in scene.appearance.planes
    )
    return replace(
        scene, appearance=replace(scene.appearance, planes=planes), settings={**scene.settings, "textures": count}
    )


def as_json(figures: Any) -> Any:
    """What JSON can hold: NumPy's numbers become Python's, floats keep six decimals."""
    return json.loads(
        json.dumps(figures, default=lambda value: value.item()), parse_float=lambda text: round(float(text), 6)
    )
