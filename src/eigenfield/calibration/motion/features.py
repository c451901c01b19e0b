"""SIFT features of photographs: keypoints at full resolution, descriptors, and the colour at each keypoint.

Lowe, *Distinctive Image Features from Scale-Invariant Keypoints*, IJCV 2004; root-normalised (Arandjelović and
Zisserman, CVPR 2012); with domain-size pooling where there is little texture (Dong and Soatto, CVPR 2015).
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from functools import partial

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from eigenfield.calibration.lenses import KnownLens, undistort_pixels
from eigenfield.calibration.motion.colmap_core import pycolmap
from eigenfield.capture.calibration import or_error
from eigenfield.capture.photographs.decoded import decode_with_mask
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.core.errors import CaptureError
from eigenfield.core.progress import Progress
from eigenfield.runtime.parallel import tracked_map
from eigenfield.runtime.temporary import temporary_folder

FEATURE_LUMA_WEIGHTS = np.array([0.299, 0.587, 0.114], np.float32)
FEATURE_MASK_THRESHOLD = 0.5
# each extraction takes half a gigabyte, however many processors there are
FEATURE_EXTRACTION_SLOTS = threading.BoundedSemaphore(4)
FEATURE_SAME_PIXELS = 3.0  # between features of one camera at two instants that are the same
FEATURE_MIN_MEDIAN_COUNT = 2500  # in the median photograph: below, weaker features are searched


@dataclass(frozen=True)
class FeatureOptions:
    """How features are searched.

    Attributes:
        max_side: Longer side in pixels at which features are searched; coordinates are those of the full photograph.
        max_features: Features a photograph; the largest are kept.
        peak_threshold: Of the difference of Gaussians, 0..1; a lower one finds weaker features.
        domain_size_pooling: Average descriptors over sizes: two to three times slower, a few per cent more matches.
    """

    max_side: int = 1600
    max_features: int = 6000
    peak_threshold: float = 0.0067
    domain_size_pooling: bool = False


WEAK_FEATURE_OPTIONS = FeatureOptions(peak_threshold=0.002, domain_size_pooling=True)


@dataclass(frozen=True, eq=False)
class Features:
    """The features of one photograph, the largest first.

    Attributes:
        points: (n, 2) float64 pixels of the photograph, centres at +0.5.
        descriptors: (n, 128) uint8 of norm 512.
        colours: (n, 3) uint8.
    """

    points: NDArray[np.float64]
    descriptors: NDArray[np.uint8]
    colours: NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.points)


NO_FEATURES = Features(np.zeros((0, 2)), np.zeros((0, 128), np.uint8), np.zeros((0, 3), np.uint8))


def extract_here(
    shots: Sequence[Shot], options: FeatureOptions, stage: str, progress: Progress | None
) -> list[Features | CaptureError]:
    """The features of photographs, or the error for one that cannot be read, by the threads of this process."""
    extract = or_error(partial(extract_features_of, options=options))
    return tracked_map(extract, shots, stage, progress)


# `extract_here`, or the same on workers
Extract = Callable[[Sequence[Shot], FeatureOptions, str, Progress | None], list[Features | CaptureError]]


def extract_features(
    photos: PhotoSet,
    options: FeatureOptions | None = None,
    progress: Progress | None = None,
    extract: Extract = extract_here,
    blind: Collection[int] = (),
) -> list[Features | CaptureError]:
    """The features of every photograph, or the error for a photograph that cannot be read.

    Args:
        options: How features are searched. None: the default, and WEAK_FEATURE_OPTIONS if the median photograph has
            few.
        extract: Finds them for given photographs and options.
        blind: Photographs that have no part in that choice.
    """
    chosen = FeatureOptions() if options is None else options
    found = extract(photos.shots, chosen, "features", progress)
    counts = [len(one) for index, one in enumerate(found) if isinstance(one, Features) and index not in blind]
    if options is None and counts and np.median(counts) < FEATURE_MIN_MEDIAN_COUNT:
        found = extract(photos.shots, WEAK_FEATURE_OPTIONS, "weaker features", progress)
    return found


def extract_features_of(shot: Shot, options: FeatureOptions) -> Features:
    """The features of one photograph where its mask and alpha allow.

    Raises:
        CaptureError: As `decode`.
    """
    pixels, mask = decode_with_mask(shot, shot.width, shot.height)
    height, width = pixels.shape[:2]
    scale = min(1.0, options.max_side / max(width, height))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    grey = pixels @ FEATURE_LUMA_WEIGHTS
    if scale < 1:
        grey = np.asarray(cv2.resize(grey, size, interpolation=cv2.INTER_AREA))
    keypoints, descriptors = _sift(np.clip(np.rint(grey * 255), 0, 255).astype(np.uint8), options)
    up = np.array([width / size[0], height / size[1]])
    points = keypoints[:, :2].astype(np.float64) * up
    scales = np.hypot(keypoints[:, 2], keypoints[:, 4]) * np.float32(up.mean())
    column, row = np.clip(points.astype(np.int64), 0, [width - 1, height - 1]).T
    counts = np.ones(len(points), bool) if mask is None else mask[row, column] > FEATURE_MASK_THRESHOLD
    # the largest first, ties by place: the extractor promises no order
    order = np.lexsort((points[:, 1], points[:, 0], -scales))
    order = order[counts[order]][: options.max_features]
    colours = np.rint(pixels[row, column] * 255).astype(np.uint8)
    return Features(points[order], np.ascontiguousarray(descriptors[order]), colours[order])


def join_features(instants: Sequence[Features]) -> Features:
    """The features of one camera at several instants, each of what stands still once.

    A feature within `FEATURE_SAME_PIXELS` of one of an instant before is taken for the same: two of one descriptor
    would hide each other from every match.
    """
    from scipy.spatial import KDTree

    joined = instants[0]
    for more in instants[1:]:
        distances = KDTree(joined.points).query(more.points)[0] if len(joined) else np.full(len(more), np.inf)
        new = np.asarray(distances > FEATURE_SAME_PIXELS)
        joined = Features(
            np.concatenate([joined.points, more.points[new]]),
            np.concatenate([joined.descriptors, more.descriptors[new]]),
            np.concatenate([joined.colours, more.colours[new]]),
        )
    return joined


def _sift(grey: NDArray[np.uint8], options: FeatureOptions) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    """Keypoints (n, 6) x, y and the 2x2 shape, and descriptors (n, 128).

    The picture goes through a file: pycolmap's extractor of arrays holds the interpreter lock while it works.
    """
    settings = pycolmap.FeatureExtractionOptions()
    settings.num_threads = 1
    settings.use_gpu = False
    settings.sift.max_num_features = 2 * options.max_features  # COLMAP drops whole octaves: ask for more than are kept
    settings.sift.peak_threshold = options.peak_threshold
    settings.sift.domain_size_pooling = options.domain_size_pooling
    with temporary_folder() as place:
        Image.fromarray(grey).save(place / "grey.png", compress_level=1)
        with FEATURE_EXTRACTION_SLOTS:
            pycolmap.extract_features(
                place / "features.db", place, image_names=["grey.png"], extraction_options=settings,
                device=pycolmap.Device.cpu,
            )  # fmt: skip
        database = pycolmap.Database.open(place / "features.db")
        try:
            image = database.read_image_with_name("grey.png")
            if image is None or not database.exists_keypoints(image.image_id):
                return np.zeros((0, 6), np.float32), np.zeros((0, 128), np.uint8)
            keypoints = np.asarray(database.read_keypoints(image.image_id))
            descriptors = np.asarray(database.read_descriptors(image.image_id).data)
        finally:
            database.close()
    return keypoints, descriptors.reshape(-1, 128)


def undistort_features(features: Features, lens: KnownLens) -> tuple[Features, Features]:
    """The features as a pinhole camera sees them, and as the photograph shows them, without those beyond the lens."""
    points = undistort_pixels(features.points, lens)
    good = np.asarray(np.isfinite(points).all(axis=1))
    seen = Features(features.points[good], features.descriptors[good], features.colours[good])
    return replace(seen, points=points[good]), seen
