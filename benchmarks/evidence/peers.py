"""Codecs beside ours on the same photographs, in one run: rate-distortion curves, times, crops at about equal bytes."""

from __future__ import annotations

import datetime
import hashlib
import json
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import eigenfield as ef
import measure
from eigenfield.capture import LightField
from eigenfield.evaluation.session import sample_evenly
from eigenfield.rendering import Renderer
from eigenfield.runtime.parallel import parallel_map
from evidence import codecs, colour, ours, pictures, rates, stills
from evidence.codecs import VideoCodec
from evidence.prepared import Prepared, as_json, codes, drawn, every, grid_of
from evidence.stills import StillCodec

QUICK = ("svt-av1-2", "svt-av1-6")
SHOWN = "svt-av1-2"  # whose middle view is kept, for the crops
LARGE = 150  # views: of a capture with more a quarter is enough to compare codecs, unless it is studied
KEYS = ("psnr", "psnr_luma", "ssim")
CODE = ("codecs.py", "stills.py", "colour.py", "rates.py")  # what the peers' figures depend on, photographs apart


@dataclass(frozen=True, eq=False)
class Views:
    """The photographs that are coded, in coding order. covered: their pixels that the proxy covers."""

    light_field: LightField
    order: list[int]
    names: list[str]
    photographs: list[NDArray[np.uint8]]
    covered: list[NDArray[np.bool_]]

    @property
    def middle(self) -> int:
        return (len(self.order) - 1) // 2


def peers(prepared: Prepared, folder: Path) -> dict[str, Any]:
    """All curves, Bjøntegaard's rates of ours against each peer, the ceiling of 4:2:0 without a codec, and crops."""
    light_field = _part(prepared)
    order = codecs.order(light_field.cameras)
    views = Views(
        light_field, order, [light_field.names[index] for index in order],
        parallel_map(lambda index: codes(light_field, index), order),
        ours.covered_pixels(prepared.work / "all.glb", order, light_field),
    )  # fmt: skip
    part = (prepared, light_field, order, views.photographs, views.covered)
    mine, _ = ours.fitted(*part, asked=ours.QUICK_QUALITIES if prepared.quick else ours.QUALITIES)
    others, left_out = [ours.paper(*part)], []
    key = _key(views, prepared.quick)
    for codec in (*codecs.VIDEO, *stills.STILLS):
        missing = codecs.missing(codec) if isinstance(codec, VideoCodec) else stills.missing(codec)
        why = "left out of the quick run" if prepared.quick and codec.name not in QUICK else missing
        if why is None:
            others.append(_curve(codec, views, prepared.work / "peers", key, prepared.quick))
        else:
            left_out.append(f"{codec.label}: {why}")
    return {
        "order": "serpentine",
        "views": len(order),
        "of": len(prepared.light_field),
        "coverage": float(np.mean([one.mean() for one in views.covered])),
        "ceiling": ceiling(views.photographs, views.names, views.covered),
        "curves": [mine, *others],
        "bd": {
            curve["name"]: {key: rates.bd_rate(curve["points"], mine["points"], key) for key in KEYS}
            | {f"{key}_gain": rates.bd_quality(curve["points"], mine["points"], key) for key in ("psnr", "psnr_luma")}
            for curve in others
        },
        "left_out": left_out,
        "crops": _crops(prepared, views, mine["points"], others, folder),
    }


def _key(views: Views, quick: bool) -> str:
    """What a peer's curve depends on: photographs, covered pixels and the code that measures it, not our own."""
    digest = hashlib.sha256(str(quick).encode())
    for name in CODE:
        digest.update(measure.meaning(Path(__file__).with_name(name)))
    for photograph, covered in zip(views.photographs, views.covered, strict=True):
        digest.update(photograph.tobytes() + np.packbits(covered).tobytes())
    return digest.hexdigest()[:16]


