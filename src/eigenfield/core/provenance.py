"""How a scene was made, as far as later steps ask: its `settings`, read once.

The settings of a file are free, and may hold anything. What is not of its kind counts as not recorded, unless said
otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.brief import brief_repr

Recorded = tuple[Any, tuple[float, ...]]  # model, whatever is recorded, and coefficients of a lens that was removed


@dataclass(frozen=True, eq=False)
class Provenance:
    """What the settings of a scene record.

    Attributes:
        origin: (3,) the origin of the scene's world in that of the capture's files; zero unless that is far away.
        metres_per_unit: The length of one unit of the world; None: unknown.
        exposure: Factor of linear photographs before the sRGB curve; None: they were coded already.
        lenses: Of each camera, None where there was none; () where none are recorded. None: they cannot be read.
        as_stored: Cameras whose photographs were not turned by their EXIF orientation.
        resampling: How texture maps were made, whatever is recorded; None: nothing.
        align: How they were aligned, likewise.
        max_angle: The largest angle at which they were taken, likewise.
        is_fitted: Whether the scene was fitted to its photographs, so that there are no texture maps.
        photographs_bytes: Of the encoded photographs' files; None: not recorded.
        fallback: What viewers without eigen textures get; None: the default.
    """

    origin: NDArray[np.float64]
    metres_per_unit: float | None
    exposure: float | None
    lenses: tuple[Recorded | None, ...] | None
    as_stored: frozenset[int]
    resampling: object
    align: object
    max_angle: object
    is_fitted: bool
    photographs_bytes: int | None
    fallback: str | None

    __repr__ = brief_repr

    @classmethod
    def of(cls, settings: Mapping[str, Any]) -> Provenance:
        """What the settings of a scene say."""
        stored, size = settings.get("asStored"), _member(settings, "photographs", "bytes")
        fallback = settings.get("fallback")
        return cls(
            origin=_place(settings.get("origin")),
            metres_per_unit=_positive(settings.get("metresPerUnit")),
            exposure=_positive(_member(settings, "tone", "exposure")),
            lenses=_lenses(settings.get("lenses")),
            as_stored=frozenset(v for v in stored if isinstance(v, int)) if isinstance(stored, list) else frozenset(),
            resampling=settings.get("resampling"),
            align=settings.get("align"),
            max_angle=settings.get("maxAngle"),
            is_fitted="fitted" in settings,
            photographs_bytes=size if isinstance(size, int) else None,
            fallback=fallback if isinstance(fallback, str) else None,
        )


def _member(settings: Mapping[str, Any], name: str, key: str) -> object:
    """A member of a setting that is an object."""
    found = settings.get(name)
    return found.get(key) if isinstance(found, Mapping) else None


def _positive(found: object) -> float | None:
    return float(found) if isinstance(found, int | float) and 0 < found < math.inf else None


def _place(found: object) -> NDArray[np.float64]:
    is_place = isinstance(found, list) and len(found) == 3 and all(type(v) in (int, float) for v in found)
    place = np.array(found if is_place else (0, 0, 0), np.float64)
    place = place if np.isfinite(place).all() else np.zeros(3)
    place.setflags(write=False)
    return place


def _lenses(found: Any) -> tuple[Recorded | None, ...] | None:
    if found is None:
        return ()
    try:
        return tuple(None if lens is None else (lens[0], tuple(map(float, lens[1]))) for lens in found)
    except (TypeError, ValueError, IndexError, KeyError):
        return None
