"""Pictures of the report: the paper's figure 6, and crops of equal size beside each other."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.core.scene import Scene
from eigenfield.evaluation.session import start_session
from eigenfield.imaging.metrics import psnr, to_codes
from eigenfield.imaging.raster import rasterise_view
from eigenfield.rendering import Renderer
from evidence.between import TITLES, Peers, Stage, ways_of
from evidence.losses import own_maps
from evidence.prepared import Prepared, codes, drawn

Picture = NDArray[np.uint8]

ERROR_GAIN = 5  # the paper's heat maps are drawn so
WIDEST = 480  # pixels of a picture in the report
CROP = 96  # pixels of a photograph
ENLARGED = 2  # times, without a filter: pixels are what a crop shows
STRIP = 20  # pixels: height of a line of words on a sheet
WEBP = [cv2.IMWRITE_WEBP_QUALITY, 82]
LOSSLESS = [cv2.IMWRITE_WEBP_QUALITY, 101]  # OpenCV's word for lossless


def figure6(scene: Scene, prepared: Prepared, folder: Path) -> list[dict[str, Any]]:
    """For the reference camera and a corner one: photograph, proxy, drawn from the camera's own texture map (equation 2
    fills what it does not see), drawn from the eigen textures, and that one's error, times ERROR_GAIN."""
    session, renderer = start_session(scene, prepared.light_field), Renderer(scene)
    rows = []
    corner = int(scene.rig.encoded[0])
    for index in dict.fromkeys((scene.rig.reference, corner)):
        photograph = codes(prepared.light_field, session.photographs[index])
        own_map = own_maps(session, [index])[index]
        eigen, covered = drawn(renderer, scene, index)
        shown = {
            "photograph": photograph, "proxy": shaded(scene.proxy.mesh, scene, index), "own_map": own_map,
            "eigen": eigen, "error": heat(eigen, photograph, covered),
        }  # fmt: skip
        name = f"{prepared.capture.name}-figure6-{index}"
        rows.append(
            {
                "camera": scene.rig.names[index],
                **{key: write(picture, folder, f"{name}-{key}") for key, picture in shown.items()},
                "psnr_own": psnr(own_map, photograph, covered), "psnr_eigen": psnr(eigen, photograph, covered),
            }
        )  # fmt: skip
    return rows


def between_cameras(stage: Stage, peers: Peers, prepared: Prepared, folder: Path) -> list[dict[str, Any]]:
    """A held-out photograph, and what each way of `between` draws in its place: that nearest the array's centre."""
    scene = stage.scene
    held = np.flatnonzero(scene.rig.held_out)
    places = scene.rig.view_plane.coordinates([camera.centre for camera in scene.rig.cameras])
    index = int(held[np.argmin(np.linalg.norm(places[held], axis=1))])
    photograph = codes(prepared.light_field, stage.views[index])
    ways = ways_of(stage, peers)
    shown = {"photograph": photograph} | {
        TITLES[key]: to_codes(ways[key](index)) for key in ("nearest", "blend", "lumigraph", "delaunay")
    }
    return [
        {
            "label": label, "camera": scene.rig.names[index],
            "picture": write(picture, folder, f"{prepared.capture.name}-between-{number}"),
        }
        for number, (label, picture) in enumerate(shown.items())
    ]  # fmt: skip


def shaded(mesh: Mesh, scene: Scene, index: int) -> Picture:
    """The bare proxy from camera `index`, lit from the camera: grey by the angle of each triangle."""
    camera = scene.rig.cameras[index]
    face = rasterise_view(mesh, camera).face
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    away = corners.mean(axis=1) - camera.centre
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12)
    grey = (40 + 200 * np.abs((normal * away).sum(axis=1))).astype(np.uint8)
    picture = np.zeros((camera.height, camera.width, 3), np.uint8)
    seen = face >= 0
    picture[seen] = grey[face[seen], None]
    return picture


def heat(a: Picture, b: Picture, covered: NDArray[np.bool_]) -> Picture:
    """The mean error over the channels, times ERROR_GAIN, dark to bright; what no surface covers is black."""
    error = cv2.absdiff(a, b).mean(axis=2) * ERROR_GAIN
    picture = cv2.applyColorMap(error.clip(0, 255).astype(np.uint8), cv2.COLORMAP_INFERNO)[..., ::-1].copy()
    picture[~covered] = 0
    return picture


