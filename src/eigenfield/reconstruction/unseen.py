"""Held-out photographs of a reconstruction, by name, whichever photographs are left out on the way."""

from __future__ import annotations

from collections.abc import Collection
from typing import TypeVar

import numpy as np

from eigenfield.capture import Capture, LightField, PhotoSet
from eigenfield.capture.holdout import held_out_cameras
from eigenfield.core.errors import OptionError
from eigenfield.reconstruction.array import array_positions

Photographs = TypeVar("Photographs", LightField, PhotoSet, Capture)


def held_out_names(rule: str | None, capture: Capture) -> frozenset[str]:
    """The photographs that a rule of `held_out_cameras` names, by the capture's own order and places.

    Raises:
        OptionError: `hold-out`: as `held_out_cameras`; or a rule of rows and columns, which are not known yet.
    """
    if capture.light_field is not None or capture.layout is not None:
        places = array_positions(capture)
    elif rule == "odd":
        raise OptionError(
            "hold-out", "rows and columns are not known before the cameras are found, which needs all photographs",
            remedy="use every:K or names, or leave out --blind",
        )  # fmt: skip
    else:
        places = np.zeros((len(capture), 2))
    held = held_out_cameras(rule, capture.names, places)
    return frozenset(name for name, out in zip(capture.names, held, strict=True) if out)


def without(photographs: Photographs, names: Collection[str]) -> Photographs:
    """The photographs but those with these names."""
    return photographs.subset([index for index, name in enumerate(photographs.names) if name not in names])


def rule_for(light_field: LightField, rule: str | None, held: Collection[str]) -> str | None:
    """A rule that names those of the held-out photographs that have a camera; the same rule, if it still does.

    Args:
        light_field: The photographs with a camera.
        rule: That named them among all.
        held: Their names.
    """
    here = [name for name in light_field.names if name in held]
    if not here:
        return None
    try:
        same = held_out_names(rule, light_field) == frozenset(here)
    except OptionError:  # a name or a row that is gone
        same = False
    return rule if same else ",".join(here)
