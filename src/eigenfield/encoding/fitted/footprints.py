"""Where the pixels of each camera land in the atlas of a mesh, whatever is seen there, and when."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate, pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.proxy import Sheets
from eigenfield.encoding.fitted.kernels import footprint_coordinates, footprint_counts
from eigenfield.encoding.fitted.model import make_upsampler
from eigenfield.encoding.fitted.sheet_kernels import sheet_points
from eigenfield.rendering.software.drawing import (
    CENTRE_OFFSETS_PX,
    Framebuffer,
    Sampling,
    Surface,
    rasterise_surface,
    smooth_edges,
)
from eigenfield.runtime.files import scratch_array, scratch_rows
from eigenfield.runtime.parallel import parallel_map, parallel_stream

Footprint = tuple[NDArray[np.uint8], NDArray[np.float32], NDArray[np.uint16]]
ONE_SAMPLE = Sampling(1, CENTRE_OFFSETS_PX, 0)  # of each sheet a pixel


@dataclass(frozen=True, eq=False)
class Footprints:
    """The footprints of Nc cameras on a mesh, shared by all observations of a camera.

    Attributes:
        shapes: (h, w) of each camera's picture.
        counts: flat uint8, of how many points of the atlas each pixel is the weighted sum, camera by camera.
        pixel_offsets: (Nc + 1,) where the counts of each camera begin.
        texel_coordinates: (n, 2) float32, columns and rows of these points, pixel by pixel, camera by camera.
        shares: (n,) uint16 the weights of these points, see `kernels`; (0,) on an opaque surface.
        offsets: (Nc + 1,) where the points of each camera begin.
        surface: the mesh under the finest atlas.
        detail: texels for one pixel of the reference camera.
    """

    shapes: tuple[tuple[int, int], ...]
    counts: NDArray[np.uint8]
    pixel_offsets: NDArray[np.int64]
    texel_coordinates: NDArray[np.float32]
    shares: NDArray[np.uint16]
    offsets: NDArray[np.int64]
    surface: Surface
    detail: float

    def __len__(self) -> int:
        return len(self.shapes)

    @property
    def nbytes(self) -> int:
        """Of its scratch files."""
        return self.counts.nbytes + self.texel_coordinates.nbytes + self.shares.nbytes

    def of(self, camera: int) -> Footprint:
        """(h, w) counts, (n, 2) texel coordinates and (n,) or (0,) shares of a camera."""
        counts = self.counts[self.pixel_offsets[camera] : self.pixel_offsets[camera + 1]]
        points = slice(self.offsets[camera], self.offsets[camera + 1])
        coordinates, shares = self.texel_coordinates[points], self.shares[points]
        return np.asarray(counts).reshape(self.shapes[camera]), np.asarray(coordinates), np.asarray(shares)


@contextlib.contextmanager
def open_footprints(
    surface: Surface, cameras: Sequence[Camera], detail: float, sheets: Sheets | None = None, work: Path | None = None
) -> Iterator[Footprints]:
    """Rasterise a mesh in cameras, as the renderer draws cameras as near as the reference; in those of half its size
    and less it takes more samples. An opaque surface has smooth edges, and each sheet one sample a pixel. The scratch
    files have 9 bytes a pixel and some more at edges, and 10 for each sheet that a pixel shows.

    Args:
        detail: texels for one pixel of the reference camera.
        sheets: of the mesh; None: it is opaque.
    """
    shapes = tuple((camera.height, camera.width) for camera in cameras)
    pixels = offsets_of([h * w for h, w in shapes])
    put = partial(_opaque_points, surface, detail)
    if sheets is not None:
        opacity = np.zeros((1, *surface.size), np.float32)
        make_upsampler(surface, (sheets.opacity.shape[0], sheets.opacity.shape[1])).up(sheets.opacity[None], opacity)
        put = partial(_points_of_sheets, surface, sheets.faces, opacity[0])
    with (
        scratch_array((int(pixels[-1]),), np.uint8, work) as counts,
        scratch_rows((2,), np.float32, work) as coordinates,
        scratch_rows((), np.uint16, work) as shares,
    ):

        def points_of(camera: int) -> _Points:
            of_camera = np.asarray(counts[pixels[camera] : pixels[camera + 1]]).reshape(shapes[camera])
            return put(cameras[camera], of_camera)

        sizes = []
        for points, parts in parallel_stream(points_of, range(len(cameras))):
            coordinates.append(points)
            shares.append(parts)
            sizes.append(len(points))
        found = coordinates.mapped(), shares.mapped(), offsets_of(sizes)
        yield Footprints(shapes, counts, pixels, *found, surface, detail)


_Points = tuple[NDArray[np.float32], NDArray[np.uint16]]


@contextlib.contextmanager
def _open_points(count: int, shared: bool, work: Path | None) -> Iterator[_Points]:
    """(count, 2) coordinates and (count,) shares, or (0,), in scratch files."""
    with (
        scratch_array((count, 2), np.float32, work) as coordinates,
        scratch_array((count if shared else 0,), np.uint16, work) as shares,
    ):
        yield coordinates, shares


def _opaque_points(surface: Surface, detail: float, camera: Camera, counts: NDArray[np.uint8]) -> _Points:
    """(n, 2) texel coordinates and (0,) shares of a camera's points; fills its counts."""
    sampling = smooth_edges(detail)
    frame = Framebuffer(surface, camera.height, camera.width, sampling)
    rasterise_surface(surface, camera, sampling, frame)
    edges = frame.spans, frame.multisampled, frame.subsamples
    coordinates = np.empty((footprint_counts(frame.inverse_depth, *edges, counts), 2), np.float32)
    places = frame.inverse_depth, frame.column_of, frame.row_of
    footprint_coordinates(*places, *edges, *surface.size, counts, coordinates)
    return coordinates, np.zeros(0, np.uint16)