def busiest(
    photographs: list[Picture], others: list[Picture], count: int = 2, covered: NDArray[np.bool_] | None = None
) -> list[tuple[int, int]]:
    """Top-left corners of the CROP squares where `others` are farthest from the photographs, away from each other:
    where a judgement by eye has something to see. covered: (H, W), what counts; None: all."""
    error = sum(cv2.absdiff(a, b).astype(np.float32).mean(axis=2) for a, b in zip(photographs, others, strict=True))
    error = error if covered is None else error * covered
    score, side, corners = _squares(np.asarray(error, np.float32)), min(CROP, *np.shape(error)), []
    for _ in range(count):
        _, (row, column) = _largest(score)
        corners.append((row, column))
        score[max(0, row - side) : row + side, max(0, column - side) : column + side] = -1
    return corners


def largest_square(values: NDArray[np.float32]) -> tuple[float, tuple[int, int]]:
    """The largest mean over a CROP square of (H, W) values, and the square's top-left corner."""
    return _largest(_squares(values))


def _squares(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """The mean over the CROP square at each top-left corner that it may have."""
    side = min(CROP, *values.shape)
    score = cv2.boxFilter(values, -1, (side, side), anchor=(0, 0), borderType=cv2.BORDER_ISOLATED)
    return np.asarray(score, np.float32)[: values.shape[0] - side + 1, : values.shape[1] - side + 1].copy()


def _largest(score: NDArray[np.float32]) -> tuple[float, tuple[int, int]]:
    row, column = (int(value) for value in np.unravel_index(np.argmax(score), score.shape))
    return float(score[row, column]), (row, column)


def crop(picture: Picture, corner: tuple[int, int]) -> Picture:
    """The CROP square at `corner`, ENLARGED."""
    row, column = corner
    side = min(CROP, *picture.shape[:2])
    part = picture[row : row + side, column : column + side]
    return np.repeat(np.repeat(part, ENLARGED, axis=0), ENLARGED, axis=1)


def write_sheet(heads: Sequence[str], rows: Sequence[tuple[str, Sequence[Picture]]], place: Path) -> Path:
    """A PNG of pictures of one size in rows, each enlarged twice under its words, if any; heads: of the columns."""
    parts = []
    for words, row in rows:
        line = np.concatenate([np.repeat(np.repeat(picture, 2, axis=0), 2, axis=1) for picture in row], axis=1)
        parts += [_words(words, line.shape[1])] * bool(words) + [line]
    width = parts[-1].shape[1] // len(heads)
    head = np.concatenate([_words(text, width) for text in heads], axis=1)
    done, data = cv2.imencode(".png", np.ascontiguousarray(np.concatenate([head, *parts])[..., ::-1]))
    assert done
    place.write_bytes(data.tobytes())
    return place


def _words(text: str, width: int) -> Picture:
    """A strip of text."""
    strip = np.full((STRIP, width, 3), 255, np.uint8)
    cv2.putText(strip, text, (2, STRIP - 6), cv2.FONT_HERSHEY_SIMPLEX, 0.38, (0, 0, 0), 1, cv2.LINE_AA)
    return strip


def write(picture: Picture, folder: Path, name: str, exact: bool = False) -> str:
    """Write FOLDER/pictures/NAME.webp, at most WIDEST wide unless exact; its path within the folder."""
    place = folder / "pictures" / f"{name}.webp"
    if exact:
        return str(write_exact(picture, place).relative_to(folder))
    if picture.shape[1] > WIDEST:
        height = round(picture.shape[0] * WIDEST / picture.shape[1])
        picture = np.asarray(cv2.resize(picture, (WIDEST, height), interpolation=cv2.INTER_AREA), np.uint8)
    return str(_write(picture, place, WEBP).relative_to(folder))


def write_exact(picture: Picture, place: Path) -> Path:
    """Write every pixel as it is."""
    return _write(picture, place, LOSSLESS)


def read(place: Path) -> Picture:
    """What `write_exact` wrote."""
    found = cv2.imdecode(np.frombuffer(place.read_bytes(), np.uint8), cv2.IMREAD_COLOR)
    assert found is not None, place
    return np.ascontiguousarray(found[..., ::-1], np.uint8)


def _write(picture: Picture, place: Path, how: list[int]) -> Path:
    place.parent.mkdir(parents=True, exist_ok=True)
    done, data = cv2.imencode(".webp", np.ascontiguousarray(picture[..., ::-1]), how)
    assert done
    place.write_bytes(data.tobytes())
    return place
