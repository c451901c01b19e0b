"""The viewer and a scene as one HTML file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from eigenfield.core.scene import Scene
from eigenfield.gltf import encode_scene
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
    """Write a page that opens by double click and needs no network: viewer and scene in one file.

    The residual, which the viewer does not show, is left out. Payloads are not coded anew.

    Args:
        scene: The scene.
        output: The .html.
        title: Of the page. Default: the output's name.
        metres_per_unit: Metres in one unit of the capture, for headsets.
        overwrite: Whether an existing file is replaced.

    Raises:
        OutputError: `viewer-build`; the file cannot be written.
    """
    refuse_existing(output, overwrite)
    glb = encode_scene(replace(scene, residual=None))
    data = single_file(glb, title=output.stem if title is None else title, metres_per_unit=metres_per_unit)
    write_bytes(output, data, overwrite=overwrite)
