"""Agisoft Metashape's camera XML (File > Export > Export Cameras; also PhotoScan's).

`<camera>` holds a 4 x 4 camera-to-world matrix, x right, y down, z forward, in the chunk's own units; the `<transform>`
of its component (else the chunk's) takes that to the world in which Metashape exports meshes: x = s R x_chunk + T.
`<sensor>` holds the size, f, b1, b2, cx, cy (**from the middle of the photograph**), k1..k4, p1..p4 of the manual's
appendix "Camera models": fx = f + b1, fy = f, skew b2; **p1 and p2 are exchanged against OpenCV's**; pixel centres at
+0.5. PhotoScan before 1.2 wrote fx, fy, skew, cx, cy from the corner, and p1, p2 as OpenCV.

A camera of a multi-camera system has no matrix but `master_id`, another camera, and its sensor the offset
x_camera = R x_master + t in the chunk's units (`<rotation>`, `<translation>`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import (
    CALIBRATION_MAX_MAGNITUDE,
    Calibration,
    Entry,
    Intrinsics,
    or_error,
    read_each,
    split_scale,
)
from eigenfield.capture.messages import describe
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.lens_keys import refuse_lens_keys
from eigenfield.capture.readers.skew import SKEW_MAX_RATIO, SKEW_NEGLIGIBLE_RATIO
from eigenfield.capture.readers.text import (
    check_finite,
    check_lens,
    check_size,
    damaged_error,
    excerpt,
    parse_numbers,
    read_head,
)
from eigenfield.capture.readers.xml_tree import load_xml
from eigenfield.core.errors import CaptureError, one_line

METASHAPE_FILES = ("cameras.xml", "camera.xml", "metashape.xml")  # then any other, in name order
METASHAPE_HEAD_BYTES = 4096  # in which <document> and <chunk> must stand
METASHAPE_LENS_MODELS = {
    "frame": "metashape",
    "fisheye": "metashape-equidistant",
    "equidistant_fisheye": "metashape-equidistant",
    "equisolid_fisheye": "metashape-equisolid",
}
METASHAPE_PARAMETERS = {
    "f", "fx", "fy", "cx", "cy", "b1", "b2", "skew", "k1", "k2", "k3", "k4", "p1", "p2", "p3", "p4"
}  # fmt: skip
METASHAPE_ROTATION_TOLERANCE = 1e-4


@dataclass(frozen=True, eq=False)
class _Frame:
    """A similarity transform: x_world = scale rotation x_chunk + shift.

    Attributes:
        rotation: (3, 3).
        shift: (3,) world units.
        scale: World units in one unit of the chunk.
    """

    rotation: NDArray[np.float64]
    shift: NDArray[np.float64]
    scale: float


def find_metashape(folder: Path) -> Path | None:
    """A Metashape camera file in a folder: `cameras.xml` first, then the first `*.xml` that begins as one."""
    for path in (*(folder / name for name in METASHAPE_FILES), *sorted(folder.glob("*.xml"))):
        head = read_head(path, METASHAPE_HEAD_BYTES) if path.is_file() else b""
        if b"<document" in head and b"<chunk" in head:
            return path
    return None


def read_metashape(path: Path) -> Calibration:
    """Every aligned and enabled camera as an entry; the others are named in `problems`.

    Raises CaptureError (`calibration-missing`, `calibration-too-large`, `xml-doctype`, `calibration-damaged`,
    `calibration-empty`) where the file as a whole cannot be used; cameras that cannot become errors of their own.
    """
    chunk, problems = _find_chunk(load_xml(path), path)
    cameras = [camera for camera in chunk.iterfind("cameras") for camera in camera.iter("camera")]
    if not cameras:
        raise CaptureError("calibration-empty", "lists no camera", path=path, remedy="name another calibration")
    frames = _read_frames(chunk, path)
    by_number = {camera.get("id", ""): camera for camera in cameras}
    owners = {camera: _pose_owner(camera, by_number) for camera in cameras}
    usable, left_out = _split_usable(owners, frames)
    sensors = {sensor.get("id", ""): sensor for sensor in chunk.iterfind("sensors/sensor")}
    lenses: dict[str, tuple[Intrinsics, Lens | None] | CaptureError] = {}

    def make_entry(camera: Element) -> Entry:
        number = camera.get("sensor_id", next(iter(sensors)) if len(sensors) == 1 else "")
        if number not in lenses:
            lenses[number] = or_error(partial(_read_calibration, number=number, path=path))(sensors.get(number))
        owner = owners[camera]
        assert owner is not None, "such a camera is not usable"
        pose = _read_pose(owner, path)
        if owner is not camera:
            pose = pose @ np.linalg.inv(_read_offset(sensors.get(number), _camera_label(camera), path))
        return _make_entry(camera, lenses[number], pose, _frame_of(owner, frames), path)

    entries, errors = read_each(make_entry, usable)
    return Calibration(path, "metashape", entries, errors, (*problems, *left_out))


def _find_chunk(root: Element, path: Path) -> tuple[Element, list[str]]:
    chunks = [root] if root.tag == "chunk" else root.findall("chunk")
    if not chunks:
        raise damaged_error(path, "has no <chunk>", "name the file of Metashape's Export Cameras, Agisoft XML")
    chosen = max(chunks, key=lambda chunk: len(chunk.findall("cameras//camera")))
    others = len(chunks) - 1
    return chosen, [f"{others} other chunks of {path.name} are not read"] if others else []


def _camera_label(camera: Element) -> str:
    return one_line(camera.get("label") or f"camera {excerpt(camera.get('id', '?'))}")


def _pose_owner(camera: Element, by_number: Mapping[str, Element]) -> Element | None:
    """The camera that has the matrix: itself, or its system's master; None where neither was aligned."""
    if camera.find("transform") is not None:
        return camera
    number = camera.get("master_id")
    master = None if number is None else by_number.get(number)
    return None if master is None or master.find("transform") is None else master


