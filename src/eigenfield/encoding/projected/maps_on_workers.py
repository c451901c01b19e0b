"""Texture maps made by workers: each reads photographs from their files, and writes maps to files."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import Observations
from eigenfield.core.progress import Progress, track
from eigenfield.encoding.atlas import Atlas, make_atlas
from eigenfield.encoding.projected.project import texture_map
from eigenfield.runtime.executor import refuse_unshared, spread
from eigenfield.runtime.files import output_errors, rename
from eigenfield.runtime.parallel import parallel_stream, pieces
from eigenfield.runtime.shared import Shared, share
from eigenfield.runtime.tasks import Workers
from eigenfield.runtime.temporary import temporary_file

MAPS_A_TASK = 8


@dataclass(frozen=True, eq=False)
class MapsJob:
    """What a worker needs to make texture maps.

    Attributes:
        mesh: With UVs.
        size: (width, height) of the atlas.
        cameras: Of the observations.
        observations: Paths of photographs, no pixels.
        max_angle: As of `EncodeOptions`.
    """

    mesh: Mesh
    size: tuple[int, int]
    cameras: Sequence[Camera]
    observations: Observations
    max_angle: int

    @cached_property
    def atlas(self) -> Atlas:
        """Made once by each worker."""
        return make_atlas(self.mesh, *self.size)


def maps_on_workers(
    workers: Workers, atlas: Atlas, cameras: Sequence[Camera], observations: Observations, work: Path | None,
    max_angle: int, progress: Progress | None,
) -> Iterator[tuple[NDArray[np.float32], NDArray[np.uint8]]]:  # fmt: skip
    """The texture map of each observation in order, as `texture_map` makes it.

    Args:
        workers: Of `open_executor`. They see `work` and the photographs.
        atlas: Of the mesh.
        cameras: Of the observations.
        observations: That are projected.
        work: Folder for files of a few maps; None: the system's temporary folder.
        max_angle: As of `EncodeOptions`.
        progress: Called for each group of maps.

    Raises:
        CaptureError: A photograph cannot be read.
        OutputError: `folder-not-shared`; the folder cannot be written.
    """
    folder = Path(tempfile.gettempdir()) if work is None else work
    refuse_unshared(workers, folder)
    groups = pieces(len(observations), MAPS_A_TASK)
    job = MapsJob(atlas.mesh, (atlas.width, atlas.height), cameras, observations, max_angle)
    with share([job], folder) as (shared,):
        made = spread(workers, ((make_maps, shared, *group) for group in groups))
        for file in track(made, "texture maps", len(groups), progress):
            with np.load(file) as maps:
                yield from zip(maps["values"], maps["seen"], strict=True)
            file.unlink()


def make_maps(shared: Shared[MapsJob], first: int, last: int) -> Path:
    """The file of the maps of observations `first` to `last` - 1, on a worker."""
    job, place = shared.value(), shared.file.parent
    atlas = job.atlas

    def project(index: int) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
        photograph, camera = job.observations.photograph(index), job.cameras[job.observations.camera_of(index)]
        return texture_map(atlas, camera, photograph.pixels, photograph.mask, job.max_angle)

    values, seen = zip(*parallel_stream(project, range(first, last)), strict=True)
    file = place / f"{first}.npz"
    with output_errors(place), temporary_file(file.name, place) as part:  # another worker may write the same file
        with part.open("wb") as target:
            np.savez(target, values=np.stack(values), seen=np.stack(seen))
        part.chmod(0o644)  # it was the worker's alone
        rename(part, file)
    return file
