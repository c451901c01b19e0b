"""Where the decibels go: photographs re-drawn from their own cameras, the losses switched off one after the other."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

import eigenfield as ef
from eigenfield.capture import LightField, match_photographs
from eigenfield.coding.pictures.quantise import basis_scale, is_photographic, mean_codes, mean_values, texture_codes
from eigenfield.core.appearance import Basis, Plane
from eigenfield.core.scene import Scene
from eigenfield.encoding.atlas import ATLAS_SIDE_CAP_TEXELS, Atlas, make_atlas
from eigenfield.encoding.spread import Spreader, make_spreader
from eigenfield.evaluation.image import covered_pixels
from eigenfield.evaluation.session import Session, start_session
from eigenfield.gltf import save
from eigenfield.imaging.metrics import PSNR_MAX_DECIBELS, psnr, psnr_luma, to_codes
from eigenfield.rendering import draw_texture
from eigenfield.rendering.picture import undo_colour
from eigenfield.rendering.software.drawing import make_surface, median_footprint
from evidence.displacement import LIMIT, displacement, moved_back
from evidence.prepared import spread_over_array

SAMPLE = 25  # cameras
ROOM = 1.5e9  # bytes of textures as float32 up to which a loss is also switched off alone
TITLES = {
    "file": "the file",
    "codec": "without the codec (8-bit codes)",
    "quantisation": "without quantisation (float textures)",
    "truncation": "without truncation (all components)",
    "resampling": "without resampling (texels twice as dense)",
}
WORDS = (
    "Encoded cameras, each drawn from its own viewpoint with its own weights, bicubic; covered pixels, 8 bits. mse is "
    "the mean over views in squared grey levels, share the part of the file's mse that goes away with the row's loss "
    "when those above it are gone already. What stays in the last row is visibility, coverage and 8 bits. Truncation "
    "holds what wrong geometry makes the maps differ by, as well as gloss."
)
DISPLACED = (
    "displacement: float textures, each picture moved towards its photograph by dense optical flow of at most "
    f"{LIMIT:g} px, measured again. control: the same on each camera's own map, where geometry plays no part: only a "
    "gain beyond that speaks of shifted surfaces, and what wrong geometry has blurred no shift brings back (on "
    "the demo, where the truth is known, a wrong mesh costs far more)."
)

Pictures = dict[int, NDArray[np.uint8]]


@dataclass(frozen=True, eq=False)
class Views:
    """What the drawn pictures are measured against: photographs and counted pixels by camera."""

    photographs: Pictures
    covered: Mapping[int, NDArray[np.bool_]]

    def measure(self, drawn: Pictures) -> dict[str, float]:
        """Means over the views, psnr_of_mse of the mean squared error; mse in squared grey levels."""
        errors, decibels, luma = [], [], []
        for index, true in self.photographs.items():
            covered = self.covered[index]
            if not covered.any():
                continue
            difference = drawn[index][covered].astype(np.float64) - true[covered]
            errors.append(float((difference**2).mean()))
            decibels.append(psnr(drawn[index], true, covered))
            luma.append(psnr_luma(drawn[index], true, covered))
        mse = float(np.mean(errors))
        return {
            "psnr": float(np.mean(np.array(decibels, float))),
            "psnr_luma": float(np.mean(np.array(luma, float))),
            "psnr_of_mse": PSNR_MAX_DECIBELS if mse == 0 else float(10 * np.log10(255**2 / mse)),
            "mse": mse,
        }


def losses(
    scene_file: Path, light_field: LightField, *, quality: int | None = None, alone: bool = True
) -> dict[str, Any]:
    """The ladder of losses under "rows", each loss switched off alone under "alone", shifts under "displacement".

    scene_file: as it was saved; how it was encoded is read from it, and it is encoded again in memory, uncoded.
    quality: of its AVIF pictures, for `alone`.
    """
    scene = ef.load(scene_file)
    capture = as_encoded(scene, light_field)
    chosen = spread_over_array(scene, scene.rig.encoded.tolist(), SAMPLE)
    session = start_session(scene, capture)
    views, drawn = _from_file(session, chosen)
    uncoded = encode_again(scene, capture)
    rungs = {"file": views.measure(drawn)}
    rungs["codec"] = views.measure(_draw(start_session(rounded_to_codes(uncoded), capture), chosen))
    exact = start_session(uncoded, capture)
    without = _draw(exact, chosen)
    rungs["quantisation"] = views.measure(without)
    own = own_maps(exact, chosen)
    rungs["truncation"] = views.measure(own)
    note = f" The atlas has {_side(scene)} texels a side: resampling was not separated."
    if _side(scene) < ATLAS_SIDE_CAP_TEXELS:
        note = ""
        rungs["resampling"] = views.measure(own_maps(denser(exact), chosen))
    result = {
        "cameras": len(chosen),
        "rows": ladder(rungs),
        "displacement": {**shifts(views, without), "control": shifts(views, own)},
        "words": f"{WORDS} {DISPLACED}{note}",
    }
    if alone:
        result["alone"] = _alone(scene, capture, views, rungs, quality)
    return result


def ladder(rungs: Mapping[str, Mapping[str, float]]) -> list[dict[str, Any]]:
    """Rows in the order of `rungs`: gain in dB over the row above (of mean squared errors), and share of the first
    row's mse that went; the last row is what stays. The shares sum to 1."""
    keys = list(rungs)
    total = rungs[keys[0]]["mse"]
    rows: list[dict[str, Any]] = [{"key": keys[0], "title": TITLES[keys[0]], **rungs[keys[0]]}]
    for before, key in pairwise(keys):
        gone = rungs[before]["mse"] - rungs[key]["mse"]
        rows.append(
            {
                "key": key,
                "title": TITLES[key],
                **rungs[key],
                "gain": rungs[key]["psnr_of_mse"] - rungs[before]["psnr_of_mse"],
                "share": gone / total if total else 0.0,
            }
        )
    left = rungs[keys[-1]]
    rows.append({"key": "left", "title": "what stays", **left, "share": left["mse"] / total if total else 1.0})
    return rows


