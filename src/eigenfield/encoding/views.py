"""Which photographs of a capture are encoded, and where their cameras stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture import Capture
from eigenfield.capture.holdout import held_out_cameras
from eigenfield.core.camera import Camera
from eigenfield.core.camera_names import named_camera
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import CalibratedObservations, Observations, cameras_of, select_cameras
from eigenfield.core.rig import Rig
from eigenfield.core.viewplane import find_grid, fit_view_plane
from eigenfield.encoding.options import EncodeOptions
from eigenfield.imaging.raster import rasterise_view
from eigenfield.reconstruction.array import looks_one_way
from eigenfield.rendering import delaunay_triangles

ODD_ENCODED_RATIO = 1 / 4  # of a grid's cameras, by --hold-out odd
REFERENCE_MAX_POINTS = 2000  # by which the scale of a view is measured
REFERENCE_SCALE_PERCENTILE = 25.0  # of the views' scales, which is that of the wider ones
REFERENCE_MAX_SCALE_RATIO = 1.5  # to it


@dataclass(frozen=True, eq=False)
class CaptureViews:
    """A capture, held-out photographs too, and its cameras as a file keeps them."""

    capture: CalibratedObservations
    rig: Rig

    def with_cameras(self, cameras: Sequence[Camera]) -> CaptureViews:
        """The same with other numbers for the same cameras."""
        rig = self.rig
        return CaptureViews(self.capture, make_rig(rig.names, cameras, rig.held_out, rig.reference))

    @cached_property
    def coordinates(self) -> NDArray[np.float64]:
        """(Nc, 2) of the cameras on the view plane."""
        return self.rig.view_plane.coordinates([camera.centre for camera in self.rig.cameras])

    @property
    def grid(self) -> NDArray[np.int64] | None:
        """(rows, columns) of the observations, where the encoded cameras stand on a grid; else None. -1 where the grid
        has no camera."""
        return grid_of(self.coordinates[self.rig.encoded])

    @cached_property
    def scattered(self) -> bool:
        """Whether the cameras, held-out ones too, neither look one way nor stand on a grid: few of them see a texel."""
        return not looks_one_way(self.rig.cameras) and grid_of(self.coordinates) is None

    @cached_property
    def observations(self) -> Observations:
        """Those of the encoded cameras, which are counted among themselves."""
        return select_cameras(self.capture, self.rig.encoded.tolist())

    def with_reference(self, reference: int) -> CaptureViews:
        """The same with another reference camera, by the index of an encoded one."""
        return CaptureViews(self.capture, replace(self.rig, reference=reference))

    @cached_property
    def taken_by(self) -> NDArray[np.int64]:
        """(No,) the camera of each of `observations`, whose rows of texture maps and weights these are."""
        return self.rig.encoded[cameras_of(self.observations)]

    def for_all_cameras(self, colours: NDArray[np.float32]) -> NDArray[np.float32]:
        """(Nc, 2, C) gains and offsets of all cameras, from those of `observations`: held-out ones have 1 and 0, since
        nothing of their photographs may be known."""
        found = np.zeros((len(self.rig.cameras), *colours.shape[1:]), np.float32)
        found[:, 0] = 1
        found[self.taken_by] = colours
        return found

    @property
    def observation_names(self) -> list[str]:
        """Of the cameras that took `observations`."""
        return [self.rig.names[index] for index in self.taken_by]


def make_rig(names: Sequence[str], cameras: Sequence[Camera], held_out: NDArray[np.bool_], reference: int) -> Rig:
    """The rig of these cameras, with the plane through them and the encoded ones' triangles on it."""
    plane = fit_view_plane(cameras)
    places = plane.coordinates([camera.centre for camera in cameras])
    return Rig(tuple(names), tuple(cameras), held_out, reference, plane, delaunay_triangles(places[~held_out]))


def select_views(capture: CalibratedObservations, options: EncodeOptions) -> CaptureViews:
    """The capture's cameras in float32, with those that the options hold out and their reference camera.

    Raises:
        OptionError: `hold-out` or `reference` for a rule or a name that does not fit the capture.
    """
    cameras = tuple(camera.to_float32() for camera in capture.cameras)
    places = fit_view_plane(cameras).coordinates([camera.centre for camera in cameras])
    held, reference = _held_and_reference(options, capture.names, places)
    return CaptureViews(capture, make_rig(capture.names, cameras, held, reference))


