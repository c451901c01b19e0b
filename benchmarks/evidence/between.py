"""Views between the encoded cameras: held-out photographs beside what our scene and its peers draw in their place."""

from __future__ import annotations

import io
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from eigenfield.capture import LightField, match_photographs
from eigenfield.capture.overlay import proxy_lines
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.scene import Scene
from eigenfield.evaluation import ExcludedCircle
from eigenfield.evaluation.image import ImageScores, measure_picture, summarise_scores
from eigenfield.gltf import parts
from eigenfield.imaging.colour import LUMA_BT709
from eigenfield.imaging.metrics import psnr, to_codes
from eigenfield.rendering import WEIGHT_MODES, Renderer, ViewWeights, camera_weights, view_weights
from evidence import codecs
from evidence.lumigraph import Lumigraph, draw_lumigraph, make_lumigraph
from evidence.prepared import spread_over_array

EDGE_REACH = 2  # pixels: what lies so near a depth edge counts as the edge's
AVIF_QUALITY, AVIF_SAMPLE = 50, 12  # of the photographs as AVIF: how many are packed to say what all need
TITLES = {
    "nearest": "the nearest photograph",
    "blend": "blended photographs",
    "lumigraph": "lumigraph of photographs",
    **{mode: f"our scene, {mode} view weights" for mode in WEIGHT_MODES},
    "ours": "our scene",
    "before": "our scene, the version before",
    **{codec.name: f"lumigraph of {codec.label}" for codec in codecs.VIDEO},
}
WORDS = (
    "Held-out views; mean over views, the worst beside it. All ways are measured over the same pixels, those that the "
    "proxy covers from the held-out camera; psnr_full counts the whole frame, black where ours and the lumigraph have "
    "nothing. The peers draw from the encoded cameras' photographs as decoded and need all of them. Where no "
    "photograph sees the surface, the lumigraph's picture is filled smoothly, as our textures are (holes: their share)."
)

Way = Callable[[int], NDArray[Any]]


@dataclass(frozen=True, eq=False)
class Stage:
    """A scene and its photographs. views: index of a scene's camera to that of its photograph."""

    scene: Scene
    capture: LightField
    views: Mapping[int, int]
    renderer: Renderer


@dataclass(frozen=True, eq=False)
class Peers:
    """What the peers draw from: the photographs of the encoded cameras, `shown` (n,) scene indices."""

    shown: NDArray[np.int64]
    lumigraph: Lumigraph


def between(
    stage: Stage,
    peers: Peers,
    sample: int | None = None,
    *,
    file: Path | None = None,
    circles: Mapping[str, ExcludedCircle] | None = None,
) -> dict[str, Any]:
    """Figures of every way to draw the held-out views: rows under "methods", in the order of TITLES.

    stage, peers: of `start`. sample: measure so many held-out cameras, spread over the array; None: all. file: the
    scene's, for its bytes. circles: of `read_circles`; then psnr_outside counts the covered pixels outside them.
    """
    scene = stage.scene
    chosen = held_out(stage, sample)
    rows, notes = measure_ways(stage, chosen, ways_of(stage, peers), circles)
    if _blended_by(scene) != "bilinear":
        notes.append("The encoded cameras are on no full grid: photographs are blended with Delaunay weights.")
    return {
        "cameras": len(chosen),
        "held_out": int(scene.rig.held_out.sum()),
        "encoded": len(scene.rig.encoded),
        "methods": rows,
        "holes": _holes(stage, peers, chosen),
        "bytes": _bytes(stage, peers, file),
        "words": " ".join((WORDS, *notes)),
    }


def start(scene: Scene, light_field: LightField) -> tuple[Stage, Peers]:
    """Match the photographs, decode the encoded cameras', prepare both renderers."""
    views = match_photographs(scene, light_field)
    shown = np.array([index for index in scene.rig.encoded if int(index) in views], np.int64)

    def photograph(index: int) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
        picture = light_field.photograph(views[int(shown[index])])
        return picture.pixels, picture.mask

    lumigraph = make_lumigraph(scene.proxy.mesh, [scene.rig.cameras[index] for index in shown], photograph)
    return Stage(scene, light_field, views, Renderer(scene)), Peers(shown, lumigraph)


