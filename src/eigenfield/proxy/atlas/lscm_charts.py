"""Layout of charts: least-squares conformal, with areas in proportion to the resolution of the photographs."""

from __future__ import annotations

import logging
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh, signed_areas, triangle_areas
from eigenfield.imaging.graph import edge_components, edge_links
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.atlas.chart_merging import Chart, merge_charts
from eigenfield.proxy.atlas.kernels import claim_texels, count_layers
from eigenfield.proxy.atlas.layout import chart_labels, l2_stretch
from eigenfield.proxy.atlas.lscm import conformal_map
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.proxy")

CHART_MAX_STRETCH_RATIO = 1.0  # relative to the stretch of the mesh's own layout
CHART_MAX_STRETCH = 3.0  # a chart with more is cut in halves
CHART_MAX_MERGED_STRETCH = 1.03  # charts whose merged layout has more stay apart
CHART_OVERLAP_RASTER_TEXELS = 256  # at least; more for more triangles
CHART_OVERLAP_MARGIN_TEXELS = 0.05  # of that raster
DENSITY_MAX_VIEWS = 64  # in which density is measured
DENSITY_MIN_PIXELS = 16  # of a chart, that a view must see
DENSITY_MAX_RATIO = 8.0  # of a chart's scale to the median, either way


def conformal_charts(mesh: Mesh) -> Mesh:
    """Every chart of a mesh laid out by `conformal_map`, at the area of its surface.

    Charts are connected by edges: at a single vertex the map could rotate and shrink one side freely. If the map folds,
    overlaps or stretches more than the mesh's own UVs, those are kept (at the same area). If those fold or overlap as
    well, the triangles that do are cut out. Then small charts are merged (`merge_charts`). The charts of the result
    overlap each other and are still to be packed. Faces keep their order.
    """
    assert mesh.uv is not None
    groups = _group_faces(np.arange(len(mesh.faces)), edge_components(mesh.faces))
    cut = [chart for group in parallel_map(lambda faces: _lay_out(mesh, faces), groups) for chart in group]
    charts = merge_charts(mesh, cut, _lay_out_merged)
    log.info(
        "atlas: %d charts of %d, %d least-squares conformal", len(charts), len(cut), sum(c.conformal for c in charts)
    )
    starts = np.cumsum([0, *(len(chart.vertices) for chart in charts[:-1])])
    faces = np.empty_like(mesh.faces)
    for chart, start in zip(charts, starts, strict=True):
        faces[chart.faces] = chart.corners + start
    vertices = mesh.vertices[np.concatenate([chart.vertices for chart in charts])]
    return Mesh(vertices, faces, np.concatenate([chart.uv for chart in charts]).astype(np.float32))


def _lay_out(mesh: Mesh, chart: NDArray[np.int64]) -> list[Chart]:
    assert mesh.uv is not None
    done, waiting = [], [chart]
    while waiting:
        faces = waiting.pop()
        used, index = np.unique(mesh.faces[faces], return_inverse=True)
        corners = index.reshape(-1, 3).astype(np.int32)
        points = mesh.vertices[used].astype(np.float64)
        uv, conformal = _lay_out_chart(points, corners, mesh.uv[used].astype(np.float64))
        if len(faces) > 1 and not _is_valid(uv, points, corners):
            waiting += _cut_overlaps(uv, corners, faces) or _cut_in_halves(points, corners, faces)
        else:
            done.append(Chart(faces, used.astype(np.int64), corners, uv - uv.min(axis=0), conformal))
    return done


def _cut_overlaps(
    uv: NDArray[np.float64], corners: NDArray[np.int32], faces: NDArray[np.int64]
) -> list[NDArray[np.int64]]:
    """Cut a chart into the part grown from its largest triangle without overlaps, and the connected rest.

    Nothing if overlaps are not what is wrong.
    """
    area = signed_areas(uv[corners])
    if not (area > 0).all():
        return []
    one, other = edge_links(corners)
    links = coo_array((np.ones(len(one), np.int8), (one, other)), shape=(len(corners), len(corners)))
    order = breadth_first_order(links, int(np.argmax(area)), directed=False, return_predecessors=False)
    grid, side = _to_raster(uv, len(corners))
    claimed = np.zeros(len(corners), np.bool_)
    claim_texels(
        grid, corners, order.astype(np.int64), CHART_OVERLAP_MARGIN_TEXELS, np.zeros((side, side), np.uint8), claimed
    )
    if claimed.all():
        return []
    return [
        piece for part in (claimed, ~claimed) for piece in _group_faces(faces[part], edge_components(corners[part]))
    ]


def _to_raster(uv: NDArray[np.float64], triangles: int) -> tuple[NDArray[np.float64], int]:
    """A layout in texels of a raster for the overlap test, and the side of the raster."""
    side = CHART_OVERLAP_RASTER_TEXELS + int(8 * np.sqrt(triangles))
    low = uv.min(axis=0)
    return (uv - low) * (side / max(float((uv.max(axis=0) - low).max()), 1e-300)), side


def _cut_in_halves(
    points: NDArray[np.float64], corners: NDArray[np.int32], faces: NDArray[np.int64]
) -> list[NDArray[np.int64]]:
    """The triangles on either side of the middle of the chart's longest direction, as connected pieces."""
    middle = points[corners].mean(axis=1)
    middle = middle - middle.mean(axis=0)
    axis = np.linalg.svd(middle, full_matrices=False)[2][0]
    rank = np.argsort(np.argsort(middle @ axis * np.sign(axis[np.argmax(np.abs(axis))]), kind="stable"))
    first = rank < len(faces) // 2
    return [piece for half in (first, ~first) for piece in _group_faces(faces[half], edge_components(corners[half]))]


