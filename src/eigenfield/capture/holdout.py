"""Which cameras are held out: `odd`, `every:K`, or names."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera_names import named_cameras
from eigenfield.core.errors import OptionError
from eigenfield.core.viewplane import find_grid

HOLDOUT_MIN_ENCODED_CAMERAS = 3


def held_out_cameras(rule: str | None, names: Sequence[str], coordinates: NDArray[np.float64]) -> NDArray[np.bool_]:
    """The held-out cameras, (Nc,) bool.

    Args:
        rule: `odd`: the views with an odd row or an odd column of a grid. `every:K`: every K-th in the capture's
            order, from number K // 2 on, so that the first is not among them. Otherwise names, with or without
            their endings, separated by commas, as of `named_cameras`.
        coordinates: (Nc, 2) on the view plane.

    Raises:
        OptionError: `hold-out`: there is no grid, a name is unknown, or fewer than 3 cameras would remain.
    """
    held = np.zeros(len(names), bool)
    if rule is None or rule == "":
        return held
    if rule == "odd":
        grid = find_grid(coordinates)
        if grid is None:
            raise OptionError(
                "hold-out", "the cameras are on no grid: no rows or columns to hold out", remedy="use every:K"
            )
        rows, columns = np.mgrid[: grid.rows, : grid.columns]
        held[grid.index] = (rows % 2 == 1) | (columns % 2 == 1)
    elif rule.startswith("every:"):
        step = rule.removeprefix("every:")
        if not step.isdecimal() or len(step) > 9 or int(step) < 2:
            raise OptionError("hold-out", f"{rule}: K must be a number of 2 or more", remedy="for example every:5")
        held[int(step) // 2 :: int(step)] = True
    else:
        held[named_cameras(rule, names, "hold-out")] = True
    if (~held).sum() < HOLDOUT_MIN_ENCODED_CAMERAS:
        raise OptionError(
            "hold-out",
            f"{(~held).sum()} cameras would remain to encode",
            remedy=f"leave at least {HOLDOUT_MIN_ENCODED_CAMERAS}",
        )
    return held
