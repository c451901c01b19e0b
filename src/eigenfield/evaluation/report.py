"""All figures of a scene against its photographs: one pass, a camera at a time for each thread."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from eigenfield.capture import LightField
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.encoding.residual import with_differences
from eigenfield.evaluation.exclusion import Circle
from eigenfield.evaluation.image import summary
from eigenfield.evaluation.session import Measured, Session, start_session
from eigenfield.gltf import parts
from eigenfield.runtime.parallel import parallel_stream

SCHEMA = "eigenfield.evaluate/1"


def evaluate(
    scene: Scene,
    capture: LightField,
    *,
    path: str | os.PathLike[str] | None = None,
    curve: str = "none",
    textures: int | None = None,
    filter: str = "bicubic",
    weights: str = "delaunay",
    circles: Mapping[str, Circle] | None = None,
    png_maps: str = "all",
    flip: bool = False,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Measure a scene against its photographs; docs/measures.md defines every figure. The result is ready for JSON.

    path: the scene's file, for `bytes` and `ratio`; both are None without it. curve: "all" cameras or a "sample" of 16:
    the UV measure for every number of textures; "none": not. textures: use only the first so many. filter: "bicubic" or
    "bilinear", for drawing. weights: view weights of held-out cameras, "delaunay", "nearest3" or "bilinear". circles:
    by camera, left out of the figures under `outside` (see `read_circles`). png_maps: "all", "sample" (16 maps, scaled
    up) or "none": the texture maps as PNG. flip: measure FLIP too, which takes longer.

    Raises CaptureError `no-photographs` when no photograph has the name of a camera, `photograph-size`, and what
    reading photographs raises; OptionError `png-maps`, `textures`, `not-photographs`, `settings-unknown`.
    """
    started = time.monotonic()
    session = start_session(
        scene, capture, curve=curve, textures=textures, filter=filter, weights=weights, circles=circles,
        png_maps=png_maps, flip=flip,
    )  # fmt: skip
    indices = list(session.photographs)
    views = with_differences(scene, indices, session.measures_residual)
    measured = parallel_stream(lambda view: (view[0], session.measure(*view)), views)
    found = dict(track(measured, "measuring", len(indices), progress))
    results = {index: found[index] for index in indices}
    figures: dict[str, Any] = {
        "schema": SCHEMA,
        "textures": session.counts[-1],
        "filter": filter,
        "weights": weights,
        "uv": _uv(session, results, -1),
        "image": {
            "encoded": _image(session, results, False),
            "residual": _residual(session, results),
            "held_out": _image(session, results, True),
        },
        "bytes": None if path is None else dict(parts(Path(path))),
        "ratio": None if path is None else _ratios(session, results, parts(Path(path))["total"]),
        "png_maps": _png_maps(session, results, png_maps),
        "missing": [name for index, name in enumerate(scene.rig.names) if index not in session.photographs],
        "cameras": [_camera(session, index, result) for index, result in results.items()],
    }
    if curve != "none":
        figures["curve"] = [
            {
                "textures": count,
                "uv_ssim": point["ssim"] if point else None,
                "uv_psnr": point["psnr"] if point else None,
                "cameras": len(session.curved),
            }
            for at, count in enumerate(session.counts)
            for point in [_uv(session, {index: results[index] for index in session.curved}, at)]
        ]
    figures["seconds"] = time.monotonic() - started
    return _rounded(figures)


def stored_scores(figures: Mapping[str, Any]) -> dict[str, Any]:
    """The figures that go into a file's `scores`, small and the same at any time: without seconds, single cameras, and
    bytes, which the file itself tells. Ratios count the file as it was measured, before it took these in."""
    left_out = {"seconds", "cameras", "bytes", "missing"}
    return {key: value for key, value in figures.items() if key not in left_out}


