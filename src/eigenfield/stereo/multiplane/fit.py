"""Fitted to photographs: a multiplane image, and soft sheets, which start from one of a smaller size."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.progress import Progress
from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.multiplane.descent import Descent, DescentTuning
from eigenfield.stereo.multiplane.drawing import inverse_view
from eigenfield.stereo.multiplane.image import MultiplaneImage
from eigenfield.stereo.multiplane.kernels import add_label_gradient, add_priors, move
from eigenfield.stereo.multiplane.pyramid import Pyramid
from eigenfield.stereo.multiplane.sheets import SoftSheets, sheets_of
from eigenfield.stereo.views import (
    Pictures,
    check_matrices,
    halve_pictures,
    halved_matrices,
    inside_pictures,
    pack_pictures,
    unpack_pictures,
)


@dataclass(frozen=True)
class MultiplaneTuning(DescentTuning):
    """Constants of `fit_multiplane`, found on Fern at 252x189.

    Attributes:
        start_error_ratio: A layer starts opaque where its photographs differ by so many times the least difference.
        start_opacity: Opacity there.
        start_haze: Opacity elsewhere.
        start_window_pixels: Window in which photographs are compared.
    """

    steps: int = 480
    levels: int = 7
    rate: float = 0.02
    colour_variation: float = 0.00045
    opacity_variation: float = 0.00125
    start_error_ratio: float = 1.15
    start_opacity: float = 0.9
    start_haze: float = 0.02
    start_window_pixels: int = 5


@dataclass(frozen=True)
class SheetTuning(DescentTuning):
    """Constants of `fit_sheets`, found on Fern at 504x378. Labels count in distances of the planes.

    Attributes:
        label_rate: Movement of a label in the first step.
        label_variation: Weight of the mean difference of neighbouring labels in a sheet, summed over sheets.
        label_huber_width: Difference of neighbours up to which its cost is quadratic.
    """

    steps: int = 240
    levels: int = 5
    rate: float = 0.01
    doubt_price: float = 0.001
    label_rate: float = 0.05
    label_variation: float = 0.01
    label_huber_width: float = 0.2


MULTIPLANE_TUNING = MultiplaneTuning()
SHEET_TUNING = SheetTuning()


def fit_multiplane(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    labels: NDArray[np.float64],
    *,
    tuning: MultiplaneTuning = MULTIPLANE_TUNING,
    progress: Progress | None = None,
) -> MultiplaneImage:
    """The multiplane image that draws V photographs best. Its farthest layer is opaque.

    Memory is about 90 bytes for a texel of each layer, and 16 for a pixel of each.

    Args:
        labels: (D,) at least two, ascending: the planes, back to front.

    Raises:
        ValueError: Pictures, matrices or labels are malformed.
    """
    packed, labels = pack_pictures(pictures), np.asarray(labels, np.float64)
    matrices = check_matrices(matrices, len(packed))
    if labels.ndim != 1 or len(labels) < 2 or not (np.diff(labels) > 0).all():
        raise ValueError("labels must be at least two, ascending")
    layers = start_layers(packed, matrices, shape, labels, tuning)
    Descent(labels, layers, tuning, len(packed)).run(packed, matrices, _ticker(progress, "planes", tuning.steps))
    return MultiplaneImage(labels, layers)


def fit_sheets(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    labels: NDArray[np.float64],
    counts: Sequence[int],
    *,
    halvings: int = 1,
    planes: MultiplaneTuning = MULTIPLANE_TUNING,
    tuning: SheetTuning = SHEET_TUNING,
    enough: Callable[[SoftSheets], bool] | None = None,
    progress: Progress | None = None,
) -> list[SoftSheets]:
    """The soft sheets that draw V photographs best, for each of some numbers of sheets.

    First planes are fitted at a small size, from which all start, then sheets at each larger one.

    Args:
        labels: (D,) ascending, at about equal distances: the planes, back to front.
        counts: Numbers of sheets, at most that of labels.
        halvings: How often the size is halved for the planes; with 0 sheets are fitted at the planes' size.
        enough: Called with the sheets of each number; after True the numbers that follow are left out.

    Raises:
        ValueError: As `fit_multiplane`; or a count is not from 1 to the number of labels.
    """
    for count in counts:
        if not 1 <= count <= np.size(labels):
            raise ValueError(f"{count} sheets of {np.size(labels)} planes")
    sizes = [(pack_pictures(pictures), check_matrices(matrices, len(pictures)), shape)]
    for _ in range(halvings):
        packed, views, (height, width) = sizes[-1]
        half = (height + 1) // 2, (width + 1) // 2
        sizes.append((halve_pictures(packed), halved_matrices(views), half))
    image = fit_multiplane(*sizes[-1], labels, tuning=planes, progress=progress)
    spacing = float(np.ptp(image.labels)) / (len(image.labels) - 1)
    rounds, found = sizes[: max(1, halvings)][::-1], []
    total, before = len(counts) * len(rounds) * tuning.steps, 0
    for count in counts:
        sheets = sheets_of(image, count)
        for packed, views, size in rounds:
            sheets = enlarged(sheets, size)
            _SheetDescent(sheets, spacing, tuning, len(packed)).run(
                packed, views, _ticker(progress, "sheets", total, before)
            )
            before += tuning.steps
        found.append(sheets)
        if enough is not None and enough(sheets):
            break
    if progress is not None and before < total:
        progress("sheets", total, total)
    return found


def enlarged(sheets: SoftSheets, shape: tuple[int, int]) -> SoftSheets:
    """The same sheets at another size."""
    size = shape[::-1]
    labels = np.stack([cv2.resize(one, size, interpolation=cv2.INTER_LINEAR) for one in sheets.labels])
    layers = np.stack([cv2.resize(one, size, interpolation=cv2.INTER_LINEAR) for one in sheets.layers])
    return SoftSheets(labels, layers)


def _ticker(progress: Progress | None, stage: str, total: int, before: int = 0) -> Callable[[int], None] | None:
    return None if progress is None else lambda done: progress(stage, before + done, total)


class _SheetDescent(Descent):
    """Of soft sheets: their layers, and their labels."""

    tuning: SheetTuning

    def __init__(self, sheets: SoftSheets, spacing: float, tuning: SheetTuning, views: int) -> None:
        """Prepare the first step.

        Args:
            sheets: Are changed in place.
            spacing: Distance of the planes, in labels.
        """
        super().__init__(sheets.labels, sheets.layers, tuning, views)
        self._spacing = spacing
        height, width = sheets.labels.shape[1:]
        self._label_pyramids = [Pyramid((height, width), 1, tuning.levels) for _ in sheets.labels]
        self._label_variation = np.full(width, tuning.label_variation / (spacing * height * width), np.float32)
        self._nothing, self._anything = np.zeros(width, np.float32), np.full(width, np.inf, np.float32)

    def _move(
        self,
        number: int,
        falling: float,
        scale: np.float32,
        rays: NDArray[np.float32],
        places: NDArray[np.float32],
        drawn: NDArray[np.float32],
        index: int,
    ) -> None:
        labels, pyramid, tuning = self.labels[index], self._label_pyramids[index], self.tuning
        step = pyramid.gradient[..., 0]
        add_label_gradient(drawn[index], places[index], self.layers[index], rays, step)  # of the layer as it was drawn
        super()._move(number, falling, scale, rays, places, drawn, index)
        narrow = np.float32(1 / (tuning.label_huber_width * self._spacing))
        add_priors(labels, 1, scale, self._label_variation, self._nothing, self._nothing, narrow, step)
        pyramid.step(number)
        rate = np.full(labels.shape[1], tuning.label_rate * self._spacing * falling, np.float32)
        move(labels, step, rate, -self._anything, self._anything)
        step[:] = 0


def plane_homographies(matrix: NDArray[np.float64], labels: NDArray[np.float64]) -> NDArray[np.float64]:
    """(D, 3, 3) from a view's index coordinates to those of the reference view, by the plane of each label."""
    base, slope = inverse_view(matrix)
    homographies = np.repeat(base[None], len(labels), axis=0)
    homographies[:, :2] += labels[:, None, None] * slope
    return homographies


