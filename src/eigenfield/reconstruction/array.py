"""Arrays with one viewing direction: joint refinement of cameras and depth, then a layered relief."""

from __future__ import annotations

import logging
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration import PlanarArray, PlanarStart, refine_planar, register_views, start_given, start_planar
from eigenfield.calibration.planar.joint import reference_margin, start_scale
from eigenfield.calibration.planar.start import resized_start
from eigenfield.capture import Capture, LightField
from eigenfield.capture.writers.save import save_calibration
from eigenfield.core.camera import Camera, axis_angles
from eigenfield.core.errors import CaptureError, ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.viewplane import fit_view_plane
from eigenfield.proxy import estimate_second_layer, read_mesh, relief_mesh, write_ply
from eigenfield.proxy.surface.neighbours import project_inside
from eigenfield.reconstruction.frame import (
    Size,
    common_frame,
    full_size_cameras,
    read_depth_pictures,
    read_masks,
    reduced,
    resized_cameras,
)
from eigenfield.reconstruction.options import SurfaceOptions
from eigenfield.reconstruction.run import StageRunner
from eigenfield.reconstruction.stage_files import (
    STAGE_CAMERAS_FILE,
    STAGE_DEPTH_FILE,
    STAGE_MESH_FILE,
    STAGE_WIDE_FILE,
    ArrayDepth,
    read_cameras,
    read_planar,
    write_cameras,
    write_planar,
)
from eigenfield.stereo import depth_buffers, depth_range, mean_texture
from eigenfield.stereo.discontinuities import find_discontinuities
from eigenfield.stereo.extend import remove_speckles
from eigenfield.stereo.views import Pictures, codes_of

log = logging.getLogger("eigenfield.reconstruction")


# Constants of `relief_of_array`. Pixels are those of the outermost view.
# regions of fewer pixels of the reference view that stand apart in depth count as errors
ARRAY_SPECKLE_FRACTION = 0.0002
ARRAY_CUT_ROUNDS = 4  # attempts to make fewer cuts
ARRAY_CUT_PIXELS = 2.5  # displacement between two neighbours at which the relief is cut between them
# the same as a fraction of the range of depths: a smaller step in a deep scene is more often an error
ARRAY_CUT_RANGE_FRACTION = 0.06
ARRAY_TOLERANCE_PIXELS = 0.08  # distance of the mesh from the depth map
ARRAY_RANGE_VIEWS = 25  # views around the central one in which a range of depths is searched
ARRAY_MIN_POINTS = 30  # points of structure from motion that determine a range of depths
ARRAY_RANGE_MARGIN_FRACTION = 0.15  # added to that range on both sides
ARRAY_DEPTH_PERCENTILES = (1.0, 99.0)  # of a depth map, that are its range
ARRAY_MIN_INVERSE_RATIO = 0.02  # of the farthest inverse depth to the nearest
ARRAY_OUTLIER_RATIO = 2.0  # a photograph whose error is this many times the typical one shows another scene
ARRAY_OUTLIER_MIN_LEVELS = 8.0  # grey levels by which its error is larger, at least
ARRAY_DENSE_VIEWS = 25  # number of given views from which cameras are refined by default
ARRAY_MAX_MARGIN_RATIO = 2  # of the parallax of the outermost camera, for a relief, to a photograph's longer side
ARRAY_MAX_THICKNESS_FRACTION = 0.15  # distance of cameras from their plane for a relief, relative to the array's extent
ARRAY_MAX_AXIS_ANGLE_DEGREES = 12.0  # angle between a camera's axis and the mean axis for a relief
ARRAY_MAX_PLANE_ANGLE_DEGREES = 25.0  # angle between the mean axis and the normal of the array's plane for a relief