def _split_usable(
    owners: Mapping[Element, Element | None], frames: dict[str, _Frame]
) -> tuple[list[Element], list[str]]:
    """Enabled and aligned cameras that share a frame, and lines that name the others."""
    disabled = [c for c in owners if c.get("enabled", "true").lower() in ("false", "0")]
    enabled = [c for c in owners if c not in set(disabled)]
    lost = [c for c in enabled if owners[c] is None]
    aligned = [c for c in enabled if c not in set(lost)]
    problems = [*_describe_cameras(disabled, "disabled"), *_describe_cameras(lost, "not aligned")]

    def component(camera: Element) -> str:
        owner = owners[camera]
        return "" if owner is None else owner.get("component_id", "")

    components = Counter(map(component, aligned))
    if len(components) > 1 and not all(number in frames for number in components):
        largest = max(components, key=lambda number: components[number])
        apart = [c for c in aligned if component(c) != largest]
        where = f"in another component than the largest ({excerpt(largest)}) without a common frame"
        problems += _describe_cameras(apart, where)
        aligned = [c for c in aligned if component(c) == largest]
    return aligned, problems


def _describe_cameras(cameras: list[Element], what: str) -> list[str]:
    return describe([_camera_label(camera) for camera in cameras], "camera is", "cameras are", what)


def _read_frames(chunk: Element, path: Path) -> dict[str, _Frame]:
    """The frame of each component that has one by its id, and the chunk's under the name "chunk"."""
    frames = {}
    for component in chunk.iterfind("components/component"):
        transform = component.find("transform")
        if transform is not None:
            number = component.get("id", "")
            frames[number] = _read_frame(transform, f"component {excerpt(number)}", path)
    transform = chunk.find("transform")
    if transform is not None:
        frames["chunk"] = _read_frame(transform, "the chunk", path)
    return frames


def _frame_of(camera: Element, frames: dict[str, _Frame]) -> _Frame:
    fallback = frames.get("chunk", _Frame(np.eye(3), np.zeros(3), 1.0))
    return frames.get(camera.get("component_id", ""), fallback)


