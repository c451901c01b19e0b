"""What a set of instants takes on many machines, reckoned from measured encodes: `python benchmarks/plan.py`.

Each instant is one task that makes one scene from the photographs of that instant. Time, memory and bytes a pixel are
those of the captures in results/proxy-scene-*.json, which are far smaller than 100 photographs of 4K: the table says
how many times. Machines are assumed to have cores as fast as those that were measured.
"""

from __future__ import annotations

import argparse
import json
import re
from dataclasses import dataclass

from eigenfield.encoding.cost import MEMORY_FIXED_BYTES, THREADS_POWER
from measure import RESULTS

PIXELS = {"fox": 540 * 960, "tarot-all": 512 * 512, "shop": 960 * 640}  # of a photograph of the measured captures
PHOTOGRAPHS = re.compile(r"for (\d+) photographs \(([\d.]+) MB\)")


@dataclass(frozen=True)
class Measured:
    """An encode that was measured, from photographs to scene.

    Attributes:
        pixels: Of all its photographs.
        photographs: Bytes of their files.
        scene: Bytes.
        seconds: It took.
        cores: Of the machine.
        memory: Bytes, at most.
    """

    pixels: float
    photographs: float
    scene: float
    seconds: float
    cores: int
    memory: float


@dataclass(frozen=True)
class Plan:
    """What all instants take.

    Attributes:
        tasks: One an instant.
        task_seconds: On a machine of its own.
        memory: Bytes for each task.
        read: Bytes of photographs.
        written: Bytes of scenes.
        hours: Of all machines together at work.
        times_larger: An instant than the capture that was measured.
    """

    tasks: int
    task_seconds: float
    memory: float
    read: float
    written: float
    hours: float
    times_larger: float


def measured(name: str) -> Measured:
    """The newest run of results/proxy-scene-NAME.json."""
    run = json.loads((RESULTS / f"proxy-scene-{name}.json").read_text(encoding="utf-8"))["runs"][-1]
    found = PHOTOGRAPHS.search(run["summary"])
    assert found is not None
    pixels, machine = int(found[1]) * PIXELS[name], run["machine"]
    memory = run["peak_anonymous_mb"] * 1e6
    return Measured(pixels, float(found[2]) * 1e6, run["bytes"], run["seconds"], machine["cores"], memory)


def plan(known: Measured, instants: int, pixels: float, machines: int, cores: int) -> Plan:
    """What a set of instants takes, one task at a time on each machine.

    Args:
        known: The encode from which it is reckoned.
        instants: Number of them.
        pixels: Of all photographs of an instant.
        machines: Number of them.
        cores: Of a machine.
    """
    times = pixels / known.pixels
    seconds = known.seconds * times * (known.cores / cores) ** THREADS_POWER
    memory = MEMORY_FIXED_BYTES + (known.memory - MEMORY_FIXED_BYTES) * times
    rounds = -(-instants // machines)  # the last machines wait for the last task
    return Plan(
        instants, seconds, memory, known.photographs * times * instants, known.scene * times * instants,
        rounds * seconds / 3600, times,
    )  # fmt: skip


def table(instants: int, cameras: int, width: int, height: int, machines: int, cores: int) -> str:
    """The plan as Markdown, a column for each measured capture."""
    pixels = float(cameras * width * height)
    plans = [plan(measured(name), instants, pixels, machines, cores) for name in PIXELS]
    rows = {
        "an instant is larger": [f"{one.times_larger:.0f} times" for one in plans],
        "tasks": [str(one.tasks) for one in plans],
        "seconds a task": [f"{one.task_seconds:.0f}" for one in plans],
        "memory a task": [f"{one.memory / 1e9:.0f} GB" for one in plans],
        "read": [f"{one.read / 1e12:.1f} TB" for one in plans],
        "written": [f"{one.written / 1e12:.2f} TB" for one in plans],
        "storage gives": [f"{one.read / one.hours / 3.6e9:.0f} MB/s" for one in plans],
        "hours": [f"{one.hours:.0f}" for one in plans],
    }
    lines = [
        f"{instants} instants of {cameras} cameras of {width}x{height}, {machines} machines of {cores} cores:",
        "",
        f"| reckoned from | {' | '.join(PIXELS)} |",
        "|---" * (1 + len(plans)) + "|",
        *(f"| {name} | {' | '.join(cells)} |" for name, cells in rows.items()),
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    names = {"instants": 10_000, "cameras": 100, "width": 3840, "height": 2160, "machines": 100, "cores": 16}
    for name, default in names.items():
        parser.add_argument(f"--{name}", type=int, default=default)
    print(table(**vars(parser.parse_args())))
