"""The filled texture maps and their visibility as pictures (the paper's figure 3)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.progress import Progress, track
from eigenfield.encoding.projected.project import TextureMaps
from eigenfield.encoding.projected.spread import Spreader
from eigenfield.imaging.png import png_bytes
from eigenfield.runtime.files import output_errors, write_bytes
from eigenfield.runtime.parallel import parallel_stream


def write_maps(
    maps: TextureMaps,
    mean: NDArray[np.float32],
    spreader: Spreader,
    names: Sequence[str],
    folder: Path,
    progress: Progress | None = None,
) -> None:
    """Write `NAME.map.png` (filled by equation 2, gutters dilated) and `NAME.seen.png` for every observation, and
    `mean.png`. Existing files of these names are replaced; each is whole or absent.

    Args:
        maps: Of No observations.
        mean: (n, C) at the chart texels.
        spreader: Of the maps' atlas.
        names: Of the observations, each once.
        folder: Is made if it does not exist.
        progress: Reports the maps that are written.
    """
    with output_errors(folder):
        folder.mkdir(parents=True, exist_ok=True)

    flat = [name.replace("/", "_").replace("\\", "_") for name in names]
    stems = [Path(name).stem for name in flat]
    labels = stems if len(set(stems)) == len(stems) else flat

    def write(index: int) -> None:
        seen = np.array(maps.seen[index])
        stem = labels[index]
        filled = spreader(np.where(seen[:, None] > 0, maps.values[index], mean))
        visibility = maps.atlas.image(seen[:, None].astype(np.float32))
        write_bytes(folder / f"{stem}.map.png", png_bytes(filled), overwrite=True)
        write_bytes(folder / f"{stem}.seen.png", png_bytes(visibility), overwrite=True)

    write_bytes(folder / "mean.png", png_bytes(spreader(mean)), overwrite=True)
    for _ in track(parallel_stream(write, range(maps.count)), "maps as pictures", maps.count, progress):
        pass
