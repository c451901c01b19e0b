"""The texture maps themselves as AVIF pictures, at the UV SSIM that a scene has: what its saving is held against."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import eigenfield as ef
from eigenfield.encoding.projected.atlas import make_atlas
from eigenfield.encoding.projected.project import texture_map
from eigenfield.imaging.metrics import ssim, to_codes

SAMPLE = 12  # maps, evenly spread; their bytes are scaled up


def coded(picture: np.ndarray[Any, Any], quality: int) -> tuple[int, np.ndarray[Any, Any]]:
    """Bytes of an (H, W, 3) uint8 picture as AVIF (4:4:4, tuned as our own), and what it decodes to."""
    buffer = io.BytesIO()
    Image.fromarray(picture).save(
        buffer, "AVIF", quality=quality, subsampling="4:4:4", speed=6, advanced={"tune": "psnr", "deltaq-mode": "0"}
    )
    return buffer.tell(), np.asarray(Image.open(buffer).convert("RGB"))


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
        results = [(coded(filled, quality), filled, visible) for filled, visible in maps]
        scores = [ssim(decoded, filled, visible) for (_, decoded), filled, visible in results]
        return float(np.mean([score or 0.0 for score in scores])), float(np.mean([size for (size, _), _, _ in results]))

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