def ways_of(stage: Stage, peers: Peers) -> dict[str, Way]:
    """Key of TITLES to what draws a held-out camera, (H, W, 3), uint8 or 0..1; in no grid `bilinear` raises."""
    ways: dict[str, Way] = {
        "nearest": partial(_nearest, stage, peers),
        "blend": partial(_blend, stage, peers),
        "lumigraph": lambda index: draw_lumigraph(peers.lumigraph, stage.scene.rig.cameras[index])[0],
    }
    return ways | {mode: partial(_ours, stage, mode) for mode in WEIGHT_MODES}


def covered_by_proxy(stage: Stage, index: int, mask: NDArray[np.float32] | None) -> NDArray[np.bool_]:
    """(H, W) the pixels that count for a camera: the proxy on all of a pixel's samples, and within the mask."""
    covered = stage.renderer.draw(stage.scene.rig.cameras[index], ViewWeights(), textures=0).covered
    return covered if mask is None else covered & (mask > 0.5)


def _ours(stage: Stage, mode: str, index: int) -> NDArray[np.float32]:
    return stage.renderer.draw(stage.scene.rig.cameras[index], camera_weights(stage.scene, index, mode)).image


def _nearest(stage: Stage, peers: Peers, index: int) -> NDArray[np.uint8]:
    centre = stage.scene.rig.cameras[index].centre
    near = int(np.argmin(np.linalg.norm(peers.lumigraph.centres - centre, axis=1)))
    return _as_large(peers.lumigraph.photograph(near), stage, index)


def _blend(stage: Stage, peers: Peers, index: int) -> NDArray[np.float32]:
    """The four neighbours of a grid with bilinear weights; without one, those of the Delaunay triangle."""
    scene = stage.scene
    x, y = scene.rig.view_plane.coordinates(scene.rig.cameras[index].centre)[0]
    dense = view_weights(scene, (float(x), float(y)), _blended_by(scene)).dense(scene.observations)
    weights = dense[np.isin(scene.rig.encoded, peers.shown)]
    total = np.zeros((scene.rig.cameras[index].height, scene.rig.cameras[index].width, 3), np.float32)
    for near in np.flatnonzero(weights):
        photograph = _as_large(peers.lumigraph.photograph(int(near)), stage, index)
        total += np.float32(weights[near] / weights.sum() / 255) * photograph
    return total


def _blended_by(scene: Scene) -> str:
    try:
        view_weights(scene, (0.0, 0.0), "bilinear")
    except OptionError:
        return "delaunay"
    return "bilinear"


def _as_large(photograph: NDArray[np.uint8], stage: Stage, index: int) -> NDArray[np.uint8]:
    """Photographs of one capture may differ in size."""
    camera = stage.scene.rig.cameras[index]
    if photograph.shape[:2] == (camera.height, camera.width):
        return photograph
    return np.asarray(cv2.resize(photograph, (camera.width, camera.height), interpolation=cv2.INTER_AREA), np.uint8)


def held_out(stage: Stage, sample: int | None = None) -> list[int]:
    """The held-out cameras whose photographs are there, or `sample` of them; ValueError where there is none."""
    held = [int(index) for index in np.flatnonzero(stage.scene.rig.held_out) if int(index) in stage.views]
    if not held:
        raise ValueError("the scene holds out no camera whose photograph is here")
    return spread_over_array(stage.scene, held, len(held) if sample is None else sample)


def near_depth_edges(mesh: Mesh, camera: Camera) -> NDArray[np.bool_]:
    """(H, W) the pixels within EDGE_REACH rows and columns of the mesh's outline and depth edges (`proxy_lines`)."""
    side = 2 * EDGE_REACH + 1
    outline = proxy_lines(mesh, camera).outline.astype(np.uint8)
    return np.asarray(cv2.dilate(outline, np.ones((side, side), np.uint8)), np.bool_)


def squared_luma_errors(drawn: NDArray[np.uint8], photograph: NDArray[np.uint8]) -> NDArray[np.float32]:
    """(H, W) of the 8-bit codes (H, W, 3), in BT.709 luma."""
    difference = np.asarray(cv2.subtract(drawn, photograph, dtype=cv2.CV_32F))
    return np.square(np.asarray(cv2.transform(difference, np.array([LUMA_BT709], np.float32)), np.float32))


def share_near(values: Sequence[NDArray[Any]], near: Sequence[NDArray[np.bool_]]) -> float:
    """The part of the sum of all values that lies at the places `near`; 0 where the sum is 0."""
    total = sum(float(one.sum(dtype=np.float64)) for one in values)
    there = sum(float(one.sum(where=at, dtype=np.float64)) for one, at in zip(values, near, strict=True))
    return there / total if total else 0.0


