"""The viewer and a scene as one HTML file."""

from __future__ import annotations

from pathlib import Path

from eigenfield.core.scene import Scene
from eigenfield.gltf import encode_scene, file_bytes, without_residual
from eigenfield.runtime.files import refuse_existing, write_bytes
from eigenfield.viewer.page import single_file


def write_page(
    scene: Scene,
    output: Path,
    *,
    title: str | None = None,
    metres_per_unit: float | None = None,
    overwrite: bool = False,
) -> None:
    """Write a page that opens by double click and needs no network: viewer and file in one.

    title: of the page, the output's name if None. metres_per_unit: metres in one unit of the capture, for headsets.
    Raises OutputError.
    """
    refuse_existing(output, overwrite)
    glb = without_residual(file_bytes(scene) or encode_scene(scene))
    data = single_file(glb, title=output.stem if title is None else title, metres_per_unit=metres_per_unit)
    write_bytes(output, data, overwrite=overwrite)
