"""The photographs of a scene: found by name, with the scene's cameras where they have none of their own."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.lightfield import LightField
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photographs.read import read_header
from eigenfield.capture.photoset import Capture, Shot
from eigenfield.core.camera import Camera
from eigenfield.core.camera_names import name_stem
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.scene import Scene

log = logging.getLogger(__name__)

SCENE_LENS_MODELS = ("brown", "fisheye", "rational", "metashape", "metashape-equidistant", "metashape-equisolid")
SCENE_MAX_CALIBRATION_PIXELS = 0.5  # two calibrations may differ by this much without a warning
SCENE_MAX_DISTANCE_RATIO = 0.1  # of the mean distance of two cameras, by which that of any two may differ


def with_scene_cameras(scene: Scene, photographs: Capture) -> LightField:
    """A light field as it is, or photographs without a calibration with the scene's cameras and lenses, by name; linear
    values with the scene's exposure.

    Photographs are turned by their EXIF orientation if those that were encoded were.

    Raises:
        CaptureError: `no-photographs`: no name fits.
        OptionError: `settings-unknown`.
    """
    record = scene.provenance
    if record.exposure is not None:
        photographs = photographs.with_exposure(record.exposure)
    if photographs.light_field is not None:
        return photographs.light_field
    index = {photograph: camera for camera, photograph in _same_names(scene, photographs.names).items()}
    chosen, numbers = photographs.subset(sorted(index)), [index[photograph] for photograph in sorted(index)]
    if not len(chosen):
        raise _no_photographs(scene, photographs.root, photographs.names)
    lenses = _recorded_lenses(scene)
    cameras = [scene.rig.cameras[number] for number in numbers]
    marked = [number in record.as_stored for number in numbers]
    shots = tuple(_orient(*known) for known in zip(chosen.shots, cameras, marked, strict=True))
    return replace(chosen, shots=shots).with_cameras(cameras, [lenses[number] for number in numbers])


def _orient(shot: Shot, camera: Camera, stored: bool) -> Shot:
    """The photograph turned as the scene has it: by its camera's size, and where both ways fit by its record."""
    header, size = read_header(shot.path), (camera.width, camera.height)
    if header.stored_size == size and (stored or header.upright_size != size):
        return replace(shot, upright=False, width=camera.width, height=camera.height)
    return shot


def _recorded_lenses(scene: Scene) -> list[Lens | None]:
    recorded = scene.provenance.lenses
    if recorded == ():
        return [None] * len(scene.rig.names)
    remedy = "name the --calibration"
    if recorded is None:
        raise OptionError("settings-unknown", "the scene's record of its lenses cannot be read", remedy=remedy)
    known = all(lens is None or lens[0] in SCENE_LENS_MODELS for lens in recorded)
    if len(recorded) != len(scene.rig.names) or not known:
        raise OptionError("settings-unknown", "the scene records lenses that do not fit its cameras", remedy=remedy)
    return [None if lens is None else Lens(*lens) for lens in recorded]


def _no_photographs(scene: Scene, root: Path, names: Sequence[str]) -> CaptureError:
    return CaptureError(
        "no-photographs",
        f"no photograph has the name of a camera of the scene (here {names[0] if names else 'none'}, there "
        f"{scene.rig.names[0]})",
        path=root,
        remedy="evaluate with the capture that was encoded",
    )


def match_photographs(scene: Scene, capture: LightField) -> dict[int, int]:
    """The view of the capture for each scene camera, by name; where no name has its ending, by the name without it.

    Raises:
        CaptureError: `no-photographs`: no name fits.
    """
    photographs = _same_names(scene, capture.names)
    if not photographs:
        raise _no_photographs(scene, capture.root, capture.names)
    other = _other_calibration(scene, capture, photographs)
    if other is not None:
        log.warning(
            "%s: the capture's calibration is not the one that was encoded; the scene's own cameras are used",
            scene.rig.names[other],
        )
    return photographs


def _other_calibration(scene: Scene, capture: LightField, photographs: dict[int, int]) -> int | None:
    """A camera of the scene that has another lens, or another place among the others, in the capture."""
    pairs = [(scene.rig.cameras[index], capture.views[view].camera) for index, view in photographs.items()]
    lenses = [np.abs(ours.K - theirs.K).max() > SCENE_MAX_CALIBRATION_PIXELS for ours, theirs in pairs]
    ours, theirs = (_relative_distances(np.array([one.centre for one in side])) for side in zip(*pairs, strict=True))
    off = np.abs(ours - theirs)
    if any(lenses):
        return [*photographs][int(np.argmax(lenses))]
    return [*photographs][int(off.sum(axis=1).argmax())] if off.max() > SCENE_MAX_DISTANCE_RATIO else None


def _relative_distances(centres: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, n) between the cameras, in their mean: the same in every world and at every scale."""
    distances = np.linalg.norm(centres[:, None] - centres[None], axis=2)
    return distances / max(float(distances.mean()), 1e-300)


def _same_names(scene: Scene, names: Sequence[str]) -> dict[int, int]:
    """The photograph of each scene camera, by index: of the same name, or else the only one of the same stem, if its
    name is no other camera's."""
    whole = {name: index for index, name in enumerate(names)}
    free = [name for name in names if name not in set(scene.rig.names)]
    stems = Counter(map(name_stem, free)), Counter(name_stem(name) for name in scene.rig.names if name not in whole)
    once = [name for name in free if stems[0][name_stem(name)] == stems[1][name_stem(name)] == 1]
    by_stem = {name_stem(name): whole[name] for name in once}
    found = {index: whole.get(name, by_stem.get(name_stem(name))) for index, name in enumerate(scene.rig.names)}
    return {index: photograph for index, photograph in found.items() if photograph is not None}
