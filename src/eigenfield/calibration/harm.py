"""Photographs that harm a scene: blurred, exposed otherwise, partly covered, or of another place.

Each photograph is compared with its neighbours, so that what it shows does not count, but how it shows it. It is a look
beforehand, in a few seconds for fifty photographs: features at 0.1 megapixels say which places two photographs share.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree
from threadpoolctl import threadpool_limits

from eigenfield.calibration.neighbours import (
    NEIGHBOUR_EPIPOLAR_PIXELS,
    NEIGHBOUR_GAMMA,
    epipolar_matches,
    fit_similarity,
)
from eigenfield.calibration.planar.tracks import find_features, mutual_matches
from eigenfield.capture import Capture
from eigenfield.capture.survey import decode_all
from eigenfield.core.observations import Photograph
from eigenfield.core.progress import Progress
from eigenfield.imaging.metrics import to_codes
from eigenfield.runtime.parallel import tracked_map

log = logging.getLogger("eigenfield.calibration")


# Constants of `find_harmful`. Chosen on the cube and Fern; in brackets the most that any sound photograph of these,
# Fox, Fountain, Temple and the sparse Tarot has.
HARM_SIDE_PIXELS = 400  # longer side at which features are searched
# longer side of the largest size at which detail is looked at: beyond, it is mostly noise
HARM_FINEST_SIDE_PIXELS = 2000
HARM_COARSEST_SIDE_PIXELS = 160  # longer side of the smallest, at least
HARM_MIN_MATCHES = 20  # points that two photographs share, from which they are compared
# points that a photograph of the capture shares with some other, in the median: with fewer, nothing is said to be of
# another place
HARM_USUAL_MATCHES = 60
HARM_PARTNERS = 4  # neighbours of a photograph
HARM_MANY = 100  # photographs of a capture from which half as many neighbours do
HARM_BLURRED_OCTAVES = 1.0  # by which detail of some size and direction is less than that of neighbours (0.54)
HARM_LOST_OCTAVES = 2.0  # the same of a photograph that shares too few points with any, against all others
HARM_EXPOSURE_STOPS = 1.5  # by which the brightness differs from that of neighbours (0.45)
HARM_EXPOSURE_MAX_PART = 0.25  # part of the photographs up to which those of another exposure are exceptions
HARM_QUANTISATION = 0.25  # grey levels added to detail, so that none is nothing
HARM_COVER_SIDE = 64  # cells along the longer side, in which something near the lens is searched
HARM_COVER_BLOCK = 6  # cells of a block that is found again in a neighbour, each way
HARM_COVER_REACH = 6  # cells by which a block may be elsewhere than a similarity says
# root mean square of grey levels by which a block differs from all that a neighbour shows there
HARM_COVER_LEVELS = 18.0
HARM_COVER_OCTAVES = 1.25  # by which a block has less detail than the neighbour has there
HARM_COVER_THICKNESS = 5  # cells that what covers measures at least, each way
HARM_COVER_LIGHT = 235.0  # grey levels of what is overexposed, and covers nothing
HarmKind = Literal["blurred", "exposure", "covered", "apart"]


@dataclass(frozen=True)
class Harm:
    """A photograph that harms.

    Attributes:
        reason: The measure, which follows the photograph's name in a sentence.
    """

    index: int
    kind: HarmKind
    reason: str


@dataclass(frozen=True, eq=False)
class PhotographLook:
    """What is kept of a photograph.

    Attributes:
        size: (width, height) at which features were searched.
        points: (n, 2) features there.
        descriptors: (n, 128).
        luma: (n,) luma around each, grey levels.
        detail: (levels, 4, n) binary logarithm of the contrast between neighbouring pixels around each, by size, the
            finest first, and direction.
        overall: (levels, 4) the same of the whole photograph.
        cells: (rows, columns, 3) grey levels.
        cell_detail: (rows, columns) binary logarithm of the coarsest detail, grey levels.
    """

    size: tuple[int, int]
    points: NDArray[np.float64]
    descriptors: NDArray[np.float32]
    luma: NDArray[np.float32]
    detail: NDArray[np.float32]
    overall: NDArray[np.float32]
    cells: NDArray[np.float32]
    cell_detail: NDArray[np.float32]


def look_at(photograph: Photograph) -> PhotographLook:
    """What `find_harmful` needs of a photograph."""
    codes = to_codes(photograph.pixels)
    height, width = codes.shape[:2]
    longer = max(height, width)
    grid = _scaled((width, height), HARM_COVER_SIDE / longer)
    grey: NDArray[Any] = cv2.cvtColor(codes, cv2.COLOR_RGB2GRAY).astype(np.float32)
    while max(grey.shape) > HARM_FINEST_SIDE_PIXELS:
        grey = cv2.pyrDown(grey)
    bands = [_detail(grey, grid)]
    while max(grey.shape) >= 2 * HARM_COARSEST_SIDE_PIXELS:
        grey = cv2.pyrDown(grey)
        bands.append(_detail(grey, grid))
    size = _scaled((width, height), min(1.0, HARM_SIDE_PIXELS / longer))
    small = cv2.resize(codes, size, interpolation=cv2.INTER_AREA)
    light = max(float(np.percentile(small, 99)), 8.0)
    stretched = np.minimum(small * np.float32(255 / light), 255).astype(np.uint8)
    points, descriptors = find_features(stretched, 1.0)
    if photograph.mask is not None:
        mask = cv2.resize(photograph.mask.astype(np.float32), size, interpolation=cv2.INTER_AREA)
        kept = _at(mask, points, size) > 0.99
        points, descriptors = points[kept], descriptors[kept]
    around = cv2.boxFilter(cv2.cvtColor(small, cv2.COLOR_RGB2GRAY).astype(np.float32), -1, (7, 7))
    luma = _at(around, points, size)
    contrast = np.array([[_at(each, points, size) for each in band] for band in bands]) / np.maximum(luma, 1)
    overall = np.array([band.mean(axis=(1, 2)) for band in bands]) / max(float(around.mean()), 1.0)
    return PhotographLook(
        size, points, descriptors, luma, np.log2(contrast), np.log2(overall),
        cv2.resize(small, grid, interpolation=cv2.INTER_AREA).astype(np.float32), np.log2(bands[-1].mean(axis=0)),
    )  # fmt: skip


def _detail(grey: NDArray[Any], grid: tuple[int, int]) -> NDArray[np.float32]:
    """(4, rows, columns) mean absolute second difference in each cell: across, down, and along both diagonals."""
    steps = ((0, 1), (1, 0), (1, 1), (1, -1))
    kernels = np.zeros((4, 3, 3), np.float32)
    for kernel, (down, right) in zip(kernels, steps, strict=True):
        kernel[1 - down, 1 - right] = kernel[1 + down, 1 + right] = 1
        kernel[1, 1] = -2
    means = [cv2.resize(np.abs(cv2.filter2D(grey, -1, one)), grid, interpolation=cv2.INTER_AREA) for one in kernels]
    return np.stack(means) + np.float32(HARM_QUANTISATION)


def find_harmful(capture: Capture, looks: Mapping[int, PhotographLook], progress: Progress | None = None) -> list[Harm]:
    """The photographs that harm, in order.

    Args:
        looks: Of those that can be decoded, by index.
    """
    indices = sorted(looks)
    if len(indices) < 3:
        return []
    partners = _find_partners(capture, looks, progress)
    best = np.array([max((len(match.here) for match in partners[index]), default=0) for index in indices])
    levels = min(len(looks[index].overall) for index in indices)
    overall = np.array([looks[index].overall[-levels:] for index in indices])
    is_joined = bool(np.median(best) >= HARM_USUAL_MATCHES)

    def judge(place: int) -> Harm | None:
        index = indices[place]
        if len(partners[index]) > 1:
            return _compare(index, looks, partners[index])
        octaves = float((overall[place] - np.median(overall, axis=0)).min())
        if not is_joined:
            return None
        if octaves < -HARM_LOST_OCTAVES:
            return Harm(index, "blurred", _blurred(octaves, "the other photographs"))
        if partners[index]:
            return None
        return Harm(index, "apart", "shows nothing that another photograph shows: another place, or from too far aside")

    harms = tracked_map(judge, range(len(indices)), "photographs that harm", progress)
    found = [harm for harm in harms if harm is not None]
    exposed = sum(harm.kind == "exposure" for harm in found)
    if exposed <= HARM_EXPOSURE_MAX_PART * len(indices):
        return found
    words = "%d of %d photographs differ from their neighbours by more than %.1f stops: fix the exposure, or "
    log.warning(words + "encode with --harmonise affine", exposed, len(indices), HARM_EXPOSURE_STOPS)
    return [harm for harm in found if harm.kind != "exposure"]  # none of these is the exception


def advise(capture: Capture, progress: Progress | None = None) -> list[Harm]:
    """The photographs that harm; those that cannot be decoded are passed over."""
    return find_harmful(capture, decode_all(capture, look_at, progress)[1], progress)


def _scaled(size: tuple[int, int], scale: float) -> tuple[int, int]:
    return max(2, round(size[0] * scale)), max(2, round(size[1] * scale))


def _at(values: NDArray[Any], points: NDArray[np.float64], size: tuple[int, int]) -> NDArray[np.float32]:
    """(n,) values of a map of the whole photograph at points of it at a size."""
    rows, columns = values.shape
    place = (points * (columns / size[0], rows / size[1])).astype(np.int64)
    column, row = np.clip(place, 0, (columns - 1, rows - 1)).T
    return np.asarray(values[row, column], np.float32)


# which photographs are compared


@dataclass(frozen=True, eq=False)
class _Match:
    """Points that a photograph shares with another: indices of its features and of the other's."""

    other: int
    here: NDArray[np.int64]
    there: NDArray[np.int64]