def _group_faces(faces: NDArray[np.int64], label: NDArray[np.int32]) -> list[NDArray[np.int64]]:
    order = np.argsort(label, kind="stable")
    return np.split(faces[order], np.cumsum(np.bincount(label))[:-1])


def _lay_out_chart(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], own_uv: NDArray[np.float64]
) -> tuple[NDArray[np.float64], bool]:
    """The layout of one chart, and whether it is conformal."""
    scaled = _scale_to_surface(own_uv, vertices, faces)
    try:
        uv = conformal_map(vertices, faces)
    except RuntimeError:  # the factorisation meets an exactly singular matrix
        return scaled, False
    if not _is_valid(uv, vertices, faces):
        return scaled, False
    if _is_valid(scaled, vertices, faces):
        limit = CHART_MAX_STRETCH_RATIO * l2_stretch(vertices, scaled, faces)
        if l2_stretch(vertices, uv, faces) > limit:
            return scaled, False
    return uv, True


def _lay_out_merged(points: NDArray[np.float64], corners: NDArray[np.int32]) -> NDArray[np.float64] | None:
    """The layout of merged charts; None if there is none or it stretches too much."""
    try:
        uv = conformal_map(points, corners)
    except RuntimeError:  # as in `_lay_out_chart`
        return None
    return uv if _is_valid(uv, points, corners, CHART_MAX_MERGED_STRETCH) else None


def _scale_to_surface(
    uv: NDArray[np.float64], vertices: NDArray[np.float64], faces: NDArray[np.int32]
) -> NDArray[np.float64]:
    """The layout at the area of the surface, with positive total area."""
    area = float(signed_areas(uv[faces]).sum())
    factor = np.sqrt(triangle_areas(vertices[faces]).sum() / abs(area)) if area != 0 else 1.0
    return np.asarray(uv * (factor, -factor if area < 0 else factor))


def _is_valid(
    uv: NDArray[np.float64],
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    max_stretch: float = CHART_MAX_STRETCH,
) -> bool:
    """Whether no triangle is flipped, none overlaps another, and the stretch is small."""
    unfolded = bool((signed_areas(uv[faces]) > 0).all())  # not finite counts as folded
    return unfolded and l2_stretch(vertices, uv, faces) < max_stretch and not _overlaps(uv, faces)


def _overlaps(uv: NDArray[np.float64], faces: NDArray[np.int32]) -> bool:
    grid, side = _to_raster(uv, len(faces))
    layers = np.zeros((side, side), np.uint8)
    count_layers(grid, faces, CHART_OVERLAP_MARGIN_TEXELS, layers)
    return bool((layers > 1).any())


def chart_scales(mesh: Mesh, cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """How much to enlarge each chart along one axis, so that its area fits the resolution of the photographs.

    The density of a chart is the median over the views that see it of pixels per surface area. The scale is relative to
    the median over the pixels of all views, and within a factor of DENSITY_MAX_RATIO of it. Charts that no view sees
    get the smallest scale.

    Returns:
        (charts,) factors.
    """
    label = chart_labels(mesh)
    charts = int(label.max()) + 1
    surface = mesh.face_areas()
    chosen = cameras[:: -(-len(cameras) // DENSITY_MAX_VIEWS)]
    counts, densities = np.stack([_view_density(mesh, camera, label, surface, charts) for camera in chosen], axis=1)
    seen = np.isfinite(densities).any(axis=0)
    if not seen.any():
        return np.ones(charts)
    density = np.full(charts, np.nan)
    density[seen] = np.nanmedian(densities[:, seen], axis=0)
    weight = counts.sum(axis=0)[seen]  # weights by surface would let a wide background dominate
    order = np.argsort(density[seen], kind="stable")
    mass = np.cumsum(weight[order])
    middle = density[seen][order][np.searchsorted(mass, mass[-1] / 2)]
    scale = np.sqrt(density / middle)
    return np.where(seen, np.clip(scale, 1 / DENSITY_MAX_RATIO, DENSITY_MAX_RATIO), 1 / DENSITY_MAX_RATIO)


def _view_density(
    mesh: Mesh, camera: Camera, label: NDArray[np.int32], surface: NDArray[np.float64], charts: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(charts,) pixels of each chart, and pixels per surface area over them; NaN where the view sees too little."""
    face = rasterise_view(mesh, camera).face
    pixels = np.bincount(face[face >= 0], minlength=len(mesh.faces))
    flat, depth = camera.project(mesh.vertices)
    corners = mesh.faces
    whole = (depth[corners] > 0).all(axis=1) & (pixels > 0)
    projected = np.zeros(len(corners))
    projected[whole] = np.abs(signed_areas(flat[corners[whole]]))
    usable = projected > 0
    spread = np.divide(surface, projected, out=np.zeros_like(surface), where=usable)  # surface per pixel
    count = np.bincount(label, (pixels * usable).astype(np.float64), charts)
    area = np.bincount(label, pixels * spread, charts)
    density = np.divide(count, area, out=np.full(charts, np.nan), where=(count >= DENSITY_MIN_PIXELS) & (area > 0))
    return np.asarray(count, np.float64), np.asarray(density, np.float64)
