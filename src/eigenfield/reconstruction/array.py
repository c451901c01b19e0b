"""Arrays that look one way: cameras corrected together with depth, then a layered relief."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate import (
    PlanarArray,
    PlanarStart,
    refine_planar,
    register_views,
    start_given,
    start_planar,
)
from eigenfield.capture import Capture, LightField
from eigenfield.capture.holdout import held_out_cameras
from eigenfield.capture.writers.save import save_calibration
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError, ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
from eigenfield.core.viewplane import fit_view_plane
from eigenfield.proxy import (
    estimate_second_layer,
    read_mesh,
    relief_mesh,
    write_ply,
)
from eigenfield.reconstruction.frame import common_frame, read_masks, read_pictures, resized_cameras
from eigenfield.reconstruction.kept import (
    CAMERAS,
    DEPTH,
    MESH,
    ArrayDepth,
    read_cameras,
    read_planar,
    write_cameras,
    write_planar,
)
from eigenfield.reconstruction.run import Run, Settings
from eigenfield.stereo import depth_buffers, depth_range, mean_texture
from eigenfield.stereo.discontinuities import find_discontinuities
from eigenfield.stereo.extend import remove_speckles

log = logging.getLogger("eigenfield.reconstruction")

SPECK = 2e-4  # of the canvas: smaller pieces that stand apart in depth are taken for errors
CUT_ROUNDS = 4  # of making fewer cuts
CUT = 2.5  # pixels in the outermost view that two neighbours may slip apart before the relief is slit between them ..
CUT_SHARE = 0.06  # .. or this part of the range of depths: a small step in a deep scene is more often an error
TOLERANCE = 0.08  # pixels there that the mesh may leave the depth map
RANGE_VIEWS = 25  # round the central one, in which a range of depths is searched
FEWEST_POINTS = 30  # of structure from motion that say a range of depths
WIDENED = 0.15  # of that range, on both sides
STRANGE, STRANGE_LEAST = 2.0, 8.0  # times the typical difference from the others, and grey levels more: another scene
DENSE = 25  # given views from which on cameras are refined unless told otherwise
OFF_PLANE = 0.15  # of the array's extent that cameras may stand off their plane, for a relief
ALIKE = 12.0  # degrees between a camera's axis and the mean axis, for a relief
FACING = 25.0  # degrees between the mean axis and the normal of the array's plane, likewise


def looks_one_way(cameras: Sequence[Camera]) -> bool:
    """Whether cameras stand on a plane and look across it alike: a relief shows all that they see."""
    plane = fit_view_plane(cameras)
    axes = np.array([camera.R[2] for camera in cameras])
    mean = axes.mean(axis=0)
    if np.linalg.norm(mean) < 0.5:
        return False
    angles = np.degrees(np.arccos(np.clip(axes @ (mean / np.linalg.norm(mean)), -1, 1)))
    normal = np.cross(plane.right, plane.up)
    centres = np.array([camera.centre for camera in cameras]) - plane.origin
    along = np.degrees(np.arccos(min(1.0, abs(float(normal @ mean)) / float(np.linalg.norm(mean)))))
    thickness = float(np.abs(centres @ normal).max()) / float(np.linalg.norm(np.ptp(centres, axis=0)))
    return bool(angles.max() < ALIKE and thickness < OFF_PLANE and (along < FACING or plane.extent.min() == 0))


def relief_of_array(
    run: Run, capture: Capture, points: NDArray[np.float64] | None, identity: list[Any]
) -> tuple[LightField, Mesh, Path | None]:
    """Cameras and depth of an array together, then the layered relief."""
    refine = _refines(capture, run.settings)
    known = np.flatnonzero(~held_out_cameras(run.settings.blind, capture.names, _positions(capture)))
    inputs = [identity, refine, known.tolist(), None if points is None else len(points)]

    def build(folder: Path) -> None:
        pictures = read_pictures(capture)
        part = capture.subset(known)
        shown = pictures if len(known) == len(pictures) else pictures[known]
        start = _start(part, shown, points)
        planar = refine_planar(shown, start, exact=not refine, progress=run.progress)
        if len(known) < len(pictures):
            new = np.setdiff1d(np.arange(len(pictures)), known)
            bases = None if capture.light_field is None else resized_cameras(capture)
            positions = _positions(capture)[:, ::-1] if start.exchanged else _positions(capture)
            planar = register_views(planar, known, pictures[new], new, positions, bases)
        light_field = _light_field(capture, planar)
        save_calibration(light_field, folder / "calibration")
        write_cameras(folder / CAMERAS, capture, light_field, np.zeros((0, 3)))
        write_planar(folder / DEPTH, planar)

    folder = run.stage("array", inputs, build)
    light_field, _ = read_cameras(folder / CAMERAS, capture)

    def mesh(place: Path) -> None:
        pictures = read_pictures(capture)
        masks = read_masks(capture)
        depth = read_planar(folder / DEPTH)
        keep = np.intersect1d(known, [capture.names.index(name) for name in light_field.names])
        shown = None if masks is None else masks[keep]
        background = run.settings.background
        closed: list[Camera] = []
        if masks is None if background is None else background:
            closed = resized_cameras(light_field.subset([light_field.names.index(capture.names[i]) for i in keep]))
        layers = _layers(
            depth, pictures[keep], shown, depth.matrices[keep], run.settings.triangles, closed, run.progress
        )
        write_ply(layers, place / MESH)

    relief = run.stage("relief", [inputs, run.settings.triangles, run.settings.background], mesh)
    return light_field, read_mesh(relief / MESH), folder / "calibration"


def _layers(
    depth: ArrayDepth,
    pictures: NDArray[np.uint8],
    masks: NDArray[np.uint8] | None,
    matrices: NDArray[np.float64],
    triangles: int,
    cameras: Sequence[Camera] = (),
    progress: Progress | None = None,
) -> Mesh:
    """The layered relief of a depth map, closed for `cameras`. Where its cuts alone take more than `triangles`, the
    depth is a noisy one: fewer are made."""
    valid = cv2.dilate((depth.count > 0).astype(np.uint8), np.ones((9, 9), np.uint8)) > 0
    if masks is not None:
        valid &= _counts(masks, matrices, depth)
    reach = float(np.abs(matrices[:, :2, 2]).max())
    low, high = np.percentile(depth.d[depth.count > 0], [1, 99])
    cut, speck = max(CUT / reach, CUT_SHARE * float(high - low)), SPECK
    for _ in range(CUT_ROUNDS):
        d = remove_speckles(depth.d, find_discontinuities(depth.d, 1 / reach, cut), round(speck * depth.d.size))
        second = estimate_second_layer(pictures, matrices, d, valid, cut=cut, progress=progress)
        mesh = relief_mesh(
            depth.canvas, d, valid, second, cut=cut, tolerance=TOLERANCE / reach, triangles=triangles, cameras=cameras,
            progress=progress,
        )  # fmt: skip
        if len(mesh.faces) <= 1.1 * triangles:
            break
        cut, speck = 1.6 * cut, 2 * speck
    return mesh


def _counts(masks: NDArray[np.uint8], matrices: NDArray[np.float64], depth: ArrayDepth) -> NDArray[np.bool_]:
    """Where most of the views that see a point have it inside their masks."""
    buffers = depth_buffers(matrices, depth.d, masks.shape[1:3])
    share, _ = mean_texture(masks, matrices, depth.d, buffers)
    counts = share[..., 0] > 127
    if not counts.any():
        raise ProxyError(
            "surface-masked", "the masks hide every pixel", remedy="white counts, black is left out: invert the masks?"
        )
    return counts


def _refines(capture: Capture, settings: Settings) -> bool:
    if settings.refine is not None:
        return settings.refine
    if capture.layout is not None and capture.layout.exact:
        return False
    return capture.light_field is None or len(capture) >= DENSE


def _start(capture: Capture, pictures: NDArray[np.uint8], points: NDArray[np.float64] | None) -> PlanarStart:
    if capture.light_field is None:
        assert capture.layout is not None
        try:
            return start_planar(pictures, capture.layout, capture.names)
        except CaptureError as error:  # it knows of no files
            raise CaptureError(error.code, error.message, path=capture.root, remedy=error.remedy) from None
    cameras = resized_cameras(capture)
    low, high = _inverse_depths(capture, cameras, pictures, points)
    return start_given(cameras, low, high)


def _positions(capture: Capture) -> NDArray[np.float64]:
    """(n, 2) on the array's plane, any unit."""
    if capture.light_field is None:
        assert capture.layout is not None
        return capture.layout.positions
    return fit_view_plane(capture.cameras).coordinates([camera.centre for camera in capture.cameras])


