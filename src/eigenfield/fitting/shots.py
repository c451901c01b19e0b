"""The photographs that a fit is held against, and how the renderer draws each of their cameras."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.camera import Camera
from eigenfield.files import scratch_array
from eigenfield.fitting.kernels import place_pixels
from eigenfield.mesh import Mesh
from eigenfield.metrics import to_codes
from eigenfield.parallel import parallel_stream
from eigenfield.progress import Progress, track
from eigenfield.rendering.drawing import Frame, Surface, cover, make_surface

Decode = Callable[[int], tuple[NDArray[np.float32], NDArray[np.float32] | None]]


@dataclass(frozen=True, eq=False)
class Shots:
    """Photographs of Ne cameras as 8-bit codes, which is what the measures compare with, and where their pixels land.

    shapes: (h, w) of each camera. codes: a flat memory map of R, G, B, landed: one of columns and rows in the atlas,
    both from pixel starts[c] for camera c. counts: likewise what each pixel counts for, 255 for whole; None: all do.
    surface: the mesh under the finest atlas. doubts: what pixels count for instead, see `doubtable`.
    """

    shapes: tuple[tuple[int, int], ...]
    codes: NDArray[np.uint8]
    landed: NDArray[np.float32]
    starts: NDArray[np.int64]
    counts: NDArray[np.uint8] | None
    surface: Surface
    doubts: NDArray[np.uint8] | None = None

    def __len__(self) -> int:
        return len(self.shapes)

    def photograph(self, index: int) -> NDArray[np.uint8]:
        """(h, w, 3) codes."""
        return self._part(self.codes, index)

    def places(self, index: int) -> NDArray[np.float32]:
        """(h, w, 2): column and row of the atlas that each pixel shows, -1 where it shows none."""
        return self._part(self.landed, index)

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
    decode: Decode,
    mesh: Mesh,
    atlas: tuple[int, int],
    work: Path | None = None,
    progress: Progress | None = None,
) -> Iterator[Shots]:
    """Decode every photograph once, and rasterise the mesh in its camera, into scratch files of 12 bytes a pixel:
    memory does not grow with their number. atlas: (rows, columns) of the finest texture. Raises CaptureError,
    OutputError `disk-full`."""
    shapes = tuple((camera.height, camera.width) for camera in cameras)
    starts, surface = _starts(shapes), make_surface(mesh, *atlas)
    total = int(starts[-1])
    with (
        scratch_array((total, 3), np.uint8, work) as codes,
        scratch_array((total, 2), np.float32, work) as landed,
        scratch_array((total,), np.uint8, work) as counts,
    ):

        def put(index: int) -> bool:
            pixels, mask = decode(index)
            part = slice(starts[index], starts[index + 1])
            codes[part] = to_codes(pixels).reshape(-1, 3)
            landed[part] = _places(surface, cameras[index])
            counts[part] = 255 if mask is None else np.where(mask > 0.5, 255, 0).reshape(-1)
            return mask is not None

        masked = list(track(parallel_stream(put, range(len(cameras))), "photographs", len(cameras), progress))
        yield Shots(shapes, codes, landed, starts, counts if any(masked) else None, surface)


def on_mesh(shots: Shots, cameras: Sequence[Camera], mesh: Mesh) -> Shots:
    """The photographs of `cameras` on another mesh; `shots`, whose places these replace, are of no use any more."""
    surface = make_surface(mesh, *shots.surface.size)

    def put(index: int) -> None:
        shots.landed[shots.starts[index] : shots.starts[index + 1]] = _places(surface, cameras[index])

    for _ in parallel_stream(put, range(len(cameras))):
        pass
    return replace(shots, surface=surface)


def _places(surface: Surface, camera: Camera) -> NDArray[np.float32]:
    """(pixels, 2) of `Shots.landed` for one camera."""
    frame = Frame(surface, camera.height, camera.width)
    cover(surface, camera, frame)
    places = np.zeros((camera.height, camera.width, 2), np.float32)
    place_pixels(frame.inverse_depth, frame.column_of, frame.row_of, *surface.size, places)
    return places.reshape(-1, 2)


@contextlib.contextmanager
def thinned(shots: Shots, step: int, work: Path | None = None) -> Iterator[Shots]:
    """Every `step`-th pixel each way, from a corner that changes with the camera; step 1: the shots themselves."""
    if step == 1:
        yield shots
        return

    def corner(index: int) -> tuple[slice, slice]:
        return slice(7 * index // step % step, None, step), slice(index % step, None, step)

    def size(length: int, part: slice) -> int:
        return len(range(length)[part])

    shapes = tuple(
        (size(h, rows), size(w, columns))
        for (h, w), (rows, columns) in zip(shots.shapes, map(corner, range(len(shots))), strict=True)
    )
    starts = _starts(shapes)
    total = int(starts[-1])
    with (
        scratch_array((total, 3), np.uint8, work) as codes,
        scratch_array((total, 2), np.float32, work) as landed,
        scratch_array((total,), np.uint8, work) as counts,
    ):
        for index in range(len(shots)):
            part, taken = slice(starts[index], starts[index + 1]), corner(index)
            codes[part] = shots.photograph(index)[taken].reshape(-1, 3)
            landed[part] = shots.places(index)[taken].reshape(-1, 2)
            if shots.counts is not None:
                counts[part] = shots.weight(index)[taken].reshape(-1)
        yield Shots(shapes, codes, landed, starts, None if shots.counts is None else counts, shots.surface)


@contextlib.contextmanager
def doubtable(shots: Shots, work: Path | None = None) -> Iterator[Shots]:
    """The same shots, whose pixels `passes.look` may let count for less: a byte a pixel more on disk."""
    with scratch_array((int(shots.starts[-1]),), np.uint8, work) as doubts:
        doubts[:] = 255 if shots.counts is None else shots.counts
        yield replace(shots, doubts=doubts)


def _starts(shapes: Sequence[tuple[int, int]]) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum([h * w for h, w in shapes])]).astype(np.int64)
