"""What stands for footage in the keys of finished stages."""

from __future__ import annotations

import hashlib
from itertools import chain
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.observations import Observations
from eigenfield.imaging.metrics import to_codes
from eigenfield.runtime.parallel import parallel_map

if TYPE_CHECKING:
    from eigenfield.capture.footage import Footage


def footage_digest(footage: Footage) -> list[Any]:
    """What stands for footage: its clock, the frames of all its files, and the pixels and masks of three instants,
    which say how they are decoded."""
    digest = hashlib.sha256()
    for number in (0, len(footage) // 2, len(footage) - 1):
        instant = cast("Observations", footage.instant(number))

        def codes(index: int, instant: Observations = instant) -> list[NDArray[np.uint8]]:
            photograph = instant.photograph(index)
            return [to_codes(one) for one in (photograph.pixels, photograph.mask) if one is not None]

        for found in chain.from_iterable(parallel_map(codes, range(len(instant)))):
            digest.update(found.data)
    return [list(footage.names), str(footage.timeline), footage.identity(), digest.hexdigest()]