def looks_one_way(cameras: Sequence[Camera]) -> bool:
    """Whether cameras stand on a plane and look across it in one direction: then a relief shows all that they see."""
    plane = fit_view_plane(cameras)
    axes = np.array([camera.R[2] for camera in cameras])
    mean = axes.mean(axis=0)
    if np.linalg.norm(mean) < 0.5:
        return False
    normal = np.cross(plane.right, plane.up)
    centres = np.array([camera.centre for camera in cameras]) - plane.origin
    along = np.degrees(np.arccos(min(1.0, abs(float(normal @ mean)) / float(np.linalg.norm(mean)))))
    thickness = float(np.abs(centres @ normal).max()) / float(np.linalg.norm(np.ptp(centres, axis=0)))
    return bool(
        axis_angles(cameras).max() < ARRAY_MAX_AXIS_ANGLE_DEGREES
        and thickness < ARRAY_MAX_THICKNESS_FRACTION
        and (along < ARRAY_MAX_PLANE_ANGLE_DEGREES or plane.extent.min() == 0)
    )


@dataclass(frozen=True, eq=False)
class AlignedArray:
    """Cameras and depth of an array.

    Attributes:
        light_field: Photographs and cameras, without outliers.
        shown: Indices in the capture of the photographs that take part.
        folder: Of the stage, with the depth map and the calibration.
    """

    light_field: LightField
    shown: NDArray[np.int64]
    folder: Path
    inputs: list[Any]

    def depth(self) -> ArrayDepth:
        """The depth map."""
        return read_planar(self.folder / STAGE_DEPTH_FILE)

    def taking_part(self, capture: Capture) -> LightField:
        """The photographs that take part, with their cameras."""
        return self.light_field.subset([self.light_field.names.index(capture.names[i]) for i in self.shown])


def align_array(
    run: StageRunner, capture: Capture, points: NDArray[np.float64] | None, blind: Collection[str] = ()
) -> AlignedArray | None:
    """Cameras and depth of an array; None: it is too wide for one view to show, and `auto` may make another surface.

    Args:
        capture: Photographs with cameras or a layout.
        points: (n, 3) points of structure from motion, if any.
        blind: Names of photographs that take no part: each only registers its own camera.
    """
    refine = _must_refine(capture, run.settings)
    known = np.flatnonzero([name not in blind for name in capture.names])
    inputs: list[Any] = [refine, known.tolist(), None if points is None else len(points)]
    must = run.settings.surface != "auto" or capture.light_field is None

    def read(size: Size) -> tuple[Pictures, Pictures]:
        pictures = read_depth_pictures(capture, size)
        return pictures, pictures if len(known) == len(pictures) else pictures[known]

    def build(folder: Path, must: bool) -> None:
        size = common_frame(capture)[1]
        pictures, shown = read(size)
        cameras = [] if capture.light_field is None else resized_cameras(capture, size)
        start = _start_array(capture.subset(known), shown, points, [cameras[i] for i in known if cameras])
        if reference_margin(start) > ARRAY_MAX_MARGIN_RATIO * max(size):
            (folder / STAGE_WIDE_FILE).touch()
            if not must:
                return
        scale = start_scale(start)
        if scale < 1:
            size = reduced(size, scale)
            log.info("depth: estimated at %d x %d pixels a photograph, to bound memory", *size)
            start = resized_start(start, size)
            pictures, shown = read(size)
        planar = refine_planar(shown, start, exact=not refine, progress=run.progress)
        if len(known) < len(pictures):
            new = np.setdiff1d(np.arange(len(pictures)), known)
            bases = None if capture.light_field is None else resized_cameras(capture, size)
            positions = array_positions(capture)[:, ::-1] if start.exchanged else array_positions(capture)
            planar = register_views(planar, known, pictures[new], new, positions, bases, exact=not refine)
        light_field = _light_field(capture, planar)
        save_calibration(light_field, folder / "calibration")
        write_cameras(folder / STAGE_CAMERAS_FILE, capture, light_field, np.zeros((0, 3)))
        write_planar(folder / STAGE_DEPTH_FILE, planar)

    folder = run.stage("array", inputs, partial(build, must=must))
    if (folder / STAGE_WIDE_FILE).exists():
        if not must:
            log.info("surface: from all sides, since near things move by over %d widths", ARRAY_MAX_MARGIN_RATIO)
            return None
        if not (folder / STAGE_DEPTH_FILE).exists():  # where `auto` has looked before
            inputs.append("wide")
            folder = run.stage("array", inputs, partial(build, must=True))
    light_field, _ = read_cameras(folder / STAGE_CAMERAS_FILE, capture)
    shown = np.intersect1d(known, [capture.names.index(name) for name in light_field.names])
    return AlignedArray(light_field, shown, folder, inputs)


