"""How good the cameras and the geometry are that photographs alone give.

    EIGENFIELD_DATA=captures python benchmarks/proxy.py [CASE ...]

Results go to benchmarks/results/proxy-NAME.json.
"""

from __future__ import annotations

import argparse
import functools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import measure
import proxy_cameras
import proxy_depth
import proxy_scenes

CASES: dict[str, Callable[[Path], dict[str, Any]]] = {
    "hci-antinous": proxy_depth.hci_antinous,
    "cameras-fountain": lambda data: proxy_cameras.against_truth(data / "fountain_P11_half"),
    "cameras-temple": lambda data: proxy_cameras.against_truth(data / "temple_ring16"),
    "cameras-stereo-chart": proxy_cameras.stereo_chart,
    "cameras-caliscope": proxy_cameras.caliscope,
    **{f"scene-{name}": functools.partial(proxy_scenes.scene, case=case) for name, case in proxy_scenes.CASES.items()},
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", help=f"of {', '.join(CASES)}; default: all")
    cases = parser.parse_args().cases or list(CASES)
    if unknown := set(cases) - set(CASES):
        parser.error(f"no such case: {', '.join(sorted(unknown))}")
    folder = measure.data()
    for name in cases:
        figures = {"case": name, **CASES[name](folder)}
        print(json.dumps(figures, indent=1), flush=True)
        measure.store(f"proxy-{name}", figures)


if __name__ == "__main__":
    main()
