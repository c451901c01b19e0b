"""What footage shows before any of it is encoded: whether cameras are in step, keep their exposure, and what moves.

Frames are looked at in grey, small, and one camera at a time. The *energy* of a frame is the mean of what changed since
the frame before. What happens in the scene happens for all cameras at once. The offsets of the cameras are therefore
those at which their energies, less what changes slowly, correlate best with each other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.footage import Footage
from eigenfield.core.progress import Progress, track
from eigenfield.runtime.parallel import parallel_stream

SURVEY_MAX_INSTANTS = 300  # that are looked at
SURVEY_SIDE = 160  # pixels of the longer side of what is looked at
STILL_DEVIATIONS = 4.0  # of its noise, within which a pixel stands still
STILL_LIMITS = 1.5 / 255, 8 / 255  # of that: noise beyond these is light that flickers
ENERGY_LEAST = 1e-4
ENERGY_WINDOW = 9  # frames, whose mean is what changes slowly
OFFSET_MIN_INSTANTS = 24  # from which energies say anything
OFFSET_MAX_FRACTION, OFFSET_MAX_FRAMES = 1 / 3, 60  # of the instants that are looked at; at most
OFFSET_MIN_CORRELATION = 0.4  # at which an offset is believed
# Of the correlation over that without an offset. Of ten cameras that are in step, one is 0.16 better a frame early
OFFSET_MIN_GAIN = 0.2
OFFSET_ROUNDS = 10
EXPOSURE_WINDOW = 5  # frames, over whose median an exposure is taken
GAMMA = 2.2


@dataclass(frozen=True, eq=False)
class Watched:
    """What one camera shows over time.

    Attributes:
        energy: (T - 1,) of each frame but the first.
        stops: By how much its exposure changes, from the darkest to the brightest moment.
        still: The share of pixels that stand still, 0..1.
        damaged: How many of its frames are.
    """

    energy: NDArray[np.float64]
    stops: float
    still: float
    damaged: int


@dataclass(frozen=True)
class Lag:
    """By how many frames a camera is late, as far as the scene's motion tells.

    Attributes:
        frames: 0 where another number would explain hardly more.
        correlation: Of its energy with those of the others.
    """

    frames: int
    correlation: float

    @property
    def known(self) -> bool:
        """Whether the motion tells anything."""
        return self.correlation >= OFFSET_MIN_CORRELATION


def watch(footage: Footage, progress: Progress | None = None) -> list[Watched]:
    """Look at the first instants, all cameras."""
    count, cameras = min(len(footage), SURVEY_MAX_INSTANTS), range(len(footage.names))
    stream = parallel_stream(lambda camera: _watch_one(footage, camera, count), cameras)
    return list(track(stream, "looking at frames", len(cameras), progress))


def _watch_one(footage: Footage, camera: int, count: int) -> Watched:
    shown = [number for number in range(count) if not footage.held[camera, number]]
    energy, middle, damaged = np.zeros(count), [], 0
    before: NDArray[np.float32] | None = None
    low = high = np.zeros((1, 1), np.float32)
    squares = np.zeros((1, 1))
    for number in shown:
        grey = footage.tracks[camera].small(int(footage.frames[camera, number]), SURVEY_SIDE)
        if grey is None:
            damaged += 1
            continue
        if before is None or before.shape != grey.shape:
            low, high, squares = grey, grey, np.zeros(grey.shape)
        else:
            energy[number] = float(np.abs(grey - before).mean())
            squares = squares + np.square(grey - before, dtype=np.float64)
        middle.append(float(np.median(grey)))
        low, high, before = np.minimum(low, grey), np.maximum(high, grey), grey
    noise = float(np.sqrt(np.quantile(squares, 0.25) / max(2 * len(middle) - 2, 1)))
    limit = float(np.clip(STILL_DEVIATIONS * noise, *STILL_LIMITS))
    return Watched(energy[1:], _stops(np.array(middle)), float(((high - low) / 2 <= limit).mean()), damaged)


def _stops(middle: NDArray[np.float64]) -> float:
    """From the darkest to the brightest moment, by medians of a few frames."""
    if len(middle) < EXPOSURE_WINDOW:
        return 0.0
    windows = np.lib.stride_tricks.sliding_window_view(middle, EXPOSURE_WINDOW)
    return float(np.ptp(GAMMA * np.log2(np.maximum(np.median(windows, axis=1), 1 / 255))))


def find_lags(energies: list[NDArray[np.float64]]) -> list[Lag]:
    """By how many frames each camera is late against most of them.

    Every camera in turn is the one that others are first compared with; the best outcome is kept.
    """
    count, instants = len(energies), len(energies[0])
    if count < 2 or instants < OFFSET_MIN_INSTANTS or min(float(energy.max()) for energy in energies) == 0:
        return [Lag(0, 0.0)] * count
    most = min(int(instants * OFFSET_MAX_FRACTION), OFFSET_MAX_FRAMES)
    table = _correlations([_quick_part(energy) for energy in energies], 2 * most)
    settled = [_settled(table, most, first) for first in range(count)]
    lags = max(settled, key=lambda lags: sum(_score(table, lags, one, lags[one]) for one in range(count)))
    lags = lags - int(np.median(lags))
    found = []
    for one in range(count):
        score, none = (_score(table, lags, one, lag) for lag in (int(lags[one]), 0))
        gains = score - none >= OFFSET_MIN_GAIN
        found.append(Lag(int(lags[one]) if gains else 0, score if gains else none))
    return found


def _quick_part(energy: NDArray[np.float64]) -> NDArray[np.float64]:
    """The logarithm of an energy less its mean over a window, with unit variance."""
    values = np.log(energy + ENERGY_LEAST)
    padded = np.pad(values, ENERGY_WINDOW // 2, mode="edge")
    quick = values - np.convolve(padded, np.full(ENERGY_WINDOW, 1 / ENERGY_WINDOW), "valid")
    return np.asarray((quick - quick.mean()) / max(float(quick.std()), 1e-9), np.float64)


def _correlations(signals: list[NDArray[np.float64]], most: int) -> NDArray[np.float64]:
    """(N, N, 2 most + 1) of each with each other, the first later by -most..most frames; of a camera with itself 0."""
    count, instants = len(signals), len(signals[0])
    table = np.zeros((count, count, 2 * most + 1))
    for one in range(count):
        for other in range(one):
            full = np.correlate(signals[one], signals[other], "full") / instants
            row = full[instants - 1 - most : instants + most]
            table[one, other], table[other, one] = row, row[::-1]
    return table


def _score(table: NDArray[np.float64], lags: NDArray[np.int64], one: int, lag: int) -> float:
    """The mean correlation of a camera at a lag with the others at theirs."""
    at = lag - lags + table.shape[2] // 2
    return float(table[one, np.arange(len(lags)), at].sum()) / (len(lags) - 1)


def _settled(table: NDArray[np.float64], most: int, first: int) -> NDArray[np.int64]:
    """Lags of which none can be bettered alone, from those against one camera on."""
    middle = table.shape[2] // 2
    lags = table[:, first, middle - most : middle + most + 1].argmax(axis=1) - most
    lags[first] = 0
    choices = range(-most, most + 1)
    for _ in range(OFFSET_ROUNDS):
        before = lags.copy()
        for one in range(len(lags)):
            scores = [(_score(table, lags, one, lag), -abs(lag), lag) for lag in choices]
            lags[one] = max(scores)[2]
        if np.array_equal(before, lags):
            break
    return lags
