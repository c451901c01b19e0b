"""What the benchmarks share: a child process timed and weighed, and results that say where they come from.

results/NAME.json is {"runs": [...]}, one run a line, the newest last. Each has date, commit, machine and command beside
its figures. A run goes once later ones have measured all that it measured; the repository's history has it.
"""

from __future__ import annotations

import ast
import json
import os
import platform
import subprocess
import sys
import time
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

RESULTS = Path(__file__).parent / "results"
ORIGIN = ("date", "commit", "machine", "command")  # what every run says beside its figures


def data() -> Path:
    """The folder of captures. SystemExit where EIGENFIELD_DATA names none."""
    folder = os.environ.get("EIGENFIELD_DATA")
    if not folder:
        raise SystemExit("EIGENFIELD_DATA must name the folder of captures")
    return Path(folder)


def meaning(file: Path) -> bytes:
    """The syntax tree of a Python file: figures are measured again when that changes, not when a comment does."""
    return ast.dump(ast.parse(file.read_text(encoding="utf-8"))).encode()


def run(arguments: list[str], tree: Path | None = None) -> dict[str, Any]:
    """Run `python ARGUMENTS...`: wall seconds, peak anonymous memory (RssAnon, children included, sampled 50 times a
    second; Linux only, else None) and what it printed. File-backed pages, such as memory maps, are not anonymous.

    Args:
        arguments: Of Python.
        tree: Whose package is imported. Default: this one's.
    """
    started = time.perf_counter()
    environment = None if tree is None else {**os.environ, "PYTHONPATH": str(tree / "src")}
    peak = 0
    with subprocess.Popen([sys.executable, *arguments], stdout=subprocess.PIPE, text=True, env=environment) as process:
        while process.poll() is None:
            peak = max(peak, _anonymous(process.pid))
            time.sleep(0.02)
        seconds = time.perf_counter() - started
        output = process.stdout.read() if process.stdout else ""
    if process.returncode:
        raise SystemExit(f"{' '.join(arguments)} ended with {process.returncode}")
    return {"seconds": round(seconds, 2), "peak_anonymous_mb": round(peak / 1e6) or None, "output": output}


def _anonymous(pid: int) -> int:
    try:
        status = Path(f"/proc/{pid}/status").read_text()
        children = [int(word) for task in Path(f"/proc/{pid}/task").iterdir() for word in
                    (task / "children").read_text().split()]  # fmt: skip
    except OSError:  # it ended in between, or this is no Linux
        return 0
    own = next((int(line.split()[1]) * 1024 for line in status.splitlines() if line.startswith("RssAnon:")), 0)
    return own + sum(_anonymous(child) for child in children)


def commit(tree: Path | None = None) -> str:
    """The commit that is measured, of another tree where one is named, marked if the tree differs from it."""
    try:
        name, changes = (
            subprocess.run(["git", *words], capture_output=True, text=True, check=True, cwd=tree).stdout
            for words in (
                ["rev-parse", "--short", "HEAD"],
                ["status", "--porcelain", "-uno", "--", ".", ":!benchmarks/results"],
            )
        )
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return name.strip() + ("+" if changes.strip() else "")


def machine() -> dict[str, Any]:
    """Processor, how many of them this process may use, memory, Python."""
    model = platform.processor() or platform.machine()
    memory = None
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), model)
        memory = round(int(Path("/proc/meminfo").read_text().split()[1]) / 2**20)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return {"processor": model, "cores": cores, "memory_gb": memory, "python": platform.python_version()}


def store(name: str, figures: dict[str, Any]) -> Path:
    """Append the figures to results/NAME.json, with date, commit, machine and command; what they supersede goes.

    Where that file cannot be read (see `runs`) it stays as it is, the run goes to NAME.json.new and SystemExit says so.
    """
    path = RESULTS / f"{name}.json"
    date = datetime.now(UTC).isoformat(timespec="seconds")
    command = " ".join(["python", *sys.argv])
    run = {"date": date, "commit": commit(), "machine": machine(), "command": command, **figures}
    new = path.with_suffix(".json.new")
    try:
        kept = runs(name) if path.exists() else []
    except SystemExit as error:
        write_runs(new, [run])
        raise SystemExit(f"{error}; this run is kept as {new}") from error
    write_runs(path, current([*kept, run]))
    return path


def current(runs: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Runs without those whose captures, or else whose driver, later ones have all measured again."""
    newest = {subject: number for number, run in enumerate(runs) for subject in _subjects(run)}
    return [runs[number] for number in sorted(set(newest.values()))]


def _subjects(run: dict[str, Any]) -> list[str]:
    return list(run["captures"]) if "captures" in run else [run.get("driver", "")]


def write_runs(path: Path, runs: list[dict[str, Any]]) -> None:
    """One run a line, so that a change of one run is a change of one line."""
    lines = ",\n".join(json.dumps(run, ensure_ascii=False) for run in runs)
    _write(path, f'{{"runs": [\n{lines}\n]}}\n')


def write_json(path: Path, value: Any) -> None:
    """A JSON file, whole or not at all, should this be killed."""
    _write(path, json.dumps(value, indent=1) + "\n")


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(".part")
    part.write_text(text, encoding="utf-8")
    part.replace(path)


def runs(name: str) -> list[dict[str, Any]]:
    """All runs in results/NAME.json, the oldest first, at least one. SystemExit names the file if it is none such."""
    path = RESULTS / f"{name}.json"
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise SystemExit(f"{path} cannot be read ({error}): take it from the repository again") from error
    found = document.get("runs") if isinstance(document, dict) else None
    if not isinstance(found, list) or not found:
        raise SystemExit(f'{path} has no "runs": put what it holds into {{"runs": [...]}}, with its date')
    for number, run in enumerate(found):
        missing = [key for key in ORIGIN if not isinstance(run, dict) or key not in run]
        if missing:
            raise SystemExit(f"{path}: run {number} does not say its {', '.join(missing)}")
    return found


def latest(name: str) -> dict[str, Any]:
    """The newest run in results/NAME.json."""
    return runs(name)[-1]
