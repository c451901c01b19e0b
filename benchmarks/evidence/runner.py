"""Steps of the evaluation, each kept when it is done: a run that was stopped goes on where it was."""

from __future__ import annotations

import datetime
import functools
import hashlib
import json
import sys
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import measure
from evidence import between as held_out
from evidence import pictures
from evidence.captures import Capture
from evidence.losses import losses
from evidence.paper import paper
from evidence.peers import peers
from evidence.prepared import Prepared, as_json, estimate, prepare
from evidence.studies import studies
from evidence.truth import true_geometry
from evidence.whole import whole

import eigenfield as ef
from eigenfield.errors import EigenfieldError

BENCHMARKS = Path(__file__).parents[1]
SAMPLE = 25  # held-out cameras that are drawn in every way


@dataclass(frozen=True)
class Run:
    """out: the report's folder. keep: take figures of another state of the code too, each marked with its commit."""

    out: Path
    quick: bool = False
    keep: bool = False
    command: str = ""


Step = Callable[[Prepared, Path], dict[str, Any]]


def _losses(prepared: Prepared, folder: Path) -> dict[str, Any]:
    figures = losses(prepared.work / "all.glb", prepared.light_field, alone=prepared.capture.studied)
    if prepared.capture.name == "demo" and not prepared.quick:
        figures["truth"] = true_geometry(prepared.capture.folder, work=prepared.work / "truth")
    return figures


def _between(prepared: Prepared, folder: Path) -> dict[str, Any]:
    file = prepared.work / "held.glb"
    scene = ef.load(file)
    figures = held_out.between(scene, prepared.light_field, SAMPLE, file=file, circles=prepared.circles())
    shown = pictures.between_cameras(scene, prepared, folder)
    return {**figures, "rule": prepared.hold_out, "pictures": shown}


STEPS: dict[str, Step] = {
    "scene": lambda prepared, folder: whole(prepared),
    "paper": paper,
    "losses": _losses,
    "rates": peers,
    "between": _between,
    "studies": lambda prepared, folder: studies(prepared),
}


def wanted(capture: Capture, quick: bool) -> list[str]:
    """The steps of one capture, in order."""
    left_out = {"studies"} if quick or not capture.studied else set()
    left_out |= set() if capture.compression else {"rates"}
    return [name for name in STEPS if name not in left_out]


def evaluate_capture(capture: Capture, run: Run, say: Callable[[str], None]) -> dict[str, Any]:
    """Every step of a capture that is not there yet, and the record of all of them."""
    work, kept = run.out / "work" / capture.name, run.out / "steps" / capture.name
    record: dict[str, Any] = {
        "title": capture.title, "folder": capture.folder.name, "note": capture.note, "licence": capture.licence,
        "compression": capture.compression,
        "steps": {},
    }  # fmt: skip
    geometry = _step("geometry", kept, run, capture, lambda: estimate(capture, work), say)
    record["geometry"] = geometry
    if "error" in geometry:
        return record
    prepared = prepare(capture, work, run.quick)
    first = prepared.light_field.cameras[0]
    record |= {"views": len(prepared.light_field), "size": [first.width, first.height], "hold_out": prepared.hold_out}
    for name in wanted(capture, run.quick):
        step = STEPS[name]
        record["steps"][name] = _step(name, kept, run, capture, lambda step=step: step(prepared, run.out), say)  # type: ignore[misc]
        if name == "scene" and "error" in record["steps"][name]:
            break  # the others draw its files
    return record


def _step(
    name: str, kept: Path, run: Run, capture: Capture, work: Callable[[], dict[str, Any]], say: Callable[[str], None]
) -> dict[str, Any]:
    """What a step left before, if the code is the same (or `keep`); else do it, and keep it. An error that its user can
    mend, or a bug, becomes the step's record and does not end the run."""
    path = kept / f"{name}.json"
    print_of_code = fingerprint()
    before = _kept(path)
    if before is not None and before["quick"] == run.quick and (run.keep or before["code"] == print_of_code):
        return before
    started = time.perf_counter()
    record: dict[str, Any] = {
        "commit": measure.commit(), "code": print_of_code, "quick": run.quick, "machine": measure.machine(),
        "command": f"python benchmarks/report.py{' --quick' if run.quick else ''} {_asked(capture)}",
        "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
    }  # fmt: skip
    try:
        record["figures"] = as_json(work())
    except EigenfieldError as error:
        record["error"] = str(error)
    except SystemExit as error:  # a child process failed; it has said why on stderr
        record["error"] = str(error)
    except Exception as error:  # one capture's bug must not cost the figures of all others; it is shown and told
        traceback.print_exc()
        record["error"] = f"{type(error).__name__}: {error}"
    record["seconds"] = round(time.perf_counter() - started, 1)
    say(f"{capture.name:>12}  {name:<9} {record['seconds']:7.1f} s  {record.get('error', '')}")
    if "error" not in record:
        _write(path, record)
    return record


def _asked(capture: Capture) -> str:
    """The word of the command line that names this capture: a path for one that is not ours."""
    return capture.name if capture.licence or capture.name == "demo" else str(capture.folder)


def _kept(path: Path) -> dict[str, Any] | None:
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):  # not there, or cut off: it is measured again
        return None
    return record if isinstance(record, dict) and {"figures", "code", "quick"} <= set(record) else None


def _write(path: Path, record: Mapping[str, Any]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(".part")
    part.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    part.replace(path)


@functools.cache
def fingerprint() -> str:
    """A hash of the code that the figures depend on: the package and the evaluation's modules, but for the page's."""
    places = [(BENCHMARKS.parent / "src").rglob("*.py"), (BENCHMARKS / "evidence").glob("*.py")]
    shown_only = {"charts.py", "markup.py", "runner.py", "captures.py"}
    digest = hashlib.sha256(sys.version.encode())
    for file in sorted(one for place in places for one in place if one.name not in shown_only):
        digest.update(str(file.relative_to(BENCHMARKS.parent)).encode() + file.read_bytes())
    return digest.hexdigest()[:16]
