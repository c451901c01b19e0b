"""Charts laid out anew: least-squares conformal, each as large as the photographs see it."""

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
from eigenfield.proxy.atlas.chart_merging import Chart, merged_charts
from eigenfield.proxy.atlas.kernels import claim_texels, count_layers
from eigenfield.proxy.atlas.layout import chart_labels, l2_stretch
from eigenfield.proxy.atlas.lscm import conformal_map
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.proxy")

WORSE = 1.0  # times the stretch of the layout that there is: a map with more is not taken
MOST_STRETCH = 3.0  # of a chart: beyond it is halved
JOINED_STRETCH = 1.03  # of charts that were joined: beyond they stay apart
OVERLAP_SIDE = 256  # raster on which a chart is tested for overlaps, at least; more for more triangles
OVERLAP_MARGIN = 0.05  # texels of that raster
MOST_VIEWS = 64  # that density is measured in
FEWEST_PIXELS = 16  # of a chart that a view must see
UNEVEN = 8.0  # times denser or coarser than the median, along one axis: no chart is more


def conformal_charts(mesh: Mesh) -> Mesh:
    """Every chart of a mesh with UVs laid out by `conformal_map`, at the area of its surface.

    A chart hangs together by edges: at a single vertex the map could turn and shrink one side freely. Where the map
    folds, overlaps or stretches more than the mesh's own UVs, those are kept (at the same area). Where those fold or
    overlap as well, the triangles that do are cut out. Then small charts join others (`merged_charts`). The UVs of the
    result lie over each other, charts are to be packed; its faces keep their order.
    """
    assert mesh.uv is not None
    groups = _grouped(np.arange(len(mesh.faces)), edge_components(mesh.faces))
    cut = [chart for group in parallel_map(lambda faces: _laid_out(mesh, faces), groups) for chart in group]
    charts = merged_charts(mesh, cut, _together)
    log.info(
        "atlas: %d charts of %d, %d least-squares conformal", len(charts), len(cut), sum(c.conformal for c in charts)
    )
    starts = np.cumsum([0, *(len(chart.vertices) for chart in charts[:-1])])
    faces = np.empty_like(mesh.faces)
    for chart, start in zip(charts, starts, strict=True):
        faces[chart.faces] = chart.corners + start
    vertices = mesh.vertices[np.concatenate([chart.vertices for chart in charts])]
    return Mesh(vertices, faces, np.concatenate([chart.uv for chart in charts]).astype(np.float32))


def _laid_out(mesh: Mesh, chart: NDArray[np.int64]) -> list[Chart]:
    assert mesh.uv is not None
    done, waiting = [], [chart]
    while waiting:
        faces = waiting.pop()
        used, index = np.unique(mesh.faces[faces], return_inverse=True)
        corners = index.reshape(-1, 3).astype(np.int32)
        points = mesh.vertices[used].astype(np.float64)
        uv, conformal = _layout(points, corners, mesh.uv[used].astype(np.float64))
        if len(faces) > 1 and not _sound(uv, points, corners):
            waiting += _without_overlaps(uv, corners, faces) or _halves(points, corners, faces)
        else:
            done.append(Chart(faces, used.astype(np.int64), corners, uv - uv.min(axis=0), conformal))
    return done


def _without_overlaps(
    uv: NDArray[np.float64], corners: NDArray[np.int32], faces: NDArray[np.int64]
) -> list[NDArray[np.int64]]:
    """The chart grown from its largest triangle over all that lie on no other, and what is left, in pieces that hang
    together; nothing if overlaps are not what is wrong."""
    area = signed_areas(uv[corners])
    if not (area > 0).all():
        return []
    one, other = edge_links(corners)
    links = coo_array((np.ones(len(one), np.int8), (one, other)), shape=(len(corners), len(corners)))
    order = breadth_first_order(links, int(np.argmax(area)), directed=False, return_predecessors=False)
    grid, side = _on_raster(uv, len(corners))
    claimed = np.zeros(len(corners), np.bool_)
    claim_texels(grid, corners, order.astype(np.int64), OVERLAP_MARGIN, np.zeros((side, side), np.uint8), claimed)
    if claimed.all():
        return []
    return [piece for part in (claimed, ~claimed) for piece in _grouped(faces[part], edge_components(corners[part]))]


def _on_raster(uv: NDArray[np.float64], triangles: int) -> tuple[NDArray[np.float64], int]:
    """A layout in texels of a raster to look for overlaps on, and the side of the raster."""
    side = OVERLAP_SIDE + int(8 * np.sqrt(triangles))
    low = uv.min(axis=0)
    return (uv - low) * (side / max(float((uv.max(axis=0) - low).max()), 1e-300)), side


