"""What each parameter is worth, the paper's way: one at a time from the defaults, on encoded and held-out cameras."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import eigenfield as ef
from eigenfield.capture import LightField
from eigenfield.core.scene import Scene
from eigenfield.encoding.options import DEFAULT_DENSITY
from eigenfield.gltf import encode_scene
from eigenfield.gltf.write import DEFAULT_AVIF_QUALITY
from eigenfield.imaging.metrics import psnr, ssim
from eigenfield.rendering import Renderer, camera_weights
from eigenfield.runtime.parallel import parallel_map
from evidence.between import weights_study
from evidence.prepared import Prepared, codes, grid_of, spread_over_array

DENSITIES = (0.5, 0.75, 1.0, 1.5, 2.0, 3.0)
QUALITIES = (25, 40, 55, 70, 85)
SAMPLE = 16  # cameras of each kind that are drawn
TEXTURES = 15
HEAD = ["kB", "encoded dB", "SSIM", "held out dB", "SSIM"]


def studies(prepared: Prepared) -> dict[str, Any]:
    """Tables for the page: title, columns, rows, and in words what was kept fixed."""
    base = _base(prepared)
    tables = [of(prepared, base) for of in (_densities, _filters, _alignment, _codecs, _weights)]
    cameras = _cameras(prepared)
    return {
        "title": f"{prepared.capture.title}: {TEXTURES} textures, density 1.5, {prepared.hold_out} held out, unless"
        f" said; means over {SAMPLE} cameras of each kind, spread over the array, over the whole frame",
        "tables": tables if cameras is None else [*tables, cameras],
    }


@dataclass(frozen=True, eq=False)
class Base:
    """The scene from which one parameter at a time departs: as it was encoded, as its file gives it back, its row."""

    scene: Scene
    kept: Scene
    row: list[Any]


def _base(prepared: Prepared) -> Base:
    scene = _encode(prepared)
    kept, size = _decoded(scene, prepared)
    return Base(scene, kept, _row(kept, prepared.light_field, size))


def _measured(scene: Scene, prepared: Prepared, codec: str = "avif", quality: int | None = None) -> list[Any]:
    kept, size = _decoded(scene, prepared, codec, quality)
    return _row(kept, prepared.light_field, size)


def _encode(prepared: Prepared, **options: Any) -> Scene:
    options = {"textures": TEXTURES, "hold_out": prepared.hold_out, "fit": "none", **options}
    return ef.encode(prepared.light_field, prepared.mesh, **options)


def _decoded(scene: Scene, prepared: Prepared, codec: str = "avif", quality: int | None = None) -> tuple[Scene, int]:
    """The scene as its file gives it back, and the file's bytes."""
    data = encode_scene(scene, codec=codec, quality=quality)
    path = prepared.work / "study.glb"
    path.write_bytes(data)
    return ef.load(path), len(data)


def _row(scene: Scene, light_field: LightField, size: int | None, filter: str = "bicubic") -> list[Any]:
    """The columns of HEAD: the bytes, then both kinds of cameras."""
    renderer = Renderer(scene)
    row: list[Any] = [None if size is None else round(size / 1e3)]
    for indices in (scene.rig.encoded.tolist(), np.flatnonzero(scene.rig.held_out).tolist()):
        chosen = spread_over_array(scene, indices, SAMPLE) if indices else []

        def of_camera(index: int) -> tuple[float, float]:
            image = renderer.draw(scene.rig.cameras[index], camera_weights(scene, index), filter=filter).image
            photograph = codes(light_field, index)
            return psnr(image, photograph) or 0.0, ssim(image, photograph) or 0.0

        found = np.array(parallel_map(of_camera, chosen)).reshape(-1, 2)
        row += (
            [None, None]
            if not len(found)
            else [round(float(v), d) for v, d in zip(found.mean(axis=0), (2, 4), strict=True)]
        )
    return row


