"""The texture maps themselves as AVIF pictures, at the UV SSIM that a scene has: what its saving is held against."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import eigenfield as ef
from eigenfield.encoding.projected import make_atlas, texture_map
from eigenfield.imaging.metrics import ssim, to_codes
from evidence.stills import STILLS, decode, encode

SAMPLE = 12  # maps, evenly spread; their bytes are scaled up
AVIF = STILLS[0]


def maps_at_equal_ssim(scene_path: Path, capture: ef.LightField, target: float) -> dict[str, Any]:
    """The lowest AVIF quality at which the filled maps reach `target`, and all maps' bytes against the file's."""
    scene = ef.load(scene_path)
    mean = to_codes(scene.appearance.planes[0].mean)
    atlas = make_atlas(scene.proxy.mesh, mean.shape[1], mean.shape[0])
    names = [view.name for view in capture.views]
    maps = []
    for row in np.linspace(0, len(scene.rig.encoded) - 1, SAMPLE).round().astype(int):
        index = scene.rig.encoded[row]
        photograph = capture.photograph(names.index(scene.rig.names[index]))
        values, seen = texture_map(atlas, scene.rig.cameras[index], photograph.pixels, photograph.mask)
        filled, visible = mean.copy(), np.zeros(mean.shape[:2], bool)
        filled.reshape(-1, 3)[atlas.texel[seen > 0]] = to_codes(values[seen > 0])
        visible.reshape(-1)[atlas.texel[seen > 0]] = True
        maps.append((filled, visible))

    def at(quality: int) -> tuple[float, float]:
        files = [encode(filled, AVIF, quality) for filled, _ in maps]
        scores = [ssim(decode(data, AVIF), *one) or 0.0 for data, one in zip(files, maps, strict=True)]
        return float(np.mean(scores)), float(np.mean([len(data) for data in files]))

    low, high = 0, 100
    while low < high:
        middle = (low + high) // 2
        if at(middle)[0] >= target:
            high = middle
        else:
            low = middle + 1
    reached, size = at(high)
    total, own = size * len(scene.rig.encoded), scene_path.stat().st_size
    return {
        "quality": high, "ssim": round(reached, 4), "maps_bytes_estimated": round(total), "sample": SAMPLE,
        "file_bytes": own, "saving": round(1 - own / total, 4),
    }  # fmt: skip
