"""All scores of a scene against its photographs: one pass, one camera at a time in each thread."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from eigenfield.capture import Capture, open_any, with_scene_cameras
from eigenfield.core.arguments import checked
from eigenfield.core.errors import OptionError
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.encoding.residual.views import with_differences
from eigenfield.evaluation.exclusion import ExcludedCircle
from eigenfield.evaluation.image import summarise_scores
from eigenfield.evaluation.session import CameraScores, PictureScores, Session, start_session
from eigenfield.evaluation.spread import MeasureJob, measure_on
from eigenfield.gltf import load, parts
from eigenfield.runtime.parallel import parallel_stream
from eigenfield.runtime.tasks import Workers

EVALUATION_SCHEMA = "eigenfield.evaluate/1"


@checked
def evaluate(
    scene: Scene | str | os.PathLike[str],
    capture: str | os.PathLike[str] | Capture,
    *,
    path: str | os.PathLike[str] | None = None,
    curve: str = "none",
    textures: int | None = None,
    filter: str = "bicubic",
    weights: str = "delaunay",
    circles: Mapping[str, ExcludedCircle] | None = None,
    png_maps: str = "all",
    flip: bool = False,
    workers: Workers | None = None,
    progress: Progress | None = notebook_progress,
) -> dict[str, Any]:
    """Measure a scene against its photographs; docs/measures.md defines every score. The result is JSON-able.

    Args:
        scene: The scene, or its file.
        capture: Its photographs, or their folder; where they have no cameras, they take the scene's by name.
        path: The scene's file, for `bytes` and `ratio`; both are None without it. Default: the file that `scene` is.
        curve: Measure UV scores for every number of textures, of "all" cameras or a "sample" of 16; "none": do not.
        textures: Use only so many textures.
        filter: "bicubic" or "bilinear", for drawing.
        weights: View weights of held-out cameras: "delaunay", "nearest3" or "bilinear".
        circles: By camera, excluded from the scores under `outside` (see `read_circles`).
        png_maps: Pack "all" texture maps as PNG, a "sample" of 16 (scaled up), or "none".
        flip: Measure FLIP too, which takes longer.
        workers: Of `open_executor`: cameras are measured there, with the same scores. They read the scene from `path`.
        progress: Called for each camera; by default a bar in a notebook.

    Raises:
        CaptureError: `no-photographs`: no photograph has the name of a camera. `photograph-size`. As for reading
            photographs.
        OptionError: `png-maps`, `curve`, `textures`, `not-photographs`, `settings-unknown` or `workers-path`.
        OutputError: As `measure_on`.
    """
    started = time.monotonic()
    if not isinstance(scene, Scene):
        path = scene if path is None else path
        scene = load(scene)
    opened = open_any(capture) if isinstance(capture, str | os.PathLike) else capture
    photographs = with_scene_cameras(scene, opened)
    settings: dict[str, Any] = {
        "curve": curve, "textures": textures, "filter": filter, "weights": weights, "circles": circles,
        "png_maps": png_maps, "flip": flip,
    }  # fmt: skip
    if workers is not None and path is None:
        raise OptionError("workers-path", "workers read the scene from its file", remedy="name it as path")
    session = start_session(scene, photographs, **settings)
    indices = list(session.photographs)
    if workers is not None and path is not None:
        found = measure_on(workers, MeasureJob(Path(path), photographs, settings), indices, progress)
    else:
        views = with_differences(scene, indices, session.measures_residual)
        measured = parallel_stream(lambda view: (view[0], session.measure(*view)), views)
        found = dict(track(measured, "measuring", len(indices), progress))
    results = {index: found[index] for index in indices}
    held_out, maps = scene.rig.held_out, _png_maps(session, results, png_maps)
    scores: dict[str, Any] = {
        "schema": EVALUATION_SCHEMA,
        "textures": session.counts[-1],
        "filter": filter,
        "weights": weights,
        "uv": _uv(session, results, -1),
        "image": {
            "encoded": _image(session, {index: one.drawn for index, one in results.items() if not held_out[index]}),
            "residual": _image(session, {index: one.residual for index, one in results.items() if one.residual}),
            "held_out": _image(session, {index: one.drawn for index, one in results.items() if held_out[index]}),
        },
        "bytes": None if path is None else dict(parts(Path(path))),
        "ratio": None if path is None else _ratios(session, maps, parts(Path(path))["total"]),
        "png_maps": maps,
        "missing": [name for index, name in enumerate(scene.rig.names) if index not in session.photographs],
        "cameras": [_camera(session, index, result) for index, result in results.items()],
    }
    if curve != "none":
        scores["curve"] = [
            {
                "textures": count,
                "uv_ssim": point["ssim"] if point else None,
                "uv_psnr": point["psnr"] if point else None,
                "cameras": len(session.curved),
            }
            for at, count in enumerate(session.counts)
            for point in [_uv(session, {index: results[index] for index in session.curved}, at)]
        ]
    scores["seconds"] = time.monotonic() - started
    rounded: dict[str, Any] = json.loads(json.dumps(scores), parse_float=lambda text: round(float(text), 6))
    return rounded  # more decimals are noise


def stored_scores(scores: Mapping[str, Any]) -> dict[str, Any]:
    """The scores that are stored in a file, small and reproducible.

    They exclude seconds, single cameras, and bytes, which the file itself shows. Ratios are those of the file as
    measured, before it stored the scores."""
    left_out = {"seconds", "cameras", "bytes", "missing"}
    return {key: value for key, value in scores.items() if key not in left_out}


def _uv(session: Session, results: Mapping[int, CameraScores], at: int) -> dict[str, Any] | None:
    """Mean and worst of the UV scores at position `at` of the session's counts."""
    taken = [(session.scene.rig.names[i], r.texture) for i, r in results.items() if r.texture is not None]
    if not taken:
        return None
    return summarise_scores([{"ssim": t.ssim[at], "psnr": t.psnr[at]} for _, t in taken], [name for name, _ in taken])