def _densities(prepared: Prepared, base: Base) -> dict[str, Any]:
    rows = []
    for density in DENSITIES:
        scene = base.scene if density == DEFAULT_DENSITY else _encode(prepared, density=density)
        row = base.row if scene is base.scene else _measured(scene, prepared)
        rows.append([f"{density:g}", scene.settings["atlas"][0], *row])
    return {
        "title": "Atlas density", "columns": ["asked for", "side", *HEAD], "rows": rows,
        "words": "Texels per photograph pixel along one axis; the side is at most 4096, the texels at most twice the"
        " photographs' pixels.",
    }  # fmt: skip


def _filters(prepared: Prepared, base: Base) -> dict[str, Any]:
    kept, size = _decoded(base.scene, prepared)
    rows = [[way, *_row(kept, prepared.light_field, size, way)] for way in ("bilinear", "bicubic")]
    return {"title": "Filters of the drawing", "columns": ["", *HEAD], "rows": rows, "words": ""}


def _alignment(prepared: Prepared, base: Base) -> dict[str, Any]:
    rows = [["none", *base.row], ["dis", *_measured(_encode(prepared, align=True), prepared)]]
    return {
        "title": "Alignment by optical flow", "columns": ["", *HEAD], "rows": rows,
        "words": "The paper aligns the texture maps to a central camera; the flow is not kept, so the drawing has it no"
        " more.",
    }  # fmt: skip


def _codecs(prepared: Prepared, base: Base) -> dict[str, Any]:
    rows: list[list[Any]] = [["none", "", *_row(base.scene, prepared.light_field, None)]]
    rows += [[codec, "", *_measured(base.scene, prepared, codec)] for codec in ("png", "webp")]
    for quality in QUALITIES:
        row = base.row if quality == DEFAULT_AVIF_QUALITY else _measured(base.scene, prepared, "avif", quality)
        rows.append(["avif", quality, *row])
    return {"title": "Codec and quality", "columns": ["codec", "quality", *HEAD], "rows": rows, "words": ""}


def _weights(prepared: Prepared, base: Base) -> dict[str, Any]:
    found = weights_study(base.kept, prepared.light_field, SAMPLE, prepared.circles())
    rows = [[one["title"], round(one["psnr"], 2), round(one["ssim"], 4)] for one in found["methods"]]
    return {
        "title": "View weights of held-out cameras", "columns": ["", "dB", "SSIM"], "rows": rows,
        "words": "nearest3 is equation 7 as printed; over covered pixels.",
    }  # fmt: skip


def _cameras(prepared: Prepared) -> dict[str, Any] | None:
    """Fewer and fewer cameras of a grid, always measured at the same ones that no case has seen."""
    light_field = prepared.light_field
    grid = grid_of(light_field)
    if grid is None or min(grid.rows, grid.columns) < 9:
        return None
    between = grid.index[1::2, 1::2]
    test = between[:: max(1, len(between) // 4), :: max(1, between.shape[1] // 4)].reshape(-1)
    subsets: list[tuple[str, NDArray[np.int64]]] = [
        (f"{grid.rows}x{grid.columns} without the measured ones", np.setdiff1d(grid.index, test)),
        (_named(grid.index[::2, ::2]), grid.index[::2, ::2]),
        (_named(grid.index[::4, ::4]), grid.index[::4, ::4]),
    ]
    if grid.rows == grid.columns == 17:
        subsets.append(("5x4", grid.index[2::4, ::4]))
    rows = []
    for name, encoded in subsets:
        some = light_field.subset(sorted({*encoded.reshape(-1).tolist(), *test.tolist()}))
        held = ",".join(light_field.names[index] for index in test)
        scene = ef.encode(some, prepared.mesh, textures=TEXTURES, hold_out=held, fit="none")
        kept, size = _decoded(scene, prepared)  # its photographs are in another order than the capture's
        rows.append([name, encoded.size, scene.appearance.textures, *_row(kept, some, size)])
    return {
        "title": "Number of cameras", "columns": ["encoded", "", "N", *HEAD], "rows": rows,
        "words": f"Held out are the same {len(test)} cameras each time. Cameras and mesh come from all photographs.",
    }  # fmt: skip


def _named(index: NDArray[Any]) -> str:
    return f"{index.shape[0]}x{index.shape[1]}"
