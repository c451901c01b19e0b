"""Worlds far from their origin (UTM, ECEF): moved to it in float64, because meshes, files and kernels keep float32."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import Calibration

FAR_MIN_EXTENTS = 100.0  # of the cameras' array, from which on their distance from the origin counts as far


def move_to_origin(read: Calibration) -> tuple[Calibration, NDArray[np.float64]]:
    """The calibration with its cameras about the origin, where they stand far from it, and a line that says so.

    Returns:
        The calibration, and (3,) float64 what was taken off every position; zero where the cameras stay.
    """
    centres = np.array([entry.centre for entry in read.entries if np.isfinite(entry.centre).all()])
    stay = read, np.zeros(3)
    if len(centres) < 2:
        return stay
    middle = _median(centres)
    # by the median distance: a camera that stands apart, at the origin say, does not hide that the others are far
    extent = 4 * float(_median(np.abs(centres - middle)).max()) or float(np.ptp(centres, axis=0).max())
    if not 0 < extent * FAR_MIN_EXTENTS < np.abs(middle).max():
        return stay
    unit = 10.0 ** np.floor(np.log10(extent))
    origin = np.round(middle / unit) * unit  # a round number, which people can type
    entries = tuple(replace(entry, centre=entry.centre - origin) for entry in read.entries)
    where = ", ".join(f"{v:.10g}" for v in origin)
    line = (
        f"the cameras stand {np.linalg.norm(middle):.3g} units from the origin (georeferenced): they and the proxy are "
        f"moved by minus ({where}) while they are worked on; calibrations and meshes that are written are moved back"
    )
    return replace(read, entries=entries, problems=(*read.problems, line)), origin


def _median(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of each column, as `np.median` has it, which loads numpy.ma: a sixth of the time that a capture takes to open."""
    ordered = np.sort(rows, axis=0)
    middle: NDArray[np.float64] = (ordered[(len(rows) - 1) // 2] + ordered[len(rows) // 2]) / 2
    return middle