def _uv(session: Session, results: Mapping[int, Measured], at: int) -> dict[str, Any] | None:
    """Mean and worst of the UV measure at position `at` of the session's counts."""
    taken = [(session.scene.rig.names[i], r.texture) for i, r in results.items() if r.texture is not None]
    if not taken:
        return None
    return summary([{"ssim": t.ssim[at], "psnr": t.psnr[at]} for _, t in taken], [name for name, _ in taken])


def _image(session: Session, results: Mapping[int, Measured], held_out: bool) -> dict[str, Any] | None:
    indices = [index for index in results if bool(session.scene.rig.held_out[index]) == held_out]
    if not indices:
        return None
    names = [session.scene.rig.names[index] for index in indices]
    figures = {"cameras": len(indices), **summary([results[index].image for index in indices], names)}
    outside = [result for index in indices if (result := results[index].outside) is not None]
    if outside:
        figures["outside"] = summary(outside, names)
    return figures


def _residual(session: Session, results: Mapping[int, Measured]) -> dict[str, Any] | None:
    """The encoded cameras' figures with the residual; never of others."""
    found = {index: result.residual for index, result in results.items() if result.residual is not None}
    if not found:
        return None
    names = [session.scene.rig.names[index] for index in found]
    figures = {"cameras": len(found), **summary([image for image, _ in found.values()], names)}
    outside = [part for _, part in found.values() if part is not None]
    if outside:
        figures["outside"] = summary(outside, names)
    return figures


def _camera(session: Session, index: int, result: Measured) -> dict[str, Any]:
    texture = result.texture
    figures: dict[str, Any] = {
        "name": session.scene.rig.names[index],
        "held_out": bool(session.scene.rig.held_out[index]),
        "psnr": result.image["psnr"],
        "ssim": result.image["ssim"],
        "coverage": result.image["coverage"],
        "uv_psnr": None if texture is None else texture.psnr[-1],
        "uv_ssim": None if texture is None else texture.ssim[-1],
    }
    if result.residual is not None:
        figures["residual"] = {key: result.residual[0][key] for key in ("psnr", "ssim")}
    return figures | ({"flip": result.image["flip"]} if "flip" in result.image else {})


def _png_maps(session: Session, results: Mapping[int, Measured], mode: str) -> dict[str, Any] | None:
    """Bytes of all encoded cameras' filled maps as PNG; scaled up from those that were packed."""
    sizes = [r.texture.png for r in results.values() if r.texture is not None and r.texture.png is not None]
    if not sizes:
        return None
    total = len(session.scene.rig.encoded)
    return {"mode": mode, "packed": len(sizes), "of": total, "bytes": round(sum(sizes) * total / len(sizes))}


def _ratios(session: Session, results: Mapping[int, Measured], size: int) -> dict[str, float | None]:
    """How many times smaller the file is than the encoded photographs' files, all maps as PNG, and raw pixels."""
    scene = session.scene
    maps = _png_maps(session, results, "")
    photographs = _photograph_bytes(session)
    return {
        "photographs": None if photographs is None else photographs / size,
        "texture_maps_png": None if maps is None else maps["bytes"] / size,
        "raw": sum(3 * scene.rig.cameras[index].width * scene.rig.cameras[index].height for index in scene.rig.encoded)
        / size,
    }


def _photograph_bytes(session: Session) -> int | None:
    """Size of the encoded photographs' files; where some are missing, what the encoder recorded."""
    encoded = [int(index) for index in session.scene.rig.encoded]
    if all(index in session.photographs for index in encoded):
        return sum(session.capture.bytes(session.photographs[index]) for index in encoded)
    recorded = session.scene.settings.get("photographs")
    size = recorded.get("bytes") if isinstance(recorded, Mapping) else None
    return size if isinstance(size, int) else None


def _rounded(value: Any) -> Any:
    """Floats to six decimals, all the way down: more is noise, and JSON would print it."""
    if isinstance(value, float):
        return round(value, 6)
    if isinstance(value, Mapping):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_rounded(entry) for entry in value]
    return value