def _points_of_sheets(
    surface: Surface, faces: Sequence[int], opacity: NDArray[np.float32], camera: Camera, counts: NDArray[np.uint8]
) -> _Points:
    """As `_opaque_points`, of sheets with so many faces each and an opacity as large as the atlas."""
    drawn = []
    for ends in reversed(list(pairwise(accumulate(faces, initial=0)))):
        sheet = _part_of(surface, slice(*ends))
        frame = Framebuffer(sheet, camera.height, camera.width, ONE_SAMPLE)
        rasterise_surface(sheet, camera, ONE_SAMPLE, frame)
        drawn.append((frame.inverse_depth, frame.column_of, frame.row_of))
    starts: NDArray[np.int64] = np.zeros((0, counts.shape[1]), np.int64)
    coordinates, shares = np.zeros((0, 2), np.float32), np.zeros(0, np.uint16)
    for counted in (False, True):
        if counted:
            starts = (np.cumsum(counts, dtype=np.int64) - counts.reshape(-1)).reshape(counts.shape)
            total = int(counts.sum(dtype=np.int64))
            coordinates, shares = np.empty((total, 2), np.float32), np.empty(total, np.uint16)
        rest = np.ones(counts.shape, np.float32)
        counts[:] = 0
        for places in drawn:
            sheet_points(*places, opacity, rest, counts, starts, coordinates, shares)
    return coordinates, shares


def _part_of(surface: Surface, faces: slice) -> Surface:
    """Some faces of a surface."""
    return replace(surface, faces=surface.faces[faces], reach=surface.reach[faces], rims=surface.rims[faces])


@contextlib.contextmanager
def subsampled_footprints(footprints: Footprints, step: int, work: Path | None = None) -> Iterator[Footprints]:
    """Those of every `step`-th pixel each way, from `sample_corner` on."""
    fewer = [footprints.of(camera)[0][sample_corner(camera, step)] for camera in range(len(footprints))]

    def taken(camera: int) -> NDArray[np.bool_]:
        found = np.zeros(footprints.shapes[camera], np.bool_)
        found[sample_corner(camera, step)] = True
        return found

    with _chosen_footprints(footprints, fewer, taken, work) as chosen:
        yield chosen


@contextlib.contextmanager
def masked_footprints(
    footprints: Footprints, seen: Callable[[int], NDArray[np.bool_]], work: Path | None = None
) -> Iterator[Footprints]:
    """Those of some pixels; the others show nothing.

    Args:
        seen: From the number of a camera to (h, w), which of its pixels these are.
    """
    masks = parallel_map(seen, range(len(footprints)))
    fewer = [footprints.of(camera)[0] * mask for camera, mask in enumerate(masks)]
    with _chosen_footprints(footprints, fewer, masks.__getitem__, work) as chosen:
        yield chosen


@contextlib.contextmanager
def _chosen_footprints(
    footprints: Footprints,
    fewer: Sequence[NDArray[np.uint8]],
    taken: Callable[[int], NDArray[np.bool_]],
    work: Path | None,
) -> Iterator[Footprints]:
    """Those of some pixels.

    Args:
        fewer: The counts that are left of each camera.
        taken: From the number of a camera to (h, w), which of its pixels' points are kept.
    """
    pixels, offsets = offsets_of([few.size for few in fewer]), offsets_of([int(few.sum()) for few in fewer])
    with (
        scratch_array((int(pixels[-1]),), np.uint8, work) as counts,
        _open_points(int(offsets[-1]), len(footprints.shares) > 0, work) as (coordinates, shares),
    ):

        def put(camera: int) -> None:
            counts[pixels[camera] : pixels[camera + 1]] = fewer[camera].reshape(-1)
            every, points, weights = footprints.of(camera)
            kept = np.repeat(taken(camera).reshape(-1), every.reshape(-1))
            into = slice(offsets[camera], offsets[camera + 1])
            coordinates[into] = points[kept]
            if len(shares):
                shares[into] = weights[kept]

        parallel_map(put, range(len(footprints)))
        shapes = tuple(few.shape for few in fewer)
        yield Footprints(shapes, counts, pixels, coordinates, shares, offsets, footprints.surface, footprints.detail)


def sample_corner(camera: int, step: int) -> tuple[slice, slice]:
    """Rows and columns of every `step`-th pixel each way, from a corner that changes with the camera."""
    return slice(7 * camera // step % step, None, step), slice(camera % step, None, step)


def offsets_of(sizes: Sequence[int]) -> NDArray[np.int64]:
    """(n + 1,) where parts of these sizes begin, one after the other, and where the last one ends."""
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