def relief_of_array(run: StageRunner, capture: Capture, array: AlignedArray) -> Mesh:
    """The layered relief of an array, with an atlas."""

    def build(folder: Path) -> None:
        depth, keep = array.depth(), array.shown
        size = depth.reference.photograph_size
        pictures, masks = read_depth_pictures(capture, size), read_masks(capture, size)
        shown = None if masks is None else masks[keep]
        background = run.settings.background
        closed: list[Camera] = []
        if masks is None if background is None else background:
            closed = resized_cameras(array.taking_part(capture))
        layers = _layered_relief(run, depth, pictures[keep], shown, depth.matrices[keep], closed)
        write_ply(layers, folder / STAGE_MESH_FILE)

    relief = run.stage("relief", [array.inputs, run.settings.triangles, run.settings.background], build)
    return read_mesh(relief / STAGE_MESH_FILE)


def array_depths(array: AlignedArray) -> tuple[float, float]:
    """The range of inverse depths of an array, seen from its reference view, 1 / world unit."""
    depth = array.depth()
    low, high = np.percentile(depth.d[depth.count > 0], ARRAY_DEPTH_PERCENTILES)
    room = ARRAY_RANGE_MARGIN_FRACTION * (high - low)
    far, near = (depth.reference.offset + depth.reference.scale * label for label in (low - room, high + room))
    return max(far, ARRAY_MIN_INVERSE_RATIO * near), near


def _layered_relief(
    run: StageRunner,
    depth: ArrayDepth,
    pictures: Pictures,
    masks: Pictures | None,
    matrices: NDArray[np.float64],
    cameras: Sequence[Camera],
) -> Mesh:
    """The layered relief of a depth map, closed for `cameras`.

    If its cuts alone take more triangles than are allowed, the depth is noisy, and fewer cuts are made.
    """
    triangles = run.settings.triangles
    valid = cv2.dilate((depth.count > 0).astype(np.uint8), np.ones((9, 9), np.uint8)) > 0
    if masks is not None:
        valid &= _inside_masks(masks, matrices, depth)
    reach = float(np.abs(matrices[:, :2, 2]).max())
    low, high = np.percentile(depth.d[depth.count > 0], [1, 99])
    cut = max(ARRAY_CUT_PIXELS / reach, ARRAY_CUT_RANGE_FRACTION * float(high - low))
    speck = ARRAY_SPECKLE_FRACTION
    for _ in range(ARRAY_CUT_ROUNDS):
        d = remove_speckles(depth.d, find_discontinuities(depth.d, 1 / reach, cut), round(speck * depth.d.size))
        second = estimate_second_layer(pictures, matrices, d, valid, cut=cut, progress=run.progress)
        mesh = relief_mesh(
            depth.reference, d, valid, second, cut=cut, tolerance=ARRAY_TOLERANCE_PIXELS / reach,
            triangles=triangles, cameras=cameras, progress=run.progress,
        )  # fmt: skip
        if len(mesh.faces) <= 1.1 * triangles:
            break
        cut, speck = 1.6 * cut, 2 * speck
    return mesh


def _inside_masks(masks: Pictures, matrices: NDArray[np.float64], depth: ArrayDepth) -> NDArray[np.bool_]:
    """Where most of the views that see a point have it inside their masks."""
    buffers = depth_buffers(matrices, depth.d, masks.shape[1:3])
    share, _ = mean_texture(masks, matrices, depth.d, buffers)
    counts = share[..., 0] > 127
    if not counts.any():
        raise ProxyError(
            "surface-masked", "the masks hide every pixel", remedy="white counts, black is left out: invert the masks?"
        )
    return counts


