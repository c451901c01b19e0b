"""A mesh under a texture, as a camera sees it: rasterise, say which tiles are needed, shade."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.camera import Camera
from eigenfield.errors import OptionError
from eigenfield.mesh import Mesh
from eigenfield.parallel import parallel_map, pieces
from eigenfield.raster import (
    BAND,
    BOUND_SLACK,
    EDGE_SLACK,
    SET_UP,
    bound_faces,
    edge_functions,
    sort_into_bands,
)
from eigenfield.rendering.kernels import DEPTH, TILE, draw_texels, gather_samples, mark_tiles, shade_rows
from eigenfield.rendering.simd import RUN

FILTERS = ("bilinear", "bicubic")
MARGIN = 2  # texels that the widest filter reaches
SAMPLES_LIMIT = 4  # along a side of a pixel, when chosen automatically
ONE_SAMPLE = 1.5  # photograph pixels a pixel up to which one sample is enough
FOOTPRINTS = 256  # triangles from which the median footprint is taken
CENTRE = np.zeros((1, 2))
STANDARD = np.array([[-2, -6], [6, -2], [-6, 2], [2, 6]]) / 16  # where GPUs put four samples of a pixel
APART = 1.0  # of the length of a usual pixel in texels: samples farther from each other show different things


@dataclass(frozen=True, eq=False)
class Sampling:
    """Where a picture is sampled. side: k, a pixel being the mean of k x k samples. Or, with k = 1, of those at
    `offsets` (s, 2) from its middle, pixels right and down; where all of them show places within `limit` texels of the
    atlas, what they show on average, as the middle would, is looked at once."""

    side: int
    offsets: NDArray[np.float64]
    limit: float


@dataclass(frozen=True, eq=False)
class Surface:
    """A mesh prepared for an atlas of H x W texels.

    vertices: (n, 3) float64. faces: (m, 3) int32. texels: (n, 2) float64, UV in texels, whole at texel centres.
    reach: (m, 4) int32, the tiles [top, bottom] x [left, right] that a triangle's filter touches.
    used: (tile rows, tile columns) bool, whether any does.
    size: H, W.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]
    texels: NDArray[np.float64]
    reach: NDArray[np.int32]
    used: NDArray[np.bool_]
    size: tuple[int, int]


