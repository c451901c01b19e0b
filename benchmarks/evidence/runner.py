"""Steps of the evaluation, each kept when it is done: a run that was stopped goes on where it was."""

from __future__ import annotations

import datetime
import functools
import hashlib
import json
import sys
import time
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import measure
from eigenfield.core.errors import EigenfieldError
from evidence.captures import Capture
from evidence.prepared import as_json, estimate, prepare
from evidence.steps import STEPS, wanted

BENCHMARKS = Path(__file__).parents[1]


@dataclass(frozen=True)
class Run:
    """out: the report's folder. keep: take figures of another state of the code too, each marked with its commit."""

    out: Path
    quick: bool = False
    keep: bool = False


def evaluate_capture(capture: Capture, run: Run, say: Callable[[str], None]) -> dict[str, Any]:
    """Every step of a capture that is not there yet, and the record of all of them."""
    work, kept = run.out / "work" / capture.name, run.out / "steps" / capture.name
    record: dict[str, Any] = {
        "title": capture.title, "folder": capture.folder.name, "note": capture.note, "licence": capture.licence,
        "compression": capture.compression,
        "steps": {},
    }  # fmt: skip
    made = [work / "proxy.glb"]
    geometry = _step("geometry", kept, run, capture, lambda: estimate(capture, work), say, made)
    record["geometry"] = geometry
    if "error" in geometry:
        return record
    prepared = prepare(capture, work, run.quick)
    first = prepared.light_field.cameras[0]
    record |= {"views": len(prepared.light_field), "size": [first.width, first.height], "hold_out": prepared.hold_out}
    for name in wanted(capture):
        step = STEPS[name]
        made = [work / "all.glb", work / "held.glb"] if name == "scene" else []
        record["steps"][name] = _step(name, kept, run, capture, partial(step, prepared, run.out), say, made)
        if name == "scene" and "error" in record["steps"][name]:
            break  # the others draw its files
    return record


def _step(
    name: str,
    kept: Path,
    run: Run,
    capture: Capture,
    work: Callable[[], dict[str, Any]],
    say: Callable[[str], None],
    made: Sequence[Path] = (),
) -> dict[str, Any]:
    """What a step left before, if the code is the same (or `keep`) and the files it `made` are there; else do it, and
    keep it. An error that its user can mend, or a bug, becomes the step's record and does not end the run."""
    path = kept / f"{name}.json"
    print_of_code = fingerprint()
    before = read_record(path)
    current = before is not None and before.get("quick") == run.quick and (run.keep or before["code"] == print_of_code)
    if before is not None and current and all(file.exists() for file in made):
        return before
    started = time.perf_counter()
    record: dict[str, Any] = {
        "commit": measure.commit(), "code": print_of_code, "quick": run.quick, "machine": measure.machine(),
        "command": f"python benchmarks/report.py{' --quick' if run.quick else ''} {_asked(capture)}",
        "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
    }  # fmt: skip
    try:
        record["figures"] = as_json(work())
    except (EigenfieldError, SystemExit) as error:  # the latter: a child process failed, and has said why on stderr
        record["error"] = str(error)
    except Exception as error:  # one capture's bug must not cost the figures of all others; it is shown and told
        traceback.print_exc()
        record["error"] = f"{type(error).__name__}: {error}"
    record["seconds"] = round(time.perf_counter() - started, 1)
    say(f"{capture.name:>12}  {name:<9} {record['seconds']:7.1f} s  {record.get('error', '')}")
    if "error" not in record:
        measure.write_json(path, record)
    return record


def _asked(capture: Capture) -> str:
    """The word of the command line that names this capture: a path for one that is not ours."""
    return capture.name if capture.licence or capture.name == "demo" else str(capture.folder)


def read_record(path: Path) -> dict[str, Any] | None:
    """What a step or `kept` left; None where nothing whole is there."""
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):  # not there, or cut off: it is measured again
        return None
    return record if isinstance(record, dict) and {"figures", "code"} <= set(record) else None


def kept(place: Path, program: Path, make: Callable[[], dict[str, Any]], more: str = "") -> dict[str, Any]:
    """What `make` left at `place`, if the code, `program`'s too, and `more` were the same; else what it makes now, left
    there."""
    code = f"{fingerprint()} {hashlib.sha256(measure.meaning(program)).hexdigest()} {more}"
    record = read_record(place)
    if record is None or record["code"] != code:
        record = {"code": code, "figures": as_json(make())}
        measure.write_json(place, record)
    return dict(record["figures"])


@functools.cache
def fingerprint() -> str:
    """A hash of the code that the figures depend on: the package and the evaluation's modules, but for the page's."""
    places = [(BENCHMARKS.parent / "src").rglob("*.py"), (BENCHMARKS / "evidence").glob("*.py")]
    shown_only = {"page.py", "runner.py", "captures.py"}
    digest = hashlib.sha256(sys.version.encode())
    for file in sorted(one for place in places for one in place if one.name not in shown_only):
        digest.update(str(file.relative_to(BENCHMARKS.parent)).encode() + measure.meaning(file))
    return digest.hexdigest()[:16]
