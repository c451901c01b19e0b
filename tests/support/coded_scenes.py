"""Scenes whose mesh, cameras and weights are coded, whose pictures have 10 bits or whose means have a precision, with
reference pictures for the tests of the web viewer."""

from __future__ import annotations

import json
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

import eigenfield as ef
from eigenfield.capture import open_capture
from eigenfield.coding.codecs import encoder
from eigenfield.coding.pictures.pictures_10bit import svt_coder
from eigenfield.coding.stacking import encode
from eigenfield.core.payloads import Affine, Payload, Payloads, PicturePayload, mean_key
from eigenfield.core.scene import Scene
from eigenfield.encoding.fitted.code_planes import code_basis, code_opacity, coded_plane, with_weights
from eigenfield.encoding.geometry.coded import DEPTH_ERROR_PX, coded_cameras, coded_mesh
from eigenfield.gltf import save
from eigenfield.proxy import PROXY_DEFAULT_TRIANGLES
from eigenfield.proxy.relief.find_lattice import relief_proxy
from support.captures import write_capture
from support.composed import encoded, kept_as_png, layered_scene
from support.scenes import bumpy_square
from support.viewer_scenes import PLACES, cameras, references, scene

GRID = np.arange(25).reshape(5, 5)
STEP = 2e-3  # of pictures, in the photographs' range


def coded_scene(weights_codec: str = "weights-1") -> Scene:
    """The scene of `viewer_scenes`, as its streams and pictures keep it: one plane of R, G and B."""
    return coded(scene(), GRID, weights_codec)


def coded(plain: Scene, grid: np.ndarray | None, weights_codec: str = "weights-1") -> Scene:
    """A scene of one plane and basis, whose cameras stand on `grid` if any, with everything coded that can be."""
    views = coded_cameras(plain.rig.cameras, plain.proxy.mesh, grid)
    (plane,) = plain.appearance.planes
    (basis,) = plane.bases
    stream, weights = encoder(weights_codec)(basis.weights, 0.01, grid)
    textures = with_weights(code_basis(basis, STEP, svt_coder(8)), weights, Payload(weights_codec, stream))
    proxy = replace(relief_proxy(plain.proxy.mesh, views.value, DEPTH_ERROR_PX), sheets=plain.proxy.sheets)
    surface = coded_mesh(proxy, views.value, plain.rig.reference)
    made = coded_plane(plane.mean, (textures,), STEP, svt_coder(8))
    proxy, payloads = surface.value, surface.payloads | views.payloads | made.payloads
    if proxy.sheets is not None:
        opacity = code_opacity(proxy.sheets.opacity, STEP, svt_coder(8))
        proxy = replace(proxy, sheets=replace(proxy.sheets, opacity=opacity.value))
        payloads |= opacity.payloads
    scene = replace(
        plain,
        proxy=proxy,
        rig=replace(plain.rig, cameras=views.value),
        appearance=replace(plain.appearance, planes=(made.value,)),
    )
    return encoded(scene, payloads)


def fitted_scene() -> Scene:
    """Luma and chroma fitted to nine photographs."""
    with tempfile.TemporaryDirectory() as work:
        folder = write_capture(Path(work) / "nine", cameras(3, 3), bumpy_square(24))
        capture = open_capture(folder)
        mesh = folder / "proxy.ply"
        return ef.encode(capture, proxy=mesh, fit="photographs", textures=6, triangles=PROXY_DEFAULT_TRIANGLES)


def precise_scene() -> Scene:
    """The layered scene with means of 10 bits, of which one precision says how finely both are coded."""
    layered = kept_as_png(layered_scene())  # its textures
    precision = np.random.default_rng(2).uniform(0.4, 1, (3, 5)).astype(np.float32)
    precision[0, 0] = 1
    means = [coded_plane(plane.mean, (), STEP, svt_coder(8), precision) for plane in layered.appearance.planes]
    planes = tuple(
        replace(plane, mean=mean.value.mean) for plane, mean in zip(layered.appearance.planes, means, strict=True)
    )
    return encoded(
        replace(layered, appearance=replace(layered.appearance, planes=planes)),
        Payloads.merge(mean.payloads for mean in means),
    )


def shallow(made: Scene) -> Scene:
    """The scene with a mean of 8 bits that is said to have 10."""
    (plane,) = made.appearance.planes
    height, width, channels = plane.mean.shape
    data = encode(np.zeros((channels * height, width, 1), np.uint8), "avif", 70)
    affine = Affine(np.ones(channels), np.zeros(channels))
    return encoded(made, Payloads({mean_key(plane.mean): [PicturePayload("av1-10bit-1", data, 1, affine)]}))


def write(folder: Path) -> None:
    """Write coded.glb, bare.glb, which shows other viewers nothing, precise.glb, fitted.glb and shallow.glb; add
    pictures of the first four to references.json, which is there."""
    listing = folder / "references.json"
    pictures = json.loads(listing.read_text(encoding="utf-8"))
    made = coded_scene()
    save(shallow(made), folder / "shallow.glb", overwrite=True)
    save(made, folder / "coded.glb", overwrite=True)
    pictures += references(folder, "coded.glb", PLACES[:2])
    save(made, folder / "bare.glb", fallback="none", overwrite=True)
    pictures += references(folder, "bare.glb", PLACES[1:2])
    save(precise_scene(), folder / "precise.glb", overwrite=True)
    pictures += references(folder, "precise.glb", PLACES[:2])
    # Fitted textures hold what their nine photographs ask for, up to the finest ripple that the atlas has: a vertex off
    # by a 32nd of a pixel is up to three grey levels there. So the vertices are where the browser has them.
    save(fitted_scene(), folder / "fitted.glb", overwrite=True)
    pictures += references(folder, "fitted.glb", PLACES[:2], snapped=True)
    listing.write_text(json.dumps(pictures, indent=1), encoding="utf-8")