def usual_reference(views: CaptureViews, mesh: Mesh) -> int:
    """The encoded camera nearest the centre of those that see the scene, but not much larger than others do.

    What an atlas made for a close view holds, a wide view shows in so few pixels that it cannot determine it.
    """
    rig = views.rig
    few = mesh.vertices[:: max(1, len(mesh.vertices) // REFERENCE_MAX_POINTS)]
    scales = np.array([_pixels_per_unit(camera, few) for camera in rig.encoded_cameras])
    if not (scales > 0).any():
        return rig.reference
    usual = REFERENCE_MAX_SCALE_RATIO * float(np.percentile(scales[scales > 0], REFERENCE_SCALE_PERCENTILE))
    places = rig.view_plane.coordinates([camera.centre for camera in rig.encoded_cameras])
    distance = np.where((scales > 0) & (scales <= usual), np.linalg.norm(places, axis=1), np.inf)
    own = scales[rig.encoded_reference]
    # of a coarse mesh a camera may see triangles without their corners
    seen = own > 0 or (rasterise_view(mesh, rig.cameras[rig.reference]).face >= 0).any()
    return rig.reference if seen and own <= usual else int(rig.encoded[np.argmin(distance)])


def _pixels_per_unit(camera: Camera, points: NDArray[np.float32]) -> float:
    """Pixels of a unit of the scene at the median depth of what a camera sees of it; 0 where it sees nothing."""
    pixels, depth = camera.project(points)
    with np.errstate(invalid="ignore"):
        inside = (depth > 0) & (pixels >= 0).all(axis=1) & (pixels < (camera.width, camera.height)).all(axis=1)
    return float(np.sqrt(camera.K[0, 0] * camera.K[1, 1]) / np.median(depth[inside])) if inside.any() else 0.0


def check_selection(capture: Capture, options: EncodeOptions) -> None:
    """Raise OptionError for what `select_views` will refuse, before cameras and proxy are estimated."""
    _select_early(capture, options)


def encoded_ratio(capture: Capture, options: EncodeOptions) -> float:
    """The part of the photographs that is not held out, as far as it is known before cameras are estimated."""
    held = _select_early(capture, options)
    return ODD_ENCODED_RATIO if held is None else 1 - float(held.mean())


def _select_early(capture: Capture, options: EncodeOptions) -> NDArray[np.bool_] | None:
    """(Nc,) which cameras are held out; None where cameras that are not estimated decide."""
    if capture.light_field is not None:
        places = fit_view_plane(capture.cameras).coordinates([camera.centre for camera in capture.cameras])
    elif capture.layout is not None:
        places = np.stack([capture.layout.columns, capture.layout.rows], axis=1).astype(np.float64)
    elif options.hold_out == "odd":
        return None
    else:
        places = np.zeros((len(capture), 2))
    return _held_and_reference(options, capture.names, places)[0]


def grid_of(coordinates: NDArray[np.float64]) -> NDArray[np.int64] | None:
    """(rows, columns) of the points of `coordinates` (n, 2), where they stand on a grid; else None."""
    grid = find_grid(coordinates)
    return None if grid is None else grid.index.astype(np.int64)


def nothing_seen_error() -> CaptureError:
    """The error `nothing-seen` of a proxy that is in no photograph."""
    remedy = "bring mesh and cameras into one frame (`eigenfield inspect CAPTURE --proxy MESH --overlay overlay.png` "
    remedy += "shows both); look at the masks"
    return CaptureError("nothing-seen", "no camera sees any texel of the proxy", remedy=remedy)


def _held_and_reference(
    options: EncodeOptions, names: Sequence[str], places: NDArray[np.float64]
) -> tuple[NDArray[np.bool_], int]:
    """(Nc,) which cameras are held out, and the reference camera, of cameras at `places` (Nc, 2) of the view plane."""
    held, name = held_out_cameras(options.hold_out, names, places), options.reference
    encoded = np.flatnonzero(~held)
    if name is None:
        return held, int(encoded[np.argmin(np.linalg.norm(places[encoded], axis=1))])
    index = named_camera(name, names, "reference")
    if index not in encoded:
        raise OptionError("reference", f"{names[index]} is held out", remedy="name an encoded camera as --reference")
    return held, index
