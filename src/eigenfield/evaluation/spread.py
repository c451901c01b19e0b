"""Measuring cameras on workers: each reads scene and photographs from their files, and returns scores."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from eigenfield.capture import LightField
from eigenfield.core.progress import Progress, track
from eigenfield.encoding.residual.views import with_differences
from eigenfield.evaluation.session import CameraScores, Session, start_session
from eigenfield.gltf import load
from eigenfield.runtime.executor import refuse_unshared, spread
from eigenfield.runtime.parallel import parallel_stream, pieces
from eigenfield.runtime.shared import Shared, share
from eigenfield.runtime.tasks import Workers

TASKS_PER_WORKER = 4  # so that the last ones end at about the same time


@dataclass(frozen=True, eq=False)
class MeasureJob:
    """What a worker needs to measure cameras.

    Attributes:
        capture: Photographs with cameras: their paths, no pixels.
        settings: Of `start_session`.
    """

    scene: Path
    capture: LightField
    settings: Mapping[str, Any]

    @cached_property
    def session(self) -> Session:
        """Begun once by each worker."""
        return start_session(load(self.scene), self.capture, **self.settings)


def measure_on(
    workers: Workers, job: MeasureJob, indices: Sequence[int], progress: Progress | None
) -> dict[int, CameraScores]:
    """The scores of cameras, which are those that one process finds.

    Args:
        workers: Of `open_executor`. They see the folder of the scene, and the photographs.

    Raises:
        OutputError: `folder-not-shared`; the scene's folder cannot be written.
    """
    folder = job.scene.absolute().parent
    refuse_unshared(workers, folder)
    size = math.ceil(len(indices) / (TASKS_PER_WORKER * workers.width))
    groups = [list(indices[start:stop]) for start, stop in pieces(len(indices), size)]
    with share([job], folder) as (shared,):
        found: dict[int, CameraScores] = {}
        results = spread(workers, ((measure_group, shared, group) for group in groups))
        for part in track(results, "measuring", len(groups), progress):
            found |= part
    return found


def measure_group(shared: Shared[MeasureJob], indices: Sequence[int]) -> dict[int, CameraScores]:
    """The scores of a few cameras, on a worker."""
    session = shared.value().session
    views = with_differences(session.scene, indices, session.measures_residual)
    return dict(parallel_stream(lambda view: (view[0], session.measure(*view)), views))