def _find_partners(
    capture: Capture, looks: Mapping[int, PhotographLook], progress: Progress | None
) -> dict[int, list[_Match]]:
    """The neighbours of each photograph that share points with it; of one without any, any other that does."""
    indices = sorted(looks)
    found: dict[int, list[_Match]] = {index: [] for index in indices}

    def compare(pairs: Sequence[tuple[int, int]]) -> None:
        with threadpool_limits(1, "blas"):
            matches = tracked_map(lambda pair: _match(looks[pair[0]], looks[pair[1]]), pairs, "neighbours", progress)
        for (a, b), match in zip(pairs, matches, strict=True):
            if match is not None:
                found[a].append(_Match(b, *match))
                found[b].append(_Match(a, *match[::-1]))

    tried = _near_pairs(capture, indices)
    compare(tried)
    alone = {index for index in indices if not found[index]}
    every = {(min(a, b), max(a, b)) for a in alone for b in indices if a != b}
    compare(sorted(every - set(tried)))
    return found


def _near_pairs(capture: Capture, indices: Sequence[int]) -> list[tuple[int, int]]:
    """Each photograph with its nearest, by cameras or the places of a grid; without either with the next by name."""
    count = HARM_PARTNERS if len(indices) < HARM_MANY else HARM_PARTNERS // 2
    if capture.light_field is not None:
        places = np.array([capture.light_field.cameras[index].centre for index in indices])
    elif capture.layout is not None:
        places = np.asarray(capture.layout.positions, np.float64)[list(indices)]
    else:
        places = np.arange(len(indices), dtype=np.float64)[:, None]
    nearest = np.asarray(KDTree(places).query(places, k=min(count + 1, len(indices)))[1])
    pairs = {(min(a, int(b)), max(a, int(b))) for a, row in enumerate(nearest) for b in row if a != b}
    return [(indices[a], indices[b]) for a, b in sorted(pairs)]