def as_encoded(scene: Scene, light_field: LightField) -> LightField:
    """The scene's cameras in its order, with their photographs. Raises ValueError where an encoded one has none."""
    found = match_photographs(scene, light_field)
    missing = [scene.rig.names[index] for index in range(len(scene.rig.names)) if index not in found]
    if missing:
        raise ValueError(f"{missing[0]} has no photograph here: the scene cannot be encoded again")
    views = [replace(light_field.views[found[i]], camera=camera) for i, camera in enumerate(scene.rig.cameras)]
    return replace(light_field, views=tuple(views), layout=None)


def encode_again(
    scene: Scene, capture: LightField, textures: int | None = None, atlas: tuple[int, int] | None = None
) -> Scene:
    """The scene as `encode` makes it, before coding, with the options that it records; others where asked for."""
    height, width = scene.appearance.planes[0].mean.shape[:2]
    held = [scene.rig.names[index] for index in np.flatnonzero(scene.rig.held_out)]
    return ef.encode(
        capture,
        scene.proxy.mesh,
        textures=scene.appearance.textures if textures is None else textures,
        atlas=(width, height) if atlas is None else atlas,
        align=scene.settings.get("align") is not None,
        reference=scene.rig.names[scene.rig.reference],
        hold_out=",".join(held) or None,
        harmonise=scene.settings.get("harmonise"),
        fit="none",
    )


def rounded_to_codes(scene: Scene) -> Scene:
    """The scene with means and textures as 8-bit codes, as a lossless file keeps them."""
    planes, harmonised = [], scene.appearance.colours is not None  # colours brought together may lie beyond 0..1
    for plane in scene.appearance.planes:
        mean = mean_values(*mean_codes(plane.mean, harmonised))
        bases = []
        for basis in plane.bases:
            scale, zero = basis_scale(basis, harmonised or is_photographic(plane.mean))
            codes = [texture_codes(basis, index, scale, zero) for index in range(basis.count)]
            stored = np.stack(codes) if codes else basis.textures
            bases.append(Basis(stored, scale, zero, basis.weights))
        planes.append(Plane(mean, tuple(bases)))
    return replace(scene, appearance=replace(scene.appearance, planes=tuple(planes)))


def own_maps(session: Session, chosen: Sequence[int]) -> Pictures:
    """Each camera drawn from its own texture map T(c), filled with the mean where it does not see (equation 2): what
    all components together give back."""
    assert session.atlas is not None
    atlas, scene, colours = session.atlas, session.scene, session.scene.appearance.colours
    gutter = make_spreader(atlas, np.ones(atlas.count, bool))
    mean = mean_at(scene.appearance.planes[0].mean, atlas)
    surface = make_surface(scene.proxy.mesh, atlas.height, atlas.width)
    detail = median_footprint(surface, scene.rig.cameras[scene.rig.reference])
    pictures = {}
    for index in chosen:
        camera = scene.rig.cameras[index]
        values, seen = session.texture(index, session.photograph(index))
        texture = _whole(gutter, np.where(seen[:, None] > 0, values, mean))
        drawn = draw_texture(scene.proxy.mesh, texture, camera, detail=detail)  # sampled as the renderer does
        image = drawn.image
        if colours is not None:
            image = undo_colour(image, drawn.coverage, np.zeros(3, np.float32), colours[index])
        pictures[index] = to_codes(image)
    return pictures


