"""Tables of figures that were measured once, by hand, made from benchmarks/results/single.json.

Each run there is one table: "title", "note", "head" and "rows". Its commit is the one that recorded the figures.
"""

from __future__ import annotations

from evaluation_tables import table
from measure import runs


def section() -> str:
    parts = [
        "## Measured once\n\nThese figures were measured by hand and have no script that repeats them. Each table names"
        " the commit that recorded it.\n"
    ]
    for run in runs("single"):
        note = f"{run['note']}\n\n" if run["note"] else ""
        parts.append(
            f"### {run['title']}\n\n{note}{table(run['head'], run['rows'])}\n"
            f"`{run['command']}`, recorded in commit {run['commit']}, {run['date'][:10]}.\n"
        )
    return "\n".join(parts) + "\n"