def _match(a: PhotographLook, b: PhotographLook) -> tuple[NDArray[np.int64], NDArray[np.int64]] | None:
    least = HARM_MIN_MATCHES
    if min(len(a.points), len(b.points)) < least:
        return None
    here, there = mutual_matches(a.descriptors, b.descriptors)
    if len(here) >= least:
        kept = epipolar_matches(a.points[here], b.points[there], NEIGHBOUR_EPIPOLAR_PIXELS)
        here, there = here[kept], there[kept]
    return (here, there) if len(here) >= least else None


# what is wrong with a photograph


def _compare(index: int, looks: Mapping[int, PhotographLook], partners: Sequence[_Match]) -> Harm | None:
    """What harms of a photograph that shares points with others, if anything does."""
    a = looks[index]
    octaves, stops = [], []
    for match in partners:
        b = looks[match.other]
        levels = min(len(a.detail), len(b.detail))  # from the coarsest on
        gained = a.detail[-levels:, :, match.here] - b.detail[-levels:, :, match.there]
        octaves.append(float(np.median(gained, axis=2).min()))
        ratio = np.maximum(a.luma[match.here], 1) / np.maximum(b.luma[match.there], 1)
        stops.append(float(np.median(np.log2(ratio))) * NEIGHBOUR_GAMMA)
    lost, exposed = _least(octaves), _least(stops)
    if lost < -HARM_BLURRED_OCTAVES:
        return Harm(index, "blurred", _blurred(lost, "its neighbours"))
    if abs(exposed) > HARM_EXPOSURE_STOPS:
        word = "brighter" if exposed > 0 else "darker"
        return Harm(index, "exposure", f"is {abs(exposed):.1f} stops {word} than its neighbours")
    return _covered(index, looks, partners)


def _blurred(octaves: float, others: str) -> str:
    return f"is blurred: its finest detail is {2**octaves:.0%} of that of {others}"