def _light_field(capture: Capture, planar: PlanarArray) -> LightField:
    """The capture with the cameras that were found, at full size, without the views that fit nowhere."""
    views = np.arange(len(capture))
    cameras = planar.model.cameras(views, planar.parameters)
    error = planar.error
    typical = float(np.nanmedian(error))
    strange = ~(error <= max(STRANGE * typical, typical + STRANGE_LEAST))
    problems = [
        f"{capture.names[i]} is blurred, shows something else, or its camera was moved: it differs by {error[i]:.0f} "
        f"grey levels from the others (they by {typical:.0f}); left out"
        for i in np.flatnonzero(strange)
    ]
    keep = [int(i) for i in np.flatnonzero(~strange)]
    whole, small = common_frame(capture)
    grown = []
    for index in keep:
        K = np.diag([whole[0] / small[0], whole[1] / small[1], 1.0]) @ cameras[index].K
        grown.append(replace(cameras[index], K=K, width=capture.sizes[index][0], height=capture.sizes[index][1]))
    return capture.subset(keep).calibrated(grown, problems=problems)


def _inverse_depths(
    capture: LightField, cameras: Sequence[Camera], pictures: NDArray[np.uint8], points: NDArray[np.float64] | None
) -> tuple[float, float]:
    """The range of inverse depths seen from the camera in the middle, 1 / world units."""
    plane = fit_view_plane(cameras)
    middle = cameras[int(np.argmin(np.linalg.norm(plane.coordinates([c.centre for c in cameras]), axis=1)))]
    if points is not None and len(points) >= FEWEST_POINTS:
        pixels, depth = middle.project(points)
        inside = (depth > 0) & (pixels > 0).all(axis=1) & (pixels < (middle.width, middle.height)).all(axis=1)
        if inside.sum() >= FEWEST_POINTS:
            low, high = np.percentile(1 / depth[inside], [1, 99])
            return max(float(low - WIDENED * (high - low)), 0.3 * float(low)), float(high + WIDENED * (high - low))
    # disparities of one step, from infinity to a fifth of the picture
    provisional = start_given(cameras, *(1e-3, 1.0))
    canvas = provisional.model.reference_view(0)
    matrices = provisional.model.matrices(canvas, np.arange(len(cameras)), provisional.parameters)
    chosen = np.argsort(np.linalg.norm(provisional.places, axis=1), kind="stable")[:RANGE_VIEWS]
    found = depth_range(pictures[chosen], matrices[chosen], canvas.shape, (0.0, canvas.camera.width / 5))
    if found is None:
        raise CaptureError(
            "depth-nothing",
            "no depth agrees with the photographs and their cameras",
            path=capture.root,
            remedy="look at the calibration (eigenfield inspect), or let it be estimated: eigenfield calibrate",
        )
    return max(found[0], 0.02 * found[1]) * canvas.scale, found[1] * canvas.scale
