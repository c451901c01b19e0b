"""The groups of a clip. Each is made by itself, in this process or on a worker, and is a finished stage when it is."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from eigenfield.core.films import CodedGroup, FilmLayout
from eigenfield.core.progress import Progress, track
from eigenfield.encoding.clip.closed_loop import code_group, texture_counts
from eigenfield.encoding.clip.films import CodedFilm
from eigenfield.encoding.clip.frames import GroupFrames, load_arrays, save_arrays
from eigenfield.encoding.clip.motion import MovingMesh
from eigenfield.encoding.clip.opacity import open_coded_opacity
from eigenfield.encoding.clip.open_loop import OpenGroup, fit_group
from eigenfield.encoding.clip.plan import ClipPlan, open_clip_plan
from eigenfield.encoding.clip.projected import project_group
from eigenfield.encoding.options import PRESETS, resolved_value
from eigenfield.encoding.plan import EncodePlan
from eigenfield.gltf.group import group_bytes
from eigenfield.runtime.executor import refuse_unshared, spread
from eigenfield.runtime.shared import Shared, share
from eigenfield.runtime.stages import SCENE_ROOMS, Stages, stage_key
from eigenfield.runtime.tasks import Task, Workers

if TYPE_CHECKING:
    from eigenfield.capture.footage import Footage

GROUP_FILE = "group.bin"
# Of a worker. Measured: 0.7 GB for the passes of twenty views of 512 x 512, and 0.69 GB for a film of 3.1 megapixels
PASSES_MEMORY_BYTES = 1e9
FILM_PIXEL_MEMORY_BYTES = 220.0


@dataclass(frozen=True, eq=False)
class MadeGroup:
    """A group as it lies in a file.

    Attributes:
        counts: Eigen textures of each plane.
        psnr: dB of each frame's luma, before its mean was coded.
    """

    data: bytes
    counts: tuple[int, ...]
    psnr: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Run:
    """Frames in a row that are encoded on one mesh, or on meshes with the same triangles.

    Attributes:
        spans: The first frame of each of its groups, and the one after the group's last.
        moving: The mesh at each frame; None: it stands still.
    """

    spans: tuple[tuple[int, int], ...]
    plan: EncodePlan
    moving: MovingMesh | None = None


@dataclass(frozen=True, eq=False)
class Groups:
    """What the groups of a clip are made of. It is the same in all processes.

    Attributes:
        runs: In the order of time. The first one's plan is that of the clip.
        identity: What every group depends on.
        work: Folder for scratch files; None: the system's.
    """

    footage: Footage
    runs: tuple[Run, ...]
    identity: str
    work: Path | None

    @property
    def spans(self) -> list[tuple[int, int]]:
        """The first frame of each group, and the one after its last."""
        return [span for run in self.runs for span in run.spans]

    @contextlib.contextmanager
    def open_run(self, run: Run) -> Iterator[ClipPlan]:
        """The plan of a run, whose textures are as large as those of all others."""
        with open_clip_plan(run.plan, self.work, run.moving, self.runs[0].plan.density) as clip:
            yield clip

    def run_of(self, number: int) -> Run:
        """The run of a group."""
        return next(run for run in self.runs if self.spans[number] in run.spans)

    def make_all(
        self, stages: Stages, workers: Workers | None, progress: Progress | None
    ) -> tuple[list[MadeGroup], FilmLayout]:
        """All groups, and how their films are laid out.

        Args:
            workers: That make all groups but the first, which says how many textures there are.
        """
        made: list[MadeGroup] = []
        for run in self.runs:
            with self.open_run(run) as clip:
                for _ in run.spans:
                    counts = made[0].counts if made else None
                    made.append(self.make(clip, stages, len(made), counts, progress))
                    if len(made) == 1:
                        layout = clip.layout(made[0].counts)
                        if workers is not None and len(self.spans) > 1:
                            self.make_on_workers(layout, stages, made[0].counts, workers, progress)
        return made, layout

    def key(self, number: int, counts: tuple[int, ...] | None) -> str:
        """Of the stage of a group."""
        return stage_key([self.identity, *self.spans[number], counts], SCENE_ROOMS)

    def make(
        self, clip: ClipPlan, stages: Stages, number: int, counts: tuple[int, ...] | None, progress: Progress | None
    ) -> MadeGroup:
        """A group, made or taken up from an earlier run.

        Args:
            counts: Eigen textures of each plane; None: as many as pay in this group.
        """
        title, key = f"group {number + 1} of {len(self.spans)}", self.key(number, counts)
        projected = clip.plan.options.fit == "none"
        clip = clip if counts is None else clip.with_textures(counts)
        frames = GroupFrames(clip, self.footage.instant, range(*self.spans[number]), stages, key, title, progress)

        def build(folder: Path) -> None:
            coded, psnr, kept = _projected(frames) if projected else _fitted(frames, counts)
            if self.run_of(number) is not self.runs[0]:
                coded = replace(coded, mesh=clip.plan.payloads.only("mesh"))
            (folder / GROUP_FILE).write_bytes(group_bytes(coded))
            save_arrays(folder, {"counts": np.array(kept), "psnr": np.array(psnr)})

        folder = stages.run(_name(number), key, build)
        frames.clear()
        found = load_arrays(folder)
        return MadeGroup(
            (folder / GROUP_FILE).read_bytes(), tuple(found["counts"].tolist()), tuple(found["psnr"].tolist())
        )

    def make_on_workers(
        self, layout: FilmLayout, stages: Stages, counts: tuple[int, ...], workers: Workers, progress: Progress | None
    ) -> None:
        """Have workers make all groups but the first, as finished stages.

        Raises:
            OutputError: `folder-not-shared`, a worker does not see the stages.
        """
        refuse_unshared(workers, stages.folder)
        films = sum(width * height for width, height in layout.sizes)
        task = Task(make_group, PASSES_MEMORY_BYTES + FILM_PIXEL_MEMORY_BYTES * films)
        with share([self], stages.folder) as (shared,):
            calls = [(task, stages.place, shared, number, counts) for number in range(1, len(self.spans))]
            for _ in track(spread(workers, calls), "groups on workers", len(calls), progress):
                pass


def _fitted(frames: GroupFrames, counts: tuple[int, ...] | None) -> tuple[CodedGroup, list[float], tuple[int, ...]]:
    """A group that is fitted in the pictures, the PSNR of its frames, and its eigen textures of each plane.

    Args:
        counts: As in `Groups.make`.
    """
    clip = frames.clip
    with open_fitted(frames) as (group, opened, opacity):
        kept = texture_counts(clip, opened) if counts is None else counts
        return *code_group(group, opened, clip.layout(kept), opacity), kept


@contextlib.contextmanager
def open_fitted(frames: GroupFrames) -> Iterator[tuple[GroupFrames, OpenGroup, CodedFilm | None]]:
    """A group that is fitted and waits to be coded, and the film of its opacity, which is; None: it has no sheets."""
    with (
        frames.opened() as seen,
        open_coded_opacity(seen) as (sheets, opacity),
        sheets.changing() as group,
    ):
        yield group, fit_group(group, PRESETS[resolved_value(frames.clip.plan.options.preset)].rounds), opacity


def _projected(frames: GroupFrames) -> tuple[CodedGroup, list[float], tuple[int, ...]]:
    """A group the paper's way; see `_fitted`."""
    opened = project_group(frames)
    kept = tuple(one.weights.shape[1] for one in opened.weights)
    return *code_group(frames, opened, frames.clip.layout(kept), None, closed=False), kept


def make_group(place: Path, shared: Shared[Groups], number: int, counts: tuple[int, ...]) -> None:
    """Make the stage of one group in a folder or at an address, on a worker."""
    groups = shared.value()
    with Stages(place) as stages:
        if stages.find(_name(number), groups.key(number, counts)) is None:
            with groups.open_run(groups.run_of(number)) as clip:
                groups.make(clip, stages, number, counts, None)


def _name(number: int) -> str:
    return f"group-{number:04d}"