def _least(values: Sequence[float]) -> float:
    """The median by size, or the smaller of both, so that one neighbour that is wrong itself does not decide."""
    return sorted(values, key=abs)[(len(values) - 1) // 2]


def _covered(index: int, looks: Mapping[int, PhotographLook], partners: Sequence[_Match]) -> Harm | None:
    """Something near the lens: at the border, smooth, and unlike all that neighbours show there, but for one, which
    may have it too."""
    a = looks[index]
    rows, columns = a.cell_detail.shape
    found = [each for match in partners if (each := _beside(a, looks[match.other], match)) is not None]
    if len(found) < 2:
        return None
    differs, lacks = (np.sort(np.stack(maps), axis=0)[1] for maps in zip(*found, strict=True))
    mask = (differs > HARM_COVER_LEVELS) & (lacks > HARM_COVER_OCTAVES)
    mask &= a.cells.max(axis=2) < HARM_COVER_LIGHT
    square = np.ones((HARM_COVER_THICKNESS,) * 2, np.uint8)
    thin = cv2.erode(mask.astype(np.uint8), square, borderType=cv2.BORDER_CONSTANT, borderValue=0)
    thick = cv2.dilate(thin, square, borderType=cv2.BORDER_CONSTANT, borderValue=0)
    _, labels, stats, middles = cv2.connectedComponentsWithStats(thick, connectivity=4)
    at_border = set(np.concatenate([labels[0], labels[rows - 1], labels[:, 0], labels[:, columns - 1]]).tolist()) - {0}
    if not at_border:
        return None
    label = max(at_border, key=lambda one: (int(stats[one, cv2.CC_STAT_AREA]), -one))
    part = stats[label, cv2.CC_STAT_AREA] / (rows * columns)
    across, down = middles[label] / (columns, rows)
    place = " ".join(
        [*(["top"] if down < 1 / 3 else ["bottom"] if down > 2 / 3 else []),
         *(["left"] if across < 1 / 3 else ["right"] if across > 2 / 3 else [])]
    )  # fmt: skip
    where = f"{part:.0%} of it, at the {place or 'border'}, is smooth and unlike its neighbours"
    return Harm(index, "covered", f"has something near the lens: {where}")


def _beside(
    a: PhotographLook, b: PhotographLook, match: _Match
) -> tuple[NDArray[np.float32], NDArray[np.float32]] | None:
    """(rows, columns) how far each cell's block is from any block of a neighbour near where it should be, in grey
    levels, and how much more detail the neighbour has around there, in octaves; 0 and minus infinity where it does not
    reach."""
    rows, columns = a.cell_detail.shape
    reach, block = HARM_COVER_REACH, (HARM_COVER_BLOCK,) * 2
    to_a, to_b = columns / a.size[0], b.cell_detail.shape[1] / b.size[0]
    similarity = fit_similarity(b.points[match.there] * to_b, a.points[match.here] * to_a)
    if similarity is None:
        return None
    gain = np.median(np.maximum(a.luma[match.here], 4) / np.maximum(b.luma[match.there], 4))
    similarity[:, 2] += similarity[:, :2] @ (0.5, 0.5) - 0.5 + reach
    size = columns + 2 * reach, rows + 2 * reach
    colours = cv2.warpAffine(b.cells * np.float32(gain), similarity, size)
    inside = cv2.warpAffine(np.ones_like(b.cell_detail), similarity, size, flags=cv2.INTER_NEAREST)
    detail = cv2.warpAffine(b.cell_detail, similarity, size) * inside

    def summed(values: NDArray[Any], side: tuple[int, int] = block) -> NDArray[np.float32]:
        return np.asarray(cv2.boxFilter(values, -1, side, normalize=False, borderType=cv2.BORDER_CONSTANT))

    whole = summed(np.ones((rows, columns), np.float32))
    least = np.full((rows, columns), np.inf, np.float32)
    for down in range(0, 2 * reach + 1, 2):
        for right in range(0, 2 * reach + 1, 2):
            there = np.s_[down : down + rows, right : right + columns]
            squares = np.square(a.cells - colours[there]).sum(axis=2) * inside[there]
            known = summed(inside[there])
            mean = np.where(known > 0.8 * whole, summed(squares) / np.maximum(known, 1), np.inf)
            least = np.minimum(least, mean.astype(np.float32))
    middle = np.s_[reach : reach + rows, reach : reach + columns]
    wide = (2 * reach + 1,) * 2
    total = summed(inside, wide)[middle]
    usual = summed(detail, wide)[middle] / np.maximum(total, 1)
    lacks = np.where(total > 0, usual - cv2.boxFilter(a.cell_detail, -1, (3, 3)), -np.inf)
    least[np.isinf(least)] = 0
    return np.sqrt(np.maximum(least, 0) / 3), lacks.astype(np.float32)