def _must_refine(capture: Capture, settings: SurfaceOptions) -> bool:
    if settings.refine is not None:
        return settings.refine
    if capture.layout is not None and capture.layout.exact:
        return False
    return capture.light_field is None or len(capture) >= ARRAY_DENSE_VIEWS


def _start_array(
    capture: Capture, pictures: Pictures, points: NDArray[np.float64] | None, cameras: Sequence[Camera]
) -> PlanarStart:
    if capture.light_field is None:
        assert capture.layout is not None
        try:
            return start_planar(codes_of(pictures), capture.layout, capture.names)
        except CaptureError as error:  # it does not know the path
            raise CaptureError(error.code, error.message, path=capture.root, remedy=error.remedy) from None
    low, high = inverse_depths(capture, cameras, pictures, points)
    return start_given(cameras, low, high)


def array_positions(capture: Capture) -> NDArray[np.float64]:
    """(n, 2) positions on the array's plane, in any unit."""
    if capture.light_field is None:
        assert capture.layout is not None
        return capture.layout.positions
    return fit_view_plane(capture.cameras).coordinates([camera.centre for camera in capture.cameras])


def _light_field(capture: Capture, planar: PlanarArray) -> LightField:
    """The capture with the estimated cameras at full size, without outliers."""
    views = np.arange(len(capture))
    cameras = planar.model.cameras(views, planar.parameters)
    error = planar.error
    typical = float(np.nanmedian(error))
    is_outlier = ~(error <= max(ARRAY_OUTLIER_RATIO * typical, typical + ARRAY_OUTLIER_MIN_LEVELS))
    problems = [
        f"{capture.names[i]} is blurred, shows something else, or its camera was moved: it differs by {error[i]:.0f} "
        f"grey levels from the others (they by {typical:.0f}); left out"
        for i in np.flatnonzero(is_outlier)
    ]
    keep = [int(i) for i in np.flatnonzero(~is_outlier)]
    full_size = full_size_cameras(capture, cameras, planar.reference.photograph_size)
    return capture.subset(keep).with_cameras([full_size[index] for index in keep], problems=problems)


def inverse_depths(
    capture: LightField, cameras: Sequence[Camera], pictures: Pictures, points: NDArray[np.float64] | None
) -> tuple[float, float]:
    """The range of inverse depths seen from the central camera, 1 / world unit.

    Args:
        cameras: Their cameras, at the size of the pictures.
        pictures: (n, H, W, 3) the photographs, or packed.
        points: (n, 3) points of structure from motion, if any.
    """
    plane = fit_view_plane(cameras)
    middle = cameras[int(np.argmin(np.linalg.norm(plane.coordinates([c.centre for c in cameras]), axis=1)))]
    if points is not None and len(points) >= ARRAY_MIN_POINTS:
        _, depth, inside = project_inside(middle, points)
        if inside.sum() >= ARRAY_MIN_POINTS:
            low, high = np.percentile(1 / depth[inside], [1, 99])
            room = ARRAY_RANGE_MARGIN_FRACTION * (high - low)
            return max(float(low - room), 0.3 * float(low)), float(high + room)
    # disparities of one step, from infinity to a fifth of the picture
    provisional = start_given(cameras, 1e-3, 1.0)
    reference = provisional.model.reference_view(0)
    matrices = provisional.model.matrices(reference, np.arange(len(cameras)), provisional.parameters)
    chosen = np.argsort(np.linalg.norm(provisional.places, axis=1), kind="stable")[:ARRAY_RANGE_VIEWS]
    label_range = depth_range(pictures[chosen], matrices[chosen], reference.shape, (0.0, reference.camera.width / 5))
    if label_range is None:
        raise CaptureError(
            "depth-nothing",
            "no depth agrees with the photographs and their cameras",
            path=capture.root,
            remedy="look at the calibration (`eigenfield inspect CAPTURE`), or let it be estimated: "
            "`eigenfield calibrate CAPTURE`",
        )
    return max(label_range[0], ARRAY_MIN_INVERSE_RATIO * label_range[1]) * reference.scale, label_range[
        1
    ] * reference.scale
