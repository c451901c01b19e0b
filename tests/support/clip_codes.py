"""The codes of a clip's films, for the tests of other decoders.

    PYTHONPATH=tests python -m support.clip_codes CLIP

prints for each frame the SHA-256 of the codes of each film, two bytes a code, the lower first, as JSON.
"""

from __future__ import annotations

import hashlib
import json
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.video.film import decode_film
from eigenfield.gltf import load_clip
from eigenfield.gltf.clips import CodedGroups


def digests(path: Path) -> list[list[str]]:
    """For each frame one of each film."""
    groups = load_clip(path).groups
    assert isinstance(groups, CodedGroups)
    listed: list[list[str]] = []
    for index in range(len(groups.lengths)):
        units = zip(*groups.coded(index).units, strict=True)
        sizes = groups.layout.sizes
        films = [decode_film(own, size, "the film") for own, size in zip(units, sizes, strict=True)]
        listed += [[_digest(codes) for codes in frame] for frame in zip(*films, strict=True)]
    return listed


def _digest(codes: NDArray[np.uint16]) -> str:
    return hashlib.sha256(codes.astype("<u2").tobytes()).hexdigest()


if __name__ == "__main__":
    print(json.dumps(digests(Path(sys.argv[1]))))