def _read_frame(transform: Element, label: str, path: Path) -> _Frame:
    words = (transform.text or "").split()
    if words:  # PhotoScan before 1.0 wrote one matrix
        matrix = parse_numbers(words, 16, f"the transform of {label}", path).reshape(4, 4)
        linear, shift = matrix[:3, :3], matrix[:3, 3]
        with np.errstate(all="ignore"):
            scale = float(np.cbrt(np.linalg.det(linear)))
    else:
        parts = {part.tag: (part.text or "").split() for part in transform}
        words = parts.get("rotation", list("100010001"))
        linear = parse_numbers(words, 9, f"the rotation of {label}", path).reshape(3, 3)
        shift = parse_numbers(parts.get("translation", list("000")), 3, f"the translation of {label}", path)
        scale = float(parse_numbers(parts.get("scale", ["1"]), 1, f"the scale of {label}", path)[0])
        with np.errstate(all="ignore"):
            linear = linear * scale
    check_finite([linear, shift], f"the transform of {label}", path)
    with np.errstate(all="ignore"):
        rotation, grown = split_scale(linear / scale)
        fits = (
            grown == 1
            and 0 < scale < CALIBRATION_MAX_MAGNITUDE
            and np.allclose(rotation @ rotation.T, np.eye(3), atol=METASHAPE_ROTATION_TOLERANCE)
        )
    if not fits:
        message = f"the transform of {label} is not a rotation, a shift and a positive scale"
        raise damaged_error(path, message, "mend it")
    return _Frame(rotation, shift, scale)


def _read_pose(camera: Element, path: Path) -> NDArray[np.float64]:
    """(4, 4) camera to chunk."""
    label, words = _camera_label(camera), (camera.findtext("transform") or "").split()
    matrix = parse_numbers(words, 16, f"the transform of {label}", path).reshape(4, 4)
    check_finite([matrix], label, path)
    if not np.allclose(matrix[3], [0, 0, 0, 1], atol=1e-6):
        raise damaged_error(path, f"the last row of the transform of {label} is not 0 0 0 1", "mend or remove it")
    return matrix


def _read_offset(sensor: Element | None, label: str, path: Path) -> NDArray[np.float64]:
    """(4, 4) from the master's axes to those of a camera of its system, as the camera's sensor states it."""
    rotation, shift = (None if sensor is None else sensor.findtext(tag) for tag in ("rotation", "translation"))
    if rotation is None:
        raise CaptureError(
            "metashape-rig",
            f"{label} belongs to a multi-camera system and has no transform, nor its sensor an offset to the master",
            path=path,
            remedy="make its cameras single ones in Metashape before exporting, or export another format",
        )
    offset = np.eye(4)
    turn = parse_numbers(rotation.split(), 9, f"the rotation of the sensor of {label}", path).reshape(3, 3)
    offset[:3, :3], grown = split_scale(turn)
    if shift is not None:
        offset[:3, 3] = parse_numbers(shift.split(), 3, f"the translation of the sensor of {label}", path)
    check_finite([offset], label, path)
    straight = np.allclose(offset[:3, :3] @ offset[:3, :3].T, np.eye(3), atol=METASHAPE_ROTATION_TOLERANCE)
    if grown != 1 or not straight:
        raise damaged_error(path, f"the rotation of the sensor of {label} is none", "export the cameras again")
    return offset


def _make_entry(
    camera: Element,
    sensor: tuple[Intrinsics, Lens | None] | CaptureError,
    matrix: NDArray[np.float64],
    frame: _Frame,
    path: Path,
) -> Entry:
    label, name = _camera_label(camera), camera.get("label")
    if not name:
        raise damaged_error(path, f"{label} has no label, which names its photograph", "mend or remove it")
    if isinstance(sensor, CaptureError):
        raise CaptureError(sensor.code, f"{label}: {sensor.message}", path=path, remedy=sensor.remedy)
    axes = frame.rotation @ matrix[:3, :3]
    with np.errstate(over="ignore", invalid="ignore"):
        centre = frame.scale * (frame.rotation @ matrix[:3, 3]) + frame.shift
    check_finite([centre], label, path)
    return Entry(name.replace("\\", "/"), label, sensor[0], axes.T, centre, sensor[1], stored=True)


