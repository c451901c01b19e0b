"""One capture of a batch, as a worker does it: paths and small numbers come in and go out.

A finished scene is a stage: the folder `NAME-KEY` with scene, page, poster and record appears by rename. Its key is of
the options, the program, and the names, sizes and times of the photographs' files, which need not be read for it.
In an object store it is of what the store lists, and what is copied from there goes when the task ends.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from eigenfield.batches.jobs import CaptureJob
from eigenfield.capture import Capture, open_any
from eigenfield.capture.identity import capture_identity
from eigenfield.capture.writers.save import save_calibration
from eigenfield.encoding import encode
from eigenfield.encoding.cost import expected_cost
from eigenfield.encoding.views import check_selection
from eigenfield.evaluation import evaluate, stored_scores
from eigenfield.gltf import load, save, store_scores
from eigenfield.proxy import refuse_no_mesh
from eigenfield.reconstruction.whole import reconstruct
from eigenfield.runtime.objects import DONE, find_objects, own_copies
from eigenfield.runtime.parallel import threads
from eigenfield.runtime.stages import Stages, stage_key
from eigenfield.runtime.tasks import installed, log_into, worker_name
from eigenfield.viewer.exports import write_guests_page

SCENES_FOLDER, WORK_FOLDER, LOGS_FOLDER = "scenes", "work", "logs"
RECORD_FILE = "record.json"
CALIBRATION_FILE = "transforms.json"


@own_copies()
def look_at(job: CaptureJob, output: Path) -> dict[str, Any]:
    """What a capture is expected to take, and its record if it is finished.

    Returns:
        `key`, `seconds` expected with this worker's threads, `memory` in bytes, and `record` or None.

    Raises:
        CaptureError, ProxyError, OptionError: The capture, or an option of it, cannot be used.
    """
    capture = None if _in_store(job) else _opened(job, output)
    key = stage_key([_inputs(job, capture), installed()])
    record = _finished(output / SCENES_FOLDER / f"{job.name}-{key}")
    if record is not None:
        return {"key": key, "seconds": 0.0, "memory": 0.0, "record": record}
    capture = capture or _opened(job, output)
    check_selection(capture, job.options)
    if job.proxy is not None:
        refuse_no_mesh(Path(job.proxy))
    cost = expected_cost(capture, job.options, job.surface, threads())
    return {"key": key, "seconds": cost.seconds, "memory": cost.memory, "record": None}


def _finished(place: Path) -> dict[str, Any] | None:
    """The record of a finished scene; None where there is none."""
    objects = find_objects(place / DONE)
    if objects is not None and not objects.exists():
        return None
    record = find_objects(place / RECORD_FILE)
    file = place / RECORD_FILE
    if record is None and not file.exists():
        return None
    found: dict[str, Any] = json.loads(file.read_bytes() if record is None else record.read())
    return found


@own_copies()
def encode_capture(job: CaptureJob, output: Path, key: str) -> dict[str, Any]:
    """Encode and measure a capture, unless it is finished.

    Returns:
        The record: name, files relative to `output`, bytes, scores, seconds, warnings.

    Raises:
        EigenfieldError: Of any step.
    """
    work = output / WORK_FOLDER / job.name

    def build(folder: Path) -> None:
        record = _make(job, output, work, folder)
        record["folder"] = f"{SCENES_FOLDER}/{job.name}-{key}"
        (folder / RECORD_FILE).write_text(json.dumps(record, indent=1), encoding="utf-8", newline="\n")

    place = Stages(output / SCENES_FOLDER).run(job.name, key, build)
    found: dict[str, Any] = json.loads((place / RECORD_FILE).read_text(encoding="utf-8"))
    return found


@own_copies()
def find_cameras(job: CaptureJob, output: Path) -> Path:
    """The cameras of a capture, found or as they are given, as a calibration that others use too.

    Raises:
        EigenfieldError: Of any step.
    """
    capture = _opened(job, output)
    surface = job.surface
    key = stage_key(["cameras", _inputs(job, capture), installed()])

    def build(folder: Path) -> None:
        light_field = capture.light_field
        if surface is not None:
            layers = surface.layers if surface.surface == "layers" else 1  # trials tell nothing about cameras
            made = reconstruct(capture, surface, layers=layers, work=output / WORK_FOLDER / job.name, progress=None)
            light_field = made.light_field
        assert light_field is not None
        save_calibration(light_field, folder / "calibration")

    return output / Stages(output).run("cameras", key, build).name / "calibration" / CALIBRATION_FILE


def _opened(job: CaptureJob, output: Path) -> Capture:
    frames = None if find_objects(output) else output / WORK_FOLDER / job.name / "frames"
    return open_any(job.path, job.place, work=frames)


def _in_store(job: CaptureJob) -> bool:
    """Whether anything of a capture lies in an object store, so that its files here are copies."""
    return any(find_objects(path) for path in job.sources)


def _inputs(job: CaptureJob, capture: Capture | None) -> list[Any]:
    """All that a capture's scene depends on, but the program; of one in an object store without opening it."""

    def of_file(path: Path) -> list[Any]:
        found = path.stat()
        return [path.name, found.st_size, found.st_mtime_ns]

    def of_place(path: str) -> list[Any]:
        objects, place = find_objects(path), Path(path)
        if objects is not None:
            return objects.stamps()
        return [of_file(one) for one in (sorted(place.rglob("*")) if place.is_dir() else [place])]

    proxy = None if job.proxy is None else of_place(job.proxy)
    options = asdict(job.options) | {"surface": None if job.surface is None else asdict(job.surface)}
    if capture is None:
        return [job.name, options, proxy, asdict(job.place), [of_place(path) for path in job.sources]]
    return [job.name, options, proxy, capture_identity(capture, of_file)]


