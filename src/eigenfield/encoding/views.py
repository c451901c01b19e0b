"""Which photographs of a capture are encoded, and where their cameras stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture import Capture, LightField
from eigenfield.capture.holdout import held_out_cameras
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.observations import Observations, cameras_of, of_cameras
from eigenfield.core.viewplane import ViewPlane, find_grid, fit_view_plane
from eigenfield.encoding.options import EncodeOptions


@dataclass(frozen=True, eq=False)
class CaptureViews:
    """A capture's cameras as a file keeps them, and which of them are encoded.

    Attributes:
        capture: The photographs, held-out ones too.
        cameras: All Nc, in the capture's order.
        held_out: (Nc,) bool.
        reference: Index of the reference camera, which is an encoded one.
    """

    capture: LightField
    cameras: tuple[Camera, ...]
    held_out: NDArray[np.bool_]
    reference: int

    @cached_property
    def view_plane(self) -> ViewPlane:
        return fit_view_plane(self.cameras)

    @cached_property
    def coordinates(self) -> NDArray[np.float64]:
        """(Nc, 2) of the cameras on the view plane."""
        return self.view_plane.coordinates([camera.centre for camera in self.cameras])

    @cached_property
    def encoded(self) -> NDArray[np.int64]:
        """(Ne,) indices of the cameras whose photographs count."""
        return np.flatnonzero(~self.held_out)

    @property
    def encoded_cameras(self) -> list[Camera]:
        return [self.cameras[index] for index in self.encoded]

    @property
    def encoded_reference(self) -> int:
        """The reference camera, counted among the encoded ones."""
        return int(np.searchsorted(self.encoded, self.reference))

    @property
    def grid(self) -> NDArray[np.int64] | None:
        """(rows, columns) of the encoded cameras, counted among themselves, where they stand on a grid; else None."""
        return grid_of(self.coordinates[self.encoded])

    @cached_property
    def observations(self) -> Observations:
        """Those of the encoded cameras, which are counted among themselves."""
        return of_cameras(self.capture, self.encoded.tolist())

    @cached_property
    def taken_by(self) -> NDArray[np.int64]:
        """(No,) the camera of each of `observations`, whose rows of texture maps and weights these are."""
        return self.encoded[cameras_of(self.observations)]

    @property
    def observation_names(self) -> list[str]:
        """Of the cameras that took `observations`."""
        return [self.capture.names[index] for index in self.taken_by]


def select_views(capture: LightField, options: EncodeOptions) -> CaptureViews:
    """The capture's cameras in float32, with those that the options hold out and their reference camera.

    Raises:
        OptionError: `hold-out` or `reference` for a rule or a name that does not fit the capture.
    """
    cameras = tuple(view.camera.rounded() for view in capture.views)
    places = fit_view_plane(cameras).coordinates([camera.centre for camera in cameras])
    held = held_out_cameras(options.hold_out, capture.names, places)
    return CaptureViews(capture, cameras, held, _reference(options.reference, capture.names, places, held))


def check_selection(capture: Capture, options: EncodeOptions) -> None:
    """Raise OptionError for what `select_views` will refuse, before cameras and proxy are estimated."""
    if capture.light_field is not None:
        places = fit_view_plane(capture.cameras).coordinates([camera.centre for camera in capture.cameras])
    elif capture.layout is not None:
        places = np.stack([capture.layout.columns, capture.layout.rows], axis=1).astype(np.float64)
    elif options.hold_out == "odd":
        return  # cameras will tell
    else:
        places = np.zeros((len(capture), 2))
    held = held_out_cameras(options.hold_out, capture.names, places)
    _reference(options.reference, capture.names, places, held)


def grid_of(coordinates: NDArray[np.float64]) -> NDArray[np.int64] | None:
    """(rows, columns) of the points of `coordinates` (n, 2), where they stand on a grid; else None."""
    grid = find_grid(coordinates)
    return None if grid is None else grid.index.astype(np.int64)


def _reference(
    name: str | None, names: Sequence[str], coordinates: NDArray[np.float64], held_out: NDArray[np.bool_]
) -> int:
    encoded = np.flatnonzero(~held_out)
    if name is None:
        return int(encoded[np.argmin(np.linalg.norm(coordinates[encoded], axis=1))])
    if name not in names:
        raise OptionError("reference", f"no camera is called {name}", remedy="eigenfield inspect lists the names")
    index = names.index(name)
    if index not in encoded:
        raise OptionError("reference", f"{name} is held out", remedy="name an encoded camera as --reference")
    return index