def _read_calibration(sensor: Element | None, number: str, path: Path) -> tuple[Intrinsics, Lens | None]:
    label = f"sensor {excerpt(number)}"
    if sensor is None:
        raise damaged_error(path, f"{label} is not listed", "export the cameras again")
    calibrations = sensor.findall("calibration")
    if not calibrations:
        raise CaptureError(
            "camera-model", f"{label} has no calibration", path=path, remedy="align the photographs in Metashape first"
        )
    calibration = next((c for c in calibrations if c.get("class") == "adjusted"), calibrations[0])
    kind = calibration.get("type", sensor.get("type", "frame")).lower()
    if kind not in METASHAPE_LENS_MODELS:
        raise CaptureError(
            "camera-model",
            f"{label} has the camera type {excerpt(kind)!r}, which is not read",
            path=path,
            remedy=f"use one of {', '.join(METASHAPE_LENS_MODELS)}, or undistort the photographs",
        )
    width, height = _read_size(calibration, sensor, label, path)
    refuse_lens_keys({part.tag: part.text for part in calibration}, METASHAPE_PARAMETERS, label, path)
    values = {part.tag: _read_number(part, label, path) for part in calibration if part.tag in METASHAPE_PARAMETERS}
    if "f" in values:
        fx, fy = values["f"] + values.get("b1", 0.0), values["f"]
        cx, cy = width / 2 + values.get("cx", 0.0), height / 2 + values.get("cy", 0.0)
        skew, p1, p2 = values.get("b2", 0.0), values.get("p1", 0.0), values.get("p2", 0.0)
    elif "fx" in values:
        fx, fy = values["fx"], values.get("fy", values["fx"])
        cx, cy = values.get("cx", width / 2), values.get("cy", height / 2)
        skew, p1, p2 = values.get("skew", 0.0), values.get("p2", 0.0), values.get("p1", 0.0)
    else:
        raise damaged_error(path, f"{label} has no focal length <f>", "export the cameras again")
    check_finite([fx, fy, cx, cy, skew], label, path)
    if not (fx > 0 and fy > 0 and abs(skew) <= SKEW_MAX_RATIO * fx):
        raise CaptureError(
            "camera-focal",
            f"{label} has a focal length of {fx:g} x {fy:g} and a skew of {skew:g}",
            path=path,
            remedy="mend it, or export the cameras again",
        )
    radial = [values.get(key, 0.0) for key in ("k1", "k2", "k3", "k4")]
    coefficients = (*radial, p1, p2, values.get("p3", 0.0), values.get("p4", 0.0), skew / fx)
    check_lens(coefficients, label, path)
    return Intrinsics(width, height, (fx, fy), None, (cx, cy)), _make_lens(METASHAPE_LENS_MODELS[kind], coefficients)


def _read_number(part: Element, label: str, path: Path) -> float:
    return float(parse_numbers((part.text or "").split(), 1, f"<{part.tag}> of {label}", path)[0])


def _read_size(calibration: Element, sensor: Element, label: str, path: Path) -> tuple[int, int]:
    for owner in (calibration, sensor):
        resolution = owner.find("resolution")
        if resolution is not None:
            words = [resolution.get("width", ""), resolution.get("height", "")]
            width, height = parse_numbers(words, 2, f"the resolution of {label}", path)
            return check_size(width, height, label, path)
    raise damaged_error(path, f"{label} has no <resolution>", "export the cameras again")


def _make_lens(model: str, coefficients: tuple[float, ...]) -> Lens | None:
    """As OpenCV's model where it is one, since other tools know that."""
    k1, k2, k3, k4, p1, p2, p3, p4, skew = coefficients
    plain = abs(skew) < SKEW_NEGLIGIBLE_RATIO
    if model == "metashape" and plain and not (k4 or ((p1 or p2) and (p3 or p4))):
        lens = Lens("brown", (k1, k2, p2, p1, k3))
        return None if lens.is_identity else lens
    if model == "metashape-equidistant" and plain and not (p1 or p2):
        return Lens("fisheye", (k1, k2, k3, k4))
    return Lens(model, coefficients)  # type: ignore[arg-type]
