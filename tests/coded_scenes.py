"""Scenes whose mesh, cameras and weights are coded and whose pictures have 10 bits, with reference pictures for the
tests of the web viewer."""

from __future__ import annotations

import json
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from captures import write_capture
from scenes import bumpy_square
from viewer_scenes import PLACES, cameras, references, scene

import eigenfield as ef
from eigenfield.format import save
from eigenfield.format.deep_code import code_basis, code_plane, with_weights
from eigenfield.format.geometry import code_cameras_of, code_mesh
from eigenfield.format.pictures import encode
from eigenfield.format.quantise import Affine
from eigenfield.format.stored import PictureFile, keep_files
from eigenfield.format.weight_coder import code_weights
from eigenfield.scene import Plane, Scene

GRID = np.arange(25).reshape(5, 5)
STEP = 2e-3  # of pictures, in the photographs' range


def coded_scene() -> Scene:
    """The scene of `viewer_scenes`, as its streams and pictures keep it: one plane of R, G and B."""
    plain = scene()
    stream, views = code_cameras_of(plain.cameras, plain.mesh, GRID)
    mesh_stream, mesh = code_mesh(plain.mesh, views, plain.reference)
    (plane,) = plain.planes
    (basis,) = plane.bases
    weight_stream, weights = code_weights(basis.weights, 0.01, GRID)
    coded = with_weights(code_basis(basis, STEP, 8), weights, weight_stream)
    return replace(
        plain,
        mesh=mesh,
        cameras=views,
        planes=(code_plane(plane.mean, (coded,), STEP, 8),),
        streams={"mesh": mesh_stream, "cameras": stream},
    )


def fitted_scene() -> Scene:
    """Luma and chroma fitted to nine photographs."""
    with tempfile.TemporaryDirectory() as work:
        folder = write_capture(Path(work) / "nine", cameras(3, 3), bumpy_square(24))
        capture = ef.open_capture(folder)
        return ef.encode(capture, proxy=folder / "proxy.ply", fit="photographs", textures=6)


def shallow(made: Scene) -> Scene:
    """The scene with a mean of 8 bits that is said to have 10."""
    (plane,) = made.planes
    height, width, channels = plane.mean.shape
    data = encode(np.zeros((channels * height, width, 1), np.uint8), "avif", 70)
    changed = Plane(plane.mean, plane.bases)
    keep_files(changed, [PictureFile(data, "image/avif", 10, 1, Affine(np.ones(channels), np.zeros(channels)))])
    return replace(made, planes=(changed,))


def write(folder: Path) -> None:
    """Write coded.glb, fitted.glb and shallow.glb; add pictures of the first two to references.json, which is there."""
    listing = folder / "references.json"
    pictures = json.loads(listing.read_text(encoding="utf-8"))
    coded = coded_scene()
    save(shallow(coded), folder / "shallow.glb", overwrite=True)
    for name, made in (("coded.glb", coded), ("fitted.glb", fitted_scene())):
        save(made, folder / name, overwrite=True)
        pictures += references(folder, name, PLACES[:2])
    listing.write_text(json.dumps(pictures, indent=1), encoding="utf-8")
