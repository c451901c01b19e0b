"""Share the captures of a batch among processes. A cluster of many machines takes one argument more.

python examples/06_workers.py [FOLDER]
"""

from __future__ import annotations

import data
import eigenfield as ef


def main() -> None:
    place = data.folder()
    (place / "captures").mkdir(exist_ok=True)
    for name, columns in (("one", 2), ("two", 3)):
        data.capture(place / "captures", name, columns)
    # cluster="ssh:anna,bert" or the address of a Dask scheduler in place of workers=2: docs/cluster.md
    result = ef.batch(place / "captures", place / "shared", workers=2, preset="small", surface="relief")
    print(f"{len(result.records)} captures, {len(result.failed)} failed")


if __name__ == "__main__":  # a process that is started imports this file again
    main()
