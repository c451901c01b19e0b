"""A textured mesh as a camera sees it: rasterise, find the tiles that are needed, shade."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import math
import mmap
from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh, signed_areas
from eigenfield.imaging.graph import face_edges
from eigenfield.imaging.raster import RASTER_BAND_ROWS, RASTER_EDGE_SLACK_FRACTION, Band, set_up_bands
from eigenfield.rendering.software import edge_kernels
from eigenfield.rendering.software.kernels import LAYER_CHANNELS, TILE_TEXELS, draw_texels, mark_tiles, shade_rows
from eigenfield.rendering.software.simd import LANE_PX
from eigenfield.runtime.parallel import parallel_map, pieces

FILTER_MARGIN_TEXELS = 2  # texels that the widest filter reaches
RENDER_MAX_SAMPLES = 4  # along a side of a pixel, by default
RENDER_ONE_SAMPLE_PX = 1.5  # photograph pixels a pixel up to which one sample is enough
FOOTPRINT_TRIANGLES = 256  # triangles from which the median footprint is taken
CENTRE_OFFSETS_PX = np.zeros((1, 2))
MULTISAMPLE_OFFSETS_PX = np.array([[-2, -6], [6, -2], [-6, 2], [2, 6]]) / 16  # as GPUs place four samples
# Texels, in photograph pixels, by which the middle of a pixel deviates from half way between opposite samples, if these
# do not lie on one piece of the atlas
EDGE_LIMIT_PX = 1.0
EDGE_CANDIDATE_RATIO = 0.5  # of that, between neighbouring pixels: then a pixel's samples are drawn


@dataclass(frozen=True, eq=False)
class Sampling:
    """Where a picture is sampled.

    Attributes:
        side: k: a pixel is the mean of k x k samples.
        offsets: (s, 2) with k = 1, samples of an edge pixel, in pixels right of and below its middle. Other pixels are
            sampled in their middle.
        limit: Texels by which the middle of an edge pixel deviates from half way between opposite samples.
    """

    side: int
    offsets: NDArray[np.float64]
    limit: float


@dataclass(frozen=True, eq=False)
class Surface:
    """A mesh prepared for an atlas of H x W texels.

    Attributes:
        vertices: (n, 3) float64.
        faces: (m, 3) int32.
        texels: (n, 2) float64, UV in texels, whole at texel centres.
        reach: (m, 4) int32, the tiles [top, bottom] x [left, right] that a triangle's filter reads.
        used: (tile rows, tile columns) bool, whether any triangle's filter reads a tile.
        rims: (m,) bool, whether a triangle has an edge that it shares with no other, in space or in the atlas.
        size: H, W.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]
    texels: NDArray[np.float64]
    reach: NDArray[np.int32]
    used: NDArray[np.bool_]
    rims: NDArray[np.bool_]
    size: tuple[int, int]


