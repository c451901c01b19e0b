"""Codecs beside ours on the same photographs, in one run: rate-distortion curves, times, crops at about equal bytes."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from evidence import codecs, colour, ours, pictures, rates, stills
from evidence.prepared import Prepared, codes, drawn, places
from numpy.typing import NDArray

import eigenfield as ef
from eigenfield.capture import LightField
from eigenfield.parallel import parallel_map
from eigenfield.rendering import Renderer
from eigenfield.viewplane import find_grid

QUICK_VIDEO = ("svt-av1-2", "svt-av1-6")
LARGE = 150  # views: of a capture with more a quarter is enough to compare codecs, unless it is studied
KEYS = ("psnr", "psnr_luma", "ssim")


def peers(prepared: Prepared, folder: Path) -> dict[str, Any]:
    """All curves, Bjøntegaard's rates of ours against each peer, the ceiling of 4:2:0 without a codec, and crops."""
    light_field = _part(prepared)
    order = codecs.order(light_field.cameras)
    names = [light_field.names[index] for index in order]
    photographs = parallel_map(lambda index: codes(light_field, index), order)
    covered = ours.surfaces(prepared, light_field, order)
    curves, left_out = [ours.ours(prepared, light_field, order, photographs, covered)], []
    crops: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as place:
        for codec in codecs.VIDEO:
            why = "left out of the quick run" if _skipped(codec.name, prepared) else codecs.missing(codec)
            if why is not None:
                left_out.append(f"{codec.label}: {why}")
                continue
            points = [
                codecs.measure_video(codec, crf, photographs, names, covered, Path(place))
                for crf in _some(codec.rates, prepared)
            ]
            curves.append(
                {"name": codec.label, "key": codec.name, "kind": "video", "chroma": codec.chroma, "points": points}
            )
            if codec.name == "svt-av1-2":
                crops = _crops(
                    prepared, names, order, photographs, curves[0]["points"], (codec, points), Path(place), folder
                )
        for still in stills.STILLS:
            why = "left out of the quick run" if _skipped(still.name, prepared) else stills.missing(still)
            if why is not None:
                left_out.append(f"{still.label}: {why}")
                continue
            points = [
                stills.measure_stills(still, rate, photographs, names, covered, Path(place))
                for rate in _some(still.rates, prepared)
            ]
            curves.append({"name": still.label, "key": still.name, "kind": "still", "chroma": "444", "points": points})
    mine = curves[0]["points"]
    return {
        "order": "serpentine",
        "views": len(order),
        "of": len(prepared.light_field),
        "coverage": float(np.mean([one.mean() for one in covered])),
        "ceiling": _ceiling(photographs, names, covered),
        "curves": curves,
        "bd": {
            curve["name"]: {key: rates.bd_rate(curve["points"], mine, key) for key in KEYS}
            | {f"{key}_gain": rates.bd_quality(curve["points"], mine, key) for key in ("psnr", "psnr_luma")}
            for curve in curves[1:]
        },
        "left_out": left_out,
        "crops": crops,
    }  # fmt: skip


def _part(prepared: Prepared) -> LightField:
    """The photographs that are coded: all, or of a large capture that is not studied every second row and column."""
    light_field = prepared.light_field
    grid = find_grid(places(light_field))
    if len(light_field) <= LARGE or prepared.capture.studied or grid is None:
        return light_field
    return light_field.subset(sorted(grid.index[::2, ::2].reshape(-1).tolist()))


def _skipped(name: str, prepared: Prepared) -> bool:
    return prepared.quick and name not in QUICK_VIDEO


def _some(values: Sequence[Any], prepared: Prepared) -> Sequence[Any]:
    return values[1::2] if prepared.quick else values


def _ceiling(
    photographs: Sequence[NDArray[np.uint8]], names: Sequence[str], covered: Sequence[NDArray[np.bool_]]
) -> dict[str, Any]:
    """What the way to 10 bit 4:2:0 and back leaves without any codec, from up to 16 views."""
    some = np.unique(np.rint(np.linspace(0, len(photographs) - 1, 16)).astype(int))
    there_and_back = (colour.ceiling(photographs[i], "420") for i in some)
    point = rates.point(
        there_and_back, [photographs[i] for i in some], [covered[i] for i in some], [names[i] for i in some]
    )
    return {key: point[key] for key in KEYS}


def _crops(
    prepared: Prepared,
    names: Sequence[str],
    order: Sequence[int],
    photographs: Sequence[NDArray[np.uint8]],
    mine: Sequence[dict[str, Any]],
    video: tuple[codecs.VideoCodec, Sequence[dict[str, Any]]],
    place: Path,
    folder: Path,
) -> list[dict[str, Any]]:
    """The middle view's two hardest crops, as photograph, as ours and as the video nearest to ours in bytes."""
    codec, points = video
    pairs = [(abs(np.log(a["bytes"] / b["bytes"])), a, b) for a in mine for b in points]
    _, own, theirs = min(pairs, key=lambda pair: pair[0])
    middle = len(order) // 2
    scene = ef.load(prepared.work / own["file"])
    sizes = [(picture.shape[0], picture.shape[1]) for picture in photographs]
    film = codecs.access(place / f"{codec.name}-{theirs['parameter']}.{codec.container}", codec, middle, sizes[middle])[
        1
    ]
    shown = {
        "photograph": (photographs[middle], None),
        f"eigenfield, {own['parameter']}": (drawn(Renderer(scene), scene, order[middle])[0], own),
        f"{codec.label}, crf {theirs['parameter']}": (film, theirs),
    }  # fmt: skip
    corners = pictures.busiest([photographs[middle]] * 2, [picture for picture, point in shown.values() if point])
    return [
        {
            "label": label, "camera": names[middle],
            "bytes": None if point is None else point["bytes"], "psnr": None if point is None else point["psnr"],
            "picture": pictures.write(
                np.concatenate([pictures.crop(picture, corner) for corner in corners], axis=1), folder,
                f"{prepared.capture.name}-crop-{number}", exact=True,
            ),
        }
        for number, (label, (picture, point)) in enumerate(shown.items())
    ]  # fmt: skip
