"""Photographs whose cameras are not known yet, with the array's grid according to names and metadata."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from eigenfield.capture.layout import GridLayout
from eigenfield.capture.lightfield import LightField, StillCapture, View
from eigenfield.capture.photographs.decoded import PhotographSource, PixelSource, decode_with_mask
from eigenfield.capture.photographs.kinds import is_linear
from eigenfield.capture.photographs.lens import Lens
from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera
from eigenfield.core.observations import Photograph

UNPACKED_FORMATS = ("video", "walk", "quilt", "eslf", "array")  # whose photographs are taken out of other files


@dataclass(frozen=True)
class Shot:
    """One photograph without a camera.

    Attributes:
        width: Of the picture as it is decoded, pixels.
        focal: Focal length in pixels, where EXIF or the format states it; None otherwise.
    """

    name: str
    path: Path
    width: int
    height: int
    focal: float | None = None
    mask: Path | None = None
    upright: bool = True
    exposure: float | None = None
    reduction: int = 1
    picture: PixelSource | None = None

    @staticmethod
    def of(view: View) -> Shot:
        """The photograph of a view, without what is known of its camera."""
        camera = view.camera
        return Shot(
            view.name, view.path, camera.width, camera.height,
            mask=view.mask, upright=view.upright, exposure=view.exposure, reduction=view.reduction,
            picture=view.picture,
        )  # fmt: skip

    @property
    def lens(self) -> Lens | None:
        """None: a lens becomes known together with the camera."""
        return None


@dataclass(frozen=True, eq=False)
class PhotoSet(StillCapture):
    """Photographs of one scene without cameras. Each is an observation, all of them of one instant.

    Attributes:
        root: The folder they were found in.
        shots: In the natural order of their names.
        layout: The array's grid; None for a folder of photographs of which nothing is known.
        problems: Lines for people.
        format: The reader's name ("stanford", "grid", "folder", ...).
    """

    root: Path
    shots: tuple[Shot, ...]
    layout: GridLayout | None
    problems: tuple[str, ...]
    format: str

    __repr__ = brief_repr

    @property
    def light_field(self) -> None:
        """None: the cameras are not known. A `LightField` has itself here."""
        return None

    @property
    def sources(self) -> tuple[PhotographSource, ...]:
        return self.shots

    @property
    def sizes(self) -> list[tuple[int, int]]:
        """(width, height) of each photograph."""
        return [(shot.width, shot.height) for shot in self.shots]

    def photograph(self, index: int) -> Photograph:
        """Decode one photograph now, its lens as it is; nothing is kept. May be called from any thread.

        Raises CaptureError as `LightField.photograph` does.
        """
        shot = self.shots[index]
        return Photograph.of(*decode_with_mask(shot, shot.width, shot.height))

    def with_exposure(self, exposure: float) -> PhotoSet:
        """The same set with another factor of linear values."""
        shots = (replace(shot, exposure=exposure) if is_linear(shot.path) else shot for shot in self.shots)
        return replace(self, shots=tuple(shots))

    def reduced(self, factor: int) -> PhotoSet:
        """The same set with smaller photographs: a pixel is the mean of `factor` by `factor` pixels."""

        def smaller(shot: Shot) -> Shot:
            focal = None if shot.focal is None else shot.focal / factor
            width, height = shot.width // factor, shot.height // factor
            return replace(shot, width=width, height=height, focal=focal, reduction=shot.reduction * factor)

        layout = None if self.layout is None else self.layout.reduced(factor)
        return replace(self, shots=tuple(smaller(shot) for shot in self.shots), layout=layout)

    def subset(self, indices: Iterable[int]) -> PhotoSet:
        """The same set with some of its shots, in the order given."""
        chosen = list(indices)
        layout = None if self.layout is None else self.layout.subset(chosen)
        return replace(self, shots=tuple(self.shots[i] for i in chosen), layout=layout)

    def with_cameras(
        self, cameras: Sequence[Camera], lenses: Sequence[Lens | None] | None = None, problems: Sequence[str] = ()
    ) -> LightField:
        """The light field of these photographs.

        Args:
            cameras: One for each photograph, in order.
            lenses: Distortion to remove from each photograph; None: none from any.
            problems: Lines added to the set's own.
        """
        lenses = [None] * len(self.shots) if lenses is None else lenses
        views = tuple(
            View(
                shot.name,
                shot.path,
                camera,
                lens,
                shot.mask,
                shot.upright,
                exposure=shot.exposure,
                reduction=shot.reduction,
                picture=shot.picture,
            )
            for shot, camera, lens in zip(self.shots, cameras, lenses, strict=True)
        )
        return LightField(self.root, views, (*self.problems, *problems), self.format, self.layout)


Capture = LightField | PhotoSet