def _make(job: CaptureJob, output: Path, work: Path, folder: Path) -> dict[str, Any]:
    """Scene, page and poster in a folder, and their record."""
    started = time.monotonic()
    warnings: list[str] = []
    scene_file, page = folder / f"{job.name}.glb", folder / f"{job.name}.html"
    with log_into(warnings):
        capture = _opened(job, output)
        if not find_objects(work):
            work.mkdir(parents=True, exist_ok=True)
        made = encode(
            capture, job.proxy, job.options, surface_options=job.surface, work=work, progress=None,
            blind=job.surface is not None and job.surface.blind is not None,
        )  # fmt: skip
        save(made, scene_file, **job.options.for_save)
        encoded = time.monotonic()
        scene = load(scene_file)
        figures = evaluate(scene, capture, path=scene_file, png_maps="none", progress=None)
        store_scores(scene_file, {**scene.scores, **stored_scores(figures)})
        write_guests_page(scene, page, title=job.name)
    image: Mapping[str, Any] = figures["image"]
    return {
        "name": job.name,
        "capture": job.path,
        "scene": scene_file.name,
        "page": page.name,
        "poster": page.with_suffix(".jpg").name,
        "bytes": scene_file.stat().st_size,
        "photographs": len(capture.sizes),
        "photographs_bytes": made.settings["photographs"]["bytes"],
        "textures": scene.appearance.textures,
        "psnr": _score(image["encoded"], "psnr"),
        "ssim": _score(image["encoded"], "ssim"),
        "held_out_psnr": _score(image["held_out"], "psnr"),
        "between_psnr_luma": _score(scene.scores.get("between"), "psnr_luma_at_least"),
        "between_psnr": _score(scene.scores.get("between"), "psnr"),
        "seconds": round(time.monotonic() - started, 1),
        "encode_seconds": round(encoded - started, 1),
        "worker": worker_name(),
        "warnings": [*capture.problems, *(line for line in warnings if line not in capture.problems)],
    }


def _score(part: Mapping[str, Any] | None, name: str) -> float | None:
    return None if part is None or part.get(name) is None else float(part[name])
