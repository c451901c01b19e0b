"""All photographs of a capture at one size, with their masks and cameras."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from eigenfield.calibration.harm import HARM_EXPOSURE_MAX_PART, HARM_EXPOSURE_STOPS
from eigenfield.capture import Capture, LightField
from eigenfield.capture.photographs.colour import encode_srgb
from eigenfield.capture.photographs.decoded import decode_with_mask
from eigenfield.capture.photographs.read import read_header
from eigenfield.core.camera import Camera
from eigenfield.core.observations import Photograph
from eigenfield.imaging.colour import linear_of_srgb
from eigenfield.runtime.parallel import parallel_map, parallel_stream
from eigenfield.stereo.views import Pictures, codes_of, mark_outside

FRAME_MAX_TOTAL_PIXELS = 120_000_000  # of all photographs together; larger captures are reduced for depth estimation
FRAME_MAX_PIXELS = 16_000_000  # likewise of one
FRAME_EXPOSURE_QUANTILE = 0.75  # of all photographs' brightness, which the others get: dark ones lose less than bright
FRAME_DARKEST_CODE = 4  # a darker median says nothing about exposure
ALPHA_UNKNOWN_FORMATS = ("JPEG XL", "TIFF")  # whose headers may say nothing of alpha

Size = tuple[int, int]  # (width, height) in pixels


def common_frame(capture: Capture, size: Size | None = None) -> tuple[Size, Size]:
    """(width, height) that holds every photograph, and to what it is reduced.

    Args:
        size: The reduced one, here and in the functions below; None: that which keeps each photograph within
            FRAME_MAX_PIXELS, and all together within FRAME_MAX_TOTAL_PIXELS.
    """
    width, height = (max(side) for side in zip(*capture.sizes, strict=True))
    most = min(FRAME_MAX_PIXELS, FRAME_MAX_TOTAL_PIXELS / len(capture.sizes))
    return (width, height), size or reduced((width, height), min(1.0, (most / (width * height)) ** 0.5))


def reduced(size: Size, scale: float) -> Size:
    """(width, height) at another scale, at least two pixels each."""
    return max(2, round(scale * size[0])), max(2, round(scale * size[1]))


def _corner(size: Size, whole: Size) -> tuple[int, int]:
    """(x, y) in the frame at which a photograph begins: it lies in the middle."""
    return (whole[0] - size[0]) // 2, (whole[1] - size[1]) // 2


def frame_places(capture: Capture, size: Size | None = None) -> list[tuple[slice, slice]]:
    """Rows and columns of each photograph in the common frame, reduced, with those that it fills in part."""
    whole, small = common_frame(capture, size)

    def place(begin: int, side: int, axis: int) -> slice:
        return slice(begin * small[axis] // whole[axis], -(-(begin + side) * small[axis] // whole[axis]))

    corners = [_corner(one, whole) for one in capture.sizes]
    return [(place(y, one[1], 1), place(x, one[0], 0)) for (x, y), one in zip(corners, capture.sizes, strict=True)]


def _fit_to_frame(picture: NDArray[Any], whole: Size, small: Size) -> NDArray[np.uint8]:
    """A photograph in the middle of the common frame, to which its edges go on, reduced."""
    height, width = picture.shape[:2]
    if (width, height) != whole:
        left, top = _corner((width, height), whole)
        sides = ((top, whole[1] - height - top), (left, whole[0] - width - left), (0, 0))[: picture.ndim]
        picture = np.pad(picture, sides, mode="edge")
    if small != whole:
        picture = cv2.resize(picture, small, interpolation=cv2.INTER_AREA)
    return np.asarray(picture, np.uint8)


def read_pictures(capture: Capture, size: Size | None = None) -> NDArray[np.uint8]:
    """(n, H, W, 3) uint8 photographs without lens distortion, in their common frame and about one exposure.

    The edges of those smaller than the frame go on beyond them (`read_depth_pictures`). The cameras look about one way
    and show about the same. So exposures follow from the photographs' medians.
    """
    whole, small = common_frame(capture, size)
    result = np.empty((len(capture), small[1], small[0], 3), np.uint8)

    def fill(index: int) -> None:
        result[index] = _fit_to_frame(np.rint(capture.photograph(index).pixels * 255).astype(np.uint8), whole, small)

    parallel_map(fill, range(len(capture)))
    _level_exposures(result, frame_places(capture, size))
    return result


def read_depth_pictures(capture: Capture, size: Size | None = None) -> Pictures:
    """As `read_pictures`, for the depth search: packed, if any photograph is smaller than the frame."""
    return mark_outside(read_pictures(capture, size), frame_places(capture, size))


def _level_exposures(pictures: NDArray[np.uint8], places: Sequence[tuple[slice, slice]]) -> None:
    """Bring photographs whose exposure is far from the others' to theirs, in place.

    A few are exceptions: they stay as they are, so that an array leaves them out.

    Args:
        places: Of `frame_places`.
    """
    shown = (picture[place][::2, ::2, 1] for picture, place in zip(pictures, places, strict=True))
    green = np.array([np.median(codes) for codes in shown])
    stops = np.log2(linear_of_srgb(np.maximum(green, FRAME_DARKEST_CODE) / 255))
    lacking = np.quantile(stops, FRAME_EXPOSURE_QUANTILE) - stops
    far = np.abs(lacking) > HARM_EXPOSURE_STOPS
    if far.mean() <= HARM_EXPOSURE_MAX_PART:
        return
    linear = linear_of_srgb(np.arange(256) / 255)
    for index in np.flatnonzero(far):
        codes = encode_srgb((linear * 2.0 ** lacking[index]).astype(np.float32))
        pictures[index] = np.rint(codes * 255).astype(np.uint8)[pictures[index]]


def filled_pictures(capture: Capture) -> Pictures:
    """As `read_depth_pictures`, with the nearest pixel in the border that the removal of a lens leaves empty."""
    whole, small = common_frame(capture)
    result = read_pictures(capture)

    def fill(index: int) -> None:
        mask = capture.photograph(index).mask if capture.sources[index].lens is not None else None
        if mask is not None:
            empty = _fit_to_frame(np.rint(mask * 255).astype(np.uint8), whole, small) < 255
            row, column = distance_transform_edt(empty, return_distances=False, return_indices=True)
            result[index] = result[index][row, column]

    parallel_map(fill, range(len(capture)))
    return mark_outside(result, frame_places(capture))


def has_masks(capture: Capture, most: int | None = None) -> bool:
    """Whether a mask or alpha hides any pixel of a photograph.

    Args:
        most: So many photographs are looked at; None: all. Those that cannot have either are not decoded.

    Raises:
        CaptureError: A photograph or a mask cannot be read.
    """
    indices = range(len(capture) if most is None else min(most, len(capture)))
    return any(mask is not None for mask in parallel_stream(partial(_own_mask, capture), indices))


def _own_mask(capture: Capture, index: int) -> NDArray[np.float32] | None:
    """(H, W) what hides pixels of a photograph as it is stored, by mask and alpha; None where nothing does.

    The border that the removal of a lens leaves empty is no mask: other views of the array see behind it.
    """
    source = capture.sources[index]
    if source.mask is None and source.picture is None:
        header = read_header(source.path)
        if not (header.alpha or header.format in ALPHA_UNKNOWN_FORMATS):
            return None
    return Photograph.of(*decode_with_mask(source, *capture.sizes[index])).mask


def read_masks(capture: Capture, size: Size | None = None) -> Pictures | None:
    """(n, H, W, 3) uint8 masks of the photographs, 255 where they are valid; None where they hide nothing.

    What lies outside a photograph smaller than the frame is no mask: packed ones say it as `read_depth_pictures` does.
    """
    whole, small = common_frame(capture, size)
    result = np.full((len(capture), small[1], small[0], 3), 255, np.uint8)

    def fill(index: int) -> bool:
        mask = _own_mask(capture, index)
        if mask is not None and capture.sources[index].lens is not None:
            mask = capture.photograph(index).mask
        if mask is None:
            return False
        result[index] = _fit_to_frame(np.rint(mask * 255).astype(np.uint8), whole, small)[..., None]
        return True

    some = any(parallel_map(fill, range(len(capture))))
    return mark_outside(result, frame_places(capture, size)) if some else None


def shown_pixels(capture: Capture) -> NDArray[np.bool_] | None:
    """(n, H, W) the pixels of photographs that lie inside their masks; None: all of the frame do."""
    masks = read_masks(capture)
    if masks is None and len(set(capture.sizes)) == 1:
        return None
    shown = np.zeros((len(capture), *common_frame(capture)[1][::-1]), np.bool_)
    for index, place in enumerate(frame_places(capture)):
        shown[index][place] = True
    if masks is not None:
        shown &= codes_of(masks)[..., 0] > 127
    return shown


def resized_cameras(capture: LightField, size: Size | None = None) -> list[Camera]:
    """The cameras in the common frame of `read_pictures`."""
    whole, small = common_frame(capture, size)
    scale = np.diag([small[0] / whole[0], small[1] / whole[1], 1.0])
    return [
        replace(camera, K=scale @ _moved(camera.K, _corner(one, whole)), width=small[0], height=small[1])
        for camera, one in zip(capture.cameras, capture.sizes, strict=True)
    ]


def full_size_cameras(capture: Capture, cameras: Sequence[Camera], size: Size | None = None) -> list[Camera]:
    """The cameras of photographs at their own sizes, from those in the common frame."""
    whole, small = common_frame(capture, size)
    scale = np.diag([whole[0] / small[0], whole[1] / small[1], 1.0])
    corners = [_corner(one, whole) for one in capture.sizes]
    return [
        replace(camera, K=_moved(scale @ camera.K, (-x, -y)), width=width, height=height)
        for camera, (x, y), (width, height) in zip(cameras, corners, capture.sizes, strict=True)
    ]


def _moved(K: NDArray[np.float64], by: tuple[int, int]) -> NDArray[np.float64]:
    """The intrinsics whose principal point lies farther right and down."""
    moved = K.copy()
    moved[:2, 2] += by
    return moved