def make_surface(mesh: Mesh, height: int, width: int) -> Surface:
    """Prepare a mesh with UVs."""
    assert mesh.uv is not None, "a mesh without UVs cannot be textured"
    texels = mesh.uv.astype(np.float64) * (width, height) - 0.5
    last = np.array([width - 1, height - 1])
    corners = texels[mesh.faces]
    low = np.clip(np.floor(corners.min(axis=1)) - FILTER_MARGIN_TEXELS, 0, last).astype(np.int32) // TILE_TEXELS
    high = np.clip(np.ceil(corners.max(axis=1)) + FILTER_MARGIN_TEXELS, 0, last).astype(np.int32) // TILE_TEXELS
    reach = np.stack([low[:, 1], high[:, 1], low[:, 0], high[:, 0]], axis=1)
    used = np.zeros((-(-height // TILE_TEXELS), -(-width // TILE_TEXELS)), np.bool_)
    for top, bottom, left, right in np.unique(reach, axis=0):
        used[top : bottom + 1, left : right + 1] = True
    faces = np.ascontiguousarray(mesh.faces, dtype=np.int32)
    vertices = mesh.vertices.astype(np.float64)
    return Surface(vertices, faces, texels, np.ascontiguousarray(reach), used, _rims(faces), (height, width))


def _rims(faces: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(m,) whether a triangle has an edge whose two vertices no other has."""
    _, edge = face_edges(faces)
    return np.asarray((np.bincount(edge)[edge] == 1).reshape(-1, 3).any(axis=1))


def sparse_zeros(shape: tuple[int, ...], dtype: type[np.float32] | type[np.int32]) -> NDArray[Any]:
    """Zeros whose pages take no memory until they are written.

    NumPy asks Linux for huge pages, many of which would be taken by a few values.
    """
    return np.frombuffer(mmap.mmap(-1, max(1, 4 * math.prod(shape))), dtype, math.prod(shape)).reshape(shape)


class Scratch:
    """Memory in which a thread finds a band's edge pixels: arguments of `edge_kernels`."""

    def __init__(self, width: int) -> None:
        """Make room for a band."""
        blocks = -(-width // edge_kernels.BLOCK_PX)
        self.coordinates = np.empty((2, RASTER_BAND_ROWS + 2, width), np.float32)
        self.marks = np.empty((RASTER_BAND_ROWS, blocks * edge_kernels.BLOCK_PX), np.bool_)
        self.places = np.empty(RASTER_BAND_ROWS * width, np.int32)
        self.starts = np.empty((RASTER_BAND_ROWS, blocks + 1), np.int64)
        self.sums = np.empty((RASTER_BAND_ROWS + 1, blocks + 1), np.int64)
        self.samples = np.empty((RASTER_BAND_ROWS * width, 3, 4), np.float32)


class Framebuffer:
    """Where the samples of one picture land in the atlas; used again for the next.

    Attributes:
        size: (H, W) of the picture.
        edges: (m, 3, 3) edge functions of the triangles.
        bounds: (m, 4) their rows and columns.
        pixels: (n, 2) the vertices in the picture.
        inverse_depth, column_of, row_of: (H k, W k + LANE_PX), of `draw_texels`.
        spans, multisampled, subsamples: Of `keep_multisampled`.
        scratch: Memory of threads that have none to do.
        seen: (m,) uint8 the triangles in view.
        needed: (tile rows, tile columns) uint8 the tiles that these read.
    """

    def __init__(self, surface: Surface, height: int, width: int, sampling: Sampling) -> None:
        """Make room for a picture."""
        count, k = len(surface.faces), sampling.side
        self.size, self.sampling = (height, width), sampling
        self.edges = np.empty((count, 3, 3))
        self.bounds, self.pixels = np.empty((count, 4), np.int32), np.empty((len(surface.vertices), 2))
        # Never NaN, even where nothing was drawn yet
        self.inverse_depth, self.column_of, self.row_of = np.zeros((3, height * k, width * k + LANE_PX), np.float32)
        most = height * width if len(sampling.offsets) > 1 else 0
        self.spans = np.zeros((height, 2), np.int64)
        self.multisampled = sparse_zeros((most,), np.int32)
        self.subsamples = sparse_zeros((3, 4 * most), np.float32)
        self.scratch: deque[Scratch] = deque()
        self.seen = np.empty(count, np.uint8)
        self.needed = np.empty(surface.used.shape, np.uint8)

    def fits(self, height: int, width: int, sampling: Sampling) -> bool:
        """Whether such a picture can be drawn in it."""
        mine = self.sampling
        return self.size == (height, width) and mine.side == sampling.side and mine.offsets is sampling.offsets


def rasterise_surface(surface: Surface, camera: Camera, sampling: Sampling, frame: Framebuffer) -> None:
    """Find where each sample lands in the atlas, and which tiles are needed, in a frame of the camera's size."""
    k, offsets = sampling.side, sampling.offsets
    size, reach = (camera.width * k, camera.height * k), float(np.abs(offsets).max())
    corners = (camera.resize(*size) if k > 1 else camera).homogeneous(surface.vertices)
    bands = set_up_bands(corners, surface.faces, *size, frame.edges, frame.pixels, frame.bounds, reach)
    frame.seen[:] = 0
    middles = frame.inverse_depth, frame.column_of, frame.row_of
    triangles = surface.faces, surface.texels, frame.edges, frame.bounds

    def draw(band: Band) -> None:
        rows, some = band
        frame.inverse_depth[slice(*rows)] = 0
        draw_texels(*triangles, some, *rows, RASTER_EDGE_SLACK_FRACTION, *middles, frame.seen)

    def smooth(band: Band) -> None:
        rows, some = band
        try:
            room = frame.scratch.pop()
        except IndexError:  # this thread is the first, or another was faster
            room = Scratch(size[0])
        drawn, limit, slack = (*triangles, some), np.float32(sampling.limit), RASTER_EDGE_SLACK_FRACTION
        edge_kernels.mark_rims(*drawn[2:], surface.rims, middles[0], *rows, slack, offsets, room.marks)
        listed = room.places, room.starts, room.sums
        candidate = limit * np.float32(EDGE_CANDIDATE_RATIO)
        edge_kernels.find_edge_pixels(*middles, *rows, candidate, *room.coordinates, room.marks, *listed)
        edge_kernels.draw_samples(*drawn, *rows, slack, offsets, *listed, room.samples, frame.seen)
        found, kept = (room.places, room.starts, room.samples), (frame.spans, frame.multisampled, frame.subsamples)
        edge_kernels.keep_multisampled(*middles, *found, limit, *rows, *kept)
        frame.scratch.append(room)

    parallel_map(draw, bands)
    if len(offsets) > 1:
        parallel_map(smooth, bands)
    mark_tiles(frame.seen, surface.reach, frame.needed)


def shade(
    surface: Surface,
    frame: Framebuffer,
    layers: NDArray[np.float32],
    filter: str,
    background: NDArray[np.float32],
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Filter the texture at each sample.

    Args:
        frame: As `rasterise_surface` leaves it.
        layers: (L, tiles, TILE_AREA, 4) the texture.
        filter: `bilinear` or `bicubic`.
        background: (C,) colour of what is not covered.

    Returns:
        (H, W, C) the picture, and (H, W) the part of each pixel's samples that show the surface.
    """
    height, width = surface.size
    picture, coverage = np.empty((*frame.size, len(background)), np.float32), np.empty(frame.size, np.float32)
    behind = np.zeros((len(layers), LAYER_CHANNELS), np.float32)
    behind.reshape(-1)[: len(background)] = background
    parallel_map(
        lambda rows: shade_rows(
            frame.inverse_depth, frame.column_of, frame.row_of, frame.spans, frame.multisampled, frame.subsamples,
            layers, width, height, filter == "bicubic", frame.sampling.side, behind, *rows, picture, coverage,
        ),
        pieces(picture.shape[0], RASTER_BAND_ROWS),
    )  # fmt: skip
    return picture, coverage


def choose_sampling(surface: Surface, camera: Camera, asked: int | None = None, detail: float = 1.0) -> Sampling:
    """How a picture is sampled.

    By default this follows from the median footprint of the triangles in view: smooth edges in a picture as large as
    the photographs or larger, `grid_side` samples in a smaller one.

    Args:
        asked: k of k x k samples a pixel. Default: see above.
        detail: Texels for one pixel of the photographs.

    Raises:
        OptionError: `samples`: `asked` is no whole number from 1 to 16.
    """
    if asked is not None:
        if not isinstance(asked, int | np.integer) or not 1 <= asked <= 16:
            raise OptionError("samples", f"{asked} x {asked} samples a pixel", remedy="ask for 1 to 16")
        return Sampling(int(asked), CENTRE_OFFSETS_PX, 0)
    side = grid_side(surface, camera, detail)
    return smooth_edges(detail) if side == 1 else Sampling(side, CENTRE_OFFSETS_PX, 0)


def grid_side(surface: Surface, camera: Camera, detail: float) -> int:
    """k of the k x k samples a pixel that are taken by default.

    Where `detail` is above 1 the atlas is denser than the photographs. A captured view drawn at its own size then needs
    one sample however many texels a pixel covers: more would blur what the photograph's own pixels have averaged
    already. Smaller pictures take as many samples as photograph pixels, at most `RENDER_MAX_SAMPLES` along a side.

    Args:
        detail: Texels for one pixel of the photographs.
    """
    footprint = median_footprint(surface, camera) / max(detail, 1.0)
    return 1 if footprint <= RENDER_ONE_SAMPLE_PX else min(int(np.ceil(footprint - 0.5)), RENDER_MAX_SAMPLES)


def smooth_edges(detail: float) -> Sampling:
    """One sample a pixel, but four in edge pixels. `detail`: texels for one pixel of the photographs, 0 if unknown."""
    return Sampling(1, MULTISAMPLE_OFFSETS_PX, EDGE_LIMIT_PX * (detail or 1.0))


def median_footprint(surface: Surface, camera: Camera) -> float:
    """Texels a pixel along a side: the median over picture area of (some of) the triangles in view; 0 if none is."""
    some = surface.faces[:: max(1, len(surface.faces) // FOOTPRINT_TRIANGLES)]
    return _footprint(surface, camera, some) or _footprint(surface, camera, surface.faces)


def _footprint(surface: Surface, camera: Camera, faces: NDArray[np.int32]) -> float:
    pixels, depth = camera.project(surface.vertices[faces].reshape(-1, 3))
    corners = np.where((depth > 0)[:, None], pixels, np.nan).reshape(-1, 3, 2)
    middle = corners.mean(axis=1)
    shown = ((middle >= 0) & (middle < (camera.width, camera.height))).all(axis=1)
    screen = np.abs(signed_areas(corners[shown]))
    atlas = np.abs(signed_areas(surface.texels[faces[shown]]))
    kept = screen > 0
    if not kept.any():
        return 0.0
    screen, atlas = screen[kept], atlas[kept]
    footprints = np.sqrt(atlas / screen)
    order = np.argsort(footprints, kind="stable")
    total = np.cumsum(screen[order])
    return float(footprints[order[np.searchsorted(total, total[-1] / 2)]])