def make_surface(mesh: Mesh, height: int, width: int) -> Surface:
    """Prepare a mesh, which must have UVs, for textures of `height` x `width`."""
    assert mesh.uv is not None, "a mesh without UVs cannot be textured"
    texels = mesh.uv.astype(np.float64) * (width, height) - 0.5
    last = np.array([width - 1, height - 1])
    corners = texels[mesh.faces]
    low = np.clip(np.floor(corners.min(axis=1)) - MARGIN, 0, last).astype(np.int32) // TILE
    high = np.clip(np.ceil(corners.max(axis=1)) + MARGIN, 0, last).astype(np.int32) // TILE
    reach = np.stack([low[:, 1], high[:, 1], low[:, 0], high[:, 0]], axis=1)
    used = np.zeros((-(-height // TILE), -(-width // TILE)), np.bool_)
    for top, bottom, left, right in np.unique(reach, axis=0):
        used[top : bottom + 1, left : right + 1] = True
    faces = np.ascontiguousarray(mesh.faces, dtype=np.int32)
    return Surface(mesh.vertices.astype(np.float64), faces, texels, np.ascontiguousarray(reach), used, (height, width))


class Frame:
    """The buffers of one picture in the making, used again for the next."""

    def __init__(self, surface: Surface, height: int, width: int, sampling: Sampling) -> None:
        count, k = len(surface.faces), sampling.side
        self.size, self.sampling = (height, width), sampling
        self.edges = np.empty((count, 3, 3))
        self.bounds = np.empty((count, 4), np.int32)
        # The samples that are looked at, see `shade_rows`; `RUN` more columns than needed, and never NaN, even where
        # nothing was drawn yet. Pages of samples that no pixel needs take no memory
        shape = height * k, width * k * len(sampling.offsets) + RUN
        self.inverse_depth, self.column_of, self.row_of = np.zeros((3, *shape), np.float32)
        self.ends = np.empty((height, width), np.int32)
        self.ends[:] = np.arange(1, width + 1) * k
        self.bands: deque[NDArray[np.float32]] = deque()  # room for all samples of a band
        self.seen = np.empty(count, np.uint8)
        self.needed = np.empty(surface.used.shape, np.uint8)

    def fits(self, height: int, width: int, sampling: Sampling) -> bool:
        """Whether it has the room for such a picture."""
        mine = self.sampling
        return self.size == (height, width) and mine.side == sampling.side and mine.offsets is sampling.offsets


def cover(surface: Surface, camera: Camera, sampling: Sampling, frame: Frame) -> None:
    """Rasterise: where each sample lands in the atlas, and which tiles are needed."""
    k, offsets = sampling.side, sampling.offsets
    matrix = (camera.resized(camera.width * k, camera.height * k) if k > 1 else camera).matrix
    corners = surface.vertices @ matrix[:, :3].T
    corners += matrix[:, 3]
    height, width = camera.height * k, camera.width * k
    slack = BOUND_SLACK + float(np.abs(offsets).max())
    frame.seen[:] = 0

    def set_up(part: tuple[int, int]) -> None:
        edge_functions(corners, surface.faces, *part, frame.edges)
        bound_faces(corners, surface.faces, frame.edges, width, height, slack, *part, frame.bounds)

    parallel_map(set_up, pieces(len(surface.faces), SET_UP))
    bands = pieces(height, BAND)
    starts = np.empty(len(bands) + 1, np.int64)
    listing = sort_into_bands(frame.bounds, BAND, starts)
    kept = frame.inverse_depth, frame.column_of, frame.row_of

    def draw(band: int) -> None:
        first, last = bands[band]
        triangles = surface.faces, surface.texels, frame.edges, frame.bounds, listing[starts[band] : starts[band + 1]]
        if len(offsets) == 1:
            whole = (part[None] for part in kept)
            draw_texels(*triangles, first, last, EDGE_SLACK, offsets, 0, *whole, frame.seen)
            return
        try:
            room = frame.bands.pop()
        except IndexError:  # this thread is the first, or another was faster
            room = np.zeros((3, len(offsets), BAND, width + RUN), np.float32)
        draw_texels(*triangles, first, last, EDGE_SLACK, offsets, first, *room, frame.seen)
        gather_samples(*room, np.float32(sampling.limit), first, last, *kept, frame.ends)
        frame.bands.append(room)

    parallel_map(draw, range(len(bands)))
    mark_tiles(frame.seen, surface.reach, frame.needed)


def shade(
    surface: Surface,
    frame: Frame,
    layers: NDArray[np.float32],
    filter: str,
    background: NDArray[np.float32],
    picture: NDArray[Any],
    coverage: NDArray[np.float32],
) -> None:
    """Fill picture (H, W, C), uint8 or float32, and coverage (H, W) from a covered frame of that size, a texture in
    `layers` and a background (C,)."""
    height, width = surface.size
    behind = np.zeros((len(layers), DEPTH), np.float32)
    behind.reshape(-1)[: len(background)] = background
    parallel_map(
        lambda rows: shade_rows(
            frame.inverse_depth, frame.column_of, frame.row_of, frame.ends, layers, width, height, filter == "bicubic",
            frame.sampling.side, behind, picture.dtype == np.uint8, *rows, picture, coverage,
        ),
        pieces(picture.shape[0], BAND),
    )  # fmt: skip


def check_filter(filter: str) -> None:
    """Raise OptionError `filter` unless it is one of `FILTERS`."""
    if filter not in FILTERS:
        raise OptionError("filter", f"no filter is called {filter!r}", remedy=f"use one of {', '.join(FILTERS)}")


def choose_sampling(surface: Surface, camera: Camera, asked: int | None = None, detail: float = 1.0) -> Sampling:
    """k x k samples a pixel if k is asked for. Else from the median footprint of the triangles in view: smooth edges
    in a picture as large as the photographs or larger, k x k samples in a smaller one.

    detail: texels for one pixel of the photographs. Where it is above 1 the atlas is denser than what it holds, and a
    captured view drawn at its own size needs one sample however many texels a pixel covers: more would blur what the
    photograph's own pixels have averaged already. Smaller pictures take as many samples as photograph pixels, at most
    `SAMPLES_LIMIT`. Raises OptionError `samples` outside 1..16.
    """
    if asked is not None:
        if not 1 <= asked <= 16:
            raise OptionError("samples", f"{asked} x {asked} samples a pixel", remedy="ask for 1 to 16")
        return Sampling(asked, CENTRE, 0)
    texels = median_footprint(surface, camera)
    footprint = texels / max(detail, 1.0)
    if footprint <= ONE_SAMPLE:
        return smooth_edges(texels)
    return Sampling(min(int(np.ceil(footprint - 0.5)), SAMPLES_LIMIT), CENTRE, 0)


def smooth_edges(footprint: float) -> Sampling:
    """One sample a pixel, but four where they show different things. footprint: see `median_footprint`."""
    return Sampling(1, STANDARD, APART * footprint)


def median_footprint(surface: Surface, camera: Camera) -> float:
    """Texels a pixel along a side, the median over picture area of (some of) the triangles in view; 0 if there are
    none."""
    faces = surface.faces[:: max(1, len(surface.faces) // FOOTPRINTS)]
    pixels, depth = camera.project(surface.vertices[faces].reshape(-1, 3))
    corners = np.where((depth > 0)[:, None], pixels, np.nan).reshape(-1, 3, 2)
    middle = corners.mean(axis=1)
    shown = ((middle >= 0) & (middle < (camera.width, camera.height))).all(axis=1)
    screen = _areas(corners[shown])
    atlas = _areas(surface.texels[faces[shown]])
    kept = screen > 0
    if not kept.any():
        return 0.0
    screen, atlas = screen[kept], atlas[kept]
    footprints = np.sqrt(atlas / screen)
    order = np.argsort(footprints, kind="stable")
    total = np.cumsum(screen[order])
    return float(footprints[order[np.searchsorted(total, total[-1] / 2)]])


def _areas(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """(T,) areas of (T, 3, 2) triangles."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