def measure_ways(
    stage: Stage, chosen: Sequence[int], ways: Mapping[str, Way], circles: Mapping[str, ExcludedCircle] | None = None
) -> tuple[list[dict[str, Any]], list[str]]:
    """A row for each way that this array allows, and a word on each that it does not.

    A row has key, title, the scores of `measure_picture` with FLIP, their worst views and seconds a view. edge_share is
    the part of all squared errors of luma in covered pixels that lies near depth edges; edge_pixels is their part of
    the covered pixels.

    Args:
        stage: The scene and its photographs.
        chosen: Indices of its cameras.
        ways: By their keys in TITLES.
        circles: Where there are some, psnr_outside counts the covered pixels outside them.
    """
    notes = []
    usable: dict[str, Way] = {}
    for key, draw in ways.items():
        try:
            draw(chosen[0])  # compiles, fills caches: not in the seconds
        except OptionError as error:
            notes.append(f"No {key} view weights: {error.message}.")
        else:
            usable[key] = draw
    figures: dict[str, list[ImageScores]] = {key: [] for key in usable}
    seconds: dict[str, list[float]] = {key: [] for key in usable}
    errors: dict[str, list[NDArray[np.float32]]] = {key: [] for key in usable}
    edges = []
    for index in chosen:
        photograph = stage.capture.photograph(stage.views[index])
        covered = covered_by_proxy(stage, index, photograph.mask)
        true = to_codes(photograph.pixels)
        circle = None if circles is None else circles.get(stage.scene.rig.names[index])
        edges.append(near_depth_edges(stage.scene.proxy.mesh, stage.scene.rig.cameras[index])[covered])
        for key, draw in usable.items():
            started = time.perf_counter()
            drawn = to_codes(draw(index))
            seconds[key].append(time.perf_counter() - started)
            figures[key].append(measure_picture(drawn, covered, true, with_flip=True))
            errors[key].append(squared_luma_errors(drawn, true)[covered])
            if circles is not None:
                beyond = covered if circle is None else covered & circle.outside(true.shape[1], true.shape[0])
                figures[key][-1]["psnr_outside"] = psnr(drawn, true, beyond)
    names = [stage.scene.rig.names[index] for index in chosen]
    rows = []
    for key in usable:
        row: dict[str, Any] = {"key": key, "title": TITLES[key], **summarise_scores(figures[key], names)}
        row["edge_share"] = share_near(errors[key], edges)
        row["edge_pixels"] = share_near([np.ones(len(one)) for one in edges], edges)
        rows.append({**row, "seconds": round(float(np.median(seconds[key])), 4)})
    return rows, notes


def _holes(stage: Stage, peers: Peers, chosen: Sequence[int]) -> float:
    """The part of the proxy's pixels in the held-out views that no encoded photograph sees."""
    surface, holes = 0, 0
    for index in chosen:
        _, on, unseen = draw_lumigraph(peers.lumigraph, stage.scene.rig.cameras[index])
        surface, holes = surface + int(on.sum()), holes + int(unseen.sum())
    return holes / max(surface, 1)


def _bytes(stage: Stage, peers: Peers, file: Path | None) -> dict[str, Any]:
    """What has to be kept for each way: all encoded photographs as they lie on the disk, or as AVIF, and the proxy as
    our file keeps it for the lumigraph; for ours the file."""
    packed = spread_over_array(stage.scene, [int(index) for index in peers.shown], AVIF_SAMPLE)
    places = [int(np.searchsorted(peers.shown, index)) for index in packed]
    avif = sum(_avif(peers.lumigraph.photograph(place)) for place in places)
    result: dict[str, Any] = {
        "photographs": sum(stage.capture.bytes(stage.views[int(index)]) for index in peers.shown),
        f"avif_{AVIF_QUALITY}": round(avif * len(peers.shown) / len(packed)),
        "avif_counted": f"{len(packed)} of {len(peers.shown)}, scaled up" if len(packed) < len(peers.shown) else "all",
    }
    if file is not None:
        result |= {"scene": file.stat().st_size, "mesh": parts(file)["mesh"]}
    return result


def _avif(photograph: NDArray[np.uint8]) -> int:
    buffer = io.BytesIO()
    Image.fromarray(photograph).save(buffer, "AVIF", quality=AVIF_QUALITY)
    return len(buffer.getvalue())
