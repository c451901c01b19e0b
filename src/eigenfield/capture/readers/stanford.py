"""Names of the (New) Stanford Light Field Archive (http://lightfield.stanford.edu): `out_RR_CC_V_U.png`.

Row, column, and the gantry's measured position, U to the right and V *down* as the cameras see it (measured on Jelly
Beans; other readers of the archive have the same signs). Which way rows and columns run differs from set to set, so
that U may rise or fall with the column and V with the row. Positions may be absent (`out_RR_CC.jpg`), and the previews
have a prefix (`jpg_out_...`). The pictures are rectified: a plane in the scene has no parallax. Nothing says the focal
length.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.arrangement import (
    Arrangement,
    find_by_names,
    make_grid_layout,
    match_names,
    require_photographs,
    with_measured_positions,
)
from eigenfield.core.errors import CaptureError
from eigenfield.core.open_options import OpenOptions

STANFORD_NUMBER = r"[-+]?\d{1,9}(?:\.\d{0,12})?"
# "out" with or without positions; any other name only with positions that have decimals
STANFORD_NAMES = re.compile(
    rf"(?:(?:.*[^a-z])?out_(\d{{1,4}})_(\d{{1,4}})(?:_({STANFORD_NUMBER})_({STANFORD_NUMBER}))?_?"
    r"|(?:.*_)?(\d{1,4})_(\d{1,4})_([-+]?\d{1,9}\.\d{1,12})_([-+]?\d{1,9}\.\d{1,12})_?)",
    re.IGNORECASE,
)

find_stanford = find_by_names(STANFORD_NAMES)


def read_stanford(folder: Path, options: OpenOptions) -> Arrangement:
    """The grid of a folder with Stanford's names, with measured positions where all names have them.

    Raises CaptureError: `names-unknown`, `node-twice`, `grid-size`, `grid-positions` (V does not follow the rows, or U
    the columns).
    """
    fitting, others = match_names(folder, STANFORD_NAMES)
    require_photographs(fitting, folder, "out_RR_CC or out_RR_CC_V_U")
    files = tuple(path for path, _ in fitting)
    fields = [match.groups()[:4] if match[1] else match.groups()[4:] for _, match in fitting]
    layout, problems = make_grid_layout(
        files, [int(f[0]) for f in fields], [int(f[1]) for f in fields], options, folder
    )
    layout = replace(layout, rectified=True)
    bare = [path.name for path, f in zip(files, fields, strict=True) if f[2] is None]
    if len(bare) < len(files):
        if bare:
            problems.append(f"{len(bare)} of {len(files)} names hold no position: the measured ones are not used")
        else:
            v, u = (np.array([float(f[i]) for f in fields]) for i in (2, 3))
            _check_order(layout.rows, layout.columns, v, u, folder)
            layout = with_measured_positions(layout, u, -v, signs=True)
    return Arrangement("stanford", files, layout, tuple(problems), tuple(others))


def _check_order(
    rows: NDArray[np.int64], columns: NDArray[np.int64], v: NDArray[np.float64], u: NDArray[np.float64], folder: Path
) -> None:
    """V must go with the rows and U with the columns, up or down, and not the other way round."""
    for values, along, across, names in ((v, rows, columns, "V rows"), (u, columns, rows, "U columns")):
        if len(np.unique(along)) > 1 and _index_correlation(values, along) < _index_correlation(values, across):
            letter, axis = names.split()
            raise CaptureError(
                "grid-positions",
                f"the positions {letter} in the names do not follow the {axis} (expected _ROW_COLUMN_V_U)",
                path=folder,
                remedy="rename the photographs, or read row and column only with --format grid",
            )


def _index_correlation(values: NDArray[np.float64], index: NDArray[np.int64]) -> float:
    """The absolute correlation of positions with node numbers; 0 where one of them does not change."""
    a, b = values - values.mean(), index - index.mean()
    scale = float(np.sqrt((a @ a) * (b @ b)))
    return abs(float(a @ b)) / scale if scale > 0 else 0.0
