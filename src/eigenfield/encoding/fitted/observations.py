"""The photographs that a fit is held against, and how the renderer draws each of their cameras."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import Observations
from eigenfield.core.progress import Progress, track
from eigenfield.encoding.fitted.kernels import count_places, place_pixels
from eigenfield.imaging.metrics import to_codes
from eigenfield.rendering.software.drawing import Frame, Surface, cover, make_surface, median_footprint, smooth_edges
from eigenfield.runtime.files import scratch_array
from eigenfield.runtime.parallel import parallel_stream


@dataclass(frozen=True, eq=False)
class Shots:
    """Photographs of Ne cameras as 8-bit codes, which is what the measures compare with, and where their pixels land.

    shapes: (h, w) of each camera. codes: a flat memory map of R, G, B, from pixel starts[c] on for camera c. counts:
    likewise what each pixel counts for, 255 for whole; None: all do. many, landed: likewise `many` and `places` of
    `fitting.kernels`, the latter from begins[c] on. surface: the mesh under the finest atlas. detail: texels for one
    pixel of the reference camera. doubts: what pixels count for instead, see `doubtable`.
    """

    shapes: tuple[tuple[int, int], ...]
    codes: NDArray[np.uint8]
    starts: NDArray[np.int64]
    counts: NDArray[np.uint8] | None
    many: NDArray[np.uint8]
    landed: NDArray[np.float32]
    begins: NDArray[np.int64]
    surface: Surface
    detail: float
    doubts: NDArray[np.uint8] | None = None

    def __len__(self) -> int:
        return len(self.shapes)

    def photograph(self, index: int) -> NDArray[np.uint8]:
        """(h, w, 3) codes."""
        return self._part(self.codes, index)

    def places(self, index: int) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """(h, w), (n, 2): of how many places each pixel is the mean, and their columns and rows in the atlas."""
        return self._part(self.many, index)[..., 0], np.asarray(
            self.landed[self.begins[index] : self.begins[index + 1]]
        )

    def _part(self, of: NDArray[Any], index: int) -> NDArray[Any]:
        return np.asarray(of[self.starts[index] : self.starts[index + 1]]).reshape(*self.shapes[index], -1)

    def weight(self, index: int) -> NDArray[np.uint8]:
        """(h, w) what the pixels count for, 255 for whole, or (0, 0) where all do."""
        return self.mask(index) if self.doubts is None else self._part(self.doubts, index)[..., 0]

    def mask(self, index: int) -> NDArray[np.uint8]:
        """The same without doubts."""
        return np.zeros((0, 0), np.uint8) if self.counts is None else self._part(self.counts, index)[..., 0]


@contextlib.contextmanager
def open_shots(
    cameras: Sequence[Camera],
    observations: Observations,
    mesh: Mesh,
    atlas: tuple[int, int],
    work: Path | None = None,
    progress: Progress | None = None,
    reference: int = 0,
) -> Iterator[Shots]:
    """Decode every photograph once, and rasterise the mesh in its camera, into scratch files of 13 bytes a pixel and
    some more at edges: memory does not grow with their number. atlas: (rows, columns) of the finest texture.
    reference: index of the scene's reference camera. Raises CaptureError, OutputError `disk-full`."""
    shapes = tuple((camera.height, camera.width) for camera in cameras)
    starts = _starts([h * w for h, w in shapes])
    total = int(starts[-1])
    with (
        scratch_array((total, 3), np.uint8, work) as codes,
        scratch_array((total,), np.uint8, work) as counts,
    ):

        def put(index: int) -> bool:
            photograph = observations.photograph(index)
            mask, part = photograph.mask, slice(starts[index], starts[index + 1])
            codes[part] = to_codes(photograph.pixels).reshape(-1, 3)
            counts[part] = 255 if mask is None else np.where(mask > 0.5, 255, 0).reshape(-1)
            return mask is not None

        masked = list(track(parallel_stream(put, range(len(cameras))), "photographs", len(cameras), progress))
        surface = make_surface(mesh, *atlas)
        detail = median_footprint(surface, cameras[reference])
        with _landed(surface, cameras, starts, detail, work) as landed:
            yield Shots(shapes, codes, starts, counts if any(masked) else None, *landed, surface, detail)