def _image(session: Session, found: Mapping[int, PictureScores]) -> dict[str, Any] | None:
    if not found:
        return None
    names = [session.scene.rig.names[index] for index in found]
    scores = {"cameras": len(found), **summarise_scores([image for image, _ in found.values()], names)}
    outside = [part for _, part in found.values() if part is not None]
    if outside:
        scores["outside"] = summarise_scores(outside, names)
    return scores


def _camera(session: Session, index: int, result: CameraScores) -> dict[str, Any]:
    image, texture = result.drawn[0], result.texture
    scores: dict[str, Any] = {
        "name": session.scene.rig.names[index],
        "held_out": bool(session.scene.rig.held_out[index]),
        **{key: image[key] for key in ("psnr", "ssim", "coverage")},
        "uv_psnr": None if texture is None else texture.psnr[-1],
        "uv_ssim": None if texture is None else texture.ssim[-1],
    }
    if result.residual is not None:
        scores["residual"] = {key: result.residual[0][key] for key in ("psnr", "ssim")}
    return scores | ({"flip": image["flip"]} if "flip" in image else {})


def _png_maps(session: Session, results: Mapping[int, CameraScores], mode: str) -> dict[str, Any] | None:
    """Bytes of all encoded cameras' filled maps as PNG, scaled up from those that were packed."""
    sizes = [r.texture.png for r in results.values() if r.texture is not None and r.texture.png is not None]
    if not sizes:
        return None
    total = len(session.scene.rig.encoded)
    return {"mode": mode, "packed": len(sizes), "of": total, "bytes": round(sum(sizes) * total / len(sizes))}


def _ratios(session: Session, maps: Mapping[str, Any] | None, size: int) -> dict[str, float | None]:
    """How many times smaller the file is than the encoded photographs' files, all maps as PNG, and raw pixels."""
    photographs = _photograph_bytes(session)
    return {
        "photographs": None if photographs is None else photographs / size,
        "texture_maps_png": None if maps is None else maps["bytes"] / size,
        "raw": sum(3 * camera.width * camera.height for camera in session.scene.rig.encoded_cameras) / size,
    }


def _photograph_bytes(session: Session) -> int | None:
    """Size of the encoded photographs' files; if some are missing, the size that the encoder recorded."""
    encoded = [int(index) for index in session.scene.rig.encoded]
    if all(index in session.photographs for index in encoded):
        return sum(session.capture.bytes(session.photographs[index]) for index in encoded)
    return session.scene.provenance.photographs_bytes