def _curve(codec: VideoCodec | StillCodec, views: Views, kept: Path, key: str, quick: bool) -> dict[str, Any]:
    """A peer's curve, measured once for the same photographs: our own file may change much oftener."""
    path = kept / f"{codec.name}-{key}.json"
    if path.exists():
        try:
            curve: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
            return curve
        except ValueError:  # cut off
            pass
    points = []
    with tempfile.TemporaryDirectory() as folder:
        for rate in codec.rates[1::2] if quick else codec.rates:
            points.append(_point(codec, rate, views, Path(folder)))
            if codec.name == SHOWN and isinstance(codec, VideoCodec):
                film = Path(folder) / f"{codec.name}-{rate}.{codec.container}"
                size = views.photographs[views.middle].shape
                picture = codecs.access(film, codec, views.middle, (size[0], size[1]))[1]
                points[-1]["middle"] = pictures.write_exact(picture, kept / f"{codec.name}-{rate}-{key}.webp").name
    video = isinstance(codec, VideoCodec)
    curve = {
        "name": codec.label, "key": codec.name, "kind": "video" if video else "still",
        "chroma": codec.chroma if isinstance(codec, VideoCodec) else "444", "points": points,
        "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
    }  # fmt: skip
    measure.write_json(path, as_json(curve))
    return curve


def _point(codec: VideoCodec | StillCodec, rate: float, views: Views, folder: Path) -> dict[str, Any]:
    if isinstance(codec, VideoCodec):
        return codecs.measure_video(codec, int(rate), views.photographs, views.names, views.covered, folder)
    return stills.measure_stills(codec, rate, views.photographs, views.names, views.covered, folder)


def _part(prepared: Prepared) -> LightField:
    """The photographs that are coded: all, or of a large capture that is not studied every second row and column."""
    light_field = prepared.light_field
    if len(light_field) <= LARGE or prepared.capture.studied or grid_of(light_field) is None:
        return light_field
    return every(light_field, 2)


def ceiling(
    photographs: Sequence[NDArray[np.uint8]], names: Sequence[str], covered: Sequence[NDArray[np.bool_]]
) -> dict[str, Any]:
    """What the way to 10 bit 4:2:0 and back leaves without any codec, from up to 16 views."""
    some = sample_evenly(range(len(photographs)), 16)
    there_and_back = (colour.ceiling(photographs[i], "420") for i in some)
    point = rates.point(
        there_and_back, [photographs[i] for i in some], [covered[i] for i in some], [names[i] for i in some]
    )
    return {key: point[key] for key in KEYS}


def _crops(
    prepared: Prepared, views: Views, mine: list[dict[str, Any]], others: list[dict[str, Any]], folder: Path
) -> list[dict[str, Any]]:
    """The middle view's two hardest crops, as photograph, as ours and as the video nearest to ours in bytes."""
    film = next((curve for curve in others if curve["key"] == SHOWN), None)
    if film is None:
        return []
    pairs = [(abs(np.log(own["bytes"] / other["bytes"])), own, other) for own in mine for other in film["points"]]
    _, own, other = min(pairs, key=lambda pair: pair[0])
    photograph = views.photographs[views.middle]
    scene = ef.load(prepared.work / own["file"])
    shown = {
        "photograph": (photograph, None),
        f"eigenfield, quality {own['parameter']}": (drawn(Renderer(scene), scene, views.order[views.middle])[0], own),
        f"{film['name']}, crf {other['parameter']}": (pictures.read(prepared.work / "peers" / other["middle"]), other),
    }
    drawings = [picture for picture, point in shown.values() if point]
    corners = pictures.busiest([photograph] * 2, drawings, covered=views.covered[views.middle])
    return [
        {
            "label": label, "camera": views.names[views.middle],
            "bytes": None if point is None else point["bytes"], "psnr": None if point is None else point["psnr"],
            "picture": pictures.write(
                np.concatenate([pictures.crop(picture, corner) for corner in corners], axis=1), folder,
                f"{prepared.capture.name}-crop-{number}", exact=True,
            ),
        }
        for number, (label, (picture, point)) in enumerate(shown.items())
    ]  # fmt: skip
