"""Our own rate-distortion curve, the paper's way: the same few settings for every capture."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import eigenfield as ef
from eigenfield.capture import LightField
from eigenfield.core.proxy import Proxy
from eigenfield.encoding import EncodeOptions
from eigenfield.encoding.options import DEFAULT_PRESET
from eigenfield.encoding.reach_target import open_fitted
from eigenfield.gltf import parts, save
from eigenfield.rendering import Renderer
from eigenfield.runtime.parallel import parallel_stream
from evidence import rates
from evidence.codecs import evict
from evidence.prepared import Prepared, drawn

Fit = tuple[EncodeOptions, Sequence[int]]  # and the qualities at which it is coded, the same for all captures

QUALITIES: tuple[Fit, ...] = ((EncodeOptions(), (84, 91, 95)), (EncodeOptions(preset="small", quality=70), (70,)))
QUICK_QUALITIES: tuple[Fit, ...] = ((EncodeOptions(), (84, 91)),)

Setting = tuple[float, int | None, int, int]

# (density, triangles, textures, quality) of the paper's way, the same for all captures. None: the whole mesh, 1.1 MB of
# Tarot's file; a simplified one, which gets an atlas of many charts, is the better choice at low rates on Tarot, and
# nowhere on Shop. Points that cost more bytes than a better one do not count in `rates.bd_rate`.
POINTS: tuple[Setting, ...] = ((0.75, 4000, 10, 35), (0.75, None, 5, 35), (1.25, None, 20, 55), (1.5, None, 40, 70))
QUICK_POINTS = ((1.0, None, 10, 45), (1.25, None, 20, 55))

Covered = list[NDArray[np.bool_]]


def fitted(
    ready: Prepared,
    light_field: LightField,
    order: Sequence[int],
    photographs: Sequence[NDArray[np.uint8]],
    covered: Covered | None = None,
    asked: Sequence[Fit] = QUALITIES,
    stem: str = "quality",
    proxy: Proxy | None = None,
) -> tuple[dict[str, Any], Covered]:
    """The curve of what `encode` makes: fits coded at some qualities, every byte of the real .glb counted, each camera
    drawn with its own weights; and the pixels that count.

    order: views of the light field; photographs, covered: theirs; None: what the proxy covers as it is first coded.
    stem: of the files' names. proxy: what `encode` makes by itself; None: the mesh of the proxy's file.
    """
    points: list[dict[str, Any]] = []
    names = [light_field.names[index] for index in order]
    fits: dict[str, dict[str, Any]] = {}
    for options, some in asked:
        preset = options.preset or DEFAULT_PRESET
        started = time.perf_counter()
        with open_fitted(light_field, proxy or ready.mesh, options, work=ready.work) as encoder:
            fit = time.perf_counter() - started
            for quality in some:
                started = time.perf_counter()
                scene = encoder.encode(quality)
                path = ready.work / f"{stem}-{quality}.glb"
                save(scene, path, overwrite=True)
                seconds = time.perf_counter() - started
                covered = covered or covered_pixels(path, order, light_field)
                points.append(
                    {
                        "parameter": quality,
                        "preset": preset,
                        "file": path.name,
                        "bytes": path.stat().st_size,
                        "parts": dict(parts(path)),
                        "textures": scene.appearance.textures,
                        "encode_seconds": round(fit + seconds, 2),
                        "access_seconds": access(path, order[len(order) // 2]),
                        **figures(path, order, photographs, covered, names),
                    }
                )
        uncoded = {name: one["uncoded"] for name, one in scene.settings["fitted"]["psnr"].items()}
        key = preset if options.quality is None else f"{preset}, quality {options.quality}"
        fits[key] = {"seconds": round(fit, 1), "uncoded": uncoded}
    assert covered is not None
    points.sort(key=lambda point: point["parameter"])
    return {"name": "eigenfield", "kind": "ours", "points": points, "fits": fits}, covered


def paper(
    ready: Prepared,
    light_field: LightField,
    order: Sequence[int],
    photographs: Sequence[NDArray[np.uint8]],
    covered: Covered,
) -> dict[str, Any]:
    """The same curve of `--fit none`, as a peer's."""
    points = []
    names = [light_field.names[index] for index in order]
    for density, triangles, textures, quality in QUICK_POINTS if ready.quick else POINTS:
        path = ready.work / f"rate-{density:g}-{triangles}-{textures}-{quality}.glb"
        started = time.perf_counter()
        scene = ef.encode(light_field, ready.mesh, textures=textures, density=density, triangles=triangles, fit="none")
        save(scene, path, quality=quality, overwrite=True)
        seconds = time.perf_counter() - started
        points.append(
            {
                "parameter": f"density {density:g}, {len(scene.proxy.mesh.faces)} triangles, "
                f"N {scene.appearance.textures}, quality {quality}",
                "bytes": path.stat().st_size,
                "parts": dict(parts(path)),
                "encode_seconds": round(seconds, 2),
                "access_seconds": access(path, order[len(order) // 2]),
                **figures(path, order, photographs, covered, names),
            }
        )
    return {"name": "eigenfield, --fit none", "key": "fit-none", "kind": "paper", "points": points}


def figures(
    path: Path,
    order: Sequence[int],
    photographs: Sequence[NDArray[np.uint8]],
    covered: Sequence[NDArray[np.bool_]],
    names: Sequence[str],
) -> dict[str, Any]:
    """`rates.point` of a file's captured views, read and drawn again."""
    scene = ef.load(path)
    renderer = Renderer(scene)
    return rates.point(
        (picture for picture, _ in parallel_stream(lambda index: drawn(renderer, scene, index), order)),
        photographs, covered, names,
    )  # fmt: skip


def access(path: Path, index: int) -> dict[str, float]:
    """Seconds from a file out of the cache to the picture of one camera, and to that of the next one asked for."""
    evict(path)
    started = time.perf_counter()
    scene = ef.load(path)
    renderer = Renderer(scene)
    drawn(renderer, scene, index)
    first = time.perf_counter() - started
    drawn(renderer, scene, (index + 1) % len(scene.rig.cameras))
    return {"first": round(first, 4), "next": round(time.perf_counter() - started - first, 4)}


def covered_pixels(path: Path, order: Sequence[int], light_field: LightField) -> Covered:
    """The pixels that a file's mesh covers in some of a light field's views, within the mask where there is one."""
    scene = ef.load(path)
    renderer, cameras = Renderer(scene), dict(zip(scene.rig.names, range(len(scene.rig.names)), strict=True))

    def of_view(index: int) -> NDArray[np.bool_]:
        mask = light_field.photograph(index).mask
        covered = drawn(renderer, scene, cameras[light_field.names[index]])[1]
        return covered if mask is None else covered & (mask > 0.5)

    return list(parallel_stream(of_view, order))
