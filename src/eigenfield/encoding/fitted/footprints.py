"""Where the pixels of each camera land in the atlas of a mesh, whatever is seen there, and when."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.encoding.fitted.kernels import footprint_coordinates, footprint_counts
from eigenfield.rendering.software.drawing import Framebuffer, Surface, rasterise_surface, smooth_edges
from eigenfield.runtime.files import scratch_array
from eigenfield.runtime.parallel import parallel_map

Footprint = tuple[NDArray[np.uint8], NDArray[np.float32]]


@dataclass(frozen=True, eq=False)
class Footprints:
    """The footprints of Nc cameras on a mesh, shared by all observations of a camera.

    Attributes:
        shapes: (h, w) of each camera's picture.
        counts: flat uint8, of how many points of the atlas each pixel is the mean, 0 to 4, camera by camera.
        pixel_offsets: (Nc + 1,) where the counts of each camera begin.
        texel_coordinates: (n, 2) float32, columns and rows of these points, pixel by pixel, camera by camera.
        offsets: (Nc + 1,) where the coordinates of each camera begin.
        surface: the mesh under the finest atlas.
        detail: texels for one pixel of the reference camera.
    """

    shapes: tuple[tuple[int, int], ...]
    counts: NDArray[np.uint8]
    pixel_offsets: NDArray[np.int64]
    texel_coordinates: NDArray[np.float32]
    offsets: NDArray[np.int64]
    surface: Surface
    detail: float

    def __len__(self) -> int:
        return len(self.shapes)

    def of(self, camera: int) -> Footprint:
        """(h, w) counts and (n, 2) texel coordinates of a camera."""
        counts = self.counts[self.pixel_offsets[camera] : self.pixel_offsets[camera + 1]]
        coordinates = self.texel_coordinates[self.offsets[camera] : self.offsets[camera + 1]]
        return np.asarray(counts).reshape(self.shapes[camera]), np.asarray(coordinates)


@contextlib.contextmanager
def open_footprints(
    surface: Surface, cameras: Sequence[Camera], detail: float, work: Path | None = None
) -> Iterator[Footprints]:
    """Rasterise a mesh in cameras, with smooth edges, as the renderer draws cameras as near as the reference; in those
    of half its size and less it takes more samples. The scratch files have 9 bytes a pixel and some more at edges.

    Each camera is rasterised twice, which costs less than room for four points of every pixel would.

    Args:
        surface: the mesh under the finest atlas.
        cameras: whose footprints are wanted.
        detail: texels for one pixel of the reference camera.
        work: folder for the scratch files.
    """
    shapes = tuple((camera.height, camera.width) for camera in cameras)
    pixels = offsets_of([h * w for h, w in shapes])

    def covered(camera: int) -> tuple[Framebuffer, NDArray[np.uint8]]:
        sampling = smooth_edges(detail)
        frame = Framebuffer(surface, *shapes[camera], sampling)
        rasterise_surface(surface, cameras[camera], sampling, frame)
        return frame, counts[pixels[camera] : pixels[camera + 1]].reshape(shapes[camera])

    def count(camera: int) -> int:
        frame, part = covered(camera)
        return int(footprint_counts(frame.inverse_depth, frame.spans, frame.multisampled, frame.subsamples, part))

    def put(camera: int) -> None:
        frame, part = covered(camera)
        into = coordinates[offsets[camera] : offsets[camera + 1]]
        footprint_coordinates(
            frame.inverse_depth, frame.column_of, frame.row_of, frame.spans, frame.multisampled, frame.subsamples,
            *surface.size, part, into,
        )  # fmt: skip

    with scratch_array((int(pixels[-1]),), np.uint8, work) as counts:
        offsets = offsets_of(parallel_map(count, range(len(cameras))))
        with scratch_array((int(offsets[-1]), 2), np.float32, work) as coordinates:
            parallel_map(put, range(len(cameras)))
            yield Footprints(shapes, counts, pixels, coordinates, offsets, surface, detail)


@contextlib.contextmanager
def subsampled_footprints(footprints: Footprints, step: int, work: Path | None = None) -> Iterator[Footprints]:
    """Those of every `step`-th pixel each way, from `sample_corner` on."""
    cameras = range(len(footprints))
    fewer = [footprints.of(camera)[0][sample_corner(camera, step)] for camera in cameras]
    pixels, offsets = offsets_of([few.size for few in fewer]), offsets_of([int(few.sum()) for few in fewer])
    with (
        scratch_array((int(pixels[-1]),), np.uint8, work) as counts,
        scratch_array((int(offsets[-1]), 2), np.float32, work) as coordinates,
    ):
        for camera in cameras:
            counts[pixels[camera] : pixels[camera + 1]] = fewer[camera].reshape(-1)
            every, points = footprints.of(camera)
            taken = np.zeros(every.shape, np.bool_)
            taken[sample_corner(camera, step)] = True
            coordinates[offsets[camera] : offsets[camera + 1]] = points[np.repeat(taken.reshape(-1), every.reshape(-1))]
        shapes = tuple(few.shape for few in fewer)
        yield Footprints(shapes, counts, pixels, coordinates, offsets, footprints.surface, footprints.detail)


def sample_corner(camera: int, step: int) -> tuple[slice, slice]:
    """Rows and columns of every `step`-th pixel each way, from a corner that changes with the camera."""
    return slice(7 * camera // step % step, None, step), slice(camera % step, None, step)


def offsets_of(sizes: Sequence[int]) -> NDArray[np.int64]:
    """(n + 1,) where parts of these sizes begin, one after the other, and where the last one ends."""
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