def denser(session: Session) -> Session:
    """The same session on an atlas of twice the side, at most ATLAS_SIDE_CAP_TEXELS."""
    assert session.atlas is not None
    factor = min(2.0, ATLAS_SIDE_CAP_TEXELS / max(session.atlas.width, session.atlas.height))
    width, height = round(session.atlas.width * factor), round(session.atlas.height * factor)
    finer = replace(session, reference=None, atlas=make_atlas(session.scene.proxy.mesh, width, height))
    if session.reference is None:
        return finer
    reference = finer.scene.rig.reference
    return replace(finer, reference=finer.texture(reference, finer.photograph(reference)))


def mean_at(mean: NDArray[np.float32], atlas: Atlas) -> NDArray[np.float32]:
    """(n, C) a mean texture at the chart texels of an atlas of its own or another size."""
    if mean.shape[:2] != (atlas.height, atlas.width):
        mean = np.asarray(cv2.resize(mean, (atlas.width, atlas.height), interpolation=cv2.INTER_CUBIC), np.float32)
    return mean.reshape(-1, mean.shape[2])[atlas.texel]


def shifts(views: Views, drawn: Pictures) -> dict[str, float]:
    """Figures of pictures moved towards their photographs: those of `Views.measure`, gain in dB over the pictures as
    they were, share of their squared error that went, and the median length of the shift in pixels."""
    moved: Pictures = {}
    lengths = []
    for index, true in views.photographs.items():
        covered = views.covered[index]
        flow = displacement(drawn[index], true, covered)
        lengths.append(np.linalg.norm(flow, axis=2)[covered])
        moved[index] = moved_back(drawn[index], flow, covered)
    before, after = views.measure(drawn), views.measure(moved)
    every = np.concatenate(lengths)
    return {
        **_gained(before, after),
        "median_px": float(np.median(every)),
        "p95_px": float(np.percentile(every, 95)),
    }


def _whole(gutter: Spreader, values: NDArray[np.float32]) -> NDArray[np.float32]:
    """(H, W, C) with charts and gutters; no tap reaches beyond."""
    picture = gutter.atlas.image(values)
    flat = picture.reshape(-1, values.shape[1])
    flat[gutter.gutter] = flat[gutter.nearest]
    return picture


def _from_file(session: Session, chosen: Sequence[int]) -> tuple[Views, Pictures]:
    photographs, covered, drawn = {}, {}, {}
    for index in chosen:
        photograph = session.photograph(index)
        picture = session.picture(index)
        photographs[index] = to_codes(photograph.pixels)
        covered[index] = covered_pixels(picture.covered, photograph.mask)
        drawn[index] = to_codes(picture.image)
    return Views(photographs, covered), drawn


def _draw(session: Session, chosen: Sequence[int]) -> Pictures:
    return {index: to_codes(session.picture(index).image) for index in chosen}


def _side(scene: Scene) -> int:
    return max(scene.appearance.planes[0].mean.shape[:2])


def _alone(
    scene: Scene, capture: LightField, views: Views, rungs: Mapping[str, Mapping[str, float]], quality: int | None
) -> list[dict[str, Any]]:
    """Each loss switched off from the whole pipeline, all others on."""
    height, width, channels = scene.appearance.planes[0].mean.shape
    plans = {
        "truncation": ("all components, coded", {"textures": len(scene.rig.encoded) - 1}, len(scene.rig.encoded) - 1),
        "resampling": (
            "texels twice as dense, coded",
            {"atlas": (2 * width, 2 * height)},
            4 * scene.appearance.textures,
        ),
    }
    rows: list[dict[str, Any]] = [
        {"key": "quantisation", "title": "float textures", **_gained(rungs["file"], rungs["quantisation"])}
    ]
    for key, (title, options, textures) in plans.items():
        row: dict[str, Any] = {"key": key, "title": title}
        if textures * height * width * channels * 4 > ROOM or (
            key == "resampling" and 2 * _side(scene) > ATLAS_SIDE_CAP_TEXELS
        ):
            rows.append({**row, "left_out": "too large to encode again"})
            continue
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.glb"
            save(encode_again(scene, capture, **options), path, codec="avif", quality=quality)  # type: ignore[arg-type]
            figures = views.measure(_draw(start_session(ef.load(path), capture), list(views.photographs)))
            rows.append({**row, **_gained(rungs["file"], figures), "bytes": path.stat().st_size})
    return rows


def _gained(before: Mapping[str, float], after: Mapping[str, float]) -> dict[str, float]:
    return {
        **after,
        "gain": after["psnr_of_mse"] - before["psnr_of_mse"],
        "share": 1 - after["mse"] / before["mse"] if before["mse"] else 0.0,
    }