def _halves(
    points: NDArray[np.float64], corners: NDArray[np.int32], faces: NDArray[np.int64]
) -> list[NDArray[np.int64]]:
    """The triangles on either side of the middle of the chart's longest direction, as pieces that hang together."""
    middle = points[corners].mean(axis=1)
    middle = middle - middle.mean(axis=0)
    axis = np.linalg.svd(middle, full_matrices=False)[2][0]
    rank = np.argsort(np.argsort(middle @ axis * np.sign(axis[np.argmax(np.abs(axis))]), kind="stable"))
    result = []
    for half in (rank < len(faces) // 2, rank >= len(faces) // 2):
        result += _grouped(faces[half], edge_components(corners[half]))
    return result


def _grouped(faces: NDArray[np.int64], label: NDArray[np.int32]) -> list[NDArray[np.int64]]:
    order = np.argsort(label, kind="stable")
    return np.split(faces[order], np.cumsum(np.bincount(label))[:-1])


def _layout(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], given: NDArray[np.float64]
) -> tuple[NDArray[np.float64], bool]:
    """The layout of one chart, and whether it is our own."""
    old = _scaled(given, vertices, faces)
    try:
        uv = conformal_map(vertices, faces)
    except RuntimeError:  # the factorisation met an exactly singular matrix
        return old, False
    if not _sound(uv, vertices, faces):
        return old, False
    if _sound(old, vertices, faces) and l2_stretch(vertices, uv, faces) > WORSE * l2_stretch(vertices, old, faces):
        return old, False
    return uv, True


def _together(points: NDArray[np.float64], corners: NDArray[np.int32]) -> NDArray[np.float64] | None:
    """The layout of charts that were joined, unless it is none or stretches much."""
    try:
        uv = conformal_map(points, corners)
    except RuntimeError:  # as in `_layout`
        return None
    return uv if _sound(uv, points, corners, JOINED_STRETCH) else None


def _scaled(uv: NDArray[np.float64], vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """At the area of the surface, and of positive area on the whole."""
    area = float(signed_areas(uv[faces]).sum())
    factor = np.sqrt(triangle_areas(vertices[faces]).sum() / abs(area)) if area != 0 else 1.0
    return np.asarray(uv * (factor, -factor if area < 0 else factor))


def _sound(
    uv: NDArray[np.float64], vertices: NDArray[np.float64], faces: NDArray[np.int32], most: float = MOST_STRETCH
) -> bool:
    """No triangle turned over, none over another, and not shrunk beyond use anywhere."""
    return not _folds(uv, faces) and l2_stretch(vertices, uv, faces) < most and not _overlaps(uv, faces)


def _folds(uv: NDArray[np.float64], faces: NDArray[np.int32]) -> bool:
    return not bool((signed_areas(uv[faces]) > 0).all())  # not finite counts as folded


def _overlaps(uv: NDArray[np.float64], faces: NDArray[np.int32]) -> bool:
    grid, side = _on_raster(uv, len(faces))
    layers = np.zeros((side, side), np.uint8)
    count_layers(grid, faces, OVERLAP_MARGIN, layers)
    return bool((layers > 1).any())


def chart_scales(mesh: Mesh, cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """(charts,) how much to enlarge each chart, along one axis, so that its area is in proportion to the density at
    which photographs see it: the median over the views that see it of pixels per surface area.

    Relative to the median over the pixels of all views, and within a factor of UNEVEN of it; charts that no view sees
    get the least.
    """
    label = chart_labels(mesh)
    charts = int(label.max()) + 1
    surface = mesh.face_areas()
    chosen = cameras[:: -(-len(cameras) // MOST_VIEWS)]
    counts, densities = np.stack([_density(mesh, camera, label, surface, charts) for camera in chosen], axis=1)
    seen = np.isfinite(densities).any(axis=0)
    if not seen.any():
        return np.ones(charts)
    density = np.full(charts, np.nan)
    density[seen] = np.nanmedian(densities[:, seen], axis=0)
    weight = counts.sum(axis=0)[seen]  # by surface, a wide background would set the measure for what is before it
    order = np.argsort(density[seen], kind="stable")
    mass = np.cumsum(weight[order])
    middle = density[seen][order][np.searchsorted(mass, mass[-1] / 2)]
    scale = np.sqrt(density / middle)
    return np.where(seen, np.clip(scale, 1 / UNEVEN, UNEVEN), 1 / UNEVEN)


def _density(
    mesh: Mesh, camera: Camera, label: NDArray[np.int32], surface: NDArray[np.float64], charts: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(charts,) pixels of each chart, and pixels per surface area over them, NaN where the view sees too little."""
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
    density = np.divide(count, area, out=np.full(charts, np.nan), where=(count >= FEWEST_PIXELS) & (area > 0))
    return np.asarray(count, np.float64), np.asarray(density, np.float64)
