"""One capture or clip of a batch, as a worker does it: paths and small numbers come in and go out.

A finished scene is a stage: the folder `NAME-KEY` with scene, page, poster and record appears by rename. Its key is of
the options, the program, and the names, sizes and times of the photographs' files, which need not be read for it.
In an object store it is of what the store lists, and what is copied from there goes when the task ends.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from eigenfield.batches.jobs import CaptureJob
from eigenfield.capture import Capture, open_any, open_footage
from eigenfield.capture.footage import Footage
from eigenfield.capture.identity import capture_identity
from eigenfield.core.open_options import OpenOptions
from eigenfield.encoding import encode, encode_footage
from eigenfield.encoding.cost import expected_cost
from eigenfield.encoding.views import check_selection
from eigenfield.evaluation import evaluate, evaluate_clip, stored_scores
from eigenfield.gltf import load, save, store_scores
from eigenfield.proxy import refuse_no_mesh
from eigenfield.proxy.meshes.sequence import is_sequence, mesh_files
from eigenfield.runtime.objects import DONE, find_objects, own_copies
from eigenfield.runtime.parallel import threads
from eigenfield.runtime.stages import Stages, stage_key
from eigenfield.runtime.tasks import installed, log_into, worker_name
from eigenfield.viewer.exports import write_guests_page

SCENES_FOLDER, WORK_FOLDER, LOGS_FOLDER = "scenes", "work", "logs"
RECORD_FILE = "record.json"
FRAME_COST_RATIO = 0.3  # of a still's expected time, for each frame of a clip
MEASURED_FRAMES = 20  # of a clip, at least if it has so many


@own_copies()
def look_at(job: CaptureJob, output: Path) -> dict[str, Any]:
    """What a capture is expected to take, and its record if it is finished.

    Returns:
        `key`, `seconds` expected with this worker's threads, `memory` in bytes, and `record` or None.

    Raises:
        CaptureError, ProxyError, OptionError: The capture, or an option of it, cannot be used.
    """
    if job.proxy is not None and not is_sequence(Path(job.proxy)):
        refuse_no_mesh(Path(job.proxy))
    capture = None if _in_store(job) or job.place.clip is not None else _opened(job, output)
    key = stage_key([_inputs(job, capture), installed()])
    record = _finished(output / SCENES_FOLDER / f"{job.name}-{key}")
    if record is not None:
        return {"key": key, "seconds": 0.0, "memory": 0.0, "record": record}
    if job.place.clip is not None:
        footage = _footage(job, output)
        cost = expected_cost(footage.instant(len(footage) // 2), job.options, job.surface, threads())
        return {"key": key, "seconds": (1 + FRAME_COST_RATIO * len(footage)) * cost.seconds, "memory": cost.memory,
                "record": None}  # fmt: skip
    capture = capture or _opened(job, output)
    check_selection(capture, job.options)
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


def _opened(job: CaptureJob, output: Path) -> Capture:
    return open_any(job.path, _place(job, output))


def _footage(job: CaptureJob, output: Path) -> Footage:
    return open_footage(job.path, options=_place(job, output))


def _place(job: CaptureJob, output: Path) -> OpenOptions:
    """How a capture is opened: what is unpacked of it lies in its work folder."""
    return replace(job.place, work=None if find_objects(output) else output / WORK_FOLDER / job.name / "frames")


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

    def of_mesh(path: str) -> list[Any]:
        return list(map(of_file, mesh_files(path))) if is_sequence(path) else of_place(path)

    proxy = None if job.proxy is None else of_mesh(job.proxy)
    options = asdict(job.options) | {"surface": None if job.surface is None else asdict(job.surface)}
    if capture is None:
        return [job.name, options, proxy, asdict(job.place), [of_place(path) for path in job.sources]]
    return [job.name, options, proxy, capture_identity(capture, of_file)]


def _make(job: CaptureJob, output: Path, work: Path, folder: Path) -> dict[str, Any]:
    """Scene or clip, page and poster in a folder, and their record."""
    started = time.monotonic()
    warnings: list[str] = []
    scene_file, page = folder / f"{job.name}.glb", folder / f"{job.name}.html"
    with log_into(warnings):
        if not find_objects(work):
            work.mkdir(parents=True, exist_ok=True)
        make = _make_still if job.place.clip is None else _make_clip
        encoded, problems, own = make(job, output, work, scene_file, page)
    return {
        "name": job.name,
        "capture": job.path,
        "scene": scene_file.name,
        "page": page.name,
        "poster": page.with_suffix(".jpg").name,
        "bytes": scene_file.stat().st_size,
        **own,
        "seconds": round(time.monotonic() - started, 1),
        "encode_seconds": round(encoded - started, 1),
        "worker": worker_name(),
        "warnings": [*problems, *(line for line in warnings if line not in problems)],
    }


Made = tuple[float, Sequence[str], dict[str, Any]]  # when it was encoded, problems of the capture, what is its own


def _make_still(job: CaptureJob, output: Path, work: Path, scene_file: Path, page: Path) -> Made:
    capture = _opened(job, output)
    made = encode(
        capture, job.proxy, job.options, surface_options=job.surface, work=work, progress=None,
        blind=job.surface is not None and job.surface.blind is not None,
    )  # fmt: skip
    save(made, scene_file, **job.options.for_save)
    encoded = time.monotonic()
    scene = load(scene_file)
    figures = evaluate(scene, capture, path=scene_file, png_maps="none", progress=None)
    if job.options.target is None or job.options.target.size is None:  # which leaves no room for them
        store_scores(scene_file, {**scene.scores, **stored_scores(figures)})
    write_guests_page(scene, page, title=job.name)
    return (
        encoded,
        capture.problems,
        {
            "photographs": len(capture.sizes),
            "photographs_bytes": made.settings["photographs"]["bytes"],
            "textures": scene.appearance.textures,
            **_scores(figures["image"]),
            "between_psnr_luma": _score(scene.scores.get("between"), "psnr_luma_at_least"),
            "between_psnr": _score(scene.scores.get("between"), "psnr"),
        },
    )


def _make_clip(job: CaptureJob, output: Path, work: Path, clip_file: Path, page: Path) -> Made:
    footage = _footage(job, output)
    clip = encode_footage(footage, job.proxy, job.options, surface_options=job.surface, work=work, progress=None)
    save(clip, clip_file)
    encoded = time.monotonic()
    every = max(1, len(footage) // MEASURED_FRAMES)
    figures = evaluate_clip(clip, footage, path=clip_file, every=every, progress=None)
    first = clip.scene(clip.timeline.first)
    write_guests_page(first, page, title=job.name, glb=clip_file.read_bytes())
    return (
        encoded,
        footage.problems,
        {
            "photographs": len(footage.names) * len(footage),
            "photographs_bytes": footage.bytes,
            "textures": first.appearance.textures,
            **_scores(figures["image"]),
            "between_psnr_luma": None,
            "between_psnr": None,
        },
    )


def _scores(image: Mapping[str, Any]) -> dict[str, float | None]:
    return {
        "psnr": _score(image["encoded"], "psnr"),
        "ssim": _score(image["encoded"], "ssim"),
        "held_out_psnr": _score(image["held_out"], "psnr"),
    }


def _score(part: Mapping[str, Any] | None, name: str) -> float | None:
    return None if part is None or part.get(name) is None else float(part[name])