def start_layers(
    pictures: NDArray[np.uint32],
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    labels: NDArray[np.float64],
    tuning: MultiplaneTuning = MULTIPLANE_TUNING,
) -> NDArray[np.float32]:
    """(D, h, w, 4): the mean of the photographs on each plane, opaque where they differ least among all planes."""
    codes, known = unpack_pictures(pictures), inside_pictures(pictures).view(np.uint8)
    homographies = np.stack([plane_homographies(matrix, labels) for matrix in matrices])

    def sweep(index: int) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
        total, squares = np.zeros((2, *shape, 3), np.float32)
        count = np.zeros(shape, np.float32)
        for view, pixels, homography in zip(codes, known, homographies[:, index], strict=True):
            size = shape[::-1]
            picture = cv2.warpPerspective(view, homography, size).astype(np.float32) / 255
            inside = cv2.warpPerspective(pixels, homography, size, flags=cv2.INTER_NEAREST)
            picture *= inside[..., None]
            total += picture
            squares += picture * picture
            count += inside
        mean = total / np.maximum(count, 1)[..., None]
        spread = np.maximum(squares / np.maximum(count, 1)[..., None] - mean * mean, 0).sum(axis=2)
        window = (tuning.start_window_pixels,) * 2
        return mean, np.asarray(cv2.blur(spread, window), np.float32) + (count < 2)

    layers, errors = np.empty((len(labels), *shape, 4), np.float32), np.empty((len(labels), *shape), np.float32)
    for index, (mean, error) in enumerate(parallel_map(sweep, range(len(labels)))):
        layers[index, ..., :3], errors[index] = mean, error
    near = errors <= tuning.start_error_ratio * errors.min(axis=0) + 1e-5
    layers[..., 3] = np.where(near, tuning.start_opacity, tuning.start_haze)
    return layers
