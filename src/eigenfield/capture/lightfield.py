"""The light field: views whose photographs decode when they are asked for, one at a time."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.layout import GridLayout
from eigenfield.capture.photographs.decoded import PhotographSource, PixelSource, decode_with_mask, size_on_disk
from eigenfield.capture.photographs.kinds import is_linear
from eigenfield.capture.photographs.lens import Lens, remove_lens
from eigenfield.capture.photographs.read import read_header
from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError
from eigenfield.core.observations import Photograph


class StillCapture(ABC):
    """What `LightField` and `PhotoSet` share: photographs of one instant, each by a camera of its own."""

    @property
    @abstractmethod
    def sources(self) -> tuple[PhotographSource, ...]:
        """What each photograph is read from."""

    def __len__(self) -> int:
        return len(self.sources)

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(source.name for source in self.sources)

    @property
    def exposure(self) -> float | None:
        """The factor that the photographs of linear values have in common; None where there are none."""
        return next((source.exposure for source in self.sources if source.exposure is not None), None)

    def camera_of(self, index: int) -> int:
        """Each photograph has a camera of its own."""
        return index

    def time_of(self, index: int) -> int:
        """All photographs are of one instant."""
        return 0

    def bytes(self, index: int) -> int:
        """The size of the photograph's file on disk."""
        return size_on_disk(self.sources[index].path)


@dataclass(frozen=True, eq=False)
class View:
    """One photograph and its camera.

    Attributes:
        camera: The pinhole camera of the photograph after lens removal, at the photograph's own size.
        bounds: Nearest and farthest depth of the scene along z in world units, a hint, where the calibration states
            them.
    """

    name: str
    path: Path
    camera: Camera
    lens: Lens | None = None
    mask: Path | None = None
    upright: bool = True
    bounds: tuple[float, float] | None = None
    exposure: float | None = None
    reduction: int = 1
    picture: PixelSource | None = None

    __repr__ = brief_repr


@dataclass(frozen=True, eq=False)
class LightField(StillCapture):
    """A capture: photographs with one camera each. Each view is an observation, all of them of one instant.

    Attributes:
        root: The folder in which the photographs were searched.
        views: In the natural order of their names.
        problems: Lines for people: what was left out or corrected on reading.
        format: The reader's name ("transforms", "colmap", "hci", ...).
        layout: The array's grid, where the photographs' names state it too; None otherwise.
        origin: As of `CalibratedObservations`.
    """

    root: Path
    views: tuple[View, ...]
    problems: tuple[str, ...]
    format: str
    layout: GridLayout | None = None
    origin: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))

    __repr__ = brief_repr

    @property
    def cameras(self) -> tuple[Camera, ...]:
        return tuple(view.camera for view in self.views)

    @property
    def light_field(self) -> LightField:
        """The capture itself: its cameras are known. A `PhotoSet` has None here."""
        return self

    @property
    def sources(self) -> tuple[PhotographSource, ...]:
        return self.views

    @property
    def sizes(self) -> list[tuple[int, int]]:
        """(width, height) of each photograph."""
        return [(camera.width, camera.height) for camera in self.cameras]

    @property
    def lenses(self) -> tuple[tuple[str, tuple[float, ...]] | None, ...]:
        """Model and coefficients of the lens that is removed from each photograph; None where there is none."""
        lenses = (view.lens for view in self.views)
        return tuple(None if lens is None else (lens.model, tuple(lens.coefficients)) for lens in lenses)

    @property
    def as_stored(self) -> tuple[int, ...]:
        """Views whose photograph's EXIF orientation is not applied, although its size would be the same."""
        found = []
        for index, view in enumerate(self.views):
            with suppress(CaptureError):  # of a film, or damaged and masked out
                header = None if view.upright else read_header(view.path)
                if header is not None and header.orientation != 1 and header.upright_size == header.stored_size:
                    found.append(index)
        return tuple(found)

    @property
    def metres_per_unit(self) -> float | None:
        """1 where the capture's parameters were in metres; None if the scale is unknown."""
        return 1.0 if self.format == "hci" and self.layout is not None and self.layout.measured else None

    def photograph(self, index: int) -> Photograph:
        """Decode one photograph now; nothing is kept. May be called from any thread.

        Raises CaptureError (`image-missing`, `image-unreadable`, `image-truncated`, `image-kind`, `image-too-large`,
        `image-size`, `mask-size`, `mask-dark`) that names the file.
        """
        view = self.views[index]
        camera = view.camera
        pixels, mask = decode_with_mask(view, camera.width, camera.height)
        if view.lens is not None:
            try:
                pixels, mask = remove_lens(pixels, mask, camera.K, view.lens)
            except CaptureError as error:
                raise CaptureError(error.code, error.message, path=view.path, remedy=error.remedy) from None
        return Photograph.of(pixels, mask)

    def with_exposure(self, exposure: float) -> LightField:
        """The same capture with another factor of linear values."""
        views = (replace(view, exposure=exposure) if is_linear(view.path) else view for view in self.views)
        return replace(self, views=tuple(views))

    def reduced(self, factor: int) -> LightField:
        """The same capture with smaller photographs: a pixel is the mean of `factor` by `factor` pixels."""
        scale = np.diag([1 / factor, 1 / factor, 1.0])

        def smaller(view: View) -> View:
            camera = view.camera
            width, height = camera.width // factor, camera.height // factor
            small = replace(camera, K=scale @ camera.K, width=width, height=height)
            return replace(view, camera=small, reduction=view.reduction * factor)

        layout = None if self.layout is None else self.layout.reduced(factor)
        return replace(self, views=tuple(smaller(view) for view in self.views), layout=layout)

    def subset(self, indices: Iterable[int]) -> LightField:
        """The same capture with some of its views, in the order given."""
        chosen = list(indices)
        layout = None if self.layout is None else self.layout.subset(chosen)
        return replace(self, views=tuple(self.views[i] for i in chosen), layout=layout)

    def where_it_stood(self) -> LightField:
        """The capture in the world of its calibration's files; itself where nothing was moved."""
        if not self.origin.any():
            return self
        cameras = [replace(camera, t=camera.t - camera.R @ self.origin) for camera in self.cameras]
        return replace(self.with_cameras(cameras), origin=np.zeros(3))

    def with_cameras(
        self, cameras: Sequence[Camera], lenses: Sequence[Lens | None] | None = None, problems: Sequence[str] = ()
    ) -> LightField:
        """The same photographs with other cameras.

        Args:
            cameras: One for each photograph, in order.
            lenses: Distortion to remove from each photograph; None: the views' own.
            problems: Lines added to the capture's own.
        """
        lenses = [view.lens for view in self.views] if lenses is None else lenses
        views = tuple(
            replace(view, camera=camera, lens=lens)
            for view, camera, lens in zip(self.views, cameras, lenses, strict=True)
        )
        return replace(self, views=views, problems=(*self.problems, *problems))