@contextlib.contextmanager
def on_mesh(shots: Shots, cameras: Sequence[Camera], mesh: Mesh, work: Path | None = None) -> Iterator[Shots]:
    """The photographs of `cameras` on another mesh."""
    surface = make_surface(mesh, *shots.surface.size)
    with _landed(surface, cameras, shots.starts, shots.detail, work) as (many, landed, begins):
        yield replace(shots, many=many, landed=landed, begins=begins, surface=surface)


@contextlib.contextmanager
def _landed(
    surface: Surface, cameras: Sequence[Camera], starts: NDArray[np.int64], detail: float, work: Path | None
) -> Iterator[tuple[NDArray[np.uint8], NDArray[np.float32], NDArray[np.int64]]]:
    """`many`, `landed` and `begins` of `Shots`, with smooth edges, as the renderer draws cameras as near as the
    reference; in those of half its size and less it takes more samples.

    Each camera is rasterised twice, which costs less than room for four places of every pixel would."""

    def drawn(index: int) -> tuple[Frame, NDArray[np.uint8]]:
        camera, sampling = cameras[index], smooth_edges(detail)
        frame = Frame(surface, camera.height, camera.width, sampling)
        cover(surface, camera, sampling, frame)
        return frame, many[starts[index] : starts[index + 1]].reshape(camera.height, camera.width)

    def count(index: int) -> int:
        frame, part = drawn(index)
        return int(count_places(frame.inverse_depth, frame.spans, frame.parted, frame.finer, part))

    def put(index: int) -> None:
        frame, part = drawn(index)
        into = places[begins[index] : begins[index + 1]]
        place_pixels(
            frame.inverse_depth, frame.column_of, frame.row_of, frame.spans, frame.parted, frame.finer, *surface.size,
            part, into,
        )  # fmt: skip

    with scratch_array((int(starts[-1]),), np.uint8, work) as many:
        begins = _starts(list(parallel_stream(count, range(len(cameras)))))
        with scratch_array((int(begins[-1]), 2), np.float32, work) as places:
            for _ in parallel_stream(put, range(len(cameras))):
                pass
            yield many, places, begins


@contextlib.contextmanager
def thinned(shots: Shots, step: int, work: Path | None = None) -> Iterator[Shots]:
    """Every `step`-th pixel each way, from a corner that changes with the camera; step 1: the shots themselves."""
    if step == 1:
        yield shots
        return

    def corner(index: int) -> tuple[slice, slice]:
        return slice(7 * index // step % step, None, step), slice(index % step, None, step)

    fewer = [shots.places(index)[0][corner(index)] for index in range(len(shots))]
    shapes = tuple(count.shape for count in fewer)
    starts, begins = _starts([h * w for h, w in shapes]), _starts([int(count.sum()) for count in fewer])
    total = int(starts[-1])
    with (
        scratch_array((total, 3), np.uint8, work) as codes,
        scratch_array((total,), np.uint8, work) as counts,
        scratch_array((total,), np.uint8, work) as many,
        scratch_array((int(begins[-1]), 2), np.float32, work) as landed,
    ):
        for index in range(len(shots)):
            part, taken, (count, places) = slice(starts[index], starts[index + 1]), corner(index), shots.places(index)
            codes[part] = shots.photograph(index)[taken].reshape(-1, 3)
            many[part] = count[taken].reshape(-1)
            kept = np.zeros(count.shape, np.bool_)
            kept[taken] = True
            landed[begins[index] : begins[index + 1]] = places[np.repeat(kept.reshape(-1), count.reshape(-1))]
            if shots.counts is not None:
                counts[part] = shots.weight(index)[taken].reshape(-1)
        weighed = None if shots.counts is None else counts
        yield Shots(shapes, codes, starts, weighed, many, landed, begins, shots.surface, shots.detail)


@contextlib.contextmanager
def doubtable(shots: Shots, work: Path | None = None) -> Iterator[Shots]:
    """The same shots, whose pixels `passes.look` may let count for less: a byte a pixel more on disk."""
    with scratch_array((int(shots.starts[-1]),), np.uint8, work) as doubts:
        doubts[:] = 255 if shots.counts is None else shots.counts
        yield replace(shots, doubts=doubts)


def _starts(sizes: Sequence[int]) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
