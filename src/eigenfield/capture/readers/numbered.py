"""Numbered frames of a grid: any names with one number that differs, row by row, as `--grid ROWSxCOLUMNS` says."""

from __future__ import annotations

from pathlib import Path

from eigenfield.capture.arrangement import Arrangement, make_grid_layout, require_photographs
from eigenfield.capture.readers.grid_names import largest_name_group
from eigenfield.core.errors import CaptureError, OptionError, one_line
from eigenfield.core.open_options import OpenOptions


def read_numbered(folder: Path, options: OpenOptions) -> Arrangement:
    """The grid of numbered photographs, in row-major order of their numbers.

    As many photographs as nodes are taken in order, whatever the numbers. With fewer, the numbers must span the grid
    exactly: those that are not there are missing nodes. Raises CaptureError: `names-unknown`, `node-twice`,
    `grid-size`; OptionError `grid-missing`.
    """
    if options.grid is None:
        raise OptionError(
            "grid-missing", "numbered frames do not say how many rows and columns there are", remedy="say --grid RxC"
        )
    files, others, fields = largest_name_group(folder)
    varying = [i for i in range(1, len(fields[0]) if fields else 0, 2) if len({int(f[i]) for f in fields}) > 1]
    require_photographs(files if len(varying) == 1 else [], folder, "with one number that differs")
    numbers = [int(f[varying[0]]) for f in fields]
    order = sorted(range(len(files)), key=lambda i: (numbers[i], files[i].name))
    files, numbers = [files[i] for i in order], [numbers[i] for i in order]
    for first, second, number, following in zip(files, files[1:], numbers, numbers[1:], strict=False):
        if number == following:
            raise CaptureError(
                "node-twice",
                f"{one_line(first.name)} and {one_line(second.name)} have the same number",
                path=folder,
                remedy="take one of them out",
            )
    total = options.grid[0] * options.grid[1]
    if len(files) == total:
        places = list(range(total))
    elif len(files) < total and numbers[-1] - numbers[0] + 1 == total:
        places = [number - numbers[0] for number in numbers]
    else:
        raise _grid_size_error(len(files), options.grid, folder)
    rows, columns = [p // options.grid[1] for p in places], [p % options.grid[1] for p in places]
    layout, problems = make_grid_layout(files, rows, columns, OpenOptions(), folder)
    return Arrangement("numbered", tuple(files), layout, tuple(problems), tuple(others))


def _grid_size_error(photographs: int, grid: tuple[int, int], folder: Path) -> CaptureError:
    """The error for a grid that does not hold as many photographs as there are; its remedy states those that would."""
    fitting = [f"{a}x{photographs // a}" for a in range(1, photographs + 1) if photographs % a == 0]
    return CaptureError(
        "grid-size",
        f"{photographs} photographs do not fill a grid of {grid[0]}x{grid[1]}, which has {grid[0] * grid[1]} nodes",
        path=folder,
        remedy=f"say one of --grid {', '.join(fitting)}, or add the photographs that are missing",
    )
