"""What several workers cost and gain: instants of the demo's array, encoded by `batch` in three ways.

    python benchmarks/batch.py [--instants 24] [--cluster] [--store]

The instants are 5x5 views of 256² with their mesh, at `--preset small`. They are encoded in one process with as many
threads as there are processors, then in as many processes of one thread each; with --cluster also by a Dask cluster of
as many workers on this machine. The overhead is the workers' time in which no capture was worked on, as a share of the
time in which one was. The files of all ways must be equal.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
import time
from pathlib import Path
from typing import Any

import eigenfield as ef
import measure
from eigenfield.demo import draw_demo_capture
from eigenfield.runtime.parallel import set_threads, threads

ROWS, SIZE = 5, 256


def encoded(clip: Path, output: Path, workers: int | None = None, cluster: str | None = None) -> dict[str, Any]:
    """A batch's figures, and its files by name."""
    began = time.perf_counter()
    options: dict[str, Any] = {"proxy": str(clip.parent / "demo" / "proxy.ply"), "preset": "small"}
    result = ef.batch(clip, output, progress=None, workers=workers, cluster=cluster, **options)
    seconds = time.perf_counter() - began
    if result.failed:
        raise SystemExit(f"{result.failed[0]['name']}: {result.failed[0]['error']}")
    busy = sum(record["seconds"] for record in result.records)
    files = {one["name"]: (output / one["folder"] / one["scene"]).read_bytes() for one in result.records}
    return {"seconds": round(seconds, 1), "busy_seconds": round(busy, 1), "files": files}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--instants", type=int, default=24)
    parser.add_argument("--cluster", action="store_true")
    parser.add_argument("--store", action="store_true")
    asked = parser.parse_args()
    workers = threads()
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        draw_demo_capture(root / "demo", rows=ROWS, columns=ROWS, size=SIZE)
        for number in range(asked.instants):
            capture = root / "clip" / f"t{number:03d}"
            shutil.copytree(root / "demo" / "images", capture / "images")
            shutil.copy(root / "demo" / "transforms.json", capture)
        shutil.copytree(root / "clip" / "t000", root / "warm" / "t")
        encoded(root / "warm", root / "warm-scenes")  # kernels are compiled
        found = {"one_process": encoded(root / "clip", root / "one")}
        found["processes"] = encoded(root / "clip", root / "many", workers=workers)
        if asked.cluster:
            from distributed import LocalCluster

            set_threads(None)
            with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=":0") as cluster:
                found["cluster"] = encoded(root / "clip", root / "dask", cluster=cluster.scheduler_address)
    files = [way.pop("files") for way in found.values()]
    if any(other != files[0] for other in files):
        raise SystemExit("the files differ")
    for name, way in found.items():
        width = 1 if name == "one_process" else workers
        way["ratio"] = round(way["seconds"] / found["one_process"]["seconds"], 3)
        way["overhead"] = round(way["seconds"] * width / way["busy_seconds"] - 1, 3)
        print(name, way)
    figures = {"instants": asked.instants, "workers": workers, "bytes": len(files[0]["t000"]), **found}
    if asked.store:
        print(f"stored as {measure.store('batch', figures)}")


if __name__ == "__main__":
    main()
