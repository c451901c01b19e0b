"""What each part of soft sheets is worth: it is taken away, and views left out are drawn from what is left.

    EIGENFIELD_DATA=captures python benchmarks/layers.py [CAPTURE ...] [--store]

As in the trial of `encode --surface auto`: sheets are fitted, at a small size and not coded, to three quarters of the
photographs, and draw the others. Four captures unless some are named.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest.mock import patch

import numpy as np
from numpy.typing import NDArray

import eigenfield as ef
import measure
from eigenfield.capture import open_any
from eigenfield.core.camera import Camera
from eigenfield.imaging.metrics import psnr
from eigenfield.reconstruction import layered, layers
from eigenfield.reconstruction.layers import LAYERS_TRIAL_SIDE_PIXELS, LAYERS_TRIAL_STEP, Range
from eigenfield.stereo import ReferenceView, view_matrices
from eigenfield.stereo.multiplane import MULTIPLANE_TUNING, SoftSheets
from eigenfield.stereo.multiplane.fit import SHEET_TUNING, fit_sheets
from evidence import captures

CAPTURES = ("fern", "boxes", "shop", "tarot-5x4")
COUNT = 8  # sheets of the whole
NO_VARIATION = {"colour_variation": 0.0, "opacity_variation": 0.0}


@dataclass(frozen=True)
class Part:
    """A part of the descent that is taken away.

    Attributes:
        words: What is left out, or changed.
        tuning: Constants of planes and sheets that take it away.
        count: Number of sheets.
        hard: Whether opacity is rounded to 0 or 1 before drawing.
    """

    words: str
    tuning: dict[str, Any]
    count: int = COUNT
    hard: bool = False


PARTS = {
    "whole": Part(f"{COUNT} sheets", {}),
    "pyramid": Part("without the pyramid of corrections", {"levels": 1}),
    "variation": Part("without total variation", NO_VARIATION),
    "price": Part("without the prices of opacity", {"opacity_price": 0.0, "doubt_price": 0.0}),
    "opacity": Part("opacity rounded to 0 or 1", {}, hard=True),
    **{f"sheets-{count}": Part(f"{count} sheets", {}, count) for count in (2, 4, 12, 16)},
}


class _GivenError(Exception):
    """Carries what sheets would be fitted to."""


def given_of(name: str, out: Path) -> tuple[NDArray[np.uint8], Sequence[Camera], Range]:
    """Photographs at the size of a trial, their cameras, and the range of inverse depths of a capture."""
    capture = captures.named(name, out)
    photographs = open_any(capture.folder, calibration=capture.calibration)

    def stop(*given: Any, **_: Any) -> None:
        raise _GivenError(*given)

    with patch.object(layered, "layers_proxy", stop):
        try:
            ef.reconstruct(photographs, surface="layers", layers=COUNT)
        except _GivenError as found:
            pictures, cameras, bounds = found.args
            small, of_small = layers.halved(pictures, cameras, LAYERS_TRIAL_SIDE_PIXELS)
            return small, of_small, bounds
    raise SystemExit(f"{name} has no soft sheets")


@contextmanager
def without(part: Part) -> Iterator[None]:
    """Take a part away."""
    planes, sheets = replace(MULTIPLANE_TUNING, **part.tuning), replace(SHEET_TUNING, **part.tuning)
    with patch.object(layers, "fit_sheets", partial(fit_sheets, planes=planes, tuning=sheets)):
        yield


def of_parts(pictures: NDArray[np.uint8], cameras: Sequence[Camera], bounds: Range) -> dict[str, Any]:
    """PSNR of views left out and of the others, and seconds, for each of PARTS."""
    left_out = np.zeros(len(cameras), np.bool_)
    left_out[LAYERS_TRIAL_STEP // 2 :: LAYERS_TRIAL_STEP] = True
    known = [camera for camera, out in zip(cameras, left_out, strict=True) if not out]
    found = {}
    for key, part in PARTS.items():
        started = time.perf_counter()
        with without(part):
            reference, (sheets,) = layers.fit_views(pictures[~left_out], known, bounds, [part.count])
        if part.hard:
            sheets.layers[..., 3] = np.rint(sheets.layers[..., 3])
        scores = np.array(_scores(reference, sheets, pictures, cameras))
        held_out, captured = float(scores[left_out].mean()), float(scores[~left_out].mean())
        seconds = round(time.perf_counter() - started, 1)
        found[key] = {"words": part.words, "held_out": held_out, "captured": captured, "seconds": seconds}
        print(f"  {part.words}: {held_out:.2f} dB held out, {captured:.2f} captured", flush=True)
    return found


def _scores(
    reference: ReferenceView, sheets: SoftSheets, pictures: NDArray[np.uint8], cameras: Sequence[Camera]
) -> list[float]:
    matrices = view_matrices(reference, cameras)
    drawn = (np.clip(sheets.draw(matrix, pictures.shape[1:3]), 0, 1) for matrix in matrices)
    codes = (np.rint(one * 255).astype(np.uint8) for one in drawn)
    return [psnr(one, true) or 0.0 for one, true in zip(codes, pictures, strict=True)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("captures", nargs="*", metavar="CAPTURE", default=CAPTURES)
    parser.add_argument("--store", action="store_true", help="append to benchmarks/results/layers.json")
    options = parser.parse_args()
    found = {}
    with TemporaryDirectory() as folder:
        for name in options.captures:
            pictures, cameras, bounds = given_of(name, Path(folder))
            height, width = pictures.shape[1:3]
            print(f"{name}: {len(pictures)} photographs of {width}x{height}")
            found[name] = {
                "views": len(pictures),
                "size": [width, height],
                "parts": of_parts(pictures, cameras, bounds),
            }
    if options.store:
        print(measure.store("layers", {"captures": found}))


if __name__ == "__main__":
    main()
