"""Gaussians as a .glb with `KHR_gaussian_splatting`, or as an .spz."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from eigenfield.core.arguments import checked
from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress
from eigenfield.core.rights import Rights
from eigenfield.core.scene import Scene, scale_of
from eigenfield.core.version import __version__
from eigenfield.gltf.accessors import FLOAT, UINT8
from eigenfield.gltf.axes import capture_to_gltf
from eigenfield.gltf.buffer import Buffer
from eigenfield.gltf.container import glb_blocks, json_bytes
from eigenfield.gltf.rights import with_rights
from eigenfield.gltf.write_geometry import bounds_of
from eigenfield.imaging.colour import linear_of_srgb
from eigenfield.imaging.metrics import to_codes
from eigenfield.rendering.render_jobs import refuse_attributes
from eigenfield.runtime.files import atomic_files, write_bytes
from eigenfield.viewer.exports.splats.fit import fit_gaussians
from eigenfield.viewer.exports.splats.gaussians import SH_ZERO, Gaussians
from eigenfield.viewer.exports.splats.place import SPLATS_MOST

SPLATTING = "KHR_gaussian_splatting"
VERTICES = 34962  # glTF's target of a buffer view
SPZ_VERSION, SPZ_LARGEST, SPZ_MAX_BITS = 4, 2.0**23, 23  # of positions, 24 bits with a sign
LEAST_OPACITY = 1e-4


@checked
def write_splats(
    scene: Scene,
    output: Path,
    *,
    splats: int | None = None,
    metres_per_unit: float | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> tuple[int, float]:
    """Write flat Gaussians on the proxy whose colours are fitted to what the scene draws in its cameras.

    Axes are those of a scene's own .glb, lengths are metres where the scene knows them.

    Args:
        output: A .glb with `KHR_gaussian_splatting`, or an .spz.
        splats: How many Gaussians at most, fewer where the cameras see fewer texels; None: one for two pixels of
            a picture.
        metres_per_unit: Metres in one unit of the capture; None: as the scene says, or else one.

    Returns:
        How many Gaussians there are, and their PSNR in dB beside what the scene draws.

    Raises:
        OptionError: `splats`, `spz-missing`, `not-a-picture`.
        OutputError: The file cannot be written.
    """
    check_splats(output, splats)
    refuse_attributes(scene.appearance.channels)
    made, decibels = fit_gaussians(scene, splats, progress)
    scale = scale_of(scene, metres_per_unit)
    turned = _turned(made, capture_to_gltf(scene.rig), scale)
    if output.suffix.lower() == ".spz":
        with atomic_files([output], overwrite=overwrite) as (place,):
            _write_spz(turned, place)
    else:
        write_bytes(output, _glb(turned, scene.rights, output), overwrite=overwrite)
    return len(made), decibels


def check_splats(output: Path, splats: int | None) -> None:
    """Before any work: check that so many Gaussians can be written there. OptionError `splats`, `spz-missing`."""
    if splats is not None and not 1 <= splats <= SPLATS_MOST:
        raise OptionError("splats", f"{splats} splats", remedy=f"ask for 1 to {SPLATS_MOST}")
    if output.suffix.lower() == ".spz":
        try:
            import gsply  # noqa: F401
        except ImportError:
            remedy = "pip install 'eigenfield[splats]', or write a .glb"
            raise OptionError("spz-missing", "gsply is not installed", remedy=remedy) from None


def _turned(gaussians: Gaussians, turn: NDArray[np.float64], scale: float) -> Gaussians:
    """In other axes, whose directions in the world are the rows of `turn`, and other units. Harmonics are of these
    axes already."""
    return Gaussians(
        scale * (gaussians.positions @ turn.T), turn @ gaussians.rotations, scale * gaussians.scales,
        gaussians.opacity, gaussians.harmonics,
    )  # fmt: skip


def _quaternions(gaussians: Gaussians) -> NDArray[np.float64]:
    """(N, 4) x, y, z, w."""
    return np.asarray(Rotation.from_matrix(gaussians.rotations).as_quat(canonical=True))


def _glb(gaussians: Gaussians, rights: Rights, output: Path) -> bytes:
    """A primitive of points, whose colours (COLOR_0, linear as glTF has them) are for viewers without the extension."""
    buffer, positions = Buffer(), gaussians.positions.astype(np.float32)
    shown = (gaussians.harmonics[:, 0] * SH_ZERO + 0.5).clip(0, 1).astype(np.float64)
    points = to_codes(np.column_stack([linear_of_srgb(shown), gaussians.opacity]).astype(np.float32))
    attributes = {
        "POSITION": buffer.accessor(positions, FLOAT, "VEC3", VERTICES, **bounds_of(positions)),
        "COLOR_0": buffer.accessor(points, UINT8, "VEC4", VERTICES, normalized=True),
        f"{SPLATTING}:ROTATION": buffer.accessor(_quaternions(gaussians), FLOAT, "VEC4", VERTICES),
        f"{SPLATTING}:SCALE": buffer.accessor(gaussians.scales, FLOAT, "VEC3", VERTICES),
        f"{SPLATTING}:OPACITY": buffer.accessor(gaussians.opacity, FLOAT, "SCALAR", VERTICES),
    }
    for index in range(gaussians.harmonics.shape[1]):
        degree = int(np.sqrt(index))
        name = f"{SPLATTING}:SH_DEGREE_{degree}_COEF_{index - degree**2}"
        attributes[name] = buffer.accessor(gaussians.harmonics[:, index], FLOAT, "VEC3", VERTICES)
    splatting = {"kernel": "ellipse", "colorSpace": "srgb_rec709_display"}
    primitive = {"mode": 0, "attributes": attributes, "extensions": {SPLATTING: splatting}}
    gltf: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": f"eigenfield {__version__}"},
        "extensionsUsed": [SPLATTING],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "splats", "mesh": 0}],
        "meshes": [{"name": "splats", "primitives": [primitive]}],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": buffer.length}],
    }
    return b"".join(glb_blocks(json_bytes(with_rights(gltf, rights)), b"".join(buffer.parts), output))


def _write_spz(gaussians: Gaussians, place: Path) -> None:
    """By gsply, with the finest steps of position that hold all of them."""
    import gsply

    opacity = np.clip(gaussians.opacity, LEAST_OPACITY, 1 - LEAST_OPACITY)
    data = gsply.GSData(
        means=gaussians.positions.astype(np.float32),
        scales=np.log(gaussians.scales).astype(np.float32),
        quats=np.roll(_quaternions(gaussians), 1, axis=1).astype(np.float32),
        opacities=np.log(opacity / (1 - opacity)),
        sh0=np.ascontiguousarray(gaussians.harmonics[:, 0]),
        shN=np.ascontiguousarray(gaussians.harmonics[:, 1:]),
    )
    largest = float(np.abs(gaussians.positions).max())
    bits = int(np.clip(np.floor(np.log2(SPZ_LARGEST / max(largest, 1e-9))), 1, SPZ_MAX_BITS))
    gsply.write_spz(place, data, version=SPZ_VERSION, fractional_bits=bits)
