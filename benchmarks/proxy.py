"""How good the cameras and the geometry are that photographs alone give.

    EIGENFIELD_DATA=captures python benchmarks/proxy.py [CASE ...]

Results go to benchmarks/results/proxy-NAME.json.
"""

from __future__ import annotations

import argparse
import functools
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import measure
import proxy_cameras
import proxy_depth
import proxy_scenes

CASES: dict[str, Callable[[Path], dict[str, Any]]] = {
    "hci-antinous": proxy_depth.hci_antinous,
    "cameras-fountain": proxy_cameras.fountain,
    "cameras-temple": proxy_cameras.temple,
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
    folder = os.environ.get("EIGENFIELD_DATA")
    if not folder:
        raise SystemExit("EIGENFIELD_DATA must name the folder of captures")
    for name in cases:
        figures = {"case": name, **CASES[name](Path(folder))}
        print(json.dumps(figures, indent=1), flush=True)
        measure.store(f"proxy-{name}", figures)


if __name__ == "__main__":
    main()
