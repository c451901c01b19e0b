"""The limits of the format, checked before a scene is written."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from pathlib import Path

from eigenfield.coding import limits
from eigenfield.coding.stacking import picture_size
from eigenfield.core.errors import FormatError, OutputError
from eigenfield.core.scene import Scene
from eigenfield.gltf.strict_json import is_printable


def check_writable(scene: Scene, path: Path | None) -> None:
    """Check a scene against the limits of every reader.

    Raises:
        OutputError: `scene-limit`, `camera-name`, `scene-values`.
        FormatError: `sheets-opacity`.
    """

    def refuse(what: str) -> None:
        raise OutputError("scene-limit", f"a file cannot hold {what}", path=path, remedy="make the scene smaller")

    def check_size(shape: tuple[int, ...], channels: int) -> None:
        height, width = shape
        w, h = picture_size(width, height, channels)
        if max(width, height) > limits.MAX_SIDE or h > limits.MAX_STACKED or w * h > limits.MAX_TEXELS:
            refuse(f"a picture of {w}x{h}")

    for plane in scene.appearance.planes:
        channels = plane.mean.shape[2]
        if channels > limits.MAX_CHANNELS:
            refuse(f"{channels} channels")
        for shape in [plane.mean.shape[:2], *(basis.textures.shape[1:3] for basis in plane.bases)]:
            check_size(shape, channels)
    sheets = scene.proxy.sheets
    if sheets is not None:
        if sheets.opacity.ndim != 2 or not ((sheets.opacity >= 0) & (sheets.opacity <= 1)).all():
            message = "an opacity is a picture of one number in 0 to 1 for each texel"
            raise FormatError("sheets-opacity", message, where="/sheets/opacity", path=path)
        check_size(sheets.opacity.shape, 1)
    bases = [basis for plane in scene.appearance.planes for basis in plane.bases]
    means = 4 * sum(plane.mean.size for plane in scene.appearance.planes)
    decoded = means + sum(math.prod(basis.textures.shape) for basis in bases)
    counts: Iterable[tuple[int, int, str]] = [
        (len(scene.rig.cameras), limits.MAX_CAMERAS, "cameras"),
        (sum(basis.count for basis in bases), limits.MAX_COMPONENTS, "eigen textures"),
        (len(scene.appearance.planes), limits.MAX_PLANES, "planes"),
        (max(len(plane.bases) for plane in scene.appearance.planes), limits.MAX_BASES, "bases"),
        (decoded, limits.MAX_DECODED, "decoded bytes"),
        (len(scene.proxy.mesh.vertices), limits.MAX_VERTICES, "vertices"),
        (len(scene.proxy.mesh.faces), limits.MAX_TRIANGLES, "triangles"),
        (0 if sheets is None else len(sheets.faces), limits.MAX_SHEETS, "sheets"),
        (max((basis.weights.size for basis in bases), default=0), limits.MAX_WEIGHTS, "weights"),
    ]
    for count, most, name in counts:
        if count > most:
            refuse(f"{count} {name}")
    for name, values in (("settings", scene.settings), ("scores", scene.scores)):
        try:
            json.dumps(values, allow_nan=False, ensure_ascii=False).encode()
        except (TypeError, ValueError, RecursionError) as error:  # of texts, UnicodeEncodeError
            message, remedy = f"{name} are no JSON: {error}", "use plain numbers, texts, lists and dictionaries"
            raise OutputError("scene-values", message, path=path, remedy=remedy) from None
    for name in scene.rig.names:
        if len(name) > limits.MAX_NAME or not is_printable(name):
            message = f"the name {name!r} cannot be kept"
            raise OutputError("camera-name", message, path=path, remedy="rename the photograph")
